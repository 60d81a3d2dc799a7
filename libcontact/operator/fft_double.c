/* SPDX-License-Identifier: GPL-3.0-or-later */
#define REAL double
#define COMPLEX double complex
#define CMPLX_OF CMPLX
#define FFTW(name) fftw_##name
#define C99(name) name
#define OPS rc_fft_double
#include "fft_body.h"
