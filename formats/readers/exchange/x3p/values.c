/* SPDX-License-Identifier: GPL-3.0-or-later */
/* X3P: heights, valid points and checksums. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "x3p_internal.h"

enum {
    MD5_FILE_MOST = 4096, /* bytes of md5checksum.hex                             */
    MASK_PADDING = 7      /* bytes that a writer may round the valid points up by */
};

/* The member that a link in main.xml names. */
static enum rc_status
follow(const struct rc_x3p *x, const char *link, size_t *member, struct rc_err *err)
{
    char name[RC_X3P_NAME];
    size_t n = strlen(x->prefix);

    if (strncmp(link, "./", 2) == 0)
        link += 2;
    if (n + strlen(link) >= sizeof name)
        return rc_err_set(err, "main.xml names a member with a name of %zu bytes", strlen(link));
    memcpy(name, x->prefix, n);
    strcpy(name + n, link);
    for (char *s = name; *s != '\0'; s++)
        if (*s == '\\')
            *s = '/';
    return rc_zip_read_find(x->archive, name, member, err);
}

/* ---- checksums ---- */

/* True if main.xml has the element and something in it. */
static bool
is_given(const char *text)
{
    return text != NULL && *text != '\0';
}

/* The MD5 checksum at the beginning of the text, in lower case. Returns false if there is none. */
static bool
md5_in(const char *text, char md5[RC_MD5_TEXT])
{
    size_t n = strspn(text, "0123456789abcdefABCDEF");

    if (n != RC_MD5_TEXT - 1)
        return false;
    for (size_t k = 0; k < n; k++)
        md5[k] = (char)(text[k] >= 'A' && text[k] <= 'F' ? text[k] + ('a' - 'A') : text[k]);
    md5[n] = '\0';
    return true;
}

/* Compares the checksum in main.xml with the checksum of the bytes. */
static enum rc_status
compare_md5(const char *what, const char *given, const char *md5, struct rc_notes *notes,
            struct rc_err *err)
{
    char wanted[RC_MD5_TEXT];

    if (!md5_in(given, wanted)) {
        rc_note(notes, "'%s' is no MD5 sum: the %s are not checked", rc_word_shown(given), what);
        return RC_OK;
    }
    if (strcmp(wanted, md5) == 0)
        return RC_OK;
    return rc_err_set(err, "the %s are damaged: their MD5 sum is %s, main.xml says %s", what, md5,
                      wanted);
}

void
rc_x3p_check_main(struct rc_x3p *x, struct rc_notes *notes)
{
    const char *link = x->text[RC_X3P_MD5_FILE];
    RC_OWNED unsigned char *bytes = NULL;
    char wanted[RC_MD5_TEXT];
    struct rc_err err;
    size_t member, n;

    if (!is_given(link))
        link = "md5checksum.hex";
    if (follow(x, link, &member, NULL) != RC_OK) {
        rc_note(notes, "the file has no md5checksum.hex: main.xml is not checked");
        return;
    }
    bytes = rc_zip_read_bytes(x->archive, member, MD5_FILE_MOST, &n, NULL, &err);
    if (bytes == NULL) {
        rc_note(notes, "main.xml is not checked: %s", err.text);
        return;
    }
    if (!md5_in((const char *)bytes, wanted))
        rc_note(notes, "md5checksum.hex has no MD5 sum: main.xml is not checked");
    else if (strcmp(wanted, x->md5) != 0)
        rc_note(notes,
                "main.xml was changed after its checksum was written: its MD5 sum is %s, "
                "md5checksum.hex says %s",
                x->md5, wanted);
}

/* ---- heights ---- */

struct values {
    double *v;
    size_t n;
    enum rc_raw raw;
};

/* A chunk holds whole numbers: RC_ZIP_CHUNK is a multiple of every width, and the size was
 * checked. */
static enum rc_status
take_values(void *arg, const unsigned char *bytes, size_t n, struct rc_err *err)
{
    struct values *values = arg;
    struct rc_bytes cursor = {.data = bytes, .size = n};
    size_t count = n / rc_raw_width(values->raw);

    (void)err;
    rc_bytes_values(&cursor, values->raw, values->v + values->n, count);
    values->n += count;
    return RC_OK;
}

enum rc_status
rc_x3p_find_points(struct rc_x3p *x, size_t *member, struct rc_err *err)
{
    uint64_t size, wanted = (uint64_t)x->n * (x->at.before_z + rc_raw_width(x->raw));

    if (follow(x, x->text[RC_X3P_POINTS], member, err) != RC_OK ||
        rc_zip_read_size(x->archive, *member, &size, err) != RC_OK)
        return RC_FAIL;
    return rc_bytes_agree("heights", wanted, size, err);
}

static enum rc_status
read_points(struct rc_x3p *x, size_t member, double *v, struct rc_notes *notes, struct rc_err *err)
{
    struct values values = {.v = v, .raw = x->raw};
    uint64_t size = (uint64_t)x->n * rc_raw_width(x->raw);
    const char *given = x->text[RC_X3P_POINTS_MD5];
    char md5[RC_MD5_TEXT] = "";

    if (rc_zip_read_member(x->archive, member, size, take_values, &values,
                           is_given(given) ? md5 : NULL, err) != RC_OK)
        return RC_FAIL;
    return is_given(given) ? compare_md5("heights", given, md5, notes, err) : RC_OK;
}

static enum rc_status
apply_mask(struct rc_x3p *x, double *v, struct rc_notes *notes, struct rc_err *err)
{
    enum rc_status status = RC_FAIL;
    RC_OWNED unsigned char *mask = NULL;
    size_t member, n, least = x->n / 8 + (x->n % 8 != 0);
    const char *given = x->text[RC_X3P_VALID_MD5];
    char md5[RC_MD5_TEXT] = "";
    uint64_t size;

    if (!is_given(x->text[RC_X3P_VALID]))
        return RC_OK;
    if (follow(x, x->text[RC_X3P_VALID], &member, err) != RC_OK ||
        rc_zip_read_size(x->archive, member, &size, err) != RC_OK)
        return RC_FAIL;
    if ((size < least || size > least + MASK_PADDING) &&
        rc_bytes_agree("valid points", least, size, err) != RC_OK)
        return RC_FAIL;
    mask = rc_zip_read_bytes(x->archive, member, size, &n, is_given(given) ? md5 : NULL, err);
    if (mask == NULL)
        return RC_FAIL;
    if (!is_given(given) || compare_md5("valid points", given, md5, notes, err) == RC_OK) {
        for (size_t k = 0; k < x->n; k++)
            if ((mask[k / 8] >> k % 8 & 1) == 0)
                v[k] = NAN;
        status = RC_OK;
    }
    return status;
}

/* ---- points with positions ---- */

unsigned char *
rc_x3p_unpack_points(struct rc_x3p *x, size_t member, size_t size, struct rc_notes *notes,
                     struct rc_err *err)
{
    const char *given = x->text[RC_X3P_POINTS_MD5];
    char md5[RC_MD5_TEXT] = "";
    RC_OWNED unsigned char *data = NULL;
    size_t got;

    data = rc_zip_read_bytes(x->archive, member, size, &got, is_given(given) ? md5 : NULL, err);
    if (data != NULL && is_given(given) && compare_md5("points", given, md5, notes, err) != RC_OK)
        return NULL;
    return rc_give(&data);
}

/* The points of a member, x and z by turns. */
static enum rc_status
read_profile(struct rc_x3p *x, double *xz, struct rc_notes *notes, struct rc_err *err)
{
    size_t member, size = x->n * (x->at.before_z + rc_raw_width(x->raw));
    struct rc_bytes bytes;
    RC_OWNED unsigned char *data = NULL;

    if (rc_x3p_find_points(x, &member, err) != RC_OK ||
        (data = rc_x3p_unpack_points(x, member, size, notes, err)) == NULL)
        return RC_FAIL;
    bytes = (struct rc_bytes){.data = data, .size = size};
    for (size_t k = 0; k < x->n; k++) {
        bytes.at = k * (x->at.before_z + rc_raw_width(x->raw));
        rc_bytes_values(&bytes, x->at.raw_x, &xz[2 * k], 1);
        bytes.at = k * (x->at.before_z + rc_raw_width(x->raw)) + x->at.before_z;
        rc_bytes_values(&bytes, x->raw, &xz[2 * k + 1], 1);
    }
    return RC_OK;
}

double *
rc_x3p_profile(struct rc_x3p *x, struct rc_notes *notes, struct rc_err *err)
{
    RC_OWNED double *p = malloc(4 * x->n * sizeof *p);
    double *xz, *z;
    bool falls;

    if (p == NULL)
        return rc_err_null(err, "out of memory for %zu points", x->n);
    z = p + x->n;
    xz = p + 2 * x->n;
    if (!x->binary)
        memcpy(xz, x->list.value, 2 * x->n * sizeof *xz);
    else if (read_profile(x, xz, notes, err) != RC_OK)
        return NULL;
    for (size_t k = 0; k < x->n; k++)
        z[k] = xz[2 * k + 1];
    if (apply_mask(x, z, notes, err) != RC_OK)
        return NULL;
    falls = x->n > 1 && (xz[2] - xz[0]) * x->at.x_increment < 0;
    for (size_t k = 0; k < x->n; k++) {
        size_t from = falls ? x->n - 1 - k : k;

        xz[2 * k + 1] = z[from] * x->increment + x->offset;
        p[k] = xz[2 * from] * x->at.x_increment + x->at.x_offset;
        if (!isfinite(p[k]) || (k > 0 && !(p[k] > p[k - 1])))
            return rc_err_null(err, "the positions change direction at point %zu", from + 1);
    }
    for (size_t k = 0; k < x->n; k++)
        z[k] = xz[2 * k + 1];
    return rc_give(&p);
}

enum rc_status
rc_x3p_values(struct rc_x3p *x, const struct rc_file *file, size_t member, double *v,
              struct rc_notes *notes, struct rc_err *err)
{
    if (!x->binary)
        memcpy(v, x->list.value, x->n * sizeof *v);
    else if (x->at.absolute_x || x->at.absolute_y ? rc_x3p_axes(x, file, v, notes, err) != RC_OK
                                                  : read_points(x, member, v, notes, err) != RC_OK)
        return RC_FAIL;
    if (apply_mask(x, v, notes, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < x->n; k++)
        v[k] = v[k] * x->increment + x->offset;
    return RC_OK;
}
