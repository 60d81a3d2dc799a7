/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Feature parameters of ISO 25178-2. Hills are found by watershed and pruned by Wolf's rule; then follow
 * their peaks, heights and areas. Dales are the hills of the map upside down.
 */
#include <stdlib.h>

#include "hills.h"
#include "libcontact/memory.h"

static const double prune = 0.05; /* share of Sz */

enum {
    FIVE = 5 /* peaks of S5p, pits of S5v */
};

/* Figures of hills, or of dales. */
struct figures {
    double density, curvature, five, area;
};

/* Minus half the sum of both second differences: positive on a peak. */
static double
curvature(const struct rc_field *f, size_t k)
{
    const struct rc_shape *s = &f->shape;
    double z = rc_field_height(f, k);
    double xx = (rc_field_height(f, rc_field_neighbour(f, k, 3)) - 2 * z +
                 rc_field_height(f, rc_field_neighbour(f, k, 4))) /
                (s->dx * s->dx);
    double yy = (rc_field_height(f, rc_field_neighbour(f, k, 1)) - 2 * z +
                 rc_field_height(f, rc_field_neighbour(f, k, 6))) /
                (s->dy * s->dy);

    return -0.5 * (xx + yy);
}

/* True if a neighbour is missing. */
static bool
on_edge(const struct rc_field *f, size_t k)
{
    for (int d = 0; d < RC_NEIGHBOURS; d++)
        if (rc_field_neighbour(f, k, d) == SIZE_MAX)
            return true;
    return false;
}

/* Inserts a height into the sorted list of the highest ones. */
static void
place(double highest[FIVE], double z)
{
    size_t k = FIVE - 1;

    if (!(z > highest[k]))
        return;
    for (; k > 0 && z > highest[k - 1]; k--)
        highest[k] = highest[k - 1];
    highest[k] = z;
}

static void
add_up(const struct rc_field *f, const struct rc_hills *s, double mean, struct figures *to)
{
    struct rc_total bend = {0}, top = {0}, area = {0};
    size_t peaks = 0, closed = 0;
    double cell = f->shape.dx * f->shape.dy, highest[FIVE];

    for (size_t k = 0; k < FIVE; k++)
        highest[k] = -INFINITY;
    for (size_t a = 0; a < s->n; a++) {
        const struct rc_hill *h = &s->hill[a];

        if (h->goes != a)
            continue;
        if (!h->open) {
            rc_total_add(&area, (double)h->nodes);
            closed++;
        }
        if (on_edge(f, h->peak))
            continue;
        rc_total_add(&bend, curvature(f, h->peak));
        place(highest, h->top);
        peaks++;
    }
    for (size_t k = 0; k < FIVE; k++)
        rc_total_add(&top, highest[k] - f->sign * mean);
    to->density = (double)peaks / ((double)f->n * cell);
    to->curvature = peaks > 0 ? rc_total_value(&bend) / (double)peaks : NAN;
    to->five = peaks >= FIVE ? rc_total_value(&top) / FIVE : NAN;
    to->area = closed > 0 ? rc_total_value(&area) / (double)closed * cell : NAN;
}

static enum rc_status
measure(struct rc_field *f, double sign, double mean, struct figures *to)
{
    struct rc_hills hills = {NULL, 0};
    enum rc_status status;

    f->sign = sign;
    status = rc_hills_find(f, &hills);
    if (status == RC_OK)
        status = rc_hills_prune(f, &hills);
    if (status == RC_OK)
        add_up(f, &hills, mean, to);
    free(hills.hill);
    return status;
}

/* Sets f->n, the range of the measured heights, and their mean. */
static void
survey(struct rc_field *f, double *mean)
{
    struct rc_total sum = {0};
    double least = INFINITY, most = -INFINITY;

    f->n = 0;
    for (size_t k = 0; k < f->shape.nx * f->shape.ny; k++) {
        if (!rc_there(f->h[k]))
            continue;
        f->n++;
        rc_total_add(&sum, f->h[k]);
        least = f->h[k] < least ? f->h[k] : least;
        most = f->h[k] > most ? f->h[k] : most;
    }
    *mean = rc_total_value(&sum) / (double)f->n;
    f->highest = most;
    f->range = f->n > 0 ? most - least : 0;
}

#define FIGURE(member) RC_FIGURE(struct rc_features, member)
/* clang-format off */
const struct rc_figure rc_figures_features[] = {
    {FIGURE(spd), "1/m2", "Spd"}, {FIGURE(svd), "1/m2", "Svd"}, {FIGURE(spc), "1/m", "Spc"},
    {FIGURE(s5p), "m", "S5p"}, {FIGURE(s5v), "m", "S5v"}, {FIGURE(s10z), "m", "S10z"},
    {FIGURE(sha), "m2", "Sha"}, {FIGURE(sda), "m2", "Sda"},
    {0},
};
/* clang-format on */

enum rc_status
rc_features(const struct rc_shape *shape, const double *h, const struct rc_surface_options *options,
            struct rc_features *a, struct rc_err *err)
{
    struct rc_field f = {.h = h, .boundary = options->boundary};
    RC_ENDS(rc_store_free) struct rc_store own = {0};
    struct figures hills = {0, NAN, NAN, NAN}, dales = {0, NAN, NAN, NAN};
    double mean;

    *a = (struct rc_features){NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    if (rc_shape_check(shape, err) != RC_OK)
        return RC_FAIL;
    f.shape = *shape;
    survey(&f, &mean);
    if (shape->nx < 3 || shape->ny < 3 || !(f.range > 0))
        return RC_OK;
    f.least = prune * f.range;
    f.threads = rc_useful_threads(shape, options->threads);
    f.mark = rc_store_take(&own, shape->nx * shape->ny, sizeof *f.mark);
    f.hill = rc_store_take(&own, shape->nx * shape->ny, sizeof *f.hill);
    if (own.failed || measure(&f, 1, mean, &hills) != RC_OK ||
        measure(&f, -1, mean, &dales) != RC_OK)
        return rc_err_set(err, "out of memory for the hills of %zu x %zu nodes", shape->nx,
                          shape->ny);
    *a = (struct rc_features){.spd = hills.density,
                              .svd = dales.density,
                              .spc = hills.curvature,
                              .s5p = hills.five,
                              .s5v = dales.five,
                              .s10z = hills.five + dales.five,
                              .sha = hills.area,
                              .sda = dales.area};
    return RC_OK;
}
