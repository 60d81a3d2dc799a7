/* Allocations that fail one after another; failing_malloc.c says which. For a program that is linked
 * with it; preloaded, the environment says what to do. */
#ifndef FAILING_MALLOC_H
#define FAILING_MALLOC_H

#include <stdbool.h>
#include <stddef.h>

/* From here on allocation number n fails (0: none), counted from 1, and with `stay` all after it. */
void fault_arm(size_t n, bool stay);
/* No further one fails. Gives how many there were. */
size_t fault_disarm(void);
/* Blocks that were allocated since fault_arm and are still held. */
size_t fault_held(void);
/* Whether the first allocation that failed was made by a library and not by the program itself. */
bool fault_in_library(void);

#endif
