/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The view of a relief, and its notes.
 */
#include "render.h"

#include <math.h>

void
view_read(struct tool *t, const char *text, struct view *view)
{
    double pair[2];

    if (look_pair(text, UNIT_NONE, pair, &t->err) != RC_OK)
        tool_usage(t, "--view %s: %s", text, t->err.text);
    if (!(fabs(pair[0]) <= 360) || !(pair[1] > 0 && pair[1] <= 90))
        tool_usage(t,
                   "--view %s: it must be AZ,EL in degrees, as in 30,35, EL above 0 and at most 90",
                   text);
    view->azimuth = pair[0];
    view->elevation = pair[1];
}

void
view_check(struct tool *t, const struct rc_grid *g, const struct figure *f)
{
    const double most = 4; /* sides */
    double side = fmax(f->at.right - f->at.left, f->at.bottom - f->at.top);
    double box = f->at.exaggeration * (f->bar.hi - f->bar.lo) / side;

    if (f->at.exaggeration > 0 && !relief_to_scale(f))
        tool_die_at(t, g, EXIT_USAGE,
                    "--exaggeration is for heights and other lengths, this is a %s: leave it out",
                    g->channel);
    if (box > most)
        tool_die_at(t, g, EXIT_USAGE,
                    "--exaggeration %.6g: the box would be %.3g times as high as its longer side: "
                    "give at most %.3g",
                    f->at.exaggeration, box, f->at.exaggeration * most / box);
}

void
view_say(const struct figure *f, struct subtitle *subtitle)
{
    char text[TICKS_TEXT];

    if (relief_to_scale(f)) {
        snprintf(text, sizeof text, "%.15g", relief_exaggeration(f));
        subtitle_add(subtitle, "vertical exaggeration ", text);
    }
    if (f->nodes.missing > 0) {
        snprintf(text, sizeof text, "%zu nodes", f->nodes.missing);
        subtitle_add(subtitle, "holes: not measured, ", text);
    }
}
