/*
 * K p and K delta of the method pcg: in single precision where the engine is the Fourier one.
 */
#include "pcg.h"

#include <math.h>

void
rc_pcg_convolve(struct rc_pcg_pass *c, rc_row *in, rc_row *out)
{
    struct rc_solver *solver = c->solver;
    size_t nx = solver->shape.nx, ny = solver->shape.ny;
    double *p = c->s->wide, *u = p + solver->n, unit = solver->length * solver->per_pressure;

    if (p == NULL) {
        rc_preconditioner_displace(solver->extension, in, out, c);
        solver->convolutions += 0.5;
        return;
    }
#pragma omp parallel for num_threads(solver->threads) schedule(static)
    for (size_t j = 0; j < ny; j++) {
        float *row = c->s->q + j * nx;
        bool any = in(c, j, row);
        for (size_t i = 0; i < nx; i++)
            p[j * nx + i] = any ? (double)row[i] : 0;
    }
    rc_conv_apply(solver->conv, p, u);
    solver->convolutions++;
#pragma omp parallel for num_threads(solver->threads) schedule(static)
    for (size_t j = 0; j < ny; j++) {
        float *row = c->s->q + j * nx;
        for (size_t i = 0; i < nx; i++)
            row[i] = (float)(u[j * nx + i] / unit);
        out(c, j, row);
    }
}

static bool
pressure_in(void *at, size_t j, void *to)
{
    const struct rc_solver *s = ((struct rc_pcg_pass *)at)->solver;
    size_t n = s->shape.nx;
    const double *p = s->p + j * n;
    float *row = to;
    bool any = false;

    for (size_t i = 0; i < n; i++) {
        row[i] = (float)(p[i] * s->per_pressure);
        any |= p[i] > 0;
    }
    return any;
}

static bool
gap_out(void *at, size_t j, void *from)
{
    const struct rc_solver *s = ((struct rc_pcg_pass *)at)->solver;
    size_t n = s->shape.nx;
    const float *row = from;
    const double *h = s->h + j * n;
    double *v = s->v + j * n, sum = 0;

    for (size_t i = 0; i < n; i++) {
        double u = (double)row[i];
        v[i] = u * s->length - h[i];
        sum += u * u;
    }
    rc_row_sums(s, j)[0] = sum;
    return true;
}

/* The first v of a grid; single precision will do for a while. */
void
rc_pcg_begin(struct rc_solver *solver, struct rc_pcg *s)
{
    struct rc_pcg_pass c = {.solver = solver, .s = s};
    double total[RC_SUMS];

    if (s->wide != NULL) {
        rc_solver_displace(solver);
        return;
    }
    rc_solver_rows_begin(solver);
    rc_pcg_convolve(&c, pressure_in, gap_out);
    rc_solver_rows_end(solver, total);
    s->drift = rc_pcg_single * sqrt(total[0] / (double)solver->n);
    solver->known = true;
    solver->fresh = false;
}
