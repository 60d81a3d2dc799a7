/*
 * NetCDF classic (versions 1, 2 and 5): all big-endian. A header with dimensions, attributes and
 * variables, and the values of each variable from its offset on. A variable along the record
 * dimension is spread over the records, which hold a row of each such variable.
 *
 * The library for it also fetches from the network and reads HDF5; what is needed here is this
 * header. A map is a variable of two dimensions. Rows run along the second to last dimension, but
 * for (x, y), which is turned. Spacings are those of the variables that bear the dimensions' names.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bytes.h"
#include "format.h"
#include "text.h"
#include "values.h"

enum {
    DIMENSIONS = 10, /* tags of lists */
    VARIABLES = 11,
    ATTRIBUTES = 12,
    DIMENSIONS_MOST = 1024,
    VARIABLES_MOST = 4096,
    RANK_MOST = 1024,
    CHAR = 2, /* type of text */
    TYPES = 12,
};

/* Bytes of a value by type; 0: none. */
static const unsigned char width[TYPES] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};

struct piece {
    const char *text;
    size_t n;
};

struct dimension {
    struct piece name;
    uint64_t length; /* 0: of records */
};

struct variable {
    struct piece name, unit, title;
    size_t rank, dimension[2]; /* the first two */
    unsigned type;
    uint64_t size, at;         /* size: bytes, of one record where it has records */
    double fill, factor, offset; /* NAN, 1, 0 when not given */
    double period;               /* not 0: it says it repeats */
};

struct netcdf {
    const struct rc_file *file;
    struct rc_bytes b;
    unsigned version;
    uint64_t records, record; /* their number; bytes of one */
    struct dimension *dimension;
    size_t dimensions;
    struct variable *variable;
    size_t variables;
};

/* ---- the header ---- */

/* A count or a size: 64 bits in version 5. */
static uint64_t
count(struct netcdf *f)
{
    return f->version == 5 ? rc_bytes_u64(&f->b) : rc_bytes_u32(&f->b);
}

/* The next n bytes and their padding to a multiple of four. */
static struct piece
bytes(struct netcdf *f, uint64_t n)
{
    size_t there = f->b.size - f->b.at;
    struct piece p = {(const char *)f->b.data + f->b.at, (size_t)n};

    if (n > there || (n + 3) / 4 * 4 > there) {
        f->b.past = true;
        return (struct piece){"", 0};
    }
    f->b.at += (size_t)((n + 3) / 4 * 4);
    return p;
}

static bool
is(struct piece p, const char *word)
{
    return p.n == strlen(word) && memcmp(p.text, word, p.n) == 0;
}

static double
value(const unsigned char *at, unsigned type)
{
    struct rc_bytes b = {.data = at, .size = width[type], .big = true};
    uint64_t wide;
    int64_t whole;
    double v;

    switch (type) {
    case 1:
        return (double)(*at ^ 0x80) - 128;
    case 2:
    case 7:
        return *at;
    case 3:
        rc_bytes_values(&b, RC_RAW_I16, &v, 1);
        return v;
    case 4:
        rc_bytes_values(&b, RC_RAW_I32, &v, 1);
        return v;
    case 5:
        rc_bytes_values(&b, RC_RAW_F32, &v, 1);
        return v;
    case 6:
        rc_bytes_values(&b, RC_RAW_F64, &v, 1);
        return v;
    case 8:
        return rc_bytes_u16(&b);
    case 9:
        return rc_bytes_u32(&b);
    case 10:
        wide = rc_bytes_u64(&b);
        memcpy(&whole, &wide, sizeof whole);
        return (double)whole;
    default:
        return (double)rc_bytes_u64(&b);
    }
}

static enum rc_status
list_of(struct netcdf *f, uint32_t tag, const char *what, uint64_t most, uint64_t *n,
        struct rc_err *err)
{
    uint32_t got = rc_bytes_u32(&f->b);

    *n = count(f);
    if (f->b.past)
        return rc_err_set(err, "the header is cut off before its %s", what);
    if (got == 0 && *n == 0)
        return RC_OK;
    if (got != tag)
        return rc_err_set(err, "the list of %s begins with %u, not %u", what, (unsigned)got,
                          (unsigned)tag);
    if (*n > most)
        return rc_err_set(err, "a list of %llu %s: more than the %llu that can be meant",
                          (unsigned long long)*n, what, (unsigned long long)most);
    return RC_OK;
}

static enum rc_status
read_dimensions(struct netcdf *f, struct rc_err *err)
{
    uint64_t n;

    if (list_of(f, DIMENSIONS, "dimensions", DIMENSIONS_MOST, &n, err) != RC_OK)
        return RC_FAIL;
    if ((f->dimension = calloc((size_t)n + 1, sizeof *f->dimension)) == NULL)
        return rc_err_set(err, "out of memory for %zu dimensions", (size_t)n);
    for (f->dimensions = 0; f->dimensions < n && !f->b.past; f->dimensions++) {
        struct dimension *d = &f->dimension[f->dimensions];
        d->name = bytes(f, count(f));
        d->length = count(f);
    }
    return f->b.past ? rc_err_set(err, "the header is cut off in its dimensions") : RC_OK;
}

static void
take_attribute(struct variable *v, struct piece name, unsigned type, uint64_t n, struct piece p)
{
    const unsigned char *at = (const unsigned char *)p.text;

    if (type == CHAR && (is(name, "unit") || is(name, "units")))
        v->unit = p;
    else if (type == CHAR && is(name, "long_name"))
        v->title = p;
    if (type == CHAR || n != 1)
        return;
    if (is(name, "_FillValue") || (is(name, "missing_value") && isnan(v->fill)))
        v->fill = value(at, type);
    else if (is(name, "scale_factor"))
        v->factor = value(at, type);
    else if (is(name, "add_offset"))
        v->offset = value(at, type);
    else if (is(name, "periodic"))
        v->period = value(at, type);
}

/* Attributes of a variable, or with NULL those of the file, which are skipped. */
static enum rc_status
read_attributes(struct netcdf *f, struct variable *v, struct rc_err *err)
{
    uint64_t n, k;

    if (list_of(f, ATTRIBUTES, "attributes", f->b.size, &n, err) != RC_OK)
        return RC_FAIL;
    for (k = 0; k < n && !f->b.past; k++) {
        struct piece name = bytes(f, count(f)), p;
        uint32_t type = rc_bytes_u32(&f->b);
        uint64_t values = count(f);

        if (f->b.past || type == 0 || type >= TYPES || values > f->b.size)
            return rc_err_set(err, "attribute %llu is damaged or cut off",
                              (unsigned long long)k + 1);
        p = bytes(f, values * width[type]);
        if (v != NULL && !f->b.past)
            take_attribute(v, name, type, values, p);
    }
    return f->b.past ? rc_err_set(err, "the header is cut off in its attributes") : RC_OK;
}

static enum rc_status
read_variable(struct netcdf *f, struct variable *v, struct rc_err *err)
{
    char quote[RC_SHOWN];
    uint64_t rank;

    *v = (struct variable){.fill = NAN, .factor = 1};
    v->name = bytes(f, count(f));
    rank = count(f);
    if (f->b.past || rank > RANK_MOST)
        return rc_err_set(err, "variable %zu is damaged or cut off", f->variables + 1);
    v->rank = (size_t)rank;
    for (size_t k = 0; k < v->rank; k++) {
        uint64_t id = count(f);
        if (id >= f->dimensions)
            return rc_err_set(err, "variable '%s' has dimension %llu of %zu",
                              rc_text_shown(quote, v->name.text, v->name.n), (unsigned long long)id,
                              f->dimensions);
        if (k < 2)
            v->dimension[k] = (size_t)id;
    }
    if (read_attributes(f, v, err) != RC_OK)
        return RC_FAIL;
    v->type = rc_bytes_u32(&f->b);
    v->size = count(f);
    v->at = f->version == 1 ? rc_bytes_u32(&f->b) : rc_bytes_u64(&f->b);
    if (f->b.past || v->type == 0 || v->type >= TYPES)
        return rc_err_set(err, "variable '%s' is cut off, or of type %u, which there is not",
                          rc_text_shown(quote, v->name.text, v->name.n), v->type);
    return RC_OK;
}

static bool
has_records(const struct netcdf *f, const struct variable *v)
{
    return v->rank > 0 && f->dimension[v->dimension[0]].length == 0;
}

static enum rc_status
read_variables(struct netcdf *f, struct rc_err *err)
{
    size_t with_records = 0;
    uint64_t n;

    if (list_of(f, VARIABLES, "variables", VARIABLES_MOST, &n, err) != RC_OK)
        return RC_FAIL;
    if (n > f->b.size / 16) /* each takes that much of the header */
        return rc_err_set(err, "a list of %llu variables in %zu bytes", (unsigned long long)n,
                          f->b.size);
    if ((f->variable = calloc((size_t)n + 1, sizeof *f->variable)) == NULL)
        return rc_err_set(err, "out of memory for %zu variables", (size_t)n);
    for (; f->variables < n; f->variables++)
        if (read_variable(f, &f->variable[f->variables], err) != RC_OK)
            return RC_FAIL;
    for (size_t k = 0; k < f->variables; k++)
        if (has_records(f, &f->variable[k])) {
            if (f->variable[k].size > f->b.size)
                return rc_err_set(err, "a record of %llu bytes in a file of %zu",
                                  (unsigned long long)f->variable[k].size, f->b.size);
            f->record += f->variable[k].size;
            with_records++;
        }
    /* the only one with records is not padded */
    for (size_t k = 0; k < f->variables && with_records == 1; k++)
        if (has_records(f, &f->variable[k]) && f->variable[k].rank == 2) {
            const struct variable *v = &f->variable[k];
            f->record = f->dimension[v->dimension[1]].length * width[v->type];
        }
    return RC_OK;
}

static void
netcdf_close(struct netcdf *f)
{
    free(f->dimension);
    free(f->variable);
}

static enum rc_status
netcdf_open(struct netcdf *f, const struct rc_file *file, struct rc_err *err)
{
    *f = (struct netcdf){.file = file, .b = {.data = file->data, .size = file->size, .big = true}};
    if (file->size < 8 || memcmp(file->data, "CDF", 3) != 0)
        return rc_err_set(err, "no NetCDF file: it does not begin with 'CDF'");
    f->version = file->data[3];
    if (f->version != 1 && f->version != 2 && f->version != 5)
        return rc_err_set(err, "version %u of NetCDF: only 1, 2 and 5 are read here", f->version);
    f->b.at = 4;
    f->records = count(f);
    if (read_dimensions(f, err) != RC_OK || read_attributes(f, NULL, err) != RC_OK)
        return RC_FAIL;
    return read_variables(f, err);
}

/* ---- maps ---- */

static uint64_t
length(const struct netcdf *f, size_t dimension)
{
    uint64_t n = f->dimension[dimension].length;

    return n == 0 ? f->records : n;
}

static bool
is_map(const struct netcdf *f, const struct variable *v)
{
    return v->rank == 2 && v->type != CHAR && length(f, v->dimension[0]) > 0 &&
           length(f, v->dimension[1]) > 0;
}

static const struct variable *
named(const struct netcdf *f, struct piece name)
{
    for (size_t k = 0; k < f->variables; k++)
        if (f->variable[k].name.n == name.n &&
            memcmp(f->variable[k].name.text, name.text, name.n) == 0)
            return &f->variable[k];
    return NULL;
}

/* Where value (i, j) of a map lies; its bytes were checked. */
static const unsigned char *
place(const struct netcdf *f, const struct variable *v, uint64_t i, uint64_t j)
{
    uint64_t columns = v->rank == 2 ? length(f, v->dimension[1]) : 1;
    uint64_t row = has_records(f, v) ? f->record : columns * width[v->type];

    return f->b.data + v->at + i * row + j * width[v->type];
}

static enum rc_status
check_bytes(const struct netcdf *f, const struct variable *v, struct rc_err *err)
{
    char quote[RC_SHOWN];
    uint64_t rows = length(f, v->dimension[0]);
    uint64_t columns = v->rank == 2 ? length(f, v->dimension[1]) : 1;
    uint64_t row, there = v->at > f->b.size ? 0 : f->b.size - v->at;

    rc_text_shown(quote, v->name.text, v->name.n);
    if (columns > there / width[v->type])
        return rc_err_set(err, "variable '%s' promises %llu values a row, the file is too short",
                          quote, (unsigned long long)columns);
    row = columns * width[v->type];
    if (has_records(f, v) && f->record < row)
        return rc_err_set(err, "variable '%s' does not fit its records", quote);
    row = has_records(f, v) ? f->record : row;
    if (rows - 1 > (there - columns * width[v->type]) / row)
        return rc_err_set(err, "variable '%s' promises %llu x %llu values, the file is too short",
                          quote, (unsigned long long)rows, (unsigned long long)columns);
    return RC_OK;
}

/* The step of a coordinate in metres, NAN where it is not told. */
static enum rc_status
step_of(const struct netcdf *f, size_t dimension, double *step, bool *periodic, struct rc_err *err)
{
    const struct variable *v = named(f, f->dimension[dimension].name);
    char quote[RC_SHOWN];
    uint64_t n = length(f, dimension);
    double first, last, metres;

    *step = NAN;
    *periodic = false;
    if (v == NULL || v->rank != 1 || v->dimension[0] != dimension || v->type == CHAR || n < 2)
        return RC_OK;
    if (check_bytes(f, v, err) != RC_OK)
        return RC_FAIL;
    rc_text_shown(quote, v->name.text, v->name.n);
    if (!rc_length_unit(v->unit.text, v->unit.n, &metres))
        return RC_OK;
    first = value(place(f, v, 0, 0), v->type);
    last = value(place(f, v, n - 1, 0), v->type);
    *step = (last - first) / (double)(n - 1);
    for (uint64_t k = 0; k < n; k++)
        if (!(fabs(value(place(f, v, k, 0), v->type) - first - (double)k * *step) <=
              1e-6 * fabs(*step)))
            return rc_err_set(err, "the coordinate '%s' has uneven steps: only regular grids are "
                                   "read", quote);
    *step = *step * v->factor * metres;
    *periodic = v->period != 0;
    return RC_OK;
}

struct map {
    const struct variable *v;
    bool turned; /* (x, y): rows run along the first dimension's other */
    size_t nx, ny;
    double dx, dy, metres;
    bool periodic;
};

static enum rc_status
judge_map(const struct netcdf *f, const struct variable *v, struct map *m, struct rc_err *err)
{
    bool along_x, along_y;
    size_t x, y;

    m->v = v;
    m->turned = is(f->dimension[v->dimension[0]].name, "x") &&
                is(f->dimension[v->dimension[1]].name, "y");
    x = v->dimension[m->turned ? 0 : 1];
    y = v->dimension[m->turned ? 1 : 0];
    m->nx = (size_t)length(f, x);
    m->ny = (size_t)length(f, y);
    if (!rc_length_unit(v->unit.text, v->unit.n, &m->metres))
        m->metres = NAN;
    if (step_of(f, x, &m->dx, &along_x, err) != RC_OK ||
        step_of(f, y, &m->dy, &along_y, err) != RC_OK)
        return RC_FAIL;
    m->periodic = along_x && along_y;
    return RC_OK;
}

static size_t
netcdf_list(const struct rc_file *file, const struct rc_wish *wish, struct rc_channel *channel,
            size_t most, struct rc_err *err)
{
    struct netcdf f;
    struct map m;
    size_t n = 0;

    (void)wish;
    if (netcdf_open(&f, file, err) == RC_OK) {
        for (size_t k = 0; k < f.variables; k++) {
            const struct variable *v = &f.variable[k];
            if (!is_map(&f, v))
                continue;
            if (n < most) {
                if (judge_map(&f, v, &m, err) != RC_OK) {
                    n = 0;
                    goto done;
                }
                channel[n] = (struct rc_channel){.nx = m.nx, .ny = m.ny, .dx = m.dx, .dy = m.dy};
                rc_text_clean(channel[n].name, sizeof channel->name, v->name.text, v->name.n);
                rc_text_clean(channel[n].unit, sizeof channel->unit,
                              isnan(m.metres) ? v->unit.text : "m",
                              isnan(m.metres) ? v->unit.n : 1);
            }
            n++;
        }
        if (n == 0)
            rc_err_set(err, "none of the file's %zu variables has two dimensions", f.variables);
    }
done:
    netcdf_close(&f);
    return n;
}

/* ---- values ---- */

static void
read_values(const struct netcdf *f, const struct map *m, double metres, struct rc_grid *g)
{
    const struct variable *v = m->v;

    for (size_t j = 0; j < m->ny; j++)
        for (size_t i = 0; i < m->nx; i++) {
            double raw = value(place(f, v, m->turned ? i : j, m->turned ? j : i), v->type);
            g->v[j * m->nx + i] =
                raw == v->fill ? NAN : (raw * v->factor + v->offset) * metres;
        }
}

static const struct variable *
pick(const struct netcdf *f, size_t index, struct rc_err *err)
{
    size_t n = 0;

    for (size_t k = 0; k < f->variables; k++)
        if (is_map(f, &f->variable[k]) && n++ == index)
            return &f->variable[k];
    rc_err_set(err, "the file has %zu variables of two dimensions, not %zu", n, index + 1);
    return NULL;
}

static struct rc_grid *
netcdf_read(const struct rc_file *file, const struct rc_wish *wish, size_t index,
            struct rc_notes *notes, struct rc_err *err)
{
    const struct variable *v;
    struct rc_grid *g = NULL;
    struct rc_shape shape;
    struct netcdf f;
    struct map m;
    char unit[RC_SHOWN];
    double metres;
    bool good = false;

    if (netcdf_open(&f, file, err) != RC_OK || (v = pick(&f, index, err)) == NULL ||
        check_bytes(&f, v, err) != RC_OK || judge_map(&f, v, &m, err) != RC_OK)
        goto done;
    shape = (struct rc_shape){.nx = m.nx, .ny = m.ny};
    if (rc_map_fits(file, m.nx, m.ny, err) != RC_OK ||
        rc_spacing(wish, m.dx, m.dy, &shape, notes, err) != RC_OK ||
        rc_height_unit(wish, m.metres, rc_text_shown(unit, v->unit.text, v->unit.n), &metres, notes,
                       err) != RC_OK ||
        (g = rc_grid_new(&shape, "height", "m", err)) == NULL ||
        rc_text_keep(g, "file.channel", v->name.text, v->name.n, err) != RC_OK ||
        rc_text_keep(g, "file.title", v->title.text == NULL ? "" : v->title.text, v->title.n,
                     err) != RC_OK ||
        (m.periodic && rc_grid_set(g, "periodic", "yes", err) != RC_OK))
        goto done;
    read_values(&f, &m, metres, g);
    good = rc_values_finite(g, err) == RC_OK;
done:
    netcdf_close(&f);
    if (good)
        return g;
    rc_grid_free(g);
    return NULL;
}

static int
netcdf_score(const struct rc_file *file)
{
    return file->size >= 8 && memcmp(file->data, "CDF", 3) == 0 &&
                   (file->data[3] == 1 || file->data[3] == 2 || file->data[3] == 5)
               ? 90
               : 0;
}

const struct rc_format rc_format_netcdf = {
    .name = "netcdf",
    .suffixes = ".nc .cdf",
    .summary = "NetCDF classic: variables of two dimensions",
    .score = netcdf_score,
    .list = netcdf_list,
    .read = netcdf_read,
};
