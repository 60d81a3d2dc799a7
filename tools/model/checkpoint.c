/*
 * --checkpoint and --resume: a file of states, from which an interrupted run continues.
 *
 * A state has one frame for each map; the header of the last one holds the numbers. A state without maps is
 * one frame of numbers. Each frame is a grid stream with its own end line and is only appended, so that a
 * crash damages at most the last frame. A state is written when a case is done and when a signal ends the
 * run. On the way it is written after 1, 2, 4, 8 ... intervals, so that at most half of the time of a case is
 * lost. The last state of a case counts. If the disk is full, the tool warns once and the run continues.
 */
#include "model.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

#include "formats/core/core.h"
#include "tools/journal/journal.h"

enum {
    FEW = 1024 /* numbers in a header */
};

struct checkpoint {
    struct tool *t;
    struct journal journal;
    struct saved {          /* a frame */
        size_t number, map; /* the case; which map of a state, from 0  */
        bool last;          /* last of the state */
        off_t at;           /* where it begins                         */
    } * saved;
    size_t count;
    double began, wait, next; /* s: start of this case, interval, time of the next state */
};

/* ---- the file ---- */

static void
note(struct checkpoint *c, const struct rc_grid *g, off_t at)
{
    struct saved *more = realloc(c->saved, (c->count + 1) * sizeof *more);
    double number, map;

    if (more == NULL)
        tool_die(c->t, "out of memory for the cases of --checkpoint");
    c->saved = more;
    if (!rc_grid_number(g, "checkpoint.case", &number))
        tool_die(c->t, "--checkpoint %s: a grid stream, but no checkpoint: name another file",
                 c->journal.name);
    if (!rc_grid_number(g, "checkpoint.map", &map))
        tool_die(c->t, "--checkpoint %s: another version wrote it: remove the file to start again",
                 c->journal.name);
    c->saved[c->count++] = (struct saved){(size_t)number, (size_t)map,
                                          rc_grid_get(g, "checkpoint.numbers") != NULL, at};
}

/* True if the first frame, complete or not, belongs to a checkpoint. */
static bool
is_checkpoint(const struct checkpoint *c)
{
    bool begins = true; /* this is the first piece of a line */
    char line[256];

    if (fseeko(c->journal.file, 0, SEEK_SET) != 0 ||
        fgets(line, sizeof line, c->journal.file) == NULL || strcmp(line, "RCG1\n") != 0)
        return false;
    while (fgets(line, sizeof line, c->journal.file) != NULL &&
           !(begins && strcmp(line, "\n") == 0)) {
        if (begins && strncmp(line, "checkpoint.case=", 16) == 0)
            return true;
        begins = strchr(line, '\n') != NULL;
    }
    return false;
}

/* Finds the frames, and removes an incomplete last one. */
static void
look_through(struct checkpoint *c)
{
    struct tool *t = c->t;
    struct rc_reader *reader = rc_reader_new(c->journal.file, 0, t->memory, &t->err);
    const struct rc_share *share = ranks_read(t, c->journal.name);
    struct rc_grid *g;
    enum rc_status status;
    off_t end = 0;

    if (reader == NULL)
        tool_die(t, "%s", t->err.text);
    rc_reader_share(reader, share);
    while ((status = rc_reader_next(reader, &g, &t->err)) == RC_MORE) {
        note(c, g, end);
        end = journal_frame_end(&c->journal);
        rc_grid_free(g);
    }
    rc_reader_free(reader);
    ranks_close(t, share);
    clearerr(c->journal.file);
    if (fseeko(c->journal.file, 0, SEEK_END) == 0 && ftello(c->journal.file) == 0)
        return;
    if (status != RC_OK && c->count == 0 && !is_checkpoint(c))
        tool_die(
            t,
            "--checkpoint %s: no pressure can be read from it (%s): remove the file to start again",
            c->journal.name, t->err.text);
    if (status != RC_OK && !journal_is_cut_off(&c->journal, end))
        tool_die(t,
                 "--checkpoint %s: frame %zu cannot be read (%s): remove the file to start again",
                 c->journal.name, c->count + 1, t->err.text);
    ranks_wait(t);         /* all ranks have read the file */
    if (!ranks_speak(t)) { /* the first rank shortens the file */
        ranks_wait(t);
        return;
    }
    if (c->count == 0)
        tool_warn(
            t, "--checkpoint %s: its first frame is incomplete: this run starts from the beginning",
            c->journal.name);
    journal_cut(&c->journal, c->count, end);
    ranks_wait(t);
}

struct checkpoint *
checkpoint_open(struct tool *t, const char *name, bool resume, double interval)
{
    struct checkpoint *c;
    bool found;

    if (name == NULL)
        return NULL;
    c = tool_room(t, 1, sizeof *c, "a checkpoint");
    c->t = t;
    c->wait = interval;
    journal_open(&c->journal, t, name, resume, &found);
    if (found)
        look_through(c);
    return c;
}

void
checkpoint_close(struct checkpoint *c)
{
    if (c == NULL)
        return;
    journal_close(&c->journal);
    free(c->saved);
    free(c);
}

void
checkpoint_crc(struct tool *t, const struct rc_grid *g, char text[16])
{
    size_t bytes = rc_grid_nodes(g) * sizeof *g->v;

    snprintf(text, 16, "%08" PRIx32, ranks_crc(t, rc_crc32_add(0, g->v, bytes), bytes));
}

void
checkpoint_refuse(const struct course *c, const char *why)
{
    tool_refuse(
        c->t, c->g,
        "--checkpoint %s: case %zu cannot be continued (%s): remove the file to start again",
        c->checkpoint->journal.name, c->number, why);
}

/* ---- reading ---- */

static void
compare(const struct course *c, const struct rc_grid *saved, bool map)
{
    const struct rc_grid *g = c->g;
    const char *name = c->checkpoint->journal.name;

    if ((map && (saved->nx != g->nx || saved->ny != g->ny)) || saved->dx != g->dx ||
        saved->dy != g->dy)
        tool_refuse(c->t, g, "--checkpoint %s: it belongs to another grid, %zu x %zu nodes", name,
                    saved->nx, saved->ny);
    for (size_t k = 0; k < c->marks; k++) {
        const struct mark *mark = &c->mark[k];
        const char *was = rc_grid_get(saved, mark->name);
        if (strcmp(was == NULL ? "" : was, mark->value) != 0)
            tool_refuse(c->t, g, "--checkpoint %s: it belongs to another problem: %s was %s, is %s",
                        name, mark->name, was == NULL ? "not given" : was,
                        mark->value[0] == '\0' ? "not given" : mark->value);
    }
}

/* Reads numbers from the header; returns how many. */
static size_t
read_numbers(const char *text, double to[FEW])
{
    size_t n = 0;
    char *end;

    for (; n < FEW; n++, text = end) {
        to[n] = strtod(text, &end);
        if (end == text)
            break;
    }
    return n;
}

double *
checkpoint_load(struct course *course, size_t *n)
{
    struct checkpoint *c = course->checkpoint;
    double numbers[FEW], *v = NULL;
    struct rc_grid *g;
    size_t k, maps, nodes = 0, few = 0;

    if (c == NULL)
        return NULL;
    c->began = tool_now();
    c->next = c->wait;
    for (k = c->count; k > 0 && (c->saved[k - 1].number != course->number || !c->saved[k - 1].last);
         k--)
        ;
    if (k == 0)
        return NULL;
    maps = c->saved[k - 1].map + 1;
    for (size_t j = maps; j-- > 0;) {
        g = journal_read(&c->journal, c->saved[k - maps + j].at);
        if (j + 1 == maps) { /* frames are read from the last one backwards */
            few = read_numbers(rc_grid_get(g, "checkpoint.numbers"), numbers);
            compare(course, g, few > 0);
            nodes = rc_grid_nodes(g);
            *n = few + maps * nodes;
            if ((v = malloc((*n + 1) * sizeof *v)) == NULL)
                tool_refuse(c->t, course->g, "out of memory for a state of --checkpoint");
            memcpy(v, numbers, few * sizeof *v);
        }
        memcpy(v + few + j * nodes, g->v, nodes * sizeof *v);
        rc_grid_free(g);
    }
    return v;
}

/* ---- saving ---- */

/* A frame with the case and the marks; its shape and values follow later. */
static struct rc_grid *
new_frame(const struct course *c)
{
    const struct rc_shape one = {1, 1, c->g->dx, c->g->dy};
    struct rc_grid *out = tool_made(c->t, c->g, rc_grid_new(&one, "state", "1", &c->t->err));

    tool_set_number(c->t, out, "checkpoint.case", (double)c->number);
    for (size_t k = 0; k < c->marks; k++)
        if (c->mark[k].value[0] != '\0')
            tool_set(c->t, out, c->mark[k].name, c->mark[k].value);
    tool_sign(c->t, out);
    return out;
}

/* Appends a frame of this shape with these values; numbers: for the header, or NULL. False if it cannot be
 * written. */
static bool
add(struct course *course, const struct rc_grid *shape, const double *v, size_t map,
    const char *numbers)
{
    struct checkpoint *c = course->checkpoint;
    RC_OWN(rc_grid, out) = new_frame(course);
    double *own = out->v;
    bool done;
    off_t at;

    tool_set_number(c->t, out, "checkpoint.map", (double)map);
    if (numbers != NULL)
        tool_set(c->t, out, "checkpoint.numbers", numbers);
    out->nx = shape->nx;
    out->ny = shape->ny;
    out->elsewhere = shape->elsewhere;
    out->v = (double *)v; /* it is only read */
    if ((done = journal_add(&c->journal, out, &at)))
        note(c, out, at);
    out->v = own;
    return done;
}

void
checkpoint_save(struct course *c, const double *state, size_t n)
{
    const size_t numbers = (size_t)state[0], maps = (size_t)state[1];
    const struct rc_grid row = {.nx = n, .ny = 1};
    char text[FEW * RC_NUMBER_SIZE] = "";
    size_t length = 0, nodes = rc_grid_nodes(c->g);

    if (c->checkpoint == NULL || c->checkpoint->journal.file == NULL)
        return;
    if (maps == 0 || numbers > FEW) {
        (void)add(c, &row, state, 0, "values");
        return;
    }
    for (size_t k = 0; k < numbers; k++)
        length += (size_t)snprintf(text + length, sizeof text - length, "%s%s", k > 0 ? " " : "",
                                   rc_number(state[k]));
    for (size_t k = 0; k < maps; k++)
        if (!add(c, c->g, state + numbers + k * nodes, k, k + 1 == maps ? text : NULL))
            return;
}

bool
checkpoint_due(struct checkpoint *c)
{
    if (c == NULL || ranks_most(c->t, tool_now() - c->began) < c->next)
        return false;
    c->next *= 2;
    return true;
}
