/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * CRC-32 of zlib, gzip and PNG (polynomial 0x04c11db7, reflected), at the end of every frame of a stream.
 * Only this file uses libdeflate, whose CRC-32 takes a ninth of the time of zlib's.
 */
#ifndef RC_CRC32_H
#define RC_CRC32_H

#include <stddef.h>
#include <stdint.h>

/* Continues a checksum: `crc` is that of the preceding bytes (0: none), n more bytes follow. */
uint32_t rc_crc32_add(uint32_t crc, const void *bytes, size_t n);
/* The checksum of two parts one after another, the second of n bytes. */
uint32_t rc_crc32_join(uint32_t first, uint32_t second, uint64_t n);

#endif
