/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each allocation in a public function of libcontact fails, alone or with all later ones. The result must
 * still be right, or the function fails with a reason, leaves its arguments unchanged and holds no memory.
 * The list of functions is read from the headers; a function without a test is an error. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "failing_malloc.h"
#include "tools/machine/machine.h"
#include "libcontact/contact.h"
#include "tests/exact.h"
#include "libcontact/volume/volume.h"
#include "uses.h"

enum {
    NX = 16,
    NY = 18,
    N = NX * NY,
    OUT = 4 * N + 4 /* most numbers that a use returns: four maps and four figures */
};

static const struct rc_shape shape = {NX, NY, 1.1e-6, 1e-6};
static const struct rc_layer layer = {2e-6, 2e9, 0.3};
static const struct rc_pair layered = {.one = {1e9, 0.3, 1, &layer}};
static double rough[N], holed[N], pressure[N], hardness[N];

/* A function that changes a map in place leaves it unchanged after a failure. */
static enum rc_status
or_as_before(enum rc_status status, const double *map, const double *before)
{
    if (status != RC_OK)
        assert_memory_equal(map, before, N * sizeof *map);
    return status;
}

/* ---- grids ---- */

static enum rc_status
grids(double *out, struct rc_err *err)
{
    enum rc_status status = RC_FAIL;
    struct rc_grid *g = rc_grid_new(&shape, "height", "m", err), *like = NULL, *part = NULL;

    if (g == NULL || (part = rc_grid_new_part(&shape, 1, "height", "m", err)) == NULL ||
        rc_grid_set(g, "note", "a", err) != RC_OK ||
        rc_grid_set_number(g, "estar", 1e9, err) != RC_OK ||
        rc_grid_history(g, "a step", err) != RC_OK || rc_grid_history(g, "another", err) != RC_OK ||
        rc_text_set(&g->unit, "um", err) != RC_OK ||
        (like = rc_grid_like(g, "pressure", "Pa", err)) == NULL)
        goto done;
    rc_grid_number(like, "estar", &out[0]);
    (void)rc_grid_dunit(like), rc_grid_origin(like, &out[1], &out[2]);
    out[1] = (double)like->keys + (double)rc_grid_nodes(part);
    out[2] = (double)strlen(rc_grid_get(like, "history"));
    status = RC_OK;
done:
    rc_grid_free(g);
    rc_grid_free(like);
    rc_grid_free(part);
    return status;
}

/* ---- surfaces ---- */

static enum rc_status
selfaffine(double *out, struct rc_err *err)
{
    static const struct rc_selfaffine what = {
        .hurst = 0.8, .rms_slope = 0.1, .seed = 3, .anisotropy = 2, .skewness = 1};

    return rc_synth_selfaffine(&shape, &what, out, err);
}

static enum rc_status
form(const struct rc_form *what, const double *h, double *out, struct rc_err *err)
{
    memcpy(out, h, sizeof rough);
    return or_as_before(rc_detrend_form(&shape, what, out, &out[N], err), out, h);
}

static enum rc_status
polynomial(double *out, struct rc_err *err)
{
    static const struct rc_form what = {.degree = 3};

    memcpy(out, rough, sizeof rough);
    return or_as_before(rc_detrend_form(&shape, &what, out, NULL, err), out, rough);
}

/* Heights of `rough` that are read row by row, and the result. */
struct rows {
    size_t at, put;
    double *out;
};

static enum rc_status
rows_again(void *of, struct rc_err *err)
{
    (void)err;
    ((struct rows *)of)->at = 0;
    return RC_OK;
}

static enum rc_status
rows_read(void *of, size_t n, double *v, struct rc_err *err)
{
    struct rows *r = of;

    (void)err;
    memcpy(v, rough + r->at, n * shape.nx * sizeof *v);
    r->at += n * shape.nx;
    return RC_OK;
}

static enum rc_status
rows_write(void *of, size_t n, const double *v, struct rc_err *err)
{
    struct rows *r = of;

    (void)err;
    memcpy(r->out + r->put, v, n * shape.nx * sizeof *v);
    r->put += n * shape.nx;
    return RC_OK;
}

/* By rows, with the result of the heights in memory. */
static enum rc_status
polynomial_of_rows(double *out, struct rc_err *err)
{
    static const struct rc_form what = {.degree = 3};
    struct rows r = {0, 0, out};
    const struct rc_row_source source = {&r, rows_again, rows_read, rows_write};
    enum rc_status status = rc_detrend_source(&shape, &what, &source, err);
    double whole[N];

    if (status != RC_OK)
        return status;
    memcpy(whole, rough, sizeof whole);
    status = rc_detrend_form(&shape, &what, whole, NULL, err);
    return status == RC_OK && memcmp(whole, out, sizeof whole) != 0
               ? rc_err_set(err, "rows give another result")
               : status;
}

static enum rc_status
figures_of_rows(double *out, struct rc_err *err)
{
    struct rows r = {0};
    const struct rc_row_source source = {&r, rows_again, rows_read, NULL};
    struct rc_statistics s;

    if (rc_measure_source(&shape, &source, &s, err) != RC_OK)
        return RC_FAIL;
    out[0] = s.rms;
    return RC_OK;
}

static enum rc_status
robust_sphere(double *out, struct rc_err *err)
{
    static const struct rc_form what = {.kind = RC_SPHERE, .robust = true, .threads = 1};
    double h[N];

    rc_synth_sphere(&shape, 1e-3, h);
    for (size_t k = 0; k < N; k++)
        h[k] += 0.01 * rough[k];
    return form(&what, h, out, err);
}

static enum rc_status
cylinder(double *out, struct rc_err *err)
{
    static const struct rc_form what = {.kind = RC_CYLINDER, .threads = 1};
    double h[N];

    rc_synth_paraboloid(&shape, (struct rc_place){0, 0}, 1e-3, INFINITY, 30, h);
    for (size_t k = 0; k < N; k++)
        h[k] += 0.01 * rough[k];
    return form(&what, h, out, err);
}

static enum rc_status
levelled_rows(double *out, struct rc_err *err)
{
    memcpy(out, holed, sizeof holed);
    return rc_detrend_rows(&shape, 2, true, out, err);
}

static enum rc_status
filtered(double *out, struct rc_err *err)
{
    static const struct rc_filter what = {
        .cutoff = 5e-6, .high = true, .robust = true, .threads = 1};

    memcpy(out, holed, sizeof holed);
    return or_as_before(rc_filter(&shape, &what, out, err), out, holed);
}

static enum rc_status
outliers(double *out, struct rc_err *err)
{
    size_t count = 0;

    memcpy(out, holed, sizeof holed);
    if (or_as_before(rc_outliers(&shape, 2, RC_FREE, 1, out, &count, err), out, holed) != RC_OK)
        return RC_FAIL;
    out[N] = (double)count;
    return RC_OK;
}

static enum rc_status
without_spikes(double *out, struct rc_err *err)
{
    size_t count = 0;

    memcpy(out, holed, sizeof holed);
    if (or_as_before(rc_spikes(&shape, 1, RC_FREE, 1, out, &count, err), out, holed) != RC_OK)
        return RC_FAIL;
    out[N] = (double)count;
    return RC_OK;
}

static enum rc_status
aligned(double *out, struct rc_err *err)
{
    const struct rc_shape s = {20, 16, 1e-6, 1e-6};
    double a[320], b[320], change[320];
    struct rc_alignment found;

    for (size_t k = 0; k < 320; k++) {
        const double x = (double)(k % 20), y = (double)(k / 20);
        a[k] = 1e-6 * (sin(0.9 * x) + cos(0.7 * y + 0.3 * x));
        b[k] = 1e-6 * (sin(0.9 * (x + 1)) + cos(0.7 * y + 0.3 * (x + 1))) + 1e-9 * sin(x * y);
    }
    if (rc_align(&s, a, &s, b, 1, 1, change, &found, err) != RC_OK)
        return RC_FAIL;
    out[N] = found.shift_x;
    return RC_OK;
}

static enum rc_status
tapered(double *out, struct rc_err *err)
{
    memcpy(out, rough, sizeof rough);
    return or_as_before(rc_taper(&shape, 3e-6, out, err), out, rough);
}

static enum rc_status
holes(double *out, struct rc_err *err)
{
    size_t filled = 0;

    memcpy(out, holed, sizeof holed);
    if (rc_hole_width(&shape, out, &out[N], err) != RC_OK ||
        rc_inpaint(&shape, out, &filled, err) != RC_OK)
        return RC_FAIL;
    out[N + 1] = (double)filled;
    return RC_OK;
}

static enum rc_status
resampled(double *out, struct rc_err *err)
{
    struct rc_shape to;

    if (rc_resample_shape(&shape, 0.8e-6, 2.1e-6, &to, err) != RC_OK)
        return RC_FAIL;
    return rc_resample(&shape, holed, RC_FREE, &to, out, err);
}

static enum rc_status
patches(double *out, struct rc_err *err)
{
    static const struct rc_patch_options o = {.largest = SIZE_MAX, .threads = 1};
    struct rc_patches found;
    enum rc_status status = rc_patches_find(&shape, pressure, &o, &found, err);

    if (status == RC_OK)
        for (size_t k = 0; k < found.count && k < N; k++)
            out[k] = found.patch[k].perimeter;
    rc_patches_free(&found);
    return status;
}

static enum rc_status
areal(double *out, struct rc_err *err)
{
    static const struct rc_surface_options o = {.threads = 1};
    struct rc_areal a;
    enum rc_status status = rc_areal(&shape, holed, &o, &a, err);

    if (status == RC_OK)
        memcpy(out, &a, sizeof a);
    return status;
}

static enum rc_status
features(double *out, struct rc_err *err)
{
    static const struct rc_surface_options o = {.threads = 1};
    struct rc_features a;
    enum rc_status status = rc_features(&shape, rough, &o, &a, err);

    if (status == RC_OK) {
        out[0] = a.spd;
        out[1] = a.svd;
    }
    return status;
}

static enum rc_status
spectrum(double *out, struct rc_err *err)
{
    struct rc_psd_options o = {.map = out, .threads = 1};
    struct rc_psd *psd = rc_psd_new(&shape, rough, &o, err);

    if (psd == NULL)
        return RC_FAIL;
    memcpy(out + N, psd->c, psd->rings * sizeof *psd->c);
    rc_psd_free(psd);
    return RC_OK;
}

/* ---- convolutions ---- */

static enum rc_status
convolved(const struct rc_pair *pair, const struct rc_conv_options *o, double *out,
          struct rc_err *err)
{
    struct rc_conv *conv = rc_conv_new(&shape, pair, o, err);

    if (conv == NULL)
        return RC_FAIL;
    rc_conv_apply(conv, pressure, out);
    out[N] = rc_conv_error(conv);
    rc_conv_free(conv);
    return RC_OK;
}

CONVOLUTION(free_fft, bare, .engine = "fft")
CONVOLUTION(single_fft, bare, .engine = "fft", .tol = 1e-3)
CONVOLUTION(periodic_fft, bare, .engine = "fft", .boundary = {.x = true, .y = true})
CONVOLUTION(mlms, bare, .engine = "mlms", .tol = 1e-4)
CONVOLUTION(direct, bare, .engine = "direct")
CONVOLUTION(coated, layered, .tol = 0)
CONVOLUTION(line, bare, .boundary = {.y = true})
CONVOLUTION(column, layered, .boundary = {.x = true})
CONVOLUTION(coated_periodic, layered, .boundary = {.x = true, .y = true})

/* ---- contact ---- */

static enum rc_status
solved(const struct rc_problem *problem, double *out, struct rc_err *err)
{
    double *const field[4] = {out, out + N, out + 2 * N, out + 3 * N};
    double stiffness;

    if (solve_twice(&shape, rough, problem, N, field, &stiffness, err) != RC_OK)
        return RC_FAIL;
    out[4 * N - 1] = stiffness;
    return RC_OK;
}

CONTACT(free_contact, bare, .load = 1e-3)
CONTACT(hard_contact, bare, .load = 1e-3, .hardness = 2e7, .boundary = RC_PERIODIC)
CONTACT(two_phases, bare, .load = 1e-3, .hardness_map = hardness)
CONTACT(paper_method, bare, .load = 1e-3, .method = "pk99", .engine = "mlms")
CONTACT(to_an_approach, bare, .approach = 1e-7, .discretization = true)
CONTACT(coated_contact, layered, .load = 1e-3)
CONTACT(coated_line_contact, layered, .load = 1e-3, .boundary = {.x = true})
CONTACT(free_to_tilt, bare, .load = 1e-3, .tilt_free = true)

/* ---- models ---- */

/* A model and two points of its history. The first point becomes history. On the way to the second one, after
 * some steps, the state goes into another model, which reaches the point; a frame and a figure are read. */
struct story {
    struct rc_model *(*make)(struct rc_err *err);
    struct rc_relaxation *(*material)(struct rc_err *err); /* NULL: none; it outlives the models */
    struct rc_point first, second;
    int steps;                             /* on the way to the second point, at least one */
    bool (*under_way)(struct rc_model *m); /* more steps, until it is true; NULL: none     */
    const char *frame;
    double (*figure)(struct rc_model *m);
    /* what only this model has, at the second point; NULL: nothing */
    enum rc_status (*more)(struct rc_model *m, double *out, struct rc_err *err);
};
static struct rc_relaxation *rubber; /* the material of the present story */

static void
set_point(struct rc_point *to, const struct rc_point *given)
{
    for (enum rc_axis axis = 0; axis < RC_AXES; axis++)
        if (given->given >> axis & 1)
            rc_point_set(to, axis, given->at[axis]);
}

/* To the first point, and some steps towards the second one. */
static enum rc_status
begin(struct rc_model *m, const struct story *s, struct rc_point *to, struct rc_err *err)
{
    struct rc_expected expected;

    set_point(to, &s->first);
    if (rc_model_plan(m, to, &expected, err) != RC_OK || rc_model_run(m, to, err) == RC_FAIL ||
        rc_model_keep(m, err) != RC_OK)
        return RC_FAIL;
    set_point(to, &s->second);
    if (rc_model_go(m, to, err) != RC_MORE)
        return RC_FAIL;
    for (int k = 0; k < s->steps || (s->under_way != NULL && !s->under_way(m)); k++)
        if (rc_model_step(m, err) != RC_MORE)
            return rc_err_set(err, "%s: no step %d", rc_model_name(m), k);
    return RC_OK;
}

static enum rc_status
told(const struct story *s, double *out, struct rc_err *err)
{
    struct rc_model *m = NULL, *other = NULL;
    enum rc_status status = RC_FAIL;
    struct rc_point to = {0};
    double *state = NULL;
    bool going;
    size_t n;

    if (s->material != NULL && (rubber = s->material(err)) == NULL)
        return RC_FAIL;
    if ((m = s->make(err)) == NULL || begin(m, s, &to, err) != RC_OK)
        goto done;
    n = rc_model_state_size(m);
    if ((state = malloc(n * sizeof *state)) == NULL) {
        rc_err_set(err, "out of memory for a state of %zu numbers", n);
        goto done;
    }
    rc_model_state(m, state);
    if ((other = s->make(err)) == NULL || rc_model_restore(other, state, n, &going, err) != RC_OK)
        goto done;
    assert_true(going);
    while ((status = rc_model_step(other, err)) == RC_MORE)
        continue;
    if (status == RC_FAIL)
        goto done;
    status = RC_FAIL;
    if (rc_model_look(other, NULL, err) == RC_OK &&
        rc_model_frame(other, s->frame, out, err) == RC_OK) {
        out[N] = s->figure(other);
        status = s->more == NULL ? RC_OK : s->more(other, out + N + 1, err);
    }
done:
    free(state);
    rc_model_free(m);
    rc_model_free(other);
    rc_relaxation_free(rubber);
    rubber = NULL;
    return status;
}

/* MAKER(name, model): the function `name` makes this model. FIGURE(name, result): the function `name`
 * gives this result of a model m. */
#define MAKER(name, model)                                                                         \
    static struct rc_model *name(struct rc_err *err)                                               \
    {                                                                                              \
        return model;                                                                              \
    }
#define FIGURE(name, result)                                                                       \
    static double name(struct rc_model *m)                                                         \
    {                                                                                              \
        return result;                                                                             \
    }

static struct rc_model *
elastic(struct rc_err *err)
{
    static const struct rc_problem o = {
        .pair.estar = 1e9, .tol = 1e-5, .hardness = 2e7, .threads = 1};
    static const struct rc_elastic_asks asks = {.stiffness = true};

    return rc_elastic_new(&shape, rough, &o, &asks, err);
}
FIGURE(stiffness, rc_elastic_result(m)->stiffness)

static enum rc_status
other_heights(struct rc_model *m, double *out, struct rc_err *err)
{
    struct rc_loops loops;
    struct rc_point at;
    const void *data;

    if (rc_model_set_heights(m, rough, err) != RC_OK ||
        rc_model_set_compliance(m, 0, NULL, 0, err) != RC_OK ||
        rc_model_run(m, &(struct rc_point){1U << RC_LOAD, {[RC_LOAD] = 1e-3}}, err) == RC_FAIL ||
        rc_model_look(m, &at, err) != RC_OK ||
        rc_model_frame(m, rc_model_frame_kind(m, 1)->name, out, err) != RC_OK)
        return RC_FAIL;
    rc_model_progress(m, &loops);
    out[N] = rc_model_number(m, rc_model_figure(m, 0, &data)->name) + (double)loops.n;
    out[N + 1] = at.at[RC_LOAD] + (double)rc_model_shape(m).nx + rc_model_name(m)[0];
    out[N + 2] = rc_axis_info(0)->name[0] + rc_solver_load(rc_model_solver(m));
    return RC_OK;
}

static const struct rc_problem *
pressed(struct rc_boundary boundary)
{
    static struct rc_problem contact;

    contact = (struct rc_problem){.boundary = boundary, .pair = bare, .tol = 1e-3, .threads = 1};
    return &contact;
}

static struct rc_yield_problem
yields(void)
{
    return (struct rc_yield_problem){
        .contact = {.boundary = RC_PERIODIC, .pair = bare, .tol = 0.1, .threads = 1},
        .law.stress = bare.one.e / 100};
}

static struct rc_model *
given_slabs(struct rc_err *err)
{
    static const double slabs[] = {.5e-6, .7e-6, 1e-6};
    struct rc_yield_problem problem = yields();

    problem.slabs = 3;
    problem.thickness = slabs;
    problem.increments = 4;
    return rc_yield_new(&shape, rough, &problem, err);
}
FIGURE(depth, rc_yield_result(m)->last.depth + (double)rc_yield_result(m)->slabs)

/* A load is given up half-way for the same again. */
static enum rc_status
again(struct rc_model *m, double *out, struct rc_err *err)
{
    const struct rc_point to = {1U << RC_LOAD, {[RC_LOAD] = 1e-3}};

    if (rc_model_keep(m, err) != RC_OK || rc_model_go(m, &to, err) != RC_MORE ||
        rc_model_step(m, err) == RC_FAIL || rc_model_run(m, &to, err) == RC_FAIL ||
        rc_model_look(m, NULL, err) != RC_OK)
        return RC_FAIL;
    return rc_model_frame(m, "residual", out, err);
}

/* Automatic slabs and increments; the first of two loads does not yield. */
static struct rc_model *
may_yield(struct rc_err *err)
{
    const struct rc_yield_problem problem = yields();
    struct rc_model *m = rc_yield_new(&shape, rough, &problem, err);

    if (m != NULL)
        rc_yield_plan(m, 2, 1e-3);
    return m;
}

static double
slabs_found(struct rc_model *m)
{
    const struct rc_yield_problem problem = yields();

    return (double)rc_yield_result(m)->slabs + rc_yield_law_stress(&problem.law, 0);
}

static bool
has_strain(struct rc_model *m)
{
    static double map[N];
    double *const strain[RC_YIELD_STRAINS] = {map};

    return rc_yield_strain(m, 0, strain);
}

/* Dissimilar bodies are pressed and moved. */
static struct rc_friction_problem
rubs(void)
{
    return (struct rc_friction_problem){
        .law = {.boundary = RC_PERIODIC, .pair = bare, .mu = 0.3, .threads = 1},
        .increments = 2,
        .fewer = 1};
}

static struct rc_model *
friction(struct rc_err *err)
{
    const struct rc_problem contact = {.boundary = RC_PERIODIC, .pair = bare, .threads = 1};
    struct rc_friction_problem law = rubs();

    law.inner_of_fewer[0] = rc_elastic_new(&shape, rough, &contact, NULL, err);
    return rc_friction_new(rc_elastic_new(&shape, rough, &contact, NULL, err), rough, &law, err);
}

static double
force(struct rc_model *m)
{
    const struct rc_point to = {1U << RC_DISPLACEMENT_X, {[RC_DISPLACEMENT_X] = 2e-9}};
    const struct rc_friction_problem law = rubs();

    return rc_friction_result(m)->last.force[0] +
           (double)rc_friction_leg(&law, &(struct rc_leg){0}, &(struct rc_point){0}, &to)
               .increments;
}

static const double *
ball(void)
{
    static double h[N];

    for (size_t k = 0; k < N; k++) {
        const double x = (double)(k % shape.nx) - (double)shape.nx / 2,
                     y = (double)k / (double)shape.nx - (double)shape.ny / 2;
        h[k] = -(x * x + y * y) * shape.dx * 0.01;
    }
    return h;
}

/* A ball rolls, with the force given. */
static struct rc_model *
roller(bool path, struct rc_err *err)
{
    const struct rc_rolling_problem law = {
        .law = {.pair = bare, .mu = 0.3, .tol = 1e-2, .threads = 1}, .force = true, .path = path};

    return rc_rolling_new(rc_elastic_new(&shape, ball(), pressed(RC_FREE), NULL, err), &law, err);
}
MAKER(rolling, roller(false, err))
MAKER(rolling_along, roller(true, err))
FIGURE(creepage, rc_rolling_result(m)->creep[0])

/* Both bodies wear, with a coefficient that differs between two phases, or they slide over each other. */
static struct rc_model *
worn(bool two_bodies, struct rc_err *err)
{
    struct rc_problem contact = *pressed(RC_FREE);
    static double phase[N];
    const struct rc_wear_problem law = {.k = {1e-12, 1e-12},
                                        .estar = 1e9,
                                        .tol = 0.3,
                                        .part = two_bodies ? NULL : phase,
                                        .two_bodies = two_bodies,
                                        .h2 = rough};

    contact.hardness = two_bodies ? 0 : 2e7;
    for (size_t k = 0; k < N; k++)
        phase[k] = k < N / 2 ? 1 : 0.05;
    return rc_wear_new(rc_elastic_new(&shape, rough, &contact, NULL, err), rough, &law, err);
}
MAKER(wear, worn(false, err))
MAKER(wear_of_two, worn(true, err))
FIGURE(volume, rc_wear_result(m)->wear_volume)

/* A ball travels over a map. */
static struct rc_model *
travel(struct rc_err *err)
{
    const struct rc_travel_problem law = {
        .track = shape, .h1 = rough, .counter = shape, .h2 = rough, .radius = 1e-4};

    return rc_travel_new(rc_elastic_new(&shape, rough, pressed(RC_FREE), NULL, err), &law, err);
}
FIGURE(height, rc_travel_result(m)->height)

/* A load dents the bodies, which are then moved and pulled apart. */
static struct rc_adhesion_problem
sticky(void)
{
    struct rc_adhesion_problem problem = {.contact = *pressed(RC_FREE), .work = 1e-3};

    problem.contact.hardness_map = hardness;
    return problem;
}

static struct rc_model *
adhesion(struct rc_err *err)
{
    const struct rc_adhesion_problem problem = sticky();

    return rc_adhesion_new(&shape, rough, &problem, err);
}
FIGURE(attraction, rc_adhesion_result(m)->state.load)

static enum rc_status
pulled_off(struct rc_model *m, double *out, struct rc_err *err)
{
    const struct rc_adhesion_problem problem = sticky();
    struct rc_adhesion_scales scales;
    struct rc_expected expected;
    struct rc_point to = {0};

    rc_point_set(&to, RC_APPROACH, -INFINITY);
    if (rc_adhesion_check(&shape, &problem, &scales, err) != RC_OK ||
        rc_adhesion_expect(&shape, &problem, &expected, err) != RC_OK ||
        rc_model_keep(m, err) != RC_OK || rc_model_run(m, &to, err) == RC_FAIL ||
        rc_model_look(m, NULL, err) != RC_OK)
        return RC_FAIL;
    out[0] = rc_adhesion_result(m)->state.pull_off_load;
    out[1] = scales.range + rc_adhesion_law_info(0)->ranged;
    return RC_OK;
}

/* Body 2 slides over a viscoelastic body, or is pressed on it in time. */
static struct rc_relaxation *
fast_rubber(struct rc_err *err)
{
    return rc_relaxation_new(1e9, 1, (double[]){4e9}, (double[]){1e-3}, err);
}
static struct rc_relaxation *
slow_rubber(struct rc_err *err)
{
    return rc_relaxation_new(4e8, 2, (double[]){4e8, 2e8}, (double[]){0.1, 1}, err);
}

static struct rc_model *
sliding(struct rc_err *err)
{
    const struct rc_problem contact = {.boundary = RC_PERIODIC, .tol = 1e-3, .threads = 1};
    const struct rc_sliding_problem law = {.material = rubber};

    return rc_sliding_new(&shape, rough, &contact, &law, err);
}
FIGURE(losses, rc_sliding_result(m)->friction)

static struct rc_model *
creep(struct rc_err *err)
{
    const struct rc_problem contact = {.pair.estar = 1e9, .tol = 1e-5, .threads = 1};
    const struct rc_viscoelastic_problem law = {.material = rubber, .share = 1, .increments = 2};

    return rc_viscoelastic_new(rc_elastic_new(&shape, rough, &contact, NULL, err), rough, &law,
                               err);
}
FIGURE(equivalent_load, rc_viscoelastic_result(m)->equivalent_load)

/* ---- leakage ---- */

/* Strips of contact with an open channel, a dead end and enclosed fluid. */
static enum rc_status
leaks(double *out, struct rc_err *err)
{
    static const struct rc_leak_options options = {.around = true, .threads = 1};
    double p[N] = {0}, g[N];
    enum rc_status status = RC_FAIL;
    struct rc_leak *leak;

    for (size_t k = 0; k < N; k++) {
        size_t i = k % NX, j = k / NX;
        p[k] = (i == 5 && j != 4) || (i == 10 && j > 2) || (i == 7 && j == 8) ? 1e6 : 0;
        g[k] = p[k] > 0 ? 0 : 1e-6 + 1e-7 * (double)(k % 7);
    }
    if (!(rc_leak_expect(N, 1).seconds > 0) ||
        (leak = rc_leak_new(&shape, p, g, &options, err)) == NULL)
        return RC_FAIL;
    while ((status = rc_leak_step(leak, err)) == RC_MORE)
        continue;
    if (status == RC_OK && (status = rc_leak_set_gap(leak, p, g, err)) == RC_OK)
        while ((status = rc_leak_step(leak, err)) == RC_MORE)
            continue;
    if (status == RC_OK) {
        rc_leak_pressure(leak, out);
        rc_leak_flux(leak, out + N);
        rc_leak_channel(leak, out + 2 * N);
        out[3 * N] = rc_leak_result(leak)->conductance;
        out[3 * N + 1] = rc_leak_result(leak)->lower;
    }
    rc_leak_free(leak);
    return status;
}

/* ---- scenes ---- */

static enum rc_status
scene(double *out, struct rc_err *err)
{
    static const struct rc_problem problem = {.boundary = {.x = true, .y = true},
                                              .pair = {{1e9, 0.3}, {2e9, 0.3}},
                                              .load = 1e-3,
                                              .threads = 1};
    static const double modulus = 5e8, time = 1;
    const struct rc_layer coat = {1e-6, 2e9, 0.3};
    enum rc_status status = RC_OK;
    RC_OWN(rc_relaxation, material) = rc_relaxation_new(5e8, 1, &modulus, &time, err);
    const struct rc_scene_data data = {.hardness = 1e8,
                                       .layers = 1,
                                       .layer = &coat,
                                       .thickness = 1e-5,
                                       .yield = 1e8,
                                       .work = 1e-2,
                                       .mu = 0.3,
                                       .tangential = 1e-4,
                                       .speed = 1e-6,
                                       .creep = {1e-4, 0},
                                       .wear = 1e-15,
                                       .distance = 1e-6,
                                       .conductivity = {45, 16},
                                       .diffusivity = {1e-5, 4e-6},
                                       .time = 1,
                                       .material = material};
    RC_OWN(rc_scene, s) =
        material == NULL ? NULL : rc_scene_new(&shape, rough, &problem, &data, err);

    if (s == NULL)
        return RC_FAIL;
    for (size_t k = 0; rc_scene_name(k) != NULL && status == RC_OK; k++) {
        const struct rc_scene_bounds bounds = {0};
        struct rc_scene_effect e;
        status = rc_scene_estimate(s, k, &e, err);
        if (status != RC_OK)
            continue;
        out[k] = (double)rc_scene_judge(&e, &bounds, NULL);
        rc_scene_accept(s, k);
    }
    out[20] = rc_scene_contact(s)->contact_area;
    out[21] = rc_scene_pressure(s)[0];
    out[22] = rc_scene_convolutions(s);
    out[23] = (double)(rc_scene_figure_names[0][0] + rc_scene_basis_names[0][0] +
                       rc_scene_verdict_names[0][0]);
    return status;
}

static enum rc_status
rolling_scene(double *out, struct rc_err *err)
{
    const struct rc_scene_data data = {.mu = 0.3, .creep = {1e-3, 0}};
    struct rc_problem problem = *pressed(RC_FREE);
    struct rc_scene_effect e;
    size_t k = 0;

    problem.load = 1e-3;
    RC_OWN(rc_scene, s) = rc_scene_new(&shape, ball(), &problem, &data, err);

    while (strcmp(rc_scene_name(k), "rolling") != 0)
        k++;
    if (s == NULL || rc_scene_estimate(s, k, &e, err) != RC_OK)
        return RC_FAIL;
    out[0] = e.change[RC_SCENE_FRICTION].high;
    return RC_OK;
}

/* ---- stresses ---- */

static enum rc_status
stressed(const struct rc_stress_options *o, double *out, struct rc_err *err)
{
    double *const field[4] = {out, out + N, out + 2 * N, out + 3 * N};

    return two_slices(&shape, pressure, o, field, err);
}

STRESS(free_stress, bare, .mu = 0.1)
STRESS(periodic_stress, bare, .mu = 0.1, .boundary = RC_PERIODIC)
STRESS(line_stress, bare, .mu = 0.1, .boundary = {.y = true})
STRESS(column_stress, layered, .boundary = {.x = true})
STRESS(line_section, bare, .boundary = {.x = true}, .section = 'x')
STRESS(column_section, bare, .boundary = {.x = true}, .section = 'y')
STRESS(direct_stress, bare, .engine = "direct")
STRESS(mlms_stress, bare, .engine = "mlms", .tol = 1e-3)
STRESS(section_stress, bare, .section = 'y')
STRESS(coated_stress, layered, .mu = 0)
STRESS(traction_stress, bare, .traction = {pressure, rough})
STRESS(traction_section, bare, .traction = {NULL, pressure}, .section = 'x')

/* The stress of a slab with plastic strain. */
static enum rc_status
strained_stress(double *out, struct rc_err *err)
{
    const double thickness = 1e-6, *const map[5] = {[2] = rough};
    const struct rc_eigenstrain strain = {.slabs = 1, .thickness = &thickness, .map = map};
    const struct rc_stress_options o = {.boundary = RC_PERIODIC,
                                        .body = bare.one,
                                        .wanted = 1U << RC_SXX | 1U << RC_SXZ | 1U << RC_MISES |
                                                  1U << RC_S1,
                                        .threads = 1,
                                        .strain = &strain};

    return stressed(&o, out, err);
}

static enum rc_status
depths(double *out, struct rc_err *err)
{
    double *z = NULL;
    size_t n = 0;
    enum rc_status status =
        rc_stress_depths(NULL, &shape, pressure, RC_FREE, &layered.one, &z, &n, err);

    if (status == RC_OK)
        memcpy(out, z, (n < OUT ? n : OUT) * sizeof *out);
    else
        assert_null(z);
    free(z);
    z = NULL;
    if (status == RC_OK) /* without ranks the same */
        status = rc_stress_depths(NULL, &shape, pressure, RC_FREE, &bare.one, &z, &n, err);
    free(z);
    return status;
}

/* Two positions, the second beside the first, in bands of rows; each calls rc_stress_set_loads(. */
static enum rc_status
fatigued(double *out, struct rc_err *err)
{
    static const double residual[NY] = {1e6};
    const struct rc_fatigue_limits limits = {600e6, 372e6, 0};
    const double *const maps[2] = {pressure, rough}, *const always[RC_COMPONENTS] = {residual};
    const double *const one[RC_COMPONENTS] = {rough, rough, rough, rough, rough, rough};
    const size_t column[2] = {0, 1};
    const struct rc_fatigue_problem problem = {.stress = {.body = bare.one, .threads = 1},
                                               .wanted = 1U << RC_DANG_VAN | 1U << RC_FINDLEY,
                                               .cases = 2,
                                               .p = maps,
                                               .column = column,
                                               .room = 4000};
    const struct rc_shape r = rc_fatigue_shape(&shape, &problem);
    double *const to[RC_FATIGUES] = {[RC_DANG_VAN] = out, [RC_FINDLEY] = out + 2 * N};
    struct rc_fatigue *f = NULL;
    double values[RC_FATIGUES];
    enum rc_status status = RC_FAIL;

    if (rc_fatigue_check(&shape, &problem, err) != RC_OK ||
        rc_fatigue_check_limits(problem.wanted, &limits, err) != RC_OK ||
        (f = rc_fatigue_new(&shape, &problem, err)) == NULL ||
        rc_fatigue_depth(f, 1e-6, &limits, always, to, err) != RC_OK ||
        rc_fatigue_history(1U << RC_DANG_VAN, &limits, true, N, one, values, err) != RC_OK)
        goto done;
    out[r.nx * r.ny] = rc_fatigue_result(f)->safety + rc_fatigue_at_depth(f)->sampling_error;
    out[r.nx * r.ny + 1] = values[RC_DANG_VAN] + (double)rc_fatigue_memory(&shape, &problem);
    status = RC_OK;
done:
    rc_fatigue_free(f);
    return status;
}

/* ---- heat ---- */

static enum rc_status
heated(double *out, struct rc_err *err)
{
    const struct rc_heat_problem problem = {.body = {{45, 1e-5, {0, 0}, 0}, {16, 4e-6, {1, 2}, 10}},
                                            .time = 1e-3,
                                            .time_steps = 2,
                                            .threads = 1};
    struct rc_expected expected;
    struct rc_heat *h = NULL;
    enum rc_status status = RC_FAIL;

    if (rc_heat_expect(&shape, &problem, 1, &expected, err) != RC_OK ||
        (h = rc_heat_new(&shape, &problem, pressure, pressure, err)) == NULL)
        return RC_FAIL;
    while ((status = rc_heat_step(h, err)) == RC_MORE)
        continue;
    if (status == RC_OK)
        status = rc_heat_temperature(h, 1, 1e-6, out, err);
    memcpy(out + N, rc_heat_flux(h, 0), N * sizeof *out);
    out[2 * N] = rc_heat_result(h)->max_temperature;
    rc_heat_free(h);
    return status;
}

/* ---- viscoelastic materials ---- */

static enum rc_status
relaxes(double *out, struct rc_err *err)
{
    const double modulus[] = {1e9, 2e8}, time[] = {1e-3, 1}, omega[] = {1, 10, 100, 1000};
    const double storage[] = {1e6, 2e6, 4e6, 9e6}, loss[] = {3e5, 8e5, 2e6, 4e6};
    struct rc_relaxation *r = rc_relaxation_new(1e6, 2, modulus, time, err), *fit = NULL;
    enum rc_status status = RC_FAIL;

    if (r != NULL && (fit = rc_relaxation_fit(4, omega, storage, loss, 0, &out[0], err)) != NULL) {
        out[1] = rc_relaxation_modulus(fit, 1) + rc_relaxation_compliance(r, 1);
        rc_relaxation_dynamic(fit, 3, out + 3, out + 5);
        status = RC_OK;
    }
    if (status == RC_OK) {
        rc_relaxation_free(fit);
        fit = rc_relaxation_fit_time(4, omega, loss, NAN, 0, &out[2], err);
        status = fit != NULL ? RC_OK : RC_FAIL;
    }
    rc_relaxation_free(r);
    rc_relaxation_free(fit);
    return status;
}

/* ---- slabs ---- */

static bool
some_strain(void *ctx, size_t slab, enum rc_component c, size_t j, double *row)
{
    (void)ctx, (void)slab, (void)c;
    for (size_t i = 0; i < NX; i++)
        row[i] = 1e-12 * pressure[j * NX + i];
    return true;
}

static void
some_stress(void *ctx, size_t slab, size_t j, double *const s[RC_COMPONENTS])
{
    double *out = ctx;

    if (slab < 3)
        memcpy(out + (slab + 1) * N + j * NX, s[RC_SXZ], NX * sizeof *out);
}

/* Runs with this precision, with or without all six stresses. */
static enum rc_status
strained(struct rc_boundary boundary, enum rc_precision precision, bool whole, double *out,
         struct rc_err *err)
{
    static const double thickness[] = {1e-6, 2e-6, 3e-6, 4e-6, 5e-6};
    const struct rc_slabs_options o = {.boundary = boundary,
                                       .slabs = 5,
                                       .thickness = thickness,
                                       .shear = 1e9,
                                       .nu = 0.3,
                                       .whole = whole,
                                       .precision = precision,
                                       .threads = 1};
    const struct rc_slab_strain strain = {NULL, some_strain, NULL};
    const struct rc_slab_stress stress = {NULL, some_stress, out};
    struct rc_slabs *slabs = rc_slabs_new(&shape, &o, err);

    if (slabs == NULL)
        return RC_FAIL;
    rc_slabs_up(slabs, &strain, out);
    rc_slabs_down(slabs, pressure, &stress);
    rc_slabs_free(slabs);
    return RC_OK;
}

static enum rc_status
slabs_double(double *out, struct rc_err *err)
{
    return strained(RC_PERIODIC, RC_DOUBLE, true, out, err);
}

static enum rc_status
slabs_single(double *out, struct rc_err *err)
{
    return strained(RC_PERIODIC, RC_SINGLE, false, out, err);
}

static enum rc_status
slabs_lines(double *out, struct rc_err *err)
{
    return strained(rc_boundary_of(true, false), RC_SINGLE, true, out, err);
}

/* ---- functions that cannot fail ---- */

/* Figures of a plan; they allocate nothing either. */
static enum rc_status
plans(double *out, struct rc_err *err)
{
    static const struct rc_conv_options conv = {.threads = 1};
    static const struct rc_problem problem = {.pair.estar = 1e9, .load = 1e-3, .threads = 1};
    struct rc_expected expected;
    struct rc_contact apart;
    const char *reason;

    rc_contact_apart(NULL, &shape, rough, NULL, &apart);
    if (!(apart.mean_gap > 0))
        return rc_err_set(err, "no gap");
    if (rc_solver_expect(&shape, &problem, &expected, err) != RC_OK)
        return RC_FAIL;
    out[12] = (double)expected.memory;
    out[13] = rc_conv_seconds(&shape, &conv);
    out[14] = (double)strlen(rc_conv_choice(&shape, &conv, &reason));
    out[15] = (double)strlen(rc_solver_choice(&shape, &problem, &reason));
    return RC_OK;
}

/* These functions allocate nothing, which is claimed below. */
static enum rc_status
without(double *out, struct rc_err *err)
{
    static const struct rc_place place = {1e-6, 2e-6};
    static const struct rc_stress_options stress = {.body.nu = 0.3, .wanted = 1, .threads = 1};
    struct rc_shape to = {NX / 2, NY / 2, 2.2e-6, 2e-6}, turned = rc_rotate_shape(&shape, 1), sum;
    struct rc_statistics statistics;
    struct rc_profile profile;
    struct rc_seam seam;
    char text[RC_NUMBER_SIZE];
    size_t product, least, largest;
    struct rc_boundary boundary;

    (void)rc_version(), (void)rc_threads_available();
    rc_memory_budget(0);
    (void)rc_memory_ask(1), (void)rc_memory_held();
    (void)rc_engine_info(0), (void)rc_method_info(0), (void)rc_window_name(0);
    rc_synth_sphere(&shape, 1e-3, out);
    rc_synth_paraboloid(&shape, place, 1e-3, 2e-3, 10, out);
    rc_synth_cone(&shape, place, 0.1, out);
    rc_synth_punch(&shape, place, 3e-6, 0, 1e-6, out);
    rc_synth_wave(&shape, 1e-7, 5e-6, 6e-6, out);
    rc_resample_means(&shape, rough, &to, out);
    (void)rc_resample_covers(&shape, &to, RC_X);
    to = (struct rc_shape){4, 5, shape.dx, shape.dy};
    memcpy(out, rough, sizeof rough);
    if (rc_crop(&shape, rough, 2, 3, &to, out + N, err) != RC_OK ||
        rc_add_shape(&shape, &shape, &sum, err) != RC_OK ||
        rc_add(&shape, rough, &shape, rough, out + N, err) != RC_OK ||
        rc_subtract(&shape, rough, &shape, pressure, out + N, err) != RC_OK ||
        rc_shape_check(&turned, err) != RC_OK || rc_size_mul(NX, NY, &product, err) != RC_OK)
        return RC_FAIL;
    rc_mirror(&shape, 'x', out);
    rc_rotate(&shape, rough, 1, out + N);
    rc_profile_along(&shape, rough, place, (struct rc_place){0, 0}, NX, out);
    if (rc_profile_measure(NX, shape.dx, out, 2, &profile, err) != RC_OK)
        return RC_FAIL;
    rc_taper_frame(&shape, 3e-6, &product, &product);
    to = rc_reflect_shape(&(struct rc_shape){NX / 2, NY / 2, shape.dx, shape.dy}, RC_PERIODIC);
    rc_reflect(&(struct rc_shape){NX / 2, NY / 2, shape.dx, shape.dy}, rough, RC_PERIODIC, out);
    rc_measure(&shape, rough, &statistics);
    rc_measure_seam(NULL, &shape, rough, &seam);
    if (rc_stress_check(&shape, &stress, err) != RC_OK || rc_stress_coarser(&shape, &stress) > 1)
        return RC_FAIL;
    out[2 * N] = rc_sum(rough, N) + rc_measure_contact_slope(NULL, &shape, rough, pressure);
    rc_extremes(N, rough, &least, &largest);
    out[2 * N + 1] = (double)(least + largest + rc_body_material(&layered.one, 3e-6));
    out[2 * N + 2] = rc_number_read(rc_number_text(text, 1.5), false, &out[0]) != NULL;
    out[2 * N + 3] = rc_figure_number(rc_figures("contact"), &(struct rc_contact){.load = 1});
    if (rc_figure_word(rc_figure_find("converged"), &(struct rc_contact){0}) != NULL)
        return RC_FAIL;
    if (!rc_boundary_named(rc_boundary_word(RC_PERIODIC), &boundary) ||
        rc_boundary_on(&shape, boundary).datum != 0)
        return RC_FAIL;
    return rc_key_valid("note") && rc_err_set(NULL, "%s", "x") == RC_FAIL ? RC_OK : RC_FAIL;
}

/* These functions only read an existing plan or solution: rc_conv_engine( rc_conv_reason(
 * rc_solver_progress( rc_solver_convolutions( rc_solver_load( rc_solver_engine(
 * rc_solver_engine_reason( rc_solver_method( rc_stress_values( rc_stress_engine(
 * rc_stress_counted( rc_grid_shape( rc_grid_case( */

#define AT(a, x)                                                                                   \
    {                                                                                              \
        1U << RC_##a,                                                                              \
        {                                                                                          \
            [RC_##a] = x                                                                           \
        }                                                                                          \
    }
#define AT2(a, x, b, y)                                                                            \
    {                                                                                              \
        1U << RC_##a | 1U << RC_##b,                                                               \
        {                                                                                          \
            [RC_##a] = x, [RC_##b] = y                                                             \
        }                                                                                          \
    }
#define ROLLED                                                                                     \
    {                                                                                              \
        1U << RC_LOAD | 1U << RC_TANGENTIAL_X | 1U << RC_TANGENTIAL_Y | 1U << RC_POSITION,         \
        {                                                                                          \
            [RC_LOAD] = 1e-3, [RC_TANGENTIAL_X] = 1e-4                                             \
        }                                                                                          \
    }

/* clang-format off */
static const struct {
    const char *name;
    use *use;     /* NULL: the story */
    bool without; /* it allocates nothing */
    size_t lost;  /* blocks that GSL loses, if more than usual */
    struct story story;
} uses[] = {
    {.name = "grids and their keys", .use = grids},
    {.name = "self-affine roughness", .use = selfaffine},
    {.name = "a polynomial", .use = polynomial},
    {.name = "a polynomial of rows", .use = polynomial_of_rows},
    {.name = "figures of rows", .use = figures_of_rows},
    {.name = "rows", .use = levelled_rows},
    {.name = "a robust sphere", .use = robust_sphere},
    {.name = "a cylinder", .use = cylinder},
    {.name = "a robust filter", .use = filtered},
    {.name = "outliers", .use = outliers},
    {.name = "spikes", .use = without_spikes},
    {.name = "alignment", .use = aligned, .lost = 64},
    {.name = "a taper", .use = tapered},
    {.name = "holes", .use = holes},
    {.name = "resampling", .use = resampled},
    {.name = "patches", .use = patches},
    {.name = "areal parameters", .use = areal},
    {.name = "hills and dales", .use = features},
    {.name = "a spectrum", .use = spectrum},
    {.name = "convolution, fft", .use = free_fft},
    {.name = "convolution, single precision", .use = single_fft},
    {.name = "convolution, periodic", .use = periodic_fft},
    {.name = "convolution, mlms", .use = mlms},
    {.name = "convolution, direct", .use = direct},
    {.name = "convolution, coated", .use = coated},
    {.name = "convolution, coated and periodic", .use = coated_periodic},
    {.name = "convolution, periodic along y", .use = line},
    {.name = "convolution, coated and periodic along x", .use = column},
    {.name = "contact", .use = free_contact},
    {.name = "contact, periodic with a hardness", .use = hard_contact},
    {.name = "contact, a map of hardness", .use = two_phases},
    {.name = "contact, pk99 by mlms", .use = paper_method},
    {.name = "contact, to an approach", .use = to_an_approach},
    {.name = "contact, coated", .use = coated_contact},
    {.name = "contact, coated and periodic along x", .use = coated_line_contact},
    {.name = "contact, free to tilt", .use = free_to_tilt},
    {.name = "the elastic model",
     .story = {elastic, NULL, AT(LOAD, 1e-3), AT(LOAD, 1.2e-3), 1, NULL,
               "gap", stiffness, other_heights}},
    {.name = "the model of yield",
     .story = {given_slabs, NULL, AT(LOAD, 1e-3), AT(LOAD, 1.1e-3), 1, NULL,
               "residual", depth, again}},
    {.name = "the friction model",
     .story = {friction, NULL, {1U << RC_LOAD | 1U << RC_DISPLACEMENT_X | 1U << RC_DISPLACEMENT_Y,
               {[RC_LOAD] = 1e-3, [RC_DISPLACEMENT_X] = 1e-9, [RC_DISPLACEMENT_Y] = 1e-10}},
               AT(DISPLACEMENT_X, 2e-9), 1, NULL, "traction-x", force, NULL}},
    {.name = "rolling",
     .story = {rolling, NULL, ROLLED, AT2(TANGENTIAL_Y, 1e-4, POSITION, 2e-6), 3, NULL,
               "traction-x", creepage, NULL}},
    {.name = "rolling along a path",
     .story = {rolling_along, NULL, ROLLED, AT2(TANGENTIAL_Y, 1e-4, POSITION, 2e-6), 2, NULL,
               "traction-x", creepage, NULL}},
    {.name = "the wear model",
     .story = {wear, NULL, AT2(LOAD, 1e-3, DISTANCE, 1e-3), AT(DISTANCE, 3e-3), 1, NULL,
               "wear", volume, NULL}},
    {.name = "the model of wear of two bodies",
     .story = {wear_of_two, NULL, AT2(LOAD, 1e-3, DISTANCE, 1e-3), AT(DISTANCE, 3e-3), 1, NULL,
               "wear", volume, NULL}},
    {.name = "the travel model",
     .story = {travel, NULL, AT2(LOAD, 1e-3, POSITION, 0), AT(POSITION, 2.2e-6), 1, NULL,
               "pressure", height, NULL}},
    {.name = "plasticity after elasticity",
     .story = {may_yield, NULL, AT(LOAD, 1e-7), AT(LOAD, 1e-3), 1, has_strain,
               "pressure", slabs_found, NULL}},
    {.name = "the model of adhesion",
     .story = {adhesion, NULL, AT(LOAD, 1e-3), AT(APPROACH, 0), 1, NULL,
               "adhesion", attraction, pulled_off}},
    {.name = "leakage", .use = leaks},
    {.name = "scene", .use = scene},
    {.name = "scene, rolling", .use = rolling_scene},
    {.name = "stress", .use = free_stress},
    {.name = "stress, periodic", .use = periodic_stress},
    {.name = "stress, y repeats", .use = line_stress},
    {.name = "stress, x repeats", .use = column_stress},
    {.name = "stress, a section across a line", .use = line_section},
    {.name = "stress, a section along a line", .use = column_section},
    {.name = "stress, direct", .use = direct_stress},
    {.name = "stress, mlms", .use = mlms_stress},
    {.name = "stress, a section", .use = section_stress},
    {.name = "stress, coated", .use = coated_stress},
    {.name = "stress, of tractions", .use = traction_stress},
    {.name = "stress, of tractions, a section", .use = traction_section},
    {.name = "stress, of plastic strain", .use = strained_stress},
    {.name = "depths", .use = depths},
    {.name = "fatigue", .use = fatigued},
    {.name = "heat", .use = heated},
    {.name = "relaxation", .use = relaxes},
    {.name = "the model of sliding",
     .story = {sliding, fast_rubber, AT2(LOAD, 1e-3, SPEED, 5e-3), AT(SPEED, 6e-3), 1, NULL,
               "pressure", losses, NULL}},
    {.name = "viscoelastic",
     .story = {creep, slow_rubber, AT2(LOAD, 1e-3, TIME, 0), AT(TIME, 1), 1, NULL,
               "pressure", equivalent_load, NULL}},
    {.name = "slabs", .use = slabs_double},
    {.name = "slabs, single precision", .use = slabs_single},
    {.name = "slabs, one axis repeats", .use = slabs_lines},
    {.name = "what a plan takes", .use = plans, .without = true},
    {.name = "what allocates nothing", .use = without, .without = true},
};
/* clang-format on */

static enum rc_status
use_of(size_t k, double *out, struct rc_err *err)
{
    return uses[k].use == NULL ? told(&uses[k].story, out, err) : uses[k].use(out, err);
}

/* Equal, except for the order of sums: without memory for sorting the C library uses another algorithm. */
static bool
same_numbers(const double *a, const double *b)
{
    double most = 0;

    for (size_t k = 0; k < OUT; k++)
        most = fmax(most, fabs(a[k]));
    for (size_t k = 0; k < OUT; k++)
        if (!(fabs(a[k] - b[k]) <= of_sum * fabs(a[k]) + 1e-13 * most) &&
            !(isnan(a[k]) && isnan(b[k])) && a[k] != b[k])
            return false;
    return true;
}

/* GSL does not free its first blocks if a later allocation fails. These are the head of a matrix without its
 * block, and the work space of its tridiagonal solver (2.7). */
static const size_t lost_by_gsl = 3;
/* A nonlinear fit loses all vectors of its state: `lost` of the row. */

static size_t tried, refused;

static void
try_one(size_t k, size_t n, bool stay, const double *right)
{
    static double out[OUT];
    struct rc_err err = {""};
    enum rc_status status;

    memset(out, 0, sizeof out);
    fault_arm(n, stay);
    status = use_of(k, out, &err);
    fault_disarm();
    tried++;
    refused += status != RC_OK;
    if (status == RC_OK && !same_numbers(right, out))
        fail_msg("%s, allocation %zu%s: another answer", uses[k].name, n, stay ? " and on" : "");
    if (status != RC_OK && err.text[0] == '\0')
        fail_msg("%s, allocation %zu: no reason", uses[k].name, n);
    if (fault_held() > (!fault_in_library() ? 0 : uses[k].lost > 0 ? uses[k].lost : lost_by_gsl))
        fail_msg("%s, allocation %zu%s: %zu blocks are held (%s)", uses[k].name, n,
                 stay ? " and on" : "", fault_held(), err.text);
}

static void
every_allocation_fails(void **state)
{
    size_t all = 0;
    static double right[OUT], warm[OUT];

    (void)state;
    for (size_t k = 0; k < sizeof uses / sizeof *uses; k++) {
        struct rc_err err = {""};
        size_t last;

        memset(right, 0, sizeof right);
        use_of(k, warm, &err); /* from here on FFTW and GSL hold no further memory */
        fault_arm(0, false);
        if (use_of(k, right, &err) != RC_OK)
            fail_msg("%s: %s", uses[k].name, err.text);
        last = fault_disarm();
        assert_int_equal(fault_held(), 0);
        if ((last == 0) != uses[k].without)
            fail_msg("%s: %zu allocations", uses[k].name, last);
        for (size_t n = 1; n <= last; n += thorough(1, last / 40 + 1)) {
            try_one(k, n, false, right);
            try_one(k, n, true, right);
        }
        all += last;
    }
    printf("%zu uses, %zu allocations; %zu made to fail, %zu refusals\n",
           sizeof uses / sizeof *uses, all, tried, refused);
    assert_true(refused > 0);
}

/* A process can read its memory and its remaining limit without allocating. */
static void
memory_is_told_without_memory(void **state)
{
    size_t held, peak;
    struct memory_room room;

    (void)state;
    fault_arm(1, true);
    held = memory_held();
    peak = memory_peak();
    room = memory_room("", 1);
    assert_int_equal(fault_disarm(), 0);
    assert_true(held > 0 && peak >= held);
    assert_true(room.bytes > 0 && isfinite(room.bytes));
}

/* ---- a check that every function was tried ---- */

static char *
text_of(const char *file)
{
    const char *source = getenv("RC_SOURCE");
    char path[4096], *text;
    long n;
    FILE *f;

    assert_non_null(source);
    snprintf(path, sizeof path, "%s/%s", source, file);
    assert_non_null(f = fopen(path, "rb"));
    fseek(f, 0, SEEK_END);
    n = ftell(f);
    rewind(f);
    assert_non_null(text = calloc(1, (size_t)n + 1));
    assert_int_equal(fread(text, 1, (size_t)n, f), n);
    fclose(f);
    return text;
}

/* Counts the functions of a header; each name must occur in one of the sources. */
static size_t
functions_of(const char *header, const char *const source[2])
{
    char *text = text_of(header), name[128];
    size_t n = 0;

    for (char *at = text; (at = strstr(at, "\nRC_API ")) != NULL;) {
        char *open = strpbrk(at + 1, "(;"), *start;

        at = open;
        if (*open == ';') /* data */
            continue;
        for (start = open; isalnum((unsigned char)start[-1]) || start[-1] == '_'; start--)
            continue;
        snprintf(name, sizeof name, "%.*s", (int)(open + 1 - start), start);
        if (strstr(source[0], name) == NULL && strstr(source[1], name) == NULL)
            fail_msg("%s) of %s is tried nowhere", name, header);
        n++;
    }
    free(text);
    return n;
}

static void
every_function_is_tried(void **state)
{
    char *here = text_of("tests/faults/law_memory.c"), *shared = text_of("tests/faults/uses.h");
    const char *const source[2] = {here, shared};
    size_t n = functions_of("libcontact/contact.h", source) +
               functions_of("libcontact/model.h", source) +
               functions_of("libcontact/grid.h", source);

    (void)state;
    printf("%zu public functions\n", n);
    assert_true(n > 80);
    free(here);
    free(shared);
}

/* Setting other heights, or the shape after a load, allocates nothing: nothing is planned and no kernel is
 * evaluated. */
static void
other_heights_take_nothing(void **state)
{
    static const struct rc_problem problem = {
        .pair.estar = 1e9, .load = 1e-3, .tol = 1e-5, .threads = 1, .hardness = 2e7};
    double h[N], gap[N];
    struct rc_solver *solver;
    struct rc_contact c;
    struct rc_err err;

    (void)state;
    for (size_t k = 0; k < N; k++)
        h[k] = 0.5 * rough[N - 1 - k];
    fault_arm(0, false);
    solver = rc_solver_new(&shape, rough, &problem, &err);
    assert_true(fault_disarm() > 10);
    assert_int_equal(finish_load(solver, &err), RC_OK);
    fault_arm(0, false);
    assert_int_equal(rc_solver_set_heights(solver, h, &err), RC_OK);
    assert_int_equal(finish_load(solver, &err), RC_OK);
    rc_solver_result(solver, NULL, gap, &c);
    assert_true(c.yielded_nodes > 0);
    assert_int_equal(rc_solver_keep_shape(solver, &c, h, &err), RC_OK);
    rc_contact_apart(NULL, &shape, h, gap, &c);
    rc_solver_set_tol(solver, 1e-5);
    assert_int_equal(rc_solver_set_load(solver, 1.2e-3, 0, &err), RC_OK);
    assert_int_equal(finish_load(solver, &err), RC_OK);
    assert_int_equal(fault_disarm(), 0);
    rc_solver_free(solver);
}

/* The solver allocates one array for a map of hardness, and none if all nodes have the same hardness or
 * none. */
static void
hardness_takes_an_array(void **state)
{
    static double equal[N], none[N];
    static const double *const maps[] = {NULL, equal, none, hardness};
    size_t takes[4];

    (void)state;
    for (size_t k = 0; k < N; k++) {
        equal[k] = 2e7;
        none[k] = NAN;
    }
    for (size_t m = 0; m < 4; m++) {
        struct rc_problem problem = {
            .pair.estar = 1e9, .load = 1e-3, .tol = 1e-5, .threads = 1, .hardness_map = maps[m]};
        struct rc_solver *solver;
        struct rc_err err;

        fault_arm(0, false);
        solver = rc_solver_new(&shape, rough, &problem, &err);
        takes[m] = fault_disarm();
        assert_non_null(solver);
        fault_arm(0, false);
        assert_int_equal(finish_load(solver, &err), RC_OK);
        if (m > 0) /* after the shared plans have been made */
            assert_int_equal(fault_disarm(), 0);
        rc_solver_free(solver);
    }
    assert_true(takes[0] >= takes[1] && takes[1] == takes[2] && takes[3] == takes[2] + 1);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hardness_takes_an_array),
        cmocka_unit_test(other_heights_take_nothing),
        cmocka_unit_test(memory_is_told_without_memory),
        cmocka_unit_test(every_function_is_tried),
        cmocka_unit_test(every_allocation_fails),
    };
    struct rc_selfaffine what = {.hurst = 0.8, .rms_slope = 0.1, .seed = 7};

    if (rc_synth_selfaffine(&shape, &what, rough, NULL) != RC_OK)
        return 1;
    for (size_t k = 0; k < N; k++) {
        holed[k] = k % 37 == 5 || (k > 100 && k < 104) ? NAN : rough[k];
        pressure[k] = fmax(0, rough[k]) * 1e14;
        hardness[k] = k % 7 == 3 ? NAN : k % 10 < 5 ? 2e7 : 6e7;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
