/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plan.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

struct plan
plan_begin(struct tool *t, struct report *r, const struct rc_grid *g, size_t number,
           const char *boundary, const char *what)
{
    const struct plan p = {t, r, !report_wanted(r) || strcmp(r->name, "-") != 0};

    report_begin(r);
    report_map(r, g, number);
    report_text(r, "boundary", boundary);
    report_count(r, "threads", t->threads, NULL);
    if (p.says)
        fprintf(t->output.file, "%s: %zu x %zu nodes%s%s%s\n", tool_where(t, g), g->nx, g->ny,
                boundary != NULL ? ", boundary " : "", boundary != NULL ? boundary : "", what);
    return p;
}

void
plan_say(const struct plan *p, const char *name, const char *format, ...)
{
    va_list list;

    if (!p->says)
        return;
    fprintf(p->tool->output.file, "  %-15s ", name);
    va_start(list, format);
    vfprintf(p->tool->output.file, format, list);
    va_end(list);
    putc('\n', p->tool->output.file);
}

void
plan_effects(const struct plan *p, const struct effect_state *effects)
{
    report_effects(p->report, effects);
    for (; effects->name != NULL; effects++)
        plan_say(p, effects->name, "%s", effects->state);
}

void
plan_end(const struct plan *p, double convolutions, double seconds, size_t memory)
{
    char work[128] = "", time[64] = "unknown time, because the memory does not suffice";

    report_forecast(p->report, convolutions, seconds, memory);
    report_finish_row(p->report);
    if (!isnan(convolutions))
        snprintf(work, sizeof work, "%.0f convolutions, ", convolutions);
    if (!isnan(seconds))
        snprintf(time, sizeof time, "%.2g s with %zu thread%s", seconds, p->tool->threads,
                 p->tool->threads == 1 ? "" : "s");
    if (p->says)
        fprintf(p->tool->output.file, "  about %s%zu MiB, %s\n", work, (memory >> 20) + 1, time);
}
