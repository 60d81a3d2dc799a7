/* SPDX-License-Identifier: GPL-3.0-or-later */
/* STL, binary: the map as the upper face of a block for a printer, with walls and a floor, so that it is
 * closed. 80 bytes of text, the number of triangles, and for each its normal, its corners, counterclockwise
 * as seen from outside, and two unused bytes. Lengths are millimetres by convention. The longer side is SIDE;
 * the thickness under the lowest point is a fiftieth of it. Row 0 is at the back. */
#include <math.h>

#include "encode.h"
#include "formats/export.h"

enum {
    HEAD = 80,
    CORNERS = 3
};

/* mm: longer side, thickness below the lowest point */
static const double side = 100, floor_thickness = 2;

struct relief {
    const struct rc_grid *g;
    double across, up; /* mm per metre along the map, and upwards */
    double lowest;     /* m */
    FILE *out;
    struct rc_buffer b;
};

/* Position of node (i, j), or of the floor below it. */
static void
corner(const struct relief *r, size_t i, size_t j, bool on_floor, float to[CORNERS])
{
    const struct rc_grid *g = r->g;

    to[0] = (float)((double)i * g->dx * r->across);
    to[1] = (float)((double)(g->ny - 1 - j) * g->dy * r->across);
    to[2] = on_floor ? 0 : (float)(floor_thickness + (g->v[j * g->nx + i] - r->lowest) * r->up);
}

static void
triangle(struct relief *r, const float a[CORNERS], const float b[CORNERS], const float c[CORNERS])
{
    const float *corners[] = {a, b, c};
    double u[CORNERS], v[CORNERS], n[CORNERS], length;

    for (int k = 0; k < CORNERS; k++) {
        u[k] = (double)b[k] - (double)a[k];
        v[k] = (double)c[k] - (double)a[k];
    }
    for (int k = 0; k < CORNERS; k++)
        n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < CORNERS; k++)
        rc_buffer_f32(&r->b, length > 0 ? (float)(n[k] / length) : 0);
    for (int p = 0; p < CORNERS; p++)
        for (int k = 0; k < CORNERS; k++)
            rc_buffer_f32(&r->b, corners[p][k]);
    rc_buffer_u16(&r->b, 0);
}

/* The two triangles of the cell whose upper left corner is node (i, j). */
static void
cell(struct relief *r, size_t i, size_t j)
{
    float a[CORNERS], b[CORNERS], c[CORNERS], d[CORNERS];

    corner(r, i, j, false, a);
    corner(r, i + 1, j, false, b);
    corner(r, i, j + 1, false, c);
    corner(r, i + 1, j + 1, false, d);
    triangle(r, a, c, d);
    triangle(r, a, d, b);
}

/* The wall below the edge between two adjacent nodes of the border, with the outside on the right. It
 * includes the part of the floor between this edge and the middle. */
static void
wall(struct relief *r, size_t i, size_t j, size_t i1, size_t j1)
{
    const struct rc_grid *g = r->g;
    float a[CORNERS], b[CORNERS], c[CORNERS], d[CORNERS];
    const float middle[CORNERS] = {(float)((double)(g->nx - 1) * g->dx * r->across / 2),
                                   (float)((double)(g->ny - 1) * g->dy * r->across / 2), 0};

    corner(r, i, j, false, a);
    corner(r, i1, j1, false, b);
    corner(r, i, j, true, c);
    corner(r, i1, j1, true, d);
    triangle(r, a, c, d);
    triangle(r, a, d, b);
    triangle(r, middle, d, c);
}

/* Goes around the border, counterclockwise as seen from above. */
static void
walls(struct relief *r)
{
    size_t right = r->g->nx - 1, front = r->g->ny - 1;

    for (size_t i = 0; i < right; i++) {
        wall(r, i, front, i + 1, front);
        wall(r, right - i, 0, right - i - 1, 0);
    }
    for (size_t j = 0; j < front; j++) {
        wall(r, right, front - j, right, front - j - 1);
        wall(r, 0, j, 0, j + 1);
    }
}

static enum rc_status
flush(struct relief *r, struct rc_err *err)
{
    enum rc_status status = rc_buffer_write(&r->b, r->out, err);

    r->b.n = 0;
    return status;
}

static double
triangles_of(const struct rc_grid *g)
{
    double i = (double)(g->nx - 1), j = (double)(g->ny - 1);

    return 2 * i * j + 3 * 2 * (i + j);
}

static enum rc_status
start(struct relief *r, const struct rc_grid *g, const struct rc_export_wish *wish,
      struct rc_err *err)
{
    struct rc_range range;
    double triangles = triangles_of(g);
    double longer = fmax((double)(g->nx - 1) * g->dx, (double)(g->ny - 1) * g->dy);

    if (g->nx < 2 || g->ny < 2)
        return rc_err_set(err, "a relief needs two columns and rows, this map has %zu and %zu",
                          g->nx, g->ny);
    if (rc_range_of(g, &range, err) != RC_OK)
        return RC_FAIL;
    if (range.missing > 0)
        return rc_err_set(err,
                          "%zu points are missing, and a relief has no holes: rc-detrend --fill "
                          "gives them heights",
                          range.missing);
    if (triangles > UINT32_MAX)
        return rc_err_set(
            err, "%.0f triangles are more than STL counts: rc-pick --resample makes fewer nodes",
            triangles);
    r->across = side / longer;
    r->up = r->across;
    if (wish->relief > 0 && range.max > range.min)
        r->up = 1e3 * wish->relief / (range.max - range.min);
    r->lowest = range.min;
    rc_buffer_print(&r->b, "%-*.*s", HEAD, HEAD, "relief by libcontact, millimetres");
    rc_buffer_u32(&r->b, (uint32_t)triangles);
    return RC_OK;
}

static enum rc_status
stl_write(FILE *out, struct rc_grid *const *frame, size_t frames, const struct rc_export_wish *wish,
          struct rc_err *err)
{
    struct relief r = {.g = frame[0], .out = out};
    enum rc_status status = start(&r, frame[0], wish, err);

    (void)frames;
    for (size_t j = 0; status == RC_OK && j + 1 < r.g->ny; j++) {
        for (size_t i = 0; i + 1 < r.g->nx; i++)
            cell(&r, i, j);
        status = flush(&r, err);
    }
    if (status == RC_OK) {
        walls(&r);
        status = flush(&r, err);
    }
    rc_buffer_free(&r.b);
    return status;
}

/* Sizes of the file and of the print, for the user. */
static void
stl_foretell(const struct rc_grid *g, const struct rc_export_wish *wish, char *text, size_t size)
{
    struct relief r = {.g = g};
    struct rc_range range;

    if (start(&r, g, wish, NULL) == RC_OK && rc_range_of(g, &range, NULL) == RC_OK) {
        double triangles = triangles_of(g);

        snprintf(text, size,
                 "a block of %.4g x %.4g x %.4g mm, %.4g times the map, heights %.4g times; %.0f "
                 "triangles, %.0f bytes",
                 (double)(g->nx - 1) * g->dx * r.across, (double)(g->ny - 1) * g->dy * r.across,
                 floor_thickness + (range.max - range.min) * r.up, r.across / 1e3, r.up / 1e3,
                 triangles, HEAD + 4 + 50 * triangles);
    } else
        *text = '\0';
    rc_buffer_free(&r.b);
}

const struct rc_export rc_export_stl = {
    .name = "stl",
    .suffixes = ".stl",
    .summary = "relief for a printer, binary STL: closed, 100 mm long, heights by --relief",
    .heights = true,
    .lengths = true,
    .types = RC_TYPE_F32,
    .relief = true,
    .foretell = stl_foretell,
    .write = stl_write,
};
