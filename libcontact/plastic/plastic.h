/*
 * What the files of this folder share beside the face, which is in contact.h. Internal: never installed.
 */
#ifndef RC_PLASTIC_H
#define RC_PLASTIC_H

#include "libcontact/contact.h"
#include "libcontact/volume/volume.h"
#include "voxels.h"

/* Part of the last increment in the base of the next: w^2/(1 + 2 w), w = 1. */
#define RC_PLASTIC_BETA (1.0 / 3)

enum rc_plastic_stage {
    RC_PLASTIC_NEW,   /* no load is asked for */
    RC_PLASTIC_TRIAL, /* increments */
    RC_PLASTIC_ORDER, /* the contact with what the order of the integration adds */
    RC_PLASTIC_STATE, /* the contact of the strain that has been accepted */
    RC_PLASTIC_AGAIN, /* the contact of a state that was taken over when it was done */
    RC_PLASTIC_DONE
};

struct rc_plastic {
    struct rc_shape shape;
    size_t n;
    int threads;
    struct rc_yield law;
    double shear, nu, yield,
        lag;              /* mu, yield stress of what is new, the lag that is asked for    */
    double *h, *u, *form; /* heights, what e does to the surface, and heights less that    */
    double *thickness;
    struct rc_solver *solver;
    struct rc_slabs *slabs;
    struct rc_voxels voxels;
    bool round;      /* the map repeats */
    double bearable; /* N: beyond it all depths yield under the mean pressure                */
    double *other;   /* a pressure to compare with                                               */
    bool alone;      /* no load: p is 0                                                          */
    bool failed;     /* memory was short in a row                                                */
    bool pressed;    /* a load has been: the solver's pressure is one to start from */
    bool stopped;    /* a contact stopped short                                                  */
    bool moved;      /* the heights are new                                                      */
    double from, to, set; /* loads: of the last result, asked for, of this increment           */
    size_t increments, increment, trial; /* of this load, which, and which application of it   */
    double order, resistance;
    double mix; /* Anderson's share of the trial before                                        */
    enum rc_plastic_stage stage;
    struct rc_plastic_figures figures;
};

/* The pressure becomes the one that the next is compared with. */
void rc_plastic_keep_pressure(struct rc_plastic *plastic);

#endif
