/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Objects of HDF5 that are closed at the end of their scope. */
#ifndef RC_HDF_ID_H
#define RC_HDF_ID_H

#include <hdf5.h>

#include "libcontact/owned.h"

/* RC_HID set = H5Dopen2(...); for an object of any kind but a file; a negative one is not an object. */
#define RC_HID RC_ENDS(rc_hid_end) hid_t

static inline void
rc_hid_end(const hid_t *id)
{
    if (*id >= 0)
        H5Idec_ref(*id);
}

#endif
