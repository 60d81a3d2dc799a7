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

double
rc_sum(const double *v, size_t n)
{
    struct rc_total total = {0};

    for (size_t k = 0; k < n; k++)
        rc_total_add(&total, v[k]);
    return rc_total_value(&total);
}
