/* SPDX-License-Identifier: GPL-3.0-or-later */

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "tools/info/info.h"

static struct args {
    bool json, spread;
    struct info_wanted wanted;
} args = {.wanted.sections = 5};

#define AT(field) .at = offsetof(struct args, field)
/* clang-format off */
static const struct opt opts[] = {
    {.name = "json", .type = OPT_FLAG, AT(json), .help = "one JSON object per frame and line, in SI"},
    {.name = "areal", .type = OPT_FLAG, AT(wanted.areal),
     .help = "for heights: parameters of ISO 25178-2, for profiles of ISO 21920-2"},
    {.name = "smr", .type = OPT_NUMBERS, .unit = UNIT_M, AT(wanted.smr), .min = -INFINITY,
     .max = INFINITY, .arg = "LIST",
     .help = "material ratio at heights above the mean (includes --areal)"},
    {.name = "profile", .type = OPT_TEXT, AT(wanted.profile), .arg = "LINE",
     .help = "parameters of ISO 21920-2 along rows, columns, an angle in degrees, or X0,Y0:X1,Y1"},
    {.name = "sections", .type = OPT_COUNT, AT(wanted.sections), .min = 1, .max = 1000, .arg = "N",
     .needs = RULES({.with = "profile"}),
     .help = "section lengths of a profile (default 5)"},
    {.name = "report", .type = OPT_REPORT, AT(wanted.report), .arg = "FILE",
     .help = "one row per frame, as JSON, .tsv or .csv, instead of text"},
    {.name = "spread", .type = OPT_FLAG, AT(spread),
     .help = "instead of the frames, mean and standard error of each figure over all of them"},
    {.name = "psd", .type = OPT_FLAG, AT(wanted.psd),
     .help = "for heights: radially averaged power spectral density, Hurst exponent"},
    {.name = "fit", .type = OPT_NUMBERS, .unit = UNIT_M, AT(wanted.fit), .min = 0, .max = INFINITY,
     .above = true, .arg = "LMIN,LMAX",
     .help = "range of wavelengths for the fit of the Hurst exponent (--psd)"},
    {.name = "window", .type = OPT_CHOICE, AT(wanted.window), .words = rc_window_name, .arg = "NAME",
     .help = "window of the spectrum: %s (--psd; default hann, periodic: none)"},
    {.name = "psd-map", .type = OPT_TEXT, AT(wanted.psd_map), .arg = "FILE",
     .help = "write the two-dimensional spectrum, a frame psd, to FILE (--psd)"},
    {.name = "patches", .type = OPT_FLAG, AT(wanted.patches),
     .help = "for pressures: contact patches, corrected area, perimeter, histogram"},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-info",
    .summary = "Show the contents of a grid stream, with statistics",
    .operands = "[FILE...]",
    .examples = "  rc-info flat.rcg\n"
                "  rc-info --areal --psd flat.rcg\n"
                "  rc-solve --load 240N --estar 116GPa flat.rcg | rc-info --json --patches\n",
    .opts = opts,
    .figures =
        (const char *const[]){"statistics", "areal", "features", "profile", "psd", "patches", NULL},
    .reads = READS_STREAM,
    .writes = WRITES_TEXT,
};

static bool
in_metres(const struct rc_grid *g)
{
    return strcmp(rc_grid_dunit(g), "m") == 0;
}

static bool
is_height(const struct rc_grid *g)
{
    return strcmp(g->channel, "height") == 0 && in_metres(g);
}

/* ---- results: figures of a pressure ---- */

struct result { /* NAN: unknown */
    double load, contact_nodes, contact_area, contact_fraction, max_pressure, approach;
    double hardness, plastic_area;
    size_t plastic_nodes;
    const char *converged; /* "yes", "no"; NULL: unknown */
    bool separated;
};

#define FIGURE(member) RC_FIGURE(struct result, member)
static const struct rc_figure results[] = {
    {FIGURE(load), "N"},        {FIGURE(contact_nodes)}, {FIGURE(contact_area), "m2"},
    {FIGURE(contact_fraction)}, {FIGURE(max_pressure)},  {FIGURE(approach), "m"},
    {FIGURE(hardness), "Pa"},   {FIGURE(plastic_area)},  {0}};

static bool
is_pressure(const struct rc_grid *g)
{
    return strcmp(g->channel, "pressure") == 0 && strcmp(g->unit, "Pa") == 0 && in_metres(g);
}

/* Numbers of values of a frame. */
struct counts {
    size_t positive, wrong, plastic; /* wrong: neither 0 nor 1; plastic: at least the hardness */
    double negative;
    bool touches;    /* the contact is known: */
    size_t touching; /* nodes in contact      */
};

/* Load and contact are computed from the values, so that they are right for any program that wrote them. */
static void
result_of(const struct rc_grid *g, const struct counts *c, const struct rc_statistics *s,
          struct result *r)
{
    const char *converged = rc_grid_get(g, "converged");
    const double cell = g->dx * g->dy;

    *r = (struct result){NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, 0, NULL, false};
    rc_grid_number(g, "approach", &r->approach);
    rc_grid_number(g, "hardness", &r->hardness);
    if (converged != NULL && (strcmp(converged, "yes") == 0 || strcmp(converged, "no") == 0))
        r->converged = converged;
    r->separated = map_says(g, "separated", "yes");
    if (s->missing > 0 || s->infinite > 0)
        return;
    r->plastic_nodes = c->plastic;
    r->load = s->sum * cell;
    r->max_pressure = s->maximum;
    if (c->touches) {
        r->contact_nodes = (double)c->touching;
        r->contact_area = cell * r->contact_nodes;
        r->contact_fraction = r->contact_nodes / ((double)g->nx * (double)g->ny);
    }
    if (!isnan(r->hardness))
        r->plastic_area = cell * (double)r->plastic_nodes;
}

/* ---- JSON ---- */

static void
put_result_object(struct report *r, const struct result *v)
{
    report_object(r, "result");
    report_table(r, results, v);
    if (v->converged == NULL)
        report_text(r, "converged", NULL);
    else
        report_bool(r, "converged", strcmp(v->converged, "yes") == 0);
    report_end(r);
}

static void
show_json(struct tool *t, const struct rc_grid *g, const struct rc_statistics *s,
          const struct counts *c, const struct info_figures *f)
{
    struct report r = {.tool = t, .name = "--json", .file = t->output.file};
    struct rc_statistics shown = *s;
    struct result result;

    if (!is_height(g))
        shown.rms_slope = NAN;
    report_begin(&r);
    report_count(&r, "case", rc_grid_case(g), NULL);
    report_count(&r, "frame", t->input.frame, NULL);
    report_text(&r, "channel", g->channel);
    report_count(&r, "nx", g->nx, NULL);
    report_count(&r, "ny", g->ny, NULL);
    report_number(&r, "dx", g->dx, NULL);
    report_number(&r, "dy", g->dy, NULL);
    report_text(&r, "dunit", rc_grid_dunit(g));
    report_text(&r, "unit", g->unit);
    report_text(&r, "type", g->type == RC_F32 ? "f32" : "f64");
    report_table(&r, rc_figures("statistics"), &shown);
    if (is_pressure(g)) {
        result_of(g, c, s, &result);
        put_result_object(&r, &result);
    }
    report_object(&r, "keys");
    for (size_t k = 0; k < g->keys; k++)
        report_text(&r, g->key[k].name, g->key[k].value);
    report_end(&r);
    info_json(&r, &args.wanted, f);
    report_finish_row(&r);
}

/* ---- text ---- */

/* Prints a line of text from the data. */
static void
put_text(FILE *out, const char *text, size_t n)
{
    shown_words(out, text, n);
    putc('\n', out);
}

static void
put_figure(FILE *out, const char *name, double value, const char *unit)
{
    fprintf(out, "  %-10s ", name);
    if (isnan(value)) {
        fputs("unknown\n", out);
        return;
    }
    fputs(shown_number(value, 6, unit), out);
    put_text(out, unit, strlen(unit));
}

static void
put_result(FILE *out, const struct rc_grid *g, const struct result *r)
{
    if (!isnan(r->load))
        put_figure(out, "load", r->load, "N");
    if (!isnan(r->contact_area)) {
        fprintf(out, "  %-10s %s, %.3g %% of the map (%.0f of %zu nodes)\n", "contact",
                shown_area(r->contact_area), 100 * r->contact_fraction, r->contact_nodes,
                g->nx * g->ny);
    } else if (!isnan(r->load)) {
        fprintf(out, "  %-10s unknown\n", "contact");
    }
    if (!isnan(r->max_pressure))
        fprintf(out, "  %-10s at most %sPa\n", "pressure", shown_number(r->max_pressure, 6, "Pa"));
    if (!isnan(r->approach))
        put_figure(out, "approach", r->approach, "m");
    if (!isnan(r->hardness)) {
        fprintf(out, "  %-10s %sPa", "hardness", shown_number(r->hardness, 6, "Pa"));
        if (r->plastic_nodes > 0)
            fprintf(out, ", reached on %s (%zu node%s)", shown_area(r->plastic_area),
                    r->plastic_nodes, r->plastic_nodes == 1 ? "" : "s");
        fprintf(out, "%s\n", r->plastic_area == 0 ? ", not reached" : "");
    }
    if (r->separated)
        fprintf(out, "  %-10s %s\n", "separated", "yes: the bodies exert no force");
    else if (r->converged != NULL)
        fprintf(out, "  %-10s %s\n", "converged",
                strcmp(r->converged, "yes") == 0 ? "yes" : "no: it stopped short of its accuracy");
}

/* The unit is text from the data. */
static void
put_length(FILE *out, const char *number, const char *unit)
{
    fputs(number, out);
    shown_words(out, unit, strlen(unit));
}

static void
put_grid(FILE *out, const struct rc_grid *g)
{
    const char *unit = rc_grid_dunit(g);

    fprintf(out, "  %-10s %zu x %zu nodes, dx ", "grid", g->nx, g->ny);
    put_length(out, shown_number(g->dx, 6, unit), unit);
    fputs(", dy ", out);
    put_length(out, shown_number(g->dy, 6, unit), unit);
    fprintf(out, "\n  %-10s ", "size");
    put_length(out, shown_number((double)g->nx * g->dx, 6, unit), unit);
    fputs(" x ", out);
    put_length(out, shown_number((double)g->ny * g->dy, 6, unit), unit);
    putc('\n', out);
    fprintf(out, "  %-10s %s\n", "type", g->type == RC_F32 ? "f32" : "f64");
}

static void
put_statistics(FILE *out, const struct rc_grid *g, const struct rc_statistics *s)
{
    double nodes = (double)g->nx * (double)g->ny;

    put_figure(out, "minimum", s->minimum, g->unit);
    put_figure(out, "maximum", s->maximum, g->unit);
    put_figure(out, "mean", s->mean, g->unit);
    put_figure(out, "rms", s->rms, g->unit);
    if (is_height(g))
        put_figure(out, "rms slope", s->rms_slope, "");
    if (s->missing > 0)
        fprintf(out, "  %-10s %zu (%.3g %%)\n", "missing", s->missing,
                100 * (double)s->missing / nodes);
    if (s->infinite > 0)
        fprintf(out, "  %-10s %zu (%.3g %%)\n", "infinite", s->infinite,
                100 * (double)s->infinite / nodes);
}

/* One step per line. */
static void
put_history(FILE *out, const char *history)
{
    const char *name = "history";

    while (history != NULL) {
        const char *next = strstr(history, " | ");
        fprintf(out, "  %-10s ", name);
        put_text(out, history, next == NULL ? strlen(history) : (size_t)(next - history));
        history = next == NULL ? NULL : next + 3;
        name = "";
    }
}

static void
put_keys(FILE *out, const struct rc_grid *g)
{
    const char *name = "keys";

    for (size_t k = 0; k < g->keys; k++) {
        const struct rc_key *key = &g->key[k];
        if (strcmp(key->name, "history") == 0 || strcmp(key->name, "case") == 0)
            continue;
        fprintf(out, "  %-10s %s=", name, key->name);
        put_text(out, key->value, strlen(key->value));
        name = "";
    }
    put_history(out, rc_grid_get(g, "history"));
}

static void
show_text(struct tool *t, const struct rc_grid *g, const struct rc_statistics *s,
          const struct counts *c, const struct info_figures *f, bool first)
{
    struct result result;

    fprintf(t->output.file, "%s", first ? "" : "\n");
    put_text(t->output.file, tool_where(t, g), WHERE);
    if (is_pressure(g)) {
        result_of(g, c, s, &result);
        put_result(t->output.file, g, &result);
    }
    put_grid(t->output.file, g);
    put_statistics(t->output.file, g, s);
    info_text(&args.wanted, f, t->output.file);
    put_keys(t->output.file, g);
}

/* ---- rows ---- */

/* The values of a frame, from memory or from its file, in two passes. */
struct values {
    struct tool *t;
    const struct rc_grid *g;
    size_t pass, row;
    double most, hardness; /* most: the largest value, at least 0 */
    struct counts *counts; /* NULL: nobody needs them */
};

static enum rc_status
again(void *of, struct rc_err *err)
{
    struct values *v = of;

    (void)err;
    if (v->pass++ > 0 && !tool_has_values(v->g))
        tool_read_again(v->t);
    v->row = 0;
    return RC_OK;
}

static enum rc_status
next_rows(void *of, size_t rows, double *to, struct rc_err *err)
{
    struct values *v = of;
    const size_t n = rows * v->g->nx;

    (void)err;
    if (tool_has_values(v->g))
        memcpy(to, v->g->v + v->row * v->g->nx, n * sizeof *to);
    else
        tool_read_rows(v->t, rows, to);
    v->row += rows;
    for (size_t k = 0; k < n && v->counts != NULL && v->pass == 1; k++) {
        v->counts->positive += rc_in_contact(to[k]);
        v->counts->wrong += to[k] != 0 && to[k] != 1;
        v->counts->plastic += to[k] >= v->hardness;
        v->most = fmax(v->most, to[k]);
    }
    for (size_t k = 0; k < n && v->counts != NULL && v->pass > 1; k++)
        v->counts->negative += contact_negative(to[k], v->most);
    return RC_OK;
}

/* True for a frame that may define the contact. */
static bool
touches(const struct rc_grid *g)
{
    return strcmp(g->channel, "pressure") == 0 || strcmp(g->channel, CONTACT_CHANNEL) == 0;
}

/* True if all that is asked for needs some rows at a time. */
static bool
works_by_rows(const struct tool *t, const struct rc_grid *g)
{
    const struct info_wanted *w = &args.wanted;
    const bool whole = strcmp(g->channel, "height") == 0 ? w->areal || w->psd || w->profile != NULL
                                                         : w->patches && touches(g);

    return !whole && tool_reads_file(t);
}

static void
measure(struct tool *t, struct rc_grid *g, struct rc_statistics *statistics, struct counts *counts)
{
    struct values v = {.t = t, .g = g, .hardness = NAN};
    const struct rc_row_source source = {&v, again, next_rows, NULL};

    *counts = (struct counts){0};
    if (touches(g))
        v.counts = counts;
    rc_grid_number(g, "hardness", &v.hardness);
    if (g->type == RC_F32) /* the resolution of single precision */
        v.hardness = (double)(float)v.hardness;
    if (!works_by_rows(t, g))
        tool_load(t, g);
    tool_must(t, g, rc_measure_source(rc_shape_of(g), &source, statistics, &t->err));
}

/* The last frame `contact` with its numbers, and the last case whose pressure was shown without one (0:
 * none), with its number of nodes in contact. */
struct beside {
    struct rc_grid *contact;
    struct counts counts;
    size_t without, nodes;
};

/* The frame that defines the contact of this one: `contact` earlier in its case, or the pressure itself.
 * NULL: unknown, or it is not a pressure. */
static const struct rc_grid *
touching(struct tool *t, const struct rc_grid *g, struct counts *c, struct beside *b)
{
    const struct rc_grid *touch;

    if (b->contact != NULL && rc_grid_case(b->contact) != rc_grid_case(g)) {
        rc_grid_free(b->contact);
        b->contact = NULL;
    }
    if (strcmp(g->channel, CONTACT_CHANNEL) == 0 && b->without == rc_grid_case(g) &&
        b->nodes != c->positive)
        tool_refuse(t, g,
                    "%zu nodes are in contact according to this frame, %zu according to the "
                    "pressure before it: the frame contact must precede its pressure",
                    c->positive, b->nodes);
    if (strcmp(g->channel, "pressure") != 0)
        return NULL;
    touch = contact_counted(t, g, b->contact, args.wanted.patches, b->counts.wrong, c->negative);
    c->touches = touch != NULL;
    c->touching = touch == NULL ? 0 : touch == g ? c->positive : b->counts.positive;
    if (b->contact == NULL) {
        b->without = rc_grid_case(g);
        b->nodes = c->touching;
    }
    return touch;
}

/* Frees a frame that has been shown, unless a later pressure may need it. */
static void
let_go(struct rc_grid *g, const struct counts *counts, struct beside *beside)
{
    if (strcmp(g->channel, CONTACT_CHANNEL) != 0) {
        rc_grid_free(g);
        return;
    }
    rc_grid_free(beside->contact);
    beside->contact = g;
    beside->counts = *counts;
}

static void
show_spread(struct tool *t, const struct info_spread *spread)
{
    struct report r = {.tool = t, .name = "--json", .file = t->output.file, .of_all = true};

    if (args.json)
        info_spread_json(spread, &r);
    else
        info_spread_text(spread, t->output.file);
}

int
main(int argc, char **argv)
{
    static struct info_spread spread;
    struct rc_statistics statistics;
    struct info_figures figures;
    struct counts counts;
    struct beside beside = {0};
    struct rc_grid *g;
    struct tool t;
    bool first = true;

    tool_start(&t, &info, argc, argv, &args);
    info_check(&args.wanted, &t);
    if (args.spread && t.output.report_alone)
        tool_usage(&t, "--spread prints on standard output, and so does --report -: give --report "
                       "a file");
    tool_by_rows(&t);
    while ((g = tool_read(&t)) != NULL) {
        const struct rc_grid *touch;

        measure(&t, g, &statistics, &counts);
        touch = touching(&t, g, &counts, &beside);
        if (is_height(g) && strcmp(g->unit, "m") == 0)
            tool_judge_slope(&t, tool_where(&t, g), statistics.rms_slope,
                             "if a unit is wrong, import the file again with --z-unit");
        info_compute(&args.wanted, &t, g, touch, &figures);
        info_report(&args.wanted.out, &args.wanted, &figures, &statistics);
        if (args.spread)
            info_spread_take(&spread, &args.wanted, &figures, &statistics);
        else if (args.json && !t.output.report_alone)
            show_json(&t, g, &statistics, &counts, &figures);
        else if (args.wanted.report == NULL)
            show_text(&t, g, &statistics, &counts, &figures, first);
        first = false;
        info_free(&figures);
        let_go(g, &counts, &beside);
    }
    rc_grid_free(beside.contact);
    info_end(&args.wanted, &t);
    if (args.spread)
        show_spread(&t, &spread);
    return tool_finish(&t);
}
