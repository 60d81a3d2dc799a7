#include "cage.h"

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include "values.h"

static const double seconds_least = 0.8, bytes_a_second = 1e7;
static const double patience = 10; /* times those, by the clock on the wall: nothing may just wait */

enum {
    TEXT_MOST = 65536, /* bytes of a key's value */
    KEYS_MOST = 256,
};

static bool left_open;

void
rc_cage_leave_open(bool open)
{
    left_open = open;
}

/* ---- the child ---- */

static double
time_bound(const struct rc_file *file)
{
    return seconds_least + (double)file->size / bytes_a_second;
}

/* Address space that the process has already; 0 where the system does not tell. */
static size_t
space_now(void)
{
    unsigned long pages = 0;
    FILE *f = fopen("/proc/self/statm", "r");

    if (f == NULL)
        return 0;
    if (fscanf(f, "%lu", &pages) != 1)
        pages = 0;
    fclose(f);
    return pages * (size_t)sysconf(_SC_PAGESIZE);
}

static void
limit(int what, rlim_t most)
{
    struct rlimit r;

    if (getrlimit(what, &r) != 0)
        return;
    if (r.rlim_max != RLIM_INFINITY && r.rlim_max < most)
        most = r.rlim_max;
    r.rlim_cur = r.rlim_max = most;
    setrlimit(what, &r);
}

static void
ring_after(int which, double seconds)
{
    struct itimerval timer = {{0, 0}, {0, 0}};
    double whole;

    timer.it_value.tv_usec = (suseconds_t)(1e6 * modf(seconds, &whole));
    timer.it_value.tv_sec = (time_t)whole;
    setitimer(which, &timer, NULL);
}

static void
shut(const struct rc_file *file)
{
    size_t space = space_now();

    signal(SIGPROF, SIG_DFL);
    signal(SIGALRM, SIG_DFL);
    signal(SIGINT, SIG_DFL); /* what is half-written is the parent's business */
    signal(SIGTERM, SIG_DFL);
    signal(SIGHUP, SIG_DFL);
    signal(SIGPIPE, SIG_DFL);
    ring_after(ITIMER_PROF, time_bound(file));
    ring_after(ITIMER_REAL, patience * time_bound(file));
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, 0);
    limit(RLIMIT_NOFILE, 0); /* no further one: a file cannot name others to be read */
    if (space > 0)
        limit(RLIMIT_AS, (rlim_t)(space + rc_memory_bound(file)));
}

/* ---- there and back ---- */

struct cage {
    pid_t child;
    FILE *pipe;
};

/* In the child it gives 0 and a pipe to write to, in the parent 1 and one to read from. */
static int
divide(struct cage *cage, const struct rc_file *file, struct rc_err *err)
{
    int end[2];

    if (pipe(end) != 0) {
        rc_err_set(err, "no pipe for reading the file: %s", strerror(errno));
        return -1;
    }
    if ((cage->child = fork()) < 0) {
        rc_err_set(err, "no process for reading the file: %s", strerror(errno));
        close(end[0]);
        close(end[1]);
        return -1;
    }
    if (cage->child == 0) {
        close(end[0]);
        if ((cage->pipe = fdopen(end[1], "wb")) == NULL)
            _exit(1);
        shut(file);
        return 0;
    }
    close(end[1]);
    if ((cage->pipe = fdopen(end[0], "rb")) == NULL) {
        close(end[0]);
        kill(cage->child, SIGKILL);
        waitpid(cage->child, NULL, 0);
        rc_err_set(err, "out of memory for a pipe");
        return -1;
    }
    return 1;
}

static _Noreturn void
leave(struct cage *cage)
{
    _exit(fflush(cage->pipe) == 0 ? 0 : 1);
}

/* Ends the child; when its answer was not whole, says why in place of what was said before. */
static void
join(struct cage *cage, const struct rc_file *file, bool whole, struct rc_err *err)
{
    int how = 0;
    pid_t got;

    fclose(cage->pipe);
    while ((got = waitpid(cage->child, &how, 0)) < 0 && errno == EINTR)
        continue;
    if (whole)
        return;
    if (got == cage->child && WIFSIGNALED(how) &&
        (WTERMSIG(how) == SIGPROF || WTERMSIG(how) == SIGALRM))
        rc_err_set(err, "the file keeps its library busy for more than %.1f s: it is damaged, or "
                        "made to", time_bound(file));
    else if (got == cage->child && WIFSIGNALED(how))
        rc_err_set(err, "the file makes its library fail (%s): it is damaged, or made to",
                   strsignal(WTERMSIG(how)));
    else
        rc_err_set(err, "the file makes its library fail: it is damaged, or needs more than the "
                        "%zu MiB that %zu bytes may take", rc_memory_bound(file) >> 20, file->size);
}

size_t
rc_cage_list(rc_list_in_cage *list, const struct rc_file *file, const struct rc_wish *wish,
             struct rc_channel *channel, size_t most, struct rc_err *err)
{
    struct rc_err said = {""};
    struct cage cage;
    size_t n = 0, shown;
    int side;
    bool whole;

    if (left_open)
        return list(file, wish, channel, most, err);
    if ((side = divide(&cage, file, err)) < 0)
        return 0;
    if (side == 0) {
        n = list(file, wish, channel, most, &said);
        fwrite(&n, sizeof n, 1, cage.pipe);
        fwrite(&said, sizeof said, 1, cage.pipe);
        fwrite(channel, sizeof *channel, n < most ? n : most, cage.pipe);
        leave(&cage);
    }
    whole = fread(&n, sizeof n, 1, cage.pipe) == 1 && fread(&said, sizeof said, 1, cage.pipe) == 1;
    shown = n < most ? n : most;
    whole = whole && fread(channel, sizeof *channel, shown, cage.pipe) == shown;
    said.text[sizeof said.text - 1] = '\0';
    if (whole && n == 0)
        rc_err_set(err, "%s", said.text);
    for (size_t k = 0; whole && k < shown; k++) {
        channel[k].name[sizeof channel->name - 1] = '\0';
        channel[k].unit[sizeof channel->unit - 1] = '\0';
    }
    join(&cage, file, whole, err);
    return whole ? n : 0;
}

/* A text as its length and its bytes. */
static bool
send_text(FILE *to, const char *text)
{
    size_t n = strlen(text);

    return fwrite(&n, sizeof n, 1, to) == 1 && fwrite(text, 1, n, to) == n;
}

static char *
receive_text(FILE *from)
{
    char *text = NULL;
    size_t n;

    if (fread(&n, sizeof n, 1, from) != 1 || n >= TEXT_MOST || (text = malloc(n + 1)) == NULL)
        return NULL;
    text[n] = '\0';
    if (fread(text, 1, n, from) == n)
        return text;
    free(text);
    return NULL;
}

static void
send_grid(FILE *to, const struct rc_grid *g)
{
    struct rc_shape shape = rc_grid_shape(g);
    bool good = fwrite(&shape, sizeof shape, 1, to) == 1 && send_text(to, g->channel) &&
                send_text(to, g->unit) && fwrite(&g->keys, sizeof g->keys, 1, to) == 1;

    for (size_t k = 0; good && k < g->keys; k++)
        good = send_text(to, g->key[k].name) && send_text(to, g->key[k].value);
    if (!good || fwrite(g->v, sizeof *g->v, g->nx * g->ny, to) != g->nx * g->ny)
        _exit(1);
}

static bool
receive_key(FILE *from, struct rc_grid *g)
{
    char *name = receive_text(from), *value = name == NULL ? NULL : receive_text(from);
    bool good = value != NULL && rc_grid_set(g, name, value, NULL) == RC_OK;

    free(name);
    free(value);
    return good;
}

/* What was read by a library that a file may have got hold of is not trusted either. */
static struct rc_grid *
receive_grid(FILE *from, const struct rc_file *file)
{
    char *channel = NULL, *unit = NULL;
    struct rc_grid *g = NULL;
    struct rc_shape shape;
    bool good = false;
    size_t keys;

    if (fread(&shape, sizeof shape, 1, from) != 1 ||
        rc_map_fits(file, shape.nx, shape.ny, NULL) != RC_OK ||
        (channel = receive_text(from)) == NULL || (unit = receive_text(from)) == NULL ||
        fread(&keys, sizeof keys, 1, from) != 1 || keys > KEYS_MOST ||
        (g = rc_grid_new(&shape, channel, unit, NULL)) == NULL)
        goto done;
    for (good = true; good && keys > 0; keys--)
        good = receive_key(from, g);
    good = good && fread(g->v, sizeof *g->v, g->nx * g->ny, from) == g->nx * g->ny;
done:
    free(channel);
    free(unit);
    if (good)
        return g;
    rc_grid_free(g);
    return NULL;
}

struct rc_grid *
rc_cage_read(rc_read_in_cage *read, const struct rc_file *file, const struct rc_wish *wish,
             size_t index, struct rc_notes *notes, struct rc_err *err)
{
    struct rc_notes noted = {0};
    struct rc_err said = {""};
    struct rc_grid *g = NULL;
    struct cage cage;
    int side;
    bool whole, good;

    if (left_open)
        return read(file, wish, index, notes, err);
    if ((side = divide(&cage, file, err)) < 0)
        return NULL;
    if (side == 0) {
        good = (g = read(file, wish, index, &noted, &said)) != NULL;
        fwrite(&good, sizeof good, 1, cage.pipe);
        fwrite(&noted, sizeof noted, 1, cage.pipe);
        fwrite(&said, sizeof said, 1, cage.pipe);
        if (good)
            send_grid(cage.pipe, g);
        leave(&cage);
    }
    whole = fread(&good, sizeof good, 1, cage.pipe) == 1 &&
            fread(&noted, sizeof noted, 1, cage.pipe) == 1 &&
            fread(&said, sizeof said, 1, cage.pipe) == 1;
    said.text[sizeof said.text - 1] = '\0';
    if (whole && good)
        whole = (g = receive_grid(cage.pipe, file)) != NULL;
    for (size_t k = 0; whole && k < noted.n && k < sizeof noted.text / sizeof *noted.text; k++)
        rc_note(notes, "%.*s", (int)sizeof *noted.text - 1, noted.text[k]);
    if (whole && !good)
        rc_err_set(err, "%s", said.text);
    join(&cage, file, whole, err);
    return g;
}
