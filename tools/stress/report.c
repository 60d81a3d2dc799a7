#include "stress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- gathering ---- */

enum rc_status
stress_report_begin(struct stress_report *r, const struct rc_grid *p,
                    const struct rc_stress_options *options, const struct numbers *depths,
                    bool peaks, struct rc_err *err)
{
    *r = (struct stress_report){.p = p, .options = options, .depths = depths, .began = tool_now()};
    for (int c = 0; c < RC_STRESSES; c++) {
        if (!peaks || !(options->wanted >> c & 1))
            continue;
        r->peak[c].value = NAN;
        r->peak[c].by_depth = malloc(depths->n * sizeof(double));
        r->peak[c].by_material = malloc((options->body.layers + 1) * sizeof(double));
        if (r->peak[c].by_depth == NULL || r->peak[c].by_material == NULL)
            return rc_err_set(err, "out of memory for a report of %zu depths", depths->n);
        for (size_t m = 0; m <= options->body.layers; m++)
            r->peak[c].by_material[m] = NAN;
    }
    return RC_OK;
}

void
stress_report_ready(struct stress_report *r)
{
    r->setup = tool_now() - r->began;
}

void
stress_report_start(struct stress_report *r)
{
    r->depth_began = tool_now();
}

/* Where value k of a slice or of a line is. */
static void
place(const struct stress_report *r, size_t k, struct stress_peak *peak)
{
    const struct rc_grid *p = r->p;
    char section = r->options->section;
    size_t i = section == 'x' ? 0 : section == 'y' ? k : k % p->nx;
    size_t j = section == 'x' ? k : section == 'y' ? 0 : k / p->nx;

    peak->x = section == 'x' ? r->options->at : ((double)i - (double)(p->nx - 1) / 2) * p->dx;
    peak->y = section == 'y' ? r->options->at : ((double)j - (double)(p->ny - 1) / 2) * p->dy;
}

/* The value of largest size of all n, or of those that several processes hold, and where it is. */
static struct stress_peak
peak_of(const struct stress_report *r, const struct tool *t, size_t n, const double *s)
{
    struct stress_peak peak = {.value = 0};
    size_t at = n > 0 ? rc_largest(n, s) : 0;

    if (n > 0) {
        peak.value = s[at];
        place(r, tool_first_row(t, r->p) * r->p->nx + at, &peak);
    }
    if (t->ranks != NULL)
        ranks_share(t, ranks_where_most(t, n > 0 ? fabs(peak.value) : -1), &peak, sizeof peak);
    return peak;
}

void
stress_report_depth(struct stress_report *r, const struct tool *t, size_t k, size_t n,
                    double *const *s)
{
    size_t material = rc_body_material(&r->options->body, r->depths->v[k]);

    r->slices += tool_now() - r->depth_began;
    for (int c = 0; c < RC_STRESSES; c++) {
        struct stress_peak *peak = &r->peak[c], here;
        if (peak->by_depth == NULL)
            continue;
        here = peak_of(r, t, n, s[c]);
        peak->by_depth[k] = here.value;
        if (!(fabs(here.value) <= fabs(peak->by_material[material])))
            peak->by_material[material] = here.value;
        if (!(fabs(here.value) <= fabs(peak->value))) {
            peak->value = here.value;
            peak->depth = r->depths->v[k];
            peak->x = here.x;
            peak->y = here.y;
        }
    }
}

void
stress_report_free(struct stress_report *r)
{
    for (int c = 0; c < RC_STRESSES; c++) {
        free(r->peak[c].by_depth);
        free(r->peak[c].by_material);
    }
}

/* ---- effects ---- */

/* Effect by effect what is computed, and why the rest is not. */
static const char *
component_effect(const struct rc_stress_options *o, int c)
{
    if (o->wanted >> c & 1)
        return "on";
    if (c < RC_COMPONENTS && o->wanted >> RC_COMPONENTS != 0)
        return "computed for what is derived from it, not written";
    return "left out: not in --components";
}

static const char *
friction_effect(const struct rc_stress_options *o)
{
    return o->mu != 0 ? "on" : "left out: mu = 0";
}

static const char *
coating_effect(const struct rc_stress_options *o)
{
    return o->body.layers > 0 ? "on" : "left out: the stream has no layers, one material";
}

static const char *
padding_effect(const struct rc_stress_options *o)
{
    return o->boundary == RC_FREE ? "on" : "left out: the map is periodic";
}

static const char *
section_effect(const struct rc_stress_options *o)
{
    return o->section != 0 ? "on" : "left out: no --section";
}

/* "auto" takes the first engine of the table; it alone has coarser grids for deep slices. */
static const char *
engine_of(const struct rc_stress_options *o)
{
    return strcmp(o->engine, "auto") == 0 ? words_engine(0) : o->engine;
}

static const char *
coarse_effect(const struct rc_stress_options *o)
{
    if (o->tol == 0)
        return "left out: no --tol";
    if (o->section != 0)
        return "left out: a section is a line already";
    if (o->boundary == RC_PERIODIC)
        return "left out: the map is periodic";
    if (o->body.layers > 0)
        return "left out: the body is coated";
    if (o->ranks != NULL)
        return "left out: several processes share the map";
    return strcmp(engine_of(o), words_engine(0)) == 0
               ? "on where depth allows"
               : "left out: the engine has its own tolerance";
}

static const struct {
    const char *name;
    const char *(*of)(const struct rc_stress_options *options);
} effects[] = {
    {"friction", friction_effect}, {"coating", coating_effect},     {"padding", padding_effect},
    {"section", section_effect},   {"coarse_grids", coarse_effect},
};

enum {
    EFFECTS = sizeof effects / sizeof *effects
};

/* ---- the report ---- */

static void
write_peaks(const struct stress_report *r, struct report *out)
{
    report_object(out, "largest");
    for (int c = 0; c < RC_STRESSES; c++) {
        const struct stress_peak *peak = &r->peak[c];
        if (peak->by_depth == NULL)
            continue;
        report_object(out, rc_component_names[c]);
        report_number(out, "value", peak->value, "Pa");
        report_number(out, "x", peak->x, "m");
        report_number(out, "y", peak->y, "m");
        report_number(out, "depth", peak->depth, "m");
        report_array(out, "by_depth");
        for (size_t k = 0; k < r->depths->n; k++)
            report_number(out, NULL, peak->by_depth[k], "Pa");
        report_end(out);
        report_array(out, "by_material");
        for (size_t m = 0; m <= r->options->body.layers; m++)
            report_number(out, NULL, peak->by_material[m], "Pa");
        report_end(out);
        report_end(out);
    }
    report_end(out);
}

static void
write_counts(struct report *out, const struct rc_stress_counts *c)
{
    report_object(out, "counts");
    report_count(out, "depths", c->depths, NULL);
    report_count(out, "coarse_depths", c->coarse_depths, NULL);
    report_count(out, "normal_kernels", c->normal_kernels, NULL);
    report_count(out, "shear_kernels", c->shear_kernels, NULL);
    report_count(out, "coefficients", c->coefficients, NULL);
    report_count(out, "source_transforms", c->source_transforms, NULL);
    report_count(out, "kernel_transforms", c->kernel_transforms, NULL);
    report_count(out, "field_transforms", c->field_transforms, NULL);
    report_count(out, "line_transforms", c->line_transforms, NULL);
    report_count(out, "engine_sums", c->engine_sums, NULL);
    report_end(out);
}

void
stress_report_write(struct stress_report *r, struct report *out, const struct rc_stress *stress)
{
    const struct rc_stress_options *o = r->options;
    const char *converged = rc_grid_get(r->p, "converged");
    const char section[2] = {o->section, '\0'};

    report_begin(out);
    report_count(out, "case", rc_grid_case(r->p), NULL);
    report_text(out, "source", rc_grid_get(r->p, "source"));
    report_count(out, "nx", r->p->nx, NULL);
    report_count(out, "ny", r->p->ny, NULL);
    report_number(out, "dx", r->p->dx, "m");
    report_number(out, "dy", r->p->dy, "m");
    report_text(out, "boundary", o->boundary == RC_PERIODIC ? "periodic" : "free");
    report_text(out, "kernel", rc_stress_engine(stress));
    report_count(out, "threads", o->threads, NULL);
    report_number(out, "nu", o->body.layers == 0 ? o->body.nu : NAN, NULL);
    report_text(out, "layers", rc_grid_get(r->p, "layers"));
    report_number(out, "mu", o->mu, NULL);
    report_text(out, "section", o->section == 0 ? NULL : section);
    report_number(out, "at", o->section == 0 ? NAN : o->at, "m");
    report_number(out, "tol", o->tol, NULL);
    report_array(out, "depths");
    for (size_t k = 0; k < r->depths->n; k++)
        report_number(out, NULL, r->depths->v[k], "m");
    report_end(out);
    report_array(out, "materials");
    for (size_t k = 0; k < r->depths->n; k++)
        report_count(out, NULL, rc_body_material(&o->body, r->depths->v[k]) + 1, NULL);
    report_end(out);
    write_peaks(r, out);
    if (converged == NULL)
        report_text(out, "converged", NULL);
    else
        report_bool(out, "converged", strcmp(converged, "no") != 0);
    report_object(out, "effects");
    for (int k = 0; k < EFFECTS; k++)
        report_text(out, effects[k].name, effects[k].of(o));
    for (int c = 0; c < RC_STRESSES; c++)
        report_text(out, rc_component_names[c], component_effect(o, c));
    report_end(out);
    write_counts(out, rc_stress_counted(stress));
    report_object(out, "seconds");
    report_number(out, "setup", r->setup, "s");
    report_number(out, "slices", r->slices, "s");
    report_number(out, "total", tool_now() - r->began, "s");
    report_end(out);
    report_count(out, "peak_memory", (size_t)ranks_most(out->tool, (double)tool_peak_memory()),
                 "B");
    report_count(out, "memory_estimate",
                 (size_t)ranks_most(out->tool, (double)out->tool->expected_memory), "B");
    report_ranks(out, out->tool);
    report_finish_row(out);
}

/* ---- the plan ---- */

enum {
    TRIAL = 192 /* nodes a side of the part that is tried */
};

/* Seconds that all depths would take, from one of them on a part of the map. */
static enum rc_status
expect(const struct tool *t, const struct rc_grid *p, const struct rc_stress_options *options,
       const struct numbers *depths, double *expected, struct rc_err *err)
{
    struct rc_shape part = {p->nx < TRIAL ? p->nx : TRIAL, p->ny < TRIAL ? p->ny : TRIAL, p->dx,
                            p->dy};
    size_t n = part.nx * part.ny;
    double nodes = (double)p->nx * (double)p->ny, seconds = INFINITY, start;
    double *v = malloc((1 + RC_STRESSES) * n * sizeof *v), *s[RC_STRESSES];
    struct rc_stress_options o = *options;
    struct rc_stress *stress = NULL;
    enum rc_status status = RC_OK;

    if (v == NULL)
        status = rc_err_set(err, "out of memory for the trial of a plan");
    status = ranks_agree(t, status, err);
    if (status != RC_OK || v == NULL)
        goto done;
    o.at = 0;
    for (size_t k = 0; k < n; k++)
        v[k] = 1;
    for (int c = 0; c < RC_STRESSES; c++)
        s[c] = v + (size_t)(c + 1) * n;
    if ((stress = rc_stress_new(&part, v, &o, err)) == NULL)
        status = RC_FAIL;
    for (int k = 0; status == RC_OK && k < 3; k++) {
        start = tool_now();
        status = rc_stress_slice(stress, depths->v[depths->n / 2], s, err);
        seconds = fmin(seconds, tool_now() - start);
    }
done:
    rc_stress_free(stress);
    free(v);
    *expected =
        seconds * (double)depths->n * nodes * log2(4 * nodes) / ((double)n * log2(4 * (double)n));
    return status;
}

/* The materials of a coated body, and how many of the depths are in each. */
static void
say_materials(FILE *out, const struct rc_stress_options *o, const struct numbers *depths)
{
    const struct rc_body *c = &o->body;
    double top = 0;

    for (size_t m = 0; c->layers > 0 && m <= c->layers; m++) {
        double e = m < c->layers ? c->layer[m].e : c->e;
        double nu = m < c->layers ? c->layer[m].nu : c->nu;
        size_t in = 0;
        for (size_t k = 0; k < depths->n; k++)
            in += rc_body_material(c, depths->v[k]) == m;
        fprintf(out, "  material %-5zufrom %g m, E %g Pa, nu %g: %zu of the depths\n", m + 1, top,
                e, nu, in);
        top += m < c->layers ? c->layer[m].thickness : 0;
    }
}

enum rc_status
stress_report_plan(const struct tool *t, const struct rc_grid *p, const struct rc_stress_options *o,
                   const struct numbers *depths, size_t memory, struct rc_err *err)
{
    FILE *out = t->out;
    double seconds;

    if (expect(t, p, o, depths, &seconds, err) != RC_OK)
        return RC_FAIL;
    fprintf(out, "case %zu: %zu x %zu nodes, %s boundary\n", rc_grid_case(p), p->nx, p->ny,
            o->boundary == RC_PERIODIC ? "periodic" : "free");
    fprintf(out, "  %-14s%zu, %g to %g m\n", "depths", depths->n, depths->v[0],
            depths->v[depths->n - 1]);
    say_materials(out, o, depths);
    fprintf(out, "  %-14s%s\n", "kernel", engine_of(o));
    for (int k = 0; k < EFFECTS; k++)
        fprintf(out, "  %-14s%s\n", effects[k].name, effects[k].of(o));
    for (int c = 0; c < RC_STRESSES; c++)
        fprintf(out, "  %-14s%s\n", rc_component_names[c], component_effect(o, c));
    fprintf(out, "  %-14sabout %zu MiB\n", "memory", (memory >> 20) + 1);
    fprintf(out, "  %-14sabout %.2g s\n", "time", seconds);
    return RC_OK;
}
