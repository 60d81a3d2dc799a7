/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text of foreign files: lines, UTF-8, and text that is safe to store or show. */
#ifndef RC_TEXT_H
#define RC_TEXT_H

#include <stdbool.h>
#include <stddef.h>

#include "libcontact/owned.h"

/* Lines that end in LF, CR LF or CR. */
struct rc_lines {
    const char *at, *end;
    size_t number; /* number of the line given last, from 1 */
};
/* The next line without its end; false when there is none. */
bool rc_lines_next(struct rc_lines *lines, const char **line, size_t *n);

/* Drops white space at both ends. */
void rc_trim(const char **text, size_t *n);

/* True if text is UTF-8 by RFC 3629: no overlong forms, no surrogates, up to U+10FFFF. */
bool rc_utf8_valid(const char *text);
/* Writes the bytes of a code point below U+10000, 1 to 3 without a NUL; returns their number. */
size_t rc_utf8_put(char *to, unsigned code);

/* The number of bytes of the control character that text begins with, 0 when it begins with another. It is 1,
 * or 2 for U+0080 to U+009F in UTF-8, which act on a terminal as well. */
size_t rc_control_size(const char *text);
/* Replaces each byte of a control character by `mark`. Returns `text`. */
char *rc_text_harmless(char *text, char mark);

/* Writes a character as XML has it in texts and attributes: "&amp;" for &. A control character, which XML
 * does not allow, becomes a blank. Returns `to`. */
enum {
    RC_ENTITY = 8
};
const char *rc_xml_character(char to[RC_ENTITY], char c);
/* Writes up to three bytes as four characters of base64. Returns `to`. */
const char *rc_base64(char to[5], const unsigned char *bytes, size_t n);

/* Copies text[0..n) as UTF-8, cut to the size. Bytes that are not UTF-8 are read as Latin-1, control
 * characters become spaces, and white space at both ends is removed. Returns `to`. */
char *rc_text_clean(char *to, size_t size, const char *text, size_t n);

enum {
    RC_SHOWN = 48
};
/* The same line, shortened for a quotation in a message. Without _to the text lives until the end of the
 * block. */
const char *rc_text_shown_to(char to[RC_SHOWN], const char *text, size_t n);
const char *rc_word_shown_to(char to[RC_SHOWN], const char *word); /* up to its NUL */
#define rc_text_shown(text, n) rc_text_shown_to((char[RC_SHOWN]){""}, text, n)
#define rc_word_shown(word) rc_word_shown_to((char[RC_SHOWN]){""}, word)

/* Sets a key to the cleaned text; does nothing when that is empty. */
enum rc_status rc_text_keep(struct rc_grid *grid, const char *key, const char *text, size_t n,
                            struct rc_err *err);
enum rc_status rc_word_keep(struct rc_grid *grid, const char *key, const char *word,
                            struct rc_err *err); /* up to its NUL */

#endif
