/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "export.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define RC_EXPORT(name) extern const struct rc_export rc_export_##name;
#include "exports.list"
#undef RC_EXPORT

const struct rc_export *const rc_exports[] = {
#define RC_EXPORT(name) &rc_export_##name,
#include "exports.list"
#undef RC_EXPORT
    NULL,
};

const struct rc_export *
rc_export_named(const char *name)
{
    for (const struct rc_export *const *e = rc_exports; *e != NULL; e++)
        if (strcmp((*e)->name, name) == 0)
            return *e;
    return NULL;
}

static bool
has_suffix(const char *file, const char *suffixes)
{
    size_t n = strlen(file), length;

    for (const char *s = suffixes; *s != '\0'; s += length + (s[length] == ' ')) {
        length = strcspn(s, " ");
        if (n > length && strncmp(file + n - length, s, length) == 0)
            return true;
    }
    return false;
}

const struct rc_export *
rc_export_suffixed(const char *file)
{
    for (const struct rc_export *const *e = rc_exports; *e != NULL; e++)
        if (has_suffix(file, (*e)->suffixes))
            return *e;
    return NULL;
}

enum rc_raw
rc_export_raw(const struct rc_grid *g, const struct rc_export_wish *wish, unsigned types)
{
    enum rc_raw raw = g->type == RC_F32 ? RC_RAW_F32 : RC_RAW_F64;

    if (wish->typed)
        return wish->raw;
    if (types >> raw & 1)
        return raw;
    for (raw = RC_RAW_F64; raw > RC_RAW_I16 && (types >> raw & 1) == 0;)
        raw--;
    return raw;
}

/* ---- sections: rows are depths ---- */

enum rc_status
rc_export_depths(const struct rc_grid *g, double *at, struct rc_err *err)
{
    const char *text = rc_grid_get(g, "depths"), *end;

    for (size_t k = 0; k < g->ny; k++) {
        while (text != NULL && (*text == ',' || *text == ' '))
            text++;
        if (text == NULL || (end = rc_number_read(text, false, &at[k])) == NULL)
            return rc_err_set(err, "a section of %zu rows without as many depths", g->ny);
        if (k > 0 && !(at[k] > at[k - 1]))
            return rc_err_set(err, "the depths of a section must rise from row to row");
        text = end;
    }
    return RC_OK;
}

bool
rc_export_even(const double *at, size_t n, double *step)
{
    *step = n > 1 ? (at[n - 1] - at[0]) / (double)(n - 1) : 0;
    for (size_t k = 1; k < n; k++)
        if (!(fabs(at[k] - at[0] - (double)k * *step) <= 1e-9 * fabs(*step)))
            return false;
    return true;
}

static enum rc_status
check_section(const struct rc_export *format, const struct rc_grid *g, struct rc_err *err)
{
    enum rc_status status = RC_FAIL;
    RC_OWNED double *at = NULL;
    double step;

    if (rc_grid_get(g, "section") == NULL || rc_grid_get(g, "depths") == NULL)
        return RC_OK;
    if ((at = malloc(g->ny * sizeof *at)) == NULL)
        return rc_err_set(err, "out of memory for %zu depths", g->ny);
    if (rc_export_depths(g, at, err) == RC_OK) {
        if (format->uneven || rc_export_even(at, g->ny, &step))
            status = RC_OK;
        else
            rc_err_set(err,
                       "the depths have uneven steps, which %s cannot say: write vtr, or resample "
                       "them with --even",
                       format->name);
    }
    return status;
}

enum rc_status
rc_export_write(const struct rc_export *format, FILE *out, struct rc_grid *const *frame,
                size_t frames, const struct rc_export_wish *wish, struct rc_err *err)
{
    for (size_t k = 0; k < frames; k++) {
        const char *dunit = rc_grid_dunit(frame[k]);
        if (check_section(format, frame[k], err) != RC_OK)
            return RC_FAIL;
        if (format->lengths && strcmp(dunit, "m") != 0)
            return rc_err_set(err,
                              "%s says of its spacings that they are lengths, these are in %s: "
                              "choose a format that names the unit (gsf, gwy, csv, hdf5)",
                              format->name, dunit);
    }
    return format->write(out, frame, frames, wish, err);
}

/* ---- words ---- */

/* The name of one frame; `cases` and `depths`: the name must distinguish cases and depths. */
static void
plain_label(char label[RC_LABEL], const struct rc_grid *g, bool cases, bool depths)
{
    double depth;
    int n = snprintf(label, RC_LABEL, "%.64s", g->channel);

    if (depths && rc_grid_number(g, "depth", &depth))
        n += snprintf(label + n, RC_LABEL - (size_t)n, "_z%s", rc_number(depth));
    if (cases)
        snprintf(label + n, RC_LABEL - (size_t)n, "_case%zu", rc_grid_case(g));
}

const char *
rc_export_label(char label[RC_LABEL], struct rc_grid *const *frame, size_t frames, size_t k,
                bool depths)
{
    char other[RC_LABEL];
    bool cases = false;
    size_t twins = 0, n;

    for (size_t j = 1; j < frames; j++)
        cases = cases || rc_grid_case(frame[j]) != rc_grid_case(frame[0]);
    plain_label(label, frame[k], cases, depths);
    for (size_t j = 0; j < k; j++) {
        plain_label(other, frame[j], cases, depths);
        twins += strcmp(label, other) == 0;
    }
    n = strlen(label);
    if (twins > 0)
        snprintf(label + n, RC_LABEL - n, "_%zu", twins + 1);
    return label;
}

/* True if text begins with a date and a time of ISO 8601: "2026-11-21T09:30:00". */
static bool
is_date(const char *text)
{
    static const char form[] = "0000-00-00T00:00:00";

    for (size_t k = 0; k < sizeof form - 1; k++)
        if (form[k] == '0' ? text[k] < '0' || text[k] > '9' : text[k] != form[k])
            return false;
    return true;
}

const char *
rc_export_date(char date[RC_DATE], const struct rc_grid *g, const struct rc_export_wish *wish)
{
    const char *said = rc_grid_get(g, "file.date");
    time_t seconds = (time_t)wish->time;
    struct tm tm;

    if (said != NULL && is_date(said)) {
        snprintf(date, RC_DATE, "%.19s", said);
        if (said[19] == 'Z')
            strcat(date, "Z");
    } else if (gmtime_r(&seconds, &tm) == NULL ||
               strftime(date, RC_DATE, "%Y-%m-%dT%H:%M:%SZ", &tm) == 0) {
        strcpy(date, "1970-01-01T00:00:00Z");
    }
    return date;
}
