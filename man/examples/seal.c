/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ridges are pressed flat: the leakage along them is the sum of the cubes of the gap. */
#include <libcontact/contact.h>
#include <math.h>
#include <stdio.h>

enum {
    N = 64
};
static double h[N * N], p[N * N], gap[N * N];

int
main(void)
{
    const double dx = 1e-6;
    struct rc_shape shape = {N, N, dx, dx};
    struct rc_problem problem = {.boundary = RC_PERIODIC,
                                 .pair.estar = 10e9};
    struct rc_leak_options along = {.direction = 'y', .around = true};
    struct rc_leak *leak = NULL;
    struct rc_model *m;
    struct rc_err err;

    rc_synth_wave(&shape, 1e-7, N * dx, INFINITY, h);
    if ((m = rc_elastic_new(&shape, h, &problem, NULL, &err)) == NULL)
        return fprintf(stderr, "%s\n", err.text), 1;
    for (double load = 0.02; load < 0.2; load *= 2) {
        struct rc_point to = {0};
        double cubes = 0;

        rc_point_set(&to, RC_LOAD, load);
        if (rc_model_run(m, &to, &err) == RC_FAIL ||
            rc_model_look(m, NULL, &err) == RC_FAIL ||
            rc_model_frame(m, "pressure", p, &err) == RC_FAIL ||
            rc_model_frame(m, "gap", gap, &err) == RC_FAIL)
            return fprintf(stderr, "%s\n", err.text), 1;
        if (leak == NULL ? (leak = rc_leak_new(&shape, p, gap, &along,
                                               &err)) == NULL
                         : rc_leak_set_gap(leak, p, gap, &err) == RC_FAIL)
            return fprintf(stderr, "%s\n", err.text), 1;
        while (rc_leak_step(leak, &err) == RC_MORE)
            continue;
        for (int i = 0; i < N; i++)
            cubes += p[i] > 0 ? 0 : pow(gap[i], 3);
        printf("%g N: conductance %.6g m3, sum of the cubes %.6g m3\n",
               load, rc_leak_result(leak)->conductance, cubes / N);
    }
    rc_leak_free(leak);
    rc_model_free(m);
    return 0;
}
