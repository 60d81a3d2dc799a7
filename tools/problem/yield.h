/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The option --yield: a body that yields in its volume, for the tools that solve it.
 */
#ifndef RC_TOOL_YIELD_H
#define RC_TOOL_YIELD_H

#include "libcontact/contact.h"
#include "physics.h"
#include "tools/cli/cli.h"

struct yield_law {
    struct rc_yield_law law;
    struct columns table; /* plastic strain and stress, of a file */
};

extern const struct opt yield_option[]; /* its text */
/* "Y", "Y,HM" or a file with a table. */
enum rc_status yield_law_read(struct yield_law *law, const char *text, struct rc_err *err);
/* Ends the tool if body 1 cannot be plastic, or the yield stress seems to lack its unit. */
void yield_law_check(struct tool *tool, const struct yield_law *law, const struct physics *physics);
/* Pa: initial slope of the yield stress over the equivalent plastic strain. */
double yield_law_hardening(const struct rc_yield_law *law);

#endif
