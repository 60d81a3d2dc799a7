/* In a file of its own because of _GNU_SOURCE, which changes what other functions do. */
#define _GNU_SOURCE /* process_vm_readv */
#include "child_memory.h"

#include <sys/uio.h>

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
