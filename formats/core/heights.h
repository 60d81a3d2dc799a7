/* One map of heights is made from the description of its file to a grid. */
#ifndef RC_HEIGHTS_H
#define RC_HEIGHTS_H

#include "file.h"
#include "wish.h"

struct rc_heights {
    size_t nx, ny;
    double dx, dy;    /* m; NAN when the file does not say                      */
    double metres;    /* metres per number of the file; NAN when the file does not say */
    const char *unit; /* the file's unit as text; "": none                      */
    /* NULL, or the name of the values: other units than lengths are then permitted */
    const char *name;
};

/* Makes a grid for the heights, without values, and sets *metres to the metres per number of the file.
 * Options of the user override the file. Values that are not lengths keep their name, and *metres is then the
 * factor to their SI unit. RC_FAIL (NULL) when neither user nor file gives the spacing or the unit. Also when
 * the map is larger than a file of this size can hold (rc_map_fits). */
struct rc_grid *rc_heights_new(const struct rc_heights *heights, const struct rc_file *file,
                               const struct rc_wish *wish, double *metres, struct rc_notes *notes,
                               struct rc_err *err);
/* The map as a channel of a list: the unit is "m" for a length. */
struct rc_channel rc_heights_channel(const struct rc_heights *heights, const char *name);

/* Turns the grid upside down: for formats whose first row is the lowest. */
void rc_heights_flip(struct rc_grid *grid);
/* Sets infinite values, which some programs write for missing points, to missing and notes their number;
 * every reader calls it. RC_FAIL when no finite value is left. */
enum rc_status rc_heights_finite(struct rc_grid *grid, struct rc_notes *notes, struct rc_err *err);

#endif
