/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which effects a contact calls for: one verdict for each, from one elastic contact. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "tools/frames/frames.h"
#include "tools/materials/materials.h"
#include "tools/problem/problem.h"
#include "tools/scene/scene.h"

static struct args {
    struct physics physics;
    struct scene_args given;
    const char *relaxation, *report, *within_temperature;
    double within, within_friction, decide;
    size_t figures;
    bool dry_run;
} args = {.physics = PHYSICS_NONE,
          .given = SCENE_NOTHING,
          .within = 0.01,
          .within_friction = 0.01,
          .decide = NAN};

static const char *const figure_words[] = {"area",        "pressure", "approach", "displacement",
                                           "temperature", "friction", "fatigue",  "leak",
                                           "pull-off",    NULL};

#define AT(field) .at = offsetof(struct args, field)
#define ABOVE_0 .min = 0, .max = INFINITY, .above = true, .result = true
/* clang-format off */
static const struct opt opts[] = {
    {.group = physics_options, .at = offsetof(struct args, physics), .title = "the elastic contact"},
    {.group = material_options, .title = "the elastic contact"},
    {.title = "data of the effects"},
    {.group = scene_options, .at = offsetof(struct args, given)},
    {.name = "noise", .type = OPT_NUMBER, .unit = UNIT_M, AT(given.noise), ABOVE_0, .arg = "S",
     .help = "warn of the noise of the scan: its standard deviation"},
    {.name = "relaxation", .type = OPT_TEXT, AT(relaxation), .result = true, .arg = "EINF,E1:TAU1,...|FILE",
     .against = RULES({.with = "E1 MODULUS", .because = "the moduli of body 1 are those of --relaxation"},
                      {.with = "estar", .because = "body 1 needs its Poisson's ratio"}),
     .help = "relaxation, sliding on rubber: the relaxation modulus of body 1, instead of --E1"},
    {.title = "verdicts"},
    {.name = "within", .type = OPT_NUMBER, AT(within), ABOVE_0, .arg = "CHANGE",
     .help = "relative change that does not matter (default 0.01)"},
    {.name = "within-temperature", .type = OPT_TEXT, AT(within_temperature), .result = true,
     .arg = "KELVIN", .help = "rise of the temperature that does not matter, a difference in K (default 10)"},
    {.name = "within-friction", .type = OPT_NUMBER, AT(within_friction), ABOVE_0, .arg = "CHANGE",
     .help = "change of the coefficient of friction that does not matter (default 0.01)"},
    {.name = "figures", .type = OPT_WORDS, AT(figures), .list = figure_words, .result = true, .arg = "LIST",
     .help = "figures that matter, of %s (default: all)"},
    {.name = "decide", .type = OPT_NUMBER, .unit = UNIT_S, AT(decide), ABOVE_0, .arg = "TIME",
     .help = "compute each undecided effect that is expected to take less than this time"},
    {.title = "output"},
    {.name = "report", .type = OPT_REPORT, AT(report), .arg = "FILE",
     .help = "write one JSON object per case, or a row of FILE.tsv or .csv for each effect"},
    {.name = "dry-run", .type = OPT_FLAG, AT(dry_run), .text = true,
     .help = "print the expected memory and time, and stop"},
    {.name = NULL},
};
/* clang-format on */

static const struct rc_figure figures[] = {
    {.name = "within", .title = "Change that does not matter"},
    {.name = "low", .title = "Least change over the bound"},
    {.name = "high", .title = "Largest change over the bound"},
    {.name = "forecast_seconds", .unit = "s", .title = "Expected time of the effect"},
    {0},
};

static const struct tool_info info = {
    .name = "rc-scene",
    .summary = "Which effects a contact calls for",
    .operands = "[FILE...]",
    .examples =
        "  rc-scene --load 5N --E1 210GPa --nu1 0.3 --E2 70GPa --nu2 0.33 --hardness 3GPa \\\n"
        "      --yield 1GPa --mu 0.3 --coefficient 1e-6mm3/Nm --distance 10m surface.rcg\n",
    .opts = opts,
    .figures = (const char *const[]){"contact", NULL},
    .own = figures,
    .fill = materials_fill,
    .of_materials = (const char *const[]){"E1", "nu1", "E2", "nu2", "hardness", "yield",
                                          "conductivity", "diffusivity", NULL},
    .reads = READS_STREAM,
    .writes = WRITES_TEXT,
};

struct run {
    struct tool t;
    struct report report;
    int in; /* the heights of the stream, for the commands */
    struct rc_scene_data data;
    struct rc_scene_bounds bounds;
    struct relaxation_law material;
    struct adhesion_law adhesion;
};

/* A verdict with all that is printed of it. */
struct line {
    struct rc_scene_effect effect;
    enum rc_scene_verdict verdict;
    enum rc_scene_figure figure;
    struct scene_command command;
    struct rc_contact base; /* with which it is compared */
    const char *with;       /* options of effects accepted before */
    bool commanded, decided;
    const char *not_computed;     /* why --decide does not compute it; NULL: it does */
    double seconds, convolutions; /* forecast; NAN: unknown */
    char why[SCENE_WHY];
};
enum {
    LINES = 24,
    NODES = 20 /* in contact, below which an estimate decides nothing */
};
static const struct rc_relaxation *run_material; /* that of --relaxation; NULL: none */
static const double strain = 0.1; /* pressure over E*, beyond which a solid is not linear elastic */

/* ---- the command line ---- */

static void
read_numbers(struct tool *t, const char *name, const char *text, enum unit unit, size_t least,
             double to[2])
{
    struct numbers list;

    if (unit_numbers(text, unit, &list, &t->err) != RC_OK)
        tool_usage(t, "--%s %s: %s", name, text, t->err.text);
    if (list.n < least || list.n > 2)
        tool_usage(t, "--%s %s: it must be %s", name, text,
                   least == 2 ? "two numbers, for body 1 and body 2" : "one number or two");
    for (size_t k = 0; k < list.n; k++) {
        if (!(list.v[k] >= 0) || isinf(list.v[k]))
            tool_usage(t, "--%s %s: the numbers must not be negative", name, text);
        to[k] = list.v[k];
    }
    free(list.v);
}

static void
read_conductivities(struct tool *t, double k[2])
{
    const char *of;

    if (unit_conductivities(args.given.conductivity, k, &of, &t->err) != RC_OK)
        tool_usage(t, "--conductivity %s: %s", args.given.conductivity, t->err.text);
    if (of != NULL && strcmp(of, "W/K") != 0)
        tool_usage(t, "--conductivity %s: it must be thermal, in W/mK", args.given.conductivity);
}

/* Creepages along x and y, and a spin; one value is the creepage along x. */
static void
read_creep(struct tool *t, double creep[2], double *spin)
{
    const char *text = args.given.creep;
    double *const to[] = {&creep[0], &creep[1], spin};
    size_t n = 0, commas = 0;

    for (const char *at = text; at != NULL && *at != '\0'; at++)
        commas += *at == ',';
    for (const char *at = text; at != NULL && *at != '\0' && n < 3; n++) {
        char one[64];
        const size_t length = strcspn(at, ",");
        if (length >= sizeof one)
            tool_usage(t, "--creep %s: a number of at most %zu characters is expected", text,
                       sizeof one - 1);
        snprintf(one, sizeof one, "%.*s", (int)length, at);
        if (unit_number(one, n == 2 ? UNIT_SPIN : UNIT_CREEP, to[n], &t->err) != RC_OK)
            tool_usage(t, "--creep %s: %s", text, t->err.text);
        if (n < 2)
            creep_judge(t, one, to[n], 1);
        at = at[length] == '\0' ? NULL : at + length + 1;
    }
    if (text != NULL && commas + 1 != n)
        tool_usage(
            t, "--creep %s: it must be a creepage along x, or two (x and y), or these and a spin",
            text);
}

/* A difference of temperatures: 10degC would be read as 283 K. */
static double
read_difference(struct tool *t)
{
    double v = 10;

    if (args.within_temperature == NULL)
        return v;
    if (strstr(args.within_temperature, "C") != NULL)
        tool_usage(t, "--within-temperature %s: it is a difference: give it in K, as in 10K",
                   args.within_temperature);
    if (unit_number(args.within_temperature, UNIT_K, &v, &t->err) != RC_OK || !(v > 0))
        tool_usage(t, "--within-temperature %s: it must be above 0, as in 10K",
                   args.within_temperature);
    return v;
}

static bool
creeps(const struct run *run)
{
    const struct rc_scene_data *d = &run->data;

    return d->creep[0] != 0 || d->creep[1] != 0 || d->spin != 0;
}

static bool
wears_by_rolling(const struct run *run, const struct line *l)
{
    return creeps(run) && strcmp(l->effect.name, "wear") == 0;
}

/* True if --speed is the speed of rolling. */
static bool
rolls(const struct run *run)
{
    return run->data.speed > 0 && creeps(run);
}

static double
known(double v)
{
    return isnan(v) ? 0 : v;
}

/* The modulus of a viscoelastic body 1 at once is that of the elastic contact: its commands name it. */
static void
give_modulus(struct tool *t)
{
    for (size_t k = 0; k < t->option.n; k++)
        if (t->option.row[k].name != NULL && strcmp(t->option.row[k].name, "E1") == 0)
            t->option.given[k] = true;
}

static void
read_data(struct run *run)
{
    struct tool *t = &run->t;
    struct physics *a = &args.physics;
    struct rc_scene_data *d = &run->data;
    double worn[2] = {0, 0};

    if (args.relaxation != NULL) {
        if (relaxation_law_read(&run->material, args.relaxation, NULL, &t->err) != RC_OK)
            tool_usage(t, "--relaxation %s: %s", args.relaxation, t->err.text);
        a->relaxes = 1 / run->material.material->instant;
        d->material = run_material = run->material.material;
    }
    physics_check(t, a);
    if (args.relaxation != NULL)
        give_modulus(t);
    if (isinf(a->e1))
        tool_usage(t, "--E1 rigid: rc-scene compares with a uniform body 1: give its modulus, and "
                      "--thickness for a thin one");
    d->hardness = isinf(a->hardness) ? 0 : a->hardness;
    d->layers = a->layer.n;
    d->layer = a->layers;
    d->thickness = known(args.given.thickness);
    if (args.given.yield != NULL) {
        double y[2] = {0, 0};
        read_numbers(t, "yield", args.given.yield, UNIT_PA, 1, y);
        d->yield = y[0];
    }
    if (args.given.adhesion != NULL) {
        if (adhesion_law_read(&run->adhesion, args.given.adhesion, &t->err) != RC_OK)
            tool_usage(t, "--adhesion %s: %s", args.given.adhesion, t->err.text);
        d->work = run->adhesion.problem.work;
        d->law = run->adhesion.problem.law;
        d->range = run->adhesion.problem.range;
    }
    d->mu = known(args.given.mu);
    d->tangential = known(args.given.tangential);
    d->speed = known(args.given.speed);
    d->time = known(args.given.time);
    d->distance = known(args.given.distance);
    d->bending = known(args.given.bending);
    d->torsion = known(args.given.torsion);
    d->drop = known(args.given.drop);
    if (args.given.coefficient != NULL) {
        read_numbers(t, "coefficient", args.given.coefficient, UNIT_WEAR, 1, worn);
        d->wear = worn[0] + worn[1];
    }
    if (args.given.conductivity != NULL)
        read_conductivities(t, d->conductivity);
    if (args.given.diffusivity.n > 0) {
        if (args.given.diffusivity.n != 2)
            tool_usage(t, "--diffusivity: give two numbers, for body 1 and body 2");
        memcpy(d->diffusivity, args.given.diffusivity.v, sizeof d->diffusivity);
    }
    read_creep(t, d->creep, &d->spin);
    if (rolls(run) && d->material != NULL)
        tool_usage(t, "--speed with --creep is the speed of rolling, and --relaxation with a speed "
                      "is for sliding on rubber: rolling on rubber is not implemented: leave out "
                      "--speed");
    d->moving = args.given.moving != NULL && strcmp(args.given.moving, "1") == 0 ? 1 : 2;
    run->bounds = (struct rc_scene_bounds){.relative = args.within,
                                           .temperature = read_difference(t),
                                           .friction = args.within_friction,
                                           .figures = (unsigned)args.figures};
}

/* ---- one case ---- */

static void
write_heights(struct tool *t, const struct rc_grid *g, int to)
{
    FILE *file = fdopen(dup(to), "wb");
    RC_OWN(rc_writer, w) = file == NULL ? NULL : rc_writer_new(file, &t->err);

    if (w == NULL || rc_writer_put(w, g, &t->err) != RC_OK || rc_writer_end(w, &t->err) != RC_OK)
        tool_die(t, "the heights cannot be passed on: %s", t->err.text);
    if (fclose(file) != 0)
        tool_die(t, "the heights cannot be passed on: set TMPDIR to a folder with room");
}

/* Solves the elastic contact by rc-solve, as the input of other programs. */
static bool
solve_contact(struct run *run, const struct scene_command *any, int in, int out)
{
    const char *word[SCENE_WORDS];
    struct process process = {.in = in, .out = out, .allowed = 1e9, .doing = "elastic contact"};
    size_t n = 0;
    enum process_end end;

    for (size_t k = 0; any->word[0][k] != NULL; k++)
        word[n++] = any->word[0][k];
    word[n++] = "--quiet";
    word[n] = NULL;
    end = process_run(&run->t, word, &process);
    free(process.said);
    if (end == PROCESS_INTERRUPTED)
        tool_die(&run->t, "interrupted");
    return end == PROCESS_ENDED;
}

/* The verdict by a computed change. */
static void
decide(struct run *run, struct line *l, const struct rc_contact *c, const struct scene_found *found)
{
    const double before[RC_SCENE_FIGURES] = {[RC_SCENE_AREA] = c->contact_area,
                                             [RC_SCENE_PRESSURE] = c->max_pressure,
                                             [RC_SCENE_APPROACH] = c->approach,
                                             [RC_SCENE_PULL_OFF] = c->load};
    struct rc_scene_effect e = l->effect;
    bool any = false;

    for (int f = 0; f < RC_SCENE_FIGURES; f++) {
        const bool differs = f <= RC_SCENE_APPROACH;
        const double v = found->figure[f], over = before[f] > 0 ? before[f] : 1,
                     change = differs                  ? fabs(v / over - 1)
                              : f == RC_SCENE_PULL_OFF ? fmax(-v / over, 0) /* it is negative */
                                                       : fabs(v),
                     error = fabs(v / over) * found->error[f];
        e.change[f] = (struct rc_interval){NAN, NAN};
        if (isnan(v))
            continue;
        e.change[f] = (struct rc_interval){fmax(change - error, 0), change + error};
        any = true;
    }
    if (!any || !found->converged)
        return;
    e.basis = RC_SCENE_COMPUTED;
    e.unfit[0] = '\0';
    l->effect = e;
    l->verdict = rc_scene_judge(&e, &run->bounds, &l->figure);
    l->decided = true;
}

/* A number of an effect; NAN: it has none of this name. */
static double
number_of(const struct rc_scene_effect *e, const char *name)
{
    for (int k = 0; k < RC_SCENE_NUMBERS && e->number_name[k] != NULL; k++)
        if (strcmp(e->number_name[k], name) == 0)
            return e->number[k];
    return NAN;
}

/* Times the nodes along an axis for this spacing: as whole cells the map keeps its size. */
static size_t
times_for(double now, double spacing, size_t nodes, size_t most)
{
    const double times = nodes == 1 ? 1 : ceil(now / spacing * (1 - 1e-9));

    return times * (double)nodes > (double)most ? 0 : (size_t)times;
}

/* True if this grid resolves the attraction. Else a computed change would be one of the grid: an undecided
 * row says which grid decides it, and the command takes one. */
static bool
resolves(struct run *run, const struct rc_grid *g, struct line *l)
{
    struct rc_scene_effect *e = &l->effect;
    const struct rc_adhesion_scales scales = {.range = run->adhesion.problem.range,
                                              .cohesive_nodes = number_of(e, "cohesive_nodes")};
    const size_t most = 16384; /* nodes a side of a map that a command makes */
    struct adhesion_grid need;
    char range[SHOWN_NUMBER];
    size_t x, y;

    if (isnan(scales.cohesive_nodes) ||
        adhesion_resolved(&scales, args.physics.boundary, fmax(g->dx, g->dy), &need))
        return true;
    if (l->verdict == RC_SCENE_UNDECIDED)
        snprintf(e->unfit, sizeof e->unfit,
                 "the grid does not resolve the range of adhesion: take a spacing of %s, or, if "
                 "only the work matters, a range of %s",
                 shown_in_unit(need.spacing, "m"), shown_in_unit_to(range, need.range, "m"));
    x = times_for(g->dx, need.spacing, g->nx, most);
    y = times_for(g->dy, need.spacing, g->ny, most);
    l->commanded = x > 0 && y > 0;
    if (l->commanded)
        scene_refine(&l->command, x * g->nx, y * g->ny);
    return false;
}

static void
name_commands(struct run *run, const struct rc_grid *g, struct line line[], size_t n,
              const char *const load[2])
{
    char body[3 * 64], thickness[64], e[64], nu[64];
    int contact = -1;

    snprintf(body, sizeof body, "%.60s,%.60s,%.60s", scene_value(&run->t, "thickness", thickness),
             scene_value(&run->t, "E1", e), scene_value(&run->t, "nu1", nu));
    for (size_t k = 0; k < n; k++) {
        struct line *l = &line[k];
        struct scene_found found;

        l->seconds = l->convolutions = NAN;
        l->why[0] = '\0';
        if (l->verdict == RC_SCENE_NEGLIGIBLE || l->verdict == RC_SCENE_MISSING)
            continue;
        if (wears_by_rolling(run, l))
            continue;
        l->commanded = scene_command(
            &run->t, number_of(&l->effect, "time") > 0 ? "leak in time" : l->effect.name, load,
            body, l->with, &l->command);
        if (!l->commanded || !resolves(run, g, l))
            continue;
        if (l->command.programs > 1 && contact < 0) {
            contact = scene_file(&run->t);
            if (!solve_contact(run, &l->command, run->in, contact))
                continue;
        }
        if (!scene_run(&run->t, &l->command, l->effect.name, run->in, contact, true, &found,
                       l->why)) {
            l->commanded = l->why[0] == '\0';
            continue;
        }
        l->seconds = found.seconds;
        l->convolutions = found.convolutions;
        if (l->verdict != RC_SCENE_UNDECIDED || !(l->seconds < args.decide))
            continue;
        l->not_computed = scene_not_computed(&run->t, l->effect.name);
        if (l->not_computed == NULL && scene_run(&run->t, &l->command, l->effect.name, run->in,
                                                 contact, false, &found, l->why))
            decide(run, l, &l->base, &found);
    }
    if (contact >= 0)
        close(contact);
}

/* ---- output ---- */

static const char *const plain_names[RC_SCENE_FIGURES] = {
    "contact area",  "largest pressure",        "approach",      "tangential displacement",
    "temperature",   "coefficient of friction", "fatigue index", "leak",
    "pull-off force"};

/* "12 %", "8.8 K", "15 times". Both ends of an interval have the unit of its upper end, `high`. */
static const char *
amount(enum rc_scene_figure figure, double v, double high, char text[SHOWN_NUMBER])
{
    const double much = 10; /* above it per cent are hard to read */

    if (figure == RC_SCENE_TEMPERATURE)
        snprintf(text, SHOWN_NUMBER, "%.3g K", v);
    else if (figure == RC_SCENE_FRICTION || figure == RC_SCENE_FATIGUE)
        snprintf(text, SHOWN_NUMBER, "%.2g", v);
    else if (high >= much)
        snprintf(text, SHOWN_NUMBER, "%.3g times", v);
    else if (v < 0.1)
        snprintf(text, SHOWN_NUMBER, "%.2g %%", 100 * v);
    else
        snprintf(text, SHOWN_NUMBER, "%.0f %%", 100 * v);
    return text;
}

/* A viscoelastic body closes the gap in time. */
static void
print_leak(const struct line *l, FILE *out)
{
    const double time = number_of(&l->effect, "time");

    fputs(l->verdict == RC_SCENE_CALLS        ? ": the gap is open from edge to edge"
          : l->verdict == RC_SCENE_NEGLIGIBLE ? ": the gap is closed between the edges"
                                              : ": the contact is close to percolation, where "
                                                "the grid decides",
          out);
    if (time > 0)
        fprintf(out, ", %s after the load acts", shown_in_unit(time, "s"));
    else if (time == 0)
        fputs(
            isnan(args.given.time)
                ? ", at once; --time gives a later contact"
                : ", at once: relaxation is not computed beside a thin body, a coat or a hardness",
            out);
}

/* A force over the load. */
static void
print_force(const struct line *l, FILE *out)
{
    const struct rc_interval *c = &l->effect.change[l->figure];
    char low[SHOWN_NUMBER], high[SHOWN_NUMBER];

    fprintf(out, ": the %s is ",
            l->figure == RC_SCENE_PULL_OFF ? plain_names[l->figure] : "tangential force");
    if (c->high - c->low > 0.02 * c->high)
        fprintf(out, "%s to ", amount(RC_SCENE_FRICTION, c->low, c->high, low));
    fprintf(out, "%s times the load", amount(RC_SCENE_FRICTION, c->high, c->high, high));
}

/* Adhesion of a viscoelastic body is estimated as the load acts. */
static void
print_instant(const struct line *l, FILE *out)
{
    const struct rc_relaxation *r = run_material;
    char text[64];

    if (r == NULL || l->effect.nodes < NODES ||
        (strcmp(l->effect.name, "adhesion") != 0 && strcmp(l->effect.name, "pull-off") != 0))
        return;
    fprintf(out, "; at once, with the modulus %s", shown_in_unit(1 / r->instant, "Pa"));
    if (r->relaxed > 0)
        fprintf(out, ": --E1 %s instead of --relaxation gives the row of the relaxed body",
                scene_number_in_unit(r->relaxed, UNIT_PA, text));
}

static void
print_change(const struct line *l, FILE *out)
{
    const struct rc_interval *c = &l->effect.change[l->figure];
    char low[SHOWN_NUMBER], high[SHOWN_NUMBER];
    const char *what = plain_names[l->figure], *name = l->effect.name;
    double most = 0;

    for (int f = 0; f < RC_SCENE_FIGURES; f++)
        most = fmax(most, isnan(l->effect.change[f].high) ? 0 : l->effect.change[f].high);
    fprintf(out, "%s", rc_scene_verdict_names[l->verdict]);
    if (l->effect.unfit[0] != '\0')
        fprintf(out, ": %s", l->effect.unfit);
    else if (isinf(most) && strcmp(name, "slip") == 0)
        fputs(": the bodies slide, the force is above mu times the load", out);
    else if (isinf(most) && strcmp(name, "grid") != 0)
        fputs(": it cannot carry the load", out);
    else if (strcmp(name, "leak") == 0)
        print_leak(l, out);
    else if (most == 0)
        fputs(": changes nothing", out);
    else if (l->effect.basis != RC_SCENE_EXACT && l->effect.nodes < NODES)
        fprintf(out, ": %zu node%s in contact; refine the grid first", l->effect.nodes,
                l->effect.nodes == 1 ? "" : "s");
    else if (l->figure == RC_SCENE_PULL_OFF || strcmp(name, "rolling") == 0)
        print_force(l, out);
    else if (l->figure == RC_SCENE_FATIGUE)
        fprintf(out,
                ": the index is %s to %s, and 1 at the endurance limit, as if this surface passed "
                "over a smooth body 1; a rough body 1 needs 'rc-solve --travel'",
                amount(l->figure, c->low, c->high, low), amount(l->figure, c->high, c->high, high));
    else if (isinf(c->high))
        fputs(": the largest pressure is at the edge of the map, where it is no property of the "
              "surface",
              out);
    else if (l->verdict == RC_SCENE_NEGLIGIBLE)
        fprintf(out, ": changes the %s by at most %s", what,
                amount(l->figure, c->high, c->high, high));
    else if (c->high - c->low < 0.02 * c->high)
        fprintf(out, ": changes the %s by %s", what, amount(l->figure, c->high, c->high, high));
    else if (c->low == 0)
        fprintf(out, ": changes the %s by up to %s", what,
                amount(l->figure, c->high, c->high, high));
    else if (strcmp(amount(l->figure, c->low, c->high, low),
                    amount(l->figure, c->high, c->high, high)) == 0)
        fprintf(out, ": changes the %s by %s", what, high);
    else
        fprintf(out, ": changes the %s by %s to %s", what, low, high);
    print_instant(l, out);
    if (l->decided)
        fputs(" (computed)", out);
    fputc('\n', out);
}

static void
print_warnings(struct run *run, const struct rc_grid *g, const struct rc_contact *c,
               const double *p, double estar)
{
    const struct rc_boundary b = args.physics.boundary;
    const double part = 0.01;
    size_t least, most;
    bool edge;

    rc_extremes(g->nx * g->ny, p, &least, &most);
    edge = (!b.x && g->nx > 1 && (most % g->nx == 0 || most % g->nx == g->nx - 1)) ||
           (!b.y && g->ny > 1 && (most / g->nx == 0 || most / g->nx == g->ny - 1));
    if (edge || (rc_repeats(b) < 2 && c->edge_load_fraction > part))
        tool_warn(&run->t,
                  "%s: %s: the largest pressure is no property of the surface: take a larger map, "
                  "a smaller load, or --periodic if the surface repeats",
                  tool_where(&run->t, g),
                  edge ? "the largest pressure is at the edge of the map"
                       : "the contact reaches the edge of the map");
    if (c->max_pressure > strain * estar)
        tool_warn(&run->t,
                  "%s: the largest pressure, %s, is %.2g of %sE*: beyond 0.1 a solid is not linear "
                  "elastic",
                  tool_where(&run->t, g), shown_in_unit(c->max_pressure, "Pa"),
                  c->max_pressure / estar, run->data.material != NULL ? "the instantaneous " : "");
}

/* As a viscoelastic body creeps, its pressure over its modulus grows. */
static void
warn_of_creep(struct run *run, const struct rc_grid *g, const struct rc_scene_effect *e)
{
    const double part = number_of(e, "max_pressure_over_modulus");
    char pressure[SHOWN_NUMBER];

    if (part > strain)
        tool_warn(&run->t,
                  "%s: %s after the load acts the largest pressure, about %s, is %.2g of E* at "
                  "this time: beyond 0.1 a solid is not linear elastic",
                  tool_where(&run->t, g), shown_in_unit(args.given.time, "s"),
                  shown_in_unit_to(pressure, number_of(e, "max_pressure"), "Pa"), part);
}

/* A stress of the material without its unit, as 300 for 300MPa, is far below the pressure of the contact. */
static void
warn_of_units(struct run *run, const struct rc_grid *g, const struct rc_contact *c)
{
    const double part = 1e-4;
    const struct {
        const char *name;
        double value;
    } limit[] = {{"hardness", run->data.hardness},
                 {"yield", run->data.yield},
                 {"bending-limit", run->data.bending},
                 {"torsion-limit", run->data.torsion}};

    for (size_t k = 0; k < sizeof limit / sizeof *limit; k++)
        if (limit[k].value > 0 && limit[k].value < part * c->max_pressure)
            tool_warn(&run->t,
                      "%s: --%s, %s, is below a ten-thousandth of the largest pressure, %s: give "
                      "its unit, as in 300MPa",
                      tool_where(&run->t, g), limit[k].name, shown_in_unit(limit[k].value, "Pa"),
                      shown_in_unit(c->max_pressure, "Pa"));
}

/* The verdicts in the order of the table: what limits the others, then effects that are called for, the
 * largest first, undecided ones, negligible ones. */
static double
rank_of(const struct line *l)
{
    const double grid = strcmp(l->effect.name, "grid") == 0 && l->verdict != RC_SCENE_NEGLIGIBLE;
    const double high = l->effect.change[l->figure].high;

    return grid ? -1 : l->verdict + 1 / (2 + (isnan(high) ? 0 : fmin(high, 1e9)));
}

/* Of pointers: a command points into its line. */
static int
by_rank(const void *a, const void *b)
{
    const double x = rank_of(*(struct line *const *)a), y = rank_of(*(struct line *const *)b);

    return (x > y) - (x < y);
}

enum {
    MISSING = 96
};

/* The names of the options that an effect needs and that are not given. */
static const char *
missing_of(struct tool *t, const char *needs, const char *before, char text[MISSING])
{
    size_t n = 0;

    text[0] = '\0';
    for (const char *at = needs; *at != '\0'; at += strspn(at, " ")) {
        const int length = (int)strcspn(at, " ");
        char name[MISSING];
        snprintf(name, sizeof name, "%.*s", length, at);
        at += length;
        if (!tool_given(t, name))
            n += (size_t)snprintf(text + n, MISSING - n, "%s%s%s", n > 0 ? " " : "", before, name);
    }
    return text;
}

/* For an effect that lacks nothing but values of named materials: which body has none, and the option. */
static void
print_lacks(struct tool *t, const struct line *l, FILE *out)
{
    char missing[MISSING], name[MISSING];

    (void)missing_of(t, l->effect.missing, "", missing);
    for (const char *at = missing; *at != '\0'; at += strspn(at, " ")) {
        const int length = (int)strcspn(at, " ");
        snprintf(name, sizeof name, "%.*s", length, at);
        at += length;
        if (*materials_lack(name) == '\0')
            return;
    }
    for (const char *at = missing; *at != '\0'; at += strspn(at, " ")) {
        const int length = (int)strcspn(at, " ");
        snprintf(name, sizeof name, "%.*s", length, at);
        at += length;
        fprintf(out, "  %s cannot be judged: %s: give --%s\n", l->effect.title,
                materials_lack(name), name);
    }
}

static void
print_table(struct run *run, const struct rc_grid *g, const struct rc_contact *c,
            struct line *const line[], size_t n, const char *file)
{
    FILE *out = run->t.output.file;
    bool first = true;

    fprintf(out, "%s, case %zu: %zu x %zu nodes, %s, contact %.3g %%, largest pressure %s",
            rc_grid_get(g, "source") == NULL ? file : rc_grid_get(g, "source"), rc_grid_case(g),
            g->nx, g->ny, shown_in_unit(c->load, "N"), 100 * c->contact_fraction,
            shown_in_unit(c->max_pressure, "Pa"));
    if (isfinite(c->approach))
        fprintf(out, ", approach %s", shown_in_unit(c->approach, "m"));
    fputc('\n', out);
    for (size_t k = 0; k < n; k++) {
        if (line[k]->verdict == RC_SCENE_MISSING)
            continue;
        fprintf(out, "  %-30s ", line[k]->effect.title);
        print_change(line[k], out);
        if (line[k]->why[0] != '\0')
            fprintf(out, "      no tool computes it: %s\n", line[k]->why);
        if (line[k]->not_computed != NULL)
            fprintf(out, "      not computed: %s\n", line[k]->not_computed);
        if (!line[k]->commanded || line[k]->decided)
            continue;
        fputs("      ", out);
        scene_show(&line[k]->command, line[k]->effect.name, file, out);
        if (!isnan(line[k]->seconds))
            fprintf(out, "   (about %.2g s)", line[k]->seconds);
        fputc('\n', out);
    }
    for (size_t k = 0; k < n; k++) {
        char missing[MISSING];
        if (line[k]->verdict != RC_SCENE_MISSING)
            continue;
        fprintf(out, "%s%s (%s)", first ? "  data missing: " : ", ", line[k]->effect.title,
                missing_of(&run->t, line[k]->effect.missing, "--", missing));
        first = false;
    }
    fputs(first ? "" : "\n", out);
    for (size_t k = 0; k < n; k++)
        if (line[k]->verdict == RC_SCENE_MISSING)
            print_lacks(&run->t, line[k], out);
}

static void
put_effect(struct tool *t, struct report *r, const struct line *l)
{
    RC_OWNED char *sentence = NULL;
    size_t size;
    char missing[MISSING];
    FILE *text = open_memstream(&sentence, &size);

    report_object(r, NULL);
    report_text(r, "effect", l->effect.name);
    report_text(r, "title", l->effect.title);
    report_text(r, "verdict", rc_scene_verdict_names[l->verdict]);
    if (text != NULL && l->verdict != RC_SCENE_MISSING)
        print_change(l, text);
    if (text == NULL || fclose(text) != 0)
        tool_die(t, "out of memory");
    sentence[strcspn(sentence, "\n")] = '\0';
    report_text(r, "sentence", sentence[0] == '\0' ? NULL : sentence);
    report_text(r, "basis",
                l->verdict == RC_SCENE_MISSING ? NULL : rc_scene_basis_names[l->effect.basis]);
    report_text(r, "missing",
                l->effect.missing == NULL ? NULL : missing_of(t, l->effect.missing, "", missing));
    report_text(r, "unfit", l->effect.unfit[0] == '\0' ? NULL : l->effect.unfit);
    report_bool(r, "decided", l->decided);
    report_object(r, "figures");
    for (int f = 0; f < RC_SCENE_FIGURES; f++)
        if (!isnan(l->effect.change[f].high)) {
            report_object(r, rc_scene_figure_names[f]);
            report_number(r, "low", l->effect.change[f].low, NULL);
            report_number(r, "high", l->effect.change[f].high, NULL);
            report_end(r);
        }
    report_end(r);
    report_object(r, "numbers");
    for (int k = 0; k < RC_SCENE_NUMBERS && l->effect.number_name[k] != NULL; k++)
        report_number(r, l->effect.number_name[k], l->effect.number[k], NULL);
    report_end(r);
    report_array(r, "command");
    for (size_t p = 0; l->commanded && p < l->command.programs; p++) {
        if (p > 0)
            report_text(r, NULL, "|");
        for (size_t k = 0; l->command.word[p][k] != NULL; k++)
            report_text(r, NULL, l->command.word[p][k]);
    }
    report_end(r);
    report_text(r, "refused", l->why[0] == '\0' ? NULL : l->why);
    report_text(r, "not_computed", l->not_computed);
    report_number(r, "forecast_convolutions", l->convolutions, NULL);
    report_number(r, "forecast_seconds", l->seconds, "s");
    report_end(r);
}

static void
put_report(struct run *run, const struct rc_grid *g, const struct rc_scene *s,
           const struct rc_contact *c, struct line *const line[], size_t n, double seconds)
{
    struct report *r = &run->report;

    if (r->separator != 0) { /* a row for each effect */
        for (size_t k = 0; k < n; k++) {
            const struct rc_interval *at = &line[k]->effect.change[line[k]->figure];
            report_begin(r);
            report_map(r, g, rc_grid_case(g));
            report_number(r, "load", c->load, "N");
            report_text(r, "effect", line[k]->effect.name);
            report_text(r, "verdict", rc_scene_verdict_names[line[k]->verdict]);
            report_text(r, "figure", rc_scene_figure_names[line[k]->figure]);
            report_number(r, "low", at->low, NULL);
            report_number(r, "high", at->high, NULL);
            report_number(r, "forecast_seconds", line[k]->seconds, "s");
            report_finish_row(r);
        }
        return;
    }
    report_begin(r);
    report_map(r, g, rc_grid_case(g));
    boundary_report(r, g, args.physics.boundary);
    report_number(r, "load", c->load, "N");
    report_number(r, "within", args.within, NULL);
    report_number(r, "contact_area", c->contact_area, "m2");
    report_number(r, "contact_fraction", c->contact_fraction, NULL);
    report_number(r, "max_pressure", c->max_pressure, "Pa");
    report_number(r, "approach", c->approach, "m");
    report_count(r, "contact_nodes", c->contact_nodes, NULL);
    report_number(r, "pressure_error_estimate", c->pressure_error, NULL);
    report_array(r, "scene");
    for (size_t k = 0; k < n; k++)
        put_effect(&run->t, r, line[k]);
    report_end(r);
    report_number(r, "convolutions", rc_scene_convolutions(s), NULL);
    report_seconds(r, (const struct report_phase[]){{NULL, 0}}, seconds);
    report_memory(r);
    report_finish_row(r);
}

/* Contacts that the rows solve beside the elastic one, some more than one. */
static void
show_plan(struct run *run, const struct rc_grid *g, size_t step)
{
    const struct rc_scene_data *d = &run->data;
    struct rc_problem problem = physics_problem(&args.physics, g, step);
    struct rc_expected expected;
    const struct plan plan = plan_begin(&run->t, &run->report, g, rc_grid_case(g),
                                        rc_boundary_word(args.physics.boundary), "");
    const struct {
        bool given;
        size_t contacts;
    } rows[] = {
        {d->hardness > 0, 1},
        {d->layers > 0, 1},
        {d->thickness > 0, 1},
        {d->tangential > 0, 1},
        {d->wear > 0, 1},
        {d->work > 0, 8}, /* and pull-off */
        {d->material != NULL, 1},
        {d->speed > 0 && d->material != NULL, 1},
        {d->mu > 0 && (d->creep[0] != 0 || d->creep[1] != 0 || d->spin != 0), 8},
    };
    size_t contacts = 2; /* with a free tilt */

    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        contacts += rows[k].given ? rows[k].contacts : 0;
    problem.threads = run->t.threads;
    problem.discretization = true;
    problem.hardness = 0;
    problem.pair.one.layers = 0;
    tool_must(&run->t, g, rc_solver_expect(rc_shape_of(g), &problem, &expected, &run->t.err));
    plan_say(&plan, "contacts", "%zu", contacts);
    plan_end(
        &plan, expected.convolutions * (double)contacts, expected.seconds * (double)contacts,
        tool_memory_with(expected.memory +
                         (d->material != NULL ? 15 : 12) * rc_grid_nodes(g) *
                             sizeof *g->v)); /* maps of three contacts, and of the relaxed one */
}

/* Largest speed of a rigid surface over the other in a contact that rolls, m/s: the spin turns about the
 * middle of the map. Without --creep the bodies slide. */
static double
sliding_speed(const struct run *run, const struct rc_grid *g, const double *p)
{
    const struct rc_scene_data *d = &run->data;
    double far = 0;

    if (!rolls(run))
        return d->speed;
    for (size_t k = 0; k < g->nx * g->ny; k++)
        if (rc_in_contact(p[k]))
            far = fmax(far, hypot(((double)(k % g->nx) - (double)(g->nx - 1) / 2) * g->dx,
                                  ((double)(k / g->nx) - (double)(g->ny - 1) / 2) * g->dy));
    return d->speed * (hypot(d->creep[0], d->creep[1]) + fabs(d->spin) * far);
}

/* The heat of bodies that slide at the speed of rolling becomes that of bodies that roll. Heat is made with
 * the sliding speed, and where they stick there is none: no lower bound. Both bodies move past the contact,
 * each with its Peclet number. Where elastic slip adds to the creepage, at the trailing edge, mu p times
 * the local slip is up to sqrt(2) times as large (Carter 1926, Proc. R. Soc. A 112, 151). */
static void
make_rolling(const struct run *run, double slides, struct rc_scene_effect *e)
{
    const struct rc_scene_data *d = &run->data;
    const double local = 1.5;
    double part = 0, k = 0, still, rolling;

    if (e->missing != NULL)
        return;
    if (args.physics.boundary.x) {
        e->change[RC_SCENE_TEMPERATURE] = (struct rc_interval){NAN, NAN};
        snprintf(e->unfit, sizeof e->unfit, "steady rolling needs a map that is free along x");
    }
    if (e->unfit[0] != '\0')
        return;
    for (int b = 0; b < 2; b++) { /* number 2: the Peclet number of body 2 */
        const double peclet = e->number[2] * d->diffusivity[1] / d->diffusivity[b];
        k += d->conductivity[b];
        part += d->conductivity[b] * sqrt(1 + 2 * peclet);
    }
    e->number_name[3] = "sliding_speed";
    e->number[3] = slides;
    e->number[0] *= slides / d->speed;
    still = e->number[0];
    rolling = e->number[1] = still * k / part;
    e->change[RC_SCENE_TEMPERATURE] =
        (struct rc_interval){0, local * fmin(1.02 * still, 3 * rolling)};
}

/* Wear of a contact that rolls needs a number of passes; a contact that stays and slides wears otherwise. */
static void
leave_wear(struct rc_scene_effect *e)
{
    if (e->missing != NULL)
        return;
    for (int f = 0; f < RC_SCENE_FIGURES; f++)
        e->change[f] = (struct rc_interval){NAN, NAN};
    snprintf(e->unfit, sizeof e->unfit,
             "a rolling contact slides by its creepage alone: rc-slip --steady --output "
             "height,pressure,slip, then rc-wear --cycles instead of --distance");
}

static void
do_load(struct run *run, const struct rc_grid *g, size_t step)
{
    static struct line line[LINES];
    struct line *sorted[LINES];
    struct tool *t = &run->t;
    const struct numbers *steps = physics_steps(&args.physics);
    const double began = tool_now();
    struct rc_problem problem = physics_problem(&args.physics, g, step);
    char value[64];
    const char *const load[2] = {args.physics.load.n > 0            ? "--load"
                                 : args.physics.mean_pressure.n > 0 ? "--mean-pressure"
                                                                    : "--approach",
                                 value};
    struct rc_contact contact;
    const char *with = "";
    double slides;
    size_t n = 0, effects = 0;

    while (rc_scene_name(effects) != NULL)
        effects++;
    if (args.physics.load.per_metre)
        snprintf(value, sizeof value, "%sN/m", rc_number(steps->v[step]));
    else
        scene_number_in_unit(steps->v[step],
                             args.physics.load.n > 0            ? UNIT_N
                             : args.physics.mean_pressure.n > 0 ? UNIT_PA
                                                                : UNIT_M,
                             value);
    problem.threads = t->threads;
    problem.tol = 1e-4;
    struct rc_scene *s =
        tool_made(t, g, rc_scene_new(rc_shape_of(g), g->v, &problem, &run->data, &t->err));

    contact = *rc_scene_contact(s);
    print_warnings(run, g, &contact, rc_scene_pressure(s), args.physics.surface_estar);
    warn_of_units(run, g, &contact);
    slides = sliding_speed(run, g, rc_scene_pressure(s));
    scene_notes(t, g, &args.given,
                &(struct scene_notes){.contact = &contact,
                                      .pair = &problem.pair,
                                      .estar = args.physics.surface_estar,
                                      .radius = args.physics.radius,
                                      .conductivity = run->data.conductivity[0],
                                      .within = args.within,
                                      .entrains = run->data.speed / (rolls(run) ? 1 : 2),
                                      .slides = slides});
    for (size_t k = 0; rc_scene_name(k) != NULL && n < LINES; k++, n++) {
        struct line *l = &line[n];
        *l = (struct line){.seconds = NAN, .convolutions = NAN, .with = ""};
        tool_progress(t, (double)k / (double)effects, "%s", rc_scene_name(k));
        l->base = strcmp(rc_scene_name(k), "yield") == 0 ? contact : *rc_scene_contact(s);
        tool_must(t, g, rc_scene_estimate(s, k, &l->effect, &t->err));
        if (rolls(run) && strcmp(l->effect.name, "heat") == 0)
            make_rolling(run, slides, &l->effect);
        if (wears_by_rolling(run, l))
            leave_wear(&l->effect);
        l->verdict = rc_scene_judge(&l->effect, &run->bounds, &l->figure);
        if (strcmp(l->effect.name, "relaxation") == 0)
            warn_of_creep(run, g, &l->effect);
        l->with = with;
        if (l->verdict == RC_SCENE_CALLS) {
            rc_scene_accept(s, k);
            with = strcmp(rc_scene_name(k), "coat") == 0       ? "layer"
                   : strcmp(rc_scene_name(k), "hardness") != 0 ? with
                   : strcmp(with, "layer") == 0                ? "layer hardness"
                                                               : "hardness";
        }
    }
    tool_progress_end(t);
    name_commands(run, g, line, n, load);
    for (size_t k = 0; k < n; k++)
        sorted[k] = &line[k];
    qsort(sorted, n, sizeof *sorted, by_rank);
    if (!t->output.report_alone)
        print_table(run, g, &contact, sorted, n, t->input.source);
    if (report_wanted(&run->report))
        put_report(run, g, s, &contact, sorted, n, tool_now() - began);
    rc_scene_free(s);
}

int
main(int argc, char **argv)
{
    static struct run run;
    struct rc_grid *g;

    tool_start(&run.t, &info, argc, argv, &args);
    read_data(&run);
    report_open(&run.report, &run.t, args.report);
    while ((g = tool_channel(&run.t, "height", false)) != NULL) {
        run.in = scene_file(&run.t); /* without the ball, which the commands add */
        write_heights(&run.t, g, run.in);
        physics_heights(&run.t, &args.physics, g);
        for (size_t k = 0; k < physics_steps(&args.physics)->n; k++)
            (args.dry_run ? show_plan : do_load)(&run, g, k);
        (void)close(run.in);
        rc_grid_free(g);
    }
    report_close(&run.report);
    rc_relaxation_free(run.material.material);
    return tool_finish(&run.t);
}
