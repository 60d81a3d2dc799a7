/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random worn maps, then some with a coefficient of each node, some on a track that wears, pairs that
 * slide over each other, and maps that repeat along one axis. They are compared with a run with a
 * tolerance ten times smaller and contacts a thousand times more accurate. The estimated errors of the
 * worn depth and of the pressure are not below the differences.
 *
 *     law_wear_estimates [FIRST LAST]        runs (default all) */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

enum {
    RUNS = 200,
    WITH_MAPS = 60, /* more */
    ON_TRACK = 60,
    SLIDING = 60,
    LINES = 60,
    PLANES = RUNS + WITH_MAPS + ON_TRACK + SLIDING,
    ALL = PLANES + LINES,
    OUTPUTS = 4,
    MOST = 48 * 48
};
static const double estar = 1e9, node = 1e-6;
static uint64_t first = 1, last = ALL;

struct random_run {
    struct rc_shape s;
    struct rc_boundary boundary;
    double tol, load, k, at[OUTPUTS];
    double of_body[2], track;
    double *h;
    double *part; /* NULL: none */
    double *h2;   /* of the body that slides over it; NULL: none */
};

static double
uniform(uint64_t *seed)
{
    return random_number(seed) + 0.5;
}

/* A coefficient of each node over the largest one: two phases, a disc that does not wear, one with a
 * gradual edge, or log-normal. */
static void
draw_parts(struct random_run *r, uint64_t *seed)
{
    const int kind = (int)(4 * uniform(seed)), square = 3 + (int)(10 * uniform(seed));
    const double least = pow(10, -0.3 - 1.3 * uniform(seed)), radius = 2 + 5 * uniform(seed);
    const size_t nx = r->s.nx, n = nx * r->s.ny;
    struct rc_selfaffine rough = {.hurst = 0.8,
                                  .rms_height = 0.2 + 0.8 * uniform(seed),
                                  .short_cut = 3 * node,
                                  .seed = *seed};
    double most = 0;

    r->part = calloc(n, sizeof *r->part);
    if (kind == 3)
        assert_int_equal(rc_synth_selfaffine(&r->s, &rough, r->part, NULL), RC_OK);
    for (size_t k = 0; k < n; k++) {
        int i = (int)(k % nx), j = (int)(k / nx);
        double off = hypot(i - (double)nx / 2, j - (double)nx / 2) / radius - 1;
        r->part[k] = kind == 0   ? (i / square + j / square) % 2 ? 1 : least
                     : kind == 1 ? off < 0 ? 0 : 1
                     : kind == 2 ? fmax(off, 0)
                                 : exp(r->part[k]);
        most = fmax(most, r->part[k]);
    }
    for (size_t k = 0; k < n; k++)
        r->part[k] /= most;
}

static struct random_run
draw(uint64_t seed)
{
    const bool maps = seed > RUNS && seed <= RUNS + WITH_MAPS,
               slides = seed > PLANES - SLIDING && seed <= PLANES, line = seed > PLANES,
               track = seed > RUNS + WITH_MAPS && !slides && !line, along_x = seed % 2 == 0;
    struct random_run r = {.k = 1e-15, .of_body = {1, 0}};
    size_t side = 24 + 8 * (size_t)(4 * uniform(&seed));
    struct rc_selfaffine rough = {
        .hurst = 0.5 + 0.45 * uniform(&seed), .rms_height = 1, .seed = seed};
    double slope = 0, area, x, y;
    const bool ball = uniform(&seed) < 0.25 && !slides;

    r.s = (struct rc_shape){side, side, node, node};
    r.boundary = (uniform(&seed) < 0.6 && !ball) || slides ? RC_PERIODIC : RC_FREE;
    if (line)
        r.boundary = rc_boundary_of(along_x, !along_x);
    r.tol = pow(10, -1 - uniform(&seed));
    r.h = calloc(side * side, sizeof *r.h);
    rough.short_cut = node * (2 + 6 * uniform(&seed));
    assert_int_equal(rc_synth_selfaffine(&r.s, &rough, r.h, NULL), RC_OK);
    for (size_t k = 0; k < side * side; k++) {
        size_t next = k % side + 1 < side ? k + 1 : k + 1 - side;
        slope += pow((r.h[next] - r.h[k]) / node, 2);
    }
    const double steep = pow(10, -1.3 + 1.3 * uniform(&seed) - (ball ? 0.5 : 0));
    slope = sqrt(2 * slope / (double)(side * side));
    for (size_t k = 0; k < side * side; k++) {
        x = ((double)(k % side) - (double)side / 2) * node;
        y = ((double)(k / side) - (double)side / 2) * node;
        r.h[k] *= steep / slope;
        if (line && ball)
            *(along_x ? &x : &y) = 0;
        if (ball)
            r.h[k] -= (x * x + y * y) / (2 * 100 * node);
    }
    area = node * node * (double)(side * side);
    r.load = estar * pow(10, -3 + 1.5 * uniform(&seed)) * area;
    for (int q = 0; q < OUTPUTS; q++)
        r.at[q] =
            (q > 0 ? r.at[q - 1] : node / (r.k * estar) * 0.03) * pow(10, 1.5 * uniform(&seed));
    if (maps)
        draw_parts(&r, &seed);
    if (slides) {
        const double rougher = steep * 2 * uniform(&seed);
        r.tol = fmax(r.tol, 0.05);
        r.of_body[1] = floor(3 * uniform(&seed)) / 2;
        r.h2 = calloc(side * side, sizeof *r.h2);
        rough.seed++;
        assert_int_equal(rc_synth_selfaffine(&r.s, &rough, r.h2, NULL), RC_OK);
        for (size_t k = 0; k < side * side; k++)
            r.h2[k] *= rougher / slope;
    }
    if (track) {
        r.of_body[0] = floor(3 * uniform(&seed)) / 2;
        r.of_body[1] = 1;
        r.track = node * pow(10, 2 * uniform(&seed));
    }
    return r;
}

static struct rc_model *
model(const struct random_run *r, double tol, double contacts)
{
    const struct rc_problem contact = {
        .boundary = r->boundary, .pair.estar = estar, .tol = contacts, .threads = 1};
    const struct rc_wear_problem law = {.k = {r->k * r->of_body[0], r->k * r->of_body[1]},
                                        .estar = estar,
                                        .tol = tol,
                                        .part = r->part,
                                        .track = r->track,
                                        .two_bodies = r->h2 != NULL,
                                        .h2 = r->h2};
    struct rc_err err = {""};
    struct rc_model *m =
        rc_wear_new(rc_elastic_new(&r->s, r->h, &contact, NULL, &err), r->h, &law, &err);

    if (m == NULL)
        fail_msg("%s", err.text);
    return m;
}

static void
slide(struct rc_model *m, const struct random_run *r, int q, double *p, double *wear)
{
    struct rc_err err = {""};
    struct rc_point to = {0};

    rc_point_set(&to, RC_LOAD, r->load);
    rc_point_set(&to, RC_DISTANCE, r->at[q]);
    if (rc_model_run(m, &to, &err) == RC_FAIL || rc_model_look(m, NULL, &err) != RC_OK ||
        rc_model_frame(m, "pressure", p, &err) != RC_OK ||
        rc_model_frame(m, "wear", wear, &err) != RC_OK || rc_model_keep(m, &err) != RC_OK)
        fail_msg("%s", err.text);
}

static double
differ(size_t n, const double *a, const double *b)
{
    double off = 0, size = 0;

    for (size_t k = 0; k < n; k++) {
        off += fabs(a[k] - b[k]);
        size += fabs(b[k]);
    }
    return off / size;
}

static void
estimates_are_not_below(void **state)
{
    static double p[2][MOST], wear[2][MOST];
    double least[2] = {INFINITY, INFINITY};
    size_t short_of = 0;

    (void)state;
    for (uint64_t seed = first; seed <= last; seed++) {
        struct random_run r = draw(seed);
        struct rc_model *m = model(&r, r.tol, r.tol / 100),
                        *fine = model(&r, r.tol / 10, r.tol / (r.h2 != NULL ? 1e3 : 1e5));
        const size_t n = r.s.nx * r.s.ny;
        for (int q = 0; q < OUTPUTS; q++) {
            const struct rc_wear_figures *f = rc_wear_result(m);
            double ratio[2];
            slide(m, &r, q, p[0], wear[0]);
            slide(fine, &r, q, p[1], wear[1]);
            ratio[0] = f->wear_error / differ(n, wear[0], wear[1]);
            ratio[1] = f->pressure_error / differ(n, p[0], p[1]);
            for (int k = 0; k < 2; k++) {
                least[k] = fmin(least[k], ratio[k]);
                if (!(ratio[k] >= 1))
                    print_message("seed %u, output %d, %zu x %zu nodes, tol %.2g: the estimate of "
                                  "the %s is %.3f of the error\n",
                                  (unsigned)seed, q, r.s.nx, r.s.ny, r.tol,
                                  k == 0 ? "wear" : "pressure", ratio[k]);
            }
            short_of += !f->converged;
        }
        rc_model_free(m);
        rc_model_free(fine);
        free(r.h);
        free(r.part);
        free(r.h2);
    }
    print_message("%d runs, %d outputs: estimates at least %.2f (wear) and %.2f (pressure) of the "
                  "error; %zu outputs short of the tolerance\n",
                  (int)(last + 1 - first), (int)(last + 1 - first) * OUTPUTS, least[0], least[1],
                  short_of);
    assert_true(least[0] >= 1 && least[1] >= 1);
}

int
main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(estimates_are_not_below),
    };

    if (argc > 2) {
        first = strtoull(argv[1], NULL, 10);
        last = strtoull(argv[2], NULL, 10);
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
