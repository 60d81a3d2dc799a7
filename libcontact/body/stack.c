/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The frequency response of a stack of bonded isotropic layers, by recursion from the bottom up.
 *
 * In a wave of wave number q along l the displacements are U sin(q l) and W cos(q l). The tractions from
 * above on a plane are f = (fx, fz). Everything below a plane responds by (U, W) = Y f. The recursion uses
 * not Y but its minors
 *
 *     y = (a, b, c, d, e):  Y_xx = c/e,  Y_zz = b/e,  Y_xz = -d/e,  det Y = a/e
 *
 * so that no differences of large numbers appear. Displacements are in units of 1/q, stresses in units of the
 * shear modulus of the medium; M is the matrix of dy/d(q z).
 */
#include "stack.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "octaves.h"
#include "radial.h"

/* Constants of a medium. */
struct medium {
    double alpha, beta, gamma;
};

static struct medium
medium_of(double nu)
{
    return (struct medium){(1 - 2 * nu) / (2 * (1 - nu)), nu / (1 - nu), 2 / (1 - nu)};
}

struct minors {
    double a, b, c, d, e;
};

/* A half-space of this material; a rigid one does not deform. */
static struct minors
half_space(const struct rc_material *m)
{
    if (isinf(m->modulus))
        return (struct minors){0, 0, 0, 0, 1};
    return (struct minors){(3 - 4 * m->nu) / 4, 1 - m->nu, 1 - m->nu, (1 - 2 * m->nu) / 2, 1};
}

/* The minors at the same plane for the medium above, whose shear modulus is r times that below. */
static struct minors
change_medium(struct minors y, double r)
{
    return (struct minors){y.a * r * r, y.b * r, y.c * r, y.d * r, y.e};
}

static struct minors
times_m(const struct medium *m, struct minors y)
{
    return (struct minors){y.b + m->alpha * y.c,
                           m->gamma * y.a - 2 * m->beta * y.d + m->alpha * y.e, y.e + 2 * y.d,
                           y.b - m->beta * y.c, m->gamma * y.c};
}

static struct minors
plus(struct minors y, double k, struct minors z)
{
    return (struct minors){y.a + k * z.a, y.b + k * z.b, y.c + k * z.c, y.d + k * z.d,
                           y.e + k * z.e};
}

/* exp(-2x) (sinh 2x - 2x)/8 and exp(-2x) (cosh 2x - 1 - 2 x^2)/16. */
static void
third_and_fourth(double x, double th, double *p3, double *p4)
{
    double far = x < 1000 ? x : 1000, term, s3 = 0, s4 = 0, x2 = 2 * x;

    if (x > 1) {
        *p3 = ((1 - th * th) / 2 - 2 * far * th) / 8;
        *p4 = ((1 - th) * (1 - th) / 2 - 2 * far * far * th) / 16;
        return;
    }
    term = x2 * x2 * x2 / 6; /* (2x)^3 / 3! */
    for (int k = 0; k < 13; k++) {
        s3 += term;
        term *= x2 / (2 * k + 4);
        s4 += term;
        term *= x2 / (2 * k + 5);
    }
    *p3 = th * s3 / 8;
    *p4 = th * s4 / 16;
}

/* Goes from the bottom of a layer to its top, x = q t. e is divided by its growth and stays 1; *grown is this
 * growth times exp(-2x). */
static struct minors
through(struct minors y, const struct medium *m, double x, double *grown)
{
    double th = exp(-2 * x), far = x < 1000 ? x : 1000, p3, p4;
    struct minors y1 = times_m(m, y), y2 = times_m(m, y1), y3 = times_m(m, y2), y4 = times_m(m, y3);
    struct minors top = {th * y.a, th * y.b, th * y.c, th * y.d, th * y.e};

    third_and_fourth(x, th, &p3, &p4);
    top = plus(top, far * th, y1);
    top = plus(top, far * far * th / 2, y2);
    top = plus(top, p3, y3);
    top = plus(top, p4, y4);
    *grown = top.e;
    return (struct minors){top.a / top.e, top.b / top.e, top.c / top.e, top.d / top.e, 1};
}

/* Minors at the surface. */
static struct minors
surface(const struct rc_stack *s, double q)
{
    struct minors y = half_space(&s->material[s->layers]);
    double grown;

    for (size_t k = s->layers; k-- > 0;) {
        const struct rc_material *m = &s->material[k];
        struct medium constants = medium_of(m->nu);
        if (!isinf(s->material[k + 1].modulus))
            y = change_medium(y, m->modulus / s->material[k + 1].modulus);
        y = through(y, &constants, q * m->thickness, &grown);
    }
    return y;
}

double
rc_stack_response(const struct rc_stack *s, double q)
{
    struct minors y = surface(s, q);

    return y.b / (2 * y.e * s->material[0].modulus);
}

double
rc_stack_excess(const struct rc_stack *s, double q)
{
    return rc_stack_response(s, q) - s->top;
}

void
rc_stack_responses(const struct rc_stack *s, size_t n, const double *q2, double *g)
{
    rc_octaves_values(s->response_table, n, q2, g);
}

/* ---- inside ---- */

size_t
rc_stack_medium(const struct rc_stack *s, double depth)
{
    double bottom = 0;
    size_t k = 0;

    while (k < s->layers && !rc_within(depth, bottom += s->material[k].thickness))
        k++;
    return k;
}

double
rc_stack_top(const struct rc_stack *s, size_t medium)
{
    double top = 0;

    for (size_t k = 0; k < medium; k++)
        top += s->material[k].thickness;
    return top;
}

/* Tractions per unit load: on a plane along the wave and down, and across the wave. */
struct traction {
    double x, z, across;
};
/* The response below a plane: minors with e = 1, and the number of the shear across the wave. */
struct below {
    struct minors y;
    double across;
};

static struct below
below_all(const struct rc_material *substrate)
{
    return (struct below){half_space(substrate), isinf(substrate->modulus) ? 0 : 1};
}

/* The response at the same plane for the medium `above` it. */
static struct below
seen_from(const struct rc_material *above, const struct rc_material *m, struct below b)
{
    double r = isinf(m->modulus) ? 0 : above->modulus / m->modulus;

    if (r == 0)
        return b;
    return (struct below){change_medium(b.y, r), b.across * r};
}

/* Goes from below a piece, x = q h, to its top. */
static struct below
above_piece(struct below b, const struct medium *m, double x)
{
    double th = exp(-2 * x), grown;

    b.y = through(b.y, m, x, &grown);
    b.across = (b.across * (1 + th) + (1 - th)) / ((1 + th) + b.across * (1 - th));
    return b;
}

struct state {
    double u, w, fx, fz;
};

static struct state
times_q(const struct medium *m, struct state v)
{
    return (struct state){v.fx - v.w, m->alpha * v.fz + m->beta * v.u,
                          m->gamma * v.u - m->beta * v.fz, v.fx};
}

/* x cosh x - sinh x, times exp(-x). */
static double
third(double x, double ch, double sh)
{
    double term = x, sum = 0; /* x^(2k + 1)/(2k + 1)! */

    if (x >= 1)
        return x * ch - sh;
    for (int k = 1; k <= 10; k++) {
        term *= x * x / (2 * k * (2 * k + 1));
        sum += 2 * k * term;
    }
    return exp(-x) * sum;
}

/* The tractions on a plane in exp(x Q) v, times exp(-x). */
static struct traction
carried(const struct medium *m, double x, struct state v)
{
    double th = exp(-2 * x), ch = (1 + th) / 2, sh = (1 - th) / 2;
    double k3 = third(x, ch, sh) / 2, k0 = ch - x * sh / 2, k1 = sh - k3, k2 = x * sh / 2;
    struct state v1 = times_q(m, v), v2 = times_q(m, v1), v3 = times_q(m, v2);

    return (struct traction){.x = k0 * v.fx + k1 * v1.fx + k2 * v2.fx + k3 * v3.fx,
                             .z = k0 * v.fz + k1 * v1.fz + k2 * v2.fz + k3 * v3.fz};
}

/* Goes from the top of a piece, x = q h, to its bottom, with the response b below. */
static struct traction
down_piece(struct traction f, struct below b, const struct medium *m, double x)
{
    struct traction c1 = carried(m, x, (struct state){b.y.c, -b.y.d, 1, 0});
    struct traction c2 = carried(m, x, (struct state){-b.y.d, b.y.b, 0, 1});
    double th = exp(-2 * x), decay = exp(-x), grown;

    through(b.y, m, x, &grown);
    return (struct traction){.x = decay / grown * (c2.z * f.x - c2.x * f.z),
                             .z = decay / grown * (c1.x * f.z - c1.z * f.x),
                             .across = 2 * decay / ((1 + th) + b.across * (1 - th)) * f.across};
}

/* Computes tractions at the bottom of layer j: f[0] under the pressure and f[1] under the shear. b is the
 * response below, in the units of layer j. The recursion goes up to the surface and then down. */
static void
go_down(const struct rc_stack *s, double q, size_t j, struct below b, struct traction f[2])
{
    const struct rc_material *m = &s->material[j];
    struct medium constants = medium_of(m->nu);
    double x = q * m->thickness;

    if (j > 0)
        go_down(s, q, j - 1, seen_from(m - 1, m, above_piece(b, &constants, x)), f);
    for (int load = 0; load < 2; load++)
        f[load] = down_piece(f[load], b, &constants, x);
}

void
rc_stack_inside(const struct rc_stack *s, size_t medium, double depth, double q, size_t n,
                double *out)
{
    const struct rc_material *m = &s->material[medium];
    struct medium constants = medium_of(m->nu);
    double h = fmin(fmax(depth - rc_stack_top(s, medium), 0), m->thickness);
    struct traction f[2] = {{0, 1, 0}, {1, 0, 1}};
    struct below b = below_all(&s->material[s->layers]), at;

    for (size_t k = s->layers; k > medium; k--) {
        if (k < s->layers) {
            struct medium c = medium_of(s->material[k].nu);
            b = above_piece(b, &c, q * s->material[k].thickness);
        }
        b = seen_from(&s->material[k - 1], &s->material[k], b);
    }
    at = medium == s->layers ? b : above_piece(b, &constants, q * (m->thickness - h));
    if (medium > 0)
        go_down(s, q, medium - 1, seen_from(m - 1, m, above_piece(at, &constants, q * h)), f);
    for (int load = 0; load < 2; load++) {
        f[load] = down_piece(f[load], at, &constants, q * h);
        if (load == 1 && n <= RC_UNDER_PRESSURE)
            break;
        double *to = out + (load == 0 ? RC_P_S : RC_T_S);
        double u = at.y.c * f[load].x - at.y.d * f[load].z;
        to[RC_P_S] = -f[load].z;
        to[RC_P_T] = -f[load].x;
        to[RC_P_L] = constants.beta * to[RC_P_S] + constants.gamma * u;
        to[RC_P_N] = m->nu * (to[RC_P_S] + to[RC_P_L]);
    }
    if (n > RC_UNDER_PRESSURE) {
        out[RC_T_R] = f[1].across;
        out[RC_T_V] = at.across * f[1].across;
    }
}

/* ---- at a distance ---- */

/* The product q t above which a wave does not reach below the top layer: exp(-2 q t) = 2e-22 is far
 * below rounding. */
static const double thick = 25;

static void
difference(const void *ctx, double q, double *g)
{
    *g = rc_stack_excess(ctx, q) / (RC_PI * q);
}

/* D(r) = 1/pi integral of (g - g(infinity)) J_0(q r) dq. The integrand decreases as exp(-2 q t), t the
 * thickness of the top layer. */
static struct rc_radial *
far(const struct rc_stack *s)
{
    static const int order = 0;
    struct rc_radial_source source = {.n = 1,
                                      .order = &order,
                                      .scale = 2 * s->material[0].thickness,
                                      .unit = s->material[0].thickness,
                                      .last = thick,
                                      .tail = (s->bottom - s->top) / RC_PI,
                                      .wave = difference,
                                      .ctx = s};

    return rc_radial_new(&source);
}

void
rc_stack_far(const struct rc_stack *s, size_t n, const double *r2, double *d)
{
    rc_octaves_values(s->far_table, n, r2, d);
}

/* ---- tables ---- */

static double
far_of(const void *ctx, double r2)
{
    const struct rc_stack *s = ctx;
    double r = sqrt(r2), d;

    rc_radial_values(s->far, 1, &r, &d);
    return d;
}

static double
response_of(const void *ctx, double q2)
{
    const struct rc_stack *s = ctx;
    double q = sqrt(q2);

    return q * s->material[0].thickness > thick ? s->top : rc_stack_response(s, q);
}

/* D is tabulated from the end of its power series to a million times the top layer. g is tabulated between
 * waves so long that the layers hardly matter and waves so short that only the top layer matters. */
static enum rc_status
tables(struct rc_stack *s)
{
    double t = s->material[0].thickness, all = 0;

    for (size_t k = 0; k < s->layers; k++)
        all += s->material[k].thickness;
    s->far_table = rc_octaves_new(pow(t / 4, 2), pow(1e6 * t, 2), far_of, s);
    s->response_table = rc_octaves_new(pow(1e-3 / all, 2), pow(thick / t, 2), response_of, s);
    return s->far_table == NULL || s->response_table == NULL ? RC_FAIL : RC_OK;
}

/* ---- from a body ---- */

static enum rc_status
check_material(const char *what, double e, double nu, bool rigid, struct rc_err *err)
{
    if (!(e > 0) || (isinf(e) && !rigid))
        return rc_err_set(err, "Young's modulus of %s is %g Pa: it must be positive and finite",
                          what, e);
    if (!(nu > -1 && nu <= 0.5))
        return rc_err_set(err, "Poisson's ratio of %s is %g: it must be above -1 and at most 0.5",
                          what, nu);
    return RC_OK;
}

enum rc_status
rc_stack_check(const struct rc_body *b, struct rc_err *err)
{
    char what[64];

    for (size_t k = 0; k < b->layers; k++) {
        snprintf(what, sizeof what, "layer %zu", k + 1);
        if (!(b->layer[k].thickness > 0) || isinf(b->layer[k].thickness))
            return rc_err_set(err, "%s is %g m thick: it must be positive and finite", what,
                              b->layer[k].thickness);
        if (check_material(what, b->layer[k].e, b->layer[k].nu, false, err) != RC_OK)
            return RC_FAIL;
    }
    return check_material("the substrate", b->e, b->nu, true, err);
}

/* 1/E* of one material. */
static double
compliance_of(const struct rc_material *m)
{
    return isinf(m->modulus) ? 0 : (1 - m->nu) / (2 * m->modulus);
}

struct rc_stack *
rc_stack_new(const struct rc_body *c, struct rc_err *err)
{
    static const char message[] = "out of memory for a stack of %zu layers";
    RC_OWN(rc_stack, s) = calloc(1, sizeof *s);

    if (s == NULL || (s->material = calloc(c->layers + 1, sizeof *s->material)) == NULL)
        return rc_err_null(err, message, c->layers);
    s->layers = c->layers;
    for (size_t k = 0; k < c->layers; k++)
        s->material[k] = (struct rc_material){
            c->layer[k].thickness, c->layer[k].e / (2 * (1 + c->layer[k].nu)), c->layer[k].nu};
    s->material[c->layers] = (struct rc_material){INFINITY, c->e / (2 * (1 + c->nu)), c->nu};
    s->top = compliance_of(&s->material[0]);
    s->bottom = compliance_of(&s->material[c->layers]);
    if ((s->far = far(s)) == NULL || tables(s) != RC_OK)
        return rc_err_null(err, message, c->layers);
    return rc_give(&s);
}

void
rc_stack_free(struct rc_stack *s)
{
    if (s == NULL)
        return;
    rc_octaves_free(s->far_table);
    rc_octaves_free(s->response_table);
    rc_radial_free(s->far);
    free(s->material);
    free(s);
}
