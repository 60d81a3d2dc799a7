/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Colours for values. */
#ifndef RC_COLORMAP_H
#define RC_COLORMAP_H

#include <stdbool.h>
#include <stddef.h>

struct rgb {
    unsigned char r, g, b; /* sRGB */
};

struct colormap {
    const char *name;
    bool diverging; /* its middle is the value 0                             */
    const unsigned *point;
    size_t points;      /* colours 0xRRGGBB at even steps, at least 2        */
    struct rgb none;    /* pressure 0: no contact                            */
    struct rgb missing; /* NaN: not measured                                 */
};

/* Name of colour map k; NULL past the last. */
const char *colormap_name(size_t k);
/* NULL for an unknown name. */
const struct colormap *colormap_find(const char *name);
/* The colour at t from 0 to 1; other t get the colour of the nearer end. */
struct rgb colormap_at(const struct colormap *map, double t);
/* The same, faster, from a table: if all t of a cell have one colour, the table contains it. Otherwise the
 * colour is computed as above. */
enum {
    COLORMAP_CELLS = 1 << 14
};
struct colormap_table {
    const struct colormap *map;
    struct {
        struct rgb colour;
        bool one;
    } cell[COLORMAP_CELLS];
};
void colormap_tabulate(struct colormap_table *table, const struct colormap *map);
static inline struct rgb
colormap_look_up(const struct colormap_table *table, double t)
{
    if (t >= 0 && t < 1) {
        size_t k = (size_t)(t * COLORMAP_CELLS);
        if (table->cell[k].one)
            return table->cell[k].colour;
    }
    return colormap_at(table->map, t);
}
/* The position of a value (not NaN) when the map spans lo to hi, lo < hi. */
double colormap_place(double lo, double hi, double value);
/* True if a light line has more contrast to the colour than a dark one. */
bool colormap_is_dark(struct rgb c);

#endif
