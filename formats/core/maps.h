/*
 * Most readers do no more than describe a file as maps of raw numbers at some place in it.
 *
 * A format fills struct rc_maps from its header. Listing, checking the sizes against the bytes that
 * are there, decoding, turning, scaling and marking what is missing is then the same for all, and
 * is done here once.
 */
#ifndef RC_MAPS_H
#define RC_MAPS_H

#include "bytes.h"
#include "file.h"
#include "header.h"
#include "wish.h"

enum {
    RC_MAPS_MOST = 64, /* that are kept of a file; further ones are counted */
    RC_KEYS_MOST = 24
};

struct rc_map {
    char name[64];
    char unit[16];      /* SI unit: "m", "V", ...; "" when the file does not say              */
    double si;          /* SI units in one unit of the file                                   */
    double scale, zero; /* value in the file's unit = raw*scale + zero                        */
    size_t nx, ny;
    double dx, dy; /* m; NAN when the file does not say                                  */
    enum rc_raw raw;
    bool big;        /* most significant byte first                                        */
    size_t at;       /* first byte                                                         */
    size_t padding;  /* bytes after each line of numbers                                   */
    bool by_columns; /* a line of numbers is a column                                      */
    bool bottom_first, right_first;
    double missing_from,
        missing_to; /* raw numbers in [from, to] are missing; NAN: none is         */
    /* Instead of raw, at and padding: puts nx*ny raw numbers into v, NAN where missing, in the
     * order that by_columns and so on say. The reader that sets it has to check nx*ny against the
     * file's size. */
    enum rc_status (*fill)(const struct rc_file *file, const struct rc_map *map, double *v,
                           struct rc_err *err);
    size_t more;   /* for fill                                                           */
    double beside; /* bytes that fill takes beside v: set by rc_map_bound                         */
    const struct rc_wish *wish; /* for fill, and the notes                               */
    struct rc_notes *notes;
    const char *doubt; /* of what the heights mean: noted, unless --z-unit says it  */
    double step
        [2]; /* the spacing where the file gives it without a unit, and words on it for the refusal: */
    char hint[128];
};

struct rc_maps {
    const struct rc_wish *wish; /* of the user, for those whose maps it changes */
    struct rc_map map[RC_MAPS_MOST], spare;
    size_t n;
    struct {
        char name[32], value[256];
    } key[RC_KEYS_MOST];
    size_t keys;
};

/* A further map of that name with scale 1 and nothing else known. */
struct rc_map *rc_maps_add(struct rc_maps *maps, const char *name, size_t n);
/* A key `file.*` of the grid, cleaned; nothing when the text is empty or the key is there. */
void rc_maps_key(struct rc_maps *maps, const char *key, const char *text, size_t n);
/* What a file calls a thing, and the key of the grid that keeps it. */
struct rc_keep {
    const char *name, *key;
};
/* Keeps the value when one of keep[0..n) has that name. */
void rc_maps_keep(struct rc_maps *maps, const struct rc_keep *keep, size_t n, struct rc_piece name,
                  struct rc_piece value);
/* Sets unit and si from the file's word for it: a length, a unit with an SI prefix, or the word. */
void rc_map_unit(struct rc_map *map, const char *text, size_t n);
/* The least and the greatest raw number that is not missing; false when the numbers are not all in
 * the file or every one is missing. */
bool rc_map_range(const struct rc_map *map, const struct rc_file *file, double *low, double *high);
/* Remembers the steps of a file that has them without a unit. */
void rc_map_hint(struct rc_map *map, double dx, double dy);
/* Sets dx and dy from the steps in the file's unit of length; the steps become a hint when the unit
 * is none. */
void rc_map_steps(struct rc_map *map, double dx, double dy, struct rc_piece unit);
/* A whole number from 1 to 2^31 - 1 as a header has it, or RC_FAIL with its name. */
enum rc_status rc_map_count(const char *what, double number, size_t *count, struct rc_err *err);
/* RC_FAIL when the map and `unpacked` bytes, which fill takes beside it, exceed rc_memory_limit: for
 * what is packed in the file. */
enum rc_status rc_map_bound(struct rc_map *map, const struct rc_file *file, double unpacked,
                            struct rc_err *err);
/* Makes it a map that is text: numbers separated by white space from `at` on. RC_FAIL when the text
 * is too short for nx*ny of them. */
enum rc_status rc_map_is_text(struct rc_map *map, const struct rc_file *file, size_t at,
                              struct rc_err *err);

/* Describes a file; RC_FAIL with the reason. */
typedef enum rc_status rc_maps_find(const struct rc_file *file, struct rc_maps *maps,
                                    struct rc_err *err);

size_t rc_maps_list(rc_maps_find *find, const struct rc_file *file, const struct rc_wish *wish,
                    struct rc_channel *channel, size_t most, struct rc_err *err);
struct rc_grid *rc_maps_read(rc_maps_find *find, const struct rc_file *file,
                             const struct rc_wish *wish, size_t index, struct rc_notes *notes,
                             struct rc_err *err);

#endif
