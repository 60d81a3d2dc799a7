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
    double radius;   /* radius of a circle with the area of the contact */
    double mean_gap; /* mean gap over the map */
    double slope,
        rate; /* slopes of load and attraction over c on the step to it; after a jump, the slopes
                 before it */
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

struct rc_retraction {
    double work, range, parted; /* work and range of the law; `parted`: the mean gap without
                                   attraction */
    enum rc_retraction_stage stage;
    /* states in the order of the retraction; the fine stage begins at `base` */
    struct rc_retraction_state base, prior, last, before, lowest, after;
    bool has_base, has_prior, has_before, has_after;
    bool rough;       /* the load does not fall like that of a path without jumps */
    double step;      /* step to the next state */
    double stiffness; /* the last positive slope of a step without a jump */
    double stiffest;  /* the largest                                                             */
    double known, known_at; /* the lowest load of the stages before, and its place */
    double hidden;          /* the lowest load that a step since `base` may hide */
    double beside; /* the lowest load that the step from the lowest state to `after` may hide */
    double to;     /* the end of the last step that may hide a lower load */
    double estimate, at_estimate,
        bend;      /* the parabola: its lowest load, its place, and half its second derivative */
    double missed; /* largest difference of a load from the parabola */
    double around; /* the bend of the parabola of the coarse stage; 0: there is none */
    double late;   /* the end of that parabola */
    bool leaps;    /* a checked load was far above it */
    /* The lowest point and the points beside it: distance and load. */
    double beside_way[RC_RETRACTION_CHECKS + 1], beside_load[RC_RETRACTION_CHECKS + 1];
    size_t beside_n;
    struct rc_retraction_step steps[RC_RETRACTION_STEPS]; /* the last ones of the fine stage */
    size_t steps_n;
    size_t states, fine, vertices, checks, halvings;
    /* the next step: keep the state as `keep`, unless that is below 0; start from state `from`, which has
     * from_c, and go to c. is_lowest: the state has the lowest load so far */
    int keep, from;
    bool is_lowest;
    double from_c, c;
    /* at the end */
    double load, at, spread;
    bool short_of; /* the search ran out of states */
};

/* Lengths are over the length of the grid, the work over this length and E*. */
void rc_retraction_begin(struct rc_retraction *r, double work, double range, double parted);
/* Takes a state and sets its `slope` and `kept`. Returns true if there is a next state; otherwise load, at
 * and spread are found. */
bool rc_retraction_next(struct rc_retraction *r, struct rc_retraction_state here);

#endif
