/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The option --relaxation: a viscoelastic material, for the tools that solve it.
 */
#ifndef RC_TOOL_RELAXATION_H
#define RC_TOOL_RELAXATION_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

struct relaxation_law {
    struct rc_relaxation *material; /* Young's modulus */
    double misfit;                  /* of a master curve; NAN: the terms were given */
};

/* The factor of all times of --shift: a number; wlf,C1,C2,T0 or arrhenius,EA,T0 at a temperature, which is
 * NULL if there is none. T and T0 in K or degC, C2 in K, EA in J/mol. */
enum rc_status relaxation_shift_read(const char *text, const char *temperature, double *shift,
                                     struct rc_err *err);

/* "Einf,E1:tau1,...", or a table with a heading: `tau E`, or `frequency storage loss` (Hz; `omega`: rad/s).
 * All times are multiplied by `shift`. */
enum rc_status relaxation_law_read(struct relaxation_law *law, const char *text, double shift,
                                   struct rc_err *err);

#endif
