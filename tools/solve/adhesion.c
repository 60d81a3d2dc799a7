/*
 * --adhesion: bodies that attract each other. The loads or approaches of a list are a path: each state starts
 * from the last one, for rising and falling values. --pull-off adds a case in which the bodies are separated.
 */
#include "solve.h"

#include <math.h>
#include <string.h>

static const double resolved = 1.5;   /* nodes in the cohesive length: with fewer the grid pins
                                         the edge of the contact */
static const double enough = 2;       /* nodes that the warning recommends */
static const double faint = 0.01;     /* fraction of the largest traction */
static const double too_strong = 0.1; /* fraction of E*: above it a solid is not linear elastic */

/* ---- the command line ---- */

static void
refuse(struct run *run, bool given, const char *what, const char *why)
{
    if (given)
        tool_usage(&run->d.t, "--adhesion does not work with %s: %s", what, why);
}

void
adhesion_read(struct run *run)
{
    const struct solve_args *args = run->args;
    struct adhering *a = &run->adhering;

    a->wanted = args->adhesion != NULL;
    if (!a->wanted && args->pull_off)
        tool_usage(&run->d.t,
                   "--pull-off needs --adhesion: without attraction the pull-off load is 0");
    if (!a->wanted && solve_wanted(args, SOLVE_ADHESION))
        tool_usage(&run->d.t, "--output adhesion needs --adhesion");
    if (!a->wanted)
        return;
    if (adhesion_law_read(&a->law, args->adhesion, &run->d.t.err) != RC_OK)
        tool_usage(&run->d.t, "--adhesion %s: %s", args->adhesion, run->d.t.err.text);
    refuse(run, args->yield != NULL, "--yield",
           "plasticity in the volume supports pressures only, no attraction");
    refuse(run, run->tilt, "--tilt free", "with adhesion the bodies move along their normal only");
    refuse(
        run, args->discretization, "--discretization",
        "a coarser grid may not resolve the law; solve a coarser map in a second command instead");
    refuse(run, args->stiffness, "--stiffness", "use a list of --approach values instead");
    refuse(run, args->conductivity != NULL, "--conductivity",
           "the analogy of conductance and stiffness holds only without attraction");
    refuse(run,
           solve_wanted(args, SOLVE_PLASTIC) || solve_wanted(args, SOLVE_RESIDUAL) ||
               solve_wanted(args, SOLVE_STRAIN),
           "--output plastic, residual or strain",
           "there is no plasticity in the volume with adhesion");
}

/* ---- the model ---- */

static struct rc_adhesion_problem
problem_of(const struct run *run, const struct rc_problem *contact)
{
    struct rc_adhesion_problem problem = run->adhering.law.problem;

    problem.contact = *contact;
    return problem;
}

struct rc_model *
adhesion_model(struct run *run, const struct rc_grid *g, const struct rc_problem *contact)
{
    const struct rc_shape shape = rc_grid_shape(g);
    const struct rc_adhesion_problem problem = problem_of(run, contact);
    struct rc_model *m = NULL;

    if (rc_adhesion_check(&shape, &problem, &run->adhering.scales, &run->d.t.err) == RC_OK)
        m = rc_adhesion_new(&shape, g->v, &problem, &run->d.t.err);
    if (m == NULL)
        tool_refuse(&run->d.t, g, "%s", run->d.t.err.text);
    return m;
}

void
adhesion_set_key(struct run *run, struct rc_grid *as, const struct rc_contact *c)
{
    char law[128];

    if (!run->adhering.wanted)
        return;
    snprintf(law, sizeof law, "%s,%s,%s", rc_number(run->adhering.law.problem.work),
             run->adhering.scales.law, rc_number(run->adhering.scales.range));
    tool_must(&run->d.t, as, rc_grid_set(as, "adhesion", law, &run->d.t.err));
    tool_must(&run->d.t, as, rc_grid_set_number(as, "load", c->load, &run->d.t.err));
}

/* ---- warnings ---- */

static void
warn_of_grid(struct run *run, const struct rc_grid *g, const char *where)
{
    const struct rc_adhesion_scales *s = &run->adhering.scales;
    double spacing = fmax(g->dx, g->dy);
    char length[SHOWN_NUMBER], range[SHOWN_NUMBER];

    if (s->cohesive_nodes >= resolved)
        return;
    /* at constant work the cohesive length grows with the square of the range */
    tool_warn(&run->d.t,
              "%s: the cohesive length, %s, is %.2g of the spacing: the grid is too coarse for "
              "this law, and pull-off and hysteresis will be too large (lattice pinning): take a "
              "spacing of %s, or, if only the work matters, a range of %s",
              where, shown_in_unit_to(length, s->cohesive_length, "m"), s->cohesive_nodes,
              shown_in_unit(spacing * s->cohesive_nodes / enough, "m"),
              shown_in_unit_to(range, s->range * sqrt(enough / s->cohesive_nodes), "m"));
}

/* Tabor's number for the sphere of --radius on these bodies. */
static double
tabor(const struct run *run)
{
    const struct physics *p = &run->args->physics;
    double w = run->adhering.law.problem.work / p->surface_estar;

    return cbrt(p->radius * w * w) / run->adhering.scales.range;
}

/* Warns if Tabor's number is below 3. The law jkr takes the shortest range that the grid resolves, and JKR
 * theory holds for Tabor's numbers of 3 and more. */
static void
warn_of_jkr(struct run *run, const struct rc_grid *g, const char *where)
{
    const double enough_tabor = 3, is = tabor(run);
    char range[SHOWN_NUMBER];

    if (strcmp(run->adhering.scales.law, "jkr") != 0 || !(is < enough_tabor))
        return;
    /* the range grows with the square root of the spacing */
    tool_warn(&run->d.t,
              "%s: Tabor's number is %.2g, below 3: the range, %s, is too long for JKR theory, and "
              "loads and areas may differ from it by some per cent: take a spacing of %s",
              where, is, shown_in_unit_to(range, run->adhering.scales.range, "m"),
              shown_in_unit(fmax(g->dx, g->dy) * pow(is / enough_tabor, 2), "m"));
}

static void
warn_of_state(struct run *run, const char *where, const struct rc_adhesion_state *f)
{
    const double estar = run->args->physics.surface_estar;

    if (f->separated)
        tool_warn(&run->d.t,
                  "%s: the bodies have separated, because no state carries this load: take "
                  "--approach to pass the pull-off, or --pull-off to find its load",
                  where);
    else if (!f->stable && f->converged)
        course_warn(&run->d.course, "the state is not stable", "%s: the state is not stable",
                    where);
    solve_warn_of_limits(run, where);
    if (run->adhering.pulling && f->pull_off_at_start)
        tool_warn(&run->d.t,
                  "%s: the lowest load is at the first point, so that the pull-off load may be "
                  "lower: end the list at a larger load or approach",
                  where);
    if (f->edge_traction > faint)
        course_warn(
            &run->d.course, "a traction at the edge of the map",
            "%s: the traction at the edge of the map is %.2g of the largest: the bodies attract "
            "each other beyond the map too, where their heights are unknown: take a larger map",
            where, f->edge_traction);
    if (run->adhering.scales.strength > too_strong * estar)
        course_warn(&run->d.course, "a traction at which a solid is not linear elastic",
                    "%s: the largest traction, %s, is %.2g of E*: beyond %g a solid is not linear "
                    "elastic: is the range right?",
                    where, shown_in_unit(run->adhering.scales.strength, "Pa"),
                    run->adhering.scales.strength / estar, too_strong);
}

static void
tell(struct run *run, const char *where, const struct rc_adhesion_state *f, bool pulled)
{
    if (pulled)
        tool_note(&run->d.t,
                  "%s: pull-off at %s +- %s, at approach %s; %zu states, %.3g convolutions, %.2g s",
                  where, shown_in_unit(f->pull_off_load, "N"),
                  shown_in_unit(f->pull_off_spread, "N"), shown_in_unit(f->pull_off_approach, "m"),
                  f->states, f->convolutions, tool_now() - run->d.began);
    tool_note(
        &run->d.t,
        "%s: force %s, of which %s attracts, contact area %s (%.3g %% of the map, %zu nodes), "
        "approach %s, stability %.2g, %zu %s; %s to %.2g in %zu iterations, %.3g convolutions, "
        "%.2g s",
        where, shown_in_unit(f->load, "N"), shown_in_unit(f->attractive_load, "N"),
        shown_area(f->contact_area), 100 * f->contact_fraction, f->contact_nodes,
        shown_in_unit(f->approach, "m"), f->stability, f->jumps, f->jumps == 1 ? "jump" : "jumps",
        f->converged ? "converged" : "not converged", f->pressure_error, f->iterations,
        f->convolutions, tool_now() - run->d.began);
}

void
adhesion_judge(struct run *run, const struct rc_grid *g, const struct solution *s)
{
    const struct rc_adhesion_state *f = run->adhering.figures;
    char where[512];

    solve_where(run, g, where, sizeof where);
    tell(run, where, f, run->adhering.pulling);
    if (run->step == 0 && !run->adhering.pulling) {
        warn_of_grid(run, g, where);
        warn_of_jkr(run, g, where);
    }
    warn_of_state(run, where, f);
    if (f->separated)
        return;
    if (tool_interrupted() == 0 && s->contact.contact_nodes > 0)
        solve_warn_of_theory(run, g, where, s);
    solve_warn_of_end(run, where, &s->contact);
}

size_t
adhesion_memory(const struct run *run, const struct rc_grid *g, const struct rc_problem *contact)
{
    const struct rc_shape shape = rc_grid_shape(g);
    const struct rc_adhesion_problem problem = problem_of(run, contact);
    /* heights, frame; state at the last point; shape of dents; state of --checkpoint */
    const size_t maps = 2u + (run->steps->n > 1 || run->args->pull_off) +
                        !isinf(run->hardness_min) + (run->d.checkpoint != NULL);
    const size_t kept =
        contact->boundary == RC_PERIODIC ? 32 : 128; /* bytes a node of a retraction */
    struct rc_expected expected = {0};
    struct rc_err err;

    (void)rc_adhesion_expect(&shape, &problem, &expected, &err);
    return expected.memory +
           ((run->args->pull_off ? kept : 0) + maps * sizeof *g->v) * rc_grid_nodes(g);
}

/* ---- plan and report ---- */

void
adhesion_expect(struct run *run, const struct rc_grid *g, const struct rc_problem *contact,
                struct rc_expected *expected)
{
    const struct rc_shape shape = rc_grid_shape(g);
    const struct rc_adhesion_problem problem = problem_of(run, contact);

    tool_must(&run->d.t, g,
              rc_adhesion_check(&shape, &problem, &run->adhering.scales, &run->d.t.err));
    tool_must(&run->d.t, g, rc_adhesion_expect(&shape, &problem, expected, &run->d.t.err));
}

const char *
adhesion_state(const struct run *run)
{
    static char text[256];
    const struct adhering *a = &run->adhering;

    if (!a->wanted)
        return "left out: no --adhesion";
    snprintf(text, sizeof text, "on: %s, %s over %s: at most %s, cohesive length %.2g nodes%s",
             a->scales.law, shown_in_unit(a->law.problem.work, "J/m2"),
             shown_in_unit(a->scales.range, "m"), shown_in_unit(a->scales.strength, "Pa"),
             a->scales.cohesive_nodes,
             isnan(run->args->physics.radius) ? "; Tabor's number needs --radius" : "");
    return text;
}

void
adhesion_report(struct report *r, const struct run *run)
{
    const struct adhering *a = &run->adhering;
    const struct rc_adhesion_state *f = a->figures;
    const bool on = f != NULL;
    const struct figures from[] = {{rc_figures("adhesion"), f}, {NULL, NULL}};

    report_number(r, "adhesion_work", on ? a->law.problem.work : NAN, "J/m2");
    report_text(r, "adhesion_law", on ? a->scales.law : NULL);
    report_number(r, "adhesion_range", on ? a->scales.range : NAN, "m");
    report_number(r, "cohesive_nodes", on ? a->scales.cohesive_nodes : NAN, NULL);
    report_named(r, from, "attractive_load repulsive_load attractive_area min_pressure stability");
    report_text(r, "stable", !on ? NULL : f->stable ? "yes" : "no");
    report_text(r, "separated", !on ? NULL : f->separated ? "yes" : "no");
    report_named(r, from, "jumps pull_off_load pull_off_approach pull_off_spread");
    report_number(r, "tabor", on ? tabor(run) : NAN, NULL);
}
