/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fully reversed bending and torsion at the endurance limits: the indices are 1. */
#include <libcontact/contact.h>
#include <math.h>
#include <stdio.h>

enum {
    STATES = 64
};

int
main(void)
{
    const struct rc_fatigue_limits limits = {.bending = 500e6,
                                             .torsion = 320e6};
    const unsigned wanted =
        1u << RC_CROSSLAND | 1u << RC_DANG_VAN | 1u << RC_FINDLEY;
    double wave[2][STATES], none[STATES] = {0}, index[RC_FATIGUES];
    struct rc_err err;

    for (int t = 0; t < STATES; t++) {
        wave[0][t] = limits.bending * cos(2 * acos(-1) * t / STATES);
        wave[1][t] = limits.torsion * cos(2 * acos(-1) * t / STATES);
    }
    for (int k = 0; k < 2; k++) {
        const double *s[RC_COMPONENTS] = {none, none, none,
                                          none, none, none};

        s[k == 0 ? RC_SXX : RC_SXY] = wave[k];
        if (rc_fatigue_history(wanted, &limits, true, STATES, s, index,
                               &err) == RC_FAIL)
            return fprintf(stderr, "%s\n", err.text), 1;
        for (int c = 0; c < RC_CRITERIA; c++)
            if (wanted >> c & 1)
                printf("%s, %s: index %.4f\n",
                       k == 0 ? "bending" : "torsion",
                       rc_criterion_names[c], index[c]);
    }
    return 0;
}
