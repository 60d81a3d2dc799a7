/*
 * What the files of this folder share beside the face, which is in contact.h. Internal: never installed.
 */
#ifndef RC_PLASTIC_H
#define RC_PLASTIC_H

#include "libcontact/contact.h"
#include "libcontact/volume/volume.h"
#include "voxels.h"

#endif
