/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by the files that use libhdf5. */
#ifndef RC_HDF_INTERNAL_H
#define RC_HDF_INTERNAL_H

#include "hdf.h"
#include "hdf_id.h"

struct rc_hdf {
    hid_t file;
};

enum {
    RC_HDF_RANK = 8 /* dimensions at most */
};

bool rc_hdf_is_number(hid_t type);

#endif
