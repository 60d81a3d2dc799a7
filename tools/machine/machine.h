/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: services of the operating system: memory, other processes, pipes, waiting
 * threads, and files that appear whole or not at all. Nothing here depends on a tool.
 */
#ifndef RC_MACHINE_H
#define RC_MACHINE_H

#include "memory.h"
#include "pipe.h"
#include "siblings.h"
#include "waiting.h"
#include "whole_file.h"

#endif
