/* Files that appear whole or not at all: made beside their place under another name, and put there when
 * they are done. What is half-written when the tool fails, or a signal ends it, is removed. */
#ifndef RC_WHOLE_FILE_H
#define RC_WHOLE_FILE_H

#include <stdbool.h>
#include <stdio.h>

enum {
    WHOLE_PATH = 4096
};

struct whole_file {
    int slot; /* of the names that a signal has to find; -1: written directly */
    char destination[WHOLE_PATH];
};

/* Where the file of that name is, or is to be made: through symbolic links, also where what they name is not
 * there yet. false with errno. */
bool whole_file_place(const char *name, char place[WHOLE_PATH]);
/* To be written; a device or a FIFO directly. Through symbolic links, so that a link stays one. NULL with
 * errno. At most four are half-written at a time. */
FILE *whole_file_open(struct whole_file *w, const char *name);
/* Whether it is half-written, and not yet in its place. */
bool whole_file_is_half(const struct whole_file *w);
/* Its name until then. */
const char *whole_file_name(const struct whole_file *w);
/* This process knows of a half-written file that another one has made, and removes it when it fails; "": no
 * more. */
void whole_file_share(struct whole_file *w, const char *name);
/* Closes what was opened, and puts it in its place once the disk has it: so a power failure too
 * leaves the old file or the new one. false with errno, which the sentence about it is to give; the
 * old file is untouched. */
bool whole_file_put(struct whole_file *w, FILE *file);
/* Waits until the disk has what was written; false with errno. Where nothing can be waited for - a device, a
 * file system without the call - there is nothing to do. */
bool file_settle(FILE *file);
/* Removes all that are half-written; safe in a signal handler. */
void whole_files_remove(void);

#endif
