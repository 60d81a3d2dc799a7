/*
 * --checkpoint and --resume: a file of pressures, and of states of a body that yields inside, from which a
 * run that was cut off goes on.
 *
 * Frames are only ever added, each a grid stream of its own with its end line, so that the file is
 * whole but for what was being written when the machine stopped: a case when it is done, what is
 * reached of one when a signal ends the run, and on the way after 1, 2, 4, 8 ... intervals, so that
 * at most half of the time spent on a case is lost. Of several frames of a case the last counts; a
 * state is one frame, so that it is there as a whole or not at all, and counts before a pressure, which is
 * that of the elastic solution before it.
 * Disk full is no reason to lose the solution: it is said once, and the run goes on.
 */
#include "solve.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

#include "formats/core/core.h"
#include "tools/journal/journal.h"

struct saved {
    size_t number; /* the case                                        */
    off_t at;      /* where its frame begins                          */
    bool state;    /* of a body that yields inside, else a pressure   */
};

struct checkpoint {
    struct run *run;
    struct journal journal;
    struct saved *saved;
    size_t count;
    char surface[16];         /* CRC-32 of the heights, the sphere included */
    char hardness[16];        /* CRC-32 of a map of it; empty: there is none */
    double began, wait, next; /* seconds: of this case, between frames, of the next one */
};

/* ---- what is there ---- */

static const char of_state[] = "state"; /* its channel */

static void
note(struct checkpoint *c, size_t number, off_t at, bool state)
{
    struct saved *more = realloc(c->saved, (c->count + 1) * sizeof *more);

    if (more == NULL)
        tool_die(&c->run->t, EXIT_IMPOSSIBLE, "out of memory for the cases of --checkpoint");
    c->saved = more;
    c->saved[c->count++] = (struct saved){number, at, state};
}

/* Whether the first frame, whole or not, is one of a checkpoint. */
static bool
is_checkpoint(const struct checkpoint *c)
{
    bool begins = true; /* a line may come in several pieces: this is its first */
    char line[256];

    if (fseeko(c->journal.file, 0, SEEK_SET) != 0 ||
        fgets(line, sizeof line, c->journal.file) == NULL || strcmp(line, "RCG1\n") != 0)
        return false;
    while (fgets(line, sizeof line, c->journal.file) != NULL &&
           !(begins && strcmp(line, "\n") == 0)) {
        if (begins && strncmp(line, "checkpoint.case=", 16) == 0)
            return true;
        begins = strchr(line, '\n') != NULL;
    }
    return false;
}

/* Finds the frames. What was being written when the run was cut off is cut off here too. */
static void
look_through(struct checkpoint *c)
{
    struct tool *t = &c->run->t;
    struct rc_err err;
    struct rc_reader *reader = rc_reader_new(c->journal.file, 0, t->memory, &err);
    const struct rc_share *share = ranks_read(t, c->journal.name);
    struct rc_grid *g;
    enum rc_status status;
    off_t end = 0;
    double number;

    if (reader == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "%s", err.text);
    rc_reader_share(reader, share);
    while ((status = rc_reader_next(reader, &g, &err)) == RC_MORE) {
        if (!rc_grid_number(g, "checkpoint.case", &number))
            tool_die(t, EXIT_IMPOSSIBLE,
                     "--checkpoint %s: a grid stream, but no checkpoint: name another file",
                     c->journal.name);
        note(c, (size_t)number, end, strcmp(g->channel, of_state) == 0);
        end = journal_frame_end(&c->journal);
        rc_grid_free(g);
    }
    rc_reader_free(reader);
    ranks_close(t, share);
    clearerr(c->journal.file);
    if (fseeko(c->journal.file, 0, SEEK_END) == 0 && ftello(c->journal.file) == 0)
        return;
    if (status != RC_OK && c->count == 0 && !is_checkpoint(c))
        tool_die(t, EXIT_IMPOSSIBLE,
                 "--checkpoint %s: no pressure can be read from it (%s): remove it to begin anew",
                 c->journal.name, err.text);
    if (status != RC_OK && !journal_is_cut_off(&c->journal, end))
        tool_die(
            t, EXIT_IMPOSSIBLE,
            "--checkpoint %s: frame %zu of it cannot be read (%s): remove the file to begin anew",
            c->journal.name, c->count + 1, err.text);
    ranks_wait(t);         /* all have looked */
    if (!ranks_speak(t)) { /* the first one cuts it off */
        ranks_wait(t);
        return;
    }
    if (c->count == 0)
        tool_warn(t,
                  "--checkpoint %s: the run stopped while it wrote the first frame: it begins anew",
                  c->journal.name);
    journal_cut(&c->journal, c->count, end);
    ranks_wait(t);
}

struct checkpoint *
checkpoint_open(struct run *run, const char *name, bool resume, double interval)
{
    struct checkpoint *c;
    bool found;

    if (name == NULL)
        return NULL;
    c = calloc(1, sizeof *c);
    if (c == NULL)
        tool_die(&run->t, EXIT_IMPOSSIBLE, "out of memory");
    c->run = run;
    c->wait = interval;
    journal_open(&c->journal, &run->t, name, resume, &found);
    if (found)
        look_through(c);
    return c;
}

void
checkpoint_close(struct checkpoint *c)
{
    if (c == NULL)
        return;
    journal_close(&c->journal);
    free(c->saved);
    free(c);
}

/* ---- a surface, a case ---- */

static void
sum_up(struct checkpoint *c, const struct rc_grid *g, char text[16])
{
    size_t bytes = rc_grid_nodes(g) * sizeof *g->v;

    snprintf(text, 16, "%08" PRIx32, ranks_crc(&c->run->t, rc_crc32_add(0, g->v, bytes), bytes));
}

void
checkpoint_surface(struct checkpoint *c, const struct rc_grid *g, const struct rc_grid *hardness)
{
    if (c == NULL)
        return;
    sum_up(c, g, c->surface);
    c->hardness[0] = '\0';
    if (hardness != NULL)
        sum_up(c, hardness, c->hardness);
}

/* What a frame has to agree in with the case that goes on from it; an empty value: neither has it. */
struct mark {
    const char *name;
    char value[2 * RC_NUMBER_SIZE];
};

enum {
    MARKS = 13
};

static struct mark
number_mark(const char *name, double value)
{
    struct mark m = {.name = name};

    rc_number_text(m.value, value);
    return m;
}

static void
marks_of(const struct checkpoint *c, struct mark mark[MARKS])
{
    const struct physics *args = &c->run->args->physics;
    size_t n = 6;

    mark[0].name = "checkpoint.surface";
    snprintf(mark[0].value, sizeof mark[0].value, "%s", c->surface);
    mark[1].name = "boundary";
    snprintf(mark[1].value, sizeof mark[1].value, "%s", args->periodic ? "periodic" : "free");
    mark[2] = number_mark("estar", args->estar);
    mark[3] = number_mark("checkpoint.hardness", args->hardness);
    if (c->hardness[0] != '\0')
        snprintf(mark[3].value, sizeof mark[3].value, "map %s", c->hardness);
    mark[4] = number_mark(args->load.per_metre        ? "checkpoint.load-per-metre"
                          : args->load.n > 0          ? "checkpoint.load"
                          : args->mean_pressure.n > 0 ? "checkpoint.mean-pressure"
                                                      : "checkpoint.approach",
                          c->run->steps->v[c->run->step]);
    mark[5].name = "checkpoint.history"; /* the loads before, which have left their shape */
    snprintf(mark[5].value, sizeof mark[5].value, "%08" PRIx32,
             !args->history
                 ? 0
                 : rc_crc32_add(0, c->run->steps->v, c->run->step * sizeof *c->run->steps->v));
    for (int k = 0; k < YIELD_MARKS; k++, n++)
        mark[n].name = yield_mark(c->run, k, mark[n].value, sizeof mark[n].value);
    mark[n].name = "checkpoint.adhesion";
    adhesion_mark(c->run, mark[n].value, sizeof mark[n].value);
}

static void
compare(struct checkpoint *c, const struct rc_grid *g, const struct rc_grid *saved)
{
    struct mark mark[MARKS];
    struct tool *t = &c->run->t;
    bool state = strcmp(saved->channel, of_state) == 0; /* whose length is its own */

    if ((!state && (saved->nx != g->nx || saved->ny != g->ny)) || saved->dx != g->dx ||
        saved->dy != g->dy)
        tool_die_at(t, g, EXIT_IMPOSSIBLE,
                    "--checkpoint %s: it belongs to another grid, %zu x %zu nodes", c->journal.name,
                    saved->nx, saved->ny);
    marks_of(c, mark);
    for (size_t k = 0; k < MARKS; k++) {
        const char *was = rc_grid_get(saved, mark[k].name);
        if (strcmp(was == NULL ? "" : was, mark[k].value) != 0)
            tool_die_at(t, g, EXIT_IMPOSSIBLE,
                        "--checkpoint %s: it belongs to another problem: %s was %s, is %s",
                        c->journal.name, mark[k].name, was == NULL ? "not given" : was,
                        mark[k].value[0] == '\0' ? "not given" : mark[k].value);
    }
}

/* The last frame of this kind that the case has, as it must be; NULL: there is none. The clock of the case
 * begins. */
static struct rc_grid *
last_frame(struct checkpoint *c, const struct rc_grid *g, bool state)
{
    struct rc_grid *saved;
    size_t k;

    if (c == NULL)
        return NULL;
    c->began = solve_now();
    c->next = c->wait;
    for (k = c->count;
         k > 0 && (c->saved[k - 1].number != c->run->number || c->saved[k - 1].state != state); k--)
        ;
    if (k == 0)
        return NULL;
    saved = journal_read(&c->journal, c->saved[k - 1].at);
    compare(c, g, saved);
    return saved;
}

bool
checkpoint_case(struct checkpoint *c, const struct rc_grid *g, struct rc_solver *solver)
{
    struct rc_grid *saved = last_frame(c, g, false);
    struct rc_err err;
    double load;

    if (saved == NULL) {
        rc_grid_free(last_frame(c, g, true)); /* a state alone has to belong to this problem too */
        return false;
    }
    if (!rc_grid_number(saved, "load", &load) ||
        rc_solver_warm_start(solver, load, saved->v, &err) != RC_OK)
        tool_die_at(&c->run->t, g, EXIT_IMPOSSIBLE, "--checkpoint %s: it cannot be started from",
                    c->journal.name);
    rc_grid_free(saved);
    return true;
}

struct rc_grid *
checkpoint_state(struct checkpoint *c, const struct rc_grid *g)
{
    return last_frame(c, g, true);
}

/* ---- saving ---- */

/* Adds this frame, whose marks and case are set here. */
static void
add(struct checkpoint *c, const struct rc_grid *g, struct rc_grid *out, double load)
{
    struct mark mark[MARKS];
    struct rc_err err;
    off_t at;

    marks_of(c, mark);
    (void)rc_grid_set(out, "case", NULL, &err); /* each is a stream of its own */
    for (size_t k = 0; k < MARKS; k++)
        if (mark[k].value[0] != '\0' &&
            rc_grid_set(out, mark[k].name, mark[k].value, &err) != RC_OK)
            tool_die_at(&c->run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    if (rc_grid_set_number(out, "checkpoint.case", (double)c->run->number, &err) != RC_OK ||
        rc_grid_set_number(out, "load", load, &err) != RC_OK ||
        rc_grid_history(out, tool_history(&c->run->t), &err) != RC_OK)
        tool_die_at(&c->run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    if (journal_add(&c->journal, out, &at))
        note(c, c->run->number, at, strcmp(out->channel, of_state) == 0);
}

void
checkpoint_save(struct checkpoint *c, const struct rc_grid *g, const struct rc_solver *solver)
{
    struct rc_grid *out;
    struct rc_err err;

    if (c == NULL || c->journal.file == NULL)
        return;
    out = rc_grid_like(g, "pressure", "Pa", &err);
    if (out == NULL)
        tool_die_at(&c->run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    memcpy(out->v, rc_solver_pressure(solver), rc_grid_nodes(g) * sizeof *out->v);
    add(c, g, out, rc_solver_load(solver));
    rc_grid_free(out);
}

void
checkpoint_save_state(struct checkpoint *c, const struct rc_grid *g, size_t n,
                      checkpoint_fill *fill, const void *ctx, double load)
{
    const struct rc_shape shape = {n, 1, g->dx, g->dy};
    struct rc_grid *out;
    struct rc_err err;

    if (c == NULL || c->journal.file == NULL)
        return;
    out = rc_grid_new(&shape, of_state, "1", &err);
    if (out == NULL)
        tool_die_at(&c->run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    fill(ctx, out->v);
    add(c, g, out, load);
    rc_grid_free(out);
}

bool
checkpoint_due(struct checkpoint *c)
{
    if (c == NULL || ranks_most(&c->run->t, solve_now() - c->began) < c->next)
        return false;
    c->next *= 2;
    return true;
}

void
checkpoint_pass(struct checkpoint *c, const struct rc_grid *g, const struct rc_solver *solver)
{
    struct rc_progress at;

    rc_solver_progress(solver, &at);
    if (c == NULL || at.coarser || at.iterations == 0)
        return; /* on the coarser grids there is nothing to keep */
    if (checkpoint_due(c))
        checkpoint_save(c, g, solver);
}
