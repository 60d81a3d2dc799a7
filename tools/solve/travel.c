/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * --travel: the contact travels along x over the map, a case a position. A ball (--radius), a roller
 * (--cylinder) or the surface of --counter is pressed on the whole map, or on a window that goes along. With
 * --yield the plastic strain stays in body 1, and --passes repeats the positions.
 */
#include "solve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

static struct {
    struct numbers travel;        /* positions of the contact */
    const char *counter, *window; /* words of the command line, or NULL */
    double counter_travel;
    size_t passes;
} args = {.counter_travel = 1, .passes = 1};

static struct {
    struct numbers positions; /* of all passes */
    size_t window[2];
    struct rc_grid *counter, *track; /* heights of body 2 (NULL: none), and of body 1 */
    const struct rc_travel_figures *found;
    double *row; /* mean equivalent plastic strain of each row of each slab, after the last pass */
    size_t rows; /* 0: nothing has yielded */
    double gain, first_gain; /* largest growth of such a mean in a pass, and in the first one */
} own;

/* ---- the command line ---- */

/* clang-format off */
static const struct opt options[] = {
    {.name = "travel", .type = OPT_NUMBERS, .unit = UNIT_M, .base = &args.travel, .min = -INFINITY,
     .max = INFINITY, .result = true, .points = true, .arg = "LIST",
     .needs = RULES({.with = "radius|cylinder|counter", .because = "nothing travels"}),
     .against = RULES({.with = "load LIST|mean-pressure LIST|approach LIST",
                       .remedy = "run rc-solve once for each load"},
                      {.with = "adhesion", .because = "it is not implemented"},
                      {.with = "tilt free", .because = "the bodies move along their normal only"},
                      {.with = "discretization", .remedy = "solve one position with it in a second command"}),
     .help = "the contact travels over the map: its positions along x, from the middle of the "
             "map, each a case"},
    {.name = "counter", .type = OPT_TEXT, .base = &args.counter, .result = true, .arg = "FILE",
     .needs = RULES({.with = "travel"}),
     .help = "heights of body 2, which travels (or a ball: --radius, a roller: --cylinder); mirrored as "
             "by rc-add"},
    {.name = "counter-travel", .type = OPT_NUMBER, .base = &args.counter_travel, .min = -INFINITY,
     .max = INFINITY, .result = true, .arg = "RATIO",
     .needs = RULES({.with = "travel"}, {.with = "counter"}),
     .help = "how far body 2 moves for each metre of the contact: 1 (default) slides, 0 rolls"},
    {.name = "window", .type = OPT_TEXT, .base = &args.window, .result = true, .arg = "WxH",
     .needs = RULES({.with = "travel"}),
     .against = RULES({.with = "yield", .because = "the plastic strain belongs to the whole map"}),
     .help = "with --travel, solve so many nodes around the contact (default: the whole map)"},
    {.name = "passes", .type = OPT_COUNT, .base = &args.passes, .min = 1, .max = 1e6, .result = true,
     .points = true, .arg = "N",
     .needs = RULES({.with = "travel"},
                    {.with = "yield", .because = "an elastic body does not change from pass to pass"}),
     .help = "with --travel and --yield, go through the positions N times (default 1)"},
    {.name = NULL},
};
/* clang-format on */

static void
read_window(struct run *run, const char *text)
{
    char *end;

    own.window[0] = strtoul(text, &end, 10);
    own.window[1] = *end == 'x' ? strtoul(end + 1, &end, 10) : 0;
    if (*end != '\0' || strchr(text, '-') != NULL || own.window[0] == 0 || own.window[1] == 0)
        tool_usage(&run->d.t, "--window %s: it must be numbers of nodes, WxH, as in 256x256", text);
}

static bool
ask(struct run *run)
{
    const bool on = args.travel.n > 0;

    run->physics->travels = on;
    return on;
}

static void
read(struct run *run)
{
    const char *half =
        run->args->increments != NULL ? strstr(run->args->increments, ",half") : NULL;
    struct tool *t = &run->d.t;

    if (half != NULL)
        tool_usage(
            t, "--increments %s: a contact that travels has no second run: give --increments %.*s",
            run->args->increments, (int)(half - run->args->increments), run->args->increments);
    if (tool_given(t, "history") && SOLVE_FIRST(run, sequence) == NULL)
        tool_usage(t,
                   "--travel does not work with --history, because the dents of a hardness are not "
                   "carried from position to position");
    if (!isnan(run->physics->cylinder) && run->physics->boundary.x && !run->physics->boundary.y)
        tool_usage(t, "--travel does not work with --cylinder and --periodic=x, because the "
                      "cylinder would travel along its axis: take --periodic=y");
    if (args.window != NULL && run->physics->boundary.x)
        tool_usage(t,
                   "--window does not work with --periodic%s, because a window is not a period: "
                   "leave out one of them, or take --periodic=y",
                   run->physics->boundary.y ? "" : "=x");
    if (args.window != NULL)
        read_window(run, args.window);
    if (args.counter != NULL)
        own.counter = physics_counter(t, args.counter);
    own.positions.n = args.travel.n * args.passes;
    own.positions.v = tool_room(t, own.positions.n, sizeof *own.positions.v, "the positions");
    for (size_t k = 0; k < own.positions.n; k++)
        own.positions.v[k] = args.travel.v[k % args.travel.n];
}

/* ---- a case ---- */

/* A map for the heights at a position, with the keys of the whole map. */
static struct rc_grid *
window_of(struct run *run, const struct rc_grid *g)
{
    struct rc_grid of = *g, *to;

    if (own.window[0] > g->nx || own.window[1] > g->ny)
        tool_refuse(&run->d.t, g, "--window %s is larger than the map of %zu x %zu nodes",
                    args.window, g->nx, g->ny);
    if (run->physics->boundary.y && own.window[0] > 0 && own.window[1] != g->ny)
        tool_refuse(&run->d.t, g,
                    "--window %s: with --periodic=y it has the rows of the map: take %zux%zu",
                    args.window, own.window[0], g->ny);
    if (own.window[0] > 0) {
        size_t first, rows;
        of.nx = own.window[0];
        of.ny = own.window[1];
        ranks_rows(&run->d.t, rc_shape_of(&of), &first, &rows);
        of.elsewhere = of.ny - rows;
    }
    to = tool_frame_like(&run->d.t, &of, NULL, g->channel, g->unit);
    memset(to->v, 0, rc_grid_nodes(to) * sizeof *to->v);
    if (own.window[0] > 0)
        tool_set(&run->d.t, to, "periodic",
                 run->physics->boundary.y && map_repeats(g).y ? "y" : NULL);
    return to;
}

static void
open(struct run *run)
{
    struct rc_grid *g = run->g;

    if (run->bound_varies)
        tool_refuse(&run->d.t, g, "--travel with a map of hardness is not implemented");
    if (own.counter != NULL)
        physics_counter_beside(&run->d.t, args.counter, own.counter, g, run->physics->boundary);
    own.track = g;
    run->g = window_of(run, g);
}

static void
close(struct run *run)
{

    rc_grid_free(run->g);
    run->g = own.track;
    free(own.row);
    own.row = NULL;
    own.rows = 0;
}

static struct rc_model *
put_around(struct run *run, struct rc_model *inner)
{
    const struct rc_grid *g = own.track, *other = own.counter;
    struct rc_travel_problem problem = {.track = rc_grid_shape(g),
                                        .h1 = g->v,
                                        .repeats = run->physics->boundary.x || map_repeats(g).x,
                                        .ratio = args.counter_travel};

    if (other != NULL) {
        problem.counter = rc_grid_shape(other);
        problem.h2 = other->v;
        problem.counter_repeats = run->physics->boundary.x || map_repeats(other).x;
    }
    if (!isnan(run->physics->radius))
        problem.radius = run->physics->radius;
    problem.cylinder = !isnan(run->physics->cylinder);
    if (problem.cylinder)
        problem.radius = run->physics->cylinder;
    return tool_made(&run->d.t, g, rc_travel_new(inner, &problem, &run->d.t.err));
}

/* Over the work of the first position. */
static double
loads_cost(const struct run *run)
{
    const double step = 0.8;

    return 1 + step * ((double)run->cases - 1);
}

/* The maps of the model. */
static size_t
bytes(const struct run *run)
{
    const size_t maps = run->physics->history ? 1 : 3;

    return maps * sizeof(double);
}

/* The map of the case changes with the position: the heights of body 1 are those of the track. */
static void
mark(struct run *run)
{
    struct course *c = &run->d.course;

    course_mark_map(c, own.track->channel, own.track);
    course_mark_key(c, own.track, "periodic", "periodic");
    if (own.counter != NULL)
        course_mark_key(c, own.counter, "periodic", "counter.periodic");
}

/* ---- passes ---- */

/* The gain of a pass: the largest growth of the mean equivalent plastic strain of a row along x. */
static void
find_gain(struct run *run, const struct rc_model *m, size_t slabs)
{
    const struct rc_grid *g = run->g;
    const size_t ny = g->ny - g->elsewhere, rows = slabs * ny; /* of this process */
    double *to[RC_YIELD_STRAINS] = {NULL}, *peeq, *row;

    own.gain = 0;
    if (slabs == 0)
        return;
    peeq = tool_room(&run->d.t, g->nx * ny, sizeof *peeq, "plastic strain");
    row = tool_room(&run->d.t, rows, sizeof *row, "plastic strain");
    to[RC_PEEQ] = peeq;
    for (size_t q = 0; q < rows; q++) {
        if (q % ny == 0)
            (void)rc_yield_strain(m, q / ny, to);
        for (size_t i = 0; i < g->nx; i++)
            row[q] += peeq[q % ny * g->nx + i] / (double)g->nx;
        own.gain = fmax(own.gain, row[q] - (own.rows > 0 ? own.row[q] : 0));
    }
    own.gain = ranks_most(&run->d.t, own.gain);
    free(peeq);
    free(own.row);
    own.row = row;
    own.rows = rows;
}

static size_t
pass_of(const struct run *run)
{
    return run->d.at / args.travel.n + 1;
}

/* Takes the heights of a position and, at the last one of a pass, the figures of the pass. Frames are
 * written in the last pass only. */
static bool
look(struct run *run, struct rc_model *m, struct solution *s)
{
    static const size_t none = 0;
    const struct rc_yield_figures *shaped = rc_yield_result(m);

    (void)s;
    tool_must(&run->d.t, run->g, rc_model_frame(m, "height", run->g->v, &run->d.t.err));
    own.found = rc_travel_result(m);
    run->d.output = pass_of(run) < args.passes ? &none : &run->args->output;
    own.gain = NAN;
    if (shaped == NULL || (run->d.at + 1) % args.travel.n != 0)
        return true;
    find_gain(run, m, shaped->yielded ? shaped->slabs : 0);
    if (pass_of(run) == 1)
        own.first_gain = own.gain;
    return true;
}

/* The longest row of nodes in contact along x, in m. */
static double
longest(const struct run *run)
{
    const struct rc_grid *g = run->g;
    const double *p = run->solver != NULL ? rc_solver_pressure(run->solver) : NULL;
    size_t most = 0;

    for (size_t j = 0; j < g->ny - g->elsewhere && p != NULL; j++)
        for (size_t i = 0, now = 0; i < 2 * g->nx; i++) { /* twice: a row may wrap */
            now = rc_in_contact(p[j * g->nx + i % g->nx]) ? now + 1 : 0;
            most = now > most ? now : most;
        }
    return ranks_most(&run->d.t, (double)(most < g->nx ? most : g->nx)) * g->dx;
}

/* After steps above 0.4 of the half width of the contact, and where less than five voxels in a row flow, 96
 * of 366 estimated errors of the steps were below the error, down to 0.32 times it; none of 210 others
 * (tests/long/estimates.py). Each voxel that begins to flow changes the pressure at once. Voxels that flowed
 * in an earlier pass hardly flow. */
static void
judge(struct run *run, const char *where, const struct solution *s)
{
    const double share = 0.2; /* of the width */
    const size_t k = run->d.at, enough = 5;
    const struct rc_yield_figures *shaped = rc_yield_result(run->model);
    const double width = longest(run),
                 step = k > 0 ? fabs(own.positions.v[k] - own.positions.v[k - 1]) : 0;
    double flowing;

    (void)s;
    if (shaped == NULL || k % args.travel.n == 0)
        return;
    flowing = shaped->last.flow_length / run->g->dx;
    if (step > share * width * (1 + 1e-9))
        course_warn(
            &run->d.course, "steps too long for the estimated error",
            "%s: the contact has moved %s, more than a fifth of its width of %s: the error of "
            "the steps may be twice the estimate: take shorter steps in --travel",
            where, shown_in_unit(step, "m"), shown_in_unit(width, "m"));
    else if (pass_of(run) == 1 && flowing > 0 && flowing < (double)enough)
        course_warn(&run->d.course, "a grid too coarse for the estimated error",
                    "%s: the longest row of voxels that flow has %.0f, less than %zu: the error of "
                    "the steps may be three times the estimate: take a finer grid",
                    where, flowing, enough);
}

/* An elastic contact at a tolerance of 1e-4 still adds up to 3e-3 of the yield strain now and then. */
static const char *
shakedown(const struct run *run)
{
    static const double enough = 1e-2; /* of the first gain */

    return pass_of(run) == 1 || isnan(own.gain)  ? NULL
           : own.gain <= enough * own.first_gain ? "yes"
                                                 : "no";
}

static void
set_keys(struct run *run, struct rc_grid *as)
{

    tool_set_number(&run->d.t, as, "position", own.found->position);
    tool_set_number(&run->d.t, as, "height", own.found->height);
    tool_set_number(&run->d.t, as, "window_x", own.found->window_x);
}

static void
report(struct report *r, const struct run *run)
{
    const struct figures from[] = {{rc_figures("travel"), own.found}, {NULL, NULL}};

    report_named(r, from, "position height");
    report_count(r, "pass", pass_of(run), NULL);
    report_value(r, "strain_gain", own.gain);
    report_text(r, "shakedown", shakedown(run));
}

static const char *
state(const struct run *run)
{
    static char text[128];

    (void)run;
    snprintf(text, sizeof text, "on: %zu %s%s", args.travel.n,
             args.travel.n == 1 ? "position" : "positions",
             own.window[0] > 0 ? ", in a window" : ", on the whole map");
    return text;
}

const struct effect solve_effect_travel = {
    .name = "travel",
    .title = "travel",
    .options = options,
    .ask = ask,
    .read = read,
    .follows = true,
    .map = {"counter", &own.counter},
    .open = open,
    .close = close,
    .mark = mark,
    .axis = RC_POSITION,
    .list = &own.positions,
    .noun = "position",
    .outer = put_around,
    .loads = loads_cost,
    .bytes = bytes,
    .look = look,
    .keys = set_keys,
    .judge = judge,
    .off = "left out: no --travel",
    .state = state,
    .report = report,
};
