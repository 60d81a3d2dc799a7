/*
 * The front: trials that no other beats in time and error at once. And trials whose estimate of
 * their error was too small.
 */
#include "cost.h"

#include <math.h>

struct point {
    double seconds, error; /* NAN: there is no result */
};

static bool
beaten(struct point a, struct point by)
{
    return by.seconds <= a.seconds && by.error <= a.error &&
           (by.seconds < a.seconds || by.error < a.error);
}

/* Errors below that of the reference count as equal. */
static struct point
point_of(const struct cost_case *c, const struct cost_trial *t)
{
    if (t->state != COST_DONE)
        return (struct point){NAN, NAN};
    return (struct point){t->seconds, fmax(t->error, c->reference.contact.pressure_error)};
}

/* The error of the reference is not known: it is taken as rounding. */
static struct point
point_of_stress(const struct cost_stress *s)
{
    if (s->state != COST_DONE)
        return (struct point){NAN, NAN};
    return (struct point){s->seconds, s->reference ? 0 : s->error};
}

void
cost_mark(struct cost_case *c)
{
    for (size_t k = 0; k < c->trials; k++) {
        struct cost_trial *t = &c->trial[k];

        t->front = t->state == COST_DONE;
        for (size_t l = 0; l < c->trials; l++)
            t->front = t->front && !beaten(point_of(c, t), point_of(c, &c->trial[l]));
        t->optimistic =
            t->state == COST_DONE && t->settings.coarse == 1 &&
            t->settings.stack == c->reference.settings.stack &&
            t->error > 1.01 * t->contact.pressure_error + c->reference.contact.pressure_error;
    }
    for (size_t k = 0; k < c->stresses; k++) {
        struct cost_stress *s = &c->stress[k];

        s->front = s->state == COST_DONE;
        for (size_t l = 0; l < c->stresses; l++)
            s->front = s->front && !beaten(point_of_stress(s), point_of_stress(&c->stress[l]));
    }
}
