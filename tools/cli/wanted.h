/*
 * Frames that a command line chooses, by channel, depth and case. Each word and number of the lists has
 * to be met by a frame: one that is not ends the tool, naming what there is.
 */
#ifndef RC_WANTED_H
#define RC_WANTED_H

#include "tool.h"

struct wanted {          /* starts as {0}: every frame                                          */
    const char *channel; /* names separated by commas; NULL: any                                */
    struct numbers depth, number; /* of depths (m) and cases; n = 0: any                        */
    struct seen *seen; /* when something is asked for: all frames so far, without values */
    size_t n, capacity;
};

/* Rows of an option table whose .at are in `member` of `type`. */
/* clang-format off */
#define WANTED_OPTIONS(args, member, in_history)                                                   \
    {.name = "channel", .type = OPT_TEXT, .at = offsetof(args, member.channel),                    \
     .result = in_history, .arg = "LIST",                                                          \
     .help = "only the frames of these channels, separated by commas"},                            \
    {.name = "depth", .type = OPT_NUMBERS, .unit = UNIT_M, .at = offsetof(args, member.depth),     \
     .min = 0, .max = INFINITY, .result = in_history, .arg = "LIST",                               \
     .help = "only the frames at these depths, met within a thousandth"},                          \
    {.name = "case", .type = OPT_NUMBERS, .at = offsetof(args, member.number), .min = 1,           \
     .max = 9e15, .whole = true, .result = in_history, .arg = "LIST",                              \
     .help = "only the frames of these cases"}
/* clang-format on */

/* Before the first frame: ends the tool for an empty name and a case that is no whole number. */
void wanted_check(const struct wanted *wanted, struct tool *tool);
/* Whether the frame is one of them. */
bool wanted_frame(struct wanted *wanted, struct tool *tool, const struct rc_grid *grid);
/* After the last frame. */
void wanted_end(struct wanted *wanted, struct tool *tool);

#endif
