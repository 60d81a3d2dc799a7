/*
 * Instrument and exchange formats: bytes -> struct rc_grid. A format is one file,
 * formats/readers/NAME.c, that ends in its struct rc_format rc_format_NAME, and one line in
 * formats.list.
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

#include "libcontact/grid.h"

/* A file that has been read whole. */
struct rc_file {
    const char *name; /* base name, for suffix and messages */
    const unsigned char *data;
    size_t size;
};

/* What the user says beside the file. */
struct rc_wish {
    double dx, dy; /* spacing in metres; NAN: as the file says                             */
    double z_unit; /* metres per unit of the file's heights; NAN: as the file says         */
    char decimal;  /* '.' or ','; 0: found out                                             */
    const char *separator; /* of columns in text; NULL: found out                                */
    const char *missing; /* a word that marks missing values in text, beside NaN, BAD, ...       */
};
extern const struct rc_wish rc_no_wish; /* of a user who says nothing: all is as the file says */

/* One map in a file, as --list shows it. */
struct rc_channel {
    char name[64];
    char unit[16]; /* SI unit of the values, "m" for heights; "" when the file does not say    */
    size_t nx, ny;
    double dx, dy; /* m; NAN when the file does not say                                        */
};

/* Things worth saying that are no errors. */
struct rc_notes {
    char text[8][200];
    size_t n;
};
void rc_note(struct rc_notes *notes, const char *format, ...) __attribute__((format(printf, 2, 3)));

struct rc_format {
    const char *name;     /* "x3p": what --format takes                                          */
    const char *suffixes; /* ".x3p": separated by spaces                                         */
    const char *summary;  /* one line                                                            */
    /* How sure it is that this is its file, 0 to 100, by content first and name second. */
    int (*score)(const struct rc_file *file);
    /* Fills at most `most` channels, gives their number in the file; 0 and *err on failure. */
    size_t (*list)(const struct rc_file *file, const struct rc_wish *wish,
                   struct rc_channel *channel, size_t most, struct rc_err *err);
    /* Channel `index` of the list: values, spacing, unit, and keys `file.*`. Channel name is
     * "height" when its unit is metres. */
    struct rc_grid *(*read)(const struct rc_file *file, const struct rc_wish *wish, size_t index,
                            struct rc_notes *notes, struct rc_err *err);
};

/* Sets shape->dx and dy: as wished (dy as dx when only dx was), else as the file says; NAN is a
 * file that does not say. RC_FAIL when neither says, or for a spacing that is not positive and
 * finite. Notes where a wish overrules the file. */
enum rc_status rc_spacing(const struct rc_wish *wish, double dx, double dy, struct rc_shape *shape,
                          struct rc_notes *notes, struct rc_err *err);
/* Sets *metres, what one unit of the file's heights is worth: as wished, else as the file says.
 * RC_FAIL when neither does; `unit` is then the file's own word for it, "" for none. */
enum rc_status rc_height_unit(const struct rc_wish *wish, double by_file, const char *unit,
                              double *metres, struct rc_notes *notes, struct rc_err *err);

/* Adds to the refusal of a file that does not say its spacing that it does not say the unit of its
 * heights either, so that both are asked for at once. */
void rc_lacks_unit(const struct rc_wish *wish, double by_file, struct rc_err *err);

/* Those of formats.list in its order, ended by NULL. */
extern const struct rc_format *const rc_formats[];

/* The format of that name, or NULL. */
const struct rc_format *rc_format_named(const char *name);
/* The one that is surest of the file, or NULL with the reason. */
const struct rc_format *rc_format_find(const struct rc_file *file, struct rc_err *err);

#endif
