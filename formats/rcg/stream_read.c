/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rcg.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

#include "stream_bytes.h"
#include "formats/core/core.h"

struct rc_reader {
    FILE *file;
    const struct rc_share *share; /* NULL: this process reads all values */
    size_t memory;
    rc_reader_allow *allow; /* NULL: none */
    void *allow_ctx;
    bool by_rows; /* heads come without memory for values; the rows of the last one: */
    size_t row, rows, left;
    enum rc_type type;
    off_t values;                  /* where its values begin; below 0: unknown */
    uint32_t crc_head;             /* checksum up to there                     */
    size_t first_case;             /* added to the case numbers of the stream being read */
    size_t last_case;              /* the largest one returned                           */
    size_t frames;                 /* since the last end line                            */
    bool ended;                    /* an end line was the last line                      */
    uint32_t crc;                  /* checksum of the frame so far                       */
    bool begun;                    /* a line of a stream was read                        */
    bool empty, foreign;           /* the input was empty, or not a stream               */
    char head[16];                 /* the first bytes of something foreign               */
    char failure[RC_FAIL_MAX + 1]; /* the message of RCGFAIL; empty: none yet            */
    int failure_status;
    char header[RC_HEADER_MAX];
};

struct rc_reader *
rc_reader_new(FILE *file, size_t first_case, size_t memory, struct rc_err *err)
{
    struct rc_reader *r = malloc(sizeof *r);

    if (r == NULL)
        return rc_err_null(err, "out of memory for a reader (%zu bytes)", sizeof *r);
    r->file = file;
    r->memory = memory;
    r->share = NULL;
    r->allow = NULL;
    r->allow_ctx = NULL;
    r->by_rows = false;
    r->row = r->rows = r->left = 0;
    r->first_case = r->last_case = first_case;
    r->frames = 0;
    r->ended = false;
    r->begun = r->empty = r->foreign = false;
    r->failure[0] = '\0';
    r->failure_status = 0;
    return r;
}

void
rc_reader_share(struct rc_reader *r, const struct rc_share *share)
{
    r->share = share;
}

void
rc_reader_ask(struct rc_reader *r, rc_reader_allow *allow, void *ctx)
{
    r->allow = allow;
    r->allow_ctx = ctx;
}

void
rc_reader_by_rows(struct rc_reader *r)
{
    r->by_rows = true;
}

void
rc_reader_free(struct rc_reader *r)
{
    free(r);
}

size_t
rc_reader_last_case(const struct rc_reader *r)
{
    return r->last_case;
}

/* The message for a stream that ends too early. */
static enum rc_status
cut_off(struct rc_reader *r, const char *where, struct rc_err *err)
{
    if (ferror(r->file))
        return rc_err_set(err, "reading failed (%s)", strerror(errno));
    return rc_err_set(err,
                      "the stream stops %s, %zu whole frames after its start: the program that "
                      "wrote it died or the file is cut off; run that program again",
                      where, r->frames);
}

/* Reads one line without its line feed and returns its length. -1: the input ends before any byte. -2: the
 * line has no end within `size` bytes. -3: the input ends inside it, or it contains NUL. */
static long
read_line(struct rc_reader *r, char *buffer, size_t size)
{
    size_t n = 0;
    int c;

    while ((c = getc(r->file)) != EOF) {
        if (c == '\0')
            return -3;
        if (n >= size || (c != '\n' && n + 1 == size))
            return -2;
        if (c == '\n') {
            buffer[n] = '\0';
            return (long)n;
        }
        buffer[n++] = (char)c;
    }
    return n == 0 ? -1 : -3;
}

/* A value with its escapes resolved in place; false for an escape that does not exist. */
static bool
unescape(char *s)
{
    char *to = s;

    for (; *s != '\0'; s++) {
        if (*s == '\\') {
            s++;
            if (*s != '\\' && *s != 'n')
                return false;
            *to++ = *s == 'n' ? '\n' : '\\';
        } else {
            *to++ = *s;
        }
    }
    *to = '\0';
    return true;
}

enum field {
    CHANNEL,
    NX,
    NY,
    DX,
    DY,
    UNIT,
    TYPE,
    FIELDS
};
static const char *const field_names[FIELDS] = {"channel", "nx", "ny", "dx", "dy", "unit", "type"};

struct head {
    char *field[FIELDS];            /* into the header buffer */
    char *extra[RC_HEADER_MAX / 3]; /* name, NUL, value; no line is shorter than 3 bytes */
    size_t extras;
};

static enum rc_status
add_line(struct head *head, char *line, struct rc_err *err)
{
    char *equals = strchr(line, '=');
    size_t most = sizeof head->extra / sizeof *head->extra;

    if (equals == NULL)
        return rc_err_set(err, "header line '%.60s' has no '='", line);
    *equals = '\0';
    if (!rc_key_valid(line))
        return rc_err_set(err, "header key '%.60s' is not of the form [a-z][a-z0-9._-]*", line);
    if (!unescape(equals + 1))
        return rc_err_set(
            err, "the value of header key '%.60s' has a backslash that is neither \\\\ nor \\n",
            line);
    if (!rc_utf8_valid(equals + 1))
        return rc_err_set(err, "the value of header key '%.60s' is not UTF-8", line);
    for (int f = 0; f < FIELDS; f++) {
        if (strcmp(line, field_names[f]) != 0)
            continue;
        if (head->field[f] != NULL)
            return rc_err_set(err, "header key '%s' occurs twice", line);
        head->field[f] = equals + 1;
        return RC_OK;
    }
    if (head->extras == most)
        return rc_err_set(err, "the header has more than %zu keys", most);
    head->extra[head->extras++] = line;
    return RC_OK;
}

/* The lines after the first one, up to the empty one. */
static enum rc_status
read_head(struct rc_reader *r, struct head *head, struct rc_err *err)
{
    char *at = r->header;
    size_t left = RC_HEADER_MAX - strlen("RCG1\n");

    for (;;) {
        long n = read_line(r, at, left);

        if (n == -1)
            return cut_off(r, "inside a header", err);
        if (n == -2)
            return rc_err_set(err, "the header is longer than %d bytes", RC_HEADER_MAX);
        if (n == -3)
            return feof(r->file) || ferror(r->file) ? cut_off(r, "inside a header", err)
                                                    : rc_err_set(err, "the header has a NUL byte");
        r->crc = rc_crc32_add(r->crc, at, (size_t)n);
        r->crc = rc_crc32_add(r->crc, "\n", 1);
        if (n == 0)
            return RC_OK;
        if (add_line(head, at, err) != RC_OK)
            return RC_FAIL;
        at += n + 1;
        left -= (size_t)n + 1;
    }
}

static enum rc_status
read_size(const char *name, const char *text, size_t *n, struct rc_err *err)
{
    char *end;
    uintmax_t value;

    errno = 0;
    value = strtoumax(text, &end, 10);
    if (*text < '0' || *text > '9' || *end != '\0' || value == 0)
        return rc_err_set(err, "%s=%.40s is not a whole number above 0", name, text);
    if (errno != 0 || value > SIZE_MAX)
        return rc_err_set(err, "%s=%.40s is more than this machine can address", name, text);
    *n = (size_t)value;
    return RC_OK;
}

static enum rc_status
read_spacing(const char *name, const char *text, double *d, struct rc_err *err)
{
    const char *end = rc_number_read(text, true, d);

    if (end == NULL || *end != '\0')
        return rc_err_set(err, "%s=%.40s is not a number", name, text);
    if (!(*d > 0) || isinf(*d))
        return rc_err_set(err, "spacing %s=%.40s m: it must be positive and finite", name, text);
    return RC_OK;
}

static enum rc_status
read_shape(const struct rc_reader *r, const struct head *head, struct rc_shape *shape,
           struct rc_err *err)
{
    size_t nodes, bytes;

    if (read_size("nx", head->field[NX], &shape->nx, err) != RC_OK ||
        read_size("ny", head->field[NY], &shape->ny, err) != RC_OK ||
        read_spacing("dx", head->field[DX], &shape->dx, err) != RC_OK ||
        read_spacing("dy", head->field[DY], &shape->dy, err) != RC_OK ||
        rc_size_mul(shape->nx, shape->ny, &nodes, err) != RC_OK ||
        rc_size_mul(nodes, sizeof(double), &bytes, err) != RC_OK)
        return RC_FAIL;
    if (r->by_rows)
        bytes = shape->nx * sizeof(double);
    if (r->memory != 0 && r->share == NULL && bytes > r->memory)
        return rc_err_set(err,
                          "a frame of %zu x %zu nodes needs %zu bytes, more than --memory allows",
                          shape->nx, shape->ny, bytes);
    if (r->share != NULL) {
        size_t first, rows;
        r->share->rows(r->share->ctx, shape, &first, &rows);
        bytes = shape->nx * rows * sizeof(double);
    }
    return r->allow == NULL ? RC_OK : r->allow(r->allow_ctx, shape, bytes, err);
}

static enum rc_status
set_keys(struct rc_grid *g, const struct head *head, struct rc_err *err)
{
    for (size_t k = 0; k < head->extras; k++) {
        const char *name = head->extra[k];

        if (rc_grid_get(g, name) != NULL)
            return rc_err_set(err, "header key '%.60s' occurs twice", name);
        if (rc_grid_set(g, name, name + strlen(name) + 1, err) != RC_OK)
            return RC_FAIL;
    }
    return RC_OK;
}

/* Continues the numbering of cases after earlier streams. */
static enum rc_status
number_case(struct rc_reader *r, struct rc_grid *g, struct rc_err *err)
{
    size_t number = rc_grid_case(g);

    if (number == 0)
        return rc_err_set(err, "case=%.40s is not a whole number from 1", rc_grid_get(g, "case"));
    number += r->first_case;
    if (r->first_case > 0 && rc_grid_set_number(g, "case", (double)number, err) != RC_OK)
        return RC_FAIL;
    if (number > r->last_case)
        r->last_case = number;
    return RC_OK;
}

/* The grid that a header describes, without values. */
static struct rc_grid *
grid_of_head(struct rc_reader *r, const struct head *head, struct rc_err *err)
{
    struct rc_shape shape;
    RC_OWN(rc_grid, g) = NULL;
    size_t first, rows;

    for (int f = 0; f < FIELDS; f++)
        if (head->field[f] == NULL)
            return rc_err_null(err, "the header has no %s= line", field_names[f]);
    if (read_shape(r, head, &shape, err) != RC_OK)
        return NULL;
    if (strcmp(head->field[TYPE], "f64") != 0 && strcmp(head->field[TYPE], "f32") != 0)
        return rc_err_null(err, "type=%.40s is neither f64 nor f32", head->field[TYPE]);
    rows = r->by_rows ? 0 : shape.ny;
    if (r->share != NULL)
        r->share->rows(r->share->ctx, &shape, &first, &rows);
    g = rc_grid_new_part(&shape, rows, head->field[CHANNEL], head->field[UNIT], err);
    if (g == NULL)
        return NULL;
    g->type = strcmp(head->field[TYPE], "f32") == 0 ? RC_F32 : RC_F64;
    r->type = g->type;
    r->row = g->nx;
    r->rows = r->left = g->ny;
    r->values = r->by_rows ? ftello(r->file) : -1;
    r->crc_head = r->crc;
    return set_keys(g, head, err) == RC_OK && number_case(r, g, err) == RC_OK ? rc_give(&g) : NULL;
}

static enum rc_status
read_f64(struct rc_reader *r, double *v, size_t n, struct rc_err *err)
{
    for (size_t m; n > 0; v += m, n -= m) {
        m = n < RC_PIECE ? n : RC_PIECE;
        if (fread(v, sizeof *v, m, r->file) != m)
            return cut_off(r, "inside the values of a frame", err);
        r->crc = rc_crc32_add(r->crc, v, m * sizeof *v);
        if (!rc_host_is_little())
            rc_swap_bytes(v, m, sizeof *v);
    }
    return RC_OK;
}

static enum rc_status
read_f32(struct rc_reader *r, double *v, size_t n, struct rc_err *err)
{
    float part[RC_CHUNK];

    while (n > 0) {
        size_t m = n < RC_CHUNK ? n : RC_CHUNK;
        if (fread(part, sizeof *part, m, r->file) != m)
            return cut_off(r, "inside the values of a frame", err);
        r->crc = rc_crc32_add(r->crc, part, m * sizeof *part);
        if (!rc_host_is_little())
            rc_swap_bytes(part, m, sizeof *part);
        for (size_t k = 0; k < m; k++)
            v[k] = (double)part[k];
        v += m;
        n -= m;
    }
    return RC_OK;
}

/* Reads the rows that this process holds from a file that all processes read. */
static enum rc_status
read_part(struct rc_reader *r, struct rc_grid *g, struct rc_err *err)
{
    const struct rc_share *share = r->share;
    size_t width = g->type == RC_F32 ? sizeof(float) : sizeof(double), nodes = rc_grid_nodes(g);
    const struct rc_shape shape = rc_grid_shape(g);
    const off_t at = ftello(r->file);
    /* values in single precision are read into the second half of the array of doubles */
    char *to = (char *)g->v + nodes * (sizeof *g->v - width);
    size_t first, rows;
    uint32_t crc;

    if (at < 0)
        return rc_err_set(err,
                          "several processes can read a file only, which this input is not (%s)",
                          strerror(errno));
    share->rows(share->ctx, &shape, &first, &rows);
    if (share->read(share->ctx, (uint64_t)at + first * g->nx * width, to, nodes * width, err) !=
        RC_OK)
        return RC_FAIL;
    crc = share->crc(share->ctx, rc_crc32_add(0, to, nodes * width), nodes * width);
    r->crc = rc_crc32_join(r->crc, crc, g->nx * g->ny * width);
    if (!rc_host_is_little())
        rc_swap_bytes(to, nodes, width);
    for (size_t k = 0; k < nodes && width < sizeof *g->v; k++) {
        float v;
        memcpy(&v, to + k * width, sizeof v);
        g->v[k] = (double)v;
    }
    if (fseeko(r->file, at + (off_t)(g->nx * g->ny * width), SEEK_SET) != 0)
        return rc_err_set(err, "reading failed (%s)", strerror(errno));
    return RC_OK;
}

static enum rc_status
read_values(struct rc_reader *r, struct rc_grid *g, struct rc_err *err)
{
    if (r->share != NULL)
        return read_part(r, g, err);
    return (g->type == RC_F32 ? read_f32 : read_f64)(r, g->v, g->nx * g->ny, err);
}

/* The line after the values of a frame; `compare` it with their checksum. */
static enum rc_status
read_crc(struct rc_reader *r, bool compare, struct rc_err *err)
{
    char line[32], wanted[32];
    long n = read_line(r, line, sizeof line);

    if (n == -1 || (n < 0 && (feof(r->file) || ferror(r->file))))
        return cut_off(r, "before the checksum of a frame", err);
    snprintf(wanted, sizeof wanted, "crc32 %08" PRIx32, r->crc);
    if (n < 0 || strncmp(line, "crc32 ", 6) != 0 || strlen(line) != strlen(wanted))
        return rc_err_set(
            err,
            "no crc32 line follows the values: nx, ny or type in the header do not match the data");
    if (compare && strcmp(line, wanted) != 0)
        return rc_err_set(
            err,
            "the checksum is %s, but that of the data is %s: the stream is damaged; make it again",
            line + 6, wanted + 6);
    return RC_OK;
}

/* If one of several processes lacks the memory for its rows, the others must not wait for it. */
static enum rc_status
agree(const struct rc_reader *r, enum rc_status status, struct rc_err *err)
{
    return r->share == NULL ? status : r->share->agree(r->share->ctx, status, err);
}

/* A grid without values yet. */
static enum rc_status
read_frame(struct rc_reader *r, struct rc_grid **grid, struct rc_err *err)
{
    RC_OWNED struct head *head = calloc(1, sizeof *head);
    RC_OWN(rc_grid, g) = NULL;

    r->crc = rc_crc32_add(0, "RCG1\n", 5);
    if (head == NULL)
        rc_err_set(err, "out of memory for a header (%zu bytes)", sizeof *head);
    else if (read_head(r, head, err) == RC_OK)
        g = grid_of_head(r, head, err);
    if (agree(r, g == NULL ? RC_FAIL : RC_OK, err) != RC_OK || g == NULL)
        return RC_FAIL;
    *grid = rc_give(&g);
    return RC_MORE;
}

static enum rc_status
end_frame(struct rc_reader *r, bool compare, struct rc_err *err)
{
    if (read_crc(r, compare, err) != RC_OK)
        return RC_FAIL;
    r->left = 0;
    r->frames++;
    r->ended = false;
    return RC_OK;
}

enum rc_status
rc_reader_values(struct rc_reader *r, struct rc_grid *g, struct rc_err *err)
{
    return read_values(r, g, err) == RC_OK ? end_frame(r, true, err) : RC_FAIL;
}

size_t
rc_reader_left(const struct rc_reader *r)
{
    return r->left;
}

enum rc_status
rc_reader_skip(struct rc_reader *r, struct rc_err *err)
{
    const size_t width = r->type == RC_F32 ? sizeof(float) : sizeof(double);

    if (fseeko(r->file, (off_t)(r->left * r->row * width), SEEK_CUR) != 0)
        return rc_err_set(err, "reading failed (%s)", strerror(errno));
    return end_frame(r, false, err);
}

enum rc_status
rc_reader_again(struct rc_reader *r, struct rc_err *err)
{
    if (r->values < 0 || fseeko(r->file, r->values, SEEK_SET) != 0)
        return rc_err_set(err, "the input cannot be read twice (%s)", strerror(errno));
    r->frames -= r->left == 0 ? 1 : 0;
    r->left = r->rows;
    r->crc = r->crc_head;
    return RC_OK;
}

enum rc_status
rc_reader_rows(struct rc_reader *r, size_t n, double *v, struct rc_err *err)
{
    if ((r->type == RC_F32 ? read_f32 : read_f64)(r, v, n * r->row, err) != RC_OK)
        return RC_FAIL;
    r->left -= n;
    return r->left == 0 ? end_frame(r, true, err) : RC_OK;
}

static enum rc_status
read_end(struct rc_reader *r, const char *count, struct rc_err *err)
{
    char wanted[32];

    snprintf(wanted, sizeof wanted, "%zu", r->frames);
    if (strcmp(count, wanted) != 0)
        return rc_err_set(err, "the end line counts %.20s frames, %s were read: frames are missing",
                          count, wanted);
    r->frames = 0;
    r->ended = true;
    r->first_case = r->last_case;
    return RC_OK;
}

/* The message after RCGFAIL, safe for terminals, and the exit status at its end. */
static enum rc_status
read_failure(struct rc_reader *r, const char *text, struct rc_err *err)
{
    size_t tail = strlen(RC_FAIL_STATUS "2)"), n;

    snprintf(r->failure, sizeof r->failure, "%.*s", RC_FAIL_MAX, text[0] == ' ' ? text + 1 : text);
    for (char *s = r->failure; *s != '\0'; s++)
        if ((unsigned char)*s < 0x20 || *s == 0x7f)
            *s = '?';
    n = strlen(r->failure);
    r->failure_status = 1;
    if (n >= tail && strcmp(r->failure + n - tail, RC_FAIL_STATUS "2)") == 0) {
        r->failure_status = 2;
        r->failure[n - tail] = '\0';
    }
    if (r->failure[0] == '\0')
        strcpy(r->failure, "without a message");
    return rc_err_set(err, "the program that wrote this stream failed: %s", r->failure);
}

const char *
rc_reader_failure(const struct rc_reader *r, int *exit_status)
{
    *exit_status = r->failure_status;
    return r->failure[0] == '\0' ? NULL : r->failure;
}

/* True if `text` is the word or a beginning of it. */
static bool
begins(const char *word, const char *text)
{
    return strncmp(word, text, strlen(text)) == 0;
}

/* True if the first line, of length n (see read_line), begins a stream. */
static void
look_at_first(struct rc_reader *r, const char *line, long n)
{
    if (r->begun || ferror(r->file))
        return;
    snprintf(r->head, sizeof r->head, "%.15s", line);
    r->empty = n == -1;
    if (n >= 0)
        r->foreign = strcmp(line, "RCG1") != 0 && strncmp(line, "RCGFAIL", 7) != 0 &&
                     strncmp(line, "RCGEND ", 7) != 0;
    else /* "RC" may be a truncated line */
        r->foreign = r->head[0] == '\0' || !(begins("RCG1", r->head) || begins("RCGEND ", r->head));
    r->begun = !r->foreign;
}

bool
rc_reader_foreign(const struct rc_reader *r, const char **head)
{
    *head = r->empty ? NULL : r->head;
    return r->foreign;
}

enum rc_status
rc_reader_head(struct rc_reader *r, struct rc_grid **grid, struct rc_err *err)
{
    char line[1024];

    *grid = NULL;
    for (;;) {
        long n;

        memset(line, 0, sizeof r->head);
        n = read_line(r, line, sizeof line);
        look_at_first(r, line, n);
        if (n == -1) {
            if (r->ended && !ferror(r->file))
                return RC_OK;
            return cut_off(
                r, r->frames == 0 && !r->ended ? "before it begins" : "without an end line", err);
        }
        if (n < 0)
            return n == -3 && (feof(r->file) || ferror(r->file))
                       ? cut_off(r, "inside a line", err)
                       : rc_err_set(err, "this is not a grid stream: no RCG1 line at its start");
        if (strcmp(line, "RCG1") == 0)
            return read_frame(r, grid, err);
        if (strncmp(line, "RCGFAIL", 7) == 0)
            return read_failure(r, line + 7, err);
        if (strncmp(line, "RCGEND ", 7) != 0)
            return rc_err_set(err,
                              "'%.40s' is in place of a frame or an end line: this is not a grid "
                              "stream, or it is damaged",
                              line);
        if (read_end(r, line + 7, err) != RC_OK)
            return RC_FAIL;
    }
}

enum rc_status
rc_reader_next(struct rc_reader *r, struct rc_grid **grid, struct rc_err *err)
{
    enum rc_status status = rc_reader_head(r, grid, err);

    if (status != RC_MORE || rc_reader_values(r, *grid, err) == RC_OK)
        return status;
    rc_grid_free(*grid);
    *grid = NULL;
    return RC_FAIL;
}
