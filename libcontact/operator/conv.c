/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * One kernel on one grid: the choice of the engine and its reason.
 */
#include "engine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/ranks/ranks.h"

static const struct rc_engine *const engines[] = {
#define RC_ENGINE(name) &rc_engine_##name,
#include RC_ENGINES_LIST
#undef RC_ENGINE
};

enum {
    ENGINES = sizeof engines / sizeof *engines,
    SMALL = 24 * 24,  /* nodes; for fewer the direct sum beats the transforms */
    LARGE = 512 * 512 /* nodes; for more multi-level summation pays on a sparse map */
};

/* Cases where multi-level summation beats the transforms (bench-convolution sparse). It takes 0.7 of their
 * time with 5 % of the nodes loaded in one disc, and about their time with 300 spots. */
static const double sparse = 0.05, sparse_tol = 1e-6;

struct rc_conv {
    const struct rc_engine *engine;
    bool precise; /* the engine's name demanded double precision */
    const char *reason;
    void *plan;
    struct rc_solids own;      /* the bodies, unless the caller owns them */
    struct rc_surface surface; /* in m and Pa */
};

/* Without a surface, for estimates only: the memory of a plan hardly depends on the bodies. */
static struct rc_sum
sum_of(const struct rc_shape *shape, const struct rc_surface *surface,
       const struct rc_conv_options *o)
{
    return (struct rc_sum){.shape = *shape,
                           .boundary = rc_boundary_on(shape, o->boundary),
                           .kernel =
                               surface == NULL ? rc_kernel_of_one : rc_surface_kernel(surface),
                           .tol = o->tol,
                           .precise = o->precise,
                           .order = o->order,
                           .correction = o->correction,
                           .threads = o->threads,
                           .ranks = rc_ranks_count(o->ranks) > 1 ? o->ranks : NULL};
}

const struct rc_engine_info *
rc_engine_info(size_t k)
{
    for (size_t e = 0; e < ENGINES; e++) {
        if (k-- == 0)
            return &engines[e]->info;
        if (engines[e]->precise.name != NULL && k-- == 0)
            return &engines[e]->precise;
    }
    return NULL;
}

static const char *
engine_name(const void *of, size_t k)
{
    (void)of;
    return k == 0 ? "auto" : rc_engine_info(k - 1) == NULL ? NULL : rc_engine_info(k - 1)->name;
}

enum rc_status
rc_engine_absent(const char *name, struct rc_err *err)
{
    rc_err_set(err, "there is no engine '%s'", name);
    return rc_err_choices(err, engine_name, NULL);
}

const struct rc_engine *
rc_engine_named(const char *name, bool *precise)
{
    bool unused;

    if (precise == NULL)
        precise = &unused;
    for (size_t k = 0; k < ENGINES; k++) {
        const char *other = engines[k]->precise.name;
        *precise = other != NULL && strcmp(other, name) == 0;
        if (*precise || strcmp(engines[k]->info.name, name) == 0)
            return engines[k];
    }
    return NULL;
}

const struct rc_engine *
rc_engine_of_transforms(void)
{
    size_t k = 0;

    while (k + 1 < ENGINES && !engines[k]->transforms)
        k++;
    return engines[k];
}

enum rc_status
rc_engine_serves(const struct rc_engine *engine, const char *name, struct rc_boundary boundary,
                 const struct rc_ranks *ranks, struct rc_err *err)
{
    const char *other = rc_engine_of_transforms()->info.name;

    if (rc_ranks_count(ranks) > 1 && !engine->transforms)
        return rc_err_set(err,
                          "the engine '%s' needs the map in one process: with several processes "
                          "take auto or '%s'",
                          name, other);
    if (rc_repeats(boundary) > 0 && !engine->info.periodic)
        return rc_err_set(err,
                          "the sums of the engine '%s' have no end on a %s boundary: leave "
                          "the choice to auto, or take '%s'",
                          name, rc_boundary_word(boundary), other);
    return RC_OK;
}

/* The bytes of a sum in addition to p and u. */
static double
bytes(const struct rc_engine *engine, const struct rc_sum *sum)
{
    const bool single = sum->tol >= RC_SINGLE_FLOOR && !sum->precise;
    const struct rc_engine_info *info =
        single || engine->precise.name == NULL ? &engine->info : &engine->precise;

    return (double)(sum->shape.nx * sum->shape.ny) *
           rc_by_padding(sum->boundary, info->sum_bytes[0], info->sum_bytes[1]);
}

/* Chooses an engine; *reason says why. */
static const struct rc_engine *
choose(const struct rc_sum *sum, const struct rc_conv_options *o, const char **reason)
{
    if (rc_repeats(sum->boundary) > 0) {
        *reason = rc_has_mean(sum->boundary) ? "the map repeats along one axis"
                                             : "the boundary is periodic";
        return &rc_engine_fft;
    }
    if (sum->ranks != NULL) {
        *reason = "several processes share the map";
        return rc_engine_of_transforms();
    }
    if (sum->order != 0) {
        *reason = "its order is given";
        return &rc_engine_mlms;
    }
    if (sum->shape.nx * sum->shape.ny <= SMALL) {
        *reason = "the grid is small";
        return &rc_engine_direct;
    }
    if (o->memory != 0 && bytes(&rc_engine_fft, sum) > (double)o->memory &&
        bytes(&rc_engine_mlms, sum) <= (double)o->memory) {
        *reason = "the transforms need more memory than is allowed";
        return &rc_engine_mlms;
    }
    if (o->loaded > 0 && o->loaded <= sparse && o->tol >= sparse_tol &&
        sum->shape.nx * sum->shape.ny >= LARGE) {
        *reason = "few nodes are loaded, and the asked accuracy allows it";
        return &rc_engine_mlms;
    }
    *reason = o->tol > 0 && !o->precise ? "the fastest on a map loaded like this"
                                        : "the fastest engine that is exact to rounding";
    return &rc_engine_fft;
}

/* The requested engine, or the choice; *precise if its name demands double precision. */
static const struct rc_engine *
find(struct rc_sum *sum, const struct rc_conv_options *o, bool *precise, const char **reason,
     struct rc_err *err)
{
    const struct rc_engine *engine;

    *precise = false;
    if (o->engine == NULL || strcmp(o->engine, "auto") == 0)
        return choose(sum, o, reason);
    *reason = "asked for";
    engine = rc_engine_named(o->engine, precise);
    if (engine == NULL)
        return (void)rc_engine_absent(o->engine, err), NULL;
    sum->precise |= *precise;
    return rc_engine_serves(engine, o->engine, sum->boundary, sum->ranks, err) == RC_OK ? engine
                                                                                        : NULL;
}

static const char *
name_of(const struct rc_engine *engine, bool precise)
{
    return precise ? engine->precise.name : engine->info.name;
}

const char *
rc_conv_choice(const struct rc_shape *shape, const struct rc_conv_options *options,
               const char **reason)
{
    struct rc_sum sum = sum_of(shape, NULL, options);
    bool precise;
    const struct rc_engine *engine = find(&sum, options, &precise, reason, NULL);

    return engine == NULL ? "" : name_of(engine, precise);
}

/* Takes over the bodies if `own`. */
static struct rc_conv *
conv_new(const struct rc_solids *bodies, bool own, const struct rc_shape *shape,
         const struct rc_conv_options *options, struct rc_err *err)
{
    struct rc_conv *conv = calloc(1, sizeof *conv);
    struct rc_sum sum;

    if (rc_ranks_need(options->ranks, conv != NULL, err, "out of memory for a plan") != RC_OK) {
        free(conv);
        return NULL;
    }
    if (own)
        conv->own = *bodies;
    conv->surface = (struct rc_surface){own ? &conv->own : bodies, 1, 1};
    sum = sum_of(shape, &conv->surface, options);
    if ((conv->engine = find(&sum, options, &conv->precise, &conv->reason, err)) == NULL ||
        (conv->plan = conv->engine->new (&sum, err)) == NULL) {
        conv->own.n = 0; /* return ownership to the caller */
        rc_conv_free(conv);
        return NULL;
    }
    return conv;
}

struct rc_conv *
rc_conv_new_of(const struct rc_solids *bodies, const struct rc_shape *shape,
               const struct rc_conv_options *options, struct rc_err *err)
{
    return conv_new(bodies, false, shape, options, err);
}

struct rc_conv *
rc_conv_new(const struct rc_shape *shape, const struct rc_pair *pair,
            const struct rc_conv_options *options, struct rc_err *err)
{
    struct rc_solids bodies;
    struct rc_conv *conv = NULL;

    if (rc_shape_check(shape, err) != RC_OK || rc_pair_check(pair, err) != RC_OK)
        return NULL;
    if (rc_solids_new(&bodies, pair, NULL, options->ranks, err) == RC_OK)
        conv = conv_new(&bodies, true, shape, options, err);
    if (conv == NULL)
        rc_solids_free(&bodies);
    return conv;
}

struct rc_fft *
rc_conv_fft(struct rc_conv *conv)
{
    return conv->engine->fft == NULL ? NULL : conv->engine->fft(conv->plan);
}

bool
rc_conv_mixed(const struct rc_conv *conv)
{
    return conv->engine->info.mixed && !conv->precise;
}

void
rc_conv_apply(struct rc_conv *conv, const double *p, double *u)
{
    conv->engine->apply(conv->plan, p, u);
}

const char *
rc_conv_engine(const struct rc_conv *conv)
{
    return name_of(conv->engine, conv->precise);
}

const char *
rc_conv_reason(const struct rc_conv *conv)
{
    return conv->reason;
}

double
rc_conv_error(const struct rc_conv *conv)
{
    return conv->engine->error(conv->plan);
}

void
rc_conv_free(struct rc_conv *conv)
{
    if (conv == NULL)
        return;
    if (conv->plan != NULL)
        conv->engine->free(conv->plan);
    rc_solids_free(&conv->own);
    free(conv);
}

enum rc_status
rc_conv_check(const struct rc_shape *shape, const struct rc_conv_options *options,
              struct rc_err *err)
{
    struct rc_sum sum = sum_of(shape, NULL, options);
    const char *reason;
    bool precise;

    return find(&sum, options, &precise, &reason, err) == NULL ? RC_FAIL : RC_OK;
}

double
rc_conv_seconds(const struct rc_shape *shape, const struct rc_conv_options *options)
{
    struct rc_sum sum = sum_of(shape, NULL, options);
    const char *reason;
    bool precise;
    const struct rc_engine *engine = find(&sum, options, &precise, &reason, NULL);
    size_t threads = options->threads == 0 ? rc_threads_available() : options->threads;

    threads *= rc_ranks_count(options->ranks);
    return engine == NULL ? NAN : engine->seconds(&sum) * 2 / (double)threads;
}
