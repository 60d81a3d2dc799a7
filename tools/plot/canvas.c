/*
 * An image by cairo, with text by Pango; no other file includes either.
 */
#include "canvas.h"

#include <math.h>
#include <pango/pangocairo.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

struct canvas {
    cairo_surface_t *surface;
    cairo_t *cairo;
    PangoLayout *layout;
    GString *unknown; /* characters that no font has, each once */
    bool no_font;     /* not even a question mark has a glyph   */
    size_t w, h;
};

static void
set_colour(struct canvas *c, struct rgb colour)
{
    cairo_set_source_rgb(c->cairo, colour.r / 255.0, colour.g / 255.0, colour.b / 255.0);
}

/* Shades of grey and unrounded widths: text looks the same whatever the screen of the machine. */
static PangoLayout *
new_layout(cairo_t *cairo)
{
    PangoLayout *layout = pango_cairo_create_layout(cairo);
    PangoContext *context = pango_layout_get_context(layout);
    cairo_font_options_t *font = cairo_font_options_create();

    cairo_font_options_set_antialias(font, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(font, CAIRO_HINT_STYLE_SLIGHT);
    cairo_font_options_set_hint_metrics(font, CAIRO_HINT_METRICS_OFF);
    pango_cairo_context_set_font_options(context, font);
    cairo_font_options_destroy(font);
    pango_context_set_round_glyph_positions(context, FALSE);
    pango_layout_set_single_paragraph_mode(layout, TRUE);
    return layout;
}

struct canvas *
canvas_new(size_t w, size_t h, struct rc_err *err)
{
    struct canvas *c;

    if (w == 0 || h == 0 || w > CANVAS_MOST || h > CANVAS_MOST) {
        rc_err_set(err, "a figure of %zu by %zu pixels: a side is 1 to %d", w, h, CANVAS_MOST);
        return NULL;
    }
    c = calloc(1, sizeof *c);
    if (c == NULL) {
        rc_err_set(err, "out of memory for a figure");
        return NULL;
    }
    *c = (struct canvas){.w = w, .h = h};
    c->surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)w, (int)h);
    c->cairo = cairo_create(c->surface);
    if (cairo_status(c->cairo) != CAIRO_STATUS_SUCCESS) {
        rc_err_set(err, "a figure of %zu by %zu pixels: %s", w, h,
                   cairo_status_to_string(cairo_status(c->cairo)));
        canvas_free(c);
        return NULL;
    }
    c->layout = new_layout(c->cairo);
    c->unknown = g_string_new(NULL);
    canvas_fill(c, 0, 0, (double)w, (double)h, (struct rgb){255, 255, 255});
    return c;
}

void
canvas_free(struct canvas *c)
{
    if (c == NULL)
        return;
    if (c->layout != NULL)
        g_object_unref(c->layout);
    if (c->unknown != NULL)
        g_string_free(c->unknown, TRUE);
    cairo_destroy(c->cairo);
    cairo_surface_destroy(c->surface);
    free(c);
}

size_t
canvas_width(const struct canvas *c)
{
    return c->w;
}

size_t
canvas_height(const struct canvas *c)
{
    return c->h;
}

/* ---- text ---- */

/* The plain character that stands for a raised one; 0: it is none. */
static gunichar
lowered(gunichar raised)
{
    switch (raised) {
    case 0xb9:
        return '1';
    case 0xb2:
        return '2';
    case 0xb3:
        return '3';
    case 0x207a:
        return '+';
    case 0x207b:
        return 0x2212; /* minus */
    default:
        return raised == 0x2070 || (raised >= 0x2074 && raised <= 0x2079) ? '0' + raised - 0x2070
                                                                          : 0;
    }
}

static void
add_raise(PangoAttrList *list, guint from, guint to, const struct canvas_font *f)
{
    PangoAttribute *scale = pango_attr_scale_new(0.7);
    PangoAttribute *rise = pango_attr_rise_new((int)(0.36 * f->size * PANGO_SCALE));

    scale->start_index = rise->start_index = from;
    scale->end_index = rise->end_index = to;
    pango_attr_list_insert(list, scale);
    pango_attr_list_insert(list, rise);
}

/* Puts the text into the layout. Raised digits become digits that are set higher, of one design and
 * whatever raised ones the font has; what no font has becomes a question mark. */
static void
put_text(struct canvas *c, const struct canvas_font *f, const char *text)
{
    PangoAttrList *list = pango_attr_list_new();
    GString *plain = g_string_new(NULL);

    for (const char *s = text; *s != '\0'; s = g_utf8_next_char(s)) {
        gunichar own = g_utf8_get_char(s), low = lowered(own);
        gsize from = plain->len;

        if (g_utf8_strchr(c->unknown->str, -1, own) != NULL)
            low = '?';
        g_string_append_unichar(plain, low != 0 ? low : own);
        if (low != 0 && low != '?')
            add_raise(list, (guint)from, (guint)plain->len, f);
    }
    pango_layout_set_text(c->layout, plain->str, (int)plain->len);
    pango_layout_set_attributes(c->layout, list);
    pango_attr_list_unref(list);
    g_string_free(plain, TRUE);
}

/* Adds the characters of the layout that have no glyph to c->unknown. */
static void
find_unknown(struct canvas *c)
{
    PangoLayoutIter *iter = pango_layout_get_iter(c->layout);

    do {
        const PangoLayoutRun *run = pango_layout_iter_get_run_readonly(iter);

        for (int k = 0; run != NULL && k < run->glyphs->num_glyphs; k++) {
            PangoGlyph glyph = run->glyphs->glyphs[k].glyph;
            gunichar character = glyph & ~PANGO_GLYPH_UNKNOWN_FLAG;

            if (glyph & PANGO_GLYPH_UNKNOWN_FLAG && glyph != PANGO_GLYPH_EMPTY &&
                g_utf8_strchr(c->unknown->str, -1, character) == NULL)
                g_string_append_unichar(c->unknown, character);
        }
    } while (pango_layout_iter_next_run(iter));
    pango_layout_iter_free(iter);
}

static void
set_text(struct canvas *c, const struct canvas_font *f, const char *text)
{
    PangoFontDescription *font = pango_font_description_new();
    char *valid = g_utf8_make_valid(text, -1);

    pango_font_description_set_family_static(font, "sans");
    pango_font_description_set_weight(font, f->bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
    pango_font_description_set_absolute_size(font, f->size * PANGO_SCALE);
    pango_layout_set_font_description(c->layout, font);
    pango_font_description_free(font);
    put_text(c, f, valid);
    if (pango_layout_get_unknown_glyphs_count(c->layout) > 0) {
        find_unknown(c);
        put_text(c, f, valid);
        c->no_font = c->no_font || pango_layout_get_unknown_glyphs_count(c->layout) > 0;
    }
    g_free(valid);
}

static double
width_of_layout(const struct canvas *c)
{
    PangoRectangle logical;

    pango_layout_get_extents(c->layout, NULL, &logical);
    return (double)logical.width / PANGO_SCALE;
}

/* Draws the layout, its base line beginning at the current point. */
static void
show_layout(struct canvas *c, struct rgb colour)
{
    set_colour(c, colour);
    pango_cairo_update_layout(c->cairo, c->layout);
    pango_cairo_show_layout_line(c->cairo, pango_layout_get_line_readonly(c->layout, 0));
    cairo_new_path(c->cairo);
}

double
canvas_text_width(struct canvas *c, const struct canvas_font *f, const char *text)
{
    set_text(c, f, text);
    return width_of_layout(c);
}

void
canvas_text(struct canvas *c, const struct canvas_font *f, double x, double y, double part,
            const char *text)
{
    set_text(c, f, text);
    cairo_move_to(c->cairo, x - part * width_of_layout(c), y);
    show_layout(c, f->colour);
}

void
canvas_text_upwards(struct canvas *c, const struct canvas_font *f, double x, double y,
                    const char *text)
{
    set_text(c, f, text);
    cairo_save(c->cairo);
    cairo_translate(c->cairo, x, y + 0.5 * width_of_layout(c));
    cairo_rotate(c->cairo, -acos(0.0));
    cairo_move_to(c->cairo, 0, 0);
    show_layout(c, f->colour);
    cairo_restore(c->cairo);
}

const char *
canvas_unknown(const struct canvas *c)
{
    return c->unknown->str;
}

const char *
canvas_warning(const struct canvas *c, char *text, size_t size)
{
    if (c->unknown->len == 0)
        return NULL;
    snprintf(text, size,
             "no font has the characters '%s': a question mark is drawn for each; install a font "
             "that has them",
             c->unknown->str);
    return text;
}

/* ---- shapes ---- */

void
canvas_fill(struct canvas *c, double x, double y, double w, double h, struct rgb colour)
{
    set_colour(c, colour);
    cairo_rectangle(c->cairo, x, y, w, h);
    cairo_fill(c->cairo);
}

void
canvas_frame(struct canvas *c, double x, double y, double w, double h, double width,
             struct rgb colour)
{
    set_colour(c, colour);
    cairo_set_line_width(c->cairo, width);
    cairo_set_line_join(c->cairo, CAIRO_LINE_JOIN_MITER);
    cairo_rectangle(c->cairo, x - 0.5 * width, y - 0.5 * width, w + width, h + width);
    cairo_stroke(c->cairo);
}

void
canvas_triangle(struct canvas *c, double corner[3][2], struct rgb colour)
{
    set_colour(c, colour);
    for (int k = 0; k < 3; k++)
        cairo_line_to(c->cairo, corner[k][0], corner[k][1]);
    cairo_close_path(c->cairo);
    cairo_fill(c->cairo);
}

void
canvas_clip(struct canvas *c, double x, double y, double w, double h)
{
    cairo_reset_clip(c->cairo);
    if (w <= 0)
        return;
    cairo_rectangle(c->cairo, x, y, w, h);
    cairo_clip(c->cairo);
}

void
canvas_move(struct canvas *c, double x, double y)
{
    cairo_move_to(c->cairo, x, y);
}

void
canvas_draw_to(struct canvas *c, double x, double y)
{
    cairo_line_to(c->cairo, x, y);
}

void
canvas_stroke(struct canvas *c, double width, struct rgb colour)
{
    set_colour(c, colour);
    cairo_set_line_width(c->cairo, width);
    cairo_set_line_cap(c->cairo, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(c->cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_stroke(c->cairo);
    cairo_set_line_cap(c->cairo, CAIRO_LINE_CAP_BUTT);
}

/* ---- pixels: 32 bits each, 0xXXRRGGBB in the byte order of the machine ---- */

static uint32_t *
row_at(struct canvas *c, size_t y)
{
    size_t stride = (size_t)cairo_image_surface_get_stride(c->surface);

    return (uint32_t *)(void *)(cairo_image_surface_get_data(c->surface) + y * stride);
}

void
canvas_pixel(struct canvas *c, size_t x, size_t y, struct rgb colour)
{
    cairo_surface_flush(c->surface);
    row_at(c, y)[x] = (uint32_t)colour.r << 16 | (uint32_t)colour.g << 8 | colour.b;
    cairo_surface_mark_dirty_rectangle(c->surface, (int)x, (int)y, 1, 1);
}

enum rc_status
canvas_check(const struct canvas *c, struct rc_err *err)
{
    if (c->no_font)
        return rc_err_set(err,
                          "no font can be found: install one, such as DejaVu Sans, or see that "
                          "fontconfig knows it");
    if (cairo_status(c->cairo) != CAIRO_STATUS_SUCCESS)
        return rc_err_set(err, "the figure cannot be drawn: %s",
                          cairo_status_to_string(cairo_status(c->cairo)));
    return RC_OK;
}

enum rc_status
canvas_row(struct canvas *c, size_t y, unsigned char *rgb, struct rc_err *err)
{
    const uint32_t *row;

    if (canvas_check(c, err) != RC_OK)
        return RC_FAIL;
    cairo_surface_flush(c->surface);
    row = row_at(c, y);
    for (size_t x = 0; x < c->w; x++) {
        rgb[3 * x] = (unsigned char)(row[x] >> 16 & 0xff);
        rgb[3 * x + 1] = (unsigned char)(row[x] >> 8 & 0xff);
        rgb[3 * x + 2] = (unsigned char)(row[x] & 0xff);
    }
    return RC_OK;
}
