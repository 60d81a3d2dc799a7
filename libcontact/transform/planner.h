/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The lock of FFTW's planner, which only one thread may use at a time, also in a program with other users of
 * FFTW. Internal: never installed.
 */
#ifndef RC_PLANNER_H
#define RC_PLANNER_H

/* Around every call that makes or destroys a plan, of either precision. */
void rc_planner_lock(void);
void rc_planner_unlock(void);

#endif
