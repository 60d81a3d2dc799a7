/*
 * How the threads of OpenMP wait for each other.
 */
#ifndef RC_WAITS_H
#define RC_WAITS_H

/* On busy cores threads that wait sleep at once, for the rest of the process. libgomp's threads test for the
 * end of a wait 300,000 times before they sleep. That is fastest on idle cores. On busy ones the tests take
 * the core from the thread that the others wait for. If a process has more OpenMP threads than cores, libgomp
 * tests 100 times only (GOMP_SPINCOUNT in its manual). So once the system often takes a core from this
 * process, a team of two threads starts that only sleeps. It changes nothing if OMP_WAIT_POLICY or
 * GOMP_SPINCOUNT asks for longer or shorter waits, or if fewer threads than cores compute. */
void waits_watch(void);

#endif
