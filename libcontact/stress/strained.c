/*
 * The stress of plastic strain in slabs, added to that of the pressure. At a depth it is that of a thin slab cut
 * out of the one around it, all of whose parts have the same strain; below the stack that of a thin slab without.
 */
#include <stdlib.h>
#include <string.h>

#include "libcontact/volume/volume.h"
#include "stress.h"

enum {
    PARTS = 5, /* maps of a slab */
    NONE = -1
};
static const double thin = 1e-2; /* of the spacing */

struct rc_strained {
    const struct rc_stress_task *task;
    struct rc_shape shape; /* rows held here */
    struct rc_slabs *slabs;
    size_t n;          /* pieces: two more than slabs                                          */
    double *thickness; /* of the pieces                                                        */
    int *from;         /* the slab of each, or NONE                                            */
    bool *strained, *wanted;
    double *const *to; /* where the stresses go                                                */
};

static const enum rc_component components[PARTS] = {RC_SXX, RC_SYY, RC_SXY, RC_SXZ, RC_SYZ};

enum rc_status
rc_strained_check(const struct rc_stress_options *o, struct rc_err *err)
{
    const struct rc_eigenstrain *e = o->strain;

    if (e == NULL)
        return RC_OK;
    if (o->body.layers > 0)
        return rc_err_set(err, "the stress of plastic strain is not known under layers");
    if (!(o->body.e > 0) || isinf(o->body.e))
        return rc_err_set(err, "the stress of plastic strain needs the body's Young's modulus");
    if (e->slabs == 0)
        return rc_err_set(err, "plastic strain in no slab");
    return RC_OK;
}

static struct rc_slabs_options
slabs_options(const struct rc_stress_options *o, const double *thickness)
{
    return (struct rc_slabs_options){.slabs = o->strain->slabs + 2,
                                     .thickness = thickness,
                                     .shear = o->body.e / (2 * (1 + o->body.nu)),
                                     .nu = o->body.nu,
                                     .padded = o->boundary == RC_FREE,
                                     .whole = true,
                                     .threads = o->threads,
                                     .ranks = o->ranks};
}

size_t
rc_strained_memory(const struct rc_stress_task *task)
{
    const struct rc_slabs_options options = slabs_options(&task->options, NULL);

    return rc_slabs_memory(&task->shape, &options);
}

struct rc_strained *
rc_strained_new(const struct rc_stress_task *task, struct rc_err *err)
{
    const struct rc_eigenstrain *e = task->options.strain;
    const struct rc_rows rows = rc_rows_of(task->options.ranks, &task->shape);
    struct rc_strained *p = calloc(1, sizeof *p);
    struct rc_slabs_options options;

    if (p == NULL) {
        rc_err_set(err, "out of memory for a plan");
        return NULL;
    }
    *p = (struct rc_strained){
        .task = task, .shape = rc_rows_shape(&rows, &task->shape), .n = e->slabs + 2};
    p->thickness = malloc(p->n * sizeof *p->thickness);
    p->from = malloc(p->n * sizeof *p->from);
    p->strained = malloc(p->n * sizeof *p->strained);
    p->wanted = malloc(p->n * sizeof *p->wanted);
    if (p->thickness == NULL || p->from == NULL || p->strained == NULL || p->wanted == NULL) {
        rc_err_set(err, "out of memory for a plan");
        rc_strained_free(p);
        return NULL;
    }
    for (size_t k = 0; k < p->n; k++) /* until a depth is asked for */
        p->thickness[k] = k < e->slabs ? e->thickness[k] : task->shape.dx;
    options = slabs_options(&task->options, p->thickness);
    p->slabs = rc_slabs_new(&task->shape, &options, err);
    if (p->slabs == NULL) {
        rc_strained_free(p);
        return NULL;
    }
    return p;
}

void
rc_strained_free(struct rc_strained *p)
{
    if (p == NULL)
        return;
    rc_slabs_free(p->slabs);
    free(p->thickness);
    free(p->from);
    free(p->strained);
    free(p->wanted);
    free(p);
}

/* ---- pieces ---- */

static void
add(struct rc_strained *p, size_t *n, double thickness, int from, bool wanted)
{
    if (!(thickness > 0))
        return;
    p->thickness[*n] = thickness;
    p->from[*n] = from;
    p->strained[*n] = from != NONE;
    p->wanted[(*n)++] = wanted;
}

static void
cut(struct rc_strained *p, double depth)
{
    const struct rc_eigenstrain *e = p->task->options.strain;
    double t = thin * fmin(p->shape.dx, p->shape.dy), top = 0;
    bool found = false;
    size_t n = 0;

    for (size_t k = 0; k < e->slabs; k++) {
        double thick = e->thickness[k], slice = fmin(t, thick / 2);
        if (found || depth >= top + thick) {
            add(p, &n, thick, (int)k, false);
        } else {
            double above = fmin(fmax(depth - top - slice / 2, 0), thick - slice);
            add(p, &n, above, (int)k, false);
            add(p, &n, slice, (int)k, true);
            add(p, &n, thick - above - slice, (int)k, false);
            found = true;
        }
        top += thick;
    }
    if (!found) {
        add(p, &n, depth - top - t / 2, NONE, false);
        add(p, &n, t, NONE, true);
    }
    while (n < p->n)
        add(p, &n, p->shape.dx, NONE, false);
}

/* ---- rows ---- */

static bool
strain_row(void *ctx, size_t slab, enum rc_component c, size_t j, double *row)
{
    const struct rc_strained *p = ctx;
    const double *map = NULL;

    for (size_t a = 0; a < PARTS && p->from[slab] != NONE; a++)
        if (components[a] == c)
            map = p->task->options.strain->map[(size_t)p->from[slab] * PARTS + a];
    if (map == NULL)
        return false;
    memcpy(row, map + j * p->shape.nx, p->shape.nx * sizeof *row);
    return true;
}

/* How much of node k of n a plane at this place takes: what is linear in between. */
static double
share(size_t k, size_t n, double step, double at)
{
    double place = at / step + (double)(n - 1) / 2;

    return fmax(0, 1 - fabs((double)k - fmin(fmax(place, 0), (double)(n - 1))));
}

/* To a line of the plane, from a row of it or across it: two rows reach the same line. */
static void
add_to_plane(const struct rc_strained *p, size_t j, const double *s, double *line)
{
    const struct rc_stress_options *o = &p->task->options;
    size_t nx = p->shape.nx;
    double part = o->section == 'y' ? share(j, p->shape.ny, p->shape.dy, o->at) : 0;

    for (size_t i = 0; i < nx && part > 0; i++) {
#pragma omp atomic
        line[i] += part * s[i];
    }
    for (size_t i = 0; i < nx && o->section == 'x'; i++)
        line[j] += share(i, nx, p->shape.dx, o->at) * s[i];
}

static void
stress_row(void *ctx, size_t slab, size_t j, double *const s[RC_COMPONENTS])
{
    const struct rc_strained *p = ctx;
    size_t nx = p->shape.nx;

    (void)slab;
    for (int c = 0; c < RC_COMPONENTS; c++) {
        if (p->to[c] == NULL)
            continue;
        if (p->task->options.section != 0) {
            add_to_plane(p, j, s[c], p->to[c]);
            continue;
        }
        for (size_t i = 0; i < nx; i++)
            p->to[c][j * nx + i] += s[c][i];
    }
}

void
rc_strained_add(struct rc_strained *p, double depth, double *const to[RC_COMPONENTS])
{
    const struct rc_slab_strain strain = {p->strained, strain_row, p};
    const struct rc_slab_stress stress = {p->wanted, stress_row, p};

    cut(p, depth);
    p->to = to;
    rc_slabs_set(p->slabs, p->thickness);
    rc_slabs_up(p->slabs, &strain, NULL);
    rc_slabs_down(p->slabs, NULL, &stress);
}
