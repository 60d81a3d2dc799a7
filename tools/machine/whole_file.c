/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "whole_file.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    SLOTS = 4
};

/* Names of half-written files; empty: none. A signal handler reads them. */
static char half[SLOTS][WHOLE_PATH];

void
whole_files_remove(void)
{
    for (int k = 0; k < SLOTS; k++) {
        if (half[k][0] != '\0')
            unlink(half[k]);
        half[k][0] = '\0';
    }
}

/* Copies text; false, with errno, if text and the suffix of a half-written name do not fit. */
static bool
keep(char place[WHOLE_PATH], const char *text)
{
    if (strlen(text) >= WHOLE_PATH - 8) {
        errno = ENAMETOOLONG;
        return false;
    }
    strcpy(place, text);
    return true;
}

/* Replaces the name of a link by its target; false: not a link, or the target's name is too long. */
static bool
follow(char place[WHOLE_PATH])
{
    char target[WHOLE_PATH], whole[2 * WHOLE_PATH];
    const char *slash = strrchr(place, '/');
    ssize_t n = readlink(place, target, sizeof target - 1);

    if (n < 0)
        return false;
    target[n] = '\0';
    snprintf(whole, sizeof whole, "%.*s%s",
             slash == NULL || target[0] == '/' ? 0 : (int)(slash - place) + 1, place, target);
    return keep(place, whole);
}

bool
whole_file_place(const char *name, char place[WHOLE_PATH])
{
    char *real;
    bool fits;

    if (!keep(place, name))
        return false;
    do { /* a link whose target does not exist yet; a cycle of links is ELOOP */
        if ((real = realpath(place, NULL)) != NULL) {
            fits = keep(place, real);
            free(real);
            return fits;
        }
        if (errno == ELOOP || errno == ENOMEM)
            return false;
        errno = 0;
    } while (follow(place));
    return errno != ENAMETOOLONG;
}

static int
free_slot(void)
{
    int slot = 0;

    while (slot < SLOTS && half[slot][0] != '\0')
        slot++;
    return slot < SLOTS ? slot : -1;
}

/* Notes the name of a half-written file: a signal finds all of it or nothing. */
static void
note(int slot, const char *name)
{
    sigset_t all, before;

    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, &before);
    snprintf(half[slot], WHOLE_PATH, "%s", name);
    sigprocmask(SIG_SETMASK, &before, NULL);
}

bool
whole_file_choose(struct whole_file *w, const char *name)
{
    char chosen[WHOLE_PATH];
    unsigned drawn;

    *w = (struct whole_file){.slot = -1};
    if (!whole_file_place(name, w->destination) || getentropy(&drawn, sizeof drawn) != 0)
        return false;
    if ((w->slot = free_slot()) < 0) {
        errno = EMFILE;
        return false;
    }
    snprintf(chosen, sizeof chosen, "%.*s.%06x", WHOLE_PATH - 8, w->destination, drawn & 0xffffff);
    note(w->slot, chosen);
    return true;
}

FILE *
whole_file_create(struct whole_file *w)
{
    FILE *file = fopen(half[w->slot], "wbx");

    if (file == NULL)
        half[w->slot][0] = '\0'; /* a file of another process may have this name */
    return file;
}

FILE *
whole_file_open(struct whole_file *w, const char *name)
{
    struct stat st;

    *w = (struct whole_file){.slot = -1};
    if (stat(name, &st) == 0 && !S_ISREG(st.st_mode))
        return fopen(name, "wb");
    return whole_file_choose(w, name) ? whole_file_create(w) : NULL;
}

bool
whole_file_is_half(const struct whole_file *w)
{
    return w->destination[0] != '\0' && w->slot >= 0 && half[w->slot][0] != '\0';
}

const char *
whole_file_name(const struct whole_file *w)
{
    return w->slot >= 0 ? half[w->slot] : w->destination;
}

void
whole_file_share(struct whole_file *w, const char *name)
{
    if (w->slot < 0)
        w->slot = free_slot();
    snprintf(w->destination, sizeof w->destination, "%s", name);
    if (w->slot >= 0)
        note(w->slot, name);
}

bool
file_settle(FILE *file)
{
    int result;

    if (fflush(file) != 0)
        return false;
    do
        result = fsync(fileno(file));
    while (result != 0 && errno == EINTR);
    return result == 0 || errno == EINVAL || errno == EROFS || errno == ENOSYS || errno == ENOTSUP;
}

int
file_error(FILE *file)
{
    clearerr(file);
    return putc('\n', file) == EOF || fflush(file) != 0 ? errno : EIO;
}

void
file_forget(FILE *file, off_t length)
{
    const int nothing = open("/dev/null", O_WRONLY | O_CLOEXEC);
    struct stat st;

    if (fstat(fileno(file), &st) == 0 && S_ISREG(st.st_mode) && nothing >= 0 &&
        ftruncate(fileno(file), length) == 0)
        (void)dup2(nothing, fileno(file)); /* the buffer is written there */
    if (nothing >= 0)
        (void)close(nothing);
}

/* Without file_settle the new name may reach the disk before the data: after a power failure an empty file
 * would then replace the old one. */
static bool
close_written(FILE *file, bool settle)
{
    bool fine;
    int why = EIO;

    if (!(fine = !ferror(file)))
        why = file_error(file);
    else if (!(fine = settle ? file_settle(file) : fflush(file) == 0))
        why = errno;
    if (fclose(file) != 0 && fine)
        return false;
    errno = why;
    return fine;
}

bool
whole_file_put(struct whole_file *w, FILE *file)
{
    bool half_written = whole_file_is_half(w);

    if (file != NULL && !close_written(file, half_written))
        return false;
    if (!half_written)
        return true;
    if (rename(half[w->slot], w->destination) != 0)
        return false;
    half[w->slot][0] = '\0';
    return true;
}
