/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Wear of the contact that rc-solve has found: how heights and pressures change as the bodies slide. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"
#include "tools/frames/frames.h"
#include "tools/model/model.h"
#include "tools/problem/problem.h"

static struct args {
    const char *coefficient, *energy, *motion, *counter, *until, *steps;
    struct numbers archard, distance, cycles, load; /* load: of the stream */
    double hardness, mu, tol;
    size_t output;
    struct drive_args drive;
} args = {.hardness = NAN, .mu = NAN, .tol = 0.1, .output = 15, .drive.interval = 60};

static const char *const frames[] = {"pressure", "gap",          "height",  "wear", "wear-1",
                                     "wear-2",   "displacement", "contact", NULL};

#define AT(field) .at = offsetof(struct args, field)
#define ABOVE_0 .min = 0, .max = INFINITY, .above = true
/* clang-format off */
static const struct opt opts[] = {
    {.name = "coefficient", .type = OPT_TEXT, AT(coefficient), .result = true, .arg = "K1[,K2]",
     .help = "wear coefficient of body 1, and of body 2 (default 0), in mm3/Nm, m2/N or 1/GPa"},
    {.name = "archard", .type = OPT_NUMBERS, AT(archard), .min = 0, .max = INFINITY, .result = true,
     .arg = "K1[,K2]",
     .needs = RULES({.with = "hardness", .because = "V = K P s/H"}),
     .against = RULES({.with = "coefficient", .because = "each says how much wears"}),
     .help = "instead: Archard's numbers, V = K P s/H, no factor 3"},
    {.name = "hardness", .type = OPT_NUMBER, .unit = UNIT_HARD, AT(hardness), ABOVE_0, .result = true,
     .arg = "PRESSURE",
     .needs = RULES({.with = "archard", .because = "V = K P s/H"}),
     .help = "H of --archard; 600HV is 600 times 9.80665 MPa. The bound of the pressure is that of rc-solve"},
    {.name = "energy", .type = OPT_TEXT, AT(energy), .result = true, .arg = "K1[,K2]",
     .needs = RULES({.with = "mu|cycles",
                     .because = "the energy is mu P s, or with --cycles the frame dissipation "
                                                    "of rc-slip --output height,dissipation"}),
     .against = RULES({.with = "coefficient|archard", .because = "each says how much wears"}),
     .help = "instead: volume per energy of friction, in mm3/J or m3/J: of --mu, or of the frame "
             "dissipation"},
    {.name = "mu", .type = OPT_NUMBER, AT(mu), ABOVE_0, .result = true, .arg = "COEFFICIENT",
     .needs = RULES({.with = "energy", .because = "the energy is mu P s"}),
     .help = "coefficient of friction of --energy"},
    {.name = "distance", .type = OPT_NUMBERS, .unit = UNIT_M, AT(distance), .min = 0, .max = INFINITY,
     .result = true, .arg = "LIST",
     .one_of = RULES({.with = "distance|cycles", .remedy = "as in --distance 1m,10m"}),
     .help = "sliding distances from the start, each a case"},
    {.name = "cycles", .type = OPT_NUMBERS, AT(cycles), .min = 0, .max = INFINITY, .result = true,
     .arg = "LIST",
       .help = "instead: numbers of cycles or passes, with a frame slip or dissipation of rc-slip"},
    {.name = "motion", .type = OPT_TEXT, AT(motion), .result = true, .arg = "same|track:LENGTH|sliding",
     .needs = RULES({.with = "counter", .word = "sliding", .because = "body 2 needs a surface"}),
     .against = RULES({.with = "cycles", .word = "track|sliding",
                       .because = "in a cycle of fretting the same points stay in contact"},
                      {.with = "until", .word = "sliding", .because = "it is not implemented"}),
     .help = "the same points stay in contact (default), body 2 passes along x on a track of this length, "
             "or two rough bodies slide over each other"},
    {.name = "counter", .type = OPT_TEXT, AT(counter), .result = true, .arg = "FILE",
     .needs = RULES({.with = "motion sliding"}),
     .help = "heights of body 2, seen from outside as those of body 1"},
    {.name = "until", .type = OPT_TEXT, AT(until), .result = true, .arg = "LIST",
     .help = "end earlier at area=FRACTION in contact or area=Nx, depth=LENGTH or uniform=SPREAD"},
    {.name = "tol", .type = OPT_NUMBER, AT(tol), .min = 0, .max = 0.5, .above = true, .result = true,
     .arg = "ERROR", .help = "bound of the estimated relative errors of wear and pressure (default 0.1)"},
    {.name = "output", .type = OPT_WORDS, AT(output), .list = frames, .arg = "LIST",
     .help = "frames to write, of %s (default: the first four, and wear-1 and wear-2 if both wear)"},
    {.name = "steps", .type = OPT_REPORT, AT(steps), .arg = "FILE",
     .help = "write the figures of every step, the running-in curve, as --report does"},
    {.group = drive_options, AT(drive)},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-wear",
    .summary = "Wear and running-in: heights and pressures as the bodies slide",
    .operands = "[FILE...]",
    .examples =
        "  rc-solve --load 10N --radius 3mm --estar 114GPa surface.rcg |\n"
        "      rc-wear --coefficient 1e-6mm3/Nm --distance 1m:1km:log:4 \\\n"
        "          --report worn.tsv --steps running-in.tsv -o worn.rcg\n"
        "  rc-render --curve distance:contact_fraction --log x -o curve.png running-in.tsv\n",
    .opts = opts,
    .figures = (const char *const[]){"contact", "elastic", "wear", NULL},
    .reads = READS_STREAM,
    .writes = WRITES_STREAM,
    .shares = true,
};

enum { /* frames beside the heights */
    COEFFICIENT,
    HARD,
    SLIP,
    ENERGY,
    PRESSURE,
    MAPS
};

struct run {
    struct drive d;
    struct rc_wear_problem law;
    struct report steps;
    double coat;                /* m: least thickness left of the top layer before wear; 0: none */
    double left;                /* m: the same at the present point; below 0: worn through */
    double relief;              /* m: from the lowest to the highest node before wear */
    double area, depth, spread; /* of --until, at the last point                      */
    double area_times;          /* of --until area=Nx: over the first contact area; 0: not given */
    size_t written;             /* steps at the last row of --steps      */
    double slid;                /* m: distance of that row               */
    const struct numbers *list; /* of distances or cycles                              */
    double path;                /* m: of the node that slips most in a cycle; 1: none */
    double k[2];                /* 1/Pa: of the options                                */
    struct rc_grid *map[MAPS];  /* of the case; NULL: none                             */
    struct tool_frame beside[MAPS + 1]; /* their channels */
    struct tool_frame maps[MAPS + 2];   /* and body 2     */
    double *part;                       /* k of each node over the largest one; NULL: 1        */
    double *energy;                     /* J/m2, of a cycle at each node; NULL: not given      */
    struct rc_grid *counter;            /* heights of body 2; NULL: smooth                     */
};

/* ---- the command line ---- */

static void
read_coefficients(struct tool *t, const char *name, const char *text, enum unit unit,
                  const char *why)
{
    double *k = ((struct run *)(void *)t)->k;
    struct numbers list;

    if (unit_numbers(text, unit, &list, &t->err) != RC_OK || list.n > 2 ||
        !(list.v[0] >= 0 && list.v[list.n - 1] >= 0))
        tool_usage(t, "--%s %s: it must be K1 or K1,K2, each at least 0 %s", name, text, why);
    memcpy(k, list.v, list.n * sizeof *k);
    free(list.v);
}

static bool
any_law(const struct tool *t)
{
    return tool_given(t, "coefficient") || tool_given(t, "archard") || tool_given(t, "energy");
}

static void
read_law(struct run *run)
{
    struct tool *t = &run->d.t;
    double *k = run->k;

    if (args.coefficient != NULL)
        read_coefficients(t, "coefficient", args.coefficient, UNIT_WEAR,
                          "with its unit, as in 1e-6mm3/Nm, m2/N or 1/GPa: a number without a unit "
                          "is often Archard's, which is given by --archard and --hardness");
    if (args.energy != NULL)
        read_coefficients(t, "energy", args.energy, UNIT_WEAR_ENERGY,
                          "with its unit, as in 1e-5mm3/J");
    if (args.archard.n > 2)
        tool_usage(t, "--archard: it must be K1 or K1,K2");
    if (t->vickers != NULL) {
        args.hardness = unit_vickers_on_faces(args.hardness);
        tool_warn(t,
                  "--hardness %s is %s: H of Archard's law is HV times 9.80665 MPa, as tables of K "
                  "take it; rc-solve --hardness takes this over sin 68 deg",
                  t->vickers, shown_in_unit(args.hardness, "Pa"));
    }
    for (size_t b = 0; b < 2; b++) {
        if (b < args.archard.n)
            k[b] = args.archard.v[b] / args.hardness;
        if (args.energy != NULL && !isnan(args.mu))
            k[b] *= args.mu;
    }
    if (!any_law(t))
        return; /* the frame wear-coefficient has it */
    if (k[0] + k[1] == 0)
        tool_usage(t, "no body wears: give a wear coefficient above 0");
    if (k[0] > 0 && k[1] > 0 && !tool_given(t, "output"))
        args.output |= 48;
}

static void
read_motion(struct run *run)
{
    const char *text = args.motion != NULL ? args.motion : "same";
    const bool track = strncmp(text, "track:", 6) == 0;
    struct rc_wear_problem *law = &run->law;
    struct tool *t = &run->d.t;
    struct rc_err err;

    law->two_bodies = strcmp(text, "sliding") == 0;
    if ((track || (!law->two_bodies && strcmp(text, "same") != 0)) &&
        (!track || unit_number(text + 6, UNIT_M, &law->track, &err) != RC_OK || !(law->track > 0) ||
         isinf(law->track)))
        tool_usage(
            t,
            "--motion %s: it must be same, sliding or track:LENGTH, with a length above 0, as "
            "in track:60mm",
            text);
    if (law->two_bodies)
        run->counter = physics_counter(t, args.counter);
}

/* area=2x, a factor of the first contact area. */
static bool
read_times(struct run *run, const char *word)
{
    char *end = NULL;

    run->area_times = strncmp(word, "area=", 5) == 0 ? strtod(word + 5, &end) : 0;
    if (end == NULL || end == word + 5 || strcmp(end, "x") != 0)
        run->area_times = 0;
    return run->area_times > 1 && isfinite(run->area_times);
}

static void
read_until(struct run *run)
{
    static const char *const name[] = {"area", "depth", "uniform"};
    double *to[] = {&run->law.until_area, &run->law.until_depth, &run->law.until_spread};
    char text[256], *at = NULL, *word;
    struct rc_err err;

    if (args.until == NULL)
        return;
    snprintf(text, sizeof text, "%s", args.until);
    for (word = strtok_r(text, ",", &at); word != NULL; word = strtok_r(NULL, ",", &at)) {
        size_t k = 0, n = strcspn(word, "=");
        if (read_times(run, word))
            continue;
        while (k < 3 && (strlen(name[k]) != n || strncmp(word, name[k], n) != 0))
            k++;
        if (k == 3 || word[n] == '\0' ||
            unit_number(word + n + 1, k == 1 ? UNIT_M : UNIT_CREEP, to[k], &err) != RC_OK ||
            !(*to[k] > 0) || (k == 0 && *to[k] > 1))
            tool_usage(
                &run->d.t,
                "--until %s: it must be area=FRACTION, depth=LENGTH or uniform=SPREAD, above "
                "0, as in area=90%%,depth=1um, or area=2x for twice the first contact area",
                args.until);
    }
}

/* ---- a case ---- */

static double
key(struct tool *t, const struct rc_grid *g, const char *name, const char *what)
{
    double v;

    if (!rc_grid_number(g, name, &v))
        tool_die_at(
            t, g, EXIT_USAGE,
            "it has no key %s, %s: rc-wear reads the output of rc-solve: run rc-solve first", name,
            what);
    return v;
}

/* Bodies that rc-wear does not know how to wear. */
static void
refuse_others(struct tool *t, const struct rc_grid *g)
{
    static const char *const keys[][2] = {{"adhesion", "attract each other"},
                                          {"yield", "yield in their volume"}};

    for (size_t k = 0; k < 2; k++)
        if (rc_grid_get(g, keys[k][0]) != NULL)
            tool_refuse(t, g, "its bodies %s: their wear is not implemented", keys[k][1]);
    bodies_demand_elastic(t, g, "wear of viscoelastic bodies is not implemented");
    if (tool_history_has(g, "rc-solve ", "--tilt free"))
        tool_refuse(t, g,
                    "its counter body was free to tilt: the wear of a body that tilts is not "
                    "implemented");
}

/* True if a frame slip or dissipation is per length rolled. */
static bool
rolls(const struct rc_grid *g)
{
    return g != NULL && strcmp(g->unit, g->channel[0] == 's' ? "1" : "J/m3") == 0;
}

/* m: the largest height less the smallest one. */
static double
relief_of(struct tool *t, const struct rc_grid *g)
{
    double high = -INFINITY, low = INFINITY;

    for (size_t k = 0; k < rc_grid_nodes(g); k++) {
        high = fmax(high, g->v[k]);
        low = fmin(low, g->v[k]);
    }
    return ranks_most(t, high) + ranks_most(t, -low);
}

/* The largest value of a map; ends the tool where values are not at least 0, or none is above. */
static double
largest(struct tool *t, const struct rc_grid *g, const char *unit)
{
    const size_t n = rc_grid_nodes(g), first = tool_first_row(t, g);
    enum rc_status status = RC_OK;
    double most = 0;

    if (strcmp(g->unit, unit) != 0)
        tool_refuse(t, g, "its unit is '%s': it must be %s", g->unit, unit);
    for (size_t k = 0; k < n && status == RC_OK; k++) {
        if (!(g->v[k] >= 0) || isinf(g->v[k]))
            status = rc_err_set(&t->err,
                                "value %g at column %zu, row %zu: it must be at least 0 and finite",
                                g->v[k], k % g->nx, first + k / g->nx);
        most = fmax(most, g->v[k]);
    }
    tool_must(t, g, ranks_agree(t, status, &t->err));
    most = ranks_most(t, most);
    if (most == 0)
        tool_refuse(t, g, "all its values are 0: no node wears");
    return most;
}

/* Multiplies the part of each node by a map over `scale`. */
static void
multiply(struct run *run, const struct rc_grid *map, double scale)
{
    const size_t n = rc_grid_nodes(map);

    if (run->part == NULL && (run->part = malloc(n * sizeof *run->part)) == NULL)
        tool_refuse(&run->d.t, map, "out of memory for the wear of %zu nodes", n);
    for (size_t k = 0; k < n; k++)
        run->part[k] =
            map->v[k] / scale *
            (run->map[COEFFICIENT] == NULL || map == run->map[COEFFICIENT] ? 1 : run->part[k]);
}

/* The energy of a cycle at each node: that of the frame dissipation, or pressure times slip, to which the
 * coefficient of sliding belongs. In rolling all points of a row pass through the contact in each cycle. */
static void
find_energy(struct run *run, const struct rc_grid *g)
{
    struct tool *t = &run->d.t;
    const struct rc_grid *from = run->map[ENERGY], *p = run->map[PRESSURE];
    const size_t n = rc_grid_nodes(g), nx = g->nx;

    if (args.until != NULL)
        tool_refuse(t, g,
                    "--until with the energy of the stream is not implemented: give --cycles");
    if (from == NULL && p == NULL)
        tool_refuse(t, run->map[SLIP],
                    "it is the slip per length rolled, and its wear needs the frame "
                    "pressure too: take rc-slip --output height,pressure,slip");
    if (from == NULL && run->map[COEFFICIENT] != NULL)
        tool_refuse(t, run->map[COEFFICIENT],
                    "a coefficient of each node is not implemented for bodies that roll: give "
                    "--coefficient");
    run->energy = tool_room(t, n, sizeof *run->energy, "the energy");
    for (size_t k = 0; k < n; k++)
        run->energy[k] = from != NULL ? from->v[k] : fmax(p->v[k], 0) * run->map[SLIP]->v[k];
    for (size_t j = 0; j < g->ny - g->elsewhere && rolls(from != NULL ? from : run->map[SLIP]);
         j++) {
        const double sum = rc_sum(run->energy + j * nx, nx) * g->dx;
        for (size_t i = 0; i < nx; i++)
            run->energy[j * nx + i] = sum;
    }
    run->law.energy = run->energy;
}

/* Forgets a map that the law does not use. */
static void
drop(struct run *run, size_t map)
{
    rc_grid_free(run->map[map]);
    run->map[map] = NULL;
}

/* The area of --until area=Nx, as a part of the map. */
static void
find_until_area(struct run *run, const struct rc_grid *g)
{
    struct tool *t = &run->d.t;
    const struct rc_grid *p = run->map[PRESSURE];
    double count = 0, part;

    if (run->area_times == 0)
        return;
    if (p == NULL)
        tool_refuse(t, g,
                    "--until area=%gx needs the first contact area, from a frame pressure beside "
                    "the height: see rc-solve --output",
                    run->area_times);
    for (size_t k = 0; k < rc_grid_nodes(p); k++)
        count += rc_in_contact(p->v[k]);
    part = ranks_sum(t, count) / ranks_sum(t, (double)rc_grid_nodes(p));
    run->law.until_area = run->area_times * part;
    if (!(run->law.until_area <= 1))
        tool_refuse(t, g,
                    "--until area=%gx: the first contact area is %.3g of the map, and %g times as "
                    "much is more than the map",
                    run->area_times, part, run->area_times);
}

/* The law of the case, from the options and its maps. */
static void
find_law(struct run *run, const struct rc_grid *g)
{
    const bool by_energy = tool_given(&run->d.t, "energy") && !tool_given(&run->d.t, "mu");
    struct tool *t = &run->d.t;
    double most = 0, least = INFINITY;

    if (any_law(t) == (run->map[COEFFICIENT] != NULL))
        tool_die_at(t, g, EXIT_USAGE,
                    any_law(t) ? "it has a frame wear-coefficient: leave out --%s"
                               : "give one of --coefficient, --archard and --energy, or a frame "
                                 "wear-coefficient: how much wears%s",
                    !any_law(t)                    ? ""
                    : tool_given(t, "coefficient") ? "coefficient"
                    : tool_given(t, "archard")     ? "archard"
                                                   : "energy");
    if (by_energy && run->map[ENERGY] == NULL)
        tool_die_at(t, g, EXIT_USAGE,
                    "it has no frame dissipation: give --mu, or take rc-slip --output "
                    "height,dissipation");
    if (!by_energy && (run->map[SLIP] != NULL) != (args.cycles.n > 0))
        tool_die_at(t, g, EXIT_USAGE,
                    run->map[SLIP] != NULL
                        ? "it has a frame slip, the path of a cycle: give --cycles"
                    : run->map[ENERGY] != NULL
                        ? "it has a frame dissipation and no slip: give --energy without --mu"
                        : "--cycles needs a frame slip, the path of a cycle, as "
                          "rc-slip --output height,slip writes it");
    if (args.cycles.n == 0)
        tool_demand_full_sliding(t, g,
                                 "take rc-slip --output height,slip, or height,dissipation for "
                                 "--energy, and --cycles instead of --distance");
    drop(run, by_energy ? SLIP : ENERGY);
    memcpy(run->law.k, run->k, sizeof run->k);
    if (run->map[COEFFICIENT] != NULL)
        multiply(run, run->map[COEFFICIENT],
                 run->law.k[0] = largest(t, run->map[COEFFICIENT], "1/Pa"));
    run->path = 1;
    if (by_energy)
        (void)largest(t, run->map[ENERGY], rolls(run->map[ENERGY]) ? "J/m3" : "J/m2");
    else if (run->map[SLIP] != NULL && rolls(run->map[SLIP]))
        (void)largest(t, run->map[SLIP], "1");
    else if (run->map[SLIP] != NULL)
        multiply(run, run->map[SLIP], run->path = largest(t, run->map[SLIP], "m"));
    if (by_energy || rolls(run->map[SLIP]))
        find_energy(run, g);
    find_until_area(run, g);
    if (by_energy || run->energy == NULL)
        drop(run, PRESSURE);
    for (size_t k = 0; k < rc_grid_nodes(g) && run->part != NULL; k++) {
        most = fmax(most, run->part[k]);
        least = fmin(least, run->part[k]);
    }
    most = ranks_most(t, most);
    least = -ranks_most(t, -least);
    if (run->part != NULL && most == 0)
        tool_refuse(t, g, "nodes that slip have the wear coefficient 0: no node wears");
    for (size_t k = 0; k < rc_grid_nodes(g) && run->part != NULL; k++)
        run->part[k] /= most;
    for (int b = 0; b < 2 && run->part != NULL; b++)
        run->law.k[b] *= most;
    run->law.part = least < most ? run->part : NULL;
    if (args.cycles.n > 0)
        run->d.shown = (struct drive_shown){RC_DISTANCE, "cycles", NULL, run->path};
    for (size_t k = 0; k < run->d.points; k++)
        rc_point_set(&run->d.point[k], RC_DISTANCE, run->list->v[k] * run->path);
}

/* E* of the pair for waves as short as the roughness: that of the top layer on body 2. */
static double
estar_of(const struct rc_pair *p)
{
    const struct rc_body *bodies[] = {&p->one, &p->two};
    double compliance = 0;

    if (p->estar > 0)
        return p->estar;
    for (int b = 0; b < 2; b++) {
        const struct rc_layer *top = bodies[b]->layers > 0 ? bodies[b]->layer : NULL;
        compliance += top != NULL ? bodies_compliance(top->e, top->nu)
                                  : bodies_compliance(bodies[b]->e, bodies[b]->nu);
    }
    return 1 / compliance;
}

/* 1/Pa: the depth that a node loses under its own pressure and sliding distance. */
static double
rate(const struct run *run, const struct rc_grid *g)
{
    const double *k = run->law.k;

    return k[0] + (run->law.track > 0 ? k[1] * g->dx / run->law.track : k[1]);
}

/* On a periodic map the body in contact is repeated along the track. */
static void
suspect_track(struct run *run, const struct rc_grid *g)
{
    const double period = g->dx * (double)g->nx, track = run->law.track;
    const char *where = tool_where(&run->d.t, g);

    if (track > 0 && track < (1 - 1e-6) * period)
        tool_refuse(
            &run->d.t, g,
            "--motion track: the track, %s, is shorter than the map, %s: cut the contact out "
            "with rc-pick --crop, or give a longer track",
            shown_in_unit(track, "m"), shown_in_unit(period, "m"));
    if (track > 0 && run->law.k[1] > 0 && fabs(track - period) > 1e-6 * period && map_boundary(g).x)
        tool_warn(
            &run->d.t,
            "%s: the map repeats along x, so that each point of the track is passed every %s and "
            "not every %s: give the period as the length of the track, or solve a free map",
            where, shown_in_unit(period, "m"), shown_in_unit(track, "m"));
}

/* Two rough bodies that slide: adds body 2, and refuses the options that this model does not have. */
static void
add_counter(struct run *run, const struct rc_grid *g)
{
    struct tool *t = &run->d.t;

    if (!map_boundary(g).x)
        tool_refuse(t, g,
                    "--motion sliding needs a map that is periodic along x, on which body 2 can "
                    "pass for ever: run rc-solve --periodic, or --periodic=x");
    if (run->law.part != NULL)
        tool_refuse(t, g, "--motion sliding with a map of the wear coefficient is not implemented");
    if (rc_grid_get(g, "hardness") != NULL || rc_grid_get(g, "hardness_map") != NULL)
        tool_refuse(t, g, "--motion sliding with a hardness is not implemented");
    physics_counter_beside(t, args.counter, run->counter, g, RC_PERIODIC);
    run->law.h2 = run->counter->v;
    run->relief += relief_of(t, run->counter);
}

/* Distances that change nothing, or after which nothing changes: a unit may be wrong. */
static void
suspect_unit(struct run *run, const struct rc_grid *g)
{
    struct tool *t = &run->d.t;
    const struct rc_point *point = run->d.point;
    static const double most_sides = 1e12; /* the surface is flat to rounding far earlier */
    const double side = fmax(g->dx * (double)g->nx, g->dy * (double)g->ny);
    const double scale = rate(run, g) * run->law.estar;
    const char *where = tool_where(t, g);
    double first = INFINITY, last = 0;

    for (size_t i = 0; i < run->d.points; i++) {
        const double s = point[i].at[RC_DISTANCE];
        first = s > 0 ? fmin(first, s) : first;
        last = fmax(last, s);
    }
    if (last > 0 && !(scale * last <= most_sides * side))
        tool_refuse(t, g,
                    "the last distance, %s, is more than %g times the distance that makes the "
                    "pressure even, %s: check the units of the wear coefficient and the distance",
                    shown_in_unit(last, "m"), most_sides, shown_in_unit(side / scale, "m"));
    if (last > 0 && scale * last < 0.01 * g->dx)
        tool_warn(
            t,
            "%s: the last distance, %s, hardly changes the contact, which takes about %s: are "
            "the wear coefficient and the distance in their units?",
            where, shown_in_unit(last, "m"), shown_in_unit(0.1 * g->dx / scale, "m"));
    else if (isfinite(first) && scale * first > 1e4 * side)
        tool_warn(t,
                  "%s: at the first distance, %s, the pressure is even already, which takes about "
                  "%s: are the wear coefficient and the distance in their units?",
                  where, shown_in_unit(first, "m"), shown_in_unit(10 * side / scale, "m"));
}

/* ---- a worn map ---- */

/* Warns of steep worn heights, and of a surface that is worn away. `room` has a map for the heights. */
static void
judge_map(struct run *run, struct rc_model *m, struct rc_grid *room)
{
    struct drive *d = &run->d;
    const double deepest = rc_wear_result(m)->max_wear_depth;
    double *p = malloc(rc_grid_nodes(room) * sizeof *p);
    char where[512];
    struct rc_err err = {"out of memory for the pressure"};

    if (p == NULL || rc_model_frame(m, "pressure", p, &err) != RC_OK ||
        rc_model_frame(m, "height", room->v, &err) != RC_OK)
        tool_refuse(&d->t, room, "%s", err.text);
    drive_where(d, room, where, sizeof where);
    drive_judge_slope(&d->course,
                      rc_measure_contact_slope(ranks_of(&d->t), rc_shape_of(room), room->v, p),
                      where);
    free(p);
    if (run->relief > 0 && deepest > run->relief)
        course_warn(&d->course, "nothing is left of the surface before wear",
                    "%s: the largest worn depth, %s, is more than the peak-to-valley height of the "
                    "surface before wear, %s: nothing is left of that surface: end earlier, as "
                    "with --until area=0.9",
                    where, shown_in_unit(deepest, "m"), shown_in_unit(run->relief, "m"));
}

/* What is left of the coat, which body 1 has, where that is worn most. An earlier run may have worn it. */
static void
find_left(struct run *run, struct rc_model *m)
{
    const struct rc_grid *g = run->d.course.g;
    RC_OWNED double *depth = run->coat > 0 ? malloc(rc_grid_nodes(g) * sizeof *depth) : NULL;
    struct rc_err err = {"out of memory for the worn depth"};

    run->left = run->coat;
    if (run->coat == 0)
        return;
    if (depth == NULL || rc_model_frame(m, "wear-1", depth, &err) != RC_OK)
        tool_refuse(&run->d.t, g, "%s", err.text);
    for (size_t k = 0; k < rc_grid_nodes(g); k++)
        run->left = fmin(run->left, run->coat - depth[k]);
    run->left = -ranks_most(&run->d.t, -run->left);
}

/* "DISTANCE 1 m", or "after 1000 cycles". */
static const char *
way_text(const struct run *run, const char *words, double distance, char text[128])
{
    (void)drive_show_axis(&run->d, RC_DISTANCE, &distance);
    if (args.cycles.n > 0)
        snprintf(text, 128, "after %.9g cycles", distance);
    else
        snprintf(text, 128, "%s %s", words, shown_in_unit(distance, "m"));
    return text;
}

/* Ends the case where the coat is worn through: the points before stay. */
static void
judge(struct drive *d, struct rc_model *m)
{
    struct run *run = (struct run *)(void *)d;
    char text[300], way[128];

    run->area = rc_model_number(m, "contact_fraction");
    run->depth = rc_wear_result(m)->max_wear_depth;
    run->spread = rc_wear_result(m)->pressure_spread;
    find_left(run, m);
    if (run->left >= 0) {
        drive_judge_point(d, m);
        return;
    }
    snprintf(text, sizeof text,
             "%s body 1 has lost %s of its coat, and %s was left: a coat that is worn through is "
             "not implemented",
             way_text(run, "after a distance of", d->is.at.at[RC_DISTANCE], way),
             shown_in_unit(run->coat - run->left, "m"), shown_in_unit(run->coat, "m"));
    if (d->at == 0)
        tool_refuse(&d->t, d->course.g, "%s", text);
    tool_warn(&d->t, "%s: %s: the output ends with the %s before", tool_where(&d->t, d->course.g),
              text, args.cycles.n > 0 ? "cycles" : "distance");
    tool_fails_with(&d->t, EXIT_SHORT);
    d->is.silent = d->is.ended = true;
    d->course.number--;
}

static void
set_keys(struct drive *d, struct rc_model *m, struct rc_grid *g)
{
    struct run *run = (struct run *)(void *)d;
    const struct rc_wear_figures *f = rc_wear_result(m);

    if (run->coat > 0)
        tool_set_number(&d->t, g, "coat_left", run->left);
    d->is.ended = d->status != RC_MORE && f->distance < d->point[d->at].at[RC_DISTANCE];
    tool_set(&d->t, g, args.cycles.n > 0 ? "distance" : "cycles", NULL); /* of an earlier run */
    tool_set_error(&d->t, g, "pressure.error", f->pressure_error);
    tool_set_number(&d->t, g, "wear_1", run->law.k[0]);
    tool_set_number(&d->t, g, "wear_2", run->law.k[1]);
    judge_map(run, m, g);
    if (run->law.two_bodies && f->pressure_error > args.tol)
        course_warn(
            &d->course, "the pressure of one alignment is less accurate than the wear",
            "the estimated error of the pressure, %.2g, is above --tol: it is the pressure of one "
            "alignment, and the worn depths that all alignments share are more accurate: take a "
            "smaller --tol",
            f->pressure_error);
}

/* Warns where the distances ended before the conditions of --until. */
static void
judge_until(struct run *run, const struct rc_grid *g)
{
    const struct rc_wear_problem *law = &run->law;
    char text[256] = "", way[128];
    size_t at = 0;

    if (args.until == NULL || run->d.args->dry_run || run->d.is.ended || run->d.status == RC_MORE ||
        tool_interrupted() != 0 ||
        (law->until_area > 0 && run->area >= law->until_area) || /* just at the last distance */
        (law->until_depth > 0 && run->depth >= law->until_depth) ||
        (law->until_spread > 0 && run->spread <= law->until_spread))
        return;
    if (law->until_area > 0)
        at += (size_t)snprintf(text, sizeof text, ": %.3g of the map is in contact, and not %.3g",
                               run->area, law->until_area);
    if (law->until_depth > 0)
        at += (size_t)snprintf(
            text + at, sizeof text - at, ": the largest worn depth is %s, and not %s",
            shown_in_unit(run->depth, "m"), shown_in_unit(law->until_depth, "m"));
    if (law->until_spread > 0)
        snprintf(text + at, sizeof text - at, ": the spread of the pressure is %.3g, and not %.3g",
                 run->spread, law->until_spread);
    tool_warn(&run->d.t, "%s: --until was not reached %s%s", tool_where(&run->d.t, g),
              way_text(run, "at the last distance,",
                       run->d.point[run->d.points - 1].at[RC_DISTANCE], way),
              text);
}

/* The column of --cycles, where a step or a point has ended at this distance. */
static void
put_cycles(struct run *run, struct report *r, double distance)
{
    const struct drive_shown as = drive_show_axis(&run->d, RC_DISTANCE, &distance);

    if (args.cycles.n > 0)
        report_number(r, as.name, distance, as.unit);
}

/* A row of --steps after each step; none for a way that is taken again. */
static void
put_step(struct course *c, struct rc_model *m)
{
    struct run *run = (struct run *)(void *)c->t;
    const struct rc_wear_figures *f = rc_wear_result(m);
    struct rc_point at = {0};

    if (f->steps == run->written || f->distance <= run->slid || !report_wanted(&run->steps))
        return;
    run->written = f->steps;
    run->slid = f->distance;
    report_begin(&run->steps);
    report_count(&run->steps, "case", c->number, NULL);
    report_text(&run->steps, "source", rc_grid_get(c->g, "source"));
    put_cycles(run, &run->steps, f->distance);
    rc_point_set(&at, RC_LOAD, run->d.point->at[RC_LOAD]);
    at.at[RC_APPROACH] = NAN; /* the contact within a step has other heights than the worn ones */
    report_model(&run->steps, m, &at, at.given);
    report_finish_row(&run->steps);
}

static void
asked(struct drive *d, const struct rc_model *m)
{
    (void)m;
    report_number(&d->report, "tol", args.tol, NULL);
    put_cycles((struct run *)(void *)d, &d->report, d->is.at.at[RC_DISTANCE]);
}

/* The effects: computed, or why not. */
static const struct effect_state *
effects(struct drive *d)
{
    static struct effect_state list[10];
    const struct run *run = (const struct run *)(const void *)d;
    const struct rc_grid *g = d->course.g;
    const bool hard = run->map[HARD] != NULL || rc_grid_get(g, "hardness") != NULL;
    const bool coated = rc_grid_get(g, "layers") != NULL;

    list[0] = (struct effect_state){"wear_1", run->law.k[0] > 0 || run->energy != NULL
                                                  ? "on"
                                                  : "left out: the coefficient of body 1 is 0"};
    list[1] = (struct effect_state){
        "wear_2", run->law.k[1] > 0 ? "on" : "left out: no coefficient of body 2"};
    list[2] = (struct effect_state){
        "coefficient_map",
        run->law.part != NULL ? "on" : "left out: one coefficient for all nodes"};
    list[3] = (struct effect_state){
        "track", run->law.track > 0 ? "on" : "left out: no --motion track:LENGTH"};
    list[4] = (struct effect_state){"two_bodies",
                                    run->law.two_bodies ? "on" : "left out: no --motion sliding"};
    list[5] = (struct effect_state){
        "dissipation", run->energy != NULL
                           ? "on: each node loses the coefficient times its energy of a cycle"
                           : "left out: no --cycles of a frame dissipation"};
    list[6] = (struct effect_state){
        "hardness", hard ? "on" : "left out: the contact was solved without a hardness"};
    list[7] = (struct effect_state){"layers", coated ? "on" : "left out: one material"};
    list[8] = (struct effect_state){
        "heat", "left out: wear and heat do not change each other here: see rc-heat"};
    return list;
}

static void
show_plan(struct drive *d, const struct plan *plan)
{
    const struct run *run = (const struct run *)(const void *)d;
    const struct rc_grid *g = d->course.g;
    const double scale = rate(run, g) * run->law.estar;
    const double limit = 0.9 * g->dx / scale;
    const double last = d->point[d->points - 1].at[RC_DISTANCE];

    if (run->energy != NULL)
        return;
    if (run->law.track == 0 || run->law.k[1] == 0)
        plan_say(plan, "explicit steps", "about %.3g, each at most 0.9 dx/(k E*) = %s",
                 ceil(last / limit), shown_in_unit(limit, "m"));
    if (run->law.part != NULL)
        plan_say(plan, "coefficients",
                 "by node: a contact takes about 12 to 35 convolutions, more than 100 where a step "
                 "is above 1000 dx/(k E*), beside 6 of a uniform one");
}

static void
do_case(struct run *run, const struct rc_grid *g)
{
    static const struct drive_advice free_map[] = {
        {"edge_load_fraction", "take a larger map, or let it be periodic"}, {NULL, NULL}};
    static const struct drive_advice periodic[] = {{"edge_load_fraction", NULL}, {NULL, NULL}};
    struct drive *d = &run->d;
    const struct rc_shape shape = rc_grid_shape(g);
    struct rc_problem problem = {.tol = args.tol / 100,
                                 .history_part = 0.05,
                                 .threads = d->t.threads,
                                 .hurry = tool_signal(),
                                 .ranks = ranks_of(&d->t)};
    struct layers layers;
    const double load = key(&d->t, g, "load", "the load");

    refuse_others(&d->t, g);
    if (rc_grid_get(g, "boundary") == NULL)
        tool_refuse(&d->t, g, "it has no key boundary, which rc-solve writes: solve the contact");
    problem.boundary = map_boundary(g);
    d->advice = !rc_has_mean(problem.boundary) ? periodic : free_map;
    tool_must(&d->t, g, layers_read(g, &layers, &d->t.err));
    tool_must(&d->t, g, bodies_read(g, &layers, &problem.pair, &d->t.err));
    if (rc_grid_get(g, "hardness") != NULL)
        problem.hardness = key(&d->t, g, "hardness", "the bound of the pressure");
    if (run->map[HARD] != NULL)
        problem.hardness_map = run->map[HARD]->v;
    else if (rc_grid_get(g, "hardness_map") != NULL)
        tool_refuse(&d->t, g,
                    "its pressure was bounded by a map, and it has no frame hardness: put the map "
                    "into the case");
    find_law(run, g);
    if (run->map[SLIP] != NULL) /* the nodes that stick carry most of the load, but do not wear */
        problem.tol /= 10;
    run->law.estar = estar_of(&problem.pair);
    run->law.tol = args.tol;
    run->coat = layers.layer != NULL ? layers.layer[0].thickness : 0;
    if (run->coat > 0 && rc_grid_get(g, "coat_left") != NULL)
        run->coat = fmin(run->coat, key(&d->t, g, "coat_left", "the rest of the coat"));
    if (layers.layer != NULL && !(run->coat > 0))
        tool_refuse(&d->t, g, "its coat is worn through: its key coat_left is %s m",
                    rc_grid_get(g, "coat_left"));
    run->relief = relief_of(&d->t, g);
    run->written = 0;
    run->slid = 0;
    if (run->law.two_bodies)
        add_counter(run, g);
    for (size_t k = 0; k < d->points; k++)
        rc_point_set(&d->point[k], RC_LOAD, load);
    if (run->energy == NULL)
        suspect_unit(run, g);
    suspect_track(run, g);
    drive_case(d, g,
               rc_wear_new(rc_elastic_new(&shape, g->v, &problem, NULL, &d->t.err), g->v, &run->law,
                           &d->t.err),
               &d->t.err);
    judge_until(run, g);
    layers_free(&layers);
    free(run->part);
    free(run->energy);
    run->part = run->energy = NULL;
    run->law.energy = NULL;
}

/* The heights of the next case, with the maps beside them. */
static struct rc_grid *
next(struct run *run)
{
    struct rc_grid *g;

    tool_free_frames(run->beside);
    if (tool_interrupted() != 0 ||
        (g = tool_channel_with(&run->d.t, "height", tool_take_frames, run->beside)) == NULL)
        return NULL;
    for (size_t k = 0; k < MAPS; k++)
        if (run->map[k] != NULL)
            tool_demand_grid_of(&run->d.t, run->map[k], g);
    return g;
}

/* A stream is one cycle: the last case has its heights and maps, and slip and dissipation are the sums
 * over all cases. */
static struct rc_grid *
next_cycle(struct run *run)
{
    struct rc_grid *g = next(run), *last = NULL, *map[MAPS];

    while (g != NULL && (run->map[SLIP] != NULL || run->map[ENERGY] != NULL)) {
        rc_grid_free(last);
        last = g;
        memcpy(map, run->map, sizeof map);
        memset(run->map, 0, sizeof map);
        if ((g = next(run)) == NULL)
            break;
        tool_demand_grid_of(&run->d.t, g, last);
        if (rolls(map[SLIP]) || rolls(map[ENERGY]))
            tool_refuse(&run->d.t, g,
                        "a second case: the wear of a contact that rolls follows from one "
                        "steady state: give rc-slip --steady, or choose with rc-pick --case");
        for (size_t m = SLIP; m <= ENERGY; m++)
            for (size_t k = 0; k < rc_grid_nodes(g) && run->map[m] != NULL && map[m] != NULL; k++)
                run->map[m]->v[k] += map[m]->v[k];
        for (size_t k = 0; k < MAPS; k++)
            rc_grid_free(map[k]);
    }
    if (g != NULL) { /* without a slip */
        rc_grid_free(last);
        return g;
    }
    if (last != NULL)
        memcpy(run->map, map, sizeof map);
    return last;
}

/* ---- main ---- */

int
main(int argc, char **argv)
{
    static struct drive_axis axes[] = {
        {RC_DISTANCE, &args.distance}, {RC_LOAD, &args.load}, {0, NULL}};
    static const char *const tells[] = {"contact_fraction",
                                        "max_pressure",
                                        "max_wear_depth",
                                        "wear_volume",
                                        "steps",
                                        "convolutions",
                                        NULL};
    static const char *const reads[] = {"boundary", "datum",    "estar",     "layers", "e2",
                                        "nu2",      "hardness", "coat_left", NULL};
    static struct run run = {.d = {.args = &args.drive,
                                   .output = &args.output,
                                   .list = frames,
                                   .tells = tells,
                                   .beside = run.maps,
                                   .reads = reads,
                                   .calls.judge = judge,
                                   .calls.keys = set_keys,
                                   .calls.columns = asked,
                                   .calls.effects = effects,
                                   .calls.plan = show_plan,
                                   .course.stepped = put_step},
                             .beside = {{"wear-coefficient", &run.map[COEFFICIENT]},
                                        {"hardness", &run.map[HARD]},
                                        {"slip", &run.map[SLIP]},
                                        {"dissipation", &run.map[ENERGY]},
                                        {"pressure", &run.map[PRESSURE]}},
                             .maps = {{"wear-coefficient", &run.map[COEFFICIENT]},
                                      {"hardness", &run.map[HARD]},
                                      {"slip", &run.map[SLIP]},
                                      {"dissipation", &run.map[ENERGY]},
                                      {"pressure", &run.map[PRESSURE]},
                                      {"counter", &run.counter}}};
    struct rc_grid *g;

    tool_start(&run.d.t, &info, argc, argv, &args);
    read_law(&run);
    read_motion(&run);
    read_until(&run);
    axes[0].list = run.list = args.cycles.n > 0 ? &args.cycles : &args.distance;
    for (size_t k = 1; k < run.list->n; k++)
        if (!(run.list->v[k] > run.list->v[k - 1]))
            tool_usage(&run.d.t, "--%s: each number must be larger than the one before it",
                       args.cycles.n > 0 ? "cycles" : "distance");
    if (args.cycles.n == 0) { /* the energy is that of full sliding */
        run.beside[ENERGY] = run.beside[PRESSURE];
        run.beside[run.area_times > 0 ? PRESSURE : ENERGY].channel = NULL;
    }
    report_open(&run.steps, &run.d.t, args.steps);
    drive_open(&run.d, axes);
    while ((g = args.cycles.n > 0 ? next_cycle(&run) : next(&run)) != NULL) {
        do_case(&run, g);
        rc_grid_free(g);
    }
    tool_free_frames(run.beside);
    rc_grid_free(run.counter);
    report_close(&run.steps);
    return drive_close(&run.d);
}
