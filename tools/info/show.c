#include "info.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* ---- areal parameters ---- */

enum kind {
    LENGTH,
    NUMBER,
    FRACTION, /* shown in per cent */
    ANGLE
};

#define FIELD(name) #name, offsetof(struct rc_areal, name)

/* In the order of the contract; of a profile by ISO 21920-2, NULL where that has none. */
static const struct parameter {
    const char *key;
    size_t at;
    const char *areal, *profile;
    enum kind kind;
} parameters[] = {
    {FIELD(sq), "Sq", "Rq", LENGTH},          {FIELD(sa), "Sa", "Ra", LENGTH},
    {FIELD(ssk), "Ssk", "Rsk", NUMBER},       {FIELD(sku), "Sku", "Rku", NUMBER},
    {FIELD(sp), "Sp", "Rpt", LENGTH},         {FIELD(sv), "Sv", "Rvt", LENGTH},
    {FIELD(sz), "Sz", "Rt", LENGTH},          {FIELD(sdq), "Sdq", "Rdq", NUMBER},
    {FIELD(sdr), "Sdr", "Rdr", FRACTION},     {FIELD(sal), "Sal", "Ral", LENGTH},
    {FIELD(str), "Str", NULL, NUMBER},        {FIELD(std), "Std", NULL, ANGLE},
    {FIELD(sk), "Sk", "Rk", LENGTH},          {FIELD(spk), "Spk", "Rpk", LENGTH},
    {FIELD(svk), "Svk", "Rvk", LENGTH},       {FIELD(smr1), "Smr1", "Rmrk1", FRACTION},
    {FIELD(smr2), "Smr2", "Rmrk2", FRACTION}, {FIELD(vmp), "Vmp", "Rvmp", LENGTH},
    {FIELD(vmc), "Vmc", "Rvmc", LENGTH},      {FIELD(vvc), "Vvc", "Rvvc", LENGTH},
    {FIELD(vvv), "Vvv", "Rvvv", LENGTH},      {FIELD(sxp), "Sxp", "Rdc", LENGTH},
};

enum {
    PARAMETERS = sizeof parameters / sizeof *parameters
};

static double
value_of(const struct rc_areal *a, const struct parameter *p)
{
    return *(const double *)(const void *)((const char *)a + p->at);
}

/* Why a parameter has no value. */
static const char *
undefined(const struct rc_areal *a, const struct parameter *p)
{
    if (isnan(a->sq))
        return "nothing was measured";
    if (!(a->sz > 0))
        return "the map is flat";
    if (p->at == offsetof(struct rc_areal, str) && !isnan(a->sal))
        return "ridges run across the map: along them heights are alike over half of it";
    return "";
}

static void
put_parameter(FILE *out, const char *name, double value, enum kind kind, const char *why)
{
    char text[SHOWN_NUMBER];

    fprintf(out, "  %-10s ", name);
    if (isnan(value))
        fprintf(out, "not defined%s%s\n", *why == '\0' ? "" : ": ", why);
    else if (kind == LENGTH)
        fprintf(out, "%s\n", shown_in_unit(text, value, "m"));
    else
        fprintf(out, "%.6g%s\n", kind == FRACTION ? 100 * value : value,
                kind == FRACTION ? " %"
                : kind == ANGLE  ? " deg"
                                 : "");
}

static void
areal_text(const struct info_figures *f, FILE *out)
{
    bool profile = f->grid->nx == 1 || f->grid->ny == 1;

    for (size_t k = 0; k < PARAMETERS; k++) {
        const struct parameter *p = &parameters[k];
        const char *name = profile ? p->profile : p->areal;
        if (name != NULL)
            put_parameter(out, name, value_of(f->areal, p), p->kind, undefined(f->areal, p));
    }
}

static void
areal_json(const struct rc_areal *a, struct json *j)
{
    json_object(j, "areal");
    for (size_t k = 0; k < PARAMETERS; k++)
        json_number(j, parameters[k].key, value_of(a, &parameters[k]));
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
info_json(const struct info_figures *f, struct json *j)
{
    if (f->areal != NULL)
        areal_json(f->areal, j);
    if (f->psd != NULL)
        psd_json(f->psd, j);
    if (f->patches != NULL)
        patches_json(f, j);
}

void
info_text(const struct info_figures *f, FILE *out)
{
    if (f->areal != NULL)
        areal_text(f, out);
    if (f->psd != NULL)
        psd_text(f, out);
    if (f->patches != NULL)
        patches_text(f, out);
}
