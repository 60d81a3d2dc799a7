/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws of every stress field in a coated body: equilibrium, Hooke's law, continuity at interfaces, the load,
 * and the sum of waves. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"
#include "libcontact/body/stack.h"
#include "libcontact/operator/operator.h"

static const struct rc_layer three[] = {
    {2.3e-6, 4e11, 0.2}, {1.1e-6, 2e10, 0.45}, {4e-6, 9e10, 0.3}};
static const struct rc_body coating = {2e11, 0.28, 3, three};

enum {
    MEDIA = 4
};

/* ---- a wave ---- */

static struct rc_stack *
stack(void)
{
    struct rc_err err;
    struct rc_stack *s = rc_stack_new(&coating, &err);

    assert_non_null(s);
    return s;
}

/* Stresses of one load, and displacements along the wave and downwards, times 2 G q. They follow from Hooke's
 * law in plane strain, and from the shear along the wave, dU/d(qz) - W = T/G. */
struct wave {
    double s, t, l, n, u, w, r, v;
};

static double
displacement(const struct rc_stack *s, size_t medium, double z, double q, int load)
{
    double f[RC_UNDER_BOTH], *from = f + (load == 0 ? RC_P_S : RC_T_S);
    double nu = s->material[medium].nu;

    rc_stack_inside(s, medium, z, q, RC_UNDER_BOTH, f);
    return ((1 - nu) * from[RC_P_L] - nu * from[RC_P_S]);
}

/* The wave at a depth in a medium from `top` to `bottom`: the points of the differences of sixth order stay
 * inside. */
static struct wave
wave_at(const struct rc_stack *s, size_t medium, double z, double q, int load, bool from_above)
{
    static const double one_sided[] = {-147, 360, -450, 400, -225, 72, -10};
    double f[RC_UNDER_BOTH], step = 1e-2 / q * (from_above ? -1 : 1), slope = 0;
    struct wave a;
    const double *from = f + (load == 0 ? RC_P_S : RC_T_S);

    rc_stack_inside(s, medium, z, q, RC_UNDER_BOTH, f);
    for (int k = 0; k < 7; k++)
        slope += one_sided[k] * displacement(s, medium, z + k * step, q, load) / (60 * step * q);
    a = (struct wave){.s = from[RC_P_S],
                      .t = from[RC_P_T],
                      .l = from[RC_P_L],
                      .n = from[RC_P_N],
                      .r = f[RC_T_R],
                      .v = f[RC_T_V]};
    a.u = displacement(s, medium, z, q, load);
    a.w = slope - 2 * a.t;
    return a;
}

/* Tractions and displacements on both sides of each interface. The slopes are of sixth order in steps of
 * a hundredth of 1/q. */
static void
bonded(void **state)
{
    struct rc_stack *s = stack();
    double tractions = 0, displacements = 0, most = 0;

    (void)state;
    for (size_t k = 0; k + 1 < MEDIA; k++)
        for (int i = 0; i < 30; i++) {
            double q = 1e5 * exp(i * 0.2), z = rc_stack_top(s, k + 1);
            for (int load = 0; load < 2; load++) {
                struct wave a = wave_at(s, k, z, q, load, true);
                struct wave b = wave_at(s, k + 1, z, q, load, false);
                double g = s->material[k].modulus, h = s->material[k + 1].modulus;
                tractions = larger(tractions, fabs(a.s - b.s));
                tractions = larger(tractions, fabs(a.t - b.t));
                tractions = larger(tractions, fabs(a.r - b.r));
                most = larger(most, larger(fabs(a.u) / g, fabs(a.w) / g));
                displacements = larger(displacements, fabs(a.u / g - b.u / h) * fmin(g, h));
                displacements = larger(displacements, fabs(a.w / g - b.w / h) * fmin(g, h));
                displacements = larger(displacements, fabs(a.v / g - b.v / h) * fmin(g, h));
            }
        }
    print_message("across interfaces tractions jump by %.1e of the load, displacements by %.1e\n",
                  tractions, displacements);
    assert_true(most > 0);
    assert_true(tractions <= rounding);
    assert_true(displacements <= 1e-9); /* error of differences */
    rc_stack_free(s);
}

static double
slope(const double v[7], double step)
{
    return (45 * (v[4] - v[2]) - 9 * (v[5] - v[1]) + (v[6] - v[0])) / (60 * step);
}

/* dS/d(qz) = -T, dT/d(qz) = L, dR/d(qz) = -V, dV/d(qz) = -R, and compatibility. With U, W from Hooke's law it
 * is d2U = dT + dW, dW = (1 - nu) S - nu L (times 2). All by central differences of sixth order. */
static void
wave_in_equilibrium(void **state)
{
    struct rc_stack *s = stack();
    const double step = 1e-2;
    double off = 0;

    (void)state;
    for (size_t k = 0; k < MEDIA; k++)
        for (int i = 0; i < 30; i++) {
            double q = 1e5 * exp(i * 0.2), nu = s->material[k].nu;
            double z = rc_stack_top(s, k) + (k < 3 ? three[k].thickness : 4e-6) * 0.4;
            double f[7][RC_UNDER_BOTH], v[RC_UNDER_BOTH + 1][7];
            if (step * 3 / q > 0.35 * (k < 3 ? three[k].thickness : 4e-6))
                continue;
            for (int j = 0; j < 7; j++) {
                rc_stack_inside(s, k, z + (j - 3) * step / q, q, RC_UNDER_BOTH, f[j]);
                for (int c = 0; c < RC_UNDER_BOTH; c++)
                    v[c][j] = f[j][c];
            }
            for (int load = 0; load < 2; load++) {
                double(*w)[7] = v + (load == 0 ? RC_P_S : RC_T_S);
                double bend = 0, curve[7] = {2, -27, 270, -490, 270, -27, 2};
                for (int j = 0; j < 7; j++)
                    bend += curve[j] * ((1 - nu) * w[RC_P_L][j] - nu * w[RC_P_S][j]) /
                            (180 * step * step);
                off = larger(off, fabs(slope(w[RC_P_S], step) + w[RC_P_T][3]));
                off = larger(off, fabs(slope(w[RC_P_T], step) - w[RC_P_L][3]));
                off = larger(off, fabs(w[RC_P_N][3] - nu * (w[RC_P_S][3] + w[RC_P_L][3])));
                off = larger(off, fabs(bend - 2 * w[RC_P_L][3] -
                                       ((1 - nu) * w[RC_P_S][3] - nu * w[RC_P_L][3])));
            }
            off = larger(off, fabs(slope(v[RC_T_R], step) + v[RC_T_V][3]));
            off = larger(off, fabs(slope(v[RC_T_V], step) + v[RC_T_R][3]));
        }
    print_message("differences are off by %.1e of the load\n", off);
    assert_true(off <= 1e-9); /* rounding over the square of the step, times some tens */
    rc_stack_free(s);
}

/* The same for layers a million times thinner, stiffer or softer than others: all values are finite. At small
 * wave numbers every depth carries the load. */
static void
extreme_stacks(void **state)
{
    static const double e[] = {1e-6, 1, 1e6}, t[] = {1e-6, 1, 1e6};

    (void)state;
    for (int a = 0; a < 27; a++) {
        const struct rc_layer layer[] = {{t[a % 3], e[a / 3 % 3], 0.5}, {1, e[a / 9], -0.999}};
        const struct rc_body c = {1, 0.3, 2, layer};
        struct rc_err err;
        struct rc_stack *s = rc_stack_new(&c, &err);
        double f[RC_UNDER_BOTH];
        assert_non_null(s);
        for (size_t k = 0; k < 3; k++)
            for (double q = 1e-8; q < 2e8; q *= 10) {
                rc_stack_inside(s, k, rc_stack_top(s, k), q, RC_UNDER_BOTH, f);
                for (int i = 0; i < RC_UNDER_BOTH; i++)
                    assert_true(isfinite(f[i]));
            }
        rc_stack_inside(s, 2, rc_stack_top(s, 2), 1e-18 / rc_stack_top(s, 2), RC_UNDER_BOTH, f);
        assert_true(fabs(f[RC_P_S] + 1) <= 1e-9);
        assert_true(fabs(f[RC_T_T] + 1) <= 1e-9);
        rc_stack_free(s);
    }
}

/* ---- maps ---- */

static const unsigned six = (1 << RC_COMPONENTS) - 1;
static const double mu = 0.35;

static void
slice(struct rc_shape shape, struct rc_boundary boundary, const double *p, double z, double *s)
{
    size_t n = shape.nx * shape.ny;
    double *to[RC_STRESSES] = {NULL};
    struct rc_stress_options o = {
        .boundary = boundary, .mu = mu, .wanted = six, .body = coating, .threads = 2};
    struct rc_err err;
    struct rc_stress *stress = rc_stress_new(&shape, p, &o, &err);

    assert_non_null(stress);
    for (int c = 0; c < RC_COMPONENTS; c++)
        to[c] = s + (size_t)c * n;
    assert_int_equal(rc_stress_slice(stress, z, to, &err), RC_OK);
    rc_stress_free(stress);
}

/* d2/dx2 of exp(-x^2/2 w^2), and its mean over a cell, times w^2. */
static double
bump(double x, double w)
{
    return (x * x / (w * w) - 1) * exp(-x * x / (2 * w * w));
}

static double
bump_mean(double x, double w, double d)
{
    double a = x - d / 2, b = x + d / 2;

    return (a * exp(-a * a / (2 * w * w)) - b * exp(-b * b / (2 * w * w))) / d;
}

/* Along a free axis each cell carries the value of a smooth pressure at its centre. Along an axis that
 * repeats the pressure is band-limited, and the same field results from the means over cells on a much
 * longer map. The pressure has no moments below the fourth, so the effect of its images falls as the
 * sixth power of width over distance. At depths of a few cells waves shorter than those of the grid
 * have decayed. */
static void
free_is_periodic_far_apart(void **state)
{
    enum {
        SMALL = 96,
        LARGE = 384
    };
    static const double depths[] = {2.3e-6, 2.9e-6, 3.4e-6, 5e-6, 7.4e-6, 12e-6};
    const double d = 0.35e-6, w = 5 * d;
    const struct rc_shape large = {LARGE, LARGE, d, d};
    double *p = calloc(LARGE * LARGE, sizeof *p), *q = calloc(LARGE * LARGE, sizeof *q);
    double *s = malloc(6 * LARGE * LARGE * sizeof *s), *t = malloc(6 * LARGE * LARGE * sizeof *t);

    (void)state;
    for (size_t k = 0; k < LARGE * LARGE; k++)
        q[k] = bump_mean(node_x(large, k), w, d) * bump_mean(node_y(large, k), w, d);
    for (size_t i = 0; i < sizeof depths / sizeof *depths; i++) {
        const struct rc_boundary boundary = each_boundary[i % BOUNDARIES == 1 ? 0 : i % BOUNDARIES];
        const struct rc_shape small = {boundary.x ? LARGE : SMALL, boundary.y ? LARGE : SMALL, d,
                                       d};
        const size_t n = small.nx * small.ny;
        double off[6] = {0}, largest[6] = {0};
        for (size_t k = 0; k < n; k++) {
            const double x = node_x(small, k), y = node_y(small, k);
            p[k] = (boundary.x ? bump_mean(x, w, d) : bump(x, w)) *
                   (boundary.y ? bump_mean(y, w, d) : bump(y, w));
        }
        slice(small, boundary, p, depths[i], s);
        slice(large, RC_PERIODIC, q, depths[i], t);
        for (int c = 0; c < 6; c++)
            for (size_t k = 0; k < n; k++) {
                const size_t x = k % small.nx + (LARGE - small.nx) / 2;
                const size_t y = k / small.nx + (LARGE - small.ny) / 2;
                double a = s[(size_t)c * n + k];
                double b = t[(size_t)c * LARGE * LARGE + y * LARGE + x];
                off[c] = larger(off[c], fabs(a - b));
                largest[c] = larger(largest[c], fabs(b));
            }
        print_message("%s: ", rc_boundary_word(boundary));
        for (int c = 0; c < 6; c++) {
            print_message("%s%.1e of %.1e%s", c == 0 ? "off by " : "", off[c], largest[c],
                          c == 5 ? "\n" : ", ");
            assert_true(off[c] <= 1e-8);
            assert_true(largest[c] > 1e-4);
        }
    }
    free(p);
    free(q);
    free(s);
    free(t);
}

/* The pressure of a disc with a rough surface. */
static void
rough(struct rc_shape shape, double radius, double *p)
{
    uint64_t seed = 1961;

    for (size_t k = 0; k < shape.nx * shape.ny; k++) {
        double r = node_r(shape, k) / radius;
        p[k] = r < 1 ? 1e9 * (random_number(&seed) + 1) * sqrt(1 - r * r) : 0;
    }
}

/* In each medium d sxj/dx + d syj/dy + d szj/dz = 0 and the sum of the normal stresses is harmonic.
 * Differences in the slice and between seven slices test this, with friction, away from the edges of a map.
 * Sources are at least eight nodes away: differences of sixth order have an error of 1e-4 of the terms. */
static void
maps_in_equilibrium(void **state)
{
    enum {
        NX = 72,
        NY = 60,
        N = NX * NY
    };
    static const int of[3][3] = {
        {RC_SXX, RC_SXY, RC_SXZ}, {RC_SXY, RC_SYY, RC_SYZ}, {RC_SXZ, RC_SYZ, RC_SZZ}};
    static const double depths[MEDIA] = {1.15e-6, 2.85e-6, 5.4e-6, 9e-6};
    static const double curve[7] = {2, -27, 270, -490, 270, -27, 2};
    const struct rc_shape shape = {NX, NY, 0.13e-6, 0.14e-6};
    const double step = 0.06e-6;
    double *p = malloc(N * sizeof *p), *s = malloc(7 * 6 * N * sizeof *s);

    (void)state;
    rough(shape, 3e-6, p);
    for (int b = 0; b < BOUNDARIES; b++)
        for (int m = 0; m < MEDIA; m++) {
            double off = 0, most = 0, harmonic = 0, bent = 0;
            for (int i = 0; i < 7; i++)
                slice(shape, each_boundary[b], p, depths[m] + (i - 3) * step, s + i * 6 * N);
            for (size_t k = 3 * NX; k < N - 3 * NX; k++) {
                double lap[3] = {0}, v[3][7];
                if (k % NX < 3 || k % NX > NX - 4)
                    continue;
                for (int c = 0; c < 3; c++) {
                    double force = 0, d[3] = {shape.dx, shape.dy, step};
                    for (int to = 0; to < 3; to++) {
                        double one;
                        for (int i = 0; i < 7; i++) {
                            ptrdiff_t by = to == 0 ? i - 3 : to == 1 ? (i - 3) * NX : 0;
                            v[to][i] =
                                s[(to == 2 ? i : 3) * 6 * N + of[c][to] * N + (ptrdiff_t)k + by];
                        }
                        one = slope(v[to], d[to]);
                        force += one;
                        most = larger(most, fabs(one));
                    }
                    off = larger(off, fabs(force));
                    for (int to = 0; to < 3; to++)
                        for (int i = 0; i < 7; i++) {
                            ptrdiff_t by = to == 0 ? i - 3 : to == 1 ? (i - 3) * NX : 0;
                            lap[to] +=
                                curve[i] / (180 * d[to] * d[to]) *
                                s[(to == 2 ? i : 3) * 6 * N + of[c][c] * N + (ptrdiff_t)k + by];
                        }
                }
                harmonic = larger(harmonic, fabs(lap[0] + lap[1] + lap[2]));
                bent = larger(bent, fabs(lap[2]));
            }
            print_message(
                "%s, medium %d: forces off by %.1e, the sum's Laplacian by %.1e of its terms\n",
                rc_boundary_word(each_boundary[b]), m + 1, off / most, harmonic / bent);
            assert_true(off < 1e-4 * most);
            assert_true(harmonic < 1e-3 * bent);
        }
    free(p);
    free(s);
}

/* The sum of szz over a plane is the load less the part outside of the map. This part falls as the third
 * power of the size. So on a map twice as large it is an eighth. */
static void
every_depth_carries_the_load(void **state)
{
    static const double depths[] = {0, 1e-6, 2.3e-6, 3e-6, 3.4e-6, 5e-6, 9e-6};

    (void)state;
    for (size_t i = 0; i < sizeof depths / sizeof *depths; i++) {
        double off[2];
        for (int m = 0; m < 2; m++) {
            const struct rc_shape shape = {(size_t)128 << m, (size_t)128 << m, 0.7e-6, 0.8e-6};
            size_t n = shape.nx * shape.ny;
            double *p = calloc(n, sizeof *p), *s = malloc(6 * n * sizeof *s);
            rough(shape, 8e-6, p);
            slice(shape, RC_FREE, p, depths[i], s);
            off[m] = fabs(rc_sum(s + RC_SZZ * n, n) / rc_sum(p, n) + 1);
            free(p);
            free(s);
        }
        print_message("%g m: load off by %.1e, %.1e\n", depths[i], off[0], off[1]);
        assert_true(off[0] <= 2e-2);
        assert_true(off[1] <= 0.15 * off[0] + summed);
    }
}

/* The same in maps: tractions and in-plane strains are equal on both sides of an interface, and the other
 * components jump. */
static void
maps_bonded(void **state)
{
    const struct rc_shape shape = {48, 40, 0.7e-6, 0.8e-6};
    size_t n = shape.nx * shape.ny;
    double *p = malloc(n * sizeof *p), *s = malloc(6 * n * sizeof *s),
           *t = malloc(6 * n * sizeof *t);
    double z = 0;

    (void)state;
    rough(shape, 12e-6, p);
    for (int k = 0; k + 1 < MEDIA; k++) {
        double e[2] = {three[k].e, k == 2 ? coating.e : three[k + 1].e};
        double nu[2] = {three[k].nu, k == 2 ? coating.nu : three[k + 1].nu};
        z += three[k].thickness;
        for (int b = 0; b < BOUNDARIES; b++) {
            double traction = 0, strain = 0, jump = 0;
            slice(shape, each_boundary[b], p, z, s);
            slice(shape, each_boundary[b], p, z * (1 + 1e-12), t);
            for (size_t i = 0; i < n; i++) {
                double *side[2] = {s + i, t + i}, along[2][3];
                for (int m = 0; m < 2; m++) {
                    double *v = side[m];
                    double xx = v[RC_SXX * n], yy = v[RC_SYY * n], zz = v[RC_SZZ * n];
                    along[m][0] = (xx - nu[m] * (yy + zz)) / e[m];
                    along[m][1] = (yy - nu[m] * (xx + zz)) / e[m];
                    along[m][2] = (1 + nu[m]) * v[RC_SXY * n] / e[m];
                }
                for (int c = 0; c < 3; c++)
                    strain = larger(strain, fabs(along[0][c] - along[1][c]) * fmin(e[0], e[1]));
                for (int c = 0; c < 6; c++)
                    if (c == RC_SZZ || c == RC_SXZ || c == RC_SYZ)
                        traction =
                            larger(traction, fabs(s[(size_t)c * n + i] - t[(size_t)c * n + i]));
                jump = larger(jump, fabs(s[RC_SXX * n + i] - t[RC_SXX * n + i]));
            }
            print_message("interface %d: tractions %.1e, strains %.1e, sxx jumps by %.1e\n", k + 1,
                          traction / 1e9, strain / 1e9, jump / 1e9);
            assert_true(traction <= 1e-10 * 1e9); /* largest at the depths between them */
            assert_true(strain <= 1e-10 * 1e9);
            assert_true(jump >= 0.01 * 1e9);
        }
    }
    free(p);
    free(s);
    free(t);
}

static double
largest_of(size_t n, const double *v)
{
    size_t least, largest;

    rc_extremes(n, v, &least, &largest);
    return v[largest];
}

/* Automatic depths: they rise, include both sides of each interface and several depths in each layer. The
 * largest Mises stress on them is that of a dense scan. */
static void
chosen_depths(void **state)
{
    const struct rc_shape shape = {48, 40, 0.7e-6, 0.8e-6};
    const struct rc_body rigid = {INFINITY, 0.3, 3, three};
    size_t n = shape.nx * shape.ny, count, in[MEDIA] = {0};
    double *p = malloc(n * sizeof *p), *m = malloc(n * sizeof *m), *z, bottom = 0, found = 0,
           most = 0;
    double *s[RC_STRESSES] = {[RC_MISES] = m};
    struct rc_stress_options o = {.wanted = 1u << RC_MISES, .body = coating, .threads = 2};
    struct rc_err err;
    struct rc_stress *stress;

    (void)state;
    for (size_t k = 0; k < n; k++)
        p[k] = node_r(shape, k) < 9e-6 ? 1e9 * sqrt(1 - pow(node_r(shape, k) / 9e-6, 2)) : 0;
    stress = rc_stress_new(&shape, p, &o, &err);
    assert_int_equal(rc_stress_depths(NULL, &shape, p, RC_FREE, &coating, &z, &count, &err), RC_OK);
    assert_true(z[0] == 0 && z[count - 1] > 2.5 * 9e-6);
    for (size_t k = 0; k < count; k++) {
        assert_true(k == 0 || z[k] > z[k - 1]);
        in[rc_body_material(&coating, z[k])]++;
        assert_int_equal(rc_stress_slice(stress, z[k], s, &err), RC_OK);
        found = larger(found, largest_of(n, m));
    }
    for (int k = 0; k < MEDIA; k++)
        assert_true(in[k] >= 4);
    for (int k = 0; k + 1 < MEDIA; k++) {
        size_t sides = 0;
        bottom += three[k].thickness;
        for (size_t i = 0; i < count; i++)
            sides += fabs(z[i] / bottom - 1) < 2e-6;
        assert_int_equal(sides, 2);
    }
    for (double d = 0; d < 20e-6; d += 0.1e-6) {
        assert_int_equal(rc_stress_slice(stress, d, s, &err), RC_OK);
        most = larger(most, largest_of(n, m));
    }
    print_message("%zu depths, largest Mises %.4f of a scan's\n", count, found / most);
    assert_true(found >= 0.98 * most);
    assert_true(count < 80);
    free(z);
    assert_int_equal(rc_stress_depths(NULL, &shape, p, RC_FREE, &rigid, &z, &count, &err), RC_OK);
    assert_true(fabs(z[count - 1] / bottom - 1) <= rounding);
    free(z);
    rc_stress_free(stress);
    free(p);
    free(m);
}

/* There are no stresses inside a rigid substrate, but on its face. Invalid options are refused. */
static void
refused(void **state)
{
    const struct rc_layer layer = {1e-6, 1e9, 0.4}, nothing = {0, 1e9, 0.4};
    struct rc_body rigid = {INFINITY, 0.3, 1, &layer};
    const struct rc_shape shape = {4, 4, 1e-6, 1e-6};
    double p[16] = {1}, v[16] = {NAN}, *s[RC_STRESSES] = {[RC_SZZ] = v};
    struct rc_stress_options o = {.wanted = 1 << RC_SZZ, .body = rigid, .threads = 1};
    struct rc_err err;

    (void)state;
    for (int b = 0; b < BOUNDARIES; b++) {
        struct rc_stress *stress;
        o.boundary = each_boundary[b];
        stress = rc_stress_new(&shape, p, &o, &err);
        assert_non_null(stress);
        assert_int_equal(rc_stress_slice(stress, 1e-6, s, &err), RC_OK);
        assert_true(v[0] < 0);
        assert_int_equal(rc_stress_slice(stress, 1.1e-6, s, &err), RC_FAIL);
        assert_non_null(strstr(err.text, "rigid"));
        rc_stress_free(stress);
    }
    o.body.layer = &nothing;
    assert_null(rc_stress_new(&shape, p, &o, &err));
    assert_string_equal(err.text, "layer 1 is 0 m thick: it must be positive and finite");
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bonded),
        cmocka_unit_test(wave_in_equilibrium),
        cmocka_unit_test(extreme_stacks),
        cmocka_unit_test(free_is_periodic_far_apart),
        cmocka_unit_test(every_depth_carries_the_load),
        cmocka_unit_test(maps_in_equilibrium),
        cmocka_unit_test(maps_bonded),
        cmocka_unit_test(chosen_depths),
        cmocka_unit_test(refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
