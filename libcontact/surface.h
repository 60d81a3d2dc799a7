/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Surfaces: maps of heights are made, levelled, filtered, filled, resampled, added and measured, and patches
 * of contact counted. This header comes with contact.h and needs nothing but grid.h.
 */
#ifndef RC_SURFACE_H
#define RC_SURFACE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "grid.h"

#ifdef __cplusplus
extern "C" {
#endif

struct rc_ranks; /* processes that share the map: contact.h */

/* ---- synthetic surfaces ---- */

/* Heights of a sphere of radius R (m): the parabola -r^2 / 2R about the middle of the map, as in Hertz's
 * theory. */
RC_API void rc_synth_sphere(const struct rc_shape *shape, double radius, double *h);

/* A position, m from the middle of the map, y down the picture: apex of an indenter, end of a profile. */
struct rc_place {
    double x, y;
};

/* The height is -s^2 / 2 radius_1 - t^2 / 2 radius_2 about the apex (m). s runs along `direction`, in degrees
 * counterclockwise from x with row 0 at the top, and t across it. A radius of INFINITY makes a cylinder with
 * its axis along that direction. */
RC_API void rc_synth_paraboloid(const struct rc_shape *shape, struct rc_place apex, double radius_1,
                                double radius_2, double direction, double *h);
/* -slope r about the apex. */
RC_API void rc_synth_cone(const struct rc_shape *shape, struct rc_place apex, double slope,
                          double *h);
/* A flat circular end of this radius at height 0, surrounded by -height (m). With an edge (m, > 0) the flank
 * begins as -(r - radius)^2 / 2 edge. Nodes on the rim belong to the end. */
RC_API void rc_synth_punch(const struct rc_shape *shape, struct rc_place apex, double radius,
                           double edge, double height, double *h);

/* amplitude * cos(2 pi x / wavelength_x) * cos(2 pi y / wavelength_y), with a crest at the middle of the map.
 * A wavelength of INFINITY omits its factor. Metres. */
RC_API void rc_synth_wave(const struct rc_shape *shape, double amplitude, double wavelength_x,
                          double wavelength_y, double *h);

/* Self-affine random roughness, periodic over nx dx by ny dy. */
struct rc_selfaffine {
    /* above 0, at most 1: the spectrum decreases as q^(-2-2H) on maps, q^(-1-2H) on profiles */
    double hurst;
    /* wanted RMS about the mean, m; 0 if rms_slope is given */
    double rms_height;
    /* wanted RMS of the magnitude of the gradient; 0 if rms_height is given */
    double rms_slope;
    /* longest wavelength, m; 0: the size of the map */
    double long_cut;
    /* flat spectrum above this wavelength, m; 0: no flat part */
    double rolloff;
    /* shortest wavelength, m, at least two nodes; 0: 2 max(dx, dy) */
    double short_cut;
    /* the same seed gives the same waves on every grid of the same size in m */
    uint64_t seed;
    /* ratio of the wavelengths along and across the lay that have equal power, at least 1; 0: 1 */
    double anisotropy;
    /* direction of the lay, degrees counterclockwise from x, row 0 at the top */
    double direction;
    /* skewness of a gamma distribution of heights, at most RC_SKEWNESS_MAX in magnitude; 0:
     * Gaussian */
    double skewness;
    /* heights of a Weibull distribution of this shape, from RC_WEIBULL_MIN to RC_WEIBULL_MAX; 0:
     * Gaussian */
    double weibull;
    /* 0: all */
    size_t threads;
    /* processes that share the map; NULL: none */
    const struct rc_ranks *ranks;
};
#define RC_SKEWNESS_MAX 3.0
#define RC_WEIBULL_MIN 0.75
#define RC_WEIBULL_MAX 100.0
/* h: the map, or this rank's rows of it, with the bits of one process. Gaussian Fourier amplitudes with
 * random phases, drawn once for each wave vector, without waves of exactly
 * two nodes. The mean is 0. The gradient comes from the waves, not from differences of nodes. A
 * distribution that is not Gaussian replaces the heights by rank; the amplitudes of the waves then stay
 * nearly Gaussian (Perez-Rafols and Almqvist 2019). RC_FAIL when a value is out of range, no wave of the map
 * lies between the cut-offs, memory is short, or heights
 * that are not Gaussian are wanted of several ranks. Switches off GSL's error handler, which belongs to the
 * process, during the call. */
RC_API enum rc_status rc_synth_selfaffine(const struct rc_shape *shape,
                                          const struct rc_selfaffine *what, double *h,
                                          struct rc_err *err);

/* ---- surfaces: forms, filters, outliers, holes ---- */

enum {
    RC_DEGREE_MAX = 20
};
enum rc_form_kind {
    /* a polynomial of total degree `degree` in x and y; on a profile, in the coordinate along it */
    RC_POLYNOMIAL,
    /* exact, of either sign, with its apex anywhere; on a profile a circle */
    RC_SPHERE,
    /* exact, of either sign, in any direction and tilt; on a profile a circle */
    RC_CYLINDER
};
struct rc_form {
    enum rc_form_kind kind;
    /* at most RC_DEGREE_MAX */
    size_t degree;
    /* weights (1 - (r/c)^2)^2 of the residuals r, c = 4.4478 times the median of |r|, iterated
     * until c converges (Beaton and Tukey 1974; ISO 16610-31) */
    bool robust;
    /* 0: all */
    size_t threads;
};
/* Subtracts the form that fits the measured points (not NaN) best, by least squares in z. The radius of a
 * sphere or a cylinder, m, is positive for a bump and negative for a hollow, NAN for a polynomial; radius may
 * be NULL. RC_FAIL when there are fewer points than unknowns, or their positions do not determine the form.
 * Also when no sphere or cylinder covers them all, one is infinite, or memory is short. h is then unchanged.
 * Switches off GSL's error handler, which belongs to the process, during the call. */
RC_API enum rc_status rc_detrend_form(const struct rc_shape *shape, const struct rc_form *form,
                                      double *h, double *radius, struct rc_err *err);

/* Heights (m) that are not in memory. */
struct rc_row_source {
    void *ctx;
    /* the next row to read is the first one; called before each of several passes */
    enum rc_status (*again)(void *ctx, struct rc_err *err);
    /* get(ctx, n, v, err) reads the next n rows to v */
    enum rc_status (*get)(void *, size_t, double *, struct rc_err *);
    /* put(ctx, n, v, err) takes the next n rows of the result, during the last pass */
    enum rc_status (*put)(void *, size_t, const double *, struct rc_err *);
};
/* rc_detrend_form with the same results for a polynomial that is not robust, in the memory of some rows.
 * RC_FAIL also when the source fails, with its sentence. */
RC_API enum rc_status rc_detrend_source(const struct rc_shape *shape, const struct rc_form *form,
                                        const struct rc_row_source *source, struct rc_err *err);

/* Levels each row separately, for scan lines. Degree 0 subtracts the median of the row; 1 or 2 subtract its
 * best straight line or parabola. The fit is by least squares, or with the weights of struct rc_form if
 * `robust`. A row with fewer than twice as many points as coefficients is levelled by its median, an empty
 * row is not changed. RC_FAIL when the degree is above 2, a height is infinite, or memory is short: some rows
 * may then be levelled. */
RC_API enum rc_status rc_detrend_rows(const struct rc_shape *shape, size_t degree, bool robust,
                                      double *h, struct rc_err *err);

/* The Gaussian regression filter of order 0 over the measured points: ISO 16610-61, for profiles 16610-21. A
 * missing point stays missing and has no weight; along a free axis the map ends at its edges. */
struct rc_filter {
    /* m, wavelength with 50 % transmission */
    double cutoff;
    /* high-pass: the input minus its low-pass */
    bool high;
    /* ISO 16610-71, 16610-31: weights (1 - (r/c)^2)^2 of the residuals r, c = 4.4478 times the
     * median of |r|, iterated until c converges */
    bool robust;
    /* the filter continues at the opposite edge along an axis that repeats */
    struct rc_boundary boundary;
    /* 0: all */
    size_t threads;
};
/* RC_FAIL when the cut-off is below two nodes or longer than the map. Also when no point is measured, a
 * height is infinite, or memory is short. h is then unchanged. */
RC_API enum rc_status rc_filter(const struct rc_shape *shape, const struct rc_filter *what,
                                double *h, struct rc_err *err);

/* Sets a point to missing if it differs too much from the median of the others in the 5 x 5 nodes around it.
 * The limit is `times` times the spread. *count is the number of such points. The spread is 1.4826 times the
 * median absolute deviation of all such differences, which is the standard deviation for Gaussian noise.
 * Missing neighbours and, along a free axis, those beyond the edges do not count; a point without
 * neighbours is kept. RC_FAIL when `times` is not positive, a height is infinite, or memory is short; h is
 * then unchanged. */
RC_API enum rc_status rc_outliers(const struct rc_shape *shape, double times,
                                  struct rc_boundary boundary, size_t threads, double *h,
                                  size_t *count, struct rc_err *err);
/* Sets spikes to missing: single nodes and groups of up to 9 (2 on a profile) that stand alone against their
 * neighbours, upwards or downwards. Grooves and ridges stay. The height of a group is the drop
 * from its top to the level at which it grows beyond 9 nodes. It must exceed `times` times the spread of
 * rc_outliers, and as many times the RMS, in the 9 x 9 nodes around its top, of the differences that
 * rc_outliers computes, without such groups. *count is the number of removed nodes. RC_FAIL as
 * rc_outliers. */
RC_API enum rc_status rc_spikes(const struct rc_shape *shape, double times,
                                struct rc_boundary boundary, size_t threads, double *h,
                                size_t *count, struct rc_err *err);

/* Blends the outer `width` (m) of the map into the mean of all heights. In each direction it multiplies the
 * difference from the mean by (1 - cos(pi s / width)) / 2, s the distance of the node from the edge. The map
 * can then be repeated without a step. RC_FAIL when the width is below a node or above half of the map. Also
 * when no height is measured, one is infinite, or memory is short. h is then unchanged. */
RC_API enum rc_status rc_taper(const struct rc_shape *shape, double width, double *h,
                               struct rc_err *err);
/* Columns and rows on each side that a taper of this width (m) changes. */
RC_API void rc_taper_frame(const struct rc_shape *shape, double width, size_t *columns,
                           size_t *rows);

/* Replaces missing values (NaN) by the solution of Laplace's equation. Boundary values are the measured
 * values around them, with zero slope across the edge of the map. *filled is the number of replaced values.
 * RC_FAIL when no value is measured, one is infinite, or memory is short. */
RC_API enum rc_status rc_inpaint(const struct rc_shape *shape, double *h, size_t *filled,
                                 struct rc_err *err);

/* Width of the widest hole in m: twice the largest distance, node to node, of a missing value (NaN) from the
 * nearest measured one. A single missing node has 2 min(dx, dy), a disc its diameter. A hole at the edge of
 * the map counts as if it continued as far beyond the edge. 0 where nothing is missing, INFINITY where
 * everything is. Exact but for rounding; takes 4 bytes a node. RC_FAIL when memory is short. */
RC_API enum rc_status rc_hole_width(const struct rc_shape *shape, const double *h, double *width,
                                    struct rc_err *err);

/* ---- surfaces: resampling, cutting, adding ---- */

/* Relative difference below which spacings count as equal. */
#define RC_SAME_SPACING 1e-6

/* Computes means of v, which is constant in the cells of `from`, over the cells of `to`. Both grids
 * have the same area and any numbers of nodes; the spacings are ignored. The integral is preserved. It brings
 * heights to a coarser grid, and pressures back. If v is partly missing (NaN), the mean is over the rest of
 * the cell; a cell is missing if less than half of it is measured. v and out do not overlap. */
RC_API void rc_resample_means(const struct rc_shape *from, const double *v,
                              const struct rc_shape *to, double *out);

/* The grid of spacings dx, dy (m) for rc_resample: as many whole cells as fit in the map, with the same
 * middle. An axis whose spacing does not change keeps its nodes; a single row stays one, of the new width.
 * RC_FAIL when a spacing is not positive or wider than the map, or there are too many nodes. */
RC_API enum rc_status rc_resample_shape(const struct rc_shape *from, double dx, double dy,
                                        struct rc_shape *to, struct rc_err *err);
/* Whether the cells of `to` cover the map `from` completely along this axis, within RC_SAME_SPACING; a map
 * that repeats along it still does then. */
RC_API bool rc_resample_covers(const struct rc_shape *from, const struct rc_shape *to,
                               enum rc_map_axis axis);
/* v on the grid `to`, with the same middle. Along an axis with larger cells: means over their area,
 * missing (NaN) where less than half of it is measured. Along an axis with smaller cells it is cubic
 * convolution with six nodes (Keys 1981), exact for cubic polynomials and smooth to the first
 * derivative. It wraps along an axis that repeats; along a free axis a parabola extrapolates the map.
 * Near a missing value it is bilinear, closer constant in the old cell, and missing in a missing cell.
 * Equal cells are copied. v and out do not overlap. RC_FAIL when `to` exceeds the map or memory is
 * short. The memory is another map if one axis becomes coarser and the other finer, otherwise a few
 * rows. */
RC_API enum rc_status rc_resample(const struct rc_shape *from, const double *v,
                                  struct rc_boundary boundary, const struct rc_shape *to,
                                  double *out, struct rc_err *err);

/* The to->nx by to->ny values from column `left` and row `top` on; out may be v. With NULL for v only checks
 * them. RC_FAIL when they exceed the map. */
RC_API enum rc_status rc_crop(const struct rc_shape *from, const double *v, size_t left, size_t top,
                              const struct rc_shape *to, double *out, struct rc_err *err);
/* Reverses left and right (axis 'x') or top and bottom ('y'), in place. */
RC_API void rc_mirror(const struct rc_shape *shape, char axis, double *v);
/* Reflection along the axes that `along` repeats: the map is in the upper left, with its images about
 * the right edge (x) and the lower edge (y). This is a period without steps along these axes. A side of
 * one node is not reflected. Rotation: quarter turns counterclockwise, row 0 at the top. *_shape: the
 * resulting shape (an odd number of turns exchanges rows and columns). v and out do not overlap. */
RC_API struct rc_shape rc_reflect_shape(const struct rc_shape *from, struct rc_boundary along);
RC_API void rc_reflect(const struct rc_shape *from, const double *v, struct rc_boundary along,
                       double *out);
RC_API struct rc_shape rc_rotate_shape(const struct rc_shape *from, size_t quarters);
RC_API void rc_rotate(const struct rc_shape *from, const double *v, size_t quarters, double *out);

/* The overlap of two maps placed with equal middles, with the spacings of a. RC_FAIL when spacings differ by
 * more than RC_SAME_SPACING. */
RC_API enum rc_status rc_add_shape(const struct rc_shape *a, const struct rc_shape *b,
                                   struct rc_shape *sum, struct rc_err *err);
/* Two facing surfaces on their overlap (m): ha + hb, b mirrored left to right as seen from a. The larger map
 * is cut evenly; of an odd number of columns or rows one more at its own right or bottom. NaN where either
 * is. out may be ha. RC_FAIL as rc_add_shape. */
RC_API enum rc_status rc_add(const struct rc_shape *a, const double *ha, const struct rc_shape *b,
                             const double *hb, double *out, struct rc_err *err);
/* ha - hb, b not mirrored: the change of a surface. */
RC_API enum rc_status rc_subtract(const struct rc_shape *a, const double *ha,
                                  const struct rc_shape *b, const double *hb, double *out,
                                  struct rc_err *err);

/* How a scan B lies on a scan A of the same surface. B is turned counterclockwise in the picture about its
 * middle, and moved right and down from the middle of A. */
struct rc_alignment {
    /* m */
    double shift_x, shift_y;
    /* rad */
    double rotation;
    /* slopes that are added to B, and the height that is added at the middle of A, m */
    double tilt_x, tilt_y, offset;
    /* m: 1.4826 times the median magnitude of A - B where nothing has changed, of the positive or of the
     * negative differences, whichever is less: wear lies on one side */
    double residual;
    /* m, rad, of 95 %: of the shift in the plane, and of the rotation */
    double shift_error, rotation_error;
    /* m^3: integral of A - B over the overlap, and its uncertainty of 95 % */
    double volume, volume_error;
    /* part of A that lies on B; part of that where A or B is missing; part of the measured rest that differs
     * by more than 3 residuals */
    double overlap, missing, changed;
};
/* A - B on the grid of A (m), NaN where either is missing, with B moved, turned and tilted so that the part
 * that has not changed is 0. Shift, rotation, tilt and offset are fitted with Tukey's biweights, from the
 * peak of a correlation on; patches of 7 x 7 nodes whose mean has changed do not count, or of 3 x 3 nodes
 * where changes are all over the map. Below 1, `below` is the part of the nodes of B that the fit knows: the
 * lowest of the levelled B, as grooves that wear does not reach; each is chosen by the mean of 3 x 3 nodes. At
 * least half of these nodes, of all if below is 1, must be unchanged. B is a cubic spline between its nodes.
 * A and B have the same spacings, and may have different sizes; a quarter of the smaller
 * side must overlap. Rotations up to 12 degrees are found. Profiles are not turned. The volume is that of all
 * nodes and includes the holes of the overlap, where the change follows from the changes around them by
 * rc_inpaint; out is NaN there. The uncertainties contain the noise, with its correlation between neighbours,
 * and the errors of the fit; that of the volume also the pull of changes that are smaller than the noise, the
 * mean noise of the lowest nodes, and for each hole its area times the spread of the changes around it. out is
 * not ha. RC_FAIL as rc_add_shape; also when `below` is not in (0, 1], a side has fewer than 16 nodes, a height
 * is infinite, three quarters are missing, the maps do not fit on each other, or memory is short. Switches off
 * GSL's error handler, which belongs to the process, during the call. */
RC_API enum rc_status rc_align(const struct rc_shape *a, const double *ha, const struct rc_shape *b,
                               const double *hb, double below, size_t threads, double *out,
                               struct rc_alignment *found, struct rc_err *err);

/* ---- figures and sums of maps ---- */

struct rc_statistics {
    /* NaN */
    size_t missing;
    /* +-inf, left out of all other figures, like NaN */
    size_t infinite;
    /* NAN when all values are missing */
    double minimum, maximum, mean;
    /* deviation from the mean (for heights: Sq) */
    double rms;
    /* magnitude of the gradient (Sdq), by forward differences between measured neighbours */
    double rms_slope;
    /* compensated */
    double sum;
};
/* Figures of the measured values, in the unit of v; rms_slope in that unit per metre. */
RC_API void rc_measure(const struct rc_shape *shape, const double *v, struct rc_statistics *result);
/* The same figures of a map that is not in memory, from two passes over a source (its put is not called), in
 * the memory of some rows. RC_FAIL when memory is short or the source fails. */
RC_API enum rc_status rc_measure_source(const struct rc_shape *shape,
                                        const struct rc_row_source *source,
                                        struct rc_statistics *result, struct rc_err *err);

/* Sum of n doubles with the compensation of Neumaier 1974: its error does not grow with n. */
RC_API double rc_sum(const double *v, size_t n);

/* RMS of the gradient's magnitude of the heights h (m) over the nodes in contact, by differences to the next
 * node along each side of the map. rc_in_contact decides from p, a pressure or a map of 1 and 0; p NULL: all
 * nodes. NAN when there is none. Among ranks (NULL: none) h and p are the rows held here. */
RC_API double rc_measure_contact_slope(const struct rc_ranks *ranks, const struct rc_shape *shape,
                                       const double *h, const double *p);

/* Steps across opposite edges of a map, beside those inside it. */
struct rc_seam {
    double inside[2], across[2];
};
/* RMS of the steps between neighbours along x, [0], and along y, [1]. The first pair is inside the map; the
 * second is across the edge, from its last line to its first. NAN along a side of one node. In the unit of v,
 * which holds no NaN. Among ranks (NULL: none) v is the rows held here. */
RC_API void rc_measure_seam(const struct rc_ranks *ranks, const struct rc_shape *shape,
                            const double *v, struct rc_seam *seam);

/* Indices of the smallest and the largest of n values, n > 0; the first of equal ones, and never a NaN. */
RC_API void rc_extremes(size_t n, const double *v, size_t *least, size_t *largest);

/* ---- contact patches ---- */

struct rc_patch_options {
    struct rc_boundary boundary;  /* periodic: patches continue across the edges of the map */
    size_t largest;               /* patches to list, the largest ones; SIZE_MAX: all */
    size_t threads;               /* 0: all */
    const struct rc_ranks *ranks; /* processes that share the map; NULL: none */
};

struct rc_patch {
    size_t nodes;
    double area, perimeter; /* m^2, m */
};

/* Nodes in contact (rc_in_contact of p, a pressure or a map of 1 and 0), joined through their four
 * neighbours. The perimeter is the sum of the edges between a node in contact and one out of contact, without
 * the border of a free map. The corrected area is smaller by (pi - 1 + ln 2)/24 dx dy for each such edge
 * (Yastrebov, Anciaux and Molinari 2017). The reason: a grid counts every node that the edge of the contact
 * crosses. */
struct rc_patches {
    size_t count, contact_nodes;
    /* m^2, m^2, m */
    double contact_area, contact_area_corrected, perimeter;
    /* The largest first; of equal ones that with the first node, row by row. The same on all ranks. NULL if
     * not requested. */
    size_t listed;
    struct rc_patch *patch;
};
/* RC_FAIL when memory is short. Call rc_patches_free in either case. */
RC_API enum rc_status rc_patches_find(const struct rc_shape *shape, const double *p,
                                      const struct rc_patch_options *options,
                                      struct rc_patches *patches, struct rc_err *err);
RC_API void rc_patches_free(struct rc_patches *patches);

/* ---- surface parameters: areal, features, profiles, spectra ---- */

struct rc_surface_options {
    struct rc_boundary boundary; /* periodic: waves and correlations continue across the edges */
    size_t threads;              /* 0: all */
};

/* Parameters of ISO 25178-2 (for a profile of ISO 21920-2 over its whole length), about the mean of the
 * measured points. NAN: undefined. A node stands for its cell. */
struct rc_areal {
    /* m: RMS, mean magnitude */
    double sq, sa;
    /* skewness, kurtosis; undefined for a flat */
    double ssk, sku;
    /* m: highest peak, deepest pit (both positive), and their sum */
    double sp, sv, sz;
    /* RMS gradient from differences of neighbours, each direction separately */
    double sdq;
    /* developed area over its projection, less 1: mean of the triangles along both diagonals of
     * each four nodes */
    double sdr;
    /* m: shortest offset with a correlation of 0.2 */
    double sal;
    /* sal over the longest such offset; NAN where the correlation does not fall to 0.2 in some
     * direction within half the map, and for a profile */
    double str;
    /* degrees, 0 <= std < 180: direction of the strongest waves, from x counterclockwise in the
     * picture; NAN for a profile */
    double std;
    /* m: core height, reduced peak and pit height */
    double sk, spk, svk;
    /* material ratios, as fractions, above and below the core */
    double smr1, smr2;
    /* m, that is m^3/m^2: material volume of peaks and core */
    double vmp, vmc;
    /* and void volume of core and pits; core: 10 % to 80 % */
    double vvc, vvv;
    /* m: height between 2.5 % and 50 % material ratio */
    double sxp;
    /* 1/m: RMS of the mean curvature, half the sum of both second differences (for a profile the
     * second difference itself), over nodes with measured neighbours */
    double rms_curvature;
};
/* h in m; values that are not finite are missing. The line of the material ratio curve is the least-squares
 * line over the 40 % of smallest secant slope (ISO 25178-2, ISO 13565-2). Of equal slopes it is the first.
 * RC_FAIL when a side is too long for a Fourier transform, or memory is short. */
RC_API enum rc_status rc_areal(const struct rc_shape *shape, const double *h,
                               const struct rc_surface_options *options, struct rc_areal *areal,
                               struct rc_err *err);

/* Feature parameters of ISO 25178-2: watershed over eight neighbours, pruned by Wolf's rule at 5 % of Sz,
 * about the mean of the measured points. NAN: undefined, as for a flat, for a map of less than 3 nodes a
 * side, and s5p, s5v for fewer than five. */
struct rc_features {
    /* 1/m^2: peaks and pits, without those at an edge or next to a missing point */
    double spd, svd;
    /* 1/m: mean curvature of these peaks, half the sum of both second differences */
    double spc;
    /* m: mean height of the five highest peaks, depth of the five deepest pits, sum */
    double s5p, s5v, s10z;
    /* m^2: mean area of the hills and dales that touch no edge and no missing point */
    double sha, sda;
};
/* h in m; values that are not finite are missing. RC_FAIL when memory is short. */
RC_API enum rc_status rc_features(const struct rc_shape *shape, const double *h,
                                  const struct rc_surface_options *options,
                                  struct rc_features *features, struct rc_err *err);

/* Parameters of ISO 21920-2, about the mean. NAN: undefined. */
struct rc_profile {
    /* m, m, skewness and kurtosis */
    double ra, rq, rsk, rku;
    /* m: highest peak, deepest pit, their sum, over the whole length */
    double rpt, rvt, rt;
    /* m: the same in each section, then means over the sections */
    double rp, rv, rz;
    /* m: mean spacing and height of the elements. An element is a hill and the following dale,
     * each at least 10 % of rz, from one rising crossing of the mean line to the next. NAN: none
     * is complete */
    double rsm, rc;
    /* RMS slope by the seven-point formula; NAN: fewer points */
    double rdq;
    size_t elements;
};
/* Takes n heights z (m), a step (m) apart, in this number of sections (usually 5). RC_FAIL when one is
 * missing or there are fewer heights than sections. */
RC_API enum rc_status rc_profile_measure(size_t n, double step, const double *z, size_t sections,
                                         struct rc_profile *profile, struct rc_err *err);
/* n heights along the line between two positions on a map, both included, by cubics through the nodes; NAN
 * where a needed node is missing. Beyond the map the heights of its edge continue. */
RC_API void rc_profile_along(const struct rc_shape *shape, const double *h, struct rc_place from,
                             struct rc_place to, size_t n, double *z);

struct rc_psd_options {
    struct rc_boundary boundary;
    /* a name of rc_window_name; NULL: none for a map that repeats along both axes, else hann */
    const char *window;
    /* m: range of the fit of the Hurst exponent; both 0: where the spectrum follows a power law */
    double shortest, longest;
    /* NULL, or nx ny values: the spectrum itself, m^4, wave number 0 at node (nx/2, ny/2), 2
     * pi/(nx dx) rad/m from column to column */
    double *map;
    /* 0: all */
    size_t threads;
};

/* Power spectral density |FFT|^2 dx dy/(nx ny), averaged over rings of wave numbers. A ring is as wide as the
 * lowest wave number (Persson et al. 2005, J. Phys. Condens. Matter 17, R1; Jacobs, Junge and Pastewka 2017,
 * Surf. Topogr. 5, 013001: C^iso, for a profile C^1D), without the mean. Its sum over all waves, over the
 * area of the map, is Sq^2. With a window w it is |FFT(w h)|^2 dx dy/(nx ny)/mean(w^2), as in Gwyddion and
 * SurfaceTopography. Its sum is then the mean square in the window: Sq^2 on average for statistically
 * homogeneous surfaces. The window is applied along each side, to heights less their mean weighted with
 * it; if the map repeats along one axis, along the other side only. */
struct rc_psd {
    size_t rings;
    /* rad/m: mean over the waves of a ring */
    double *q;
    /* m^4; for a profile m^3 */
    double *c;
    /* number of waves in a ring, opposite ones both counted: at least one */
    size_t *modes;
    /* its name */
    const char *window;
    /* m^2: sum of c over all waves, over the area of the map */
    double sum;
    /* m^2: Sq^2, of the heights themselves */
    double mean_square;
    /* H of c ~ q^(-2-2H), for a profile q^(-1-2H); NAN: no power law */
    double hurst;
    /* its standard error */
    double hurst_error;
    /* m: the range of its fit; NAN: none */
    double shortest, longest;
};
/* Name of window k = 0, 1, ...: none, hann, hamming, blackman; NULL past the last. */
RC_API const char *rc_window_name(size_t k);
/* NULL when a height is missing or infinite, or the range is invalid or holds too few waves. Also when a side
 * is too long for a Fourier transform, or memory is short. */
RC_API struct rc_psd *rc_psd_new(const struct rc_shape *shape, const double *h,
                                 const struct rc_psd_options *options, struct rc_err *err);
RC_API void rc_psd_free(struct rc_psd *psd);

#ifdef __cplusplus
}
#endif

#endif
