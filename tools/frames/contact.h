/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The nodes in contact and the boundary, from the frames of a case. All tools use these definitions.
 */
#ifndef RC_TOOL_CONTACT_H
#define RC_TOOL_CONTACT_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

#define CONTACT_CHANNEL "contact"

/* The frame from whose values rc_in_contact finds the touching nodes. It is `contact`, in the case of the
 * pressure p and on its grid, or p itself if `contact` is NULL. NULL if both are NULL. Also NULL, with a
 * warning, if p is a net pressure of bodies that attract each other, which does not determine the contact.
 * Ends the tool if a value of `contact` is neither 0 nor 1, and warns if the pressure of other bodies is
 * negative. */
const struct rc_grid *contact_frame(struct tool *tool, const struct rc_grid *p,
                                    const struct rc_grid *contact);
/* The same, but ends the tool instead of returning NULL; `what` needs the contact (with a verb, as in
 * "--patches needs to know"). */
const struct rc_grid *contact_demand(struct tool *tool, const struct rc_grid *p,
                                     const struct rc_grid *contact);

/* The same two for frames that are not in memory: `wrong` values of `contact` are neither 0 nor 1, and
 * `negative` values of p are negative (contact_negative). */
const struct rc_grid *contact_counted(struct tool *tool, const struct rc_grid *p,
                                      const struct rc_grid *contact, bool demanded, size_t wrong,
                                      double negative);
/* True for a value that is negative by more than rounding beside the largest one, `most`, at least 0. */
bool contact_negative(double v, double most);

/* ---- rolling ---- */

/* Warns of a creepage above 0.05 that was given as a plain number: in per cent it is 100 times as small.
 * `text`: one component of --creep, or a range; v: its n values. */
void creep_judge(struct tool *tool, const char *text, const double *v, size_t n);

/* ---- the boundary ---- */

/* The options --periodic and --datum. */
struct boundary_args {
    const char *periodic; /* NULL: not given; else "", "x", "y" or "xy" */
    double datum;         /* m; NAN: not given */
};
#define BOUNDARY_NONE                                                                              \
    {                                                                                              \
        .datum = NAN                                                                               \
    }
/* A row of a tool's table for each, with .at of a struct boundary_args in the arguments. */
#define OPT_PERIODIC(place, says)                                                                  \
    {                                                                                              \
        .name = "periodic", .type = OPT_CHOICE, .arg = "xy|x|y", .optional = true, .result = true, \
        .at = (place) + offsetof(struct boundary_args, periodic), .help = says                     \
    }
#define OPT_DATUM(place)                                                                           \
    {                                                                                              \
        .name = "datum", .type = OPT_NUMBER, .unit = UNIT_M, .min = 0, .max = INFINITY,            \
        .above = true, .result = true, .arg = "LENGTH",                                            \
        .at = (place) + offsetof(struct boundary_args, datum),                                     \
        .needs = RULES({.with = "periodic x|periodic y"}),                                         \
        .help = "distance at which a line load does not displace the surface (default: the "       \
                "length of the map across the axis that repeats)"                                  \
    }
/* The boundary that these ask for. */
struct rc_boundary boundary_asked(const struct boundary_args *asked);

/* The axes along which a surface repeats: its key `periodic`. */
struct rc_boundary map_repeats(const struct rc_grid *g);
void map_set_repeats(struct tool *tool, struct rc_grid *g, struct rc_boundary repeats);
/* The surface does not repeat along these axes any more. NULL if it did not before. Otherwise sets the
 * key and returns the end of "it is not periodic": "" or, if it still repeats along the other axis, "
 * along x". */
const char *map_end_period(struct tool *tool, struct rc_grid *g, struct rc_boundary ends);
/* The boundary of a result is in its keys `boundary` and `datum`; without them that of the surface holds. */
struct rc_boundary map_boundary(const struct rc_grid *g);
void map_set_boundary(struct tool *tool, struct rc_grid *g, struct rc_boundary boundary);
/* The boundary of the contact that p was solved for; if p does not say, the options do. Ends the tool if the
 * two contradict each other. */
struct rc_boundary contact_boundary(struct tool *tool, const struct rc_grid *p,
                                    const struct boundary_args *asked);
/* The fields of a report: boundary and, if one axis repeats, the datum of the displacement. */
void boundary_report(struct report *report, const struct rc_grid *g, struct rc_boundary boundary);
/* The state of the effect "padding". */
const char *boundary_padding(struct rc_boundary boundary);

#endif
