/*
 * Memory within a budget.
 *
 * In libcontact, formats and tools malloc, calloc, realloc, aligned_alloc and free are those of memory.c (see
 * CMakeLists.txt). They call the C library's and add up what it gives (malloc_usable_size): one atomic addition a
 * call, no header and no table. What would exceed the budget is refused, and takes the path of an allocation that
 * fails; so no other function has to know how much memory its subject needs. Memory that other libraries take for
 * themselves (FFTW's planner, GSL, HDF5) does not count. The budget is the process's, as its memory is; every rank
 * has its own, and the ranks agree on a failure. Work that allocates large maps only after a long iteration asks
 * for them before it: rc_memory_ask (grid.h).
 */
#ifndef RC_MEMORY_H
#define RC_MEMORY_H

#include "grid.h"

/* Room for n numbers of `size` bytes, not cleared, at the start of a cache line; NULL when there
 * is none or n * size is no size. free() gives it back. What takes megabytes lies in large pages
 * where the system has them: columns of a map are read page by page, and fresh pages are cleared
 * one by one. */
void *rc_alloc(size_t n, size_t size);

/* malloc, calloc, realloc, aligned_alloc and free. */
void *rc_malloc(size_t bytes);
void *rc_calloc(size_t n, size_t size);
void *rc_realloc(void *at, size_t bytes);
void *rc_aligned_alloc(size_t line, size_t bytes);
void rc_free(void *at);

/* What this thread allocates from here to rc_memory_lent does not count: it takes the place of pages of larger
 * maps that nobody has touched yet, and is freed before they are. rc_memory_lent says how much it was, which
 * rc_memory_return takes once it is freed. */
void rc_memory_lend(void);
size_t rc_memory_lent(void);
void rc_memory_return(size_t bytes);

/* memcpy for what is read again only after many megabytes of others: it goes past the caches, and
 * the lines it goes to are not fetched before they are overwritten. */
void rc_copy_past(void *to, const void *from, size_t bytes);

#endif
