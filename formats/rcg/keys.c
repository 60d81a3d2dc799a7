/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Keys with a fixed meaning, and the values that they can have (rcg(5)). A reader that knows the words of a
 * key need not expect others.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/grid.h"
#include "rcg.h"

/* What the value of a key is. */
enum kind {
    KEY_TEXT, /* any; tools that use it read it themselves */
    KEY_WORD,
    KEY_NUMBER,
    KEY_COUNT,  /* a whole number             */
    KEY_NUMBERS /* numbers separated by commas */
};

struct rule {
    const char *name;
    enum kind kind;
    const char *const *words; /* those of KEY_WORD; ends with NULL */
    double least, most;       /* bounds of a number                   */
    bool above;               /* least itself is out of bounds        */
    const char *unit;         /* NULL: a number without a unit        */
};

#define TEXT .kind = KEY_TEXT
#define WORDS .kind = KEY_WORD, .words = (const char *const[])
#define NUMBER .kind = KEY_NUMBER, .least = -INFINITY, .most = INFINITY
#define FROM(l) .kind = KEY_NUMBER, .least = (l), .most = INFINITY
#define ABOVE(l) .kind = KEY_NUMBER, .least = (l), .most = INFINITY, .above = true
#define RATIO .kind = KEY_NUMBER, .least = -1, .most = 0.5, .above = true
#define COUNT .kind = KEY_COUNT, .least = 1, .most = 1e15
#define LIST .kind = KEY_NUMBERS, .least = 0, .most = INFINITY

/* clang-format off */
static const struct rule keys[] = {
    {"source", TEXT},
    {"history", TEXT},
    {"form", TEXT},
    {"layers", TEXT},
    {"layers.residual", TEXT},
    {"adhesion", TEXT},
    {"dunit", TEXT},
    {"window", TEXT},
    {"periodic", WORDS{"yes", "no", "x", "y", NULL}},
    {"boundary", WORDS{"free", "periodic", "periodic-x", "periodic-y", NULL}},
    {"datum", ABOVE(0), .unit = "m"},
    {"converged", WORDS{"yes", "no", NULL}},
    {"separated", WORDS{"yes", NULL}},
    {"hardness_map", WORDS{"yes", NULL}},
    {"section", WORDS{"x", "y", NULL}},
    {"direction", WORDS{"x", "y", NULL}},
    {"case", COUNT},
    {"frames", COUNT},
    {"material", COUNT},
    {"slabs", COUNT},
    {"estar", ABOVE(0), .unit = "Pa"},
    {"e1", ABOVE(0), .unit = "Pa"},
    {"nu", RATIO},
    {"e2", ABOVE(0), .unit = "Pa"},
    {"nu2", RATIO},
    {"load", NUMBER, .unit = "N"},
    {"approach", NUMBER, .unit = "m"},
    {"hardness", ABOVE(0), .unit = "Pa"},
    {"yield", ABOVE(0), .unit = "Pa"},
    {"hardening", FROM(0), .unit = "Pa"},
    {"depth", FROM(0), .unit = "m"},
    {"depths", LIST, .unit = "m"},
    {"thickness", ABOVE(0), .unit = "m"},
    {"at", NUMBER, .unit = "m"},
    {"mu", NUMBER},
    {"friction", FROM(0)},
    {"tau_max", ABOVE(0), .unit = "Pa"},
    {"tangential_x", NUMBER, .unit = "N"},
    {"tangential_y", NUMBER, .unit = "N"},
    {"displacement_x", NUMBER, .unit = "m"},
    {"displacement_y", NUMBER, .unit = "m"},
    {"creep_x", NUMBER},
    {"creep_y", NUMBER},
    {"spin", NUMBER, .unit = "rad/m"},
    {"position", NUMBER, .unit = "m"},
    {"height", NUMBER, .unit = "m"},
    {"window_x", NUMBER, .unit = "m"},
    {"time", FROM(0), .unit = "s"},
    {"speed", NUMBER, .unit = "m/s"},
    {"distance", FROM(0), .unit = "m"},
    {"cycles", FROM(0)},
    {"wear_1", FROM(0), .unit = "1/Pa"},
    {"wear_2", FROM(0), .unit = "1/Pa"},
    {"coat_left", FROM(0), .unit = "m"},
    {"bending_limit", ABOVE(0), .unit = "Pa"},
    {"torsion_limit", ABOVE(0), .unit = "Pa"},
    {"max_temperature", NUMBER, .unit = "K"},
    {"flow_conductance", FROM(0), .unit = "m3"},
    {"flow_rate", NUMBER, .unit = "m3/s"},
    {"pressure_drop", NUMBER, .unit = "Pa"},
    {"viscosity", ABOVE(0), .unit = "Pa s"},
    {"throat_x", NUMBER, .unit = "m"},
    {"throat_y", NUMBER, .unit = "m"},
    {"filled", FROM(0)},
    {"outliers", FROM(0)},
    {"spikes", FROM(0)},
    {"taper", FROM(0), .unit = "m"},
    {"form.radius", NUMBER, .unit = "m"},
    {"height.error", FROM(0), .unit = "m"},
    {"pressure.error", FROM(0)},
    {"traction.error", FROM(0)},
    {"align.shift_x", NUMBER, .unit = "m"},
    {"align.shift_y", NUMBER, .unit = "m"},
    {"align.rotation", NUMBER, .unit = "rad"},
    {"align.residual", FROM(0), .unit = "m"},
    {"align.volume", NUMBER, .unit = "m3"},
    {"align.volume_error", FROM(0), .unit = "m3"},
};
/* clang-format on */

enum {
    KEYS = sizeof keys / sizeof *keys
};

static bool
is_word(const struct rule *key, const char *text)
{
    size_t k = 0;

    while (key->words[k] != NULL && strcmp(key->words[k], text) != 0)
        k++;
    return key->words[k] != NULL;
}

/* Reads the number at the beginning of a text. NULL: there is none that the key can have. */
static const char *
take_number(const struct rule *key, const char *text)
{
    double v;
    const char *end = rc_number_read(text, false, &v);

    if (end == NULL || !isfinite(v) || !(v >= key->least && v <= key->most) ||
        (key->above && v == key->least) || (key->kind == KEY_COUNT && v != floor(v)))
        return NULL;
    return end;
}

static bool
fits(const struct rule *key, const char *text)
{
    if (key->kind == KEY_TEXT)
        return true;
    if (key->kind == KEY_WORD)
        return is_word(key, text);
    do
        text = take_number(key, text);
    while (text != NULL && key->kind == KEY_NUMBERS && *text++ == ',');
    return text != NULL && (key->kind == KEY_NUMBERS ? text[-1] : *text) == '\0';
}

/* "above -1 and at most 0.5" */
static void
describe_bounds(const struct rule *key, char *to, size_t size)
{
    size_t n = 0;

    *to = '\0';
    if (isfinite(key->least))
        n = (size_t)snprintf(to, size, " %s %g", key->above ? "above" : "of at least", key->least);
    if (isfinite(key->most) && key->kind == KEY_NUMBER)
        snprintf(to + n, size - n, " and at most %g", key->most);
}

static void
describe(const struct rule *key, char *to, size_t size)
{
    static const char *const nouns[] = {
        [KEY_NUMBER] = "a number", [KEY_COUNT] = "a whole number", [KEY_NUMBERS] = "numbers"};
    size_t n = 0;

    if (key->kind == KEY_WORD) {
        for (size_t k = 0; key->words[k] != NULL && n < size; k++)
            n += (size_t)snprintf(to + n, size - n, "%s%s",
                                  k == 0                      ? ""
                                  : key->words[k + 1] == NULL ? " or "
                                                              : ", ",
                                  key->words[k]);
        return;
    }
    n = (size_t)snprintf(to, size, "%s", nouns[key->kind]);
    if (key->unit != NULL)
        n += (size_t)snprintf(to + n, size - n, " in %s", key->unit);
    describe_bounds(key, to + n, size - n);
    if (key->kind == KEY_NUMBERS)
        strncat(to, ", separated by commas", size - strlen(to) - 1);
}

static enum rc_status
check(const struct rule *key, const char *text, struct rc_err *err)
{
    char must[128];

    if (fits(key, text))
        return RC_OK;
    describe(key, must, sizeof must);
    return rc_err_set(err, "%s=%.60s: it must be %s", key->name, text, must);
}

enum rc_status
rc_key_check(const char *name, const char *value, struct rc_err *err)
{
    for (size_t k = 0; k < KEYS; k++)
        if (strcmp(keys[k].name, name) == 0)
            return check(&keys[k], value, err);
    return RC_OK;
}

enum rc_status
rc_keys_check(const struct rc_grid *g, struct rc_err *err)
{
    for (size_t k = 0; k < KEYS; k++) {
        const char *text = rc_grid_get(g, keys[k].name);

        if (text != NULL && check(&keys[k], text, err) != RC_OK)
            return RC_FAIL;
    }
    return RC_OK;
}
