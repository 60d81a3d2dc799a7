/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * libcontact: contact of rough surfaces on elastic half-spaces.
 *
 * A map of heights is pressed against a flat; two rough surfaces are one map, the sum of both (rc_add). The
 * library finds where the bodies touch, at what pressure and with what gap. Models add yield, adhesion,
 * friction, rolling, wear, travel and viscoelasticity. From the result it computes leakage, temperatures,
 * stresses and fatigue. It works on arrays: it reads no files and prints nothing.
 *
 *     #include <libcontact/contact.h>
 *     #include <stdio.h>
 *
 *     static double h[129 * 129], p[129 * 129];
 *
 *     int
 *     main(void)
 *     {
 *         struct rc_shape shape = {129, 129, 5.3e-6, 5.3e-6};
 *         struct rc_problem problem = {.pair.estar = 114e9, .tol = 1e-6};
 *         struct rc_point to = {0};
 *         struct rc_err err;
 *
 *         rc_synth_sphere(&shape, 7.5e-3, h);
 *         struct rc_model *m = rc_elastic_new(&shape, h, &problem, NULL, &err);
 *         rc_point_set(&to, RC_LOAD, 240);
 *         if (m == NULL || rc_model_run(m, &to, &err) == RC_FAIL ||
 *             rc_model_look(m, &to, &err) == RC_FAIL ||
 *             rc_model_frame(m, "pressure", p, &err) == RC_FAIL)
 *             return fprintf(stderr, "%s\n", err.text), 1;
 *         printf("approach %g m, contact area %g m2, largest pressure %g Pa\n",
 *                to.at[RC_APPROACH], rc_model_number(m, "contact_area"),
 *                p[64 * 129 + 64]);
 *         rc_model_free(m);
 *     }
 *
 * A model (model.h) has a history; one set of functions drives all models, and an outer model, such as wear,
 * drives an inner one. A handle, such as struct rc_solver, is a single problem with functions of its own.
 *
 * Units and signs. Everything is SI: metres, pascals, newtons. Height is positive towards the other body,
 * pressure in compression, displacement into the body, stress in tension, depth below the surface. Body 1 is
 * the one that stresses, plasticity and fatigue analyse.
 *
 * Maps. A map is an array of nx ny doubles in the layout of grid.h: value (i, j) is v[j * nx + i] and belongs
 * to the cell about x = (i - (nx - 1)/2) dx, y = (j - (ny - 1)/2) dy. On the free half-space the pressure is
 * constant in its cell, on a periodic map it is band-limited.
 *
 * Options. In a struct of options 0, or NULL, is the default of every member, so that
 *
 *     struct rc_problem problem = {.pair.estar = 114e9, .load = 240};
 *
 * is complete, and remains so when members are added. Results that are unknown are NAN.
 *
 * Errors. A maker (rc_..._new) returns NULL, other functions return RC_FAIL, and the struct rc_err of the
 * caller, or NULL, then holds one sentence: what is wrong, with the value, and what to do. A function that
 * needs another one before it fails in this way, too. A check (rc_..._check) and a forecast (rc_..._expect)
 * fail as the maker would, except for short memory. RC_MORE is an unfinished iteration. RC_SHORT is one that
 * cannot reach the accuracy: its result is the best so far, and there is no sentence. Results say so with
 * `converged`. All functions that free an object take NULL.
 *
 * Ownership. The caller owns its arrays, and all that the members of a struct of options point to.
 *
 *   - Arguments: a function copies what it needs later. Keep the heights of a model until its first
 *     rc_model_go or rc_model_restore has returned, and the pressure and tractions of rc_stress_new until
 *     rc_stress_free or rc_stress_set_loads, and the map of rc_model_set_compliance until another is set.
 *   - Members of options: keep what they point to, unchanged, until the object is freed.
 *   - Inner models: the maker of an outer model owns the inner model from the call on, also when it fails. An
 *     inner model NULL makes it fail with the message of that one, so that makers can be nested.
 *     rc_model_free of the outermost model frees all.
 *   - Results: what a returned pointer points to belongs to the object, until the next call that changes it.
 *
 * Tolerance. `tol` bounds the estimated error of the object that has it. An outer model does not divide its
 * tolerance: the caller, who makes the inner model, gives that one a part of it:
 *
 *     wear              1/100; 1/1000 with `part`
 *     friction          1/4 if RC_COUPLING_FULL couples dissimilar bodies,
 *                       otherwise 1; 1/40 for `inner_of_fewer`
 *     viscoelastic      1/8
 *     travel, rolling   1
 *
 * Threads. The member `threads` sets the number of threads of one object; it changes no bit of a result. Two
 * threads of the caller may use two objects at the same time, but not the same object; a model, its inner
 * models and its solver are one object. The library has no state between calls except the memory budget
 * (rc_memory_budget), which holds for the process. It switches on the lock of FFTW's planner when it is
 * loaded, so that the caller's threads may plan transforms too; with libfftw3_omp they may not. While
 * rc_synth_selfaffine or rc_detrend_form runs, GSL's error handler is off in all threads.
 */
#ifndef RC_CONTACT_H
#define RC_CONTACT_H

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>

#include "grid.h"
#include "model.h"
#include "scene.h"
#include "surface.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- handles ---- */

struct rc_conv;    /* displacements under a pressure: u = K p */
struct rc_solver;  /* elastic contact, with or without a hardness                     */
struct rc_leak;    /* flow through a gap                                              */
struct rc_stress;  /* stresses below the surface                                      */
struct rc_fatigue; /* fatigue under the stresses below the surface                    */
struct rc_heat;    /* temperatures of the contact                                     */
struct rc_ranks;   /* processes that share a map: contact_mpi.h           */

/* Version of the library, "0.1.0". */
RC_API const char *rc_version(void);
/* Processors this process may use, at least 1. */
RC_API size_t rc_threads_available(void);

/* ---- tables: engines and methods ---- */

/* Smaller errors than this need double precision; single precision gives some 1e-6 of the largest |u|. */
#define RC_SINGLE_FLOOR 1e-5

/* An engine: a way to sum displacements. */
struct rc_engine_info {
    const char *name, *summary;
    /* works for periodic boundaries too */
    bool periodic;
    /* methods may iterate with it in single precision */
    bool mixed;
    /* the engine of the row before in double precision throughout */
    bool precise;
    /* its time grows as this power of the number of nodes */
    int order;
    /* Bytes for each node, on free and periodic maps. First: a sum, beside p and u, in single
     * precision if the engine is mixed. Then: a solver. Measured on 1024 x 1024 nodes; smaller
     * maps need a few percent more. */
    double sum_bytes[2], contact_bytes[2];
};
/* A method: an iteration of the contact. "auto" is the first one. */
struct rc_method_info {
    const char *name, *summary;
    bool mixed;   /* iterates in single precision if the engine permits it */
    double bytes; /* bytes a node in addition to those of "auto" */
};
/* Row k = 0, 1, ... of a table; NULL past the last. Options take their words from these tables. */
RC_API const struct rc_engine_info *rc_engine_info(size_t k);
RC_API const struct rc_method_info *rc_method_info(size_t k);

/* ---- bodies ---- */

/* A layer of isotropic material, bonded to the material below. */
struct rc_layer {
    double thickness; /* m, > 0 */
    double e, nu;     /* Young's modulus, Pa, > 0; Poisson's ratio, above -1 and at most 0.5 */
};
/* An elastic half-space, uniform or under layers. */
struct rc_body {
    double e, nu;                 /* moduli of the half-space; e INFINITY: rigid */
    size_t layers;                /* 0: uniform */
    const struct rc_layer *layer; /* the top layer first */
};
/* Index of the material at a depth (m): 0 the top layer, `layers` the half-space. An interface belongs to the
 * material above it. */
RC_API size_t rc_body_material(const struct rc_body *body, double depth);

/* The two bodies in contact, or E* alone for uniform bodies. */
struct rc_pair {
    /* body 1, which stress and plasticity analyse */
    struct rc_body one;
    /* e 0: rigid */
    struct rc_body two;
    /* Pa, 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2, if `one` and `two` are left out; 0: computed
     * from them */
    double estar;
};

/* ---- convolution ---- */

struct rc_conv_options {
    struct rc_boundary boundary;
    /* a row of engines.list, or NULL or "auto" */
    const char *engine;
    /* asked error of u, relative to the sum of |K| |p|; 0: rounding */
    double tol;
    /* in double precision throughout, even where tol permits less */
    bool precise;
    /* t, m_c of the engine mlms, both or none */
    size_t order, correction;
    /* bytes that "auto" may use; 0: any */
    size_t memory;
    /* expected fraction of nodes with pressure, for "auto"; 0: unknown */
    double loaded;
    /* 0: all */
    size_t threads;
    /* processes that share the map; NULL: none */
    const struct rc_ranks *ranks;
};

/* The engine that such a plan would use, and the reason; "" when there is none of that name. */
RC_API const char *rc_conv_choice(const struct rc_shape *shape,
                                  const struct rc_conv_options *options, const char **reason);
/* Seconds of one such sum within a solve, including the work of the method. They were measured on a machine
 * of 2026; other machines may differ by several times. NAN when there is no such engine. */
RC_API double rc_conv_seconds(const struct rc_shape *shape, const struct rc_conv_options *options);
/* u = K p: the sum of the displacements of both bodies (m) under the pressure p (Pa). With RC_PERIODIC the
 * mean of u is 0, because the displacement of a periodic half-space under a mean pressure is unbounded. NULL
 * when a number of the bodies is invalid, there is no such engine, none for the boundary or the ranks, or
 * memory is short. */
RC_API struct rc_conv *rc_conv_new(const struct rc_shape *shape, const struct rc_pair *pair,
                                   const struct rc_conv_options *options, struct rc_err *err);
/* p and u do not overlap. */
RC_API void rc_conv_apply(struct rc_conv *conv, const double *p, double *u);
/* Name of the engine, and the reason for its choice in a few words. */
RC_API const char *rc_conv_engine(const struct rc_conv *conv);
RC_API const char *rc_conv_reason(const struct rc_conv *conv);
/* The engine's own bound of the error of u, relative to the sum of |K| |p|. */
RC_API double rc_conv_error(const struct rc_conv *conv);
RC_API void rc_conv_free(struct rc_conv *conv);

/* ---- solver ---- */

struct rc_problem {
    struct rc_boundary boundary;
    /* the bodies */
    struct rc_pair pair;
    /* total normal force, N, > 0; with an approach a guess, or 0 */
    double load;
    /* m, > 0: approach from first touch, for which the load is found; 0: the load is given. If
     * one axis repeats it needs a datum of at least a quarter of the other one, and more under
     * a stiff coat */
    double approach;
    /* upper bound of the pressure, Pa; 0 or INFINITY: none */
    double hardness;
    /* Pa, nx ny: hardness of each node, NAN or INFINITY for none; NULL: `hardness` holds for all
     * nodes */
    const double *hardness_map;
    /* m: error of the heights, as the shape_error of the solution that made them; only affects
     * which nodes count as yielded */
    double height_error;
    /* the counter body tilts until the pressures have no moment about the point where the load
     * acts; not with RC_PERIODIC */
    bool tilt_free;
    /* m: that point, x and y from the middle of the map */
    double force_at[2];
    /* asked relative L1 error of the pressure; 0: (nx ny)^(-3/4), at most 1e-3 */
    double tol;
    /* fraction of tol for a yielding load of a history, whose error stays in the shape; 0: 1 */
    double history_part;
    /* NULL: auto */
    const char *engine;
    /* NULL: auto */
    const char *method;
    /* 0: 100 + 10 sqrt(nx ny) */
    size_t max_iterations;
    /* 0: all */
    size_t threads;
    /* estimate the discretization error; also solves a coarser grid */
    bool discretization;
    /* processes that share the map; NULL: none */
    const struct rc_ranks *ranks;
    /* If this is not 0 (a signal handler may set it), the caller cannot wait. A step ends early,
     * also within a convolution, and rc_solver_result uses gap and displacement of the last
     * step, in single precision if its convolutions were. If the step has changed the pressure,
     * or none was finished on this grid, the gap costs a convolution in single precision.
     * Without a hardness it is made only for displacement or gap; else the figures of the gap
     * are NAN. NULL: never. Ignored with ranks, and where a contact is part of another problem. */
    const volatile sig_atomic_t *hurry;
};

/* Estimated relative errors of contact area, largest pressure and approach; NAN: unknown, also that of
 * the last two for a contact at a free edge of the map, and that of the largest pressure if a node with a
 * neighbour out of contact has more than .9 of it, or, in a profile, is beside it. */
struct rc_discretization {
    double contact_area, max_pressure, approach;
};

/* The figures of a solution, after rc_solver_step returns RC_OK or RC_SHORT, or after any earlier
 * iteration. */
struct rc_contact {
    /* N, Pa, Pa: summed from the pressure itself */
    double load, mean_pressure, max_pressure;
    /* p > 0; p = hardness */
    size_t contact_nodes, plastic_nodes;
    /* p = hardness, and a gap that is negative by more than four times the error of gap and
     * heights: nodes that yield under this load */
    size_t yielded_nodes;
    /* m^2, - */
    double contact_area, contact_fraction;
    /* m^2 */
    double plastic_area, yielded_area;
    /* load on the outer 2 % of the map */
    double edge_load_fraction;
    /* Pa: the largest pressure of the nodes at the free edges of the map; 0: no edge is free */
    double edge_pressure;
    /* m, from first touch, that of the highest node; NAN when no node is elastic, unless the
     * approach was given and suits the contact. With a free tilt: at the point where the load
     * acts, from the position where a rigid body would rest. */
    double approach;
    /* slope of the counter body along x and y */
    double tilt[2];
    /* m, mean of max(gap, 0) over the whole map */
    double mean_gap;
    /* J, of both bodies: the integral of p u / 2. On a periodic map without the energy of the
     * mean pressure, which depends on the thickness of the bodies. If one axis repeats it is
     * that within the distance `datum` */
    double elastic_energy;
    /* m: the largest violation of gap >= 0 where p = 0, gap = 0 where elastic, gap <= 0 at the
     * hardness, from a fresh convolution */
    double gap_error;
    /* m: error of the heights of rc_solver_plastic */
    double shape_error;
    /* gap_error over max(std h, std u); for equal heights over the largest displacement due to
     * the mean pressure */
    double kkt_residual;
    /* estimated relative L1 error of the pressure; NAN when stopped on a coarser grid; the part
     * of it from earlier loads of a history, through the shape */
    double pressure_error, inherited_error;
    size_t iterations;
    /* equivalents on the finest grid */
    double convolutions;
    /* estimated discretization errors */
    struct rc_discretization discretization;
    /* pressure_error <= tol, at the given load or approach */
    bool converged;
    /* some node is at the hardness */
    bool hardness_active;
};

/* The engine that such a solver would use, and the reason; "" when there is none of that name. */
RC_API const char *rc_solver_choice(const struct rc_shape *shape, const struct rc_problem *problem,
                                    const char **reason);
/* The cost of a computation, before it begins. */
struct rc_expected {
    double convolutions, seconds;
    size_t memory; /* bytes of a rank, without the caller's arrays, code, and FFTW's plans */
};
/* Further bytes a node of rc_solver_stiffness and rc_solver_conductance while they run. */
enum {
    RC_STIFFNESS_BYTES = 12,
    RC_CONDUCTANCE_BYTES = 20
};
/* Expected cost of such a solver, from benchmark fits: convolutions (equivalents) and seconds, both NAN where
 * unknown, and bytes. RC_FAIL when rc_solver_new would refuse the problem, except for short memory. Examples:
 * no such engine or method, none for the boundary or the ranks, no solution under the load. */
RC_API enum rc_status rc_solver_expect(const struct rc_shape *shape,
                                       const struct rc_problem *problem,
                                       struct rc_expected *expected, struct rc_err *err);
/* The heights h are finite. NULL if the load exceeds hardness * area, or the sum of the hardness map times
 * the cell (the message has both numbers). NULL also if the problem is invalid or memory is short. */
RC_API struct rc_solver *rc_solver_new(const struct rc_shape *shape, const double *h,
                                       const struct rc_problem *problem, struct rc_err *err);
/* Starts another first loading of the same surface. Its target is a load in N or, with approach > 0, an
 * approach in m; the last solution is only its start. Resets the counts. RC_FAIL as in rc_solver_new; the
 * solver can then only be freed. */
RC_API enum rc_status rc_solver_set_load(struct rc_solver *solver, double load, double approach,
                                         struct rc_err *err);
/* Another asked relative L1 error of the pressure, > 0, from the next load on. The engine keeps the tolerance
 * of rc_solver_new, which should not be far above this one. */
RC_API void rc_solver_set_tol(struct rc_solver *solver, double tol);
/* Other heights (nx ny m), under the present load or approach: same plan and memory, no new tables; the
 * last pressure is the start. Resets the counts. RC_FAIL when a height is not finite (nothing has then
 * changed), and as in rc_solver_set_load. */
RC_API enum rc_status rc_solver_set_heights(struct rc_solver *solver, const double *h,
                                            struct rc_err *err);
/* Starts from this pressure (nx ny Pa) of an earlier solver of the same problem instead of from coarser
 * grids. The pressure is projected onto bounds and load. load (N) is the load of this pressure; it is needed
 * when the approach is given. p NULL: starts from coarser grids, as a new solver does. RC_FAIL after the
 * first step of a load, and as in rc_solver_set_load. */
RC_API enum rc_status rc_solver_warm_start(struct rc_solver *solver, double load, const double *p,
                                           struct rc_err *err);
/* One iteration, on coarser grids first: RC_MORE, RC_OK when the estimated error is below tol, RC_SHORT when
 * it cannot get there (iteration limit, rounding). */
RC_API enum rc_status rc_solver_step(struct rc_solver *solver);
struct rc_progress {
    struct rc_shape grid;
    bool coarser; /* than the map's own grid, whose start it computes */
    size_t iterations;
    double error, tol;
};
/* Progress: the grid of the present iterations (a coarser one at first), the number of iterations on it, and
 * two errors. These are the last estimated error there (NAN before the first) and the error asked for. */
RC_API void rc_solver_progress(const struct rc_solver *solver, struct rc_progress *progress);
/* Convolutions so far, in equivalents of one in double precision on this grid; those on coarser grids and in
 * single precision count with their share. */
RC_API double rc_solver_convolutions(const struct rc_solver *solver);
/* The present load, N: the given one, or the last one tried for an approach. */
RC_API double rc_solver_load(const struct rc_solver *solver);
/* The present pressure (nx ny Pa), valid until the next step. */
RC_API const double *rc_solver_pressure(const struct rc_solver *solver);
/* Fresh displacement and gap of that pressure (either may be NULL) and the figures; see `hurry`. */
RC_API void rc_solver_result(struct rc_solver *solver, double *displacement, double *gap,
                             struct rc_contact *contact);
/* The height map (nx ny m) after elastic unloading: where the hardness was reached, the heights are lower by
 * the overlap; accurate to shape_error. Under the same load again, this shape carries the same pressure
 * without further yielding. Call it after rc_solver_result. */
RC_API enum rc_status rc_solver_plastic(const struct rc_solver *solver, double *h,
                                        struct rc_err *err);
/* For a loading history, where each load acts on the shape that earlier ones left: set each load, step to the
 * end, take the result, then call this. h (nx ny m; in: the loaded heights) and the heights of the solver
 * become the shape after unloading. Its error is at most contact->shape_error of the rc_contact from
 * rc_solver_result. If no node has yielded, nothing changes. RC_FAIL as in rc_solver_plastic and
 * rc_solver_set_heights. */
RC_API enum rc_status rc_solver_keep_shape(struct rc_solver *solver,
                                           const struct rc_contact *contact, double *h,
                                           struct rc_err *err);
/* The unloaded state of bodies of these heights (nx ny m): gap at first touch. The gap (nx ny m, or NULL; not
 * h itself) and its mean; no pressure, no displacement. `ranks`: processes that share the map; NULL: none. */
RC_API void rc_contact_apart(const struct rc_ranks *ranks, const struct rc_shape *shape,
                             const double *h, double *gap, struct rc_contact *contact);
/* d load / d approach, N/m, at the solution, after rc_solver_result: the increase of the load of the
 * elastic nodes while no node joins or leaves. NAN when none is elastic, where a periodic surface is in
 * complete contact, and where the datum lies so near that the approach does not grow with the load.
 * Takes 10 to 20 convolutions; RC_FAIL when memory is short. */
RC_API enum rc_status rc_solver_stiffness(struct rc_solver *solver, double *stiffness,
                                          struct rc_err *err);
/* Conductance of heat or electric current from one body to the other, by Barber's analogy (Proc. R. Soc. A
 * 459 (2003) 53). For conductivities k1, k2 of the bodies it is 2 S/(E* (1/k1 + 1/k2)). S is the stiffness if
 * all nodes in contact, also those at the hardness, moved together. It is the flow over the difference of the
 * potentials far away. On a periodic map the potentials are the means over each surface. If one axis repeats,
 * they are those at the distance `datum` in either body. Only the contact conducts, and it has no film. */
struct rc_conductance {
    /* N/m: S; equals rc_solver_stiffness if no node is at the hardness */
    double stiffness;
    /* W/K with k1, k2 in W/(m K); S with S/m */
    double value;
    /* lower bound for these nodes; its difference from `value` shows the accuracy */
    double lower;
};
/* Call it at the solution, after rc_solver_result. NAN for layered bodies, to which the analogy does
 * not apply, and where rc_solver_stiffness would be NAN for its nodes. Takes 10 to 20 convolutions;
 * RC_FAIL when a conductivity is not positive and finite, and when memory is short. */
RC_API enum rc_status rc_solver_conductance(struct rc_solver *solver, double k1, double k2,
                                            struct rc_conductance *conductance, struct rc_err *err);
/* Names of engine and method, and the reason for the engine. */
RC_API const char *rc_solver_engine(const struct rc_solver *solver);
RC_API const char *rc_solver_engine_reason(const struct rc_solver *solver);
RC_API const char *rc_solver_method(const struct rc_solver *solver);
RC_API void rc_solver_free(struct rc_solver *solver);

/* ---- elastic contact as a model ---- */

/* Optional figures, which cost convolutions. */
struct rc_elastic_asks {
    bool stiffness;
    /* conductivities of the bodies, as for rc_solver_conductance; both 0: no conductance */
    double conductivity[2];
};
struct rc_elastic_figures {
    struct rc_contact contact;
    /* NAN: not requested */
    double stiffness, conductance, conductance_lower;
    /* m, both from the first touch of the first shape: the approach now, and the approach at
     * which the present shape first touches, after a keep */
    double indentation, residual_indentation;
    /* rad; NAN: no free tilt */
    double tilt_x, tilt_y;
    /* NULL: no load so far */
    const char *kernel, *method;
};
/* A model (model.h) of elastic bodies, with or without a hardness. It takes a load or an approach; load 0:
 * the bodies are separated. Keeping a point adds its plastic dents to the shape. Frame: plastic, the
 * heights after unloading (m). The load and approach of the problem are ignored. asks NULL: no optional
 * figures. */
RC_API struct rc_model *rc_elastic_new(const struct rc_shape *shape, const double *h,
                                       const struct rc_problem *problem,
                                       const struct rc_elastic_asks *asks, struct rc_err *err);
/* The figures, after rc_model_look, of an elastic model or of a model with an elastic inner model; NULL for
 * other models. */
RC_API const struct rc_elastic_figures *rc_elastic_result(const struct rc_model *model);

/* ---- yield: plasticity in the volume ---- */

/* Von Mises plasticity with isotropic hardening. The yield stress grows with the equivalent plastic strain
 * linearly, or by a table of points. */
struct rc_yield_law {
    /* Pa, > 0: initial yield stress */
    double stress;
    /* Pa, >= 0: slope over the equivalent plastic strain */
    double modulus;
    /* points of the table; 0: linear law */
    size_t points;
    /* strains from 0, increasing; stresses in Pa, not decreasing. Extrapolated beyond the last
     * point */
    const double *strain_at, *stress_at;
};

/* Yield stress at this equivalent plastic strain, Pa. */
RC_API double rc_yield_law_stress(const struct rc_yield_law *law, double strain);

struct rc_yield_problem {
    /* pair.one is the body that yields, with e and nu; no hardness; load and approach are
     * ignored */
    struct rc_problem contact;
    struct rc_yield_law law;
    /* slabs that may yield, from the surface down; 0: chosen */
    size_t slabs;
    /* m, of each; NULL: chosen */
    const double *thickness;
    /* increments of each load; 0: chosen */
    size_t increments;
    /* a second run with half the increments estimates their error */
    bool companion;
    /* tolerance of the stress: its lag behind the yield condition (RMS) over the yield stress;
     * 0: chosen */
    double lag;
    /* strains and stresses in double precision, and on all nodes in deep slabs too: up to 8 times the
     * memory */
    bool precise;
};

/* Results of one load; lengths in m. */
struct rc_yield_load {
    /* increments of this load: 1 without or almost without further yield */
    size_t increments;
    /* applications of the volume operator, in all runs of this load */
    size_t applications;
    /* voxels (a node and a slab) that have yielded */
    size_t voxels;
    /* bottom of the deepest yielded voxel; m^3 */
    double depth, volume;
    /* largest equivalent plastic strain */
    double max_strain;
    /* J, plastic work of all loads so far */
    double work;
    /* Pa: largest mean over 2 x 2 nodes, because without hardening the pressure alternates from
     * node to node */
    double max_pressure_mean4;
    /* the lag that was reached */
    double lag;
    /* Estimated relative L1 error of the pressure, the sum of its parts; of the parts from increments
     * and slabs the squares are added. The parts are: from the increments of this load (NAN for fewer
     * than 8); from the increments of earlier loads (NAN where one had fewer). Then: from the
     * iteration; from the tolerance of the contacts; from the images of a free map. */
    double error, increment_error, inherited_error;
    double iteration_error, contact_error, image_error;
    /* from the thickness of the slabs (NAN for fewer than 8 increments, or if fewer than 6 of the
     * given slabs yield) */
    double slab_error;
    /* m^3: the integral of the equivalent strain over the volume */
    double strained;
    /* m: the longest row of voxels along x that flow in the last increment */
    double flow_length;
};

enum {
    RC_PEEQ = 5, /* equivalent plastic strain, after exx eyy exy exz eyz; ezz = -exx - eyy */
    RC_YIELD_STRAINS
};

enum {
    RC_YIELD_INCREMENTS = 512 /* most increments of a load */
};
struct rc_yield_figures {
    struct rc_contact contact;
    /* all 0: no voxel has yielded */
    struct rc_yield_load last;
    /* true: the body has yielded; false: the solution is elastic */
    bool yielded;
    /* slabs in use; 0: no voxel has yielded */
    size_t slabs;
    /* m, of each */
    const double *thickness;
    /* reached, and of the load, as tried */
    size_t increment, increments;
    /* elastic contact: largest Mises stress over the yield stress, and its depth in m; NAN:
     * unknown */
    double max_mises_over_yield, max_mises_depth;
    /* as in rc_elastic_figures */
    double indentation, residual_indentation;
};
/* A model (model.h) of a body that may yield, along a history of loads; its heights cannot change. As long
 * as no stress reaches the yield stress, the elastic contact is the solution. In the problem, thickness
 * NULL lets this function choose so many slabs. 0: as many as needed, from half the spacing at the
 * surface, each a quarter thicker than the last. increments 0: it chooses their number for each load, so
 * that the estimated error is at most contact.tol (0: 1e-2). lag 0: it chooses a value that suits this.
 * Frames: residual, the residual displacement (m), and plastic, as for elastic bodies. NULL when the
 * problem is invalid, or memory is short. */
RC_API struct rc_model *rc_yield_new(const struct rc_shape *shape, const double *h,
                                     const struct rc_yield_problem *problem, struct rc_err *err);
/* Announces this number of loads, N the largest: slabs are chosen for the largest, and increments also for
 * the loads that inherit their error. Optional. */
RC_API void rc_yield_plan(struct rc_model *model, size_t loads, double largest);
/* The figures after a look. NULL: neither the model nor its inner model yields. */
RC_API const struct rc_yield_figures *rc_yield_result(const struct rc_model *model);
/* Plastic strain of a slab, nx ny each; NULL: not needed. False: no voxel has yielded, or the slab does not
 * exist. */
RC_API bool rc_yield_strain(const struct rc_model *model, size_t slab,
                            double *const e[RC_YIELD_STRAINS]);

/* ---- adhesion as a model ---- */

struct rc_adhesion_law_info {
    const char *name, *summary;
    bool ranged; /* true: the caller may choose its range; false: the grid determines it */
};
/* Row k = 0, 1, ... of the table of laws; NULL past the last. */
RC_API const struct rc_adhesion_law_info *rc_adhesion_law_info(size_t k);

/* Bodies that attract each other: a traction sigma(g) >= 0 pulls where the gap is g >= 0. */
struct rc_adhesion_problem {
    /* Used: bodies, boundary, hardness (of p + sigma), tol (at most 1e-3), max_iterations and
     * threads. Ignored: load and approach. engine, method: NULL or "auto", or an engine with
     * transforms */
    struct rc_problem contact;
    /* J/m^2, > 0: work to separate a unit area, the integral of sigma */
    double work;
    /* a row of the table; NULL: the first */
    const char *law;
    /* m: exponential, the length over which sigma decreases to 1/e; dugdale, work/sigma(0);
     * compact, where sigma ends. 0: a cohesive length of two nodes */
    double range;
    /* A retraction may begin where the bodies last moved apart: the model keeps that state, a map */
    bool pull_off;
};

/* The law on this grid. */
struct rc_adhesion_scales {
    const char *law;
    /* m */
    double range;
    /* Pa: sigma(0) */
    double strength;
    /* Pa/m: the largest -sigma' */
    double steepest;
    /* m: E* (for waves of two nodes) / `steepest` */
    double cohesive_length;
    /* cohesive_length over the larger of dx, dy: below 1.5 the grid itself causes hysteresis */
    double cohesive_nodes;
};
/* RC_FAIL, and *err says why, when rc_adhesion_new would refuse the problem, except for short memory. */
RC_API enum rc_status rc_adhesion_check(const struct rc_shape *shape,
                                        const struct rc_adhesion_problem *problem,
                                        struct rc_adhesion_scales *scales, struct rc_err *err);

/* The current state of the path. Loads are positive when the bodies are pressed together; all pressures but
 * `repulsive_load` are net, p of the contact less sigma. NAN: unknown. */
struct rc_adhesion_state {
    /* N, Pa */
    double load, mean_pressure;
    /* m: 0 at first touch of the undeformed bodies, negative apart */
    double approach;
    /* m, over the map */
    double mean_gap;
    /* N, both positive: sums of sigma and of p + sigma */
    double attractive_load, repulsive_load;
    /* m^2: where sigma > sigma(0)/100 */
    double attractive_area;
    /* nodes with gap 0, or negative at the hardness */
    size_t contact_nodes;
    /* m^2, - */
    double contact_area, contact_fraction;
    /* nodes with a negative gap: p + sigma = hardness */
    size_t plastic_nodes;
    /* m^2 */
    double plastic_area;
    /* Pa */
    double max_pressure, min_pressure;
    /* largest sigma over sigma(0) at the edge of a free map; else 0 */
    double edge_traction;
    /* The smallest eigenvalue of A - D on the nodes off contact, A = 1/K and D = -sigma', in
     * units of A as the contact leaves it. Above 0 the state is stable under the control in use;
     * below 0 it is a saddle */
    double stability;
    /* stability > 0, to the accuracy of the iteration */
    bool stable;
    /* The bodies are apart, without force or pressure: no stable state carries this load, or they separated
     * earlier and the load is 0, where they stay apart (converged) */
    bool separated;
    /* they separated under an earlier load, and this one does not press them together */
    bool was_separated;
    /* Number of points between the last state and this one where the path of stable states
     * ended. Found by the curvatures during the iteration; several in a row may count as one */
    size_t jumps;
    /* The lowest load of a retraction, N, its approach, m, and the error of the load. This is
     * twice the misfit of a parabola through neighbouring states, or the error that a jump hides.
     * NAN where the load only rises: the retraction began beyond the lowest load */
    double pull_off_load, pull_off_approach, pull_off_spread;
    /* m: approach at which the retraction of the model began */
    double pull_off_from;
    /* the lowest load is at the first state of the retraction */
    bool pull_off_at_start;
    /* states of this retraction, otherwise 1 */
    size_t states;
    /* steps in the gap */
    size_t iterations;
    /* steps for the stability */
    size_t eigen_steps;
    /* equivalents of one in double precision on this grid, padded if free */
    double convolutions;
    /* m: the largest correction K r of the gap still to come */
    double gap_error;
    /* largest |p + sigma| off contact, or -(p + sigma) in contact, over sigma(0) */
    double kkt_residual;
    /* estimated relative L1 error of p; the part of it from the plastic dents of earlier states */
    double pressure_error;
    double inherited_error;
    /* pressure_error <= tol, and stable */
    bool converged;
};

/* Expected cost of a state of a path. Fails as rc_adhesion_check. */
RC_API enum rc_status rc_adhesion_expect(const struct rc_shape *shape,
                                         const struct rc_adhesion_problem *problem,
                                         struct rc_expected *expected, struct rc_err *err);
struct rc_adhesion_figures {
    struct rc_contact contact; /* the figures that all contacts have */
    struct rc_adhesion_state state;
};
/* The model (model.h) of such bodies. It takes a load or an approach; the approach -INFINITY, which is no
 * first point, retracts the bodies until they separate, and finds the lowest load on the way. If the last
 * point lies beyond that load, and the problem has `pull_off`, the retraction begins at the state from which
 * the bodies last moved apart. Under a tensile load the next stable state of lower energy is found, if there
 * is one: see `separated`. Keeping a point adds its plastic dents to the shape. Frames: adhesion, the
 * attraction (Pa), and plastic, as for elastic bodies. NULL when the problem is invalid, when the engine or
 * method does not suit it, or memory is short. */
RC_API struct rc_model *rc_adhesion_new(const struct rc_shape *shape, const double *h,
                                        const struct rc_adhesion_problem *problem,
                                        struct rc_err *err);
/* The figures after a look. NULL: neither the model nor its inner model has adhesion. */
RC_API const struct rc_adhesion_figures *rc_adhesion_result(const struct rc_model *model);

/* ---- friction as a model ---- */

/* Coulomb's law at each node, with history. A node sticks while its traction is below mu times its pressure,
 * or slips against the traction at this limit. Given are the pressure and the tangential motion, in
 * increments. Tractions act on body 1, and the force is their sum. Body 2 pulls body 1 along, and has
 * moved over it by the displacement (on a periodic map their mean planes). Slip is the motion of body 1 over
 * body 2, opposite to the traction. */
struct rc_friction_law {
    struct rc_boundary boundary;
    /* uniform bodies, those of the inner model */
    struct rc_pair pair;
    /* Poisson's ratio of both, if only E* of the pair is known */
    double nu;
    /* coefficient of friction, > 0 */
    double mu;
    /* Pa: upper bound of the traction (Tresca); 0 or INFINITY: none */
    double tau_max;
    /* for dissimilar bodies: pressure causes no tangential displacement */
    bool uncoupled;
    /* asked relative L1 error of the tractions; 0: 1e-4 */
    double tol;
    /* most steps of an increment; 0: 200 */
    size_t max_steps;
    /* 0: all */
    size_t threads;
    /* processes that share the map; the model of friction takes those of its inner model. NULL: one */
    const struct rc_ranks *ranks;
};

/* Figures of an increment. */
struct rc_friction_increment {
    /* N, normal */
    double load;
    /* N: largest force that friction can carry, at most mu times the load */
    double limit;
    /* N, along x and y */
    double force[2];
    /* m, of body 2 over body 1 since first touch */
    double displacement[2];
    /* numbers of nodes among those with a load */
    size_t stick_nodes, slip_nodes;
    /* m^2 */
    double stick_area, slip_area;
    /* share of the nodes that carry load; NAN: none */
    double stick_fraction;
    /* N/m: |force| over |displacement|; NAN where one is 0 */
    double stiffness;
    /* J, in this increment */
    double dissipated;
    /* m, in this increment alone */
    double largest_slip;
    /* m: largest slip where nodes stick, or across the traction */
    double slip_error;
    /* estimated relative L1 error of the tractions, of this increment alone */
    double traction_error;
    size_t steps;
    /* so far, of all solutions, in equivalents of a single map in double precision */
    double convolutions;
    /* traction_error <= tol */
    bool converged;
};

/* Coupling of pressure and tractions of dissimilar bodies. */
enum rc_coupling {
    /* both ways: solved alternately, pass by pass */
    RC_COUPLING_FULL,
    /* pressure causes tangential displacement, tractions do not change the pressure */
    RC_COUPLING_GOODMAN,
    /* neither way */
    RC_COUPLING_NONE
};

enum {
    RC_FEWER = 2 /* most solutions with fewer increments */
};
struct rc_friction_problem {
    /* `coupling` sets `uncoupled`; tol: the tolerance of an increment */
    struct rc_friction_law law;
    enum rc_coupling coupling;
    /* from point to point, in which all axes change in proportion; 0: chosen */
    size_t increments;
    /* passes of pressure and tractions in an increment; 0: 50 */
    size_t max_passes;
    /* A known contact: its load (N; 0: none), pressure (Pa) and gap (m; NULL: unknown), nx ny.
     * It is not solved where tractions do not change the pressure. */
    double known_load;
    const double *known_p, *known_gap;
    /* Further solutions with half of the increments (1) and a quarter (2), which tell the error
     * of the increments; 0: it is unknown. If tractions change the pressure, each needs a model
     * like the inner one, which the model of friction owns from then on. Otherwise NULL. */
    size_t fewer;
    struct rc_model *inner_of_fewer[RC_FEWER];
    /* the model has a frame `dissipation`, J/m2: its energy since the last kept point */
    bool dissipation;
};

struct rc_friction_figures {
    /* figures of the last increment; dissipated: since the last kept point */
    struct rc_friction_increment last;
    /* since the last point kept: pressures passed to friction */
    size_t passes;
    /* relative L1, of the last pass; 0: only one pass is needed */
    double pressure_change, traction_change;
    /* Estimated relative L1 errors of the tractions. First: of the last increment, with the
     * change by further passes. Then: of the iteration of earlier increments; of the contacts of
     * this and earlier increments; of too few increments (NAN: unknown) */
    double traction_error, inherited_error, contact_error, increment_error;
    /* m: largest length of the vector (slip-x, slip-y), the slip since the bodies touched */
    double largest_slip_total;
    /* m, as in rc_contact; NAN: unknown */
    double approach;
    /* convolutions of friction and contacts, since the last point kept */
    double convolutions;
    /* all contacts, tractions and passes since the last point kept */
    bool converged;
};

/* How the error of the increments to a point, and to earlier points, is known. */
enum rc_told {
    RC_TOLD_EXACT,  /* there is none */
    RC_TOLD_MANY,   /* the estimate is near the error */
    RC_TOLD_SOME,   /* a larger factor of safety */
    RC_TOLD_FEW,    /* the largest factor */
    RC_TOLD_UNKNOWN /* fewer than 4 increments */
};
/* The leg from one point to the next. */
struct rc_leg {
    size_t increments;
    enum rc_told told;
    bool carries; /* tractions, at its end */
    bool late;    /* one increment, or two with a large first one */
    bool falls;   /* the load falls */
};
/* The leg that the model takes from a point to the next; before: the leg to `from`. The first leg begins
 * with a point and a leg of zeros. */
RC_API struct rc_leg rc_friction_leg(const struct rc_friction_problem *problem,
                                     const struct rc_leg *before, const struct rc_point *from,
                                     const struct rc_point *to);
/* A model (model.h) of friction over an inner one of the same bodies and boundary. In addition to the axes
 * of the inner model it takes two forces or two displacements along the surface; the first point has both.
 * h: the undeformed heights. NULL: they are unknown, and only the known contact is possible. Where
 * dissimilar bodies are coupled the inner model must allow other heights. Frames: pressure, traction-x,
 * traction-y (Pa), slip-x, slip-y (m, since first touch), state (0: the node carries no load, 1: it
 * sticks, 2: it slips). RC_FAIL during a path when friction cannot carry the force. */
RC_API struct rc_model *rc_friction_new(struct rc_model *inner, const double *h,
                                        const struct rc_friction_problem *problem,
                                        struct rc_err *err);
/* The figures of this model, after rc_model_look; NULL: it has no friction. */
RC_API const struct rc_friction_figures *rc_friction_result(const struct rc_model *model);

/* ---- rolling as a model ---- */

/* A contact that is not solved, in a map with its middle at x, m, where RC_POSITION is counted. */
struct rc_rolling_contact {
    const double *p; /* pressure, nx ny Pa */
    double x;
};
/* The contact rolls towards +x. Body 2 moves over body 1 by (creep_x - spin y, creep_y + spin x) per
 * length rolled, with x and y from the middle of the contact. The middle is at RC_POSITION (0 if it is
 * never given), in the middle row; on a periodic map that of the nearest period. This is minus the
 * creepage of railway textbooks, where body 1 moves over body 2. In a steady state, tractions and slip
 * at each place of the contact do not change with time. On a path, the bodies are pressed together at
 * the first point, and each further point is a step of rolling from the last point kept. */
struct rc_rolling_problem {
    /* Friction and bodies. A steady state needs the free boundary. Pressure moves dissimilar
     * bodies along each other, unless `uncoupled`; tractions do not change the pressure. tol 0
     * is 1e-3, on a path 1e-2. max_steps holds for each grid. */
    struct rc_friction_law law;
    /* points give RC_TANGENTIAL_X, RC_TANGENTIAL_Y, and RC_CREEP_X, RC_CREEP_Y are found */
    bool force;
    /* each point is a step; else a steady state, whatever comes before */
    bool path;
    /* NULL: the inner model solves the contact. The caller may change it from point to point. On
     * a path the map moves by whole columns. */
    const struct rc_rolling_contact *known;
};
struct rc_rolling_figures {
    /* N: normal; the largest that friction can carry */
    double load, limit;
    /* creepage per length rolled, and spin in rad/m. NAN: not yet */
    double creep[2], spin;
    /* N, on body 1; N m, about the middle of the contact, NAN where a contact on a periodic map
     * reaches half a period from there */
    double force[2], moment;
    /* numbers of the nodes that carry load */
    size_t stick_nodes, slip_nodes;
    /* share of the nodes that carry load */
    double stick_fraction;
    /* J/m: force times creepage, moment times spin */
    double power;
    /* J/m: friction energy, the sum of the frame `dissipation`: the mean traction of a step
     * times its slip. It is `power` in a steady state of similar bodies; on a path elastic
     * energy is the difference. */
    double power_slip;
    /* Extrapolated from the two finest grids to a spacing of 0; NAN: too few nodes along x, or a
     * path. */
    double extrapolated_creep[2];
    double extrapolated_force[2], extrapolated_moment;
    /* m: semi-axes, along x and y, of the ellipse of the same area and ratio of second moments */
    double ellipse[2];
    /* C11, C22, C23 of this ellipse in Kalker's linear theory, and its force, N; NAN: its semi-axes
     * have a ratio beyond 0.1 to 10 */
    double kalker[3], kalker_force[2];
    /* N: of Kalker's simplified theory (FASTSIM, 1982) for this ellipse; NAN as before */
    double fastsim_force[2];
    /* Estimated relative errors. First: L1 error of the tractions on this grid. Second: error of
     * the force due to the spacing, or of the creepage if the force is given (NAN: unknown). */
    double traction_error, discretization_error;
    /* steps of Newton's method; steps in time, where it fails */
    size_t steps, fallbacks;
    /* with those of the contact */
    double convolutions;
    /* traction_error <= tol */
    bool converged;
};
/* A model (model.h) of rolling over an inner model of the same bodies and boundary. Beside the axes of the
 * inner model it takes RC_CREEP_X and RC_CREEP_Y, or two forces, and RC_SPIN and RC_POSITION. The position
 * may not fall on a path. Frames: pressure, traction-x, traction-y (Pa), slip-x, slip-y (per length
 * rolled), state (as for friction), dissipation (J/m3: energy per area and length rolled), slip (per
 * length rolled: dissipation over the largest traction). RC_FAIL during a path if no node is in contact,
 * friction cannot carry the force, or a contact with spin reaches half a period from its middle. RC_FAIL
 * too if the contact reaches the last column (the leading edge), or a column that comes in. Sources:
 * Kalker 1990, Three-dimensional elastic bodies in rolling contact; Newton's method as in
 * libcontact/rolling/steady.c. */
RC_API struct rc_model *rc_rolling_new(struct rc_model *inner,
                                       const struct rc_rolling_problem *problem,
                                       struct rc_err *err);
/* The figures of this model, after rc_model_look; NULL: it does not roll. */
RC_API const struct rc_rolling_figures *rc_rolling_result(const struct rc_model *model);

/* ---- wear as a model ---- */

struct rc_wear_problem {
    /* 1/Pa: depth that bodies 1 and 2 lose per pressure and sliding distance, both >= 0 */
    double k[2];
    /* Pa, > 0, of the bodies: for the first step and the forecast */
    double estar;
    /* bound of the estimated relative error of the worn depth; 0: 0.1 */
    double tol;
    /* nx ny numbers from 0 to 1, by which k is multiplied at each node, the largest 1; NULL: 1
     * everywhere. */
    const double *part;
    /* m: body 1 stays in contact and body 2 passes it along x, on a track of this length. It
     * wears each point of the track once per this distance; 0: the same points of both bodies
     * stay in contact */
    double track;
    /* Two rough bodies slide over each other along x, on a map that repeats: h gives the heights
     * of body 1, and h2 those of body 2, nx ny m, face to face (NULL: body 2 is smooth). Each
     * wears by the mean pressure of all alignments. */
    bool two_bodies;
    const double *h2;
    /* nx ny J/m2: a friction energy at each node per unit of the distance, which then is a
     * number of cycles. A node loses k times this energy, whatever its pressure is; NULL: k p
     * per sliding distance. There is no part, track, two_bodies or condition beside it. */
    const double *energy;
    /* A leg ends early when one of these three is reached (0: no such condition). First: contact
     * fraction */
    double until_area;
    /* m: largest worn depth */
    double until_depth;
    /* spread of the pressure, from above */
    double until_spread;
};
struct rc_wear_figures {
    /* m; NAN with an energy */
    double distance;
    /* m3, of both bodies and of each */
    double wear_volume, wear_volume_1, wear_volume_2;
    /* m, of both bodies together */
    double max_wear_depth, mean_wear_depth;
    /* standard deviation in contact over the mean */
    double pressure_spread;
    size_t steps, rejected, contacts;
    double convolutions;
    /* Estimated: L1 norm of the error of the worn depth over the worn volume; relative L1 error
     * of the pressure; relative error of the largest pressure, NAN between two points of the history.
     * On worn surfaces the true errors are usually 10 to 30 times smaller. */
    double wear_error, pressure_error, max_pressure_error;
    /* the first two are at most tol */
    bool converged;
};
/* A model (model.h) of bodies that wear at every node by k p per sliding distance. The inner model must
 * allow other heights and a compliance. In addition to the load it takes the distance. h: the heights at
 * the start. Its frame `height` is the worn height, `wear` the depth that both bodies have lost. If two
 * bodies slide over each other, the frames show the alignment of the start, and only the error of the worn
 * depth decides whether a point has converged. Source: Archard 1953 (J. Appl. Phys. 24, 981); steps as in
 * libcontact/wear. */
RC_API struct rc_model *rc_wear_new(struct rc_model *inner, const double *h,
                                    const struct rc_wear_problem *problem, struct rc_err *err);
/* The figures of this model, after rc_model_look; NULL: it does not wear. */
RC_API const struct rc_wear_figures *rc_wear_result(const struct rc_model *model);

/* ---- travel as a model ---- */

/* Heights in m. */
struct rc_travel_problem {
    /* map of body 1, with the spacings of the inner model */
    struct rc_shape track;
    const double *h1;
    /* the map of body 1 is periodic along x */
    bool repeats;
    /* map of body 2, with the same rows as body 1 */
    struct rc_shape counter;
    /* NULL: smooth */
    const double *h2;
    bool counter_repeats;
    /* travel of the heights of body 2 per travel of the contact; 0: it rolls */
    double ratio;
    /* m, of the ball that travels; 0: none */
    double radius;
    /* the ball is a cylinder instead, along y */
    bool cylinder;
};
struct rc_travel_figures {
    /* m: x of the middle of the contact on the map of body 1, from the middle of that map */
    double position;
    /* m: height of body 2, the highest node less the approach, in a datum that stays with body 1 */
    double height;
    /* m: x of the middle of the window on that map; 0 for the whole map */
    double window_x;
};
/* A model (model.h) of a contact that travels along x over body 1. The inner model must allow other
 * heights. In addition to the load it takes the position. The inner model has the map of body 1, or a
 * window with fewer columns or rows, which moves with the contact by whole nodes. The numbers of rows of
 * both maps and of the window are all even or all odd, so that their middle rows agree. In a window each
 * position is a first contact; on the whole map the inner model keeps its history. The frame `height`
 * holds the heights of both bodies at the position. The heights of body 2 between nodes are interpolated
 * by cubic polynomials. RC_FAIL when the window leaves the map of a body. */
RC_API struct rc_model *rc_travel_new(struct rc_model *inner,
                                      const struct rc_travel_problem *problem, struct rc_err *err);
/* The figures of this model, after rc_model_look; NULL: it does not travel. */
RC_API const struct rc_travel_figures *rc_travel_result(const struct rc_model *model);

/* ---- viscoelastic materials ---- */

/* A relaxation modulus, which is a Prony series, and the creep compliance of the same material:
 *
 *     E(t) = relaxed + sum over k of modulus[k] exp(-t/time[k])
 *     J(t) = instant + sum over j of compliance[j] (1 - exp(-t/retardation[j]))
 *            + fluidity t
 *
 * A strain of 1 from t = 0 on needs the stress E(t); a stress of 1 from t = 0 on causes the strain J(t). Any
 * modulus has such a compliance, with a factor that is constant in time: for a contact, E/(1 - nu^2). */
struct rc_relaxation {
    double relaxed;                   /* Pa */
    size_t terms;                     /* terms with a modulus of 0 are left out */
    double *modulus, *time;           /* Pa, s; the times rise */
    double instant, fluidity;         /* 1/Pa, 1/(Pa s); fluidity > 0 if relaxed = 0 */
    size_t creep_terms;               /* terms, or terms - 1 with a fluidity */
    double *compliance, *retardation; /* 1/Pa, s; the times rise */
};
/* From `terms` moduli (Pa, >= 0) and relaxation times (s, > 0, all different), in any order, and the relaxed
 * modulus (Pa, >= 0; 0: a fluid). The compliance is exact to rounding, also over 20 decades (Gross 1953,
 * Mathematical structure of the theories of viscoelasticity). NULL when a number is out of range, when all
 * moduli are 0, or when memory is short. */
RC_API struct rc_relaxation *rc_relaxation_new(double relaxed, size_t terms, const double *modulus,
                                               const double *time, struct rc_err *err);
/* Fits a master curve: storage and loss moduli (Pa, > 0) at n >= 4 different angular frequencies (rad/s,
 * above 0). The relaxation times are even in the logarithm, from the inverse of the highest frequency to that
 * of the lowest one: `per_decade` in a decade (0: 1.5, or 8 if these give a clearly better fit). The moduli,
 * >= 0, give the least sum of squares of the relative errors (Lawson and Hanson 1974). *misfit: the RMS of
 * these errors; above 0.05 the two columns contradict each other. NULL: out of range, or out of memory. */
RC_API struct rc_relaxation *rc_relaxation_fit(size_t n, const double *omega, const double *storage,
                                               const double *loss, double per_decade,
                                               double *misfit, struct rc_err *err);
/* Fits a measured relaxation: moduli (Pa, > 0) at n >= 4 different times (s, >= 0) after a step of strain.
 * Moduli and misfit are as for rc_relaxation_fit; the relaxation times, 4 a decade by default, go from the
 * shortest time above 0 to the longest one.
 * `relaxed` is the relaxed modulus (Pa, >= 0); NAN: it is fitted, which needs times at which E(t) is level.
 * NULL when a number is out of range or memory is short. */
RC_API struct rc_relaxation *rc_relaxation_fit_time(size_t n, const double *time,
                                                    const double *modulus, double relaxed,
                                                    double per_decade, double *misfit,
                                                    struct rc_err *err);
/* E(t), Pa. */
RC_API double rc_relaxation_modulus(const struct rc_relaxation *r, double t);
/* J(t), 1/Pa. */
RC_API double rc_relaxation_compliance(const struct rc_relaxation *r, double t);
/* The complex modulus E(i omega), Pa, and the complex compliance J(i omega) = 1/E(i omega), 1/Pa: real and
 * imaginary parts, for exp(i omega t) with omega > 0, rad/s. */
RC_API void rc_relaxation_dynamic(const struct rc_relaxation *r, double omega, double modulus[2],
                                  double compliance[2]);
RC_API void rc_relaxation_free(struct rc_relaxation *r);

/* ---- viscoelastic bodies as a model ---- */

struct rc_viscoelastic_problem {
    /* of the body that relaxes */
    const struct rc_relaxation *material;
    /* part of this body in the compliance 1/E* of both bodies at once, from above 0 to 1; the
     * other body is elastic, or rigid: 1 */
    double share;
    /* s: shortest time between two points, and time of the last one, for which terms of the
     * material are left out; 0: all terms are kept */
    double shortest, longest;
    /* of the history, for the expected cost; 0: 1 */
    size_t points;
    /* steps from point to point, at least 2; 0: chosen, 20 to 320; see below */
    size_t increments;
    /* of the errors of the increments and of earlier contacts, relative L1 of the pressure; 0: 0.01 */
    double tol;
};
struct rc_viscoelastic_figures {
    /* pressure_error holds all errors; inherited_error: the part from the contacts before this point, which
     * grows as the load falls; elastic_energy NAN */
    struct rc_contact contact;
    /* s */
    double time;
    /* steps from the previous point */
    size_t increments;
    /* relative L1 error of the pressure due to the steps, from runs with half and a quarter as many */
    double increment_error;
    /* N: load with the same contact on bodies that keep their instantaneous moduli, as long as
     * this load has only risen: the integral of J(t - s)/J(0) dP(s) */
    double equivalent_load;
    /* m: approach; approach at first touch right after the load is removed */
    double indentation, residual_indentation;
};
/* A model (model.h) of viscoelastic bodies in time. The inner model must be elastic, without a hardness,
 * with the instantaneous moduli of the bodies. Poisson's ratio is constant in time, and all of the
 * viscoelastic body relaxes alike. h: the heights of the inner model. Points need the time beside the load
 * or the approach. The load acts suddenly at the first point, and then changes in proportion to the time;
 * two points at the same time are a jump. A load of 0 separates the bodies. After a corner of the load the
 * first step is the shortest time of the material over the increments. Steps then grow with the time since
 * the corner, 1.2 times the increments in a decade. The longest one is the time between the points over
 * the increments. */
RC_API struct rc_model *rc_viscoelastic_new(struct rc_model *inner, const double *h,
                                            const struct rc_viscoelastic_problem *problem,
                                            struct rc_err *err);
/* The figures of this model, after rc_model_look; NULL: it is not viscoelastic. */
RC_API const struct rc_viscoelastic_figures *rc_viscoelastic_result(const struct rc_model *model);

/* ---- steady sliding over a viscoelastic body as a model ---- */

struct rc_sliding_problem {
    /* E/(1 - nu^2) of body 1 */
    const struct rc_relaxation *material;
    /* 1/Pa, (1 - nu^2)/E of body 2, which is elastic; 0: it is rigid */
    double compliance;
    /* body 2 slides along +y; false: along +x */
    bool along_y;
    /* it meets its own grooves after one period of the map; false: a fresh track */
    bool repeats;
};
struct rc_sliding_figures {
    /* m/s */
    double speed;
    /* Coefficient of friction and force (N) against the motion, by the losses in the material:
     * the integral of -p du/dx. */
    double friction, friction_force;
    /* The coefficient by the integral of -p dh/dx. Both are equal on a fine grid. */
    double friction_by_heights;
    /* Bound of the relative error of `friction` that the error of the pressure causes; it does not
     * include the error of the grid. NAN: no friction. */
    double friction_error;
    /* W, the losses of all waves: friction_force |speed| */
    double dissipated_power;
    /* largest ratio of loss and storage of the waves along the motion */
    double tan_delta_max;
    /* "fresh" or "repeated" */
    const char *track;
    /* elastic contacts of the iteration, and steps in all of them */
    size_t contacts, iterations;
    /* equivalents */
    double convolutions;
    /* m, from first touch */
    double approach;
    /* estimated, relative L1 */
    double pressure_error;
    /* NAN: not defined here */
    double elastic_energy;
    bool converged;
};
/* A model (model.h) of the steady state in which body 2, which has the heights h, slides at a speed over
 * the smooth viscoelastic body 1. It takes the load or the approach, and the speed, which may be negative.
 * The bodies of `problem` are not used. NULL when a number is out of range, memory is short, or the
 * material flows without end. A point fails if tan delta exceeds 3 among the waves of the map. The
 * material keeps J(-i qx v) (Persson 2001, J. Chem. Phys. 115, 3840; Carbone and Putignano 2013, J. Mech.
 * Phys. Solids 61, 1822); the iteration is described in libcontact/viscoelastic/sliding.c. */
RC_API struct rc_model *rc_sliding_new(const struct rc_shape *shape, const double *h,
                                       const struct rc_problem *problem,
                                       const struct rc_sliding_problem *law, struct rc_err *err);
/* The figures of this model, after rc_model_look; NULL: it does not slide. */
RC_API const struct rc_sliding_figures *rc_sliding_result(const struct rc_model *model);

/* ---- leakage ---- */

struct rc_leak_options {
    /* 'x': from the first column to the last; 'y': from the first row to the last; 0: 'x' */
    char direction;
    /* true: the sides along the flow join, as on a periodic map; false: they are walls */
    bool around;
    /* 0: all */
    size_t threads;
};

/* Flow through the gap between two edges of the map under a pressure difference of 1, by Reynolds'
 * equation, div(g^3 grad P) = 0. With a viscosity eta and a difference dp the rate is
 * conductance dp/(12 eta). */
struct rc_leak_figures {
    /* m^3; exactly 0 if no path percolates */
    double conductance;
    /* the same with a gap that varies linearly between nodes; its error has the opposite sign */
    double conductance_linear;
    /* half their difference over the first: estimated relative discretization error; NAN: no
     * flow */
    double error;
    /* m^3, rigorous bounds of `conductance` on this grid, to rounding */
    double lower, upper;
    /* factor of Patir and Cheng: conductance relative to two flats at the mean gap */
    double flow_factor;
    /* factors of Patir and Cheng for sliding along the flow, the rough body at rest: the flow
     * per width without a pressure difference is U/2 (mean_gap + gap_rms shear_flow_factor);
     * NAN: an even gap */
    double shear_flow_factor;
    /* of the pressure term of the shear stress: the flow due to this term, over U/2 mean_gap */
    double shear_stress_factor;
    /* m: over all nodes, 0 in contact */
    double mean_gap;
    /* m: RMS deviation from mean_gap over all nodes */
    double gap_rms;
    /* RMS of the gap's gradient where fluid flows; NAN: nowhere */
    double slope;
    /* through the edges of cells */
    bool percolates;
    /* through their corners too */
    bool percolates_diagonal;
    /* m: critical constriction, the smallest gap of the widest path; 0: no path */
    double critical_gap;
    /* m: its position; NAN: nowhere */
    double critical_x, critical_y;
    /* fluid nodes across it: below 3 the grid does not resolve it */
    size_t throat_nodes;
    /* dead: fluid at rest */
    size_t fluid_nodes, dead_nodes;
    /* nodes with flowing fluid */
    size_t unknowns;
};

/* Fluid is where the bodies are not in contact and the gap g (m) is positive; gaps below 1e-30 of the largest
 * count as closed. rc_in_contact decides from p, a pressure or a map of 1 and 0; p NULL: no contact. Finds
 * the percolating path. NULL when a value is not finite, the map has 2^31 nodes, or memory is short. */
RC_API struct rc_leak *rc_leak_new(const struct rc_shape *shape, const double *p, const double *g,
                                   const struct rc_leak_options *options, struct rc_err *err);
/* Seconds and bytes of such a flow through so many nodes with fluid. */
RC_API struct rc_expected rc_leak_expect(size_t fluid, size_t threads);
/* Sets another contact and gap of the same map, with the same options and memory. It works as rc_leak_new,
 * but a value that is not finite leaves everything unchanged. After RC_FAIL due to short memory the object
 * can only be freed. */
RC_API enum rc_status rc_leak_set_gap(struct rc_leak *leak, const double *p, const double *g,
                                      struct rc_err *err);
/* RC_MORE until the flow is known, then RC_OK: two steps. RC_FAIL when memory is short, before the
 * elimination of the first step. */
RC_API enum rc_status rc_leak_step(struct rc_leak *leak, struct rc_err *err);
/* Percolation is known at once, conductances after the last step. */
RC_API const struct rc_leak_figures *rc_leak_result(const struct rc_leak *leak);
/* Maps of nx ny values after the last step. Fluid pressure: 1 at the inlet, 0 at the outlet; NAN in contact,
 * and in enclosed fluid. */
RC_API void rc_leak_pressure(const struct rc_leak *leak, double *pressure);
/* Magnitude of the flow per width for a pressure difference of 1 and 12 eta = 1, m^2. It is exactly 0 where
 * fluid is at rest, and NAN in contact. */
RC_API void rc_leak_flux(const struct rc_leak *leak, double *flux);
/* 0 in contact, 1 where fluid is at rest (dead ends, enclosed), 2 where it flows. */
RC_API void rc_leak_channel(const struct rc_leak *leak, double *channel);
RC_API void rc_leak_free(struct rc_leak *leak);

/* ---- heat ---- */

/* The material of a body, which moves past the contact. */
struct rc_heat_body {
    double conductivity; /* W/(m K), > 0 */
    double diffusivity;  /* m2/s, > 0 */
    double velocity[2];  /* m/s along x and y; the contact stands still */
    double bulk;         /* K: temperature far below the contact */
};
/* How the bodies share the heat. */
enum rc_heat_partition {
    RC_HEAT_MATCHED, /* equal temperatures at every node in contact */
    RC_HEAT_BLOK,    /* one number, for equal largest temperatures (Blok 1937) */
    RC_HEAT_CHARRON, /* one number, k1/(k1 + k2): exact without motion (Charron 1943) */
    RC_HEAT_SHARE    /* one given number */
};
struct rc_heat_problem {
    struct rc_boundary boundary;
    struct rc_heat_body body[2];
    /* s since heating began; 0: the steady state */
    double time;
    /* The heat into each body is constant in the first of so many equal steps of the time, and linear
     * in later ones. Memory and work grow. 0: as many as `tol` needs: runs with 1, 2, 4 ... steps,
     * at most 64, whose results are extrapolated. Only RC_HEAT_MATCHED takes steps. */
    size_t time_steps;
    enum rc_heat_partition partition;
    /* of body 1, for RC_HEAT_SHARE */
    double share;
    /* of the mismatch, and with time_steps = 0 of time_error; 0: 1e-3 */
    double tol;
    /* 0: all */
    size_t threads;
    /* processes that share the map; maps are then the rows held here. NULL: none */
    const struct rc_ranks *ranks;
};
/* The Peclet number of a body is V a/(2 kap). a is the radius of a circle of the area of the largest
 * patch; of a patch that goes around a map that repeats along one axis, half its mean width; for a cell the
 * side of the cell along the motion. */
struct rc_heat_figures {
    /* W: of the contact, into body 1 */
    double heat_power, heat_power_1;
    /* Of body 1. NAN: no heat; share_1 also where bulk temperatures drive more heat from body to
     * body than the contact has. */
    double share_1, share_blok, share_charron;
    double peclet_1, peclet_2, cell_peclet_1, cell_peclet_2;
    /* K above the bulk of body 1 */
    double max_temperature;
    /* its place, m */
    double max_x, max_y;
    /* K above the bulk of body 1, in contact; of the hotter body */
    double mean_temperature;
    /* The largest difference of the temperatures in contact, over the largest rise of a body
     * above its bulk. */
    double mismatch;
    /* Estimated error of the temperatures in contact from the time steps, over the largest rise; NAN:
     * the caller gave the number of steps; 0: no steps. */
    double time_error;
    /* Number of contact nodes in a row, along the motion, through the hottest node. With few of
     * them and a cell_peclet above 1 the grid misses the temperature at the trailing edge. */
    size_t hot_nodes;
    /* s: contact area over the smaller diffusivity; where the largest patch goes around the map, the
     * square of the mean width of the contact over it */
    double steady_time;
    size_t iterations;
    double convolutions;
    /* mismatch and a known time_error <= tol; always true for one number */
    bool converged;
};
/* Expected cost of temperatures at so many depths below the surface. */
RC_API enum rc_status rc_heat_expect(const struct rc_shape *shape,
                                     const struct rc_heat_problem *problem, size_t depths,
                                     struct rc_expected *expected, struct rc_err *err);
/* Temperatures of the surfaces of two half-spaces due to the heat flux q of their contact, nx ny W/m2
 * (Jaeger 1942, J. Proc. R. Soc. N.S.W. 76, 203). They are exact at all speeds for a flux that is
 * constant in each cell along a free axis, and band-limited along an axis that repeats. rc_in_contact
 * finds the contact from `contact`, a pressure or a map of 1 and 0; with NULL, contact is where q is
 * not 0. Heat can flow from body to body only in contact. NULL when q is not finite, or is not 0 out of
 * contact; when no node is in contact; when there is no steady state (maps that repeat along both axes,
 * or along one where a body that takes heat does not move along the other); or when memory is short. */
RC_API struct rc_heat *rc_heat_new(const struct rc_shape *shape,
                                   const struct rc_heat_problem *problem, const double *q,
                                   const double *contact, struct rc_err *err);
/* One step, of 2 convolutions: RC_MORE; RC_OK when the temperatures match; RC_SHORT after 100 steps or
 * 64 time steps, or when rounding prevents this. RC_FAIL when memory is short. */
RC_API enum rc_status rc_heat_step(struct rc_heat *heat, struct rc_err *err);
/* The figures. Call this and the following functions after the last step. */
RC_API const struct rc_heat_figures *rc_heat_result(const struct rc_heat *heat);
/* Heat flux into body 0 or 1, nx ny W/m2. Where cold material enters the contact, it may be negative, or
 * larger than q. */
RC_API const double *rc_heat_flux(const struct rc_heat *heat, int body);
/* Temperature of body 0 or 1 at a depth in m: nx ny values, K above the bulk of body 1. RC_FAIL when the
 * depth is negative or memory is short. */
RC_API enum rc_status rc_heat_temperature(struct rc_heat *heat, int body, double depth, double *to,
                                          struct rc_err *err);
RC_API void rc_heat_free(struct rc_heat *heat);

/* ---- stress ---- */

enum rc_component {
    RC_SXX,
    RC_SYY,
    RC_SZZ,
    RC_SXY,
    RC_SXZ,
    RC_SYZ,
    RC_COMPONENTS,
    RC_MISES = RC_COMPONENTS, /* this and the following ones are derived from all six */
    RC_TRESCA,                /* s1 - s3 */
    RC_S1,                    /* principal stresses, s1 >= s2 >= s3 */
    RC_S2,
    RC_S3,
    RC_STRESSES
};
/* Names in that order: "sxx", ... */
RC_API extern const char *const rc_component_names[RC_STRESSES];

/* Plastic strain in slabs from the surface down. Each slab has five maps of nx ny values, exx eyy exy exz
 * eyz, with ezz = -exx - eyy. NULL: 0. */
struct rc_eigenstrain {
    size_t slabs;
    const double *thickness; /* m */
    const double *const *map;
};

struct rc_stress_options {
    struct rc_boundary boundary;
    /* body 1; the stresses in a uniform one do not depend on e. */
    struct rc_body body;
    /* the surface also carries the traction mu p along +x; 0 if there are maps of traction */
    double mu;
    /* bits of enum rc_component */
    unsigned wanted;
    /* 'x' or 'y': only the plane x = at, or y = at; 0: maps */
    char section;
    /* m, from the middle of the map, within it */
    double at;
    /* a row of engines.list, or NULL or "auto" */
    const char *engine;
    /* asked error of a component over the largest pressure or traction; 0: rounding */
    double tol;
    /* 0: all */
    size_t threads;
    /* All depths of the slices, m, to plan the memory of coarser grids; NULL: any depth. */
    const double *depth;
    size_t depths;
    /* processes that share the map; NULL: none */
    const struct rc_ranks *ranks;
    /* NULL, or strain whose stress is added. It costs five transforms per slab and one per depth
     * and component, and needs body.e of a uniform body. Interfaces belong to the lower slab.
     * Sections interpolate linearly. */
    const struct rc_eigenstrain *strain;
    /* Tractions on this body's surface along +x and +y, Pa, nx ny each, interpolated like p;
     * NULL: none. */
    const double *traction[2];
    /* Stress of each layer without load, Pa, tension positive, uniform and equal in all
     * directions along the layer. It is added to sxx and syy there before stresses are derived.
     * NULL: none. The half-space below is infinitely thick and balances its force without
     * stress. */
    const double *residual;
    /* Estimate the error by tol and by the errors of the loads, see rc_stress_counts. */
    bool estimate;
    /* Sum of |error| over sum of |value| of p, and of the maps of traction together. NAN: unknown, as are
     * then the estimates. */
    double pressure_error, traction_error;
};

/* Work counters; tests use them to check that only requested fields are computed. An error, for each of enum
 * rc_component, is the sum of |error| over the sum of |stress|, over all nodes and depths. error:
 * NAN without `estimate`, if an error of the loads is unknown, and for a section whose loads have errors. */
struct rc_stress_counts {
    size_t depths;
    size_t source_transforms;       /* transforms of the pressure and of maps of traction */
    size_t normal_kernels;          /* kernels evaluated at a depth, for the pressure */
    size_t shear_kernels;           /* the same for the traction, if any */
    size_t coefficients;            /* values of these kernels */
    size_t kernel_transforms;       /* two-dimensional, of a quarter */
    size_t field_transforms;        /* two-dimensional, from wave numbers to a map */
    size_t line_transforms;         /* one-dimensional, of kernels and sources of a section */
    size_t engine_sums;             /* convolutions by another engine */
    size_t coarse_depths;           /* depths computed on a coarser grid */
    size_t strain_transforms;       /* transforms of maps of plastic strain to wave numbers */
    size_t strain_field_transforms; /* transforms of its stresses back to maps */
    double error[RC_STRESSES];      /* estimated, by tol and the errors of the loads */
};

/* RC_FAIL, and *err says why, when rc_stress_new would refuse these options, except for short memory. */
RC_API enum rc_status rc_stress_check(const struct rc_shape *shape,
                                      const struct rc_stress_options *options, struct rc_err *err);
/* Nodes of the largest coarser grid for the depths, over the nodes of the map; 0: none. Such a grid
 * adds this fraction of the memory of the transforms. */
RC_API double rc_stress_coarser(const struct rc_shape *shape,
                                const struct rc_stress_options *options);
/* Suitable depths from 0 down for the stresses under this pressure, *n of them in an array that the
 * caller frees. They are close together near the surface, where short waves matter, and farther apart
 * below. They end at three contact radii (free), at six half-widths (one axis repeats), or where the
 * waves have decayed to 1 % (periodic). Their distance is a quarter of 1/q of the RMS wave, and in a
 * layer at most a quarter of its thickness. Each interface gets two depths, itself and one a millionth
 * deeper; none is in a rigid half-space. Among ranks (NULL: none) p is the rows held here. RC_FAIL, and
 * NULL for the depths, when memory is short. */
RC_API enum rc_status rc_stress_depths(const struct rc_ranks *ranks, const struct rc_shape *shape,
                                       const double *p, struct rc_boundary boundary,
                                       const struct rc_body *body, double **depths, size_t *n,
                                       struct rc_err *err);
/* Stresses under the pressure p (Pa) in a half-space. The pressure is constant in each cell along a
 * free axis, and band-limited along one that repeats. On a periodic map its mean gives szz = -p, sxz =
 * -mu p (with maps of traction minus their means) and sxx = syy = -(1 + 2 nu) p / 2 at every depth.
 * This is the limit for a loaded patch that grows without end. A layered body has sxx and syy of the
 * half-space below, whose strains along the surface the layers share. If only the axis along a section
 * repeats, stresses between two lines of nodes are interpolated. NULL when an option is out of range,
 * there is no such engine or none for the boundary or the section, or memory is short. */
RC_API struct rc_stress *rc_stress_new(const struct rc_shape *shape, const double *p,
                                       const struct rc_stress_options *options, struct rc_err *err);
/* Number of values of a component at one depth: nx ny for maps, nx for the section y = at, ny for x = at. */
RC_API size_t rc_stress_values(const struct rc_stress *stress);
/* The wanted components at the depth z >= 0 (m), Pa, tension positive: s[c] for each c of `wanted`; the
 * others stay unchanged. At an interface sxx, syy and sxy jump: it belongs to the material above it; depth*(1
 * + 1e-12) selects the material below. RC_FAIL also inside a rigid half-space. */
RC_API enum rc_status rc_stress_slice(struct rc_stress *stress, double depth,
                                      double *const s[RC_STRESSES], struct rc_err *err);
/* Other maps of pressure and, if the plan has them, of traction. Slices at the last depth then cost no
 * kernels. RC_FAIL for sections and for engines without transforms. */
RC_API enum rc_status rc_stress_set_loads(struct rc_stress *stress, const double *p,
                                          const double *const traction[2], struct rc_err *err);
/* Name of the engine, and the counters so far. */
RC_API const char *rc_stress_engine(const struct rc_stress *stress);
RC_API const struct rc_stress_counts *rc_stress_counted(const struct rc_stress *stress);
RC_API void rc_stress_free(struct rc_stress *stress);

/* ---- fatigue ---- */

/* Criteria of multiaxial high-cycle fatigue: an index of 1 is the endurance limit. Definitions, constants
 * and sources are in libcontact/fatigue/criteria.c and contact-theory(7). */
enum rc_criterion {
    RC_CROSSLAND,
    RC_DANG_VAN,
    RC_PAPADOPOULOS,
    RC_FINDLEY,
    /* above 1 the body never shakes down to elastic cycles; needs the yield stress */
    RC_SHAKEDOWN,
    RC_CRITERIA,
    /* sqrt(J2) of the amplitude of the deviator, Pa */
    RC_AMPLITUDE = RC_CRITERIA,
    /* of Findley's plane: angle of its normal to z, degrees, 0 to 90 */
    RC_PLANE_TILT,
    /* the same: angle of the normal to x, about z, -180 to 180 */
    RC_PLANE_TURN,
    RC_FATIGUES
};
/* Names in that order: "crossland", "dangvan", ... "amplitude", "plane-tilt", "plane-turn" */
RC_API extern const char *const rc_criterion_names[RC_FATIGUES];

/* Of a material, Pa: endurance limits in fully reversed bending and torsion, and the yield stress in tension;
 * 0 where no wanted criterion needs it. */
struct rc_fatigue_limits {
    double bending, torsion, yield;
};
/* RC_FAIL when `wanted`, bits of enum rc_criterion, is empty, a needed limit is not above 0, or torsion over
 * bending is above 1, as for no material, or outside the range of a criterion. */
RC_API enum rc_status rc_fatigue_check_limits(unsigned wanted,
                                              const struct rc_fatigue_limits *limits,
                                              struct rc_err *err);
/* The wanted values of one history of n > 0 stresses, s[c] with n values each, Pa; the others become NAN.
 * The history is a closed cycle; the order of its states has no effect. full: in the criterion of Dang
 * Van, hydrostatic pressure lowers the index. Otherwise only hydrostatic tension counts, which is on the
 * safe side. Shakedown allows residual stresses sxx and syy. RC_FAIL as above, and when memory is short. */
RC_API enum rc_status rc_fatigue_history(unsigned wanted, const struct rc_fatigue_limits *limits,
                                         bool full, size_t n, const double *const s[RC_COMPONENTS],
                                         double values[RC_FATIGUES], struct rc_err *err);

/* Histories below a map. With `pass`, the pressure travels with the contact over a body of uniform
 * properties: each point of a row along that axis sees all stresses of the row, and has one result.
 * Otherwise each case is the pressure at a position of the contact, and each node of the body has a
 * result. If the map is free along the travel, which is along x for cases, the unloaded state belongs
 * to each history, and a node outside the map of a case is unloaded. Otherwise nothing is added, and
 * columns wrap around. A contact that stays is unloaded before and after the cases, unless the map
 * repeats along both axes. */
struct rc_fatigue_problem {
    /* Its members wanted, section and traction are ignored; no strain. */
    struct rc_stress_options stress;
    /* bits of enum rc_criterion */
    unsigned wanted;
    /* as for rc_fatigue_history */
    bool full;
    /* 'x', 'y', or 0: cases */
    char pass;
    /* 1 with a pass */
    size_t cases;
    /* of each case, nx ny values, Pa; among ranks the rows held here */
    const double *const *p;
    /* the same; NULL: none */
    const double *const *traction[2];
    /* of each case: the column of the body below its first column; NULL: the contact stays */
    const size_t *column;
    /* Bytes for histories of cases; 0: all. With little room, stresses are computed again for
     * each band of rows, which costs time. The results are the same. */
    size_t room;
    /* Stressed volume: the integral of (amplitude - threshold)^power z^-depth_power over points
     * of a depth and over depths, with the amplitude in GPa. That of a pass is per length of
     * travel. power 0: none. */
    double power, depth_power, threshold;
};
/* The largest value of a criterion. */
struct rc_fatigue_place {
    /* index, or Pa for the amplitude; NAN: not wanted, or no depth yet */
    double value;
    /* m; x NAN: all of the travel */
    double x, y, depth;
    /* Relative: how much larger the value may be between the states and between the points, from
     * histories that are interpolated near the largest values of this depth. */
    double sampling_error;
};
struct rc_fatigue_figures {
    struct rc_fatigue_place largest[RC_CRITERIA + 1];
    /* 1 over the largest index */
    double safety;
    /* the largest one of the wanted criteria */
    double sampling_error;
    /* degrees: of Findley's plane at its largest index */
    double plane_tilt, plane_turn;
    /* Pa, at the point and instant that decide for Dang Van */
    double dangvan_hydrostatic;
    /* Pa, in all histories */
    double least_hydrostatic, largest_hydrostatic;
    /* GPa^power m^(3 - depth_power), of a pass m^(2 - depth_power) */
    double stressed_volume;
    /* states: of one history */
    size_t depths, histories, states;
    /* most bands of rows */
    size_t bands;
};
/* RC_FAIL when rc_fatigue_new would refuse the problem, except for short memory. */
RC_API enum rc_status rc_fatigue_check(const struct rc_shape *shape,
                                       const struct rc_fatigue_problem *problem,
                                       struct rc_err *err);
/* The grid of the results of a depth. A pass along x has ny columns, one for each row of the map, and one
 * row. Cases have the columns of the body that a case covers. */
RC_API struct rc_shape rc_fatigue_shape(const struct rc_shape *shape,
                                        const struct rc_fatigue_problem *problem);
/* Bytes that rc_fatigue_new allocates for its maps and histories, beside the plan of the stresses. */
RC_API size_t rc_fatigue_memory(const struct rc_shape *shape,
                                const struct rc_fatigue_problem *problem);
/* NULL when the problem is refused or memory is short. */
RC_API struct rc_fatigue *rc_fatigue_new(const struct rc_shape *shape,
                                         const struct rc_fatigue_problem *problem,
                                         struct rc_err *err);
/* The wanted values at the depth z >= 0 for a material with these limits: out[c] (NULL: not needed) for each
 * bit of `wanted`, on the grid of rc_fatigue_shape. Among ranks each gets its rows of this grid, of a pass
 * all values, and each gives the same members of `out`. residual: NULL, or a stress that is always there, Pa,
 * six components of ny values, for a pass along y nx values; NULL in it: 0. */
RC_API enum rc_status rc_fatigue_depth(struct rc_fatigue *fatigue, double depth,
                                       const struct rc_fatigue_limits *limits,
                                       const double *const residual[RC_COMPONENTS],
                                       double *const out[RC_FATIGUES], struct rc_err *err);
/* Figures of the last depth, and of all depths so far. */
RC_API const struct rc_fatigue_figures *rc_fatigue_at_depth(const struct rc_fatigue *fatigue);
RC_API const struct rc_fatigue_figures *rc_fatigue_result(const struct rc_fatigue *fatigue);
RC_API void rc_fatigue_free(struct rc_fatigue *fatigue);

/* ---- several processes ---- */
/* The functions that need MPI are in contact_mpi.h. */

/* Messages of all processes that share maps, in total. */
struct rc_sent {
    size_t exchanges;       /* exchanges of whole maps between rows and columns */
    double messages, bytes; /* messages and bytes of these exchanges */
    double other_bytes;     /* bytes of sums, neighbouring rows, coarser grids */
    double seconds;         /* seconds in exchanges, of the slowest process */
};

#ifdef __cplusplus
}
#endif

#endif
