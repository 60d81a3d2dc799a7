/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder. It has bytes, text, numbers in tables, maps of raw numbers, and the checksum
 * of a stream.
 */
#ifndef RC_CORE_H
#define RC_CORE_H

#include "bytes.h"
#include "crc32.h"
#include "even.h"
#include "file.h"
#include "header.h"
#include "maps.h"
#include "number_table.h"
#include "raster.h"
#include "text.h"
#include "units.h"

#endif
