/*
 * --relaxation: terms on the command line, a file of terms, or a master curve.
 */
#include "relaxes.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    COLUMNS = 3,
    WORD = 64
};
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

/* ---- a file ---- */

/* What a column holds, by its name. */
enum kind {
    TAU,
    MODULUS,
    FREQUENCY,
    OMEGA,
    STORAGE,
    LOSS,
    OTHER
};
static const struct {
    const char *name;
    enum kind kind;
} names[] = {
    {"tau", TAU},
    {"time", TAU},
    {"e", MODULUS},
    {"modulus", MODULUS},
    {"frequency", FREQUENCY},
    {"f", FREQUENCY},
    {"omega", OMEGA},
    {"storage", STORAGE},
    {"e'", STORAGE},
    {"loss", LOSS},
    {"e''", LOSS},
    {"e\"", LOSS},
};

struct table {
    enum kind kind[COLUMNS];
    char unit[COLUMNS][WORD]; /* "": none */
    size_t columns, n, room;
    double *v; /* by lines */
};

/* Splits a line at blanks, commas and semicolons. */
static size_t
split(char *line, char *word[COLUMNS + 1])
{
    char *save = NULL;
    size_t n = 0;

    line[strcspn(line, "#\r\n")] = '\0';
    for (char *w = strtok_r(line, " \t,;", &save); w != NULL && n <= COLUMNS;
         w = strtok_r(NULL, " \t,;", &save))
        word[n++] = w;
    return n;
}

/* "storage/MPa" is a name and a unit. */
static enum rc_status
read_heading(struct table *t, size_t n, char *word[], struct rc_err *err)
{
    if (n > COLUMNS)
        return rc_err_set(err,
                          "it has more than %d columns: keep `tau E`, `frequency storage "
                          "loss` or `omega storage loss`, and remove the others, such as tan "
                          "delta",
                          COLUMNS);
    for (size_t c = 0; c < n; c++) {
        char *slash = strchr(word[c], '/');
        t->kind[c] = OTHER;
        if (slash != NULL) {
            *slash = '\0';
            snprintf(t->unit[c], WORD, "%s", slash + 1);
        }
        for (char *p = word[c]; *p != '\0'; p++)
            *p = (char)tolower((unsigned char)*p);
        for (size_t k = 0; k < sizeof names / sizeof *names; k++)
            if (strcmp(word[c], names[k].name) == 0)
                t->kind[c] = names[k].kind;
    }
    t->columns = n;
    if (n == 2 && t->kind[0] == TAU && t->kind[1] == MODULUS)
        return RC_OK;
    if (n == 3 && (t->kind[0] == FREQUENCY || t->kind[0] == OMEGA) && t->kind[1] == STORAGE &&
        t->kind[2] == LOSS)
        return RC_OK;
    return rc_err_set(err,
                      "its heading must be `tau E`, `frequency storage loss` or `omega storage "
                      "loss`");
}

static bool
is_number(const char *word)
{
    char *end;

    (void)strtod(word, &end);
    return end != word;
}

static enum rc_status
read_value(const struct table *t, size_t c, const char *word, double *value, struct rc_err *err)
{
    char text[2 * WORD], *end;

    if (t->kind[c] == TAU && strcmp(word, "inf") == 0) {
        *value = INFINITY;
        return RC_OK;
    }
    (void)strtod(word, &end);
    snprintf(text, sizeof text, "%.*s%.*s", WORD - 1, word, WORD - 1,
             *end == '\0' ? t->unit[c] : "");
    if (t->kind[c] == TAU)
        return unit_number(text, UNIT_S, value, err);
    if (t->kind[c] != FREQUENCY && t->kind[c] != OMEGA)
        return read_modulus(text, value, err);
    if (t->unit[c][0] != '\0' && strcmp(t->unit[c], t->kind[c] == OMEGA ? "rad/s" : "Hz") != 0)
        return rc_err_set(err, "unit %s: a frequency must be in Hz, and omega in rad/s",
                          t->unit[c]);
    if (*end != '\0')
        return rc_err_set(err, "'%s' is not a number", word);
    *value = strtod(word, NULL) * (t->kind[c] == FREQUENCY ? hertz : 1);
    return RC_OK;
}

static enum rc_status
add_line(struct table *t, char *word[], struct rc_err *err)
{
    if (t->n == t->room) {
        double *v = realloc(t->v, (2 * t->room + 64) * COLUMNS * sizeof *v);
        if (v == NULL)
            return rc_err_set(err, "out of memory");
        t->v = v;
        t->room = 2 * t->room + 64;
    }
    for (size_t c = 0; c < t->columns; c++)
        if (read_value(t, c, word[c], &t->v[t->n * COLUMNS + c], err) != RC_OK)
            return RC_FAIL;
    t->n++;
    return RC_OK;
}

/* The first line is the heading. A second line without numbers holds units. */
static enum rc_status
read_line(struct table *t, size_t number, char *line, struct rc_err *err)
{
    char *word[COLUMNS + 1];
    const size_t n = split(line, word);
    struct rc_err why;

    if (n == 0)
        return RC_OK;
    if (t->columns == 0)
        return read_heading(t, n, word, err);
    if (n != t->columns)
        return rc_err_set(err, "line %zu: it must hold %zu values", number, t->columns);
    if (t->n == 0 && !is_number(word[0]) && !is_number(word[n - 1])) {
        for (size_t c = 0; c < n; c++)
            snprintf(t->unit[c], WORD, "%s", word[c]);
        return RC_OK;
    }
    return add_line(t, word, &why) == RC_OK ? RC_OK
                                            : rc_err_set(err, "line %zu: %s", number, why.text);
}

/* The columns of the table, one after another. */
static double *
columns_of(const struct table *t)
{
    double *v = malloc((t->n * COLUMNS + 1) * sizeof *v);

    for (size_t k = 0; k < t->n && v != NULL; k++)
        for (size_t c = 0; c < t->columns; c++)
            v[c * t->n + k] = t->v[k * COLUMNS + c];
    return v;
}

/* The line `inf E` is the relaxed modulus. */
static enum rc_status
take_table(struct relaxation_law *law, const struct table *t, double shift, struct rc_err *err)
{
    const size_t n = t->n;
    RC_OWNED double *v = columns_of(t);
    double relaxed = 0;
    size_t terms = 0;

    if (v == NULL)
        return rc_err_set(err, "out of memory");
    for (size_t k = 0; k < n && t->columns == 2; k++)
        if (isinf(v[k])) {
            relaxed += v[n + k];
        } else {
            v[terms] = v[k] * shift;
            v[n + terms++] = v[n + k];
        }
    for (size_t k = 0; k < n && t->columns == 3; k++)
        v[k] /= shift;
    law->misfit = NAN;
    law->material = t->columns == 2
                        ? rc_relaxation_new(relaxed, terms, v + n, v, err)
                        : rc_relaxation_fit(n, v, v + n, v + 2 * n, 0, &law->misfit, err);
    return law->material != NULL ? RC_OK : RC_FAIL;
}

static enum rc_status
read_file(struct relaxation_law *law, FILE *file, double shift, struct rc_err *err)
{
    struct table t = {.columns = 0};
    enum rc_status status = RC_OK;
    char line[512];

    for (size_t number = 1; status == RC_OK && fgets(line, sizeof line, file) != NULL; number++)
        status = read_line(&t, number, line, err);
    if (status == RC_OK && ferror(file))
        status = rc_err_set(err, "%s", strerror(errno));
    if (status == RC_OK && t.n == 0)
        status = rc_err_set(err, "it holds no values");
    if (status == RC_OK)
        status = take_table(law, &t, shift, err);
    free(t.v);
    return status;
}

enum rc_status
relaxation_law_read(struct relaxation_law *law, const char *text, double shift, struct rc_err *err)
{
    FILE *file = strchr(text, ':') != NULL ? NULL : fopen(text, "r");
    enum rc_status status;

    if (file == NULL && strchr(text, ':') == NULL && strchr(text, '.') != NULL && !is_number(text))
        return rc_err_set(err, "%s", strerror(errno));
    if (file == NULL)
        return read_terms(law, text, shift, err);
    status = read_file(law, file, shift, err);
    fclose(file);
    return status;
}
