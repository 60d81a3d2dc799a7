/*
 * What a channel is called, in which colours it is drawn, and from which value to which.
 */
#include "render.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SIGMA "\xcf\x83"

/* clang-format off */
static const struct channel channels[] = {
    {"mises", "von Mises stress", "magma", true},
    {"pressure", "Contact pressure", "magma", true},
    {"height", "Height", "viridis", false},
    {"gap", "Gap", "viridis", false},
    {"displacement", "Normal displacement", "viridis", false},
    {"plastic", "Height after unloading", "viridis", false},
    {"tresca", "Tresca stress", "magma", true},
    {"sxx", "Stress " SIGMA "xx", "bluered", false},
    {"syy", "Stress " SIGMA "yy", "bluered", false},
    {"szz", "Stress " SIGMA "zz", "bluered", false},
    {"sxy", "Stress " SIGMA "xy", "bluered", false},
    {"sxz", "Stress " SIGMA "xz", "bluered", false},
    {"syz", "Stress " SIGMA "yz", "bluered", false},
    {"s1", "Principal stress " SIGMA "1", "bluered", false},
    {"s2", "Principal stress " SIGMA "2", "bluered", false},
    {"s3", "Principal stress " SIGMA "3", "bluered", false},
};
/* clang-format on */

struct channel
channel_of(const struct rc_grid *g, const struct survey *s)
{
    for (size_t k = 0; k < sizeof channels / sizeof *channels; k++)
        if (strcmp(channels[k].name, g->channel) == 0)
            return channels[k];
    return (struct channel){.name = g->channel,
                            .title = g->channel,
                            .colormap = s->min < 0 && s->max > 0 ? "bluered" : "viridis"};
}

static enum unit
unit_of(const struct rc_grid *g)
{
    for (enum unit u = UNIT_M; u <= UNIT_PA; u++)
        if (strcmp(unit_name(u), g->unit) == 0)
            return u;
    return UNIT_NONE;
}

const char *
range_read(struct tool *t, const char *text, const struct rc_grid *g, double *lo, double *hi)
{
    static char si[2 * RC_NUMBER_SIZE + 2];
    char list[256], low[RC_NUMBER_SIZE], high[RC_NUMBER_SIZE];
    char *colon;
    struct numbers n = {0};
    struct rc_err err;

    snprintf(list, sizeof list, "%s", text);
    if ((colon = strchr(list, ':')) != NULL)
        *colon = ',';
    if (unit_numbers(list, unit_of(g), &n, &err) != RC_OK)
        tool_die(t, EXIT_USAGE, "--range %s: %s (channel %s is in %s)", text, err.text, g->channel,
                 g->unit);
    if (n.n != 2 || !(n.v[0] < n.v[1]))
        tool_die(t, EXIT_USAGE, "--range %s: it must be LO:HI, two values with LO below HI", text);
    *lo = n.v[0];
    *hi = n.v[1];
    free(n.v);
    snprintf(si, sizeof si, "%s:%s", rc_number_text(low, *lo), rc_number_text(high, *hi));
    return si;
}

void
range_choose(const struct rc_grid *g, const struct survey *s, const struct colormap *map,
             const struct channel *what, bool curve, double *lo, double *hi)
{
    double size = fmax(fabs(s->min), fabs(s->max)), margin;

    *lo = map->diverging ? -size : what->from_zero && s->min >= 0 ? 0 : s->min;
    *hi = map->diverging ? size : s->max;
    if (curve) {
        margin = 0.05 * s->max - 0.05 * s->min;
        *lo = what->from_zero && s->min >= 0 ? 0 : fmax(s->min - margin, -DBL_MAX);
        *hi = fmin(s->max + margin, DBL_MAX);
    }
    if (size < 1e-300) { /* zero everywhere: a nanometre about it, or one of what else it is */
        size = unit_of(g) == UNIT_M ? 1e-9 : 1;
        *lo = what->from_zero ? 0 : -size;
        *hi = size;
    } else if (0.5 * *hi - 0.5 * *lo <= 1e-12 * size) { /* constant, but for rounding */
        *lo = fmax(s->min - 0.1 * size, -DBL_MAX);
        *hi = fmin(s->max + 0.1 * size, DBL_MAX);
    }
}
