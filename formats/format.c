/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "format.h"

#include <math.h>
#include <string.h>

#include "formats/sandbox/sandbox.h"

#define RC_FORMAT(name) extern const struct rc_format rc_format_##name;
#include "formats.list"
#undef RC_FORMAT

const struct rc_format *const rc_formats[] = {
#define RC_FORMAT(name) &rc_format_##name,
#include "formats.list"
#undef RC_FORMAT
    NULL,
};

const struct rc_wish rc_no_wish = {.dx = NAN, .dy = NAN, .z_unit = NAN, .xy_unit = NAN};

const struct rc_format *
rc_format_named(const char *name)
{
    for (const struct rc_format *const *f = rc_formats; *f != NULL; f++)
        if (strcmp((*f)->name, name) == 0)
            return *f;
    return NULL;
}

static bool
matches(const struct rc_format *f, const struct rc_file *file)
{
    bool is = f->is != NULL && f->is(file);

    for (size_t k = 0; k < sizeof f->magic / sizeof *f->magic; k++)
        is = is || (f->magic[k].n > 0 && rc_file_holds(file, 0, f->magic[k].bytes, f->magic[k].n));
    return is;
}

static int
score(const struct rc_format *f, struct rc_maps *maps)
{
    if (f->score_open != NULL)
        return rc_file_is_text(maps->file) || rc_file_is_utf16(maps->file) ? f->score_open(maps)
                                                                           : 0;
    if (f->score != NULL)
        return f->score(maps->file);
    return !matches(f, maps->file) ? 0 : f->sure > 0 ? f->sure : 95;
}

static enum rc_status
check(const struct rc_format *f, const struct rc_file *file, struct rc_err *err)
{
    return f->refusal == NULL || matches(f, file) ? RC_OK : rc_err_set(err, "%s", f->refusal);
}

/* Kinds of files without heights, or with compressed heights. */
static const char *
other_file(const struct rc_file *file)
{
    static const struct {
        const char *magic, *what;
    } kinds[] = {
        {"\x89PNG", "a PNG picture has colours, no heights: save X3P, SDF or text in the program "
                    "that made it"},
        {"\xff\xd8\xff", "a JPEG picture has colours, no heights: save X3P, SDF or text in the "
                         "program that made it"},
        {"%PDF", "a PDF document has no readable heights"},
        {"BZh", "the file is packed with bzip2: unpack it first (bunzip2)"},
        {"\xfd"
         "7zXZ",
         "the file is packed with xz: unpack it first (unxz)"},
        {"\x28\xb5\x2f\xfd", "the file is packed with zstd: unpack it first (unzstd)"},
    };

    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        if (rc_file_holds(file, 0, kinds[k].magic, strlen(kinds[k].magic)))
            return kinds[k].what;
    return NULL;
}

/* What is opened for it stays open for the format, unless options say how to read text: they do not take part
 * in the choice. */
static const struct rc_format *
find(struct rc_maps *maps, struct rc_err *err)
{
    const struct rc_wish *wish = maps->wish;
    bool says = wish->separator != NULL || wish->decimal != 0 || wish->missing != NULL;
    const struct rc_file *file = maps->file;
    const struct rc_format *best = NULL;
    int most = 0;

    maps->wish = says ? &rc_no_wish : wish;
    for (const struct rc_format *const *f = rc_formats; *f != NULL; f++) {
        int here = score(*f, maps);
        if (here > most) {
            best = *f;
            most = here;
        }
    }
    maps->wish = wish;
    if (says || best == NULL || best->score_open == NULL)
        rc_maps_shut(maps);
    if (best != NULL)
        return best;
    if (file->size == 0)
        return rc_err_null(err, "the file is empty");
    if (rc_file_holds(file, 0, "\x1f\x8b", 2))
        return rc_err_null(err, "the file is packed with gzip twice: unpack it once (gunzip)");
    if (other_file(file) != NULL)
        return rc_err_null(err, "%s", other_file(file));
    return rc_err_null(
        err,
        "not recognised: it has none of the formats of --formats (it begins '%s'); give "
        "--format NAME, or save X3P, SDF or text in the program that made it",
        rc_text_shown((const char *)file->data, file->size < 24 ? file->size : 24));
}

const struct rc_format *
rc_format_find(const struct rc_file *file, struct rc_err *err)
{
    RC_OWN(rc_maps, maps) = rc_maps_new(file, &rc_no_wish, err);

    return maps == NULL ? NULL : find(maps, err);
}

struct rc_maps *
rc_format_open(const struct rc_format *f, const struct rc_file *file, const struct rc_wish *wish,
               struct rc_err *err)
{
    RC_OWN(rc_maps, maps) = rc_maps_new(file, wish, err);

    if (maps == NULL || (f == NULL && (f = find(maps, err)) == NULL) ||
        check(f, file, err) != RC_OK)
        return NULL;
    maps->format = f;
    if ((f->sandboxed ? rc_sandbox_describe : rc_maps_describe)(maps, f->find, err) != RC_OK)
        return NULL;
    return rc_give(&maps);
}

struct rc_grid *
rc_format_read(struct rc_maps *maps, const struct rc_wish *wish, size_t index,
               struct rc_notes *notes, struct rc_err *err)
{
    return maps->format->sandboxed
               ? rc_sandbox_read(maps, maps->format->find, wish, index, notes, err)
               : rc_maps_read(maps, wish, index, notes, err);
}
