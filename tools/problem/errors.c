/* Parts of an estimated error: their sum, the largest, and their keys in a report. */
#include "errors.h"

#include <math.h>
#include <stddef.h>

static const struct kind {
    size_t at; /* in struct error_parts */
    const char *key, *lowered_by;
} kinds[] = {
    {offsetof(struct error_parts, increment), "increment_error_estimate", "increments"},
    {offsetof(struct error_parts, inherited), "inherited_error_estimate", "history"},
    {offsetof(struct error_parts, iteration), "iteration_error_estimate", "tolerance"},
    {offsetof(struct error_parts, contact), "contact_error_estimate", "tolerance"},
    {offsetof(struct error_parts, image), "image_error_estimate", "map"},
};

enum {
    KINDS = sizeof kinds / sizeof *kinds
};

static double
part(const struct error_parts *parts, size_t k)
{
    return *(const double *)((const char *)parts + kinds[k].at);
}

double
errors_sum(const struct error_parts *parts)
{
    double sum = 0;

    for (size_t k = 0; k < KINDS; k++)
        sum += part(parts, k);
    return sum;
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
    return part(parts, most) > 0 ? kinds[most].lowered_by : NULL;
}

void
errors_report(struct report *r, const struct error_parts *parts)
{
    for (size_t k = 0; k < KINDS; k++)
        report_number(r, kinds[k].key, parts->told ? part(parts, k) : NAN, NULL);
    report_text(r, "error_limited_by", parts->told ? errors_limited_by(parts) : NULL);
}
