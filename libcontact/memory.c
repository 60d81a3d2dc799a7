#define _DEFAULT_SOURCE /* madvise */
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>

#include "memory.h"

enum {
    LINE = 64,
    LARGE =
        2 * 1024 * 1024 /* the page that x86-64 and most ARM systems have beside the usual one */
};

void *
rc_alloc(size_t n, size_t size)
{
    void *at;
    size_t bytes;

    if (size != 0 && n > SIZE_MAX / 2 / size)
        return NULL;
    bytes = n * size;
    if (posix_memalign(&at, bytes < LARGE ? LINE : LARGE, bytes > 0 ? bytes : 1) != 0)
        return NULL;
#ifdef MADV_HUGEPAGE
    if (bytes >= LARGE)
        (void)madvise(at, bytes / LARGE * LARGE,
                      MADV_HUGEPAGE); /* a wish: refused, nothing is lost */
#endif
    return at;
}
