/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The range of the colours.
 */
#include "render.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* The per cent of the values beyond each end of the colours if an outlier would take most of the range. */
#define BEYOND 0.5

enum {
    PART = 16, /* bits of a value in one pass of the selection */
    PARTS = 1 << PART
};

static enum unit
unit_of(const struct rc_grid *g)
{
    for (enum unit u = UNIT_M; u <= UNIT_PA; u++)
        if (strcmp(unit_name(u), g->unit) == 0)
            return u;
    return UNIT_NONE;
}

/* ---- percentiles ---- */

/* All frames of a picture have one range. */
struct frames_of {
    struct rc_grid *const *grid;
    const struct rc_grid *const *touch; /* contact of each frame; NULL: unknown */
    size_t n;
};

/* The frame that selects the values of frame m: of a pressure only nodes in contact count. NULL: all. */
static const double *
touch_of(const struct frames_of *f, size_t m)
{
    bool pressure = strcmp(f->grid[m]->channel, "pressure") == 0;

    return pressure && f->touch[m] != NULL ? f->touch[m]->v : NULL;
}

static bool
counts(const double *touch, const struct rc_grid *g, size_t k)
{
    return isfinite(g->v[k]) && (touch == NULL || rc_in_contact(touch[k]));
}

/* Converts a value to bits that have the order of the values. */
static uint64_t
bits_of(double v)
{
    uint64_t bits;

    v += 0.0; /* -0 is 0 */
    memcpy(&bits, &v, sizeof bits);
    return bits >> 63 != 0 ? ~bits : bits | 1ULL << 63;
}

static double
value_of(uint64_t bits)
{
    double v;

    bits = bits >> 63 != 0 ? bits & ~(1ULL << 63) : ~bits;
    memcpy(&v, &bits, sizeof v);
    return v;
}

/* Histogram of PART bits, from bit `shift` on, of the values whose higher bits equal `above`. */
static void
count_parts(const struct frames_of *f, uint64_t above, int shift, size_t count[PARTS])
{
    const uint64_t mask = shift + PART < 64 ? ~0ULL << (shift + PART) : 0;

    memset(count, 0, PARTS * sizeof *count);
    for (size_t m = 0; m < f->n; m++) {
        const struct rc_grid *g = f->grid[m];
        const double *touch = touch_of(f, m);

        for (size_t i = 0; i < g->nx * g->ny; i++)
            if (counts(touch, g, i) && (bits_of(g->v[i]) & mask) == above)
                count[bits_of(g->v[i]) >> shift & (PARTS - 1)]++;
    }
}

/* Value number k, from 0, in ascending order, by a radix selection from the highest bits, without another map
 * in memory. */
static double
ranked(const struct frames_of *f, size_t k)
{
    static size_t count[PARTS];
    uint64_t bits = 0;

    for (int shift = 64 - PART; shift >= 0; shift -= PART) {
        uint64_t part = 0;

        count_parts(f, bits, shift, count);
        while (k >= count[part])
            k -= count[part++];
        bits |= part << shift;
    }
    return value_of(bits);
}

static double
percentile(const struct frames_of *f, double percent)
{
    double place, below;
    size_t n = 0, k;

    for (size_t m = 0; m < f->n; m++)
        for (size_t i = 0; i < f->grid[m]->nx * f->grid[m]->ny; i++)
            n += counts(touch_of(f, m), f->grid[m], i);
    if (n == 0)
        return 0;
    place = percent / 100 * (double)(n - 1);
    k = (size_t)place;
    below = ranked(f, k);
    if (k + 1 >= n || place == (double)k)
        return below;
    return below + (place - (double)k) * (ranked(f, k + 1) - below);
}

/* ---- outliers ---- */

int
range_compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* The median of the values around a node. */
static double
around(const double *touch, const struct rc_grid *g, size_t node)
{
    size_t i = node % g->nx, j = node / g->nx, n = 0;
    double near[25];

    for (size_t y = j < 2 ? 0 : j - 2; y < g->ny && y <= j + 2; y++)
        for (size_t x = i < 2 ? 0 : i - 2; x < g->nx && x <= i + 2; x++)
            if (counts(touch, g, y * g->nx + x))
                near[n++] = g->v[y * g->nx + x];
    qsort(near, n, sizeof *near, range_compare);
    return near[n / 2];
}

/* True if one value of a map takes more than half of the range and is isolated, far from the values around
 * it. This does not happen in a well resolved solution. */
static bool
has_outlier(const struct frames_of *f, const struct survey *s)
{
    const struct rc_grid *g = f->grid[0];
    const double *touch = touch_of(f, 0);
    const size_t fewest = 400; /* nodes: on smaller maps half a per cent is less than a node */
    double half = 0.5 * s->max - 0.5 * s->min;

    if (g->nx * g->ny < fewest || g->nx < 3 || g->ny < 3 || !(half > 0) || !isfinite(2 * half))
        return false;
    return (counts(touch, g, s->max_at) && s->max - around(touch, g, s->max_at) > half) ||
           (counts(touch, g, s->min_at) && around(touch, g, s->min_at) - s->min > half);
}

/* ---- options ---- */

static bool
is_percent(const char *text, size_t n, double *value)
{
    char number[64];
    struct rc_err err;

    if (n < 2 || n >= sizeof number || text[n - 1] != '%')
        return false;
    memcpy(number, text, n - 1);
    number[n - 1] = '\0';
    return unit_number(number, UNIT_NONE, value, &err) == RC_OK && *value >= 0 && *value <= 100;
}

/* P%:Q% or P%,Q% */
static void
read_percent(struct tool *t, const char *text, struct range *r)
{
    const size_t n = strcspn(text, ":,");

    if (text[n] == '\0' || !is_percent(text, n, &r->low_percent) ||
        !is_percent(text + n + 1, strlen(text + n + 1), &r->high_percent) ||
        !(r->low_percent < r->high_percent))
        tool_usage(t, "--range %s: percentiles are P%%:Q%%, from 0%% to 100%%, with P below Q",
                   text);
    r->kind = RANGE_PERCENT;
}

void
range_read(struct tool *t, const char *text, const struct rc_grid *g, struct range *r)
{
    double pair[2];

    r->kind = RANGE_SYMMETRIC;
    if (strcmp(text, "symmetric") == 0)
        return;
    if (strchr(text, '%') != NULL) {
        read_percent(t, text, r);
        return;
    }
    if (look_pair(text, unit_of(g), pair, &t->err) != RC_OK)
        tool_usage(t, "--range %s: %s (channel %s is in %s)", text, t->err.text, g->channel,
                   g->unit);
    if (!(pair[0] < pair[1]))
        tool_usage(
            t, "--range %s: it must be LO:HI, two values with LO below HI, P%%:Q%% or symmetric",
            text);
    r->kind = RANGE_VALUES;
    r->lo = pair[0];
    r->hi = pair[1];
}

const char *
range_text(const struct range *r)
{
    static char si[2 * RC_NUMBER_SIZE + 2];

    snprintf(si, sizeof si, "%s:%s", rc_number(r->lo), rc_number(r->hi));
    return si;
}

/* Warns of a range in which values cannot be distinguished, for example because a unit was forgotten. Either
 * it does not overlap the values, or one of the two is less than a thousandth of the other. */
void
range_doubt(struct tool *t, const char *option, const char *text, const char *unit, double min,
            double max, const struct range *r)
{
    const double common = fmin(r->hi, max) - fmax(r->lo, min), values = max - min;
    char is[4][SHOWN_NUMBER];

    if (r->kind != RANGE_VALUES || (common >= 0 && common >= 1e-3 * values &&
                                    (values == 0 || common >= 1e-3 * (r->hi - r->lo))))
        return;
    tool_warn(t,
              "--%s %s goes from %s to %s, but the values go from %s to %s: was a unit "
              "forgotten?",
              option, text, shown_in_unit_to(is[0], r->lo, unit),
              shown_in_unit_to(is[1], r->hi, unit), shown_in_unit_to(is[2], min, unit),
              shown_in_unit_to(is[3], max, unit));
}

/* ---- the ends ---- */

/* Values this close to 0 are rounding: a hundredth of an atom, or 1e-9 of the largest. */
static double
rounding(const struct rc_grid *g, double size)
{
    return unit_of(g) == UNIT_M ? 1e-12 : 1e-9 * size;
}

/* A range from 0, to 0, or symmetric about 0. */
static void
anchor(const struct rc_grid *g, const struct colormap *map, const struct channel *what,
       struct range *r)
{
    double size = fmax(fabs(r->lo), fabs(r->hi));

    if (map->diverging || r->kind == RANGE_SYMMETRIC) {
        r->lo = -size;
        r->hi = size;
    } else if (what->to_zero) {
        r->hi = 0;
    } else if (what->from_zero && r->lo >= -fmin(rounding(g, size), size)) {
        r->lo = 0;
    }
}

/* Gives the range a width above 0. */
static void
widen(const struct rc_grid *g, const struct channel *what, struct range *r)
{
    double size = fmax(fabs(r->lo), fabs(r->hi));

    if (size < 1e-300) { /* zero everywhere: 1 nm about it, or 1 in another unit */
        size = unit_of(g) == UNIT_M ? 1e-9 : 1;
        r->lo = what->from_zero ? 0 : -size;
        r->hi = size;
    } else if (0.5 * r->hi - 0.5 * r->lo <= 1e-12 * size) { /* constant except for rounding */
        r->lo = fmax(r->lo - 0.1 * size, -DBL_MAX);
        r->hi = fmin(r->hi + 0.1 * size, DBL_MAX);
    }
}

static void
take_percentiles(const struct frames_of *f, struct range *r, double low, double high)
{
    r->lo = percentile(f, low);
    r->hi = percentile(f, high);
    snprintf(r->note, sizeof r->note, "colours from %s %% to %s %% of the %s", rc_number(low),
             rc_number(high), touch_of(f, 0) != NULL ? "contact" : "nodes");
}

void
range_choose(struct rc_grid *const *grid, const struct rc_grid *const *touch, size_t n,
             const struct survey *s, const struct colormap *map, const struct channel *what,
             struct range *r)
{
    const struct frames_of all = {grid, touch, n};
    const struct rc_grid *g = grid[0];

    if (r->kind == RANGE_VALUES)
        return;
    r->lo = s->min;
    r->hi = s->max;
    if (r->kind == RANGE_PERCENT)
        take_percentiles(&all, r, r->low_percent, r->high_percent);
    else if (r->kind == RANGE_CLIP || (r->kind == RANGE_AUTO && n == 1 && has_outlier(&all, s)))
        take_percentiles(&all, r, BEYOND, 100 - BEYOND);
    if (r->kind == RANGE_AUTO && r->note[0] != '\0' && r->hi - r->lo > 0.5 * (s->max - s->min)) {
        r->lo = s->min; /* there are too many of them to be left out */
        r->hi = s->max;
        r->note[0] = '\0';
    }
    if (r->kind != RANGE_PERCENT)
        anchor(g, map, what, r);
    widen(g, what, r);
}

void
range_take_logarithm(struct tool *t, struct rc_grid *const *grid, size_t n, struct range *r)
{
    const double decades = 1e-6;
    double least = INFINITY;

    if (r->kind == RANGE_VALUES && !(r->lo > 0))
        tool_usage(t, "--log has no place for 0 and below: give a --range above it");
    if (r->lo > 0)
        return;
    for (size_t m = 0; m < n; m++)
        for (size_t k = 0; k < grid[m]->nx * grid[m]->ny; k++)
            if (grid[m]->v[k] > 0)
                least = fmin(least, grid[m]->v[k]);
    if (!(r->hi > 0) || !isfinite(least))
        tool_refuse(t, grid[0],
                    "no value is above 0, and only those have a logarithm: leave out --log");
    r->lo = fmax(least, decades * r->hi);
    if (r->lo >= 0.999 * r->hi)
        r->lo = 0.1 * r->hi;
}

double
range_least(struct rc_grid *const *grid, const struct rc_grid *const *touch, size_t n,
            const struct survey *s, const struct range *r)
{
    double slack = rounding(grid[0], fmax(fabs(s->min), fabs(s->max)));

    if (strcmp(grid[0]->channel, "pressure") == 0 && s->min == 0)
        return percentile(&(struct frames_of){grid, touch, n},
                          0); /* nodes outside of the contact are not below the range */
    return s->min < r->lo && s->min >= r->lo - slack ? r->lo : s->min;
}
