/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Estimated errors of viscoelastic pressures are not below the error, except for 1 in 50, where
 * differences of the runs are small by chance. The median of their ratio is at most 5. For random
 * materials, maps and histories with falls of 10 to 1000. The truth is a scheme in strains: the
 * displacement changes linearly in each step, and stresses of the terms of the relaxation modulus
 * follow it. It shares the elastic contact with the library, and neither terms nor steps. It counts
 * where its pressures with twice as many steps agree to a tenth of the error. Errors up to 1e-5 do not
 * count. RC_CAMPAIGN: number of histories of each kind; RC_SEED. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

enum {
    MOST = 24 * 24,
    POINTS = 5,
    TERMS = 4
};
static const double glass = 1e9; /* Pa */
static unsigned long long seed;

static double
draw(double low, double high)
{
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

static bool
often(double part)
{
    return draw(0, 1) < part;
}

/* ---- histories ---- */

enum kind {
    LOAD,
    APPROACH,
    FLUID,
    KINDS
};
static const char *const kind_name[] = {"load", "approach", "fluid"};

/* Moduli over glass; `relaxed` and all e: 1 together. */
struct history {
    struct rc_shape shape;
    struct rc_problem contact;
    struct rc_layer coat;
    enum rc_axis axis;
    size_t terms, n, increments;
    double relaxed, e[TERMS], tau[TERMS], tol;
    double value[POINTS], time[POINTS], shortest, fall;
    double h[MOST];
};

static void
random_material(struct history *a, enum kind kind)
{
    const bool wide = often(0.4);
    double sum;

    a->terms = (size_t)draw(1, TERMS + 0.99);
    a->relaxed = kind == FLUID ? 0 : pow(10, draw(-3, -0.3));
    sum = 0;
    for (size_t k = 0; k < a->terms; k++) {
        a->e[k] = pow(10, draw(-2, 0));
        a->tau[k] = pow(10, wide ? draw(-7, 3) : draw(-2, 1.5));
        sum += a->e[k];
    }
    for (size_t k = 0; k < a->terms; k++)
        a->e[k] *= (1 - a->relaxed) / sum;
}

static void
random_map(struct history *a)
{
    const bool line = often(0.25);
    const struct rc_selfaffine rough = {.hurst = 0.8,
                                        .rms_slope = 0.1,
                                        .seed = (unsigned long)draw(1, 1e9),
                                        .short_cut = draw(3e-6, 8e-6)};
    struct rc_err err;

    a->shape = (struct rc_shape){(size_t)draw(10, line ? 64 : 20), line ? 1 : (size_t)draw(10, 20),
                                 1e-6, 1e-6};
    a->n = a->shape.nx * a->shape.ny;
    a->contact = (struct rc_problem){
        .boundary = each_boundary[(size_t)draw(0, line ? 1.99 : BOUNDARIES - 0.01)], .threads = 1};
    if (often(0.25) && !line)
        rc_synth_sphere(&a->shape, 1e-4, a->h);
    else
        assert_int_equal(rc_synth_selfaffine(&a->shape, &rough, a->h, &err), RC_OK);
    if (often(0.2) &&
        (rc_repeats(a->contact.boundary) == 2 || rc_repeats(a->contact.boundary) == 0)) {
        a->coat = (struct rc_layer){draw(2e-6, 2e-5), glass, draw(0.2, 0.49)};
        a->contact.pair.one = (struct rc_body){INFINITY, 0.3, 1, &a->coat};
    } else {
        a->contact.pair.estar = glass;
    }
}

/* The first point is a jump. Later ones rise, fall by 10 to 1000, hold, or jump. */
static void
random_path(struct history *a, enum kind kind)
{
    double top = -INFINITY, mean = 0, unit, high = 0;

    for (size_t k = 0; k < a->n; k++) {
        top = fmax(top, a->h[k]);
        mean += a->h[k] / (double)a->n;
    }
    a->axis = kind == APPROACH || (kind == FLUID && often(0.3)) ? RC_APPROACH : RC_LOAD;
    unit = a->axis == RC_APPROACH ? (top - mean) * pow(10, draw(-2, -0.2))
                                  : pow(10, draw(-4, -1.5)) * glass * (double)a->n * 1e-12;
    a->fall = 1;
    a->shortest = INFINITY;
    for (size_t k = 0; k < POINTS; k++) {
        const double what = draw(0, 1);
        const bool jumps = k > 1 && often(0.1);
        a->value[k] = k == 0 || what < 0.3 ? unit * pow(10, draw(-1, 0))
                      : what < 0.7         ? high * pow(10, -draw(1, 3))
                                           : a->value[k - 1];
        a->time[k] =
            k == 0 ? 0
                   : a->time[k - 1] + (jumps ? 0 : pow(10, often(0.3) ? draw(-2, 3) : draw(-1, 1)));
        high = fmax(high, a->value[k]);
        a->fall = fmin(a->fall, a->value[k] / high);
        if (k > 0 && !jumps)
            a->shortest = fmin(a->shortest, a->time[k] - a->time[k - 1]);
    }
}

static struct history
random_history(enum kind kind)
{
    struct history a = {.tol = pow(10, draw(-3, -1.7)),
                        .increments = often(0.3) ? (size_t)draw(8, 41) : 0};

    random_material(&a, kind);
    random_map(&a);
    random_path(&a, kind);
    return a;
}

/* ---- the library ---- */

struct result {
    enum rc_status status;
    double error, steps, inherited, load, p[MOST];
    size_t nodes, increments;
};

/* The work of all points; -1: refused. With the tolerances of rc-solve. */
static double
by_library(const struct history *a, struct result *to)
{
    struct rc_problem contact = a->contact;
    struct rc_viscoelastic_problem law = {.share = 1,
                                          .increments = a->increments,
                                          .tol = 0.9 * a->tol,
                                          .shortest = a->shortest,
                                          .longest = a->time[POINTS - 1],
                                          .points = POINTS};
    double modulus[TERMS], work = 0;
    const struct rc_viscoelastic_figures *f;
    struct rc_relaxation *material;
    struct rc_model *m;
    struct rc_err err = {""};

    if (contact.pair.one.layers > 0)
        contact.pair.one.layer = &a->coat;
    contact.tol = 0.1 * a->tol * fmax(a->fall, 1e-4);
    for (size_t k = 0; k < a->terms; k++)
        modulus[k] = a->e[k] * glass;
    material = rc_relaxation_new(a->relaxed * glass, a->terms, modulus, a->tau, &err);
    assert_non_null(material);
    law.material = material;
    m = rc_viscoelastic_new(rc_elastic_new(&a->shape, a->h, &contact, NULL, &err), a->h, &law,
                            &err);
    for (size_t k = 0; k < POINTS && m != NULL; k++) {
        struct rc_point at = {0};
        rc_point_set(&at, a->axis, a->value[k]);
        rc_point_set(&at, RC_TIME, a->time[k]);
        to[k].status = rc_model_run(m, &at, &err);
        if (to[k].status == RC_FAIL || rc_model_look(m, NULL, &err) != RC_OK ||
            rc_model_frame(m, "pressure", to[k].p, &err) != RC_OK ||
            rc_model_keep(m, &err) != RC_OK) {
            work = -1;
            break;
        }
        f = rc_viscoelastic_result(m);
        to[k].error = f->contact.pressure_error;
        to[k].steps = f->increment_error;
        to[k].inherited = f->contact.inherited_error;
        to[k].load = f->contact.load;
        to[k].nodes = f->contact.contact_nodes;
        to[k].increments = f->increments;
        work += f->contact.convolutions;
    }
    rc_model_free(m);
    rc_relaxation_free(material);
    return m == NULL ? -1 : work;
}

/* ---- the truth ---- */

struct truth {
    const struct history *a;
    struct rc_model *m;
    bool apart;
    double top, *u, *y, *posed, *w; /* y: one map for each term */
};

/* A step in which u changes linearly: w = A u + B after it. */
static bool
truth_step(struct truth *t, double dt, double value)
{
    const struct history *a = t->a;
    struct rc_point at = {0};
    struct rc_err err = {""};
    double keep[TERMS], per[TERMS], all = a->relaxed, top = -INFINITY, approach = INFINITY;

    for (size_t k = 0; k < a->terms; k++) {
        const double x = dt / a->tau[k];
        keep[k] = exp(-x);
        per[k] = a->e[k] * (x > 0 ? -expm1(-x) / x : 1);
        all += per[k];
    }
    for (size_t i = 0; i < a->n; i++) {
        double b = 0;
        for (size_t k = 0; k < a->terms; k++)
            b += keep[k] * t->y[k * a->n + i] - per[k] * t->u[i];
        t->posed[i] = all * a->h[i] + b;
        top = fmax(top, t->posed[i]);
    }
    if (a->axis == RC_APPROACH)
        approach = all * (value - t->top) + top;
    rc_point_set(&at, a->axis, a->axis == RC_LOAD ? value : fmax(0, approach));
    t->apart = approach <= 0;
    if (t->apart)
        memset(t->w, 0, a->n * sizeof *t->w);
    else if (rc_model_set_heights(t->m, t->posed, &err) != RC_OK ||
             rc_model_run(t->m, &at, &err) != RC_OK || rc_model_keep(t->m, &err) != RC_OK ||
             rc_model_frame(t->m, "displacement", t->w, &err) != RC_OK)
        return false;
    for (size_t i = 0; i < a->n; i++) {
        const double u = (t->w[i] - (t->posed[i] - all * a->h[i])) / all;
        for (size_t k = 0; k < a->terms; k++)
            t->y[k * a->n + i] = keep[k] * t->y[k * a->n + i] + per[k] * (u - t->u[i]);
        t->u[i] = u;
    }
    return true;
}

/* Steps of a leg grow with the time since its start, from a part of the shortest time of the material to a
 * part of the leg. */
static bool
truth_leg(struct truth *t, size_t k, size_t n)
{
    const struct history *a = t->a;
    const double way = a->time[k] - a->time[k - 1];
    double least = way, sum = 0, dt, at = 0;

    if (way == 0)
        return truth_step(t, 0, a->value[k]);
    for (size_t q = 0; q < a->terms; q++)
        least = fmin(least, a->tau[q]);
    least = fmax(least, 1e-4 * way) / (double)n;
    for (dt = least; sum < way; dt = fmin(dt * (1 + 2.0 / (double)n), way / (double)n))
        sum += dt;
    for (dt = least; at < way * (1 - 1e-9);
         dt = fmin(dt * (1 + 2.0 / (double)n), way / (double)n)) {
        at = fmin(way, at + dt * way / sum);
        if (!truth_step(t, dt * way / sum,
                        a->value[k - 1] + (a->value[k] - a->value[k - 1]) * at / way))
            return false;
    }
    return true;
}

static bool
by_strains(const struct history *a, size_t n, double (*p)[MOST])
{
    static double room[(TERMS + 3) * MOST];
    struct rc_problem contact = a->contact;
    struct rc_err err = {""};
    struct truth t = {.a = a, .top = -INFINITY, .u = room};
    bool good = true;

    if (contact.pair.one.layers > 0)
        contact.pair.one.layer = &a->coat;
    contact.tol = 1e-9;
    memset(room, 0, sizeof room);
    t.posed = room + a->n;
    t.w = room + 2 * a->n;
    t.y = room + 3 * a->n;
    for (size_t i = 0; i < a->n; i++)
        t.top = fmax(t.top, a->h[i]);
    t.m = rc_elastic_new(&a->shape, a->h, &contact, NULL, &err);
    for (size_t k = 0; k < POINTS && good; k++) {
        good = k == 0 ? truth_step(&t, 0, a->value[0]) : truth_leg(&t, k, n);
        memset(p[k], 0, sizeof p[k]);
        for (size_t i = 0; i < a->n; i++)
            good = good && isfinite(t.w[i]);
        if (good && !t.apart && rc_model_frame(t.m, "pressure", p[k], &err) != RC_OK)
            good = false;
    }
    rc_model_free(t.m);
    return good;
}

/* ---- the comparison ---- */

static double ratio[KINDS][60000];

static bool
carries(const double *p, size_t n)
{
    bool any = false;

    for (size_t i = 0; i < n; i++)
        any = any || p[i] > 0;
    return any;
}

static int
ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static void
estimates(void **state)
{
    const char *count = getenv("RC_CAMPAIGN"), *first = getenv("RC_SEED");
    const size_t cases = count != NULL ? strtoul(count, NULL, 10) : thorough(300, 8);
    static struct result found[POINTS];
    static double truth[2][POINTS][MOST];

    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        size_t n = 0, below = 0, unknown = 0, refused = 0, points = 0, missed = 0;
        double work = 0;
        seed = 77 + (unsigned)kind + (first != NULL ? 1000 * strtoul(first, NULL, 10) : 0);
        for (size_t q = 0; q < cases; q++) {
            const struct history a = random_history((enum kind)kind);
            const double took = by_library(&a, found);
            const size_t n0 = 80;
            if (took < 0 || !by_strains(&a, n0, truth[0]) || !by_strains(&a, 2 * n0, truth[1])) {
                refused++;
                continue;
            }
            work += took;
            for (size_t k = 0; k < POINTS; k++) {
                const double error = found[k].load > 0 || carries(truth[1][k], a.n)
                                         ? distance(a.n, found[k].p, truth[1][k])
                                         : 0,
                             halved = error > 0 ? distance(a.n, truth[0][k], truth[1][k]) : 0;
                points++;
                missed += found[k].status != RC_OK;
                if (!(error > 1e-5))
                    continue;
                if (!(halved < 0.1 * error) && found[k].error < error + halved) {
                    unknown++;
                    continue;
                }
                if (!(halved < 0.1 * error))
                    continue;
                ratio[kind][n++] = found[k].error / error;
                if (found[k].error < 0.99 * error) {
                    below++;
                    print_message(
                        "%s %zu, point %zu: %zu nodes of %zu, error %.2g, told %.2g (steps %.2g, "
                        "inherited %.2g), truth within %.2g, %zu increments%s%s\n",
                        kind_name[kind], q, k, found[k].nodes, a.n, error, found[k].error,
                        found[k].steps, found[k].inherited, halved, found[k].increments,
                        a.axis == RC_APPROACH ? ", approach" : "",
                        found[k].status == RC_OK ? "" : ", short");
                }
            }
        }
        qsort(ratio[kind], n, sizeof **ratio, ascending);
        print_message("%s: %zu histories (%zu refused), %zu points, %zu above the tolerance; %zu "
                      "errors above "
                      "1e-5: %zu estimates below .99 (%zu more unknown); least %.3f, median %.2f, "
                      "90 %% %.2f; "
                      "%.0f convolutions\n",
                      kind_name[kind], cases, refused, points, missed, n, below, unknown,
                      ratio[kind][0], ratio[kind][n / 2], ratio[kind][9 * n / 10], work);
        assert_true(below <= n / 50 && (n < 100 || ratio[kind][n / 2] <= 5));
    }
}

/* History `number` of the seed. */
static struct history
history_of(unsigned long long start, enum kind kind, size_t number)
{
    struct history a;

    seed = start;
    for (size_t q = 0; q <= number; q++)
        a = random_history(kind);
    return a;
}

/* The dent of a fluid under one node, which a jump of the approach touches. The node is elastic in a jump. */
static double
dent(const struct history *a, const double *first, const double *jump)
{
    double p0 = 0, p = 0;

    for (size_t i = 0; i < a->n; i++) {
        p0 += first[i];
        p += jump[i];
    }
    return a->value[2] - a->value[0] * p / p0;
}

/* A fluid has separated at a given approach. A jump brings the bodies to a point between the dents of the
 * truth and of the library, which is deeper. The truth touches, and the library finds no contact; its
 * estimate says that this is not known. */
static void
whether_they_touch(void **state)
{
    static struct result found[POINTS];
    static double truth[POINTS][MOST];
    struct history a = history_of(90350079, FLUID, 144);
    double deep, deeper;

    (void)state;
    assert_true(by_library(&a, found) >= 0 && by_strains(&a, 80, truth));
    assert_true(a.axis == RC_APPROACH && found[2].nodes == 1 && a.time[2] == a.time[1]);
    assert_true(!carries(truth[1], a.n) && found[1].error < 1e-6 && found[1].status == RC_OK);
    deep = dent(&a, truth[0], truth[2]);
    deeper = dent(&a, found[0].p, found[2].p);
    assert_true(deep > 0 && deeper > deep && deeper < 1.01 * deep);
    a.value[2] = (deep + deeper) / 2;
    assert_true(by_library(&a, found) >= 0 && by_strains(&a, 80, truth));
    assert_true(carries(truth[2], a.n) && !carries(found[2].p, a.n));
    assert_true(found[2].error > 1 && found[2].status == RC_SHORT);
}

/* Histories whose errors were above the estimates, until steps, terms and estimates knew of these causes. */
static void
known_causes(void **state)
{
    static const struct {
        const char *cause;
        enum kind kind;
        unsigned long long seed;
        size_t number, point;
        double most; /* error */
    } at[] = {
        {"fast terms settle after a jump", LOAD, 90350077, 29, 4, 5e-5},
        {"the first step after a jump, which all runs share", APPROACH, 90371078, 40, 1, 1e-5},
        {"a contact ends, and another begins, within a step", APPROACH, 90350078, 148, 3, 1e-4},
        {"a step after a long one from a jump", FLUID, 90350079, 48, 4, 1e-3},
        {"a contact ends within a step", FLUID, 90350079, 144, 2, 1e-4},
        {"the same, with 11 increments", FLUID, 90210079, 156, 2, 0.05},
        {"a step after a long one, under 6 nodes", FLUID, 90310079, 111, 4, 1e-4},
        {"a pressure of 1e-13 of the first one is rounded", FLUID, 90350079, 275, 4, 0.1},
    };
    static struct result found[POINTS];
    static double truth[POINTS][MOST];

    (void)state;
    for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
        const struct history a = history_of(at[k].seed, at[k].kind, at[k].number);
        double error;
        assert_true(by_library(&a, found) >= 0 && by_strains(&a, 80, truth));
        error = distance(a.n, found[at[k].point].p, truth[at[k].point]);
        print_message("%s: error %.2g, told %.2g\n", at[k].cause, error, found[at[k].point].error);
        assert_true(error < at[k].most);
        assert_true(found[at[k].point].error >= error);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(estimates), cmocka_unit_test(known_causes),
                                       cmocka_unit_test(whether_they_touch)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
