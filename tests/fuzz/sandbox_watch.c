/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Runs readers in their sandbox: the coverage of the child is passed to the fuzzer, and a child that crashes
 * reports the place. A crash in the library is counted only, because the sandbox protects against it. A crash
 * in code of this project is a finding: the first caller outside of the C library and the sanitizer decides.
 * A refusal for time or memory counts as any other refusal.
 */
#define _GNU_SOURCE /* dladdr */
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <hdf5.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include <sanitizer/asan_interface.h>
#include <sanitizer/common_interface_defs.h>

#include "formats/format.h"

int LLVMFuzzerInitialize(int *argc, char ***argv);
void watch_judge(void);
void __ubsan_on_report(void);

enum {
    DEPTH = 64,
    COUNTERS_MOST = 1 << 20
};

/* The counters of libFuzzer: a byte for every edge of the code built with it. */
extern uint8_t counters_start[] __asm__("__start___sancov_cntrs");
extern uint8_t counters_end[] __asm__("__stop___sancov_cntrs");

static struct shared {
    int depth; /* 0: no child has crashed here */
    void *frame[DEPTH];
    uint8_t counter[COUNTERS_MOST];
} * shared;

static unsigned long children, died;
static bool is_child;

void __real__exit(int status);
void __wrap__exit(int status);
void __real_rc_confine(const struct rc_file *file);
void __wrap_rc_confine(const struct rc_file *file);

static size_t
counters(void)
{
    size_t n = (size_t)(counters_end - counters_start);

    return n < COUNTERS_MOST ? n : COUNTERS_MOST;
}

static void
merge(uint8_t *to, const uint8_t *from)
{
    size_t n = counters();

    for (size_t k = 0; k < n; k++)
        to[k] = to[k] > from[k] ? to[k] : from[k];
}

/* ---- in the child ---- */

void
__wrap__exit(int status)
{
    merge(shared->counter, counters_start);
    __real__exit(status);
}

static void
tell(void)
{
    shared->depth = backtrace(shared->frame, DEPTH);
}

static void
on_signal(int signal_number)
{
    tell();
    merge(shared->counter, counters_start);
    signal(signal_number, SIG_DFL);
    raise(signal_number);
}

/* Called by the sanitizer of undefined behaviour, in both processes. */
void
__ubsan_on_report(void)
{
    if (is_child)
        tell();
}

/* Also called if the address sanitizer itself finds no memory; that is not a report. */
static void
on_report(void)
{
    if (__asan_report_present())
        tell();
    merge(shared->counter, counters_start);
}

static void
in_child(void)
{
    int nothing = open("/dev/null", O_WRONLY);

    is_child = true;
    if (nothing >= 0)
        dup2(nothing, 2); /* reports of expected crashes */
    __sanitizer_set_death_callback(on_report);
}

/* The child sets its handlers after rc_confine, which removes all handlers. */
void
__wrap_rc_confine(const struct rc_file *file)
{
    static const int signals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP};

    __real_rc_confine(file);
    for (size_t k = 0; k < sizeof signals / sizeof *signals; k++)
        signal(signals[k], on_signal);
}

/* ---- in the parent ---- */

static void
in_parent(void)
{
    children++;
}

static void
summary(void)
{
    fprintf(stderr, "sandbox: %lu children, of which %lu died in their library\n", children, died);
}

int
LLVMFuzzerInitialize(int *argc, char ***argv)
{
    void *frame[2];

    (void)argc, (void)argv;
    shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED || pthread_atfork(NULL, in_parent, in_child) != 0)
        abort();
    backtrace(frame, 2); /* this call loads its libraries while files can still be opened */
    atexit(summary);
    H5open(); /* here once, instead of in every child */
    return 0;
}

/* 1 if this address is code of the project, 0 if it belongs to a library, -1 otherwise. */
static int
belongs(void *pc)
{
    static const char *const systems[] = {"libc.so",  "libm.so",   "libgcc",
                                          "ld-linux", "libstdc++", "libpthread"};
    static const char *const own[] = {"tell", "on_report", "on_signal", "on_malloc", "on_free"};
    static Dl_info self;
    char name[256];
    Dl_info at;

    if (self.dli_fbase == NULL)
        dladdr((void *)(uintptr_t)LLVMFuzzerInitialize, &self);
    if (dladdr(pc, &at) == 0)
        return -1;
    for (size_t k = 0; k < sizeof systems / sizeof *systems; k++)
        if (strstr(at.dli_fname, systems[k]) != NULL)
            return -1;
    if (at.dli_fbase != self.dli_fbase)
        return 0;
    __sanitizer_symbolize_pc(pc, "%f", name, sizeof name);
    if (strncmp(name, "__", 2) == 0 || strstr(name, "::") != NULL)
        return -1;
    if (dlsym(RTLD_NEXT, name) != NULL) /* malloc, memmove, ... of the sanitizer */
        return -1;
    for (size_t k = 0; k < sizeof own / sizeof *own; k++)
        if (strcmp(name, own[k]) == 0)
            return -1;
    fprintf(stderr, "a child died in %s\n", name);
    return 1;
}

void
watch_judge(void)
{
    int whose = -1;

    merge(counters_start, shared->counter);
    memset(shared->counter, 0, counters());
    for (int k = 0; k < shared->depth && whose < 0; k++)
        whose = belongs(shared->frame[k]);
    died += shared->depth > 0;
    shared->depth = 0;
    if (whose == 1)
        abort();
}
