#include "preconditioner.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

struct rc_preconditioner {
    struct rc_operator *op;     /* the caller's                                                  */
    struct rc_shape unit;       /* the grid in units of sqrt(dx dy)                              */
    struct rc_spectrum *spread; /* G                                                         */
    float fade;                 /* c, for d_i^(-1/2)                                             */
    bool fades;                 /* else c, d and S do not count                              */
    float surrounded;           /* S of a node that W half surrounds                             */
    float *node;                /* rc_extension_weight: 1 / (sum_j G_ij + c d_i^(-1/2))           */
    float whole;                /* sum_j G_ij, were all nodes on W                                */
    uint16_t *closeness;        /* d_i^(-1/2), times CLOSE                                       */
    const unsigned char *w;
    bool measure; /* the distances are to be found again                           */
    int threads;
    size_t own; /* numbers of scratch of one thread                              */
    float *scratch;
    double *lines;       /* three, where ranks share the map; else NULL                    */
    size_t above, below; /* rows of the frame that are held here                              */
    float *
        frame; /* rc_extension_weight of nodes of the frame: those of a row follow each other, all or
                      left and right of the map; NULL: there is none */
};

/* |x|^(-5/2), on a line |x|^(-3/2): half a power more than the exact extension off a half-plane or a
 * half-line, which has weights of the sources instead. Off a coat that bends it is that only as near as the
 * coat is thick, and |x|^(-4) beyond: the inverse then grows as q^a with a of up to 4 between the waves as
 * long as the coat bends and those as short as it is thick, and the exact extension off a half-plane
 * has sources weighted by d_j^(-a/2). A node has no weight in itself, because no node is both on W and
 * off it. */
enum kind {
    ON_MAP,
    ON_LINE,
    ON_COAT
};

struct spread {
    enum kind kind;
    double bends; /* length from which the coat bends */
};

static double
spread_of(double r2, const struct spread *s)
{
    double root = sqrt(sqrt(r2)), near, far;

    if (r2 == 0)
        return 0;
    if (s->kind == ON_LINE)
        return 1 / (root * root * root);
    near = 1 / (r2 * root);
    if (s->kind == ON_MAP)
        return near;
    far = 1 + sqrt(r2) / s->bends;
    return near / (far * sqrt(far));
}

static void
spread_rows(const void *of, const struct rc_lattice *at, size_t n, size_t first, size_t last,
            double *out)
{
    double dx = (double)at->sx * at->dx, dy = (double)at->sy * at->dy;
    double unit = 1 / (at->dx * at->dy); /* of squared lengths */

    for (size_t j = first; j < last; j++, out += n)
        for (size_t i = 0; i < n; i++) {
            double x = (double)i * dx, y = (double)j * dy;
            out[i] = spread_of((x * x + y * y) * unit, of);
        }
}

/* ---- the frame ---- */

/* Nodes of the frame before those of row j of the framed map. */
static size_t
frame_before(const struct rc_preconditioner *e, size_t j)
{
    size_t x = e->op->frame.x, y = e->above, ny = e->unit.ny, all = e->unit.nx + 2 * x;

    if (j <= y)
        return j * all;
    return j <= y + ny ? y * all + (j - y) * 2 * x : y * all + ny * 2 * x + (j - y - ny) * all;
}

static bool
is_on_map(const struct rc_preconditioner *e, size_t j)
{
    return j >= e->above && j - e->above < e->unit.ny;
}

/* Of a framed row the part on the map, of which it becomes row *j; NULL where it is off the map. */
static float *
on_map(const struct rc_preconditioner *e, size_t *j, void *row)
{
    if (!is_on_map(e, *j))
        return NULL;
    *j -= e->above;
    return (float *)row + e->op->frame.x;
}

/* What a row of the frame, or its nodes left and right of the map, are multiplied by. */
static void
weigh_frame(const struct rc_preconditioner *e, size_t j, float *row)
{
    const float *weight;
    size_t x = e->op->frame.x, nx = e->unit.nx;

    if (e->frame == NULL)
        return;
    weight = e->frame + frame_before(e, j);
    if (!is_on_map(e, j)) {
        for (size_t i = 0; i < nx + 2 * x; i++)
            row[i] *= weight[i];
        return;
    }
    for (size_t i = 0; i < x; i++) {
        row[i] *= weight[i];
        row[nx + x + i] *= weight[x + i];
    }
}

static void
keep_frame(struct rc_preconditioner *e, size_t j, const float *row)
{
    float *to;
    size_t x = e->op->frame.x, nx = e->unit.nx;

    if (e->frame == NULL)
        return;
    to = e->frame + frame_before(e, j);
    if (!is_on_map(e, j)) {
        memcpy(to, row, (nx + 2 * x) * sizeof *to);
        return;
    }
    memcpy(to, row, x * sizeof *to);
    memcpy(to + x, row + x + nx, x * sizeof *to);
}

static void
clear_sides(const struct rc_preconditioner *e, float *row)
{
    memset(row, 0, e->op->frame.x * sizeof *row);
    memset(row + e->op->frame.x + e->unit.nx, 0, e->op->frame.x * sizeof *row);
}

/* The fade f of the extension is for nodes that W does not surround. S, the sum over W of
 * |x_ij|^(-5/2) d_i^(1/2), tells how far W does: it is 4.8 beside a straight edge. Near small patches
 * the extension has to fall off to the mean, 0. Where W is all around it must not: on a periodic map a
 * constant has no energy at all, and a fade of a tenth would make waves of length l too stiff by a
 * factor that grows with l, 2.4 for the longest of 2048 x 2048 at 39 % contact, so that the number of
 * steps would grow with the map. */
static const float surrounded = 3;
/* On the period of a line S is 2 beside a half-line, and the mean has to be reached only far from all of W:
 * tried with contact of 2 to 90 % on 1024 to 65536 nodes. */
static const float surrounded_on_line = 1.25F;
static const double fade_on_line = 0.02;
/* Off a coat that bends the extension does not fade: over the bending length there is no energy in what is
 * smooth. Where the sum of G is less than this, some 1e-5 of that beside W, it has lost its
 * digits in single precision, and the extension falls to 0. */
static const float least_sum = 1e-5F;

/* Beyond the ends of a line that does not repeat there is nothing to extend to; there the extension of maps
 * is as good. */
static bool
is_line(const struct rc_operator *op)
{
    return op->boundary == RC_PERIODIC && (op->whole.nx == 1 || op->whole.ny == 1);
}

static enum kind
kind_on(const struct rc_operator *op)
{
    return is_line(op) ? ON_LINE : op->bends > 0 ? ON_COAT : ON_MAP;
}

struct rc_preconditioner *
rc_preconditioner_new(struct rc_operator *op, struct rc_err *err)
{
    struct rc_preconditioner *e = calloc(1, sizeof *e);
    size_t n = op->shape.nx * op->shape.ny, frame;
    double unit = sqrt(op->shape.dx) * sqrt(op->shape.dy);
    const struct spread of = {kind_on(op), op->bends};
    bool line = of.kind == ON_LINE;
    const struct rc_kernel spread = {.rows = spread_rows, .of = &of};

    if (e == NULL)
        goto short_of_memory;
    e->op = op;
    e->threads = rc_useful_threads(&op->shape, op->threads);
    e->unit = op->shape;
    e->unit.dx /= unit;
    e->unit.dy /= unit;
    e->fade = (float)(op->extension * (line ? fade_on_line : 1));
    e->fades = of.kind != ON_COAT;
    e->surrounded = line ? surrounded_on_line : surrounded;
    e->own = rc_distance_scratch(&e->unit) + op->shape.nx;
    e->node = rc_alloc(n, sizeof *e->node);
    e->closeness = rc_alloc(n, sizeof *e->closeness);
    e->scratch = rc_alloc((size_t)e->threads * e->own, sizeof *e->scratch);
    if (e->node == NULL || e->closeness == NULL || e->scratch == NULL)
        goto short_of_memory;
    e->above = op->shape.ny > 0 && op->rows.first == 0 ? op->frame.y : 0;
    e->below = op->shape.ny > 0 && op->rows.first + op->rows.n == op->rows.ny ? op->frame.y : 0;
    frame = frame_before(e, e->above + e->unit.ny + e->below);
    if (frame > 0 && (e->frame = rc_alloc(frame, sizeof *e->frame)) == NULL)
        goto short_of_memory;
    if (op->rows.ranks != NULL && (e->lines = rc_alloc(3 * op->shape.nx, sizeof *e->lines)) == NULL)
        goto short_of_memory;
    if (rc_ranks_agree(op->rows.ranks, RC_OK, err) != RC_OK) {
        rc_preconditioner_free(e);
        return NULL;
    }
    if ((e->spread = rc_operator_spectrum(op, &spread, err)) == NULL) {
        rc_preconditioner_free(e);
        return NULL;
    }
    e->whole = (float)rc_spectrum_total(e->spread);
    return e;
short_of_memory:
    rc_err_set(err, "out of memory for the error estimate of %zu x %zu nodes", op->shape.nx,
               op->shape.ny);
    (void)rc_ranks_agree(op->rows.ranks, RC_FAIL, err);
    rc_preconditioner_free(e);
    return NULL;
}

void
rc_preconditioner_free(struct rc_preconditioner *e)
{
    if (e == NULL)
        return;
    rc_spectrum_free(e->spread);
    free(e->node);
    free(e->closeness);
    free(e->scratch);
    free(e->lines);
    free(e->frame);
    free(e);
}

size_t
rc_preconditioner_memory(const struct rc_shape *shape, enum rc_boundary boundary, size_t ranks)
{
    size_t rows = ranks > 1 ? rc_rows_most(shape, ranks) : shape->ny;
    struct rc_frame frame = rc_operator_frame(shape, boundary);

    return rc_spectrum_memory(shape, boundary, RC_SINGLE, ranks) +
           shape->nx * rows * (sizeof(float) + sizeof(uint16_t)) +
           (rows * 2 * frame.x + 2 * frame.y * (shape->nx + 2 * frame.x)) * sizeof(float);
}

/* ---- the working set ---- */

static bool
mask_in(void *at, size_t j, void *row)
{
    struct rc_preconditioner *e = at;
    size_t n = e->unit.nx;
    float *out = on_map(e, &j, row);
    const unsigned char *w;
    unsigned any = 0;

    if (out == NULL)
        return false;
    clear_sides(e, row);
    w = e->w + j * n;
    for (size_t i = 0; i < n; i++) {
        out[i] = w[i];
        any |= w[i];
    }
    return any != 0;
}

/* Scale of the stored d^(-1/2), whose largest value is 2, at d = 1/4. A thousand nodes away it is
 * still right to a part in a thousand; it only chooses weights. */
enum {
    CLOSE = 32767
};

RC_CLONES static void
closeness_of(size_t n, const float *restrict d2, uint16_t *restrict closeness)
{
    for (size_t i = 0; i < n; i++) {
        float d = sqrtf(d2[i]) - 0.5f, c = CLOSE / sqrtf(d > 0.25f ? d : 0.25f);
        closeness[i] = (uint16_t)(int)(c > 1 ? c : 1);
    }
}

/* The pressure M 1 of a shift of all of W is large at nodes whose surroundings are not W: it is nearly
 * proportional to the part of the sum of G that is missing there. */
RC_CLONES static void
weigh(size_t n, float fade, float surrounded_by, float whole, const unsigned char *w,
      const float *sums, const uint16_t *restrict closeness, float *restrict node)
{
    for (size_t i = 0; i < n; i++) {
        float sum = sums[i] > 0 ? sums[i] : 0, close = (float)closeness[i] * (1.0F / CLOSE);
        float part = sum / (surrounded_by * close);
        float part4 = part * part * part * part, missing = 1 - sum / whole;
        float share = missing > RC_LEAST_SHARE ? missing : RC_LEAST_SHARE;
        float weight = 1 / (sum + fade * close / (1 + part4));
        node[i] = w[i] ? rc_node_on(share) : rc_node_off(weight);
    }
}

/* Weights without a fade. */
RC_CLONES static void
weigh_coat(size_t n, float whole, const unsigned char *w, const float *sums, float *restrict node)
{
    for (size_t i = 0; i < n; i++) {
        float sum = sums[i] > 0 ? sums[i] : 0, missing = 1 - sum / whole;
        float share = missing > RC_LEAST_SHARE ? missing : RC_LEAST_SHARE;
        node[i] = w[i] ? rc_node_on(share) : rc_node_off(1 / (sum + least_sum));
    }
}

/* The sums arrive; where distances are to be found, `node` holds the steps along the columns. */
static bool
weights_out(void *at, size_t j, void *row)
{
    struct rc_preconditioner *e = at;
    size_t n = e->unit.nx;
    float *scratch = e->scratch + (size_t)omp_get_thread_num() * e->own;
    float *d2 = scratch + rc_distance_scratch(&e->unit), *node, *sums;

    keep_frame(e, j, row);
    if ((sums = on_map(e, &j, row)) == NULL)
        return true;
    node = e->node + j * n;
    if (e->measure) {
        rc_distance_row(&e->unit, e->op->boundary, scratch, node, d2);
        closeness_of(n, d2, e->closeness + j * n);
    }
    if (!e->fades) {
        weigh_coat(n, e->whole, e->w + j * n, sums, node);
        return true;
    }
    weigh(n, e->fade, e->surrounded, e->whole, e->w + j * n, sums, e->closeness + j * n, node);
    return true;
}

/* Falls off from 1 at the map to 0 beyond the end of the frame. */
static float
taper(size_t off, size_t frame)
{
    return 1 - (float)off / (float)(frame + 1);
}

/* Nodes from k to the nearest of n that follow `before` others; that one. */
static size_t
beside(size_t k, size_t before, size_t n, size_t *nearest)
{
    *nearest = k < before ? 0 : k < before + n ? k - before : n - 1;
    return k < before ? before - k : k - before - *nearest;
}

/* From the sum of a node of the frame to its weight. Its distance from W is taken for that of the nearest
 * node of the map and the way there. */
static float
frame_weight(const struct rc_preconditioner *e, size_t i, size_t j, float sum)
{
    const struct rc_frame *frame = &e->op->frame;
    size_t k, l, x = beside(i, frame->x, e->unit.nx, &k), y = beside(j, e->above, e->unit.ny, &l);
    float near = CLOSE / (float)e->closeness[l * e->unit.nx + k]; /* d^(1/2) */
    float way = hypotf((float)x * (float)e->unit.dx, (float)y * (float)e->unit.dy);
    float close = 1 / sqrtf(near * near + way), part;

    sum = sum > 0 ? sum : 0;
    part = sum / (e->surrounded * close);
    return taper(x, frame->x) * taper(y, frame->y) /
           (sum + e->fade * close / (1 + part * part * part * part));
}

static void
weigh_all_of_frame(struct rc_preconditioner *e)
{
    size_t x = e->op->frame.x, nx = e->unit.nx, rows = e->above + e->unit.ny + e->below;

#pragma omp parallel for num_threads(e->threads) schedule(static)
    for (size_t j = 0; j < rows; j++) {
        float *at = e->frame + frame_before(e, j);
        bool all = !is_on_map(e, j);
        for (size_t i = 0; i < nx + 2 * x; i++)
            if (all || i < x || i >= x + nx) {
                *at = frame_weight(e, i, j, *at);
                at++;
            }
    }
}

void
rc_preconditioner_set(struct rc_preconditioner *e, const unsigned char *w, bool measure)
{
    const struct rc_spectrum *factors[] = {e->spread};
    rc_row *rows[] = {mask_in, weights_out};

    e->w = w;
    e->measure = measure && e->fades;
    if (e->measure)
        rc_distance_columns(&e->unit, &e->op->rows, e->op->boundary, w, e->threads, e->lines,
                            e->node);
    rc_operator_chain_framed(e->op, 1, factors, rows, e);
    if (e->frame != NULL)
        weigh_all_of_frame(e);
}

void
rc_preconditioner_spread(struct rc_preconditioner *e, float *z)
{
    size_t n = e->op->shape.nx * e->op->shape.ny;
    float most = 0;

    for (size_t k = 0; k < n; k++)
        z[k] = 1;
    rc_preconditioner_apply(e, z, 0, z, NULL, NULL);
    for (size_t k = 0; k < n; k++)
        most = z[k] > most ? z[k] : most;
    most = (float)rc_ranks_most(e->op->rows.ranks, (double)most);
    for (size_t k = 0; k < n && most > 0; k++)
        if (e->w[k])
            e->node[k] = rc_node_on(fmaxf(z[k] / most, RC_LEAST_SHARE));
}

const float *
rc_preconditioner_nodes(const struct rc_preconditioner *e)
{
    return e->node;
}

/* ---- E' A E ---- */

struct correction {
    struct rc_preconditioner *e;
    const float *r;
    float offset, *z;
    rc_row *done;
    void *ctx;
};

RC_CLONES static bool
take(size_t n, const unsigned char *w, const float *r, float offset, float *restrict out)
{
    unsigned any = 0;

    for (size_t i = 0; i < n; i++) {
        out[i] = w[i] ? r[i] - offset : 0;
        any |= w[i];
    }
    return any != 0;
}

static bool
residual_in(void *at, size_t j, void *row)
{
    struct correction *c = at;
    const struct rc_preconditioner *e = c->e;
    size_t n = e->unit.nx;
    float *to = on_map(e, &j, row);

    if (to == NULL)
        return false;
    clear_sides(e, row);
    return take(n, e->w + j * n, c->r + j * n, c->offset, to);
}

RC_CLONES static void
extend(size_t n, const unsigned char *w, const float *r, float offset, const float *node,
       float *restrict row)
{
    for (size_t i = 0; i < n; i++)
        row[i] = w[i] ? r[i] - offset : rc_extension_weight(node[i]) * row[i];
}

static bool
extended(void *at, size_t j, void *row)
{
    struct correction *c = at;
    const struct rc_preconditioner *e = c->e;
    size_t n = e->unit.nx;
    float *field;

    weigh_frame(e, j, row);
    if ((field = on_map(e, &j, row)) != NULL)
        extend(n, e->w + j * n, c->r + j * n, c->offset, e->node + j * n, field);
    return true;
}

RC_CLONES static void
part(size_t n, const unsigned char *w, const float *node, float *restrict row, float *restrict z)
{
    for (size_t i = 0; i < n; i++) {
        z[i] = w[i] ? row[i] : 0;
        row[i] = w[i] ? 0 : rc_extension_weight(node[i]) * row[i];
    }
}

static bool
parted(void *at, size_t j, void *row)
{
    struct correction *c = at;
    const struct rc_preconditioner *e = c->e;
    size_t n = e->unit.nx;
    float *field;

    weigh_frame(e, j, row);
    if ((field = on_map(e, &j, row)) != NULL)
        part(n, e->w + j * n, e->node + j * n, field, c->z + j * n);
    return true;
}

RC_CLONES static void
add(size_t n, const unsigned char *w, const float *row, float *restrict z)
{
    for (size_t i = 0; i < n; i++)
        z[i] += w[i] ? row[i] : 0;
}

static bool
correction_out(void *at, size_t j, void *row)
{
    struct correction *c = at;
    const struct rc_preconditioner *e = c->e;
    size_t n = e->unit.nx;
    float *field = on_map(e, &j, row);

    if (field == NULL)
        return true;
    add(n, e->w + j * n, field, c->z + j * n);
    return c->done == NULL || c->done(c->ctx, j, field);
}

void
rc_preconditioner_apply(struct rc_preconditioner *e, const float *r, float offset, float *z,
                        rc_row *done, void *ctx)
{
    struct correction c = {.e = e, .r = r, .offset = offset, .z = z, .done = done, .ctx = ctx};
    const struct rc_spectrum *factors[] = {e->spread, e->op->inverse, e->spread};
    rc_row *rows[] = {residual_in, extended, parted, correction_out};

    rc_operator_chain_framed(e->op, 3, factors, rows, &c);
}
