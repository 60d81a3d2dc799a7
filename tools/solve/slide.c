/*
 * --relaxation with --speed: body 2 slides steadily over the viscoelastic body 1, a case a speed. One load
 * has a list of speeds, one speed a list of loads, and lists of equal length belong together.
 */
#include "solve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

static const double beyond = 10; /* times the inverse of the shortest relaxation time */

static bool
slides_along_y(const struct run *run)
{
    return strcmp(run->args->along, "y") == 0;
}

static bool
repeats(const struct run *run)
{
    return strcmp(run->args->track, "repeated") == 0;
}

/* ---- the command line ---- */

static void
refuse(struct run *run, bool given, const char *what, const char *why)
{
    if (given)
        tool_usage(&run->d.t, "--speed does not work with %s: %s", what, why);
}

/* The relaxation of E/(1 - nu^2) of body 1. */
static void
make_material(struct run *run)
{
    const struct rc_relaxation *m = run->relaxing.law.material;
    const double nu = run->args->physics.nu1, plane = 1 - nu * nu;
    double *modulus = malloc((m->terms + 1) * sizeof *modulus);
    struct rc_err err = {"out of memory for the material"};

    for (size_t k = 0; k < m->terms && modulus != NULL; k++)
        modulus[k] = m->modulus[k] / plane;
    if (modulus != NULL)
        run->sliding.material =
            rc_relaxation_new(m->relaxed / plane, m->terms, modulus, m->time, &err);
    free(modulus);
    if (run->sliding.material == NULL)
        tool_usage(&run->d.t, "--relaxation: %s", err.text);
}

void
slide_check(struct run *run)
{
    const struct solve_args *a = run->args;
    struct sliding *s = &run->sliding;
    struct tool *t = &run->d.t;

    s->wanted = a->speed.n > 0;
    if (!s->wanted && (tool_given(t, "along") || tool_given(t, "track")))
        tool_usage(t, "--along and --track have no effect without --speed");
    if (!s->wanted)
        return;
    if (a->relaxation == NULL)
        tool_usage(t, "--speed needs the material of body 1: give --relaxation");
    refuse(run, !a->physics.periodic && repeats(run), "--track repeated",
           "only a map that repeats has one: give --periodic");
    refuse(run, a->time.n > 0, "--time", "a steady state has no time");
    refuse(run, !isinf(a->physics.hardness), "--hardness", "it is not implemented");
    refuse(run, a->physics.layer.n > 0, "--layer", "it is not implemented");
    refuse(run, a->yield != NULL, "--yield", "it is not implemented");
    refuse(run, a->adhesion != NULL, "--adhesion", "it is not implemented");
    refuse(run, a->travel.n > 0, "--travel", "the steady state is that of all positions");
    refuse(run, tool_given(t, "history"), "--history", "each case is a steady state of its own");
    refuse(run, a->stiffness, "--stiffness", "it is not implemented");
    refuse(run, a->conductivity != NULL, "--conductivity", "it is not implemented");
    refuse(run, a->discretization, "--discretization",
           "solve a coarser map in a second command instead");
    refuse(run, ranks_of(t) != NULL, "several processes", "take one");
    if (!(run->relaxing.law.material->relaxed > 0))
        tool_usage(
            t, "--relaxation: the relaxed modulus is 0: body 2 would sink without end, and there "
               "is no steady state for --speed");
    if (run->steps->n > 1 && a->speed.n > 1 && run->steps->n != a->speed.n)
        tool_usage(t,
                   "--speed has %zu values, and the list of loads or approaches %zu: give lists of "
                   "equal length, or one load or one speed",
                   a->speed.n, run->steps->n);
    run->stiffness = false;
    make_material(run);
    relax_warn_of_material(run);
}

/* ---- points ---- */

size_t
slide_points(const struct run *run)
{
    return run->args->speed.n > 1 ? run->args->speed.n : run->steps->n;
}

double
slide_speed(const struct run *run, size_t point)
{
    return run->args->speed.v[run->args->speed.n > 1 ? point : 0];
}

size_t
slide_step(const struct run *run, size_t point)
{
    return run->steps->n > 1 ? point : 0;
}

struct rc_model *
slide_model(struct run *run, const struct rc_problem *problem)
{
    const struct physics *a = &run->args->physics;
    const struct rc_sliding_problem law = {
        .material = run->sliding.material,
        .compliance = fmax(1 / a->surface_estar - (1 - a->nu1 * a->nu1) / a->e1, 0),
        .along_y = slides_along_y(run),
        .repeats = repeats(run)};

    return tool_made(&run->d.t, run->g,
                     rc_sliding_new(rc_shape_of(run->g), run->g->v, problem, &law, &run->d.t.err));
}

/* ---- results ---- */

void
slide_look(struct run *run, const struct rc_model *m, struct rc_contact *c)
{
    const struct rc_sliding_figures *f = run->sliding.found = rc_sliding_result(m);

    if (f == NULL)
        return;
    c->approach = f->approach;
    c->iterations = f->iterations;
    c->convolutions = f->convolutions;
    c->pressure_error = f->pressure_error;
    c->elastic_energy = f->elastic_energy;
    c->converged = f->converged;
}

void
slide_warn(struct run *run, const char *where)
{
    const struct sliding *s = &run->sliding;
    const struct rc_relaxation *m = s->material;
    const double traction = 0.3, pi = 3.141592653589793;
    const struct rc_grid *g = run->g;
    double speed, length;

    if (!s->wanted || s->found == NULL)
        return;
    speed = fabs(s->found->speed);
    length = slides_along_y(run) ? (double)g->ny * g->dy : (double)g->nx * g->dx;
    if (s->found->friction > traction)
        tool_warn(&run->d.t,
                  "%s: the coefficient of friction is %.3g, and the contact is that of smooth "
                  "bodies without friction: above %g the tractions along the surface change it",
                  where, s->found->friction, traction);
    if (isnan(run->relaxing.law.misfit) || m->terms == 0 || speed == 0)
        return;
    if (2 * pi * speed / (8 * g->dx) * m->time[0] > beyond)
        tool_warn(&run->d.t,
                  "%s: waves of 8 nodes excite the material beyond the frequencies of the master "
                  "curve: there it has its instantaneous modulus by extrapolation",
                  where);
    if (2 * pi * speed / length * m->time[m->terms - 1] < 1 / beyond)
        tool_warn(&run->d.t,
                  "%s: waves as long as the map, %s, excite the material below the frequencies of "
                  "the master curve: there it has its relaxed modulus by extrapolation",
                  where, shown_in_unit(length, "m"));
}

void
slide_report(struct report *r, const struct run *run)
{
    const struct figures from[] = {{rc_figures("sliding"), run->sliding.found}, {NULL, NULL}};

    report_named(r, from,
                 "speed friction friction_force friction_error_estimate dissipated_power track "
                 "tan_delta_max contacts");
}

const char *
slide_state(const struct run *run)
{
    static char text[128];

    if (!run->sliding.wanted)
        return "left out: no --speed";
    snprintf(text, sizeof text, "on: along %s, %s track", run->args->along, run->args->track);
    return text;
}
