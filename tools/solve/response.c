/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The response of a solution to small changes: its stiffness and, by analogy, its conductance, whose
 * computation finds the stiffness too if no node is at the hardness.
 */
#include "solve.h"

#include <math.h>

enum {
    STIFFNESS = 6 /* convolutions of one of them */
};

/* ---- conductance ---- */

static const char *conductivities; /* of both bodies, or NULL */
static struct {
    bool found;       /* by each solution */
    double k[2];      /* SI */
    const char *unit; /* W/K or S; NULL: the conductivities have no unit */
} conductance;

/* clang-format off */
static const struct opt conductivity_options[] = {
    {.name = "conductivity", .type = OPT_TEXT, .base = &conductivities, .arg = "K1,K2",
     .help = "compute the conductance from the conductivities of both bodies: 45W/mK,16W/mK, 58MS/m,7MS/m"},
    {.name = NULL},
};
/* clang-format on */

static bool
ask_conductance(struct run *run)
{
    struct tool *t = &run->d.t;

    if (conductivities == NULL)
        return false;
    if (unit_conductivities(conductivities, conductance.k, &conductance.unit, &t->err) != RC_OK)
        tool_usage(t, "--conductivity %s: %s", conductivities, t->err.text);
    conductance.found = run->physics->layer.n == 0;
    if (!conductance.found)
        tool_warn(t, "--conductivity does not work with --layer, because the analogy of "
                     "conductance and stiffness fails: the conductance is left out");
    return conductance.found;
}

static bool
look_apart(struct run *run, struct rc_model *m, struct solution *s)
{
    (void)m;
    if (run->apart)
        s->conductance = (struct rc_conductance){NAN, 0, 0};
    return true;
}

static void
find_conductance(struct run *run, struct rc_solver *solver, struct solution *s)
{
    if (isnan(s->conductance.value))
        tool_must(&run->d.t, run->g,
                  rc_solver_conductance(solver, conductance.k[0], conductance.k[1], &s->conductance,
                                        &run->d.t.err));
}

static double
conductance_work(const struct run *run)
{
    (void)run;
    return STIFFNESS + 1;
}

static const char *
conductance_state(const struct run *run)
{
    (void)run;
    return conductance.found        ? "on"
           : conductivities != NULL ? "left out: layers, for which no analogy holds"
                                    : "left out: no --conductivity";
}

static void
report_conductance(struct report *r, const struct run *run)
{
    report_number(r, "conductance", run->solution.conductance.value, conductance.unit);
    report_number(r, "conductance_lower", run->solution.conductance.lower, conductance.unit);
}

const struct effect solve_effect_conductivity = {
    .name = "conductivity",
    .title = "output",
    .options = conductivity_options,
    .ask = ask_conductance,
    .look = look_apart,
    .find = find_conductance,
    .work = conductance_work,
    .later = RC_CONDUCTANCE_BYTES, /* the map of patches is freed before */
    .state = conductance_state,
    .place = COLUMNS_OF_BOUNDS,
    .columns = true,
    .report = report_conductance,
};

/* ---- stiffness ---- */

static bool given;

/* clang-format off */
static const struct opt stiffness_options[] = {
    {.name = "stiffness", .type = OPT_FLAG, .base = &given,
     .help = "compute d load / d approach (default: with a list)"},
    {.name = NULL},
};
/* clang-format on */

static bool
is_asked(const struct run *run)
{
    return given || (physics_steps(run->physics)->n > 1 && SOLVE_FIRST(run, no_stiffness) == NULL);
}

static bool
ask_stiffness(struct run *run)
{
    return is_asked(run);
}

static void
find_stiffness(struct run *run, struct rc_solver *solver, struct solution *s)
{
    if (conductance.found)
        find_conductance(run, solver, s);
    if (conductance.found && s->contact.plastic_nodes == 0)
        s->stiffness = s->conductance.stiffness;
    else
        tool_must(&run->d.t, run->g, rc_solver_stiffness(solver, &s->stiffness, &run->d.t.err));
}

static double
stiffness_work(const struct run *run)
{
    return conductance.found && isinf(run->bound_min) ? 0 : STIFFNESS;
}

static const char *
stiffness_state(const struct run *run)
{
    static char text[64];
    const struct effect *without = SOLVE_FIRST(run, no_stiffness);

    if (is_asked(run))
        return "on";
    snprintf(text, sizeof text, "left out: %s",
             without != NULL ? without->no_stiffness : "no --stiffness");
    return text;
}

const struct effect solve_effect_stiffness = {
    .name = "stiffness",
    .title = "output",
    .options = stiffness_options,
    .ask = ask_stiffness,
    .find = find_stiffness,
    .work = stiffness_work,
    .later = RC_STIFFNESS_BYTES,
    .state = stiffness_state,
};
