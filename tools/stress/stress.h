/*
 * The face of this folder: what rc-stress says about a case, in its --report and its --dry-run, and the
 * plastic strain that it finds beside the pressure.
 */
#ifndef RC_TOOL_STRESS_H
#define RC_TOOL_STRESS_H

#include <stdio.h>

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

struct stress_place {
    double value, x, y, depth; /* Pa, m; NAN: none */
};

/* The largest value of a channel, or its least, and where it is. */
struct stress_extreme {
    struct stress_place all;
    struct stress_place *by_material; /* value NAN: no depth is in it      */
    double *by_depth;                 /* at each depth; NULL: nobody asks  */
};

enum stress_end {
    STRESS_LARGEST,
    STRESS_LEAST,
    STRESS_ENDS
};

struct stress_report {
    const struct rc_grid *p;
    const struct rc_stress_options *options;
    const struct numbers *depths;
    struct stress_extreme extreme[STRESS_ENDS][RC_STRESSES];
    double began, depth_began, setup, slices; /* seconds */
};

/* All three are kept by the caller. `extremes`: the largest and least values are wanted. */
enum rc_status stress_report_begin(struct stress_report *report, const struct rc_grid *p,
                                   const struct rc_stress_options *options,
                                   const struct numbers *depths, bool extremes, struct rc_err *err);
/* The plan stands; a depth begins; depth k of n values a channel is there. */
void stress_report_ready(struct stress_report *report);
void stress_report_start(struct stress_report *report);
void stress_report_depth(struct stress_report *report, const struct tool *tool, size_t k, size_t n,
                         double *const *s);
/* The row of the case. */
void stress_report_write(struct stress_report *report, struct report *out,
                         const struct rc_stress *stress);
void stress_report_free(struct stress_report *report);

/* What would be done, in words, in so many bytes; a part of the map is tried for the time. RC_FAIL when that
 * fails, as the whole then would. */
enum rc_status stress_report_plan(const struct tool *tool, const struct rc_grid *p,
                                  const struct rc_stress_options *options,
                                  const struct numbers *depths, size_t memory, struct rc_err *err);

/* ---- strain.c ---- */

/* What a case holds of plastic strain. */
struct stress_strain {
    struct rc_eigenstrain strain;
    struct rc_grid **frame; /* of its maps */
    const double **map;
    double *thickness;
    size_t slabs, maps;
};
/* Takes a frame that follows the pressure p in its case; false: it is none of these. `strain` is 0 before
 * the first. */
bool stress_strain_take(struct tool *tool, const struct rc_grid *p, struct rc_grid *g,
                        struct stress_strain *strain);
/* After the case. False: the body has not yielded, or not all of the strain was in the stream, which is
 * warned of. */
bool stress_strain_whole(struct tool *tool, const struct rc_grid *p, struct stress_strain *strain);
void stress_strain_free(struct stress_strain *strain);
/* Depths to look at, *n of them, which the caller frees; NULL when memory is short. */
double *stress_strain_depths(const struct stress_strain *strain, size_t *n);

#endif
