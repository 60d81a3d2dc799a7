/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * --relaxation: terms on the command line, a table of terms, a measured relaxation, or a master curve.
 */
#include "relaxation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double hertz = 6.283185307179586; /* rad/s */
static const double rounding = 1e-6;           /* relative */

/* A modulus must have a unit: 5 could be meant in MPa. */
static enum rc_status
read_modulus(const char *text, double *value, struct rc_err *err)
{
    const double as_pascals =
        1e5; /* such a number is meant in Pa: polymers have less than 10 GPa */
    char *end;
    const double bare = strtod(text, &end);

    if (end != text && *end == '\0' && bare != 0)
        return rc_err_set(err, "modulus %s: give its unit, as in %s%s", text, text,
                          fabs(bare) < as_pascals ? "MPa" : "Pa");
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
    PHASE,
    COMPLEX, /* |E*| */
    TEMPERATURE,
    SHEAR,
    KINDS
};
/* English and German names. Instruments write E' and E'' also with primes (U+2032, U+2033) and with raised
 * commas (U+2019). */
static const struct wanted_column wanted[KINDS] = {
    [TAU] = {.names = "tau relaxationtime relaxationszeit \317\204",
             .unit = UNIT_S,
             .optional = true,
             .infinite = true},
    [MODULUS] = {.names = "E modulus relaxationmodulus erelax e(t) relaxationsmodul",
                 .unit = UNIT_PA,
                 .optional = true,
                 .needs_unit = true},
    [TIME] = {.names = "time t zeit", .unit = UNIT_S, .optional = true, .infinite = true},
    [FREQUENCY] = {.names = "frequency f freq frequenz", .unit = UNIT_HZ, .optional = true},
    [OMEGA] = {.names = "omega angularfrequency kreisfrequenz \317\211",
               .unit = UNIT_RAD_S,
               .optional = true},
    [STORAGE] = {.names = "storage storagemodulus e' estor estorage speichermodul e\342\200\262 "
                          "e\342\200\231",
                 .unit = UNIT_PA,
                 .optional = true,
                 .needs_unit = true},
    [LOSS] = {.names = "loss lossmodulus e'' e\" eloss verlustmodul e\342\200\263 "
                       "e\342\200\262\342\200\262 e\342\200\231\342\200\231 e\342\200\235",
              .unit = UNIT_PA,
              .optional = true,
              .needs_unit = true},
    [TAN_DELTA] = {.names = "tandelta tan(delta) tand lossfactor damping dampingfactor "
                            "verlustfaktor tan\316\264 tan(\316\264)",
                   .optional = true,
                   .spare = 1U << LOSS},
    [PHASE] = {.names = "phase phaseangle phaselag delta phasenwinkel \316\264",
               .unit = UNIT_ANGLE,
               .optional = true,
               .needs_unit = true,
               .spare = 1U << LOSS | 1U << TAN_DELTA},
    [COMPLEX] = {.names = "|e*| e* complexmodulus dynamicmodulus komplexermodul komplexmodul",
                 .unit = UNIT_PA,
                 .optional = true,
                 .needs_unit = true,
                 .spare = 1U << STORAGE},
    [TEMPERATURE] = {.names = "temperature temp temperatur",
                     .unit = UNIT_K,
                     .optional = true,
                     .needs_unit = true},
    [SHEAR] = {.names = "g g(t) g' g'' g\" gstor gstorage gloss shearmodulus g* |g*|",
               .unit = UNIT_PA,
               .optional = true,
               .refused =
                   "it is a shear modulus: multiply it by 2 (1 + nu), which is 3 for rubber, and "
                   "name it E, E' or E''"},
};

/* True if the table has these columns and no others, except temperatures. */
static bool
has(const struct columns *c, unsigned kinds)
{
    unsigned there = 0;

    for (unsigned k = 0; k < TEMPERATURE; k++)
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
    law->material = rc_relaxation_new(relaxed, terms, modulus, tau, err);
    return law->material != NULL ? RC_OK : RC_FAIL;
}

/* Sets the range of the table to that of v[0..n), angular frequencies or times, with the modulus at each;
 * `whole`: without an upper end. */
static void
set_range(struct relaxation_law *law, size_t n, const double *v, const double *modulus,
          bool in_time, bool whole)
{
    double low = INFINITY, high = 0;

    law->least.modulus = INFINITY;
    for (size_t k = 0; k < n; k++) {
        const struct relaxation_measured at = {modulus[k], in_time ? 1 / v[k] : v[k]};

        low = fmin(low, v[k]);
        high = fmax(high, v[k]);
        if (at.modulus < law->least.modulus ||
            (at.modulus == law->least.modulus && at.omega < law->least.omega))
            law->least = at;
        if (at.modulus > law->most.modulus ||
            (at.modulus == law->most.modulus && at.omega > law->most.omega))
            law->most = at;
    }
    law->in_time = in_time;
    law->lowest = !in_time ? low : whole ? 0 : 1 / high;
    law->highest = !in_time ? high : 1 / low;
}

/* Makes storage and loss of one modulus and tan delta or the phase angle: E' = |E*| cos delta and
 * E'' = E' tan delta. A table that has others, or all, stays as it is. */
static enum rc_status
complete(struct columns *c, struct rc_err *err)
{
    const unsigned size = c->v[STORAGE] != NULL ? STORAGE : COMPLEX;
    const unsigned angle = c->v[TAN_DELTA] != NULL ? TAN_DELTA : PHASE;
    const double right_angle = 1.5707963267948966;
    double *e = c->v[size], *lag = c->v[angle];

    if (c->v[LOSS] != NULL || e == NULL || lag == NULL)
        return RC_OK;
    for (size_t k = 0; k < c->n; k++) {
        if (!(lag[k] > 0) || (angle == PHASE && lag[k] >= right_angle))
            return rc_err_set(err, "line %zu: %s: it must be above 0%s", c->line[k],
                              angle == PHASE ? "phase" : "tan delta",
                              angle == PHASE ? " and below 90 degrees" : "");
        lag[k] = angle == PHASE ? tan(lag[k]) : lag[k];
        e[k] /= size == COMPLEX ? hypot(1, lag[k]) : 1;
        lag[k] *= e[k];
    }
    c->v[size] = c->v[angle] = NULL;
    c->v[STORAGE] = e;
    c->v[LOSS] = lag;
    return RC_OK;
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
    set_range(law, c->n, omega, c->v[STORAGE], false, false);
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
    set_range(law, n, time, modulus, true, !isnan(relaxed));
    law->material = rc_relaxation_fit_time(n, time, modulus, relaxed, 0, &law->misfit, err);
    return law->material != NULL ? RC_OK : RC_FAIL;
}

static enum rc_status
take_table(struct relaxation_law *law, struct columns *c, double shift, struct rc_err *err)
{
    const unsigned moduli = 1U << STORAGE | 1U << LOSS;

    if (complete(c, err) != RC_OK)
        return RC_FAIL;
    if (has(c, 1U << TAU | 1U << MODULUS))
        return take_terms(law, c, shift, err);
    if (has(c, 1U << FREQUENCY | moduli) || has(c, 1U << OMEGA | moduli))
        return fit_curve(law, c, shift, err);
    if (has(c, 1U << TIME | 1U << MODULUS))
        return fit_relaxation(law, c, shift, err);
    return rc_err_set(
        err, "its heading must be `tau E`, `time E` or `frequency storage loss`; omega may "
             "take the place of frequency, tandelta or phase that of loss, and then |E*| "
             "that of storage");
}

static double factor_at(const struct relaxation_shift *s, double kelvin);

/* Shifts each row of a table from its temperature to T0: a time there is a_T times as long. Equal times
 * of two temperatures are made different, far below what a fit resolves. */
static enum rc_status
reduce(const struct columns *c, const struct relaxation_shift *shift, struct rc_err *err)
{
    static const enum kind inverse[] = {FREQUENCY, OMEGA};

    if (c->v[TAU] != NULL)
        return rc_err_set(err, "a table of terms has no temperatures: leave out that column");
    if (shift == NULL || !(shift->wlf || shift->arrhenius))
        return rc_err_set(err, "the column temperature needs a law that shifts its rows to one "
                               "temperature: --shift wlf,C1,C2,T0 or arrhenius,EA,T0");
    for (size_t k = 0; k < c->n; k++) {
        double a = factor_at(shift, c->v[TEMPERATURE][k]) * (1 + 1e-7 * (double)k / (double)c->n);

        if (!(a > 0) || isinf(a))
            return rc_err_set(err, "line %zu: at %g K the law of --shift has no value", c->line[k],
                              c->v[TEMPERATURE][k]);
        if (c->v[TIME] != NULL)
            c->v[TIME][k] /= a;
        for (size_t i = 0; i < sizeof inverse / sizeof *inverse; i++)
            if (c->v[inverse[i]] != NULL)
                c->v[inverse[i]][k] *= a;
    }
    return RC_OK;
}

enum rc_status
relaxation_law_read(struct relaxation_law *law, const char *text,
                    const struct relaxation_shift *shift, struct rc_err *err)
{
    const double factor = shift != NULL && shift->factor.n == 1 ? shift->factor.v[0] : 1;
    struct columns c;
    enum rc_status status;

    *law = (struct relaxation_law){.misfit = NAN, .highest = INFINITY};
    law->shift = shift != NULL && shift->factor.n > 1 ? shift : NULL;
    if (strchr(text, ':') != NULL || !columns_file(text))
        return read_terms(law, text, factor, err);
    status = columns_read(&c, text, wanted, KINDS, true, err);
    if (status == RC_OK && c.v[TEMPERATURE] != NULL)
        status = reduce(&c, shift, err);
    if (status == RC_OK)
        status = take_table(law, &c, factor, err);
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

/* A temperature, or a list of them. */
static enum rc_status
read_temperatures(const char *text, struct numbers *kelvin, struct rc_err *err)
{
    const char *unit = text + strcspn(text, "KC");

    if (strpbrk(text, ",:") == NULL) {
        if ((kelvin->v = malloc(sizeof *kelvin->v)) == NULL)
            return rc_err_set(err, "out of memory");
        kelvin->n = 1;
        return read_temperature(text, kelvin->v, err);
    }
    if (*unit == '\0')
        return rc_err_set(err, "temperatures %s: give their unit, K or degC, as in 20degC,40degC",
                          text);
    if (unit_numbers(text, UNIT_K, kelvin, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < kelvin->n; k++)
        if (!(kelvin->v[k] > 0))
            return rc_err_set(err, "temperature %g K: it must be above 0 K", kelvin->v[k]);
    return RC_OK;
}

/* Ferry 1980, Viscoelastic properties of polymers, chapter 11: log10 aT = -C1 (T - T0)/(C2 + T - T0), and ln
 * aT = EA/R (1/T - 1/T0). NAN below the range of WLF. */
static double
factor_at(const struct relaxation_shift *s, double kelvin)
{
    const double gas = 8.314462618; /* J/(mol K) */
    const double above = kelvin - s->t0;

    if (s->wlf)
        return s->c[1] + above > 0 ? pow(10, -s->c[0] * above / (s->c[1] + above)) : NAN;
    return exp(s->c[0] / gas * (1 / kelvin - 1 / s->t0));
}

static const char forms[] = "it must be factors, wlf,C1,C2,T0 or arrhenius,EA,T0";

static enum rc_status
read_factors(const char *text, const char *temperature, struct relaxation_shift *s,
             struct rc_err *err)
{
    struct rc_err why;

    if (unit_numbers(text, UNIT_NONE, &s->factor, &why) != RC_OK)
        return rc_err_set(err, "%s; a factor is above 0", forms);
    for (size_t k = 0; k < s->factor.n; k++)
        if (!(s->factor.v[k] > 0) || isinf(s->factor.v[k]))
            return rc_err_set(err, "%s; a factor is above 0", forms);
    return temperature == NULL
               ? RC_OK
               : rc_err_set(err, "--temperature has no effect without --shift wlf or arrhenius");
}

static enum rc_status
read_law(const char *text, struct relaxation_shift *s, struct rc_err *err)
{
    char *end;

    text = strchr(text, ',');
    if (!s->wlf) {
        char energy[64];
        const size_t n = strcspn(text + 1, ",");
        snprintf(energy, sizeof energy, "%.*s", (int)n, text + 1);
        if (text[n + 1] != ',')
            return rc_err_set(err, "%s", forms);
        if (unit_number(energy, UNIT_MOLAR, &s->c[0], err) != RC_OK)
            return RC_FAIL;
        if (!(s->c[0] > 0))
            return rc_err_set(err, "%s: EA must be above 0 J/mol", forms);
        text += n + 1;
    }
    for (int k = 0; k < (s->wlf ? 2 : 0); k++) {
        s->c[k] = strtod(text + 1, &end);
        if (end == text + 1 || *end != ',' || !(s->c[k] > 0) || isinf(s->c[k]))
            return rc_err_set(err, "%s, with numbers above 0 and T0 in K or degC", forms);
        text = end;
    }
    return read_temperature(text + 1, &s->t0, err);
}

enum rc_status
relaxation_shift_read(const char *text, const char *temperature, struct relaxation_shift *s,
                      struct rc_err *err)
{
    *s = (struct relaxation_shift){.wlf = strncmp(text, "wlf,", 4) == 0,
                                   .arrhenius = strncmp(text, "arrhenius,", 10) == 0};
    if (!s->wlf && !s->arrhenius)
        return read_factors(text, temperature, s, err);
    if (temperature == NULL)
        return rc_err_set(err, "--shift %s needs --temperature", s->wlf ? "wlf" : "arrhenius");
    if (read_law(text, s, err) != RC_OK || read_temperatures(temperature, &s->kelvin, err) != RC_OK)
        return RC_FAIL;
    if ((s->factor.v = malloc(s->kelvin.n * sizeof *s->factor.v)) == NULL)
        return rc_err_set(err, "out of memory");
    s->factor.n = s->kelvin.n;
    for (size_t k = 0; k < s->kelvin.n; k++) {
        double t = s->kelvin.v[k], a = s->factor.v[k] = factor_at(s, t);

        if (isnan(a))
            return rc_err_set(err, "at %g K it has no value: C2 = %g K reaches down to %g K", t,
                              s->c[1], s->t0 - s->c[1]);
        if (!(a > 0) || isinf(a))
            return rc_err_set(err, "at %g K the factor is %g: the law does not reach so far", t, a);
    }
    return RC_OK;
}

double
relaxation_factor(const struct relaxation_shift *s, size_t k)
{
    return s == NULL || s->factor.n == 0 ? 1 : s->factor.v[s->factor.n > 1 ? k : 0];
}

double
relaxation_kelvin(const struct relaxation_shift *s, size_t k)
{
    return s == NULL || s->kelvin.n == 0 ? NAN : s->kelvin.v[s->kelvin.n > 1 ? k : 0];
}

const char *
relaxation_outside_to(char text[RELAXATION_OUTSIDE], const struct relaxation_law *law, size_t k,
                      double omega)
{
    const double a = relaxation_factor(law->shift, k);
    const bool above = omega > law->highest / a * (1 + rounding);
    const double end = (above ? law->highest : law->lowest) / a;
    const struct relaxation_measured *measured = above ? &law->most : &law->least;
    char limit[128];

    if (!above && !(omega < end * (1 - rounding)))
        return NULL;
    if (law->in_time)
        snprintf(limit, sizeof limit, "%s, 1/(2 pi t) of the %s time of the table, %s",
                 shown_in_unit(end / hertz, "Hz"), above ? "first" : "last",
                 shown_in_unit(1 / end, "s"));
    else
        snprintf(limit, sizeof limit, "the %s frequency of the table, %s", above ? "last" : "first",
                 shown_in_unit(end / hertz, "Hz"));
    snprintf(
        text, RELAXATION_OUTSIDE,
        "%s, %s %s: its %s modulus, %s, is an extrapolation; the %s modulus of the table is %s "
        "at %s",
        shown_in_unit(omega / hertz, "Hz"), above ? "above" : "below", limit,
        above ? "instantaneous" : "relaxed",
        shown_in_unit(above ? 1 / law->material->instant : law->material->relaxed, "Pa"),
        above ? "highest" : "lowest", shown_in_unit(measured->modulus, "Pa"),
        law->in_time ? shown_in_unit(a / measured->omega, "s")
                     : shown_in_unit(measured->omega / a / hertz, "Hz"));
    return text;
}
