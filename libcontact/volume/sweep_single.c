/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Single precision: half the memory and memory traffic, for uses that do not need sixteen digits. */
#define REAL float
#define BITS uint32_t
#define SHIFT 0x1.8p23f
#define MANTISSA 23
#define TINY 1e-30f
#define DEEPEST 87
#define LONG 0
#define OPS rc_sweep_single
#include "sweep_body.h"
