#include "contact.h"

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
