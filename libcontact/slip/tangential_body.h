/*
 * Waves of both maps multiplied by the spectra of shear, in one precision: REAL and OPS are set by the
 * file that includes this.
 */
#include <string.h>

#include "tangential.h"

RC_CLONES static void
apply(const struct rc_shear_column *column, const void *a_of, const void *b_of)
{
    const REAL *a = a_of, *b = b_of, *x = column->x, *y = column->y;
    REAL *to = column->to;
    size_t n = column->n;

    for (size_t k = 0; k < n; k++) {
        REAL straight = a[column->wave[k]];
        REAL cross = -(REAL)column->mirror[k] * b[column->wave[k]];
        to[k] = straight * x[k] + cross * y[k];
        to[n + k] = straight * x[n + k] + cross * y[n + k];
    }
}

RC_CLONES static void
inverse(const struct rc_shear_column *column, const void *a_of, const void *b_of, const void *c_of)
{
    const REAL *a = a_of, *b = b_of, *c = c_of, *x = column->x, *y = column->y;
    REAL *to = column->to;
    size_t n = column->n;

    for (size_t k = 0; k < n; k++) {
        size_t w = column->wave[k];
        REAL determinant = a[w] * c[w] - b[w] * b[w];
        REAL over = determinant > 0 ? 1 / determinant : 0; /* nothing stands against the mean */
        REAL straight = c[w] * over, cross = (REAL)column->mirror[k] * b[w] * over;
        to[k] = straight * x[k] + cross * y[k];
        to[n + k] = straight * x[n + k] + cross * y[n + k];
    }
}

static bool
row(const void *from, size_t n, void *to)
{
    const REAL *v = from;

    for (size_t i = 0; i < n; i++)
        if (v[i] != 0) {
            memcpy(to, from, n * sizeof *v);
            return true;
        }
    return false;
}

const struct rc_shear_ops OPS = {apply, inverse, row};
