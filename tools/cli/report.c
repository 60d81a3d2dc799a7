/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "formats/core/core.h"
#include "libcontact/owned.h"
#include "tools/machine/machine.h"
#include "ranks.h"

enum {
    ROW = 1 << 16 /* bytes: most rows are shorter */
};

/* ---- the file ---- */

static bool
is_standard_output(const char *name)
{
    return strcmp(name, "-") == 0;
}

void
report_open(struct report *r, struct tool *t, const char *name)
{
    const char *ending = name == NULL ? NULL : strrchr(name, '.');

    *r = (struct report){.tool = t, .name = name};
    if (ending != NULL && strcasecmp(ending, ".tsv") == 0)
        r->separator = '\t';
    if (ending != NULL && strcasecmp(ending, ".csv") == 0)
        r->separator = ',';
    if (name != NULL && !is_standard_output(name))
        tool_demand_writable(t, "--report", name);
}

bool
report_wanted(const struct report *r)
{
    return r->name != NULL;
}

/* Ends the tool. The file keeps the rows that were written whole. */
static _Noreturn void
failed(struct report *r)
{
    const int why = file_error(r->file);

    file_forget(r->file, r->whole);
    tool_die(r->tool, "--report %s: writing failed (%s)", r->name, strerror(why));
}

void
report_close(struct report *r)
{
    if (r->file == NULL)
        return;
    if (r->file != stdout && fclose(r->file) != 0)
        tool_die(r->tool, "--report %s: writing failed (%s)", r->name, strerror(errno));
    r->file = NULL;
}

/* ---- cells of a table ---- */

/* Takes over `text`; NULL: memory was short. */
static void
put_cell(struct report *r, const char *name, const char *unit, char *text)
{
    size_t k = 0;

    if (text == NULL)
        tool_die(r->tool, "--report %s: out of memory", r->name);
    if (r->depth > 0) {
        free(text);
        return;
    }
    while (k < r->columns && strcmp(r->column[k].name, name) != 0)
        k++;
    assert(k < r->columns || !r->headed); /* a later row cannot add a column */
    assert(k < REPORT_COLUMNS);
    if (k == r->columns) {
        r->column[k].name = name;
        r->column[r->columns++].unit = unit;
    }
    free(r->cell[k]);
    r->cell[k] = text;
}

static void
put_word(struct report *r, const char *name, const char *unit, const char *word)
{
    char *text = strdup(word);

    if (text != NULL)
        rc_text_harmless(text, ' ');
    put_cell(r, name, unit, text);
}

/* Cells with commas or quotes are written in quotes (RFC 4180). */
static void
write_cell(struct report *r, size_t k, const char *text)
{
    if (k > 0)
        putc(r->separator, r->file);
    if (r->separator != ',' || text[strcspn(text, ",\"")] == '\0') {
        fputs(text, r->file);
        return;
    }
    putc('"', r->file);
    for (; *text != '\0'; text++)
        fputs(*text == '"' ? "\"\"" : (char[]){*text, '\0'}, r->file);
    putc('"', r->file);
}

/* Writes the names, with the unit after the first slash. */
static void
write_head(struct report *r)
{
    char name[REPORT_NAME];

    for (size_t k = 0; k < r->columns; k++) {
        snprintf(name, sizeof name, "%s%s%s", r->column[k].name,
                 r->column[k].unit == NULL ? "" : "/",
                 r->column[k].unit == NULL ? "" : r->column[k].unit);
        write_cell(r, k, name);
    }
    putc('\n', r->file);
    r->headed = true;
}

static void
write_cells(struct report *r)
{
    for (size_t k = 0; k < r->columns; k++) {
        write_cell(r, k, r->cell[k] == NULL ? "NaN" : r->cell[k]);
        free(r->cell[k]);
        r->cell[k] = NULL;
    }
    putc('\n', r->file);
}

/* ---- rows ---- */

void
report_begin(struct report *r)
{
    const bool made = r->file == NULL;

    if (r->name == NULL)
        return;
    if (made)
        r->file = is_standard_output(r->name)
                      ? stdout
                      : fopen(ranks_speak(r->tool) ? r->name : "/dev/null", "w");
    if (r->file == NULL)
        tool_die(r->tool, "--report %s: %s", r->name, strerror(errno));
    if (made && r->file != stdout)
        setvbuf(r->file, NULL, _IOFBF, ROW); /* a row is one write */
    if (!r->separator)
        json_open(&r->json, r->file);
}

/* A value as JSON has it, in quotes or not; NULL: unknown. */
static void
put(struct report *r, const char *name, const char *unit, const char *value, bool quoted)
{
    if (r->name == NULL)
        return;
    if (r->separator)
        put_word(r, name, unit, value == NULL ? "NaN" : value);
    else
        (quoted ? json_text : json_plain)(&r->json, name, value);
}

void
report_number(struct report *r, const char *name, double value, const char *unit)
{
    put(r, name, unit, isfinite(value) ? rc_number(value) : NULL, false);
}

void
report_count(struct report *r, const char *name, size_t value, const char *unit)
{
    char text[32];

    snprintf(text, sizeof text, "%zu", value);
    put(r, name, unit, text, false);
}

void
report_text(struct report *r, const char *name, const char *value)
{
    if (r->depth == 0 && strcmp(name, "source") == 0)
        r->source = value;
    put(r, name, NULL, value, true);
}

void
report_bool(struct report *r, const char *name, bool value)
{
    put(r, name, NULL, value ? "true" : "false", false);
}

void
report_column(struct report *r, const char *name, const char *unit)
{
    if (r->separator)
        put(r, name, unit, NULL, false);
}

static void
begin_inside(struct report *r, const char *name, char bracket)
{
    if (r->name == NULL)
        return;
    if (!r->separator)
        json_begin(&r->json, name, bracket);
    assert(r->depth < REPORT_DEPTH);
    r->bracket[r->depth++] = bracket;
}

void
report_object(struct report *r, const char *name)
{
    begin_inside(r, name, '}');
}

void
report_array(struct report *r, const char *name)
{
    begin_inside(r, name, ']');
}

void
report_end(struct report *r)
{
    if (r->name == NULL)
        return;
    assert(r->depth > 0);
    r->depth--;
    if (!r->separator)
        json_end(&r->json, r->bracket[r->depth]);
}

void
report_numbers(struct report *r, const char *name, const double *v, size_t step, size_t n)
{
    report_array(r, name);
    for (size_t k = 0; k < n; k++)
        report_number(r, NULL, *(const double *)(const void *)((const char *)v + k * step), NULL);
    report_end(r);
}

void
report_no_object(struct report *r, const char *name)
{
    if (r->name != NULL && !r->separator)
        json_plain(&r->json, name, NULL);
}

/* The name of the input as on the command line: the row is about the case that began there. Of a pipe:
 * the source of its map. */
static void
put_file(struct report *r)
{
    const struct tool *t = r->tool;
    const char *name = t->current.number != 0 ? t->current.source : t->input.source;

    if (name == NULL || strcmp(name, "standard input") == 0)
        name = r->source;
    report_text(r, "file", name);
    r->source = NULL;
}

void
report_finish_row(struct report *r)
{
    if (r->name == NULL)
        return;
    assert(r->depth == 0);
    if (r->tool->info->reads == READS_STREAM && !r->of_all)
        put_file(r);
    if (r->separator && !r->headed)
        write_head(r);
    if (r->separator)
        write_cells(r);
    else
        json_close(&r->json);
    if (ferror(r->file) || fflush(r->file) != 0)
        failed(r);
    r->whole = ftello(r->file);
}

/* ---- figures from their tables ---- */

static void
put_figure(struct report *r, const char *name, const struct figures *f)
{
    const double number = rc_figure_number(f->table, f->data);

    if (f->table->kind == RC_WORD)
        report_text(r, name, rc_figure_word(f->table, f->data));
    else if (f->data == NULL || f->table->kind == RC_NUMBER)
        report_number(r, name, number, f->table->unit);
    else if (f->table->kind == RC_COUNT)
        report_count(r, name, (size_t)number, f->table->unit);
    else
        report_bool(r, name, number != 0);
}

/* True if both names belong to one object: equal up to a dot. */
static bool
same_object(const char *a, const char *b)
{
    size_t n = strcspn(a, ".");

    return strncmp(a, b, n + 1) == 0 && a[n] == '.';
}

static bool
is_known(const struct figures *f)
{
    return f->table->kind == RC_WORD ? rc_figure_word(f->table, f->data) != NULL
                                     : !isnan(rc_figure_number(f->table, f->data));
}

static void
put_object(struct report *r, const struct figures *f, size_t n)
{
    char object[REPORT_NAME];
    size_t length = strcspn(f->table->name, "."), known = 0;

    snprintf(object, sizeof object, "%.*s", (int)length, f->table->name);
    for (size_t k = 0; k < n; k++)
        known += is_known(&f[k]);
    if (known == 0) {
        report_no_object(r, object);
        return;
    }
    report_object(r, object);
    for (size_t k = 0; k < n; k++)
        put_figure(r, f[k].table->name + length + 1, &f[k]);
    report_end(r);
}

static void
put_figures(struct report *r, const struct figures *f, size_t n)
{
    for (size_t k = 0, end; k < n; k = end) {
        for (end = k + 1; end < n && same_object(f[k].table->name, f[end].table->name); end++)
            ;
        if (strchr(f[k].table->name, '.') != NULL)
            put_object(r, f + k, end - k);
        else
            put_figure(r, f[k].table->name, &f[k]);
    }
}

void
report_table(struct report *r, const struct rc_figure *table, const void *data)
{
    struct figures f[REPORT_COLUMNS];
    size_t n = 0;

    for (; table->name != NULL; table++) {
        assert(n < REPORT_COLUMNS);
        f[n++] = (struct figures){table, data};
    }
    if (report_wanted(r))
        put_figures(r, f, n);
}

void
report_model(struct report *r, const struct rc_model *m, const struct rc_point *at, unsigned given)
{
    struct rc_figure found[RC_AXES]; /* an outer model finds another value than the inner figure */
    struct figures f[REPORT_COLUMNS];
    size_t n = 0;

    for (size_t k = 0; (f[n].table = rc_model_figure(m, k, &f[n].data)) != NULL; k++) {
        n += strcmp(f[n].table->name, "converged") != 0;
        assert(n < REPORT_COLUMNS);
    }
    for (size_t a = 0; a < RC_AXES; a++) {
        const struct rc_axis_info *axis = rc_axis_info(a);
        size_t k = 0;
        while (k < n && strcmp(f[k].table->name, axis->name) != 0)
            k++;
        if (k == n && (given >> a & 1 || given >> axis->partner & 1))
            report_number(r, axis->name, at->at[a], axis->unit);
        if (k < n && !(given >> a & 1) && given >> axis->partner & 1) {
            found[a] = *f[k].table;
            found[a].at = offsetof(struct rc_point, at) + a * sizeof *at->at;
            f[k] = (struct figures){&found[a], at};
        }
    }
    if (report_wanted(r))
        put_figures(r, f, n);
}

/* The figure whose name is the first n characters; the last table is NULL. */
static struct figures
named(const struct figures *from, const char *name, size_t n)
{
    for (; from->table != NULL; from++)
        for (const struct rc_figure *f = from->table; f->name != NULL; f++)
            if (strncmp(f->name, name, n) == 0 && f->name[n] == '\0')
                return (struct figures){f, from->data};
    assert(!"a column without a row in the tables");
    abort();
}

void
report_named(struct report *r, const struct figures *from, const char *names)
{
    struct figures f[REPORT_COLUMNS];
    size_t n = 0;

    for (size_t length; *names != '\0'; names += length + strspn(names + length, " ")) {
        length = strcspn(names, " ");
        assert(n < REPORT_COLUMNS);
        f[n++] = named(from, names, length);
    }
    if (report_wanted(r))
        put_figures(r, f, n);
}

static const struct rc_figure own[] = {
    {.name = "nodes_per_patch", .title = "Nodes per patch"},
    {.name = "contact_area_corrected", .unit = "m2", .title = "Contact area, corrected"},
    {.name = "contact_radius", .unit = "m", .title = "Contact radius"},
    {.name = "stiffness", .unit = "N/m", .title = "Stiffness"},
    {.name = "indentation", .unit = "m", .title = "Indentation"},
    {.name = "residual_indentation", .unit = "m", .title = "Residual indentation"},
    {.name = "contact_area_inside", .unit = "m2", .title = "Contact area inside the taper"},
    {.name = "contact_fraction_inside", .title = "Contact fraction inside the taper"},
    {.name = "min_displacement", .unit = "m", .title = "Least displacement"},
    {.name = "max_displacement", .unit = "m", .title = "Largest displacement"},
    {.name = "mean_displacement", .unit = "m", .title = "Mean displacement"},
    {.name = "flow_rate", .unit = "m3/s", .title = "Flow rate"},
    {.name = "shear_flow", .unit = "m3/s", .title = "Shear flow"},
    {.name = "critical_flow", .unit = "m3/s", .title = "Flow of the critical constriction"},
    {.name = "dissipated_total", .unit = "J", .title = "Dissipated energy"},
    {.name = "peak_memory", .unit = "B", .title = "Memory"},
    {.name = "estar", .unit = "Pa", .title = "E*"},
    {.name = "hardness", .unit = "Pa", .title = "Hardness"},
    {.name = "radius", .unit = "m", .title = "Radius"},
    {.name = "cylinder", .unit = "m", .title = "Radius of the cylinder"},
    {.name = "depth", .unit = "m", .title = "Depth"},
    {.name = "pass", .title = "Pass"},
    {.name = "rolling_speed", .unit = "m/s", .title = "Speed of rolling"},
    {.name = "shift", .title = "Shift factor"},
    {.name = "temperature", .unit = "K", .title = "Temperature"},
    {.name = "strain_gain", .title = "Plastic strain of a pass"},
    {.name = "q", .unit = "rad/m", .title = "Wavenumber"},
    {.name = "c", .unit = "m4", .title = "Power spectral density"},
};

const struct rc_figure *
report_figure(const char *name)
{
    const struct rc_figure *f = rc_figure_find(name);

    for (size_t k = 0; f == NULL && k < sizeof own / sizeof *own; k++)
        f = strcmp(own[k].name, name) == 0 ? &own[k] : NULL;
    return f;
}

void
report_value(struct report *r, const char *name, double value)
{
    const struct rc_figure *f = report_figure(name);

    assert(f != NULL);
    report_number(r, name, value, f->unit);
}

/* In a table without blanks, for programs that split lines there. */
static void
put_materials(struct report *r)
{
    const size_t size = strlen(r->tool->materials) + 1;
    RC_OWNED char *text = tool_room(r->tool, size, 1, "the values of materials");

    memcpy(text, r->tool->materials, size);
    for (char *s = text; r->separator && *s != '\0'; s++)
        *s = *s == ' ' ? '_' : *s;
    report_text(r, "body_materials", text);
}

void
report_map(struct report *r, const struct rc_grid *g, size_t number)
{
    report_count(r, "case", number, NULL);
    report_text(r, "source", rc_grid_get(g, "source"));
    if (r->tool->materials != NULL)
        put_materials(r);
    report_count(r, "nx", g->nx, NULL);
    report_count(r, "ny", g->ny, NULL);
    report_number(r, "dx", g->dx, "m");
    report_number(r, "dy", g->dy, "m");
}

void
report_effects(struct report *r, const struct effect_state *e)
{
    report_object(r, "effects");
    for (; e->name != NULL; e++)
        report_text(r, e->name, e->state);
    report_end(r);
}

void
report_seconds(struct report *r, const struct report_phase *phase, double total)
{
    if (r->separator) {
        report_number(r, "seconds", total, "s");
        return;
    }
    report_object(r, "seconds");
    for (; phase->name != NULL; phase++)
        report_number(r, phase->name, phase->seconds, "s");
    report_number(r, "total", total, "s");
    report_end(r);
}

void
report_carried(struct report *r, const char *converged)
{
    if (converged == NULL)
        report_text(r, "converged", NULL);
    else
        report_bool(r, "converged", strcmp(converged, "no") != 0);
}

void
report_forecast(struct report *r, double convolutions, double seconds, size_t memory)
{
    report_number(r, "expected_convolutions", convolutions, NULL);
    report_number(r, "expected_seconds", seconds, "s");
    report_count(r, "expected_memory", memory, "B");
}

void
report_memory(struct report *r)
{
    const double peak = ranks_most(r->tool, (double)memory_peak());
    const double counted = ranks_most(r->tool, (double)tool_counted_memory(r->tool));

    report_count(r, "peak_memory", (size_t)peak, "B");
    report_count(r, "memory_estimate", (size_t)counted, "B");
}

void
report_ranks(struct report *r, const struct tool *t)
{
    struct rc_sent sent;

    ranks_sent(t, &sent); /* all processes together, with or without a report */
    if (r->name == NULL || t->ranks == NULL)
        return;
    report_count(r, "ranks", ranks_count(t), NULL);
    report_count(r, "exchanges", sent.exchanges, NULL);
    report_number(r, "messages", sent.messages, NULL);
    report_number(r, "bytes_exchanged", sent.bytes, "B");
    report_number(r, "other_bytes", sent.other_bytes, "B");
    report_number(r, "exchange_seconds", sent.seconds, "s");
}
