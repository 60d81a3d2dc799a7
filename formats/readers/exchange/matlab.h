/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the map that the variables of a MATLAB file define, in any version of the file; see mat.c,
 * mat73.c. */
#ifndef RC_MATLAB_H
#define RC_MATLAB_H

#include "formats/format.h"

struct rc_matlab_array {
    char name[64];
    const char *other; /* its kind, if it is not a real array of numbers; otherwise NULL */
    bool is_text;
    size_t rows, columns, more; /* more: dimensions that are neither */
    double first;               /* its single number; NAN: none */
    char text[16];
    size_t at; /* for the source */
};

/* A file's variables, one by one. */
struct rc_matlab_source {
    const struct rc_file *file;
    void *arg;
    void (*start)(struct rc_matlab_source *source);
    /* Reads the next variable: RC_MORE; RC_OK: there is none; RC_FAIL: the file is damaged. */
    enum rc_status (*next)(struct rc_matlab_source *source, struct rc_matlab_array *array,
                           struct rc_err *err);
    /* Its rows*columns numbers, column after column. */
    enum rc_status (*numbers)(struct rc_matlab_source *source, const struct rc_matlab_array *array,
                              double *v, struct rc_err *err);
    /* Says where these lie. */
    enum rc_status (*place)(struct rc_matlab_source *source, const struct rc_matlab_array *array,
                            struct rc_map *map, struct rc_err *err);
};

/* Adds the channels with their spacings and units; RC_FAIL where there is none, which names what there is
 * instead. */
enum rc_status rc_matlab_maps(struct rc_matlab_source *source, struct rc_maps *maps,
                              struct rc_err *err);

#endif
