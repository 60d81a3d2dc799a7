/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Verdicts of scenes against the models of the effects. On random surfaces, with effects near their
 * thresholds, "negligible" is never said of an effect that changes a figure by more than the bound, and
 * "calls for it" seldom of one that does not. RC_LONG takes 200 scenes an effect, and 40 on maps of 256 x 256
 * nodes; with RC_SIDE=N the latter alone, of N x N nodes. RC_ONLY=EFFECT takes one effect, RC_FROM=SEED other
 * scenes. RC_SHOW prints each scene that is wrong or outside, RC_SHOW=all all of them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/common.h"
#include "tests/exact.h"

enum {
    SIDE = 256,
    MOST = SIDE * SIDE,
    SCALES = 4
};
static const double bounds_of[SCALES] = {0.005, 0.01, 0.02, 0.05};

static uint64_t state_of_random;

static double
uniform(double from, double to)
{
    state_of_random += 0x9e3779b97f4a7c15U;
    uint64_t z = state_of_random;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return from + (to - from) * (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static double
powers(double from, double to)
{
    return exp(uniform(log(from), log(to)));
}

/* ---- scenes ---- */

struct case_of {
    struct rc_shape shape;
    struct rc_problem problem;
    struct rc_scene_data data;
    struct rc_relaxation *material;
    struct rc_layer coat;
    double bend; /* 1/m: of the ball, height bend (x^2 + y^2) */
    double h[MOST];
};

static const struct {
    struct rc_body one, two;
} bodies[] = {
    {{.e = 210e9, .nu = 0.3}, {.e = 210e9, .nu = 0.3}},  /* steel on steel */
    {{.e = 210e9, .nu = 0.3}, {.e = INFINITY}},          /* steel, rigid */
    {{.e = 72e9, .nu = 0.2}, {.e = INFINITY}},           /* glass */
    {{.e = 78e9, .nu = 0.42}, {.e = 70e9, .nu = 0.33}},  /* gold on aluminium */
    {{.e = 0.5e9, .nu = 0.46}, {.e = 210e9, .nu = 0.3}}, /* PTFE on steel */
    {{.e = 5e6, .nu = 0.49}, {.e = 210e9, .nu = 0.3}},   /* rubber on steel */
    {{.e = 120e9, .nu = 0.34}, {.e = 370e9, .nu = 0.22}} /* copper on alumina */
};
enum {
    MATERIALS = sizeof bodies / sizeof *bodies
};

static double
estar_of(const struct rc_pair *p)
{
    return 1 / ((1 - p->one.nu * p->one.nu) / p->one.e +
                (p->two.e > 0 ? (1 - p->two.nu * p->two.nu) / p->two.e : 0));
}

/* A rough block, a rough ball (a third) or, half of the others, a periodic surface. `fraction`: of the map
 * in contact, roughly. */
static void
make(struct case_of *c, uint64_t seed, bool periodic, size_t side)
{
    struct rc_err err;
    double slope = 0, kind, ball, fraction;

    state_of_random = seed * 7919 + 12345;
    for (int k = 0; k < 8; k++)
        (void)uniform(0, 1);
    memset(c, 0, sizeof *c);
    c->shape = (struct rc_shape){side, side, powers(20e-9, 5e-6), 0};
    c->shape.dy = c->shape.dx;
    kind = uniform(0, 1);
    fraction = powers(0.003, 0.5);
    const struct rc_selfaffine rough = {.hurst = uniform(0.3, 1),
                                        .rms_height = 1e-9,
                                        .rolloff = fmax((double)side * uniform(0.25, 0.5), 10) *
                                                   c->shape.dx,
                                        .short_cut = uniform(4, 10) * c->shape.dx,
                                        .seed = seed + 1};
    if (rc_synth_selfaffine(&c->shape, &rough, c->h, &err) != RC_OK)
        fail_msg("%s", err.text);
    for (size_t j = 0; j < side; j++)
        for (size_t i = 0; i < side; i++)
            slope += pow((c->h[j * side + (i + 1) % side] - c->h[j * side + i]) / c->shape.dx, 2) *
                     2 / (double)(side * side);
    slope = powers(0.005, 0.5) / sqrt(slope);
    for (size_t k = 0; k < side * side; k++)
        c->h[k] *= slope;
    slope = 0;
    for (size_t j = 0; j < side; j++)
        for (size_t i = 0; i < side; i++)
            slope += pow((c->h[j * side + (i + 1) % side] - c->h[j * side + i]) / c->shape.dx, 2) *
                     2 / (double)(side * side);
    slope = sqrt(slope);
    ball = kind < 0.35 && !periodic ? powers(1, 20) : 0;
    for (size_t j = 0; j < side && ball > 0; j++)
        for (size_t i = 0; i < side; i++) {
            const double x = ((double)i - (double)(side - 1) / 2) / (double)side,
                         y = ((double)j - (double)(side - 1) / 2) / (double)side;
            c->h[j * side + i] -= ball * slope * (x * x + y * y) * (double)side * c->shape.dx / 4;
        }
    c->bend = ball * slope / (4 * (double)side * c->shape.dx);
    if (periodic || kind > 0.65)
        c->problem.boundary = RC_PERIODIC;
    const size_t material = (size_t)uniform(0, MATERIALS);
    c->problem.pair.one = bodies[material].one;
    c->problem.pair.two = bodies[material].two;
    c->problem.tol = 1e-5;
    c->problem.threads = 1;
    c->problem.load = 0.5 * fraction * slope * estar_of(&c->problem.pair) * (double)(side * side) *
                      c->shape.dx * c->shape.dx * (ball > 0 ? 0.2 : 1);
}

/* ---- truths ---- */

struct figures {
    double of[RC_SCENE_FIGURES]; /* magnitudes of changes; NAN: not computed */
};

static bool
run(struct rc_model *m, const struct rc_point *to, struct rc_err *err)
{
    return m != NULL && rc_model_run(m, to, err) == RC_OK && rc_model_look(m, NULL, err) == RC_OK;
}

static struct rc_point
load_of(const struct case_of *c)
{
    struct rc_point to = {0};

    rc_point_set(&to, RC_LOAD, c->problem.load);
    return to;
}

static struct rc_contact
elastic(const struct case_of *c, const struct rc_pair *pair)
{
    struct rc_problem problem = c->problem;
    const struct rc_point to = load_of(c);
    struct rc_err err;

    problem.pair = *pair;
    RC_OWN(rc_model, m) = rc_elastic_new(&c->shape, c->h, &problem, NULL, &err);
    if (!run(m, &to, &err))
        return (struct rc_contact){.contact_area = NAN};
    return rc_elastic_result(m)->contact;
}

static struct figures
none(void)
{
    struct figures f;

    for (int k = 0; k < RC_SCENE_FIGURES; k++)
        f.of[k] = NAN;
    return f;
}

static void
compare(struct figures *f, const struct rc_contact *before, double area, double pressure,
        double approach)
{
    f->of[RC_SCENE_AREA] = fabs(area / before->contact_area - 1);
    f->of[RC_SCENE_PRESSURE] = fabs(pressure / before->max_pressure - 1);
    f->of[RC_SCENE_APPROACH] = fabs(approach / before->approach - 1);
}

enum {
    FINER = 4
};

/* Weights of the nodes of a periodic line at a point between them: the waves that it holds. */
static void
waves_at(size_t n, double at, double *w)
{
    for (size_t k = 0; k < n; k++) {
        const double x = 2 * exact_pi * (at - (double)k) / (double)n;
        double sum = 1;
        for (size_t m = 1; 2 * m < n; m++)
            sum += 2 * cos((double)m * x);
        w[k] = (sum + (n % 2 == 0 ? cos((double)n / 2 * x) : 0)) / (double)n;
    }
}

/* The contact of the same waves and the same ball on a finer grid. */
static struct rc_model *
finer(const struct case_of *c, struct rc_shape *to, struct rc_err *err)
{
    static double w[FINER * SIDE][SIDE], half[FINER * MOST], fine[FINER * FINER * MOST];
    const size_t n = c->shape.nx, m = FINER * n;
    const struct rc_shape shape = {m, m, c->shape.dx / FINER, c->shape.dx / FINER};

    for (size_t i = 0; i < m; i++)
        waves_at(n, ((double)i + 0.5) / FINER - 0.5, w[i]);
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < m; i++) {
            double sum = 0;
            for (size_t k = 0; k < n; k++) {
                const double x = ((double)k - (double)(n - 1) / 2) * c->shape.dx,
                             y = ((double)j - (double)(n - 1) / 2) * c->shape.dx;
                sum += w[i][k] * (c->h[j * n + k] + c->bend * (x * x + y * y));
            }
            half[j * m + i] = sum;
        }
    for (size_t j = 0; j < m; j++)
        for (size_t i = 0; i < m; i++) {
            const double x = ((double)i - (double)(m - 1) / 2) * shape.dx,
                         y = ((double)j - (double)(m - 1) / 2) * shape.dx;
            double sum = 0;
            for (size_t k = 0; k < n; k++)
                sum += w[j][k] * half[k * m + i];
            fine[j * m + i] = sum - c->bend * (x * x + y * y);
        }
    *to = shape;
    return rc_elastic_new(&shape, fine, &c->problem, NULL, err);
}

static bool
truth_grid(struct case_of *c, const struct rc_contact *e, struct figures *f)
{
    const struct rc_point to = load_of(c);
    const struct rc_contact *after;
    struct rc_shape shape;
    struct rc_err err;
    RC_OWN(rc_model, model) = finer(c, &shape, &err);

    if (!run(model, &to, &err))
        return false;
    after = &rc_elastic_result(model)->contact;
    compare(f, e, after->contact_area, after->max_pressure, after->approach);
    return true;
}

/* A way through the gap on the finer grid. */
static bool
truth_leak(struct case_of *c, const struct rc_contact *e, struct figures *f)
{
    static double p[FINER * FINER * MOST], gap[FINER * FINER * MOST];
    const struct rc_leak_options options = {.around = c->problem.boundary.y};
    const struct rc_point to = load_of(c);
    struct rc_shape shape;
    struct rc_err err;
    RC_OWN(rc_model, model) = finer(c, &shape, &err);

    (void)e;
    if (!run(model, &to, &err) || rc_model_frame(model, "pressure", p, &err) != RC_OK ||
        rc_model_frame(model, "gap", gap, &err) != RC_OK)
        return false;
    RC_OWN(rc_leak, leak) = rc_leak_new(&shape, p, gap, &options, &err);
    if (leak == NULL)
        return false;
    f->of[RC_SCENE_LEAK] = rc_leak_result(leak)->percolates;
    return true;
}

/* The largest index of all depths from the distance of the states, as rc-fatigue takes them. */
static bool
truth_fatigue(struct case_of *c, const struct rc_contact *e, struct figures *f)
{
    static double p[MOST];
    const double *one = p, *none[RC_COMPONENTS] = {NULL};
    const struct rc_fatigue_limits limits = {.bending = c->data.bending,
                                             .torsion = c->data.torsion};
    struct rc_fatigue_problem problem = {
        .stress = {.boundary = c->problem.boundary, .body = c->problem.pair.one, .threads = 1},
        .wanted = 1U << RC_CROSSLAND | 1U << RC_DANG_VAN,
        .pass = 'x',
        .cases = 1,
        .p = &one};
    const struct rc_point to = load_of(c);
    double *out[RC_FATIGUES] = {NULL};
    const struct rc_fatigue_figures *found;
    struct rc_err err;
    RC_OWN(rc_model, m) = rc_elastic_new(&c->shape, c->h, &c->problem, NULL, &err);

    (void)e;
    if (!run(m, &to, &err) || rc_model_frame(m, "pressure", p, &err) != RC_OK)
        return false;
    RC_OWN(rc_fatigue, fatigue) = rc_fatigue_new(&c->shape, &problem, &err);
    for (double z = 1; z < 10; z += z < 3 ? 0.125 : 0.5)
        if (fatigue == NULL ||
            rc_fatigue_depth(fatigue, z * c->shape.dx, &limits, none, out, &err) != RC_OK)
            return false;
    found = rc_fatigue_result(fatigue);
    f->of[RC_SCENE_FATIGUE] =
        fmax(found->largest[RC_CROSSLAND].value, found->largest[RC_DANG_VAN].value);
    return true;
}

static bool
truth_yield(struct case_of *c, const struct rc_contact *e, struct figures *f)
{
    struct rc_yield_problem p = {.contact = c->problem, .law.stress = c->data.yield};
    const struct rc_point to = load_of(c);
    const struct rc_yield_figures *y;
    struct rc_err err;

    p.contact.tol = 2e-3;
    RC_OWN(rc_model, m) = rc_yield_new(&c->shape, c->h, &p, &err);
    if (!run(m, &to, &err))
        return false;
    y = rc_yield_result(m);
    if (y->yielded)
        compare(f, e, y->contact.contact_area, y->contact.max_pressure, y->indentation);
    else
        compare(f, e, e->contact_area, e->max_pressure, e->approach);
    return true;
}

static bool
truth_adhesion(struct case_of *c, const struct rc_contact *e, struct figures *f)
{
    const struct rc_adhesion_problem p = {
        .contact = c->problem, .work = c->data.work, .law = c->data.law, .range = c->data.range};
    const struct rc_point to = load_of(c);
    const struct rc_adhesion_state *s;
    struct rc_err err;
    RC_OWN(rc_model, m) = rc_adhesion_new(&c->shape, c->h, &p, &err);

    if (!run(m, &to, &err))
        return false;
    s = &rc_adhesion_result(m)->state;
    compare(f, e, s->contact_area, s->max_pressure, s->approach);
    return true;
}

/* The pull-off force over the load. */
static bool
truth_pull_off(struct case_of *c, const struct rc_contact *e, struct figures *f)
{
    struct rc_adhesion_problem p = {
        .contact = c->problem, .work = c->data.work, .law = c->data.law, .range = c->data.range};
    struct rc_point to = load_of(c), away = {0};
    struct rc_err err;

    (void)e;
    p.contact.tol = 1e-3;
    RC_OWN(rc_model, m) = rc_adhesion_new(&c->shape, c->h, &p, &err);
    if (!run(m, &to, &err) || rc_model_keep(m, &err) != RC_OK)
        return false;
    rc_point_set(&away, RC_APPROACH, -INFINITY);
    if (!run(m, &away, &err))
        return false;
    f->of[RC_SCENE_PULL_OFF] =
        fmax(-rc_adhesion_result(m)->state.pull_off_load, 0) / c->problem.load;
    return true;
}

/* The tangential force of steady rolling over the load. */
static bool
truth_rolling(struct case_of *c, const struct rc_contact *e, struct figures *f)
{
    const struct rc_rolling_problem p = {.law = {.boundary = c->problem.boundary,
                                                 .pair = c->problem.pair,
                                                 .mu = c->data.mu,
                                                 .tol = 1e-4,
                                                 .threads = 1}};
    struct rc_point to = load_of(c);
    const struct rc_rolling_figures *r;
    struct rc_err err;
    RC_OWN(rc_model, m) =
        rc_rolling_new(rc_elastic_new(&c->shape, c->h, &c->problem, NULL, &err), &p, &err);

    (void)e;
    rc_point_set(&to, RC_CREEP_X, c->data.creep[0]);
    rc_point_set(&to, RC_CREEP_Y, c->data.creep[1]);
    rc_point_set(&to, RC_SPIN, c->data.spin);
    if (!run(m, &to, &err))
        return false;
    r = rc_rolling_result(m);
    f->of[RC_SCENE_FRICTION] = hypot(r->force[0], r->force[1]) / r->load;
    return true;
}

static bool
truth_wear(struct case_of *c, const struct rc_contact *e, struct figures *f)
{
    struct rc_problem inner = c->problem;
    const struct rc_wear_problem p = {
        .k = {c->data.wear, 0}, .estar = estar_of(&c->problem.pair), .tol = 0.02};
    struct rc_point to = load_of(c);
    const struct rc_contact *after;
    struct rc_err err;

    inner.tol = 2e-4;
    rc_point_set(&to, RC_DISTANCE, 0);
    RC_OWN(rc_model, m) =
        rc_wear_new(rc_elastic_new(&c->shape, c->h, &inner, NULL, &err), c->h, &p, &err);
    if (!run(m, &to, &err) || rc_model_keep(m, &err) != RC_OK)
        return false;
    rc_point_set(&to, RC_DISTANCE, c->data.distance);
    if (rc_model_run(m, &to, &err) == RC_FAIL || rc_model_look(m, NULL, &err) != RC_OK)
        return false;
    after = &rc_elastic_result(m)->contact;
    compare(f, e, after->contact_area, after->max_pressure, NAN);
    return true;
}

static bool
truth_heat(struct case_of *c, const struct rc_contact *e, struct figures *f)
{
    const struct rc_scene_data *d = &c->data;
    struct rc_heat_problem p = {
        .boundary = c->problem.boundary, .time = d->time, .time_steps = d->time > 0 ? 16 : 0};
    const struct rc_point to = load_of(c);
    static double q[MOST], pressure[MOST];
    enum rc_status status = RC_MORE;
    struct rc_err err;
    RC_OWN(rc_model, m) = rc_elastic_new(&c->shape, c->h, &c->problem, NULL, &err);

    (void)e;
    if (!run(m, &to, &err) || rc_model_frame(m, "pressure", pressure, &err) != RC_OK)
        return false;
    for (size_t k = 0; k < c->shape.nx * c->shape.ny; k++)
        q[k] = d->mu * d->speed * pressure[k];
    for (int b = 0; b < 2; b++)
        p.body[b] = (struct rc_heat_body){.conductivity = d->conductivity[b],
                                          .diffusivity = d->diffusivity[b],
                                          .velocity = {b == 1 ? d->speed : 0}};
    RC_OWN(rc_heat, heat) = rc_heat_new(&c->shape, &p, q, pressure, &err);
    while (heat != NULL && status == RC_MORE)
        status = rc_heat_step(heat, &err);
    if (heat == NULL || status == RC_FAIL)
        return false;
    f->of[RC_SCENE_TEMPERATURE] = rc_heat_result(heat)->max_temperature;
    return true;
}

/* Friction pressed by the load in 8 increments, and then pushed. */
static struct rc_model *
friction_of(const struct case_of *c, struct rc_err *err)
{
    struct rc_problem inner = c->problem;
    struct rc_friction_problem p = {.law = {.boundary = c->problem.boundary,
                                            .pair = c->problem.pair,
                                            .mu = c->data.mu,
                                            .tol = 1e-4,
                                            .threads = 1},
                                    .increments = 16};

    inner.tol = 1e-5;
    return rc_friction_new(rc_elastic_new(&c->shape, c->h, &inner, NULL, err), c->h, &p, err);
}

static bool
truth_slip(struct case_of *c, const struct rc_contact *e, struct figures *f)
{
    struct rc_point to = load_of(c);
    const struct rc_friction_figures *r;
    double linear;
    struct rc_err err;
    RC_OWN(rc_model, m) = friction_of(c, &err);

    (void)e;
    rc_point_set(&to, RC_TANGENTIAL_X, 0);
    rc_point_set(&to, RC_TANGENTIAL_Y, 0);
    if (!run(m, &to, &err) || rc_model_keep(m, &err) != RC_OK)
        return false;
    rc_point_set(&to, RC_TANGENTIAL_X, 1e-3 * c->data.tangential);
    if (!run(m, &to, &err))
        return false;
    r = rc_friction_result(m);
    linear = r->last.displacement[0] / r->last.force[0];
    rc_point_set(&to, RC_TANGENTIAL_X, c->data.tangential);
    if (!run(m, &to, &err))
        return false;
    r = rc_friction_result(m);
    f->of[RC_SCENE_DISPLACEMENT] = fabs(r->last.displacement[0] / r->last.force[0] / linear - 1);
    return rc_there(f->of[RC_SCENE_DISPLACEMENT]);
}

static bool
truth_dissimilar(struct case_of *c, const struct rc_contact *e, struct figures *f)
{
    struct rc_point to = load_of(c);
    struct rc_contact after;
    struct rc_err err;
    RC_OWN(rc_model, m) = friction_of(c, &err);

    rc_point_set(&to, RC_TANGENTIAL_X, 0);
    rc_point_set(&to, RC_TANGENTIAL_Y, 0);
    if (!run(m, &to, &err))
        return false;
    after = rc_elastic_result(m)->contact;
    compare(f, e, after.contact_area, after.max_pressure,
            c->problem.hardness > 0 ? NAN : after.approach);
    return true;
}

static bool
truth_relaxation(struct case_of *c, const struct rc_contact *e, struct figures *f)
{
    const double one = (1 - pow(c->problem.pair.one.nu, 2)) / c->problem.pair.one.e;
    const struct rc_viscoelastic_problem p = {.material = c->material,
                                              .share = one * estar_of(&c->problem.pair),
                                              .shortest = c->data.time,
                                              .longest = c->data.time};
    struct rc_problem inner = c->problem;
    struct rc_point to = load_of(c);
    const struct rc_viscoelastic_figures *r;
    struct rc_err err;

    inner.tol = 1e-4;
    RC_OWN(rc_model, m) =
        rc_viscoelastic_new(rc_elastic_new(&c->shape, c->h, &inner, NULL, &err), c->h, &p, &err);
    rc_point_set(&to, RC_TIME, 0);
    if (!run(m, &to, &err) || rc_model_keep(m, &err) != RC_OK)
        return false;
    rc_point_set(&to, RC_TIME, c->data.time);
    if (rc_model_run(m, &to, &err) == RC_FAIL || rc_model_look(m, NULL, &err) != RC_OK)
        return false;
    r = rc_viscoelastic_result(m);
    compare(f, e, r->contact.contact_area, r->contact.max_pressure, r->contact.approach);
    return true;
}

static bool
truth_sliding(struct case_of *c, const struct rc_contact *e, struct figures *f)
{
    const struct rc_body *one = &c->problem.pair.one, *two = &c->problem.pair.two;
    double modulus[8], plain = 1 - one->nu * one->nu;
    struct rc_pair relaxed = c->problem.pair;
    struct rc_point to = load_of(c);
    struct rc_contact before;
    struct rc_err err;

    (void)e;
    for (size_t k = 0; k < c->material->terms; k++)
        modulus[k] = c->material->modulus[k] / plain;
    RC_OWN(rc_relaxation, r) = rc_relaxation_new(c->material->relaxed / plain, c->material->terms,
                                                 modulus, c->material->time, &err);
    const struct rc_sliding_problem law = {
        .material = r, .compliance = isinf(two->e) ? 0 : (1 - two->nu * two->nu) / two->e};
    RC_OWN(rc_model, m) = rc_sliding_new(&c->shape, c->h, &c->problem, &law, &err);
    rc_point_set(&to, RC_SPEED, c->data.speed);
    if (!run(m, &to, &err))
        return false;
    relaxed.one.e = c->material->relaxed;
    before = elastic(c, &relaxed);
    compare(f, &before, rc_model_number(m, "contact_area"), rc_model_number(m, "max_pressure"),
            rc_sliding_result(m)->approach);
    f->of[RC_SCENE_FRICTION] = fabs(rc_sliding_result(m)->friction);
    return true;
}

/* ---- data near the threshold of each effect ---- */

static void
draw_nothing(struct case_of *c, const struct rc_contact *e, double mises)
{
    (void)c;
    (void)e;
    (void)mises;
}

static void
draw_yield(struct case_of *c, const struct rc_contact *e, double mises)
{
    (void)e;
    c->data.yield = mises / powers(0.9, 4);
}

static void
draw_fatigue(struct case_of *c, const struct rc_contact *e, double mises)
{
    (void)e;
    c->data.torsion = 0.45 * mises / powers(0.6, 1.6);
    c->data.bending = c->data.torsion / uniform(0.58, 0.8);
}

/* Near percolation. */
static void
draw_leak(struct case_of *c, const struct rc_contact *e, double mises)
{
    (void)mises;
    c->data.drop = 1e5;
    c->problem.load *= uniform(0.1, 1) / e->contact_fraction;
}

static void
draw_adhesion(struct case_of *c, const struct rc_contact *e, double mises)
{
    const double p = c->problem.load / e->contact_area, estar = estar_of(&c->problem.pair),
                 radius = sqrt(e->contact_area / exact_pi / 10);

    (void)mises;
    c->data.work = powers(1e-3, 0.3);
    c->data.work *= pow(1.5 * p, 2) * exact_pi * radius / (2 * estar) * 0.1;
    c->data.law = "exponential";
    c->data.range = sqrt(c->data.work * c->shape.dx / estar * powers(1.2, 20));
}

static void
draw_pull_off(struct case_of *c, const struct rc_contact *e, double mises)
{
    const double stronger = powers(1, 1000);

    draw_adhesion(c, e, mises);
    c->data.work *= stronger;
    c->data.range *= sqrt(stronger);
}

/* A force of a hundredth of the limit up to the limit. */
static void
draw_rolling(struct case_of *c, const struct rc_contact *e, double mises)
{
    const double a = sqrt(e->contact_area / exact_pi), turn = uniform(0, 2 * exact_pi);
    double creep;

    (void)mises;
    c->data.mu = powers(0.01, 1);
    creep = c->data.mu * c->problem.load / e->contact_area / estar_of(&c->problem.pair) *
            powers(0.01, 10);
    c->data.creep[0] = creep * cos(turn);
    c->data.creep[1] = creep * sin(turn);
    c->data.spin = uniform(0, 1) < 0.5 ? 0 : creep / a * uniform(-1, 1);
}

static void
draw_wear(struct case_of *c, const struct rc_contact *e, double mises)
{
    (void)e;
    (void)mises;
    c->data.distance = 1;
    c->data.wear = powers(1e-4, 1) * 4 * c->shape.dx / estar_of(&c->problem.pair);
}

static void
draw_heat(struct case_of *c, const struct rc_contact *e, double mises)
{
    const double mean = c->problem.load / e->contact_area, a = sqrt(e->contact_area / exact_pi);

    (void)mises;
    c->data.mu = uniform(0.05, 0.6);
    for (int b = 0; b < 2; b++) {
        c->data.conductivity[b] = powers(0.2, 300);
        c->data.diffusivity[b] = powers(1e-7, 1e-4);
    }
    c->data.speed = powers(1, 300) * (c->data.conductivity[0] + c->data.conductivity[1]) /
                    (c->data.mu * mean * a);
    c->data.speed = fmin(c->data.speed, 200 * c->data.diffusivity[1] / c->shape.dx);
    if (c->problem.boundary.x)
        c->data.time = powers(0.1, 100) * a * a / c->data.diffusivity[0];
}

static void
draw_slip(struct case_of *c, const struct rc_contact *e, double mises)
{
    (void)e;
    (void)mises;
    c->problem.pair.two = c->problem.pair.one; /* like bodies */
    c->data.mu = uniform(0.1, 0.8);
    c->data.tangential = powers(0.02, 0.95) * c->data.mu * c->problem.load;
}

static void
draw_dissimilar(struct case_of *c, const struct rc_contact *e, double mises)
{
    (void)e;
    (void)mises;
    c->data.mu = powers(0.05, 1);
}

static void
set_material(struct case_of *c, double at)
{
    const double e = c->problem.pair.one.e, soft = powers(1.5, 30);
    const double part = uniform(0.1, 0.9) * (1 - 1 / soft),
                 modulus[] = {e * part, e * (1 - 1 / soft - part)};
    const double time[] = {at * powers(0.03, 30), at * powers(0.03, 30)};
    struct rc_err err;

    c->material = rc_relaxation_new(e / soft, 2, modulus, time, &err);
    assert_non_null(c->material);
    c->data.material = c->material;
}

static void
draw_relaxation(struct case_of *c, const struct rc_contact *e, double mises)
{
    (void)e;
    (void)mises;
    c->data.time = 1;
    set_material(c, powers(1, 100));
}

static void
draw_sliding(struct case_of *c, const struct rc_contact *e, double mises)
{
    (void)e;
    (void)mises;
    c->data.speed = 1;
    set_material(c, (double)c->shape.nx * c->shape.dx * 0.1 * powers(0.001, 1));
}

static const struct effect_of {
    const char *name;
    void (*draw)(struct case_of *c, const struct rc_contact *e, double mises);
    bool (*truth)(struct case_of *c, const struct rc_contact *e, struct figures *f);
    /* on periodic maps; a third of the scenes with a hardness; a third with a coat */
    bool periodic, hard, coated;
    size_t side, most; /* nodes a side; on large maps at most (0: any) */
} effects[] = {
    {"grid", draw_nothing, truth_grid, false, false, false, 48, 0},
    {"yield", draw_yield, truth_yield, false, false, false, 32, 0},
    {"fatigue", draw_fatigue, truth_fatigue, false, false, false, 32, 0},
    {"leak", draw_leak, truth_leak, true, false, false, 48, 0},
    {"adhesion", draw_adhesion, truth_adhesion, false, true, true, 48, 0},
    {"pull-off", draw_pull_off, truth_pull_off, false, false, true, 24, 64},
    {"rolling", draw_rolling, truth_rolling, false, true, false, 32, 0},
    {"wear", draw_wear, truth_wear, false, true, true, 48, 0},
    {"heat", draw_heat, truth_heat, false, true, true, 48, 0},
    {"slip", draw_slip, truth_slip, false, false, false, 32, 0},
    {"dissimilar", draw_dissimilar, truth_dissimilar, false, true, false, 24, 0},
    {"relaxation", draw_relaxation, truth_relaxation, false, false, false, 40, 0},
    {"sliding", draw_sliding, truth_sliding, true, false, false, 40, 0},
};

/* ---- the campaign ---- */

struct counts {
    size_t scenes, below, said[4], wrong, vain, outside;
};

static size_t
row_of(const char *name)
{
    size_t k = 0;

    while (rc_scene_name(k) != NULL && strcmp(rc_scene_name(k), name) != 0)
        k++;
    assert_non_null(rc_scene_name(k));
    return k;
}

static void
show(const char *what, uint64_t seed, const struct rc_scene_effect *e, const struct figures *f)
{
    if (getenv("RC_SHOW") == NULL)
        return;
    print_message("    %s %s, seed %zu, %zu nodes:", what, e->name, (size_t)seed, e->nodes);
    for (int k = 0; k < RC_SCENE_FIGURES; k++)
        if (!isnan(f->of[k]))
            print_message(" %s %.3g in %.3g to %.3g;", rc_scene_figure_names[k], f->of[k],
                          e->change[k].low, e->change[k].high);
    for (int k = 0; k < RC_SCENE_NUMBERS && e->number_name[k] != NULL; k++)
        print_message(" %s %.3g", e->number_name[k], e->number[k]);
    print_message("\n");
}

static void
judge(struct counts count[SCALES], uint64_t seed, const struct rc_scene_effect *e,
      const struct figures *f)
{
    const char *all = getenv("RC_SHOW");
    bool outside = false;

    if (all != NULL && strcmp(all, "all") == 0)
        show("case", seed, e, f);
    for (int k = 0; k < RC_SCENE_FIGURES; k++)
        outside = outside ||
                  (!isnan(f->of[k]) && !isnan(e->change[k].high) && e->nodes >= 20 &&
                   (f->of[k] < e->change[k].low - 0.001 || f->of[k] > e->change[k].high + 0.001));
    if (outside)
        show("outside", seed, e, f);
    for (int s = 0; s < SCALES; s++) {
        const struct rc_scene_bounds b = {
            .relative = bounds_of[s], .temperature = 1000 * bounds_of[s], .friction = bounds_of[s]};
        const enum rc_scene_verdict verdict = rc_scene_judge(e, &b, NULL);
        bool above = false;

        for (int k = 0; k < RC_SCENE_FIGURES; k++)
            above = above || (!isnan(e->change[k].high) &&
                              f->of[k] > (k == RC_SCENE_TEMPERATURE ? b.temperature
                                          : k == RC_SCENE_FATIGUE   ? 1
                                          : k == RC_SCENE_LEAK      ? 0.5
                                                                    : b.relative));
        for (int k = 0; k < RC_SCENE_FIGURES && e->basis == RC_SCENE_EXACT; k++)
            above = above || f->of[k] > b.relative;
        count[s].scenes++;
        count[s].below += !above;
        count[s].said[verdict]++;
        count[s].outside += outside;
        count[s].wrong += verdict == RC_SCENE_NEGLIGIBLE && above;
        count[s].vain += verdict == RC_SCENE_CALLS && !above;
        if (verdict == RC_SCENE_NEGLIGIBLE && above)
            show("false", seed, e, f);
        if (verdict == RC_SCENE_CALLS && !above)
            show("in vain", seed, e, f);
    }
}

static double
most_mises(const struct case_of *c, const double *p)
{
    struct rc_stress_options o = {
        .boundary = c->problem.boundary, .body = c->problem.pair.one, .wanted = 1U << RC_MISES};
    static double map[MOST];
    double *to[RC_STRESSES] = {[RC_MISES] = map}, most = 0;
    struct rc_err err;
    RC_OWN(rc_stress, stress) = rc_stress_new(&c->shape, p, &o, &err);

    for (double z = 0.25; z < 8; z += 0.25) {
        assert_int_equal(rc_stress_slice(stress, z * c->shape.dx, to, &err), RC_OK);
        for (size_t k = 0; k < c->shape.nx * c->shape.ny; k++)
            most = fmax(most, map[k]);
    }
    return most;
}

/* Estimates from the contact with this effect. */
static bool
accept(struct rc_scene *s, const char *name)
{
    struct rc_scene_effect e;
    struct rc_err err;

    if (rc_scene_estimate(s, row_of(name), &e, &err) != RC_OK || e.unfit[0] != '\0')
        return false;
    rc_scene_accept(s, row_of(name));
    return true;
}

static void
campaign(const struct effect_of *effect, size_t side, size_t scenes, uint64_t first)
{
    static struct case_of c;
    struct counts count[SCALES] = {0};
    const size_t row = row_of(effect->name);
    size_t tried = 0;

    for (uint64_t seed = first; count[0].scenes < scenes && tried < 16 * scenes; seed++, tried++) {
        struct rc_scene_effect e;
        struct figures f = none();
        struct rc_contact before;
        struct rc_err err;

        make(&c, seed, effect->periodic, side);
        RC_OWN(rc_scene, plain) = rc_scene_new(&c.shape, c.h, &c.problem, &c.data, &err);
        if (plain == NULL || rc_scene_contact(plain)->contact_nodes < 20)
            continue;
        before = *rc_scene_contact(plain);
        effect->draw(&c, &before,
                     effect->draw == draw_yield || effect->draw == draw_fatigue
                         ? most_mises(&c, rc_scene_pressure(plain))
                         : 0);
        if (effect->hard && seed % 3 == 0)
            c.data.hardness = before.max_pressure * uniform(0.2, 0.9);
        if (effect->coated && seed % 3 == 1) {
            c.coat = (struct rc_layer){c.shape.dx * powers(0.5, 10),
                                       c.problem.pair.one.e * powers(0.1, 10), 0.3};
            c.data.layers = 1;
            c.data.layer = &c.coat;
        }
        RC_OWN(rc_scene, s) = rc_scene_new(&c.shape, c.h, &c.problem, &c.data, &err);
        if (s != NULL && c.data.layers > 0) {
            c.problem.pair.one.layers = 1;
            c.problem.pair.one.layer = &c.coat;
            if (!accept(s, "coat"))
                continue;
        }
        if (s != NULL && c.data.hardness > 0) {
            c.problem.hardness = c.data.hardness;
            if (!accept(s, "hardness"))
                continue;
        }
        if (s != NULL)
            before = *rc_scene_contact(s);
        if (s != NULL && rc_scene_estimate(s, row, &e, &err) == RC_OK && e.unfit[0] == '\0' &&
            effect->truth(&c, &before, &f))
            judge(count, seed, &e, &f);
        rc_relaxation_free(c.material);
    }
    for (int s = 0; s < SCALES; s++) {
        const struct counts *n = &count[s];
        print_message("%-10s %.1f %%: %zu scenes, %zu below; negligible %zu, %zu false; calls %zu, "
                      "%zu in vain; not decided %zu; outside %zu\n",
                      effect->name, 100 * bounds_of[s], n->scenes, n->below,
                      n->said[RC_SCENE_NEGLIGIBLE], n->wrong, n->said[RC_SCENE_CALLS], n->vain,
                      n->said[RC_SCENE_UNDECIDED], n->outside);
        assert_int_equal(n->wrong, 0);
        assert_true(n->vain * 200 <= n->scenes);
    }
    assert_true(count[0].scenes * 2 >= scenes);
}

static void
hold(size_t side, size_t scenes, uint64_t first)
{
    const char *only = getenv("RC_ONLY"), *from = getenv("RC_FROM");

    for (size_t k = 0; k < sizeof effects / sizeof *effects; k++)
        if (only == NULL || strcmp(only, effects[k].name) == 0)
            campaign(&effects[k],
                     side == 0                                       ? effects[k].side
                     : effects[k].most > 0 && side > effects[k].most ? effects[k].most
                                                                     : side,
                     scenes, from == NULL ? first : (uint64_t)atol(from));
}

static void
verdicts_hold(void **state)
{
    (void)state;
    if (getenv("RC_SIDE") == NULL)
        hold(0, thorough(200, 20), 1000);
}

static void
verdicts_hold_on_large_maps(void **state)
{
    const char *side = getenv("RC_SIDE");

    (void)state;
    if (thorough(1, 0) == 1)
        hold(side == NULL ? SIDE : (size_t)atol(side), 40, 2000);
}

/* A hard body with 123 nodes in contact. In the estimate one node joins and another leaves; in the true
 * contact only one of them changes. */
static void
nodes_change_places(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof effects / sizeof *effects; k++)
        if (strcmp(effects[k].name, "dissimilar") == 0)
            campaign(&effects[k], effects[k].side, 1, 340125);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nodes_change_places),
        cmocka_unit_test(verdicts_hold),
        cmocka_unit_test(verdicts_hold_on_large_maps),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
