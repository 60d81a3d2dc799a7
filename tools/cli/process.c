/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* for prctl of Linux */
#include "process.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

/* The path of the tool with this name in the folder of this tool; if there is none, its name alone, for
 * PATH. */
static const char *
beside(const char *name, char path[4096])
{
    ssize_t n = readlink("/proc/self/exe", path, 4000);
    char *slash;

    path[n > 0 ? n : 0] = '\0';
    if ((slash = strrchr(path, '/')) == NULL)
        return name;
    snprintf(slash + 1, (size_t)(path + 4096 - slash - 1), "%s", name);
    return access(path, X_OK) == 0 ? path : name;
}

static _Noreturn void
become(const char *const word[], int in, int out, int said, const char *folder)
{
    char path[4096];

#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL); /* it ends with its parent */
#endif
    if (dup2(in, STDIN_FILENO) >= 0 && dup2(out, STDOUT_FILENO) >= 0 &&
        dup2(said, STDERR_FILENO) >= 0 && (folder == NULL || chdir(folder) == 0))
        execvp(beside(word[0], path), (char *const *)word);
    dprintf(said, "%s: it cannot be run: %s\n", word[0], strerror(errno));
    _exit(127);
}

static pid_t
start(const char *const word[], int in, int out, int said, const char *folder)
{
    pid_t child;

    lseek(in, 0, SEEK_SET);
    fflush(NULL); /* so that the child does not write the parent's buffers */
    if ((child = fork()) == 0)
        become(word, in, out, said, folder);
    return child;
}

/* True if the process has ended and waits for waitpid. */
static bool
has_ended(pid_t child)
{
    siginfo_t how = {0};

    return waitid(P_PID, (id_t)child, &how, WEXITED | WNOHANG | WNOWAIT) == 0 && how.si_pid != 0;
}

/* Reads the output of the process until it ends or must be stopped. */
static enum process_end
listen_to(struct tool *t, struct process *p, pid_t child, int from, double until)
{
    size_t n = 0, room = 0;

    for (;;) {
        struct pollfd at = {from, POLLIN, 0};
        ssize_t got;

        if (tool_interrupted() != 0)
            return PROCESS_INTERRUPTED;
        if (tool_now() > until)
            return PROCESS_LATE;
        tool_progress(t, NAN, "%s", p->doing);
        if (poll(&at, 1, 50) <= 0) {
            if (has_ended(child)) /* and the other end is still open */
                return PROCESS_ENDED;
            continue;
        }
        if (n + 4096 > room) {
            char *more = realloc(p->said, room = 2 * room + 8192);
            if (more == NULL)
                return PROCESS_DIED;
            p->said = more;
        }
        got = read(from, p->said + n, room - n - 1);
        if (got < 0 && errno == EINTR)
            continue;
        n += got > 0 ? (size_t)got : 0;
        p->said[n] = '\0';
        if (got <= 0)
            return got == 0 ? PROCESS_ENDED : PROCESS_DIED;
    }
}

enum process_end
process_run(struct tool *t, const char *const word[], struct process *p)
{
    double until = tool_now() + p->allowed;
    enum process_end end;
    int said[2], how = 0;
    pid_t child;

    p->status = -1;
    p->said = NULL;
    if (pipe(said) != 0)
        tool_die(t, "no pipe can be made: %s", strerror(errno));
    fcntl(said[0], F_SETFD, FD_CLOEXEC);
    fcntl(said[1], F_SETFD, FD_CLOEXEC);
    child = start(word, p->in, p->out >= 0 ? p->out : said[1], said[1], p->folder);
    close(said[1]);
    end = child < 0 ? PROCESS_DIED : listen_to(t, p, child, said[0], until);
    close(said[0]);
    tool_progress_end(t);
    if (child < 0)
        return end;
    if (end != PROCESS_ENDED)
        kill(child, SIGKILL);
    while (waitpid(child, &how, 0) < 0 && errno == EINTR)
        ;
    if (end != PROCESS_ENDED)
        return end;
    if (tool_interrupted() != 0) /* Ctrl-C reaches both processes */
        return PROCESS_INTERRUPTED;
    if (!WIFEXITED(how))
        return PROCESS_DIED;
    p->status = WEXITSTATUS(how);
    return p->status == 0 || p->status == EXIT_SHORT ? PROCESS_ENDED : PROCESS_FAILED;
}
