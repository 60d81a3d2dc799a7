/*
 * An image to draw figures on, in pixels from the upper left corner. Text is UTF-8 in the sans
 * serif of the system, and in other fonts for the characters that it lacks.
 */
#ifndef RC_CANVAS_H
#define RC_CANVAS_H

#include <stdbool.h>
#include <stddef.h>

#include "libcontact/grid.h"
#include "colormap.h"

struct canvas;

enum {
    CANVAS_MOST = 32000 /* pixels a side */
};

/* White. NULL when a side is more than CANVAS_MOST or memory is short. */
struct canvas *canvas_new(size_t w, size_t h, struct rc_err *err);
void canvas_free(struct canvas *canvas); /* NULL is allowed */

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
/* A line inside the rectangle would hide pixels of a map: it runs around it. */
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

void canvas_pixel(struct canvas *canvas, size_t x, size_t y, struct rgb colour);
/* RC_FAIL when something before could not be drawn, or there is no font. */
enum rc_status canvas_check(const struct canvas *canvas, struct rc_err *err);
/* Row y as width times red, green, blue. RC_FAIL as canvas_check. */
enum rc_status canvas_row(struct canvas *canvas, size_t y, unsigned char *rgb, struct rc_err *err);
size_t canvas_width(const struct canvas *canvas);
size_t canvas_height(const struct canvas *canvas);

#endif
