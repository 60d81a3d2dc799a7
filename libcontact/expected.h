/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The measured numbers of forecasts (rc_solver_expect, rc_model_plan and others): work, in convolutions or
 * applications, and seconds. bench/forecast.sh compares them with runs. Seconds are those of 2 cores of an
 * Intel Xeon, 2026-11-28; a caller scales them to its machine. Internal: never installed.
 */
#ifndef RC_EXPECTED_H
#define RC_EXPECTED_H

/* ---- seconds of one sum K p in a solve, with the iteration's passes over maps; two threads ---- */

#define RC_SUM_FREE 31e-9     /* a node, by transforms                                  */
#define RC_SUM_PERIODIC 13e-9 /* the same                                               */
#define RC_SUM_PAST 9e-9      /* periodic, more for a node beyond the first million     */
#define RC_SUM_PROFILE 120e-9 /* a node of a profile, with the plans of its transforms  */
#define RC_SUM_START 0.1e-3
#define RC_SUM_MLMS 3e-9    /* a node, for each decade of the accuracy                */
#define RC_SUM_DIRECT 1e-11 /* a pair of nodes                                        */

/* ---- work of other models, in convolutions unless stated; seconds in those of a sum ---- */

#define RC_STIFFNESS_WORK 6
#define RC_LAYER_TABLES 6    /* the spectra of layers take as long as so many sums  */
#define RC_ADHESION_WORK 40  /* a first state on 128 x 128 nodes; grows as n^(1/4)  */
#define RC_ADHESION_PASSES 4 /* seconds of a step                                   */
/* A body that yields: applications after the increments and of one increment, convolutions of a slab and
 * application, and its seconds: free, periodic. */
#define RC_YIELD_LAST 10
#define RC_YIELD_INCREMENT 2.2
#define RC_YIELD_SLAB 3.3
#define RC_YIELD_SUMS                                                                              \
    {                                                                                              \
        3.6, 5.1                                                                                   \
    }
#define RC_CREEP_STEP 4.4     /* a step in time                                       */
#define RC_SLIDE_CONTACT 5.5  /* a contact of a sliding body after the first one      */
#define RC_SLIDE_PASSES 1.6   /* seconds                                              */
#define RC_WEAR_BY_NODE 3     /* times a contact of a uniform coefficient; 2 to 6     */
#define RC_RUBBING_PASSES 2   /* seconds of a contact of two rough bodies */
#define RC_ROLLING_STEP 25    /* a step of a path                                     */
#define RC_ROLLING_STEADY 29  /* a steady state to 1e-2; a third more for each decade */
#define RC_ROLLING_FORCE 33   /* the same, with a given force                         */
#define RC_ROLLING_PASSES 1.9 /* seconds of a convolution of a steady state          */
/* Leakage: seconds and bytes of a node with fluid of 512 x 512; the seconds grow as n^(1/7). The bytes are
 * those of maps that are eliminated whole, and of larger ones. */
#define RC_LEAK_NODE 1.7e-6
#define RC_LEAK_BYTES                                                                              \
    {                                                                                              \
        360, 49                                                                                    \
    }
/* Temperatures: sums beside those of a step in time, seconds a node for the coefficients and for a further
 * depth; bytes a node, free and periodic, with the shares of nodes and with one number, and of a further
 * step. */
#define RC_HEAT_WORK 2.5
#define RC_HEAT_STEP 8
#define RC_HEAT_NODE 100e-9
#define RC_HEAT_DEPTH 250e-9
#define RC_HEAT_BYTES                                                                              \
    {                                                                                              \
        {170, 133},                                                                                \
        {                                                                                          \
            93, 80                                                                                 \
        }                                                                                          \
    }
#define RC_HEAT_TIME_BYTES 25

#endif
