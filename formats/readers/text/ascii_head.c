/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ascii_head.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* The values of the keys, as they are in the file; n = 0: not given. */
struct given {
    struct rc_piece channel, width, height, pixel, factor, ny, nx, x_length, y_length, x_unit,
        y_unit, z_unit, z_range, bit, any_line, x_step, y_step, scale, scaled, size, separator;
};

#define TO(member) offsetof(struct given, member)
static const struct {
    const char *key; /* in upper or lower case; several keys are separated by '|' */
    size_t to;
    bool anywhere; /* profiles and lists of points have such lines too */
} keys[] = {
    {"channel|display", TO(channel), false},
    {"width|real width|x-length|x amplitude", TO(width), false},
    {"height|real height|y-length|y amplitude", TO(height), false},
    {"value units|data unit|unit data|exported image units", TO(z_unit), false},
    {"pixel size", TO(pixel), false},
    {"height conversion factor (-> m)", TO(factor), false},
    {"h|y-pixels|ny|image height", TO(ny), false},
    {"w|x-pixels|nx|image width", TO(nx), false},
    {"x-length", TO(x_length), false},
    {"y-length", TO(y_length), false},
    {"x-unit|unit x", TO(x_unit), true},
    {"y-unit|unit y", TO(y_unit), true},
    {"z-unit|z unit", TO(z_unit), true},
    {"bit2nm", TO(bit), false},
    {"file format", TO(any_line), false},
    {"scale x", TO(x_step), false},
    {"scale y", TO(y_step), false},
    {"scale data", TO(scale), false},
    {"datascaleneeded", TO(scaled), false},
    {"scan size", TO(size), false},
    {"sep", TO(separator), true},
    {"z amplitude", TO(z_range), false}, /* a number, and the unit of the heights */
};
#undef TO

/* The lines of a header, while they are read. */
struct lines {
    struct given given;
    bool known;    /* at least one line is */
    bool any_line; /* up to `Start of Data` all lines belong to the header */
    size_t comments;
    struct rc_piece comment[4];
};

/* ---- values of a header ---- */

/* A division by a power of ten that a double holds rounds once: 5 um is the double 5e-06. */
static double
in_metres(double value, double unit)
{
    return unit < 1 ? value / round(1 / unit) : value * unit;
}

/* "10.00 µm" or "10.00 [µm]" in metres, NAN when it is no such thing. */
static double
length_of(struct rc_piece p)
{
    double value, unit;

    if (p.n == 0 || !rc_piece_number(p, &value, &p))
        return NAN;
    unit = rc_piece_metres(rc_piece_bare(p));
    return isnan(unit) ? NAN : in_metres(value, unit);
}

static double
number_of(struct rc_piece p)
{
    double value;

    return p.n > 0 && rc_piece_number(p, &value, &p) && p.n == 0 ? value : NAN;
}

static size_t
count_of(struct rc_piece p)
{
    double value = number_of(p);

    if (!(value >= 1 && value <= 1e15 && value == floor(value)))
        return 0;
    return value < (double)SIZE_MAX ? (size_t)value : SIZE_MAX;
}

/* "10 10 um", or one number for both. */
static void
take_scan_size(struct rc_ascii_head *h, struct rc_piece p)
{
    double a, b, unit;

    if (p.n == 0 || !rc_piece_number(p, &a, &p))
        return;
    if (!rc_piece_number(p, &b, &p))
        b = a;
    if (rc_length_unit(p.text, p.n, &unit)) {
        h->width = in_metres(a, unit);
        h->height = in_metres(b, unit);
    }
}

static void
take_unit(struct rc_ascii_head *h, struct rc_piece p)
{
    p = rc_piece_bare(p);
    h->z = NAN;
    rc_text_clean(h->unit, sizeof h->unit, p.text, p.n);
    if (rc_length_unit(p.text, p.n, &h->z))
        h->unit[0] = '\0';
}

/* ---- lines of a header ---- */

/* Where the key ends: at a colon, an equals sign, or the wide colon of East Asian text. */
static const char *
find_mark(const char *s, size_t n, size_t *width)
{
    for (size_t k = 0; k < n; k++) {
        *width = 1;
        if (s[k] == ':' || s[k] == '=')
            return s + k;
        *width = 3;
        if (n - k >= 3 && memcmp(s + k, "\xef\xbc\x9a", 3) == 0)
            return s + k;
    }
    return NULL;
}

/* `key: value` or `key=value`; whether the key is one of ours. */
static bool
take_entry(struct lines *h, const char *s, size_t n, struct rc_piece *value)
{
    size_t width;
    const char *mark = find_mark(s, n, &width);
    struct rc_piece key;
    bool found = false;

    *value = (struct rc_piece){s, 0};
    if (mark == NULL)
        return false;
    value->text = mark + width;
    value->n = n - (size_t)(value->text - s);
    rc_trim(&value->text, &value->n);
    key = rc_piece_trim((struct rc_piece){s, (size_t)(mark - s)});
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
        if (rc_piece_is(key, keys[k].key)) {
            memcpy((char *)&h->given + keys[k].to, value, sizeof *value);
            h->any_line = h->any_line || rc_piece_is(key, "file format");
            h->known = h->known || !keys[k].anywhere;
            found = true;
        }
    return found;
}

/* Several `key=value` without white space on one line: "h=305 w=75". */
static bool
take_words(struct lines *h, const char *s, size_t n)
{
    struct rc_piece value;
    size_t length;

    for (; n > 0; s += length, n -= length) {
        while (n > 0 && *s == ' ')
            s++, n--;
        for (length = 0; length < n && s[length] != ' ';)
            length++;
        if (length > 0 && !take_entry(h, s, length, &value))
            return false;
    }
    return true;
}

/* True if the line belongs to the header. */
static bool
take_line(struct lines *h, const char *s, size_t n)
{
    struct rc_piece value;

    rc_trim(&s, &n);
    if (n == 0)
        return true;
    if (*s == '#' || *s == '%') {
        while (n > 0 && (*s == '#' || *s == '%'))
            s++, n--;
        rc_trim(&s, &n);
        take_entry(h, s, n, &value);
        h->any_line = false; /* this is for headers without a mark in their lines */
        if (h->comments < sizeof h->comment / sizeof *h->comment)
            h->comment[h->comments] = value;
        h->comments++;
        return true;
    }
    if (n > 1 && *s == '"' && s[1] == '\\') {
        s++;
        n -= s[n - 2] == '"' ? 2 : 1;
    }
    if (*s == '\\') {
        take_entry(h, s + 1, n - 1, &value);
        return true;
    }
    if (rc_piece_begins((struct rc_piece){s, n}, "wsxm ") ||
        rc_piece_begins((struct rc_piece){s, n}, "text file create date")) {
        h->any_line = true;
        return true;
    }
    if (h->any_line && *s >= 'A') {
        h->any_line = !rc_piece_begins((struct rc_piece){s, n}, "start of data");
        take_entry(h, s, n, &value);
        return true;
    }
    if (*s >= 'A')
        return take_entry(h, s, n, &value) && (n < 2 || s[1] != '=' || take_words(h, s, n));
    return false;
}

/* Gwyddion writes its header in the user's language: four lines. The second and third are lengths, and
 * the last is a unit. */
static void
take_by_shape(struct rc_ascii_head *h, const struct lines *l)
{
    const struct rc_piece *c = l->comment;

    if (l->comments != 4 || !isnan(h->width) || !isnan(h->height) || isnan(length_of(c[1])) ||
        isnan(length_of(c[2])) || !isnan(length_of(c[0])) || !isnan(length_of(c[3])))
        return;
    h->known = true;
    h->channel = c[0];
    h->width = length_of(c[1]);
    h->height = length_of(c[2]);
    take_unit(h, c[3]);
}

/* Numbers that have their unit on another line. SPIP's lengths without one are in nanometres, and
 * its Bit2nm is for what has no unit; Nova's scale counts where the header says so. */
static void
join_units(struct rc_ascii_head *h, const struct given *g)
{
    bool has_x = g->x_unit.text != NULL;
    double x = has_x ? rc_piece_metres(rc_piece_bare(g->x_unit)) : 1e-9;
    double y = g->y_unit.text != NULL ? rc_piece_metres(rc_piece_bare(g->y_unit)) : x;

    if (!isnan(number_of(g->x_length)))
        h->width = in_metres(number_of(g->x_length), x);
    if (!isnan(number_of(g->y_length)))
        h->height = in_metres(number_of(g->y_length), y);
    h->step_x = has_x ? in_metres(number_of(g->x_step), x) : NAN;
    h->step_y = has_x ? in_metres(number_of(g->y_step), y) : NAN;
    if (isnan(h->z) && h->unit[0] == '\0')
        h->z = in_metres(number_of(g->bit), 1e-9);
    if (g->scaled.text != NULL && !rc_piece_is(g->scaled, "no"))
        h->z *= number_of(g->scale);
    if (isnan(h->z))
        h->z = number_of(g->factor);
}

void
rc_ascii_read_head(struct rc_ascii_head *h, struct rc_lines *lines)
{
    struct rc_lines ahead = *lines;
    struct lines l = {.known = false};
    const struct given *g = &l.given;
    struct rc_piece range;
    const char *line;
    double number;
    size_t n;

    while (rc_lines_next(&ahead, &line, &n) && take_line(&l, line, n))
        *lines = ahead;
    *h = (struct rc_ascii_head){.known = l.known,
                                .channel = g->channel,
                                .width = length_of(g->width),
                                .height = length_of(g->height),
                                .pixel = length_of(g->pixel),
                                .z = NAN,
                                .nx = count_of(g->nx),
                                .ny = count_of(g->ny)};
    if (g->separator.n == 1)
        h->separator[0] = *g->separator.text;
    if (g->z_range.n > 0 && rc_piece_number(g->z_range, &number, &range))
        take_unit(h, range);
    if (g->z_unit.text != NULL)
        take_unit(h, g->z_unit);
    take_scan_size(h, g->size);
    take_by_shape(h, &l);
    join_units(h, g);
}
