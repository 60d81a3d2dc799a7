/*
 * The face of this folder: a file that a run adds frames to and goes on from, as --checkpoint names it.
 *
 * Each frame is a grid stream of its own with its end line, so that the file is whole but for what was being
 * written when the machine stopped. Of several processes that share maps all call these, and all get the
 * same.
 */
#ifndef RC_JOURNAL_H
#define RC_JOURNAL_H

#include <sys/types.h>

#include "tools/cli/cli.h"

struct journal {
    struct tool *t;
    const char *name;
    FILE *file; /* NULL: it could not be added to */
};

/* Opens what is there where `resume` is set, else, or where nothing is, a new one: *found says which. It is
 * locked, so that no other run adds to it. Ends the tool where it cannot be. */
void journal_open(struct journal *j, struct tool *t, const char *name, bool resume, bool *found);
void journal_close(struct journal *j);

/* Where the frame ends whose last line begins here. */
off_t journal_frame_end(const struct journal *j);
/* Whether no frame ends behind this place: what is there was being written when the run was killed or
 * the machine stopped. A frame that ends and cannot be read is something else: memory may only be short. */
bool journal_is_cut_off(const struct journal *j, off_t at);
/* Cuts off what stands behind the last frame, which ends here; frames: how many there are. */
void journal_cut(struct journal *j, size_t frames, off_t end);

/* The frame that begins here. The tool ends where it cannot be read. */
struct rc_grid *journal_read(const struct journal *j, off_t at);
/* Adds a frame; *at is where it begins. False, and a warning, where that fails: nothing is added from then
 * on, because a full disk is no reason to lose the solution. */
bool journal_add(struct journal *j, const struct rc_grid *g, off_t *at);

#endif
