/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Groups of rows of a table: with the same values in some columns, or with the same x.
 */
#include "render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- by column ---- */

struct place {
    double key[1 + GROUP_COLUMNS]; /* the piece, then the indices of the words */
    size_t row;
};

static int
compare_places(const void *one, const void *other)
{
    const struct place *a = one, *b = other;

    for (size_t k = 0; k < 1 + GROUP_COLUMNS; k++)
        if (a->key[k] != b->key[k])
            return a->key[k] < b->key[k] ? -1 : 1;
    return a->row < b->row ? -1 : 1;
}

static bool
same_group(const struct place *a, const struct place *b)
{
    return memcmp(a->key, b->key, sizeof a->key) == 0;
}

void
groups_sort(struct table *table, struct tool *t, const size_t *by, size_t n, bool pieces)
{
    RC_OWNED struct place *place = tool_room(t, table->rows, sizeof *place, "a table");
    RC_OWNED double *v = tool_room(t, table->rows, sizeof *v, "a table");
    size_t *piece = tool_room(t, table->rows, sizeof *piece, "a table"), now = 0;

    for (size_t k = 0; k < table->rows; k++) {
        while (now + 1 < table->pieces && table->piece[now + 1] <= k)
            now++;
        place[k] = (struct place){.row = k, .key = {pieces ? (double)now : 0}};
        for (size_t b = 0; b < n; b++) {
            double word = table->column[by[b]].v[k];

            place[k].key[1 + b] = isnan(word) ? INFINITY : word;
        }
    }
    qsort(place, table->rows, sizeof *place, compare_places);
    for (size_t c = 0; c < table->columns; c++) {
        memcpy(v, table->column[c].v, table->rows * sizeof *v);
        for (size_t k = 0; k < table->rows; k++)
            table->column[c].v[k] = v[place[k].row];
    }
    table->pieces = 0;
    for (size_t k = 0; k < table->rows; k++)
        if (k == 0 || !same_group(&place[k], &place[k - 1]))
            piece[table->pieces++] = k;
    free(table->piece);
    table->piece = piece;
}

/* ---- by x ---- */

void
spread_take(struct spread *s, struct tool *t, const double *x, const double *y, size_t n)
{
    const double shared = 1e-6; /* relative, of x: requested loads are met more accurately */
    double(*point)[2] = tool_room(t, n, sizeof *point, "the points of a curve");
    size_t points = 0, last;

    *s = (struct spread){.x = tool_room(t, 4 * n, sizeof *s->x, "the points of a curve"),
                         .least = SIZE_MAX};
    s->y = s->x + n;
    s->low = s->y + n;
    s->high = s->low + n;
    for (size_t k = 0; k < n; k++)
        if (isfinite(x[k]) && isfinite(y[k])) {
            point[points][0] = x[k];
            point[points++][1] = y[k];
        }
    qsort(point, points, sizeof *point, range_compare);
    for (size_t k = 0; k < points; k = last) {
        double sum[2] = {0, 0}, squares = 0, rows, deviation;

        for (last = k; last < points && point[last][0] - point[k][0] <= shared * fabs(point[k][0]);
             last++) {
            sum[0] += point[last][0];
            sum[1] += point[last][1];
        }
        rows = (double)(last - k);
        s->x[s->n] = sum[0] / rows;
        s->y[s->n] = sum[1] / rows;
        for (size_t i = k; i < last; i++)
            squares += pow(point[i][1] - s->y[s->n], 2);
        deviation = last - k > 1 ? sqrt(squares / (rows - 1)) : NAN;
        s->low[s->n] = s->y[s->n] - deviation;
        s->high[s->n] = s->y[s->n] + deviation;
        s->least = last - k < s->least ? last - k : s->least;
        s->most = last - k > s->most ? last - k : s->most;
        s->n++;
    }
    free(point);
}
