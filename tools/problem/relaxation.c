/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * --relaxation: terms on the command line, a table of terms, or a master curve.
 */
#include "relaxation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double hertz = 6.283185307179586; /* rad/s */

/* A modulus must have a unit: 5 could be meant in MPa. */
static enum rc_status
read_modulus(const char *text, double *value, struct rc_err *err)
{
    char *end;
    const double bare = strtod(text, &end);

    if (end != text && *end == '\0' && bare != 0)
        return rc_err_set(err, "modulus %s: give its unit, as in %sMPa", text, text);
    return unit_number(text, UNIT_PA, value, err);
}

/* ---- terms on the command line ---- */

static enum rc_status
read_term(char *word, double shift, double *modulus, double *time, struct rc_err *err)
{
    char *colon = strchr(word, ':');

    if (colon == NULL)
        return rc_err_set(err, "'%s': a term must be a modulus and a time, as in 9MPa:1ms", word);
    *colon = '\0';
    if (read_modulus(word, modulus, err) != RC_OK ||
        unit_number(colon + 1, UNIT_S, time, err) != RC_OK)
        return RC_FAIL;
    *time *= shift;
    return RC_OK;
}

static enum rc_status
read_terms(struct relaxation_law *law, const char *text, double shift, struct rc_err *err)
{
    const size_t room = strlen(text) + 1;
    RC_OWNED char *copy = malloc(room);
    RC_OWNED double *v = malloc(2 * room * sizeof *v);
    double relaxed;
    char *save = NULL;
    size_t n = 0;

    if (copy == NULL || v == NULL)
        return rc_err_set(err, "out of memory");
    memcpy(copy, text, room);
    for (char *word = strtok_r(copy, ",", &save); word != NULL; word = strtok_r(NULL, ",", &save))
        if (n++ == 0 ? read_modulus(word, &relaxed, err) != RC_OK
                     : read_term(word, shift, &v[n - 2], &v[room + n - 2], err) != RC_OK)
            return RC_FAIL;
    if (n < 2)
        return rc_err_set(err, "it must be Einf,E1:tau1,..., as in 1MPa,9MPa:1ms, or a file");
    law->misfit = NAN;
    law->material = rc_relaxation_new(relaxed, n - 1, v, v + room, err);
    return law->material != NULL ? RC_OK : RC_FAIL;
}

/* ---- a table ---- */

enum kind {
    TAU,
    MODULUS,
    TIME,
    FREQUENCY,
    OMEGA,
    STORAGE,
    LOSS,
    TAN_DELTA,
    KINDS
};
static const struct wanted_column wanted[KINDS] = {
    [TAU] = {.names = "tau relaxationtime", .unit = UNIT_S, .optional = true, .infinite = true},
    [MODULUS] = {.names = "E modulus relaxationmodulus erelax e(t)",
                 .unit = UNIT_PA,
                 .optional = true,
                 .needs_unit = true},
    [TIME] = {.names = "time t", .unit = UNIT_S, .optional = true},
    [FREQUENCY] = {.names = "frequency f freq", .unit = UNIT_HZ, .optional = true},
    [OMEGA] = {.names = "omega angularfrequency", .unit = UNIT_RAD_S, .optional = true},
    [STORAGE] = {.names = "storage storagemodulus e' estor estorage",
                 .unit = UNIT_PA,
                 .optional = true,
                 .needs_unit = true},
    [LOSS] = {.names = "loss lossmodulus e'' e\" eloss",
              .unit = UNIT_PA,
              .optional = true,
              .needs_unit = true},
    [TAN_DELTA] = {.names = "tandelta tan(delta) tand lossfactor", .ignored = true},
};

/* True if the table has these columns and no others. */
static bool
has(const struct columns *c, unsigned kinds)
{
    unsigned there = 0;

    for (unsigned k = 0; k < KINDS; k++)
        there |= c->v[k] != NULL ? 1U << k : 0;
    return there == kinds;
}

/* A line of each term; the line `inf E` has the relaxed modulus. */
static enum rc_status
take_terms(struct relaxation_law *law, struct columns *c, double shift, struct rc_err *err)
{
    double *tau = c->v[TAU], *modulus = c->v[MODULUS], relaxed = 0;
    size_t terms = 0;

    for (size_t k = 0; k < c->n; k++)
        if (isinf(tau[k])) {
            relaxed += modulus[k];
        } else {
            tau[terms] = tau[k] * shift;
            modulus[terms++] = modulus[k];
        }
    law->misfit = NAN;
    law->material = rc_relaxation_new(relaxed, terms, modulus, tau, err);
    return law->material != NULL ? RC_OK : RC_FAIL;
}

static enum rc_status
fit_curve(struct relaxation_law *law, struct columns *c, double shift, struct rc_err *err)
{
    const unsigned frequency = c->v[OMEGA] != NULL ? OMEGA : FREQUENCY;
    const unsigned kind[] = {frequency, STORAGE, LOSS};
    double *omega = c->v[frequency];

    for (size_t k = 0; k < c->n; k++) {
        for (size_t i = 0; i < 3; i++)
            if (!(c->v[kind[i]][k] > 0))
                return rc_err_set(err, "line %zu: %.*s: it must be above 0", c->line[k],
                                  (int)strcspn(wanted[kind[i]].names, " "), wanted[kind[i]].names);
        omega[k] *= (frequency == FREQUENCY ? hertz : 1) / shift;
    }
    law->material = rc_relaxation_fit(c->n, omega, c->v[STORAGE], c->v[LOSS], 0, &law->misfit, err);
    return law->material != NULL ? RC_OK : RC_FAIL;
}

static enum rc_status
take_table(struct relaxation_law *law, struct columns *c, double shift, struct rc_err *err)
{
    const unsigned moduli = 1U << STORAGE | 1U << LOSS;

    if (has(c, 1U << TAU | 1U << MODULUS))
        return take_terms(law, c, shift, err);
    if (has(c, 1U << FREQUENCY | moduli) || has(c, 1U << OMEGA | moduli))
        return fit_curve(law, c, shift, err);
    if (has(c, 1U << TIME | 1U << MODULUS))
        return rc_err_set(err,
                          "its columns time and E are a measured relaxation: a table of measured "
                          "E(t) must be fitted first, for example in another program: give its "
                          "terms in columns `tau E`");
    return rc_err_set(err,
                      "its heading must be `tau E`, `frequency storage loss` or `omega storage "
                      "loss`");
}

enum rc_status
relaxation_law_read(struct relaxation_law *law, const char *text, double shift, struct rc_err *err)
{
    struct columns c;
    enum rc_status status;

    if (strchr(text, ':') != NULL || !columns_file(text))
        return read_terms(law, text, shift, err);
    status = columns_read(&c, text, wanted, KINDS, true, err);
    if (status == RC_OK)
        status = take_table(law, &c, shift, err);
    columns_free(&c);
    return status;
}
