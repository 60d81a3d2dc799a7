/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "materials.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum {
    BODIES = 2,
    LINE = 4096, /* most bytes of a line of a table */
    NAME = 28,   /* columns of a name in the printed table */
    LACKS = 256  /* bytes of a sentence about a value that no table has */
};

static struct {
    const char *body[BODIES], *table;
    char *both[MATERIAL_PROPERTIES];        /* values of two bodies, for options that take both */
    char *told;                             /* the text of the report */
    char lacks[MATERIAL_PROPERTIES][LACKS]; /* the materials without a value that an option needs */
    struct material *own; /* rows of --materials FILE, as material_table; NULL: none */
} asked;

/* clang-format off */
static const struct {
    const char *name;
    enum unit unit;
    int columns; /* in the printed table */
} properties[] = {
    [MATERIAL_E] = {"E", UNIT_PA, 9},
    [MATERIAL_NU] = {"nu", UNIT_NONE, 6},
    [MATERIAL_HARDNESS] = {"hardness", UNIT_HARD, 8},
    [MATERIAL_YIELD] = {"yield", UNIT_PA, 7},
    [MATERIAL_CONDUCTIVITY] = {"conductivity", UNIT_W_MK, 12},
    [MATERIAL_DIFFUSIVITY] = {"diffusivity", UNIT_DIFFUSIVITY, 11},
};

/* Which property of which body an option has. */
static const struct fill {
    const char *option;
    enum material_property property;
    enum { FIRST, SECOND, BOTH, SOFTER } of; /* SOFTER: the lower value; BOTH: the two values, "A,B" */
} fills[] = {
    {"E1", MATERIAL_E, FIRST},
    {"nu1", MATERIAL_NU, FIRST},
    {"E2", MATERIAL_E, SECOND},
    {"nu2", MATERIAL_NU, SECOND},
    {"nu", MATERIAL_NU, FIRST},
    {"yield", MATERIAL_YIELD, FIRST},
    {"hardness", MATERIAL_HARDNESS, SOFTER},
    {"conductivity", MATERIAL_CONDUCTIVITY, BOTH},
    {"diffusivity", MATERIAL_DIFFUSIVITY, BOTH},
};
/* clang-format on */

/* ---- names ---- */

/* The next of the names that '|' separates, without blanks around it; false: no more. */
static bool
next_name(const char **names, char name[NAME_SIZE])
{
    size_t n;

    *names += strspn(*names, " |");
    n = strcspn(*names, "|");
    snprintf(name, NAME_SIZE, "%.*s", (int)n, *names);
    *names += n;
    for (n = strlen(name); n > 0 && name[n - 1] == ' ';)
        name[--n] = '\0';
    return n > 0;
}

/* The first name of row k, for completions. */
static const char *
first_name(size_t k)
{
    static char name[NAME_SIZE];
    const char *names = material_table[k].names;

    if (names == NULL)
        return NULL;
    (void)next_name(&names, name);
    return name;
}

static bool
has_name(const struct material *m, const char *name)
{
    char one[NAME_SIZE];

    for (const char *names = m->names; next_name(&names, one);)
        if (strcasecmp(one, name) == 0)
            return true;
    return false;
}

static const struct material *
found_in(const struct material *table, const char *name)
{
    for (; table != NULL && table->names != NULL; table++)
        if (has_name(table, name))
            return table;
    return NULL;
}

static void
nearest_in(const struct material *table, const char *name, char nearest[NAME_SIZE])
{
    char one[NAME_SIZE];

    for (; table != NULL && table->names != NULL; table++)
        for (const char *names = table->names; next_name(&names, one);)
            if (name_misspelt(name, one))
                name_nearer(name, one, nearest);
}

static const struct material *
named(struct tool *t, int body)
{
    char nearest[NAME_SIZE] = "", meant[NAME_MEANT];
    const char *name = asked.body[body];
    const struct material *m;

    if (name == NULL)
        return NULL;
    if ((m = found_in(asked.own, name)) != NULL || (m = found_in(material_table, name)) != NULL)
        return m;
    nearest_in(asked.own, name, nearest);
    nearest_in(material_table, name, nearest);
    tool_usage(
        t,
        "--body%d %s: it is in no table; --materials prints the known ones, --materials FILE "
        "reads yours%s",
        body + 1, name, name_meant(nearest, meant));
}

/* ---- a table of the user ---- */

/* The next cell of a line, without blanks around it; NULL at the end. */
static char *
next_cell(char **line)
{
    char *cell = *line, *end;

    if (cell == NULL)
        return NULL;
    *line = strchr(cell, '\t');
    if (*line != NULL)
        *(*line)++ = '\0';
    cell += strspn(cell, " ");
    for (end = cell + strlen(cell); end > cell && strchr(" \r\n", end[-1]) != NULL;)
        *--end = '\0';
    return cell;
}

enum {
    COLUMN_NAME = MATERIAL_PROPERTIES,
    COLUMN_SOURCE,
    COLUMNS
};

static int
column_of(const char *name)
{
    for (int p = 0; p < MATERIAL_PROPERTIES; p++)
        if (strcasecmp(name, properties[p].name) == 0)
            return p;
    return strcasecmp(name, "name") == 0     ? COLUMN_NAME
           : strcasecmp(name, "source") == 0 ? COLUMN_SOURCE
                                             : COLUMNS;
}

/* Reads the names of the columns; returns their number. */
static size_t
read_head(struct tool *t, char *line, int column[COLUMNS])
{
    bool named_column = false;
    size_t n = 0;

    for (char *cell; (cell = next_cell(&line)) != NULL; n++) {
        const int c = column_of(cell);
        if (c == COLUMNS || n == COLUMNS)
            tool_usage(t,
                       "--materials %s: '%s' is no column: they are name, E, nu, hardness, yield, "
                       "conductivity, diffusivity and source, with tabs between them",
                       asked.table, cell);
        for (size_t k = 0; k < n; k++)
            if (column[k] == c)
                tool_usage(t, "--materials %s: two columns are named '%s'", asked.table, cell);
        column[n] = c;
        named_column = named_column || c == COLUMN_NAME;
    }
    if (!named_column)
        tool_usage(t,
                   "--materials %s: the first line has no column 'name': it holds the names of "
                   "the columns, with tabs between them",
                   asked.table);
    return n;
}

static void
read_row(struct tool *t, char *line, size_t number, const int column[COLUMNS], size_t columns,
         struct material *m)
{
    const char *source = "";
    char *cell;

    *m = (struct material){.names = ""};
    for (size_t k = 0; (cell = next_cell(&line)) != NULL; k++) {
        double value;
        if (k == columns)
            tool_usage(t, "--materials %s, line %zu: it has more cells than the first line",
                       asked.table, number);
        if (*cell == '\0' || strcmp(cell, "-") == 0)
            continue;
        if (column[k] == COLUMN_NAME)
            m->names = tool_copy(t, cell);
        else if (column[k] == COLUMN_SOURCE)
            source = tool_copy(t, cell);
        else if (strcmp(cell, "rigid") != 0 &&
                 unit_number(cell, properties[column[k]].unit, &value, &t->err) != RC_OK)
            tool_usage(t, "--materials %s, line %zu, %s: %s", asked.table, number,
                       properties[column[k]].name, t->err.text);
        else
            m->of[column[k]].value = tool_copy(t, cell);
    }
    if (*m->names == '\0')
        tool_usage(t, "--materials %s, line %zu: it has no name", asked.table, number);
    for (int p = 0; p < MATERIAL_PROPERTIES; p++)
        m->of[p].source = source;
}

static void
read_table(struct tool *t)
{
    FILE *f = fopen(asked.table, "r");
    int column[COLUMNS];
    size_t columns = 0, n = 0, room = 0, number = 0;
    char line[LINE];

    if (f == NULL)
        tool_die(t, "--materials %s: %s", asked.table, strerror(errno));
    while (fgets(line, sizeof line, f) != NULL) {
        number++;
        if (strlen(line) == LINE - 1)
            tool_usage(t, "--materials %s, line %zu: it has more than %d bytes", asked.table,
                       number, LINE - 2);
        if (line[strspn(line, " \t\r\n")] == '\0' || *line == '#')
            continue;
        if (columns == 0) {
            columns = read_head(t, line, column);
            continue;
        }
        asked.own = tool_grown(t, asked.own, n, &room, sizeof *asked.own, "a table of materials");
        read_row(t, line, number, column, columns, &asked.own[n++]);
    }
    fclose(f);
    asked.own = tool_grown(t, asked.own, n, &room, sizeof *asked.own, "a table of materials");
    asked.own[n] = (struct material){.names = NULL};
}

/* ---- the printed table ---- */

static void
print_sources(const struct material *m)
{
    const char *before = NULL;

    for (int p = 0; p < MATERIAL_PROPERTIES; p++)
        if (m->of[p].value != NULL) {
            if (before != NULL && strcmp(before, m->of[p].source) == 0)
                printf(", %s", properties[p].name);
            else
                printf("%s%s%s", before == NULL ? "" : ": ", before == NULL ? "" : before,
                       before == NULL ? "" : "; ");
            if (before == NULL || strcmp(before, m->of[p].source) != 0)
                printf("%s", properties[p].name);
            before = m->of[p].source;
        }
    printf(": %s\n", before);
}

static _Noreturn void
print_table(void)
{
    printf("%-*s", NAME, "name");
    for (int p = 0; p < MATERIAL_PROPERTIES; p++)
        printf("\t%-*s", properties[p].columns, properties[p].name);
    printf("\tsource\n");
    for (const struct material *m = material_table; m->names != NULL; m++) {
        printf("%-*s", NAME, m->names);
        for (int p = 0; p < MATERIAL_PROPERTIES; p++)
            printf("\t%-*s", properties[p].columns, m->of[p].value == NULL ? "-" : m->of[p].value);
        printf("\t");
        print_sources(m);
    }
    exit(fflush(stdout) == 0 && !ferror(stdout) ? 0 : EXIT_IMPOSSIBLE);
}

/* ---- options ---- */

#define AT(field) .base = &asked.field
/* clang-format off */
#define BODY_1 {.name = "body1", .type = OPT_TEXT, AT(body[0]), .words = first_name, .result = true, \
    .arg = "MATERIAL", .help = "material of body 1: its values, where the line does not give them"}
#define BODY_2 {.name = "body2", .type = OPT_TEXT, AT(body[1]), .words = first_name, .result = true, \
    .arg = "MATERIAL", .help = "the same for body 2; also rigid"}
#define TABLE {.name = "materials", .type = OPT_TEXT, AT(table), .optional = true, .result = true, \
    .arg = "FILE", \
    .help = "print the table of materials and exit; with FILE: take the rows of this table too"}
const struct opt material_options[] = {BODY_1, BODY_2, TABLE, {.name = NULL}};
const struct opt material_options_of_one[] = {BODY_1, TABLE, {.name = NULL}};
/* clang-format on */

/* True if another option of the line has the values of this one. */
static bool
is_replaced(const struct tool *t, const struct fill *f)
{
    if (f->property == MATERIAL_E && f->of == FIRST && tool_given(t, "relaxation"))
        return true;
    return (f->property == MATERIAL_E || f->property == MATERIAL_NU) &&
           (tool_given(t, "estar") || tool_given(t, "nu"));
}

static const char *
value_of(const struct material *m, enum material_property p)
{
    return m == NULL ? NULL : m->of[p].value;
}

/* The lower of two values; NULL: none. */
static const char *
lower(const char *a, const char *b, enum unit unit)
{
    double first, second;

    if (a == NULL || b == NULL)
        return a == NULL ? b : a;
    if (unit_number(a, unit, &first, NULL) != RC_OK || unit_number(b, unit, &second, NULL) != RC_OK)
        return a;
    return first <= second ? a : b;
}

/* Adds to the text of the report, as in "E1 211.9GPa (steel)" or, for an option of the line, "E1 as
 * given". */
static void
tell(struct tool *t, const char *format, ...)
{
    RC_OWNED char *old = asked.told;
    const char *before = old == NULL ? "" : old;
    const size_t size = strlen(before) + LINE;
    char *text = tool_room(t, size, 1, "the values of materials");
    size_t n = (size_t)snprintf(text, size, "%s%s", before, *before == '\0' ? "" : "; ");
    va_list args;

    va_start(args, format);
    vsnprintf(text + n, size - n, format, args);
    va_end(args);
    t->materials = asked.told = text;
}

/* True for an option that the tool cannot do without. */
static bool
is_demanded(const struct tool *t, const char *name)
{
    for (size_t k = 0; k < t->option.n; k++)
        if (t->option.row[k].name != NULL && strcmp(t->option.row[k].name, name) == 0)
            return t->option.row[k].one_of != NULL;
    return false;
}

/* "K1,K2" of both bodies; NULL if one is unknown. */
static const char *
of_both(struct tool *t, enum material_property p, const char *one, const char *two)
{
    if (one == NULL || two == NULL)
        return NULL;
    asked.both[p] = tool_room(t, strlen(one) + strlen(two) + 2, 1, "the values of materials");
    sprintf(asked.both[p], "%s,%s", one, two);
    return asked.both[p];
}

static bool
is_rigid(const struct material *m)
{
    const char *e = value_of(m, MATERIAL_E);

    return e != NULL && strcmp(e, "rigid") == 0;
}

/* True if the line names the material of this body, and the table lacks the property. A rigid body does not
 * yield. */
static bool
lacks(const struct material *m, enum material_property p)
{
    return m != NULL && value_of(m, p) == NULL &&
           !(is_rigid(m) && (p == MATERIAL_HARDNESS || p == MATERIAL_YIELD));
}

/* Keeps "the table has no hardness of steel, body 1; 100Cr6 has 848HV". */
static void
keep_lack(const struct fill *f, const struct material *const m[BODIES])
{
    const enum material_property p = f->property;
    const bool of[BODIES] = {f->of != SECOND && lacks(m[0], p), f->of != FIRST && lacks(m[1], p)};
    const int without = of[0] ? 0 : 1, with = 1 - without;
    char *text = asked.lacks[p];
    size_t n;

    if (!of[without])
        return;
    n = (size_t)snprintf(text, LACKS, "the table has no %s of %.64s, body %d",
                         p == MATERIAL_YIELD ? "yield stress" : properties[p].name,
                         asked.body[without], without + 1);
    if (of[with])
        snprintf(text + n, LACKS - n, ", or of %.64s, body %d", asked.body[with], with + 1);
    else if (value_of(m[with], p) != NULL && n < LACKS && (f->of == SOFTER || f->of == BOTH))
        snprintf(text + n, LACKS - n, "; %.64s, body %d, has %.64s", asked.body[with], with + 1,
                 value_of(m[with], p));
}

static void
fill(struct tool *t, const struct fill *f, const struct material *const m[BODIES])
{
    const char *one = value_of(m[0], f->property), *two = value_of(m[1], f->property);
    const char *text = f->of == FIRST    ? one
                       : f->of == SECOND ? two
                       : f->of == BOTH   ? of_both(t, f->property, one, two)
                                         : lower(one, two, properties[f->property].unit);
    /* the softer body may be the one without a value */
    const bool unknown = f->of == SOFTER && (lacks(m[0], f->property) || lacks(m[1], f->property));

    if (f->of == BOTH && text == NULL && m[0] != NULL && m[1] != NULL &&
        is_demanded(t, f->option) && !tool_given(t, f->option))
        tool_usage(
            t,
            "the table has no %s of %s: give --%s K1,K2 with the values of both bodies, as in "
            "--%s 45W/mK,16W/mK",
            properties[f->property].name, asked.body[one == NULL ? 0 : 1], f->option, f->option);
    if (!tool_given(t, f->option))
        keep_lack(f, m);
    if (unknown || text == NULL || is_replaced(t, f))
        return;
    if (tool_given(t, f->option)) {
        tell(t, "%s as given", f->option);
        return;
    }
    tell(t, "%s %s (%s)", f->option, text,
         f->of == FIRST    ? asked.body[0]
         : f->of == SECOND ? asked.body[1]
         : f->of == BOTH   ? "both bodies"
         : text == one     ? asked.body[0]
                           : asked.body[1]);
    tool_set_option(t, f->option, text);
}

const char *
materials_value(struct tool *t, enum material_property p)
{
    return value_of(named(t, 0), p);
}

const char *
materials_lack(const char *option)
{
    for (size_t k = 0; k < sizeof fills / sizeof *fills; k++)
        if (strcmp(fills[k].option, option) == 0)
            return asked.lacks[fills[k].property];
    return "";
}

void
materials_fill(struct tool *t)
{
    const struct material *m[BODIES];

    if (tool_given(t, "materials") && asked.table == NULL)
        print_table();
    if (asked.table != NULL)
        read_table(t);
    for (int b = 0; b < BODIES; b++)
        m[b] = named(t, b);
    for (const char *const *option = t->info->of_materials; *option != NULL; option++)
        for (size_t k = 0; k < sizeof fills / sizeof *fills; k++)
            if (strcmp(fills[k].option, *option) == 0)
                fill(t, &fills[k], m);
    if (t->materials != NULL)
        tool_note(t, "%s", t->materials);
}
