/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Stresses in a plane across the map, line by line of depth. Only the direction along the plane is
 * transformed. On the free boundary a line of the field is a sum over the lines of pressure. Each term is a
 * convolution with the kernel at the line's distance from the plane. Lines at equal distances on both sides
 * share their kernels, and lines without pressure cost nothing. On the periodic boundary the field is the sum
 * of all waves across the plane, for each wave along it.
 *
 * Where the map repeats across the plane only, the waves across it take the place of the lines. For the plane
 * at y = 0 the pressure is the sum of a_b(x) cos(q_b y) + b_b(x) sin(q_b y). Kernels that are even across act
 * on a_b, odd ones on -b_b. Where the map repeats along the plane only, the field is a sum over the lines for
 * each wave along it. Kernels are known at distances of whole cells, so the field is linear between two lines
 * of nodes.
 *
 * A section across x is the same with x and y exchanged: the map is transposed, and the kernels are evaluated
 * at the exchanged positions.
 */
#include "stress.h"

#include <complex.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/body/line.h"
#include "libcontact/memory.h"

enum {
    PARTS = 16 /* partial sums, added in order: the result is the same for any number of threads */
};

/* The two lines of pressure at one distance from the plane, or the one that is on the map. Kernels that are
 * even across the plane take their sum. Odd ones take their difference, the line on the positive side of the
 * plane first. Of a wave across the plane: a_b and b_b. */
struct pair {
    double offset;    /* m, >= 0; of a wave its wave number, rad/m */
    size_t even, odd; /* lines of each source */
    double sign;      /* sign of odd kernels */
};

struct plan {
    struct rc_stress_task task;
    bool transposed; /* section across x: y runs along the plane */
    bool repeats_along, repeats_across;
    size_t n, m;              /* nodes along and across                   */
    double d_along, d_across; /* their spacings, m                        */
    size_t waves;             /* along: 0 .. waves - 1                    */
    size_t length;            /* length of a transform */
    int threads;
    struct rc_line *line;
    struct rc_dct *dct; /* transform of a kernel along the section; NULL if the map repeats along */
    struct rc_line *across; /* transform across; NULL unless the map repeats across only */
    double complex *source; /* `lines` of `waves` for each map; periodic: the waves across */
    /* free across: lines with pressure, and the place of each line among them; place is NULL: all lines */
    size_t lines, *place;
    struct pair *pair;
    size_t pairs;
    size_t kernels;  /* number of kernels with scratch */
    double *scratch; /* memory for each thread: a line of each kernel, and its positions or waves */
    size_t scratch_size;
    double complex *sum;      /* `waves` for each part and component */
    struct rc_inside *inside; /* at the depth */
    struct rc_store own;
};

static bool
odd_along(const struct plan *plan, int kernel)
{
    return (rc_stress_parity[kernel] & (plan->transposed ? RC_ODD_Y : RC_ODD_X)) != 0;
}

static bool
odd_across(const struct plan *plan, int kernel)
{
    return (rc_stress_parity[kernel] & (plan->transposed ? RC_ODD_X : RC_ODD_Y)) != 0;
}

static void
plan_free(void *at)
{
    struct plan *plan = at;

    if (plan == NULL)
        return;
    rc_line_free(plan->line);
    rc_line_free(plan->across);
    rc_dct_free(plan->dct);
    rc_store_free(&plan->own);
    free(plan);
}

RC_OWNER(plan)

static struct plan
sizes(const struct rc_stress_task *t)
{
    struct plan plan = {.task = *t, .transposed = t->options.section == 'x'};
    const struct rc_shape *s = &t->shape;
    const struct rc_boundary b = t->options.boundary;
    size_t waves, lines;

    plan.repeats_along = rc_wraps(b, plan.transposed ? RC_Y : RC_X);
    plan.repeats_across = rc_wraps(b, plan.transposed ? RC_X : RC_Y);
    plan.n = plan.transposed ? s->ny : s->nx;
    plan.m = plan.transposed ? s->nx : s->ny;
    plan.d_along = plan.transposed ? s->dy : s->dx;
    plan.d_across = plan.transposed ? s->dx : s->dy;
    plan.length = plan.repeats_along ? plan.n : rc_fourier_length(plan.n, 2);
    plan.waves = plan.length / 2 + 1;
    plan.lines = plan.m;
    plan.threads = rc_useful_threads(s, t->options.threads);
    plan.kernels = (size_t)RC_COMPONENTS * (rc_stress_has(t, RC_TURNED) ? RC_LOADS : RC_TURNED);
    waves = (5 + plan.kernels + RC_WAVE_NUMBERS) * plan.m + plan.n + plan.kernels;
    lines = (2 + plan.kernels) * plan.waves + (plan.repeats_across ? 2 * plan.m + 2 : 0);
    plan.scratch_size = plan.repeats_along ? waves : lines;
    return plan;
}

/* Copies a map with its rows along the plane. */
static void
transpose(const struct plan *plan, const double *p, double *v)
{
    size_t n = plan->n, m = plan->m;

    for (size_t j = 0; j < m; j++)
        for (size_t i = 0; i < n; i++)
            v[j * n + i] = p[plan->transposed ? i * m + j : j * n + i];
}

/* The place of a line without pressure. */
static const size_t nowhere = SIZE_MAX;

/* Line j of a source. */
static double complex *
line_of(const struct plan *plan, size_t source, size_t j)
{
    const size_t place = plan->place == NULL ? j : plan->place[j];

    return plan->source + (source * plan->lines + place) * plan->waves;
}

/* ---- free along the plane: pairs of lines, or of waves across ---- */

/* The line at the same distance on the other side of the plane, or m when there is none. */
static size_t
opposite(const struct plan *plan, size_t j)
{
    double at = (double)(plan->m - 1) - (double)j + 2 * plan->task.options.at / plan->d_across;
    double whole = round(at);

    return fabs(at - whole) < 1e-9 && whole >= 0 && whole < (double)plan->m ? (size_t)whole
                                                                            : plan->m;
}

/* Makes the pair of line j, unless the opposite line does. */
static void
add_pair(struct plan *plan, size_t j)
{
    double offset =
        plan->task.options.at - ((double)j - (double)(plan->m - 1) / 2) * plan->d_across;
    size_t other = opposite(plan, j);
    struct pair *pair = &plan->pair[plan->pairs];
    const bool both = other != j && other < plan->m && plan->place[other] != nowhere;

    if (plan->place[j] == nowhere || (both && offset < 0))
        return;
    *pair = (struct pair){fabs(offset), j, j, offset < 0 ? -1 : 1};
    plan->pairs++;
    if (!both)
        return;
    pair->odd = other;
    for (size_t k = 0; k < plan->task.sources; k++) {
        double complex *a = line_of(plan, k, j), *b = line_of(plan, k, other);
        for (size_t q = 0; q < plan->waves; q++) {
            double complex x = a[q], y = b[q];
            a[q] = x + y;
            b[q] = x - y;
        }
    }
}

/* The pair of wave b across; b_b is 0 for the mean and for a wave of two nodes. */
static void
add_wave(struct plan *plan, size_t b)
{
    const bool single = b == 0 || 2 * b == plan->m;

    plan->pair[plan->pairs++] = (struct pair){rc_fourier_q(b, plan->m, plan->d_across), b,
                                              single ? b : plan->m - b, single ? 0 : 1};
}

/* Changes the lines of v: a_b to line b, and -b_b to line m - b. */
static void
resolve(struct plan *plan, double *v)
{
    const size_t n = plan->n, m = plan->m;
    const double from_first = plan->task.options.at + (double)(m - 1) / 2 * plan->d_across;

#pragma omp parallel for num_threads(plan->threads) schedule(static)
    for (size_t i = 0; i < n; i++) {
        double *line = plan->scratch + (size_t)omp_get_thread_num() * plan->scratch_size;
        double complex *wave = (double complex *)(void *)line; /* m/2 + 1 of them */
        double *values = line + 2 * (m / 2 + 1);
        for (size_t j = 0; j < m; j++)
            values[j] = v[j * n + i];
        rc_line_forward(plan->across, values, wave);
        for (size_t b = 0; 2 * b <= m; b++) {
            const double phase = rc_fourier_q(b, m, plan->d_across) * from_first;
            const bool single = b == 0 || 2 * b == m;
            const double complex at = wave[b] * CMPLX(cos(phase), single ? 0 : sin(phase));
            v[b * n + i] = (single ? 1 : 2) * creal(at) / (double)m;
            if (!single)
                v[(m - b) * n + i] = 2 * cimag(at) / (double)m;
        }
    }
    plan->task.counts->line_transforms += n;
}

/* Transforms the lines of a source in this part, v; a line that only another source loads is 0. */
static void
transform_lines(struct plan *plan, size_t source, const double *v)
{
    size_t n = plan->n, transforms = 0;

#pragma omp parallel for num_threads(plan->threads) schedule(dynamic, 4) reduction(+ : transforms)
    for (size_t j = 0; j < plan->m; j++) {
        double *line = plan->scratch + (size_t)omp_get_thread_num() * plan->scratch_size;
        double complex *to;
        if (plan->place != NULL && plan->place[j] == nowhere)
            continue;
        to = line_of(plan, source, j);
        if (!rc_any(v + j * n, n)) {
            memset(to, 0, plan->waves * sizeof *to);
            continue;
        }
        memset(line, 0, plan->length * sizeof *line);
        memcpy(line, v + j * n, n * sizeof *line);
        rc_line_forward(plan->line, line, to);
        transforms++;
    }
    plan->task.counts->line_transforms += transforms;
}

static bool
carries(const struct plan *plan, size_t j)
{
    const struct rc_stress_task *t = &plan->task;
    size_t step = plan->transposed ? plan->m : 1, first = plan->transposed ? j : j * plan->n;

    for (size_t k = 0; k < t->sources; k++)
        for (size_t i = 0; i < plan->n; i++)
            if (t->source[k][first + i * step] != 0)
                return true;
    return false;
}

/* Finds the lines with pressure, the only ones that take memory. */
static void
place_lines(struct plan *plan)
{
    plan->lines = 0;
    plan->place = rc_store_take(&plan->own, plan->m, sizeof *plan->place);
    for (size_t j = 0; plan->place != NULL && j < plan->m; j++)
        plan->place[j] = carries(plan, j) ? plan->lines++ : nowhere;
}

static enum rc_status
transform_sources(struct plan *plan, double *v, struct rc_err *err)
{
    const struct rc_stress_task *t = &plan->task;
    const struct rc_shape shape = {plan->n, plan->m, plan->d_along, plan->d_across};
    enum rc_status status = RC_OK;

    for (size_t k = 0; status == RC_OK && k < t->sources; k++) {
        transpose(plan, t->source[k], v);
        if (plan->repeats_along && plan->repeats_across) {
            status = rc_fourier_forward(&shape, v, line_of(plan, k, 0), err);
            t->counts->source_transforms++;
            continue;
        }
        if (plan->repeats_across)
            resolve(plan, v);
        transform_lines(plan, k, v);
    }
    for (size_t j = 0; !plan->repeats_along && j < plan->m; j++)
        if (!plan->repeats_across)
            add_pair(plan, j);
        else if (2 * j <= plan->m)
            add_wave(plan, j);
    return status;
}

static void *
plan_new(const struct rc_stress_task *task, struct rc_err *err)
{
    RC_OWN(plan, plan) = malloc(sizeof *plan);
    RC_OWNED double *p = NULL;
    size_t threads;

    if (plan == NULL)
        return rc_err_null(err, "out of memory for a plan");
    *plan = sizes(task);
    threads = (size_t)plan->threads;
    p = malloc(plan->n * plan->m * sizeof *p);
    plan->pair = rc_store_take(&plan->own, plan->m, sizeof *plan->pair);
    if (!plan->repeats_across)
        place_lines(plan);
    plan->source = rc_store_take(&plan->own, task->sources * plan->lines * plan->waves + 1,
                                 sizeof *plan->source);
    plan->scratch = rc_store_take(&plan->own, threads * plan->scratch_size, sizeof *plan->scratch);
    if (p == NULL || plan->own.failed)
        return rc_err_null(err, "out of memory for a section of %zu x %zu nodes", plan->n, plan->m);
    if ((plan->line = rc_line_new(plan->length, threads, err)) == NULL ||
        (!plan->repeats_along && (plan->dct = rc_dct_new(plan->waves, threads, err)) == NULL) ||
        (!plan->repeats_along && plan->repeats_across &&
         (plan->across = rc_line_new(plan->m, threads, err)) == NULL))
        return NULL;
    if (transform_sources(plan, p, err) != RC_OK)
        return NULL;
    free(rc_give(&p)); /* before the sums are allocated */
    plan->sum = rc_store_take(&plan->own, PARTS * RC_COMPONENTS * plan->waves, sizeof *plan->sum);
    if (plan->own.failed)
        return rc_err_null(err, "out of memory for the sums of a section of %zu nodes", plan->n);
    return rc_give(&plan);
}

/* Adds the field of a load on one pair of lines; `k` is the kernel's transform along. */
static void
add_product(const struct plan *plan, int load, int kernel, const double *k, const struct pair *pair,
            double complex *sum)
{
    bool odd = odd_across(plan, kernel);
    const struct rc_stress_task *t = &plan->task;
    const double complex *p = line_of(plan, t->load[load].source, odd ? pair->odd : pair->even);
    double weight = t->load[load].weight;

    if (odd)
        weight *= pair->sign;
    if (odd_along(plan, kernel))
        for (size_t q = 0; q < plan->waves; q++)
            sum[q] += CMPLX(weight * k[q] * cimag(p[q]), -weight * k[q] * creal(p[q]));
    else
        for (size_t q = 0; q < plan->waves; q++)
            sum[q] += weight * k[q] * p[q];
}

static void
transform_kernels(const struct plan *plan, double *const line[RC_STRESS_KERNELS])
{
    unsigned odd = 0;

    for (int k = 0; k < (int)plan->kernels; k++)
        odd |= (unsigned)odd_along(plan, k) << k;
    rc_dct_run(plan->dct, RC_STRESS_KERNELS, odd, line);
}

/* The transforms along the plane of the kernels of a wave across it. */
static enum rc_status
kernels_of_wave(const struct plan *plan, double wave, double *const line[RC_STRESS_KERNELS])
{
    const bool along_x = !plan->transposed;
    struct rc_line_at at = {.cell = plan->d_along, .step = 1, .n = plan->length, .wave = wave};
    const double most = RC_STRESS_REACH / plan->inside->depth;

    if (rc_line_decays(&at))
        return rc_inside_spectra(plan->inside, plan->task.kernels, along_x, &at, most, line, NULL);
    at.n = plan->waves;
    if (rc_inside_lines(plan->inside, plan->task.kernels, along_x, &at, most, line, NULL) != RC_OK)
        return RC_FAIL;
    transform_kernels(plan, line);
    return RC_OK;
}

/* The same of the kernels of a pair of lines; `scratch` has room for two lines. */
static void
kernels_of_pair(const struct plan *plan, double offset, double *scratch,
                double *const line[RC_STRESS_KERNELS])
{
    const struct rc_stress_task *t = &plan->task;
    const struct rc_cell cell = {t->shape.dx, t->shape.dy};
    double *along = scratch, *across = along + plan->waves;

    if (plan->transposed) {
        for (size_t i = 0; i < plan->waves; i++) {
            along[i] = (double)i * plan->d_along;
            across[i] = offset;
        }
        t->type->coefficients(plan->inside, &cell, t->kernels, plan->waves, across, along, line);
    } else {
        t->type->line(plan->inside, &cell, t->kernels, plan->d_along, plan->waves, offset, line);
    }
    transform_kernels(plan, line);
}

static enum rc_status
sum_pair(struct plan *plan, const struct pair *pair, double complex *sum)
{
    const struct rc_stress_task *t = &plan->task;
    double *scratch = plan->scratch + (size_t)omp_get_thread_num() * plan->scratch_size;
    double *line[RC_STRESS_KERNELS] = {NULL};

    if (plan->repeats_across && !rc_stress_reaches(pair->offset, plan->inside->depth))
        return RC_OK;
    for (int k = 0; k < (int)plan->kernels; k++)
        line[k] = t->kernels >> k & 1 ? scratch + (size_t)(k + 2) * plan->waves : NULL;
    if (!plan->repeats_across)
        kernels_of_pair(plan, pair->offset, scratch, line);
    else if (kernels_of_wave(plan, pair->offset, line) != RC_OK)
        return RC_FAIL;
    for (int c = 0; c < RC_COMPONENTS; c++)
        for (int load = 0; load < RC_LOADS; load++) {
            int k = rc_stress_kernel(t->type, load, c);
            if (t->components >> c & 1 && rc_stress_has(t, load))
                add_product(plan, load, k, line[k], pair, sum + (size_t)c * plan->waves);
        }
    return RC_OK;
}

static enum rc_status
sum_pairs(struct plan *plan)
{
    size_t one = RC_COMPONENTS * plan->waves;
    enum rc_status status = RC_OK;

    memset(plan->sum, 0, PARTS * one * sizeof *plan->sum);
#pragma omp parallel for num_threads(plan->threads) schedule(dynamic)
    for (size_t part = 0; part < PARTS; part++)
        for (size_t g = part; g < plan->pairs; g += PARTS)
            if (sum_pair(plan, &plan->pair[g], plan->sum + part * one) != RC_OK)
#pragma omp atomic write
                status = RC_FAIL;
    for (size_t part = 1; part < PARTS; part++)
        for (size_t q = 0; q < one; q++)
            plan->sum[q] += plan->sum[part * one + q];
    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        if (plan->task.kernels >> k & 1) {
            rc_stress_count(&plan->task, k, plan->pairs * plan->waves);
            plan->task.counts->line_transforms += plan->pairs;
        }
    return status;
}

/* ---- repeats along the plane only: for each wave along it a sum over the lines ---- */

/* The kernel at line j of nodes, for a load on another one. */
static double
at_distance(const struct plan *plan, int kernel, const double *k, double j, size_t load)
{
    const double distance = j - (double)load;
    const double value = k[(size_t)fabs(distance)];

    return distance < 0 && odd_across(plan, kernel) ? -value : value;
}

/* The wave a of the lines of a source, by a kernel `k`, in the plane: `part` of the way from the line of
 * nodes `below` to the next one. */
static double complex
sum_lines(const struct plan *plan, size_t source, int kernel, const double *k, size_t a,
          double below, double part)
{
    double complex sum = 0;

    for (size_t j = 0; j < plan->m; j++) {
        if (plan->place[j] == nowhere)
            continue;
        sum += line_of(plan, source, j)[a] * ((1 - part) * at_distance(plan, kernel, k, below, j) +
                                              part * at_distance(plan, kernel, k, below + 1, j));
    }
    return odd_along(plan, kernel) ? -I * sum : sum;
}

/* All components of wave a along the plane. */
static enum rc_status
sum_wave(const struct plan *plan, size_t a, double below, double part)
{
    const struct rc_stress_task *t = &plan->task;
    const struct rc_line_at at = {.cell = plan->d_across,
                                  .step = 1,
                                  .n = plan->m + 1,
                                  .wave = rc_fourier_q(a, plan->n, plan->d_along)};
    const double most = RC_STRESS_REACH / plan->inside->depth;
    double *scratch = plan->scratch + (size_t)omp_get_thread_num() * plan->scratch_size;
    double *line[RC_STRESS_KERNELS] = {NULL};
    unsigned kernels = rc_stress_reaches(at.wave, plan->inside->depth) ? t->kernels : 0;

    for (int k = 0; k < (int)plan->kernels; k++) {
        line[k] = scratch + (size_t)k * at.n;
        if (2 * a == plan->n && odd_along(plan, k))
            kernels &= ~(1u << k);
    }
    if (rc_inside_lines(plan->inside, kernels, plan->transposed, &at, most, line, NULL) != RC_OK)
        return RC_FAIL;
    for (int c = 0; c < RC_COMPONENTS; c++) {
        double complex sum = 0;
        for (int load = 0; load < RC_LOADS; load++) {
            const int k = rc_stress_kernel(t->type, load, c);
            if (t->components >> c & 1 && rc_stress_has(t, load) && kernels >> k & 1)
                sum += t->load[load].weight *
                       sum_lines(plan, t->load[load].source, k, line[k], a, below, part);
        }
        plan->sum[(size_t)c * plan->waves + a] = sum;
    }
    return RC_OK;
}

static enum rc_status
sum_along(struct plan *plan)
{
    const double place = plan->task.options.at / plan->d_across + (double)(plan->m - 1) / 2;
    const double whole = round(place), below = fabs(place - whole) < 1e-9 ? whole : floor(place);
    enum rc_status status = RC_OK;

#pragma omp parallel for num_threads(plan->threads) schedule(dynamic)
    for (size_t a = 0; a < plan->waves; a++)
        if (sum_wave(plan, a, below, fmax(place - below, 0)) != RC_OK)
#pragma omp atomic write
            status = RC_FAIL;
    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        if (plan->task.kernels >> k & 1)
            rc_stress_count(&plan->task, k, plan->waves * (plan->m + 1));
    return status;
}

/* ---- periodic: waves ---- */

/* Waves m - b across are as long as waves b; the first may have q = 0. */
static void
set_numbers(const struct plan *plan, const double *q, double *numbers)
{
    const struct rc_stress_task *t = &plan->task;
    size_t n = rc_stress_numbers(t), m = plan->m, first = q[0] > 0 ? 0u : 1u;

    memset(numbers, 0, first * n * sizeof *numbers);
    t->type->waves(plan->inside, m / 2 + 1 - first, q + first, numbers + first * n);
    for (size_t b = m / 2 + 1; b < m; b++)
        memcpy(numbers + b * n, numbers + (m - b) * n, n * sizeof *numbers);
}

/* Symbols of all kernels at the waves across, for wave a along; m each, in `symbol`. */
static void
wave_symbols(const struct plan *plan, size_t a, double *scratch, double *symbol[RC_STRESS_KERNELS])
{
    const struct rc_stress_task *t = &plan->task;
    size_t m = plan->m;
    double *along = scratch, *across = along + m, *x = across + m, *y = x + m, *q = y + m;
    double *first = q + m, *numbers = first + plan->kernels * m;
    const struct rc_waves waves = {m, x, y, q, numbers};

    for (size_t b = 0; b < m; b++) {
        along[b] = rc_fourier_q(a, plan->n, plan->d_along);
        across[b] = rc_fourier_q(b, m, plan->d_across);
    }
    rc_wave_directions(m, plan->transposed ? across : along, plan->transposed ? along : across, x,
                       y, q);
    set_numbers(plan, q, numbers);
    for (size_t k = 0; k < plan->kernels; k++) {
        symbol[k] = first + k * m;
        if (t->kernels >> k & 1)
            rc_inside_symbol(plan->inside, (int)k, &waves, &t->shape, symbol[k]);
    }
}

/* Transform of a component due to wave b across of a source, over that wave. */
static double complex
response(const struct plan *plan, size_t source, int component,
         double *const symbol[RC_STRESS_KERNELS], size_t b, bool last_x, bool last_y)
{
    static const double complex powers[] = {1, -I, -1}; /* powers of -i */
    const struct rc_stress_task *t = &plan->task;
    double complex sum = 0;

    for (int load = 0; load < RC_LOADS; load++) {
        int k = rc_stress_kernel(t->type, load, component);
        unsigned parity = rc_stress_parity[k];
        double weight = t->load[load].weight;
        if (!rc_stress_has(t, load) || t->load[load].source != source)
            continue;
        if ((parity & RC_ODD_X && last_x) || (parity & RC_ODD_Y && last_y))
            continue;
        weight *= symbol[k][b];
        sum += weight * powers[((parity & RC_ODD_X) != 0) + ((parity & RC_ODD_Y) != 0)];
    }
    return sum;
}

static enum rc_status
sum_waves(struct plan *plan)
{
    const struct rc_stress_task *t = &plan->task;
    double from_first = t->options.at + (double)(plan->m - 1) / 2 * plan->d_across;

#pragma omp parallel for num_threads(plan->threads) schedule(static)
    for (size_t a = 0; a < plan->waves; a++) {
        double *scratch = plan->scratch + (size_t)omp_get_thread_num() * plan->scratch_size;
        double *symbol[RC_STRESS_KERNELS];
        double complex sum[RC_COMPONENTS] = {0};
        wave_symbols(plan, a, scratch, symbol);
        for (size_t b = 0; b < plan->m; b++) {
            double q = rc_fourier_q(b, plan->m, plan->d_across);
            bool last_along = 2 * a == plan->n, last_across = 2 * b == plan->m;
            double complex turn =
                last_across ? CMPLX(cos(q * from_first), 0) : cexp(I * q * from_first);
            for (size_t k = 0; k < t->sources; k++) {
                double complex p = line_of(plan, k, b)[a] * turn;
                for (int c = 0; c < RC_COMPONENTS; c++)
                    if (t->components >> c & 1)
                        sum[c] += p * response(plan, k, c, symbol, b,
                                               plan->transposed ? last_across : last_along,
                                               plan->transposed ? last_along : last_across);
            }
        }
        for (int c = 0; c < RC_COMPONENTS; c++)
            plan->sum[(size_t)c * plan->waves + a] = sum[c];
    }
    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        if (t->kernels >> k & 1)
            rc_stress_count(t, k, plan->waves * plan->m);
    return RC_OK;
}

/* ---- all boundaries ---- */

static enum rc_status
slice(void *at, double depth, double *const s[RC_COMPONENTS], struct rc_err *err)
{
    struct plan *plan = at;
    const bool periodic = plan->repeats_along && plan->repeats_across;
    const double scale = 1 / ((double)plan->length * (periodic ? (double)plan->m : 1));
    enum rc_status status;

    if ((plan->inside = rc_stress_inside(&plan->task, depth, err)) == NULL)
        return RC_FAIL;
    status = periodic ? sum_waves(plan) : plan->repeats_along ? sum_along(plan) : sum_pairs(plan);
    if (status != RC_OK)
        rc_err_set(err, "out of memory for the kernels of a section of %zu nodes", plan->n);
    for (int c = 0; c < RC_COMPONENTS; c++) {
        if (status != RC_OK || !(plan->task.components >> c & 1))
            continue;
        rc_line_backward(plan->line, plan->sum + (size_t)c * plan->waves, plan->scratch);
        for (size_t i = 0; i < plan->n; i++)
            s[c][i] = scale * plan->scratch[i];
        plan->task.counts->line_transforms++;
    }
    rc_inside_free(plan->inside);
    plan->inside = NULL;
    return status;
}

const struct rc_stress_evaluator rc_stress_section = {
    .new = plan_new,
    .slice = slice,
    .free = plan_free,
};
