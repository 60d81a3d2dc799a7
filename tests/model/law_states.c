/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A state may be taken after every step, from the first to the last. A fresh model that goes on from it
 * ends with the same bits in all frames, in the figures other than those of the cost, and in the found
 * axes. This holds for every row of models.list that is marked `exact` in kinds.h. The others keep only
 * the pressure of their iteration, and end within the tolerance of that table. Reached points that are
 * kept or not, and states of restored models, are included. */
#include "kinds.h"

enum {
    FIGURES = 128,
    FRAMES = 16,
    MOST = 2000 /* steps of a history */
};

struct result {
    const char *name[FIGURES], *frame_name[FRAMES];
    double figure[FIGURES], frame[FRAMES][N], at[RC_AXES];
    size_t figures, frames;
};
static struct result whole[POINTS], again[POINTS];
static size_t reached[POINTS]; /* counts at which the points of the whole history are reached */
/* largest relative difference of a kind, and that of its pressure */
static double apart, of_pressure;
static char worst[300];

static void
look(struct rc_model *m, struct result *to)
{
    const struct rc_figure *f;
    const struct rc_frame_kind *kind;
    struct rc_point at;
    struct rc_err err = {""};
    const void *data;

    *to = (struct result){.figures = 0};
    if (rc_model_look(m, &at, &err) != RC_OK)
        fail_msg("%s: %s", rc_model_name(m), err.text);
    memcpy(to->at, at.at, sizeof to->at);
    for (size_t k = 0; (f = rc_model_figure(m, k, &data)) != NULL; k++)
        if (f->role != RC_FIGURE_COST && strstr(f->name, "iterations") == NULL) {
            to->name[to->figures] = f->name;
            to->figure[to->figures++] = rc_figure_number(f, data);
        }
    for (size_t k = 0; (kind = rc_model_frame_kind(m, k)) != NULL; k++)
        if (rc_model_frame(m, kind->name, to->frame[to->frames], &err) == RC_OK)
            to->frame_name[to->frames++] = kind->name;
    assert_true(to->figures <= FIGURES && to->frames <= FRAMES);
}

/* Returns the largest difference over the largest value. */
static double
compare(const char *what, size_t n, const double *a, const double *b)
{
    double most = 0, all = 0;

    for (size_t k = 0; k < n; k++)
        most = fmax(most, fabs(a[k]));
    for (size_t k = 0; k < n; k++) {
        const double d = isnan(a[k]) && isnan(b[k]) ? 0 : a[k] == b[k] ? 0 : fabs(a[k] - b[k]);
        const double off = isnan(d) ? INFINITY : most > 0 && !isinf(most) ? d / most : d;
        all = fmax(all, off);
        if (off > apart) {
            apart = off;
            snprintf(worst, sizeof worst, "%s %zu: %.17g, was %.17g", what, k, b[k], a[k]);
        }
    }
    return all;
}

static void
compare_results(const char *what)
{
    char text[128];

    for (int p = 0; p < POINTS; p++) {
        const struct result *a = &whole[p], *b = &again[p];
        assert_true(a->figures == b->figures && a->frames == b->frames);
        for (size_t k = 0; k < a->figures; k++) {
            snprintf(text, sizeof text, "%s, point %d, %s", what, p, a->name[k]);
            (void)compare(text, 1, &a->figure[k], &b->figure[k]);
        }
        for (size_t k = 0; k < a->frames; k++) {
            double off;
            snprintf(text, sizeof text, "%s, point %d, %s", what, p, a->frame_name[k]);
            off = compare(text, N, a->frame[k], b->frame[k]);
            if (strcmp(a->frame_name[k], "pressure") == 0)
                of_pressure = fmax(of_pressure, off);
        }
        snprintf(text, sizeof text, "%s, point %d, axis", what, p);
        for (size_t k = 0; k < RC_AXES; k++)
            (void)compare(text, 1, &a->at[k], &b->at[k]);
    }
}

/* Gives the state of a model to a fresh one. */
static struct rc_model *
moved_on(const struct kind *kind, struct rc_model *m, bool *going)
{
    const size_t n = rc_model_state_size(m);
    struct rc_model *other = make(kind);
    struct rc_err err = {""};
    double *v = malloc(n * sizeof *v);

    assert_non_null(v);
    rc_model_state(m, v);
    rc_model_free(m);
    if (rc_model_restore(other, v, n, going, &err) != RC_OK)
        fail_msg("%s: %s", kind->name, err.text);
    free(v);
    return other;
}

/* Runs the history; at this count of steps, reached points and kept points, the model is replaced.
 * Returns the count at the end. */
static size_t
history(const struct kind *kind, size_t stop, size_t stop_again, struct result *to)
{
    struct rc_model *m = make(kind);
    struct rc_err err = {""};
    size_t count = 0;

    for (int k = 0; k < POINTS; k++) {
        const struct rc_point at = point_of(kind, k);
        enum rc_status status = rc_model_go(m, &at, &err);
        bool going;
        while (status == RC_MORE) {
            status = rc_model_step(m, &err);
            if (status == RC_FAIL)
                fail_msg("%s: %s", kind->name, err.text);
            count++;
            assert_true(count < MOST);
            if (count == stop || count == stop_again) {
                m = moved_on(kind, m, &going);
                if (going) /* also a reached point may need further steps */
                    status = RC_MORE;
            }
        }
        if (stop == 0)
            reached[k] = count;
        look(m, &to[k]);
        if (rc_model_keep(m, &err) != RC_OK)
            fail_msg("%s: %s", kind->name, err.text);
        if (++count == stop || count == stop_again)
            m = moved_on(kind, m, &going);
    }
    rc_model_free(m);
    return count;
}

/* Some stops of a long history, and each that is at a reached or kept point. */
static bool
takes(size_t stop, size_t last)
{
    static size_t next;
    bool end = false;

    for (int k = 0; k < POINTS; k++)
        end = end || stop == reached[k] || stop == reached[k] + 1;
    if (stop == 1)
        next = 1;
    if (stop < next)
        return end;
    next += getenv("RC_LONG") != NULL || last < 40 ? 1 : 1 + stop % (last / 10);
    return true;
}

static void
same_bits(void **state)
{
    size_t stages = 0, wrong = 0;

    (void)state;
    for (size_t q = 0; q < KINDS; q++) {
        const struct kind *kind = &kinds[q];
        const size_t last = history(kind, 0, 0, whole);
        size_t stops = 0, differ = 0;
        const char *only = getenv("RC_KIND");
        double most = 0;
        char text[sizeof worst] = "";
        of_pressure = 0;
        for (size_t stop = 1; (only == NULL || strcmp(only, kind->name) == 0) && stop <= last;
             stop++) {
            char what[64];
            if (!takes(stop, last))
                continue;
            snprintf(what, sizeof what, "stop %zu", stop);
            apart = 0;
            (void)history(kind, stop, stop % 3 == 0 ? stop + 2 : 0, again);
            compare_results(what);
            stops++;
            differ += apart > 0;
            if (apart > most) {
                most = apart;
                memcpy(text, worst, sizeof text);
            }
        }
        printf("%s: %zu of %zu stops differ; the pressure by at most %.2g%s%s\n", kind->name,
               differ, stops, of_pressure, most > 0 ? "; most differs " : "", text);
        stages += stops;
        wrong += kind->exact ? differ : of_pressure > kind->tol;
    }
    printf("%zu stops in %d models\n", stages, KINDS);
    assert_true(wrong == 0);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(same_bits)};

    return cmocka_run_group_tests(tests, make_heights, NULL);
}
