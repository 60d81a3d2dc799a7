/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Weights of the interpolation and coefficients of the corrections.
 */
#include "mlms.h"

#include <math.h>
#include <stdlib.h>

void
rc_mlms_weights(size_t t, double *s)
{
    for (size_t i = 0; i < t; i++) {
        long double product = 1, at = (long double)(t - i); /* the sum must be 1 to rounding */
        for (size_t k = 1; k <= 2 * t; k++)
            if (k != t - i)
                product *= (2 * ((long double)t - k) + 1) / (2 * (at - k));
        s[i] = (double)product;
    }
}

/* Samples at offsets k < nx, l < ny; those at negative offsets follow by sign. */
struct table {
    size_t nx, ny;
    double *v;
};

/* v NULL: memory is short. */
static struct table
table_new(struct rc_store *own, size_t nx, size_t ny)
{
    return (struct table){nx, ny, rc_store_zeros(own, nx * ny, sizeof(double))};
}

static double
at(const struct table *t, const double sign[2], ptrdiff_t k, ptrdiff_t l)
{
    double factor = (k < 0 ? sign[RC_X] : 1) * (l < 0 ? sign[RC_Y] : 1);

    return factor * t->v[(size_t)labs(l) * t->nx + (size_t)labs(k)];
}

/* Interpolates `from` in one direction, at every offset where it is known. */
static void
interpolate(const struct rc_mlms *m, int direction, const struct table *from, struct table *to)
{
    for (size_t l = 0; l < to->ny; l++)
        for (size_t k = 0; k < to->nx; k++) {
            double sum = 0;
            for (size_t i = 0; i < m->d.t; i++) {
                ptrdiff_t d = 2 * (ptrdiff_t)i + 1, x = direction == RC_X ? d : 0,
                          y = direction == RC_Y ? d : 0;
                sum += m->s[i] * (at(from, m->sign, (ptrdiff_t)k - x, (ptrdiff_t)l - y) +
                                  at(from, m->sign, (ptrdiff_t)k + x, (ptrdiff_t)l + y));
            }
            to->v[l * to->nx + k] = sum;
        }
}

/* Number of offsets of either sign with these |k| and |l|. */
static double
images(size_t k, size_t l)
{
    return (k > 0 ? 2.0 : 1.0) * (l > 0 ? 2.0 : 1.0);
}

static struct rc_lattice
lattice(const struct rc_sum *sum, const struct rc_mlms_axis axis[2])
{
    return (struct rc_lattice){sum->shape.dx, sum->shape.dy, axis[RC_X].step, axis[RC_Y].step};
}

/* error[c]: the kernel less its interpolation in the directions of class c = x + 2 y; equations (13) and
 * (16). Offsets reach to `reach` plus `beyond`. *about: sum of |K| over the offsets up to the reach, without
 * the node itself. */
static bool
errors(const struct rc_mlms *m, const struct rc_sum *sum, const struct rc_mlms_axis axis[2],
       size_t beyond, struct rc_store *own, struct table error[4], double *about)
{
    const struct rc_lattice nodes = lattice(sum, axis);
    RC_ENDS(rc_store_free) struct rc_store passing = {0};
    size_t reach[2], more[2];
    struct table k, kx;

    for (int a = 0; a < 2; a++) {
        reach[a] = axis[a].reach + beyond + 1;
        more[a] = axis[a].halved ? 2 * m->d.t - 1 : 0;
    }
    k = table_new(&passing, reach[RC_X] + more[RC_X], reach[RC_Y] + more[RC_Y]);
    kx = table_new(&passing, reach[RC_X], k.ny);
    if (passing.failed)
        return false;
    sum->kernel.rows(sum->kernel.of, &nodes, k.nx, 0, k.ny, k.v);
    *about = 0;
    for (size_t l = 0; l <= axis[RC_Y].reach; l++)
        for (size_t i = l == 0; i <= axis[RC_X].reach; i++)
            *about += images(i, l) * fabs(k.v[l * k.nx + i]);
    for (size_t c = 1; c < 4; c++) {
        size_t x = c & 1, y = c >> 1;
        if (x > axis[RC_X].halved || y > axis[RC_Y].halved)
            continue;
        error[c] = table_new(own, reach[RC_X], reach[RC_Y]);
        if (own->failed)
            return false;
        if (x)
            interpolate(m, RC_X, &k, y ? &kx : &error[c]);
        if (y)
            interpolate(m, RC_Y, x ? &kx : &k, &error[c]);
        for (size_t l = 0; l < reach[RC_Y]; l++)
            for (size_t i = 0; i < reach[RC_X]; i++) {
                double *e = &error[c].v[l * reach[RC_X] + i];
                *e = k.v[l * k.nx + i] - *e;
            }
    }
    return true;
}

/* ---- neglected coefficients ---- */

/* Largest |K| of the cells that the nodes next to a node of this level represent. At the node itself the
 * kernel is that of a single cell. Half a step away it is about that of all step_x step_y cells between. */
static double
local_kernel(const struct rc_sum *sum, const struct rc_mlms_axis axis[2])
{
    struct rc_lattice half = lattice(sum, axis);
    double k[2], own, between = 0, cells = (double)half.sx * (double)half.sy;
    size_t n = sum->shape.nx > 1 ? 2 : 1;

    half.sx = half.sx > 1 ? half.sx / 2 : 1;
    half.sy = half.sy > 1 ? half.sy / 2 : 1;
    sum->kernel.rows(sum->kernel.of, &half, n, 0, 1, k);
    own = fabs(k[0]);
    between = n > 1 ? fabs(k[1]) : 0;
    if (sum->shape.ny > 1) {
        sum->kernel.rows(sum->kernel.of, &half, n, 1, 2, k);
        between = fmax(between, fmax(fabs(k[0]), n > 1 ? fabs(k[1]) : 0));
    }
    return cells > 1 ? fmax(own / cells, 1.76 * between) : fmax(own, between);
}

/* The neglected coefficients of a level: see rc_mlms_left_out. */
static void
left_out(const struct rc_mlms *m, const struct rc_sum *sum, const struct rc_mlms_axis axis[2],
         double *one, double *all)
{
    enum {
        BEYOND = 4 /* coefficients decrease fast with distance */
    };
    RC_ENDS(rc_store_free) struct rc_store own = {0};
    struct table e[4] = {{0}};
    double largest = 0, most_of_all = 0, local = local_kernel(sum, axis), about = 0;
    size_t most[2];

    for (int a = 0; a < 2; a++)
        most[a] = axis[a].n - 1 + (axis[a].halved ? 2 * m->d.t : 0);
    if (!errors(m, sum, axis, BEYOND, &own, e, &about))
        largest = INFINITY;
    for (size_t c = 1; c < 4; c++) {
        double together = 0;
        for (size_t k = 0; e[c].v != NULL && k < e[c].nx && k <= most[RC_X]; k++) {
            ptrdiff_t in = rc_mlms_extent(&m->d, &sum->shape, axis, k, false);
            ptrdiff_t odd = rc_mlms_extent(&m->d, &sum->shape, axis, k, c == 3 && k % 2 != 0);
            for (size_t l = (size_t)(in + 1); l < e[c].ny && l <= most[RC_Y]; l++)
                if (l % 2 == 0 || (ptrdiff_t)l > odd) {
                    double value = fabs(e[c].v[l * e[c].nx + k]);
                    largest = fmax(largest, value);
                    together += images(k, l) * value;
                }
        }
        most_of_all = fmax(most_of_all, together);
    }
    *one = fmax(*one, largest / local);
    *all = fmax(*all, most_of_all / (local + about));
}

void
rc_mlms_left_out(const struct rc_sum *sum, const struct rc_mlms_design *d, double *one, double *all)
{
    struct rc_mlms m = {.d = *d};
    unsigned parity = sum->kernel.parity;

    *one = *all = 0;
    m.sign[RC_X] = parity & RC_ODD_X ? -1 : 1;
    m.sign[RC_Y] = parity & RC_ODD_Y ? -1 : 1;
    rc_mlms_weights(d->t, m.s);
    for (size_t q = 0; q < d->levels; q++)
        left_out(&m, sum, d->axis[q], one, all);
}

/* ---- tables ---- */

static ptrdiff_t
floor_half(ptrdiff_t v)
{
    return v >= 0 ? v / 2 : -((1 - v) / 2);
}

/* Range of places from source to target class whose offset is at most l and of the right parity. */
static void
places(const struct rc_mlms_axis *a, ptrdiff_t delta, ptrdiff_t l, ptrdiff_t *first,
       ptrdiff_t *last)
{
    *first = a->halved ? -floor_half(l + delta) : -l;
    *last = a->halved ? floor_half(l - delta) : l;
}

/* Rows of all offsets, for single sources. */
static bool
unfold(struct rc_mlms_stencil *s, struct rc_mlms *m, const struct rc_mlms_axis axis[2],
       const struct rc_shape *shape, const struct table *e, const ptrdiff_t delta[2])
{
    ptrdiff_t last_x, last_y, hx = (ptrdiff_t)axis[RC_X].halved, hy = (ptrdiff_t)axis[RC_Y].halved;

    places(&axis[RC_X], delta[RC_X], (ptrdiff_t)axis[RC_X].reach, &s->first_x, &last_x);
    places(&axis[RC_Y], delta[RC_Y], (ptrdiff_t)axis[RC_Y].reach, &s->first_y, &last_y);
    if (last_x < s->first_x || last_y < s->first_y)
        return true;
    s->width = ((size_t)(last_x - s->first_x) + RC_SIMD_WIDTH) / RC_SIMD_WIDTH * RC_SIMD_WIDTH;
    s->rows = (size_t)(last_y - s->first_y) + 1;
    s->sparse = rc_store_zeros(&m->own, s->width * s->rows, sizeof *s->sparse);
    if (s->sparse == NULL)
        return false;
    for (ptrdiff_t x = s->first_x; x <= last_x; x++)
        for (ptrdiff_t y = s->first_y; y <= last_y; y++) {
            ptrdiff_t k = (hx ? 2 * x : x) + delta[RC_X], l = (hy ? 2 * y : y) + delta[RC_Y];
            if (labs(l) <= rc_mlms_extent(&m->d, shape, axis, (size_t)labs(k),
                                          delta[RC_X] != 0 && delta[RC_Y] != 0))
                s->sparse[(size_t)(y - s->first_y) * s->width + (size_t)(x - s->first_x)] =
                    at(e, m->sign, k, l);
        }
    return true;
}

/* Goes from class source to class target with the table of errors e. */
static bool
stencil(struct rc_mlms_stencil *s, struct rc_mlms *m, const struct rc_mlms_axis axis[2],
        const struct rc_shape *shape, size_t target, size_t source, const struct table *e)
{
    const struct rc_mlms_axis *x = &axis[RC_X], *y = &axis[RC_Y];
    ptrdiff_t delta[2] = {(ptrdiff_t)(target & 1) - (ptrdiff_t)(source & 1),
                          (ptrdiff_t)(target >> 1) - (ptrdiff_t)(source >> 1)};
    size_t first = x->halved ? (size_t)labs(delta[RC_X]) : 0, by = 1 + x->halved;
    size_t length = 2 * y->margin + 3 + 2 * RC_BLOCK;
    double *values;

    s->columns = x->reach >= first ? (x->reach - first) / by + 1 : 0;
    if (s->columns == 0)
        return true;
    s->column = rc_store_zeros(&m->own, s->columns, sizeof *s->column);
    values = rc_store_zeros(&m->own, s->columns * length, sizeof *values);
    if (m->own.failed)
        return false;
    for (size_t j = 0; j < s->columns; j++) {
        size_t k = first + j * by;
        double *c = values + j * length + y->margin + 1 + RC_BLOCK;
        struct rc_column *column = &s->column[j];
        places(y, delta[RC_Y],
               rc_mlms_extent(&m->d, shape, axis, k, delta[RC_X] != 0 && delta[RC_Y] != 0),
               &column->first, &column->last);
        column->c = c;
        for (ptrdiff_t v = column->first; v <= column->last; v++)
            c[v] = at(e, m->sign, (ptrdiff_t)k, v * (y->halved ? 2 : 1) + delta[RC_Y]);
    }
    return unfold(s, m, axis, shape, e, delta);
}

bool
rc_mlms_stencils(struct rc_mlms *m, const struct rc_sum *sum, size_t level)
{
    struct rc_mlms_level *l = &m->level[level];
    RC_ENDS(rc_store_free) struct rc_store own = {0};
    struct table e[4] = {{0}};
    size_t classes[2] = {l->axis[RC_X].halved, l->axis[RC_Y].halved};
    double about;
    bool done = errors(m, sum, l->axis, 0, &own, e, &about);

    for (size_t c = 1; done && c < 4; c++) {
        if (e[c].v == NULL)
            continue;
        done = stencil(&l->coarse[c], m, l->axis, &sum->shape, 0, c, &e[c]);
        for (size_t s = 0; done && s < 4; s++)
            if ((s & 1) <= classes[RC_X] && s >> 1 <= classes[RC_Y])
                done = stencil(&l->fine[c][s], m, l->axis, &sum->shape, c, s, &e[c]);
    }
    return done;
}
