/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Commands that compute an effect: what they need, their forecasts and their results. */
#include "scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char other[] = "--decide does not compare its figures: see the report of the command";
static const char percolates[] =
    "rc-leak finds the same percolation on this grid: only a finer or larger map decides";

/* The options that follow those of the contact, and a second program with its options. Words that are no
 * names of options of rc-scene are taken as they are. */
static const struct {
    const char *effect, *solve, *program, *options;
    const char *last, *last_options; /* a third program, which reads the output of the second */
    bool relaxes;                    /* --relaxation has the modulus of body 1 */
    bool together; /* the options of the second program are used if all are given */
    /* Names of the figures in the report of the last program, in the order of enum rc_scene_figure; of two
     * names the larger value counts. */
    const char *figure[RC_SCENE_FIGURES];
    const char *not_computed; /* without a figure: why the program does not decide */
} rows[] = {
    {.effect = "grid",
     .solve = "--discretization --verbose", /* its errors are a note */
     .not_computed = "rc-solve --discretization has the estimates on which this interval rests: "
                     "only a finer map decides"},
    {.effect = "tilt",
     .solve = "--tilt free",
     .figure = {"contact_area", "max_pressure", "approach"}},
    {.effect = "thin", .solve = "", .figure = {"contact_area", "max_pressure", "approach"}},
    {.effect = "coat", .solve = "layer", .figure = {"contact_area", "max_pressure", "approach"}},
    {.effect = "hardness",
     .solve = "hardness",
     .figure = {"contact_area", "max_pressure", "approach"}},
    {.effect = "slip",
     .solve = "",
     .program = "rc-slip",
     .options = "mu tangential",
     .not_computed = other},
    {.effect = "relaxation",
     .solve = "relaxation time",
     .relaxes = true,
     .figure = {"contact_area", "max_pressure", "approach"}},
    {.effect = "yield",
     .solve = "yield",
     .figure = {"contact_area", "max_pressure", "indentation"}},
    {.effect = "adhesion",
     .solve = "adhesion",
     .figure = {"contact_area", "max_pressure", "approach"}},
    {.effect = "pull-off",
     .solve = "adhesion --pull-off",
     .figure = {[RC_SCENE_PULL_OFF] = "pull_off_load"}},
    {.effect = "wear",
     .solve = "",
     .program = "rc-wear",
     .options = "coefficient distance",
     .figure = {"contact_area", "max_pressure"}},
    {.effect = "heat",
     .solve = "",
     .program = "rc-heat",
     .options = "mu speed conductivity diffusivity moving time",
     .figure = {[RC_SCENE_TEMPERATURE] = "max_temperature"}},
    {.effect = "heat of rolling",
     .solve = "",
     .program = "rc-slip",
     .options = "mu creep --steady --output pressure,dissipation",
     .last = "rc-heat",
     .last_options = "rolling=speed conductivity diffusivity time",
     .figure = {[RC_SCENE_TEMPERATURE] = "max_temperature"}},
    {.effect = "dissimilar",
     .solve = "--output pressure,gap,height",
     .program = "rc-slip",
     .options = "mu --coupling full --tangential 0N",
     .not_computed = other},
    {.effect = "rolling",
     .solve = "",
     .program = "rc-slip",
     .options = "mu creep --steady",
     .not_computed =
         "its force is the one of rc-slip, to a lower accuracy: only a smaller --tol decides"},
    {.effect = "sliding", .solve = "relaxation speed", .relaxes = true, .not_computed = other},
    {.effect = "fatigue",
     .solve = "",
     .program = "rc-fatigue",
     .options = "bending-limit torsion-limit --pass x --depths auto",
     .figure = {[RC_SCENE_FATIGUE] = "crossland|dangvan"}},
    {.effect = "leak",
     .solve = "",
     .program = "rc-leak",
     .options = "pressure-drop viscosity",
     .together = true,
     .not_computed = percolates},
    {.effect = "leak in time",
     .solve = "relaxation time",
     .relaxes = true,
     .program = "rc-leak",
     .options = "pressure-drop viscosity",
     .together = true,
     .not_computed = percolates},
};
static const char contact_options[] =
    "estar E1 nu1 E2 nu2 radius cylinder periodic datum"; /* of the contact, without its load */

static size_t
row_of(struct tool *t, const char *effect)
{
    size_t k = 0;

    if (strcmp(effect, "heat") == 0 && tool_given(t, "creep"))
        effect = "heat of rolling";
    while (k < sizeof rows / sizeof *rows && strcmp(rows[k].effect, effect) != 0)
        k++;
    return k;
}

/* ---- words ---- */

const char *
scene_number_in_unit(double value, enum unit unit, char text[64])
{
    static const char *const units[] = {
        [UNIT_M] = "m", [UNIT_N] = "N", [UNIT_PA] = "Pa", [UNIT_HARD] = "Pa"};
    double again;
    size_t n = 0;
    struct rc_err err;

    if (unit < sizeof units / sizeof *units && units[unit] != NULL) {
        for (const char *at = shown_in_unit(value, units[unit]); *at != '\0' && n < 60; at++)
            if (*at != ' ')
                text[n++] = *at;
        text[n] = '\0';
        if (unit_number(text, unit, &again, &err) == RC_OK && again == value)
            return text;
    }
    snprintf(text, 64, "%s", rc_number(value));
    return text;
}

/* The value of an option as it was typed, or as its table has it; else 210GPa for 2.1e11 Pa. */
static const char *
value_of(struct tool *t, size_t k, char pretty[64])
{
    const struct opt *o = &t->option.row[k];
    const char *typed = t->option.text[k];
    const double *v = tool_value(t, o);

    if (o->type == OPT_NUMBER && !isinf(*v))
        return typed != NULL ? typed : scene_number_in_unit(*v, o->unit, pretty);
    return o->type == OPT_NUMBERS && typed != NULL ? typed : tool_result_value(t, k);
}

const char *
scene_value(struct tool *t, const char *name, char pretty[64])
{
    for (size_t k = 0; k < t->option.n; k++)
        if (t->option.row[k].name != NULL && strcmp(t->option.row[k].name, name) == 0)
            return value_of(t, k, pretty);
    return "";
}

/* Adds an option of rc-scene, if it was given, as `--name value`; "other=name": as `--other value`. */
static void
add_option(struct tool *t, const char *name, const char **word, char (*text)[96], size_t *n)
{
    const char *own = strchr(name, '=');
    const int shown = (int)strcspn(name, "=");

    own = own == NULL ? name : own + 1;
    for (size_t k = 0; k < t->option.n; k++) {
        const struct opt *o = &t->option.row[k];
        char pretty[64];
        const char *value;
        if (o->name == NULL || strcmp(o->name, own) != 0 || !t->option.given[k] ||
            *n + 3 >= SCENE_WORDS)
            continue;
        if (o->type == OPT_TEXTS) { /* --layer, once for each */
            const struct steps *steps = tool_value(t, o);
            for (size_t i = 0; i < steps->n && *n + 3 < SCENE_WORDS; i++) {
                snprintf(text[*n], sizeof *text, "--%s", name);
                word[*n] = text[*n];
                word[*n + 1] = steps->step[i].typed;
                *n += 2;
            }
            continue;
        }
        value = value_of(t, k, pretty);
        if (o->optional && value[0] != '\0' && strcmp(value, "yes") != 0)
            snprintf(text[*n], sizeof *text, "--%s=%s", name, value);
        else
            snprintf(text[*n], sizeof *text, "--%.*s", shown, name);
        word[*n] = text[*n];
        ++*n;
        if (o->optional || o->type == OPT_FLAG)
            continue;
        snprintf(text[*n], sizeof *text, "%s", value);
        word[*n] = text[*n];
        ++*n;
    }
}

static bool
all_given(struct tool *t, const char *names)
{
    for (const char *at = names; *at != '\0'; at += strspn(at, " ")) {
        char name[48];
        const size_t length = strcspn(at, " ");
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        at += length;
        if (!tool_given(t, name))
            return false;
    }
    return true;
}

/* Adds the words of a row: names of options, or words as they are. */
static void
add_words(struct tool *t, const char *words, bool relaxes, const char **word, char (*text)[96],
          size_t *n)
{
    bool plain = false; /* the word before was one as it is */

    for (const char *at = words; *at != '\0'; at += strspn(at, " ")) {
        const size_t length = strcspn(at, " ");
        char name[48];
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        at += length;
        if (relaxes && strcmp(name, "E1") == 0)
            continue;
        if (name[0] != '-' && !plain) {
            add_option(t, name, word, text, n);
            continue;
        }
        plain = name[0] == '-' && strcmp(name, "--discretization") != 0 &&
                strcmp(name, "--verbose") != 0 && strcmp(name, "--pull-off") != 0 &&
                strcmp(name, "--steady") != 0;
        if (*n + 1 < SCENE_WORDS) {
            snprintf(text[*n], sizeof *text, "%s", name);
            word[*n] = text[*n];
            ++*n;
        }
    }
}

bool
scene_command(struct tool *t, const char *effect, const char *const load[2], const char *body,
              const char *with, struct scene_command *c)
{
    const size_t k = row_of(t, effect);
    const bool thin = strcmp(effect, "thin") == 0;
    size_t n = 0;

    if (k == sizeof rows / sizeof *rows)
        return false;
    c->programs = rows[k].program == NULL ? 1 : rows[k].last == NULL ? 2 : 3;
    c->word[0][n++] = "rc-solve";
    c->word[0][n++] = load[0];
    c->word[0][n++] = load[1];
    if (thin) { /* body 1 is a layer on a rigid base */
        static const char *const of_body[] = {"--E1", "rigid", "--layer"};
        for (size_t i = 0; i < 3; i++)
            c->word[0][n++] = of_body[i];
        snprintf(c->text[0][n], sizeof c->text[0][n], "%s", body); /* the caller frees it */
        c->word[0][n] = c->text[0][n];
        n++;
        add_words(t, "E2 nu2 radius cylinder periodic datum", false, c->word[0], c->text[0], &n);
    } else {
        add_words(t, contact_options, rows[k].relaxes, c->word[0], c->text[0], &n);
    }
    add_words(t, rows[k].solve, false, c->word[0], c->text[0], &n);
    if (strcmp(effect, "yield") != 0)
        add_words(t, with, false, c->word[0], c->text[0], &n);
    c->word[0][n] = NULL;
    if (rows[k].program == NULL)
        return true;
    n = 0;
    c->word[1][n++] = rows[k].program;
    if (!rows[k].together || all_given(t, rows[k].options))
        add_words(t, rows[k].options, false, c->word[1], c->text[1], &n);
    c->word[1][n] = NULL;
    if (rows[k].last == NULL)
        return true;
    n = 0;
    c->word[2][n++] = rows[k].last;
    add_words(t, rows[k].last_options, false, c->word[2], c->text[2], &n);
    c->word[2][n] = NULL;
    return true;
}

void
scene_refine(struct scene_command *c, size_t nx, size_t ny)
{
    char *size = c->text[1][0]; /* of a second program, which there is not */

    memcpy(c->word[1], c->word[0], sizeof c->word[1]);
    snprintf(size, sizeof c->text[1][0], "%zux%zu", nx, ny);
    c->word[0][0] = "rc-pick";
    c->word[0][1] = "--resample";
    c->word[0][2] = size;
    c->word[0][3] = NULL;
    c->programs = 2;
}

void
scene_show(const struct scene_command *c, const char *effect, const char *file, FILE *out)
{
    for (size_t p = 0; p < c->programs; p++) {
        fputs(p > 0 ? " | " : "", out);
        for (size_t k = 0; c->word[p][k] != NULL; k++) {
            fputs(k == 0 ? "" : " ", out);
            shown_shell_word(out, c->word[p][k]);
        }
        if (p == 0) {
            fputc(' ', out);
            shown_shell_word(out, file);
        }
    }
    /* the name is not that of a file of the user, as wear.rcg may be */
    fprintf(out, " -o scene-%s.rcg", effect);
}

/* ---- runs ---- */

const char *
scene_not_computed(struct tool *t, const char *effect)
{
    const size_t k = row_of(t, effect);

    return k == sizeof rows / sizeof *rows ? NULL : rows[k].not_computed;
}

/* The last line of a report, or of what a tool said. */
static const char *
last_object(char *said)
{
    char *line = said == NULL ? NULL : strrchr(said, '{');

    while (line != NULL && line > said && line[-1] != '\n')
        line--;
    return line;
}

/* The figure of this name, or the largest of NAME|NAME, and its relative error, 0 without an estimate. */
static void
read_figure(const char *object, const char *names, double *value, double *error)
{
    for (const char *at = names; *at != '\0'; at += strspn(at, "|")) {
        char name[48], estimate[64];
        const size_t length = strcspn(at, "|");
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        snprintf(estimate, sizeof estimate, "%s_error_estimate", name);
        at += length;
        const double v = json_real(json_member(object, name)),
                     e = json_real(json_member(object, estimate));
        if (isnan(v) || (!isnan(*value) && v <= *value))
            continue;
        *value = v;
        *error = isnan(e) ? 0 : e;
    }
}

static void
read_report(const char *object, size_t row, bool plan, struct scene_found *found)
{
    const char *total = json_member(object, "seconds");

    for (int f = 0; f < RC_SCENE_FIGURES; f++)
        if (rows[row].figure[f] != NULL)
            read_figure(object, rows[row].figure[f], &found->figure[f], &found->error[f]);
    if (!isnan(found->figure[RC_SCENE_PULL_OFF]))
        found->error[RC_SCENE_PULL_OFF] = json_real(json_member(object, "pull_off_spread")) /
                                          fabs(found->figure[RC_SCENE_PULL_OFF]);
    found->converged = json_real(json_member(object, "converged")) == 1;
    found->seconds = json_real(plan ? json_member(object, "expected_seconds")
                                    : json_member(total == NULL ? "{}" : total, "total"));
    found->convolutions =
        json_real(json_member(object, plan ? "expected_convolutions" : "convolutions"));
}

int
scene_file(struct tool *t)
{
    FILE *file = tmpfile();
    int own;

    if (file == NULL || (own = dup(fileno(file))) < 0)
        tool_die(t, "no temporary file can be made: set TMPDIR to a folder with room");
    fclose(file);
    return own;
}

/* Why a program has failed, if this is for the contact, and not for the machine. */
static void
find_reason(const struct process *process, const char *program, char why[SCENE_WHY])
{
    const char *said = process->said == NULL ? "" : process->said, *of = strstr(said, "): ");
    const bool about = of != NULL && of < said + strcspn(said, "\n");

    if (about) /* PROGRAM: SOURCE, case 1, frame 2 (NAME): */
        said = of + 3;
    else if (strncmp(said, program, strlen(program)) == 0)
        said += strlen(program) + strspn(said + strlen(program), ": ");
    if (about || process->status == EXIT_USAGE)
        snprintf(why, SCENE_WHY, "%s: %.*s", program, (int)strcspn(said, "\n"), said);
}

/* The output of the second of three programs, the input of the last one; -1 if it fails. */
static int
run_second(struct tool *t, const struct scene_command *c, const char *effect, int contact,
           char why[SCENE_WHY])
{
    const char *word[SCENE_WORDS + 2];
    struct process process = {.in = contact, .out = scene_file(t), .allowed = 1e9, .doing = effect};
    size_t n = 0;
    enum process_end end;

    for (; c->word[1][n] != NULL; n++)
        word[n] = c->word[1][n];
    word[n++] = "--quiet";
    word[n] = NULL;
    end = process_run(t, word, &process);
    if (end == PROCESS_INTERRUPTED)
        tool_die(t, "interrupted");
    if (end != PROCESS_ENDED) {
        find_reason(&process, c->word[1][0], why);
        close(process.out);
        process.out = -1;
    }
    free(process.said);
    return process.out;
}

bool
scene_run(struct tool *t, const struct scene_command *c, const char *effect, int in, int contact,
          bool plan, struct scene_found *found, char why[SCENE_WHY])
{
    const size_t row = row_of(t, effect);
    const size_t last = plan && c->programs > 2 ? 1 : c->programs - 1; /* rc-slip takes the time */
    bool fine = true;

    *found = (struct scene_found){.seconds = NAN, .convolutions = NAN};
    for (int f = 0; f < RC_SCENE_FIGURES; f++)
        found->figure[f] = NAN;
    /* the elastic contact is the input of a second program */
    const char *word[SCENE_WORDS + 8];
    struct process process = {
        .in = last == 0 ? in : contact, .out = -1, .allowed = 1e9, .doing = effect};
    size_t n = 0;
    enum process_end end;
    const char *object;
    if (last == 2 && (process.in = run_second(t, c, effect, contact, why)) < 0)
        return false;
    for (size_t k = 0; c->word[last][k] != NULL; k++)
        word[n++] = c->word[last][k];
    word[n++] = "--quiet";
    word[n++] = "--report";
    word[n++] = "-";
    if (plan)
        word[n++] = "--dry-run";
    word[n] = NULL;
    end = process_run(t, word, &process);
    if (last == 2)
        close(process.in);
    object = last_object(process.said);
    if (end == PROCESS_INTERRUPTED)
        tool_die(t, "interrupted");
    if (end != PROCESS_ENDED || object == NULL) {
        find_reason(&process, c->word[last][0], why);
        fine = false;
    } else {
        read_report(object, row, plan, found);
    }
    free(process.said);
    return fine;
}
