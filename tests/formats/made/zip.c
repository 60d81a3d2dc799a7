/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ZIP archives made in memory, for the readers of their members. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <zip.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "made.h"

struct bytes
archive(const struct member *member, size_t members)
{
    zip_source_t *source = zip_source_buffer_create(NULL, 0, 0, NULL);
    zip_t *zip = zip_open_from_source(source, ZIP_TRUNCATE, NULL);
    struct bytes b = {0};
    zip_stat_t st;

    assert_non_null(zip);
    zip_source_keep(source);
    for (size_t k = 0; k < members; k++)
        assert_true(zip_file_add(zip, member[k].name,
                                 zip_source_buffer(zip, member[k].bytes, member[k].n, 0),
                                 ZIP_FL_ENC_UTF_8) >= 0);
    assert_int_equal(zip_close(zip), 0);
    assert_int_equal(zip_source_stat(source, &st), 0);
    b.n = (size_t)st.size;
    b.data = malloc(b.n);
    assert_int_equal(zip_source_open(source), 0);
    assert_int_equal(zip_source_read(source, b.data, b.n), (zip_int64_t)b.n);
    zip_source_close(source);
    zip_source_free(source);
    return b;
}

char *
with(const char *text, const char *from, const char *to)
{
    const char *at = strstr(text, from);
    size_t size = strlen(text) + strlen(to) + 1, head;
    char *made = malloc(size);

    if (at == NULL)
        fail_msg("'%s' is not in the text", from);
    head = (size_t)(at - text);
    memcpy(made, text, head);
    snprintf(made + head, size - head, "%s%s", to, at + strlen(from));
    return made;
}

void
alter(char **text, const char *from, const char *to)
{
    char *made = with(*text, from, to);

    free(*text);
    *text = made;
}
