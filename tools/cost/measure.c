/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs the programs of a trial, and compares their frames and figures with those of the reference. */
#include "cost.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

/* ---- runs ---- */

static void
put(const char *word[], size_t *n, const char *a, const char *b)
{
    word[(*n)++] = a;
    if (b != NULL)
        word[(*n)++] = b;
}

/* The run of these words on this input, which is added if there is none. */
static size_t
run_of(struct cost_case *c, size_t level, size_t from, const char *const word[], size_t n)
{
    struct cost_run *r;
    size_t k, i;

    for (k = 0; k < c->runs; k++) {
        r = &c->run[k];
        for (i = 0; i < n && r->word[i] != NULL && strcmp(word[i], r->word[i]) == 0; i++)
            continue;
        if (r->level == level && r->from == from && i == n && r->word[i] == NULL)
            return k;
    }
    c->run = tool_grown(c->tool, c->run, c->runs, &c->run_room, sizeof *r, "a list of runs");
    r = &c->run[c->runs];
    *r = (struct cost_run){.level = level,
                           .from = from,
                           .output = -1,
                           .seconds = NAN,
                           .processor = NAN,
                           .memory = NAN,
                           .convolutions = NAN,
                           .planned = NAN,
                           .mebibytes = NAN};
    r->word = tool_room(c->tool, n + 8, sizeof *word, "a command");
    for (i = 0; i < n; i++)
        r->word[i] = tool_copy(c->tool, word[i]);
    return c->runs++;
}

size_t
cost_input_add(struct cost_case *c, size_t trial, int file)
{
    char name[32];
    const char *word[] = {name};
    size_t k;

    snprintf(name, sizeof name, "input %zu", trial);
    k = run_of(c, 0, SIZE_MAX, word, 1);
    c->run[k].output = file;
    c->run[k].state = COST_DONE;
    return k;
}

static int
input_of(const struct cost_case *c, const struct cost_run *r)
{
    return r->from == SIZE_MAX ? c->input : c->run[r->from].output;
}

/* Words of program k in the trial; `text` holds those of its options. */
static size_t
words_of(const struct cost_case *c, const struct cost_trial *t, size_t k, const char *word[],
         char text[COST_LISTS][320])
{
    const struct cost_program *p = &c->command.program[k];
    size_t n = p->words;

    memcpy(word, p->word, n * sizeof *word);
    for (size_t l = 0; l < c->lists; l++) {
        const struct cost_list *list = &c->list[l];

        if (!list->grid && (list->program == k || list->program == SIZE_MAX) &&
            cost_option(p, list->option) != NULL)
            n = cost_option_put(c->tool, p, word, n, list->option, list->value[t->pick[l]],
                                text[l]);
    }
    memmove(word + 1, word, n * sizeof *word);
    word[0] = p->name;
    return n + 1;
}

/* Takes time, memory and work from the report of a program. */
static void
take(struct cost_case *c, struct cost_run *r, double processor)
{
    const char *at = c->said, *line;
    double seconds = NAN, memory = NAN, convolutions = NAN;

    r->lines = 0;
    while ((line = cost_line(&at)) != NULL) {
        const char *total = json_member(line, "seconds.total");
        const double own = json_real(total), work = json_real(json_member(line, "convolutions")),
                     most = json_real(json_member(line, "peak_memory"));

        r->lines++;
        seconds = isnan(own) ? seconds : isnan(seconds) ? own : seconds + own;
        convolutions = isnan(work)           ? convolutions
                       : isnan(convolutions) ? work
                                             : convolutions + work;
        memory = fmax(memory, most);
        if (most > 0)
            tool_memory_beside(c->tool, (size_t)most,
                               (size_t)fmax(json_real(json_member(line, "memory_estimate")), 0));
    }
    seconds = isnan(seconds) ? processor : seconds; /* it has no report */
    r->seconds = fmin(seconds, r->seconds);         /* fmin returns the number, not NAN */
    r->processor = fmin(processor, r->processor);
    r->memory = fmax(memory, r->memory);
    r->convolutions = convolutions;
    r->runs++;
    if (r->report == NULL) {
        r->report = c->said == NULL ? tool_copy(c->tool, "") : c->said;
        c->said = NULL;
    }
}

static double
processor_of_children(void)
{
    struct rusage use;

    getrusage(RUSAGE_CHILDREN, &use);
    return (double)use.ru_utime.tv_sec + (double)use.ru_stime.tv_sec +
           1e-6 * ((double)use.ru_utime.tv_usec + (double)use.ru_stime.tv_usec);
}

static void
fail(char why[256], enum process_end end, double allowed, const char *message)
{
    if (end == PROCESS_LATE)
        snprintf(why, 256, "stopped after %.2g s, all that was left of --limit", allowed);
    else if (end == PROCESS_INTERRUPTED)
        snprintf(why, 256, "interrupted");
    else if (end == PROCESS_DIED || *message == '\0')
        snprintf(why, 256, "its process died: memory may be short");
    else
        snprintf(why, 256, "it failed: %.240s", message);
}

/* Warnings for the reference apply to all trials. */
static void
repeat_warnings(struct cost_case *c, const char *name)
{
    const size_t n = strlen(name);

    for (const char *line = c->said; line != NULL && *line != '\0';) {
        const size_t length = strcspn(line, "\n");

        if (strncmp(line, name, n) == 0 && line[n] == ':')
            tool_warn(c->tool, "%.*s", (int)length, line);
        line += length + (line[length] == '\n');
    }
}

static enum process_end
execute(struct cost_case *c, size_t at, bool reference, double allowed, const char *doing)
{
    struct cost_run *r = &c->run[at];
    const struct cost_program *p = r->level == 0 ? NULL : &c->command.program[r->level - 1];
    const bool again = r->runs > 0, last = r->level == c->command.programs;
    const double start = tool_now(), processor = processor_of_children();
    enum process_end end;
    size_t n = 0;
    int status, out = c->nowhere;

    while (r->word[n] != NULL)
        n++;
    if (p != NULL && p->reports)
        put(r->word, &n, "--report", "/dev/fd/2");
    if (!reference || again || p == NULL)
        put(r->word, &n, "--quiet", NULL);
    if (!again && (p == NULL || p->streams || !last))
        out = r->output = cost_file(c->tool);
    end = cost_process(c, r->word, input_of(c, r), out, allowed, doing, &status);
    while (n > 0 &&
           (strcmp(r->word[n - 1], "--quiet") == 0 || strcmp(r->word[n - 1], "/dev/fd/2") == 0 ||
            strcmp(r->word[n - 1], "--report") == 0))
        r->word[--n] = NULL;
    if (end == PROCESS_ENDED) {
        if (reference && !again && p != NULL)
            repeat_warnings(c, p->name);
        take(c, r, processor_of_children() - processor);
        c->around = tool_now() - start - r->seconds;
        if (again)
            return end;
        r->converged = status == 0;
        r->state = COST_DONE;
    } else if (!again) {
        r->state = COST_STOPPED;
        c->usage = c->usage || (end == PROCESS_FAILED && status == EXIT_USAGE);
        fail(r->why, end, allowed, cost_message(c->said));
    }
    return end;
}

/* ---- before the run ---- */

static void
leave_out(struct cost_trial *t, const char *why)
{
    t->state = COST_LEFT_OUT;
    snprintf(t->why, sizeof t->why, "left out: %.240s", why);
}

static bool
plan_grid(struct cost_case *c, struct cost_trial *t)
{
    enum {
        SMALLEST = 8 /* nodes along a side; smaller coarse grids are not tried */
    };
    const struct rc_shape shape = cost_shape(c, t);
    const size_t least = shape.nx < shape.ny ? shape.nx : shape.ny;
    char size[64];
    const char *word[] = {"rc-pick", "--resample", size};

    if (t->coarse == 1)
        return true;
    if ((least == 1 ? shape.nx * shape.ny : least) < SMALLEST) {
        leave_out(t, "the grid is too small to be coarsened so far");
        return false;
    }
    snprintf(size, sizeof size, "%zux%zu", shape.nx, shape.ny);
    t->grid = run_of(c, 0, SIZE_MAX, word, 3);
    if (c->run[t->grid].state == COST_OPEN)
        execute(c, t->grid, false, INFINITY, "coarser grids");
    if (c->run[t->grid].state != COST_DONE)
        leave_out(t, c->run[t->grid].why);
    return c->run[t->grid].state == COST_DONE;
}

/* Asks the first program of the trial what it will cost. */
static void
plan_first(struct cost_case *c, struct cost_trial *t)
{
    struct cost_run *r = &c->run[t->run[0]];
    const char *word[COST_WORDS], *at;
    enum process_end end;
    size_t n = 0;
    int status;

    if (!c->command.program[0].plans || !isnan(r->planned) || r->state == COST_DONE)
        return;
    for (; r->word[n] != NULL; n++)
        word[n] = r->word[n];
    put(word, &n, "--dry-run", "--quiet");
    put(word, &n, "--report", "-");
    word[n] = NULL;
    end = cost_process(c, word, input_of(c, r), -1, INFINITY, "a plan", &status);
    c->usage = c->usage || (end == PROCESS_FAILED && status == EXIT_USAGE);
    if (end == PROCESS_FAILED)
        leave_out(t, cost_message(c->said));
    at = c->said;
    at = end == PROCESS_ENDED ? cost_line(&at) : NULL;
    r->planned = json_real(json_member(at, "expected_seconds"));
    r->mebibytes = json_real(json_member(at, "expected_memory")) / 1048576;
    if (c->tool->memory != 0 && r->mebibytes * 1048576 > (double)c->tool->memory) {
        char text[128];

        snprintf(text, sizeof text, "it needs about %.1f MiB, --memory allows %.1f MiB",
                 r->mebibytes, (double)c->tool->memory / 1048576);
        leave_out(t, text);
    }
}

void
cost_plan(struct cost_case *c, struct cost_trial *t)
{
    const char *word[COST_WORDS + 8];
    char text[COST_LISTS][320], threads[32], memory[32];
    size_t from;

    if (t->state != COST_OPEN || t->runs > 0 || !plan_grid(c, t))
        return;
    from = t->grid;
    snprintf(threads, sizeof threads, "%zu", c->tool->threads);
    snprintf(memory, sizeof memory, "%zu", c->tool->memory);
    for (size_t k = 0; k < c->command.programs; k++) {
        size_t n = words_of(c, t, k, word, text);

        put(word, &n, "--threads", threads);
        if (c->tool->memory != 0)
            put(word, &n, "--memory", memory);
        from = t->run[t->runs++] = run_of(c, k + 1, from, word, n);
    }
    plan_first(c, t);
    t->expected = c->run[t->run[0]].planned;
}

/* ---- trials ---- */

void
cost_trial_sum(const struct cost_case *c, struct cost_trial *t)
{
    const struct rc_shape shape = cost_shape(c, t);
    const double share = (double)(shape.nx * shape.ny) / (double)(c->shape.nx * c->shape.ny);

    t->seconds = t->processor = 0;
    t->memory = t->convolutions = NAN;
    t->converged = true;
    for (size_t k = 0; k < t->runs; k++) {
        const struct cost_run *r = &c->run[t->run[k]];

        t->seconds += r->seconds;
        t->processor += r->processor;
        t->memory = fmax(t->memory, r->memory);
        if (!isnan(r->convolutions)) /* on the map's own grid */
            t->convolutions =
                (isnan(t->convolutions) ? 0 : t->convolutions) + share * r->convolutions;
        t->converged = t->converged && r->converged;
    }
}

bool
cost_trial_run(struct cost_case *c, size_t trial, double allowed)
{
    struct cost_trial *t = &c->trial[trial];
    const double until = tool_now() + allowed;
    char name[160];
    enum process_end end = PROCESS_ENDED;

    cost_name(c, t, false, name);
    for (size_t k = 0; k < t->runs; k++) {
        struct cost_run *r = &c->run[t->run[k]];

        if (r->state == COST_OPEN)
            end = execute(c, t->run[k], t->reference, until - tool_now(), name);
        if (r->state == COST_DONE)
            continue;
        t->state = r->state;
        snprintf(t->why, sizeof t->why, "%s%s%.200s", c->command.programs > 1 ? r->word[0] : "",
                 c->command.programs > 1 ? ": " : "", r->why);
        return end != PROCESS_INTERRUPTED;
    }
    cost_trial_sum(c, t);
    t->state = COST_DONE;
    if (c->cases > 0)
        cost_compare(c, t);
    return true;
}

void
cost_run_again(struct cost_case *c, const struct cost_trial *t, size_t run, double allowed)
{
    char name[160];

    execute(c, run, false, allowed, cost_name(c, t, false, name));
}

/* ---- frames ---- */

static size_t
channel_of(const struct cost_case *c, const char *name)
{
    size_t k = 0;

    while (k < c->channels && strcmp(c->channel[k].name, name) != 0)
        k++;
    return k;
}

/* Calls `each` for all frames of a stream. */
static void
walk(struct cost_case *c, int file, void (*each)(struct cost_case *c, const struct rc_grid *g))
{
    FILE *from = cost_file_read(c->tool, file);
    struct rc_err err;
    struct rc_reader *reader = rc_reader_new(from, 0, 0, &err);
    struct rc_grid *g;

    while (reader != NULL && tool_interrupted() == 0 &&
           rc_reader_next(reader, &g, &err) == RC_MORE) {
        each(c, g);
        rc_grid_free(g);
    }
    rc_reader_free(reader);
    fclose(from);
}

static void
note_channel(struct cost_case *c, const struct rc_grid *g)
{
    const size_t k = channel_of(c, g->channel);
    struct cost_channel *channel = &c->channel[k];

    c->cases = rc_grid_case(g) > c->cases ? rc_grid_case(g) : c->cases;
    if (k == COST_CHANNELS)
        return;
    if (k == c->channels) {
        *channel = (struct cost_channel){.whole = true};
        snprintf(channel->name, sizeof channel->name, "%s", g->channel);
        c->channels++;
    }
    for (size_t i = 0; i < rc_grid_nodes(g); i++) {
        const double v = g->v[i];

        if (isnan(v))
            continue;
        channel->sum += fabs(v);
        channel->whole = channel->whole && v >= 0 && v <= 10 && v == floor(v);
    }
}

static void
note_passed(struct cost_case *c, const struct rc_grid *g)
{
    const size_t k = channel_of(c, g->channel);

    if (k < c->channels)
        c->channel[k].passed = true;
}

/* Adds the differences of a frame; from a coarser grid values are constant in its cells. A frame of whole
 * numbers has the number of nodes that differ. */
static void
compare(struct cost_case *c, const struct rc_grid *g, const struct rc_grid *exact, size_t k,
        double sum[], double count[])
{
    const struct rc_shape own = rc_grid_shape(g), shape = rc_grid_shape(exact);
    const size_t n = rc_grid_nodes(exact);
    double *fine = NULL;
    const double *v = g->v;

    if (own.nx != shape.nx || own.ny != shape.ny) {
        fine = tool_room(c->tool, n, sizeof *fine, "a map");
        rc_resample_means(&own, g->v, &shape, fine);
        v = fine;
    }
    for (size_t i = 0; i < n; i++) {
        if (isnan(v[i]) || isnan(exact->v[i]))
            continue;
        count[k]++;
        if (c->channel[k].whole)
            sum[k] += round(v[i]) != exact->v[i];
        else
            sum[k] += fabs(v[i] - exact->v[i]);
    }
    free(fine);
}

static bool
same_place(const struct rc_grid *a, const struct rc_grid *b)
{
    const char *one = rc_grid_get(a, "depth"), *two = rc_grid_get(b, "depth");

    return strcmp(a->channel, b->channel) == 0 && rc_grid_case(a) == rc_grid_case(b) &&
           ((one == NULL && two == NULL) || (one != NULL && two != NULL && strcmp(one, two) == 0));
}

/* Compares both streams frame by frame, so that at most two frames are in memory. A channel of which a frame
 * is missing or elsewhere has no error. Returns the number of cases of the trial. */
static size_t
compare_frames(struct cost_case *c, int own, int exact, double error[COST_CHANNELS])
{
    double sum[COST_CHANNELS] = {0}, count[COST_CHANNELS] = {0};
    const int file[2] = {own, exact};
    struct rc_grid *g[2] = {NULL, NULL};
    struct rc_reader *reader[2];
    enum rc_status status[2] = {RC_OK, RC_OK};
    FILE *from[2];
    struct rc_err err;
    size_t cases = 0, k;

    for (k = 0; k < 2; k++) {
        from[k] = cost_file_read(c->tool, file[k]);
        reader[k] = rc_reader_new(from[k], 0, 0, &err);
        status[k] = reader[k] == NULL ? RC_FAIL : rc_reader_next(reader[k], &g[k], &err);
    }
    while (status[0] == RC_MORE && tool_interrupted() == 0) {
        cases = rc_grid_case(g[0]) > cases ? rc_grid_case(g[0]) : cases;
        while (status[1] == RC_MORE && !same_place(g[0], g[1]) &&
               rc_grid_case(g[1]) <= rc_grid_case(g[0])) {
            if ((k = channel_of(c, g[1]->channel)) < c->channels)
                sum[k] = NAN;
            rc_grid_free(g[1]);
            g[1] = NULL;
            status[1] = rc_reader_next(reader[1], &g[1], &err);
        }
        k = channel_of(c, g[0]->channel);
        if (status[1] == RC_MORE && same_place(g[0], g[1])) {
            if (k < c->channels)
                compare(c, g[0], g[1], k, sum, count);
            rc_grid_free(g[1]);
            g[1] = NULL;
            status[1] = rc_reader_next(reader[1], &g[1], &err);
        } else if (k < c->channels) {
            sum[k] = NAN;
        }
        rc_grid_free(g[0]);
        g[0] = NULL;
        status[0] = rc_reader_next(reader[0], &g[0], &err);
    }
    for (k = 0; k < 2; k++) {
        rc_grid_free(g[k]);
        rc_reader_free(reader[k]);
        fclose(from[k]);
    }
    for (k = 0; k < c->channels; k++) {
        const double all = c->channel[k].whole ? count[k] : c->channel[k].sum;

        error[k] = count[k] == 0 ? NAN : sum[k] == 0 ? 0 : sum[k] / all;
    }
    return cases;
}

/* ---- figures ---- */

/* The figures of a program: numbers that are results, and estimates of errors. Places and depths of extremes
 * jump between nodes. */
static void
find_figures(struct cost_case *c, size_t program)
{
    const char *f = json_first(json_member(c->command.program[program].json, "figures"));

    for (; f != NULL; f = json_next(f)) {
        struct cost_figure own = {.program = program};
        const bool estimates = json_is(json_member(f, "role"), "error");
        size_t n;

        if (!json_is(json_member(f, "kind"), "number") ||
            !(estimates || json_is(json_member(f, "role"), "result")))
            continue;
        json_copy(json_member(f, "name"), own.name, sizeof own.name);
        json_copy(json_member(f, "of"), own.of, sizeof own.of);
        json_copy(json_member(f, "by"), own.by, sizeof own.by);
        json_copy(json_member(f, "unit"), own.unit, sizeof own.unit);
        n = strlen(own.name);
        if (estimates && c->estimates < COST_ESTIMATES)
            c->estimate[c->estimates++] = own;
        if (estimates || c->figures == COST_FIGURES ||
            (n > 2 &&
             (strcmp(own.name + n - 2, "_x") == 0 || strcmp(own.name + n - 2, "_y") == 0)) ||
            (n > 6 && strcmp(own.name + n - 6, "_depth") == 0))
            continue;
        c->figure[c->figures++] = own;
    }
}

static const char *
report_of(const struct cost_case *c, const struct cost_trial *t, size_t program)
{
    return c->run[t->run[program]].report;
}

/* The largest difference of any line, relative to the largest value; NAN: unknown. */
static double
compare_figure(const struct cost_case *c, const struct cost_trial *t, const struct cost_figure *f)
{
    const char *at = report_of(c, t, f->program),
               *of = report_of(c, &c->trial[c->reference], f->program);
    const char *line, *exact;
    double most = 0, off = 0;

    if (c->run[t->run[f->program]].lines != c->run[c->trial[c->reference].run[f->program]].lines)
        return NAN;
    while ((line = cost_line(&at)) != NULL && (exact = cost_line(&of)) != NULL) {
        const double v = json_real(json_member(line, f->name)),
                     r = json_real(json_member(exact, f->name));

        if (isnan(v) != isnan(r))
            return NAN;
        most = fmax(most, fabs(r));
        if (!isnan(r) && fabs(v - r) > fabs(off))
            off = v - r;
        if (isnan(r) && at == NULL)
            return NAN;
    }
    return off == 0 ? most > 0 ? 0 : NAN : most > 0 ? off / most : NAN;
}

static double
largest(const char *report, const char *name)
{
    double most = NAN;
    const char *line;

    while ((line = cost_line(&report)) != NULL)
        most = fmax(most, json_real(json_member(line, name)));
    return most;
}

/* True if the report of the reference has a number for the figure. */
static bool
is_reported(const struct cost_case *c, const struct cost_figure *f)
{
    return !isnan(largest(report_of(c, &c->trial[c->reference], f->program), f->name));
}

/* Figures that several programs report have the number of their program before their names. */
static void
name_figures(struct cost_case *c)
{
    for (size_t k = 0; k < c->figures; k++) {
        struct cost_figure *f = &c->figure[k];
        bool twice = false, later = false;

        for (size_t i = 0; i < c->figures && is_reported(c, f); i++) {
            const struct cost_figure *o = &c->figure[i];

            if (i == k || strcmp(o->name, f->name) != 0 || !is_reported(c, o))
                continue;
            twice = true;
            later = later || o->program > f->program;
        }
        if (twice)
            snprintf(f->shown, sizeof f->shown, "%zu.%s", f->program + 1, f->name);
        else
            snprintf(f->shown, sizeof f->shown, "%s", f->name);
        snprintf(f->column, sizeof f->column, "%.56s_error", later ? f->shown : f->name);
    }
}

void
cost_compare(struct cost_case *c, struct cost_trial *t)
{
    const struct cost_trial *reference = &c->trial[c->reference];
    struct cost_run *r = &c->run[t->run[t->runs - 1]];
    const int exact = c->run[reference->run[reference->runs - 1]].output;

    if (!r->compared && r->output >= 0 && r->output == exact) {
        r->compared = true;
        for (size_t k = 0; k < c->channels; k++)
            r->channel[k] = 0;
    } else if (!r->compared && r->output >= 0 && exact >= 0) {
        const size_t cases = compare_frames(c, r->output, exact, r->channel);

        r->compared = true;
        close(r->output);
        r->output = -1;
        if (cases != c->cases && tool_interrupted() == 0) {
            r->state = t->state = COST_STOPPED;
            snprintf(t->why, sizeof t->why, "it gives %zu case%s, the reference %zu", cases,
                     cases == 1 ? "" : "s", c->cases);
            return;
        }
    }
    for (size_t k = 0; k < c->channels && !r->compared; k++)
        r->channel[k] = NAN;
    for (size_t k = 0; k < c->figures; k++)
        t->figure[k] = compare_figure(c, t, &c->figure[k]);
    for (size_t k = 0; k < c->estimates; k++)
        t->judged[k] = largest(report_of(c, t, c->estimate[k].program), c->estimate[k].name);
}

void
cost_reference_read(struct cost_case *c)
{
    const struct cost_trial *reference = &c->trial[c->reference];
    const struct cost_run *r = &c->run[reference->run[reference->runs - 1]];

    if (r->output >= 0) {
        walk(c, r->output, note_channel);
        walk(c, input_of(c, r), note_passed);
    }
    c->cases = c->cases == 0 ? 1 : c->cases;
    for (size_t k = c->command.programs; k-- > 0;)
        find_figures(c, k);
    name_figures(c);
    for (size_t k = 0; k < c->trials; k++)
        if (c->trial[k].state == COST_DONE)
            cost_compare(c, &c->trial[k]);
}

/* ---- errors ---- */

double
cost_error_of(const struct cost_case *c, const struct cost_trial *t, struct cost_object o)
{
    if (!o.known || t->state != COST_DONE)
        return NAN;
    return o.frame ? c->run[t->run[t->runs - 1]].channel[o.k] : t->figure[o.k];
}

struct cost_object
cost_object_named(const struct cost_case *c, const char *name)
{
    size_t k = channel_of(c, name);

    if (k < c->channels)
        return (struct cost_object){.frame = true, .known = true, .k = k};
    for (k = 0; k < c->figures && strcmp(c->figure[k].shown, name) != 0; k++)
        continue;
    if (k == c->figures) /* without a number: of the last program */
        for (k = 0; k < c->figures && strcmp(c->figure[k].name, name) != 0; k++)
            continue;
    return (struct cost_object){.known = k < c->figures, .k = k};
}

struct cost_object
cost_object_of(const struct cost_case *c, const struct cost_figure *estimate)
{
    const struct cost_object named = cost_object_named(c, estimate->of);

    for (size_t k = 0; k < c->figures && !named.frame; k++)
        if (c->figure[k].program == estimate->program &&
            strcmp(c->figure[k].name, estimate->of) == 0)
            return (struct cost_object){.known = true, .k = k};
    return named;
}

const char *
cost_object_name(const struct cost_case *c, struct cost_object o)
{
    return !o.known ? "nothing" : o.frame ? c->channel[o.k].name : c->figure[o.k].shown;
}

/* True for an estimate that is named after what it belongs to: the others of this program are parts of it. */
static bool
is_whole(const struct cost_figure *e)
{
    const size_t n = strlen(e->of);

    return strncmp(e->name, e->of, n) == 0 && strcmp(e->name + n, "_error_estimate") == 0;
}

/* An estimate counts if an option of its program, or the grid, lowers it. NAN also if that of the whole error
 * is unknown, whatever its parts are. */
double
cost_estimate_of(const struct cost_case *c, const struct cost_trial *t, struct cost_object o,
                 bool any)
{
    double most = NAN;

    for (size_t k = 0; k < c->estimates; k++) {
        const struct cost_figure *e = &c->estimate[k];
        const bool grid = strcmp(e->by, "grid") == 0;
        const struct cost_object own = cost_object_of(c, e);

        if (!o.known || !own.known || own.frame != o.frame || own.k != o.k)
            continue;
        if (grid ? t->coarse == 1 : t->coarse > 1 && !any)
            continue;
        if (!grid && cost_option(&c->command.program[e->program], e->by) == NULL)
            continue;
        if (is_whole(e) && isnan(t->judged[k]))
            return NAN;
        most = fmax(most, t->judged[k]);
    }
    return most;
}

static const double rounding = 1e-12; /* differences below are those of sums in another order */

/* The largest change of the last steps of the lists; NAN: none is known. */
static double
last_change(const struct cost_case *c, struct cost_object o)
{
    const struct cost_trial *reference = &c->trial[c->reference];
    double most = NAN;

    for (size_t l = 0; l < c->lists; l++) {
        size_t pick[COST_LISTS], k = 0;

        if (c->list[l].last == SIZE_MAX)
            continue;
        memcpy(pick, reference->pick, sizeof pick);
        pick[l] = c->list[l].last;
        while (k < c->trials && memcmp(c->trial[k].pick, pick, c->lists * sizeof *pick) != 0)
            k++;
        if (k < c->trials)
            most = fmax(most, fabs(cost_error_of(c, &c->trial[k], o)));
    }
    return most;
}

double
cost_reference_error(const struct cost_case *c, struct cost_object o)
{
    const struct cost_trial *reference = &c->trial[c->reference];
    const double own = cost_estimate_of(c, reference, o, true);
    double most = fmax(own, last_change(c, o));

    for (size_t l = 0; l < c->lists && isnan(own) && most < rounding; l++)
        if (strcmp(c->list[l].option, "tol") == 0) /* the last step did no further work */
            most = c->list[l].number[reference->pick[l]];
    return most;
}

static void
mark_differences(struct cost_case *c)
{
    for (size_t k = 0; k < c->trials; k++) {
        const struct cost_trial *t = &c->trial[k];

        if (t->state != COST_DONE)
            continue;
        for (size_t i = 0; i < c->channels; i++)
            c->channel[i].differs =
                c->channel[i].differs || c->run[t->run[t->runs - 1]].channel[i] > rounding;
        for (size_t i = 0; i < c->figures; i++)
            c->figure[i].differs = c->figure[i].differs || fabs(t->figure[i]) > rounding;
    }
}

/* The frame or figure of --of; else the first frame that the last program makes, that is no map of whole
 * numbers and that differs in some trial; else less. */
static struct cost_object
ranked(const struct cost_case *c)
{
    if (c->of != NULL)
        return cost_object_named(c, c->of);
    for (int less = 0; less < 3; less++)
        for (size_t k = 0; k < c->channels; k++)
            if (!c->channel[k].passed && (less > 0 || !c->channel[k].whole) &&
                (less > 1 || c->channel[k].differs))
                return (struct cost_object){.frame = true, .known = true, .k = k};
    for (size_t k = 0; k < c->figures; k++)
        if (c->figure[k].differs)
            return (struct cost_object){.known = true, .k = k};
    return (struct cost_object){.known = false};
}

/* What the estimate in the table belongs to: the ranked object, or the first one of the last program that has
 * an estimate. */
static struct cost_object
judged(const struct cost_case *c)
{
    const struct cost_trial *reference = &c->trial[c->reference];

    if (!isnan(cost_estimate_of(c, reference, c->ranked, true)))
        return c->ranked;
    for (size_t k = 0; k < c->estimates; k++) {
        const struct cost_object o = cost_object_of(c, &c->estimate[k]);

        if (c->estimate[k].program + 1 == c->command.programs &&
            !isnan(cost_estimate_of(c, reference, o, true)))
            return o;
    }
    return c->ranked;
}

bool
cost_is_optimistic(const struct cost_case *c, const struct cost_trial *t, struct cost_object o)
{
    const double own =
                     fmin(cost_estimate_of(c, &c->trial[c->reference], o, true), last_change(c, o)),
                 error = fabs(cost_error_of(c, t, o)) - (isnan(own) ? 0 : own);

    return error > rounding && cost_estimate_of(c, t, o, false) < 0.9 * error;
}

/* Errors below the error of the reference count as equal. */
static double
seen(const struct cost_case *c, const struct cost_trial *t)
{
    return fmax(t->error, c->reference_error);
}

/* True if `by` is as accurate, and better in time or memory by more than the scatter, but not worse in the
 * other. */
static bool
is_beaten(const struct cost_case *c, const struct cost_trial *t, const struct cost_trial *by)
{
    const double seconds = fmax(0.1 * t->seconds, 2e-3), bytes = fmax(0.1 * t->memory, 1048576),
                 faster = t->seconds - by->seconds,
                 smaller = isnan(t->memory) || isnan(by->memory) ? 0 : t->memory - by->memory;

    return by->state == COST_DONE && by->converged && seen(c, by) <= seen(c, t) &&
           ((faster > seconds && smaller >= -bytes) || (smaller > bytes && faster >= -seconds));
}

void
cost_judge(struct cost_case *c)
{
    mark_differences(c);
    c->ranked = ranked(c);
    c->judged = judged(c);
    c->reference_error = cost_reference_error(c, c->ranked);
    for (size_t k = 0; k < c->trials; k++) {
        struct cost_trial *t = &c->trial[k];

        t->optimistic = false;
        if (t->state != COST_DONE)
            continue;
        t->error = fabs(cost_error_of(c, t, c->ranked));
        t->estimate = cost_estimate_of(c, t, c->judged, true);
        t->bound = t->error + (isnan(c->reference_error) ? 0 : c->reference_error);
        t->unjudged = isnan(t->estimate);
        for (size_t i = 0; i < c->estimates && !t->reference; i++)
            t->optimistic =
                t->optimistic || cost_is_optimistic(c, t, cost_object_of(c, &c->estimate[i]));
    }
    for (size_t k = 0; k < c->trials; k++) {
        struct cost_trial *t = &c->trial[k];

        t->front = t->state == COST_DONE && !isnan(t->error);
        for (size_t i = 0; i < c->trials && t->front; i++)
            t->front = !is_beaten(c, t, &c->trial[i]);
    }
}
