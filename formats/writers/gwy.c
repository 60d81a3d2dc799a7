/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Gwyddion's own format: `GWYP` and one object, a container. An object is its name, NUL, the bytes
 * that follow, and items: name, NUL, a letter for the type, the value. All numbers are
 * little-endian; frame k is the field /k/data, with its title, its keys, and a mask of 1 at missing points.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "encode.h"
#include "formats/export.h"

/* The target of bytes; without a file they are only counted, because an object begins with its size. */
struct sink {
    FILE *out;
    uint64_t n;
    enum rc_status status;
    struct rc_err *err;
};

static void
put(struct sink *s, const void *bytes, size_t n)
{
    s->n += n;
    if (s->out != NULL && s->status == RC_OK)
        s->status = rc_put(s->out, bytes, n, s->err);
}

static void
put_word(struct sink *s, uint32_t value)
{
    unsigned char bytes[4];

    for (size_t k = 0; k < sizeof bytes; k++)
        bytes[k] = (unsigned char)(value >> 8 * k);
    put(s, bytes, sizeof bytes);
}

static void
put_doubles(struct sink *s, const double *v, size_t n)
{
    static const struct rc_code code = {.raw = RC_RAW_F64};

    s->n += 8 * (uint64_t)n;
    if (s->out != NULL && s->status == RC_OK)
        s->status = rc_encode_file(&code, v, n, s->out, s->err);
}

/* ---- items ---- */

static void
item(struct sink *s, const char *name, char type)
{
    put(s, name, strlen(name) + 1);
    put(s, &type, 1);
}

static void
item_count(struct sink *s, const char *name, size_t value)
{
    item(s, name, 'i');
    put_word(s, (uint32_t)value);
}

static void
item_double(struct sink *s, const char *name, double value)
{
    item(s, name, 'd');
    put_doubles(s, &value, 1);
}

static void
item_text(struct sink *s, const char *name, const char *value)
{
    item(s, name, 's');
    put(s, value, strlen(value) + 1);
}

typedef void body(struct sink *s, const void *what);

/* Writes name, size and body; the body runs twice, first to measure its size. */
static void
object(struct sink *s, const char *name, body *write, const void *what)
{
    struct sink measure = {.status = RC_OK};

    write(&measure, what);
    put(s, name, strlen(name) + 1);
    if (measure.n > UINT32_MAX && s->status == RC_OK)
        s->status =
            rc_err_set(s->err, "the frames need more than the 4 GiB that a gwy file allows");
    put_word(s, (uint32_t)measure.n);
    if (s->out == NULL)
        s->n += measure.n;
    else if (s->status == RC_OK)
        write(s, what);
}

static void
item_object(struct sink *s, const char *name, const char *type, body *write, const void *what)
{
    item(s, name, 'o');
    object(s, type, write, what);
}

/* ---- a field ---- */

static void
unit_body(struct sink *s, const void *what)
{
    item_text(s, "unitstr", what);
}

static void
field_head(struct sink *s, const struct rc_grid *g, const char *unit)
{
    double i, j;

    item_count(s, "xres", g->nx);
    item_count(s, "yres", g->ny);
    item_double(s, "xreal", (double)g->nx * g->dx);
    item_double(s, "yreal", (double)g->ny * g->dy);
    if (strcmp(rc_grid_dunit(g), "m") != 0) { /* the position of wave number 0 */
        rc_grid_origin(g, &i, &j);
        item_double(s, "xoff", -(i + 0.5) * g->dx);
        item_double(s, "yoff", -(j + 0.5) * g->dy);
    }
    item_object(s, "si_unit_xy", "GwySIUnit", unit_body, rc_grid_dunit(g));
    item_object(s, "si_unit_z", "GwySIUnit", unit_body, unit);
    item(s, "data", 'D');
    put_word(s, (uint32_t)(g->nx * g->ny));
}

/* A missing point needs a number under the mask: the middle of the range of measured values. */
static void
data_body(struct sink *s, const void *what)
{
    const struct rc_grid *g = what;
    struct rc_range range;
    double row[256];
    size_t n = g->nx * g->ny, now;

    field_head(s, g, g->unit);
    if (s->out == NULL || s->status != RC_OK) {
        s->n += 8 * (uint64_t)n;
        return;
    }
    s->status = rc_range_of(g, &range, s->err);
    for (size_t k = 0; k < n; k += now) {
        now = n - k < 256 ? n - k : 256;
        for (size_t i = 0; i < now; i++)
            row[i] = isnan(g->v[k + i]) ? 0.5 * range.min + 0.5 * range.max : g->v[k + i];
        put_doubles(s, row, now);
    }
}

static void
mask_body(struct sink *s, const void *what)
{
    const struct rc_grid *g = what;
    double row[256];
    size_t n = g->nx * g->ny, now;

    field_head(s, g, "");
    for (size_t k = 0; k < n; k += now) {
        now = n - k < 256 ? n - k : 256;
        for (size_t i = 0; i < now; i++)
            row[i] = isnan(g->v[k + i]) ? 1 : 0;
        put_doubles(s, row, now);
    }
}

static void
meta_body(struct sink *s, const void *what)
{
    const struct rc_grid *g = what;

    for (size_t k = 0; k < g->keys; k++)
        item_text(s, g->key[k].name, g->key[k].value);
}

/* ---- the file ---- */

struct frames {
    struct rc_grid *const *frame;
    size_t n;
};

static bool
has_missing(const struct rc_grid *g)
{
    for (size_t k = 0; k < g->nx * g->ny; k++)
        if (isnan(g->v[k]))
            return true;
    return false;
}

static void
container_body(struct sink *s, const void *what)
{
    const struct frames *f = what;
    char name[64], label[RC_LABEL];

    for (size_t k = 0; k < f->n; k++) {
        const struct rc_grid *g = f->frame[k];

        snprintf(name, sizeof name, "/%zu/data", k);
        item_object(s, name, "GwyDataField", data_body, g);
        snprintf(name, sizeof name, "/%zu/data/title", k);
        item_text(s, name, rc_export_label(label, f->frame, f->n, k, true));
        if (has_missing(g)) {
            snprintf(name, sizeof name, "/%zu/mask", k);
            item_object(s, name, "GwyDataField", mask_body, g);
        }
        if (g->keys > 0) {
            snprintf(name, sizeof name, "/%zu/meta", k);
            item_object(s, name, "GwyContainer", meta_body, g);
        }
    }
}

static enum rc_status
gwy_write(FILE *out, struct rc_grid *const *frame, size_t frames, const struct rc_export_wish *wish,
          struct rc_err *err)
{
    struct frames all = {frame, frames};
    struct sink s = {.out = out, .status = RC_OK, .err = err};

    (void)wish;
    for (size_t k = 0; k < frames; k++)
        if (frame[k]->nx * frame[k]->ny > INT32_MAX)
            return rc_err_set(err, "%zu x %zu nodes are more than a gwy file can count",
                              frame[k]->nx, frame[k]->ny);
    put(&s, "GWYP", 4);
    object(&s, "GwyContainer", container_body, &all);
    return s.status;
}

const struct rc_export rc_export_gwy = {
    .name = "gwy",
    .suffixes = ".gwy",
    .summary = "Gwyddion, a channel for each frame, missing points under a mask",
    .several = true,
    .types = RC_TYPE_F64,
    .write = gwy_write,
};
