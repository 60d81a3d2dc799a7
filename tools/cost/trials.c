/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The trials in the order of the table: every method with every engine of libcontact's tables. The first of
 * each, which "auto" uses, are tried in small steps of the tolerance and on coarser grids. The others are
 * tried in larger steps for comparison. For a body that yields: every number of slabs with every number of
 * increments. For bodies that attract each other: the only method. Then come the stresses, with every engine.
 */
#include "cost.h"

#include <math.h>
#include <string.h>

/* Tolerances 1e-from, 1e-(from + step), ..., 1e-to; step 0: none. */
struct range {
    int from, to, step;
};

static struct range
range_of(size_t method, size_t engine)
{
    const struct rc_method_info *m = rc_method_info(method);
    const struct rc_engine_info *e = rc_engine_info(engine);
    bool sums = e->order > 1;

    if ((e->precise && !m->mixed) || (method > 0 && sums))
        return (struct range){0, 0, 0}; /* under the first condition the trial equals that of the
                                           previous engine */
    if (method == 0)
        return (struct range){2, 10, sums ? 4 : engine == 0 ? 1 : 2};
    return (struct range){2, engine == 0 ? 8 : 4, 2};
}

/* On coarser grids the discretization error soon exceeds the effect of the tolerance. With adhesion an error
 * above 1e-3 may belong to another state, and a coarser grid has fewer nodes per cohesive length. */
static const struct {
    unsigned coarse;
    struct range range;
} coarser[] = {{8, {2, 2, 1}}, {4, {2, 2, 1}}, {2, {2, 3, 1}}},
  adhesion[] = {{4, {3, 3, 1}}, {2, {3, 4, 1}}, {1, {3, 6, 1}}, {1, {8, 8, 1}}};

/* The numbers of slabs are half of rc-solve's, as many, and twice as many. */
static const double stacks[] = {0.5, 1, 2};
static const size_t increments[] = {4, 8, 16, 32, 64};
static const double contact_tol = 1e-4; /* tolerance of each contact, as in rc-solve */

/* Stresses: the first engine is exact; with a tolerance it is faster, because deep slices use coarser grids.
 * Other engines whose time grows with the square of the nodes take no tolerance. */
static const double first_tols[] = {0, 1e-2, 1e-3, 1e-4, 1e-6}, other_tols[] = {1e-2, 1e-4, 1e-6},
                    rounding[] = {0};

#define COUNT(array) (sizeof(array) / sizeof *(array))

static void
add(struct cost_case *c, struct cost_trial t)
{
    for (const struct cost_column *col = cost_columns; col->figure.name != NULL; col++)
        *cost_value(col, &t.is) = NAN;
    t.is.runs = 0;
    t.is.increments = t.increments > 0 ? (double)t.increments : NAN;
    t.planned = t.mebibytes = NAN;
    t.goal = !(t.about & COST_YIELD) || t.reference ? t.tol : isnan(c->error) ? 0 : c->error;
    t.shape = c->shape;
    /* so that both grids have the same area */
    for (size_t side = 0; side < 2 && t.coarse > 1; side++) {
        size_t *n = side == 0 ? &t.shape.nx : &t.shape.ny, nodes = *n;
        double *d = side == 0 ? &t.shape.dx : &t.shape.dy;
        *n = (nodes + t.coarse / 2) / t.coarse > 0 ? (nodes + t.coarse / 2) / t.coarse : 1;
        *d *= (double)nodes / (double)*n;
    }
    c->trial = tool_grown(c->tool, c->trial, c->trials, &c->room, sizeof t, "a list of trials");
    c->trial[c->trials++] = t;
}

static void
add_range(struct cost_case *c, struct cost_trial t, unsigned coarse, struct range range)
{
    t.about = c->about & ~(unsigned)COST_STRESS;
    t.coarse = coarse;
    for (int digits = range.from; range.step > 0 && digits <= range.to; digits += range.step) {
        t.tol = 1 / pow(10, digits);
        add(c, t);
    }
}

static struct cost_trial
elastic(size_t method, size_t engine)
{
    const struct rc_method_info *m = rc_method_info(method);
    const struct rc_engine_info *e = rc_engine_info(engine);

    return (struct cost_trial){.method = m->name,
                               .kernel = e->name,
                               .arithmetic = m->mixed && e->mixed ? "mixed" : "double"};
}

static void
add_elastic(struct cost_case *c, size_t kernels, size_t methods)
{
    for (size_t m = 0; rc_method_info(m) != NULL; m++)
        for (size_t e = 0; rc_engine_info(e) != NULL; e++) {
            if (!(methods >> m & 1) || !(kernels >> e & 1))
                continue;
            for (size_t k = 0; k < COUNT(coarser) && m == 0 && e == 0; k++)
                add_range(c, elastic(m, e), coarser[k].coarse, coarser[k].range);
            add_range(c, elastic(m, e), 1, range_of(m, e));
        }
}

static void
add_yield(struct cost_case *c)
{
    for (size_t k = 0; k < COUNT(stacks) * COUNT(increments); k++) {
        struct cost_trial t = elastic(0, 0);
        t.about = c->about;
        t.coarse = 1;
        t.tol = contact_tol;
        t.stack = stacks[k / COUNT(increments)];
        t.increments = increments[k % COUNT(increments)];
        add(c, t);
    }
}

static void
add_adhesion(struct cost_case *c)
{
    struct cost_trial t = elastic(0, 0);

    t.method = "gap";
    for (size_t k = 0; k < COUNT(adhesion); k++)
        add_range(c, t, adhesion[k].coarse, adhesion[k].range);
}

static void
add_stresses(struct cost_case *c)
{
    const struct rc_engine_info *e;

    for (size_t k = 0; (e = rc_engine_info(k)) != NULL; k++) {
        const double *tol = k == 0 ? first_tols : e->order == 1 ? other_tols : rounding;
        size_t n = k == 0 ? COUNT(first_tols) : e->order == 1 ? COUNT(other_tols) : 1;

        if (e->precise || (rc_repeats(c->line.boundary) > 0 && !e->periodic))
            continue; /* stresses are always in double precision */
        for (size_t i = 0; i < n; i++)
            add(c, (struct cost_trial){.about = COST_STRESS,
                                       .kernel = e->name,
                                       .coarse = 1,
                                       .tol = tol[i],
                                       .reference = k == 0 && tol[i] == 0});
    }
}

/* Double precision throughout, to 1e-12; for a body that yields, more increments than any trial and the most
 * slabs. */
static struct cost_trial
reference_of(unsigned about)
{
    struct cost_trial r = elastic(0, 0);
    const struct rc_engine_info *e;

    r.tol = about & COST_ADHESION ? 1e-11 : about & COST_YIELD ? 1e-6 : 1e-12;
    if (about & COST_ADHESION) {
        r.method = "gap";
    } else if (about & COST_YIELD) {
        r.increments = 2 * increments[COUNT(increments) - 1];
        r.stack = stacks[COUNT(stacks) - 1];
    } else {
        for (size_t k = 0; (e = rc_engine_info(k)) != NULL && strcmp(r.arithmetic, "double") != 0;
             k++)
            if (e->precise)
                r = (struct cost_trial){
                    .method = r.method, .kernel = e->name, .arithmetic = "double", .tol = r.tol};
    }
    r.reference = true;
    r.coarse = 1;
    r.about = about & ~(unsigned)COST_STRESS;
    return r;
}

void
cost_trials(struct cost_case *c, size_t kernels, size_t methods)
{
    add(c, reference_of(c->about));
    c->reference = c->trial[0];
    c->trials = 0;
    if (c->about & COST_ADHESION)
        add_adhesion(c);
    else if (c->about & COST_YIELD)
        add_yield(c);
    else
        add_elastic(c, kernels, methods);
    c->pressures = c->trials;
    if (c->about & COST_STRESS)
        add_stresses(c);
}

/* ---- names ---- */

size_t
cost_series(const struct cost_trial *t)
{
    size_t place = 0;

    if (t->about & COST_STRESS)
        return words_engine_place(t->kernel);
    if (t->about & COST_YIELD) {
        while (place + 1 < COUNT(stacks) && stacks[place] != t->stack)
            place++;
        return place;
    }
    for (size_t m = 0; rc_method_info(m) != NULL; m++)
        for (size_t e = 0; rc_engine_info(e) != NULL; e++) {
            if (strcmp(rc_method_info(m)->name, t->method) == 0 &&
                strcmp(rc_engine_info(e)->name, t->kernel) == 0)
                return place;
            place += range_of(m, e).step > 0;
        }
    return 0;
}

/* "12 slabs"; before the number is known "1 x the slabs". */
static const char *
slabs_of(char text[32], const struct cost_trial *t)
{
    if (t->is.slabs > 0)
        snprintf(text, 32, "%.0f slabs", t->is.slabs);
    else
        snprintf(text, 32, "%g x the slabs", t->stack);
    return text;
}

const char *
cost_series_name(char text[64], const struct cost_trial *t)
{
    char slabs[32];

    if (t->about & COST_STRESS)
        snprintf(text, 64, "%s%s", t->kernel,
                 t->kernel == rc_engine_info(0)->name ? ", deep slices coarser" : "");
    else if (t->increments > 0)
        snprintf(text, 64, "%s", slabs_of(slabs, t));
    else
        snprintf(text, 64, "%s, %s", t->method, t->kernel);
    return text;
}

const char *
cost_point_name(char text[32], const struct cost_trial *t)
{
    if (t->increments > 0)
        snprintf(text, 32, "%zu", t->increments);
    else if (t->coarse > 1)
        snprintf(text, 32, "1/%u", t->coarse);
    else
        snprintf(text, 32, t->tol > 0 ? "%.0e" : "exact", t->tol);
    return text;
}

const char *
cost_name(char text[128], const struct cost_trial *t)
{
    char slabs[32];

    if (t->about & COST_STRESS)
        snprintf(text, 128, "stresses by %s, tol %.0e", t->kernel, t->tol);
    else if (t->increments > 0)
        snprintf(text, 128, "%zu increments, %s, %zu x %zu", t->increments, slabs_of(slabs, t),
                 t->shape.nx, t->shape.ny);
    else
        snprintf(text, 128, "%s, %s, tol %.0e, %zu x %zu", t->method, t->kernel, t->tol,
                 t->shape.nx, t->shape.ny);
    return text;
}

size_t
cost_trial_words(const struct cost_trial *t, const char *word[], size_t n)
{
    static char tol[RC_NUMBER_SIZE], of[2][32];

    if (t->about == COST_PRESSURE || t->about == (COST_PRESSURE | COST_LEAK)) {
        word[n++] = "--method";
        word[n++] = t->method;
    }
    /* yield and adhesion have only one method and kernel */
    if (!(t->about & (COST_YIELD | COST_ADHESION))) {
        word[n++] = "--kernel";
        word[n++] = t->kernel;
    }
    if (t->increments > 0) {
        snprintf(of[0], sizeof of[0], "%zu", t->increments);
        snprintf(of[1], sizeof of[1], "%.0f", t->is.slabs);
        word[n++] = "--increments";
        word[n++] = of[0];
        if (t->is.slabs > 0) {
            word[n++] = "--slabs";
            word[n++] = of[1];
        }
    }
    if (t->goal > 0) {
        word[n++] = "--tol";
        word[n++] = rc_number_text(tol, t->goal);
    }
    return n;
}
