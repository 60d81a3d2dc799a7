#include "ascii_head.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* The kind of a value, and the type of its member. */
enum kind {
    TEXT,      /* struct rc_piece                                         */
    LENGTH,    /* double, m                                               */
    NUMBER,    /* double, without further text */
    COUNT,     /* size_t                                                  */
    IN_METRES, /* struct rc_ascii_unit: a unit of length                  */
    UNLESS_NO, /* bool                                                    */
    CHARACTER, /* char: the only one                                      */
    PRESENT,   /* bool: that the key is there                             */
    /* these kinds have no member: */
    VALUE_UNIT, /* unit of the heights */
    RANGE,      /* a number and that unit                                 */
    SCAN_SIZE,
};

#define TO(member) offsetof(struct rc_ascii_head, member)
static const struct {
    const char *key; /* in upper or lower case; several keys are separated by '|' */
    enum kind kind;
    size_t to;
    bool anywhere; /* profiles and lists of points have such lines too */
} keys[] = {
    {"channel|display", TEXT, TO(channel), false},
    {"width|x-length|x amplitude", LENGTH, TO(width), false},
    {"height|y-length|y amplitude", LENGTH, TO(height), false},
    {"value units|data unit|unit data|exported image units", VALUE_UNIT, 0, false},
    {"pixel size", LENGTH, TO(pixel), false},
    {"height conversion factor (-> m)", NUMBER, TO(factor), false},
    {"h|y-pixels|ny", COUNT, TO(ny), false},
    {"w|x-pixels|nx", COUNT, TO(nx), false},
    {"x-length", NUMBER, TO(as_given.x_length), false},
    {"y-length", NUMBER, TO(as_given.y_length), false},
    {"x-unit|unit x", IN_METRES, TO(as_given.x_unit), true},
    {"y-unit|unit y", IN_METRES, TO(as_given.y_unit), true},
    {"z-unit", VALUE_UNIT, 0, true},
    {"bit2nm", NUMBER, TO(as_given.bit), false},
    {"file format", PRESENT, TO(any_line), false},
    {"scale x", NUMBER, TO(as_given.x_step), false},
    {"scale y", NUMBER, TO(as_given.y_step), false},
    {"scale data", NUMBER, TO(as_given.scale), false},
    {"datascaleneeded", UNLESS_NO, TO(as_given.scaled), false},
    {"scan size", SCAN_SIZE, 0, false},
    {"sep", CHARACTER, TO(separator), true},
    {"z amplitude", RANGE, 0, false},
};
#undef TO

/* ---- values of a header ---- */

/* The number at the start of a value and the rest; numbers in a header have the decimal mark of the exporting
 * program. */
static bool
leading_number(struct rc_piece *p, double *value)
{
    char copy[64];
    size_t n = p->n < sizeof copy - 1 ? p->n : sizeof copy - 1;
    const char *end;

    memcpy(copy, p->text, n);
    copy[n] = '\0';
    if (strchr(copy, '.') == NULL && strchr(copy, ',') != NULL)
        *strchr(copy, ',') = '.';
    if ((end = rc_number_read(copy, false, value)) == NULL)
        return false;
    p->text += end - copy;
    p->n -= (size_t)(end - copy);
    rc_trim(&p->text, &p->n);
    return true;
}

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

    if (!leading_number(&p, &value))
        return NAN;
    unit = rc_piece_metres(rc_piece_bare(p));
    return isnan(unit) ? NAN : in_metres(value, unit);
}

static double
number_of(struct rc_piece p)
{
    double value;

    return leading_number(&p, &value) && p.n == 0 ? value : NAN;
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

    if (!leading_number(&p, &a))
        return;
    if (!leading_number(&p, &b))
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

/* Puts a value into the member that is `to` bytes into the head. */
static void
take(struct rc_ascii_head *h, enum kind kind, size_t to, struct rc_piece value)
{
    void *member = (char *)h + to;
    double number;

    switch (kind) {
    case TEXT:
        *(struct rc_piece *)member = value;
        break;
    case LENGTH:
        *(double *)member = length_of(value);
        break;
    case NUMBER:
        *(double *)member = number_of(value);
        break;
    case COUNT:
        *(size_t *)member = count_of(value);
        break;
    case IN_METRES:
        *(struct rc_ascii_unit *)member =
            (struct rc_ascii_unit){true, rc_piece_metres(rc_piece_bare(value))};
        break;
    case UNLESS_NO:
        *(bool *)member = !rc_piece_is(value, "no");
        break;
    case CHARACTER:
        if (value.n == 1)
            *(char *)member = *value.text;
        break;
    case PRESENT:
        *(bool *)member = true;
        break;
    case VALUE_UNIT:
        take_unit(h, value);
        break;
    case RANGE:
        if (leading_number(&value, &number))
            take_unit(h, value);
        break;
    case SCAN_SIZE:
        take_scan_size(h, value);
        break;
    }
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
take_entry(struct rc_ascii_head *h, const char *s, size_t n, struct rc_piece *value)
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
            take(h, keys[k].kind, keys[k].to, *value);
            h->known = h->known || !keys[k].anywhere;
            found = true;
        }
    return found;
}

/* Several `key=value` without white space on one line: "h=305 w=75". */
static bool
take_words(struct rc_ascii_head *h, const char *s, size_t n)
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

static void
remember(struct rc_ascii_head *h, struct rc_piece value)
{
    if (h->comments < sizeof h->comment / sizeof *h->comment)
        h->comment[h->comments] = (struct rc_ascii_comment){value, length_of(value)};
    h->comments++;
}

/* True if the line belongs to the header. */
static bool
take_line(struct rc_ascii_head *h, const char *s, size_t n)
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
        remember(h, value);
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
    if (rc_piece_begins((struct rc_piece){s, n}, "wsxm ")) {
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
take_by_shape(struct rc_ascii_head *h)
{
    const struct rc_ascii_comment *c = h->comment;

    if (h->comments != 4 || !isnan(h->width) || !isnan(h->height) || isnan(c[1].length) ||
        isnan(c[2].length) || !isnan(c[0].length) || !isnan(c[3].length))
        return;
    h->known = true;
    h->channel = c[0].value;
    h->width = c[1].length;
    h->height = c[2].length;
    take_unit(h, c[3].value);
}

/* Numbers that have their unit on another line. SPIP's lengths without one are in nanometres, and
 * its Bit2nm is for what has no unit; Nova's scale counts where the header says so. */
static void
join_units(struct rc_ascii_head *h)
{
    double x = h->as_given.x_unit.given ? h->as_given.x_unit.metres : 1e-9;
    double y = h->as_given.y_unit.given ? h->as_given.y_unit.metres : x;

    if (!isnan(h->as_given.x_length))
        h->width = in_metres(h->as_given.x_length, x);
    if (!isnan(h->as_given.y_length))
        h->height = in_metres(h->as_given.y_length, y);
    if (h->as_given.x_unit.given) {
        h->step_x = in_metres(h->as_given.x_step, x);
        h->step_y = in_metres(h->as_given.y_step, y);
    }
    if (isnan(h->z) && h->unit[0] == '\0' && !isnan(h->as_given.bit))
        h->z = in_metres(h->as_given.bit, 1e-9);
    if (h->as_given.scaled)
        h->z *= h->as_given.scale;
    if (isnan(h->z))
        h->z = h->factor;
}

void
rc_ascii_read_head(struct rc_ascii_head *h, struct rc_lines *lines)
{
    struct rc_lines ahead = *lines;
    const char *line;
    size_t n;

    *h = (struct rc_ascii_head){.width = NAN,
                                .height = NAN,
                                .pixel = NAN,
                                .step_x = NAN,
                                .step_y = NAN,
                                .z = NAN,
                                .factor = NAN,
                                .as_given = {.x_length = NAN,
                                             .y_length = NAN,
                                             .x_step = NAN,
                                             .y_step = NAN,
                                             .bit = NAN,
                                             .scale = NAN}};
    while (rc_lines_next(&ahead, &line, &n) && take_line(h, line, n))
        *lines = ahead;
    take_by_shape(h);
    join_units(h);
}
