/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "calls.h"

/* There is no filter on s390x: mmap has one argument there, the address of the others, which a filter cannot
 * read. */
#if defined(__linux__) && defined(__LP64__) &&                                                     \
    (defined(__x86_64__) || defined(__aarch64__) || defined(__riscv) || defined(__powerpc64__)) && \
    __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__

#include <errno.h>
#include <linux/seccomp.h>
#include <seccomp.h>
#include <stddef.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

/* Calls allowed with any arguments: they affect only this process and reveal no data. Calls that block and
 * catch signals are not allowed: with them a child could survive SIGALRM. */
static const int harmless[] = {SCMP_SYS(exit_group),
                               SCMP_SYS(exit),
                               SCMP_SYS(brk),
                               SCMP_SYS(munmap),
                               SCMP_SYS(mremap),
                               SCMP_SYS(madvise),
                               SCMP_SYS(futex),
                               SCMP_SYS(sched_yield),
                               SCMP_SYS(rt_sigreturn),
                               SCMP_SYS(sigaltstack),
                               SCMP_SYS(restart_syscall),
                               SCMP_SYS(close),
                               SCMP_SYS(getpid),
                               SCMP_SYS(gettid),
                               SCMP_SYS(getrandom),
                               SCMP_SYS(getrusage),
                               SCMP_SYS(sysinfo),
                               SCMP_SYS(sched_getaffinity),
                               SCMP_SYS(clock_gettime),
                               SCMP_SYS(clock_nanosleep),
                               SCMP_SYS(nanosleep),
                               SCMP_SYS(pause),
                               SCMP_SYS(gettimeofday),
                               SCMP_SYS(time)};

bool
rc_calls_can_be_filtered(void)
{
    /* a NULL filter: EFAULT if the system has filters, EINVAL if not */
    return prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, NULL, 0, 0) != 0 && errno == EFAULT;
}

/* Allows a call with these arguments. Calls of other processors, and those of x32, end the process. */
static bool
allow(scmp_filter_ctx filter, int call, unsigned n, const struct scmp_arg_cmp *arguments)
{
    return seccomp_rule_add_array(filter, SCMP_ACT_ALLOW, call, n, arguments) == 0;
}

static bool
set_rules(scmp_filter_ctx filter, int out)
{
    const struct scmp_arg_cmp no_code = SCMP_A2(SCMP_CMP_MASKED_EQ, PROT_EXEC, 0);
    const struct scmp_arg_cmp memory[] = {
        no_code, SCMP_A3(SCMP_CMP_MASKED_EQ, MAP_ANONYMOUS, MAP_ANONYMOUS)};
    const struct scmp_arg_cmp to_out = SCMP_A0(SCMP_CMP_EQ, (scmp_datum_t)out, 0);
    const struct scmp_arg_cmp itself = SCMP_A0(SCMP_CMP_EQ, (scmp_datum_t)getpid(), 0);

    for (size_t k = 0; k < sizeof harmless / sizeof *harmless; k++)
        if (!allow(filter, harmless[k], 0, NULL))
            return false;
    return allow(filter, SCMP_SYS(write), 1, &to_out) && allow(filter, SCMP_SYS(mmap), 2, memory) &&
           allow(filter, SCMP_SYS(mprotect), 1, &no_code) &&
           allow(filter, SCMP_SYS(tgkill), 1, &itself) /* abort() */ &&
           seccomp_attr_set(filter, SCMP_FLTATR_ACT_BADARCH, SCMP_ACT_KILL_PROCESS) == 0;
}

bool
rc_calls_filter(int out)
{
    scmp_filter_ctx filter;
    bool set;

    if (!rc_calls_can_be_filtered())
        return true;
    if ((filter = seccomp_init(SCMP_ACT_ERRNO(EPERM))) == NULL)
        return false;
    set = set_rules(filter, out) && seccomp_load(filter) == 0;
    seccomp_release(filter);
    return set;
}

#else

bool
rc_calls_can_be_filtered(void)
{
    return false;
}

bool
rc_calls_filter(int out)
{
    (void)out;
    return true;
}

#endif
