/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Which effects a contact calls for. The elastic contact of two bodies is solved once. From its pressure, gap
 * and displacement, and from data of the materials, each effect gets an interval of the change that it would
 * make: in the contact area, the largest pressure and other figures. A bound of the user turns intervals into
 * verdicts. An effect that costs one more contact is computed; the others are estimated. This header comes
 * with contact.h.
 *
 *     struct rc_scene_data data = {.hardness = 3e9, .yield = 1e9};
 *     struct rc_scene_bounds bounds = {0};
 *     struct rc_scene *s = rc_scene_new(&shape, h, &problem, &data, &err);
 *     for (size_t k = 0; s != NULL && rc_scene_name(k) != NULL; k++) {
 *         struct rc_scene_effect e;
 *         if (rc_scene_estimate(s, k, &e, &err) == RC_OK)
 *             printf("%s: %d\n", e.title, rc_scene_judge(&e, &bounds, NULL));
 *     }
 *     rc_scene_free(s);
 */
#ifndef RC_SCENE_H
#define RC_SCENE_H

#include "grid.h"

#ifdef __cplusplus
extern "C" {
#endif

struct rc_contact;
struct rc_layer;
struct rc_problem;
struct rc_relaxation;
struct rc_scene;

/* Data of the effects; 0 or NULL: not known, so that an effect that needs it has no interval. */
struct rc_scene_data {
    double hardness; /* Pa */
    /* a coat of body 1, the top layer first */
    size_t layers;
    const struct rc_layer *layer;
    double thickness; /* m: of body 1, on a rigid base */
    double yield;     /* Pa: initial yield stress of body 1 */
    /* work of adhesion, J/m2; its law (NULL: the first) and range, m (0: chosen by the grid) */
    double work;
    const char *law;
    double range;
    double mu;         /* coefficient of friction */
    double tangential; /* N */
    double speed;      /* m/s, of sliding */
    double creep[2];   /* of body 2 over body 1, per length rolled towards +x, along x and y */
    double spin;       /* rad/m */
    double wear;       /* 1/Pa: depth that both bodies lose per pressure and distance */
    double distance;   /* m, slid */
    double conductivity[2], diffusivity[2]; /* W/(m K), m2/s, of bodies 1 and 2 */
    int moving;                             /* the body that moves past the contact; 0: 2 */
    double time;                            /* s, since the load acts and heat flows */
    double bending, torsion;                /* Pa: endurance limits of body 1, fully reversed */
    double drop; /* Pa: of a fluid in the gap, from the left edge to the right one */
    /* E(t) of body 1; pair.one.e is its modulus at time 0 */
    const struct rc_relaxation *material;
};

/* What an effect may change. The approach of a body that yields is counted from its undeformed shape. */
enum rc_scene_figure {
    RC_SCENE_AREA,
    RC_SCENE_PRESSURE, /* the largest one */
    RC_SCENE_APPROACH,
    RC_SCENE_DISPLACEMENT, /* along the surface, over that of linear theory */
    RC_SCENE_TEMPERATURE,  /* K */
    RC_SCENE_FRICTION,     /* change of the coefficient; of rolling, force over load */
    RC_SCENE_FATIGUE, /* index of fatigue, 1 at the endurance limit, as the contact passes along x */
    RC_SCENE_LEAK,    /* 1: the gap is open between these edges; 0: it is closed */
    RC_SCENE_PULL_OFF, /* pull-off force over the load */
    RC_SCENE_FIGURES
};
/* Names in that order: "contact_area", "max_pressure", "approach", "displacement", ... */
RC_API extern const char *const rc_scene_figure_names[RC_SCENE_FIGURES];

/* How an interval is known. */
enum rc_scene_basis {
    RC_SCENE_EXACT,     /* the elastic solution is the solution */
    RC_SCENE_COMPUTED,  /* from one more contact */
    RC_SCENE_BOUND,     /* by a theorem */
    RC_SCENE_CALIBRATED /* by a formula with constants that were set on computed contacts */
};
/* Names in that order: "exact", "computed", ... */
RC_API extern const char *const rc_scene_basis_names[];

/* Magnitudes of a change: relative, but temperature in K, friction as a difference, fatigue and leak as they
 * are, with the bounds 1 and 1/2. */
struct rc_interval {
    double low, high; /* NAN: the effect does not change this figure, or it is unknown */
};
enum {
    RC_SCENE_NUMBERS = 4
};
struct rc_scene_effect {
    const char *name, *title;
    enum rc_scene_basis basis;
    /* data that are not given, "mu speed"; NULL: all are */
    const char *missing;
    /* why there is no interval although all data are given; "": there is one */
    char unfit[160];
    struct rc_interval change[RC_SCENE_FIGURES];
    /* nodes in contact, below 20 of which only an exact interval counts */
    size_t nodes;
    /* quantities on which the interval rests; names NULL past the last */
    const char *number_name[RC_SCENE_NUMBERS];
    double number[RC_SCENE_NUMBERS];
};

/* Bounds of a change that does not matter; 0: the default. */
struct rc_scene_bounds {
    double relative;    /* default 0.01 */
    double temperature; /* K, default 10 */
    double friction;    /* default 0.01 */
    unsigned figures;   /* bit of each figure that matters; 0: all */
};
enum rc_scene_verdict {
    RC_SCENE_CALLS,      /* the change is above the bound */
    RC_SCENE_UNDECIDED,  /* the interval holds the bound, or there is none */
    RC_SCENE_NEGLIGIBLE, /* the change is below the bound */
    RC_SCENE_MISSING     /* data are missing */
};
/* Names in that order: "calls for it", "not decided", ... */
RC_API extern const char *const rc_scene_verdict_names[];

/* Solves the elastic contact of the pair, which is uniform and has no hardness, under problem->load. It
 * ignores the hardness and the layers of the problem. NULL when the problem is invalid, the contact does not
 * converge, or memory is short. The heights are kept by the caller; so is what `data` points to. */
RC_API struct rc_scene *rc_scene_new(const struct rc_shape *shape, const double *h,
                                     const struct rc_problem *problem,
                                     const struct rc_scene_data *data, struct rc_err *err);
/* Figures of the contact from which effects are estimated, and its pressure, nx ny Pa. */
RC_API const struct rc_contact *rc_scene_contact(const struct rc_scene *scene);
RC_API const double *rc_scene_pressure(const struct rc_scene *scene);
/* Convolutions of all contacts so far. */
RC_API double rc_scene_convolutions(const struct rc_scene *scene);
/* The name of effect k; NULL past the last. Computed effects come first. */
RC_API const char *rc_scene_name(size_t k);
/* The interval of effect k. RC_FAIL when memory is short. */
RC_API enum rc_status rc_scene_estimate(struct rc_scene *scene, size_t k,
                                        struct rc_scene_effect *effect, struct rc_err *err);
/* From now on effects are estimated from the contact with effect k, whose interval was asked for last and
 * which is a coat, a thin body or a hardness. No effect on the others. */
RC_API void rc_scene_accept(struct rc_scene *scene, size_t k);
/* *figure: the one that decides, if there is an interval. */
RC_API enum rc_scene_verdict rc_scene_judge(const struct rc_scene_effect *effect,
                                            const struct rc_scene_bounds *bounds,
                                            enum rc_scene_figure *figure);
RC_API void rc_scene_free(struct rc_scene *scene);

#ifdef __cplusplus
}
#endif

#endif
