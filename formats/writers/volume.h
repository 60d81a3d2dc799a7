/*
 * Frames as one block of nodes, for the formats of VTK: maps on one grid beside each other, maps at
 * several depths above each other, or a section with its depths.
 *
 * x, y and z are those of the grid stream: the origin in the middle of the map, y down the picture,
 * z into the body; together they are right-handed.
 */
#ifndef RC_VOLUME_H
#define RC_VOLUME_H

#include "encode.h"
#include "formats/export.h"
#include "stack.h"

/* A value at every node: one frame a layer. */
struct rc_layers {
    struct rc_stack stack;
    char name[RC_LABEL];
    enum rc_raw raw;
};

struct rc_volume {
    size_t n[3];   /* nodes along x, y, z             */
    double *at[3]; /* n of them: where the nodes are  */
    size_t layers; /* frames in each stack            */
    size_t node;   /* values in a layer               */
    struct rc_layers *array;
    size_t arrays;
};

/* RC_FAIL for frames that do not fit together. Free it in either case. */
enum rc_status rc_volume_make(struct rc_volume *volume, struct rc_grid *const *frame, size_t frames,
                              const struct rc_export_wish *wish, struct rc_err *err);
void rc_volume_free(struct rc_volume *volume);

/* Bytes that an array of n values takes in the file, with the count before it. */
uint64_t rc_vtk_bytes(size_t n, enum rc_raw raw);
/* The attributes and the keys of the arrays as a header: `<PointData>...`, from byte `offset` of
 * the appended data on. */
void rc_vtk_arrays(struct rc_buffer *b, const struct rc_volume *volume, uint64_t offset);
/* The history of the first frame, as field data. */
void rc_vtk_history(struct rc_buffer *b, const struct rc_grid *grid);
/* One array of the appended data: its length in bytes and its values. */
enum rc_status rc_vtk_put(FILE *out, const double *v, size_t n, enum rc_raw raw,
                          struct rc_err *err);
enum rc_status rc_vtk_put_arrays(FILE *out, const struct rc_volume *volume, struct rc_err *err);

enum {
    RC_VTK_TYPES = RC_TYPE_F32 | RC_TYPE_F64
};

#endif
