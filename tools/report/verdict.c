/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The first paragraph: the contact and the effects in words, and what limits the trust in them. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "page.h"

/* The first paragraph of a contact in words: area, pressure, what yields, the error. */
static void
put_contact(struct page *run)
{
    static const char loads[] = "loads.tsv";
    const struct physics *p = &page_args.physics;
    FILE *out = run->page.file;
    const double bound = page_last_number(run, loads, "plastic_area"),
                 area = page_last_number(run, loads, "contact_area");
    const double stress = json_real(json_member(run->stress, "max.mises.value")),
                 depth = json_real(json_member(run->stress, "max.mises.depth"));
    const double fraction = page_last_number(run, loads, "contact_fraction");

    fputs("Under a load of ", out);
    page_last(run, loads, "load");
    fputs(", a mean pressure of ", out);
    page_last(run, loads, "mean_pressure");
    fprintf(out, ", the bodies touch on %s of the map, ", shown_percent(fraction, 3));
    page_last(run, loads, "contact_area");
    fputs(". The largest pressure is ", out);
    page_last(run, loads, "max_pressure");
    if (isfinite(p->hardness) && bound > 0)
        fprintf(out, ": the hardness, at which %s of the contact yields. ",
                shown_percent(bound / area, 3));
    else if (isfinite(p->hardness))
        fputs(", below the hardness: nothing yields at the surface. ", out);
    else
        fputs("; the bodies are elastic, and no hardness limits it. ", out);
    if (!isnan(stress)) {
        fprintf(out, "Below it the largest Mises stress is %sPa", shown_number(stress, 4, "Pa"));
        if (depth > 0)
            fprintf(out, ", %sm deep", shown_number(depth, 3, "m"));
        if (!(run->yield > 0))
            fputs(": a material with a lower yield stress yields there. ", out);
        else
            fprintf(out, ", %.3g times the yield stress of %s: %s. ", stress / run->yield,
                    shown_in_unit(run->yield, "Pa"),
                    stress > run->yield ? "the volume yields, which these figures do not include"
                                        : "the volume stays elastic");
    }
    fprintf(out, "The estimated error of the solution on this grid, in the pressure, is %s.\n",
            shown_percent(page_last_number(run, loads, "pressure_error_estimate"), 2));
}

/* Errors and bars above this share are named. */
static const double share = 0.1;
static const double few = 100; /* nodes in contact: below it only their number is named */

/* Begins the sentence of limits, or separates the next one. */
static void
begin_limit(FILE *out, size_t *n)
{
    fputs((*n)++ == 0 ? "What limits the trust in these figures: " : "; ", out);
}

/* What limits the trust in the contact by the figures of its report, each in some words. */
static void
put_contact_limits(struct page *run, size_t *n)
{
    static const char loads[] = "loads.tsv";
    const double nodes = page_last_number(run, loads, "contact_nodes"),
                 patch = page_last_number(run, loads, "nodes_per_patch"),
                 edge = page_last_number(run, loads, "edge_load_fraction"),
                 slope = page_last_number(run, loads, "rms_slope");
    char text[PAGE_CELL], unit[PAGE_CELL];
    const struct {
        bool holds;
        const char *format, *value;
    } limit[] = {
        {page_last_cell(run, loads, "converged", text, unit) && strcmp(text, "false") == 0,
         "the solver stopped before its tolerance", ""},
        {nodes < few, "only %s nodes touch, so that the grid decides", shown_number(nodes, 2, "")},
        {nodes >= few && patch < 4, "a contact patch has only %s nodes, so that the grid decides",
         shown_number(patch, 2, "")},
        {rc_repeats(page_args.physics.boundary) == 0 && edge > 0.01,
         "the edge of the map carries %s of the load, so that a larger map has another result",
         shown_percent(edge, 3)},
        {slope > 0.3,
         "the RMS slope where the bodies touch is %s, beyond the theory of small slopes",
         shown_number(slope, 2, "")},
        {page_last_number(run, loads, "max_pressure") > page_args.physics.surface_estar / 10,
         "the largest pressure is beyond a tenth of E*, where strains are not small", ""},
        {page_args.relaxation != NULL && page_has_readers(run),
         "the sections of other effects are those of the contact before creep", ""},
        {run->assumed, "no elasticity was given, so that the values are those of steel on steel",
         ""},
    };

    for (size_t k = 0; k < sizeof limit / sizeof *limit; k++)
        if (limit[k].holds) {
            begin_limit(run->page.file, n);
            fprintf(run->page.file, limit[k].format, limit[k].value);
        }
}

/* The tool has failed. */
static bool
is_missing(struct page *run, const char *file)
{
    FILE *in = page_open(run, file);
    const bool empty = getc(in) == EOF;

    fclose(in);
    return empty;
}

/* True if rc-scene has judged the contact. */
static bool
has_verdicts(struct page *run)
{
    for (size_t k = 0; k < page_part_count; k++)
        if (page_parts[k].show == page_show_effects)
            return page_is_wanted(run, &page_parts[k]) && !is_missing(run, page_parts[k].file);
    return false;
}

/* The change by a finer grid, of rc-scene, but for few nodes, which put_contact_limits names. False: it is
 * not known. */
static bool
put_grid_limit(struct page *run, size_t *n)
{
    static const char table[] = "effects.tsv";
    static const char *const grid[][2] = {{"effect", "grid"}, {NULL}};
    FILE *out = run->page.file;
    char figure[PAGE_CELL], cell[PAGE_CELL];
    double high;

    if (!has_verdicts(run) || !page_cell(run, table, "high", grid, cell) ||
        !page_cell(run, table, "figure", grid, figure))
        return false;
    high = strtod(cell, NULL);
    if (high <= share || page_last_number(run, "loads.tsv", "contact_nodes") < few)
        return true;
    begin_limit(out, n);
    for (char *c = figure; (c = strchr(c, '_')) != NULL;)
        *c = ' ';
    if (!isfinite(high))
        fprintf(out, "the change of the %s by a finer grid is unknown", figure);
    else if (high < 10)
        fprintf(out, "a finer grid changes the %s by up to %s", figure, shown_percent(high, 2));
    else
        fprintf(out, "a finer grid changes the %s by up to %.2g times", figure, high);
    return true;
}

static const char ending[] = "_error_estimate";

/* The largest estimated error of a report, over all rows, and its column. 0: it has none. */
static double
largest_error(struct page *run, const char *file, char column[PAGE_CELL])
{
    FILE *in = page_open(run, file);
    RC_OWNED char *line = NULL;
    char wanted[PAGE_WORDS][PAGE_CELL] = {""};
    size_t room = 0;
    double largest = 0;

    for (size_t row = 0; getline(&line, &room, in) > 0; row++) {
        char *cell = line, *rest;

        for (size_t k = 0; k < PAGE_WORDS && *cell != '\0'; k++, cell = rest) {
            rest = page_end_cell(cell);
            if (row > 0 && wanted[k][0] != '\0' && strtod(cell, NULL) > largest) { /* no NaN */
                largest = strtod(cell, NULL);
                memcpy(column, wanted[k], PAGE_CELL);
            } else if (row == 0 && strlen(cell) > strlen(ending) &&
                       strcmp(cell + strlen(cell) - strlen(ending), ending) == 0)
                snprintf(wanted[k], PAGE_CELL, "%s", cell);
        }
    }
    fclose(in);
    return largest;
}

/* " of the largest pressure": what an estimated error belongs to, from its title or that of its figure. */
static void
put_owner(FILE *out, const char *column)
{
    static const char error[] = "Error";
    const struct rc_figure *f = report_figure(column),
                           *of = f == NULL || f->of == NULL ? NULL : report_figure(f->of);

    if (f != NULL && strncmp(f->title, error, strlen(error)) == 0) {
        page_text(out, f->title + strlen(error));
    } else if (of != NULL) {
        fprintf(out, " of the %c", tolower((unsigned char)of->title[0]));
        page_text(out, of->title + 1);
    } else
        fprintf(out, " %.*s", (int)(strlen(column) - strlen(ending)), column);
}

/* The sections whose reports have a large estimated error. */
static void
put_errors(struct page *run, size_t *n)
{
    const char *heading = "";
    size_t errors = 0;

    for (size_t k = 0; k < page_part_count; k++) {
        const struct page_part *part = &page_parts[k];
        char column[PAGE_CELL];
        double error;

        if (part->heading != NULL)
            heading = part->heading;
        if ((part->show != page_show_figures && part->show != page_show_table) ||
            !page_is_wanted(run, part) ||
            !((error = largest_error(run, part->file, column)) > share))
            continue;
        if (errors++ == 0)
            begin_limit(run->page.file, n);
        fputs(errors == 1 ? "the estimated error" : ", that", run->page.file);
        put_owner(run->page.file, column);
        fprintf(run->page.file, " is %s under %s", shown_percent(error, 3), heading);
        if (part->wide != NULL && strcmp(part->wide, column) == 0)
            fprintf(run->page.file, " (%s)", part->covers);
    }
}

static const char bars[] = "bars.tsv";

/* A figure without a limit with the grid: the part of the noise is known. */
static void
put_unlimited(struct page *run, const char *title, const char *const row[][2])
{
    FILE *out = run->page.file;
    char text[PAGE_CELL];

    fprintf(out, "the %s has no bar: ", title);
    if (page_cell(run, bars, "why", row, text))
        page_text(out, text);
    if (page_cell(run, bars, "noise_relative", row, text) && strcmp(text, "NaN") != 0)
        fprintf(out, " (noise alone changes it by %s)", shown_percent(strtod(text, NULL), 3));
}

/* The bars of the figures of this paragraph. False: they were asked for and are not there. */
static bool
put_bars(struct page *run, size_t *n)
{
    static const struct {
        const char *name, *title;
    } figure[] = {{"max_pressure", "largest pressure"}, {"contact_area", "contact area"}};
    char text[PAGE_CELL];

    if (page_args.noise.n == 0)
        return true;
    for (size_t k = 0; k < sizeof figure / sizeof *figure; k++) {
        const char *const row[][2] = {
            {"what", "figure"}, {"case", run->last}, {"name", figure[k].name}, {NULL}};
        if (!page_cell(run, bars, "bar_relative", row, text))
            return false;
        const double bar = strtod(text, NULL);
        if (bar <= share)
            continue;
        begin_limit(run->page.file, n);
        if (!isnan(bar))
            fprintf(run->page.file, "the bar of the %s is %s", figure[k].title,
                    shown_percent(bar, 3));
        else if (page_cell(run, bars, "limit", row, text) && strcmp(text, "false") == 0)
            put_unlimited(run, figure[k].title, row);
        else {
            fprintf(run->page.file, "the bar of the %s is unknown", figure[k].title);
            if (page_cell(run, bars, "why", row, text) && strcmp(text, "NaN") != 0) {
                fputs(": ", run->page.file);
                page_text(run->page.file, text);
            }
        }
    }
    return true;
}

static bool
is_inaccurate(struct page *run, const char *file)
{
    static const char *const short_of[][2] = {{"converged", "false"}, {NULL}};
    char cell[PAGE_CELL];

    return page_cell(run, file, "converged", short_of, cell);
}

/* The sections of effects whose report is such, as "Travel, Wear". */
static const char *
name_sections(struct page *run, bool (*is_such)(struct page *run, const char *file),
              char text[PAGE_CELL])
{
    const char *heading = "";
    size_t n = 0;

    text[0] = '\0';
    for (size_t k = 0; k < page_part_count; k++) {
        const struct page_part *part = &page_parts[k];

        if (part->heading != NULL)
            heading = part->heading;
        if (part->needs != NULL && part->command == NULL && page_is_wanted(run, part) &&
            n < PAGE_CELL && is_such(run, part->file))
            n += (size_t)snprintf(text + n, PAGE_CELL - n, "%s%s", n > 0 ? ", " : "", heading);
    }
    return text;
}

/* What limits the trust in the contact and in the effects. */
static void
put_limits(struct page *run)
{
    char sections[PAGE_CELL];
    FILE *out = run->page.file;
    size_t n = 0;
    bool judged;

    if (*name_sections(run, is_inaccurate, sections) != '\0') {
        begin_limit(out, &n);
        fprintf(out, "the requested accuracy was not reached under %s", sections);
    }
    if (*name_sections(run, is_missing, sections) != '\0') {
        begin_limit(out, &n);
        fprintf(out, "not computed: %s", sections);
    }
    put_contact_limits(run, &n);
    judged = put_grid_limit(run, &n);
    put_errors(run, &n);
    if (!put_bars(run, &n)) {
        begin_limit(out, &n);
        fputs("the bars of the measurement were not computed", out);
    }
    if (n == 0)
        fprintf(out,
                "The checks of the edges and the slopes found nothing that limits these figures, "
                "and no estimated error%s is above %.0f %%; %s",
                judged ? " or change by a finer grid" : "", 100 * share,
                page_args.noise.n > 0 ? "the bars under Accuracy are those of the measurement"
                                      : "--noise adds bars for the measurement");
    fputs(".\n", out);
}

void
page_show_verdict(struct page *run, FILE *in, const char *a, const char *b)
{
    FILE *out = run->page.file;
    char text[PAGE_CELL], unit[PAGE_CELL];

    (void)in, (void)a, (void)b;
    fputs("<p id=\"verdict\">", out);
    put_contact(run);
    for (size_t k = 0; k < page_part_count; k++) {
        const char *says = page_parts[k].says, *at;

        if (says == NULL || !page_is_wanted(run, &page_parts[k]) ||
            !page_last_cell(run, page_parts[k].file, page_parts[k].figure, text, unit) ||
            strcmp(text, "NaN") == 0)
            continue;
        if (strcmp(text, "false") == 0 || strcmp(text, "no") == 0)
            says = page_parts[k].denies != NULL ? page_parts[k].denies : says;
        at = strstr(says, "%s");
        fprintf(out, "%.*s", at == NULL ? (int)strlen(says) : (int)(at - says), says);
        if (at != NULL)
            page_value(out, text, unit);
        fprintf(out, "%s\n", at == NULL ? "" : at + 2);
    }
    put_limits(run);
    fputs("</p>\n", out);
}
