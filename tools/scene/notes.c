/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Warnings of effects that no tool computes. */
#include "scene.h"

/* The least thickness of a film under a ball: Hamrock and Dowson 1977 (J. Lubr. Technol. 99, 264), and 1978
 * (J. Lubr. Technol. 100, 236) for soft bodies. One surface slides, so that it carries the fluid with half
 * the speed, or both roll and carry it with theirs. The modulus of these papers is 2 E*, and the ball has
 * the ellipticity 1. */
static double
film_of(const struct scene_args *a, const struct scene_notes *n)
{
    const double modulus = 2 * n->estar, r = n->radius,
                 u = a->viscosity * n->entrains / (modulus * r),
                 w = n->contact->load / (modulus * r * r);

    return isnan(a->piezo) ? 7.43 * r * pow(u, 0.65) * pow(w, -0.21) * (1 - 0.85 * exp(-0.31))
                           : 3.63 * r * pow(u, 0.68) * pow(a->piezo * modulus, 0.49) *
                                 pow(w, -0.073) * (1 - exp(-0.68));
}

/* RMS of the heights without the ball. */
static double
roughness_of(const struct rc_grid *g, double radius)
{
    const size_t n = rc_grid_nodes(g);
    double sum = 0, square = 0;

    for (size_t k = 0; k < n; k++) {
        const double x = ((double)(k % g->nx) - (double)(g->nx - 1) / 2) * g->dx,
                     y = ((double)(k / g->nx) - (double)(g->ny - 1) / 2) * g->dy,
                     r2 = x * x + y * y,
                     h = g->v[k] + r2 / (radius + sqrt(fmax(radius * radius - r2, 0)));
        sum += h;
        square += h * h;
    }
    return sqrt(fmax(square / (double)n - sum / (double)n * (sum / (double)n), 0));
}

void
scene_notes(struct tool *t, const struct rc_grid *g, const struct scene_args *a,
            const struct scene_notes *n)
{
    const char *where = tool_where(t, g);

    if (!isnan(a->viscosity) && !isnan(n->radius)) {
        const double film = film_of(a, n), over = film / roughness_of(g, n->radius);
        if (over > 1)
            tool_warn(t,
                      "%s: a film of the fluid may carry load: it is %s thick, %.2g times the RMS "
                      "roughness (Hamrock and Dowson 1977, 1978), and no tool computes it",
                      where, shown_in_unit(film, "m"), over);
    }
    if (!isnan(a->expansion) && n->pair->one.e > 0) {
        /* Barber 1969, Proc. R. Soc. A 312, 381: expansion over elastic curvature */
        const double part = a->mu * n->slides * n->estar * a->expansion * (1 + n->pair->one.nu) /
                            n->conductivity * sqrt(n->contact->contact_area / acos(-1)) / 2;
        if (part > n->within)
            tool_warn(t,
                      "%s: thermal expansion may change the contact: it is %.2g %% of the elastic "
                      "displacement (Barber 1969), and no tool computes it",
                      where, 100 * part);
    }
    if (a->noise > n->within * n->contact->approach)
        tool_warn(
            t,
            "%s: the noise of the scan is %.2g %% of the approach: 'rc-cost --noise' computes "
            "its effect",
            where, 100 * a->noise / n->contact->approach);
}
