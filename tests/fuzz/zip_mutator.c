/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Changes files inside ZIP archives. In three of four cases it unpacks a member, changes it and packs it
 * again, so that the fuzzing gets past the archive. Else it changes the bytes of the file. In half of the
 * cases it corrects the MD5 checksums in other members. */
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zip.h>

#include "formats/containers/containers.h"

enum {
    MEMBERS_MOST = 16,
    MEMBER_MOST = 1 << 18,
    GROWTH = 256
};

size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t most);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed);

struct member {
    char name[256];
    uint8_t *bytes; /* n bytes, and space for GROWTH more */
    size_t n;
};

static bool
unpack_member(zip_t *zip, size_t index, struct member *m)
{
    zip_file_t *f = NULL;
    zip_stat_t st;
    bool good = zip_stat_index(zip, index, 0, &st) == 0 && st.size <= MEMBER_MOST &&
                strlen(st.name) < sizeof m->name && (f = zip_fopen_index(zip, index, 0)) != NULL;

    if (good) {
        strcpy(m->name, st.name);
        m->n = (size_t)st.size;
        m->bytes = calloc(1, m->n + GROWTH);
        good = zip_fread(f, m->bytes, m->n) >= 0;
    }
    if (f != NULL)
        zip_fclose(f);
    return good;
}

/* The number of members of an archive, or 0 if one of them cannot be unpacked. */
static size_t
unpack(const uint8_t *data, size_t size, struct member member[MEMBERS_MOST])
{
    zip_source_t *source = zip_source_buffer_create(data, size, 0, NULL);
    zip_t *zip = zip_open_from_source(source, ZIP_RDONLY, NULL);
    size_t n = 0, k;

    if (zip == NULL) {
        zip_source_free(source);
        return 0;
    }
    n = (size_t)zip_get_num_entries(zip, 0);
    n = n <= MEMBERS_MOST ? n : 0;
    for (k = 0; k < n && unpack_member(zip, k, &member[k]); k++)
        continue;
    zip_discard(zip);
    return k == n ? n : 0;
}

/* Writes an archive to `to` and returns its bytes; 0 if they exceed `most`. */
static size_t
pack(const struct member *member, size_t n, bool deflate, uint8_t *to, size_t most)
{
    zip_source_t *source = zip_source_buffer_create(NULL, 0, 0, NULL);
    zip_t *zip = zip_open_from_source(source, ZIP_TRUNCATE, NULL);
    zip_stat_t st = {0};
    size_t size = 0;

    zip_source_keep(source);
    for (size_t k = 0; k < n; k++) {
        zip_source_t *bytes = zip_source_buffer(zip, member[k].bytes, member[k].n, 0);
        zip_int64_t at = zip_file_add(zip, member[k].name, bytes, ZIP_FL_OVERWRITE);

        if (at < 0)
            zip_source_free(bytes);
        else
            zip_set_file_compression(zip, (zip_uint64_t)at, deflate ? ZIP_CM_DEFLATE : ZIP_CM_STORE,
                                     1);
    }
    if (zip_close(zip) != 0)
        zip_discard(zip);
    else if (zip_source_stat(source, &st) == 0 && st.size <= most && zip_source_open(source) == 0) {
        size = (size_t)st.size;
        zip_source_read(source, to, size);
        zip_source_close(source);
    }
    zip_source_free(source);
    return size;
}

static void
checksums_follow(struct member *member, size_t n, const char *old, const char *new)
{
    const size_t length = RC_MD5_TEXT - 1;

    for (size_t k = 0; k < n; k++)
        for (size_t at = 0; at + length <= member[k].n; at++)
            if (memcmp(member[k].bytes + at, old, length) == 0)
                memcpy(member[k].bytes + at, new, length);
}

size_t
LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    struct member member[MEMBERS_MOST] = {0};
    char old[RC_MD5_TEXT], new[RC_MD5_TEXT];
    size_t n, front = 0, packed = 0;

    while (front + 4 <= size && memcmp(data + front, "PK\3\4", 4) != 0)
        front++; /* a picture may come before the archive */
    n = seed % 4 == 0 || front + 4 > size ? 0 : unpack(data + front, size - front, member);
    if (n > 0) {
        struct member *m = &member[seed / 4 % n];

        rc_md5_of(m->bytes, m->n, old);
        m->n = LLVMFuzzerMutate(m->bytes, m->n, m->n + GROWTH);
        rc_md5_of(m->bytes, m->n, new);
        if (seed / 64 % 2 == 0)
            checksums_follow(member, n, old, new);
        packed = pack(member, n, seed / 128 % 2 == 0, data + front, most - front);
    }
    for (size_t k = 0; k < MEMBERS_MOST; k++)
        free(member[k].bytes);
    return packed > 0 ? front + packed : LLVMFuzzerMutate(data, size, most);
}
