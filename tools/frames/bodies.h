/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The bodies of a contact in the keys of a stream: `e1 nu e2 nu2` and, for a layered body 1, `layers`.
 * `layers` has "t,E,nu" of each material in SI, the top first, joined by ";", the substrate last with t =
 * inf. e2 and nu2 are absent when body 2 is rigid. All four are absent when only the composite modulus
 * `estar` is known. Residual stresses of layers, in Pa, the top first and joined by ";", are in
 * `layers.residual`.
 */
#ifndef RC_TOOL_BODIES_H
#define RC_TOOL_BODIES_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

/* Body 1 from its key `layers`. */
struct layers {
    const char *text;       /* value of the key, owned by the frame; NULL: no layers */
    struct rc_layer *layer; /* the substrate last; NULL: no layers */
    struct rc_body body;    /* undefined for a bare body */
    double *residual;       /* Pa, of each layer; NULL: none          */
};

/* RC_FAIL if the key is invalid. */
enum rc_status layers_read(const struct rc_grid *grid, struct layers *layers, struct rc_err *err);
void layers_free(struct layers *layers);

/* In place of the modulus of a layer: it is that of --relaxation. */
#define LAYER_RELAXES "relaxation"
/* Reads one layer of a command line, "2um,300GPa,0.25", or with a residual stress,
 * "2um,300GPa,0.25,-3GPa". relaxes: the instantaneous modulus of --relaxation, or 0; *is: the layer has
 * this modulus. */
enum rc_status layer_read(const char *text, struct rc_layer *layer, double *residual,
                          double relaxes, bool *is, struct rc_err *err);

/* Ends the tool for a viscoelastic body, whose moduli in the stream are those of fast loads. */
void bodies_demand_elastic(struct tool *tool, const struct rc_grid *grid, const char *remedy);

/* (1 - nu^2)/E of a half-space; 0 for a rigid one, whose E is infinite, or 0 in struct rc_body. */
double bodies_compliance(double e, double nu);
/* Reads both bodies from the keys of the frame: from its `layers`, if it has any, or from E*. RC_FAIL if the
 * keys do not define them. */
enum rc_status bodies_read(const struct rc_grid *grid, const struct layers *layers,
                           struct rc_pair *pair, struct rc_err *err);
/* Sets all these keys and removes those of other bodies; residual: stresses of the layers, Pa, NULL: none. */
void bodies_set(struct tool *tool, struct rc_grid *grid, const struct rc_pair *pair,
                const double *residual);

#endif
