#include "common.h"

#include <omp.h>

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

bool
rc_any(const double *v, size_t n)
{
    for (size_t k = 0; k < n; k++)
        if (v[k] != 0)
            return true;
    return false;
}

enum {
    LANES = 16
};

/* Several sums at a time of the first n values, n a multiple of LANES, each with what its additions
 * have rounded away. */
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

double
rc_sum(const double *v, size_t n)
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
    return rc_total_value(&total);
}
