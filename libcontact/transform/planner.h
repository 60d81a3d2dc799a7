/*
 * The lock of FFTW's planner, in which only one thread may be at a time, in a program with other
 * users of FFTW too. Internal: never installed.
 */
#ifndef RC_PLANNER_H
#define RC_PLANNER_H

/* Around every call that makes or destroys a plan, of either precision. */
void rc_planner_lock(void);
void rc_planner_unlock(void);

#endif
