/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The measured numbers of forecasts (rc_solver_expect, rc_model_plan and others): work, in convolutions or
 * applications, and seconds. tests/long/pipe_forecasts.sh compares them with runs, and bench/forecast.sh on
 * larger maps. Seconds are those of 2 cores of an Intel Xeon, 2026-11-28; a caller scales them to its
 * machine. Internal: never installed.
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
#define RC_LAYER_TABLES 10 /* the spectra of layers take as long as so many sums */
#define RC_LINE_TABLES 5   /* the same for the coefficients where one axis repeats */
/* A first state on 128 x 128 periodic nodes, which grows as n^(1/4); where the cohesive length is below
 * RC_ADHESION_STIFF nodes; times on a free map; seconds of a convolution, in those of a sum. */
#define RC_ADHESION_WORK 25
#define RC_ADHESION_STIFF_WORK 60
#define RC_ADHESION_STIFF 1.5
#define RC_ADHESION_FREE 1.3
#define RC_ADHESION_PASSES 4
/* A body with a yield stress: depths of the search for the largest stress, before they are counted, and
 * seconds of a depth, in those of a sum without its start: free, periodic. One that yields: applications
 * after the increments and of one increment, convolutions of a slab and application, and its seconds: free,
 * periodic. */
#define RC_YIELD_LOOKED 28
#define RC_YIELD_LOOK                                                                              \
    {                                                                                              \
        4.5, 2.5                                                                                   \
    }
#define RC_YIELD_LAST 10
#define RC_YIELD_INCREMENT 2.2
#define RC_YIELD_SLAB 3.3
#define RC_YIELD_SUMS                                                                              \
    {                                                                                              \
        3.6, 5.1                                                                                   \
    }
#define RC_CREEP_STEP 4.4    /* a step in time                                       */
#define RC_CREEP_APPROACH 10 /* the same, at a given approach                        */
#define RC_SLIDE_CONTACT 3   /* a contact of a sliding body                          */
#define RC_SLIDE_FREE 12     /* in addition, on a free map, and where it repeats     */
#define RC_SLIDE_PERIODIC 3
#define RC_SLIDE_PASSES 1.6   /* seconds                                              */
#define RC_WEAR_CONTACT 0.7   /* of a first contact, from the pressure of the last    */
#define RC_WEAR_BY_NODE 1.5   /* times a contact of a uniform coefficient; 1 to 6     */
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
/* Temperatures: sums beside those of a step in time; seconds a node for the coefficients, those of a
 * further step and a further depth; bytes a node, free and periodic, with the shares of nodes and with
 * one number; sums of a further step, and its bytes. */
#define RC_HEAT_WORK 2.5
#define RC_HEAT_STEP 8
#define RC_HEAT_NODE 100e-9
#define RC_HEAT_STEP_NODE 250e-9
#define RC_HEAT_DEPTH 250e-9
#define RC_HEAT_BYTES                                                                              \
    {                                                                                              \
        {170, 133},                                                                                \
        {                                                                                          \
            93, 80                                                                                 \
        }                                                                                          \
    }
#define RC_HEAT_TIME_STEP 4
#define RC_HEAT_TIME_BYTES                                                                         \
    {                                                                                              \
        110, 28                                                                                    \
    }

#endif
