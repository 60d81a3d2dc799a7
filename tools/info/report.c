/*
 * What --report writes: a row a frame, flat, so that the parameters of many scans are one table.
 * What a frame does not have is unknown: all rows have the columns of what was asked for.
 */
#include "info.h"

#include <math.h>

static void
put_parameters(struct report *r, const void *figures, const struct info_parameter *p)
{
    for (; p->key != NULL; p++)
        report_number(r, p->key, figures == NULL ? NAN : info_value(figures, p),
                      info_unit(p->kind));
}

static void
put_smr(struct report *r, const struct info_wanted *w, const struct info_figures *f)
{
    for (size_t k = 0; k < w->smr.n; k++)
        report_number(r, w->smr_name[k], f->areal == NULL ? NAN : f->smr[k], NULL);
}

static void
put_profile(struct report *r, const struct info_profile *p)
{
    static const struct rc_profile none = {NAN, NAN, NAN, NAN, NAN, NAN, NAN,
                                           NAN, NAN, NAN, NAN, NAN, NAN, 0};
    static const char *const deviation[] = {
        "ra_deviation",  "rq_deviation", "rsk_deviation", "rku_deviation", "rp_deviation",
        "rv_deviation",  "rz_deviation", "rpt_deviation", "rvt_deviation", "rt_deviation",
        "rsm_deviation", "rc_deviation", "rdq_deviation"};

    put_parameters(r, p == NULL ? &none : &p->mean, info_line);
    for (size_t k = 0; info_line[k].key != NULL; k++)
        report_number(r, deviation[k], info_value(p == NULL ? &none : &p->deviation, &info_line[k]),
                      info_unit(info_line[k].kind));
    report_number(r, "profiles", p == NULL ? NAN : (double)p->lines, NULL);
    report_number(r, "elements", p == NULL ? NAN : (double)p->elements, NULL);
}

static void
put_psd(struct report *r, const struct rc_psd *p)
{
    report_number(r, "hurst", p == NULL ? NAN : p->hurst, NULL);
    report_number(r, "hurst_error", p == NULL ? NAN : p->hurst_error, NULL);
    report_number(r, "psd_sum", p == NULL ? NAN : p->sum, "m2");
    report_number(r, "mean_square", p == NULL ? NAN : p->mean_square, "m2");
}

static void
put_patches(struct report *r, const struct rc_patches *p)
{
    report_number(r, "patches", p == NULL ? NAN : (double)p->count, NULL);
    report_number(r, "contact_nodes", p == NULL ? NAN : (double)p->contact_nodes, NULL);
    report_number(r, "contact_area", p == NULL ? NAN : p->contact_area, "m2");
    report_number(r, "contact_area_corrected", p == NULL ? NAN : p->contact_area_corrected, "m2");
    report_number(r, "perimeter", p == NULL ? NAN : p->perimeter, "m");
    report_number(r, "largest_area", p == NULL ? NAN : p->count > 0 ? p->patch[0].area : 0, "m2");
}

void
info_report(struct report *r, const struct info_wanted *w, const struct info_figures *f,
            const struct rc_statistics *s)
{
    const struct rc_grid *g = f->grid;
    bool any = w->areal || w->psd || w->patches || w->line.along != NULL;

    if (!report_wanted(r) ||
        (any && f->areal == NULL && f->psd == NULL && f->patches == NULL && f->profile == NULL))
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
    report_number(r, "minimum", s->minimum, NULL);
    report_number(r, "maximum", s->maximum, NULL);
    report_number(r, "mean", s->mean, NULL);
    report_number(r, "rms", s->rms, NULL);
    report_count(r, "missing", s->missing, NULL);
    if (w->areal) {
        put_parameters(r, f->areal, info_areal);
        put_parameters(r, f->features, info_features);
        put_smr(r, w, f);
    }
    if (w->line.along != NULL)
        put_profile(r, f->profile);
    if (w->psd)
        put_psd(r, f->psd);
    if (w->patches)
        put_patches(r, f->patches);
    report_finish_row(r);
}
