/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Instrument and exchange formats: bytes -> struct rc_grid. A format is one file,
 * formats/readers/SUBJECT/NAME.c (or NAME/NAME.c, with more files beside it), that ends in its struct
 * rc_format rc_format_NAME, and one line in formats.list.
 *
 * Every reader
 *
 *     1. checks the magic again unless its row has it, because the user may force a format;
 *     2. checks each size against the bytes of the file before allocating;
 *     3. refuses a spacing that is zero, negative, NaN or infinite, and never repairs one;
 *     4. reads numbers with a point in every locale;
 *     5. has an explicit byte order;
 *     6. returns missing points as NaN, by the rule of the format;
 *     7. applies scale and offset by the rule of the format, to metres;
 *     8. keeps row 0 as the top row;
 *     9. frees everything on every path;
 *    10. gives the reason of a failure with the wrong value.
 */
#ifndef RC_FORMAT_H
#define RC_FORMAT_H

#include <stddef.h>

#include "formats/core/core.h"
#include "libcontact/owned.h"

struct rc_format {
    const char *name;     /* "x3p": name for --format                                            */
    const char *suffixes; /* ".x3p": suffixes, separated by spaces */
    const char *summary;  /* one line                                                            */
    /* A file of this format begins with one of these bytes, or has other bytes elsewhere; then `sure` (0: 95)
     * is its score. Another file is refused with this reason, because the user may force a format. */
    struct {
        const char *bytes;
        size_t n;
    } magic[3];
    bool (*is)(const struct rc_file *file);
    int sure;
    const char *refusal;
    /* For other formats: the certainty that the file has this format, 0 to 100, first by content, then by
     * name. */
    int (*score)(const struct rc_file *file);
    /* The same for text without a mark of its format, which is opened for it: all of them share what is in
     * maps->opened. */
    int (*score_open)(struct rc_maps *maps);
    rc_maps_find *find; /* describes the maps of a file (core/maps.h) */
    /* Listing and reading run in a separate process, which also holds the values until it has sent them. */
    bool sandboxed;
    bool copies;  /* the library of that process makes a copy of the file */
    bool columns; /* its channels are columns of one table: a message names the unread columns */
};

/* The formats of formats.list in its order, ended by NULL. */
extern const struct rc_format *const rc_formats[];

/* The format with this name, or NULL. */
const struct rc_format *rc_format_named(const char *name);
/* The format with the highest certainty for the file, or NULL with the reason. */
const struct rc_format *rc_format_find(const struct rc_file *file, struct rc_err *err);

/* Opens a file as this format, or, where it is NULL, as the one with the highest certainty; maps->format says
 * which. NULL with the reason. The caller keeps file and wish until rc_maps_free. */
struct rc_maps *rc_format_open(const struct rc_format *format, const struct rc_file *file,
                               const struct rc_wish *wish, struct rc_err *err);
/* Reads a map of it; see rc_maps_read. */
struct rc_grid *rc_format_read(struct rc_maps *maps, const struct rc_wish *wish, size_t index,
                               struct rc_notes *notes, struct rc_err *err);

/* The kind of a channel, from its name. */
enum rc_named {
    RC_NAMED_TOPOGRAPHY,
    RC_NAMED_NOTHING,   /* neither */
    RC_NAMED_OTHERWISE, /* something else: a deflection, an error signal, ... */
};

/* The default channel. */
struct rc_topography {
    size_t index;        /* index of the channel; if none has the unit, the number of channels */
    enum rc_named named; /* by its name                                                 */
    size_t alike;        /* number of channels with the unit and equally good names */
};
/* Chooses among the channels of channel[0..n) that have this unit (NULL: any), by their names; see
 * topography.c. */
struct rc_topography rc_format_topography(const struct rc_channel *channel, size_t n,
                                          const char *unit);

#endif
