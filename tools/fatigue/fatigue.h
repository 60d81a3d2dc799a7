/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: the endurance limits and the residual stress of rc-fatigue.
 */
#ifndef RC_TOOL_FATIGUE_H
#define RC_TOOL_FATIGUE_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

/* As on the command line: numbers of each material, the top first, or a table of depths. */
struct fatigue_limits_asked {
    struct numbers bending, torsion, yield;
    const char *table;
};

/* Limits at depths: of a table, or of materials. */
struct fatigue_limits {
    const struct fatigue_limits_asked *asked;
    double *depth; /* of a table, rising; NULL: of materials */
    struct rc_fatigue_limits *at;
    size_t n;
};
/* Ends the tool if a wanted criterion lacks its limits or is not defined for them. */
void fatigue_limits_read(struct tool *tool, const struct fatigue_limits_asked *asked,
                         unsigned wanted, struct fatigue_limits *limits);
/* Ends the tool unless a list has one number, or one for each material of the body. */
void fatigue_limits_check(struct tool *tool, const struct rc_grid *p,
                          const struct fatigue_limits *limits, const struct rc_body *body);
/* Those at this depth; a table is interpolated, and its ends hold beyond it. */
struct rc_fatigue_limits fatigue_limits_at(const struct fatigue_limits *limits,
                                           const struct rc_body *body, double depth);
void fatigue_limits_free(struct fatigue_limits *limits);

/* Stresses that do not depend on the position along the travel, at each depth of a file. */
struct fatigue_residual {
    const char *name; /* of the file; NULL: none */
    size_t n, room, lines;
    double *depth;
    double **line[RC_COMPONENTS]; /* Pa, the mean along the travel; NULL: 0 */
};
/* pass: 'x' or 'y'. Ends the tool if the file cannot be read. It also ends if a stress varies along the
 * travel by more than 10 % of the largest stress of its depth. */
void fatigue_residual_read(struct tool *tool, const char *name, char pass,
                           struct fatigue_residual *residual);
/* The stresses at this depth; NULL without a file. Ends the tool if the file has none there. */
const double *const *fatigue_residual_at(struct tool *tool, const struct fatigue_residual *residual,
                                         size_t lines, double depth,
                                         const double *at[RC_COMPONENTS]);
void fatigue_residual_free(struct fatigue_residual *residual);

#endif
