/* SPDX-License-Identifier: GPL-3.0-or-later */
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

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

#include "formats/core/core.h"
#include "tools/journal/journal.h"

enum {
    FEW = 1024,    /* numbers in a header */
    MOST = 1 << 30 /* number of a case or of a map */
};
/* Instead of numbers in the header: all values of the state stand in one row. */
static const char in_a_row[] = "values";

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

/* A whole number of at least `least` in the header, of a frame that was just read. */
static size_t
whole_number(const struct checkpoint *c, const struct rc_grid *g, const char *key, double least,
             const char *missing)
{
    double v;

    if (rc_grid_get(g, key) == NULL)
        tool_die(c->t, "--checkpoint %s: %s", c->journal.name, missing);
    if (!rc_grid_number(g, key, &v) || !(v >= least && v <= MOST) || v != floor(v))
        tool_die(c->t,
                 "--checkpoint %s: frame %zu has %s=%.40s, which is not a whole number from %g: "
                 "remove the file to start again",
                 c->journal.name, c->count + 1, key, rc_grid_get(g, key), least);
    return (size_t)v;
}

static void
note(struct checkpoint *c, const struct rc_grid *g, off_t at)
{
    struct saved *more = realloc(c->saved, (c->count + 1) * sizeof *more);

    if (more == NULL)
        tool_die(c->t, "out of memory for the cases of --checkpoint");
    c->saved = more;
    c->saved[c->count] = (struct saved){
        .number = whole_number(c, g, "checkpoint.case", 1,
                               "a grid stream, but no checkpoint: name another file"),
        .map = whole_number(c, g, "checkpoint.map", 0,
                            "another version wrote it: remove the file to start again"),
        .last = rc_grid_get(g, "checkpoint.numbers") != NULL,
        .at = at};
    c->count++;
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

/* Finds the frames, and removes an incomplete last one. Reads only their headers: values are checked when a
 * state is loaded. */
static void
look_through(struct checkpoint *c)
{
    struct tool *t = c->t;
    struct rc_reader *reader = rc_reader_new(c->journal.file, 0, t->memory, &t->err);
    struct rc_grid *g;
    enum rc_status status;
    off_t end = 0;

    if (reader == NULL)
        tool_die(t, "%s", t->err.text);
    rc_reader_by_rows(reader);
    while ((status = rc_reader_head(reader, &g, &t->err)) == RC_MORE) {
        if ((status = rc_reader_skip(reader, &t->err)) == RC_OK) {
            note(c, g, end);
            end = journal_frame_end(&c->journal);
        }
        rc_grid_free(g);
        if (status != RC_OK)
            break;
    }
    rc_reader_free(reader);
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
checkpoint_refuse(const struct course *c, const char *why)
{
    tool_refuse(
        c->t, c->g,
        "--checkpoint %s: case %zu cannot be continued (%s): remove the file to start again",
        c->checkpoint->journal.name, c->number, why);
}

/* ---- marks ---- */

static const struct {
    const char *key, *shown;
    bool hidden; /* the value is a CRC-32, which tells the user nothing */
} kinds[] = {[MARK_OPTION] = {"option", "--", false},
             [MARK_BOUND] = {"option", "--", false},
             [MARK_FILE] = {"file", "contents of --", true},
             [MARK_FRAME] = {"frame", "frame ", true},
             [MARK_KEY] = {"key", "key ", false},
             [MARK_POINT] = {"point", "", false},
             [MARK_EARLIER] = {"earlier", "earlier ", true}};

/* The key of a mark in a frame. */
static const char *
key_of(const struct mark *mark, char key[64])
{
    snprintf(key, 64, "%s.%s", kinds[mark->kind].key, mark->name);
    for (char *c = key; *c != '\0'; c++)
        *c = *c == ' ' ? '.' : (char)tolower((unsigned char)*c);
    return key;
}

/* True if the number may rise, and has risen. */
static bool
has_risen(const struct mark *mark, const char *was)
{
    return mark->kind == MARK_BOUND && was[0] != '\0' && mark->value[0] != '\0' &&
           strtod(mark->value, NULL) > strtod(was, NULL);
}

/* Ends the tool because the state belongs to another problem; was: "" if it was not given. */
static void
refuse_mark(const struct course *c, const struct mark *mark, const char *was)
{
    const char *is = mark->value, *shown = kinds[mark->kind].shown;

    if (kinds[mark->kind].hidden && was[0] != '\0' && is[0] != '\0')
        tool_refuse(c->t, c->g,
                    "--checkpoint %s: it belongs to another problem: %s%s: the values differ",
                    c->checkpoint->journal.name, shown, mark->name);
    tool_refuse(c->t, c->g, "--checkpoint %s: it belongs to another problem: %s%s was %s, is %s",
                c->checkpoint->journal.name, shown, mark->name,
                was[0] == '\0'             ? "not given"
                : kinds[mark->kind].hidden ? "given"
                                           : was,
                is[0] == '\0'              ? "not given"
                : kinds[mark->kind].hidden ? "given"
                                           : is);
}

/* ---- reading ---- */

static void
compare_marks(const struct course *c, const struct rc_grid *saved, bool hidden)
{
    char key[64];

    for (size_t k = 0; k < c->marks; k++) {
        const struct mark *mark = &c->mark[k];
        const char *was = rc_grid_get(saved, key_of(mark, key));
        if (was == NULL)
            was = "";
        if (kinds[mark->kind].hidden == hidden && strcmp(was, mark->value) != 0 &&
            !has_risen(mark, was))
            refuse_mark(c, mark, was);
    }
}

/* Refuses a frame of another grid or problem. Marks that the message can show come first. map: its values
 * are a map, not a row of values. */
static void
compare(const struct course *c, const struct rc_grid *saved, bool map)
{
    const struct rc_grid *g = c->g;
    const char *name = c->checkpoint->journal.name;

    compare_marks(c, saved, false);
    if (saved->dx != g->dx || saved->dy != g->dy ||
        (map ? saved->nx != g->nx || saved->ny != g->ny : saved->ny != 1))
        tool_refuse(c->t, g, "--checkpoint %s: it belongs to another grid, %zu x %zu nodes", name,
                    saved->nx, saved->ny);
    compare_marks(c, saved, true);
}

/* Reads numbers from the header; returns how many. */
static size_t
read_numbers(const struct course *c, const char *text, double to[FEW])
{
    size_t n = 0;
    char *end;

    for (; n < FEW; n++, text = end) {
        to[n] = strtod(text, &end);
        if (end == text)
            break;
    }
    if (*text != '\0')
        checkpoint_refuse(c, "its header holds something else than numbers");
    return n;
}

/* The frames of the last state of this case: returns the first, *maps is their number; 0: there is none. */
static const struct saved *
last_state(const struct course *course, size_t *maps)
{
    const struct checkpoint *c = course->checkpoint;
    const struct saved *first;
    size_t k = c->count;

    *maps = 0;
    while (k > 0 && (c->saved[k - 1].number != course->number || !c->saved[k - 1].last))
        k--;
    if (k == 0)
        return NULL;
    *maps = c->saved[k - 1].map + 1;
    if (*maps > k)
        checkpoint_refuse(course, "frames are missing");
    first = &c->saved[k - *maps];
    for (size_t j = 0; j < *maps; j++)
        if (first[j].number != course->number || first[j].map != j ||
            first[j].last != (j + 1 == *maps))
            checkpoint_refuse(course, "frames are missing");
    return first;
}

/* The numbers of a row, which one process has read, for all. */
static double *
spread_row(const struct course *course, const struct rc_grid *row, double *v, size_t *n)
{
    struct tool *t = course->checkpoint->t;
    const bool own = rc_grid_nodes(row) > 0;
    double *all = realloc(v, (row->nx + 1) * sizeof *v);

    if (ranks_most(t, all == NULL) > 0)
        tool_refuse(t, course->g, "out of memory for a state of --checkpoint");
    *n = row->nx;
    for (size_t k = 0; k < row->nx; k++)
        all[k] = ranks_sum(t, own ? all[k] : -0.0); /* -0 + v is v, also for v = -0 */
    return all;
}

double *
checkpoint_load(struct course *course, size_t *n)
{
    struct checkpoint *c = course->checkpoint;
    double numbers[FEW], *v = NULL;
    const struct saved *saved;
    size_t maps, nodes = 0, few = 0;

    if (c == NULL)
        return NULL;
    c->began = tool_now();
    c->next = c->wait;
    saved = last_state(course, &maps);
    for (size_t j = maps; j-- > 0;) {
        RC_OWN(rc_grid, g) =
            journal_read(&c->journal, saved[j].at, (size_t)(saved + j - c->saved) + 1);
        if (j + 1 == maps) { /* frames are read from the last one backwards */
            const char *text = rc_grid_get(g, "checkpoint.numbers");
            if (strcmp(text, in_a_row) != 0)
                few = read_numbers(course, text, numbers);
            if (few == 0 && maps > 1)
                checkpoint_refuse(course, "its numbers are missing");
            nodes = rc_grid_nodes(g);
            *n = few + maps * nodes;
            if ((v = malloc((*n + 1) * sizeof *v)) == NULL)
                tool_refuse(c->t, course->g, "out of memory for a state of --checkpoint");
            memcpy(v, numbers, few * sizeof *v);
        }
        compare(course, g, few > 0);
        memcpy(v + few + j * nodes, g->v, nodes * sizeof *v);
        if (few == 0)
            v = spread_row(course, g, v, n);
    }
    return v;
}

/* ---- saving ---- */

/* A frame with the case and the marks; its shape and values follow later. */
static struct rc_grid *
new_frame(const struct course *c)
{
    const struct rc_shape one = {1, 1, c->g->dx, c->g->dy};
    char key[64];
    struct rc_grid *out = tool_made(c->t, c->g, rc_grid_new(&one, "state", "1", &c->t->err));

    tool_set_number(c->t, out, "checkpoint.case", (double)c->number);
    for (size_t k = 0; k < c->marks; k++)
        if (c->mark[k].value[0] != '\0')
            tool_set(c->t, out, key_of(&c->mark[k], key), c->mark[k].value);
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
    struct rc_grid row = {.nx = n, .ny = 1};
    char text[FEW * RC_NUMBER_SIZE] = "";
    size_t length = 0, nodes = rc_grid_nodes(c->g), first, rows;

    if (c->checkpoint == NULL || c->checkpoint->journal.file == NULL)
        return;
    if (maps == 0 || numbers > FEW) {
        /* the numbers of all processes are equal: one of them writes the row */
        ranks_rows(c->t, rc_shape_of(&row), &first, &rows);
        row.elsewhere = 1 - rows;
        (void)add(c, &row, state, 0, in_a_row);
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
