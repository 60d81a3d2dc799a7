/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: numbers, units and names as users type and read them, tables of numbers, and
 * JSON. Nothing here depends on a tool.
 */
#ifndef RC_TOOL_TEXT_H
#define RC_TOOL_TEXT_H

#include "columns.h"
#include "json.h"
#include "name_list.h"
#include "names.h"
#include "shown.h"
#include "units.h"

#endif
