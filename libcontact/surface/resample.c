/*
 * Means over the cells of another grid on the same area.
 *
 * Along a line of n m units the n cells of one grid are m units long, the m cells of the other n
 * units: all of them begin at whole units, and what two of them share is a whole number too.
 */
#include "libcontact/contact.h"

/* Where a cell begins: `rest` units after the start of cell `cell` of the other grid. */
struct edge {
    size_t cell, rest;
};

/* The edge a cell of n units further on, on a grid of cells of m units. */
static struct edge
next_edge(struct edge e, size_t n, size_t m)
{
    e.cell += n / m;
    e.rest += n % m;
    if (e.rest >= m) {
        e.rest -= m;
        e.cell++;
    }
    return e;
}

/* Adds `weight` times the integrals of a line of n values over the m cells of `out`, in units. */
static void
add_line(const double *v, size_t n, double weight, double *out, size_t m)
{
    struct edge a = {0, 0}, b;

    for (size_t i = 0; i < m; i++, a = b) {
        double sum;

        b = next_edge(a, n, m);
        if (a.cell == b.cell) {
            sum = (double)n * v[a.cell];
        } else {
            sum = (double)(m - a.rest) * v[a.cell];
            for (size_t k = a.cell + 1; k < b.cell; k++)
                sum += (double)m * v[k];
            if (b.rest > 0)
                sum += (double)b.rest * v[b.cell];
        }
        out[i] += weight * sum;
    }
}

void
rc_resample_means(const struct rc_shape *from, const double *v, const struct rc_shape *to,
                  double *out)
{
    double area = (double)from->nx * (double)from->ny;
    size_t nx = from->nx, ny = from->ny;
    struct edge a = {0, 0}, b;

    for (size_t j = 0; j < to->ny; j++, a = b) {
        double *line = out + j * to->nx;

        b = next_edge(a, ny, to->ny);
        for (size_t i = 0; i < to->nx; i++)
            line[i] = 0;
        for (size_t l = a.cell; l < b.cell || (l == b.cell && b.rest > 0); l++) {
            size_t first = l == a.cell ? a.rest : 0, last = l == b.cell ? b.rest : to->ny;

            add_line(v + l * nx, nx, (double)(last - first), line, to->nx);
        }
        for (size_t i = 0; i < to->nx; i++)
            line[i] /= area;
    }
}
