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
