/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names as users type them: in British or American spelling, and with mistakes. */
#ifndef RC_NAMES_H
#define RC_NAMES_H

#include <stdbool.h>
#include <stddef.h>

enum {
    NAME_SIZE = 64, /* largest size of a name, with its end */
    NAME_MEANT = NAME_SIZE + 24
};

/* The name in the other spelling, "colourmap" for "colormap" and the reverse; NULL if it has only one. */
const char *name_respelt(const char *name, char text[NAME_SIZE]);
/* True if a[0..n) and b[0..m) are the same name in any spelling. */
bool name_same(const char *a, size_t n, const char *b, size_t m);

/* Replaces `nearest`, initially "", by the name if the name is nearer to the typed one. */
void name_nearer(const char *typed, const char *name, char nearest[NAME_SIZE]);
/* True if `typed` is a misspelling of `name`: at most one mistake in five letters, and none in a digit. For
 * names that stand for values: a wrong guess would be accepted by trust. */
bool name_misspelt(const char *typed, const char *name);
/* Returns ": did you mean NAME?" for the end of a message; "" where no name is near. */
const char *name_meant(const char *nearest, char text[NAME_MEANT]);

#endif
