#include "sandbox.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "calls.h"
#include "confine.h"
#include "result.h"
#include "formats/core/core.h"

static bool bypassed;

void
rc_sandbox_bypass(bool bypass)
{
    bypassed = bypass;
}

static void
close_pipes(struct rc_pipes *p)
{
    if (p->result != NULL)
        fclose(p->result);
    close(p->reply);
}

/* Makes the child, which is confined, and the pipes between the two. Gives 0 in the child, 1 in the
 * parent, and -1 with the reason when there is no child. */
static int
start(struct rc_pipes *p, const struct rc_file *file, struct rc_err *err)
{
    int result[2], reply[2], own;

    if (pipe(result) != 0) {
        rc_err_set(err, "no pipe for reading the file: %s", strerror(errno));
        return -1;
    }
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, reply) != 0) {
        rc_err_set(err, "no socket for reading the file: %s", strerror(errno));
        close(result[0]);
        close(result[1]);
        return -1;
    }
    p->held = 0;
    p->child = fork();
    own = p->child == 0; /* the child writes results at end 1, the parent reads them at end 0 */
    close(result[!own]);
    close(reply[!own]);
    p->reply = reply[own];
    p->result = p->child < 0 ? NULL : fdopen(result[own], p->child == 0 ? "wb" : "rb");
    if (p->child == 0) {
        if (p->result == NULL)
            _exit(1);
        rc_confine(file);
        rc_calls_filter(fileno(p->result), p->reply);
        return 0;
    }
    if (p->result != NULL)
        return 1;
    close(result[0]);
    close_pipes(p);
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
leave(struct rc_pipes *p, bool sent)
{
    _exit(fflush(p->result) == 0 && sent ? 0 : 1);
}

/* Waits for the end of the child; where its result is not whole, *err says how the child ended. */
static void
finish(struct rc_pipes *p, const struct rc_file *file, bool whole, struct rc_err *err)
{
    int how = 0;
    pid_t got;

    close_pipes(p);
    while ((got = waitpid(p->child, &how, 0)) < 0 && errno == EINTR)
        continue;
    if (whole)
        return;
    if (got == p->child && WIFSIGNALED(how) &&
        (WTERMSIG(how) == SIGPROF || WTERMSIG(how) == SIGALRM))
        rc_err_set(err,
                   "the file keeps its library busy for more than %.1f s: it is damaged, or "
                   "made to",
                   rc_confine_seconds(file));
    else if (got == p->child && WIFSIGNALED(how))
        rc_err_set(err, "the file makes its library fail (%s): it is damaged, or made to",
                   strsignal(WTERMSIG(how)));
    else
        rc_err_set(err,
                   "the file makes its library fail: it is damaged, or needs more than the "
                   "%zu MiB that %zu bytes may take",
                   rc_memory_limit(file->size) >> 20, file->size);
}

size_t
rc_sandbox_list(rc_sandboxed_list *list, const struct rc_file *file, const struct rc_wish *wish,
                struct rc_channel *channel, size_t most, struct rc_err *err)
{
    struct rc_err said = {""};
    struct rc_pipes pipes;
    size_t n = 0;
    bool whole;
    int side;

    if (bypassed)
        return list(file, wish, channel, most, err);
    if ((side = start(&pipes, file, err)) < 0)
        return 0;
    if (side == 0) {
        n = list(file, wish, channel, most, &said);
        leave(&pipes, rc_result_send_list(&pipes, channel, n, most, &said));
    }
    whole = rc_result_receive_list(&pipes, channel, &n, most, &said);
    if (whole && n == 0)
        rc_err_set(err, "%s", said.text);
    finish(&pipes, file, whole, err);
    return whole ? n : 0;
}

struct rc_grid *
rc_sandbox_read(rc_sandboxed_read *read, const struct rc_file *file, const struct rc_wish *wish,
                size_t index, struct rc_notes *notes, struct rc_err *err)
{
    struct rc_notes noted = {0};
    struct rc_err said = {""};
    struct rc_grid *g = NULL;
    struct rc_pipes pipes;
    bool whole;
    int side;

    if (bypassed)
        return read(file, wish, index, notes, err);
    if ((side = start(&pipes, file, err)) < 0)
        return NULL;
    if (side == 0) {
        g = read(file, wish, index, &noted, &said);
        leave(&pipes, rc_result_send_grid(&pipes, g, &noted, &said));
    }
    whole = rc_result_receive_grid(&pipes, file, &g, &noted, &said);
    if (notes != NULL) {
        notes->held = pipes.held;
        notes->metres = whole ? noted.metres : 0;
    }
    for (size_t k = 0; whole && k < noted.n; k++)
        rc_note(notes, "%s", noted.text[k]);
    if (whole && g == NULL)
        rc_err_set(err, "%s", said.text);
    finish(&pipes, file, whole, err);
    return g;
}
