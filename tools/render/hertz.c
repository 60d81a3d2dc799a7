/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Hertz's contact of a smooth sphere or of a long cylinder beside the map.
 */
#include "render.h"

#include <math.h>
#include <string.h>

/* Warns if the pressure of a map is not about its middle, where Hertz's contact is: the map may be a part of
 * the solved one. */
static void
warn_of_centre(struct tool *t, const struct rc_grid *g, const struct hertz_contact *h)
{
    const double near = 0.25; /* of the radius */
    double sum = 0, x = 0, y = 0, away;

    if (strcmp(g->channel, "pressure") != 0)
        return;
    for (size_t k = 0; k < rc_grid_nodes(g); k++)
        if (isfinite(g->v[k])) {
            sum += g->v[k];
            x += g->v[k] * ((double)(k % g->nx) - 0.5 * (double)(g->nx - 1)) * g->dx;
            y += g->v[k] * ((double)(k / g->nx) - 0.5 * (double)(g->ny - 1)) * g->dy;
        }
    away = h->across == 'x' ? fabs(x) : h->across == 'y' ? fabs(y) : hypot(x, y);
    if (sum > 0 && away > near * h->half * sum)
        tool_warn(t,
                  "%s: the %s of Hertz is about the middle of the map, but the centre of the "
                  "pressure is %s away from it",
                  tool_where(t, g), h->across == '\0' ? "circle" : "strip",
                  scale_value(away / sum, "m"));
}

static double
modulus_of(struct tool *t, const struct rc_grid *g, const struct law_given *given)
{
    double estar = given->estar;

    if (isnan(estar))
        bodies_demand_elastic(t, g, "give the modulus of this time with --estar");
    return isnan(estar) && !rc_grid_number(g, "estar", &estar) ? 0 : estar;
}

/* The radius behind a word of the key form; 0: it names another shape. */
static double
radius_of(const char *form, const char *word)
{
    const size_t n = strlen(word);
    struct rc_err err;
    double r;

    return form != NULL && strncmp(form, word, n) == 0 &&
                   unit_number(form + n, UNIT_M, &r, &err) == RC_OK
               ? r
               : 0;
}

/* A cylinder of radius R under the load W' for each metre touches a strip of half width a,
 * a^2 = 4 W' R / (pi E*), p0 = 2 W' / (pi a) (Johnson 1985, eqs. 4.43 and 4.45). The key load is that of one
 * period of the axis. */
static void
read_strip(struct tool *t, const struct rc_grid *g, const struct law_given *given, double r,
           struct hertz_contact *h)
{
    const struct rc_boundary repeats = map_boundary(g);
    const char *form = rc_grid_get(g, "form");
    const double estar = modulus_of(t, g, given);
    double load, period;

    if (rc_repeats(repeats) != 1)
        tool_refuse(t, g,
                    "--hertz draws a cylinder (form=%s) whose axis repeats alone, but its boundary "
                    "is %s: solve with --periodic=y, or leave out --hertz",
                    form, rc_boundary_word(repeats));
    if (!(estar > 0) || !rc_grid_number(g, "load", &load) || !(load > 0))
        tool_refuse(t, g,
                    "--hertz of a cylinder needs the keys load and estar: give the modulus with "
                    "--estar, or leave out --hertz");
    h->across = repeats.y ? 'x' : 'y';
    period = repeats.y ? (double)g->ny * g->dy : (double)g->nx * g->dx;
    h->half = sqrt(4 * load / period * r / (FIGURE_PI * estar));
    h->peak = 2 * load / period / (FIGURE_PI * h->half);
    snprintf(h->text, sizeof h->text, "Hertz, half width %s", scale_value(h->half, "m"));
}

/* A sphere of radius R touches a disc, a^3 = 3 F R / (4 E*), p0 = 3 F / (2 pi a^2) (Hertz 1882). */
static void
read_circle(struct tool *t, const struct rc_grid *g, const struct law_given *given,
            struct hertz_contact *h)
{
    const double estar = modulus_of(t, g, given);
    const double r =
        isnan(given->radius) ? radius_of(rc_grid_get(g, "form"), "sphere ") : given->radius;
    double load;

    if (!(r > 0) || !(estar > 0) || !rc_grid_number(g, "load", &load) || !(load > 0))
        tool_refuse(t, g,
                    "--hertz needs the keys load, estar and form=sphere RADIUS: give what is "
                    "missing with --estar and --radius, or leave out --hertz; an elliptic contact "
                    "has no such circle, so there --radius does not help");
    h->across = '\0';
    h->half = cbrt(0.75 * load * r / estar);
    h->peak = 1.5 * load / (FIGURE_PI * h->half * h->half);
    snprintf(h->text, sizeof h->text, "Hertz, radius %s", scale_value(h->half, "m"));
}

void
hertz_read(struct tool *t, const struct rc_grid *g, const struct law_given *given,
           struct hertz_contact *h)
{
    const char *form = rc_grid_get(g, "form");
    const double cylinder = radius_of(form, "cylinder ");

    if (rc_grid_get(g, "section") != NULL)
        tool_refuse(t, g, "--hertz is a circle or a strip on a map, and this is a section");
    if (!isnan(given->radius) &&
        (cylinder > 0 || (form == NULL && rc_repeats(map_boundary(g)) == 1)))
        tool_refuse(t, g,
                    "--radius is that of a sphere, but this is the contact of a cylinder "
                    "(%s%s): leave out --radius",
                    cylinder > 0 ? "form=" : "boundary=",
                    cylinder > 0 ? form : rc_boundary_word(map_boundary(g)));
    if (cylinder > 0)
        read_strip(t, g, given, cylinder, h);
    else
        read_circle(t, g, given, h);
    warn_of_centre(t, g, h);
}

double
hertz_pressure_at(const struct hertz_contact *h, double x, double y)
{
    const double r = h->across == 'x' ? x : h->across == 'y' ? y : hypot(x, y);

    return h->peak * sqrt(fmax(0, 1 - r * r / (h->half * h->half)));
}
