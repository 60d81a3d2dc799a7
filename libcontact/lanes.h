/*
 * The inner loops of the sums in real space, compiled for each width of registers. Rows are
 * contiguous in x; every loop works on whole vectors of x and never on a single node.
 */
#ifndef RC_LANES_H
#define RC_LANES_H

#include <stddef.h>

enum {
    RC_STRIP = 32, /* nodes of a row that are summed at once                              */
    RC_BLOCK = 4,  /* rows that are summed at once                                        */
    RC_LANE = 8,   /* nodes by which counts are rounded up: a vector of the widest registers */
};

/* One column of a stencil: its coefficients c[first] .. c[last], and RC_BLOCK - 1 zeros on either
 * side of them. */
struct rc_column {
    ptrdiff_t first, last;
    const double *c;
};

struct rc_lanes {
    const char *name;
    /* Column j < columns: q_j[r RC_STRIP + x] = src[r stride + x - near - j]
     * + sign src[r stride + x - far + j], the one value when both are the same, for r < rows and
     * x < n rounded up to RC_LANE; q_j = q + j size. */
    void (*fold)(const double *src, size_t stride, size_t rows, size_t n, size_t columns,
                 ptrdiff_t near, ptrdiff_t far, double sign, double *q, size_t size);
    /* out[y stride + x] += sum over columns j and their l of c_j[l] q_j[(y - l) RC_STRIP + x] for
     * y < rows, x < n, rounded up to RC_BLOCK and RC_LANE. */
    void (*stencil)(const double *q, size_t size, size_t columns, const struct rc_column *column,
                    double *out, size_t stride, size_t rows, size_t n);
    /* out[y stride + x] += v c[y width + x] for y < rows, x < width, a multiple of RC_LANE. */
    void (*scatter)(double v, const double *c, size_t width, size_t rows, double *out,
                    size_t stride);
    /* out[i stride + x] += sum over a < n of q[a RC_BLOCK + i] k[x - a], i < RC_BLOCK, x < RC_STRIP. */
    void (*product)(const double *k, const double *q, size_t n, double *out, size_t stride);
    /* out[x] = first[x] + sum over i < t of s[i] (near[i][x] + far[i][x]); first may be NULL. */
    void (*weigh)(size_t t, const double *s, const double *const *near, const double *const *far,
                  const double *first, size_t n, double *out);
    /* Even and odd places of n values, and back. */
    void (*split)(const double *src, size_t n, double *even, double *odd);
    void (*join)(const double *even, const double *odd, size_t n, double *out);
    /* Values that are not zero. */
    size_t (*count)(const double *src, size_t n);
};

/* Those for the processor at hand. */
const struct rc_lanes *rc_lanes(void);

#endif
