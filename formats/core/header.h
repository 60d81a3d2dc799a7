/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Headers of text. They have `key = value` lines, numbers with units, and tables of the relevant keys. */
#ifndef RC_HEADER_H
#define RC_HEADER_H

#include <stdbool.h>
#include <stddef.h>

#include "text.h"

struct rc_piece {
    const char *text; /* without a NUL at its end */
    size_t n;
};

/* The piece of a word that ends in NUL. */
struct rc_piece rc_piece_of(const char *word);
/* True if the piece is one of the words, separated by '|', in upper or lower case of ASCII. */
bool rc_piece_is(struct rc_piece piece, const char *words);
/* True if it begins with the word, in either case. */
bool rc_piece_begins(struct rc_piece piece, const char *word);
/* The position of the word in the piece, or NULL; upper and lower case differ. */
const char *rc_piece_find(struct rc_piece piece, const char *word);
struct rc_piece rc_piece_trim(struct rc_piece piece);
/* The piece without surrounding quotes or brackets: nm of "[nm]". */
struct rc_piece rc_piece_bare(struct rc_piece piece);
/* A cursor over its lines, before the first one. */
struct rc_lines rc_piece_lines(struct rc_piece piece);
/* Splits the text at the first of the characters `marks`, and trims both parts. Returns false if there is
 * none. */
bool rc_piece_part(struct rc_piece piece, const char *marks, struct rc_piece *before,
                   struct rc_piece *after);
/* Takes the next word: in quotes, or up to one of the characters `ends`, any number of which come before it.
 * Without quotes or brackets around it. False where there is none. */
bool rc_piece_word(struct rc_piece *rest, const char *ends, struct rc_piece *word);
/* The number at the beginning of a text, and the trimmed rest (which may be NULL). Returns false without a
 * number. Decimal commas are read as points. */
bool rc_piece_number(struct rc_piece piece, double *value, struct rc_piece *rest);
/* True if the piece is a word for infinity, as C libraries print one: inf, -Infinity, 1.#INF. */
bool rc_piece_infinite(struct rc_piece piece, double *value);

/* Metres in one unit of the length that the piece names; NAN for another word. */
double rc_piece_metres(struct rc_piece piece);
/* The same for files that write units in capitals: "MM" is mm, not Mm. */
double rc_piece_metres_in_capitals(struct rc_piece piece);
/* Makes a text safe to quote in a message, as rc_text_shown does. */
const char *rc_piece_shown_to(char to[RC_SHOWN], struct rc_piece piece);
#define rc_piece_shown(piece) rc_piece_shown_to((char[RC_SHOWN]){""}, piece)
/* Sets a key of the grid; as rc_text_keep. */
enum rc_status rc_piece_keep(struct rc_grid *grid, const char *key, struct rc_piece piece,
                             struct rc_err *err);

enum rc_field_kind {
    RC_FIELD_TEXT,   /* struct rc_piece                                    */
    RC_FIELD_NUMBER, /* double, text after the number is ignored           */
    RC_FIELD_LENGTH  /* double, metres; numbers without a unit are metres  */
};

/* A key that matters, and where its value goes in a struct. */
struct rc_field {
    const char *key; /* in upper or lower case; several keys are separated by '|' */
    enum rc_field_kind kind;
    size_t at;
};
/* Puts the value into the member of the struct that the field of that key names; does nothing for
 * other keys. RC_FAIL for a value of the wrong kind. */
enum rc_status rc_field_take(const struct rc_field *field, size_t n, struct rc_piece key,
                             struct rc_piece value, void *into, struct rc_err *err);
/* Reads all lines that contain one of the `marks`, up to the end or the line `last` (which may be NULL). */
enum rc_status rc_fields_read(const struct rc_field *field, size_t n, struct rc_lines *lines,
                              const char *marks, const char *last, void *into, struct rc_err *err);

/* Reads n numbers from *text on, separated by white space or line ends; NAN for the words NaN, NA,
 * BAD, -- and ---. RC_FAIL when a word is not a number or there are too few numbers. */
enum rc_status rc_flow_read(struct rc_piece *text, double *v, size_t n, struct rc_err *err);

#endif
