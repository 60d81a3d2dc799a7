/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of figures: names, units and titles are valid for columns and axes, a name has one meaning in all
 * tables. Values are those of the members. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "libcontact/contact.h"
#include "libcontact/model/row.h"

static const char *const tables[] = {
#define RC_FIGURES(name) #name,
#include "libcontact/model/figures.list"
#undef RC_FIGURES
};

/* A frame of some model, or of rc-stress. */
static bool
is_frame(const char *name)
{
#define RC_MODEL(row) &rc_model_##row,
    static const struct rc_model_row *const models[] = {
#include RC_MODELS_LIST
    };
#undef RC_MODEL
    bool is = false;

    assert_non_null(name);
    for (int c = 0; c < RC_STRESSES; c++)
        is |= strcmp(rc_component_names[c], name) == 0;
    for (size_t k = 0; k < sizeof models / sizeof *models; k++)
        for (const struct rc_frame_kind *f = models[k]->frame; f->name != NULL; f++)
            is |= strcmp(f->name, name) == 0;
    return is;
}

static void
check_row(const struct rc_figure *f)
{
    static const char ending[] = "_error_estimate";
    const struct rc_figure *found = rc_figure_find(f->name);

    assert_true(islower(f->name[0]));
    assert_int_equal(strspn(f->name, "abcdefghijklmnopqrstuvwxyz0123456789_."), strlen(f->name));
    assert_non_null(f->title);
    assert_true(isupper(f->title[0]) && f->title[strlen(f->title) - 1] != '.');
    assert_true(f->unit == NULL || strcmp(f->unit, "1") != 0);
    /* an estimated error is named so, and says what it belongs to and how it becomes smaller */
    assert_int_equal(f->role == RC_FIGURE_ERROR,
                     strlen(f->name) > strlen(ending) &&
                         strcmp(f->name + strlen(f->name) - strlen(ending), ending) == 0);
    assert_int_equal(f->role == RC_FIGURE_ERROR, f->by != NULL);
    if (f->role == RC_FIGURE_ERROR && !is_frame(f->of) && rc_figure_find(f->of) == NULL)
        fail_msg("%s belongs to %s, which is no figure and no frame", f->name, f->of);
    assert_int_equal(f->limit != 0, f->warning != NULL);
    assert_true(f->kind == RC_NUMBER || f->unit == NULL);
    /* the first figure of that name, which has the same meaning; its unit may be known at run time only */
    assert_string_equal(found->title, f->title);
    assert_true(found->unit == NULL || (f->unit != NULL && strcmp(found->unit, f->unit) == 0));
}

static void
rows(void **state)
{
    (void)state;
    for (size_t t = 0; t < sizeof tables / sizeof *tables; t++) {
        const struct rc_figure *table = rc_figures(tables[t]), *f;
        assert_non_null(table);
        for (f = table; f->name != NULL; f++) {
            check_row(f);
            for (const struct rc_figure *g = table; g < f; g++)
                if (strcmp(f->name, g->name) == 0 || f->at == g->at)
                    fail_msg("%s: %s and %s are one", tables[t], g->name, f->name);
        }
        assert_true(f > table + 1);
    }
    /* each error of an increment has a row: friction's too */
    for (const struct rc_figure *f = rc_figures("friction");; f++) {
        assert_non_null(f->name);
        if (f->at == offsetof(struct rc_friction_figures, increment_error))
            break;
    }
    assert_null(rc_figures("no such table"));
    assert_null(rc_figure_find("no such figure"));
}

struct sample {
    bool yes;
    size_t count;
    double number;
    const char *word;
};

static void
values(void **state)
{
    static const struct rc_figure table[] = {
        {RC_FIGURE(struct sample, yes), NULL, "Yes"},
        {RC_FIGURE(struct sample, count), NULL, "Count"},
        {RC_FIGURE(struct sample, number), "m", "Number"},
        {RC_FIGURE_AS("name", struct sample, word), NULL, "Word"}};
    const struct sample v = {true, 7, -2.5, "fft"}, w = {.number = NAN};

    (void)state;
    assert_true(rc_figure_number(&table[0], &v) == 1 && rc_figure_number(&table[0], &w) == 0);
    assert_true(rc_figure_number(&table[1], &v) == 7);
    assert_true(rc_figure_number(&table[2], &v) == -2.5 && isnan(rc_figure_number(&table[2], &w)));
    assert_true(isnan(rc_figure_number(&table[3], &v)));
    assert_string_equal(rc_figure_word(&table[3], &v), "fft");
    assert_null(rc_figure_word(&table[3], &w));
    assert_null(rc_figure_word(&table[2], &v));
    assert_string_equal(table[3].name, "name");
    for (int k = 0; k < 4; k++)
        assert_true(isnan(rc_figure_number(&table[k], NULL)) &&
                    rc_figure_word(&table[k], NULL) == NULL);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows),
        cmocka_unit_test(values),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
