/* What readers do with the values once they have them. */
#ifndef RC_VALUES_H
#define RC_VALUES_H

#include "formats/format.h"

/* Turns the rows over: for formats whose first row is the lowest. */
void rc_values_flip(struct rc_grid *grid);
/* RC_FAIL where a value is infinite; NaN is a missing one. */
enum rc_status rc_values_finite(const struct rc_grid *grid, struct rc_err *err);

/* Bytes that reading a file may take at most: 16 times its own and 64 MiB. */
size_t rc_memory_bound(const struct rc_file *file);
/* RC_FAIL when the values of a map are more than that: a packed file can promise any number. */
enum rc_status rc_map_fits(const struct rc_file *file, size_t nx, size_t ny, struct rc_err *err);

#endif
