/*
 * The face of this folder: a page to draw figures on, in pixels from the upper left corner. What is drawn is
 * kept as shapes and words, and becomes pixels, a PDF or an SVG when it is written. Text is UTF-8 in the sans
 * serif of the system or the font asked for, and in other fonts for the characters that it lacks.
 */
#ifndef RC_CANVAS_H
#define RC_CANVAS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "libcontact/grid.h"
#include "colormap.h"
#include "png.h"

struct canvas;

enum {
    CANVAS_MOST = 32000 /* pixels a side */
};

/* White. NULL when a side is more than CANVAS_MOST or memory is short. */
struct canvas *canvas_new(size_t w, size_t h, struct rc_err *err);
void canvas_free(struct canvas *canvas); /* NULL is allowed */

/* The family of all text from now on, "sans" without one. Gives the name of the font that is there
 * for it: another one when none is called so. */
const char *canvas_set_family(struct canvas *canvas, const char *family);

struct canvas_font {
    double size; /* pixels */
    bool bold;
    struct rgb colour;
};

double canvas_text_width(struct canvas *canvas, const struct canvas_font *font, const char *text);
/* `part` of the text is left of x: 0 begins there, 0.5 is centred, 1 ends there. y is the base
 * line. */
void canvas_text(struct canvas *canvas, const struct canvas_font *font, double x, double y,
                 double part, const char *text);
/* Reads upwards, its middle at y; x is the base line. */
void canvas_text_upwards(struct canvas *canvas, const struct canvas_font *font, double x, double y,
                         const char *text);

/* The characters, each once, of the texts measured and drawn so far that no font has: a question
 * mark is drawn in their place. */
const char *canvas_unknown(const struct canvas *canvas);
/* A sentence that says so, for whoever waits for the picture; NULL when there are none. */
const char *canvas_warning(const struct canvas *canvas, char *text, size_t size);

void canvas_fill(struct canvas *canvas, double x, double y, double w, double h, struct rgb colour);
/* A line around the rectangle: inside it, the line would hide pixels of a map. */
void canvas_frame(struct canvas *canvas, double x, double y, double w, double h, double width,
                  struct rgb colour);
/* Fills the triangle. */
void canvas_triangle(struct canvas *canvas, double corner[3][2], struct rgb colour);

/* What follows shows only inside the rectangle; w 0 ends that. */
void canvas_clip(struct canvas *canvas, double x, double y, double w, double h);
/* Lines are drawn in one stroke: move, draw to, draw to, ..., stroke. */
void canvas_move(struct canvas *canvas, double x, double y);
void canvas_draw_to(struct canvas *canvas, double x, double y);
void canvas_stroke(struct canvas *canvas, double width, struct rgb colour);
/* The same in dashes of that length with gaps as long. */
void canvas_dashes(struct canvas *canvas, double width, double dash, struct rgb colour);

/* An image of nx by ny pixels, row by row, over the rectangle; its pixels have sharp edges however large
 * they become. Only those show that are inked (NULL: all). The canvas frees both; `pixel` NULL: memory is
 * short, which canvas_check reports. */
void canvas_image(struct canvas *canvas, double x, double y, double w, double h, struct rgb *pixel,
                  bool *inked, size_t nx, size_t ny);

/* RC_FAIL when something before could not be drawn, or there is no font. */
enum rc_status canvas_check(const struct canvas *canvas, struct rc_err *err);
/* Row y as width times red, green, blue. RC_FAIL as canvas_check. */
enum rc_status canvas_row(struct canvas *canvas, size_t y, unsigned char *rgb, struct rc_err *err);

/* ---- files ---- */

enum canvas_format {
    CANVAS_PNG,
    CANVAS_SVG,
    CANVAS_PDF
};

/* "png", "svg" or "pdf" as a format: any other is a PNG. */
enum canvas_format canvas_format(const char *name);

/* How large the page is on paper: so many of its pixels in an inch (216 until this is called). With
 * `pixels` the size of an SVG is in the pixels of a screen, one for each of the page. */
void canvas_set_dpi(struct canvas *canvas, double dpi, bool pixels);

/* Writes the page on `file`, which stays the caller's. No time is written: the same page is the
 * same bytes. `text` goes into the chunks of a PNG; of the others Title, Description and Software
 * have a place. RC_FAIL as canvas_check, or when the device refuses. */
enum rc_status canvas_write(struct canvas *canvas, enum canvas_format format,
                            const struct picture_text *text, size_t texts, FILE *file,
                            struct rc_err *err);

#endif
