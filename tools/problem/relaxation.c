/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * --relaxation: terms on the command line, a table of terms, a measured relaxation, or a master curve.
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
    [TIME] = {.names = "time t", .unit = UNIT_S, .optional = true, .infinite = true},
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

/* A measured relaxation; the line `inf E` has the relaxed modulus. */
static enum rc_status
fit_relaxation(struct relaxation_law *law, struct columns *c, double shift, struct rc_err *err)
{
    double *time = c->v[TIME], *modulus = c->v[MODULUS], relaxed = NAN;
    size_t n = 0;

    for (size_t k = 0; k < c->n; k++) {
        if (isinf(time[k]) ? !(modulus[k] >= 0) : !(modulus[k] > 0))
            return rc_err_set(err, "line %zu: E: it must be %s 0", c->line[k],
                              isinf(time[k]) ? "at least" : "above");
        if (isinf(time[k])) {
            if (!isnan(relaxed))
                return rc_err_set(err, "line %zu: the relaxed modulus (inf) is given twice",
                                  c->line[k]);
            relaxed = modulus[k];
        } else {
            time[n] = time[k] * shift;
            modulus[n++] = modulus[k];
        }
    }
    law->material = rc_relaxation_fit_time(n, time, modulus, relaxed, 0, &law->misfit, err);
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
        return fit_relaxation(law, c, shift, err);
    return rc_err_set(err,
                      "its heading must be `tau E`, `time E`, `frequency storage loss` or `omega "
                      "storage loss`");
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

/* ---- the shift of a temperature ---- */

static enum rc_status
read_temperature(const char *text, double *kelvin, struct rc_err *err)
{
    static const struct {
        const char *unit;
        double zero;
    } units[] = {{"K", 0}, {"degC", 273.15}, {"C", 273.15}};
    char *end;
    const double value = strtod(text, &end);

    for (size_t k = 0; k < sizeof units / sizeof *units && end != text; k++)
        if (strcmp(end, units[k].unit) == 0) {
            *kelvin = value + units[k].zero;
            return *kelvin > 0 && !isinf(*kelvin)
                       ? RC_OK
                       : rc_err_set(err, "temperature %s: it must be above 0 K", text);
        }
    return rc_err_set(err, "temperature %s: give its unit, K or degC, as in 40degC", text);
}

/* Ferry 1980, Viscoelastic properties of polymers, chapter 11: log10 aT = -C1 (T - T0)/(C2 + T - T0), and ln
 * aT = EA/R (1/T - 1/T0). */
enum rc_status
relaxation_shift_read(const char *text, const char *temperature, double *shift, struct rc_err *err)
{
    static const char *const forms = "it must be a factor, wlf,C1,C2,T0 or arrhenius,EA,T0";
    const double gas = 8.314462618; /* J/(mol K) */
    const bool wlf = strncmp(text, "wlf,", 4) == 0;
    double c[2], t, t0;
    char *end;

    if (!wlf && strncmp(text, "arrhenius,", 10) != 0) {
        *shift = strtod(text, &end);
        if (end == text || *end != '\0' || !(*shift > 0) || isinf(*shift))
            return rc_err_set(err, "%s; a factor is above 0", forms);
        return temperature == NULL
                   ? RC_OK
                   : rc_err_set(err,
                                "--temperature has no effect without --shift wlf or arrhenius");
    }
    if (temperature == NULL)
        return rc_err_set(err, "--shift %s needs --temperature", wlf ? "wlf" : "arrhenius");
    text = strchr(text, ',');
    for (int k = 0; k < (wlf ? 2 : 1); k++) {
        c[k] = strtod(text + 1, &end);
        if (end == text + 1 || *end != ',' || !(c[k] > 0) || isinf(c[k]))
            return rc_err_set(err, "%s, with numbers above 0 and T0 in K or degC", forms);
        text = end;
    }
    if (read_temperature(text + 1, &t0, err) != RC_OK ||
        read_temperature(temperature, &t, err) != RC_OK)
        return RC_FAIL;
    if (wlf && !(c[1] + t - t0 > 0))
        return rc_err_set(err, "at %s it has no value: C2 = %g K reaches down to %g K", temperature,
                          c[1], t0 - c[1]);
    *shift = wlf ? pow(10, -c[0] * (t - t0) / (c[1] + t - t0)) : exp(c[0] / gas * (1 / t - 1 / t0));
    return *shift > 0 && !isinf(*shift)
               ? RC_OK
               : rc_err_set(err, "at %s the factor is %g: the law does not reach so far",
                            temperature, *shift);
}
