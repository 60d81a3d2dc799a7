/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The option --relaxation: a viscoelastic material, for the tools that solve it.
 */
#ifndef RC_TOOL_RELAXATION_H
#define RC_TOOL_RELAXATION_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

/* What --shift and --temperature say. */
struct relaxation_shift {
    bool wlf, arrhenius;
    double c[2], t0;       /* C1 and C2 (K), or EA (J/mol); T0 in K        */
    struct numbers factor; /* of all times; 1 without --shift              */
    struct numbers kelvin; /* the temperatures of a law; n = 0: none       */
};

struct relaxation_law {
    struct rc_relaxation
        *material; /* Young's modulus, at the temperature if there is one, else at T0 */
    double misfit; /* of a master curve; NAN: the terms were given */
    /* rad/s: the frequencies of the table, or the inverse of its times, after a single shift; 0 and
     * INFINITY: there is no end, as of terms */
    double lowest, highest;
    bool in_time; /* the table has times */
    /* the least and the largest measured modulus (of a frequency: of storage), Pa, each with its frequency
     * or the inverse of its time, as above */
    struct relaxation_measured {
        double modulus, omega;
    } least, most;
    const struct relaxation_shift
        *shift; /* of several factors, one for each case; NULL: there is one */
};

/* --shift: a list of factors of all times; wlf,C1,C2,T0 or arrhenius,EA,T0 at a list of temperatures,
 * which is NULL if there is none. T and T0 in K or degC, C2 in K, EA in J/mol. */
enum rc_status relaxation_shift_read(const char *text, const char *temperature,
                                     struct relaxation_shift *shift, struct rc_err *err);

/* "Einf,E1:tau1,...", or a table with a heading: `tau E`, `time E`, or `frequency storage loss` (Hz;
 * `omega`: rad/s), where `tandelta` or `phase` may take the place of loss, and then `|E*|` that of storage.
 * A table of measured moduli may have a column of temperatures, whose rows the law shifts to T0. All times
 * are multiplied by the factor of `shift`, if it is one; NULL: 1. */
enum rc_status relaxation_law_read(struct relaxation_law *law, const char *text,
                                   const struct relaxation_shift *shift, struct rc_err *err);
/* Describes the angular frequency `omega` (rad/s) that case k excites, as in "5000 Hz, above the last
 * frequency of the table, 1000 Hz: its instantaneous modulus, ..."; NULL: it is inside the range of the
 * table. */
enum {
    RELAXATION_OUTSIDE = 384
};
const char *relaxation_outside_to(char text[RELAXATION_OUTSIDE], const struct relaxation_law *law,
                                  size_t k, double omega);
#define relaxation_outside(law, k, omega)                                                          \
    relaxation_outside_to((char[RELAXATION_OUTSIDE]){""}, law, k, omega)
/* The factor of case k, and its temperature (K; NAN: none). */
double relaxation_factor(const struct relaxation_shift *shift, size_t k);
double relaxation_kelvin(const struct relaxation_shift *shift, size_t k);

#endif
