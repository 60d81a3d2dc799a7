#include "panels.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "page.h"

enum {
    LEAST = 40 /* pixels of a panel's width */
};

/* The whole is a page whose plot is all panels together; each panel is one within it. */
struct sheet {
    const struct panels *panels;
    struct page page;
    size_t columns, rows;
    double w, h, across, down; /* of a panel, and from one to the next */
    struct canvas_font label;  /* smaller where panels are narrow */
};

size_t
panels_columns(size_t n, double aspect)
{
    const double page = 1.4; /* width over height */
    double least = INFINITY;
    size_t best = 1;

    for (size_t columns = 1; columns <= n; columns++) {
        size_t rows = (n + columns - 1) / columns;
        double empty = (double)(columns * rows - n) / (double)n;
        double cost = fabs(log(aspect * (double)columns / (double)rows / page)) + 2 * empty;

        if (cost < least - 1e-9) {
            least = cost;
            best = columns;
        }
    }
    return best;
}

/* The room around the panels depends on the marks, and these depend on the size of a panel. */
static enum rc_status
lay_out(struct sheet *s, struct rc_err *err)
{
    struct page *p = &s->page;
    double u = p->u, aspect = page_aspect(p->f), text_w = (double)p->w - 48 * u, above;

    p->distorted = aspect != (p->f->right - p->f->left) / (p->f->bottom - p->f->top);
    s->w = ((double)p->w - 260 * u) / (double)s->columns;
    for (int round_k = 0; round_k < 3; round_k++) {
        p->plot_w = (size_t)fmax(s->w, 1);
        p->plot_h = (size_t)fmax(s->w / aspect, 1);
        page_measure(p);
        p->left_w = 24 * u + 1.3 * p->large.size + 8 * u + p->down.widest + 14 * u;
        p->right_w = page_right(p);
        s->across = fmax(22 * u + p->gutter, p->across.widest + 14 * u); /* marks at both edges */
        s->w =
            floor(((double)p->w - p->left_w - p->right_w - s->across * (double)(s->columns - 1)) /
                  (double)s->columns);
        if (s->w < LEAST)
            return rc_err_set(err,
                              "%zu columns on %zu pixels leave %d for each: ask for fewer "
                              "columns or a larger --width",
                              s->columns, p->w, s->w < 0 ? 0 : (int)s->w);
    }
    s->h = round(s->w / aspect);
    s->across += s->w;
    s->down = s->h + 2.1 * p->small.size;
    page_words(p, text_w);
    page_legend(p, text_w);
    above = page_words_height(p) + 2.1 * p->small.size;
    p->plot_x = (size_t)round(p->left_w);
    p->plot_y = (size_t)round(above);
    p->plot_w = (size_t)(s->w + s->across * (double)(s->columns - 1));
    p->plot_h = (size_t)(s->h + s->down * (double)(s->rows - 1));
    p->h = (size_t)ceil(above + (double)p->plot_h + page_marks(p) + p->legend_h + 22 * u);
    return RC_OK;
}

/* Axes stand left of the first column and under the lowest panel of each. */
static enum rc_status
draw_panel(struct sheet *s, size_t k, struct rc_err *err)
{
    const struct panel *panel = &s->panels->panel[k];
    struct page *p = malloc(sizeof *p);
    size_t column = k % s->columns, row = k / s->columns;
    char label[LINE];
    enum rc_status status;

    if (p == NULL)
        return rc_err_set(err, "out of memory for a figure");
    *p = s->page;
    p->f = &panel->figure;
    p->g = panel->grid;
    p->plot_x += (size_t)(s->across * (double)column);
    p->plot_y += (size_t)(s->down * (double)row);
    p->plot_w = (size_t)s->w;
    p->plot_h = (size_t)s->h;
    snprintf(label, sizeof label, "%s", panel->label);
    page_shorten(p, &s->label, s->w, label);
    canvas_text(p->c, &s->label, (double)p->plot_x, (double)p->plot_y - 0.45 * s->page.small.size,
                0, label);
    status = page_map(p, column == 0, k + s->columns >= s->panels->n, err);
    free(p);
    return status;
}

static void
set_label(struct sheet *s)
{
    double widest = 1;

    s->label = s->page.small;
    s->label.bold = true;
    for (size_t k = 0; k < s->panels->n; k++)
        widest = fmax(widest, canvas_text_width(s->page.c, &s->label, s->panels->panel[k].label));
    s->label.size *= fmin(1, fmax(0.6, 0.97 * s->w / widest));
}

static enum rc_status
draw(struct sheet *s, struct rc_err *err)
{
    set_label(s);
    page_heading(&s->page);
    for (size_t k = 0; k < s->panels->n; k++)
        if (draw_panel(s, k, err) != RC_OK)
            return RC_FAIL;
    page_bar(&s->page);
    return canvas_check(s->page.c, err);
}

/* Laid out; NULL when memory is short or the page too narrow. */
static struct sheet *
sheet_new(const struct panels *panels, struct rc_err *err)
{
    struct sheet *s = calloc(1, sizeof *s);
    enum rc_status status;

    if (s == NULL) {
        rc_err_set(err, "out of memory for a figure");
        return NULL;
    }
    s->panels = panels;
    s->columns = panels->columns;
    s->rows = (panels->n + s->columns - 1) / s->columns;
    s->page.f = panels->figure;
    s->page.g = panels->panel[0].grid;
    page_size(&s->page, PANELS_WIDTH);
    if ((s->page.c = page_canvas(&s->page, 1, 1, err)) != NULL) { /* to measure text on */
        status = lay_out(s, err);
        canvas_free(s->page.c);
        if (status == RC_OK)
            return s;
    }
    free(s);
    return NULL;
}

struct canvas *
panels_draw(const struct panels *panels, struct rc_err *err)
{
    struct sheet *s = sheet_new(panels, err);
    struct canvas *drawn = NULL;

    if (s == NULL)
        return NULL;
    if ((s->page.c = page_canvas(&s->page, s->page.w, s->page.h, err)) == NULL)
        goto done;
    if (draw(s, err) == RC_OK)
        drawn = s->page.c;
    else
        canvas_free(s->page.c);
done:
    free(s);
    return drawn;
}
