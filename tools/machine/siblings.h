/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Processes of the same tool that run beside this one, as when xargs or make starts several. */
#ifndef RC_TOOL_SIBLINGS_H
#define RC_TOOL_SIBLINGS_H

#include <stddef.h>

struct siblings {
    size_t n;     /* processes of this name and user, with this one: at least 1 */
    double bytes; /* what the others hold in memory */
};

/* Without /proc this process is alone. `root` precedes /proc: "". */
struct siblings machine_siblings(const char *root);

#endif
