/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Writing of exchange formats: struct rc_grid -> bytes.
 *
 * A written format is one file, formats/writers/NAME.c, that ends in its struct rc_export rc_export_NAME, and
 * one line in exports.list. Every writer
 *
 *     1. writes sequentially, because the output may be a pipe;
 *     2. has an explicit byte order, and numbers with a point in every locale;
 *     3. marks missing points by the rule of the format, and refuses data that the format cannot hold;
 *     4. keeps row 0 as the top row;
 *     5. writes no time and no file name: the same frames and options give the same bytes.
 */
#ifndef RC_EXPORT_H
#define RC_EXPORT_H

#include <stdint.h>
#include <stdio.h>

#include "formats/core/core.h"
#include "libcontact/owned.h"

/* Options of the user. */
struct rc_export_wish {
    bool typed;          /* true: `raw` was requested */
    enum rc_raw raw;     /* type of the values in the file */
    int64_t time;        /* seconds since 1970, for formats with a mandatory date */
    const char *creator; /* program and version, for formats that name it */
    const char *missing; /* word for a missing point in text; NULL: the word of the format */
    /* m: height of a print from its lowest to its highest point; 0: to scale with the map */
    double relief;
};

enum {
    /* bits of rc_export.types: 1 << enum rc_raw */
    RC_TYPE_I16 = 1 << RC_RAW_I16,
    RC_TYPE_I32 = 1 << RC_RAW_I32,
    RC_TYPE_F32 = 1 << RC_RAW_F32,
    RC_TYPE_F64 = 1 << RC_RAW_F64,
};

struct rc_export {
    const char *name;     /* "x3p": name for --format                                         */
    const char *suffixes; /* ".x3p": suffixes, separated by spaces; they select the format of -o
                             NAME */
    const char *summary;  /* one line                                                         */
    bool text;            /* readable: may be written to a terminal                           */
    bool several;         /* accepts several frames; otherwise only one */
    bool stack;           /* accepts the depths of one channel and case */
    bool uneven;          /* stores the depth of each row of a section: depths may be uneven */
    bool lengths;         /* its spacings are lengths: refuses another dunit */
    bool heights;         /* the values of the format are metres: only heights */
    unsigned types;       /* possible types, from the bits above; 0: text */
    bool relief;          /* is for printers: accepts a relief height */
    /* NULL, or writes the size of the result for a frame to text[0..size); "" if it refuses the frame. */
    void (*foretell)(const struct rc_grid *frame, const struct rc_export_wish *wish, char *text,
                     size_t size);
    /* Writes frame[0..frames), frames > 0. RC_FAIL for frames that the format cannot hold, or when writing
     * fails. */
    enum rc_status (*write)(FILE *out, struct rc_grid *const *frame, size_t frames,
                            const struct rc_export_wish *wish, struct rc_err *err);
};

/* Writes the frames. A section whose rows have uneven depths is refused unless the format is
 * `uneven`. */
enum rc_status rc_export_write(const struct rc_export *format, FILE *out,
                               struct rc_grid *const *frame, size_t frames,
                               const struct rc_export_wish *wish, struct rc_err *err);

/* The formats of exports.list in its order, ended by NULL. */
extern const struct rc_export *const rc_exports[];

/* The format with this name, or NULL. */
const struct rc_export *rc_export_named(const char *name);
/* The first format with the suffix of the file name, or NULL. */
const struct rc_export *rc_export_suffixed(const char *file);

/* The type of the values is the requested one, else that of the frame, else the widest of `types`. */
enum rc_raw rc_export_raw(const struct rc_grid *grid, const struct rc_export_wish *wish,
                          unsigned types);

/* Reads the depths of a section's rows from its key `depths`, ny numbers separated by commas or spaces, into
 * at. RC_FAIL if their number is not ny or they do not rise. */
enum rc_status rc_export_depths(const struct rc_grid *grid, double *at, struct rc_err *err);
/* True if n positions have even steps, except for rounding; returns the step, 0 for a single one. */
bool rc_export_even(const double *at, size_t n, double *step);

enum {
    RC_LABEL = 160
};
/* Gives frame k a unique name: "pressure"; "pressure_case2" with several cases; "mises_z2e-05" if `depths` is
 * set and the depths differ. Returns `label`. */
const char *rc_export_label(char label[RC_LABEL], struct rc_grid *const *frame, size_t frames,
                            size_t k, bool depths);

/* The date of the measurement from the keys of the frame, else the time of the options:
 * "2026-11-21T09:30:00Z" (ISO 8601). */
enum {
    RC_DATE = 32
};
const char *rc_export_date(char date[RC_DATE], const struct rc_grid *grid,
                           const struct rc_export_wish *wish);

#endif
