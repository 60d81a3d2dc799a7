/*
 * Projected conjugate gradients with the extension preconditioner (extension.h): the iteration count
 * does not grow with the grid.
 *
 * Working set W: the elastic nodes and those at a bound that want to leave it. Residual r = -g on W
 * with zero mean, z = E' A E r with zero mean, direction by Polak and Ribiere, restarted when the
 * factor is negative; components that point out of the box are dropped. Exact line search, then the
 * Euclidean projection onto {0 <= p <= H, sum p = S}: one shift of the nodes of W. Scaling instead,
 * as in (31b) of Polonsky and Keer, fails near saturation; shifting all nodes drags every separated
 * one into contact.
 *
 * ||z||_1 / ||p||_1 estimates the error of the pressure and costs nothing here: z is at hand.
 */
#include "solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct state {
    double *u;        /* K p                                                            */
    double *r;        /* residual on W                                                  */
    double *d;        /* direction                                                      */
    double *q;        /* K d                                                            */
    double *old;      /* p before the last step                                         */
    double *r_old;    /* residual of the last step                                      */
    unsigned char *w; /* the working set that the preconditioner knows                  */
    double rz;        /* r'z of the last step; 0: the next direction is steepest descent */
    bool known;       /* u is K p, be it by recurrence                                  */
    bool fresh;       /* u is K p from a convolution                                    */
    struct rc_guard guard;
    bool set;         /* the preconditioner knows a set                                 */
};

static void
state_free(void *at)
{
    struct state *s = at;

    if (s == NULL)
        return;
    free(s->u);
    free(s->r);
    free(s->d);
    free(s->q);
    free(s->old);
    free(s->r_old);
    free(s->w);
    free(s);
}

/* ---- nested start ---- */

enum {
    COARSEST = 24 /* nodes a side from which a coarser grid is worth solving first */
};
static const double coarse_tol = 3e-2;

/* Mean of the (up to) four nodes under coarse node (i, j). */
static double
mean_height(const struct rc_solver *s, size_t i, size_t j)
{
    double sum = 0;
    size_t count = 0;

    for (size_t b = 2 * j; b < 2 * j + 2 && b < s->shape.ny; b++)
        for (size_t a = 2 * i; a < 2 * i + 2 && a < s->shape.nx; a++) {
            sum += s->h[b * s->shape.nx + a];
            count++;
        }
    return sum / (double)count;
}

/* The same contact on the grid of every second node, solved roughly (and there by the same start);
 * its pressure, repeated, is a better beginning than a constant one. Without memory for it, the
 * constant one stays. */
static void
nested_start(struct rc_solver *s)
{
    struct rc_shape coarse = {(s->shape.nx + 1) / 2, (s->shape.ny + 1) / 2, 2 * s->shape.dx,
                              2 * s->shape.dy};
    struct rc_problem problem = {.boundary = s->boundary, .estar = s->estar, .load = s->load,
                                 .hardness = s->hardness, .tol = fmax(coarse_tol, s->tol),
                                 .method = "pcg", .threads = s->threads};
    double *h;
    struct rc_solver *c;

    if (s->shape.nx < COARSEST || s->shape.ny < COARSEST)
        return;
    h = malloc(coarse.nx * coarse.ny * sizeof *h);
    if (h == NULL)
        return;
    for (size_t k = 0; k < coarse.nx * coarse.ny; k++)
        h[k] = mean_height(s, k % coarse.nx, k / coarse.nx);
    c = rc_solver_new(&coarse, h, &problem, NULL);
    if (c != NULL) {
        while (rc_solver_step(c) == RC_MORE)
            ;
        for (size_t k = 0; k < s->n; k++) {
            s->p[k] = c->p[k / s->shape.nx / 2 * coarse.nx + k % s->shape.nx / 2];
            s->g[k] = -s->h[k]; /* should nodes have to join, the highest first */
        }
        s->convolutions += c->convolutions * (double)c->n / (double)s->n;
        if (rc_box_balance(s->n, s->hardness, s->sum, s->g, s->p, NULL) != RC_OK)
            for (size_t k = 0; k < s->n; k++)
                s->p[k] = s->sum / (double)s->n;
        rc_solver_free(c);
    }
    free(h);
}

static void *
state_new(struct rc_solver *solver, struct rc_err *err)
{
    struct state *s = calloc(1, sizeof *s);
    size_t bytes = solver->n * sizeof(double);

    if (s != NULL) {
        s->u = malloc(bytes);
        s->r = calloc(solver->n, sizeof(double));
        s->d = calloc(solver->n, sizeof(double));
        s->q = malloc(bytes);
        s->old = malloc(bytes);
        s->r_old = malloc(bytes);
        s->w = malloc(solver->n);
    }
    if (s == NULL || s->u == NULL || s->r == NULL || s->d == NULL || s->q == NULL ||
        s->old == NULL || s->r_old == NULL || s->w == NULL) {
        rc_err_set(err, "out of memory for the iteration of %zu nodes", solver->n);
        state_free(s);
        return NULL;
    }
    s->guard.energy = INFINITY;
    nested_start(solver);
    return s;
}

/* Takes the mean over the nodes with w set from v. */
static void
remove_mean(size_t n, const unsigned char *w, double *v)
{
    double mean = 0;
    size_t count = 0;

    for (size_t k = 0; k < n; k++)
        if (w[k]) {
            mean += v[k];
            count++;
        }
    mean /= count == 0 ? 1 : (double)count;
    for (size_t k = 0; k < n; k++)
        if (w[k])
            v[k] -= mean;
}

/* W, its size, and r on it from u = K p. */
static size_t
residual(struct rc_solver *solver, struct state *s)
{
    double shift;
    size_t count = 0;

    rc_solver_gap(solver, s->u, solver->g, &shift);
    for (size_t k = 0; k < solver->n; k++) {
        solver->working[k] = rc_elastic(solver, k) || rc_wants_out(solver, k);
        count += solver->working[k];
        s->r[k] = solver->working[k] ? -solver->g[k] : 0;
    }
    remove_mean(solver->n, solver->working, s->r);
    return count;
}

/* z, and from it the estimate of the error. */
static double
precondition(struct rc_solver *solver, struct state *s)
{
    double sum = 0;

    if (!s->set || memcmp(s->w, solver->working, solver->n) != 0) {
        memcpy(s->w, solver->working, solver->n);
        rc_extension_set(solver->extension, s->w);
        solver->convolutions += 0.5;
        s->set = true;
    }
    rc_extension_apply(solver->extension, s->r, solver->z);
    solver->convolutions += 1.5;
    remove_mean(solver->n, s->w, solver->z);
    for (size_t k = 0; k < solver->n; k++)
        sum += fabs(solver->z[k]);
    return sum / solver->sum;
}

static void
displace(struct rc_solver *solver, struct state *s)
{
    rc_conv_apply(solver->conv, solver->p, s->u);
    solver->convolutions++;
    s->known = s->fresh = true;
}

/* Residual, preconditioned residual and estimate of p; before it is believed that p is good enough,
 * from a fresh convolution. */
static double
judge(struct rc_solver *solver, struct state *s)
{
    double estimate;

    for (;;) {
        if (!s->known)
            displace(solver, s);
        estimate = residual(solver, s) < 2 ? 0 : precondition(solver, s);
        if (estimate > solver->tol || s->fresh)
            return estimate;
        s->known = false;
    }
}

/* Polak and Ribiere: beta = z'(r - r_old) / r_old'z_old. */
static void
direct(struct rc_solver *solver, struct state *s)
{
    double above = 0, rz = 0, beta;

    for (size_t k = 0; k < solver->n; k++) {
        above += solver->z[k] * (s->r[k] - s->r_old[k]);
        rz += solver->z[k] * s->r[k];
    }
    beta = s->rz > 0 ? fmax(above / s->rz, 0) : 0;
    for (size_t k = 0; k < solver->n; k++) {
        double d = s->w[k] ? solver->z[k] + beta * s->d[k] : 0;
        bool out = (solver->p[k] <= 0 && d < 0) || (solver->p[k] >= solver->hardness && d > 0);
        s->d[k] = out ? 0 : d;
        solver->working[k] = s->w[k] && !out;
    }
    remove_mean(solver->n, solver->working, s->d);
    s->rz = rz;
}

/* p + alpha d, back into the box by one shift of W; false when nothing was out of it. */
static bool
move(struct rc_solver *solver, struct state *s, double alpha)
{
    double held = 0, carried = 0;
    bool out = false;
    size_t count = 0;

    for (size_t k = 0; k < solver->n; k++) {
        if (!s->w[k]) {
            held += solver->p[k];
            continue;
        }
        solver->p[k] += alpha * s->d[k];
        out |= solver->p[k] < 0 || solver->p[k] > solver->hardness;
        count++;
    }
    if (!out)
        return false;
    carried = solver->sum - held;
    if (carried > 0 && carried <= solver->hardness * (double)count)
        rc_box_project(solver->n, s->w, solver->hardness, carried, solver->p);
    else
        rc_box_project(solver->n, NULL, solver->hardness, solver->sum, solver->p);
    /* rounding leaves a little of the load over; should that fail, a little it is */
    (void)rc_box_balance(solver->n, solver->hardness, solver->sum, solver->g, solver->p, NULL);
    return true;
}

/* Relative L1 size of the last step. */
static double
change(const struct rc_solver *solver, const struct state *s)
{
    double sum = 0;

    for (size_t k = 0; k < solver->n; k++)
        sum += fabs(solver->p[k] - s->old[k]);
    return sum / solver->sum;
}

/* From the last p that was good, the step that is sure to lower the energy. */
static void
retreat(struct rc_solver *solver, struct state *s)
{
    rc_guard_step(&s->guard, solver, s->old, s->d, s->q);
    s->rz = 0;
    s->known = s->fresh = false;
    solver->change = change(solver, s);
}

static void
step(struct rc_solver *solver, void *at)
{
    struct state *s = at;
    double rd = 0, dq = 0, alpha;

    if (!s->known)
        displace(solver, s);
    if (rc_guard_raised(&s->guard, solver, s->u)) {
        retreat(solver, s);
        return;
    }
    memcpy(s->r_old, s->r, solver->n * sizeof *s->r);
    solver->estimate = judge(solver, s);
    solver->change = 0;
    if (solver->estimate <= solver->tol)
        return;
    direct(solver, s);
    rc_conv_apply(solver->conv, s->d, s->q);
    solver->convolutions++;
    for (size_t k = 0; k < solver->n; k++) {
        rd += s->r[k] * s->d[k];
        dq += s->d[k] * s->q[k];
    }
    memcpy(s->old, solver->p, solver->n * sizeof *s->old);
    if (!(dq > 0 && rd > 0)) { /* what is left of the direction leads nowhere */
        retreat(solver, s);
        return;
    }
    alpha = rd / dq;
    s->known = !move(solver, s, alpha);
    s->fresh = false;
    for (size_t k = 0; k < solver->n && s->known; k++)
        s->u[k] += alpha * s->q[k];
    solver->change = change(solver, s);
}

const struct rc_method rc_method_pcg = {
    .name = "pcg",
    .summary = "projected conjugate gradients with the extension preconditioner",
    .new = state_new,
    .step = step,
    .free = state_free,
};
