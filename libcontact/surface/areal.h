/*
 * The parts of an areal description, each of which sets its own fields. Internal: never installed.
 */
#ifndef RC_SURFACE_AREAL_H
#define RC_SURFACE_AREAL_H

#include "libcontact/common.h"

/* A map and its figures that all parts need. */
struct rc_relief {
    struct rc_shape shape;
    const double *h;
    enum rc_boundary boundary;
    int threads;
    size_t there; /* measured: finite */
    double mean, minimum, maximum;
};

/* material_ratio.c: sk to sxp. RC_FAIL when memory is short. */
enum rc_status rc_material_ratio(const struct rc_relief *relief, struct rc_areal *areal,
                                 struct rc_err *err);

/* texture.c: sal, str, std, where they are defined. RC_FAIL as in rc_areal. */
enum rc_status rc_texture(const struct rc_relief *relief, struct rc_areal *areal,
                          struct rc_err *err);

/* spectrum.c: Hann's window over n nodes at node i, nowhere 0; 1 on a side of one node. */
double rc_hann(size_t i, size_t n);

#endif
