/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Lists, and the trials that they give: each value with each value of the other lists. The reference has a
 * value of each list that is one step tighter than the tightest one, and the grid of the input.
 */
#include "cost.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- values ---- */

static void
add_value(struct cost_case *c, struct cost_list *l, const char *value)
{
    if (l->n + 2 >= COST_VALUES)
        tool_usage(c->tool, "--vary %s: more than %d values", l->name, COST_VALUES - 2);
    l->value[l->n++] = value;
}

/* Numbers from a:b:n and a:b:log:n, or texts between separators. */
static void
split_values(struct cost_case *c, struct cost_list *l, const char *text)
{
    const char separator = strchr(text, ';') != NULL ? ';' : ',';
    struct numbers numbers = {.n = 0};
    struct rc_err err;

    if (separator == ',' && strchr(text, ':') != NULL &&
        unit_numbers(text, UNIT_NONE, &numbers, &err) == RC_OK) {
        for (size_t k = 0; k < numbers.n; k++)
            add_value(c, l, tool_copy(c->tool, rc_number(numbers.v[k])));
        free(numbers.v);
        return;
    }
    for (char *at = tool_copy(c->tool, text), *end; at != NULL; at = end) {
        if ((end = strchr(at, separator)) != NULL)
            *end++ = '\0';
        if (*at != '\0')
            add_value(c, l, at);
    }
}

/* Whether all values are plain numbers. One with a unit is a quantity, and has no tight end. */
static void
find_numbers(struct cost_list *l)
{
    l->numbers = l->n > 0;
    l->whole = true;
    for (size_t k = 0; k < l->n; k++) {
        char *end;

        l->number[k] = strtod(l->value[k], &end);
        l->numbers = l->numbers && end != l->value[k] && *end == '\0' && isfinite(l->number[k]);
        l->whole = l->whole && l->number[k] == floor(l->number[k]);
    }
}

/* ---- lists ---- */

/* Finds the programs of the option; ends the tool if there is none, or which of them is not clear. */
static void
find_programs(struct cost_case *c, struct cost_list *l, const char *from)
{
    const char *name = l->name, *dot = strchr(name, '.'), *option = NULL;
    size_t with = 0, only = SIZE_MAX;

    if (dot != NULL && strspn(name, "0123456789") == (size_t)(dot - name)) {
        only = (size_t)strtoul(name, NULL, 10) - 1;
        name = dot + 1;
        if (only >= c->command.programs)
            tool_usage(c->tool, "%s %s: the command has %zu program%s", from, l->name,
                       c->command.programs, c->command.programs == 1 ? "" : "s");
    }
    for (size_t k = 0; k < c->command.programs; k++) {
        const char *o = cost_option(&c->command.program[k], name);

        if (o == NULL || (only != SIZE_MAX && k != only))
            continue;
        with++;
        l->program = k;
        option = o;
    }
    if (with == 0)
        tool_usage(c->tool, "%s: %s has no option --%s%s", from,
                   only != SIZE_MAX ? c->command.program[only].name : "the command", name,
                   strcmp(from, "--tol") == 0 ? ": give --vary OPTION=LIST or --grid LIST" : "");
    if (with > 1 && strcmp(from, "--tol") != 0)
        tool_usage(c->tool, "%s %s: %zu programs have --%s: write %zu.%s for %s", from, l->name,
                   with, name, l->program + 1, name, c->command.program[l->program].name);
    if (with > 1)
        l->program = SIZE_MAX;
    snprintf(l->option, sizeof l->option, "%s", name);
    l->least = json_real(json_member(option, "least"));
    l->most = json_real(json_member(option, "most"));
    cost_option_check(c->tool, option, from);
}

void
cost_list_add(struct cost_case *c, const char *from, const char *name, const char *values)
{
    struct cost_list *l = &c->list[c->lists];

    for (size_t k = 0; k < c->lists; k++)
        if (strcmp(c->list[k].name, name) == 0)
            tool_usage(c->tool, "%s: --%s has a list already", from, name);
    if (c->lists == COST_LISTS || strlen(name) >= sizeof l->name)
        tool_usage(c->tool, "%s %s: more than %d lists", from, name, COST_LISTS);
    *l = (struct cost_list){.grid = strcmp(from, "--grid") == 0, .least = NAN, .most = NAN};
    snprintf(l->name, sizeof l->name, "%s", name);
    if (!l->grid)
        find_programs(c, l, from);
    split_values(c, l, values);
    find_numbers(l);
    l->given = l->n;
    if (l->n == 0)
        tool_usage(c->tool, "%s %s: a value is missing", from, name);
    if (strcmp(l->option, "tol") == 0 || l->grid)
        l->tight = -1;
    for (size_t k = 0; k < l->n && (l->grid || strcmp(from, "--tol") == 0); k++)
        if (!l->numbers || l->number[k] <= 0 || (l->grid && (!l->whole || l->number[k] > 4096)))
            tool_usage(c->tool, "%s %s: %s", from, values,
                       l->grid ? "whole numbers k are expected, for 1/k of the nodes a side"
                               : "tolerances above 0 are expected");
    c->lists++;
}

void
cost_list_vary(struct cost_case *c, const char *text)
{
    const size_t n = strcspn(text, "=");
    char name[COST_NAME];

    text += strncmp(text, "--", 2) == 0 ? 2 : 0;
    if (text[strcspn(text, "=")] != '=' || n == 0 || n >= sizeof name)
        tool_usage(c->tool, "--vary %s: OPTION=LIST is expected, as in --vary increments=8,16,32",
                   text);
    snprintf(name, sizeof name, "%.*s", (int)strcspn(text, "="), text);
    cost_list_add(c, "--vary", name, text + strcspn(text, "=") + 1);
}

void
cost_list_reference(struct cost_case *c, const char *text)
{
    const size_t n = strcspn(text, "=");

    for (size_t k = 0; k < c->lists && text[n] == '='; k++) {
        struct cost_list *l = &c->list[k];
        double most = -INFINITY, least = INFINITY;

        if (strlen(l->name) != n || strncmp(l->name, text, n) != 0 || l->grid || l->fixed)
            continue;
        for (size_t i = 0; i < l->n; i++) {
            most = fmax(most, l->number[i]);
            least = fmin(least, l->number[i]);
        }
        add_value(c, l, text + n + 1);
        find_numbers(l);
        l->fixed = true;
        l->reference = l->n - 1;
        if (l->tight == 0 && l->numbers && l->number[l->reference] >= most)
            l->tight = 1;
        if (l->tight == 0 && l->numbers && l->number[l->reference] <= least)
            l->tight = -1;
        return;
    }
    tool_usage(c->tool, "--reference %s: OPTION=VALUE is expected, for an option with a list",
               text);
}

size_t
cost_list_rank(const struct cost_list *l, size_t value)
{
    size_t rank = 0;

    for (size_t k = 0; k < l->n && l->numbers; k++)
        rank += (l->number[k] - l->number[value]) * l->tight < 0;
    return rank;
}

/* Of the values, the tightest one whose number differs from that of `but`; SIZE_MAX: none. */
static size_t
tightest(const struct cost_list *l, size_t but)
{
    size_t best = SIZE_MAX;

    for (size_t k = 0; k < l->n; k++)
        if ((but == SIZE_MAX || l->number[k] != l->number[but]) &&
            (best == SIZE_MAX || cost_list_rank(l, k) > cost_list_rank(l, best)))
            best = k;
    return best;
}

void
cost_list_close(struct cost_case *c, struct cost_list *l)
{
    size_t a, b;
    double ratio, next;
    char text[64];

    l->last = SIZE_MAX;
    if (!l->numbers) {
        l->reference = l->fixed ? l->reference : 0;
        return;
    }
    if (l->tight == 0)
        l->tight = l->whole ? 1 : -1;
    a = tightest(l, SIZE_MAX);
    b = tightest(l, a);
    ratio = b == SIZE_MAX ? l->tight > 0 ? 2 : 0.1 : l->number[a] / l->number[b];
    next = l->grid ? 1 : l->number[a] * ratio;
    if (l->whole)
        next = round(next);
    next = next > l->most ? l->most : next < l->least ? l->least : next;
    if (!l->fixed && (next - l->number[a]) * l->tight > 0 && isfinite(next) && next > 0) {
        snprintf(text, sizeof text, "%.6g", next);
        l->number[l->n] = strtod(text, NULL);
        add_value(c, l, tool_copy(c->tool, text));
    }
    l->reference = l->fixed ? l->reference : tightest(l, SIZE_MAX);
    l->last = l->grid ? SIZE_MAX : tightest(l, l->reference);
}

void
cost_list_shorten(struct cost_list *l)
{
    l->n = l->given;
    l->reference = tightest(l, SIZE_MAX);
    l->last = tightest(l, l->reference);
}

/* ---- trials ---- */

size_t
cost_trial_add(struct cost_case *c, unsigned coarse)
{
    struct cost_trial *t;

    c->trial = tool_grown(c->tool, c->trial, c->trials, &c->room, sizeof *t, "a list of trials");
    t = &c->trial[c->trials];
    *t = (struct cost_trial){.coarse = coarse,
                             .grid = SIZE_MAX,
                             .expected = NAN,
                             .seconds = NAN,
                             .processor = NAN,
                             .memory = NAN,
                             .convolutions = NAN,
                             .estimate = NAN,
                             .error = NAN,
                             .bound = NAN};
    for (size_t k = 0; k < COST_FIGURES; k++)
        t->figure[k] = NAN;
    for (size_t k = 0; k < COST_ESTIMATES; k++)
        t->judged[k] = NAN;
    return c->trials++;
}

size_t
cost_trial_find(struct cost_case *c, const size_t pick[COST_LISTS], bool adds)
{
    size_t at;

    for (size_t k = 0; k < c->trials; k++)
        if (memcmp(c->trial[k].pick, pick, c->lists * sizeof *pick) == 0)
            return k;
    if (!adds)
        return SIZE_MAX;
    if (c->trials == COST_TRIALS)
        tool_usage(c->tool, "the lists give more than %d trials: shorten them", COST_TRIALS);
    at = cost_trial_add(c, 1);
    memcpy(c->trial[at].pick, pick, c->lists * sizeof *pick);
    for (size_t k = 0; k < c->lists; k++)
        if (c->list[k].grid)
            c->trial[at].coarse = (unsigned)c->list[k].number[pick[k]];
    return at;
}

void
cost_trials(struct cost_case *c)
{
    size_t pick[COST_LISTS] = {0}, k;

    c->points = c->lists - 1;
    for (k = c->lists; k-- > 0;)
        if (c->list[k].numbers && !c->list[k].grid)
            c->points = k;
    for (k = 0; k < c->lists; k++)
        if (strcmp(c->list[k].name, "tol") == 0)
            c->points = k;
    do {
        cost_trial_find(c, pick, true);
        for (k = c->lists; k-- > 0 && ++pick[k] == c->list[k].given;)
            pick[k] = 0;
    } while (k != SIZE_MAX);
}

struct rc_shape
cost_shape(const struct cost_case *c, const struct cost_trial *t)
{
    struct rc_shape shape = c->shape;

    /* so that both grids have the same area */
    for (size_t side = 0; side < 2 && t->coarse > 1; side++) {
        size_t *n = side == 0 ? &shape.nx : &shape.ny, nodes = *n;
        double *d = side == 0 ? &shape.dx : &shape.dy;
        *n = (nodes + t->coarse / 2) / t->coarse > 0 ? (nodes + t->coarse / 2) / t->coarse : 1;
        *d *= (double)nodes / (double)*n;
    }
    return shape;
}

/* ---- names ---- */

const char *
cost_value(const struct cost_list *l, size_t value, char text[COST_NAME])
{
    if (l->grid && l->number[value] > 1)
        snprintf(text, COST_NAME, "1/%.40s", l->value[value]);
    else
        snprintf(text, COST_NAME, "%s", l->value[value]);
    return text;
}

const char *
cost_name(const struct cost_case *c, const struct cost_trial *t, bool series, char text[160])
{
    char value[COST_NAME];
    size_t n = 0;

    snprintf(text, 160, "%s", t->name != NULL ? t->name : "");
    for (size_t k = 0; k < c->lists && n < 160; k++) {
        const struct cost_list *l = &c->list[k];

        if (series && (l->grid || k == c->points))
            continue;
        n += (size_t)snprintf(text + n, 160 - n, "%s%s %s", n > 0 ? ", " : "", l->name,
                              cost_value(l, t->pick[k], value));
    }
    return text;
}
