/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "file.h"

#include <errno.h>
#include <stdint.h>
#include <string.h>

enum {
    TIMES_FILE = 16,
    LEAST = 64 << 20,
};

bool
rc_file_named(const struct rc_file *file, const char *suffixes)
{
    struct rc_piece name = {file->name, strlen(file->name)};
    char suffix[16];

    while (*suffixes != '\0') {
        size_t n = strcspn(suffixes, " ");
        if (n < sizeof suffix && n <= name.n) {
            memcpy(suffix, suffixes, n);
            suffix[n] = '\0';
            if (rc_piece_is((struct rc_piece){name.text + name.n - n, n}, suffix))
                return true;
        }
        suffixes += n;
        suffixes += strspn(suffixes, " ");
    }
    return false;
}

bool
rc_file_holds(const struct rc_file *file, size_t at, const void *bytes, size_t n)
{
    return at <= file->size && file->size - at >= n && memcmp(file->data + at, bytes, n) == 0;
}

bool
rc_file_is_utf16(const struct rc_file *file)
{
    return rc_file_holds(file, 0, "\xff\xfe", 2) || rc_file_holds(file, 0, "\xfe\xff", 2);
}

bool
rc_file_is_text(const struct rc_file *file)
{
    size_t looked = file->size < 4096 ? file->size : 4096;

    return looked > 0 && memchr(file->data, '\0', looked) == NULL;
}

struct rc_piece
rc_file_piece(const struct rc_file *file)
{
    return (struct rc_piece){(const char *)file->data, file->size};
}

struct rc_piece
rc_file_text(const struct rc_file *file, size_t at, size_t n)
{
    const char *text = (const char *)file->data + at;

    return rc_piece_trim((struct rc_piece){text, strnlen(text, n)});
}

struct rc_bytes
rc_file_bytes(const struct rc_file *file, bool big)
{
    return (struct rc_bytes){.data = file->data, .size = file->size, .big = big};
}

size_t
rc_memory_limit(size_t file_size)
{
    const size_t most = SIZE_MAX / 2; /* so that the memory of the process can be added to it */

    return file_size > (most - LEAST) / TIMES_FILE ? most : TIMES_FILE * file_size + LEAST;
}

enum rc_status
rc_map_fits(const struct rc_file *file, size_t nx, size_t ny, struct rc_err *err)
{
    size_t n, bytes, limit = rc_memory_limit(file->size);

    if (rc_size_mul(nx, ny, &n, err) != RC_OK ||
        rc_size_mul(n, sizeof(double), &bytes, err) != RC_OK)
        return RC_FAIL;
    if (bytes > limit)
        return rc_err_set(
            err,
            "%zu x %zu values need %zu MiB, more than the %zu that a file of %zu bytes may take",
            nx, ny, bytes >> 20, limit >> 20, file->size);
    return RC_OK;
}

enum rc_status
rc_put(FILE *out, const void *bytes, size_t n, struct rc_err *err)
{
    if (n == 0 || fwrite(bytes, 1, n, out) == n)
        return RC_OK;
    return rc_put_failed(err);
}

enum rc_status
rc_put_failed(struct rc_err *err)
{
    return rc_err_set(err, "writing failed (%s)", strerror(errno));
}
