/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Input that is not a grid stream: its kind, and the command that converts it. */
#ifndef RC_FOREIGN_H
#define RC_FOREIGN_H

#include <stddef.h>

/* The message for the input `name` ("-": standard input) that begins with `head`, read by `tool`. */
const char *foreign_message(char *text, size_t size, const char *tool, const char *name,
                            const char *head);

#endif
