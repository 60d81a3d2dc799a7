/* Memory of another process. */
#ifndef RC_REACH_H
#define RC_REACH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

/* Copies n bytes from where they lie in a child that waits; false where the system does not let, or
 * there are none. */
bool rc_reach(pid_t child, uint64_t from, void *to, size_t n);

#endif
