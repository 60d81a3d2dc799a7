/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A rough surface slides and wears. The worn volume is that of Archard's law. */
#include <libcontact/contact.h>
#include <stdio.h>

enum {
    N = 64
};
static double h[N * N];

int
main(void)
{
    const double k = 1e-16, load = 0.2, estar = 100e9, tol = 0.02;
    struct rc_shape shape = {N, N, 1e-6, 1e-6};
    struct rc_selfaffine rough = {
        .hurst = 0.8, .rms_height = 50e-9, .short_cut = 8e-6, .seed = 1};
    struct rc_problem contact = {
        .boundary = RC_PERIODIC, .pair.estar = estar, .tol = tol / 100};
    struct rc_wear_problem wear = {.k = {k}, .estar = estar, .tol = tol};
    struct rc_model *m;
    struct rc_err err;

    if (rc_synth_selfaffine(&shape, &rough, h, &err) != RC_OK)
        return fprintf(stderr, "%s\n", err.text), 1;
    m = rc_elastic_new(&shape, h, &contact, NULL, &err);
    if ((m = rc_wear_new(m, h, &wear, &err)) == NULL)
        return fprintf(stderr, "%s\n", err.text), 1;
    for (double s = 0; s <= 2; s += 0.5) {
        struct rc_point to = {0};

        rc_point_set(&to, RC_LOAD, load);
        rc_point_set(&to, RC_DISTANCE, s);
        if (rc_model_run(m, &to, &err) == RC_FAIL ||
            rc_model_look(m, NULL, &err) == RC_FAIL ||
            rc_model_keep(m, &err) == RC_FAIL)
            return fprintf(stderr, "%s\n", err.text), 1;
        printf("%.1f m: contact on %.3f of the area, worn %.6g m3, "
               "Archard %.6g m3\n",
               s, rc_model_number(m, "contact_fraction"),
               rc_model_number(m, "wear_volume"), k * load * s);
    }
    rc_model_free(m);
    return 0;
}
