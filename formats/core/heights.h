/* One map of heights: from what its file says of it to a grid. */
#ifndef RC_HEIGHTS_H
#define RC_HEIGHTS_H

#include "file.h"
#include "wish.h"

struct rc_heights {
    size_t nx, ny;
    double dx, dy;    /* m; NAN when the file does not say                              */
    double metres;    /* that a number of the file is worth; NAN when it does not say   */
    const char *unit; /* the file's own word for that; "" for none                      */
    const char *name; /* NULL, or what it is called: values in another unit are read too */
};

/* A grid for them, its values still to come, and in *metres what a number is worth: both by the
 * wish or else by the file. What is no length keeps its name, and *metres is that in its SI unit.
 * RC_FAIL (NULL) when neither says, or when the map is larger than a file of this size can hold
 * (rc_map_fits). */
struct rc_grid *rc_heights_new(const struct rc_heights *heights, const struct rc_file *file,
                               const struct rc_wish *wish, double *metres, struct rc_notes *notes,
                               struct rc_err *err);
/* The same as a list shows them: the unit is "m" where it is a length. */
struct rc_channel rc_heights_channel(const struct rc_heights *heights, const char *name);

/* Turns the grid upside down: for formats whose first row is the lowest. */
void rc_heights_flip(struct rc_grid *grid);
/* What every reader does with infinite values: they are missing points, as some programs write
 * those, and their number is noted. RC_FAIL when there is no other value. */
enum rc_status rc_heights_finite(struct rc_grid *grid, struct rc_notes *notes, struct rc_err *err);

#endif
