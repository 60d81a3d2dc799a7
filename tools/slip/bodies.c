/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elastic constants of the bodies for tangential displacements. */
#include "slip.h"

#include <math.h>

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

/* True if the key has this value. An absent key has the value `none`. */
static bool
same(const struct rc_grid *p, const char *key, double value, double none)
{
    double own = none;

    if (!rc_grid_number(p, key, &own))
        own = none;
    return own == value || fabs(own - value) <= 1e-9 * fabs(value);
}

/* Takes the bodies of the command line, which must agree with the keys of the pressure. */
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
        tool_refuse(&run->d.t, run->p,
                    "its E* is %.9g Pa, but --E1 --nu1 --E2 --nu2 give %.9g Pa: solve the contact "
                    "for these bodies first",
                    estar, of_these);
    if (rc_grid_get(run->p, "e1") != NULL &&
        !(same(run->p, "e1", a->e1, NAN) && same(run->p, "nu", a->nu1, NAN) &&
          same(run->p, "e2", rigid ? 0 : a->e2, 0) && same(run->p, "nu2", rigid ? 0 : a->nu2, 0)))
        tool_refuse(&run->d.t, run->p,
                    "its bodies differ from --E1 --nu1 --E2 --nu2: leave these options out, or "
                    "solve the contact for these bodies first");
}

/* Takes the bodies from the stream: both, or E* and one Poisson's ratio for both. */
static void
take_own(struct slip_run *run)
{
    struct slip_pair *b = &run->bodies;
    struct rc_pair *pair = &b->pair;

    if (rc_grid_number(run->p, "e1", &pair->one.e) && rc_grid_number(run->p, "nu", &pair->one.nu)) {
        if (!isnan(run->args->nu))
            tool_refuse(&run->d.t, run->p,
                        "the stream already gives Poisson's ratios: leave out --nu");
        if (rc_grid_get(run->p, "e2") != NULL && (!rc_grid_number(run->p, "e2", &pair->two.e) ||
                                                  !rc_grid_number(run->p, "nu2", &pair->two.nu)))
            tool_refuse(&run->d.t, run->p,
                        "its keys e2 and nu2 are not both numbers: solve the contact again");
        return;
    }
    pair->one = (struct rc_body){0};
    if (!rc_grid_number(run->p, "estar", &pair->estar))
        tool_die_at(&run->d.t, run->p, EXIT_USAGE,
                    "E* is not in the stream: give both bodies, --E1 --nu1 --E2 --nu2");
    b->nu = run->args->nu;
    if (isnan(b->nu) && !rc_grid_number(run->p, "nu", &b->nu))
        tool_die_at(&run->d.t, run->p, EXIT_USAGE,
                    "Poisson's ratio is not in the stream: give --nu for bodies of the same "
                    "material, else both bodies, --E1 --nu1 --E2 --nu2");
}

void
slip_find_bodies(struct slip_run *run)
{
    run->bodies = (struct slip_pair){.nu = 0};
    bodies_demand_elastic(&run->d.t, run->p, "friction of viscoelastic bodies is not implemented");
    if (rc_grid_get(run->p, "layers") != NULL)
        tool_refuse(&run->d.t, run->p,
                    "its body 1 has layers, and rc-slip supports only bodies without layers: solve "
                    "the contact without --layer");
    if (tool_given(&run->d.t, "E1"))
        take_given(run);
    else
        take_own(run);
    set_constants(&run->bodies);
}
