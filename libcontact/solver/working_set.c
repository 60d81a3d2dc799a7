/*
 * Which nodes at a bound join the working set.
 *
 * One that penetrates the other body (p = 0 and g < 0; the like at the hardness) need not want to:
 * next to an edge of contact that is about to be pressed less, it overlaps a little, and once its
 * neighbours are in touch it would have to pull. Were it to join, the preconditioner would count on
 * that pull, which the bound then takes away, and the step would be too long: at 2048 x 2048 and 50
 * % contact that doubled the number of steps.
 *
 * What the set would load it with is z = A r, A = (-Laplace)^(1/2) E* / 2 the inverse of the
 * half-space, r the residual extended smoothly: (A r)_i ~ sum_j (r_i - r_j) / |x_i - x_j|^3. The
 * sum falls off so fast that its sign can be told from the eight neighbours. A node joins unless
 * that sign is the wrong one; one without neighbours in the set always does, and so do all as the
 * residual of their neighbours goes to 0. The estimate that is believed at last is made with all of
 * them.
 */
#include "solver.h"

#include <math.h>
#include <string.h>

#include "working_set.h"

struct sift {
    struct rc_solver *s;
    float weight[3][3]; /* |x|^(-3) */
};

/* sum_j (r_k - r_j) / |x|^3 over the neighbours of k = j nx + i that are in the set. */
static float
pull(const struct sift *c, size_t i, size_t j)
{
    const struct rc_solver *s = c->s;
    size_t nx = s->shape.nx, ny = s->shape.ny;
    bool round = s->boundary == RC_PERIODIC;
    float own = s->r[j * nx + i], sum = 0;

    for (size_t b = 0; b < 3; b++) {
        size_t y = j + b; /* one more than the row */
        if ((y == 0 || y > ny) && !round)
            continue;
        y = y == 0 ? ny - 1 : y > ny ? 0 : y - 1;
        for (size_t a = 0; a < 3; a++) {
            size_t x = i + a, k;
            if ((x == 0 || x > nx) && !round)
                continue;
            x = x == 0 ? nx - 1 : x > nx ? 0 : x - 1;
            k = y * nx + x;
            sum += s->w[k] != 0 ? c->weight[b][a] * (own - s->r[k]) : 0;
        }
    }
    return sum;
}

/* First of the nodes from k on that wants to join, or end. */
static size_t
next(const unsigned char *w, size_t k, size_t end)
{
    static const uint64_t wants = UINT64_C(0x0101010101010101) * RC_WANTS;
    uint64_t eight;

    for (; k + 8 <= end; k += 8) {
        memcpy(&eight, w + k, sizeof eight);
        if ((eight & wants) != 0)
            break;
    }
    while (k < end && (w[k] & RC_WANTS) == 0)
        k++;
    return k;
}

/* Leaves in z whether a node that wants to is to join: it is at p = 0 with r > 0, or at the
 * hardness with r < 0. */
static void
decide(const struct sift *c)
{
    struct rc_solver *s = c->s;
    size_t nx = s->shape.nx;

#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (size_t j = 0; j < s->shape.ny; j++)
        for (size_t k = next(s->w, j * nx, (j + 1) * nx); k < (j + 1) * nx;
             k = next(s->w, k + 1, (j + 1) * nx)) {
            float f = pull(c, k - j * nx, j);
            s->z[k] = (s->p[k] > 0 ? -f : f) < 0 ? 0 : 1;
        }
}

/* What moves a node by 1 while the others around it stay where they are: the mean of |q|/2 over
 * the wave numbers of a square grid, on cells of unit area for E* = 1. */
static const double stiffness = 1.2;

enum { /* sums */
    RESIDUAL,
    OUT,
    CHANGED,
    SIZE
};

static void
settle_block(void *at, size_t first, size_t n, double *sums)
{
    struct rc_solver *s = at;

    for (size_t k = next(s->w, first, first + n); k < first + n; k = next(s->w, k + 1, first + n)) {
        bool was = (s->w[k] & RC_WAS) != 0, in = s->z[k] > 0;
        s->w[k] = in;
        if (in)
            continue;
        sums[RESIDUAL] += (double)s->r[k];
        sums[OUT]++;
        sums[SIZE] += fabs((double)s->r[k]);
        sums[CHANGED] += was ? 1 : -1; /* they were counted as if they had joined */
        s->r[k] = 0;
    }
}

void
rc_working_set_sift(struct rc_solver *s, double *sum, double *count, double *changed)
{
    double unit = sqrt(s->shape.dx * s->shape.dy), total[RC_SUMS];
    struct sift c = {.s = s};

    for (int b = -1; b <= 1; b++)
        for (int a = -1; a <= 1; a++) {
            double r = hypot(a * (s->shape.dx / unit), b * (s->shape.dy / unit));
            c.weight[b + 1][a + 1] = r > 0 ? (float)(1 / (r * r * r)) : 0;
        }
    decide(&c);
    rc_solver_blocks(s, settle_block, s, total);
    *sum -= total[RESIDUAL];
    *count -= total[OUT];
    *changed += total[CHANGED];
    s->aside = stiffness * total[SIZE];
}
