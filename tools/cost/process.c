#define _DEFAULT_SOURCE /* MAP_ANONYMOUS, which POSIX 2008 lacks */
#include "cost.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

void *
cost_share(size_t bytes)
{
    void *shared = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);

    return shared == MAP_FAILED ? NULL : shared;
}

void
cost_unshare(void *shared, size_t bytes)
{
    if (shared != NULL)
        munmap(shared, bytes);
}

static _Noreturn void
be_child(void (*work)(void *ctx), void *ctx)
{
    /* the parent's handlers would remove the parent's files */
    signal(SIGINT, SIG_DFL);
    signal(SIGTERM, SIG_DFL);
    signal(SIGHUP, SIG_DFL);
    work(ctx);
    _exit(0);
}

static void
end(pid_t child)
{
    kill(child, SIGKILL);
    while (waitpid(child, NULL, 0) < 0 && errno == EINTR)
        ;
}

enum cost_end
cost_run(void (*work)(void *ctx), void *ctx, double allowed, void (*watch)(void *ctx))
{
    double start = tool_now(), pause = 1e-3;
    pid_t child, done;
    int status;

    fflush(NULL); /* what waits in a buffer is the parent's to write */
    if ((child = fork()) == 0)
        be_child(work, ctx);
    if (child < 0)
        return COST_DIED;
    while ((done = waitpid(child, &status, WNOHANG)) == 0 || (done < 0 && errno == EINTR)) {
        struct timespec wait = {0, (long)(1e9 * pause)};

        if (tool_interrupted() != 0 || tool_now() - start > allowed) {
            end(child);
            return tool_interrupted() != 0 ? COST_INTERRUPTED : COST_LATE;
        }
        watch(ctx);
        nanosleep(&wait, NULL);
        pause = pause < 0.02 ? 1.5 * pause : pause;
    }
    if (tool_interrupted() != 0) /* Ctrl-C reaches both */
        return COST_INTERRUPTED;
    return done == child && WIFEXITED(status) && WEXITSTATUS(status) == 0 ? COST_ENDED : COST_DIED;
}
