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

/* Options for some kinds of pictures only. */
static void
leave_out(struct tool *t, const char *kind, const char *const *option)
{
    for (; *option != NULL; option++)
        if (tool_given(t, *option))
            tool_usage(t, "%s: leave out --%s", kind, *option);
}

static void
check_kinds(struct tool *t, const struct args *a)
{
    static const char *const of_maps[] = {"channel", "depth", "section", "case", "range", NULL};
    static const char *const of_colours[] = {"colormap", "contour", "border", "clip", "keep", NULL};
    static const char *const of_places[] = {"window", "depth-range", "aspect", NULL};
    static const char *const of_laws[] = {"law", "rms-slope", NULL};
    static const char *const of_spheres[] = {"estar", "radius", NULL};
    static const char *const of_tables[] = {"by", "points", "error", "spread", NULL};
    static const char *const of_curves[] = {"legend", "x-label", "y-label",
                                            "x-unit", "y-unit",  NULL};
    int kinds = (a->curve != NULL) + (a->cut != NULL) + a->histogram + a->material_ratio +
                (a->raw || a->figure);

    if (kinds > 1 && !(a->raw && a->figure))
        tool_usage(t,
                   "--raw, --figure, --curve, --cut, --histogram and --material-ratio are kinds of "
                   "picture: give one");
    if (a->curve != NULL)
        leave_out(t, "--curve draws tables, not maps", of_maps);
    if (a->curve != NULL || args_lines(a)) {
        leave_out(t, "a curve has no colours", of_colours);
        leave_out(t, "a curve is not part of a map", of_places);
    }
    if (a->range != NULL && (a->histogram || a->material_ratio))
        tool_usage(t, "--range is for maps and for --cut: leave it out");
    if (a->curve == NULL && !args_lines(a) && a->style.log != NULL && *a->style.log != '\0')
        tool_usage(t,
                   "--log %s names an axis of a curve: for a map give --log without axes, or add "
                   "--curve X:Y",
                   a->style.log);
    if (a->curve == NULL)
        leave_out(t, "it is for tables, with --curve X:Y", of_tables);
    if (a->curve == NULL && !args_lines(a))
        leave_out(t, "it is for curves: --curve, --cut, --histogram, --material-ratio", of_curves);
    if (a->curve == NULL && !a->histogram)
        leave_out(t, "--law needs --curve or --histogram", of_laws);
    if (a->curve == NULL && !a->histogram && !a->hertz)
        leave_out(t, "they are for laws and --hertz", of_spheres);
    if (a->hertz && (a->curve != NULL || a->histogram || a->material_ratio))
        tool_usage(t, "--hertz is for a map or --cut: with --curve take --law hertz");
}

bool
args_several(const struct args *a)
{
    return a->wanted.depth.n > 1 || a->wanted.number.n > 1 || a->sheet != NULL;
}

static void
check_lists(struct tool *t, const struct args *a)
{
    if (args_several(a) && (a->raw || a->curve != NULL))
        tool_usage(t, "--raw shows one frame: give one --depth and one --case");
    if (a->hillshade && (a->raw || a->curve != NULL || args_lines(a) || a->view != NULL))
        tool_usage(t, "--hillshade is for flat maps with axes: leave it out");
    if (a->view != NULL &&
        (a->raw || a->curve != NULL || args_lines(a) || a->contour || a->border || args_several(a)))
        tool_usage(t,
                   "--view draws one map as a relief: leave out --raw, --contour, --border, curves "
                   "and lists");
    if (a->view != NULL && !isnan(a->aspect))
        tool_usage(t, "--aspect is for flat maps and sections; a relief has --exaggeration");
    if (a->view == NULL && !isnan(a->exaggeration))
        tool_usage(t, "--exaggeration is for a relief: add --view AZ,EL");
    if (a->view != NULL && a->style.log != NULL)
        tool_usage(t, "--view has an even axis upwards: leave out --log");
    if (a->hertz && (a->view != NULL || args_several(a)))
        tool_usage(t, "--hertz is for one flat map: leave it out");
    if (args_several(a) && a->window != NULL && strcmp(a->window, "contact") == 0)
        tool_usage(
            t, "--window contact is another one in each map: of several give it as X0:X1,Y0:Y1");
    if (a->sheet != NULL && (a->raw || a->curve != NULL || args_lines(a)))
        tool_usage(t, "--sheet is for maps: leave it out");
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

static void
check_options(struct tool *t, const struct args *a)
{
    if (a->raw && a->figure)
        tool_usage(t, "--raw and --figure are two kinds of picture: give one");
    if (a->raw && (a->contour || a->border || !isnan(a->aspect)))
        tool_usage(t, "--raw draws only nodes: leave out --%s",
                   a->contour  ? "contour"
                   : a->border ? "border"
                               : "aspect");
    if (a->raw && a->width != NULL)
        tool_usage(t, "--raw is as wide as the map has columns: leave out --width");
    if (a->raw && a->style.paper.family != NULL)
        tool_usage(t, "--raw draws no text: leave out --font");
    if (a->raw && canvas_format(ending_of(t->out_name)) != CANVAS_PNG)
        tool_usage(t, "--raw has a pixel for each node, which only a PNG has: -o must end in .png");
    if (a->raw && a->hertz)
        tool_usage(t, "--raw draws only nodes: leave out --hertz");
    if (a->clip && a->range != NULL)
        tool_usage(t, "--clip chooses the range: leave out --range");
}

void
args_check(struct tool *t, struct args *a)
{
    check_options(t, a);
    read_width(t, a);
    check_kinds(t, a);
    check_lists(t, a);
}
