/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A reader describes a file as maps. It fills struct rc_maps from the header, with the position and the type
 * of raw numbers, or with a function that fills in the values. The rest is the same for all readers, and is
 * done here. It lists, checks the sizes against the bytes of the file, decodes, reorders, scales and marks
 * missing points. A file is opened once: struct rc_maps keeps what its reader opened, for all its values.
 */
#ifndef RC_MAPS_H
#define RC_MAPS_H

#include "bytes.h"
#include "file.h"
#include "header.h"
#include "wish.h"

enum {
    RC_MAPS_MOST = 1024, /* most maps kept of a file; further ones are only counted */
    RC_KEYS_MOST = 24
};

/* A map of a file. A reader sets what its file says; for most files 0 is right for most members, so that the
 * members stay in one list. */
struct rc_map {
    char name[64];
    char unit[16];      /* SI unit: "m", "V", ...; "" if unknown                              */
    double si;          /* SI units in one unit of the file                                   */
    double scale, zero; /* value in the file's unit = raw*scale + zero                        */
    size_t nx, ny;
    double dx, dy; /* m; NAN if unknown                                                       */
    enum rc_raw raw;
    bool big;        /* most significant byte first                                        */
    size_t at;       /* first byte                                                         */
    size_t padding;  /* padding bytes after each line of numbers */
    bool by_columns; /* a line of numbers is a column                                      */
    bool bottom_first, right_first;
    size_t
        rows; /* the first rows of the map, which were measured: others are missing; 0: all were */
    double missing_from,
        missing_to; /* raw numbers in [from, to] are missing; NAN: none is         */
    /* Replaces raw, at and padding. Writes nx*ny raw numbers to v, NAN if missing, in the order that
     * by_columns and the other members give. The reader that sets it must check nx*ny against the size of
     * the file. */
    enum rc_status (*fill)(const struct rc_file *file, const struct rc_map *map, double *v,
                           struct rc_err *err);
    /* Gives *n unpacked bytes, which the caller frees, or NULL with the reason: raw, big, at and padding then
     * hold for them, not for the file. `within` says the same of bytes that are unpacked already. */
    unsigned char *(*unpack)(const struct rc_file *file, const struct rc_map *map, size_t *n,
                             struct rc_err *err);
    struct rc_file within;
    size_t more; /* for fill and unpack                                                           */
    void *opened;               /* for fill: that of struct rc_maps */
    double beside;              /* bytes that fill needs in addition to v; rc_map_bound sets them */
    const struct rc_wish *wish; /* data of fill, and the notes */
    struct rc_notes *notes;
    struct rc_piece title;      /* title of this map, for the key file.title; n = 0: none */
    struct rc_boundary repeats; /* the axes along which the map repeats, as the file says */
    bool heights;               /* the values are heights: a unit that is not a length is refused */
    bool own_dy;                /* --dx does not give the spacing in y */
    const char *doubt;          /* a doubt about the heights: noted, unless --z-unit is given     */
    double step[2]; /* the spacing if the file gives it without a unit, and a text about it for the
                       message: */
    char hint[128];
};

struct rc_maps {
    const struct rc_file *file;
    const struct rc_wish *wish; /* options of the user, for readers whose maps depend on them */
    const struct rc_format *format;
    void *opened; /* what the reader opened, see rc_maps_open; NULL: nothing */
    void (*close)(void *opened);
    struct rc_map map[RC_MAPS_MOST], spare;
    size_t n;
    struct {
        char name[32], value[2048];
    } key[RC_KEYS_MOST];
    size_t keys;
};

/* Adds a map with this name and scale 1; all else is unknown. */
struct rc_map *rc_maps_add(struct rc_maps *maps, struct rc_piece name);
/* Adds a cleaned key `file.*` of the grid, unless the text is empty or the key exists. */
void rc_maps_key(struct rc_maps *maps, const char *key, struct rc_piece text);
/* Adds file.date from six numbers of this type, year to second, from `at` on. */
void rc_maps_date(struct rc_maps *maps, struct rc_bytes bytes, size_t at, enum rc_raw raw);
/* The name of an item in a file, and the key of the grid for it. */
struct rc_keep {
    const char *name, *key;
};
/* Keeps the value if one of keep[0..n) has this name. */
void rc_maps_keep(struct rc_maps *maps, const struct rc_keep *keep, size_t n, struct rc_piece name,
                  struct rc_piece value);
/* Sets unit and si from the file's word for it. The word may be a length or a unit with an SI prefix. */
void rc_map_unit(struct rc_map *map, struct rc_piece unit);
/* The smallest and the largest raw number that is not missing; false if the file lacks some numbers, or if
 * all are missing. */
bool rc_map_range(const struct rc_map *map, const struct rc_file *file, double *low, double *high);
/* Records the steps of a file that gives them without a unit. */
void rc_map_hint(struct rc_map *map, double dx, double dy);
/* Sets dx and dy from the steps in the file's unit of length; if that is not a unit, the steps become a
 * hint. */
void rc_map_steps(struct rc_map *map, double dx, double dy, struct rc_piece unit);
/* A whole number from 1 to 2^31 - 1 in a header, or RC_FAIL with its name. */
enum rc_status rc_map_count(const char *what, double number, size_t *count, struct rc_err *err);
/* Sets nx and ny by rc_map_count. `x` and `y` are the names that the file has for them, or NULL. */
enum rc_status rc_map_size(struct rc_map *map, double columns, const char *x, double rows,
                           const char *y, struct rc_err *err);
/* RC_FAIL if the map and `unpacked` bytes, which fill needs beside it, exceed rc_memory_limit: for packed
 * data. */
enum rc_status rc_map_bound(struct rc_map *map, const struct rc_file *file, double unpacked,
                            struct rc_err *err);
/* Makes it a map of text: numbers separated by white space from `at` on. RC_FAIL if the text is too short for
 * nx*ny of them. */
enum rc_status rc_map_is_text(struct rc_map *map, const struct rc_file *file, size_t at,
                              struct rc_err *err);

/* Describes a file; RC_FAIL with the reason. */
typedef enum rc_status rc_maps_find(const struct rc_file *file, struct rc_maps *maps,
                                    struct rc_err *err);
/* For find: `size` zero bytes for what the reader opens. rc_maps_shut calls close, unless it is NULL,
 * and frees them, also where find fails. NULL with the reason. */
void *rc_maps_open(struct rc_maps *maps, size_t size, void (*close)(void *opened),
                   struct rc_err *err);
void rc_maps_shut(struct rc_maps *maps);

/* The maps of a file, none yet; NULL with the reason. The caller keeps file and wish until rc_maps_free. */
struct rc_maps *rc_maps_new(const struct rc_file *file, const struct rc_wish *wish,
                            struct rc_err *err);
void rc_maps_free(struct rc_maps *maps);
RC_OWNER(rc_maps)

/* Calls find, names maps without a name, and checks all maps. */
enum rc_status rc_maps_describe(struct rc_maps *maps, rc_maps_find *find, struct rc_err *err);
/* Gives their number; the first `most` are listed. */
size_t rc_maps_list(const struct rc_maps *maps, struct rc_channel *channel, size_t most);
/* Reads one of them, as often as it is asked for. The wish may add a spacing and a unit to that of the
 * maps. */
struct rc_grid *rc_maps_read(struct rc_maps *maps, const struct rc_wish *wish, size_t index,
                             struct rc_notes *notes, struct rc_err *err);

#endif
