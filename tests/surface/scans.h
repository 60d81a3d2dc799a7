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
    WAVES = 160
};

struct surface {
    double q[WAVES], direction[WAVES], amplitude[WAVES], phase[WAVES];
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
}

static inline double
surface_height(const struct surface *s, double x, double y)
{
    double h = 0;

    for (int k = 0; k < WAVES; k++)
        h += s->amplitude[k] *
             cos(s->q[k] * (x * cos(s->direction[k]) + y * sin(s->direction[k])) + s->phase[k]);
    return h;
}

/* Where and how the second scan lies, and what else differs. */
struct scans {
    struct rc_shape a, b;
    double shift_x, shift_y, turn; /* m, rad; as struct rc_alignment has them */
    double tilt_x, tilt_y, offset; /* of A over B */
    double noise;                  /* m, of each scan */
    double groove, width;          /* m: depth of a groove in A, and its half width */
    double lay;                    /* 1: no lay */
    int holes;                     /* in each scan */
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

/* Depth of the groove: a parabola across, along a line that is inclined to the map. */
static inline double
worn_depth(const struct scans *c, double x, double y)
{
    const double u = (0.94 * x + 0.34 * y - 5e-6) / c->width, v = (-0.34 * x + 0.94 * y) / 70e-6;

    return c->groove > 0 && fabs(u) < 1 && fabs(v) < 1 ? c->groove * (1 - u * u) * (1 - v * v) : 0;
}

static inline double
place(size_t k, size_t n, double d)
{
    return ((double)k - (double)(n - 1) / 2) * d;
}

static inline void
scan_both(const struct surface *s, const struct scans *c, double *a, double *b)
{
    for (size_t j = 0; j < c->a.ny; j++)
        for (size_t i = 0; i < c->a.nx; i++) {
            const double x = place(i, c->a.nx, c->a.dx), y = place(j, c->a.ny, c->a.dy);
            a[j * c->a.nx + i] = surface_height(s, x, y) - worn_depth(c, x, y) + c->offset +
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

struct errors {
    double shift, turn;       /* nodes, degrees */
    double volume, bar, worn; /* m^3: error, its bar, the volume itself */
    struct rc_alignment found;
};

/* Aligns the scans; the volume counts the nodes that are measured in both. */
static inline struct errors
align_scans(const struct surface *s, const struct scans *c)
{
    double *a = new_map(&c->a), *b = new_map(&c->b), *out = new_map(&c->a);
    struct rc_alignment found;
    struct errors e = {0};
    struct rc_err err;

    scan_both(s, c, a, b);
    if (rc_align(&c->a, a, &c->b, b, 1, out, &found, &err) != RC_OK)
        fail_msg("%s", err.text);
    for (size_t k = 0; k < c->a.nx * c->a.ny; k++)
        if (!isnan(out[k]))
            e.worn -= worn_depth(c, place(k % c->a.nx, c->a.nx, c->a.dx),
                                 place(k / c->a.nx, c->a.ny, c->a.dy)) *
                      c->a.dx * c->a.dy;
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
