/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hard contacts as tables: each row is a contact. One function solves all of them and checks them against the
 * same bounds and, if it is known, the exact answer. */
#ifndef HARD_CASE_H
#define HARD_CASE_H

#include <float.h>

#include "tests/contact_case.h"
#include "libcontact/operator/operator.h"

enum {
    FREE = 1,
    PERIODIC = 2,
    BOTH = FREE | PERIODIC
};

struct hard_case {
    const char *name;
    struct rc_shape shape;
    unsigned boundaries;
    /* height of node k, in units of `unit` */
    double (*height)(struct rc_shape shape, size_t k, double a, uint64_t *seed);
    double a;        /* parameter of this function                    */
    double unit;     /* m                                             */
    double mean;     /* mean pressure over E*                         */
    double hardness; /* over the mean pressure; 0: none               */
    double estar;    /* Pa; 0: 114 GPa                                */
    /* The error against the known answer, over the permitted error; NULL: the answer is unknown. */
    double (*truth)(const struct hard_case *c, const struct rc_problem *problem, const double *h,
                    const struct solved *s);
    double tol; /* requested accuracy; 0: hard_tol */
};

/* The bounds of every case, and the requested accuracy. If the roughness is small compared with the
 * displacement, a pressure accurate to 1e-8 may not give a gap accurate to 1e-9 of the displacement. */
static const double hard_error = 1e-8, hard_kkt = 1e-9, hard_tol = 1e-12;

static inline double *
hard_heights(const struct hard_case *c)
{
    size_t n = c->shape.nx * c->shape.ny;
    double *h = malloc(n * sizeof *h);
    uint64_t seed = 3;

    assert_non_null(h);
    for (size_t k = 0; k < n; k++)
        h[k] = c->unit * c->height(c->shape, k, c->a, &seed);
    return h;
}

/* The bodies of all cases if they have layers; else each case has its own E*. */
static struct rc_pair hard_pair = {.estar = 0};

static inline void
hard_bodies(struct rc_solids *bodies)
{
    struct rc_err err;

    *bodies = (struct rc_solids){.n = 0};
    if (hard_pair.one.layers > 0)
        assert_int_equal(rc_solids_new(bodies, &hard_pair, NULL, NULL, &err), RC_OK);
}

/* The effective E* for a wave of wave number q. */
static inline double
hard_modulus(const struct hard_case *c, const struct rc_solids *bodies, double q)
{
    return bodies->n > 0 ? rc_solids_modulus(bodies, q) : c->estar > 0 ? c->estar : 114e9;
}

static inline struct rc_problem
hard_problem(const struct hard_case *c, struct rc_boundary boundary)
{
    struct rc_solids bodies;
    double estar, mean;

    hard_bodies(&bodies);
    estar = hard_modulus(c, &bodies, 2 * exact_pi / (8 * c->shape.dx));
    mean = c->mean * estar;
    rc_solids_free(&bodies);
    return (struct rc_problem){
        .boundary = boundary,
        .pair = hard_pair.one.layers > 0 ? hard_pair : (struct rc_pair){.estar = estar},
        .load = mean * c->shape.dx * c->shape.dy * (double)(c->shape.nx * c->shape.ny),
        .hardness = c->hardness > 0 ? c->hardness * mean : INFINITY,
        /* if most nodes yield the few others carry little load: their gaps need a higher accuracy */
        .tol = c->tol > 0        ? c->tol
               : c->hardness > 0 ? 0.3 * hard_tol
                                 : hard_tol,
        .method = "pcg",
    };
}

/* u = K p by independent methods. On small free maps it is the direct sum; on periodic maps it is 2 / (E*
 * |q|) with a transform that the solver does not use. If one axis repeats it is the engine, which
 * truth_line_operator compares with closed forms. */
static inline void
hard_displace(const struct hard_case *c, const struct rc_problem *problem, const double *p,
              double *u)
{
    struct rc_shape s = c->shape;
    size_t columns = rc_fourier_columns(&s), n = s.nx * s.ny;
    double complex *f;
    struct rc_solids bodies;
    struct rc_err err;

    if (rc_has_mean(problem->boundary)) {
        const bool direct = rc_repeats(problem->boundary) == 0 && n <= 5000;
        struct rc_conv_options options = {.boundary = problem->boundary,
                                          .engine = direct ? "direct" : "fft"};
        struct rc_conv *conv = rc_conv_new(&s, &problem->pair, &options, &err);
        assert_non_null(conv);
        rc_conv_apply(conv, p, u);
        rc_conv_free(conv);
        return;
    }
    f = malloc(rc_fourier_size(&s) * sizeof *f);
    assert_non_null(f);
    hard_bodies(&bodies);
    assert_int_equal(rc_fourier_forward(&s, p, f, &err), RC_OK);
    for (size_t j = 0; j < s.ny; j++)
        for (size_t i = 0; i < columns; i++) {
            double qx = 2 * exact_pi * (double)i / (s.dx * (double)s.nx);
            double qy = 2 * exact_pi * (double)rc_fourier_number(j, s.ny) / (s.dy * (double)s.ny);
            double q = hypot(qx, qy);
            f[j * columns + i] *= q > 0 ? 2 / (hard_modulus(c, &bodies, q) * q * (double)n) : 0;
        }
    assert_int_equal(rc_fourier_backward(&s, f, u, &err), RC_OK);
    rc_solids_free(&bodies);
    free(f);
}

/* The displacement by a uniform pressure. It is that in the middle of a free map (Love) or of a strip, and on
 * a periodic map that of a wave of the map's length. */
static inline double
hard_depth(const struct hard_case *c, const struct rc_problem *problem)
{
    double a = c->shape.dx * (double)c->shape.nx, b = c->shape.dy * (double)c->shape.ny;
    double mean = problem->load / (a * b);
    struct rc_solids bodies;
    double estar;

    hard_bodies(&bodies);
    estar = hard_modulus(c, &bodies, 2 * exact_pi / fmax(a, b));
    rc_solids_free(&bodies);
    if (rc_repeats(problem->boundary) == 1)
        return mean * 2 * (problem->boundary.x ? b : a) * (1 + log(2)) / (exact_pi * estar);
    return rc_repeats(problem->boundary) == 0 ? mean * love_displacement(0, 0, a / 2, b / 2, estar)
                                              : mean * fmax(a, b) / (exact_pi * estar);
}

/* The bound of the KKT residual. If the heights differ by less than 1e-7 of the displacement, the rounding
 * error of the displacement exceeds 1e-9 of this difference. No solver can do better. The bound is then 200
 * units of rounding. */
static inline double
hard_bound(const struct hard_case *c, const struct rc_problem *problem, const double *h)
{
    size_t n = c->shape.nx * c->shape.ny;
    double mean = 0, spread = 0;

    for (size_t k = 0; k < n; k++)
        mean += (h[k] - h[0]) / (double)n;
    for (size_t k = 0; k < n; k++)
        spread += pow(h[k] - h[0] - mean, 2);
    spread = sqrt(spread / (double)n);
    return hard_kkt + (spread > 0 ? 200 * DBL_EPSILON * hard_depth(c, problem) / spread : 0);
}

/* The KKT residual of p. */
static inline double
hard_violation(const struct hard_case *c, const struct rc_problem *problem, const double *h,
               const double *p)
{
    size_t n = c->shape.nx * c->shape.ny, elastic = 0;
    double *u = malloc(n * sizeof *u), mean_u = 0, mean_h = 0, shift = 0, worst = 0;
    double low = -INFINITY, high = INFINITY, spread_u = 0, spread_h = 0, scale;

    assert_non_null(u);
    hard_displace(c, problem, p, u);
    for (size_t k = 0; k < n; k++) {
        double v = u[k] - (h[k] - h[0]);
        mean_u += u[k] / (double)n;
        mean_h += (h[k] - h[0]) / (double)n;
        if (p[k] <= 0)
            high = fmin(high, v);
        else if (p[k] >= problem->hardness)
            low = fmax(low, v);
        else if (++elastic > 0)
            shift += v;
    }
    shift = elastic > 0   ? shift / (double)elastic
            : isinf(high) ? low
            : isinf(low)  ? high
                          : (low + high) / 2;
    for (size_t k = 0; k < n; k++) {
        double g = u[k] - (h[k] - h[0]) - shift;
        spread_u += pow(u[k] - mean_u, 2);
        spread_h += pow(h[k] - h[0] - mean_h, 2);
        worst = larger(worst, p[k] <= 0 ? -g : p[k] >= problem->hardness ? g : fabs(g));
    }
    /* under stiff coats of a map that repeats along one axis the mean displacement may be 1e5 of the
     * spread */
    worst = rc_repeats(problem->boundary) == 1 ? larger(worst - 200 * DBL_EPSILON * fabs(mean_u), 0)
                                               : worst;
    scale = sqrt(larger(spread_u, spread_h) / (double)n);
    if (spread_h ==
        0) /* all heights are equal: relative to the displacement by the mean pressure */
        scale = hard_depth(c, problem);
    free(u);
    return worst == 0 ? 0 : worst / scale;
}

static inline bool
hard_holds(const struct hard_case *c, struct rc_boundary boundary)
{
    struct rc_problem problem = hard_problem(c, boundary);
    double *h = hard_heights(c), off = 0, kkt = NAN, load = NAN, bound = NAN;
    struct solved s = solve(c->shape, h, problem);
    size_t n = c->shape.nx * c->shape.ny;
    bool holds = s.status == RC_OK && s.c.pressure_error <= hard_error, in_box = true;

    if (s.status != RC_FAIL) {
        long double sum = 0;
        for (size_t k = 0; k < n; k++) {
            sum += s.p[k];
            in_box = in_box && s.p[k] >= 0 && s.p[k] <= problem.hardness;
        }
        load = (double)(sum * c->shape.dx * c->shape.dy / problem.load - 1);
        kkt = larger(s.c.kkt_residual, hard_violation(c, &problem, h, s.p));
        bound = hard_bound(c, &problem, h);
        off = c->truth == NULL ? 0 : c->truth(c, &problem, h, &s);
        holds = holds && in_box && fabs(load) <= summed && kkt <= bound && off <= 1;
    }
    print_message("%s %-28s %-10s %4zu its %6.0f conv, contact %.4f, plastic %zu: error %.1e, KKT "
                  "%.1e, load %.0e",
                  holds ? "  " : "##", c->name, rc_boundary_word(boundary), s.c.iterations,
                  s.c.convolutions, s.c.contact_fraction, s.c.plastic_nodes, s.c.pressure_error,
                  kkt, load);
    if (bound > 2 * hard_kkt)
        print_message(" (%.0e by rounding)", bound);
    if (c->truth != NULL)
        print_message(", truth %.2f", off);
    print_message("%s%s\n",
                  s.status == RC_FAIL    ? ": "
                  : s.status == RC_SHORT ? ": short"
                                         : "",
                  s.status == RC_FAIL ? s.err.text : "");
    solved_free(&s);
    free(h);
    return holds;
}

static inline size_t
hard_failures(const struct hard_case *c)
{
    static size_t turn;
    size_t failed = 0;

    if (c->boundaries & FREE)
        failed += !hard_holds(c, RC_FREE);
    if (c->boundaries & PERIODIC)
        failed += !hard_holds(c, RC_PERIODIC);
    /* with every commit every second case, in turns along x and y */
    if (c->boundaries == BOTH && (turn % 4 == 0 || thorough(true, false)))
        failed += !hard_holds(c, rc_boundary_of(true, false));
    if (c->boundaries == BOTH && (turn % 4 == 2 || thorough(true, false)))
        failed += !hard_holds(c, rc_boundary_of(false, true));
    turn++;
    return failed;
}

static inline void
hard_run(const struct hard_case *cases, size_t n)
{
    size_t failed = 0;

    for (size_t k = 0; k < n; k++)
        failed += hard_failures(&cases[k]);
    assert_int_equal(failed, 0);
}

#define HARD_RUN(cases) hard_run(cases, sizeof cases / sizeof *cases)

/* Uniform noise, used by several tables. */
static inline double
hard_noise(struct rc_shape shape, size_t k, double a, uint64_t *seed)
{
    (void)shape, (void)k, (void)a;
    return random_number(seed);
}

#endif
