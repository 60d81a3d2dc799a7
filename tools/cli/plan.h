/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * --dry-run: what a tool would do with a map and what it would cost, in lines for people and, with --report,
 * as a row for programs. With --report - only the row is printed.
 */
#ifndef RC_PLAN_H
#define RC_PLAN_H

#include "report.h"

struct plan {
    struct tool *tool;
    struct report *report;
    bool says; /* the lines are printed */
};

/* The map, and more words about it (""). boundary NULL: unknown. */
struct plan plan_begin(struct tool *tool, struct report *report, const struct rc_grid *g,
                       size_t number, const char *boundary, const char *what);
/* "  NAME  TEXT", for people only. */
void plan_say(const struct plan *plan, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void plan_effects(const struct plan *plan, const struct effect_state *effects);
/* The cost: equivalents of a convolution (NAN: unknown, or there are none), s (NAN: unknown), bytes of the
 * process. what: more words about the convolutions (""). */
void plan_end(const struct plan *plan, double convolutions, double seconds, size_t memory);

#endif
