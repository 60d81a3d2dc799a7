/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "crc32.h"

#include <libdeflate.h>
#include <zlib.h>

uint32_t
rc_crc32_add(uint32_t crc, const void *bytes, size_t n)
{
    return libdeflate_crc32(crc, bytes, n);
}

uint32_t
rc_crc32_join(uint32_t first, uint32_t second, uint64_t n)
{
    return (uint32_t)crc32_combine(first, second, (z_off_t)n);
}
