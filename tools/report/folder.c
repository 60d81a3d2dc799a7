/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The temporary folder of the files of the parts. */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "page.h"

char page_folder[WHOLE_PATH - 256];

/* Also at the end of a tool that fails. */
void
page_remove_folder(void)
{
    DIR *dir = opendir(page_folder);
    const struct dirent *entry;

    while (dir != NULL && (entry = readdir(dir)) != NULL)
        unlinkat(dirfd(dir), entry->d_name, 0);
    if (dir != NULL)
        closedir(dir);
    rmdir(page_folder);
}

/* A process of its own waits for the end of this one, which nothing else may notice (kill -9), and then
 * removes the folder. The other tools end with this one, so that no file is added later. */
static void
guard_folder(struct tool *t)
{
    enum {
        FILES = 1024,
        TRIES = 40
    };
    static const struct timespec pause = {.tv_nsec = 50000000};
    int end[2];
    char nothing;

    if (pipe(end) != 0)
        tool_die(t, "no pipe can be made: %s", strerror(errno));
    (void)fcntl(end[1], F_SETFD, FD_CLOEXEC);
    if (fork() != 0) { /* without this process only kill -9 leaves the folder */
        (void)close(end[0]);
        return;
    }
    (void)setsid(); /* a signal to all processes of a terminal does not end it */
    signal(SIGTERM, SIG_IGN);
    for (int fd = 0; fd < FILES; fd++)
        if (fd != end[0])
            (void)close(fd);
    while (read(end[0], &nothing, 1) < 0 && errno == EINTR)
        continue;
    for (int k = 0; k < TRIES && access(page_folder, F_OK) == 0; k++) {
        page_remove_folder();
        (void)nanosleep(&pause, NULL);
    }
    _exit(0);
}

void
page_make_folder(struct tool *t)
{
    const char *place = getenv("TMPDIR");

    snprintf(page_folder, sizeof page_folder, "%s/rc-report-XXXXXX",
             place == NULL || *place == '\0' ? "/tmp" : place);
    if (mkdtemp(page_folder) == NULL)
        tool_die(t, "a temporary folder %s cannot be made: %s", page_folder, strerror(errno));
    atexit(page_remove_folder);
    guard_folder(t);
}

FILE *
page_open(struct page *run, const char *name)
{
    char path[WHOLE_PATH];
    FILE *in;

    snprintf(path, sizeof path, "%s/%s", page_folder, name);
    if ((in = fopen(path, "rb")) == NULL)
        tool_die(&run->t, "%s: %s", path, strerror(errno));
    return in;
}
