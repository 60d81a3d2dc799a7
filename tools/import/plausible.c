/* Sizes that hardly any surface has: most often a unit that is not the one its file should have. */
#include "import.h"

#include <math.h>
#include <string.h>

static const double longest = 1, shortest = 10e-9; /* m, of a side */

/* Largest less least height. */
static double
span_of(const struct rc_grid *g)
{
    double least = INFINITY, most = -INFINITY;

    for (size_t k = 0; k < g->nx * g->ny; k++) {
        least = fmin(least, g->v[k]);
        most = fmax(most, g->v[k]);
    }
    return most - least;
}

void
import_judge(struct tool *t, const struct rc_grid *g, const struct rc_wish *wish)
{
    double x = (double)g->nx * g->dx, y = g->ny > 1 ? (double)g->ny * g->dy : x;
    double span = strcmp(g->unit, "m") == 0 ? span_of(g) : 0;
    char by[32] = " long";

    if (g->ny > 1)
        snprintf(by, sizeof by, " by %.4g m", y);
    if (isnan(wish->dx) && (fmax(x, y) > longest || fmin(x, y) < shortest))
        tool_warn(t,
                  "%s: the %s is %.4g m%s, which is implausible: if the file means another unit, "
                  "--dx%s the spacing",
                  t->source, g->ny > 1 ? "map" : "profile", x, by,
                  g->ny > 1 ? " and --dy give" : " gives");
    if (isnan(wish->z_unit) && span > fmax(x, y))
        tool_warn(
            t,
            "%s: the heights span %.4g m, more than the %.4g m of the longer side, which is "
            "implausible: if the file means another unit, --z-unit gives that of the heights, "
            "--dx the spacing",
            t->source, span, fmax(x, y));
}
