/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: options of a contact (load, bodies, boundary), the options --yield and
 * --adhesion, and the parts of an estimated error.
 */
#ifndef RC_TOOL_PROBLEM_H
#define RC_TOOL_PROBLEM_H

#include "adhesion.h"
#include "errors.h"
#include "physics.h"
#include "relaxation.h"
#include "yield.h"

#endif
