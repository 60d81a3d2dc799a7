/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Frames selected on the command line by channel, case, section and depth. Each word and number of the lists
 * must match a frame: otherwise the tool ends with a message that lists the existing ones.
 */
#ifndef RC_WANTED_H
#define RC_WANTED_H

#include "tools/cli/cli.h"

struct wanted {                   /* starts as {0}: every frame */
    const char *channel;          /* names separated by commas; NULL: any */
    bool one;                     /* it is one name, which may contain commas */
    const char *section;          /* "x" or "y": only sections across that axis; NULL: any frame */
    struct numbers depth, number; /* requested depths (m) and cases; n = 0: any */
    /* Called for each frame of the requested cases that is not selected, and returns true if it takes the
     * frame over. NULL: such frames are dropped. */
    bool (*other)(void *ctx, struct rc_grid *grid);
    void *ctx;
    struct wanted_frames *frames; /* the frames so far */
};

/* Rows of an option table whose .at are in `member` of `type`. */
/* clang-format off */
#define WANTED_OPTIONS(args, member, in_history)                                                   \
    {.name = "channel", .type = OPT_TEXT, .at = offsetof(args, member.channel),                    \
     .result = in_history, .arg = "LIST",                                                          \
     .help = "only the frames of these channels, separated by commas"},                            \
    {.name = "depth", .type = OPT_NUMBERS, .unit = UNIT_M, .at = offsetof(args, member.depth),     \
     .min = 0, .max = INFINITY, .result = in_history, .arg = "LIST",                               \
     .help = "only the frames at these depths, or the nearest within half a step"},                \
    {.name = "case", .type = OPT_NUMBERS, .at = offsetof(args, member.number), .min = 1,           \
     .max = 9e15, .whole = true, .result = in_history, .arg = "LIST",                              \
     .help = "only the frames of these cases, as in 1,4-6"}
/* clang-format on */

/* Before the first frame: ends the tool for an empty name. */
void wanted_check(const struct wanted *wanted, struct tool *tool);
/* The next selected frame; the caller frees it. NULL after the last one. Frames wait here for the end of
 * their case if a later frame may be nearer to the requested depth. A depth selects the nearest one, within
 * half the step to the next one, or within a thousandth. */
struct rc_grid *wanted_read(struct wanted *wanted, struct tool *tool);

#endif
