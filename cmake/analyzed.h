/* Included before each file that clang-tidy looks at, except those that define these two functions,
 * because it sees one file at a time. rc_err_set gives nothing but RC_FAIL, and rc_ranks_agree gives
 * RC_OK only where this rank has RC_OK: with that, clang-tidy does not follow impossible paths after
 * a failure. */
#include "libcontact/grid.h"
#include "libcontact/ranks/ranks.h"

#define rc_err_set(...) ((void)rc_err_set(__VA_ARGS__), RC_FAIL)
#define rc_ranks_agree(ranks, status, err) (rc_ranks_agree(ranks, status, err) == RC_OK ? (status) : RC_FAIL)
