/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The search for the lowest load of a retraction. It chooses the next approach, and the state to start from.
 * It sees only loads; adhesion.c has the states, and keeps the ones to which the search may return.
 */
#ifndef RC_RETRACTION_H
#define RC_RETRACTION_H

#include <stdbool.h>
#include <stddef.h>

enum {
    RC_RETRACTION_KEPT = 4,   /* most kept states */
    RC_RETRACTION_CHECKS = 8, /* most states beside the lowest one */
    RC_RETRACTION_STEPS = 16, /* most steps of the fine stage whose loads are kept */
    RC_RETRACTION_HERE = -1   /* the latest state */
};

/* A state of the retraction, over the length and E*. */
struct rc_retraction_state {
    double c, load, attraction;
    double punch;    /* stiffness of a flat punch with the area of the contact */
    double crack;    /* part of the force that opens a crack around the contact */
    double mean_gap; /* mean gap over the map */
    double slope,
        rate; /* slopes of load and attraction over c on the step to it; after a jump, the slopes
                 before it. For the first state `slope` is an expected one */
    int kept; /* index among the kept states */
};

enum rc_retraction_stage {
    RC_RETRACTION_COARSE, /* until the bodies have separated */
    RC_RETRACTION_FINE,   /* repeated in steps that cannot hide a lower load */
    RC_RETRACTION_VERTEX, /* at the minimum of the parabola through the lowest state */
    RC_RETRACTION_CHECK   /* check of the parabola beside its vertex */
};

/* A step of the fine stage: the load before it, its end, length, and the slope of the load. */
struct rc_retraction_step {
    double load, end, way, slope;
};

struct rc_retraction_law {
    double range;
    double parted; /* the mean gap without attraction */
    bool lines; /* whole lines of nodes may separate at once: the load is a saw on fine grids too */
};

/* States in the order of the retraction; the fine stage begins at `base`. */
struct rc_retraction_path {
    struct rc_retraction_state base, prior, last, before, lowest, after;
    bool has_base, has_prior, has_before, has_after;
    bool shrunk; /* in a part of the step to `after` the attraction changes by a part only */
};

/* What the length of the next step depends on. */
struct rc_retraction_pace {
    bool rough;       /* the load does not fall like that of a path without jumps */
    double step;      /* step to the next state */
    double stiffness; /* the last positive slope of a step without a jump */
    double stiffest;  /* the largest */
};

/* Low loads beside that of the lowest state. */
struct rc_retraction_low {
    double known, known_at; /* the lowest load of the stages before, and its place */
    double hidden;          /* the lowest load that a step since `base` may hide */
    double beside; /* the lowest load that the step from the lowest state to `after` may hide */
    double to;     /* the end of the last step that may hide a lower load */
};

struct rc_retraction_parabola {
    double load, at, bend; /* its lowest load, its place, and half its second derivative */
    double missed;         /* largest difference of a load from the parabola */
    double around;         /* the bend of the parabola of the coarse stage; 0: there is none */
    double late;           /* the end of that parabola */
    bool leaps;            /* a checked load was far above it */
};

/* The lowest point of the parabola and the points beside it: distance and load. */
struct rc_retraction_beside {
    double way[RC_RETRACTION_CHECKS + 1], load[RC_RETRACTION_CHECKS + 1];
    size_t n;
};

/* The last steps of the fine stage. */
struct rc_retraction_fine {
    struct rc_retraction_step step[RC_RETRACTION_STEPS];
    size_t n;
};

/* The next step: the caller keeps the state as `keep`, unless that is below 0, and goes from state `from`,
 * which has from_c, to c. */
struct rc_retraction_next {
    int keep, from;
    bool is_lowest; /* the state has the lowest load so far */
    double from_c, c;
};

/* The result. */
struct rc_retraction_found {
    double load, at, spread;
    bool short_of; /* the search ran out of states */
};

/* Functions that choose the next stage get the whole search. */
struct rc_retraction {
    struct rc_retraction_law law;
    enum rc_retraction_stage stage;
    struct rc_retraction_path path;
    struct rc_retraction_pace pace;
    struct rc_retraction_low low;
    struct rc_retraction_parabola parabola;
    struct rc_retraction_beside beside;
    struct rc_retraction_fine fine;
    struct {
        size_t states, fines, vertices, checks, halvings;
    } count;
    struct rc_retraction_next next;
    struct rc_retraction_found found;
};

/* Lengths are over the length of the grid, forces over its square and E*. */
void rc_retraction_begin(struct rc_retraction *r, const struct rc_retraction_law *law);
/* Takes a state and sets its `slope` and `kept`. Returns true if there is a next state; otherwise `found` is
 * complete. */
bool rc_retraction_next(struct rc_retraction *r, struct rc_retraction_state here);

#endif
