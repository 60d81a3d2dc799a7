/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common.h"

#include <omp.h>
#include <stdio.h>
#include <string.h>

const char *
rc_version(void)
{
    return RC_VERSION;
}

size_t
rc_threads_available(void)
{
    int n = omp_get_num_procs();

    return n < 1 ? 1 : (size_t)n;
}

int
rc_useful_threads(const struct rc_shape *s, size_t threads)
{
    size_t most = 1 + s->nx * s->ny / 8192;

    if (threads == 0)
        threads = rc_threads_available();
    return (int)(threads < most ? threads : most);
}

enum rc_status
rc_err_choices(struct rc_err *err, const char *(*row)(const void *of, size_t k), const void *of)
{
    const char *name;

    for (size_t k = 0; err != NULL && (name = row(of, k)) != NULL; k++) {
        const size_t n = strlen(err->text);
        size_t first = 0;
        while (strcmp(row(of, first), name) != 0)
            first++;
        if (first == k)
            snprintf(err->text + n, sizeof err->text - n, "%s%s", k == 0 ? ": take one of " : ", ",
                     name);
    }
    return RC_FAIL;
}

bool
rc_any(const double *v, size_t n)
{
    for (size_t k = 0; k < n; k++)
        if (v[k] != 0)
            return true;
    return false;
}

double
rc_highest(const double *v, size_t n)
{
    double most = -INFINITY;

    for (size_t k = 0; k < n; k++)
        most = v[k] > most ? v[k] : most;
    return most;
}

struct rc_total
rc_distance_of(const double *a, const double *b, size_t n)
{
    struct rc_total sum = {0};

    for (size_t k = 0; k < n; k++)
        rc_total_add(&sum, fabs(b == NULL ? a[k] : a[k] - b[k]));
    return sum;
}

double
rc_distance(const double *a, const double *b, size_t n)
{
    const struct rc_total sum = rc_distance_of(a, b, n);

    return rc_total_value(&sum);
}

enum {
    LANES = 16
};

/* Several sums at once over the first n values, n a multiple of LANES, each with the rounding error of its
 * additions. */
RC_CLONES static void
add_lanes(const double *v, size_t n, double *restrict sum, double *restrict lost)
{
    for (size_t k = 0; k < n; k += LANES)
#pragma omp simd
        for (size_t l = 0; l < LANES; l++) {
            double a = sum[l], b = v[k + l], s = a + b;
            lost[l] += fabs(a) >= fabs(b) ? (a - s) + b : (b - s) + a;
            sum[l] = s;
        }
}

struct rc_total
rc_total_of(const double *v, size_t n)
{
    double sum[LANES] = {0}, lost[LANES] = {0};
    struct rc_total total = {0};
    size_t whole = n / LANES * LANES;

    add_lanes(v, whole, sum, lost);
    for (size_t l = 0; l < LANES; l++) {
        rc_total_add(&total, sum[l]);
        total.lost += lost[l];
    }
    for (size_t k = whole; k < n; k++)
        rc_total_add(&total, v[k]);
    return total;
}

double
rc_sum(const double *v, size_t n)
{
    const struct rc_total total = rc_total_of(v, n);

    return rc_total_value(&total);
}
