/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "waves.h"

#include <complex.h>

#include "libcontact/memory.h"
#include "libcontact/transform/fourier.h"

struct waves {
    struct rc_turn turn;
    struct rc_line *along_x, *along_y;
    double complex *pieces, *columns,
        *line;          /* pieces of rows, NULL for one process; columns held here;
                                                one row or column */
    double *part;       /* a column's real or imaginary part               */
    size_t first, wide; /* columns held here                               */
    struct rc_store own;
};

static void
waves_free(struct waves *w)
{
    rc_turn_free(&w->turn);
    rc_line_free(w->along_x);
    rc_line_free(w->along_y);
    rc_store_free(&w->own);
}

static enum rc_status
take_memory(struct waves *w, const struct rc_ranks *ranks, const struct rc_shape *s,
            struct rc_err *err)
{
    const size_t columns = rc_fourier_columns(s), most = columns > s->ny ? columns : s->ny;
    const size_t rows = rc_rows_of(ranks, s).n;

    w->wide = columns;
    if (ranks != NULL) {
        if (rc_turn_new(&w->turn, ranks, s->ny, rc_rows_unit(s->nx), 0, columns, sizeof *w->line,
                        err) != RC_OK)
            return RC_FAIL;
        w->first = w->turn.column[w->turn.own];
        w->wide = w->turn.column[w->turn.own + 1] - w->first;
        w->pieces = rc_store_take(&w->own, rows * columns, sizeof *w->pieces);
    }
    w->columns = rc_store_take(&w->own, w->wide * s->ny, sizeof *w->columns);
    w->line = rc_store_take(&w->own, 2 * most, sizeof *w->line);
    w->part = rc_store_take(&w->own, s->ny, sizeof *w->part);
    if (w->along_x != NULL && w->along_y != NULL && !w->own.failed)
        return RC_OK;
    return rc_err_set(err, "out of memory for the waves of %zu x %zu nodes", s->nx, s->ny);
}

/* The transforms of the rows, exchanged for whole columns. */
static void
find_columns(struct waves *w, const struct rc_ranks *ranks, const struct rc_shape *s,
             const double *v)
{
    const size_t rows = rc_rows_of(ranks, s).n;

    for (size_t j = 0; j < rows; j++) {
        double complex *to = ranks == NULL ? w->columns + j * w->wide : w->line;
        rc_line_forward(w->along_x, v + j * s->nx, to);
        if (ranks != NULL)
            rc_turn_put(&w->turn, j, to, w->pieces);
    }
    if (ranks != NULL)
        rc_ranks_turn(&w->turn, false, w->pieces, w->columns);
}

/* The waves of a column of complex numbers, from its two parts. */
static void
visit_column(struct waves *w, size_t ny, size_t here, rc_wave_visit *visit, void *ctx)
{
    double complex *re = w->line, *im = w->line + ny / 2 + 1;

    for (size_t j = 0; j < ny; j++)
        w->part[j] = creal(w->columns[j * w->wide + here]);
    rc_line_forward(w->along_y, w->part, re);
    for (size_t j = 0; j < ny; j++)
        w->part[j] = cimag(w->columns[j * w->wide + here]);
    rc_line_forward(w->along_y, w->part, im);
    for (size_t j = 0; j < ny; j++) {
        const size_t k = 2 * j <= ny ? j : ny - j;
        const double complex a = re[k], b = im[k];
        visit(ctx, w->first + here, j, k == j ? cabs(a + I * b) : cabs(conj(a) + I * conj(b)));
    }
}

enum rc_status
rc_waves_visit(const struct rc_ranks *ranks, const struct rc_shape *s, const double *v,
               rc_wave_visit *visit, void *ctx, struct rc_err *err)
{
    RC_ENDS(waves_free)
    struct waves w = {.along_x = rc_line_new(s->nx, 1, NULL),
                      .along_y = rc_line_new(s->ny, 1, NULL)};

    if (rc_ranks_agree(ranks, take_memory(&w, ranks, s, err), err) != RC_OK)
        return RC_FAIL;
    find_columns(&w, ranks, s, v);
    for (size_t i = 0; i < w.wide; i++)
        visit_column(&w, s->ny, i, visit, ctx);
    return RC_OK;
}
