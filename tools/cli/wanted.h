/*
 * Frames selected on the command line by channel, depth and case. Each word and number of the lists must
 * match a frame: otherwise the tool ends with a message that lists the existing ones.
 */
#ifndef RC_WANTED_H
#define RC_WANTED_H

#include "tool.h"

/* The frames of a stream that were read, without their values. */
struct seen {
    char *channel;
    char section; /* 'x', 'y', or 0 */
    double depth; /* NAN: none      */
    size_t number;
    bool taken;
};
struct seen_list {
    struct seen *seen;
    size_t n, room;
};

struct seen *seen_add(struct seen_list *list, struct tool *tool, const struct rc_grid *grid);
void seen_free(struct seen_list *list);
/* For messages: the channels; the cases, and the depths in m, of the frames that are `right`. */
typedef bool seen_right(const void *ctx, const struct seen *seen);
void seen_channels(const struct seen_list *list, struct name_list *to);
void seen_cases(const struct seen_list *list, seen_right *right, const void *ctx,
                struct name_list *to);
void seen_depths(const struct seen_list *list, seen_right *right, const void *ctx,
                 struct name_list *to);

struct wanted {          /* starts as {0}: every frame                                          */
    const char *channel; /* names separated by commas; NULL: any                                */
    struct numbers depth, number; /* requested depths (m) and cases; n = 0: any */
    /* Called for each frame that is not selected, and returns true if it takes the frame over. NULL: such
     * frames are dropped. It must be NULL where depths are requested. */
    bool (*other)(void *ctx, struct rc_grid *grid);
    void *ctx;
    struct seen_list list;        /* with any selection: all frames so far */
    struct wanted_depths *depths; /* waiting frames of the current case; NULL: none requested */
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

/* Before the first frame: ends the tool for an empty name, or a case that is not a whole number. */
void wanted_check(const struct wanted *wanted, struct tool *tool);
/* The next selected frame; the caller frees it. NULL after the last one. Frames wait here for the end of
 * their case if a later frame may be nearer to the requested depth. */
struct rc_grid *wanted_read(struct wanted *wanted, struct tool *tool);

/* The one of n depths that `asked` selects. It is the nearest, within half the step to the next one, or
 * within a thousandth. NAN: none. */
double wanted_depth(const double *depth, size_t n, double asked);
/* Warns if the selected depth differs from the requested one by more than a thousandth. */
void wanted_tell(struct tool *tool, double asked, double taken);

#endif
