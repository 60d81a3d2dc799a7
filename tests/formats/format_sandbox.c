/* SPDX-License-Identifier: GPL-3.0-or-later */
/* For any behaviour of a reader in the sandbox the program gets a result or a reason, in limited time and
 * memory. */
#define _DEFAULT_SOURCE /* syscall, MAP_ANONYMOUS */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "formats/sandbox/calls.h"
#include "formats/sandbox/result.h"
#include "formats/sandbox/sandbox.h"

static int inherited; /* an open file of the parent */
static pid_t parent;  /* the process that makes the child */

static const struct rc_file file = {.name = "made", .data = (const unsigned char *)"x", .size = 1};

static enum rc_status
fill_good(const struct rc_file *f, const struct rc_map *map, double *v, struct rc_err *err)
{
    (void)f, (void)err;
    for (size_t k = 0; k < 60000; k++)
        v[k] = k % 7 == 0 ? NAN : (double)(k + map->more);
    rc_note(map->notes, "worth saying");
    return RC_OK;
}

static enum rc_status
good(const struct rc_file *f, struct rc_maps *maps, struct rc_err *err)
{
    (void)err;
    assert_ptr_equal(f, &file);
    for (size_t k = 0; k < 4; k++) {
        struct rc_map *map = rc_maps_add(maps, rc_piece_of("height"));

        map->nx = 300;
        map->ny = 200;
        map->dx = 1.1e-6;
        map->dy = 0.7e-6;
        map->fill = fill_good;
        map->more = k;
        rc_map_unit(map, rc_piece_of("nm"));
    }
    rc_maps_key(maps, "file.date", rc_piece_of("2024\xc2\xb5"));
    return RC_OK;
}

static struct rc_grid *
read_apart(rc_maps_find *find, size_t index, struct rc_notes *notes, struct rc_err *err)
{
    RC_OWN(rc_maps, maps) = rc_maps_new(&file, &rc_no_wish, err);

    assert_non_null(maps);
    return rc_sandbox_read(maps, find, &rc_no_wish, index, notes, err);
}

static size_t
list_apart(rc_maps_find *find, struct rc_channel channel[2], struct rc_err *err)
{
    RC_OWN(rc_maps, maps) = rc_maps_new(&file, &rc_no_wish, err);

    assert_non_null(maps);
    return rc_sandbox_describe(maps, find, err) == RC_OK ? rc_maps_list(maps, channel, 2) : 0;
}

static enum rc_status
refusing(const struct rc_file *f, struct rc_maps *maps, struct rc_err *err)
{
    (void)f, (void)maps;
    return rc_err_set(err, "what is wrong: 7");
}

static enum rc_status
crashing(const struct rc_file *f, struct rc_maps *maps, struct rc_err *err)
{
    (void)f, (void)maps, (void)err;
    abort();
}

/* cmocka catches this signal: its handler must not run in the child. */
static enum rc_status
segfaulting(const struct rc_file *f, struct rc_maps *maps, struct rc_err *err)
{
    (void)f, (void)maps;
    raise(SIGSEGV);
    return rc_err_set(err, "alive");
}

static enum rc_status
endless(const struct rc_file *f, struct rc_maps *maps, struct rc_err *err)
{
    volatile size_t k = 0;

    (void)f, (void)maps, (void)err;
    for (;;)
        k++;
    return RC_FAIL;
}

static enum rc_status
stubborn(const struct rc_file *f, struct rc_maps *maps, struct rc_err *err)
{
    sigset_t all;

    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, NULL);
    return endless(f, maps, err);
}

static enum rc_status
waiting(const struct rc_file *f, struct rc_maps *maps, struct rc_err *err)
{
    (void)f, (void)maps, (void)err;
    for (;;)
        pause();
    return RC_FAIL;
}

static enum rc_status
asleep(const struct rc_file *f, struct rc_maps *maps, struct rc_err *err)
{
    sigset_t all;

    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, NULL);
    return waiting(f, maps, err);
}

static enum rc_status
greedy(const struct rc_file *f, struct rc_maps *maps, struct rc_err *err)
{
    size_t got = 0;

    (void)f, (void)maps;
    for (void *p; (p = malloc(1 << 20)) != NULL; got++)
        memset(p, 1, 1 << 20);
    /* it keeps its memory until it is killed: NOLINTNEXTLINE(clang-analyzer-unix.Malloc) */
    return rc_err_set(err, "memory ended after %zu MiB", got);
}

static enum rc_status
nosy(const struct rc_file *f, struct rc_maps *maps, struct rc_err *err)
{
    int fd = open("/etc/passwd", O_RDONLY);

    (void)f, (void)maps;
    return rc_err_set(err, fd < 0 ? "closed" : "open");
}

/* ---- ways out ---- */

/* Each function tries one way out of the sandbox and returns a value below 0, with errno, if it is closed. It
 * would change only files in the test's folder. */
static int
way_open(void)
{
    return open("made-by-child", O_WRONLY | O_CREAT, 0600);
}

static int
way_openat(void)
{
    return (int)syscall(SYS_openat, AT_FDCWD, "/etc/passwd", O_RDONLY);
}

static int
way_unlink(void)
{
    return unlink("victim");
}

static int
way_rename(void)
{
    return rename("victim", "moved");
}

static int
way_link(void)
{
    return symlink("victim", "link");
}

static int
way_mkdir(void)
{
    return mkdir("made-by-child", 0700);
}

static int
way_chmod(void)
{
    return chmod("victim", 0777);
}

static int
way_truncate(void)
{
    return truncate("victim", 0);
}

static int
way_inherited_write(void)
{
    return (int)write(inherited, "bad", 3);
}

static int
way_inherited_map(void)
{
    void *p = mmap(NULL, 6, PROT_READ | PROT_WRITE, MAP_SHARED, inherited, 0);

    if (p == MAP_FAILED)
        return -1;
    memcpy(p, "bad", 3);
    return 0;
}

static int
way_inherited_truncate(void)
{
    return ftruncate(inherited, 0);
}

static int
way_standard_output(void)
{
    return (int)write(STDOUT_FILENO, "", 0);
}

static int
way_standard_error(void)
{
    return (int)write(STDERR_FILENO, "", 0);
}

static int
way_standard_input(void)
{
    char byte;

    return (int)read(STDIN_FILENO, &byte, 0);
}

static int
way_socket(void)
{
    return socket(AF_INET, SOCK_STREAM, 0);
}

static int
way_local_socket(void)
{
    return socket(AF_UNIX, SOCK_STREAM, 0);
}

static int
way_exec(void)
{
    char *const arguments[] = {"true", NULL};

    return execv("/bin/true", arguments);
}

static int
way_fork(void)
{
    pid_t child = fork();

    if (child == 0)
        _exit(0);
    return child;
}

static int
way_signal(void)
{
    return kill(parent, 0);
}

static int
way_thread_signal(void)
{
    return (int)syscall(SYS_tgkill, parent, parent, 0);
}

static int
way_trace(void)
{
    return (int)syscall(SYS_ptrace, 16 /* PTRACE_ATTACH */, parent, 0, 0);
}

static int
way_memory(void)
{
    static char byte = 'x';
    struct iovec here = {&byte, 1}, there = {&byte, 1};

    return (int)syscall(SYS_process_vm_writev, parent, &here, 1, &there, 1, 0);
}

static int
way_code(void)
{
    return mmap(NULL, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) == MAP_FAILED
               ? -1
               : 0;
}

static int
way_made_code(void)
{
    void *p = mmap(NULL, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);

    return p == MAP_FAILED ? 0 : mprotect(p, 4096, PROT_READ | PROT_EXEC);
}

static int
way_limits(void)
{
    const struct rlimit all = {RLIM_INFINITY, RLIM_INFINITY};

    return setrlimit(RLIMIT_AS, &all);
}

static int
way_timer(void)
{
    const struct itimerval never = {{0, 0}, {0, 0}};

    return setitimer(ITIMER_PROF, &never, NULL);
}

static int
way_user(void)
{
    return setuid(0);
}

static int
way_folder(void)
{
    return chdir("/");
}

static int
way_kernel_ring(void)
{
    return (int)syscall(425 /* io_uring_setup */, 1, NULL);
}

static int
way_memory_file(void)
{
    return (int)syscall(SYS_memfd_create, "x", 0);
}

static int
way_filter(void)
{
    return prctl(PR_SET_SECCOMP, 0, NULL, 0, 0);
}

static int
way_environment(void)
{
    struct stat st;

    return stat("/etc/passwd", &st);
}

static const struct {
    const char *name;
    int (*go)(void);
} ways[] = {
    {"making a file", way_open},
    {"reading a file", way_openat},
    {"removing a file", way_unlink},
    {"renaming a file", way_rename},
    {"a link", way_link},
    {"making a folder", way_mkdir},
    {"rights of a file", way_chmod},
    {"cutting a file off", way_truncate},
    {"writing to a file that was open", way_inherited_write},
    {"mapping a file that was open", way_inherited_map},
    {"cutting off a file that was open", way_inherited_truncate},
    {"standard output", way_standard_output},
    {"standard error", way_standard_error},
    {"standard input", way_standard_input},
    {"the network", way_socket},
    {"a socket of this machine", way_local_socket},
    {"another program", way_exec},
    {"another process", way_fork},
    {"a signal to the parent", way_signal},
    {"a signal to a thread of it", way_thread_signal},
    {"tracing the parent", way_trace},
    {"memory of the parent", way_memory},
    {"code", way_code},
    {"code of its own making", way_made_code},
    {"its limits", way_limits},
    {"its timer", way_timer},
    {"another user", way_user},
    {"another folder", way_folder},
    {"calls by a ring", way_kernel_ring},
    {"a file in memory", way_memory_file},
    {"the filter itself", way_filter},
    {"what files there are", way_environment},
};

/* Tries all ways out, and refuses the file with the names of the open ones. */
static enum rc_status
escaping(const struct rc_file *f, struct rc_maps *maps, struct rc_err *err)
{
    char open_ways[1024] = ""; /* list of all their names */

    (void)f, (void)maps;
    for (size_t k = 0; k < sizeof ways / sizeof *ways; k++) {
        errno = 0;
        if (ways[k].go() >= 0 || errno != EPERM) {
            strncat(open_ways, ways[k].name, sizeof open_ways - strlen(open_ways) - 3);
            strcat(open_ways, "; ");
        }
    }
    return rc_err_set(err, "open: %s", open_ways);
}

static void
there_is_no_way_out(void **state)
{
    char folder[] = "/tmp/rc-sandbox-XXXXXX", text[16] = "", before[4096];
    struct rc_notes notes = {0};
    struct rc_err err = {""};
    struct stat st;
    FILE *f;

    (void)state;
    if (!rc_calls_can_be_filtered()) {
        print_message("This system filters no calls: the sandbox has its limits only.\n");
        skip();
    }
    assert_non_null(getcwd(before, sizeof before));
    assert_non_null(mkdtemp(folder));
    assert_int_equal(chdir(folder), 0);
    assert_non_null(f = fopen("victim", "w+"));
    assert_true(fputs("whole\n", f) >= 0 && fflush(f) == 0 && chmod("victim", 0600) == 0);
    inherited = fileno(f);
    parent = getpid();
    assert_null(read_apart(escaping, 0, &notes, &err));
    assert_string_equal(err.text, "open: ");
    rewind(f);
    assert_non_null(fgets(text, sizeof text, f));
    assert_string_equal(text, "whole\n");
    assert_int_equal(fclose(f), 0);
    assert_true(stat("victim", &st) == 0 && (st.st_mode & 0777) == 0600);
    assert_true(access("made-by-child", F_OK) != 0 && access("link", F_OK) != 0);
    printf("%zu ways out, each shut\n", sizeof ways / sizeof *ways);
    assert_int_equal(unlink("victim"), 0);
    assert_int_equal(chdir(before), 0);
    assert_int_equal(rmdir(folder), 0);
}

static void
check_good(const struct rc_grid *g)
{
    assert_non_null(g);
    assert_true(g->nx == 300 && g->ny == 200 && g->dx == 1.1e-6 && g->dy == 0.7e-6);
    for (size_t k = 0; k < 60000; k++)
        assert_true(k % 7 == 0 ? g->v[k] != g->v[k] : g->v[k] == (double)(k + 3) * 1e-9);
    assert_string_equal(rc_grid_get(g, "file.date"), "2024\xc2\xb5");
}

static void
a_grid_comes_back_whole(void **state)
{
    struct rc_notes notes = {0};
    struct rc_err err = {""};
    struct rc_grid *g = read_apart(good, 3, &notes, &err);

    (void)state;
    if (g == NULL)
        fail_msg("%s", err.text);
    check_good(g);
    assert_int_equal(notes.n, 1);
    assert_string_equal(notes.text[0], "worth saying");
    rc_grid_free(g);
}

/* The bytes in which a child sends the grid of good(); the caller frees them. */
static char *
sent_result(size_t *n)
{
    struct rc_result r = {.n = 1};
    RC_OWN(rc_maps, maps) = rc_maps_new(&file, &rc_no_wish, NULL);
    struct rc_grid *g;
    char *bytes = NULL;
    FILE *to = open_memstream(&bytes, n);

    assert_non_null(to);
    assert_true(maps != NULL && rc_maps_describe(maps, good, NULL) == RC_OK);
    g = rc_maps_read(maps, &rc_no_wish, 3, &r.noted, &r.said);
    assert_true(rc_result_send_grid(to, &r, g));
    assert_int_equal(fclose(to), 0);
    rc_grid_free(g);
    return bytes;
}

static bool
receive(char *bytes, size_t n, struct rc_grid **g, struct rc_notes *notes)
{
    FILE *from = fmemopen(bytes, n, "rb");
    struct rc_result r;
    bool whole;

    assert_non_null(from);
    *g = NULL;
    if ((whole = rc_result_receive(from, &r)) && r.n > 0)
        whole = (*g = rc_result_receive_grid(from, &file)) != NULL;
    if (whole)
        *notes = r.noted;
    fclose(from);
    return whole;
}

static void
what_is_cut_off_is_refused(void **state)
{
    struct rc_notes notes = {0};
    struct rc_grid *g = NULL;
    size_t n;
    char *bytes = sent_result(&n);

    (void)state;
    assert_true(receive(bytes, n, &g, &notes));
    check_good(g);
    assert_string_equal(notes.text[0], "worth saying");
    rc_grid_free(g);
    for (size_t cut = 1; cut < n; cut += cut < sizeof(struct rc_result) + 300 ? 1 : 9973) {
        assert_false(receive(bytes, cut, &g, &notes));
        assert_null(g);
    }
    free(bytes);
}

/* A child that a hostile file controls may send any bytes. */
static void
results_are_not_trusted(void **state)
{
    static const unsigned char nasty[] = {0, 1, 2, 0x7f, 0x80, 0xff};
    uint64_t seed = 0x9e3779b97f4a7c15;
    size_t n, taken = 0;
    char *bytes = sent_result(&n), *bad = malloc(n);

    (void)state;
    assert_non_null(bad);
    for (size_t t = 0; t < 3000; t++) {
        struct rc_notes notes = {0};
        struct rc_grid *g = NULL;

        memcpy(bad, bytes, n);
        for (size_t k = 0; k <= t % 3; k++) {
            seed ^= seed << 13;
            seed ^= seed >> 7;
            seed ^= seed << 17;
            bad[(seed >> 16) % (sizeof(struct rc_result) + 300)] = (char)nasty[seed % sizeof nasty];
        }
        if (receive(bad, n, &g, &notes)) {
            assert_true(notes.n <= sizeof notes.text / sizeof *notes.text);
            assert_true(g == NULL || (g->dx > 0 && g->dy > 0 && g->nx * g->ny <= 60000));
            taken++;
        }
        rc_grid_free(g);
    }
    printf("3000 results changed at random, %zu of them whole\n", taken);
    free(bad);
    free(bytes);
}

/* More nodes than allowed for the file are refused before memory is allocated. */
static void
a_grid_of_any_size_is_refused(void **state)
{
    static const char head[] = "RCG1\nchannel=height\nnx=1000000\nny=1000000\ndx=1e-06\ndy=1e-06\n"
                               "unit=m\ntype=f64\n\n";
    const struct rc_result r = {.n = 1};
    char bytes[sizeof r + sizeof head];
    struct rc_notes notes;
    struct rc_grid *g;

    (void)state;
    memcpy(bytes, &r, sizeof r);
    memcpy(bytes + sizeof r, head, sizeof head - 1);
    assert_false(receive(bytes, sizeof r + sizeof head - 1, &g, &notes));
    assert_null(g);
}

static bool
refused_for(rc_maps_find *find, const char *why)
{
    struct rc_notes notes = {0};
    struct rc_err err = {""};
    const struct rc_grid *g = read_apart(find, 0, &notes, &err);

    if (g == NULL && strstr(err.text, why) != NULL)
        return true;
    printf("refused for '%s', not for '%s'\n", err.text, why);
    fflush(stdout);
    return false;
}

static double
now(void)
{
    struct timespec ts;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &ts);
    return (double)ts.tv_sec + 1e-9 * (double)ts.tv_nsec;
}

/* All at the same time, because some of them wait for eight seconds: each in a process of its own. */
static void
trouble_stays_in_the_child(void **state)
{
    const bool filtered = rc_calls_can_be_filtered(); /* blocking is refused */
    const struct {
        rc_maps_find *find;
        const char *why;
    } troubles[] = {
        {refusing, "what is wrong: 7"},
        {crashing, "the library for this file failed (Aborted)"},
        {segfaulting, "the library for this file failed (Segmentation fault)"},
        {endless, "busy for more than 0.8 s"},
        {waiting, "busy for more than 0.8 s"},
        {stubborn,
         filtered ? "busy for more than 0.8 s" : "the library for this file failed (Killed)"},
        {filtered ? asleep : refusing, filtered ? "busy for more than 0.8 s" : "what is wrong: 7"},
        {nosy, "closed"},
    };
    enum {
        TROUBLES = sizeof troubles / sizeof *troubles
    };
    pid_t child[TROUBLES];

    (void)state;
    for (size_t k = 0; k < TROUBLES; k++) {
        fflush(NULL);
        child[k] = fork();
        assert_true(child[k] >= 0);
        if (child[k] == 0) {
            const double before = now();
            const bool right = refused_for(troubles[k].find, troubles[k].why);
            /* the limit of time was not exceeded by this project's code */
            _exit(right && now() - before < 0.5 ? 0 : 1);
        }
    }
    for (size_t k = 0; k < TROUBLES; k++) {
        int status;

        assert_int_equal(waitpid(child[k], &status, 0), child[k]);
        if (status != 0)
            fail_msg("not refused for '%s' in time", troubles[k].why);
    }
}

static void
memory_is_bounded(void **state)
{
    struct rc_notes notes = {0};
    struct rc_err err = {""};
    const char *said;

    (void)state;
    assert_null(read_apart(greedy, 0, &notes, &err));
    printf("%s\n", err.text);
    if ((said = strstr(err.text, "ended after ")) != NULL)
        assert_in_range(strtoul(said + 12, NULL, 10), 32, 64);
    else /* the address sanitizer may not return from it */
        assert_non_null(strstr(err.text, "its library"));
}

static enum rc_status
three(const struct rc_file *f, struct rc_maps *maps, struct rc_err *err)
{
    (void)f, (void)err;
    for (size_t k = 0; k < 3; k++) {
        struct rc_map *map = rc_maps_add(maps, rc_piece_of(""));

        strcpy(map->name, "c\033");
        strcpy(map->unit, "\302\233m");
        map->nx = k + 1;
        map->ny = 1;
        map->fill = fill_good;
    }
    return RC_OK;
}

static void
lists_come_back(void **state)
{
    struct rc_channel channel[2];
    struct rc_err err = {""};

    (void)state;
    assert_int_equal(list_apart(three, channel, &err), 3);
    assert_int_equal(channel[1].nx, 2);
    assert_string_equal(channel[1].name, "c "); /* no control characters */
    assert_string_equal(channel[1].unit, "  m");
    assert_int_equal(list_apart(refusing, channel, &err), 0);
    assert_string_equal(err.text, "what is wrong: 7");
    assert_int_equal(list_apart(crashing, channel, &err), 0);
    assert_non_null(strstr(err.text, "the library for this file failed"));
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_grid_comes_back_whole),
        cmocka_unit_test(what_is_cut_off_is_refused),
        cmocka_unit_test(results_are_not_trusted),
        cmocka_unit_test(a_grid_of_any_size_is_refused),
        cmocka_unit_test(trouble_stays_in_the_child),
        cmocka_unit_test(memory_is_bounded),
        cmocka_unit_test(lists_come_back),
        cmocka_unit_test(there_is_no_way_out),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
