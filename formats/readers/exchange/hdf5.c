/*
 * HDF5: every dataset of numbers with two dimensions is a channel, rows by columns, row 0 first.
 * The attributes dx and dy (m) and unit or units, as rc-export writes them, say what it is;
 * _FillValue is a missing point. Without them the user has to.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/containers/containers.h"
#include "formats/format.h"

enum {
    SETS_MOST = 256
};

struct facts {
    struct rc_heights heights;
    char unit[RC_SHOWN];
};

static void
read_facts(struct rc_hdf *h, const struct rc_hdf_set *set, struct facts *f)
{
    f->heights = (struct rc_heights){.nx = set->columns,
                                     .ny = set->rows,
                                     .dx = NAN,
                                     .dy = NAN,
                                     .unit = f->unit,
                                     .name = set->path};
    rc_hdf_number(h, set->path, "dx", &f->heights.dx);
    rc_hdf_number(h, set->path, "dy", &f->heights.dy);
    rc_hdf_text(h, set->path, "unit", f->unit, sizeof f->unit);
    if (f->unit[0] == '\0')
        rc_hdf_text(h, set->path, "units", f->unit, sizeof f->unit);
    f->heights.metres = rc_word_metres(f->unit);
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
        struct facts f;

        read_facts(h, &set[k], &f);
        channel[k] = rc_heights_channel(&f.heights, set[k].path);
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
    read_facts(h, &set[index], &f);
    if ((g = rc_heights_new(&f.heights, file, wish, &metres, notes, err)) == NULL ||
        rc_word_keep(g, "file.channel", set[index].path, err) != RC_OK ||
        rc_hdf_values(h, &set[index], g->v, err) != RC_OK)
        goto done;
    rc_hdf_number(h, set[index].path, "_FillValue", &fill);
    for (size_t k = 0; (!isnan(fill) || metres != 1) && k < g->nx * g->ny; k++)
        g->v[k] = g->v[k] == fill ? NAN : g->v[k] * metres;
    good = rc_heights_finite(g, notes, err) == RC_OK;
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
    return rc_hdf_is(file) ? 60 : 0; /* files of instruments have other readers */
}

const struct rc_format rc_format_hdf5 = {
    .name = "hdf5",
    .suffixes = ".h5 .hdf5",
    .summary = "HDF5: datasets of two dimensions",
    .score = hdf5_score,
    .list = list_channels,
    .read = read_values,
    .sandboxed = true,
};
