/* What is written holds the numbers that were given, by a decoder of each format that shares no code
 * with its writer, and by our own reader where there is one. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <hdf5.h>
#include <zip.h>

#include "formats/export.h"
#include "formats/format.h"

/* ---- frames and files ---- */

static uint64_t seed = 0x2545f4914f6cdd1d;

static double
uniform(void)
{
    seed ^= seed << 13;
    seed ^= seed >> 7;
    seed ^= seed << 17;
    return (double)(seed >> 11) / 9007199254740992.0;
}

/* Heights about 3.3 um, a share of them missing. */
static struct rc_grid *
random_grid(size_t nx, size_t ny, double missing)
{
    struct rc_shape shape = {.nx = nx, .ny = ny, .dx = 1.1e-6, .dy = 1.29e-6};
    struct rc_grid *g = rc_grid_new(&shape, "height", "m", NULL);

    assert_non_null(g);
    for (size_t k = 0; k < nx * ny; k++)
        g->v[k] = uniform() < missing ? NAN : 3.3e-6 + 1.7e-6 * (uniform() - 0.5);
    return g;
}

static const struct rc_export_wish plain = {.time = 1700000000, .creator = "test"};

static struct rc_export_wish
typed(enum rc_raw raw)
{
    struct rc_export_wish wish = plain;

    wish.typed = true;
    wish.raw = raw;
    return wish;
}

struct made {
    char *bytes;
    size_t n;
};

static enum rc_status
try_export(const char *name, struct rc_grid *const *frame, size_t frames,
           const struct rc_export_wish *wish, struct made *made, struct rc_err *err)
{
    const struct rc_export *format = rc_export_named(name);
    enum rc_status status;
    FILE *f;

    assert_non_null(format);
    f = open_memstream(&made->bytes, &made->n);
    assert_non_null(f);
    err->text[0] = '\0';
    status = format->write(f, frame, frames, wish, err);
    fclose(f);
    return status;
}

static struct made
export(const char *name, struct rc_grid *const *frame, size_t frames,
       const struct rc_export_wish *wish)
{
    struct made made;
    struct rc_err err;

    if (try_export(name, frame, frames, wish, &made, &err) != RC_OK)
        fail_msg("%s: %s", name, err.text);
    return made;
}

static void
refuse(const char *name, struct rc_grid *const *frame, size_t frames,
       const struct rc_export_wish *wish, const char *why)
{
    struct made made;
    struct rc_err err;

    if (try_export(name, frame, frames, wish, &made, &err) == RC_OK)
        fail_msg("%s: written, and should be refused for: %s", name, why);
    if (strstr(err.text, why) == NULL)
        fail_msg("%s: refused for '%s', not for '%s'", name, err.text, why);
    free(made.bytes);
}

/* ---- decoders, from the descriptions of the formats ---- */

struct map {
    size_t nx, ny;
    double dx, dy; /* NAN where the format does not say */
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
room(const struct map *m)
{
    double *v = malloc(m->nx * m->ny * sizeof *v);

    assert_non_null(v);
    return v;
}

/* What stands behind `key` in text, as a number. */
static double
after(const char *text, const char *key)
{
    const char *at = strstr(text, key);

    if (at == NULL)
        fail_msg("no '%s' in the file", key);
    return strtod(at + strlen(key), NULL);
}

static struct map
decode_sdf(const struct made *made)
{
    const char *at = strstr(made->bytes, "\n*\n") + 3;
    struct map m = {.nx = (size_t)after(made->bytes, "NumPoints   = "),
                    .ny = (size_t)after(made->bytes, "NumProfiles = "),
                    .dx = after(made->bytes, "Xscale      = "),
                    .dy = after(made->bytes, "Yscale      = ")};
    double scale = after(made->bytes, "Zscale      = ");

    assert_memory_equal(made->bytes, "aISO-1.0\n", 9);
    m.v = room(&m);
    for (size_t k = 0; k < m.nx * m.ny; k++) {
        char *end;
        at += strspn(at, " \n");
        m.v[k] = strncmp(at, "BAD", 3) == 0 ? NAN : scale * strtod(at, &end);
        at = isnan(m.v[k]) ? at + 3 : end;
    }
    assert_string_equal(at, "\n*\n*\n");
    return m;
}

static struct map
decode_sdf_binary(const struct made *made)
{
    const char *h = made->bytes;
    struct map m = {.nx = bits(h + 42, 2), .ny = bits(h + 44, 2), .dx = f64(h + 46),
                    .dy = f64(h + 54)};
    double scale = f64(h + 62);
    int type = h[79];
    size_t width = type == 5 ? 2 : type == 6 ? 4 : 8;

    assert_memory_equal(h, "bISO-1.0libcontact", 18);
    assert_int_equal(h[78], 0);
    assert_int_equal(h[80], 0);
    assert_int_equal(made->n, 81 + width * m.nx * m.ny);
    m.v = room(&m);
    for (size_t k = 0; k < m.nx * m.ny; k++) {
        const char *at = h + 81 + width * k;
        double value = type == 7 ? f64(at) : whole(at, width);
        m.v[k] = value == -ldexp(1, 8 * (int)width - 1) ? NAN : value * scale;
    }
    return m;
}

static struct map
decode_gsf(const struct made *made)
{
    size_t head = strlen(made->bytes), pad = 4 - head % 4;
    struct map m = {.nx = (size_t)after(made->bytes, "\nXRes = "),
                    .ny = (size_t)after(made->bytes, "\nYRes = ")};

    assert_memory_equal(made->bytes, "Gwyddion Simple Field 1.0\n", 26);
    assert_non_null(strstr(made->bytes, "\nXYUnits = m\nZUnits = m\nTitle = height\n"));
    m.dx = after(made->bytes, "\nXReal = ") / (double)m.nx;
    m.dy = after(made->bytes, "\nYReal = ") / (double)m.ny;
    assert_int_equal(made->n, head + pad + 4 * m.nx * m.ny);
    m.v = room(&m);
    for (size_t k = 0; k < m.nx * m.ny; k++)
        m.v[k] = f32(made->bytes + head + pad + 4 * k);
    return m;
}

/* The value of the item `name` of type `type` between two places. */
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

static struct map
decode_gwy(const struct made *made)
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
    m.v = room(&m);
    for (size_t k = 0; k < m.nx * m.ny; k++) {
        m.v[k] = f64(data + 4 + 8 * k);
        if (isnan(m.v[k]))
            fail_msg("a NaN, which Gwyddion cannot draw");
        if (mask != NULL && f64(mask + 4 + 8 * k) != 0)
            m.v[k] = NAN;
    }
    return m;
}

static struct map
decode_npy(const struct made *made)
{
    size_t head = 10 + bits(made->bytes + 8, 2), width;
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
    m.v = room(&m);
    for (size_t k = 0; k < m.nx * m.ny; k++)
        m.v[k] = width == 8 ? f64(made->bytes + head + 8 * k) : f32(made->bytes + head + 4 * k);
    return m;
}

static struct map
decode_csv(const struct made *made)
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
    m.v = room(&m);
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

static struct map
decode_xyz(const struct made *made)
{
    struct map m = {.dx = NAN, .dy = NAN};
    size_t lines = 0;
    double first_y = 0, y = 0;
    char *at = made->bytes;

    for (const char *s = made->bytes; *s != '\0'; s++)
        lines += *s == '\n';
    m.nx = lines;
    m.ny = 1;
    m.v = room(&m);
    m.nx = 0;
    for (size_t k = 0; k < lines; k++) {
        double x = strtod(at, &at);
        y = strtod(at, &at);
        m.v[k] = strtod(at, &at);
        first_y = k == 0 ? y : first_y;
        m.nx += y == first_y;
        if (k == 0)
            m.dx = -x; /* of the first of the middle's two sides */
        assert_int_equal(*at++, '\n');
    }
    m.ny = lines / m.nx;
    m.dx = m.nx > 1 ? 2 * m.dx / ((double)m.nx - 1) : NAN;
    m.dy = m.ny > 1 ? (y - first_y) / ((double)m.ny - 1) : NAN;
    return m;
}

static struct map
decode_sur(const struct made *made)
{
    const char *h = made->bytes;
    struct map m = {.nx = bits(h + 108, 4), .ny = bits(h + 112, 4), .dx = 1e-3 * f32(h + 120),
                    .dy = 1e-3 * f32(h + 124)};
    size_t width = bits(h + 98, 2) / 8;
    double low = whole(h + 100, 4), high = whole(h + 104, 4);

    assert_memory_equal(h, "DIGITAL SURF", 12);
    assert_int_equal(bits(h + 18, 2), 2);
    assert_int_equal(bits(h + 334, 4), 0); /* no comment, no private zone */
    assert_int_equal(bits(h + 116, 4), m.nx * m.ny);
    assert_string_equal(h + 180, "mm");
    assert_string_equal(h + 196, "mm");
    assert_string_equal(h + 212, "mm");
    assert_int_equal(made->n, 512 + width * m.nx * m.ny);
    assert_true(low == 0); /* so that subtracting it or not is the same */
    m.v = room(&m);
    for (size_t k = 0; k < m.nx * m.ny; k++) {
        double raw = whole(h + 512 + width * k, width);
        bool missing = bits(h + 86, 2) == 1 && raw == low - 2;
        assert_true(missing || (raw >= low && raw <= high));
        m.v[k] = missing ? NAN : 1e-3 * (raw * f32(h + 128) + f32(h + 474));
    }
    return m;
}

/* Where the appended data of the array `name` begin, after their length. */
static const char *
appended(const struct made *made, const char *name, size_t *bytes)
{
    char key[64];
    const char *at, *data = strstr(made->bytes, "<AppendedData encoding=\"raw\">");

    snprintf(key, sizeof key, "Name=\"%s\"", name);
    if ((at = strstr(made->bytes, key)) == NULL)
        fail_msg("no array %s", name);
    data = strchr(data, '_') + 1 + (size_t)after(at, "offset=\"");
    *bytes = bits(data, 8);
    return data + 8;
}

static struct map
decode_vtk(const struct made *made, const char *name, const char *type)
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
    m.v = room(&m);
    for (size_t k = 0; k < m.nx * m.ny; k++)
        m.v[k] = width == 8 ? f64(data + 8 * k) : f32(data + 4 * k);
    return m;
}

static struct map
decode_vti(const struct made *made)
{
    struct map m = decode_vtk(made, "height", "type=\"ImageData\"");
    const char *spacing = strstr(made->bytes, "Spacing=\"") + 9;
    char *end;

    m.dx = m.nx > 1 ? strtod(spacing, &end) : NAN;
    strtod(spacing, &end);
    m.dy = m.ny > 1 ? strtod(end, NULL) : NAN;
    return m;
}

static struct map
decode_vtr(const struct made *made)
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

static double
hdf5_number(hid_t set, const char *name)
{
    hid_t attribute = H5Aopen(set, name, H5P_DEFAULT);
    double value;

    assert_true(attribute >= 0 && H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) >= 0);
    H5Aclose(attribute);
    return value;
}

static struct map
decode_hdf5(const struct made *made)
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
    m = (struct map){.nx = size[1], .ny = size[0], .dx = hdf5_number(set, "dx"),
                     .dy = hdf5_number(set, "dy")};
    m.v = room(&m);
    assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, m.v) >= 0);
    H5Sclose(space);
    H5Dclose(set);
    H5Fclose(file);
    H5Pclose(access);
    return m;
}

/* ---- there and back ---- */

/* How far a number may be off: `step` of the range, `part` of the largest. */
static const struct {
    const char *name;
    int type; /* enum rc_raw, -1: none */
    double step, part, spacing;
    struct map (*decode)(const struct made *made);
    const char *reader;
} formats[] = {
    {"x3p", RC_RAW_I16, 0.501 / 65534, 1e-15, 0, NULL, "x3p"},
    {"x3p", RC_RAW_I32, 0.501 / 4294967294.0, 1e-15, 0, NULL, "x3p"},
    {"x3p", RC_RAW_F32, 0, 6e-8, 0, NULL, "x3p"},
    {"x3p", RC_RAW_F64, 0, 0, 0, NULL, "x3p"},
    {"sdf", -1, 0, 0, 0, decode_sdf, "sdf"},
    {"sdf-binary", RC_RAW_I16, 0, 0.501 / 32767, 0, decode_sdf_binary, "sdf"},
    {"sdf-binary", RC_RAW_I32, 0, 0.501 / 2147483647.0, 0, decode_sdf_binary, "sdf"},
    {"sdf-binary", RC_RAW_F64, 0, 0, 0, decode_sdf_binary, "sdf"},
    {"gsf", -1, 0, 6e-8, 4e-16, decode_gsf, "gsf"},
    {"gwy", -1, 0, 0, 4e-16, decode_gwy, "gwy"},
    {"npy", RC_RAW_F32, 0, 6e-8, 0, decode_npy, "npy"},
    {"npy", RC_RAW_F64, 0, 0, 0, decode_npy, "npy"},
    {"csv", -1, 0, 0, 4e-16, decode_csv, "ascii"},
    {"xyz", -1, 0, 0, 4e-16, decode_xyz, "xyz"},
    {"vti", RC_RAW_F32, 0, 6e-8, 4e-16, decode_vti, NULL},
    {"vti", RC_RAW_F64, 0, 0, 4e-16, decode_vti, NULL},
    {"vtr", RC_RAW_F32, 0, 6e-8, 1e-13, decode_vtr, NULL},
    {"vtr", RC_RAW_F64, 0, 0, 1e-13, decode_vtr, NULL},
    {"hdf5", RC_RAW_F32, 0, 6e-8, 0, decode_hdf5, "hdf5"},
    {"hdf5", RC_RAW_F64, 0, 0, 0, decode_hdf5, "hdf5"},
    /* the offset is rounded to a float below, and widens the range by that */
    {"sur", RC_RAW_I16, 0.501 / 32767, 1e-11, 6e-8, decode_sur, "sur"},
    {"sur", RC_RAW_I32, 0.501 / 2147483647.0, 1e-15, 6e-8, decode_sur, "sur"},
};

static void
compare(size_t f, const char *by, const struct rc_grid *g, const struct map *m)
{
    double low = INFINITY, high = -INFINITY, most = 0, worst = 0, within;

    assert_int_equal(m->nx, g->nx);
    assert_int_equal(m->ny, g->ny);
    if (fabs(m->dx - g->dx) > formats[f].spacing * g->dx ||
        fabs(m->dy - g->dy) > formats[f].spacing * g->dy)
        fail_msg("%s %s: spacings %.17g and %.17g", formats[f].name, by, m->dx, m->dy);
    for (size_t k = 0; k < g->nx * g->ny; k++) {
        if (isnan(g->v[k]) != isnan(m->v[k]))
            fail_msg("%s %s: value %zu is %g, not %g", formats[f].name, by, k, m->v[k], g->v[k]);
        low = fmin(low, g->v[k]);
        high = fmax(high, g->v[k]);
        most = fmax(most, fabs(g->v[k]));
        worst = fmax(worst, fabs(g->v[k] - m->v[k]));
    }
    within = (high > low ? formats[f].step * (high - low) : 0) + formats[f].part * most;
    if (!(worst <= within))
        fail_msg("%s %s, type %d, %zu x %zu: off by %g, more than %g", formats[f].name, by,
                 formats[f].type, g->nx, g->ny, worst, within);
}

/* Our own reader, asked for what the format does not say. */
static void
compare_reader(size_t f, const struct rc_grid *g, const struct made *made)
{
    const struct rc_format *reader = rc_format_named(formats[f].reader);
    struct rc_wish wish = {.dx = NAN, .dy = NAN, .z_unit = NAN};
    struct rc_file file = {.data = (const unsigned char *)made->bytes, .size = made->n};
    struct rc_notes notes = {0};
    struct rc_err err = {""};
    struct rc_grid *back;
    struct map m;

    if (reader == NULL)
        return;
    file.name = "made";
    if (strcmp(formats[f].name, "npy") == 0 || strcmp(formats[f].name, "xyz") == 0)
        wish = (struct rc_wish){.dx = g->dx, .dy = g->dy, .z_unit = 1};
    if ((back = reader->read(&file, &wish, 0, &notes, &err)) == NULL)
        fail_msg("%s, type %d, %zu x %zu: our reader says: %s", formats[f].name, formats[f].type,
                 g->nx, g->ny, err.text);
    m = (struct map){back->nx, back->ny, back->dx, back->dy, back->v};
    if (back->ny == 1 && back->dy == back->dx)
        m.dy = g->dy; /* a profile read from a file is a map with dy = dx */
    compare(f, "by our reader", g, &m);
    assert_string_equal(back->channel, "height");
    rc_grid_free(back);
}

/* A text matrix of one column could be a profile, three points could be a list, and a raster of one
 * line is none: the readers of text leave these to their user. */
static bool
reader_takes(size_t f, const struct rc_grid *g)
{
    bool csv = strcmp(formats[f].name, "csv") == 0, xyz = strcmp(formats[f].name, "xyz") == 0;

    return !(csv && g->nx == 1) && !(xyz && (g->nx == 1 || g->ny == 1));
}

static void
there_and_back(size_t nx, size_t ny, double missing)
{
    struct rc_grid *g = random_grid(nx, ny, missing);

    for (size_t f = 0; f < sizeof formats / sizeof *formats; f++) {
        struct rc_export_wish wish =
            formats[f].type < 0 ? plain : typed((enum rc_raw)formats[f].type);
        struct made made = export(formats[f].name, &g, 1, &wish);

        if (formats[f].decode != NULL) {
            struct map m = formats[f].decode(&made);
            compare(f, "decoded", g, &m);
            free(m.v);
        }
        if (formats[f].reader != NULL && reader_takes(f, g) && missing < 1)
            compare_reader(f, g, &made);
        free(made.bytes);
    }
    rc_grid_free(g);
}

static void
all_formats_on_ugly_sizes(void **state)
{
    static const size_t size[][2] = {{1, 1}, {1, 17}, {29, 1},  {2, 3},
                                     {3, 2}, {7, 13}, {61, 31}, {128, 5}};

    (void)state;
    for (size_t k = 0; k < sizeof size / sizeof *size; k++) {
        there_and_back(size[k][0], size[k][1], 0);
        there_and_back(size[k][0], size[k][1], 0.15);
    }
    there_and_back(5, 3, 1);
    for (size_t f = 0; f < sizeof formats / sizeof *formats; f++)
        if (formats[f].reader != NULL && rc_format_named(formats[f].reader) == NULL)
            printf("%s: decoded, but there is no reader '%s' to go through\n", formats[f].name,
                   formats[f].reader);
}

static void
equal_heights(void **state)
{
    struct rc_grid *g = random_grid(4, 3, 0);

    (void)state;
    for (int sign = -1; sign <= 1; sign++) {
        for (size_t k = 0; k < 12; k++)
            g->v[k] = sign * 2.5e-6;
        for (size_t f = 0; f < sizeof formats / sizeof *formats; f++) {
            struct rc_export_wish wish =
                formats[f].type < 0 ? plain : typed((enum rc_raw)formats[f].type);
            struct made made = export(formats[f].name, &g, 1, &wish);
            struct map m;

            if (formats[f].decode != NULL) {
                m = formats[f].decode(&made);
                /* the sur offset rounds down to a float, and the step takes up the rest */
                compare(f, "decoded", g, &m);
                free(m.v);
            } else {
                compare_reader(f, g, &made);
            }
            free(made.bytes);
        }
    }
    rc_grid_free(g);
}

/* ---- what a file says beside its numbers ---- */

static zip_t *
unzip(const struct made *made)
{
    zip_source_t *from = zip_source_buffer_create(made->bytes, made->n, 0, NULL);
    zip_t *zip = zip_open_from_source(from, ZIP_RDONLY, NULL);

    assert_non_null(zip);
    return zip;
}

static void
member(zip_t *zip, const char *name, char *to, size_t size)
{
    zip_file_t *f = zip_fopen(zip, name, 0);
    zip_int64_t n;

    if (f == NULL)
        fail_msg("the archive has no %s", name);
    n = zip_fread(f, to, size - 1);
    assert_true(n >= 0);
    to[n] = '\0';
    zip_fclose(f);
}

/* Points 1 and 9 of ten are missing: 1111 1101, 01 by the standard, lowest bit first. */
static void
x3p_parts(void **state)
{
    struct rc_grid *g = random_grid(5, 2, 0);
    char xml[8192], bytes[200];
    struct made made;
    zip_t *zip;

    (void)state;
    g->v[1] = g->v[9] = NAN;
    rc_grid_set(g, "file.date", "2024-02-29T12:30:00Z", NULL);
    rc_grid_set(g, "file.creator", "A. <B> & \"C\"", NULL);
    rc_grid_set(g, "history", "rc-import 0.1.0", NULL);
    made = export("x3p", &g, 1, &plain);
    zip = unzip(&made);
    member(zip, "main.xml", xml, sizeof xml);
    assert_non_null(strstr(xml, "<Date>2024-02-29T12:30:00Z</Date>"));
    assert_non_null(strstr(xml, "<Creator>A. &lt;B&gt; &amp; &quot;C&quot;</Creator>"));
    assert_non_null(strstr(xml, "<Comment>rc-import 0.1.0</Comment>"));
    assert_non_null(strstr(xml, "<AxisType>A</AxisType><DataType>D</DataType>"));
    assert_non_null(strstr(xml, "<ValidPointsLink>bindata/valid.bin</ValidPointsLink>"));
    member(zip, "bindata/valid.bin", bytes, sizeof bytes);
    assert_memory_equal(bytes, "\xfd\x01", 3);
    member(zip, "md5checksum.hex", bytes, sizeof bytes);
    assert_string_equal(bytes + 32, " *main.xml\n");
    zip_discard(zip);
    free(made.bytes);
    g->v[1] = g->v[9] = 1e-6;
    made = export("x3p", &g, 1, &plain);
    zip = unzip(&made);
    member(zip, "main.xml", xml, sizeof xml);
    assert_null(strstr(xml, "ValidPoints"));
    assert_true(zip_name_locate(zip, "bindata/valid.bin", 0) < 0);
    zip_discard(zip);
    free(made.bytes);
    rc_grid_free(g);
}

/* Noise in all of its bits does not pack, and is stored; a slope does. */
static void
x3p_packs_what_packs(void **state)
{
    static const zip_uint16_t method[] = {ZIP_CM_STORE, ZIP_CM_DEFLATE};

    (void)state;
    for (size_t k = 0; k < 2; k++) {
        struct rc_grid *g = random_grid(300, 200, 0);
        struct made made;
        zip_stat_t st;
        zip_t *zip;

        for (size_t i = 0; k == 1 && i < 60000; i++)
            g->v[i] = 1e-6 * (double)(i % 300);
        made = export("x3p", &g, 1, &plain);
        zip = unzip(&made);
        assert_int_equal(zip_stat(zip, "bindata/data.bin", 0, &st), 0);
        assert_int_equal(st.size, 480000);
        assert_int_equal(st.comp_method, method[k]);
        zip_discard(zip);
        free(made.bytes);
        rc_grid_free(g);
    }
}

static void
same_frames_same_bytes(void **state)
{
    struct rc_grid *g = random_grid(13, 7, 0.1);

    (void)state;
    for (const struct rc_export *const *e = rc_exports; *e != NULL; e++) {
        struct made a = export((*e)->name, &g, 1, &plain), b = export((*e)->name, &g, 1, &plain);
        assert_int_equal(a.n, b.n);
        assert_memory_equal(a.bytes, b.bytes, a.n);
        free(a.bytes);
        free(b.bytes);
    }
    rc_grid_free(g);
}

static void
comma_locale(void **state)
{
    struct rc_grid *g = random_grid(3, 2, 0.2);
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"};
    const char *found = NULL;

    (void)state;
    for (size_t k = 0; k < sizeof names / sizeof *names && found == NULL; k++)
        found = setlocale(LC_NUMERIC, names[k]) == NULL ? NULL : names[k];
    if (found == NULL)
        printf("not checked: no locale with a decimal comma is installed\n");
    for (const struct rc_export *const *e = rc_exports; *e != NULL && found != NULL; e++) {
        struct made a = export((*e)->name, &g, 1, &plain), b;
        setlocale(LC_NUMERIC, "C");
        b = export((*e)->name, &g, 1, &plain);
        setlocale(LC_NUMERIC, found);
        assert_int_equal(a.n, b.n);
        assert_memory_equal(a.bytes, b.bytes, a.n);
        free(a.bytes);
        free(b.bytes);
    }
    setlocale(LC_NUMERIC, "C");
    rc_grid_free(g);
}

/* ---- several frames ---- */

enum {
    STACK = 6
};

/* mises and szz at three depths, in the order of a stream; the value tells where it stands. */
static void
make_stack(struct rc_grid *frame[STACK], const double depth[3])
{
    for (size_t k = 0; k < STACK; k++) {
        struct rc_shape shape = {.nx = 3, .ny = 2, .dx = 1e-6, .dy = 2e-6};
        frame[k] = rc_grid_new(&shape, k % 2 == 0 ? "mises" : "szz", "Pa", NULL);
        rc_grid_set_number(frame[k], "depth", depth[k / 2], NULL);
        for (size_t i = 0; i < 6; i++)
            frame[k]->v[i] = 100.0 * (double)(k % 2) + 10.0 * (double)(k / 2) + (double)i;
    }
}

static void
drop_stack(struct rc_grid *frame[STACK])
{
    for (size_t k = 0; k < STACK; k++)
        rc_grid_free(frame[k]);
}

static void
check_stack(const struct made *made)
{
    static const char *const name[] = {"mises", "szz"};

    for (size_t a = 0; a < 2; a++) {
        size_t bytes;
        const char *data = appended(made, name[a], &bytes);
        assert_int_equal(bytes, 8 * 18);
        for (size_t k = 0; k < 18; k++)
            assert_true(f64(data + 8 * k) ==
                        100.0 * (double)a + 10.0 * (double)(k / 6) + (double)(k % 6));
    }
    assert_non_null(strstr(made->bytes, ">Pa</InformationKey>"));
}

static void
depths_make_a_stack(void **state)
{
    static const double even[] = {1e-6, 2.5e-6, 4e-6}, uneven[] = {0, 1e-6, 4e-6};
    struct rc_grid *frame[STACK], *swapped[STACK];
    struct made made;
    const char *z;
    size_t bytes;

    (void)state;
    make_stack(frame, even);
    made = export("vti", frame, STACK, &plain);
    assert_non_null(strstr(made.bytes, "WholeExtent=\"0 2 0 1 0 2\" Origin=\"-1e-06 -1e-06 1e-06\" "
                                       "Spacing=\"1e-06 2e-06 1.5e-06\""));
    check_stack(&made);
    free(made.bytes);
    for (size_t k = 0; k < STACK; k++)
        swapped[k] = frame[STACK - 1 - k]; /* the deepest first */
    made = export("vti", swapped, STACK, &plain);
    check_stack(&made);
    free(made.bytes);
    drop_stack(frame);
    make_stack(frame, uneven);
    refuse("vti", frame, STACK, &plain, "uneven steps");
    made = export("vtr", frame, STACK, &plain);
    check_stack(&made);
    z = appended(&made, "z", &bytes);
    assert_int_equal(bytes, 24);
    for (size_t k = 0; k < 3; k++)
        assert_true(f64(z + 8 * k) == uneven[k]);
    free(made.bytes);
    refuse("vti", frame, STACK - 1, &plain, "mises has 3 depths and szz has 2");
    rc_grid_set(frame[5], "depth", NULL, NULL);
    refuse("vtr", frame, STACK, &plain, "some have none");
    rc_grid_set_number(frame[5], "depth", 5e-6, NULL);
    refuse("vtr", frame, STACK, &plain, "different depths");
    rc_grid_set_number(frame[4], "depth", 1e-6, NULL);
    refuse("vtr", frame, STACK, &plain, "two frames of channel mises at one depth");
    drop_stack(frame);
}

static void
a_section_stands_upright(void **state)
{
    struct rc_shape shape = {.nx = 3, .ny = 2, .dx = 1e-6, .dy = 4e-6};
    struct rc_grid *g = rc_grid_new(&shape, "mises", "Pa", NULL);
    struct made made;
    size_t bytes;
    const char *at;

    (void)state;
    for (size_t k = 0; k < 6; k++)
        g->v[k] = (double)k;
    rc_grid_set(g, "section", "y", NULL);
    rc_grid_set_number(g, "at", 7e-6, NULL);
    refuse("vtr", &g, 1, &plain, "without as many depths");
    rc_grid_set(g, "depths", "0,4e-06", NULL);
    made = export("vti", &g, 1, &plain);
    assert_non_null(strstr(made.bytes, "WholeExtent=\"0 2 0 0 0 1\" Origin=\"-1e-06 7e-06 0\" "
                                       "Spacing=\"1e-06 1e-06 4e-06\""));
    free(made.bytes);
    rc_grid_set(g, "section", "x", NULL);
    made = export("vtr", &g, 1, &plain);
    assert_non_null(strstr(made.bytes, "WholeExtent=\"0 0 0 2 0 1\""));
    at = appended(&made, "x", &bytes);
    assert_true(bytes == 8 && f64(at) == 7e-6);
    at = appended(&made, "mises", &bytes);
    assert_true(bytes == 48 && f64(at + 40) == 5);
    free(made.bytes);
    rc_grid_free(g);
}

static void
frames_have_names_of_their_own(void **state)
{
    struct rc_grid *frame[3];
    struct made made;

    (void)state;
    for (size_t k = 0; k < 3; k++)
        frame[k] = random_grid(4, 3, 0);
    rc_grid_set(frame[1], "case", "2", NULL);
    rc_grid_set(frame[2], "case", "2", NULL);
    made = export("vti", frame, 3, &plain);
    assert_non_null(strstr(made.bytes, "Name=\"height_case1\""));
    assert_non_null(strstr(made.bytes, "Name=\"height_case2\""));
    assert_non_null(strstr(made.bytes, "Name=\"height_case2_2\""));
    free(made.bytes);
    made = export("gwy", frame, 3, &plain);
    assert_string_equal(gwy_item(made.bytes, made.bytes + made.n, "/2/data/title", 's'),
                        "height_case2_2");
    free(made.bytes);
    frame[0]->dx *= 2;
    refuse("vti", frame, 3, &plain, "another grid");
    made = export("hdf5", frame, 3, &plain); /* each has a grid of its own there */
    free(made.bytes);
    for (size_t k = 0; k < 3; k++)
        rc_grid_free(frame[k]);
}

/* ---- refusals ---- */

static void
what_cannot_be_said(void **state)
{
    static const char *const finite[] = {"x3p", "sdf", "sdf-binary", "sur"};
    struct rc_grid *g = random_grid(4, 3, 0);
    struct rc_export_wish narrow = typed(RC_RAW_F32);

    (void)state;
    g->v[6] = 1e300;
    refuse("npy", &g, 1, &narrow, "too large for the type f32");
    refuse("gsf", &g, 1, &plain, "too large for the type f32");
    refuse("sur", &g, 1, &plain, "beyond the floats");
    g->v[6] = -INFINITY;
    for (size_t k = 0; k < sizeof finite / sizeof *finite; k++)
        refuse(finite[k], &g, 1, &plain, "column 2, row 1 (from 0) is infinite");
    rc_grid_free(g);
    g = random_grid(65536, 1, 0);
    refuse("sdf-binary", &g, 1, &plain, "at most 65535");
    rc_grid_free(g);
}

static void
full_device(void **state)
{
    struct rc_grid *g = random_grid(300, 300, 0.1);
    FILE *f = fopen("/dev/full", "wb");

    (void)state;
    assert_non_null(f);
    setvbuf(f, NULL, _IONBF, 0);
    for (const struct rc_export *const *e = rc_exports; *e != NULL; e++) {
        struct rc_err err = {""};
        if ((*e)->write(f, &g, 1, &plain, &err) == RC_OK || strstr(err.text, "writing failed") == NULL)
            fail_msg("%s: a full device is not told (%s)", (*e)->name, err.text);
    }
    fclose(f);
    rc_grid_free(g);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_formats_on_ugly_sizes),
        cmocka_unit_test(equal_heights),
        cmocka_unit_test(x3p_parts),
        cmocka_unit_test(x3p_packs_what_packs),
        cmocka_unit_test(same_frames_same_bytes),
        cmocka_unit_test(comma_locale),
        cmocka_unit_test(depths_make_a_stack),
        cmocka_unit_test(a_section_stands_upright),
        cmocka_unit_test(frames_have_names_of_their_own),
        cmocka_unit_test(what_cannot_be_said),
        cmocka_unit_test(full_device),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
