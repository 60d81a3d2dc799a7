/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Fourier transforms of periodic maps and lines. Internal: never installed.
 *
 * The spectrum of nx x ny real values has ny rows of nx/2 + 1 complex numbers. Column k is wave number k
 * along x; row k is wave number k along y, or k - ny in the upper half. The other half plane is the complex
 * conjugate. No transform divides by nx ny.
 */
#ifndef RC_FOURIER_H
#define RC_FOURIER_H

#include <complex.h>
#include <stddef.h>

#include "libcontact/common.h"

/* Complex numbers in one row of the spectrum, and in all of it. */
size_t rc_fourier_columns(const struct rc_shape *shape);
size_t rc_fourier_size(const struct rc_shape *shape);
/* Signed wave number of place k of n. The second function gives it in rad/m, for n nodes d metres apart. */
static inline long
rc_fourier_number(size_t k, size_t n)
{
    return 2 * k <= n ? (long)k : -(long)(n - k);
}

static inline double
rc_fourier_q(size_t k, size_t n, double d)
{
    return 2 * RC_PI * (double)rc_fourier_number(k, n) / ((double)n * d);
}

/* Length of a transform with n nodes and as much padding: the smallest multiple of `step` from 2n up without
 * prime factors above 7. */
size_t rc_fourier_length(size_t n, size_t step);

/* RC_FAIL when a side is too long for FFTW. */
enum rc_status rc_fourier_check(const struct rc_shape *shape, struct rc_err *err);
/* s_k = sum of v_j exp(-2 pi i jk / n); v is kept. RC_FAIL when a side is too long for FFTW or
 * memory is short. */
enum rc_status rc_fourier_forward(const struct rc_shape *shape, const double *v, double complex *s,
                                  struct rc_err *err);
/* v_j = sum of s_k exp(+2 pi i jk / n) over both half planes; s is destroyed. Fails likewise. */
enum rc_status rc_fourier_backward(const struct rc_shape *shape, double complex *s, double *v,
                                   struct rc_err *err);

/* The same for each column of ny rows of `wide` complex numbers, in place. The numbers of a column do not
 * depend on `wide`. RC_FAIL when memory is short. */
enum rc_status rc_fourier_columns_backward(size_t ny, size_t wide, int threads, double complex *s,
                                           struct rc_err *err);

/* Transforms of single lines of n real values, for this number of threads. NULL when memory is short. */
struct rc_line;
struct rc_line *rc_line_new(size_t n, size_t threads, struct rc_err *err);
/* s_k, k <= n/2, of n values, and back (without division by n); any alignment. The threads of one OpenMP team
 * call it. */
void rc_line_forward(const struct rc_line *line, const double *v, double complex *s);
void rc_line_backward(const struct rc_line *line, const double complex *s, double *v);
void rc_line_free(struct rc_line *line); /* NULL is allowed */
RC_OWNER(rc_line)

#endif
