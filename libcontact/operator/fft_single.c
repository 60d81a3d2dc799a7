/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Single precision has half the memory traffic and twice the numbers in a register. It serves uses that do
 * not need sixteen digits: the preconditioner, and the residual while it is large. */
#define REAL float
#define COMPLEX float complex
#define CMPLX_OF CMPLXF
#define FFTW(name) fftwf_##name
#define C99(name) name##f
#define OPS rc_fft_single
#include "fft_body.h"
