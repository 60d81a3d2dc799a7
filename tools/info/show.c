#include "info.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* ---- areal parameters ---- */

/* Why a parameter has no value. */
static const char *
undefined(const struct rc_areal *a, const struct info_parameter *p)
{
    if (isnan(a->sq))
        return "nothing was measured";
    if (!(a->sz > 0))
        return "the map is flat";
    if (strcmp(p->key, "str") == 0 && !isnan(a->sal))
        return "ridges run across the map: along them heights are alike over half of it";
    if (strcmp(p->key, "s5p") == 0 || strcmp(p->key, "s5v") == 0 || strcmp(p->key, "s10z") == 0)
        return "there are less than five peaks, or pits";
    if (strcmp(p->key, "sha") == 0 || strcmp(p->key, "sda") == 0)
        return "all reach the edge, or what was not measured";
    return "";
}

static void
put_parameters(const struct info_figures *f, const void *figures, const struct info_parameter *p,
               FILE *out)
{
    bool profile = f->grid->nx == 1 || f->grid->ny == 1;
    char text[SHOWN_NUMBER];

    for (; p->key != NULL; p++) {
        const char *name = profile ? p->profile : p->areal;
        double value = info_value(figures, p);
        const char *why = undefined(f->areal, p);

        if (name == NULL)
            continue;
        fprintf(out, "  %-10s ", name);
        if (isnan(value))
            fprintf(out, "not defined%s%s\n", *why == '\0' ? "" : ": ", why);
        else
            fprintf(out, "%s\n", info_shown(text, value, p->kind));
    }
}

static void
areal_text(const struct info_wanted *w, const struct info_figures *f, FILE *out)
{
    const char *name = f->grid->nx == 1 || f->grid->ny == 1 ? "Rmr" : "Smr";
    char height[SHOWN_NUMBER], share[SHOWN_NUMBER];

    put_parameters(f, f->areal, info_areal, out);
    if (f->features != NULL)
        put_parameters(f, f->features, info_features, out);
    for (size_t k = 0; k < w->smr.n; k++)
        fprintf(out, "  %-10s %s at %s\n", name, info_shown(share, f->smr[k], INFO_FRACTION),
                shown_in_unit(height, w->smr.v[k], "m"));
}

static void
json_parameters(struct json *j, const char *name, const void *figures,
                const struct info_parameter *p)
{
    json_object(j, name);
    for (; p->key != NULL; p++)
        json_number(j, p->key, info_value(figures, p));
    json_end(j, '}');
}

static void
smr_json(const struct info_wanted *w, const struct info_figures *f, struct json *j)
{
    json_object(j, "smr");
    json_array(j, "height");
    for (size_t k = 0; k < w->smr.n; k++)
        json_number(j, NULL, w->smr.v[k]);
    json_end(j, ']');
    json_array(j, "ratio");
    for (size_t k = 0; k < w->smr.n; k++)
        json_number(j, NULL, f->smr[k]);
    json_end(j, ']');
    json_end(j, '}');
}

/* ---- profiles ---- */

static void
profile_text(const struct info_profile *f, const struct info_wanted *w, FILE *out)
{
    char text[SHOWN_NUMBER], more[SHOWN_NUMBER];

    fprintf(out, "  %-10s %s", "profile", w->line.along);
    if (w->line.rows || w->line.columns)
        fprintf(out, ": %zu of them, means +- standard deviations", f->lines);
    fprintf(out, "; %zu points, %s, %zu section%s\n", f->points,
            shown_in_unit(text, f->length, "m"), f->sections, f->sections == 1 ? "" : "s");
    if (f->skipped > 0)
        fprintf(out, "  %-10s %zu that were not measured whole\n", "left out", f->skipped);
    for (const struct info_parameter *p = info_line; p->key != NULL; p++) {
        double value = info_value(&f->mean, p), spread = info_value(&f->deviation, p);

        if (isnan(value))
            fprintf(out, "  %-10s not defined\n", p->profile);
        else
            fprintf(out, "  %-10s %s%s%s\n", p->profile, info_shown(text, value, p->kind),
                    isnan(spread) ? "" : " +- ",
                    isnan(spread) ? "" : info_shown(more, spread, p->kind));
    }
}

static void
profile_json(const struct info_profile *f, const struct info_wanted *w, struct json *j)
{
    json_object(j, "profile");
    json_text(j, "along", w->line.along);
    json_count(j, "profiles", f->lines);
    json_count(j, "points", f->points);
    json_number(j, "length", f->length);
    json_count(j, "sections", f->sections);
    json_count(j, "elements", f->elements);
    for (const struct info_parameter *p = info_line; p->key != NULL; p++)
        json_number(j, p->key, info_value(&f->mean, p));
    json_parameters(j, "deviation", &f->deviation, info_line);
    json_end(j, '}');
}

/* ---- spectra ---- */

enum {
    LINES = 12 /* of a spectrum, for people */
};

/* The rings that come next after equal steps of log q. */
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
        shown_number(length, INFO_2PI / psd->q[k], 4, "m");
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
    char shortest[SHOWN_NUMBER], longest[SHOWN_NUMBER];

    psd_lines(psd, profile ? "c, m3" : "c, m4", out);
    fprintf(out, "  %-10s %s\n", "window", psd->window);
    fprintf(out, "  %-10s %.4g m2 (Sq^2 is %.4g m2)\n", "sum", psd->sum, psd->mean_square);
    if (isnan(psd->hurst))
        fprintf(out, "  %-10s not defined: no wavelengths follow a power law\n", "Hurst");
    else
        fprintf(out, "  %-10s %.3f +- %.2g (wavelengths from %s to %s)\n", "Hurst", psd->hurst,
                psd->hurst_error, shown_in_unit(shortest, psd->shortest, "m"),
                shown_in_unit(longest, psd->longest, "m"));
}

static void
psd_json(const struct rc_psd *psd, struct json *j)
{
    json_object(j, "psd");
    json_array(j, "q");
    for (size_t k = 0; k < psd->rings; k++)
        json_number(j, NULL, psd->q[k]);
    json_end(j, ']');
    json_array(j, "c");
    for (size_t k = 0; k < psd->rings; k++)
        json_number(j, NULL, psd->c[k]);
    json_end(j, ']');
    json_array(j, "modes");
    for (size_t k = 0; k < psd->rings; k++)
        json_count(j, NULL, psd->modes[k]);
    json_end(j, ']');
    json_text(j, "window", psd->window);
    json_number(j, "sum", psd->sum);
    json_number(j, "mean_square", psd->mean_square);
    json_number(j, "hurst", psd->hurst);
    json_number(j, "hurst_error", psd->hurst_error);
    json_array(j, "fit");
    json_number(j, NULL, psd->shortest);
    json_number(j, NULL, psd->longest);
    json_end(j, ']');
    json_end(j, '}');
}

/* ---- patches ---- */

static void
patches_text(const struct info_figures *f, FILE *out)
{
    const struct rc_patches *p = f->patches;
    char text[SHOWN_NUMBER];

    fprintf(out, "  %-14s %zu\n", "patches", p->count);
    fprintf(out, "  %-14s %s (%zu nodes)\n", "contact area", shown_area(text, p->contact_area),
            p->contact_nodes);
    fprintf(out, "  %-14s %s\n", "corrected area", shown_area(text, p->contact_area_corrected));
    fprintf(out, "  %-14s %s\n", "perimeter", shown_in_unit(text, p->perimeter, "m"));
    if (p->count > 0)
        fprintf(out, "  %-14s %s (%zu nodes)\n", "largest patch",
                shown_area(text, p->patch[0].area), p->patch[0].nodes);
}

static void
histogram_json(const struct info_figures *f, struct json *j)
{
    json_object(j, "pressure_histogram");
    json_array(j, "edges");
    for (size_t b = 0; f->edges != NULL && b <= INFO_BINS; b++)
        json_number(j, NULL, f->edges[b]);
    json_end(j, ']');
    json_array(j, "counts");
    for (size_t b = 0; f->counts != NULL && b < INFO_BINS; b++)
        json_count(j, NULL, f->counts[b]);
    json_end(j, ']');
    json_end(j, '}');
}

static void
patches_json(const struct info_figures *f, struct json *j)
{
    const struct rc_patches *p = f->patches;

    json_object(j, "patches");
    json_count(j, "count", p->count);
    json_count(j, "contact_nodes", p->contact_nodes);
    json_number(j, "contact_area", p->contact_area);
    json_number(j, "contact_area_corrected", p->contact_area_corrected);
    json_number(j, "perimeter", p->perimeter);
    json_number(j, "largest_area", p->count > 0 ? p->patch[0].area : 0);
    json_array(j, "areas");
    for (size_t k = 0; k < p->count; k++)
        json_number(j, NULL, p->patch[k].area);
    json_end(j, ']');
    json_array(j, "perimeters");
    for (size_t k = 0; k < p->count; k++)
        json_number(j, NULL, p->patch[k].perimeter);
    json_end(j, ']');
    histogram_json(f, j);
    json_end(j, '}');
}

/* ---- all of it ---- */

void
info_json(const struct info_wanted *w, const struct info_figures *f, struct json *j)
{
    if (f->areal != NULL)
        json_parameters(j, "areal", f->areal, info_areal);
    if (f->features != NULL)
        json_parameters(j, "features", f->features, info_features);
    if (f->areal != NULL && w->smr.n > 0)
        smr_json(w, f, j);
    if (f->profile != NULL)
        profile_json(f->profile, w, j);
    if (f->psd != NULL)
        psd_json(f->psd, j);
    if (f->patches != NULL)
        patches_json(f, j);
}

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
