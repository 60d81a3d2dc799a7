/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The quality of the preconditioner:
 *
 *     bench-spectrum [-n SIZE,SIZE...]
 *
 * Extreme eigenvalues of M K between the nodes of contact, on vectors of zero mean. M is E' A E
 * (preconditioner.h), or A cut to those nodes (E the extension by zero). The Lanczos process finds them: they
 * are eigenvalues of the tridiagonal matrix from conjugate gradients with a random right-hand side. Contact
 * sets are those of solved rough surfaces, and a disc.
 */
#include "bench.h"

#include <float.h>
#include <unistd.h>

#include "libcontact/solver/preconditioner.h"

enum {
    STEPS = 60
};

struct row {
    const char *name;
    struct rc_boundary boundary;
    double mean; /* pressure over E* and RMS slope; 0: a disc of 0.3 of the map */
};

/* clang-format off */
static const struct row rows[] = {
    {"disc", FREE, 0},         {"rough", FREE, 0.02},     {"rough", FREE, 0.2},
    {"disc", PERIODIC, 0},     {"rough", PERIODIC, 0.004}, {"rough", PERIODIC, 0.18},
    {"rough", PERIODIC, 0.8},
};
/* clang-format on */

static size_t
choose(const struct row *row, struct rc_shape s, unsigned char *w)
{
    static const double slope = 0.1;
    size_t n = s.nx * s.ny, count = 0;
    double *h = must(malloc(n * sizeof *h)), side = (double)s.nx;
    struct rc_selfaffine what = {
        .hurst = 0.8, .rms_slope = slope, .short_cut = 8, .rolloff = side / 8, .seed = 5};
    struct rc_problem problem = {.boundary = row->boundary,
                                 .pair.estar = 1,
                                 .tol = 1e-5,
                                 .load = row->mean * slope * (double)n};
    struct rc_solver *solver;
    struct rc_err err;

    for (size_t k = 0; k < n; k++)
        w[k] = hypot((double)(k % s.nx) - side / 2, (double)(k / s.nx) - side / 2) < 0.3 * side;
    if (row->mean > 0) {
        must_be(rc_synth_selfaffine(&s, &what, h, &err), &err);
        solver = solver_new(s, h, problem);
        solver_run(solver);
        for (size_t k = 0; k < n; k++)
            w[k] = rc_solver_pressure(solver)[k] > 0;
        rc_solver_free(solver);
    }
    free(h);
    for (size_t k = 0; k < n; k++)
        count += w[k];
    return count;
}

struct operators {
    size_t n, count;
    const unsigned char *w;
    struct rc_fft *fft;
    struct rc_spectrum *kernel, *inverse;
    struct rc_preconditioner *extension; /* NULL: A cut to W */
    float *single;                       /* 2n               */
};

/* Sets v to 0 outside of W, and removes the mean on W. */
static void
restrict_to_set(const struct operators *o, double *v)
{
    double mean = 0;

    for (size_t k = 0; k < o->n; k++)
        mean += o->w[k] ? v[k] / (double)o->count : 0;
    for (size_t k = 0; k < o->n; k++)
        v[k] = o->w[k] ? v[k] - mean : 0;
}

static void
precondition(const struct operators *o, const double *r, double *z)
{
    double size = 0;

    if (o->extension == NULL) {
        rc_fft_apply(o->fft, o->inverse, r, z);
    } else {
        for (size_t k = 0; k < o->n; k++)
            size = fmax(size, fabs(r[k]));
        for (size_t k = 0; k < o->n; k++)
            o->single[k] = (float)(r[k] / size);
        rc_preconditioner_apply(o->extension, o->single, 0, o->single + o->n, NULL, NULL);
        for (size_t k = 0; k < o->n; k++)
            z[k] = size * (double)o->single[o->n + k];
    }
    restrict_to_set(o, z);
}

static double
product(size_t n, const double *a, const double *b)
{
    double sum = 0;

    for (size_t k = 0; k < n; k++)
        sum += a[k] * b[k];
    return sum;
}

/* Eigenvalues of the symmetric tridiagonal matrix below x (Sturm). */
static size_t
below(size_t n, const double *diagonal, const double *square, double x)
{
    size_t count = 0;
    double q = 1;

    for (size_t k = 0; k < n; k++) {
        q = diagonal[k] - x - (k > 0 ? square[k - 1] / (q == 0 ? DBL_MIN : q) : 0);
        count += q < 0;
    }
    return count;
}

static double
eigenvalue(size_t n, const double *diagonal, const double *square, size_t which)
{
    double low = 0, high = 1e9;

    for (int round = 0; round < 200; round++) {
        double middle = (low + high) / 2;
        if (below(n, diagonal, square, middle) > which)
            high = middle;
        else
            low = middle;
    }
    return low;
}

/* Preconditioned conjugate gradients: T has 1/a_k + b_(k-1)/a_(k-1) on the diagonal and
 * sqrt(b_k)/a_k beside it. */
static void
extremes(const struct operators *o, double *least, double *most)
{
    size_t n = o->n, k;
    double *v = must(calloc(4 * n, sizeof *v)), *r = v, *z = v + n, *d = v + 2 * n, *q = v + 3 * n;
    double diagonal[STEPS], square[STEPS], rz, first, a = 1, b = 0;

    for (size_t i = 0; i < n; i++)
        r[i] = (double)rand() / RAND_MAX - 0.5;
    restrict_to_set(o, r);
    precondition(o, r, z);
    memcpy(d, z, n * sizeof *d);
    first = rz = product(n, r, z);
    for (k = 0; k < STEPS && rz > 1e-10 * first; k++) {
        double before = a, ratio = b, next;
        rc_fft_apply(o->fft, o->kernel, d, q);
        restrict_to_set(o, q);
        a = rz / product(n, d, q);
        diagonal[k] = 1 / a + (k > 0 ? ratio / before : 0);
        for (size_t i = 0; i < n; i++)
            r[i] -= a * q[i];
        precondition(o, r, z);
        next = product(n, r, z);
        b = next / rz;
        square[k] = b / (a * a);
        rz = next;
        for (size_t i = 0; i < n; i++)
            d[i] = z[i] + b * d[i];
    }
    *least = eigenvalue(k, diagonal, square, 0);
    *most = eigenvalue(k, diagonal, square, k - 1);
    free(v);
}

static void
spectrum(const struct row *row, size_t m)
{
    struct rc_shape s = {m, m, 1, 1};
    size_t n = m * m;
    unsigned char *w = must(malloc(n));
    struct operators o = {.n = n, .w = w, .count = choose(row, s, w)};
    struct rc_operator_options options = {.boundary = row->boundary,
                                          .pair = &(struct rc_pair){.estar = 1}};
    struct rc_operator *op;
    double least[2], most[2];
    struct rc_err err;

    o.fft = must(rc_fft_new(NULL, NULL, &s, row->boundary, RC_DOUBLE, 0, &err));
    o.kernel = must(rc_spectrum_new(o.fft, &err));
    must_be(rc_spectrum_set(o.kernel, o.fft, &rc_kernel_of_one, &err), &err);
    o.inverse = must(rc_spectrum_new_reciprocal(o.fft, o.kernel, &err));
    o.single = must(malloc(2 * n * sizeof *o.single));
    extremes(&o, &least[0], &most[0]);
    op = must(rc_operator_new(&s, &options, &err));
    o.extension = must(rc_preconditioner_new(op, &err));
    rc_preconditioner_set(o.extension, w);
    extremes(&o, &least[1], &most[1]);
    printf("%-8s %-8s %5zu %8.4f | %8.4f %8.3f | %8.4f %8.3f\n", row->name,
           rc_boundary_word(row->boundary), m, (double)o.count / (double)n, least[1], most[1],
           least[0], most[0]);
    fflush(stdout);
    rc_preconditioner_free(o.extension);
    rc_operator_free(op);
    rc_spectrum_free(o.kernel);
    rc_spectrum_free(o.inverse);
    rc_fft_free(o.fft);
    free(o.single);
    free(w);
}

int
main(int argc, char **argv)
{
    size_t sizes[16] = {128, 256, 512, 1024}, count = 4;

    for (int option; (option = getopt(argc, argv, "n:")) != -1;)
        if (option == 'n')
            count = sizes_read(optarg, 16, sizes);
        else
            return 2;
    printf("%-8s %-8s %5s %8s | %17s | %17s\n", "contact", "boundary", "nodes", "fraction",
           "E' A E: from to", "A cut: from to");
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (size_t i = 0; i < count; i++)
            spectrum(&rows[k], sizes[i]);
    return 0;
}
