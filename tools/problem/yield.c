/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * --yield: the yield law of body 1, the options that exclude it, and its slabs.
 */
#include "yield.h"

#include <math.h>
#include <string.h>

const struct opt yield_option[] = {
    {.name = "yield",
     .type = OPT_TEXT,
     .result = true,
     .arg = "Y[,HM]|FILE",
     .help = "yield stress of body 1 (in its volume), and its increase per plastic strain, HM"},
    {.name = NULL},
};

static const struct wanted_column columns[] = {
    {.names = "strain plasticstrain equivalentplasticstrain", .unit = UNIT_NONE},
    {.names = "stress yieldstress flowstress", .unit = UNIT_PA},
};

/* Checks point n of the table against the point before it. */
static enum rc_status
check_point(const double *strain, const double *stress, size_t n, struct rc_err *err)
{
    if (n == 0 && strain[n] != 0)
        return rc_err_set(err, "plastic strain %g: the table must begin at 0", strain[n]);
    if (n > 0 && !(strain[n] > strain[n - 1]))
        return rc_err_set(
            err, "plastic strain %g: it must be above %g, the strain of the previous point",
            strain[n], strain[n - 1]);
    if (!(stress[n] > 0))
        return rc_err_set(err, "stress %g Pa: it must be above 0", stress[n]);
    if (n > 0 && stress[n] < stress[n - 1])
        return rc_err_set(
            err, "stress %g Pa: it must not be below %g Pa, the stress of the previous point",
            stress[n], stress[n - 1]);
    return RC_OK;
}

static enum rc_status
read_table(struct yield_law *y, const char *name, struct rc_err *err)
{
    struct columns *c = &y->table;
    struct rc_err point;

    if (columns_read(c, name, columns, sizeof columns / sizeof *columns, false, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < c->n; k++)
        if (check_point(c->v[0], c->v[1], k, &point) != RC_OK)
            return rc_err_set(err, "line %zu: %s", c->line[k], point.text);
    y->law = (struct rc_yield_law){.points = c->n, .strain_at = c->v[0], .stress_at = c->v[1]};
    return RC_OK;
}

enum rc_status
yield_law_read(struct yield_law *y, const char *text, struct rc_err *err)
{
    size_t first = strcspn(text, ",");
    char stress[64];

    if (columns_file(text))
        return read_table(y, text, err);
    if (first >= sizeof stress)
        return rc_err_set(err, "it must be Y, or Y,Hm, as in 1GPa,2GPa, or a FILE with a table");
    memcpy(stress, text, first);
    stress[first] = '\0';
    if (unit_number(stress, UNIT_PA, &y->law.stress, err) != RC_OK)
        return RC_FAIL;
    if (text[first] == ',' && unit_number(text + first + 1, UNIT_PA, &y->law.modulus, err) != RC_OK)
        return RC_FAIL;
    if (!(y->law.stress > 0) || !(y->law.modulus >= 0))
        return rc_err_set(err, "the yield stress must be above 0, and hardening not below it");
    return RC_OK;
}

/* Warns of a yield stress outside the range from a millionth of the modulus to the modulus. */
static void
check_unit(struct tool *t, double stress, double estar)
{
    const double least = 1e-6;

    if (stress >= least * estar && stress <= estar)
        return;
    tool_usage(t, "--yield: the yield stress, %s, is %s, %s: is its unit right, as in 1GPa?",
               shown_in_unit(stress, "Pa"), stress > estar ? "above E*" : "below a millionth of E*",
               shown_in_unit(estar, "Pa"));
}

void
yield_law_check(struct tool *t, const struct yield_law *read, const struct physics *a)
{
    const struct rc_yield_law *law = &read->law;

    if (a->nu1 == 0.5)
        tool_usage(
            t, "--yield does not work with --nu1 0.5, because body 1 must be compressible: give "
               "a smaller --nu1");
    check_unit(t, rc_yield_law_stress(law, 0), a->surface_estar);
}

double
yield_law_hardening(const struct rc_yield_law *law)
{
    if (law->points == 0)
        return law->modulus;
    return law->points == 1
               ? 0
               : (law->stress_at[1] - law->stress_at[0]) / (law->strain_at[1] - law->strain_at[0]);
}
