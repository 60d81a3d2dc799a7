/*
 * What all folders of libcontact share: loops for wide registers, and threads that pay. Internal:
 * never installed.
 */
#ifndef RC_COMMON_H
#define RC_COMMON_H

#include "contact.h"

/* Inner loops are compiled for wider registers too, and the loader takes what the processor has. */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
    !defined(__SANITIZE_ADDRESS__)
#define RC_CLONES __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define RC_CLONES
#endif

/* Threads that pay on a grid: waking one costs about what a few thousand nodes do. threads 0: as
 * many as there are. */
int rc_useful_threads(const struct rc_shape *shape, size_t threads);

#endif
