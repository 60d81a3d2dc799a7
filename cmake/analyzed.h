/* Included before each file that clang-tidy looks at, which sees one at a time: rc_err_set, which
 * stands in another, never gives anything but RC_FAIL, so what follows a failure need not be thought
 * of. */
#include "libcontact/grid.h"

#define rc_err_set(...) ((void)rc_err_set(__VA_ARGS__), RC_FAIL)
