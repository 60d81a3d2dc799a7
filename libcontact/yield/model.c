/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The model of a body that may yield in its volume, along a history of loads. A load is first solved as an
 * elastic contact. If its stresses stay below the yield stress everywhere, this is the solution, and no voxel
 * takes memory. Otherwise the body is loaded from 0 in increments, with slabs as deep as the largest planned
 * load needs. From then on each load continues from the last one.
 *
 * If the caller gives no number of increments, it follows from the largest elastic Mises stress. While their
 * part of the estimated error is too large, the body returns to the state before the load and takes more
 * increments. If that of the slabs is too large after the first load, the body takes thinner slabs and begins
 * again.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "yield.h"

#include "libcontact/expected.h"
#include "libcontact/memory.h"

enum {
    /* Fewest increments of a load: with fewer their error is unknown, see FEW. */
    FIRST = 8,
    /* Increments of the last try, so that a load ends. Half and double change no bit (23 lists of loads
     * of bench/constants.py). */
    MOST_AUTO = 128,
    /* Half, one try, takes 0.8 times the applications, and five loads miss their goal; double changes no
     * bit (23 lists of loads of bench/constants.py). */
    TRIES = 3
};
/* Goal of the error that determines the increments. Half takes 1.3 times the applications, double 0.8
 * times, and errors follow (23 lists of loads of bench/constants.py). */
static const double deserved = 1e-2;
/* Largest tolerance of each contact. Half changes no number of applications; double takes 4 % more,
 * because flow keeps a part of the error (23 lists of loads of bench/constants.py). */
static const double contact_most = 1e-4;
/* Its smallest tolerance, for a smaller goal. Half and double change no bit (23 lists of loads of
 * bench/constants.py). */
static const double contact_least = 1e-6;
/* Part of the goal. Half and double change no bit (23 lists of loads of bench/constants.py). */
static const double contact_share = 0.1;
/* The smallest lag that single precision allows. Half and double change no bit (23 lists of loads of
 * bench/constants.py). */
static const double lag_least = 1e-3;
/* Part of the goal for a load that others follow: they inherit its error. Half takes 1.2 times the
 * applications, double 0.9 times, with errors up to 5 times as large (23 lists of loads of
 * bench/constants.py). */
static const double for_later = 0.7;
/* The elastic Mises stress over the yield stress from which on the first load has no elastic trials: a ball
 * yields from an eighth of such a load on, and rough bodies sooner. */
static const double beyond = 2;
/* Increments of the first try over the largest elastic Mises stress over the yield stress. On 99 random maps
 * the increments that are enough for an error of 1e-2 differed from that by a factor of 1.7 (RMS). */
static const double of_stress = 3.3;
/* For an error of `deserved`; their error falls with this power of their number. */
static const double falls = 1.25;
/* The increments of the next try over those of the last one: enough for the error, and some more, within
 * bounds. */
static const double surplus = 1.15, again_least = 1.2, again_most = 4;
/* Of two runs: `of_change` times the change of the pressure over ratio - 1 is an error of the increments.
 * In 367 loads of random lists no estimate was below the error for 8 and 16 or 8 and 24 increments, one
 * for 16 and 32, two for 8 and 32. */
static const double of_change = 1.5;
/* Part of the goal that the error of the increments may have beside any other part. */
static const double own_least = 0.35;
/* Part of the goal for the change of the pressure by pairs of slabs, and the least goal that it follows. */
static const double slab_share = 0.35, slab_least = 1e-3;
/* Part of the goal beyond which the error of the slabs of a first load is worth thinner slabs; how much
 * thinner than needed they are; most slabs over the earlier ones. */
static const double slab_most = 0.7, thinner = 1.1, slabs_most = 3;
/* Of the increments of the two runs. Half and double of both change the applications by at most 4 % (23
 * lists of loads of bench/constants.py). */
static const double least_ratio = 2, most_ratio = 4;

enum stage {
    APART,   /* no load, and nothing has yielded */
    ELASTIC, /* the elastic contact */
    DEPTHS,  /* its stresses */
    LARGEST, /* the elastic contact under the largest load of the plan */
    MAKE,    /* the next step makes the volume */
    VOLUME
};

/* The loads of the caller, N. */
struct plan {
    double load, largest; /* load of the point; largest load of the plan */
    size_t left, planned; /* remaining loads of the plan; all of them */
};

/* The tries of a load, each with more increments. */
struct tries {
    size_t increments;           /* of the present try */
    size_t number;               /* of the try, from 0 */
    struct rc_state_copy before; /* state before the load; empty: there is no further try */
    struct rc_state_copy half;   /* companion: state of the run with half the increments */
    double *other;               /* Pa: pressure of the first try; NULL: there was none */
    size_t than;                 /* its increments; 0: it is not comparable */
    size_t spent;                /* applications of the tries of this load that were given up */
    size_t thicker;              /* those with thicker slabs */
    bool thinned;                /* there were thicker slabs */
    bool twice; /* the first try has half of the increments, and another one follows */
};

struct yield {
    struct rc_model base;
    struct rc_yield_problem
        problem; /* as given to the maker                                        */
    size_t n;
    double *h;             /* m: undeformed heights                                        */
    double first_top, top; /* m: highest point of h; highest point of the shape after plastic
                              strain */
    struct rc_solver *elastic;
    struct rc_yield_solver *plastic; /* NULL: no voxel has yielded */
    struct rc_yield_depths depths;   /* its `most` is over the yield stress */
    struct plan plan;
    struct tries tries;
    enum stage stage;
    enum rc_status reached; /* status of the elastic contact */
    bool far;               /* the first load that yields is far above the first yield */
    bool travels, moved;    /* the heights may change; they have changed since the last load */
    struct rc_yield_figures figures;
};

const struct rc_figure rc_figures_yield[] = {
#define FIGURE(member) RC_FIGURE(struct rc_yield_figures, member)
#define AS(column, member) RC_FIGURE_AS(column, struct rc_yield_figures, member)
    {AS("increments", last.increments), NULL, "Increments", .role = RC_FIGURE_COST},
    {AS("applications", last.applications), NULL, "Applications", .role = RC_FIGURE_COST},
    {FIGURE(slabs), NULL, "Slabs", .says = "layers that may yield"},
    {AS("plastic_depth", last.depth), "m", "Plastic depth"},
    {AS("plastic_volume", last.volume), "m3", "Plastic volume"},
    {AS("max_plastic_strain", last.max_strain), NULL, "Largest plastic strain", .limit = 0.1,
     .warning = "the plastic strain is beyond the theory of small strains"},
    {AS("plastic_work", last.work), "J", "Plastic work", .says = "of all loads so far"},
    {AS("max_pressure_mean4", last.max_pressure_mean4), "Pa", "Largest pressure over 2 x 2 nodes"},
    {FIGURE(max_mises_over_yield), NULL, "Mises stress over the yield stress",
     .says = "largest value in a body without yield"},
    {FIGURE(max_mises_depth), "m", "Depth of the largest Mises stress"},
    {FIGURE(indentation), "m", "Indentation",
     .says = "approach from the first touch of the first shape"},
    {FIGURE(residual_indentation), "m", "Residual indentation",
     .says =
         "first touch of the shape after the load, counted from first touch of the first shape"},
    {AS("increment_error_estimate", last.increment_error), NULL, "Error of the increments",
     .role = RC_FIGURE_ERROR, .by = "increments", .of = "pressure"},
    {AS("inherited_error_estimate", last.inherited_error), NULL, "Error of earlier loads",
     .role = RC_FIGURE_ERROR, .by = "increments", .of = "pressure"},
    {AS("iteration_error_estimate", last.iteration_error), NULL, "Error of the iteration",
     .role = RC_FIGURE_ERROR, .by = "tol", .of = "pressure"},
    {AS("contact_error_estimate", last.contact_error), NULL, "Error of the contacts",
     .role = RC_FIGURE_ERROR, .by = "tol", .of = "pressure"},
    {AS("image_error_estimate", last.image_error), NULL, "Error of the edge of the map",
     .role = RC_FIGURE_ERROR, .by = "boundary", .of = "pressure"},
    {AS("slab_error_estimate", last.slab_error), NULL, "Error of the slabs",
     .role = RC_FIGURE_ERROR, .by = "slabs", .of = "pressure"},
    {0},
};
static const struct rc_figure_set sets[] = {
    {rc_figures_contact, offsetof(struct yield, figures.contact)},
    {rc_figures_yield, offsetof(struct yield, figures)},
    {NULL, 0},
};

enum {
    RESIDUAL = RC_CONTACT_FRAMES,
    SHAPE
};
static const struct rc_frame_kind frames[] = {
    RC_CONTACT_FRAME_KINDS,
    [RESIDUAL] = {"residual", "m", "Residual displacement"},
    [SHAPE] = {"plastic", "m", "Height after yield"},
    {NULL, NULL, NULL},
};

/* ---- slabs ---- */

/* The allowed relative error of the pressure. */
static double
goal(const struct rc_yield_problem *problem)
{
    return problem->contact.tol > 0 ? problem->contact.tol : deserved;
}

/* Finds the slabs from the elastic pressure; y->slabs is 0 if no stress reaches the yield stress. */
static enum rc_status
find_slabs(const struct rc_yield_problem *asked, const struct rc_shape *shape, const double *p,
           struct rc_yield_depths *depths, struct rc_err *err)
{
    const double yield = rc_yield_law_stress(&asked->law, 0);
    struct rc_yield_depths d = {.halved = depths->halved,
                                .wanted = slab_share * fmax(goal(asked), slab_least)};
    const enum rc_status status = rc_yield_depths(shape, &asked->contact, p, yield, &d, err);

    if (status != RC_OK)
        return status;
    depths->most = d.most / yield;
    depths->deepest = d.deepest;
    depths->part = d.part;
    depths->looked = d.looked;
    depths->halved = d.halved;
    depths->slabs = d.slabs == 0 || asked->slabs == 0 ? d.slabs : asked->slabs;
    free(depths->thickness);
    depths->thickness = NULL;
    if (depths->slabs > 0)
        depths->thickness = malloc(depths->slabs * sizeof *depths->thickness);
    if (depths->thickness != NULL && asked->thickness != NULL)
        memcpy(depths->thickness, asked->thickness, depths->slabs * sizeof *depths->thickness);
    else if (depths->thickness != NULL)
        rc_yield_solver_stack(&d, depths->slabs, depths->thickness);
    free(d.thickness);
    return rc_ranks_need(asked->contact.ranks, depths->slabs == 0 || depths->thickness != NULL, err,
                         "out of memory for the slabs");
}

/* ---- the volume ---- */

static struct rc_yield_problem
problem_of(const struct rc_yield_problem *given, const struct rc_yield_depths *depths)
{
    struct rc_yield_problem problem = *given;
    const double asked = problem.contact.tol > 0 ? problem.contact.tol : 1;

    problem.contact.tol =
        fmin(fmin(asked, fmax(contact_share * asked, contact_least)), contact_most);
    problem.slabs = depths->slabs;
    problem.thickness = depths->thickness;
    if (problem.lag == 0)
        problem.lag = fmax(2 * fmin(goal(given), deserved), lag_least);
    return problem;
}

static enum rc_status
make(struct yield *y, struct rc_err *err)
{
    const struct rc_yield_problem problem = problem_of(&y->problem, &y->depths);

    rc_solver_free(y->elastic); /* the volume has a solver of its own, and takes its memory */
    y->elastic = NULL;
    if ((y->plastic = rc_yield_solver_new(&y->base.shape, y->h, &problem, err)) == NULL)
        return RC_FAIL;
    y->plastic->asked.travels = y->travels;
    y->plastic->asked.yields = y->far;
    y->plastic->asked.chosen = y->problem.slabs == 0;
    y->stage = VOLUME;
    return RC_OK;
}

/* The increments of the first try from one load to the next, where the largest elastic Mises stress is `most`
 * times the yield stress. */
static size_t
first_increments(const struct rc_yield_problem *problem, double most, double share, bool later)
{
    const double aim = goal(problem) * (later ? for_later : 1);
    const double wanted = of_stress * most * pow(deserved / aim, 1 / falls) * share;

    return problem->increments > 0 ? problem->increments
                                   : (size_t)ceil(fmin(fmax(wanted, FIRST), MOST_AUTO));
}

/* True if no load of the plan needs more than RC_YIELD_SEVERE increments for an error of `deserved`. */
static bool
is_mild(const struct yield *y)
{
    return y->depths.most > 0 && of_stress * y->depths.most <= RC_YIELD_SEVERE;
}

/* Sets the load with the number of increments of the next try. */
static enum rc_status
try_load(struct yield *y, struct rc_err *err)
{
    y->plastic->asked.thorough = y->tries.number > 0 && !y->problem.companion;
    y->plastic->asked.mild = is_mild(y) && y->tries.number == 0;
    rc_yield_solver_set_increments(y->plastic, y->tries.increments);
    return rc_yield_solver_set_load(y->plastic, y->plan.load, err);
}

static enum rc_status
save(const struct yield *y, struct rc_state_copy *to, const char *what, struct rc_err *err)
{
    return rc_state_save(to, y->base.rows.ranks, rc_yield_solver_exchange, y->plastic) == RC_OK
               ? RC_OK
               : rc_err_set(err, "out of memory for %s", what);
}

static enum rc_status
load(const struct yield *y, const struct rc_state_copy *from, struct rc_err *err)
{
    return rc_state_load(from, y->base.rows.ranks, rc_yield_solver_exchange, y->plastic, err);
}

/* Begins the first try of a load. On other heights the same load is one more increment. */
static enum rc_status
begin(struct yield *y, struct rc_err *err)
{
    const double from = y->plastic->way.from;
    const bool follows = y->moved && y->plan.load > 0 && y->plan.load == from;

    y->moved = false;
    y->tries.than = 0;
    y->tries.spent = y->tries.thicker;
    y->tries.thicker = 0;
    if (follows) {
        y->tries.increments = 1;
        y->tries.number = 0;
        rc_state_forget(&y->tries.before);
        y->plastic->asked.thorough = false;
        rc_yield_solver_follow(y->plastic);
        return rc_yield_solver_set_load(y->plastic, y->plan.load, err);
    }
    y->tries.increments = first_increments(
        &y->problem, y->depths.most,
        fabs(y->plan.load - from) / fmax(fmax(y->plan.load, from), DBL_MIN), y->plan.left > 0);
    /* separated bodies have no pressure to compare */
    y->tries.twice = y->problem.increments == 0 && !is_mild(y) && y->plan.load > 0 &&
                     y->tries.increments > RC_YIELD_SEVERE;
    if (y->tries.twice)
        y->tries.increments /= 2;
    y->tries.number = 0;
    rc_state_forget(&y->tries.before);
    if ((y->problem.increments == 0 || y->problem.companion) &&
        save(y, &y->tries.before, "the state before a load", err) != RC_OK)
        return RC_FAIL;
    if (y->problem.companion)
        y->tries.increments /= 2;
    if (y->problem.companion && y->tries.half.n > 0 && load(y, &y->tries.half, err) != RC_OK)
        return RC_FAIL;
    return try_load(y, err);
}

/* True if more increments can lower the error of the load to the goal; sets their number. The other parts of
 * the error do not depend on it. */
static bool
deserves_more(struct tries *tries, const struct rc_yield_load *f, double wanted, bool later)
{
    const double own = f->increment_error, slab = isnan(f->slab_error) ? 0 : f->slab_error;
    const double left =
        fmax(wanted - f->iteration_error - f->contact_error - f->image_error, wanted / 2);
    const double room = fmax(sqrt(fmax(left * left - slab * slab, 0)) * (later ? for_later : 1) -
                                 f->inherited_error,
                             own_least * wanted);
    const bool half = tries->twice && tries->number == 0 && f->increments > 1;
    const size_t most = !tries->twice && tries->increments < RC_YIELD_SEVERE ? RC_YIELD_SEVERE
                        : wanted < deserved                                  ? RC_YIELD_INCREMENTS
                                                                             : MOST_AUTO;
    const double ratio = fmax(surplus * pow(own / room, 1 / falls), half ? 2 : 0);
    const double more =
        ceil((double)tries->increments * fmin(fmax(ratio, again_least), again_most));

    if (tries->before.n == 0 || tries->number + 1 == TRIES || tries->increments >= most ||
        !(half || own > room))
        return false;
    tries->increments = more < (double)most ? (size_t)more : most;
    return true;
}

/* Estimates the error of the increments again, from the change since the first try. A companion run has
 * its own history, so that the change contains the errors of earlier loads. */
static void
compare_runs(struct yield *y)
{
    const struct rc_yield_load *f = &y->plastic->figures;
    const double ratio =
        y->tries.than > 0 ? (double)y->tries.increments / (double)y->tries.than : 0;
    const double *p = rc_solver_pressure(y->plastic->solver);
    double own = f->increment_error, before = f->inherited_error, change;
    const struct rc_ranks *ranks = y->base.rows.ranks;

    if (y->plan.load == 0 || ratio < least_ratio || isnan(f->increment_error))
        return;
    change = of_change / (fmin(ratio, most_ratio) - 1) *
             rc_ranks_distance(ranks, p, y->tries.other, y->n) / rc_ranks_sum_of(ranks, p, y->n);
    if (!y->problem.companion) {
        own = fmax(own, change);
    } else if (change > own + before) {
        before = own > 0 ? before * change / (own + before) : change;
        own = own > 0 ? change - before : 0;
    }
    rc_yield_solver_judge(y->plastic, own, before);
}

/* Forgets the volume. */
static void
forget_volume(struct yield *y)
{
    rc_yield_solver_free(y->plastic);
    free(y->depths.thickness);
    rc_state_forget(&y->tries.before);
    rc_state_forget(&y->tries.half);
    y->plastic = NULL;
    y->depths.thickness = NULL;
    y->depths.slabs = 0;
}

/* RC_MORE if a first load deserves thinner slabs, which are then set. A last load within the goal does not
 * deserve them. */
static enum rc_status
take_thinner(struct yield *y, struct rc_err *err)
{
    const struct rc_yield_load *f = &y->plastic->figures;
    const double wanted = slab_most * fmax(goal(&y->problem), slab_least),
                 ratio = thinner * sqrt(f->slab_error / wanted);
    const size_t n = (size_t)ceil((double)y->depths.slabs * fmin(ratio, slabs_most));
    double *thickness;

    if (!y->plastic->asked.chosen || y->tries.thinned || y->plan.load == 0 ||
        y->plastic->run.taken != f->increments || !(f->slab_error > wanted) ||
        (y->plan.left == 0 && f->error <= goal(&y->problem)))
        return RC_OK;
    thickness = malloc(n * sizeof *thickness);
    if (rc_ranks_need(y->base.rows.ranks, thickness != NULL, err, "out of memory for the slabs") !=
        RC_OK) {
        free(thickness);
        return RC_FAIL;
    }
    rc_yield_solver_stack(&y->depths, n, thickness);
    y->tries.thicker = y->tries.spent + f->applications;
    forget_volume(y);
    y->depths.thickness = thickness;
    y->depths.slabs = n;
    y->tries.thinned = true;
    y->stage = MAKE;
    return RC_MORE;
}

static bool
has_other(struct yield *y)
{
    if (y->tries.other == NULL)
        y->tries.other = rc_store_take(&y->base.own, y->n, sizeof *y->tries.other);
    return y->tries.other != NULL;
}

/* Keeps the pressure of the first try, and returns to the state before it. */
static enum rc_status
try_again(struct yield *y, size_t than, struct rc_err *err)
{
    if (rc_ranks_need(y->base.rows.ranks, has_other(y), err,
                      "out of memory for the pressure of a try") != RC_OK)
        return RC_FAIL;
    if (y->tries.number == 0) {
        memcpy(y->tries.other, rc_solver_pressure(y->plastic->solver),
               y->n * sizeof *y->tries.other);
        y->tries.than = than;
    }
    y->tries.spent += y->plastic->figures.applications;
    y->tries.number++;
    if (load(y, &y->tries.before, err) != RC_OK)
        return RC_FAIL;
    return try_load(y, err) == RC_OK ? RC_MORE : RC_FAIL;
}

static enum rc_status
press_volume(struct yield *y, struct rc_err *err)
{
    const enum rc_status status = rc_yield_solver_step(y->plastic, err);
    const size_t tried = y->tries.increments;
    enum rc_status thinner_slabs;

    if (status == RC_MORE || status == RC_FAIL)
        return status;
    if ((thinner_slabs = take_thinner(y, err)) != RC_OK)
        return thinner_slabs;
    compare_runs(y);
    if (y->problem.companion && y->tries.before.n > 0 && y->tries.number == 0) {
        rc_state_forget(&y->tries.half);
        if (save(y, &y->tries.half, "the state of the companion run", err) != RC_OK)
            return RC_FAIL;
        y->tries.increments = y->problem.increments;
        return try_again(y, tried, err);
    }
    if (!y->problem.companion &&
        deserves_more(&y->tries, &y->plastic->figures, goal(&y->problem), y->plan.left > 0))
        return try_again(y, tried, err);
    rc_state_forget(&y->tries.before);
    return status;
}

/* ---- memory ---- */

/* The number of slabs, each counted as the part of the nodes of the map that it has. */
static double
slabs_by_nodes(const struct rc_yield_problem *problem, const struct rc_shape *shape,
               const struct rc_yield_depths *depths)
{
    const struct rc_slabs_options options = {.slabs = depths->slabs,
                                             .thickness = depths->thickness,
                                             .boundary = problem->contact.boundary,
                                             .coarser = problem->precise ? 0 : RC_YIELD_COARSER,
                                             .ranks = problem->contact.ranks};

    return depths->thickness != NULL ? rc_slabs_by_nodes(shape, &options)
           : depths->slabs > 0       ? (double)depths->slabs
                                     : (double)problem->slabs;
}

/* Bytes of the volume and of its state, if this part of the voxels yields. */
static size_t
volume_bytes(const struct rc_yield_problem *problem, const struct rc_shape *shape,
             const struct rc_yield_depths *depths)
{
    /* bytes a node, measured on 1024 x 1024 nodes: free, periodic */
    static const double body[] = {122, 96}, slab[] = {92.2, 23.1};
    const struct rc_boundary boundary = problem->contact.boundary;
    const double voxels = depths->part * sizeof(struct rc_voxel);
    const size_t slabs = depths->slabs > 0 ? depths->slabs : problem->slabs;
    const bool tries = problem->increments == 0 || problem->companion;

    /* a state takes at most the memory of the voxels and of a pressure */
    return rc_slabs_line_bytes(shape, boundary, slabs) +
           (size_t)((double)(shape->nx * shape->ny) /
                    (double)rc_ranks_count(problem->contact.ranks) *
                    (rc_by_padding(boundary, body[0], body[1]) + (1 + tries) * sizeof(double) +
                     slabs_by_nodes(problem, shape, depths) *
                         (rc_by_padding(boundary, slab[0], slab[1]) +
                          (2 + problem->companion) * voxels)));
}

/* The cost of a sum in the volume with that of the longer profiles (volume/lines.h), over that without. */
static double
with_lines(const struct rc_shape *shape, struct rc_boundary boundary)
{
    return rc_repeats(boundary) != 1
               ? 1
               : 1 + (1 + RC_SLABS_FAR) / (double)(boundary.x ? shape->nx : shape->ny);
}

/* The cost of the elastic contact. */
static enum rc_status
expect_elastic(const struct rc_shape *shape, const struct rc_yield_problem *problem, double load,
               struct rc_expected *expected, struct rc_err *err)
{
    struct rc_problem contact = problem->contact;

    contact.load = load;
    contact.approach = 0;
    return rc_solver_expect(shape, &contact, expected, err);
}

/* The cost of the elastic contact. Once the body is known to yield, the cost of a first load of the volume is
 * added, with its own contacts. It was measured on rough contacts of 9 to 23 % contact. */
static enum rc_status
plan(const struct rc_model *m, const struct rc_point *most, struct rc_expected *expected,
     struct rc_err *err)
{
    const struct yield *y = (const struct yield *)m;
    const size_t volume = y->depths.slabs > 0 || y->problem.slabs > 0
                              ? volume_bytes(&y->problem, &y->base.shape, &y->depths)
                              : 0;
    const size_t first = first_increments(&y->problem, y->depths.most, 1, y->plan.left > 0);
    const double increments =
        (y->problem.increments == 0 && !is_mild(y) && first > RC_YIELD_SEVERE ? 1.5 : 1) *
        (double)first;
    static const double sums[] = RC_YIELD_SUMS, look[] = RC_YIELD_LOOK;
    const double looked = rc_by_padding(y->problem.contact.boundary, look[0], look[1]) *
                          (double)(y->depths.looked > 0 ? y->depths.looked : RC_YIELD_LOOKED);
    const double threads = (double)(y->problem.contact.threads > 0 ? y->problem.contact.threads
                                                                   : rc_threads_available());
    const double applied = y->depths.slabs > 0
                               ? (RC_YIELD_LAST + RC_YIELD_INCREMENT * increments) *
                                     slabs_by_nodes(&y->problem, &y->base.shape, &y->depths)
                               : 0;
    double one; /* seconds of a sum without its start; the other sums have none of their own */

    if (expect_elastic(&y->base.shape, &y->problem, most->at[RC_LOAD], expected, err) != RC_OK)
        return RC_FAIL;
    one = fmax(expected->seconds / expected->convolutions - 2 * RC_SUM_START / threads, 0);
    expected->seconds += looked * one;
    expected->seconds += applied * one *
                         rc_by_padding(y->problem.contact.boundary, sums[0], sums[1]) *
                         with_lines(&y->base.shape, y->problem.contact.boundary);
    expected->convolutions += RC_YIELD_SLAB * applied;
    expected->memory = volume > expected->memory ? volume : expected->memory;
    return RC_OK;
}

/* Bytes that the volume takes in addition to the memory of the elastic contact. */
static size_t
more_bytes(const struct yield *y)
{
    const size_t volume = volume_bytes(&y->problem, &y->base.shape, &y->depths);
    struct rc_expected elastic = {0};

    (void)expect_elastic(&y->base.shape, &y->problem, fmax(y->plan.load, y->plan.largest), &elastic,
                         NULL);
    return volume > elastic.memory ? volume - elastic.memory : 0;
}

/* ---- loads ---- */

static enum rc_status
set_elastic(struct yield *y, double load, struct rc_err *err)
{
    struct rc_problem contact = y->problem.contact;

    if (y->elastic != NULL)
        return rc_solver_set_load(y->elastic, load, 0, err);
    contact.load = load;
    contact.approach = 0;
    y->elastic = rc_solver_new(&y->base.shape, y->h, &contact, err);
    return y->elastic != NULL ? RC_OK : RC_FAIL;
}

static enum rc_status
set_load(struct yield *y, double load, struct rc_err *err)
{
    y->plan.load = load;
    if (y->stage == VOLUME)
        return begin(y, err);
    if (!(load >= 0))
        return rc_err_set(err, "load %g N: it must be finite and not negative", load);
    y->stage = load > 0 ? ELASTIC : APART;
    if (load > 0)
        y->depths.most = y->depths.deepest = 0;
    return load > 0 ? set_elastic(y, load, err) : RC_OK;
}

static enum rc_status
go(struct rc_model *m, struct rc_err *err)
{
    struct yield *y = (struct yield *)m;

    y->plan.left -= y->plan.left > 0;
    return set_load(y, m->to.at[RC_LOAD], err);
}

/* Finds the stresses of the elastic contact. Returns RC_MORE if the body yields. */
static enum rc_status
look_inside(struct yield *y, struct rc_err *err)
{
    const enum rc_status status =
        find_slabs(&y->problem, &y->base.shape, rc_solver_pressure(y->elastic), &y->depths, err);

    if (status != RC_OK) /* RC_MORE: the caller cannot wait */
        return status;
    if (y->depths.slabs == 0)
        return y->reached;
    y->far = y->depths.most > beyond;
    y->stage = y->plan.largest > y->plan.load ? LARGEST : MAKE;
    return y->stage == LARGEST && set_elastic(y, y->plan.largest, err) != RC_OK ? RC_FAIL : RC_MORE;
}

/* Takes an iteration of the elastic contact. */
static enum rc_status
press_elastic(struct yield *y, struct rc_err *err)
{
    const enum rc_status status = rc_solver_step(y->elastic);
    enum rc_status looked = RC_OK;

    if (status == RC_MORE)
        return RC_MORE;
    if (y->stage == LARGEST)
        looked = find_slabs(&y->problem, &y->base.shape, rc_solver_pressure(y->elastic), &y->depths,
                            err);
    if (looked != RC_OK)
        return looked;
    y->reached = status;
    y->stage = y->stage == LARGEST ? MAKE : DEPTHS;
    return RC_MORE;
}

static enum rc_status
step(struct rc_model *m, struct rc_err *err)
{
    struct yield *y = (struct yield *)m;

    switch (y->stage) {
    case APART:
        return RC_OK;
    case VOLUME:
        return press_volume(y, err);
    case MAKE:
        return make(y, err) == RC_OK && begin(y, err) == RC_OK ? RC_MORE : RC_FAIL;
    case DEPTHS:
        return look_inside(y, err);
    default:
        return press_elastic(y, err);
    }
}

/* ---- results ---- */

static struct rc_solver *
solver(const struct rc_model *m)
{
    const struct yield *y = (const struct yield *)m;

    return y->plastic != NULL ? y->plastic->solver : y->elastic;
}

/* Adds the displacement due to plastic strain. */
static void
displace(const struct yield *y, double factor, double *v)
{
    const double *u = y->plastic != NULL ? y->plastic->maps.u : NULL;

    for (size_t k = 0; k < y->n && u != NULL; k++)
        v[k] += factor * u[k];
}

/* Finds the shape after plastic strain. */
static void
shape(const struct yield *y, double *to)
{
    memcpy(to, y->h, y->n * sizeof *to);
    displace(y, -1, to);
}

/* Finds the figures of separated bodies, and the gap (NULL: not needed). */
static enum rc_status
look_apart(const struct yield *y, double *gap, struct rc_contact *c, struct rc_err *err)
{
    RC_OWNED double *left = rc_alloc(y->n, sizeof *left);

    if (rc_ranks_need(y->base.rows.ranks, left != NULL, err,
                      "out of memory for the shape after yield") != RC_OK)
        return RC_FAIL;
    shape(y, left);
    rc_contact_apart(y->base.rows.ranks, &y->base.shape, left, gap, c);
    return RC_OK;
}

static double
highest(const struct yield *y)
{
    const double *u = y->plastic != NULL ? y->plastic->maps.u : NULL;
    double top = -INFINITY;

    for (size_t k = 0; k < y->n; k++)
        top = fmax(top, u != NULL ? y->h[k] - u[k] : y->h[k]);
    return rc_ranks_most(y->base.rows.ranks, top);
}

/* 0: an elastic trial of the load */
static size_t
increment_of(const struct rc_yield_solver *p)
{
    return p->stage == RC_YIELD_PROBE ? 0 : p->run.increment;
}

static void
look_at_volume(struct yield *y)
{
    struct rc_yield_figures *f = &y->figures;

    f->last = y->plastic->figures;
    f->last.applications += y->tries.spent;
    f->increment = increment_of(y->plastic);
    f->contact.pressure_error = f->last.error;
    f->contact.convolutions = NAN; /* nearly all of the work is for the volume */
    /* the error is unknown if the caller asked for few increments */
    f->contact.converged =
        y->base.status == RC_OK && f->contact.converged &&
        (f->last.error <= goal(&y->problem) ||
         ((y->problem.increments > 0 || y->problem.slabs > 0) && isnan(f->last.error)));
}

static enum rc_status
look(struct rc_model *m, struct rc_point *at, struct rc_err *err)
{
    struct yield *y = (struct yield *)m;
    struct rc_yield_figures *f = &y->figures;
    const bool known = y->plastic == NULL && (y->depths.most > 0 || y->plan.load == 0);

    if (y->stage == LARGEST) { /* the caller stopped before the end: the load is the load of the
                                  point */
        if (set_elastic(y, y->plan.load, err) != RC_OK)
            return RC_FAIL;
        y->stage = ELASTIC;
    }
    y->top = highest(y);
    if (m->to.at[RC_LOAD] == 0 && look_apart(y, NULL, &f->contact, err) != RC_OK)
        return RC_FAIL;
    if (m->to.at[RC_LOAD] > 0)
        rc_solver_result(solver(m), NULL, NULL, &f->contact);
    f->last = (struct rc_yield_load){0};
    f->yielded = y->plastic != NULL;
    f->slabs = y->depths.slabs;
    f->thickness = y->depths.thickness;
    f->increments = y->tries.increments;
    f->max_mises_over_yield = known ? y->depths.most : NAN;
    f->max_mises_depth = known ? y->depths.deepest : NAN;
    if (y->plastic != NULL)
        look_at_volume(y);
    f->residual_indentation = y->first_top - y->top;
    f->indentation = (m->to.at[RC_LOAD] > 0 ? f->contact.approach : 0) + y->first_top - y->top;
    at->at[RC_LOAD] = f->contact.load;
    at->at[RC_APPROACH] = f->contact.approach;
    return RC_OK;
}

static enum rc_status
fill(struct rc_model *m, size_t frame, double *to, struct rc_err *err)
{
    struct yield *y = (struct yield *)m;
    struct rc_contact again;

    memset(to, 0, y->n * sizeof *to);
    if (frame == SHAPE)
        shape(y, to);
    else if (frame == RC_FRAME_GAP && m->to.at[RC_LOAD] == 0)
        return look_apart(y, to, &again, err);
    else if (m->to.at[RC_LOAD] > 0 && (frame == RC_FRAME_PRESSURE || frame == RC_FRAME_CONTACT))
        memcpy(to, rc_solver_pressure(solver(m)), y->n * sizeof *to);
    else if (frame != RESIDUAL && m->to.at[RC_LOAD] > 0)
        rc_solver_result(solver(m), frame == RC_FRAME_DISPLACEMENT ? to : NULL,
                         frame == RC_FRAME_GAP ? to : NULL, &again);
    if (frame == RESIDUAL || frame == RC_FRAME_DISPLACEMENT)
        displace(y, 1, to);
    for (size_t k = 0; k < y->n && frame == RC_FRAME_CONTACT; k++)
        to[k] = rc_in_contact(to[k]) ? 1 : 0;
    return RC_OK;
}

static void
progress(const struct rc_model *m, struct rc_loops *l)
{
    const struct yield *y = (const struct yield *)m;
    const double most = (double)y->tries.increments;
    struct rc_progress at;

    l->coming = y->stage == MAKE ? more_bytes(y) : 0;
    if (y->plastic != NULL) {
        const double increment = fmin((double)increment_of(y->plastic), most);
        rc_loops_add(l, "load", "N", y->plastic->way.set, NAN);
        rc_loops_add(l, "increment", NULL, increment, most);
        rc_loops_add(l, "application", NULL, (double)y->plastic->run.trial, NAN);
        /* between increments a state is smaller; the last increment may take long */
        l->worth = y->plastic->run.trial == 0 || increment >= most;
    } else if (y->elastic != NULL) {
        rc_solver_progress(y->elastic, &at);
        rc_loops_add(l, "iteration", NULL, (double)at.iterations, NAN);
        l->grid = at.grid;
        l->error = at.error;
        l->tol = at.tol;
        l->worth = !at.coarser && at.iterations > 0;
    }
}

static enum rc_status
set_heights(struct rc_model *m, const double *h, struct rc_err *err)
{
    struct yield *y = (struct yield *)m;

    memcpy(y->h, h, y->n * sizeof *h);
    y->travels = y->moved = true;
    if (m->from.given == 0 && y->plastic == NULL)
        y->first_top = highest(y);
    if (y->plastic != NULL)
        rc_yield_solver_set_heights(y->plastic, h);
    return y->elastic != NULL ? rc_solver_set_heights(y->elastic, h, err) : RC_OK;
}

/* ---- states ---- */

/* Of a state. Earlier states, in which deep slabs had all nodes, began with a number of increments. */
enum {
    LAYOUT = RC_YIELD_INCREMENTS + 3
};

/* A state has its layout, counts and loads first. Then comes the pressure of an elastic contact. For a volume
 * come the thicknesses of its slabs, the state before the load, and its own state. */

/* solved: the load of the stored pressure; 0: none is stored. */
static void
exchange_elastic(struct yield *y, struct rc_state *s, double solved)
{
    const double *p;
    struct rc_err err;
    double *to;

    if (!rc_state_reads(s)) { /* the cast is safe: writing does not change the pressure */
        to = rc_state_map(s, y->n, solved > 0 ? (double *)rc_solver_pressure(y->elastic) : NULL);
        if (to != NULL && solved == 0)
            memset(to, 0, y->n * sizeof *to);
        return;
    }
    forget_volume(y);
    y->stage = APART;
    p = rc_state_read_map(s, y->n);
    if (rc_state_reads(s) &&
        (set_load(y, y->plan.load, &err) != RC_OK ||
         (solved > 0 &&
          (y->elastic == NULL || rc_solver_warm_start(y->elastic, solved, p, &err) != RC_OK))))
        rc_state_refuse(s, "its load or its pressure is not finite or negative");
}

static void
exchange_volume(struct yield *y, struct rc_state *s, size_t slabs)
{
    double *thickness = y->depths.thickness;
    struct rc_err err;

    if (!rc_state_holds(s, slabs))
        return;
    if (rc_state_reads(s) && (thickness = malloc(slabs * sizeof *thickness)) == NULL) {
        rc_state_refuse(s, "memory is short");
        return;
    }
    rc_state_finite(s, slabs, thickness);
    if (rc_state_reads(s) &&
        (y->plastic == NULL || slabs != y->depths.slabs ||
         memcmp(thickness, y->depths.thickness, slabs * sizeof *thickness) != 0)) {
        forget_volume(y);
        y->depths.slabs = slabs;
        y->depths.thickness = thickness;
        if (make(y, &err) != RC_OK)
            rc_state_refuse(s, err.text);
    }
    if (thickness != y->depths.thickness)
        free(thickness);
    rc_state_copy(s, &y->tries.before);
    rc_state_copy(s, &y->tries.half);
    rc_state_count(s, &y->tries.spent, SIZE_MAX / 4096);
    rc_state_number(s, &y->depths.most, 0);
    RC_STATE_FLAGS(s, &y->tries.thinned, &y->tries.twice);
    rc_state_count(s, &y->tries.than, RC_YIELD_INCREMENTS);
    if (y->tries.than > 0 && !has_other(y))
        rc_state_refuse(s, "memory is short");
    else if (y->tries.than > 0)
        rc_state_map(s, y->n, y->tries.other);
    if (y->plastic != NULL) {
        y->plastic->asked.mild = is_mild(y) && y->tries.number == 0;
        rc_yield_solver_exchange(y->plastic, s);
    }
}

static void
state(struct rc_model *m, struct rc_state *s)
{
    struct yield *y = (struct yield *)m;
    size_t layout = LAYOUT;
    size_t slabs = y->plastic != NULL ? y->depths.slabs : 0;
    double solved = y->plastic == NULL && y->elastic != NULL && y->stage != APART
                        ? rc_solver_load(y->elastic)
                        : 0;

    rc_state_count(s, &layout, SIZE_MAX / 2);
    if (layout != LAYOUT) {
        rc_state_refuse(s, "another version of the program wrote it");
        return;
    }
    rc_state_count(s, &y->tries.increments, RC_YIELD_INCREMENTS);
    rc_state_count(s, &y->tries.number, TRIES - 1);
    rc_state_count(s, &y->plan.left, SIZE_MAX / 2);
    rc_state_count(s, &slabs, SIZE_MAX / sizeof(double));
    rc_state_number(s, &y->plan.load, 0);
    rc_state_number(s, &solved, 0);
    rc_state_finite(s, 1, &y->first_top);
    if (rc_state_refused(s))
        return;
    if (slabs > 0)
        exchange_volume(y, s, slabs);
    else
        exchange_elastic(y, s, solved);
    if (rc_state_reads(s) && m->moved)
        m->status = RC_MORE; /* the next step decides whether it is the solution */
}

static void
release(struct rc_model *m)
{
    struct yield *y = (struct yield *)m;

    forget_volume(y);
    rc_solver_free(y->elastic);
}

/* ---- the maker ---- */

const struct rc_model_row rc_model_yield = {
    .name = "yield",
    .summary = "a body that yields in its volume",
    .needs = 1u << RC_LOAD,
    .takes = 1u << RC_LOAD,
    RC_MODEL_VERBS,
    .frame = frames,
    .free = release,
    .heights = set_heights,
    .plan = plan,
    .solver = solver,
};

struct rc_model *
rc_yield_new(const struct rc_shape *shape, const double *h, const struct rc_yield_problem *problem,
             struct rc_err *err)
{
    RC_OWN(rc_model, m) = NULL;
    struct yield *y;

    if (rc_shape_check(shape, err) != RC_OK || rc_yield_solver_check(problem, err) != RC_OK ||
        (m = rc_model_make(&rc_model_yield, sizeof *y, shape, problem->contact.ranks, err)) == NULL)
        return NULL;
    y = (struct yield *)m;
    y->problem = *problem;
    m->boundary = problem->contact.boundary;
    y->n = rc_model_nodes(m);
    y->h = rc_store_copy(&m->own, y->n, sizeof *h, h);
    if (rc_model_room(m, err) != RC_OK)
        return NULL;
    y->first_top = highest(y);
    return rc_give(&m);
}

static struct yield *
yielding_of(const struct rc_model *m)
{
    return (struct yield *)rc_model_find(m, &rc_model_yield);
}

void
rc_yield_plan(struct rc_model *m, size_t loads, double largest)
{
    struct yield *y = yielding_of(m);

    if (y != NULL) {
        y->plan.left = y->plan.planned = loads;
        y->plan.largest = largest;
    }
}

bool
rc_yield_strain(const struct rc_model *m, size_t slab, double *const e[RC_YIELD_STRAINS])
{
    const struct yield *y = yielding_of(m);

    if (y == NULL || y->plastic == NULL || slab >= y->depths.slabs)
        return false;
    rc_yield_solver_strain(y->plastic, slab, e);
    return true;
}
