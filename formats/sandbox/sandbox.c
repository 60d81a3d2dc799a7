/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sandbox.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
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

/* A confined child, and the parent's end of its pipe. */
struct child {
    pid_t pid; /* 0 in the child itself */
    FILE *result;
};

/* Starts the child. Returns false, with the reason, if there is none. */
static bool
start(struct child *c, const struct rc_file *file, struct rc_err *err)
{
    int end[2], own;

    if (pipe(end) != 0) {
        rc_err_set(err, "no pipe for reading the file: %s", strerror(errno));
        return false;
    }
    c->pid = fork();
    own = c->pid == 0;
    close(end[!own]);
    c->result = c->pid < 0 ? NULL : fdopen(end[own], own ? "wb" : "rb");
    if (c->pid == 0) {
        if (c->result == NULL)
            _exit(1);
        rc_confine(file);
        if (!rc_calls_filter(end[1]))
            _exit(1);
        return true;
    }
    if (c->result != NULL)
        return true;
    close(end[0]);
    if (c->pid < 0) {
        rc_err_set(err, "no process for reading the file: %s", strerror(errno));
    } else {
        kill(c->pid, SIGKILL);
        waitpid(c->pid, NULL, 0);
        rc_err_set(err, "out of memory for a pipe");
    }
    return false;
}

/* The number of kB after `key` at the beginning of a line of /proc/CHILD/NAME. 0: there is no such line. Does
 * not allocate, because the next child would inherit the memory. */
static size_t
kilobytes(pid_t child, const char *name, const char *key)
{
    char text[8192] = "\n", line[64];
    ssize_t n, got = 1;
    const char *at;
    int file;

    snprintf(line, sizeof line, "/proc/%ld/%s", (long)child, name);
    if ((file = open(line, O_RDONLY | O_CLOEXEC)) < 0)
        return 0;
    while (got < (ssize_t)sizeof text - 1 &&
           (n = read(file, text + got, sizeof text - 1 - (size_t)got)) > 0)
        got += n;
    close(file);
    text[got] = '\0';
    snprintf(line, sizeof line, "\n%s", key);
    at = strstr(text, line);
    return at == NULL ? 0 : strtoul(at + strlen(line), NULL, 10);
}

/* Largest private memory of a child, in bytes, which it does not share with other processes. It includes
 * freed memory. 0 if the system does not say, or the child has ended. Code is excluded, because it is memory
 * of a file. */
static size_t
memory_of(pid_t child)
{
    size_t most = kilobytes(child, "status", "VmHWM:"), now = kilobytes(child, "status", "VmRSS:");
    size_t own = kilobytes(child, "smaps_rollup", "Private_Dirty:");

    return own == 0 ? 0 : 1024 * (own + (most > now ? most - now : 0));
}

static _Noreturn void
leave(const struct child *c, bool sent)
{
    _exit(fflush(c->result) == 0 && sent ? 0 : 1);
}

/* Waits for the end of the child; if its result is incomplete, *err says how the child ended. */
static void
finish(const struct child *c, const struct rc_file *file, bool whole, struct rc_err *err)
{
    int how = 0;
    pid_t got;

    fclose(c->result);
    while ((got = waitpid(c->pid, &how, 0)) < 0 && errno == EINTR)
        continue;
    if (whole)
        return;
    if (got == c->pid && WIFSIGNALED(how) && (WTERMSIG(how) == SIGPROF || WTERMSIG(how) == SIGALRM))
        rc_err_set(
            err, "the file keeps its library busy for more than %.1f s: it is damaged, or made to",
            rc_confine_seconds(file));
    else if (got == c->pid && WIFSIGNALED(how))
        rc_err_set(err, "the library for this file failed (%s): the file is damaged or malicious",
                   strsignal(WTERMSIG(how)));
    else
        rc_err_set(err,
                   "the library for this file failed: the file is damaged, or needs more than %zu "
                   "MiB, the limit for %zu bytes",
                   rc_memory_limit(file->size) >> 20, file->size);
}

enum rc_status
rc_sandbox_describe(struct rc_maps *maps, rc_maps_find *find, struct rc_err *err)
{
    struct rc_result r = {0};
    struct child child;
    bool whole;

    if (bypassed)
        return rc_maps_describe(maps, find, err);
    if (!start(&child, maps->file, err))
        return RC_FAIL;
    if (child.pid == 0) {
        if (rc_maps_describe(maps, find, &r.said) == RC_OK)
            r.n = maps->n;
        leave(&child, rc_result_send_list(child.result, &r, maps));
    }
    whole = rc_result_receive(child.result, &r) && rc_result_receive_list(child.result, &r, maps);
    if (whole && r.n == 0)
        rc_err_set(err, "%s", r.said.text);
    finish(&child, maps->file, whole, err);
    return whole && r.n > 0 ? RC_OK : RC_FAIL;
}

struct rc_grid *
rc_sandbox_read(struct rc_maps *maps, rc_maps_find *find, const struct rc_wish *wish, size_t index,
                struct rc_notes *notes, struct rc_err *err)
{
    const struct rc_file *file = maps->file;
    struct rc_result r = {0};
    struct rc_grid *g = NULL;
    struct child child;
    bool whole;

    if (bypassed)
        return rc_maps_read(maps, wish, index, notes, err);
    if (!start(&child, file, err))
        return NULL;
    if (child.pid == 0) {
        maps->n = maps->keys = 0;
        if (rc_maps_describe(maps, find, &r.said) == RC_OK)
            g = rc_maps_read(maps, wish, index, &r.noted, &r.said);
        r.n = g != NULL;
        leave(&child, rc_result_send_grid(child.result, &r, g));
    }
    whole = rc_result_receive(child.result, &r);
    if (notes != NULL) /* while the child writes the values */
        notes->held = memory_of(child.pid);
    if (whole && r.n > 0)
        whole = (g = rc_result_receive_grid(child.result, file)) != NULL;
    if (notes != NULL)
        notes->metres = whole ? r.noted.metres : 0;
    for (size_t k = 0; whole && k < r.noted.n; k++)
        rc_note(notes, "%s", r.noted.text[k]);
    if (whole && g == NULL)
        rc_err_set(err, "%s", r.said.text);
    finish(&child, file, whole, err);
    return g;
}
