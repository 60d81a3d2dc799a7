/*
 * Columns of reports drawn as curves, with a published law beside them.
 */
#include "render.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    COLUMNS = 16, /* that one picture draws over another */
    SERIES = 64,
    NAME = 256,
    SAMPLES = 200 /* of a law */
};

/* What the columns of the reports are called in a figure, and their unit where the table is JSON,
 * which names none. */
static const struct quantity {
    const char *name, *title, *unit;
} quantities[] = {
    {"load", "Load", "N"},
    {"mean_pressure", "Mean pressure", "Pa"},
    {"max_pressure", "Largest pressure", "Pa"},
    {"contact_nodes", "Nodes in contact", "1"},
    {"nodes_per_patch", "Nodes per patch", "1"},
    {"contact_area", "Contact area", "m2"},
    {"contact_area_corrected", "Contact area, corrected", "m2"},
    {"contact_fraction", "Contact fraction", "1"},
    {"contact_area_inside", "Contact area inside the taper", "m2"},
    {"contact_fraction_inside", "Contact fraction inside the taper", "1"},
    {"plastic_area", "Area at the hardness", "m2"},
    {"yielded_area", "Area that gave way", "m2"},
    {"edge_load_fraction", "Share of the load at the edge", "1"},
    {"approach", "Approach", "m"},
    {"indentation", "Approach from the first touch of all", "m"},
    {"residual_indentation", "Residual indentation", "m"},
    {"mean_gap", "Mean gap", "m"},
    {"stiffness", "Stiffness", "N/m"},
    {"conductance", "Conductance", "1"}, /* W/K or S, as the table says */
    {"iterations", "Iterations", "1"},
    {"convolutions", "Convolutions", "1"},
    {"kkt_residual", "Residual", "1"},
    {"pressure_error_estimate", "Error of the pressure", "1"},
    {"discretization_error_estimate", "Error of the grid", "1"},
    {"flow_rate", "Flow rate", "m3/s"},
    {"flow_conductance", "Flow conductance", "m3"},
    {"flow_conductance_linear", "Flow conductance, linear faces", "m3"},
    {"flow_factor", "Flow factor", "1"},
    {"critical_gap", "Critical gap", "m"},
    {"critical_flow", "Flow of the critical constriction", "m3/s"},
    {"tangential_x", "Force along x", "N"},
    {"tangential_y", "Force along y", "N"},
    {"displacement_x", "Displacement along x", "m"},
    {"displacement_y", "Displacement along y", "m"},
    {"tangential_stiffness", "Tangential stiffness", "N/m"},
    {"stick_area", "Area that sticks", "m2"},
    {"slip_area", "Area that slips", "m2"},
    {"stick_fraction", "Part of the contact that sticks", "1"},
    {"dissipated_energy", "Dissipated energy", "J"},
    {"dissipated_total", "Dissipated energy", "J"},
    {"peak_memory", "Memory", "B"},
    {"depth", "Depth", "m"},
    {"attractive_load", "Load of attraction", "N"},
    {"repulsive_load", "Load of repulsion", "N"},
    {"attractive_area", "Area of attraction", "m2"},
    {"stability", "Stability", "1"},
    {"q", "Wavenumber", "rad/m"},
    {"c", "Power spectral density", "m4"},
};

/* Columns that every table is asked for, after those of the curves. */
enum helper {
    NX,
    NY,
    DX,
    DY,
    ESTAR,
    RADIUS,
    CONVERGED,
    CASE,
    INDENTATION,
    APPROACH,
    JUMPS,
    HELPERS
};
static const char *const helper_name[HELPERS] = {"nx",          "ny",       "dx",        "dy",
                                                 "estar",       "radius",   "converged", "case",
                                                 "indentation", "approach", "jumps"};

struct curves {
    struct tool *tool;
    const struct curve_style *style;
    char *names;                 /* the argument, cut into words */
    const char *column[COLUMNS]; /* the first is x               */
    size_t columns;              /* x and y                      */
    struct table *table;         /* one a file                   */
    size_t tables;
    struct law_given given;
    bool short_of; /* a row is not converged */
    bool history;  /* approaches are counted from the first touch of the first shape */
    struct graph_series series[SERIES];
    char name[SERIES][NAME];
    size_t n;
    double law_x[SAMPLES], law_y[SAMPLES];
    char title[NAME], axis[NAME];
};

/* ---- words ---- */

static const char *
last_part(const char *name)
{
    const char *point = strrchr(name, '.');

    return point == NULL ? name : point + 1;
}

static const struct quantity *
quantity_of(const char *name)
{
    for (size_t k = 0; k < sizeof quantities / sizeof *quantities; k++)
        if (strcmp(quantities[k].name, last_part(name)) == 0)
            return &quantities[k];
    return NULL;
}

static const char *
title_of(const struct curves *c, size_t k)
{
    const char *name = c->column[k];

    if (c->history && strcmp(name, helper_name[APPROACH]) == 0)
        name = helper_name[INDENTATION];
    return quantity_of(name) == NULL ? name : quantity_of(name)->title;
}

/* A spectrum of a profile has a unit of its own. */
static const char *
unit_of(const struct table *table, size_t c)
{
    const struct column *column = &table->column[c];
    const struct quantity *q = quantity_of(column->name);
    const double *ny = table->column[table->columns - HELPERS + NY].v;

    if (column->unit[0] != '\0')
        return column->unit;
    if (strcmp(last_part(column->name), "c") == 0 && ny[0] == 1)
        return "m3";
    return q == NULL ? "1" : q->unit;
}

static const char *
base_name(const char *file)
{
    const char *slash = strrchr(file, '/');

    return slash == NULL ? file : slash + 1;
}

bool
curve_log(const struct curve_style *s, char axis)
{
    return s->log != NULL && (s->log[0] == '\0' || strchr(s->log, axis) != NULL);
}

/* ---- the columns asked for ---- */

static void
split_names(struct curves *c, const char *columns)
{
    const char *wrong = "it must be X:Y or X:Y,Y,..., names of columns";
    char *s;

    if ((c->names = strdup(columns)) == NULL)
        tool_die(c->tool, EXIT_IMPOSSIBLE, "out of memory");
    if ((s = strchr(c->names, ':')) == NULL || strchr(s + 1, ':') != NULL)
        tool_die(c->tool, EXIT_USAGE, "--curve %s: %s", columns, wrong);
    *s = '\0';
    c->column[c->columns++] = c->names;
    for (char *word = s + 1;; word = s + 1) {
        if (c->columns == COLUMNS)
            tool_die(c->tool, EXIT_USAGE, "--curve: more than %d columns over one other",
                     COLUMNS - 1);
        c->column[c->columns++] = word;
        if ((s = strchr(word, ',')) == NULL)
            break;
        *s = '\0';
    }
    for (size_t k = 0; k < c->columns; k++)
        if (*c->column[k] == '\0')
            tool_die(c->tool, EXIT_USAGE, "--curve %s: %s", columns, wrong);
}

static void
read_tables(struct curves *c)
{
    size_t files = c->tool->operands == 0 ? 1 : c->tool->operands;

    if ((c->table = calloc(files, sizeof *c->table)) == NULL)
        tool_die(c->tool, EXIT_IMPOSSIBLE, "out of memory");
    for (size_t f = 0; f < files; f++) {
        struct table *table = &c->table[c->tables++];

        table->columns = c->columns + HELPERS;
        if ((table->column = calloc(table->columns, sizeof *table->column)) == NULL)
            tool_die(c->tool, EXIT_IMPOSSIBLE, "out of memory");
        for (size_t k = 0; k < table->columns; k++) {
            table->column[k].optional = k >= c->columns;
            table->column[k].name = k < c->columns ? c->column[k] : helper_name[k - c->columns];
        }
        table_read(table, c->tool, c->tool->operands == 0 ? "-" : c->tool->operand[f]);
    }
}

static const double *
helper(const struct curves *c, const struct table *table, enum helper which)
{
    return table->column[c->columns + which].v;
}

/* In a history each approach is counted from a shape of its own: over these, work would seem to be
 * gained. */
static void
count_from_one_shape(struct curves *c, struct table *table)
{
    const double *from_first = helper(c, table, INDENTATION);
    bool history = false;

    for (size_t k = 0; k < table->rows; k++)
        history = history || isfinite(from_first[k]);
    for (size_t k = 0; k < c->columns && history; k++)
        if (strcmp(c->column[k], helper_name[APPROACH]) == 0) {
            memcpy(table->column[k].v, from_first, table->rows * sizeof *from_first);
            c->history = true;
        }
}

/* All files and all columns over one axis have one unit. */
static void
check_units(struct curves *c)
{
    for (size_t f = 0; f < c->tables; f++)
        for (size_t k = 0; k < c->columns; k++) {
            const char *here = unit_of(&c->table[f], k);
            size_t first = k == 0 ? 0 : 1;

            if (strcmp(here, unit_of(c->table, first)) != 0)
                tool_die(c->tool, EXIT_IMPOSSIBLE,
                         "%s: %s is in %s, %s in %s: an axis has one unit: draw two pictures",
                         c->table[f].source, c->column[k], here, c->column[first],
                         unit_of(c->table, first));
        }
}

static void
check_convergence(struct curves *c)
{
    size_t n = 0;

    for (size_t f = 0; f < c->tables; f++)
        for (size_t k = 0; k < c->table[f].rows; k++)
            n += helper(c, &c->table[f], CONVERGED)[k] == 0;
    if (n == 0)
        return;
    c->short_of = true;
    tool_warn(c->tool, "%zu of the rows stopped short of their accuracy: the figure says so", n);
    tool_fails_with(c->tool, EXIT_SHORT);
}

/* ---- curves ---- */

static struct graph_series *
new_series(struct curves *c)
{
    if (c->n == SERIES)
        tool_die(c->tool, EXIT_IMPOSSIBLE,
                 "more than %d curves in one picture: name fewer columns "
                 "or files",
                 SERIES - 1);
    c->series[c->n].place = c->n;
    return &c->series[c->n++];
}

static void
add_word(char name[NAME], const char *word)
{
    size_t n = strlen(name);

    snprintf(name + n, NAME - n, "%s%s", n == 0 ? "" : ", ", word);
}

enum stretch {
    LOADING,
    RETRACTION,
    JUMP,
    STRETCHES
};

/* A stretch of a path; `place` is that of the first of its kind, which alone has a name. */
static void
add_stretch(struct curves *c, const double *x, const double *y, size_t n, enum stretch what,
            const char *whose, size_t place[STRETCHES])
{
    static const char *const word[STRETCHES] = {"loading", "retraction", "jump"};
    struct graph_series *s = new_series(c);
    char *name = c->name[c->n - 1];

    if (place[what] == SERIES) {
        place[what] = s->place;
        if (*whose != '\0')
            add_word(name, whose);
        add_word(name, word[what]);
        s->name = name;
    }
    s->place = place[what];
    s->kind = what == JUMP ? GRAPH_LAW : GRAPH_MARKS;
    s->x = x;
    s->y = y;
    s->n = n;
}

/* The path of bodies that attract each other: together, apart, and between the two where they jump. */
static void
add_path(struct curves *c, const struct table *table, size_t k, size_t from, size_t to,
         const char *whose)
{
    const double *at = helper(c, table, APPROACH), *jumps = helper(c, table, JUMPS);
    const double *x = table->column[0].v, *y = table->column[k].v;
    size_t place[STRETCHES] = {SERIES, SERIES, SERIES}, last;

    for (size_t row = from;; row = last) {
        for (last = row; last + 1 < to && !(jumps[last + 1] > 0); last++)
            if (last > row && (at[last + 1] - at[last]) * (at[last] - at[last - 1]) < 0)
                break; /* it turns: the point belongs to both ways */
        add_stretch(c, x + row, y + row, last - row + 1,
                    last > row ? at[last] < at[row] : row > from && at[row] < at[row - 1], whose,
                    place);
        if (last + 1 >= to)
            return;
        if (jumps[last + 1] > 0) {
            add_stretch(c, x + last, y + last, 2, JUMP, whose, place);
            last++;
        }
    }
}

static void
add_curves(struct curves *c, const struct table *table)
{
    for (size_t k = 1; k < c->columns; k++)
        for (size_t p = 0; p < table->pieces; p++) {
            size_t from = table->piece[p],
                   to = p + 1 < table->pieces ? table->piece[p + 1] : table->rows;
            struct graph_series *s;
            char name[NAME] = "", text[64];
            double number = helper(c, table, CASE)[from];

            if (c->tables > 1)
                add_word(name, base_name(table->source));
            if (c->columns > 2)
                add_word(name, title_of(c, k));
            snprintf(text, sizeof text, "%s %.0f", isnan(number) ? "curve" : "case",
                     isnan(number) ? (double)p + 1 : number);
            if (table->pieces > 1)
                add_word(name, text);
            if (*name == '\0' && c->style->law != NULL)
                add_word(name, base_name(table->source));
            if (isfinite(helper(c, table, JUMPS)[from])) {
                add_path(c, table, k, from, to, name);
                continue;
            }
            s = new_series(c);
            memcpy(c->name[c->n - 1], name, NAME);
            s->name = *name == '\0' ? NULL : c->name[c->n - 1];
            s->kind = GRAPH_MARKS;
            s->x = table->column[0].v + from;
            s->y = table->column[k].v + from;
            s->n = to - from;
        }
}

/* ---- laws ---- */

/* A value that the command line does not give, if all tables have the same one; else NAN. */
static double
given_in_tables(struct curves *c, enum helper which, double option)
{
    double value = NAN;

    for (size_t f = 0; isnan(option) && f < c->tables; f++)
        for (size_t k = 0; k < c->table[f].rows; k++) {
            double v = helper(c, &c->table[f], which)[k];

            if (isnan(v))
                continue;
            if (!isnan(value) && fabs(v - value) > 1e-6 * fabs(value))
                tool_die(
                    c->tool, EXIT_IMPOSSIBLE,
                    "%s: %s is not the same in all rows, and a law is for one value: draw them in "
                    "pictures of their own",
                    c->table[f].source, helper_name[which]);
            value = v;
        }
    return isnan(option) ? value : option;
}

static double
area_in_tables(struct curves *c)
{
    double area = NAN;

    for (size_t f = 0; f < c->tables; f++)
        for (size_t k = 0; k < c->table[f].rows; k++) {
            const struct table *t = &c->table[f];
            double a = helper(c, t, NX)[k] * helper(c, t, NY)[k] * helper(c, t, DX)[k] *
                       helper(c, t, DY)[k];

            if (!isnan(area) && fabs(a - area) > 1e-6 * area)
                tool_die(
                    c->tool, EXIT_IMPOSSIBLE,
                    "%s: the maps differ in size, and a law is for one size: draw them in pictures "
                    "of their own",
                    t->source);
            area = isnan(a) ? area : a;
        }
    return area;
}

static void
settle_given(struct curves *c)
{
    const char *law = c->style->law, *lacks;

    c->given = c->style->given;
    c->given.estar = given_in_tables(c, ESTAR, c->given.estar);
    c->given.radius = given_in_tables(c, RADIUS, c->given.radius);
    c->given.area = area_in_tables(c);
    if ((lacks = law_lacks(law, &c->given)) != NULL)
        tool_die(c->tool, EXIT_USAGE, "--law %s needs %s: give it", law, lacks);
}

/* The law over the x that there are. Dashes tell it from points, its name comes last. */
static void
add_law(struct curves *c)
{
    const char *law = c->style->law, *x = last_part(c->column[0]), *y = last_part(c->column[1]);
    bool log = curve_log(c->style, 'x');
    double lo = INFINITY, hi = -INFINITY;
    struct graph_series *s;

    if (c->columns > 2 || !law_knows(law, x, y))
        tool_die(c->tool, EXIT_USAGE, "--law %s: it ties %s%s, not what --curve asks for", law,
                 law_quantities(law), c->columns > 2 ? ", one at a time" : "");
    settle_given(c);
    if (law_needs_area(law, &c->given, x, y) && isnan(c->given.area))
        tool_die(c->tool, EXIT_IMPOSSIBLE,
                 "--law %s: for %s over %s it needs the area of the map, the columns nx, ny, dx "
                 "and dy",
                 law, y, x);
    for (size_t f = 0; f < c->tables; f++)
        for (size_t k = 0; k < c->table[f].rows; k++) {
            double v = c->table[f].column[0].v[k];

            if (isfinite(v) && (v > 0 || !log)) {
                lo = fmin(lo, v);
                hi = fmax(hi, v);
            }
        }
    if (!log)
        lo = lo > 0 && lo < 0.3 * hi ? 0 : lo; /* where the axis begins */
    for (int k = 0; k < SAMPLES; k++) {
        double t = (double)k / (SAMPLES - 1);

        c->law_x[k] = log ? lo * pow(hi / lo, t) : lo + t * (hi - lo);
        c->law_y[k] = law_value(law, &c->given, x, c->law_x[k], y);
    }
    s = new_series(c);
    *s = (struct graph_series){
        .name = law_title(law), .kind = GRAPH_LAW, .x = c->law_x, .y = c->law_y, .n = SAMPLES};
}

/* ---- the whole ---- */

static void
describe(struct curves *c)
{
    char *x = c->title;

    for (size_t k = 1; k < c->columns; k++) {
        size_t n = strlen(c->axis);

        add_word(c->axis, title_of(c, k));
        if (k > 1 && quantity_of(c->column[k]) != NULL)
            c->axis[n + 2] = (char)tolower((unsigned char)c->axis[n + 2]);
    }
    snprintf(c->title, NAME, "%.150s against ", c->axis);
    x += strlen(x);
    snprintf(x, NAME - (size_t)(x - c->title), "%.90s", title_of(c, 0));
    if (quantity_of(c->column[0]) != NULL)
        *x = (char)tolower((unsigned char)*x);
}

static struct canvas *
draw(struct curves *c, struct drawn *drawn)
{
    const struct graph graph = {
        .title = drawn->title,
        .subtitle = drawn->source,
        .stamp = drawn->stamp,
        .x = {title_of(c, 0), unit_of(c->table, 0), curve_log(c->style, 'x'), NAN, NAN},
        .y = {c->axis, unit_of(c->table, 1), curve_log(c->style, 'y'), NAN, NAN},
        .series = c->series,
        .n = c->n,
        .width = c->style->width,
        .dpi = c->style->dpi,
        .family = c->style->family,
    };
    struct canvas *canvas;
    struct rc_err err;
    size_t bytes;

    if (graph_memory(&graph, &bytes, &err) != RC_OK ||
        tool_ask_memory(c->tool, NULL, bytes, "give fewer rows", &err) != RC_OK)
        tool_die(c->tool, EXIT_IMPOSSIBLE, "%s", err.text);
    if ((canvas = graph_draw(&graph, &err)) == NULL)
        tool_die(c->tool, EXIT_IMPOSSIBLE, "%s", err.text);
    return canvas;
}

static void
curves_free(struct curves *c)
{
    for (size_t f = 0; f < c->tables; f++) {
        table_free(&c->table[f]);
        free(c->table[f].column);
    }
    free(c->table);
    free(c->names);
    free(c);
}

struct canvas *
curves_draw(struct tool *t, const char *columns, const struct curve_style *style,
            struct drawn *drawn)
{
    struct curves *c = calloc(1, sizeof *c);
    struct canvas *canvas;

    if (c == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "out of memory");
    c->tool = t;
    c->style = style;
    split_names(c, columns);
    read_tables(c);
    for (size_t f = 0; f < c->tables; f++)
        count_from_one_shape(c, &c->table[f]);
    check_units(c);
    check_convergence(c);
    for (size_t f = 0; f < c->tables; f++)
        add_curves(c, &c->table[f]);
    if (style->law != NULL)
        add_law(c);
    describe(c);
    snprintf(drawn->title, sizeof drawn->title, "%s",
             style->title == NULL ? c->title : style->title);
    snprintf(drawn->source, sizeof drawn->source, "%s",
             c->tables > 1 ? "" : base_name(c->table->source));
    drawn->stamp = c->short_of ? "not converged" : NULL;
    canvas = draw(c, drawn);
    curves_free(c);
    return canvas;
}
