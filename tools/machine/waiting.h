/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * How long a thread waits in a loop for the others before it sleeps.
 *
 * The OpenMP library reads this time once, when it is loaded, from GOMP_SPINCOUNT or OMP_WAIT_POLICY. Its
 * default is some milliseconds. On a machine with other busy programs a thread waits that long, after each
 * parallel loop, for a thread that has no core. The tools set a short time, if the user has set none.
 */
#ifndef RC_WAITING_H
#define RC_WAITING_H

/* Puts back the variable of the environment that carried the time. The first call of every tool. */
void waiting_restore(void);

#endif
