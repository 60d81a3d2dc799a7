/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Declarations for the files of the X3P reader; see x3p.c. */
#ifndef RC_X3P_INTERNAL_H
#define RC_X3P_INTERNAL_H

#include "formats/containers/containers.h"
#include "formats/core/core.h"
#include "formats/format.h"

enum {
    RC_X3P_NAME = 1024 /* bytes of a member's name */
};

/* The data taken from main.xml. */
enum rc_x3p_field {
    RC_X3P_FEATURE,
    RC_X3P_CX_AXIS,
    RC_X3P_CX_TYPE,
    RC_X3P_CX_INCREMENT,
    RC_X3P_CX_OFFSET,
    RC_X3P_CY_AXIS,
    RC_X3P_CY_TYPE,
    RC_X3P_CY_INCREMENT,
    RC_X3P_CZ_TYPE,
    RC_X3P_CZ_INCREMENT,
    RC_X3P_CZ_OFFSET,
    RC_X3P_SIZE_X,
    RC_X3P_SIZE_Y,
    RC_X3P_SIZE_Z,
    RC_X3P_LIST,
    RC_X3P_POINTS,
    RC_X3P_POINTS_MD5,
    RC_X3P_VALID,
    RC_X3P_VALID_MD5,
    RC_X3P_MD5_FILE,
    RC_X3P_FIRST_KEY, /* from here on: stored as keys of the frame */
    RC_X3P_FIELDS = RC_X3P_FIRST_KEY + 11
};

/* Where the numbers of a point are, and what they mean. */
struct rc_x3p_points {
    bool absolute;               /* a profile with a position for each point */
    bool absolute_x, absolute_y; /* the same of a map                                      */
    enum rc_raw raw_x, raw_y;    /* numbers of a point: x, y if that axis is absolute too, and z */
    size_t before_y, before_z;   /* bytes of a point that come before y, before z            */
    double x_increment, x_offset, y_increment;
};

/* Heights that were in main.xml; positions and heights by turns. */
struct rc_x3p_list {
    double *value;
    size_t n, capacity;
};

struct rc_x3p {
    struct rc_zip_read *archive;
    size_t main, points;       /* members; points: where they are binary                       */
    char prefix[RC_X3P_NAME];  /* the folder that main.xml lies in, with its slash, or ""      */
    char md5[RC_MD5_TEXT];     /* MD5 of main.xml */
    char *text[RC_X3P_FIELDS]; /* NULL: not in the file                                        */
    bool is_x3p, turned;       /* turned: a rotation that is not the identity                  */
    bool old_root;             /* main.xml calls its root ISO5436, without the part            */
    bool profile;
    bool binary; /* the heights are in a separate member */
    enum rc_raw raw;
    size_t nx, ny, n; /* n = nx*ny                                                    */
    double dx, dy;    /* m, NAN when not given                                        */
    double increment, offset;
    struct rc_x3p_points at;
    struct rc_x3p_list list;
};

/* Reads and checks main.xml: RC_FAIL if the data is not a map on a regular grid. */
enum rc_status rc_x3p_head(struct rc_x3p *x, struct rc_err *err);
/* The key of the grid that stores a field, for fields from RC_X3P_FIRST_KEY on. */
const char *rc_x3p_key(size_t field);

/* Notes a wrong checksum of main.xml. */
void rc_x3p_check_main(struct rc_x3p *x, struct rc_notes *notes);
/* Finds the member of the heights and checks its size before anything is allocated for it. */
enum rc_status rc_x3p_find_points(struct rc_x3p *x, size_t *member, struct rc_err *err);
/* Reads the x->n positions of a profile that is `absolute`, rising and in metres, and behind them
 * its heights; the caller frees them. NULL with the reason. */
double *rc_x3p_profile(struct rc_x3p *x, struct rc_notes *notes, struct rc_err *err);
/* The points of a map or profile, as they lie in their member of `size` bytes, which the caller frees; NULL
 * with the reason. */
unsigned char *rc_x3p_unpack_points(struct rc_x3p *x, size_t member, size_t size,
                                    struct rc_notes *notes, struct rc_err *err);
/* Sets x->dx and dy of a map with absolute axes by its points, and puts their numbers into v unless it is
 * NULL. RC_FAIL where the places do not form an even grid. */
enum rc_status rc_x3p_axes(struct rc_x3p *x, const struct rc_file *file, double *v,
                           struct rc_notes *notes, struct rc_err *err);
/* Puts the heights into v, in metres; missing ones are NAN. */
enum rc_status rc_x3p_values(struct rc_x3p *x, const struct rc_file *file, size_t member, double *v,
                             struct rc_notes *notes, struct rc_err *err);

#endif
