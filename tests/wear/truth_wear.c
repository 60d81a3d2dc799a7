/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compares worn heights and pressures with closed forms. Each wave in full contact decays at its own rate.
 * The pressure of a circular and of a strip punch becomes even by the modes of the operator. A ball wears to
 * the rigid limit, and stiff roughness to its Abbott curve. In the end the pressure is even, or k p is where
 * k differs. A part that does not wear carries the load in the end. The worn volume of an even k is k P s. A
 * ball that passes on a track cuts a groove of the rigid width, with the same load on all rows. Of two rough
 * bodies that slide over each other, each loses its own waves, and a smooth one is a track. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

static const double estar = 1e9, node = 1e-6, k_wear = 1e-15; /* Pa, m, 1/Pa */
/* Distance in nodes: s k E* / dx. */
static const double unit = node / (k_wear * estar);

struct run {
    struct rc_model *m;
    size_t n;
    const double *part;
    double *p, *h, *wear;
};

static struct run
start_with(const struct rc_shape *s, const double *h, struct rc_boundary boundary, double tol,
           const double *part)
{
    const struct rc_problem contact = {.boundary = boundary,
                                       .pair.estar = estar,
                                       .tol = (tol > 0 ? tol : 0.1) / 100,
                                       .threads = 1};
    const struct rc_wear_problem law = {
        .k = {k_wear / 4, 3 * k_wear / 4}, .estar = estar, .tol = tol, .part = part};
    const size_t n = s->nx * s->ny;
    struct rc_err err = {""};
    struct run r = {.n = n, .part = part, .p = calloc(3 * n, sizeof *r.p)};

    r.h = r.p + n;
    r.wear = r.p + 2 * n;
    r.m = rc_wear_new(rc_elastic_new(s, h, &contact, NULL, &err), h, &law, &err);
    if (r.m == NULL)
        fail_msg("%s", err.text);
    return r;
}

static struct run
start(const struct rc_shape *s, const double *h, struct rc_boundary boundary, double tol)
{
    return start_with(s, h, boundary, tol, NULL);
}

/* Slides to a distance in nodes under a mean pressure over the map. The volume is k P s, to rounding. */
static const struct rc_wear_figures *
slide(struct run *r, double mean, double distance)
{
    const struct rc_shape s = rc_model_shape(r->m);
    const double load = mean * s.dx * s.dy * (double)r->n;
    const struct rc_wear_figures *f;
    struct rc_err err = {""};
    struct rc_point to = {0};

    rc_point_set(&to, RC_LOAD, load);
    rc_point_set(&to, RC_DISTANCE, distance * unit);
    if (rc_model_run(r->m, &to, &err) != RC_OK || rc_model_look(r->m, NULL, &err) != RC_OK ||
        rc_model_frame(r->m, "pressure", r->p, &err) != RC_OK ||
        rc_model_frame(r->m, "height", r->h, &err) != RC_OK ||
        rc_model_frame(r->m, "wear", r->wear, &err) != RC_OK || rc_model_keep(r->m, &err) != RC_OK)
        fail_msg("%g nodes: %s", distance, err.text);
    f = rc_wear_result(r->m);
    assert_true(f->converged && f->distance == distance * unit);
    if (r->part == NULL)
        assert_true(fabs(f->wear_volume / (k_wear * load * distance * unit) - 1) < summed);
    assert_true(fabs(f->wear_volume_2 - 3 * f->wear_volume_1) <= rounding * f->wear_volume);
    return f;
}

static void
end(struct run *r)
{
    rc_model_free(r->m);
    free(r->p);
}

/* ---- waves ---- */

enum {
    WAVES = 32,
    MODES = 5
};
static const int wave[MODES][2] = {{1, 0}, {0, 2}, {3, 4}, {7, -5}, {12, 16}};
static const double amplitude[MODES] = {.6, .3, .08, .04, .02}; /* of the nodes */

/* The height of a wave at a node, m, and its decay per node of distance: exp(-k E* q s/2). */
static double
wave_at(int m, size_t k)
{
    const int x = (int)(k % WAVES), y = (int)(k / WAVES);

    return amplitude[m] * node * cos(2 * exact_pi * (wave[m][0] * x + wave[m][1] * y) / WAVES + m);
}

static double
rate(int m)
{
    return exact_pi / WAVES * hypot(wave[m][0], wave[m][1]);
}

static void
waves_decay(void **state)
{
    static double h[WAVES * WAVES];
    const struct rc_shape s = {WAVES, WAVES, node, node};
    const double mean = 0.3 * estar, tols[] = {0.1, 0.02};
    struct run r;

    (void)state;
    for (int t = 0; t < 2; t++) {
        for (size_t k = 0; k < WAVES * WAVES; k++) {
            h[k] = 0;
            for (int m = 0; m < MODES; m++)
                h[k] += wave_at(m, k);
        }
        r = start(&s, h, RC_PERIODIC, tols[t]);
        for (double at = 0.1; at < 200; at *= 10) {
            const struct rc_wear_figures *f = slide(&r, mean, at);
            double off[2] = {0, 0}, sum[2] = {0, 0};
            for (size_t k = 0; k < WAVES * WAVES; k++) {
                double worn = at * mean / estar * node, p = mean;
                for (int m = 0; m < MODES; m++) {
                    worn += (1 - exp(-rate(m) * at)) * wave_at(m, k);
                    p += estar / node * rate(m) * wave_at(m, k) * exp(-rate(m) * at);
                }
                off[0] += fabs(r.wear[k] - worn);
                off[1] += fabs(r.p[k] - p);
                sum[0] += worn;
                sum[1] += p;
            }
            if (!(off[0] <= f->wear_error * sum[0] && off[1] <= f->pressure_error * sum[1] &&
                  off[0] <= 1e-3 * sum[0] && off[1] <= 2e-3 * sum[1]))
                fail_msg("tol %g, at %g nodes: errors %.2g of the wear, %.2g estimated; %.2g of "
                         "the pressure, %.2g estimated",
                         tols[t], at, off[0] / sum[0], f->wear_error, off[1] / sum[1],
                         f->pressure_error);
        }
        end(&r);
    }
}

/* ---- punches ---- */

enum {
    TIMES = 5
};
/* k E* s / a, and the RMS of p over its mean, less 1, of a flat punch. They are sums over the modes of the
 * operator on a disc and on a strip in plane strain, from 40 Legendre functions. The rates on the disc are
 * 2.06065, 3.67104, 5.25854, 6.83864 E* k/a ...; those on the strip are 1.72667, 3.31431, 4.89197, 6.46651
 * ... */
static const double times[TIMES] = {0.1, 0.25, 0.5, 1, 2};
static const double on_disc[TIMES] = {0.41210, 0.24875, 0.13259, 0.044623, 0.0056115};
static const double on_strip[TIMES] = {0.43244, 0.28019, 0.16419, 0.065626, 0.011534};

/* A punch of all nodes nearer than `radius` to the middle, or to a line along the axis that repeats.
 * `half`: a in nodes, that its area has. Each way between two times takes `parts` distances of the list. */
static void
punch(const struct rc_shape *s, double radius, double half, struct rc_boundary boundary,
      const double *want, double tol, int parts)
{
    const size_t n = s->nx * s->ny;
    double *h = calloc(n, sizeof *h);
    size_t in = 0;
    struct run r;

    for (size_t k = 0; k < n; k++) {
        double x = (double)(k % s->nx) - (double)(s->nx - 1) / 2;
        double y = (double)(k / s->nx) - (double)(s->ny - 1) / 2;
        if (rc_repeats(boundary) == 1)
            *(boundary.x ? &x : &y) = 0;
        h[k] = hypot(x, y) < radius ? 0 : -1000 * node;
        in += h[k] == 0;
    }
    half = half > 0 ? half : sqrt((double)in / exact_pi);
    r = start(s, h, boundary, tol);
    for (int t = 0; t < TIMES; t++) {
        const double mean = 1e-3 * estar * (double)in / (double)n;
        const double from = t > 0 ? times[t - 1] : 0;
        double sum = 0;
        for (int q = 1; q <= parts; q++)
            slide(&r, mean, (from + (times[t] - from) * q / parts) * half);
        for (size_t k = 0; k < n; k++)
            sum += h[k] == 0 ? pow(r.p[k] / (1e-3 * estar) - 1, 2) : 0;
        /* the last number is small: 5 % of it is 3e-4 of the pressure, far below the usual tolerance */
        if (!(fabs(sqrt(sum / (double)in) / want[t] - 1) <
              (tol == 0 && times[t] > 1 ? 0.05 : 0.015)))
            fail_msg("%zu x %zu, k E* s/a = %g: RMS %.4g, not %.4g", s->nx, s->ny, times[t],
                     sqrt(sum / (double)in), want[t]);
    }
    end(&r);
    free(h);
}

static void
punches_become_even(void **state)
{
    (void)state;
    for (int q = 0; q < 2; q++) {
        const double tol = q == 0 ? 0 : 0.02;
        const int parts = q == 0 ? 1 : 4;
        punch(&(struct rc_shape){36, 36, node, node}, 16.3, 0, RC_FREE, on_disc, tol, parts);
        punch(&(struct rc_shape){1280, 1, node, node}, 20, 20, RC_PERIODIC, on_strip, tol, parts);
        punch(&(struct rc_shape){44, 1, node, 7 * node}, 20, 20, rc_boundary_of(false, true),
              on_strip, tol, parts);
        punch(&(struct rc_shape){3, 44, node, node}, 20, 20, rc_boundary_of(true, false), on_strip,
              tol, parts);
    }
}

/* ---- the rigid limit ---- */

/* The scar of a ball of radius R has the area of a plane cut of volume V, a^4 = 4 R V/pi. The pressure is
 * even. */
static void
a_ball_is_cut(void **state)
{
    enum {
        SIDE = 48
    };
    const double radius = 100, hertz_radius = 4, a = 18; /* nodes */
    const double load = 4 * pow(hertz_radius, 3) / (3 * radius),
                 volume = exact_pi * pow(a, 4) / (4 * radius);
    const struct rc_shape s = {SIDE, SIDE, node, node};
    static double h[SIDE * SIDE];
    double even = 0, area;
    struct run r;

    (void)state;
    for (size_t k = 0; k < SIDE * SIDE; k++) {
        double x = (double)(k % SIDE) - (SIDE - 1) / 2.0, y = (double)(k / SIDE) - (SIDE - 1) / 2.0;
        h[k] = -node * (x * x + y * y) / (2 * radius);
    }
    r = start(&s, h, RC_FREE, 0);
    (void)slide(&r, load * estar / (SIDE * SIDE), volume / load);
    area = rc_model_number(r.m, "contact_fraction") * SIDE * SIDE;
    assert_true(fabs(sqrt(area / exact_pi) / a - 1) < coarse_grid);
    for (size_t k = 0; k < SIDE * SIDE; k++) {
        double x = (double)(k % SIDE) - (SIDE - 1) / 2.0, y = (double)(k / SIDE) - (SIDE - 1) / 2.0;
        if (hypot(x, y) < 0.8 * a)
            even = fmax(even, fabs(r.p[k] * exact_pi * a * a / (load * estar) - 1));
    }
    assert_true(even < 0.02);
    end(&r);
}

/* The scar of a cylinder has the section of a cut of the volume V per length, 2 a = (12 R V)^(1/3). The
 * pressure is even, and that of any line is P/(2 a). The cylinder is along y, then along x. */
static void
a_cylinder_is_cut(void **state)
{
    enum {
        SIDE = 64,
        ROWS = 3
    };
    const double radius = 200, hertz_half = 4, a = 24;                     /* nodes */
    const double load = exact_pi * hertz_half * hertz_half / (4 * radius), /* over E* and a node */
        volume = 8 * pow(a, 3) / (12 * radius);
    static double h[SIDE * ROWS];

    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        const struct rc_shape s = turned ? (struct rc_shape){ROWS, SIDE, node, node}
                                         : (struct rc_shape){SIDE, ROWS, node, node};
        double even = 0, found;
        struct run r;

        for (size_t k = 0; k < SIDE * ROWS; k++) {
            const double x = (double)(turned ? k / ROWS : k % SIDE) - (SIDE - 1) / 2.0;
            h[k] = -node * x * x / (2 * radius);
        }
        r = start(&s, h, rc_boundary_of(turned, !turned), 0);
        (void)slide(&r, load * estar / SIDE, volume / load);
        found = rc_model_number(r.m, "contact_fraction") * SIDE / 2;
        assert_true(fabs(found / a - 1) < 1 / a);
        for (size_t k = 0; k < SIDE * ROWS; k++) {
            const double x = (double)(turned ? k / ROWS : k % SIDE) - (SIDE - 1) / 2.0;
            if (fabs(x) < 0.8 * a)
                even = fmax(even, fabs(r.p[k] * 2 * a / (load * estar) - 1));
        }
        if (!(even < 0.03))
            fail_msg("half width %g nodes, pressure off by %.3f", found, even);
        end(&r);
    }
}

/* Steep roughness hardly deforms: it becomes min(h, cut), and the worn volume gives the cut. At long
 * distances the contact is complete and the pressure even at any slope. */
static void
roughness_is_cut(void **state)
{
    enum {
        SIDE = 32
    };
    const struct rc_shape s = {SIDE, SIDE, node, node};
    const struct rc_selfaffine rough = {
        .hurst = 0.8, .rms_slope = 10, .short_cut = 8 * node, .seed = 5};
    const double mean = 0.01 * estar;
    static double h[SIDE * SIDE];
    double low = -1, high = 1, off = 0, worn = 0;
    struct run r;

    (void)state;
    assert_int_equal(rc_synth_selfaffine(&s, &rough, h, NULL), RC_OK);
    r = start(&s, h, RC_PERIODIC, 0);
    (void)slide(&r, mean, 500);
    for (int round = 0; round < 60; round++) {
        double cut = (low + high) / 2, sum = 0;
        for (size_t k = 0; k < SIDE * SIDE; k++)
            sum += fmax(h[k] - cut, 0);
        *(sum > 500 * mean / estar * node * SIDE * SIDE ? &low : &high) = cut;
    }
    for (size_t k = 0; k < SIDE * SIDE; k++) {
        off += fabs(r.wear[k] - fmax(h[k] - low, 0));
        worn += r.wear[k];
    }
    if (!(off / worn < 0.01))
        fail_msg("the worn depth is off by %.2g", off / worn);
    end(&r);
    for (size_t k = 0; k < SIDE * SIDE; k++)
        h[k] /= 100;
    r = start(&s, h, RC_PERIODIC, 0);
    assert_true(slide(&r, mean, 1000)->pressure_spread < 5e-3);
    end(&r);
}

enum {
    GROOVE = 64
};

/* A ball of radius 100 nodes, with a Hertz radius of 4, slides on a track, of which body 2 loses k P s.
 * Returns the model at the distance after which the rigid ball has cut a groove of half width a. */
static struct rc_model *
cut_groove(size_t side, double a, double of_ball, double track, double *frame[3])
{
    static const char *const name[] = {"pressure", "wear-1", "wear-2"};
    const double radius = 100, length = 1000 * node,
                 load = 256 / (3 * radius) * estar * node * node;
    const double s = 2 * length * pow(a * node, 3) / (3 * radius * node * k_wear * load);
    const struct rc_shape shape = {side, side, node, node};
    const struct rc_problem contact = {.pair.estar = estar, .tol = 1e-3, .threads = 1};
    const struct rc_wear_problem law = {.k = {of_ball * k_wear, fmax(track, 0) * k_wear},
                                        .estar = estar,
                                        .track = track >= 0 ? length : 0};
    static double h[GROOVE * GROOVE];
    const struct rc_wear_figures *f;
    struct rc_err err = {""};
    struct rc_point to = {0};
    struct rc_model *m;

    for (size_t k = 0; k < side * side; k++) {
        double x = (double)(k % side) - (double)(side - 1) / 2;
        double y = (double)(k / side) - (double)(side - 1) / 2;
        h[k] = -node * (x * x + y * y) / (2 * radius);
    }
    m = rc_wear_new(rc_elastic_new(&shape, h, &contact, NULL, &err), h, &law, &err);
    rc_point_set(&to, RC_LOAD, load);
    rc_point_set(&to, RC_DISTANCE, s);
    if (m == NULL || rc_model_run(m, &to, &err) != RC_OK || rc_model_look(m, NULL, &err) != RC_OK)
        fail_msg("%s", err.text);
    for (int q = 0; q < 3; q++)
        assert_int_equal(rc_model_frame(m, name[q], frame[q], &err), RC_OK);
    f = rc_wear_result(m);
    assert_true(fabs(f->wear_volume_1 - of_ball * k_wear * load * s) <= summed * f->wear_volume &&
                fabs(f->wear_volume_2 - fmax(track, 0) * k_wear * load * s) <=
                    summed * f->wear_volume);
    return m;
}

static void
a_ball_cuts_a_groove(void **state)
{
    static double p[GROOVE * GROOVE], ball[GROOVE * GROOVE], track[GROOVE * GROOVE],
        again[GROOVE * GROOVE];
    /* elasticity leaves 3.5 and 2.0 % between the row loads, also with a tenth of the tolerance */
    const double rigid[] = {13.6, 19.6}, found[] = {14, 20}, even[] = {0.04, 0.025};
    const size_t side[] = {48, 64};

    (void)state;
    for (int q = 0; q < 2; q++) {
        const size_t n = side[q];
        double half = 0, mean = 0, most = 0, least = INFINITY, count = 0;
        rc_model_free(cut_groove(n, rigid[q], 0, 1, (double *[]){p, ball, track}));
        for (size_t j = 0; j < n; j++) {
            double load = 0, off = fabs((double)j - (double)(n - 1) / 2);
            for (size_t i = 0; i < n; i++) {
                load += p[j * n + i];
                assert_true(ball[j * n + i] == 0 && track[j * n + i] == track[j * n]);
            }
            half += load > 0 ? 0.5 : 0;
            if (off > 0.8 * rigid[q])
                continue;
            mean += load;
            count++;
            most = fmax(most, load);
            least = fmin(least, load);
        }
        if (!(half == found[q] && (most - least) * count < even[q] * mean))
            fail_msg("half width %g nodes, %g when rigid; row loads %.3f to %.3f of their mean",
                     half, rigid[q], least * count / mean, most * count / mean);
    }
    rc_model_free(cut_groove(48, 13.6, 1, 0, (double *[]){p, ball, track}));
    rc_model_free(cut_groove(48, 13.6, 1, -1, (double *[]){again, ball, track}));
    assert_memory_equal(p, again, sizeof *p * 48 * 48); /* a track that does not wear is none */
}

/* A roller along y slides along x: its track sinks evenly, and the pressure stays. A roller along x slides
 * along itself: each row of a track as long as the period loses as much as the same points of both bodies. */
static void
a_roller_on_a_track(void **state)
{
    enum {
        SIDE = 48,
        ROWS = 4
    };
    static double h[SIDE * ROWS], p[3][SIDE * ROWS];

    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        const struct rc_shape s = turned ? (struct rc_shape){ROWS, SIDE, node, node}
                                         : (struct rc_shape){SIDE, ROWS, node, node};
        const struct rc_problem contact = {.boundary = rc_boundary_of(turned, !turned),
                                           .pair.estar = estar,
                                           .tol = 1e-6,
                                           .threads = 1};
        double most = 0;

        for (size_t k = 0; k < SIDE * ROWS; k++) {
            const double x = (double)(turned ? k / ROWS : k % SIDE) - (SIDE - 1) / 2.0;
            h[k] = -node * x * x / 400;
        }
        for (int q = 0; q < 3; q++) { /* before, on the track, at the same points */
            const struct rc_wear_problem law = {
                .k = {0, k_wear}, .estar = estar, .tol = 0.01, .track = q < 2 ? ROWS * node : 0};
            struct rc_err err = {""};
            struct rc_point to = {0};
            struct rc_model *m =
                rc_wear_new(rc_elastic_new(&s, h, &contact, NULL, &err), h, &law, &err);
            rc_point_set(&to, RC_LOAD, 0.3 * estar * node * node * ROWS);
            rc_point_set(&to, RC_DISTANCE, q == 0 ? 0 : 20 * unit);
            if (m == NULL || rc_model_run(m, &to, &err) == RC_FAIL ||
                rc_model_look(m, NULL, &err) != RC_OK ||
                rc_model_frame(m, "pressure", p[q], &err) != RC_OK)
                fail_msg("%s", err.text);
            rc_model_free(m);
        }
        for (size_t k = 0; k < SIDE * ROWS; k++)
            most = fmax(most, p[0][k]);
        for (size_t k = 0; k < SIDE * ROWS; k++)
            assert_true(fabs(p[1][k] - p[turned ? 2 : 0][k]) < (turned ? 0.02 : 1e-4) * most);
    }
}

/* Where the last valleys close, a contact puts several times the mean pressure on a few nodes, within its
 * tolerance, and the more so the larger the map is. The largest pressure must be the mean, as in the end. */
static void
close_valleys(size_t side, uint64_t seed, double mean, double from, double to, double within)
{
    const struct rc_shape s = {side, side, node, node};
    const struct rc_selfaffine rough = {.hurst = 0.8,
                                        .rms_slope = 0.1,
                                        .rolloff = (double)side / 4 * node,
                                        .short_cut = 8 * node,
                                        .seed = seed};
    double *h = calloc(side * side, sizeof *h), peak;
    struct run r;

    assert_int_equal(rc_synth_selfaffine(&s, &rough, h, NULL), RC_OK);
    r = start(&s, h, RC_PERIODIC, 0);
    for (double at = from; at <= to; at *= 10)
        (void)slide(&r, mean, at);
    peak = rc_model_number(r.m, "max_pressure") / mean;
    if (!(peak < 1 + within))
        fail_msg("%zu x %zu nodes: the largest pressure is %.3f of the mean", side, side, peak);
    end(&r);
    free(h);
}

static void
valleys_close_evenly(void **state)
{
    (void)state;
    close_valleys(256, 1, 0.002 * estar, 1, 1000, 0.02);
    close_valleys(320, 2, 0.001 * estar, 1e4, 1e4, 0.001);
}

/* ---- a coefficient of each node ---- */

/* Two phases of squares: in the end k p is even, so that p = P / (k sum 1/k), and the heights are K p. */
static void
phases_share_the_load(void **state)
{
    enum {
        SIDE = 64,
        SQUARE = 16
    };
    const struct rc_shape s = {SIDE, SIDE, node, node};
    const double mean = 0.01 * estar, soft[] = {1.0 / 3, 0.05};
    const struct rc_selfaffine rough = {
        .hurst = 0.8, .rms_slope = 0.1, .short_cut = 8 * node, .seed = 5};
    static double h[SIDE * SIDE], part[SIDE * SIDE], u[SIDE * SIDE];
    struct rc_pair pair = {.estar = estar};
    struct rc_conv_options options = {.boundary = RC_PERIODIC};
    struct rc_conv *conv = rc_conv_new(&s, &pair, &options, NULL);
    struct run r;

    (void)state;
    for (int q = 0; q < 2; q++) {
        double off = 0, inverse = 0, relief = 0, size = 0, level = 0;
        assert_int_equal(rc_synth_selfaffine(&s, &rough, h, NULL), RC_OK);
        for (size_t k = 0; k < SIDE * SIDE; k++) {
            part[k] = (k % SIDE / SQUARE + k / SIDE / SQUARE) % 2 ? 1 : soft[q];
            inverse += 1 / part[k] / (SIDE * SIDE);
        }
        r = start_with(&s, h, RC_PERIODIC, 0.02, part);
        (void)slide(&r, mean, 1e4 / soft[q]);
        rc_conv_apply(conv, r.p, u);
        for (size_t k = 0; k < SIDE * SIDE; k++) {
            off = fmax(off, fabs(part[k] * inverse * r.p[k] / mean - 1));
            level += (u[k] - r.h[k]) / (SIDE * SIDE);
        }
        for (size_t k = 0; k < SIDE * SIDE; k++) {
            relief = fmax(relief, fabs(u[k] - r.h[k] - level));
            size = fmax(size, fabs(u[k]));
        }
        if (!(off < 1e-5 && relief < 3e-6 * size))
            fail_msg("phases 1:%g: the pressure differs by %.2g, the relief by %.2g", 1 / soft[q],
                     off, relief / size);
        end(&r);
    }
    rc_conv_free(conv);
}

/* A ball of which the nodes nearer than c to the middle do not wear. Its scar is cut off at c. It carries 2
 * E* sqrt(c^2 - r^2) / (pi R) + (P - 4 E* c^3/3 R) / (2 pi c sqrt(c^2 - r^2)). */
static void
a_disc_that_sticks_carries_all(void **state)
{
    enum {
        SIDE = 64
    };
    const double
        radius = 100,
        c = 8.2919 -
            0.117; /* nodes: radius by area, and a disc of nodes acts as one smaller by 0.117 */
    const double load = 4 * pow(14, 3) / (3 * radius);
    const struct rc_shape s = {SIDE, SIDE, node, node};
    static double h[SIDE * SIDE], part[SIDE * SIDE];
    struct run r;

    (void)state;
    for (size_t k = 0; k < SIDE * SIDE; k++) {
        double x = (double)(k % SIDE) - (SIDE - 1) / 2.0, y = (double)(k / SIDE) - (SIDE - 1) / 2.0;
        h[k] = -node * (x * x + y * y) / (2 * radius);
        part[k] = hypot(x, y) < 8.5 ? 0 : 1;
    }
    r = start_with(&s, h, RC_FREE, 0, part);
    for (double at = 100; at < 2000; at *= 10) {
        double inside = 0, outside, ratio = 0, count = 0, spread = 0;
        (void)slide(&r, load * estar / (SIDE * SIDE), at);
        for (size_t k = 0; k < SIDE * SIDE; k++) {
            inside += part[k] > 0 ? 0 : r.p[k] / estar;
            assert_true(part[k] > 0 || r.wear[k] == 0);
        }
        outside = 1 - inside / load;
        for (size_t k = 0; k < SIDE * SIDE; k++) {
            double x = (double)(k % SIDE) - (SIDE - 1) / 2.0,
                   y = (double)(k / SIDE) - (SIDE - 1) / 2.0;
            double q = hypot(x, y), root = sqrt(fmax(c * c - q * q, 0));
            if (q < 0.8 * c) {
                double want = 2 / (exact_pi * radius) * root +
                              (inside - 4 * c * c * c / (3 * radius)) / (2 * exact_pi * c * root);
                double is = r.p[k] / estar / want;
                ratio += is;
                count++;
                spread = fmax(spread, fabs(is - 1));
            }
        }
        if (!(fabs(ratio / count - 1) < 0.01 && spread < 0.03 &&
              outside < (at < 200 ? 0.02 : 1e-3) && outside > (at < 200 ? 0.01 : -1)))
            fail_msg("at %g nodes: %.2g of the load outside; inside %.4f of the pressure, at most "
                     "%.3f off",
                     at, outside, ratio / count, spread);
    }
    end(&r);
}

/* ---- two rough bodies that slide over each other ---- */

/* Slides to a distance in nodes, and reads wear-1 and wear-2. */
static const struct rc_wear_figures *
slide_over(struct rc_model *m, double mean, double distance, double *wear)
{
    const struct rc_shape s = rc_model_shape(m);
    const size_t n = s.nx * s.ny;
    struct rc_err err = {""};
    struct rc_point to = {0};

    rc_point_set(&to, RC_LOAD, mean * s.dx * s.dy * (double)n);
    rc_point_set(&to, RC_DISTANCE, distance * unit);
    if (rc_model_run(m, &to, &err) != RC_OK || rc_model_look(m, NULL, &err) != RC_OK ||
        rc_model_frame(m, "wear-1", wear, &err) != RC_OK ||
        rc_model_frame(m, "wear-2", wear + n, &err) != RC_OK || rc_model_keep(m, &err) != RC_OK)
        fail_msg("%g nodes: %s", distance, err.text);
    return rc_wear_result(m);
}

static struct rc_model *
pair_that_slides(const struct rc_shape *s, struct rc_boundary boundary, const double *h,
                 struct rc_wear_problem law)
{
    const struct rc_problem contact = {
        .boundary = boundary, .pair.estar = estar, .tol = law.tol / 100, .threads = 1};
    struct rc_err err = {""};
    struct rc_model *m;

    law.estar = estar;
    m = rc_wear_new(rc_elastic_new(s, h, &contact, NULL, &err), h, &law, &err);
    if (m == NULL)
        fail_msg("%s", err.text);
    return m;
}

/* The worn depth of a body at node k: that of its own waves in full contact. A wave across the motion, which
 * no alignment changes, is common to both bodies. */
static double
lost_by(int body, size_t k, double distance, double mean)
{
    const double part[] = {0.25, 0.75};
    double lost = part[body] * mean / estar * distance * node;

    for (int m = 0; m < MODES; m++) {
        if (wave[m][0] == 0)
            lost += part[body] * (1 - exp(-rate(m) * distance)) *
                    (wave_at(m, k) + wave_at(m, k + WAVES));
        else if (m % 2 == body)
            lost += (1 - exp(-part[body] * rate(m) * distance)) * wave_at(m, k);
    }
    return lost;
}

/* In full contact each body loses its own waves, at the rate of its own coefficient. */
static void
waves_of_each_body_decay(void **state)
{
    enum {
        N = WAVES * WAVES
    };
    const struct rc_shape s = {WAVES, WAVES, node, node};
    const double mean = 0.3 * estar;
    static double h[2][N], wear[2 * N];
    struct rc_model *m;

    (void)state;
    for (size_t k = 0; k < N; k++)
        for (int w = 0; w < MODES; w++) {
            h[w % 2][k] += wave_at(w, k);
            h[1][k] += wave[w][0] == 0 ? wave_at(w, k + WAVES) - wave_at(w, k) : 0;
            h[0][k] += wave[w][0] == 0 ? wave_at(w, k) : 0;
        }
    m = pair_that_slides(
        &s, RC_PERIODIC, h[0],
        (struct rc_wear_problem){
            .k = {k_wear / 4, 3 * k_wear / 4}, .tol = 0.05, .two_bodies = true, .h2 = h[1]});
    for (double at = 1; at < 200; at *= 10) {
        const struct rc_wear_figures *f = slide_over(m, mean, at, wear);
        double off = 0, sum = 0;
        for (size_t k = 0; k < 2 * N; k++) {
            off += fabs(wear[k] - lost_by(k >= N, k % N, at, mean));
            sum += wear[k];
        }
        assert_true(fabs(f->wear_volume_2 - 3 * f->wear_volume_1) <= rounding * f->wear_volume);
        if (!(off <= f->wear_error * sum && off < 0.01 * sum))
            fail_msg("at %g nodes: error %.2g, %.2g estimated", at, off / sum, f->wear_error);
    }
    rc_model_free(m);
}

/* A smooth body 2 that wears under a rough body 1 which does not: the same as a track as long as the map. */
static void
a_smooth_body_is_a_track(void **state)
{
    enum {
        SIDE = 32,
        N = SIDE * SIDE
    };
    const struct rc_shape s = {SIDE, SIDE, node, node};
    const struct rc_selfaffine rough = {
        .hurst = 0.8, .rms_slope = 0.1, .short_cut = 8 * node, .seed = 5};
    struct rc_wear_problem law = {.k = {0, k_wear}, .tol = 0.05, .two_bodies = true};
    static double h[N], wear[2][2 * N];
    struct rc_model *m[2];

    (void)state;
    assert_int_equal(rc_synth_selfaffine(&s, &rough, h, NULL), RC_OK);
    for (int ends = 0; ends < 2; ends++) { /* the maps repeat along y, or end there */
        const struct rc_boundary boundary = rc_boundary_of(true, !ends);
        law.two_bodies = true;
        law.track = 0;
        m[0] = pair_that_slides(&s, boundary, h, law);
        law.two_bodies = false;
        law.track = SIDE * node;
        m[1] = pair_that_slides(&s, boundary, h, law);
        for (double at = 3; at < 200; at *= 5) {
            double off = 0, sum = 0, most = 0;
            for (int q = 0; q < 2; q++)
                most += slide_over(m[q], 0.01 * estar, at, wear[q])->wear_error;
            for (size_t k = N; k < 2 * N; k++) {
                off += fabs(wear[0][k] - wear[1][k]);
                sum += wear[1][k];
            }
            if (!(off <= most * sum && off < 0.03 * sum))
                fail_msg("at %g nodes: error %.2g, %.2g estimated", at, off / sum, most);
        }
        rc_model_free(m[0]);
        rc_model_free(m[1]);
    }
}

/* A given energy wears each node by the coefficient times it, on any way to a number of cycles; the
 * pressure is that of the worn heights. What has no meaning beside it is refused. */
static void
an_energy_wears_exactly(void **state)
{
    enum {
        SIDE = 24,
        N = SIDE * SIDE
    };
    const struct rc_shape s = {SIDE, SIDE, node, 1.3 * node};
    const double load = 0.02 * estar * node * node;
    const struct rc_problem contact = {.pair.estar = estar, .tol = 1e-8, .threads = 1};
    static double h[N], energy[N], wear[N], p[N], worn[N];
    struct rc_wear_problem law = {
        .k = {2 * k_wear, k_wear}, .estar = estar, .tol = 1e-4, .energy = energy};
    struct rc_err err = {""};
    struct rc_model *m;
    double sum = 0, off = 0, all = 0;
    struct solved is;

    (void)state;
    for (size_t k = 0; k < N; k++) {
        const double x = (double)(k % SIDE) - 11, y = 1.3 * ((double)(k / SIDE) - 12);
        h[k] = -(x * x + y * y) * node / 400;
        energy[k] = 1e-3 * node / (3 * k_wear) * (1 + sin(x) * cos(y));
        sum += energy[k];
    }
    m = rc_wear_new(rc_elastic_new(&s, h, &contact, NULL, &err), h, &law, &err);
    assert_non_null(m);
    for (int cycles = 0; cycles <= 5; cycles += cycles + 1) { /* 0, 1, 3 */
        struct rc_point to = {0};
        rc_point_set(&to, RC_LOAD, load);
        rc_point_set(&to, RC_DISTANCE, cycles);
        assert_int_equal(rc_model_run(m, &to, &err), RC_OK);
        assert_true(rc_model_look(m, NULL, &err) == RC_OK && rc_model_keep(m, &err) == RC_OK);
        assert_int_equal(rc_model_frame(m, "wear", wear, &err), RC_OK);
        for (size_t k = 0; k < N; k++)
            assert_true(fabs(wear[k] - cycles * 3 * k_wear * energy[k]) <= 1e-14 * node);
        assert_true(
            fabs(rc_wear_result(m)->wear_volume - cycles * 3 * k_wear * sum * s.dx * s.dy) <=
            1e-12 * rc_wear_result(m)->wear_volume);
    }
    for (size_t k = 0; k < N; k++)
        worn[k] = h[k] - wear[k];
    is = solve(s, worn,
               (struct rc_problem){.pair.estar = estar, .load = load, .tol = 1e-9, .threads = 1});
    assert_int_equal(rc_model_frame(m, "pressure", p, &err), RC_OK);
    for (size_t k = 0; k < N; k++) {
        off += fabs(p[k] - is.p[k]);
        all += is.p[k];
    }
    assert_true(off < 1e-6 * all);
    solved_free(&is);
    rc_model_free(m);
    law.track = node;
    assert_null(rc_wear_new(rc_elastic_new(&s, h, &contact, NULL, &err), h, &law, &err));
    assert_non_null(strstr(err.text, "wear by a given energy"));
    law.track = 0;
    energy[7] = -1;
    assert_null(rc_wear_new(rc_elastic_new(&s, h, &contact, NULL, &err), h, &law, &err));
    assert_non_null(strstr(err.text, "energy -1 J/m2 of node 7"));
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_energy_wears_exactly),
        cmocka_unit_test(phases_share_the_load),
        cmocka_unit_test(a_disc_that_sticks_carries_all),
        cmocka_unit_test(waves_decay),
        cmocka_unit_test(punches_become_even),
        cmocka_unit_test(a_ball_is_cut),
        cmocka_unit_test(a_cylinder_is_cut),
        cmocka_unit_test(a_roller_on_a_track),
        cmocka_unit_test(roughness_is_cut),
        cmocka_unit_test(valleys_close_evenly),
        cmocka_unit_test(a_ball_cuts_a_groove),
        cmocka_unit_test(waves_of_each_body_decay),
        cmocka_unit_test(a_smooth_body_is_a_track),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
