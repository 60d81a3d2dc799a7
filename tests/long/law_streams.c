/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A hundred thousand frames take no more memory than a thousand, in every tool that passes frames on. A
 * profile of 2^31 + 9 nodes passes through them with every node at its place. So no index has 32 bits. */
#define _DEFAULT_SOURCE /* wait4 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "formats/core/core.h"
#include "formats/rcg/rcg.h"
#include "tests/exact.h"

enum {
    FEW = 1000,
    MANY = 100000,
    OUTPUT = 1 << 16 /* number of bytes of a tool's output that are kept */
};

/* The additional memory, in MiB, permitted for a hundred times as many frames. */
static const double growth_most = 1;

/* ---- a tool that reads the output of a function ---- */

struct ran {
    int status;
    double mib; /* the peak of its memory */
    char said[OUTPUT];
    size_t n; /* bytes of its messages */
};

typedef void producer(FILE *out, size_t n);

static pid_t
start_producer(producer *produce, size_t n, int to[2])
{
    pid_t child = fork();
    FILE *out;

    if (child != 0)
        return child;
    close(to[0]);
    signal(SIGPIPE, SIG_DFL);
    out = fdopen(to[1], "wb");
    produce(out, n);
    _exit(fclose(out) == 0 ? 0 : 1);
}

/* If memory becomes short the system must end this process, and no other process of the machine. */
static void
offer_to_kernel(void)
{
    FILE *f = fopen("/proc/self/oom_score_adj", "w");

    if (f == NULL)
        return;
    fputs("1000", f);
    fclose(f);
}

static pid_t
start_tool(const char *command, int from, int to)
{
    pid_t child = fork();

    if (child != 0)
        return child;
    offer_to_kernel();
    dup2(from, 0);
    dup2(to, 1);
    for (int fd = 3; fd < 64; fd++)
        close(fd);
    execl("/bin/sh", "sh", "-c", command, (char *)NULL);
    _exit(127);
}

/* Keeps the first bytes of a tool's output, and counts all of them. */
static void
run(struct ran *r, producer *produce, size_t n, const char *tool, const char *arguments)
{
    char command[1024], piece[1 << 16];
    struct rusage usage;
    int in[2], out[2], status;
    pid_t writer, reader;
    ssize_t got;

    snprintf(command, sizeof command, "exec %s/%s %s", getenv("RC_BIN"), tool, arguments);
    memset(r, 0, sizeof *r);
    assert_true(pipe(in) == 0 && pipe(out) == 0);
    fflush(NULL);
    writer = start_producer(produce, n, in);
    reader = start_tool(command, in[0], out[1]);
    assert_true(writer > 0 && reader > 0);
    close(in[0]), close(in[1]), close(out[1]);
    while ((got = read(out[0], piece, sizeof piece)) > 0) {
        if (r->n < OUTPUT - 1)
            memcpy(r->said + r->n, piece,
                   (size_t)got < OUTPUT - 1 - r->n ? (size_t)got : OUTPUT - 1 - r->n);
        r->n += (size_t)got;
    }
    close(out[0]);
    assert_int_equal(wait4(reader, &status, 0, &usage), reader);
    r->status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    r->mib = (double)usage.ru_maxrss / 1024;
    assert_int_equal(waitpid(writer, &status, 0), writer);
}

/* ---- many frames ---- */

static void
write_frames(FILE *out, size_t n)
{
    struct rc_shape shape = {12, 9, 1.1e-6, 1e-6};
    struct rc_grid *g = rc_grid_new(&shape, "height", "m", NULL);
    struct rc_writer *w = rc_writer_new(out, NULL);

    for (size_t k = 0; k < n; k++) {
        for (size_t i = 0; i < 108; i++)
            g->v[i] = 1e-9 * (double)((i * i + 7 * k) % 101);
        if (rc_grid_set_number(g, "case", (double)(k + 1), NULL) != RC_OK ||
            rc_writer_put(w, g, NULL) != RC_OK)
            _exit(1);
    }
    if (rc_writer_end(w, NULL) != RC_OK)
        _exit(1);
    rc_writer_free(w);
    rc_grid_free(g);
}

static void
frames_take_no_memory(void **state)
{
    static const struct {
        const char *tool, *arguments;
    } tools[] = {
        {"rc-info", "--json --areal"},
        {"rc-pick", "--crop 2,2,8,6 --mirror x"},
        {"rc-detrend", "--plane --lowpass 4um"},
        {"rc-solve", "--quiet --load 1mN --estar 1GPa --tol 1e-2 --output pressure"},
    };
    static struct ran few, many;

    (void)state;
    for (size_t k = 0; k < sizeof tools / sizeof *tools; k++) {
        size_t most = strcmp(tools[k].tool, "rc-solve") == 0 ? MANY / 10 : MANY; /* slow */

        run(&few, write_frames, FEW, tools[k].tool, tools[k].arguments);
        run(&many, write_frames, most, tools[k].tool, tools[k].arguments);
        printf("%s: %d frames %.1f MiB, %zu frames %.1f MiB\n", tools[k].tool, FEW, few.mib, most,
               many.mib);
        assert_int_equal(few.status, 0);
        assert_int_equal(many.status, 0);
        assert_true(many.n > most / FEW * 9 / 10 * few.n);
        (void)growth_most;
#if !defined(__SANITIZE_ADDRESS__) /* which holds freed memory */
        assert_true(many.mib < few.mib + growth_most);
#endif
    }
}

/* ---- 2^31 + 9 nodes ---- */

/* Zeros, except the last nine nodes, which are 1e-9, 2e-9, ... 9e-9 m; in f32. */
static void
write_profile(FILE *out, size_t n)
{
    static float zeros[1 << 16], last[9];
    char head[256];
    uint32_t crc;
    size_t left = n - 9;
    int length = snprintf(head, sizeof head,
                          "RCG1\nchannel=height\nnx=%zu\nny=1\ndx=1e-06\ndy=1e-06\nunit=m\n"
                          "type=f32\n\n",
                          n);

    for (size_t k = 0; k < 9; k++)
        last[k] = (float)(1e-9 * (double)(k + 1));
    crc = rc_crc32_add(0, head, (size_t)length);
    fwrite(head, 1, (size_t)length, out);
    while (left > 0) {
        size_t m = left < 1 << 16 ? left : 1 << 16;

        crc = rc_crc32_add(crc, zeros, m * sizeof *zeros);
        if (fwrite(zeros, sizeof *zeros, m, out) != m)
            _exit(1);
        left -= m;
    }
    crc = rc_crc32_add(crc, last, sizeof last);
    fwrite(last, sizeof *last, 9, out);
    fprintf(out, "crc32 %08" PRIx32 "\nRCGEND 1\n", crc);
}

static double
gib_available(void)
{
    FILE *f = fopen("/proc/meminfo", "r");
    char line[256];
    double kib = 0;

    while (f != NULL && fgets(line, sizeof line, f) != NULL)
        if (sscanf(line, "MemAvailable: %lf", &kib) == 1)
            break;
    if (f != NULL)
        fclose(f);
    return kib / (1 << 20);
}

static double
figure(const char *said, const char *name)
{
    const char *at = strstr(said, name);

    return at == NULL ? NAN : strtod(at + strlen(name), NULL);
}

static bool too_small; /* whether this machine is large enough for one of the tests */

static void
no_index_has_32_bits(void **state)
{
    const size_t n = ((size_t)1 << 31) + 9;
    static struct ran r;
    struct rc_grid *g;
    struct rc_reader *reader;
    FILE *f;

    (void)state;
    if (gib_available() < 18) {
        print_message("%.1f GiB are free, of 18 that 2^31 + 9 nodes take: not tried.\n",
                      gib_available());
        too_small = true;
        skip();
    }
    run(&r, write_profile, n, "rc-info", "--json");
    printf("rc-info of %zu nodes: %.1f MiB\n", n, r.mib);
    assert_int_equal(r.status, 0);
    assert_true(figure(r.said, "\"nx\": ") == (double)n);
    assert_true(figure(r.said, "\"minimum\": ") == 0);
    assert_true(figure(r.said, "\"maximum\": ") == (double)(float)9e-9);
    assert_true(fabs(figure(r.said, "\"mean\": ") * (double)n / 45e-9 - 1) < 1e-6);
    run(&r, write_profile, n, "rc-pick", "--crop 2147483646,0,11,1");
    assert_int_equal(r.status, 0);
    f = fmemopen(r.said, r.n, "rb");
    reader = rc_reader_new(f, 0, 0, NULL);
    assert_int_equal(rc_reader_next(reader, &g, NULL), RC_MORE);
    assert_int_equal(g->nx, 11);
    for (size_t k = 0; k < 11; k++)
        assert_true(g->v[k] == (k < 2 ? 0 : (double)(float)(1e-9 * (double)(k - 1))));
    rc_grid_free(g);
    rc_reader_free(reader);
    fclose(f);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_take_no_memory),
        cmocka_unit_test(no_index_has_32_bits),
    };

    int failed = cmocka_run_group_tests(tests, NULL, NULL);

    return failed == 0 && too_small ? 77
                                    : failed; /* the exit status that ctest counts as skipped */
}
