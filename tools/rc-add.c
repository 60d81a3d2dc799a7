/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rc-add: the sum of two facing surfaces, as one surface pressed against a flat. */
#include "tools/cli/cli.h"
#include "tools/frames/frames.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static struct args {
    bool subtract, align;
    double below;
    const char *report;
} args = {.below = 100};

static struct report report;

/* clang-format off */
static const struct opt opts[] = {
    {.name = "subtract", .type = OPT_FLAG, .at = offsetof(struct args, subtract), .result = true,
     .help = "A - B, without mirroring B: the change between two measurements"},
    {.name = "align", .type = OPT_FLAG, .at = offsetof(struct args, align), .result = true,
     .needs = RULES({.with = "subtract", .because = "it aligns two scans of one surface"}),
     .help = "shift, turn and tilt B so that the part that has not changed is 0"},
    {.name = "align-below", .type = OPT_NUMBER, .at = offsetof(struct args, below), .min = 0, .max = 100,
     .above = true, .result = true, .arg = "PERCENT",
     .needs = RULES({.with = "align", .because = "it chooses the nodes of the fit"}),
     .help = "fit on the lowest PERCENT of the nodes of B only, as on grooves, where more than half is worn"},
    {.name = "report", .type = OPT_REPORT, .at = offsetof(struct args, report), .arg = "FILE",
     .needs = RULES({.with = "align", .because = "it reports the alignment"}),
     .help = "write one JSON object per surface, or a row of FILE.tsv or .csv: shift, volume, errors"},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-add",
    .summary = "Add two surfaces that face each other, or subtract one from the other",
    .operands = "A B",
    .examples = "  rc-synth sphere --radius 2mm --like flat.rcg | rc-add flat.rcg - > both.rcg\n"
                "  rc-add --subtract flat.rcg surface.rcg > change.rcg\n"
                "  rc-add --subtract --align worn.rcg new.rcg > wear.rcg\n",
    .opts = opts,
    .reads = READS_FILES,
    .writes = WRITES_STREAM,
};

enum {
    HISTORY = 4096 /* most bytes of the history of B in the history of the sum */
};

/* ---- the two streams ---- */

/* A second struct tool reads B and reports under the name of the first one; its failure also ends the output
 * of the first. */
struct second {
    struct tool t, first; /* first: before its first frame, to read a file again */
    bool file;
    struct rc_grid *g; /* from the same case as A */
    size_t n;          /* surfaces read so far  */
};

static struct rc_grid *
read_second(struct tool *t, struct second *b)
{
    struct rc_grid *g;

    b->t.output.began = t->output.began;
    g = tool_channel(&b->t, "height", false);
    if (b->t.exit_status != 0)
        tool_fails_with(t, b->t.exit_status);
    return g;
}

/* The surface of B for the next surface of A: a single one for all of A, or one of several. */
static void
next_second(struct tool *t, struct second *b, const struct rc_grid *a)
{
    struct rc_grid *g = read_second(t, b);

    if (g == NULL && b->n > 1)
        tool_refuse(t, a, "%s has only %zu surfaces: B must have one surface, or as many as A",
                    t->operand[1], b->n);
    if (g == NULL && (b->g == NULL || tool_has_values(b->g)))
        return;
    if (g == NULL) { /* a single one for all of A, whose values are read again */
        b->t = b->first;
        g = read_second(t, b);
        b->n--;
    }
    rc_grid_free(b->g);
    b->g = g;
    b->n++;
    if (!b->file) /* it may be needed again */
        tool_load(&b->t, g);
}

static void
demand_end(struct tool *t, struct second *b, size_t first)
{
    struct rc_grid *g = read_second(t, b);

    if (g != NULL)
        tool_die(
            t,
            "%s has more surfaces than the %zu of %s: put the stream with several surfaces first",
            t->operand[1], first, t->operand[0]);
}

/* ---- checks ---- */

static void
demand_heights(struct tool *t, const struct rc_grid *g)
{
    if (strcmp(g->unit, "m") != 0)
        tool_refuse(t, g,
                    "its unit is '%s': heights are in metres; import the file again with --z-unit",
                    g->unit);
    if (tool_has_values(g))
        tool_demand_measured(t, g);
}

/* If one map is finer than the other, suggests averaging its nodes rather than interpolating the coarser
 * one. */
static _Noreturn void
refuse_spacings(struct tool *t, const struct rc_grid *a, const struct rc_grid *b)
{
    bool first = a->dx <= b->dx && a->dy <= b->dy;
    const struct rc_grid *to = first ? b : a;

    tool_refuse(t, a,
                "spacings of %s x %s m, and in %s of %s x %s m: bring them together by rc-pick "
                "--resample %s,%s %s",
                rc_number(a->dx), rc_number(a->dy),
                strcmp(t->operand[1], "-") == 0 ? "standard input" : t->operand[1],
                rc_number(b->dx), rc_number(b->dy), rc_number(to->dx), rc_number(to->dy),
                t->operand[first ? 0 : 1]);
}

/* ---- keys ---- */

/* The sum repeats along an axis if both do and no node was cut along it. */
static void
set_periodic(struct tool *t, struct rc_grid *a, const struct rc_grid *b, struct rc_boundary cut)
{
    const struct rc_boundary other = map_repeats(b);
    const char *along = map_end_period(t, a, rc_boundary_of(cut.x || !other.x, cut.y || !other.y));

    if (along == NULL)
        return;
    tool_warn(t,
              "%s: this surface is periodic, but the result is not%s, because %s: it gets "
              "periodic=%s",
              tool_where(t, a), along,
              rc_repeats(cut) > 0 ? "the maps are cut to their overlap" : "the other one is not",
              rc_grid_get(a, "periodic"));
    tool_set(t, a, "taper", NULL);
}

/* A shape that was added to one of them is in the sum; the same shape in both cancels in the difference. */
static enum rc_status
set_form(struct rc_grid *a, const struct rc_grid *b, struct rc_err *err)
{
    const char *of_a = rc_grid_get(a, "form"), *of_b = rc_grid_get(b, "form");
    RC_OWNED char *both = NULL;
    size_t size;

    if (of_b == NULL)
        return RC_OK;
    if (args.subtract)
        return of_a != NULL && strcmp(of_a, of_b) == 0 ? rc_grid_set(a, "form", NULL, err) : RC_OK;
    if (of_a == NULL)
        return rc_grid_set(a, "form", of_b, err);
    size = strlen(of_a) + strlen(of_b) + sizeof " + ";
    if ((both = malloc(size)) == NULL)
        return rc_err_set(err, "out of memory for %zu bytes of text", size);
    snprintf(both, size, "%s + %s", of_a, of_b);
    return rc_grid_set(a, "form", both, err);
}

/* The origin of a surface: its source, or the name of the file without folders. */
static const char *
name_of(const struct rc_grid *g, const char *operand)
{
    const char *source = rc_grid_get(g, "source"), *slash = strrchr(operand, '/');

    return source != NULL ? source : slash != NULL ? slash + 1 : operand;
}

/* Appends the steps of a history, separated by semicolons: up to `room` bytes, and whole characters. */
static void
append_history(char *to, const char *text, size_t room)
{
    size_t n = strlen(to);

    for (; *text != '\0' && room > 0; room--) {
        if (strncmp(text, " | ", 3) == 0) {
            to[n++] = ';';
            text += 2;
        } else {
            to[n++] = *text++;
        }
    }
    while (*text != '\0' && n > 0 && ((unsigned char)*text & 0xc0) == 0x80) {
        text--;
        n--;
    }
    strcpy(to + n, *text == '\0' ? "" : "...");
}

/* "rc-add 0.1.0 a.x3p b.x3p (b.x3p: rc-import 0.1.0; rc-detrend 0.1.0 --plane)": continues the history of A,
 * with that of B in it. */
static enum rc_status
add_history(struct tool *t, struct rc_grid *a, const struct rc_grid *b, struct rc_err *err)
{
    const char *first = name_of(a, t->operand[0]), *second = name_of(b, t->operand[1]);
    const char *history = rc_grid_get(b, "history");
    size_t size = strlen(tool_history(t)) + strlen(first) + 2 * strlen(second) + HISTORY + 16;
    RC_OWNED char *step = malloc(size);

    if (step == NULL)
        return rc_err_set(err, "out of memory for %zu bytes of history", size);
    snprintf(step, size, "%s %s %s", tool_history(t), first, second);
    if (history != NULL) {
        snprintf(step + strlen(step), size - strlen(step), " (%s: ", second);
        append_history(step, history, HISTORY);
        strcat(step, ")");
    }
    return rc_grid_history(a, step, err);
}

/* ---- the sum ---- */

/* The next row of B. */
static void
next_row(struct second *b, size_t j, double *row)
{
    if (tool_has_values(b->g))
        memcpy(row, b->g->v + j * b->g->nx, b->g->nx * sizeof *row);
    else
        tool_read_rows(&b->t, 1, row);
}

/* Ends the tool if a height in the rest of A or of B is infinite, too. */
static void
demand_rest(struct tool *t, const struct rc_grid *a, struct second *b)
{
    tool_skip_rows(t, tool_rows_left(t));
    tool_demand_measured(t, a);
    if (tool_has_values(b->g))
        return;
    tool_skip_rows(&b->t, tool_rows_left(&b->t));
    tool_demand_measured(&b->t, b->g);
}

/* Writes the sum row by row; `sum` is its frame, of these shapes. */
static void
write_rows(struct tool *t, struct rc_grid *sum, const struct rc_shape *sa, struct second *b)
{
    const struct rc_shape a_row = {sa->nx, 1, sa->dx, sa->dy};
    const struct rc_shape b_row = {b->g->nx, 1, b->g->dx, b->g->dy};
    const size_t top = (b->g->ny - sum->ny) / 2;
    RC_OWNED double *va = tool_room(t, sa->nx, sizeof *va, "a row of a map");
    RC_OWNED double *vb = tool_room(t, b->g->nx, sizeof *vb, "a row of a map");

    tool_write_head(t, sum);
    tool_skip_rows(t, (sa->ny - sum->ny) / 2);
    if (!tool_has_values(b->g))
        tool_skip_rows(&b->t, top);
    for (size_t j = 0; j < sum->ny; j++) {
        tool_read_rows(t, 1, va);
        next_row(b, top + j, vb);
        tool_must(t, sum,
                  (args.subtract ? rc_subtract : rc_add)(&a_row, va, &b_row, vb, va, &t->err));
        t->input.missing |= b->t.input.missing;
        t->input.infinite |= b->t.input.infinite;
        if (j + 1 == sum->ny)
            demand_rest(t, sum, b);
        tool_write_rows(t, sum, 1, va);
    }
}

/* Writes the sum of A and B, which keeps A's keys. */
static void
add(struct tool *t, struct rc_grid *a, struct second *second)
{
    const struct rc_grid *b = second->g;
    struct rc_shape sa = rc_grid_shape(a), sb = rc_grid_shape(b), sum;
    struct rc_boundary cut;

    if (rc_add_shape(&sa, &sb, &sum, &t->err) != RC_OK)
        refuse_spacings(t, a, b);
    cut = rc_boundary_of(sa.nx != sb.nx, sa.ny != sb.ny);
    if (rc_repeats(cut) > 0)
        tool_note(t, "%s: %zu x %zu nodes and %zu x %zu of B: cut to the %zu x %zu that they share",
                  tool_where(t, a), sa.nx, sa.ny, sb.nx, sb.ny, sum.nx, sum.ny);
    set_periodic(t, a, b, cut);
    tool_must(t, a, set_form(a, b, &t->err));
    tool_must(t, a, add_history(t, a, b, &t->err));
    a->nx = sum.nx;
    a->ny = a->elsewhere = sum.ny;
    if (b->type == RC_F64)
        a->type = RC_F64;
    write_rows(t, a, &sa, second);
}

/* ---- alignment ---- */

static const double in_degrees = 57.29577951308232;

/* What is worth a warning: a shift that is not known to this part of a node, and this part of the overlap
 * without heights. */
static const double uncertain = 0.1, many_missing = 0.1;

static void
tell(struct tool *t, const struct rc_grid *a, const struct rc_alignment *is)
{
    const char *where = tool_where(t, a);

    tool_tell(t,
              "%s: B is shifted by %.3f and %.3f nodes and turned by %.4f degrees; the overlap is "
              "%.3g %% of A, and %.2g %% of it is missing; %.3g %% of the measured part has "
              "changed, the rest differs by %s; volume %s mm3 +- %.2g mm3 (95 %%)",
              where, is->shift_x / a->dx, is->shift_y / a->dy, is->rotation * in_degrees,
              100 * is->overlap, 100 * is->missing, 100 * is->changed,
              shown_in_unit(is->residual, "m"), shown_number(is->volume * 1e9, 4, ""),
              is->volume_error * 1e9);
    if (is->missing > many_missing)
        tool_warn(t,
                  "%s: %.0f %% of the overlap is missing in A or B: the volume there is estimated "
                  "from the changes around it; rc-pick --crop leaves out parts without heights",
                  where, 100 * is->missing);
    if (!(is->shift_error < uncertain * fmin(a->dx, a->dy)))
        tool_warn(
            t,
            "%s: the shift is uncertain by %.2g nodes: the unchanged part is smooth, or equal "
            "along a line",
            where, is->shift_error / fmin(a->dx, a->dy));
}

/* Warns of single points and groups of up to 9 that stand alone above the change around them, if filling them
 * from around changes the volume by a tenth of its uncertainty or more. Those below can be worn summits. */
static void
warn_of_spikes(struct tool *t, const struct rc_grid *a, const struct rc_alignment *is)
{
    const double times = 5, least = 0.1; /* as rc-detrend(1) advises; part of the uncertainty */
    const struct rc_shape shape = rc_grid_shape(a);
    const size_t n = rc_grid_nodes(a);
    RC_OWNED double *filled = tool_room(t, n, sizeof *filled, "the change without spikes");
    size_t spikes, holes, points = 0;
    double volume = 0;

    memcpy(filled, a->v, n * sizeof *filled);
    tool_must(t, a, rc_spikes(&shape, times, RC_FREE, t->threads, filled, &spikes, &t->err));
    if (spikes == 0)
        return;
    tool_must(t, a, rc_inpaint(&shape, filled, &holes, &t->err));
    for (size_t k = 0; k < n; k++) {
        const double rise = isnan(a->v[k]) ? 0 : fmax(a->v[k] - filled[k], 0);
        points += rise > 0;
        volume += rise * a->dx * a->dy;
    }
    if (points > 0 && volume >= least * is->volume_error)
        tool_warn(
            t,
            "%s: %zu isolated points above the change around them are %.2g mm3 of the "
            "volume: if they are spikes of the instrument, run rc-detrend --spikes %g on both "
            "scans first",
            tool_where(t, a), points, volume * 1e9, times);
}

static void
report_alignment(const struct rc_grid *a, const struct rc_alignment *is)
{
    struct report *r = &report;

    if (!report_wanted(r))
        return;
    report_begin(r);
    report_map(r, a, rc_grid_case(a));
    report_number(r, "shift_x", is->shift_x, "m");
    report_number(r, "shift_y", is->shift_y, "m");
    report_number(r, "rotation", is->rotation, "rad");
    report_number(r, "shift_error", is->shift_error, "m");
    report_number(r, "rotation_error", is->rotation_error, "rad");
    report_number(r, "tilt_x", is->tilt_x, NULL);
    report_number(r, "tilt_y", is->tilt_y, NULL);
    report_number(r, "offset", is->offset, "m");
    report_number(r, "residual", is->residual, "m");
    report_number(r, "volume", is->volume, "m3");
    report_number(r, "volume_error", is->volume_error, "m3");
    report_number(r, "overlap", is->overlap, NULL);
    report_number(r, "changed", is->changed, NULL);
    report_number(r, "missing", is->missing, NULL);
    report_finish_row(r);
}

/* Writes A - B, with B aligned; the map keeps the nodes of A. */
static void
align(struct tool *t, struct rc_grid *a, struct second *second)
{
    const struct rc_grid *b = second->g;
    const struct rc_shape sa = rc_grid_shape(a), sb = rc_grid_shape(b);
    double *change = tool_room(t, rc_grid_nodes(a), sizeof *change, "the change");
    struct rc_alignment is;
    struct rc_shape both;

    if (rc_add_shape(&sa, &sb, &both, &t->err) != RC_OK)
        refuse_spacings(t, a, b);
    tool_must(t, a,
              rc_align(&sa, a->v, &sb, b->v, args.below / 100, t->threads, change, &is, &t->err));
    free(a->v);
    a->v = change;
    t->input.missing = true;
    set_periodic(t, a, b, rc_boundary_of(true, true));
    tool_must(t, a, set_form(a, b, &t->err));
    tool_set_number(t, a, "align.shift_x", is.shift_x);
    tool_set_number(t, a, "align.shift_y", is.shift_y);
    tool_set_number(t, a, "align.rotation", is.rotation);
    tool_set_number(t, a, "align.residual", is.residual);
    tool_set_number(t, a, "align.volume", is.volume);
    tool_set_number(t, a, "align.volume_error", is.volume_error);
    tool_must(t, a, add_history(t, a, b, &t->err));
    a->type = b->type == RC_F64 ? RC_F64 : a->type;
    tell(t, a, &is);
    warn_of_spikes(t, a, &is);
    report_alignment(a, &is);
    tool_write(t, a);
}

/* ---- the command line ---- */

static void
open_two(struct tool *t, struct second *b)
{
    struct stat st;

    if (t->operands != 2)
        tool_usage(t, "%zu files named: give two, A and B; - is standard input", t->operands);
    if (strcmp(t->operand[0], "-") == 0 && strcmp(t->operand[1], "-") == 0)
        tool_usage(t, "- and -: standard input is one surface, A or B");
    if (!args.align)
        tool_by_rows(t);
    *b = (struct second){.t = *t};
    b->t.operand = t->operand + 1;
    t->operands = b->t.operands = 1;
    b->first = b->t;
    b->file = stat(b->t.operand[0], &st) == 0 && S_ISREG(st.st_mode);
}

int
main(int argc, char **argv)
{
    struct second b;
    struct rc_grid *a;
    struct tool t;
    size_t n = 0;

    tool_start(&t, &info, argc, argv, &args);
    open_two(&t, &b);
    report_open(&report, &t, args.report);
    while ((a = tool_channel(&t, "height", true)) != NULL) {
        next_second(&t, &b, a);
        t.input.missing |= b.t.input.missing;
        t.input.infinite |= b.t.input.infinite;
        demand_heights(&t, a);
        demand_heights(&b.t, b.g);
        (args.align ? align : add)(&t, a, &b);
        rc_grid_free(a);
        n++;
    }
    demand_end(&t, &b, n);
    rc_grid_free(b.g);
    report_close(&report);
    return tool_finish(&t);
}
