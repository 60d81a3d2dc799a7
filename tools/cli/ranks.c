/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ranks.h"

#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include "formats/core/core.h"

#ifdef RC_MPI
#include "libcontact/contact_mpi.h"

/* A process's part of a file. */
struct part {
    uint64_t bytes;
    uint32_t crc, unused;
};

struct ranks {
    struct rc_ranks *library;
    MPI_Comm comm; /* communicator for the calls of the tool */
    MPI_Comm last; /* only for the last messages: other processes may then be in any call */
    int count, own;
    int beside;                /* processes on this machine   */
    struct part *parts;        /* work space: one per process */
    struct itimerval patience; /* time of the launcher; 0: unknown */
};

/* ---- start and end ---- */

/* Every launcher sets one of these variables for the processes that it starts. */
static bool
launched(void)
{
    static const char *const marks[] = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK",
                                        "PMI_SIZE"};

    for (size_t k = 0; k < sizeof marks / sizeof *marks; k++)
        if (getenv(marks[k]) != NULL)
            return true;
    return false;
}

/* The time before the launcher kills the processes. Open MPI's mpirun does this a second after SIGTERM, or
 * after the time in its option, which it passes to the processes. Other launchers, such as srun, wait half a
 * minute or more. */
static struct itimerval
patience(void)
{
    const char *told = getenv("OMPI_MCA_odls_base_sigkill_timeout");
    double seconds = getenv("OMPI_COMM_WORLD_SIZE") == NULL ? 0 : told == NULL ? 1 : atof(told);
    double least = 0.7 * fmin(fmax(seconds, 0), 1e6);

    return (struct itimerval){
        .it_value = {(time_t)least, (suseconds_t)(1e6 * (least - floor(least)))}};
}

void
ranks_hurry(const struct tool *t)
{
    if (t->ranks != NULL)
        setitimer(ITIMER_REAL, &t->ranks->patience, NULL);
}

static void
finalize(void)
{
    int done;

    MPI_Finalized(&done);
    if (!done)
        MPI_Finalize();
}

void
ranks_start(struct tool *t)
{
    static struct ranks r;
    MPI_Comm machine;
    int given;

    if (!launched())
        return;
    if (MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &given) != MPI_SUCCESS)
        tool_die(t, "MPI cannot be started");
    MPI_Comm_dup(MPI_COMM_WORLD, &r.comm);
    MPI_Comm_dup(MPI_COMM_WORLD, &r.last);
    MPI_Comm_size(r.comm, &r.count);
    MPI_Comm_rank(r.comm, &r.own);
    if (r.count == 1) { /* a single process works as without MPI, also with pipes */
        MPI_Comm_free(&r.comm);
        MPI_Comm_free(&r.last);
        MPI_Finalize();
        return;
    }
    MPI_Comm_split_type(r.comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    MPI_Comm_size(machine, &r.beside);
    MPI_Comm_free(&machine);
    r.patience = patience();
    t->ranks = &r;
    atexit(finalize); /* also after --help */
    if (r.own > 0 && freopen("/dev/null", "w", stdout) == NULL)
        tool_die(t, "/dev/null: %s", strerror(errno));
    if ((r.parts = malloc((size_t)r.count * sizeof *r.parts)) == NULL)
        tool_die(t, "out of memory for %d processes", r.count);
    r.library = tool_made(t, NULL, rc_ranks_new(r.comm, &t->err));
}

void
ranks_end(struct tool *t)
{
    if (t->ranks == NULL)
        return;
    setitimer(ITIMER_REAL, &(struct itimerval){.it_value = {0}}, NULL);
    rc_ranks_free(t->ranks->library);
    free(t->ranks->parts);
    MPI_Comm_free(&t->ranks->comm);
    MPI_Comm_free(&t->ranks->last);
    finalize();
    t->ranks = NULL;
}

_Noreturn void
ranks_die(struct tool *t, int status, const char *text,
          void (*say)(struct tool *tool, int status, const char *text))
{
    const struct timespec while_ = {0, 1000000};
    MPI_Request all_here;
    int worst = status, done = 0;
    double began = tool_now();

    MPI_Iallreduce(&status, &worst, 1, MPI_INT, MPI_MAX, t->ranks->last, &all_here);
    while (!done && tool_now() - began < 2) {
        MPI_Test(&all_here, &done, MPI_STATUS_IGNORE);
        if (!done)
            nanosleep(&while_, NULL);
    }
    if (!done || t->ranks->own == 0)
        say(t, done ? worst : status, text);
    if (!done)
        MPI_Abort(MPI_COMM_WORLD, status);
    signal(SIGTERM, SIG_IGN); /* the launcher ends the others when the first one ends */
    signal(SIGALRM, SIG_IGN);
    MPI_Barrier(t->ranks->last);
    exit(worst);
}

/* ---- shares of the processes ---- */

const struct rc_ranks *
ranks_of(const struct tool *t)
{
    return t->ranks == NULL ? NULL : t->ranks->library;
}

size_t
ranks_count(const struct tool *t)
{
    return t->ranks == NULL ? 1 : (size_t)t->ranks->count;
}

size_t
ranks_beside(const struct tool *t)
{
    return t->ranks == NULL ? 1 : (size_t)t->ranks->beside;
}

void
ranks_refuse(struct tool *t)
{
    if (ranks_count(t) > 1 && !t->info->shares)
        tool_usage(
            t, "%s cannot share its maps among processes: start one process, with --threads%s%s",
            t->info->name, t->info->alone == NULL ? "" : "; ",
            t->info->alone == NULL ? "" : t->info->alone);
}

bool
ranks_speak(const struct tool *t)
{
    return t->ranks == NULL || t->ranks->own == 0;
}

void
ranks_rows(const struct tool *t, const struct rc_shape *shape, size_t *first, size_t *n)
{
    *first = 0;
    *n = shape->ny;
    if (t->ranks != NULL)
        rc_ranks_rows(t->ranks->library, shape, first, n);
}

/* ---- values known to all processes ---- */

double
ranks_sum(const struct tool *t, double v)
{
    if (t->ranks != NULL)
        MPI_Allreduce(MPI_IN_PLACE, &v, 1, MPI_DOUBLE, MPI_SUM, t->ranks->comm);
    return v;
}

/* Adds v to sum[0], and the rounding error to sum[1]. */
static void
add_exactly(double sum[2], double v)
{
    const double to = sum[0] + v;

    sum[1] += fabs(sum[0]) >= fabs(v) ? (sum[0] - to) + v : (v - to) + sum[0];
    sum[0] = to;
}

double
ranks_total(const struct tool *t, const double *v, size_t n)
{
    double own[2] = {0, 0}, all[2] = {0, 0};

    if (t->ranks == NULL)
        return rc_sum(v, n);
    for (size_t k = 0; k < n; k++)
        add_exactly(own, v[k]);
    for (size_t r = 0; r < ranks_count(t); r++) {
        double part[2] = {own[0], own[1]};
        ranks_share(t, r, part, sizeof part);
        add_exactly(all, part[0]);
        all[1] += part[1];
    }
    return isfinite(all[0]) ? all[0] + all[1] : all[0];
}

double
ranks_most(const struct tool *t, double v)
{
    if (t->ranks != NULL)
        MPI_Allreduce(MPI_IN_PLACE, &v, 1, MPI_DOUBLE, MPI_MAX, t->ranks->comm);
    return v;
}

size_t
ranks_where_most(const struct tool *t, double v)
{
    struct {
        double v;
        int rank;
    } own = {v, 0};

    if (t->ranks == NULL)
        return 0;
    own.rank = t->ranks->own;
    MPI_Allreduce(MPI_IN_PLACE, &own, 1, MPI_DOUBLE_INT, MPI_MAXLOC, t->ranks->comm);
    return (size_t)own.rank;
}

enum rc_status
ranks_agree(const struct tool *t, enum rc_status status, struct rc_err *err)
{
    int first;

    if (t->ranks == NULL)
        return status;
    first = status == RC_OK ? t->ranks->count : t->ranks->own;
    MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, t->ranks->comm);
    if (first == t->ranks->count)
        return RC_OK;
    MPI_Bcast(err, sizeof *err, MPI_BYTE, first, t->ranks->comm);
    return RC_FAIL;
}

void
ranks_share(const struct tool *t, size_t root, void *v, size_t bytes)
{
    if (t->ranks != NULL)
        MPI_Bcast(v, (int)bytes, MPI_BYTE, (int)root, t->ranks->comm);
}

void
ranks_wait(const struct tool *t)
{
    if (t->ranks != NULL)
        MPI_Barrier(t->ranks->comm);
}

void
ranks_sent(const struct tool *t, struct rc_sent *sent)
{
    *sent = (struct rc_sent){0};
    if (t->ranks != NULL)
        rc_ranks_sent(t->ranks->library, sent);
}

uint32_t
ranks_crc(const struct tool *t, uint32_t crc, size_t bytes)
{
    const struct part own = {bytes, crc, 0}, *all;
    uint32_t sum = 0;

    if (t->ranks == NULL)
        return crc;
    all = t->ranks->parts;
    MPI_Allgather(&own, sizeof own, MPI_BYTE, t->ranks->parts, sizeof own, MPI_BYTE,
                  t->ranks->comm);
    for (int r = 0; r < t->ranks->count; r++)
        sum = rc_crc32_join(sum, all[r].crc, all[r].bytes);
    return sum;
}

/* ---- files ---- */

struct file {
    struct rc_share share;
    struct tool *tool;
    MPI_File file;
};

static void
share_rows(void *at, const struct rc_shape *shape, size_t *first, size_t *n)
{
    ranks_rows(((const struct file *)at)->tool, shape, first, n);
}

static enum rc_status
share_agree(void *at, enum rc_status status, struct rc_err *err)
{
    return ranks_agree(((const struct file *)at)->tool, status, err);
}

static uint32_t
share_crc(void *at, uint32_t crc, size_t bytes)
{
    return ranks_crc(((const struct file *)at)->tool, crc, bytes);
}

enum {
    PIECE = 1 << 26 /* largest number of bytes in one read or write: MPI counts in ints */
};

/* Success if all processes succeeded, otherwise failure on all. */
static enum rc_status
agree(const struct file *f, int result, size_t missing, const char *what, struct rc_err *err)
{
    char text[MPI_MAX_ERROR_STRING] = "";
    int length, worst = result != MPI_SUCCESS ? 2 : missing > 0 ? 1 : 0;
    const int own = worst;

    MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_INT, MPI_MAX, f->tool->ranks->comm);
    if (worst == 0)
        return RC_OK;
    if (own == 2)
        MPI_Error_string(result, text, &length);
    if (worst == 1)
        return rc_err_set(err, "%s stops short", what);
    return rc_err_set(err, "%s failed%s%s%s", what, own == 2 ? " (" : "", text,
                      own == 2 ? ")" : "");
}

static enum rc_status
share_read(void *at, uint64_t place, void *to, size_t bytes, struct rc_err *err)
{
    struct file *f = at;
    int result = MPI_SUCCESS, got = 0;
    size_t done = 0;

    while (done < bytes) {
        int n = bytes - done < PIECE ? (int)(bytes - done) : PIECE;
        MPI_Status status;
        result = MPI_File_read_at(f->file, (MPI_Offset)(place + done), (char *)to + done, n,
                                  MPI_BYTE, &status);
        if (result != MPI_SUCCESS || MPI_Get_count(&status, MPI_BYTE, &got) != MPI_SUCCESS ||
            got <= 0)
            break;
        done += (size_t)got;
    }
    return agree(f, result, bytes - done, "reading", err);
}

static enum rc_status
share_write(void *at, uint64_t place, const void *from, size_t bytes, struct rc_err *err)
{
    struct file *f = at;
    int result = MPI_SUCCESS, put = 0;
    size_t done = 0;

    while (done < bytes) {
        int n = bytes - done < PIECE ? (int)(bytes - done) : PIECE;
        MPI_Status status;
        result = MPI_File_write_at(f->file, (MPI_Offset)(place + done), (const char *)from + done,
                                   n, MPI_BYTE, &status);
        if (result != MPI_SUCCESS || MPI_Get_count(&status, MPI_BYTE, &put) != MPI_SUCCESS ||
            put <= 0)
            break;
        done += (size_t)put;
    }
    return agree(f, result, bytes - done, "writing", err);
}

static const struct rc_share *
open_file(struct tool *t, const char *name, int mode)
{
    struct file *f = calloc(1, sizeof *f);
    char text[MPI_MAX_ERROR_STRING];
    int result, length;

    if (f == NULL)
        tool_die(t, "out of memory");
    *f = (struct file){.share = {.ctx = f,
                                 .first = t->ranks->own == 0,
                                 .rows = share_rows,
                                 .crc = share_crc,
                                 .agree = share_agree,
                                 .read = share_read,
                                 .write = share_write},
                       .tool = t};
    result = MPI_File_open(t->ranks->comm, name, mode, MPI_INFO_NULL, &f->file);
    if (result != MPI_SUCCESS) {
        MPI_Error_string(result, text, &length);
        tool_die(t, "%s: %s", name, text);
    }
    return &f->share;
}

const struct rc_share *
ranks_read(struct tool *t, const char *name)
{
    return t->ranks == NULL ? NULL : open_file(t, name, MPI_MODE_RDONLY);
}

const struct rc_share *
ranks_write(struct tool *t, const char *name)
{
    return t->ranks == NULL ? NULL : open_file(t, name, MPI_MODE_WRONLY);
}

enum rc_status
ranks_settle(const struct rc_share *share, struct rc_err *err)
{
    struct file *f;

    if (share == NULL)
        return RC_OK;
    f = share->ctx;
    return agree(f, MPI_File_sync(f->file), 0, "writing", err);
}

void
ranks_close(struct tool *t, const struct rc_share *share)
{
    struct file *f;

    if (share == NULL)
        return;
    f = share->ctx;
    if (MPI_File_close(&f->file) != MPI_SUCCESS)
        tool_die(t, "a file cannot be closed");
    free(f);
}

#else

void
ranks_start(struct tool *t)
{
    t->ranks = NULL;
}

void
ranks_refuse(struct tool *t)
{
    const char *count = getenv("OMPI_COMM_WORLD_SIZE"), *own = getenv("OMPI_COMM_WORLD_RANK");

    if (count == NULL)
        count = getenv("PMI_SIZE"), own = getenv("PMI_RANK");
    if (count == NULL || atoi(count) <= 1)
        return;
    if (own != NULL && atoi(own) != 0) /* the first process prints the message */
        exit(EXIT_USAGE);
    tool_usage(
        t,
        "%s is built without MPI, and a launcher has started it %s times: start one process, "
        "or see contact-mpi(7)",
        t->info->name, count);
}

#endif
