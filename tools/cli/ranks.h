/*
 * A tool under mpirun: its processes share every map, each with rows of its own. A build without
 * MPI, and a tool that was not started by a launcher of MPI, has struct tool's `ranks` NULL and is
 * alone: the functions then say what holds of one process.
 *
 * All processes do the same and find the same; the first one alone speaks to people and writes reports.
 */
#ifndef RC_TOOL_RANKS_H
#define RC_TOOL_RANKS_H

#include "libcontact/contact.h"
#include "tool.h"

/* Where a launcher of MPI has started several: they find each other. At the start of a tool that can. */
void ranks_start(struct tool *tool);
/* The processes part; nothing of them may be used any more. */
void ranks_end(struct tool *tool);

/* For the options of the library. */
const struct rc_ranks *ranks_of(const struct tool *tool);
size_t ranks_count(const struct tool *tool);
/* Whether this process speaks to people and writes what is no map. */
bool ranks_speak(const struct tool *tool);
/* Rows of a map that are held here. */
void ranks_rows(const struct tool *tool, const struct rc_shape *shape, size_t *first, size_t *n);
/* Sums and largest values over all processes, and the CRC-32 of all parts one after another. */
double ranks_sum(const struct tool *tool, double v);
double ranks_most(const struct tool *tool, double v);
uint32_t ranks_crc(const struct tool *tool, uint32_t crc, size_t bytes);
/* RC_OK when all have that; else RC_FAIL for all, with the sentence of the first that cannot go on. */
enum rc_status ranks_agree(const struct tool *tool, enum rc_status status, struct rc_err *err);
/* Everybody gets what process `root` has. */
void ranks_share(const struct tool *tool, size_t root, void *v, size_t bytes);
/* Nobody goes on before all are here. */
void ranks_wait(const struct tool *tool);
/* The process whose v is the largest, the first of equals. */
size_t ranks_where_most(const struct tool *tool, double v);
/* What all have sent: see rc_ranks_sent. */
void ranks_sent(const struct tool *tool, struct rc_sent *sent);

/* A file of which each reads and writes its part: for rcg.h. */
const struct rc_share *ranks_read(struct tool *tool, const char *name);
const struct rc_share *ranks_write(struct tool *tool, const char *name);
/* The disk has what all have written; NULL: nothing to wait for. All get the same status. */
enum rc_status ranks_settle(const struct rc_share *share, struct rc_err *err);
void ranks_close(struct tool *tool, const struct rc_share *share);

/* After a signal: SIGALRM comes before a launcher that gives those whom it ends so and so long kills
 * them. Safe in a signal handler. */
void ranks_hurry(const struct tool *tool);

/* This process cannot go on, and most likely none can. Waits a moment for the others to come here
 * too: then the first one says why, and all end with the largest status; else this one does, and the
 * others are killed. `say` tells people and removes what is half-written. */
_Noreturn void ranks_die(struct tool *tool, int status, const char *text,
                         void (*say)(struct tool *tool, int status, const char *text));

#endif
