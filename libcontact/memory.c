/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _DEFAULT_SOURCE /* madvise */
#undef malloc
#undef calloc
#undef realloc
#undef aligned_alloc
#undef free
#include <malloc.h>
#include <stdatomic.h>
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
    SMALL = 1 << 18,
    LARGE = 2 * 1024 * 1024 /* the large page of x86-64 and most ARM systems */
};

/* ---- budget ---- */

static atomic_size_t held, lent, peak, budget, refused; /* bytes; budget and refused 0: none */
static _Thread_local struct {
    bool on;
    size_t bytes;
} lending;

/* Blocks of other libraries that are freed here were never added. */
static size_t
held_now(void)
{
    const size_t now = atomic_load_explicit(&held, memory_order_relaxed) -
                       atomic_load_explicit(&lent, memory_order_relaxed);

    return now > SIZE_MAX / 2 ? 0 : now;
}

void
rc_memory_budget(size_t bytes)
{
    atomic_store(&budget, bytes);
    atomic_store(&refused, 0);
}

bool
rc_memory_ask(size_t bytes)
{
    const size_t now = held_now(), with = bytes > SIZE_MAX - now ? SIZE_MAX : now + bytes;
    const size_t allowed = atomic_load_explicit(&budget, memory_order_relaxed);

    if (allowed == 0 || with <= allowed || lending.on)
        return true;
    atomic_store(&refused, with);
    return false;
}

struct rc_memory
rc_memory_held(void)
{
    return (struct rc_memory){held_now(), atomic_load(&peak), atomic_load(&refused)};
}

/* ---- blocks ---- */

/* Small blocks are counted, and never refused: messages need some. */
static bool
fits(size_t bytes)
{
    return bytes < SMALL || rc_memory_ask(bytes);
}

void
rc_memory_lend(void)
{
    lending.on = true;
    lending.bytes = 0;
}

size_t
rc_memory_lent(void)
{
    lending.on = false;
    return lending.bytes;
}

void
rc_memory_return(size_t bytes)
{
    atomic_fetch_sub(&lent, bytes);
}

static void
lend(size_t bytes)
{
    if (!lending.on)
        return;
    lending.bytes += bytes;
    atomic_fetch_add(&lent, bytes);
}

/* The bytes that a block counts for. After a block with such an alignment the C library maps up to one large
 * page more. So rc_alloc stores the true size at the end of the block. */
static size_t
size_of(void *at)
{
    const size_t usable = malloc_usable_size(at);
    size_t bytes;

    if ((uintptr_t)at % LARGE != 0 || usable < LARGE)
        return usable;
    memcpy(&bytes, (char *)at + usable - sizeof bytes, sizeof bytes);
    return bytes;
}

static void *
add(void *at)
{
    const size_t bytes = size_of(at);
    size_t most = atomic_load_explicit(&peak, memory_order_relaxed), now;

    lend(bytes);
    atomic_fetch_add_explicit(&held, bytes, memory_order_relaxed);
    now = held_now();
    while (now > most && !atomic_compare_exchange_weak(&peak, &most, now))
        continue;
    return at;
}

static void
take_off(size_t bytes)
{
    lend(-bytes);
    atomic_fetch_sub_explicit(&held, bytes, memory_order_relaxed);
}

void *
rc_malloc(size_t bytes)
{
    return fits(bytes) ? add(malloc(bytes)) : NULL;
}

void *
rc_calloc(size_t n, size_t size)
{
    const size_t bytes = size != 0 && n > SIZE_MAX / size ? SIZE_MAX : n * size;

    return fits(bytes) ? add(calloc(n, size)) : NULL;
}

void *
rc_realloc(void *at, size_t bytes)
{
    const size_t before = size_of(at);
    void *now;

    if (bytes > before && !fits(bytes - before))
        return NULL;
    if ((now = realloc(at, bytes)) == NULL)
        return NULL;
    take_off(before);
    return add(now);
}

void *
rc_aligned_alloc(size_t line, size_t bytes)
{
    return fits(bytes) ? add(aligned_alloc(line, bytes)) : NULL;
}

void
rc_free(void *at)
{
    take_off(size_of(at));
    free(at);
}

void *
rc_alloc(size_t n, size_t size)
{
    void *at;
    size_t bytes;

    if (size != 0 && n > SIZE_MAX / 2 / size)
        return NULL;
    bytes = n * size;
    if (bytes < LARGE)
        return fits(bytes) && posix_memalign(&at, LINE, bytes > 0 ? bytes : 1) == 0 ? add(at)
                                                                                    : NULL;
    if (!fits(bytes) || posix_memalign(&at, LARGE, bytes + sizeof bytes) != 0)
        return NULL;
    memcpy((char *)at + malloc_usable_size(at) - sizeof bytes, &bytes, sizeof bytes);
#ifdef MADV_HUGEPAGE
    /* only a request: a refusal does no harm */
    (void)madvise(at, bytes / LARGE * LARGE, MADV_HUGEPAGE);
#endif
    return add(at);
}

void *
rc_store_take(struct rc_store *s, size_t n, size_t size)
{
    void **block = rc_realloc(s->block, (s->n + 1) * sizeof *block);

    if (block != NULL) {
        s->block = block;
        if ((block[s->n] = rc_alloc(n, size)) != NULL)
            return block[s->n++];
    }
    s->failed = true;
    return NULL;
}

void *
rc_store_zeros(struct rc_store *s, size_t n, size_t size)
{
    void *at = rc_store_take(s, n, size);

    return at != NULL ? memset(at, 0, n * size) : NULL;
}

void *
rc_store_copy(struct rc_store *s, size_t n, size_t size, const void *from)
{
    void *at = rc_store_take(s, n, size);

    return at != NULL ? memcpy(at, from, n * size) : NULL;
}

bool
rc_store_need(struct rc_store *store, size_t n, double **v)
{
    if (*v == NULL)
        *v = rc_store_zeros(store, n, sizeof **v);
    return *v != NULL;
}

void
rc_store_free(struct rc_store *s)
{
    for (size_t k = 0; k < s->n; k++)
        rc_free(s->block[k]);
    rc_free(s->block);
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
    _mm_sfence(); /* before other threads see the result */
}
#else
void
rc_copy_past(void *to, const void *from, size_t bytes)
{
    memcpy(to, from, bytes);
}
#endif
