/*
 * A body that yields inside, as the tools that solve it are told.
 */
#ifndef RC_TOOL_YIELDS_H
#define RC_TOOL_YIELDS_H

#include "libcontact/contact.h"
#include "physics.h"
#include "tools/cli/cli.h"

struct yield_law {
    struct rc_yield law;
    double *table[2]; /* plastic strain, stress; NULL: none given */
};

/* "Y", "Y,HM" or a table FILE.tsv. */
enum rc_status yield_law_read(struct yield_law *law, const char *text, struct rc_err *err);
/* Where it is given, ends the tool: it does not go with --yield. */
void yield_law_refuse(struct tool *tool, bool given, const char *what, const char *why);
/* The same for all of the physics that does not, and for a yield stress whose unit was forgotten. */
void yield_law_check(struct tool *tool, const struct yield_law *law, const struct physics *physics);
/* Pa: growth of the yield stress at first, per equivalent plastic strain. */
double yield_law_hardening(const struct rc_yield *law);

#endif
