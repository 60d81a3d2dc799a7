/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "memory.h"

#include <errno.h>
#include <fcntl.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

enum {
    PATH_SIZE = 4096,
    LINE_SIZE = 2 * PATH_SIZE
};

/* ---- files of the kernel, read without the heap, because a report on memory must not allocate ---- */

struct text {
    int fd;
    size_t at, n; /* bytes of the buffer: processed, and read */
    char bytes[PATH_SIZE];
};

static bool
open_under(const char *root, const char *folder, const char *name, struct text *text)
{
    char path[2 * PATH_SIZE];
    int n = snprintf(path, sizeof path, "%s%s%s", root, folder, name);

    text->at = text->n = 0;
    text->fd = n < 0 || (size_t)n >= sizeof path ? -1 : open(path, O_RDONLY | O_CLOEXEC);
    return text->fd >= 0;
}

static bool
next_byte(struct text *text, char *byte)
{
    if (text->at == text->n) {
        ssize_t n;
        do
            n = read(text->fd, text->bytes, sizeof text->bytes);
        while (n < 0 && errno == EINTR);
        if (n <= 0)
            return false;
        text->n = (size_t)n;
        text->at = 0;
    }
    *byte = text->bytes[text->at++];
    return true;
}

/* Works as fgets: reads the next line, or as much of it as fits. false: no more lines. */
static bool
next_line(struct text *text, char *line, size_t size)
{
    size_t n = 0;

    while (n + 1 < size && next_byte(text, &line[n]))
        if (line[n++] == '\n')
            break;
    line[n] = '\0';
    return n > 0;
}

/* The number after `key` in a file of "key number" lines, times `unit`; NAN: none. Without a key the first
 * number of the file; "max" is none. */
static double
number_in(const char *root, const char *folder, const char *name, const char *key, double unit)
{
    struct text text;
    char line[512];
    double found = NAN;
    size_t n = strlen(key);

    if (!open_under(root, folder, name, &text))
        return NAN;
    while (isnan(found) && next_line(&text, line, sizeof line)) {
        char *end;
        unsigned long long value;

        if (strncmp(line, key, n) != 0)
            continue;
        value = strtoull(line + n, &end, 10);
        if (end != line + n)
            found = unit * (double)value;
    }
    close(text.fd);
    return found;
}

static double
status(const char *key)
{
    return number_in("", "/proc/self/", "status", key, 1024);
}

/* ---- this process ---- */

size_t
memory_held(void)
{
    struct text text;
    char line[512];
    long pages = 0;

    if (!open_under("", "/proc/self/", "statm", &text))
        return 0;
    if (!next_line(&text, line, sizeof line) || sscanf(line, "%*s %ld", &pages) != 1)
        pages = 0;
    close(text.fd);
    return (size_t)pages * (size_t)sysconf(_SC_PAGESIZE);
}

size_t
memory_peak(void)
{
    double peak = status("VmHWM:");
    struct rusage usage;

    if (!isnan(peak))
        return (size_t)peak;
    getrusage(RUSAGE_SELF, &usage);
    return (size_t)usage.ru_maxrss * 1024;
}

void
memory_keep_maps_apart(void)
{
#ifdef M_MMAP_THRESHOLD
    (void)mallopt(M_MMAP_THRESHOLD, MEMORY_APART);
#endif
}

void
memory_give_back(void)
{
#ifdef __GLIBC__
    (void)malloc_trim(0);
#endif
}

/* ---- limits ---- */

static void
lower(struct memory_room *room, double bytes, const char *why)
{
    if (bytes < room->bytes)
        *room = (struct memory_room){fmax(bytes, 0), why};
}

static void
look_at_machine(const char *root, struct memory_room *room)
{
    double available = number_in(root, "/proc/", "meminfo", "MemAvailable:", 1024);
    double swap = number_in(root, "/proc/", "meminfo", "SwapFree:", 1024);

    if (!isnan(available))
        lower(room, available + (isnan(swap) ? 0 : swap), "the machine has");
}

static void
look_at_limits(struct memory_room *room)
{
    const struct {
        int what;
        const char *held, *why;
    } limits[] = {{RLIMIT_AS, "VmSize:", "the limit of address space (ulimit -v) leaves"},
                  {RLIMIT_DATA, "VmData:", "the limit of data (ulimit -d) leaves"}};

    for (size_t k = 0; k < sizeof limits / sizeof *limits; k++) {
        struct rlimit r;
        double held = status(limits[k].held);

        if (getrlimit(limits[k].what, &r) == 0 && r.rlim_cur != RLIM_INFINITY)
            lower(room, (double)r.rlim_cur - (isnan(held) ? 0 : held), limits[k].why);
    }
}

/* Names of the files of a control group, by version of the interface. */
static const struct version {
    const char *type; /* type of the file system */
    bool named;       /* the controller has the name "memory" */
    const char *bound[2], *usage, *cached;
} versions[] = {
    {"cgroup2", false, {"/memory.max", "/memory.high"}, "/memory.current", "inactive_file "},
    {"cgroup",
     true,
     {"/memory.limit_in_bytes", "/memory.soft_limit_in_bytes"},
     "/memory.usage_in_bytes",
     "total_inactive_file "},
};

/* Soft limits of version 1 are ignored, because they do not limit anything by themselves. */
static size_t
bounds_of(const struct version *v)
{
    return v->named ? 1 : 2;
}

/* One group: its limit less its use, without cached pages of files, which the kernel drops first. */
static void
look_at_group(const char *root, const char *folder, const struct version *v,
              struct memory_room *room)
{
    double usage = number_in(root, folder, v->usage, "", 1);
    double cached = number_in(root, folder, "/memory.stat", v->cached, 1);

    if (isnan(usage))
        return;
    usage -= isnan(cached) ? 0 : fmin(cached, usage);
    for (size_t k = 0; k < bounds_of(v); k++) {
        double bound = number_in(root, folder, v->bound[k], "", 1);
        if (!isnan(bound))
            lower(room, bound - usage, "the group of processes (cgroup) leaves");
    }
}

static bool
has_word(const char *list, const char *word)
{
    size_t n = strlen(word);

    for (const char *at = list; (at = strstr(at, word)) != NULL; at += n)
        if ((at == list || at[-1] == ',') && (at[n] == '\0' || at[n] == ',' || at[n] == '\n'))
            return true;
    return false;
}

/* Reads from /proc/self/cgroup the path of the process in the tree of this version. */
static bool
group_path(const char *root, const struct version *v, char *path)
{
    struct text text;
    char line[LINE_SIZE];
    bool found = false;

    if (!open_under(root, "/proc/self/", "cgroup", &text))
        return false;
    while (!found && next_line(&text, line, sizeof line)) {
        char *names = strchr(line, ':'), *at = names == NULL ? NULL : strchr(names + 1, ':');
        if (at == NULL)
            continue;
        *at = '\0';
        at[1 + strcspn(at + 1, "\n")] = '\0';
        found = (v->named ? has_word(names + 1, "memory") : names[1] == '\0') &&
                strlen(at + 1) < PATH_SIZE;
        if (found)
            strcpy(path, at + 1);
    }
    close(text.fd);
    return found;
}

/* From /proc/self/mountinfo: where that tree is mounted, and which part of it. */
static bool
group_mount(const char *root, const struct version *v, char *part, char *mount)
{
    struct text text;
    char line[LINE_SIZE], type[64], options[1024];
    bool found = false;

    if (!open_under(root, "/proc/self/", "mountinfo", &text))
        return false;
    while (!found && next_line(&text, line, sizeof line)) {
        const char *rest = strstr(line, " - ");
        found = rest != NULL && sscanf(rest, " - %63s %*s %1023s", type, options) == 2 &&
                strcmp(type, v->type) == 0 && (!v->named || has_word(options, "memory")) &&
                sscanf(line, "%*s %*s %*s %4095s %4095s", part, mount) == 2;
    }
    close(text.fd);
    return found;
}

/* True if the path leads to the group, given by its first n bytes, or inside it. */
static bool
is_inside(const char *path, const char *group, size_t n)
{
    return strncmp(path, group, n) == 0 && (path[n] == '/' || path[n] == '\0');
}

/* Goes from the process's own group to the outermost visible one. In a container only the inner part of the
 * tree is mounted; the path does not show what lies outside. */
static void
look_at_groups(const char *root, const struct version *v, struct memory_room *room)
{
    char path[PATH_SIZE], part[PATH_SIZE], mount[PATH_SIZE], folder[2 * PATH_SIZE];
    size_t n, top;

    if (!group_path(root, v, path) || !group_mount(root, v, part, mount))
        return;
    n = strcmp(part, "/") == 0 ? 0 : strlen(part);
    top = strlen(mount);
    snprintf(folder, sizeof folder, "%s%s", mount,
             is_inside(path, part, n) ? path + n
             : strcmp(path, "/") == 0 ? ""
                                      : path);
    for (;;) {
        look_at_group(root, folder, v, room);
        if (strlen(folder) <= top || strrchr(folder, '/') < folder + top)
            return;
        *strrchr(folder, '/') = '\0';
    }
}

struct memory_room
memory_room(const char *root, size_t shared)
{
    struct memory_room room = {INFINITY, ""};

    look_at_machine(root, &room);
    for (size_t k = 0; k < sizeof versions / sizeof *versions; k++)
        look_at_groups(root, &versions[k], &room);
    room.bytes /= (double)shared;
    look_at_limits(&room);
    return room;
}
