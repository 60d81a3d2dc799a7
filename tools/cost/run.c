/* The programs that rc-cost runs: finds, starts and awaits them, and reads their messages. */
#define _GNU_SOURCE /* of Linux: prctl */
#include "cost.h"

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

/* ---- files ---- */

int
cost_file(struct tool *t)
{
    const char *folder = getenv("TMPDIR");
    char name[4096];
    int fd;

    snprintf(name, sizeof name, "%s/rc-cost-XXXXXX",
             folder == NULL || *folder == '\0' ? "/tmp" : folder);
    if ((fd = mkstemp(name)) < 0)
        tool_die(t, EXIT_IMPOSSIBLE, "a temporary file %s cannot be made: %s", name,
                 strerror(errno));
    unlink(name);
    fcntl(fd, F_SETFD, FD_CLOEXEC);
    return fd;
}

FILE *
cost_file_read(struct tool *t, int file)
{
    int fd = fcntl(file, F_DUPFD_CLOEXEC, 0);
    FILE *stream;

    if (fd < 0 || lseek(fd, 0, SEEK_SET) < 0 || (stream = fdopen(fd, "rb")) == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "a temporary file cannot be read: %s", strerror(errno));
    return stream;
}

/* ---- processes ---- */

/* The path of the tool of that name in the folder of this one; else its name alone, for PATH. */
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
become(const char *const word[], int in, int out, int said)
{
    char path[4096];

#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL); /* it ends with its parent */
#endif
    if (dup2(in, STDIN_FILENO) >= 0 && dup2(out, STDOUT_FILENO) >= 0 &&
        dup2(said, STDERR_FILENO) >= 0)
        execvp(beside(word[0], path), (char *const *)word);
    dprintf(said, "%s: it cannot be run: %s\n", word[0], strerror(errno));
    _exit(127);
}

static pid_t
start(const char *const word[], int in, int out, int said)
{
    pid_t child;

    lseek(in, 0, SEEK_SET);
    fflush(NULL); /* so that the child does not write the parent's buffers */
    if ((child = fork()) == 0)
        become(word, in, out, said);
    return child;
}

void
cost_wait(int process, bool ends)
{
    if (ends)
        kill(process, SIGKILL);
    while (waitpid(process, NULL, 0) < 0 && errno == EINTR)
        ;
}

static void
make_pipe(struct tool *t, int end[2])
{
    if (pipe(end) != 0)
        tool_die(t, EXIT_IMPOSSIBLE, "no pipe can be made: %s", strerror(errno));
    fcntl(end[0], F_SETFD, FD_CLOEXEC);
    fcntl(end[1], F_SETFD, FD_CLOEXEC);
}

/* Reads the output of the process until it ends or must be stopped. */
static enum cost_end
listen_to(struct cost_case *c, int from, double until, const char *doing)
{
    size_t n = 0, room = 0;

    for (;;) {
        struct pollfd at = {from, POLLIN, 0};
        ssize_t got;

        if (tool_interrupted() != 0)
            return COST_INTERRUPTED;
        if (tool_now() > until)
            return COST_LATE;
        tool_progress(c->tool, NAN, "%s", doing);
        if (poll(&at, 1, 50) <= 0)
            continue;
        if (n + 4096 > room) {
            char *more = realloc(c->said, room = 2 * room + 8192);
            if (more == NULL)
                return COST_DIED;
            c->said = more;
        }
        got = read(from, c->said + n, room - n - 1);
        if (got < 0 && errno == EINTR)
            continue;
        n += got > 0 ? (size_t)got : 0;
        c->said[n] = '\0';
        if (got <= 0)
            return COST_ENDED;
    }
}

enum cost_end
cost_run(struct cost_case *c, const char *const word[], int in, int out, double allowed,
         const char *doing, int *status)
{
    double until = tool_now() + allowed;
    enum cost_end end;
    int said[2], how = 0;
    pid_t child;

    *status = -1;
    free(c->said);
    c->said = NULL;
    make_pipe(c->tool, said);
    if (out >= 0 && (ftruncate(out, 0) != 0 || lseek(out, 0, SEEK_SET) < 0) && errno != EINVAL)
        tool_die(c->tool, EXIT_IMPOSSIBLE, "a temporary file cannot be written: %s",
                 strerror(errno));
    child = start(word, in, out >= 0 ? out : said[1], said[1]);
    close(said[1]);
    end = child < 0 ? COST_DIED : listen_to(c, said[0], until, doing);
    close(said[0]);
    tool_progress_end(c->tool);
    if (child < 0)
        return end;
    if (end != COST_ENDED) {
        cost_wait(child, true);
        return end;
    }
    while (waitpid(child, &how, 0) < 0 && errno == EINTR)
        ;
    if (tool_interrupted() != 0) /* Ctrl-C reaches both processes */
        return COST_INTERRUPTED;
    if (!WIFEXITED(how))
        return COST_DIED;
    *status = WEXITSTATUS(how);
    return *status == 0 || *status == EXIT_SHORT ? COST_ENDED : COST_FAILED;
}

int
cost_start(struct tool *t, const char *const word[], int in, FILE **out)
{
    int from[2];
    pid_t child;

    make_pipe(t, from);
    child = start(word, in, from[1], STDERR_FILENO);
    close(from[1]);
    if (child < 0 || (*out = fdopen(from[0], "rb")) == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "%s cannot be run: %s", word[0], strerror(errno));
    return child;
}

/* ---- their reports and messages ---- */

double
cost_number(const char *report, const char *key)
{
    char name[64];
    const char *last = report, *line = report;

    if (report == NULL)
        return NAN;
    for (; line != NULL; line = strchr(line, '\n')) {
        line += *line == '\n';
        last = *line == '{' ? line : last;
    }
    snprintf(name, sizeof name, "\"%s\": ", key);
    while ((last = strstr(last, name)) != NULL) {
        last += strlen(name);
        if (*last == 't' || *last == 'f')
            return *last == 't';
        if (strchr("\"{[n", *last) == NULL)
            return strtod(last, NULL);
    }
    return NAN;
}

const char *
cost_message(const char *said)
{
    static char text[256];
    const char *line = said == NULL ? "" : said, *next, *at;

    for (text[0] = '\0'; *line != '\0'; line = next) {
        size_t n = strcspn(line, "\n"), name = strcspn(line, " \n");

        next = line + n + (line[n] == '\n');
        if (strncmp(line, "rc-", 3) == 0 && line[name - 1] == ':' && line[name] == ' ')
            snprintf(text, sizeof text, "%.*s", (int)(n - name - 1), line + name + 1);
    }
    at = strstr(text, ", frame ");
    at = at == NULL ? NULL : strstr(at, "): ");
    return at == NULL ? text : at + 3;
}
