/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Options of a contact for the tools that solve it: load, elasticity, hardness, form, boundary.
 */
#ifndef RC_PHYSICS_H
#define RC_PHYSICS_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"
#include "tools/frames/frames.h"

struct physics {
    struct numbers load, mean_pressure, approach; /* one of them is given */
    double estar, e1, nu1, e2, nu2;               /* given: estar alone, or the others */
    double hardness, radius, cylinder;
    struct boundary_args repeats;
    struct rc_boundary boundary; /* from these options */
    struct steps layer;      /* as on the command line, top first                                */
    struct rc_layer *layers; /* as numbers                                                       */
    double *residual;        /* their residual stresses, Pa; NULL: none                          */
    struct rc_pair pair;     /* the bodies from these numbers                                    */
    double surface_estar;    /* surface estar of the topmost material and body 2 */
    double relaxes;         /* Pa: instantaneous modulus of a viscoelastic body; 0: there is none */
    size_t relaxing_layers; /* layers that have this modulus, instead of body 1                 */
    bool travels;           /* the form is not part of the map, but moves over it               */
    bool pulls;             /* loads and approaches may be negative or 0                        */
    bool history;           /* each load acts on the shape that earlier ones left, and may be 0 */
};

/* Its options, for a row of a tool's table: .group = physics_options, .at = offset of struct physics in the
 * arguments. */
extern const struct opt physics_options[];
/* --history, a bool; and --tilt with its place. */
extern const struct opt history_option[], tilt_options[];
struct tilt_args {
    const char *tilt;  /* a word, or NULL */
    struct numbers at; /* x and y; none: the middle */
};
/* The values without options. */
#define PHYSICS_NONE                                                                               \
    {                                                                                              \
        .estar = NAN, .e1 = NAN, .nu1 = NAN, .e2 = NAN, .nu2 = NAN, .hardness = INFINITY,          \
        .radius = NAN, .cylinder = NAN, .repeats = BOUNDARY_NONE                                   \
    }

/* Ends the tool if too few or too many options were given; otherwise makes the pair. */
void physics_check(struct tool *tool, struct physics *physics);
/* The loads, mean pressures or approaches. */
const struct numbers *physics_steps(const struct physics *physics);

/* Ends the tool when a frame does not hold heights suitable for contact. Otherwise adds the sphere or the
 * cylinder, which the key `form` then names, and warns when the map does not suit the boundary. */
void physics_heights(struct tool *tool, const struct physics *physics, struct rc_grid *heights);
/* The ball that heights are. */
struct ball {
    double radius; /* m, of --radius, otherwise of the key form=sphere R; NAN if it is unknown */
    double along
        [2]; /* m: the mean radii of curvature of the heights along x and y, if the key was read */
    double off; /* m: the largest distance of the heights from the ball of the key */
};
/* The radius is NAN if the curvature of the heights along x or y differs from that of the key by more than
 * 10 %. */
struct ball physics_ball(struct tool *tool, const struct physics *physics,
                         const struct rc_grid *heights);
/* The axis of --cylinder on this map. */
enum rc_map_axis physics_cylinder_axis(const struct physics *physics,
                                       const struct rc_grid *heights);
/* Ends the tool when a frame of hardness beside the heights (or NULL) is invalid, or --hardness is given
 * too. */
void physics_hardness(struct tool *tool, const struct rc_grid *hardness);
/* The heights of body 2 in the file of --counter. They face body 1, as in rc-add: the map is mirrored left to
 * right. The caller frees them. */
struct rc_grid *physics_counter(struct tool *tool, const char *name);
/* Ends the tool if their spacing differs from that of body 1, or if their numbers of nodes along an axis
 * that repeats differ. */
void physics_counter_beside(struct tool *tool, const char *name, const struct rc_grid *counter,
                            const struct rc_grid *heights, struct rc_boundary boundary);
/* The length on which a force per metre acts: the period of a map that repeats along one axis, or the
 * width of the single row or column of a profile. */
double physics_width(const struct physics *physics, const struct rc_grid *heights);
/* The contact at one step of the list, without the options of the solver. */
struct rc_problem physics_problem(const struct physics *physics, const struct rc_grid *heights,
                                  size_t step);

#endif
