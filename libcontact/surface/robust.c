/*
 * The median of a map, found by counting: numbers are ordered as their bits are, so a histogram of
 * the highest bits tells in which bin the middle one lies, one of the next 11 bits of those in that
 * bin is the second step, and after six steps all bits are known. Nothing is moved or copied.
 */
#include "robust.h"

#include <stdint.h>
#include <string.h>

enum {
    BITS = 11, /* that a step finds; the first one those above 55 */
    BINS = 1 << BITS,
    FIRST = 55
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

/* Counts, by the bits from `shift` on, the numbers whose higher bits are those of `prefix`. */
static void
count_bins(const struct values *of, uint64_t prefix, int shift, size_t *bins)
{
    memset(bins, 0, BINS * sizeof *bins);
#pragma omp parallel for num_threads(of->threads) reduction(+ : bins[:BINS])
    for (size_t k = 0; k < of->n; k++) {
        uint64_t key;
        if (isnan(of->v[k]))
            continue;
        key = key_of(of, of->v[k]);
        if (shift == FIRST || key >> (shift + BITS) == prefix)
            bins[key >> shift & (BINS - 1)]++;
    }
}

/* The key of rank `rank`, from 0; *after: how many keys are at most it. */
static uint64_t
select_key(const struct values *of, size_t rank, size_t *after)
{
    size_t bins[BINS];
    uint64_t prefix = 0;
    size_t below = 0;

    for (int shift = FIRST; shift >= 0; shift -= BITS) {
        uint64_t bin = 0;
        count_bins(of, prefix, shift, bins);
        while (below + bins[bin] <= rank)
            below += bins[bin++];
        prefix = prefix << BITS | bin;
        *after = below + bins[bin];
    }
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
    size_t count = 0, after = 0;
    double median = NAN;
    uint64_t lower;

#pragma omp parallel for num_threads(threads) reduction(+ : count)
    for (size_t k = 0; k < n; k++)
        count += isnan(v[k]) ? 0 : 1;
    if (count > 0) {
        lower = select_key(&of, (count - 1) / 2, &after);
        median = number_of(lower);
        if (count % 2 == 0 && after <= count / 2)
            median += 0.5 * (number_of(next_key(&of, lower)) - median);
    }
    return median;
}
