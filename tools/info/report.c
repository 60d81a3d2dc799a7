/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Rows of figures. Rows of --report are flat, so that the parameters of many scans form one table. All rows
 * have the columns of the requested options, and figures that a frame lacks are unknown. In --json the
 * figures of each option are an object.
 */
#include "info.h"

#include <math.h>

static void
put_list(struct report *r, const char *name, const double *v, size_t n)
{
    report_numbers(r, name, v, sizeof *v, n);
}

static void
put_counts(struct report *r, const char *name, const size_t *v, size_t n)
{
    report_array(r, name);
    for (size_t k = 0; k < n; k++)
        report_count(r, NULL, v[k], NULL);
    report_end(r);
}

static double
largest(const struct rc_patches *p)
{
    return p == NULL ? NAN : p->count > 0 ? p->patch[0].area : 0;
}

/* ---- a row ---- */

static void
put_profile(struct report *r, const struct info_profile *p)
{
    static char deviation[16][24];
    const struct rc_figure *line = rc_figures("profile");

    report_table(r, line, p == NULL ? NULL : &p->mean);
    for (size_t k = 0; line[k].name != NULL; k++) {
        snprintf(deviation[k], sizeof *deviation, "%s_deviation", line[k].name);
        report_number(r, deviation[k], rc_figure_number(&line[k], p == NULL ? NULL : &p->deviation),
                      line[k].unit);
    }
    report_number(r, "profiles", p == NULL ? NAN : (double)p->lines, NULL);
    report_number(r, "elements", p == NULL ? NAN : (double)p->elements, NULL);
}

bool
info_has_no_row(const struct info_wanted *w, const struct info_figures *f)
{
    bool any = w->areal || w->psd || w->patches || w->line.along != NULL;

    return any && f->areal == NULL && f->psd == NULL && f->patches == NULL && f->profile == NULL;
}

void
info_report(struct report *r, const struct info_wanted *w, const struct info_figures *f,
            const struct rc_statistics *s)
{
    const struct figures from[] = {{rc_figures("statistics"), s}, {NULL, NULL}};
    const struct rc_grid *g = f->grid;

    if (!report_wanted(r) || info_has_no_row(w, f))
        return;
    report_begin(r);
    report_count(r, "case", rc_grid_case(g), NULL);
    report_text(r, "source", rc_grid_get(g, "source"));
    report_text(r, "channel", g->channel);
    report_text(r, "unit", g->unit);
    report_count(r, "nx", g->nx, NULL);
    report_count(r, "ny", g->ny, NULL);
    report_number(r, "dx", g->dx, rc_grid_dunit(g));
    report_number(r, "dy", g->dy, rc_grid_dunit(g));
    report_named(r, from, "minimum maximum mean rms missing");
    if (w->areal) {
        report_table(r, rc_figures("areal"), f->areal);
        report_table(r, rc_figures("features"), f->features);
        for (size_t k = 0; k < w->smr.n; k++)
            report_number(r, w->smr_name[k], f->areal == NULL ? NAN : f->smr[k], NULL);
    }
    if (w->line.along != NULL)
        put_profile(r, f->profile);
    if (w->psd)
        report_table(r, rc_figures("psd"), f->psd);
    if (w->patches) {
        report_table(r, rc_figures("patches"), f->patches);
        report_number(r, "largest_area", largest(f->patches), "m2");
    }
    report_finish_row(r);
}

/* ---- an object for each option ---- */

static void
table_json(struct report *r, const char *name, const struct rc_figure *table, const void *figures)
{
    report_object(r, name);
    report_table(r, table, figures);
    report_end(r);
}

static void
profile_json(struct report *r, const struct info_profile *p, const struct info_wanted *w)
{
    report_object(r, "profile");
    report_text(r, "along", w->line.along);
    report_count(r, "profiles", p->lines, NULL);
    report_count(r, "points", p->points, NULL);
    report_number(r, "length", p->length, "m");
    report_count(r, "sections", p->sections, NULL);
    report_count(r, "elements", p->elements, NULL);
    report_table(r, rc_figures("profile"), &p->mean);
    table_json(r, "deviation", rc_figures("profile"), &p->deviation);
    report_end(r);
}

static void
psd_json(struct report *r, const struct rc_psd *p)
{
    const struct figures from[] = {{rc_figures("psd"), p}, {NULL, NULL}};

    report_object(r, "psd");
    put_list(r, "q", p->q, p->rings);
    put_list(r, "c", p->c, p->rings);
    put_counts(r, "modes", p->modes, p->rings);
    report_text(r, "window", p->window);
    report_number(r, "sum", p->sum, "m2");
    report_named(r, from, "mean_square hurst hurst_error");
    put_list(r, "fit", (const double[]){p->shortest, p->longest}, 2);
    report_end(r);
}

static void
patches_json(struct report *r, const struct info_figures *f)
{
    const struct rc_patches *p = f->patches;
    const struct figures from[] = {{rc_figures("patches"), p}, {NULL, NULL}};

    report_object(r, "patches");
    report_count(r, "count", p->count, NULL);
    report_named(r, from, "contact_nodes contact_area contact_area_corrected perimeter");
    report_number(r, "largest_area", largest(p), "m2");
    for (int k = 0; k < 2; k++)
        report_numbers(r, k == 0 ? "areas" : "perimeters",
                       p->count == 0 ? NULL
                       : k == 0      ? &p->patch->area
                                     : &p->patch->perimeter,
                       sizeof *p->patch, p->count);
    report_object(r, "pressure_histogram");
    put_list(r, "edges", f->edges, f->edges == NULL ? 0 : INFO_BINS + 1);
    put_counts(r, "counts", f->counts, f->counts == NULL ? 0 : INFO_BINS);
    report_end(r);
    report_end(r);
}

void
info_json(struct report *r, const struct info_wanted *w, const struct info_figures *f)
{
    if (f->areal != NULL)
        table_json(r, "areal", rc_figures("areal"), f->areal);
    if (f->features != NULL)
        table_json(r, "features", rc_figures("features"), f->features);
    if (f->areal != NULL && w->smr.n > 0) {
        report_object(r, "smr");
        put_list(r, "height", w->smr.v, w->smr.n);
        put_list(r, "ratio", f->smr, w->smr.n);
        report_end(r);
    }
    if (f->profile != NULL)
        profile_json(r, f->profile, w);
    if (f->psd != NULL)
        psd_json(r, f->psd);
    if (f->patches != NULL)
        patches_json(r, f);
}
