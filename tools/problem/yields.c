/*
 * --yield: the yield law of body 1, the options that exclude it, and its slabs.
 */
#include "yields.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* True if the word cannot begin a number; "nan" counts as a word. */
static bool
is_word(const char *text)
{
    char *end;

    (void)strtod(text, &end);
    return end == text;
}

/* Checks a point of the table against the points before it. */
static enum rc_status
check_point(const struct yield_law *y, size_t n, double strain, double stress, struct rc_err *err)
{
    if (n == 0 && strain != 0)
        return rc_err_set(err, "plastic strain %g: the table must begin at 0", strain);
    if (n > 0 && !(strain > y->table[0][n - 1]))
        return rc_err_set(
            err, "plastic strain %g: it must be above %g, the strain of the previous point", strain,
            y->table[0][n - 1]);
    if (!(stress > 0))
        return rc_err_set(err, "stress %g Pa: it must be above 0", stress);
    if (n > 0 && stress < y->table[1][n - 1])
        return rc_err_set(
            err, "stress %g Pa: it must not be below %g Pa, the stress of the previous point",
            stress, y->table[1][n - 1]);
    return RC_OK;
}

/* Reads lines of "strain stress"; '#' begins a comment, and a line of words at the top is a heading. */
static enum rc_status
read_table(struct yield_law *y, const char *name, struct rc_err *err)
{
    FILE *file = fopen(name, "r");
    char line[512];
    size_t n = 0, room = 0, number = 0;
    enum rc_status status = RC_OK;
    struct rc_err point;

    if (file == NULL)
        return rc_err_set(err, "%s", strerror(errno));
    while (status == RC_OK && fgets(line, sizeof line, file) != NULL) {
        char strain[128], stress[128], rest[2];
        double at[2];
        int got;

        number++;
        line[strcspn(line, "#\r\n")] = '\0';
        got = sscanf(line, " %127s %127s %1s", strain, stress, rest);
        if (got <= 0)
            continue;
        if (got != 2) {
            status =
                rc_err_set(err, "line %zu: it must hold a plastic strain and a stress", number);
            break;
        }
        if (unit_number(strain, UNIT_NONE, &at[0], err) != RC_OK ||
            unit_number(stress, UNIT_PA, &at[1], err) != RC_OK) {
            if (n == 0 && number == 1 && is_word(strain) && is_word(stress))
                continue;
            status =
                rc_err_set(err, "line %zu: '%s %s': it must be a plastic strain and a stress in Pa",
                           number, strain, stress);
            break;
        }
        if (check_point(y, n, at[0], at[1], &point) != RC_OK) {
            status = rc_err_set(err, "line %zu: %s", number, point.text);
            break;
        }
        if (n == room) {
            room = 2 * room + 64;
            y->table[0] = realloc(y->table[0], room * sizeof(double));
            y->table[1] = realloc(y->table[1], room * sizeof(double));
            if (y->table[0] == NULL || y->table[1] == NULL) {
                status = rc_err_set(err, "out of memory");
                break;
            }
        }
        y->table[0][n] = at[0];
        y->table[1][n++] = at[1];
    }
    if (status == RC_OK && ferror(file))
        status = rc_err_set(err, "%s", strerror(errno));
    fclose(file);
    if (status == RC_OK && n == 0)
        status = rc_err_set(err, "it holds no strain and stress");
    if (status == RC_OK)
        y->law = (struct rc_yield){.points = n, .strain_at = y->table[0], .stress_at = y->table[1]};
    return status;
}

enum rc_status
yield_law_read(struct yield_law *y, const char *text, struct rc_err *err)
{
    size_t n = strlen(text), first = strcspn(text, ",");
    char stress[64];

    if (n > 4 && strcmp(text + n - 4, ".tsv") == 0)
        return read_table(y, text, err);
    if (first >= sizeof stress)
        return rc_err_set(err, "it must be Y, or Y,Hm, as in 1GPa,2GPa, or a table FILE.tsv");
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

void
yield_law_refuse(struct tool *t, bool given, const char *what, const char *why)
{
    if (given)
        tool_usage(t, "--yield does not work with %s: %s", what, why);
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
    const struct rc_yield *law = &read->law;

    yield_law_refuse(t, !isinf(a->hardness), "--hardness",
                     "--yield computes plasticity itself, which --hardness approximates");
    yield_law_refuse(t, a->layer.n > 0, "--layer", "it supports only bodies without layers");
    yield_law_refuse(t, tool_given(t, "estar"), "--estar",
                     "body 1 needs its own modulus: give --E1 --nu1, and --E2 --nu2 or --E2 rigid");
    yield_law_refuse(t, a->nu1 == 0.5, "--nu1 0.5",
                     "body 1 must be compressible: give a smaller --nu1");
    yield_law_refuse(t, a->approach.n > 0, "--approach",
                     "it needs a load: give --load or --mean-pressure");
    check_unit(t, rc_yield_stress(law, 0), a->surface_estar);
}

double
yield_law_hardening(const struct rc_yield *law)
{
    if (law->points == 0)
        return law->modulus;
    return law->points == 1
               ? 0
               : (law->stress_at[1] - law->stress_at[0]) / (law->strain_at[1] - law->strain_at[0]);
}
