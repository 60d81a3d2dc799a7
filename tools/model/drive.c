/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A tool with a model has points, frames, a report, warnings and --dry-run. */
#include "model.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"
#include "tools/frames/frames.h"

#define AT(field) .at = offsetof(struct drive_args, field)
/* clang-format off */
const struct opt drive_options[] = {
    {.name = "report", .type = OPT_REPORT, AT(report), .arg = "FILE",
     .help = "write one JSON object per case, or a row of FILE.tsv or .csv: figures, accuracy, cost"},
    {.name = "checkpoint", .type = OPT_TEXT, AT(checkpoint), .arg = "FILE",
     .help = "store the states reached in FILE, to continue an interrupted run"},
    {.name = "resume", .type = OPT_FLAG, AT(resume),
     .needs = RULES({.with = "checkpoint"}),
     .help = "continue from the --checkpoint of an earlier run"},
    {.name = "interval", .type = OPT_NUMBER, .unit = UNIT_S, AT(interval), .min = 0, .max = 1e9,
     .arg = "TIME",
     .needs = RULES({.with = "checkpoint"}),
     .help = "first state of a case in --checkpoint after this time, then after 2, 4 ... times it "
             "(60)"},
    {.name = "dry-run", .type = OPT_FLAG, AT(dry_run), .text = true,
     .help = "print what would be computed, with reasons and cost, and stop"},
    {.name = NULL},
};
/* clang-format on */

/* ---- points ---- */

static const char *
name_of(const struct drive *d, const struct drive_axis *axis)
{
    for (size_t k = 0; k < d->t.option.n; k++)
        if (tool_value(&d->t, &d->t.option.row[k]) == (const void *)axis->list)
            return d->t.option.row[k].name;
    return rc_axis_info(axis->axis)->name;
}

void
drive_make_points(struct drive *d, const struct drive_axis *axes)
{
    const struct drive_axis *longest = axes;

    for (const struct drive_axis *a = axes; a->list != NULL; a++)
        if (a->list->n > longest->list->n)
            longest = a;
    d->points = longest->list->n;
    d->point = tool_room(&d->t, d->points, sizeof *d->point, "the points");
    for (const struct drive_axis *a = axes; a->list != NULL; a++) {
        if (a->list->n > 1 && a->list->n < d->points)
            tool_usage(
                &d->t,
                "--%s has %zu values and --%s %zu: give lists of equal length, or one number",
                name_of(d, a), a->list->n, name_of(d, longest), d->points);
        for (size_t k = 0; k < d->points && a->list->n > 0; k++)
            rc_point_set(&d->point[k], a->axis, a->list->v[a->list->n > 1 ? k : 0]);
    }
}

void
drive_open(struct drive *d, const struct drive_axis *axes)
{
    d->axes = axes;
    if (axes != NULL)
        drive_make_points(d, axes);
    d->course.t = &d->t;
    report_open(&d->report, &d->t, d->args->report);
    if (!d->args->dry_run)
        d->checkpoint =
            checkpoint_open(&d->t, d->args->checkpoint, d->args->resume, d->args->interval);
    tool_catch_signals();
}

struct rc_grid *
drive_next(struct drive *d)
{
    return tool_interrupted() != 0 ? NULL : tool_channel(&d->t, "height", false);
}

int
drive_close(struct drive *d)
{
    checkpoint_close(d->checkpoint);
    course_warn_at_end(&d->course);
    report_close(&d->report);
    free(d->point);
    return tool_finish(&d->t);
}

/* ---- what a state of a checkpoint must agree in ---- */

void
course_mark(struct course *c, enum mark_kind kind, const char *name, const char *value)
{
    struct mark *m = c->mark;

    while (m < c->mark + c->marks && (m->kind != kind || strcmp(m->name, name) != 0))
        m++;
    if (m == c->mark + COURSE_MARKS)
        tool_die(c->t, "more than %d marks of --checkpoint", COURSE_MARKS);
    if (m == c->mark + c->marks)
        c->marks++;
    m->kind = kind;
    m->name = name;
    if (strlen(value) < sizeof m->value)
        strcpy(m->value, value);
    else
        snprintf(m->value, sizeof m->value, "CRC-32 %08" PRIx32,
                 rc_crc32_add(0, value, strlen(value)));
}

void
course_mark_crc(struct course *c, enum mark_kind kind, const char *name, uint32_t crc)
{
    char text[16];

    snprintf(text, sizeof text, "%08" PRIx32, crc);
    course_mark(c, kind, name, text);
}

void
course_mark_map(struct course *c, const char *name, const struct rc_grid *map)
{
    const size_t bytes = map == NULL ? 0 : rc_grid_nodes(map) * sizeof *map->v;

    if (map == NULL)
        course_mark(c, MARK_FRAME, name, "");
    else
        course_mark_crc(c, MARK_FRAME, name,
                        ranks_crc(c->t, rc_crc32_add(0, map->v, bytes), bytes));
}

void
course_mark_key(struct course *c, const struct rc_grid *map, const char *key, const char *name)
{
    const char *value = rc_grid_get(map, key);

    course_mark(c, MARK_KEY, name, value != NULL ? value : "");
}

static bool
is_among(const char *name, const char *const *list)
{
    while (list != NULL && *list != NULL && strcmp(*list, name) != 0)
        list++;
    return list != NULL && *list != NULL;
}

/* True if the option gives an axis, whose values are marks of the points. */
static bool
is_axis(const struct drive *d, const char *option)
{
    const struct drive_axis *a = d->axes;

    while (a != NULL && a->list != NULL && strcmp(name_of(d, a), option) != 0)
        a++;
    return a != NULL && a->list != NULL;
}

/* Each option that changes results, the maps, and the keys. Options come first, so that the message about
 * another problem names the option, not the map that it changes. */
static void
mark_case(struct drive *d)
{
    struct course *c = &d->course;

    c->marks = 0;
    if (d->checkpoint == NULL)
        return;
    for (size_t k = 0; k < d->t.option.n; k++) {
        const struct opt *o = &d->t.option.row[k];
        if (o->result && !o->points && !is_axis(d, o->name) && !is_among(o->name, d->changeable))
            course_mark(
                c, d->bound != NULL && strcmp(o->name, d->bound) == 0 ? MARK_BOUND : MARK_OPTION,
                o->name, tool_result_value(&d->t, k));
    }
    for (const char *const *key = d->reads; key != NULL && *key != NULL; key++)
        course_mark_key(c, c->g, *key, *key);
    for (const struct tool_frame *f = d->beside; f != NULL && f->channel != NULL; f++)
        course_mark_map(c, f->channel, *f->frame);
    course_mark_map(c, c->g->channel, c->g);
    if (d->calls.mark != NULL)
        d->calls.mark(d);
}

struct drive_shown
drive_show_axis(const struct drive *d, enum rc_axis axis, double *value)
{
    const struct rc_axis_info *info = rc_axis_info(axis);
    double v;

    if (d->shown.name == NULL || d->shown.axis != axis)
        return (struct drive_shown){axis, info->name, info->unit, 1};
    v = *value / d->shown.one;
    *value = round(v) * d->shown.one == *value ? round(v) : v; /* 1000 cycles and not 999.9... */
    return d->shown;
}

/* The axes of the point, and all points before it. */
static void
mark_point(struct drive *d)
{
    const struct rc_point *p = &d->point[d->at];
    uint32_t crc = 0;

    if (d->checkpoint == NULL)
        return;
    for (enum rc_axis k = 0; k < RC_AXES; k++) {
        double value = p->at[k];
        const struct drive_shown as = drive_show_axis(d, k, &value);
        course_mark(&d->course, MARK_POINT, as.name, (p->given >> k & 1) ? rc_number(value) : "");
    }
    for (size_t k = 0; k < d->at && !d->independent; k++) {
        crc = rc_crc32_add(crc, &d->point[k].given, sizeof d->point[k].given);
        crc = rc_crc32_add(crc, d->point[k].at, sizeof d->point[k].at);
    }
    course_mark_crc(&d->course, MARK_EARLIER, "points", crc);
}

/* ---- frames ---- */

static const struct rc_frame_kind *
kind_of(const struct rc_model *m, const char *name)
{
    const struct rc_frame_kind *kind;

    for (size_t k = 0; (kind = rc_model_frame_kind(m, k)) != NULL; k++)
        if (strcmp(kind->name, name) == 0)
            break;
    return kind;
}

static void
set_keys(struct drive *d, struct rc_model *m, struct rc_grid *g, const struct rc_point *at)
{
    if (d->calls.all_keys != NULL) {
        d->calls.all_keys(d, m, g);
        return;
    }
    tool_set(&d->t, g, "converged", d->status == RC_OK ? "yes" : "no");
    tool_sign(&d->t, g);
    if (d->points > 1)
        tool_set_number(&d->t, g, "case", (double)d->course.number);
    for (enum rc_axis k = 0; k < RC_AXES; k++) {
        const unsigned given = d->point[d->at].given;
        double value = at->at[k];
        if ((given >> k & 1 || given >> rc_axis_info(k)->partner & 1) && isfinite(value)) {
            const struct drive_shown as = drive_show_axis(d, k, &value);
            tool_set_number(&d->t, g, as.name, value);
        }
    }
    if (d->calls.keys != NULL)
        d->calls.keys(d, m, g);
}

/* The values of a frame: those of the tool, or of the model, found in the buffer. NULL: there are none. */
static const double *
values_of(struct drive *d, struct rc_model *m, struct rc_grid *as, const char *word, double *buffer)
{
    const double *own = d->calls.frame != NULL ? d->calls.frame(d, m, as, word) : NULL;

    if (own != NULL)
        return own;
    if (kind_of(m, word) == NULL)
        return strcmp(word, "height") == 0 ? d->course.g->v : NULL;
    tool_must(&d->t, d->course.g, rc_model_frame(m, word, buffer, &d->t.err));
    return buffer;
}

static void
put_frames(struct drive *d, struct rc_model *m, const struct rc_point *at)
{
    const struct rc_grid *g = d->course.g;
    RC_OWN(rc_grid, as) = tool_frame_like(&d->t, g, NULL, g->channel, g->unit);

    set_keys(d, m, as, at);
    for (size_t k = 0; d->list[k] != NULL; k++) {
        const char *word = d->list[k];
        const struct rc_frame_kind *kind = kind_of(m, word);
        struct rc_grid frame;
        const double *v =
            *d->output >> k & 1 ? values_of(d, m, as, word, d->is.spare ? g->v : as->v) : NULL;
        if (v == NULL)
            continue;
        frame = *as;                  /* as the reader of the stream sees it */
        frame.channel = (char *)word; /* this, the unit and the values are only read */
        frame.unit = kind != NULL      ? (char *)kind->unit
                     : d->unit != NULL ? (char *)d->unit
                                       : as->unit;
        frame.v = (double *)v;
        frame.type = kind == NULL                         ? g->type
                     : strcmp(word, CONTACT_CHANNEL) == 0 ? RC_F32 /* 0 and 1 */
                                                          : RC_F64;
        tool_write(&d->t, &frame);
    }
}

/* ---- report ---- */

/* The boundary that the tool or the map says. */
static const char *
boundary_of(const struct drive *d, const struct rc_grid *g)
{
    return d->boundary != NULL ? d->boundary : rc_grid_get(g, "boundary");
}

static void
put_row(struct drive *d, const struct rc_model *m, const struct rc_point *at)
{
    struct report *r = &d->report;

    if (!report_wanted(r))
        return;
    report_begin(r);
    if (d->calls.row != NULL) {
        d->calls.row(d, m);
        report_finish_row(r);
        return;
    }
    report_map(r, d->course.g, d->course.number);
    if (d->boundary != NULL)
        report_text(r, "boundary", d->boundary);
    else
        boundary_report(r, d->course.g, map_boundary(d->course.g));
    report_count(r, "threads", d->t.threads, NULL);
    if (d->calls.columns != NULL)
        d->calls.columns(d, m);
    report_model(r, m, at, d->point[d->at].given);
    report_bool(r, "converged", d->status == RC_OK);
    if (d->calls.effects != NULL)
        report_effects(r, d->calls.effects(d));
    report_seconds(r,
                   (const struct report_phase[]){
                       {"setup", d->is.setup}, {"iterate", d->course.iterate}, {NULL, 0}},
                   d->is.looked - d->is.began);
    report_memory(r);
    report_ranks(r, r->tool);
    report_finish_row(r);
}

/* ---- warnings ---- */

static const char *
shown(char text[SHOWN_NUMBER], double value, const char *unit)
{
    if (unit != NULL)
        return shown_in_unit_to(text, value, unit);
    snprintf(text, SHOWN_NUMBER, "%.3g", value);
    return text;
}

void
drive_where(const struct drive *d, const struct rc_grid *g, char *text, size_t size)
{
    const char *source = rc_grid_get(g, "source");
    size_t at = (size_t)snprintf(text, size, "%s, case %zu",
                                 source != NULL              ? source
                                 : d->t.input.source != NULL ? d->t.input.source
                                                             : "standard input",
                                 d->course.number);
    char value[SHOWN_NUMBER];

    for (enum rc_axis k = 0; k < RC_AXES && at < size; k++)
        if (d->is.at.given >> k & 1) {
            double is = d->is.at.at[k];
            const struct drive_shown as = drive_show_axis(d, k, &is);
            if (as.unit == NULL && as.name == d->shown.name)
                snprintf(value, sizeof value, "%.9g", is);
            else
                shown(value, is, as.unit);
            at += (size_t)snprintf(text + at, size - at, ", %s %s", as.name, value);
        }
}

void
drive_judge(struct course *c, const struct rc_model *m, const struct drive_advice *advice,
            const char *where)
{
    const struct rc_figure *f;
    const void *data;

    for (size_t k = 0; (f = rc_model_figure(m, k, &data)) != NULL; k++) {
        const double v = rc_figure_number(f, data);
        const struct drive_advice *a = advice;
        char value[SHOWN_NUMBER];
        while (a != NULL && a->figure != NULL && strcmp(a->figure, f->name) != 0)
            a++;
        if (a != NULL && a->figure == NULL)
            a = NULL;
        if (f->warning != NULL && (f->least ? v < f->limit : v > f->limit) &&
            (a == NULL || a->advice != NULL))
            course_warn(c, f->warning, "%s: %c%s is %s, %s %g: %s%s%s", where,
                        tolower((unsigned char)f->title[0]), f->title + 1, shown(value, v, f->unit),
                        f->least ? "below" : "above", f->limit, f->warning, a != NULL ? ": " : "",
                        a != NULL ? a->advice : "");
    }
}

void
drive_judge_slope(struct course *c, double slope, const char *where)
{
    static const double small = 0.3; /* RMS slope: above it the theory of small slopes fails */

    if (slope > small)
        course_warn(c, "slopes beyond the theory of small slopes",
                    "%s: RMS slope %.2g where the bodies touch is beyond the theory of small "
                    "slopes (%g): expect pressures that are too high",
                    where, slope, small);
}

/* The row of a figure of the model, by its name. */
static const struct rc_figure *
figure_of(const struct rc_model *m, const char *name)
{
    const struct rc_figure *f;
    const void *data;

    for (size_t k = 0; (f = rc_model_figure(m, k, &data)) != NULL; k++)
        if (strcmp(f->name, name) == 0)
            break;
    return f;
}

void
drive_tell(struct drive *d, const struct rc_model *m)
{
    char where[512], text[512] = "", value[SHOWN_NUMBER];
    size_t at = 0;

    drive_where(d, d->course.g, where, sizeof where);
    for (const char *const *name = d->tells; name != NULL && *name != NULL; name++) {
        const struct rc_figure *f = figure_of(m, *name);
        if (f != NULL && at < sizeof text && !isnan(rc_model_number(m, *name)))
            at += (size_t)snprintf(text + at, sizeof text - at, "%c%s %s, ",
                                   tolower((unsigned char)f->title[0]), f->title + 1,
                                   shown(value, rc_model_number(m, *name), f->unit));
    }
    if (at > 0)
        tool_note(&d->t, "%s: %s%.2g s", where, text, tool_now() - d->is.began);
}

static bool
has_option(const struct tool *t, const char *name)
{
    for (size_t k = 0; name != NULL && k < t->option.n; k++)
        if (strcmp(t->option.row[k].name, name) == 0)
            return true;
    return false;
}

/* Warns of a point that stopped short: names the largest part of its error, and the option that lowers it. */
static void
judge_end(struct drive *d, const struct rc_model *m, const char *where)
{
    const struct rc_figure *f, *largest = NULL;
    const void *data;
    double most = 0;

    if (d->status == RC_MORE)
        tool_warn(&d->t, "%s: interrupted: the frames hold the best state so far, not a solution",
                  where);
    if (d->status != RC_SHORT)
        return;
    for (size_t k = 0; (f = rc_model_figure(m, k, &data)) != NULL; k++)
        if (f->role == RC_FIGURE_ERROR && strcmp(f->by, "grid") != 0 &&
            rc_figure_number(f, data) > most) { /* converged does not ask about the grid */
            most = rc_figure_number(f, data);
            largest = f;
        }
    if (largest == NULL)
        course_warn(&d->course, "stopped short", "%s: stopped short of the asked accuracy", where);
    else
        course_warn(&d->course, "stopped short",
                    "%s: stopped short of the asked accuracy: %c%s is %.2g%s%s", where,
                    tolower((unsigned char)largest->title[0]), largest->title + 1, most,
                    has_option(&d->t, largest->by) ? ": change it with --" : "",
                    has_option(&d->t, largest->by) ? largest->by : "");
}

/* ---- a case ---- */

static struct rc_expected
plan_of(struct drive *d, const struct rc_grid *g, const struct rc_model *m)
{
    struct rc_expected expected;

    tool_must(&d->t, g, rc_model_plan(m, &d->point[d->points - 1], &expected, &d->t.err));
    return expected;
}

static void
print_plan(struct drive *d, const struct rc_grid *g, const struct rc_model *m)
{
    const struct rc_expected expected = plan_of(d, g, m);
    struct plan plan;
    char what[128];

    snprintf(what, sizeof what, ", %zu %s of the %s model", d->points,
             d->points == 1 ? "point" : "points", rc_model_name(m));
    plan = plan_begin(&d->t, &d->report, g, d->course.number + 1, boundary_of(d, g), what);
    if (d->calls.effects != NULL)
        plan_effects(&plan, d->calls.effects(d));
    if (d->calls.plan != NULL)
        d->calls.plan(d, &plan);
    course_plan(&plan, g, expected, d->points);
}

void
drive_judge_point(struct drive *d, struct rc_model *m)
{
    char where[512];

    drive_where(d, d->course.g, where, sizeof where);
    drive_judge(&d->course, m, d->advice, where);
    judge_end(d, m, where);
    drive_tell(d, m);
    if (d->status != RC_OK)
        tool_fails_with(&d->t, EXIT_SHORT);
}

void
drive_keep(struct drive *d, struct rc_model *m)
{
    if (d->status != RC_MORE)
        tool_must(&d->t, d->course.g, rc_model_keep(m, &d->t.err));
}

/* Takes the figures of the model at a point; then the point becomes history. */
static void
end_point(struct drive *d, struct rc_model *m)
{
    struct rc_point at;

    tool_must(&d->t, d->course.g, rc_model_look(m, &at, &d->t.err));
    d->is.looked = tool_now();
    d->is.at.at[RC_DISTANCE] = at.at[RC_DISTANCE];
    d->is.silent = false;
    (d->calls.judge != NULL ? d->calls.judge : drive_judge_point)(d, m);
    if (!d->is.silent)
        put_frames(d, m, &at);
    if (d->calls.keep != NULL)
        d->calls.keep(d, m);
    if (!d->is.silent)
        put_row(d, m, &at);
    if (d->calls.keep == NULL)
        drive_keep(d, m);
}

void
drive_points(struct drive *d, const struct rc_grid *g, struct rc_model *m)
{
    struct course *c = &d->course;

    c->g = g;
    mark_case(d);
    d->is.ended = false;
    for (d->at = 0; d->at < d->points && !d->is.ended; d->at++) {
        if (d->at > 0 && tool_interrupted() != 0)
            break; /* the first point is written in any case */
        d->is.began = tool_now();
        c->number++;
        d->is.at = d->point[d->at];
        c->checkpoint = d->checkpoint;
        mark_point(d);
        if (d->calls.begin != NULL)
            d->calls.begin(d, m);
        course_set(c, m, &d->point[d->at]);
        d->is.setup = tool_now() - d->is.began;
        tool_catch_signals(); /* a tool may release them for the first plan */
        d->status = course_run(c, m);
        end_point(d, m);
    }
    if (!d->is.lasts)
        rc_model_free(m);
}

void
drive_case(struct drive *d, const struct rc_grid *g, struct rc_model *m, const struct rc_err *err)
{
    if (m == NULL)
        tool_refuse(&d->t, g, "%s", err->text);
    if (d->points == 1)
        d->course.number = rc_grid_case(g) - 1;
    d->course.g = g;
    if (d->args->dry_run) {
        print_plan(d, g, m);
        rc_model_free(m);
        return;
    }
    tool_demand_memory(&d->t, g, plan_of(d, g, m).memory);
    drive_points(d, g, m);
}
