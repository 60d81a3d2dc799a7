/*
 * The load is kept exactly while 0 <= p <= H: the constraint that scaling alone breaks.
 */
#include "solver.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Factor f with sum over the elastic nodes of min(f p, H) = target. A node that reaches the bound
 * at one factor stays there at every larger one, so each round fixes some and the rest is linear. */
static void
scale_elastic(size_t n, double hardness, double target, double *p)
{
    for (;;) {
        double free_sum = 0, error = 0, f;
        bool capped = false;

        for (size_t k = 0; k < n; k++)
            if (p[k] > 0 && p[k] < hardness) {
                double y = p[k] - error, t = free_sum + y; /* Kahan */
                error = (t - free_sum) - y;
                free_sum = t;
            }
        if (!(free_sum > 0))
            return;
        f = target / free_sum;
        for (size_t k = 0; k < n && f > 1; k++)
            if (p[k] > 0 && p[k] < hardness && f * p[k] >= hardness) {
                p[k] = hardness;
                target -= hardness;
                capped = true;
            }
        if (capped)
            continue;
        for (size_t k = 0; k < n; k++)
            if (p[k] > 0 && p[k] < hardness)
                p[k] *= f;
        return;
    }
}

struct candidate {
    double g;
    size_t k;
};

static int
by_gap(const void *a, const void *b)
{
    const struct candidate *x = a, *y = b;

    if (x->g != y->g)
        return x->g < y->g ? -1 : 1;
    return x->k < y->k ? -1 : 1;
}

/* All loaded nodes, if any, are at the bound and `rest` is still missing: nodes join by their gap. */
static enum rc_status
add_nodes(size_t n, double hardness, double rest, const double *g, double *p, struct rc_err *err)
{
    struct candidate *list = NULL;
    size_t count = 0, c = 0;

    for (size_t k = 0; k < n; k++)
        count += p[k] <= 0;
    list = malloc((count + 1) * sizeof *list);
    if (list == NULL)
        return rc_err_set(err, "out of memory for %zu nodes", count);
    for (size_t k = 0; k < n; k++)
        if (p[k] <= 0)
            list[c++] = (struct candidate){.g = g[k], .k = k};
    qsort(list, count, sizeof *list, by_gap);
    for (c = 0; c < count && rest > (isinf(hardness) ? 0 : 4 * DBL_EPSILON * hardness); c++) {
        p[list[c].k] = rest < hardness ? rest : hardness;
        rest -= p[list[c].k];
    }
    free(list);
    return RC_OK;
}

/* The nodes at the bound carry too much by themselves. */
static void
scale_all(size_t n, double sum, double *p)
{
    double f = sum / rc_sum(p, n);

    for (size_t k = 0; k < n; k++)
        p[k] *= f;
}

enum rc_status
rc_box_balance(size_t n, double hardness, double sum, const double *g, double *p,
               struct rc_err *err)
{
    size_t elastic = 0, full = 0;
    double target;

    for (size_t k = 0; k < n; k++) {
        elastic += p[k] > 0 && p[k] < hardness;
        full += p[k] >= hardness;
    }
    target = full == 0 ? sum : sum - hardness * (double)full;
    if (elastic == 0 && fabs(target) <= 4 * DBL_EPSILON * sum)
        return RC_OK; /* every loaded node at the bound, and that is the load */
    if (elastic > 0 && target > 0 && target <= hardness * (double)elastic) {
        scale_elastic(n, hardness, target, p);
        return RC_OK;
    }
    if (elastic + full == 0 || target > hardness * (double)elastic) {
        for (size_t k = 0; k < n; k++)
            if (p[k] > 0)
                p[k] = hardness;
        return add_nodes(n, hardness,
                         elastic + full == 0 ? sum : sum - hardness * (double)(elastic + full), g,
                         p, err);
    }
    scale_all(n, sum, p);
    return RC_OK;
}

/* phi(mu) = sum clip(y + mu, 0, H) - S is monotone and piecewise linear: Newton's method inside a
 * bracket that shrinks, halved where Newton leaves it. */
void
rc_box_project(size_t n, const unsigned char *w, double hardness, double sum, double *y)
{
    double least = INFINITY, most = -INFINITY, low, high, mu;
    size_t count = 0;

    for (size_t k = 0; k < n; k++)
        if (w == NULL || w[k]) {
            least = fmin(least, y[k]);
            most = fmax(most, y[k]);
            count++;
        }
    low = -most; /* nothing above 0 */
    high = isinf(hardness) ? sum / (double)count - least : hardness - least;
    mu = fmin(fmax(0, low), high);
    for (int round = 0; round < 200; round++) {
        double phi = -sum, slope = 0, next;
        for (size_t k = 0; k < n; k++) {
            double v = y[k] + mu;
            if (w != NULL && !w[k])
                continue;
            phi += fmin(fmax(v, 0), hardness);
            slope += v > 0 && v < hardness;
        }
        if (fabs(phi) <= 4 * DBL_EPSILON * sum)
            break;
        if (phi > 0)
            high = mu;
        else
            low = mu;
        next = mu - phi / slope;
        if (!(next > low && next < high))
            next = (low + high) / 2;
        if (next == mu)
            break;
        mu = next;
    }
    for (size_t k = 0; k < n; k++)
        if (w == NULL || w[k])
            y[k] = fmin(fmax(y[k] + mu, 0), hardness);
}
