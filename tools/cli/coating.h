/*
 * What a coated body is made of: the key `layers` of a stream, "t,E,nu" of each material in SI, the top
 * first, joined by ";", the substrate last with t = inf.
 */
#ifndef RC_TOOL_COATING_H
#define RC_TOOL_COATING_H

#include "libcontact/contact.h"

struct coating {
    const char *text;       /* the key, kept by the frame; NULL: one material */
    struct rc_layer *layer; /* the substrate last                             */
    struct rc_coating coating;
};

/* From the key of a frame; RC_FAIL where it makes no sense. The other body is rigid as far as the key
 * says. */
enum rc_status coating_read(const struct rc_grid *grid, struct coating *coating,
                            struct rc_err *err);
void coating_free(struct coating *coating);
/* Material at a depth (m), 0 the top; an interface belongs to the one above it. */
size_t coating_material(const struct coating *coating, double depth);

/* One layer as it stands on a command line, "2um,300GPa,0.25". */
enum rc_status coating_layer(const char *text, struct rc_layer *layer, struct rc_err *err);
/* Sets the key; NULL takes it away. */
enum rc_status coating_set(struct rc_grid *grid, const struct rc_coating *coating,
                           struct rc_err *err);

#endif
