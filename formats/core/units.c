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
        {"Ang", 1e-10},
        {"AA", 1e-10},
        {"Angstrom", 1e-10},
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
