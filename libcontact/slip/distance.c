/*
 * Exact distances to a set of nodes, in time proportional to the size of the map, after
 * Felzenszwalb and Huttenlocher (Theory of Computing 8, 2012).
 *
 * Along the columns: one sweep down and one up count the steps from every node to the nearest node
 * of the set in its column.
 *
 * Along a row: d^2 at column x is the least of f_k + (x - k)^2 over all columns k, where f_k is the
 * square of the distance along column k; lengths are in units of dx. These are parabolas of one
 * shape: any two cross once, and beyond the crossing the one whose apex is farther right is the
 * lower. Their lower envelope is therefore a list of parabolas with apexes from left to right, each
 * of them the lowest on one run of columns. The list is built from left to right: where a new
 * parabola is lower than the last of the list already on the first column of its run, the last is
 * dropped, and the new one is compared with the one before; otherwise the run of the new one begins
 * at the first column beyond their crossing.
 *
 * A periodic row is taken from a column with the least f to the next image of that column: as no f
 * is less, nothing outside is nearer to a column between these two than they are.
 *
 * A column whose f + 1 is not less than the f of either neighbour is the nearest one to no other
 * column: at the neighbour it is not better than the neighbour itself, and farther away still less
 * so. Such columns are most of those in and above patches of the set. They are left out of the
 * envelope, which saves a tenth to two thirds of the work, and every column is compared with its own
 * f at the end.
 *
 * Rounding: squares are in single precision, crossings in double. With dx = dy squares up to 2^24
 * are whole numbers and exact, that is, all distances up to 4096 steps: everywhere on periodic maps
 * up to 5792 x 5792 nodes and on free ones up to 2896 x 2896. Longer distances, which maps of 8192
 * nodes may hold, and those with dx and dy unequal have squares right to four parts in 2^23.
 */
#include "distance.h"

#include <math.h>

enum {
    STRIP = 512 /* columns counted together */
};
static const float far_away = 1e9f; /* steps: no node of the set in this column */

/* The columns [first, last), down and up, or one of these. */
struct columns {
    const struct rc_shape *s;
    const unsigned char *w;
    size_t first, last;
    float *steps;
};

/* Counts for each node the steps from the last node of the set above it; on a periodic map the column
 * above continues at its other end. */
static void
count_down(const struct columns *c, bool wrap, float *run)
{
    const struct rc_shape *s = c->s;
    size_t first = c->first, last = c->last;

    for (size_t i = first; i < last; i++)
        run[i - first] = far_away;
    for (size_t j = 0; wrap && j < s->ny; j++)
        for (size_t i = first; i < last; i++)
            run[i - first] = c->w[j * s->nx + i] ? 0 : run[i - first] + 1;
    for (size_t j = 0; j < s->ny; j++)
        for (size_t i = first; i < last; i++) {
            run[i - first] = c->w[j * s->nx + i] ? 0 : run[i - first] + 1;
            c->steps[j * s->nx + i] = run[i - first];
        }
}

static void
count_up(const struct columns *c, bool wrap, float *run)
{
    const struct rc_shape *s = c->s;
    size_t first = c->first, last = c->last;

    for (size_t i = first; i < last; i++)
        run[i - first] = far_away;
    for (size_t j = s->ny; wrap && j-- > 0;)
        for (size_t i = first; i < last; i++)
            run[i - first] = c->w[j * s->nx + i] ? 0 : run[i - first] + 1;
    for (size_t j = s->ny; j-- > 0;)
        for (size_t i = first; i < last; i++) {
            float *at = &c->steps[j * s->nx + i], up = run[i - first] + 1;
            *at = up < *at ? up : *at;
            run[i - first] = *at;
        }
}

void
rc_distance_columns(const struct rc_shape *s, enum rc_boundary boundary, const unsigned char *w,
                    int threads, float *steps)
{
    bool wrap = boundary == RC_PERIODIC;

#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t first = 0; first < s->nx; first += STRIP) {
        struct columns c = {.s = s,
                            .w = w,
                            .first = first,
                            .last = s->nx - first < STRIP ? s->nx : first + STRIP,
                            .steps = steps};
        float run[STRIP];

        count_down(&c, wrap, run);
        count_up(&c, wrap, run);
    }
}

/* A column of a row, and what it gives to the others. */
struct parabola {
    float f;
    int apex, first; /* its own column; the first one on which it is the lowest */
};

/* f of n columns that lie side by side. */
static void
square(size_t n, const float *steps, float aspect, float *restrict f)
{
    for (size_t k = 0; k < n; k++)
        f[k] = steps[k] >= far_away ? INFINITY : aspect * steps[k] * (aspect * steps[k]);
}

/* Lists those of n columns that may be the nearest to another one, and returns how many these are;
 * f has a number on either side. */
static size_t
candidates(size_t n, const float *f, struct parabola *list)
{
    size_t count = 0;

    for (size_t k = 0; k < n; k++) {
        list[count].f = f[k];
        list[count].apex = (int)k;
        count += f[k] + 1 < (f[k - 1] > f[k + 1] ? f[k - 1] : f[k + 1]);
    }
    return count;
}

/* Leaves in the list those that are the lowest on some of the columns 0 to n - 1, sets where each
 * begins to be, and returns how many these are. */
static size_t
envelope(size_t n, size_t count, struct parabola *list)
{
    size_t m = 0;

    for (size_t q = 0; q < count; q++) {
        struct parabola next = list[q];
        double first = 0;

        for (; m > 0; m--) {
            struct parabola last = list[m - 1];
            double apart = next.apex - last.apex;
            /* how far `next` is above it where its run begins; every column takes 2 apart off */
            double above =
                (double)next.f - last.f - apart * (2. * last.first - next.apex - last.apex);
            if (above >= 0) {
                first = last.first + 1 + above / (2 * apart);
                break;
            }
        }
        if (first < (double)n) {
            next.first = (int)first;
            list[m++] = next;
        }
    }
    return m;
}

/* f becomes d^2, in units of dx. */
static void
evaluate(size_t n, size_t m, const struct parabola *list, float *restrict f)
{
    for (size_t q = 0; q < m; q++) {
        int end = q + 1 < m ? list[q + 1].first : (int)n;
        for (int x = list[q].first; x < end; x++) {
            float d = (float)(x - list[q].apex), d2 = list[q].f + d * d;
            f[x] = d2 < f[x] ? d2 : f[x];
        }
    }
}

size_t
rc_distance_scratch(const struct rc_shape *s)
{
    size_t n = s->nx + 1; /* with the first column again */

    return n + 2 + n * (sizeof(struct parabola) / sizeof(float));
}

void
rc_distance_row(const struct rc_shape *s, enum rc_boundary boundary, float *scratch,
                const float *steps, float *d2)
{
    bool wrap = boundary == RC_PERIODIC;
    size_t n = s->nx, start = 0, ahead, m;
    float *f = scratch + 1, aspect = (float)(s->dy / s->dx), unit = (float)(s->dx * s->dx);
    struct parabola *list = (void *)(f + n + 2);

    for (size_t k = 1; wrap && k < n; k++)
        start = steps[k] < steps[start] ? k : start;
    ahead = n - start;
    square(ahead, steps + start, aspect, f);
    square(start + wrap, steps, aspect, f + ahead);
    f[-1] = f[n + wrap] = INFINITY;
    m = envelope(n, candidates(n + wrap, f, list), list);
    evaluate(n, m, list, f);
    for (size_t k = 0; k < ahead; k++)
        d2[start + k] = unit * f[k];
    for (size_t k = 0; k < start; k++)
        d2[k] = unit * f[ahead + k];
}
