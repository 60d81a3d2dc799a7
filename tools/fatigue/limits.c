/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Endurance limits of materials or of a table, and residual stresses. */
#include "fatigue.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- limits ---- */

static void
read_table(struct tool *t, struct fatigue_limits *l)
{
    static const struct wanted_column wanted[] = {
        {.names = "depth z", .unit = UNIT_M},
        {.names = "bending bendinglimit", .unit = UNIT_PA},
        {.names = "torsion torsionlimit", .unit = UNIT_PA},
        {.names = "yield yieldstress", .unit = UNIT_PA, .optional = true},
    };
    enum {
        KINDS = sizeof wanted / sizeof *wanted
    };
    const char *name = l->asked->table;
    struct columns c;

    if (columns_read(&c, name, wanted, KINDS, false, &t->err) != RC_OK)
        tool_usage(t, "--limits %s: %s", name, t->err.text);
    l->n = c.n;
    l->depth = tool_room(t, l->n, sizeof *l->depth, "a table of limits");
    l->at = tool_room(t, l->n, sizeof *l->at, "a table of limits");
    for (size_t k = 0; k < l->n; k++) {
        double v[KINDS] = {0};

        for (size_t i = 0; i < KINDS && c.v[i] != NULL; i++)
            if (!((v[i] = c.v[i][k]) >= 0))
                tool_usage(t, "--limits %s: line %zu: %g: it must be at least 0", name, c.line[k],
                           v[i]);
        if (k > 0 && !(v[0] > l->depth[k - 1]))
            tool_usage(t, "--limits %s: line %zu: depth %g m: the depths must increase", name,
                       c.line[k], v[0]);
        l->depth[k] = v[0];
        l->at[k] = (struct rc_fatigue_limits){v[1], v[2], v[3]};
    }
    columns_free(&c);
}

static double
number_of(const struct numbers *list, size_t k)
{
    return list->n == 0 ? 0 : list->v[list->n == 1 ? 0 : k];
}

/* True if a criterion needs endurance limits. */
static bool
needs_limits(unsigned wanted)
{
    return (wanted & (1U << RC_SHAKEDOWN | 1U << RC_AMPLITUDE)) != wanted;
}

/* What is probably wrong with refused limits. */
static const char *
likely_cause(const struct rc_fatigue_limits *l)
{
    const double ratio = l->torsion / l->bending;

    if (ratio > 1 && ratio <= 2)
        return "were the two exchanged?";
    return ratio > 2 || (ratio > 0 && ratio < 0.1) ? "is a unit wrong?" : "see --criteria";
}

void
fatigue_limits_read(struct tool *t, const struct fatigue_limits_asked *asked, unsigned wanted,
                    struct fatigue_limits *l)
{
    const struct numbers *const list[] = {&asked->bending, &asked->torsion, &asked->yield};
    size_t most = 0;

    l->asked = asked;
    for (int i = 0; i < 3; i++)
        most = list[i]->n > most ? list[i]->n : most;
    if (asked->table == NULL && needs_limits(wanted) &&
        (asked->bending.n == 0 || asked->torsion.n == 0))
        tool_usage(
            t, "give both endurance limits, --bending-limit and --torsion-limit: every criterion "
               "needs the two, and their ratio differs between materials");
    if (asked->table != NULL) {
        read_table(t, l);
    } else {
        l->n = most > 0 ? most : 1;
        l->at = tool_room(t, l->n, sizeof *l->at, "limits");
        for (int i = 0; i < 3; i++)
            if (list[i]->n > 1 && list[i]->n != l->n)
                tool_usage(
                    t, "the limits of materials must be lists of the same length, or one number "
                       "for all");
        for (size_t k = 0; k < l->n; k++)
            l->at[k] = (struct rc_fatigue_limits){number_of(list[0], k), number_of(list[1], k),
                                                  number_of(list[2], k)};
    }
    for (size_t k = 0; k < l->n; k++)
        if (rc_fatigue_check_limits(wanted, &l->at[k], &t->err) != RC_OK)
            tool_usage(t, "%s: %s", t->err.text, likely_cause(&l->at[k]));
}

/* 650 or 650GPa instead of 650MPa: no material bears ten thousand times its limit, and none has an endurance
 * limit of 10 GPa. */
static void
warn_of_units(struct tool *t, const struct rc_grid *p, const struct fatigue_limits *l)
{
    const double part = 1e-4, strongest = 10e9;
    double least = INFINITY, most = 0, endurance = 0;

    for (size_t k = 0; k < l->n; k++) {
        const double of[] = {l->at[k].bending, l->at[k].torsion, l->at[k].yield};
        for (size_t i = 0; i < sizeof of / sizeof *of; i++)
            if (of[i] > 0)
                least = fmin(least, of[i]);
        endurance = fmax(endurance, fmax(l->at[k].bending, l->at[k].torsion));
    }
    if (endurance > strongest)
        tool_warn(t,
                  "%s: an endurance limit of %s is above that of any material: is its unit right?",
                  tool_where(t, p), shown_in_unit(endurance, "Pa"));
    for (size_t k = 0; k < rc_grid_nodes(p); k++)
        most = fmax(most, p->v[k]);
    most = ranks_most(t, most);
    if (least < part * most)
        tool_warn(
            t,
            "%s: a limit of %s is below a ten-thousandth of the largest pressure, %s: give its "
            "unit, as in 650MPa",
            tool_where(t, p), shown_in_unit(least, "Pa"), shown_in_unit(most, "Pa"));
}

void
fatigue_limits_check(struct tool *t, const struct rc_grid *p, const struct fatigue_limits *l,
                     const struct rc_body *body)
{
    if (l->depth == NULL && l->n > 1 && l->n != body->layers + 1)
        tool_refuse(t, p, "its body has %zu material%s, and there are limits of %zu",
                    body->layers + 1, body->layers == 0 ? "" : "s", l->n);
    warn_of_units(t, p, l);
}

static double
between(double a, double b, double part)
{
    return a + (b - a) * part;
}

struct rc_fatigue_limits
fatigue_limits_at(const struct fatigue_limits *l, const struct rc_body *body, double depth)
{
    size_t k = 0;
    double part;

    if (l->depth == NULL)
        return l->at[l->n == 1 ? 0 : rc_body_material(body, depth)];
    while (k + 1 < l->n && depth > l->depth[k + 1])
        k++;
    if (k + 1 == l->n || depth <= l->depth[0])
        return l->at[k];
    part = (depth - l->depth[k]) / (l->depth[k + 1] - l->depth[k]);
    return (struct rc_fatigue_limits){between(l->at[k].bending, l->at[k + 1].bending, part),
                                      between(l->at[k].torsion, l->at[k + 1].torsion, part),
                                      between(l->at[k].yield, l->at[k + 1].yield, part)};
}

void
fatigue_limits_free(struct fatigue_limits *l)
{
    free(l->depth);
    free(l->at);
}

/* ---- residual stresses ---- */

static int
component_of(const char *channel)
{
    int c = 0;

    while (c < RC_COMPONENTS && strcmp(channel, rc_component_names[c]) != 0)
        c++;
    return c;
}

/* The index of a depth; n when the file has none there. */
static size_t
index_of(const struct fatigue_residual *r, double depth)
{
    size_t k = 0;

    while (k < r->n && !(fabs(r->depth[k] - depth) <= 1e-9 * fabs(depth)))
        k++;
    return k;
}

/* A map that is read row by row: no process holds it. */
struct along {
    double *mean, *low, *high; /* of each line along the travel */
    double largest;            /* absolute value */
};

static void
add_row(struct along *a, size_t line, double v, size_t n)
{
    a->mean[line] += v / (double)n;
    a->low[line] = fmin(a->low[line], v);
    a->high[line] = fmax(a->high[line], v);
    a->largest = fmax(a->largest, fabs(v));
}

/* For each line its mean along the travel. largest: the largest deviation from these means, and the largest
 * absolute value; both grow. */
static double *
means(struct tool *t, const struct fatigue_residual *r, struct rc_reader *reader,
      const struct rc_grid *g, char pass, double largest[2])
{
    const bool along_x = pass == 'x';
    const size_t lines = along_x ? g->ny : g->nx, n = along_x ? g->nx : g->ny;
    double *room = tool_room(t, 2 * lines + g->nx, sizeof *room, "the residual stress");
    double *row = room + 2 * lines;
    struct along a = {tool_room(t, lines, sizeof *a.mean, "the residual stress"), room,
                      room + lines, 0};
    size_t count = 0, first = 0;

    for (size_t k = 0; k < lines; k++) {
        a.low[k] = INFINITY;
        a.high[k] = -INFINITY;
    }
    for (size_t j = 0; j < g->ny; j++) {
        if (rc_reader_rows(reader, 1, row, &t->err) != RC_OK)
            tool_die(t, "--residual %s: %s", r->name, t->err.text);
        for (size_t i = 0; i < g->nx; i++) {
            if (!isfinite(row[i]) && count++ == 0)
                first = j * g->nx + i;
            add_row(&a, along_x ? j : i, row[i], n);
        }
    }
    tool_demand_none(t, g, count, first, "recompute the map");
    for (size_t k = 0; k < lines; k++)
        largest[0] =
            fmax(largest[0], fmax(fabs(a.low[k] - a.mean[k]), fabs(a.high[k] - a.mean[k])));
    largest[1] = fmax(largest[1], a.largest);
    free(room);
    return a.mean;
}

/* Reads the rows of a frame that is not needed, because the file may be a pipe. */
static void
pass_over(struct tool *t, const struct fatigue_residual *r, struct rc_reader *reader,
          const struct rc_grid *g)
{
    double *row = tool_room(t, g->nx, sizeof *row, "the residual stress");

    for (size_t j = 0; j < g->ny; j++)
        if (rc_reader_rows(reader, 1, row, &t->err) != RC_OK)
            tool_die(t, "--residual %s: %s", r->name, t->err.text);
    free(row);
}

static void
keep_residual(struct tool *t, struct fatigue_residual *r, struct rc_reader *reader,
              const struct rc_grid *g, char pass, double largest[2])
{
    const int c = component_of(g->channel);
    const size_t lines = pass == 'x' ? g->ny : g->nx;
    double depth;
    size_t k, room;

    if (!rc_grid_number(g, "depth", &depth))
        tool_refuse(t, g, "--residual %s: it has no key depth: a section will not do", r->name);
    if (r->n > 0 && lines != r->lines)
        tool_refuse(t, g, "--residual %s: its maps differ in size", r->name);
    r->lines = lines;
    if ((k = index_of(r, depth)) == r->n) {
        room = r->room;
        for (int i = 0; i < RC_COMPONENTS; i++) {
            room = r->room;
            r->line[i] =
                tool_grown(t, r->line[i], r->n, &room, sizeof(double *), "the residual stress");
            r->line[i][k] = NULL;
        }
        r->depth = tool_grown(t, r->depth, r->n, &r->room, sizeof *r->depth, "the residual stress");
        r->depth[r->n++] = depth;
    }
    free(r->line[c][k]);
    r->line[c][k] = means(t, r, reader, g, pass, largest);
}

void
fatigue_residual_read(struct tool *t, const char *name, char pass, struct fatigue_residual *r)
{
    static const double uniform = 0.1;
    FILE *file = fopen(name, "rb");
    struct rc_reader *reader;
    struct rc_grid *g = NULL;
    enum rc_status status;
    double largest[2] = {0, 0}; /* deviation, stress */

    r->name = name;
    if (file == NULL)
        tool_die(t, "--residual %s: %s", name, strerror(errno));
    if ((reader = rc_reader_new(file, 0, t->memory, &t->err)) == NULL)
        tool_die(t, "--residual %s: %s", name, t->err.text);
    rc_reader_by_rows(reader);
    while ((status = rc_reader_head(reader, &g, &t->err)) == RC_MORE) {
        if (rc_keys_check(g, &t->err) != RC_OK)
            tool_die(t, "--residual %s: %s: correct it with rc-pick --set", name, t->err.text);
        if (component_of(g->channel) < RC_COMPONENTS)
            keep_residual(t, r, reader, g, pass, largest);
        else
            pass_over(t, r, reader, g);
        rc_grid_free(g);
    }
    if (status == RC_FAIL)
        tool_die(t, "--residual %s: %s", name, t->err.text);
    rc_reader_free(reader);
    fclose(file);
    if (r->n == 0)
        tool_die(t,
                 "--residual %s: it holds no stresses: see rc-stress --residual --components "
                 "sxx,syy,szz,sxy,sxz,syz",
                 name);
    if (largest[0] > uniform * largest[1])
        tool_die(
            t,
            "--residual %s: it varies along the travel by %.2g %% of its largest value: more "
            "than 10 %% cannot stay in a body over which the contact travels; cut out the part "
            "that is uniform with rc-pick --crop",
            name, 100 * largest[0] / largest[1]);
}

const double *const *
fatigue_residual_at(struct tool *t, const struct fatigue_residual *r, size_t lines, double depth,
                    const double *at[RC_COMPONENTS])
{
    size_t k;

    if (r->name == NULL)
        return NULL;
    if (lines != r->lines)
        tool_die(t, "--residual %s: it has %zu lines along the travel, and the pressure has %zu",
                 r->name, r->lines, lines);
    if ((k = index_of(r, depth)) == r->n)
        tool_die(t,
                 "--residual %s: it has no stresses at the depth %g m: give both commands the same "
                 "--depths",
                 r->name, depth);
    for (int c = 0; c < RC_COMPONENTS; c++)
        at[c] = r->line[c][k];
    return at;
}

void
fatigue_residual_free(struct fatigue_residual *r)
{
    for (int c = 0; c < RC_COMPONENTS; c++) {
        for (size_t k = 0; k < r->n; k++)
            free(r->line[c][k]);
        free(r->line[c]);
    }
    free(r->depth);
}
