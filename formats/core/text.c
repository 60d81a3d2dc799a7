#include "text.h"

#include <math.h>
#include <string.h>

#include "utf8.h"

bool
rc_lines_next(struct rc_lines *l, const char **line, size_t *n)
{
    const char *s = l->at;

    if (s == l->end)
        return false;
    while (s < l->end && *s != '\n' && *s != '\r')
        s++;
    *line = l->at;
    *n = (size_t)(s - l->at);
    if (s < l->end && *s == '\r' && s + 1 < l->end && s[1] == '\n')
        s++;
    l->at = s < l->end ? s + 1 : s;
    l->number++;
    return true;
}

static bool
is_white(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

void
rc_trim(const char **text, size_t *n)
{
    while (*n > 0 && is_white((*text)[*n - 1]))
        --*n;
    while (*n > 0 && is_white(**text)) {
        ++*text;
        --*n;
    }
}

bool
rc_length_unit(const char *text, size_t n, double *metres)
{
    static const struct {
        const char *name;
        double metres;
    } units[] = {
        {"m", 1},
        {"nm", 1e-9},
        {"um", 1e-6},
        {"\xc2\xb5m", 1e-6}, /* U+00B5, micro sign            */
        {"\xce\xbcm", 1e-6}, /* U+03BC, Greek mu              */
        {"\xb5m", 1e-6},     /* the micro sign in Latin-1     */
        {"~m", 1e-6},        /* NanoScope's way round it      */
        {"Micrometer", 1e-6},
        {"Nanometer", 1e-9},
        {"Millimeter", 1e-3},
        {"micron", 1e-6},
        {"microns", 1e-6},
        {"mm", 1e-3},
        {"cm", 1e-2},
        {"km", 1e3},
        {"pm", 1e-12},
        {"fm", 1e-15},
        {"\xc3\x85", 1e-10},     /* U+00C5, A with ring    */
        {"\xe2\x84\xab", 1e-10}, /* U+212B, Angstrom sign  */
        {"\xc5", 1e-10},         /* Latin-1                */
    };

    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        if (strlen(units[k].name) == n && memcmp(units[k].name, text, n) == 0) {
            *metres = units[k].metres;
            return true;
        }
    return false;
}

double
rc_word_metres(const char *word)
{
    double metres;

    return rc_length_unit(word, strlen(word), &metres) ? metres : NAN;
}

size_t
rc_control_size(const char *text)
{
    const unsigned char *s = (const unsigned char *)text;

    if (s[0] == 0xc2 && s[1] >= 0x80 && s[1] < 0xa0)
        return 2;
    return (s[0] < ' ' && s[0] != '\0') || s[0] == 0x7f;
}

char *
rc_text_harmless(char *text, char mark)
{
    for (char *s = text; *s != '\0'; s++)
        memset(s, mark, rc_control_size(s));
    return text;
}

/* Latin-1 to UTF-8: the code points of Latin-1 are the first 256 of Unicode. */
static void
widen(char *to, size_t size, const char *text, size_t n)
{
    size_t used = 0;

    for (size_t k = 0; k < n; k++) {
        unsigned char c = text[k] == '\0' ? ' ' : (unsigned char)text[k];

        if (used + (c < 0x80 ? 1 : 2) >= size)
            break;
        used += rc_utf8_put(to + used, c);
    }
    to[used] = '\0';
}

char *
rc_text_clean(char *to, size_t size, const char *text, size_t n)
{
    size_t most = size - 1, kept;

    rc_trim(&text, &n);
    kept = n < most ? n : most;
    while (kept < n && kept > 0 && ((unsigned char)text[kept] & 0xc0U) == 0x80)
        kept--; /* not in the middle of a character */
    for (size_t k = 0; k < kept; k++)
        to[k] = (char)(text[k] == '\0' ? ' ' : text[k]);
    to[kept] = '\0';
    if (!rc_utf8_valid(to))
        widen(to, size, text, n);
    return rc_text_harmless(to, ' ');
}

const char *
rc_text_shown(char to[RC_SHOWN], const char *text, size_t n)
{
    return rc_text_clean(to, RC_SHOWN, text, n);
}

const char *
rc_word_shown(char to[RC_SHOWN], const char *word)
{
    return rc_text_shown(to, word, strlen(word));
}

enum rc_status
rc_text_keep(struct rc_grid *g, const char *key, const char *text, size_t n, struct rc_err *err)
{
    char value[2048];

    rc_text_clean(value, sizeof value, text, n);
    return *value == '\0' ? RC_OK : rc_grid_set(g, key, value, err);
}

enum rc_status
rc_word_keep(struct rc_grid *g, const char *key, const char *word, struct rc_err *err)
{
    return rc_text_keep(g, key, word, strlen(word), err);
}
