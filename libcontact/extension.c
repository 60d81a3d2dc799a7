#include "extension.h"

#include <math.h>
#include <stdlib.h>

#include "fft.h"

struct rc_extension {
    struct rc_shape unit; /* the grid in units of sqrt(dx dy) */
    double stiffness;     /* E* / sqrt(dx dy): what A is in those units, per unit of E* = 1          */
    size_t n;
    struct rc_fft *fft;   /* single precision is enough: only the residual has to be exact           */
    struct rc_spectrum *inverse, *spread; /* A and G                                        */
    double *weight;  /* off W: 1 / (sum_j G_ij + d_i^(-1/2) / 2); on W: 0                    */
    double *field;   /* scratch of n                                                        */
    double *other;   /* scratch of n                                                        */
    int threads;
    double *scratch; /* of distance                                                         */
    const unsigned char *w;
};

/* |x|^(-5/2); a node has no weight in itself, because no node is both on W and off it. */
static void
spread_rows(const struct rc_medium *medium, size_t component, const struct rc_lattice *at,
            size_t n, size_t first, size_t last, double *out)
{
    double dx = (double)at->sx * at->dx, dy = (double)at->sy * at->dy;
    double unit = 1 / (at->dx * at->dy); /* of squared lengths */

    (void)medium;
    (void)component;
    for (size_t j = first; j < last; j++, out += n)
        for (size_t i = 0; i < n; i++) {
            double x = (double)i * dx, y = (double)j * dy;
            double r2 = (x * x + y * y) * unit;
            out[i] = r2 == 0 ? 0 : 1 / (r2 * sqrt(sqrt(r2)));
        }
}

static const unsigned even[] = {0};

static const struct rc_kernel spread = {
    .name = "spread",
    .summary = "weights of the extension off the working set",
    .components = 1,
    .parity = even,
    .rows = spread_rows,
};

struct rc_extension *
rc_extension_new(const struct rc_shape *shape, enum rc_boundary boundary, double estar,
                 size_t threads, struct rc_err *err)
{
    struct rc_medium medium = {.estar = 1};
    struct rc_extension *e = calloc(1, sizeof *e);
    size_t n = shape->nx * shape->ny;
    double unit = sqrt(shape->dx) * sqrt(shape->dy);

    if (e == NULL)
        goto short_of_memory;
    e->n = n;
    e->threads = rc_useful_threads(shape, threads);
    e->unit = *shape;
    e->unit.dx /= unit;
    e->unit.dy /= unit;
    e->stiffness = estar / unit;
    e->weight = malloc(n * sizeof *e->weight);
    e->field = malloc(n * sizeof *e->field);
    e->other = malloc(n * sizeof *e->other);
    e->scratch = malloc(rc_distance_scratch(shape, e->threads) * sizeof *e->scratch);
    if (e->weight == NULL || e->field == NULL || e->other == NULL || e->scratch == NULL)
        goto short_of_memory;
    if ((e->fft = rc_fft_new(&e->unit, boundary, RC_SINGLE, threads, err)) == NULL ||
        (e->inverse = rc_spectrum_new(e->fft, err)) == NULL ||
        (e->spread = rc_spectrum_new(e->fft, err)) == NULL ||
        rc_spectrum_set_inverse(e->inverse, e->fft, &rc_kernel_boussinesq, 0, &medium,
                                err) != RC_OK ||
        rc_spectrum_set_values(e->spread, e->fft, &spread, 0, &medium, err) != RC_OK) {
        rc_extension_free(e);
        return NULL;
    }
    return e;
short_of_memory:
    rc_err_set(err, "out of memory for the error estimate of %zu x %zu nodes", shape->nx,
               shape->ny);
    rc_extension_free(e);
    return NULL;
}

void
rc_extension_free(struct rc_extension *e)
{
    if (e == NULL)
        return;
    rc_fft_free(e->fft);
    rc_spectrum_free(e->inverse);
    rc_spectrum_free(e->spread);
    free(e->weight);
    free(e->field);
    free(e->other);
    free(e->scratch);
    free(e);
}

void
rc_extension_set(struct rc_extension *e, const unsigned char *w)
{
    e->w = w;
    for (size_t k = 0; k < e->n; k++)
        e->field[k] = w[k] != 0;
    rc_fft_apply(e->fft, e->spread, e->field, e->weight);
    rc_distance_squared(&e->unit, w, e->threads, e->scratch, e->field);
    for (size_t k = 0; k < e->n; k++) {
        double d = fmax(sqrt(e->field[k]) - 0.5, 0.25);
        e->weight[k] = w[k] ? 0 : 1 / (fmax(e->weight[k], 0) + 0.5 / sqrt(d));
    }
}

/* Single precision has 38 decades, gaps in metres and moduli in pascals can need more: the largest |r|
 * is made 1, and A works in units of E* and of the grid. */
void
rc_extension_apply(struct rc_extension *e, const double *r, double *z)
{
    double *y = e->field, *q = e->other, size = 0, scale;

    for (size_t k = 0; k < e->n; k++)
        size = fmax(size, fabs(r[k]));
    scale = size > 0 ? 1 / size : 0;
    for (size_t k = 0; k < e->n; k++)
        q[k] = scale * r[k];
    rc_fft_apply(e->fft, e->spread, q, y);
    for (size_t k = 0; k < e->n; k++)
        y[k] = e->w[k] ? q[k] : e->weight[k] * y[k];
    rc_fft_apply(e->fft, e->inverse, y, y);
    for (size_t k = 0; k < e->n; k++)
        q[k] = e->weight[k] * y[k];
    rc_fft_apply(e->fft, e->spread, q, q);
    for (size_t k = 0; k < e->n; k++)
        z[k] = e->w[k] ? size * e->stiffness * (y[k] + q[k]) : 0;
}
