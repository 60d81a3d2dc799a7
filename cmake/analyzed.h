/* Included before each file that clang-tidy looks at, but those that hold these two functions, as it sees one
 * file at a time: rc_err_set never gives anything but RC_FAIL, and rc_ranks_agree gives RC_OK only where this
 * rank has it, so that what follows a failure need not be thought of. */
#include "libcontact/grid.h"
#include "libcontact/ranks/ranks.h"

#define rc_err_set(...) ((void)rc_err_set(__VA_ARGS__), RC_FAIL)
#define rc_ranks_agree(ranks, status, err) (rc_ranks_agree(ranks, status, err) == RC_OK ? (status) : RC_FAIL)
