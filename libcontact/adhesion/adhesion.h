/*
 * The face of this folder is in contact.h; here is what its files share. Internal: never installed.
 */
#ifndef RC_ADHESION_H
#define RC_ADHESION_H

#include "gap.h"
#include "law.h"
#include "retraction.h"

#endif
