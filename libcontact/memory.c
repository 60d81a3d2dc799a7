#define _DEFAULT_SOURCE /* madvise */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

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

#ifdef __SSE2__
void
rc_copy_past(void *to, const void *from, size_t bytes)
{
    size_t head = (LINE - (uintptr_t)to % LINE) % LINE, k;
    char *b = to;
    const char *a = from;

    head = head < bytes ? head : bytes;
    memcpy(b, a, head);
    for (k = head; k + LINE <= bytes; k += LINE)
        for (size_t i = k; i < k + LINE; i += sizeof(__m128i))
            _mm_stream_si128((__m128i *)(void *)(b + i),
                             _mm_loadu_si128((const __m128i *)(const void *)(a + i)));
    memcpy(b + k, a + k, bytes - k);
    _mm_sfence(); /* before what others are told */
}
#else
void
rc_copy_past(void *to, const void *from, size_t bytes)
{
    memcpy(to, from, bytes);
}
#endif
