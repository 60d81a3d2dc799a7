#include "coarse.h"

struct rc_shape
coarse_shape(const struct rc_shape *f, unsigned factor)
{
    size_t nx = (f->nx + factor / 2) / factor, ny = (f->ny + factor / 2) / factor;

    if (nx == 0)
        nx = 1;
    if (ny == 0)
        ny = 1;
    return (struct rc_shape){nx, ny, f->dx * ((double)f->nx / (double)nx),
                             f->dy * ((double)f->ny / (double)ny)};
}

/* Cell i of m cells lies over the cells first .. last of n cells on the same length; it has
 * `part` of cell j, in units in which a cell of the m is n wide. */
static size_t
first(size_t i, size_t m, size_t n)
{
    return i * n / m;
}

static size_t
last(size_t i, size_t m, size_t n)
{
    return ((i + 1) * n + m - 1) / m - 1;
}

static size_t
part(size_t i, size_t m, size_t j, size_t n)
{
    size_t a = i * n > j * m ? i * n : j * m;
    size_t b = (i + 1) * n < (j + 1) * m ? (i + 1) * n : (j + 1) * m;

    return b - a;
}

/* Means over the cells of one grid of values that are constant in the cells of another. */
static void
means(const struct rc_shape *from, const double *v, const struct rc_shape *to, double *out)
{
    for (size_t j = 0; j < to->ny; j++)
        for (size_t i = 0; i < to->nx; i++) {
            double sum = 0;

            for (size_t l = first(j, to->ny, from->ny); l <= last(j, to->ny, from->ny); l++) {
                double row = 0;

                for (size_t k = first(i, to->nx, from->nx); k <= last(i, to->nx, from->nx); k++)
                    row += (double)part(i, to->nx, k, from->nx) * v[l * from->nx + k];
                sum += (double)part(j, to->ny, l, from->ny) * row;
            }
            out[j * to->nx + i] = sum / ((double)from->nx * (double)from->ny);
        }
}

void
coarse_means(const struct rc_shape *fine, const double *h, const struct rc_shape *coarse,
             double *to)
{
    means(fine, h, coarse, to);
}

void
coarse_spread(const struct rc_shape *coarse, const double *p, const struct rc_shape *fine,
              double *to)
{
    means(coarse, p, fine, to);
}
