#include "waits.h"

#include <omp.h>
#include <pthread.h>
#include <signal.h>
#include <stddef.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

enum {
    INTERVAL = 10, /* ms */
    OFTEN = 5      /* switches in about two intervals; idle cores cause few of them */
};

/* Switches from a thread of this process that could have gone on. */
static long
switches(void)
{
    struct rusage use;

    return getrusage(RUSAGE_SELF, &use) == 0 ? use.ru_nivcsw : 0;
}

static void *
watch(void *none)
{
    const struct timespec interval = {0, INTERVAL * 1000000L};
    long before, now = switches(), sum = 0;

    do {
        before = now;
        (void)nanosleep(&interval, NULL);
        now = switches();
        sum = sum / 2 + now - before - 1; /* this thread takes a core once an interval */
    } while (sum < OFTEN);
#pragma omp parallel num_threads(2)
    (void)omp_get_thread_num();
    for (;;)
        (void)pause(); /* libgomp counts the team as long as its first thread lives */
    return none;
}

void
waits_watch(void)
{
    sigset_t all, before;
    pthread_attr_t detached;
    pthread_t thread;

    if (pthread_attr_init(&detached) != 0)
        return;
    (void)pthread_attr_setdetachstate(&detached, PTHREAD_CREATE_DETACHED);
    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before); /* signals are for the other threads */
    (void)pthread_create(&thread, &detached, watch, NULL);
    (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
    (void)pthread_attr_destroy(&detached);
}
