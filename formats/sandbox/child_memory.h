/* Memory of a child process, read from its parent. */
#ifndef RC_CHILD_MEMORY_H
#define RC_CHILD_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

/* Copies n bytes from the address `from` of a child, which must stand still meanwhile. False where
 * the system does not allow it or the child has no such memory. */
bool rc_child_memory_copy(pid_t child, uint64_t from, void *to, size_t n);

/* Private memory of a child at its largest, in bytes: what the child holds and shares with no other
 * process, and what it has given back since. 0 where the system does not say. Code is not counted,
 * because it is memory of a file. */
size_t rc_child_memory_held(pid_t child);

#endif
