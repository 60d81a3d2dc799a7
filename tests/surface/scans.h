/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two scans of one surface, whose waves are known everywhere: the second one is turned, moved and tilted, and
 * the first one has worn. */
#ifndef SCANS_H
#define SCANS_H

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "tests/exact.h"
#include "maps.h"

enum {
    WAVES = 160,
    MARKS = 60
};

struct surface {
    double q[WAVES], direction[WAVES], amplitude[WAVES], phase[WAVES];
    /* grooves of honing: angle of the normal, distance from the middle, depth, width (m) */
    double normal[MARKS], distance[MARKS], depth[MARKS], width[MARKS];
};

static inline double
uniform(double low, double high)
{
    return low + (high - low) * (chance() + 1) / 2;
}

static inline double
normal(void)
{
    const double u = (rand() + 1.0) / (RAND_MAX + 2.0), v = (rand() + 1.0) / (RAND_MAX + 2.0);

    return sqrt(-2 * log(u)) * cos(2 * exact_pi * v);
}

/* Waves from 5 um to 120 um with amplitudes that grow with their length, in any direction or nearly along one
 * (a lay); Sq is about 1 um. */
static inline void
make_surface(struct surface *s, double lay)
{
    double sum = 0;

    for (int k = 0; k < WAVES; k++) {
        const double length = 5e-6 * pow(24, (k + 0.5) / WAVES);
        s->q[k] = 2 * exact_pi / length;
        s->direction[k] = lay * uniform(-exact_pi / 2, exact_pi / 2);
        s->phase[k] = uniform(0, 2 * exact_pi);
        s->amplitude[k] = pow(length, 0.7) * fabs(normal());
        sum += s->amplitude[k] * s->amplitude[k] / 2;
    }
    for (int k = 0; k < WAVES; k++)
        s->amplitude[k] *= 1e-6 / sqrt(sum);
    memset(s->depth, 0, sizeof s->depth);
}

/* Roughness with Sq = `size` and waves from 5 um to `longest`, and the grooves of two directions in it, up to
 * 3 `size` deep. */
static inline void
make_honed(struct surface *s, double size, double longest)
{
    make_surface(s, 1);
    for (int k = 0; k < WAVES; k++) {
        s->amplitude[k] *= size / 1e-6;
        s->q[k] = 2 * exact_pi / 5e-6 * pow(5e-6 / longest, (k + 0.5) / WAVES);
    }
    for (int k = 0; k < MARKS; k++) {
        s->normal[k] = (k % 2 ? 1 : -1) * uniform(0.45, 0.55) + exact_pi / 2;
        s->distance[k] = uniform(-150e-6, 150e-6);
        s->depth[k] = uniform(0.3, 3) * size;
        s->width[k] = uniform(2.5e-6, 6e-6);
    }
}

static inline double
surface_height(const struct surface *s, double x, double y)
{
    double h = 0;

    for (int k = 0; k < WAVES; k++)
        h += s->amplitude[k] *
             cos(s->q[k] * (x * cos(s->direction[k]) + y * sin(s->direction[k])) + s->phase[k]);
    for (int k = 0; k < MARKS && s->depth[k] > 0; k++) {
        const double u =
            (x * cos(s->normal[k]) + y * sin(s->normal[k]) - s->distance[k]) / s->width[k];
        h -= s->depth[k] * exp(-u * u);
    }
    return h;
}

/* Where and how the second scan lies, and what else differs. */
struct scans {
    struct rc_shape a, b;
    double shift_x, shift_y, turn; /* m, rad; as struct rc_alignment has them */
    double tilt_x, tilt_y, offset; /* of A over B */
    double noise;                  /* m, of each scan */
    double groove, width;          /* m: depth of a groove in A, and its half width */
    double share, cut;    /* of the nodes of A that lose their tops, and the height (m) above */
    double lay;           /* 1: no lay */
    double below;         /* part of the nodes of B in the fit, 0: all */
    int holes;            /* in each scan */
    double missing, size; /* part of each scan in holes more, and their largest radius, nodes */
};

static inline void
punch_holes(const struct rc_shape *s, int holes, double *h)
{
    for (int q = 0; q < holes; q++) {
        const double i = uniform(0, (double)s->nx), j = uniform(0, (double)s->ny),
                     r = uniform(1, 5);
        for (size_t k = 0; k < s->nx * s->ny; k++)
            if (hypot((double)(k % s->nx) - i, (double)(k / s->nx) - j) < r)
                h[k] = NAN;
    }
}

/* Holes of radii up to `size`, or single nodes, until this part of the map is missing. */
static inline void
punch_share(const struct rc_shape *s, double part, double size, double *h)
{
    const double nodes = (double)(s->nx * s->ny);
    double missing = 0;

    while (missing < part * nodes) {
        const double i = uniform(0, (double)s->nx), j = uniform(0, (double)s->ny),
                     r = uniform(0, size);
        const size_t at = (size_t)j * s->nx + (size_t)i;
        for (size_t k = 0; k < s->nx * s->ny; k++)
            if ((k == at || hypot((double)(k % s->nx) - i, (double)(k / s->nx) - j) < r) &&
                !isnan(h[k])) {
                h[k] = NAN;
                missing++;
            }
    }
}

/* Of the groove: a parabola across, along a line that is inclined to the map. Of tops above a height: all but
 * a twentieth. */
static inline double
worn_depth(const struct surface *s, const struct scans *c, double x, double y)
{
    const double u = (0.94 * x + 0.34 * y - 5e-6) / c->width, v = (-0.34 * x + 0.94 * y) / 70e-6;

    if (c->share > 0)
        return 0.95 * fmax(surface_height(s, x, y) - c->cut, 0);
    return c->groove > 0 && fabs(u) < 1 && fabs(v) < 1 ? c->groove * (1 - u * u) * (1 - v * v) : 0;
}

static inline double
place(size_t k, size_t n, double d)
{
    return ((double)k - (double)(n - 1) / 2) * d;
}

/* The height that leaves its share of the nodes of A above. */
static inline double
find_cut(const struct surface *s, const struct scans *c)
{
    double low = -1e-3, high = 1e-3;

    for (int step = 0; step < 40; step++) {
        const double now = (low + high) / 2;
        size_t above = 0, n = 0;
        for (size_t k = 0; k < c->a.nx * c->a.ny; k += 7, n++)
            above += surface_height(s, place(k % c->a.nx, c->a.nx, c->a.dx),
                                    place(k / c->a.nx, c->a.ny, c->a.dy)) > now;
        if ((double)above > c->share * (double)n)
            low = now;
        else
            high = now;
    }
    return low;
}

static inline void
scan_both(const struct surface *s, const struct scans *c, double *a, double *b)
{
    for (size_t j = 0; j < c->a.ny; j++)
        for (size_t i = 0; i < c->a.nx; i++) {
            const double x = place(i, c->a.nx, c->a.dx), y = place(j, c->a.ny, c->a.dy);
            a[j * c->a.nx + i] = surface_height(s, x, y) - worn_depth(s, c, x, y) + c->offset +
                                 c->tilt_x * x + c->tilt_y * y + c->noise * normal();
        }
    for (size_t j = 0; j < c->b.ny; j++)
        for (size_t i = 0; i < c->b.nx; i++) {
            /* y points down: counterclockwise in the picture */
            const double x = place(i, c->b.nx, c->b.dx), y = place(j, c->b.ny, c->b.dy);
            b[j * c->b.nx + i] = surface_height(s, cos(c->turn) * x + sin(c->turn) * y + c->shift_x,
                                                -sin(c->turn) * x + cos(c->turn) * y + c->shift_y) +
                                 c->noise * normal();
        }
    punch_holes(&c->a, c->holes, a);
    punch_holes(&c->b, c->holes, b);
    punch_share(&c->a, c->missing, c->size, a);
    punch_share(&c->b, c->missing, c->size, b);
}

/* A case of the campaign. */
static inline struct scans
random_scans(size_t nx, size_t ny)
{
    struct scans c = {.a = {nx, ny, 1e-6, 1.1e-6}, .b = {nx, ny, 1e-6, 1.1e-6}, .lay = 1};

    c.b.nx += (size_t)uniform(0, 30) - 15;
    c.b.ny += (size_t)uniform(0, 30) - 15;
    c.shift_x = uniform(-0.25, 0.25) * (double)nx * c.a.dx;
    c.shift_y = uniform(-0.25, 0.25) * (double)ny * c.a.dy;
    c.turn = uniform(-10, 10) * exact_pi / 180;
    c.tilt_x = uniform(-0.02, 0.02);
    c.tilt_y = uniform(-0.02, 0.02);
    c.offset = uniform(-20e-6, 20e-6);
    c.noise = 1e-6 * exp(uniform(log(0.002), log(0.05)));
    c.groove = 1e-6 * exp(uniform(log(0.1), log(5)));
    c.width = uniform(5e-6, 25e-6);
    c.holes = rand() % 20;
    return c;
}

/* 0.1 to 10 % of each scan in holes, instead of other holes: single nodes, or radii up to 5 nodes. */
static inline void
add_shares(struct scans *c)
{
    c->holes = 0;
    c->missing = 0.001 * exp(uniform(0, log(100)));
    c->size = rand() % 2 ? 0 : uniform(1, 5);
}

/* A honed surface that has lost the tops of 30 to 50 % of its nodes, up to several micrometres. */
static inline struct scans
worn_scans(size_t nx, size_t ny, struct surface *s)
{
    struct scans c = random_scans(nx, ny);
    const double size = 1e-6 * exp(uniform(log(0.7), log(5)));

    make_honed(s, size, 5e-6 * exp(uniform(log(2), log(24))));
    c.noise *= size / 1e-6;
    c.groove = 0;
    c.share = uniform(0.3, 0.5);
    c.cut = find_cut(s, &c);
    return c;
}

struct errors {
    double shift, turn;       /* nodes, degrees */
    double volume, bar, worn; /* m^3: error, its bar, the volume itself */
    double on_b, missing;     /* nodes of A on B, and those without a change */
    struct rc_alignment found;
};

static inline bool
lies_on_b(const struct scans *c, double x, double y)
{
    const double u = cos(c->turn) * (x - c->shift_x) - sin(c->turn) * (y - c->shift_y),
                 v = sin(c->turn) * (x - c->shift_x) + cos(c->turn) * (y - c->shift_y);

    return fabs(u) <= place(c->b.nx - 1, c->b.nx, c->b.dx) * (1 + 1e-9) &&
           fabs(v) <= place(c->b.ny - 1, c->b.ny, c->b.dy) * (1 + 1e-9);
}

/* Aligns the scans; the volume counts all nodes of A that lie on B. A refusal has infinite errors. */
static inline struct errors
align_scans(const struct surface *s, const struct scans *c)
{
    double *a = new_map(&c->a), *b = new_map(&c->b), *out = new_map(&c->a);
    struct rc_alignment found;
    struct errors e = {0};
    struct rc_err err;

    scan_both(s, c, a, b);
    if (rc_align(&c->a, a, &c->b, b, c->below > 0 ? c->below : 1, 1, out, &found, &err) != RC_OK) {
        printf("refused: %s\n", err.text);
        free(a);
        free(b);
        free(out);
        return (struct errors){.shift = INFINITY, .turn = INFINITY, .volume = INFINITY};
    }
    for (size_t k = 0; k < c->a.nx * c->a.ny; k++) {
        const double x = place(k % c->a.nx, c->a.nx, c->a.dx),
                     y = place(k / c->a.nx, c->a.ny, c->a.dy);
        if (!lies_on_b(c, x, y))
            continue;
        e.on_b++;
        e.missing += isnan(out[k]);
        e.worn -= worn_depth(s, c, x, y) * c->a.dx * c->a.dy;
    }
    e.shift = hypot((found.shift_x - c->shift_x) / c->a.dx, (found.shift_y - c->shift_y) / c->a.dy);
    e.turn = fabs(found.rotation - c->turn) * 180 / exact_pi;
    e.volume = found.volume - e.worn;
    e.bar = found.volume_error;
    e.found = found;
    free(a);
    free(b);
    free(out);
    return e;
}

#endif
