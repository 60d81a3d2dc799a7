/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "foreign.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* First bytes of files that a user may pass in place of a stream; `readable`: rc-import may read them. */
static const struct kind {
    const char *magic, *what;
    bool readable;
} kinds[] = {
    {"PK\003\004", "a ZIP archive", true},
    {"\037\213", "GZIP", true},
    {"\211HDF", "HDF5", true},
    {"\211PNG", "a PNG picture", false},
    {"\377\330\377", "a JPEG picture", false},
    {"%PDF", "PDF", false},
    {"{\"", "JSON", false},
};

static bool
is_text(const char *head)
{
    for (const char *s = head; *s != '\0'; s++)
        if (((unsigned char)*s < 0x20 && strchr("\t\r\n", *s) == NULL) || *s == 0x7f)
            return false;
    return *head != '\0';
}

/* The name for a shell: in quotes if it has special characters. */
static const char *
shell_name(char *text, size_t size, const char *name)
{
    const char *plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._/+-";

    if (name[strspn(name, plain)] == '\0' || strchr(name, '\'') != NULL)
        snprintf(text, size, "%s", name);
    else
        snprintf(text, size, "'%s'", name);
    return text;
}

const char *
foreign_message(char *text, size_t size, const char *tool, const char *name, const char *head)
{
    const struct kind *kind = NULL;
    const char *what = is_text(head) ? "text" : NULL;
    const char *shown = strcmp(name, "-") == 0 ? "standard input" : name;
    char word[256];

    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        if (strncmp(head, kinds[k].magic, strlen(kinds[k].magic)) == 0)
            kind = &kinds[k];
    if (kind != NULL)
        what = kind->what;
    if (strncmp(head, "# rc-cost:", 10) == 0 || strncmp(head, "rc-", 3) == 0)
        snprintf(text, size,
                 "%s is the result of rc-cost: if %s is a part of its command, write '|' in quotes "
                 "before it: rc-cost FILE -- COMMAND '|' %s ...",
                 shown, tool, tool);
    else if (strncmp(head, "RCG1\r", 5) == 0)
        snprintf(text, size,
                 "%s: a copy in text mode has changed its line ends: copy it in binary mode",
                 shown);
    else if (kind != NULL && !kind->readable)
        snprintf(text, size,
                 "%s is not a grid stream, but looks like %s: %s reads streams of rc-import", shown,
                 what, tool);
    else
        snprintf(text, size, "%s is not a grid stream%s%s: rc-import %s | %s ...", shown,
                 what == NULL ? "" : ", it looks like ", what == NULL ? "" : what,
                 shell_name(word, sizeof word, name), tool);
    return text;
}
