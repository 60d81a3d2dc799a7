/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "wish.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void
rc_note(struct rc_notes *notes, const char *format, ...)
{
    va_list ap;

    if (notes == NULL || notes->n == sizeof notes->text / sizeof *notes->text)
        return;
    va_start(ap, format);
    vsnprintf(notes->text[notes->n++], sizeof *notes->text, format, ap);
    va_end(ap);
}

/* One axis of rc_spacing. */
static enum rc_status
pick_spacing(char axis, double wished, double by_file, double *spacing, struct rc_notes *notes,
             struct rc_err *err)
{
    bool given = !isnan(wished);

    *spacing = given ? wished : by_file;
    if (isnan(*spacing))
        return rc_err_set(err, "the file does not give the spacing in %c: --d%c LENGTH says it",
                          axis, axis);
    if (!(*spacing > 0) || isinf(*spacing))
        return rc_err_set(err, "the spacing in %c is %s m%s: it must be positive and finite", axis,
                          rc_number(*spacing), given ? "" : " in the file");
    if (given && !isnan(by_file) && wished != by_file)
        rc_note(notes, "the spacing in %c is %s m as given; the file says %s m", axis,
                rc_number(wished), rc_number(by_file));
    return RC_OK;
}

enum rc_status
rc_spacing(const struct rc_wish *wish, double dx, double dy, struct rc_shape *shape,
           struct rc_notes *notes, struct rc_err *err)
{
    double wished_dy = isnan(wish->dy) ? wish->dx : wish->dy;

    if (pick_spacing('x', wish->dx, dx, &shape->dx, notes, err) != RC_OK)
        return RC_FAIL;
    return pick_spacing('y', wished_dy, dy, &shape->dy, notes, err);
}

void
rc_lacks_unit(const struct rc_wish *wish, double by_file, struct rc_err *err)
{
    static const char more[] = ", and the unit of its heights is missing too: give --z-unit UNIT";

    if (err != NULL && isnan(wish->z_unit) && isnan(by_file) &&
        strlen(err->text) + sizeof more <= sizeof err->text)
        strcat(err->text, more);
}

enum rc_status
rc_height_unit(const struct rc_wish *wish, double by_file, const char *unit, double *metres,
               struct rc_notes *notes, struct rc_err *err)
{
    *metres = isnan(wish->z_unit) ? by_file : wish->z_unit;
    if (isnan(*metres) && *unit == '\0')
        return rc_err_set(err, "the file does not give the unit of its heights: --z-unit says it "
                               "(um, nm, or a number of metres)");
    if (isnan(*metres))
        return rc_err_set(err,
                          "the values are in '%s', which is not a length: --z-unit says how many "
                          "metres one of them is",
                          unit);
    if (*metres == 0 || isinf(*metres))
        return rc_err_set(err, "one unit of height is %s m: it must be finite and not 0",
                          rc_number(*metres));
    if (!isnan(wish->z_unit) && !isnan(by_file) && wish->z_unit != by_file)
        rc_note(notes, "one unit of height is %s m as given; the file says %s m",
                rc_number(wish->z_unit), rc_number(by_file));
    if (notes != NULL)
        notes->metres = *metres;
    return RC_OK;
}
