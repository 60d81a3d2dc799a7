/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Of a load that is a wave along one axis and a cell along the other, the displacements and stresses are the
 * integrals of point loads: closed forms, Bessel functions, and sums over the points of real space. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/line_truth.h"
#include "libcontact/body/line.h"
#include "tests/body_case.h"
#include "tests/wave_load.h"

/* The largest error over the largest value; a number that is not finite is an infinite error. */
struct error {
    double off, largest;
};

static void
compare(struct error *e, double value, double truth)
{
    e->off = larger(e->off, isfinite(value) && isfinite(truth) ? fabs(value - truth) : INFINITY);
    e->largest = fmax(e->largest, fabs(truth));
}

static void
within(const char *what, const struct error *e, double bound)
{
    print_message("%s: error %.1e of the largest value\n", what, e->off / e->largest);
    assert_true(e->off <= bound * e->largest);
}

/* Both axes: the kernel with x and y exchanged. */
static void
line_of(const struct rc_kernel *kernel, bool along_x, const struct rc_line_at *at, double *out)
{
    struct rc_err err;

    assert_int_equal(rc_kernel_line(kernel, along_x, at, out, &err), RC_OK);
}

/* ---- displacements ---- */

/* Integrals over y of 1/r, x^2/r^3, x y/r^3, y/r^2 and x/r^2, times cos(Q y), or sin(Q y) for those odd in y,
 * z = Q x: Gradshteyn and Ryzhik 3.754, 3.723 and their derivatives. */
static double
z_k1(double z)
{
    return fabs(z) > 700 ? 0 : 2 * fabs(z) * gsl_sf_bessel_K1(fabs(z));
}

static double
z_k0(double z)
{
    return z == 0 ? 0 : z * k0(z);
}

static double
decay(double z)
{
    return exact_pi * exp(-fabs(z));
}

static double
odd_decay(double z)
{
    return z < 0 ? -decay(z) : decay(z);
}

static const double waves[] = {1e-5, 3e-3, 0.012, 0.11, 0.2, 0.9, 7}; /* Q d */
static const struct rc_line_at grids[] = {
    {.cell = 1.3e-6, .step = 1, .n = 130}, {.cell = 0.4, .step = 3, .n = 21}, {7, 1, 1, 0, 0}};

enum {
    WAVES = sizeof waves / sizeof *waves,
    GRIDS = sizeof grids / sizeof *grids
};

/* Two half-spaces of one material under pressure: K0; F(z) of a strip is its integral. */
static void
surface_under_a_wave(void **state)
{
    const double estar = 3.7;
    struct error e = {0, 0};
    struct body_case c;
    double out[MOST];

    (void)state;
    surface_case(&c, (struct rc_pair){.estar = estar});
    for (int g = 0; g < GRIDS; g++)
        for (int m = 0; m < WAVES; m++) {
            struct rc_line_at at = grids[g];
            struct error one = {0, 0};
            at.wave = waves[m] / at.cell;
            line_of(&c.kernel, m % 2 == 0, &at, out);
            for (size_t i = 0; i < at.n; i += 1 + i / 4)
                compare(&one, out[i], cell(k0, at.cell, at.wave, i * at.step) / (exact_pi * estar));
            e.off = larger(e.off, one.off / one.largest);
        }
    e.largest = 1;
    within("a uniform body under a wave", &e, summed);
    body_case_free(&c);
}

/* Without a wave: logarithms, 0 at the datum. */
static void
surface_without_a_wave(void **state)
{
    const double estar = 0.23;
    struct error e = {0, 0};
    struct body_case c;
    double out[MOST];

    (void)state;
    surface_case(&c, (struct rc_pair){.estar = estar});
    for (int g = 0; g < GRIDS; g++)
        for (double datum = 1e-2; datum < 1e8; datum *= 317) {
            struct rc_line_at at = grids[g];
            struct error one = {0, 0};
            at.n = at.n == 130 ? 1025 : at.n;
            at.datum = datum * at.cell;
            line_of(&c.kernel, g == 0, &at, out);
            for (size_t i = 0; i < at.n; i++)
                compare(&one, out[i],
                        -2 * at.cell / (exact_pi * estar) *
                            log_cell((double)(i * at.step), at.cell, at.datum));
            e.off = larger(e.off, one.off / one.largest);
        }
    e.largest = 1;
    within("a uniform body without a wave", &e, summed);
    body_case_free(&c);
}

/* The tractions of shear.c, as sums of these integrals; y^2/r^3 is 1/r - x^2/r^3. */
static double
shear_truth(const struct rc_shear *s, int kernel, double d, double wave, size_t node)
{
    double scale = 1 / (exact_pi * s->estar), whole, part;

    switch (kernel) {
    case RC_SHEAR_XX:
    case RC_SHEAR_YY:
        whole = cell(k0, d, wave, node);
        part = cell(z_k1, d, wave, node);
        return scale * (whole + s->kap * (kernel == RC_SHEAR_XX ? part : whole - part));
    case RC_SHEAR_XY:
        return scale * s->kap * cell(z_k0, d, wave, node);
    case RC_SHEAR_XZ:
        return scale * s->beta * cell(odd_decay, d, wave, node);
    default:
        return scale * s->beta * cell(decay, d, wave, node);
    }
}

static const int exchanged_shear[RC_SHEAR_KERNELS] = {RC_SHEAR_YY, RC_SHEAR_XX, RC_SHEAR_XY,
                                                      RC_SHEAR_YZ, RC_SHEAR_XZ};

static void
shear_under_a_wave(void **state)
{
    const struct rc_shear shear = {2.1, 0.37, 0.21};
    double out[MOST];

    (void)state;
    for (int k = 0; k < RC_SHEAR_KERNELS; k++) {
        static const char *const name[] = {"shear XX", "shear YY", "shear XY", "shear XZ",
                                           "shear YZ"};
        struct error e = {0, 0};
        for (int m = 0; m < WAVES - 1; m++)
            for (int turned = 0; turned < 2; turned++) {
                const struct rc_shear_field field = {&shear, turned ? exchanged_shear[k] : k};
                const struct rc_kernel kernel = rc_shear_kernel(&field);
                struct rc_line_at at = grids[m % 2];
                struct error one = {0, 0};
                at.wave = waves[m] / at.cell;
                line_of(&kernel, !turned, &at, out);
                for (size_t i = 0; i < at.n; i += 1 + i / 4)
                    compare(&one, out[i], shear_truth(&shear, k, at.cell, at.wave, i * at.step));
                e.off = larger(e.off, one.off / one.largest);
            }
        e.largest = 1;
        within(name[k], &e, summed);
    }
}

/* Without a wave: logarithms for the tractions, and a step, beta/E* on each side of a line of pressure. */
static void
shear_without_a_wave(void **state)
{
    const struct rc_shear shear = {2.1, 0.37, 0.21};
    const double d = 0.4, factor[] = {1, 1 + shear.kap, 0, 0, 0};
    const struct rc_line_at at = {d, 1, 100, 0, 33};
    double out[MOST];

    (void)state;
    for (int k = 0; k < RC_SHEAR_KERNELS; k++)
        for (int turned = 0; turned < 2; turned++) {
            const struct rc_shear_field field = {&shear, turned ? exchanged_shear[k] : k};
            const struct rc_kernel kernel = rc_shear_kernel(&field);
            line_of(&kernel, !turned, &at, out);
            for (size_t i = 0; i < at.n; i++) {
                double truth = -2 * d * factor[k] / (exact_pi * shear.estar) *
                               log_cell((double)i, d, at.datum);
                if (k == RC_SHEAR_XZ)
                    truth = i == 0 ? 0 : shear.beta * d / shear.estar;
                assert_true(fabs(out[i] - truth) <= summed * d / shear.estar);
            }
        }
}

/* ---- layers ---- */

static void
coats(void **state)
{
    static const double thickness[] = {0.01, 0.4, 5, 1000}, ratio[] = {1 / 400.0, 0.1, 12, 400};
    static const double wave[] = {0, 0.012, 0.6};
    struct error e = {0, 0};
    double out[MOST];

    (void)state;
    for (int t = 0; t < 4; t++)
        for (int r = 0; r < 4; r++) {
            const struct rc_layer layer[] = {{thickness[t], 2 * ratio[r], 0.2},
                                             {2 * thickness[t], 2 * sqrt(ratio[r]), 0.4}};
            const struct rc_body body = {
                .e = 2, .nu = 0.3, .layer = layer, .layers = 1 + (size_t)(t + r) % 2};
            struct body_case c;
            struct rc_err err;
            RC_OWN(rc_stack, stack) = rc_stack_new(&body, &err);
            assert_non_null(stack);
            surface_case(&c, (struct rc_pair){.one = body});
            for (int m = 0; m < 3; m++) {
                struct rc_line_at at = {1, 1, 300, wave[m], 300};
                struct error one = {0, 0};
                line_of(&c.kernel, true, &at, out);
                for (size_t i = 0; i < 3; i++)
                    compare(&one, out[i], coat_truth(stack, 1, at.wave, at.datum, i));
                if (thickness[t] >= 0.4)
                    compare(&one, out[9], coat_truth(stack, 1, at.wave, at.datum, 9));
                e.off = larger(e.off, one.off / one.largest);
            }
            body_case_free(&c);
        }
    e.largest = 1;
    within("coats", &e, summed);
}

/* ---- stresses without a wave ---- */

/* Under a unit load on a line along y, plane or antiplane strain (Flamant; Johnson 1985, eqs. 2.15, 2.17): a
 * pressure, a traction along x, a traction along y. */
static double
line_stress(int kernel, double nu, double x, double z)
{
    double r2 = x * x + z * z, f = -2 / (exact_pi * r2 * r2), s = kernel >= RC_COMPONENTS ? x : z;

    switch (kernel) {
    case RC_SXX:
    case RC_COMPONENTS + RC_SXX:
        return f * s * x * x;
    case RC_SYY:
    case RC_COMPONENTS + RC_SYY:
        return f * s * r2 * nu;
    case RC_SZZ:
    case RC_COMPONENTS + RC_SZZ:
        return f * s * z * z;
    case RC_SXZ:
    case RC_COMPONENTS + RC_SXZ:
        return f * s * x * z;
    case 2 * RC_COMPONENTS + RC_SXY:
        return f * r2 * x / 2;
    case 2 * RC_COMPONENTS + RC_SYZ:
        return f * r2 * z / 2;
    default:
        return 0;
    }
}

struct point {
    int kernel;
    double nu, x, z;
};

static double
line_stress_at(double u, void *of)
{
    const struct point *p = of;

    return line_stress(p->kernel, p->nu, p->x - u, p->z);
}

/* The kernel with x and y exchanged. */
static int
exchanged(int kernel)
{
    static const int load[] = {RC_NORMAL, RC_TURNED, RC_SHEAR};

    return load[kernel / RC_COMPONENTS] * RC_COMPONENTS +
           (int)rc_stress_exchanged[kernel % RC_COMPONENTS];
}

struct stresses {
    double v[RC_STRESS_KERNELS][MOST], *out[RC_STRESS_KERNELS];
};

/* All 18 kernels, with the free axis along y exchanged with those along x. */
static void
stress_lines(const struct rc_inside *inside, bool along_x, const struct rc_line_at *at,
             struct stresses *s)
{
    struct rc_err err;

    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        s->out[along_x ? k : exchanged(k)] = s->v[k];
    assert_int_equal(
        rc_inside_lines(inside, (1u << RC_STRESS_KERNELS) - 1, along_x, at, INFINITY, s->out, &err),
        RC_OK);
}

static void
stresses_without_a_wave(void **state)
{
    static const double depths[] = {0, 1e-3, 0.03, 0.5, 11, 130};
    static struct stresses s;
    const struct rc_body body = {.e = 1, .nu = 0.28};

    (void)state;
    for (int z = 0; z < 6; z++) {
        const double d = 0.7, depth = depths[z] * d;
        const struct rc_line_at at = {d, 1, 160, 0, 0}; /* a stress needs no datum */
        struct error e = {0, 0};
        struct body_case c;
        stress_case(&c, body, depth, RC_PERIODIC, 0);
        stress_lines(c.inside, z % 2 == 0, &at, &s);
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            for (size_t i = 0; i < at.n; i += 1 + i / 3) {
                struct point p = {k, body.nu, (double)i * d, depth};
                gsl_function f = {line_stress_at, &p};
                double truth = 0, part, error;
                if (depth > 0 || i > 0)
                    for (int half = -1; half < 1; half++) {
                        gsl_integration_qag(&f, half * d / 2, (half + 1) * d / 2, 1e-16, 1e-13,
                                            MOST, GSL_INTEG_GAUSS61, space, &part, &error);
                        truth += part;
                    }
                else if (k == RC_SXX || k == RC_SZZ || k == RC_COMPONENTS + RC_SXZ ||
                         k == 2 * RC_COMPONENTS + RC_SYZ)
                    truth = -1; /* below the cell itself, at the surface */
                else if (k == RC_SYY)
                    truth = -2 * body.nu;
                compare(&e, s.v[k][i], truth);
            }
        print_message("depth %g: ", depths[z]);
        within("stresses without a wave", &e, summed);
        body_case_free(&c);
    }
}

/* ---- stresses under a wave, in real space ---- */

static void
stresses_under_a_wave(void **state)
{
    static const struct {
        double wave, depth;
        size_t node[3];
    } at[] = {
        {1.1, 0.6, {0, 1, 5}}, {0.13, 3, {0, 4, 40}}, {2.7, 1e-3, {1, 2, 3}}, {0.4, 0, {1, 2, 6}}};
    static struct stresses s;
    const struct rc_body body = {.e = 1, .nu = 0.28};

    (void)state;
    for (int n = 0; n < 4; n++) {
        const double d = 1.4;
        const struct rc_line_at line = {d, 1, 60, at[n].wave / d, 0};
        struct error e = {0, 0};
        struct body_case c;
        stress_case(&c, body, at[n].depth * d, RC_PERIODIC, 0);
        stress_lines(c.inside, n % 2 == 0, &line, &s);
        for (int i = 0; i < 3; i++) {
            double truth[RC_STRESS_KERNELS];
            wave_load_stress(body.nu, d, line.wave, (double)at[n].node[i] * d, at[n].depth * d,
                             truth);
            for (int k = 0; k < RC_STRESS_KERNELS; k++)
                compare(&e, s.v[k][at[n].node[i]], truth[k]);
        }
        print_message("depth %g, wave %g: ", at[n].depth, at[n].wave);
        within("stresses under a wave", &e, summed);
        body_case_free(&c);
    }
}

/* ---- the kernels of real space ---- */

/* The sum over y of the rows of a kernel for cells d by h, which are means over h: divided by sinc(Q h/2). */
static void
by_rows(const struct rc_kernel *kernel, double d, double wave, size_t n, double h, double *sum)
{
    const struct rc_lattice at = {d, h, 1, 1};
    double row[MOST];

    memset(sum, 0, n * sizeof *sum);
    for (size_t j = 0; (double)j * h * wave < sum_end; j++) {
        double y = (double)j * h, half = wave * h / 2;
        double weight = (j == 0 ? 1 : 2) * end_of_sum(wave, y) * half / sin(half);
        kernel->rows(kernel->of, &at, n, j, j + 1, row);
        weight *= kernel->parity & RC_ODD_Y ? sin(wave * y) : cos(wave * y);
        for (size_t i = 0; i < n; i++)
            sum[i] += weight * row[i];
    }
}

/* Lines and rows belong to one kernel, signs included. The node on the cell itself is left out, where the sum
 * over y does not converge so fast. */
static void
lines_are_sums_of_rows(void **state)
{
    const struct rc_layer layer[] = {{0.3, 3, 0.2}, {2, 0.1, 0.4}};
    const struct rc_pair pairs[] = {{.estar = 0.7},
                                    {.one = {.e = 2, .nu = 0.3, .layer = layer, .layers = 2}}};
    const struct rc_shear shear = {2.1, 0.37, 0.21};
    const struct rc_line_at at = {1.25, 1, 6, 0.9, 0};
    double line[MOST], rows[MOST];

    (void)state;
    for (int k = 0; k < 2 + RC_SHEAR_KERNELS; k++) {
        const struct rc_shear_field field = {&shear, (enum rc_shear_which)(k < 2 ? 0 : k - 2)};
        struct error e = {0, 0};
        struct body_case c = {.inside = NULL};
        if (k < 2)
            surface_case(&c, pairs[k]);
        else
            c.kernel = rc_shear_kernel(&field);
        line_of(&c.kernel, true, &at, line);
        by_rows(&c.kernel, at.cell, at.wave, at.n, at.cell / 12, rows);
        for (size_t i = 1; i < at.n; i++)
            compare(&e, line[i], rows[i]);
        print_message("kernel %d: ", k);
        within("by rows", &e, summed);
        body_case_free(&c);
    }
}

/* ---- stresses of layers ---- */

struct inside_wave {
    const struct rc_kernel *kernel;
    double d, x;
};

static double
inside_wave(double q, void *of)
{
    const struct inside_wave *w = of;
    double half = q * w->d / 2, phase = q * w->x;

    return w->kernel->symbol(w->kernel->of, q, 0) * w->d * sin(half) / half *
           (w->kernel->parity & RC_ODD_X ? sin(phase) : cos(phase)) / exact_pi;
}

/* The integral over the waves, which decrease as exp(-q z). Those that are odd along y are 0. */
static double
by_waves(const struct rc_inside *inside, int kernel, double d, double x)
{
    const struct rc_stress_field field = {inside, kernel};
    const struct rc_kernel k = rc_stress_field_kernel(&field);
    struct inside_wave w = {&k, d, x};
    gsl_function f = {inside_wave, &w};
    double sum = 0, part, error, last = 45 / inside->depth;

    if (k.parity & RC_ODD_Y)
        return 0;
    for (double from = 0, to = last * 1e-7; from < last; from = to, to = fmin(7 * to, last)) {
        gsl_integration_qag(&f, from, to, 1e-15, 1e-13, MOST, GSL_INTEG_GAUSS61, space, &part,
                            &error);
        sum += part;
    }
    return sum;
}

/* The sum over y of coefficients of cells d by h, which are means over h: divided by sinc(Q h/2). */
static void
by_cells(const struct rc_inside *inside, double d, double wave, size_t n, double h,
         double sum[RC_STRESS_KERNELS][MOST])
{
    const struct rc_cell c = {d, h};
    static struct stresses one;

    for (int k = 0; k < RC_STRESS_KERNELS; k++) {
        one.out[k] = one.v[k];
        memset(sum[k], 0, n * sizeof *sum[k]);
    }
    for (size_t j = 0; (double)j * h * wave < sum_end; j++) {
        double y = (double)j * h, half = wave * h / 2;
        double weight = (j == 0 ? 1 : 2) * end_of_sum(wave, y) * half / sin(half);
        inside->type->line(inside, &c, (1u << RC_STRESS_KERNELS) - 1, d, n, y, one.out);
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            for (size_t i = 0; i < n; i++)
                sum[k][i] += weight * one.v[k][i] *
                             (rc_stress_parity[k] & RC_ODD_Y ? sin(wave * y) : cos(wave * y));
    }
}

static void
stresses_of_layers(void **state)
{
    static const struct rc_layer layers[][2] = {{{2, 400, 0.2}, {1, 3, 0.4}},
                                                {{0.3, 1 / 400.0, 0.45}, {4, 9, 0.1}},
                                                {{70, 5, 0.3}, {3, 0.1, 0.3}}};
    static const double depths[] = {0.9, 2.4, 80};
    static struct stresses s, truth;

    (void)state;
    for (int b = 0; b < 3; b++)
        for (int z = 0; z < 3; z++) {
            const struct rc_body body = {.e = 1, .nu = 0.28, .layer = layers[b], .layers = 2};
            struct rc_line_at at = {1, 1, 30, 0, 1};
            struct error e = {0, 0};
            struct body_case c;
            stress_case(&c, body, depths[z], RC_FREE, 0);
            stress_lines(c.inside, true, &at, &s);
            for (int k = 0; k < RC_STRESS_KERNELS; k++)
                for (size_t i = 0; i < at.n; i += 7)
                    compare(&e, s.v[k][i], by_waves(c.inside, k, at.cell, (double)i));
            print_message("layers %d, depth %g: ", b, depths[z]);
            within("by waves", &e, summed);
            e = (struct error){0, 0};
            at.wave = 1.1 / depths[z];
            at.n = 5;
            stress_lines(c.inside, false, &at, &s);
            by_cells(c.inside, at.cell, at.wave, at.n, depths[z] / 6, truth.v);
            for (int k = 0; k < RC_STRESS_KERNELS; k++)
                for (size_t i = 0; i < at.n; i++)
                    compare(&e, s.v[k][i], truth.v[k][i]);
            print_message("layers %d, depth %g: ", b, depths[z]);
            within("by cells", &e, summed);
            body_case_free(&c);
        }
}

/* ---- laws ---- */

/* Layers of one material do not matter. */
static void
layers_of_one_material(void **state)
{
    const struct rc_layer layer[] = {{0.02, 3, 0.31}, {50, 3, 0.31}};
    const struct rc_body bare = {.e = 3, .nu = 0.31};
    const struct rc_body body = {.e = 3, .nu = 0.31, .layer = layer, .layers = 2};
    static struct stresses s, t;
    double one[MOST], two[MOST];

    (void)state;
    for (int m = 0; m < WAVES; m++) {
        const struct rc_line_at at = {1, 1, 40, m == 0 ? 0 : waves[m], 21};
        struct body_case c, d;
        struct error e = {0, 0};
        surface_case(&c, (struct rc_pair){.one = bare});
        surface_case(&d, (struct rc_pair){.one = body});
        line_of(&c.kernel, true, &at, one);
        line_of(&d.kernel, true, &at, two);
        for (size_t i = 0; i < at.n; i++)
            compare(&e, two[i], one[i]);
        assert_true(e.off <= summed * e.largest);
        body_case_free(&c);
        body_case_free(&d);
        stress_case(&c, bare, 0.7, RC_PERIODIC, 0);
        stress_case(&d, body, 0.7, RC_PERIODIC, 0);
        stress_lines(c.inside, true, &at, &s);
        stress_lines(d.inside, true, &at, &t);
        e = (struct error){0, 0};
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            for (size_t i = 0; i < at.n; i++)
                compare(&e, t.v[k][i], s.v[k][i]);
        assert_true(e.off <= summed * e.largest);
        body_case_free(&c);
        body_case_free(&d);
    }
}

/* The sum over all nodes is the symbol of the wave that is constant along the free axis. */
static void
sums_are_symbols(void **state)
{
    const struct rc_layer layer = {1.7, 90, 0.2};
    const struct rc_body bodies[] = {{.e = 1, .nu = 0.3},
                                     {.e = 1, .nu = 0.3, .layer = &layer, .layers = 1}};
    double out[MOST];

    (void)state;
    for (int b = 0; b < 2; b++)
        for (int k = -1; k < RC_STRESS_KERNELS; k++) {
            const struct rc_line_at at = {1.25, 1, 500, 0.08, 0};
            struct body_case c;
            double sum = 0, all;
            if (k < 0)
                surface_case(&c, (struct rc_pair){.one = bodies[b]});
            else
                stress_case(&c, bodies[b], 0.4, RC_PERIODIC, k);
            line_of(&c.kernel, true, &at, out);
            all = fabs(out[0]);
            for (size_t i = 1; i < at.n && !(c.kernel.parity & RC_ODD_X); i++) {
                sum += 2 * out[i];
                all += 2 * fabs(out[i]);
            }
            assert_true(fabs(sum + out[0] - c.kernel.symbol(c.kernel.of, 0, at.wave)) <=
                        summed * all);
            body_case_free(&c);
        }
}

/* The transforms of a period of coefficients, of any number of nodes and cells from node to node. */
static void
spectra_are_transforms(void **state)
{
    static const struct {
        size_t step, n; /* n: nodes of a period */
        double wave, depth;
    } at[] = {{1, 64, 1.3, 0}, {1, 64, 1.3, 0.6}, {1, 45, 2, 0.3},
              {3, 40, 0.7, 5}, {4, 21, 1, 9},     {1, 2, 80, 0.05}};
    static struct stresses s, t;
    const struct rc_layer layer = {1.7, 90, 0.2};
    const struct rc_body bodies[] = {{.e = 1, .nu = 0.3},
                                     {.e = 1, .nu = 0.3, .layer = &layer, .layers = 1}};
    const unsigned all = (1u << RC_STRESS_KERNELS) - 1;

    (void)state;
    for (size_t n = 0; n < 4 * sizeof at / sizeof *at; n++) {
        const bool along_x = n % 2;
        struct rc_line_at line = {1.1, at[n / 4].step, at[n / 4].n, at[n / 4].wave, 0};
        struct error e = {0, 0};
        struct body_case c;
        struct rc_err err;
        stress_case(&c, bodies[n / 2 % 2], at[n / 4].depth, RC_PERIODIC, 0);
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            t.out[k] = t.v[k];
        assert_true(rc_line_decays(&line));
        assert_int_equal(rc_inside_spectra(c.inside, all, along_x, &line, INFINITY, t.out, &err),
                         RC_OK);
        line.n = line.n / 2 + 1;
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            s.out[k] = s.v[k];
        assert_int_equal(rc_inside_lines(c.inside, all, along_x, &line, INFINITY, s.out, &err),
                         RC_OK);
        for (int k = 0; k < RC_STRESS_KERNELS; k++) {
            const bool odd = rc_stress_parity[k] & (along_x ? RC_ODD_X : RC_ODD_Y);
            for (size_t q = 0; q < line.n; q++) {
                double sum = odd ? 0 : s.v[k][0];
                for (size_t i = 1; i < line.n; i++) {
                    const double phase = 2 * exact_pi * (double)(i * q) / (double)at[n / 4].n;
                    sum += (2 * i == at[n / 4].n ? 1 : 2) * s.v[k][i] *
                           (odd ? sin(phase) : cos(phase));
                }
                compare(&e, t.v[k][q], sum);
            }
        }
        assert_true(e.off <= summed * e.largest);
        body_case_free(&c);
    }
}

/* ---- callers ---- */

/* Several threads get the numbers that one gets, and a kernel alone those that it has with others. */
static void
calls(void **state)
{
    enum {
        CALLS = 600,
        NODES = 9
    };
    static double alone[CALLS][NODES], together[CALLS][NODES];
    const struct rc_body body = {.e = 1, .nu = 0.28};
    static struct stresses s;
    struct body_case c;

    (void)state;
    stress_case(&c, body, 0.3, RC_PERIODIC, RC_SXX);
    for (int m = 0; m < CALLS; m++) {
        const struct rc_line_at at = {1, 1, NODES, m * 0.01, 1};
        stress_lines(c.inside, true, &at, &s);
        memcpy(alone[m], s.v[RC_SXX], sizeof alone[m]);
    }
#pragma omp parallel for schedule(dynamic) num_threads(4)
    for (int m = 0; m < CALLS; m++) {
        const struct rc_line_at at = {1, 1, NODES, m * 0.01, 1};
        double *out[RC_STRESS_KERNELS] = {together[m]};
        struct rc_err err;
        (void)rc_inside_lines(c.inside, 1u << RC_SXX, true, &at, INFINITY, out, &err);
    }
    assert_memory_equal(alone, together, sizeof alone);
    body_case_free(&c);
}

/* With too little for each block in turn; nothing is kept. */
static void
memory_is_short(void **state)
{
    const struct rc_line_at at = {1, 1, 40000, 0, 1};
    struct body_case c;
    double *out = malloc(at.n * sizeof *out);
    enum rc_status status = RC_FAIL;
    struct rc_err err;
    size_t held, failed = 0;

    (void)state;
    assert_non_null(out);
    surface_case(&c, (struct rc_pair){.estar = 1});
    held = rc_memory_held().held;
    for (size_t more = 1; status != RC_OK; more += 400000, failed++) {
        rc_memory_budget(held + more);
        status = rc_kernel_line(&c.kernel, true, &at, out, &err);
        assert_true(rc_memory_held().held == held);
    }
    rc_memory_budget(0);
    assert_true(failed > 3);
    assert_string_equal(err.text, "out of memory for the coefficients of 40000 nodes");
    body_case_free(&c);
    free(out);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(surface_under_a_wave),
        cmocka_unit_test(surface_without_a_wave),
        cmocka_unit_test(shear_under_a_wave),
        cmocka_unit_test(shear_without_a_wave),
        cmocka_unit_test(coats),
        cmocka_unit_test(stresses_without_a_wave),
        cmocka_unit_test(stresses_under_a_wave),
        cmocka_unit_test(lines_are_sums_of_rows),
        cmocka_unit_test(stresses_of_layers),
        cmocka_unit_test(layers_of_one_material),
        cmocka_unit_test(sums_are_symbols),
        cmocka_unit_test(spectra_are_transforms),
        cmocka_unit_test(calls),
        cmocka_unit_test(memory_is_short),
    };

    return cmocka_run_group_tests(tests, line_begin, line_end);
}
