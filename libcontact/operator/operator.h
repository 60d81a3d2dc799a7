/*
 * The face of this folder: kernels, engines and transforms. Internal: never installed.
 */
#ifndef RC_OPERATOR_H
#define RC_OPERATOR_H

#include "engine.h"
#include "fft.h"
#include "fourier.h"
#include "kernel.h"

#endif
