#include "tool.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "libcontact/contact.h"
#include "pipe.h"

enum {
    PATH_SIZE = 4096,
    BUFFER = 1 << 20,
};

/* The file under construction: a signal handler has to find it, so there is one. */
static char half_written[PATH_SIZE];
static char destination[PATH_SIZE];

/* ---- signals ---- */

static volatile sig_atomic_t interrupted;
static const int signals_minded[] = {SIGINT, SIGTERM, SIGHUP};

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
    for (size_t k = 0; k < sizeof signals_minded / sizeof *signals_minded; k++)
        if (signal(signals_minded[k], handler) == SIG_IGN)
            signal(signals_minded[k], SIG_IGN); /* nohup stays nohup */
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

/* ---- messages ---- */

static bool progress_shown;

static void
say(struct tool *t, const char *text)
{
    tool_progress_end(t);
    fprintf(stderr, "%s: %s\n", t->info->name, text);
}

void
tool_warn(struct tool *t, const char *format, ...)
{
    char text[1024];
    va_list ap;

    if (t->quiet)
        return;
    va_start(ap, format);
    vsnprintf(text, sizeof text, format, ap);
    va_end(ap);
    say(t, text);
}

void
tool_note(struct tool *t, const char *format, ...)
{
    char text[1024];
    va_list ap;

    if (!t->verbose)
        return;
    va_start(ap, format);
    vsnprintf(text, sizeof text, format, ap);
    va_end(ap);
    say(t, text);
}

static double
now(void)
{
    struct timespec ts;

    clock_gettime(CLOCK_MONOTONIC, &ts);
    return (double)ts.tv_sec + 1e-9 * (double)ts.tv_nsec;
}

void
tool_progress(struct tool *t, const char *format, ...)
{
    static double last;
    bool terminal = isatty(STDERR_FILENO);
    va_list ap;

    if (t->quiet || !(terminal || t->progress) || now() - last < 0.1)
        return;
    last = now();
    fprintf(stderr, terminal ? "\r\033[K%s: " : "%s: ", t->info->name);
    va_start(ap, format);
    vfprintf(stderr, format, ap);
    va_end(ap);
    if (!terminal)
        fputc('\n', stderr);
    fflush(stderr);
    progress_shown = terminal;
}

void
tool_progress_end(struct tool *t)
{
    (void)t;
    if (progress_shown)
        fputs("\r\033[K", stderr);
    progress_shown = false;
}

static _Noreturn void
die(struct tool *t, int status, const char *text)
{
    say(t, text);
    if (t->writer != NULL && t->began && half_written[0] == '\0')
        rc_writer_fail(t->writer, text);
    if (half_written[0] != '\0')
        unlink(half_written);
    half_written[0] = '\0';
    if (interrupted != 0)
        end_by(interrupted); /* the signal broke off a read or a write: it is the reason */
    exit(status);
}

void
tool_die(struct tool *t, int status, const char *format, ...)
{
    char text[1024];
    va_list ap;

    va_start(ap, format);
    vsnprintf(text, sizeof text, format, ap);
    va_end(ap);
    die(t, status, text);
}

const char *
tool_where(const struct tool *t, const struct rc_grid *g, char *text, size_t size)
{
    const char *source = g == NULL ? NULL : rc_grid_get(g, "source");

    if (source == NULL)
        source = t->source == NULL ? "standard input" : t->source;
    if (g == NULL)
        snprintf(text, size, "%s", source);
    else
        snprintf(text, size, "%s, case %zu, frame %zu (%s)", source, rc_grid_case(g), t->frame,
                 g->channel);
    return text;
}

void
tool_die_at(struct tool *t, const struct rc_grid *g, int status, const char *format, ...)
{
    char text[1024], where[256], whole[1400];
    va_list ap;

    va_start(ap, format);
    vsnprintf(text, sizeof text, format, ap);
    va_end(ap);
    snprintf(whole, sizeof whole, "%s: %s", tool_where(t, g, where, sizeof where), text);
    die(t, status, whole);
}

/* ---- output ---- */

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

static void
open_output(struct tool *t)
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
        setvbuf(t->out, NULL, _IOFBF, BUFFER);
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

    if (t->type_given)
        g->type = t->type;
    t->began = true;
    if (rc_writer_put(t->writer, g, &err) != RC_OK)
        tool_die_at(t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    g->type = type;
}

/* ---- input ---- */

static void
open_next(struct tool *t)
{
    const char *name = t->operands == 0 ? "-" : t->operand[t->next_operand];
    struct rc_err err;

    t->next_operand++;
    t->frame = 0;
    if (strcmp(name, "-") == 0) {
        t->in = stdin;
        t->source = "standard input";
    } else {
        t->source = name;
        if ((t->in = fopen(name, "rb")) == NULL)
            tool_die(t, EXIT_IMPOSSIBLE, "%s: %s", name, strerror(errno));
    }
    if (isatty(fileno(t->in)))
        tool_die(t, EXIT_USAGE, "%s is a terminal: pipe a grid stream in or name a file",
                 t->source);
    setvbuf(t->in, NULL, _IOFBF, BUFFER);
    t->reader = rc_reader_new(t->in, t->last_case, t->memory, &err);
    if (t->reader == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "%s", err.text);
}

static void
close_input(struct tool *t)
{
    t->last_case = rc_reader_last_case(t->reader);
    rc_reader_free(t->reader);
    t->reader = NULL;
    if (t->in != stdin)
        fclose(t->in);
}

static void
mind_convergence(struct tool *t, const struct rc_grid *g)
{
    const char *converged = rc_grid_get(g, "converged");
    char where[256];

    if (converged == NULL || strcmp(converged, "no") != 0)
        return;
    if (!t->warned_short)
        tool_warn(t,
                  "%s: this solution stopped short of its accuracy (converged=no): what follows "
                  "from it does too",
                  tool_where(t, g, where, sizeof where));
    t->warned_short = true;
    tool_fails_with(t, EXIT_SHORT);
}

struct rc_grid *
tool_read(struct tool *t)
{
    struct rc_grid *g;
    struct rc_err err;
    size_t inputs = t->operands == 0 ? 1 : t->operands;

    for (;;) {
        if (t->reader == NULL) {
            if (t->next_operand == inputs)
                return NULL;
            open_next(t);
        }
        switch (rc_reader_next(t->reader, &g, &err)) {
        case RC_MORE:
            t->frame++;
            mind_convergence(t, g);
            return g;
        case RC_OK:
            close_input(t);
            break;
        default:
            tool_die(t, EXIT_IMPOSSIBLE, "%s, frame %zu: %s", t->source, t->frame + 1, err.text);
        }
    }
}

static void
end_case(struct tool *t, const char *channel)
{
    if (t->now.number != 0 && t->now.found == 0)
        tool_die(t, EXIT_IMPOSSIBLE, "%s, case %zu: no frame with the channel %s, only %s",
                 t->now.source, t->now.number, channel, t->now.names);
}

static void
begin_case(struct tool *t, size_t number)
{
    t->now.number = number;
    t->now.source = t->source;
    t->now.found = 0;
    t->now.names[0] = '\0';
}

struct rc_grid *
tool_channel(struct tool *t, const char *channel, bool pass)
{
    struct rc_grid *g;

    while ((g = tool_read(t)) != NULL) {
        size_t number = rc_grid_case(g), used;

        if (number != t->now.number) {
            end_case(t, channel);
            begin_case(t, number);
        }
        used = strlen(t->now.names);
        snprintf(t->now.names + used, sizeof t->now.names - used, "%s%s", used == 0 ? "" : " ",
                 g->channel);
        if (strcmp(g->channel, channel) == 0) {
            if (t->now.found++ > 0)
                tool_die_at(t, g, EXIT_IMPOSSIBLE,
                            "a second %s frame in one case: maps that do not belong together need "
                            "case numbers of their own",
                            channel);
            return g;
        }
        if (pass)
            tool_write(t, g);
        rc_grid_free(g);
    }
    end_case(t, channel);
    if (t->now.number == 0)
        tool_die(t, EXIT_IMPOSSIBLE, "%s: the stream holds no frame", t->source);
    return NULL;
}

void
tool_demand_finite(struct tool *t, const struct rc_grid *g, const char *remedy)
{
    size_t count = 0, first = 0;

    for (size_t k = g->nx * g->ny; k-- > 0;)
        if (!isfinite(g->v[k])) {
            count++;
            first = k;
        }
    if (count > 0)
        tool_die_at(t, g, EXIT_IMPOSSIBLE,
                    "%zu of %zu values are NaN or infinite, the first in column %zu of row %zu: %s",
                    count, g->nx * g->ny, first % g->nx, first / g->nx, remedy);
}

void
tool_demand_writable(struct tool *t, const char *option, const char *name)
{
    char folder[PATH_SIZE];
    const char *slash, *where = name;

    if (name == NULL)
        return;
    if (access(name, F_OK) != 0) { /* to be made: its folder has to let us */
        slash = strrchr(name, '/');
        snprintf(folder, sizeof folder, "%.*s", slash == NULL ? 1 : (int)(slash - name) + 1,
                 slash == NULL ? "." : name);
        where = folder;
    }
    if (access(where, W_OK) != 0)
        tool_die(t, EXIT_IMPOSSIBLE, "%s %s: %s", option, name, strerror(errno));
}

void
tool_demand_memory(struct tool *t, const struct rc_grid *g, size_t bytes)
{
    if (t->memory != 0 && bytes > t->memory)
        tool_die_at(t, g, EXIT_IMPOSSIBLE,
                    "%zu x %zu nodes need about %zu MiB, --memory allows %zu", g->nx, g->ny,
                    (bytes >> 20) + 1, t->memory >> 20);
}

/* ---- start and finish ---- */

static size_t
threads_wanted(struct tool *t)
{
    const char *text = getenv("RC_THREADS");
    struct rc_err err;
    double n;

    if (text == NULL || *text == '\0')
        return rc_threads_available();
    if (unit_number(text, UNIT_NONE, &n, &err) != RC_OK || n < 1 || n > 4096 || n != floor(n))
        tool_die(t, EXIT_USAGE, "RC_THREADS=%s: it must be a whole number from 1 to 4096", text);
    return (size_t)n;
}

void
tool_start(struct tool *t, const struct tool_info *info, int argc, char **argv, void *args)
{
    *t = (struct tool){.info = info, .args = args, .writes = info->writes};
    tool_options(t, argc, argv);
    if (t->threads == 0)
        t->threads = threads_wanted(t);
    if (info->reads == READS_NOTHING && t->operands > 0)
        tool_die(t, EXIT_USAGE, "'%s': this tool reads no files; see %s --help", t->operand[0],
                 info->name);
    if (info->settle != NULL)
        info->settle(t);
    handle(end_by);
    if (tool_given(t, "dry-run")) { /* words instead of grids, and no file is touched */
        t->writes = WRITES_TEXT;
        t->out_name = NULL;
    }
    open_output(t);
}

void
tool_fails_with(struct tool *t, int status)
{
    if (t->exit_status == 0 || t->exit_status == EXIT_SHORT)
        t->exit_status = status;
}

int
tool_finish(struct tool *t)
{
    struct rc_err err;

    tool_progress_end(t);
    if (t->writer != NULL && rc_writer_end(t->writer, &err) != RC_OK)
        tool_die(t, EXIT_IMPOSSIBLE, "%s: %s",
                 t->out_name == NULL ? "standard output" : t->out_name, err.text);
    t->began = false; /* an end line is out: nothing may follow it */
    rc_writer_free(t->writer);
    t->writer = NULL;
    if (fflush(t->out) != 0 || ferror(t->out) || fclose(t->out) != 0)
        tool_die(t, EXIT_IMPOSSIBLE, "%s: writing failed (%s)",
                 t->out_name == NULL ? "standard output" : t->out_name, strerror(errno));
    if (half_written[0] != '\0' && rename(half_written, destination) != 0)
        tool_die(t, EXIT_IMPOSSIBLE, "-o %s: %s", t->out_name, strerror(errno));
    half_written[0] = '\0';
    if (interrupted != 0)
        end_by(interrupted);
    return t->exit_status;
}
