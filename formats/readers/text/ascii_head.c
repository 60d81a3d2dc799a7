#include "ascii_head.h"

#include <math.h>
#include <string.h>

enum kind {
    CHANNEL,
    WIDTH,
    HEIGHT,
    VALUE_UNIT,
    PIXEL,
    FACTOR,
    COLUMNS,
    ROWS,
    X_LENGTH,
    Y_LENGTH,
    X_UNIT,
    Y_UNIT,
    Z_UNIT,
    X_STEP,
    Y_STEP,
    BIT_NM,
    SCALE,
    SCALED,
    SCAN_SIZE,
    SEPARATOR,
    ANY_LINE,
    RANGE,
};

static const struct {
    const char *key; /* in either case */
    enum kind kind;
} keys[] = {
    {"channel", CHANNEL},
    {"width", WIDTH},
    {"height", HEIGHT},
    {"value units", VALUE_UNIT},
    {"pixel size", PIXEL},
    {"data unit", VALUE_UNIT},
    {"height conversion factor (-> m)", FACTOR},
    {"h", ROWS},
    {"w", COLUMNS},
    {"x-pixels", COLUMNS},
    {"y-pixels", ROWS},
    {"x-length", X_LENGTH},
    {"y-length", Y_LENGTH},
    {"x-unit", X_UNIT},
    {"y-unit", Y_UNIT},
    {"z-unit", Z_UNIT},
    {"display", CHANNEL},
    {"bit2nm", BIT_NM},
    {"file format", ANY_LINE},
    {"nx", COLUMNS},
    {"ny", ROWS},
    {"scale x", X_STEP},
    {"scale y", Y_STEP},
    {"unit x", X_UNIT},
    {"unit y", Y_UNIT},
    {"unit data", VALUE_UNIT},
    {"scale data", SCALE},
    {"datascaleneeded", SCALED},
    {"scan size", SCAN_SIZE},
    {"exported image units", VALUE_UNIT},
    {"sep", SEPARATOR},
    {"x amplitude", WIDTH},
    {"y amplitude", HEIGHT},
    {"z amplitude", RANGE},
};

/* Whether profiles and lists of points have such lines too. */
static bool
is_anywhere(enum kind kind)
{
    return kind == X_UNIT || kind == Y_UNIT || kind == Z_UNIT || kind == SEPARATOR;
}

/* ---- values of a header ---- */

/* The number at the start of a value and what follows it; header numbers have the decimal mark of
 * whoever exported them. */
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

static void
take(struct rc_ascii_head *h, enum kind kind, struct rc_piece value)
{
    double range;

    switch (kind) {
    case CHANNEL:
        h->channel = value;
        break;
    case WIDTH:
        h->width = length_of(value);
        break;
    case HEIGHT:
        h->height = length_of(value);
        break;
    case VALUE_UNIT:
    case Z_UNIT:
        take_unit(h, value);
        break;
    case PIXEL:
        h->pixel = length_of(value);
        break;
    case FACTOR:
        h->factor = number_of(value);
        break;
    case COLUMNS:
        h->nx = count_of(value);
        break;
    case ROWS:
        h->ny = count_of(value);
        break;
    case X_LENGTH:
        h->width = length_of(value);
        h->as_given.x_length = number_of(value);
        break;
    case Y_LENGTH:
        h->height = length_of(value);
        h->as_given.y_length = number_of(value);
        break;
    case X_UNIT:
        h->as_given.has_x_unit = true;
        h->as_given.x_unit = rc_piece_metres(rc_piece_bare(value));
        break;
    case Y_UNIT:
        h->as_given.has_y_unit = true;
        h->as_given.y_unit = rc_piece_metres(rc_piece_bare(value));
        break;
    case X_STEP:
        h->as_given.x_step = number_of(value);
        break;
    case Y_STEP:
        h->as_given.y_step = number_of(value);
        break;
    case BIT_NM:
        h->as_given.bit = number_of(value);
        break;
    case SCALE:
        h->as_given.scale = number_of(value);
        break;
    case SCALED:
        h->as_given.scaled = !rc_piece_is(value, "no");
        break;
    case SCAN_SIZE:
        take_scan_size(h, value);
        break;
    case SEPARATOR:
        if (value.n == 1)
            h->separator[0] = *value.text;
        break;
    case ANY_LINE:
        h->any_line = true;
        break;
    case RANGE:
        if (leading_number(&value, &range))
            take_unit(h, value);
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

    *value = (struct rc_piece){s, 0};
    if (mark == NULL)
        return false;
    value->text = mark + width;
    value->n = n - (size_t)(value->text - s);
    rc_trim(&value->text, &value->n);
    key = rc_piece_trim((struct rc_piece){s, (size_t)(mark - s)});
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
        if (rc_piece_is(key, keys[k].key)) {
            take(h, keys[k].kind, *value);
            h->known = h->known || !is_anywhere(keys[k].kind);
            return true;
        }
    return false;
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

/* Whether the line belongs to the header. */
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
        h->any_line = false; /* that is for headers whose lines have no mark */
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

/* Gwyddion writes its header in the user's language: four lines, of which the second and third are
 * lengths and the last is a unit. */
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
    double x = h->as_given.has_x_unit ? h->as_given.x_unit : 1e-9;
    double y = h->as_given.has_y_unit ? h->as_given.y_unit : x;

    if (!isnan(h->as_given.x_length))
        h->width = in_metres(h->as_given.x_length, x);
    if (!isnan(h->as_given.y_length))
        h->height = in_metres(h->as_given.y_length, y);
    if (h->as_given.has_x_unit) {
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
