/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bytes of a file. */
#include "import.h"

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

const char *
import_source(const char *name)
{
    return strcmp(name, "-") == 0 ? "standard input" : name;
}

/* Initial size of the buffer: the size of the file, if it is known. */
static size_t
first_size(FILE *in)
{
    struct stat st;

    if (fstat(fileno(in), &st) == 0 && S_ISREG(st.st_mode) && st.st_size > 0 &&
        (uintmax_t)st.st_size < SIZE_MAX / 2)
        return (size_t)st.st_size + 1;
    return 1 << 16;
}

/* All bytes of `in`, or NULL. */
static unsigned char *
whole(struct tool *t, FILE *in, size_t *n, struct rc_err *err)
{
    size_t size = first_size(in), got;
    unsigned char *data = NULL, *more;

    for (*n = 0;; size *= 2) {
        if (t->memory != 0 && size > t->memory) {
            rc_err_set(err, "reading it needs more memory than the %s of --memory",
                       shown_bytes((double)t->memory));
            break;
        }
        if ((more = realloc(data, size)) == NULL) {
            rc_err_set(err, "out of memory for %zu bytes", size);
            break;
        }
        data = more;
        while (*n < size && (got = fread(data + *n, 1, size - *n, in)) > 0)
            *n += got;
        if (*n == size)
            continue;
        if (!ferror(in))
            return data;
        rc_err_set(err, "reading failed (%s)", strerror(errno));
        break;
    }
    free(data);
    return NULL;
}

unsigned char *
import_read(struct tool *t, const char *name, struct rc_file *file, struct rc_err *err)
{
    FILE *in = strcmp(name, "-") == 0 ? stdin : fopen(name, "rb");
    const char *slash = strrchr(name, '/');
    unsigned char *data;

    if (in == NULL)
        return rc_err_null(err, "%s", strerror(errno));
    if (isatty(fileno(in)))
        tool_usage(t, "%s is a terminal: name a file", import_source(name));
    *file = (struct rc_file){.name = slash == NULL ? name : slash + 1};
    file->data = data = whole(t, in, &file->size, err);
    if (in != stdin)
        fclose(in);
    return data;
}

enum rc_status
import_skip(struct rc_file *file, unsigned char *data, size_t lines, struct rc_err *err)
{
    size_t wide = rc_file_is_utf16(file) ? 2 : 1, at = wide == 2 ? 2 : 0, done = 0;
    size_t low = wide == 2 && data[0] == 0xfe ? 1 : 0; /* position of the significant byte */

    while (done < lines && at + wide <= file->size) {
        unsigned c = data[at + low] + (wide == 2 ? 256U * data[at + 1 - low] : 0U);

        at += wide;
        if (c == '\r' && at + wide <= file->size && data[at + low] == '\n' &&
            (wide == 1 || data[at + 1 - low] == 0))
            at += wide;
        done += c == '\n' || c == '\r';
    }
    if (done < lines || at >= file->size)
        return rc_err_set(err, "--skip %zu skips the whole file: give a smaller number", lines);
    if (wide == 2) { /* the byte order mark stays at the start */
        at -= 2;
        memmove(data + at, data, 2);
    }
    file->data = data + at;
    file->size -= at;
    return RC_OK;
}
