/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The free memory is the minimum of that of the machine, the rest of each control group of the process, and
 * its own limits. The test reads them from files like those of the kernel. */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tools/machine/machine.h"

static const double mib = 1 << 20;

/* A folder with replacements of these files. */
static char root[] = "/tmp/memory-room-XXXXXX";

static void
put(const char *name, const char *text)
{
    char path[512];
    FILE *file;

    for (const char *s = strchr(name + 1, '/'); s != NULL; s = strchr(s + 1, '/')) {
        snprintf(path, sizeof path, "%s%.*s", root, (int)(s - name), name);
        mkdir(path, 0777);
    }
    snprintf(path, sizeof path, "%s%s", root, name);
    assert_non_null(file = fopen(path, "w"));
    fputs(text, file);
    fclose(file);
}

static int
begin(void **state)
{
    (void)state;
    strcpy(root + strlen(root) - 6, "XXXXXX");
    return mkdtemp(root) == NULL;
}

static int
end(void **state)
{
    char command[64];

    (void)state;
    snprintf(command, sizeof command, "rm -r %s", root);
    return system(command);
}

static void
the_machine(const char *available, const char *swap)
{
    char text[256];

    snprintf(text, sizeof text,
             "MemTotal:       24684040 kB\nMemFree:          10 kB\nMemAvailable:   %s kB\n"
             "SwapTotal:             99999999 kB\nSwapFree:              %s kB\n",
             available, swap);
    put("/proc/meminfo", text);
}

static void
test_machine(void **state)
{
    struct memory_room room;

    (void)state;
    room = memory_room(root, 1);
    assert_true(isinf(room.bytes)); /* there is no file */
    the_machine("2048", "1024");
    room = memory_room(root, 1);
    assert_true(room.bytes == 3 * mib);
    assert_string_equal(room.why, "the machine has");
    assert_true(memory_room(root, 4).bytes == 3 * mib / 4); /* four processes share it */
}

/* Processes of the same name share cores and memory: those of other names, and this one, do not count. */
static void
test_siblings(void **state)
{
    struct siblings s;
    char self[64];

    (void)state;
    assert_true(machine_siblings(root).n == 1); /* there is no file */
    put("/proc/self/comm", "rc-solve\n");
    snprintf(self, sizeof self, "/proc/%ld/comm", (long)getpid());
    put(self, "rc-solve\n");
    put("/proc/71/comm", "rc-solve\n");
    put("/proc/71/statm", "900 30 5 1 0 9 0\n");
    put("/proc/72/comm", "rc-solve\n");
    put("/proc/72/statm", "900 12 5 1 0 9 0\n");
    put("/proc/73/comm", "rc-slip\n");
    put("/proc/73/statm", "900 500 5 1 0 9 0\n");
    put("/proc/sys/comm", "rc-solve\n");
    s = machine_siblings(root);
    assert_true(s.n == 3 && s.bytes == 42.0 * (double)sysconf(_SC_PAGESIZE));
}

static const char mounts2[] =
    "22 1 8:1 / / rw - ext4 /dev/root rw\n"
    "30 22 0:26 / /sys/fs/cgroup rw,nosuid shared:4 - cgroup2 cgroup2 rw,nsdelegate\n";

/* The group of the process has a high limit, its parent a lower one: the group nearest to its limit counts.
 * Cached pages of files do not count as used. */
static void
test_version_2(void **state)
{
    struct memory_room room;

    (void)state;
    the_machine("99999999", "0");
    put("/proc/self/mountinfo", mounts2);
    put("/proc/self/cgroup", "0::/user.slice/job\n");
    put("/sys/fs/cgroup/user.slice/job/memory.max", "max\n");
    put("/sys/fs/cgroup/user.slice/job/memory.high", "67108864\n");
    put("/sys/fs/cgroup/user.slice/job/memory.current", "33554432\n");
    put("/sys/fs/cgroup/user.slice/job/memory.stat", "anon 1\nfile 99\ninactive_file 1048576\n");
    room = memory_room(root, 1);
    assert_true(room.bytes == 33 * mib);
    assert_non_null(strstr(room.why, "cgroup"));
    put("/sys/fs/cgroup/user.slice/memory.max", "104857600\n");
    put("/sys/fs/cgroup/user.slice/memory.high", "max\n");
    put("/sys/fs/cgroup/user.slice/memory.current", "94371840\n");
    put("/sys/fs/cgroup/user.slice/memory.stat", "inactive_file 0\n");
    assert_true(memory_room(root, 1).bytes == 10 * mib);
    put("/sys/fs/cgroup/user.slice/memory.current", "104857600\n");
    assert_true(memory_room(root, 1).bytes == 0);
    put("/sys/fs/cgroup/user.slice/memory.current", "204857600\n"); /* above a bound set later */
    assert_true(memory_room(root, 1).bytes == 0);
    put("/sys/fs/cgroup/user.slice/memory.max", "max\n");
    assert_true(memory_room(root, 1).bytes == 33 * mib);
}

/* The separate tree of the memory controller (version 1), beside an empty tree of version 2; a soft limit has
 * no effect. */
static void
test_version_1(void **state)
{
    (void)state;
    the_machine("99999999", "0");
    put("/proc/self/mountinfo",
        "33 31 0:30 / /sys/fs/cgroup/cpu rw - cgroup cgroup rw,cpu\n"
        "35 31 0:32 / /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory\n"
        "41 31 0:38 / /sys/fs/cgroup/unified rw,relatime - cgroup2 cgroup2 rw\n");
    put("/proc/self/cgroup", "9:name=systemd:/\n4:memory:/a/b\n1:cpu:/\n0::/\n");
    put("/sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
    put("/sys/fs/cgroup/memory/memory.usage_in_bytes", "1\n");
    put("/sys/fs/cgroup/memory/a/memory.limit_in_bytes", "52428800\n");
    put("/sys/fs/cgroup/memory/a/memory.usage_in_bytes", "41943040\n");
    put("/sys/fs/cgroup/memory/a/memory.stat",
        "cache 5\ninactive_file 7\ntotal_inactive_file 2097152\n");
    put("/sys/fs/cgroup/memory/a/b/memory.limit_in_bytes", "9223372036854771712\n");
    put("/sys/fs/cgroup/memory/a/b/memory.soft_limit_in_bytes", "5\n");
    put("/sys/fs/cgroup/memory/a/b/memory.usage_in_bytes", "41943040\n");
    assert_true(memory_room(root, 1).bytes == 12 * mib);
}

/* In a container the tree is mounted from the container's group downwards, and paths do not show this. */
static void
test_container(void **state)
{
    (void)state;
    the_machine("99999999", "0");
    put("/proc/self/mountinfo", "30 22 0:26 /docker/4f1c /sys/fs/cgroup ro - cgroup2 cgroup rw\n");
    put("/proc/self/cgroup", "0::/docker/4f1c/inner\n");
    put("/sys/fs/cgroup/memory.max", "20971520\n");
    put("/sys/fs/cgroup/memory.current", "10485760\n");
    assert_true(memory_room(root, 1).bytes == 10 * mib);
    put("/sys/fs/cgroup/inner/memory.max", "20971520\n");
    put("/sys/fs/cgroup/inner/memory.current", "12582912\n");
    assert_true(memory_room(root, 1).bytes == 8 * mib);
    put("/proc/self/cgroup", "0::/\n"); /* in a separate name space */
    assert_true(memory_room(root, 1).bytes == 10 * mib);
    put("/proc/self/cgroup", "0::/docker/4f1c\n");
    assert_true(memory_room(root, 1).bytes == 10 * mib);
}

/* A group whose name only begins like that of the mounted group lies outside of it. Then only the limits of
 * the mounted group are visible. */
static void
test_names_that_begin_alike(void **state)
{
    (void)state;
    the_machine("99999999", "0");
    put("/proc/self/mountinfo", "30 22 0:26 /a /sys/fs/cgroup ro - cgroup2 cgroup rw\n");
    put("/sys/fs/cgroup/memory.max", "20971520\n");
    put("/sys/fs/cgroup/memory.current", "10485760\n");
    put("/sys/fs/cgroup/b/memory.max", "20971520\n");
    put("/sys/fs/cgroup/b/memory.current", "12582912\n");
    put("/sys/fs/cgroupb/memory.max", "20971520\n");
    put("/sys/fs/cgroupb/memory.current", "20971520\n");
    put("/proc/self/cgroup", "0::/ab\n");
    assert_true(memory_room(root, 1).bytes == 10 * mib);
    put("/proc/self/cgroup", "0::/ab/c\n");
    assert_true(memory_room(root, 1).bytes == 10 * mib);
    put("/proc/self/cgroup", "0::/a/b\n");
    assert_true(memory_room(root, 1).bytes == 8 * mib);
}

/* Limits of the process, in a child, so that the test itself is not limited. */
static void
test_limits(void **state)
{
    int status = 0;
    pid_t child;

    (void)state;
    if ((child = fork()) == 0) {
        struct memory_room room;
        struct rlimit r = {(rlim_t)1 << 40, (rlim_t)1 << 40};

        setrlimit(RLIMIT_AS, &r);
        room = memory_room(root, 1);
        _exit(strstr(room.why, "ulimit -v") != NULL && room.bytes < (double)r.rlim_cur &&
                      room.bytes > 0
                  ? 0
                  : 1);
    }
    assert_true(waitpid(child, &status, 0) == child);
    assert_true(WIFEXITED(status));
#ifndef __SANITIZE_ADDRESS__ /* the sanitizer has reserved more address space than this */
    assert_int_equal(WEXITSTATUS(status), 0);
#endif
}

/* Memory that was written to counts, memory that was only allocated does not, and the peak remains. */
static void
test_held(void **state)
{
    const size_t n = (size_t)64 << 20;
    size_t before = memory_held(), peak;
    char *p = mmap(NULL, n, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);

    (void)state;
    assert_true(p != MAP_FAILED);
    assert_true(before > 0);
    assert_true((double)memory_held() < (double)before + 4 * mib);
    memset(p, 1, n);
    assert_true((double)memory_held() > (double)before + 60 * mib);
    assert_true((double)memory_held() < (double)before + 68 * mib);
    peak = memory_peak();
    assert_true(peak + (1 << 20) >= memory_held());
    munmap(p, n);
    assert_true((double)memory_held() < (double)before + 4 * mib);
    assert_true(memory_peak() + (1 << 20) >=
                peak); /* each thread updates the kernel's counters only from time to time */
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_machine, begin, end),
        cmocka_unit_test_setup_teardown(test_siblings, begin, end),
        cmocka_unit_test_setup_teardown(test_version_2, begin, end),
        cmocka_unit_test_setup_teardown(test_version_1, begin, end),
        cmocka_unit_test_setup_teardown(test_container, begin, end),
        cmocka_unit_test_setup_teardown(test_names_that_begin_alike, begin, end),
        cmocka_unit_test_setup_teardown(test_limits, begin, end),
        cmocka_unit_test(test_held),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
