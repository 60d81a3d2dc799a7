/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that appear whole or not at all: they are written under another name in the same folder and renamed
 * when complete. If the tool fails or a signal ends it, half-written files are removed. */
#ifndef RC_WHOLE_FILE_H
#define RC_WHOLE_FILE_H

#include <stdbool.h>
#include <stdio.h>

enum {
    WHOLE_PATH = 4096
};

struct whole_file {
    int slot; /* index of its name, for the signal handler; -1: written directly */
    char destination[WHOLE_PATH];
};

/* The place of the file with this name, whether it exists or not. Follows symbolic links, also if their
 * targets do not exist. On failure returns false with errno. */
bool whole_file_place(const char *name, char place[WHOLE_PATH]);
/* Opens a file for writing; a device or a FIFO directly. Follows symbolic links, so that a link stays a link.
 * NULL with errno. At most four files can be half-written at a time. */
FILE *whole_file_open(struct whole_file *w, const char *name);
/* The two steps of this, for a regular file: chooses the name until it is complete, false with errno; creates
 * it under this name. In between other processes can be told the name, so that each of them can remove it. */
bool whole_file_choose(struct whole_file *w, const char *name);
FILE *whole_file_create(struct whole_file *w);
/* True if it is half-written and not yet renamed. */
bool whole_file_is_half(const struct whole_file *w);
/* Its name until then. */
const char *whole_file_name(const struct whole_file *w);
/* Registers a half-written file of another process, to remove it if this process fails; "": no more. */
void whole_file_share(struct whole_file *w, const char *name);
/* Closes the file, and renames it after the data has reached the disk. Even a power failure leaves the old
 * file or the new one. false with errno, for the caller's message; the old file is then unchanged. */
bool whole_file_put(struct whole_file *w, FILE *file);
/* Waits until the data is on the disk; false with errno. Returns true at once for a device or a file system
 * without this call. */
bool file_settle(FILE *file);
/* The error number of a write to this file that has failed: asks the disk again, because errno is that of a
 * later call. */
int file_error(FILE *file);
/* Cuts a regular file at this length; what its buffer holds is lost. */
void file_forget(FILE *file, off_t length);
/* Removes all half-written files; safe in a signal handler. */
void whole_files_remove(void);

#endif
