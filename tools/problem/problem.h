/*
 * The interface of this folder: a contact as the tools that solve it read it (load, bodies, boundary), the
 * options --yield and --adhesion, and the parts of an estimated error.
 */
#ifndef RC_TOOL_PROBLEM_H
#define RC_TOOL_PROBLEM_H

#include "attracts.h"
#include "errors.h"
#include "physics.h"
#include "yields.h"

#endif
