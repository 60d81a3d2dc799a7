/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Criteria of fatigue agree with closed forms: bending, torsion, uniaxial and combined cycles, in and out of
 * phase; rolling and sliding line contact (Johnson 1985, 4.49 and 7.8); a rolling ball. The smallest ball is
 * that of the best subset of the points, and Findley's plane is not worse than any of a brute search. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"
#include "libcontact/fatigue/fatigue.h"

static const double pi = 3.14159265358979323846;
static const unsigned all_four =
    1U << RC_CROSSLAND | 1U << RC_DANG_VAN | 1U << RC_PAPADOPOULOS | 1U << RC_FINDLEY;
/* Nishihara and Kawamoto's hard steel, Pa */
static const struct rc_fatigue_limits steel = {313.9e6, 196.2e6, 0};

/* ---- tension and torsion ---- */

enum {
    CYCLE = 720
};

/* The indices of tension s sin + mean with torsion t sin of another phase (degrees). */
static void
cycle(const struct rc_fatigue_limits *limits, double s, double mean, double t, double phase,
      double values[RC_FATIGUES])
{
    static double zero[CYCLE], tension[CYCLE], torsion[CYCLE];
    const double *const path[RC_COMPONENTS] = {tension, zero, zero, torsion, zero, zero};
    struct rc_err err;

    for (int k = 0; k < CYCLE; k++) {
        double a = 2 * pi * k / CYCLE;
        tension[k] = mean + s * sin(a);
        torsion[k] = t * sin(a - phase * pi / 180);
    }
    assert_int_equal(rc_fatigue_history(all_four, limits, true, CYCLE, path, values, &err), RC_OK);
}

static void
near(double value, double expected, double tol, const char *what)
{
    if (!(fabs(value - expected) <= tol))
        fail_msg("%s: %.9g instead of %.9g", what, value, expected);
}

static void
calibration(void **state)
{
    double v[RC_FATIGUES];
    (void)state;

    cycle(&steel, steel.bending, 0, 0, 0, v);
    for (int c = 0; c < RC_SHAKEDOWN; c++)
        near(v[c], 1, 1e-5, "reversed bending");
    cycle(&steel, 0, 0, steel.torsion, 0, v);
    for (int c = 0; c < RC_SHAKEDOWN; c++)
        near(v[c], 1, 1e-5, "reversed torsion");
    assert_true(isnan(v[RC_SHAKEDOWN]) && isnan(v[RC_AMPLITUDE]));
}

/* Tension from 0 to twice its amplitude. */
static void
repeated(void **state)
{
    const double f = steel.bending, t = steel.torsion, s = 100e6, r = f / t;
    const double k = (2 - r) / (2 * sqrt(r - 1)), limit = f / (2 * sqrt(r - 1));
    double v[RC_FATIGUES];
    (void)state;

    cycle(&steel, s, s, 0, 0, v);
    near(v[RC_CROSSLAND], (s / sqrt(3) + (3 * t / f - sqrt(3)) * 2 * s / 3) / t, 1e-5, "Crossland");
    near(v[RC_DANG_VAN], (s / 2 + (3 * t / f - 1.5) * 2 * s / 3) / t, 1e-5, "Dang Van");
    near(v[RC_PAPADOPOULOS], v[RC_CROSSLAND], 1e-5, "Papadopoulos");
    near(v[RC_FINDLEY], s / 2 * (2 * k + sqrt(1 + 4 * k * k)) / limit, 1e-5, "Findley");
}

static void
combined(void **state)
{
    const double f = steel.bending, t0 = steel.torsion, s = 180e6, t = 110e6, r = f / t0;
    const double k_h = 3 * t0 / f - sqrt(3), k_d = 3 * t0 / f - 1.5;
    const double k = (2 - r) / (2 * sqrt(r - 1)), limit = f / (2 * sqrt(r - 1));
    double v[RC_FATIGUES], largest = 0;
    (void)state;

    cycle(&steel, s, 0, t, 0, v);
    near(v[RC_CROSSLAND], (sqrt(s * s / 3 + t * t) + k_h * s / 3) / t0, 1e-5,
         "in phase, Crossland");
    near(v[RC_PAPADOPOULOS], v[RC_CROSSLAND], 1e-5, "in phase, Papadopoulos");
    near(v[RC_DANG_VAN], (sqrt(s * s / 4 + t * t) + k_d * s / 3) / t0, 1e-5, "in phase, Dang Van");
    { /* Mohr's circle: radius r, centre s/2; largest of r sin(a) + k (s/2 + r cos(a)) */
        double radius = sqrt(s * s / 4 + t * t);
        near(v[RC_FINDLEY], (radius * sqrt(1 + k * k) + k * s / 2) / limit, 1e-5,
             "in phase, Findley");
    }
    cycle(&steel, s, 0, t, 90, v);
    near(v[RC_CROSSLAND], (fmax(s / sqrt(3), t) + k_h * s / 3) / t0, 1e-5, "90 degrees, Crossland");
    for (int n = 0; n < CYCLE; n++) {
        double a = 2 * pi * n / CYCLE, x = s * sin(a), y = t * cos(a);
        largest = fmax(largest, sqrt(x * x / 4 + y * y) + k_d * x / 3);
    }
    near(v[RC_DANG_VAN], largest / t0, 1e-5, "90 degrees, Dang Van");
    for (int phase = 0; phase <= 180; phase += 15) {
        cycle(&steel, s, 0, t, phase, v);
        near(v[RC_PAPADOPOULOS], (sqrt(s * s / 3 + t * t) + k_h * s / 3) / t0, 1e-5,
             "Papadopoulos at any phase");
    }
}

/* Tests at the endurance limit (MPa, degrees), computed: 100 times the index less 1. */
static void
hard_steel(void **state)
{
    static const double rows[][7] = {
        /* s, t, phase; Papadopoulos, Crossland, Dang Van, Findley */
        {138.1, 167.1, 0, -2.3, -2.3, 1.0, 1.0},  {140.4, 169.9, 30, -0.6, -2.5, 0.3, 2.5},
        {145.7, 176.3, 60, 3.1, -3.6, -2.4, 5.9}, {150.2, 181.7, 90, 6.3, -3.7, -6.8, 8.8},
        {245.3, 122.6, 0, 1.4, 1.4, 4.0, 4.0},    {249.7, 124.8, 30, 3.3, 0.0, 2.4, 4.7},
        {252.4, 126.2, 60, 4.4, -8.3, -6.8, 1.5}, {258, 129, 90, 6.7, -17.8, -17.8, -3.5},
        {299.1, 62.8, 0, 0.9, 0.9, 1.7, 1.7},     {304.5, 63.9, 90, 2.7, -3.0, -3.0, -1.3}};
    static const int column[] = {RC_PAPADOPOULOS, RC_CROSSLAND, RC_DANG_VAN, RC_FINDLEY};
    (void)state;

    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        double v[RC_FATIGUES];
        cycle(&steel, rows[k][0] * 1e6, 0, rows[k][1] * 1e6, rows[k][2], v);
        for (int c = 0; c < 4; c++)
            near(100 * (v[column[c]] - 1), rows[k][3 + c], 0.1, rc_criterion_names[column[c]]);
    }
}

/* ---- line contact ---- */

/* Stresses over p0 under a contact of half-width 1 that also slides, at x and z > 0. */
static void
line_stress(double x, double z, double mu, double nu, double s[RC_COMPONENTS])
{
    const double d = 1 - x * x + z * z, root = hypot(d, 2 * x * z);
    const double m = sqrt((root + d) / 2), n = copysign(sqrt((root - d) / 2), x);
    const double sum = m * m + n * n, zz = (z * z + n * n) / sum;
    const double sx = -(m * (1 + zz) - 2 * z), sz = -m * (1 - zz), t = -n * (m * m - z * z) / sum;

    s[RC_SXX] = sx + mu * (n * (2 - (z * z - m * m) / sum) - 2 * x);
    s[RC_SZZ] = sz + mu * t;
    s[RC_SXZ] = t + mu * sx;
    s[RC_SYY] = nu * (s[RC_SXX] + s[RC_SZZ]);
    s[RC_SXY] = s[RC_SYZ] = 0;
}

static void
line_values(double z, double mu, double nu, unsigned wanted, const struct rc_fatigue_limits *limits,
            bool full, double v[RC_FATIGUES])
{
    enum {
        N = 1201
    };
    static double path[RC_COMPONENTS][N + 1];
    const double *s[RC_COMPONENTS];
    struct rc_err err;

    for (int k = 0; k < N; k++) {
        double one[RC_COMPONENTS];
        line_stress(6 * tan((k - N / 2) * 1.4 / (N / 2.0)) / tan(1.4), z, mu, nu, one);
        for (int c = 0; c < RC_COMPONENTS; c++)
            path[c][k] = one[c];
    }
    for (int c = 0; c < RC_COMPONENTS; c++) {
        path[c][N] = 0;
        s[c] = path[c];
    }
    assert_int_equal(rc_fatigue_history(wanted, limits, full, N + 1, s, v, &err), RC_OK);
}

/* The formula of the test is in equilibrium, and has its load. */
static void
line_formula(void **state)
{
    const double e = 1e-5;
    (void)state;

    for (double x = -1.7; x < 2; x += 0.37)
        for (double z = 0.1; z < 2; z += 0.3) {
            double l[6], r[6], u[6], d[6];
            line_stress(x - e, z, 0.3, 0.3, l);
            line_stress(x + e, z, 0.3, 0.3, r);
            line_stress(x, z - e, 0.3, 0.3, u);
            line_stress(x, z + e, 0.3, 0.3, d);
            near((r[RC_SXX] - l[RC_SXX] + d[RC_SXZ] - u[RC_SXZ]) / e, 0, 1e-6, "equilibrium in x");
            near((r[RC_SXZ] - l[RC_SXZ] + d[RC_SZZ] - u[RC_SZZ]) / e, 0, 1e-6, "equilibrium in z");
        }
}

static void
line(void **state)
{
    static const double ratio[] = {0.577350269189627, 0.62, 0.70};
    static const double dang_van[] = {0.186, 0.158, 0.120}, findley[] = {0.247, 0.243, 0.229};
    double v[RC_FATIGUES], most = 0, depth = 0;
    (void)state;

    for (double z = 0.3; z <= 0.7001; z += 0.01) {
        line_values(z, 0, 0.3, 1U << RC_AMPLITUDE, &steel, true, v);
        if (v[RC_AMPLITUDE] > most) {
            most = v[RC_AMPLITUDE];
            depth = z;
        }
    }
    near(most, 0.25, 1e-4, "amplitude of a line contact");
    near(depth, 0.5, 0.011, "its depth");
    for (int k = 0; k < 3; k++) {
        const struct rc_fatigue_limits l = {1, ratio[k] + 1e-9, 0};
        double full = 0, cut = 0, plane = 0, crossland = 0;
        for (double z = 0.4; z <= 0.9001; z += 0.02) {
            line_values(z, 0, 0.3, 1U << RC_DANG_VAN | 1U << RC_FINDLEY | 1U << RC_CROSSLAND, &l,
                        true, v);
            full = fmax(full, v[RC_DANG_VAN] * l.torsion);
            plane = fmax(plane, v[RC_FINDLEY] * l.torsion);
            crossland = fmax(crossland, v[RC_CROSSLAND] * l.torsion);
            line_values(z, 0, 0.3, 1U << RC_DANG_VAN, &l, false, v);
            cut = fmax(cut, v[RC_DANG_VAN] * l.torsion);
        }
        near(full, dang_van[k], 6e-4, "Dang Van of a line contact");
        near(cut, 0.25, 1e-3, "Dang Van without compression");
        near(crossland, 0.25, 1e-3, "Crossland of a line contact");
        near(plane, findley[k], 6e-4, "Findley of a line contact");
    }
}

/* Largest p0/k that shakes down: Johnson 1985, fig. 9.3. */
static void
line_shakedown(void **state)
{
    static const double mu[] = {0, 0.3, 0.367, 0.4, 0.5}, load[] = {4, 2.90, 2.725, 2.5, 2};
    const struct rc_fatigue_limits k = {0, 0, sqrt(3)};
    (void)state;

    for (int i = 0; i < 5; i++) {
        double most = 0;
        for (double z = 0.001; z < 0.8; z += z < 0.011 ? 0.01 : 0.02) {
            double v[RC_FATIGUES];
            line_values(z, mu[i], 0.5, 1U << RC_SHAKEDOWN, &k, false, v);
            most = fmax(most, v[RC_SHAKEDOWN]);
        }
        near(1 / most, load[i], 0.003 * load[i], "shakedown of a line contact");
    }
}

/* A roller that passes across its axis, on a map that repeats along it: the values of the formula at
 * each depth. The error of the cells is below 1e-3; Dang Van's largest instant lies between two states.
 * A pass along the axis changes no stress. */
static void
roller(void **state)
{
    enum {
        NX = 480,
        NY = 3,
        A = 40 /* half-width in nodes */
    };
    static double p[2][NX * NY], v[RC_FATIGUES][NX];
    static const double depths[] = {0.4, 0.5, 0.6, 0.8};
    const struct rc_fatigue_limits l = {1, 0.62, sqrt(3)};
    const unsigned wanted = 1U << RC_CROSSLAND | 1U << RC_DANG_VAN | 1U << RC_FINDLEY |
                            1U << RC_SHAKEDOWN | 1U << RC_AMPLITUDE;
    double *out[RC_FATIGUES];
    (void)state;

    for (int c = 0; c < RC_FATIGUES; c++)
        out[c] = v[c];
    for (size_t i = 0; i < NX; i++)
        for (size_t j = 0; j < NY; j++) {
            const double x = ((double)i - (NX - 1) / 2.0) / A;
            p[0][j * NX + i] = p[1][i * NY + j] =
                (roller_load(1, x + 0.5 / A) - roller_load(1, x - 0.5 / A)) * A;
        }
    for (int turned = 0; turned < 2; turned++)
        for (int friction = 0; friction < 2; friction++) {
            const struct rc_shape shape = {turned ? NY : NX, turned ? NX : NY, 1e-6, 1e-6};
            const double *const maps[] = {p[turned]}, mu = friction && !turned ? 0.3 : 0;
            struct rc_fatigue_problem problem = {
                .stress = {.boundary = rc_boundary_of(turned, !turned),
                           .body.nu = 0.3,
                           .mu = mu,
                           .threads = 1},
                .wanted = wanted,
                .full = true,
                .pass = turned ? 'y' : 'x',
                .cases = 1,
                .p = maps};
            struct rc_err err = {""};
            struct rc_fatigue *f = rc_fatigue_new(&shape, &problem, &err);
            if (f == NULL)
                fail_msg("%s", err.text);
            for (int d = 0; d < 4; d++) {
                double truth[RC_FATIGUES];
                line_values(depths[d], mu, 0.3, wanted, &l, true, truth);
                assert_int_equal(rc_fatigue_depth(f, depths[d] * A * 1e-6, &l, NULL, out, &err),
                                 RC_OK);
                for (int c = 0; c < RC_FATIGUES; c++)
                    for (int j = 0; wanted >> c & 1 && j < NY; j++)
                        near(v[c][j], truth[c], (c == RC_DANG_VAN ? 7e-3 : 1e-3) * truth[c],
                             rc_criterion_names[c]);
            }
            near(rc_fatigue_result(f)->largest[RC_AMPLITUDE].depth / (A * 1e-6),
                 friction && !turned ? 0.4 : 0.5, 1e-9, "depth of the amplitude");
            if (mu == 0)
                near(rc_fatigue_result(f)->largest[RC_AMPLITUDE].value, 0.25, 5e-4,
                     "amplitude of a roller");
            assert_int_equal(rc_fatigue_result(f)->states, NX + 1);
            rc_fatigue_free(f);
            problem.pass = turned ? 'x' : 'y';
            f = rc_fatigue_new(&shape, &problem, &err);
            assert_int_equal(rc_fatigue_depth(f, 0.5 * A * 1e-6, &l, NULL, out, &err), RC_OK);
            near(rc_fatigue_result(f)->largest[RC_AMPLITUDE].value, 0, 1e-7,
                 "amplitude along the roller");
            assert_int_equal(rc_fatigue_result(f)->states, NY);
            rc_fatigue_free(f);
        }
}

/* A static stress does not change shakedown, and changes Dang Van by k h. */
static void
residual_stress(void **state)
{
    enum {
        N = 400
    };
    const struct rc_fatigue_limits limits = {1, 0.62, sqrt(3)};
    const unsigned wanted = 1U << RC_SHAKEDOWN | 1U << RC_DANG_VAN | 1U << RC_AMPLITUDE;
    static double path[RC_COMPONENTS][N];
    const double *s[RC_COMPONENTS];
    double before[RC_FATIGUES], after[RC_FATIGUES];
    struct rc_err err;
    (void)state;

    for (int k = 0; k < N; k++) {
        double one[RC_COMPONENTS];
        line_stress((k - N / 2) * 0.03 + 0.001, 0.5, 0.1, 0.3, one);
        for (int c = 0; c < RC_COMPONENTS; c++)
            path[c][k] = one[c];
    }
    for (int c = 0; c < RC_COMPONENTS; c++)
        s[c] = path[c];
    rc_fatigue_history(wanted, &limits, true, N, s, before, &err);
    for (int k = 0; k < N; k++) {
        path[RC_SXX][k] += 0.2;
        path[RC_SYY][k] += 0.2;
    }
    rc_fatigue_history(wanted, &limits, true, N, s, after, &err);
    near(after[RC_SHAKEDOWN], before[RC_SHAKEDOWN], 1e-12, "shakedown");
    near(after[RC_AMPLITUDE], before[RC_AMPLITUDE], 1e-12, "amplitude");
    near(after[RC_DANG_VAN] - before[RC_DANG_VAN], (3 * 0.62 - 1.5) * 0.4 / 3 / 0.62, 1e-9,
         "Dang Van");
}

/* ---- a ball ---- */

static void
ball(void **state)
{
    enum {
        N = 128,
        A = 28 /* contact radius in nodes */
    };
    static double p[N * N], out[N], held[N];
    const struct rc_shape shape = {N, N, 1e-6, 1e-6};
    const double *const maps[] = {p}, k = 1 / sqrt(3);
    const struct rc_fatigue_limits yield = {0, 0, 1};
    struct rc_fatigue_problem problem = {.stress = {.body.nu = 0.3, .threads = 1},
                                         .wanted = 1U << RC_SHAKEDOWN | 1U << RC_AMPLITUDE,
                                         .pass = 'x',
                                         .cases = 1,
                                         .p = maps};
    struct rc_fatigue *f;
    struct rc_err err = {""};
    double *const wanted[RC_FATIGUES] = {[RC_AMPLITUDE] = out, [RC_SHAKEDOWN] = held};
    double most = 0;
    (void)state;

    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++)
            p[j * N + i] = sqrt(fmax(0, 1 - (pow(i - 63.5, 2) + pow(j - 63.5, 2)) / (A * A)));
    if ((f = rc_fatigue_new(&shape, &problem, &err)) == NULL)
        fail_msg("%s", err.text);
    for (int n = 0; n < 9; n++) { /* the largest orthogonal shear stress is at .35 a */
        assert_int_equal(
            rc_fatigue_depth(f, (0.25 + 0.025 * n) * A * 1e-6, &yield, NULL, wanted, &err), RC_OK);
        most = fmax(most, held[N / 2]);
    }
    near(rc_fatigue_result(f)->largest[RC_AMPLITUDE].value, 0.2138, 4e-4, "amplitude of a ball");
    near(rc_fatigue_result(f)->largest[RC_AMPLITUDE].depth / (A * 1e-6), 0.35, 0.03, "its depth");
    near(fabs(rc_fatigue_result(f)->largest[RC_AMPLITUDE].y), 0.5e-6, 1e-12, "its row");
    /* In the middle row. Beside it the two free stresses help less. */
    near(1 / (most * k), 4.676, 0.012, "shakedown of a ball");
    near(1 / (rc_fatigue_result(f)->largest[RC_SHAKEDOWN].value * k), 4.64, 0.02,
         "shakedown beside the middle");
    assert_int_equal(rc_fatigue_result(f)->states, N + 1);
    rc_fatigue_free(f);
    problem.pass = 'y'; /* the same by symmetry */
    f = rc_fatigue_new(&shape, &problem, &err);
    assert_int_equal(rc_fatigue_depth(f, 0.35 * A * 1e-6, &yield, NULL, wanted, &err), RC_OK);
    near(rc_fatigue_result(f)->largest[RC_AMPLITUDE].value, 0.2138, 4e-4, "along y");
    rc_fatigue_free(f);
}

/* ---- smallest balls ---- */

enum {
    MOST = 12 /* points whose subsets are tried */
};

static uint64_t seed = 20261127;

static double
number(void) /* from -1 to 1 */
{
    seed = seed * 6364136223846793005U + 1442695040888963407U;
    return (double)(int64_t)(seed >> 11) / 4503599627370496.0 - 1;
}

/* The ball with the points of a subset on its boundary and the centre in their plane: Gauss's elimination;
 * the radius is INFINITY if they have no such ball. */
static double
through(size_t dim, size_t free, size_t n, double (*x)[5], const size_t *of, double centre[5])
{
    double a[5][6], square = 0;

    for (size_t i = 1; i < n; i++) {
        double rhs = 0;
        for (size_t k = 0; k < dim; k++)
            rhs += k < free ? pow(x[of[i]][k] - x[of[0]][k], 2)
                            : pow(x[of[i]][k], 2) - pow(x[of[0]][k], 2);
        for (size_t j = 1; j < n; j++) {
            a[i - 1][j - 1] = 0;
            for (size_t k = 0; k < free; k++)
                a[i - 1][j - 1] += (x[of[i]][k] - x[of[0]][k]) * (x[of[j]][k] - x[of[0]][k]);
        }
        a[i - 1][n - 1] = rhs / 2;
    }
    for (size_t i = 0; i + 1 < n; i++) {
        size_t best = i;
        for (size_t r = i; r + 1 < n; r++)
            best = fabs(a[r][i]) > fabs(a[best][i]) ? r : best;
        if (fabs(a[best][i]) < 1e-9)
            return INFINITY;
        for (size_t k = 0; k < n; k++) {
            double v = a[i][k];
            a[i][k] = a[best][k];
            a[best][k] = v;
        }
        for (size_t r = 0; r + 1 < n; r++)
            for (size_t k = n; r != i && k-- > i;)
                a[r][k] -= a[r][i] / a[i][i] * a[i][k];
    }
    for (size_t k = 0; k < dim; k++) {
        centre[k] = k < free ? x[of[0]][k] : 0;
        for (size_t i = 1; k < free && i < n; i++)
            centre[k] += a[i - 1][n - 1] / a[i - 1][i - 1] * (x[of[i]][k] - x[of[0]][k]);
        square += pow(x[of[0]][k] - centre[k], 2);
    }
    return sqrt(square);
}

/* The smallest radius of a ball through a subset that has all points. */
static double
of_subsets(size_t dim, size_t free, size_t n, double (*x)[5])
{
    double best = INFINITY;

    for (unsigned set = 1; set < 1U << n; set++) {
        size_t of[MOST], m = 0;
        double centre[5], radius;
        bool whole = true;
        for (size_t k = 0; k < n; k++)
            if (set >> k & 1 && m <= free + 1)
                of[m++] = k;
        if (m > free + 1 || (radius = through(dim, free, m, x, of, centre)) >= best)
            continue;
        for (size_t k = 0; whole && k < n; k++) {
            double square = 0;
            for (size_t d = 0; d < dim; d++)
                square += pow(x[k][d] - centre[d], 2);
            whole = sqrt(square) <= radius * (1 + 1e-11);
        }
        if (whole)
            best = radius;
    }
    return best;
}

/* Points at random: without a law, on a path that is nearly plane, on an ellipse, some of them twice. */
static void
make_path(int kind, size_t n, double (*x)[5])
{
    double a[5], b[5];

    for (int k = 0; k < 5; k++)
        a[k] = number(), b[k] = number();
    for (size_t t = 0; t < n; t++) {
        double angle = 6.28 * (double)t / (double)n, u = cos(angle),
               v = kind == 2 ? sin(angle) : number();
        for (int k = 0; k < 5; k++)
            x[t][k] =
                kind == 0 ? number() : u * a[k] + v * b[k] + (kind == 1 ? 1e-3 * number() : 0);
    }
    if (kind == 3)
        memcpy(x[n - 1], x[0], sizeof *x);
}

static struct rc_ball
smallest(size_t dim, size_t free, size_t n, double (*x)[5])
{
    static double line[5][300], room[300];
    const double *const path[] = {line[0], line[1], line[2], line[3], line[4]};

    for (size_t k = 0; k < dim; k++)
        for (size_t t = 0; t < n; t++)
            line[k][t] = x[t][k];
    return rc_ball_about(dim, free, n, path, room);
}

static void
balls(void **state)
{
    static const size_t kinds[][2] = {{5, 5}, {5, 2}, {2, 2}}; /* dimensions, those of the centre */
    (void)state;

    for (int n = 0; n < 1000; n++) {
        double x[MOST][5];
        const size_t points = 1 + (size_t)n % 10;
        make_path(n % 4, points, x);
        for (size_t k = 0; k < 3; k++) {
            double truth = of_subsets(kinds[k][0], kinds[k][1], points, x);
            double radius = smallest(kinds[k][0], kinds[k][1], points, x).radius;
            if (!(fabs(radius - truth) <= 1e-10 * truth))
                fail_msg("history %d of %zu points, kind %zu: %.15g instead of %.15g", n, points, k,
                         radius, truth);
        }
    }
}

/* Long paths: a ball with all points cannot be smaller than that of a subset. */
static void
long_balls(void **state)
{
    static double x[257][5];
    (void)state;

    for (int n = 0; n < 60; n++) {
        double near_surface[MOST][5];
        size_t kept = 0;
        struct rc_ball b;
        make_path(n % 2, 257, x);
        b = smallest(5, 5, 257, x);
        for (size_t t = 0; t < 257; t++) {
            double square = 0;
            for (size_t k = 0; k < 5; k++)
                square += pow(x[t][k] - b.centre[k], 2);
            assert_true(sqrt(square) <= b.radius * (1 + 1e-12));
            if (sqrt(square) > b.radius * (1 - 1e-9) && kept < MOST)
                memcpy(near_surface[kept++], x[t], sizeof *x);
        }
        near(of_subsets(5, 5, kept, near_surface), b.radius, 1e-10 * b.radius,
             "ball of a long path");
        assert_true(b.passes < 30);
    }
}

/* ---- Findley ---- */

/* tau_a + k max s_n on a plane, from all pairs and triples of its path. */
static double
on_one_plane(size_t n, double (*s)[RC_COMPONENTS], double tilt, double turn, double k)
{
    const double normal[] = {sin(tilt) * cos(turn), sin(tilt) * sin(turn), cos(tilt)};
    const double a[] = {cos(tilt) * cos(turn), cos(tilt) * sin(turn), -sin(tilt)};
    const double b[] = {-sin(turn), cos(turn), 0};
    double x[MOST][5], most = -INFINITY;

    for (size_t t = 0; t < n; t++) {
        const double m[3][3] = {
            {s[t][0], s[t][3], s[t][4]}, {s[t][3], s[t][1], s[t][5]}, {s[t][4], s[t][5], s[t][2]}};
        double sn = 0;
        x[t][0] = x[t][1] = 0;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                sn += normal[i] * m[i][j] * normal[j];
                x[t][0] += a[i] * m[i][j] * normal[j];
                x[t][1] += b[i] * m[i][j] * normal[j];
            }
        most = fmax(most, sn);
    }
    return of_subsets(2, 2, n, x) + k * most;
}

static void
findley_planes(void **state)
{
    const struct rc_fatigue_limits limits = {1, 0.62, 0};
    const double r = 1 / 0.62, k = (2 - r) / (2 * sqrt(r - 1)), limit = 1 / (2 * sqrt(r - 1));
    const unsigned wanted = 1U << RC_FINDLEY | 1U << RC_PLANE_TILT | 1U << RC_PLANE_TURN;
    (void)state;

    for (int n = 0; n < 24; n++) {
        enum {
            N = 7
        };
        double s[N][RC_COMPONENTS], line[RC_COMPONENTS][N], v[RC_FATIGUES], best = 0, own;
        const double *path[RC_COMPONENTS];
        struct rc_err err;
        for (int c = 0; c < RC_COMPONENTS; c++) {
            path[c] = line[c];
            for (int t = 0; t < N; t++)
                s[t][c] = line[c][t] = number() - (n % 2 == 1 && c < 3 ? 1 : 0);
        }
        assert_int_equal(rc_fatigue_history(wanted, &limits, true, N, path, v, &err), RC_OK);
        for (int i = 0; i <= 18; i++)
            for (int j = 0; j < 72; j++)
                best = fmax(best, on_one_plane(N, s, i * pi / 36, j * pi / 36, k));
        own = on_one_plane(N, s, v[RC_PLANE_TILT] * pi / 180, v[RC_PLANE_TURN] * pi / 180, k);
        near(v[RC_FINDLEY] * limit, own, 1e-9, "Findley on its own plane");
        if (v[RC_FINDLEY] * limit < best * (1 - 1e-6))
            fail_msg("history %d: %.6f, but %.6f on another plane", n, v[RC_FINDLEY] * limit, best);
        /* a hydrostatic stress acts on all planes alike, also where the index is 0 or below */
        for (double index = 1e-3; index > -1e3; index = index > 0 ? -1e-3 : 100 * index) {
            const double more = (index - v[RC_FINDLEY]) * limit / k;
            double other[RC_FATIGUES];
            for (int c = 0; c < 3; c++)
                for (int t = 0; t < N; t++)
                    line[c][t] = s[t][c] + more;
            assert_int_equal(rc_fatigue_history(wanted, &limits, true, N, path, other, &err),
                             RC_OK);
            near(other[RC_FINDLEY], index, 1e-5 * (1 + 1e-7 * fabs(index)),
                 "Findley under pressure");
        }
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(calibration),     cmocka_unit_test(repeated),
        cmocka_unit_test(combined),        cmocka_unit_test(hard_steel),
        cmocka_unit_test(line_formula),    cmocka_unit_test(line),
        cmocka_unit_test(roller),          cmocka_unit_test(line_shakedown),
        cmocka_unit_test(residual_stress), cmocka_unit_test(ball),
        cmocka_unit_test(balls),           cmocka_unit_test(long_balls),
        cmocka_unit_test(findley_planes),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
