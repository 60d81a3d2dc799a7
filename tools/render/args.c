/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The options: valid combinations, and their results.
 */
#include "render.h"

#include <math.h>
#include <string.h>

bool
args_lines(const struct args *a)
{
    return a->cut != NULL || a->histogram || a->material_ratio;
}

bool
args_several(const struct args *a)
{
    return a->wanted.depth.n > 1 || a->wanted.number.n > 1 || a->sheet != NULL;
}

/* A plain number of pixels, or a length on paper. */
static void
read_width(struct tool *t, struct args *a)
{
    const double dpi = 300, inch = 0.0254;
    const double narrow = 0.06; /* metres: smaller figures have no room for a map beside text and
                                   axes */
    bool plain = a->width != NULL && a->width[strspn(a->width, "0123456789")] == '\0';
    double width = 0;

    a->style.paper.dpi = isnan(a->dpi) ? 0 : a->dpi;
    if (a->width == NULL)
        return;
    if (unit_number(a->width, plain ? UNIT_NONE : UNIT_M, &width, &t->err) != RC_OK)
        tool_usage(t, "--width %s: %s", a->width, t->err.text);
    if (!plain) {
        a->style.paper.dpi = a->style.paper.dpi > 0 ? a->style.paper.dpi : dpi;
        width *= a->style.paper.dpi / inch;
    }
    if (a->style.paper.dpi > 0 && !(width >= narrow / inch * a->style.paper.dpi))
        tool_usage(t, "--width %s: on paper it must be at least 60mm", a->width);
    if (!(width >= FIGURE_NARROW && width <= FIGURE_WIDE))
        tool_usage(t, "--width %s: it must be %d to %d pixels%s", a->width, FIGURE_NARROW,
                   FIGURE_WIDE, plain ? "" : ", which is a matter of --dpi");
    a->style.paper.width = (size_t)round(width);
}

void
args_check(struct tool *t, struct args *a)
{
    if (a->raw && canvas_format(ending_of(t->out_name)) != CANVAS_PNG)
        tool_usage(t, "--raw has a pixel for each node, which only a PNG has: -o must end in .png");
    read_width(t, a);
}
