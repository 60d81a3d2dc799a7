/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * libcontact on several processes: the ranks of an MPI communicator share a map, each with some of its rows.
 * It exists only in a library built with MPI (-DRC_MPI=ON).
 *
 *     struct rc_ranks *ranks = rc_ranks_new(MPI_COMM_WORLD, &err);
 *     rc_ranks_rows(ranks, &shape, &first, &n);
 *     struct rc_problem problem = {..., .ranks = ranks};
 *     solver = rc_solver_new(&shape, h, &problem, &err);
 *
 * rc_ranks_rows tells the rows of this rank; shape is the whole map, h its n rows. Shapes are those of whole
 * maps; every array of values holds the rows of this rank only, and may be empty.
 * Calls that take such an object are made by all ranks, with equal arguments except arrays. Their results and
 * errors are the same on all ranks. MPI_THREAD_FUNNELED is enough: MPI is called by the calling thread alone.
 */
#ifndef RC_CONTACT_MPI_H
#define RC_CONTACT_MPI_H

#include <mpi.h>

#include "contact.h"

#ifdef __cplusplus
extern "C" {
#endif

/* By all ranks of comm, which is duplicated. NULL when memory is short. */
RC_API struct rc_ranks *rc_ranks_new(MPI_Comm comm, struct rc_err *err);
/* All ranks call it, before MPI_Finalize, after they have freed all objects that use these ranks. NULL is
 * allowed. */
RC_API void rc_ranks_free(struct rc_ranks *ranks);
/* Rows of a map that this rank holds: `n` from `first` on; n may be 0. */
RC_API void rc_ranks_rows(const struct rc_ranks *ranks, const struct rc_shape *shape, size_t *first,
                          size_t *n);

/* The data that all ranks have sent to each other since rc_ranks_new. */
RC_API void rc_ranks_sent(const struct rc_ranks *ranks, struct rc_sent *sent);

#ifdef __cplusplus
}
#endif

#endif
