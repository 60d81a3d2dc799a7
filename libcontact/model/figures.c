/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of figures: reads values, and finds figures by name. */
#include <math.h>
#include <string.h>

#include "row.h"

static const struct {
    const char *name;
    const struct rc_figure *figure;
} tables[] = {
#define RC_FIGURES(name) {#name, rc_figures_##name},
#include "figures.list"
#undef RC_FIGURES
};

enum {
    TABLES = sizeof tables / sizeof *tables
};

double
rc_figure_number(const struct rc_figure *f, const void *data)
{
    const void *at;

    if (data == NULL || f->kind == RC_WORD)
        return NAN;
    at = (const char *)data + f->at;
    return f->kind == RC_NUMBER  ? *(const double *)at
           : f->kind == RC_COUNT ? (double)*(const size_t *)at
                                 : *(const bool *)at;
}

const char *
rc_figure_word(const struct rc_figure *f, const void *data)
{
    return data == NULL || f->kind != RC_WORD
               ? NULL
               : *(const char *const *)(const void *)((const char *)data + f->at);
}

const struct rc_figure *
rc_figures(const char *name)
{
    for (size_t k = 0; k < TABLES; k++)
        if (strcmp(tables[k].name, name) == 0)
            return tables[k].figure;
    return NULL;
}

const struct rc_figure *
rc_figure_find(const char *name)
{
    for (size_t k = 0; k < TABLES; k++)
        for (const struct rc_figure *f = tables[k].figure; f->name != NULL; f++)
            if (strcmp(f->name, name) == 0)
                return f;
    return NULL;
}

/* rc_elastic_result and the others: the figures of the first model of a chain that has them. */
#define RESULT(name, table)                                                                        \
    const struct name##_figures *name##_result(const struct rc_model *m)                           \
    {                                                                                              \
        return rc_model_result(m, table);                                                          \
    }
RESULT(rc_elastic, rc_figures_elastic)
RESULT(rc_yield, rc_figures_yield)
RESULT(rc_friction, rc_figures_friction)
RESULT(rc_rolling, rc_figures_rolling)
RESULT(rc_wear, rc_figures_wear)
RESULT(rc_travel, rc_figures_travel)
RESULT(rc_sliding, rc_figures_sliding)
RESULT(rc_viscoelastic, rc_figures_viscoelastic)
