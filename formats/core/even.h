/*
 * Profiles whose points are unevenly spaced: refused, or resampled where the user wishes it.
 *
 * Between neighbouring points a profile is taken to be straight. It is unknown across a gap of more
 * than RC_EVEN_GAP steps (or median spacings, where the step is finer) and next to a missing point.
 * The profile's own step is the median of the spacings, so that a gap or a cluster of points does
 * not change it; it is fitted so that whole steps fill the length.
 */
#ifndef RC_EVEN_H
#define RC_EVEN_H

#include "file.h"
#include "wish.h"

enum {
    RC_EVEN_GAP = 5
};

struct rc_even {
    double first, step; /* of the nodes, in the unit of the positions         */
    size_t n;           /* nodes                                              */
    double widest;      /* gap that is bridged; 0: the points are the nodes   */
};

/* Lays nodes along points at x[0] < x[1] < ..., `metres` each (NAN: not known): with the step that
 * the user wishes, or at the points themselves where these are even, give or take a twentieth of a
 * step or the last decimal in the file. RC_FAIL for uneven points when there is no wish, and for a
 * step that does not fit. */
enum rc_status rc_even_new(const double *x, size_t points, double metres,
                           const struct rc_file *file, const struct rc_wish *wish,
                           struct rc_even *even, struct rc_err *err);
/* Interpolates the heights z at the points to the nodes. What lies between two nodes may be higher than
 * both: notes->above and below say by how much. */
void rc_even_heights(const struct rc_even *even, const double *x, const double *z, size_t points,
                     double *v, struct rc_notes *notes);
/* The step of an axis of n > 1 points, which rise or fall; what is even is judged as above. RC_FAIL where
 * they are not even; `name` is what the axis is called in messages. x is turned round where it falls. */
enum rc_status rc_axis_step(const char *name, double *x, size_t n, double *step,
                            struct rc_err *err);

#endif
