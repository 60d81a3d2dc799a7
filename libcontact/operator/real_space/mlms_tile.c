/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * One tile of one level: pressures to the coarse grid, corrections there, and displacements back.
 */
#include "mlms.h"

#include <string.h>

/* A rectangle of nodes or places: [x0, x0 + nx) by [y0, y0 + ny); the corner may lie outside. */
struct area {
    ptrdiff_t x0, y0;
    size_t nx, ny;
};

static size_t
rounded(size_t n, size_t to)
{
    return (n + to - 1) / to * to;
}

/* Prefetches values that are read some rows later: rows are too short and too far apart for the hardware to
 * do so. */
static void
prefetch(const double *map, const struct rc_mlms_axis axis[2], ptrdiff_t x0, ptrdiff_t y, size_t n)
{
    enum {
        ROWS = 4
    };
    ptrdiff_t nx = (ptrdiff_t)axis[RC_X].n, first = x0 > 0 ? x0 : 0, last = x0 + (ptrdiff_t)n;

    last = last < nx ? last : nx;
    if (y + ROWS >= 0 && y + ROWS < (ptrdiff_t)axis[RC_Y].n)
        for (ptrdiff_t x = first; x < last; x += RC_SIMD_WIDTH)
            __builtin_prefetch(map + (y + ROWS) * nx + x);
}

static size_t
least(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Nodes of a tile. */
static struct area
tile_area(const struct rc_mlms_axis axis[2], size_t tile)
{
    size_t x = tile % axis[RC_X].tiles, y = tile / axis[RC_X].tiles;
    size_t wide = axis[RC_X].tile << axis[RC_X].halved, high = axis[RC_Y].tile << axis[RC_Y].halved;

    return (struct area){(ptrdiff_t)(x * wide), (ptrdiff_t)(y * high),
                         least(wide, axis[RC_X].n - x * wide),
                         least(high, axis[RC_Y].n - y * high)};
}

/* True if a tile that carries pressure meets an area of a level's nodes. */
static bool
loaded(const struct rc_mlms_level *l, struct area a)
{
    const struct rc_mlms_axis *ax = &l->axis[RC_X], *ay = &l->axis[RC_Y];
    size_t wide = ax->tile << ax->halved, high = ay->tile << ay->halved;
    ptrdiff_t x1 = a.x0 + (ptrdiff_t)a.nx, y1 = a.y0 + (ptrdiff_t)a.ny;

    a.x0 = a.x0 > 0 ? a.x0 : 0;
    a.y0 = a.y0 > 0 ? a.y0 : 0;
    if (x1 <= a.x0 || y1 <= a.y0)
        return false;
    for (size_t y = (size_t)a.y0 / high; y < ay->tiles && y <= (size_t)(y1 - 1) / high; y++)
        for (size_t x = (size_t)a.x0 / wide; x < ax->tiles && x <= (size_t)(x1 - 1) / wide; x++)
            if (l->loaded[y * ax->tiles + x])
                return true;
    return false;
}

/* An area of places in nodes, with the margins of corrections. */
static struct area
halo(const struct rc_mlms_axis axis[2], struct area a)
{
    size_t hx = axis[RC_X].halved, hy = axis[RC_Y].halved;
    size_t mx = axis[RC_X].margin, my = axis[RC_Y].margin;

    return (struct area){(a.x0 - (ptrdiff_t)mx) * (ptrdiff_t)(1 + hx),
                         (a.y0 - (ptrdiff_t)my) * (ptrdiff_t)(1 + hy), (a.nx + 2 * mx) << hx,
                         (a.ny + 2 * my) << hy};
}

void
rc_mlms_scan(const struct rc_mlms *m, size_t level, const double *p, size_t tile)
{
    const struct rc_mlms_level *l = &m->level[level];
    struct area t = tile_area(l->axis, tile);
    const double *row = p + (size_t)t.y0 * l->axis[RC_X].n + (size_t)t.x0;

    l->loaded[tile] = 0;
    for (size_t y = 0; y < t.ny && !l->loaded[tile]; y++, row += l->axis[RC_X].n)
        l->loaded[tile] = m->simd->count_nonzero(row, t.nx) > 0;
}

/* ---- (10) ---- */

/* Values [x0, x0 + n) of row y of an nx x ny map; those outside are not copied. */
static void
copy_row(const double *map, const struct rc_mlms_axis axis[2], ptrdiff_t x0, ptrdiff_t y, size_t n,
         double *out)
{
    ptrdiff_t nx = (ptrdiff_t)axis[RC_X].n, first = x0 < 0 ? -x0 : 0, last = nx - x0;

    last = last < (ptrdiff_t)n ? last : (ptrdiff_t)n;
    if (y < 0 || y >= (ptrdiff_t)axis[RC_Y].n || last <= first) {
        memset(out, 0, n * sizeof *out);
        return;
    }
    memset(out, 0, (size_t)first * sizeof *out);
    memcpy(out + first, map + y * nx + x0 + first, (size_t)(last - first) * sizeof *out);
    memset(out + last, 0, (n - (size_t)last) * sizeof *out);
}

/* Row `at` of the coarse grid in y, still fine in x: [x0, x0 + n). */
static void
reduce_rows(const struct rc_mlms *m, const struct rc_mlms_axis axis[2], const double *p,
            ptrdiff_t x0, ptrdiff_t at, size_t n, struct rc_mlms_scratch *w, double *out)
{
    ptrdiff_t nx = (ptrdiff_t)axis[RC_X].n, ny = (ptrdiff_t)axis[RC_Y].n;
    ptrdiff_t first = x0 < 0 ? -x0 : 0, last = nx - x0 < (ptrdiff_t)n ? nx - x0 : (ptrdiff_t)n;
    ptrdiff_t y = 2 * (at - (ptrdiff_t)m->d.t + 1);
    const double *on = y >= 0 && y < ny ? p + y * nx + x0 + first : NULL;

    if (last < first)
        last = first;
    prefetch(p, axis, x0, y + 2 * (ptrdiff_t)m->d.t - 2, n);
    prefetch(p, axis, x0, y + 2 * (ptrdiff_t)m->d.t - 1, n);
    for (size_t i = 0; i < m->d.t; i++) {
        ptrdiff_t below = y - 1 - 2 * (ptrdiff_t)i, above = y + 1 + 2 * (ptrdiff_t)i;
        w->near[i] = below >= 0 && below < ny ? p + below * nx + x0 + first : w->zeros;
        w->far[i] = above >= 0 && above < ny ? p + above * nx + x0 + first : w->zeros;
    }
    memset(out, 0, (size_t)first * sizeof *out);
    m->simd->weighted_sum(m->d.t, m->s, w->near, w->far, on, (size_t)(last - first), out + first);
    memset(out + last, 0, (n - (size_t)last) * sizeof *out);
}

/* The same in x: coarse nodes from a row that begins 2t fine nodes before the first of them. */
static void
reduce_row(const struct rc_mlms *m, const double *row, size_t n, struct rc_mlms_scratch *w,
           double *out)
{
    size_t t = m->d.t, fine = 2 * (n + 2 * t);
    double *even = w->out[0], *odd = w->out[1];

    m->simd->deinterleave(row, fine, even, odd);
    for (size_t i = 0; i < t; i++) {
        w->near[i] = odd + t - 1 - i;
        w->far[i] = odd + t + i;
    }
    m->simd->weighted_sum(t, m->s, w->near, w->far, even + t, n, out);
}

void
rc_mlms_reduce(const struct rc_mlms *m, size_t level, const double *p, size_t tile,
               struct rc_mlms_scratch *w)
{
    const struct rc_mlms_level *l = &m->level[level], *next = l + 1;
    const struct rc_mlms_axis *ax = &l->axis[RC_X], *ay = &l->axis[RC_Y];
    struct area c = tile_area(next->axis, tile);
    ptrdiff_t t = (ptrdiff_t)m->d.t, x0 = ax->halved ? 2 * (c.x0 - 2 * t + 1) : c.x0;
    ptrdiff_t y0 = ay->halved ? 2 * (c.y0 - 2 * t + 1) : c.y0;
    size_t n = ax->halved ? 2 * (c.nx + 2 * m->d.t) : c.nx;
    size_t high = ay->halved ? 2 * (c.ny + 2 * m->d.t) : c.ny, found = 0;
    double *out = next->p + (size_t)c.y0 * next->axis[RC_X].n + (size_t)c.x0;
    bool any = loaded(l, (struct area){x0, y0, n, high});

    for (size_t y = 0; y < c.ny; y++, out += next->axis[RC_X].n) {
        double *row = ax->halved ? w->mid : out;
        if (!any) {
            memset(out, 0, c.nx * sizeof *out);
            continue;
        }
        if (ay->halved)
            reduce_rows(m, l->axis, p, x0, c.y0 + (ptrdiff_t)y, n, w, row);
        else
            copy_row(p, l->axis, x0, c.y0 + (ptrdiff_t)y, n, row);
        if (ax->halved)
            reduce_row(m, row, c.nx, w, out);
        found += m->simd->count_nonzero(out, c.nx);
    }
    next->loaded[tile] = found > 0;
}

/* ---- (14), (17) ---- */

/* Pressures about an area of places, class by class, with the margins of the level; zero outside the map. */
static void
gather(const struct rc_mlms *m, const struct rc_mlms_axis axis[2], const double *p, struct area a,
       struct rc_mlms_scratch *w)
{
    const struct rc_mlms_axis *ax = &axis[RC_X], *ay = &axis[RC_Y];
    size_t wide = rounded(rounded(a.nx, RC_SIMD_WIDTH) + 2 * ax->margin, RC_SIMD_WIDTH);
    size_t stride = m->plane_stride;
    size_t high = rounded(a.ny, RC_BLOCK) + 2 * ay->margin, n = wide << ax->halved;
    ptrdiff_t x0 = (a.x0 - (ptrdiff_t)ax->margin) * (ptrdiff_t)(1 + ax->halved);
    ptrdiff_t y0 = a.y0 - (ptrdiff_t)ay->margin;

    for (size_t y = 0; y < high; y++)
        for (size_t s = 0; s <= ay->halved; s++) {
            ptrdiff_t at = (y0 + (ptrdiff_t)y) * (ptrdiff_t)(1 + ay->halved) + (ptrdiff_t)s;
            double *even = w->plane[2 * s] + y * stride, *odd = w->plane[2 * s + 1] + y * stride;
            const double *row = w->mid;
            prefetch(p, axis, x0, at, n);
            if (x0 >= 0 && x0 + (ptrdiff_t)n <= (ptrdiff_t)ax->n && at >= 0 &&
                at < (ptrdiff_t)ay->n)
                row = p + at * (ptrdiff_t)ax->n + x0;
            else
                copy_row(p, axis, x0, at, n, w->mid);
            if (ax->halved)
                m->simd->deinterleave(row, n, even, odd);
            else
                memcpy(even, row, n * sizeof *even);
        }
}

/* Adds the corrections from the pressures of one class to the target classes of one parity in x, strip by
 * strip. Offsets of both signs of x share their coefficients; between classes that are delta = target -
 * source apart, offset k is place (k - delta)/2. */
static void
sum_class(const struct rc_mlms *m, const struct rc_mlms_axis axis[2],
          const struct rc_mlms_stencil *const targets[2], size_t tx, size_t source, struct area a,
          struct rc_mlms_scratch *w)
{
    const struct rc_mlms_axis *ax = &axis[RC_X];
    ptrdiff_t delta = (ptrdiff_t)tx - (ptrdiff_t)(source & 1);
    const struct rc_mlms_stencil *any = targets[0] != NULL ? targets[0] : targets[1];
    size_t wide = rounded(a.nx, RC_SIMD_WIDTH);
    struct rc_strip s = {.stride = m->plane_stride,
                         .margin = axis[RC_Y].margin,
                         .rows = a.ny,
                         .columns = any->columns,
                         .near = ax->halved && delta < 0,
                         .far = ax->halved && delta > 0 ? -1 : 0,
                         .sign = m->sign[RC_X],
                         .out_stride = m->out_stride,
                         .ring = w->ring};

    for (size_t x = 0; x < wide; x += RC_STRIP) {
        s.src = w->plane[source] + ax->margin + x;
        s.n = least(wide - x, RC_STRIP);
        for (size_t ty = 0; ty < 2; ty++) {
            s.column[ty] = targets[ty] != NULL ? targets[ty]->column : NULL;
            s.out[ty] = w->out[tx + 2 * ty] + x;
        }
        m->simd->stencil(&s);
    }
}

/* ---- the same where few nodes carry pressure ---- */

/* Lists the nodes of a halo with pressure, row and column in one number; with more than `most` the list is
 * incomplete. */
static size_t
list_loaded(const struct rc_mlms *m, const struct rc_mlms_axis axis[2], const double *p,
            struct area h, size_t most, struct rc_mlms_scratch *w)
{
    size_t n = 0, wide = rounded(h.nx, RC_SIMD_WIDTH);

    for (size_t y = 0; y < h.ny && n <= most; y++) {
        ptrdiff_t at = h.y0 + (ptrdiff_t)y;
        const double *row = w->mid;
        prefetch(p, axis, h.x0, at, wide);
        if (at < 0 || at >= (ptrdiff_t)axis[RC_Y].n)
            continue;
        if (h.x0 >= 0 && h.x0 + (ptrdiff_t)wide <= (ptrdiff_t)axis[RC_X].n)
            row = p + at * (ptrdiff_t)axis[RC_X].n + h.x0;
        else
            copy_row(p, axis, h.x0, at, wide, w->mid);
        n += m->simd->find_nonzero(row, wide, (uint32_t)y << 16, w->list + n);
    }
    return n;
}

/* The number of loaded nodes of a halo up to which single sources cost less than all nodes at once. Measured
 * at 1024 x 1024 with random nodes: both take the same time when 7, 8, 8 % are loaded for errors of 1e-4,
 * 1e-6, 1e-8. */
static size_t
few_nodes(struct area h)
{
    static const double break_even = 0.075;

    return h.nx > 0xffff || h.ny > 0xffff ? 0 : (size_t)(break_even * (double)(h.nx * h.ny));
}

/* Sorts the n listed nodes of a halo by class. Values go to w->plane[class]. Places follow after the list;
 * those of a class are from begin[class] to begin[class + 1] - 1. */
static void
sort_by_class(const struct rc_mlms_axis axis[2], const double *p, struct area h, size_t n,
              struct rc_mlms_scratch *w, size_t begin[5])
{
    const double *corner = p + h.y0 * (ptrdiff_t)axis[RC_X].n + h.x0;
    uint32_t *place = w->list + n;
    size_t hx = axis[RC_X].halved, hy = axis[RC_Y].halved, next[4];

    memset(begin, 0, 5 * sizeof *begin);
    for (size_t i = 0; i < n; i++)
        begin[1 + (w->list[i] & hx) + 2 * (w->list[i] >> 16 & hy)]++;
    for (size_t c = 0; c < 4; c++)
        next[c] = begin[c + 1] += begin[c];
    for (size_t i = n; i-- > 0;) {
        size_t x = w->list[i] & 0xffff, y = w->list[i] >> 16, c = (x & hx) + 2 * (y & hy);
        place[--next[c]] = (uint32_t)(y >> hy << 16 | x >> hx);
        w->plane[c][next[c] - begin[c]] = corner[y * axis[RC_X].n + x];
    }
}

/* Corrections of the targets first .. last of area a by the n listed nodes of its halo. */
static void
scatter(const struct rc_mlms *m, const struct rc_mlms_axis axis[2], const double *p,
        const struct rc_mlms_stencil targets[][4], size_t first, size_t last, struct area a,
        size_t n, struct rc_mlms_scratch *w)
{
    size_t begin[5];

    sort_by_class(axis, p, halo(axis, a), n, w, begin);
    for (size_t target = first; target <= last; target++)
        for (size_t c = 0; c < 4; c++) {
            const struct rc_mlms_stencil *s = &targets[target - first][c];
            struct rc_scatter all = {.value = w->plane[c],
                                     .place = w->list + n + begin[c],
                                     .n = begin[c + 1] - begin[c],
                                     .c = s->sparse,
                                     .width = s->width,
                                     .rows = s->rows,
                                     .left = s->first_x - (ptrdiff_t)axis[RC_X].margin,
                                     .top = s->first_y - (ptrdiff_t)axis[RC_Y].margin,
                                     .wide = a.nx,
                                     .high = a.ny,
                                     .out = w->out[target],
                                     .out_stride = m->out_stride};
            if (s->rows > 0)
                m->simd->scatter(&all);
        }
}

void
rc_mlms_correct(const struct rc_mlms *m, size_t level, const double *p, size_t tile,
                struct rc_mlms_scratch *w)
{
    const struct rc_mlms_level *l = &m->level[level], *next = l + 1;
    const struct rc_mlms_axis *ax = &l->axis[RC_X], *ay = &l->axis[RC_Y];
    struct area c = tile_area(next->axis, tile);
    size_t width = next->axis[RC_X].n;

    for (size_t y = 0; y < c.ny; y += ay->tile)
        for (size_t x = 0; x < c.nx; x += ax->tile) {
            size_t over_x = ax->halved * (m->d.t - 1), over_y = ay->halved * (m->d.t - 1);
            struct area a = {c.x0 + (ptrdiff_t)x - (ptrdiff_t)over_x,
                             c.y0 + (ptrdiff_t)y - (ptrdiff_t)over_y, least(ax->tile, c.nx - x),
                             least(ay->tile, c.ny - y)};
            double *u = next->u + ((size_t)c.y0 + y) * width + (size_t)c.x0 + x;
            struct area h = halo(l->axis, a);
            size_t n;

            if (!loaded(l, h) || (n = list_loaded(m, l->axis, p, h, few_nodes(h), w)) == 0)
                continue;
            for (size_t r = 0; r < a.ny; r++)
                memcpy(w->out[0] + r * m->out_stride, u + r * width, a.nx * sizeof *u);
            if (n <= few_nodes(h)) {
                scatter(m, l->axis, p, &l->coarse, 0, 0, a, n, w);
            } else {
                gather(m, l->axis, p, a, w);
                for (size_t s = 1; s < 4; s++) {
                    const struct rc_mlms_stencil *targets[2] = {&l->coarse[s], NULL};
                    if (l->coarse[s].columns > 0)
                        sum_class(m, l->axis, targets, 0, s, a, w);
                }
            }
            for (size_t r = 0; r < a.ny; r++)
                memcpy(u + r * width, w->out[0] + r * m->out_stride, a.nx * sizeof *u);
        }
}

/* ---- (15) ---- */

/* n odd nodes of a row from the coarse nodes about them; from[0] is t - 1 before the first. */
static void
between(const struct rc_mlms *m, const double *from, size_t step, size_t n,
        struct rc_mlms_scratch *w, double *out)
{
    for (size_t i = 0; i < m->d.t; i++) {
        w->near[i] = from + (m->d.t - 1 - i) * step;
        w->far[i] = from + (m->d.t + i) * step;
    }
    m->simd->weighted_sum(m->d.t, m->s, w->near, w->far, NULL, n, out);
}

/* Displacements of an area of places from the next level's, class by class. */
static void
interpolate(const struct rc_mlms *m, const struct rc_mlms_level *l, struct area a, size_t odd_nx,
            size_t odd_ny, struct rc_mlms_scratch *w)
{
    size_t hx = l->axis[RC_X].halved, hy = l->axis[RC_Y].halved, t = m->d.t;
    size_t width = (l + 1)->axis[RC_X].n, rows = hy ? a.ny + 2 * t - 1 : a.ny;
    const double *u = (l + 1)->u + (size_t)a.y0 * width + (size_t)a.x0;
    const double *even = u + hx * (t - 1); /* on the first place, hy (t - 1) rows above it */

    if (hy && odd_ny < a.ny)
        rows -= 1;
    for (size_t r = 0; r < a.ny; r++)
        memcpy(w->out[0] + r * m->out_stride, even + (r + hy * (t - 1)) * width, a.nx * sizeof *u);
    for (size_t r = 0; hx && r < rows; r++) {
        between(m, u + r * width, 1, odd_nx, w, w->mid + r * m->mid_stride);
        if (r >= hy * (t - 1) && r - hy * (t - 1) < a.ny)
            memcpy(w->out[1] + (r - hy * (t - 1)) * m->out_stride, w->mid + r * m->mid_stride,
                   odd_nx * sizeof *u);
    }
    for (size_t r = 0; hy && r < odd_ny; r++) {
        between(m, even + r * width, width, a.nx, w, w->out[2] + r * m->out_stride);
        if (hx)
            between(m, w->mid + r * m->mid_stride, m->mid_stride, odd_nx, w,
                    w->out[3] + r * m->out_stride);
    }
}

static void
add_corrections(const struct rc_mlms *m, const struct rc_mlms_level *l, const double *p,
                struct area a, struct rc_mlms_scratch *w)
{
    struct area h = halo(l->axis, a);
    size_t n;

    if (!loaded(l, h))
        return;
    n = list_loaded(m, l->axis, p, h, few_nodes(h), w);
    if (n <= few_nodes(h)) {
        scatter(m, l->axis, p, &l->fine[1], 1, 3, a, n, w);
        return;
    }
    gather(m, l->axis, p, a, w);
    for (size_t source = 0; source < 4; source++)
        for (size_t tx = 0; tx <= l->axis[RC_X].halved; tx++) {
            const struct rc_mlms_stencil *targets[2] = {NULL, NULL};
            for (size_t ty = 0; ty <= l->axis[RC_Y].halved; ty++)
                if (l->fine[tx + 2 * ty][source].columns > 0)
                    targets[ty] = &l->fine[tx + 2 * ty][source];
            if (targets[0] != NULL || targets[1] != NULL)
                sum_class(m, l->axis, targets, tx, source, a, w);
        }
}

void
rc_mlms_expand(const struct rc_mlms *m, size_t level, const double *p, double *u, size_t tile,
               struct rc_mlms_scratch *w)
{
    const struct rc_mlms_level *l = &m->level[level];
    const struct rc_mlms_axis *ax = &l->axis[RC_X], *ay = &l->axis[RC_Y];
    size_t hx = ax->halved, hy = ay->halved;
    struct area t = tile_area(l->axis, tile);
    struct area a = {t.x0 >> hx, t.y0 >> hy, (t.nx + hx) >> hx, (t.ny + hy) >> hy};
    double *row = u + (size_t)t.y0 * ax->n + (size_t)t.x0;

    interpolate(m, l, a, t.nx >> hx, t.ny >> hy, w);
    add_corrections(m, l, p, a, w);
    for (size_t y = 0; y < t.ny; y++, row += ax->n) {
        size_t s = hy ? y % 2 * 2 : 0, r = (y >> hy) * m->out_stride;
        if (hx)
            m->simd->interleave(w->out[s] + r, w->out[s + 1] + r, t.nx, row);
        else
            memcpy(row, w->out[s] + r, t.nx * sizeof *row);
    }
}
