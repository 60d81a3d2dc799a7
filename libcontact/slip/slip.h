/*
 * What the files of this folder share beside the face, which is in contact.h. Internal: never installed.
 */
#ifndef RC_SLIP_H
#define RC_SLIP_H

#include "discs.h"

#endif
