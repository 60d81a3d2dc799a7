/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cost of a run: the most memory held at a time, and processor seconds. */
#ifndef METER_H
#define METER_H

#include <stddef.h>

/* Aborts when the program holds more than `most` bytes beyond those held now; 0: no limit. */
void meter_start(size_t most);
/* Aborts if the run took longer than a second. */
void meter_stop(void);

#endif
