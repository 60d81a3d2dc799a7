/*
 * The loops of lanes.h for one width: WIDTH doubles in a vector, NAME(x) names of that width,
 * TARGET what the compiler may use. The file that includes this sets them, once for each width.
 */
typedef double NAME(vector) __attribute__((vector_size(WIDTH * 8), aligned(8), may_alias));
#define VECTOR NAME(vector)
#define AT(place) (*(VECTOR *)(place))
#define FROM(place) (*(const VECTOR *)(place))

/* So many vectors of one row, all columns. */
TARGET static inline __attribute__((always_inline)) void
NAME(fold_row)(int vectors, const double *src, size_t columns, ptrdiff_t near, ptrdiff_t far,
               double sign, double *q, size_t size)
{
    size_t j = 0;

    if (near == far) { /* the offset zero */
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

TARGET static void
NAME(fold)(const double *src, size_t stride, size_t rows, size_t n, size_t columns, ptrdiff_t near,
           ptrdiff_t far, double sign, double *q, size_t size)
{
    enum {
        WIDE = 4 * WIDTH
    };

    for (size_t r = 0; r < rows; r++, src += stride, q += RC_STRIP) {
        size_t x = 0;
        for (; x + WIDE <= n; x += WIDE)
            NAME(fold_row)(4, src + x, columns, near, far, sign, q + x, size);
        for (; x < n; x += WIDTH)
            NAME(fold_row)(1, src + x, columns, near, far, sign, q + x, size);
    }
}

/* One source row to target rows first .. last-1 of a block; c[i] is the coefficient to row i. All
 * counts are constants where this is called: the sums stay in registers. */
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

/* A block of RC_BLOCK target rows of so many vectors. Of a column's source rows the first reaches
 * only the first target row, the next two, and so on; the last only the last. */
TARGET static inline __attribute__((always_inline)) void
NAME(block)(int vectors, const double *q, size_t size, size_t columns,
            const struct rc_column *column, double *out, size_t stride)
{
    VECTOR sum[RC_BLOCK][4];

#pragma GCC unroll 4
    for (int i = 0; i < RC_BLOCK; i++)
#pragma GCC unroll 4
        for (int x = 0; x < vectors; x++)
            sum[i][x] = (VECTOR){0}; /* not `out`: beside it, small terms lose their digits */
    for (size_t j = 0; j < columns; j++) {
        ptrdiff_t n = column[j].last - column[j].first + 1;
        const double *row = q + j * size - column[j].last * RC_STRIP;
        const double *c = column[j].c + column[j].last;

        if (n < RC_BLOCK) {
            for (ptrdiff_t r = 0; n > 0 && r < n + RC_BLOCK - 1; r++, row += RC_STRIP)
                NAME(step)(sum, vectors, row, c - r, 0, RC_BLOCK);
            continue;
        }
        NAME(step)(sum, vectors, row, c, 0, 1);
        NAME(step)(sum, vectors, row + RC_STRIP, c - 1, 0, 2);
        NAME(step)(sum, vectors, row + 2 * RC_STRIP, c - 2, 0, 3);
        row += 3 * RC_STRIP;
        c -= 3;
        for (ptrdiff_t r = RC_BLOCK - 1; r < n; r++, row += RC_STRIP, c--)
            NAME(step)(sum, vectors, row, c, 0, RC_BLOCK);
        NAME(step)(sum, vectors, row, c, 1, RC_BLOCK);
        NAME(step)(sum, vectors, row + RC_STRIP, c - 1, 2, RC_BLOCK);
        NAME(step)(sum, vectors, row + 2 * RC_STRIP, c - 2, 3, RC_BLOCK);
    }
#pragma GCC unroll 4
    for (int i = 0; i < RC_BLOCK; i++)
#pragma GCC unroll 4
        for (int x = 0; x < vectors; x++)
            AT(out + (size_t)i * stride + x * WIDTH) += sum[i][x];
}

TARGET static void
NAME(stencil)(const double *q, size_t size, size_t columns, const struct rc_column *column,
              double *out, size_t stride, size_t rows, size_t n)
{
    for (size_t y = 0; y < rows; y += RC_BLOCK, q += RC_BLOCK * RC_STRIP, out += RC_BLOCK * stride) {
#if WIDTH == 8 /* 32 registers: 16 sums, 4 values, coefficients */
        size_t x = 0;
        if (n > 16) {
            NAME(block)(4, q, size, columns, column, out, stride);
        } else if (n > 8) {
            NAME(block)(2, q + x, size, columns, column, out + x, stride);
        } else {
            NAME(block)(1, q + x, size, columns, column, out + x, stride);
        }
#else /* 16 registers: 8 sums */
        for (size_t x = 0; x < n; x += 2 * WIDTH)
            NAME(block)(2, q + x, size, columns, column, out + x, stride);
#endif
    }
}

TARGET static void
NAME(scatter)(double v, const double *c, size_t width, size_t rows, double *out, size_t stride)
{
    for (size_t y = 0; y < rows; y++, c += width, out += stride)
        for (size_t x = 0; x < width; x += WIDTH)
            AT(out + x) += v * FROM(c + x);
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
NAME(weigh)(size_t t, const double *s, const double *const *near, const double *const *far,
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
NAME(split)(const double *restrict src, size_t n, double *restrict even, double *restrict odd)
{
    for (size_t k = 0; k < n / 2; k++) {
        even[k] = src[2 * k];
        odd[k] = src[2 * k + 1];
    }
    if (n % 2 != 0)
        even[n / 2] = src[n - 1];
}

TARGET static void
NAME(join)(const double *restrict even, const double *restrict odd, size_t n, double *restrict out)
{
    for (size_t k = 0; k < n / 2; k++) {
        out[2 * k] = even[k];
        out[2 * k + 1] = odd[k];
    }
    if (n % 2 != 0)
        out[n - 1] = even[n / 2];
}

TARGET static size_t
NAME(count)(const double *src, size_t n)
{
    VECTOR sum = {0};
    double total = 0;
    size_t k = 0;

    for (; k + WIDTH <= n; k += WIDTH) {
        VECTOR one = {0};
        sum += FROM(src + k) != one ? one + 1 : one;
    }
    for (int v = 0; v < WIDTH; v++)
        total += sum[v];
    for (; k < n; k++)
        total += src[k] != 0;
    return (size_t)total;
}

static const struct rc_lanes NAME(lanes) = {
    .name = LANES,
    .fold = NAME(fold),
    .stencil = NAME(stencil),
    .scatter = NAME(scatter),
    .product = NAME(product),
    .weigh = NAME(weigh),
    .split = NAME(split),
    .join = NAME(join),
    .count = NAME(count),
};

#undef VECTOR
#undef AT
#undef FROM
