/*
 * A matrix of heights as text, with or without a header; below it others, each with its own header,
 * are further channels. Headers that are understood:
 *
 *     # Channel: Topography           Gwyddion. In other languages the four lines are known by
 *     # Width: 10.00 µm               what follows the colons; a size is that of the whole map, so
 *     # Height: 10.00 µm              that the spacing is size over count
 *     # Value units: m
 *
 *     h=305 w=75                      digital holography (Koala)
 *     pixel size=3.69862e-007 m
 *     data unit=rad
 *     height conversion factor (-> m)=2.91818e-008
 *
 *     # x-pixels = 4                  SPIP, lengths in nm, heights in z-unit or Bit2nm nm; and
 *     # x-length = 640.0              attocube's Daisy, which says x-unit, y-unit and z-unit
 *     # z-unit = nm
 *
 *     File Format = ASCII             NT-MDT's Nova, after which all lines are of the header
 *     NX = 4
 *     Scale X = 0.5                   spacing, in Unit X
 *     Unit Data = nm
 *     Start of Data :
 *
 *     WSxM ASCII Matrix file          WSxM, after which all lines up to the numbers are of the header
 *     X Amplitude: 500.0 nm
 *     Z Amplitude: 12.3 nm            of which only the unit counts
 *
 *     \Scan Size: 10 10 um            NanoScope export of one image
 *     \Exported image units: nm
 *
 * Two columns whose first rises, and three columns of which two run through a raster, are taken
 * for profiles and lists of points and refused, unless a header says that they are a matrix.
 */
#include <math.h>
#include <string.h>

#include "ascii_head.h"
#include "formats/format.h"

/* One of the images of a file. */
struct image {
    struct rc_ascii_head head;
    struct rc_lines lines; /* its numbers, and comments between them */
};

/* The next image from *rest on, which then stands at the header of the one after it. A header that
 * stands below numbers begins another image; other comments there do not. */
static void
next_image(struct rc_lines *rest, struct image *image)
{
    struct rc_lines ahead;
    const char *line;
    size_t n;
    bool rows = false;

    rc_ascii_read_head(&image->head, rest);
    image->lines = *rest;
    for (ahead = *rest; rc_lines_next(&ahead, &line, &n); *rest = ahead) {
        struct rc_ascii_head head;

        rc_trim(&line, &n);
        if (n > 0 && (*line == '#' || *line == '%')) {
            ahead = *rest;
            rc_ascii_read_head(&head, &ahead);
            if (rows && head.known) {
                image->lines.end = rest->at;
                return;
            }
        }
        rows = rows || (n > 0 && *line != '#' && *line != '%');
    }
    rest->at = rest->end;
}

static enum rc_status
find_image(const struct rc_file *file, size_t index, struct image *image, size_t *n,
           struct rc_err *err)
{
    struct rc_lines rest = rc_piece_lines(rc_file_piece(file));
    struct image other;

    image->head = (struct rc_ascii_head){0};
    *n = 0;
    if (rc_file_is_utf16(file))
        return rc_err_set(err, "the text is UTF-16: convert it first (iconv -f UTF-16 -t UTF-8)");
    if (rc_file_holds(file, 0, "\xef\xbb\xbf", 3))
        rest.at += 3; /* the byte order mark of UTF-8 */
    do
        next_image(&rest, *n == index ? image : &other);
    while (++*n, rest.at < rest.end);
    if (index < *n)
        return RC_OK;
    if (*n == 1)
        return rc_err_set(err, "a text matrix has one channel, not %zu", index + 1);
    return rc_err_set(err, "there is no channel %zu: the file has %zu", index + 1, *n);
}

/* Image `index` of the *n in the file. */
static enum rc_status
ascii_open(const struct rc_file *file, const struct rc_wish *wish, size_t index,
           struct rc_ascii_head *h, struct rc_number_table *table, size_t *n, struct rc_err *err)
{
    struct rc_wish said = *wish;
    struct image image;

    *h = (struct rc_ascii_head){0};
    if (find_image(file, index, &image, n, err) != RC_OK)
        return RC_FAIL;
    *h = image.head;
    if (said.separator == NULL && h->separator[0] != '\0')
        said.separator = h->separator;
    if (rc_number_table_open(table, &image.lines, &said, err) != RC_OK)
        return RC_FAIL;
    if ((h->nx != 0 && h->nx != table->columns) || (h->ny != 0 && h->ny != table->rows))
        return rc_err_set(err,
                          "the header promises %zu columns and %zu rows, the file has %zu and "
                          "%zu",
                          h->nx == 0 ? table->columns : h->nx, h->ny == 0 ? table->rows : h->ny,
                          table->columns, table->rows);
    if (table->columns == 1)
        return rc_err_set(err,
                          "%zu numbers in one column: that is a profile or a list, no matrix "
                          "(--format profile takes them for heights)",
                          table->rows);
    return RC_OK;
}

/* Spacing as the header has it, NAN where it does not say. */
static void
spacing(const struct rc_ascii_head *h, const struct rc_number_table *table, double *dx, double *dy)
{
    *dx = !isnan(h->step_x)  ? h->step_x
          : !isnan(h->pixel) ? h->pixel
                             : h->width / (double)table->columns;
    *dy = !isnan(h->step_y)  ? h->step_y
          : !isnan(h->pixel) ? h->pixel
                             : h->height / (double)table->rows;
    if (isnan(*dy))
        *dy = *dx;
}

/* Whether two columns run through a raster: column `slow` stays the same while `fast` goes on in
 * one direction, then makes a step, always in one direction too. Four points of one row are a
 * raster, fewer could be anything. */
static bool
is_raster(const double *v, size_t rows, size_t slow, size_t fast)
{
    double slow_way = 0, fast_way = 0;
    bool rests = false;

    for (size_t j = 1; j < rows; j++) {
        double ds = v[3 * j + slow] - v[3 * j - 3 + slow];
        double df = v[3 * j + fast] - v[3 * j - 3 + fast];
        double *way = ds == 0 ? &fast_way : &slow_way, d = ds == 0 ? df : ds;

        if (isnan(d) || d == 0 || d * *way < 0)
            return false;
        *way = d > 0 ? 1 : -1;
        rests = rests || ds == 0;
    }
    return rests && (slow_way != 0 || rows > 3);
}

static bool
is_rising(const double *v, size_t rows)
{
    for (size_t j = 1; j < rows; j++)
        if (!(v[2 * j] > v[2 * j - 2]))
            return false;
    return rows > 2;
}

static enum rc_status
refuse_coordinates(const struct rc_ascii_head *h, const struct rc_number_table *table,
                   const double *v, struct rc_err *err)
{
    if (h->nx != 0 || !isnan(h->width) || !isnan(h->pixel) || !isnan(h->step_x))
        return RC_OK;
    if (table->columns == 2 && is_rising(v, table->rows))
        return rc_err_set(err, "two columns, of which the first rises: that is a profile (x, z), "
                               "no matrix; a header with a width would say otherwise");
    if (table->columns == 3 && (is_raster(v, table->rows, 0, 1) || is_raster(v, table->rows, 1, 0)))
        return rc_err_set(err, "three columns, of which two run through a raster: that is a list "
                               "of points (x, y, z), no matrix; a header with a width would say "
                               "otherwise");
    return RC_OK;
}

/* The factor from the numbers to SI units; `other` is what they are when they are no heights. */
static enum rc_status
get_scales(const struct rc_ascii_head *h, double dx, double dy, const struct rc_map *other,
           const struct rc_wish *wish, struct rc_shape *shape, double *si, struct rc_notes *notes,
           struct rc_err *err)
{
    if (rc_spacing(wish, dx, dy, shape, notes, err) == RC_OK) {
        *si = other == NULL ? NAN : other->si;
        return other != NULL ? RC_OK : rc_height_unit(wish, h->z, h->unit, si, notes, err);
    }
    if (isnan(dx) && h->unit[0] == '\0')
        rc_lacks_unit(wish, h->z, err);
    return RC_FAIL;
}

/* What an image among others shows that has a unit of its own, which is no length. */
static bool
is_other(const struct rc_ascii_head *h, size_t images, const struct rc_wish *wish,
         struct rc_map *other)
{
    *other = (struct rc_map){0};
    if (images == 1 || !isnan(wish->z_unit) || !isnan(h->z) || h->unit[0] == '\0')
        return false;
    rc_text_clean(other->name, sizeof other->name, h->channel.text, h->channel.n);
    if (other->name[0] == '\0')
        strcpy(other->name, "values");
    rc_map_unit(other, h->unit, strlen(h->unit));
    return true;
}

static struct rc_grid *
read_matrix(const struct rc_ascii_head *h, size_t images, struct rc_number_table *table,
            const struct rc_wish *wish, struct rc_notes *notes, struct rc_err *err)
{
    struct rc_shape shape = {.nx = table->columns, .ny = table->rows, .dx = 1, .dy = 1};
    struct rc_map map, *other = is_other(h, images, wish, &map) ? &map : NULL;
    struct rc_grid *g = NULL;
    double dx, dy, si;
    size_t n;

    if (rc_number_table_size(table, &n, err) != RC_OK ||
        (g = rc_grid_new(&shape, other == NULL ? "height" : map.name,
                         other == NULL ? "m" : map.unit, err)) == NULL)
        return NULL;
    spacing(h, table, &dx, &dy);
    if (rc_number_table_read(table, g->v, err) != RC_OK ||
        refuse_coordinates(h, table, g->v, err) != RC_OK ||
        get_scales(h, dx, dy, other, wish, &shape, &si, notes, err) != RC_OK ||
        rc_piece_keep(g, "file.channel", h->channel, err) != RC_OK) {
        rc_grid_free(g);
        return NULL;
    }
    g->dx = shape.dx;
    g->dy = shape.dy;
    for (size_t k = 0; k < n; k++)
        g->v[k] *= si;
    if (rc_heights_finite(g, notes, err) == RC_OK)
        return g;
    rc_grid_free(g);
    return NULL;
}

/* ---- the entry in formats.list ---- */

static int
ascii_score(const struct rc_file *file)
{
    struct rc_number_table table;
    struct rc_ascii_head h;
    unsigned char c;
    size_t images;

    if (rc_file_is_utf16(file))
        return 2;
    if (!rc_file_is_text(file))
        return 0;
    if (ascii_open(file, &rc_no_wish, 0, &h, &table, &images, NULL) == RC_OK)
        return h.known ? 90 : 40;
    /* A low score for what begins like numbers, so that the refusal says what is wrong with them. */
    c = file->data[0];
    return h.known ? 30 : (c >= '0' && c <= '9') || c == '-' || c == ' ' ? 5 : 0;
}

static size_t
ascii_list(const struct rc_file *file, const struct rc_wish *wish, struct rc_channel *channel,
           size_t most, struct rc_err *err)
{
    size_t images = 1;

    for (size_t k = 0; k < images && k < (most == 0 ? 1 : most); k++) {
        struct rc_channel c = {.name = "height"};
        struct rc_number_table table;
        struct rc_ascii_head h;
        struct rc_map other;

        if (ascii_open(file, wish, k, &h, &table, &images, err) != RC_OK)
            return 0;
        if (h.channel.n > 0)
            rc_text_clean(c.name, sizeof c.name, h.channel.text, h.channel.n);
        strcpy(c.unit, isnan(h.z) ? h.unit : "m");
        if (is_other(&h, images, &rc_no_wish, &other))
            strcpy(c.unit, other.unit);
        c.nx = table.columns;
        c.ny = table.rows;
        spacing(&h, &table, &c.dx, &c.dy);
        if (most > 0)
            channel[k] = c;
    }
    return images;
}

static struct rc_grid *
ascii_read(const struct rc_file *file, const struct rc_wish *wish, size_t index,
           struct rc_notes *notes, struct rc_err *err)
{
    struct rc_number_table table;
    struct rc_ascii_head h;
    size_t images;

    if (ascii_open(file, wish, index, &h, &table, &images, err) != RC_OK)
        return NULL;
    return read_matrix(&h, images, &table, wish, notes, err);
}

const struct rc_format rc_format_ascii = {
    .name = "ascii",
    .suffixes = ".txt .asc .csv",
    .summary = "matrices of heights as text, with or without a header",
    .score = ascii_score,
    .list = ascii_list,
    .read = ascii_read,
};
