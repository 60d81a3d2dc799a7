/*
 * What a contact is, as the tools that solve it are told: load, elasticity, hardness, form,
 * boundary.
 */
#ifndef RC_PHYSICS_H
#define RC_PHYSICS_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

struct physics {
    struct numbers load, mean_pressure, approach; /* one of them                      */
    double estar, e1, nu1, e2, nu2;               /* the first, or the others         */
    double hardness, radius;
    bool periodic;
    struct steps layer;      /* as they stand on the line, top first                              */
    struct rc_layer *layers; /* as numbers                                                        */
    double *residual;        /* their residual stresses, Pa; NULL: none                           */
    struct rc_pair pair;     /* what all these say                                                */
    double surface_estar;    /* of the topmost material and body 2                               */
    bool attracts;           /* loads and approaches may be of either sign, and 0                */
    bool history; /* a load acts on the shape that those before it have left, and may be 0 */
};

/* Its options, for a row of a tool's table: .group = physics_options, .at = where the args keep
 * it. */
extern const struct opt physics_options[];
/* Nothing given. */
#define PHYSICS_NONE                                                                               \
    {                                                                                              \
        .estar = NAN, .e1 = NAN, .nu1 = NAN, .e2 = NAN, .nu2 = NAN, .hardness = INFINITY,          \
        .radius = NAN                                                                              \
    }

/* Ends the tool where too little or too much was given; else makes the pair. */
void physics_check(struct tool *tool, struct physics *physics);
/* The loads, mean pressures or approaches. */
const struct numbers *physics_steps(const struct physics *physics);

/* Ends the tool where a frame does not hold heights that can be pressed; else adds the sphere, which
 * the key `form` then names, and warns of what the boundary does not suit. */
void physics_heights(struct tool *tool, const struct physics *physics, struct rc_grid *heights);
/* Ends the tool where a map of hardness beside the heights, or NULL, is none, or --hardness is given too. */
void physics_hardness(struct tool *tool, const struct rc_grid *hardness);
/* The contact at one of the steps; how it is to be solved is left open. */
struct rc_problem physics_problem(const struct physics *physics, const struct rc_grid *heights,
                                  size_t step);

#endif
