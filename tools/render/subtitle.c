/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The line under the title: source, case, load, position, and extremes.
 */
#include "render.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define BETWEEN " \xc2\xb7 " /* the figure may break the line here */

void
subtitle_add(struct subtitle *w, const char *name, const char *value)
{
    size_t left = sizeof w->text - w->n;
    int n = snprintf(w->text + w->n, left, "%s%s%s", w->n > 0 ? BETWEEN : "", name, value);

    if (n > 0 && (size_t)n < left)
        w->n += (size_t)n;
    else
        w->text[w->n] = '\0';
}

/* A millionth of the other extreme is more likely rounding than a value. */
static const char *
extreme(char text[TICKS_TEXT], double value, const struct survey *s, const char *unit)
{
    if (value != 0 && fabs(value) < 1e-6 * fmax(fabs(s->min), fabs(s->max)))
        return "\xe2\x89\x88 0";
    return scale_value_to(text, value, unit);
}

static void
say_range(struct subtitle *w, const struct rc_grid *g, const struct survey *s,
          const struct means *m)
{
    char text[TICKS_TEXT];

    if (channel_of(g, s).is[0] != NULL)
        return;
    subtitle_add(w, "min ", extreme(text, s->min, s, g->unit));
    if (m->taken)
        means_say(m, w, g->unit);
    else
        subtitle_add(w, "max ", extreme(text, s->max, s, g->unit));
}

static void
say_part(struct subtitle *w, double part)
{
    char text[TICKS_TEXT];

    if (!(part < 1))
        return;
    snprintf(text, sizeof text, part < 1e-4 ? "%.1g" : "%.2g", 100 * part);
    subtitle_add(w, text, " % of the map");
}

/* Names of keys with the units of their numbers; texts have none. A state identifies a case. */
static const struct {
    const char *key, *name, *unit;
    bool state;
} pieces[] = {{"source", "", NULL, false},
              {"case", "case ", NULL, false},
              {"load", "load ", "N", true},
              {"distance", "distance ", "m", true},
              {"cycles", "cycles ", NULL, true},
              {"time", "time ", "s", true},
              {"speed", "speed ", "m/s", true},
              {"position", "position ", "m", true},
              {"creep_x", "creepage along x ", "%", true},
              {"creep_y", "creepage along y ", "%", true},
              {"spin", "spin ", "rad/m", true},
              {"section", "section ", NULL, false},
              {"depth", "depth ", "m", false},
              {"material", "", NULL, false}}; /* a separate word */

enum {
    PIECES = sizeof pieces / sizeof *pieces
};

/* Most rolling has creepage along x alone: the others are left out where they are 0. */
static bool
is_creepage(const char *key)
{
    return strncmp(key, "creep_", 6) == 0 || strcmp(key, "spin") == 0;
}

bool
subtitle_same(struct rc_grid *const *grid, size_t n, const char *key)
{
    const char *first = rc_grid_get(grid[0], key), *other;

    for (size_t k = 1; k < n; k++) {
        other = rc_grid_get(grid[k], key);
        if ((first == NULL) != (other == NULL) || (first != NULL && strcmp(first, other) != 0))
            return false;
    }
    return true;
}

static const char *
piece_number(char text[TICKS_TEXT], double value, size_t p)
{
    if (strcmp(pieces[p].unit, "%") != 0)
        return scale_value_to(text, value, pieces[p].unit);
    snprintf(text, TICKS_TEXT, "%.4g %%", 100 * value);
    return text;
}

static const char *
piece_text(char text[TICKS_TEXT], const struct rc_grid *g, size_t p)
{
    const char *name = rc_grid_get(g, pieces[p].key);
    double number;

    if (strcmp(pieces[p].key, "material") == 0)
        return (name = media_name(text, g)) == NULL ? "?" : name;
    if (strcmp(pieces[p].key, "section") == 0) {
        if (rc_grid_number(g, "at", &number))
            snprintf(text, TICKS_TEXT, "%.1s = %.40s", name, scale_value(number, "m"));
        else
            snprintf(text, TICKS_TEXT, "largest over all %.1s", name);
        return text;
    }
    if (pieces[p].unit != NULL && rc_grid_number(g, pieces[p].key, &number))
        return piece_number(text, number, p);
    return name;
}

/* Loads that differ by less than their text shows are the same. */
static bool
piece_same(struct rc_grid *const *grid, size_t n, size_t p)
{
    char first[TICKS_TEXT], other[TICKS_TEXT];
    double number;

    if (pieces[p].unit == NULL || !rc_grid_number(grid[0], pieces[p].key, &number))
        return subtitle_same(grid, n, pieces[p].key) &&
               (strcmp(pieces[p].key, "section") != 0 || subtitle_same(grid, n, "at"));
    piece_number(first, number, p);
    for (size_t k = 1; k < n; k++)
        if (!rc_grid_number(grid[k], pieces[p].key, &number) ||
            strcmp(first, piece_number(other, number, p)) != 0)
            return false;
    return true;
}

const char *
subtitle_section(char text[SECTION_TITLE], struct rc_grid *const *grid, size_t n, const char *title)
{
    char place[TICKS_TEXT];
    double at;

    for (size_t p = 0; p < PIECES; p++)
        if (strcmp(pieces[p].key, "section") == 0 && rc_grid_get(grid[0], "section") != NULL &&
            piece_same(grid, n, p)) {
            snprintf(text, SECTION_TITLE, "%.80s%s%s", title,
                     rc_grid_number(grid[0], "at", &at) ? " at " : ", ",
                     piece_text(place, grid[0], p));
            return text;
        }
    return title;
}

void
subtitle_common(struct subtitle *w, struct rc_grid *const *grid, size_t n, bool largest)
{
    char text[TICKS_TEXT], line[sizeof w->text];
    double number;

    for (size_t p = 0; p < PIECES; p++) {
        if (rc_grid_get(grid[0], pieces[p].key) == NULL || !piece_same(grid, n, p) ||
            (w->titled && strcmp(pieces[p].key, "section") == 0) ||
            (is_creepage(pieces[p].key) && rc_grid_number(grid[0], pieces[p].key, &number) &&
             number == 0))
            continue;
        snprintf(line, sizeof line, "%s%s", piece_text(text, grid[0], p),
                 largest && strcmp(pieces[p].key, "depth") == 0 ? " (where it is largest)" : "");
        subtitle_add(w, pieces[p].name, line);
    }
}

void
subtitle_write(struct subtitle *w, struct rc_grid *const *grid, size_t n, const struct survey *s,
               const struct means *means, double part, bool largest)
{
    subtitle_common(w, grid, n, largest);
    say_part(w, part);
    say_range(w, grid[0], s, means);
}

/* If a state identifies the frame, the number of its case is omitted. */
void
frame_label(char *text, size_t size, struct rc_grid *const *grid, size_t n, size_t k)
{
    bool named = false;
    char value[TICKS_TEXT];
    size_t used = 0;

    for (size_t p = 0; p < PIECES; p++)
        named = named || (pieces[p].state && !piece_same(grid, n, p));
    text[0] = '\0';
    for (size_t p = 0; p < PIECES && used < size; p++) {
        if (rc_grid_get(grid[k], pieces[p].key) == NULL || piece_same(grid, n, p) ||
            (named && strcmp(pieces[p].key, "case") == 0))
            continue;
        used += (size_t)snprintf(text + used, size - used, "%s%s%s", used == 0 ? "" : ", ",
                                 pieces[p].name, piece_text(value, grid[k], p));
    }
    if (used == 0)
        snprintf(text, size, "frame %zu", k + 1);
}

/* ---- the legend ---- */

const char *
words_largest(struct words *w, const struct rc_grid *g, double value, const char *across, double x,
              double depth)
{
    snprintf(w->largest, sizeof w->largest, "%s %s at %s = %s, depth %s",
             value < 0 ? "least" : "largest", scale_value(value, g->unit), across,
             scale_value(x, "m"), scale_value(depth, "m"));
    return w->largest;
}
