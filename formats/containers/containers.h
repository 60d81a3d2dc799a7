/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: layouts that several formats share, such as ZIP and HDF5. One or two files
 * here use the library for each.
 */
#ifndef RC_CONTAINERS_H
#define RC_CONTAINERS_H

#include "cdf.h"
#include "checksum.h"
#include "hdf.h"
#include "ole.h"
#include "tiff.h"
#include "xml.h"
#include "zip_read.h"
#include "zip_write.h"

#include "formats/containers/packing/packing.h"

#endif
