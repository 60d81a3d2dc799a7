/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The state of a model and its inner models as numbers, for files and for the copy at each kept point. The
 * order is: the count of numbers and maps, the numbers, then the maps.
 */
#include "row.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct rc_state {
    enum {
        COUNTS,
        WRITES,
        READS
    } mode;
    double *to;            /* WRITES */
    const double *from;    /* READS  */
    size_t at, numbers;    /* place of the next number, and where they end     */
    size_t map_at, n;      /* place of the next map, and where they end        */
    size_t maps, all_maps; /* maps exchanged so far, and all maps of the state that is read */
    struct {               /* numbers go into maps instead: see rc_state_parts */
        bool on;
        size_t first, nodes; /* the nodes of the part      */
        size_t at, end;      /* its next number, and where they end */
        size_t all;          /* nodes held here            */
    } part;
    bool copy;     /* see rc_state_is_copy */
    bool bad;      /* the numbers were refused, */
    char why[256]; /* because of this */
};

bool
rc_state_reads(const struct rc_state *s)
{
    return s->mode == READS && !s->bad;
}

bool
rc_state_is_copy(const struct rc_state *s)
{
    return s->copy;
}

bool
rc_state_refused(const struct rc_state *s)
{
    return s->bad;
}

void
rc_state_refuse(struct rc_state *s, const char *why)
{
    if (!s->bad)
        snprintf(s->why, sizeof s->why, "%s", why);
    s->bad = true;
}

bool
rc_state_agree(struct rc_state *s, const struct rc_ranks *ranks)
{
    if (rc_ranks_most(ranks, s->bad) > 0)
        rc_state_refuse(s, "another process refuses it");
    return !s->bad;
}

bool
rc_state_holds(struct rc_state *s, size_t n)
{
    if (s->part.on ? n > s->part.end - s->part.at : s->mode == READS && n > s->numbers - s->at)
        rc_state_refuse(s, "numbers are missing");
    return !s->bad;
}

/* Exchanges numbers of a part with its nodes of one map after the other. */
static void
exchange_part(struct rc_state *s, size_t n, double *v)
{
    for (size_t k = 0; k < n && s->mode != COUNTS; k++) {
        const size_t at = s->part.at + k, map = at / s->part.nodes;
        const size_t place = s->map_at + map * s->part.all + s->part.first + at % s->part.nodes;
        if (s->mode == READS)
            v[k] = s->from[place];
        else
            s->to[place] = v[k];
    }
    s->part.at += n;
}

void
rc_state_numbers(struct rc_state *s, size_t n, double *v)
{
    if (n == 0)
        return;
    if (!rc_state_holds(s, n))
        return;
    if (s->part.on) {
        exchange_part(s, n, v);
        return;
    }
    if (s->mode == READS)
        memcpy(v, s->from + s->at, n * sizeof *v);
    else if (s->mode == WRITES)
        memcpy(s->to + s->at, v, n * sizeof *v);
    s->at += n;
}

/* Refuses a state without a further map of n values. */
static void
demand_map(struct rc_state *s, size_t n)
{
    if (n > s->n - s->map_at || s->maps == s->all_maps)
        rc_state_refuse(s, "numbers are missing");
}

/* Refuses numbers that are not finite, also in single precision. */
static bool
finite(struct rc_state *s, size_t n, const double *v)
{
    for (size_t k = 0; k < n && !s->bad; k++)
        if (!(fabs(v[k]) <= (double)FLT_MAX))
            rc_state_refuse(s, "a number is not finite");
    return !s->bad;
}

double *
rc_state_map(struct rc_state *s, size_t n, double *v)
{
    const double *from;

    if (s->mode == READS) {
        if ((from = rc_state_read_map(s, n)) != NULL && v != NULL)
            memcpy(v, from, n * sizeof *v);
        return NULL;
    }
    if (s->mode == WRITES && v != NULL)
        memcpy(s->to + s->map_at, v, n * sizeof *v);
    s->map_at += n;
    s->maps++;
    return s->mode == WRITES ? s->to + s->map_at - n : NULL;
}

const double *
rc_state_read_map(struct rc_state *s, size_t n)
{
    demand_map(s, n);
    if (s->bad || !finite(s, n, s->from + s->map_at))
        return NULL;
    s->map_at += n;
    s->maps++;
    return s->from + s->map_at - n;
}

void
rc_state_rows(struct rc_state *s, const struct rc_rows *rows, size_t nx, double *v)
{
    const double *from = rc_state_reads(s) ? rc_state_read_map(s, rows->n * nx) : NULL;
    double *to = s->mode == READS ? NULL : rc_state_map(s, rows->n * nx, NULL);

    for (size_t k = 0; k < rows->n * nx && to != NULL; k++)
        to[k] = v[k / nx];
    for (size_t j = 0; j < rows->n && from != NULL; j++)
        v[j] = from[j * nx];
}

/* The maps that the fullest part of all ranks needs. */
static size_t
maps_of_parts(const struct rc_rows *rows, size_t nx,
              void (*part)(void *of, struct rc_state *s, size_t first, size_t n), void *of)
{
    const size_t unit = rc_rows_unit(nx);
    double most = 0;

    for (size_t j = 0; j < rows->n; j += unit) {
        const size_t n = rows->n - j < unit ? rows->n - j : unit;
        struct rc_state s = {.mode = COUNTS, .part = {.on = true, .end = SIZE_MAX}};
        part(of, &s, j, n);
        most = fmax(most, ceil((double)s.part.at / (double)(n * nx)));
    }
    return (size_t)rc_ranks_most(rows->ranks, most);
}

void
rc_state_parts(struct rc_state *s, const struct rc_rows *rows, size_t nx,
               void (*part)(void *of, struct rc_state *s, size_t first, size_t n), void *of)
{
    const size_t unit = rc_rows_unit(nx), all = rows->n * nx;
    size_t maps = s->mode == READS ? 0 : maps_of_parts(rows, nx, part, of);

    rc_state_count(s, &maps, s->mode == READS ? s->all_maps - s->maps : maps);
    if (s->bad)
        return;
    if (s->mode == READS && maps * all > s->n - s->map_at) {
        rc_state_refuse(s, "numbers are missing");
        return;
    }
    if (s->mode == WRITES)
        memset(s->to + s->map_at, 0, maps * all * sizeof *s->to);
    for (size_t j = 0; j < rows->n && s->mode != COUNTS && !s->bad; j += unit) {
        const size_t n = rows->n - j < unit ? rows->n - j : unit;
        s->part.on = true;
        s->part.first = j * nx;
        s->part.nodes = n * nx;
        s->part.at = 0;
        s->part.end = maps * n * nx;
        s->part.all = all;
        part(of, s, j, n);
        s->part.on = false;
    }
    s->map_at += maps * all;
    s->maps += maps;
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

void
rc_state_each_number(struct rc_state *s, double *const *v)
{
    for (; *v != NULL; v++)
        rc_state_finite(s, 1, *v);
}

/* A number that is not finite has a place above all numbers of single precision. */
void
rc_state_each_open(struct rc_state *s, double *const *v)
{
    static const double places[] = {1e300, 2e300, 3e300};
    static const double are[] = {INFINITY, -INFINITY, NAN};

    for (; *v != NULL; v++) {
        double stored = **v;
        size_t k = isnan(stored) ? 2 : isinf(stored) ? stored < 0 : 3;
        if (k < 3)
            stored = places[k];
        rc_state_numbers(s, 1, &stored);
        if (!rc_state_reads(s))
            continue;
        for (k = 0; k < 3 && stored != places[k]; k++)
            ;
        if (k < 3)
            **v = are[k];
        else if (finite(s, 1, &stored))
            **v = stored;
    }
}

void
rc_state_each_count(struct rc_state *s, size_t *const *n)
{
    for (; *n != NULL; n++)
        rc_state_count(s, *n, SIZE_MAX / 4096);
}

void
rc_state_each_flag(struct rc_state *s, bool *const *flag)
{
    for (; *flag != NULL; flag++) {
        size_t v = **flag;
        rc_state_count(s, &v, 1);
        **flag = v;
    }
}

void
rc_state_finite(struct rc_state *s, size_t n, double *v)
{
    rc_state_numbers(s, n, v);
    if (rc_state_reads(s))
        (void)finite(s, n, v);
}

void
rc_state_each_size(struct rc_state *s, double *const *v)
{
    for (; *v != NULL; v++)
        rc_state_number(s, *v, 0);
}

void
rc_state_number(struct rc_state *s, double *v, double least)
{
    rc_state_finite(s, 1, v);
    if (rc_state_reads(s) && !(*v >= least))
        rc_state_refuse(s, "a number is out of range");
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
    for (enum rc_axis k = 0; k < RC_AXES; k++)
        if (k == RC_APPROACH) /* of a retraction it is -INFINITY */
            RC_STATE_OPEN(s, &p->at[k]);
        else
            rc_state_finite(s, 1, &p->at[k]);
}

/* Exchanges the members of the row, then the inner models. */
static void
exchange_members(struct rc_model *m, struct rc_state *s)
{
    m->row->state(m, s);
    if (m->inner != NULL && !s->bad)
        rc_state_model(s, m->inner);
}

void
rc_state_copy(struct rc_state *s, struct rc_state_copy *c)
{
    size_t numbers = c->numbers, maps = c->maps;
    size_t nodes = maps > 0 ? (c->n - numbers) / maps : 0;
    double *v;

    rc_state_count(s, &numbers, SIZE_MAX / sizeof *v - 1);
    rc_state_count(s, &maps, s->mode == READS ? s->all_maps - s->maps : maps);
    if (!rc_state_holds(s, numbers))
        return;
    if (rc_state_reads(s)) {
        nodes = maps > 0 ? (s->n - s->numbers) / s->all_maps : 0;
        if ((v = realloc(c->v, (numbers + maps * nodes + 1) * sizeof *v)) == NULL) {
            rc_state_refuse(s, "memory is short");
            return;
        }
        *c = (struct rc_state_copy){v, numbers + maps * nodes, numbers, maps};
    }
    rc_state_numbers(s, numbers, c->v);
    for (size_t k = 0; k < maps; k++)
        rc_state_map(s, nodes, c->v + numbers + k * nodes);
}

void
rc_state_model(struct rc_state *s, struct rc_model *m)
{
    double head[] = {mark(m->row->name), (double)m->shape.nx, (double)m->shape.ny};
    const double own[] = {head[0], head[1], head[2]};
    size_t status = (size_t)(m->status - RC_FAIL), moved = m->moved;

    rc_state_numbers(s, 3, head);
    if (rc_state_reads(s) && memcmp(head, own, sizeof own) != 0)
        rc_state_refuse(s, head[0] != own[0] ? "it belongs to another model"
                                             : "it belongs to another map");
    rc_state_count(s, &status, RC_SHORT - RC_FAIL);
    rc_state_count(s, &moved, 1);
    exchange_point(s, &m->from);
    exchange_point(s, &m->to);
    m->status = (enum rc_status)((int)status + RC_FAIL);
    m->moved = moved;
    if (m->status == RC_MORE && !m->moved)
        rc_state_refuse(s, "it has steps without a point");
    m->looked &= !rc_state_reads(s);
    if (m->moved && !m->row->forgets)
        rc_state_copy(s, &m->kept); /* a restored model needs it for its own later return */
    if (s->mode != READS || rc_state_agree(s, m->rows.ranks))
        exchange_members(m, s);
    if (rc_state_reads(s) && m->moved && m->inner != NULL && m->inner->status == RC_MORE)
        m->status = RC_MORE; /* the inner model must find its solution again */
}

/* ---- copies ---- */

enum rc_status
rc_state_save(struct rc_state_copy *c, const struct rc_ranks *ranks,
              void (*part)(void *of, struct rc_state *s), void *of)
{
    struct rc_state s = {.mode = COUNTS, .copy = true};
    struct rc_err err = {""};
    double *v;

    part(of, &s);
    if ((v = realloc(c->v, (s.at + s.map_at + 1) * sizeof *v)) != NULL)
        *c = (struct rc_state_copy){v, s.at + s.map_at, s.at, s.maps};
    if (rc_ranks_agree(ranks, v != NULL ? RC_OK : RC_FAIL, &err) != RC_OK)
        return RC_FAIL;
    s = (struct rc_state){.mode = WRITES, .copy = true, .to = v, .map_at = s.at};
    part(of, &s);
    return RC_OK;
}

enum rc_status
rc_state_load(const struct rc_state_copy *c, const struct rc_ranks *ranks,
              void (*part)(void *of, struct rc_state *s), void *of, struct rc_err *err)
{
    struct rc_state s = {.mode = READS,
                         .copy = true,
                         .from = c->v,
                         .n = c->n,
                         .numbers = c->numbers,
                         .map_at = c->numbers,
                         .all_maps = c->maps};

    part(of, &s);
    return rc_ranks_need(ranks, !s.bad, err, "the previous point cannot be restored: %s", s.why);
}

void
rc_state_forget(struct rc_state_copy *c)
{
    free(c->v);
    *c = (struct rc_state_copy){0};
}

static void
exchange_model(void *m, struct rc_state *s)
{
    exchange_members(m, s);
}

enum rc_status
rc_model_remember(struct rc_model *m, struct rc_err *err)
{
    if (m->row->forgets || rc_state_save(&m->kept, m->rows.ranks, exchange_model, m) == RC_OK)
        return RC_OK;
    return rc_err_set(err, "out of memory for the state of the %s model", m->row->name);
}

enum rc_status
rc_model_recall(struct rc_model *m, struct rc_err *err)
{
    return m->row->forgets ? RC_OK : rc_state_load(&m->kept, m->rows.ranks, exchange_model, m, err);
}

/* ---- for files ---- */

static void
exchange_all(struct rc_model *m, struct rc_state *s, size_t numbers, size_t maps)
{
    const size_t most = SIZE_MAX / sizeof(double);

    rc_state_count(s, &numbers, most);
    rc_state_count(s, &maps, most);
    if (rc_state_reads(s) && (numbers < s->at || numbers > s->n))
        rc_state_refuse(s, "numbers are missing");
    if (rc_state_reads(s)) {
        s->numbers = s->map_at = numbers;
        s->all_maps = maps;
    }
    rc_state_model(s, m);
}

size_t
rc_model_state_size(struct rc_model *m)
{
    struct rc_state s = {.mode = COUNTS};

    exchange_all(m, &s, 0, 0);
    return s.at + s.map_at;
}

void
rc_model_state(struct rc_model *m, double *state)
{
    struct rc_state s = {.mode = COUNTS};
    size_t maps;

    exchange_all(m, &s, 0, 0);
    maps = s.maps;
    s = (struct rc_state){.mode = WRITES, .to = state, .map_at = s.at};
    exchange_all(m, &s, s.map_at, maps);
}

enum rc_status
rc_model_restore(struct rc_model *m, const double *state, size_t n, bool *going, struct rc_err *err)
{
    struct rc_state s = {.mode = READS, .from = state, .n = n, .numbers = n};

    for (size_t k = 0; k < n; k++)
        if (isnan(state[k]))
            rc_state_refuse(&s, "it holds NaN");
    exchange_all(m, &s, 0, 0);
    if (!s.bad && (s.at != s.numbers || s.map_at != n || s.maps != s.all_maps))
        rc_state_refuse(&s, "it has more numbers than the model");
    *going = m->status == RC_MORE;
    return !s.bad ? RC_OK
                  : rc_err_set(err, "this is not a state of the %s model: %s", m->row->name, s.why);
}
