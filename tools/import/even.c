/* Resamples profiles to another step. */
#include "import.h"

#include <math.h>
#include <stdlib.h>

enum rc_status
import_even(const struct rc_file *file, const struct rc_wish *wish, struct rc_grid *g,
            struct rc_notes *notes, struct rc_err *err)
{
    enum rc_status status = RC_FAIL;
    double *x = NULL, *v = NULL;
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
    if ((x = malloc(g->nx * sizeof *x)) == NULL) {
        rc_err_set(err, "out of memory for %zu points", g->nx);
        goto done;
    }
    for (size_t k = 0; k < g->nx; k++)
        x[k] = g->dx * (double)k;
    if (rc_even_new(x, g->nx, 1, file, wish, &even, err) != RC_OK)
        goto done;
    if ((v = malloc(even.n * sizeof *v)) == NULL) {
        rc_err_set(err, "out of memory for %zu nodes", even.n);
        goto done;
    }
    rc_even_heights(&even, x, g->v, g->nx, v, notes);
    free(g->v);
    g->v = v;
    g->nx = even.n;
    g->dx = g->dy = wish->even_step;
    status = RC_OK;
done:
    free(x);
    return status;
}
