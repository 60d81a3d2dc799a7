/* The bodies: their elastic constants along the surface. */
#include "slip.h"

#include <math.h>

void
slip_check_bodies(struct slip_run *run)
{
    struct tool *t = &run->t;
    int bodies =
        tool_given(t, "E1") + tool_given(t, "nu1") + tool_given(t, "E2") + tool_given(t, "nu2");
    bool rigid = isinf(run->args->e2);

    if (bodies > 0 && (rigid ? bodies != 3 || tool_given(t, "nu2") : bodies != 4))
        tool_die(t, EXIT_USAGE,
                 "give both bodies, --E1 --nu1 --E2 --nu2, or --E1 --nu1 --E2 rigid");
    if (bodies > 0 && tool_given(t, "nu"))
        tool_die(t, EXIT_USAGE, "--nu is of both bodies, --nu1 and --nu2 are of each: give either");
}

/* (1 - nu)/G, nu/G and (1 - 2 nu)/G, up to a common factor. */
static void
add_body(const struct rc_body *b, double side, double sum[3])
{
    double compliance = b->e == 0 || isinf(b->e) ? 0 : (1 + b->nu) / b->e;

    sum[0] += (1 - b->nu) * compliance;
    sum[1] += b->nu * compliance;
    sum[2] += side * (1 - 2 * b->nu) * compliance;
}

static void
set_constants(struct slip_pair *b)
{
    double sum[3] = {0, 0, 0};

    add_body(&b->pair.one, 1, sum);
    add_body(&b->pair.two, -1, sum);
    b->kap = b->pair.estar > 0 ? b->nu / (1 - b->nu) : sum[1] / sum[0];
    b->beta = b->pair.estar > 0 ? 0 : sum[2] / (2 * sum[0]);
}

/* Whether a key has this value; `none`: the value of an absent key. */
static bool
same(const struct rc_grid *p, const char *key, double value, double none)
{
    double own = none;

    if (!rc_grid_number(p, key, &own))
        own = none;
    return own == value || fabs(own - value) <= 1e-9 * fabs(value);
}

/* Takes the bodies of the command line, which must be those of the pressure. */
static void
take_given(struct slip_run *run)
{
    const struct slip_args *a = run->args;
    struct rc_pair *pair = &run->bodies.pair;
    bool rigid = isinf(a->e2);
    double estar, of_these;

    pair->one = (struct rc_body){.e = a->e1, .nu = a->nu1};
    if (!rigid)
        pair->two = (struct rc_body){.e = a->e2, .nu = a->nu2};
    of_these = 1 / ((1 - a->nu1 * a->nu1) / a->e1 + (rigid ? 0 : (1 - a->nu2 * a->nu2) / a->e2));
    if (rc_grid_number(run->p, "estar", &estar) && !(fabs(of_these / estar - 1) < 1e-9))
        tool_die_at(&run->t, run->p, EXIT_IMPOSSIBLE,
                    "its E* is %.9g Pa, that of --E1 --nu1 --E2 --nu2 is %.9g Pa: solve it for "
                    "these bodies first",
                    estar, of_these);
    if (rc_grid_get(run->p, "e1") != NULL &&
        !(same(run->p, "e1", a->e1, NAN) && same(run->p, "nu", a->nu1, NAN) &&
          same(run->p, "e2", rigid ? 0 : a->e2, 0) && same(run->p, "nu2", rigid ? 0 : a->nu2, 0)))
        tool_die_at(&run->t, run->p, EXIT_IMPOSSIBLE,
                    "its bodies are others than those of --E1 --nu1 --E2 --nu2: leave these out, "
                    "or solve it for these bodies first");
}

/* Takes the bodies of the stream: both, or only E* with a Poisson's ratio of both. */
static void
take_own(struct slip_run *run)
{
    struct slip_pair *b = &run->bodies;
    struct rc_pair *pair = &b->pair;

    if (rc_grid_number(run->p, "e1", &pair->one.e) && rc_grid_number(run->p, "nu", &pair->one.nu)) {
        if (!isnan(run->args->nu))
            tool_die_at(&run->t, run->p, EXIT_IMPOSSIBLE,
                        "its bodies have Poisson's ratios of their own: leave out --nu");
        if (rc_grid_get(run->p, "e2") != NULL && (!rc_grid_number(run->p, "e2", &pair->two.e) ||
                                                  !rc_grid_number(run->p, "nu2", &pair->two.nu)))
            tool_die_at(&run->t, run->p, EXIT_IMPOSSIBLE,
                        "its keys e2 and nu2 are no material: solve it again");
        return;
    }
    pair->one = (struct rc_body){0};
    if (!rc_grid_number(run->p, "estar", &pair->estar))
        tool_die_at(&run->t, run->p, EXIT_USAGE,
                    "E* is not in the stream: give both bodies, --E1 --nu1 --E2 --nu2");
    b->nu = run->args->nu;
    if (isnan(b->nu) && !rc_grid_number(run->p, "nu", &b->nu))
        tool_die_at(&run->t, run->p, EXIT_USAGE,
                    "Poisson's ratio is not in the stream: give it with --nu for bodies that are "
                    "alike, or both bodies, --E1 --nu1 --E2 --nu2");
}

void
slip_find_bodies(struct slip_run *run)
{
    run->bodies = (struct slip_pair){.nu = 0};
    if (rc_grid_get(run->p, "layers") != NULL)
        tool_die_at(&run->t, run->p, EXIT_IMPOSSIBLE,
                    "its body is coated, and how layers shear is not known here: solve it for bare "
                    "bodies");
    if (tool_given(&run->t, "E1"))
        take_given(run);
    else
        take_own(run);
    set_constants(&run->bodies);
}
