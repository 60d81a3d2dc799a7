/* SPDX-License-Identifier: GPL-3.0-or-later */
/* SI prefixes in every spelling give their powers of ten, and powers of ten give the prefixes. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "formats/core/core.h"

/* The SI brochure, 9th edition, table 7. */
static const struct {
    const char *text;
    int power;
    double factor;
} prefixes[] = {
    {"f", -15, 1e-15}, {"p", -12, 1e-12},      {"n", -9, 1e-9},
    {"u", -6, 1e-6},   {"\xc2\xb5", -6, 1e-6}, {"\xce\xbc", -6, 1e-6},
    {"m", -3, 1e-3},   {"c", -2, 1e-2},        {"", 0, 1},
    {"k", 3, 1e3},     {"M", 6, 1e6},          {"G", 9, 1e9},
    {"T", 12, 1e12},
};

static void
spellings_and_their_powers(void **state)
{
    size_t n = 0;

    (void)state;
    for (size_t k = 0; k < sizeof prefixes / sizeof *prefixes; k++) {
        int power = 99;

        assert_true(rc_prefix_power(prefixes[k].text, strlen(prefixes[k].text), &power));
        assert_int_equal(power, prefixes[k].power);
        assert_true(rc_prefix_factor(power) == prefixes[k].factor);
    }
    while (rc_prefixes[n].text != NULL)
        n++;
    assert_int_equal(n, sizeof prefixes / sizeof *prefixes);
}

static void
powers_and_their_spellings(void **state)
{
    static const char *const usual[] = {"f", "p", "n", "u", "m", "", "k", "M", "G", "T"};

    (void)state;
    for (int power = -15; power <= 12; power++)
        if (power % 3 == 0)
            assert_string_equal(rc_prefix_of(power), usual[power / 3 + 5]);
        else
            assert_null(rc_prefix_of(power));
    assert_null(rc_prefix_of(-18));
    assert_null(rc_prefix_of(15));
}

static void
what_is_no_prefix(void **state)
{
    static const char *const words[] = {"K", "d", "mm", "\xb5", "\xc2", " ", "x"};
    int power;

    (void)state;
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        assert_false(rc_prefix_power(words[k], strlen(words[k]), &power));
}

/* Units of a file, in the spellings that instruments use. */
static void
units_of_files(void **state)
{
    static const struct {
        const char *text, *unit;
        double si;
    } units[] = {
        {"V", "V", 1},
        {" mV ", "V", 1e-3},
        {"\xb5V", "V", 1e-6},
        {"\xc2\xb5V", "V", 1e-6},
        {"\xce\xbcV", "V", 1e-6},
        {"uA", "A", 1e-6},
        {"kPa", "Pa", 1e3},
        {"GPa", "Pa", 1e9},
        {"fF", "F", 1e-15},
        {"nm", "m", 1e-9},
        {"\xb5m", "m", 1e-6},
        {"Micrometers", "m", 1e-6},
        {"MILLIMETRE", "m", 1e-3},
        {"inch", "m", 25.4e-3},
        {"Inches", "m", 25.4e-3},
        {"in", "m", 25.4e-3},
        {"mil", "m", 25.4e-6},
        {"thou", "m", 25.4e-6},
        {"\xb5in", "m", 25.4e-9},
        {"\xc2\xb5inch", "m", 25.4e-9},
        {"microinches", "m", 25.4e-9},
        {"IN", "IN", 1},
        {"\xb0", "deg", 1},
        {"\xc2\xba", "deg", 1},
        {"a.u.", "a.u.", 1},
        {"kV/m", "kV/m", 1},
        {"", "", 1},
        {"mrad", "rad", 1e-3},
        {"Hz", "Hz", 1},
    };

    (void)state;
    for (size_t k = 0; k < sizeof units / sizeof *units; k++) {
        struct rc_map map = {.si = 0};

        rc_map_unit(&map, rc_piece_of(units[k].text));
        assert_string_equal(map.unit, units[k].unit);
        assert_true(map.si == units[k].si);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spellings_and_their_powers),
        cmocka_unit_test(powers_and_their_spellings),
        cmocka_unit_test(what_is_no_prefix),
        cmocka_unit_test(units_of_files),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
