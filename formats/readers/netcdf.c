/*
 * NetCDF classic (versions 1, 2 and 5): all big-endian. A header with dimensions, attributes and
 * variables, and the values of each variable from its offset on. A variable along the record
 * dimension is spread over the records, which hold a row of each such variable.
 *
 * NetCDF's library would also fetch files from the network and read HDF5; only the header is needed
 * here. A map is a variable of two dimensions. Rows run along the second to last dimension, but
 * for (x, y), which is turned. Spacings are those of the variables that bear the dimensions' names.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/containers/containers.h"
#include "formats/format.h"

static uint64_t
length(const struct rc_cdf *f, size_t dimension)
{
    uint64_t n = f->dimension[dimension].length;

    return n == 0 ? f->records : n;
}

static bool
is_map(const struct rc_cdf *f, const struct rc_cdf_variable *v)
{
    return v->rank == 2 && v->type != RC_CDF_CHAR && length(f, v->dimension[0]) > 0 &&
           length(f, v->dimension[1]) > 0;
}

static const struct rc_cdf_variable *
named(const struct rc_cdf *f, struct rc_piece name)
{
    for (size_t k = 0; k < f->variables; k++)
        if (f->variable[k].name.n == name.n &&
            memcmp(f->variable[k].name.text, name.text, name.n) == 0)
            return &f->variable[k];
    return NULL;
}

/* Where value (i, j) of a map lies; its bytes were checked. */
static const unsigned char *
place(const struct rc_cdf *f, const struct rc_cdf_variable *v, uint64_t i, uint64_t j)
{
    uint64_t columns = v->rank == 2 ? length(f, v->dimension[1]) : 1;
    uint64_t row = rc_cdf_has_records(f, v) ? f->record : columns * rc_cdf_width[v->type];

    return f->b.data + v->at + i * row + j * rc_cdf_width[v->type];
}

static enum rc_status
check_bytes(const struct rc_cdf *f, const struct rc_cdf_variable *v, struct rc_err *err)
{
    char quote[RC_SHOWN];
    uint64_t rows = length(f, v->dimension[0]);
    uint64_t columns = v->rank == 2 ? length(f, v->dimension[1]) : 1;
    uint64_t row, there = v->at > f->b.size ? 0 : f->b.size - v->at;

    rc_piece_shown(quote, v->name);
    if (columns > there / rc_cdf_width[v->type])
        return rc_err_set(err, "variable '%s' promises %llu values a row, the file is too short",
                          quote, (unsigned long long)columns);
    row = columns * rc_cdf_width[v->type];
    if (rc_cdf_has_records(f, v) && f->record < row)
        return rc_err_set(err, "variable '%s' does not fit its records", quote);
    row = rc_cdf_has_records(f, v) ? f->record : row;
    if (rows - 1 > (there - columns * rc_cdf_width[v->type]) / row)
        return rc_err_set(err, "variable '%s' promises %llu x %llu values, the file is too short",
                          quote, (unsigned long long)rows, (unsigned long long)columns);
    return RC_OK;
}

/* The step of a coordinate in metres, NAN where the file does not give it. */
static enum rc_status
step_of(const struct rc_cdf *f, size_t dimension, double *step, bool *periodic, struct rc_err *err)
{
    const struct rc_cdf_variable *v = named(f, f->dimension[dimension].name);
    char quote[RC_SHOWN];
    uint64_t n = length(f, dimension);
    double first, last, metres;

    *step = NAN;
    *periodic = false;
    if (v == NULL || v->rank != 1 || v->dimension[0] != dimension || v->type == RC_CDF_CHAR ||
        n < 2)
        return RC_OK;
    if (check_bytes(f, v, err) != RC_OK)
        return RC_FAIL;
    rc_piece_shown(quote, v->name);
    if (!rc_length_unit(v->unit.text, v->unit.n, &metres))
        return RC_OK;
    first = rc_cdf_value(place(f, v, 0, 0), v->type);
    last = rc_cdf_value(place(f, v, n - 1, 0), v->type);
    *step = (last - first) / (double)(n - 1);
    for (uint64_t k = 0; k < n; k++)
        if (!(fabs(rc_cdf_value(place(f, v, k, 0), v->type) - first - (double)k * *step) <=
              1e-6 * fabs(*step)))
            return rc_err_set(err,
                              "the coordinate '%s' has uneven steps: only regular grids are "
                              "read",
                              quote);
    *step = *step * v->factor * metres;
    *periodic = v->period != 0;
    return RC_OK;
}

struct map {
    const struct rc_cdf_variable *v;
    bool turned; /* the dimensions are (x, y), not (y, x) */
    bool periodic;
    struct rc_heights heights;
    char unit[RC_SHOWN];
    char name[RC_SHOWN];
};

static enum rc_status
judge_map(const struct rc_cdf *f, const struct rc_cdf_variable *v, struct map *m,
          struct rc_err *err)
{
    bool along_x, along_y;
    size_t x, y;

    m->v = v;
    m->turned = rc_cdf_is(f->dimension[v->dimension[0]].name, "x") &&
                rc_cdf_is(f->dimension[v->dimension[1]].name, "y");
    x = v->dimension[m->turned ? 0 : 1];
    y = v->dimension[m->turned ? 1 : 0];
    m->heights = (struct rc_heights){.nx = (size_t)length(f, x), .ny = (size_t)length(f, y)};
    m->heights.unit = rc_piece_shown(m->unit, v->unit);
    m->heights.name = rc_piece_shown(m->name, v->name);
    m->heights.metres = rc_piece_metres(v->unit);
    if (step_of(f, x, &m->heights.dx, &along_x, err) != RC_OK ||
        step_of(f, y, &m->heights.dy, &along_y, err) != RC_OK)
        return RC_FAIL;
    m->periodic = along_x && along_y;
    return RC_OK;
}

static size_t
netcdf_list(const struct rc_file *file, const struct rc_wish *wish, struct rc_channel *channel,
            size_t most, struct rc_err *err)
{
    char name[sizeof channel->name];
    struct rc_cdf f;
    struct map m;
    size_t n = 0;

    (void)wish;
    if (rc_cdf_open(&f, file, err) == RC_OK) {
        for (size_t k = 0; k < f.variables; k++) {
            const struct rc_cdf_variable *v = &f.variable[k];
            if (!is_map(&f, v))
                continue;
            if (n < most) {
                if (judge_map(&f, v, &m, err) != RC_OK) {
                    n = 0;
                    goto done;
                }
                rc_text_clean(name, sizeof name, v->name.text, v->name.n);
                channel[n] = rc_heights_channel(&m.heights, name);
            }
            n++;
        }
        if (n == 0)
            rc_err_set(err, "none of the file's %zu variables has two dimensions", f.variables);
    }
done:
    rc_cdf_close(&f);
    return n;
}

/* ---- values ---- */

static void
read_values(const struct rc_cdf *f, const struct map *m, double metres, struct rc_grid *g)
{
    const struct rc_cdf_variable *v = m->v;

    for (size_t j = 0; j < g->ny; j++)
        for (size_t i = 0; i < g->nx; i++) {
            double raw = rc_cdf_value(place(f, v, m->turned ? i : j, m->turned ? j : i), v->type);
            g->v[j * g->nx + i] = raw == v->fill ? NAN : (raw * v->factor + v->offset) * metres;
        }
}

static const struct rc_cdf_variable *
pick(const struct rc_cdf *f, size_t index, struct rc_err *err)
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
    const struct rc_cdf_variable *v;
    struct rc_grid *g = NULL;
    struct rc_cdf f;
    struct map m;
    double metres;
    bool good = false;

    if (rc_cdf_open(&f, file, err) != RC_OK || (v = pick(&f, index, err)) == NULL ||
        check_bytes(&f, v, err) != RC_OK || judge_map(&f, v, &m, err) != RC_OK)
        goto done;
    if ((g = rc_heights_new(&m.heights, file, wish, &metres, notes, err)) == NULL ||
        rc_piece_keep(g, "file.channel", v->name, err) != RC_OK ||
        rc_piece_keep(g, "file.title", v->title, err) != RC_OK ||
        (m.periodic && rc_grid_set(g, "periodic", "yes", err) != RC_OK))
        goto done;
    read_values(&f, &m, metres, g);
    good = rc_heights_finite(g, notes, err) == RC_OK;
done:
    rc_cdf_close(&f);
    if (good)
        return g;
    rc_grid_free(g);
    return NULL;
}

static int
netcdf_score(const struct rc_file *file)
{
    return file->size >= 8 && rc_file_holds(file, 0, "CDF", 3) &&
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
