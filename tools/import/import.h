/*
 * The face of this folder: the bytes of a file, which of its channels is read, and what is odd about it.
 */
#ifndef RC_IMPORT_H
#define RC_IMPORT_H

#include "formats/format.h"
#include "tools/cli/cli.h"

enum {
    CHANNELS_MOST = 64, /* that are looked at in one file */
    IMPORT_NAMES = 300  /* bytes of a list of names, so that a message holds it and what to do */
};

/* ---- file.c ---- */

/* The bytes of a file, or of standard input for "-", which the caller frees, and *file of them;
 * NULL when it cannot be read or needs more than --memory allows. */
unsigned char *import_read(struct tool *tool, const char *name, struct rc_file *file,
                           struct rc_err *err);
/* Passes over its first lines, in UTF-16 too. RC_FAIL where there are no more. */
enum rc_status import_skip(struct rc_file *file, unsigned char *data, size_t lines,
                           struct rc_err *err);
/* How messages name it. */
const char *import_source(const char *name);

/* ---- even.c ---- */

/* Brings a profile to the step wish->even_step. RC_FAIL for a map, and where the step is no fit. */
enum rc_status import_even(const struct rc_file *file, const struct rc_wish *wish,
                           struct rc_grid *grid, struct rc_notes *notes, struct rc_err *err);

/* ---- plausible.c ---- */

/* Warns of a map with a side above 1 m or below 10 nm, and of heights that span more than its longer
 * side, unless the user has said the spacing, or the unit. */
void import_judge(struct tool *tool, const struct rc_grid *grid, const struct rc_wish *wish);
/* Warns where the least or the greatest value stands often, and far from all others, or is a number that
 * programs write for missing points: `unit` is what one number of the file is in the grid's unit. */
void import_judge_marks(struct tool *tool, const struct rc_grid *grid, double unit);

/* ---- channel.c ---- */

struct pick {
    size_t index;
    char said[400]; /* what the user should know of it; "": nothing */
};

/* Picks the channel that `wanted` names: in these words, by its number from 1, by its first
 * letters; NULL: the topography. `any_unit`: the user has said what its unit is worth. RC_FAIL
 * where there is none or it could be several, which are named. */
enum rc_status import_pick(const struct rc_channel *channel, size_t n, const char *wanted,
                           bool any_unit, struct pick *pick, struct rc_err *err);

/* "1 'Phase' in deg, 2 'Current' in A" of the channels but `except`, cut to the room there is. */
const char *import_names(const struct rc_channel *channel, size_t n, size_t except,
                         char names[IMPORT_NAMES]);

#endif
