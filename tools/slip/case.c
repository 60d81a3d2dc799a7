/* A case of rc-slip: its corners one after another, and the frames of each. */
#include "slip.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *name, *unit;
} frames[SLIP_FRAMES] = {
    [SLIP_PRESSURE] = {"pressure", "Pa"},     [SLIP_TRACTION_X] = {"traction-x", "Pa"},
    [SLIP_TRACTION_Y] = {"traction-y", "Pa"}, [SLIP_SLIP_X] = {"slip-x", "m"},
    [SLIP_SLIP_Y] = {"slip-y", "m"},          [SLIP_STATE] = {"state", "1"},
};

const char *
slip_frame_word(size_t k)
{
    return k < SLIP_FRAMES ? frames[k].name : NULL;
}

/* ---- what stands in the stream ---- */

static void
check_beside(struct slip_run *run, struct rc_grid *g)
{
    if (g == NULL)
        return;
    tool_demand_grid_of(&run->t, g, run->p);
    tool_demand_finite(&run->t, g, "solve the contact again");
}

static void
check_pressure(struct slip_run *run)
{
    size_t n = rc_grid_nodes(run->p), pulled = 0, without = 0;
    const struct rc_grid *touch;

    tool_demand_finite(&run->t, run->p, "recompute the map");
    for (size_t k = 0; k < n; k++)
        pulled += run->p->v[k] < 0;
    if (pulled > 0 || rc_grid_get(run->p, "adhesion") != NULL)
        tool_die_at(
            &run->t, run->p, EXIT_IMPOSSIBLE,
            "it is the net pressure of bodies that attract each other, negative at %zu of %zu "
            "nodes: the normal force that friction follows in such a contact is not in the stream: "
            "take pressures of rc-solve without --adhesion",
            pulled, n);
    touch = contact_frame(&run->t, run->p, run->contact);
    for (size_t k = 0; k < n; k++)
        without += rc_in_contact(run->p->v[k]) && !rc_in_contact(touch->v[k]);
    if (without > 0)
        tool_die_at(
            &run->t, run->contact, EXIT_IMPOSSIBLE,
            "%zu nodes that carry pressure are not in contact by this frame: friction needs "
            "both to agree, solve the contact again",
            without);
    run->load = rc_sum(run->p->v, n) * run->p->dx * run->p->dy;
}

/* A pressure found on one boundary has no friction on the other. */
static void
find_boundary(struct slip_run *run)
{
    const char *own = rc_grid_get(run->p, "boundary");
    bool periodic = own == NULL ? run->args->periodic : strcmp(own, "periodic") == 0;

    if (own != NULL && strcmp(own, "free") != 0 && !periodic)
        tool_die_at(&run->t, run->p, EXIT_IMPOSSIBLE,
                    "its boundary is '%s': it must be free or periodic", own);
    if (run->args->periodic && !periodic)
        tool_die_at(&run->t, run->p, EXIT_IMPOSSIBLE,
                    "its boundary is %s: --periodic contradicts it", own);
    run->boundary = periodic ? RC_PERIODIC : RC_FREE;
}

/* Where contacts are to be solved, of elastic bodies with known heights. */
static void
check_solvable(struct slip_run *run)
{
    static const char *const more[] = {"hardness", "yield", "adhesion"};

    if (!run->solves)
        return;
    if (run->height == NULL && run->alternates)
        tool_die_at(
            &run->t, run->p, EXIT_IMPOSSIBLE,
            "its bodies are dissimilar (beta %.3g), so that it feels tractions and is found "
            "anew, and there must be a height beside it: take all that rc-solve writes, or "
            "--coupling goodman or none",
            run->bodies.beta);
    if (run->height == NULL)
        tool_die_at(&run->t, run->p, EXIT_IMPOSSIBLE,
                    "contacts under other loads than its own, %g N, are to be solved, and there "
                    "must be a height beside it: take all that rc-solve writes",
                    run->load);
    for (size_t k = 0; k < sizeof more / sizeof *more; k++)
        if (rc_grid_get(run->p, more[k]) != NULL)
            tool_die_at(&run->t, run->p, EXIT_IMPOSSIBLE,
                        "contacts are to be solved on the way, which is done for elastic bodies "
                        "only, and its key %s says that these are none: move them under its own "
                        "load alone%s",
                        more[k], run->alternates ? ", with --coupling goodman" : "");
}

/* ---- frames ---- */

static void
set_number(struct slip_run *run, struct rc_grid *g, const char *name, double value)
{
    struct rc_err err;

    if ((isfinite(value) ? rc_grid_set_number(g, name, value, &err)
                         : rc_grid_set(g, name, NULL, &err)) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
}

static void
set_keys(struct slip_run *run, struct rc_grid *g, const struct slip_state *s)
{
    const struct rc_slip_figures *f = &s->figures.slip;
    const char *own = rc_grid_get(g, "converged");
    bool converged = s->converged && (own == NULL || strcmp(own, "no") != 0);
    bool apart = f->stick_nodes + f->slip_nodes == 0;
    struct rc_err err;

    if (rc_grid_set(g, "converged", converged ? "yes" : "no", &err) != RC_OK ||
        rc_grid_set(g, "boundary", run->boundary == RC_PERIODIC ? "periodic" : "free", &err) !=
            RC_OK ||
        (tool_given(&run->t, "E1") && bodies_set(g, &run->bodies.pair, NULL, &err) != RC_OK) ||
        rc_grid_history(g, tool_history(&run->t), &err) != RC_OK)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    if (run->bodies.pair.estar > 0)
        set_number(run, g, "nu", run->bodies.nu);
    if (run->number != rc_grid_case(run->p))
        set_number(run, g, "case", (double)run->number);
    set_number(run, g, "load", f->load);
    set_number(run, g, "approach", s->approach);
    set_number(run, g, "friction", run->args->mu);
    set_number(run, g, "tau_max", run->args->tau_max);
    set_number(run, g, "tangential_x", f->force[0]);
    set_number(run, g, "tangential_y", f->force[1]);
    set_number(run, g, "displacement_x", apart ? NAN : f->displacement[0]);
    set_number(run, g, "displacement_y", apart ? NAN : f->displacement[1]);
}

/* Maps are made one after another, in one buffer, as they are written. */
static void
write_frames(struct slip_run *run, struct rc_joint *joint, const struct slip_state *s)
{
    struct rc_slip *slip = rc_joint_slip(joint);
    const double *p = rc_joint_pressure(joint);
    struct rc_err err;
    struct rc_grid *g = rc_grid_like(run->p, "pressure", "Pa", &err);

    if (g == NULL)
        tool_die_at(&run->t, run->p, EXIT_IMPOSSIBLE, "%s", err.text);
    set_keys(run, g, s);
    for (int k = 0; k < SLIP_FRAMES; k++) {
        struct rc_grid frame = *g; /* as the reader of the stream sees it */

        if (!(run->args->output >> k & 1))
            continue;
        frame.channel = (char *)frames[k].name; /* these and the values are only read */
        frame.unit = (char *)frames[k].unit;
        if (k == SLIP_PRESSURE && p != NULL)
            frame.v = (double *)p;
        else if (k == SLIP_PRESSURE)
            memset(g->v, 0, rc_grid_nodes(g) * sizeof *g->v);
        else if (k == SLIP_TRACTION_X || k == SLIP_TRACTION_Y)
            frame.v = (double *)rc_slip_traction(slip, k - SLIP_TRACTION_X);
        else if (k == SLIP_STATE)
            rc_slip_state(slip, g->v);
        else
            rc_slip_slip(slip, k - SLIP_SLIP_X, g->v);
        tool_write(&run->t, &frame);
    }
    rc_grid_free(g);
}

/* ---- increments ---- */

/* Increment k of n to a corner; `near` has gone there, NULL: nobody has. */
static void
increment(struct slip_run *run, struct rc_joint *joint, struct rc_joint *near, size_t corner,
          size_t k, size_t n, struct slip_state *s)
{
    struct slip_corner c = slip_on_the_way(run, corner, k, n);
    enum rc_status status;
    struct rc_err err;
    bool there;

    if (near != NULL)
        rc_joint_start(joint,
                       (const double *[2]){rc_slip_traction(rc_joint_slip(near), 0),
                                           rc_slip_traction(rc_joint_slip(near), 1)},
                       rc_joint_pressure(near));
    there = slip_checkpoint_next(run->checkpoint, joint);
    status = c.moved ? rc_joint_set_displacement(joint, c.load, c.to[0], c.to[1], &err)
                     : rc_joint_set_force(joint, c.load, c.to[0], c.to[1], &err);
    if (status == RC_OK)
        status = RC_MORE;
    while (status == RC_MORE && tool_interrupted() == 0) {
        tool_progress(&run->t, (double)(k - 1) / (double)n,
                      "case %zu, %zu x %zu, increment %zu of %zu", run->number, run->p->nx,
                      run->p->ny, k, n);
        status = rc_joint_step(joint, &err);
    }
    tool_progress_end(&run->t);
    if (status == RC_FAIL &&
        k < n) /* what is asked for at the corner fails too, and is the user's number */
        increment(run, joint, near, corner, n, n, s);
    if (status == RC_FAIL)
        tool_die_at(&run->t, run->p, EXIT_IMPOSSIBLE, "%s", err.text);
    rc_joint_result(joint, &s->figures);
    if (!there || s->figures.passes > 1 || s->figures.slip.steps > 0)
        slip_checkpoint_save(run->checkpoint, joint);
    s->passes += s->figures.passes;
    s->dissipated += s->figures.slip.dissipated;
    s->converged = s->converged && s->figures.converged;
    rc_joint_keep(joint);
}

/* To a corner, in all increments and in fewer ones, each of which starts from what all have found there;
 * stops where the tool is interrupted. */
static void
go_to(struct slip_run *run, struct rc_joint *const joint[SLIP_JOINTS], size_t corner,
      struct slip_state *s)
{
    size_t n = run->corner[corner].increments;
    double before = 0, after = 0;
    struct slip_state fewer = {.converged = true};

    for (size_t j = 0; j < run->joints; j++) {
        rc_joint_result(joint[j], &fewer.figures);
        before += fewer.figures.convolutions;
    }
    s->dissipated = 0;
    s->passes = 0;
    s->converged = true;
    for (size_t k = 1; k <= n && tool_interrupted() == 0; k++) {
        increment(run, joint[0], NULL, corner, k, n, s);
        for (size_t j = 1; j < run->joints && tool_interrupted() == 0; j++) {
            size_t all = slip_fewer(n, j), done = k * all / n;
            if (done > (k - 1) * all / n)
                increment(run, joint[j], joint[0], corner, done, all, &fewer);
            if (j == 1)
                s->doubt = fewer.figures.traction_error + fewer.figures.inherited_error;
        }
    }
    s->converged = s->converged && fewer.converged && tool_interrupted() == 0;
    s->dissipated_total += s->dissipated;
    for (size_t j = 0; j < run->joints; j++) {
        rc_joint_result(joint[j], &fewer.figures);
        after += fewer.figures.convolutions;
    }
    s->convolutions += after - before;
}

/* Under the load of the stream it is that of the stream, unless it has been found anew. */
static double
approach_of(const struct slip_run *run, const struct slip_state *s)
{
    double own;

    if (isfinite(s->figures.approach) || s->corner->load != run->load ||
        !rc_grid_number(run->p, "approach", &own))
        return s->figures.approach;
    return own;
}

/* Sum over the map of |q_a - q_b|, Pa, b NULL: of |q_a|; less `lag`, which may be NULL. */
static double
distance(const struct slip_run *run, struct rc_joint *a, struct rc_joint *b, double *const lag[2])
{
    double sum = 0;

    for (size_t k = 0; k < rc_grid_nodes(run->p); k++) {
        double d[2];
        for (int c = 0; c < 2; c++)
            d[c] = rc_slip_traction(rc_joint_slip(a), c)[k] -
                   (b == NULL ? 0 : rc_slip_traction(rc_joint_slip(b), c)[k]) -
                   (lag == NULL ? 0 : lag[c][k]);
        sum += hypot(d[0], d[1]);
    }
    return sum;
}

/* What the increments leave, Pa, summed over the map; `before` at the corner before, which stays, also
 * where D and D2 fall because they cancel. Half of the increments are off by D more and a quarter by D2
 * more again, which tells how fast that falls. On a way of two increments D grows by what the way adds.
 * `doubt`: D's own, of the iteration. The factors are those of random paths. */
static double
increment_error(const struct slip_run *run, struct rc_joint *const joint[SLIP_JOINTS],
                const struct slip_corner *to, double before, double doubt)
{
    static const double factor[] = {[SLIP_MANY] = 1.5, [SLIP_SOME] = 3, [SLIP_FEW] = 6};
    static const double slowest = 0.85;
    double d, d2, rho, error;

    if (to->told == SLIP_EXACT)
        return 0;
    if (to->told == SLIP_UNKNOWN)
        return NAN;
    d = distance(run, joint[0], joint[1], NULL) + doubt;
    if (to->late)
        return fmin(fmax(factor[to->told] * d, before),
                    before +
                        factor[SLIP_SOME] * (distance(run, joint[0], joint[1], run->lag) + doubt));
    d2 = distance(run, joint[1], joint[2], NULL);
    rho = d < slowest * d2 ? d / d2 : slowest;
    error = fmax(factor[to->told] * d, d * rho / (1 - rho));
    return fmax(error, before);
}

/* Keeps how far half of the increments are off, for the way to the next corner. */
static void
keep_lag(struct slip_run *run, struct rc_joint *const joint[SLIP_JOINTS])
{
    for (size_t k = 0; k < rc_grid_nodes(run->p) && run->joints > 1; k++)
        for (int c = 0; c < 2; c++)
            run->lag[c][k] = rc_slip_traction(rc_joint_slip(joint[0]), c)[k] -
                             rc_slip_traction(rc_joint_slip(joint[1]), c)[k];
}

/* The parts of the error at a corner, and whether their sum is what was asked for. */
static void
find_errors(struct slip_run *run, struct rc_joint *const joint[SLIP_JOINTS], struct slip_state *s)
{
    const struct rc_joint_figures *f = &s->figures;
    double size = distance(run, joint[0], NULL, NULL);

    s->lagging = increment_error(run, joint, s->corner, s->lagging, s->doubt * size);
    keep_lag(run, joint);
    s->errors = (struct error_parts){.told = true,
                                     .increment = size > 0 ? s->lagging / size : 0,
                                     .inherited = f->inherited_error,
                                     .iteration = f->traction_error,
                                     .contact = f->contact_error};
    s->traction_error = errors_sum(&s->errors);
    s->converged = s->converged && (errors_within(s->traction_error, slip_goal(run)) ||
                                    (run->increments > 0 && isnan(s->traction_error)));
}

static struct rc_joint_problem
problem_of(const struct slip_run *run)
{
    static const double usual = 1e-4; /* of the iteration: errors of all increments add up */
    const struct slip_args *a = run->args;
    struct rc_joint_problem problem = {
        .contact = {.boundary = run->boundary,
                    .pair = run->bodies.pair,
                    .load = run->load,
                    .threads = run->t.threads},
        .slip = {.nu = run->bodies.nu,
                 .mu = a->mu,
                 .tau_max = isnan(a->tau_max) ? 0 : a->tau_max,
                 .tol = (isnan(a->tol) ? usual : a->tol) / (double)slip_all_increments(run)},
        .coupling = run->coupling,
    };

    for (size_t k = 0; k < run->corners && !(problem.contact.load > 0); k++)
        problem.contact.load = run->corner[k].load;
    return problem;
}

static struct rc_joint *
new_joint(struct slip_run *run, const struct rc_joint_problem *problem)
{
    struct rc_shape shape = rc_grid_shape(run->p);
    struct rc_err err;
    struct rc_joint *joint =
        rc_joint_new(&shape, run->solves ? run->height->v : NULL, problem, &err);

    if (joint == NULL)
        tool_die_at(&run->t, run->p, EXIT_IMPOSSIBLE, "%s", err.text);
    if (run->load > 0)
        rc_joint_know(joint, run->load, run->p->v, run->gap == NULL ? NULL : run->gap->v);
    return joint;
}

static void
follow(struct slip_run *run, const struct rc_joint_problem *problem)
{
    struct rc_joint *joint[SLIP_JOINTS] = {NULL};
    struct slip_state s = {.dissipated_total = 0};

    for (size_t j = 0; j < run->joints; j++) {
        struct rc_joint_problem its = *problem;
        if (j >
            0) /* it starts from the answer that it is compared with: what it leaves counts thrice */
            its.slip.tol /= 10;
        joint[j] = new_joint(run, &its);
    }
    for (int c = 0; c < 2 && run->joints > 1; c++)
        if ((run->lag[c] = calloc(rc_grid_nodes(run->p), sizeof(double))) == NULL)
            tool_die_at(&run->t, run->p, EXIT_IMPOSSIBLE, "out of memory for its tractions");
    for (size_t k = 0; k < run->corners && tool_interrupted() == 0; k++) {
        double began = tool_now();

        run->number += !run->corner[k].silent;
        s.corner = &run->corner[k];
        s.convolutions = 0;
        go_to(run, joint, k, &s);
        find_errors(run, joint, &s);
        s.approach = approach_of(run, &s);
        s.seconds = tool_now() - began;
        if (!s.converged)
            tool_fails_with(&run->t, EXIT_SHORT);
        if (run->corner[k].silent && tool_interrupted() == 0)
            continue;
        slip_judge(run, &s);
        write_frames(run, joint[0], &s);
        slip_report(run, &s);
    }
    for (size_t j = 0; j < run->joints; j++)
        rc_joint_free(joint[j]);
    for (int c = 0; c < 2; c++) {
        free(run->lag[c]);
        run->lag[c] = NULL;
    }
}

/* ---- a case ---- */

static size_t
memory_for(const struct slip_run *run, const struct rc_joint_problem *problem)
{
    struct rc_shape shape = rc_grid_shape(run->p);

    return run->joints * rc_joint_memory(&shape, problem, run->solves) +
           (run->joints > 1 ? 3 : 1) * rc_grid_nodes(run->p) * sizeof(double) +
           slip_checkpoint_memory(run);
}

void
slip_case(struct slip_run *run)
{
    struct rc_joint_problem problem;
    size_t told = 0;

    check_pressure(run);
    check_beside(run, run->gap);
    check_beside(run, run->height);
    find_boundary(run);
    slip_find_bodies(run);
    slip_plan_path(run);
    check_solvable(run);
    for (size_t k = 0; k < run->corners; k++)
        told += !run->corner[k].silent;
    if (told == 1 && rc_grid_case(run->p) > run->number)
        run->number = rc_grid_case(run->p) - 1;
    problem = problem_of(run);
    slip_checkpoint_case(run->checkpoint);
    slip_judge_plan(run);
    if (run->args->dry_run) {
        slip_say_plan(run, tool_memory_with(memory_for(run, &problem)));
    } else {
        tool_demand_memory(&run->t, run->p, memory_for(run, &problem));
        follow(run, &problem);
    }
    free(run->corner);
}
