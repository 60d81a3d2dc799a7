/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The action of a pressure on the surface, for the solver: the interface of this folder. Internal: never
 * installed.
 *
 * The solver gets an operator K. It asks K for K p, for its inverse as a multiplication in wave numbers, and
 * for a few figures. Its users need no knowledge of bodies, engine, transforms or other ranks: maps and rows
 * are those held here.
 */
#ifndef RC_OPERATOR_H
#define RC_OPERATOR_H

#include "engine.h"
#include "fft.h"
#include "libcontact/transform/transform.h"

/* Constant after it is made. Pressures and displacements row by row are in single precision and in their own
 * units: u = unit K' p. K' is about 1, so that no decade of metres or pascals is lost. Lengths beside them
 * are in units of sqrt(dx dy). */
/* The compliance beside that of the bodies. */
struct rc_operator_soft {
    /* m/Pa: D of the diagonal term, that of a typical node; K below is K + D. With `part` (else NULL, and all
     * nodes have `plus`) node k has own part[k]. */
    double plus, own;
    const double *part;
    /* 1/Pa: each row also moves by this times the integral of p along it, which is part of K below */
    double row;
    double *sunk; /* m: motion of each row held here, see rc_operator_sink; NULL: row is 0 */
};

/* Members of the inverse, in the units of rows. */
struct rc_operator_near {
    double
        inverse[3]
               [3]; /* the pressures on a node and its eight neighbours that move this node by 1 and
                               no other node */
    double
        neighbour[3]
                 [3]; /* the coupling of this node to each of the eight in smooth motions, up to a
                               factor */
};

struct rc_operator {
    struct rc_shape whole, shape; /* shape of the whole map, and of the rows held here */
    struct rc_rows rows;          /* rows held here */
    /* With the datum of K, m, for which K is positive. That of the options adds `rise` times the sum of the
     * nodal pressures to the displacement, m/Pa. */
    struct rc_boundary boundary;
    double rise;
    double nearest; /* m: with a nearer datum a load may move a rigid body away */
    size_t threads;
    double unit;  /* m/Pa                                                             */
    double estar; /* Pa, if it is the same for all waves; NAN: it is not              */
    struct rc_operator_soft soft;
    double norm;     /* m/Pa: a bound of the largest eigenvalue                          */
    double diagonal; /* m/Pa: displacement of a node under unit pressure on its own cell */
    struct rc_operator_near near;
    struct rc_frame frame; /* nodes of the padding in rc_operator_chain_framed */
    /* a common shift of a set needs pressures of its own at the edges (see working_set.c): layers on a free
     * map */
    bool edges;
    double error;       /* error of K p, relative to the sum of |K| |p| */
    double row_error;   /* the same, row by row                                            */
    double row_cost;    /* cost of K p row by row, in equivalents of K p in double precision */
    double factor_cost; /* cost of each factor of a chain */
    bool exact;         /* K p is available in double precision                            */
    bool bends;         /* a coating stiffer than its base: the inverse alternates in sign */
    bool mean_free;     /* the mean of u is 0 for any pressure: it has no stiffness        */
    const char *engine, *reason; /* engine of K p and the reason for it; NULL: none */
    const struct rc_spectrum *kernel, *inverse; /* factors for rc_operator_chain: K and K^-1   */
};

struct rc_operator_options {
    struct rc_boundary boundary;
    const struct rc_pair *pair;   /* the bodies: the caller's                                    */
    const struct rc_along *along; /* NULL: the factor is 1; else the caller's                    */
    const char *engine;           /* NULL: auto                                    */
    double tol;                   /* permitted error of K p, as in rc_conv_options */
    size_t threads;               /* 0: all                                        */
    const struct rc_ranks *ranks; /* ranks that share the map */
};

/* NULL when there is no such engine, or none for the boundary, or memory is short. */
struct rc_operator *rc_operator_new(const struct rc_shape *shape,
                                    const struct rc_operator_options *options, struct rc_err *err);
/* The same bodies on another grid that these ranks share, without K p in double precision. */
struct rc_operator *rc_operator_coarse(const struct rc_operator *op, const struct rc_ranks *ranks,
                                       const struct rc_shape *shape, struct rc_err *err);
void rc_operator_free(struct rc_operator *op); /* NULL is allowed */
RC_OWNER(rc_operator)
/* RC_FAIL, and *err says why, when there is no such engine, or none for the boundary or the ranks. */
enum rc_status rc_operator_check(const struct rc_shape *shape,
                                 const struct rc_operator_options *options, struct rc_err *err);
/* The frame that it would use. */
struct rc_frame rc_operator_frame(const struct rc_shape *shape,
                                  const struct rc_operator_options *options);
/* The engine that it would use, and why; "" when there is none of that name. */
const char *rc_operator_engine(const struct rc_shape *shape,
                               const struct rc_operator_options *options, const char **reason);
/* Seconds of one K p within a solve, as rc_conv_seconds. */
double rc_operator_seconds(const struct rc_shape *shape, const struct rc_operator_options *options);

/* Adds a diagonal D >= 0, m/Pa, to K, in place of the last one: a layer without lateral stiffness, displaced
 * by D p. D is `plus`, times part[k] of each node held here unless `part` is NULL; the caller keeps `part`.
 * It applies to everything above and below, except that the inverse has the typical D everywhere. It also
 * adds the motion of whole rows: `row`, 1/Pa, times the integral of p along the row. Where both are 0, the
 * results have the same bytes as without this call. RC_FAIL when memory is short. */
enum rc_status rc_operator_set_diagonal(struct rc_operator *op, double plus, const double *part,
                                        double row, struct rc_err *err);
/* Finds the motion of the rows under a pressure, for rc_operator_own_motion. */
void rc_operator_sink(struct rc_operator *op, const double *p);
/* D of node k, m/Pa. */
static inline double
rc_operator_own(const struct rc_operator *op, size_t k)
{
    return op->soft.part == NULL ? op->soft.plus : op->soft.own * op->soft.part[k];
}
/* Motion of node k under the pressure p on it, m, without that of the bodies. */
static inline double
rc_operator_own_motion(const struct rc_operator *op, size_t k, double p)
{
    return rc_operator_own(op, k) * p +
           (op->soft.sunk == NULL ? 0 : op->soft.sunk[k / op->shape.nx]);
}
/* The smallest and the largest D of all nodes, m/Pa. */
void rc_operator_own_range(const struct rc_operator *op, double *lowest, double *highest);
/* Below this D, in dx / E*, the stiffness of the shortest waves hides the diagonal. */
#define RC_LEAST_OWN 0.15
/* The factor `inverse` becomes that of K + plus I, with the motion of rows. */
void rc_operator_set_inverse(struct rc_operator *op, double plus);

/* u = K p, in m and Pa, in double precision; only where op->exact. */
void rc_operator_apply(struct rc_operator *op, const double *p, double *u);
/* u = K' p row by row: `in` writes the rows of p (floats), `out` reads those of u. Costs op->row_cost. */
void rc_operator_apply_rows(struct rc_operator *op, rc_row *in, rc_row *out, void *ctx);
/* The inverse grows as A(q) ~ q^a. Returns a at wave number q, in 1/unit of lengths: 1 on uniform bodies, up
 * to 4 where a coating bends. */
double rc_operator_power(const struct rc_operator *op, double q);
/* Several convolutions in sequence, with rows[k] between factor k - 1 and k, as rc_fft_chain. Each factor
 * costs op->factor_cost. */
void rc_operator_chain(struct rc_operator *op, size_t n, const struct rc_spectrum *const *factors,
                       rc_row *const *rows, void *ctx);
/* The same with the frame: rows are those of rc_fft_new_framed. */
void rc_operator_chain_framed(struct rc_operator *op, size_t n,
                              const struct rc_spectrum *const *factors, rc_row *const *rows,
                              void *ctx);

/* ---- K and its inverse on the whole transformed grid: whole.c ---- */

/* A grid that is padded along the free axes, with the map in its upper left corner: the map itself where both
 * axes repeat. On this grid K
 * is a circulant and its inverse A exact: a displacement of the whole grid belongs to one pressure. All
 * fields are in units of their own: displacements of `length`, pressures of `modulus`. */
struct rc_whole {
    struct rc_shape map, grid; /* in m                                                       */
    struct rc_rows rows;       /* rows of the grid held here                                 */
    struct rc_boundary boundary;
    int threads;
    double length;   /* m: sqrt(dx dy)                                                    */
    double modulus;  /* Pa: E* as the roughness feels it                                  */
    double diagonal; /* displacement of a node under unit pressure on its own cell        */
    double mean;     /* K times a uniform pressure on the whole grid; 0 where both axes repeat */
    double most;     /* largest eigenvalue of K                                           */
};

/* NULL when a number of the bodies is invalid, no padding makes the inverse of a layered pair positive, or
 * memory is short. Ignores engine and tolerance of the options. */
struct rc_whole *rc_whole_new(const struct rc_shape *shape,
                              const struct rc_operator_options *options, struct rc_err *err);
void rc_whole_free(struct rc_whole *whole); /* NULL is allowed */
/* E* of the pair for waves as short as the roughness of this grid, Pa, and `diagonal`. */
enum rc_status rc_whole_scales(const struct rc_shape *shape, const struct rc_pair *pair,
                               double *modulus, double *diagonal, struct rc_err *err);
/* u = K p in double precision; p and u, rows of the grid held here, may be the same. */
void rc_whole_apply(struct rc_whole *whole, const double *p, double *u);
/* Adds a uniform stiffness to that of the rough K, which becomes 1/(A + stiffness); 0 restores K. The wave of
 * all nodes keeps its factor where that is 0. A does not change. */
void rc_whole_pin(struct rc_whole *whole, double stiffness);
/* p = A u in double precision with rows of doubles; u = K p and p = A u in single precision with rows of
 * floats. Rows are those of the grid held here, row 0 is the first of them. */
enum rc_whole_factor {
    RC_WHOLE_INVERSE,
    RC_WHOLE_ROUGH,
    RC_WHOLE_ROUGH_INVERSE
};
void rc_whole_rows(struct rc_whole *whole, enum rc_whole_factor which, rc_row *in, rc_row *out,
                   void *ctx);

#endif
