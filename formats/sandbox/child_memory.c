/* In a file of its own because of _GNU_SOURCE, which changes what other functions do. */
#define _GNU_SOURCE /* process_vm_readv */
#include "child_memory.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/uio.h>
#include <unistd.h>

bool
rc_child_memory_copy(pid_t child, uint64_t from, void *to, size_t n)
{
#ifdef __linux__
    size_t done = 0;

    while (done < n) {
        struct iovec here = {(char *)to + done, n - done};
        struct iovec there = {(void *)(uintptr_t)(from + done), n - done};
        ssize_t copied = process_vm_readv(child, &here, 1, &there, 1, 0);

        if (copied <= 0)
            return false;
        done += (size_t)copied;
    }
    return true;
#else
    (void)child, (void)from, (void)to, (void)n;
    return false;
#endif
}

/* The number of kB after `key` at the beginning of a line of /proc/CHILD/NAME; 0: no such line. Takes no
 * memory from the heap, because the next child would inherit it. */
static size_t
kilobytes(pid_t child, const char *name, const char *key)
{
    char text[8192] = "\n", line[64];
    ssize_t n, got = 1;
    const char *at;
    int file;

    snprintf(line, sizeof line, "/proc/%ld/%s", (long)child, name);
    if ((file = open(line, O_RDONLY | O_CLOEXEC)) < 0)
        return 0;
    while (got < (ssize_t)sizeof text - 1 &&
           (n = read(file, text + got, sizeof text - 1 - (size_t)got)) > 0)
        got += n;
    close(file);
    text[got] = '\0';
    snprintf(line, sizeof line, "\n%s", key);
    at = strstr(text, line);
    return at == NULL ? 0 : strtoul(at + strlen(line), NULL, 10);
}

size_t
rc_child_memory_held(pid_t child)
{
    size_t most = kilobytes(child, "status", "VmHWM:"), now = kilobytes(child, "status", "VmRSS:");
    size_t own = kilobytes(child, "smaps_rollup", "Private_Dirty:");

    return own == 0 ? 0 : 1024 * (own + (most > now ? most - now : 0));
}
