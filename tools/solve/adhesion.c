/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * --adhesion: bodies that attract each other. The loads or approaches of a list are a path: each state starts
 * from the last one, for rising and falling values. --pull-off adds a case in which the bodies are separated.
 */
#include "solve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double within = 0.01;    /* of the range: closer heights are those of the ball */
static const double faint = 0.01;     /* fraction of the largest traction */
static const double too_strong = 0.1; /* fraction of E*: above it a solid is not linear elastic */
/* m, work over strength: that of cohesion between atoms at their spacing, 0.165 nm and more (Israelachvili,
 * Intermolecular and Surface Forces, 2011, chapter 13), where the law of Lennard-Jones has 0.97 of it */
static const double atomic = 0.1e-9;
static const double jkr_tabor = 3;  /* contacts with larger Tabor's numbers follow JKR theory */
static const double most_work = 10; /* J/m2: diamond, cleaved, has 11 */

static struct {
    const char *law; /* words of the command line, or NULL */
    bool pull_off;   /* pull-off is an additional last case */
} args;

static struct {
    struct adhesion_law law;
    struct rc_adhesion_scales scales;        /* scales of the law on this grid */
    const struct rc_adhesion_state *figures; /* figures of the current point; NULL: none */
    bool pulling;                            /* this case is the pull-off */
    struct ball ball;
    double part;       /* expected work of a state over that of a map in partial contact */
    double filled;     /* pressure with the attraction over that which closes the gap */
    double retraction; /* expected work of the retraction over that of the first state */
} own;

/* ---- the command line ---- */

/* clang-format off */
static const struct opt options[] = {
    {.group = adhesion_option, .base = &args.law,
     .against = RULES({.with = "tilt free",
                       .because = "with adhesion the bodies move along their normal only"},
                      {.with = "discretization", .because = "a coarser grid may not resolve the law",
                       .remedy = "solve a coarser map in a second command instead"},
                      {.with = "stiffness", .remedy = "use a list of --approach values instead"},
                      {.with = "conductivity",
                       .because = "the analogy of conductance and stiffness holds only "
                                                          "without attraction"},
                      {.with = "output plastic",
                       .because = "there is no plasticity in the volume with adhesion"})},
    {.name = "pull-off", .type = OPT_FLAG, .base = &args.pull_off, .result = true, .points = true,
     .needs = RULES({.with = "adhesion", .because = "without attraction the pull-off load is 0"}),
     .help = "after the last state separate the bodies, and find the pull-off load"},
    {.name = NULL},
};
/* clang-format on */

static bool
ask(struct run *run)
{
    run->physics->pulls = args.law != NULL;
    return args.law != NULL;
}

static void
read(struct run *run)
{
    if (adhesion_law_read(&own.law, args.law, &run->d.t.err) != RC_OK)
        tool_usage(&run->d.t, "--adhesion %s: %s", args.law, run->d.t.err.text);
    if (solve_wanted(run->args, SOLVE_PRESSURE) || solve_wanted(run->args, SOLVE_GAP))
        solve_add_frame(CONTACT_CHANNEL); /* the pressure does not determine the contact */
}

/* ---- the model ---- */

static struct rc_adhesion_problem
problem_of(const struct rc_problem *contact)
{
    struct rc_adhesion_problem problem = own.law.problem;

    problem.contact = *contact;
    problem.pull_off = args.pull_off;
    return problem;
}

static struct rc_model *
make(struct run *run, const struct rc_problem *contact)
{
    const struct rc_grid *g = run->g;
    const struct rc_shape shape = rc_grid_shape(g);
    const struct rc_adhesion_problem problem = problem_of(contact);
    struct rc_model *m = NULL;

    own.ball = physics_ball(&run->d.t, run->physics, g);
    if (rc_adhesion_check(&shape, &problem, &own.scales, &run->d.t.err) == RC_OK)
        m = rc_adhesion_new(&shape, g->v, &problem, &run->d.t.err);
    if (m == NULL)
        tool_refuse(&run->d.t, g, "%s", run->d.t.err.text);
    return m;
}

static void
add_points(struct run *run)
{
    struct drive *d = &run->d;
    size_t room = d->points;

    if (!args.pull_off)
        return;
    d->point = tool_grown(&d->t, d->point, d->points, &room, sizeof *d->point, "the loads");
    d->point[d->points] = d->point[0];
    rc_point_set(&d->point[d->points++], RC_APPROACH, -INFINITY);
}

static void
begin(struct run *run, struct rc_model *m, const struct rc_problem *problem)
{
    (void)m, (void)problem;
    own.pulling = run->d.at == run->cases;
    if (own.pulling)
        run->d.course.checkpoint = NULL;
}

/* The error of the shape is not that of the heights. Separated bodies are in equilibrium at each distance. */
static bool
look(struct run *run, struct rc_model *m, struct solution *s)
{
    const struct rc_adhesion_figures *f = rc_adhesion_result(m);

    (void)run;
    own.figures = &f->state;
    s->contact = f->contact;
    s->contact.shape_error = NAN;
    if (f->state.separated)
        s->contact.approach = s->contact.mean_gap = NAN;
    return true;
}

static void
close(struct run *run)
{
    (void)run;
    own.figures = NULL;
}

static void
set_keys(struct run *run, struct rc_grid *as)
{
    char law[128];

    snprintf(law, sizeof law, "%s,%s,%s", rc_number(own.law.problem.work), own.scales.law,
             rc_number(own.scales.range));
    tool_must(&run->d.t, as, rc_grid_set(as, "adhesion", law, &run->d.t.err));
    tool_must(&run->d.t, as,
              rc_grid_set_number(as, "load", run->solution.contact.load, &run->d.t.err));
    tool_set(&run->d.t, as, "separated", own.figures->separated ? "yes" : NULL);
}

/* ---- warnings ---- */

static void
warn_of_grid(struct run *run, const char *where)
{
    const struct rc_grid *g = run->g;
    const struct rc_adhesion_scales *s = &own.scales;
    char length[SHOWN_NUMBER], range[SHOWN_NUMBER], *blank;
    struct adhesion_grid need;

    if (adhesion_resolved(s, run->physics->boundary, fmax(g->dx, g->dy), &need))
        return;
    shown_in_unit_to(range, need.range, "m");
    if ((blank = strchr(range, ' ')) != NULL) /* a word of the command line */
        memmove(blank, blank + 1, strlen(blank));
    tool_warn(&run->d.t,
              "%s: the cohesive length, %s, is %.2g of the spacing: the grid is too coarse for "
              "this law, and pull-off and hysteresis will be too large (lattice pinning): take a "
              "spacing of %s, or, if only the work matters, a longer range, as --adhesion "
              "%.*s,%s,%s",
              where, shown_in_unit_to(length, s->cohesive_length, "m"), s->cohesive_nodes,
              shown_in_unit(need.spacing, "m"), (int)strcspn(args.law, ","), args.law, s->law,
              range);
}

/* Work above that of any surfaces is that of a forgotten unit, or of an adhesive that dissipates. */
static void
warn_of_work(struct run *run, const char *where)
{
    char *end;
    const double given = strtod(args.law, &end);
    const bool bare = *end == '\0' || *end == ',';

    if (own.law.problem.work > most_work &&
        (bare || own.scales.strength > too_strong * run->physics->surface_estar))
        tool_warn(
            &run->d.t,
            "%s: the work of adhesion, %s, is far above that of clean surfaces, about 0.01 to "
            "10 J/m2%s%s%s",
            where, shown_in_unit(own.law.problem.work, "J/m2"),
            bare ? ": was the unit forgotten, as in --adhesion " : "", bare ? rc_number(given) : "",
            bare ? "mJ/m2" : ": is it right?");
}

/* Tabor's number for the ball, or for the cylinder of --cylinder, on these bodies. */
static double
tabor(const struct run *run)
{
    const struct physics *p = run->physics;
    double w = own.law.problem.work / p->surface_estar;

    return cbrt((isnan(own.ball.radius) ? p->cylinder : own.ball.radius) * w * w) /
           own.scales.range;
}

static bool
grid_sets_range(void)
{
    return !(own.law.problem.range > 0);
}

static bool
below_atoms(void)
{
    return own.law.problem.work / own.scales.strength < atomic;
}

/* Says which range the grid has set. A range that it sets shall not matter, as with Tabor's numbers of 3 and
 * more; the law jkr has a warning of its own. */
static void
warn_of_range(struct run *run, const char *where)
{
    const bool set = grid_sets_range();
    const double is = tabor(run);
    const int work = (int)strcspn(args.law, ",");
    char range[SHOWN_NUMBER], text[SHOWN_NUMBER + 160] = "";

    shown_in_unit_to(range, own.scales.range, "m");
    if (set)
        snprintf(text, sizeof text,
                 ", the default for this grid (a cohesive length of %.2g nodes),",
                 own.scales.cohesive_nodes);
    if (below_atoms())
        tool_warn(
            &run->d.t,
            "%s: the range of adhesion, %s%s is below the spacing of atoms: real attraction "
            "reaches 0.1 to 0.4 nm or more, so that real bodies are closer to DMT theory than "
            "this contact: give the range of the surfaces, as --adhesion "
            "%.*s,exponential,0.3nm",
            where, range, set ? text : ",", work, args.law);
    else if (set && strcmp(own.scales.law, "jkr") != 0 && is < jkr_tabor)
        tool_warn(&run->d.t,
                  "%s: the range of adhesion, %s%s changes loads and areas, because Tabor's number "
                  "is %.2g, below 3: give the range of the surfaces, or take a spacing of %s",
                  where, range, text, is,
                  shown_in_unit(fmax(run->g->dx, run->g->dy) * pow(is / jkr_tabor, 2), "m"));
    else if (set)
        tool_note(&run->d.t, "%s: the range of adhesion is %s%s as none is given", where, range,
                  text);
}

/* Warns if Tabor's number is below 3. The law jkr takes the shortest range that the grid resolves, and JKR
 * theory holds for Tabor's numbers of 3 and more. */
static void
warn_of_jkr(struct run *run, const char *where)
{
    const struct rc_grid *g = run->g;
    const double is = tabor(run);
    char range[SHOWN_NUMBER];

    if (strcmp(own.scales.law, "jkr") != 0 || !(is < jkr_tabor) || below_atoms())
        return;
    /* the range grows with the square root of the spacing */
    tool_warn(&run->d.t,
              "%s: Tabor's number is %.2g, below 3: the range, %s, is too long for JKR theory, and "
              "loads and areas may differ from it by some per cent: take a spacing of %s",
              where, is, shown_in_unit_to(range, own.scales.range, "m"),
              shown_in_unit(fmax(g->dx, g->dy) * pow(is / jkr_tabor, 2), "m"));
}

/* A path keeps the contact down to pull-off only if its loads fall. */
static void
warn_of_separation(struct run *run, const char *where, const struct rc_adhesion_state *f)
{
    if (f->converged) /* at load 0 they rest apart */
        return;
    if (f->was_separated)
        course_warn(
            &run->d.course, "bodies that separated at an earlier load",
            "%s: the bodies separated at an earlier load, and separated bodies carry no tensile "
            "load: list the loads from the largest to the smallest, as 0,-1nN,-2nN, so that the "
            "contact lasts down to pull-off",
            where);
    else
        tool_warn(&run->d.t, "%s: the bodies have separated, because no state carries this load%s",
                  where,
                  args.pull_off ? ""
                                : ": take --approach to pass the pull-off, or --pull-off to find "
                                  "its load");
}

static void
warn_of_state(struct run *run, const char *where, const struct rc_adhesion_state *f)
{
    const double estar = run->physics->surface_estar;

    if (f->separated)
        warn_of_separation(run, where, f);
    else if (!f->stable && f->converged)
        course_warn(&run->d.course, "the state is not stable", "%s: the state is not stable",
                    where);
    solve_warn_of_limits(
        run, where,
        f->stable && f->converged && !f->separated ? "a list of approaches passes the jump" : NULL);
    if (own.pulling && f->pull_off_at_start)
        tool_warn(
            &run->d.t,
            "%s: the pull-off load is unknown, because the retraction begins at the last "
            "state of the list, which is beyond it: end the list at a larger load or approach",
            where);
    if (f->edge_traction > faint)
        course_warn(
            &run->d.course, "a traction at the edge of the map",
            "%s: the traction at the edge of the map is %.2g %% of the largest: the bodies attract "
            "each other beyond the map too, where their heights are unknown: take a larger map",
            where, 100 * f->edge_traction);
    if (own.scales.strength > too_strong * estar && !(own.law.problem.work > most_work))
        course_warn(&run->d.course, "a traction at which a solid is not linear elastic",
                    "%s: the largest traction, %s, is %.2g of E*: beyond %g a solid is not linear "
                    "elastic: is the range right?",
                    where, shown_in_unit(own.scales.strength, "Pa"), own.scales.strength / estar,
                    too_strong);
}

static void
tell(struct run *run, const char *where, const struct rc_adhesion_state *f, bool pulled)
{
    char spread[SHOWN_NUMBER], at[SHOWN_NUMBER], from[SHOWN_NUMBER];

    if (pulled && !f->pull_off_at_start)
        tool_note(&run->d.t,
                  "%s: pull-off at %s +- %s, at approach %s, on a retraction from approach %s; "
                  "%zu states, %.3g convolutions, %.2g s",
                  where, shown_in_unit(f->pull_off_load, "N"),
                  shown_in_unit_to(spread, f->pull_off_spread, "N"),
                  shown_in_unit_to(at, f->pull_off_approach, "m"),
                  shown_in_unit_to(from, f->pull_off_from, "m"), f->states, f->convolutions,
                  tool_now() - run->d.is.began);
    if (f->separated) {
        tool_note(&run->d.t,
                  "%s: the bodies are apart and exert no force; %zu %s, %zu iterations, %.3g "
                  "convolutions, %.2g s",
                  where, f->jumps, f->jumps == 1 ? "jump" : "jumps", f->iterations, f->convolutions,
                  tool_now() - run->d.is.began);
        return;
    }
    tool_note(
        &run->d.t,
        "%s: force %s, of which %s attracts, contact area %s (%.3g %% of the map, %zu nodes), "
        "approach %s, stability %.2g, %zu %s; %s to %.2g in %zu iterations, %.3g convolutions, "
        "%.2g s",
        where, shown_in_unit(f->load, "N"), shown_in_unit(f->attractive_load, "N"),
        shown_area(f->contact_area), 100 * f->contact_fraction, f->contact_nodes,
        shown_in_unit(f->approach, "m"), f->stability, f->jumps, f->jumps == 1 ? "jump" : "jumps",
        f->converged ? "converged" : "not converged", f->pressure_error, f->iterations,
        f->convolutions, tool_now() - run->d.is.began);
}

static void
judge(struct run *run, const char *where, const struct solution *s)
{
    const struct rc_adhesion_state *f = own.figures;

    tell(run, where, f, own.pulling);
    if (run->step == 0 && !own.pulling) {
        warn_of_work(run, where);
        warn_of_range(run, where);
        warn_of_grid(run, where);
        warn_of_jkr(run, where);
    }
    warn_of_state(run, where, f);
    if (f->separated)
        return;
    if (tool_interrupted() == 0 && s->contact.contact_nodes > 0)
        solve_warn_of_theory(run, where, s);
    solve_warn_of_end(run, where, s);
}

/* ---- plan and report ---- */

static size_t
memory(struct run *run, const struct rc_problem *contact)
{
    const struct rc_shape shape = rc_grid_shape(run->g);
    const struct rc_adhesion_problem problem = problem_of(contact);
    /* heights, frame; state at the last point; shape of dents; state of --checkpoint */
    /* where a retraction may begin: in the model, at the last point, in the state of --checkpoint */
    const size_t turn = args.pull_off && run->steps->n > 1 ? 2u + (run->d.checkpoint != NULL) : 0;
    const size_t maps = 2u + (run->steps->n > 1 || args.pull_off) + !isinf(run->bound_min) +
                        (run->d.checkpoint != NULL) + turn;
    const size_t kept =
        (size_t)rc_by_padding(contact->boundary, 128, 32); /* bytes a node of a retraction */
    struct rc_expected expected = {0};
    struct rc_err err;

    (void)rc_adhesion_expect(&shape, &problem, &expected, &err);
    return expected.memory +
           ((args.pull_off ? kept : 0) + maps * sizeof *run->g->v) * rc_grid_nodes(run->g);
}

/* The work on a map that the attraction pulls into nearly full contact, over that of
 * rc_adhesion_expect: few nodes are left whose gap must be found, except at the edges of a free map.
 * `filled` is the pressure with the attraction over the scale of the pressure in full contact, E*
 * slope/2. Measured on rough maps of 64 x 64 to 192 x 192 nodes. */
static double
full_contact(const struct run *run, const struct rc_problem *contact)
{
    const double slope =
        rc_measure_contact_slope(ranks_of(&run->d.t), rc_shape_of(run->g), run->g->v, NULL);
    const double nodes = (double)run->g->nx * (double)run->g->ny;
    const double filled =
        (own.scales.strength + contact->load / (nodes * run->g->dx * run->g->dy)) /
        (contact->pair.estar * slope / 2);
    const double nearly = 3, full = 4.5;
    const bool edges = rc_has_mean(contact->boundary);

    own.filled = filled;
    if (own.scales.cohesive_nodes > 1.5 || !(filled > (edges ? full : nearly)))
        return 1;
    return filled > full ? (edges ? 1.0 / 2 : 1.0 / 3) : fmin(sqrt(nodes / 16384) / 2, 1);
}

/* The retraction over the first state. It takes more states, the more the load exceeds the pull-off load,
 * for which the attraction of rigid bodies at first touch stands. A gap that the attraction closes opens in
 * many steps. Of 60 rough maps of 32 x 32 to 96 x 96 nodes 46 are within a factor of 2, all within 4. */
static double
retraction_cost(const struct run *run, const struct rc_problem *contact)
{
    const struct rc_grid *g = run->g;
    const double steepness = own.scales.strength / own.law.problem.work, usual = 0.02, most = 600;
    const double closed = 1.2, opens = own.scales.cohesive_nodes < 1 ? 180 : 55;
    double highest = -INFINITY, sum = 0, over;
    size_t first, rows;

    ranks_rows(&run->d.t, rc_shape_of(g), &first, &rows);
    for (size_t k = 0; k < rows * g->nx; k++)
        highest = fmax(highest, g->v[k]);
    highest = ranks_most(&run->d.t, highest);
    for (size_t k = 0; k < rows * g->nx; k++)
        sum += exp((g->v[k] - highest) * steepness);
    sum = ranks_sum(&run->d.t, sum) * g->dx * g->dy * own.scales.strength;
    over = contact->load > 0 ? sum / contact->load : usual; /* the load of an approach is unknown */
    return own.filled > closed ? opens / own.part : fmin(9 + 4.6 * pow(over, -0.45), most);
}

/* Finds the cost of a state and the scales of the law on this grid. */
static void
plan_cost(struct run *run, const struct rc_problem *contact, struct rc_expected *expected)
{
    const struct rc_shape shape = rc_grid_shape(run->g);
    const struct rc_adhesion_problem problem = problem_of(contact);

    tool_must(&run->d.t, run->g, rc_adhesion_check(&shape, &problem, &own.scales, &run->d.t.err));
    tool_must(&run->d.t, run->g, rc_adhesion_expect(&shape, &problem, expected, &run->d.t.err));
    own.ball = physics_ball(&run->d.t, run->physics, run->g);
    own.part = full_contact(run, contact);
    expected->convolutions *= own.part;
    expected->seconds *= own.part;
    if (args.pull_off)
        own.retraction = retraction_cost(run, contact);
}

/* Over the work of the first state. */
static double
loads_cost(const struct run *run)
{
    const double next_full = 0.25; /* of a further state in full contact */

    return 1 + (own.part < 1 ? next_full : 1) * ((double)run->cases - 1) +
           (args.pull_off ? own.retraction : 0);
}

/* Johnson, Kendall and Roberts 1971; Derjaguin, Muller and Toporov 1975. */
static void
describe_ball(char *text, size_t size, const struct run *run)
{
    const double force = acos(-1) * own.law.problem.work * own.ball.radius;
    char radius[SHOWN_NUMBER], jkr[SHOWN_NUMBER], difference[SHOWN_NUMBER + 64] = "";

    if (own.ball.off > within * own.scales.range)
        snprintf(difference, sizeof difference, " (these heights differ from it by up to %s)",
                 shown_in_unit(own.ball.off, "m"));
    snprintf(text, size,
             "; a smooth ball of %s radius%s pulls off at %s by JKR and %s by DMT; Tabor's number "
             "is %.2g (JKR above 5, DMT below 0.1)",
             shown_in_unit_to(radius, own.ball.radius, "m"), difference,
             shown_in_unit_to(jkr, 1.5 * force, "N"), shown_in_unit(2 * force, "N"), tabor(run));
}

static const char *
state(const struct run *run)
{
    static char text[768];
    char along_x[SHOWN_NUMBER];
    size_t n;

    n = (size_t)snprintf(
        text, sizeof text, "on: %s, %s over %s%s: at most %s, cohesive length %.2g nodes",
        own.scales.law, shown_in_unit(own.law.problem.work, "J/m2"),
        shown_in_unit(own.scales.range, "m"), grid_sets_range() ? " (set by the grid)" : "",
        shown_in_unit(own.scales.strength, "Pa"), own.scales.cohesive_nodes);
    if (!isnan(own.ball.radius))
        describe_ball(text + n, sizeof text - n, run);
    else if (!isnan(own.ball.along[0]))
        snprintf(text + n, sizeof text - n,
                 "; no Tabor's number: by the key form=%s the heights are a ball, but their radii "
                 "of curvature are %s along x and %s along y",
                 rc_grid_get(run->g, "form"), shown_in_unit_to(along_x, own.ball.along[0], "m"),
                 shown_in_unit(own.ball.along[1], "m"));
    else if (isnan(tabor(run)))
        snprintf(text + n, sizeof text - n, "; Tabor's number needs --radius or --cylinder");
    return text;
}

static void
report(struct report *r, const struct run *run)
{
    const struct rc_adhesion_state *f = own.figures;
    const bool on = f != NULL;
    const struct figures from[] = {{rc_figures("adhesion"), f}, {NULL, NULL}};

    report_number(r, "adhesion_work", on ? own.law.problem.work : NAN, "J/m2");
    report_text(r, "adhesion_law", on ? own.scales.law : NULL);
    report_number(r, "adhesion_range", on ? own.scales.range : NAN, "m");
    report_number(r, "cohesive_nodes", on ? own.scales.cohesive_nodes : NAN, NULL);
    report_named(r, from, "attractive_load repulsive_load attractive_area min_pressure stability");
    report_text(r, "stable", !on ? NULL : f->stable ? "yes" : "no");
    report_text(r, "separated", !on ? NULL : f->separated ? "yes" : "no");
    report_named(r, from, "jumps pull_off_load pull_off_approach pull_off_spread");
    report_number(r, "tabor", on ? tabor(run) : NAN, NULL);
}

const struct effect solve_effect_adhesion = {
    .name = "adhesion",
    .title = "adhesion",
    .options = options,
    .ask = ask,
    .read = read,
    .sequence = true,
    .tol = TOL_FREE,
    .no_stiffness = "the bodies attract each other",
    .close = close,
    .points = add_points,
    .base = make,
    .at_once = true,
    .by_gap = true,
    .method = "gap",
    .engine = "the gap is found by transforms",
    .plan = plan_cost,
    .loads = loads_cost,
    .memory = memory,
    .begin = begin,
    .look = look,
    .judge_alone = judge,
    .keys = set_keys,
    .frames = (const char *const[]){"adhesion", NULL},
    .foreign = (const char *const[]){"separated", NULL},
    .frames_alone = "needs --adhesion",
    .off = "left out: no --adhesion",
    .state = state,
    .place = COLUMNS_OF_GAP,
    .columns = true,
    .report = report,
};
