/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts of an estimated error: their sum, the largest, and their keys in a report. */
#include "errors.h"

#include <math.h>
#include <stddef.h>

#define PART(member) RC_FIGURE_AS(#member "_error_estimate", struct error_parts, member)
static const struct rc_figure kinds[] = {
    {PART(increment), .by = "increments"},
    {PART(inherited), .by = "history"},
    {PART(iteration), .by = "tolerance"},
    {PART(contact), .by = "tolerance"},
    {PART(image), .by = "map"},
    {0},
};

enum {
    KINDS = sizeof kinds / sizeof *kinds - 1
};

static double
part(const struct error_parts *parts, size_t k)
{
    return rc_figure_number(&kinds[k], parts);
}

double
errors_sum(const struct error_parts *parts)
{
    return hypot(parts->increment + parts->inherited, parts->slab) + parts->iteration +
           parts->contact + parts->image;
}

const char *
errors_limited_by(const struct error_parts *parts)
{
    size_t most = 0;

    if (isnan(errors_sum(parts)))
        return "unknown";
    for (size_t k = 1; k < KINDS; k++)
        if (part(parts, k) > part(parts, most))
            most = k;
    if (parts->slab > part(parts, most))
        return "slabs";
    return part(parts, most) > 0 ? kinds[most].by : NULL;
}

void
errors_report(struct report *r, const struct error_parts *parts)
{
    report_table(r, kinds, parts->told ? parts : NULL);
    report_text(r, "error_limited_by", parts->told ? errors_limited_by(parts) : NULL);
}
