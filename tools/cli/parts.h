/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Only options.c, input.c, output.c and tool.c share this header, not the tools themselves.
 */
#ifndef RC_PARTS_H
#define RC_PARTS_H

#include "tool.h"

enum {
    TOOL_BUFFER = 1 << 16 /* size of the buffer for reading and writing; larger blocks bypass it */
};

/* Index of text[0..n) among the words of an option, or -1. */
int option_word_index(const struct opt *option, const char *text, size_t n);
/* Word k of an option with a list of words: its start and length; NULL past the last. */
const char *option_word(const struct opt *option, size_t k, size_t *length);
/* Row k of the common options; NULL past the last one of this tool. */
const struct opt *option_common(const struct tool *tool, size_t k);
/* Writes the words of a list, separated by blanks or '|', as an array. */
void option_json_list(struct json *json, const char *name, const char *words);
/* Prints the completions of bash, zsh or fish, or the option table as json; false for another word. */
bool completions_print(const struct tool *tool, const char *shell);
/* Ends the tool if the command line breaks a rule of an option. */
void rules_check(struct tool *tool);
/* "needs --tilt free; not with --history": the rules of an option, as in --help; valid until the next
 * call. */
const char *rules_text(const struct tool *tool, const struct opt *option);
/* Writes them as members of an object. */
void rules_json(struct json *json, const struct tool *tool, const struct opt *option);
/* Reads the command line into tool->args and the common options. */
void options_read(struct tool *tool, int argc, char **argv);

/* Counts values that are NaN, and values that are infinite or would be infinite in the type of the frame. The
 * counts are over the whole map: processes that share it call together. */
struct not_finite {
    size_t missing, infinite;
} not_finite(const struct tool *tool, const struct rc_grid *grid);
/* The same of some values of this process. */
struct not_finite not_finite_in(enum rc_type type, const double *v, size_t n);

/* Makes SIGINT, SIGTERM and SIGHUP remove incomplete files and end the tool. */
void output_handle_signals(void);
void output_open(struct tool *tool);
/* Ends the stream, closes the file and gives it its final name. */
void output_end(struct tool *tool);
/* If a signal has arrived, ends the tool by it. */
void output_end_by_signal(void);
/* For a tool that cannot continue: writes the failure to a stream that has begun and, in a pipe, even before,
 * and removes incomplete files. */
void output_abandon(struct tool *tool, const char *why, int exit_status);
/* Ends the tool like the failed one before it in the pipe, with the same message in the stream and the same
 * exit status. */
_Noreturn void fail_as_before(struct tool *tool, const char *message, int exit_status);

#endif
