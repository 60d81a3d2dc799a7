#include "inside.h"

#include <stdlib.h>
#include <string.h>

static const struct rc_engine *const engines[] = {
#define RC_ENGINE(name) &rc_engine_##name,
#include "engines.list"
#undef RC_ENGINE
};

enum {
    ENGINES = sizeof engines / sizeof *engines,
    SMALL = 24 * 24 /* nodes below which the direct sum beats the transforms */
};

struct rc_conv {
    const struct rc_engine *engine;
    void *plan;
};

static const struct rc_engine *
choose(const struct rc_shape *shape, const char *name, struct rc_err *err)
{
    if (name == NULL || strcmp(name, "auto") == 0)
        return shape->nx * shape->ny <= SMALL ? &rc_engine_direct : &rc_engine_fft;
    for (size_t k = 0; k < ENGINES; k++)
        if (strcmp(engines[k]->name, name) == 0)
            return engines[k];
    rc_err_set(err, "there is no engine '%s'", name);
    return NULL;
}

struct rc_conv *
rc_conv_new(const struct rc_shape *shape, double estar, const char *engine, size_t threads,
            struct rc_err *err)
{
    struct rc_sum sum = {.shape = *shape,
                         .kernel = &rc_kernel_boussinesq,
                         .medium = {.estar = estar},
                         .threads = threads};
    struct rc_conv *conv = NULL;

    if (rc_shape_check(shape, err) != RC_OK)
        return NULL;
    conv = calloc(1, sizeof *conv);
    if (conv == NULL) {
        rc_err_set(err, "out of memory for a plan");
        return NULL;
    }
    if ((conv->engine = choose(shape, engine, err)) == NULL ||
        (conv->plan = conv->engine->new(&sum, err)) == NULL) {
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
rc_conv_memory(const struct rc_shape *shape, const char *name)
{
    struct rc_sum sum = {.shape = *shape, .kernel = &rc_kernel_boussinesq};
    const struct rc_engine *engine = choose(shape, name, NULL);

    return engine == NULL ? 0 : engine->memory(&sum);
}
