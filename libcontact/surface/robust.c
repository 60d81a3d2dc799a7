/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The median of a map. For a large map a sample gives two numbers between which the median lies almost
 * surely. One pass counts the numbers below and keeps the few between them (Floyd and Rivest 1975, Commun.
 * ACM 18, 165). If the sample was wrong, all numbers are kept.
 *
 * The median of the kept numbers is found by counting. The bits of numbers sort like the numbers, so a
 * histogram of the highest bits gives the bin of the median. The next steps are histograms of the next bits
 * over the numbers in that bin, down to the last bit.
 */
#include "robust.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/common.h"

/* Bits that are still unknown after each step. */
static const int shifts[] = {53, 42, 31, 20, 9, 0};

enum {
    STEPS = sizeof shifts / sizeof *shifts,
    BINS = 1 << 11, /* largest number, of a step */
    SAMPLE = 1 << 15,
    LARGE = 32 * SAMPLE, /* numbers from which a sample is used */
    NEAR = 32,           /* fraction of the numbers that may lie near the median: 1/NEAR */
    PIECE = 1024         /* numbers processed together */
};

struct values {
    const double *v;
    size_t n;
    double about;
    bool magnitude;
    int threads;
};

static inline double
number_at(const struct values *of, size_t k)
{
    double d = of->v[k] - of->about;

    return of->magnitude ? fabs(d) : d + 0.0; /* -0 is 0 */
}

/* Bits that sort like the numbers. */
static inline uint64_t
key_of(double d)
{
    const uint64_t sign = UINT64_C(1) << 63;
    uint64_t bits;

    memcpy(&bits, &d, sizeof bits);
    return bits & sign ? ~bits : bits | sign;
}

static double
number_of(uint64_t key)
{
    const uint64_t sign = UINT64_C(1) << 63;
    uint64_t bits = key & sign ? key & ~sign : ~key;
    double d;

    memcpy(&d, &bits, sizeof d);
    return d;
}

/* Counts, by the bits of step k, the numbers whose higher bits equal `prefix`. */
static void
count_bins(const struct values *of, uint64_t prefix, size_t k, size_t *bins)
{
    int shift = shifts[k], above = k == 0 ? 63 : shifts[k - 1];
    uint64_t mask = BINS - 1;

    if (k > 0)
        mask = (UINT64_C(1) << (above - shift)) - 1;
    memset(bins, 0, BINS * sizeof *bins);
#pragma omp parallel for num_threads(of->threads) reduction(+ : bins[:BINS])
    for (size_t i = 0; i < of->n; i++) {
        uint64_t key;
        if (isnan(of->v[i]))
            continue;
        key = key_of(number_at(of, i));
        if (k == 0 || key >> above == prefix)
            bins[key >> shift & mask]++;
    }
}

/* The key with `rank` keys below it. repeats: the next one is equal. */
static uint64_t
key_at(const struct values *of, size_t rank, bool *repeats)
{
    size_t bins[BINS], below = 0, bin = 0;
    uint64_t prefix = 0;

    for (size_t k = 0; k < STEPS; k++) {
        count_bins(of, prefix, k, bins);
        for (bin = 0; below + bins[bin] <= rank; bin++)
            below += bins[bin];
        prefix = (k == 0 ? 0 : prefix << (shifts[k - 1] - shifts[k])) | bin;
    }
    *repeats = rank - below + 1 < bins[bin];
    return prefix;
}

/* The next larger key. */
static uint64_t
next_key(const struct values *of, uint64_t key)
{
    uint64_t next = UINT64_MAX;

#pragma omp parallel for num_threads(of->threads) reduction(min : next)
    for (size_t k = 0; k < of->n; k++)
        if (!isnan(of->v[k])) {
            uint64_t other = key_of(number_at(of, k));
            next = other > key && other < next ? other : next;
        }
    return next;
}

/* ---- numbers near the median ---- */

static size_t
count_there(const struct values *of)
{
    size_t count = 0;

#pragma omp parallel for num_threads(of->threads) reduction(+ : count)
    for (size_t k = 0; k < of->n; k++)
        count += isnan(of->v[k]) ? 0 : 1;
    return count;
}

static int
by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return x < y ? -1 : x > y;
}

/* Bounds below and above the median, four standard deviations of a sample's median away; false when the
 * sample is too small. */
static bool
guess(const struct values *of, double *sample, double bounds[2])
{
    const uint64_t golden =
        UINT64_C(0x9E3779B97F4A7C15); /* a share of 2^64: these places fill the map evenly */
    size_t n = 0, off;

    for (uint64_t k = 0; k < SAMPLE; k++) {
        double part = (double)(k * golden >> 11) * 0x1p-53;
        sample[n] = number_at(of, (size_t)(part * (double)of->n));
        n += isnan(sample[n]) ? 0 : 1;
    }
    if (n < SAMPLE / 2)
        return false;
    qsort(sample, n, sizeof *sample, by_value);
    off = (size_t)(2 * sqrt((double)n));
    bounds[0] = sample[n / 2 - off];
    bounds[1] = sample[n / 2 + off];
    return true;
}

/* Numbers of a piece. */
struct counts {
    size_t there, below, inside;
};

RC_CLONES static struct counts
take_piece(const struct values *of, size_t first, size_t n, const double bounds[2],
           double *restrict inside)
{
    const double low = bounds[0], high = bounds[1], about = of->about;
    const bool magnitude = of->magnitude;
    double there = 0, below = 0, d[PIECE];
    size_t kept = 0;

    for (size_t i = 0; i < n; i++)
        d[i] = of->v[first + i] - about;
    for (size_t i = 0; i < n && magnitude; i++)
        d[i] = fabs(d[i]);
#pragma omp simd reduction(+ : there, below)
    for (size_t i = 0; i < n; i++) {
        there += d[i] == d[i] ? 1 : 0;
        below += d[i] < low ? 1 : 0;
    }
    for (size_t i = 0; i < n; i++) {
        inside[kept] = d[i];
        kept += (d[i] >= low) & (d[i] <= high);
    }
    return (struct counts){(size_t)there, (size_t)below, kept};
}

/* Counts the measured numbers and those below the bounds, and keeps those within, at most `room`. */
static struct counts
keep_inside(const struct values *of, const double bounds[2], size_t room, double *kept)
{
    size_t there = 0, below = 0, used = 0;

#pragma omp parallel for num_threads(of->threads) reduction(+ : there, below)
    for (size_t k = 0; k < of->n; k += PIECE) {
        double inside[PIECE];
        struct counts c = take_piece(of, k, of->n - k < PIECE ? of->n - k : PIECE, bounds, inside);
        size_t at;
#pragma omp atomic capture
        {
            at = used;
            used += c.inside;
        }
        if (at + c.inside <= room)
            memcpy(kept + at, inside, c.inside * sizeof *kept);
        there += c.there;
        below += c.below;
    }
    return (struct counts){there, below, used};
}

/* Sets *near to the numbers near the median, which are in the returned array; or to all numbers if it returns
 * NULL. *count becomes the number of all, *rank the number of entries of *near below the median. */
static double *
narrow(const struct values *of, struct values *near, size_t *count, size_t *rank)
{
    size_t room = of->n / NEAR;
    double bounds[2], *kept = of->n < LARGE ? NULL : malloc(room * sizeof *kept);

    if (kept != NULL && guess(of, kept, bounds)) {
        struct counts c = keep_inside(of, bounds, room, kept);
        size_t middle = (c.there - 1) / 2;
        if (c.inside <= room && c.below <= middle && middle + 1 < c.below + c.inside) {
            *near = (struct values){kept, c.inside, 0, false, 1};
            *count = c.there;
            *rank = middle - c.below;
            return kept;
        }
    }
    free(kept);
    *near = *of;
    *count = count_there(of);
    *rank = *count > 0 ? (*count - 1) / 2 : 0;
    return NULL;
}

double
rc_median(const double *v, size_t n, double about, bool magnitude, int threads)
{
    const struct values of = {v, n, about, magnitude, threads};
    struct values near;
    size_t count, rank;
    RC_OWNED double *kept = narrow(&of, &near, &count, &rank);
    double median = NAN;
    bool repeats;

    if (count > 0) {
        uint64_t lower = key_at(&near, rank, &repeats);
        median = number_of(lower);
        if (count % 2 == 0 && !repeats)
            median += 0.5 * (number_of(next_key(&near, lower)) - median);
    }
    return median;
}
