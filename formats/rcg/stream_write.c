/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rcg.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "stream_bytes.h"
#include "formats/core/core.h"

struct rc_writer {
    FILE *file;                   /* NULL: several processes write */
    const struct rc_share *share; /* with several processes; position of the next byte */
    uint64_t at;
    size_t frames;
    enum rc_type
        type; /* of the frame that is being written: its values to come, and its checksum */
    size_t left;
    uint32_t crc;
};

struct rc_writer *
rc_writer_new(FILE *file, struct rc_err *err)
{
    struct rc_writer *w = malloc(sizeof *w);

    if (w == NULL)
        return rc_err_null(err, "out of memory for a writer (%zu bytes)", sizeof *w);
    *w = (struct rc_writer){.file = file};
    return w;
}

struct rc_writer *
rc_writer_new_shared(const struct rc_share *share, uint64_t at, struct rc_err *err)
{
    struct rc_writer *w = rc_writer_new(NULL, err);

    if (w != NULL) {
        w->share = share;
        w->at = at;
    }
    return w;
}

void
rc_writer_free(struct rc_writer *w)
{
    free(w);
}

/* The header in work: text[n] is the next free byte; `full` when it did not fit. */
struct text {
    char text[RC_HEADER_MAX];
    size_t n;
    bool full;
};

static void
put_char(struct text *t, char c)
{
    if (t->n == sizeof t->text)
        t->full = true;
    else
        t->text[t->n++] = c;
}

static void
put_line(struct text *t, const char *name, const char *value)
{
    while (*name != '\0')
        put_char(t, *name++);
    put_char(t, '=');
    for (; *value != '\0'; value++) {
        if (*value == '\\' || *value == '\n')
            put_char(t, '\\');
        put_char(t, *value == '\n' ? 'n' : *value);
    }
    put_char(t, '\n');
}

static void
put_number(struct text *t, const char *name, double value)
{
    put_line(t, name, rc_number(value));
}

static void
put_count(struct text *t, const char *name, size_t n)
{
    char digits[32];

    snprintf(digits, sizeof digits, "%zu", n);
    put_line(t, name, digits);
}

static uint32_t
write_f64(FILE *file, const double *v, size_t n, uint32_t crc)
{
    bool as_it_is = rc_host_is_little();
    double part[RC_PIECE];

    for (size_t m; n > 0; v += m, n -= m) {
        const double *piece = v;

        m = n < RC_PIECE ? n : RC_PIECE;
        if (!as_it_is) {
            memcpy(part, v, m * sizeof *v);
            rc_swap_bytes(part, m, sizeof *part);
            piece = part;
        }
        crc = rc_crc32_add(crc, piece, m * sizeof *piece);
        fwrite(piece, sizeof *piece, m, file);
    }
    return crc;
}

static uint32_t
write_f32(FILE *file, const double *v, size_t n, uint32_t crc)
{
    float part[RC_CHUNK];

    for (; n > 0; v += RC_CHUNK) {
        size_t m = n < RC_CHUNK ? n : RC_CHUNK;
        for (size_t k = 0; k < m; k++)
            part[k] = (float)v[k];
        if (!rc_host_is_little())
            rc_swap_bytes(part, m, sizeof *part);
        fwrite(part, sizeof *part, m, file);
        crc = rc_crc32_add(crc, part, m * sizeof *part);
        n -= m;
    }
    return crc;
}

/* ---- a file written by several processes ---- */

/* Writes the bytes between values, which are the same in all processes: the first process writes them. */
static enum rc_status
write_text(struct rc_writer *w, const char *text, size_t n, struct rc_err *err)
{
    const struct rc_share *share = w->share;

    if (share->write(share->ctx, w->at, text, share->first ? n : 0, err) != RC_OK)
        return RC_FAIL;
    w->at += n;
    return RC_OK;
}

/* Sets *own to the values of this process as stored in the file; NULL if g->v can be written directly. */
static enum rc_status
as_stored(const struct rc_grid *g, void **own, struct rc_err *err)
{
    size_t n = rc_grid_nodes(g), width = g->type == RC_F32 ? sizeof(float) : sizeof(double);
    char *to;

    *own = NULL;
    if (g->type == RC_F64 && rc_host_is_little())
        return RC_OK;
    if ((*own = to = malloc(n * width + 1)) == NULL)
        return rc_err_set(err, "out of memory for the %zu values of a frame", n);
    for (size_t k = 0; k < n; k++) {
        float v = (float)g->v[k];
        memcpy(to + k * width, g->type == RC_F32 ? (const void *)&v : &g->v[k], width);
    }
    if (!rc_host_is_little())
        rc_swap_bytes(to, n, width);
    return RC_OK;
}

static enum rc_status
put_shared(struct rc_writer *w, const struct text *t, const struct rc_grid *g, struct rc_err *err)
{
    const struct rc_share *share = w->share;
    const struct rc_shape shape = rc_grid_shape(g);
    size_t width = g->type == RC_F32 ? sizeof(float) : sizeof(double), first, rows;
    size_t bytes = rc_grid_nodes(g) * width, all = g->nx * g->ny * width;
    RC_OWNED void *own = NULL;
    const void *from;
    char line[32];
    uint32_t crc;

    share->rows(share->ctx, &shape, &first, &rows);
    if (share->agree(share->ctx, as_stored(g, &own, err), err) != RC_OK)
        return RC_FAIL;
    from = own == NULL ? g->v : own;
    crc = share->crc(share->ctx, rc_crc32_add(0, from, bytes), bytes);
    crc = rc_crc32_join(rc_crc32_add(0, t->text, t->n), crc, all);
    if (write_text(w, t->text, t->n, err) != RC_OK ||
        share->write(share->ctx, w->at + first * g->nx * width, from, bytes, err) != RC_OK)
        return RC_FAIL;
    w->at += all;
    snprintf(line, sizeof line, "crc32 %08" PRIx32 "\n", crc);
    return write_text(w, line, strlen(line), err);
}

/* ---- frames ---- */

/* The header of a frame; the caller frees it. NULL on failure, with several processes on all of them. */
static struct text *
header(const struct rc_writer *w, const struct rc_grid *g, struct rc_err *err)
{
    RC_OWNED struct text *t = malloc(sizeof *t);
    enum rc_status status = RC_OK;

    if (t == NULL)
        status = rc_err_set(err, "out of memory for a header (%zu bytes)", sizeof *t);
    if (w->share != NULL)
        status = w->share->agree(w->share->ctx, status, err);
    if (t == NULL || status != RC_OK)
        return NULL;
    t->n = 0;
    t->full = false;
    for (const char *s = "RCG1\n"; *s != '\0'; s++)
        put_char(t, *s);
    put_line(t, "channel", g->channel);
    put_count(t, "nx", g->nx);
    put_count(t, "ny", g->ny);
    put_number(t, "dx", g->dx);
    put_number(t, "dy", g->dy);
    put_line(t, "unit", g->unit);
    put_line(t, "type", g->type == RC_F32 ? "f32" : "f64");
    for (size_t k = 0; k < g->keys; k++)
        put_line(t, g->key[k].name, g->key[k].value);
    put_char(t, '\n');
    if (t->full)
        return rc_err_null(
            err,
            "the header of a frame would be longer than %d bytes: its keys carry too much text",
            RC_HEADER_MAX);
    return rc_give(&t);
}

enum rc_status
rc_writer_begin(struct rc_writer *w, const struct rc_grid *g, struct rc_err *err)
{
    RC_OWNED struct text *t = header(w, g, err);

    if (t == NULL)
        return RC_FAIL;
    fwrite(t->text, 1, t->n, w->file);
    w->crc = rc_crc32_add(0, t->text, t->n);
    w->type = g->type;
    w->left = g->nx * g->ny;
    return ferror(w->file) ? rc_put_failed(err) : RC_OK;
}

enum rc_status
rc_writer_values(struct rc_writer *w, const double *v, size_t n, struct rc_err *err)
{
    w->crc = (w->type == RC_F32 ? write_f32 : write_f64)(w->file, v, n, w->crc);
    w->left -= n;
    if (w->left == 0) {
        fprintf(w->file, "crc32 %08" PRIx32 "\n", w->crc);
        w->frames++;
    }
    return ferror(w->file) ? rc_put_failed(err) : RC_OK;
}

enum rc_status
rc_writer_put(struct rc_writer *w, const struct rc_grid *g, struct rc_err *err)
{
    if (w->share != NULL) {
        RC_OWNED struct text *t = header(w, g, err);
        if (t == NULL || put_shared(w, t, g, err) != RC_OK)
            return RC_FAIL;
        w->frames++;
        return RC_OK;
    }
    return rc_writer_begin(w, g, err) == RC_OK ? rc_writer_values(w, g->v, g->nx * g->ny, err)
                                               : RC_FAIL;
}

enum rc_status
rc_writer_end(struct rc_writer *w, struct rc_err *err)
{
    char line[32];

    if (w->share != NULL) {
        snprintf(line, sizeof line, "RCGEND %zu\n", w->frames);
        return write_text(w, line, strlen(line), err);
    }
    fprintf(w->file, "RCGEND %zu\n", w->frames);
    return fflush(w->file) != 0 || ferror(w->file) ? rc_put_failed(err) : RC_OK;
}

void
rc_stream_fail(FILE *file, const char *message, int exit_status)
{
    char tail[32] = "", text[RC_FAIL_MAX + 1];
    bool valid = rc_utf8_valid(message);
    size_t n = 0, most;

    if (exit_status != 1)
        snprintf(tail, sizeof tail, RC_FAIL_STATUS "%d)", exit_status);
    most = RC_FAIL_MAX - strlen(tail);
    for (const char *s = message; *s != '\0' && n < most; s++) {
        unsigned char c = (unsigned char)*s;
        text[n++] = c < 0x20 || c == 0x7f ? ' ' : c >= 0x80 && !valid ? '?' : *s;
    }
    if (valid && n < strlen(message)) /* no partial character at the end */
        while (n > 0 && ((unsigned char)message[n] & 0xc0) == 0x80)
            n--;
    text[n] = '\0';
    fprintf(file, "RCGFAIL %s%s\n", text, tail);
    fflush(file);
}
