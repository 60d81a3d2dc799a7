/*
 * A process of its own for libraries that were not made for hostile files (libhdf5, libtiff): what
 * a file makes them do, they do in a child with bounded memory and time that can open no other
 * file. It hands its answer back through a pipe; when it dies, its file is refused and nothing else
 * is harmed.
 *
 * Bounds: 16 times the file plus 64 MiB of memory beyond what the process has; 0.8 s and 1 s for
 * every 10 MB of the file, of the processor, and ten times that by the clock. Call from one thread.
 */
#ifndef RC_SANDBOX_H
#define RC_SANDBOX_H

#include "formats/format.h"

/* As those of struct rc_format. */
typedef size_t rc_list_in_cage(const struct rc_file *file, const struct rc_wish *wish,
                               struct rc_channel *channel, size_t most, struct rc_err *err);
typedef struct rc_grid *rc_read_in_cage(const struct rc_file *file, const struct rc_wish *wish,
                                        size_t index, struct rc_notes *notes, struct rc_err *err);

size_t rc_cage_list(rc_list_in_cage *list, const struct rc_file *file, const struct rc_wish *wish,
                    struct rc_channel *channel, size_t most, struct rc_err *err);
struct rc_grid *rc_cage_read(rc_read_in_cage *read, const struct rc_file *file,
                             const struct rc_wish *wish, size_t index, struct rc_notes *notes,
                             struct rc_err *err);

/* The functions of a row of formats.list, NAME_list and NAME_read, from list_channels and
 * read_values. */
#define RC_FORMAT_IN_CAGE(name)                                                                    \
    static size_t name##_list(const struct rc_file *file, const struct rc_wish *wish,              \
                              struct rc_channel *channel, size_t most, struct rc_err *err)         \
    {                                                                                              \
        return rc_cage_list(list_channels, file, wish, channel, most, err);                        \
    }                                                                                              \
    static struct rc_grid *name##_read(const struct rc_file *file, const struct rc_wish *wish,     \
                                       size_t index, struct rc_notes *notes, struct rc_err *err)   \
    {                                                                                              \
        return rc_cage_read(read_values, file, wish, index, notes, err);                           \
    }

/* With `open` the calls run in this process, without bounds: for fuzzers, which want to see them. */
void rc_cage_leave_open(bool open);

#endif
