#include "extension.h"

#include <math.h>

/* Lower envelope of the parabolas f[k] + (step (i - k))^2 on one line of n values `stride` apart,
 * in place. v: places of the parabolas in the envelope; edge: where each begins. */
static void
envelope(double *f, size_t n, size_t stride, double step, double *v, double *edge, double *value)
{
    double s2 = step * step;
    size_t count = 0, at = 0;

    for (size_t i = 0; i < n; i++) {
        double x = (double)i, begin = -INFINITY;
        if (isinf(f[i * stride]))
            continue;
        while (count > 0) {
            double y = v[count - 1];
            begin = (f[i * stride] - value[count - 1] + s2 * (x * x - y * y)) / (2 * s2 * (x - y));
            if (begin > edge[count - 1])
                break;
            count--;
        }
        if (count == 0)
            begin = -INFINITY;
        v[count] = x;
        value[count] = f[i * stride];
        edge[count] = begin;
        count++;
    }
    for (size_t i = 0; i < n && count > 0; i++) {
        double x = (double)i;
        while (at + 1 < count && edge[at + 1] < x)
            at++;
        f[i * stride] = value[at] + s2 * (x - v[at]) * (x - v[at]);
    }
}

void
rc_distance_squared(const struct rc_shape *s, const unsigned char *w, double *scratch, double *d2)
{
    size_t longest = s->nx > s->ny ? s->nx : s->ny;
    double *v = scratch, *edge = v + longest, *value = edge + longest;

    for (size_t k = 0; k < s->nx * s->ny; k++)
        d2[k] = w[k] ? 0 : INFINITY;
    for (size_t j = 0; j < s->ny; j++)
        envelope(d2 + j * s->nx, s->nx, 1, s->dx, v, edge, value);
    for (size_t i = 0; i < s->nx; i++)
        envelope(d2 + i, s->ny, s->nx, s->dy, v, edge, value);
}
