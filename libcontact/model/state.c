/*
 * The state of a model and its inner ones as numbers, for files and for the copy that is taken at each
 * point kept.
 */
#include "row.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct rc_state {
    enum {
        COUNTS,
        WRITES,
        READS
    } mode;
    double *to;         /* WRITES */
    const double *from; /* READS  */
    size_t at, n;
    const char *bad; /* why the numbers were refused; NULL: they were not */
};

bool
rc_state_reads(const struct rc_state *s)
{
    return s->mode == READS && s->bad == NULL;
}

void
rc_state_refuse(struct rc_state *s, const char *why)
{
    if (s->bad == NULL)
        s->bad = why;
}

bool
rc_state_holds(struct rc_state *s, size_t n)
{
    if (s->mode == READS && n > s->n - s->at)
        rc_state_refuse(s, "numbers are missing");
    return s->bad == NULL;
}

void
rc_state_numbers(struct rc_state *s, size_t n, double *v)
{
    if (n == 0)
        return;
    if (!rc_state_holds(s, n))
        return;
    if (s->mode == READS)
        memcpy(v, s->from + s->at, n * sizeof *v);
    else if (s->mode == WRITES)
        memcpy(s->to + s->at, v, n * sizeof *v);
    s->at += n;
}

void
rc_state_count(struct rc_state *s, size_t *n, size_t most)
{
    double v = (double)*n;

    rc_state_numbers(s, 1, &v);
    if (!rc_state_reads(s))
        return;
    if (v >= 0 && v <= (double)most && v == floor(v))
        *n = (size_t)v;
    else
        rc_state_refuse(s, "a size is out of range");
}

/* The name of a model as a number. */
static double
mark(const char *name)
{
    double v = 0;

    for (; *name != '\0'; name++)
        v = fmod(31 * v + *name, 1e9);
    return v;
}

static void
exchange_point(struct rc_state *s, struct rc_point *p)
{
    size_t given = p->given;

    rc_state_count(s, &given, (1u << RC_AXES) - 1);
    p->given = (unsigned)given;
    rc_state_numbers(s, RC_AXES, p->at);
}

static void exchange(struct rc_model *m, struct rc_state *s);

/* The members of the row, then the inner models. */
static void
exchange_members(struct rc_model *m, struct rc_state *s)
{
    m->row->state(m, s);
    if (m->inner != NULL)
        exchange(m->inner, s);
}

/* The copy of the state at the last point kept, without which a restored model could not forget. */
static void
exchange_kept(struct rc_model *m, struct rc_state *s)
{
    size_t n = m->kept.n;
    double *v;

    rc_state_count(s, &n, SIZE_MAX / sizeof *v - 1);
    if (rc_state_holds(s, n) && rc_state_reads(s)) {
        if ((v = realloc(m->kept.v, (n + 1) * sizeof *v)) == NULL) {
            rc_state_refuse(s, "memory is short");
            return;
        }
        m->kept.v = v;
        m->kept.n = n;
    }
    rc_state_numbers(s, n, m->kept.v);
}

static void
exchange(struct rc_model *m, struct rc_state *s)
{
    double head[] = {mark(m->row->name), (double)m->shape.nx, (double)m->shape.ny};
    const double own[] = {head[0], head[1], head[2]};
    size_t status = (size_t)(m->status - RC_FAIL), moved = m->moved;

    rc_state_numbers(s, 3, head);
    if (rc_state_reads(s) && memcmp(head, own, sizeof own) != 0)
        rc_state_refuse(s, head[0] != own[0] ? "it is of another model" : "it is of another map");
    rc_state_count(s, &status, RC_SHORT - RC_FAIL);
    rc_state_count(s, &moved, 1);
    exchange_point(s, &m->from);
    exchange_point(s, &m->to);
    m->status = (enum rc_status)((int)status + RC_FAIL);
    m->moved = moved;
    if (m->moved && !m->row->forgets)
        exchange_kept(m, s);
    if (s->bad == NULL)
        exchange_members(m, s);
}

/* ---- the copy ---- */

enum rc_status
rc_model_remember(struct rc_model *m, struct rc_err *err)
{
    struct rc_state s = {.mode = COUNTS};
    double *v;

    if (m->row->forgets)
        return RC_OK;
    exchange_members(m, &s);
    if ((v = realloc(m->kept.v, (s.at + 1) * sizeof *v)) == NULL)
        return rc_err_set(err, "out of memory for the state of the %s model", m->row->name);
    m->kept.v = v;
    m->kept.n = s.at;
    s = (struct rc_state){.mode = WRITES, .to = v};
    exchange_members(m, &s);
    return RC_OK;
}

/* What was stepped since then is forgotten. */
enum rc_status
rc_model_recall(struct rc_model *m, struct rc_err *err)
{
    struct rc_state s = {.mode = READS, .from = m->kept.v, .n = m->kept.n};

    if (m->row->forgets)
        return RC_OK;
    exchange_members(m, &s);
    return s.bad == NULL ? RC_OK
                         : rc_err_set(err, "the %s model cannot return to the point before: %s",
                                      m->row->name, s.bad);
}

/* ---- for files ---- */

size_t
rc_model_state_size(struct rc_model *m)
{
    struct rc_state s = {.mode = COUNTS};

    exchange(m, &s);
    return s.at;
}

void
rc_model_state(struct rc_model *m, double *state)
{
    struct rc_state s = {.mode = WRITES, .to = state};

    exchange(m, &s);
}

enum rc_status
rc_model_restore(struct rc_model *m, const double *state, size_t n, bool *going, struct rc_err *err)
{
    struct rc_state s = {.mode = READS, .from = state, .n = n};

    for (size_t k = 0; k < n; k++)
        if (isnan(state[k]))
            rc_state_refuse(&s, "it holds NaN");
    exchange(m, &s);
    if (s.bad == NULL && s.at != n)
        rc_state_refuse(&s, "it has more numbers than the model");
    *going = m->status == RC_MORE;
    return s.bad == NULL
               ? RC_OK
               : rc_err_set(err, "this is no state of the %s model: %s", m->row->name, s.bad);
}
