/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: the bytes of a file, the choice of a channel, and warnings of implausible
 * values.
 */
#ifndef RC_IMPORT_H
#define RC_IMPORT_H

#include "formats/format.h"
#include "tools/cli/cli.h"

enum {
    CHANNELS_MOST = 64, /* channels read from one file */
    IMPORT_NAMES = 300  /* bytes of a list of names, which leave room for the rest of a message */
};

/* ---- file.c ---- */

/* The bytes of a file, or of standard input for "-", which the caller frees; *file describes them. NULL
 * when the file cannot be read or exceeds --memory. */
unsigned char *import_read(struct tool *tool, const char *name, struct rc_file *file,
                           struct rc_err *err);
/* Skips the first lines of the file, in UTF-16 too. RC_FAIL when there are fewer. */
enum rc_status import_skip(struct rc_file *file, unsigned char *data, size_t lines,
                           struct rc_err *err);
/* Its name in messages. */
const char *import_source(const char *name);

/* ---- even.c ---- */

/* Resamples a profile to the step wish->even_step. RC_FAIL for a map, and for an unsuitable step. */
enum rc_status import_even(const struct rc_file *file, const struct rc_wish *wish,
                           struct rc_grid *grid, struct rc_notes *notes, struct rc_err *err);

/* ---- plausible.c ---- */

/* Warns of a map with a side above 1 m or below 10 nm, unless the user gave the spacing. Warns of
 * heights whose range exceeds the longer side, and of a steep mean slope, unless the user gave the unit;
 * and of a spacing and heights that are both above 1 mm. `unit` is the value of 1 of the file in the
 * grid's unit. */
void import_judge(struct tool *tool, const struct rc_grid *grid, const struct rc_wish *wish,
                  double unit);
/* Warns when the smallest or largest value occurs often and far from all others, or is a number that
 * programs write for missing points. `unit` as above. */
void import_judge_marks(struct tool *tool, const struct rc_grid *grid, double unit);

/* ---- channel.c ---- */

struct pick {
    size_t index;
    char said[400]; /* information for the user; "": none */
};

/* Picks the channel that `wanted` names: by its full name, its number from 1, or its first letters;
 * NULL: the topography. `any_unit`: the user gave the unit. RC_FAIL when there is none, or several,
 * which the message names. */
enum rc_status import_pick(const struct rc_channel *channel, size_t n, const char *wanted,
                           bool any_unit, struct pick *pick, struct rc_err *err);

/* "1 'Phase' in deg, 2 'Current' in A" for all channels but `except`, cut to the available size. */
const char *import_names(const struct rc_channel *channel, size_t n, size_t except,
                         char names[IMPORT_NAMES]);

#endif
