/*
 * Which channel of a file is its topography, by unit and name.
 *
 * A height is a length, but not every length is a height: a deflection, an error signal and an
 * amplitude come in metres too. So the words of the name decide, in this order:
 *
 *     1. names of a topography (Height, Topography, Z-Axis, ZSensor), then names that say nothing
 *        (Raw, Layer 0), then names of something else, whatever other words are in them (Height
 *        Error)
 *     2. as measured before derived (corrected, smoothed, flattened)
 *     3. forward (trace) before backward (retrace)
 *     4. what a sensor of z measured before what drove the piezo: a drive creeps and has hysteresis
 *     5. the order of the file
 */
#include "format.h"

#include <string.h>

enum {
    TOPOGRAPHY = 1 << 0,
    OTHER = 1 << 1, /* of something else */
    DERIVED = 1 << 2,
    BACKWARD = 1 << 3,
    MEASURED = 1 << 4,
    WORD_MOST = 24
};

/* Words of a channel's name, in lower case, and what each tells of the channel. */
static const struct {
    const char *word;
    unsigned says;
} words[] = {
    {"topography", TOPOGRAPHY},
    {"topographie", TOPOGRAPHY},
    {"topo", TOPOGRAPHY},
    {"height", TOPOGRAPHY},
    {"heights", TOPOGRAPHY},
    {"hoehe", TOPOGRAPHY},
    {"h\xc3\xb6he", TOPOGRAPHY},
    {"z", TOPOGRAPHY},
    {"zaxis", TOPOGRAPHY},
    {"depth", TOPOGRAPHY},
    {"elevation", TOPOGRAPHY},
    {"relief", TOPOGRAPHY},
    {"surface", TOPOGRAPHY},
    {"zsensor", TOPOGRAPHY | MEASURED},
    {"zsnsr", TOPOGRAPHY | MEASURED},
    {"sensor", MEASURED},
    {"detector", MEASURED},
    {"measured", MEASURED},
    {"backward", BACKWARD},
    {"backwards", BACKWARD},
    {"back", BACKWARD},
    {"bwd", BACKWARD},
    {"bw", BACKWARD},
    {"retrace", BACKWARD},
    {"reverse", BACKWARD},
    {"corrected", DERIVED},
    {"detrended", DERIVED},
    {"difference", DERIVED},
    {"diff", DERIVED},
    {"filled", DERIVED},
    {"filtered", DERIVED},
    {"fit", DERIVED},
    {"fitted", DERIVED},
    {"flattened", DERIVED},
    {"interpolated", DERIVED},
    {"leveled", DERIVED},
    {"levelled", DERIVED},
    {"processed", DERIVED},
    {"residual", DERIVED},
    {"roughness", DERIVED},
    {"smoothed", DERIVED},
    {"waviness", DERIVED},
    {"adhesion", OTHER},
    {"amplitude", OTHER},
    {"bias", OTHER},
    {"brightness", OTHER},
    {"capacitance", OTHER},
    {"color", OTHER},
    {"colour", OTHER},
    {"conductance", OTHER},
    {"confidence", OTHER},
    {"contrast", OTHER},
    {"current", OTHER},
    {"deflection", OTHER},
    {"deformation", OTHER},
    {"deviation", OTHER},
    {"dissipation", OTHER},
    {"drift", OTHER},
    {"error", OTHER},
    {"force", OTHER},
    {"frequency", OTHER},
    {"friction", OTHER},
    {"gradient", OTHER},
    {"indentation", OTHER},
    {"input", OTHER},
    {"intensity", OTHER},
    {"laser", OTHER},
    {"lateral", OTHER},
    {"light", OTHER},
    {"mask", OTHER},
    {"modulus", OTHER},
    {"noise", OTHER},
    {"oscillation", OTHER},
    {"phase", OTHER},
    {"potential", OTHER},
    {"quality", OTHER},
    {"resistance", OTHER},
    {"slope", OTHER},
    {"stiffness", OTHER},
    {"temperature", OTHER},
    {"thickness", OTHER},
    {"uncertainty", OTHER},
    {"voltage", OTHER},
    {"x", OTHER},
    {"y", OTHER},
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

/* Letters of the word that s begins with; "ZSensorTrace" is three: Z, Sensor, Trace. */
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
    char word[WORD_MOST];

    if (n >= sizeof word)
        return 0;
    for (size_t k = 0; k < n; k++)
        word[k] = (char)(is_upper(s[k]) ? s[k] - 'A' + 'a' : s[k]);
    word[n] = '\0';
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        if (strcmp(words[k].word, word) == 0)
            return words[k].says;
    return 0;
}

/* The less the likelier. */
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
