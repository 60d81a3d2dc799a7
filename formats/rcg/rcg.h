/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The grid stream RCG1: frames of maps through pipes (rcg(5)).
 *
 * A reader needs no seek and no more memory than one frame; it reads concatenated streams and numbers their
 * cases consecutively. A writer writes one stream with one end line.
 */
#ifndef RC_RCG_H
#define RC_RCG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "libcontact/owned.h"

enum {
    RC_HEADER_MAX = 65536 /* bytes of one frame's header, first to last line feed */
};

/* For several processes that read or write one file, each with its rows of every map. All call the same
 * functions with the same headers; if one fails, all fail. */
struct rc_share {
    void *ctx;
    bool first; /* this process writes everything but the values */
    void (*rows)(void *ctx, const struct rc_shape *shape, size_t *first, size_t *n);
    /* Reads or writes the bytes of this process at a position of the file. All processes call it, also with 0
     * bytes. */
    enum rc_status (*read)(void *ctx, uint64_t at, void *to, size_t bytes, struct rc_err *err);
    enum rc_status (*write)(void *ctx, uint64_t at, const void *from, size_t bytes,
                            struct rc_err *err);
    /* CRC-32 of the concatenated parts of all processes. */
    uint32_t (*crc)(void *ctx, uint32_t own, size_t bytes);
    /* RC_OK when every process succeeded; else RC_FAIL in all, with the message of one that failed. */
    enum rc_status (*agree)(void *ctx, enum rc_status status, struct rc_err *err);
};

struct rc_reader;

/* Reads from `file`, which the caller owns. `first_case` is added to the case numbers of the first stream in
 * it. A frame whose values need more than `memory` bytes is refused; 0 sets no limit. NULL when memory is
 * short. */
struct rc_reader *rc_reader_new(FILE *file, size_t first_case, size_t memory, struct rc_err *err);

/* From now on several processes read the values. `share` is the part of this one and must outlive the reader;
 * `file` is the same file, which every process has opened. */
void rc_reader_share(struct rc_reader *reader, const struct rc_share *share);

/* RC_OK if a frame of this shape with `bytes` of values may be read; else RC_FAIL and the reason in *err. */
typedef enum rc_status rc_reader_allow(void *ctx, const struct rc_shape *shape, size_t bytes,
                                       struct rc_err *err);
/* From now on asks `allow` before it allocates a frame. */
void rc_reader_ask(struct rc_reader *reader, rc_reader_allow *allow, void *ctx);
/* Returns RC_MORE and the next frame, which the caller frees; RC_OK and NULL after the last end line.
 * RC_FAIL: the stream is damaged, cut off, or ended by RCGFAIL, whose message is repeated. */
enum rc_status rc_reader_next(struct rc_reader *reader, struct rc_grid **grid, struct rc_err *err);
/* The same in two steps. First read the next frame without values; then, before the next head, read its
 * values. */
enum rc_status rc_reader_head(struct rc_reader *reader, struct rc_grid **grid, struct rc_err *err);
enum rc_status rc_reader_values(struct rc_reader *reader, struct rc_grid *grid, struct rc_err *err);

/* From now on, before the first head: heads come without memory for values (`elsewhere` is ny), which
 * rc_reader_rows reads. */
void rc_reader_by_rows(struct rc_reader *reader);
/* The rows of the last head that were not read yet. Read them all before the next head. */
size_t rc_reader_left(const struct rc_reader *reader);
/* Reads the next n rows to v; with the last one it also checks the checksum. */
enum rc_status rc_reader_rows(struct rc_reader *reader, size_t n, double *v, struct rc_err *err);
/* Continues after the values of the last head, which are neither read nor checked. RC_FAIL if the frame is
 * not complete, or the input is a pipe. */
enum rc_status rc_reader_skip(struct rc_reader *reader, struct rc_err *err);
/* The next row is the first one of the last head again. RC_FAIL if the input is a pipe. */
enum rc_status rc_reader_again(struct rc_reader *reader, struct rc_err *err);

/* After RC_FAIL: the message of the RCGFAIL that ended the stream, and the exit status of the program that
 * wrote it, 1 or 2. NULL after another failure. Valid as long as the reader. */
const char *rc_reader_failure(const struct rc_reader *reader, int *exit_status);

/* After RC_FAIL: whether the input is not a stream at all, from its first byte on. `head` is then its
 * beginning, a few bytes up to the first NUL, or NULL if it is empty. */
bool rc_reader_foreign(const struct rc_reader *reader, const char **head);

/* Largest case number so far: `first_case` for the reader of the next file. */
size_t rc_reader_last_case(const struct rc_reader *reader);
void rc_reader_free(struct rc_reader *reader);
RC_OWNER(rc_reader)

struct rc_writer;

struct rc_writer *rc_writer_new(FILE *file, struct rc_err *err);
/* A writer whose file several processes write, from this position on. */
struct rc_writer *rc_writer_new_shared(const struct rc_share *share, uint64_t at,
                                       struct rc_err *err);
/* Writes one frame, in grid->type. RC_FAIL when the header is too long or the device fails. */
enum rc_status rc_writer_put(struct rc_writer *writer, const struct rc_grid *grid,
                             struct rc_err *err);
/* The same in parts, for one process: the header, then all values in any number of pieces. */
enum rc_status rc_writer_begin(struct rc_writer *writer, const struct rc_grid *grid,
                               struct rc_err *err);
enum rc_status rc_writer_values(struct rc_writer *writer, const double *v, size_t n,
                                struct rc_err *err);
/* Writes the end line and flushes. */
enum rc_status rc_writer_end(struct rc_writer *writer, struct rc_err *err);
void rc_writer_free(struct rc_writer *writer);
RC_OWNER(rc_writer)

/* RC_FAIL, with a message that names the key and the values that it can have, if this is none of them. Keys
 * without a fixed meaning have any value. */
enum rc_status rc_key_check(const char *name, const char *value, struct rc_err *err);
/* The same for all keys of a frame. */
enum rc_status rc_keys_check(const struct rc_grid *grid, struct rc_err *err);

/* Ends a stream, whether begun or not, with RCGFAIL, the message and the exit status of this program, 1 or 2.
 * The reader of the stream then fails too. Silent when even that cannot be written. */
void rc_stream_fail(FILE *file, const char *message, int exit_status);

#endif
