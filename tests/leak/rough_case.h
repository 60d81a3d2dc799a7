/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rough elastic contacts, the flow through their gaps, and its values on coarser grids. */
#ifndef ROUGH_CASE_H
#define ROUGH_CASE_H

#include "tests/contact_case.h"
#include "leak_case.h"

static const double rough_estar = 1e9, rough_slope = 0.1;

/* Waves from a quarter of the map down to this number of nodes. */
static inline double *
rough(struct rc_shape s, size_t shortest, uint64_t seed)
{
    const struct rc_selfaffine what = {.hurst = 0.8,
                                       .rms_slope = rough_slope,
                                       .rolloff = (double)s.nx / 4 * s.dx,
                                       .short_cut = (double)shortest * s.dx,
                                       .seed = seed};
    double *h = malloc(s.nx * s.ny * sizeof *h);

    assert_true(rc_synth_selfaffine(&s, &what, h, NULL) == RC_OK);
    return h;
}

/* The mean pressure is in units of E* times the slope. */
static inline struct solved
rough_press(struct rc_shape s, const double *h, double pressure)
{
    struct rc_problem problem = {.boundary = RC_PERIODIC,
                                 .pair.estar = rough_estar,
                                 .load = pressure * rough_estar * rough_slope *
                                         (double)(s.nx * s.ny) * s.dx * s.dy,
                                 .tol = 1e-4};
    struct solved found = solve(s, h, problem);

    assert_true(found.status == RC_OK);
    return found;
}

static inline double
rough_contact(struct rc_shape s, const struct solved *c)
{
    return (double)c->c.contact_nodes / (double)(s.nx * s.ny);
}

/* ---- the grid ---- */

/* The flow on a grid of every step-th node of an n x n map. step is odd, so that the coarse cells have the
 * same centres. */
static inline struct rc_leak_figures
rough_sampled(const struct solved *s, size_t fine, size_t step, char direction)
{
    size_t n = fine / step;
    struct rc_shape shape = {n, n, (double)step * 1e-6, (double)step * 1e-6};
    double *p = malloc(n * n * sizeof *p), *g = malloc(n * n * sizeof *g);
    struct rc_leak_figures f;

    for (size_t k = 0; k < n * n; k++) {
        size_t at = (k / n * step + step / 2) * fine + k % n * step + step / 2;
        p[k] = s->p[at];
        g[k] = s->gap[at];
    }
    f = leak_figures(shape, p, g, direction, true);
    free(p);
    free(g);
    return f;
}

struct rough_grid {
    double coarse[2], middle[2]; /* mean relative errors, of harmonic and linear faces     */
    double order[2];
    double estimate,
        between; /* the same on the coarse grid; the error of 0.4 harmonic + 0.6 linear    */
    size_t bracketed, covered;
};

static inline void
rough_beside(struct rough_grid *grid, const struct solved *c, size_t fine, size_t shortest,
             char direction, double weight)
{
    double truth, at[2][2];
    struct rc_leak_figures f[3];

    for (size_t k = 0, step = 9; k < 3; k++, step /= 3)
        f[k] = rough_sampled(c, fine, step, direction);
    truth = f[2].conductance + (f[2].conductance - f[1].conductance) / 8;
    for (size_t k = 0; k < 2; k++) {
        at[k][0] = f[k].conductance / truth - 1;
        at[k][1] = f[k].conductance_linear / truth - 1;
    }
    print_message("contact %.3f: %zu nodes %+.4f %+.4f, %zu nodes %+.4f %+.4f\n",
                  (double)c->c.contact_nodes / (double)(fine * fine), shortest / 9, at[0][0],
                  at[0][1], shortest / 3, at[1][0], at[1][1]);
    grid->bracketed += at[0][0] < 0 && at[0][1] > 0;
    grid->covered += fabs(at[0][0]) < 2 * f[0].error;
    for (int rule = 0; rule < 2; rule++) {
        grid->coarse[rule] += fabs(at[0][rule]) * weight;
        grid->middle[rule] += fabs(at[1][rule]) * weight;
    }
    grid->between += fabs(0.4 * at[0][0] + 0.6 * at[0][1]) * weight;
    grid->estimate += f[0].error * weight;
}

/* Compares grids of every 9th and every 3rd node with the full grid, extrapolated to the limit at second
 * order with harmonic faces only. So the reference does not depend on linear faces. Both directions, contact
 * fractions of 0.11 to 0.23. */
static inline struct rough_grid
rough_converges(size_t fine, size_t shortest, uint64_t seed, size_t seeds)
{
    const struct rc_shape s = {fine, fine, 1e-6, 1e-6};
    const double cases = 2 * (double)seeds;
    struct rough_grid grid = {0};

    for (size_t m = 0; m < seeds; m++) {
        double *h = rough(s, shortest, seed + m);
        struct solved c = rough_press(s, h, m % 2 == 0 ? 0.055 : 0.105);
        for (int way = 0; way < 2; way++)
            rough_beside(&grid, &c, fine, shortest, way == 0 ? 'x' : 'y', 1 / cases);
        solved_free(&c);
        free(h);
    }
    for (int rule = 0; rule < 2; rule++) {
        grid.order[rule] = log(grid.coarse[rule] / grid.middle[rule]) / log(3);
        print_message("%s: %.4f with %zu nodes in the shortest wave, %.4f with %zu: order %.2f\n",
                      rule == 0 ? "harmonic" : "linear", grid.coarse[rule], shortest / 9,
                      grid.middle[rule], shortest / 3, grid.order[rule]);
    }
    print_message(
        "bracketed %zu of %zu, within twice the estimate %zu; estimate %.4f, between %.4f\n",
        grid.bracketed, 2 * seeds, grid.covered, grid.estimate, grid.between);
    return grid;
}

/* ---- percolation ---- */

static inline bool
rough_open(struct rc_shape s, const struct solved *c, char direction)
{
    const struct rc_leak_options options = {.direction = direction, .around = true};
    struct rc_leak *leak = rc_leak_new(&s, c->p, c->gap, &options, NULL);
    bool through;

    assert_non_null(leak);
    through = rc_leak_result(leak)->percolates;
    rc_leak_free(leak);
    return through;
}

/* Closed: the flow is exactly 0. */
static inline void
rough_is_shut(struct rc_shape s, const struct solved *c, char direction)
{
    struct leak_flow flow = leak_flow(s, c->p, c->gap, direction, true);

    assert_true(!flow.f.percolates && flow.f.conductance == 0 && flow.f.upper == 0 &&
                flow.f.critical_gap == 0);
    for (size_t k = 0; k < s.nx * s.ny; k++)
        assert_true((flow.channel[k] == 1 && flow.flux[k] == 0) ||
                    (flow.channel[k] == 0 && isnan(flow.flux[k])));
    leak_flow_free(&flow);
}

#endif
