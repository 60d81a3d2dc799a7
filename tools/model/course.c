/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Steps a model to a point, with progress and checkpoints. */
#include "model.h"

#include <math.h>
#include <stdlib.h>

static void
save(struct course *c, struct rc_model *m)
{
    size_t n = rc_model_state_size(m);
    RC_OWNED double *v = malloc((n + 1) * sizeof *v);

    if (v == NULL)
        tool_refuse(c->t, c->g, "out of memory for a state of --checkpoint");
    rc_model_state(m, v);
    checkpoint_save(c, v, n);
}

void
course_set(struct course *c, struct rc_model *m, const struct rc_point *to)
{
    size_t n;
    RC_OWNED double *v = checkpoint_load(c, &n);
    bool going;

    c->resumed = v != NULL;
    if (v != NULL && rc_model_restore(m, v, n, &going, &c->t->err) != RC_OK)
        checkpoint_refuse(c, c->t->err.text);
    if (v == NULL && rc_model_go(m, to, &c->t->err) == RC_FAIL)
        tool_must(c->t, c->g, RC_FAIL);
}

/* ---- progress ---- */

/* Seconds until the error reaches the tolerance at its rate of decrease on this grid; NAN: unknown. */
static double
left(struct course *c, const struct rc_loops *l)
{
    const size_t nodes = l->grid.nx * l->grid.ny;
    const double iterations = l->n > 0 ? l->loop[l->n - 1].at : 0, now = tool_now();

    if (nodes != c->since.nodes || iterations <= c->since.iterations || isnan(c->since.error)) {
        c->since.nodes = nodes; /* another grid, or load */
        c->since.iterations = iterations;
        c->since.error = l->error;
        c->since.at = now;
        return NAN;
    }
    if (!(l->error < c->since.error) || !(l->error > l->tol) || nodes != c->g->nx * c->g->ny)
        return NAN;
    return log(l->error / l->tol) / log(c->since.error / l->error) * (now - c->since.at);
}

/* The share of the case that is done: on the map's own grid as the logarithm of the error falls, within the
 * increments; NAN: unknown. */
static double
share_done(const struct course *c, const struct rc_loops *l)
{
    double done = NAN;

    if (l->grid.nx * l->grid.ny == c->g->nx * c->g->ny && c->since.error > l->tol)
        done = fmin(fmax(log(c->since.error / l->error) / log(c->since.error / l->tol), 0), 1);
    for (size_t k = l->n; k-- > 0;)
        if (l->loop[k].of > 0)
            done = (l->loop[k].at - 1 + (isnan(done) ? 0 : done)) / l->loop[k].of;
    return done;
}

/* "case 2, 128 x 128, load 3 N, increment 4 of 16, application 2, error 1e-3 of 1e-4, about 3.1 s left" */
static void
show(struct course *c, const struct rc_loops *l)
{
    const double seconds = left(c, l);
    char text[256] = "";
    size_t at = 0;

    for (size_t k = 0; k < l->n && at < sizeof text; k++) {
        const struct rc_loop *loop = &l->loop[k];
        at += (size_t)snprintf(text + at, sizeof text - at, ", %s %.*g%s%s", loop->what,
                               loop->unit != NULL ? 3 : 15, loop->at, loop->unit != NULL ? " " : "",
                               loop->unit != NULL ? loop->unit : "");
        if (!isnan(loop->of) && at < sizeof text)
            at += (size_t)snprintf(text + at, sizeof text - at, " of %.15g", loop->of);
    }
    if (!isnan(l->error) && at < sizeof text)
        at +=
            (size_t)snprintf(text + at, sizeof text - at, ", error %.1e of %.1e", l->error, l->tol);
    if (!isnan(seconds) && at < sizeof text)
        snprintf(text + at, sizeof text - at, ", about %.*f s left", seconds < 10 ? 1 : 0, seconds);
    tool_progress(c->t, share_done(c, l), "case %zu, %zu x %zu%s", c->number, l->grid.nx,
                  l->grid.ny, text);
}

/* ---- steps ---- */

size_t
course_peak(size_t bytes)
{
    const size_t plans = 4 << 20; /* plans of FFTW, in both precisions */

    return tool_memory_with(size_sum(bytes, plans));
}

/* Seconds of a small contact on this machine over the expected ones, the least of 3 to 20 tries, which
 * together take about `work` seconds; 1: memory is short. They are processor seconds of one thread, so that
 * other processes do not change them: in wall clock, on a busy machine, the threads wait for each other. */
static double
slowness(double work)
{
    enum {
        SIDE = 256,
        FEWEST = 3,
        TRIES = 20
    };
    const double end = tool_worked() + work;
    const struct rc_shape shape = {SIDE, SIDE, 1, 1};
    struct rc_problem problem = {
        .boundary = RC_PERIODIC, .pair.estar = 1, .load = 300, .tol = 1e-4, .threads = 1};
    double *h = malloc((size_t)SIDE * SIDE * sizeof *h), least = INFINITY;
    struct rc_solver *s = NULL;
    struct rc_expected e;

    for (size_t k = 0; h != NULL && k < (size_t)SIDE * SIDE; k++)
        h[k] = cos(0.4 * (double)(k % SIDE)) * cos(0.1 * (double)(k / SIDE)) / 10;
    if (h != NULL && rc_solver_expect(&shape, &problem, &e, NULL) == RC_OK)
        s = rc_solver_new(&shape, h, &problem, NULL);
    for (int k = 0; s != NULL && k < TRIES && (k < FEWEST || tool_worked() < end) &&
                    rc_solver_set_load(s, 300 + k, 0, NULL) == RC_OK;
         k++) {
        const double start = tool_worked();
        while (rc_solver_step(s) == RC_MORE)
            continue;
        least = fmin(least, (tool_worked() - start) / rc_solver_convolutions(s));
    }
    rc_solver_free(s);
    free(h);
    return isinf(least) ? 1 : least * e.convolutions / e.seconds;
}

double
course_seconds(const struct rc_grid *g, double seconds, size_t points)
{
    const double start = 0.006, each = 0.0005; /* s of a process with its plans, and of a point */
    const double node = 90e-9; /* s to read and plan, and for the figures and frames of a point */
    const double work = seconds + node * (double)rc_grid_nodes(g) * (double)(points + 1);
    static double factor;

    /* The speed of the machine hardly matters for a shorter work than the start of the process. */
    if (factor == 0 && work > start / 4)
        factor = slowness(work);
    return (factor > 0 ? factor : 1) * work + start + each * (double)points;
}

void
course_plan(const struct plan *plan, const struct rc_grid *g, struct rc_expected expected,
            size_t points)
{
    plan_end(plan, expected.convolutions, course_seconds(g, expected.seconds, points),
             course_peak(expected.memory));
}

enum rc_status
course_run(struct course *c, struct rc_model *m)
{
    const double start = tool_now();
    enum rc_status status = RC_MORE;
    struct rc_loops loops;
    size_t steps = 0;

    rc_model_progress(m, &loops);
    while (tool_interrupted() == 0 && status == RC_MORE) {
        if (loops.coming > 0) {
            tool_demand_memory(c->t, c->g, loops.coming);
            save(c, m);
        }
        if ((status = rc_model_step(m, &c->t->err)) == RC_FAIL)
            tool_must(c->t, c->g, RC_FAIL);
        steps++;
        if (c->stepped != NULL)
            c->stepped(c, m);
        rc_model_progress(m, &loops);
        show(c, &loops);
        if (status == RC_MORE && loops.worth && checkpoint_due(c->checkpoint))
            save(c, m);
    }
    tool_progress_end(c->t);
    if (c->checkpoint != NULL &&
        (!c->resumed || steps > 2)) /* otherwise the file has this state already */
        save(c, m);
    c->iterate = tool_now() - start;
    return status;
}
