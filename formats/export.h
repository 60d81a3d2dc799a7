/*
 * Exchange formats the other way: struct rc_grid -> bytes. A format that is written is one file,
 * formats/writers/NAME.c, that ends in its struct rc_export rc_export_NAME, and one line in
 * exports.list.
 *
 * What every writer does:
 *   1. writes straight on, without seeking: the output may be a pipe;
 *   2. spells out byte order, and numbers with a point in every locale;
 *   3. marks missing points by the format's own rule, and refuses what the format cannot say;
 *   4. keeps row 0 as the top row;
 *   5. keeps no clock and no file name: the same frames and wishes give the same bytes.
 */
#ifndef RC_EXPORT_H
#define RC_EXPORT_H

#include <stdint.h>
#include <stdio.h>

#include "formats/core/core.h"
#include "libcontact/grid.h"

/* What the user says beside the frames. */
struct rc_export_wish {
    bool typed;          /* whether `raw` was asked for                                       */
    enum rc_raw raw;     /* how values are to lie in the file                                 */
    int64_t time;        /* seconds since 1970, for formats that must bear a date             */
    const char *creator; /* program and version, for those that name it                       */
    const char *missing; /* word for a missing point in text; NULL: the format's own          */
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
    const char *name;     /* "x3p": what --format takes                                       */
    const char *suffixes; /* ".x3p": separated by spaces; -o NAME chooses by them             */
    const char *summary;  /* one line                                                         */
    bool text;            /* for people too: may be written to a terminal                     */
    bool several;         /* takes several frames; else just one                              */
    bool stack;           /* or the depths of one channel and case                            */
    bool uneven;          /* says where each row of a section is: its depths may be uneven    */
    bool lengths;         /* says of its spacings that they are lengths: refuses another dunit */
    bool heights;         /* says metres by its definition: holds heights only                */
    unsigned types;       /* types that it can hold, of the bits above; 0: text */
    unsigned copies; /* copies of all values that it holds in memory, as they lie in the file */
    bool relief;     /* is for printers: takes a wished relief                               */
    /* NULL, or says into text[0..size) how large what it makes of a frame will be; "" where it refuses. */
    void (*foretell)(const struct rc_grid *frame, const struct rc_export_wish *wish, char *text,
                     size_t size);
    /* Writes frame[0..frames), frames > 0. RC_FAIL for what the format cannot hold, or when the
     * device refuses. */
    enum rc_status (*write)(FILE *out, struct rc_grid *const *frame, size_t frames,
                            const struct rc_export_wish *wish, struct rc_err *err);
};

/* Writes the frames. A section whose rows have uneven depths is refused unless the format is
 * `uneven`. */
enum rc_status rc_export_write(const struct rc_export *format, FILE *out,
                               struct rc_grid *const *frame, size_t frames,
                               const struct rc_export_wish *wish, struct rc_err *err);

/* Those of exports.list in its order, ended by NULL. */
extern const struct rc_export *const rc_exports[];

/* The one of that name, or NULL. */
const struct rc_export *rc_export_named(const char *name);
/* The first one whose suffix the file name has, or NULL. */
const struct rc_export *rc_export_suffixed(const char *file);

/* How values are to lie: as wished, else in the frame's own type, else in the widest of `types`. */
enum rc_raw rc_export_raw(const struct rc_grid *grid, const struct rc_export_wish *wish,
                          unsigned types);

/* Reads the depths of a section's rows from its key `depths`, ny numbers separated by commas or
 * spaces, into at. RC_FAIL when their number is not ny or they do not rise from row to row. */
enum rc_status rc_export_depths(const struct rc_grid *grid, double *at, struct rc_err *err);
/* Whether n places have even steps, but for rounding, and the step; 0 for a single one. */
bool rc_export_even(const double *at, size_t n, double *step);

enum {
    RC_LABEL = 160
};
/* Gives frame k a name that no other frame has: "pressure"; "pressure_case2" when there are several
 * cases; "mises_z2e-05" when `depths` is set and the depths differ. Returns `label`. */
const char *rc_export_label(char label[RC_LABEL], struct rc_grid *const *frame, size_t frames,
                            size_t k, bool depths);

/* The date of the measurement from the frame's file, else the time of the wish:
 * "2026-11-21T09:30:00Z" (ISO 8601). */
enum {
    RC_DATE = 32
};
const char *rc_export_date(char date[RC_DATE], const struct rc_grid *grid,
                           const struct rc_export_wish *wish);

#endif
