/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each allocation in libcontact on one of the processes that share a map fails, alone or with all later ones.
 * All processes must return the same: the right result, or one failure with its reason. None may wait for
 * another, and no memory may be held. RC_STRIDE in the environment is the step from one failing allocation to
 * the next. By default it is large enough for the default set of tests. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "failing_malloc.h"
#include "libcontact/contact_mpi.h"
#include "tests/exact.h"
#include "uses.h"

enum {
    NX = 96, /* columns: one of two processes has 32 rows and the other 64 */
    NY = 96,
    N = NX * NY,
    FIELDS = 4,
    PATIENCE = 60, /* seconds for one use */
    TRIES = 4      /* failures in a use, on each process and in both modes, without RC_STRIDE */
};

static const struct rc_shape shape = {NX, NY, 1.1e-6, 1e-6};
static const struct rc_layer layer = {4e-6, 2e9, 0.3};
static const struct rc_pair layered = {.one = {1e9, 0.3, 1, &layer}};
/* A map for two processes, whose coarser grid is shared too. */
static const struct rc_shape large = {384, 352, 1.1e-6, 1e-6};
static double rough[N], pressure[N], hardness[N], large_rough[384 * 352];
static struct rc_ranks *ranks;
static int own, processes;
static size_t first, here; /* nodes */

/* The results of a use: fields at the nodes of this process, zeros before. */
static double given[FIELDS][N];

/* ---- uses ---- */

static enum rc_status
several(double *out, struct rc_err *err)
{
    struct rc_ranks *more = rc_ranks_new(MPI_COMM_WORLD, err);
    struct rc_sent sent;
    size_t row, n;

    if (more == NULL)
        return RC_FAIL;
    rc_ranks_rows(more, &shape, &row, &n);
    rc_ranks_sent(more, &sent);
    out[0] = (double)(row + n);
    rc_ranks_free(more);
    return RC_OK;
}

static enum rc_status
convolved(const struct rc_pair *pair, const struct rc_conv_options *of, double *out,
          struct rc_err *err)
{
    struct rc_conv_options o = *of;
    struct rc_conv *conv;

    o.ranks = ranks;
    if ((conv = rc_conv_new(&shape, pair, &o, err)) == NULL)
        return RC_FAIL;
    rc_conv_apply(conv, pressure + first, out);
    rc_conv_free(conv);
    return RC_OK;
}

CONVOLUTION(free_conv, bare, .engine = "fft64")
CONVOLUTION(single_conv, bare, .tol = 1e-3)
CONVOLUTION(periodic_conv, bare, .boundary = {.x = true, .y = true})
CONVOLUTION(line_conv, bare, .boundary = {.y = true})
CONVOLUTION(column_conv, layered, .boundary = {.x = true})
CONVOLUTION(coated_conv, layered, .tol = 0)
CONVOLUTION(coated_periodic_conv, layered, .boundary = {.x = true, .y = true})

static enum rc_status
solved(const struct rc_problem *of, double *out, struct rc_err *err)
{
    double *const field[FIELDS] = {out, out + N, out + 2 * N, out + 3 * N};
    struct rc_problem problem = *of;
    double stiffness;

    problem.ranks = ranks;
    if (problem.hardness_map != NULL)
        problem.hardness_map += first;
    return solve_twice(&shape, rough + first, &problem, here, field, &stiffness, err);
}

CONTACT(free_contact, bare, .load = 0.02)
CONTACT(hard_contact, bare, .load = 0.02, .hardness = 5e7, .boundary = RC_PERIODIC)
CONTACT(two_phases, bare, .load = 0.02, .hardness_map = hardness)
CONTACT(paper_method, bare, .load = 0.02, .method = "pk99")
CONTACT(to_an_approach, bare, .approach = 3e-7, .discretization = true)
CONTACT(coated_contact, layered, .load = 0.02)
CONTACT(coated_line_contact, layered, .load = 0.02, .boundary = {.y = true})
CONTACT(free_to_tilt, bare, .load = 0.02, .tilt_free = true)

/* Up to the first step on the full grid, because this step depends on the starting value. */
static enum rc_status
large_start(double *out, struct rc_err *err)
{
    const struct rc_problem problem = {
        .pair.estar = 1e9, .load = 0.2, .threads = 1, .tol = 1e-2, .ranks = ranks};
    struct rc_progress at = {.coarser = true};
    struct rc_solver *solver;
    size_t row, n;

    (void)out;
    rc_ranks_rows(ranks, &large, &row, &n);
    solver = rc_solver_new(&large, large_rough + row * large.nx, &problem, err);
    if (solver == NULL)
        return RC_FAIL;
    while ((at.coarser || at.iterations == 0) && rc_solver_step(solver) == RC_MORE)
        rc_solver_progress(solver, &at);
    rc_solver_free(solver);
    return RC_OK;
}

static enum rc_status
stressed(const struct rc_stress_options *of, double *out, struct rc_err *err)
{
    double *const field[FIELDS] = {out, out + N, out + 2 * N, out + 3 * N};
    struct rc_stress_options o = *of;

    o.ranks = ranks;
    for (size_t k = 0; k < 2; k++)
        if (o.traction[k] != NULL)
            o.traction[k] += first;
    return two_slices(&shape, pressure + first, &o, field, err);
}

STRESS(free_stress, bare, .mu = 0.1)
STRESS(periodic_stress, bare, .mu = 0.1, .boundary = RC_PERIODIC)
STRESS(single_stress, bare, .tol = 1e-3)
STRESS(coated_stress, layered, .mu = 0)
STRESS(traction_stress, bare, .traction = {pressure, pressure})

static enum rc_status
depths(double *out, struct rc_err *err)
{
    double *z = NULL;
    size_t n = 0;
    enum rc_status status =
        rc_stress_depths(ranks, &shape, pressure + first, RC_FREE, &layered.one, &z, &n, err);

    if (status == RC_OK)
        memcpy(out, z, n * sizeof *z);
    else
        assert_null(z);
    free(z);
    return status;
}

static enum rc_status
patches(double *out, struct rc_err *err)
{
    const struct rc_patch_options o = {
        .boundary = RC_PERIODIC, .largest = SIZE_MAX, .threads = 1, .ranks = ranks};
    struct rc_patches found;
    enum rc_status status = rc_patches_find(&shape, pressure + first, &o, &found, err);

    for (size_t k = 0; k < found.count && status == RC_OK; k++)
        out[k] = found.patch[k].perimeter;
    out[N] = found.perimeter;
    rc_patches_free(&found);
    return status;
}

static enum rc_status
measured(double *out, struct rc_err *err)
{
    struct rc_seam seam;

    (void)err;
    out[0] = rc_measure_contact_slope(ranks, &shape, rough + first, pressure + first);
    rc_measure_seam(ranks, &shape, rough + first, &seam);
    out[1] = seam.across[0] + seam.across[1];
    return RC_OK;
}

static const struct {
    const char *name;
    use *use;
    double tol;   /* error of a result, relative to the largest number of its field */
    size_t tries; /* 0: TRIES                                                       */
    bool without; /* it allocates nothing                                           */
} uses[] = {
    {.name = "processes that share a map", .use = several},
    {.name = "convolution", .use = free_conv},
    {.name = "convolution, single precision", .use = single_conv},
    {.name = "convolution, periodic", .use = periodic_conv},
    {.name = "convolution, coated", .use = coated_conv},
    {.name = "convolution, coated and periodic", .use = coated_periodic_conv},
    {.name = "convolution, periodic along y", .use = line_conv},
    {.name = "convolution, coated and periodic along x", .use = column_conv},
    /* without memory the solver starts without coarser grids */
    {.name = "contact", .use = free_contact, .tol = 1e-3},
    {.name = "contact, periodic with a hardness", .use = hard_contact, .tol = 1e-3},
    {.name = "contact, a map of hardness", .use = two_phases, .tol = 1e-3},
    {.name = "contact, pk99", .use = paper_method, .tol = 1e-3},
    {.name = "contact, to an approach", .use = to_an_approach, .tol = 1e-3},
    {.name = "contact, coated", .use = coated_contact, .tol = 1e-3},
    {.name = "contact, coated and periodic along y", .use = coated_line_contact, .tol = 1e-3},
    {.name = "contact, free to tilt", .use = free_to_tilt, .tol = 1e-3},
    {.name = "contact, coarser grids that are shared", .use = large_start, .tries = 2},
    {.name = "stress", .use = free_stress},
    {.name = "stress, periodic", .use = periodic_stress},
    {.name = "stress, single precision", .use = single_stress},
    {.name = "stress, coated", .use = coated_stress},
    {.name = "stress, of tractions", .use = traction_stress},
    {.name = "depths", .use = depths},
    {.name = "patches", .use = patches},
    {.name = "slopes and seams", .use = measured, .without = true},
};

/* ---- one failure ---- */

/* A process that waits for ever is reported and ends all processes. */
static char waiting[256];

static void
end_waiting(int number)
{
    (void)number;
    (void)!write(STDERR_FILENO, waiting, strlen(waiting));
    _exit(1);
}

/* GSL does not free its first blocks if a later allocation fails (law_memory.c). */
static const size_t lost_by_gsl = 3;
static double right[FIELDS][N];
static size_t tried, refused;

static bool
same_numbers(double tol)
{
    for (int f = 0; f < FIELDS; f++) {
        double most = 0;
        for (size_t k = 0; k < N; k++)
            most = fmax(most, fabs(right[f][k]));
        for (size_t k = 0; k < N; k++)
            if (!(fabs(given[f][k] - right[f][k]) <= fmax(tol, of_sum) * most))
                return false;
    }
    return true;
}

/* The fault of a result on this process; NULL: none. */
static const char *
wrong(size_t k, enum rc_status status, const struct rc_err *err)
{
    struct {
        int status;
        struct rc_err err;
    } mine, of_first;

    memset(&mine, 0, sizeof mine);
    mine.status = (int)status;
    if (status != RC_OK)
        snprintf(mine.err.text, sizeof mine.err.text, "%s", err->text);
    of_first = mine;
    MPI_Bcast(&of_first, sizeof of_first, MPI_BYTE, 0, MPI_COMM_WORLD);
    if (status != RC_OK && err->text[0] == '\0')
        return "no reason";
    if (mine.status != of_first.status || strcmp(mine.err.text, of_first.err.text) != 0)
        return "not what the first process says";
    if (status == RC_OK && !same_numbers(uses[k].tol))
        return "another answer";
    return fault_held() > (fault_in_library() ? lost_by_gsl : 0) ? "blocks are held" : NULL;
}

/* Makes allocation n of process `victim` fail, and with `stay` all later ones. */
static void
try_one(size_t k, int victim, size_t n, bool stay)
{
    struct rc_err err = {""};
    enum rc_status status;
    const char *found;
    int any;

    snprintf(waiting, sizeof waiting, "%s, allocation %zu%s of process %d: process %d waits\n",
             uses[k].name, n, stay ? " and on" : "", victim, own);
    memset(given, 0, sizeof given);
    alarm(PATIENCE);
    fault_arm(own == victim ? n : 0, stay);
    status = uses[k].use(&given[0][0], &err);
    fault_disarm();
    found = wrong(k, status, &err);
    any = found != NULL;
    MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    alarm(0);
    tried++;
    refused += status != RC_OK;
    if (any)
        fail_msg("%s, allocation %zu%s of process %d: here, process %d: %s (%s)", uses[k].name, n,
                 stay ? " and on" : "", victim, own, found == NULL ? "fine" : found, err.text);
}

static size_t
stride_of(size_t k, size_t last)
{
    const char *text = getenv("RC_STRIDE");
    size_t tries = uses[k].tries > 0 ? uses[k].tries : TRIES;

    return text != NULL && atoi(text) > 0 ? (size_t)atoi(text) : last / tries + 1;
}

static void
every_allocation_fails(void **state)
{
    size_t all = 0;

    (void)state;
    for (size_t k = 0; k < sizeof uses / sizeof *uses; k++) {
        struct rc_err err = {""};
        size_t last[8], mine;

        uses[k].use(&given[0][0], &err); /* from here on FFTW and GSL hold no further memory */
        memset(given, 0, sizeof given);
        fault_arm(0, false);
        if (uses[k].use(&given[0][0], &err) != RC_OK)
            fail_msg("%s: %s", uses[k].name, err.text);
        mine = fault_disarm();
        memcpy(right, given, sizeof right);
        assert_int_equal(fault_held(), 0);
        MPI_Allgather(&mine, sizeof mine, MPI_BYTE, last, sizeof mine, MPI_BYTE, MPI_COMM_WORLD);
        if ((mine == 0) != uses[k].without)
            fail_msg("%s: %zu allocations", uses[k].name, mine);
        for (int victim = 0; victim < processes; victim++) {
            size_t stride = stride_of(k, last[victim]);
            for (size_t n = 1 + k % stride; n <= last[victim]; n += stride) {
                try_one(k, victim, n, false);
                try_one(k, victim, n, true);
            }
            all += last[victim];
        }
    }
    printf("%zu uses, %zu allocations; %zu made to fail, %zu refusals\n",
           sizeof uses / sizeof *uses, all, tried, refused);
    assert_true(refused > 0);
}

int
main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_allocation_fails)};
    struct rc_selfaffine what = {.hurst = 0.8, .rms_slope = 0.1, .seed = 7};
    struct rc_err err;
    int failed = 1;

    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &own);
    MPI_Comm_size(MPI_COMM_WORLD, &processes);
    signal(SIGALRM, end_waiting);
    if (processes <= 8 && (ranks = rc_ranks_new(MPI_COMM_WORLD, &err)) != NULL &&
        rc_synth_selfaffine(&shape, &what, rough, NULL) == RC_OK &&
        rc_synth_selfaffine(&large, &what, large_rough, NULL) == RC_OK) {
        for (size_t k = 0; k < N; k++)
            pressure[k] = fmax(0, rough[k]) * 1e14, hardness[k] = k % 10 < 5 ? 5e7 : NAN;
        rc_ranks_rows(ranks, &shape, &first, &here);
        first *= NX;
        here *= NX;
        failed = cmocka_run_group_tests(tests, NULL, NULL);
    }
    rc_ranks_free(ranks);
    MPI_Finalize();
    return failed;
}
