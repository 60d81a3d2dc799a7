/*
 * The direction of the method pcg, and with it the estimate of the error.
 */
#include "pcg.h"

#include <math.h>

enum { /* sums of z */
    Z,
    ZQ,
    Q
};

static bool
correction_done(void *at, size_t j, void *row)
{
    const struct rc_pcg_pass *c = at;
    size_t n = c->solver->shape.nx;
    const float *z = c->solver->z + j * n, *q = c->s->q + j * n;
    const unsigned char *w = c->solver->w + j * n;
    double sum = 0, product = 0, other = 0;

    (void)row;
    if (c->s->curvature > 0) {
#pragma omp simd reduction(+ : sum, product, other)
        for (size_t i = 0; i < n; i++) {
            double a = (double)z[i], b = (double)q[i];
            sum += a;
            product += a * b;
            other += w[i] ? b : 0;
        }
    } else {
#pragma omp simd reduction(+ : sum)
        for (size_t i = 0; i < n; i++)
            sum += (double)z[i];
    }
    rc_row_sums(c->solver, j)[Z] = sum;
    rc_row_sums(c->solver, j)[ZQ] = product;
    rc_row_sums(c->solver, j)[Q] = other;
    return true;
}

/* z becomes the direction: a is the mean of z, b beta. */
RC_CLONES static void
direct(size_t n, const double *restrict p, double hardness, const unsigned char *restrict w,
       const float *restrict delta, float mean, float beta, float *restrict z, double *sums)
{
    double size = 0, sum = 0;
    int kept = 0;

#pragma omp simd reduction(+ : size, sum, kept)
    for (size_t k = 0; k < n; k++) {
        float e = z[k] - mean, d = e + (beta != 0 ? beta * delta[k] : 0);
        bool out = ((p[k] <= 0) & (d < 0)) | ((p[k] >= hardness) & (d > 0)) | (w[k] == 0);
        size += w[k] ? (double)fabsf(e) : 0;
        d = out ? 0 : d;
        z[k] = d;
        sum += (double)d;
        kept += d != 0;
    }
    sums[0] = size;
    sums[1] = sum;
    sums[2] = kept;
}

static void
direct_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_pcg_pass *c = at;
    const struct rc_solver *s = c->solver;

    direct(n, s->p + first, s->hardness, s->w + first, c->s->delta + first, (float)c->a,
           (float)c->b, s->z + first, sums);
}

double
rc_pcg_precondition(struct rc_solver *solver, struct rc_pcg *s, double *mean)
{
    struct rc_pcg_pass c = {.solver = solver, .s = s};
    double total[RC_SUMS], above;

    if (solver->working < 2)
        return 0;
    rc_solver_rows_begin(solver);
    rc_solver_correct(solver, correction_done, &c);
    rc_solver_rows_end(solver, total);
    c.a = total[Z] / (double)solver->working;
    above = total[ZQ] - c.a * total[Q];
    c.b = s->curvature > 0 && above < 0 ? -above / s->curvature : 0;
    rc_solver_blocks(solver, direct_block, &c, total);
    *mean = total[2] > 0 ? total[1] / total[2] : 0;
    if (solver->elastic == 0 && solver->working > 0)
        return INFINITY; /* some want to move, but no gap says how far */
    return (total[0] + solver->aside) / solver->per_pressure / solver->sum +
           rc_solver_engine_error(solver);
}
