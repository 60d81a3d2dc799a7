/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The interface of this folder. It unpacks gzip, zlib and Zstandard, as whole files or inside a file. */
#ifndef RC_PACKING_H
#define RC_PACKING_H

#include "gzip.h"
#include "inflate.h"
#include "zstd.h"

#endif
