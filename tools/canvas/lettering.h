/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text by Pango: its width, its drawing, characters that no font has. */
#ifndef RC_LETTERING_H
#define RC_LETTERING_H

#include <stdbool.h>

#include "canvas.h"

struct lettering;

struct lettering *lettering_new(void);
void lettering_free(struct lettering *lettering); /* NULL is allowed */
void lettering_set_family(struct lettering *lettering, const char *family);
/* The family that is really in use. */
const char *lettering_family(struct lettering *lettering);

double lettering_width(struct lettering *lettering, const struct canvas_font *font,
                       const char *text);
/* Draws the text on a cairo_t; its base line begins at the current point. */
void lettering_show(struct lettering *lettering, void *cairo, const struct canvas_font *font,
                    const char *text);

/* The characters, each once, of all texts so far that no font has. */
const char *lettering_unknown(const struct lettering *lettering);
/* True if no font has even a question mark. */
bool lettering_has_no_font(const struct lettering *lettering);

/* Divides the text into raised and other pieces. For the piece that begins at *at it gives the letters, and
 * whether they are raised. Raised letters have LETTERING_RAISED times the size and are LETTERING_RISE times
 * the size higher. False at the end. The caller frees `letters` with free(). */
bool lettering_piece(const struct lettering *lettering, const char *text, size_t *at,
                     char **letters, bool *raised);

#define LETTERING_RAISED 0.7
#define LETTERING_RISE 0.36

#endif
