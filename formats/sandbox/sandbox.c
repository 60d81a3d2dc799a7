#include "sandbox.h"

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include "result.h"
#include "formats/core/core.h"

static const double seconds_least = 0.8, bytes_a_second = 1e7;
static const double patience =
    10; /* times those, by the clock on the wall: nothing may just wait */

static bool left_open;

void
rc_cage_leave_open(bool open)
{
    left_open = open;
}

/* ---- the child ---- */

static double
time_bound(const struct rc_file *file)
{
    return seconds_least + (double)file->size / bytes_a_second;
}

/* Address space that the process has already; 0 where the system does not tell. */
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
ring_after(int which, double seconds)
{
    struct itimerval timer = {{0, 0}, {0, 0}};
    double whole;

    timer.it_value.tv_usec = (suseconds_t)(1e6 * modf(seconds, &whole));
    timer.it_value.tv_sec = (time_t)whole;
    setitimer(which, &timer, NULL);
}

static void
shut(const struct rc_file *file)
{
    size_t space = space_now();

    signal(SIGPROF, SIG_DFL);
    signal(SIGALRM, SIG_DFL);
    signal(SIGINT, SIG_DFL); /* what is half-written is the parent's business */
    signal(SIGTERM, SIG_DFL);
    signal(SIGHUP, SIG_DFL);
    signal(SIGPIPE, SIG_DFL);
    ring_after(ITIMER_PROF, time_bound(file));
    ring_after(ITIMER_REAL, patience * time_bound(file));
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, 0);
    limit(RLIMIT_NOFILE, 0); /* no further one: a file cannot name others to be read */
    if (space > 0)
        limit(RLIMIT_AS, (rlim_t)(space + rc_memory_bound(file)));
}

/* ---- there and back ---- */

static void
shut_pipes(struct rc_pipes *p)
{
    if (p->answer != NULL)
        fclose(p->answer);
    close(p->reply);
}

/* In the child it gives 0, in the parent 1, and -1 where there is no child. */
static int
divide(struct rc_pipes *p, const struct rc_file *file, struct rc_err *err)
{
    int answer[2], reply[2], side;

    if (pipe(answer) != 0) {
        rc_err_set(err, "no pipe for reading the file: %s", strerror(errno));
        return -1;
    }
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, reply) != 0) {
        rc_err_set(err, "no socket for reading the file: %s", strerror(errno));
        close(answer[0]);
        close(answer[1]);
        return -1;
    }
    p->child = fork();
    side = p->child != 0; /* the end of each that is used here: a parent reads */
    close(answer[side]);
    close(reply[side]);
    p->reply = reply[!side];
    p->answer = p->child < 0 ? NULL : fdopen(answer[!side], side == 0 ? "wb" : "rb");
    if (side == 0) {
        if (p->answer == NULL)
            _exit(1);
        shut(file);
        return 0;
    }
    if (p->answer != NULL)
        return 1;
    close(answer[0]);
    shut_pipes(p);
    if (p->child < 0) {
        rc_err_set(err, "no process for reading the file: %s", strerror(errno));
    } else {
        kill(p->child, SIGKILL);
        waitpid(p->child, NULL, 0);
        rc_err_set(err, "out of memory for a pipe");
    }
    return -1;
}

static _Noreturn void
leave(struct rc_pipes *p, bool told)
{
    _exit(fflush(p->answer) == 0 && told ? 0 : 1);
}

/* Ends the child; when its answer was not whole, says why in place of what was said before. */
static void
join(struct rc_pipes *p, const struct rc_file *file, bool whole, struct rc_err *err)
{
    int how = 0;
    pid_t got;

    shut_pipes(p);
    while ((got = waitpid(p->child, &how, 0)) < 0 && errno == EINTR)
        continue;
    if (whole)
        return;
    if (got == p->child && WIFSIGNALED(how) &&
        (WTERMSIG(how) == SIGPROF || WTERMSIG(how) == SIGALRM))
        rc_err_set(err,
                   "the file keeps its library busy for more than %.1f s: it is damaged, or "
                   "made to",
                   time_bound(file));
    else if (got == p->child && WIFSIGNALED(how))
        rc_err_set(err, "the file makes its library fail (%s): it is damaged, or made to",
                   strsignal(WTERMSIG(how)));
    else
        rc_err_set(err,
                   "the file makes its library fail: it is damaged, or needs more than the "
                   "%zu MiB that %zu bytes may take",
                   rc_memory_bound(file) >> 20, file->size);
}

size_t
rc_cage_list(rc_list_in_cage *list, const struct rc_file *file, const struct rc_wish *wish,
             struct rc_channel *channel, size_t most, struct rc_err *err)
{
    struct rc_err said = {""};
    struct rc_pipes pipes;
    size_t n = 0;
    bool whole;
    int side;

    if (left_open)
        return list(file, wish, channel, most, err);
    if ((side = divide(&pipes, file, err)) < 0)
        return 0;
    if (side == 0) {
        n = list(file, wish, channel, most, &said);
        leave(&pipes, rc_answer_send_list(&pipes, channel, n, most, &said));
    }
    whole = rc_answer_take_list(&pipes, channel, &n, most, &said);
    if (whole && n == 0)
        rc_err_set(err, "%s", said.text);
    join(&pipes, file, whole, err);
    return whole ? n : 0;
}

struct rc_grid *
rc_cage_read(rc_read_in_cage *read, const struct rc_file *file, const struct rc_wish *wish,
             size_t index, struct rc_notes *notes, struct rc_err *err)
{
    struct rc_notes noted = {0};
    struct rc_err said = {""};
    struct rc_grid *g = NULL;
    struct rc_pipes pipes;
    bool whole;
    int side;

    if (left_open)
        return read(file, wish, index, notes, err);
    if ((side = divide(&pipes, file, err)) < 0)
        return NULL;
    if (side == 0) {
        g = read(file, wish, index, &noted, &said);
        leave(&pipes, rc_answer_send_grid(&pipes, g, &noted, &said));
    }
    whole = rc_answer_take_grid(&pipes, file, &g, &noted, &said);
    for (size_t k = 0; whole && k < noted.n; k++)
        rc_note(notes, "%s", noted.text[k]);
    if (whole && g == NULL)
        rc_err_set(err, "%s", said.text);
    join(&pipes, file, whole, err);
    return g;
}
