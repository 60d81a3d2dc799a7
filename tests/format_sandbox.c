/* Whatever a reader does in the sandbox, the program gets a result or a reason, in bounded time and
 * memory. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "formats/sandbox/result.h"
#include "formats/sandbox/sandbox.h"

static const struct rc_file file = {.name = "made", .data = (const unsigned char *)"x", .size = 1};
static struct rc_grid *
good(const struct rc_file *f, const struct rc_wish *wish, size_t index, struct rc_notes *notes,
     struct rc_err *err)
{
    struct rc_shape shape = {.nx = 300, .ny = 200, .dx = 1.1e-6, .dy = 0.7e-6};
    struct rc_grid *g = rc_grid_new(&shape, "height", "m", err);

    assert_ptr_equal(f, &file);
    (void)wish;
    for (size_t k = 0; k < 60000; k++)
        g->v[k] = k % 7 == 0 ? NAN : 1e-9 * (double)(k + index);
    rc_grid_set(g, "file.date", "2024\n\xc2\xb5", err);
    rc_note(notes, "worth saying");
    return g;
}

static struct rc_grid *
refusing(const struct rc_file *f, const struct rc_wish *wish, size_t index, struct rc_notes *notes,
         struct rc_err *err)
{
    (void)f, (void)wish, (void)index, (void)notes;
    rc_err_set(err, "what is wrong: 7");
    return NULL;
}

static struct rc_grid *
crashing(const struct rc_file *f, const struct rc_wish *wish, size_t index, struct rc_notes *notes,
         struct rc_err *err)
{
    (void)f, (void)wish, (void)index, (void)notes, (void)err;
    abort();
}

/* cmocka catches this one: its handler must not run in the child. */
static struct rc_grid *
segfaulting(const struct rc_file *f, const struct rc_wish *wish, size_t index,
            struct rc_notes *notes, struct rc_err *err)
{
    (void)f, (void)wish, (void)index, (void)notes;
    raise(SIGSEGV);
    rc_err_set(err, "alive");
    return NULL;
}

static struct rc_grid *
endless(const struct rc_file *f, const struct rc_wish *wish, size_t index, struct rc_notes *notes,
        struct rc_err *err)
{
    volatile size_t k = 0;

    (void)f, (void)wish, (void)index, (void)notes, (void)err;
    for (;;)
        k++;
    return NULL;
}

static struct rc_grid *
waiting(const struct rc_file *f, const struct rc_wish *wish, size_t index, struct rc_notes *notes,
        struct rc_err *err)
{
    (void)f, (void)wish, (void)index, (void)notes, (void)err;
    for (;;)
        pause();
    return NULL;
}

static struct rc_grid *
greedy(const struct rc_file *f, const struct rc_wish *wish, size_t index, struct rc_notes *notes,
       struct rc_err *err)
{
    size_t got = 0;

    (void)f, (void)wish, (void)index, (void)notes;
    for (void *p; (p = malloc(1 << 20)) != NULL; got++)
        memset(p, 1, 1 << 20);
    rc_err_set(err, "memory ended after %zu MiB", got);
    return NULL;
}

static struct rc_grid *
nosy(const struct rc_file *f, const struct rc_wish *wish, size_t index, struct rc_notes *notes,
     struct rc_err *err)
{
    int fd = open("/etc/passwd", O_RDONLY);

    (void)f, (void)wish, (void)index, (void)notes;
    rc_err_set(err, fd < 0 ? "closed" : "open");
    return NULL;
}

static void
check_good(const struct rc_grid *g)
{
    assert_non_null(g);
    assert_true(g->nx == 300 && g->ny == 200 && g->dx == 1.1e-6 && g->dy == 0.7e-6);
    for (size_t k = 0; k < 60000; k++)
        assert_true(k % 7 == 0 ? g->v[k] != g->v[k] : g->v[k] == 1e-9 * (double)(k + 3));
    assert_string_equal(rc_grid_get(g, "file.date"), "2024\n\xc2\xb5");
}

static void
a_grid_comes_back_whole(void **state)
{
    struct rc_notes notes = {0};
    struct rc_err err = {""};
    struct rc_grid *g = rc_sandbox_read(good, &file, &rc_no_wish, 3, &notes, &err);

    (void)state;
    if (g == NULL)
        fail_msg("%s", err.text);
    check_good(g);
    assert_int_equal(notes.n, 1);
    assert_string_equal(notes.text[0], "worth saying");
    rc_grid_free(g);
}

/* The bytes by which a child sends the grid of good(), values included; the caller frees them. */
static char *
sent_result(size_t *n)
{
    struct rc_notes notes = {0};
    struct rc_err err = {""};
    struct rc_grid *g = good(&file, &rc_no_wish, 3, &notes, &err);
    struct rc_pipes pipes = {.child = -1};
    char *bytes = NULL;
    int end[2];

    assert_int_equal(socketpair(AF_UNIX, SOCK_STREAM, 0, end), 0);
    assert_int_equal(write(end[1], "\2", 1),
                     1); /* the reply: the values are wanted through the pipe */
    pipes.reply = end[0];
    assert_non_null(pipes.result = open_memstream(&bytes, n));
    assert_true(rc_result_send_grid(&pipes, g, &notes, &err));
    assert_int_equal(fclose(pipes.result), 0);
    close(end[0]);
    close(end[1]);
    rc_grid_free(g);
    return bytes;
}

/* Receives it from no child, so that there is no memory to copy from: through the pipe. */
static bool
receive(char *bytes, size_t n, struct rc_grid **g, struct rc_notes *notes)
{
    struct rc_pipes pipes = {.child = -1, .result = fmemopen(bytes, n, "rb")};
    struct rc_err said;
    int end[2];
    bool whole;

    assert_non_null(pipes.result);
    assert_int_equal(socketpair(AF_UNIX, SOCK_STREAM, 0, end), 0);
    pipes.reply = end[0];
    whole = rc_result_receive_grid(&pipes, &file, g, notes, &said);
    fclose(pipes.result);
    close(end[0]);
    close(end[1]);
    return whole;
}

static void
values_come_through_the_pipe_too(void **state)
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
    for (size_t cut = 1; cut < n; cut += cut < 6000 ? 1 : 9973) {
        assert_false(receive(bytes, cut, &g, &notes));
        g = NULL;
    }
    free(bytes);
}

/* A child that a file has got hold of may say anything. */
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
            bad[(seed >> 16) % 6000] = (char)nasty[seed % sizeof nasty];
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

static void
expect(rc_sandboxed_read *read, const char *why)
{
    struct rc_notes notes = {0};
    struct rc_err err = {""};

    assert_null(rc_sandbox_read(read, &file, &rc_no_wish, 0, &notes, &err));
    if (strstr(err.text, why) == NULL)
        fail_msg("refused for '%s', not for '%s'", err.text, why);
}

static double
now(void)
{
    struct timespec ts;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &ts);
    return (double)ts.tv_sec + 1e-9 * (double)ts.tv_nsec;
}

static void
trouble_stays_in_the_child(void **state)
{
    double before = now();

    (void)state;
    expect(refusing, "what is wrong: 7");
    expect(crashing, "makes its library fail (Aborted)");
    expect(segfaulting, "makes its library fail (Segmentation fault)");
    expect(endless, "busy for more than 0.8 s");
    expect(waiting, "busy for more than 0.8 s");
    expect(nosy, "closed");
    assert_true(now() - before < 0.5); /* the time was not ours */
}

static void
memory_is_bounded(void **state)
{
    struct rc_notes notes = {0};
    struct rc_err err = {""};
    const char *said;

    (void)state;
    assert_null(rc_sandbox_read(greedy, &file, &rc_no_wish, 0, &notes, &err));
    printf("%s\n", err.text);
    if ((said = strstr(err.text, "ended after ")) != NULL)
        assert_in_range(strtoul(said + 12, NULL, 10), 32, 64);
    else /* the address sanitizer may not come back from it */
        assert_non_null(strstr(err.text, "its library"));
}

static size_t
three(const struct rc_file *f, const struct rc_wish *wish, struct rc_channel *channel, size_t most,
      struct rc_err *err)
{
    (void)f, (void)wish, (void)err;
    for (size_t k = 0; k < 3 && k < most; k++)
        channel[k] = (struct rc_channel){.name = "c", .unit = "m", .nx = k + 1, .ny = 1};
    return 3;
}

static size_t
none(const struct rc_file *f, const struct rc_wish *wish, struct rc_channel *channel, size_t most,
     struct rc_err *err)
{
    (void)f, (void)wish, (void)channel, (void)most;
    rc_err_set(err, "no channel");
    return 0;
}

static size_t
crashing_list(const struct rc_file *f, const struct rc_wish *wish, struct rc_channel *channel,
              size_t most, struct rc_err *err)
{
    (void)f, (void)wish, (void)channel, (void)most, (void)err;
    abort();
}

static void
lists_come_back(void **state)
{
    struct rc_channel channel[2];
    struct rc_err err = {""};

    (void)state;
    assert_int_equal(rc_sandbox_list(three, &file, &rc_no_wish, channel, 2, &err), 3);
    assert_int_equal(channel[1].nx, 2);
    assert_int_equal(rc_sandbox_list(none, &file, &rc_no_wish, channel, 2, &err), 0);
    assert_string_equal(err.text, "no channel");
    assert_int_equal(rc_sandbox_list(crashing_list, &file, &rc_no_wish, channel, 2, &err), 0);
    assert_non_null(strstr(err.text, "makes its library fail"));
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_grid_comes_back_whole),
        cmocka_unit_test(values_come_through_the_pipe_too),
        cmocka_unit_test(results_are_not_trusted),
        cmocka_unit_test(trouble_stays_in_the_child),
        cmocka_unit_test(memory_is_bounded),
        cmocka_unit_test(lists_come_back),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
