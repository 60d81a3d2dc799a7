/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: options, input and output streams, messages, units, reports.
 */
#ifndef RC_CLI_H
#define RC_CLI_H

#include "ending.h"
#include "tools/text/text.h"
#include "plan.h"
#include "tools/machine/machine.h"
#include "process.h"
#include "ranks.h"
#include "report.h"
#include "results.h"
#include "tool.h"
#include "words.h"

#endif
