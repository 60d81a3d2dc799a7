/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The noun of the toolkit: one map on one regular grid, with the words that travel with it.
 *
 *          i = 0 .... nx-1    x = (i - (nx-1)/2) dx, along a row
 *     j=0  v[0]  v[1] ...     y = (j - (ny-1)/2) dy, down the picture
 *      :   v[nx] ...          value (i, j) stands for its cell: v[j*nx + i]
 *
 * Everything is SI. This header is all that formats/ may include.
 */
#ifndef RC_GRID_H
#define RC_GRID_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The names that the shared library offers; all others stay inside. */
#if defined(__GNUC__)
#define RC_API __attribute__((visibility("default")))
#else
#define RC_API
#endif

/* ---- status and errors ---- */

enum rc_status {
    RC_OK = 0,    /* done */
    RC_MORE = 1,  /* an iteration that has not finished: not an error */
    RC_SHORT = 2, /* an iteration that cannot reach the asked accuracy */
    RC_FAIL = -1, /* it could not be done; struct rc_err says why */
};

/* One sentence, owned by the caller: the offending value, the rule it broke, what to do. */
struct rc_err {
    char text[512];
};

/* Sets the sentence (printf style; cut at the size of the text) and returns RC_FAIL. err may be
 * NULL. */
RC_API enum rc_status rc_err_set(struct rc_err *err, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 2, 3)))
#endif
    ;

/* ---- memory ---- */

/* Memory allocated by the library and the tools, in bytes. Code, stacks of threads, arrays of the caller and
 * memory of other libraries are not included. */
struct rc_memory {
    /* now */
    size_t held;
    /* the most so far */
    size_t peak;
    /* the memory with the block that was refused last since the budget was set; 0: none */
    size_t refused;
};

/* Largest number of bytes that the library may allocate in this process; 0, the default: no limit. A call
 * that would need more fails as if memory were short; makers and verbs allocate their maps before they
 * iterate. */
RC_API void rc_memory_budget(size_t bytes);
/* True if so many more bytes may be allocated. */
RC_API bool rc_memory_ask(size_t bytes);
/* The memory in use now and at most. */
RC_API struct rc_memory rc_memory_held(void);

/* ---- shape of a map ---- */

/* The parts of a grid that computations on arrays need. Sizes count nodes; spacings are in metres. */
struct rc_shape {
    size_t nx, ny;
    double dx, dy;
};

/* RC_FAIL for a zero size, a spacing that is not from 1e-60 to 1e60, or a node count whose bytes
 * would overflow size_t. */
RC_API enum rc_status rc_shape_check(const struct rc_shape *shape, struct rc_err *err);

enum rc_map_axis {
    RC_X,
    RC_Y
};

/* How the map continues beyond its edges, axis by axis. Pressure is constant in a cell along a free axis, and
 * band-limited along an axis that repeats. */
struct rc_boundary {
    /* true: the map repeats without end along this axis; false: the surface of the half-space extends,
     * without load, beyond the map */
    bool x, y;
    /* m; used if exactly one axis repeats: the displacement of a line load has no limit, and is taken as 0 at
     * this distance from the load. 0: the length of the free axis. Pressure, area and gap do not depend on
     * it. */
    double datum;
};

/* The boundary that repeats along these axes. */
static inline struct rc_boundary
rc_boundary_of(bool x, bool y)
{
    struct rc_boundary boundary;

    boundary.x = x;
    boundary.y = y;
    boundary.datum = 0;
    return boundary;
}

/* No axis repeats; both do. */
#define RC_FREE rc_boundary_of(false, false)
#define RC_PERIODIC rc_boundary_of(true, true)

/* True if the map repeats along this axis. */
static inline bool
rc_wraps(struct rc_boundary boundary, enum rc_map_axis axis)
{
    return axis == RC_X ? boundary.x : boundary.y;
}

/* How many of the two axes repeat: 0, 1 or 2. */
static inline int
rc_repeats(struct rc_boundary boundary)
{
    return (int)boundary.x + (int)boundary.y;
}

/* The word of the key `periodic` of a surface that repeats so: yes, no, x, y. */
static inline const char *
rc_repeats_word(struct rc_boundary boundary)
{
    return rc_repeats(boundary) == 2 ? "yes" : boundary.x ? "x" : boundary.y ? "y" : "no";
}

/* True if a uniform pressure displaces the surface relative to a point far away: some axis is free. */
static inline bool
rc_has_mean(struct rc_boundary boundary)
{
    return rc_repeats(boundary) < 2;
}

/* A cost that is proportional to the padded map, twice as long along each free axis, from its values on
 * a free map and on one that repeats along both axes. */
static inline double
rc_by_padding(struct rc_boundary boundary, double free_map, double periodic)
{
    return rc_repeats(boundary) == 0   ? free_map
           : rc_repeats(boundary) == 2 ? periodic
                                       : periodic + (free_map - periodic) / 3;
}

/* True if both repeat along the same axes. The datum is not compared. */
static inline bool
rc_same_boundary(struct rc_boundary a, struct rc_boundary b)
{
    return a.x == b.x && a.y == b.y;
}

/* The word in streams and reports: free, periodic, periodic-x, periodic-y. */
RC_API const char *rc_boundary_word(struct rc_boundary boundary);
/* The boundary of this word, with the datum 0; false when there is none. */
RC_API bool rc_boundary_named(const char *word, struct rc_boundary *boundary);
/* The boundary with its datum: that of the map's free axis where it is 0 and exactly one axis repeats. */
RC_API struct rc_boundary rc_boundary_on(const struct rc_shape *shape, struct rc_boundary boundary);

/* A node is in contact if its value in the frame `contact` of its case (1 or 0) is above 0. If the case has
 * no such frame, the pressure decides. In tools contact_frame chooses between the two frames. */
static inline bool
rc_in_contact(double value)
{
    return value > 0;
}

/* ---- grids: a map with its keys, as in a stream ---- */

enum rc_type {
    RC_F64,
    RC_F32
};

struct rc_key {
    char *name;  /* [a-z][a-z0-9._-]* */
    char *value; /* UTF-8, not yet escaped */
};

struct rc_grid {
    /* nodes, both > 0 */
    size_t nx, ny;
    /* metres, unless rc_grid_dunit is another unit; both > 0 and finite */
    double dx, dy;
    /* "height", "pressure", "szz", ... */
    char *channel;
    /* "m", "Pa", ...; SI */
    char *unit;
    /* how the values are stored in a stream; in memory always double */
    enum rc_type type;
    /* every other header line, in order: case, source, history, ... */
    struct rc_key *key;
    size_t keys;
    /* nx*ny values, row 0 first; NaN: not measured */
    double *v;
    /* number of the ny rows that are not in v, because other processes hold them */
    size_t elsewhere;
};

/* A grid with uninitialised values. NULL on a bad shape or when memory is short. */
RC_API struct rc_grid *rc_grid_new(const struct rc_shape *shape, const char *channel,
                                   const char *unit, struct rc_err *err);
/* The same for some of its rows, or for no row. */
RC_API struct rc_grid *rc_grid_new_part(const struct rc_shape *shape, size_t rows,
                                        const char *channel, const char *unit, struct rc_err *err);
/* Values in v. */
RC_API size_t rc_grid_nodes(const struct rc_grid *grid);
/* Same shape and keys as `like`, values uninitialised; type is RC_F64. */
RC_API struct rc_grid *rc_grid_like(const struct rc_grid *like, const char *channel,
                                    const char *unit, struct rc_err *err);
RC_API void rc_grid_free(struct rc_grid *grid);

/* Its shape. */
RC_API struct rc_shape rc_grid_shape(const struct rc_grid *grid);

/* Value of a carried key, or NULL. The required header lines (nx, unit, ...) are fields, not keys. */
RC_API const char *rc_grid_get(const struct rc_grid *grid, const char *name);
/* Sets, replaces or, with value NULL, removes a key. RC_FAIL for a name that is not a key name, or
 * that of a field (nx, unit, ...), or when memory is short. */
RC_API enum rc_status rc_grid_set(struct rc_grid *grid, const char *name, const char *value,
                                  struct rc_err *err);
/* The same with a number, written as rc_number_text does. */
RC_API enum rc_status rc_grid_set_number(struct rc_grid *grid, const char *name, double value,
                                         struct rc_err *err);
/* Number in a key; false when the key is absent or is not wholly one finite number. */
RC_API bool rc_grid_number(const struct rc_grid *grid, const char *name, double *value);
/* The unit of dx and dy: the key `dunit`, "m" when it is absent. */
RC_API const char *rc_grid_dunit(const struct rc_grid *grid);
/* Column and row at which x and y are 0: the middle of the map, which may lie between two nodes. A map of
 * wave numbers (dunit=rad/m) has them at the node (nx/2, ny/2). */
RC_API void rc_grid_origin(const struct rc_grid *grid, double *i, double *j);
/* The case the frame belongs to: the key `case`, 1 when absent, 0 when it is not a whole number > 0. */
RC_API size_t rc_grid_case(const struct rc_grid *grid);

/* Adds one step to the key `history`, steps joined by " | ". Past 32 KiB middle steps become "...", and so
 * does the end of a step beyond 16368 bytes. */
RC_API enum rc_status rc_grid_history(struct rc_grid *grid, const char *step, struct rc_err *err);

/* True for a name of a key: [a-z][a-z0-9._-]*. */
RC_API bool rc_key_valid(const char *name);

/* ---- numbers and texts ---- */

/* Replaces *text by a copy of value. RC_FAIL when memory is short. */
RC_API enum rc_status rc_text_set(char **text, const char *value, struct rc_err *err);

enum {
    RC_NUMBER_SIZE = 32
};
/* The shortest decimal that reads back exactly, with a point in every locale: "1.1e-06", "240". */
RC_API const char *rc_number_text(char text[RC_NUMBER_SIZE], double value);
/* Reads a decimal number with a point in every locale: returns the first character after it, or
 * NULL when there is none. Accepts no hexadecimal, no white space; "nan" and "inf" only when
 * `special`. */
RC_API const char *rc_number_read(const char *text, bool special, double *value);

/* a*b, or RC_FAIL when it does not fit. */
RC_API enum rc_status rc_size_mul(size_t a, size_t b, size_t *product, struct rc_err *err);

#ifdef __cplusplus
}
#endif

#endif
