/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JSON objects for reports, one per line: fields in the order in which they are given; unknown is null. */
#ifndef RC_JSON_H
#define RC_JSON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

struct json {
    FILE *file;
    bool follows; /* a comma must precede the next field */
};

void json_open(struct json *json, FILE *file);
/* `name` NULL: an element of an array. */
void json_plain(struct json *json, const char *name,
                const char *value);                                  /* as it stands; NULL: null */
void json_number(struct json *json, const char *name, double value); /* NaN and infinity: null */
void json_text(struct json *json, const char *name, const char *value); /* NULL: null */
void json_bool(struct json *json, const char *name, bool value);
/* An object or an array; bracket: its last one, '}' or ']'. */
void json_begin(struct json *json, const char *name, char bracket);
void json_end(struct json *json, char bracket);
/* Ends the outermost object and the line, and flushes. */
void json_close(struct json *json);

#endif
