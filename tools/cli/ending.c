/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ending.h"

#include <string.h>
#include <strings.h>
#include <sys/stat.h>

static const char *const endings[] = {"png", "svg", "pdf"};

enum {
    ENDINGS = sizeof endings / sizeof *endings
};

/* The suffix of a picture; NULL: the name has no such suffix. */
static const char *
find(const char *name)
{
    size_t n = strlen(name);

    for (size_t k = 0; n >= 4 && k < ENDINGS; k++)
        if (name[n - 4] == '.' && strcasecmp(name + n - 3, endings[k]) == 0)
            return endings[k];
    return NULL;
}

const char *
ending_of(const char *name)
{
    const char *ending = name == NULL ? NULL : find(name);

    return ending == NULL ? endings[0] : ending;
}

void
ending_demand_picture(struct tool *t, const char *option, const char *name)
{
    struct stat st;

    if (name == NULL || find(name) != NULL)
        return;
    if (strncmp(name, "/dev/", 5) == 0 || (stat(name, &st) == 0 && !S_ISREG(st.st_mode)))
        return;
    tool_usage(t,
               "%s %s: a picture is a PNG, SVG or PDF: its name has to end in .png, .svg or .pdf",
               option, name);
}

void
ending_refuse_picture(struct tool *t, const char *name)
{
    if (name != NULL && find(name) != NULL)
        tool_usage(t, "-o %s: %s writes a grid stream, not a picture: pipe it into rc-render -o %s",
                   name, t->info->name, name);
}
