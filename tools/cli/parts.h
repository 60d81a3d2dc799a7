/*
 * What the parts of a tool share: options.c, input.c, output.c, tool.c. Not for the tools
 * themselves.
 */
#ifndef RC_PARTS_H
#define RC_PARTS_H

#include "tool.h"

enum {
    TOOL_BUFFER = 1 << 16 /* bytes read or written together; more at once passes it by */
};

/* Word k of an option that takes one of a list, or some: its start and length; NULL past the
 * last. */
const char *option_word(const struct opt *option, size_t k, size_t *length);
/* Row k of those that every tool has; NULL past the last one that this one has. */
const struct opt *option_common(const struct tool_info *info, size_t k);
/* Prints the completions of bash, zsh or fish, or the option table as json; false: another word. */
bool completions_print(const struct tool *tool, const char *shell);
/* Reads the command line into tool->args and the options of every tool. */
void options_read(struct tool *tool, int argc, char **argv);

/* How many values are NaN, and how many are infinite or would be in the frame's type. They are
 * counted over the whole map: processes that share it call together. */
struct not_finite {
    size_t missing, infinite;
} not_finite(const struct tool *tool, const struct rc_grid *grid);

/* SIGINT, SIGTERM and SIGHUP remove what is half-written and end the tool. */
void output_handle_signals(void);
void output_open(struct tool *tool);
/* Ends the stream, closes, puts the file in place. */
void output_end(struct tool *tool);
/* Where a signal has come, ends by it. */
void output_end_by_signal(void);
/* The tool cannot go on: says so in a stream that has begun and, in a pipe, even before one has,
 * and removes half-written files. */
void output_abandon(struct tool *tool, const char *why, int exit_status);
/* Ends the tool as the one before it in the pipe, which has said why: with its message and its exit
 * status. */
_Noreturn void fail_as_before(struct tool *tool, const char *message, int exit_status);

#endif
