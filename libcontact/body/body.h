/*
 * The face of this folder: layers on a half-space, how they answer waves, and the integrals that make
 * answers at a distance of these. Internal: never installed.
 */
#ifndef RC_BODY_H
#define RC_BODY_H

#include "kernel.h"
#include "octaves.h"
#include "quadrature.h"
#include "radial.h"
#include "stack.h"

#endif
