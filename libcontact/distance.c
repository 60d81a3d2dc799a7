#include "extension.h"

#include <math.h>
#include <omp.h>

enum {
    COLUMNS = 8 /* taken out together: a cache line of each row */
};

/* Lower envelope of the parabolas f[k] + (step (i - k))^2 on one line of n values, in place. v: places
 * of the parabolas in the envelope; edge: where each begins; value: their heights. */
static void
envelope(double *f, size_t n, double step, double *v, double *edge, double *value)
{
    double s2 = step * step;
    size_t count = 0, at = 0;

    for (size_t i = 0; i < n; i++) {
        double x = (double)i, begin = -INFINITY;
        if (isinf(f[i]))
            continue;
        while (count > 0) {
            double y = v[count - 1];
            begin = (f[i] - value[count - 1] + s2 * (x * x - y * y)) / (2 * s2 * (x - y));
            if (begin > edge[count - 1])
                break;
            count--;
        }
        if (count == 0)
            begin = -INFINITY;
        v[count] = x;
        value[count] = f[i];
        edge[count] = begin;
        count++;
    }
    for (size_t i = 0; i < n && count > 0; i++) {
        double x = (double)i;
        while (at + 1 < count && edge[at + 1] < x)
            at++;
        f[i] = value[at] + s2 * (x - v[at]) * (x - v[at]);
    }
}

size_t
rc_distance_scratch(const struct rc_shape *s, int threads)
{
    size_t longest = s->nx > s->ny ? s->nx : s->ny;

    return (size_t)threads * (3 * longest + COLUMNS * s->ny);
}

static void
columns(const struct rc_shape *s, size_t first, size_t n, double *line, double *v, double *edge,
        double *value, double *d2)
{
    for (size_t j = 0; j < s->ny; j++)
        for (size_t b = 0; b < n; b++)
            line[b * s->ny + j] = d2[j * s->nx + first + b];
    for (size_t b = 0; b < n; b++)
        envelope(line + b * s->ny, s->ny, s->dy, v, edge, value);
    for (size_t j = 0; j < s->ny; j++)
        for (size_t b = 0; b < n; b++)
            d2[j * s->nx + first + b] = line[b * s->ny + j];
}

void
rc_distance_squared(const struct rc_shape *s, const unsigned char *w, int threads, double *scratch,
                    double *d2)
{
    size_t longest = s->nx > s->ny ? s->nx : s->ny, own = rc_distance_scratch(s, 1);

#pragma omp parallel num_threads(threads)
    {
        double *v = scratch + (size_t)omp_get_thread_num() * own, *edge = v + longest;
        double *value = edge + longest, *line = value + longest;

#pragma omp for schedule(static)
        for (size_t j = 0; j < s->ny; j++) {
            double *row = d2 + j * s->nx;
            for (size_t i = 0; i < s->nx; i++)
                row[i] = w[j * s->nx + i] ? 0 : INFINITY;
            envelope(row, s->nx, s->dx, v, edge, value);
        }
#pragma omp for schedule(static)
        for (size_t i = 0; i < s->nx; i += COLUMNS)
            columns(s, i, s->nx - i < COLUMNS ? s->nx - i : COLUMNS, line, v, edge, value, d2);
    }
}
