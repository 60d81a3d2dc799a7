/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Names of channels, and their colours.
 */
#include "render.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define SIGMA "\xcf\x83"

/* clang-format off */
static const struct channel channels[] = {
    {"mises", "von Mises stress", "magma", .from_zero = true},
    {"pressure", "Contact pressure", "magma", .from_zero = true, .none = "no contact"},
    {"adhesion", "Traction of adhesion", "magma", .from_zero = true},
    {"hardness", "Hardness", "viridis", .from_zero = true},
    {"height", "Height", "viridis", .from_zero = false},
    {"gap", "Gap", "viridis", .from_zero = true},
    {"displacement", "Normal displacement", "viridis", .from_zero = false},
    {"plastic", "Height after unloading", "viridis", .from_zero = false},
    {"residual", "Residual displacement", "bluered", .from_zero = false},
    {"peeq", "Equivalent plastic strain", "magma", .from_zero = true},
    {"fluid-pressure", "Fluid pressure", "viridis", .from_zero = true,
     .missing = "contact, or enclosed fluid"},
    {"flux", "Flow per width", "magma", .from_zero = true, .none = "stagnant fluid",
     .missing = "contact"},
    {"channel", "Flow channels", "viridis", .from_zero = true, .none = "contact",
     .is = {"stagnant fluid", "flowing fluid"}, .axis = "0 contact, 1 stagnant fluid, 2 flowing fluid"},
    {"contact", "Contact", "viridis", .from_zero = true, .none = "no contact", .is = {"contact"},
     .axis = "0 no contact, 1 contact"},
    {"traction-x", "Traction along x", "bluered", .none = "no traction"},
    {"traction-y", "Traction along y", "bluered", .none = "no traction"},
    {"traction", "Traction", "magma", .from_zero = true, .none = "no traction"},
    {"slip-x", "Slip along x", "bluered", .none = "no contact, or stick"},
    {"slip-y", "Slip along y", "bluered", .none = "no contact, or stick"},
    {"state", "Stick and slip", "viridis", .from_zero = true, .none = "no contact",
     .is = {"sticks", "slips"}, .axis = "0 no contact, 1 sticks, 2 slips"},
    {"psd", "Power spectral density", "magma", .from_zero = true},
    {"tresca", "Tresca stress", "magma", .from_zero = true},
    {"sxx", "Stress " SIGMA "xx", "bluered", .from_zero = false},
    {"syy", "Stress " SIGMA "yy", "bluered", .from_zero = false},
    {"szz", "Stress " SIGMA "zz", "bluered", .from_zero = false},
    {"sxy", "Stress " SIGMA "xy", "bluered", .from_zero = false},
    {"sxz", "Stress " SIGMA "xz", "bluered", .from_zero = false},
    {"syz", "Stress " SIGMA "yz", "bluered", .from_zero = false},
    {"s1", "Principal stress " SIGMA "1", "bluered", .from_zero = false},
    {"s2", "Principal stress " SIGMA "2", "bluered", .from_zero = false},
    {"s3", "Principal stress " SIGMA "3", "bluered", .from_zero = false},
    {"temperature-1", "Temperature of body 1", "magma", .from_zero = true},
    {"temperature-2", "Temperature of body 2", "magma", .from_zero = true},
    {"crossland", "Index of Crossland", "magma", .from_zero = true},
    {"dangvan", "Index of Dang Van", "magma", .from_zero = true},
    {"papadopoulos", "Index of Papadopoulos", "magma", .from_zero = true},
    {"findley", "Index of Findley", "magma", .from_zero = true},
    {"shakedown", "Index of shakedown", "magma", .from_zero = true},
    {"amplitude", "Amplitude of the shear stress", "magma", .from_zero = true},
};
/* clang-format on */

/* A channel counts as one-sided if the values beyond 0 are at most this fraction of the largest magnitude. */
#define ONE_SIDED 1e-3

/* True for the difference of two measurements: rc-add --align writes keys, and the history has the command.
 * The history of its second file stands in parentheses. */
static bool
is_change(const struct rc_grid *g)
{
    const char *step = rc_grid_get(g, "history"), *end, *option;
    bool is = rc_grid_get(g, "align.shift_x") != NULL;

    for (; step != NULL; step = *end == '\0' ? NULL : end + 3) {
        if ((end = strstr(step, " | ")) == NULL)
            end = step + strlen(step);
        if (strncmp(step, "rc-add ", 7) != 0)
            continue;
        option = strstr(step, " --subtract ");
        is = option != NULL && option < end && option < step + strcspn(step, "(");
    }
    return is;
}

struct channel
channel_of(const struct rc_grid *g, const struct survey *s)
{
    double size = fmax(fabs(s->min), fabs(s->max));
    bool both = fmin(-s->min, s->max) > ONE_SIDED * size;

    for (size_t k = 0; k < sizeof channels / sizeof *channels; k++) {
        struct channel c = channels[k];

        if (strcmp(c.name, g->channel) != 0)
            continue;
        if (strcmp(c.colormap, "bluered") == 0 && !both && size > 0) {
            c.colormap = "magma"; /* diverging colours are for values on both sides of 0 */
            c.from_zero = s->max >= -s->min;
            c.to_zero = !c.from_zero;
        } else if (strcmp(c.name, "height") == 0 && is_change(g)) {
            c.title = "Change of height";
        } else if (strcmp(c.name, "pressure") == 0 && both) {
            c.title = "Net pressure"; /* of bodies that attract each other */
            c.sign = "tension negative";
            c.colormap = "bluered";
            c.from_zero = false;
            c.none = "no net pressure";
        }
        return c;
    }
    return (struct channel){
        .name = g->channel, .title = g->channel, .colormap = both ? "bluered" : "viridis"};
}

const char *
channel_title(const struct channel *c, const char *words, char text[CHANNEL_TITLE])
{
    snprintf(text, CHANNEL_TITLE, "%.80s%s%.80s%s%s%s", c->title, *words == '\0' ? "" : " ", words,
             c->sign == NULL ? "" : " (", c->sign == NULL ? "" : c->sign,
             c->sign == NULL ? "" : ")");
    return text;
}
