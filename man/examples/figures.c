/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a model tells: the names, units and values of its figures, and the means of its frames. */
#include <libcontact/contact.h>
#include <stdio.h>
#include <stdlib.h>

static void
show(struct rc_model *m)
{
    struct rc_shape shape = rc_model_shape(m);
    double *v = malloc(shape.nx * shape.ny * sizeof *v);
    const struct rc_figure *figure;
    const struct rc_frame_kind *frame;
    const void *data;

    for (size_t k = 0; (figure = rc_model_figure(m, k, &data)) != NULL;
         k++)
        if (figure->kind == RC_WORD)
            printf("%s: %s\n", figure->name,
                   rc_figure_word(figure, data));
        else
            printf("%s: %g %s\n", figure->name,
                   rc_figure_number(figure, data),
                   figure->unit != NULL ? figure->unit : "");
    for (size_t k = 0;
         v != NULL && (frame = rc_model_frame_kind(m, k)) != NULL; k++)
        if (rc_model_frame(m, frame->name, v, NULL) == RC_OK)
            printf("frame %s: mean %g %s\n", frame->name,
                   rc_sum(v, shape.nx * shape.ny) /
                       (double)(shape.nx * shape.ny),
                   frame->unit);
    free(v);
}

int
main(void)
{
    static double h[65 * 65];
    struct rc_shape shape = {65, 65, 1e-5, 1e-5};
    struct rc_problem problem = {.pair.estar = 114e9, .tol = 1e-6};
    struct rc_model *m;
    struct rc_point to = {0};
    struct rc_err err;

    rc_synth_sphere(&shape, 7.5e-3, h);
    m = rc_elastic_new(&shape, h, &problem, NULL, &err);
    rc_point_set(&to, RC_LOAD, 100);
    if (m == NULL || rc_model_run(m, &to, &err) == RC_FAIL ||
        rc_model_look(m, NULL, &err) == RC_FAIL)
        return fprintf(stderr, "%s\n", err.text), 1;
    show(m);
    rc_model_free(m);
    return 0;
}
