/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The elastic model gives the results of rc_solver to the last bit. The cases are loads and approaches, a
 * history with a hardness, a counter body that tilts, and layers. Others are stiffness and conductance, and
 * heights that are set later. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "libcontact/yield/yield.h"

enum {
    NX = 40,
    NY = 28,
    N = NX * NY
};

static const struct rc_shape shape = {NX, NY, 1.1e-6, 1e-6};
static const struct rc_layer layer = {2e-6, 3e9, 0.3};
static double h[N], left[N], p[N], want[N];

struct sample {
    const char *name;
    struct rc_problem problem;
    bool by_approach, keeps;
    double at[3];
};
static const struct sample samples[] = {
    {"loads", {.pair.estar = 1e9}, false, false, {1e-3, 4e-3, 2e-3}},
    {"approaches", {.pair.estar = 1e9, .tol = 1e-5}, true, false, {5e-7, 8e-7, 6e-7}},
    {"a history",
     {.pair.estar = 1e9, .hardness = 5e7, .history_part = .05},
     false,
     true,
     {3e-3, 1e-3, 4e-3}},
    {"a periodic history",
     {.boundary = {.x = true, .y = true}, .pair.estar = 1e9, .hardness = 5e7},
     false,
     true,
     {3e-3, 0, 4e-3}},
    {"tilt", {.pair.estar = 1e9, .tilt_free = true}, false, false, {1e-3, 2e-3, 3e-3}},
    {"layers",
     {.pair.one = {1e9, 0.3, 1, &layer}, .discretization = true},
     false,
     false,
     {1e-3, 2e-3, 3e-3}},
};
static const double k1 = 45, k2 = 16;

/* Solves point k with the solver; fills c, and writes the shape after it to `left`. */
static void
by_solver(const struct sample *s, struct rc_solver **solver, int k, struct rc_contact *c,
          double *stiffness, struct rc_conductance *conductance)
{
    struct rc_problem problem = s->problem;
    const double load = s->by_approach ? 0 : s->at[k], approach = s->by_approach ? s->at[k] : 0;
    struct rc_err err = {""};

    problem.load = load;
    problem.approach = approach;
    problem.threads = 1;
    if (*solver == NULL)
        *solver = rc_solver_new(&shape, h, &problem, &err);
    else
        assert_int_equal(rc_solver_set_load(*solver, load, approach, &err), RC_OK);
    assert_non_null(*solver);
    while (rc_solver_step(*solver) == RC_MORE)
        ;
    rc_solver_result(*solver, NULL, want, c);
    assert_int_equal(rc_solver_conductance(*solver, k1, k2, conductance, &err), RC_OK);
    if (c->plastic_nodes > 0)
        assert_int_equal(rc_solver_stiffness(*solver, stiffness, &err), RC_OK);
    else
        *stiffness = conductance->stiffness;
    c->convolutions = rc_solver_convolutions(*solver);
}

static bool
equal(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

static void
compare(const struct sample *s, struct rc_model *m, const struct rc_contact *c)
{
    const struct rc_figure *table = rc_figures("contact");
    const struct rc_contact *found = &rc_elastic_result(m)->contact;

    for (const struct rc_figure *f = table; f->name != NULL; f++)
        if (!equal(rc_figure_number(f, c), rc_figure_number(f, found)) ||
            !equal(rc_model_number(m, f->name), rc_figure_number(f, c)))
            fail_msg("%s: %s is %.17g, not %.17g", s->name, f->name, rc_figure_number(f, found),
                     rc_figure_number(f, c));
}

static void
one(const struct sample *s)
{
    static const struct rc_elastic_asks asks = {.stiffness = true, .conductivity = {k1, k2}};
    struct rc_problem problem = s->problem;
    struct rc_err err = {""};
    struct rc_solver *solver = NULL;
    struct rc_model *m;
    double gap[N];

    problem.threads = 1;
    m = rc_elastic_new(&shape, h, &problem, &asks, &err);
    if (m == NULL)
        fail_msg("%s: %s", s->name, err.text);
    memcpy(left, h, sizeof h);
    for (int k = 0; k < 3; k++) {
        struct rc_point to = {0}, at;
        struct rc_contact c;
        double stiffness = NAN;
        struct rc_conductance conductance = {0};
        rc_point_set(&to, s->by_approach ? RC_APPROACH : RC_LOAD, s->at[k]);
        assert_int_equal(rc_model_run(m, &to, &err), RC_OK);
        assert_int_equal(rc_model_look(m, &at, &err), RC_OK);
        if (s->at[k] == 0) { /* separated, on the deformed shape */
            rc_contact_apart(NULL, &shape, left, want, &c);
            assert_true(fabs(rc_elastic_result(m)->contact.mean_gap - c.mean_gap) <
                        1e-12 * c.mean_gap);
            assert_true(rc_elastic_result(m)->conductance == 0 && at.at[RC_LOAD] == 0);
            assert_int_equal(rc_model_keep(m, &err), RC_OK);
            continue;
        }
        by_solver(s, &solver, k, &c, &stiffness, &conductance);
        compare(s, m, &c);
        assert_true(at.at[RC_LOAD] == c.load && equal(at.at[RC_APPROACH], c.approach));
        assert_true(equal(rc_elastic_result(m)->stiffness, stiffness));
        assert_true(equal(rc_elastic_result(m)->conductance, conductance.value));
        assert_true(equal(rc_elastic_result(m)->tilt_x, problem.tilt_free ? atan(c.tilt[0]) : NAN));
        assert_string_equal(rc_elastic_result(m)->kernel, rc_solver_engine(solver));
        assert_int_equal(rc_model_frame(m, "gap", gap, &err), RC_OK);
        assert_memory_equal(gap, want, sizeof gap);
        assert_int_equal(rc_model_frame(m, "pressure", p, &err), RC_OK);
        assert_memory_equal(p, rc_solver_pressure(solver), sizeof p);
        if (s->keeps) {
            assert_int_equal(rc_solver_keep_shape(solver, &c, left, &err), RC_OK);
            assert_int_equal(rc_model_keep(m, &err), RC_OK);
            assert_int_equal(rc_model_frame(m, "plastic", p, &err), RC_OK);
            for (size_t q = 0; q < N; q++) /* the solver counts heights from the highest node */
                assert_true(fabs(p[q] - left[q]) < 1e-21);
        }
    }
    if (s->keeps)
        assert_true(rc_model_number(m, "residual_indentation") > 0);
    rc_solver_free(solver);
    rc_model_free(m);
}

static void
all(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof samples / sizeof *samples; k++)
        one(&samples[k]);
}

/* The yielding model finds what a volume of its slabs finds under the same loads, to the last bit. */
static void
yielding(void **state)
{
    struct rc_yield_problem problem = {
        .contact = {.pair.one = {0.91e9, 0.3}, .tol = 0.05, .threads = 1},
        .law = {.stress = 2e7, .modulus = 1e8},
        .increments = 8};
    const double loads[] = {1e-6, 3e-3, 0, 2e-3};
    struct rc_err err = {""};
    struct rc_model *m = rc_yield_new(&shape, h, &problem, &err);
    const struct rc_yield_figures *found = rc_yield_result(m);
    struct rc_yield_solver *plastic = NULL;

    (void)state;
    for (int k = 0; k < 4; k++) {
        double *const e[RC_YIELD_STRAINS] = {[RC_PEEQ] = p};
        struct rc_point to = {0};
        rc_point_set(&to, RC_LOAD, loads[k]);
        assert_int_equal(rc_model_run(m, &to, &err), RC_OK);
        assert_int_equal(rc_model_look(m, NULL, &err), RC_OK);
        assert_int_equal(found->yielded, k > 0); /* the first load is too small */
        assert_int_equal(rc_yield_strain(m, 0, e), k > 0);
        assert_true(k > 0 || rc_model_number(m, "plastic_volume") == 0);
        if (k == 1) { /* the settings that the model chose */
            problem.slabs = found->slabs;
            problem.thickness = found->thickness;
            problem.contact.tol = 1e-4;
            problem.lag = 0.02;
            assert_non_null(plastic = rc_yield_solver_new(&shape, h, &problem, &err));
            plastic->asked.yields = true;
        }
        if (k > 0) {
            assert_int_equal(rc_yield_solver_set_load(plastic, loads[k], &err), RC_OK);
            while (rc_yield_solver_step(plastic, &err) == RC_MORE)
                ;
            assert_true(rc_model_number(m, "plastic_volume") == plastic->figures.volume);
            assert_int_equal(rc_model_frame(m, "residual", p, &err), RC_OK);
            assert_memory_equal(p, plastic->maps.u, sizeof p);
        }
        if (k > 0 && loads[k] > 0) {
            assert_int_equal(rc_model_frame(m, "pressure", p, &err), RC_OK);
            assert_memory_equal(p, rc_solver_pressure(plastic->solver), sizeof p);
        }
        assert_int_equal(rc_model_keep(m, &err), RC_OK);
    }
    assert_true(found->last.work > 0 && rc_elastic_result(m) == NULL);
    assert_int_equal(rc_model_set_heights(m, h, &err), RC_OK);
    rc_yield_solver_free(plastic);
    rc_model_free(m);
}

/* Other heights, before the first load and after one: the contact is that of the new heights, and the dents
 * remain. */
static void
other_heights(void **state)
{
    struct rc_problem problem = {.pair.estar = 1e9, .tol = 1e-9, .hardness = 5e7, .threads = 1};
    static const double flat[N];
    struct rc_err err = {""};
    struct rc_model *m = rc_elastic_new(&shape, flat, &problem, NULL, &err), *other;
    struct rc_point to = {0};
    double dented[N], lifted[N], most = 0;

    (void)state;
    rc_point_set(&to, RC_LOAD, 3e-3);
    assert_int_equal(rc_model_set_heights(m, h, &err), RC_OK);
    assert_true(rc_model_run(m, &to, &err) == RC_OK && rc_model_keep(m, &err) == RC_OK);
    assert_int_equal(rc_model_frame(m, "plastic", dented, &err), RC_OK);
    for (size_t k = 0; k < N; k++)
        lifted[k] = h[k] + 1e-7 * sin((double)k);
    assert_int_equal(rc_model_set_heights(m, lifted, &err), RC_OK);
    for (size_t k = 0; k < N; k++)
        dented[k] += lifted[k] - h[k];
    problem.height_error = rc_elastic_result(m)->contact.shape_error;
    other = rc_elastic_new(&shape, dented, &problem, NULL, &err);
    assert_true(rc_model_run(m, &to, &err) == RC_OK && rc_model_run(other, &to, &err) == RC_OK);
    assert_true(rc_model_look(m, NULL, &err) == RC_OK && rc_model_look(other, NULL, &err) == RC_OK);
    assert_true(rc_model_frame(m, "pressure", p, &err) == RC_OK &&
                rc_model_frame(other, "pressure", want, &err) == RC_OK);
    for (size_t k = 0; k < N; k++)
        most = fmax(most, want[k]);
    for (size_t k = 0; k < N; k++)
        assert_true(fabs(p[k] - want[k]) < 1e-5 * most);
    lifted[3] = NAN;
    assert_int_equal(rc_model_set_heights(m, lifted, &err), RC_FAIL);
    rc_model_free(m);
    rc_model_free(other);
}

static int
make_heights(void **state)
{
    const struct rc_selfaffine what = {.hurst = 0.8, .rms_slope = 0.1, .seed = 7};

    (void)state;
    return rc_synth_selfaffine(&shape, &what, h, NULL) == RC_OK ? 0 : -1;
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all),
        cmocka_unit_test(other_heights),
        cmocka_unit_test(yielding),
    };

    return cmocka_run_group_tests(tests, make_heights, NULL);
}
