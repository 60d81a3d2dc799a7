/*
 * Room for maps.
 */
#ifndef RC_MEMORY_H
#define RC_MEMORY_H

#include <stddef.h>

/* Room for n numbers of `size` bytes, not cleared, at the start of a cache line; NULL when there
 * is none or n * size is no size. free() gives it back. What takes megabytes lies in large pages
 * where the system has them: columns of a map are read page by page, and fresh pages are cleared
 * one by one. */
void *rc_alloc(size_t n, size_t size);

/* memcpy for what is read again only after many megabytes of others: it goes past the caches, and
 * the lines it goes to are not fetched before they are overwritten. */
void rc_copy_past(void *to, const void *from, size_t bytes);

#endif
