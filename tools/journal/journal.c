/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* F_OFD_SETLK */
#include "journal.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char end_line[] = "RCGEND 1\n";

/* NULL and errno where the file cannot be opened in this mode. With several processes the first one opens or
 * creates the file, and the others then open this file. All get NULL, or none. */
static FILE *
open_file(const struct journal *j, const char *mode)
{
    FILE *file = NULL;
    int problem = 0;

    if (ranks_speak(j->t) && (file = fopen(j->name, mode)) == NULL)
        problem = errno;
    ranks_share(j->t, 0, &problem, sizeof problem);
    if (problem == 0 && file == NULL && (file = fopen(j->name, "r+b")) == NULL)
        problem = errno;
    problem = (int)ranks_most(j->t, problem);
    if (problem != 0 && file != NULL)
        (void)fclose(file);
    errno = problem;
    return problem == 0 ? file : NULL;
}

/* Locks the file, because two runs that add to one file would damage it. The lock ends with the process, also
 * when it is killed; on a file system without locks there is none. Where the system has them, locks of the
 * open file are used. A lock of the process would end when the process closes the file anywhere, as MPI-IO
 * does after each frame. The lock is on a byte beyond all data, because MPI-IO locks what it writes. */
static void
lock(const struct journal *j)
{
#ifdef F_OFD_SETLK
    const int set = F_OFD_SETLK;
#else
    const int set = F_SETLK;
#endif
    struct flock behind = {
        .l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = (off_t)1 << 62, .l_len = 1};
    bool taken = false;

    if (ranks_speak(j->t)) /* only the first of several processes prints messages */
        taken = fcntl(fileno(j->file), set, &behind) != 0 && (errno == EACCES || errno == EAGAIN);
    ranks_share(j->t, 0, &taken, sizeof taken);
    if (taken)
        tool_die(j->t, "--checkpoint %s: another run is writing to it: wait for its end, or end it",
                 j->name);
}

static bool
is_empty(const char *name)
{
    struct stat s;

    return stat(name, &s) == 0 && S_ISREG(s.st_mode) && s.st_size == 0;
}

void
journal_open(struct journal *j, struct tool *t, const char *name, bool resume, bool *found)
{
    *j = (struct journal){.t = t, .name = name};
    *found = false;
    if (strcmp(name, "-") == 0)
        tool_usage(t, "--checkpoint -: a checkpoint must be a file, not a pipe: give a file name");
    if (resume && (j->file = open_file(j, "r+b")) != NULL) {
        *found = true;
        lock(j);
        return;
    }
    if (resume && errno != ENOENT)
        tool_die(t, "--checkpoint %s: %s", name, strerror(errno));
    if ((j->file = open_file(j, "w+bx")) == NULL && errno == EEXIST && is_empty(name))
        j->file = open_file(j, "r+b"); /* of a run that was refused before its first state */
    if (j->file == NULL)
        tool_die(t, "--checkpoint %s: %s", name,
                 errno == EEXIST ? "the file exists: continue from it with --resume, or remove it"
                                 : strerror(errno));
    lock(j);
}

void
journal_close(struct journal *j)
{
    if (j->file != NULL)
        (void)fclose(j->file);
    j->file = NULL;
}

off_t
journal_frame_end(const struct journal *j)
{
    return ftello(j->file) + (off_t)strlen(end_line);
}

bool
journal_is_cut_off(const struct journal *j, off_t at)
{
    size_t same = 0;
    int byte;

    if (fseeko(j->file, at, SEEK_SET) != 0)
        return false;
    while ((byte = getc(j->file)) != EOF) {
        same = byte == end_line[same] ? same + 1 : byte == end_line[0] ? 1 : 0;
        if (end_line[same] == '\0')
            return false;
    }
    return true;
}

void
journal_cut(struct journal *j, size_t frames, off_t end)
{
    if (frames > 0)
        end -= (off_t)strlen(end_line);
    if (ftruncate(fileno(j->file), end) != 0 || fseeko(j->file, end, SEEK_SET) != 0 ||
        (frames > 0 && fputs(end_line, j->file) == EOF) || fflush(j->file) != 0)
        tool_die(j->t, "--checkpoint %s: %s", j->name, strerror(errno));
}

struct rc_grid *
journal_read(const struct journal *j, off_t at, size_t number)
{
    const struct rc_share *share;
    struct rc_reader *reader;
    struct rc_grid *g = NULL;

    if (fseeko(j->file, at, SEEK_SET) != 0)
        tool_die(j->t, "--checkpoint %s: %s", j->name, strerror(errno));
    reader = rc_reader_new(j->file, 0, 0, &j->t->err);
    share = ranks_read(j->t, j->name);
    if (reader != NULL)
        rc_reader_share(reader, share);
    if (reader == NULL || rc_reader_next(reader, &g, &j->t->err) != RC_MORE)
        tool_die(j->t,
                 "--checkpoint %s: frame %zu cannot be read (%s): remove the file to start again",
                 j->name, number, j->t->err.text);
    rc_reader_free(reader);
    ranks_close(j->t, share);
    return g;
}

/* Writes a stream of one frame at the end of the file; all processes take part: if one fails, none has
 * written. */
static enum rc_status
put(struct journal *j, const struct rc_grid *g, off_t at, struct rc_err *err)
{
    const struct rc_share *share = ranks_write(j->t, j->name);
    struct rc_writer *writer = share == NULL ? rc_writer_new(j->file, err)
                                             : rc_writer_new_shared(share, (uint64_t)at, err);
    enum rc_status status = ranks_agree(j->t, writer == NULL ? RC_FAIL : RC_OK, err);

    if (status == RC_OK)
        status = rc_writer_put(writer, g, err);
    if (status == RC_OK)
        status = rc_writer_end(writer, err);
    rc_writer_free(writer);
    if (status == RC_OK)
        status = ranks_settle(share, err);
    ranks_close(j->t, share);
    if (status == RC_OK && share == NULL && !file_settle(j->file))
        return rc_err_set(err, "%s", strerror(errno));
    return status;
}

/* The position of the next frame; false: unknown. */
static bool
find_end(const struct journal *j, off_t *at)
{
    bool fine = fseeko(j->file, 0, SEEK_END) == 0 && (*at = ftello(j->file)) >= 0;

    ranks_share(j->t, 0, at, sizeof *at);
    return ranks_most(j->t, fine ? 0 : 1) == 0;
}

bool
journal_add(struct journal *j, const struct rc_grid *g, off_t *at)
{
    struct rc_err err;

    *at = 0;
    if (find_end(j, at) && put(j, g, *at, &err) == RC_OK)
        return true;
    tool_warn(j->t, "--checkpoint %s: writing failed: earlier states stay, but no more are added",
              j->name);
    journal_close(j);
    return false;
}
