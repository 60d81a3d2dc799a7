/*
 * FFTW's planner is the one part of it that two threads may not enter at once, of a program with
 * other users of FFTW too. Internal: never installed.
 */
#ifndef RC_PLANNER_H
#define RC_PLANNER_H

/* Around every call that makes or destroys a plan, of either precision. */
void rc_planner_lock(void);
void rc_planner_unlock(void);

#endif
