/* What the user says beside a file, such as spacings and units that the file lacks or gives wrong, and
 * what is noted for the user. */
#ifndef RC_WISH_H
#define RC_WISH_H

#include <stdbool.h>
#include <stddef.h>

#include "libcontact/grid.h"

/* Which of the first row and column of a matrix as text are labels or positions, and no heights. */
enum rc_label {
    RC_LABELS_FOUND, /* those that look like it */
    RC_LABELS_KEEP,  /* none                    */
    RC_LABELS_ROW,
    RC_LABELS_COLUMN,
    RC_LABELS_BOTH
};

/* What the user says beside the file. */
struct rc_wish {
    double dx, dy; /* spacing in metres; NAN: as the file says                             */
    double z_unit; /* metres per unit of the file's heights; NAN: as the file says         */
    char decimal;  /* '.' or ','; 0: found out                                             */
    const char *separator; /* of columns in text; NULL: found out                                */
    const char *missing; /* a word that marks missing values in text, beside NaN, BAD, ...       */
    bool even;           /* profiles whose points are not evenly apart are resampled             */
    double even_step;    /* m, to this step; 0: to one of their own                              */
    enum rc_label labels;
    double
        xy_unit; /* metres per unit of positions or steps that have none in the file; NAN: not said */
    bool ignore_mask; /* points that the file's mask excludes are kept                            */
};
extern const struct rc_wish rc_no_wish; /* of a user who says nothing: all is as the file says */

/* One map in a file, as --list shows it. */
struct rc_channel {
    char name[64];
    char unit[16]; /* SI unit of the values, "m" for heights; "" when the file does not say    */
    size_t nx, ny;
    double dx, dy; /* m; NAN when the file does not say                                        */
    double beside; /* bytes that reading the values takes beside them                          */
};

/* Remarks on a file, which are no errors. */
struct rc_notes {
    char text[8][200];
    size_t n;
    double metres; /* in one unit of height of the file; 0: heights are in no length */
    size_t held;   /* private memory of the process that read the file; 0: this process read it */
    double above, below; /* of a profile that was resampled: how far its highest point is above the
                            highest node, and its lowest below the lowest, in spans of its heights */
};
void rc_note(struct rc_notes *notes, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Sets shape->dx and dy: as wished (dy as dx when only dx was), else as the file says (NAN: it does
 * not say). RC_FAIL when neither says, or for a spacing that is not positive and finite. Notes
 * where a wish overrules the file. */
enum rc_status rc_spacing(const struct rc_wish *wish, double dx, double dy, struct rc_shape *shape,
                          struct rc_notes *notes, struct rc_err *err);
/* Sets *metres, the metres in one unit of the file's heights: as wished, else as the file says.
 * RC_FAIL when neither does; `unit` is then the file's own word for it, "" for none. */
enum rc_status rc_height_unit(const struct rc_wish *wish, double by_file, const char *unit,
                              double *metres, struct rc_notes *notes, struct rc_err *err);

/* For a file that is refused because it lacks its spacing: where it lacks the unit of its heights
 * too, says so in the refusal, so that the user is asked for both at once. */
void rc_lacks_unit(const struct rc_wish *wish, double by_file, struct rc_err *err);

#endif
