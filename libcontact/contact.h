/*
 * The verbs of libcontact: contact of rough surfaces on elastic half-spaces.
 *
 * Physics on arrays: nothing here reads or writes files, prints, or keeps state between calls, but for
 * the memory budget of grid.h.
 * Arrays hold nx*ny doubles in the layout of grid.h. Everything is SI: metres, pascals, newtons.
 * Pressure is compression positive, displacement positive into the body, heights positive towards
 * the other body, stresses tension positive, depth positive below the surface. On the free
 * (non-periodic) half-space a pressure value is constant in its cell.
 *
 * Makers return NULL, doers RC_FAIL, when they fail; *err then holds the reason in one sentence.
 *
 * In a struct of options 0, or NULL, is the default of every field, so that
 *
 *     struct rc_problem problem = {.pair.estar = 114e9, .load = 240};
 *
 * is whole, and stays so when fields are added. Figures that are not known are NAN. Arrays stay the
 * caller's; what has to outlive a call is copied, except where a comment says that the caller keeps it.
 */
#ifndef RC_CONTACT_H
#define RC_CONTACT_H

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "grid.h"
#include "model.h"

#ifdef __cplusplus
extern "C" {
#endif

struct rc_conv;   /* one influence kernel on one grid, ready to be applied */
struct rc_solver; /* one contact problem being iterated                    */
struct rc_stress; /* one pressure map whose stress slices are asked for    */
struct rc_ranks;  /* processes that share a map: contact_mpi.h; NULL: none */

/* The messages of all processes that share maps, added up. */
struct rc_sent {
    size_t exchanges;       /* of whole maps: rows to columns, or back           */
    double messages, bytes; /* of these                                          */
    double other_bytes;     /* of sums, rows beside those held, coarser grids    */
    double seconds;         /* in exchanges of maps, of the process that took most */
};

/* Version of the library, "0.1.0". */
RC_API const char *rc_version(void);
/* Processors this process may use, at least 1. */
RC_API size_t rc_threads_available(void);

/* ---- tables: engines and methods ---- */

/* Rows of the tables, k = 0, 1, ...; NULL past the last. The words of an option are made from
 * them. */
struct rc_engine_info { /* how sums are done */
    const char *name, *summary;
    bool periodic; /* on periodic boundaries too                                               */
    bool mixed;    /* methods may iterate with it in single precision                          */
    bool precise;  /* the engine of the row before it, in double precision throughout          */
    int order;     /* its time grows as the number of nodes to this power                      */
};
struct rc_method_info { /* how the contact is iterated; the first is the one that "auto" takes */
    const char *name, *summary;
    bool mixed; /* iterates in single precision where the engine allows it                     */
};
RC_API const struct rc_engine_info *rc_engine_info(size_t k);
RC_API const struct rc_method_info *rc_method_info(size_t k);

/* ---- surfaces: synth.c ---- */

/* Heights of a sphere of radius R (m), -r^2 / 2R about the middle of the map: the parabola that
 * Hertz's theory means by a sphere. */
RC_API void rc_synth_sphere(const struct rc_shape *shape, double radius, double *h);

/* Where the apex of an indenter stands, or a profile ends, m from the middle of the map, y down the
 * picture. */
struct rc_place {
    double x, y;
};

/* -s^2 / 2 radius_1 - t^2 / 2 radius_2 about the apex (m), s along `direction`, in degrees
 * counterclockwise from x with row 0 at the top, t across. An INFINITY for a radius makes a cylinder
 * whose axis lies along it. */
RC_API void rc_synth_paraboloid(const struct rc_shape *shape, struct rc_place apex, double radius_1,
                                double radius_2, double direction, double *h);
/* -slope r about the apex. */
RC_API void rc_synth_cone(const struct rc_shape *shape, struct rc_place apex, double slope,
                          double *h);
/* A flat circular end of this radius at height 0, and -height around it (m); with an edge (m, above
 * 0) the flank begins as -(r - radius)^2 / 2 edge. Nodes on the rim belong to the end. */
RC_API void rc_synth_punch(const struct rc_shape *shape, struct rc_place apex, double radius,
                           double edge, double height, double *h);

/* amplitude * cos(2 pi x / wavelength_x) * cos(2 pi y / wavelength_y), with a crest at the middle
 * of the map; an INFINITY for a wavelength leaves its factor out. Metres. */
RC_API void rc_synth_wave(const struct rc_shape *shape, double amplitude, double wavelength_x,
                          double wavelength_y, double *h);

/* Self-affine random roughness, periodic over nx dx by ny dy. */
struct rc_selfaffine {
    double hurst;      /* above 0, at most 1: the spectrum falls as q^(-2-2H) on maps, q^(-1-2H)
                          on profiles                                                           */
    double rms_height; /* asked RMS about the mean, m; 0 when rms_slope is given              */
    double rms_slope;  /* asked RMS of the gradient's magnitude; 0 when rms_height is given   */
    double long_cut;   /* longest wavelength, m; 0: the map itself                            */
    double rolloff;    /* flat for wavelengths above this one, m; 0: no flat part             */
    double short_cut;  /* shortest wavelength, m, at least two nodes; 0: 2 max(dx, dy)        */
    uint64_t seed;     /* the same seed gives the same waves on every grid of the same size in m */
    double anisotropy; /* waves along the lay are so many times as long as those of the same power
                          across it, at least 1; 0: 1                                           */
    double direction;  /* of the lay, degrees counterclockwise from x, row 0 at the top         */
    double skewness;   /* heights of a gamma distribution, at most RC_SKEWNESS_MAX in size; 0:
                          Gaussian ones                                                         */
    double weibull;    /* heights of a Weibull distribution of this shape, from RC_WEIBULL_MIN to
                          RC_WEIBULL_MAX; 0: not                                                */
};
#define RC_SKEWNESS_MAX 3.0
#define RC_WEIBULL_MIN 0.75
#define RC_WEIBULL_MAX 100.0
/* Gaussian Fourier amplitudes with random phases, one draw for each wave vector; waves of exactly
 * two nodes are left out. The mean is 0. The gradient is that of the waves, not of differences
 * between nodes. Another distribution is given to the heights by rank; the waves then have nearly
 * the amplitudes of Gaussian heights (Perez-Rafols and Almqvist 2019). RC_FAIL when a value is out
 * of its bounds, no wave of the map lies between the cut-offs, or memory is short. GSL's error
 * handler, which belongs to the process, is off during the call. */
RC_API enum rc_status rc_synth_selfaffine(const struct rc_shape *shape,
                                          const struct rc_selfaffine *what, double *h,
                                          struct rc_err *err);

/* ---- surfaces: forms, filters, outliers, holes ---- */

enum {
    RC_DEGREE_MAX = 20
};
enum rc_form_kind {
    RC_POLYNOMIAL, /* of total degree `degree` in x and y; on a profile in the one that varies   */
    RC_SPHERE,     /* exact, of either sign, its apex anywhere; on a profile a circle            */
    RC_CYLINDER    /* exact, of either sign, in any direction and tilt; on a profile a circle    */
};
struct rc_form {
    enum rc_form_kind kind;
    size_t degree;  /* at most RC_DEGREE_MAX                                                      */
    bool robust;    /* weights (1 - (r/c)^2)^2 of what is left, r, with c = 4.4478 times the median
                      of |r|, anew until c stays (Beaton and Tukey 1974; ISO 16610-31)           */
    size_t threads; /* 0: all                                                                     */
};
/* Subtracts the form that fits best, by least squares in z, the points that are there (not NaN).
 * The radius of a sphere or a cylinder, m, is positive for a bump and negative for a hollow; NAN of
 * a polynomial; radius may be NULL. RC_FAIL when there are fewer points than unknowns, their places
 * do not determine the form, no sphere or cylinder is above them all, one is infinite, or memory is
 * short; h is then as it was. GSL's error handler, which belongs to the process, is off during the
 * call. */
RC_API enum rc_status rc_detrend_form(const struct rc_shape *shape, const struct rc_form *form,
                                      double *h, double *radius, struct rc_err *err);

/* Levels each row by itself, as scan lines want it: subtracts the median of a row (degree 0), or the
 * straight line or parabola that fits it best (1 or 2: by least squares, or with weights as in struct
 * rc_form where `robust`). A row of less than twice as many points as the polynomial has coefficients
 * is levelled by its median, one without a point stays. RC_FAIL when the degree is above 2, a height is
 * infinite, or memory is short: rows may have been levelled by then. */
RC_API enum rc_status rc_detrend_rows(const struct rc_shape *shape, size_t degree, bool robust,
                                      double *h, struct rc_err *err);

/* The Gaussian regression filter of order 0 over the points that are there: ISO 16610-61, of
 * profiles 16610-21. A missing point stays missing and has no weight; beyond a map that is not
 * periodic nothing has any. */
struct rc_filter {
    double cutoff;  /* wavelength of which half gets through, m                                  */
    bool high;      /* the input less its low-pass, instead of that                              */
    bool robust;    /* ISO 16610-71, 16610-31: points off the low-pass are weighted by
                      (1 - (r/c)^2)^2, c = 4.4478 times the median of |r|, anew until c stays  */
    bool periodic;  /* goes on at the other side of the map                                      */
    size_t threads; /* 0: all                                                                   */
};
/* RC_FAIL when the cut-off is below two nodes or longer than the map, nothing is there, a height is
 * infinite, or memory is short; h is then as it was. */
RC_API enum rc_status rc_filter(const struct rc_shape *shape, const struct rc_filter *what,
                                double *h, struct rc_err *err);

/* Makes points missing that lie further than `times` times the spread from the median of the others
 * in the 5 x 5 nodes around them; *count counts them. The spread is 1.4826 times the median
 * absolute deviation of all such differences, for Gaussian noise its standard deviation. Missing
 * neighbours and, unless the map is periodic, those beyond it do not count; a point without any
 * stays. RC_FAIL when `times` is not positive, a height is infinite, or memory is short; h is then
 * as it was. */
RC_API enum rc_status rc_outliers(const struct rc_shape *shape, double times, bool periodic,
                                  size_t threads, double *h, size_t *count, struct rc_err *err);

/* Leads the outer `width` (m) of the map to the mean of all heights: the difference from the mean
 * is multiplied by (1 - cos(pi s / width)) / 2 for either direction, s being the distance of the
 * node from the edge. The map can then be repeated without a step. RC_FAIL when the width is below
 * a node or above half of the map, no height is there, one is infinite, or memory is short; h is
 * then as it was. */
RC_API enum rc_status rc_taper(const struct rc_shape *shape, double width, double *h,
                               struct rc_err *err);
/* Columns and rows on each side that a taper of this width (m) changes: nodes that are nearer to
 * the edge. */
RC_API void rc_taper_frame(const struct rc_shape *shape, double width, size_t *columns,
                           size_t *rows);

/* Gives every missing value (NaN) the solution of Laplace's equation with the measured ones around
 * it as boundary values and no slope across the edge of the map; *filled counts them. RC_FAIL when
 * nothing was measured, a value is infinite, or memory is short. */
RC_API enum rc_status rc_inpaint(const struct rc_shape *shape, double *h, size_t *filled,
                                 struct rc_err *err);

/* Width of the widest hole in m: twice the largest distance of a missing value (NaN) from the nearest
 * one that is there, node to node: 2 min(dx, dy) for a single missing node, and for a disc its
 * diameter. A hole at the edge of the map has its rim on one side only, and counts as if it went on
 * as far beyond. 0 where nothing is missing, INFINITY where nothing is there. Exact but for rounding;
 * takes 4 bytes a node. RC_FAIL when memory is short. */
RC_API enum rc_status rc_hole_width(const struct rc_shape *shape, const double *h, double *width,
                                    struct rc_err *err);

/* ---- surfaces: resample.c, geometry.c ---- */

/* Spacings that differ by less than this, relative, count as equal. */
#define RC_SAME_SPACING 1e-6

/* Means of v, which is constant in the cells of `from`, over the cells of `to`, a grid of any other
 * number of nodes on the same area: their spacings are not looked at. The integral stays what it
 * is. Heights are taken to a coarser grid this way, and pressures back. Where v is missing (NaN)
 * the mean is that of the rest of the cell; where less than half of the cell is left, it is missing
 * too. v and out do not overlap. */
RC_API void rc_resample_means(const struct rc_shape *from, const double *v,
                              const struct rc_shape *to, double *out);

/* The grid of spacings dx, dy (m) that rc_resample fills: as many whole cells as fit in the map,
 * middle on middle. An axis whose spacing stays the same keeps its nodes; a single row stays one,
 * of the new width. RC_FAIL when a spacing is not positive or wider than the map, or the nodes are
 * more than can be counted. */
RC_API enum rc_status rc_resample_shape(const struct rc_shape *from, double dx, double dy,
                                        struct rc_shape *to, struct rc_err *err);
/* Whether the cells of `to` cover the map `from` wholly, within RC_SAME_SPACING: a periodic map
 * stays periodic then. */
RC_API bool rc_resample_covers(const struct rc_shape *from, const struct rc_shape *to);
/* v on the grid `to`, middle on middle. Along an axis where its cells are larger: means over their
 * area, missing (NaN) where less than half of it is measured. Where they are smaller: cubic
 * convolution by six nodes (Keys 1981), exact for cubic polynomials, smooth to the first
 * derivative; it wraps when `periodic`, else the map goes on as a parabola beyond its last node.
 * Next to a missing value it is bilinear, next to that constant in the old cell, and in a missing
 * cell missing. Where cells are as they were, nothing changes. v and out do not overlap. RC_FAIL
 * when `to` reaches beyond the map or memory is short: it takes another map when one axis becomes
 * coarser and the other finer, else a few rows. */
RC_API enum rc_status rc_resample(const struct rc_shape *from, const double *v, bool periodic,
                                  const struct rc_shape *to, double *out, struct rc_err *err);

/* The to->nx by to->ny values from column `left` and row `top` on; out may be v. RC_FAIL when they
 * reach beyond the map. */
RC_API enum rc_status rc_crop(const struct rc_shape *from, const double *v, size_t left, size_t top,
                              const struct rc_shape *to, double *out, struct rc_err *err);
/* Left to right (axis 'x') or top to bottom ('y'), in place. */
RC_API void rc_mirror(const struct rc_shape *shape, char axis, double *v);
/* Reflection: the map in the upper left quarter and its images about the right and the lower edge, a
 * period without a step, on which no slope is added; a side of one node stays as it is. Rotation: quarter
 * turns counterclockwise, row 0 at the top: the shape that comes out (an odd number of them makes rows of
 * columns), and the values. v and out do not overlap. */
RC_API struct rc_shape rc_reflect_shape(const struct rc_shape *from);
RC_API void rc_reflect(const struct rc_shape *from, const double *v, double *out);
RC_API struct rc_shape rc_rotate_shape(const struct rc_shape *from, size_t quarters);
RC_API void rc_rotate(const struct rc_shape *from, const double *v, size_t quarters, double *out);

/* The overlap of two maps that lie middle on middle, with the spacings of a. RC_FAIL when spacings
 * differ by more than RC_SAME_SPACING. */
RC_API enum rc_status rc_add_shape(const struct rc_shape *a, const struct rc_shape *b,
                                   struct rc_shape *sum, struct rc_err *err);
/* Two surfaces face to face on their overlap (m): ha + hb, b mirrored left to right as it is seen
 * from a. The larger map is cut evenly; of an odd number of its columns or rows one more at its
 * own right or bottom. NaN where either is. out may be ha. RC_FAIL as rc_add_shape. */
RC_API enum rc_status rc_add(const struct rc_shape *a, const double *ha, const struct rc_shape *b,
                             const double *hb, double *out, struct rc_err *err);
/* ha - hb, b not mirrored: how a surface has changed. */
RC_API enum rc_status rc_subtract(const struct rc_shape *a, const double *ha,
                                  const struct rc_shape *b, const double *hb, double *out,
                                  struct rc_err *err);

/* ---- figures and sums of maps: measure.c, common.c ---- */

struct rc_statistics {
    size_t missing;                /* NaN                                                */
    size_t infinite;               /* +-inf, left out of the rest like NaN               */
    double minimum, maximum, mean; /* NAN when nothing is there                          */
    double rms;                    /* about the mean (for heights: Sq)                   */
    double rms_slope;              /* magnitude of the gradient (Sdq), forward
                                             differences where both neighbours are there        */
    double sum;                    /* compensated                                        */
};
/* Figures of what is there; h's own unit, rms_slope in that unit per metre. */
RC_API void rc_measure(const struct rc_shape *shape, const double *v, struct rc_statistics *result);

/* Sum of n doubles with the compensation of Neumaier 1974: its error does not grow with n. */
RC_API double rc_sum(const double *v, size_t n);

/* RMS of the gradient's magnitude of the heights h (m) over the nodes in contact (rc_in_contact of p, a
 * pressure or a map of 1 and 0; p NULL: over all), by
 * differences to the next node along each side of the map; NAN when there is none. Where ranks share the
 * map h and p are the rows held here; ranks NULL: none. */
RC_API double rc_measure_contact_slope(const struct rc_ranks *ranks, const struct rc_shape *shape,
                                       const double *h, const double *p);

/* RMS of the steps between neighbours along x, [0], and along y, [1]: inside the map, and from its
 * last line to its first, where the periods of a periodic map meet. NAN along a side of one node.
 * In the unit of v, which holds no NaN. Where ranks share the map v is the rows held here; ranks
 * NULL: none. */
struct rc_seam {
    double inside[2], across[2];
};
RC_API void rc_measure_seam(const struct rc_ranks *ranks, const struct rc_shape *shape,
                            const double *v, struct rc_seam *seam);

/* ---- contact patches: patches.c ---- */

enum rc_boundary {
    RC_FREE,    /* a half-space whose surface goes on, without load, beyond the map            */
    RC_PERIODIC /* the map repeats for ever                                                    */
};

struct rc_patch_options {
    enum rc_boundary boundary; /* periodic: patches go on across the edges of the map           */
    bool each;                 /* fill the list of patches                                      */
    size_t threads;            /* 0: all                                                        */
    const struct rc_ranks *ranks; /* processes that share the map; NULL: none                   */
};

struct rc_patch {
    size_t nodes;
    double area, perimeter; /* m^2, m */
};

/* Nodes in contact (rc_in_contact of p, a pressure or a map of 1 and 0), joined by their four neighbours. The perimeter is made of the edges
 * between a node in contact and one that is not; the border of a free map is none. The corrected area
 * takes off (pi - 1 + ln 2)/24 dx dy for each such edge (Yastrebov, Anciaux and Molinari 2017): a grid
 * counts every node that the edge of the contact passes through. */
struct rc_patches {
    size_t count, contact_nodes;
    double contact_area, contact_area_corrected, perimeter; /* m^2, m^2, m                        */
    struct rc_patch *patch; /* `count` of them, the largest first; NULL when not asked for      */
};
/* RC_FAIL when memory is short. rc_patches_free in either case. */
RC_API enum rc_status rc_patches_find(const struct rc_shape *shape, const double *p,
                                      const struct rc_patch_options *options,
                                      struct rc_patches *patches, struct rc_err *err);
RC_API void rc_patches_free(struct rc_patches *patches);
/* Bytes that it takes beside p. For p NULL, and wherever ranks share the map, about as many as a
 * rough contact takes; among ranks those of the rank that takes most, with the patches of the whole
 * map, which every rank has. */
RC_API size_t rc_patches_memory(const struct rc_shape *shape, const double *p,
                                const struct rc_patch_options *options);

/* ---- what a surface is like: areal.c, material_ratio.c, texture.c, spectrum.c ---- */

struct rc_surface_options {
    enum rc_boundary boundary; /* periodic: waves and correlations go on across the edges        */
    size_t threads;            /* 0: all                                                         */
};

/* The parameters of ISO 25178-2 (of a profile those of ISO 21920-2 over its whole length), about the
 * mean of what is there. NAN: not defined. A node stands for its cell. */
struct rc_areal {
    double sq, sa;     /* m: RMS, mean size                                                       */
    double ssk, sku;   /* skewness, kurtosis; not of a flat                                       */
    double sp, sv, sz; /* m: highest peak, deepest pit (both positive), and their sum             */
    double sdq;        /* RMS gradient: of differences of neighbours, each direction by itself    */
    double sdr;        /* developed area over its projection, less 1: triangles along either
                          diagonal of each four nodes                                             */
    double sal;        /* m: nearest offset whose correlation has fallen to 0.2                   */
    double str;        /* sal over the farthest offset up to which it has not; NAN where it does
                          not fall in some direction within half the map, and of a profile        */
    double std;        /* degrees, 0 <= std < 180: direction of the strongest waves, from x
                          counterclockwise in the picture; not of a profile                       */
    double sk, spk, svk; /* m: core height, reduced peak and pit height              */
    double smr1, smr2;   /* material ratios, as fractions, above and below the core  */
    double vmp, vmc;     /* m, that is m^3/m^2: material volume of peaks and core    */
    double vvc, vvv;     /* and void volume of core and pits; core: 10 % to 80 %     */
    double sxp;          /* m: height between 2.5 % and 50 % material ratio          */
    /* 1/m: RMS of the mean curvature, half the sum of both second differences (of a profile the second
     * difference itself), over nodes whose neighbours are there */
    double rms_curvature;
};
/* h in m; what is not finite was not measured and is left out. The line of the material ratio curve
 * is that of least squares over the 40 % of smallest secant slope (ISO 25178-2, ISO 13565-2), the
 * first of equals. RC_FAIL when a side is too long for a Fourier transform, or memory is short. */
RC_API enum rc_status rc_areal(const struct rc_shape *shape, const double *h,
                               const struct rc_surface_options *options, struct rc_areal *areal,
                               struct rc_err *err);

/* Feature parameters of ISO 25178-2: by watershed over eight neighbours, pruned by Wolf's rule at 5 % of
 * Sz, about the mean of what is there. NAN: not defined, as of a flat and of a map of less than 3 nodes a
 * side; s5p, s5v of less than five. */
struct rc_features {
    double spd,
        svd; /* 1/m^2: peaks and pits, but for those at an edge or beside what was not measured */
    double
        spc; /* 1/m: mean curvature of these peaks, half the sum of both second differences     */
    double s5p, s5v,
        s10z; /* m: mean height of the five highest peaks, depth of the five deepest pits, sum   */
    double sha,
        sda; /* m^2: mean area of hills and dales that reach no edge and nothing not measured   */
};
/* h in m; what is not finite was not measured. RC_FAIL when memory is short. */
RC_API enum rc_status rc_features(const struct rc_shape *shape, const double *h,
                                  const struct rc_surface_options *options,
                                  struct rc_features *features, struct rc_err *err);

/* Parameters of ISO 21920-2, about the mean. NAN: not defined. */
struct rc_profile {
    double ra, rq, rsk,
        rku;             /* m, m, skewness and kurtosis                                         */
    double rpt, rvt, rt; /* m: highest peak, deepest pit, their sum, over the whole length      */
    double rp, rv, rz;   /* m: the same in each section, as means over the sections             */
    double rsm, rc;      /* m: mean spacing and height of the elements: hills and the dales that
                                follow them, each of 10 % of rz at least, from one rising crossing of
                                the mean line to the next; NAN: none is whole                        */
    double rdq;          /* RMS slope by the formula over seven points; NAN: of less             */
    size_t elements;
};
/* Of n heights z (m), a step (m) apart, in so many sections (5 are usual). RC_FAIL when one was not
 * measured or there are fewer heights than sections. */
RC_API enum rc_status rc_profile_measure(size_t n, double step, const double *z, size_t sections,
                                         struct rc_profile *profile, struct rc_err *err);
/* n heights along the line between two places of a map, both included, by cubics through the nodes; NAN
 * where one that is needed was not measured. Beyond the map heights are those at its edge. */
RC_API void rc_profile_along(const struct rc_shape *shape, const double *h, struct rc_place from,
                             struct rc_place to, size_t n, double *z);

struct rc_psd_options {
    enum rc_boundary boundary;
    const char *window;       /* by a name of rc_window_name; NULL: none where the map is periodic,
                                 else hann                                                         */
    double shortest, longest; /* m: waves that the Hurst exponent is fitted to; both 0: those where
                                  the spectrum follows a power law                                */
    double *map;    /* NULL, or room for nx ny values: the spectrum itself, m^4, wave number 0 at
                       node (nx/2, ny/2), 2 pi/(nx dx) rad/m from column to column                */
    size_t threads; /* 0: all                                                                     */
};

/* Power spectral density |FFT|^2 dx dy/(nx ny), averaged over rings of wave numbers as wide as the
 * lowest one (Persson et al. 2005, J. Phys. Condens. Matter 17, R1; Jacobs, Junge and Pastewka 2017,
 * Surf. Topogr. 5, 013001: C^iso, and of a profile C^1D); the mean is no wave. Its sum over all
 * waves, over the area of the map, is Sq^2. Under a window w it is |FFT(w h)|^2 dx dy/(nx
 * ny)/mean(w^2), as Gwyddion and SurfaceTopography have it, and its sum is what the window sees: Sq^2
 * on average over surfaces that are alike everywhere. The window is laid along each side, and heights
 * are counted from their mean weighted with it. */
struct rc_psd {
    size_t rings;
    double *q;     /* rad/m: mean over the waves of a ring                                        */
    double *c;     /* m^4; of a profile m^3                                                       */
    size_t *modes; /* waves, opposite ones both, in a ring: at least one                          */
    const char *window;       /* its name                                                        */
    double sum;               /* m^2: of c over all waves, over the area of the map              */
    double mean_square;       /* m^2: Sq^2, of the heights themselves                            */
    double hurst;             /* of c ~ q^(-2-2H), of a profile q^(-1-2H); NAN: no power law     */
    double hurst_error;       /* its standard error                                              */
    double shortest, longest; /* m: the waves that it was fitted to; NAN: none                   */
};
/* NULL when a height is missing or infinite, the range is none or holds too few waves, a side is too
 * long for a Fourier transform, or memory is short. */
RC_API struct rc_psd *rc_psd_new(const struct rc_shape *shape, const double *h,
                                 const struct rc_psd_options *options, struct rc_err *err);
/* Name of window k = 0, 1, ...: none, hann, hamming, blackman; NULL past the last. */
RC_API const char *rc_window_name(size_t k);
RC_API void rc_psd_free(struct rc_psd *psd); /* NULL is allowed */

/* ---- bodies ---- */

/* A layer of isotropic material, bonded to what is below it. */
struct rc_layer {
    double thickness; /* m, > 0                                                                */
    double e, nu;     /* Young's modulus, Pa, > 0; Poisson's ratio, above -1 and at most 0.5   */
};
/* An elastic half-space, bare or under layers. */
struct rc_body {
    double e, nu;  /* of the half-space; e INFINITY: rigid                                      */
    size_t layers; /* 0: bare                                                                   */
    const struct rc_layer *layer; /* the top one first                                          */
};
/* Material at a depth (m), 0 the top one, `layers` the half-space: an interface belongs to the material
 * above it. */
RC_API size_t rc_body_material(const struct rc_body *body, double depth);

/* The bodies that touch: both, or two bare ones of which only the composite modulus is known. */
struct rc_pair {
    struct rc_body one; /* the one that is analysed                                             */
    struct rc_body two; /* e 0: rigid                                                           */
    double estar; /* Pa, 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2, where `one` and `two` are left
                           out; 0: it follows from them                                         */
};

/* ---- convolution: conv.c ---- */

struct rc_conv_options {
    enum rc_boundary boundary;
    const char *engine; /* a row of engines.list, or NULL or "auto"                              */
    double tol;         /* asked error of u, relative to the sum of |K| |p|; 0: rounding          */
    bool precise; /* in double precision throughout, even where tol would allow less             */
    size_t order, correction; /* of the engine mlms by hand, both or none: t, m_c                */
    size_t memory;  /* bytes that "auto" may take; 0: any                                    */
    double loaded;  /* fraction of nodes that carry pressure, as "auto" may expect; 0: unknown */
    size_t threads; /* 0: all                                                                */
    const struct rc_ranks *ranks; /* processes that share the map; NULL: none                   */
};

/* u = K p: displacement of both bodies together (m) under the pressure p (Pa). With RC_PERIODIC the mean
 * of u is 0: the mean pressure moves a periodic half-space without limit. NULL when a number of the bodies
 * makes no sense, there is no such engine, none for the boundary or the ranks, or memory is short. */
RC_API struct rc_conv *rc_conv_new(const struct rc_shape *shape, const struct rc_pair *pair,
                                   const struct rc_conv_options *options, struct rc_err *err);
/* p and u do not overlap. */
RC_API void rc_conv_apply(struct rc_conv *conv, const double *p, double *u);
/* Name of the engine, and in a few words why it was taken. */
RC_API const char *rc_conv_engine(const struct rc_conv *conv);
RC_API const char *rc_conv_reason(const struct rc_conv *conv);
/* The engine's own bound on the error of u, relative to the sum of |K| |p|. */
RC_API double rc_conv_error(const struct rc_conv *conv);
RC_API void rc_conv_free(struct rc_conv *conv);
/* The engine that such a plan would take, and why; "" when there is none of that name. */
RC_API const char *rc_conv_choice(const struct rc_shape *shape,
                                  const struct rc_conv_options *options, const char **reason);
/* Bytes that such a plan takes beside p and u; 0 when there is no such engine. */
RC_API size_t rc_conv_memory(const struct rc_shape *shape, const struct rc_conv_options *options);
/* Seconds that one such sum takes in a solve, the work of the method around it included:
 * measured on a machine of 2026, and several times off on another. NAN when there is no such
 * engine. */
RC_API double rc_conv_seconds(const struct rc_shape *shape, const struct rc_conv_options *options);

/* ---- solver: solver.c ---- */

struct rc_problem {
    enum rc_boundary boundary;
    struct rc_pair pair; /* the bodies; layers are copied                                        */
    double load;         /* total normal force, N, > 0; with an approach a guess, or 0            */
    double approach;     /* m, > 0: the load is sought that brings the bodies so far together from
                           first touch; 0: the load is given                                     */
    double hardness;     /* upper bound of the pressure, Pa; 0 or INFINITY: none                  */
    const double *hardness_map; /* instead of it, Pa, nx ny, copied: NAN or INFINITY where there is
                                  none; NULL: hardness is that of all nodes                      */
    double height_error; /* m: what the heights may be off, as the shape_error of the solution that
                           left their shape; bears on what counts as yielded only                */
    bool tilt_free;     /* the counter body turns until the pressures have no moment about the point
                           where the load acts; not with RC_PERIODIC                              */
    double force_at[2]; /* m: that point, x and y from the middle of the map                      */
    double tol;         /* asked relative L1 error of the pressure; 0: (nx ny)^(-3/4), but never
                           above 1e-3                                                            */
    double history_part; /* of tol: to this a load of a history is solved in which nodes yield, for
                            what it is off stays in the shape that it leaves; 0: 1 */
    const char *engine;  /* NULL: auto                                                            */
    const char *method;  /* NULL: auto                                                            */
    size_t max_iterations; /* 0: 100 + 10 sqrt(nx ny)                                            */
    size_t threads;      /* 0: all                                                                */
    bool discretization; /* estimate what the grid leaves out: a coarser one is solved as well   */
    const struct rc_ranks *ranks; /* processes that share the map; NULL: none                   */
    /* Where this is not 0, as a signal handler may set it, time is short: a step ends before it moves the
     * pressure, and rc_solver_result takes gap and displacement as the steps have left them, of single
     * precision where their convolutions were. NULL: it never is; nor does it count with ranks, and in
     * problems that a contact is a part of. */
    const volatile sig_atomic_t *hurry;
};

/* Relative errors, or figures, of contact area, largest pressure and approach; NAN: unknown. */
struct rc_discretization {
    double contact_area, max_pressure, approach;
};

/* What has been found, once rc_solver_step gives RC_OK or RC_SHORT, or at any earlier iteration
 * that one wants to stop at. */
struct rc_contact {
    double load, mean_pressure, max_pressure; /* N, Pa, Pa: summed from the pressure itself      */
    size_t contact_nodes, plastic_nodes;      /* p > 0; p = hardness                             */
    /* p = hardness, and a gap that is negative by more than four times what it and the heights may
     * be off: what gives way under this load */
    size_t yielded_nodes;
    double contact_area, contact_fraction; /* m^2, -                                             */
    double plastic_area, yielded_area;     /* m^2                                                */
    double edge_load_fraction;             /* load on the outer 2 % of the map                   */
    /* m, from first touch; NAN when no node is elastic, unless it was sought and suits the contact. Where the
     * counter body is free to tilt, of the point where the load acts, from where a rigid body would stand. */
    double approach;
    double tilt[2];  /* slope of the counter body's face along x and y     */
    double mean_gap; /* m, of max(gap, 0) over the whole map               */
    /* J, of both bodies under the pressure p, which displaces them by u: the integral of p u / 2. On a
     * periodic map above that of the mean pressure, which depends on how thick the bodies are */
    double elastic_energy;
    /* m: the worst violation of gap >= 0 where p = 0, gap = 0 where elastic, gap <= 0 at the
     * hardness, from a fresh convolution */
    double gap_error;
    double shape_error; /* m: what the heights that are left (rc_solver_plastic) may be off    */
    /* the same over max(std h, std u); for one height everywhere over what the mean pressure could
     * displace */
    double kkt_residual;
    /* estimated relative L1 error of the pressure; NAN when stopped on a coarser grid; the part of it that
     * earlier loads of a history have left in the shape */
    double pressure_error, inherited_error;
    size_t iterations;
    double convolutions;                     /* equivalents on the finest grid                   */
    struct rc_discretization discretization; /* estimated relative errors that the grid makes    */
    bool
        converged; /* pressure_error <= tol; the load, or the approach, is the one that was given */
    bool hardness_active; /* some node is at the hardness                     */
};

/* `h` (not NaN, not infinite) is copied. NULL when load > hardness * area, or more
 * than the sum of the hardness map times the cell: the message has both numbers. */
RC_API struct rc_solver *rc_solver_new(const struct rc_shape *shape, const double *h,
                                       const struct rc_problem *problem, struct rc_err *err);
/* One iteration, on coarser grids at first: RC_MORE, RC_OK when the estimated error is below
 * tol, RC_SHORT when it cannot get there (iteration limit, rounding). */
RC_API enum rc_status rc_solver_step(struct rc_solver *solver);
/* Another first loading of the same surface, at a load in N or, with approach > 0, to an
 * approach in m: the last solution is only where it starts. Counts begin anew. RC_FAIL as in
 * rc_solver_new; the solver is then of no further use. */
RC_API enum rc_status rc_solver_set_load(struct rc_solver *solver, double load, double approach,
                                         struct rc_err *err);
/* Another asked relative L1 error of the pressure, above 0, from the next load that is set. The engine stays
 * that of the tolerance of rc_solver_new, which should not be far above this one. */
RC_API void rc_solver_set_tol(struct rc_solver *solver, double tol);
/* Other heights (nx ny m, copied), of any range, under the load or the approach that is set: the same plan
 * and the same memory, nothing is evaluated anew; the last pressure is where it starts. Counts begin anew.
 * RC_FAIL when one is not a finite number, which leaves all as it was, and as in rc_solver_set_load. */
RC_API enum rc_status rc_solver_set_heights(struct rc_solver *solver, const double *h,
                                            struct rc_err *err);
/* Starts from this pressure (nx ny Pa; what leaves the box or the load is put right), as it was
 * left by an earlier solver of the same problem, instead of from coarser grids; load (N) is that
 * of this pressure, which matters where an approach is sought. RC_FAIL after the first step of a
 * load, and as in rc_solver_set_load. */
RC_API enum rc_status rc_solver_warm_start(struct rc_solver *solver, double load, const double *p,
                                           struct rc_err *err);
/* How far it is: the grid that is being iterated, which is a coarser one at first, the
 * iterations on it, the last estimate of the error there (NAN before the first) and the one
 * asked for. */
struct rc_progress {
    struct rc_shape grid;
    bool coarser; /* than the map's own: what it finds there is where the map's own begins */
    size_t iterations;
    double error, tol;
};
RC_API void rc_solver_progress(const struct rc_solver *solver, struct rc_progress *progress);
/* Convolutions so far, in equivalents of one double-precision convolution on this grid; coarser
 * grids and single precision count their share. */
RC_API double rc_solver_convolutions(const struct rc_solver *solver);
/* The load that is set, N: the one given, or the last one tried for an approach. */
RC_API double rc_solver_load(const struct rc_solver *solver);
/* The pressure reached (nx*ny Pa), valid until the next step. */
RC_API const double *rc_solver_pressure(const struct rc_solver *solver);
/* Fresh displacement and gap of that pressure (either may be NULL) and the figures; see `hurry`. */
RC_API void rc_solver_result(struct rc_solver *solver, double *displacement, double *gap,
                             struct rc_contact *contact);
/* The height map (nx*ny m) that is left when the bodies are taken apart: where the hardness was
 * reached, what stood into the other body is gone; known to within shape_error. Pressed again to the same
 * load it carries the same pressure, and nothing more yields. After rc_solver_result. */
RC_API enum rc_status rc_solver_plastic(const struct rc_solver *solver, double *h,
                                        struct rc_err *err);
/* A loading history, where each load acts on the shape that those before it have left, is a list of
 * loads set, stepped to the end and looked at, with this after each: h (nx ny m; in: the heights
 * that were pressed) and the heights of the solver become the shape that is left, known to within
 * contact->shape_error, which `contact` from rc_solver_result holds. Where no node has yielded h
 * stays, and so does the solver. RC_FAIL as in rc_solver_plastic and rc_solver_set_heights. */
RC_API enum rc_status rc_solver_keep_shape(struct rc_solver *solver,
                                           const struct rc_contact *contact, double *h,
                                           struct rc_err *err);
/* The unloaded state of bodies of these heights (nx ny m): gap at first touch. The gap (nx ny m, or
 * NULL; not h itself) and its mean; no pressure, no displacement. `ranks`: processes that share the
 * map; NULL: none. */
RC_API void rc_contact_apart(const struct rc_ranks *ranks, const struct rc_shape *shape,
                             const double *h, double *gap, struct rc_contact *contact);
/* d load / d approach, N/m, at the solution, after rc_solver_result: what the elastic nodes
 * carry more when the bodies come closer, no node changing sides. NAN when none is elastic, and
 * where a periodic surface is in complete contact. Takes 10 to 20 convolutions; RC_FAIL when
 * memory is short. */
RC_API enum rc_status rc_solver_stiffness(struct rc_solver *solver, double *stiffness,
                                          struct rc_err *err);
/* How well the contact conducts heat, or current, from one body to the other, by Barber's analogy
 * (Proc. R. Soc. A 459 (2003) 53): for conductivities k1, k2 of the bodies 2 S/(E* (1/k1 + 1/k2)),
 * S the stiffness were all nodes in contact, those at their hardness too, to come closer together.
 * It is the flow over the difference between potentials far away, on a periodic map between those
 * that the two surfaces have on average. Nothing flows where there is no contact, and there is no
 * film in it. */
struct rc_conductance {
    double stiffness; /* N/m: that S; of rc_solver_stiffness where no node is at its hardness    */
    double value;     /* W/K with k1, k2 in W/(m K); S with S/m                                  */
    double lower; /* no more than that of these nodes; by how much less says how well it is known */
};
/* At the solution, after rc_solver_result. NAN for bodies with layers, for which there is no such
 * analogy, and where a periodic surface is in complete contact. Takes 10 to 20 convolutions;
 * RC_FAIL when a conductivity is not positive and finite, and when memory is short. */
RC_API enum rc_status rc_solver_conductance(struct rc_solver *solver, double k1, double k2,
                                            struct rc_conductance *conductance, struct rc_err *err);
RC_API const char *rc_solver_engine(const struct rc_solver *solver);
RC_API const char *rc_solver_engine_reason(const struct rc_solver *solver);
RC_API const char *rc_solver_method(const struct rc_solver *solver);
RC_API void rc_solver_free(struct rc_solver *solver);
/* Name of the engine that such a solver would take, and why; "" when there is none of that name. */
RC_API const char *rc_solver_choice(const struct rc_shape *shape, const struct rc_problem *problem,
                                    const char **reason);
/* Bytes that a solver of this size takes, its copies of the heights and of the pressure included.
 * As of the other estimates here: beside the caller's arrays, code, and FFTW's plans, 2 to 3 MiB a
 * precision; and where ranks share the map, of the rank that takes most, beside what MPI takes. */
RC_API size_t rc_solver_memory(const struct rc_shape *shape, const struct rc_problem *problem);
/* Bytes that these take beside it, for as long as they run. */
RC_API size_t rc_solver_stiffness_memory(const struct rc_shape *shape,
                                         const struct rc_problem *problem);
RC_API size_t rc_solver_conductance_memory(const struct rc_shape *shape,
                                           const struct rc_problem *problem);

/* Expected cost of such a solver, from benchmark fits: convolutions (in equivalents, as they are
 * counted) and seconds, both NAN where nobody knows, and bytes. RC_FAIL when there would be none,
 * though memory were there: no such engine or method, none for the boundary or the ranks, no solution
 * under the load. */
struct rc_expected {
    double convolutions, seconds;
    size_t memory;
};
RC_API enum rc_status rc_solver_expect(const struct rc_shape *shape,
                                       const struct rc_problem *problem,
                                       struct rc_expected *expected, struct rc_err *err);

/* ---- the elastic model: solver/elastic.c ---- */

/* Figures that cost convolutions. */
struct rc_elastic_asks {
    bool stiffness;
    double
        conductivity[2]; /* of the bodies, as for rc_solver_conductance; both 0: no conductance */
};
struct rc_elastic_figures {
    struct rc_contact contact;
    double stiffness, conductance, conductance_lower; /* NAN: not asked for                       */
    /* m: the approach from the first touch of the first shape, and the first touch of the shape that is
     * left, once it is kept */
    double indentation, residual_indentation;
    double tilt_x, tilt_y; /* rad; NAN: the counter body cannot tilt                         */
    const char *kernel, *method; /* NULL: no load so far                                          */
};
/* A model (model.h) of elastic bodies, with a hardness; it takes a load or an approach, 0: the bodies are
 * apart. A point that is kept leaves its dents in the shape. `h` is copied; what `problem` points to has to
 * last. The problem's load and approach are not used. asks NULL: nothing. */
RC_API struct rc_model *rc_elastic_new(const struct rc_shape *shape, const double *h,
                                       const struct rc_problem *problem,
                                       const struct rc_elastic_asks *asks, struct rc_err *err);
/* The figures after a look, of a model that is elastic or has an elastic inner model; NULL: it has none. */
RC_API const struct rc_elastic_figures *rc_elastic_result(const struct rc_model *model);

/* ---- plasticity in the volume: plastic/plastic.c ---- */

/* Von Mises, hardening alike in all directions: a yield stress that grows with the equivalent plastic
 * strain, along a line, or along a table of points, which the caller keeps. */
struct rc_yield {
    double stress; /* Pa, > 0: of material that has not yielded                                   */
    double
        modulus;   /* Pa, >= 0, by which it grows per equivalent plastic strain                   */
    size_t points; /* 0: that line; else the table's                                              */
    const double *strain_at, *stress_at; /* the first at 0, growing; Pa, never falling. Beyond the
                                            last it goes on as between the last two              */
};

/* Yield stress at an equivalent plastic strain, Pa. */
RC_API double rc_yield_stress(const struct rc_yield *law, double strain);

struct rc_plastic_problem {
    /* pair.one is the body that yields, with e and nu; its load does not count, nor does an approach; no
     * bound of the pressure */
    struct rc_problem contact;
    struct rc_yield yield;
    size_t slabs; /* that may yield, from the surface down                              */
    const double
        *thickness;    /* m, of each; copied                                                 */
    size_t increments; /* of each load; 0: 16                                                */
    double
        lag; /* a load is believed when the stress that lags behind is below this part of the yield
                   stress (RMS); 0: 0.02                                                          */
    bool precise; /* strains and stresses in double precision, in twice the memory               */
};

/* What a load has done; lengths in m. */
struct rc_plastic_figures {
    size_t increments; /* of this load: 1 where nothing, or only a trace, flows on the way to it  */
    size_t applications; /* of the volume's operator                                              */
    size_t voxels;       /* of a node and a slab, that have yielded                   */
    double depth, volume;      /* bottom of the deepest of them; m^3                        */
    double max_strain;         /* largest equivalent plastic strain                         */
    double work;               /* J, that all loads so far have put into plastic strain     */
    double max_pressure_mean4; /* Pa: of means of 2 x 2 nodes, for without hardening the pressure
                                        alternates from node to node                             */
    double lag;                /* that was reached                                          */
    /* Estimated relative L1 error of the pressure, the sum of its parts: of the increments of this load, NAN
     * for fewer than 8 of them; of those of the loads before, NAN where one of these had fewer; of the
     * iteration; of the tolerance of the contacts; and of the images of a map that does not repeat. */
    double error, increment_error, inherited_error, iteration_error, contact_error, image_error;
    double strained; /* m^3: the integral of the equivalent strain over the volume                */
};

struct rc_plastic;
/* h: nx ny m, copied. NULL where the problem makes no sense, or memory is short. */
RC_API struct rc_plastic *rc_plastic_new(const struct rc_shape *shape, const double *h,
                                         const struct rc_plastic_problem *problem,
                                         struct rc_err *err);
/* The next load of a history, N; 0 takes the bodies apart. */
RC_API enum rc_status rc_plastic_set_load(struct rc_plastic *plastic, double load,
                                          struct rc_err *err);
/* Increments of each load from the next that is set; 0: 16. */
RC_API void rc_plastic_set_increments(struct rc_plastic *plastic, size_t increments);
/* The next load acts on these heights, nx ny m, of bodies without strain: one of them has been moved. */
RC_API void rc_plastic_set_heights(struct rc_plastic *plastic, const double *h);
/* One application: a contact and two sweeps through the volume. RC_MORE until the load is reached, then
 * RC_OK, or RC_SHORT where a contact or the iteration stopped short; RC_FAIL when memory is short. */
RC_API enum rc_status rc_plastic_step(struct rc_plastic *plastic, struct rc_err *err);
/* How far it is: the load of this increment, N, which increment (0: an elastic trial of the load), which
 * application of it. */
RC_API void rc_plastic_progress(const struct rc_plastic *plastic, double *load, size_t *increment,
                                size_t *application);
RC_API const struct rc_plastic_figures *rc_plastic_result(const struct rc_plastic *plastic);
/* The contact of the heights less the residual displacement: for its pressure, gap and figures. Its
 * displacement is the elastic part. Of no use where the load is 0. */
RC_API struct rc_solver *rc_plastic_solver(struct rc_plastic *plastic);
/* What plastic strain alone does to the surface, nx ny m, into the body. */
RC_API const double *rc_plastic_residual(const struct rc_plastic *plastic);
enum {
    RC_PEEQ = 5, /* equivalent plastic strain, after exx eyy exy exz eyz; ezz = -exx - eyy */
    RC_PLASTIC_STRAINS
};
/* Plastic strain of a slab, nx ny each; NULL: not wanted. */
RC_API void rc_plastic_strain(const struct rc_plastic *plastic, size_t slab,
                              double *const e[RC_PLASTIC_STRAINS]);
/* Where it stands after any step, as so many numbers, all finite, which a file may keep: fewer between two
 * increments than within one, and fewest when a load is reached. */
RC_API size_t rc_plastic_state_size(const struct rc_plastic *plastic);
RC_API void rc_plastic_state(const struct rc_plastic *plastic, double *state);
/* Goes on from there, in one of the same problem and heights: the next step is the one that would have
 * come, its contact within the tolerance. Of a load that had been reached that step only finds the contact
 * again. RC_FAIL where the n numbers are no state of such a problem, which leaves all as it was, and when
 * memory is short; it is then of no further use. */
RC_API enum rc_status rc_plastic_restore(struct rc_plastic *plastic, const double *state, size_t n,
                                         struct rc_err *err);
RC_API void rc_plastic_free(struct rc_plastic *plastic); /* NULL is allowed */
/* Bytes that one takes when this part of its voxels yields. */
RC_API size_t rc_plastic_memory(const struct rc_shape *shape,
                                const struct rc_plastic_problem *problem, double yielding);

/* ---- a body that may yield, its elastic contact first: plastic/press.c ---- */

/* As long as nothing yields the elastic contact is the solution. Of the problem thickness NULL lets the slabs
 * be chosen, so many of them (0: as many as halve, at the surface, the spacing and grow by a quarter), increments 0 their number for each load, so
 * that its estimated error is at most contact.tol (0: 1e-2), and lag 0 what suits that. */
struct rc_press;
enum {
    RC_PRESS_INCREMENTS = 512 /* of a load, at most */
};
struct rc_press_figures {
    double goal; /* error that is asked for                                             */
    double most,
        deepest; /* elastic Mises stress over the yield stress, at most; its depth, m; 0: unknown */
    size_t slabs; /* in use, 0: nothing has yielded                                      */
    const double
        *thickness;    /* m, of each                                                          */
    size_t increments; /* of the load, as they are tried                                      */
};
/* h: nx ny m, copied. NULL where the problem makes no sense, or memory is short. */
RC_API struct rc_press *rc_press_new(const struct rc_shape *shape, const double *h,
                                     const struct rc_plastic_problem *problem, struct rc_err *err);
/* So many loads come, N the largest: the slabs are chosen for that one, and the increments also for the loads
 * that inherit their error. May be left out. */
RC_API void rc_press_plan(struct rc_press *press, size_t loads, double largest);
/* The next load of a history, N; 0 takes the bodies apart. */
RC_API enum rc_status rc_press_set_load(struct rc_press *press, double load, struct rc_err *err);
/* An iteration of the elastic contact, or one of rc_plastic_step. RC_MORE until the load is reached. */
RC_API enum rc_status rc_press_step(struct rc_press *press, struct rc_err *err);
/* After the last step; of a load that is given up half-way too. */
RC_API const struct rc_press_figures *rc_press_result(struct rc_press *press);
/* The contact, elastic or of rc_plastic_solver; NULL: no load has been set above 0. */
RC_API struct rc_solver *rc_press_solver(struct rc_press *press);
/* The body that has yielded, for its figures, residual displacement and strain; NULL: nothing has. */
RC_API struct rc_plastic *rc_press_plastic(struct rc_press *press);
/* Where it stands after any step; the count of these numbers, all that is found for NULL. */
RC_API size_t rc_press_state(const struct rc_press *press, double *state);
/* As rc_plastic_restore. Where that fails the press is of no further use. */
RC_API enum rc_status rc_press_restore(struct rc_press *press, const double *state, size_t n,
                                       struct rc_err *err);
/* Bytes that the next step needs for the volume, 0.3 of its voxels yielding, and for a state where one is
 * kept; or that the restoring of n numbers needs. 0: none. */
RC_API size_t rc_press_memory(const struct rc_press *press, const double *state, size_t n,
                              bool kept);
RC_API void rc_press_free(struct rc_press *press); /* NULL is allowed */

/* The model (model.h) of such a body, along a history of loads; its heights cannot change. The problem is that of
 * rc_press_new; what it points to has to last. */
struct rc_yielding_figures {
    struct rc_contact contact;
    struct rc_plastic_figures plastic; /* all 0: nothing has yielded                              */
    size_t slabs;
    double max_mises_over_yield,
        max_mises_depth; /* of the elastic contact; m; NAN: unknown       */
};
RC_API struct rc_model *rc_yielding_new(const struct rc_shape *shape, const double *h,
                                        const struct rc_plastic_problem *problem,
                                        struct rc_err *err);
/* The figures after a look, of a model that yields or has such an inner model; NULL: it has none. */
RC_API const struct rc_yielding_figures *rc_yielding_result(const struct rc_model *model);

/* ---- adhesion: adhesion/adhesion.c ---- */

/* Rows of the table of laws, k = 0, 1, ...; NULL past the last. */
struct rc_adhesion_law_info {
    const char *name, *summary;
    bool ranged; /* it has a range that the caller may choose; else the grid does */
};
RC_API const struct rc_adhesion_law_info *rc_adhesion_law_info(size_t k);

/* Bodies that attract each other: where the gap is g >= 0 a traction sigma(g) >= 0 pulls. */
struct rc_adhesion_problem {
    /* The bodies, the boundary, the hardness (of p + sigma), tol (at most 1e-3), max_iterations and
     * threads; its load and approach do not count. engine, method: auto, NULL, or, of the first, one that
     * transforms */
    struct rc_problem contact;
    double work;     /* J/m^2, > 0: what it takes to part a unit area, the integral of sigma      */
    const char *law; /* a row of the table; NULL: the first                                      */
    /* m: exponential, the length over which sigma falls to 1/e; dugdale, work/sigma(0); compact, where
     * sigma ends. 0: such that the cohesive length is two nodes */
    double range;
};

/* What the law is on this grid. */
struct rc_adhesion_scales {
    const char *law;
    double range;           /* m                                                              */
    double strength;        /* Pa: sigma(0)                                                    */
    double steepest;        /* Pa/m: the largest -sigma'                                       */
    double cohesive_length; /* m: E*, as waves of two nodes feel it, over that                 */
    double
        cohesive_nodes; /* over the larger of dx, dy: below 1.5 the grid makes hysteresis of its own */
};
/* RC_FAIL, and *err says why, when rc_adhesion_new would refuse the problem, though memory were there. */
RC_API enum rc_status rc_adhesion_check(const struct rc_shape *shape,
                                        const struct rc_adhesion_problem *problem,
                                        struct rc_adhesion_scales *scales, struct rc_err *err);

/* The current state of the path. Loads are positive when the bodies are pressed together; all
 * pressures but `repulsive_load` are net, p of the contact less sigma. NAN: not known. */
struct rc_adhesion_figures {
    double load, mean_pressure; /* N, Pa                                                        */
    double approach;            /* m: 0 at first touch of the undeformed bodies, negative apart */
    double mean_gap;            /* m, over the map                                              */
    double attractive_load, repulsive_load; /* N, both positive: sums of sigma and of p + sigma   */
    double attractive_area;                 /* m^2: where sigma > sigma(0)/100                    */
    size_t contact_nodes;                   /* where the gap is 0, or at the hardness negative    */
    double contact_area, contact_fraction;  /* m^2, -                                             */
    size_t plastic_nodes;                   /* where the gap is negative: p + sigma = hardness    */
    double plastic_area;                    /* m^2                                                */
    double max_pressure, min_pressure;      /* Pa                                                 */
    double edge_traction; /* sigma over sigma(0), the largest at the edge of a free map; else 0   */
    /* The smallest eigenvalue of A - D on the nodes off contact, A = 1/K and D = -sigma', in units of A as
     * the contact leaves it: above 0 the state is stable under the control in use, below 0 it is a
     * saddle */
    double stability;
    bool stable;    /* stability > 0, as far as it has been found */
    bool separated; /* under the load that was set the bodies part, and nothing stops them */
    /* Places on the way from the state before where nothing resisted: the path of stable states had ended
     * there. Found by the curvatures that the iteration meets; some in a row may count once */
    size_t jumps;
    /* The lowest load of the retraction that rc_adhesion_pull_off asked for, N, at which approach, m, and
     * how much of the load it may be off: what a parabola beside it misses, twice, or what a jump hides */
    double pull_off_load, pull_off_approach, pull_off_spread;
    bool pull_off_at_start; /* it was the first state of the retraction                         */
    size_t states;      /* of this retraction, else 1                                             */
    size_t iterations;  /* steps in the gap                                                      */
    size_t eigen_steps; /* steps for the stability                                               */
    double convolutions; /* equivalents of one in double precision on this grid, padded if free   */
    double gap_error;    /* m: the largest correction K r of the gap that is still to come        */
    double
        kkt_residual; /* the worst |p + sigma| off contact, or p + sigma < 0 in it, over sigma(0) */
    double pressure_error; /* estimated relative L1 error of p; the part of it from dents of earlier
                              states, where nodes yield */
    double inherited_error;
    bool converged; /* pressure_error <= tol, and stable                                    */
};

struct rc_adhesion;
/* h: nx ny m, copied. NULL where the problem makes no sense, it is shared among ranks, the engine or method
 * is none for it, or memory is short. The path begins with undeformed bodies. */
RC_API struct rc_adhesion *rc_adhesion_new(const struct rc_shape *shape, const double *h,
                                           const struct rc_adhesion_problem *problem,
                                           struct rc_err *err);
/* The next state of the path is that of this load, N, of either sign. Under a load that pulls it is the one
 * downhill from the last, if there is one: see `separated`. */
RC_API enum rc_status rc_adhesion_set_load(struct rc_adhesion *a, double load, struct rc_err *err);
/* The next state of the path is that of this approach, m, 0 at first touch, negative apart: the control
 * that has a state everywhere. RC_FAIL on a periodic map where the mean gap would not be positive. */
RC_API enum rc_status rc_adhesion_set_approach(struct rc_adhesion *a, double approach,
                                               struct rc_err *err);
/* Bodies are drawn apart from the state there is, approach by approach, until they have parted, and the
 * lowest load on the way is found. RC_FAIL when there is no state yet, or memory for three is short. */
RC_API enum rc_status rc_adhesion_pull_off(struct rc_adhesion *a, struct rc_err *err);
/* The state of a path is this pressure's (nx ny Pa, net) at this approach, m, as they were left by an earlier
 * one of the same problem: the next state begins there. RC_FAIL when a value is not finite. */
RC_API enum rc_status rc_adhesion_start(struct rc_adhesion *a, const double *pressure,
                                        double approach, struct rc_err *err);
/* One step of the gap, or of the eigenvector. RC_MORE until the state is found; RC_OK; RC_SHORT where it
 * stopped short of tol or the bodies part; RC_FAIL when nothing has been set. */
RC_API enum rc_status rc_adhesion_step(struct rc_adhesion *a, struct rc_err *err);
struct rc_adhesion_progress {
    size_t state;      /* of a retraction, from 1                                            */
    size_t iterations; /* of this state                                                      */
    bool eigenvalue;   /* its stability is being found                                       */
    double load;       /* N, that was set; NAN: an approach was                              */
    double approach;   /* m, that was set, also in a retraction; NAN: a load was             */
    double error, tol; /* estimated error of the pressure, NAN at first; the one asked for   */
};
RC_API void rc_adhesion_progress(const struct rc_adhesion *a,
                                 struct rc_adhesion_progress *progress);
/* Of the state reached, valid until the next step; after a retraction of the state of lowest load. */
RC_API const struct rc_adhesion_figures *rc_adhesion_result(struct rc_adhesion *a);
RC_API const struct rc_adhesion_scales *rc_adhesion_scales(const struct rc_adhesion *a);
/* nx ny values each: net pressure, Pa; gap, m, never negative but at the hardness; displacement K p, m;
 * sigma, Pa. */
RC_API void rc_adhesion_pressure(const struct rc_adhesion *a, double *pressure);
RC_API void rc_adhesion_gap(const struct rc_adhesion *a, double *gap);
RC_API void rc_adhesion_displacement(const struct rc_adhesion *a, double *displacement);
RC_API void rc_adhesion_traction(const struct rc_adhesion *a, double *traction);
/* Other heights (nx ny m, copied): the next state begins with the displacement of the last one, and its
 * load or approach has to be set. RC_FAIL when one is not a finite number, which leaves all as it was. */
RC_API enum rc_status rc_adhesion_set_heights(struct rc_adhesion *a, const double *h,
                                              struct rc_err *err);
/* Where the hardness was reached: what stood into the other body is gone, from the heights of the path from
 * here on and from h, nx ny m (or NULL), those that the path began with less what has gone before. Without
 * effect where nothing has yielded. rc_adhesion_pull_off begins with it. */
RC_API void rc_adhesion_keep_shape(struct rc_adhesion *a, double *h);
RC_API void rc_adhesion_free(struct rc_adhesion *a); /* NULL is allowed */
/* Bytes that one takes; 0 when there is none such. */
RC_API size_t rc_adhesion_memory(const struct rc_shape *shape,
                                 const struct rc_adhesion_problem *problem);
/* Bytes that it takes besides once it has been pulled off. */
RC_API size_t rc_adhesion_pull_off_memory(const struct rc_shape *shape,
                                          const struct rc_adhesion_problem *problem);
/* What a state of a path will take. Fails as rc_adhesion_check. */
RC_API enum rc_status rc_adhesion_expect(const struct rc_shape *shape,
                                         const struct rc_adhesion_problem *problem,
                                         struct rc_expected *expected, struct rc_err *err);
/* ---- leakage: leak/leak.c ---- */

struct rc_leak_options {
    char direction; /* 'x': from the first column to the last; 'y': from the first row to the last;
                       0: 'x'                                                                     */
    bool around;    /* the sides along the flow meet, as on a periodic map; else they are closed  */
    size_t threads; /* 0: all                                                                     */
};

/* Flow through the gap between two edges of the map under a pressure difference of 1, by Reynolds'
 * equation, div(g^3 grad P) = 0. With a viscosity eta and a difference dp the rate is
 * conductance dp/(12 eta). */
struct rc_leak_figures {
    double conductance; /* m^3; 0, exactly, where nothing percolates                             */
    double conductance_linear; /* the same with gaps that change linearly from node to node: it errs
                                  to the other side                                              */
    double error;        /* half their difference over the first: estimate of the relative error of
                            the grid; NAN: no flow                                                */
    double lower, upper; /* m^3, proven bounds of `conductance` on this grid, to rounding         */
    double flow_factor;  /* of Patir and Cheng: conductance over that of two flat faces at the mean
                            gap                                                                   */
    double mean_gap;     /* m: over all nodes, 0 in contact                                       */
    double slope;        /* RMS of the gap's gradient where fluid flows; NAN: nowhere             */
    bool percolates;     /* through the edges of cells                                            */
    bool percolates_diagonal; /* through their corners too                                        */
    double critical_gap; /* m: the narrowest place of the widest way; 0: there is no way      */
    double critical_x, critical_y; /* m: where that is; NAN: nowhere                             */
    size_t throat_nodes; /* fluid nodes side by side there: below 3 the grid does not resolve it  */
    size_t fluid_nodes, dead_nodes; /* dead: fluid that stands                                    */
    size_t unknowns;                /* nodes where fluid flows                                    */
};

struct rc_leak;
/* Fluid is where the bodies are not in contact (rc_in_contact of p, a pressure or a map of 1 and 0; NULL: no
 * contact) and the gap g (m) is positive; gaps below 1e-30 of the largest let nothing through. Finds what percolates. NULL where a
 * value is not finite, the map has 2^31 nodes, memory is short, or the library was built without AMD of
 * SuiteSparse. */
RC_API struct rc_leak *rc_leak_new(const struct rc_shape *shape, const double *p, const double *g,
                                   const struct rc_leak_options *options, struct rc_err *err);
/* Another contact and gap of the same map, with the same options and memory: as rc_leak_new, but a value
 * that is not finite leaves all as it was. After RC_FAIL for want of memory it is of no further use. */
RC_API enum rc_status rc_leak_set_gap(struct rc_leak *leak, const double *p, const double *g,
                                      struct rc_err *err);
/* RC_MORE until the flow is known, then RC_OK: two steps. RC_FAIL when memory is short, before
 * the first begins to eliminate. */
RC_API enum rc_status rc_leak_step(struct rc_leak *leak, struct rc_err *err);
/* What percolates and where is known at once, conductances after the last step. */
RC_API const struct rc_leak_figures *rc_leak_result(const struct rc_leak *leak);
/* Maps of nx ny values after the last step. Fluid pressure, 1 at the inlet, 0 at the outlet; NAN in
 * contact, and where fluid is shut in. */
RC_API void rc_leak_pressure(const struct rc_leak *leak, double *pressure);
/* Size of the flow per width for a pressure difference of 1 and 12 eta = 1, m^2: 0, exactly, where fluid
 * stands; NAN in contact. */
RC_API void rc_leak_flux(const struct rc_leak *leak, double *flux);
/* 0 in contact, 1 where fluid stands (dead ends, shut in), 2 where it flows. */
RC_API void rc_leak_channel(const struct rc_leak *leak, double *channel);
RC_API void rc_leak_free(struct rc_leak *leak); /* NULL is allowed */

/* ---- friction in the contact: slip/slip.c ---- */

/* Coulomb's law node by node, with memory: a node carries tractions up to mu times its pressure and sticks,
 * or slips against them. The pressure is given, and so is what the pressure does not know: how the bodies
 * are moved along the surface, in increments. Tractions are those on body 1, and the force is their sum:
 * body 2 drags body 1 along by it, and has moved over it by the displacement (on a periodic map their mean
 * planes). Slip is that of body 1 on body 2, against the traction. */
struct rc_slip_problem {
    enum rc_boundary boundary;
    struct rc_pair pair; /* bare bodies */
    double nu;           /* of both, where only E* of the pair is known */
    double mu;           /* coefficient of friction, > 0 */
    double tau_max;      /* Pa: no node carries more (Tresca); 0 or INFINITY: no such bound */
    bool uncoupled;      /* dissimilar bodies as if pressure moved nothing along the surface */
    double tol;          /* asked relative L1 error of the tractions; 0: 1e-4 */
    size_t max_steps;    /* of an increment; 0: 200 */
    size_t threads;      /* 0: all */
    const struct rc_ranks *ranks; /* refused: friction is not shared among processes */
};

/* What an increment has done. */
struct rc_slip_figures {
    double load;            /* N, normal */
    double limit;           /* N: what friction could carry, no more than mu times the load */
    double force[2];        /* N, along x and y */
    double displacement[2]; /* m, of body 2 over body 1 since they have touched */
    size_t stick_nodes, slip_nodes; /* of those that carry something */
    double stick_area, slip_area;   /* m^2 */
    double stick_fraction;          /* of the nodes that carry something; NAN: there is none */
    double stiffness;               /* N/m: |force| over |displacement|; NAN where one is 0 */
    double dissipated;              /* J, in this increment */
    double largest_slip;            /* m, in this increment */
    double slip_error; /* m: largest slip where nothing may slip, or across the traction */
    double
        traction_error; /* estimated relative L1 error of the tractions, of this increment alone */
    size_t steps;
    double convolutions; /* since rc_slip_new, in equivalents of a single map in double precision */
    bool converged;      /* traction_error <= tol */
};

struct rc_slip;
/* NULL where the problem makes no sense, or memory is short. The bodies are apart. */
RC_API struct rc_slip *rc_slip_new(const struct rc_shape *shape,
                                   const struct rc_slip_problem *problem, struct rc_err *err);
/* The pressure of this increment (nx ny Pa, copied; NULL: the bodies are apart) and the gap that goes with
 * it (nx ny m, copied; NULL: not known). Where a node touches in the increment that was not in contact
 * before, it has moved with its body until then: with the gap before, that is known to first order, and
 * exactly for nu = 0, where force and load grow in proportion (Jaeger 1998; Ciavarella 1998); without it
 * the node begins as it stood before the increment. RC_FAIL when a pressure is negative or not finite. */
RC_API enum rc_status rc_slip_set_pressure(struct rc_slip *slip, const double *p, const double *gap,
                                           struct rc_err *err);
/* Force (N) or displacement (m) at the end of the increment, along x and y, after its pressure. RC_FAIL,
 * with both numbers, when friction cannot carry the force: the bodies slide; the increment is then as
 * before. With a displacement nodes that touch begin as without a gap. Bodies that are apart forget: slip and
 * displacement are 0, whatever is set, and count from the next touch. */
RC_API enum rc_status rc_slip_set_force(struct rc_slip *slip, double fx, double fy,
                                        struct rc_err *err);
RC_API enum rc_status rc_slip_set_displacement(struct rc_slip *slip, double dx, double dy,
                                               struct rc_err *err);
/* One step, of 7 to 12 convolutions: RC_MORE, RC_OK when the estimated error is below tol, RC_SHORT when it
 * cannot get there; RC_FAIL when nothing is asked for, or memory is short. */
RC_API enum rc_status rc_slip_step(struct rc_slip *slip, struct rc_err *err);
RC_API void rc_slip_result(struct rc_slip *slip, struct rc_slip_figures *figures);
/* The increment becomes history, on which the next one builds. Until then pressure and force may be set
 * again. */
RC_API void rc_slip_keep(struct rc_slip *slip);
/* Tractions, Pa, nx ny along x and along y, until the next step; slip since the bodies have touched, m, with
 * that of this increment, 0 out of contact. */
RC_API const double *rc_slip_traction(const struct rc_slip *slip, int direction);
RC_API void rc_slip_slip(const struct rc_slip *slip, int direction, double *to);
/* nx ny: 0 where nothing is carried, 1 where a node sticks, 2 where it slips. */
RC_API void rc_slip_state(const struct rc_slip *slip, double *to);
/* Normal displacement that the tractions make, nx ny m, into the bodies: 0 where these are alike. A contact
 * whose heights are less by it is that under these tractions. */
RC_API void rc_slip_normal(struct rc_slip *slip, double *uz);
/* Dundurs' constant of the pair: 0 where pressure and tractions do not know of each other. */
RC_API double rc_slip_beta(const struct rc_slip *slip);
RC_API void rc_slip_free(struct rc_slip *slip); /* NULL is allowed */
/* Bytes that it takes; 0 where the problem makes no sense. */
RC_API size_t rc_slip_memory(const struct rc_shape *shape, const struct rc_slip_problem *problem);

/* ---- bodies pressed and moved along each other: slip/joint.c ---- */

/* What pressure and tractions of dissimilar bodies know of each other. */
enum rc_coupling {
    RC_COUPLING_FULL,    /* all: they are found in turn, pass by pass                   */
    RC_COUPLING_GOODMAN, /* the pressure moves the bodies along each other, and no more */
    RC_COUPLING_NONE     /* nothing                                                     */
};

/* A contact and its friction, increment by increment: the pressure is found with each load, and with each
 * pass. */
struct rc_joint_problem {
    /* Bare bodies; the load is that of the first increment, or a guess; tol 0: as of friction, or less */
    struct rc_problem contact;
    /* Boundary, pair, threads and ranks are those of the contact, uncoupled is what `coupling` says */
    struct rc_slip_problem slip;
    enum rc_coupling coupling;
    size_t max_passes; /* of an increment; 0: 50 */
};

struct rc_joint_figures {
    struct rc_slip_figures slip;
    size_t passes; /* of this increment: pressures that friction was given                      */
    double pressure_change, traction_change; /* relative L1, of the last pass; 0: one will do   */
    double traction_error;  /* estimated relative L1 error, with what more passes would change   */
    double inherited_error; /* of the increments before: sum of traction_error |q|_1, over |q|_1 */
    double contact_error;   /* of the contacts solved on the way, and before: mu error P         */
    double approach;        /* m, as in rc_contact; NAN: unknown                                 */
    double convolutions;    /* of friction and contacts                                          */
    bool converged;         /* both, and the passes                                              */
};

struct rc_joint;
/* The heights are copied; NULL: there are none, and pressures only those of rc_joint_know. The bodies are
 * apart. NULL where either problem makes no sense, heights are missing for a pressure that feels tractions,
 * or memory is short. */
RC_API struct rc_joint *rc_joint_new(const struct rc_shape *shape, const double *h,
                                     const struct rc_joint_problem *problem, struct rc_err *err);
/* The contact under this load is known: its pressure and gap (NULL: not known), which the caller keeps.
 * Where pressures do not feel tractions it is not solved again. */
RC_API void rc_joint_know(struct rc_joint *joint, double load, const double *p, const double *gap);
/* Load (N, 0: the bodies are taken apart) and force (N) or displacement (m) along x and y at the end of the
 * increment. RC_FAIL when a load makes no sense or is neither known nor can be solved. */
RC_API enum rc_status rc_joint_set_force(struct rc_joint *joint, double load, double fx, double fy,
                                         struct rc_err *err);
RC_API enum rc_status rc_joint_set_displacement(struct rc_joint *joint, double load, double dx,
                                                double dy, struct rc_err *err);
/* The next increment starts from these tractions and this pressure (nx ny Pa; NULL: none), copied, instead of
 * from where the last has ended: what another run has found of it is found with a step. Before it is set. */
RC_API void rc_joint_start(struct rc_joint *joint, const double *const q[2], const double *p);
/* One step, of the contact or of friction: RC_MORE; RC_OK when both are within tol; RC_SHORT when they
 * cannot get there; RC_FAIL when nothing is asked for, and when friction cannot carry the force, as in
 * rc_slip_set_force. After any step pressure and tractions go together: one may stop there. */
RC_API enum rc_status rc_joint_step(struct rc_joint *joint, struct rc_err *err);
RC_API void rc_joint_result(struct rc_joint *joint, struct rc_joint_figures *figures);
/* The increment becomes history. */
RC_API void rc_joint_keep(struct rc_joint *joint);
/* Friction, for its tractions and slip. */
RC_API struct rc_slip *rc_joint_slip(struct rc_joint *joint);
/* The pressure under which these are, nx ny Pa, until the next step; NULL: the bodies are apart. */
RC_API const double *rc_joint_pressure(const struct rc_joint *joint);
RC_API void rc_joint_free(struct rc_joint *joint); /* NULL is allowed */
/* Bytes that it takes, with heights or without; 0 where the problem makes no sense. */
RC_API size_t rc_joint_memory(const struct rc_shape *shape, const struct rc_joint_problem *problem,
                              bool heights);

/* ---- stress: stress.c ---- */

enum rc_component {
    RC_SXX,
    RC_SYY,
    RC_SZZ,
    RC_SXY,
    RC_SXZ,
    RC_SYZ,
    RC_COMPONENTS,
    RC_MISES = RC_COMPONENTS, /* from here on derived from all six             */
    RC_TRESCA,                /* s1 - s3                                       */
    RC_S1,                    /* principal stresses, s1 >= s2 >= s3            */
    RC_S2,
    RC_S3,
    RC_STRESSES
};
/* "sxx", ... in that order. */
RC_API extern const char *const rc_component_names[RC_STRESSES];

/* Plastic strain in slabs from the surface down: of each five maps of nx ny values, exx eyy exy exz eyz, with
 * ezz = -exx - eyy; NULL: 0. */
struct rc_eigenstrain {
    size_t slabs;
    const double *thickness; /* m                                                                 */
    const double *const *map;
};

struct rc_stress_options {
    enum rc_boundary boundary;
    struct rc_body body; /* under the pressure; of a bare one e is of no use. Layers are copied   */
    double mu;          /* the surface also carries the traction mu p along +x; 0 beside a map    */
    unsigned wanted;    /* bits of enum rc_component                                              */
    char section;       /* 'x' or 'y': only the plane x = at, or y = at; 0: maps                  */
    double at;          /* m, from the middle of the map; within it                               */
    const char *engine; /* a row of engines.list, or NULL or "auto"                               */
    double tol;         /* asked error of a component over the largest pressure, or traction of a
                           map where that is larger; 0: rounding                                 */
    size_t threads;     /* 0: all                                                                 */
    const struct rc_ranks *ranks; /* processes that share the map; NULL: none                   */
    /* NULL, or strain whose stress is added. It costs five transforms per slab and one per depth and
     * component, and needs body.e, of a bare body. Interfaces belong to the lower slab. Sections
     * interpolate linearly. The caller keeps all of it. */
    const struct rc_eigenstrain *strain;
    /* Tractions that the surface also carries, along +x and +y on this body, Pa, as large as p, and as p
     * between the nodes; NULL: none. The caller keeps them as p. */
    const double *traction[2];
    /* Stress that each layer has without any load, Pa, tension positive, uniform and equal in all
     * directions along it: added to sxx and syy there, before stresses are derived; NULL: none. The caller
     * keeps it, and the layers with it. The half-space below, thick without end, balances its force without a stress. */
    const double *residual;
};

/* Work counters; tests use them to check that only requested fields are computed. */
struct rc_stress_counts {
    size_t depths;
    size_t source_transforms; /* of the pressure, and of maps of traction                        */
    size_t normal_kernels;    /* kernels of a depth evaluated, of the pressure                   */
    size_t shear_kernels;     /* and of the traction: none where there is none                   */
    size_t coefficients;      /* values of them                                                  */
    size_t kernel_transforms; /* two-dimensional, of a quarter                                   */
    size_t field_transforms;  /* two-dimensional, from wave numbers to a map                     */
    size_t line_transforms;   /* one-dimensional, of kernels and sources of a section            */
    size_t engine_sums;       /* convolutions by another engine                                  */
    size_t coarse_depths;     /* of these depths computed on a coarser grid                      */
    size_t strain_transforms; /* of maps of plastic strain to wave numbers                       */
    size_t strain_field_transforms; /* and of its stresses from there to maps                    */
};

/* Stresses under the pressure p (Pa; kept by the caller, who does not change it) on a half-space. Free: the
 * pressure is constant in each cell. Periodic: it is band-limited, and its mean gives szz = -p, sxz = -mu p
 * (of maps of traction minus those) and sxx = syy = -(1 + 2 nu) p / 2 at every depth, what a patch that
 * grows without end gives; in a layered body it is that of the half-space below, whose strains along the
 * surface the layers share. NULL when an option is out of bounds, there is no such engine or none for the
 * boundary or the section, or memory is short. */
RC_API struct rc_stress *rc_stress_new(const struct rc_shape *shape, const double *p,
                                       const struct rc_stress_options *options, struct rc_err *err);
/* RC_FAIL, and *err says why, when rc_stress_new would refuse these, though memory were there. */
RC_API enum rc_status rc_stress_check(const struct rc_shape *shape,
                                      const struct rc_stress_options *options, struct rc_err *err);
/* Values of a component at one depth: nx ny, or of the section y = at nx, of x = at ny. */
RC_API size_t rc_stress_values(const struct rc_stress *stress);
/* What is wanted at the depth z >= 0 (m), Pa, tension positive: s[c] for each c of `wanted`; the
 * others are not touched. At an interface sxx, syy and sxy jump: it belongs to the material above it;
 * depth*(1 + 1e-12) selects the material below. RC_FAIL also inside a rigid half-space. */
RC_API enum rc_status rc_stress_slice(struct rc_stress *stress, double depth,
                                      double *const s[RC_STRESSES], struct rc_err *err);
RC_API const char *rc_stress_engine(const struct rc_stress *stress);
RC_API const struct rc_stress_counts *rc_stress_counted(const struct rc_stress *stress);
RC_API void rc_stress_free(struct rc_stress *stress);
/* Bytes that such a plan takes, beside p and the slices; where ranks share the map, of the rank
 * that takes most. With the depths that will be asked for (m, so many; 0: any), and for a section
 * the lines along it that carry pressure or traction (0: all). */
RC_API size_t rc_stress_memory(const struct rc_shape *shape,
                               const struct rc_stress_options *options, const double *depth,
                               size_t depths, size_t loaded);

/* Depths from 0 down at which to look at the stresses under this pressure, *n of them in an array
 * that the caller frees: close together where its short waves are felt, farther apart below, down
 * to three contact radii (free) or to where the waves have died to 1 % (periodic). Successive
 * depths are a quarter of the RMS wave's 1/q apart. In a layer they are at most a quarter of it apart, and
 * each interface has two, itself and one a millionth deeper; none is in a rigid half-space. ranks: they
 * share the map, of which p holds the rows held here; NULL: none. RC_FAIL, and NULL for the depths, when
 * memory is short. */
RC_API enum rc_status rc_stress_depths(const struct rc_ranks *ranks, const struct rc_shape *shape,
                                       const double *p, enum rc_boundary boundary,
                                       const struct rc_body *body, double **depths, size_t *n,
                                       struct rc_err *err);

/* Places of the least and the largest of n values, n > 0; the first of equals, and never a NaN. */
RC_API void rc_extremes(size_t n, const double *v, size_t *least, size_t *largest);

/* The derived stresses of n points from their six components: out[c] for each c from RC_MISES on
 * whose bit is set. */
RC_API void rc_stress_derive(unsigned wanted, size_t n, const double *const s[RC_COMPONENTS],
                             double *const out[RC_STRESSES]);

#ifdef __cplusplus
}
#endif

#endif
