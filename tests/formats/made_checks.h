/* What every map that is read must be, whatever its file was; cmocka.h must come before. */
#ifndef MADE_CHECKS_H
#define MADE_CHECKS_H

#include <math.h>

#include "tests/exact.h"
#include "formats/core/core.h"

/* Steps of accuracy that files bring with them, relative. */
static const double last_digit = 4e-16;    /* a rounding or two of a double */
static const double float_rounding = 6e-8; /* one rounding to a float: 2^-24 */

/* Positive, finite spacings, no infinite value, and no more values than a file of that size may
 * have. */
__attribute__((unused)) static void
check_sound(const char *what, const struct rc_grid *g, size_t file_size)
{
    if (!(g->dx > 0) || !isfinite(g->dx) || !(g->dy > 0) || !isfinite(g->dy))
        fail_msg("%s: the spacing is %g, %g", what, g->dx, g->dy);
    if (8 * g->nx * g->ny > rc_memory_limit(file_size))
        fail_msg("%s: %zu x %zu out of %zu bytes", what, g->nx, g->ny, file_size);
    for (size_t k = 0; k < g->nx * g->ny; k++)
        if (isinf(g->v[k]))
            fail_msg("%s: an infinite height", what);
}

#endif
