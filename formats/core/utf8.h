/* UTF-8. */
#ifndef RC_UTF8_H
#define RC_UTF8_H

#include <stdbool.h>
#include <stddef.h>

/* Whether text is UTF-8 as RFC 3629 has it: no overlong forms, no surrogates, up to U+10FFFF. */
bool rc_utf8_valid(const char *text);
/* Puts the bytes of a code point below U+10000, 1 to 3 without a NUL; gives their number. */
size_t rc_utf8_put(char *to, unsigned code);

#endif
