/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The channel of a file with the topography, by unit and name. A height is a length, but not every length is
 * a height: a deflection, an error signal and an amplitude may be in metres too. Therefore the words of the
 * name decide, in this order:
 *
 *     1. names of a topography (Height, Topography, Z-Axis, ZSensor), then neutral names (Raw, Layer 0),
 *        then names of other quantities, also if they contain such a word (Height Error)
 *     2. measured before derived (corrected, smoothed, flattened)
 *     3. forward (trace) before backward (retrace)
 *     4. sensor signals of z before the drive of the piezo, which creeps and has hysteresis
 *     5. the order of the file
 */
#include "format.h"

#include <string.h>

enum {
    TOPOGRAPHY = 1 << 0,
    OTHER = 1 << 1, /* a channel of another quantity */
    DERIVED = 1 << 2,
    BACKWARD = 1 << 3,
    MEASURED = 1 << 4
};

/* Words of a channel's name, in lower case, and the meaning of each. */
static const struct {
    const char *words; /* separated by '|' */
    unsigned says;
} words[] = {
    {"topography|topographie|topo|height|heights|hoehe|h\xc3\xb6he|z|zaxis|depth|elevation|relief|"
     "surface",
     TOPOGRAPHY},
    {"zsensor|zsnsr", TOPOGRAPHY | MEASURED},
    {"sensor|detector|measured", MEASURED},
    {"backward|backwards|back|bwd|bw|retrace|reverse", BACKWARD},
    {"corrected|detrended|difference|diff|filled|filtered|fit|fitted|flattened|interpolated|"
     "leveled|levelled|processed|residual|roughness|smoothed|waviness",
     DERIVED},
    {"adhesion|amplitude|bias|brightness|capacitance|color|colour|conductance|confidence|contrast|"
     "current|deflection|deformation|deviation|dissipation|drift|error|force|frequency|friction|"
     "gradient|indentation|input|intensity|laser|lateral|light|mask|modulus|noise|oscillation|"
     "phase|potential|quality|resistance|slope|stiffness|temperature|thickness|uncertainty|voltage|"
     "x|y",
     OTHER},
};

static bool
is_lower(char c)
{
    return c >= 'a' && c <= 'z';
}

static bool
is_upper(char c)
{
    return c >= 'A' && c <= 'Z';
}

static bool
is_letter(char c)
{
    return is_lower(c) || is_upper(c) || (unsigned char)c >= 0x80;
}

/* The number of letters of the first word of s; "ZSensorTrace" has three words: Z, Sensor, Trace. */
static size_t
word_length(const char *s)
{
    size_t n = 1;

    while (is_letter(s[n]) && !(is_upper(s[n]) && (is_lower(s[n - 1]) || is_lower(s[n + 1]))))
        n++;
    return n;
}

static unsigned
word_says(const char *s, size_t n)
{
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        if (rc_piece_is((struct rc_piece){s, n}, words[k].words))
            return words[k].says;
    return 0;
}

/* A rank: the lowest is the most likely. */
static unsigned
rank_of(const char *name, enum rc_named *named)
{
    unsigned says = 0;

    for (const char *s = name; *s != '\0';) {
        size_t n = is_letter(*s) ? word_length(s) : 0;

        says |= word_says(s, n);
        s += n == 0 ? 1 : n;
    }
    *named = says & OTHER        ? RC_NAMED_OTHERWISE
             : says & TOPOGRAPHY ? RC_NAMED_TOPOGRAPHY
                                 : RC_NAMED_NOTHING;
    return 8 * (unsigned)*named + (says & DERIVED ? 4 : 0) + (says & BACKWARD ? 2 : 0) +
           (says & MEASURED ? 0 : 1);
}

struct rc_topography
rc_format_topography(const struct rc_channel *channel, size_t n, const char *unit)
{
    struct rc_topography best = {.index = n};
    unsigned least = 0;

    for (size_t k = 0; k < n; k++) {
        enum rc_named named;
        unsigned rank = rank_of(channel[k].name, &named);

        if (unit != NULL && strcmp(channel[k].unit, unit) != 0)
            continue;
        if (best.index == n || named < best.named)
            best.alike = 0;
        if (best.index == n || named <= best.named)
            best.alike++;
        if (best.index == n || rank < least) {
            best.index = k;
            best.named = named;
            least = rank;
        }
    }
    return best;
}
