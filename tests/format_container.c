/* PLUX, NetCDF, HDF5 and DATX files, made here, are read by their own rules; what is damaged, lies of
 * its size or was made to burst is refused. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <hdf5.h>
#include <zip.h>

#include "made.h"

extern const struct rc_format rc_format_plux, rc_format_netcdf, rc_format_hdf5, rc_format_datx,
    rc_format_x3p;

/* ---- archives ---- */

struct member {
    const char *name;
    const void *bytes;
    size_t n;
};

static struct bytes
archive(const struct member *member, size_t members)
{
    zip_source_t *source = zip_source_buffer_create(NULL, 0, 0, NULL);
    zip_t *zip = zip_open_from_source(source, ZIP_TRUNCATE, NULL);
    struct bytes b = {0};
    zip_stat_t st;

    assert_non_null(zip);
    zip_source_keep(source);
    for (size_t k = 0; k < members; k++)
        assert_true(zip_file_add(zip, member[k].name,
                                 zip_source_buffer(zip, member[k].bytes, member[k].n, 0),
                                 ZIP_FL_ENC_UTF_8) >= 0);
    assert_int_equal(zip_close(zip), 0);
    assert_int_equal(zip_source_stat(source, &st), 0);
    b.n = (size_t)st.size;
    b.data = malloc(b.n);
    assert_int_equal(zip_source_open(source), 0);
    assert_int_equal(zip_source_read(source, b.data, b.n), (zip_int64_t)b.n);
    zip_source_close(source);
    zip_source_free(source);
    return b;
}

/* ---- PLUX ---- */

static const char plux_xml[] =
    "<?xml version=\"1.0\"?><xml><GENERAL><DATE>2023-05-17 10:00</DATE>"
    "<IMAGE_SIZE_X>3</IMAGE_SIZE_X><IMAGE_SIZE_Y>2</IMAGE_SIZE_Y>"
    "<FOV_X>1.25</FOV_X><FOV_Y>0.75</FOV_Y></GENERAL>"
    "<LAYER_0><FILENAME_Z>LAYER_0.raw</FILENAME_Z></LAYER_0>"
    "<LAYER_1><FILENAME_Z>./LAYER_1.raw</FILENAME_Z></LAYER_1>"
    "<INFO><ITEM_0><NAME>Device</NAME><VALUE>S neox</VALUE></ITEM_0></INFO></xml>";

static const double heights[6] = {1.5, -2.25, NAN, 0, 1000, -0.5};

static struct bytes
plux_file(const char *xml, size_t less)
{
    struct bytes first = {0}, second = {0}, b;

    for (size_t k = 0; k < 6; k++) {
        add_f32(&first, heights[k]);
        add_f32(&second, k == 5 ? (less == 99 ? INFINITY : 7) : 2 * heights[k]);
    }
    b = archive((struct member[]){{"index.xml", xml, strlen(xml)},
                                  {"LAYER_0.raw", first.data, first.n - (less == 99 ? 0 : less)},
                                  {"LAYER_1.raw", second.data, second.n}},
                3);
    drop(&first);
    drop(&second);
    return b;
}

static void
plux_is_read(void **state)
{
    struct bytes b = plux_file(plux_xml, 0);
    struct rc_file file = file_of(&b, "made");
    struct rc_channel channel[4];
    struct rc_grid *g;
    double v[6];

    (void)state;
    assert_ptr_equal(rc_format_find(&file, NULL), &rc_format_plux);
    assert_int_equal(rc_format_plux.list(&file, &no_wish, channel, 4, NULL), 2);
    assert_string_equal(channel[1].name, "Layer 1");
    for (size_t layer = 0; layer < 2; layer++) {
        for (size_t k = 0; k < 6; k++)
            v[k] = (layer == 0 ? heights[k] : k == 5 ? 7 : 2 * heights[k]) * 1e-6;
        g = read_well(&rc_format_plux, &b, layer);
        check_map(g, 3, 2, 1.25e-6, 0.75e-6, v);
        assert_string_equal(rc_grid_get(g, "file.model"), "S neox");
        assert_string_equal(rc_grid_get(g, "file.date"), "2023-05-17 10:00");
        rc_grid_free(g);
    }
    drop(&b);
}

/* text with the first `from` replaced by `to`; the caller frees it. */
static char *
with(const char *text, const char *from, const char *to)
{
    const char *at = strstr(text, from);
    size_t size = strlen(text) + strlen(to) + 1, head;
    char *made = malloc(size);

    assert_non_null(at);
    head = (size_t)(at - text);
    memcpy(made, text, head);
    snprintf(made + head, size - head, "%s%s", to, at + strlen(from));
    return made;
}

static void
plux_is_refused(void **state)
{
    static const struct {
        const char *from, *to, *why;
    } cases[] = {
        {"<IMAGE_SIZE_X>3</IMAGE_SIZE_X>", "", "no size of an image"},
        {"SIZE_X>3", "SIZE_X>0", "empty"},
        {"SIZE_X>3", "SIZE_X>-3", "whole number"},
        {"SIZE_X>3", "SIZE_X>999999999", "promises"},
        {"SIZE_X>3", "SIZE_X>18446744073709551616", "whole number"},
        {"SIZE_X>3", "SIZE_X>4", "promises 32 bytes of heights, the file has 24"},
        {"FOV_X>1.25", "FOV_X>0", "must be positive"},
        {"FOV_X>1.25", "FOV_X>-1", "must be positive"},
        {"FOV_X>1.25", "FOV_X>nan", "does not give the spacing"},
        {"FOV_X>1.25", "FOV_X>inf", "must be positive and finite"},
        {"FOV_X>1.25", "FOV_X>wide", "no number"},
        {"LAYER_0.raw", "LAYER_9.raw", "no member 'LAYER_9.raw'"},
        {"LAYER_0.raw", "../../etc/passwd", "no member"},
        {"<?xml version=\"1.0\"?>",
         "<!DOCTYPE x [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;&a;&a;\">]>", "document type"},
        {"</xml>", "", "no whole XML"},
    };
    struct bytes b;

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char *xml = with(plux_xml, cases[k].from, cases[k].to);
        b = plux_file(xml, 0);
        refuse(&rc_format_plux, &b, cases[k].why);
        drop(&b);
        free(xml);
    }
    b = plux_file(plux_xml, 4);
    refuse(&rc_format_plux, &b, "promises 24 bytes of heights, the file has 20");
    drop(&b);
    b = archive((struct member[]){{"other.xml", plux_xml, 4}}, 1);
    refuse(&rc_format_plux, &b, "no index.xml");
    drop(&b);
    b = plux_file(plux_xml, 0);
    refuse_cuts(&rc_format_plux, &b, b.n, 1);
    survive_changes(&rc_format_plux, &b, 3000);
    drop(&b);
}

static void
plux_infinite(void **state)
{
    struct bytes b = plux_file(plux_xml, 99);
    struct rc_err err;

    (void)state;
    assert_null(try_read(&rc_format_plux, &b, &no_wish, 1, &err));
    assert_non_null(strstr(err.text, "column 2, row 1 (from 0) is infinite"));
    assert_null(try_read(&rc_format_plux, &b, &no_wish, 2, &err));
    assert_non_null(strstr(err.text, "has 2 layers, not 3"));
    drop(&b);
}

/* 64 MiB of zeros pack into 64 KiB, and would be 128 MiB of heights. */
static void
zip_bombs(void **state)
{
    enum {
        SIDE = 4096
    };
    static const char x3p_xml[] =
        "<p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\"><Record1>"
        "<FeatureType>SUR</FeatureType><Axes><CX><AxisType>I</AxisType><Increment>1</Increment></CX>"
        "<CY><AxisType>I</AxisType><Increment>1</Increment></CY><CZ><DataType>F</DataType></CZ></Axes>"
        "</Record1><Record3><MatrixDimension><SizeX>4096</SizeX><SizeY>4096</SizeY><SizeZ>1</SizeZ>"
        "</MatrixDimension><DataLink><PointDataLink>data.bin</PointDataLink></DataLink></Record3>"
        "</p:ISO5436_2>";
    char *zeros = calloc((size_t)SIDE * SIDE, 4), *one, *two;
    struct bytes b;

    (void)state;
    assert_non_null(zeros);
    one = with(plux_xml, "SIZE_X>3", "SIZE_X>4096");
    two = with(one, "SIZE_Y>2", "SIZE_Y>4096");
    b = archive((struct member[]){{"index.xml", two, strlen(two)},
                                  {"LAYER_0.raw", zeros, (size_t)SIDE * SIDE * 4}}, 2);
    printf("a bomb of %zu bytes\n", b.n);
    refuse(&rc_format_plux, &b, "4096 x 4096 values need 128 MiB, more than the 65");
    drop(&b);
    b = archive((struct member[]){{"main.xml", x3p_xml, strlen(x3p_xml)},
                                  {"data.bin", zeros, (size_t)SIDE * SIDE * 4}}, 2);
    refuse(&rc_format_x3p, &b, "4096 x 4096 values need 128 MiB, more than the 65");
    drop(&b);
    free(one);
    free(two);
    free(zeros);
}

/* ---- NetCDF ---- */

struct cdf {
    unsigned version, type;
    const char *first, *second; /* names of the dimensions */
    uint64_t rows, columns;     /* their lengths; rows 0: records */
    double step_y;
    const char *unit;
    double fill, factor, offset;
    bool coordinates, periodic;
};

static const struct cdf cdf = {.version = 1, .type = 6, .first = "y", .second = "x", .rows = 2,
                               .columns = 3, .step_y = 0.7, .unit = "nm", .fill = NAN, .factor = 1,
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

/* One variable: its place is set by the second of two runs. */
static void
cdf_variable(struct bytes *b, const struct cdf *c, const char *name, size_t rank, unsigned first,
             const char *unit, unsigned type, uint64_t size, uint64_t at)
{
    bool map = rank == 2;
    size_t attributes = (size_t)1 + (!map && c->periodic) +
                        (map ? (size_t)!isnan(c->fill) + (c->factor != 1) + (c->offset != 0) : 0);

    cdf_text(b, c, name);
    cdf_count(b, c, rank);
    for (size_t k = 0; k < rank; k++)
        cdf_count(b, c, first + k);
    cdf_list(b, c, 12, attributes);
    cdf_text(b, c, "units");
    add_number(b, 2, 4);
    cdf_text(b, c, unit);
    if (!map && c->periodic)
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

    if (rows * columns != 6 || rows > 6) { /* a header that lies */
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
    assert_int_equal(rc_grid_get(g, "periodic") != NULL, c->periodic);
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
            c.periodic = true;
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
netcdf_is_refused(void **state)
{
    struct cdf c = cdf;
    struct bytes b;

    (void)state;
    c.coordinates = false;
    refuse_cdf(&c, "does not give the spacing");
    c = cdf, c.unit = "K";
    refuse_cdf(&c, "'K', which is no length");
    c = cdf, c.step_y = 0;
    refuse_cdf(&c, "must be positive");
    c = cdf, c.step_y = -1;
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

/* ---- HDF5 ---- */

static hid_t
hdf_start(void)
{
    hid_t access = H5Pcreate(H5P_FILE_ACCESS), file;

    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    H5Pset_fapl_core(access, 1 << 16, false);
    file = H5Fcreate("made", H5F_ACC_TRUNC, H5P_DEFAULT, access);
    assert_true(file >= 0);
    H5Pclose(access);
    return file;
}

static struct bytes
hdf_end(hid_t file)
{
    struct bytes b = {0};

    H5Fflush(file, H5F_SCOPE_GLOBAL);
    b.n = (size_t)H5Fget_file_image(file, NULL, 0);
    b.data = malloc(b.n);
    assert_true(H5Fget_file_image(file, b.data, b.n) == (ssize_t)b.n);
    H5Fclose(file);
    return b;
}

static void
hdf_number(hid_t set, const char *name, double value)
{
    const hsize_t one = 1;
    hid_t space = H5Screate_simple(1, &one, NULL);
    hid_t a = H5Acreate2(set, name, H5T_IEEE_F64BE, space, H5P_DEFAULT, H5P_DEFAULT);

    assert_true(H5Awrite(a, H5T_NATIVE_DOUBLE, &value) >= 0);
    H5Aclose(a);
    H5Sclose(space);
}

static void
hdf_text(hid_t set, const char *name, const char *text, bool variable)
{
    const hsize_t one = 1;
    hid_t space = H5Screate_simple(1, &one, NULL), type = H5Tcopy(H5T_C_S1), a;

    H5Tset_size(type, variable ? H5T_VARIABLE : strlen(text));
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    a = H5Acreate2(set, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Awrite(a, type, variable ? (const void *)&text : text) >= 0);
    H5Aclose(a);
    H5Tclose(type);
    H5Sclose(space);
}

/* A dataset of the six counts; with `chunk` packed in pieces. */
static hid_t
hdf_set(hid_t in, const char *name, hid_t type, int rank, const hsize_t *size, const hsize_t *chunk)
{
    hid_t space = H5Screate_simple(rank, size, NULL), options = H5Pcreate(H5P_DATASET_CREATE), set;

    if (chunk != NULL) {
        H5Pset_chunk(options, rank, chunk);
        H5Pset_shuffle(options);
        H5Pset_deflate(options, 6);
    }
    set = H5Dcreate2(in, name, type, space, H5P_DEFAULT, options, H5P_DEFAULT);
    assert_true(set >= 0);
    assert_true(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, counts) >= 0);
    H5Pclose(options);
    H5Sclose(space);
    return set;
}

static void
hdf5_is_read(void **state)
{
    const hid_t types[] = {H5T_STD_I8LE,   H5T_STD_U16BE,  H5T_STD_I32LE,
                           H5T_STD_U64BE,  H5T_IEEE_F32BE, H5T_IEEE_F64LE};
    const hsize_t flat[] = {2, 3}, deep[] = {1, 2, 3}, chunk[] = {2, 2}, column[] = {6};
    const double v[6] = {1e-9, 2e-9, 3e-9, NAN, 5e-9, 6e-9};

    (void)state;
    for (size_t k = 0; k < sizeof types / sizeof *types; k++)
        for (int way = 0; way < 3; way++) {
            hid_t file = hdf_start(), group, set;
            struct rc_channel channel[4];
            struct rc_file made;
            struct rc_grid *g;
            struct bytes b;

            group = H5Gcreate2(file, "scan", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
            H5Dclose(hdf_set(file, "a list", types[k], 1, column, NULL));
            set = way == 2 ? hdf_set(group, "z", types[k], 3, deep, NULL)
                           : hdf_set(group, "z", types[k], 2, flat, way == 1 ? chunk : NULL);
            hdf_number(set, "dx", 1.1e-6);
            hdf_number(set, "dy", 1.3e-6);
            hdf_text(set, way == 1 ? "units" : "unit", "nm", way == 1);
            hdf_number(set, "_FillValue", 100);
            H5Dclose(set);
            H5Gclose(group);
            b = hdf_end(file);
            made = file_of(&b, "made");
            assert_ptr_equal(rc_format_find(&made, NULL), &rc_format_hdf5);
            assert_int_equal(rc_format_hdf5.list(&made, &no_wish, channel, 4, NULL), 1);
            assert_string_equal(channel->name, "scan/z");
            assert_string_equal(channel->unit, "m");
            g = read_well(&rc_format_hdf5, &b, 0);
            check_map(g, 3, 2, 1.1e-6, 1.3e-6, v);
            rc_grid_free(g);
            drop(&b);
        }
}

/* A small file cannot send the reader to another one: what it named would come out as heights. */
static void
hdf5_stays_in_its_file(void **state)
{
    const hsize_t size[] = {4, 8};
    hid_t file = hdf_start(), space = H5Screate_simple(2, size, NULL);
    hid_t options = H5Pcreate(H5P_DATASET_CREATE), set;
    struct rc_wish wish = {.dx = 1, .dy = 1, .z_unit = 1};
    struct rc_err err;
    struct bytes b;

    (void)state;
    H5Pset_external(options, "/etc/passwd", 0, 32);
    set = H5Dcreate2(file, "stolen", H5T_STD_U8LE, space, H5P_DEFAULT, options, H5P_DEFAULT);
    assert_true(set >= 0);
    H5Dclose(set);
    H5Pclose(options);
    H5Sclose(space);
    H5Lcreate_external("/tmp/other.h5", "/z", file, "elsewhere", H5P_DEFAULT, H5P_DEFAULT);
    b = hdf_end(file);
    assert_null(try_read(&rc_format_hdf5, &b, &wish, 0, &err));
    assert_non_null(strstr(err.text, "'stolen' cannot be unpacked"));
    drop(&b);
}

/* Changed at random and read without a cage, HDF5 files make libhdf5 1.10.8 itself read past its
 * memory (RC_FUZZ=10 RC_FUZZ_OPEN=1): that is what the cage is for.
 *
 * 128 MiB of zeros in a file of a few hundred KiB: as a map, and as one piece of a tiny map. */
static void
hdf5_bombs(void **state)
{
    const hsize_t size[] = {4096, 4096}, small[] = {2, 2}, any[] = {H5S_UNLIMITED, H5S_UNLIMITED};
    struct rc_wish wish = {.dx = 1, .dy = 1, .z_unit = 1};

    (void)state;
    for (int way = 0; way < 2; way++) {
        hid_t file = hdf_start(), options = H5Pcreate(H5P_DATASET_CREATE), set;
        hid_t space = way == 0 ? H5Screate_simple(2, size, NULL)
                               : H5Screate_simple(2, small, any);
        double *zeros = calloc(4096 * 4096, sizeof *zeros);
        struct rc_err err;
        struct bytes b;

        H5Pset_chunk(options, 2, size);
        H5Pset_deflate(options, 1);
        set = H5Dcreate2(file, "z", H5T_IEEE_F64LE, space, H5P_DEFAULT, options, H5P_DEFAULT);
        assert_true(set >= 0);
        assert_true(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, zeros) >= 0);
        free(zeros);
        H5Dclose(set);
        H5Pclose(options);
        H5Sclose(space);
        b = hdf_end(file);
        assert_null(try_read(&rc_format_hdf5, &b, &wish, 0, &err));
        printf("a bomb of %zu bytes: %s\n", b.n, err.text);
        assert_non_null(strstr(err.text, way == 0 ? "more than the" : "cannot be unpacked"));
        drop(&b);
    }
}

static struct bytes
hdf_plain(void)
{
    const hsize_t size[] = {2, 3};
    hid_t file = hdf_start(), set = hdf_set(file, "z", H5T_IEEE_F64LE, 2, size, NULL);

    hdf_number(set, "dx", 1e-6);
    hdf_number(set, "dy", 1e-6);
    hdf_text(set, "unit", "m", false);
    H5Dclose(set);
    return hdf_end(file);
}

static void
hdf5_is_refused(void **state)
{
    struct bytes b = hdf_plain();
    hid_t file;

    (void)state;
    refuse_cuts(&rc_format_hdf5, &b, b.n, 31);
    survive_changes(&rc_format_hdf5, &b, 200);
    drop(&b);
    file = hdf_start();
    b = hdf_end(file);
    refuse(&rc_format_hdf5, &b, "no dataset of numbers with two dimensions");
    drop(&b);
}

/* ---- DATX ---- */

struct row {
    const char *group, *key, *value;
};

static void
datx_table(hid_t file, const struct row *row, size_t n)
{
    hid_t word = H5Tcopy(H5T_C_S1), type = H5Tcreate(H5T_COMPOUND, sizeof *row), space, set;
    const hsize_t rows = n;

    H5Tset_size(word, H5T_VARIABLE);
    H5Tinsert(type, "Source", offsetof(struct row, group), word);
    H5Tinsert(type, "Link", offsetof(struct row, key), word);
    H5Tinsert(type, "Destination", offsetof(struct row, value), word);
    space = H5Screate_simple(1, &rows, NULL);
    set = H5Dcreate2(file, "MetaData", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(set >= 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, row) >= 0);
    H5Dclose(set);
    H5Sclose(space);
    H5Tclose(type);
    H5Tclose(word);
}

/* Category, unit, and numbers as a list or, with `fixed`, as an array. */
static void
datx_converter(hid_t set, const char *name, const char *category, double metres, bool fixed)
{
    struct {
        const char *category, *unit;
        hvl_t list;
        double array[4];
    } value = {category, "Pixels", {0}, {0, metres, 0, 0}};
    const hsize_t one = 1, four = 4;
    hid_t word = H5Tcopy(H5T_C_S1), type = H5Tcreate(H5T_COMPOUND, sizeof value);
    hid_t numbers = fixed ? H5Tarray_create2(H5T_NATIVE_DOUBLE, 1, &four)
                          : H5Tvlen_create(H5T_NATIVE_DOUBLE);
    hid_t space = H5Screate_simple(1, &one, NULL), a;

    value.list.len = 4;
    value.list.p = value.array;
    H5Tset_size(word, H5T_VARIABLE);
    H5Tinsert(type, "Category", 0, word);
    H5Tinsert(type, "BaseUnit", sizeof(char *), word);
    H5Tinsert(type, "Parameters",
              (size_t)((char *)(fixed ? (void *)value.array : (void *)&value.list) -
                       (char *)&value), numbers);
    a = H5Acreate2(set, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(a >= 0 && H5Awrite(a, type, &value) >= 0);
    H5Aclose(a);
    H5Sclose(space);
    H5Tclose(numbers);
    H5Tclose(type);
    H5Tclose(word);
}

static struct bytes
datx_file(bool table, const char *unit, bool fixed, double dx)
{
    static const struct row rows[] = {{"Root", "Measurement", "{1}"},
                                      {"{1}", "Name", "a part"},
                                      {"{1}", "Surface", "{2}"},
                                      {"{2}", "Path", "/Data/Surface/{3}"}};
    const hsize_t size[] = {2, 3};
    hid_t file = hdf_start(), data, surface, set;

    data = H5Gcreate2(file, "Data", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    surface = H5Gcreate2(data, "Surface", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    datx_table(file, rows, table ? 4 : 2);
    if (table) /* a first dataset that the table does not name */
        H5Dclose(hdf_set(surface, "a", H5T_STD_I8LE, 2, size, NULL));
    set = hdf_set(surface, "{3}", H5T_IEEE_F64LE, 2, size, NULL);
    hdf_text(set, "Unit", unit, true);
    hdf_number(set, "No Data", 100);
    hdf_number(set, "Wavelength", 632.8e-9);
    hdf_number(set, "Interferometric Scale Factor", 0.5);
    hdf_number(set, "Obliquity Factor", 1.1);
    datx_converter(set, "X Converter", "LateralCat", dx, fixed);
    datx_converter(set, "Y Converter", "LateralCat", 0.75e-6, fixed);
    datx_converter(set, "Z Converter", "HeightCat", 1, fixed);
    H5Dclose(set);
    H5Gclose(surface);
    H5Gclose(data);
    return hdf_end(file);
}

static void
datx_is_read(void **state)
{
    static const struct {
        const char *unit;
        double metres;
    } units[] = {{"NanoMeters", 1e-9}, {"MicroMeters", 1e-6}, {"Fringes", 632.8e-9 * 0.5 * 1.1}};

    (void)state;
    for (size_t k = 0; k < 3; k++)
        for (int way = 0; way < 4; way++) {
            struct bytes b = datx_file(way & 1, units[k].unit, way & 2, 1.5e-6);
            struct rc_file file = file_of(&b, "made");
            struct rc_grid *g;
            double v[6];

            assert_ptr_equal(rc_format_find(&file, NULL), &rc_format_datx);
            for (size_t i = 0; i < 6; i++)
                v[i] = counts[i] == 100 ? NAN : counts[i] * units[k].metres;
            g = read_well(&rc_format_datx, &b, 0);
            check_map(g, 3, 2, 1.5e-6, 0.75e-6, v);
            rc_grid_free(g);
            drop(&b);
        }
}

static void
datx_is_refused(void **state)
{
    struct bytes b = datx_file(true, "Waves", false, 1e-6);

    (void)state;
    refuse(&rc_format_datx, &b, "'Waves', which is no length");
    drop(&b);
    b = datx_file(true, "NanoMeters", false, 0);
    refuse(&rc_format_datx, &b, "must be positive");
    drop(&b);
    b = hdf_plain();
    refuse(&rc_format_datx, &b, "no DATX");
    drop(&b);
    b = datx_file(true, "NanoMeters", false, 1e-6);
    refuse_cuts(&rc_format_datx, &b, b.n, 113);
    survive_changes(&rc_format_datx, &b, 200);
    drop(&b);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plux_is_read),
        cmocka_unit_test(plux_is_refused),
        cmocka_unit_test(plux_infinite),
        cmocka_unit_test(zip_bombs),
        cmocka_unit_test(netcdf_is_read),
        cmocka_unit_test(netcdf_is_refused),
        cmocka_unit_test(hdf5_is_read),
        cmocka_unit_test(hdf5_stays_in_its_file),
        cmocka_unit_test(hdf5_bombs),
        cmocka_unit_test(hdf5_is_refused),
        cmocka_unit_test(datx_is_read),
        cmocka_unit_test(datx_is_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
