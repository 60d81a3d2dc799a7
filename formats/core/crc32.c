#include "crc32.h"

#include <libdeflate.h>

uint32_t
rc_crc32_add(uint32_t crc, const void *bytes, size_t n)
{
    return libdeflate_crc32(crc, bytes, n);
}
