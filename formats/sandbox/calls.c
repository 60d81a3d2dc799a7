#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "calls.h"

#if defined(__linux__)
#include <errno.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

#if defined(__linux__) && defined(__x86_64__) && !defined(__ILP32__)
#define ARCHITECTURE AUDIT_ARCH_X86_64
#elif defined(__linux__) && defined(__aarch64__) && defined(__AARCH64EL__)
#define ARCHITECTURE AUDIT_ARCH_AARCH64
#elif defined(__linux__) && defined(__riscv) && __riscv_xlen == 64
#define ARCHITECTURE AUDIT_ARCH_RISCV64
#elif defined(__linux__) && defined(__powerpc64__) && defined(__LITTLE_ENDIAN__)
#define ARCHITECTURE AUDIT_ARCH_PPC64LE
#endif

/* Not s390x: there mmap has one argument, a place in memory that holds the others, and no filter
 * can look there. */

#ifdef ARCHITECTURE

/* Allowed whatever their arguments are: they act on this process alone and give nothing away. The calls
 * that block and catch signals are not allowed: with them a child could outlive SIGALRM. */
static const unsigned harmless[] = {
    __NR_exit_group,
    __NR_exit,
    __NR_brk,
    __NR_munmap,
    __NR_mremap,
    __NR_madvise,
    __NR_futex,
    __NR_sched_yield,
    __NR_rt_sigreturn,
    __NR_sigaltstack,
    __NR_restart_syscall,
    __NR_close,
    __NR_getpid,
    __NR_gettid,
    __NR_getrandom,
    __NR_getrusage,
    __NR_sysinfo,
    __NR_sched_getaffinity,
    __NR_clock_gettime,
    __NR_clock_nanosleep,
    __NR_nanosleep,
#ifdef __NR_pause
    __NR_pause,
#endif
#ifdef __NR_gettimeofday
    __NR_gettimeofday,
#endif
#ifdef __NR_time
    __NR_time,
#endif
};

/* What an argument of a call has to be. */
struct condition {
    enum {
        IS,     /* the value           */
        HAS,    /* a bit of the value  */
        HAS_NOT /* none of them        */
    } how;
    unsigned argument;
    uint32_t value;
};

enum {
    CONDITIONS = 2,
    CODE = 160
};

struct program {
    struct sock_filter code[CODE];
    unsigned short n;
};

static void
put(struct program *p, uint16_t what, uint32_t value, unsigned yes, unsigned no)
{
    p->code[p->n++] = (struct sock_filter){what, (uint8_t)yes, (uint8_t)no, value};
}

static void
load(struct program *p, size_t at)
{
    put(p, BPF_LD | BPF_W | BPF_ABS, (uint32_t)at, 0, 0);
}

/* The lower half of an argument; no condition looks at the other one. */
static size_t
place(unsigned argument)
{
    const uint16_t one = 1;
    size_t lower = *(const unsigned char *)&one == 1 ? 0 : 4;

    return offsetof(struct seccomp_data, args) + 8 * argument + lower;
}

/* Filters the call with this number: it is allowed where all conditions hold, else refused. Other calls
 * pass on to the instructions behind, with their number still loaded. */
static void
allow_if(struct program *p, unsigned call, const struct condition *c, unsigned conditions)
{
    put(p, BPF_JMP | BPF_JEQ | BPF_K, call, 0, 2 * conditions + 2);
    for (unsigned k = 0; k < conditions; k++) {
        unsigned refuse = 2 * (conditions - k) - 1;

        load(p, place(c[k].argument));
        if (c[k].how == HAS_NOT)
            put(p, BPF_JMP | BPF_JSET | BPF_K, c[k].value, refuse, 0);
        else
            put(p, BPF_JMP | (c[k].how == IS ? BPF_JEQ : BPF_JSET) | BPF_K, c[k].value, 0, refuse);
    }
    put(p, BPF_RET | BPF_K, SECCOMP_RET_ALLOW, 0, 0);
    put(p, BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM, 0, 0);
}

static void
write_program(struct program *p, int out, int in)
{
    const struct condition to_out = {IS, 0, (uint32_t)out}, from_in = {IS, 0, (uint32_t)in};
    const struct condition itself = {IS, 0, (uint32_t)getpid()};
    const struct condition memory[CONDITIONS] = {{HAS, 3, MAP_ANONYMOUS}, {HAS_NOT, 2, PROT_EXEC}};
    const struct condition protection = {HAS_NOT, 2, PROT_EXEC};

    load(p, offsetof(struct seccomp_data, arch));
    put(p, BPF_JMP | BPF_JEQ | BPF_K, ARCHITECTURE, 1, 0);
    put(p, BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS, 0, 0);
    load(p, offsetof(struct seccomp_data, nr)); /* calls of x32 have other numbers */
    for (size_t k = 0; k < sizeof harmless / sizeof *harmless; k++) {
        put(p, BPF_JMP | BPF_JEQ | BPF_K, harmless[k], 0, 1);
        put(p, BPF_RET | BPF_K, SECCOMP_RET_ALLOW, 0, 0);
    }
    allow_if(p, __NR_write, &to_out, 1);
    allow_if(p, __NR_read, &from_in, 1);
    allow_if(p, __NR_mmap, memory, 2);
    allow_if(p, __NR_mprotect, &protection, 1);
    allow_if(p, __NR_tgkill, &itself, 1); /* abort() */
    put(p, BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM, 0, 0);
}

bool
rc_calls_can_be_filtered(void)
{
    /* a filter at no address: EFAULT where the system has filters, EINVAL where it has none */
    return prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, NULL, 0, 0) != 0 && errno == EFAULT;
}

void
rc_calls_filter(int out, int in)
{
    struct program p = {.n = 0};
    struct sock_fprog program;

    write_program(&p, out, in);
    program = (struct sock_fprog){p.n, p.code};
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0)
        (void)prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program, 0, 0);
}

#else

bool
rc_calls_can_be_filtered(void)
{
    return false;
}

void
rc_calls_filter(int out, int in)
{
    (void)out, (void)in;
}

#endif
