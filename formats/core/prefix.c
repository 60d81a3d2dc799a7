#include "prefix.h"

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
