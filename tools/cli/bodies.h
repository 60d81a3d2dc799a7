/*
 * The bodies of a contact as a stream has them: the keys `e1 nu e2 nu2` and, of a layered body 1,
 * `layers`, "t,E,nu" of each material in SI, the top first, joined by ";", the substrate last with
 * t = inf. e2 and nu2 are absent when body 2 is rigid; all four are when only the composite modulus
 * `estar` is known. Layers with residual stresses have them, in Pa, top first and joined by ";", in
 * `layers.residual`.
 */
#ifndef RC_TOOL_BODIES_H
#define RC_TOOL_BODIES_H

#include "libcontact/contact.h"

/* Body 1 by its key `layers`. */
struct layers {
    const char *text;       /* the key, kept by the frame; NULL: bare */
    struct rc_layer *layer; /* the substrate last; NULL: bare         */
    struct rc_body body;    /* bare: nothing is known of it           */
    double *residual;       /* Pa, of each layer; NULL: none          */
};

/* RC_FAIL where the key makes no sense. */
enum rc_status layers_read(const struct rc_grid *grid, struct layers *layers, struct rc_err *err);
void layers_free(struct layers *layers);

/* One layer as it stands on a command line, "2um,300GPa,0.25", or with a residual stress, Pa,
 * "2um,300GPa,0.25,-3GPa". */
enum rc_status layer_read(const char *text, struct rc_layer *layer, double *residual,
                          struct rc_err *err);

/* Both bodies: as in `layers`, which was read from the same frame, and else by E*. RC_FAIL where the keys
 * do not say it. */
enum rc_status bodies_read(const struct rc_grid *grid, const struct layers *layers,
                           struct rc_pair *pair, struct rc_err *err);
/* Sets all these keys, and takes away those of other bodies; residual stresses of the layers, Pa: NULL is
 * none. */
enum rc_status bodies_set(struct rc_grid *grid, const struct rc_pair *pair, const double *residual,
                          struct rc_err *err);

#endif
