/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * From figures of varied maps to bars. The scatter of noisy repeats is no error: noise makes a map rougher,
 * always in the same direction, and the measured map has one dose of it. The mean change by a second dose
 * stands for that of the first one. tests/long/bars.py compares bars with the figures of synthetic surfaces
 * on four times as many nodes a side; scatter alone holds them in 45 % of the cases.
 */
#include "scan.h"

#include <math.h>
#include <string.h>

/* Ratio of the changes of the slope above which shorter waves may follow: 28 of 28 fractals, and 0 of 57 maps
 * whose waves have 4 nodes or more. */
static const double ends = 0.8;
static const double smooth =
    0.02; /* a slope that changes by less, relatively, is that of a smooth map */
/* Of the larger of the last change with the grid and half the one before. 0.5 holds 92 % of all values, but
 * only 70 % of mean temperatures and of factors of shear flow; 1 holds 97 %. */
static const double grid_factor = 0.85;
static const double shift_factor = 1.83; /* of the rms change by shifted holes */
static const double rounding = 1e-9;     /* relative; smaller changes are none */

/* 95 % of Student's distribution, so that 90 % are within both signs (Hill 1970 expands it so). */
static double
student(size_t degrees)
{
    static const double t[] = {NAN, 6.314, 2.920, 2.353, 2.132, 2.015, 1.943, 1.895, 1.860, 1.833};
    const double z = 1.64485, n = (double)degrees, z3 = z * z * z;

    if (degrees < sizeof t / sizeof *t)
        return t[degrees];
    return z + (z3 + z) / (4 * n) + (5 * z3 * z * z + 16 * z3 + 3 * z) / (96 * n * n);
}

/* ---- the grid ---- */

void
scan_judge_grid(struct scan *s)
{
    const struct rc_grid *g = s->frame[0];
    double change;

    for (size_t k = 1; k < s->frames && strcmp(g->channel, "height") != 0; k++)
        g = s->frame[k];
    for (size_t k = 0; k < 3; k++) {
        const struct rc_shape shape = rc_grid_shape(g);
        const double own = scan_slope(s, &shape, g->v, 1u << k);

        s->slope[k] = sqrt(fmax(own * own - s->noise_slope[k] * s->noise_slope[k], 0));
    }
    change = s->slope[0] - s->slope[1];
    s->ratio = change / (s->slope[1] - s->slope[2]);
    if (!(s->ratio >= 0)) /* also where both do not change */
        s->ratio = change > smooth * s->slope[0] ? INFINITY : NAN;
    s->unlimited =
        s->slope[0] == 0 ? s->sigma > 0 : s->ratio > ends && change > smooth * s->slope[0];
    snprintf(s->note, sizeof s->note,
             "a finer grid may change it further, so give the spacing, %sm%s%s%s, with the value",
             shown_number(g->dx, 4, "m"), g->dx == g->dy || g->ny == 1 ? "" : " by ",
             g->dx == g->dy || g->ny == 1 ? "" : shown_number(g->dy, 4, "m"),
             g->dx == g->dy || g->ny == 1 ? "" : "m");
}

/* ---- figures ---- */

/* Line `line` of the report of a trial; NULL: none. */
static const char *
line_of(const struct cost_case *c, size_t trial, size_t program, size_t line)
{
    const struct cost_trial *t = &c->trial[trial];
    const char *at, *own = NULL;

    if (t->state != COST_DONE)
        return NULL;
    at = c->run[t->run[program]].report;
    for (size_t k = 0; k <= line; k++)
        if ((own = cost_line(&at)) == NULL)
            return NULL;
    return own;
}

static double
value_of(const struct scan *s, size_t trial, const struct scan_bar *b)
{
    return json_real(
        json_member(line_of(s->c, trial, b->figure->program, b->line), b->figure->name));
}

/* The values on the maps of one source. Maps whose run failed are left out; returns the number of the others.
 * *of: the number of maps. */
static size_t
values_of(const struct scan *s, enum scan_source source, const struct scan_bar *b, double v[],
          size_t *of)
{
    size_t n = 0;

    *of = 0;
    for (size_t k = 0; k < s->variants; k++)
        if (s->variant[k].source == source) {
            (*of)++;
            if (s->c->trial[s->variant[k].trial].state == COST_DONE)
                v[n++] = value_of(s, s->variant[k].trial, b);
        }
    return n;
}

static double
mean_of(const double v[], size_t n)
{
    double sum = 0;

    for (size_t k = 0; k < n; k++)
        sum += v[k];
    return sum / (double)n;
}

/* Root of the sum of squared differences from `from`, over `over`. */
static double
spread(const double v[], size_t n, double from, double over)
{
    double sum = 0;

    for (size_t k = 0; k < n; k++)
        sum += (v[k] - from) * (v[k] - from);
    return sqrt(sum / over);
}

static bool
begins(const char *name, const char *with)
{
    return strncmp(name, with, strlen(with)) == 0;
}

/* Extremes grow with the area. The approach counts from the highest node. */
static bool
is_extreme(const char *name)
{
    return begins(name, "max_") || begins(name, "min_") || begins(name, "approach");
}

/* ---- the rules, one for each source ---- */

static double
noise_part(struct scan_bar *b, const double v[], size_t n)
{
    if (n < 2)
        return NAN;
    b->bias = mean_of(v, n) - b->value;
    b->scatter = spread(v, n, mean_of(v, n), (double)(n - 1));
    return student(n - 1) * b->scatter + fabs(b->bias);
}

/* Of figure f1 of the map and f2, f4 of the coarser grids. */
static double
change_with_grid(double f1, const double coarse[2])
{
    return grid_factor * fmax(fabs(f1 - coarse[0]), fabs(coarse[0] - coarse[1]) / 2);
}

/* Changes of the numerator and of the denominator of a quotient nearly cancel in its last change, but not in
 * its error: each of them counts alone. */
static double
quotient_change(const struct scan *s, const struct scan_bar *b)
{
    struct cost_figure figure = {.program = b->figure->program};
    struct scan_bar divisor = {.figure = &figure, .line = b->line};
    double v[COST_TRIALS], above, below, products[2];
    size_t of;

    snprintf(figure.name, sizeof figure.name, "%s", b->figure->of);
    divisor.value = value_of(s, s->c->reference, &divisor);
    if (values_of(s, SCAN_GRID, &divisor, v, &of) < 2)
        return NAN;
    for (size_t k = 0; k < 2; k++)
        products[k] = b->coarse[k] * v[k];
    above = change_with_grid(b->value * divisor.value, products);
    below = b->value * change_with_grid(divisor.value, v);
    return hypot(above, below) / fabs(divisor.value);
}

static double
grid_part(struct scan *s, struct scan_bar *b, const double v[], size_t n)
{
    b->coarse[0] = n < 2 ? NAN : v[0];
    b->coarse[1] = n < 2 ? NAN : v[1];
    b->unlimited = s->unlimited && !(fabs(b->value - b->coarse[0]) <= rounding * fabs(b->value));
    return *b->figure->of != '\0' ? quotient_change(s, b) : change_with_grid(b->value, b->coarse);
}

static double
patch_part(const struct scan *s, struct scan_bar *b, double v[], size_t n)
{
    double share = s->share, mean = mean_of(v, n);

    if (n < 2)
        return NAN;
    if (fabs(mean / share - b->value) < fabs(mean - b->value)) { /* it adds up over the map */
        for (size_t k = 0; k < n; k++)
            v[k] /= share;
        mean /= share;
    }
    b->here = is_extreme(b->figure->name);
    return student(n - 1) * spread(v, n, mean, (double)(n - 1)) / sqrt((double)n) +
           fabs(b->value - mean);
}

static double
filter_part(const struct scan_bar *b, const double v[], size_t n)
{
    double most = NAN;

    for (size_t k = 0; k < n; k++)
        most = isnan(v[k]) ? NAN : fmax(most, fabs(v[k] - b->value));
    return most;
}

static void
find_bar(struct scan *s, struct scan_bar *b)
{
    double v[COST_TRIALS], square = 0, most = 0;
    bool unknown = false, known = false;

    b->dominant = SCAN_SOURCES;
    for (size_t k = 0; k < SCAN_SOURCES; k++) {
        size_t of, n = values_of(s, k, b, v, &of);
        double *part = &b->part[k];
        const bool counts = k != SCAN_FILTER || s->options->filter_bar;

        *part = NAN;
        if (of == 0)
            continue;
        *part = k == SCAN_NOISE   ? noise_part(b, v, n)
                : k == SCAN_GRID  ? grid_part(s, b, v, n)
                : k == SCAN_PATCH ? patch_part(s, b, v, n)
                : k == SCAN_HOLES ? (n < 2 ? NAN : shift_factor * spread(v, n, b->value, (double)n))
                                  : filter_part(b, v, n);
        if (k == SCAN_GRID && b->unlimited)
            *part = NAN;
        else if (k == SCAN_PATCH && b->here)
            *part = NAN;
        else if (isnan(*part) && counts)
            unknown = true;
        else if (counts) {
            square += *part * *part;
            known = true;
        }
        if (*part > most) {
            most = *part;
            b->dominant = k;
        }
    }
    b->bar = b->unlimited || unknown || !known ? NAN : sqrt(square);
    if (b->bar <= rounding * fabs(b->value)) {
        b->bar = 0;
        b->dominant = SCAN_SOURCES;
    }
    b->note = b->unlimited ? s->note
              : unknown    ? "unknown on some of the maps"
              : b->here    ? "on this area"
                           : "";
}

/* True if a later program of the pipe has the figure too, with the same value. */
static bool
is_passed_on(const struct scan *s, const struct scan_bar *b)
{
    for (size_t k = 0; k < s->bars; k++)
        if (s->bar[k].line == b->line && strcmp(s->bar[k].figure->name, b->figure->name) == 0 &&
            fabs(s->bar[k].value - b->value) <= 1e-3 * fabs(b->value))
            return true;
    return false;
}

void
scan_find_bars(struct scan *s)
{
    struct cost_case *c = s->c;

    for (size_t k = 0; k < c->figures; k++)
        for (size_t line = 0; line_of(c, c->reference, c->figure[k].program, line) != NULL;
             line++) {
            struct scan_bar b = {.figure = &c->figure[k],
                                 .line = line,
                                 .bias = NAN,
                                 .scatter = NAN,
                                 .coarse = {NAN, NAN}};

            b.value = value_of(s, c->reference, &b);
            if (isnan(b.value) || is_passed_on(s, &b))
                continue;
            find_bar(s, &b);
            s->bar = tool_grown(c->tool, s->bar, s->bars, &s->bar_room, sizeof b, "a list of bars");
            s->bar[s->bars++] = b;
        }
    for (size_t k = 0; k < s->bars; k++) {
        struct scan_bar *b = &s->bar[k];

        b->name = b->figure->name;
        for (size_t i = 0; i < s->bars; i++)
            if (s->bar[i].figure != b->figure && strcmp(s->bar[i].figure->name, b->name) == 0)
                b->name = b->figure->shown;
    }
}
