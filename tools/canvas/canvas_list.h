/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The items of a canvas, for the files that convert it to pixels, PDF or SVG. */
#ifndef RC_CANVAS_LIST_H
#define RC_CANVAS_LIST_H

#include "canvas.h"
#include "lettering.h"

enum item_kind {
    ITEM_TEXT,
    ITEM_FILL,
    ITEM_FRAME, /* a frame; the middle of its line is the rectangle */
    ITEM_POLYGON,
    ITEM_CLIP,
    ITEM_LINES,
    ITEM_IMAGE
};

struct item_point {
    double x, y;
    bool begins; /* a straight line */
};

struct item {
    enum item_kind kind;
    double x, y, w, h; /* rectangles; for a text the position of its `part` on the base line */
    double width, dash;
    struct rgb colour;
    /* text */
    struct canvas_font font;
    char *text;
    double part, length; /* length: width of the text in pixels */
    bool upwards;
    /* lines and polygons */
    struct item_point *point;
    size_t points;
    /* images; `inked` NULL: all pixels are drawn */
    struct rgb *pixel;
    bool *inked;
    void *reserved; /* never touched: counts the copy that cairo keeps of it for a PDF */
    size_t nx, ny;
};

struct canvas {
    size_t w, h;
    double dpi;
    bool screen; /* the size of an SVG is in pixels */
    struct item *item;
    size_t items, capacity;
    struct item_point *path; /* the line being drawn */
    size_t points, point_capacity;
    struct lettering *lettering;
    unsigned *drawn; /* the page as pixels; NULL: not yet */
    bool short_of_memory;
};

/* ---- cairo_page.c ---- */

/* Draws the items on the pixels of the page, once. */
enum rc_status drawn_update(struct canvas *canvas, struct rc_err *err);
enum rc_status pdf_write(struct canvas *canvas, const struct picture_text *text, size_t texts,
                         FILE *file, struct rc_err *err);

/* ---- svg.c ---- */

enum rc_status svg_write(struct canvas *canvas, const struct picture_text *text, size_t texts,
                         FILE *file, struct rc_err *err);

#endif
