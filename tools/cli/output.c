/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Output that appears whole or not at all, also when a signal ends the tool.
 */
#include "tool.h"

#include <errno.h>
#include <signal.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "parts.h"
#include "tools/machine/machine.h"
#include "ranks.h"

/* The file of -o, for the signal handler. */
static struct whole_file output = {.slot = -1};

/* ---- signals ---- */

static volatile sig_atomic_t interrupted;
static const struct tool *together; /* the processes that share the maps; NULL: a single process */
static char no_time[256];           /* the message before a launcher kills the process */
static const int signals_handled[] = {SIGINT, SIGTERM, SIGHUP};

static void
end_by(int number)
{
    whole_files_remove();
    signal(number, SIG_DFL);
    raise(number);
}

/* For several processes: the launcher kills them before the current result can be written. It returns the
 * exit status of the process that ends first, so this is an exit status of the tools. */
static void
end_in_time(int number)
{
    (void)number;
    whole_files_remove();
    if (ranks_speak(together))
        (void)!write(STDERR_FILENO, no_time, strlen(no_time));
    _exit(EXIT_IMPOSSIBLE);
}

static void
note_signal(int number)
{
    if (together != NULL && whole_file_is_half(&output))
        end_in_time(number); /* one of several processes may have died */
    interrupted = number;
    signal(number, end_by); /* a second signal ends the tool */
    if (together != NULL)
        ranks_hurry(together);
}

static void
handle(void (*handler)(int))
{
    for (size_t k = 0; k < sizeof signals_handled / sizeof *signals_handled; k++)
        if (signal(signals_handled[k], handler) == SIG_IGN)
            signal(signals_handled[k], SIG_IGN); /* nohup stays nohup */
}

void
tool_catch_signals(void)
{
    if (interrupted != 0)
        return; /* the next signal ends the tool */
    if (together != NULL)
        signal(SIGALRM, end_in_time);
    handle(note_signal);
}

void
tool_release_signals(void)
{
    if (together != NULL)
        return;
    if (interrupted != 0)
        end_by(interrupted);
    handle(end_by);
}

int
tool_interrupted(void)
{
    return together == NULL ? interrupted : (int)ranks_most(together, (double)interrupted);
}

const volatile sig_atomic_t *
tool_signal(void)
{
    return &interrupted;
}

void
output_handle_signals(void)
{
    handle(end_by);
    signal(SIGXFSZ,
           SIG_IGN); /* a write beyond the limit of a file's size fails, as on a full disk */
}

/* ---- the file or the stream ---- */

/* Ends the tool if several processes have no file that they can share. The file is made at the first write,
 * so that a process that is killed before leaves none. */
static void
demand_shared_file(struct tool *t)
{
    struct stat st;

    if (t->out_name == NULL)
        tool_usage(
            t,
            "several processes write a file, each its part of it: give -o FILE instead of a pipe");
    if (stat(t->out_name, &st) == 0 && !S_ISREG(st.st_mode))
        tool_die(t,
                 "-o %s: several processes write a file, each its part of it: give a regular file",
                 t->out_name);
    tool_demand_writable(t, "-o", t->out_name);
}

/* The first process makes the file, and all open it. All know its name before it exists: if one process is
 * killed, the others remove it. */
static void
open_shared(struct tool *t)
{
    char name[WHOLE_PATH] = "";
    FILE *file;

    if (ranks_speak(t)) {
        if (!whole_file_choose(&output, t->out_name))
            tool_die(t, "-o %s: %s", t->out_name, strerror(errno));
        snprintf(name, sizeof name, "%s", whole_file_name(&output));
    }
    ranks_share(t, 0, name, sizeof name);
    if (!ranks_speak(t))
        whole_file_share(&output, name);
    ranks_wait(t);
    if (ranks_speak(t) && ((file = whole_file_create(&output)) == NULL || fclose(file) != 0))
        tool_die(t, "-o %s: %s", t->out_name, strerror(errno));
    ranks_wait(t);
    t->output.share = ranks_write(t, name);
    t->output.writer = tool_made(t, NULL, rc_writer_new_shared(t->output.share, 0, &t->err));
}

void
output_open(struct tool *t)
{
    struct stat st;
    bool binary = t->writes != WRITES_TEXT;

    together = t->ranks == NULL ? NULL : t;
    snprintf(
        no_time, sizeof no_time,
        "%s: ended by a signal, without time to write the current result: see contact-mpi(7)\n",
        t->info->name);
    if (t->ranks != NULL && t->writes == WRITES_STREAM) {
        demand_shared_file(t);
        return;
    }
    if (t->out_name == NULL) {
        if (binary && isatty(STDOUT_FILENO))
            tool_die(t,
                     "standard output is a terminal: pipe it into the next tool or give -o FILE");
        t->output.file = stdout;
    } else {
        if (stat(t->out_name, &st) == 0 && S_ISDIR(st.st_mode))
            tool_die(t, "-o %s: this is a folder", t->out_name);
        if ((t->output.file = whole_file_open(&output, t->out_name)) == NULL)
            tool_die(t, "-o %s: %s", t->out_name, strerror(errno));
        if (binary && isatty(fileno(t->output.file)))
            tool_die(t, "-o %s: this is a terminal", t->out_name);
    }
    if (binary)
        setvbuf(t->output.file, NULL, _IOFBF, TOOL_BUFFER);
    if (binary)
        pipe_widen(fileno(t->output.file));
    if (t->writes == WRITES_STREAM &&
        (t->output.writer = rc_writer_new(t->output.file, &t->err)) == NULL)
        tool_die(t, "%s", t->err.text);
}

/* Values near the limits of a double can overflow in the computation: then there is no output. n: of the map
 * so far. */
static void
demand_no_new(struct tool *t, const struct rc_grid *g, struct not_finite n)
{
    if (n.infinite > 0 && !t->input.infinite)
        tool_refuse(t, g,
                    "%zu of %zu values of %s are too large for %s: are the units of heights, "
                    "spacings, loads and moduli right?%s",
                    n.infinite, g->nx * g->ny, g->channel,
                    g->type == RC_F32 ? "single precision" : "a number",
                    g->type == RC_F32 ? " --type f64 holds more" : "");
    if (n.missing > 0 && !t->input.missing)
        tool_refuse(t, g,
                    "%zu of %zu values of %s are undefined, because numbers were too large or too "
                    "small: are the units of heights, spacings, loads and moduli right?",
                    n.missing, g->nx * g->ny, g->channel);
}

/* Copies the rows of the last frame that was read. */
static void
copy_rows(struct tool *t, struct rc_grid *g)
{
    const size_t most = tool_rows_together(g->nx);
    RC_OWNED double *v = tool_room(t, most * g->nx, sizeof *v, "some rows of a map");

    tool_write_head(t, g);
    for (size_t n, left = g->ny; left > 0; left -= n) {
        n = left < most ? left : most;
        tool_read_rows(t, n, v);
        tool_write_rows(t, g, n, v);
    }
}

void
tool_write(struct tool *t, struct rc_grid *g)
{
    enum rc_type type = g->type;

    if (t->output.report_alone)
        return;
    if (t->input.by_rows && !tool_has_values(g)) {
        copy_rows(t, g);
        return;
    }
    if (t->ranks != NULL && t->output.writer == NULL)
        open_shared(t);
    if (t->output.type_given)
        g->type = t->output.type;
    if (!(t->input.missing && t->input.infinite))
        demand_no_new(t, g, not_finite(t, g));
    t->output.began = true;
    tool_must(t, g, rc_writer_put(t->output.writer, g, &t->err));
    g->type = type;
}

void
tool_write_head(struct tool *t, struct rc_grid *g)
{
    enum rc_type type = g->type;

    if (t->output.type_given)
        g->type = t->output.type;
    t->output.began = true;
    t->output.left = g->nx * g->ny;
    t->output.missing = t->output.infinite = 0;
    tool_must(t, g, rc_writer_begin(t->output.writer, g, &t->err));
    g->type = type;
}

void
tool_write_rows(struct tool *t, const struct rc_grid *g, size_t n, const double *v)
{
    const size_t values = n * g->nx;
    struct rc_grid as = *g;
    struct not_finite found;

    if (t->output.type_given)
        as.type = t->output.type;
    found = not_finite_in(as.type, v, values);
    t->output.missing += found.missing;
    t->output.infinite += found.infinite;
    t->output.left -= values;
    if (t->output.left == 0)
        demand_no_new(t, &as, (struct not_finite){t->output.missing, t->output.infinite});
    tool_must(t, g, rc_writer_values(t->output.writer, v, values, &t->err));
}

void
output_end(struct tool *t)
{
    const char *name = t->out_name == NULL ? "standard output" : t->out_name;

    if (t->ranks != NULL && t->writes == WRITES_STREAM && t->output.writer == NULL)
        open_shared(t); /* the file holds no frame */
    if (t->output.writer != NULL && rc_writer_end(t->output.writer, &t->err) != RC_OK)
        tool_die(t, "%s: %s", name, t->err.text);
    t->output.ended = true; /* an end line was written: nothing may follow it */
    rc_writer_free(t->output.writer);
    t->output.writer = NULL;
    if (ranks_settle(t->output.share, &t->err) != RC_OK)
        tool_die(t, "%s: %s", name, t->err.text);
    ranks_close(t, t->output.share);
    t->output.share = NULL;
    if (!ranks_speak(t))
        whole_file_share(&output, ""); /* the first process renames it */
    if (!whole_file_put(&output, t->output.file))
        tool_die(t, "%s: writing failed (%s)", name, strerror(errno));
    /* The result is complete. When one process ends with a status above 0, the launcher signals the
     * others. */
    if (together != NULL) {
        handle(SIG_IGN);
        signal(SIGALRM, SIG_IGN);
    }
}

void
output_end_by_signal(void)
{
    if (interrupted != 0)
        end_by(interrupted);
}

/* The file for RCGFAIL; NULL: none. A reader in a pipe waits for a stream even before one has begun; a file
 * without a stream gets no such line. */
static FILE *
stream_to_fail(const struct tool *t)
{
    bool before = interrupted == 0;

    if (t->ranks != NULL)
        return NULL;
    if (whole_file_is_half(&output) || t->output.ended)
        return NULL;
    if (t->output.file == NULL) /* while the command line is read */
        return t->output.expected && before && pipe_is(STDOUT_FILENO) ? stdout : NULL;
    return t->output.writer != NULL &&
                   (t->output.began || (before && pipe_is(fileno(t->output.file))))
               ? t->output.file
               : NULL;
}

void
output_abandon(struct tool *t, const char *why, int exit_status)
{
    FILE *stream = stream_to_fail(t);

    if (stream != NULL) {
        signal(SIGPIPE, SIG_IGN); /* a reader that has ended does not change the exit status */
        rc_stream_fail(stream, why, exit_status);
    }
    whole_files_remove();
    if (interrupted != 0)
        end_by(interrupted); /* a signal interrupted a read or a write: it is the reason */
}
