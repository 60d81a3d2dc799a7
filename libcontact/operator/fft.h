/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The parts of the transform engine. One transform of the source serves several kernels on one grid, in
 * double or single precision, on any boundary. Internal: never installed.
 *
 * Only fft_body.h, compiled once for each precision, uses FFTW.
 */
#ifndef RC_FFT_H
#define RC_FFT_H

#include <signal.h>

#include "libcontact/body/body.h"
#include "libcontact/memory.h"
#include "libcontact/ranks/ranks.h"

enum rc_precision {
    RC_DOUBLE,
    RC_SINGLE /* single inside and in the rows of a chain; maps are double on both sides */
};

struct rc_fft;
struct rc_spectrum; /* transform of a kernel: a quarter of its values, real */

/* RC_FAIL if its datum is not 0, for the default, or positive and finite. */
enum rc_status rc_boundary_check(struct rc_boundary boundary, struct rc_err *err);

/* `shape` is that of the whole map. Where ranks share the map (NULL: none), maps and rows are those held
 * here, row 0 is the first of them. Spectra have the columns that this rank multiplies. The plan works in the
 * memory of `lender`, another plan that outlives it; the two never run at the same time. If `lender` is NULL
 * or its memory too small, the plan allocates its own. */
struct rc_fft *rc_fft_new(const struct rc_ranks *ranks, struct rc_fft *lender,
                          const struct rc_shape *shape, struct rc_boundary boundary,
                          enum rc_precision precision, size_t threads, struct rc_err *err);
/* The same for every 2^level-th row and column of a larger map, where 2^level divides rc_rows_unit of
 * that map. `shape` is that of the coarser map. Each of its rows belongs to the rank that has the row
 * of the larger map. */
struct rc_fft *rc_fft_new_coarser(const struct rc_ranks *ranks, struct rc_fft *lender,
                                  const struct rc_shape *shape, size_t level,
                                  struct rc_boundary boundary, enum rc_precision precision,
                                  size_t threads, struct rc_err *err);
/* The same transforms, with the spectra of rc_fft_new, of a map in a frame. The frame is x columns and
 * y rows of the padding on either side of the map, at most half of the padding; 0 along an axis that
 * repeats. Row and column 0 are the first of the frame. Its rows belong to the ranks with the first and
 * the last row of the map. Within the map a kernel acts as before; over distances that exceed the
 * padding it acts around the period. Chains only. */
struct rc_frame {
    size_t x, y;
};
/* The factor of node `at` of a framed row or column, in which the map has the n nodes from `first` on: 1 on
 * the map, and beyond it a linear decrease to 0 at the end of `frame` nodes. */
static inline float
rc_frame_fade(size_t at, size_t first, size_t n, size_t frame)
{
    const size_t off = at < first ? first - at : at < first + n ? 0 : at - first - n + 1;

    return 1 - (float)off / (float)(frame + 1);
}
struct rc_fft *rc_fft_new_framed(const struct rc_ranks *ranks, struct rc_fft *lender,
                                 const struct rc_shape *shape, struct rc_boundary boundary,
                                 const struct rc_frame *frame, enum rc_precision precision,
                                 size_t threads, struct rc_err *err);
void rc_fft_free(struct rc_fft *fft);
RC_OWNER(rc_fft)
/* Sides of the transformed grid: with padding along free axes; a profile has none across it. */
void rc_fft_period(const struct rc_shape *shape, struct rc_boundary boundary, size_t *px,
                   size_t *py);

/* NULL when memory is short. */
struct rc_spectrum *rc_spectrum_new(const struct rc_fft *fft, struct rc_err *err);
void rc_spectrum_free(struct rc_spectrum *spectrum);
RC_OWNER(rc_spectrum)
/* Its value at wave number 0: for a kernel given by values, their sum over a period. */
double rc_spectrum_total(const struct rc_spectrum *spectrum);
/* Sets it to the spectrum of a kernel: along free axes the transform of its values, along axes that
 * repeat its symbol. RC_FAIL when memory is short or the kernel has no symbol. */
enum rc_status rc_spectrum_set(struct rc_spectrum *spectrum, const struct rc_fft *fft,
                               const struct rc_kernel *kernel, struct rc_err *err);
/* The same with a boundary of the kernel, at least one axis of which is free, and which may differ from
 * that of the transforms (see operator.h, rc_whole). Several threads call `each` with the n wave
 * numbers along y of column i along x. It may change them before they are stored. Columns are those
 * held here: rc_fft_columns. */
typedef void rc_column(void *ctx, size_t i, size_t n, double *column);
enum rc_status rc_spectrum_set_by(struct rc_spectrum *spectrum, const struct rc_fft *fft,
                                  const struct rc_kernel *kernel, struct rc_boundary boundary,
                                  rc_column *each, void *ctx, struct rc_err *err);
/* An rc_column that stores the n numbers of column i at ctx + i n; ctx is an array of double. */
rc_column rc_keep_column;
/* Wave numbers of a column, and of its entries, in the padded map, rad/m. */
double rc_fft_qx(const struct rc_fft *fft, size_t i);
double rc_fft_qy(const struct rc_fft *fft, size_t j);
void rc_fft_waves(const struct rc_fft *fft, size_t *columns, size_t *n);
/* Columns that this rank multiplies: `n` from `first` on; without ranks all. */
void rc_fft_columns(const struct rc_fft *fft, size_t *first, size_t *n);
/* The first column of rank r; of as many ranks as there are: the number of columns. */
size_t rc_fft_column_of(const struct rc_fft *fft, size_t r);
/* Rows of the map held here. */
size_t rc_fft_rows(const struct rc_fft *fft);
/* Number of threads that may pass rows of a quarter. */
int rc_fft_threads(const struct rc_fft *fft);
/* The reciprocal of another kernel's spectrum: the inverse of the padded circulant, or of the symbol; zero
 * where that is zero. It is computed during use from `of`, which outlives it, and serves only chains. NULL
 * when memory is short. */
struct rc_spectrum *rc_spectrum_new_reciprocal(const struct rc_fft *fft,
                                               const struct rc_spectrum *of, struct rc_err *err);
/* Changes the spectrum of K, in chains, to that of K + plus I + row R'R, where R sums each row. With
 * `inverse` the spectrum is that of K^-1. plus and row 0 restore K. */
void rc_spectrum_add(struct rc_spectrum *spectrum, const struct rc_fft *fft, bool inverse,
                     double plus, double row);

/* Kernels of rc_fft_fields. Unless both axes repeat, a kernel is given by a quarter of its period, its
 * values at the offsets i < *nx, j < *ny; along an axis that repeats, waves take the place of offsets.
 * rc_fft_quarter_line transforms a line of each of `count` kernels along the first free axis, x or y;
 * lines[k] is odd where bit k of `odd` is set, or NULL. Any thread of one OpenMP team calls it, for
 * every line whose transform is not known. Ranks compute rows *first .. *first + *n - 1 each. When all
 * rows are transformed, rc_fft_quarter_turn exchanges the rows held here for columns, within
 * rc_fft_quarter_size numbers: the columns of rc_fft_columns, with rc_fft_quarter_wide numbers from row
 * to row. It fails when memory is short, which cannot happen without ranks. */
void rc_fft_quarter(const struct rc_fft *fft, size_t *nx, size_t *ny);
void rc_fft_quarter_rows(const struct rc_fft *fft, size_t *first, size_t *n);
size_t rc_fft_quarter_size(const struct rc_fft *fft);
size_t rc_fft_quarter_wide(const struct rc_fft *fft);
void rc_fft_quarter_line(const struct rc_fft *fft, size_t count, unsigned odd,
                         double *const *lines);
enum rc_status rc_fft_quarter_turn(const struct rc_fft *fft, double *quarter, struct rc_err *err);
/* Where both axes repeat a kernel is given by its transform, over (-i)^(number of odd directions). Wave
 * numbers are qx, qy >= 0 in rad/m. Several threads call it for a column i of equal qx: out[j] at qy[j], j <
 * n. Waves of two nodes are left out in a direction in which the kernel is odd: they are zero at all
 * nodes. */
typedef void rc_symbol(const void *of, size_t i, double qx, size_t n, const double *qy,
                       double *out);

/* u = K p. u and p may be the same. */
void rc_fft_apply(struct rc_fft *fft, const struct rc_spectrum *kernel, const double *p, double *u);

/* Processes a row in the middle of a chain: row j of nx numbers in the plan's precision. It writes the row
 * that is transformed next and returns false where this row is zero; the last function only reads. Several
 * threads share the rows; each row is passed once. */
enum {
    RC_CHAIN = 4
};
typedef bool rc_row(void *ctx, size_t j, void *row);
/* rows[0] writes the source of kernels[0], rows[k] turns its field into the source of kernels[k], and rows[n]
 * reads the last field. There are n <= RC_CHAIN kernels, n + 1 functions, and no map between them. */
void rc_fft_chain(struct rc_fft *fft, size_t n, const struct rc_spectrum *const *kernels,
                  rc_row *const *rows, void *ctx);
/* If this is not NULL, and its value not 0, convolutions that the same thread begins skip their rows and
 * lines of columns. Their results are then undefined. */
extern _Thread_local const volatile sig_atomic_t *rc_fft_hurry;
/* Keeps the whole transform of p as one of RC_SOURCES; then u = K p for any number of kernels. */
enum {
    RC_SOURCES = 3
};
enum rc_status rc_fft_load(struct rc_fft *fft, size_t source, const double *p, struct rc_err *err);
/* Up to RC_FIELDS fields at once, u = the sum of weight K p over the n > 0 terms of each. They share the
 * transforms of kernels and the passes over the sources. The first weight of a field is 1. The spectra are
 * made line by line of columns, and are not kept. Kernels count as zero from column `columns` on. RC_FAIL
 * when memory is short. */
enum {
    RC_FIELDS = 2,
    RC_LINES = RC_FIELDS * RC_SOURCES /* most kernels */
};
struct rc_fft_kernel {
    unsigned parity;
    const double *quarter; /* after rc_fft_quarter_turn */
    rc_symbol *symbol;     /* both axes repeat */
    const void *of;
};
struct rc_fft_sum {
    double *u;
    size_t n;
    struct rc_fft_term {
        size_t kernel, source;
        double weight;
    } term[RC_SOURCES];
};
enum rc_status rc_fft_fields(struct rc_fft *fft, size_t columns, size_t kernels,
                             const struct rc_fft_kernel *kernel, size_t n,
                             const struct rc_fft_sum *sum, struct rc_err *err);

/* Transforms maps to waves and back separately, for sums over several maps. Each column held here has
 * rc_fft_length numbers in the plan's precision: first their real parts, then their imaginary parts. Number t
 * stands for wave number rc_fft_wave(fft, t) along y, and column i lies at 2 i rc_fft_length real numbers
 * from `waves`. Where `waves` is NULL, `column`, called by several threads, reads or writes one column after
 * the other. Forward divides by the nodes of the (padded) map, back does not. */
typedef void rc_wave_column(void *ctx, size_t i, void *column);
size_t rc_fft_length(const struct rc_fft *fft);
size_t rc_fft_wave(const struct rc_fft *fft, size_t t);
/* For each number t of a column: its place in a column of the quarter of a spectrum, and -1 where it is the
 * mirror image of the number there, else 1. False when memory is short. */
bool rc_fft_fold(const struct rc_fft *fft, struct rc_store *own, size_t **place,
                 signed char **mirror);
void rc_fft_forward(struct rc_fft *fft, rc_row *row, void *ctx, void *waves,
                    rc_wave_column *column);
void rc_fft_back(struct rc_fft *fft, const void *waves, rc_wave_column *column, rc_row *row,
                 void *ctx);

/* ---- between fft.c and fft_body.h ---- */

/* Columns have length py = radix * m and are transformed as `radix` interleaved transforms of length m: with
 * w = exp(-2 pi i / py), *     X[radix k + r] = sum over n < m of y_r[n] exp(-2 pi i n k / m), y_r[n] = w^(r
 * n) sum over s < 4 of (-i)^(r s) x[n + s m],       radix = 4 * where only the first ny of x are not zero.
 * With radix = 1 FFTW transforms the whole column. * A spectrum is determined by a quarter of it, cx columns
 * of cy numbers s(q), q <= py/2. A column is stored in the order of the residues r: A[k] = s(radix k) up to
 * the middle and, for radix 4, B[k] = s(4k + 1) for all k < m (beyond the middle by symmetry, which also
 * gives residue 3) and C[k] = s(4k + 2) up to the middle: cy numbers in all. */
struct rc_layout {
    size_t nx, ny;
    size_t px, py; /* transform lengths                                  */
    size_t cx, cy; /* px/2 + 1, py/2 + 1                                 */
    size_t stride; /* complex numbers from row to row: whole cache lines */
    size_t radix, m;
    int threads;
    /* The part held here, without ranks all: rows, columns, and complex numbers from row to row where all
     * rows of these columns are together. */
    size_t rows, first, columns, wide;
    const struct rc_turn *turn; /* rows to columns in units of `line`; NULL: no ranks */
};

/* Complex numbers of the rows in work: columns of all rows and, with ranks, rows to send and receive. */
static inline size_t
rc_layout_rows(const struct rc_layout *l)
{
    return l->ny * l->wide + (l->turn == NULL ? 0 : l->rows * l->stride);
}

/* (a + b s) / (c + d s) of the numbers s of a spectrum; 0 where c + d s is 0. */
struct rc_ratio {
    double a, b, c, d;
};
/* The factor of a transform: this ratio of a spectrum, stored as above. */
struct rc_factor {
    const void *spectrum;
    unsigned parity;
    struct rc_ratio ratio, first; /* `first`: ratio of the first column, of waves along y */
};
/* A row function, and the factor of its row's transform. */
struct rc_link {
    rc_row *row;
    struct rc_factor factor;
};

/* Returns spectra of the kernels in the columns c .. c + n - 1 of those held here, at most a line of them:
 * column b of kernel k is stored as above at (k line + b) cy. Several threads call it. */
typedef const void *rc_line_spectra(void *ctx, size_t c, size_t n);

struct rc_fft_ops {
    size_t real_size; /* bytes of a real number                                           */
    size_t line;      /* complex numbers per row that are transformed together as columns */
    /* NULL: out of memory. `lent`: memory for the rows in work, rc_layout_rows complex numbers, which
     * outlives the plan; NULL: the plan allocates it. */
    void *(*new)(const struct rc_layout *layout, void *lent);
    void (*free)(void *plan);
    /* Memory of the plan that is free between its transforms; NULL when the plan has less than `bytes`. */
    void *(*workspace)(void *plan, size_t bytes);
    /* Stores s(q), q < cy, times `scale` as column c of a spectrum; mirror -1: odd in y. */
    void (*store)(const struct rc_layout *layout, size_t c, double scale, double mirror,
                  const double *s, void *spectrum);
    void (*apply)(void *plan, const struct rc_factor *factor, const double *p, double *u);
    void (*chain)(void *plan, size_t n, const struct rc_link *links, rc_row *last, void *ctx);
    bool (*load)(void *plan, size_t source, const double *p); /* false: out of memory */
    /* rc_fft_fields; false: out of memory. */
    bool (*fields)(void *plan, size_t columns, rc_line_spectra *spectra, void *ctx,
                   const struct rc_fft_kernel *kernel, size_t n, const struct rc_fft_sum *sum);
    /* rc_fft_forward and rc_fft_back. */
    void (*forward)(void *plan, rc_row *row, void *ctx, void *waves, rc_wave_column *column);
    void (*back)(void *plan, const void *waves, rc_wave_column *column, rc_row *row, void *ctx);
};
extern const struct rc_fft_ops rc_fft_double, rc_fft_single;

#endif
