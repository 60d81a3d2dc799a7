/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact of sharp, flat, single and random shapes is solved to 1e-8, and agrees with the exact answer if it
 * is known. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hard_case.h"

/* ---- heights ---- */

static double
flat(struct rc_shape s, size_t k, double a, uint64_t *seed)
{
    (void)s, (void)k, (void)seed;
    return a;
}

/* One node above (a = 1) or below (a = -1) all others. */
static double
odd_one(struct rc_shape s, size_t k, double a, uint64_t *seed)
{
    (void)seed;
    return k == s.nx * (s.ny / 3) + s.nx / 4 ? a : 0;
}

static double
sphere(struct rc_shape s, size_t k, double a, uint64_t *seed)
{
    double r = node_r(s, k);

    (void)seed;
    return -r * r / (2 * a);
}

static double
cone(struct rc_shape s, size_t k, double a, uint64_t *seed)
{
    (void)seed;
    return -a * node_r(s, k);
}

/* Spheres of radius a about a quarter and three quarters of the length. */
static double
two_peaks(struct rc_shape s, size_t k, double a, uint64_t *seed)
{
    double x = fabs(node_x(s, k)) - s.dx * (double)s.nx / 4, y = node_y(s, k);

    (void)seed;
    return -(x * x + y * y) / (2 * a);
}

/* Punches of height 1: a disc of radius a m, a square of 2 a nodes a side, a strip of 2 a nodes. */
static double
disc(struct rc_shape s, size_t k, double a, uint64_t *seed)
{
    (void)seed;
    return node_r(s, k) <= a ? 1 : 0;
}

static double
square(struct rc_shape s, size_t k, double a, uint64_t *seed)
{
    (void)seed;
    return fabs(node_x(s, k)) < a * s.dx && fabs(node_y(s, k)) < a * s.dy ? 1 : 0;
}

static double
strip(struct rc_shape s, size_t k, double a, uint64_t *seed)
{
    (void)seed;
    return fabs(node_x(s, k)) < a * s.dx ? 1 : 0;
}

/* Ridges a nodes wide, 2 a apart. */
static double
grooves(struct rc_shape s, size_t k, double a, uint64_t *seed)
{
    (void)seed;
    return fmod((double)(k % s.nx), 2 * a) < a ? 1 : 0;
}

static double
cauchy(struct rc_shape s, size_t k, double a, uint64_t *seed)
{
    (void)s, (void)k, (void)a;
    return tan(exact_pi * random_number(seed));
}

/* Blocks of a x a nodes, each flat, with different heights. The surface has plateaus of equal heights. */
static double
blocks(struct rc_shape s, size_t k, double a, uint64_t *seed)
{
    size_t i = k % s.nx / (size_t)a, j = k / s.nx / (size_t)a;
    uint64_t own = 1000 * j + i;

    (void)seed;
    random_number(&own);
    return floor(4 * random_number(&own)) / 4;
}

/* ---- answers ---- */

static double
relative(double value, double truth, double allowed)
{
    return fabs(value / truth - 1) / allowed;
}

/* The only touching node carries the whole load, and sinks by Love's displacement of its own cell. */
static double
one_node(const struct hard_case *c, const struct rc_problem *problem, const double *h,
         const struct solved *s)
{
    double area = c->shape.dx * c->shape.dy, p = problem->load / area, off;
    size_t top = 0;

    for (size_t k = 0; k < c->shape.nx * c->shape.ny; k++)
        top = h[k] > h[top] ? k : top;
    off = s->c.contact_nodes == 1 ? relative(s->p[top], p, rounding) : INFINITY;
    if (rc_repeats(problem->boundary) == 0)
        off = larger(off, relative(s->c.approach,
                                   p * love_displacement(0, 0, c->shape.dx / 2, c->shape.dy / 2,
                                                         problem->pair.estar),
                                   summed));
    return off;
}

/* Hertz. */
static double
hertz_answer(const struct hard_case *c, const struct rc_problem *problem, const double *h,
             const struct solved *s)
{
    struct hertz exact = hertz(problem->load, c->a, problem->pair.estar);
    double nodes = exact.a / c->shape.dx;

    (void)h;
    return larger(
        relative(s->c.approach, exact.approach, grid_approach / (nodes * nodes)),
        larger(relative(s->c.max_pressure, exact.p0, grid_peak / (nodes * nodes)),
               relative(s->c.contact_area, exact_pi * exact.a * exact.a, grid_area / nodes)));
}

static double
cone_answer(const struct hard_case *c, const struct rc_problem *problem, const double *h,
            const struct solved *s)
{
    double a = cone_radius(problem->load, c->a, problem->pair.estar), nodes = a / c->shape.dx;

    (void)h;
    return larger(relative(s->c.approach, cone_approach(problem->load, c->a, problem->pair.estar),
                           grid_cone / nodes),
                  relative(s->c.contact_area, exact_pi * a * a, grid_area / nodes));
}

/* The edge of the disc is a staircase and the pressure there is singular: an error of half a node in the
 * radius. */
static double
disc_answer(const struct hard_case *c, const struct rc_problem *problem, const double *h,
            const struct solved *s)
{
    (void)h;
    return relative(s->c.approach, punch_approach(problem->load, c->a, problem->pair.estar),
                    0.5 * c->shape.dx / c->a);
}

/* A rigid square punch is analogous to a charged square plate. Its capacity is 0.36679 times the side; that
 * of a disc is 2/pi times the radius (Read 1997; Hwang and Mascagni 2004). */
static double
square_answer(const struct hard_case *c, const struct rc_problem *problem, const double *h,
              const struct solved *s)
{
    double side = 2 * (c->height == flat ? (double)c->shape.nx / 2 : c->a) * c->shape.dx;

    (void)h;
    return relative(
        s->c.approach,
        punch_approach(problem->load, exact_pi / 2 * 0.36679 * side, problem->pair.estar),
        0.5 * c->shape.dx / side);
}

/* Rigid flat strips of width 2 w, one in each period L, at a mean pressure m. p = m cos(pi x / L) /
 * sqrt(sin^2(pi w / L) - sin^2(pi x / L)) (Johnson 1985, section 13.2: the periodic form of the flat punch).
 * Compared in the middle of the strip, with an error of a node in its width. */
static double
strips_answer(const struct hard_case *c, const struct rc_problem *problem, const double *h,
              const struct solved *s)
{
    bool one = c->height == strip;
    double part = one ? 2 * c->a / (double)c->shape.nx : 0.5;
    double mean = c->mean * problem->pair.estar, truth = mean / sin(exact_pi * part / 2);
    size_t middle = one ? c->shape.nx / 2 : (size_t)c->a / 2,
           nodes = (size_t)(one ? 2 * c->a : c->a);

    (void)h;
    if (rc_repeats(problem->boundary) < 2)
        return 0;
    if ((double)s->c.contact_nodes != part * (double)(c->shape.nx * c->shape.ny))
        return INFINITY;
    return relative(s->p[middle], truth, 1.0 / (double)nodes);
}

/* A rigid flat strip as wide as a map that repeats along it: P'/(pi E*) 2 ln(2 datum/a), with the
 * default datum of 2 a. */
static double
strip_answer(const struct hard_case *c, const struct rc_problem *problem, const struct solved *s)
{
    double a = c->shape.dx * (double)c->shape.nx, b = c->shape.dy * (double)c->shape.ny;
    double load = problem->load / (problem->boundary.x ? a : b);

    return relative(s->c.approach, 2 * load * log(4) / (exact_pi * problem->pair.estar),
                    0.5 * (problem->boundary.x ? c->shape.dy / b : c->shape.dx / a));
}

/* A flat map on a flat has the same pressure everywhere. */
static double
even_answer(const struct hard_case *c, const struct rc_problem *problem, const double *h,
            const struct solved *s)
{
    double off = 0;

    if (rc_repeats(problem->boundary) == 1)
        return strip_answer(c, problem, s);
    if (rc_repeats(problem->boundary) == 0)
        return square_answer(c, problem, h, s);
    for (size_t k = 0; k < c->shape.nx * c->shape.ny; k++)
        off = larger(off, relative(s->p[k], c->mean * problem->pair.estar, summed));
    return off;
}

/* Each of two equal peaks carries half. */
static double
halves_answer(const struct hard_case *c, const struct rc_problem *problem, const double *h,
              const struct solved *s)
{
    double left = 0;

    (void)h;
    for (size_t k = 0; k < c->shape.nx * c->shape.ny; k++)
        left += k % c->shape.nx < c->shape.nx / 2 ? s->p[k] : 0;
    return relative(left * c->shape.dx * c->shape.dy, problem->load / 2, 2 * hard_error);
}

/* ---- tables ---- */

#define ODD                                                                                        \
    {                                                                                              \
        33, 47, 1.1e-6, 1e-6                                                                       \
    }
#define EVEN                                                                                       \
    {                                                                                              \
        64, 64, 1e-6, 1e-6                                                                         \
    }
#define CENTRED                                                                                    \
    {                                                                                              \
        65, 65, 1e-6, 1e-6                                                                         \
    } /* a node at the apex: the approach counts from it */
#define MAP                                                                                        \
    {                                                                                              \
        41, 29, 1e-6, 1.2e-6                                                                       \
    }

static const struct hard_case lonely[] = {
    {"one node", ODD, BOTH, odd_one, 1, 1e-6, 1e-9, 0, 0, one_node, 0},
    {"one node, 1e-15", ODD, BOTH, odd_one, 1, 1e-6, 1e-15, 0, 0, one_node, 0},
    {"one node, 1e-18", ODD, BOTH, odd_one, 1, 1e-6, 1e-18, 0, 0, one_node, 0},
    {"one node, 1e-21", ODD, BOTH, odd_one, 1, 1e-6, 1e-21, 0, 0, one_node, 0},
    {"one node, 1e-25", ODD, BOTH, odd_one, 1, 1e-6, 1e-25, 0, 0, one_node, 0},
    {"one node, 1e-30", ODD, BOTH, odd_one, 1, 1e-6, 1e-30, 0, 0, one_node, 0},
    {"one node of noise, 1e-21", ODD, BOTH, hard_noise, 0, 1e-7, 1e-21, 0, 0, one_node, 0},
    {"one node of noise, 1e-30", ODD, BOTH, hard_noise, 0, 1e-7, 1e-30, 0, 0, one_node, 0},
    {"all but one node", ODD, BOTH, odd_one, 1, 1e-10, 1e-3, 0, 0, NULL, 2e-14},
    {"a pit of one node", ODD, BOTH, odd_one, -1, 1e-7, 1e-3, 0, 0, NULL, 0},
    {"a shallow pit", ODD, BOTH, odd_one, -1, 1e-10, 1e-1, 0, 0, NULL, 2e-14},
    {"one node of noise", ODD, BOTH, hard_noise, 0, 1e-7, 1e-12, 0, 0, one_node, 0},
    {"one node of Cauchy heights", ODD, BOTH, cauchy, 0, 1e-7, 1e-6, 0, 0, one_node, 0},
    {"constant height", EVEN, BOTH, flat, 1, 1, 1e-3, 0, 0, even_answer, 0},
    {"constant height 0", EVEN, BOTH, flat, 0, 1, 1e-3, 0, 0, even_answer, 0},
};

static void
lonely_nodes(void **state)
{
    (void)state;
    HARD_RUN(lonely);
}

/* clang-format off */
static const struct hard_case bodies[] = {
    {"sphere", CENTRED, FREE, sphere, 1e-3, 1, 3e-3, 0, 0, hertz_answer, 0},
    {"sphere, periodic", EVEN, PERIODIC, sphere, 1e-3, 1, 3e-3, 0, 0, NULL, 0},
    {"two equal peaks", {128, 40, 1e-6, 1e-6}, BOTH, two_peaks, 1e-3, 1, 1e-3, 0, 0, halves_answer, 0},
    {"two equal peaks, touching", {128, 40, 1e-6, 1e-6}, BOTH, two_peaks, 1e-3, 1, 1e-1, 0, 0,
     halves_answer, 0},
    {"cone", CENTRED, FREE, cone, 0.05, 1, 5e-3, 0, 0, cone_answer, 0},
    {"cone, periodic", EVEN, PERIODIC, cone, 0.05, 1, 5e-3, 0, 0, NULL, 0},
    {"flat punch", EVEN, FREE, disc, 20.2e-6, 1e-5, 1e-3, 0, 0, disc_answer, 0},
    {"flat punch, periodic", EVEN, PERIODIC, disc, 20.2e-6, 1e-5, 1e-3, 0, 0, NULL, 0},
    {"flat punch, sunk in", EVEN, BOTH, disc, 20.2e-6, 1e-7, 1e-1, 0, 0, NULL, 0},
    {"square punch", EVEN, FREE, square, 20, 1e-5, 1e-3, 0, 0, square_answer, 0},
    {"square punch, periodic", EVEN, PERIODIC, square, 20, 1e-5, 1e-3, 0, 0, NULL, 0},
    {"step", {64, 29, 1e-6, 1.2e-6}, BOTH, strip, 16, 1e-4, 1e-3, 0, 0, strips_answer, 0},
    {"step, sunk in", {64, 29, 1e-6, 1.2e-6}, BOTH, strip, 16, 1e-7, 1e-1, 0, 0, NULL, 0},
    {"grooves", {80, 29, 1e-6, 1.2e-6}, BOTH, grooves, 5, 1e-5, 1e-3, 0, 0, strips_answer, 0},
    {"grooves, sunk in", {80, 29, 1e-6, 1.2e-6}, BOTH, grooves, 5, 1e-7, 5e-2, 0, 0, NULL, 0},
    {"blocks", EVEN, BOTH, blocks, 7, 1e-6, 1e-2, 0, 0, NULL, 0},
    {"blocks of one node", MAP, BOTH, blocks, 1, 1e-6, 1e-2, 0, 0, NULL, 0},
};
/* clang-format on */

static void
bodies_of_revolution_and_others(void **state)
{
    (void)state;
    HARD_RUN(bodies);
}

static const struct hard_case random_heights[] = {
    {"noise, a few nodes", MAP, BOTH, hard_noise, 0, 1e-7, 1e-5, 0, 0, NULL, 0},
    {"noise, a tenth", MAP, BOTH, hard_noise, 0, 1e-7, 3e-3, 0, 0, NULL, 0},
    {"noise, half", MAP, BOTH, hard_noise, 0, 1e-7, 2e-2, 0, 0, NULL, 0},
    {"noise, nearly all", MAP, BOTH, hard_noise, 0, 1e-7, 1e-1, 0, 0, NULL, 0},
    {"noise, all", MAP, BOTH, hard_noise, 0, 1e-7, 1, 0, 0, NULL, 0},
    {"Cauchy, a few nodes", MAP, BOTH, cauchy, 0, 1e-7, 1e-3, 0, 0, NULL, 0},
    {"Cauchy, some", MAP, BOTH, cauchy, 0, 1e-7, 1e-1, 0, 0, NULL, 0},
    {"Cauchy, many", MAP, BOTH, cauchy, 0, 1e-7, 1, 0, 0, NULL, 0},
    {"Cauchy, nearly all", MAP, BOTH, cauchy, 0, 1e-7, 100, 0, 0, NULL, 0},
    {"noise, 160 x 140", {160, 140, 1e-6, 1.3e-6}, BOTH, hard_noise, 0, 1e-7, 2e-2, 0, 0, NULL, 0},
    {"Cauchy, 160 x 140", {160, 140, 1e-6, 1.3e-6}, BOTH, cauchy, 0, 1e-7, 1e-1, 0, 0, NULL, 0},
};

static void
noise_and_cauchy_heights(void **state)
{
    (void)state;
    HARD_RUN(random_heights);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lonely_nodes),
        cmocka_unit_test(bodies_of_revolution_and_others),
        cmocka_unit_test(noise_and_cauchy_heights),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
