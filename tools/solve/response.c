/*
 * The response of a solution to small changes: its stiffness and, by analogy, its conductance, whose computation
 * finds the stiffness too if no node is at the hardness.
 */
#include "solve.h"

#include <math.h>

enum {
    STIFFNESS = 6 /* convolutions of one of them */
};

/* ---- conductance ---- */

static const char *conductivities; /* of both bodies, or NULL */
static struct {
    bool wanted;
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
    (void)run;
    return conductivities != NULL;
}

static void
read_conductance(struct run *run)
{
    if (unit_conductivities(conductivities, conductance.k, &conductance.unit, &run->d.t.err) !=
        RC_OK)
        tool_usage(&run->d.t, "--conductivity %s: %s", conductivities, run->d.t.err.text);
    conductance.wanted = run->physics->pair.one.layers == 0;
    if (!conductance.wanted)
        tool_warn(&run->d.t, "--conductivity does not work with --layer, because the analogy of "
                             "conductance and stiffness fails: the conductance is left out");
}

static bool
look_apart(struct run *run, struct rc_model *m, struct solution *s)
{
    (void)m;
    if (run->apart && conductance.wanted)
        s->conductance = (struct rc_conductance){NAN, 0, 0};
    return true;
}

static void
find_conductance(struct run *run, struct rc_solver *solver, struct solution *s)
{
    if (conductance.wanted && isnan(s->conductance.value))
        tool_must(&run->d.t, run->g,
                  rc_solver_conductance(solver, conductance.k[0], conductance.k[1], &s->conductance,
                                        &run->d.t.err));
}

static double
conductance_work(const struct run *run)
{
    (void)run;
    return conductance.wanted ? STIFFNESS + 1 : 0;
}

/* The map of patches is freed before. */
static size_t
conductance_bytes(const struct run *run)
{
    (void)run;
    return conductance.wanted ? RC_CONDUCTANCE_BYTES : 0;
}

static const char *
conductance_state(const struct run *run)
{
    (void)run;
    return conductance.wanted ? "on" : "left out: layers, for which no analogy holds";
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
    .read = read_conductance,
    .look = look_apart,
    .find = find_conductance,
    .work = conductance_work,
    .later = conductance_bytes,
    .off = "left out: no --conductivity",
    .state = conductance_state,
    .place = COLUMNS_OF_BOUNDS,
    .columns = true,
    .report = report_conductance,
};

/* ---- stiffness ---- */

static struct {
    bool given;
    bool wanted;
    const char *why_not;
} stiffness;

/* clang-format off */
static const struct opt stiffness_options[] = {
    {.name = "stiffness", .type = OPT_FLAG, .base = &stiffness.given,
     .help = "compute d load / d approach (default: with a list)"},
    {.name = NULL},
};
/* clang-format on */

static void
read_stiffness(struct run *run)
{
    const struct effect *without = SOLVE_FIRST(run, no_stiffness);

    stiffness.why_not = without != NULL ? without->no_stiffness : "one load and no --stiffness";
    stiffness.wanted = stiffness.given || (run->steps->n > 1 && without == NULL);
}

static void
find_stiffness(struct run *run, struct rc_solver *solver, struct solution *s)
{
    if (!stiffness.wanted)
        return;
    find_conductance(run, solver, s);
    if (conductance.wanted && s->contact.plastic_nodes == 0)
        s->stiffness = s->conductance.stiffness;
    else
        tool_must(&run->d.t, run->g, rc_solver_stiffness(solver, &s->stiffness, &run->d.t.err));
}

static double
stiffness_work(const struct run *run)
{
    return stiffness.wanted && !(conductance.wanted && isinf(run->bound_min)) ? STIFFNESS : 0;
}

static size_t
stiffness_bytes(const struct run *run)
{
    (void)run;
    return stiffness.wanted ? RC_STIFFNESS_BYTES : 0;
}

static const char *
stiffness_state(const struct run *run)
{
    static char text[64];

    (void)run;
    if (stiffness.wanted)
        return "on";
    snprintf(text, sizeof text, "left out: %s", stiffness.why_not);
    return text;
}

const struct effect solve_effect_stiffness = {
    .name = "stiffness",
    .title = "output",
    .options = stiffness_options,
    .read = read_stiffness,
    .find = find_stiffness,
    .work = stiffness_work,
    .later = stiffness_bytes,
    .state = stiffness_state,
};
