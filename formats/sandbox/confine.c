/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "confine.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include "formats/core/core.h"

static const double seconds_least = 0.8, bytes_a_second = 1e7;
/* The limit of wall-clock time is this many times larger, because a child that waits uses no processor
 * time. */
static const double clock_factor = 10;

double
rc_confine_seconds(const struct rc_file *file)
{
    return seconds_least + (double)file->size / bytes_a_second;
}

/* Address space in use; 0 if the system does not say. */
static size_t
space_now(void)
{
    unsigned long pages = 0;
    FILE *f = fopen("/proc/self/statm", "r");

    if (f == NULL)
        return 0;
    if (fscanf(f, "%lu", &pages) != 1)
        pages = 0;
    fclose(f);
    return pages * (size_t)sysconf(_SC_PAGESIZE);
}

static void
limit(int what, rlim_t most)
{
    struct rlimit r;

    if (getrlimit(what, &r) != 0)
        return;
    if (r.rlim_max != RLIM_INFINITY && r.rlim_max < most)
        most = r.rlim_max;
    r.rlim_cur = r.rlim_max = most;
    setrlimit(what, &r);
}

static void
set_timer(int which, double seconds)
{
    struct itimerval timer = {{0, 0}, {0, 0}};
    double whole;

    timer.it_value.tv_usec = (suseconds_t)(1e6 * modf(seconds, &whole));
    timer.it_value.tv_sec = (time_t)whole;
    setitimer(which, &timer, NULL);
}

void
rc_confine(const struct rc_file *file)
{
    /* the parent may catch these signals; the child must die of them */
    static const int signals[] = {SIGPROF, SIGALRM, SIGINT,  SIGTERM, SIGHUP, SIGPIPE,
                                  SIGSEGV, SIGBUS,  SIGABRT, SIGFPE,  SIGILL, SIGSYS};
    size_t space = space_now();
    sigset_t none;

    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    for (size_t k = 0; k < sizeof signals / sizeof *signals; k++)
        signal(signals[k], SIG_DFL);
    set_timer(ITIMER_PROF, rc_confine_seconds(file));
    set_timer(ITIMER_REAL, clock_factor * rc_confine_seconds(file));
    limit(RLIMIT_CPU, (rlim_t)rc_confine_seconds(file) + 2); /* in case the signals are blocked */
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, 0);
    limit(RLIMIT_NOFILE, 0); /* a malicious file then cannot open other files */
    if (space > 0)
        limit(RLIMIT_AS, (rlim_t)(space + rc_memory_limit(file->size)));
}
