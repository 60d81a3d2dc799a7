/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "checksum.h"

#include <stdlib.h>
#include <sys/types.h>
#include <md5.h>

struct rc_md5 {
    MD5_CTX context;
};

void
rc_md5_of(const void *bytes, size_t n, char text[RC_MD5_TEXT])
{
    MD5Data(bytes, n, text);
}

struct rc_md5 *
rc_md5_new(struct rc_err *err)
{
    struct rc_md5 *m = malloc(sizeof *m);

    if (m == NULL)
        rc_err_set(err, "out of memory for a checksum (%zu bytes)", sizeof *m);
    else
        MD5Init(&m->context);
    return m;
}

void
rc_md5_add(struct rc_md5 *m, const void *bytes, size_t n)
{
    MD5Update(&m->context, bytes, n);
}

void
rc_md5_get(struct rc_md5 *m, char text[RC_MD5_TEXT])
{
    MD5End(&m->context, text);
}

void
rc_md5_free(struct rc_md5 *m)
{
    free(m);
}
