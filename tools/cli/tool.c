/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Start and end of a tool, and checks before the work.
 */
#include "tool.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "libcontact/contact.h"
#include "tools/machine/machine.h"
#include "ending.h"
#include "parts.h"
#include "ranks.h"

/* ---- start and finish ---- */

/* Cores of this process, shared with the other processes of this tool: ten that start together do not
 * each take all of them. Processes that share a map have their cores from mpirun. */
static size_t
shared_cores(struct tool *t)
{
    const size_t cores = rc_threads_available();
    const size_t n = t->ranks == NULL ? machine_siblings("").n : 1;

    t->part = n > 1;
    return cores > n ? cores / n : 1;
}

static size_t
threads_wanted(struct tool *t)
{
    const char *text = getenv("RC_THREADS");
    struct rc_err err;
    double n;

    if (text == NULL || *text == '\0')
        return shared_cores(t);
    if (unit_number(text, UNIT_NONE, &n, &err) != RC_OK || n < 1 || n > 4096 || n != floor(n))
        tool_usage(t, "RC_THREADS=%s: it must be a whole number from 1 to 4096", text);
    return (size_t)n;
}

/* True if standard output is used by --report. */
static bool
reports_to_output(const struct tool *t)
{
    for (size_t k = 0; k < t->option.n; k++)
        if (t->option.row[k].type == OPT_REPORT && t->option.given[k] &&
            strcmp(*(const char *const *)tool_value(t, &t->option.row[k]), "-") == 0)
            return true;
    return false;
}

/* The next file that the tool opens would take the place of a standard file that is closed, and a checkpoint
 * could become the output. Such a standard file fails instead when it is read or written. */
static void
hold_standard_files(void)
{
    for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; fd++)
        if (fcntl(fd, F_GETFD) < 0 && errno == EBADF)
            (void)open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

void
tool_start(struct tool *t, const struct tool_info *info, int argc, char **argv, void *args)
{
    *t = (struct tool){.info = info, .args = args, .writes = info->writes};
    waiting_restore();
    hold_standard_files();
    memory_keep_maps_apart();
    ranks_start(t);
    options_read(t, argc, argv);
    ranks_refuse(t);
    if (info->fill != NULL)
        info->fill(t);
    rules_check(t);
    if (t->threads == 0)
        t->threads = threads_wanted(t);
    tool_budget(t);
    (void)tool_counted_memory(t); /* the memory before any map is allocated: code */
    if (info->reads == READS_NOTHING && t->operands > 0)
        tool_usage(t, "'%s': this tool reads no files; see %s --help", t->operand[0], info->name);
    if (info->settle != NULL)
        info->settle(t);
    output_handle_signals();
    if (tool_given(t, "dry-run")) { /* text instead of grids, and no file is made */
        t->writes = WRITES_TEXT;
        t->out_name = NULL;
    } else if (t->out_name == NULL && reports_to_output(t)) {
        t->writes = WRITES_TEXT;
        t->output.report_alone = true;
    }
    if (t->writes == WRITES_STREAM)
        ending_refuse_picture(t, t->out_name);
    output_open(t);
}

void
tool_fails_with(struct tool *t, int status)
{
    if (t->exit_status == 0 || t->exit_status == EXIT_SHORT)
        t->exit_status = status;
}

static double
mebibytes(double bytes)
{
    return bytes / (1 << 20);
}

int
tool_finish(struct tool *t)
{
    double counted, taken;
    size_t peak;

    tool_progress_end(t);
    tool_count_warnings(t);
    output_end(t);
    peak = memory_peak(); /* the output may be made only at the end */
    counted = ranks_most(t, (double)tool_counted_memory(t));
    taken = ranks_most(t, (double)(peak > t->room.children ? peak : t->room.children));
    if (t->debug)
        tool_note(t, "memory: %.1f MiB counted, %.1f MiB taken", mebibytes(counted),
                  mebibytes(taken));
    ranks_end(t);
    output_end_by_signal();
    return t->exit_status;
}

/* ---- demands ---- */

void
tool_demand_writable(struct tool *t, const char *option, const char *name)
{
    char place[WHOLE_PATH], *slash;
    const char *where = name;
    struct stat st;

    if (name == NULL)
        return;
    if (stat(name, &st) == 0 && S_ISDIR(st.st_mode))
        tool_die(t, "%s %s: this is a folder", option, name);
    if (access(name, F_OK) != 0) { /* it does not exist yet: its folder must be writable */
        if (!whole_file_place(name, place))
            tool_die(t, "%s %s: %s", option, name, strerror(errno));
        if ((slash = strrchr(place, '/')) != NULL)
            slash[1] = '\0';
        where = slash == NULL ? "." : place;
    }
    if (access(where, W_OK) != 0)
        tool_die(t, "%s %s: %s", option, name, strerror(errno));
}

/* ---- time and memory of the run ---- */

double
tool_now(void)
{
    struct timespec ts;

    clock_gettime(CLOCK_MONOTONIC, &ts);
    return (double)ts.tv_sec + 1e-9 * (double)ts.tv_nsec;
}

double
tool_worked(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

/* The other process has ended: later work of this process, such as a picture of results, does not add to its
 * memory. */
void
tool_memory_beside(struct tool *t, size_t bytes, size_t counted)
{
    const size_t both = memory_peak() + bytes, count = tool_own_memory(t) + counted;

    t->room.children = both > t->room.children ? both : t->room.children;
    t->room.counted = count > t->room.counted ? count : t->room.counted;
}
