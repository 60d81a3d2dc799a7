/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names of parameters in the standards, and their units. */
#include "info.h"

#include <string.h>

/* ISO 21920-2, in the order of the table of rc_areal. */
static const char *const of_profile[] = {"Rq",   "Ra",   "Rsk",  "Rku",   "Rpt",          "Rvt",
                                         "Rt",   "Rdq",  "Rdr",  "Ral",   NULL,           NULL,
                                         "Rk",   "Rpk",  "Rvk",  "Rmrk1", "Rmrk2",        "Rvmp",
                                         "Rvmc", "Rvvc", "Rvvv", "Rdc",   "RMS curvature"};

const char *
info_profile_name(const struct rc_figure *areal)
{
    return of_profile[areal - rc_figures("areal")];
}

const char *
info_shown_to(char text[SHOWN_NUMBER], double value, const struct rc_figure *f)
{
    static const char *const fraction[] = {"sdr", "smr1", "smr2"};
    static const struct {
        const char *unit, *shown;
        double factor;
    } units[] = {{"deg", "deg", 1}, {"1/m2", "1/mm2", 1e-6}, {"1/m", "1/mm", 1e-3}};
    const char *unit = f->unit == NULL ? "" : f->unit;

    if (strcmp(unit, "m") == 0)
        return shown_in_unit_to(text, value, "m");
    if (strcmp(unit, "m2") == 0)
        return shown_area_to(text, value);
    snprintf(text, SHOWN_NUMBER, "%.6g", value);
    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        if (strcmp(unit, units[k].unit) == 0)
            snprintf(text, SHOWN_NUMBER, "%.6g %s", units[k].factor * value, units[k].shown);
    for (size_t k = 0; k < sizeof fraction / sizeof *fraction; k++)
        if (strcmp(f->name, fraction[k]) == 0)
            snprintf(text, SHOWN_NUMBER, "%.6g %%", 100 * value);
    return text;
}
