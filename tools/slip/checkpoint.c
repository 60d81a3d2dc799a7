/*
 * --checkpoint and --resume: a file of tractions and pressures, from which a run that was cut off goes on.
 *
 * Each increment that is done adds a frame, a grid stream of its own with its end line, and so does one that
 * a signal ends: along x, along y and the pressure, one below the other. A run that goes on takes every
 * increment again, in order, and begins it with what stands there: one that was done is done with a step,
 * and the answer is that of a run that was never cut off, within the tolerance. Disk full is no reason to
 * lose the solution: it is said once.
 */
#include "slip.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

#include "formats/core/core.h"
#include "tools/journal/journal.h"

static const char channel[] = "friction-start";

enum {
    MAPS = 3
};

struct slip_checkpoint {
    struct slip_run *run;
    struct journal journal;
    struct saved {
        size_t step;
        off_t at;
    } * saved;
    size_t count, step; /* increments since the start, of all cases */
    char problem[16];   /* CRC-32 of the case and what is asked of it */
};

static void
note(struct slip_checkpoint *c, size_t step, off_t at)
{
    struct saved *more = realloc(c->saved, (c->count + 1) * sizeof *more);

    if (more == NULL)
        tool_die(&c->run->t, EXIT_IMPOSSIBLE, "out of memory for the increments of --checkpoint");
    c->saved = more;
    c->saved[c->count++] = (struct saved){step, at};
}

/* Finds the frames; what was being written when the run was cut off is cut off here too. */
static void
look_through(struct slip_checkpoint *c)
{
    struct tool *t = &c->run->t;
    struct rc_err err;
    struct rc_reader *reader = rc_reader_new(c->journal.file, 0, t->memory, &err);
    struct rc_grid *g;
    off_t end = 0;
    double step;

    if (reader == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "%s", err.text);
    while (rc_reader_next(reader, &g, &err) == RC_MORE) {
        if (strcmp(g->channel, channel) != 0 || !rc_grid_number(g, "checkpoint.step", &step))
            tool_die(
                t, EXIT_IMPOSSIBLE,
                "--checkpoint %s: a grid stream, but no checkpoint of rc-slip: name another file",
                c->journal.name);
        note(c, (size_t)step, end);
        end = journal_frame_end(&c->journal);
        rc_grid_free(g);
    }
    rc_reader_free(reader);
    clearerr(c->journal.file);
    if (c->count == 0 && fseeko(c->journal.file, 0, SEEK_END) == 0 && ftello(c->journal.file) > 0)
        tool_die(t, EXIT_IMPOSSIBLE,
                 "--checkpoint %s: no increment can be read from it: name another file, or remove "
                 "it to begin anew",
                 c->journal.name);
    journal_cut(&c->journal, c->count, end);
}

struct slip_checkpoint *
slip_checkpoint_open(struct slip_run *run, const char *name, bool resume)
{
    struct slip_checkpoint *c;
    bool found;

    if (name == NULL)
        return NULL;
    if ((c = calloc(1, sizeof *c)) == NULL)
        tool_die(&run->t, EXIT_IMPOSSIBLE, "out of memory");
    c->run = run;
    journal_open(&c->journal, &run->t, name, resume, &found);
    if (found)
        look_through(c);
    return c;
}

void
slip_checkpoint_close(struct slip_checkpoint *c)
{
    if (c == NULL)
        return;
    journal_close(&c->journal);
    free(c->saved);
    free(c);
}

void
slip_checkpoint_case(struct slip_checkpoint *c)
{
    const struct rc_grid *maps[2];
    const char *asked;
    uint32_t crc;

    if (c == NULL)
        return;
    maps[0] = c->run->p;
    maps[1] = c->run->height;
    asked = tool_history(&c->run->t);
    crc = rc_crc32_add(0, asked, strlen(asked));
    for (int k = 0; k < 2 && maps[k] != NULL; k++)
        crc = rc_crc32_add(crc, maps[k]->v, rc_grid_nodes(maps[k]) * sizeof *maps[k]->v);
    snprintf(c->problem, sizeof c->problem, "%08" PRIx32, crc);
}

/* The last frame of this increment; NULL: there is none. */
static struct rc_grid *
last_frame(struct slip_checkpoint *c)
{
    struct tool *t = &c->run->t;
    struct rc_grid *g;
    const char *problem;
    size_t k = c->count;

    while (k > 0 && c->saved[k - 1].step != c->step)
        k--;
    if (k == 0 || c->journal.file == NULL)
        return NULL;
    g = journal_read(&c->journal, c->saved[k - 1].at);
    problem = rc_grid_get(g, "checkpoint.problem");
    if (problem == NULL || strcmp(problem, c->problem) != 0 || g->nx != c->run->p->nx ||
        g->ny != MAPS * c->run->p->ny)
        tool_die(t, EXIT_IMPOSSIBLE,
                 "--checkpoint %s: it is of another pressure, or of other options: resume with "
                 "those that it was begun with, or remove it",
                 c->journal.name);
    return g;
}

bool
slip_checkpoint_next(struct slip_checkpoint *c, struct rc_joint *joint)
{
    size_t n;
    struct rc_grid *g;

    if (c == NULL)
        return false;
    c->step++;
    n = rc_grid_nodes(c->run->p);
    if ((g = last_frame(c)) == NULL)
        return false;
    rc_joint_start(joint, (const double *[2]){g->v, g->v + n}, g->v + 2 * n);
    rc_grid_free(g);
    return true;
}

void
slip_checkpoint_save(struct slip_checkpoint *c, struct rc_joint *joint)
{
    const double *p = rc_joint_pressure(joint);
    struct rc_shape shape;
    struct rc_grid *g;
    struct rc_err err;
    size_t n;
    off_t at;

    if (c == NULL || c->journal.file == NULL)
        return;
    n = rc_grid_nodes(c->run->p);
    shape = rc_grid_shape(c->run->p);
    shape.ny *= MAPS;
    if ((g = rc_grid_new(&shape, channel, "Pa", &err)) == NULL ||
        rc_grid_set(g, "checkpoint.problem", c->problem, &err) != RC_OK ||
        rc_grid_set_number(g, "checkpoint.step", (double)c->step, &err) != RC_OK ||
        rc_grid_history(g, tool_history(&c->run->t), &err) != RC_OK)
        tool_die_at(&c->run->t, c->run->p, EXIT_IMPOSSIBLE, "%s", err.text);
    for (int k = 0; k < 2; k++)
        memcpy(g->v + (size_t)k * n, rc_slip_traction(rc_joint_slip(joint), k), n * sizeof *g->v);
    if (p != NULL)
        memcpy(g->v + 2 * n, p, n * sizeof *g->v);
    else
        memset(g->v + 2 * n, 0, n * sizeof *g->v);
    if (journal_add(&c->journal, g, &at))
        note(c, c->step, at);
    rc_grid_free(g);
}

size_t
slip_checkpoint_memory(const struct slip_run *run)
{
    return run->checkpoint == NULL ? 0 : MAPS * rc_grid_nodes(run->p) * sizeof(double);
}
