/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Selects the channel of a file. */
#include "import.h"

#include <math.h>
#include <string.h>

/* True if the name begins with these letters, in upper or lower case. */
static bool
begins(const char *name, const char *start)
{
    return rc_piece_begins((struct rc_piece){name, strlen(name)}, start);
}

/* "1 'Phase' in deg, 2 'Current' in A" for the channels whose names begin so, except one; "..." replaces the
 * rest. */
static const char *
list_names(const struct rc_channel *channel, size_t n, size_t except, const char *start,
           char names[IMPORT_NAMES])
{
    size_t used = 0;

    names[0] = '\0';
    for (size_t k = 0; k < n; k++) {
        const char *in = channel[k].unit[0] == '\0' ? "" : " in ";
        char one[sizeof *channel + 32];

        if (k == except || !begins(channel[k].name, start))
            continue;
        snprintf(one, sizeof one, "%s%zu '%s'%s%s", used == 0 ? "" : ", ", k + 1, channel[k].name,
                 in, channel[k].unit);
        if (used + strlen(one) + sizeof ", ..." > IMPORT_NAMES) {
            strcpy(names + used, ", ...");
            break;
        }
        strcpy(names + used, one);
        used += strlen(one);
    }
    return names;
}

const char *
import_names(const struct rc_channel *channel, size_t n, size_t except, char names[IMPORT_NAMES])
{
    return list_names(channel, n, except, "", names);
}

static const char *
names_of(const struct rc_channel *channel, size_t n, const char *start, char names[IMPORT_NAMES])
{
    return list_names(channel, n, n, start, names);
}

static enum rc_status
pick_topography(const struct rc_channel *channel, size_t n, bool any_unit, struct pick *pick,
                struct rc_err *err)
{
    static const char *const what[] = {"channels are heights", "channels could be the topography",
                                       "channels are in metres, none is named as a topography"};
    struct rc_topography t = rc_format_topography(channel, n, "m");
    char names[IMPORT_NAMES];

    if (t.index == n) /* the reader names the missing part */
        t = rc_format_topography(channel, n, any_unit ? NULL : "");
    if (t.index == n)
        return rc_err_set(err,
                          "no channel is a height, the file has %s: take one with --channel, "
                          "unchanged, or with --z-unit for its unit in metres",
                          names_of(channel, n, "", names));
    pick->index = t.index;
    if (t.alike > 1)
        snprintf(pick->said, sizeof pick->said,
                 "%zu %s: '%s' (%zu) is read; --channel takes another, --list shows them", t.alike,
                 what[t.named], channel[t.index].name, t.index + 1);
    else if (t.named == RC_NAMED_OTHERWISE && n > 1)
        snprintf(pick->said, sizeof pick->said,
                 "no channel in metres is named as a topography: '%s' (%zu) is read; --channel "
                 "takes another, --list shows them",
                 channel[t.index].name, t.index + 1);
    return RC_OK;
}

/* The channels of exactly that name, with or without regard to case. Returns their number, and the first. */
static size_t
named(const struct rc_channel *channel, size_t n, const char *wanted, bool either_case,
      size_t *first)
{
    size_t found = 0;

    for (size_t k = 0; k < n; k++)
        if (either_case
                ? begins(channel[k].name, wanted) && strlen(channel[k].name) == strlen(wanted)
                : strcmp(channel[k].name, wanted) == 0)
            if (found++ == 0)
                *first = k;
    return found;
}

enum rc_status
import_pick(const struct rc_channel *channel, size_t n, const char *wanted, bool any_unit,
            struct pick *pick, struct rc_err *err)
{
    size_t found = 0;
    char names[IMPORT_NAMES];
    const char *end;
    char nearest[NAME_SIZE] = "", meant[NAME_MEANT];
    double number;

    *pick = (struct pick){0};
    if (wanted == NULL)
        return pick_topography(channel, n, any_unit, pick, err);
    if ((found = named(channel, n, wanted, false, &pick->index)) == 0) {
        end = rc_number_read(wanted, false, &number);
        if (end != NULL && *end == '\0' && number >= 1 && number <= (double)n &&
            number == floor(number)) {
            pick->index = (size_t)number - 1;
            return RC_OK;
        }
        found = named(channel, n, wanted, true, &pick->index);
    }
    if (found > 1)
        snprintf(
            pick->said, sizeof pick->said,
            "%zu channels are called '%s': the first, %zu, is read; --channel takes another by "
            "its number",
            found, channel[pick->index].name, pick->index + 1);
    if (found > 0)
        return RC_OK;
    for (size_t k = 0; k < n && *wanted != '\0'; k++)
        if (begins(channel[k].name, wanted) && found++ == 0)
            pick->index = k;
    if (found == 1)
        return RC_OK;
    if (found > 1)
        return rc_err_set(err, "'%s' is the beginning of %zu names of channels: %s",
                          rc_word_shown(wanted), found, names_of(channel, n, wanted, names));
    for (size_t k = 0; k < n; k++)
        name_nearer(wanted, channel[k].name, nearest);
    return rc_err_set(err, "no channel '%s'; there are %s%s", rc_word_shown(wanted),
                      names_of(channel, n, "", names), name_meant(nearest, meant));
}
