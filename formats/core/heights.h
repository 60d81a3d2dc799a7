/* One map of heights: from what its file says of it to a grid. */
#ifndef RC_HEIGHTS_H
#define RC_HEIGHTS_H

#include "file.h"
#include "wish.h"

struct rc_heights {
    size_t nx, ny;
    double dx, dy;    /* m; NAN when the file does not say                              */
    double metres;    /* in one number of the file; NAN when it does not say */
    const char *unit; /* the file's own word for that; "" for none                      */
    const char *name; /* NULL, or what it is called: values in another unit are read too */
};

/* Makes a grid for the heights, without values yet, and sets *metres to the metres in one number of
 * the file; a wish of the user comes before the file. Values that are no lengths keep their name,
 * and *metres is then the factor to their SI unit. RC_FAIL (NULL) when neither user nor file gives
 * the spacing or the unit, or when the map is larger than a file of this size can hold
 * (rc_map_fits). */
struct rc_grid *rc_heights_new(const struct rc_heights *heights, const struct rc_file *file,
                               const struct rc_wish *wish, double *metres, struct rc_notes *notes,
                               struct rc_err *err);
/* The map as a list of channels shows it: the unit is "m" for a length. */
struct rc_channel rc_heights_channel(const struct rc_heights *heights, const char *name);

/* Turns the grid upside down: for formats whose first row is the lowest. */
void rc_heights_flip(struct rc_grid *grid);
/* Turns infinite values, which some programs write for missing points, into missing points and
 * notes their number; every reader calls it. RC_FAIL when no finite value is left. */
enum rc_status rc_heights_finite(struct rc_grid *grid, struct rc_notes *notes, struct rc_err *err);

#endif
