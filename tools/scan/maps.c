/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The maps of a study of the measurement. Noise is added once more: the measured map has had one dose
 * already, and the second one changes a figure about as much as the first did. Coarser grids are means, as
 * those of --grid. Quarters tell how far the map stands for the surface. The pattern of missing nodes is
 * shifted to other places, where the filled map knows the heights.
 */
#include "scan.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    SHIFTS = 10,  /* of the pattern of missing nodes */
    SMALLEST = 8, /* nodes along a side of a quarter */
};

/* ---- noise ---- */

/* SplitMix64 (Steele, Lea, Flood 2014). */
static uint64_t
draw(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;

    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static double
uniform(uint64_t *state)
{
    return ((double)(draw(state) >> 11) + 0.5) * 0x1p-53;
}

/* White Gaussian noise of standard deviation 1 (Box and Muller 1958). */
static void
white(uint64_t *state, size_t n, double *v)
{
    const double pi = 3.14159265358979323846;

    for (size_t k = 0; k < n; k += 2) {
        const double r = sqrt(-2 * log(uniform(state))), angle = 2 * pi * uniform(state);

        v[k] = r * cos(angle);
        if (k + 1 < n)
            v[k + 1] = r * sin(angle);
    }
}

/* True if neighbouring nodes have a correlation of at least 0.17 in noise with this length. */
static bool
correlated(const struct scan *s, const struct rc_shape *shape)
{
    return s->length >
           0.75 * fmin(shape->dx, shape->nx > 1 && shape->ny > 1 ? shape->dy : shape->dx);
}

/* Noise of s->sigma. White noise after a Gaussian filter of cut-off a has the correlation
 * exp(-pi (r / 0.4697 a)^2 / 2) (ISO 16610-61), which is exp(-(r / length)^2) with a = 2.668 length. */
static void
make_noise(struct scan *s, const struct rc_shape *shape, double *v)
{
    struct tool *t = s->c->tool;
    const size_t n = shape->nx * shape->ny;
    const struct rc_filter filter = {.cutoff = 2.668 * s->length, .threads = t->threads};
    struct rc_statistics is = {.rms = 1};

    white(&s->random, n, v);
    if (correlated(s, shape)) {
        if (rc_filter(shape, &filter, v, &t->err) != RC_OK)
            tool_usage(t, "noise with a correlation length of %g m: %s", s->length, t->err.text);
        rc_measure(shape, v, &is);
    }
    for (size_t k = 0; k < n; k++)
        v[k] *= s->sigma / is.rms;
}

/* Noise above the rms height of every map is a wrong unit. */
static void
demand_small_noise(const struct scan *s)
{
    double most = 0;

    for (size_t k = 0; k < s->frames; k++) {
        const struct rc_shape shape = rc_grid_shape(s->frame[k]);
        struct rc_statistics is;
        if (strcmp(s->frame[k]->channel, "height") != 0)
            continue;
        rc_measure(&shape, s->frame[k]->v, &is);
        most = fmax(most, is.rms);
    }
    if (most > 0 && s->sigma > most)
        tool_die(s->c->tool,
                 "--noise %s: the rms height of the map is %s: noise is smaller; a number without "
                 "a unit is in metres, write 5nm",
                 shown_in_unit(s->sigma, "m"), shown_in_unit(most, "m"));
}

/* The noise of a scan from two scans of the same place: their levelled difference has twice the variance.
 * The length follows from that of the correlation 0.2, 1.2686 times as long. */
static void
measure_noise(struct scan *s)
{
    struct tool *t = s->c->tool;
    const char *name = s->options->again;
    struct rc_grid *b = tool_frame_of_file(t, "repeat", name, "height"), *a = NULL;
    const struct rc_form plane = {.kind = RC_POLYNOMIAL, .degree = 1, .threads = t->threads};
    const struct rc_surface_options options = {.threads = t->threads};
    struct rc_shape shape;
    struct rc_statistics is;
    struct rc_areal areal = {.sal = NAN};
    double *difference;

    for (size_t k = 0; a == NULL && k < s->frames; k++)
        if (strcmp(s->frame[k]->channel, "height") == 0)
            a = s->frame[k];
    if (a->nx != b->nx || a->ny != b->ny || fabs(a->dx / b->dx - 1) > RC_SAME_SPACING ||
        fabs(a->dy / b->dy - 1) > RC_SAME_SPACING)
        tool_die(t,
                 "--repeat %s: it has %zu x %zu nodes, %g m apart, the input %zu x %zu, %g m "
                 "apart: give "
                 "a second scan of the same place",
                 name, b->nx, b->ny, b->dx, a->nx, a->ny, a->dx);
    shape = rc_grid_shape(a);
    difference = tool_room(t, rc_grid_nodes(a), sizeof *difference, "a map");
    for (size_t k = 0; k < rc_grid_nodes(a); k++)
        difference[k] = a->v[k] - b->v[k];
    if (rc_detrend_form(&shape, &plane, difference, NULL, &t->err) != RC_OK ||
        rc_areal(&shape, difference, &options, &areal, &t->err) != RC_OK)
        tool_die(t, "--repeat %s: %s", name, t->err.text);
    rc_measure(&shape, difference, &is);
    s->sigma = is.rms / sqrt(2);
    s->length = areal.sal / 1.2686;
    if (!(s->sigma > 0))
        tool_die(t, "--repeat %s: it equals the input: give a second scan", name);
    if (!correlated(s, &shape))
        s->length = 0;
    rc_measure(&shape, a->v, &is);
    if (s->sigma > 0.5 * is.rms)
        tool_warn(t,
                  "--repeat %s: the scans differ by %.2g %% of the rms height: do they show the "
                  "same place?",
                  name, 100 * sqrt(2) * s->sigma / is.rms);
    free(difference);
    rc_grid_free(b);
}

/* ---- files ---- */

static bool
is_heights(const struct rc_grid *g)
{
    return strcmp(g->channel, "height") == 0;
}

static void
read_frames(struct scan *s)
{
    struct tool *t = s->c->tool;
    FILE *from = cost_file_read(t, s->c->input);
    struct rc_reader *reader = tool_made(t, NULL, rc_reader_new(from, 0, t->memory, &t->err));
    struct rc_grid *g;
    bool heights = false;

    while (rc_reader_next(reader, &g, &t->err) == RC_MORE) {
        results_demand_none(t, g);
        s->frame =
            tool_grown(t, s->frame, s->frames, &s->frame_room, sizeof *s->frame, "a list of maps");
        s->frame[s->frames++] = g;
        if (!is_heights(g))
            continue;
        tool_demand_lengths(t, g);
        for (size_t k = 0; k < rc_grid_nodes(g) && !heights; k++)
            s->missing += isnan(g->v[k]) ? 1 : 0;
        heights = true;
    }
    rc_reader_free(reader);
    fclose(from);
    if (!heights)
        tool_die(
            t, "the input has no heights: give the measured map, and all programs as the command");
}

static struct rc_grid *
copy_of(struct scan *s, const struct rc_grid *g)
{
    struct rc_grid *map = tool_frame_like(s->c->tool, g, NULL, g->channel, g->unit);

    memcpy(map->v, g->v, rc_grid_nodes(g) * sizeof *g->v);
    return map;
}

/* ---- the sources ---- */

double
scan_slope(const struct scan *s, const struct rc_shape *shape, const double *v, unsigned coarse)
{
    struct rc_shape to = *shape;
    struct rc_statistics is;
    double *mean;

    to.nx = (shape->nx + coarse / 2) / coarse;
    to.ny = (shape->ny + coarse / 2) / coarse;
    to.nx = to.nx > 0 ? to.nx : 1;
    to.ny = to.ny > 0 ? to.ny : 1;
    to.dx *= (double)shape->nx / (double)to.nx;
    to.dy *= (double)shape->ny / (double)to.ny;
    mean = tool_room(s->c->tool, to.nx * to.ny, sizeof *mean, "a map");
    rc_resample_means(shape, v, &to, mean);
    rc_measure(&to, mean, &is);
    free(mean);
    return is.rms_slope;
}

static struct rc_grid *
with_noise(struct scan *s, const struct rc_grid *g, size_t k)
{
    struct rc_grid *map = copy_of(s, g);
    const struct rc_shape shape = rc_grid_shape(g);
    double *v;

    (void)k;
    if (!is_heights(g))
        return map;
    v = tool_room(s->c->tool, rc_grid_nodes(g), sizeof *v, "a map");
    make_noise(s, &shape, v);
    for (size_t i = 0; i < 3; i++) /* the mean square */
        s->noise_slope[i] = sqrt((pow(s->noise_slope[i], 2) * (double)s->noises +
                                  pow(scan_slope(s, &shape, v, 1u << i), 2)) /
                                 (double)(s->noises + 1));
    s->noises++;
    for (size_t i = 0; i < rc_grid_nodes(g); i++)
        map->v[i] += v[i];
    free(v);
    return map;
}

/* True if the map equals its image about the middle of this axis: it was reflected to be periodic. */
static bool
is_reflected(const struct rc_grid *g, bool y)
{
    for (size_t j = 0; j < g->ny; j++)
        for (size_t i = 0; i < g->nx; i++) {
            const double a = g->v[j * g->nx + i], b = y ? g->v[(g->ny - 1 - j) * g->nx + i]
                                                        : g->v[j * g->nx + g->nx - 1 - i];

            if (a != b && !(isnan(a) && isnan(b)))
                return false;
        }
    return (y ? g->ny : g->nx) > 1;
}

/* Quarter k of the part that is not an image of itself: of a profile four pieces, else two by two. Only a
 * program that repeats the map gets it reflected, along the axes that it repeats. */
static struct rc_grid *
quarter_of(struct scan *s, const struct rc_grid *g, size_t k)
{
    struct tool *t = s->c->tool;
    const bool *images = s->images;
    const size_t nx = images[0] ? g->nx / 2 : g->nx, ny = images[1] ? g->ny / 2 : g->ny;
    const size_t across = ny == 1 ? 4 : nx == 1 ? 1 : 2, down = 4 / across;
    const struct rc_form plane = {.kind = RC_POLYNOMIAL, .degree = 1, .threads = t->threads};
    struct rc_shape from = rc_grid_shape(g), to = from, whole;
    struct rc_grid *map;
    double *v;

    to.nx = nx / across;
    to.ny = ny / down;
    whole = rc_reflect_shape(&to, s->reflects);
    v = tool_room(t, to.nx * to.ny, sizeof *v, "a map");
    tool_must(t, g, rc_crop(&from, g->v, k % across * to.nx, k / across * to.ny, &to, v, &t->err));
    if (is_heights(g))
        tool_must(t, g, rc_detrend_form(&to, &plane, v, NULL, &t->err));
    map = tool_frame_like(t, g, &whole, g->channel, g->unit);
    rc_reflect(&to, v, s->reflects, map->v);
    for (const char *const *key =
             (const char *const[]){"filled", "outliers", "load", "taper", NULL};
         *key != NULL; key++)
        tool_set(t, map, *key, NULL);
    free(v);
    return map;
}

static void
find_quarters(struct scan *s)
{
    const struct rc_grid *g = s->frame[0];
    size_t nx, ny, across;

    s->images[0] = s->images[1] = true;
    for (size_t k = 0; k < s->frames; k++)
        for (size_t y = 0; y < 2; y++)
            s->images[y] = s->images[y] && is_reflected(s->frame[k], y == 1);
    nx = s->images[0] ? g->nx / 2 : g->nx;
    ny = s->images[1] ? g->ny / 2 : g->ny;
    across = ny == 1 ? 4 : nx == 1 ? 1 : 2;
    if ((nx > 1 && nx / across < SMALLEST) || (ny > 1 && ny * across / 4 < SMALLEST))
        tool_usage(s->c->tool, "--patch: the quarters of %zu x %zu nodes are smaller than %d nodes",
                   nx, ny, SMALLEST);
    s->share = (double)(nx * ny) / 4 / (double)(g->nx * g->ny) * (s->reflects.x && nx > 1 ? 2 : 1) *
               (s->reflects.y && ny > 1 ? 2 : 1);
}

/* The filled map with the pattern of missing nodes elsewhere. */
static struct rc_grid *
with_holes(struct scan *s, const struct rc_grid *g, size_t k)
{
    struct tool *t = s->c->tool;
    struct rc_grid *map = copy_of(s, g);
    const struct rc_shape shape = rc_grid_shape(g);
    size_t right, down, filled;

    (void)k;
    if (!is_heights(g))
        return map;
    tool_must(t, g, rc_inpaint(&shape, map->v, &filled, &t->err));
    do { /* by at least one node */
        right = (size_t)(draw(&s->random) % g->nx);
        down = (size_t)(draw(&s->random) % g->ny);
    } while (right + down == 0);
    for (size_t j = 0; j < g->ny; j++)
        for (size_t i = 0; i < g->nx; i++)
            if (isnan(g->v[j * g->nx + i]))
                map->v[(j + down) % g->ny * g->nx + (i + right) % g->nx] = NAN;
    return map;
}

/* ---- files of the maps ---- */

/* Writes a map of each frame; returns the file. */
static int
write_maps(struct scan *s, struct rc_grid *(*make)(struct scan *, const struct rc_grid *, size_t),
           size_t k)
{
    struct tool *t = s->c->tool;
    const int file = cost_file(t);
    FILE *to = fdopen(dup(file), "wb");
    struct rc_writer *writer;

    if (to == NULL || (writer = rc_writer_new(to, &t->err)) == NULL)
        tool_die(t, "a temporary file cannot be written: %s", strerror(errno));
    for (size_t i = 0; i < s->frames && tool_interrupted() == 0; i++) {
        struct rc_grid *map = make(s, s->frame[i], k);

        if (rc_writer_put(writer, map, &t->err) != RC_OK)
            tool_die(t, "%s", t->err.text);
        rc_grid_free(map);
    }
    if (rc_writer_end(writer, &t->err) != RC_OK || fclose(to) != 0)
        tool_die(t, "%s", t->err.text);
    rc_writer_free(writer);
    return file;
}

/* The input as rc-detrend leaves it; -1: the trial got the reason. */
static int
write_filtered(struct scan *s, const struct scan_variant *v)
{
    struct cost_case *c = s->c;
    struct cost_trial *trial = &c->trial[v->trial];
    char *text = tool_copy(c->tool, v->words);
    const char *word[COST_WORDS] = {"rc-detrend"};
    const int file = cost_file(c->tool);
    enum process_end end;
    size_t n = 1;
    int status;

    for (char *w = strtok(text, " "); w != NULL && n + 2 < COST_WORDS; w = strtok(NULL, " "))
        word[n++] = w;
    word[n++] = "--quiet";
    end = cost_process(c, word, c->input, file, INFINITY, v->name, &status);
    free(text);
    if (end == PROCESS_ENDED)
        return file;
    if (end == PROCESS_FAILED && status == EXIT_USAGE)
        tool_usage(c->tool, "--filter: %s", cost_message(c->said));
    close(file);
    trial->state = end == PROCESS_INTERRUPTED ? COST_STOPPED : COST_LEFT_OUT;
    snprintf(trial->why, sizeof trial->why, "left out: rc-detrend: %.200s",
             end == PROCESS_FAILED        ? cost_message(c->said)
             : end == PROCESS_INTERRUPTED ? "interrupted"
                                          : "its process died");
    return -1;
}

/* Makes the map of a trial, just before its run: the files of large maps fill a disk. */
static void
prepare(struct scan *s, const struct scan_variant *v)
{
    static struct rc_grid *(*const make[SCAN_SOURCES])(struct scan *, const struct rc_grid *,
                                                       size_t) = {
        [SCAN_NOISE] = with_noise, [SCAN_PATCH] = quarter_of, [SCAN_HOLES] = with_holes};
    struct cost_case *c = s->c;
    int file = -1;

    s->random = (s->options->seed * SCAN_SOURCES + v->source) * 0x9e3779b97f4a7c15u +
                v->number * 0xd1b54a32d192ed03u;
    draw(&s->random);
    if (v->source == SCAN_FILTER)
        file = write_filtered(s, v);
    else if (make[v->source] != NULL)
        file = write_maps(s, make[v->source], v->number);
    if (file >= 0)
        c->trial[v->trial].grid = cost_input_add(c, v->trial, file);
    if (tool_interrupted() == 0)
        cost_plan(c, &c->trial[v->trial]);
}

/* ---- the list of maps ---- */

static void
add_variants(struct scan *s, enum scan_source source, const char *name, size_t n)
{
    struct cost_case *c = s->c;

    for (size_t k = 0; k < n; k++) {
        struct scan_variant *v;

        s->variant =
            tool_grown(c->tool, s->variant, s->variants, &s->room, sizeof *v, "a list of maps");
        v = &s->variant[s->variants++];
        *v = (struct scan_variant){.source = source, .number = k};
        if (source == SCAN_GRID)
            snprintf(v->name, sizeof v->name, "%s 1/%d", name, 2 << k);
        else if (source == SCAN_FILTER)
            snprintf(v->name, sizeof v->name, "filter %.50s", name);
        else
            snprintf(v->name, sizeof v->name, "%s %zu", name, k + 1);
        v->words = name;
        v->trial = cost_trial_add(c, source == SCAN_GRID ? 2u << k : 1);
        c->trial[v->trial].name = tool_copy(c->tool, v->name);
    }
}

static void
add_filters(struct scan *s)
{
    for (char *at = tool_copy(s->c->tool, s->options->filter), *end; at != NULL; at = end) {
        if ((end = strchr(at, ';')) != NULL)
            *end++ = '\0';
        at += strspn(at, " ");
        if (*at != '\0')
            add_variants(s, SCAN_FILTER, at, 1);
    }
}

/* ---- the runs ---- */

static void
check_forces(const struct scan *s)
{
    const struct cost_command *command = &s->c->command;
    char name[COST_NAME];

    for (size_t k = 0; k < command->programs; k++) {
        const struct cost_program *p = &command->program[k];

        for (const char *o = json_first(json_member(p->json, "options")); o != NULL;
             o = json_next(o))
            if (json_is(json_member(o, "unit"), "N") &&
                cost_option_given(p, json_copy(json_member(o, "name"), name, sizeof name)) != NULL)
                tool_usage(s->c->tool,
                           "--patch: --%s of %s is a force on the whole map: give --mean-pressure, "
                           "which a "
                           "quarter can have too",
                           name, p->name);
    }
}

static void
close_outputs(struct cost_case *c, const struct cost_trial *t)
{
    for (size_t k = 0; k <= t->runs; k++) {
        const size_t at = k < t->runs ? t->run[k] : t->grid;
        struct cost_run *r = at == SIZE_MAX ? NULL : &c->run[at];

        if (r != NULL && r->output >= 0) {
            close(r->output);
            r->output = -1;
        }
    }
}

static void
run_measured(struct scan *s)
{
    struct cost_case *c = s->c;
    struct cost_trial *t = &c->trial[c->reference];

    if (t->state == COST_OPEN)
        cost_trial_run(c, c->reference, c->limit);
    if (tool_interrupted() != 0)
        tool_die(c->tool, "interrupted before anything was measured");
    t = &c->trial[c->reference];
    if (t->state != COST_DONE)
        tool_die_at(c->tool, c->usage ? NULL : c->first, c->usage ? EXIT_USAGE : EXIT_IMPOSSIBLE,
                    "the map as measured: %s",
                    strncmp(t->why, "left out: ", 10) == 0 ? t->why + 10 : t->why);
    cost_reference_read(c);
    close_outputs(c, t);
}

static void
run_variants(struct scan *s)
{
    struct cost_case *c = s->c;

    c->began = tool_now();
    for (size_t k = 0; k < s->variants && tool_interrupted() == 0; k++) {
        struct cost_trial *t = &c->trial[s->variant[k].trial];
        const double left = c->limit - (tool_now() - c->began),
                     like = c->trial[c->reference].seconds;

        if (t->state == COST_OPEN && like > left) {
            t->state = COST_LEFT_OUT;
            snprintf(t->why, sizeof t->why,
                     "left out: it would take about %.2g s, and %.2g s are left of --limit", like,
                     fmax(left, 0));
        }
        if (t->state == COST_OPEN)
            prepare(s, &s->variant[k]);
        if (t->state == COST_OPEN && tool_interrupted() == 0)
            cost_trial_run(c, s->variant[k].trial, left);
        close_outputs(c, t);
    }
}

/* True if a program of the command has the option and its words give it. */
/* The argument of an option of one of the programs; NULL: none has it. */
static const char *
given(const struct scan *s, const char *name)
{
    const struct cost_command *command = &s->c->command;
    const char *value = NULL;

    for (size_t k = 0; k < command->programs && value == NULL; k++)
        value = cost_option_given(&command->program[k], name);
    return value;
}

/* The axes along which quarters are reflected: those that the contact repeats. */
static struct rc_boundary
reflected_axes(const struct scan *s)
{
    const char *axes = given(s, "periodic");

    if (axes == NULL || given(s, "mirror") != NULL)
        return RC_FREE;
    return *axes == '\0' ? RC_PERIODIC
                         : rc_boundary_of(strchr(axes, 'x') != NULL, strchr(axes, 'y') != NULL);
}

void
scan_study(struct scan *s, bool plans)
{
    struct cost_case *c = s->c;
    const struct scan_options *o = s->options;

    s->ratio = NAN;
    s->reflects = reflected_axes(s);
    if (o->noise.n > 2)
        tool_usage(c->tool, "--noise takes a standard deviation and a length, not %zu numbers",
                   o->noise.n);
    if (o->patch)
        check_forces(s);
    read_frames(s);
    c->reference = cost_trial_add(c, 1);
    c->trial[c->reference].name = "the map as measured";
    c->trial[c->reference].reference = true;
    cost_plan(c, &c->trial[c->reference]);
    if (!plans)
        run_measured(s);
    if (o->again != NULL)
        measure_noise(s);
    else if (o->noise.n > 0) {
        s->sigma = o->noise.v[0];
        s->length = o->noise.n > 1 ? o->noise.v[1] : 0;
        demand_small_noise(s);
    }
    if (o->patch)
        find_quarters(s);
    if (o->holes && s->missing == 0)
        tool_usage(c->tool, "--holes: no node of the map is missing: give the map before it was "
                            "filled, and begin the command with rc-detrend --fill");
    add_variants(s, SCAN_NOISE, "noise", s->sigma > 0 ? o->repeats : 0);
    add_variants(s, SCAN_GRID, "grid", o->resolution ? 2 : 0);
    add_variants(s, SCAN_PATCH, "patch", o->patch ? 4 : 0);
    add_variants(s, SCAN_HOLES, "holes", o->holes ? SHIFTS : 0);
    if (o->filter != NULL)
        add_filters(s);
    if (plans)
        return;
    c->command.program[0].plans = false; /* the other runs take about as long */
    run_variants(s);
    if (o->resolution)
        scan_judge_grid(s);
    scan_find_bars(s);
}
