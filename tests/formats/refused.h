/* Whether a refusal gives the reason that it should. */
#ifndef REFUSED_H
#define REFUSED_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* Where addresses have 32 bits, a size that lies may be refused earlier, as more than there can be. */
static inline bool
gives_reason(const char *text, const char *why)
{
    return strstr(text, why) != NULL ||
           (SIZE_MAX == UINT32_MAX && strstr(text, "more than this machine can address") != NULL);
}

#endif
