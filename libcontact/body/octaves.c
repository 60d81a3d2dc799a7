/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The exponent of x and the first bits of its mantissa give the number of the piece, the other bits the
 * position in it. A piece is the polynomial through its Chebyshev points.
 */
#include "octaves.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

enum {
    PIECE_BITS = 5, /* 32 pieces an octave */
    TERMS = 6
};
static const unsigned mantissa = 52;

struct rc_octaves {
    rc_octaves_of *f;
    const void *ctx;
    uint64_t first; /* number of the first piece */
    size_t n;       /* pieces */
    double (*piece)[TERMS];
};

/* The number of the piece of x, and the position of x in it, -1/2 to 1/2. */
static inline uint64_t
piece_of(double x, double *t)
{
    const uint64_t rest = (UINT64_C(1) << (mantissa - PIECE_BITS)) - 1, one = UINT64_C(1023)
                                                                              << mantissa;
    uint64_t bits, in;

    memcpy(&bits, &x, sizeof bits);
    in = one | (bits & rest) << PIECE_BITS;
    memcpy(t, &in, sizeof *t);
    *t -= 1.5;
    return bits >> (mantissa - PIECE_BITS);
}

/* Lower end of a piece. */
static double
begin_of(uint64_t piece)
{
    uint64_t bits = piece << (mantissa - PIECE_BITS);
    double x;

    memcpy(&x, &bits, sizeof x);
    return x;
}

/* The polynomial through the values v at the points t: Newton's form, then powers. */
static void
fit(const double t[TERMS], double v[TERMS], double out[TERMS])
{
    for (int k = 1; k < TERMS; k++)
        for (int j = TERMS - 1; j >= k; j--)
            v[j] = (v[j] - v[j - 1]) / (t[j] - t[j - k]);
    memset(out, 0, TERMS * sizeof *out);
    for (int k = TERMS - 1; k >= 0; k--) {
        for (int j = TERMS - 1; j > 0; j--)
            out[j] = out[j - 1] - t[k] * out[j];
        out[0] = v[k] - t[k] * out[0];
    }
}

struct rc_octaves *
rc_octaves_new(double first, double last, rc_octaves_of *f, const void *ctx)
{
    RC_OWN(rc_octaves, o) = calloc(1, sizeof *o);
    double t[TERMS], v[TERMS], in;

    if (o == NULL)
        return NULL;
    o->f = f;
    o->ctx = ctx;
    o->first = piece_of(first, &in);
    o->n = (size_t)(piece_of(last, &in) - o->first + 1);
    if ((o->piece = rc_alloc(o->n, sizeof *o->piece)) == NULL)
        return NULL;
    for (int k = 0; k < TERMS; k++)
        t[k] = cos(RC_PI * (k + 0.5) / TERMS) / 2;
    for (size_t n = 0; n < o->n; n++) {
        double from = begin_of(o->first + n), to = begin_of(o->first + n + 1);
        for (int k = 0; k < TERMS; k++)
            v[k] = f(ctx, from + (t[k] + 0.5) * (to - from));
        fit(t, v, o->piece[n]);
    }
    return rc_give(&o);
}

void
rc_octaves_free(struct rc_octaves *o)
{
    if (o == NULL)
        return;
    free(o->piece);
    free(o);
}

void
rc_octaves_values(const struct rc_octaves *o, size_t n, const double *x, double *out)
{
    for (size_t k = 0; k < n; k++) {
        double t;
        uint64_t piece = piece_of(x[k], &t) - o->first;
        const double *c;

        if (piece >= o->n) { /* below the first piece the difference wraps */
            out[k] = o->f(o->ctx, x[k]);
            continue;
        }
        c = o->piece[piece];
        out[k] = c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
    }
}
