/*
 * --yield: body 1 yields inside. A load is solved as an elastic one first; where its stresses nowhere reach
 * the yield stress that is the solution, and nothing of the volume has been touched. Else the body is
 * pressed from 0 in increments, and from then on every load of the list follows the last.
 */
#include "solve.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

enum {
    FIRST = 8,       /* increments of the first try of a load, where their number is left open */
    MOST_AUTO = 128, /* and of the last, */
    MOST = 512,      /* with a --tol below the usual goal, and on the command line */
    TRIES = 3
};
static const double deserved = 1e-2;       /* error that the increments are chosen for            */
static const double contact_most = 1e-4;   /* tolerance of each contact, at most,                 */
static const double contact_least = 1e-6;  /* and, for the sake of a smaller --tol, at least      */
static const double contact_share = 0.1;   /* of --tol                                            */
static const double lag_least = 1e-3;      /* what single precision allows                        */
static const double for_later = 0.7;       /* share of the goal where loads follow                */
static const double expected_part = 0.3;   /* of the voxels that yield, for the memory            */
static const double order = 1.1;           /* power of the error that the increments go by        */
static const double image_order = 1 / 2.7; /* and the side of a free map                         */
static const double large_strain = 0.1;

/* ---- the command line ---- */

/* "auto", or a whole number in *count, 0: none; else a list of lengths where one is asked for. */
static void
read_count(struct run *run, const char *name, const char *text, size_t *count,
           struct numbers *lengths)
{
    struct rc_err err;
    char *end;
    unsigned long n;

    *count = 0;
    if (text == NULL || strcmp(text, "auto") == 0)
        return;
    n = strtoul(text, &end, 10);
    if (end != text && *end == '\0' && n > 0 && n <= MOST && text[0] != '-') {
        *count = n;
        return;
    }
    if (lengths == NULL || (end != text && *end == '\0'))
        tool_die(&run->t, EXIT_USAGE, "--%s %s: it must be auto%s or a number from 1 to %d", name,
                 text, lengths == NULL ? "" : ", a list of thicknesses", MOST);
    if (unit_numbers(text, UNIT_M, lengths, &err) != RC_OK)
        tool_die(&run->t, EXIT_USAGE, "--%s %s: %s", name, text, err.text);
    for (size_t k = 0; k < lengths->n; k++)
        if (!(lengths->v[k] > 0))
            tool_die(&run->t, EXIT_USAGE, "--%s %s: a slab must have a thickness above 0", name,
                     text);
}

void
yield_read(struct run *run)
{
    const struct solve_args *args = run->args;
    const struct physics *a = &args->physics;
    struct yielding *y = &run->yielding;
    struct rc_err err;

    y->wanted = args->yield != NULL;
    if (!y->wanted && (args->increments != NULL || args->slabs != NULL))
        tool_die(&run->t, EXIT_USAGE, "--increments and --slabs belong to --yield");
    for (int f = SOLVE_RESIDUAL; !y->wanted && f <= SOLVE_STRAIN; f++)
        if (solve_wanted(args, f))
            tool_die(&run->t, EXIT_USAGE, "--output %s has no effect without --yield",
                     solve_frames[f].name);
    if (!y->wanted)
        return;
    if (yield_law_read(&y->read, args->yield, &err) != RC_OK)
        tool_die(&run->t, EXIT_USAGE, "--yield %s: %s", args->yield, err.text);
    y->law = y->read.law;
    read_count(run, "increments", args->increments, &y->asked, NULL);
    read_count(run, "slabs", args->slabs, &y->slab_count, &y->list);
    yield_law_check(&run->t, &y->read, a);
    yield_law_refuse(&run->t, args->discretization, "--discretization",
                     "a grid half as fine yields elsewhere: solve it by itself");
    yield_law_refuse(&run->t, run->tilt, "--tilt free", "a body that yields follows one direction");
}

void
yield_free(struct run *run)
{
    struct yielding *y = &run->yielding;

    rc_plastic_free(y->plastic);
    free(y->thickness);
    free(y->before);
    y->plastic = NULL;
    y->thickness = y->before = NULL;
    y->slabs = 0;
}

/* ---- slabs ---- */

/* From the elastic pressure: false when nothing yields under it. */
static bool
find_slabs(struct run *run, const struct rc_grid *g, const double *p)
{
    struct yielding *y = &run->yielding;
    const struct rc_shape shape = rc_grid_shape(g);
    double stress = yield_law_first(&y->law);
    struct rc_plastic_depths d;
    struct rc_err err;

    if (rc_plastic_depths(&shape, run->args->physics.periodic ? RC_PERIODIC : RC_FREE, p,
                          &run->args->physics.pair.one, stress, run->t.threads, &d, &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    y->most = d.most / stress;
    y->deepest = d.deepest;
    free(y->thickness);
    y->thickness = d.thickness;
    y->slabs = d.slabs;
    if (d.slabs == 0)
        return false;
    if (y->list.n > 0) {
        free(y->thickness);
        y->slabs = y->list.n;
        y->thickness = malloc(y->slabs * sizeof *y->thickness);
        if (y->thickness != NULL)
            memcpy(y->thickness, y->list.v, y->slabs * sizeof *y->thickness);
    } else if (y->slab_count > 0) {
        y->slabs = y->slab_count;
        y->thickness = yield_stack(&d, y->slabs);
        free(d.thickness);
    }
    if (y->thickness == NULL)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "out of memory for the slabs");
    return true;
}

/* ---- loads ---- */

static double
goal(const struct run *run)
{
    return run->args->tol > 0 ? run->args->tol : deserved;
}

static struct rc_plastic_problem
problem_of(const struct run *run, struct rc_problem contact)
{
    const struct yielding *y = &run->yielding;
    double asked = contact.tol > 0 ? contact.tol : 1;

    contact.tol = fmin(fmin(asked, fmax(contact_share * asked, contact_least)), contact_most);
    return (struct rc_plastic_problem){.contact = contact,
                                       .yield = y->law,
                                       .slabs = y->slabs,
                                       .thickness = y->thickness,
                                       .increments = y->increments,
                                       .lag = fmax(2 * fmin(goal(run), deserved), lag_least)};
}

static void
make(struct run *run, const struct rc_grid *g, struct rc_problem contact)
{
    struct yielding *y = &run->yielding;
    const struct rc_shape shape = rc_grid_shape(g);
    struct rc_plastic_problem problem = problem_of(run, contact);
    size_t bytes = rc_plastic_memory(&shape, &problem, expected_part);
    struct rc_err err;

    rc_plastic_free(y->plastic);
    y->plastic = NULL;
    /* a state takes no more than the voxels, and a pressure */
    if (run->checkpoint != NULL || (y->asked == 0 && run->steps->n > 1))
        bytes += bytes - rc_plastic_memory(&shape, &problem, 0) + rc_grid_nodes(g) * sizeof *g->v;
    tool_demand_memory(&run->t, g, bytes);
    y->plastic = rc_plastic_new(&shape, g->v, &problem, &err);
    if (y->plastic == NULL)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
}

/* ---- states in a checkpoint: increments, try, slabs, their thicknesses, then the library's numbers ---- */

enum {
    STATE_HEAD = 3
};

static void
fill_state(const void *ctx, double *to)
{
    const struct yielding *y = ctx;

    to[0] = (double)y->increments;
    to[1] = (double)y->try;
    to[2] = (double)y->slabs;
    memcpy(to + STATE_HEAD, y->thickness, y->slabs * sizeof *to);
    rc_plastic_state(y->plastic, to + STATE_HEAD + y->slabs);
}

static void
save(struct run *run, const struct rc_grid *g, double load)
{
    const struct yielding *y = &run->yielding;

    checkpoint_save_state(run->checkpoint, g,
                          STATE_HEAD + y->slabs + rc_plastic_state_size(y->plastic), fill_state, y,
                          load);
}

static void
damaged(struct run *run, const struct rc_grid *g, const char *why)
{
    tool_die_at(&run->t, g, EXIT_IMPOSSIBLE,
                "--checkpoint %s: case %zu cannot be gone on with (%s): remove the file to begin "
                "anew",
                run->args->checkpoint, run->number, why);
}

/* What the state says of increments and slabs. */
static void
read_head(struct run *run, const struct rc_grid *g, const struct rc_grid *state)
{
    struct yielding *y = &run->yielding;
    const double *v = state->v;

    if (state->nx < STATE_HEAD || !(v[0] >= 1 && v[0] <= MOST) || !(v[1] >= 0 && v[1] < TRIES) ||
        !(v[2] >= 1 && v[2] < (double)(state->nx - STATE_HEAD)))
        damaged(run, g, "its first numbers are none of a state");
    y->increments = (size_t)v[0];
    y->try = (size_t)v[1];
    y->slabs = (size_t)v[2];
    free(y->thickness);
    y->thickness = malloc(y->slabs * sizeof *y->thickness);
    if (y->thickness == NULL)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "out of memory for the slabs");
    memcpy(y->thickness, v + STATE_HEAD, y->slabs * sizeof *y->thickness);
}

static void
restore(struct run *run, const struct rc_grid *g, struct rc_grid *state)
{
    struct yielding *y = &run->yielding;
    size_t head = STATE_HEAD + y->slabs;
    const double *v = state->v;
    struct rc_err err;

    if (state->nx <= head || !(v[0] >= 1 && v[0] <= MOST) || !(v[1] >= 0 && v[1] < TRIES) ||
        v[2] != (double)y->slabs || memcmp(v + STATE_HEAD, y->thickness, y->slabs * sizeof *v) != 0)
        damaged(run, g, "it has other slabs than the load before it");
    y->increments = (size_t)v[0];
    y->try = (size_t)v[1];
    if (rc_plastic_restore(y->plastic, v + head, state->nx - head, &err) != RC_OK)
        damaged(run, g, err.text);
    rc_grid_free(state);
}

const char *
yield_mark(const struct run *run, int k, char *value, size_t size)
{
    static const char *const names[YIELD_MARKS] = {"checkpoint.yield",      "checkpoint.e1",
                                                   "checkpoint.nu1",        "checkpoint.slabs",
                                                   "checkpoint.increments", "checkpoint.tol"};
    const struct yielding *y = &run->yielding;
    const struct physics *a = &run->args->physics;
    const double number[YIELD_MARKS] = {y->law.stress,         a->pair.one.e,    a->pair.one.nu,
                                        (double)y->slab_count, (double)y->asked, goal(run)};
    char text[RC_NUMBER_SIZE], modulus[RC_NUMBER_SIZE];
    const size_t bytes = y->law.points * sizeof(double);

    value[0] = '\0';
    if (!y->wanted)
        return names[k];
    if (k == 0 && y->law.points > 0)
        snprintf(value, size, "table %08" PRIx32,
                 rc_crc32_add(rc_crc32_add(0, y->read.table[0], bytes), y->read.table[1], bytes));
    else if (k == 0)
        snprintf(value, size, "%s,%s", rc_number_text(text, number[k]),
                 rc_number_text(modulus, y->law.modulus));
    else if (k == 3 && y->list.n > 0)
        snprintf(value, size, "list %08" PRIx32,
                 rc_crc32_add(0, y->list.v, y->list.n * sizeof *y->list.v));
    else
        snprintf(value, size, "%s",
                 (k == 3 || k == 4) && number[k] == 0 ? "auto" : rc_number_text(text, number[k]));
    return names[k];
}

/* ---- the loads themselves ---- */

/* A load with as many increments as are to be tried next. */
static void
set_load(struct run *run, const struct rc_grid *g, double load)
{
    struct rc_err err;

    rc_plastic_set_increments(run->yielding.plastic, run->yielding.increments);
    if (rc_plastic_set_load(run->yielding.plastic, load, &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
}

/* To the end of the load that is set. `kept`: the checkpoint holds where it stands. */
static void
go(struct run *run, const struct rc_grid *g, double load, bool kept)
{
    struct yielding *y = &run->yielding;
    double start = solve_now(), at;
    size_t increment, application, steps = 0;
    struct rc_err err;

    y->status = RC_MORE;
    while (tool_interrupted() == 0 && y->status == RC_MORE) {
        y->status = rc_plastic_step(y->plastic, &err);
        steps++;
        rc_plastic_progress(y->plastic, &at, &increment, &application);
        tool_progress(&run->t,
                      "case %zu, %zu x %zu, load %.3g N, increment %zu of %zu, application %zu",
                      run->number, g->nx, g->ny, at, increment, y->increments, application);
        /* between increments less is to be kept; the last may take long */
        if (y->status == RC_MORE && (application == 0 || increment >= y->increments) &&
            checkpoint_due(run->checkpoint))
            save(run, g, load);
    }
    tool_progress_end(&run->t);
    if (y->status == RC_FAIL)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    if (!kept || steps > 1) /* else it is there already */
        save(run, g, load);
    run->iterate += solve_now() - start;
}

/* Before a load: where it begins, so that it can be tried again. */
static void
begin(struct run *run, const struct rc_grid *g)
{
    struct yielding *y = &run->yielding;

    y->increments = y->asked > 0 ? y->asked : FIRST;
    y->try = 0;
    if (y->asked > 0)
        return;
    free(y->before);
    y->before_size = rc_plastic_state_size(y->plastic);
    y->before = malloc(y->before_size * sizeof *y->before);
    if (y->before == NULL)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "out of memory for the state before a load");
    rc_plastic_state(y->plastic, y->before);
}

/* Whether more increments lower the error of the load to what is asked for, and how many. What images and
 * earlier loads do is not their matter. */
static bool
deserves_more(struct run *run)
{
    struct yielding *y = &run->yielding;
    const struct rc_plastic_figures *f = rc_plastic_result(y->plastic);
    const size_t most = goal(run) < deserved ? MOST : MOST_AUTO;
    const double aim = goal(run) * (run->step + 1 < run->steps->n ? for_later : 1);
    const double own = f->increment_error, here = f->error - f->image_error;
    double more = ceil((double)y->increments * pow(2 * own / goal(run), order));

    if (y->asked > 0 || y->try + 1 == TRIES || y->increments >= most ||
        own <= goal(run) / (f->image_error > goal(run) ? 2 : 4) ||
        (here <= aim && !(f->error > goal(run) && own > goal(run) / 2)))
        return false;
    y->increments = more < (double)y->increments + 1 ? y->increments + 1
                    : more < (double)most            ? (size_t)more
                                                     : most;
    y->try++;
    return true;
}

/* The load that is set, again from where it began where its increments are found to be too few. */
static void
go_on(struct run *run, const struct rc_grid *g, double load, bool kept)
{
    struct yielding *y = &run->yielding;
    struct rc_err err;

    go(run, g, load, kept);
    while (tool_interrupted() == 0 && deserves_more(run)) {
        if (rc_plastic_restore(y->plastic, y->before, y->before_size, &err) != RC_OK)
            tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
        set_load(run, g, load);
        go(run, g, load, false);
    }
}

void
yield_press(struct run *run, const struct rc_grid *g, double load)
{
    struct rc_grid *state = checkpoint_state(run->checkpoint, g);

    begin(run, g);
    run->resumed = state != NULL;
    if (run->resumed)
        restore(run, g, state);
    else
        set_load(run, g, load);
    go_on(run, g, load, run->resumed);
}

/* Solves the elastic contact at the largest load of the list, which goes deepest. False: a signal has come,
 * and the contact is that of the load before. */
static bool
go_to_largest(struct run *run, const struct rc_grid *g, struct rc_solver *solver, double load)
{
    double most = 0, unit = load / run->steps->v[run->step];
    struct rc_err err;

    for (size_t k = run->step; k < run->steps->n; k++)
        most = fmax(most, run->steps->v[k]);
    if (most <= run->steps->v[run->step])
        return true;
    if (rc_solver_set_load(solver, most * unit, 0, &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    while (tool_interrupted() == 0 && rc_solver_step(solver) == RC_MORE)
        solve_progress(run, solver);
    if (tool_interrupted() == 0)
        return true;
    if (rc_solver_set_load(solver, load, 0, &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    return false;
}

bool
yield_begins(struct run *run, const struct rc_grid *g, struct rc_solver *solver,
             struct rc_problem contact)
{
    struct yielding *y = &run->yielding;

    y->most = 0;
    if (!y->wanted || tool_interrupted() != 0 || !find_slabs(run, g, rc_solver_pressure(solver)) ||
        !go_to_largest(run, g, solver, contact.load))
        return false;
    (void)find_slabs(run, g, rc_solver_pressure(solver));
    y->increments = y->asked > 0 ? y->asked : FIRST;
    make(run, g, contact);
    begin(run, g);
    set_load(run, g, contact.load);
    go_on(run, g, contact.load, false);
    return true;
}

bool
yield_resumes(struct run *run, const struct rc_grid *g, struct rc_problem contact)
{
    struct rc_grid *state = run->yielding.wanted ? checkpoint_state(run->checkpoint, g) : NULL;

    if (state == NULL)
        return false;
    run->resumed = true;
    read_head(run, g, state);
    make(run, g, contact);
    begin(run, g);
    restore(run, g, state);
    go_on(run, g, contact.load, true);
    return true;
}

/* ---- what is found ---- */

/* Broken off before it was known whether body 1 yields under the load. */
static bool
is_unknown(const struct run *run)
{
    const struct yielding *y = &run->yielding;

    return y->wanted && y->plastic == NULL && tool_interrupted() != 0 &&
           !(y->most > 0 && y->most <= 1);
}

void
yield_look(struct run *run, struct solution *s)
{
    struct yielding *y = &run->yielding;
    const struct rc_plastic_figures *f;
    struct rc_contact *c = &s->contact;

    if (is_unknown(run)) { /* the error of the elastic contact says nothing */
        c->pressure_error = NAN;
        c->converged = false;
    }
    if (y->plastic == NULL)
        return;
    f = rc_plastic_result(y->plastic);
    c->convolutions = NAN; /* nearly all of the work is in the volume */
    s->errors = (struct error_parts){
        true,          f->increment_error, f->inherited_error, f->iteration_error, f->contact_error,
        f->image_error};
    if (y->status == RC_MORE) /* broken off */
        s->errors.increment = NAN;
    c->pressure_error = errors_sum(&s->errors);
    c->converged = y->status == RC_OK && c->converged &&
                   (errors_within(c->pressure_error, goal(run)) ||
                    (y->asked > 0 && isnan(c->pressure_error))); /* so few were asked for */
    if (f->increment_error > y->worst_error) {
        y->worst_error = f->increment_error;
        y->worst = run->number;
        y->worst_increments = f->increments;
    }
}

double
yield_peak(const struct run *run, double max_pressure, const char **name)
{
    const double soft =
        10; /* hardening below so many times the yield stress lets nodes alternate */
    const struct yielding *y = &run->yielding;
    const bool alternates =
        y->plastic != NULL && yield_law_hardening(&y->law) < soft * yield_law_first(&y->law);

    if (name != NULL)
        *name = alternates ? "largest pressure over 2 x 2 nodes" : "largest pressure";
    return alternates ? rc_plastic_result(y->plastic)->max_pressure_mean4 : max_pressure;
}

void
yield_displace(const struct run *run, size_t n, double factor, double *v)
{
    const double *u;

    if (run->yielding.plastic == NULL)
        return;
    u = rc_plastic_residual(run->yielding.plastic);
    for (size_t k = 0; k < n; k++)
        v[k] += factor * u[k];
}

/* ---- strain ---- */

static void
put_slab(struct run *run, struct rc_grid *frame, size_t slab, double depth, double *buffer)
{
    static const char *const names[RC_PLASTIC_STRAINS] = {"exx", "eyy", "exy",
                                                          "exz", "eyz", "peeq"};
    const struct yielding *y = &run->yielding;
    struct rc_err err;

    if (rc_grid_set_number(frame, "depth", depth, &err) != RC_OK ||
        rc_grid_set_number(frame, "thickness", y->thickness[slab], &err) != RC_OK)
        tool_die_at(&run->t, frame, EXIT_IMPOSSIBLE, "%s", err.text);
    for (size_t c = 0; c < RC_PLASTIC_STRAINS; c++) {
        double *to[RC_PLASTIC_STRAINS] = {NULL};
        struct rc_grid as = *frame; /* as the reader of the stream sees it */
        to[c] = buffer;
        rc_plastic_strain(y->plastic, slab, to);
        as.channel = (char *)names[c]; /* these are only read */
        as.unit = (char *)"1";
        as.v = buffer;
        tool_write(&run->t, &as);
    }
}

void
yield_put_strain(struct run *run, const struct rc_grid *like, double *buffer)
{
    const struct yielding *y = &run->yielding;
    struct rc_grid *frame;
    struct rc_err err;
    double z = 0;

    if (y->plastic == NULL)
        return;
    frame = rc_grid_like(like, like->channel, like->unit, &err);
    if (frame == NULL)
        tool_die_at(&run->t, like, EXIT_IMPOSSIBLE, "%s", err.text);
    for (size_t k = 0; k < y->slabs; k++) {
        put_slab(run, frame, k, z + y->thickness[k] / 2, buffer);
        z += y->thickness[k];
    }
    rc_grid_free(frame);
}

static void
warn_of_slabs(struct run *run, const char *where, const struct rc_plastic_figures *f)
{
    const struct yielding *y = &run->yielding;
    double bottom = 0, above = 0;
    size_t within = 0;

    for (size_t k = 0; k < y->slabs; k++) {
        above = bottom;
        bottom += y->thickness[k];
        within += above < f->depth;
    }
    if (f->depth > above)
        solve_warn(run, "the lowest slab yields",
                   "%s: the lowest slab yields: the stack is too shallow: give more --slabs",
                   where);
    if (within > 0 && within < 4)
        solve_warn(
            run, "few slabs in the depth that yields",
            "%s: %zu %s in the depth that yields: its stresses are coarse: take a finer grid, or "
            "thinner --slabs",
            where, within, within == 1 ? "slab lies" : "slabs lie");
}

/* The part of the error that is largest, and what lowers it, by how much that was missed. */
static void
warn_of_part(struct run *run, const char *where, const struct solution *s)
{
    const struct yielding *y = &run->yielding;
    const struct rc_plastic_figures *f = rc_plastic_result(y->plastic);
    const struct error_parts *e = &s->errors;
    const double asked = goal(run), off = s->contact.pressure_error / asked;
    const char limit = errors_limited_by(e)[0]; /* of increments, history, tolerance, map */
    const size_t made = limit == 'h' ? y->worst_increments : f->increments;
    const double more = ceil((double)made * pow(off, order));
    char what[256], first[96];

    snprintf(first, sizeof first, "its estimated error is %.2g %%, above %.2g %%",
             100 * s->contact.pressure_error, 100 * asked);
    if (limit == 'i')
        snprintf(what, sizeof what, "its increments leave %.2g %%: give --increments %.0f",
                 100 * e->increment, more);
    else if (limit == 'h')
        snprintf(what, sizeof what,
                 "%.2g %% come from case %zu, which was reached in %zu increments: give "
                 "--increments %.0f",
                 100 * e->inherited, y->worst, made, more);
    else if (limit == 'm')
        snprintf(what, sizeof what,
                 "%.2g %% come from the edge of the map: more increments do not help: give a map "
                 "%.1f times as large with the same contact, or --periodic where it is a period",
                 100 * e->image, ceil(10 * pow(off, image_order)) / 10);
    else
        snprintf(what, sizeof what,
                 "%.2g %% come from the tolerance of contacts and iteration: give --tol %.0e",
                 100 * (e->iteration + e->contact), asked / 10);
    solve_warn(run, "errors above what was asked for", "%s: %s: %s", where, first, what);
}

bool
yield_warn_of_end(struct run *run, const char *where, const struct solution *s)
{
    const struct yielding *y = &run->yielding;
    size_t increment, application;
    double load;

    if (is_unknown(run)) {
        tool_warn(&run->t,
                  "%s: interrupted before it is known whether body 1 yields: what is written is an "
                  "elastic solution: its error is not known",
                  where);
        return true;
    }
    if (y->plastic == NULL)
        return false;
    rc_plastic_progress(y->plastic, &load, &increment, &application);
    if (y->status == RC_MORE)
        tool_warn(&run->t,
                  "%s: interrupted in increment %zu of %zu: what is written is on the way there, "
                  "not a solution: its error is not known",
                  where, increment, y->increments);
    else if (isnan(s->contact.pressure_error))
        solve_warn(run, "an error that is not known",
                   "%s: nothing is known of its error: a load was reached in fewer than 8 "
                   "increments: give more --increments",
                   where);
    else if (!s->contact.converged && y->status == RC_OK && s->contact.pressure_error > goal(run))
        warn_of_part(run, where, s);
    else
        return false;
    return true;
}

void
yield_judge(struct run *run, const char *where, const struct solution *s)
{
    enum {
        SPOT = 113 /* nodes: 6 in the radius */
    };
    const struct rc_plastic_figures *f;

    if (run->yielding.plastic == NULL)
        return;
    f = rc_plastic_result(run->yielding.plastic);
    warn_of_slabs(run, where, f);
    if (f->max_strain > large_strain)
        solve_warn(run, "plastic strain beyond the theory of small strains",
                   "%s: plastic strain up to %.2g: beyond 0.1 the theory of small strains is left",
                   where, f->max_strain);
    if (s->patches.count > 0 && s->contact.contact_nodes < SPOT * s->patches.count)
        solve_warn(
            run, "what yields under a contact spot is not resolved",
            "%s: %.0f nodes in a contact spot: with less than 6 in its radius what yields under "
            "it is not resolved",
            where, (double)s->contact.contact_nodes / (double)s->patches.count);
}

void
yield_tell(const struct run *run, const struct rc_contact *c, char *text, size_t size)
{
    const struct rc_plastic_figures *f;

    if (run->yielding.plastic == NULL) {
        snprintf(text, size, "%zu iterations, %.3g convolutions", c->iterations, c->convolutions);
        return;
    }
    f = rc_plastic_result(run->yielding.plastic);
    snprintf(text, size, "%zu increments, %zu applications", f->increments, f->applications);
}

const char *
yield_state(const struct run *run)
{
    static char text[128];
    const struct yielding *y = &run->yielding;
    char depth[SHOWN_NUMBER];

    if (!y->wanted)
        return "left out: no --yield";
    if (y->plastic != NULL)
        return "on";
    if (y->most == 0)
        return "on where the elastic stress exceeds it; costs nothing elsewhere";
    snprintf(text, sizeof text,
             "left out: the largest Mises stress is %.3g of the yield stress, %s deep", y->most,
             shown_in_unit(depth, y->deepest, "m"));
    return text;
}

void
yield_report(struct report *r, const struct run *run)
{
    const struct yielding *y = &run->yielding;
    const bool on = y->plastic != NULL;
    const struct rc_plastic_figures none = {0}, *f = on ? rc_plastic_result(y->plastic) : &none;
    double stress = yield_law_first(&y->law);

    report_number(r, "yield", y->wanted ? stress : NAN, "Pa");
    report_number(r, "hardening", y->wanted && y->law.points == 0 ? y->law.modulus : NAN, "Pa");
    report_number(r, "increments", on ? (double)f->increments : NAN, NULL);
    report_number(r, "applications", on ? (double)f->applications : NAN, NULL);
    report_number(r, "slabs", on ? (double)y->slabs : NAN, NULL);
    report_number(r, "plastic_depth", on ? f->depth : NAN, "m");
    report_number(r, "plastic_volume", on ? f->volume : NAN, "m3");
    report_number(r, "max_plastic_strain", on ? f->max_strain : NAN, NULL);
    report_number(r, "plastic_work", on ? f->work : NAN, "J");
    report_number(r, "max_pressure_mean4", on ? f->max_pressure_mean4 : NAN, "Pa");
    report_number(r, "max_mises_over_yield", y->wanted && !on ? y->most : NAN, NULL);
    report_number(r, "max_mises_depth", y->wanted && !on ? y->deepest : NAN, "m");
}
