/* What readers do with the values once they have them. */
#ifndef RC_VALUES_H
#define RC_VALUES_H

#include "formats/format.h"

/* Turns the rows over: for formats whose first row is the lowest. */
void rc_values_flip(struct rc_grid *grid);
/* RC_FAIL where a value is infinite; NaN is a missing one. */
enum rc_status rc_values_finite(const struct rc_grid *grid, struct rc_err *err);

#endif
