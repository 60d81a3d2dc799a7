/* Input that is no grid stream: what it looks like, and the command that makes one of it. */
#ifndef RC_FOREIGN_H
#define RC_FOREIGN_H

#include <stddef.h>

/* The message for input called `name` ("-": standard input) that begins with `head`, read by
 * `tool`. */
const char *foreign_message(char *text, size_t size, const char *tool, const char *name,
                            const char *head);

#endif
