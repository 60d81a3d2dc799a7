/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The mean of a map that is read row by row. Internal: never installed.
 */
#ifndef RC_MEASURE_H
#define RC_MEASURE_H

#include <stddef.h>

/* Counts, extremes and the sum of measured values, row by row, in the order of rc_measure. */
enum {
    RC_LANES = 8 /* values processed together */
};
struct rc_first {
    double there[RC_LANES], missing[RC_LANES], minimum[RC_LANES], maximum[RC_LANES];
    struct rc_lane_sums {
        double sum[RC_LANES], lost[RC_LANES];
    } sum;
};
void rc_first_begin(struct rc_first *f);
void rc_first_row(struct rc_first *f, const double *v, size_t n);
/* The mean as in rc_measure. */
double rc_first_mean(const struct rc_first *f);

#endif
