/* Text by Pango: how wide it is, how it is drawn, what no font has. */
#ifndef RC_LETTERING_H
#define RC_LETTERING_H

#include <stdbool.h>

#include "canvas.h"

struct lettering;

struct lettering *lettering_new(void);
void lettering_free(struct lettering *lettering); /* NULL is allowed */
void lettering_set_family(struct lettering *lettering, const char *family);
/* The family that text is really set in. */
const char *lettering_family(struct lettering *lettering);

double lettering_width(struct lettering *lettering, const struct canvas_font *font,
                       const char *text);
/* Draws the text on a cairo_t, its base line beginning at the current point. */
void lettering_show(struct lettering *lettering, void *cairo, const struct canvas_font *font,
                    const char *text);

/* The characters of texts so far that no font has, each once. */
const char *lettering_unknown(const struct lettering *lettering);
/* Not even a question mark has a glyph. */
bool lettering_has_no_font(const struct lettering *lettering);

/* The text in pieces: of the piece that begins at *at, the letters as they are to be set, and
 * whether they are raised, set at LETTERING_RAISED of the size and LETTERING_RISE of it higher.
 * False at the end. The caller frees `letters` with free(). */
bool lettering_piece(const struct lettering *lettering, const char *text, size_t *at,
                     char **letters, bool *raised);

#define LETTERING_RAISED 0.7
#define LETTERING_RISE 0.36

#endif
