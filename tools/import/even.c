/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Resamples profiles to another step. */
#include "import.h"

#include <math.h>
#include <stdlib.h>

enum rc_status
import_even(const struct rc_file *file, const struct rc_wish *wish, struct rc_grid *g,
            struct rc_notes *notes, struct rc_err *err)
{
    RC_OWNED double *x = NULL;
    double *v;
    struct rc_even even;

    if (g->ny > 1)
        return rc_err_set(err, "--even STEP resamples profiles, and this is a map of %zu rows",
                          g->ny);
    if (g->nx < 2)
        return rc_err_set(err, "--even STEP resamples profiles, and this is a single point");
    if (fabs(g->dx - wish->even_step) <= 1e-9 * wish->even_step) { /* the reader already did it */
        g->dx = g->dy = wish->even_step;
        return RC_OK;
    }
    if ((x = malloc(g->nx * sizeof *x)) == NULL)
        return rc_err_set(err, "out of memory for %zu points", g->nx);
    for (size_t k = 0; k < g->nx; k++)
        x[k] = g->dx * (double)k;
    if (rc_even_new(x, g->nx, 1, file, wish, &even, err) != RC_OK)
        return RC_FAIL;
    if ((v = malloc(even.n * sizeof *v)) == NULL)
        return rc_err_set(err, "out of memory for %zu nodes", even.n);
    rc_even_heights(&even, x, g->v, g->nx, v, notes);
    free(g->v);
    g->v = v;
    g->nx = even.n;
    g->dx = g->dy = wish->even_step;
    return RC_OK;
}
