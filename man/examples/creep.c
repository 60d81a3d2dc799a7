/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A rigid ball under a constant load sinks into a viscoelastic body (Lee and Radok 1960). */
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
    static const double modulus = 9e6, time = 1;
    const double radius = 10e-3, load = 0.1;
    struct rc_err err;
    struct rc_relaxation *rubber =
        rc_relaxation_new(1e6, 1, &modulus, &time, &err);
    struct rc_shape shape = {N, N, 50e-6, 50e-6};
    struct rc_problem contact = {.tol = 1e-3};
    struct rc_viscoelastic_problem creep = {
        .material = rubber, .share = 1, .tol = 8e-3};
    struct rc_model *m;

    if (rubber == NULL)
        return fprintf(stderr, "%s\n", err.text), 1;
    rc_synth_sphere(&shape, radius, h);
    contact.pair.estar = rc_relaxation_modulus(rubber, 0);
    m = rc_elastic_new(&shape, h, &contact, NULL, &err);
    if ((m = rc_viscoelastic_new(m, h, &creep, &err)) == NULL)
        return fprintf(stderr, "%s\n", err.text), 1;
    for (double t = 0; t <= 20; t = t > 0 ? 4 * t : 0.25) {
        double j = rc_relaxation_compliance(rubber, t);
        struct rc_point to = {0};

        rc_point_set(&to, RC_LOAD, load);
        rc_point_set(&to, RC_TIME, t);
        if (rc_model_run(m, &to, &err) == RC_FAIL ||
            rc_model_look(m, &to, &err) == RC_FAIL ||
            rc_model_keep(m, &err) == RC_FAIL)
            return fprintf(stderr, "%s\n", err.text), 1;
        printf("%g s: approach %.4g m, Lee and Radok %.4g m\n", t,
               to.at[RC_APPROACH],
               pow(0.75 * load * j, 2.0 / 3) * pow(radius, -1.0 / 3));
    }
    rc_model_free(m);
    rc_relaxation_free(rubber);
    return 0;
}
