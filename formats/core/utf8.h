#ifndef RC_UTF8_H
#define RC_UTF8_H

#include <stdbool.h>

/* Whether text is UTF-8 as RFC 3629 has it: no overlong forms, no surrogates, up to U+10FFFF. */
bool rc_utf8_valid(const char *text);

#endif
