/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "json.h"

#include <math.h>

#include "formats/core/core.h"

static void
quoted(FILE *file, const char *s)
{
    size_t size;

    putc('"', file);
    for (; *s != '\0'; s++) {
        if (*s == '"' || *s == '\\')
            fprintf(file, "\\%c", *s);
        else if ((size = rc_control_size(s)) > 0) /* the code point is the last byte */
            fprintf(file, "\\u%04x", (unsigned)(unsigned char)*(s += size - 1));
        else
            putc(*s, file);
    }
    putc('"', file);
}

static void
name_of(struct json *j, const char *name)
{
    if (j->follows)
        fputs(", ", j->file);
    j->follows = true;
    if (name != NULL) {
        quoted(j->file, name);
        fputs(": ", j->file);
    }
}

void
json_open(struct json *j, FILE *file)
{
    *j = (struct json){.file = file};
    putc('{', file);
}

void
json_plain(struct json *j, const char *name, const char *value)
{
    name_of(j, name);
    fputs(value == NULL ? "null" : value, j->file);
}

void
json_text(struct json *j, const char *name, const char *value)
{
    if (value == NULL) {
        json_plain(j, name, NULL);
        return;
    }
    name_of(j, name);
    quoted(j->file, value);
}

void
json_number(struct json *j, const char *name, double value)
{
    json_plain(j, name, isfinite(value) ? rc_number(value) : NULL);
}

void
json_bool(struct json *j, const char *name, bool value)
{
    json_plain(j, name, value ? "true" : "false");
}

void
json_begin(struct json *j, const char *name, char bracket)
{
    name_of(j, name);
    putc(bracket == '}' ? '{' : '[', j->file);
    j->follows = false;
}

void
json_end(struct json *j, char bracket)
{
    putc(bracket, j->file);
    j->follows = true;
}

void
json_close(struct json *j)
{
    fputs("}\n", j->file);
    fflush(j->file);
}
