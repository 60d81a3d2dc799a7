/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fig. 1 of the paper. */
#include "paper.h"

#include "tests/contact_case.h"

static const double friction = 0.15;

struct errors {
    size_t iterations;
    double radius, pressure, mises;
};

static double
mises_error(struct rc_shape shape, struct hertz exact, const double *p, const char *engine)
{
    double *s[RC_STRESSES] = {NULL}, *truth, z = mises_depth(exact, paper_nu, friction), error;
    size_t n = shape.nx * shape.ny;
    struct rc_stress_options o = {.body.nu = paper_nu,
                                  .mu = friction,
                                  .wanted = 1u << RC_MISES,
                                  .engine = engine,
                                  .tol = strcmp(engine, "mlms") == 0 ? 0.1 / (double)n : 0,
                                  .threads = threads};
    struct rc_err err;
    struct rc_stress *stress = must(rc_stress_new(&shape, p, &o, &err));

    s[RC_MISES] = map_new(n);
    truth = map_new(n);
    must_be(rc_stress_slice(stress, z, s, &err), &err);
    for (size_t k = 0; k < n; k++) {
        double at[6];
        sliding_sphere(exact, paper_nu, friction, node_x(shape, k), node_y(shape, k), z, at);
        truth[k] = mises_of(at);
    }
    error = error_l1(n, s[RC_MISES], truth);
    rc_stress_free(stress);
    free(s[RC_MISES]);
    free(truth);
    return error;
}

/* The paper's eps_p: over the nodes in contact. */
static double
pressure_error(struct rc_shape shape, struct hertz exact, const double *p)
{
    double apart = 0, size = 0;

    for (size_t k = 0; k < shape.nx * shape.ny; k++)
        if (p[k] > 0) {
            double there = hertz_pressure(exact, node_r(shape, k));
            apart += fabs(p[k] - there);
            size += there;
        }
    return apart / size;
}

static struct errors
measured(size_t m, bool as_they_did)
{
    struct hertz exact = hertz(paper_load, paper_radius, paper_estar);
    double step = 2.1 * exact.a / (double)m, *h = map_new(m * m);
    struct rc_shape shape = {m, m, step, step};
    struct rc_problem problem = {.pair.estar = paper_estar,
                                 .load = paper_load,
                                 .tol = 0.01 * pow((double)m, -1.5),
                                 .threads = threads};
    struct rc_solver *solver;
    struct rc_contact c;
    struct errors e;
    bool done;

    rc_synth_sphere(&shape, paper_radius, h);
    if (as_they_did) {
        solver = paper_solve(shape, h, problem, &done);
    } else {
        solver = solver_new(shape, h, problem);
        solver_run(solver);
    }
    e.iterations = solver_progress(solver).iterations;
    e.pressure = pressure_error(shape, exact, rc_solver_pressure(solver));
    e.mises = mises_error(shape, exact, rc_solver_pressure(solver), as_they_did ? "mlms" : "fft");
    rc_solver_result(solver, NULL, NULL, &c);
    e.radius = fabs(sqrt(c.contact_area / exact_pi) / exact.a - 1);
    rc_solver_free(solver);
    free(h);
    return e;
}

void
fig1(void)
{
    enum {
        ROWS = 5
    };
    static const char *const title[] = {"converged: pcg and transforms, to a hundredth of M^(-3/2)",
                                        "as in the paper: pk99 and MLMS, stopped when the pressure "
                                        "changes by less than M^(-3/2), (32)"};

    printf("\nFig. 1: Hertz's contact, the map 2.1 a wide; Mises' stress at %.3f a, mu = %g, nu = "
           "%g\n",
           mises_depth((struct hertz){.a = 1, .p0 = 1}, paper_nu, friction), friction, paper_nu);
    for (int how = 0; how < 2; how++) {
        double rows[ROWS], e[3][ROWS];
        printf("%s\n%6s %6s %10s %8s %10s %8s %10s %8s\n", title[how], "M", "steps", "radius",
               "x M", "pressure", "x M^1.5", "Mises", "x M^2");
        for (int k = 0; k < ROWS; k++) {
            size_t m = (size_t)64 << k;
            struct errors at = measured(m, how == 1);
            rows[k] = (double)m;
            e[0][k] = at.radius;
            e[1][k] = at.pressure;
            e[2][k] = at.mises;
            printf("%6zu %6zu %10.2e %8.2f %10.2e %8.2f %10.2e %8.2f\n", m, at.iterations,
                   at.radius, at.radius * rows[k], at.pressure, at.pressure * pow(rows[k], 1.5),
                   at.mises, at.mises * rows[k] * rows[k]);
            fflush(stdout);
        }
        printf("%-13s %10.2f %8s %10.2f %8s %10.2f\n", "exponent", exponent(ROWS, rows, e[0]), "",
               exponent(ROWS, rows, e[1]), "", exponent(ROWS, rows, e[2]));
    }
}
