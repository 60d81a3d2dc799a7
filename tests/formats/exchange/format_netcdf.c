/* SPDX-License-Identifier: GPL-3.0-or-later */
/* NetCDF files made by this test are read in all versions and types; damaged files and files with wrong sizes
 * are refused. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "tests/formats/made/made.h"

extern const struct rc_format rc_format_netcdf;

struct cdf {
    unsigned version, type;
    const char *first, *second; /* names of the dimensions */
    uint64_t rows, columns;     /* their lengths; rows 0: records */
    double step_y;
    const char *unit;
    double fill, factor, offset;
    bool coordinates;
    int periodic; /* 1: along x, 2: along y, 3: both */
};

static const struct cdf cdf = {.version = 1,
                               .type = 6,
                               .first = "y",
                               .second = "x",
                               .rows = 2,
                               .columns = 3,
                               .step_y = 0.7,
                               .unit = "nm",
                               .fill = NAN,
                               .factor = 1,
                               .coordinates = true};

static const double counts[6] = {1, 2, 3, 100, 5, 6};

static void
cdf_count(struct bytes *b, const struct cdf *c, uint64_t n)
{
    add_number(b, n, c->version == 5 ? 8 : 4);
}

static void
cdf_text(struct bytes *b, const struct cdf *c, const char *text)
{
    size_t n = strlen(text);

    cdf_count(b, c, n);
    add(b, text, n);
    add(b, "\0\0\0", (4 - n % 4) % 4);
}

static void
cdf_list(struct bytes *b, const struct cdf *c, unsigned tag, size_t n)
{
    add_number(b, n == 0 ? 0 : tag, 4);
    cdf_count(b, c, n);
}

static void
cdf_number(struct bytes *b, const struct cdf *c, const char *name, double value)
{
    cdf_text(b, c, name);
    add_number(b, 6, 4);
    cdf_count(b, c, 1);
    add_f64(b, value);
}

static void
cdf_value(struct bytes *b, unsigned type, double value)
{
    static const unsigned char width[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};

    if (type == 5)
        add_f32(b, value);
    else if (type == 6)
        add_f64(b, value);
    else
        add_number(b, (uint64_t)(int64_t)value, width[type]);
}

/* Writes one variable; the second of two passes sets its position. */
static void
cdf_variable(struct bytes *b, const struct cdf *c, const char *name, size_t rank, unsigned first,
             const char *unit, unsigned type, uint64_t size, uint64_t at)
{
    const bool map = rank == 2, periodic = !map && (c->periodic & (strcmp(name, "x") == 0 ? 1 : 2));
    size_t attributes = (size_t)1 + periodic +
                        (map ? (size_t)!isnan(c->fill) + (c->factor != 1) + (c->offset != 0) : 0);

    cdf_text(b, c, name);
    cdf_count(b, c, rank);
    for (size_t k = 0; k < rank; k++)
        cdf_count(b, c, first + k);
    cdf_list(b, c, 12, attributes);
    cdf_text(b, c, "units");
    add_number(b, 2, 4);
    cdf_text(b, c, unit);
    if (periodic)
        cdf_number(b, c, "periodic", 1);
    if (map && !isnan(c->fill))
        cdf_number(b, c, "_FillValue", c->fill);
    if (map && c->factor != 1)
        cdf_number(b, c, "scale_factor", c->factor);
    if (map && c->offset != 0)
        cdf_number(b, c, "add_offset", c->offset);
    add_number(b, type, 4);
    cdf_count(b, c, size);
    add_number(b, at, c->version == 1 ? 4 : 8);
}

static struct bytes
cdf_write(const struct cdf *c, const uint64_t at[3])
{
    static const unsigned char width[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    size_t columns = (size_t)c->columns < 100 ? (size_t)c->columns : 3;
    size_t values = c->rows == 0 ? columns : 6;
    struct bytes b = {.big = true};

    add(&b, "CDF", 3);
    add_number(&b, c->version, 1);
    cdf_count(&b, c, c->rows == 0 ? 2 : 0);
    cdf_list(&b, c, 10, 2);
    cdf_text(&b, c, c->first);
    cdf_count(&b, c, c->rows);
    cdf_text(&b, c, c->second);
    cdf_count(&b, c, c->columns);
    cdf_list(&b, c, 12, 1);
    cdf_text(&b, c, "title");
    add_number(&b, 2, 4);
    cdf_text(&b, c, "of the file");
    cdf_list(&b, c, 11, c->coordinates ? 3 : 1);
    cdf_variable(&b, c, "heights", 2, 0, c->unit, c->type, (values * width[c->type] + 3) / 4 * 4,
                 at[0]);
    if (c->coordinates) {
        cdf_variable(&b, c, c->first, 1, 0, "um", 6, 8 * (c->rows == 0 ? 1 : c->rows), at[1]);
        cdf_variable(&b, c, c->second, 1, 1, "um", 5, 12, at[2]);
    }
    return b;
}

static struct bytes
cdf_file(const struct cdf *c)
{
    uint64_t at[3] = {0};
    struct bytes b = cdf_write(c, at);
    bool records = c->rows == 0;
    size_t rows = (size_t)(records ? 2 : c->rows), columns = (size_t)c->columns;

    if (rows * columns != 6 || rows > 6) { /* a header with a false size */
        rows = 2;
        columns = 3;
    }
    at[2] = b.n;
    at[0] = b.n + 12;
    at[1] = at[0];
    for (int run = 0; run < 2; run++) {
        drop(&b);
        b = cdf_write(c, at);
        for (size_t i = 0; i < 3; i++)
            add_f32(&b, 10 + 1.25 * (double)i);
        for (size_t j = 0; j < rows; j++) {
            for (size_t i = 0; i < columns; i++)
                cdf_value(&b, c->type, counts[j * columns + i]);
            while (b.n % 4 != 0 && c->coordinates && records)
                add(&b, "", 1);
            if (records && c->coordinates) {
                at[1] = run == 0 && j == 0 ? b.n : at[1];
                add_f64(&b, 1 - c->step_y * (1 - (double)j));
            }
        }
        while (b.n % 4 != 0)
            add(&b, "", 1);
        if (!records && c->coordinates) {
            at[1] = b.n;
            for (size_t j = 0; j < rows; j++)
                add_f64(&b, 3 + c->step_y * (double)j);
        }
    }
    return b;
}

static const char *const periods[] = {NULL, "x", "y", "yes"};

static void
check_cdf(const struct cdf *c, bool turned)
{
    struct bytes b = cdf_file(c);
    struct rc_file file = file_of(&b, "made");
    struct rc_grid *g;
    double v[6];

    assert_ptr_equal(rc_format_find(&file, NULL), &rc_format_netcdf);
    for (size_t k = 0; k < 6; k++) {
        double raw = counts[turned ? (k % 2) * 3 + k / 2 : k];
        v[k] = raw == c->fill ? NAN : (raw * c->factor + c->offset) * 1e-9;
    }
    g = read_well(&rc_format_netcdf, &b, 0);
    if (turned)
        check_map(g, 2, 3, 0.7e-6, 1.25e-6, v);
    else
        check_map(g, 3, 2, 1.25e-6, 0.7e-6, v);
    if (c->periodic == 0)
        assert_null(rc_grid_get(g, "periodic"));
    else
        assert_string_equal(rc_grid_get(g, "periodic"), periods[c->periodic]);
    assert_string_equal(rc_grid_get(g, "file.channel"), "heights");
    rc_grid_free(g);
    drop(&b);
}

static void
netcdf_is_read(void **state)
{
    static const unsigned versions[] = {1, 2, 5};

    (void)state;
    for (size_t k = 0; k < 3; k++)
        for (unsigned type = 1; type <= (versions[k] == 5 ? 11 : 6); type++) {
            struct cdf c = cdf;
            if (type == 2) /* text */
                continue;
            c.version = versions[k];
            c.type = type;
            check_cdf(&c, false);
            c.fill = 100;
            c.factor = 0.25;
            c.offset = -3;
            for (c.periodic = 1; c.periodic < 3; c.periodic++)
                check_cdf(&c, false);
            check_cdf(&c, false);
            c.rows = 0; /* along the record dimension */
            check_cdf(&c, false);
            c.rows = 2;
            c.first = "x";
            c.second = "y";
            check_cdf(&c, true);
        }
}

static void
refuse_cdf(const struct cdf *c, const char *why)
{
    struct bytes b = cdf_file(c);

    refuse(&rc_format_netcdf, &b, why);
    drop(&b);
}

static void
other_units_stay(void **state)
{
    struct cdf c = cdf;
    struct bytes b, plain = cdf_file(&cdf);
    struct rc_grid *g, *of = read_well(&rc_format_netcdf, &plain, 0);

    (void)state;
    c.unit = "K";
    b = cdf_file(&c);
    g = read_well(&rc_format_netcdf, &b, 0);
    assert_string_equal(g->unit, "K");
    assert_string_equal(g->channel, rc_grid_get(g, "file.channel"));
    for (size_t k = 0; k < g->nx * g->ny;
         k++) /* the same numbers as in the other file, whose unit is nm */
        assert_true(isnan(of->v[k]) ? isnan(g->v[k])
                                    : fabs(of->v[k] - 1e-9 * g->v[k]) <= rounding * fabs(of->v[k]));
    rc_grid_free(g);
    rc_grid_free(of);
    drop(&b);
    drop(&plain);
}

/* ---- scans of GXSM ---- */

/* A file as GXSM writes it. The field is over (time, value, dimy, dimx) with 2 rows of 3 nodes; dz and the
 * coordinates follow. Before these comes a log over two other dimensions. */
struct gxsm {
    uint64_t times;
    unsigned field_type;
    double dz, step_y;
    const char *unit; /* that it displays */
    bool records;     /* time is the record dimension */
};

static void
gxsm_variable(struct bytes *b, const char *name, size_t rank, const unsigned *dimension,
              const char *unit, unsigned type, uint64_t size, uint64_t at)
{
    cdf_text(b, &cdf, name);
    add_number(b, rank, 4);
    for (size_t k = 0; k < rank; k++)
        add_number(b, dimension[k], 4);
    add_number(b, unit == NULL ? 0 : 12, 4);
    add_number(b, unit != NULL, 4);
    if (unit != NULL) {
        cdf_text(b, &cdf, "unit");
        add_number(b, 2, 4);
        cdf_text(b, &cdf, unit);
    }
    add_number(b, type, 4);
    add_number(b, size, 4);
    add_number(b, at, 4);
}

static void
gxsm_header(struct bytes *b, const struct gxsm *g, const uint64_t at[5])
{
    static const char *const names[] = {"time", "value", "dimy", "dimx", "events", "columns"};
    const uint64_t lengths[] = {g->records ? 0 : g->times, 1, 2, 3, 4, 2};
    static const unsigned field[] = {0, 1, 2, 3}, y[] = {2}, x[] = {3}, events[] = {4, 5};
    size_t width = g->field_type == 3 ? 2 : 4;

    add(b, "CDF\1", 4);
    add_number(b, g->records ? g->times : 0, 4);
    add_number(b, 10, 4);
    add_number(b, 6, 4);
    for (size_t k = 0; k < 6; k++) {
        cdf_text(b, &cdf, names[k]);
        add_number(b, lengths[k], 4);
    }
    add_zeros(b, 8); /* attributes of the file */
    add_number(b, 11, 4);
    add_number(b, 5, 4);
    gxsm_variable(b, "scan speed", 2, events, NULL, 6, 64, at[0]);
    gxsm_variable(b, g->field_type == 3 ? "H" : "FloatField", 4, field, g->unit, g->field_type,
                  6 * width, at[1]);
    gxsm_variable(b, "dimx", 1, x, NULL, 5, 12, at[2]);
    gxsm_variable(b, "dimy", 1, y, NULL, 5, 8, at[3]);
    gxsm_variable(b, "dz", 0, NULL, "AA", 6, 8, at[4]);
}

static struct bytes
gxsm_file(const struct gxsm *g)
{
    uint64_t at[5] = {0};
    struct bytes b = {.big = true};

    for (int run = 0; run < 2; run++) {
        drop(&b);
        b.big = true;
        gxsm_header(&b, g, at);
        at[0] = b.n;
        for (size_t k = 0; k < 8; k++)
            add_f64(&b, 900 + (double)k);
        at[2] = b.n;
        for (size_t i = 0; i < 3; i++) /* rounded to floats, far from 0 */
            add_f32(&b, -50000 + 1587.3 * (double)i);
        at[3] = b.n;
        for (size_t j = 0; j < 2; j++)
            add_f32(&b, 700 - g->step_y * (double)j);
        at[4] = b.n;
        add_f64(&b, g->dz);
        at[1] = b.n;
        for (size_t k = 0; k < 6 * g->times; k++)
            cdf_value(&b, g->field_type, counts[k % 6]);
    }
    return b;
}

static void
scans_of_gxsm(void **state)
{
    static const struct gxsm plain = {1, 5, 0.25, 500, "nm", false};
    struct rc_channel channel[4];
    struct rc_wish wish = rc_no_wish;

    (void)state;
    for (int variant = 0; variant < 5; variant++) {
        struct gxsm g = plain;
        struct bytes b;
        struct rc_file file;
        struct rc_grid *map;
        double v[6];

        g.field_type = variant == 1 ? 3 : 5;
        g.records = variant == 2;
        g.step_y = variant == 3 ? -500 : 500;
        g.unit = variant == 4 ? "\xc3\x85"
                              : "nm"; /* the lengths are in Angstrom, whatever the display unit */
        b = gxsm_file(&g);
        file = file_of(&b, "scan.nc");
        assert_int_equal(list_maps(&rc_format_netcdf, &file, &wish, channel, 4, NULL), 1);
        assert_string_equal(channel[0].name, variant == 1 ? "H" : "FloatField");
        for (size_t k = 0; k < 6; k++)
            v[k] = counts[k] * 0.25e-10;
        map = read_well(&rc_format_netcdf, &b, 0);
        assert_true(map->nx == 3 && map->ny == 2);
        assert_true(fabs(map->dx - 1587.3e-10) <= 2e-6 * map->dx); /* rounding of floats near 5e4 */
        assert_true(fabs(map->dy - 500e-10) <= float_rounding * map->dy);
        check_map(map, 3, 2, map->dx, map->dy, v);
        rc_grid_free(map);
        refuse_cuts(&rc_format_netcdf, &b, b.n - 3, 1);
        survive_changes(&rc_format_netcdf, &b, 2000);
        drop(&b);
    }
}

static void
other_scans_of_gxsm(void **state)
{
    struct gxsm g = {1, 5, 0.25, 500, "V", false};
    struct rc_channel channel[4];
    struct bytes b = gxsm_file(&g);
    struct rc_file file = file_of(&b, "scan.nc");
    struct rc_grid *map = read_well(&rc_format_netcdf, &b, 0);

    (void)state;
    assert_string_equal(map->unit, "V");
    assert_true(map->v[3] == 25);
    rc_grid_free(map);
    drop(&b);
    g.unit = "mV"; /* the prefix belongs to the display: the unit of the values is unknown */
    b = gxsm_file(&g);
    refuse(&rc_format_netcdf, &b, "does not give the unit of its heights");
    drop(&b);
    /* neither the two layers nor the log are maps */
    g.times = 2;
    b = gxsm_file(&g);
    file = file_of(&b, "scan.nc");
    assert_int_equal(list_maps(&rc_format_netcdf, &file, &rc_no_wish, channel, 4, NULL), 0);
    refuse(&rc_format_netcdf, &b, "variables has two dimensions");
    drop(&b);
}

/* A falling coordinate reverses the map. */
static void
falling_axes(void **state)
{
    struct cdf c = cdf;
    struct bytes b, plain = cdf_file(&cdf);
    struct rc_grid *g, *of = read_well(&rc_format_netcdf, &plain, 0);

    (void)state;
    c.step_y = -cdf.step_y;
    b = cdf_file(&c);
    g = read_well(&rc_format_netcdf, &b, 0);
    assert_true(g->dx == of->dx && fabs(g->dy - of->dy) <= rounding * of->dy);
    for (size_t k = 0; k < g->nx * g->ny; k++) {
        double turned = of->v[(g->ny - 1 - k / g->nx) * g->nx + k % g->nx];

        assert_true(isnan(turned) ? isnan(g->v[k]) : g->v[k] == turned);
    }
    rc_grid_free(g);
    rc_grid_free(of);
    drop(&b);
    drop(&plain);
}

static void
netcdf_is_refused(void **state)
{
    struct cdf c = cdf;
    struct bytes b;

    (void)state;
    c.coordinates = false;
    refuse_cdf(&c, "does not give the spacing");
    c = cdf, c.step_y = 0;
    refuse_cdf(&c, "must be positive");
    c = cdf, c.step_y = NAN;
    refuse_cdf(&c, "uneven steps");
    c = cdf, c.step_y = INFINITY;
    refuse_cdf(&c, "uneven steps");
    c = cdf, c.columns = 0x7fffffff;
    refuse_cdf(&c, "the file is too short");
    c = cdf, c.version = 5, c.columns = 0x7fffffffffffffff, c.rows = 0x7fffffffffffffff;
    refuse_cdf(&c, "the file is too short");
    c = cdf, c.version = 5, c.rows = 0x2000000000000001;
    refuse_cdf(&c, "the file is too short");
    b = cdf_file(&cdf);
    b.data[3] = 3;
    refuse(&rc_format_netcdf, &b, "version 3");
    b.data[3] = 1;
    refuse_cuts(&rc_format_netcdf, &b, b.n, 1);
    survive_changes(&rc_format_netcdf, &b, 20000);
    drop(&b);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(netcdf_is_read), cmocka_unit_test(other_units_stay),
        cmocka_unit_test(scans_of_gxsm),  cmocka_unit_test(other_scans_of_gxsm),
        cmocka_unit_test(falling_axes),   cmocka_unit_test(netcdf_is_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
