/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Semismooth Newton on the faces of the discs. Each set of faces gets one step of preconditioned conjugate
 * gradients: the sets change too fast for a second step to pay. 1. delta is the mean of Tq - w over the nodes
 * with |q| < g. Without such a node, delta comes from a projected gradient step. 2. A node inside its circle
 * sticks: both components are free. A node on its circle slips: only its tangent is free. If its slip points
 * inwards it sticks again, unless the residuals of its neighbours would push it out. A shortened step leaves
 * slipping nodes on chords, inside the circle: they keep slipping while their residual points outwards. 3.
 * Newton's method needs the curvature of the circle: D = |s|/g along the tangents of slipping nodes. 4. z = M
 * r (extension.h), shifted to zero load. The step is d = z + beta times the last step (Hestenes and Stiefel).
 * 5. Slipping nodes return radially to their circles. The sticking nodes of each tile of 16 x 16 take the
 * nearest tractions on the discs that carry the load of the tile. One shift carries the rest. 6. The length
 * minimises Newton's energy on the faces; it is at most 1, and at most 1.9 times the length that lowers the
 * energy most. If the energy does not fall, a projected gradient step follows, which lowers it. If rounding
 * hides the change of the energy, the length is Newton's alone. M applied to the residual also gives the
 * estimate of the error, together with three parts that M does not contain. The first is the load of nodes
 * inside their circles. The second is the load of turns. Near sliding all tangents are nearly parallel, so
 * that only large turns carry a small load along the force. The third are nodes on their circles that would
 * stick under another delta.
 */
#include "discs.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

enum {
    OFF = RC_FACE_OFF,
    STICK = RC_FACE_STICK,
    SLIP = RC_FACE_SLIP,
    INWARDS, /* on its circle, slips inwards: whether it sticks is not yet decided */
};
enum {
    SUMS = 7,
    MOSTS = 2, /* largest numbers, behind the sums */
    TILE = 16
};
/* Factor of the estimate. Half takes 3 % fewer convolutions, and 7 estimates are below the error;
 * double takes 3 % more (52 runs of bench/constants.py). */
static const double safety = 1.3;
/* Factor of the estimate before the faces are final. Not sensitive: half and double change the estimate
 * by at most 1 % (52 runs of bench/constants.py). */
static const double early = 20;
/* Relative: rounding of a radius. Half and double change no bit (52 runs of bench/constants.py). */
static const double on_circle = 1e-12;
/* If a larger part of a step is clipped, the next step is not conjugate. Not sensitive: half and double
 * change the convolutions by less than 1 % (52 runs of bench/constants.py). */
static const double clipped = 0.1;
/* Part of a step: after a shorter one nodes are not sifted, see way.sift. Not sensitive: half and
 * double change no convolution (52 runs of bench/constants.py). */
static const double short_step = 0.1;

/* ---- sums over nodes ---- */

typedef void of_node(const struct rc_discs *d, size_t k, const void *with, double *sum);

struct row {
    const struct rc_discs *d;
    of_node *of;
    const void *with;
};

static void
sum_row(void *ctx, size_t j, double *sum)
{
    const struct row *r = ctx;

    for (size_t k = j * r->d->nx; k < (j + 1) * r->d->nx; k++)
        if (r->d->face[k] != OFF)
            r->of(r->d, k, r->with, sum);
}

/* Computes the first `count` sums over the nodes that carry a load, and after them the largest values. */
static void
sum_nodes(const struct rc_discs *d, of_node *of, const void *with, size_t count, double *out)
{
    struct row row = {d, of, with};
    double all[SUMS + MOSTS];

    rc_sums_rows(&d->rows, sum_row, &row, all);
    memcpy(out, all, count * sizeof *out);
}

/* Removes from v the components that are not free at a node. */
static inline void
free_part(const unsigned char *face, double *const *q, size_t k, double v[2])
{
    rc_free_part(face[k], q[0][k], q[1][k], &v[0], &v[1]);
}

static inline double
slip_of(const struct rc_discs *d, int c, size_t k)
{
    return d->u[c][k] - d->w[c][k] - d->delta[c];
}

/* Solves m x = v for a symmetric 2 x 2 matrix (xx, yy, xy). If m is singular, solves on its range. */
static void
solve(const double m[3], const double v[2], double x[2])
{
    double trace = m[0] + m[1], det = m[0] * m[1] - m[2] * m[2];

    if (!(trace > 0)) {
        x[0] = x[1] = 0;
    } else if (det > 1e-14 * trace * trace) {
        x[0] = (m[1] * v[0] - m[2] * v[1]) / det;
        x[1] = (m[0] * v[1] - m[2] * v[0]) / det;
    } else { /* rank 1: the inverse of m on its range is m over the square of its trace */
        x[0] = (m[0] * v[0] + m[2] * v[1]) / (trace * trace);
        x[1] = (m[2] * v[0] + m[1] * v[1]) / (trace * trace);
    }
}

/* ---- the load ---- */

/* The nodes that a shift moves, and their starting points. */
enum who {
    ALL,
    STICKING,
    ON_FACES /* all nodes; slipping nodes stay on their circles */
};
struct moved {
    double *const *y;
    enum who who;
    const size_t *tile; /* first column and row, and the column and row after the last; NULL: the
                           map */
    double nu[2];
};

/* Sums for a shift of y by nu. 0, 1: the traction of a node. 2 to 4: xx yy xy of its derivative. 5: the
 * function whose gradient is sums 0 and 1. */
static void
carried_by(const struct rc_discs *d, size_t k, const void *with, double *sum)
{
    const struct moved *m = with;
    double x = m->y[0][k] + m->nu[0], y = m->y[1][k] + m->nu[1], r = sqrt(x * x + y * y);
    double g = d->g[k], e;
    bool circle = m->who == ON_FACES && d->face[k] == SLIP && r > 0;

    if (m->who == STICKING && d->face[k] != STICK)
        return;
    if (r <= g && !circle) {
        sum[0] += x;
        sum[1] += y;
        sum[2]++;
        sum[3]++;
        sum[5] += r * r / 2;
        return;
    }
    e = g / r;
    sum[0] += e * x;
    sum[1] += e * y;
    sum[2] += e * y * y / (r * r);
    sum[3] += e * x * x / (r * r);
    sum[4] -= e * x * y / (r * r);
    sum[5] += circle ? g * r : g * (r - g / 2);
}

static void
carried(const struct rc_discs *d, const struct moved *m, double out[SUMS])
{
    if (m->tile == NULL) {
        sum_nodes(d, carried_by, m, 6, out);
        return;
    }
    memset(out, 0, SUMS * sizeof *out);
    for (size_t j = m->tile[2]; j < m->tile[3]; j++)
        for (size_t k = j * d->nx + m->tile[0]; k < j * d->nx + m->tile[1]; k++)
            if (d->face[k] == STICK)
                carried_by(d, k, m, out);
}

/* Finds nu such that the tractions on the discs nearest to y + nu carry `load` within `near`, summed over the
 * moved nodes. nu minimises a convex function, which Newton's method finds. It is damped after Levenberg and
 * Marquardt, because parallel tractions on their circles make the matrix singular. `size`: the largest force
 * that friction can carry on these nodes. Returns false if the nodes cannot carry the load. */
static bool
find_shift(const struct rc_discs *d, struct moved *m, const double load[2], double size,
           double near)
{
    /* Damping of Newton's method for a node: at the start, and where only rounding is left. Not
     * sensitive: half and double change no convolution (52 runs of bench/constants.py). */
    static const double first = 1e-6, least = 1e-14;
    double at[SUMS], damping = first * (double)d->all;

    m->nu[0] = m->nu[1] = 0;
    carried(d, m, at);
    for (int step = 0; step < 200; step++) {
        double f[2] = {load[0] - at[0], load[1] - at[1]}, off = hypot(f[0], f[1]);
        double damped[3] = {at[2] + damping, at[3] + damping, at[4]}, move[2], there[SUMS];
        double value = at[5] - load[0] * m->nu[0] - load[1] * m->nu[1], next;

        if (off <= near)
            return true;
        solve(damped, f, move);
        m->nu[0] += move[0];
        m->nu[1] += move[1];
        carried(d, m, there);
        next = there[5] - load[0] * m->nu[0] - load[1] * m->nu[1];
        if (!(next <= value - 1e-4 * (move[0] * f[0] + move[1] * f[1]) + 1e-13 * fabs(value))) {
            m->nu[0] -= move[0];
            m->nu[1] -= move[1];
            damping *= 10;
            continue;
        }
        if (off <= 1e-12 * size && hypot(load[0] - there[0], load[1] - there[1]) >= off)
            return true; /* the rest is rounding */
        damping = fmax(damping / 10, least * (double)d->all);
        memcpy(at, there, sizeof at);
    }
    return hypot(load[0] - at[0], load[1] - at[1]) <= 1e-9 * size;
}

/* Moves a node, and projects it on its disc. */
static inline void
move_node(const unsigned char *face, const double *g, const struct moved *m, size_t k)
{
    if (face[k] == OFF || (m->who == STICKING && face[k] != STICK))
        return;
    m->y[0][k] += m->nu[0];
    m->y[1][k] += m->nu[1];
    rc_onto_disc(g[k], m->who == ON_FACES && face[k] == SLIP, &m->y[0][k], &m->y[1][k]);
}

static void
move_all(const struct rc_discs *d, const struct moved *m)
{
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++)
        move_node(d->face, d->g, m, k);
}

/* Finds the shift nu that carries the load of the map to rounding. */
static bool
carry(const struct rc_discs *d, struct moved *m, const double load[2])
{
    return find_shift(d, m, load, d->limit, 4 * DBL_EPSILON * d->limit);
}

/* Projects y on the discs and, if a load is given, on the load. */
static void
project(const struct rc_discs *d, double *const y[2])
{
    struct moved m = {.y = y, .who = ALL};

    if (!d->asked.given)
        carry(d, &m, d->asked.sum);
    move_all(d, &m);
}

/* Moves the sticking nodes of a tile to the nearest tractions on the discs with the same sum as in y. */
static void
keep_tile(const struct rc_discs *d, double *const y[2], const size_t tile[4])
{
    struct moved m = {.y = y, .who = STICKING, .tile = tile};
    double load[2] = {0, 0}, size = 0;
    bool outside = false;

    for (size_t j = tile[2]; j < tile[3]; j++)
        for (size_t k = j * d->nx + tile[0]; k < j * d->nx + tile[1]; k++)
            if (d->face[k] == STICK) {
                load[0] += y[0][k];
                load[1] += y[1][k];
                size += d->g[k];
                outside = outside || hypot(y[0][k], y[1][k]) > d->g[k];
            }
    if (!outside)
        return;
    if (!(hypot(load[0], load[1]) < size && find_shift(d, &m, load, size, 1e-6 * size)))
        m.nu[0] = m.nu[1] = 0;
    for (size_t j = tile[2]; j < tile[3]; j++)
        for (size_t k = j * d->nx + tile[0]; k < j * d->nx + tile[1]; k++)
            move_node(d->face, d->g, &m, k);
}

static void
rest_of(const struct rc_discs *d, size_t k, const void *with, double *sum)
{
    double *const *y = with;

    if (d->face[k] == STICK) {
        sum[2] += d->g[k];
        return;
    }
    sum[0] += y[0][k];
    sum[1] += y[1][k];
}

/* Tiles have 16 x 16 nodes, and are nearly square in metres. Their rows are a power of two, so that tiles end
 * where ranks do. */
static size_t
tile_rows(const struct rc_tangential *t)
{
    const double part = fmin(fmax(TILE / sqrt(t->shape.dy / t->shape.dx), 1), TILE * TILE);

    return (size_t)exp2(round(log2(floor(part))));
}

/* Moves the end y of a step back to the discs. */
static void
back(const struct rc_discs *d, double *const y[2])
{
    double slips[3], rest[2];
    const size_t high = tile_rows(d->t), wide = TILE * TILE / high;
    size_t across = (d->nx + wide - 1) / wide, down = (d->ny + high - 1) / high;
    struct moved m = {.y = y, .who = STICKING};

#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++)
        if (d->face[k] == SLIP)
            rc_onto_disc(d->g[k], true, &y[0][k], &y[1][k]);
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t t = 0; t < across * down; t++) {
        size_t i = t % across * wide, j = t / across * high;
        size_t tile[4] = {i, i + wide < d->nx ? i + wide : d->nx, j,
                          j + high < d->ny ? j + high : d->ny};
        keep_tile(d, y, tile);
    }
    if (d->asked.given)
        return;
    sum_nodes(d, rest_of, y, 3, slips);
    rest[0] = d->asked.sum[0] - slips[0];
    rest[1] = d->asked.sum[1] - slips[1];
    if (!(hypot(rest[0], rest[1]) < slips[2] && carry(d, &m, rest))) {
        m.who = ON_FACES;
        if (!carry(d, &m, d->asked.sum)) {
            m.who = ALL;
            carry(d, &m, d->asked.sum);
        }
    }
    move_all(d, &m);
}

/* ---- faces ---- */

/* True if a shortened step has left the node on a chord. */
static inline bool
on_chord(const unsigned char *face, const double *g, size_t k, double size)
{
    return face[k] == SLIP && size > g[k] / 2;
}

static void
inside(const struct rc_discs *d, size_t k, const void *with, double *sum)
{
    double size = hypot(d->q[0][k], d->q[1][k]);
    bool in = size < d->g[k] * (1 - on_circle) && !on_chord(d->face, d->g, k, size);

    (void)with;
    for (int c = 0; c < 2; c++)
        sum[c] += in ? d->u[c][k] - d->w[c][k] : 0;
    sum[2] += in;
}

/* The inward component of the slip of a node. */
static inline double
inwards(const struct rc_discs *d, size_t k)
{
    double x = d->q[0][k], y = d->q[1][k], size = hypot(x, y);

    return size > 0 ? (slip_of(d, 0, k) * x + slip_of(d, 1, k) * y) / size : 0;
}

static void
find_delta(struct rc_discs *d)
{
    struct moved m = {.y = d->way.d, .who = ALL};
    double at[3];

    d->judged.measured = d->asked.given;
    if (d->asked.given)
        return;
    sum_nodes(d, inside, NULL, 3, at);
    d->judged.measured = at[2] > 0;
    if (d->judged.measured) {
        d->delta[0] = at[0] / at[2];
        d->delta[1] = at[1] / at[2];
        return;
    }
    d->way.part = 0; /* the map of the step holds the shifts here */
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++)
        for (int c = 0; c < 2; c++)
            d->way.d[c][k] = d->q[c][k] - (d->u[c][k] - d->w[c][k]) / d->m->self;
    carry(d, &m, d->asked.sum);
    d->delta[0] = m.nu[0] * d->m->self;
    d->delta[1] = m.nu[1] * d->m->self;
}

static void
first_look(struct rc_discs *d, size_t k)
{
    double g = d->g[k], size = hypot(d->q[0][k], d->q[1][k]), in = inwards(d, k);
    bool circle = size >= g * (1 - on_circle) ||
                  (on_chord(d->face, d->g, k, size) && size - in / d->m->self >= g);

    d->face[k] = !circle ? STICK : in > 0 ? INWARDS : SLIP;
}

/* The neighbour of node i of n nodes. Returns n if there is none. */
static inline size_t
beside(size_t i, int step, size_t n, bool round)
{
    if (step < 0)
        return i > 0 ? i - 1 : round && n > 1 ? n - 1 : n;
    if (step > 0)
        return i + 1 < n ? i + 1 : round && n > 1 ? 0 : n;
    return i;
}

enum {
    BESIDE = 3 /* numbers of a node: its slip, and whether it sticks or wants to */
};

static bool
wants_to_stick(const struct rc_discs *d, size_t k)
{
    return d->face[k] == STICK || d->face[k] == INWARDS;
}

/* Fetches the rows beside those held here. */
static void
fetch_beside(struct rc_discs *d)
{
    const size_t each = BESIDE * d->nx, ends[2] = {0, d->ny - 1};
    double *v = d->beside;
    bool has[2];

    if (d->t->rows.ranks == NULL)
        return;
    for (size_t end = 0; end < 2 && d->ny > 0; end++)
        for (size_t i = 0; i < d->nx; i++) {
            const size_t k = ends[end] * d->nx + i;
            double *to = v + end * each + BESIDE * i;
            for (int c = 0; c < 2; c++)
                to[c] = slip_of(d, c, k);
            to[2] = wants_to_stick(d, k);
        }
    rc_ranks_beside(&d->t->rows, d->t->boundary.y, each * sizeof *v, v, v + each, v + 2 * each,
                    v + 3 * each, has);
}

/* A node in column x of row y of the map: its slip; false: it does not want to stick. */
static bool
sticking_at(const struct rc_discs *d, size_t x, size_t y, double slip[2])
{
    const struct rc_rows *rows = &d->t->rows;
    const double *v;
    size_t k;

    if (y >= rows->first && y < rows->first + rows->n) {
        k = (y - rows->first) * d->nx + x;
        if (!wants_to_stick(d, k))
            return false;
        slip[0] = slip_of(d, 0, k);
        slip[1] = slip_of(d, 1, k);
        return true;
    }
    v = d->beside + BESIDE * ((y == (rows->first + rows->n) % rows->ny ? 3 : 2) * d->nx + x);
    memcpy(slip, v, 2 * sizeof *slip);
    return v[2] > 0;
}

/* True if the residuals of its neighbours would push a sticking node out of its disc again. */
static bool
is_pushed_out(const struct rc_discs *d, size_t i, size_t j)
{
    const struct rc_boundary round = d->t->boundary;
    const size_t k = j * d->nx + i, row = d->t->rows.first + j, ny = d->t->rows.ny;
    double sum = 0, own[2] = {-slip_of(d, 0, k), -slip_of(d, 1, k)}, slip[2];

    for (int b = -1; b <= 1; b++)
        for (int a = -1; a <= 1; a++) {
            size_t x = beside(i, a, d->nx, round.x), y = beside(row, b, ny, round.y);
            double r = hypot(a * d->t->shape.dx, b * d->t->shape.dy);
            if ((a == 0 && b == 0) || x == d->nx || y == ny)
                continue;
            if (sticking_at(d, x, y, slip))
                sum += (d->q[0][k] * (own[0] + slip[0]) + d->q[1][k] * (own[1] + slip[1])) /
                       (r * r * r);
        }
    return sum > 0;
}

static void
last_look(const struct rc_discs *d, size_t k, const void *with, double *sum)
{
    double slip[2] = {slip_of(d, 0, k), slip_of(d, 1, k)}, size = hypot(slip[0], slip[1]);

    (void)with;
    sum[SUMS + 1] = fmax(sum[SUMS + 1], size);
    if (d->face[k] == INWARDS) {
        d->face[k] = d->curve[k] < 0 ? SLIP : STICK;
        sum[2] += d->face[k] == SLIP;
    }
    sum[d->face[k] == STICK ? 0 : 1]++;
    d->curve[k] = d->face[k] == SLIP ? (float)(fmax(-inwards(d, k), 0) / d->g[k]) : 0;
    free_part(d->face, d->q, k, slip);
    for (int c = 0; c < 2; c++)
        d->r[c][k] = (float)-slip[c];
    sum[SUMS] = fmax(sum[SUMS], hypot(slip[0], slip[1]));
}

/* Finds faces, D and the residual along free directions. Returns the number of nodes that slip inwards
 * and stay on their circles. */
static size_t
find_faces(struct rc_discs *d, bool sift)
{
    double at[SUMS + MOSTS];

#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++) {
        d->curve[k] = d->r[0][k] = d->r[1][k] = 0;
        if (d->face[k] != OFF)
            first_look(d, k);
    }
    if (sift)
        fetch_beside(d);
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t j = 0; j < d->ny; j++)
        for (size_t i = 0; i < d->nx && sift; i++)
            if (d->face[j * d->nx + i] == INWARDS && is_pushed_out(d, i, j))
                d->curve[j * d->nx + i] = -1;
    sum_nodes(d, last_look, NULL, SUMS + MOSTS, at);
    d->found.stick = (size_t)at[0];
    d->found.slipping = (size_t)at[1];
    d->found.residual = at[SUMS];
    d->found.slip = at[SUMS + 1];
    return (size_t)at[2];
}

/* ---- the residual ---- */

static void
load_of(const struct rc_discs *d, size_t k, const void *with, double *sum)
{
    float *const *v = with;

    sum[0] += (double)v[0][k];
    sum[1] += (double)v[1][k];
    for (int c = 0; c < 3; c++)
        sum[2 + c] += (double)d->m->n[c][k];
}

static inline void
shift_of(const struct rc_extension *m, size_t k, const double mu[2], double v[2])
{
    double n[3] = {(double)m->n[0][k], (double)m->n[1][k], (double)m->n[2][k]};

    v[0] = n[0] * mu[0] + n[2] * mu[1];
    v[1] = n[2] * mu[0] + n[1] * mu[1];
}

/* The distance of a slipping node to its circle, from inside. */
static inline double
short_of_circle(const unsigned char *face, const double *g, size_t k, double size)
{
    return face[k] == SLIP ? fmax(g[k] - size, 0) : 0;
}

/* Computes the sums that M does not contain. 0, 1: the load that slipping nodes gain on the way to their
 * circles. 2, 3: the load that they lose by turning by z, to second order. 4, 5: the residual, for the
 * motion. */
static void
left_by_model(const struct rc_discs *d, size_t k, const void *with, double *sum)
{
    double x = d->q[0][k], y = d->q[1][k], size = hypot(x, y), part, turn[2] = {0, 0}, residual[2];
    double r[2] = {(double)d->r[0][k], (double)d->r[1][k]};

    (void)with;
    if (d->face[k] == SLIP && size > 0) {
        double z[2] = {(double)d->z[0][k], (double)d->z[1][k]};
        part = short_of_circle(d->face, d->g, k, size) / size;
        sum[0] += part * x;
        sum[1] += part * y;
        part = (z[0] * z[0] + z[1] * z[1]) / (2 * d->g[k] * size);
        turn[0] = part * x;
        turn[1] = part * y;
    }
    shift_of(d->m, k, r, residual);
    for (int c = 0; c < 2; c++) {
        sum[2 + c] += turn[c];
        sum[4 + c] -= residual[c];
    }
}

/* Shifts that carry the sums 0, 1 and 2, 3 of left_by_model. */
struct remedy {
    double out[2], turn[2];
};

static void
errors(const struct rc_discs *d, size_t k, const void *with, double *sum)
{
    double x = d->q[0][k], y = d->q[1][k], size = hypot(x, y), out[2], turn[2];
    const struct remedy *m = with;

    shift_of(d->m, k, m->out, out);
    shift_of(d->m, k, m->turn, turn);
    sum[0] += hypot((double)d->z[0][k], (double)d->z[1][k]) +
              short_of_circle(d->face, d->g, k, size) + hypot(out[0], out[1]) +
              hypot(turn[0], turn[1]);
    sum[1] += size;
    sum[2] += x;
    sum[3] += y;
    if (d->face[k] == SLIP && !d->judged.measured && size > 0)
        sum[4] +=
            fmax(inwards(d, k) - (d->judged.motion[0] * x + d->judged.motion[1] * y) / size, 0);
}

/* The error relative to the exact tractions. `off`: the error of q; `size`: the sum of |q|. The sum of the
 * exact |q| is at least size - off, and at least the load. */
static double
relative(const struct rc_discs_asked *asked, double off, double size)
{
    /* Keeps the estimate finite before the first solution: it is then above 1 anyway. Half and double
     * change no bit (52 runs of bench/constants.py). */
    static const double least = 1.0 / 16;
    double part = safety * off / size,
           load = asked->given ? 0 : hypot(asked->sum[0], asked->sum[1]) / size;

    if (off == 0)
        return 0;
    part *= 1 + fmin(early * part, 0.5);
    return part / fmax(fmax(1 - part, load), least);
}

/* Computes z = M r minus its load, and the estimate: |z|_1, the distances to the circles, and the sums of
 * left_by_model. */
static void
precondition(struct rc_discs *d)
{
    double at[5], mu[2] = {0, 0}, left[6];
    struct remedy m = {{0, 0}, {0, 0}};

    rc_extension_apply(d->m, d->r, d->z);
    d->judged.motion[0] = d->judged.motion[1] = 0;
    if (!d->asked.given) {
        sum_nodes(d, load_of, d->z, 5, at);
        solve(&at[2], at, mu);
#pragma omp parallel for num_threads(d->threads) schedule(static)
        for (size_t k = 0; k < d->n; k++) {
            double v[2];
            shift_of(d->m, k, mu, v);
            for (int c = 0; c < 2; c++)
                d->z[c][k] -= (float)v[c];
        }
        sum_nodes(d, left_by_model, NULL, 6, left);
        solve(&at[2], left, m.out);
        solve(&at[2], left + 2, m.turn);
        if (!d->judged.measured)
            solve(&at[2], left + 4, d->judged.motion);
    }
    sum_nodes(d, errors, &m, 5, at);
    d->judged.carries = d->asked.given ||
                        hypot(at[2] - d->asked.sum[0], at[3] - d->asked.sum[1]) <= 1e-9 * d->limit;
    d->judged.turning = relative(&d->asked, at[0], at[1]);
    d->found.estimate = relative(&d->asked, at[0] + at[4] / d->m->self, at[1]);
}

/* The mean of the residual, if a displacement is given. Returns false if the mean is only rounding. */
static bool
has_mean(const struct rc_discs *d, double mean[2])
{
    double at[5];

    sum_nodes(d, load_of, d->r, 5, at);
    mean[0] = at[0] / (double)d->all;
    mean[1] = at[1] / (double)d->all;
    return hypot(mean[0], mean[1]) > 1e-6 * d->found.slip;
}

/* Computes faces, residual and estimate. Returns false if no node resists the mean of the residual. */
static bool
look(struct rc_discs *d, double mean[2])
{
    size_t sifted;

    for (bool sift = d->way.sift;; sift = false) {
        sifted = find_faces(d, sift);
        if (!rc_extension_set(d->m, d->face, d->q, d->curve, d->asked.given) && has_mean(d, mean))
            return false;
        precondition(d);
        if (d->found.estimate > d->asked.tol &&
            d->judged.turning <= d->asked.tol) { /* the next delta decides which nodes stick */
            d->delta[0] += d->judged.motion[0];
            d->delta[1] += d->judged.motion[1];
            d->judged.measured = true;
        } else if (sifted == 0 || d->found.estimate > d->asked.tol) {
            return true;
        }
    }
}

/* ---- steps ---- */

static void
conjugate(const struct rc_discs *d, size_t k, const void *with, double *sum)
{
    double f[2] = {d->way.d[0][k], d->way.d[1][k]};

    (void)with;
    free_part(d->face, d->q, k, f);
    for (int c = 0; c < 2; c++) {
        double y = d->way.h[c][k] + (double)d->curve[k] * f[c];
        sum[0] += (double)d->z[c][k] * y;
        sum[1] += f[c] * y;
    }
}

/* Makes z the direction: adds the multiple of the last step that makes both steps conjugate in T + D. */
static void
direct(struct rc_discs *d)
{
    double at[2], beta;

    if (d->way.part == 0)
        return;
    sum_nodes(d, conjugate, NULL, 2, at);
    beta = at[1] > 0 ? fmin(fmax(-d->way.part * at[0] / at[1], 0), 1) / d->way.part : 0;
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++) {
        double f[2] = {d->way.d[0][k], d->way.d[1][k]};
        free_part(d->face, d->q, k, f);
        for (int c = 0; c < 2; c++)
            d->z[c][k] += (float)(beta * f[c]);
    }
}

enum {
    FALL,     /* -s'd                                    */
    TWIST,    /* d'T d                                   */
    CURVED,   /* f'D f, f the free part of d             */
    DOWN,     /* r'f                                     */
    CLIPPED,  /* |d - p z|_1, where p z is the step before the projection */
    STRAIGHT, /* |p z|_1                                 */
    SCALE     /* the size of rounding */
};

static void
energies(const struct rc_discs *d, size_t k, const void *with, double *sum)
{
    double p = *(const double *)with, f[2] = {d->way.d[0][k], d->way.d[1][k]};
    double z[2] = {p * (double)d->z[0][k], p * (double)d->z[1][k]};

    sum[CLIPPED] += hypot(f[0] - z[0], f[1] - z[1]);
    sum[STRAIGHT] += hypot(z[0], z[1]);
    for (int c = 0; c < 2; c++) {
        double slip = slip_of(d, c, k);
        sum[FALL] -= f[c] * slip;
        sum[TWIST] += f[c] * d->way.h[c][k];
        sum[SCALE] += d->g[k] * fabs(slip);
    }
    free_part(d->face, d->q, k, f);
    sum[CURVED] += (double)d->curve[k] * (f[0] * f[0] + f[1] * f[1]);
    sum[DOWN] += (double)d->r[0][k] * f[0] + (double)d->r[1][k] * f[1];
}

/* Turns d from the tractions at the end of a step into the step itself, and computes h = T d. Returns true if
 * the energy falls along d. */
static bool
judge(struct rc_discs *d, double p, double at[SUMS])
{
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++)
        for (int c = 0; c < 2; c++)
            d->way.d[c][k] = d->face[k] == OFF ? 0 : d->way.d[c][k] - d->q[c][k];
    rc_tangential_apply(d->t, d->way.d, d->way.h);
    sum_nodes(d, energies, &p, 7, at);
    return at[FALL] > 0;
}

/* Takes `part` of the step. `reach`: the multiple of z from which the step was projected back. A node that
 * would leave its disc ends on a chord. */
static void
take(struct rc_discs *d, double length, double reach)
{
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++) {
        double end = hypot(d->q[0][k] + d->way.d[0][k], d->q[1][k] + d->way.d[1][k]);
        double far =
            hypot(d->q[0][k] + reach * (double)d->z[0][k], d->q[1][k] + reach * (double)d->z[1][k]);
        if (d->face[k] == STICK && fmax(end, far) >= d->g[k] * (1 - on_circle))
            d->face[k] = SLIP;
        for (int c = 0; c < 2; c++) {
            d->q[c][k] += length * d->way.d[c][k];
            d->u[c][k] += length * d->way.h[c][k];
        }
    }
}

/* Takes a step along the projected gradient. A second one shows that nodes on chords should stick: on their
 * circles the energy would rise. */
static void
fall_back(struct rc_discs *d)
{
    double at[SUMS];

    d->found.fallbacks++;
    d->way.part = 0;
    d->way.sift = true;
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++)
        for (int c = 0; c < 2; c++)
            d->way.d[c][k] = d->q[c][k] - slip_of(d, c, k) / d->t->norm;
    project(d, d->way.d);
    if (judge(d, 0, at))
        take(d, fmin(at[FALL] / at[TWIST], 1), 0);
    for (size_t k = 0; k < d->n && d->way.fell; k++)
        if (d->face[k] == SLIP && hypot(d->q[0][k], d->q[1][k]) < d->g[k] * (1 - on_circle))
            d->face[k] = STICK;
    d->way.fell = true;
}

/* Takes a step along z. */
static void
step_along(struct rc_discs *d)
{
    double at[SUMS], length, newton, all, reach = d->way.reach;

    direct(d);
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++)
        for (int c = 0; c < 2; c++)
            d->way.d[c][k] = d->q[c][k] + d->way.reach * (double)d->z[c][k];
    back(d, d->way.d);
    if (!judge(d, reach, at) && at[TWIST] > 16 * DBL_EPSILON * at[SCALE]) {
        d->way.reach = reach / 8; /* else the next step would fail too */
        fall_back(d);
        return;
    }
    all = at[TWIST] + at[CURVED];
    newton = length = at[DOWN] / all;
    if (!(length >= 0.5)) /* the radial moves count too */
        length = (at[FALL] + at[CURVED] / 2) / all;
    d->way.part = at[CLIPPED] > clipped * at[STRAIGHT] ? 0 : reach;
    d->way.reach =
        fmin(fmax(reach * length, length < short_step ? reach / 8 : fmin(0.5, 4 * reach)), 1);
    /* Half of 1.9 takes 2 % more convolutions; double and half of 0.25 change none (52 runs of
     * bench/constants.py). */
    length = at[TWIST] > 16 * DBL_EPSILON * at[SCALE]
                 ? fmin(fmin(length, 1), 1.9 * at[FALL] / at[TWIST])
                 : fmin(fmax(newton, 0.25), 1); /* see 6 */
    d->way.sift = length >= short_step;
    d->way.fell = false;
    take(d, length, reach);
}

/* For complete contact that sticks. Nothing resists the motion of the mean plane of a periodic map. So
 * tractions grow along this motion until the first node reaches its circle. */
static void
to_first_circle(struct rc_discs *d, const double mean[2])
{
    double size = hypot(mean[0], mean[1]), x = mean[0] / size, y = mean[1] / size, far = INFINITY;

    for (size_t k = 0; k < d->n; k++) {
        double along = d->q[0][k] * x + d->q[1][k] * y, across = d->q[1][k] * x - d->q[0][k] * y;
        far = fmin(far, sqrt(fmax(d->g[k] * d->g[k] - across * across, 0)) - along);
    }
    far = -rc_ranks_most(d->t->rows.ranks, -far);
    for (size_t k = 0; k < d->n; k++) {
        d->q[0][k] += far * x;
        d->q[1][k] += far * y;
    }
}

enum rc_status
rc_discs_step(struct rc_discs *d)
{
    double mean[2];
    bool seen;

    find_delta(d);
    seen = look(d, mean);
    if (!seen)
        d->found.estimate = 1;
    else if (d->found.estimate <= d->asked.tol)
        return d->judged.carries ? RC_OK : RC_SHORT;
    else if (isnan(d->found.estimate)) /* a number is too large */
        return RC_SHORT;
    if (d->found.steps >= d->asked.most)
        return RC_SHORT;
    d->found.steps++;
    if (seen)
        step_along(d);
    else if (d->found.slipping == 0)
        to_first_circle(d, mean);
    else
        fall_back(d);
    return RC_MORE;
}

/* A load on a line displaces a strip of the width w by the logarithm of the datum over w/4 at least. */
enum rc_status
rc_discs_check_datum(const struct rc_discs *d, double length, struct rc_err *err)
{
    const bool across = d->t->boundary.x; /* the free axis is y */
    const double cell = across ? d->t->shape.dy : d->t->shape.dx;
    size_t first = SIZE_MAX, end = 0;
    double width;

    for (size_t k = 0; k < d->n && rc_repeats(d->t->boundary) == 1; k++) {
        const size_t at = across ? d->t->rows.first + k / d->nx : k % d->nx;
        if (d->g[k] > 0) {
            first = at < first ? at : first;
            end = at + 1 > end ? at + 1 : end;
        }
    }
    if (rc_repeats(d->t->boundary) == 1) { /* whole numbers below 2^53 */
        end = (size_t)rc_ranks_most(d->t->rows.ranks, (double)end);
        first =
            (size_t)-rc_ranks_most(d->t->rows.ranks, first == SIZE_MAX ? -0x1p53 : -(double)first);
    }
    width = end > 0 ? (double)(end - first) * cell * length : 0;
    if (d->t->boundary.datum * length > width / 4 || width == 0)
        return RC_OK;
    return rc_err_set(
        err,
        "datum %g m, in a contact %g m wide: where the displacement is given, it must "
        "be above a quarter of this width; give a larger datum, or the force",
        d->t->boundary.datum * length, width);
}

static void
radius(const struct rc_discs *d, size_t k, const void *with, double *sum)
{
    (void)with;
    sum[0] += d->g[k];
}

/* Part of the radius beyond which a node of the start slips. Half takes 3 % more convolutions. Double
 * makes all nodes stick, which takes 15 % more (52 runs of bench/constants.py). */
static const double near = 0.99;

static void
well_inside(const struct rc_discs *d, size_t k, const void *with, double *sum)
{
    (void)with;
    sum[0] += hypot(d->q[0][k], d->q[1][k]) < near * d->g[k];
}

void
rc_discs_begin(struct rc_discs *d)
{
    double inside;

#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++) {
        d->face[k] = d->g[k] > 0 ? STICK : OFF;
        for (int c = 0; c < 2; c++)
            if (d->face[k] == OFF)
                d->q[c][k] = 0;
    }
    sum_nodes(d, radius, NULL, 1, &d->limit);
    project(d, d->q);
    sum_nodes(d, well_inside, NULL, 1, &inside);
    for (size_t k = 0; k < d->n && inside > 0; k++) /* the start may have nodes on chords */
        if (d->face[k] == STICK && hypot(d->q[0][k], d->q[1][k]) >= near * d->g[k])
            d->face[k] = SLIP;
    rc_tangential_apply(d->t, d->q, d->u);
    d->found.steps = d->found.fallbacks = 0;
    d->way.part = 0;
    d->way.reach = 1;
    d->way.sift = true;
    d->way.fell = false;
}

/* ---- memory ---- */

enum {
    OWN = 4, /* maps of doubles that are needed after the last step */
    WORK = 7,
    SINGLE = 5
};

static void
set_pair(double *to[2], double *map, size_t n)
{
    to[0] = map;
    to[1] = map + n;
}

static enum rc_status
has_memory(const struct rc_discs *d, bool has, struct rc_err *err)
{
    const struct rc_shape *all = &d->t->shape;

    return rc_ranks_need(d->t->rows.ranks, has, err,
                         "out of memory for the friction of %zu x %zu nodes", all->nx, all->ny);
}

/* The maps of a problem lie in one block. */
static enum rc_status
allocate_own(struct rc_discs *d, struct rc_err *err)
{
    double *map = rc_store_zeros(&d->own, OWN * d->n, sizeof *map);

    d->face = rc_store_zeros(&d->own, d->n, 1);
    if (has_memory(d, !d->own.failed, err) != RC_OK)
        return RC_FAIL;
    set_pair(d->q, map, d->n);
    set_pair(d->u, map + 2 * d->n, d->n);
    return RC_OK;
}

/* Those of the iteration lie in two blocks. */
static enum rc_status
allocate_work(struct rc_discs *d, struct rc_err *err)
{
    const struct rc_ranks *ranks = d->t->rows.ranks;
    double *map = rc_store_zeros(&d->own, WORK * d->n, sizeof *map);
    float *single = rc_store_take(&d->own, SINGLE * d->n, sizeof *single);
    const enum rc_status sums = rc_sums_new(&d->rows, ranks, d->ny, SUMS, MOSTS, d->threads);

    if (ranks != NULL)
        d->beside = rc_store_zeros(&d->own, 4 * BESIDE * d->nx, sizeof *d->beside);
    if (has_memory(d, sums == RC_OK && !d->own.failed, err) != RC_OK)
        return RC_FAIL;
    d->g = map;
    set_pair(d->w, map + d->n, d->n);
    set_pair(d->way.d, map + 3 * d->n, d->n);
    set_pair(d->way.h, map + 5 * d->n, d->n);
    d->curve = single;
    for (size_t c = 0; c < 2; c++) {
        d->r[c] = single + (1 + c) * d->n;
        d->z[c] = single + (3 + c) * d->n;
    }
    return (d->m = rc_extension_new(d->t, err)) == NULL ? RC_FAIL : RC_OK;
}

struct rc_discs *
rc_discs_new(struct rc_tangential *t, struct rc_err *err)
{
    RC_OWN(rc_discs, d) = calloc(1, sizeof *d);

    if (rc_ranks_need(t->rows.ranks, d != NULL, err, "out of memory for friction") != RC_OK)
        return NULL;
    if (t->rows.ranks != NULL && rc_rows_unit(t->shape.nx) % tile_rows(t) != 0)
        return rc_err_null(err,
                           "dy is %g times dx: processes cannot share the map, because a tile of "
                           "friction has %zu rows: take one process, or square cells",
                           t->shape.dy / t->shape.dx, tile_rows(t));
    *d = (struct rc_discs){.t = t,
                           .nx = t->shape.nx,
                           .ny = t->rows.n,
                           .n = t->shape.nx * t->rows.n,
                           .all = t->shape.nx * t->shape.ny,
                           .threads = t->threads,
                           .asked.most = 200};
    return allocate_own(d, err) == RC_OK && allocate_work(d, err) == RC_OK ? rc_give(&d) : NULL;
}

struct rc_discs *
rc_discs_beside(const struct rc_discs *other, struct rc_err *err)
{
    RC_OWN(rc_discs, d) = calloc(1, sizeof *d);

    if (rc_ranks_need(other->t->rows.ranks, d != NULL, err, "out of memory for friction") != RC_OK)
        return NULL;
    *d = *other;
    d->borrows = true;
    d->own = (struct rc_store){0};
    return allocate_own(d, err) == RC_OK ? rc_give(&d) : NULL;
}

void
rc_discs_free(struct rc_discs *d)
{
    if (d == NULL)
        return;
    if (!d->borrows) {
        rc_extension_free(d->m);
        free(d->rows.row);
    }
    rc_store_free(&d->own);
    free(d);
}
