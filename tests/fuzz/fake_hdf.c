/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Replaces hdf.c: returns results that libhdf5 could return for a hostile file, within the guarantees of
 * hdf.h. The bytes of the file determine the results of successive calls; after its end they are 0. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/containers/containers.h"
#include "formats/core/core.h"

struct rc_hdf {
    const struct rc_file *file;
    size_t at;
};

/* clang-format off */
static const char *const words[] = {
    "Root", "Measurement", "Surface", "Path", "{1}", "{2}", "Data/Surface/z", "/Data/Surface/z",
    "LateralCat", "HeightCat", "Pixels", "Meters", "NanoMeters", "Fringes", "m", "um", "z", ""};
/* clang-format on */

static unsigned
byte(struct rc_hdf *h)
{
    return h->at < h->file->size ? h->file->data[h->at++] : 0;
}

static double
number(struct rc_hdf *h)
{
    static const double some[] = {1e-6, 0, -1, 1, 632.8e-9, 1e308, 5e-324};
    unsigned which = byte(h), bytes[2];
    unsigned char raw[8];
    double value;

    if (which < sizeof some / sizeof *some)
        return some[which];
    if (which < 16)
        return which % 2 == 0 ? NAN : INFINITY;
    if (which < 192) {
        bytes[0] = byte(h), bytes[1] = byte(h);
        return (double)(bytes[0] << 8 | bytes[1]) * 1e-9;
    }
    for (size_t k = 0; k < sizeof raw; k++)
        raw[k] = (unsigned char)byte(h);
    memcpy(&value, raw, sizeof value);
    return value;
}

static void
text(struct rc_hdf *h, char *to, size_t size)
{
    unsigned which = byte(h);
    char raw[256];

    if (which < sizeof words / sizeof *words) {
        rc_text_clean(to, size, words[which], strlen(words[which]));
        return;
    }
    for (unsigned k = 0; k < which; k++)
        raw[k] = (char)byte(h);
    rc_text_clean(to, size, raw, which);
}

/* Mostly small numbers, sometimes any number; few large but possible ones, which would only take time. */
static size_t
length(struct rc_hdf *h)
{
    size_t n = byte(h);

    if (n < 240)
        return n + 1; /* a dataset without values does not exist */
    for (int k = 0; k < 8; k++)
        n = n << 8 | byte(h);
    return n == 0 ? 1 : n < (size_t)1 << 32 ? n % 512 + 1 : n;
}

static void
one_set(struct rc_hdf *h, struct rc_hdf_set *set)
{
    text(h, set->path, sizeof set->path);
    set->rows = length(h);
    set->columns = length(h);
}

bool
rc_hdf_is(const struct rc_file *file)
{
    return file->size > 0;
}

struct rc_hdf *
rc_hdf_new(const struct rc_file *file, struct rc_err *err)
{
    struct rc_hdf *h = calloc(1, sizeof *h);

    if (h == NULL || file->size == 0) {
        rc_err_set(err, "no HDF5 file");
        free(h);
        return NULL;
    }
    h->file = file;
    return h;
}

void
rc_hdf_free(struct rc_hdf *h)
{
    free(h);
}

size_t
rc_hdf_sets(struct rc_hdf *h, struct rc_hdf_set *set, size_t most)
{
    size_t n = byte(h);

    n = n < 16 ? n : n * n;
    for (size_t k = 0; k < n && k < most; k++)
        one_set(h, &set[k]);
    return n;
}

bool
rc_hdf_set_at(struct rc_hdf *h, const char *path, struct rc_hdf_set *set)
{
    if (strlen(path) >= sizeof set->path || byte(h) % 8 == 0)
        return false;
    strcpy(set->path, path);
    set->rows = length(h);
    set->columns = length(h);
    return true;
}

enum rc_status
rc_hdf_values(struct rc_hdf *h, const struct rc_hdf_set *set, double *v, struct rc_err *err)
{
    double some[4];

    if (byte(h) % 8 == 0)
        return rc_err_set(err, "the dataset cannot be unpacked");
    for (size_t k = 0; k < 4; k++)
        some[k] = number(h);
    for (size_t k = 0; k < set->rows * set->columns; k++)
        v[k] = some[k % 4];
    return RC_OK;
}

bool
rc_hdf_number(struct rc_hdf *h, const char *path, const char *name, double *value)
{
    (void)path, (void)name;
    if (byte(h) % 4 == 0)
        return false;
    *value = number(h);
    return true;
}

char *
rc_hdf_text(struct rc_hdf *h, const char *path, const char *name, char *to, size_t size)
{
    (void)path, (void)name;
    text(h, to, size);
    return to;
}

bool
rc_hdf_table(struct rc_hdf *h, const char *path, const char *attribute, rc_hdf_take_record *take,
             void *arg)
{
    unsigned rows = byte(h) % 16;

    (void)path, (void)attribute;
    for (unsigned k = 0; k < rows; k++) {
        struct rc_hdf_record record = {.numbers = 0};

        for (size_t i = 0; i < 3; i++)
            text(h, record.text[i], sizeof record.text[i]);
        record.numbers = byte(h) % 5;
        for (size_t i = 0; i < record.numbers; i++)
            record.number[i] = number(h);
        take(arg, &record);
    }
    return rows > 0;
}
