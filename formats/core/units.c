#include "units.h"

#include <math.h>
#include <string.h>

const struct rc_prefix rc_prefixes[] = {
    {"f", -15},       {"p", -12}, {"n", -9}, {"u", -6}, {"\xc2\xb5", -6}, /* U+00B5, micro sign */
    {"\xce\xbc", -6},                                                     /* U+03BC, Greek mu   */
    {"m", -3},        {"c", -2},  {"", 0},   {"k", 3},  {"M", 6},
    {"G", 9},         {"T", 12},  {NULL, 0},
};

bool
rc_prefix_power(const char *text, size_t n, int *power)
{
    for (const struct rc_prefix *p = rc_prefixes; p->text != NULL; p++)
        if (strlen(p->text) == n && memcmp(p->text, text, n) == 0) {
            *power = p->power;
            return true;
        }
    return false;
}

const char *
rc_prefix_of(int power)
{
    if (power % 3 != 0)
        return NULL;
    for (const struct rc_prefix *p = rc_prefixes; p->text != NULL; p++)
        if (p->power == power)
            return p->text;
    return NULL;
}

double
rc_prefix_factor(int power)
{
    double whole = 1; /* exact up to 1e22 */

    for (int k = 0; k < (power < 0 ? -power : power); k++)
        whole *= 10;
    return power < 0 ? 1 / whole : whole;
}

/* Symbols, whose case counts. */
static const struct length {
    const char *name;
    double metres;
} symbols[] =
    {
        {"m", 1},
        {"nm", 1e-9},
        {"um", 1e-6},
        {"\xc2\xb5m", 1e-6}, /* U+00B5, micro sign            */
        {"\xce\xbcm", 1e-6}, /* U+03BC, Greek mu              */
        {"\xb5m", 1e-6},     /* the micro sign in Latin-1     */
        {"~m", 1e-6},        /* NanoScope's way round it      */
        {"mm", 1e-3},
        {"cm", 1e-2},
        {"km", 1e3},
        {"pm", 1e-12},
        {"fm", 1e-15},
        {"\xc3\x85", 1e-10},     /* U+00C5, A with ring    */
        {"\xe2\x84\xab", 1e-10}, /* U+212B, Angstrom sign  */
        {"\xc5", 1e-10},         /* Latin-1                */
        {"AA", 1e-10},
        {"in", 25.4e-3},
        {"\"", 25.4e-3},
        {"uin", 25.4e-9},
        {"u\"", 25.4e-9},
        {"\xc2\xb5in", 25.4e-9},
        {"\xce\xbcin", 25.4e-9},
        {"\xb5in", 25.4e-9},
        {"\xc2\xb5\"", 25.4e-9},
        {"\xce\xbc\"", 25.4e-9},
        {"\xb5\"", 25.4e-9},
},
  words[] = {
      /* in either case, one or several */
      {"metre", 1},
      {"meter", 1},
      {"millimetre", 1e-3},
      {"millimeter", 1e-3},
      {"centimetre", 1e-2},
      {"centimeter", 1e-2},
      {"micrometre", 1e-6},
      {"micrometer", 1e-6},
      {"mikrometer", 1e-6},
      {"micron", 1e-6},
      {"nanometre", 1e-9},
      {"nanometer", 1e-9},
      {"picometre", 1e-12},
      {"picometer", 1e-12},
      {"ang", 1e-10},
      {"angstrom", 1e-10},
      {"\xc3\xa5ngstr\xc3\xb6m", 1e-10}, /* of UTF-8 */
      {"\xc3\x85ngstr\xc3\xb6m", 1e-10},
      {"inch", 25.4e-3},
      {"inche", 25.4e-3}, /* and s */
      {"mil", 25.4e-6},
      {"thou", 25.4e-6},
      {"microinch", 25.4e-9},
      {"microinche", 25.4e-9},
      {"uinch", 25.4e-9},
      {"\xc2\xb5inch", 25.4e-9},
      {"\xce\xbcinch", 25.4e-9},
      {"\xb5inch", 25.4e-9},
};

static bool
same_word(const char *word, const char *text, size_t n)
{
    for (size_t k = 0; k < n; k++)
        if (word[k] == '\0' ||
            word[k] != (char)(text[k] >= 'A' && text[k] <= 'Z' ? text[k] - 'A' + 'a' : text[k]))
            return false;
    return word[n] == '\0';
}

bool
rc_length_unit(const char *text, size_t n, double *metres)
{
    size_t one = n > 1 && (text[n - 1] == 's' || text[n - 1] == 'S') ? n - 1 : n;

    for (size_t k = 0; k < sizeof symbols / sizeof *symbols; k++)
        if (strlen(symbols[k].name) == n && memcmp(symbols[k].name, text, n) == 0) {
            *metres = symbols[k].metres;
            return true;
        }
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        if (same_word(words[k].name, text, n) || same_word(words[k].name, text, one)) {
            *metres = words[k].metres;
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
