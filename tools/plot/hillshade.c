/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "raster.h"

#include <math.h>
#include <stdlib.h>

/* The value of a cell: 0 without contact, NaN if missing. */
static double
value_at(const struct raster *r, size_t i, size_t j)
{
    size_t k = j * r->w + i;

    return isnan(r->v[k]) && r->none[k] > 0 ? 0 : r->v[k];
}

/* Slopes to the right and downwards, per width of a cell, from valid neighbours. */
static void
slopes(const struct raster *r, double aspect, size_t i, size_t j, double *right, double *down)
{
    size_t i0 = i > 0 ? i - 1 : i, i1 = i + 1 < r->w ? i + 1 : i;
    size_t j0 = j > 0 ? j - 1 : j, j1 = j + 1 < r->h ? j + 1 : j;
    double here = value_at(r, i, j), a = value_at(r, i0, j), b = value_at(r, i1, j),
           c = value_at(r, i, j0), d = value_at(r, i, j1);

    *right = i1 == i0 ? 0 : ((isnan(b) ? here : b) - (isnan(a) ? here : a)) / (double)(i1 - i0);
    *down = j1 == j0
                ? 0
                : ((isnan(d) ? here : d) - (isnan(c) ? here : c)) / ((double)(j1 - j0) * aspect);
}

/* Lambert's cosine law, with light at 45 degrees over the upper left corner. */
static double
brightness(double right, double down)
{
    const double level = 0.5, above = sqrt(0.5); /* components of the light: (-1/2, -1/2, 0.71) */
    double cosine = (level * right + level * down + above) / sqrt(1 + right * right + down * down);

    return fmin(fmax(0.35 + 0.65 * cosine / above, 0.35), 1.4);
}

float *
hillshade_new(const struct raster *r, double aspect, struct rc_err *err)
{
    const double steep = 0.7; /* the RMS slope is scaled to this value */
    float *shade = malloc(r->w * r->h * sizeof *shade);
    double sum = 0, right, down, factor;
    size_t n = 0;

    if (shade == NULL)
        return rc_err_null(err, "out of memory for the shades of a map");
    for (size_t j = 0; j < r->h; j++)
        for (size_t i = 0; i < r->w; i++) {
            slopes(r, aspect, i, j, &right, &down);
            if (isfinite(right) && isfinite(down)) {
                sum += right * right + down * down;
                n++;
            }
        }
    factor = sum > 0 ? steep / sqrt(sum / (double)n) : 0;
    for (size_t j = 0; j < r->h; j++)
        for (size_t i = 0; i < r->w; i++) {
            slopes(r, aspect, i, j, &right, &down);
            shade[j * r->w + i] = isfinite(right) && isfinite(down)
                                      ? (float)brightness(factor * right, factor * down)
                                      : 1;
        }
    return shade;
}
