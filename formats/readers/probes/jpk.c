/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * JPK image scans (.jpk, .jpk-qi-image): a TIFF whose first page is a thumbnail with the data of the scan in
 * private tags. Each other page is one channel.
 *
 * A channel has several slots, each a scale for the raw numbers: the one that the file names as
 * default is used. The first line of a scan is the lowest, unless the page says that the grid is
 * reflected.
 */
#include <string.h>

#include "formats/containers/containers.h"
#include "formats/format.h"

enum {
    START_DATE = 0x8003,
    COMMENT = 0x8005,
    SAMPLE = 0x8007,
    ACCOUNT = 0x8009,
    PROGRAM = 0x8001,
    U_LENGTH = 0x8042,
    V_LENGTH = 0x8043,
    REFLECT = 0x8045,
    CHANNEL = 0x8050,
    RETRACE = 0x8051,
    FANCY_NAME = 0x8052,
    SLOTS = 0x8080,
    DEFAULT_SLOT = 0x8081,
    FIRST_SLOT = 0x8090,
    SLOT_STRIDE = 0x30,
    /* within a slot */
    SLOT_NAME = 0x00,
    UNIT = 0x12,
    SCALING = 0x13,
    MULTIPLY = 0x14,
    OFFSET = 0x15,
    SLOTS_MOST = 64,
    TYPE_ASCII = 2,
    TYPE_DOUBLE = 12,
};

struct scan {
    struct rc_tiff *tiff;
    size_t pages;
    double width, height; /* m */
};

struct channel {
    char name[64], unit[16];
    double multiply, offset;
    bool linear, reflected;
    struct rc_tiff_shape shape;
};

static void
scan_close(void *opened)
{
    rc_tiff_free(((struct scan *)opened)->tiff);
}

static enum rc_status
scan_open(struct scan *s, const struct rc_file *file, struct rc_err *err)
{
    if ((s->tiff = rc_tiff_new(file, err)) == NULL)
        return RC_FAIL;
    if (!rc_tiff_number(s->tiff, U_LENGTH, &s->width) ||
        !rc_tiff_number(s->tiff, V_LENGTH, &s->height))
        return rc_err_set(err, "a TIFF, but no JPK scan: its first page gives no size of a grid "
                               "(tags 0x8042 and 0x8043)");
    return rc_tiff_pages(s->tiff, &s->pages, err);
}

/* ---- a page ---- */

static bool
find_slot(struct rc_tiff *t, uint32_t *slot)
{
    char wanted[64], name[64];
    double n = 0;

    rc_tiff_text(t, DEFAULT_SLOT, wanted, sizeof wanted);
    rc_tiff_number(t, SLOTS, &n);
    for (uint32_t k = 0; k < SLOTS_MOST && (double)k < n && wanted[0] != '\0'; k++) {
        *slot = FIRST_SLOT + SLOT_STRIDE * k;
        if (strcmp(rc_tiff_text(t, *slot + SLOT_NAME, name, sizeof name), wanted) == 0)
            return true;
    }
    return false;
}

static void
name_channel(struct rc_tiff *t, struct channel *c)
{
    double retrace = 0;
    size_t n;

    rc_tiff_text(t, FANCY_NAME, c->name, sizeof c->name - 12);
    if (c->name[0] == '\0')
        rc_tiff_text(t, CHANNEL, c->name, sizeof c->name - 12);
    rc_tiff_number(t, RETRACE, &retrace);
    n = strlen(c->name);
    if (retrace == 0)
        return;
    if (n > 0 && c->name[n - 1] == ')')
        strcpy(c->name + n - 1, ", retrace)");
    else
        strcat(c->name, " (retrace)");
}

/* True if the present page of the file is a channel; the thumbnail has no slot of pixels. */
static bool
read_channel(struct rc_tiff *t, struct channel *c)
{
    char scaling[32];
    double reflect = 0;
    uint32_t slot;

    *c = (struct channel){.multiply = 1};
    name_channel(t, c);
    if (c->name[0] == '\0' || !find_slot(t, &slot) || rc_tiff_shape(t, &c->shape, NULL) != RC_OK ||
        c->shape.samples != 1 || c->shape.bits < 16)
        return false;
    rc_tiff_number(t, REFLECT, &reflect);
    c->reflected = reflect != 0;
    rc_tiff_text(t, slot + UNIT, c->unit, sizeof c->unit);
    rc_tiff_text(t, slot + SCALING, scaling, sizeof scaling);
    c->linear =
        strcmp(scaling, "NullScaling") == 0 || (strcmp(scaling, "LinearScaling") == 0 &&
                                                rc_tiff_number(t, slot + MULTIPLY, &c->multiply) &&
                                                rc_tiff_number(t, slot + OFFSET, &c->offset));
    return true;
}

/* ---- the file ---- */

static enum rc_status
fill_channel(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    struct rc_tiff *t = ((struct scan *)map->opened)->tiff;
    struct channel c;

    (void)file;
    if (!rc_tiff_page(t, map->more) || !read_channel(t, &c))
        return rc_err_set(err, "page %zu cannot be read again", map->more);
    if (!c.linear)
        return rc_err_set(
            err, "channel '%s' has no linear scale with a multiplier and an offset: it is not read",
            c.name);
    if (rc_tiff_values(t, &c.shape, v, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < map->nx * map->ny; k++)
        v[k] = v[k] * c.multiply + c.offset;
    return RC_OK;
}

static void
add_channel(const struct scan *s, const struct channel *c, size_t page, struct rc_maps *maps)
{
    struct rc_map *map = rc_maps_add(maps, rc_piece_of(c->name));

    map->nx = c->shape.nx;
    map->ny = c->shape.ny;
    map->dx = s->width / (double)c->shape.nx;
    map->dy = s->height / (double)c->shape.ny;
    map->bottom_first = !c->reflected;
    map->fill = fill_channel;
    map->more = page;
    rc_map_unit(map, rc_piece_of(c->unit));
}

static enum rc_status
find_channels(const struct scan *s, struct rc_maps *maps, struct rc_err *err)
{
    static const struct {
        uint32_t tag;
        const char *key;
    } words[] = {{START_DATE, "file.date"},
                 {COMMENT, "file.comment"},
                 {SAMPLE, "file.sample"},
                 {ACCOUNT, "file.creator"},
                 {PROGRAM, "file.version"}};
    struct channel c;
    char text[512];

    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        if (strcmp(rc_tiff_text(s->tiff, words[k].tag, text, sizeof text), "<empty>") != 0)
            rc_maps_key(maps, words[k].key, rc_piece_of(text));
    for (size_t page = 1; page < s->pages; page++)
        if (rc_tiff_page(s->tiff, page) && read_channel(s->tiff, &c))
            add_channel(s, &c, page, maps);
    return maps->n > 0 ? RC_OK : rc_err_set(err, "a JPK file without a channel");
}

static enum rc_status
jpk_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct scan *s;

    if (rc_file_holds(file, 0, "PK", 2))
        return rc_err_set(err, "force curves of JPK: only image scans are read");
    s = rc_maps_open(maps, sizeof *s, scan_close, err);
    return s != NULL && scan_open(s, file, err) == RC_OK ? find_channels(s, maps, err) : RC_FAIL;
}

/* ---- the entry in formats.list ---- */

/* Force curves are a separate ZIP archive, recognised by this member. */
static bool
is_force(const struct rc_file *file)
{
    RC_OWN(rc_zip_read, archive) = rc_zip_read_new(file, NULL);
    size_t member;
    bool found =
        archive != NULL && rc_zip_read_find(archive, "header.properties", &member, NULL) == RC_OK;

    return found;
}

static int
jpk_score(const struct rc_file *file)
{
    if (is_force(file))
        return 30; /* so that the refusal has a reason */
    return rc_tiff_is(file) && rc_tiff_hints(file, U_LENGTH, TYPE_DOUBLE) &&
                   rc_tiff_hints(file, DEFAULT_SLOT, TYPE_ASCII)
               ? 90
               : 0;
}

const struct rc_format rc_format_jpk = {
    .name = "jpk",
    .suffixes = ".jpk .jpk-qi-image",
    .summary = "JPK (Bruker) image scans",
    .score = jpk_score,
    .find = jpk_find,
    .sandboxed = true,
    .copies = true,
};
