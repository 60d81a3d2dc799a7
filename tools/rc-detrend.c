/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tools/cli/cli.h"
#include "tools/frames/frames.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct args {
    struct steps steps;
    bool robust;
} args;

/* The step of an option, applied to each map in the order of the command line. */
struct work {
    enum rc_status (*run)(struct tool *t, struct rc_grid *g, const struct step *step,
                          struct rc_err *err);
    struct rc_form form; /* of remove_form; the value of the step is added to its degree */
    bool high;           /* of filter: short waves are kept                              */
};

/* fraction of filled points above which a warning is given */
static const double filled_much = 0.05;
static const double outliers_much = 0.05; /* the same for outliers and spikes */

/* Removing a form from a periodic surface opens a step between the periods, along the axes along which the
 * form changes. */
static void
end_period(struct tool *t, struct rc_grid *g, struct rc_boundary changes)
{
    const char *along = map_end_period(t, g, changes);

    if (along != NULL)
        tool_warn(t,
                  "%s: a periodic surface is not periodic%s without its form: it gets periodic=%s",
                  tool_where(t, g), along, rc_grid_get(g, "periodic"));
}

/* The axes along which the heights have changed by different amounts: by more than the rounding of a fit. */
static struct rc_boundary
changed_along(struct tool *t, const struct rc_grid *g, const double *before)
{
    const double of_range = 1e-9, of_height = 1e-15;
    struct rc_boundary changes = RC_FREE;
    RC_OWNED double *column = tool_room(t, g->nx, sizeof *column, "a row of a map");
    struct rc_statistics s;
    double rounding;

    rc_measure(rc_shape_of(g), before, &s);
    rounding = of_range * (s.maximum - s.minimum) + of_height * fmax(s.maximum, -s.minimum);
    for (size_t j = 0; j < g->ny; j++) {
        double row = NAN; /* the first change of this row, and those of the columns */
        for (size_t i = 0; i < g->nx; i++) {
            const double here = before[j * g->nx + i] - g->v[j * g->nx + i];
            row = isnan(row) ? here : row;
            column[i] = j == 0 || isnan(column[i]) ? here : column[i];
            changes.x = changes.x || fabs(here - row) > rounding;
            changes.y = changes.y || fabs(here - column[i]) > rounding;
        }
    }
    return changes;
}

/* An added sphere or cylinder is removed with the form of the surface. */
static void
forget_form(struct tool *t, struct rc_grid *g, const struct rc_form *removed)
{
    if (removed->kind != RC_POLYNOMIAL || removed->degree >= 2)
        tool_set(t, g, "form", NULL);
}

static enum rc_status
remove_form(struct tool *t, struct rc_grid *g, const struct step *step, struct rc_err *err)
{
    struct rc_form form = ((const struct work *)step->opt->of)->form;
    const char *where = tool_where(t, g);
    double radius;
    RC_OWNED double *before = NULL;

    form.degree += (size_t)step->value;
    if (rc_repeats(map_repeats(g)) > 0 && !(form.kind == RC_POLYNOMIAL && form.degree == 0)) {
        before = tool_room(t, rc_grid_nodes(g), sizeof *before, "the heights");
        memcpy(before, g->v, rc_grid_nodes(g) * sizeof *before);
    }
    form.robust = args.robust;
    form.threads = t->threads;
    if (rc_detrend_form(rc_shape_of(g), &form, g->v, &radius, err) != RC_OK)
        return RC_FAIL;
    forget_form(t, g, &form);
    if (form.kind != RC_POLYNOMIAL) {
        tool_note(t, "%s: a %s of radius %sm", where, radius > 0 ? "bump" : "hollow",
                  shown_number(fabs(radius), 6, "m"));
        if ((isfinite(radius) ? rc_grid_set_number(g, "form.radius", radius, err)
                              : rc_grid_set(g, "form.radius", NULL, err)) != RC_OK) /* flat */
            return RC_FAIL;
    }
    if (before != NULL)
        end_period(t, g, changed_along(t, g, before));
    return RC_OK;
}

/* Levelling rows keeps a period; removing slopes of rows keeps it along y only. */
static enum rc_status
rows(struct tool *t, struct rc_grid *g, const struct step *step, struct rc_err *err)
{
    const double degree = step->value;

    if (rc_detrend_rows(rc_shape_of(g), (size_t)degree, args.robust, g->v, err) != RC_OK)
        return RC_FAIL;
    if (degree > 0)
        end_period(t, g, rc_boundary_of(true, false));
    return RC_OK;
}

static enum rc_status
filter(struct tool *t, struct rc_grid *g, const struct step *step, struct rc_err *err)
{
    const struct rc_filter what = {.cutoff = step->value,
                                   .high = ((const struct work *)step->opt->of)->high,
                                   .robust = args.robust,
                                   .boundary = map_repeats(g),
                                   .threads = t->threads};

    if (what.high)
        tool_set(t, g, "form", NULL);
    return rc_filter(rc_shape_of(g), &what, g->v, err);
}

/* Adds to a key that counts over all steps, including those of earlier commands. */
static enum rc_status
add_to_key(struct rc_grid *g, const char *key, size_t count, struct rc_err *err)
{
    double before = 0;

    if (rc_grid_get(g, key) != NULL && !rc_grid_number(g, key, &before))
        return rc_err_set(err, "%s=%s is not a number", key, rc_grid_get(g, key));
    return rc_grid_set_number(g, key, before + (double)count, err);
}

static enum rc_status
outliers(struct tool *t, struct rc_grid *g, const struct step *step, struct rc_err *err)
{
    const double times = step->value;
    size_t count, nodes = g->nx * g->ny;
    const char *where = tool_where(t, g);

    if (rc_outliers(rc_shape_of(g), times, map_repeats(g), t->threads, g->v, &count, err) != RC_OK)
        return RC_FAIL;
    t->input.missing = true;
    tool_note(t, "%s: %zu of %zu points are outliers", where, count, nodes);
    if ((double)count > outliers_much * (double)nodes)
        tool_warn(t,
                  "%s: --outliers %g removed %.3g %% of the points (%zu of %zu): if these are "
                  "grooves or steps, raise the threshold",
                  where, times, 100 * (double)count / (double)nodes, count, nodes);
    return add_to_key(g, "outliers", count, err);
}

static enum rc_status
spikes(struct tool *t, struct rc_grid *g, const struct step *step, struct rc_err *err)
{
    const double times = step->value, nodes = (double)rc_grid_nodes(g);
    const char *where = tool_where(t, g);
    size_t count;

    if (rc_spikes(rc_shape_of(g), times, map_repeats(g), t->threads, g->v, &count, err) != RC_OK)
        return RC_FAIL;
    t->input.missing = true;
    if ((double)count > outliers_much * nodes)
        tool_warn(
            t, "%s: --spikes %g removed %.3g %% of the points (%zu of %.0f): raise the threshold",
            where, times, 100 * (double)count / nodes, count, nodes);
    else
        tool_tell(t, "%s: --spikes %g removed %.3g %% of the points (%zu of %.0f)", where, times,
                  100 * (double)count / nodes, count, nodes);
    return add_to_key(g, "spikes", count, err);
}

/* In a large contact the tapered edges at the mean height carry load. */
static enum rc_status
taper(struct tool *t, struct rc_grid *g, const struct step *step, struct rc_err *err)
{
    struct rc_shape shape = rc_grid_shape(g);
    struct rc_statistics was, is;
    size_t columns, rows;
    double inside, widest, width = step->value;

    if (rc_repeats(map_repeats(g)) == 1)
        return rc_err_set(err,
                          "--taper: the map repeats along one axis already (periodic=%s): solve it "
                          "with --periodic=%s, or take --mirror",
                          rc_grid_get(g, "periodic"), rc_grid_get(g, "periodic"));
    rc_measure(&shape, g->v, &was);
    if (rc_taper(&shape, width, g->v, err) != RC_OK)
        return RC_FAIL;
    rc_measure(&shape, g->v, &is);
    rc_taper_frame(&shape, width, &columns, &rows);
    inside =
        (double)(g->nx - 2 * columns) / (double)g->nx * (double)(g->ny - 2 * rows) / (double)g->ny;
    tool_warn(t,
              "%s: the taper covers %.3g %% of the map, and Sq goes from %s to %s: near the edges "
              "the surface is smoother, and under a large load it carries more than the rest: "
              "--mirror makes a periodic map without a taper",
              tool_where(t, g), 100 * (1 - inside), shown_in_unit(was.rms, "m"),
              shown_in_unit(is.rms, "m"));
    if (rc_grid_number(g, "taper", &widest) && widest > width)
        width = widest;
    if (rc_grid_set_number(g, "taper", width, err) != RC_OK)
        return RC_FAIL;
    return rc_grid_set(g, "periodic", "yes", err);
}

/* Multiplies a count of points, because they are repeated. */
static enum rc_status
multiply_key(struct rc_grid *g, const char *key, double times, struct rc_err *err)
{
    double count;

    return rc_grid_number(g, key, &count) ? rc_grid_set_number(g, key, times * count, err) : RC_OK;
}

static enum rc_status
mirror(struct tool *t, struct rc_grid *g, const struct step *step, struct rc_err *err)
{
    static const struct rc_boundary asked[] = {{.x = true}, {.y = true}, {.x = true, .y = true}};
    const struct rc_boundary was = map_repeats(g);
    const struct rc_boundary wanted = asked[step->value < 0 ? 2 : (size_t)step->value];
    const struct rc_boundary along = rc_boundary_of(wanted.x && !was.x, wanted.y && !was.y);
    struct rc_shape from = rc_grid_shape(g), to = rc_reflect_shape(&from, along);
    double times = (double)(to.nx / from.nx) * (double)(to.ny / from.ny);
    double *v;

    if (rc_grid_get(g, "section") != NULL || strcmp(rc_grid_dunit(g), "m") != 0)
        return rc_err_set(err, "--mirror: the frame is not a map of places: leave it out, with "
                               "rc-pick --channel");
    if (rc_repeats(along) == 0)
        return rc_err_set(
            err, "--mirror has no effect, because the map is already periodic%s: leave it out",
            rc_repeats(was) == 2 ? ""
            : was.x              ? " along x"
                                 : " along y");
    if (from.nx * from.ny == 1)
        return rc_err_set(err, "--mirror: a single node is not a map");
    if (rc_shape_check(&to, err) != RC_OK)
        return RC_FAIL;
    if ((v = malloc(to.nx * to.ny * sizeof *v)) == NULL)
        return rc_err_set(err, "out of memory for %zu x %zu nodes", to.nx, to.ny);
    rc_reflect(&from, g->v, along, v);
    free(g->v);
    g->v = v;
    g->nx = to.nx;
    g->ny = to.ny;
    if (multiply_key(g, "filled", times, err) != RC_OK ||
        multiply_key(g, "outliers", times, err) != RC_OK ||
        multiply_key(g, "spikes", times, err) != RC_OK)
        return RC_FAIL;
    map_set_repeats(t, g, rc_boundary_of(was.x || wanted.x, was.y || wanted.y));
    return RC_OK;
}

static size_t
count_missing(const struct rc_grid *g)
{
    size_t n = 0;

    for (size_t k = 0; k < g->nx * g->ny; k++)
        n += isnan(g->v[k]) ? 1 : 0;
    return n;
}

/* Warns when a large part of the surface is interpolated. */
static enum rc_status
warn_of_holes(struct tool *t, const struct rc_grid *g, size_t missing, struct rc_err *err)
{
    size_t nodes = g->nx * g->ny;
    double width;

    if ((double)missing <= filled_much * (double)nodes || missing == nodes || t->quiet)
        return RC_OK;
    if (rc_hole_width(rc_shape_of(g), g->v, &width, err) != RC_OK)
        return RC_FAIL;
    tool_warn(t,
              "%s: %.3g %% of the points were missing (%zu of %zu) and are filled from their "
              "neighbours; the widest hole is %sm wide, and heights inside it are uncertain",
              tool_where(t, g), 100 * (double)missing / (double)nodes, missing, nodes,
              shown_number(width, 3, "m"));
    return RC_OK;
}

static enum rc_status
fill(struct tool *t, struct rc_grid *g, const struct step *step, struct rc_err *err)
{
    size_t filled, nodes = g->nx * g->ny, missing = count_missing(g);

    (void)step;
    if (warn_of_holes(t, g, missing, err) != RC_OK)
        return RC_FAIL;
    if (rc_inpaint(rc_shape_of(g), g->v, &filled, err) != RC_OK)
        return RC_FAIL;
    tool_note(t, "%s: %zu of %zu points filled", tool_where(t, g), filled, nodes);
    return add_to_key(g, "filled", filled, err);
}

/* Ends the tool for a failed step: a length beyond the map may lack its unit. */
static _Noreturn void
failed(struct tool *t, const struct rc_grid *g, const struct step *step, const struct rc_err *err)
{
    double side = fmax((double)g->nx * g->dx, (double)g->ny * g->dy);

    if (step->opt->unit == UNIT_M && step->value > side &&
        step->text[strspn(step->text, "+.0123456789")] == '\0')
        tool_refuse(t, g, "%s: a number without a unit is in metres, write %sum for micrometres",
                    err->text, step->text);
    tool_refuse(t, g, "%s", err->text);
}

/* Ends the tool if mirror images would give the frames of a case different sizes. */
static void
demand_one_period(struct tool *t, const struct rc_grid *g)
{
    static struct rc_boundary first;
    static size_t number; /* number of the current case; 0: none yet */
    const struct rc_boundary own = map_repeats(g);

    if (rc_grid_case(g) != number) {
        number = rc_grid_case(g);
        first = own;
    }
    for (size_t k = 0; k < args.steps.n && !rc_same_boundary(own, first); k++)
        if (((const struct work *)args.steps.step[k].opt->of)->run == mirror)
            tool_refuse(t, g,
                        "--mirror: this frame has periodic=%s, and the one before it in the case "
                        "periodic=%s: set the key of both with rc-pick --set periodic=%s",
                        rc_repeats_word(own), rc_repeats_word(first),
                        rc_repeats_word(strcmp(g->channel, "height") == 0 ? own : first));
}

static void
detrend(struct tool *t, struct rc_grid *g)
{
    demand_one_period(t, g);
    for (size_t k = 0; k < args.steps.n; k++) {
        const struct step *step = &args.steps.step[k];
        const struct work *work = step->opt->of;
        if (work->run(t, g, step, &t->err) != RC_OK)
            failed(t, g, step, &t->err);
    }
    tool_sign(t, g);
}

/* ---- row by row ---- */

struct rows_of {
    struct tool *t;
    struct rc_grid *g;
    bool begun;
};

static enum rc_status
again(void *ctx, struct rc_err *err)
{
    (void)err;
    tool_read_again(((struct rows_of *)ctx)->t);
    return RC_OK;
}

static enum rc_status
read_rows(void *ctx, size_t n, double *v, struct rc_err *err)
{
    (void)err;
    tool_read_rows(((struct rows_of *)ctx)->t, n, v);
    return RC_OK;
}

static enum rc_status
write_rows(void *ctx, size_t n, const double *v, struct rc_err *err)
{
    struct rows_of *of = ctx;

    (void)err;
    if (!of->begun) {
        tool_sign(of->t, of->g);
        tool_write_head(of->t, of->g);
    }
    of->begun = true;
    tool_write_rows(of->t, of->g, n, v);
    return RC_OK;
}

/* True if the only step is a polynomial that needs neither medians nor the heights before it. */
static bool
works_by_rows(const struct tool *t, const struct rc_grid *g)
{
    const struct work *work = args.steps.step[0].opt->of;

    return args.steps.n == 1 && work->run == remove_form && work->form.kind == RC_POLYNOMIAL &&
           !args.robust && rc_repeats(map_repeats(g)) == 0 && tool_reads_file(t);
}

/* The frame is read several times, and is never in memory as a whole. */
static void
detrend_rows(struct tool *t, struct rc_grid *g)
{
    const struct step *step = &args.steps.step[0];
    struct rows_of of = {t, g, false};
    const struct rc_row_source source = {&of, again, read_rows, write_rows};
    struct rc_form form = ((const struct work *)step->opt->of)->form;

    form.degree += (size_t)step->value;
    form.threads = t->threads;
    forget_form(t, g, &form);
    if (rc_detrend_source(rc_shape_of(g), &form, &source, &t->err) != RC_OK) {
        tool_demand_measured(t, g);
        failed(t, g, step, &t->err);
    }
}

/* ---- frame by frame ---- */

static void
one(struct tool *t, struct rc_grid *g)
{
    if (works_by_rows(t, g)) {
        demand_one_period(t, g);
        detrend_rows(t, g);
        return;
    }
    tool_load(t, g);
    tool_demand_measured(t, g);
    detrend(t, g);
    tool_write(t, g);
}

/* Mirrors the other frames of the case, such as a map of hardness, with the heights. */
static void
passing(struct tool *t, struct rc_grid *g)
{
    char step[64];

    demand_one_period(t, g);
    for (size_t k = 0; k < args.steps.n; k++) {
        const struct work *work = args.steps.step[k].opt->of;
        const char *axes = args.steps.step[k].text;
        if (work->run != mirror)
            continue;
        tool_load(t, g);
        snprintf(step, sizeof step, "%s %s --mirror%s%s", t->info->name, rc_version(),
                 axes == NULL ? "" : " ", axes == NULL ? "" : axes);
        tool_must(t, g, mirror(t, g, &args.steps.step[k], &t->err));
        tool_must(t, g, rc_grid_history(g, step, &t->err));
    }
}

static void
check_steps(struct tool *t)
{
    if (args.steps.n == 0)
        tool_usage(t, "nothing to do: give --plane, --poly N or --fill, or another step of --help");
}

/* ---- options ---- */

#define STEP(word, ...)                                                                            \
    .name = word, .type = OPT_STEP, .at = offsetof(struct args, steps), .result = true,            \
    .of = &(const struct work)                                                                     \
    {                                                                                              \
        __VA_ARGS__                                                                                \
    }
#define ABOVE_0 .max = INFINITY, .above = true
/* clang-format off */
static const struct opt opts[] = {
    {STEP("plane", .run = remove_form, .form.degree = 1),
     .help = "subtract the least-squares plane"},
    {STEP("poly", .run = remove_form), .max = RC_DEGREE_MAX, .arg = "N",
     .help = "subtract the polynomial of degree N (0: the mean)"},
    {STEP("rows", .run = rows), .arg = "offset|tilt|bow",
     .help = "subtract the median, straight line or parabola of each row"},
    {STEP("sphere", .run = remove_form, .form.kind = RC_SPHERE),
     .help = "subtract the best sphere, and print its radius"},
    {STEP("cylinder", .run = remove_form, .form.kind = RC_CYLINDER),
     .help = "subtract the best cylinder, of any direction and tilt"},
    {STEP("lowpass", .run = filter), .unit = UNIT_M, ABOVE_0, .arg = "L",
     .help = "keep waves longer than L (Gaussian filter, 50 % at L)"},
    {STEP("highpass", .run = filter, .high = true), .unit = UNIT_M, ABOVE_0, .arg = "L",
     .help = "keep waves shorter than L: the input minus its low-pass"},
    {STEP("outliers", .run = outliers), .real = true, ABOVE_0, .arg = "T",
     .help = "drop points that differ by T deviations from the median of their neighbours"},
    {STEP("spikes", .run = spikes), .real = true, ABOVE_0, .arg = "T",
     .help = "drop spikes of 1 to 9 nodes that stand alone by T deviations; grooves stay"},
    {STEP("fill", .run = fill), .help = "fill missing points smoothly from the points around them"},
    {STEP("taper", .run = taper), .unit = UNIT_M, ABOVE_0, .arg = "W",
     .help = "blend a frame of width W into the mean height, so that the map repeats"},
    {STEP("mirror", .run = mirror), .optional = true, .arg = "x|y|xy",
     .help = "add the mirror images about two edges, or those along one axis, so that the map "
             "repeats"},
    {.name = "robust", .type = OPT_FLAG, .at = offsetof(struct args, robust), .result = true,
     .needs = RULES({.with = "plane|poly|rows|sphere|cylinder|lowpass|highpass",
                    .because = "it changes forms and filters"}),
     .help = "robust forms and filters, insensitive to outliers"},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-detrend",
    .summary = "Level height maps, remove their form, filter, drop spikes, fill missing points",
    .operands = "[FILE...]",
    .examples =
        "  rc-import bench.x3p | rc-detrend --plane --fill > flat.rcg\n"
        "  rc-import bench.x3p | rc-detrend --robust --plane --spikes 5 --fill > clean.rcg\n",
    .opts = opts,
    .passing = passing,
    .reads = READS_STREAM,
    .writes = WRITES_STREAM,
};

int
main(int argc, char **argv)
{
    struct rc_grid *g;
    struct tool t;

    tool_start(&t, &info, argc, argv, &args);
    check_steps(&t);
    tool_by_rows(&t);
    while ((g = tool_channel(&t, "height", true)) != NULL) {
        one(&t, g);
        rc_grid_free(g);
    }
    return tool_finish(&t);
}
