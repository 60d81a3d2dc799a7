/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The images of a map that repeats along one axis. The sweeps make it repeat along the free axis too, after
 * its padded length. For what varies along the repeating axis the images are as far as those of a free map.
 * For its mean along this axis they are images of lines, whose effect falls with the square of the distance
 * only. This mean is a profile, which costs little: two more stacks solve it with the padded length and with
 * RC_SLABS_FAR times that length, and the difference of the two is added. Internal: never installed.
 */
#ifndef RC_LINES_H
#define RC_LINES_H

#include "volume.h"

struct rc_lines;

/* `period`: nodes of the padded free axis. NULL when memory is short. */
struct rc_lines *rc_lines_new(const struct rc_shape *shape, const struct rc_slabs_options *options,
                              size_t period, struct rc_err *err);
void rc_lines_free(struct rc_lines *lines); /* NULL is allowed */
RC_OWNER(rc_lines)

/* As those of struct rc_slabs, for the difference. `strain` is read a second time. */
void rc_lines_up(struct rc_lines *lines, const struct rc_slab_strain *strain, bool u);
void rc_lines_down(struct rc_lines *lines, const double *p, const struct rc_slab_stress *stress);
void rc_lines_through(struct rc_lines *lines);
void rc_lines_slice(struct rc_lines *lines, double depth, unsigned components);

/* Adds the difference to row j: of the displacement, and of the stress of a slab (of the slice: 0). NULL:
 * nothing is added. */
void rc_lines_add_u(const struct rc_lines *lines, size_t j, double *row);
void rc_lines_add_stress(const struct rc_lines *lines, size_t slab, enum rc_component c, size_t j,
                         double *row);

#endif
