/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Decoders of exported files, written from the descriptions of the formats; they share no code with
 * the writers. */
#ifndef DECODERS_H
#define DECODERS_H

#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/formats/made/made.h"

struct map {
    size_t nx, ny;
    double dx, dy; /* NAN if the format does not define it */
    double *v;
};

static uint64_t
bits(const char *at, size_t n)
{
    uint64_t value = 0;

    for (size_t k = n; k-- > 0;)
        value = value << 8 | (unsigned char)at[k];
    return value;
}

static size_t
count(const char *at, size_t n)
{
    uint64_t value = bits(at, n);

    assert_true(value <= SIZE_MAX);
    return (size_t)value;
}

static double
f64(const char *at)
{
    uint64_t word = bits(at, 8);
    double value;

    memcpy(&value, &word, 8);
    return value;
}

static double
f32(const char *at)
{
    uint32_t word = (uint32_t)bits(at, 4);
    float value;

    memcpy(&value, &word, 4);
    return (double)value;
}

static double
whole(const char *at, size_t width)
{
    int64_t value = (int64_t)bits(at, width), sign = (int64_t)1 << (8 * width - 1);

    return (double)(value >= sign ? value - 2 * sign : value);
}

static double *
new_values(const struct map *m)
{
    double *v = malloc(m->nx * m->ny * sizeof *v);

    assert_non_null(v);
    return v;
}

/* The number that follows `key` in the text. */
static double
after(const char *text, const char *key)
{
    const char *at = strstr(text, key);

    if (at == NULL)
        fail_msg("no '%s' in the file", key);
    return strtod(at + strlen(key), NULL);
}

__attribute__((unused)) static struct map
decode_sdf(const struct written *made)
{
    const char *at = strstr(made->bytes, "\n*\n") + 3;
    struct map m = {.nx = (size_t)after(made->bytes, "NumPoints   = "),
                    .ny = (size_t)after(made->bytes, "NumProfiles = "),
                    .dx = after(made->bytes, "Xscale      = "),
                    .dy = after(made->bytes, "Yscale      = ")};
    double scale = after(made->bytes, "Zscale      = ");

    assert_memory_equal(made->bytes, "aISO-1.0\n", 9);
    m.v = new_values(&m);
    for (size_t k = 0; k < m.nx * m.ny; k++) {
        char *end;
        at += strspn(at, " \n");
        m.v[k] = strncmp(at, "BAD", 3) == 0 ? NAN : scale * strtod(at, &end);
        at = isnan(m.v[k]) ? at + 3 : end;
    }
    assert_string_equal(at, "\n*\n*\n");
    return m;
}

__attribute__((unused)) static struct map
decode_sdf_binary(const struct written *made)
{
    const char *h = made->bytes;
    struct map m = {
        .nx = count(h + 42, 2), .ny = count(h + 44, 2), .dx = f64(h + 46), .dy = f64(h + 54)};
    double scale = f64(h + 62);
    int type = (unsigned char)h[79];
    size_t width = type == 5 ? 2 : type == 6 ? 4 : 8;

    assert_memory_equal(h, "bISO-1.0libcontact", 18);
    assert_int_equal(h[78], 0);
    assert_int_equal(h[80], 0);
    assert_int_equal(made->n, 81 + width * m.nx * m.ny);
    m.v = new_values(&m);
    for (size_t k = 0; k < m.nx * m.ny; k++) {
        const char *at = h + 81 + width * k;
        double value = type == 7 ? f64(at) : whole(at, width);
        m.v[k] = value == -ldexp(1, 8 * (int)width - 1) ? NAN : value * scale;
    }
    return m;
}

__attribute__((unused)) static struct map
decode_gsf(const struct written *made)
{
    size_t head = strlen(made->bytes), pad = 4 - head % 4;
    struct map m = {.nx = (size_t)after(made->bytes, "\nXRes = "),
                    .ny = (size_t)after(made->bytes, "\nYRes = ")};

    assert_memory_equal(made->bytes, "Gwyddion Simple Field 1.0\n", 26);
    assert_non_null(strstr(made->bytes, "\nXYUnits = m\nZUnits = m\nTitle = height\n"));
    m.dx = after(made->bytes, "\nXReal = ") / (double)m.nx;
    m.dy = after(made->bytes, "\nYReal = ") / (double)m.ny;
    assert_int_equal(made->n, head + pad + 4 * m.nx * m.ny);
    m.v = new_values(&m);
    for (size_t k = 0; k < m.nx * m.ny; k++)
        m.v[k] = f32(made->bytes + head + pad + 4 * k);
    return m;
}

/* The value of the item `name` of type `type` between two offsets. */
static const char *
gwy_item(const char *at, const char *end, const char *name, int type)
{
    size_t n = strlen(name) + 1;

    for (; at + n < end; at++)
        if (memcmp(at, name, n) == 0 && at[n] == type)
            return at + n + 1;
    fail_msg("no item %s of type %c", name, type);
    return NULL;
}

__attribute__((unused)) static struct map
decode_gwy(const struct written *made)
{
    const char *end = made->bytes + made->n, *field, *data, *mask = NULL;
    struct map m;

    assert_memory_equal(made->bytes, "GWYPGwyContainer", 17);
    assert_true(bits(made->bytes + 17, 4) == made->n - 21);
    field = gwy_item(made->bytes, end, "/0/data", 'o');
    assert_string_equal(field, "GwyDataField");
    m.nx = (size_t)bits(gwy_item(field, end, "xres", 'i'), 4);
    m.ny = (size_t)bits(gwy_item(field, end, "yres", 'i'), 4);
    m.dx = f64(gwy_item(field, end, "xreal", 'd')) / (double)m.nx;
    m.dy = f64(gwy_item(field, end, "yreal", 'd')) / (double)m.ny;
    assert_string_equal(gwy_item(field, end, "unitstr", 's'), "m");
    data = gwy_item(field, end, "data", 'D');
    assert_true(bits(data, 4) == m.nx * m.ny);
    for (const char *at = data; at + 8 < end; at++)
        if (memcmp(at, "/0/mask", 8) == 0 && mask == NULL)
            mask = gwy_item(at, end, "data", 'D');
    m.v = new_values(&m);
    for (size_t k = 0; k < m.nx * m.ny; k++) {
        m.v[k] = f64(data + 4 + 8 * k);
        if (isnan(m.v[k]))
            fail_msg("a NaN, which Gwyddion cannot draw");
        if (mask != NULL && f64(mask + 4 + 8 * k) != 0)
            m.v[k] = NAN;
    }
    return m;
}

__attribute__((unused)) static struct map
decode_npy(const struct written *made)
{
    size_t head = 10 + count(made->bytes + 8, 2), width;
    const char *shape = strstr(made->bytes + 10, "'shape': (");
    struct map m = {.dx = NAN, .dy = NAN};
    char *end;

    assert_memory_equal(made->bytes, "\x93NUMPY\x01\x00", 8);
    assert_int_equal(head % 64, 0);
    assert_int_equal(made->bytes[head - 1], '\n');
    width = strstr(made->bytes + 10, "'<f8'") != NULL ? 8 : 4;
    m.ny = strtoul(shape + 10, &end, 10);
    m.nx = strtoul(end + 1, NULL, 10);
    assert_int_equal(made->n, head + width * m.nx * m.ny);
    m.v = new_values(&m);
    for (size_t k = 0; k < m.nx * m.ny; k++)
        m.v[k] = width == 8 ? f64(made->bytes + head + 8 * k) : f32(made->bytes + head + 4 * k);
    return m;
}

__attribute__((unused)) static struct map
decode_csv(const struct written *made)
{
    struct map m = {.nx = 1};
    const char *at = made->bytes;
    double width = after(at, "# Width: "), height = after(at, "# Height: ");

    for (int line = 0; line < 4; line++)
        at = strchr(at, '\n') + 1;
    for (const char *s = at; *s != '\n'; s++)
        m.nx += *s == ',';
    for (const char *s = at; *s != '\0'; s++)
        m.ny += *s == '\n';
    m.dx = width / (double)m.nx;
    m.dy = height / (double)m.ny;
    m.v = new_values(&m);
    for (size_t k = 0; k < m.nx * m.ny; k++) {
        char *end;
        m.v[k] = strtod(at, &end);
        assert_int_equal(*end, k % m.nx == m.nx - 1 ? '\n' : ',');
        if (!isnan(m.v[k]))
            assert_true(memchr(at, '.', (size_t)(end - at)) != NULL);
        at = end + 1;
    }
    return m;
}

__attribute__((unused)) static struct map
decode_xyz(const struct written *made)
{
    struct map m = {.dx = NAN, .dy = NAN};
    size_t lines = 0;
    double first_y = 0, y = 0;
    char *at = made->bytes;

    for (const char *s = made->bytes; *s != '\0'; s++)
        lines += *s == '\n';
    m.nx = lines;
    m.ny = 1;
    m.v = new_values(&m);
    m.nx = 0;
    for (size_t k = 0; k < lines; k++) {
        double x = strtod(at, &at);
        y = strtod(at, &at);
        m.v[k] = strtod(at, &at);
        first_y = k == 0 ? y : first_y;
        m.nx += y == first_y;
        if (k == 0)
            m.dx = -x; /* differences of the first two sides in the middle */
        assert_int_equal(*at++, '\n');
    }
    assert_true(m.nx > 0);
    m.ny = lines / m.nx;
    m.dx = m.nx > 1 ? 2 * m.dx / ((double)m.nx - 1) : NAN;
    m.dy = m.ny > 1 ? (y - first_y) / ((double)m.ny - 1) : NAN;
    return m;
}

__attribute__((unused)) static struct map
decode_sur(const struct written *made)
{
    const char *h = made->bytes;
    struct map m = {.nx = count(h + 108, 4),
                    .ny = count(h + 112, 4),
                    .dx = 1e-3 * f32(h + 120),
                    .dy = 1e-3 * f32(h + 124)};
    size_t width = count(h + 98, 2) / 8;
    double low = whole(h + 100, 4), high = whole(h + 104, 4);

    assert_memory_equal(h, "DIGITAL SURF", 12);
    assert_int_equal(bits(h + 18, 2), 2);
    assert_int_equal(bits(h + 334, 4), 0); /* without comment and private zone */
    assert_int_equal(bits(h + 116, 4), m.nx * m.ny);
    assert_string_equal(h + 180, "mm");
    assert_string_equal(h + 196, "mm");
    assert_string_equal(h + 212, "mm");
    assert_int_equal(made->n, 512 + width * m.nx * m.ny);
    assert_true(low == 0); /* so that the result does not depend on subtracting it */
    m.v = new_values(&m);
    for (size_t k = 0; k < m.nx * m.ny; k++) {
        double raw = whole(h + 512 + width * k, width);
        bool missing = bits(h + 86, 2) == 1 && raw == low - 2;
        assert_true(missing || (raw >= low && raw <= high));
        m.v[k] = missing ? NAN : 1e-3 * (raw * f32(h + 128) + f32(h + 474));
    }
    return m;
}

/* The start of the appended data of the array `name`, after their length. */
static const char *
appended(const struct written *made, const char *name, size_t *bytes)
{
    char key[64];
    const char *at, *data = strstr(made->bytes, "<AppendedData encoding=\"raw\">");

    snprintf(key, sizeof key, "Name=\"%s\"", name);
    if ((at = strstr(made->bytes, key)) == NULL)
        fail_msg("no array %s", name);
    data = strchr(data, '_') + 1 + (size_t)after(at, "offset=\"");
    *bytes = count(data, 8);
    return data + 8;
}

__attribute__((unused)) static struct map
decode_vtk(const struct written *made, const char *name, const char *type)
{
    const char *extent = strstr(made->bytes, "WholeExtent=\"0 ") + 15, *data;
    static const char last[] = "\n  </AppendedData>\n</VTKFile>\n";
    struct map m = {.dx = NAN, .dy = NAN};
    size_t bytes, width;
    char *end;

    assert_non_null(strstr(made->bytes, type));
    assert_non_null(strstr(made->bytes, "byte_order=\"LittleEndian\" header_type=\"UInt64\""));
    assert_string_equal(made->bytes + made->n - strlen(last), last);
    m.nx = strtoul(extent, &end, 10) + 1;
    m.ny = strtoul(end + 3, &end, 10) + 1;
    m.ny *= strtoul(end + 3, NULL, 10) + 1;
    data = appended(made, name, &bytes);
    width = bytes / (m.nx * m.ny);
    assert_int_equal(bytes, width * m.nx * m.ny);
    m.v = new_values(&m);
    for (size_t k = 0; k < m.nx * m.ny; k++)
        m.v[k] = width == 8 ? f64(data + 8 * k) : f32(data + 4 * k);
    return m;
}

__attribute__((unused)) static struct map
decode_vti(const struct written *made)
{
    struct map m = decode_vtk(made, "height", "type=\"ImageData\"");
    const char *spacing = strstr(made->bytes, "Spacing=\"") + 9;
    char *end;

    m.dx = m.nx > 1 ? strtod(spacing, &end) : NAN;
    strtod(spacing, &end);
    m.dy = m.ny > 1 ? strtod(end, NULL) : NAN;
    return m;
}

__attribute__((unused)) static struct map
decode_vtr(const struct written *made)
{
    struct map m = decode_vtk(made, "height", "type=\"RectilinearGrid\"");
    size_t bytes;
    const char *x = appended(made, "x", &bytes), *y;

    assert_int_equal(bytes, 8 * m.nx);
    y = appended(made, "y", &bytes);
    assert_int_equal(bytes, 8 * m.ny);
    m.dx = m.nx > 1 ? f64(x + 8) - f64(x) : NAN;
    m.dy = m.ny > 1 ? f64(y + 8) - f64(y) : NAN;
    return m;
}

__attribute__((unused)) static double
hdf5_number(hid_t set, const char *name)
{
    hid_t attribute = H5Aopen(set, name, H5P_DEFAULT);
    double value = NAN;

    assert_true(attribute >= 0 && H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) >= 0);
    H5Aclose(attribute);
    return value;
}

__attribute__((unused)) static struct map
decode_hdf5(const struct written *made)
{
    hid_t access = H5Pcreate(H5P_FILE_ACCESS), file, set, space;
    hsize_t size[2];
    struct map m;

    H5Pset_fapl_core(access, 1 << 16, false);
    assert_true(H5Pset_file_image(access, made->bytes, made->n) >= 0);
    file = H5Fopen("made", H5F_ACC_RDONLY, access);
    set = H5Dopen2(file, "height", H5P_DEFAULT);
    assert_true(set >= 0);
    space = H5Dget_space(set);
    assert_int_equal(H5Sget_simple_extent_dims(space, size, NULL), 2);
    m = (struct map){.nx = (size_t)size[1],
                     .ny = (size_t)size[0],
                     .dx = hdf5_number(set, "dx"),
                     .dy = hdf5_number(set, "dy")};
    m.v = new_values(&m);
    assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, m.v) >= 0);
    H5Sclose(space);
    H5Dclose(set);
    H5Fclose(file);
    H5Pclose(access);
    return m;
}

/* The position of the numbers of a variable in an uncompressed MAT file. */
static const char *
mat_variable(const struct written *made, const char *name, int class, size_t *rows, size_t *columns)
{
    size_t length = strlen(name);

    for (const char *at = made->bytes + 128; at < made->bytes + made->n;
         at += 8 + count(at + 4, 4)) {
        assert_int_equal(bits(at, 4), 14); /* an array */
        assert_int_equal(count(at + 4, 4) % 8, 0);
        assert_int_equal(bits(at + 8, 4), 6);  /* flags: unsigned, 8 bytes */
        assert_int_equal(bits(at + 24, 4), 5); /* dimensions: signed, 8 bytes */
        assert_int_equal(bits(at + 28, 4), 8);
        assert_int_equal(bits(at + 40, 4), 1); /* its name: characters */
        if (count(at + 44, 4) != length || memcmp(at + 48, name, length) != 0)
            continue;
        assert_true((int)bits(at + 16, 1) == class);
        *rows = count(at + 32, 4);
        *columns = count(at + 36, 4);
        return at + 48 + (length + 7) / 8 * 8 + 8;
    }
    fail_msg("no variable '%s'", name);
    return NULL;
}

__attribute__((unused)) static struct map
decode_mat(const struct written *made)
{
    bool single;
    size_t one, n;
    struct map m = {0};
    const char *at;

    assert_memory_equal(made->bytes, "MATLAB 5.0 MAT-file", 19);
    assert_memory_equal(made->bytes + 124, "\0\1IM", 4);
    m.dx = f64(mat_variable(made, "dx", 6, &one, &n));
    m.dy = f64(mat_variable(made, "dy", 6, &one, &n));
    at = mat_variable(made, "unit", 4, &one, &n);
    assert_true(one == 1 && n == 1 && at[0] == 'm' && at[1] == '\0');
    at = made->bytes + 128 + 4 * 72; /* after these, in the class single or double */
    single = bits(at + 16, 1) == 7;
    at = mat_variable(made, "height", single ? 7 : 6, &m.ny, &m.nx);
    assert_int_equal(count(at - 4, 4), m.nx * m.ny * (single ? 4 : 8));
    assert_true(made->n - (size_t)(at - made->bytes) ==
                (m.nx * m.ny * (single ? 4 : 8) + 7) / 8 * 8);
    m.v = new_values(&m);
    for (size_t i = 0; i < m.nx; i++)
        for (size_t j = 0; j < m.ny; j++, at += single ? 4 : 8)
            m.v[j * m.nx + i] = single ? f32(at) : f64(at);
    return m;
}

#endif
