/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Statistics of figures over scans: mean, standard error of the mean, and standard deviation. */
#include <math.h>
#include <string.h>

#include "info.h"

/* Adds a value by Welford's update, which keeps small deviations beside a large mean. */
static void
take(struct info_spread *s, const char *channel, const char *name, const char *unit, double value)
{
    struct info_spread_row *r = s->row;
    double step;
    size_t k = 0;

    if (!isfinite(value))
        return;
    while (k < s->n && (strcmp(r[k].name, name) != 0 || strcmp(r[k].channel, channel) != 0))
        k++;
    if (k == INFO_SPREAD)
        return;
    if (k == s->n) {
        r[k] = (struct info_spread_row){.least = value, .most = value};
        snprintf(r[k].channel, sizeof r[k].channel, "%s", channel);
        snprintf(r[k].name, sizeof r[k].name, "%s", name);
        snprintf(r[k].unit, sizeof r[k].unit, "%s", unit == NULL ? "" : unit);
        s->n++;
    }
    r += k;
    step = value - r->mean;
    r->mean += step / (double)++r->n;
    r->squares += step * (value - r->mean);
    r->least = fmin(r->least, value);
    r->most = fmax(r->most, value);
}

/* The direction `std` has no mean. */
static void
take_table(struct info_spread *s, const char *channel, const char *table, const void *data)
{
    for (const struct rc_figure *f = rc_figures(table); data != NULL && f->name != NULL; f++)
        if (f->kind != RC_WORD && f->kind != RC_YESNO && strcmp(f->name, "std") != 0)
            take(s, channel, f->name, f->unit, rc_figure_number(f, data));
}

void
info_spread_take(struct info_spread *s, const struct info_wanted *w, const struct info_figures *f,
                 const struct rc_statistics *statistics)
{
    static const char *const names[] = {"minimum", "maximum", "mean", "rms"};
    const double v[] = {statistics->minimum, statistics->maximum, statistics->mean,
                        statistics->rms};
    const char *channel = f->grid->channel;

    if (info_has_no_row(w, f))
        return;
    for (size_t k = 0; k < sizeof v / sizeof *v; k++)
        take(s, channel, names[k], f->grid->unit, v[k]);
    if (strcmp(channel, "height") == 0)
        take(s, channel, "rms_slope", NULL, statistics->rms_slope);
    take_table(s, channel, "areal", f->areal);
    take_table(s, channel, "features", f->features);
    for (size_t k = 0; f->areal != NULL && k < w->smr.n; k++)
        take(s, channel, w->smr_name[k], NULL, f->smr[k]);
    take_table(s, channel, "profile", f->profile == NULL ? NULL : &f->profile->mean);
    take_table(s, channel, "psd", f->psd);
    take_table(s, channel, "patches", f->patches);
}

static double
deviation_of(const struct info_spread_row *r)
{
    return r->n > 1 ? sqrt(r->squares / (double)(r->n - 1)) : NAN;
}

static void
put(FILE *out, double value, const char *unit)
{
    char text[SHOWN_NUMBER + 16];

    if (isnan(value))
        snprintf(text, sizeof text, "-");
    else
        snprintf(text, sizeof text, "%s%s", shown_number(value, 4, unit), unit);
    fprintf(out, " %14s", text);
}

void
info_spread_text(const struct info_spread *s, FILE *out)
{
    fprintf(out, "%-10s %-24s %14s %14s %14s %14s %14s %6s\n", "channel", "figure", "mean",
            "standard error", "deviation", "least", "greatest", "n");
    for (size_t k = 0; k < s->n; k++) {
        const struct info_spread_row *r = &s->row[k];
        double deviation = deviation_of(r);

        fprintf(out, "%-10s %-24s", r->channel, r->name);
        put(out, r->mean, r->unit);
        put(out, deviation / sqrt((double)r->n), r->unit);
        put(out, deviation, r->unit);
        put(out, r->least, r->unit);
        put(out, r->most, r->unit);
        fprintf(out, " %6zu\n", r->n);
    }
}

void
info_spread_json(const struct info_spread *s, struct report *r)
{
    for (size_t k = 0; k < s->n; k++) {
        const struct info_spread_row *row = &s->row[k];
        double deviation = deviation_of(row);

        report_begin(r);
        report_text(r, "channel", row->channel);
        report_text(r, "figure", row->name);
        report_text(r, "unit", row->unit[0] == '\0' ? NULL : row->unit);
        report_count(r, "n", row->n, NULL);
        report_number(r, "mean", row->mean, NULL);
        report_number(r, "standard_error", deviation / sqrt((double)row->n), NULL);
        report_number(r, "deviation", deviation, NULL);
        report_number(r, "least", row->least, NULL);
        report_number(r, "greatest", row->most, NULL);
        report_finish_row(r);
    }
}
