/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options of the user that supplement or correct a file, such as spacings and units, and notes for the
 * user. */
#ifndef RC_WISH_H
#define RC_WISH_H

#include <stdbool.h>
#include <stddef.h>

#include "libcontact/owned.h"

/* Whether the first row and the first column of a text matrix are labels or positions, not heights. */
enum rc_label {
    RC_LABELS_FOUND, /* rows and columns that look like labels */
    RC_LABELS_KEEP,  /* none                        */
    RC_LABELS_ROW,
    RC_LABELS_COLUMN,
    RC_LABELS_BOTH
};

/* Options of the user for a file. */
struct rc_wish {
    double dx, dy;         /* spacing in metres; NAN: as the file says                     */
    double z_unit;         /* metres per unit of the file's heights; NAN: as the file says */
    char decimal;          /* '.' or ','; 0: detected                                      */
    const char *separator; /* separator of columns in text; NULL: detected */
    const char *missing;   /* a word that marks missing values in text, besides NaN, BAD, ... */
    bool even;             /* resample profiles with uneven points */
    double even_step;      /* m, to this step; 0: to a step from the profile */
    enum rc_label labels;
    double
        /* metres per unit of positions or steps without a unit in the file; NAN: not given */
        xy_unit;
    bool ignore_mask; /* keep points that the file's mask excludes */
};
extern const struct rc_wish rc_no_wish; /* no options: all values from the file */

/* One map in a file, for --list. */
struct rc_channel {
    char name[64];
    char unit[16]; /* SI unit of the values, "m" for heights; "" if unknown */
    size_t nx, ny;
    double dx, dy; /* m; NAN if unknown */
    double beside; /* bytes needed to read the values, besides the values */
};

/* Notes on a file that are not errors. */
struct rc_notes {
    char text[8][200];
    size_t n;
    double metres; /* metres per unit of height of the file; 0: heights are not lengths */
    size_t held;   /* private memory of the process that read the file; 0: this process read it */
    /* Of a resampled profile, relative to the range of its heights: its highest point is this far above the
     * highest node, its lowest point this far below the lowest node. */
    double above, below;
};
void rc_note(struct rc_notes *notes, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Sets shape->dx and dy: the user's (dy equal to dx if only dx is given), else the file's (NAN: none).
 * RC_FAIL when neither gives them, or for a spacing that is not positive and finite. Notes where the user
 * overrules the file. */
enum rc_status rc_spacing(const struct rc_wish *wish, double dx, double dy, struct rc_shape *shape,
                          struct rc_notes *notes, struct rc_err *err);
/* Sets *metres, the metres per unit of the file's heights. The user's value has precedence over the file's.
 * RC_FAIL when neither gives it; `unit` is then the file's text for it, "": none. */
enum rc_status rc_height_unit(const struct rc_wish *wish, double by_file, const char *unit,
                              double *metres, struct rc_notes *notes, struct rc_err *err);

/* For a file that is refused because its spacing is missing. If the unit of its heights is missing too, the
 * message says so, so that the user can give both at once. */
void rc_lacks_unit(const struct rc_wish *wish, double by_file, struct rc_err *err);

#endif
