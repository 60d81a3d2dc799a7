/*
 * --travel: the contact travels along x over the map, a case a position. A ball (--radius) or the surface of
 * --counter is pressed on the whole map, or on a window that goes along. With --yield the plastic strain
 * stays in body 1, and --passes repeats the positions.
 */
#include "solve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

/* ---- the command line ---- */

static void
refuse(struct run *run, bool given, const char *what, const char *why)
{
    if (given)
        tool_usage(&run->d.t, "--travel does not work with %s: %s", what, why);
}

static void
read_window(struct run *run, const char *text)
{
    struct travelling *w = &run->travelling;
    char *end;

    w->window[0] = strtoul(text, &end, 10);
    w->window[1] = *end == 'x' ? strtoul(end + 1, &end, 10) : 0;
    if (*end != '\0' || strchr(text, '-') != NULL || w->window[0] == 0 || w->window[1] == 0)
        tool_usage(&run->d.t, "--window %s: it must be numbers of nodes, WxH, as in 256x256", text);
}

void
travel_read(struct run *run)
{
    static const char *const others[] = {"counter", "counter-travel", "window", "passes"};
    const struct solve_args *args = run->args;
    struct travelling *w = &run->travelling;
    struct tool *t = &run->d.t;

    w->wanted = args->travel.n > 0;
    for (size_t k = 0; k < 4; k++)
        if (!w->wanted && tool_given(t, others[k]))
            tool_usage(t, "--%s has no effect without --travel", others[k]);
    if (!w->wanted)
        return;
    if (isnan(args->physics.radius) && args->counter == NULL)
        tool_usage(t, "--travel: nothing travels: give a ball, --radius, or a surface, "
                      "--counter FILE");
    if (args->counter == NULL && tool_given(t, "counter-travel"))
        tool_usage(t, "--counter-travel has no effect without --counter");
    if (args->yield == NULL && tool_given(t, "passes"))
        tool_usage(t, "--passes has no effect without --yield: an elastic body does not "
                      "change from pass to pass");
    if (run->steps->n > 1)
        tool_usage(t,
                   "--travel takes one load, and this list has %zu: run rc-solve once "
                   "for each load",
                   run->steps->n);
    refuse(run, args->adhesion != NULL, "--adhesion", "it is not implemented");
    refuse(run, run->tilt, "--tilt free", "the bodies move along their normal only");
    refuse(run, args->discretization, "--discretization",
           "solve one position with it in a second command");
    refuse(run, args->physics.history && args->yield == NULL, "--history",
           "the dents of a hardness are not carried from position to position");
    refuse(run, args->window != NULL && args->yield != NULL, "--window and --yield",
           "the plastic strain belongs to the whole map");
    refuse(run, args->window != NULL && args->physics.periodic, "--window and --periodic",
           "a window is not a period");
    refuse(run, ranks_of(t) != NULL, "several processes", "take one");
    if (args->window != NULL)
        read_window(run, args->window);
    if (args->counter != NULL)
        w->counter = physics_counter(t, args->counter);
    w->passes = args->passes;
}

/* ---- a case ---- */

/* A map for the heights at a position, with the keys of the whole map. */
static struct rc_grid *
window_of(struct run *run, const struct rc_grid *g)
{
    const struct travelling *w = &run->travelling;
    struct rc_grid of = *g, *to;

    if (w->window[0] > g->nx || w->window[1] > g->ny)
        tool_refuse(&run->d.t, g, "--window %s is larger than the map of %zu x %zu nodes",
                    run->args->window, g->nx, g->ny);
    if (w->window[0] > 0) {
        of.nx = w->window[0];
        of.ny = w->window[1];
    }
    to = tool_frame_like(&run->d.t, &of, NULL, g->channel, g->unit);
    memset(to->v, 0, rc_grid_nodes(to) * sizeof *to->v);
    if (w->window[0] > 0)
        tool_set(&run->d.t, to, "periodic", NULL);
    return to;
}

void
travel_begin(struct run *run)
{
    struct travelling *w = &run->travelling;
    struct rc_grid *g = run->g;

    if (!w->wanted)
        return;
    if (run->hardness != NULL)
        tool_refuse(&run->d.t, g, "--travel with a map of hardness is not implemented");
    if (w->counter != NULL)
        physics_counter_beside(&run->d.t, run->args->counter, w->counter, g,
                               run->args->physics.periodic);
    w->track = g;
    run->g = window_of(run, g);
}

void
travel_end(struct run *run)
{
    struct travelling *w = &run->travelling;

    if (!w->wanted)
        return;
    rc_grid_free(run->g);
    run->g = w->track;
    free(w->row);
    w->row = NULL;
    w->rows = 0;
}

struct rc_model *
travel_model(struct run *run, struct rc_model *inner)
{
    const struct travelling *w = &run->travelling;
    const struct rc_grid *g = w->track, *other = w->counter;
    struct rc_travel_problem problem = {.track = rc_grid_shape(g),
                                        .h1 = g->v,
                                        .repeats = run->args->physics.periodic ||
                                                   map_says(g, "periodic", "yes"),
                                        .ratio = run->args->counter_travel};

    if (other != NULL) {
        problem.counter = rc_grid_shape(other);
        problem.h2 = other->v;
        problem.counter_repeats = run->args->physics.periodic || map_says(other, "periodic", "yes");
    }
    if (!isnan(run->args->physics.radius))
        problem.radius = run->args->physics.radius;
    return tool_made(&run->d.t, g, rc_travel_new(inner, &problem, &run->d.t.err));
}

size_t
travel_points(const struct run *run)
{
    return run->args->travel.n * run->travelling.passes;
}

size_t
travel_bytes(const struct run *run)
{
    const size_t maps = run->yielding.wanted ? 1 : 3;

    return run->travelling.wanted ? maps * sizeof(double) : 0;
}

double
travel_position(const struct run *run, size_t point)
{
    return run->args->travel.v[point % run->args->travel.n];
}

/* The map of the case changes with the position: the heights of body 1 are those of the track. */
void
travel_mark(struct run *run)
{
    const struct travelling *w = &run->travelling;
    struct course *c = &run->d.course;

    if (!w->wanted)
        return;
    course_mark_map(c, w->track->channel, w->track);
    course_mark_key(c, w->track, "periodic", "periodic");
    if (w->counter != NULL)
        course_mark_key(c, w->counter, "periodic", "counter.periodic");
}

/* ---- passes ---- */

/* The gain of a pass: the largest growth of the mean equivalent plastic strain of a row along x. */
static void
find_gain(struct run *run, const struct rc_model *m)
{
    struct travelling *w = &run->travelling;
    const struct rc_grid *g = run->g;
    const size_t rows = run->yielding.found->slabs * g->ny;
    double *to[RC_YIELD_STRAINS] = {NULL}, *peeq, *row;

    w->gain = 0;
    if (!run->yielding.on)
        return;
    peeq = tool_room(&run->d.t, g->nx * g->ny, sizeof *peeq, "plastic strain");
    row = tool_room(&run->d.t, rows, sizeof *row, "plastic strain");
    to[RC_PEEQ] = peeq;
    for (size_t q = 0; q < rows; q++) {
        if (q % g->ny == 0)
            (void)rc_yield_strain(m, q / g->ny, to);
        for (size_t i = 0; i < g->nx; i++)
            row[q] += peeq[q % g->ny * g->nx + i] / (double)g->nx;
        w->gain = fmax(w->gain, row[q] - (w->rows > 0 ? w->row[q] : 0));
    }
    free(peeq);
    free(w->row);
    w->row = row;
    w->rows = rows;
}

static size_t
pass_of(const struct run *run)
{
    return run->d.at / run->args->travel.n + 1;
}

/* Takes the heights of a position, before its figures are found. Frames are written in the last pass only. */
void
travel_look(struct run *run, struct rc_model *m)
{
    static const size_t none = 0;
    struct travelling *w = &run->travelling;

    if (!w->wanted)
        return;
    tool_must(&run->d.t, run->g, rc_model_frame(m, "height", run->g->v, &run->d.t.err));
    w->found = rc_travel_result(m);
    run->d.output = pass_of(run) < w->passes ? &none : &run->args->output;
}

/* Finds the figures of a pass at its last position. */
void
travel_end_pass(struct run *run, const struct rc_model *m)
{
    struct travelling *w = &run->travelling;

    w->gain = NAN;
    if (!w->wanted || !run->yielding.wanted || (run->d.at + 1) % run->args->travel.n != 0)
        return;
    find_gain(run, m);
    if (pass_of(run) == 1)
        w->first_gain = w->gain;
}

/* An elastic contact at a tolerance of 1e-4 still adds up to 3e-3 of the yield strain now and then. */
static const char *
shakedown(const struct run *run)
{
    static const double enough = 1e-2; /* of the first gain */
    const struct travelling *w = &run->travelling;

    return pass_of(run) == 1 || isnan(w->gain) ? NULL
           : w->gain <= enough * w->first_gain ? "yes"
                                               : "no";
}

void
travel_set_keys(struct run *run, struct rc_grid *as)
{
    const struct travelling *w = &run->travelling;

    if (!w->wanted)
        return;
    tool_set_number(&run->d.t, as, "position", w->found->position);
    tool_set_number(&run->d.t, as, "height", w->found->height);
    tool_set_number(&run->d.t, as, "window_x", w->found->window_x);
}

void
travel_report(struct report *r, const struct run *run)
{
    const struct figures from[] = {{rc_figures("travel"), run->travelling.found}, {NULL, NULL}};

    if (!run->travelling.wanted)
        return;
    report_named(r, from, "position height");
    report_count(r, "pass", pass_of(run), NULL);
    report_value(r, "strain_gain", run->travelling.gain);
    report_text(r, "shakedown", shakedown(run));
}

const char *
travel_state(const struct run *run)
{
    static char text[128];
    const struct travelling *w = &run->travelling;

    if (!w->wanted)
        return "left out: no --travel";
    snprintf(text, sizeof text, "on: %zu %s%s", run->args->travel.n,
             run->args->travel.n == 1 ? "position" : "positions",
             w->window[0] > 0 ? ", in a window" : ", on the whole map");
    return text;
}
