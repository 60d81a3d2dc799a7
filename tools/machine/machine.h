/*
 * The face of this folder: what the operating system gives a tool: memory, pipes, and files that
 * appear whole or not at all. Nothing here knows a tool.
 */
#ifndef RC_MACHINE_H
#define RC_MACHINE_H

#include "memory.h"
#include "pipe.h"
#include "whole_file.h"

#endif
