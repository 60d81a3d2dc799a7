/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The inner loops of the sums in real space, compiled for each width of registers. Rows are contiguous in x;
 * loops process whole vectors of x, not single nodes.
 */
#ifndef RC_SIMD_H
#define RC_SIMD_H

#include <stddef.h>
#include <stdint.h>

enum {
    RC_STRIP = 32, /* nodes of a row summed at once */
    RC_BLOCK = 4,  /* rows summed at once */
    /* counts are rounded up to multiples of this: a vector of the widest registers */
    RC_SIMD_WIDTH = 8,
};

/* One column of a stencil: its coefficients c[first] .. c[last], and RC_BLOCK - 1 zeros on either
 * side of them. */
struct rc_column {
    ptrdiff_t first, last;
    const double *c;
};

/* A strip of sources, and one or two strips of targets to which its stencils add. */
struct rc_strip {
    const double *src; /* the row `margin` above the first target row */
    size_t stride, margin;
    size_t rows, n; /* number of targets; computed to multiples of RC_BLOCK and RC_SIMD_WIDTH, n <=
            * RC_STRIP */
    /* Column j uses src[x - near - j] + sign src[x - far + j], or the one value if both are the same. */
    size_t columns;
    ptrdiff_t near, far;
    double sign;
    const struct rc_column *column[2]; /* NULL: no such target */
    double *out[2];
    size_t out_stride;
    double *ring; /* columns (2 margin + RC_BLOCK) RC_STRIP, aligned to 64 bytes */
};

/* Single sources, and the targets to which an unfolded stencil adds around each. Rows of `out` are long
 * enough for targets outside the map. */
struct rc_scatter {
    const double *value;
    const uint32_t *place; /* y << 16 | x of each */
    size_t n;
    const double *c; /* rows of `width`, a multiple of RC_SIMD_WIDTH */
    size_t width, rows;
    ptrdiff_t left, top; /* distances from a source to its lowest target */
    size_t wide, high;   /* columns and rows of the targets */
    double *out;
    size_t out_stride;
};

struct rc_simd {
    /* out[y][x] += sum over columns j and their l of c_j[l] column_j[y - l][x]. */
    void (*stencil)(const struct rc_strip *strip);
    void (*scatter)(const struct rc_scatter *scatter);
    /* out[i stride + x] += sum over a < n of q[a RC_BLOCK + i] k[x - a], for i < RC_BLOCK and
     * x < RC_STRIP. */
    void (*product)(const double *k, const double *q, size_t n, double *out, size_t stride);
    /* out[x] = first[x] + sum over i < t of s[i] (near[i][x] + far[i][x]); first may be NULL. */
    void (*weighted_sum)(size_t t, const double *s, const double *const *near,
                         const double *const *far, const double *first, size_t n, double *out);
    /* Even and odd places of n values, and back. */
    void (*deinterleave)(const double *src, size_t n, double *even, double *odd);
    void (*interleave)(const double *even, const double *odd, size_t n, double *out);
    /* first + x for each src[x] != 0, x < n, a multiple of RC_SIMD_WIDTH; returns their number. The list has
     * room for n. */
    size_t (*find_nonzero)(const double *src, size_t n, uint32_t first, uint32_t *list);
    /* The number of values that are not zero. */
    size_t (*count_nonzero)(const double *src, size_t n);
};

/* The loops for this processor. */
const struct rc_simd *rc_simd(void);

#endif
