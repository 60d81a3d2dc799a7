/*
 * CRC-32 as zlib, gzip and PNG have it (polynomial 0x04c11db7, reflected), which closes every frame of a
 * stream; the only place that knows libdeflate, whose sum takes a ninth of the time of zlib's.
 */
#ifndef RC_CRC32_H
#define RC_CRC32_H

#include <stddef.h>
#include <stdint.h>

/* Continues a checksum: `crc` is that of the bytes before (0: of none), n more bytes follow. */
uint32_t rc_crc32_add(uint32_t crc, const void *bytes, size_t n);
/* The checksum of two parts one after another, the second of n bytes. */
uint32_t rc_crc32_join(uint32_t first, uint32_t second, uint64_t n);

#endif
