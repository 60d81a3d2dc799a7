/* The face of this folder: what unpacks streams of gzip, zlib and Zstandard, whole or inside a file. */
#ifndef RC_PACKING_H
#define RC_PACKING_H

#include "gzip.h"
#include "inflate.h"
#include "zstd.h"

#endif
