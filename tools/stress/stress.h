/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: --report and --dry-run of rc-stress, and the plastic strain in a case.
 */
#ifndef RC_TOOL_STRESS_H
#define RC_TOOL_STRESS_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"
#include "tools/frames/frames.h"

struct stress_place {
    double value, x, y, depth; /* Pa, m; NAN: none */
};

/* The largest or the smallest value of a channel, with its position. */
struct stress_extreme {
    struct stress_place all;
    struct stress_place *by_material; /* for each material; value NAN: no depth is in it */
    double *by_depth;                 /* at each depth; NULL: not requested */
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

/* The caller keeps all three. `extremes`: the largest and smallest values are requested. */
enum rc_status stress_report_begin(struct stress_report *report, const struct rc_grid *p,
                                   const struct rc_stress_options *options,
                                   const struct numbers *depths, bool extremes, struct rc_err *err);
/* When depth k, begun at depth_began, with n values per channel is done. */
void stress_report_depth(struct stress_report *report, const struct tool *tool, size_t k, size_t n,
                         double *const *s);
/* Writes the row of the case. */
void stress_report_write(struct stress_report *report, struct report *out,
                         const struct rc_stress *stress);
void stress_report_free(struct stress_report *report);

/* Prints the planned work and its memory; a trial on a part of the map gives the time. RC_FAIL if the trial
 * fails, because then the whole would fail too. */
enum rc_status stress_report_plan(struct tool *tool, struct report *report, const struct rc_grid *p,
                                  const struct rc_stress_options *options,
                                  const struct numbers *depths, size_t memory, struct rc_err *err);

/* ---- input.c ---- */

/* Options of all tools that compute stresses; the tables are groups of struct opt. */
struct stress_asked {
    double nu, mu, tol; /* NAN: not given */
    const char *kernel;
    struct boundary_args repeats;
    bool residual; /* residual: without the pressure */
};
#define STRESS_ASKED                                                                               \
    {                                                                                              \
        .nu = NAN, .tol = NAN, .kernel = "auto"                                                    \
    }
extern const struct opt stress_body_options[], stress_sum_options[];

/* The body and the tractions of a case. */
struct stress_input {
    struct rc_grid *traction[2]; /* along x, along y; NULL: none */
    struct layers layers;
};
/* Keeps a frame of traction; false: it is another frame. */
bool stress_input_take(struct tool *tool, const struct rc_grid *p, struct rc_grid *g,
                       struct stress_input *input);
/* Sets all options but `wanted`, the section and the strain. Ends the tool where stream and options
 * contradict each other. */
void stress_input_read(struct tool *tool, const struct rc_grid *p, const struct stress_asked *asked,
                       struct stress_input *input, struct rc_stress_options *options);
void stress_input_free(struct stress_input *input);
/* Engines for periodic maps also compute sections: both are sums of waves. */
bool stress_on_free_maps_only(const char *kernel);
/* Chooses the depths if there are none, and sets them in the options. Refuses those in a rigid substrate, and
 * warns of those far below. */
void stress_depths_read(struct tool *tool, const struct rc_grid *p,
                        struct rc_stress_options *options, struct numbers *depths);
/* Bytes of a plan for so many components, from bytes a node measured on 1024 x 1024 nodes. */
size_t stress_plan_bytes(const struct rc_grid *p, const struct rc_stress_options *options,
                         size_t components);

/* ---- strain.c ---- */

/* The plastic strain of a case. */
struct stress_strain {
    struct rc_eigenstrain strain;
    struct rc_grid **frame; /* frames of its maps */
    const double **map;
    double *thickness;
    size_t slabs, maps;
};
/* Takes a frame that follows the pressure p in its case; false: it is not plastic strain. `strain` is 0
 * before the first. */
bool stress_strain_take(struct tool *tool, const struct rc_grid *p, struct rc_grid *g,
                        struct stress_strain *strain);
/* Call it after the case. False: the body has not yielded, or the stream lacks some of the strain, with a
 * warning. */
bool stress_strain_whole(struct tool *tool, const struct rc_grid *p, struct stress_strain *strain);
void stress_strain_free(struct stress_strain *strain);
/* Chooses *n depths, which the caller frees; NULL when memory is short. */
double *stress_strain_depths(const struct stress_strain *strain, size_t *n);

#endif
