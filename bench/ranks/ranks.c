/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The cost of a convolution for processes that share a map: mpirun -n P bench-ranks M [free]. Prints the
 * shortest time of five, its part in exchanges, and the largest peak memory of a process.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "libcontact/contact_mpi.h"
#include "libcontact/memory.h"

static double
exchange_seconds(const struct rc_ranks *ranks)
{
    struct rc_sent sent;

    rc_ranks_sent(ranks, &sent);
    return sent.seconds;
}

/* The shortest time of a sum, and of its exchanges, in seconds. */
static void
measure(const struct rc_ranks *ranks, struct rc_conv *conv, const double *p, double *u,
        double out[2])
{
    out[0] = INFINITY;
    for (int k = 0; k < 5; k++) {
        double before = exchange_seconds(ranks), began, took;
        MPI_Barrier(MPI_COMM_WORLD);
        began = MPI_Wtime();
        rc_conv_apply(conv, p, u);
        took = MPI_Wtime() - began;
        MPI_Allreduce(MPI_IN_PLACE, &took, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
        if (took < out[0]) {
            out[0] = took;
            out[1] = exchange_seconds(ranks) - before;
        }
    }
}

int
main(int argc, char **argv)
{
    struct rc_conv_options o = {.engine = "fft"};
    struct rc_shape shape = {.dx = 1e-6, .dy = 1e-6};
    size_t m = argc > 1 ? strtoul(argv[1], NULL, 10) : 0, first, n;
    struct rc_ranks *ranks;
    struct rusage usage;
    double *p, *u, time[2] = {0}, memory;
    struct rc_err err;
    int own, count;

    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &own);
    MPI_Comm_size(MPI_COMM_WORLD, &count);
    if (m == 0 || argc > 3 || (argc > 2 && strcmp(argv[2], "free") != 0)) {
        fprintf(stderr, "usage: mpirun -n P bench-ranks M [free]\n");
        MPI_Abort(MPI_COMM_WORLD, 2);
    }
    ranks = rc_ranks_new(MPI_COMM_WORLD, &err);
    if (ranks == NULL) {
        fprintf(stderr, "bench-ranks: %s\n", err.text);
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    o.boundary = argc > 2 ? RC_FREE : RC_PERIODIC;
    o.ranks = ranks;
    shape.nx = shape.ny = m;
    rc_ranks_rows(ranks, &shape, &first, &n);
    p = rc_alloc(n * m, sizeof *p);
    u = rc_alloc(n * m, sizeof *u);
    if (p == NULL || u == NULL) {
        fprintf(stderr, "bench-ranks: out of memory for %zu x %zu nodes\n", m, n);
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    for (size_t k = 0; k < n * m; k++)
        p[k] = u[k] = 1 + (double)(k % 7);
    for (int single = 0; single < 2; single++) {
        struct rc_conv *conv;
        o.tol = single ? 1e-5 : 0;
        conv = rc_conv_new(&shape, &(struct rc_pair){.estar = 1e11}, &o, &err);
        if (conv == NULL) {
            fprintf(stderr, "bench-ranks: %s\n", err.text);
            MPI_Abort(MPI_COMM_WORLD, 1);
        }
        measure(ranks, conv, p, u, time);
        if (own == 0)
            printf("%zu\t%s\t%d\t%s\t%.4f\t%.4f\n", m, argc > 2 ? argv[2] : "periodic", count,
                   single ? "single" : "double", time[0], time[1]);
        rc_conv_free(conv);
    }
    getrusage(RUSAGE_SELF, &usage);
    memory = (double)usage.ru_maxrss * 1024;
    MPI_Allreduce(MPI_IN_PLACE, &memory, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    if (own == 0)
        printf("# %.0f MiB\n", memory / 1048576);
    free(p);
    free(u);
    rc_ranks_free(ranks);
    MPI_Finalize();
    return 0;
}
