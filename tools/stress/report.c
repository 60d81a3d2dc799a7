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
        if ((r->peak[c].by_depth = malloc(depths->n * sizeof(double))) == NULL)
            return rc_err_set(err, "out of memory for a report of %zu depths", depths->n);
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

void
stress_report_depth(struct stress_report *r, size_t k, size_t n, double *const *s)
{
    r->slices += tool_now() - r->depth_began;
    for (int c = 0; c < RC_STRESSES; c++) {
        struct stress_peak *peak = &r->peak[c];
        size_t at;
        if (peak->by_depth == NULL)
            continue;
        at = rc_largest(n, s[c]);
        peak->by_depth[k] = s[c][at];
        if (!(fabs(s[c][at]) <= fabs(peak->value))) {
            peak->value = s[c][at];
            peak->depth = r->depths->v[k];
            place(r, at, peak);
        }
    }
}

void
stress_report_free(struct stress_report *r)
{
    for (int c = 0; c < RC_STRESSES; c++)
        free(r->peak[c].by_depth);
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
    return strcmp(engine_of(o), words_engine(0)) == 0
               ? "on where depth allows"
               : "left out: the engine has its own tolerance";
}

static const struct {
    const char *name;
    const char *(*of)(const struct rc_stress_options *options);
} effects[] = {
    {"friction", friction_effect},
    {"padding", padding_effect},
    {"section", section_effect},
    {"coarse_grids", coarse_effect},
};

enum {
    EFFECTS = sizeof effects / sizeof *effects
};

/* ---- the report ---- */

static void
report_peaks(const struct stress_report *r, struct json *j)
{
    json_object(j, "largest");
    for (int c = 0; c < RC_STRESSES; c++) {
        const struct stress_peak *peak = &r->peak[c];
        if (peak->by_depth == NULL)
            continue;
        json_object(j, rc_component_names[c]);
        json_number(j, "value", peak->value);
        json_number(j, "x", peak->x);
        json_number(j, "y", peak->y);
        json_number(j, "depth", peak->depth);
        json_array(j, "by_depth");
        for (size_t k = 0; k < r->depths->n; k++)
            json_number(j, NULL, peak->by_depth[k]);
        json_end(j, ']');
        json_end(j, '}');
    }
    json_end(j, '}');
}

static void
report_counts(struct json *j, const struct rc_stress_counts *c)
{
    json_object(j, "counts");
    json_count(j, "depths", c->depths);
    json_count(j, "coarse_depths", c->coarse_depths);
    json_count(j, "normal_kernels", c->normal_kernels);
    json_count(j, "shear_kernels", c->shear_kernels);
    json_count(j, "coefficients", c->coefficients);
    json_count(j, "source_transforms", c->source_transforms);
    json_count(j, "kernel_transforms", c->kernel_transforms);
    json_count(j, "field_transforms", c->field_transforms);
    json_count(j, "line_transforms", c->line_transforms);
    json_count(j, "engine_sums", c->engine_sums);
    json_end(j, '}');
}

enum rc_status
stress_report_write(struct stress_report *r, FILE *file, const struct rc_stress *stress)
{
    const struct rc_stress_options *o = r->options;
    const char *converged = rc_grid_get(r->p, "converged");
    const char section[2] = {o->section, '\0'};
    struct json j;

    json_open(&j, file);
    json_count(&j, "case", rc_grid_case(r->p));
    json_text(&j, "source", rc_grid_get(r->p, "source"));
    json_count(&j, "nx", r->p->nx);
    json_count(&j, "ny", r->p->ny);
    json_number(&j, "dx", r->p->dx);
    json_number(&j, "dy", r->p->dy);
    json_text(&j, "boundary", o->boundary == RC_PERIODIC ? "periodic" : "free");
    json_text(&j, "kernel", rc_stress_engine(stress));
    json_count(&j, "threads", o->threads);
    json_number(&j, "nu", o->nu);
    json_number(&j, "mu", o->mu);
    json_text(&j, "section", o->section == 0 ? NULL : section);
    json_number(&j, "at", o->section == 0 ? NAN : o->at);
    json_number(&j, "tol", o->tol);
    json_array(&j, "depths");
    for (size_t k = 0; k < r->depths->n; k++)
        json_number(&j, NULL, r->depths->v[k]);
    json_end(&j, ']');
    report_peaks(r, &j);
    if (converged == NULL)
        json_null(&j, "converged");
    else
        json_bool(&j, "converged", strcmp(converged, "no") != 0);
    json_object(&j, "effects");
    for (int k = 0; k < EFFECTS; k++)
        json_text(&j, effects[k].name, effects[k].of(o));
    for (int c = 0; c < RC_STRESSES; c++)
        json_text(&j, rc_component_names[c], component_effect(o, c));
    json_end(&j, '}');
    report_counts(&j, rc_stress_counted(stress));
    json_object(&j, "seconds");
    json_number(&j, "setup", r->setup);
    json_number(&j, "slices", r->slices);
    json_number(&j, "total", tool_now() - r->began);
    json_end(&j, '}');
    json_count(&j, "peak_memory", tool_peak_memory());
    json_close(&j);
    return ferror(file) ? RC_FAIL : RC_OK;
}

/* ---- the plan ---- */

enum {
    TRIAL = 192 /* nodes a side of the part that is tried */
};

/* Seconds that all depths would take, from one of them on a part of the map. */
static double
expected_seconds(const struct rc_grid *p, const struct rc_stress_options *options,
                 const struct numbers *depths)
{
    struct rc_shape part = {p->nx < TRIAL ? p->nx : TRIAL, p->ny < TRIAL ? p->ny : TRIAL, p->dx,
                            p->dy};
    size_t n = part.nx * part.ny;
    double nodes = (double)p->nx * (double)p->ny, seconds = INFINITY, start;
    double *v = malloc((1 + RC_STRESSES) * n * sizeof *v), *s[RC_STRESSES];
    struct rc_stress_options o = *options;
    struct rc_stress *stress = NULL;
    struct rc_err err;

    o.at = 0;
    for (size_t k = 0; v != NULL && k < n; k++)
        v[k] = 1;
    for (int c = 0; v != NULL && c < RC_STRESSES; c++)
        s[c] = v + (size_t)(c + 1) * n;
    if (v != NULL)
        stress = rc_stress_new(&part, v, &o, &err);
    for (int k = 0; stress != NULL && k < 3; k++) {
        start = tool_now();
        if (rc_stress_slice(stress, depths->v[depths->n / 2], s, &err) != RC_OK)
            break;
        seconds = fmin(seconds, tool_now() - start);
    }
    rc_stress_free(stress);
    free(v);
    return seconds * (double)depths->n * nodes * log2(4 * nodes) /
           ((double)n * log2(4 * (double)n));
}

void
stress_report_plan(FILE *out, const struct rc_grid *p, const struct rc_stress_options *o,
                   const struct numbers *depths)
{
    struct rc_shape shape = rc_grid_shape(p);

    fprintf(out, "case %zu: %zu x %zu nodes, %s boundary\n", rc_grid_case(p), p->nx, p->ny,
            o->boundary == RC_PERIODIC ? "periodic" : "free");
    fprintf(out, "  %-14s%zu, %g to %g m\n", "depths", depths->n, depths->v[0],
            depths->v[depths->n - 1]);
    fprintf(out, "  %-14s%s\n", "kernel", engine_of(o));
    for (int k = 0; k < EFFECTS; k++)
        fprintf(out, "  %-14s%s\n", effects[k].name, effects[k].of(o));
    for (int c = 0; c < RC_STRESSES; c++)
        fprintf(out, "  %-14s%s\n", rc_component_names[c], component_effect(o, c));
    fprintf(out, "  %-14s%zu MiB beside the maps\n", "memory",
            (rc_stress_memory(&shape, o) >> 20) + 1);
    fprintf(out, "  %-14sabout %.2g s\n", "time", expected_seconds(p, o, depths));
}
