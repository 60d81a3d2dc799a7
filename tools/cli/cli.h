/*
 * The interface of this folder: options, input and output streams, messages, units, reports, the bodies of a
 * stream.
 */
#ifndef RC_CLI_H
#define RC_CLI_H

#include "bodies.h"
#include "contact.h"
#include "ending.h"
#include "tools/text/text.h"
#include "plan.h"
#include "tools/machine/machine.h"
#include "process.h"
#include "ranks.h"
#include "report.h"
#include "results.h"
#include "tool.h"
#include "wanted.h"
#include "words.h"

#endif
