/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Selects the body type and combines the two bodies of a pair.
 */
#include "body.h"

#include <math.h>
#include <string.h>

#include "uniform.h"

static const struct rc_body_type *const types[] = {
#define RC_BODY(name) &rc_body_##name,
#include RC_BODIES_LIST
#undef RC_BODY
};

enum {
    TYPES = sizeof types / sizeof *types
};

const struct rc_body_type *
rc_body_type(const struct rc_body *body)
{
    size_t k = 0;

    while (k + 1 < TYPES && !types[k]->takes(body))
        k++;
    return types[k];
}

size_t
rc_body_material(const struct rc_body *b, double depth)
{
    double bottom = 0;
    size_t k = 0;

    while (k < b->layers && !rc_within(depth, bottom += b->layer[k].thickness))
        k++;
    return k;
}

/* ---- a pair, checked ---- */

/* The caller gave no values: it is rigid, or E* includes it. */
static bool
unsaid(const struct rc_body *b)
{
    return b->e == 0 && b->layers == 0;
}

/* True for a body that deforms under some wave. */
static bool
gives_way(const struct rc_body *b)
{
    const struct rc_body_type *type = rc_body_type(b);

    return !unsaid(b) && (type->compliance == NULL || type->compliance(b) > 0);
}

enum rc_status
rc_pair_check(const struct rc_pair *p, struct rc_err *err)
{
    if (p->estar != 0 || unsaid(&p->one)) {
        if (p->estar == 0 && !unsaid(&p->two))
            return rc_err_set(err, "body 2 is given and body 1 is not: give both, or E*");
        if (!unsaid(&p->one) || !unsaid(&p->two))
            return rc_err_set(err, "E* = %g Pa and the bodies are given: give one or the other",
                              p->estar);
        if (p->estar == 0)
            return rc_err_set(err, "E* and the Young's moduli of both bodies are 0: give E*, or E "
                                   "and nu of the bodies");
        if (!(p->estar > 0) || isinf(p->estar))
            return rc_err_set(err, "E* = %g Pa: it must be positive and finite", p->estar);
        return RC_OK;
    }
    if (rc_body_type(&p->one)->check(&p->one, RC_SURFACE, err) != RC_OK ||
        (!unsaid(&p->two) && rc_body_type(&p->two)->check(&p->two, RC_SURFACE, err) != RC_OK))
        return RC_FAIL;
    if (!gives_way(&p->one) && !gives_way(&p->two))
        return rc_err_set(err, "both bodies are rigid: give one of them a Young's modulus");
    return RC_OK;
}

bool
rc_pair_positive(const struct rc_pair *p)
{
    return p->estar > 0 || (rc_body_type(&p->one)->positive && rc_body_type(&p->two)->positive);
}

double
rc_pair_modulus(const struct rc_pair *p)
{
    const struct rc_body *bodies[] = {&p->one, &p->two};
    double compliance = 0;

    if (p->estar > 0)
        return p->estar;
    for (int k = 0; k < 2; k++)
        if (gives_way(bodies[k]))
            compliance += rc_body_type(bodies[k])->compliance == NULL
                              ? NAN
                              : rc_body_type(bodies[k])->compliance(bodies[k]);
    return 1 / compliance;
}

double
rc_pair_bends(const struct rc_pair *p, double side)
{
    const struct rc_body *bodies[] = {&p->one, &p->two};
    double most = 0;

    for (int k = 0; k < 2; k++) {
        const struct rc_body_type *type = rc_body_type(bodies[k]);
        if (gives_way(bodies[k]) && type->bends != NULL)
            most = fmax(most, type->bends(bodies[k], side));
    }
    return most;
}

/* ---- made ready ---- */

/* Combines the uniform bodies into one, of `compliance`; the others stay separate. */
static enum rc_status
make(struct rc_solids *s, const struct rc_pair *p, struct rc_err *err)
{
    const struct rc_body *bodies[] = {&p->one, &p->two};
    double compliance = 0;

    for (int k = 0; k < 2; k++) {
        const struct rc_body_type *type = rc_body_type(bodies[k]);
        if (!gives_way(bodies[k]))
            continue;
        if (type->compliance != NULL)
            compliance += type->compliance(bodies[k]);
        else if ((s->solid[s->n++] = type->new (bodies[k], err)) == NULL)
            return RC_FAIL;
    }
    if (p->estar > 0 || compliance > 0)
        s->solid[s->n++] = rc_uniform_new(p->estar > 0 ? p->estar : 1 / compliance, err);
    return s->n == 0 || s->solid[s->n - 1] == NULL ? RC_FAIL : RC_OK;
}

enum rc_status
rc_solids_new(struct rc_solids *s, const struct rc_pair *pair, const struct rc_along *along,
              const struct rc_ranks *ranks, struct rc_err *err)
{
    *s = (struct rc_solids){.along = along};
    return rc_ranks_agree(ranks, make(s, pair, err), err);
}

void
rc_solids_free(struct rc_solids *s)
{
    for (size_t k = 0; k < s->n; k++)
        rc_solid_free(s->solid[k]);
    s->n = 0;
}

/* The sum of 1/E* of both; a single E* is returned to the last bit. */
static double
together(size_t n, const double estar[2])
{
    return n == 1 ? estar[0] : 1 / (1 / estar[0] + 1 / estar[1]);
}

double
rc_solids_modulus(const struct rc_solids *s, double q)
{
    double estar[2];

    for (size_t k = 0; k < s->n; k++)
        estar[k] = s->solid[k]->type->modulus(s->solid[k], q);
    return together(s->n, estar);
}

double
rc_solids_modulus_of(const struct rc_solids *s, double q2)
{
    double estar[2];

    for (size_t k = 0; k < s->n; k++)
        estar[k] = s->solid[k]->type->modulus_of(s->solid[k], q2);
    return together(s->n, estar);
}

double
rc_solids_softest(const struct rc_solids *s)
{
    double estar[2];

    for (size_t k = 0; k < s->n; k++)
        estar[k] = s->solid[k]->type->softest(s->solid[k]);
    return together(s->n, estar) / (s->along != NULL ? s->along->most : 1);
}

/* ---- the kernel of displacement ---- */

static void
rows(const void *of, const struct rc_lattice *at, size_t n, size_t first, size_t last, double *out)
{
    const struct rc_surface *u = of;
    const struct rc_along *along = u->solids->along;

    memset(out, 0, (last - first) * n * sizeof *out);
    for (size_t k = 0; k < u->solids->n; k++) {
        const struct rc_solid *s = u->solids->solid[k];
        s->type->add_rows(s, u->length, u->modulus, at, n, first, last, out);
    }
    for (size_t k = 0; along != NULL && along->at != NULL && k < (last - first) * n; k++)
        out[k] *=
            along->at(along->of, at->dx * u->length, (double)(k % n * at->sx) * at->dx * u->length,
                      (double)((first + k / n) * at->sy) * at->dy * u->length);
}

/* Westergaard 1939: a wave of pressure of wave number q makes a wave of displacement 2 / (E* q) as
 * high. */
static double
symbol(const void *of, double qx, double qy)
{
    const struct rc_surface *u = of;
    const struct rc_along *along = u->solids->along;
    double q = hypot(qx, qy), q2 = q / u->length * (q / u->length);
    double factor = along != NULL ? along->factor(along->of, qx / u->length) : 1;

    return factor * 2 / (rc_solids_modulus_of(u->solids, q2) / u->modulus * q);
}

struct rc_kernel
rc_surface_kernel(const struct rc_surface *u)
{
    return (struct rc_kernel){.of = u, .rows = rows, .symbol = symbol};
}

/* ---- stresses inside ---- */

const enum rc_component rc_stress_exchanged[RC_COMPONENTS] = {RC_SYY, RC_SXX, RC_SZZ,
                                                              RC_SXY, RC_SYZ, RC_SXZ};

int
rc_stress_unturned(int kernel)
{
    return rc_stress_turned(kernel) ? (int)RC_SHEAR * (int)RC_COMPONENTS +
                                          (int)rc_stress_exchanged[kernel % RC_COMPONENTS]
                                    : kernel;
}

static void
symbols(const struct rc_inside *in, int kernel, const struct rc_waves *w, double *out)
{
    const struct rc_waves turned = {w->n, w->y, w->x, w->q, w->numbers};

    in->type->symbol(in, rc_stress_unturned(kernel), rc_stress_turned(kernel) ? &turned : w, out);
}

void
rc_inside_symbol(const struct rc_inside *in, int kernel, const struct rc_waves *waves,
                 const struct rc_shape *shape, double *out)
{
    const struct rc_shape turned = {shape->ny, shape->nx, shape->dy, shape->dx};

    symbols(in, kernel, waves, out);
    if (waves->q[0] == 0)
        out[0] = in->type->mean(in, rc_stress_unturned(kernel),
                                rc_stress_turned(kernel) ? &turned : shape);
}

/* Sxz under a traction along y equals syz under one along x: both change sides with x and y. */
int
rc_stress_kernel(const struct rc_inside_type *type, int load, int component)
{
    if (type->shares && load != RC_NORMAL && component == RC_SZZ)
        return load == RC_SHEAR ? RC_SXZ : RC_SYZ;
    if (load == RC_TURNED && component == RC_SXZ)
        return (int)RC_SHEAR * (int)RC_COMPONENTS + (int)RC_SYZ;
    return load * RC_COMPONENTS + component;
}

unsigned
rc_stress_distinct(const struct rc_inside_type *type, unsigned components, unsigned loads)
{
    unsigned kernels = 0;

    for (int c = 0; c < RC_COMPONENTS; c++)
        for (int load = 0; load < RC_LOADS; load++)
            if (components >> c & 1 && loads >> load & 1)
                kernels |= 1u << rc_stress_kernel(type, load, c);
    return kernels;
}

static void
stress_rows(const void *of, const struct rc_lattice *at, size_t n, size_t first, size_t last,
            double *out)
{
    const struct rc_stress_field *f = of;
    const struct rc_cell cell = {at->dx, at->dy};
    double *to[RC_STRESS_KERNELS] = {NULL};

    for (size_t j = first; j < last; j++) {
        to[f->kernel] = out + (j - first) * n;
        f->inside->type->line(f->inside, &cell, 1u << f->kernel, (double)at->sx * at->dx, n,
                              (double)(j * at->sy) * at->dy, to);
    }
}

static double
stress_symbol(const void *of, double qx, double qy)
{
    const struct rc_stress_field *f = of;
    double x, y, q, out, numbers[RC_WAVE_NUMBERS];
    const struct rc_waves wave = {1, &x, &y, &q, numbers};

    rc_wave_directions(1, &qx, &qy, &x, &y, &q);
    f->inside->type->waves(f->inside, 1, &q, numbers);
    symbols(f->inside, f->kernel, &wave, &out);
    return out;
}

struct rc_kernel
rc_stress_field_kernel(const struct rc_stress_field *f)
{
    return (struct rc_kernel){.of = f,
                              .parity = rc_stress_parity[f->kernel],
                              .rows = stress_rows,
                              .symbol = stress_symbol};
}
