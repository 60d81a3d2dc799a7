/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Only this file uses Pango, and only this file and cairo_page.c use cairo.
 */
#include "lettering.h"

#include <pango/pangocairo.h>
#include <stdlib.h>
#include <string.h>

struct lettering {
    cairo_surface_t *surface; /* nothing is drawn on this surface, but a layout needs one */
    cairo_t *cairo;
    PangoLayout *layout;
    char *family, *found;
    GString *unknown;
    bool no_font;
};

#ifdef RC_OWN_FONTS
#include <fontconfig/fontconfig.h>
#include <unistd.h>

/* Fonts that come with the program, for machines without any. They come from the settings of the system,
 * where it has some, and from the folder RC_OWN_FONTS. This is a path from the folder of the program. */
static void
own_fonts(void)
{
    char path[4096];
    ssize_t n = readlink("/proc/self/exe", path, sizeof path - sizeof "/" RC_OWN_FONTS);
    bool system = getenv("FONTCONFIG_FILE") != NULL || access("/etc/fonts/fonts.conf", R_OK) == 0;
    FcConfig *config = system ? FcInitLoadConfig() : FcConfigCreate();

    if (n <= 0 || config == NULL)
        return;
    path[n] = '\0';
    strcpy(strrchr(path, '/'), "/" RC_OWN_FONTS);
    if (!system) {
        static const char none[] = "<fontconfig><dir>/usr/share/fonts</dir><cachedir "
                                   "prefix='xdg'>fontconfig</cachedir></fontconfig>";
        FcConfigParseAndLoadFromMemory(config, (const FcChar8 *)none, FcTrue);
    }
    FcConfigAppFontAddDir(config, (const FcChar8 *)path);
    FcConfigBuildFonts(config);
    FcConfigSetCurrent(config);
}
#endif

/* Grey antialiasing and unrounded widths: text does not depend on the screen of the machine. */
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

struct lettering *
lettering_new(void)
{
    struct lettering *l = calloc(1, sizeof *l);

    if (l == NULL)
        return NULL;
#ifdef RC_OWN_FONTS
    own_fonts();
#endif
    l->surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, 1);
    l->cairo = cairo_create(l->surface);
    l->layout = new_layout(l->cairo);
    l->unknown = g_string_new(NULL);
    l->family = g_strdup("sans");
    return l;
}

void
lettering_free(struct lettering *l)
{
    if (l == NULL)
        return;
    g_object_unref(l->layout);
    g_string_free(l->unknown, TRUE);
    cairo_destroy(l->cairo);
    cairo_surface_destroy(l->surface);
    g_free(l->family);
    g_free(l->found);
    free(l);
}

static PangoFontDescription *
describe(const struct lettering *l, const struct canvas_font *f)
{
    PangoFontDescription *font = pango_font_description_new();

    pango_font_description_set_family(font, l->family);
    pango_font_description_set_weight(font, f->bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
    pango_font_description_set_absolute_size(font, f->size * PANGO_SCALE);
    return font;
}

void
lettering_set_family(struct lettering *l, const char *family)
{
    g_free(l->family);
    g_free(l->found);
    l->family = g_strdup(family);
    l->found = NULL;
}

const char *
lettering_family(struct lettering *l)
{
    PangoFontDescription *wanted, *got;
    PangoFont *font;

    if (l->found != NULL)
        return l->found;
    wanted = describe(l, &(struct canvas_font){.size = 20});
    font = pango_context_load_font(pango_layout_get_context(l->layout), wanted);
    pango_font_description_free(wanted);
    if (font == NULL)
        return l->family;
    got = pango_font_describe(font);
    l->found = g_strdup(pango_font_description_get_family(got));
    pango_font_description_free(got);
    g_object_unref(font);
    return l->found;
}

/* ---- raised characters ---- */

/* The plain character of a raised one; 0: it is not raised. */
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

static bool
is_unknown(const struct lettering *l, gunichar character)
{
    return g_utf8_strchr(l->unknown->str, -1, character) != NULL;
}

bool
lettering_piece(const struct lettering *l, const char *text, size_t *at, char **letters,
                bool *raised)
{
    GString *piece = g_string_new(NULL);
    char *valid = g_utf8_make_valid(text, -1);
    const char *s = valid + *at;

    for (bool first = true; *s != '\0'; s = g_utf8_next_char(s), first = false) {
        gunichar own = g_utf8_get_char(s), low = is_unknown(l, own) ? 0 : lowered(own);

        if (first)
            *raised = low != 0;
        else if (*raised != (low != 0))
            break;
        g_string_append_unichar(piece, low != 0 ? low : is_unknown(l, own) ? '?' : own);
    }
    *at = (size_t)(s - valid);
    g_free(valid);
    /* passed on, not copied: if a copy failed for lack of memory, words would be missing */
    *letters = g_string_free(piece, piece->len == 0);
    return *letters != NULL;
}

/* ---- layout ---- */

static void
add_raise(PangoAttrList *list, guint from, guint to, const struct canvas_font *f)
{
    PangoAttribute *scale = pango_attr_scale_new(LETTERING_RAISED);
    PangoAttribute *rise = pango_attr_rise_new((int)(LETTERING_RISE * f->size * PANGO_SCALE));

    scale->start_index = rise->start_index = from;
    scale->end_index = rise->end_index = to;
    pango_attr_list_insert(list, scale);
    pango_attr_list_insert(list, rise);
}

/* Puts the text into the layout. Raised digits become plain digits set higher, because raised digits of fonts
 * differ in design. A question mark replaces a character that no font has. */
static void
put_text(struct lettering *l, const struct canvas_font *f, const char *text)
{
    PangoAttrList *list = pango_attr_list_new();
    GString *plain = g_string_new(NULL);
    size_t at = 0;
    char *letters;
    bool raised = false;

    while (lettering_piece(l, text, &at, &letters, &raised)) {
        gsize from = plain->len;

        g_string_append(plain, letters);
        if (raised)
            add_raise(list, (guint)from, (guint)plain->len, f);
        free(letters);
    }
    pango_layout_set_text(l->layout, plain->str, (int)plain->len);
    pango_layout_set_attributes(l->layout, list);
    pango_attr_list_unref(list);
    g_string_free(plain, TRUE);
}

/* Adds the characters of the layout that have no glyph to l->unknown. */
static void
find_unknown(struct lettering *l)
{
    PangoLayoutIter *iter = pango_layout_get_iter(l->layout);

    do {
        const PangoLayoutRun *run = pango_layout_iter_get_run_readonly(iter);

        for (int k = 0; run != NULL && k < run->glyphs->num_glyphs; k++) {
            PangoGlyph glyph = run->glyphs->glyphs[k].glyph;
            gunichar character = glyph & ~PANGO_GLYPH_UNKNOWN_FLAG;

            if (glyph & PANGO_GLYPH_UNKNOWN_FLAG && glyph != PANGO_GLYPH_EMPTY &&
                !is_unknown(l, character))
                g_string_append_unichar(l->unknown, character);
        }
    } while (pango_layout_iter_next_run(iter));
    pango_layout_iter_free(iter);
}

static void
set_text(struct lettering *l, const struct canvas_font *f, const char *text)
{
    PangoFontDescription *font = describe(l, f);

    pango_layout_set_font_description(l->layout, font);
    pango_font_description_free(font);
    put_text(l, f, text);
    if (pango_layout_get_unknown_glyphs_count(l->layout) > 0) {
        find_unknown(l);
        put_text(l, f, text);
        l->no_font = l->no_font || pango_layout_get_unknown_glyphs_count(l->layout) > 0;
    }
}

double
lettering_width(struct lettering *l, const struct canvas_font *f, const char *text)
{
    PangoRectangle logical;

    pango_cairo_update_layout(l->cairo, l->layout);
    set_text(l, f, text);
    pango_layout_get_extents(l->layout, NULL, &logical);
    return (double)logical.width / PANGO_SCALE;
}

void
lettering_show(struct lettering *l, void *cairo, const struct canvas_font *f, const char *text)
{
    set_text(l, f, text);
    cairo_set_source_rgb(cairo, f->colour.r / 255.0, f->colour.g / 255.0, f->colour.b / 255.0);
    pango_cairo_update_layout(cairo, l->layout);
    pango_cairo_show_layout_line(cairo, pango_layout_get_line_readonly(l->layout, 0));
    cairo_new_path(cairo);
}

const char *
lettering_unknown(const struct lettering *l)
{
    return l->unknown->str;
}

bool
lettering_has_no_font(const struct lettering *l)
{
    return l->no_font;
}
