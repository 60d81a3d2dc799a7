/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Allocation number n fails: malloc, calloc, realloc, posix_memalign, aligned_alloc and FFTW's own.
 *
 * Counted are the allocations of the program itself, and those of libraries that handle a failure. These are
 * the C library, GSL with its handler off, zlib, libdeflate, libpng, libzip, libmd. Not counted are those of
 * libraries that end the process when memory is short, because a program cannot handle that. These are GLib,
 * and with it Pango; OpenMP; FFTW's planner. Those of libxml2, libhdf5 and libtiff, which guarantee nothing,
 * do not count either. The last two run in a separate process (formats/sandbox). The return address of the
 * call shows who allocates; if it lies in a library that handles failures, the caller of the library decides.
 * As a preloaded library it reads the environment: RC_FAULT_AT=n, 0 for none. RC_FAULT_STAY=1: all later
 * allocations fail too. RC_FAULT_COUNT=FILE: the number of allocations is written there when the process
 * exits. Child processes are not affected. The address sanitizer comes after it
 * (ASAN_OPTIONS=verify_asan_link_order=0).
 */
#define _GNU_SOURCE /* dl_iterate_phdr, RTLD_NEXT */
#include "failing_malloc.h"

#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void *fftw_malloc(size_t n);
void *fftwf_malloc(size_t n);
void fftw_free(void *at);
void fftwf_free(void *at);
void *reallocarray(void *old, size_t n, size_t size);

enum whose {
    NOBODYS, /* does not count                             */
    COUNTED,
    PASSED_ON /* the caller of the library decides */
};

enum {
    OBJECTS = 512,
    DEPTH = 24,
    HELD = 1 << 16 /* slots for held blocks */
};

static struct object {
    uintptr_t begin, end;
    enum whose whose;
} object[OBJECTS];
static size_t objects;

static struct {
    size_t at, count, held;
    bool armed, stay, here, lost, in_library;
    pid_t process;
} fault;
static void *held[HELD];
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static _Thread_local volatile bool busy;

/* ---- who allocates ---- */

static enum whose
whose_is(const char *file)
{
    static const char *const passed_on[] = {"libc.so",     "libm.so", "libasan", "libubsan",
                                            "ld-linux",    "libgsl.", "libz.",   "libpng16",
                                            "libdeflate.", "libzip.", "libmd."};
    const char *slash = strrchr(file, '/'), *name = slash == NULL ? file : slash + 1;

    if (*name == '\0') /* the program */
        return COUNTED;
    for (size_t k = 0; k < sizeof passed_on / sizeof *passed_on; k++)
        if (strncmp(name, passed_on[k], strlen(passed_on[k])) == 0)
            return PASSED_ON;
    return NOBODYS;
}

static int
note_object(struct dl_phdr_info *info, size_t size, void *unused)
{
    (void)size, (void)unused;
    for (size_t k = 0; k < info->dlpi_phnum && objects < OBJECTS; k++)
        if (info->dlpi_phdr[k].p_type == PT_LOAD && (info->dlpi_phdr[k].p_flags & PF_X) != 0) {
            uintptr_t begin = info->dlpi_addr + info->dlpi_phdr[k].p_vaddr;

            object[objects++] = (struct object){begin, begin + info->dlpi_phdr[k].p_memsz,
                                                whose_is(info->dlpi_name)};
        }
    return 0;
}

static enum whose
whose_code(const void *place)
{
    uintptr_t at = (uintptr_t)place;

    for (size_t k = 0; k < objects; k++)
        if (at >= object[k].begin && at < object[k].end)
            return object[k].whose;
    return NOBODYS; /* a library that was loaded later: a plug-in */
}

static bool
is_counted(const void *caller)
{
    enum whose whose = whose_code(caller);
    void *frame[DEPTH];
    int depth;

    if (whose != PASSED_ON)
        return whose == COUNTED;
    depth = backtrace(frame, DEPTH);
    for (int k = 0; k < depth; k++) /* up the stack to the C library, and on to its caller */
        if (frame[k] == caller) {
            for (; k < depth; k++)
                if ((whose = whose_code(frame[k])) != PASSED_ON)
                    return whose == COUNTED;
        }
    return false;
}

/* ---- blocks that are allocated ---- */

static void
hold(void *at)
{
    size_t k = ((uintptr_t)at >> 4) * 2654435761u % HELD;

    for (size_t tries = 0; held[k] != NULL; k = (k + 1) % HELD)
        if (++tries == HELD - 1) {
            fault.lost = true;
            return;
        }
    held[k] = at;
    fault.held++;
}

/* Removes an entry, and moves later entries forward as linear probing requires. */
static void
let_go(const void *at)
{
    size_t k = ((uintptr_t)at >> 4) * 2654435761u % HELD;

    while (held[k] != NULL && held[k] != at)
        k = (k + 1) % HELD;
    if (held[k] == NULL)
        return;
    held[k] = NULL;
    fault.held--;
    for (k = (k + 1) % HELD; held[k] != NULL; k = (k + 1) % HELD) {
        void *moved = held[k];

        held[k] = NULL;
        fault.held--;
        hold(moved);
    }
}

/* ---- counting ---- */

/* True if this allocation must fail. */
static bool
fails(const void *caller, bool *counted)
{
    bool hit = false;

    *counted = false;
    if (!fault.armed || busy)
        return false;
    busy = true;
    if (getpid() == fault.process && is_counted(caller)) {
        pthread_mutex_lock(&lock);
        fault.count++;
        hit = fault.at > 0 && (fault.stay ? fault.count >= fault.at : fault.count == fault.at);
        if (hit && fault.count == fault.at)
            fault.in_library = whose_code(caller) == PASSED_ON;
        *counted = true;
        pthread_mutex_unlock(&lock);
    }
    busy = false;
    if (hit)
        errno = ENOMEM;
    return hit;
}

static void *
kept(void *at, bool counted)
{
    if (at == NULL || !counted || !fault.here)
        return at;
    pthread_mutex_lock(&lock);
    hold(at);
    pthread_mutex_unlock(&lock);
    return at;
}

static void
forget(const void *at)
{
    if (at == NULL || !fault.here)
        return;
    pthread_mutex_lock(&lock);
    let_go(at);
    pthread_mutex_unlock(&lock);
}

/* ---- functions in place of the C library's ---- */

/* The search for the real functions may itself allocate and free; meanwhile memory comes from a small buffer
 * that is never freed. */
static _Thread_local volatile bool
    looking; /* volatile: dlsym is declared as a function that never calls back */
static _Alignas(16) char store[1 << 14];
static size_t stored;

static void *
from_store(size_t n)
{
    char *at = store + stored;

    n = (n + 15) / 16 * 16;
    if (n > sizeof store - stored)
        return NULL;
    stored += n;
    return at;
}

static bool
is_stored(const void *at)
{
    return (const char *)at >= store && (const char *)at < store + sizeof store;
}

static void *
find(const char *name)
{
    void *at;

    looking = true;
    at = dlsym(RTLD_NEXT, name);
    looking = false;
    return at;
}

/* The real function of this name. */
#define REAL(name)                                                                                 \
    static __typeof__(name) *real;                                                                 \
    if (real == NULL)                                                                              \
    *(void **)&real = find(#name)

void *
malloc(size_t n)
{
    if (looking)
        return from_store(n);
    REAL(malloc);
    bool counted;

    return fails(__builtin_return_address(0), &counted) ? NULL : kept(real(n), counted);
}

void *
calloc(size_t n, size_t size)
{
    if (looking)
        return from_store(n * size); /* zeros, because the buffer is used only once */
    REAL(calloc);
    bool counted;

    return fails(__builtin_return_address(0), &counted) ? NULL : kept(real(n, size), counted);
}

static void *
resize(const void *caller, void *old, size_t n)
{
    REAL(realloc);
    bool counted;
    void *at;

    if (fails(caller, &counted))
        return NULL;
    forget(old);
    at = real(old, n);
    return at == NULL && n > 0 ? kept(old, counted), NULL : kept(at, counted);
}

void *
realloc(void *old, size_t n)
{
    return resize(__builtin_return_address(0), old, n);
}

void *
reallocarray(void *old, size_t n, size_t size)
{
    if (size > 0 && n > SIZE_MAX / size) {
        errno = ENOMEM;
        return NULL;
    }
    return resize(__builtin_return_address(0), old, n * size);
}

int
posix_memalign(void **at, size_t alignment, size_t n)
{
    REAL(posix_memalign);
    bool counted;
    int status;

    if (fails(__builtin_return_address(0), &counted))
        return ENOMEM;
    if ((status = real(at, alignment, n)) == 0)
        kept(*at, counted);
    return status;
}

void *
aligned_alloc(size_t alignment, size_t n)
{
    REAL(aligned_alloc);
    bool counted;

    return fails(__builtin_return_address(0), &counted) ? NULL : kept(real(alignment, n), counted);
}

void
free(void *at)
{
    if (looking || is_stored(at))
        return;
    REAL(free);

    forget(at);
    real(at);
}

void *
fftw_malloc(size_t n)
{
    REAL(fftw_malloc);
    bool counted;

    return fails(__builtin_return_address(0), &counted) ? NULL : kept(real(n), counted);
}

void *
fftwf_malloc(size_t n)
{
    REAL(fftwf_malloc);
    bool counted;

    return fails(__builtin_return_address(0), &counted) ? NULL : kept(real(n), counted);
}

/* These call free of the C library, which is replaced above and removes the block from the list. */

/* ---- from the program, from the environment ---- */

static void
look_around(void)
{
    void *frame[2];

    busy = true;
    objects = 0;
    dl_iterate_phdr(note_object, NULL);
    backtrace(frame, 2); /* loads the libraries that it needs */
    busy = false;
}

void
fault_arm(size_t n, bool stay)
{
    look_around();
    memset(held, 0, sizeof held);
    fault.at = n;
    fault.stay = stay;
    fault.count = fault.held = 0;
    fault.process = getpid();
    fault.in_library = false;
    fault.here = fault.armed = true;
}

size_t
fault_disarm(void)
{
    fault.armed = false;
    return fault.count;
}

size_t
fault_held(void)
{
    if (fault.lost)
        abort();
    return fault.held;
}

bool
fault_in_library(void)
{
    return fault.in_library;
}

__attribute__((constructor)) static void
begin(void)
{
    const char *at = getenv("RC_FAULT_AT"), *stay = getenv("RC_FAULT_STAY");

    if (at == NULL)
        return;
    look_around();
    fault.at = (size_t)strtoull(at, NULL, 10);
    fault.stay = stay != NULL;
    fault.process = getpid();
    fault.armed = true;
}

__attribute__((destructor)) static void
end(void)
{
    const char *name = getenv("RC_FAULT_COUNT");
    char text[32];
    int fd, n;

    fault.armed = false;
    if (name == NULL || getpid() != fault.process ||
        (fd = open(name, O_WRONLY | O_CREAT | O_TRUNC, 0600)) < 0)
        return;
    n = snprintf(text, sizeof text, "%zu\n", fault.count);
    if (write(fd, text, (size_t)n) != n)
        abort();
    close(fd);
}
