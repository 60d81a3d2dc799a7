/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Shared by the files of this folder. An effect is a row of a table: the data that it needs, and the function
 * that finds its interval. Internal: never installed.
 */
#ifndef RC_SCENE_PARTS_H
#define RC_SCENE_PARTS_H

#include "libcontact/common.h"
#include "libcontact/memory.h"

/* A solved contact. */
struct solved {
    double *p, *gap, *u; /* Pa, m, m */
    double *shape;       /* m: heights after unloading; NULL: no hardness */
    struct rc_contact contact;
    double stiffness; /* N/m; NAN: not asked for */
};

struct rc_scene {
    struct rc_store own; /* the arrays */
    struct rc_shape shape;
    size_t n;
    const double *h;
    struct rc_scene_data data;
    struct rc_layer thin; /* body 1, if it is thin */
    /* problems and contacts: elastic; from which effects are estimated; solved last */
    struct rc_problem plain, problem, other_problem;
    struct solved elastic, now, other;
    struct solved
        relaxed; /* elastic contact with the compliance of data.time; p NULL: not solved */
    double relaxed_modulus; /* Pa: its E* */
    size_t computed;        /* the effect whose contact is in `other`; SIZE_MAX: none */
    bool accepted;          /* `now` has a computed effect: low ends of estimates are not known */
    double convolutions;
};

struct scene_row {
    const char *name, *title;
    const char *needs; /* names of data, "mu speed"; "": none */
    bool accepts;      /* later effects may be estimated from its contact */
    enum rc_status (*find)(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);
};

struct asked {
    const struct rc_problem *problem;
    const double *h;   /* NULL: the heights of the scene */
    double compliance; /* m/Pa, of single nodes, as in rc_model_set_compliance */
    bool stiffness;    /* its stiffness too */
};
/* Solves a contact. RC_SHORT where it does not converge. */
enum rc_status scene_solve(struct rc_scene *s, const struct asked *asked, struct solved *to,
                           struct rc_err *err);
/* Magnitudes of the relative changes of area, largest pressure and approach. */
void scene_changes(const struct solved *from, const struct solved *to,
                   double change[RC_SCENE_FIGURES]);

static inline void
scene_set(struct rc_scene_effect *e, enum rc_scene_figure figure, double low, double high)
{
    e->change[figure] = (struct rc_interval){fmax(low, 0), fmax(high, 0)};
}
/* The area of the largest patch, and that of all without the steps of the grid; NULL: not wanted. */
enum rc_status scene_patches(struct rc_scene *s, double *largest, double *corrected,
                             struct rc_err *err);
/* How it is known that the elastic solution is the solution: for certain, if the grid resolves the contact;
 * the stresses of few nodes are too small. */
enum rc_scene_basis scene_elastic_basis(const struct rc_scene *s);
void scene_number(struct rc_scene_effect *e, const char *name, double value);

/* computed.c */
enum rc_status scene_grid(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);
enum rc_status scene_tilt(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);
enum rc_status scene_thin(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);
enum rc_status scene_coat(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);
enum rc_status scene_hardness(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);
enum rc_status scene_slip(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);
enum rc_status scene_relaxation(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);
/* Solves the contact in `relaxed`, once; where it does not converge RC_SHORT, and e->unfit says so. */
enum rc_status scene_relaxed(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);
/* estimated.c */
enum rc_status scene_yield(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);
enum rc_status scene_adhesion(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);
enum rc_status scene_wear(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);
enum rc_status scene_heat(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);
enum rc_status scene_dissimilar(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);
enum rc_status scene_sliding(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);
/* The largest Mises stress of the contact in a uniform body 1, and its depth. */
enum rc_status scene_mises(struct rc_scene *s, const double *p, double *most, double *depth,
                           struct rc_err *err);
/* Whether rc-solve --adhesion computes this contact, on a grid that resolves the law; else e->unfit. */
bool scene_adheres(const struct rc_scene *s, const struct rc_adhesion_problem *problem,
                   struct rc_adhesion_scales *scales, struct rc_scene_effect *e);
/* The contact in `other` under this load and the attraction at the gap of `from`: the heights with its
 * displacement, and the load with its sum, N. In contact the attraction has its full strength. */
enum rc_status scene_attracted(struct rc_scene *s, const struct rc_adhesion_problem *problem,
                               const struct rc_adhesion_scales *scales, const struct solved *from,
                               double load, double *sum, struct rc_err *err);
/* forces.c */
enum rc_status scene_rolling(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);
enum rc_status scene_pull_off(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);
/* limits.c */
enum rc_status scene_fatigue(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);
enum rc_status scene_leak(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err);

#endif
