/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A file in memory. It has its format by name and first bytes, positions in it, and its limit of memory. A
 * file is written here too. */
#ifndef RC_FILE_H
#define RC_FILE_H

#include <stdio.h>

#include "bytes.h"
#include "header.h"

struct rc_file {
    const char *name; /* base name, for suffix and messages */
    const unsigned char *data;
    size_t size;
};

/* True if the name of the file ends in one of the suffixes ".a .b", in either case. */
bool rc_file_named(const struct rc_file *file, const char *suffixes);
/* True if the file has these bytes at that position. */
bool rc_file_holds(const struct rc_file *file, size_t at, const void *bytes, size_t n);
/* True if it begins with the byte order mark of UTF-16, of either order. */
bool rc_file_is_utf16(const struct rc_file *file);
/* True if it may be text of one byte a character: not empty, and no NUL in its first 4 KiB. */
bool rc_file_is_text(const struct rc_file *file);
/* The whole file. */
struct rc_piece rc_file_piece(const struct rc_file *file);
/* The text at that position, which must be in the file: up to n bytes or a NUL, trimmed. */
struct rc_piece rc_file_text(const struct rc_file *file, size_t at, size_t n);
/* A cursor at the first byte. */
struct rc_bytes rc_file_bytes(const struct rc_file *file, bool big);

/* Bytes beyond its own that reading a file of that size may need, whatever its header promises: 16 times its
 * size and 64 MiB. Packed data can promise any number of values in a few bytes. */
size_t rc_memory_limit(size_t file_size);
/* RC_FAIL when the values of a map exceed this limit. */
enum rc_status rc_map_fits(const struct rc_file *file, size_t nx, size_t ny, struct rc_err *err);

/* Writes the bytes; RC_FAIL with the system's reason. */
enum rc_status rc_put(FILE *out, const void *bytes, size_t n, struct rc_err *err);
/* Sets that reason after another failed call that writes. */
enum rc_status rc_put_failed(struct rc_err *err);

#endif
