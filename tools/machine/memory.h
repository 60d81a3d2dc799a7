/*
 * What a process holds of the machine's memory, and how much more it may take before the system
 * would end it.
 */
#ifndef RC_TOOL_MEMORY_H
#define RC_TOOL_MEMORY_H

#include <stddef.h>

/* Bytes in memory now; 0 where the system does not say. */
size_t memory_held(void);

/* The most that this process has held. The figure of getrusage is another: it is handed on from the
 * process that started this one. */
size_t memory_peak(void);

enum {
    MEMORY_APART = 1 << 17 /* bytes from which a map is kept apart */
};
/* Makes the memory of a map go back to the system when it is freed: else maps of one size leave
 * holes in which those of the next do not fit. */
void memory_keep_maps_apart(void);
/* Gives back what is free, holes between smaller ones too. */
void memory_give_back(void);

struct memory_room {
    double bytes;    /* INFINITY: nothing is known to bound it      */
    const char *why; /* what bounds it, as in "the machine has"     */
};

/* The least of what the machine has left (swap included), what the groups of processes that this
 * one is in may still take (cgroups, versions 1 and 2, up to the outermost), and what its own
 * limits of address space and data (ulimit -v, -d) leave. `root` stands before /proc and /sys: "". */
struct memory_room memory_room(const char *root);

#endif
