/*
 * HDF5: every dataset of numbers with two dimensions is a channel, rows by columns, row 0 first.
 * The attributes dx and dy (m) and unit or units, as rc-export writes them, say what it is;
 * _FillValue is a missing point. Without them the user has to.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/sandbox/sandbox.h"
#include "hdf.h"
#include "formats/core/core.h"

enum {
    SETS_MOST = 256
};

struct facts {
    double dx, dy, metres; /* NAN when not told */
    char unit[RC_SHOWN];
};

static struct facts
facts_of(struct rc_hdf *h, const char *path)
{
    struct facts f = {.dx = NAN, .dy = NAN, .metres = NAN};

    rc_hdf_number(h, path, "dx", &f.dx);
    rc_hdf_number(h, path, "dy", &f.dy);
    rc_hdf_text(h, path, "unit", f.unit, sizeof f.unit);
    if (f.unit[0] == '\0')
        rc_hdf_text(h, path, "units", f.unit, sizeof f.unit);
    if (!rc_length_unit(f.unit, strlen(f.unit), &f.metres))
        f.metres = NAN;
    return f;
}

/* The datasets of a file, which the caller frees; NULL with the reason. */
static struct rc_hdf_set *
find_sets(struct rc_hdf *h, size_t *n, struct rc_err *err)
{
    struct rc_hdf_set *set = calloc(SETS_MOST, sizeof *set);

    if (set == NULL) {
        rc_err_set(err, "out of memory for %d datasets", SETS_MOST);
        return NULL;
    }
    *n = rc_hdf_sets(h, set, SETS_MOST);
    if (*n > 0)
        return set;
    rc_err_set(err, "the file has no dataset of numbers with two dimensions");
    free(set);
    return NULL;
}

static size_t
list_channels(const struct rc_file *file, const struct rc_wish *wish, struct rc_channel *channel,
              size_t most, struct rc_err *err)
{
    struct rc_hdf *h = rc_hdf_new(file, err);
    struct rc_hdf_set *set = NULL;
    size_t n = 0;

    (void)wish;
    if (h == NULL || (set = find_sets(h, &n, err)) == NULL)
        goto done;
    for (size_t k = 0; k < n && k < most && k < SETS_MOST; k++) {
        struct facts f = facts_of(h, set[k].path);
        channel[k] =
            (struct rc_channel){.nx = set[k].columns, .ny = set[k].rows, .dx = f.dx, .dy = f.dy};
        rc_text_clean(channel[k].name, sizeof channel->name, set[k].path, strlen(set[k].path));
        rc_text_clean(channel[k].unit, sizeof channel->unit, isnan(f.metres) ? f.unit : "m",
                      isnan(f.metres) ? strlen(f.unit) : 1);
    }
done:
    free(set);
    rc_hdf_free(h);
    return n < SETS_MOST ? n : SETS_MOST;
}

static struct rc_grid *
read_values(const struct rc_file *file, const struct rc_wish *wish, size_t index,
            struct rc_notes *notes, struct rc_err *err)
{
    struct rc_hdf *h = rc_hdf_new(file, err);
    struct rc_hdf_set *set = NULL;
    struct rc_grid *g = NULL;
    struct rc_shape shape;
    struct facts f;
    size_t n = 0;
    double fill = NAN, metres;
    bool good = false;

    if (h == NULL || (set = find_sets(h, &n, err)) == NULL)
        goto done;
    if (index >= n || index >= SETS_MOST) {
        rc_err_set(err, "the file has %zu datasets of two dimensions, not %zu", n, index + 1);
        goto done;
    }
    f = facts_of(h, set[index].path);
    shape = (struct rc_shape){.nx = set[index].columns, .ny = set[index].rows};
    if (rc_map_fits(file, shape.nx, shape.ny, err) != RC_OK ||
        rc_spacing(wish, f.dx, f.dy, &shape, notes, err) != RC_OK ||
        rc_height_unit(wish, f.metres, f.unit, &metres, notes, err) != RC_OK ||
        (g = rc_grid_new(&shape, "height", "m", err)) == NULL ||
        rc_text_keep(g, "file.channel", set[index].path, strlen(set[index].path), err) != RC_OK ||
        rc_hdf_values(h, &set[index], g->v, err) != RC_OK)
        goto done;
    rc_hdf_number(h, set[index].path, "_FillValue", &fill);
    for (size_t k = 0; (!isnan(fill) || metres != 1) && k < shape.nx * shape.ny; k++)
        g->v[k] = g->v[k] == fill ? NAN : g->v[k] * metres;
    good = rc_values_finite(g, err) == RC_OK;
done:
    free(set);
    rc_hdf_free(h);
    if (good)
        return g;
    rc_grid_free(g);
    return NULL;
}

/* ---- the entry in formats.list ---- */

static int
hdf5_score(const struct rc_file *file)
{
    return rc_hdf_is(file) ? 60 : 0; /* instruments have formats of their own in it */
}

RC_FORMAT_SANDBOXED(hdf5)

const struct rc_format rc_format_hdf5 = {
    .name = "hdf5",
    .suffixes = ".h5 .hdf5",
    .summary = "HDF5: datasets of two dimensions",
    .score = hdf5_score,
    .list = hdf5_list,
    .read = hdf5_read,
};
