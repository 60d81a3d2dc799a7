#include "values.h"

#include <math.h>

void
rc_values_flip(struct rc_grid *g)
{
    for (size_t j = 0; j < g->ny / 2; j++)
        for (size_t i = 0; i < g->nx; i++) {
            double *a = &g->v[j * g->nx + i], *b = &g->v[(g->ny - 1 - j) * g->nx + i], kept = *a;
            *a = *b;
            *b = kept;
        }
}

enum rc_status
rc_values_finite(const struct rc_grid *g, struct rc_err *err)
{
    for (size_t k = 0; k < g->nx * g->ny; k++)
        if (isinf(g->v[k]))
            return rc_err_set(err, "the height at column %zu, row %zu (from 0) is infinite",
                              k % g->nx, k / g->nx);
    return RC_OK;
}
