/*
 * The search for the lowest load of a retraction: which approach comes next, and from which state the way
 * to it begins. It sees loads only; adhesion.c has the states, and keeps those that the search may go
 * back to.
 */
#ifndef RC_RETRACTION_H
#define RC_RETRACTION_H

#include <stdbool.h>
#include <stddef.h>

enum {
    RC_RETRACTION_KEPT = 4,   /* states that are kept, at most */
    RC_RETRACTION_CHECKS = 8, /* states beside the lowest, at most */
    RC_RETRACTION_HERE = -1   /* the state that has just been found */
};

/* A state of the retraction, over the length and E*. */
struct rc_retraction_state {
    double c, load, attraction;
    double radius;   /* of a circle as large as the contact                                    */
    double mean_gap; /* over the map                                                           */
    size_t jumps;    /* that the way to it was seen to take                                    */
    double slope,
        rate; /* of load and attraction over c, as the way to it tells; where it jumped, as before */
    int kept; /* as which state                                                         */
};

enum rc_retraction_stage {
    RC_RETRACTION_COARSE, /* until the bodies have parted                              */
    RC_RETRACTION_FINE,   /* again, in steps that hide no lower load                   */
    RC_RETRACTION_VERTEX, /* where the parabola about the lowest is lowest             */
    RC_RETRACTION_CHECK   /* whether the parabola holds beside its vertex                */
};

struct rc_retraction {
    double work, range, parted; /* of the law; the mean gap beyond which nothing holds */
    enum rc_retraction_stage stage;
    /* in the order of the retraction; the fine stage begins at `base` */
    struct rc_retraction_state base, prior, last, before, lowest, after;
    bool has_base, has_prior, has_before, has_after;
    bool rough;       /* the load does not fall as on a path without jumps                       */
    double step;      /* to the state under way                                                 */
    double stiffness; /* the last slope above 0 of a way without a jump                          */
    double stiffest;  /* the largest                                                             */
    double known;     /* the lowest load of the coarse stage                                     */
    double hidden;    /* the lowest load that a way since `base` may hide                        */
    double beside;    /* that the way from the lowest to `after` may hide                        */
    double to;        /* the end of the last way that may hide a lower load                      */
    double estimate, at_estimate,
        bend;      /* of the parabola: its lowest load, where, and half its second derivative */
    double missed; /* by how much a load was another than that of the parabola               */
    double around; /* the bend of the coarse stage's parabola; above 0 where there is one    */
    double late;   /* and its end                                                            */
    /* Where the search ended, and beside it: how far off, and the load. */
    double beside_way[RC_RETRACTION_CHECKS + 1], beside_load[RC_RETRACTION_CHECKS + 1];
    size_t beside_n;
    size_t states, fine, vertices, checks;
    /* what to do next: keep the state as `keep`, unless that is below 0; it is the lowest so far; go from
     * `from`, which is that of from_c, to c */
    int keep, from;
    bool is_lowest;
    double from_c, c;
    /* at the end */
    double load, at, spread;
    bool short_of; /* of states */
};

/* Lengths over the length of the grid, the work over length and E*. */
void rc_retraction_begin(struct rc_retraction *r, double work, double range, double parted);
/* Takes a state, whose `slope` and `kept` it sets itself; true: there is a next one, else load, at and
 * spread are found. */
bool rc_retraction_next(struct rc_retraction *r, struct rc_retraction_state here);

#endif
