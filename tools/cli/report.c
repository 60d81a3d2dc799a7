#include "report.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "formats/core/core.h"
#include "ranks.h"

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

static _Noreturn void
failed(struct report *r)
{
    tool_die(r->tool, EXIT_IMPOSSIBLE, "--report %s: writing failed (%s)", r->name,
             strerror(errno));
}

void
report_close(struct report *r)
{
    if (r->file == NULL)
        return;
    if (ferror(r->file) || (r->file == stdout ? fflush(r->file) : fclose(r->file)) != 0)
        failed(r);
    r->file = NULL;
}

/* ---- cells of a table ---- */

/* `text` is taken over; NULL: memory was short. */
static void
put_cell(struct report *r, const char *name, const char *unit, char *text)
{
    size_t k = 0;

    if (text == NULL)
        tool_die(r->tool, EXIT_IMPOSSIBLE, "--report %s: out of memory", r->name);
    if (r->depth > 0) {
        free(text);
        return;
    }
    while (k < r->columns && strcmp(r->column[k].name, name) != 0)
        k++;
    assert(k < r->columns || !r->headed); /* a later row brings no new column */
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

/* Cells with commas or quotes stand in quotes (RFC 4180). */
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

/* The names, with the unit after the first slash. */
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
    fflush(r->file);
}

/* ---- rows ---- */

void
report_begin(struct report *r)
{
    if (r->name == NULL)
        return;
    if (r->file == NULL)
        r->file = is_standard_output(r->name)
                      ? stdout
                      : fopen(ranks_speak(r->tool) ? r->name : "/dev/null", "w");
    if (r->file == NULL)
        tool_die(r->tool, EXIT_IMPOSSIBLE, "--report %s: %s", r->name, strerror(errno));
    if (!r->separator)
        json_open(&r->json, r->file);
}

void
report_number(struct report *r, const char *name, double value, const char *unit)
{
    char text[RC_NUMBER_SIZE];

    if (r->name == NULL)
        return;
    if (r->separator)
        put_word(r, name, unit, isfinite(value) ? rc_number_text(text, value) : "NaN");
    else
        json_number(&r->json, name, value);
}

void
report_count(struct report *r, const char *name, size_t value, const char *unit)
{
    char text[32];

    if (r->name == NULL)
        return;
    snprintf(text, sizeof text, "%zu", value);
    if (r->separator)
        put_word(r, name, unit, text);
    else
        json_count(&r->json, name, value);
}

void
report_text(struct report *r, const char *name, const char *value)
{
    if (r->name == NULL)
        return;
    if (r->separator)
        put_word(r, name, NULL, value == NULL ? "NaN" : value);
    else
        json_text(&r->json, name, value);
}

void
report_bool(struct report *r, const char *name, bool value)
{
    if (r->name == NULL)
        return;
    if (r->separator)
        put_word(r, name, NULL, value ? "true" : "false");
    else
        json_bool(&r->json, name, value);
}

void
report_column(struct report *r, const char *name, const char *unit)
{
    if (r->name != NULL && r->separator)
        put_word(r, name, unit, "NaN");
}

static void
begin_inside(struct report *r, char bracket)
{
    assert(r->depth < REPORT_DEPTH);
    r->bracket[r->depth++] = bracket;
}

void
report_object(struct report *r, const char *name)
{
    if (r->name == NULL)
        return;
    if (!r->separator)
        json_object(&r->json, name);
    begin_inside(r, '}');
}

void
report_array(struct report *r, const char *name)
{
    if (r->name == NULL)
        return;
    if (!r->separator)
        json_array(&r->json, name);
    begin_inside(r, ']');
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
report_no_object(struct report *r, const char *name)
{
    if (r->name != NULL && !r->separator)
        json_null(&r->json, name);
}

void
report_finish_row(struct report *r)
{
    if (r->name == NULL)
        return;
    assert(r->depth == 0);
    if (r->separator && !r->headed)
        write_head(r);
    if (r->separator)
        write_cells(r);
    else
        json_close(&r->json);
    if (ferror(r->file))
        failed(r);
}

void
report_ranks(struct report *r, const struct tool *t)
{
    struct rc_sent sent;

    ranks_sent(t, &sent); /* all together, wanted or not */
    if (r->name == NULL || t->ranks == NULL)
        return;
    report_count(r, "ranks", ranks_count(t), NULL);
    report_count(r, "exchanges", sent.exchanges, NULL);
    report_number(r, "messages", sent.messages, NULL);
    report_number(r, "bytes_exchanged", sent.bytes, "B");
    report_number(r, "other_bytes", sent.other_bytes, "B");
    report_number(r, "exchange_seconds", sent.seconds, "s");
}
