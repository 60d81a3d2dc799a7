/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Paths: loads and forces, corner by corner. */
#include "slip.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double same_load = 1e-6; /* relative: a nearer load counts as the load of the stream */

/* ---- the command line ---- */

static const char apart[] = " ,\t";

/* Reads "LOAD,FX,FY", which may contain blanks. */
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
    return RC_OK;
}

/* `where`: the option and the place in it. */
static void
add_corner(struct slip_run *run, const struct slip_corner *c, const char *where)
{
    if (!(c->load >= 0) || isinf(c->load) || !isfinite(c->to[0]) || !isfinite(c->to[1]))
        tool_usage(&run->d.t, "%s: the load must be finite and not negative, forces finite", where);
    run->given =
        tool_grown(&run->d.t, run->given, run->givens, &run->room, sizeof *run->given, "a path");
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
    char part[256], where[300];

    while (*path != '\0') {
        size_t n = strcspn(path, ";");
        if (n >= sizeof part)
            tool_usage(&run->d.t, "--path %.40s...: it must be LOAD,FX,FY; ...", path);
        memcpy(part, path, n);
        part[n] = '\0';
        path += n + (path[n] == ';');
        if (blank(part))
            continue;
        if (read_corner(part, &c, &run->d.t.err) != RC_OK)
            tool_usage(&run->d.t, "--path %s: %s", part, run->d.t.err.text);
        snprintf(where, sizeof where, "--path %s", part);
        add_corner(run, &c, where);
    }
    if (run->givens == 0)
        tool_usage(&run->d.t, "--path: it must be LOAD,FX,FY; ..., as in 240N,36N,0");
}

static void
read_history(struct slip_run *run, const char *name)
{
    static const struct wanted_column wanted[] = {
        {.names = "load p fz normalload normalforce", .unit = UNIT_N},
        {.names = "fx forcex tangentialx", .unit = UNIT_N},
        {.names = "fy forcey tangentialy", .unit = UNIT_N},
    };
    struct columns c;
    char where[300];

    if (columns_read(&c, name, wanted, 3, false, &run->d.t.err) != RC_OK)
        tool_usage(&run->d.t, "--history %s: %s", name, run->d.t.err.text);
    for (size_t k = 0; k < c.n; k++) {
        const struct slip_corner corner = {.load = c.v[0][k], .to = {c.v[1][k], c.v[2][k]}};

        snprintf(where, sizeof where, "--history %.200s: line %zu", name, c.line[k]);
        add_corner(run, &corner, where);
    }
    columns_free(&c);
}

/* Writes the path in SI units into the history of the stream, from whichever option it came. */
static void
set_history(struct slip_run *run, struct slip_args *args)
{
    size_t most = run->givens * 3 * (RC_NUMBER_SIZE + 1) + 1, n = 0;
    char *text = tool_room(&run->d.t, most, 1, "a path"), number[3][RC_NUMBER_SIZE];

    for (size_t k = 0; k < run->givens; k++) {
        const struct slip_corner *c = &run->given[k];
        n += (size_t)snprintf(
            text + n, most - n, "%s%s,%s,%s", k == 0 ? "" : ";", rc_number_text(number[0], c->load),
            rc_number_text(number[1], c->to[0]), rc_number_text(number[2], c->to[1]));
    }
    args->path = text;
    for (size_t k = 0; k < run->d.t.option.n; k++) {
        const char *name = run->d.t.option.row[k].name;
        if (strcmp(name, "path") == 0 || strcmp(name, "history") == 0)
            run->d.t.option.given[k] = name[0] == 'p';
    }
}

void
slip_read_path(struct slip_run *run, struct slip_args *args)
{
    const struct numbers *along = args->tangential.n > 0 ? &args->tangential : &args->displacement;
    double n;
    struct rc_err err;

    if (along->n > 2)
        tool_usage(&run->d.t,
                   "--%s: it must be one value (along x) or two (x and y), as in %s: for several "
                   "steps take --path",
                   along == &args->tangential ? "tangential" : "displacement",
                   along == &args->tangential ? "36N,0" : "1um,0");
    if (args->increments != NULL && strcmp(args->increments, "auto") != 0) {
        if (unit_number(args->increments, UNIT_NONE, &n, &err) != RC_OK ||
            !(n >= 1 && n <= 1e6 && n == floor(n)))
            tool_usage(&run->d.t, "--increments %s: it must be auto or a number from 1 to 1000000",
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

/* ---- the path of a case ---- */

/* Makes the path under the load of the stream: press the bodies together, then move them. */
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

struct rc_point
slip_point(const struct slip_corner *c)
{
    struct rc_point p = {0};

    rc_point_set(&p, RC_LOAD, c->load);
    rc_point_set(&p, c->moved ? RC_DISPLACEMENT_X : RC_TANGENTIAL_X, c->to[0]);
    rc_point_set(&p, c->moved ? RC_DISPLACEMENT_Y : RC_TANGENTIAL_Y, c->to[1]);
    return p;
}

/* Returns the tolerance of an increment. It falls with their number, because their errors add up. */
static double
tolerance(const struct slip_run *run)
{
    static const double usual = 1e-4;
    size_t n = 0;

    for (size_t k = 0; k < run->corners; k++)
        n += run->corner[k].leg.increments;
    return (isnan(run->args->tol) ? usual : run->args->tol) / (double)n;
}

struct rc_friction_problem
slip_law(const struct slip_run *run)
{
    const struct slip_args *a = run->args;

    return (struct rc_friction_problem){.law = {.boundary = run->boundary,
                                                .pair = run->bodies.pair,
                                                .nu = run->bodies.nu,
                                                .mu = a->mu,
                                                .tau_max = isnan(a->tau_max) ? 0 : a->tau_max,
                                                .threads = run->d.t.threads},
                                        .coupling = run->coupling,
                                        .increments = run->increments,
                                        .dissipation = a->output >> SLIP_DISSIPATION & 1,
                                        .known_load = run->load,
                                        .known_p = run->p->v,
                                        .known_gap = run->gap == NULL ? NULL : run->gap->v};
}

/* Plans the leg to a corner, the further solutions that estimate its error, and whether contacts under other
 * loads must be solved. A leg from no load to a force needs the gap before contact. */
static void
plan_leg(struct slip_run *run, const struct slip_corner *from, struct slip_corner *to)
{
    const struct rc_point a = slip_point(from), b = slip_point(to);

    to->leg = rc_friction_leg(&run->law, &from->leg, &a, &b);
    if (to->leg.told != RC_TOLD_EXACT && to->leg.told != RC_TOLD_UNKNOWN)
        run->law.fewer = to->leg.late && run->law.fewer < RC_FEWER ? 1 : RC_FEWER;
    run->solves =
        run->solves || (to->load > 0 && to->load != run->load) ||
        (to->leg.increments > 1 && from->load != to->load) ||
        (from->load == 0 && to->load > 0 && hypot(to->to[0], to->to[1]) > 0 && run->given != NULL);
}

void
slip_plan_path(struct slip_run *run)
{
    static const struct slip_corner start = {0};

    run->coupled = run->bodies.beta != 0 && run->coupling != RC_COUPLING_NONE;
    run->alternates = run->bodies.beta != 0 && run->coupling == RC_COUPLING_FULL;
    run->solves = run->alternates;
    run->corners = 0;
    run->corner = tool_room(&run->d.t, run->givens + 2, sizeof *run->corner, "a path");
    if (run->given == NULL)
        press_and_move(run);
    for (size_t k = 0; k < run->givens; k++) {
        struct slip_corner c = run->given[k];
        if (fabs(c.load - run->load) <= same_load * run->load)
            c.load = run->load;
        run->corner[run->corners++] = c;
    }
    run->law = slip_law(run);
    for (size_t k = 0; k < run->corners; k++)
        plan_leg(run, k == 0 ? &start : &run->corner[k - 1], &run->corner[k]);
    run->law.law.tol = tolerance(run);
}
