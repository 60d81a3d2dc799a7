/* SPDX-License-Identifier: GPL-3.0-or-later */
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
 *     Text File Create Date : ...     an AFM, after which all lines up to the numbers are of the header;
 * the
 *     Image Width : 4                 numbers may be in one line
 *     Real Width : 8.00 um
 *
 *     \Scan Size: 10 10 um            NanoScope export of one image
 *     \Exported image units: nm
 *
 * Without a known header, lines of other text above the numbers are skipped, and the first row and
 * column may be labels or positions (labels.h).
 *
 * Two columns of which the first rises, perhaps with small steps back, count as a profile. Three columns
 * with a raster in two of them count as a list of points. Both are refused, unless a header says that
 * they are a matrix.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ascii_head.h"
#include "labels.h"
#include "formats/format.h"

enum {
    IMAGES_MOST = 64 /* images that are read from one file */
};

/* One of the images of a file: a table of heights with its header, and its rows and columns without
 * heights. */
struct image {
    struct rc_ascii_head head;
    struct rc_lines lines; /* its numbers, and comments between them */
    struct rc_number_table table;
    struct rc_labels labels;
    size_t nx, ny; /* columns and rows of heights */
};

struct matrix {
    struct image image[IMAGES_MOST];
    size_t images; /* also those that are not kept */
    const struct rc_titled_table
        *titled; /* has the table of the only image; NULL: it is behind a header */
};

/* Takes the next image from *rest on, and moves *rest to the header of the following one. A header below
 * numbers begins another image; other comments there do not. */
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

/* True if the numbers stand in one line, or in one column, and are as many as the header says: they are
 * a map, row by row. */
static bool
is_one_line(const struct image *m)
{
    const struct rc_number_table *t = &m->table;
    size_t n;

    return m->head.nx > 0 && m->head.ny > 0 && (t->rows == 1 || t->columns == 1) &&
           rc_size_mul(m->head.nx, m->head.ny, &n, NULL) == RC_OK && n == t->rows * t->columns;
}

/* Opens the table behind the header of an image. */
static enum rc_status
open_behind_head(struct image *m, const struct rc_wish *wish, struct rc_err *err)
{
    const struct rc_ascii_head *h = &m->head;
    struct rc_wish said = *wish;

    if (said.separator == NULL && h->separator[0] != '\0')
        said.separator = h->separator;
    if (rc_number_table_open(&m->table, &m->lines, &said, err) != RC_OK)
        return RC_FAIL;
    if (is_one_line(m))
        return RC_OK;
    if ((h->nx != 0 && h->nx != m->table.columns) || (h->ny != 0 && h->ny != m->table.rows))
        return rc_err_set(err,
                          "the header promises %zu columns and %zu rows, the file has %zu and %zu",
                          h->nx == 0 ? m->table.columns : h->nx, h->ny == 0 ? m->table.rows : h->ny,
                          m->table.columns, m->table.rows);
    if (m->table.columns == 1)
        return rc_err_set(err,
                          "%zu numbers in one column: that is a profile or a list, no matrix "
                          "(--format profile takes them for heights)",
                          m->table.rows);
    return RC_OK;
}

/* Finds the images of the file, and opens the first. */
static enum rc_status
open_images(struct matrix *m, const struct rc_titled_table *t, struct rc_err *err)
{
    struct rc_lines rest = rc_piece_lines(rc_file_piece(t->file));
    struct image other;

    if (rc_file_is_utf16(t->file))
        return rc_err_set(err, "the text is UTF-16: convert it first (iconv -f UTF-16 -t UTF-8)");
    if (rc_file_holds(t->file, 0, "\xef\xbb\xbf", 3))
        rest.at += 3; /* the byte order mark of UTF-8 */
    do
        next_image(&rest, m->images < IMAGES_MOST ? &m->image[m->images] : &other);
    while (++m->images, rest.at < rest.end);
    return open_behind_head(&m->image[0], t->wish, err);
}

/* True if a line above the numbers looks like a row of them that is damaged. */
static bool
is_damaged_row(const struct rc_titled_table *t)
{
    struct rc_piece line = t->title_line, title, rest;
    size_t numbers = 0, others = 0;
    double value;

    while (rc_title_next(&line, t->title_separator, &title))
        if (rc_piece_number(rc_piece_bare(title), &value, &rest) && rest.n == 0)
            numbers++;
        else
            others += title.n > 0;
    return numbers > others && numbers + others >= t->numbers.columns && others > 0 &&
           !rc_titled_table_is_matrix(t);
}

/* A matrix below titles or other text, in UTF-16 too. */
static bool
open_below_titles(struct matrix *m, const struct rc_titled_table *t)
{
    m->titled = t;
    m->images = 1;
    m->image[0].head = (struct rc_ascii_head){.width = NAN,
                                              .height = NAN,
                                              .pixel = NAN,
                                              .step_x = NAN,
                                              .step_y = NAN,
                                              .z = rc_piece_metres(t->axis_unit[2])};
    m->image[0].table = t->numbers;
    return (rc_file_is_text(t->file) || rc_file_is_utf16(t->file)) && t->status == RC_OK &&
           rc_titled_table_is_matrix(t) && !is_damaged_row(t) &&
           !(rc_file_is_utf16(t->file) && t->skipped > 0);
}

/* Where no header is known and there is no matrix below titles either, the reason is that of the
 * numbers. */
static enum rc_status
matrix_open(void *found, struct rc_titled_table *table, struct rc_err *err)
{
    struct matrix *m = found;

    return open_images(m, table, err) == RC_OK ||
                   (!m->image[0].head.known && open_below_titles(m, table))
               ? RC_OK
               : RC_FAIL;
}

static const struct rc_table_kind kind = {RC_TABLE_MATRIX, sizeof(struct matrix), matrix_open,
                                          NULL};

/* Spacing as the header or the positions have it, NAN where they do not say. */
static enum rc_status
spacing(const struct image *m, const struct rc_wish *wish, double *dx, double *dy,
        struct rc_err *err)
{
    const struct rc_ascii_head *h = &m->head;

    if (!h->known)
        return rc_labels_spacing(&m->labels, wish, dx, dy, err);
    *dx = !isnan(h->step_x) ? h->step_x : !isnan(h->pixel) ? h->pixel : h->width / (double)m->nx;
    *dy = !isnan(h->step_y) ? h->step_y : !isnan(h->pixel) ? h->pixel : h->height / (double)m->ny;
    if (isnan(*dy))
        *dy = *dx;
    return RC_OK;
}

/* True if two columns run through a raster. Column `slow` is constant while `fast` changes in one
 * direction, and then makes a step, always in the same direction. Four points of one row are a raster,
 * fewer could be anything. */
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

/* True if the first of two columns holds positions: it rises, or it runs one way but for small steps
 * back, which few rows could do by chance. */
static bool
has_positions(const double *v, size_t rows)
{
    bool rises = rows > 2;

    for (size_t j = 1; j < rows; j++)
        rises = rises && v[2 * j] > v[2 * j - 2];
    return rises || (rows > 5 && rc_even_one_way(v, rows, 2));
}

static enum rc_status
refuse_coordinates(const struct image *m, const double *v, struct rc_err *err)
{
    const struct rc_ascii_head *h = &m->head;

    if (h->nx != 0 || !isnan(h->width) || !isnan(h->pixel) || !isnan(h->step_x))
        return RC_OK;
    if (m->nx == 2 && has_positions(v, m->ny))
        return rc_err_set(err, "two columns with a rising first one are a profile (x, z), no "
                               "matrix: give --format profile, or add a header with a width");
    if (m->nx == 3 && (is_raster(v, m->ny, 0, 1) || is_raster(v, m->ny, 1, 0)))
        return rc_err_set(err,
                          "three columns with a raster in two of them are a list of points (x, y, "
                          "z), no matrix: give --format xyz, or add a header with a width");
    return RC_OK;
}

/* Puts the heights into v, without labels and positions. */
static enum rc_status
read_heights(struct image *m, double *v, struct rc_err *err)
{
    const struct rc_labels *l = &m->labels;
    size_t n = m->table.rows * m->table.columns;
    RC_OWNED double *all = NULL;

    if (l->rows + l->columns == 0)
        return rc_number_table_read(&m->table, v, err);
    if ((all = malloc(n * sizeof *all)) == NULL)
        return rc_err_set(err, "out of memory for %zu values", n);
    if (rc_number_table_read(&m->table, all, err) != RC_OK)
        return RC_FAIL;
    for (size_t j = 0; j < m->ny; j++)
        memcpy(v + j * m->nx, all + (j + l->rows) * m->table.columns + l->columns,
               m->nx * sizeof *v);
    return RC_OK;
}

static void
note_skipped(const struct rc_titled_table *t, struct rc_notes *notes)
{
    if (t->skipped > 0)
        rc_note(notes, "%zu line%s above the numbers %s passed over, the first is '%s'", t->skipped,
                t->skipped == 1 ? "" : "s", t->skipped == 1 ? "is" : "are",
                rc_piece_shown(t->first_skipped));
    if (t->titles == t->numbers.columns && !rc_titled_table_numbered(t))
        rc_note(notes, "the titles, '%s' and so on, name no axis: the table is read as a matrix",
                rc_piece_shown(rc_titled_table_name(t, 0)));
}

/* ---- the entry in formats.list ---- */

static int
ascii_score(struct rc_maps *maps)
{
    enum rc_status status;
    const struct matrix *m = rc_table_as(maps, &kind, &status, NULL);
    bool known = m != NULL && m->image[0].head.known;
    unsigned char c = maps->file->data[0];

    if (status == RC_OK)
        return known ? 90 : 40;
    if (rc_file_is_utf16(maps->file))
        return 2;
    /* A low score for a file that begins like numbers, so that the refusal names the error. */
    return known ? 30 : (c >= '0' && c <= '9') || strchr("- \"", c) != NULL ? 5 : 0;
}

static enum rc_status
fill_matrix(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    struct matrix *m = ((struct rc_titled_table *)map->opened)->as[RC_TABLE_MATRIX].found;
    struct image *image = &m->image[map->more];

    (void)file;
    if (read_heights(image, v, err) != RC_OK || refuse_coordinates(image, v, err) != RC_OK)
        return RC_FAIL;
    if (m->titled != NULL)
        note_skipped(m->titled, map->notes);
    rc_labels_note(&image->labels, map->notes);
    return RC_OK;
}

/* The unit is a length, or another one of a file with several images; of a single image it is refused. */
static void
set_unit(const struct image *m, bool single, struct rc_map *map)
{
    const struct rc_ascii_head *h = &m->head;
    double metres = isnan(h->z) ? rc_piece_metres(m->labels.height_unit) : h->z;

    map->heights = single;
    strcpy(map->unit, isnan(metres) ? h->unit : "m");
    if (!isnan(metres))
        map->si = metres;
    else if (!single)
        rc_map_unit(map, rc_piece_of(h->unit));
}

/* Finds the labels or positions of image k, and adds its map. */
static enum rc_status
add_image(struct matrix *m, size_t k, struct rc_maps *maps, struct rc_err *err)
{
    const struct rc_wish *wish = maps->wish;
    struct image *image = &m->image[k];
    struct rc_labels *l = &image->labels;
    struct rc_map *map;
    size_t n;

    l->height_unit = rc_piece_of("");
    if ((k > 0 && open_behind_head(image, wish, err) != RC_OK) ||
        (!image->head.known && rc_labels_find(&image->table, m->titled, wish, l, err) != RC_OK))
        return RC_FAIL;
    image->nx = is_one_line(image) ? image->head.nx : image->table.columns - l->columns;
    image->ny = is_one_line(image) ? image->head.ny : image->table.rows - l->rows;
    map = rc_maps_add(maps, image->head.channel);
    if (rc_number_table_size(&image->table, &n, err) != RC_OK)
        return RC_FAIL;
    map->nx = image->nx;
    map->ny = image->ny;
    map->fill = fill_matrix;
    map->more = k;
    map->right_first = l->falls[0];
    map->bottom_first = l->falls[1];
    if (l->rows + l->columns > 0)
        map->beside = 8 * (double)n;
    set_unit(image, m->images == 1, map);
    /* --dx gives the unit of the positions, of y too */
    map->own_dy = l->positions && isnan(l->metres[0]) && isnan(wish->dy) && !isnan(wish->dx);
    return spacing(image, wish, &map->dx, &map->dy, err);
}

static enum rc_status
ascii_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    enum rc_status status;
    struct matrix *m = rc_table_as(maps, &kind, &status, err);

    (void)file;
    for (size_t k = 0; status == RC_OK && k < m->images && k < IMAGES_MOST; k++)
        status = add_image(m, k, maps, err);
    return status;
}

const struct rc_format rc_format_ascii = {
    .name = "ascii",
    .suffixes = ".txt .asc .csv",
    .summary = "matrices of heights as text, with or without a header",
    .score_open = ascii_score,
    .find = ascii_find,
};
