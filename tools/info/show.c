/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "info.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* ---- areal parameters ---- */

/* The reason why a parameter has no value. */
static const char *
undefined(const struct rc_areal *a, const struct rc_figure *p)
{
    if (isnan(a->sq))
        return "nothing was measured";
    if (!(a->sz > 0))
        return "the map is flat";
    if (strcmp(p->name, "str") == 0 && !isnan(a->sal))
        return "ridges run across the map: along them heights are alike over half of it";
    if (strcmp(p->name, "s5p") == 0 || strcmp(p->name, "s5v") == 0 || strcmp(p->name, "s10z") == 0)
        return "there are fewer than five peaks, or pits";
    if (strcmp(p->name, "sha") == 0 || strcmp(p->name, "sda") == 0)
        return "all reach the edge, or missing points";
    return "";
}

static void
put_parameters(const struct info_figures *f, const char *table, const void *figures, FILE *out)
{
    bool profile = f->grid->nx == 1 || f->grid->ny == 1;

    for (const struct rc_figure *p = rc_figures(table); p->name != NULL; p++) {
        const char *name = profile ? info_profile_name(p) : p->title, *why = undefined(f->areal, p);
        double value = rc_figure_number(p, figures);

        if (name == NULL)
            continue;
        fprintf(out, "  %-10s ", name);
        if (isnan(value))
            fprintf(out, "not defined%s%s\n", *why == '\0' ? "" : ": ", why);
        else
            fprintf(out, "%s\n", info_shown(value, p));
    }
}

static void
areal_text(const struct info_wanted *w, const struct info_figures *f, FILE *out)
{
    const char *name = f->grid->nx == 1 || f->grid->ny == 1 ? "Rmr" : "Smr";

    put_parameters(f, "areal", f->areal, out);
    if (f->features != NULL)
        put_parameters(f, "features", f->features, out);
    for (size_t k = 0; k < w->smr.n; k++)
        fprintf(out, "  %-10s %.6g %% at %s\n", name, 100 * f->smr[k],
                shown_in_unit(w->smr.v[k], "m"));
}

/* ---- profiles ---- */

static void
profile_text(const struct info_profile *f, const struct info_wanted *w, FILE *out)
{
    fprintf(out, "  %-10s %s", "profile", w->line.along);
    if (w->line.rows || w->line.columns)
        fprintf(out, ": %zu of them, means +- standard deviations", f->lines);
    fprintf(out, "; %zu points, %s, %zu section%s\n", f->points, shown_in_unit(f->length, "m"),
            f->sections, f->sections == 1 ? "" : "s");
    if (f->skipped > 0)
        fprintf(out, "  %-10s %zu with missing points\n", "left out", f->skipped);
    for (const struct rc_figure *p = rc_figures("profile"); p->name != NULL; p++) {
        double value = rc_figure_number(p, &f->mean), spread = rc_figure_number(p, &f->deviation);

        if (isnan(value))
            fprintf(out, "  %-10s not defined\n", p->title);
        else
            fprintf(out, "  %-10s %s%s%s\n", p->title, info_shown(value, p),
                    isnan(spread) ? "" : " +- ", isnan(spread) ? "" : info_shown(spread, p));
    }
}

/* ---- spectra ---- */

enum {
    LINES = 12 /* rings of a spectrum in text output */
};

/* Shows about a dozen rings: the first ring after each of equal steps of log q. */
static void
psd_lines(const struct rc_psd *psd, const char *unit, FILE *out)
{
    double low = log(psd->q[0]), step = (log(psd->q[psd->rings - 1]) - low) / (LINES - 1);
    double next = low;

    fprintf(out, "  %-10s %-12s %-12s %-12s %s\n", "psd", "wavelength", "q, rad/m", unit, "waves");
    for (size_t k = 0; k < psd->rings; k++) {
        char length[SHOWN_NUMBER + 1];
        if (k + 1 < psd->rings && log(psd->q[k]) < next - 1e-9)
            continue;
        next = fmax(next + step, log(psd->q[k]) + step / 2);
        shown_number_to(length, INFO_2PI / psd->q[k], 4, "m");
        strcat(length, "m");
        fprintf(out, "  %-10s %-12s %-12.4g %-12.4g %zu\n", "", length, psd->q[k], psd->c[k],
                psd->modes[k]);
    }
}

static void
psd_text(const struct info_figures *f, FILE *out)
{
    bool profile = f->grid->nx == 1 || f->grid->ny == 1;
    const struct rc_psd *psd = f->psd;

    psd_lines(psd, profile ? "c, m3" : "c, m4", out);
    fprintf(out, "  %-10s %s\n", "window", psd->window);
    fprintf(out, "  %-10s %.4g m2 (Sq^2 is %.4g m2)\n", "sum", psd->sum, psd->mean_square);
    if (isnan(psd->hurst))
        fprintf(out, "  %-10s not defined: no wavelengths follow a power law\n", "Hurst");
    else
        fprintf(out, "  %-10s %.3f +- %.2g (wavelengths from %s to %s)\n", "Hurst", psd->hurst,
                psd->hurst_error, shown_in_unit(psd->shortest, "m"),
                shown_in_unit(psd->longest, "m"));
}

/* ---- patches ---- */

static void
patches_text(const struct info_figures *f, FILE *out)
{
    const struct rc_patches *p = f->patches;

    fprintf(out, "  %-14s %zu\n", "patches", p->count);
    fprintf(out, "  %-14s %s (%zu nodes)\n", "contact area", shown_area(p->contact_area),
            p->contact_nodes);
    fprintf(out, "  %-14s %s\n", "corrected area", shown_area(p->contact_area_corrected));
    fprintf(out, "  %-14s %s\n", "perimeter", shown_in_unit(p->perimeter, "m"));
    if (p->count > 0)
        fprintf(out, "  %-14s %s (%zu nodes)\n", "largest patch", shown_area(p->patch[0].area),
                p->patch[0].nodes);
}

/* ---- the whole output ---- */

void
info_text(const struct info_wanted *w, const struct info_figures *f, FILE *out)
{
    if (f->areal != NULL)
        areal_text(w, f, out);
    if (f->profile != NULL)
        profile_text(f->profile, w, out);
    if (f->psd != NULL)
        psd_text(f, out);
    if (f->patches != NULL)
        patches_text(f, out);
}
