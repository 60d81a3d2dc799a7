/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Memory of the machine that a process uses, and how much more it may use before the system would end it.
 */
#ifndef RC_TOOL_MEMORY_H
#define RC_TOOL_MEMORY_H

#include <stddef.h>

/* Bytes in memory now; 0 if the system does not say. */
size_t memory_held(void);

/* The peak of this process. getrusage has another figure, which includes that of the process that started
 * this one. */
size_t memory_peak(void);

enum {
    MEMORY_APART = 1 << 17 /* bytes; larger maps are allocated apart */
};
/* Returns the memory of a map to the system when it is freed. Otherwise maps of one size leave holes in which
 * those of the next size do not fit. */
void memory_keep_maps_apart(void);
/* Returns free memory to the system, including holes between smaller blocks. */
void memory_give_back(void);

struct memory_room {
    double bytes;    /* INFINITY: no known limit */
    const char *why; /* what limits it, as in "the machine has" */
};

/* The least of the following. One is the free memory of the machine (swap included). Another is what the
 * control groups of this process still allow (cgroups, versions 1 and 2, up to the outermost). The last is
 * what its own limits of address space and data (ulimit -v, -d) still allow. `shared` processes share the
 * first two in equal parts. `root` precedes /proc and /sys: "". */
struct memory_room memory_room(const char *root, size_t shared);

#endif
