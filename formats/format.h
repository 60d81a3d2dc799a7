/*
 * Instrument and exchange formats: bytes -> struct rc_grid. A format is one file,
 * formats/readers/SUBJECT/NAME.c (or NAME/NAME.c, with more files beside it), that ends in its struct
 * rc_format rc_format_NAME, and one line in formats.list.
 *
 * What every reader does:
 *   1. looks at the magic again, because the user may force a format;
 *   2. trusts no size: checks it against the bytes that are there before allocating;
 *   3. refuses a spacing that is zero, negative, NaN or infinite, and never repairs one;
 *   4. reads numbers with a point in every locale;
 *   5. spells out byte order;
 *   6. gives missing points as NaN, by the format's own rule;
 *   7. applies scale and offset by the format's own rule, to metres;
 *   8. keeps row 0 as the top row;
 *   9. frees everything on every path;
 *  10. says why, with the offending value.
 */
#ifndef RC_FORMAT_H
#define RC_FORMAT_H

#include <stddef.h>

#include "formats/core/core.h"
#include "libcontact/grid.h"

struct rc_format {
    const char *name;     /* "x3p": what --format takes                                          */
    const char *suffixes; /* ".x3p": separated by spaces                                         */
    const char *summary;  /* one line                                                            */
    /* A file of this format begins with one of these bytes, or is one by what it holds elsewhere; then `sure`
     * (0: 95) is its score. */
    struct {
        const char *bytes;
        size_t n;
    } magic[2];
    bool (*is)(const struct rc_file *file);
    int sure;
    /* Where that does not tell: how sure it is that this is its file, 0 to 100, by content first and name
     * second. */
    int (*score)(const struct rc_file *file);
    /* Describes the maps of a file (core/maps.h); or, where it is NULL, the two functions below. */
    rc_maps_find *find;
    /* Fills at most `most` channels, gives their number in the file; 0 and *err on failure. */
    size_t (*list)(const struct rc_file *file, const struct rc_wish *wish,
                   struct rc_channel *channel, size_t most, struct rc_err *err);
    /* Channel `index` of the list: values, spacing, unit, and keys `file.*`. Channel name is
     * "height" when its unit is metres. */
    struct rc_grid *(*read)(const struct rc_file *file, const struct rc_wish *wish, size_t index,
                            struct rc_notes *notes, struct rc_err *err);
    /* Listing and reading run in a process of their own, which holds the values too until they have been
     * handed over. */
    bool sandboxed;
    bool copies;  /* the library of that process holds a copy of the file */
    bool columns; /* its channels are columns of one table: those that are not read are told of */
};

/* Those of formats.list in its order, ended by NULL. */
extern const struct rc_format *const rc_formats[];

/* The format of that name, or NULL. */
const struct rc_format *rc_format_named(const char *name);
/* The one that is surest of the file, or NULL with the reason. */
const struct rc_format *rc_format_find(const struct rc_file *file, struct rc_err *err);

/* Those of a format, by what its row has: see above. */
int rc_format_score(const struct rc_format *format, const struct rc_file *file);
size_t rc_format_list(const struct rc_format *format, const struct rc_file *file,
                      const struct rc_wish *wish, struct rc_channel *channel, size_t most,
                      struct rc_err *err);
struct rc_grid *rc_format_read(const struct rc_format *format, const struct rc_file *file,
                               const struct rc_wish *wish, size_t index, struct rc_notes *notes,
                               struct rc_err *err);

/* What the name of a channel says of it. */
enum rc_named {
    RC_NAMED_TOPOGRAPHY,
    RC_NAMED_NOTHING,   /* neither */
    RC_NAMED_OTHERWISE, /* something else: a deflection, an error signal, ... */
};

/* The channel that is meant when the user names none. */
struct rc_topography {
    size_t index;        /* of the channel; where none has the unit, the number of channels */
    enum rc_named named; /* by its name                                                 */
    size_t alike;        /* channels with the unit whose names are as good */
};
/* Chooses among the channels of channel[0..n) that have this unit (NULL: any), by their names; see
 * topography.c. */
struct rc_topography rc_format_topography(const struct rc_channel *channel, size_t n,
                                          const char *unit);

#endif
