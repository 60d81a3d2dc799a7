/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fatigue below a contact that rolls or slides: criteria of the stress history of each point. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tools/fatigue/fatigue.h"
#include "tools/materials/materials.h"
#include "tools/stress/stress.h"

static struct args {
    struct fatigue_limits_asked limits;
    struct numbers depths, life; /* depths: none: auto */
    size_t criteria;             /* bits of enum rc_criterion */
    const char *pass, *dangvan, *residual, *report, *by_depth;
    bool planes, dry_run;
    struct stress_asked asked;
} args = {.asked = STRESS_ASKED,
          .dangvan = "cut",
          .criteria = 1U << RC_CROSSLAND | 1U << RC_DANG_VAN | 1U << RC_AMPLITUDE};

static const char *
criterion_word(size_t k)
{
    return k <= RC_AMPLITUDE ? rc_criterion_names[k] : NULL;
}

#define AT(field) .at = offsetof(struct args, field)
/* clang-format off */
static const struct opt opts[] = {
    {.name = "bending-limit", .type = OPT_NUMBERS, .unit = UNIT_PA, AT(limits.bending), .min = 0,
     .max = INFINITY, .above = true, .result = true, .arg = "LIST",
     .help = "endurance limit in fully reversed bending; of a coated body a list, top layer first"},
    {.name = "torsion-limit", .type = OPT_NUMBERS, .unit = UNIT_PA, AT(limits.torsion), .min = 0,
     .max = INFINITY, .above = true, .result = true, .arg = "LIST",
     .help = "endurance limit in fully reversed torsion, likewise"},
    {.name = "yield", .type = OPT_NUMBERS, .unit = UNIT_PA, AT(limits.yield), .min = 0, .max = INFINITY,
     .above = true, .result = true, .arg = "LIST",
     .help = "yield stress in tension, likewise, for the criterion shakedown"},
    {.name = "limits", .type = OPT_TEXT, AT(limits.table), .result = true, .arg = "FILE",
     .against = RULES({.with = "bending-limit|torsion-limit|yield", .because = "the table has all limits"}),
     .help = "instead: a table of depth, bending limit, torsion limit and, if needed, yield stress"},
    {.name = "criteria", .type = OPT_WORDS, AT(criteria), .result = true, .words = criterion_word,
     .arg = "LIST",
     .needs = RULES({.with = "pass", .word = "shakedown",
                     .because = "only then the residual stresses do not vary along the travel"}),
     .help = "of %s (default: crossland, dangvan, amplitude)"},
    {.name = "dangvan", .type = OPT_CHOICE, AT(dangvan), .result = true, .arg = "cut|full",
     .needs = RULES({.with = "criteria dangvan"}),
     .help = "hydrostatic pressure has no effect in Dang Van's criterion, or lowers it (default cut)"},
    {.name = "pass", .type = OPT_CHOICE, AT(pass), .result = true, .arg = "x|y",
     .help = "the contact passes along x or y: all points of a line get the stresses of the whole line"},
    {.name = "depths", .type = OPT_NUMBERS, .unit = UNIT_M, AT(depths), .min = 0,
     .max = INFINITY, .result = true, .word = "auto", .arg = "LIST",
     .one_of = RULES({.with = "depths",
                      .remedy = "as in --depths 1um,5um or --depths 1um:50um:log:20, or leave "
                                                "their choice to --depths auto"}),
     .help = "depths: a,b,c, a:b:n or a:b:log:n, or auto: dense near the surface"},
    {.name = "residual", .type = OPT_TEXT, AT(residual), .result = true, .arg = "FILE",
     .help = "stresses that are always there, as rc-stress --residual writes them at these depths"},
    {.group = stress_body_options, AT(asked)},
    {.group = material_options_of_one},
    {.name = "planes", .type = OPT_FLAG, AT(planes), .result = true,
     .help = "also write the angles of Findley's plane: frames plane-tilt and plane-turn"},
    {.name = "life", .type = OPT_NUMBERS, AT(life), .min = 0, .max = INFINITY, .result = true,
     .arg = "C[,H[,TAU]]", .help = "report the integral of (amplitude - TAU)^C z^-H, TAU in Pa"},
    {.group = stress_sum_options, AT(asked)},
    {.name = "report", .type = OPT_REPORT, AT(report), .arg = "FILE",
     .help = "write one JSON object per result, or a row of FILE.tsv or .csv: largest indices, safety"},
    {.name = "by-depth", .type = OPT_REPORT, AT(by_depth), .arg = "FILE",
     .help = "write the largest indices of each depth, as --report does"},
    {.name = "dry-run", .type = OPT_FLAG, AT(dry_run), .text = true,
     .help = "print what would be computed, with memory and time, and stop"},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-fatigue",
    .summary = "Fatigue below a contact that rolls or slides: indices and safety factor",
    .operands = "[FILE...]",
    .examples =
        "  rc-solve --load 240N --E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3 surface.rcg |\n"
        "      rc-fatigue --bending-limit 600MPa --torsion-limit 372MPa --pass x --depths auto \\\n"
        "          --report fatigue.json --by-depth depths.tsv -o fatigue.rcg\n"
        "  rc-render --channel dangvan -o section.png fatigue.rcg\n"
        "  rc-render --curve depth:dangvan -o curve.png depths.tsv\n",
    .opts = opts,
    .figures = (const char *const[]){"fatigue", NULL},
    .shares = true,
    .fill = materials_fill,
    .of_materials = (const char *const[]){"nu", NULL},
    .reads = READS_STREAM,
    .writes = WRITES_STREAM,
};

/* A case of the stream. */
struct position {
    struct rc_grid *p, *traction[2];
};

struct run {
    struct tool t;
    struct fatigue_limits limits;
    struct fatigue_residual residual;
    struct report report, by_depth;
    /* of the present history */
    struct position *position;
    size_t positions, room;
    struct stress_input input; /* of the first case; tractions of the next one */
    struct rc_stress_options options;
    struct rc_fatigue_problem problem;
    struct numbers depths;
    const double **map[3]; /* pressure and tractions of each case */
    size_t *column;
    double step;  /* m: largest distance of the contact between two states */
    size_t needs; /* bytes of all work, beside the maps that are read */
    struct rc_grid *frame[RC_FATIGUES];
    double *line
        [RC_FATIGUES]; /* of a pass: the values of a depth, of which a row of the frame is made */
};

static bool
wanted(int c)
{
    return args.criteria >> c & 1;
}

/* ---- the command line ---- */

static void
check_arguments(struct run *run)
{
    struct tool *t = &run->t;

    for (size_t k = 1; k < args.depths.n; k++)
        if (!(args.depths.v[k] > args.depths.v[k - 1]))
            tool_usage(t, "--depths: the depths must increase");
    if (args.planes)
        args.criteria |= 1U << RC_FINDLEY | 1U << RC_PLANE_TILT | 1U << RC_PLANE_TURN;
    if (args.life.n > 3 || (args.life.n > 0 && !(args.life.v[0] > 0)))
        tool_usage(t, "--life: it must be C, C,H or C,H,TAU, with C above 0");
    fatigue_limits_read(t, &args.limits, (unsigned)args.criteria, &run->limits);
    if (isnan(args.asked.tol))
        args.asked.tol = 1e-5; /* stresses in single precision, and on coarser grids below */
    if (args.residual != NULL)
        fatigue_residual_read(t, args.residual, args.pass == NULL ? 'x' : args.pass[0],
                              &run->residual);
    report_open(&run->report, t, args.report);
    report_open(&run->by_depth, t, args.by_depth);
}

/* ---- the cases of a history ---- */

static bool
take(void *ctx, struct tool *t, const struct rc_grid *p, struct rc_grid *g)
{
    return stress_input_take(t, p, g, &((struct run *)ctx)->input);
}

static const char *
key_text(const struct rc_grid *g, const char *name)
{
    const char *text = rc_grid_get(g, name);

    return text == NULL ? "" : text;
}

/* Adds a case; the next ones must be of the same body on the same grid. */
static void
add_case(struct run *run, struct rc_grid *p)
{
    static const char *const same[] = {"boundary", "layers", "layers.residual", "nu"};
    struct tool *t = &run->t;
    const size_t n = run->positions;
    const struct rc_grid *first = n > 0 ? run->position[0].p : p;
    struct position *at;

    tool_demand_finite(t, p, "recompute the map");
    tool_demand_grid_of(t, p, first);
    for (size_t k = 0; k < sizeof same / sizeof *same; k++)
        if (strcmp(key_text(p, same[k]), key_text(first, same[k])) != 0)
            tool_refuse(t, p,
                        "its key %s is '%s', that of the first case '%s': the cases of a history "
                        "must have the same body",
                        same[k], key_text(p, same[k]), key_text(first, same[k]));
    if (rc_grid_get(p, "slabs") != NULL && n == 0)
        tool_warn(t,
                  "the body has yielded, and its residual stress is not in the histories: compute "
                  "it with rc-stress --residual and give the file to --residual");
    if (n == 0)
        stress_input_read(t, p, &args.asked, &run->input, &run->options);
    run->position = tool_grown(t, run->position, n, &run->room, sizeof *run->position, "cases");
    at = &run->position[run->positions++];
    at->p = p;
    for (int k = 0; k < 2; k++) {
        at->traction[k] = run->input.traction[k];
        run->input.traction[k] = NULL;
        if (at->traction[k] != NULL) {
            tool_demand_grid_of(t, at->traction[k], p);
            tool_demand_finite(t, at->traction[k], "recompute the map");
        }
        if ((at->traction[k] != NULL) != (run->position[0].traction[k] != NULL))
            tool_refuse(t, p, "only some of the cases have a frame traction-%c",
                        k == 0 ? 'x' : 'y');
    }
}

static double
position_of(struct run *run, const struct rc_grid *p)
{
    double x = 0;

    if (rc_grid_get(p, "position") != NULL && !rc_grid_number(p, "position", &x))
        tool_refuse(&run->t, p, "its key position is not a number");
    if ((rc_grid_get(p, "position") != NULL) !=
        (rc_grid_get(run->position[0].p, "position") != NULL))
        tool_refuse(&run->t, p, "only some of the cases have the key position");
    return x;
}

/* Where the map of a case lies on the body: its key window_x, without it the position. */
static double
place_of(struct run *run, const struct rc_grid *p)
{
    double x = position_of(run, p);

    (void)rc_grid_number(p, "window_x", &x);
    return x;
}

/* True if the contact is at other positions of the body in other cases. */
static bool
travels(const struct run *run)
{
    const struct rc_grid *first = run->position[0].p;

    return rc_grid_get(first, "position") != NULL || rc_grid_get(first, "window_x") != NULL;
}

/* The columns of the body under the maps, and the distance between states. */
static void
set_columns(struct run *run)
{
    const struct rc_grid *first = run->position[0].p;
    double least = INFINITY, before = NAN, rounded = 0;

    run->step = args.pass == NULL ? 0 : args.pass[0] == 'x' ? first->dx : first->dy;
    for (size_t k = 0; k < run->positions; k++)
        least = fmin(least, place_of(run, run->position[k].p));
    for (size_t k = 0; k < run->positions && args.pass == NULL; k++) {
        const double x = place_of(run, run->position[k].p);
        const double at = position_of(run, run->position[k].p);
        const double moved = (x - least) / first->dx, columns = floor(moved + 0.5);
        if (columns > 1e7)
            tool_refuse(
                &run->t, run->position[k].p,
                "its position, %g m, is %g columns from that of another case: are positions "
                "in metres?",
                x, columns);
        run->column[k] = (size_t)columns;
        rounded = fmax(rounded, fabs(moved - columns));
        if (k > 0)
            run->step = fmax(run->step, fabs(at - before));
        before = at;
    }
    if (rounded > 0.01)
        tool_warn(
            &run->t,
            "positions are rounded to columns of the map, by up to %.2g of dx: take positions "
            "at multiples of dx",
            rounded);
}

static size_t
count_wanted(void)
{
    size_t n = 0;

    for (int c = 0; c < RC_FATIGUES; c++)
        n += wanted(c);
    return n;
}

/* Lines along the travel. */
static size_t
lines_of(const struct run *run)
{
    return run->problem.pass == 'y' ? run->position[0].p->nx : run->position[0].p->ny;
}

/* A section with a row for each depth, or the map of a depth. */
static struct rc_shape
frame_shape(const struct run *run)
{
    struct rc_shape shape = rc_fatigue_shape(rc_shape_of(run->position[0].p), &run->problem);
    const struct numbers *d = &run->depths;

    if (run->problem.pass != 0) {
        shape.ny = d->n;
        shape.dy = d->n > 1 ? (d->v[d->n - 1] - d->v[0]) / (double)(d->n - 1) : shape.dx;
    }
    return shape;
}

static void
set_problem(struct run *run)
{
    struct tool *t = &run->t;
    const struct rc_grid *first = run->position[0].p;
    const struct rc_shape shape = rc_grid_shape(first);
    const size_t n = run->positions;
    size_t frames, least, first_row, rows, left = tool_memory_left(t);
    struct rc_shape frame;

    run->column = tool_room(t, n, sizeof *run->column, "cases");
    for (int m = 0; m < 3; m++) {
        run->map[m] = tool_room(t, n, sizeof(double *), "cases");
        for (size_t k = 0; k < n; k++) {
            const struct position *at = &run->position[k];
            const struct rc_grid *g = m == 0 ? at->p : at->traction[m - 1];
            run->map[m][k] = g == NULL ? NULL : g->v;
        }
    }
    set_columns(run);
    run->problem = (struct rc_fatigue_problem){.stress = run->options,
                                               .wanted = (unsigned)args.criteria,
                                               .full = strcmp(args.dangvan, "full") == 0,
                                               .pass = args.pass == NULL ? 0 : args.pass[0],
                                               .cases = n,
                                               .p = run->map[0],
                                               .column = travels(run) ? run->column : NULL,
                                               .power = args.life.n > 0 ? args.life.v[0] : 0,
                                               .depth_power = args.life.n > 1 ? args.life.v[1] : 0,
                                               .threshold = args.life.n > 2 ? args.life.v[2] : 0};
    for (int k = 0; k < 2; k++)
        run->problem.traction[k] = run->map[k + 1][0] == NULL ? NULL : run->map[k + 1];
    tool_must(t, first, rc_fatigue_check(&shape, &run->problem, &t->err));
    /* histories get what the plan, the maps and the frames leave */
    frame = frame_shape(run);
    ranks_rows(t, &frame, &first_row, &rows);
    frames = count_wanted() * frame.nx * (rows + (run->problem.pass != 0)) * sizeof(double);
    run->problem.room = 1;
    run->needs = stress_plan_bytes(first, &run->options, RC_COMPONENTS) + frames;
    least = run->needs + rc_fatigue_memory(&shape, &run->problem);
    run->problem.room = left > least ? left - least : 1;
    run->needs += rc_fatigue_memory(&shape, &run->problem);
}

/* ---- depths and frames ---- */

static double
highest(const struct tool *t, const struct rc_grid *p)
{
    double most = -INFINITY;

    for (size_t k = 0; k < rc_grid_nodes(p); k++)
        most = fmax(most, p->v[k]);
    return ranks_most(t, most);
}

/* Automatic depths are at least half a node below the surface. Above that the stress is that of single cells,
 * not of the pressure. */
static void
set_depths(struct run *run)
{
    const struct rc_grid *peak = run->position[0].p;
    struct numbers *d = &run->depths;
    double largest = -INFINITY, least = fmin(peak->dx, peak->dy) / 2;
    size_t kept = 0;

    for (size_t k = 0; k < run->positions; k++) {
        const struct rc_grid *p = run->position[k].p;
        const double high = highest(&run->t, p);
        if (high > largest) {
            largest = high;
            peak = p;
        }
    }
    *d = args.depths;
    stress_depths_read(&run->t, peak, &run->options, d);
    if (args.depths.n > 0) {
        if (d->v[0] < least)
            tool_warn(&run->t,
                      "the first depth, %s, is less than half the distance of nodes, %s: stresses "
                      "there are those of single cells, and indices are too large or too small",
                      shown_in_unit(d->v[0], "m"), shown_in_unit(2 * least, "m"));
        return;
    }
    for (size_t k = 0; k < d->n; k++)
        if (d->v[k] >= least)
            d->v[kept++] = d->v[k];
    d->n = kept;
}

static const char *
unit_of(int c)
{
    return c < RC_CRITERIA ? "1" : c == RC_AMPLITUDE ? "Pa" : "deg";
}

static bool
needs_endurance(void)
{
    return (args.criteria & ((1U << RC_SHAKEDOWN) - 1)) != 0;
}

/* The limits in the keys, if all depths have the same. */
static void
set_keys(struct run *run, struct rc_grid *g)
{
    static const char *const gone[] = {"position", "height", "mu", "approach"};
    const char pass[2] = {run->problem.pass, '\0'};
    const struct rc_fatigue_limits *limits = run->limits.at;
    struct numbers *d = &run->depths;
    struct tool *t = &run->t;

    for (size_t k = 0; k < sizeof gone / sizeof *gone; k++)
        tool_set(t, g, gone[k], NULL);
    if (pass[0] != '\0') {
        tool_set(t, g, "section", pass);
        tool_set_numbers(t, g, "depths", d->v, d->n);
    }
    tool_set_number(t, g, "frames", (double)(count_wanted() * (pass[0] != '\0' ? 1 : d->n)));
    if (run->limits.n <= 1 && limits->bending > 0)
        tool_set_number(t, g, "bending_limit", limits->bending);
    if (run->limits.n <= 1 && limits->torsion > 0)
        tool_set_number(t, g, "torsion_limit", limits->torsion);
    tool_sign(t, g);
}

static void
new_frames(struct run *run)
{
    const struct rc_shape shape = frame_shape(run);

    for (int c = 0; c < RC_FATIGUES; c++) {
        run->frame[c] = NULL;
        if (!wanted(c))
            continue;
        run->frame[c] =
            tool_frame_like(&run->t, run->position[0].p, &shape, rc_criterion_names[c], unit_of(c));
        set_keys(run, run->frame[c]);
        if (run->problem.pass != 0)
            run->line[c] = tool_room(&run->t, shape.nx, sizeof(double), "a section");
    }
}

static void
free_frames(struct run *run)
{
    for (int c = 0; c < RC_FATIGUES; c++) {
        rc_grid_free(run->frame[c]);
        free(run->line[c]);
        run->frame[c] = NULL;
        run->line[c] = NULL;
    }
}

/* The criteria and effects: computed, or why not. */
static const struct effect_state *
effects(const struct run *run)
{
    static struct effect_state list[RC_FATIGUES + 4];
    const bool traction = run->options.mu != 0 || run->position[0].traction[0] != NULL ||
                          run->position[0].traction[1] != NULL;

    for (int c = 0; c < RC_FATIGUES; c++)
        list[c] = (struct effect_state){rc_criterion_names[c],
                                        wanted(c) ? "on" : "left out: not in --criteria"};
    list[RC_FATIGUES] = (struct effect_state){
        "pass", args.pass != NULL ? "on" : "left out: no --pass, the cases are the history"};
    list[RC_FATIGUES + 1] = (struct effect_state){
        "friction", traction ? "on" : "left out: mu = 0 and no frames of traction"};
    list[RC_FATIGUES + 2] =
        (struct effect_state){"residual", args.residual != NULL ? "on" : "left out: no --residual"};
    return list;
}

/* ---- the report ---- */

static void
begin_row(struct run *run, struct report *out)
{
    const struct rc_grid *first = run->position[0].p;
    const char pass[2] = {run->problem.pass, '\0'};

    report_begin(out);
    report_map(out, first, rc_grid_case(first));
    report_text(out, "boundary", rc_boundary_word(run->options.boundary));
    report_count(out, "threads", run->t.threads, NULL);
    report_text(out, "pass", pass[0] == '\0' ? NULL : pass);
    report_count(out, "positions", run->positions, NULL);
}

static void
report_depth(struct run *run, const struct rc_fatigue *f, double depth, double **by_depth, size_t k)
{
    const struct rc_fatigue_figures *at = rc_fatigue_at_depth(f);
    const struct rc_fatigue_limits l = fatigue_limits_at(&run->limits, &run->options.body, depth);

    for (int c = 0; c <= RC_CRITERIA; c++)
        by_depth[c][k] = at->largest[c].value;
    begin_row(run, &run->by_depth);
    report_number(&run->by_depth, "depth", depth, "m");
    report_count(&run->by_depth, "material", rc_body_material(&run->options.body, depth) + 1, NULL);
    report_number(&run->by_depth, "bending_limit", l.bending, "Pa");
    report_number(&run->by_depth, "torsion_limit", l.torsion, "Pa");
    report_table(&run->by_depth, rc_figures("fatigue"), at);
    report_finish_row(&run->by_depth);
}

static void
report_all(struct run *run, const struct rc_fatigue *f, double **by_depth, double began)
{
    struct report *out = &run->report;
    const char *converged = NULL;

    for (size_t k = 0; k < run->positions && (converged == NULL || strcmp(converged, "no") != 0);
         k++)
        converged = rc_grid_get(run->position[k].p, "converged");

    begin_row(run, out);
    report_text(out, "dangvan_compression", args.dangvan);
    report_text(out, "residual", args.residual);
    report_numbers(out, "depth_list", run->depths.v, sizeof *run->depths.v, run->depths.n);
    report_table(out, rc_figures("fatigue"), rc_fatigue_result(f));
    report_object(out, "by_depth");
    for (int c = 0; c <= RC_CRITERIA; c++)
        if (wanted(c))
            report_numbers(out, rc_criterion_names[c], by_depth[c], sizeof(double), run->depths.n);
    report_end(out);
    report_number(out, "tol", run->options.tol, NULL);
    report_carried(out, converged);
    report_effects(out, effects(run));
    report_seconds(out, (const struct report_phase[]){{NULL, 0}}, tool_now() - began);
    report_memory(out);
    report_ranks(out, out->tool);
    report_finish_row(out);
}

/* ---- judgement ---- */

/* True if the map repeats along the travel, or along both axes. */
static bool
never_unloads(const struct run *run)
{
    const struct rc_boundary boundary = run->options.boundary;

    if (run->problem.pass == 0 && !travels(run))
        return !rc_has_mean(boundary);
    return rc_wraps(boundary, run->problem.pass == 'y' ? RC_Y : RC_X);
}

/* The case that a history begins with. */
static const char *
case_of(struct run *run)
{
    static char text[WHERE];
    char *frame;

    snprintf(text, sizeof text, "%s", tool_where(&run->t, run->position[0].p));
    if ((frame = strstr(text, ", frame ")) != NULL) /* the last one that was read */
        *frame = '\0';
    return text;
}

static void
warn_of_sampling(struct run *run, const char *criterion, const struct rc_fatigue_place *at)
{
    static const char what[] = "a large sampling error";
    struct tool *t = &run->t;
    const char *where = case_of(run);

    if (run->step > 0)
        tool_warn_first(t, what,
                        "%s: %s: its largest value is at the depth %s, and the states of a history "
                        "are up to %s apart: its sampling error is %.2g: take a finer map or more "
                        "positions, or leave out depths above it",
                        where, criterion, shown_in_unit(at->depth, "m"),
                        shown_in_unit(run->step, "m"), at->sampling_error);
    else
        tool_warn_first(
            t, what,
            "%s: %s: its largest value is at the depth %s, and the history "
            "has %zu case%s: its sampling error is %.2g: take a finer map or more loads, or "
            "leave out depths above it",
            where, criterion, shown_in_unit(at->depth, "m"), run->positions,
            run->positions == 1 ? "" : "s", at->sampling_error);
}

static void
judge(struct run *run, const struct rc_fatigue *f)
{
    static const double coarse = 0.05;
    const struct rc_fatigue_figures *r = rc_fatigue_result(f);
    const struct rc_fatigue_place *at = r->largest;
    struct tool *t = &run->t;
    const char *where = case_of(run);

    for (int c = 0; c <= RC_CRITERIA; c++)
        if (wanted(c) && at[c].sampling_error > coarse) {
            warn_of_sampling(run, rc_criterion_names[c], &at[c]);
            break;
        }
    if (never_unloads(run) && needs_endurance())
        tool_warn_first(t, "the points never unload",
                        "%s: %s the points never unload: the amplitudes and the indices of "
                        "Crossland, Papadopoulos and Findley are smaller than in a single contact",
                        where,
                        rc_has_mean(run->options.boundary) ? "the map repeats along the travel, and"
                                                           : "on a periodic map");
    if (wanted(RC_DANG_VAN) && run->problem.full && r->dangvan_hydrostatic < 0)
        tool_warn_first(t, "hydrostatic pressure lowers Dang Van's index",
                        "%s: the instant that decides for Dang Van is under hydrostatic pressure, "
                        "which lowers the index as far as the limits allow: compare --dangvan cut",
                        where);
    if (wanted(RC_SHAKEDOWN) && at[RC_SHAKEDOWN].value > 1)
        tool_warn_first(
            t, "an index of shakedown above 1",
            "%s: the index of shakedown is %.3g: the body yields in every cycle, and criteria of "
            "elastic cycles do not hold",
            where, at[RC_SHAKEDOWN].value);
}

/* ---- a history ---- */

/* The values of a pass to their row of the section. */
static void
set_row(struct run *run, size_t k)
{
    for (int c = 0; c < RC_FATIGUES; c++) {
        struct rc_grid *g = run->frame[c];
        size_t first, rows;
        if (!wanted(c))
            continue;
        ranks_rows(&run->t, rc_shape_of(g), &first, &rows);
        if (k >= first && k < first + rows)
            memcpy(g->v + (k - first) * g->nx, run->line[c], g->nx * sizeof *g->v);
    }
}

static void
do_depth(struct run *run, struct rc_fatigue *f, size_t k)
{
    struct tool *t = &run->t;
    const double depth = run->depths.v[k], *at[RC_COMPONENTS];
    const struct rc_body *body = &run->options.body;
    const struct rc_fatigue_limits l = fatigue_limits_at(&run->limits, body, depth);
    double *to[RC_FATIGUES] = {NULL};

    tool_progress(t, (double)k / (double)run->depths.n, "depth %zu of %zu", k + 1, run->depths.n);
    for (int c = 0; c < RC_FATIGUES; c++)
        if (wanted(c))
            to[c] = run->problem.pass != 0 ? run->line[c] : run->frame[c]->v;
    tool_must(t, run->position[0].p,
              rc_fatigue_depth(f, depth, &l,
                               fatigue_residual_at(t, &run->residual, lines_of(run), depth, at), to,
                               &t->err));
    if (run->problem.pass != 0)
        set_row(run, k);
    for (int c = 0; c < RC_FATIGUES && run->problem.pass == 0 && !args.dry_run; c++) {
        if (!wanted(c))
            continue;
        tool_set_number(t, run->frame[c], "depth", depth);
        if (body->layers > 0)
            tool_set_number(t, run->frame[c], "material",
                            (double)rc_body_material(body, depth) + 1);
        tool_write(t, run->frame[c]);
    }
}

/* Processor seconds of a thread for all depths, from a trial of one; NAN: the memory does not suffice. */
static double
expect(struct run *run)
{
    const struct rc_grid *first = run->position[0].p;
    double began = tool_worked(), made;
    struct rc_fatigue *f;

    if (ranks_most(&run->t, run->needs > tool_memory_left(&run->t)) > 0)
        return NAN;
    f = tool_made(&run->t, first, rc_fatigue_new(rc_shape_of(first), &run->problem, &run->t.err));
    new_frames(run);
    made = tool_worked();
    do_depth(run, f, run->depths.n / 2);
    tool_progress_end(&run->t);
    free_frames(run);
    rc_fatigue_free(f);
    return (made - began + (double)run->depths.n * (tool_worked() - made)) / (double)run->t.threads;
}

static void
show_plan(struct run *run, const struct rc_shape *shape)
{
    const struct rc_grid *first = run->position[0].p;
    const struct rc_shape r = rc_fatigue_shape(shape, &run->problem);
    const double memory = ranks_most(&run->t, (double)tool_memory_with(run->needs));
    const double seconds = expect(run);
    const struct numbers *d = &run->depths;
    const struct plan plan = plan_begin(&run->t, &run->report, first, rc_grid_case(first),
                                        rc_boundary_word(run->options.boundary), "");

    if (args.pass == NULL)
        plan_say(&plan, "positions", "%zu", run->positions);
    plan_say(&plan, "depths", "%zu, %g to %g m", d->n, d->v[0], d->v[d->n - 1]);
    plan_say(&plan, "histories", "%zu at each depth", r.nx * r.ny);
    plan_effects(&plan, effects(run));
    plan_end(&plan, NAN, seconds, (size_t)memory);
}

static void
do_history(struct run *run)
{
    struct tool *t = &run->t;
    const struct rc_grid *first = run->position[0].p;
    const struct rc_shape shape = rc_grid_shape(first);
    const double began = tool_now();
    struct rc_fatigue *f;
    double *by_depth[RC_CRITERIA + 1];

    fatigue_limits_check(t, first, &run->limits, &run->options.body);
    if (args.pass == NULL && !travels(run) && run->positions > 1)
        tool_warn(t,
                  "%s: the %zu cases are taken as the states of one history, of a contact that "
                  "stays in its place; --pass x judges each case as a contact that passes",
                  t->input.source, run->positions);
    else if (args.pass == NULL && !travels(run))
        tool_warn(t,
                  "%s: this contact is loaded and unloaded in its place; --pass x judges one that "
                  "passes, as a roller does",
                  t->input.source);
    set_depths(run);
    set_problem(run);
    if (args.dry_run) {
        show_plan(run, &shape);
        return;
    }
    tool_must(t, first, ranks_agree(t, tool_ask_memory(t, &shape, run->needs, &t->err), &t->err));
    f = tool_made(t, first, rc_fatigue_new(&shape, &run->problem, &t->err));
    new_frames(run);
    for (int c = 0; c <= RC_CRITERIA; c++)
        by_depth[c] = tool_room(t, run->depths.n, sizeof(double), "the report");
    for (size_t k = 0; k < run->depths.n; k++) {
        do_depth(run, f, k);
        report_depth(run, f, run->depths.v[k], by_depth, k);
    }
    tool_progress_end(t);
    for (int c = 0; c < RC_FATIGUES; c++)
        if (run->frame[c] != NULL && run->problem.pass != 0)
            tool_write(t, run->frame[c]);
    free_frames(run);
    judge(run, f);
    report_all(run, f, by_depth, began);
    for (int c = 0; c <= RC_CRITERIA; c++)
        free(by_depth[c]);
    rc_fatigue_free(f);
}

static void
forget_history(struct run *run)
{
    for (size_t k = 0; k < run->positions; k++) {
        rc_grid_free(run->position[k].p);
        rc_grid_free(run->position[k].traction[0]);
        rc_grid_free(run->position[k].traction[1]);
    }
    run->positions = 0;
    for (int m = 0; m < 3; m++)
        free(run->map[m]);
    free(run->column);
    if (run->depths.v != args.depths.v)
        free(run->depths.v);
    stress_input_free(&run->input);
}

int
main(int argc, char **argv)
{
    static struct run run;
    struct rc_grid *p;

    tool_start(&run.t, &info, argc, argv, &args);
    check_arguments(&run);
    while ((p = tool_channel_with(&run.t, "pressure", take, &run)) != NULL) {
        if (args.pass != NULL && rc_grid_get(p, "position") != NULL)
            tool_refuse(&run.t, p,
                        "it is a position of a contact that travels: leave out --pass %s, which "
                        "repeats one pressure, or choose a position, as in rc-pick --case 1 and "
                        "--set position=",
                        args.pass);
        add_case(&run, p);
        if (args.pass == NULL)
            continue;
        do_history(&run);
        forget_history(&run);
    }
    if (run.positions > 0) {
        do_history(&run);
        forget_history(&run);
    }
    report_close(&run.report);
    report_close(&run.by_depth);
    fatigue_limits_free(&run.limits);
    fatigue_residual_free(&run.residual);
    free(run.position);
    free(args.depths.v);
    return tool_finish(&run.t);
}
