/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: which frames of a stream are selected, and what they say of bodies, contact
 * and boundary.
 */
#ifndef RC_FRAMES_H
#define RC_FRAMES_H

#include "bodies.h"
#include "contact.h"
#include "wanted.h"

#endif
