/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact tests under mpirun: every process runs the whole test, but the processes share the solution of each
 * contact. The results are gathered, and each process checks all of them. */
#ifndef CONTACT_RANKS_H
#define CONTACT_RANKS_H

#include "libcontact/contact_mpi.h"

static struct rc_ranks *contact_ranks;

__attribute__((constructor)) static void
contact_start(void)
{
    struct rc_err err;

    MPI_Init(NULL, NULL);
    contact_ranks = rc_ranks_new(MPI_COMM_WORLD, &err);
    if (contact_ranks == NULL)
        MPI_Abort(MPI_COMM_WORLD, 1);
}

__attribute__((destructor)) static void
contact_end(void)
{
    rc_ranks_free(contact_ranks);
    MPI_Finalize();
}

struct contact_part {
    const double *h;
    double *p, *gap, *u;
};

/* Engines without transforms need the whole map: each process solves these contacts alone. */
static inline struct contact_part
contact_share(struct rc_shape shape, const double *h, struct rc_problem *problem, struct solved *s)
{
    size_t first, n;
    struct rc_err err;

    if ((problem->engine == NULL || strcmp(problem->engine, "auto") == 0 ||
         strncmp(problem->engine, "fft", 3) == 0) &&
        rc_shape_check(&shape, &err) == RC_OK)
        problem->ranks = contact_ranks;
    rc_ranks_rows(problem->ranks, &shape, &first, &n);
    first *= shape.nx;
    return (struct contact_part){h + first, s->p + first, s->gap + first, s->u + first};
}

static inline size_t
contact_nodes_here(struct rc_shape shape, const struct rc_problem *problem)
{
    size_t first, n;

    rc_ranks_rows(problem->ranks, &shape, &first, &n);
    return n * shape.nx;
}

static inline void
contact_gather(struct rc_shape shape, const struct rc_problem *problem, struct solved *s)
{
    double *map[] = {s->p, s->gap, s->u};
    int count, own[2], *all, *at;
    size_t first, n;

    if (problem->ranks == NULL)
        return;
    MPI_Comm_size(MPI_COMM_WORLD, &count);
    all = malloc(4 * (size_t)count * sizeof *all);
    at = all + 2 * count;
    rc_ranks_rows(problem->ranks, &shape, &first, &n);
    own[0] = (int)(n * shape.nx);
    own[1] = (int)(first * shape.nx);
    MPI_Allgather(own, 1, MPI_INT, all, 1, MPI_INT, MPI_COMM_WORLD);
    MPI_Allgather(own + 1, 1, MPI_INT, at, 1, MPI_INT, MPI_COMM_WORLD);
    for (int m = 0; m < 3; m++)
        MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, map[m], all, at, MPI_DOUBLE,
                       MPI_COMM_WORLD);
    free(all);
}

#endif
