/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A separate file, because _GNU_SOURCE would change signal() in output.c. */
#define _GNU_SOURCE /* F_SETPIPE_SZ */
#include "pipe.h"

#include <fcntl.h>
#include <sys/stat.h>

void
pipe_widen(int fd)
{
#ifdef F_SETPIPE_SZ
    (void)fcntl(fd, F_SETPIPE_SZ, 1 << 20);
#else
    (void)fd;
#endif
}

bool
pipe_is(int fd)
{
    struct stat st;

    return fstat(fd, &st) == 0 && (S_ISFIFO(st.st_mode) || S_ISSOCK(st.st_mode));
}
