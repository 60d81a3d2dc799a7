/*
 * One kernel on one grid: which engine does the sums, and why.
 */
#include "engine.h"

#include <stdlib.h>
#include <string.h>

static const struct rc_engine *const engines[] = {
#define RC_ENGINE(name) &rc_engine_##name,
#include "engines.list"
#undef RC_ENGINE
};

enum {
    ENGINES = sizeof engines / sizeof *engines,
    SMALL = 24 * 24,  /* nodes below which the direct sum beats the transforms              */
    LARGE = 512 * 512 /* nodes from which multi-level summation pays on a sparse map        */
};

/* Where multi-level summation begins to beat the transforms (bench-convolution sparse: 0.7 of their
 * time with 5 % of the nodes loaded in one disc, about theirs in 300 spots). */
static const double sparse = 0.05, sparse_tol = 1e-6;

struct rc_conv {
    const struct rc_engine *engine;
    const char *reason;
    void *plan;
};

static struct rc_sum
sum_of(const struct rc_shape *shape, double estar, const struct rc_conv_options *o)
{
    return (struct rc_sum){.shape = *shape,
                           .boundary = o->boundary,
                           .kernel = &rc_kernel_boussinesq,
                           .medium = {.estar = estar},
                           .tol = o->tol,
                           .order = o->order,
                           .correction = o->correction,
                           .threads = o->threads};
}

static const struct rc_engine *
named(const char *name)
{
    for (size_t k = 0; k < ENGINES; k++)
        if (strcmp(engines[k]->name, name) == 0)
            return engines[k];
    return NULL;
}

/* The choice among the engines, with its reason. */
static const struct rc_engine *
choose(const struct rc_sum *sum, const struct rc_conv_options *o, const char **reason)
{
    if (sum->boundary == RC_PERIODIC) {
        *reason = "the boundary is periodic";
        return named("fft");
    }
    if (sum->order != 0) {
        *reason = "its order is given";
        return named("mlms");
    }
    if (sum->shape.nx * sum->shape.ny <= SMALL) {
        *reason = "the grid is small";
        return named("direct");
    }
    if (o->memory != 0 && named("fft")->memory(sum) > o->memory &&
        named("mlms")->memory(sum) <= o->memory) {
        *reason = "the transforms need more memory than is allowed";
        return named("mlms");
    }
    if (o->loaded > 0 && o->loaded <= sparse && o->tol >= sparse_tol &&
        sum->shape.nx * sum->shape.ny >= LARGE) {
        *reason = "few nodes are loaded, and the asked accuracy allows it";
        return named("mlms");
    }
    *reason = o->tol > 0 ? "the fastest on a map loaded like this"
                         : "the fastest of those that are exact to rounding";
    return named("fft");
}

static const struct rc_engine *
find(const struct rc_sum *sum, const struct rc_conv_options *o, const char **reason,
     struct rc_err *err)
{
    if (o->engine == NULL || strcmp(o->engine, "auto") == 0)
        return choose(sum, o, reason);
    *reason = "asked for";
    if (named(o->engine) == NULL)
        rc_err_set(err, "there is no engine '%s'", o->engine);
    return named(o->engine);
}

const char *
rc_conv_choice(const struct rc_shape *shape, const struct rc_conv_options *options,
               const char **reason)
{
    struct rc_sum sum = sum_of(shape, 1, options);
    const struct rc_engine *engine = find(&sum, options, reason, NULL);

    return engine == NULL ? "" : engine->name;
}

struct rc_conv *
rc_conv_new(const struct rc_shape *shape, double estar, const struct rc_conv_options *options,
            struct rc_err *err)
{
    struct rc_sum sum = sum_of(shape, estar, options);
    struct rc_conv *conv = NULL;

    if (rc_shape_check(shape, err) != RC_OK)
        return NULL;
    conv = calloc(1, sizeof *conv);
    if (conv == NULL) {
        rc_err_set(err, "out of memory for a plan");
        return NULL;
    }
    if ((conv->engine = find(&sum, options, &conv->reason, err)) == NULL ||
        (conv->plan = conv->engine->new (&sum, err)) == NULL) {
        rc_conv_free(conv);
        return NULL;
    }
    return conv;
}

void
rc_conv_apply(struct rc_conv *conv, const double *p, double *u)
{
    conv->engine->apply(conv->plan, p, u);
}

const char *
rc_conv_engine(const struct rc_conv *conv)
{
    return conv->engine->name;
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
    free(conv);
}

size_t
rc_conv_memory(const struct rc_shape *shape, const struct rc_conv_options *options)
{
    struct rc_sum sum = sum_of(shape, 1, options);
    const char *reason;
    const struct rc_engine *engine = find(&sum, options, &reason, NULL);

    return engine == NULL ? 0 : engine->memory(&sum);
}
