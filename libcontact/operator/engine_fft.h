/*
 * What the rows of the transform engine share: `fft` takes the precision that the asked error
 * needs, `fft64` has it in its name. Internal: never installed.
 */
#ifndef RC_ENGINE_FFT_H
#define RC_ENGINE_FFT_H

#include "engine.h"
#include "fft.h"

void *rc_engine_fft_new(const struct rc_sum *sum, enum rc_precision precision, struct rc_err *err);
size_t rc_engine_fft_memory(const struct rc_sum *sum, enum rc_precision precision);
void rc_engine_fft_apply(void *plan, const double *p, double *u);
double rc_engine_fft_error(const void *plan);
void rc_engine_fft_free(void *plan);

#endif
