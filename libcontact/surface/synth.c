/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Surfaces from a formula. */
#include "synth.h"

#include <math.h>

#include "libcontact/common.h"

/* Relative, so that nodes on a rim are included despite the rounding of decimal numbers. */
static const double slack = 1e-9;

static double
place(size_t i, size_t n, double d)
{
    return ((double)i - 0.5 * (double)(n - 1)) * d;
}

void
rc_synth_direction(double degrees, double *c, double *s)
{
    double quarter = remainder(degrees, 360) / 90;

    *c = quarter == -1 || quarter == 1 ? 0 : cos(quarter * RC_PI / 2);
    *s = quarter == 0 || quarter == -2 || quarter == 2 ? 0 : sin(quarter * RC_PI / 2);
}

void
rc_synth_sphere(const struct rc_shape *shape, double radius, double *h)
{
    rc_synth_paraboloid(shape, (struct rc_place){0, 0}, radius, radius, 0, h);
}

void
rc_synth_paraboloid(const struct rc_shape *shape, struct rc_place apex, double radius_1,
                    double radius_2, double direction, double *h)
{
    double c, s;

    rc_synth_direction(direction, &c, &s);
    for (size_t j = 0; j < shape->ny; j++) {
        double y = place(j, shape->ny, shape->dy) - apex.y;
        for (size_t i = 0; i < shape->nx; i++) {
            double x = place(i, shape->nx, shape->dx) - apex.x;
            double along = c * x - s * y, across = s * x + c * y;
            double sag = radius_1 == radius_2
                             ? (x * x + y * y) / (2 * radius_1)
                             : along * along / (2 * radius_1) + across * across / (2 * radius_2);
            h[j * shape->nx + i] = 0 - sag; /* never -0 */
        }
    }
}

/* Distance of a node from the apex. */
static double
distance(const struct rc_shape *shape, struct rc_place apex, size_t i, size_t j)
{
    return hypot(place(i, shape->nx, shape->dx) - apex.x, place(j, shape->ny, shape->dy) - apex.y);
}

void
rc_synth_cone(const struct rc_shape *shape, struct rc_place apex, double slope, double *h)
{
    for (size_t j = 0; j < shape->ny; j++)
        for (size_t i = 0; i < shape->nx; i++)
            h[j * shape->nx + i] = 0 - slope * distance(shape, apex, i, j);
}

void
rc_synth_punch(const struct rc_shape *shape, struct rc_place apex, double radius, double edge,
               double height, double *h)
{
    for (size_t j = 0; j < shape->ny; j++)
        for (size_t i = 0; i < shape->nx; i++) {
            double out = distance(shape, apex, i, j) - radius;
            double depth = out <= slack * radius ? 0
                           : edge > 0            ? fmin(out * out / (2 * edge), height)
                                                 : height;
            h[j * shape->nx + i] = 0 - depth;
        }
}

void
rc_synth_wave(const struct rc_shape *shape, double amplitude, double wavelength_x,
              double wavelength_y, double *h)
{
    for (size_t j = 0; j < shape->ny; j++) {
        double a = amplitude * cos(2 * RC_PI * place(j, shape->ny, shape->dy) / wavelength_y);
        for (size_t i = 0; i < shape->nx; i++)
            h[j * shape->nx + i] =
                a * cos(2 * RC_PI * place(i, shape->nx, shape->dx) / wavelength_x);
    }
}
