/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: Fourier transforms of maps and lines by FFTW, and results from the power of
 * their waves. Internal: never installed.
 */
#ifndef RC_TRANSFORM_H
#define RC_TRANSFORM_H

#include "dct.h"
#include "fourier.h"
#include "planner.h"
#include "power.h"

#endif
