/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "text.h"

#include <string.h>

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

/* Bytes that follow the lead byte, with the code point's first bits in *code; -1: no lead byte. */
static int
lead(unsigned char byte, unsigned *code)
{
    if (byte < 0x80) {
        *code = byte;
        return 0;
    }
    if (byte >= 0xc2 && byte <= 0xdf) {
        *code = byte & 0x1fU;
        return 1;
    }
    if (byte >= 0xe0 && byte <= 0xef) {
        *code = byte & 0x0fU;
        return 2;
    }
    if (byte >= 0xf0 && byte <= 0xf4) {
        *code = byte & 0x07U;
        return 3;
    }
    return -1;
}

bool
rc_utf8_valid(const char *text)
{
    static const unsigned least[] = {0, 0x80, 0x800, 0x10000};
    const unsigned char *s = (const unsigned char *)text;

    while (*s != 0) {
        unsigned code;
        int more = lead(*s++, &code);

        if (more < 0)
            return false;
        for (int k = 0; k < more; k++, s++) {
            if ((*s & 0xc0U) != 0x80)
                return false;
            code = code << 6 | (*s & 0x3fU);
        }
        if (code < least[more] || code > 0x10ffff || (code >= 0xd800 && code <= 0xdfff))
            return false;
    }
    return true;
}

size_t
rc_utf8_put(char *to, unsigned code)
{
    if (code < 0x80) {
        to[0] = (char)code;
        return 1;
    }
    if (code < 0x800) {
        to[0] = (char)(0xc0 | code >> 6);
        to[1] = (char)(0x80 | (code & 0x3f));
        return 2;
    }
    to[0] = (char)(0xe0 | code >> 12);
    to[1] = (char)(0x80 | (code >> 6 & 0x3f));
    to[2] = (char)(0x80 | (code & 0x3f));
    return 3;
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

const char *
rc_xml_character(char to[RC_ENTITY], char c)
{
    static const char marked[] = "&<>\"", *const entities[] = {"&amp;", "&lt;", "&gt;", "&quot;"};
    const char *mark = c == '\0' ? NULL : strchr(marked, c);

    if (mark != NULL)
        return strcpy(to, entities[mark - marked]);
    to[0] = (char)((unsigned char)c < ' ' ? ' ' : c);
    to[1] = '\0';
    return to;
}

const char *
rc_base64(char to[5], const unsigned char *b, size_t n)
{
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned bits = b[0] * 65536U + (n > 1 ? b[1] * 256U : 0) + (n > 2 ? b[2] : 0);

    for (size_t k = 0; k < 4; k++)
        to[k] = k <= n ? digit[bits >> (18 - 6 * k) & 63] : '=';
    to[4] = '\0';
    return to;
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
        kept--; /* do not cut a character */
    for (size_t k = 0; k < kept; k++)
        to[k] = (char)(text[k] == '\0' ? ' ' : text[k]);
    to[kept] = '\0';
    if (!rc_utf8_valid(to))
        widen(to, size, text, n);
    return rc_text_harmless(to, ' ');
}

const char *
rc_text_shown_to(char to[RC_SHOWN], const char *text, size_t n)
{
    return rc_text_clean(to, RC_SHOWN, text, n);
}

const char *
rc_word_shown_to(char to[RC_SHOWN], const char *word)
{
    return rc_text_shown_to(to, word, strlen(word));
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
