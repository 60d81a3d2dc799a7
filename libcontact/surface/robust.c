/*
 * The median of a map, found by counting: numbers are ordered as their bits are, so a histogram of
 * the highest bits tells in which bin the median lies; the second step is a histogram of the next
 * bits over the numbers in that bin. When only a small part of all numbers is left in the bin, they
 * are sorted.
 */
#include "robust.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Bits that are still unknown after each step. */
static const int shifts[] = {53, 42, 31, 20, 9, 0};
/* The key of no number, only of a NaN. */
static const uint64_t unknown = UINT64_MAX;

enum {
    STEPS = sizeof shifts / sizeof *shifts,
    BINS = 1 << 11, /* at most, of a step */
    PART = 64,      /* that is small enough to be sorted */
};

struct values {
    const double *v;
    size_t n;
    double about;
    bool magnitude;
    int threads;
};

/* Bits that stand in the order of the numbers. */
static inline uint64_t
key_of(const struct values *of, double v)
{
    const uint64_t sign = UINT64_C(1) << 63;
    double d = v - of->about;
    uint64_t bits;

    d = of->magnitude ? fabs(d) : d + 0.0; /* -0 is 0 */
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

/* Counts, by the bits that step k finds, the numbers whose higher bits are those of `prefix`. */
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
        key = key_of(of, of->v[i]);
        if (k == 0 || key >> above == prefix)
            bins[key >> shift & mask]++;
    }
}

static int
by_size(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;

    return x < y ? -1 : x > y;
}

/* The keys with this prefix, count of them, sorted; NULL when memory is short. */
static uint64_t *
sort_bin(const struct values *of, uint64_t prefix, int shift, size_t count)
{
    uint64_t *keys = malloc(count * sizeof *keys);
    size_t used = 0;

    if (keys == NULL)
        return NULL;
#pragma omp parallel for num_threads(of->threads)
    for (size_t i = 0; i < of->n; i++) {
        uint64_t key = key_of(of, of->v[i]);
        size_t at;
        if (isnan(of->v[i]) || key >> shift != prefix)
            continue;
#pragma omp atomic capture
        at = used++;
        keys[at] = key;
    }
    qsort(keys, count, sizeof *keys, by_size);
    return keys;
}

/* The key in the middle of *count, of an even number of them the lower one; *upper then becomes the
 * other one where that is found on the way, else `unknown`. */
static uint64_t
middle_key(const struct values *of, size_t *count, uint64_t *upper)
{
    size_t bins[BINS], below = 0, rank = 0, bin = 0;
    uint64_t prefix = 0, *sorted;

    *count = 0;
    *upper = unknown;
    for (size_t k = 0; k < STEPS; k++) {
        count_bins(of, prefix, k, bins);
        for (size_t b = 0; k == 0 && b < BINS; b++)
            *count += bins[b];
        if (*count == 0)
            return 0;
        rank = (*count - 1) / 2;
        for (bin = 0; below + bins[bin] <= rank; bin++)
            below += bins[bin];
        prefix = (k == 0 ? 0 : prefix << (shifts[k - 1] - shifts[k])) | bin;
        if (bins[bin] > *count / PART || k + 1 == STEPS)
            continue;
        if ((sorted = sort_bin(of, prefix, shifts[k], bins[bin])) == NULL)
            continue;
        prefix = sorted[rank - below];
        if (rank - below + 1 < bins[bin])
            *upper = sorted[rank - below + 1];
        free(sorted);
        return prefix;
    }
    if (rank - below + 1 < bins[bin])
        *upper = prefix;
    return prefix;
}

/* The smallest key above this one. */
static uint64_t
next_key(const struct values *of, uint64_t key)
{
    uint64_t next = UINT64_MAX;

#pragma omp parallel for num_threads(of->threads) reduction(min : next)
    for (size_t k = 0; k < of->n; k++)
        if (!isnan(of->v[k])) {
            uint64_t other = key_of(of, of->v[k]);
            next = other > key && other < next ? other : next;
        }
    return next;
}

double
rc_median(const double *v, size_t n, double about, bool magnitude, int threads)
{
    const struct values of = {v, n, about, magnitude, threads};
    size_t count;
    uint64_t upper, lower = middle_key(&of, &count, &upper);
    double median = count == 0 ? NAN : number_of(lower);

    if (count == 0 || count % 2 == 1)
        return median;
    if (upper == unknown)
        upper = next_key(&of, lower);
    median += 0.5 * (number_of(upper) - median);
    return median;
}
