/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Included before each file if the C library defines CMPLX only for gcc: clang with an older glibc. */
#ifndef CMPLX
#define CMPLX(x, y) __builtin_complex((double)(x), (double)(y))
#define CMPLXF(x, y) __builtin_complex((float)(x), (float)(y))
#endif
