/*
 * Which trials there are, in the order in which the table shows them: every method with every
 * engine of libcontact's tables. The first of each, which "auto" takes, are tried in small steps of
 * the tolerance and on coarser grids, the others in larger steps, to compare with. Of a body that yields
 * inside the first of both, with every stack of slabs in every number of increments; of bodies that attract
 * each other the one method that there is.
 */
#include "cost.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Tolerances 1e-2, 1e-(2 + step), ..., 1e-to; step 0: there are none. */
struct range {
    int to, step;
};

enum {
    FROM = 2
};

static struct range
range_of(size_t method, size_t engine)
{
    const struct rc_method_info *m = rc_method_info(method);
    const struct rc_engine_info *e = rc_engine_info(engine);

    if (e->precise && !m->mixed)
        return (struct range){0, 0}; /* the row before it is the same */
    if (method == 0)
        return (struct range){10, e->order > 1 ? 4 : engine == 0 ? 1 : 2};
    if (e->order > 1)
        return (struct range){0, 0};
    return (struct range){engine == 0 ? 8 : 4, 2};
}

/* Coarser grids: how many times fewer nodes along a side, and the last tolerance 1e-to. Below that
 * their discretization error hides what a tolerance changes. */
static const struct {
    unsigned coarse;
    int to;
} coarser[] = {{8, 2}, {4, 2}, {2, 3}};

enum {
    COARSER = sizeof coarser / sizeof *coarser
};

struct list {
    struct cost_trial *trial;
    size_t n;
};

static enum rc_status
add(struct list *list, size_t method, size_t engine, unsigned coarse, struct range range)
{
    const struct rc_method_info *m = rc_method_info(method);
    const struct rc_engine_info *e = rc_engine_info(engine);

    for (int digits = FROM; digits <= range.to; digits += range.step) {
        struct cost_trial *more = realloc(list->trial, (list->n + 1) * sizeof *more);

        if (more == NULL)
            return RC_FAIL;
        list->trial = more;
        list->trial[list->n++] = (struct cost_trial){
            .settings = {.method = m->name,
                         .kernel = e->name,
                         .arithmetic = m->mixed && e->mixed ? "mixed" : "double",
                         .coarse = coarse,
                         .tol = 1 / pow(10, digits)}};
    }
    return RC_OK;
}

static enum rc_status
add_series(struct list *list, size_t method, size_t engine)
{
    struct range range = range_of(method, engine);
    enum rc_status status = RC_OK;

    for (size_t k = 0; k < COARSER && method == 0 && engine == 0 && status == RC_OK; k++)
        status = add(list, method, engine, coarser[k].coarse, (struct range){coarser[k].to, 1});
    if (range.step > 0 && status == RC_OK)
        status = add(list, method, engine, 1, range);
    return status;
}

struct cost_trial *
cost_trials(size_t kernels, size_t methods, size_t *n)
{
    struct list list = {.trial = malloc(sizeof *list.trial)};
    enum rc_status status = list.trial == NULL ? RC_FAIL : RC_OK;

    for (size_t m = 0; rc_method_info(m) != NULL; m++)
        for (size_t e = 0; rc_engine_info(e) != NULL && status == RC_OK; e++)
            if ((methods >> m & 1) && (kernels >> e & 1))
                status = add_series(&list, m, e);
    if (status != RC_OK) {
        free(list.trial);
        list = (struct list){.trial = NULL};
    }
    *n = list.n;
    return list.trial;
}

/* Half as many slabs, as many as rc-solve takes, twice as many. */
static const double stacks[] = {0.5, 1, 2};
static const size_t increments[] = {2, 4, 8, 16, 32};

enum {
    STACKS = sizeof stacks / sizeof *stacks,
    INCREMENTS = sizeof increments / sizeof *increments,
    REFERENCE = 128 /* increments */
};
static const double contact_tol = 1e-4; /* of each contact, as rc-solve has it */

static struct cost_settings
yielding(double stack, size_t n, double tol)
{
    return (struct cost_settings){.method = rc_method_info(0)->name,
                                  .kernel = rc_engine_info(0)->name,
                                  .arithmetic = "mixed",
                                  .coarse = 1,
                                  .tol = tol,
                                  .increments = n,
                                  .stack = stack};
}

struct cost_trial *
cost_yielding_trials(size_t *n)
{
    struct cost_trial *trial = calloc(STACKS * INCREMENTS, sizeof *trial);

    *n = STACKS * INCREMENTS;
    for (size_t k = 0; k < *n && trial != NULL; k++)
        trial[k].settings =
            yielding(stacks[k / INCREMENTS], increments[k % INCREMENTS], contact_tol);
    return trial;
}

/* The loosest tolerance is 1e-3: farther off a state may be another. On a coarser grid the cohesive length
 * has fewer nodes. */
static const struct {
    unsigned coarse;
    int digits;
} attracting[] = {{4, 3}, {2, 3}, {2, 4}, {1, 3}, {1, 4}, {1, 5}, {1, 6}, {1, 8}};

static struct cost_settings
attracted(unsigned coarse, int digits)
{
    return (struct cost_settings){.method = "gap",
                                  .kernel = rc_engine_info(0)->name,
                                  .arithmetic = "mixed",
                                  .coarse = coarse,
                                  .tol = 1 / pow(10, digits),
                                  .attracts = true};
}

struct cost_trial *
cost_attracting_trials(size_t *n)
{
    struct cost_trial *trial = calloc(sizeof attracting / sizeof *attracting, sizeof *trial);

    *n = sizeof attracting / sizeof *attracting;
    for (size_t k = 0; k < *n && trial != NULL; k++)
        trial[k].settings = attracted(attracting[k].coarse, attracting[k].digits);
    return trial;
}

struct cost_settings
cost_attracting_reference(void)
{
    return attracted(1, 11);
}

struct rc_shape
cost_coarse_shape(const struct rc_shape *map, unsigned factor)
{
    size_t nx = (map->nx + factor / 2) / factor, ny = (map->ny + factor / 2) / factor;

    nx = nx > 0 ? nx : 1;
    ny = ny > 0 ? ny : 1;
    return (struct rc_shape){nx, ny, map->dx * ((double)map->nx / (double)nx),
                             map->dy * ((double)map->ny / (double)ny)};
}

size_t
cost_series(const struct cost_settings *settings)
{
    size_t place = 0;

    if (settings->attracts)
        return 0;
    if (settings->increments > 0) {
        while (place + 1 < STACKS && stacks[place] != settings->stack)
            place++;
        return place;
    }
    for (size_t m = 0; rc_method_info(m) != NULL; m++)
        for (size_t e = 0; rc_engine_info(e) != NULL; e++) {
            if (strcmp(rc_method_info(m)->name, settings->method) == 0 &&
                strcmp(rc_engine_info(e)->name, settings->kernel) == 0)
                return place;
            place += range_of(m, e).step > 0;
        }
    return place;
}

/* "12 slabs", before they are known "1 x the slabs". */
static const char *
slabs_of(char text[32], const struct cost_trial *c)
{
    if (c->slabs > 0)
        snprintf(text, 32, "%zu slabs", c->slabs);
    else
        snprintf(text, 32, "%g x the slabs", c->settings.stack);
    return text;
}

const char *
cost_series_name(char text[64], const struct cost_trial *c)
{
    char slabs[32];

    if (c->settings.increments > 0)
        snprintf(text, 64, "%s", slabs_of(slabs, c));
    else
        snprintf(text, 64, "%s, %s", c->settings.method, c->settings.kernel);
    return text;
}

const char *
cost_point_name(char text[32], const struct cost_settings *s)
{
    if (s->increments > 0)
        snprintf(text, 32, "%zu", s->increments);
    else if (s->coarse > 1)
        snprintf(text, 32, "1/%u", s->coarse);
    else
        snprintf(text, 32, "%.0e", s->tol);
    return text;
}

struct cost_settings
cost_reference(bool yields)
{
    const struct rc_engine_info *engine = rc_engine_info(0), *info;

    if (yields) {
        struct cost_settings s = yielding(stacks[STACKS - 1], REFERENCE, contact_tol / 100);
        s.precise = true;
        s.arithmetic = "double";
        return s;
    }

    for (size_t e = 0; !engine->precise && (info = rc_engine_info(e)) != NULL; e++)
        engine = info->precise ? info : engine;
    return (struct cost_settings){.method = rc_method_info(0)->name,
                                  .kernel = engine->name,
                                  .arithmetic = "double",
                                  .coarse = 1,
                                  .tol = 1e-12};
}

const char *
cost_name(char text[128], const struct cost_trial *c)
{
    char slabs[32];

    if (c->settings.increments > 0)
        snprintf(text, 128, "%zu increments, %s, %zu x %zu", c->settings.increments,
                 slabs_of(slabs, c), c->shape.nx, c->shape.ny);
    else
        snprintf(text, 128, "%s, %s, tol %.0e, %zu x %zu", c->settings.method, c->settings.kernel,
                 c->settings.tol, c->shape.nx, c->shape.ny);
    return text;
}
