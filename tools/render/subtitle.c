/*
 * The line under the title: the source, the case, the load, the place, and the extremes.
 */
#include "render.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define BETWEEN " \xc2\xb7 " /* where a figure breaks the line */

/* Adds a piece to the subtitle; one that does not fit is left out whole. */
static void
add_piece(struct subtitle *w, const char *name, const char *value)
{
    size_t left = sizeof w->text - w->n;
    int n = snprintf(w->text + w->n, left, "%s%s%s", w->n > 0 ? BETWEEN : "", name, value);

    if (n > 0 && (size_t)n < left)
        w->n += (size_t)n;
    else
        w->text[w->n] = '\0';
}

static void
say_where(struct subtitle *w, const struct rc_grid *g, bool largest)
{
    const char *section = rc_grid_get(g, "section");
    char text[TICKS_TEXT], name[TICKS_TEXT + 32];
    double number;

    if (section != NULL) {
        snprintf(name, sizeof name, "section %.1s = ", section);
        add_piece(w, name, rc_grid_number(g, "at", &number) ? scale_value(text, number, "m") : "?");
    } else if (rc_grid_number(g, "depth", &number)) {
        scale_value(text, number, "m");
        snprintf(name, sizeof name, "%s%s", text, largest ? " (where it is largest)" : "");
        add_piece(w, "depth ", name);
    }
}

/* What is a millionth of the other extreme is more likely rounding than a value in its own unit. */
static const char *
extreme(char text[TICKS_TEXT], double value, const struct survey *s, const char *unit)
{
    if (value != 0 && fabs(value) < 1e-6 * fmax(fabs(s->min), fabs(s->max)))
        return "\xe2\x89\x88 0";
    return scale_value(text, value, unit);
}

void
subtitle_write(struct subtitle *w, const struct rc_grid *g, const struct survey *s, double part,
               bool largest)
{
    const char *source = rc_grid_get(g, "source"), *number = rc_grid_get(g, "case");
    char text[TICKS_TEXT];
    double load;

    if (source != NULL)
        add_piece(w, "", source);
    if (number != NULL)
        add_piece(w, "case ", number);
    if (rc_grid_number(g, "load", &load))
        add_piece(w, "load ", scale_value(text, load, "N"));
    say_where(w, g, largest);
    if (part < 1) {
        snprintf(text, sizeof text, part < 1e-4 ? "%.1g" : "%.2g", 100 * part);
        add_piece(w, text, " % of the map");
    }
    add_piece(w, "min ", extreme(text, s->min, s, g->unit));
    add_piece(w, "max ", extreme(text, s->max, s, g->unit));
}

/* ---- the legend ---- */

const char *
words_largest(struct words *w, const struct rc_grid *g, double value, const char *across, double x,
              double depth)
{
    char size[TICKS_TEXT], at[TICKS_TEXT], down[TICKS_TEXT];

    snprintf(w->largest, sizeof w->largest, "%s %s at %s = %s, depth %s",
             value < 0 ? "least" : "largest", scale_value(size, value, g->unit), across,
             scale_value(at, x, "m"), scale_value(down, depth, "m"));
    return w->largest;
}

/* Hertz (1882): a sphere of radius R touches a disc, a^3 = 3 F R / (4 E*). */
const char *
words_hertz(struct tool *t, struct words *w, const struct rc_grid *g, double *radius)
{
    const char *form = rc_grid_get(g, "form");
    char text[TICKS_TEXT];
    double load, estar, r = 0;
    struct rc_err err;

    if (rc_grid_get(g, "section") != NULL)
        tool_die_at(t, g, EXIT_IMPOSSIBLE, "--hertz is a circle on a map, and this is a section");
    if (form == NULL || strncmp(form, "sphere ", 7) != 0 ||
        unit_number(form + 7, UNIT_M, &r, &err) != RC_OK || !(r > 0) ||
        !rc_grid_number(g, "load", &load) || !rc_grid_number(g, "estar", &estar) || !(load > 0) ||
        !(estar > 0))
        tool_die_at(t, g, EXIT_IMPOSSIBLE,
                    "--hertz needs the keys load, estar and form=sphere RADIUS, which rc-solve "
                    "--radius leaves: leave it out");
    *radius = cbrt(0.75 * load * r / estar);
    snprintf(w->circle, sizeof w->circle, "Hertz, radius %s", scale_value(text, *radius, "m"));
    return w->circle;
}
