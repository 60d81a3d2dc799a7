/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Parameters of ISO 21920-2 of a profile, and profiles along any line of a map.
 */
#include "libcontact/common.h"

/* Share of Rz: a hill or dale that deviates less than this from the mean line does not count. The
 * default of ISO 4287. */
static const double discrimination = 0.1;

/* ---- along a line ---- */

/* Weights of four neighbours at a position 0 <= t < 1 between the second and the third. The cubic has the
 * values of both and the central slopes there. */
static void
cubic(double t, double w[4])
{
    w[0] = t * (-0.5 + t * (1 - 0.5 * t));
    w[1] = 1 + t * t * (-2.5 + 1.5 * t);
    w[2] = t * (0.5 + t * (2 - 1.5 * t));
    w[3] = t * t * (-0.5 + 0.5 * t);
}

/* Splits a position in nodes; at the edges the edge nodes replace the missing outer neighbours. */
static void
split(double place, size_t n, size_t at[4], double w[4])
{
    double below = floor(fmin(fmax(place, 0), (double)(n - 1)));
    long long first = (long long)below - 1;

    cubic(fmin(fmax(place, 0), (double)(n - 1)) - below, w);
    for (int k = 0; k < 4; k++) {
        long long i = first + k;

        at[k] = i < 0 ? 0 : i >= (long long)n ? n - 1 : (size_t)i;
    }
}

static double
value_at(const struct rc_shape *s, const double *h, double x, double y)
{
    size_t i[4], j[4];
    double wx[4], wy[4], sum = 0;

    split(x / s->dx + 0.5 * (double)(s->nx - 1), s->nx, i, wx);
    split(y / s->dy + 0.5 * (double)(s->ny - 1), s->ny, j, wy);
    for (int b = 0; b < 4; b++)
        for (int a = 0; a < 4; a++)
            if (wx[a] != 0 && wy[b] != 0)
                sum += wx[a] * wy[b] * h[j[b] * s->nx + i[a]];
    return sum;
}

void
rc_profile_along(const struct rc_shape *shape, const double *h, struct rc_place from,
                 struct rc_place to, size_t n, double *z)
{
    for (size_t k = 0; k < n; k++) {
        double t = n > 1 ? (double)k / (double)(n - 1) : 0;

        z[k] = value_at(shape, h, from.x + t * (to.x - from.x), from.y + t * (to.y - from.y));
    }
}

/* ---- heights ---- */

static void
measure_heights(const double *z, size_t n, double mean, struct rc_profile *p)
{
    struct rc_total size = {0}, power[3] = {{0}};
    double least = INFINITY, most = -INFINITY;

    for (size_t k = 0; k < n; k++) {
        double d = z[k] - mean;

        rc_total_add(&size, fabs(d));
        rc_total_add(&power[0], d * d);
        rc_total_add(&power[1], d * d * d);
        rc_total_add(&power[2], d * d * d * d);
        least = fmin(least, d);
        most = fmax(most, d);
    }
    p->ra = rc_total_value(&size) / (double)n;
    p->rq = sqrt(rc_total_value(&power[0]) / (double)n);
    p->rpt = most;
    p->rvt = -least;
    p->rt = most - least;
    if (p->rt > 0) {
        p->rsk = rc_total_value(&power[1]) / (double)n / pow(p->rq, 3);
        p->rku = rc_total_value(&power[2]) / (double)n / pow(p->rq, 4);
    }
}

/* Means over section lengths of the highest peak, the deepest pit and the sum of both. */
static void
measure_sections(const double *z, size_t n, double mean, size_t sections, struct rc_profile *p)
{
    p->rp = p->rv = 0;
    for (size_t s = 0; s < sections; s++) {
        double least = INFINITY, most = -INFINITY;

        for (size_t k = s * n / sections; k < (s + 1) * n / sections; k++) {
            least = fmin(least, z[k] - mean);
            most = fmax(most, z[k] - mean);
        }
        p->rp += most / (double)sections;
        p->rv -= least / (double)sections;
    }
    p->rz = p->rp + p->rv;
}

/* ---- slopes ---- */

/* By the seven-point formula, where all seven points are measured. */
static void
measure_slopes(const double *z, size_t n, double step, struct rc_profile *p)
{
    struct rc_total sum = {0};

    if (n < 7)
        return;
    for (size_t k = 3; k + 3 < n; k++) {
        double g = (z[k + 3] - z[k - 3] - 9 * (z[k + 2] - z[k - 2]) + 45 * (z[k + 1] - z[k - 1])) /
                   (60 * step);

        rc_total_add(&sum, g * g);
    }
    p->rdq = sqrt(rc_total_value(&sum) / (double)(n - 6));
}

/* ---- elements: a hill and the dale that follows it, between crossings of the mean line ---- */

struct elements {
    double from, last; /* start of the element, at a rising crossing; NAN: none yet */
    double top, bottom;
    double spacing, height;
    size_t n;
};

/* The profile crosses the mean line upwards at `at`, after a dale that counts. */
static void
end_element(struct elements *e, double at)
{
    if (!isnan(e->from)) {
        e->spacing += at - e->from;
        e->height += e->top - e->bottom;
        e->n++;
    }
    e->from = at;
}

/* A hill begins at the last rising crossing before it is high enough, after a dale that was deep enough. */
static void
measure_elements(const double *z, size_t n, double mean, double step, struct rc_profile *p)
{
    struct elements e = {.from = NAN, .last = NAN};
    double enough = discrimination * p->rz, top = 0, bottom = 0;
    int side = 0; /* the last hill (1) or dale (-1) that counts; 0: none yet */

    for (size_t k = 0; k < n; k++) {
        double d = z[k] - mean, before = k > 0 ? z[k - 1] - mean : 0;

        if (k > 0 && before < 0 && d >= 0)
            e.last = (double)(k - 1) + before / (before - d);
        top = fmax(top, d);
        bottom = fmin(bottom, d);
        if (d >= enough && side <= 0) {
            if (side < 0 && !isnan(e.last)) {
                e.top = top;
                e.bottom = bottom;
                end_element(&e, e.last);
                top = d;
                bottom = 0;
            }
            side = 1;
        } else if (d <= -enough && side >= 0) {
            side = -1;
        }
    }
    if (e.n > 0) {
        p->rsm = e.spacing / (double)e.n * step;
        p->rc = e.height / (double)e.n;
    }
    p->elements = e.n;
}

#define FIGURE(member) RC_FIGURE(struct rc_profile, member)
/* clang-format off */
const struct rc_figure rc_figures_profile[] = {
    {FIGURE(ra), "m", "Ra"}, {FIGURE(rq), "m", "Rq"}, {FIGURE(rsk), NULL, "Rsk"}, {FIGURE(rku), NULL, "Rku"},
    {FIGURE(rp), "m", "Rp"}, {FIGURE(rv), "m", "Rv"}, {FIGURE(rz), "m", "Rz"}, {FIGURE(rpt), "m", "Rpt"},
    {FIGURE(rvt), "m", "Rvt"}, {FIGURE(rt), "m", "Rt"}, {FIGURE(rsm), "m", "Rsm"}, {FIGURE(rc), "m", "Rc"},
    {FIGURE(rdq), NULL, "Rdq"},
    {0},
};
/* clang-format on */

enum rc_status
rc_profile_measure(size_t n, double step, const double *z, size_t sections, struct rc_profile *p,
                   struct rc_err *err)
{
    double mean;

    *p = (struct rc_profile){NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, 0};
    if (sections == 0 || n < sections)
        return rc_err_set(err, "a profile of %zu points has no %zu sections", n, sections);
    for (size_t k = 0; k < n; k++)
        if (!rc_there(z[k]))
            return rc_err_set(err, "point %zu of the profile was not measured", k);
    mean = rc_sum(z, n) / (double)n;
    measure_heights(z, n, mean, p);
    measure_sections(z, n, mean, sections, p);
    measure_slopes(z, n, step, p);
    if (p->rt > 0)
        measure_elements(z, n, mean, step, p);
    return RC_OK;
}
