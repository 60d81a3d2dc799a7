/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures the cost of a trial, and the error of its pressures or stresses against the reference. */
#include "cost.h"

#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A command line: words, and the texts to which they point. */
struct line {
    const char *word[COST_WORDS];
    size_t n;
    char threads[32], memory[32];
};

static void
put(struct line *l, const char *a, const char *b)
{
    if (a != NULL && l->n + 3 < COST_WORDS) {
        l->word[l->n++] = a;
        if (b != NULL)
            l->word[l->n++] = b;
    }
}

static void
begin(const struct cost_case *c, struct line *l, const char *tool)
{
    *l = (struct line){.n = 0};
    put(l, tool, NULL);
    snprintf(l->threads, sizeof l->threads, "%zu", c->tool->threads);
    snprintf(l->memory, sizeof l->memory, "%zu", c->tool->memory);
    put(l, "--threads", l->threads);
    if (c->tool->memory != 0)
        put(l, "--memory", l->memory);
}

static int
grid_of(struct cost_case *c, const struct cost_trial *m)
{
    int k = m->coarse == 8 ? 3 : m->coarse == 4 ? 2 : m->coarse == 2 ? 1 : 0, status;
    char size[64];
    struct line l;

    if (c->files.grid[k] >= 0)
        return c->files.grid[k];
    c->files.grid[k] = cost_file(c->tool);
    snprintf(size, sizeof size, "%zux%zu", m->shape.nx, m->shape.ny);
    begin(c, &l, "rc-pick");
    put(&l, "--quiet", "--resample");
    put(&l, size, NULL);
    if (cost_run(c, l.word, c->files.grid[0], c->files.grid[k], INFINITY, "coarser grids",
                 &status) == PROCESS_FAILED)
        tool_refuse(c->tool, c->heights, "%s", cost_message(c->said));
    return c->files.grid[k];
}

static void
solve_line(struct cost_case *c, const struct cost_trial *m, struct line *l)
{
    begin(c, l, "rc-solve");
    for (size_t k = 0; k < c->line.words && l->n + 24 < COST_WORDS; k++)
        put(l, c->line.word[k], NULL);
    l->n = cost_trial_words(m, l->word, l->n);
}

/* ---- before the run ---- */

static void
leave_out(struct cost_trial *m, const char *why)
{
    m->state = COST_LEFT_OUT;
    snprintf(m->why, sizeof m->why, "left out: %.240s", why);
}

/* Warnings of rc-solve for the reference apply to all trials. */
static void
repeat_warnings(struct cost_case *c)
{
    for (char *line = c->said, *next; line != NULL; line = next) {
        if ((next = strchr(line, '\n')) != NULL)
            *next++ = '\0';
        if (strncmp(line, "rc-solve: ", 10) == 0)
            tool_warn(c->tool, "%s", line + 10);
    }
}

void
cost_plan(struct cost_case *c, struct cost_trial *m)
{
    enum {
        SMALLEST = 8 /* nodes along a side; smaller coarse grids are not tried */
    };
    const size_t least = m->shape.nx < m->shape.ny ? m->shape.nx : m->shape.ny;
    struct line l;
    int status;
    enum process_end end;

    if (m->coarse > 1 && (least == 1 ? m->shape.nx * m->shape.ny : least) < SMALLEST) {
        leave_out(m, "the grid is too small to be coarsened so far");
        return;
    }
    solve_line(c, m, &l);
    put(&l, "--dry-run", m->reference ? NULL : "--quiet");
    put(&l, "--report", "-");
    end = cost_run(c, l.word, grid_of(c, m), -1, INFINITY, "a plan", &status);
    if (end == PROCESS_FAILED && m->reference && status == EXIT_USAGE)
        tool_usage(c->tool, "%s", cost_message(c->said));
    if (end == PROCESS_FAILED && m->reference)
        tool_refuse(c->tool, c->heights, "%s", cost_message(c->said));
    if (end == PROCESS_FAILED)
        leave_out(m, cost_message(c->said));
    if (end != PROCESS_ENDED || c->said == NULL)
        return;
    m->mebibytes = cost_number(c->said, "expected_memory") / 1048576;
    m->planned = cost_number(c->said, "expected_seconds");
    if (c->tool->memory != 0 && m->mebibytes * 1048576 > (double)c->tool->memory)
        leave_out(m, "it needs more than --memory");
    if (m->reference)
        repeat_warnings(c);
}

/* ---- pressures ---- */

/* The last pressure of the output, on the map's own grid, which the caller frees; NULL: none. */
static double *
pressure_of(struct cost_case *c, const struct cost_trial *m)
{
    FILE *file = cost_file_read(c->tool, c->files.output);
    struct rc_err err;
    struct rc_reader *reader = rc_reader_new(file, 0, 0, &err);
    struct rc_grid *g;
    double *p = NULL;

    while (reader != NULL && rc_reader_next(reader, &g, &err) == RC_MORE) {
        if (strcmp(g->channel, "pressure") == 0 && g->nx == m->shape.nx && g->ny == m->shape.ny) {
            free(p);
            p = g->v;
            g->v = NULL;
        }
        rc_grid_free(g);
    }
    rc_reader_free(reader);
    fclose(file);
    if (p != NULL && m->coarse > 1) {
        double *fine = malloc(c->shape.nx * c->shape.ny * sizeof *fine);
        if (fine != NULL)
            rc_resample_means(&m->shape, p, &c->shape, fine);
        free(p);
        p = fine;
    }
    return p;
}

static double
distance(size_t n, const double *p, const double *truth)
{
    double sum = 0, all = 0;

    for (size_t k = 0; k < n; k++) {
        sum += fabs(p[k] - truth[k]);
        all += fabs(truth[k]); /* with adhesion: net pressures */
    }
    return sum / all;
}

/* Takes the figures from a report. */
static void
take(const struct cost_case *c, struct cost_trial *m, const char *report, bool leak)
{
    for (const struct cost_column *col = cost_columns; col->figure.name != NULL; col++) {
        double value;

        if (col->from == NULL || !(col->of & m->about) || (col->of == COST_LEAK) != leak)
            continue;
        value = cost_number(report, col->from);
        if (col->relative && !m->reference)
            value = value / (leak ? c->reference.is.flow_conductance
                                  : cost_number(c->solved, col->from)) -
                    1;
        *cost_value(col, &m->is) = col->relative && m->reference ? 0
                                   : isnan(value)                ? NAN
                                                                 : value; /* no sign */
    }
}

/* Seconds from heights to pressure, of all loads of a history. */
static double
seconds_of(char *said)
{
    double sum = 0;

    for (char *line = said, *end; line != NULL; line = end) {
        if ((end = strchr(line, '\n')) != NULL)
            *end = '\0';
        if (*line == '{')
            sum += cost_number(line, "total") - cost_number(line, "result");
        if (end != NULL)
            *end++ = '\n';
    }
    return sum;
}

static void
stop(struct cost_trial *m, enum process_end end, double allowed, const char *message)
{
    if (m->state == COST_DONE)
        return; /* a repetition: the trial has its result */
    m->state = COST_STOPPED;
    if (end == PROCESS_LATE)
        snprintf(m->why, sizeof m->why, "stopped after %.2g s, all that was left of --limit",
                 allowed);
    else if (end == PROCESS_INTERRUPTED)
        snprintf(m->why, sizeof m->why, "interrupted");
    else if (end == PROCESS_DIED || *message == '\0')
        snprintf(m->why, sizeof m->why, "its process died: memory may be short");
    else
        snprintf(m->why, sizeof m->why, "it failed: %.240s", message);
}

/* Computes the leakage through the gap of the last solution. */
static enum process_end
leak(struct cost_case *c, struct cost_trial *m, double allowed, const char *name)
{
    int status;
    enum process_end end;
    struct line l;

    begin(c, &l, "rc-leak");
    put(&l, "--direction", c->line.leak);
    put(&l, "--quiet", NULL);
    put(&l, "--report", "/dev/fd/2");
    end = cost_run(c, l.word, c->files.output, c->files.nowhere, allowed, name, &status);
    if (end == PROCESS_ENDED)
        take(c, m, c->said, true);
    return end;
}

/* Keeps the report; false if the tool wrote none. */
static bool
keep(struct cost_case *c, struct cost_trial *m)
{
    const double before = m->is.seconds;
    double seconds = (m->about & COST_STRESS)
                         ? cost_number(c->said, "setup") + cost_number(c->said, "slices")
                         : seconds_of(c->said);

    if (isnan(seconds))
        return false;
    take(c, m, c->said, false);
    m->is.seconds = seconds < before || isnan(before) ? seconds : before;
    if (m->is.convolutions > 0) /* on the map's own grid */
        m->is.convolutions *=
            (double)(m->shape.nx * m->shape.ny) / (double)(c->shape.nx * c->shape.ny);
    m->is.runs++;
    if (m->is.memory > 0)
        tool_memory_beside(c->tool, (size_t)m->is.memory,
                           (size_t)cost_number(c->said, "memory_estimate"));
    return true;
}

static bool
run_pressure(struct cost_case *c, struct cost_trial *m, double allowed)
{
    char name[128];
    double start = tool_now(), *p = NULL;
    enum process_end end;
    struct line l;
    int status, in = grid_of(c, m);

    cost_name(name, m);
    solve_line(c, m, &l);
    put(&l, "--quiet", NULL);
    put(&l, "--output", c->line.leak != NULL ? "pressure,gap" : "pressure");
    put(&l, "--report", "/dev/fd/2");
    end = cost_run(c, l.word, in, c->files.output, allowed, name, &status);
    if (end == PROCESS_ENDED && !keep(c, m))
        end = PROCESS_DIED;
    if (end == PROCESS_ENDED) {
        c->around = tool_now() - start - m->is.seconds;
        m->converged = status == 0;
        if ((p = pressure_of(c, m)) == NULL)
            end = PROCESS_DIED;
    }
    if (m->reference && p != NULL) {
        if (m->is.runs == 1) {
            c->pressure = p;
            c->solved = c->said;
            c->said = NULL;
            m->is.error = 0;
        }
    } else if (p != NULL) {
        if (c->pressure != NULL)
            m->is.error = distance(c->shape.nx * c->shape.ny, p, c->pressure);
        free(p);
    }
    if (end == PROCESS_ENDED && c->line.leak != NULL)
        end = leak(c, m, allowed - (tool_now() - start), name);
    if (end == PROCESS_ENDED)
        m->state = COST_DONE;
    else
        stop(m, end, allowed, cost_message(c->said));
    return end != PROCESS_INTERRUPTED;
}

/* ---- the reference ---- */

/* Finds the default number of slabs of rc-solve by a run with few increments. */
static void
find_slabs(struct cost_case *c)
{
    struct cost_trial first = c->trial[0];

    first.stack = 1;
    if (!run_pressure(c, &first, c->limit))
        return;
    if (first.state != COST_DONE) {
        c->reference.state = first.state;
        snprintf(c->reference.why, sizeof c->reference.why, "%s", first.why);
        return;
    }
    if (isnan(first.is.slabs))
        tool_refuse(c->tool, c->heights,
                    "nothing yields: the largest Mises stress is %.3g of the yield stress: leave "
                    "out --yield",
                    cost_number(c->said, "max_mises_over_yield"));
    c->base_slabs = first.is.slabs;
    for (size_t k = 0; k < c->pressures; k++)
        c->trial[k].is.slabs = ceil(c->base_slabs * c->trial[k].stack);
    c->reference.is.slabs = ceil(c->base_slabs * c->reference.stack);
}

/* Memory of the largest process, and of the maps of this one. These are the reference, the pressure of the
 * trial, and the same on the map's grid. */
static size_t
memory_for(const struct cost_case *c)
{
    double most = c->reference.mebibytes,
           map = (double)(c->shape.nx * c->shape.ny) * sizeof(double);

    for (size_t k = 0; k < c->pressures; k++)
        if (c->trial[k].state == COST_OPEN)
            most = fmax(most, c->trial[k].mebibytes);
    return (size_t)(fmax(most, 0) * 1048576 + 3 * map);
}

void
cost_solve_reference(struct cost_case *c)
{
    struct cost_trial *r = &c->reference;
    int scratch = c->files.output;

    tool_demand_memory(c->tool, c->heights, memory_for(c));
    if (r->about & COST_YIELD)
        find_slabs(c);
    c->files.output = c->files.solution;
    if (r->state != COST_STOPPED && tool_interrupted() == 0)
        run_pressure(c, r, c->limit);
    c->files.output = scratch;
    if (tool_interrupted() != 0)
        tool_refuse(c->tool, c->heights, "interrupted before anything was measured");
    if (r->state != COST_DONE)
        tool_refuse(c->tool, c->heights, "no reference: %s", r->why);
    if (strstr(c->solved, "\"separated\": \"yes\"") != NULL)
        tool_refuse(c->tool, c->heights, "no reference: under this load the bodies part");
}

/* ---- stresses ---- */

static void
stress_line(struct cost_case *c, const struct cost_trial *m, struct line *l,
            char tol[RC_NUMBER_SIZE])
{
    begin(c, l, "rc-stress");
    put(l, "--depths", c->line.depths);
    put(l, c->line.nu != NULL ? "--nu" : NULL, c->line.nu);
    put(l, c->line.mu != NULL ? "--mu" : NULL, c->line.mu);
    put(l, "--kernel", m->kernel);
    put(l, m->tol > 0 ? "--tol" : NULL, rc_number_text(tol, m->tol));
    put(l, "--quiet", NULL);
}

/* Sums over all frames: the largest error, the sum of squares and the number of values. Also the largest
 * Mises stress, and the exact one. */
struct errors {
    double worst, squares, n, mises, exact;
};

static void
compare(const struct rc_grid *g, const struct rc_grid *exact, struct errors *e)
{
    bool mises = strcmp(g->channel, "mises") == 0;

    for (size_t k = 0; k < rc_grid_nodes(g); k++) {
        double off = fabs(g->v[k] - exact->v[k]);

        e->worst = fmax(e->worst, off);
        e->squares += off * off;
        e->mises = mises ? fmax(e->mises, g->v[k]) : e->mises;
        e->exact = mises ? fmax(e->exact, exact->v[k]) : e->exact;
    }
    e->n += (double)rc_grid_nodes(g);
}

/* Compares both frame by frame, so that at most two frames are in memory. False: a process did not end. */
static bool
compare_stresses(struct cost_case *c, const struct cost_trial *m, double until, struct errors *e)
{
    const struct cost_trial exact = {.kernel = rc_engine_info(0)->name};
    char tol[2][RC_NUMBER_SIZE];
    struct rc_reader *reader[2];
    struct rc_grid *g[2] = {NULL, NULL};
    enum rc_status status = RC_MORE;
    struct rc_err err;
    struct line l[2];
    FILE *from[2];
    char name[32];
    int child[2], in;

    snprintf(name, sizeof name, "/dev/fd/%d",
             c->files.solution); /* a new descriptor has its own position */

    for (int k = 0; k < 2; k++) {
        stress_line(c, k == 0 ? m : &exact, &l[k], tol[k]);
        in = open(name, O_RDONLY | O_CLOEXEC);
        child[k] = process_start(c->tool, l[k].word, in, &from[k]);
        close(in);
        if ((reader[k] = rc_reader_new(from[k], 0, 0, &err)) == NULL)
            status = RC_FAIL;
    }
    while (status == RC_MORE && tool_interrupted() == 0 && tool_now() < until) {
        status = rc_reader_next(reader[0], &g[0], &err);
        if (rc_reader_next(reader[1], &g[1], &err) != status)
            status = RC_FAIL;
        if (status == RC_MORE)
            compare(g[0], g[1], e);
        rc_grid_free(g[0]);
        rc_grid_free(g[1]);
        g[0] = g[1] = NULL;
        tool_progress(c->tool, NAN, "stresses by %s: errors", m->kernel);
    }
    for (int k = 0; k < 2; k++) {
        rc_reader_free(reader[k]);
        fclose(from[k]);
        process_wait(child[k], status != RC_OK);
    }
    tool_progress_end(c->tool);
    return status == RC_OK;
}

static bool
run_stress(struct cost_case *c, struct cost_trial *m, double allowed)
{
    double until = tool_now() + allowed, peak = cost_number(c->solved, "max_pressure");
    int status;
    struct errors e = {0};
    char name[128], tol[RC_NUMBER_SIZE];
    enum process_end end;
    struct line l;

    do {
        stress_line(c, m, &l, tol);
        put(&l, "--report", "/dev/fd/2");
        end = cost_run(c, l.word, c->files.solution, c->files.nowhere, until - tool_now(),
                       cost_name(name, m), &status);
        if (end == PROCESS_ENDED && !keep(c, m))
            end = PROCESS_DIED;
    } while (end == PROCESS_ENDED && cost_again(m->is.runs, m->is.seconds));
    if (m->reference && end == PROCESS_ENDED) {
        c->stressed = c->said;
        c->said = NULL;
    } else if (m->is.runs > 0) {
        if (!compare_stresses(c, m, until, &e))
            end = tool_interrupted() != 0 ? PROCESS_INTERRUPTED : PROCESS_LATE;
        m->is.error = e.worst / peak;
        m->is.rms_error = sqrt(e.squares / e.n) / peak;
        m->is.mises_error = e.mises / e.exact - 1;
    }
    if (end == PROCESS_ENDED) {
        m->state = COST_DONE;
    } else {
        m->is.runs = 0;
        stop(m, end, allowed, cost_message(c->said));
    }
    return end != PROCESS_INTERRUPTED;
}

bool
cost_trial_run(struct cost_case *c, struct cost_trial *m, double allowed)
{
    return (m->about & COST_STRESS) ? run_stress(c, m, allowed) : run_pressure(c, m, allowed);
}
