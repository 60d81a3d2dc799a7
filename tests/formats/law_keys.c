/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A key with a fixed meaning has one of its words, or a number within its bounds; any other value is
 * refused with a message that names the key and the value. Other keys have any value. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "formats/rcg/rcg.h"
#include "libcontact/grid.h"

#define LIST(...)                                                                                  \
    (const char *const[])                                                                          \
    {                                                                                              \
        __VA_ARGS__, NULL                                                                          \
    }

static const char *const malformed[] = {"",   "abc", "nan", "inf", "-inf", "1e999", "1,5", " 1",
                                        "1 ", "0x1", "1m",  "--1", "1e",   "yes",   "\n",  NULL};
static const char *const negative[] = {"-1", "-1e-300", NULL};
static const char *const zero[] = {"0", "-0", "0e5", NULL};

/* Keys of one kind, and values that they have and do not have. */
static const struct kind {
    const char *const *keys, *const *good, *const *bad, *const *also_bad, *const *not_zero;
} kinds[] = {
    {LIST("periodic"), LIST("yes", "no", "x", "y"),
     LIST("", "Yes", "true", "1", "xy", "yes ", "yes,no", "perodic"), NULL, NULL},
    {LIST("converged"), LIST("yes", "no"),
     LIST("", "Yes", "true", "1", "x", "yes ", "yes,no", "perodic"), NULL, NULL},
    {LIST("boundary"), LIST("free", "periodic", "periodic-x", "periodic-y"),
     LIST("", "perodic", "periodic-z", "Free", "yes", "free periodic"), NULL, NULL},
    {LIST("hardness_map", "separated"), LIST("yes"), LIST("", "no", "1"), NULL, NULL},
    {LIST("section", "direction"), LIST("x", "y"), LIST("", "z", "X", "xy", "x,y", "0"), NULL,
     NULL},
    {LIST("load", "approach", "at", "mu", "tangential_x", "tangential_y", "displacement_x",
          "displacement_y", "creep_x", "creep_y", "spin", "position", "height", "window_x", "speed",
          "form.radius", "align.shift_x", "align.shift_y", "align.rotation", "align.volume",
          "throat_x", "throat_y", "flow_rate", "pressure_drop"),
     LIST("0", "-1", "1", "+1.5e-6", ".5", "5.", "-2E3"), malformed, NULL, NULL},
    {LIST("depth", "hardening", "time", "distance", "cycles", "wear_1", "wear_2", "taper", "filled",
          "outliers", "spikes", "align.residual", "align.volume_error", "height.error",
          "pressure.error", "traction.error", "friction", "flow_conductance"),
     LIST("0", "1", "1e-6", "2.5"), malformed, negative, NULL},
    {LIST("datum", "estar", "e1", "e2", "hardness", "yield", "tau_max", "thickness",
          "bending_limit", "torsion_limit", "viscosity"),
     LIST("1", "1e-6", "2e11"), malformed, negative, zero},
    {LIST("nu", "nu2"), LIST("0", "0.5", "-0.9", "0.3"), malformed, LIST("-1", "0.6", "1"), NULL},
    {LIST("case", "frames", "material", "slabs"), LIST("1", "7", "123456789012345"), malformed,
     LIST("-1", "1.5", "1e-3"), zero},
    {LIST("depths"), LIST("0", "0,1e-6", "1,2,3.5"),
     LIST("", "abc", "1,", ",1", "1,,2", "1;2", "1,nan", "1, 2"), negative, NULL},
};

static void
refused(const char *const *keys, const char *const *values)
{
    for (const char *const *key = keys; values != NULL && *key != NULL; key++)
        for (const char *const *value = values; *value != NULL; value++) {
            char both[128];
            struct rc_err err = {.text = ""};

            snprintf(both, sizeof both, "%s=%s: it must be ", *key, *value);
            if (rc_key_check(*key, *value, &err) != RC_FAIL || strstr(err.text, both) == NULL)
                fail_msg("%s: %s", both, err.text);
        }
}

static void
test_kinds(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        for (const char *const *key = kinds[k].keys; *key != NULL; key++)
            for (const char *const *value = kinds[k].good; *value != NULL; value++) {
                struct rc_err err = {.text = ""};
                if (rc_key_check(*key, *value, &err) != RC_OK)
                    fail_msg("%s=%s is refused: %s", *key, *value, err.text);
            }
        refused(kinds[k].keys, kinds[k].bad);
        refused(kinds[k].keys, kinds[k].also_bad);
        refused(kinds[k].keys, kinds[k].not_zero);
    }
}

static void
test_frames(void **state)
{
    const struct rc_shape shape = {1, 1, 1, 1};
    struct rc_err err;
    struct rc_grid *g = rc_grid_new(&shape, "height", "m", &err);

    (void)state;
    assert_non_null(g);
    assert_int_equal(rc_grid_set(g, "note", "perodic", &err), RC_OK);
    assert_int_equal(rc_grid_set(g, "source", "", &err), RC_OK);
    assert_int_equal(rc_grid_set(g, "boundary", "free", &err), RC_OK);
    assert_int_equal(rc_keys_check(g, &err), RC_OK);
    assert_int_equal(rc_grid_set(g, "nu2", "2", &err), RC_OK);
    assert_int_equal(rc_keys_check(g, &err), RC_FAIL);
    assert_string_equal(err.text, "nu2=2: it must be a number above -1 and at most 0.5");
    rc_grid_free(g);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_kinds), cmocka_unit_test(test_frames)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
