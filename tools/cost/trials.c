/*
 * The trials, in the order in which the table shows them.
 */
#include "cost.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* clang-format off */
static const struct series {
    const char *method, *kernel, *arithmetic;
    unsigned coarse;
    int from, to, step; /* tolerances 1e-from, ..., 1e-to */
} series[] = {
    {"pcg", "fft", "mixed", 8, 2, 2, 1}, /* what these grids leave out hides more */
    {"pcg", "fft", "mixed", 4, 2, 2, 1},
    {"pcg", "fft", "mixed", 2, 2, 3, 1},
    {"pcg", "fft", "mixed", 1, 2, 10, 1},
    {"pcg", "fft64", "double", 1, 2, 10, 2},
    {"pcg", "mlms", "double", 1, 2, 10, 2}, /* its order rises with the accuracy */
    {"pcg", "direct", "double", 1, 2, 10, 4},
    {"pk99", "fft", "double", 1, 2, 8, 2},
    {"pk99", "mlms", "double", 1, 2, 4, 2},
};
/* clang-format on */

enum {
    SERIES = sizeof series / sizeof *series
};

const struct cost_settings cost_reference = {"pcg", "fft64", "double", 1, 1e-12};

/* Place of a word among words separated by '|'. */
static size_t
place(const char *words, const char *word)
{
    size_t k = 0;

    for (size_t n; *words != '\0'; words += n + (words[n] == '|'), k++) {
        n = strcspn(words, "|");
        if (strlen(word) == n && strncmp(words, word, n) == 0)
            break;
    }
    return k;
}

static bool
wanted(const struct series *s, size_t kernels, size_t methods)
{
    return (kernels >> place(COST_KERNELS, s->kernel) & 1) &&
           (methods >> place(COST_METHODS, s->method) & 1);
}

struct cost_trial *
cost_trials(size_t kernels, size_t methods, size_t *n)
{
    struct cost_trial *trial;
    size_t most = 0;

    for (size_t k = 0; k < SERIES; k++)
        most += (size_t)((series[k].to - series[k].from) / series[k].step + 1);
    trial = calloc(most, sizeof *trial);
    *n = 0;
    for (size_t k = 0; trial != NULL && k < SERIES; k++)
        for (int digits = series[k].from; digits <= series[k].to; digits += series[k].step)
            if (wanted(&series[k], kernels, methods))
                trial[(*n)++].settings = (struct cost_settings){.method = series[k].method,
                                                                .kernel = series[k].kernel,
                                                                .arithmetic = series[k].arithmetic,
                                                                .coarse = series[k].coarse,
                                                                .tol = 1 / pow(10, digits)};
    return trial;
}

const char *
cost_name(char text[128], const struct cost_trial *c)
{
    snprintf(text, 128, "%s, %s, tol %.0e, %zu x %zu", c->settings.method, c->settings.kernel,
             c->settings.tol, c->shape.nx, c->shape.ny);
    return text;
}
