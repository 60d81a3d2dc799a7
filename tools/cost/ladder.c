/*
 * The ladder, as data, in the order of the table.
 */
#include "cost.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* clang-format off */
static const struct row {
    const char *method, *kernel, *arithmetic;
    unsigned coarse;
    int from, to, step; /* tolerances 1e-from, ..., 1e-to */
} ladder[] = {
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
    ROWS = sizeof ladder / sizeof *ladder
};

const struct cost_rung cost_reference = {"pcg", "fft64", "double", 1, 1e-12};

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
wanted(const struct row *row, size_t kernels, size_t methods)
{
    return (kernels >> place(COST_KERNELS, row->kernel) & 1) &&
           (methods >> place(COST_METHODS, row->method) & 1);
}

struct cost *
cost_ladder(size_t kernels, size_t methods, size_t *n)
{
    struct cost *cost;
    size_t most = 0;

    for (size_t k = 0; k < ROWS; k++)
        most += (size_t)((ladder[k].to - ladder[k].from) / ladder[k].step + 1);
    cost = calloc(most, sizeof *cost);
    *n = 0;
    for (size_t k = 0; cost != NULL && k < ROWS; k++)
        for (int digits = ladder[k].from; digits <= ladder[k].to; digits += ladder[k].step)
            if (wanted(&ladder[k], kernels, methods))
                cost[(*n)++].rung = (struct cost_rung){.method = ladder[k].method,
                                                       .kernel = ladder[k].kernel,
                                                       .arithmetic = ladder[k].arithmetic,
                                                       .coarse = ladder[k].coarse,
                                                       .tol = 1 / pow(10, digits)};
    return cost;
}

const char *
cost_name(char text[128], const struct cost *c)
{
    snprintf(text, 128, "%s, %s, tol %.0e, %zu x %zu", c->rung.method, c->rung.kernel, c->rung.tol,
             c->shape.nx, c->shape.ny);
    return text;
}
