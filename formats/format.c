#include "format.h"

#include <math.h>
#include <string.h>

#define RC_FORMAT(name) extern const struct rc_format rc_format_##name;
#include "formats.list"
#undef RC_FORMAT

const struct rc_format *const rc_formats[] = {
#define RC_FORMAT(name) &rc_format_##name,
#include "formats.list"
#undef RC_FORMAT
    NULL,
};

const struct rc_wish rc_no_wish = {.dx = NAN, .dy = NAN, .z_unit = NAN};

const struct rc_format *
rc_format_named(const char *name)
{
    for (const struct rc_format *const *f = rc_formats; *f != NULL; f++)
        if (strcmp((*f)->name, name) == 0)
            return *f;
    return NULL;
}

const struct rc_format *
rc_format_find(const struct rc_file *file, struct rc_err *err)
{
    const struct rc_format *best = NULL;
    char first[RC_SHOWN];
    int most = 0;

    for (const struct rc_format *const *f = rc_formats; *f != NULL; f++) {
        int score = (*f)->score(file);
        if (score > most) {
            best = *f;
            most = score;
        }
    }
    if (best != NULL)
        return best;
    if (file->size == 0)
        rc_err_set(err, "the file is empty");
    else if (rc_file_holds(file, 0, "\x1f\x8b", 2))
        rc_err_set(err, "the file is packed with gzip twice: unpack it once (gunzip)");
    else
        rc_err_set(
            err,
            "not recognised: it is none of the formats that --formats lists (it "
            "begins '%s'); --format NAME says which one it is, or the program that it comes from "
            "may "
            "save X3P, SDF or text",
            rc_text_shown(first, (const char *)file->data, file->size < 24 ? file->size : 24));
    return NULL;
}
