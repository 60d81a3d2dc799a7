/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Colours for values. A colour map is a list of colours at even steps, interpolated in sRGB. The steps are
 * small enough that the lightness (CIELAB L*) is monotonic. viridis and magma follow the maps of these names
 * by N. Smith, S. van der Walt and E. Firing (2015, in the public domain). bluered was made for this tool. It
 * has equal lightness at equal distance from its middle, so that a picture in grey still shows the size of a
 * signed value.
 */
#include "colormap.h"

#include <string.h>

/* clang-format off */
static const unsigned viridis[] = {
    0x440154, 0x460e5f, 0x48196a, 0x482373, 0x472c7b, 0x453681, 0x424086, 0x3e4989,
    0x3b528b, 0x375b8d, 0x33638e, 0x306b8e, 0x2d728e, 0x29798e, 0x27808e, 0x24888d,
    0x21908c, 0x1f988b, 0x1fa088, 0x21a785, 0x27ae81, 0x31b57b, 0x3ebb74, 0x4dc26c,
    0x5dc863, 0x6fce58, 0x82d34b, 0x96d83e, 0xabdc31, 0xbfe027, 0xd4e322, 0xe9e522,
    0xfde725,
};

static const unsigned magma[] = {
    0x000004, 0x0a0418, 0x110926, 0x150e35, 0x1c1046, 0x271058, 0x351069, 0x431076,
    0x51127e, 0x5e1681, 0x6a1b81, 0x762181, 0x822581, 0x8f2a80, 0x9c2e7f, 0xa9327d,
    0xb6377a, 0xc33c75, 0xd04170, 0xdb4869, 0xe65163, 0xef5c5e, 0xf5695c, 0xf9785d,
    0xfc8761, 0xfd9768, 0xfea671, 0xfeb47b, 0xfec387, 0xfed194, 0xfee0a2, 0xfdeeb0,
    0xfcfdbf,
};

static const unsigned bluered[] = {
    0x244a88, 0x2f5898, 0x3b65a5, 0x4571b1, 0x507cbc, 0x5b87c5, 0x6692cd, 0x729dd4,
    0x7ea7da, 0x8bb1df, 0x98bbe4, 0xa6c4e8, 0xb4ceeb, 0xc2d7ed, 0xd0dfef, 0xdfe7ef,
    0xeeeeee, 0xf2e3de, 0xf3d8ce, 0xf3ccbe, 0xf2c0af, 0xefb4a0, 0xeca792, 0xe89b84,
    0xe38e77, 0xde816a, 0xd7745e, 0xcf6752, 0xc65a47, 0xbc4c3c, 0xb03e31, 0xa22f26,
    0x921d1b,
};
/* clang-format on */

static const unsigned grey[] = {0x000000, 0xffffff};

#define POINTS(row) .point = row, .points = sizeof row / sizeof *row

/* The colours `none` and `missing` differ from all colours of values. */
/* clang-format off */
static const struct colormap maps[] = {
    {.name = "viridis", POINTS(viridis), .none = {0xea, 0xea, 0xea}, .missing = {0xa6, 0xa6, 0xa6}},
    {.name = "magma", POINTS(magma), .none = {0xea, 0xea, 0xea}, .missing = {0xa6, 0xa6, 0xa6}},
    {.name = "bluered", POINTS(bluered), .diverging = true, .none = {0xd2, 0xd2, 0xd2},
     .missing = {0x96, 0x96, 0x96}},
    {.name = "grey", POINTS(grey), .none = {0xd6, 0xe4, 0xf2}, .missing = {0xe3, 0xc9, 0x92}},
};
/* clang-format on */

const char *
colormap_name(size_t k)
{
    return k < sizeof maps / sizeof *maps ? maps[k].name : NULL;
}

const struct colormap *
colormap_find(const char *name)
{
    for (size_t k = 0; k < sizeof maps / sizeof *maps; k++)
        if (strcmp(maps[k].name, name) == 0)
            return &maps[k];
    return NULL;
}

static unsigned char
blend(unsigned a, unsigned b, int shift, double u)
{
    double x = a >> shift & 0xff, y = b >> shift & 0xff;

    return (unsigned char)(x + (y - x) * u + 0.5);
}

struct rgb
colormap_at(const struct colormap *map, double t)
{
    double place = (t > 0 ? t < 1 ? t : 1 : 0) * (double)(map->points - 1);
    size_t k = (size_t)place;
    unsigned a, b;

    if (k == map->points - 1)
        k--;
    a = map->point[k];
    b = map->point[k + 1];
    place -= (double)k;
    return (struct rgb){blend(a, b, 16, place), blend(a, b, 8, place), blend(a, b, 0, place)};
}

/* Between two colours of the list each component is monotonic: if both ends of a cell have the same colour,
 * all its inside has it. */
void
colormap_tabulate(struct colormap_table *table, const struct colormap *map)
{
    const size_t steps = map->points - 1;

    table->map = map;
    for (size_t k = 0; k < COLORMAP_CELLS; k++) {
        struct rgb a = colormap_at(map, (double)k / COLORMAP_CELLS);
        struct rgb b = colormap_at(map, (double)(k + 1) / COLORMAP_CELLS);
        bool between = k * steps / COLORMAP_CELLS == ((k + 1) * steps - 1) / COLORMAP_CELLS;

        table->cell[k].colour = a;
        table->cell[k].one = between && a.r == b.r && a.g == b.g && a.b == b.b;
    }
}

double
colormap_place(double lo, double hi, double value)
{
    /* halves, because hi - lo of the largest numbers would overflow */
    return (0.5 * value - 0.5 * lo) / (0.5 * hi - 0.5 * lo);
}

bool
colormap_is_dark(struct rgb c)
{
    return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b < 128;
}
