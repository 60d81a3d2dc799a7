#include "utf8.h"

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
