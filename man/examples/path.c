/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A ball sticks and slips while a tangential force rises, falls and reverses (Mindlin). */
#include <libcontact/contact.h>
#include <math.h>
#include <stdio.h>

enum {
    N = 64
};
static double h[N * N];

int
main(void)
{
    static const double pull[] = {0, 0.3, 0.6, 0.9, 0, -0.9};
    const double e = 210e9, nu = 0.3, radius = 10e-3, load = 10, mu = 0.3;
    const double estar = e / 2 / (1 - nu * nu), g = e / 2 / (1 + nu);
    const double a = cbrt(0.75 * load * radius / estar);
    const double slides = 3 * mu * load * (2 - nu) / (8 * g * a);
    struct rc_shape shape = {N, N, 3 * a / N, 3 * a / N};
    struct rc_problem contact = {
        .pair = {.one = {e, nu}, .two = {e, nu}}};
    struct rc_friction_problem friction = {
        .law = {.pair = contact.pair, .mu = mu}};
    struct rc_model *m;
    struct rc_err err;

    rc_synth_sphere(&shape, radius, h);
    m = rc_elastic_new(&shape, h, &contact, NULL, &err);
    if ((m = rc_friction_new(m, h, &friction, &err)) == NULL)
        return fprintf(stderr, "%s\n", err.text), 1;
    for (int k = 0; k < 6; k++) {
        double moved = slides * (1 - pow(1 - fabs(pull[k]), 2.0 / 3));
        struct rc_point to = {0};

        if (k > 3) /* back from 0.9 */
            moved = slides * (2 * pow(1 - (0.9 - pull[k]) / 2, 2.0 / 3) -
                              1 - pow(0.1, 2.0 / 3));
        rc_point_set(&to, RC_LOAD, load);
        rc_point_set(&to, RC_TANGENTIAL_X, pull[k] * mu * load);
        rc_point_set(&to, RC_TANGENTIAL_Y, 0);
        if (rc_model_run(m, &to, &err) == RC_FAIL ||
            rc_model_look(m, &to, &err) == RC_FAIL ||
            rc_model_keep(m, &err) == RC_FAIL)
            return fprintf(stderr, "%s\n", err.text), 1;
        printf("%.2f N: moved %.4g m, Mindlin %.4g m; %.3f of the "
               "contact sticks\n",
               pull[k] * mu * load, to.at[RC_DISPLACEMENT_X], moved,
               rc_model_number(m, "stick_fraction"));
    }
    rc_model_free(m);
    return 0;
}
