/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Adds the stress due to plastic strain in slabs to the stress of the pressure. One sweep goes up through the
 * slabs, and one down for all depths.
 */
#include <stdlib.h>
#include <string.h>

#include "libcontact/volume/volume.h"
#include "stress.h"

enum {
    PARTS = 5 /* maps of a slab */
};

struct rc_strained {
    const struct rc_stress_task *task;
    struct rc_shape shape; /* rows held here */
    struct rc_slabs *slabs;
    double *const *to; /* where the stresses are added */
};

static const enum rc_component components[PARTS] = {RC_SXX, RC_SYY, RC_SXY, RC_SXZ, RC_SYZ};

enum rc_status
rc_strained_check(const struct rc_stress_options *o, struct rc_err *err)
{
    const struct rc_eigenstrain *e = o->strain;

    if (e == NULL)
        return RC_OK;
    if (o->body.layers > 0)
        return rc_err_set(err,
                          "the stress of plastic strain is not implemented for bodies with layers");
    if (!(o->body.e > 0) || isinf(o->body.e))
        return rc_err_set(err, "the stress of plastic strain needs the body's Young's modulus");
    if (e->slabs == 0)
        return rc_err_set(err, "plastic strain in no slab");
    return RC_OK;
}

static struct rc_slabs_options
slabs_options(const struct rc_stress_options *o)
{
    return (struct rc_slabs_options){.slabs = o->strain->slabs,
                                     .thickness = o->strain->thickness,
                                     .shear = o->body.e / (2 * (1 + o->body.nu)),
                                     .nu = o->body.nu,
                                     .boundary = o->boundary,
                                     .slices = true,
                                     .threads = o->threads,
                                     .ranks = o->ranks};
}

/* ---- strain ---- */

static const double *
strain_map(const struct rc_strained *p, size_t slab, size_t part)
{
    return p->task->options.strain->map[slab * PARTS + part];
}

static bool
strain_row(void *ctx, size_t slab, enum rc_component c, size_t j, double *row)
{
    const struct rc_strained *p = ctx;
    const double *map = NULL;

    for (size_t a = 0; a < PARTS; a++)
        if (components[a] == c)
            map = strain_map(p, slab, a);
    if (map == NULL)
        return false;
    memcpy(row, map + j * p->shape.nx, p->shape.nx * sizeof *row);
    return true;
}

/* Makes both sweeps. `strained` has an entry for each slab. */
static void
sweep(struct rc_strained *p, bool *strained)
{
    const struct rc_slab_strain strain = {strained, strain_row, p};

    for (size_t k = 0; k < p->task->options.strain->slabs; k++) {
        strained[k] = false;
        for (size_t a = 0; a < PARTS; a++)
            strained[k] = strained[k] || strain_map(p, k, a) != NULL;
    }
    rc_slabs_up(p->slabs, &strain, NULL);
    rc_slabs_through(p->slabs);
}

struct rc_strained *
rc_strained_new(const struct rc_stress_task *task, struct rc_err *err)
{
    const struct rc_slabs_options options = slabs_options(&task->options);
    const struct rc_rows rows = rc_rows_of(task->options.ranks, &task->shape);
    RC_OWN(rc_strained, p) = calloc(1, sizeof *p);
    RC_OWNED bool *strained = calloc(options.slabs, sizeof *strained);

    if (rc_ranks_need(task->options.ranks, p != NULL && strained != NULL, err,
                      "out of memory for a plan") != RC_OK)
        return NULL;
    *p = (struct rc_strained){.task = task, .shape = rc_rows_shape(&rows, &task->shape)};
    if ((p->slabs = rc_slabs_new(&task->shape, &options, err)) == NULL)
        return NULL;
    sweep(p, strained);
    return rc_give(&p);
}

void
rc_strained_free(struct rc_strained *p)
{
    if (p == NULL)
        return;
    rc_slabs_free(p->slabs);
    free(p);
}

/* ---- stress ---- */

/* The weight of node k of n in a plane at this position, by linear interpolation. */
static double
share(size_t k, size_t n, double step, double at)
{
    double place = at / step + (double)(n - 1) / 2;

    return fmax(0, 1 - fabs((double)k - fmin(fmax(place, 0), (double)(n - 1))));
}

/* Adds a row to a line of the plane, along it or across it: two rows contribute to the same line. */
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
stress_row(void *ctx, enum rc_component c, size_t j, const double *row)
{
    const struct rc_strained *p = ctx;
    size_t nx = p->shape.nx;

    if (p->task->options.section != 0) {
        add_to_plane(p, j, row, p->to[c]);
        return;
    }
    for (size_t i = 0; i < nx; i++)
        p->to[c][j * nx + i] += row[i];
}

void
rc_strained_add(struct rc_strained *p, double depth, double *const to[RC_COMPONENTS])
{
    const struct rc_slice_stress stress = {p->task->components, stress_row, p};

    p->to = to;
    rc_slabs_slice(p->slabs, depth, &stress);
}

void
rc_strained_count(const struct rc_strained *p, struct rc_stress_counts *counts)
{
    const struct rc_slabs_counts *c = rc_slabs_counted(p->slabs);

    counts->strain_transforms = c->forward;
    counts->strain_field_transforms = c->back;
}
