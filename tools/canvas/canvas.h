/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder. A page for figures is in pixels from the upper left corner. It stores shapes
 * and texts, and converts them to pixels, a PDF or an SVG when it is written. Text is UTF-8 in the sans serif
 * font of the system or in the requested font. Characters that this font lacks are set in other fonts.
 */
#ifndef RC_CANVAS_H
#define RC_CANVAS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "libcontact/grid.h"
#include "libcontact/owned.h"
#include "colormap.h"
#include "png.h"

struct canvas;

enum {
    CANVAS_MOST = 32000 /* pixels a side */
};

/* Makes a white page. NULL when a side exceeds CANVAS_MOST or memory is short. */
struct canvas *canvas_new(size_t w, size_t h, struct rc_err *err);
void canvas_free(struct canvas *canvas); /* NULL is allowed */

/* Sets the font family of all later text; NULL: "sans". Returns the name of the font in use, which differs if
 * the system has no font of this name. */
const char *canvas_set_family(struct canvas *canvas, const char *family);

struct canvas_font {
    double size; /* pixels */
    bool bold;
    struct rgb colour;
};

double canvas_text_width(struct canvas *canvas, const struct canvas_font *font, const char *text);
/* The fraction `part` of the text is left of x. With 0 it begins there, with 0.5 it is centred, with 1 it
 * ends there. y is the base line. */
void canvas_text(struct canvas *canvas, const struct canvas_font *font, double x, double y,
                 double part, const char *text);
/* Text that reads upwards, with its middle at y; x is the base line. */
void canvas_text_upwards(struct canvas *canvas, const struct canvas_font *font, double x, double y,
                         const char *text);

/* The characters, each once, of the texts measured and drawn so far that no font has; a question mark
 * replaces them. */
const char *canvas_unknown(const struct canvas *canvas);
/* A warning about these characters for the user; NULL if there are none. */
const char *canvas_warning(const struct canvas *canvas, char *text, size_t size);

void canvas_fill(struct canvas *canvas, double x, double y, double w, double h, struct rgb colour);
/* A line just outside of the rectangle, so that it does not cover pixels of a map. */
void canvas_frame(struct canvas *canvas, double x, double y, double w, double h, double width,
                  struct rgb colour);
/* Fills the triangle. */
void canvas_triangle(struct canvas *canvas, double corner[3][2], struct rgb colour);

/* Clips later items to the rectangle; w = 0 ends the clipping. */
void canvas_clip(struct canvas *canvas, double x, double y, double w, double h);
/* A line is a path drawn in one stroke: move, draw to, draw to, ..., stroke. */
void canvas_move(struct canvas *canvas, double x, double y);
void canvas_draw_to(struct canvas *canvas, double x, double y);
/* Move and draw to. */
void canvas_line(struct canvas *canvas, double x0, double y0, double x1, double y1);
void canvas_stroke(struct canvas *canvas, double width, struct rgb colour);
/* The same with dashes and gaps of this length. */
void canvas_dashes(struct canvas *canvas, double width, double dash, struct rgb colour);

/* An image of nx by ny pixels, row by row, over the rectangle; its pixels have sharp edges at any size. Only
 * pixels with `inked` set are drawn (NULL: all). The canvas frees both arrays; `pixel` NULL means that memory
 * is short, which canvas_check reports. */
void canvas_image(struct canvas *canvas, double x, double y, double w, double h, struct rgb *pixel,
                  bool *inked, size_t nx, size_t ny);

/* RC_FAIL if an earlier item could not be drawn, or if there is no font. */
enum rc_status canvas_check(const struct canvas *canvas, struct rc_err *err);
/* Row y of the page as width times red, green, blue. RC_FAIL as for canvas_check. */
enum rc_status canvas_row(struct canvas *canvas, size_t y, unsigned char *rgb, struct rc_err *err);

/* ---- files ---- */

enum canvas_format {
    CANVAS_PNG,
    CANVAS_SVG,
    CANVAS_PDF
};

/* The format with the name "png", "svg" or "pdf"; PNG for any other name. */
enum canvas_format canvas_format(const char *name);

/* Sets the size of the page on paper by its pixels per inch (by default 216). With `pixels` the size of an
 * SVG is in screen pixels, one for each pixel of the page. */
void canvas_set_dpi(struct canvas *canvas, double dpi, bool pixels);

/* Writes the page to `file`, which the caller keeps. No time is written: the same page gives the same bytes.
 * `text` goes into the chunks of a PNG; the other formats hold only Title, Description and Software. RC_FAIL
 * as for canvas_check, or when writing fails. */
enum rc_status canvas_write(struct canvas *canvas, enum canvas_format format,
                            const struct picture_text *text, size_t texts, FILE *file,
                            struct rc_err *err);

#endif
