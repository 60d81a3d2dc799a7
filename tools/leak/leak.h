/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options, case and report of rc-leak. */
#ifndef RC_TOOL_LEAK_H
#define RC_TOOL_LEAK_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

/* A case of rc-leak. */
struct leak_case {
    const struct rc_grid *gap; /* its values may already be freed */
    char direction;
    bool around;
    bool pressed;           /* a pressure frame determined the contact */
    double contact, mean;   /* fraction of the nodes, mean pressure in Pa; NAN without it       */
    double drop, viscosity; /* Pa, Pa s; NAN: not given                                        */
    double rate;            /* m^3/s for a conductance of 1 m^3; NAN: not given                 */
    double smooth, rough;   /* m/s, speeds of the bodies; smooth NAN: not given                 */
    double setup, solve;    /* s                                                                */
    const struct rc_leak_figures *figures;
};

/* Warnings about the accuracy of a flow, each for the first case that causes it. */
void leak_judge(struct tool *tool, const struct leak_case *c);
/* The effects of the case: computed, or why not. */
const struct effect_state *leak_effects(const struct leak_case *c);
/* The main figures, with --verbose. */
void leak_tell(struct tool *tool, const struct leak_case *c);
void leak_report(struct report *report, const struct leak_case *c);

#endif
