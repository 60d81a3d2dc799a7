/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/* ---- the reader ---- */

static const char *
skip_blanks(const char *s)
{
    return s + strspn(s, " \t\r\n");
}

/* Past the text that begins here. */
static const char *
past_text(const char *s)
{
    for (s++; *s != '"' && *s != '\0'; s++)
        s += *s == '\\' && s[1] != '\0';
    return *s == '"' ? s + 1 : s;
}

static const char *
past_value(const char *s)
{
    int depth = 0;

    do {
        if (*s == '"') {
            s = past_text(s);
            continue;
        }
        if (depth == 0 && strchr(",:]}", *s) != NULL)
            return s;
        depth += (*s == '{' || *s == '[') - (*s == '}' || *s == ']');
        s += *s != '\0';
    } while (*s != '\0' && (depth > 0 || strchr(",]}", *s) == NULL));
    return s;
}

const char *
json_first(const char *s)
{
    if (s == NULL || (*s != '{' && *s != '['))
        return NULL;
    s = skip_blanks(s + 1);
    return *s == '}' || *s == ']' || *s == '\0' ? NULL : s;
}

const char *
json_next(const char *s)
{
    s = skip_blanks(past_value(s));
    if (*s == ':')
        s = skip_blanks(past_value(skip_blanks(s + 1)));
    return *s == ',' ? skip_blanks(s + 1) : NULL;
}

const char *
json_member(const char *object, const char *name)
{
    const size_t n = strcspn(name, ".");

    if (object == NULL || *object != '{')
        return NULL;
    for (const char *at = json_first(object); at != NULL; at = json_next(at)) {
        if (*at != '"' || strncmp(at + 1, name, n) != 0 || at[1 + n] != '"')
            continue;
        at = skip_blanks(past_text(at));
        at = *at == ':' ? skip_blanks(at + 1) : at;
        return name[n] == '.' ? json_member(at, name + n + 1) : at;
    }
    return NULL;
}

double
json_real(const char *value)
{
    char *end;
    double number;

    if (value == NULL)
        return NAN;
    if (strncmp(value, "true", 4) == 0 || strncmp(value, "false", 5) == 0)
        return *value == 't';
    number = strtod(value, &end);
    return end == value ? NAN : number;
}

bool
json_is(const char *value, const char *text)
{
    const size_t n = strlen(text);

    return value != NULL && *value == '"' && strncmp(value + 1, text, n) == 0 &&
           value[1 + n] == '"';
}

const char *
json_copy(const char *value, char *text, size_t size)
{
    size_t n = 0;

    for (const char *s = value == NULL || *value != '"' ? "" : value + 1;
         *s != '"' && *s != '\0' && n + 1 < size; s++)
        text[n++] = *s == '\\' && s[1] != '\0' ? *++s : *s;
    text[n] = '\0';
    return text;
}
