/*
 * The face of this folder: options, streams in and out, messages, units, reports, the physics of a
 * contact.
 */
#ifndef RC_CLI_H
#define RC_CLI_H

#include "coating.h"
#include "ending.h"
#include "json.h"
#include "name_list.h"
#include "physics.h"
#include "report.h"
#include "results.h"
#include "shown.h"
#include "tool.h"
#include "units.h"
#include "wanted.h"
#include "words.h"

#endif
