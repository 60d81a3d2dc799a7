/* SPDX-License-Identifier: GPL-3.0-or-later */
#define REAL double
#define BITS uint64_t
#define SHIFT 0x1.8p52
#define MANTISSA 52
#define TINY 1e-290
#define DEEPEST 708
#define LONG 1
#define OPS rc_sweep_double
#include "sweep_body.h"
