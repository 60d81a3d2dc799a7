/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Columns of reports drawn as curves, with a published law beside them.
 */
#include "render.h"

#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum {
    COLUMNS = 16, /* most columns over one other in a picture */
    SERIES = 64,
    WORDS = 40, /* most categories of an axis */
    NAME = 256,
    SAMPLES = 200 /* samples of a law */
};

/* Columns that are read from every table, after those of the curves. */
enum helper {
    NX,
    NY,
    DX,
    DY,
    ESTAR,
    RADIUS,
    SLOPE,
    CONVERGED,
    CASE,
    INDENTATION,
    RESIDUAL,
    APPROACH,
    JUMPS,
    SPEED,
    SOURCE, /* these two are words that distinguish pieces */
    LOAD,
    SEPARATED,
    TIME,
    PULL_OFF,
    HELPERS
};
static const char *const helper_name[HELPERS] = {"nx",
                                                 "ny",
                                                 "dx",
                                                 "dy",
                                                 "estar",
                                                 "radius",
                                                 "rms_slope",
                                                 "converged",
                                                 "case",
                                                 "indentation",
                                                 "residual_indentation",
                                                 "approach",
                                                 "jumps",
                                                 "speed",
                                                 "source",
                                                 "load",
                                                 "separated",
                                                 "time",
                                                 "pull_off_load"};

/* The columns of the command line. */
struct choice {
    char *names;                 /* the argument, divided into words */
    const char *column[COLUMNS]; /* the first is x               */
    size_t columns;              /* x and y                      */
    char *by_names, *error_names;
    const char *by[GROUP_COLUMNS], *error[COLUMNS];
    size_t bys, errors;
    size_t asked; /* all of the requested columns; those above follow them */
};

/* Points that are means of rows. */
struct averages {
    double *own[SERIES];
    size_t n, fewest, most; /* rows in such a point */
};

struct law_line {
    struct law_given given;
    double x[SAMPLES], y[SAMPLES];
};

struct curves {
    struct tool *tool;
    const struct curve_style *style;
    struct choice choice;
    struct table *table; /* one a file                   */
    size_t tables;
    struct law_line law;
    bool short_of;           /* a row is not converged */
    bool zigzag;             /* a warning about a line that turns back was printed */
    bool history;            /* approaches count from the first touch of the initial shape */
    const char *word[WORDS]; /* words of x, if it has categories: for 0, 1, ... */
    size_t words;
    struct graph_series series[SERIES];
    char name[SERIES][NAME], note[NAME];
    struct averages means;
    char title[NAME], axis[NAME];
};

/* ---- words ---- */

static const char *
last_part(const char *name)
{
    const char *point = strrchr(name, '.');

    return point == NULL ? name : point + 1;
}

/* A known column, with its title and unit; NULL for another one. */
static const struct rc_figure *
figure_of(const char *name)
{
    return report_figure(last_part(name));
}

/* The title inside a sentence; E*, RMS and names of parameters, such as Sq, keep their capitals. */
static void
begin_small(char *title)
{
    static const char *const named[] = {"areal", "features", "profile"};

    for (size_t t = 0; t < sizeof named / sizeof *named; t++)
        for (const struct rc_figure *f = rc_figures(named[t]); f->name != NULL; f++)
            if (strcmp(f->title, title) == 0)
                return;
    if (islower((unsigned char)title[1]))
        title[0] = (char)tolower((unsigned char)title[0]);
}

static const char *
title_of(const struct choice *choice, bool history, size_t k)
{
    const char *name = choice->column[k];

    if (history && strcmp(name, helper_name[APPROACH]) == 0)
        name = helper_name[INDENTATION];
    return figure_of(name) == NULL ? name : figure_of(name)->title;
}

/* A spectrum of a profile has a different unit. */
static const char *
unit_of(const struct table *table, size_t c)
{
    const struct column *column = &table->column[c];
    const struct rc_figure *known = figure_of(column->name);
    const double *ny = table->column[table->columns - HELPERS + NY].v;

    if (column->unit[0] != '\0')
        return column->unit;
    if (strcmp(last_part(column->name), "c") == 0 && ny[0] == 1)
        return "m3";
    return known == NULL || known->unit == NULL ? "1" : known->unit;
}

static const char *
base_name(const char *file)
{
    const char *slash = strrchr(file, '/');

    return slash == NULL ? file : slash + 1;
}

static void
add_word(char name[NAME], const char *word)
{
    size_t n = strlen(name);

    snprintf(name + n, NAME - n, "%s%.250s", n == 0 ? "" : ", ", word);
}

/* ---- the columns asked for ---- */

/* Divides a list at its commas into names, after the n names of `word`. text: the argument of the option. */
static void
split_list(struct tool *tool, const char *option, const char *text, const char *must, char *list,
           const char **word, size_t most, size_t *n)
{
    for (char *s = list, *comma; s != NULL; s = comma) {
        if ((comma = strchr(s, ',')) != NULL)
            *comma++ = '\0';
        if (*s == '\0' || *n == most)
            tool_usage(tool, "--%s %s: it must be %s, %zu at most", option, text, must, most);
        word[(*n)++] = s;
    }
}

static void
split_names(struct curves *c, const char *columns)
{
    static const char must[] = "X:Y or X:Y,Y,..., names of columns";
    char *colon;

    c->choice.names = tool_copy(c->tool, columns);
    if ((colon = strchr(c->choice.names, ':')) == NULL || colon == c->choice.names ||
        strchr(colon + 1, ':'))
        tool_usage(c->tool, "--curve %s: it must be %s", columns, must);
    *colon = '\0';
    c->choice.column[c->choice.columns++] = c->choice.names;
    split_list(c->tool, "curve", columns, must, colon + 1, c->choice.column, COLUMNS,
               &c->choice.columns);
}

static void
split_options(struct curves *c)
{
    const struct curve_style *s = c->style;

    if (s->by != NULL)
        split_list(c->tool, "by", s->by, "names of columns",
                   c->choice.by_names = tool_copy(c->tool, s->by), c->choice.by, GROUP_COLUMNS,
                   &c->choice.bys);
    if (s->error != NULL)
        split_list(c->tool, "error", s->error, "names of columns",
                   c->choice.error_names = tool_copy(c->tool, s->error), c->choice.error, COLUMNS,
                   &c->choice.errors);
    if (c->choice.errors > 0 && c->choice.errors != c->choice.columns - 1)
        tool_usage(c->tool, "--error %s: it must be one column for each of --curve", s->error);
    c->choice.asked = c->choice.columns + c->choice.bys + c->choice.errors;
}

static const char *
asked_name(const struct choice *choice, size_t k)
{
    return k < choice->columns                 ? choice->column[k]
           : k < choice->columns + choice->bys ? choice->by[k - choice->columns]
                                               : choice->error[k - choice->columns - choice->bys];
}

static bool
is_label(const struct choice *choice, size_t k)
{
    return (k >= choice->columns && k < choice->columns + choice->bys) ||
           k == choice->asked + SOURCE || k == choice->asked + LOAD ||
           k == choice->asked + SEPARATED;
}

static void
read_tables(struct curves *c)
{
    size_t files = c->tool->operands == 0 ? 1 : c->tool->operands;

    c->table = tool_room(c->tool, files, sizeof *c->table, "a table");
    for (size_t f = 0; f < files; f++) {
        struct table *table = &c->table[c->tables++];

        table->columns = c->choice.asked + HELPERS;
        table->column = tool_room(c->tool, table->columns, sizeof *table->column, "a table");
        for (size_t k = 0; k < table->columns; k++) {
            table->column[k].optional = k >= c->choice.asked;
            table->column[k].either = k == 0;
            table->column[k].label = is_label(&c->choice, k);
            table->column[k].name =
                k < c->choice.asked ? asked_name(&c->choice, k) : helper_name[k - c->choice.asked];
        }
        table_read(table, c->tool, c->tool->operands == 0 ? "-" : c->tool->operand[f]);
    }
}

static const double *
helper(const struct curves *c, const struct table *table, enum helper which)
{
    return table->column[c->choice.asked + which].v;
}

/* True for a row of a history: it has a residual indentation, or the indentation is not the approach.
 * Each speed of sliding is a case of its own. */
static bool
is_history(const struct curves *c, const struct table *table, size_t k)
{
    const double indentation = helper(c, table, INDENTATION)[k];

    return isfinite(indentation) && isnan(helper(c, table, SPEED)[k]) &&
           (isfinite(helper(c, table, RESIDUAL)[k]) ||
            indentation != helper(c, table, APPROACH)[k]);
}

/* In a history each approach counts from the current shape; in a curve over these approaches work would seem
 * to be gained. */
static void
count_from_one_shape(struct curves *c, struct table *table)
{
    const double *from_first = helper(c, table, INDENTATION);
    bool history = false;

    for (size_t k = 0; k < table->rows; k++)
        history = history || is_history(c, table, k);
    c->history = c->history || history;
    for (size_t k = 0; k < c->choice.columns && history; k++)
        if (strcmp(c->choice.column[k], helper_name[APPROACH]) == 0)
            memcpy(table->column[k].v, from_first, table->rows * sizeof *from_first);
}

/* Checks that all columns of one axis in all files have the same unit. */
static void
check_units(struct curves *c)
{
    for (size_t f = 0; f < c->tables; f++)
        for (size_t k = 0; k < c->choice.columns; k++) {
            const char *here = unit_of(&c->table[f], k);
            size_t first = k == 0 ? 0 : 1;

            if (strcmp(here, unit_of(c->table, first)) != 0)
                tool_die(c->tool,
                         "%s: %s is in %s, %s in %s: an axis has one unit: draw two pictures",
                         c->table[f].source, c->choice.column[k], here, c->choice.column[first],
                         unit_of(c->table, first));
        }
}

/* The word of a row in a column of labels; NULL: none. */
static const char *
word_of(const struct table *table, size_t column, size_t row)
{
    double v = table->column[column].v[row];

    return isnan(v) ? NULL : table->column[column].word[(size_t)v];
}

/* True if the bodies are apart in this row: its force and area are 0, and its approach is unknown. */
static bool
is_separated(const struct curves *c, const struct table *table, size_t row)
{
    const char *word = word_of(table, c->choice.asked + SEPARATED, row);

    return word != NULL && strcmp(word, "yes") == 0;
}

static void
check_convergence(struct curves *c)
{
    size_t n = 0, apart = 0;

    for (size_t f = 0; f < c->tables; f++)
        for (size_t k = 0; k < c->table[f].rows; k++)
            if (helper(c, &c->table[f], CONVERGED)[k] == 0)
                (*(is_separated(c, &c->table[f], k) ? &apart : &n))++;
    if (n + apart == 0)
        return;
    c->short_of = n > 0;
    if (n > 0)
        tool_warn(c->tool, "%zu of the rows stopped short of their accuracy: the figure says so",
                  n);
    if (apart > 0)
        tool_warn(c->tool,
                  "in %zu of the rows the bodies have separated, because no state carries the load",
                  apart);
    tool_fails_with(c->tool, EXIT_SHORT);
}

/* ---- groups of rows ---- */

/* True if rows of a table come from several sources with several rows each: a line through all of them would
 * have no meaning. */
static bool
has_sources(size_t asked, const struct table *table)
{
    const struct column *source = &table->column[asked + SOURCE];
    size_t rows[SERIES] = {0};

    if (table->pieces > 1 || source->word_count < 2 || source->word_count >= SERIES)
        return false;
    for (size_t k = 0; k < table->rows; k++) {
        if (isnan(source->v[k]))
            return false;
        rows[(size_t)source->v[k]]++;
    }
    for (size_t w = 0; w < source->word_count; w++)
        if (rows[w] < 2)
            return false;
    return true;
}

/* Each case is a curve if x goes one way in every case and begins anew in the next one, as depths do. */
static void
split_cases(struct curves *c, struct table *table)
{
    const double *x = table->column[0].v, *number = helper(c, table, CASE);
    size_t *piece, pieces = 1, k = 1;
    double way = 0;

    if (table->pieces > 1 || table->rows < 4)
        return;
    piece = tool_room(c->tool, table->rows, sizeof *piece, "a table");
    piece[0] = 0;
    for (; k < table->rows && isfinite(number[k]); k++) {
        const double step = x[k] - x[k - 1];
        if (number[k] == number[k - 1]) {
            way = way == 0 ? step : way;
            if (!(step * way > 0))
                break;
        } else {
            if (k - piece[pieces - 1] < 2 || !(step * way < 0))
                break;
            piece[pieces++] = k;
        }
    }
    if (k < table->rows || pieces == 1 || table->rows - piece[pieces - 1] < 2) {
        free(piece);
        return;
    }
    free(table->piece);
    table->piece = piece;
    table->pieces = pieces;
}

static void
group_rows(struct curves *c, struct table *table)
{
    const size_t by[GROUP_COLUMNS] = {c->choice.columns, c->choice.columns + 1},
                 source = c->choice.asked + SOURCE;

    if (c->choice.bys > 0 || c->style->spread)
        groups_sort(table, c->tool, by, c->choice.bys, !c->style->spread);
    else if (has_sources(c->choice.asked, table))
        groups_sort(table, c->tool, &source, 1, true);
    else
        split_cases(c, table);
}

/* True if the first rows of all pieces have words in that column, and these are not all equal. */
static bool
tells_pieces(const struct table *table, size_t column)
{
    bool differ = false;

    for (size_t p = 0; p < table->pieces; p++) {
        if (word_of(table, column, table->piece[p]) == NULL)
            return false;
        differ = differ || strcmp(word_of(table, column, table->piece[p]),
                                  word_of(table, column, table->piece[0])) != 0;
    }
    return differ;
}

/* "load 10 N", "rough.x3p", "boundary free". */
static void
say_label(const struct table *table, size_t k, size_t row, char text[NAME])
{
    const struct column *column = &table->column[k];
    const struct rc_figure *known = figure_of(column->name);
    const char *unit = unit_of(table, k), *end;
    const char *word = word_of(table, k, row);
    char title[NAME];
    double number;

    snprintf(title, sizeof title, "%s", known == NULL ? last_part(column->name) : known->title);
    begin_small(title);
    end = word == NULL ? NULL : rc_number_read(word, true, &number);
    if (word != NULL && strcmp(last_part(column->name), helper_name[SOURCE]) == 0)
        snprintf(text, NAME, "%s", base_name(word));
    else if (end == NULL || *end != '\0')
        snprintf(text, NAME, "%.120s %.120s", title, word == NULL ? "unknown" : word);
    else
        snprintf(text, NAME, "%.120s %.100s", title,
                 strcmp(unit, "1") == 0 ? word : scale_value(number, unit));
}

static void
say_piece(const struct curves *c, const struct table *table, size_t p, char text[NAME])
{
    double number = helper(c, table, CASE)[table->piece[p]];
    size_t row = table->piece[p];
    char word[NAME];

    *text = '\0';
    for (size_t b = 0; b < c->choice.bys; b++) {
        say_label(table, c->choice.columns + b, row, word);
        add_word(text, word);
    }
    for (size_t h = SOURCE; *text == '\0' && h <= LOAD; h++)
        if (tells_pieces(table, c->choice.asked + h))
            say_label(table, c->choice.asked + h, row, text);
    if (*text == '\0')
        snprintf(text, NAME, "%s %.0f", isnan(number) ? "curve" : "case",
                 isnan(number) ? (double)p + 1 : number);
}

/* The index of a word among those of all tables, from 0. */
static size_t
word_number(const struct curves *c, size_t column, const char *word)
{
    size_t n = 0;

    for (size_t f = 0; f < c->tables; f++)
        for (size_t w = 0; w < c->table[f].column[column].word_count; w++) {
            const char *other = c->table[f].column[column].word[w];
            bool before = false;

            if (word != NULL && strcmp(other, word) == 0)
                return n;
            for (size_t e = 0; e < f && !before; e++)
                for (size_t v = 0; v < c->table[e].column[column].word_count && !before; v++)
                    before = strcmp(c->table[e].column[column].word[v], other) == 0;
            n += !before;
        }
    return n;
}

/* Words in the x column are numbered across all tables. */
static void
take_words(struct curves *c)
{
    for (size_t f = 0; f < c->tables; f++) {
        struct column *x = &c->table[f].column[0];

        if (x->numbers != c->table[0].column[0].numbers)
            tool_die(c->tool, "%s: column %s holds %s, that of %s %s: draw two pictures",
                     c->table[f].source, x->name, x->numbers ? "numbers" : "words",
                     c->table[0].source, x->numbers ? "words" : "numbers");
        if (x->numbers)
            continue;
        if (wording_log(c->style, 'x'))
            tool_usage(c->tool,
                       "--log: column %s contains words, which have no logarithm: give the other "
                       "axis alone, as in --log y",
                       x->name);
        for (size_t w = 0; w < x->word_count; w++) {
            size_t number = word_number(c, 0, x->word[w]);

            if (number >= WORDS)
                tool_die(c->tool,
                         "column %s holds more than %d different words, too many for an axis",
                         x->name, WORDS);
            c->word[number] = x->word[w];
            c->words = number + 1 > c->words ? number + 1 : c->words;
        }
        for (size_t row = 0; row < c->table[f].rows; row++)
            if (!isnan(x->v[row]))
                x->v[row] = (double)word_number(c, 0, x->word[(size_t)x->v[row]]);
    }
}

/* ---- curves ---- */

static struct graph_series *
new_series(struct curves *c)
{
    if (c->means.n == SERIES)
        tool_die(c->tool,
                 "more than %d curves in one picture: name fewer columns "
                 "or files, or a --by of fewer values",
                 SERIES - 1);
    c->series[c->means.n].place = c->means.n;
    return &c->series[c->means.n++];
}

enum stretch {
    LOADING,
    UNLOADING,
    JUMP,
    STRETCHES
};

/* The column whose change gives the direction of a path: the indentation in a history. */
static const double *
way_of(const struct curves *c, const struct table *table, size_t from)
{
    return helper(c, table, is_history(c, table, from) ? INDENTATION : APPROACH);
}

/* True for the row of a pull-off, an additional case on a retraction of its own. */
static bool
is_pull_off(const struct curves *c, const struct table *table, size_t row)
{
    return isfinite(helper(c, table, PULL_OFF)[row]);
}

/* The direction from each row of a path to the next. */
static enum stretch *
find_steps(struct curves *c, const struct table *table, size_t from, size_t to)
{
    const double *at = way_of(c, table, from), *jumps = helper(c, table, JUMPS);
    enum stretch *step = tool_room(c->tool, to - from + 1, sizeof *step, "a curve");
    const double rounding = 1e-9;

    for (size_t k = 1; k < to - from; k++) {
        double here = at[from + k], last = at[from + k - 1];

        if (jumps[from + k] > 0 || is_separated(c, table, from + k) ||
            is_separated(c, table, from + k - 1) || is_pull_off(c, table, from + k))
            step[k] = JUMP;
        else if (fabs(here - last) > rounding * fmax(fabs(here), fabs(last)))
            step[k] = here < last ? UNLOADING : LOADING;
        else
            step[k] = step[k - 1] == JUMP ? LOADING : step[k - 1];
    }
    return step;
}

/* True if a stretch has a point, or a jump a line. */
static bool
is_drawn(const double *x, const double *y, size_t n, bool line)
{
    for (size_t k = 0; k + line < n; k++)
        if (isfinite(x[k] + y[k]) && isfinite(x[k + line] + y[k + line]))
            return true;
    return false;
}

/* Divides a path into stretches with one direction, with gaps between them; a single row between jumps
 * belongs to the stretch before it. */
static void
add_stretches(struct curves *c, const double *x, const double *y, const double *at,
              const enum stretch *step, size_t rows, enum stretch what, const char *name)
{
    double *v = tool_room(c->tool, 4 * rows, sizeof *v, "a curve");
    struct graph_series *s;
    size_t n = 0;

    for (size_t k = 0; k < rows; k++) {
        bool to = k > 0 && step[k] == what, on = k + 1 < rows && step[k + 1] == what;
        bool alone = (k == 0 || step[k] == JUMP) && (k + 1 == rows || step[k + 1] == JUMP);
        /* separated bodies have no approach */
        bool apart = isnan(at[k]) || (k > 0 && at[k] < at[k - 1]);

        if (!to && !on && !(alone && what == (apart ? UNLOADING : LOADING)))
            continue;
        if (n > 0 && !to) {
            v[n] = NAN;
            v[2 * rows + n++] = NAN;
        }
        v[n] = x[k];
        v[2 * rows + n++] = y[k];
    }
    if (!is_drawn(v, v + 2 * rows, n, what == JUMP)) {
        free(v);
        return;
    }
    s = new_series(c);
    c->means.own[c->means.n - 1] = v;
    snprintf(c->name[c->means.n - 1], NAME, "%s", name);
    s->name = c->name[c->means.n - 1];
    s->kind = what == JUMP ? GRAPH_LAW : GRAPH_MARKS;
    s->x = v;
    s->y = v + 2 * rows;
    s->n = n;
}

/* True if a piece is a path: bodies that attract each other, or loads in sequence with unloading. */
static bool
is_path(struct curves *c, const struct table *table, size_t from, size_t to)
{
    bool unloads = false;
    enum stretch *step;

    if (c->style->spread || c->style->points || c->choice.errors > 0 || c->words > 0 ||
        to - from < 2)
        return false;
    if (isfinite(helper(c, table, JUMPS)[from]))
        return true;
    if (!is_history(c, table, from) || c->choice.bys == GROUP_COLUMNS)
        return false;
    step = find_steps(c, table, from, to);
    for (size_t k = 1; k < to - from; k++)
        unloads = unloads || step[k] == UNLOADING;
    free(step);
    return unloads;
}

static void
add_path(struct curves *c, const struct table *table, size_t k, size_t from, size_t to,
         const char *whose)
{
    const double *at = way_of(c, table, from), *x = table->column[0].v, *y = table->column[k].v;
    const char *back = at == helper(c, table, APPROACH) ? "retraction" : "unloading";
    const char *const word[STRETCHES] = {"loading", back, "jump"};
    enum stretch *step = find_steps(c, table, from, to);

    for (enum stretch what = LOADING; what < STRETCHES; what++) {
        char name[NAME] = "";

        if (*whose != '\0')
            add_word(name, whose);
        add_word(name, word[what]);
        add_stretches(c, x + from, y + from, at + from, step, to - from, what, name);
    }
    free(step);
}

/* The points themselves, or the means of points with the same x, and their bars. */
static void
set_points(struct curves *c, const struct table *table, size_t k, size_t from, size_t to,
           struct graph_series *s)
{
    const double *x = table->column[0].v + from, *y = table->column[k].v + from, *error;
    struct spread spread;
    double *bars;

    s->x = x;
    s->y = y;
    s->n = to - from;
    if (c->style->spread) {
        spread_take(&spread, c->tool, x, y, s->n);
        c->means.own[c->means.n - 1] = spread.x;
        c->means.fewest = spread.least < c->means.fewest ? spread.least : c->means.fewest;
        c->means.most = spread.most > c->means.most ? spread.most : c->means.most;
        s->x = spread.x;
        s->y = spread.y;
        s->low = spread.low;
        s->high = spread.high;
        s->n = spread.n;
    } else if (c->choice.errors > 0) {
        error = table->column[c->choice.columns + c->choice.bys + k - 1].v + from;
        bars = tool_room(c->tool, 2 * s->n, sizeof *bars, "error bars");
        for (size_t i = 0; i < s->n; i++) {
            bars[i] = y[i] - fabs(error[i]);
            bars[s->n + i] = y[i] + fabs(error[i]);
        }
        c->means.own[c->means.n - 1] = bars;
        s->low = bars;
        s->high = bars + s->n;
    }
}

/* A line through rows whose x goes back and forth, for example from several seeds at the same loads, is not a
 * curve. Loading and unloading has one reversal. */
static void
warn_of_zigzag(struct curves *c, const struct table *table, size_t from, size_t to)
{
    const double *x = table->column[0].v;
    double way = 0, last = NAN;
    size_t turns = 0;

    if (c->history || c->style->spread || c->style->points || c->words > 0 || c->zigzag)
        return;
    for (size_t k = from; k < to; k++) {
        if (!isfinite(x[k]))
            continue;
        if (way * (x[k] - last) < 0)
            turns++;
        way = isnan(last) || x[k] == last ? way : x[k] - last;
        last = x[k];
    }
    c->zigzag = turns > 2;
    if (c->zigzag)
        tool_warn(c->tool,
                  "%s: the line turns back %zu times along %s: --spread makes a point of rows that "
                  "share it, --by COLUMN a curve of each group, --points leaves out the line",
                  table->source, turns, c->choice.column[0]);
}

/* Takes the pull-offs out of a curve, because no line may join them: points, y after `to - from` x, and
 * their number. NULL: none, or points that are averaged. */
static double *
take_pull_offs(struct curves *c, const struct table *table, size_t k, size_t from, size_t to,
               size_t *n)
{
    const double *x = table->column[0].v;
    double *y = table->column[k].v, *v = NULL;

    *n = 0;
    for (size_t row = from; row < to && !c->style->spread; row++) {
        if (!is_pull_off(c, table, row))
            continue;
        v = v == NULL ? tool_room(c->tool, 2 * (to - from), sizeof *v, "a curve") : v;
        v[*n] = x[row];
        v[to - from + (*n)++] = y[row];
        y[row] = NAN;
    }
    return v;
}

static void
add_pull_offs(struct curves *c, double *v, size_t n, size_t room, const char *whose)
{
    struct graph_series *s = new_series(c);
    char *name = c->name[c->means.n - 1];

    c->means.own[c->means.n - 1] = v;
    snprintf(name, NAME, "%s", whose);
    add_word(name, "pull-off");
    s->name = name;
    s->kind = GRAPH_POINTS;
    s->x = v;
    s->y = v + room;
    s->n = n;
}

static void
add_line(struct curves *c, const struct table *table, size_t k, size_t from, size_t to,
         const char *name)
{
    struct graph_series *s;

    warn_of_zigzag(c, table, from, to);
    s = new_series(c);
    snprintf(c->name[c->means.n - 1], NAME, "%s", name);
    s->name = *name == '\0' ? NULL : c->name[c->means.n - 1];
    s->kind = c->style->points || c->words > 0 ? GRAPH_POINTS : GRAPH_MARKS;
    if (c->choice.bys == GROUP_COLUMNS) {
        s->place = word_number(c, c->choice.columns, word_of(table, c->choice.columns, from));
        s->mark =
            1 + word_number(c, c->choice.columns + 1, word_of(table, c->choice.columns + 1, from));
    }
    set_points(c, table, k, from, to, s);
}

static void
add_curve(struct curves *c, const struct table *table, size_t k, size_t p)
{
    size_t from = table->piece[p], to = p + 1 < table->pieces ? table->piece[p + 1] : table->rows;
    size_t pulled;
    double *pull_off;
    char name[NAME] = "", text[NAME];

    if (c->tables > 1)
        add_word(name, base_name(table->source));
    if (c->choice.columns > 2)
        add_word(name, title_of(&c->choice, c->history, k));
    if (table->pieces > 1 || c->choice.bys > 0) {
        say_piece(c, table, p, text);
        add_word(name, text);
    }
    if (*name == '\0' && c->style->law != NULL)
        add_word(name, base_name(table->source));
    pull_off = take_pull_offs(c, table, k, from, to, &pulled);
    if (is_path(c, table, from, to))
        add_path(c, table, k, from, to, name);
    else if (pulled < to - from)
        add_line(c, table, k, from, to, name);
    if (pulled > 0)
        add_pull_offs(c, pull_off, pulled, to - from, name);
}

static void
add_curves(struct curves *c, const struct table *table)
{
    for (size_t k = 1; k < c->choice.columns; k++)
        for (size_t p = 0; p < table->pieces; p++)
            add_curve(c, table, k, p);
}

/* Describes the bars. */
static void
say_bars(struct curves *c)
{
    char rows[64];

    if (c->style->spread && c->means.most > 1) {
        snprintf(rows, sizeof rows, c->means.fewest == c->means.most ? "%zu" : "%zu to %zu",
                 c->means.fewest, c->means.most);
        snprintf(c->note, NAME,
                 "means of the rows that share %.80s (%s each) · bars: their standard deviation",
                 c->choice.column[0], rows);
    }
    for (size_t k = 0; k < c->choice.errors; k++) {
        size_t n = strlen(c->note);

        snprintf(c->note + n, NAME - n, "%s%.60s", n == 0 ? "bars: ± " : ", ", c->choice.error[k]);
    }
}

/* ---- laws ---- */

/* A value that is missing on the command line, if all rows of the tables have the same one; else NAN. */
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
                tool_die(c->tool,
                         "%s: %s is not the same in all rows, but a law needs one value: draw "
                         "separate pictures",
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
                    c->tool,
                    "%s: the maps differ in size, but a law needs one size: draw separate pictures",
                    t->source);
            area = isnan(a) ? area : a;
        }
    return area;
}

/* True if the rows of a report are times, of creep or of a seal that relaxes. */
static bool
has_times(const struct curves *c)
{
    for (size_t f = 0; f < c->tables; f++)
        for (size_t k = 0; k < c->table[f].rows; k++)
            if (isfinite(helper(c, &c->table[f], TIME)[k]))
                return true;
    return false;
}

static void
settle_given(struct curves *c)
{
    const char *law = c->style->law, *lacks;

    c->law.given = c->style->given;
    if (isnan(c->law.given.estar) && has_times(c))
        tool_usage(c->tool,
                   "--law %s: the rows have times, as those of a viscoelastic body have, and their "
                   "estar is that of fast loads: give the modulus of these times with --estar",
                   law);
    c->law.given.estar = given_in_tables(c, ESTAR, c->law.given.estar);
    c->law.given.radius = given_in_tables(c, RADIUS, c->law.given.radius);
    if (strcmp(law, "persson") == 0)
        c->law.given.rms_slope = given_in_tables(c, SLOPE, c->law.given.rms_slope);
    c->law.given.area = area_in_tables(c);
    if ((lacks = law_lacks(law, &c->law.given)) != NULL)
        tool_usage(c->tool, "--law %s needs %s: give it", law, lacks);
}

/* The law over the range of x. It is dashed, and its name comes last. */
static void
add_law(struct curves *c)
{
    const char *law = c->style->law, *x = last_part(c->choice.column[0]),
               *y = last_part(c->choice.column[1]);
    bool log = wording_log(c->style, 'x');
    double lo = INFINITY, hi = -INFINITY;
    struct graph_series *s;

    if (c->choice.columns > 2 || !law_knows(law, x, y))
        tool_usage(c->tool, "--law %s relates %s%s, which --curve does not draw", law,
                   law_named(law)->says, c->choice.columns > 2 ? ", one at a time" : "");
    settle_given(c);
    if (law_needs_area(law, &c->law.given, x, y) && isnan(c->law.given.area))
        tool_die(c->tool,
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
        lo = lo > 0 && lo < 0.3 * hi ? 0 : lo; /* the start of the axis */
    for (int k = 0; k < SAMPLES; k++) {
        double t = (double)k / (SAMPLES - 1);

        c->law.x[k] = log ? lo * pow(hi / lo, t) : lo + t * (hi - lo);
        c->law.y[k] = law_value(law, &c->law.given, x, c->law.x[k], y);
    }
    s = new_series(c);
    *s = (struct graph_series){.name = law_named(law)->title,
                               .kind = GRAPH_LAW,
                               .x = c->law.x,
                               .y = c->law.y,
                               .n = SAMPLES};
}

/* ---- the quantity of several columns ---- */

/* A part of a title. */
struct part {
    const char *text;
    size_t n;
};

/* The word at text, without a comma behind it; *next: the text behind its blank. */
static struct part
next_word(const char *text, const char **next)
{
    const size_t n = strcspn(text, " ");

    *next = text[n] == '\0' ? text + n : text + n + 1;
    return (struct part){text, n > 0 && text[n - 1] == ',' ? n - 1 : n};
}

static bool
is_equal(const struct part *a, const struct part *b)
{
    return a->n == b->n && strncasecmp(a->text, b->text, a->n) == 0;
}

/* The words of a title before "of x", "along x", "in contact" and the like, or before a comma; returns their
 * number. The last one is the quantity, as in "Mean pressure". */
static size_t
noun_of(const char *title, struct part word[WORDS])
{
    static const char *const ends[] = {"along", "at",   "by",  "for",  "from", "in",    "of",
                                       "on",    "over", "per", "that", "to",   "under", "with"};
    size_t n = 0;

    for (const char *at = title; *at != '\0' && n < WORDS;) {
        const struct part next = next_word(at, &at);

        for (size_t k = 0; k < sizeof ends / sizeof *ends; k++)
            if (is_equal(&next, &(struct part){ends[k], strlen(ends[k])}))
                return n;
        if (next.text[0] == '(')
            return n;
        word[n++] = next;
        if (next.text[next.n] == ',')
            return n;
    }
    return n;
}

/* The words before "of" and the like with which the nouns of all columns end: "Force" of "Force along x" and
 * "Force along y", "Pressure" of "Mean pressure" and "Largest pressure". False: there are none. */
static bool
common_noun(const struct curves *c, char text[NAME])
{
    struct part first[WORDS], other[WORDS];
    const size_t n = noun_of(title_of(&c->choice, c->history, 1), first);
    size_t same = n;

    for (size_t k = 2; k < c->choice.columns; k++) {
        const size_t m = noun_of(title_of(&c->choice, c->history, k), other);
        size_t e = 0;

        while (e < same && e < m && is_equal(&first[n - 1 - e], &other[m - 1 - e]))
            e++;
        same = e;
    }
    if (same == 0)
        return false;
    snprintf(text, NAME, "%.*s", (int)(first[n - 1].text + first[n - 1].n - first[n - same].text),
             first[n - same].text);
    text[0] = (char)toupper((unsigned char)text[0]);
    return true;
}

/* The title of a column with which those of all columns begin, as "Force along x" and "Force along x in
 * linear theory" do; NULL: none. */
static const char *
common_title(const struct curves *c)
{
    for (size_t k = 1; k < c->choice.columns; k++) {
        const char *title = title_of(&c->choice, c->history, k);
        size_t n = strlen(title), begin = 0;
        for (size_t m = 1; m < c->choice.columns; m++) {
            const char *other = title_of(&c->choice, c->history, m);
            begin += strncmp(title, other, n) == 0 && strchr(" ,", other[n]) != NULL;
        }
        if (begin == c->choice.columns - 1)
            return title;
    }
    return NULL;
}

/* The quantity of a unit; NULL: there are several. Temperatures of reports are above that of the bodies. */
static const char *
quantity_of(const char *unit)
{
    static const struct {
        const char *unit, *quantity;
    } of[] = {{"N", "Force"},   {"Pa", "Stress"}, {"m", "Length"},      {"m2", "Area"},
              {"m3", "Volume"}, {"s", "Time"},    {"J", "Energy"},      {"K", "Temperature rise"},
              {"W", "Power"},   {"m/s", "Speed"}, {"W/m2", "Heat flux"}};

    for (size_t k = 0; k < sizeof of / sizeof *of; k++)
        if (strcmp(of[k].unit, unit) == 0)
            return of[k].quantity;
    return NULL;
}

/* What the columns share: their title, or the beginning of it, or the quantity; the legend has their
 * differences. Else all their titles. */
static void
say_quantity(struct curves *c)
{
    const char *unit = unit_of(c->table, 1), *common = common_title(c), *quantity;

    if (common != NULL) {
        add_word(c->axis, common);
        return;
    }
    quantity = quantity_of(unit);
    if (strcmp(unit, "K") != 0 && common_noun(c, c->axis))
        return;
    if (quantity != NULL) {
        add_word(c->axis, quantity);
        return;
    }
    for (size_t k = 1; k < c->choice.columns; k++) {
        size_t n = strlen(c->axis);

        add_word(c->axis, title_of(&c->choice, c->history, k));
        if (k > 1 && figure_of(c->choice.column[k]) != NULL)
            begin_small(c->axis + n + 2);
    }
}

/* ---- the whole ---- */

static void
describe(struct curves *c)
{
    char *x = c->title;

    say_quantity(c);
    snprintf(c->title, NAME, "%.150s against ", c->axis);
    x += strlen(x);
    snprintf(x, NAME - (size_t)(x - c->title), "%.90s", title_of(&c->choice, c->history, 0));
    if (figure_of(c->choice.column[0]) != NULL)
        begin_small(x);
}

static struct canvas *
draw(struct curves *c, struct drawn *drawn)
{
    const char *y = last_part(c->choice.column[1]);
    bool flow = strncmp(y, "flow_", 5) == 0 || strncmp(y, "critical_", 9) == 0;
    struct graph graph = {
        .x = {title_of(&c->choice, c->history, 0), unit_of(c->table, 0), false, NAN, NAN, NULL,
              c->word, c->words},
        .y = {c->axis, unit_of(c->table, 1), false, NAN, NAN},
        .zero = flow ? "sealed (no flow)" : NULL,
        .n = c->means.n,
        .note = *c->note == '\0' ? NULL : c->note,
    };

    return wording_graph(c->tool, c->style, c->title, drawn->source, &graph, c->series, drawn);
}

static void
curves_free(struct curves *c)
{
    for (size_t f = 0; f < c->tables; f++) {
        table_free(&c->table[f]);
        free(c->table[f].column);
    }
    free(c->table);
    for (size_t k = 0; k < c->means.n; k++)
        free(c->means.own[k]);
    free(c->choice.names);
    free(c->choice.by_names);
    free(c->choice.error_names);
    free(c);
}

struct canvas *
curves_draw(struct tool *t, const char *columns, const struct curve_style *style,
            struct drawn *drawn)
{
    struct curves *c = tool_room(t, 1, sizeof *c, "curves");
    struct canvas *canvas;

    t->remedy = "give fewer rows";
    c->tool = t;
    c->style = style;
    c->means.fewest = SIZE_MAX;
    split_names(c, columns);
    split_options(c);
    read_tables(c);
    for (size_t f = 0; f < c->tables; f++)
        count_from_one_shape(c, &c->table[f]);
    check_units(c);
    check_convergence(c);
    take_words(c);
    for (size_t f = 0; f < c->tables; f++)
        group_rows(c, &c->table[f]);
    for (size_t f = 0; f < c->tables; f++)
        add_curves(c, &c->table[f]);
    say_bars(c);
    if (style->law != NULL)
        add_law(c);
    describe(c);
    snprintf(drawn->source, sizeof drawn->source, "%s",
             c->tables > 1 ? "" : base_name(c->table->source));
    drawn->stamp = c->short_of ? "not converged" : NULL;
    canvas = draw(c, drawn);
    curves_free(c);
    return canvas;
}
