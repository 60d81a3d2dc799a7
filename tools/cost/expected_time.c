/*
 * How long a trial will take: what libcontact expects of its method and engine, corrected by what
 * the trials that have been run on this map took instead. A machine may be several times off, and a
 * surface may need fewer convolutions or more.
 */
#include "cost.h"

#include <math.h>
#include <string.h>

/* Convolutions of a body that yields inside: two applications an increment and some at the end, each 14 of
 * them a slab, and 8 for the contact. */
static double
work_of(const struct cost_settings *s)
{
    const double slabs = 14, convolutions = 14, contact = 8, last = 6;

    return (2 * (double)s->increments + last) * (convolutions * slabs * s->stack + contact);
}

/* Of the library, for the trial's own grid. */
static struct rc_expected
expected(const struct cost_case *c, const struct cost_trial *t)
{
    struct rc_problem problem = c->problem;
    struct rc_expected e;

    problem.method = t->settings.method;
    problem.engine = t->settings.kernel;
    problem.tol = t->settings.tol;
    problem.threads = c->tool->threads;
    if (t->settings.coarse > 1)
        problem.hardness_map = NULL; /* it is of another grid */
    if (c->adhesion != NULL) {
        struct rc_adhesion_problem attracting = *c->adhesion;
        attracting.contact = problem;
        if (rc_adhesion_expect(&t->shape, &attracting, &e, NULL) != RC_OK)
            e = (struct rc_expected){NAN, NAN, 0};
        return e;
    }
    if (rc_solver_expect(&t->shape, &problem, &e, NULL) != RC_OK)
        e = (struct rc_expected){NAN, NAN, 0};
    if (t->settings.increments > 0) { /* that many times the elastic solution */
        double more = work_of(&t->settings) / e.convolutions;
        e.convolutions *= more;
        e.seconds *= more;
    }
    return e;
}

/* The trial with the nearest tolerance that was run on the map's own grid, with the same method, or
 * engine, or both, where there is one. */
static const struct cost_trial *
nearest(const struct cost_case *c, const struct cost_settings *s, bool same_method,
        bool same_engine)
{
    const struct cost_trial *near = NULL;

    for (size_t k = 0; k < c->trials; k++) {
        const struct cost_trial *m = &c->trial[k];

        if (m->state == COST_DONE && m->settings.coarse == 1 &&
            (!same_method || strcmp(m->settings.method, s->method) == 0) &&
            (!same_engine || strcmp(m->settings.kernel, s->kernel) == 0) &&
            (near == NULL ||
             fabs(log(m->settings.tol / s->tol)) <= fabs(log(near->settings.tol / s->tol))))
            near = m;
    }
    return near;
}

static const struct cost_trial *
reference_of(const struct cost_case *c)
{
    return c->reference.state == COST_DONE ? &c->reference : NULL;
}

/* Convolutions that a method took over the expected number. */
static double
more_convolutions(const struct cost_case *c, const struct cost_settings *s)
{
    const struct cost_trial *near = nearest(c, s, true, false);

    if (near == NULL && strcmp(s->method, c->reference.settings.method) == 0)
        near = reference_of(c);
    return near == NULL || isnan(near->convolutions)
               ? 1
               : near->convolutions / expected(c, near).convolutions;
}

/* Seconds of a convolution by an engine over the expected ones; by trials of the same method if
 * possible, because the seconds include the work beside the convolutions. */
static double
slower(const struct cost_case *c, const struct cost_settings *s)
{
    const struct cost_trial *near = nearest(c, s, true, true);
    struct rc_expected e;

    if (near == NULL)
        near = nearest(c, s, false, true);
    if (near == NULL)
        near = reference_of(c);
    if (near == NULL)
        return 1;
    e = expected(c, near);
    if (isnan(near->convolutions)) /* nobody has counted them */
        return near->seconds / e.seconds;
    return near->seconds / near->convolutions / (e.seconds / e.convolutions);
}

double
cost_expect(const struct cost_case *c, const struct cost_trial *t)
{
    return expected(c, t).seconds * more_convolutions(c, &t->settings) * slower(c, &t->settings);
}

/* ---- stresses ---- */

/* One sum of displacements by the engine of a trial, on this machine. */
static double
one_sum(const struct cost_case *c, const struct cost_stress *s)
{
    struct rc_conv_options options = {.boundary = c->problem.boundary,
                                      .engine = s->kernel,
                                      .tol = s->tol,
                                      .threads = c->tool->threads};
    struct cost_settings settings = {
        .method = "", .kernel = s->kernel, .tol = s->tol > 0 ? s->tol : 1e-14};

    return rc_conv_seconds(&c->shape, &options) * slower(c, &settings);
}

/* Sums that a depth takes, in times of one of displacements: by the transforms of the first
 * engine, whose plan all components share, and by other engines, component by component. Beside
 * each slice the exact one is computed, to compare. */
double
cost_expect_stress(const struct cost_case *c, const struct cost_stress *s)
{
    const double sums_exact = 3, sums_other = 7;
    double depths = (double)c->depths.n, exact = sums_exact * one_sum(c, &c->stress[0]) * depths;

    for (size_t k = 0; k < c->stresses; k++)
        if (c->stress[k].state == COST_DONE && c->stress[k].reference)
            exact = c->stress[k].seconds;
    if (strcmp(s->kernel, c->stress[0].kernel) == 0)
        return 2 * exact;
    for (size_t k = 0; k < c->stresses; k++) {
        const struct cost_stress *m = &c->stress[k];

        if (m->state == COST_DONE && strcmp(m->kernel, s->kernel) == 0)
            return exact + m->seconds * one_sum(c, s) / one_sum(c, m);
    }
    return exact + sums_other * one_sum(c, s) * depths;
}
