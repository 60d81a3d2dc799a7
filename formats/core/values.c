#include "values.h"

#include <math.h>
#include <stdint.h>

enum {
    TIMES_FILE = 16,
    MEMORY_LEAST = 64 << 20,
};

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

size_t
rc_memory_bound(const struct rc_file *file)
{
    return file->size > SIZE_MAX / TIMES_FILE / 2 ? SIZE_MAX / 2
                                                  : TIMES_FILE * file->size + MEMORY_LEAST;
}

enum rc_status
rc_map_fits(const struct rc_file *file, size_t nx, size_t ny, struct rc_err *err)
{
    size_t n, bytes;

    if (rc_size_mul(nx, ny, &n, err) != RC_OK ||
        rc_size_mul(n, sizeof(double), &bytes, err) != RC_OK)
        return RC_FAIL;
    if (bytes > rc_memory_bound(file))
        return rc_err_set(err,
                          "%zu x %zu values need %zu MiB, more than the %zu that a file of %zu "
                          "bytes may take",
                          nx, ny, bytes >> 20, rc_memory_bound(file) >> 20, file->size);
    return RC_OK;
}
