/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The loops of simd.h for one width: WIDTH doubles in a vector, NAME(x) names of that width,
 * TARGET what the compiler may use. The file that includes this sets them, once for each width.
 */
typedef double NAME(vector) __attribute__((vector_size(WIDTH * 8), aligned(8), may_alias));
typedef int64_t NAME(flags) __attribute__((vector_size(WIDTH * 8)));
#define VECTOR NAME(vector)
#define AT(place) (*(VECTOR *)(place))
#define FROM(place) (*(const VECTOR *)(place))

/* All columns for this number of vectors of one row. */
TARGET static inline __attribute__((always_inline)) void
NAME(fold_row)(int vectors, const double *src, size_t columns, ptrdiff_t near, ptrdiff_t far,
               double sign, double *q, size_t size)
{
    size_t j = 0;

    if (near == far) { /* offset zero */
#pragma GCC unroll 4
        for (int x = 0; x < vectors; x++)
            AT(q + x * WIDTH) = FROM(src - near + x * WIDTH);
        j = 1;
    }
    for (; j < columns; j++) {
        const double *a = src - near - (ptrdiff_t)j, *b = src - far + (ptrdiff_t)j;
#pragma GCC unroll 4
        for (int x = 0; x < vectors; x++)
            AT(q + j * size + x * WIDTH) = FROM(a + x * WIDTH) + sign * FROM(b + x * WIDTH);
    }
}

/* One source row to target rows first .. last-1 of a block; c[i] is the coefficient to row i. All counts are
 * constants at every call, so the sums stay in registers. */
TARGET static inline __attribute__((always_inline)) void
NAME(step)(VECTOR sum[RC_BLOCK][4], int vectors, const double *q, const double *c, int first,
           int last)
{
    VECTOR v[4];

#pragma GCC unroll 4
    for (int x = 0; x < vectors; x++)
        v[x] = FROM(q + x * WIDTH);
#pragma GCC unroll 4
    for (int i = first; i < last; i++) {
        double w = c[i];
#pragma GCC unroll 4
        for (int x = 0; x < vectors; x++)
            sum[i][x] += w * v[x];
    }
}

/* A block of RC_BLOCK target rows of this number of vectors. Folded rows lie in a ring; `begin` is that of
 * the first target row. The first source row of a column reaches only the first target row, the second two,
 * and so on; the last reaches only the last. */
TARGET static inline __attribute__((always_inline)) void
NAME(block)(int vectors, const struct rc_strip *s, const struct rc_column *column, size_t begin,
            size_t x0, double *out)
{
    VECTOR sum[RC_BLOCK][4];
    size_t ring = 2 * s->margin + RC_BLOCK;

#pragma GCC unroll 4
    for (int i = 0; i < RC_BLOCK; i++)
#pragma GCC unroll 4
        for (int x = 0; x < vectors; x++)
            sum[i][x] = (VECTOR){0}; /* not added to `out`, where small terms would lose digits */
    for (size_t j = 0; j < s->columns; j++) {
        ptrdiff_t n = column[j].last - column[j].first + 1;
        size_t first = (size_t)((ptrdiff_t)(begin + s->margin) - column[j].last);
        const double *start = s->ring + j * ring * RC_STRIP + x0, *end = start + ring * RC_STRIP;
        const double *row = start + (first < ring ? first : first - ring) * RC_STRIP;
        const double *c = column[j].c + column[j].last;

#define NEXT (c--, row = row + RC_STRIP == end ? start : row + RC_STRIP)
        if (n < RC_BLOCK) {
            for (ptrdiff_t r = 0; n > 0 && r < n + RC_BLOCK - 1; r++, NEXT)
                NAME(step)(sum, vectors, row, c, 0, RC_BLOCK);
            continue;
        }
        NAME(step)(sum, vectors, row, c, 0, 1);
        NEXT;
        NAME(step)(sum, vectors, row, c, 0, 2);
        NEXT;
        NAME(step)(sum, vectors, row, c, 0, 3);
        NEXT;
        for (ptrdiff_t r = RC_BLOCK - 1; r < n; r++, NEXT)
            NAME(step)(sum, vectors, row, c, 0, RC_BLOCK);
        NAME(step)(sum, vectors, row, c, 1, RC_BLOCK);
        NEXT;
        NAME(step)(sum, vectors, row, c, 2, RC_BLOCK);
        NEXT;
        NAME(step)(sum, vectors, row, c, 3, RC_BLOCK);
#undef NEXT
    }
#pragma GCC unroll 4
    for (int i = 0; i < RC_BLOCK; i++)
#pragma GCC unroll 4
        for (int x = 0; x < vectors; x++)
            AT(out + (size_t)i * s->out_stride + x * WIDTH) += sum[i][x];
}

TARGET static void
NAME(fold)(const struct rc_strip *s, size_t row, size_t place)
{
    enum {
        WIDE = 4 * WIDTH
    };
    const double *src = s->src + row * s->stride;
    double *q = s->ring + place * RC_STRIP;
    size_t x = 0, size = (2 * s->margin + RC_BLOCK) * RC_STRIP;

    for (; x + WIDE <= s->n; x += WIDE)
        NAME(fold_row)(4, src + x, s->columns, s->near, s->far, s->sign, q + x, size);
    for (; x < s->n; x += WIDTH)
        NAME(fold_row)(1, src + x, s->columns, s->near, s->far, s->sign, q + x, size);
}

TARGET static void
NAME(stencil)(const struct rc_strip *s)
{
    size_t ring = 2 * s->margin + RC_BLOCK, begin = 0, end = 2 * s->margin;

    for (size_t r = 0; r < end; r++)
        NAME(fold)(s, r, r);
    for (size_t y = 0; y < s->rows; y += RC_BLOCK) {
        for (size_t r = 0; r < RC_BLOCK; r++, end = end + 1 == ring ? 0 : end + 1)
            NAME(fold)(s, 2 * s->margin + y + r, end);
        for (int k = 0; k < 2; k++) {
            const struct rc_column *column = s->column[k];
            double *out = s->out[k] + y * s->out_stride;
            if (column == NULL)
                continue;
#if WIDTH == 8 /* 32 registers: 16 sums, 4 values, coefficients */
            if (s->n > 16)
                NAME(block)(4, s, column, begin, 0, out);
            else if (s->n > 8)
                NAME(block)(2, s, column, begin, 0, out);
            else
                NAME(block)(1, s, column, begin, 0, out);
#else /* 16 registers: 8 sums */
            for (size_t x = 0; x < s->n; x += 2 * WIDTH)
                NAME(block)(2, s, column, begin, x, out + x);
#endif
        }
        begin = begin + RC_BLOCK < ring ? begin + RC_BLOCK : begin + RC_BLOCK - ring;
    }
}

/* Adds value times rows of c at their targets. */
TARGET static inline __attribute__((always_inline)) void
NAME(add_rows)(size_t vectors, double value, const double *c, double *out, size_t rows,
               size_t stride)
{
#if WIDTH == 8
    /* Stores across cache lines are slow: shift the coefficients to the start of a line. */
    size_t shift = (uintptr_t)out / sizeof *out % 8;
    const __m512i each = _mm512_setr_epi64(8, 9, 10, 11, 12, 13, 14, 15);
    const __m512i from = _mm512_sub_epi64(each, _mm512_set1_epi64((long long)shift));
    const __m512d factor = _mm512_set1_pd(value);

    out -= shift;
    for (size_t y = 0; y < rows; y++, c += vectors * 8, out += stride) {
        __m512d before = _mm512_setzero_pd();
#pragma GCC unroll 8
        for (size_t v = 0; v <= vectors; v++) {
            __m512d here = v < vectors ? _mm512_loadu_pd(c + v * 8) : _mm512_setzero_pd();
            __m512d shifted = _mm512_permutex2var_pd(before, from, here);
            _mm512_storeu_pd(out + v * 8,
                             _mm512_fmadd_pd(factor, shifted, _mm512_loadu_pd(out + v * 8)));
            before = here;
        }
    }
#else
    for (size_t y = 0; y < rows; y++, c += vectors * WIDTH, out += stride)
#pragma GCC unroll 8
        for (size_t v = 0; v < vectors; v++)
            AT(out + v * WIDTH) += value * FROM(c + v * WIDTH);
#endif
}

TARGET static inline __attribute__((always_inline)) void
NAME(scatter_all)(size_t vectors, const struct rc_scatter *s)
{
    for (size_t i = 0; i < s->n; i++) {
        ptrdiff_t x = (ptrdiff_t)(s->place[i] & 0xffff) + s->left;
        ptrdiff_t y = (ptrdiff_t)(s->place[i] >> 16) + s->top;
        ptrdiff_t first = y < 0 ? -y : 0, last = (ptrdiff_t)s->high - y;

        last = last < (ptrdiff_t)s->rows ? last : (ptrdiff_t)s->rows;
        if (first < last && x < (ptrdiff_t)s->wide && x + (ptrdiff_t)s->width > 0)
            NAME(add_rows)
        (vectors, s->value[i], s->c + first * (ptrdiff_t)s->width,
         s->out + (y + first) * (ptrdiff_t)s->out_stride + x, (size_t)(last - first),
         s->out_stride);
    }
}

TARGET static void
NAME(scatter)(const struct rc_scatter *s)
{
    if (s->width == 8)
        NAME(scatter_all)(8 / WIDTH, s);
    else if (s->width == 16)
        NAME(scatter_all)(16 / WIDTH, s);
    else if (s->width == 24)
        NAME(scatter_all)(24 / WIDTH, s);
    else
        NAME(scatter_all)(s->width / WIDTH, s);
}

TARGET static void
NAME(product)(const double *k, const double *q, size_t n, double *out, size_t stride)
{
    enum {
        VECTORS = WIDTH == 8 ? 4 : 2
    };

    for (size_t x = 0; x < RC_STRIP; x += VECTORS * WIDTH) {
        VECTOR sum[RC_BLOCK][4];
#pragma GCC unroll 4
        for (int i = 0; i < RC_BLOCK; i++)
#pragma GCC unroll 4
            for (int v = 0; v < VECTORS; v++)
                sum[i][v] = (VECTOR){0};
        for (size_t a = 0; a < n; a++)
            NAME(step)(sum, VECTORS, k + x - a, q + a * RC_BLOCK, 0, RC_BLOCK);
#pragma GCC unroll 4
        for (int i = 0; i < RC_BLOCK; i++)
#pragma GCC unroll 4
            for (int v = 0; v < VECTORS; v++)
                AT(out + (size_t)i * stride + x + (size_t)v * WIDTH) += sum[i][v];
    }
}

TARGET static void
NAME(weighted_sum)(size_t t, const double *s, const double *const *near, const double *const *far,
                   const double *first, size_t n, double *out)
{
    size_t x = 0;

    for (; x + 4 * WIDTH <= n; x += 4 * WIDTH) {
        VECTOR sum[4] = {{0}};
#pragma GCC unroll 4
        for (int v = 0; v < 4; v++)
            if (first != NULL)
                sum[v] = FROM(first + x + v * WIDTH);
        for (size_t i = 0; i < t; i++) {
            double w = s[i];
            const double *a = near[i] + x, *b = far[i] + x;
#pragma GCC unroll 4
            for (int v = 0; v < 4; v++)
                sum[v] += w * (FROM(a + v * WIDTH) + FROM(b + v * WIDTH));
        }
#pragma GCC unroll 4
        for (int v = 0; v < 4; v++)
            AT(out + x + v * WIDTH) = sum[v];
    }
    for (; x + WIDTH <= n; x += WIDTH) {
        VECTOR sum = {0};
        if (first != NULL)
            sum = FROM(first + x);
        for (size_t i = 0; i < t; i++)
            sum += s[i] * (FROM(near[i] + x) + FROM(far[i] + x));
        AT(out + x) = sum;
    }
    for (; x < n; x++) {
        double sum = first != NULL ? first[x] : 0;
        for (size_t i = 0; i < t; i++)
            sum += s[i] * (near[i][x] + far[i][x]);
        out[x] = sum;
    }
}

TARGET static void
NAME(deinterleave)(const double *restrict src, size_t n, double *restrict even,
                   double *restrict odd)
{
    for (size_t k = 0; k < n / 2; k++) {
        even[k] = src[2 * k];
        odd[k] = src[2 * k + 1];
    }
    if (n % 2 != 0)
        even[n / 2] = src[n - 1];
}

TARGET static void
NAME(interleave)(const double *restrict even, const double *restrict odd, size_t n,
                 double *restrict out)
{
    for (size_t k = 0; k < n / 2; k++) {
        out[2 * k] = even[k];
        out[2 * k + 1] = odd[k];
    }
    if (n % 2 != 0)
        out[n - 1] = even[n / 2];
}

TARGET static size_t
NAME(find_nonzero)(const double *src, size_t n, uint32_t first, uint32_t *list)
{
    size_t found = 0;

#if WIDTH == 8
    const __m256i each = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    for (size_t x = 0; x < n; x += 8) {
        __mmask8 some =
            _mm512_cmp_pd_mask(_mm512_loadu_pd(src + x), _mm512_setzero_pd(), _CMP_NEQ_UQ);
        __m256i at = _mm256_add_epi32(each, _mm256_set1_epi32((int)(first + x)));
        _mm256_storeu_si256((__m256i_u *)(void *)(list + found),
                            _mm256_maskz_compress_epi32(some, at));
        found += (size_t)__builtin_popcount(some);
    }
#else
    for (size_t x = 0; x < n; x++) {
        list[found] = first + (uint32_t)x;
        found += src[x] != 0;
    }
#endif
    return found;
}

TARGET static size_t
NAME(count_nonzero)(const double *src, size_t n)
{
    const VECTOR zero = {0};
    NAME(flags) sum = {0}; /* comparison gives -1 or 0 */
    size_t total = 0, k = 0;

    for (; k + WIDTH <= n; k += WIDTH)
        sum -= (NAME(flags))(FROM(src + k) != zero);
    for (int v = 0; v < WIDTH; v++)
        total += (size_t)sum[v];
    for (; k < n; k++)
        total += src[k] != 0;
    return total;
}

static const struct rc_simd NAME(simd) = {
    .stencil = NAME(stencil),
    .scatter = NAME(scatter),
    .product = NAME(product),
    .weighted_sum = NAME(weighted_sum),
    .deinterleave = NAME(deinterleave),
    .interleave = NAME(interleave),
    .find_nonzero = NAME(find_nonzero),
    .count_nonzero = NAME(count_nonzero),
};

#undef VECTOR
#undef AT
#undef FROM
