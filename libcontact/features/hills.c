/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Hills by watershed: a node belongs to the hill whose peak the steepest ascent over its eight neighbours
 * reaches. Of equal heights the first counts as higher, so that a plateau has one peak. Hills are numbered in
 * the order of the map, so that touching hills lie near each other in memory.
 */
#include "hills.h"

#include "libcontact/memory.h"

/* ---- ascents ---- */

static void
set_lengths(const struct rc_field *f, double length[RC_NEIGHBOURS])
{
    double dx = f->shape.dx, dy = f->shape.dy;

    for (int d = 0; d < RC_NEIGHBOURS; d++)
        length[d] = sqrt(dx * dx * rc_across[d] * rc_across[d] + dy * dy * rc_down[d] * rc_down[d]);
}

/* The direction of the steepest ascent from node k. */
static unsigned char
ascent(const struct rc_field *f, const double length[RC_NEIGHBOURS], size_t k)
{
    double most = -1;
    unsigned char best = RC_PEAK;

    for (int d = 0; d < RC_NEIGHBOURS && rc_there(f->h[k]); d++) {
        size_t m = rc_field_neighbour(f, k, d);
        double slope;

        if (m == SIZE_MAX || !rc_field_before(f, m, k))
            continue;
        slope = (rc_field_height(f, m) - rc_field_height(f, k)) / length[d];
        if (slope > most) {
            most = slope;
            best = (unsigned char)d;
        }
    }
    return rc_there(f->h[k]) ? best : RC_ABSENT;
}

enum {
    PIECE = 256 /* nodes of a row processed together */
};

/* The same for n nodes of a row from h on that have all neighbours; rows are nx apart. */
RC_CLONES static void
ascents(const double *h, ptrdiff_t nx, double sign, const double length[RC_NEIGHBOURS], size_t n,
        unsigned char *restrict mark)
{
    double most[PIECE], best[PIECE];

    for (size_t i = 0; i < n; i++) {
        most[i] = -1;
        best[i] = rc_there(h[i]) ? RC_PEAK : RC_ABSENT;
    }
    for (int d = 0; d < RC_NEIGHBOURS; d++) {
        const double *other = h + rc_down[d] * nx + rc_across[d], far = length[d];
        const bool first = d < RC_NEIGHBOURS / 2; /* the first of equal heights */

        for (size_t i = 0; i < n; i++) {
            double z = sign * h[i], up = sign * other[i], slope = (up - z) / far;
            bool above = (up > z) | ((up == z) & first);
            bool better = rc_there(h[i]) & rc_there(other[i]) & above & (slope > most[i]);
            most[i] = better ? slope : most[i];
            best[i] = better ? d : best[i];
        }
    }
    for (size_t i = 0; i < n; i++)
        mark[i] = (unsigned char)best[i];
}

static void
find_ascents(struct rc_field *f)
{
    size_t nx = f->shape.nx, ny = f->shape.ny;
    double length[RC_NEIGHBOURS];

    set_lengths(f, length);
#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t j = 0; j < ny; j++) {
        size_t row = j * nx;
        bool inside = j > 0 && j + 1 < ny;
        for (size_t i = 0; i < nx; i += inside ? nx - 1 : 1)
            f->mark[row + i] = ascent(f, length, row + i) | RC_BORDER;
        for (size_t i = 1; i + 1 < nx && inside; i += PIECE)
            ascents(f->h + row + i, (ptrdiff_t)nx, f->sign, length,
                    nx - 1 - i < PIECE ? nx - 1 - i : PIECE, f->mark + row + i);
    }
}

/* ---- hills ---- */

static bool
is_peak(const struct rc_field *f, size_t k)
{
    return (f->mark[k] & RC_ASCENT) == RC_PEAK;
}

/* A hill for each peak, in the order of the map; other nodes do not belong to a hill yet. */
static enum rc_status
number_peaks(struct rc_field *f, struct rc_hills *s)
{
    size_t first[RC_BANDS + 1] = {0}, bands = rc_field_bands(f);

#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t band = 0; band < bands; band++) {
        size_t peaks = 0;
        for (size_t k = rc_field_band(f, band); k < rc_field_band(f, band + 1); k++)
            peaks += is_peak(f, k) ? 1 : 0;
        first[band + 1] = peaks;
    }
    for (size_t band = 0; band < bands; band++)
        first[band + 1] += first[band];
    s->n = first[bands];
    if (s->n >= RC_NO_HILL || (s->hill = rc_alloc(s->n, sizeof *s->hill)) == NULL)
        return RC_FAIL;
#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t band = 0; band < bands; band++)
        for (size_t k = rc_field_band(f, band), a = first[band]; k < rc_field_band(f, band + 1);
             k++) {
            f->hill[k] = RC_NO_HILL;
            if (!is_peak(f, k))
                continue;
            s->hill[a] = (struct rc_hill){.top = rc_field_height(f, k),
                                          .peak = k,
                                          .joined = (uint32_t)a,
                                          .goes = (uint32_t)a};
            f->hill[k] = (uint32_t)a++;
        }
    return RC_OK;
}

/* Assigns every node to the hill of the peak that its ascent reaches. Of other bands only the peaks are read,
 * which do not change. */
static void
climb(struct rc_field *f)
{
#pragma omp parallel for num_threads(f->threads) schedule(dynamic)
    for (size_t band = 0; band < rc_field_bands(f); band++) {
        const size_t start = rc_field_band(f, band), size = rc_field_band(f, band + 1) - start;
        for (size_t k = start; k < start + size; k++) {
            size_t m = k;
            uint32_t hill;
            if ((f->mark[k] & RC_ASCENT) == RC_ABSENT)
                continue;
            while (m - start < size ? f->hill[m] == RC_NO_HILL : !is_peak(f, m))
                m = rc_field_beside(f, m, f->mark[m] & RC_ASCENT);
            hill = f->hill[m];
            for (m = k; m - start < size && f->hill[m] == RC_NO_HILL;) {
                size_t next = rc_field_beside(f, m, f->mark[m] & RC_ASCENT);
                f->hill[m] = hill;
                m = next;
            }
        }
    }
}

enum rc_status
rc_hills_find(struct rc_field *f, struct rc_hills *s)
{
    find_ascents(f);
    if (number_peaks(f, s) != RC_OK)
        return RC_FAIL;
    climb(f);
    return RC_OK;
}
