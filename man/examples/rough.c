/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A rough surface is pressed flat. In complete contact the pressure is linear in the heights. */
#include <libcontact/contact.h>
#include <stdio.h>

enum {
    N = 128
};
static double h[N * N], p[N * N];

int
main(void)
{
    static const double parts[] = {0.01, 0.1, 1, 6};
    const double estar = 100e9, slope = 0.05, full = estar * slope / 2;
    struct rc_shape shape = {N, N, 1e-6, 1e-6};
    struct rc_selfaffine rough = {
        .hurst = 0.8, .rms_slope = slope, .short_cut = 8e-6, .seed = 1};
    struct rc_problem problem = {
        .boundary = RC_PERIODIC, .pair.estar = estar, .tol = 1e-5};
    struct rc_model *m;
    struct rc_err err;

    if (rc_synth_selfaffine(&shape, &rough, h, &err) != RC_OK ||
        (m = rc_elastic_new(&shape, h, &problem, NULL, &err)) == NULL)
        return fprintf(stderr, "%s\n", err.text), 1;
    for (int k = 0; k < 4; k++) {
        struct rc_point to = {0};
        struct rc_statistics of_p;

        rc_point_set(&to, RC_LOAD,
                     parts[k] * full * (N * 1e-6) * (N * 1e-6));
        if (rc_model_run(m, &to, &err) == RC_FAIL ||
            rc_model_look(m, NULL, &err) == RC_FAIL ||
            rc_model_frame(m, "pressure", p, &err) == RC_FAIL)
            return fprintf(stderr, "%s\n", err.text), 1;
        rc_measure(&shape, p, &of_p);
        printf(
            "%.6g Pa: contact on %.4f of the area, RMS pressure %.6g "
            "Pa%s\n",
            of_p.mean, rc_model_number(m, "contact_fraction"), of_p.rms,
            rc_elastic_result(m)->contact.converged ? ""
                                                    : ", not converged");
    }
    printf("complete contact in theory: RMS pressure %.6g Pa\n", full);
    rc_model_free(m);
    return 0;
}
