/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Stress slices and sections: choice of the evaluator, and derived stresses.
 */
#include "stress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

struct rc_stress {
    struct rc_stress_task task;
    const struct rc_stress_evaluator *evaluator;
    void *plan;
    struct rc_solid *solid;
    struct rc_strained *strained; /* NULL: no plastic strain */
    size_t values;
    double *own[RC_COMPONENTS]; /* components that are needed but not requested */
    struct rc_body body; /* the caller's; its layers are copied if they have residual stress */
    struct rc_stress_counts counts;
    struct rc_store memory; /* of `own` */
    /* Pa, sums over the nodes: estimated errors of the last depth, and of all depths; sizes of the
     * stresses */
    double error[RC_COMPONENTS], errors[RC_STRESSES], sizes[RC_STRESSES];
};

const char *const rc_component_names[RC_STRESSES] = {"sxx",   "syy",    "szz", "sxy", "sxz", "syz",
                                                     "mises", "tresca", "s1",  "s2",  "s3"};

/* Rounding errors of a sum by transforms, over the root mean square of the largest component: single
 * precision, double precision. */
static const double of_single = 3e-7, of_double = 1e-15;

static const unsigned six = (1u << RC_COMPONENTS) - 1;

enum {
    PIECE = 8192 /* points derived together by a thread */
};

/* ---- options ---- */

static bool
automatic(const char *engine)
{
    return engine == NULL || strcmp(engine, "auto") == 0;
}

/* The engine of that name, NULL when there is none; without a name the fastest one for stresses. */
static const struct rc_engine *
engine_of(const char *name, bool *precise)
{
    *precise = false;
    return automatic(name) ? rc_engine_of_transforms() : rc_engine_named(name, precise);
}

enum rc_status
rc_stress_check(const struct rc_shape *shape, const struct rc_stress_options *o, struct rc_err *err)
{
    bool precise;
    const struct rc_engine *engine = engine_of(o->engine, &precise);
    const struct rc_body_type *type = rc_body_type(&o->body);
    double half =
        o->section == 'x' ? (double)shape->nx * shape->dx / 2 : (double)shape->ny * shape->dy / 2;

    if (rc_shape_check(shape, err) != RC_OK)
        return RC_FAIL;
    if (type->check(&o->body, RC_INSIDE, err) != RC_OK)
        return RC_FAIL;
    if (type->inside == NULL)
        return rc_err_set(err, "stresses inside a body that is %s are not implemented", type->name);
    if (!isfinite(o->mu))
        return rc_err_set(err, "friction coefficient %g: it must be finite", o->mu);
    if (o->mu != 0 && (o->traction[0] != NULL || o->traction[1] != NULL))
        return rc_err_set(
            err, "friction coefficient %g and a map of traction: give one or the other", o->mu);
    if (o->wanted == 0 || o->wanted >> RC_STRESSES != 0)
        return rc_err_set(err, "the requested components are empty or unknown");
    if (!(o->tol >= 0 && o->tol < 1))
        return rc_err_set(err, "tolerance %g: it must be at least 0 and below 1", o->tol);
    if (o->section != 0 && !(fabs(o->at) <= half))
        return rc_err_set(err, "section %c = %g m: the map ends at %g m", o->section, o->at, half);
    if (engine == NULL)
        return rc_engine_absent(o->engine, err);
    if (rc_ranks_count(o->ranks) > 1 && o->section != 0)
        return rc_err_set(
            err, "a section is computed by one process, which holds the whole map: take maps "
                 "at these depths, or one process");
    if (rc_engine_serves(engine, o->engine, o->boundary, o->ranks, err) != RC_OK ||
        rc_strained_check(o, err) != RC_OK)
        return RC_FAIL;
    if (o->section != 0 && !engine->transforms)
        return rc_err_set(err, "a section is summed by %s, not by %s: leave the kernel to auto",
                          rc_engine_of_transforms()->info.name, o->engine);
    return RC_OK;
}

/* The loads on the surface, and the maps of each. */
static void
set_loads(struct rc_stress_task *t)
{
    static const int along[2] = {RC_SHEAR, RC_TURNED};

    t->loads = 1U << RC_NORMAL;
    t->source[t->sources++] = t->p;
    t->load[RC_NORMAL].weight = 1;
    if (t->options.mu != 0) {
        t->loads |= 1U << RC_SHEAR;
        t->load[RC_SHEAR].weight = t->options.mu;
    }
    for (size_t k = 0; k < 2; k++) {
        if (t->options.traction[k] == NULL)
            continue;
        t->loads |= 1U << along[k];
        t->load[along[k]].weight = 1;
        t->load[along[k]].source = t->sources;
        t->source[t->sources++] = t->options.traction[k];
    }
}

static bool
sheared(const struct rc_stress_task *t)
{
    return t->loads != 1U << RC_NORMAL;
}

double
rc_stress_shear(const struct rc_stress_task *t)
{
    return fabs(t->options.mu) + (double)(t->sources - 1);
}

static struct rc_stress_task
task_of(const struct rc_shape *shape, const double *p, const struct rc_solid *solid,
        const struct rc_stress_options *o, struct rc_stress_counts *counts)
{
    bool derived = o->wanted >> RC_COMPONENTS != 0;
    unsigned components = derived ? six : o->wanted & six;
    struct rc_stress_task task = {.shape = *shape,
                                  .options = *o,
                                  .p = p,
                                  .type = rc_body_type(&o->body)->inside,
                                  .solid = solid,
                                  .components = components,
                                  .counts = counts};

    set_loads(&task);
    task.kernels = rc_stress_distinct(task.type, components, task.loads);
    task.options.body.layer = NULL; /* the caller may free them */
    if (rc_ranks_count(o->ranks) == 1)
        task.options.ranks = NULL;
    task.engine = engine_of(o->engine, &task.precise);
    return task;
}

static const struct rc_stress_evaluator *
evaluator_of(const struct rc_stress_task *task)
{
    if (task->options.section != 0)
        return &rc_stress_section;
    return task->engine != NULL && task->engine->transforms ? &rc_stress_slices_fft
                                                            : &rc_stress_slices_engine;
}

double
rc_stress_coarser(const struct rc_shape *shape, const struct rc_stress_options *o)
{
    const struct rc_stress_task task = task_of(shape, NULL, NULL, o, NULL);

    return evaluator_of(&task) == &rc_stress_slices_fft ? rc_stress_slices_coarser(&task) : 0;
}

static size_t
values_of(const struct rc_shape *shape, const struct rc_stress_options *o)
{
    struct rc_rows rows = rc_rows_of(o->ranks, shape);

    return o->section == 'y' ? shape->nx : o->section == 'x' ? shape->ny : shape->nx * rows.n;
}

void
rc_stress_count(const struct rc_stress_task *t, int kernel, size_t coefficients)
{
    bool normal = rc_stress_distinct(t->type, t->components, 1U << RC_NORMAL) >> kernel & 1;

    *(normal ? &t->counts->normal_kernels : &t->counts->shear_kernels) += 1;
    t->counts->coefficients += coefficients;
}

struct rc_inside *
rc_stress_inside(const struct rc_stress_task *t, double depth, struct rc_err *err)
{
    return t->type->new (t->solid, depth, sheared(t), t->options.boundary, err);
}

size_t
rc_stress_numbers(const struct rc_stress_task *t)
{
    return t->type->numbers(sheared(t));
}

/* ---- the estimated error ---- */

/* The sum of the errors that do not come from a coarser grid, of a depth whose components have the sums of
 * squares `squares`. Rounding errors of transforms spread over the map, and two components are transformed
 * together. An engine errs by its tolerance of the sum of |K| |p|; as kernels are even or odd, this holds
 * for the sum of the errors too. */
static double
error_anywhere(const struct rc_stress *stress, const double squares[RC_COMPONENTS])
{
    const struct rc_stress_task *t = &stress->task;
    const bool engine = stress->evaluator == &rc_stress_slices_engine;
    const bool single = stress->evaluator == &rc_stress_slices_fft && rc_stress_slices_single(t);
    double largest = 0, error;

    for (int c = 0; c < RC_COMPONENTS; c++)
        largest = fmax(largest, squares[c]);
    error = (single ? of_single : of_double) *
            sqrt((double)t->shape.nx * (double)t->shape.ny * largest);
    for (size_t k = 0; engine && k < t->sources; k++)
        for (size_t i = 0; i < stress->values; i++)
            error +=
                t->options.tol * (k == 0 ? 1 + fabs(t->options.mu) : 1) * fabs(t->source[k][i]);
    return error;
}

/* Of derived stresses: the size of the tensor of the errors. Its Mises stress is at most sqrt(3/2) of
 * this, its Tresca stress at most sqrt(2), and principal stresses change by no more (Weyl). */
static double
of_derived(int c, const double of[RC_COMPONENTS])
{
    double square = 0;

    for (int k = 0; k < RC_COMPONENTS; k++)
        square += (k < RC_SXY ? 1 : 2) * of[k] * of[k];
    return sqrt(square * (c == RC_MISES ? 1.5 : c == RC_TRESCA ? 2 : 1));
}

/* Sums over the nodes: of |error| of each map of the loads. An error of the tractions may lie in either map. */
static void
errors_of_loads(const struct rc_stress *stress, double sum[RC_LOADS])
{
    const struct rc_stress_task *t = &stress->task;
    const double *x = t->sources > 1 ? t->source[1] : NULL, *y = t->sources > 2 ? t->source[2] : x;

    for (size_t i = 0; i < stress->values; i++) {
        sum[0] += fabs(t->source[0][i]);
        if (x != NULL)
            sum[1] += x == y ? fabs(x[i]) : hypot(x[i], y[i]);
    }
    rc_ranks_each_sum(t->options.ranks, RC_LOADS, sum);
    sum[2] = sum[1];
    for (size_t k = 0; k < RC_LOADS; k++) {
        const double share = k == 0 ? t->options.pressure_error : t->options.traction_error;

        sum[k] = share == 0 ? 0 : share * sum[k];
    }
}

/* The sums of the errors at a depth that come from the errors of the loads; NAN: unknown. On a line of nodes
 * they are unknown, because the errors of the loads may be near the line. */
static enum rc_status
of_loads(const struct rc_stress *stress, double depth, double of[RC_STRESSES], struct rc_err *err)
{
    const struct rc_stress_task *t = &stress->task;
    const double told = t->options.pressure_error + t->options.traction_error; /* or NAN */
    double sum[RC_LOADS] = {0}, gain[RC_STRESSES];

    for (int c = 0; c < RC_STRESSES; c++)
        of[c] = told == 0 || (told > 0 && t->options.section == 0) ? 0 : NAN;
    if (told == 0 || isnan(of[0]))
        return RC_OK;
    errors_of_loads(stress, sum);
    for (size_t k = 0; k < t->sources; k++) {
        if (sum[k] == 0)
            continue;
        if (rc_stress_gain(t, k, depth, gain, err) != RC_OK)
            return RC_FAIL;
        for (int c = 0; c < RC_STRESSES; c++)
            of[c] += sum[k] * gain[c];
    }
    return RC_OK;
}

/* Adds the depth to the errors and to the sizes of the stresses. */
static enum rc_status
add_errors(struct rc_stress *stress, double depth, double *const six_of[RC_COMPONENTS],
           double *const s[RC_STRESSES], struct rc_err *err)
{
    const struct rc_stress_options *o = &stress->task.options;
    double squares[RC_COMPONENTS] = {0}, size[RC_STRESSES] = {0}, loads[RC_STRESSES], anywhere;
    enum rc_status status = of_loads(stress, depth, loads, err);

    if (rc_ranks_agree(o->ranks, status, err) != RC_OK)
        return RC_FAIL;
    for (int c = 0; c < RC_COMPONENTS; c++)
        for (size_t k = 0; six_of[c] != NULL && k < stress->values; k++)
            squares[c] += six_of[c][k] * six_of[c][k];
    for (int c = 0; c < RC_STRESSES; c++)
        for (size_t k = 0; o->wanted >> c & 1 && k < stress->values; k++)
            size[c] += fabs(s[c][k]);
    rc_ranks_each_sum(o->ranks, RC_COMPONENTS, squares);
    rc_ranks_each_sum(o->ranks, RC_COMPONENTS, stress->error);
    rc_ranks_each_sum(o->ranks, RC_STRESSES, size);
    anywhere = error_anywhere(stress, squares);
    for (int c = 0; c < RC_COMPONENTS; c++)
        stress->error[c] += anywhere;
    for (int c = 0; c < RC_STRESSES; c++) {
        if (!(o->wanted >> c & 1))
            continue;
        stress->errors[c] +=
            loads[c] + (c < RC_COMPONENTS ? stress->error[c] : of_derived(c, stress->error));
        stress->sizes[c] += size[c];
        stress->counts.error[c] = stress->sizes[c] > 0 ? stress->errors[c] / stress->sizes[c] : NAN;
    }
    return RC_OK;
}

/* ---- plan ---- */

struct rc_stress *
rc_stress_new(const struct rc_shape *shape, const double *p,
              const struct rc_stress_options *options, struct rc_err *err)
{
    enum rc_status status = RC_OK;
    RC_OWN(rc_stress, stress) = NULL;

    if (rc_stress_check(shape, options, err) != RC_OK)
        return NULL;
    if ((stress = calloc(1, sizeof *stress)) == NULL)
        status = rc_err_set(err, "out of memory for a plan");
    else if ((stress->solid = rc_body_type(&options->body)->new (&options->body, err)) == NULL)
        status = RC_FAIL;
    if (rc_ranks_agree(options->ranks, status, err) != RC_OK)
        return NULL;
    stress->task = task_of(shape, p, stress->solid, options, &stress->counts);
    stress->evaluator = evaluator_of(&stress->task);
    for (int c = 0; c < RC_STRESSES; c++)
        stress->counts.error[c] = NAN;
    if (options->estimate)
        stress->task.error = stress->error;
    stress->body = options->body;
    stress->values = values_of(shape, options);
    for (int c = 0; c < RC_COMPONENTS; c++)
        if ((stress->task.components & ~options->wanted) >> c & 1)
            stress->own[c] = rc_store_take(&stress->memory, stress->values, sizeof(double));
    if (rc_ranks_need(options->ranks, !stress->memory.failed, err,
                      "out of memory for %zu values of a stress", stress->values) != RC_OK)
        return NULL;
    if ((stress->plan = stress->evaluator->new (&stress->task, err)) == NULL ||
        (options->strain != NULL &&
         (stress->strained = rc_strained_new(&stress->task, err)) == NULL))
        return NULL;
    if (stress->strained != NULL)
        rc_strained_count(stress->strained, &stress->counts);
    return rc_give(&stress);
}

void
rc_stress_free(struct rc_stress *stress)
{
    if (stress == NULL)
        return;
    if (stress->plan != NULL)
        stress->evaluator->free(stress->plan);
    rc_strained_free(stress->strained);
    rc_store_free(&stress->memory);
    rc_solid_free(stress->solid);
    free(stress);
}

/* ---- slices ---- */

static void
derive(const struct rc_stress *stress, const double *const six_of[RC_COMPONENTS],
       double *const s[RC_STRESSES])
{
#pragma omp parallel for schedule(static)                                                          \
    num_threads(rc_useful_threads(&stress->task.shape, stress->task.options.threads))
    for (size_t first = 0; first < stress->values; first += PIECE) {
        size_t n = stress->values - first < PIECE ? stress->values - first : PIECE;
        const double *from[RC_COMPONENTS];
        double *to[RC_STRESSES] = {NULL};
        for (int c = 0; c < RC_COMPONENTS; c++)
            from[c] = six_of[c] + first;
        for (int c = RC_COMPONENTS; c < RC_STRESSES; c++)
            to[c] = stress->task.options.wanted >> c & 1 ? s[c] + first : NULL;
        rc_stress_derive(stress->task.options.wanted, n, from, to);
    }
}

static void
add_residual(const struct rc_stress *stress, double depth, double *const six_of[RC_COMPONENTS])
{
    const double *residual = stress->task.options.residual;
    size_t layer = residual == NULL ? 0 : rc_body_material(&stress->body, depth);

    if (residual == NULL || layer == stress->body.layers)
        return;
    for (int c = 0; c < RC_COMPONENTS; c++)
        for (size_t k = 0; (c == RC_SXX || c == RC_SYY) && six_of[c] != NULL && k < stress->values;
             k++)
            six_of[c][k] += residual[layer];
}

enum rc_status
rc_stress_slice(struct rc_stress *stress, double depth, double *const s[RC_STRESSES],
                struct rc_err *err)
{
    double *six_of[RC_COMPONENTS] = {NULL};

    if (!(depth >= 0) || isinf(depth))
        return rc_err_set(err, "depth %g m: it must be finite and not negative", depth);
    for (int c = 0; c < RC_COMPONENTS; c++)
        if (stress->task.components >> c & 1)
            six_of[c] = stress->own[c] != NULL ? stress->own[c] : s[c];
    memset(stress->error, 0, sizeof stress->error);
    if (stress->evaluator->slice(stress->plan, depth, six_of, err) != RC_OK)
        return RC_FAIL;
    if (stress->strained != NULL) {
        rc_strained_add(stress->strained, depth, six_of);
        rc_strained_count(stress->strained, &stress->counts);
    }
    add_residual(stress, depth, six_of);
    stress->counts.depths++;
    if (stress->task.options.wanted >> RC_COMPONENTS != 0)
        derive(stress, (const double *const *)six_of, s);
    return stress->task.options.estimate ? add_errors(stress, depth, six_of, s, err) : RC_OK;
}

enum rc_status
rc_stress_set_loads(struct rc_stress *stress, const double *p, const double *const traction[2],
                    struct rc_err *err)
{
    struct rc_stress_task *t = &stress->task;

    if (stress->evaluator->load == NULL)
        return rc_err_set(err, "other pressures on the same plan need maps by transforms");
    t->p = p;
    t->sources = 0;
    t->source[t->sources++] = p;
    for (size_t k = 0; k < 2; k++)
        if (t->options.traction[k] != NULL)
            t->source[t->sources++] = traction[k];
    return stress->evaluator->load(stress->plan, t->source, err);
}

size_t
rc_stress_values(const struct rc_stress *stress)
{
    return stress->values;
}

const char *
rc_stress_engine(const struct rc_stress *stress)
{
    const struct rc_stress_task *t = &stress->task;

    return t->precise ? t->engine->precise.name : t->engine->info.name;
}

#define COUNT(member, title)                                                                       \
    {                                                                                              \
        RC_FIGURE_AS("counts." #member, struct rc_stress_counts, member), NULL, title,             \
            .role = RC_FIGURE_COST                                                                 \
    }
#define ERROR(c, name)                                                                             \
    {                                                                                              \
        RC_FIGURE_AS(name "_error_estimate", struct rc_stress_counts, error[c]), NULL,             \
            "Error of " name, .says = "estimated relative L1 error", .role = RC_FIGURE_ERROR,      \
                              .by = "tol", .of = name                                              \
    }
/* clang-format off */
const struct rc_figure rc_figures_stress[] = {
    COUNT(depths, "Depths"), COUNT(coarse_depths, "Depths on coarser grids"),
    COUNT(normal_kernels, "Kernels of the pressure"), COUNT(shear_kernels, "Kernels of the traction"),
    COUNT(coefficients, "Coefficients of kernels"), COUNT(source_transforms, "Transforms of sources"),
    COUNT(kernel_transforms, "Transforms of kernels"), COUNT(field_transforms, "Transforms of fields"),
    COUNT(line_transforms, "Transforms along lines"), COUNT(engine_sums, "Sums by another engine"),
    COUNT(strain_transforms, "Transforms of strains"),
    COUNT(strain_field_transforms, "Transforms of the stresses of strains"),
    ERROR(RC_SXX, "sxx"), ERROR(RC_SYY, "syy"), ERROR(RC_SZZ, "szz"), ERROR(RC_SXY, "sxy"),
    ERROR(RC_SXZ, "sxz"), ERROR(RC_SYZ, "syz"), ERROR(RC_MISES, "mises"), ERROR(RC_TRESCA, "tresca"),
    ERROR(RC_S1, "s1"), ERROR(RC_S2, "s2"), ERROR(RC_S3, "s3"),
    {0},
};
/* clang-format on */

const struct rc_stress_counts *
rc_stress_counted(const struct rc_stress *stress)
{
    return &stress->counts;
}
