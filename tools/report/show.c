/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the parts show: pictures, texts and tables as HTML. */
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"
#include "page.h"

/* Writes text of files and users: no character of it acts as markup, and none is a control character. */
void
page_text(FILE *out, const char *text)
{
    bool utf8 = rc_utf8_valid(text);

    for (size_t size; *text != '\0'; text += size) {
        size = rc_control_size(text);
        if (*text != '\n' && (size > 0 || (!utf8 && (unsigned char)*text >= 0x80)))
            putc('?', out);
        else if (strchr("&<>\"'", *text) != NULL)
            fprintf(out, "&#%d;", *text);
        else
            putc(*text, out);
        size = size == 0 ? 1 : size;
    }
}

/* True for the file of a command that failed. */
static bool
is_empty(FILE *in)
{
    const int first = getc(in);

    return first == EOF || ungetc(first, in) == EOF;
}

void
page_show_picture(struct page *run, FILE *in, const char *caption, const char *unused)
{
    FILE *out = run->page.file;
    unsigned char bytes[3];
    char four[5];

    (void)unused;
    if (is_empty(in)) /* of an effect that was not computed */
        return;
    fprintf(out, "<figure><img alt=\"%s\" src=\"data:image/png;base64,", caption);
    for (size_t n; (n = fread(bytes, 1, sizeof bytes, in)) > 0;)
        fputs(rc_base64(four, bytes, n), out);
    fprintf(out, "\"/><figcaption>%s</figcaption></figure>\n", caption);
}

static bool
begins(const char *line, const char *word)
{
    return word != NULL && strncmp(line, "  ", 2) == 0 &&
           strncmp(line + 2, word, strlen(word)) == 0;
}

/* Shows some lines of a text of rc-info. The first is the line with this first word (NULL: the second line),
 * the last is the one before the line with the other word. */
void
page_show_lines(struct page *run, FILE *in, const char *from, const char *to)
{
    RC_OWNED char *line = NULL;
    size_t room = 0;
    bool shown = false;

    fputs("<pre>", run->page.file);
    for (size_t k = 0; getline(&line, &room, in) > 0; k++) {
        shown = (shown || (from == NULL ? k == 1 : begins(line, from))) && !begins(line, to);
        if (shown)
            page_text(run->page.file, line);
    }
    fputs("</pre>\n", run->page.file);
}

/* ---- tables of reports ---- */

/* A value of a report with its unit, in four digits; what is no number, as it is. A length below 1 fm is only
 * rounding. */
void
page_value(FILE *out, const char *text, const char *unit)
{
    char *end;
    const double value = strtod(text, &end);
    const double whole = value == 0 || strcmp(unit, "m") != 0 || fabs(value) >= 1e-15 ? value : 0;

    if (strcmp(text, "NaN") == 0 || *text == '\0')
        putc('-', out);
    else if (strcmp(text, "true") == 0 || strcmp(text, "false") == 0)
        fputs(*text == 't' ? "yes" : "no", out);
    else if (end == text || *end != '\0')
        page_text(out, text);
    else if (strcmp(unit, "m2") == 0)
        fputs(shown_area(value), out);
    else
        fprintf(out, "%s%s", shown_number(whole, 4, unit), unit);
}

/* A cell of a line, which the next one follows: ends it and returns the rest. */
char *
page_end_cell(char *cell)
{
    char *rest = cell + strcspn(cell, "\t\n");

    if (*rest != '\0')
        *rest++ = '\0';
    return rest;
}

/* Writes the cell of a column in the last row of a report to `text`, and its unit to `unit`. False: the
 * report is empty or has no such column. */
bool
page_last_cell(struct page *run, const char *file, const char *column, char text[PAGE_CELL],
               char unit[PAGE_CELL])
{
    FILE *in = page_open(run, file);
    RC_OWNED char *line = NULL;
    size_t room = 0, at = SIZE_MAX;
    const size_t name = strlen(column);

    *text = '\0';
    for (size_t row = 0; getline(&line, &room, in) > 0; row++) {
        char *cell = line, *rest;

        for (size_t k = 0; *cell != '\0'; k++, cell = rest) {
            rest = page_end_cell(cell);
            if (row == 0 && strncmp(cell, column, name) == 0 &&
                (cell[name] == '/' || cell[name] == '\0')) {
                at = k;
                snprintf(unit, PAGE_CELL, "%s", cell[name] == '/' ? cell + name + 1 : "");
            }
            if (row > 0 && k == at)
                snprintf(text, PAGE_CELL, "%s", cell);
        }
    }
    fclose(in);
    return at != SIZE_MAX && *text != '\0';
}

bool
page_cell(struct page *run, const char *file, const char *column, const char *const where[][2],
          char text[PAGE_CELL])
{
    FILE *in = page_open(run, file);
    RC_OWNED char *line = NULL;
    char *head[PAGE_WORDS] = {NULL};
    RC_OWNED char *names = NULL;
    size_t room = 0;
    bool found = false;

    for (size_t row = 0; !found && getline(&line, &room, in) > 0; row++) {
        char *cell = row == 0 ? (names = strdup(line)) : line, *rest;
        size_t conditions = 0, met = 0;
        bool has = false;

        if (cell == NULL)
            tool_die(&run->t, "out of memory");
        for (size_t k = 0; k < PAGE_WORDS && *cell != '\0'; k++, cell = rest) {
            rest = page_end_cell(cell);
            if (row == 0) {
                head[k] = cell;
                cell[strcspn(cell, "/")] = '\0';
                continue;
            }
            for (size_t i = 0; head[k] != NULL && where[i][0] != NULL; i++)
                met += strcmp(head[k], where[i][0]) == 0 && strcmp(cell, where[i][1]) == 0;
            if (head[k] != NULL && strcmp(head[k], column) == 0) {
                has = true;
                snprintf(text, PAGE_CELL, "%s", cell);
            }
        }
        while (where[conditions][0] != NULL)
            conditions++;
        found = row > 0 && has && met == conditions;
    }
    fclose(in);
    return found;
}

double
page_last_number(struct page *run, const char *file, const char *column)
{
    char text[PAGE_CELL], unit[PAGE_CELL];

    return page_last_cell(run, file, column, text, unit) ? strtod(text, NULL) : NAN;
}

void
page_last(struct page *run, const char *file, const char *column)
{
    char text[PAGE_CELL], unit[PAGE_CELL];

    if (page_last_cell(run, file, column, text, unit))
        page_value(run->page.file, text, unit);
    else
        fputs("unknown", run->page.file);
}

static void
put_title(FILE *out, const char *column)
{
    const struct rc_figure *f = report_figure(column);

    if (f != NULL && f->title != NULL)
        page_text(out, f->title);
    else
        for (const char *c = column; *c != '\0'; c++)
            putc(*c == '_' ? ' ' : *c, out);
}

/* Shows these figures of the last row of a report, one below the other. */
void
page_show_figures(struct page *run, FILE *in, const char *columns, const char *unused)
{
    FILE *out = run->page.file;
    char word[PAGE_CELL], text[PAGE_CELL], unit[PAGE_CELL];

    (void)unused;
    if (is_empty(in)) {
        fputs("<p>This was not computed: see the messages under Accuracy.</p>\n", out);
        return;
    }
    fputs("<table>\n", out);
    for (const char *at = columns; *at != '\0'; at += strspn(at, " ")) {
        const size_t n = strcspn(at, " ");

        snprintf(word, sizeof word, "%.*s", (int)n, at);
        at += n;
        if (!page_last_cell(run, run->shown, word, text, unit) || strcmp(text, "NaN") == 0)
            continue;
        fputs("<tr><th>", out);
        put_title(out, word);
        fputs("</th><td>", out);
        page_value(out, text, unit);
        fputs("</td></tr>\n", out);
    }
    fputs("</table>\n", out);
}

/* Shows these columns of a report, if its last row has a value. */
void
page_show_table(struct page *run, FILE *in, const char *columns, const char *unused)
{
    FILE *out = run->page.file;
    char unit[PAGE_WORDS][PAGE_CELL], text[PAGE_CELL], other[PAGE_CELL];
    bool wanted[PAGE_WORDS] = {false};
    char *line = NULL, *rest;
    size_t room = 0;

    (void)unused;
    fputs("<table>\n", out);
    for (size_t row = 0; getline(&line, &room, in) > 0; row++) {
        char *cell = line;

        fputs("<tr>", out);
        for (size_t k = 0; k < PAGE_WORDS && *cell != '\0'; k++, cell = rest) {
            rest = page_end_cell(cell);
            if (row == 0) {
                const size_t n = strcspn(cell, "/");
                char name[PAGE_CELL];

                snprintf(name, sizeof name, " %.*s ", (int)n, cell);
                snprintf(unit[k], PAGE_CELL, "%s", cell[n] == '/' ? cell + n + 1 : "");
                cell[n] = '\0';
                wanted[k] = strstr(columns, name) != NULL &&
                            page_last_cell(run, run->shown, cell, text, other) &&
                            strcmp(text, "NaN") != 0;
            }
            if (!wanted[k])
                continue;
            fputs(row == 0 ? "<th>" : "<td>", out);
            if (row > 0)
                page_value(out, cell, unit[k]);
            else
                put_title(out, cell);
            fputs(row == 0 ? "</th>" : "</td>", out);
        }
        fputs("</tr>\n", out);
    }
    fputs("</table>\n", out);
    free(line);
}

/* The columns of the table of bars. */
enum bar_column {
    WHAT,
    CASE,
    NAME,
    UNIT,
    VALUE,
    SHARE,
    NOISE,
    DOMINANT,
    LIMIT,
    WHY,
    BAR_COLUMNS
};

/* Divides a line of the table of bars into cells: own[] has those of the columns, empty for NaN. The titles
 * of the first line set the places at[] of the columns. */
static void
split_bar(char *line, bool first, size_t at[BAR_COLUMNS], const char *own[BAR_COLUMNS])
{
    static const char *const names[BAR_COLUMNS] = {
        "what",         "case",           "name",     "unit",  "value",
        "bar_relative", "noise_relative", "dominant", "limit", "why"};
    char *cell[PAGE_WORDS] = {NULL};

    for (size_t k = 0; k < PAGE_WORDS && *line != '\0'; k++) {
        cell[k] = line;
        line += strcspn(line, "\t\n");
        if (*line != '\0')
            *line++ = '\0';
        for (size_t i = 0; first && i < BAR_COLUMNS; i++)
            at[i] = strcmp(cell[k], names[i]) == 0 ? k : at[i];
    }
    for (size_t i = 0; i < BAR_COLUMNS; i++)
        own[i] = cell[at[i]] == NULL || strcmp(cell[at[i]], "NaN") == 0 ? "" : cell[at[i]];
}

/* True for a figure of this case that has a bar, or a reason why it has none. */
static bool
is_bar(const char *const own[BAR_COLUMNS], const char *last)
{
    return strcmp(own[WHAT], "figure") == 0 && strcmp(own[CASE], last) == 0 &&
           strcmp(own[SHARE], "0") != 0 && (*own[SHARE] != '\0' || *own[WHY] != '\0');
}

/* A figure without a limit with the grid has only the part of the noise. */
static bool
has_limit(const char *const own[BAR_COLUMNS])
{
    return strcmp(own[LIMIT], "false") != 0;
}

static void
put_bar(FILE *out, const char *const own[BAR_COLUMNS])
{
    char name[PAGE_CELL];

    snprintf(name, sizeof name, "%s", own[NAME]);
    for (char *c = name; (c = strchr(c, '_')) != NULL;)
        *c = ' ';
    fputs("<tr><td>", out);
    page_text(out, name);
    fprintf(out, "</td><td>%.4g ", strtod(own[VALUE], NULL));
    page_text(out, own[UNIT]);
    fputs("</td><td>", out);
    if (*own[SHARE] != '\0')
        fputs(shown_percent(strtod(own[SHARE], NULL), 3), out);
    else if (!has_limit(own) && *own[NOISE] != '\0')
        fprintf(out, "noise alone %s", shown_percent(strtod(own[NOISE], NULL), 3));
    else
        putc('-', out);
    fputs("</td><td>", out);
    page_text(out, *own[SHARE] == '\0' ? "" : own[DOMINANT]);
    fputs("</td><td>", out);
    page_text(out, own[WHY]);
    fputs("</td></tr>\n", out);
}

/* Shows the figures of the last case that have a bar. Without a limit with the grid they have only the part
 * of the noise, and a note. */
void
page_show_bars(struct page *run, FILE *in, const char *a, const char *b)
{
    FILE *out = run->page.file;
    char *line = NULL;
    size_t room = 0, at[BAR_COLUMNS] = {0}, bars = 0, unlimited = 0;

    (void)a, (void)b;
    if (is_empty(in)) {
        fputs("<p>The bars were not computed: see the messages below.</p>\n", out);
        return;
    }
    fprintf(out,
            "<p>Noise of %s in the heights, and the grid, change the figures of the last "
            "load:</p>\n<table>\n"
            "<tr><th>figure</th><th>value</th><th>bar</th><th>mostly by</th><th></th></tr>\n",
            shown_in_unit(page_args.noise.v[0], "m"));
    for (size_t row = 0; getline(&line, &room, in) > 0; row++) {
        const char *own[BAR_COLUMNS];

        split_bar(line, row == 0, at, own);
        if (row == 0 || !is_bar(own, run->last))
            continue;
        bars += *own[SHARE] != '\0';
        unlimited += !has_limit(own);
        put_bar(out, own);
    }
    fputs("</table>\n", out);
    if (bars > 0)
        fputs("<p>In 90 % of the cases the value of the true surface is within the bar.</p>\n",
              out);
    if (unlimited > 0)
        fputs("<p>Noise alone: in 90 % of the cases the value of a scan with this spacing and "
              "without "
              "noise is within this range. A finer scan may have any other value.</p>\n",
              out);
    free(line);
}

void
page_show_bodies(struct page *run, FILE *in, const char *a, const char *b)
{
    const struct physics *p = &page_args.physics;
    FILE *out = run->page.file;

    (void)in, (void)a, (void)b;
    fprintf(out, "<p>The surface is pressed against a flat body. E* is %s",
            shown_in_unit(p->surface_estar, "Pa"));
    if (p->pair.one.layers > 0)
        fprintf(out, " at the surface of %zu layer%s", p->pair.one.layers,
                p->pair.one.layers == 1 ? "" : "s");
    if (!isnan(p->radius))
        fprintf(out, ", a sphere of radius %s is added", shown_in_unit(p->radius, "m"));
    if (!isnan(p->cylinder))
        fprintf(out, ", a cylinder of radius %s is added", shown_in_unit(p->cylinder, "m"));
    if (isfinite(p->hardness))
        fprintf(out, ", the hardness is %s", shown_in_unit(p->hardness, "Pa"));
    else
        fputs(", the bodies are elastic", out);
    fprintf(out, ", and the map %s.%s</p>\n",
            rc_repeats(p->boundary) == 2 ? "repeats without end"
            : p->boundary.x              ? "repeats along x"
            : p->boundary.y              ? "repeats along y"
                                         : "ends at its edges",
            run->assumed ? " No elasticity was given: these are values of steel on steel." : "");
}

/* The limits of all tools, as README has them. */
void
page_show_limits(struct page *run, FILE *in, const char *a, const char *b)
{
    (void)in, (void)a, (void)b;
    fputs("<ul>\n"
          "<li>Bodies are half-spaces with small slopes and small strains: thin bodies do not "
          "bend, and bodies "
          "have no side edges.</li>\n"
          "<li>No fluid film carries load. Temperatures do not change the contact, and metals do "
          "not creep. "
          "Wear depends on the sliding distance alone.</li>\n"
          "<li>No cantilever of an AFM: an approach is that of the bodies themselves, without the "
          "snap-in and snap-off of a soft spring.</li>\n"
          "<li>You choose the filters, the form and the threshold of spikes. A scan too coarse for "
          "its contact "
          "gets a warning; nothing is corrected behind your back.</li>\n</ul>\n",
          run->page.file);
}

void
page_show_messages(struct page *run, FILE *in, const char *a, const char *b)
{
    FILE *out = run->page.file;

    (void)in, (void)a, (void)b;
    if (run->said.size == 0) {
        fputs("<p>The tools gave no warnings.</p>\n", out);
        return;
    }
    fputs("<p>Warnings of the tools:</p>\n<pre>", out);
    page_text(out, run->said.text);
    fputs("</pre>\n", out);
}

void
page_show_commands(struct page *run, FILE *in, const char *a, const char *b)
{
    FILE *out = run->page.file;

    (void)in, (void)a, (void)b;
    fprintf(out,
            "<p>These commands of libcontact %s make the files of this page again.</p>\n"
            "<pre id=\"commands\">",
            rc_version());
    page_text(out, run->commands.text);
    fputs("</pre>\n", out);
}

/* Writes a command of another tool, with its files as they were given. */
static void
put_command(const struct page *run, const char *line)
{
    FILE *out = run->page.file;

    for (size_t k = 0; k < sizeof run->named / sizeof *run->named; k++) {
        const char *path = run->named[k].path, *at = path == NULL ? NULL : strstr(line, path);
        if (at == NULL)
            continue;
        RC_OWNED char *before = strndup(line, (size_t)(at - line));
        page_text(out, before == NULL ? "" : before);
        page_text(out, run->named[k].given);
        line = at + strlen(path);
    }
    page_text(out, line);
}

static void
put_verdict(FILE *out, const char *title, const char *verdict)
{
    fputs("<tr><th>", out);
    page_text(out, title);
    fputs("</th><td>", out);
    page_text(out, verdict);
    fputs("</td></tr>\n", out);
}

/* Shows the verdicts of rc-scene: the lines of effects, indented by two blanks, with their commands, indented
 * further, and what is missing. Expected times depend on the machine and are left out. The sentence of an
 * effect that cannot be judged follows its title after one blank, verdicts begin in a column of their own. */
void
page_show_effects(struct page *run, FILE *in, const char *a, const char *b)
{
    enum {
        TITLE = 33 /* the verdict begins here */
    };
    static const char unjudged[] = " cannot be judged: ";
    FILE *out = run->page.file;
    RC_OWNED char *line = NULL;
    RC_OWNED char *missing = NULL;
    size_t room = 0, lines = 0;
    char *end;

    (void)a, (void)b;
    fprintf(out, "<p>By how much each effect would change the elastic contact under %s.</p>\n",
            run->loads > 1 ? "the last load" : "this load");
    fputs("<table id=\"effects\">\n", out);
    for (ssize_t n; (n = getline(&line, &room, in)) > 0; lines++) {
        line[n - 1] = '\0';
        if ((end = strstr(line, "   (about ")) != NULL)
            *end = '\0';
        if (strncmp(line, "  data missing: ", 16) == 0) {
            missing = strdup(line + 16);
        } else if (strncmp(line, "      ", 6) == 0) {
            fputs("<tr><td></td><td><pre>", out);
            put_command(run, line + 6);
            fputs("</pre></td></tr>\n", out);
        } else if (lines > 0 && (end = strstr(line, unjudged)) != NULL) {
            *end = '\0';
            put_verdict(out, line + 2, end + 1);
        } else if (lines > 0 && n > TITLE) {
            line[TITLE - 1] = '\0';
            for (char *c = line + TITLE - 2; c > line && *c == ' '; c--)
                *c = '\0';
            put_verdict(out, line + 2, line + TITLE);
        }
    }
    fputs("</table>\n", out);
    if (lines == 0)
        fputs("<p>rc-scene has no verdicts on this contact: see its message.</p>\n", out);
    if (missing != NULL) {
        fputs("<p>Data are missing for: ", out);
        page_text(out, missing);
        fputs(".</p>\n", out);
    }
}
