/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JSON objects for reports, one per line: fields in the order in which they are given; unknown is null. And a
 * reader of the JSON that the tools write. */
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

/* A value is where its text begins. The value of a member, in an object inside for "a.b"; NULL: none. */
const char *json_member(const char *object, const char *name);
/* The first element of an array, or the first name of an object; the next one; NULL: none. */
const char *json_first(const char *container);
const char *json_next(const char *element);
/* A number, or true or false as 1 or 0; NAN: another value, or NULL. */
double json_real(const char *value);
/* True if the value is this text. */
bool json_is(const char *value, const char *text);
/* Copies a text, with its escapes, up to `size` bytes with the end; "" for another value, or NULL. */
const char *json_copy(const char *value, char *text, size_t size);

#endif
