/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Nanosurf: an INI header that ends in "#!". Then come the data of all channels in sequence, in the order of
 * their groups, the bottom row first.
 *
 *     [DataSet]
 *     Gr0-Ch1=DataSet-0:1       channel 1 of group 0 is described in section [DataSet-0:1]
 *
 *     [DataSet-0:1]
 *     Points=256                columns
 *     Lines=256                 rows
 *     Dim0Range=5e-05           width in Dim0Unit; Dim1 is the other way
 *     Dim2Range=2.032e-05       value = Dim2Min + share of the whole numbers' range * Dim2Range
 *     SaveBits=16
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/format.h"

enum {
    NAME = 64
};

/* Gr0-Ch1=DataSet-0:1 */
struct entry {
    unsigned long group, channel;
    struct rc_piece section;
};

struct set {
    double columns, rows, bits, x, y, least, range;
    struct rc_piece frame, x_unit, y_unit, unit, name, mode, sign, order;
};

static const struct rc_field fields[] = {
    {"Points", RC_FIELD_NUMBER, offsetof(struct set, columns)},
    {"Lines", RC_FIELD_NUMBER, offsetof(struct set, rows)},
    {"Frame", RC_FIELD_TEXT, offsetof(struct set, frame)},
    {"Dim0Unit", RC_FIELD_TEXT, offsetof(struct set, x_unit)},
    {"Dim0Range", RC_FIELD_NUMBER, offsetof(struct set, x)},
    {"Dim1Unit", RC_FIELD_TEXT, offsetof(struct set, y_unit)},
    {"Dim1Range", RC_FIELD_NUMBER, offsetof(struct set, y)},
    {"Dim2Name", RC_FIELD_TEXT, offsetof(struct set, name)},
    {"Dim2Unit", RC_FIELD_TEXT, offsetof(struct set, unit)},
    {"Dim2Range", RC_FIELD_NUMBER, offsetof(struct set, range)},
    {"Dim2Min", RC_FIELD_NUMBER, offsetof(struct set, least)},
    {"SaveMode", RC_FIELD_TEXT, offsetof(struct set, mode)},
    {"SaveBits", RC_FIELD_NUMBER, offsetof(struct set, bits)},
    {"SaveSign", RC_FIELD_TEXT, offsetof(struct set, sign)},
    {"SaveOrder", RC_FIELD_TEXT, offsetof(struct set, order)},
};

static const struct rc_keep keys[] = {
    {"Date", "file.date"},
    {"Time", "file.time"},
    {"Scan head", "file.scanner"},
    {"Head type", "file.model"},
    {"Controller S/N", "file.serial"},
    {"Software ver.", "file.version"},
};

/* The start of the data, after the first "#!" at the beginning of a line; 0: there is none. */
static size_t
data_at(const struct rc_file *file)
{
    const unsigned char *s = file->data, *mark;

    for (size_t at = 0; (mark = memchr(s + at, '#', file->size - at)) != NULL;) {
        at = (size_t)(mark - s) + 1;
        if (at < file->size && s[at] == '!' && (at == 1 || s[at - 2] == '\n'))
            return at + 1;
    }
    return 0;
}

/* The lines of a section, or false. */
static bool
find_section(struct rc_piece header, struct rc_piece name, struct rc_piece *section)
{
    struct rc_lines lines = rc_piece_lines(header);
    struct rc_piece line;
    const char *start = NULL;

    while (rc_lines_next(&lines, &line.text, &line.n)) {
        const char *before = line.text;
        line = rc_piece_trim(line);
        if (line.n == 0 || *line.text != '[')
            continue;
        if (start != NULL) {
            *section = (struct rc_piece){start, (size_t)(before - start)};
            return true;
        }
        if (line.n == name.n + 2 && memcmp(line.text + 1, name.text, name.n) == 0)
            start = lines.at;
    }
    if (start != NULL)
        *section = (struct rc_piece){start, (size_t)(header.text + header.n - start)};
    return start != NULL;
}

/* Adds the map, when it is one, and moves *at behind the data. */
static enum rc_status
add_set(const struct set *s, struct rc_maps *maps, size_t *at, struct rc_err *err)
{
    char text[2 * NAME + 2], name[NAME], frame[NAME];
    double range = s->bits == 16 ? 65536 : 4294967296.0;
    struct rc_map *map;
    size_t nx, ny, n;

    if (s->bits != 16 && s->bits != 32)
        return rc_err_set(err, "SaveBits is %g: it must be 16 or 32", s->bits);
    if (s->mode.n > 0 && !rc_piece_is(s->mode, "Binary"))
        return rc_err_set(err, "SaveMode is '%s': only Binary is read",
                          rc_text_clean(name, sizeof name, s->mode.text, s->mode.n));
    if (rc_map_count("columns (Points)", s->columns, &nx, err) != RC_OK ||
        rc_map_count("rows (Lines)", s->rows, &ny, err) != RC_OK ||
        rc_size_mul(nx * (size_t)(s->bits / 8), ny, &n, err) != RC_OK)
        return RC_FAIL;
    if (!isnan(rc_piece_metres(s->x_unit)) && !isnan(rc_piece_metres(s->y_unit))) {
        rc_text_clean(name, sizeof name, s->name.text, s->name.n);
        rc_text_clean(frame, sizeof frame, s->frame.text, s->frame.n);
        snprintf(text, sizeof text, "%s%s%s", name, *frame == '\0' ? "" : ", ", frame);
        map = rc_maps_add(maps, rc_piece_of(text));
        map->nx = nx;
        map->ny = ny;
        map->at = *at;
        map->raw = s->bits == 16 ? RC_RAW_I16 : RC_RAW_I32;
        map->big = rc_piece_is(s->order, "Motorola");
        map->bottom_first = true;
        map->scale = s->range / range;
        map->zero = s->least + s->range / 2;
        if (rc_piece_is(s->sign, "Unsigned")) {
            map->raw = s->bits == 16 ? RC_RAW_U16 : RC_RAW_U32;
            map->zero = s->least;
        }
        map->dx = s->x * rc_piece_metres(s->x_unit) / (double)nx;
        map->dy = s->y * rc_piece_metres(s->y_unit) / (double)ny;
        rc_map_unit(map, s->unit);
    }
    *at = n > SIZE_MAX - *at ? SIZE_MAX : *at + n;
    return RC_OK;
}

static int
by_place(const void *a, const void *b)
{
    const struct entry *x = a, *y = b;

    if (x->group != y->group)
        return x->group < y->group ? -1 : 1;
    return (x->channel > y->channel) - (x->channel < y->channel);
}

/* The number behind a word that the text begins with; moves behind it. */
static bool
take_number(struct rc_piece *text, const char *word, unsigned long *number)
{
    size_t n = strlen(word), first = n;

    if (!rc_piece_begins(*text, word))
        return false;
    for (*number = 0; n < text->n && text->text[n] >= '0' && text->text[n] <= '9'; n++)
        *number = (10 * *number + (unsigned long)(text->text[n] - '0')) % 1000000;
    *text = (struct rc_piece){text->text + n, text->n - n};
    return n > first;
}

/* The entries of [DataSet] in the order of their data; gives their number. */
static size_t
find_entries(struct rc_piece table, struct entry entry[RC_MAPS_MOST])
{
    struct rc_lines lines = rc_piece_lines(table);
    struct rc_piece line, key;
    size_t n = 0;

    while (n < RC_MAPS_MOST && rc_lines_next(&lines, &line.text, &line.n))
        if (rc_piece_part(line, "=", &key, &entry[n].section) &&
            take_number(&key, "Gr", &entry[n].group) &&
            take_number(&key, "-Ch", &entry[n].channel) && key.n == 0)
            n++;
    qsort(entry, n, sizeof *entry, by_place);
    return n;
}

static enum rc_status
add_all(struct rc_piece header, struct rc_piece table, size_t at, struct rc_maps *maps,
        struct rc_err *err)
{
    struct entry entry[RC_MAPS_MOST] = {{0}};
    size_t n = find_entries(table, entry);

    for (size_t k = 0; k < n; k++) {
        struct rc_piece section;
        struct rc_lines lines;
        struct set s = {0};

        if (!find_section(header, entry[k].section, &section))
            return rc_err_set(
                err, "channel %lu of group %lu is described in section '%s', which is not there",
                entry[k].channel, entry[k].group, rc_piece_shown(entry[k].section));
        lines = rc_piece_lines(section);
        if (rc_fields_read(fields, sizeof fields / sizeof *fields, &lines, "=", NULL, &s, err) !=
                RC_OK ||
            add_set(&s, maps, &at, err) != RC_OK)
            return RC_FAIL;
    }
    if (maps->n == 0)
        return rc_err_set(err, "the file has only curves, no map");
    return RC_OK;
}

static enum rc_status
nid_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    static const struct rc_piece about[] = {
        {"DataSet-Info", 12},
        {"DataSet\\DataSetInfos\\Scan", 25},
        {"DataSet\\DataSetInfos\\Global", 27},
    };
    struct rc_piece header = {(const char *)file->data, data_at(file)}, table, section;
    struct rc_piece line, key, value;

    if (header.n == 0)
        return rc_err_set(err, "no Nanosurf file: there is no line that begins with #!");
    if (!find_section(header, (struct rc_piece){"DataSet", 7}, &table))
        return rc_err_set(err, "no Nanosurf file: its header has no section [DataSet]");
    for (size_t s = 0; s < sizeof about / sizeof *about; s++)
        if (find_section(header, about[s], &section)) {
            struct rc_lines lines = rc_piece_lines(section);
            while (rc_lines_next(&lines, &line.text, &line.n))
                if (rc_piece_part(line, "=", &key, &value))
                    rc_maps_keep(maps, keys, sizeof keys / sizeof *keys, key, value);
        }
    return add_all(header, table, header.n, maps, err);
}

const struct rc_format rc_format_nid = {
    .name = "nid",
    .suffixes = ".nid .ezd",
    .summary = "Nanosurf images",
    .magic = {{"[DataSet]", 9}},
    .find = nid_find,
};
