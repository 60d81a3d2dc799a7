/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Published laws of contact that a figure can show beside its points.
 *
 * Hertz: an elastic sphere of radius R on a half-space. K. L. Johnson, Contact Mechanics (1985), eqs. 4.22 to
 * 4.24: a^3 = 3 F R / (4 E*), approach = a^2 / R, p0 = 3 F / (2 pi a^2). The stiffness dF / d approach is 2
 * E* a (Pharr, Oliver and Brotzen 1992). Each quantity is a power of the load.
 *
 * Persson: a rough half-space under the mean pressure p. Its pressures have the variance s^2 = (E* h')^2 / 4,
 * h' the RMS gradient of the height. B. N. J. Persson, J. Chem. Phys. 115 (2001) 3840; closed form by W.
 * Manners and J. A. Greenwood, Wear 261 (2006) 600: the contact fraction is erf(p / (sqrt(2) s)). The density
 * of the pressure is the difference of two normal distributions about p and -p.
 */
#include "render.h"

#include <math.h>
#include <string.h>

/* ---- Hertz ---- */

struct power {
    const char *name;
    double factor, exponent; /* quantity = factor F^exponent */
};

enum {
    HERTZ = 7
};

static void
hertz_powers(const struct law_given *g, struct power power[HERTZ])
{
    double a = cbrt(3 * g->radius / (4 * g->estar)); /* contact radius: a F^(1/3) */

    power[0] = (struct power){"load", 1, 1};
    power[1] = (struct power){"mean_pressure", 1 / g->area, 1};
    power[2] = (struct power){"approach", a * a / g->radius, 2.0 / 3};
    power[3] = (struct power){"contact_area", FIGURE_PI * a * a, 2.0 / 3};
    power[4] = (struct power){"contact_fraction", FIGURE_PI * a * a / g->area, 2.0 / 3};
    power[5] = (struct power){"max_pressure", 1.5 / (FIGURE_PI * a * a), 1.0 / 3};
    power[6] = (struct power){"stiffness", 2 * g->estar * a, 1.0 / 3};
}

static const struct power *
find_power(const struct power power[HERTZ], const char *name)
{
    for (size_t k = 0; k < HERTZ; k++)
        if (strcmp(power[k].name, name) == 0)
            return &power[k];
    return NULL;
}

static double
hertz(const struct law_given *g, const char *x, double value, const char *y)
{
    struct power power[HERTZ];
    const struct power *from, *to;

    hertz_powers(g, power);
    from = find_power(power, x);
    to = find_power(power, y);
    if (from == NULL || to == NULL || value < 0)
        return NAN;
    return to->factor * pow(value / from->factor, to->exponent / from->exponent);
}

/* ---- Persson ---- */

static double
deviation(const struct law_given *g)
{
    return 0.5 * g->estar * g->rms_slope;
}

static double
persson(const struct law_given *g, const char *x, double value, const char *y)
{
    double pressure = strcmp(x, "load") == 0 ? value / g->area : value;
    double fraction = erf(pressure / (sqrt(2) * deviation(g)));

    return strcmp(y, "contact_area") == 0 ? fraction * g->area : fraction;
}

double
law_pressure_density(const struct law_given *g, double mean, double p)
{
    double s = deviation(g), a = (p - mean) / s, b = (p + mean) / s;

    return (exp(-0.5 * a * a) - exp(-0.5 * b * b)) / (s * sqrt(2 * FIGURE_PI));
}

/* ---- the table ---- */

static const struct law laws[] = {
    {"hertz", "Hertz (Johnson 1985, eqs. 4.22 to 4.24)",
     " load mean_pressure approach contact_area contact_fraction max_pressure stiffness ",
     " load mean_pressure approach contact_area contact_fraction max_pressure stiffness ",
     "any of load, mean_pressure, approach, contact_area, contact_fraction, max_pressure, "
     "stiffness over another",
     true, false, hertz},
    {"persson", "Persson (J. Chem. Phys. 115, 2001, 3840)", " load mean_pressure ",
     " contact_fraction contact_area ",
     "contact_fraction or contact_area over load or mean_pressure", false, true, persson},
};

const char *
law_word(size_t k)
{
    return k < sizeof laws / sizeof *laws ? laws[k].name : NULL;
}

const struct law *
law_named(const char *name)
{
    for (size_t k = 0; k < sizeof laws / sizeof *laws; k++)
        if (strcmp(laws[k].name, name) == 0)
            return &laws[k];
    return NULL;
}

const char *
law_lacks(const char *name, const struct law_given *g)
{
    const struct law *law = law_named(name);

    if (!(g->estar > 0))
        return "--estar";
    if (law->radius && !(g->radius > 0))
        return "--radius";
    return law->rms_slope && !(g->rms_slope > 0) ? "--rms-slope" : NULL;
}

static bool
is_one_of(const char *names, const char *name)
{
    size_t n = strlen(name);

    for (const char *s = names; (s = strstr(s, name)) != NULL; s += n)
        if (s[-1] == ' ' && s[n] == ' ')
            return true;
    return false;
}

bool
law_knows(const char *name, const char *x, const char *y)
{
    const struct law *law = law_named(name);

    return is_one_of(law->x, x) && is_one_of(law->y, y);
}

double
law_value(const char *name, const struct law_given *g, const char *x, double value, const char *y)
{
    return law_knows(name, x, y) ? law_named(name)->value(g, x, value, y) : NAN;
}

bool
law_needs_area(const char *name, const struct law_given *given, const char *x, const char *y)
{
    struct law_given one = *given, two = *given;

    one.area = 1;
    two.area = 2;
    return law_value(name, &one, x, 0.1, y) != law_value(name, &two, x, 0.1, y);
}
