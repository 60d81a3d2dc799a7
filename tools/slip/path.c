/* Loads and forces, corner by corner, and in how many increments. */
#include "slip.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double same_load = 1e-6; /* relative: what is nearer to the stream's load is that */
static const double straight = 1e-9;

enum {
    LATE = 2,    /* increments of a straight way                                              */
    HALVED = 4,  /* so many, and half of them, tell the error                                 */
    TURNS = 8,   /* of a force that turns by a right angle                                    */
    PRESSES = 16 /* of a contact that grows or shrinks                                        */
};
/* Of a straight way: a node that slips carries against its whole slip of an increment, and not against how it
 * slips in the end. Most nodes have begun to slip by then, and what is left of the way sets them right. */
static const double late = 0.9;

/* ---- the command line ---- */

static const char apart[] = " ,\t";

/* "LOAD,FX,FY", also with blanks. */
static enum rc_status
read_corner(const char *text, struct slip_corner *c, struct rc_err *err)
{
    double *to[] = {&c->load, &c->to[0], &c->to[1]};
    char word[64];

    *c = (struct slip_corner){0};
    for (int k = 0; k < 3; k++) {
        size_t n;
        text += strspn(text, apart);
        n = strcspn(text, apart);
        if (n == 0 || n >= sizeof word)
            return rc_err_set(err, "it must be LOAD,FX,FY, as in 240N,36N,0");
        memcpy(word, text, n);
        word[n] = '\0';
        if (unit_number(word, UNIT_N, to[k], err) != RC_OK)
            return RC_FAIL;
        text += n;
    }
    if (text[strspn(text, apart)] != '\0')
        return rc_err_set(err, "it must be LOAD,FX,FY, as in 240N,36N,0");
    if (!(c->load >= 0) || isinf(c->load) || !isfinite(c->to[0]) || !isfinite(c->to[1]))
        return rc_err_set(err, "the load must be finite and not negative, forces finite");
    return RC_OK;
}

static void
add_corner(struct slip_run *run, const struct slip_corner *c)
{
    struct slip_corner *more = realloc(run->given, (run->givens + 1) * sizeof *more);

    if (more == NULL)
        tool_die(&run->t, EXIT_IMPOSSIBLE, "out of memory for a path");
    run->given = more;
    run->given[run->givens++] = *c;
}

static bool
blank(const char *s)
{
    return s[strspn(s, apart)] == '\0';
}

static void
read_path(struct slip_run *run, const char *path)
{
    struct slip_corner c;
    struct rc_err err;
    char part[256];

    while (*path != '\0') {
        size_t n = strcspn(path, ";");
        if (n >= sizeof part)
            tool_die(&run->t, EXIT_USAGE, "--path %.40s...: it must be LOAD,FX,FY; ...", path);
        memcpy(part, path, n);
        part[n] = '\0';
        path += n + (path[n] == ';');
        if (blank(part))
            continue;
        if (read_corner(part, &c, &err) != RC_OK)
            tool_die(&run->t, EXIT_USAGE, "--path %s: %s", part, err.text);
        add_corner(run, &c);
    }
    if (run->givens == 0)
        tool_die(&run->t, EXIT_USAGE, "--path: it must be LOAD,FX,FY; ..., as in 240N,36N,0");
}

/* Lines; '#' begins a comment, and a line of words at the top is a heading. */
static void
read_history(struct slip_run *run, const char *name)
{
    FILE *file = fopen(name, "r");
    struct slip_corner c;
    struct rc_err err;
    char line[512];
    size_t number = 0;

    if (file == NULL)
        tool_die(&run->t, EXIT_USAGE, "--history %s: %s", name, strerror(errno));
    while (fgets(line, sizeof line, file) != NULL) {
        number++;
        if (strchr(line, '\n') == NULL && !feof(file))
            tool_die(&run->t, EXIT_USAGE, "--history %s: line %zu is too long", name, number);
        line[strcspn(line, "#\r\n")] = '\0';
        if (blank(line) || (run->givens == 0 && strpbrk(line, "0123456789") == NULL))
            continue;
        if (read_corner(line, &c, &err) != RC_OK)
            tool_die(&run->t, EXIT_USAGE, "--history %s: line %zu: %s", name, number, err.text);
        add_corner(run, &c);
    }
    if (ferror(file))
        tool_die(&run->t, EXIT_USAGE, "--history %s: %s", name, strerror(errno));
    fclose(file);
    if (run->givens == 0)
        tool_die(&run->t, EXIT_USAGE,
                 "--history %s: it holds no line of load, force along x and force along y", name);
}

/* In a stream's history the path stands in SI, wherever it came from. */
static void
set_history(struct slip_run *run, struct slip_args *args)
{
    size_t most = run->givens * 3 * (RC_NUMBER_SIZE + 1) + 1, n = 0;
    char *text = malloc(most), number[3][RC_NUMBER_SIZE];

    if (text == NULL)
        tool_die(&run->t, EXIT_IMPOSSIBLE, "out of memory for a path");
    for (size_t k = 0; k < run->givens; k++) {
        const struct slip_corner *c = &run->given[k];
        n += (size_t)snprintf(
            text + n, most - n, "%s%s,%s,%s", k == 0 ? "" : ";", rc_number_text(number[0], c->load),
            rc_number_text(number[1], c->to[0]), rc_number_text(number[2], c->to[1]));
    }
    args->path = text;
    for (size_t k = 0; k < run->t.opts; k++)
        if (strcmp(run->t.opt[k].name, "path") == 0)
            run->t.given[k] = true;
}

void
slip_read_path(struct slip_run *run, struct slip_args *args)
{
    double n;
    struct rc_err err;

    if (args->increments != NULL && strcmp(args->increments, "auto") != 0) {
        if (unit_number(args->increments, UNIT_NONE, &n, &err) != RC_OK ||
            !(n >= 1 && n <= 1e6 && n == floor(n)))
            tool_die(&run->t, EXIT_USAGE,
                     "--increments %s: it must be auto or a number from 1 to 1000000",
                     args->increments);
        run->increments = (size_t)n;
    }
    if (args->path != NULL)
        read_path(run, args->path);
    if (args->history != NULL)
        read_history(run, args->history);
    if (run->givens > 0)
        set_history(run, args);
}

/* ---- of a case ---- */

/* Sine of the angle by which the way turns; 0: there is none. */
static double
turn(const struct slip_corner *from, const struct slip_corner *to)
{
    double before = hypot(from->to[0], from->to[1]);
    double d[2] = {to->to[0] - from->to[0], to->to[1] - from->to[1]}, length = hypot(d[0], d[1]);

    if (!(before > 0) || !(length > 0) || from->moved != to->moved)
        return 0;
    return fabs(from->to[0] * d[1] - from->to[1] * d[0]) / (before * length);
}

static bool
force_changes(const struct slip_corner *from, const struct slip_corner *to)
{
    double most = fmax(hypot(from->to[0], from->to[1]), hypot(to->to[0], to->to[1]));

    return to->moved != from->moved ||
           hypot(to->to[0] - from->to[0], to->to[1] - from->to[1]) > straight * most;
}

/* Whether one increment is exact: bodies alike with nu = 0, on which all slips along one line, along which
 * all forces have been. */
static bool
exact(const struct slip_run *run, const struct slip_corner *from, const struct slip_corner *to)
{
    bool grows = to->load > from->load * (1 + straight), capped = !isnan(run->args->tau_max);
    bool aside = fabs(from->to[0] * to->to[1] - from->to[1] * to->to[0]) >
                 straight * hypot(from->to[0], from->to[1]) * hypot(to->to[0], to->to[1]);

    return !run->coupled && run->bodies.kap == 0 && !aside &&
           (from->moved == to->moved || !(hypot(from->to[0], from->to[1]) > 0)) &&
           (!grows || !(to->moved || capped)) && (from->told == SLIP_EXACT || from->load == 0);
}

/* Increments, and what will be known of them: one where that is exact, two where load and line of the force
 * stay, more where the force turns or the load changes. */
static void
set_increments(const struct slip_run *run, const struct slip_corner *from, struct slip_corner *to)
{
    bool grows = to->load > from->load * (1 + straight), moves = force_changes(from, to);
    bool falls = to->load < from->load * (1 - straight);
    enum slip_told before = from->load > 0 ? from->told : SLIP_EXACT;
    double angle = turn(from, to);
    size_t n = 1;

    to->carries =
        run->coupled || hypot(to->to[0], to->to[1]) > 0 || (from->load > 0 && from->carries);
    to->told = before;
    to->increments = 1;
    if (!to->carries || to->load == 0 || (!grows && !falls && !moves)) {
        to->increments = run->coupled && run->increments > 0 ? run->increments : 1;
        to->late = to->increments == 1;
        return;
    }
    if (exact(run, from, to)) {
        to->increments = run->increments > 0 ? run->increments : 1;
        return;
    }
    if (run->increments > 0)
        n = run->increments;
    else if (grows || falls)
        n = PRESSES;
    else if (angle > straight)
        while (n < TURNS && ((double)n < TURNS * angle * (1 - straight) || n < HALVED))
            n *= 2;
    else
        n = LATE;
    to->increments = n;
    to->late = n == LATE && run->increments == 0;
    if (n < (grows || falls ? TURNS : HALVED) && !to->late)
        to->told = SLIP_UNKNOWN;
    else if (grows && !run->coupled)
        to->told = n >= PRESSES ? SLIP_SOME : SLIP_FEW;
    else if (grows || falls)
        to->told = n >= PRESSES && run->coupled ? SLIP_MANY : n >= TURNS ? SLIP_SOME : SLIP_FEW;
    else
        to->told = to->late ? SLIP_SOME : n >= TURNS ? SLIP_MANY : SLIP_FEW;
    if (before > to->told)
        to->told = before;
}

size_t
slip_fewer(size_t n, size_t joint)
{
    n >>= joint;
    return n > 0 ? n : 1;
}

size_t
slip_all_increments(const struct slip_run *run)
{
    size_t n = 0;

    for (size_t k = 0; k < run->corners; k++)
        n += run->corner[k].increments;
    return n;
}

static const struct slip_corner start = {0};

static const struct slip_corner *
before(const struct slip_run *run, size_t k)
{
    return k == 0 ? &start : &run->corner[k - 1];
}

/* Under the load of the stream: pressed, and then moved. */
static void
press_and_move(struct slip_run *run)
{
    const struct slip_args *a = run->args;
    bool moved = a->displacement.n > 0;
    const struct numbers *to = moved ? &a->displacement : &a->tangential;
    struct slip_corner c = {.load = run->load, .moved = moved};

    for (size_t k = 0; k < to->n; k++)
        c.to[k] = to->v[k];
    run->corner[run->corners++] = (struct slip_corner){.load = run->load, .silent = !run->coupled};
    if (run->coupled && !moved && !(hypot(c.to[0], c.to[1]) > 0))
        return;
    run->corner[run->corners++] = c;
}

void
slip_plan_path(struct slip_run *run)
{
    run->coupled = run->bodies.beta != 0 && run->coupling != RC_COUPLING_NONE;
    run->alternates = run->bodies.beta != 0 && run->coupling == RC_COUPLING_FULL;
    run->solves = run->alternates;
    run->joints = 1;
    run->corners = 0;
    run->corner = malloc((run->givens + 2) * sizeof *run->corner);
    if (run->corner == NULL)
        tool_die(&run->t, EXIT_IMPOSSIBLE, "out of memory for a path");
    if (run->given == NULL)
        press_and_move(run);
    for (size_t k = 0; k < run->givens; k++) {
        struct slip_corner c = run->given[k];
        if (fabs(c.load - run->load) <= same_load * run->load)
            c.load = run->load;
        run->corner[run->corners++] = c;
    }
    for (size_t k = 0; k < run->corners; k++) {
        const struct slip_corner *from = before(run, k);
        struct slip_corner *to = &run->corner[k];
        set_increments(run, from, to);
        if (to->told != SLIP_EXACT && to->told != SLIP_UNKNOWN)
            run->joints = to->late && run->joints < SLIP_JOINTS ? 2 : SLIP_JOINTS;
        /* other loads than the stream's; or from no load to a force, where the first gap counts */
        for (size_t i = 1; i <= to->increments; i++) {
            double load = slip_on_the_way(run, k, i, to->increments).load;
            run->solves = run->solves || (load > 0 && load != run->load);
        }
        run->solves = run->solves || (from->load == 0 && to->load > 0 && force_changes(from, to) &&
                                      run->given != NULL);
    }
}

/* A point on the straight line. Where the load falls, the increments become shorter towards the end: many
 * nodes begin to slip late, and the traction of a node points against its slip in the last increment. */
struct slip_corner
slip_on_the_way(const struct slip_run *run, size_t corner, size_t k, size_t n)
{
    const struct slip_corner *from = before(run, corner), *to = &run->corner[corner];
    struct slip_corner c = *to;
    double part = to->late ? late : (double)k / (double)n;

    if (to->load < from->load * (1 - straight))
        part = 1 - (1 - part) * (1 - part);
    if (k == n)
        return c;
    c.load = from->load + part * (to->load - from->load);
    for (int i = 0; i < 2; i++)
        c.to[i] = from->moved == to->moved ? from->to[i] + part * (to->to[i] - from->to[i])
                                           : part * to->to[i];
    return c;
}
