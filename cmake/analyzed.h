/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Included before each file that clang-tidy checks, except those that define these two functions, because it
 * sees one file at a time. rc_err_set always returns RC_FAIL, and rc_ranks_agree returns RC_OK only if this
 * rank has RC_OK. With this knowledge clang-tidy does not follow impossible paths after a failure. */
#include "libcontact/grid.h"
#include "libcontact/ranks/ranks.h"

#define rc_err_set(...) ((void)rc_err_set(__VA_ARGS__), RC_FAIL)
#define rc_ranks_agree(ranks, status, err)                                                         \
    (rc_ranks_agree(ranks, status, err) == RC_OK ? (status) : RC_FAIL)
