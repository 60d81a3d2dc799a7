/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A number on the command line gives the SI value of its text to the last bit; other text is refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/exact.h"
#include "tools/text/text.h"

static void
test_numbers(void **state)
{
    static const struct {
        const char *text;
        enum unit unit;
        double value;
    } good[] = {
        {"240N", UNIT_N, 240},
        {"240", UNIT_N, 240},
        {"1.5kN", UNIT_N, 1.5e3},
        {"37.3mN", UNIT_N, 37.3e-3},
        {"6GPa", UNIT_PA, 6e9},
        {"6GPa", UNIT_HARD, 6e9},
        {"113.93GPa", UNIT_PA, 113.93e9},
        {"2.5TPa", UNIT_PA, 2.5e12},
        {"350MPa", UNIT_PA, 350e6},
        {"2e-8", UNIT_PER_PA, 2e-8},
        {"20/GPa", UNIT_PER_PA, 20e-9},
        {"20 1/GPa", UNIT_PER_PA, 20e-9},
        {"101325", UNIT_PA, 101325},
        {"1.1um", UNIT_M, 1.1e-6},
        {"1.29um", UNIT_M, 1.29e-6},
        {"0.3um", UNIT_M, 0.3e-6},
        {"1.29\xc2\xb5m", UNIT_M, 1.29e-6},
        {"1.29\xce\xbcm", UNIT_M, 1.29e-6},
        {"1.29 um", UNIT_M, 1.29e-6},
        {"2.385mm", UNIT_M, 2.385e-3},
        {"2.385e0mm", UNIT_M, 2.385e-3},
        {"2385e-3mm", UNIT_M, 2.385e-3},
        {".5cm", UNIT_M, 0.5e-2},
        {"5.nm", UNIT_M, 5e-9},
        {"7pm", UNIT_M, 7e-12},
        {"3fm", UNIT_M, 3e-15},
        {"-4.2um", UNIT_M, -4.2e-6},
        {"+4.2um", UNIT_M, 4.2e-6},
        {"1e-6", UNIT_M, 1e-6},
        {"0m", UNIT_M, 0},
        {"2m", UNIT_M, 2},
        {"0.1", UNIT_NONE, 0.1},
        {"-3e-2", UNIT_NONE, -3e-2},
        {"2s", UNIT_S, 2},
        {"250ms", UNIT_S, 0.25},
        {"250N/mm2", UNIT_PA, 250e6},
        {"250N/mm\302\262", UNIT_PA, 250e6},
        {"3 mm\302\263/Nm", UNIT_WEAR, 3e-9},
        {"80kJ/mol", UNIT_MOLAR, 80e3},
        {"80e3", UNIT_MOLAR, 80e3},
        {"45deg", UNIT_ANGLE, 0.78539816339744828},
        {"45 \302\260", UNIT_ANGLE, 0.78539816339744828},
        {"5mrad", UNIT_ANGLE, 5e-3},
        {"1.2 kN/mm^2", UNIT_HARD, 1.2e9},
        {"3N/m2", UNIT_PA, 3},
        {"2.5bar", UNIT_PA, 2.5e5},
        {"300mbar", UNIT_PA, 300e2},
        {"12cP", UNIT_PAS, 12e-3},
        {"3m/s", UNIT_SPEED, 3},
        {"250mm/s", UNIT_SPEED, 0.25},
        {"36 km/h", UNIT_SPEED, 10},
        {"30m/min", UNIT_SPEED, 0.5},
        {"12mm2/s", UNIT_DIFFUSIVITY, 12e-6},
        {"1.2e-5 m^2/s", UNIT_DIFFUSIVITY, 1.2e-5},
        {"3.7MJ/m3K", UNIT_HEAT, 3.7e6},
        {"3.7 MJ/(m3 K)", UNIT_HEAT, 3.7e6},
        {"3.7J/cm^3/K", UNIT_HEAT, 3.7e6},
        {"20degC", UNIT_K, 293.15},
        {"300mK", UNIT_K, 0.3},
        {"50Hz", UNIT_HZ, 50},
        {"3P", UNIT_PAS, 0.3},
        {"2mPa.s", UNIT_PAS, 2e-3},
        {"2kgf", UNIT_N, 2 * 9.80665},
        {"50gf", UNIT_N, 50 * 9.80665e-3},
        {"2inch", UNIT_M, 2 * 25.4e-3},
        {"2in", UNIT_M, 2 * 25.4e-3},
        {"3mil", UNIT_M, 3 * 25.4e-6},
        {"3thou", UNIT_M, 3 * 25.4e-6},
        {"4microinch", UNIT_M, 4 * 25.4e-9},
        {"4uin", UNIT_M, 4 * 25.4e-9},
        {"1.5min", UNIT_S, 90},
        {"0.5 h", UNIT_S, 1800},
        {"60", UNIT_S, 60},
        {"512M", UNIT_BYTES, 512.0 * 1024 * 1024},
        {"4G", UNIT_BYTES, 4.0 * 1024 * 1024 * 1024},
        {"2GiB", UNIT_BYTES, 2.0 * 1024 * 1024 * 1024},
        {"2GB", UNIT_BYTES, 2e9},
        {"1.5k", UNIT_BYTES, 1536},
        {"65536", UNIT_BYTES, 65536},
        {"65536B", UNIT_BYTES, 65536},
    };

    (void)state;
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        struct rc_err err = {""};
        double value = NAN;
        if (unit_number(good[k].text, good[k].unit, &value, &err) != RC_OK)
            fail_msg("%s: %s", good[k].text, err.text);
        if (value != good[k].value)
            fail_msg("%s: %.17g instead of %.17g", good[k].text, value, good[k].value);
    }
}

/* Every length in micrometres with three decimals gives the nearest double in metres. */
static void
test_micrometres(void **state)
{
    char text[32], metres[32];
    double value;

    (void)state;
    for (int k = 1; k < 20000; k += 7) {
        snprintf(text, sizeof text, "%d.%03dum", k / 1000, k % 1000);
        snprintf(metres, sizeof metres, "%de-9", k);
        assert_int_equal(unit_number(text, UNIT_M, &value, NULL), RC_OK);
        assert_true(value == strtod(metres, NULL));
    }
}

/* 1 kgf/mm^2 on four faces, each 22 degrees from the plane: 1/cos(22 deg) = 1.078534743 (tables). */
static void
test_vickers(void **state)
{
    static const char *const texts[] = {"600HV", "600HV10", "600 HV0.3"};
    double value;

    (void)state;
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        assert_int_equal(unit_number(texts[k], UNIT_HARD, &value, NULL), RC_OK);
        assert_true(fabs(value / (600 * 9.80665e6 * 1.078534743) - 1) < 1e-9);
        assert_true(unit_vickers(texts[k]));
        assert_int_equal(unit_number(texts[k], UNIT_PA, &value, NULL), RC_FAIL);
    }
    assert_false(unit_vickers("6GPa"));
    assert_int_equal(unit_number("600HVx", UNIT_HARD, &value, NULL), RC_FAIL);
    assert_int_equal(unit_number("60HRC", UNIT_HARD, &value, NULL), RC_FAIL);
}

static void
test_refusals(void **state)
{
    /* clang-format off */
    static const struct {
        const char *text;
        enum unit unit;
    } bad[] = {
        {"", UNIT_M},        {" ", UNIT_M},        {"um", UNIT_M},        {"1.1 u m", UNIT_M},
        {"1.1umm", UNIT_M},  {"1.1xm", UNIT_M},    {"1.1u", UNIT_M},      {"1.1N", UNIT_M},
        {"1.1Um", UNIT_M},   {"1,1um", UNIT_M},    {"1.1.2um", UNIT_M},   {"nan", UNIT_M},
        {"inf", UNIT_M},     {"-inf", UNIT_N},     {"nanm", UNIT_M},      {"0x10", UNIT_N},
        {"1e400", UNIT_N},   {"1e305GPa", UNIT_PA}, {"--1", UNIT_N},      {"240 N N", UNIT_N},
        {"5N/mm", UNIT_PA},  {"5N/mm3", UNIT_PA},  {"5bar", UNIT_N},      {"5kgf", UNIT_PA},
        {"5cP", UNIT_PA},    {"5min", UNIT_M},     {"5N/2", UNIT_PA},     {"5/mm2", UNIT_PA},
        {"5m", UNIT_NONE},   {"5%", UNIT_NONE},    {"6GPa", UNIT_N},      {"6gPa", UNIT_PA},
        {"6Gpa", UNIT_PA},
        {"4X", UNIT_BYTES},   {"4m", UNIT_BYTES},    {"4mn", UNIT_S},   
        {"4hs", UNIT_S},    {"1e", UNIT_NONE},     {"3m", UNIT_SPEED},    {"3m/m", UNIT_SPEED},
        {"3m2/s", UNIT_SPEED}, {"3m/s", UNIT_DIFFUSIVITY}, {"3J/kgK", UNIT_HEAT},
        {"3C", UNIT_K},      {"3degF", UNIT_K},
        {"\xc2m", UNIT_M},   {"1.1\xb5m", UNIT_M}, {"1um,2um", UNIT_M},   {"0:1:3", UNIT_M},
    };
    /* clang-format on */

    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        struct rc_err err = {""};
        double value;
        if (unit_number(bad[k].text, bad[k].unit, &value, &err) != RC_FAIL)
            fail_msg("'%s' is taken for %g", bad[k].text, value);
        assert_true(err.text[0] != '\0');
    }
}

static void
check_list(const char *text, enum unit unit, size_t n, const double *v)
{
    struct numbers list;
    struct rc_err err = {""};

    if (unit_numbers(text, unit, &list, &err) != RC_OK)
        fail_msg("%s: %s", text, err.text);
    assert_int_equal(list.n, n);
    for (size_t k = 0; k < n; k++)
        if (!(fabs(list.v[k] - v[k]) <= converted * fabs(v[k])))
            fail_msg("%s: number %zu is %.17g instead of %.17g", text, k, list.v[k], v[k]);
    free(list.v);
}

static void
test_lists(void **state)
{
    (void)state;
    check_list("5um", UNIT_M, 1, (double[]){5e-6});
    check_list("1N,2.5N,10mN", UNIT_N, 3, (double[]){1, 2.5, 0.01});
    check_list("0,2um,1.5mm", UNIT_M, 3, (double[]){0, 2e-6, 1.5e-3});
    check_list("3,0,-2", UNIT_M, 3, (double[]){3, 0, -2});
    check_list("0,0", UNIT_M, 2, (double[]){0, 0});
    check_list("0:50um:6", UNIT_M, 6, (double[]){0, 10e-6, 20e-6, 30e-6, 40e-6, 50e-6});
    check_list("10N:1N:4", UNIT_N, 4, (double[]){10, 7, 4, 1});
    check_list("1:2:2", UNIT_NONE, 2, (double[]){1, 2});
    check_list("0N,1N:3N:3,5N:1N:2", UNIT_N, 6, (double[]){0, 1, 2, 3, 5, 1});
    check_list("1um:100um:log:3,1mm", UNIT_M, 4, (double[]){1e-6, 1e-5, 1e-4, 1e-3});
}

/* Values with equal ratios are exact decimals where possible: powers of ten to the last bit. */
static void
test_ratios(void **state)
{
    struct numbers list;

    (void)state;
    check_list("1MPa:1GPa:log:4", UNIT_PA, 4, (double[]){1e6, 1e7, 1e8, 1e9});
    check_list("1:10000:log:5", UNIT_N, 5, (double[]){1, 10, 100, 1000, 10000});
    check_list("8um:1um:log:4", UNIT_M, 4, (double[]){8e-6, 4e-6, 2e-6, 1e-6});
    check_list("1nm:1m:log:10", UNIT_M, 10,
               (double[]){1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1});
    check_list("2:3:log:2", UNIT_NONE, 2, (double[]){2, 3});
    check_list("7:7:log:3", UNIT_NONE, 3, (double[]){7, 7, 7});
    assert_int_equal(unit_numbers("1MPa:1GPa:log:7", UNIT_PA, &list, NULL), RC_OK);
    assert_int_equal(list.n, 7);
    assert_true(list.v[0] == 1e6 && list.v[2] == 1e7 && list.v[4] == 1e8 && list.v[6] == 1e9);
    for (size_t k = 1; k < 7; k += 2) /* half way: the square root of ten to fourteen digits */
        assert_true(fabs(list.v[k] / list.v[k - 1] - sqrt(10)) <= rounding * sqrt(10));
    free(list.v);
    assert_int_equal(unit_numbers("0.1um:0.7um:log:46", UNIT_M, &list, NULL), RC_OK);
    assert_true(list.v[0] == 0.1e-6 && list.v[45] == 0.7e-6);
    free(list.v);
}

/* Forces per length, for options that accept them. */
static void
test_forces(void **state)
{
    static const struct {
        const char *text;
        bool per_metre;
        double value;
    } good[] = {
        {"3mN/m", true, 3e-3},   {"1N/m", true, 1},      {"1.29kN/m", true, 1290},
        {"2.5N/mm", true, 2500}, {"0.3 N/m", true, 0.3}, {"7mN/um", true, 7e3},
        {"3mN", false, 3e-3},    {"3", false, 3},        {"0", false, 0},
    };
    static const char *const bad[] = {"1N/m,2N", "1N,2N/m", "1N/m,2",   "1N/",  "1/m",
                                      "1N/s",    "1Pa/m",   "1N/m/m",   "1m/N", "1N/xm",
                                      "1N/m2",   "1N//m",   "1N:2N/m:3"};
    struct numbers list;
    double value;

    (void)state;
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        struct rc_err err = {""};
        if (unit_forces(good[k].text, &list, &err) != RC_OK)
            fail_msg("%s: %s", good[k].text, err.text);
        assert_int_equal(list.n, 1);
        assert_int_equal(list.per_metre, good[k].per_metre);
        if (list.v[0] != good[k].value)
            fail_msg("%s: %.17g instead of %.17g", good[k].text, list.v[0], good[k].value);
        free(list.v);
    }
    assert_int_equal(unit_forces("0,1N/m,2N/m", &list, NULL), RC_OK);
    assert_true(list.per_metre && list.n == 3 && list.v[2] == 2);
    free(list.v);
    assert_int_equal(unit_forces("1N/m:1kN/m:log:4", &list, NULL), RC_OK);
    assert_true(list.per_metre && list.n == 4 && list.v[1] == 10);
    free(list.v);
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        struct rc_err err = {""};
        if (unit_forces(bad[k], &list, &err) != RC_FAIL)
            fail_msg("'%s' is taken for %g", bad[k], list.v[0]);
        assert_true(err.text[0] != '\0' && list.v == NULL);
    }
    assert_int_equal(unit_numbers("1N/m", UNIT_N, &list, NULL), RC_FAIL);
    assert_int_equal(unit_number("1N/m", UNIT_N, &value, NULL), RC_FAIL);
}

static void
test_decimal_commas(void **state)
{
    static const char *const doubtful[] = {"1,5",  "0001,5",  "12,34", "1,05", "-1,5",  "+2,3",
                                           "5,5",  "100,250", "0,5",   "0,5m", "-0,5N", "0,25 mm",
                                           "0,1%", "0,05um",  "0,010", "0,5eV"};
    static const char *const clear[] = {"1",     "1.5",          "1,5,9",  "1,10",
                                        "10,1",  "0,0",          "0,10um", "0,100",
                                        "0N,5N", "0,5,10",       "0,5.0",  "0,5.5m",
                                        "0,-5m", "0,1e-6mm3/Nm", "0:5m:2", "5,0",
                                        "1N,5N", "1.0,5",        "1,5.0",  "1e0,5",
                                        "1,5e0", "1:5:2",        ",5",     "1,",
                                        "1,-5",  "a,b",          "",       "1, 5",
                                        "1,5N",  "auto",         "1,5log", "10000000,50000000"};

    (void)state;
    for (size_t k = 0; k < sizeof doubtful / sizeof *doubtful; k++)
        if (!unit_decimal_comma(doubtful[k]))
            fail_msg("'%s' is not doubted", doubtful[k]);
    for (size_t k = 0; k < sizeof clear / sizeof *clear; k++)
        if (unit_decimal_comma(clear[k]))
            fail_msg("'%s' is doubted", clear[k]);
}

/* Both ends of a range are exactly the given numbers. */
static void
test_range_ends(void **state)
{
    struct numbers list;

    (void)state;
    assert_int_equal(unit_numbers("0.1um:0.7um:46", UNIT_M, &list, NULL), RC_OK);
    assert_int_equal(list.n, 46);
    assert_true(list.v[0] == 0.1e-6 && list.v[45] == 0.7e-6);
    for (size_t k = 1; k < 46; k++)
        assert_true(list.v[k] > list.v[k - 1]);
    free(list.v);
}

static void
test_bad_lists(void **state)
{
    static const char *const bad[] = {"",
                                      ",",
                                      "1,",
                                      ",1",
                                      "1um,2",
                                      "2,1um",
                                      "1um,,2um",
                                      "1um 2um",
                                      "0:1um",
                                      "0:1um:1",
                                      "0:1um:0",
                                      "0:1um:2.5",
                                      "0:1um:-3",
                                      "0:1um:3um",
                                      "1:2um:3",
                                      "1um:2:3",
                                      ":1um:3",
                                      "0::3",
                                      "0:1um:",
                                      "0:1um:3:4",
                                      "0:1um:1e9",
                                      "1,0:2:3",
                                      "0,5um:2um:4",
                                      "1,5:2:3",
                                      "3,2,5:9:3",
                                      "0:1um:nan",
                                      "1um:2um:log",
                                      "1um:2um:log:",
                                      "1um:2um:log:1",
                                      "1um:2um:log:2.5",
                                      "1um:2um:log:log:3",
                                      "1um:2um:lin:3",
                                      "0:1um:log:3",
                                      "1um:0:log:3",
                                      "-1um:1um:log:3",
                                      "-2um:-1um:log:3",
                                      "1um:2:log:3",
                                      "1um:log:3",
                                      "log:3",
                                      "1um:2um:3:log",
                                      "1um:2um:log:3um"};

    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        struct numbers list;
        struct rc_err err = {""};
        if (unit_numbers(bad[k], UNIT_M, &list, &err) != RC_FAIL)
            fail_msg("'%s' is taken for %zu numbers", bad[k], list.n);
        assert_true(err.text[0] != '\0');
    }
}

/* The decimal mark is a point in every locale. */
static void
test_comma_locale(void **state)
{
    double value;

    (void)state;
    if (setlocale(LC_ALL, "de_DE.UTF-8") == NULL && setlocale(LC_ALL, "fr_FR.UTF-8") == NULL)
        skip();
    assert_int_equal(unit_number("1.29um", UNIT_M, &value, NULL), RC_OK);
    assert_true(value == 1.29e-6);
    assert_int_equal(unit_number("1,29um", UNIT_M, &value, NULL), RC_FAIL);
    setlocale(LC_ALL, "C");
}

/* A number that rounds to 1000 or 1024 of a unit is printed as one of the next unit. */
static void
test_shown(void **state)
{
    static const struct {
        double value;
        const char *unit, *shown;
    } numbers[] = {
        {999.999e-6, "m", "999.999 um"},
        {999.9999e-6, "m", "1 mm"},
        {-999.9999e-9, "m", "-1 um"},
        {999.9999e6, "Pa", "1 GPa"},
        {1e-6, "m", "1 um"},
        {999.9999, "m", "1000 m"}, /* nobody says km */
        {999.9999, "deg", "1000 deg"},
        {0, "N", "0 N"},
        {INFINITY, "Pa", "inf Pa"},
    };
    static const struct {
        double value;
        const char *shown;
    } sizes[] = {
        {0, "0 bytes"},
        {1023, "1023 bytes"},
        {1024, "1 KiB"},
        {1536, "1.5 KiB"},
        {1023.4 * 1024, "1023 KiB"},
        {1023.5 * 1024, "1 MiB"},
        {1048575, "1 MiB"},
        {1048576, "1 MiB"},
        {1.5e9, "1431 MiB"},
        {7.36 * 1048576, "7.4 MiB"},
        {9.99 * 1048576, "10 MiB"},
        {10.4 * 1048576, "10 MiB"},
    };
    static const struct {
        double share;
        int digits;
        const char *shown;
    } shares[] = {
        {0, 2, "0 %"},          {1.32e-4, 2, "0.013 %"}, {1.32e-9, 2, "0.00000013 %"},
        {0.05, 3, "5 %"},       {0.0999, 2, "10 %"},     {0.0999, 3, "9.99 %"},
        {0.5, 1, "50 %"},       {1.374, 2, "137 %"},     {12345.678, 2, "1234568 %"},
        {-0.0314, 2, "-3.1 %"}, {1e-30, 2, "0 %"},       {1e300, 2, "1e+302 %"},
        {INFINITY, 2, "inf %"}, {NAN, 2, "unknown"},
    };
    char text[SHOWN_NUMBER];

    (void)state;
    for (size_t k = 0; k < sizeof shares / sizeof *shares; k++)
        assert_string_equal(shown_percent_to(text, shares[k].share, shares[k].digits),
                            shares[k].shown);
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        assert_string_equal(shown_in_unit_to(text, numbers[k].value, numbers[k].unit),
                            numbers[k].shown);
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
        assert_string_equal(shown_bytes_to(text, sizes[k].value), sizes[k].shown);
}

static void
test_conductivities(void **state)
{
    static const struct {
        const char *text;
        double k1, k2;
        const char *conductance;
    } good[] = {
        {"45W/mK,16.3W/mK", 45, 16.3, "W/K"},
        {"45W/(m K),16.3 W/m/K", 45, 16.3, "W/K"},
        {"0.2mW/mK,1.1kW/(m*K)", 0.2e-3, 1.1e3, "W/K"},
        {"4.01W/cmK,4.01W/(cm K)", 401, 401, "W/K"},
        {"58MS/m,7.1MS/m", 58e6, 7.1e6, "S"},
        {"0.29S/um,2.9kS/cm", 0.29e6, 2.9e5, "S"},
        {"45,1.6e1", 45, 16, NULL},
    };
    static const char *const bad[] = {
        "",
        "45",
        "45,",
        ",45",
        "45,16,3",
        "45W/mK",
        "45,0",
        "-45,16",
        "45W/mK,16",
        "45W/mK,16S/m",
        "45W/m,16W/m",
        "45W,16W",
        "45x,16",
        "45W/mKK,1W/mK",
        "45S/mK,1S/mK",
        "45W/K,16W/K",
        "45MW/m2K,1W/mK",
        "1e999,1",
        "inf,1",
        "nan,1",
        "45S/,1S/m",
        "45/m,1S/m",
    };

    (void)state;
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        double k[2] = {NAN, NAN};
        const char *conductance;
        struct rc_err err;
        assert_int_equal(unit_conductivities(good[i].text, k, &conductance, &err), RC_OK);
        assert_true(k[0] == good[i].k1 && k[1] == good[i].k2);
        if (good[i].conductance == NULL)
            assert_null(conductance);
        else
            assert_string_equal(conductance, good[i].conductance);
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        double k[2];
        const char *conductance;
        struct rc_err err = {""};
        if (unit_conductivities(bad[i], k, &conductance, &err) == RC_OK)
            fail_msg("'%s' was taken", bad[i]);
        assert_true(err.text[0] != '\0');
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers),        cmocka_unit_test(test_micrometres),
        cmocka_unit_test(test_vickers),        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_lists),          cmocka_unit_test(test_range_ends),
        cmocka_unit_test(test_bad_lists),      cmocka_unit_test(test_comma_locale),
        cmocka_unit_test(test_ratios),         cmocka_unit_test(test_forces),
        cmocka_unit_test(test_decimal_commas), cmocka_unit_test(test_shown),
        cmocka_unit_test(test_conductivities),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
