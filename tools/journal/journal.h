/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: a file to which a run adds frames, and from which another run continues
 * (--checkpoint).
 *
 * Each frame is a grid stream of its own with its end line, so that the file stays readable. Only a frame
 * that was being written when the machine stopped is lost. Processes that share maps all call these
 * functions, and all get the same result.
 */
#ifndef RC_JOURNAL_H
#define RC_JOURNAL_H

#include <sys/types.h>

#include "tools/cli/cli.h"

struct journal {
    struct tool *t;
    const char *name;
    FILE *file; /* NULL: writing has failed */
};

/* Opens the existing file if `resume` is set; otherwise, or if there is none, creates a new one: *found says
 * which. Locks it, so that no other run adds to it. Ends the tool on failure. */
void journal_open(struct journal *j, struct tool *t, const char *name, bool resume, bool *found);
void journal_close(struct journal *j);

/* The end of the frame whose last line begins here. */
off_t journal_frame_end(const struct journal *j);
/* True if no complete frame follows this position: the data there was being written when the run was killed
 * or the machine stopped. A complete frame that cannot be read is another failure, for example short
 * memory. */
bool journal_is_cut_off(const struct journal *j, off_t at);
/* Truncates the file after its last frame, which ends here; frames: their number. */
void journal_cut(struct journal *j, size_t frames, off_t end);

/* Reads frame `number`, which begins here. Ends the tool on failure. */
struct rc_grid *journal_read(const struct journal *j, off_t at, size_t number);
/* Adds a frame; *at is its position. On failure returns false with a warning, and adds nothing from then on,
 * because a full disk is not a reason to lose the solution. */
bool journal_add(struct journal *j, const struct rc_grid *g, off_t *at);

#endif
