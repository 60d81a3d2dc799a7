/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * K and its inverse on the whole transformed grid. The padded grid is treated as periodic, with each offset
 * of the kernel counted once, by the shortest way around. Pressures on the map then act on the map as on the
 * half-space, whatever the padding. Each wave has its own factor, whose reciprocal is A.
 *
 * A must be positive. For uniform bodies K is positive with twice the sides. For layers that bend over
 * lengths near those of the map it becomes so with more padding.
 */
#include <math.h>
#include <stdlib.h>

#include "operator.h"

enum {
    SIDES = 5 /* trials, in halves of the map's sides */
};
static const size_t halves[SIDES] = {4, 6, 8, 12, 16};

struct own {
    struct rc_whole whole;
    const struct rc_ranks *ranks; /* share the grid */
    struct rc_solids bodies;
    struct rc_fft *fft, *rough; /* transforms in double and in single precision */
    struct rc_spectrum *kernel, *inverse, *rough_kernel, *rough_inverse;
};

static struct rc_shape
grid_of(const struct rc_shape *s, struct rc_boundary boundary, size_t half)
{
    struct rc_shape grid = *s;

    if (!boundary.x)
        grid.nx = rc_fourier_length((s->nx * half + 3) / 4, 2);
    if (!boundary.y)
        grid.ny = rc_fourier_length((s->ny * half + 3) / 4, 4);
    return grid;
}

/* Frees transforms and spectra, for example before another padding is tried. */
static void
clear(struct own *w)
{
    struct own none = {.whole = w->whole, .ranks = w->ranks, .bodies = w->bodies};

    rc_fft_free(w->rough); /* uses memory of the other */
    rc_fft_free(w->fft);
    rc_spectrum_free(w->kernel);
    rc_spectrum_free(w->inverse);
    rc_spectrum_free(w->rough_kernel);
    rc_spectrum_free(w->rough_inverse);
    *w = none;
}

void
rc_whole_free(struct rc_whole *whole)
{
    struct own *w = (struct own *)whole;

    if (w == NULL)
        return;
    clear(w);
    rc_solids_free(&w->bodies);
    free(w);
}

RC_OWNER(rc_whole)

struct extremes {
    double least, most;
};

static void
see_column(void *ctx, size_t i, size_t n, double *column)
{
    struct extremes *e = ctx;
    double least = INFINITY, most = 0;

    for (size_t j = 0; j < n; j++)
        if (i + j > 0 || column[j] != 0) {
            least = fmin(least, column[j]);
            most = fmax(most, column[j]);
        }
#pragma omp critical
    {
        e->least = fmin(e->least, least);
        e->most = fmax(e->most, most);
    }
}

/* The kernel's spectrum in one precision, on the map or the padded grid. */
static struct rc_spectrum *
spectrum_of(const struct own *w, const struct rc_fft *fft, struct extremes *seen,
            struct rc_err *err)
{
    const struct rc_surface surface = {&w->bodies, w->whole.length, w->whole.modulus};
    const struct rc_kernel kernel = rc_surface_kernel(&surface);
    RC_OWN(rc_spectrum, k) = rc_spectrum_new(fft, err);
    enum rc_status status;

    if (k == NULL)
        return NULL;
    struct rc_boundary boundary = w->whole.boundary;

    boundary.datum /= w->whole.length;
    if (rc_has_mean(boundary))
        status = rc_spectrum_set_by(k, fft, &kernel, boundary, see_column, seen, err);
    else
        status = rc_spectrum_set(k, fft, &kernel, err);
    return status == RC_OK ? rc_give(&k) : NULL;
}

static enum rc_status
plan(struct own *w, size_t threads, struct extremes *seen, struct rc_err *err)
{
    const struct rc_shape *g = &w->whole.grid;
    const struct rc_shape unit = {g->nx, g->ny, g->dx / w->whole.length, g->dy / w->whole.length};
    struct extremes again = {INFINITY, 0};

    if ((w->fft = rc_fft_new(w->ranks, NULL, &unit, RC_PERIODIC, RC_DOUBLE, threads, err)) ==
            NULL ||
        (w->rough = rc_fft_new(w->ranks, w->fft, &unit, RC_PERIODIC, RC_SINGLE, threads, err)) ==
            NULL ||
        (w->kernel = spectrum_of(w, w->fft, seen, err)) == NULL ||
        (w->inverse = rc_spectrum_new_reciprocal(w->fft, w->kernel, err)) == NULL ||
        (w->rough_kernel = spectrum_of(w, w->rough, &again, err)) == NULL ||
        (w->rough_inverse = rc_spectrum_new_reciprocal(w->rough, w->rough_kernel, err)) == NULL)
        return RC_FAIL;
    w->whole.mean = rc_spectrum_total(w->kernel);
    seen->least = -rc_ranks_most(w->ranks, -seen->least); /* of the columns of all ranks */
    seen->most = rc_ranks_most(w->ranks, seen->most);
    return RC_OK;
}

/* On a periodic map the longest wave is the most compliant: 2/(E* q), q = 2 pi/L. */
static double
most_of(const struct own *w)
{
    const struct rc_shape *s = &w->whole.map;
    double side = fmax(s->dx * (double)s->nx, s->dy * (double)s->ny);

    return side / w->whole.length / RC_PI * w->whole.modulus /
           rc_solids_modulus(&w->bodies, 2 * RC_PI / side);
}

static double
diagonal_of(const struct rc_solids *bodies, const struct rc_shape *s, double length, double modulus)
{
    const struct rc_surface surface = {bodies, length, modulus};
    const struct rc_kernel kernel = rc_surface_kernel(&surface);
    const struct rc_lattice cell = {s->dx / length, s->dy / length, 1, 1};
    double self;

    kernel.rows(kernel.of, &cell, 1, 0, 1, &self);
    return self;
}

enum rc_status
rc_whole_scales(const struct rc_shape *shape, const struct rc_pair *pair, double *modulus,
                double *diagonal, struct rc_err *err)
{
    double length = sqrt(shape->dx) * sqrt(shape->dy);
    struct rc_solids bodies;
    enum rc_status status = rc_solids_new(&bodies, pair, NULL, NULL, err);

    if (status == RC_OK) {
        *modulus = rc_solids_modulus(&bodies, RC_PI / length);
        *diagonal = diagonal_of(&bodies, shape, length, *modulus);
    }
    rc_solids_free(&bodies);
    return status;
}

/* With a short datum a load that covers the padded map displaces it away from the load. */
static enum rc_status
datum_suffices(const struct rc_whole *whole, struct rc_err *err)
{
    const struct rc_shape *g = &whole->grid;

    if (rc_repeats(whole->boundary) != 1 || whole->mean > 0)
        return RC_OK;
    return rc_err_set(
        err,
        "datum %g m: with adhesion it must not be so far below the length of the map across the "
        "axis that repeats: take a datum of %g m, which changes neither pressures nor gaps",
        whole->boundary.datum,
        (whole->boundary.x ? g->dy * (double)g->ny : g->dx * (double)g->nx) / 2);
}

struct rc_whole *
rc_whole_new(const struct rc_shape *shape, const struct rc_operator_options *o, struct rc_err *err)
{
    double length = sqrt(shape->dx) * sqrt(shape->dy);
    RC_OWN(rc_whole, whole) = NULL;
    struct own *w;

    if (rc_shape_check(shape, err) != RC_OK || rc_pair_check(o->pair, err) != RC_OK)
        return NULL;
    w = calloc(1, sizeof *w);
    whole = w != NULL ? &w->whole : NULL;
    if (rc_ranks_need(o->ranks, w != NULL, err, "out of memory for a plan") != RC_OK ||
        rc_ranks_agree(o->ranks, rc_solids_new(&w->bodies, o->pair, NULL, NULL, err), err) != RC_OK)
        return NULL;
    w->ranks = o->ranks;
    w->whole = (struct rc_whole){.map = *shape,
                                 .boundary = rc_boundary_on(shape, o->boundary),
                                 .length = length,
                                 .modulus = rc_solids_modulus(&w->bodies, RC_PI / length)};
    w->whole.diagonal = diagonal_of(&w->bodies, shape, length, w->whole.modulus);
    for (size_t k = 0; k < SIDES; k++) {
        struct extremes seen = {INFINITY, 0};
        w->whole.grid = grid_of(shape, o->boundary, halves[k]);
        w->whole.rows = rc_rows_of(o->ranks, &w->whole.grid);
        w->whole.threads = rc_useful_threads(&w->whole.grid, o->threads);
        if (plan(w, o->threads, &seen, err) != RC_OK || datum_suffices(&w->whole, err) != RC_OK)
            return NULL;
        w->whole.most = rc_has_mean(o->boundary) ? seen.most : most_of(w);
        if (seen.least > 0)
            return rc_give(&whole);
        clear(w);
    }
    return rc_err_null(
        err,
        "these layers bend over lengths beyond the map of %g x %g m, so that its longest "
        "waves have no positive stiffness: take a larger map or softer layers",
        shape->dx * (double)shape->nx, shape->dy * (double)shape->ny);
}

void
rc_whole_apply(struct rc_whole *whole, const double *p, double *u)
{
    struct own *w = (struct own *)whole;

    rc_fft_apply(w->fft, w->kernel, p, u);
}

void
rc_whole_pin(struct rc_whole *whole, double stiffness)
{
    struct own *w = (struct own *)whole;

    rc_spectrum_add(w->rough_kernel, w->rough, true, stiffness, 0);
}

void
rc_whole_rows(struct rc_whole *whole, enum rc_whole_factor which, rc_row *in, rc_row *out,
              void *ctx)
{
    struct own *w = (struct own *)whole;
    const struct rc_spectrum *factors[] = {[RC_WHOLE_INVERSE] = w->inverse,
                                           [RC_WHOLE_ROUGH] = w->rough_kernel,
                                           [RC_WHOLE_ROUGH_INVERSE] = w->rough_inverse};
    rc_row *rows[] = {in, out};

    rc_fft_chain(which == RC_WHOLE_INVERSE ? w->fft : w->rough, 1, &factors[which], rows, ctx);
}
