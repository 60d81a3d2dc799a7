/*
 * JPK image scans (.jpk, .jpk-qi-image): a TIFF whose first page is a thumbnail with the data of
 * the scan in private tags, and whose other pages are one channel each.
 *
 * A channel has several slots, each a scale for the raw numbers: the one that the file names as
 * default is used. The first line of a scan is the lowest, unless the page says that the grid is
 * reflected.
 */
#include <math.h>
#include <string.h>

#include "formats/containers/containers.h"
#include "formats/format.h"
#include "formats/sandbox/sandbox.h"

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
    KEYS = 6,
};

struct scan {
    struct rc_tiff *tiff;
    size_t pages;
    double width, height; /* m */
    char date[64], comment[512], sample[128], account[128], program[64];
};

struct channel {
    char name[64], unit[16];
    double multiply, offset;
    bool linear, reflected;
    struct rc_tiff_shape shape;
};

static enum rc_status
scan_open(struct scan *s, const struct rc_file *file, struct rc_err *err)
{
    *s = (struct scan){.tiff = rc_tiff_new(file, err)};
    if (s->tiff == NULL)
        return RC_FAIL;
    if (!rc_tiff_number(s->tiff, U_LENGTH, &s->width) ||
        !rc_tiff_number(s->tiff, V_LENGTH, &s->height))
        return rc_err_set(err, "a TIFF, but no JPK scan: its first page gives no size of a grid "
                               "(tags 0x8042 and 0x8043)");
    if (rc_tiff_pages(s->tiff, &s->pages, err) != RC_OK)
        return RC_FAIL;
    rc_tiff_text(s->tiff, START_DATE, s->date, sizeof s->date);
    rc_tiff_text(s->tiff, COMMENT, s->comment, sizeof s->comment);
    rc_tiff_text(s->tiff, SAMPLE, s->sample, sizeof s->sample);
    rc_tiff_text(s->tiff, ACCOUNT, s->account, sizeof s->account);
    rc_tiff_text(s->tiff, PROGRAM, s->program, sizeof s->program);
    return RC_OK;
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

static struct rc_heights
heights_of(const struct scan *s, const struct channel *c)
{
    return (struct rc_heights){.nx = c->shape.nx,
                               .ny = c->shape.ny,
                               .dx = s->width / (double)c->shape.nx,
                               .dy = s->height / (double)c->shape.ny,
                               .metres = rc_word_metres(c->unit),
                               .unit = c->unit,
                               .name = c->name};
}

static size_t
list_channels(const struct rc_file *file, const struct rc_wish *wish, struct rc_channel *channel,
              size_t most, struct rc_err *err)
{
    struct channel c;
    struct scan s;
    size_t n = 0;

    (void)wish;
    if (scan_open(&s, file, err) == RC_OK) {
        for (size_t page = 1; page < s.pages; page++) {
            if (!rc_tiff_page(s.tiff, page) || !read_channel(s.tiff, &c))
                continue;
            if (n < most) {
                struct rc_heights h = heights_of(&s, &c);
                channel[n] = rc_heights_channel(&h, c.name);
            }
            n++;
        }
        if (n == 0)
            rc_err_set(err, "a JPK file without a channel");
    }
    rc_tiff_free(s.tiff);
    return n;
}

/* ---- values ---- */

/* Goes to the page of channel `index`. */
static enum rc_status
go_to(struct scan *s, size_t index, struct channel *c, struct rc_err *err)
{
    size_t n = 0;

    for (size_t page = 1; page < s->pages; page++)
        if (rc_tiff_page(s->tiff, page) && read_channel(s->tiff, c) && n++ == index)
            return RC_OK;
    return rc_err_set(err, "the file has %zu channels, not %zu", n, index + 1);
}

static enum rc_status
keep_words(const struct scan *s, const struct channel *c, struct rc_grid *g, struct rc_err *err)
{
    const struct {
        const char *key, *text;
    } words[KEYS] = {
        {"file.date", s->date},       {"file.comment", s->comment}, {"file.sample", s->sample},
        {"file.creator", s->account}, {"file.version", s->program}, {"file.channel", c->name},
    };

    for (size_t k = 0; k < KEYS; k++)
        if (strcmp(words[k].text, "<empty>") != 0 &&
            rc_word_keep(g, words[k].key, words[k].text, err) != RC_OK)
            return RC_FAIL;
    return RC_OK;
}

static struct rc_grid *
read_values(const struct rc_file *file, const struct rc_wish *wish, size_t index,
            struct rc_notes *notes, struct rc_err *err)
{
    struct rc_grid *g = NULL;
    struct rc_heights h;
    struct channel c;
    struct scan s;
    double metres;
    bool good = false;

    if (scan_open(&s, file, err) != RC_OK || go_to(&s, index, &c, err) != RC_OK)
        goto done;
    if (!c.linear) {
        rc_err_set(
            err, "channel '%s' has no linear scale with a multiplier and an offset: it is not read",
            c.name);
        goto done;
    }
    h = heights_of(&s, &c);
    if ((g = rc_heights_new(&h, file, wish, &metres, notes, err)) == NULL ||
        keep_words(&s, &c, g, err) != RC_OK || rc_tiff_values(s.tiff, &c.shape, g->v, err) != RC_OK)
        goto done;
    for (size_t k = 0; k < g->nx * g->ny; k++)
        g->v[k] = (g->v[k] * c.multiply + c.offset) * metres;
    if (!c.reflected)
        rc_heights_flip(g);
    good = rc_heights_finite(g, notes, err) == RC_OK;
done:
    rc_tiff_free(s.tiff);
    if (good)
        return g;
    rc_grid_free(g);
    return NULL;
}

/* ---- the entry in formats.list ---- */

/* Force curves are a separate ZIP archive, recognised by this member. */
static bool
is_force(const struct rc_file *file)
{
    struct rc_zip_read *archive = rc_zip_read_new(file, NULL);
    size_t member;
    bool found =
        archive != NULL && rc_zip_read_find(archive, "header.properties", &member, NULL) == RC_OK;

    rc_zip_read_free(archive);
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

static size_t
jpk_list(const struct rc_file *file, const struct rc_wish *wish, struct rc_channel *channel,
         size_t most, struct rc_err *err)
{
    if (is_force(file)) {
        rc_err_set(err, "force curves of JPK: only image scans are read");
        return 0;
    }
    return rc_sandbox_list(NULL, list_channels, file, wish, channel, most, err);
}

static struct rc_grid *
jpk_read(const struct rc_file *file, const struct rc_wish *wish, size_t index,
         struct rc_notes *notes, struct rc_err *err)
{
    if (is_force(file)) {
        rc_err_set(err, "force curves of JPK: only image scans are read");
        return NULL;
    }
    return rc_sandbox_read(NULL, read_values, file, wish, index, notes, err);
}

const struct rc_format rc_format_jpk = {
    .name = "jpk",
    .suffixes = ".jpk .jpk-qi-image",
    .summary = "JPK (Bruker) image scans",
    .score = jpk_score,
    .list = jpk_list,
    .read = jpk_read,
};
