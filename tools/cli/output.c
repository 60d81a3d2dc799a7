/*
 * Output that appears whole or not at all, also when a signal ends the tool.
 */
#include "tool.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "parts.h"
#include "pipe.h"

enum {
    PATH_SIZE = 4096
};

/* The file under construction: a signal handler has to find it, so there is one. */
static char half_written[PATH_SIZE];
static char destination[PATH_SIZE];

/* ---- signals ---- */

static volatile sig_atomic_t interrupted;
static const int signals_handled[] = {SIGINT, SIGTERM, SIGHUP};

static void
end_by(int number)
{
    if (half_written[0] != '\0')
        unlink(half_written);
    signal(number, SIG_DFL);
    raise(number);
}

static void
note_signal(int number)
{
    interrupted = number;
    signal(number, SIG_DFL); /* a second one is final */
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
    handle(note_signal);
}

int
tool_interrupted(void)
{
    return interrupted;
}

void
output_handle_signals(void)
{
    handle(end_by);
}

/* ---- the file or the stream ---- */

/* Where -o leads when it is to appear whole: through symbolic links, so that a link stays one. */
static void
resolve(struct tool *t, const char *name)
{
    char *real = realpath(name, NULL);

    if (strlen(real == NULL ? name : real) >= PATH_SIZE - 8)
        tool_die(t, EXIT_IMPOSSIBLE, "-o %s: the name is too long", name);
    strcpy(destination, real == NULL ? name : real);
    free(real);
}

static void
open_temporary(struct tool *t)
{
    mode_t mask = umask(0);
    char name[PATH_SIZE];
    int fd;

    umask(mask);
    resolve(t, t->out_name);
    snprintf(name, sizeof name, "%s", destination);
    strcat(name, ".XXXXXX");
    fd = mkstemp(name);
    if (fd < 0)
        tool_die(t, EXIT_IMPOSSIBLE, "-o %s: %s", t->out_name, strerror(errno));
    strcpy(half_written, name);
    if (fchmod(fd, 0666 & ~mask) != 0 || (t->out = fdopen(fd, "wb")) == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "-o %s: %s", t->out_name, strerror(errno));
}

void
output_open(struct tool *t)
{
    struct stat st;
    struct rc_err err;
    bool binary = t->writes != WRITES_TEXT;

    if (t->out_name == NULL) {
        if (binary && isatty(STDOUT_FILENO))
            tool_die(t, EXIT_IMPOSSIBLE,
                     "standard output is a terminal: pipe it into the next tool or give -o FILE");
        t->out = stdout;
    } else if (stat(t->out_name, &st) == 0 && !S_ISREG(st.st_mode)) {
        if (S_ISDIR(st.st_mode))
            tool_die(t, EXIT_IMPOSSIBLE, "-o %s: this is a folder", t->out_name);
        if ((t->out = fopen(t->out_name, "wb")) == NULL)
            tool_die(t, EXIT_IMPOSSIBLE, "-o %s: %s", t->out_name, strerror(errno));
        if (binary && isatty(fileno(t->out)))
            tool_die(t, EXIT_IMPOSSIBLE, "-o %s: this is a terminal", t->out_name);
    } else {
        open_temporary(t);
    }
    if (binary)
        setvbuf(t->out, NULL, _IOFBF, TOOL_BUFFER);
    if (binary)
        pipe_widen(fileno(t->out));
    if (t->writes == WRITES_STREAM && (t->writer = rc_writer_new(t->out, &err)) == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "%s", err.text);
}

void
tool_write(struct tool *t, struct rc_grid *g)
{
    enum rc_type type = g->type;
    struct rc_err err;

    if (t->report_alone)
        return;
    if (t->type_given)
        g->type = t->type;
    t->began = true;
    if (rc_writer_put(t->writer, g, &err) != RC_OK)
        tool_die_at(t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    g->type = type;
}

void
output_end(struct tool *t)
{
    const char *name = t->out_name == NULL ? "standard output" : t->out_name;
    struct rc_err err;

    if (t->writer != NULL && rc_writer_end(t->writer, &err) != RC_OK)
        tool_die(t, EXIT_IMPOSSIBLE, "%s: %s", name, err.text);
    t->ended = true; /* an end line is out: nothing may follow it */
    rc_writer_free(t->writer);
    t->writer = NULL;
    if (fflush(t->out) != 0 || ferror(t->out) || fclose(t->out) != 0)
        tool_die(t, EXIT_IMPOSSIBLE, "%s: writing failed (%s)", name, strerror(errno));
    if (half_written[0] != '\0' && rename(half_written, destination) != 0)
        tool_die(t, EXIT_IMPOSSIBLE, "-o %s: %s", t->out_name, strerror(errno));
    half_written[0] = '\0';
    if (interrupted != 0)
        end_by(interrupted);
}

/* Where RCGFAIL is to stand; NULL: nowhere. A reader in a pipe waits for a stream also where none
 * has begun; a file that has none yet gets none. */
static FILE *
stream_to_fail(const struct tool *t)
{
    bool before = interrupted == 0;

    if (half_written[0] != '\0' || t->ended)
        return NULL;
    if (t->out == NULL) /* the command line is being read */
        return t->stream_expected && before && pipe_is(STDOUT_FILENO) ? stdout : NULL;
    return t->writer != NULL && (t->began || (before && pipe_is(fileno(t->out)))) ? t->out : NULL;
}

void
output_abandon(struct tool *t, const char *why, int exit_status)
{
    FILE *stream = stream_to_fail(t);

    if (stream != NULL) {
        signal(SIGPIPE, SIG_IGN); /* a reader that has gone does not change the exit status */
        rc_stream_fail(stream, why, exit_status);
    }
    if (half_written[0] != '\0')
        unlink(half_written);
    half_written[0] = '\0';
    if (interrupted != 0)
        end_by(interrupted); /* the signal broke off a read or a write: it is the reason */
}
