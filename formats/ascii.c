/*
 * A matrix of heights as text, with or without a header. Headers that are understood:
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
 *     # x-pixels = 4                  SPIP; lengths in nm
 *     # x-length = 640.0
 *     # Bit2nm = 1.0
 *
 *     \Scan Size: 10 10 um            NanoScope export of one image
 *     \Exported image units: nm
 *
 * Two columns whose first rises, and three columns of which two run through a raster, are taken
 * for profiles and lists of points and refused, unless a header says that they are a matrix.
 */
#include <math.h>
#include <string.h>

#include "rows.h"

struct piece {
    const char *text;
    size_t n;
};

/* One `# key: value` line, by what its value looks like. */
struct comment {
    struct piece value;
    double length;  /* a number with a unit of length, in m; NAN: something else  */
};

struct header {
    bool known; /* at least one line was understood                                  */
    struct piece channel;
    double width, height, pixel; /* m, NAN when not given                            */
    double z, factor;            /* m per number, by unit and by factor; NAN likewise */
    char unit[16];               /* of the numbers when it is no length              */
    size_t nx, ny;               /* 0 when not given                                 */
    size_t comments;
    struct comment comment[4];
};

enum kind {
    CHANNEL,
    WIDTH,
    HEIGHT,
    VALUE_UNIT,
    PIXEL,
    FACTOR,
    COLUMNS,
    ROWS,
    WIDTH_NM,
    HEIGHT_NM,
    FACTOR_NM,
    SCAN_SIZE,
};

static const struct {
    const char *key; /* in lower case */
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
    {"x-length", WIDTH_NM},
    {"y-length", HEIGHT_NM},
    {"bit2nm", FACTOR_NM},
    {"scan size", SCAN_SIZE},
    {"exported image units", VALUE_UNIT},
};

/* ---- values of a header ---- */

/* The number at the start of a value and what follows it; header numbers have the decimal mark of
 * whoever exported them. */
static bool
leading_number(struct piece *p, double *value)
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

/* "10.00 µm" in metres, NAN when it is no such thing. */
static double
length_of(struct piece p)
{
    double value, unit;

    return leading_number(&p, &value) && rc_length_unit(p.text, p.n, &unit)
               ? in_metres(value, unit)
               : NAN;
}

static double
number_of(struct piece p)
{
    double value;

    return leading_number(&p, &value) && p.n == 0 ? value : NAN;
}

static size_t
count_of(struct piece p)
{
    double value = number_of(p);

    return value >= 1 && value <= 1e15 && value == floor(value) ? (size_t)value : 0;
}

/* "10 10 um", or one number for both. */
static void
take_scan_size(struct header *h, struct piece p)
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
take_unit(struct header *h, struct piece p)
{
    rc_text_clean(h->unit, sizeof h->unit, p.text, p.n);
    if (rc_length_unit(p.text, p.n, &h->z))
        h->unit[0] = '\0';
}

static void
take(struct header *h, enum kind kind, struct piece value)
{
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
    case WIDTH_NM:
        h->width = in_metres(number_of(value), 1e-9);
        break;
    case HEIGHT_NM:
        h->height = in_metres(number_of(value), 1e-9);
        break;
    case FACTOR_NM:
        h->factor = in_metres(number_of(value), 1e-9);
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

static bool
key_is(const char *key, const char *s, size_t n)
{
    if (strlen(key) != n)
        return false;
    for (size_t k = 0; k < n; k++)
        if ((s[k] >= 'A' && s[k] <= 'Z' ? s[k] + ('a' - 'A') : s[k]) != key[k])
            return false;
    return true;
}

/* `key: value` or `key=value`; whether the key is one of ours. */
static bool
take_entry(struct header *h, const char *s, size_t n, struct piece *value)
{
    size_t width, key_n;
    const char *mark = find_mark(s, n, &width);

    *value = (struct piece){s, 0};
    if (mark == NULL)
        return false;
    value->text = mark + width;
    value->n = n - (size_t)(value->text - s);
    rc_trim(&value->text, &value->n);
    key_n = (size_t)(mark - s);
    rc_trim(&s, &key_n);
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
        if (key_is(keys[k].key, s, key_n)) {
            take(h, keys[k].kind, *value);
            h->known = true;
            return true;
        }
    return false;
}

/* Several `key=value` without white space on one line: "h=305 w=75". */
static bool
take_words(struct header *h, const char *s, size_t n)
{
    struct piece value;
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
remember(struct header *h, struct piece value)
{
    if (h->comments < sizeof h->comment / sizeof *h->comment)
        h->comment[h->comments] = (struct comment){value, length_of(value)};
    h->comments++;
}

/* Whether the line belongs to the header. */
static bool
take_line(struct header *h, const char *s, size_t n)
{
    struct piece value;

    rc_trim(&s, &n);
    if (n == 0)
        return true;
    if (*s == '#' || *s == '%') {
        while (n > 0 && (*s == '#' || *s == '%'))
            s++, n--;
        rc_trim(&s, &n);
        take_entry(h, s, n, &value);
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
    if (*s >= 'A')
        return take_entry(h, s, n, &value) && (n < 2 || s[1] != '=' || take_words(h, s, n));
    return false;
}

/* Gwyddion writes its header in the user's language: four lines, of which the second and third are
 * lengths and the last is a unit. */
static void
take_by_shape(struct header *h)
{
    const struct comment *c = h->comment;

    if (h->comments != 4 || !isnan(h->width) || !isnan(h->height) || isnan(c[1].length) ||
        isnan(c[2].length) || !isnan(c[0].length) || !isnan(c[3].length))
        return;
    h->known = true;
    h->channel = c[0].value;
    h->width = c[1].length;
    h->height = c[2].length;
    take_unit(h, c[3].value);
}

static void
read_header(struct header *h, struct rc_lines *lines)
{
    struct rc_lines ahead = *lines;
    const char *line;
    size_t n;

    *h = (struct header){
        .width = NAN, .height = NAN, .pixel = NAN, .z = NAN, .factor = NAN};
    while (rc_lines_next(&ahead, &line, &n) && take_line(h, line, n))
        *lines = ahead;
    take_by_shape(h);
    if (isnan(h->z))
        h->z = h->factor;
}

/* ---- the matrix ---- */

static enum rc_status
ascii_open(const struct rc_file *file, const struct rc_wish *wish, struct header *h,
           struct rc_rows *rows, struct rc_err *err)
{
    const char *text = (const char *)file->data;
    struct rc_lines lines = {.at = text, .end = text + file->size};

    *h = (struct header){0};
    if (file->size >= 2 && (memcmp(text, "\xff\xfe", 2) == 0 || memcmp(text, "\xfe\xff", 2) == 0))
        return rc_err_set(err, "the text is UTF-16: convert it first (iconv -f UTF-16 -t UTF-8)");
    if (file->size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0)
        lines.at += 3;
    read_header(h, &lines);
    if (rc_rows_start(rows, &lines, wish, err) != RC_OK)
        return RC_FAIL;
    if ((h->nx != 0 && h->nx != rows->columns) || (h->ny != 0 && h->ny != rows->rows))
        return rc_err_set(err, "the header promises %zu columns and %zu rows, the file has %zu and "
                               "%zu", h->nx == 0 ? rows->columns : h->nx,
                          h->ny == 0 ? rows->rows : h->ny, rows->columns, rows->rows);
    if (rows->columns == 1)
        return rc_err_set(err, "%zu numbers in one column: that is a profile or a list, no matrix "
                               "(--format profile takes them for heights)", rows->rows);
    return RC_OK;
}

/* Spacing as the header has it, NAN where it does not say. */
static void
spacing(const struct header *h, const struct rc_rows *rows, double *dx, double *dy)
{
    *dx = isnan(h->pixel) ? h->width / (double)rows->columns : h->pixel;
    *dy = isnan(h->pixel) ? h->height / (double)rows->rows : h->pixel;
    if (isnan(*dy))
        *dy = *dx;
}

/* Whether a raster is run through: column `slow` keeps still while `fast` goes on in one direction,
 * then makes a step, always in one direction too. */
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
    return rests && slow_way != 0;
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
mind_coordinates(const struct header *h, const struct rc_rows *rows, const double *v,
                 struct rc_err *err)
{
    if (h->nx != 0 || !isnan(h->width) || !isnan(h->pixel))
        return RC_OK;
    if (rows->columns == 2 && is_rising(v, rows->rows))
        return rc_err_set(err, "two columns, of which the first rises: that is a profile (x, z), "
                               "no matrix; a header with a width would say otherwise");
    if (rows->columns == 3 &&
        (is_raster(v, rows->rows, 0, 1) || is_raster(v, rows->rows, 1, 0)))
        return rc_err_set(err, "three columns, of which two run through a raster: that is a list "
                               "of points (x, y, z), no matrix; a header with a width would say "
                               "otherwise");
    return RC_OK;
}

static enum rc_status
get_scales(const struct header *h, double dx, double dy, const struct rc_wish *wish,
           struct rc_shape *shape, double *metres, struct rc_notes *notes, struct rc_err *err)
{
    if (rc_spacing(wish, dx, dy, shape, notes, err) == RC_OK)
        return rc_height_unit(wish, h->z, h->unit, metres, notes, err);
    if (isnan(dx) && h->unit[0] == '\0')
        rc_lacks_unit(wish, h->z, err);
    return RC_FAIL;
}

static struct rc_grid *
read_matrix(const struct header *h, struct rc_rows *rows, const struct rc_wish *wish,
            struct rc_notes *notes, struct rc_err *err)
{
    struct rc_shape shape = {.nx = rows->columns, .ny = rows->rows, .dx = 1, .dy = 1};
    size_t n, bytes = (size_t)(rows->end - rows->start);
    struct rc_grid *g = NULL;
    double dx, dy, metres;

    if (rc_size_mul(shape.nx, shape.ny, &n, err) != RC_OK)
        return NULL;
    if (n > bytes + 1) { /* a value takes a byte at least, but for the last */
        rc_err_set(err, "%zu columns and %zu rows in %zu bytes: some row is too short", shape.nx,
                   shape.ny, bytes);
        return NULL;
    }
    if ((g = rc_grid_new(&shape, "height", "m", err)) == NULL)
        return NULL;
    spacing(h, rows, &dx, &dy);
    if (rc_rows_read(rows, g->v, err) != RC_OK ||
        mind_coordinates(h, rows, g->v, err) != RC_OK ||
        get_scales(h, dx, dy, wish, &shape, &metres, notes, err) != RC_OK ||
        rc_text_keep(g, "file.channel", h->channel.text, h->channel.n, err) != RC_OK) {
        rc_grid_free(g);
        return NULL;
    }
    g->dx = shape.dx;
    g->dy = shape.dy;
    for (size_t k = 0; k < n; k++) {
        bool missing = isnan(g->v[k]);

        g->v[k] *= metres;
        if (!missing && !isfinite(g->v[k])) {
            rc_err_set(err, "the height at column %zu, row %zu (from 0) is infinite", k % shape.nx,
                       k / shape.nx);
            rc_grid_free(g);
            return NULL;
        }
    }
    return g;
}

/* ---- the row ---- */

static const struct rc_wish no_wish = {.dx = NAN, .dy = NAN, .z_unit = NAN};

static int
ascii_score(const struct rc_file *file)
{
    size_t looked = file->size < 4096 ? file->size : 4096;
    struct rc_rows rows;
    struct header h;
    unsigned char c;

    if (file->size >= 2 && (memcmp(file->data, "\xff\xfe", 2) == 0 ||
                            memcmp(file->data, "\xfe\xff", 2) == 0))
        return 2;
    if (file->size == 0 || memchr(file->data, 0, looked) != NULL)
        return 0;
    if (ascii_open(file, &no_wish, &h, &rows, NULL) == RC_OK)
        return h.known ? 90 : 40;
    /* A little for what begins as numbers do, so that a refusal says what is wrong with them. */
    c = file->data[0];
    return h.known ? 30 : (c >= '0' && c <= '9') || c == '-' || c == ' ' ? 5 : 0;
}

static size_t
ascii_list(const struct rc_file *file, const struct rc_wish *wish, struct rc_channel *channel,
           size_t most, struct rc_err *err)
{
    struct rc_channel c = {.name = "height"};
    struct rc_rows rows;
    struct header h;

    if (ascii_open(file, wish, &h, &rows, err) != RC_OK)
        return 0;
    if (h.channel.n > 0)
        rc_text_clean(c.name, sizeof c.name, h.channel.text, h.channel.n);
    strcpy(c.unit, isnan(h.z) ? h.unit : "m");
    c.nx = rows.columns;
    c.ny = rows.rows;
    spacing(&h, &rows, &c.dx, &c.dy);
    if (most > 0)
        *channel = c;
    return 1;
}

static struct rc_grid *
ascii_read(const struct rc_file *file, const struct rc_wish *wish, size_t index,
           struct rc_notes *notes, struct rc_err *err)
{
    struct rc_rows rows;
    struct header h;

    if (ascii_open(file, wish, &h, &rows, err) != RC_OK)
        return NULL;
    if (index != 0) {
        rc_err_set(err, "a text matrix has one channel, not %zu", index + 1);
        return NULL;
    }
    return read_matrix(&h, &rows, wish, notes, err);
}

const struct rc_format rc_format_ascii = {
    .name = "ascii",
    .suffixes = ".txt .asc .csv",
    .summary = "matrix of heights as text, with or without a header",
    .score = ascii_score,
    .list = ascii_list,
    .read = ascii_read,
};
