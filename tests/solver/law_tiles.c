/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Moves of the working set in any direction. The load does not change, pressures stay within the bounds, and
 * nodes outside of the set do not change. The report of the move is true. With tiles, each tile keeps the
 * load of the unclipped step if it can carry it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "libcontact/solver/solver.h"
#include "tests/contact_case.h"

enum {
    TILE = 16 /* nodes a side */
};

struct row {
    size_t nx, ny;
    double hardness; /* over the mean pressure; INFINITY: none */
    double part;     /* fraction of the nodes that are loaded */
    double size;     /* size of the step, over the mean pressure */
};

static double
uniform(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) / 9007199254740992.0;
}

static const struct row rows[] = {
    {64, 64, INFINITY, 0.4, 0.1}, {64, 64, INFINITY, 0.4, 5}, {70, 33, INFINITY, 0.05, 2},
    {64, 64, 4, 0.4, 0.5},        {100, 37, 3, 0.5, 10},      {200, 1, 30, 0.1, 3},
    {5, 7, INFINITY, 0.6, 1},     {48, 48, 1.05, 0.97, 0.5},
};

struct set_up {
    struct rc_solver *solver;
    double *before;
    float *d, *delta;
    struct rc_tile *tiles;
    double alpha, mean;
};

/* A pressure with the load, a working set of all elastic nodes and half of the others, and a direction on
 * it. */
static struct set_up
set_up(const struct row *row)
{
    struct rc_shape shape = {row->nx, row->ny, 1e-6, 1e-6};
    size_t n = row->nx * row->ny;
    double *h = calloc(n, sizeof *h), load = 1e9 * (double)n * 1e-12, sum = 0, moved = 0;
    struct rc_problem problem = {.pair.estar = 1e11,
                                 .load = load,
                                 .tol = 1e-6,
                                 .hardness = isinf(row->hardness) ? 0 : row->hardness * 1e9};
    struct set_up s = {.before = calloc(n, sizeof *s.before),
                       .d = calloc(n, sizeof *s.d),
                       .delta = calloc(n, sizeof *s.delta),
                       .tiles = calloc(rc_tiles(&shape), sizeof *s.tiles)};
    uint64_t seed = 7;
    struct rc_err err;
    double *p;

    for (size_t k = 0; k < n; k++)
        h[k] = 1e-7 * uniform(&seed);
    s.solver = rc_solver_new(&shape, h, &problem, &err);
    assert_non_null(s.solver);
    p = s.solver->it.p;
    for (size_t k = 0; k < n; k++)
        p[k] = uniform(&seed) < row->part ? 1e9 * uniform(&seed) / row->part : 0;
    rc_projection_restore(s.solver, rc_iterate_carried(s.solver));
    for (size_t k = 0; k < n; k++) {
        bool in = rc_elastic(s.solver, k) || uniform(&seed) < 0.5;
        s.solver->set.w[k] = in;
        s.solver->set.size += in;
        s.solver->set.saturated += !in && p[k] > 0;
        s.d[k] = in ? (float)(uniform(&seed) - 0.3) : 0;
        sum += (double)s.d[k];
        moved += in;
    }
    s.mean = sum / moved;
    s.alpha = 1e9 * row->size;
    memcpy(s.before, p, n * sizeof *p);
    free(h);
    return s;
}

static void
take_down(struct set_up *s)
{
    rc_solver_free(s->solver);
    free(s->before);
    free(s->d);
    free(s->delta);
    free(s->tiles);
}

/* Checks that hold after every move. */
static void
lawful(const struct set_up *s, const struct rc_move *m)
{
    const struct rc_solver *solver = s->solver;
    const struct rc_box box = rc_box(solver, 0);
    const double *p = solver->it.p, load = solver->load.sum;
    double size = 0;

    for (size_t k = 0; k < solver->posed.n; k++) {
        double change = p[k] - s->before[k], told = (double)s->delta[k] / solver->load.per_pressure;
        assert_true(p[k] >= rc_low(box, k) && p[k] <= rc_high(box, k));
        assert_true(fabs(change - told) <= 1e-6 * fabs(change) + 1e-13 * load);
        assert_true(solver->set.w[k] != 0 || change == 0);
        size += fabs(change);
    }
    assert_true(fabs(rc_sum(p, solver->posed.n) - load) <= 1e-13 * load);
    assert_true(m->size >= size * (1 - 1e-9) && m->size <= 2 * size);
}

static struct rc_move
move_of(const struct set_up *s)
{
    static const struct rc_tile_line alone = {0};

    return (struct rc_move){.solver = s->solver,
                            .d = s->d,
                            .alpha = s->alpha,
                            .mean = s->mean,
                            .delta = s->delta,
                            .tiles = s->tiles,
                            .line = &alone};
}

/* Without clipping the move is exactly the step; with clipping tiles keep their sums. */
static void
by_tiles(void **state)
{
    size_t carried_out = 0, kept = 0, all = 0;

    (void)state;
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        struct set_up s = set_up(&rows[r]);
        const struct rc_solver *solver = s.solver;
        struct rc_move m = move_of(&s);

        if (rc_move_tiles(&m)) {
            carried_out++;
            lawful(&s, &m);
            for (size_t j0 = 0; j0 < rows[r].ny; j0 += TILE)
                for (size_t i0 = 0; i0 < rows[r].nx; i0 += TILE) {
                    double asked = 0, got = 0, most = 0;
                    for (size_t j = j0; j < j0 + TILE && j < rows[r].ny; j++)
                        for (size_t i = i0; i < i0 + TILE && i < rows[r].nx; i++) {
                            size_t k = j * rows[r].nx + i;
                            double e = (double)s.d[k];
                            asked += s.before[k] + (e != 0 ? m.alpha * (e - m.mean) : 0);
                            got += solver->it.p[k];
                            most += solver->it.p[k] > 0 ? solver->it.p[k] : 0;
                        }
                    all++;
                    kept += fabs(got - asked) <= 1e-2 * most;
                }
        }
        take_down(&s);
    }
    assert_true(carried_out >= 6);
    print_message("%zu moves, %zu of %zu tiles keep their sums\n", carried_out, kept, all);
    assert_true(10 * kept >= 8 * all); /* some cannot */
}

/* The projection: no other admissible pressure with this load is nearer to the step. The condition is a
 * common shift of all nodes that are not at a bound, and the right sign at the nodes at a bound. */
static void
by_one_shift(void **state)
{
    (void)state;
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        struct set_up s = set_up(&rows[r]);
        const struct rc_solver *solver = s.solver;
        struct rc_move m = move_of(&s);
        double low = -INFINITY, high = INFINITY, tiny;

        rc_move_shift(&m);
        lawful(&s, &m);
        tiny = 1e-9 * solver->load.sum / (double)solver->posed.n;
        for (size_t k = 0; k < solver->posed.n; k++) {
            double e = (double)s.d[k], p = solver->it.p[k];
            double shift = p - s.before[k] - (e != 0 ? m.alpha * (e - m.mean) : 0);
            if (solver->set.w[k] == 0)
                continue;
            if (!rc_at_high(rc_box(solver, 0), k, p))
                high = fmin(high, shift);
            if (!rc_at_low(rc_box(solver, 0), k, p))
                low = fmax(low, shift);
        }
        assert_true(low <= high + tiny);
        take_down(&s);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(by_tiles),
        cmocka_unit_test(by_one_shift),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
