/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes allocations fail one after another; failing_malloc.c defines which. This is the interface for a
 * program that is linked with it; the preloaded library reads the environment. */
#ifndef FAILING_MALLOC_H
#define FAILING_MALLOC_H

#include <stdbool.h>
#include <stddef.h>

/* From here on allocation number n fails (0: none), counted from 1, and with `stay` all after it. */
void fault_arm(size_t n, bool stay);
/* Stops the faults. Returns the number of allocations since fault_arm. */
size_t fault_disarm(void);
/* Blocks that were allocated since fault_arm and are still held. */
size_t fault_held(void);
/* True if a library, not the program itself, made the first failing allocation. */
bool fault_in_library(void);

#endif
