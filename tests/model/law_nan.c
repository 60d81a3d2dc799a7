/* SPDX-License-Identifier: GPL-3.0-or-later */
/* NaN is never a result. Each row of models.list gets numbers that are NaN, infinite, or so large or
 * small that sums overflow: in points, heights and stored states. The model refuses them with a
 * sentence, or it is not converged. It never says "converged" with NaN in a frame, or in a figure that
 * is known otherwise. After a go or a step that failed, figures are unknown, and look, keep, step and
 * frames are refused. */
#include "kinds.h"

/* With the address sanitizer a step takes several times as long. A commit then tries each number at one of
 * two points, fewer states, and two numbers for each. */
static bool
fewer(void)
{
#ifdef __SANITIZE_ADDRESS__
    return getenv("RC_LONG") == NULL;
#else
    return false;
#endif
}

enum {
    FEW = 60 /* steps of a run with such numbers */
};

/* figures and frames that a usual run knows at each point */
static bool known[KINDS][256], shown[KINDS][256];
static size_t tried, refused, short_of, reached, wrong;

/* Prints the first false results; the test goes on, to count them all. */
static void
complain(const char *what, const char *of, const char *why)
{
    if (wrong++ < 40)
        printf("%s: %s %s\n", what, of, why);
}

/* True if the frame has no NaN. */
static bool
whole(struct rc_model *m, const char *name)
{
    struct rc_err err;
    double map[N];
    bool good = rc_model_frame(m, name, map, &err) == RC_OK;

    for (size_t i = 0; i < N && good; i++)
        good = !isnan(map[i]);
    return good;
}

static void
usual(size_t q)
{
    struct rc_model *m = make(&kinds[q]);
    struct rc_err err = {""};
    const void *data;
    const struct rc_figure *f;
    const struct rc_frame_kind *kind;

    memset(known[q], true, sizeof known[q]);
    memset(shown[q], true, sizeof shown[q]);
    assert_true(isnan(rc_model_number(m, "load")) && isnan(rc_model_number(m, "converged")));
    for (int k = 0; k < POINTS; k++) {
        const struct rc_point to = point_of(&kinds[q], k);
        const enum rc_status status = rc_model_run(m, &to, &err);
        assert_true(status == RC_OK || status == RC_SHORT);
        assert_int_equal(rc_model_look(m, NULL, &err), RC_OK);
        for (size_t j = 0; (f = rc_model_figure(m, j, &data)) != NULL; j++)
            known[q][j] &= !isnan(rc_figure_number(f, data));
        for (size_t j = 0; (kind = rc_model_frame_kind(m, j)) != NULL; j++)
            shown[q][j] &= whole(m, kind->name);
        assert_int_equal(rc_model_keep(m, &err), RC_OK);
    }
    rc_model_free(m);
}

/* Nothing can be had from a model that failed. */
static void
silent(struct rc_model *m, const char *what)
{
    struct rc_err err = {""};
    struct rc_point at;
    const struct rc_figure *f;
    const void *data;
    double map[N];

    err.text[0] = '\0';
    if (rc_model_look(m, &at, &err) != RC_FAIL || err.text[0] == '\0')
        fail_msg("%s: a look after a failure: \"%s\"", what, err.text);
    for (size_t a = 0; a < RC_AXES; a++)
        assert_true(isnan(at.at[a]));
    for (size_t k = 0; (f = rc_model_figure(m, k, &data)) != NULL; k++)
        if (!isnan(rc_figure_number(f, data)) || rc_figure_word(f, data) != NULL)
            complain(what, f->name, "is known after a failure");
    assert_int_equal(rc_model_frame(m, rc_model_frame_kind(m, 0)->name, map, &err), RC_FAIL);
    assert_int_equal(rc_model_step(m, &err), RC_FAIL);
    assert_int_equal(rc_model_keep(m, &err), RC_FAIL);
}

/* True for figures of the outermost model. An inner one may have converged while the outer one has not. */
static bool
is_own(const struct rc_model *m, const void *data)
{
    for (const struct rc_figure_set *s = m->row->figures; s->table != NULL; s++)
        if (data == (const char *)m + s->at)
            return true;
    return false;
}

/* Checks a model that has stopped with this status. */
static void
honest(struct rc_model *m, size_t q, enum rc_status status, const char *what)
{
    struct rc_err err = {""};
    const struct rc_figure *f;
    const struct rc_frame_kind *kind;
    const void *data;
    bool converged = status == RC_OK, unloaded, few_slabs = false;

    if (rc_model_look(m, NULL, &err) != RC_OK) {
        assert_true(err.text[0] != '\0');
        refused++;
        return;
    }
    for (size_t k = 0; (f = rc_model_figure(m, k, &data)) != NULL; k++) {
        converged |=
            is_own(m, data) && strcmp(f->name, "converged") == 0 && rc_figure_number(f, data) > 0;
        few_slabs |=
            strcmp(f->name, "slab_error_estimate") == 0 && isnan(rc_figure_number(f, data));
    }
    /* without load some figures are unknown; where all nodes in contact yield, the approach is; where
     * fewer than six of the given slabs yield, their error is, and with it that of the pressure */
    unloaded = rc_model_number(m, "load") == 0 ||
               rc_model_number(m, "plastic_area") >= rc_model_number(m, "contact_area");
    *(converged ? &reached : &short_of) += 1;
    for (size_t k = 0; converged && (f = rc_model_figure(m, k, &data)) != NULL; k++)
        if (known[q][k] && !unloaded && strcmp(f->name, "slab_error_estimate") != 0 &&
            !(few_slabs && strcmp(f->name, "pressure_error_estimate") == 0) &&
            f->kind == RC_NUMBER && isnan(rc_figure_number(f, data)))
            complain(what, f->name, "is NaN, and the model is converged");
    for (size_t k = 0; converged && (kind = rc_model_frame_kind(m, k)) != NULL; k++)
        if (shown[q][k] && !whole(m, kind->name))
            complain(what, kind->name, "has NaN, and the model is converged");
}

/* Goes to a point with such a number, `going`: the point is set already. */
static void
walk(struct rc_model *m, size_t q, const struct rc_point *to, bool going, const char *what)
{
    struct rc_err err = {""};
    enum rc_status status = going ? RC_MORE : rc_model_go(m, to, &err);

    tried++;
    for (size_t k = 0; k < FEW && status == RC_MORE; k++) {
        status = rc_model_step(m, &err);
        if (k < 3 && status == RC_MORE)
            honest(m, q, status, what);
    }
    if (status != RC_FAIL) {
        honest(m, q, status, what);
        return;
    }
    if (err.text[0] == '\0')
        fail_msg("%s: refused without a word", what);
    refused++;
    silent(m, what);
}

static void
summary(const char *what)
{
    printf(
        "%s: %zu runs; %zu looks refused or runs failed, %zu looks not converged, %zu converged\n",
        what, tried, refused, short_of, reached);
    tried = refused = short_of = reached = 0;
    if (wrong > 0) {
        const size_t count = wrong;
        wrong = 0;
        fail_msg("%zu false results", count);
    }
}

static const double bad[] = {NAN,   -NAN, INFINITY, -INFINITY, 1e300, -1e300,
                             1e160, 1e37, -1e37,    1e20,      1e-300};

static void
in_points(void **state)
{
    (void)state;
    for (size_t q = 0; q < KINDS; q++) {
        const struct kind *kind = &kinds[q];
        usual(q);
        for (int a = 0; a < AXES && (a == 0 || kind->axis[a] != RC_LOAD); a++)
            for (size_t b = 0; b < sizeof bad / sizeof *bad; b++)
                for (int at = fewer() ? (int)(q + b) % 2 : 0; at < 2; at += fewer() ? 2 : 1) {
                    /* the first point, and the next one */
                    struct rc_model *m = make(kind);
                    struct rc_err err = {""};
                    struct rc_point to = point_of(kind, 0);
                    char what[128];
                    snprintf(what, sizeof what, "%s, point %d, %s %g", kind->name, at,
                             rc_axis_info(kind->axis[a])->name, bad[b]);
                    if (at > 0) {
                        assert_true(rc_model_run(m, &to, &err) != RC_FAIL);
                        assert_int_equal(rc_model_keep(m, &err), RC_OK);
                        to = point_of(kind, 1);
                    }
                    to.at[kind->axis[a]] = bad[b];
                    if (isnan(bad[b])) {
                        assert_int_equal(rc_model_go(m, &to, &err), RC_FAIL);
                        silent(m, what);
                    }
                    walk(m, q, &to, false, what);
                    rc_model_free(m);
                }
    }
    summary("points");
}

/* A reached point is no longer there after a go that failed; the next good go works. */
static void
after_a_failure(void **state)
{
    (void)state;
    for (size_t q = 0; q < KINDS; q++) {
        struct rc_model *m = make(&kinds[q]);
        struct rc_point first = point_of(&kinds[q], 0), none = first;
        struct rc_err err = {""};
        none.at[kinds[q].axis[0]] = NAN;
        assert_true(rc_model_run(m, &first, &err) != RC_FAIL);
        assert_int_equal(rc_model_look(m, NULL, &err), RC_OK);
        assert_int_equal(rc_model_go(m, &none, &err), RC_FAIL);
        silent(m, kinds[q].name);
        if (rc_model_run(m, &first, &err) == RC_FAIL || rc_model_look(m, NULL, &err) != RC_OK ||
            rc_model_keep(m, &err) != RC_OK)
            fail_msg("%s: %s", kinds[q].name, err.text);
        rc_model_free(m);
    }
}

static void
in_heights(void **state)
{
    (void)state;
    for (size_t q = 0; q < KINDS; q++)
        for (size_t b = 0; b < sizeof bad / sizeof *bad; b++) {
            const double was = heights[N / 2 + 3];
            const struct rc_point to = point_of(&kinds[q], 0);
            struct rc_err err = {""};
            struct rc_model *m;
            char what[128];
            snprintf(what, sizeof what, "%s, height %g", kinds[q].name, bad[b]);
            heights[N / 2 + 3] = bad[b];
            m = kinds[q].make(&err);
            if (m != NULL)
                walk(m, q, &to, false, what);
            else if (err.text[0] == '\0')
                fail_msg("%s: refused without a word", what);
            rc_model_free(m);
            heights[N / 2 + 3] = was;
        }
    summary("heights");
}

/* Numbers of a state, and some of its maps, are replaced one by one. */
static void
in_states(void **state)
{
    const bool all = getenv("RC_LONG") != NULL;
    const size_t few = all ? 1 : fewer() ? 16 : 4;

    (void)state;
    for (size_t q = 0; q < KINDS; q++)
        for (size_t steps = 2; steps < 40; steps += all ? 1 + steps / 2 : 17) {
            const struct rc_point first = point_of(&kinds[q], 0), second = point_of(&kinds[q], 1);
            struct rc_model *m = make(&kinds[q]);
            struct rc_err err = {""};
            enum rc_status status;
            size_t n;
            double *v;
            bool going;
            assert_true(rc_model_run(m, &first, &err) != RC_FAIL);
            assert_int_equal(rc_model_keep(m, &err), RC_OK);
            assert_int_equal(status = rc_model_go(m, &second, &err), RC_MORE);
            for (size_t k = 0; k < steps && status == RC_MORE; k++)
                status = rc_model_step(m, &err);
            n = rc_model_state_size(m);
            v = malloc(n * sizeof *v);
            assert_non_null(v);
            rc_model_state(m, v);
            rc_model_free(m);
            for (size_t k = q % few; k < n; k += k < 60 ? few : 1 + n / (all ? 24 : 6))
                for (size_t b = fewer() ? k / few % 3 * 2 : 0; b < sizeof bad / sizeof *bad;
                     b += fewer() ? 6 : 2) {
                    const double was = v[k];
                    char what[128];
                    snprintf(what, sizeof what, "%s, %zu steps, state %zu is %g", kinds[q].name,
                             steps, k, bad[b]);
                    m = make(&kinds[q]);
                    v[k] = bad[b];
                    err.text[0] = '\0';
                    if (rc_model_restore(m, v, n, &going, &err) == RC_OK) {
                        assert_true(!isnan(bad[b]));
                        walk(m, q, NULL, true, what);
                    } else {
                        tried++, refused++;
                        assert_true(err.text[0] != '\0');
                    }
                    rc_model_free(m);
                    v[k] = was;
                }
            free(v);
            if (status != RC_MORE)
                break;
        }
    summary("states");
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(in_points),
        cmocka_unit_test(after_a_failure),
        cmocka_unit_test(in_heights),
        cmocka_unit_test(in_states),
    };

    return cmocka_run_group_tests(tests, make_heights, NULL);
}
