/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Written from Microsoft's description of the format, [MS-CFB]. */
#include "ole.h"

#include <stdlib.h>
#include <string.h>

enum {
    AT_SHIFT = 30, /* positions of the sizes of sectors and of small sectors */
    AT_TABLES = 44,
    AT_DIRECTORY = 48,
    AT_CUTOFF = 56, /* streams shorter than this are in small sectors */
    AT_SMALL_TABLE = 60,
    AT_MORE_TABLES = 68,
    AT_FIRST_TABLES = 76,
    FIRST_TABLES = 109, /* number of sectors of the table in the header */
    ENTRY = 128,        /* bytes of an entry of the directory */
    NAME = 64,
    AT_NAME_SIZE = 64,
    AT_TYPE = 66,
    AT_START = 116,
    AT_SIZE = 120,
    STREAM = 2,
    ROOT = 5
};

#define END UINT32_C(0xfffffffa) /* larger numbers are not sectors */

static const unsigned char magic[8] = {0xd0, 0xcf, 0x11, 0xe0, 0xa1, 0xb1, 0x1a, 0xe1};

struct ole {
    struct rc_bytes b;
    size_t sector, small; /* bytes of one */
    uint32_t *table;      /* the next sector of each of `sectors` */
    size_t sectors;
};

bool
rc_ole_is(const struct rc_file *file)
{
    return rc_file_holds(file, 0, magic, sizeof magic);
}

static size_t
place(const struct ole *o, uint32_t sector)
{
    return ((size_t)sector + 1) * o->sector;
}

/* Copies the next sector of the table; false if it is not in the file. */
static bool
take_table(struct ole *o, uint32_t sector, size_t *filled)
{
    struct rc_bytes b = o->b;

    if (sector >= o->sectors)
        return false;
    b.at = place(o, sector);
    for (size_t k = 0; k < o->sector / 4 && *filled < o->sectors; k++)
        o->table[(*filled)++] = rc_bytes_u32(&b);
    return !b.past || *filled == o->sectors;
}

/* The table that chains sectors. Its own sectors are listed in the header and in further sectors, each of
 * which ends with the number of the next one. */
static enum rc_status
read_table(struct ole *o, struct rc_err *err)
{
    struct rc_bytes b = o->b;
    size_t tables = (size_t)rc_bytes_at(&b, AT_TABLES, RC_RAW_U32), filled = 0;
    uint32_t more = (uint32_t)rc_bytes_at(&b, AT_MORE_TABLES, RC_RAW_U32);

    o->sectors = o->b.size / o->sector; /* the header takes the place of one sector */
    if ((o->table = malloc(o->sectors * sizeof *o->table)) == NULL)
        return rc_err_set(err, "out of memory for a table of %zu sectors", o->sectors);
    memset(o->table, 0xff, o->sectors * sizeof *o->table);
    b.at = AT_FIRST_TABLES;
    for (size_t k = 0, left = FIRST_TABLES; k < tables && filled < o->sectors; k++, left--) {
        if (left == 0) {
            if (more >= o->sectors)
                break;
            b.at = place(o, more);
            left = o->sector / 4 - 1;
            more = (uint32_t)rc_bytes_at(&b, b.at + 4 * left, RC_RAW_U32);
            b.at -= 4 * (left + 1);
        }
        if (!take_table(o, rc_bytes_u32(&b), &filled))
            break;
    }
    return RC_OK;
}

/* The n bytes of a chain that begins at a sector; the caller frees them; NULL if the chain is broken. */
static unsigned char *
read_chain(const struct ole *o, uint32_t sector, size_t n)
{
    RC_OWNED unsigned char *all = malloc(n + 1);

    for (size_t done = 0; all != NULL && done < n; done += o->sector) {
        size_t part = n - done < o->sector ? n - done : o->sector;

        if (sector >= o->sectors || part > o->b.size || place(o, sector) > o->b.size - part)
            return NULL;
        memcpy(all + done, o->b.data + place(o, sector), part);
        sector = o->table[sector];
    }
    return rc_give(&all);
}

static size_t
chain_length(const struct ole *o, uint32_t sector)
{
    size_t n = 0;

    while (sector < END && sector < o->sectors && n < o->sectors) {
        sector = o->table[sector];
        n++;
    }
    return n * o->sector;
}

/* A stream in small sectors: they are in the stream of the root, chained by a separate table. */
static unsigned char *
read_small(const struct ole *o, uint32_t root, uint32_t first, size_t n)
{
    struct rc_bytes head = o->b, next = {0};
    uint32_t start = (uint32_t)rc_bytes_at(&head, AT_SMALL_TABLE, RC_RAW_U32);
    size_t bytes = chain_length(o, root), links = chain_length(o, start);
    RC_OWNED unsigned char *in = read_chain(o, root, bytes);
    RC_OWNED unsigned char *all = malloc(n + 1);
    RC_OWNED unsigned char *table = read_chain(o, start, links);

    if (all == NULL || in == NULL || table == NULL)
        return NULL;
    next.data = table;
    next.size = links;
    for (size_t done = 0; done < n; done += o->small) {
        if (first >= bytes / o->small || first >= links / 4)
            return NULL;
        memcpy(all + done, in + first * o->small, n - done < o->small ? n - done : o->small);
        first = (uint32_t)rc_bytes_at(&next, 4 * (size_t)first, RC_RAW_U32);
    }
    return rc_give(&all);
}

/* True if the entry has this name, in UTF-16 with a NUL. */
static bool
is_named(const unsigned char *entry, const char *name)
{
    size_t n = strlen(name);

    if (2 * (n + 1) > NAME || entry[AT_NAME_SIZE] != 2 * (n + 1))
        return false;
    for (size_t k = 0; k < n; k++)
        if (entry[2 * k] != (unsigned char)name[k] || entry[2 * k + 1] != 0)
            return false;
    return true;
}

static unsigned char *
find_stream(const struct ole *o, const char *name, size_t *n, struct rc_err *err)
{
    struct rc_bytes head = o->b, entries = {0};
    uint32_t start = (uint32_t)rc_bytes_at(&head, AT_DIRECTORY, RC_RAW_U32), root = END;
    size_t cutoff = (size_t)rc_bytes_at(&head, AT_CUTOFF, RC_RAW_U32);
    RC_OWNED unsigned char *directory = read_chain(o, start, chain_length(o, start));
    unsigned char *all;

    entries.data = directory;
    entries.size = directory == NULL ? 0 : chain_length(o, start);
    for (size_t at = 0; at + ENTRY <= entries.size; at += ENTRY) {
        uint32_t first = (uint32_t)rc_bytes_at(&entries, at + AT_START, RC_RAW_U32);
        uint64_t size = rc_bytes_u64(&entries);

        if (directory[at + AT_TYPE] == ROOT)
            root = first;
        if (directory[at + AT_TYPE] != STREAM || !is_named(directory + at, name))
            continue;
        *n = (size_t)size;
        all = size > o->b.size ? NULL
              : *n < cutoff    ? read_small(o, root, first, *n)
                               : read_chain(o, first, *n);
        if (all == NULL)
            rc_err_set(
                err,
                "the stream '%s' of the compound file is damaged, or there is no memory for it",
                name);
        return all;
    }
    return rc_err_null(err, "the compound file has no stream '%s'", name);
}

unsigned char *
rc_ole_stream(const struct rc_file *file, const char *name, size_t *n, struct rc_err *err)
{
    struct ole o = {.b = rc_file_bytes(file, false)};
    struct rc_bytes b = o.b;
    size_t shift = (size_t)rc_bytes_at(&b, AT_SHIFT, RC_RAW_U16), small = rc_bytes_u16(&b);
    unsigned char *all = NULL;

    if (!rc_ole_is(file) || shift < 9 || shift > 16 || small < 4 || small > shift)
        return rc_err_null(err, "no compound file, or one whose header is damaged");
    o.sector = (size_t)1 << shift;
    o.small = (size_t)1 << small;
    if (read_table(&o, err) == RC_OK)
        all = find_stream(&o, name, n, err);
    free(o.table);
    return all;
}
