#include "shown.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "formats/core/core.h"

const char *
shown_number(char text[SHOWN_NUMBER], double value, int digits, const char *unit)
{
    bool known = strcmp(unit, "m") == 0 || strcmp(unit, "Pa") == 0 || strcmp(unit, "N") == 0;
    int most = strcmp(unit, "m") == 0 ? 0 : 12, power = 0; /* nobody says Mm */

    if (known && value != 0 && isfinite(value)) {
        power = 3 * (int)floor(log10(fabs(value)) / 3);
        power = power > most ? most : rc_prefix_of(power) == NULL ? 0 : power;
    }
    snprintf(text, SHOWN_NUMBER, "%.*g%s%s", digits, value / pow(10, power),
             *unit == '\0' ? "" : " ", rc_prefix_of(power));
    return text;
}
