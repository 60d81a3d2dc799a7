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
    bool (*other)(void *ctx,
                  struct rc_grid *
                      grid); /* takes a frame that is not one of them, and says whether it keeps it;
                          NULL: none is; not where depths are asked for                       */
    void *ctx;
    struct seen *seen; /* when something is asked for: all frames so far, without values */
    size_t n, capacity;
    struct wanted_depths *depths; /* of the case that is read; NULL: none are asked for          */
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
     .help = "only the frames of these cases"}
/* clang-format on */

/* Before the first frame: ends the tool for an empty name and a case that is no whole number. */
void wanted_check(const struct wanted *wanted, struct tool *tool);
/* The next frame that is one of them; the caller frees it. NULL after the last one. Frames at a depth that a
 * later one may turn out to be nearer to wait here for the end of their case. */
struct rc_grid *wanted_read(struct wanted *wanted, struct tool *tool);

/* Which of n depths is meant by `asked`: the nearest, within half the step to the next one, or
 * within a thousandth; NAN: none. */
double wanted_depth(const double *depth, size_t n, double asked);
/* Warns that frames at another depth than the one asked for are taken, where they differ by more
 * than a thousandth. */
void wanted_tell(struct tool *tool, double asked, double taken);

#endif
