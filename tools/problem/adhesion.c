/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * --adhesion: work, law and range of the attraction between the bodies.
 */
#include "adhesion.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

const struct opt adhesion_option[] = {
    {.name = "adhesion",
     .type = OPT_TEXT,
     .result = true,
     .arg = "WORK[,LAW[,RANGE]]",
     .help = "the bodies attract each other: 50mJ/m2, 50mJ/m2,exponential,2nm; a list is a path"},
    {.name = NULL},
};

static bool
is_law(const char *text, size_t n)
{
    const struct rc_adhesion_law_info *law;

    for (size_t k = 0; (law = rc_adhesion_law_info(k)) != NULL; k++)
        if (strlen(law->name) == n && memcmp(law->name, text, n) == 0)
            return true;
    return false;
}

static void
list_laws(char *text, size_t size)
{
    const struct rc_adhesion_law_info *law;
    size_t n = 0;

    text[0] = '\0';
    for (size_t k = 0; (law = rc_adhesion_law_info(k)) != NULL && n < size; k++)
        n += (size_t)snprintf(text + n, size - n, "%s%s", k == 0 ? "" : ", ", law->name);
}

/* What a name that is no law probably means; an empty text: not known. */
static const char *
hint(const char *name)
{
    if (strcasecmp(name, "dmt") == 0)
        return ": DMT is the limit of a range that is long against the deformation: take "
               "exponential with such a range";
    if (strcasecmp(name, "maugis") == 0 || strcasecmp(name, "maugis-dugdale") == 0)
        return ": Maugis' law is dugdale";
    return "";
}

enum rc_status
adhesion_law_read(struct adhesion_law *a, const char *text, struct rc_err *err)
{
    char part[3][64] = {"", "", ""}, laws[128];
    size_t n = 0;

    for (const char *at = text; n < 3; at += strcspn(at, ",") + 1, n++) {
        size_t length = strcspn(at, ",");
        if (length >= sizeof part[n])
            return rc_err_set(err, "it must be WORK,LAW,RANGE, as in 50mJ/m2,exponential,2nm");
        memcpy(part[n], at, length);
        part[n][length] = '\0';
        if (at[length] == '\0')
            break;
        if (n == 2)
            return rc_err_set(err, "it must be WORK,LAW,RANGE, as in 50mJ/m2,exponential,2nm");
    }
    if (unit_number(part[0], UNIT_WORK, &a->problem.work, err) != RC_OK)
        return RC_FAIL;
    if (!(a->problem.work > 0))
        return rc_err_set(err, "the work of adhesion must be above 0: for bodies without "
                               "attraction leave out --adhesion");
    list_laws(laws, sizeof laws);
    if (n >= 1 && !is_law(part[1], strlen(part[1]))) {
        const struct rc_adhesion_law_info *law;
        for (size_t k = 0; (law = rc_adhesion_law_info(k)) != NULL; k++)
            if (strcasecmp(law->name, part[1]) == 0)
                return rc_err_set(err, "there is no law '%s': write %s", part[1], law->name);
        return rc_err_set(err, "there is no law '%s': it must be one of %s%s", part[1], laws,
                          hint(part[1]));
    }
    snprintf(a->name, sizeof a->name, "%s", part[1]);
    a->problem.law = n >= 1 ? a->name : NULL;
    if (n < 2)
        return RC_OK;
    if (unit_number(part[2], UNIT_M, &a->problem.range, err) != RC_OK)
        return RC_FAIL;
    if (!(a->problem.range > 0))
        return rc_err_set(err, "the range must be above 0; without a range the tool takes the "
                               "shortest one that the grid resolves");
    return RC_OK;
}

/* To three digits, as advice needs no more. */
static double
rounded(double v)
{
    const double digit = pow(10, floor(log10(v)) - 2);

    return round(v / digit) * digit;
}

bool
adhesion_resolved(const struct rc_adhesion_scales *scales, struct rc_boundary boundary,
                  double spacing, struct adhesion_grid *need)
{
    const double least = 1.5, enough = 2,          /* nodes in the cohesive length */
        times = rc_repeats(boundary) == 1 ? 2 : 1; /* whole lines of nodes separate at once */

    /* at constant work the cohesive length grows with the square of the range */
    *need = (struct adhesion_grid){
        .spacing = rounded(spacing * scales->cohesive_nodes / (times * enough)),
        .range = rounded(scales->range * sqrt(times * enough / scales->cohesive_nodes)),
    };
    return scales->cohesive_nodes >= times * least;
}
