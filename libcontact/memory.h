/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Memory within a budget.
 *
 * libcontact, formats and tools use malloc, calloc, realloc, aligned_alloc and free of memory.c (see
 * CMakeLists.txt). These call the C library and add up malloc_usable_size: one atomic addition a call, no
 * header and no table. An allocation that would exceed the budget fails as if memory were short, so callers
 * need no forecast of their own. The counter does not include memory of other libraries (FFTW's planner, GSL,
 * HDF5). Each process has one budget; under MPI each rank has its own, and the ranks agree on a failure. Work
 * that allocates large maps only after a long iteration asks for them before it: rc_memory_ask (grid.h).
 */
#ifndef RC_MEMORY_H
#define RC_MEMORY_H

#include "owned.h"

/* Memory for n numbers of `size` bytes, not cleared, at the start of a cache line. NULL if memory is short or
 * n * size overflows. free() returns it. Blocks of megabytes use large pages if the system has them. Columns
 * of a map touch many pages, and the system clears new pages one by one. */
void *rc_alloc(size_t n, size_t size);

/* malloc, calloc, realloc, aligned_alloc and free. */
void *rc_malloc(size_t bytes);
void *rc_calloc(size_t n, size_t size);
void *rc_realloc(void *at, size_t bytes);
void *rc_aligned_alloc(size_t line, size_t bytes);
void rc_free(void *at);

/* Blocks that one call frees, those of a handle for example; zeroed: none. */
struct rc_store {
    void **block;
    size_t n;
    bool failed; /* memory was short for one of them */
};
/* As rc_alloc, but the block belongs to the store. */
void *rc_store_take(struct rc_store *store, size_t n, size_t size);
/* The same, with zeros, or with a copy of `from`. */
void *rc_store_zeros(struct rc_store *store, size_t n, size_t size);
void *rc_store_copy(struct rc_store *store, size_t n, size_t size, const void *from);
/* Makes a map of n zeros where it is missing (*v NULL); false: memory is short. */
bool rc_store_need(struct rc_store *store, size_t n, double **v);
void rc_store_free(struct rc_store *store);

/* Allocations of this thread between rc_memory_lend and rc_memory_lent do not count. They take the place of
 * pages of larger maps that are still untouched, and are freed before those are touched. rc_memory_lent
 * returns their bytes. Pass them to rc_memory_return after freeing. */
void rc_memory_lend(void);
size_t rc_memory_lent(void);
void rc_memory_return(size_t bytes);

/* memcpy for data that is next read after many megabytes of other data. It bypasses the caches, and does not
 * fetch the lines that it overwrites. */
void rc_copy_past(void *to, const void *from, size_t bytes);

#endif
