/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A case of rc-solve: solves its loads one after another, finds their figures and writes their frames. */
#include "solve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

/* ---- one case ---- */

struct rc_problem
solve_problem(struct run *run, size_t step)
{
    struct rc_problem problem = physics_problem(run->physics, run->g, step);

    problem.tol = run->args->tol;
    problem.engine = run->args->kernel;
    problem.method = run->args->method;
    problem.threads = run->d.t.threads;
    problem.ranks = ranks_of(&run->d.t);
    problem.hurry = tool_signal();
    problem.height_error = run->height_error;
    SOLVE_EACH (run, e, problem)
        e->problem(run, &problem);
    return problem;
}

/* Marks of a checkpoint beside the options, maps and keys. */
static void
mark(struct drive *d)
{
    struct run *run = (struct run *)(void *)d;

    SOLVE_EACH (run, e, mark)
        e->mark(run);
}

/* ---- results ---- */

static void
set_keys(struct drive *d, const struct rc_model *m, struct rc_grid *g)
{
    struct run *run = (struct run *)(void *)d;
    const struct rc_contact *c = &run->solution.contact;

    (void)m;
    map_set_boundary(&d->t, g, run->physics->boundary);
    tool_set(&d->t, g, "converged", c->converged ? "yes" : "no");
    tool_set_error(&d->t, g, "pressure.error", c->pressure_error);
    bodies_set(&d->t, g, &run->physics->pair, run->physics->residual);
    tool_sign(&d->t, g);
    if (d->points > 1)
        tool_set_number(&d->t, g, "case", (double)run->d.course.number);
    /* the requested and the reached load differ by rounding only */
    tool_set_number(&d->t, g, "load",
                    run->physics->load.n > 0 ? solve_problem(run, run->step).load : c->load);
    for (size_t k = 0; solve_effects[k] != NULL; k++)
        for (const char *const *key = solve_effects[k]->foreign; key != NULL && *key != NULL; key++)
            tool_set(&d->t, g, *key, NULL);
    SOLVE_EACH (run, e, keys)
        e->keys(run, g);
}

static void
set_height_error(struct run *run, struct rc_grid *g)
{
    const struct rc_contact *c = &run->solution.contact;

    if (c->yielded_nodes > 0 && isfinite(c->shape_error))
        tool_set_number(&run->d.t, g, HEIGHT_ERROR, c->shape_error);
}

/* Values that are not those of a frame of the model. The frames from `plastic` on have the error of the
 * shape. */
static const double *
own_values(struct drive *d, struct rc_model *m, struct rc_grid *as, const char *word)
{
    struct run *run = (struct run *)(void *)d;
    const bool plastic = strcmp(word, solve_frames[SOLVE_PLASTIC]) == 0;
    const double *v = NULL;

    if (plastic)
        set_height_error(run, as);
    SOLVE_EACH (run, e, frame)
        if (v == NULL)
            v = e->frame(run, m, as, word);
    return v == NULL && plastic && run->apart ? run->g->v : v; /* the shape has not changed */
}

/* ---- loads ---- */

/* In a history, gives the heights the shape after the load. */
static void
keep_shape(struct drive *d, struct rc_model *m)
{
    struct run *run = (struct run *)(void *)d;
    struct solution *s = &run->solution;
    struct rc_grid *g = run->g;
    char where[512];

    if (!run->physics->history)
        return;
    if (s->contact.yielded_nodes > 0 && !solve_moves(run)) {
        tool_must(&d->t, g, rc_model_frame(m, "plastic", g->v, &d->t.err));
        g->type = RC_F64;
        set_height_error(run, g);
    }
    drive_keep(d, m);
    s->indentation = rc_model_number(m, "indentation");
    s->residual_indentation = rc_model_number(m, "residual_indentation");
    if (fabs(s->indentation - s->contact.approach) > 1e-6 * fabs(s->contact.approach))
        tool_note(&d->t,
                  "%s: indentation %s from the first touch of the initial shape; the approach "
                  "counts from that of the dented one",
                  solve_where(run, g, where, sizeof where), shown_in_unit(s->indentation, "m"));
}

/* Finds the contact inside the taper of a tapered map (key `taper`); touch is NULL for separated bodies. */
static void
look_inside(struct run *run, const struct rc_grid *g, const double *touch, struct solution *s)
{
    size_t columns, rows, first = tool_first_row(&run->d.t, g);
    double width, touching = 0, inside;

    s->inside_area = s->inside_fraction = NAN;
    if (!rc_grid_number(g, "taper", &width))
        return;
    rc_taper_frame(rc_shape_of(g), width, &columns, &rows);
    for (size_t k = 0; touch != NULL && k < rc_grid_nodes(g); k++) {
        size_t i = k % g->nx, j = first + k / g->nx;
        if (i >= columns && i + columns < g->nx && j >= rows && j + rows < g->ny &&
            rc_in_contact(touch[k]))
            touching++;
    }
    touching = ranks_sum(&run->d.t, touching);
    inside = (double)(g->nx - 2 * columns) * (double)(g->ny - 2 * rows);
    s->inside_area = touching * g->dx * g->dy;
    s->inside_fraction = inside > 0 ? touching / inside : NAN;
}

/* The centre of the touching nodes along one axis of n nodes, in nodes: the angle of the sum of
 * exp(2 pi i k/n), which holds also for a patch across the seam of a periodic map. w: touching nodes at each
 * k, on this process. Adds the second moment about the centre, in nodes^2 a node, to *moment. */
static void
add_moment(struct tool *t, size_t n, double d, const double *w, double *moment)
{
    const double turn = 2 * acos(-1) / (double)n;
    double sine = 0, cosine = 0, touching = 0, square = 0, centre;

    for (size_t k = 0; k < n; k++) {
        sine += w[k] * sin(turn * (double)k);
        cosine += w[k] * cos(turn * (double)k);
        touching += w[k];
    }
    centre = atan2(ranks_sum(t, sine), ranks_sum(t, cosine)) / turn;
    for (size_t k = 0; k < n; k++)
        square += w[k] * pow(remainder((double)k - centre, (double)n), 2);
    /* a node is a cell of width 1, whose own moment is 1/12 */
    *moment += (ranks_sum(t, square) / ranks_sum(t, touching) + 1.0 / 12) * d * d;
}

/* The radius of a contact that is one round patch: sqrt(A/pi) of its corrected area A. No other shape of the
 * same area has a polar moment as small as that of a disc, A^2/(2 pi); the moment of a round patch exceeds it
 * by at most 5 %, as that of an ellipse with axes of ratio 1.37 or of a square does. Otherwise NAN. */
static double
contact_radius(struct tool *t, const struct rc_grid *g, const double *touch,
               const struct rc_patches *patches)
{
    const double round = 1.05, pi = acos(-1);
    const size_t first = tool_first_row(t, g);
    RC_OWNED double *columns = NULL, *rows = NULL;
    double moment = 0;

    if (patches->count != 1 || g->nx == 1 || g->ny == 1)
        return NAN;
    columns = tool_room(t, g->nx, sizeof *columns, "a row of a map");
    rows = tool_room(t, g->ny, sizeof *rows, "a column of a map");
    memset(columns, 0, g->nx * sizeof *columns);
    memset(rows, 0, g->ny * sizeof *rows);
    for (size_t k = 0; k < rc_grid_nodes(g); k++)
        if (rc_in_contact(touch[k])) {
            columns[k % g->nx]++;
            rows[first + k / g->nx]++;
        }
    add_moment(t, g->nx, g->dx, columns, &moment);
    add_moment(t, g->ny, g->dy, rows, &moment);
    return moment * 2 * pi <= round * patches->contact_area
               ? sqrt(patches->contact_area_corrected / pi)
               : NAN;
}

static void
look_at_contact(struct run *run, const struct rc_grid *g, const double *touch, struct solution *s)
{
    struct rc_shape shape = rc_grid_shape(g);
    struct rc_patch_options options = {.boundary = run->physics->boundary,
                                       .largest = report_wanted(&run->d.report) ? SOLVE_LARGEST : 0,
                                       .threads = run->d.t.threads,
                                       .ranks = ranks_of(&run->d.t)};

    tool_must(&run->d.t, g, rc_patches_find(&shape, touch, &options, &s->patches, &run->d.t.err));
    s->contact_radius = contact_radius(&run->d.t, g, touch, &s->patches);
    s->slope = rc_measure_contact_slope(ranks_of(&run->d.t), &shape, g->v, touch);
    look_inside(run, g, touch, s);
}

/* Finds the touching nodes from the gap, because the net pressure of an adhesive contact does not determine
 * them. */
static void
look_at_closed_gap(struct run *run, const struct rc_grid *g, struct rc_model *m, struct solution *s)
{
    RC_OWNED double *touch = tool_room(&run->d.t, rc_grid_nodes(g), sizeof *touch, "a map");

    tool_must(&run->d.t, g, rc_model_frame(m, CONTACT_CHANNEL, touch, &run->d.t.err));
    look_at_contact(run, g, touch, s);
}

/* Finds the touching nodes. */
static void
look_at_nodes(struct run *run, struct rc_model *m, struct solution *s)
{
    if (run->apart)
        look_inside(run, run->g, NULL, s);
    else if (SOLVE_FIRST(run, by_gap) != NULL)
        look_at_closed_gap(run, run->g, m, s);
    else if (run->solver != NULL && tool_interrupted() == 0) /* else it may have no pressure yet */
        look_at_contact(run, run->g, rc_solver_pressure(run->solver), s);
}

/* Finds further figures, and parts of the error. */
static void
find_more(struct run *run, struct solution *s)
{
    if (run->solver != NULL && !run->apart) {
        if (tool_interrupted() == 0)
            SOLVE_EACH (run, e, find)
                e->find(run, run->solver, s);
        s->contact.convolutions = rc_solver_convolutions(run->solver);
    }
    if (s->contact.inherited_error > 0)
        s->errors =
            (struct error_parts){.told = true,
                                 .inherited = s->contact.inherited_error,
                                 .contact = s->contact.pressure_error - s->contact.inherited_error};
    s->peak = s->contact.max_pressure;
    SOLVE_EACH (run, e, errors)
        e->errors(run, s);
}

/* Finds the figures of this load, and warns. */
static void
judge_load(struct drive *d, struct rc_model *m)
{
    struct run *run = (struct run *)(void *)d;
    struct solution *s = &run->solution;
    const struct rc_elastic_figures *elastic = rc_elastic_result(m);
    const double start = tool_now();

    rc_patches_free(&s->patches);
    *s = (struct solution){.peak_name = "largest pressure",
                           .increments = NAN,
                           .slope = NAN,
                           .stiffness = NAN,
                           .contact_radius = NAN,
                           .conductance = {NAN, NAN, NAN},
                           .indentation = NAN,
                           .residual_indentation = NAN,
                           .inside_area = NAN,
                           .inside_fraction = NAN};
    run->solver = rc_model_solver(m);
    if (elastic != NULL)
        s->contact = elastic->contact;
    if (elastic != NULL && !solve_moves(run))
        s->indentation = rc_model_number(m, "indentation");
    SOLVE_EACH (run, e, look)
        if (!e->look(run, m, s))
            return;
    look_at_nodes(run, m, s);
    find_more(run, s);
    run->done = tool_now();
    run->result = run->apart ? 0 : run->done - start;
    solve_judge(run, s);
    if (!s->contact.converged && !run->apart)
        tool_fails_with(&d->t, EXIT_SHORT);
    /* the frames are found in the input map if it is no longer needed */
    d->is.spare =
        !solve_wanted(run->args, SOLVE_HEIGHT) && !run->physics->history && d->at + 1 == d->points;
}

/* Before a load. The first one plans the solver. */
static void
begin_load(struct drive *d, struct rc_model *m)
{
    struct run *run = (struct run *)(void *)d;
    struct rc_problem problem;

    run->step = d->at < run->steps->n ? d->at : run->steps->n - 1;
    run->apart = run->steps->v[run->step] == 0 && !run->physics->pulls;
    problem = solve_problem(run, run->step);
    if (run->apart)
        d->course.checkpoint = NULL;
    SOLVE_EACH (run, e, begin)
        e->begin(run, m, &problem);
    if (SOLVE_FIRST(run, at_once) != NULL ? d->at > 0 : run->apart || rc_model_solver(m) != NULL)
        return;
    solve_demand_memory(run, &problem);
    if (run->done == 0)         /* no load has been solved */
        tool_release_signals(); /* making the plan takes long, and before its end there is no
                                   pressure to write */
}

/* The loads of a list, each from the solution of the last one; in a history, on the shape after the last one.
 * Effects have further axes, and points. */
static void
make_points(struct run *run)
{
    struct drive *d = &run->d;
    struct numbers load = {.n = run->steps->n};
    struct drive_axis axes[RC_AXES + 1] = {
        {run->physics->approach.n > 0 ? RC_APPROACH : RC_LOAD, &load}};
    size_t n = 1;

    load.v = tool_room(&d->t, load.n, sizeof *load.v, "the loads");
    for (size_t k = 0; k < load.n; k++) {
        const struct rc_problem problem = physics_problem(run->physics, run->g, k);
        load.v[k] = run->physics->approach.n > 0 ? problem.approach : problem.load;
    }
    SOLVE_EACH (run, e, list)
        axes[n++] = (struct drive_axis){e->axis, e->list};
    drive_make_points(d, axes);
    free(load.v);
    run->cases = d->points;
    SOLVE_EACH (run, e, points)
        e->points(run);
}

static struct rc_model *
elastic_model(struct run *run, const struct rc_problem *problem)
{
    return tool_made(&run->d.t, run->g,
                     rc_elastic_new(rc_shape_of(run->g), run->g->v, problem, NULL, &run->d.t.err));
}

/* The model of the case. With --dry-run only those that are needed for the forecast; NULL: none is. */
static struct rc_model *
make_model(struct run *run, const struct rc_problem *problem)
{
    const bool all = !run->args->drive.dry_run;
    struct rc_model *m = NULL;

    SOLVE_EACH (run, e, base)
        if (m == NULL && (all || e->expect != NULL))
            m = e->base(run, problem);
    SOLVE_EACH (run, e, outer)
        if (all || e->expect != NULL)
            m = e->outer(run, m != NULL ? m : elastic_model(run, problem));
    return m != NULL || !all ? m : elastic_model(run, problem);
}

static void
do_loads(struct run *run)
{
    const struct rc_problem problem = solve_problem(run, 0);
    struct drive *d = &run->d;

    run->model = make_model(run, &problem);
    d->calls.mark = mark;
    d->calls.begin = begin_load;
    d->calls.judge = judge_load;
    d->calls.all_keys = set_keys;
    d->calls.frame = own_values;
    d->calls.keep = keep_shape;
    d->calls.row = solve_report;
    d->independent = !run->physics->history && SOLVE_FIRST(run, follows) == NULL;
    if (d->points == 1)
        d->course.number = rc_grid_case(run->g) - 1;
    drive_points(d, run->g, run->model);
    rc_patches_free(&run->solution.patches);
}

static void
plan_loads(struct run *run)
{
    struct rc_problem problem;

    run->step = 0; /* a load of 0 costs nothing */
    while (!run->physics->pulls && run->step + 1 < run->steps->n && run->steps->v[run->step] == 0)
        run->step++;
    problem = solve_problem(run, run->step);
    run->model = make_model(run, &problem);
    solve_plan(run, &problem);
    rc_model_free(run->model);
}

void
solve_case(struct run *run)
{
    struct rc_grid *g = run->g;

    SOLVE_EACH (run, e, take)
        e->take(run);
    run->rms_slope = report_wanted(&run->d.report)
                         ? rc_measure_contact_slope(ranks_of(&run->d.t), rc_shape_of(g), g->v, NULL)
                         : NAN;
    physics_heights(&run->d.t, run->physics, g);
    if (!rc_grid_number(g, HEIGHT_ERROR, &run->height_error))
        run->height_error = 0;
    SOLVE_EACH (run, e, open)
        e->open(run);
    make_points(run);
    (run->args->drive.dry_run ? plan_loads : do_loads)(run);
    free(run->d.point);
    run->d.point = NULL;
    run->d.points = 0;
    SOLVE_EACH (run, e, close)
        e->close(run);
}
