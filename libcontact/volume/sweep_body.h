/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The sweeps in one precision: the including file defines REAL and its constants.
 *
 * q is a wave vector in the plane, c = qx/q, d = qy/q; axes s along q and t across. Of strain and
 * stress
 *
 *     ss = c^2 xx + d^2 yy + 2cd xy    st = cd (yy - xx) + (c^2 - d^2) xy    sz = -i (c xz + d yz)
 *     tt = d^2 xx + c^2 yy - 2cd xy                                          tz = -i (c yz - d xz)
 *
 * so that all coefficients below are real. Real parts of ss, tt, zz and st belong to imaginary parts of xz
 * and yz. Each half is computed separately, and differs by a sign in these two.
 *
 * Three waves travel down and three up. w are their amplitudes times q, D is the distance from the depth
 * where they are known, and x = q D. Their stress over 2 mu exp(-x), with f = 1 for downward and -1 for
 * upward waves:
 *
 *     ss = -w1 + (x - 2 nu) w2    zz = w1 - (2 (1 - nu) + x) w2    sz = f (-w1 + (1 - 2 nu + x) w2)
 *     tt = -2 nu w2               st = -w3/2                       tz = -f w3/2
 *
 * After the distance D they are exp(-x) (w1 - x w2, w2, w3). A sheet of strain e dz emits, over q dz,
 *
 *     down (S1/2 + sz, (S2 + D2)/2, tz - st)    S2 = (zz - ss)/(2 (1 - nu))    D2 = sz/(1 - nu)
 *     up   (S1/2 - sz, (S2 - D2)/2, -tz - st)   S1 = (3 - 4 nu) S2 - (1 - 2 nu) zz/(1 - nu)
 *
 * and causes the stress -2 mu (e_ab + nu/(1 - nu) (exx + eyy) delta_ab), a, b = x, y, in its own plane. At
 * the surface
 *
 *     down1 = (3 - 4 nu) up1 - 4 (1 - nu)(1 - 2 nu) up2 + (1 - 2 nu) p/(2 mu)
 *     down2 = 2 up1 - (3 - 4 nu) up2 + p/(2 mu)          down3 = up3
 *     u = 4 (1 - nu) (up1 - 2 (1 - nu) up2)/q
 *
 * in addition to K p. Integrals over a slab, with x = q h, E = exp(-x) and F_n = sum over k of (-x)^k/(k +
 * n)!, so that E = 1 - x F1, F1 = 1 - x F2, F2 = 1/2 - x F3: of the emitted waves, for the factors 1 and x,
 * g0 = x F1, g1 = x^2 (F1 - F2); of the mean of outside waves m0 = F1, m1 = x (F1 - F2); of the mean of its
 * own waves j0 = x F2, j1 = x^2 (F2 - 2 F3).
 */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "libcontact/common.h"
#include "sweep.h"

enum {
    BLOCK = 64 /* waves that pass the slabs of a group together; they fit into the first cache */
};

/* ---- coefficients ---- */

struct way {
    REAL q[BLOCK], alive[BLOCK];
    REAL c[BLOCK], d[BLOCK], cc[BLOCK], dd[BLOCK], cd[BLOCK], c2[BLOCK]; /* c2: cc - dd */
};

struct slab_of {
    REAL e[BLOCK], ex[BLOCK]; /* E, x E */
    REAL g0[BLOCK], g1[BLOCK], m0[BLOCK], m1[BLOCK], j0[BLOCK], j1[BLOCK];
};

RC_WIDE_CLONES static void
set_way(const struct rc_sweep_column *column, size_t first, size_t n, struct way *w)
{
    double qx = column->qx, on = column->dead ? 0 : 1;

#pragma omp simd
    for (size_t k = 0; k < n; k++) {
        double qy = column->qy[first + k], q2 = qx * qx + qy * qy;
        double mean = q2 > 0 ? 0 : 1,
               q = sqrt(q2 + mean); /* for wave number 0 the direction is arbitrary */
        double over = 1 / q, c = (qx + mean) * over, d = qy * over;
        w->q[k] = (REAL)q;
        w->alive[k] = (REAL)(on * column->alive[first + k] * (1 - mean));
        w->c[k] = (REAL)c;
        w->d[k] = (REAL)d;
        w->cc[k] = (REAL)(c * c);
        w->dd[k] = (REAL)(d * d);
        w->cd[k] = (REAL)(c * d);
        w->c2[k] = (REAL)(c * c - d * d);
    }
}

/* exp(-x), 0 <= x: 2^-n exp(r), |r| <= log(2)/2. */
static inline REAL
decay(REAL x)
{
    const REAL shift = SHIFT, high = (REAL)0x1.62ep-1, /* few digits, so that products are exact */
        low = (REAL)(0.693147180559945309417 - 0x1.62ep-1);
    REAL y = x < (REAL)DEEPEST ? x : (REAL)DEEPEST;
    REAL u = shift - y * (REAL)1.44269504088896340736, n = u - shift;
    REAL r = (-y - n * high) - n * low, s;
    BITS a, b;

#if LONG
    s = 1. / 6227020800.;
    s = 1. / 479001600. + r * s;
    s = 1. / 39916800. + r * s;
    s = 1. / 3628800. + r * s;
    s = 1. / 362880. + r * s;
    s = 1. / 40320. + r * s;
    s = 1. / 5040. + r * s;
#else
    s = (REAL)(1. / 5040.);
#endif
    s = (REAL)(1. / 720.) + r * s;
    s = (REAL)(1. / 120.) + r * s;
    s = (REAL)(1. / 24.) + r * s;
    s = (REAL)(1. / 6.) + r * s;
    s = (REAL)(1. / 2.) + r * s;
    s = 1 + r * s;
    s = 1 + r * s;
    memcpy(&a, &u, sizeof a); /* the last digits of a hold n */
    memcpy(&b, &s, sizeof b);
    b += a << MANTISSA;
    memcpy(&s, &b, sizeof s);
    return x < (REAL)DEEPEST ? s : 0;
}

/* F3 for 0 <= x <= 1. */
static inline REAL
series(REAL x)
{
    REAL s;

#if LONG
    s = 1. / 6402373705728000.;
    s = 1. / 355687428096000. - x * s;
    s = 1. / 20922789888000. - x * s;
    s = 1. / 1307674368000. - x * s;
    s = 1. / 87178291200. - x * s;
    s = 1. / 6227020800. - x * s;
    s = 1. / 479001600. - x * s;
    s = 1. / 39916800. - x * s;
#else
    s = (REAL)(1. / 39916800.);
#endif
    s = (REAL)(1. / 3628800.) - x * s;
    s = (REAL)(1. / 362880.) - x * s;
    s = (REAL)(1. / 40320.) - x * s;
    s = (REAL)(1. / 5040.) - x * s;
    s = (REAL)(1. / 720.) - x * s;
    s = (REAL)(1. / 120.) - x * s;
    s = (REAL)(1. / 24.) - x * s;
    return (REAL)(1. / 6.) - x * s;
}

RC_WIDE_CLONES static void
set_slab(const struct way *w, double thickness, size_t n, struct slab_of *s)
{
    REAL h = (REAL)thickness;

#pragma omp simd
    for (size_t k = 0; k < n; k++) {
        REAL x = w->q[k] * h, on = w->alive[k], over = 1 / x;
        REAL near = series(x < 1 ? x : 1), far = decay(x);
        REAL a1 = (1 - far) * over, a2 = (1 - a1) * over, a3 = ((REAL)0.5 - a2) * over;
        REAL f3 = x < 1 ? near : a3, f2 = x < 1 ? (REAL)0.5 - x * f3 : a2;
        REAL f1 = x < 1 ? 1 - x * f2 : a1, e = x < 1 ? 1 - x * f1 : far;
        REAL m1 = x * (f1 - f2), j1 = x * (f2 - 2 * f3);
        s->e[k] = on * e;
        s->ex[k] = on * x * e;
        s->g0[k] = on * x * f1;
        s->g1[k] = on * x * m1;
        s->m0[k] = on * f1;
        s->m1[k] = on * m1;
        s->j0[k] = on * x * f2;
        s->j1[k] = on * x * j1;
    }
}

/* ---- one half of the waves: the real one (sign 1) or the imaginary one (-1) ---- */

struct strain {
    REAL ss[BLOCK], zz[BLOCK], st[BLOCK], sz[BLOCK], tz[BLOCK];
};

struct waves {
    REAL w1[BLOCK], w2[BLOCK], w3[BLOCK];
};

/* The addresses of one half of the numbers of a slab; for xz and yz of the other half. */
struct half {
    REAL sign;
    REAL *xx, *yy, *xy, *xz, *yz, *zz;
};

static struct half
half_of(const struct rc_sweep_slab *slab, size_t length, size_t first, bool imaginary)
{
    size_t here = first + (imaginary ? length : 0), there = first + (imaginary ? 0 : length);
    REAL *zz = slab->zz;

    return (struct half){.sign = imaginary ? -1 : 1,
                         .xx = (REAL *)slab->strain[0] + here,
                         .yy = (REAL *)slab->strain[1] + here,
                         .xy = (REAL *)slab->strain[2] + here,
                         .xz = (REAL *)slab->strain[3] + there,
                         .yz = (REAL *)slab->strain[4] + there,
                         .zz = zz == NULL ? NULL : zz + here};
}

RC_WIDE_CLONES static void
turn_strain(const struct way *w, const struct half *from, size_t n, struct strain *e)
{
    const REAL *xx = from->xx, *yy = from->yy, *xy = from->xy, *xz = from->xz, *yz = from->yz;
    REAL sign = from->sign;

#pragma omp simd
    for (size_t k = 0; k < n; k++) {
        e->ss[k] = w->cc[k] * xx[k] + w->dd[k] * yy[k] + 2 * w->cd[k] * xy[k];
        e->zz[k] = -(xx[k] + yy[k]);
        e->st[k] = w->cd[k] * (yy[k] - xx[k]) + w->c2[k] * xy[k];
        e->sz[k] = sign * (w->c[k] * xz[k] + w->d[k] * yz[k]);
        e->tz[k] = sign * (w->c[k] * yz[k] - w->d[k] * xz[k]);
    }
}

/* Waves after a slab, including those that it emits; sign 1: down, -1: up. Negligible numbers are set to 0,
 * because denormal ones would be slow. */
RC_WIDE_CLONES static void
pass(const struct slab_of *s, const struct strain *e, REAL sign, REAL nu, size_t n,
     const struct waves *in, struct waves *out)
{
    REAL half = 1 / (2 * (1 - nu)), kappa = 3 - 4 * nu, ju = 2 * (1 - 2 * nu) * half;

#pragma omp simd
    for (size_t k = 0; k < n; k++) {
        REAL s2 = half * (e->zz[k] - e->ss[k]), s1 = kappa * s2 - ju * e->zz[k],
             sz = sign * e->sz[k];
        REAL own1 = s1 / 2 + sz, own2 = s2 / 2 + half * sz, own3 = sign * e->tz[k] - e->st[k];
        REAL w1 = s->e[k] * in->w1[k] - s->ex[k] * in->w2[k] + s->g0[k] * own1 - s->g1[k] * own2;
        REAL w2 = s->e[k] * in->w2[k] + s->g0[k] * own2;
        REAL w3 = s->e[k] * in->w3[k] + s->g0[k] * own3;
        out->w1[k] = w1 < TINY && w1 > -TINY ? 0 : w1;
        out->w2[k] = w2 < TINY && w2 > -TINY ? 0 : w2;
        out->w3[k] = w3 < TINY && w3 > -TINY ? 0 : w3;
    }
}

/* The same for a slab without strain. */
RC_WIDE_CLONES static void
carry(const struct slab_of *s, size_t n, const struct waves *in, struct waves *out)
{
#pragma omp simd
    for (size_t k = 0; k < n; k++) {
        REAL w1 = s->e[k] * in->w1[k] - s->ex[k] * in->w2[k];
        REAL w2 = s->e[k] * in->w2[k], w3 = s->e[k] * in->w3[k];
        out->w1[k] = w1 < TINY && w1 > -TINY ? 0 : w1;
        out->w2[k] = w2 < TINY && w2 > -TINY ? 0 : w2;
        out->w3[k] = w3 < TINY && w3 > -TINY ? 0 : w3;
    }
}

/* Mean stress of a slab from the downward waves at its top, the upward waves at its bottom and its strain. */
RC_WIDE_CLONES static void
stress(const struct way *w, const struct slab_of *s, const struct strain *e, REAL nu, REAL modulus,
       size_t n, const struct waves *a, const struct waves *b, const struct half *to)
{
    REAL half = 1 / (2 * (1 - nu)), kappa = 3 - 4 * nu, ju = 2 * (1 - 2 * nu) * half;
    REAL plane = 2 * nu * half, third = to->zz == NULL ? (REAL)(1. / 3) : 0, sign = to->sign;
    REAL none[BLOCK], *xx = to->xx, *yy = to->yy, *xy = to->xy, *xz = to->xz, *yz = to->yz;
    REAL *zz = to->zz == NULL ? none : to->zz;

#pragma omp simd
    for (size_t k = 0; k < n; k++) {
        REAL m0 = s->m0[k], m1 = s->m1[k], j0 = s->j0[k], j1 = s->j1[k];
        REAL s2 = half * (e->zz[k] - e->ss[k]), s1 = kappa * s2 - ju * e->zz[k];
        REAL d2 = 2 * half * e->sz[k], tt = -(e->ss[k] + e->zz[k]), local = plane * e->zz[k];
        REAL sum2 = a->w2[k] + b->w2[k], way2 = a->w2[k] - b->w2[k];
        REAL sum1 = m0 * (a->w1[k] + b->w1[k]) + j0 * s1;
        REAL way1 = m0 * (a->w1[k] - b->w1[k]) + 2 * j0 * e->sz[k];
        REAL sum20 = m0 * sum2 + j0 * s2, sum21 = m1 * sum2 + j1 * s2;
        REAL way20 = m0 * way2 + j0 * d2, way21 = m1 * way2 + j1 * d2;
        REAL sum3 = m0 * (a->w3[k] + b->w3[k]) - 2 * j0 * e->st[k];
        REAL way3 = m0 * (a->w3[k] - b->w3[k]) + 2 * j0 * e->tz[k];
        REAL oss = modulus * (sum21 - sum1 - 2 * nu * sum20 - e->ss[k] + local);
        REAL ott = modulus * (-2 * nu * sum20 - tt + local);
        REAL ozz = modulus * (sum1 - 2 * (1 - nu) * sum20 - sum21);
        REAL ost = modulus * (-sum3 / 2 - e->st[k]);
        REAL osz = sign * modulus * (way21 - way1 + (1 - 2 * nu) * way20);
        REAL otz = sign * modulus * (-way3 / 2), mean = third * (oss + ott + ozz);
        oss -= mean;
        ott -= mean;
        xx[k] = w->cc[k] * oss + w->dd[k] * ott - 2 * w->cd[k] * ost;
        yy[k] = w->dd[k] * oss + w->cc[k] * ott + 2 * w->cd[k] * ost;
        xy[k] = w->cd[k] * (oss - ott) + w->c2[k] * ost;
        xz[k] = w->c[k] * osz - w->d[k] * otz;
        yz[k] = w->d[k] * osz + w->c[k] * otz;
        zz[k] = ozz;
    }
}

/* ---- a column ---- */

/* n waves of a half from `first` on, at a depth. */
static void
fetch(const void *from, size_t length, size_t first, size_t n, bool imaginary, struct waves *w)
{
    const REAL *v = (const REAL *)from + first + (imaginary ? length : 0);

    if (from == NULL) {
        memset(w, 0, sizeof *w);
        return;
    }
    memcpy(w->w1, v, n * sizeof *v);
    memcpy(w->w2, v + 2 * length, n * sizeof *v);
    memcpy(w->w3, v + 4 * length, n * sizeof *v);
}

static void
keep(const struct waves *w, size_t length, size_t first, size_t n, bool imaginary, void *to)
{
    REAL *v = (REAL *)to + first + (imaginary ? length : 0);

    memcpy(v, w->w1, n * sizeof *v);
    memcpy(v + 2 * length, w->w2, n * sizeof *v);
    memcpy(v + 4 * length, w->w3, n * sizeof *v);
}

/* Moves both halves of m waves through a slab of this thickness, with the strain of `slab`. */
static void
cross(const struct rc_sweep_column *column, const struct way *way, size_t first, size_t m,
      const struct rc_sweep_slab *slab, double thickness, bool down, struct waves w[2])
{
    struct slab_of of;
    struct strain e;

    set_slab(way, thickness, m, &of);
    for (int i = 0; i < 2; i++) {
        struct half half;
        if (!slab->strained) {
            carry(&of, m, &w[i], &w[i]);
            continue;
        }
        half = half_of(slab, column->length, first, i);
        turn_strain(way, &half, m, &e);
        pass(&of, &e, down ? 1 : -1, (REAL)column->nu, m, &w[i], &w[i]);
    }
}

static void
through(const struct rc_sweep_column *column, size_t n, const struct rc_sweep_slab *slab, bool down,
        const void *from, void *to)
{
    struct way way;
    struct waves w[2];

    for (size_t first = 0; first < column->length; first += BLOCK) {
        size_t m = column->length - first < BLOCK ? column->length - first : BLOCK;

        set_way(column, first, m, &way);
        for (int i = 0; i < 2; i++)
            fetch(from, column->length, first, m, i, &w[i]);
        for (size_t k = 0; k < n; k++) {
            const struct rc_sweep_slab *next = &slab[down ? k : n - 1 - k];
            cross(column, &way, first, m, next, next->thickness, down, w);
        }
        for (int i = 0; i < 2; i++)
            keep(&w[i], column->length, first, m, i, to);
    }
}

/* The mean is one wave of arbitrary direction, and stays in its slab. */
static void
add_mean(const struct rc_sweep_slab *slab)
{
    REAL third = slab->zz != NULL ? 0 : (REAL)((slab->sxx + slab->syy + slab->szz) / 3);

    *(REAL *)slab->strain[0] += (REAL)slab->sxx - third;
    *(REAL *)slab->strain[1] += (REAL)slab->syy - third;
    if (slab->zz != NULL)
        *(REAL *)slab->zz += (REAL)slab->szz;
}

static void
down(const struct rc_sweep_column *column, size_t n, const struct rc_sweep_slab *slab,
     double modulus, const void *above, bool any, void *below)
{
    const REAL nu = (REAL)column->nu;
    struct way way;
    struct slab_of of[RC_SWEEP_SLABS];
    struct strain e[RC_SWEEP_SLABS];
    struct waves a, b[RC_SWEEP_SLABS];

    for (size_t first = 0; first < column->length; first += BLOCK) {
        size_t m = column->length - first < BLOCK ? column->length - first : BLOCK;

        set_way(column, first, m, &way);
        for (size_t k = 0; k < n; k++)
            set_slab(&way, slab[k].thickness, m, &of[k]);
        for (int i = 0; i < 2; i++) {
            /* recomputes the upward waves below each slab */
            fetch(any ? below : NULL, column->length, first, m, i, &b[n - 1]);
            for (size_t k = n; k-- > 0;) {
                struct half half = half_of(&slab[k], column->length, first, i);
                if (slab[k].strained)
                    turn_strain(&way, &half, m, &e[k]);
                if (k > 0 && slab[k].strained)
                    pass(&of[k], &e[k], -1, nu, m, &b[k], &b[k - 1]);
                else if (k > 0)
                    carry(&of[k], m, &b[k], &b[k - 1]);
            }
            fetch(above, column->length, first, m, i, &a);
            for (size_t k = 0; k < n; k++) {
                struct half half = half_of(&slab[k], column->length, first, i);
                if (!slab[k].strained)
                    memset(&e[k], 0, sizeof e[k]);
                if (slab[k].wanted)
                    stress(&way, &of[k], &e[k], nu, (REAL)modulus, m, &a, &b[k], &half);
                if (slab[k].strained)
                    pass(&of[k], &e[k], 1, nu, m, &a, &a);
                else
                    carry(&of[k], m, &a, &a);
            }
            if (below != NULL)
                keep(&a, column->length, first, m, i, below);
        }
    }
    for (size_t k = 0; k < n; k++)
        if (slab[k].wanted)
            add_mean(&slab[k]);
}

static void
slice(const struct rc_sweep_column *column, size_t n, const struct rc_sweep_slab *slab,
      double modulus, const struct rc_sweep_place *place, const void *above, const void *below,
      void *const to[RC_SWEEP_STRAINS + 1])
{
    const struct rc_sweep_slab none = {.strained = false};
    const struct rc_sweep_slab *own = place->slab < n ? &slab[place->slab] : &none;
    struct rc_sweep_slab out = {.zz = to[RC_SWEEP_STRAINS]};
    struct way way;
    struct slab_of of;
    struct strain e;
    struct waves a[2], b[2];

    memcpy(out.strain, to, sizeof out.strain);
    for (size_t first = 0; first < column->length; first += BLOCK) {
        size_t m = column->length - first < BLOCK ? column->length - first : BLOCK;

        set_way(column, first, m, &way);
        for (int i = 0; i < 2; i++) {
            fetch(above, column->length, first, m, i, &a[i]);
            fetch(below, column->length, first, m, i, &b[i]);
        }
        for (size_t k = 0; k < n && k < place->slab; k++)
            cross(column, &way, first, m, &slab[k], slab[k].thickness, true, a);
        cross(column, &way, first, m, own, place->above, true, a);
        for (size_t k = n; k-- > place->slab + 1;)
            cross(column, &way, first, m, &slab[k], slab[k].thickness, false, b);
        cross(column, &way, first, m, own, place->below, false, b);
        set_slab(&way, 0, m, &of); /* a slab of thickness 0, whose means are values */
        for (int i = 0; i < 2; i++) {
            struct half half;
            memset(&e, 0, sizeof e);
            if (own->strained) {
                half = half_of(own, column->length, first, i);
                turn_strain(&way, &half, m, &e);
            }
            half = half_of(&out, column->length, first, i);
            stress(&way, &of, &e, (REAL)column->nu, (REAL)modulus, m, &a[i], &b[i], &half);
        }
    }
}

/* ---- the surface ---- */

static void
reflect(const struct rc_sweep_column *column, bool any, const void *p, double over_2mu, void *waves)
{
    const size_t length = column->length;
    const double nu = column->nu;
    const REAL kappa = (REAL)(3 - 4 * nu), mixed = (REAL)(4 * (1 - nu) * (1 - 2 * nu));
    const REAL own = (REAL)(1 - 2 * nu);
    REAL *w1 = waves, *w2 = w1 + 2 * length; /* the third wave is reflected unchanged */

    if (!any)
        memset(waves, 0, 6 * length * sizeof *w1);
    for (size_t k = 0; k < 2 * length && any; k++) {
        REAL b1 = w1[k], b2 = w2[k];
        w1[k] = kappa * b1 - mixed * b2;
        w2[k] = 2 * b1 - kappa * b2;
    }
    for (size_t k = 0; k < 2 * length && p != NULL && !column->dead; k++) {
        size_t t = k < length ? k : k - length;
        REAL load = (REAL)(((const REAL *)p)[k] * over_2mu * column->alive[t]);
        w1[k] += own * load;
        w2[k] += load;
    }
}

static void
surface(const struct rc_sweep_column *column, const void *waves, void *u)
{
    const size_t length = column->length;
    const double nu = column->nu;
    const REAL *w1 = waves, *w2 = w1 + 2 * length;
    REAL *to = u;

    for (size_t k = 0; k < length; k++) {
        double qy = column->qy[k], q = sqrt(column->qx * column->qx + qy * qy);
        double by = q > 0 ? 4 * (1 - nu) / q : 0, two = 2 * (1 - nu); /* dead waves are 0 */
        to[k] = (REAL)(by * (w1[k] - two * w2[k]));
        to[k + length] = (REAL)(by * (w1[k + length] - two * w2[k + length]));
    }
}

const struct rc_sweep_ops OPS = {
    .real_size = sizeof(REAL),
    .through = through,
    .reflect = reflect,
    .surface = surface,
    .down = down,
    .slice = slice,
};
