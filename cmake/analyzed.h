/* Included before each file that clang-tidy looks at, which sees one at a time, but those that hold these two: rc_err_set never
 * gives anything but RC_FAIL, and rc_ranks_agree gives RC_OK only where this rank has it, so what follows a failure need not be
 * thought of. */
#include "libcontact/grid.h"
#include "libcontact/ranks/ranks.h"

#define rc_err_set(...) ((void)rc_err_set(__VA_ARGS__), RC_FAIL)
#define rc_ranks_agree(ranks, status, err) (rc_ranks_agree(ranks, status, err) == RC_OK ? (status) : RC_FAIL)
