/*
 * The face of this folder: a contact as the tools that solve it are told, load, bodies and boundary, and what
 * goes with --yield and --adhesion.
 */
#ifndef RC_TOOL_PROBLEM_H
#define RC_TOOL_PROBLEM_H

#include "attracts.h"
#include "physics.h"
#include "yields.h"

#endif
