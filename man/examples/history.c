/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A ball that yields at 1.5 GPa is loaded, unloaded, loaded again and loaded higher. */
#include <libcontact/contact.h>
#include <stdio.h>

int
main(void)
{
    static const double loads[] = {240, 0, 240, 300};
    static double h[65 * 65], gap[65 * 65];
    struct rc_shape shape = {65, 65, 1e-5, 1e-5};
    struct rc_problem problem = {
        .pair.estar = 114e9, .load = 240, .hardness = 1.5e9};
    struct rc_solver *solver;
    struct rc_contact c;

    rc_synth_sphere(&shape, 7.5e-3, h);
    solver = rc_solver_new(&shape, h, &problem, NULL);
    for (int k = 0; k < 4 && solver != NULL; k++) {
        rc_contact_apart(NULL, &shape, h, gap, &c);
        if (loads[k] > 0 &&
            rc_solver_set_load(solver, loads[k], 0, NULL) == RC_OK) {
            while (rc_solver_step(solver) == RC_MORE)
                continue;
            rc_solver_result(solver, NULL, gap, &c);
            rc_solver_keep_shape(solver, &c, h, NULL);
        }
        printf("%g N: %zu nodes in contact, %zu yield\n", loads[k],
               c.contact_nodes, c.yielded_nodes);
    }
    rc_solver_free(solver);
    return 0;
}
