/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws of every model. A run may be stopped after any step and continued from its state in another
 * model. The result is the same as that of a run without a stop. Points that were not kept have no
 * effect. Other data are refused as a state, a false number in a state does no harm, and figures and
 * frames have names. The test runs for every row of models.list, and also with the model of tests/toys. */
#include "kinds.h"

enum {
    FIGURES = 64,
    FEW = 1000 /* largest number of steps of a history */
};

/* ---- a run, as in a tool ---- */

/* Figures of the accuracy. */
static const char others[] = " kkt_residual pull_off_spread ";

static double near_tol = 1e-6;

static bool
near(double a, double b, double scale)
{
    return fabs(a - b) <= near_tol * scale || (isnan(a) && isnan(b));
}

/* A stability is an eigenvalue to 20 %, at most. A stiff state, whose softest modes are all alike, may show
 * another of them. */
static bool
same_stability(double a, double b)
{
    const double stiff = 0.5, bound = 0.2, least = fmin(a, b), most = fmax(a, b);

    return (isnan(a) && isnan(b)) || least > stiff ||
           (least > 0 && least >= (1 - 2 * bound) * most);
}

struct found {
    size_t figures;
    const struct rc_figure *of[FIGURES];
    double figure[FIGURES], load, approach, pressure[N];
};

static void
look(struct rc_model *m, struct found *found)
{
    const struct rc_figure *f;
    const void *data;
    struct rc_point at;
    struct rc_err err = {""};

    if (rc_model_look(m, &at, &err) != RC_OK ||
        rc_model_frame(m, "pressure", found->pressure, &err) != RC_OK)
        fail_msg("%s: %s", rc_model_name(m), err.text);
    found->load = at.at[RC_LOAD];
    found->approach = at.at[RC_APPROACH];
    found->figures = 0;
    for (size_t k = 0; (f = rc_model_figure(m, k, &data)) != NULL; k++)
        if (f->role != RC_FIGURE_COST && f->role != RC_FIGURE_ERROR &&
            strstr(others, f->name) == NULL) {
            assert_true(found->figures < FIGURES);
            found->of[found->figures] = f;
            found->figure[found->figures++] = rc_figure_number(f, data);
        }
}

/* Counts the steps of a run before it stops, and checks the progress of every step. */
static enum rc_status
steps(struct rc_model *m, size_t *left, struct rc_err *err)
{
    enum rc_status s = RC_MORE;
    struct rc_loops loops;

    while (s == RC_MORE && *left > 0) {
        s = rc_model_step(m, err);
        --*left;
        rc_model_progress(m, &loops);
        assert_true(loops.n > 0 && loops.n < RC_LOOPS);
        for (size_t k = 0; k < loops.n; k++)
            assert_true(!(loops.loop[k].at > loops.loop[k].of));
    }
    if (s == RC_FAIL)
        fail_msg("%s: %s", rc_model_name(m), err->text);
    return s;
}

/* Goes through the points from k on; `going`: point k is set already. When `left` is 0 the run stops, and k
 * is the unfinished point. */
static enum rc_status
run(const struct kind *kind, struct rc_model *m, int *k, bool going, size_t *left,
    struct found found[POINTS])
{
    struct rc_err err = {""};

    for (; *k < POINTS; ++*k) {
        const struct rc_point to = point_of(kind, *k);
        if (!going && rc_model_go(m, &to, &err) != RC_MORE)
            fail_msg("%s, point %d: %s", kind->name, *k, err.text);
        going = false;
        if (steps(m, left, &err) == RC_MORE)
            return RC_MORE;
        look(m, &found[*k]);
        assert_int_equal(rc_model_keep(m, &err), RC_OK);
        /* found axes too are those of the kept point */
        assert_true(near(m->from.at[RC_LOAD], found[*k].load, 1e-3));
        assert_true(isnan(found[*k].approach) ||
                    near(m->from.at[RC_APPROACH], found[*k].approach, 1e-7));
    }
    return RC_OK;
}

/* `stopped`: the run of b was stopped on the way to this point, and counts the jumps from there. */
static void
same(const char *what, const struct found *a, const struct found *b, bool stopped)
{
    double most = 0;

    for (size_t k = 0; k < N; k++)
        most = fmax(most, fabs(a->pressure[k]));
    assert_int_equal(a->figures, b->figures);
    for (size_t k = 0; k < a->figures; k++) {
        const char *name = a->of[k]->name, *unit = a->of[k]->unit;
        const bool pressure = unit != NULL && strcmp(unit, "Pa") == 0;
        const bool alike =
            strcmp(name, "stability") == 0
                ? same_stability(a->figure[k], b->figure[k])
                : near(a->figure[k], b->figure[k], pressure ? most : fabs(a->figure[k]));
        if (!alike && !(stopped && strcmp(name, "jumps") == 0))
            fail_msg("%s: %s is %.10g, was %.10g", what, name, b->figure[k], a->figure[k]);
    }
    assert_true(near(a->load, b->load, fabs(a->load)));
    assert_true(near(a->approach, b->approach, fabs(a->approach)));
    for (size_t k = 0; k < N; k++)
        if (!near(a->pressure[k], b->pressure[k], 10 * most))
            fail_msg("%s: pressure %zu is %.10g, was %.10g", what, k, b->pressure[k],
                     a->pressure[k]);
}

/* ---- the laws ---- */

static struct found whole[POINTS], again[POINTS];

/* Stops after `stop` steps and continues in another model; false if the run ends before. */
static bool
resumed(const struct kind *kind, size_t stop)
{
    size_t left = stop, rest = FEW, n;
    struct rc_model *m = make(kind);
    struct rc_err err = {""};
    double *v;
    bool going;
    int k = 0, stopped;
    char what[64];

    if (run(kind, m, &k, false, &left, again) == RC_OK) {
        rc_model_free(m);
        return false;
    }
    stopped = k;
    n = rc_model_state_size(m);
    v = malloc(n * sizeof *v);
    assert_non_null(v);
    rc_model_state(m, v);
    rc_model_free(m);
    m = make(kind);
    if (rc_model_restore(m, v, n, &going, &err) != RC_OK)
        fail_msg("%s, %zu steps: %s", kind->name, stop, err.text);
    free(v);
    assert_true(going);
    assert_int_equal(run(kind, m, &k, true, &rest, again), RC_OK);
    rc_model_free(m);
    for (k = 0; k < POINTS; k++) {
        snprintf(what, sizeof what, "%s, %zu steps, point %d", kind->name, stop, k);
        same(what, &whole[k], &again[k], k == stopped);
    }
    return true;
}

static void
run_whole(const struct kind *kind)
{
    struct rc_model *m = make(kind);
    size_t left = FEW;
    int k = 0;

    near_tol = kind->tol;
    assert_int_equal(run(kind, m, &k, false, &left, whole), RC_OK);
    rc_model_free(m);
}

static void
stops(void **state)
{
    (void)state;
    for (size_t q = 0; q < KINDS; q++) {
        size_t count = 0;
        run_whole(&kinds[q]);
        for (size_t stop = 1; resumed(&kinds[q], stop);
             stop += 1 + stop / (stop < 8 || getenv("RC_LONG") != NULL ? 4 : 1))
            count++;
        printf("%s: %zu stops\n", kinds[q].name, count);
        assert_true(count > 4);
    }
}

/* A model reaches a point and does not keep it. Its state is given to another model, which finds the point
 * again and can keep it. */
static void
reached(void **state)
{
    (void)state;
    for (size_t q = 0; q < KINDS; q++) {
        const struct kind *kind = &kinds[q];
        const struct rc_point first = point_of(kind, 0);
        struct rc_model *m = make(kind), *other = make(kind);
        size_t left = FEW, n;
        struct rc_err err = {""};
        struct found one;
        double *v;
        bool going;
        run_whole(kind);
        assert_int_equal(rc_model_run(m, &first, &err), RC_OK);
        n = rc_model_state_size(m);
        v = malloc(n * sizeof *v);
        assert_non_null(v);
        rc_model_state(m, v);
        rc_model_free(m);
        if (rc_model_restore(other, v, n, &going, &err) != RC_OK)
            fail_msg("%s: %s", kind->name, err.text);
        free(v);
        assert_int_equal(steps(other, &left, &err), RC_OK);
        look(other, &one);
        same(kind->name, &whole[0], &one, false);
        if (rc_model_keep(other, &err) != RC_OK)
            fail_msg("%s: %s", kind->name, err.text);
        rc_model_free(other);
    }
}

/* Half-way to the last point the model is sent to the second point. The result is that of going there
 * directly, in the same model and in another one that was restored from the state half-way. */
static void
forgets(void **state)
{
    (void)state;
    for (size_t q = 0; q < KINDS; q++) {
        const struct kind *kind = &kinds[q];
        const struct rc_point first = point_of(kind, 0), second = point_of(kind, 1),
                              far = point_of(kind, 2);
        struct rc_model *m = make(kind), *other = make(kind);
        struct rc_err err = {""};
        struct found one;
        size_t few = 3, n;
        double *v;
        bool going;
        run_whole(kind);
        assert_int_equal(rc_model_run(m, &first, &err), RC_OK);
        assert_int_equal(rc_model_keep(m, &err), RC_OK);
        assert_int_equal(rc_model_go(m, &far, &err), RC_MORE);
        assert_int_equal(rc_model_keep(m, &err), RC_FAIL); /* on the way */
        (void)steps(m, &few, &err);
        n = rc_model_state_size(m);
        v = malloc(n * sizeof *v);
        assert_non_null(v);
        rc_model_state(m, v);
        assert_int_equal(rc_model_run(m, &second, &err), RC_OK);
        look(m, &one);
        same(kind->name, &whole[1], &one, false);
        rc_model_free(m);
        if (rc_model_restore(other, v, n, &going, &err) != RC_OK)
            fail_msg("%s: %s", kind->name, err.text);
        free(v);
        assert_int_equal(rc_model_run(other, &second, &err), RC_OK);
        look(other, &one);
        same(kind->name, &whole[1], &one, false);
        rc_model_free(other);
    }
}

/* ---- refusals ---- */

/* Restores a state that may be false: it is refused, or steps, figures and frames follow. */
static bool
taken(const struct kind *kind, const double *v, size_t n)
{
    static double frame[N];
    struct rc_model *m = make(kind);
    struct rc_err err = {""};
    const struct rc_frame_kind *f;
    struct rc_point at;
    bool going;
    const bool fine = rc_model_restore(m, v, n, &going, &err) == RC_OK;

    if (!fine)
        assert_string_not_equal(err.text, "");
    for (int k = 0; k < 3 && fine && going; k++)
        going = rc_model_step(m, &err) == RC_MORE;
    if (fine && rc_model_look(m, &at, &err) == RC_OK)
        for (size_t k = 0; (f = rc_model_frame_kind(m, k)) != NULL; k++)
            (void)rc_model_frame(m, f->name, frame, &err);
    rc_model_free(m);
    return fine;
}

/* A state of a file may hold any numbers: each of the first ones, and some of the others, is replaced. */
static void
false_states(void **state)
{
    static const double lies[] = {0,    1,    -1,      0.5,   2,      3,        7,
                                  1000, 1e15, 4503e12, 1e300, -1e300, INFINITY, 1e-300};
    enum {
        LIES = sizeof lies / sizeof *lies,
        STOPS = 4
    };

    const bool all = getenv("RC_LONG") != NULL;

    (void)state;
    for (size_t q = 0; q < sizeof kinds / sizeof *kinds; q++) {
        const struct kind *kind = &kinds[q];
        size_t tried = 0, fine = 0, lie = q;
        for (size_t stop = 1; stop <= STOPS; stop += all ? 1 : 2) {
            struct rc_model *m = make(kind);
            const struct rc_point first = point_of(kind, 0), second = point_of(kind, 1);
            size_t few = 3 * stop, n;
            struct rc_err err = {""};
            double *v;
            if (stop > STOPS / 2) {
                assert_int_equal(rc_model_run(m, &first, &err), RC_OK);
                assert_int_equal(rc_model_keep(m, &err), RC_OK);
            }
            assert_int_equal(rc_model_go(m, stop > STOPS / 2 ? &second : &first, &err), RC_MORE);
            (void)steps(m, &few, &err);
            n = rc_model_state_size(m);
            v = calloc(n + 1, sizeof *v);
            assert_non_null(v);
            rc_model_state(m, v);
            rc_model_free(m);
            for (size_t k = 0; k < n; k += k < 60 || (all && k < 240) ? 1 : n / 20 + 1)
                for (int times = 0; times < (all ? 6 : 2); times++, tried++) {
                    const double was = v[k];
                    v[k] = times == 0 ? was + 1 : lies[lie++ % LIES];
                    fine += taken(kind, v, n);
                    v[k] = was;
                }
            for (size_t most = v[0] > 0 ? 6 : 0; most-- > 0; tried++) { /* of maps and numbers */
                const double was[2] = {v[0], v[1]};
                v[0] = (double[]){0, 1, 2, was[0] - 1, (double)n, (double)n - 1}[most];
                v[1] = (double[]){0, was[1], 1, was[1] + 1, was[1], 1e9}[most];
                fine += taken(kind, v, n);
                v[0] = was[0], v[1] = was[1];
            }
            free(v);
        }
        printf("%s: %zu false states, %zu taken\n", kind->name, tried, fine);
        assert_true(tried > 200 && fine < tried);
    }
}

static void
refused(const struct kind *kind, const double *v, size_t n, const char *why)
{
    struct rc_model *m = make(kind);
    struct rc_err err = {""};
    bool going;

    assert_int_equal(rc_model_restore(m, v, n, &going, &err), RC_FAIL);
    if (strstr(err.text, why) == NULL)
        fail_msg("%s: \"%s\", not \"%s\"", kind->name, err.text, why);
    rc_model_free(m);
}

static void
states_of_others(void **state)
{
    (void)state;
    for (size_t q = 0; q < KINDS; q++) {
        const struct kind *kind = &kinds[q];
        struct rc_model *m = make(kind);
        struct rc_err err = {""};
        const struct rc_point first = point_of(kind, 0);
        size_t few = 5, n;
        double *v;
        assert_int_equal(rc_model_go(m, &first, &err), RC_MORE);
        assert_int_equal(steps(m, &few, &err), RC_MORE);
        n = rc_model_state_size(m);
        v = calloc(n + 1, sizeof *v);
        assert_non_null(v);
        rc_model_state(m, v);
        rc_model_free(m);
        for (size_t cut = 0; cut < n; cut += 1 + cut / 3)
            refused(kind, v, cut, "numbers are missing");
        refused(kind, v, n + 1, "more numbers");
        v[2] += 1;
        refused(kind, v, n, "another model");
        v[2] -= 1, v[3] += 1;
        refused(kind, v, n, "another map");
        v[3] -= 1, v[5] = 7;
        refused(kind, v, n, "out of range");
        v[5] = NAN;
        refused(kind, v, n, "NaN");
        free(v);
    }
}

static void
points(void **state)
{
    struct rc_model *m = make(&kinds[0]);
    struct rc_point p = {0};
    struct rc_expected expected;
    struct rc_err err = {""};
    double map[N];

    (void)state;
    assert_int_equal(rc_model_go(m, &p, &err), RC_FAIL);
    assert_string_equal(err.text, "a point of the elastic model needs the load");
    rc_point_set(&p, RC_LOAD, -1);
    assert_int_equal(rc_model_go(m, &p, &err), RC_FAIL);
    assert_int_equal(rc_model_step(m, &err), RC_FAIL);
    rc_point_set(&p, RC_LOAD, NAN);
    assert_int_equal(rc_model_go(m, &p, &err), RC_FAIL);
    rc_point_set(&p, RC_APPROACH, 1e-8); /* and the load is not among them */
    assert_true(p.given == 1u << RC_APPROACH);
    assert_int_equal(rc_model_plan(m, &p, &expected, &err), RC_OK);
    assert_true(expected.memory > N && expected.convolutions > 12);
    rc_point_set(&p, RC_TIME, 1);
    assert_int_equal(rc_model_go(m, &p, &err), RC_FAIL);
    assert_string_equal(err.text, "a point gives the time, which the elastic model does not have");
    assert_int_equal(rc_model_frame(m, "nothing", map, &err), RC_FAIL);
    assert_int_equal(rc_model_frame(m, "pressure", map, &err), RC_FAIL); /* before the first look */
    assert_true(isnan(rc_model_number(m, "nothing")));
    rc_model_free(m);
    for (size_t k = 0; k < RC_AXES; k++)
        assert_true(rc_axis_info(rc_axis_info(k)->partner)->partner == k);
    assert_null(rc_axis_info(RC_AXES));
}

/* A plan tells a cost; that of an outer model is at least the cost of its inner model. */
static void
plans(void **state)
{
    (void)state;
    for (size_t q = 0; q < KINDS; q++) {
        struct rc_model *m = make(&kinds[q]);
        const struct rc_point first = point_of(&kinds[q], 0);
        const struct rc_point of_inner = rc_point_for(m->inner, &first);
        struct rc_expected e, inner = {0, 0, 0};
        struct rc_err err = {""};
        if (rc_model_plan(m, &first, &e, &err) != RC_OK ||
            (m->inner != NULL && rc_model_plan(m->inner, &of_inner, &inner, &err) != RC_OK))
            fail_msg("%s: %s", kinds[q].name, err.text);
        assert_true(e.convolutions >= inner.convolutions && e.convolutions > 1);
        assert_true(e.seconds >= inner.seconds && e.seconds > 0);
        assert_true(e.memory >= inner.memory && e.memory > N);
        rc_model_free(m);
    }
}

static void
all_rows(void **state)
{
    static const char *const names[] = {
#define RC_MODEL(name) #name,
#include RC_MODELS_LIST
#undef RC_MODEL
    };

    (void)state;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        size_t q = 0, frames = 0;
        struct rc_model *m;
        const struct rc_frame_kind *f;
        while (q < KINDS && strcmp(kinds[q].name, names[k]) != 0)
            q++;
        if (q == KINDS)
            fail_msg("models.list has '%s', which is tried nowhere", names[k]);
        m = make(&kinds[q]);
        assert_string_equal(rc_model_name(m), names[k]);
        assert_true(rc_model_shape(m).nx == NX);
        for (; (f = rc_model_frame_kind(m, frames)) != NULL; frames++)
            assert_true(f->unit != NULL && f->title != NULL);
        assert_true(frames >= 1);
        rc_model_free(m);
    }
}

/* The sentence about a frame that a model does not have lists the frames that it has. */
static void
frames_listed(void **state)
{
    static double to[N];

    (void)state;
    for (size_t q = 0; q < KINDS; q++) {
        struct rc_model *m = make(&kinds[q]);
        const struct rc_frame_kind *f;
        struct rc_err err = {""};
        assert_int_equal(rc_model_frame(m, "worn", to, &err), RC_FAIL);
        assert_non_null(strstr(err.text, "has no frame 'worn': take one of "));
        for (size_t k = 0; (f = rc_model_frame_kind(m, k)) != NULL; k++)
            assert_non_null(strstr(strchr(err.text, ':'), f->name));
        rc_model_free(m);
    }
}

/* The heights are the caller's again after the first go. The maps of travel are members of its options. */
static void
heights_of_caller(void **state)
{
    static double own[N];
    static struct found kept, reused;

    (void)state;
    memcpy(own, heights, sizeof own);
    for (size_t q = 0; q < KINDS; q++) {
        for (int late = 0; late < 2 && strcmp(kinds[q].name, "travel") != 0; late++) {
            struct rc_model *m = make(&kinds[q]);
            const struct rc_point first = point_of(&kinds[q], 0), next = point_of(&kinds[q], 1);
            struct rc_err err = {""};
            enum rc_status status = rc_model_go(m, &first, &err);
            for (size_t k = 0; k < N && late; k++)
                heights[k] = NAN;
            while (status == RC_MORE)
                status = rc_model_step(m, &err);
            if (status == RC_FAIL || rc_model_keep(m, &err) != RC_OK ||
                rc_model_run(m, &next, &err) == RC_FAIL)
                fail_msg("%s: %s", kinds[q].name, err.text);
            look(m, late ? &reused : &kept);
            rc_model_free(m);
            memcpy(heights, own, sizeof own);
        }
        assert_memory_equal(kept.pressure, reused.pressure, sizeof kept.pressure);
        assert_true(kept.figures == reused.figures && kept.load == reused.load);
        for (size_t k = 0; k < kept.figures; k++)
            if (!near(kept.figure[k], reused.figure[k], fabs(kept.figure[k])))
                fail_msg("%s: %s", kinds[q].name, kept.of[k]->name);
    }
}

#ifdef RC_TOYS
/* Flat bodies in full contact: p = F/A, and the springs settle by s = c p (1 - exp(-t/tau)), exactly for any
 * steps. After complete relaxation every node has settled by c times its own pressure, for any surface. */
static void
relaxation(void **state)
{
    static const double flat[N];
    const double c = 1e-15;
    const struct toy_relaxing law = {.compliance = c, .tau = 2, .tol = 1e-3};
    const double p = 1e-3 / (N * shape.dx * shape.dy);
    struct rc_problem o = {.boundary = RC_PERIODIC, .pair.estar = 1e9, .tol = 1e-9, .threads = 1};
    struct rc_err err = {""};
    double s[N], q[N], sum = 0, off = 0;
    struct rc_point to = {0};
    struct rc_model *m =
        toy_relaxing_new(rc_elastic_new(&shape, flat, &o, NULL, &err), flat, &law, &err);

    (void)state;
    assert_non_null(m);
    rc_point_set(&to, RC_LOAD, 1e-3);
    rc_point_set(&to, RC_TIME, 3);
    assert_int_equal(rc_model_run(m, &to, &err), RC_OK);
    assert_int_equal(rc_model_look(m, NULL, &err), RC_OK);
    assert_true(near(rc_model_number(m, "mean_settlement"), c * p * (1 - exp(-1.5)), c * p));
    rc_model_free(m);

    m = toy_relaxing_new(rc_elastic_new(&shape, heights, &o, NULL, &err), heights, &law, &err);
    assert_non_null(m);
    rc_point_set(&to, RC_TIME, 60);
    assert_int_equal(rc_model_run(m, &to, &err), RC_OK);
    assert_true(rc_model_look(m, NULL, &err) == RC_OK &&
                rc_model_frame(m, "settlement", s, &err) == RC_OK &&
                rc_model_frame(m, "pressure", q, &err) == RC_OK);
    for (size_t k = 0; k < N; k++) {
        sum += s[k];
        off += fabs(s[k] - c * q[k]);
    }
    assert_true(off < 3e-3 * sum); /* the last step is within 1e-3 */
    printf("%g steps, %g rejected\n", rc_model_number(m, "steps"), rc_model_number(m, "rejected"));
    assert_true(rc_model_number(m, "steps") < 200 && rc_model_number(m, "time") == 60);
    rc_model_free(m);
}
#endif

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_rows),
        cmocka_unit_test(frames_listed),
        cmocka_unit_test(heights_of_caller),
        cmocka_unit_test(points),
        cmocka_unit_test(stops),
        cmocka_unit_test(reached),
        cmocka_unit_test(forgets),
        cmocka_unit_test(states_of_others),
        cmocka_unit_test(plans),
        cmocka_unit_test(false_states),
#ifdef RC_TOYS
        cmocka_unit_test(relaxation),
#endif
    };

    return cmocka_run_group_tests(tests, make_heights, NULL);
}
