/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Temperatures of a contact whose bodies slide: flash temperatures of both surfaces. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tools/frames/frames.h"
#include "tools/materials/materials.h"
#include "tools/model/model.h"

static struct args {
    const char *conductivity, *moving, *partition, *report;
    struct numbers speed, diffusivity, capacity, bulk, depths;
    double mu, time, tol, frequency, rolling;
    size_t time_steps, output;
    bool dry_run;
} args = {.moving = "2", .partition = "matched", .mu = NAN, .tol = 1e-3, .output = 31};

static const char *const frames[] = {"temperature-1", "temperature-2", "heat-1",
                                     "heat-2",        CONTACT_CHANNEL, NULL};

static const char *const partitions[] = {
    [RC_HEAT_MATCHED] = "matched", [RC_HEAT_BLOK] = "blok", [RC_HEAT_CHARRON] = "charron", NULL};

#define AT(field) .at = offsetof(struct args, field)
#define ABOVE_0 .min = 0, .max = INFINITY, .above = true, .result = true
/* clang-format off */
static const struct opt opts[] = {
    {.name = "mu", .type = OPT_NUMBER, AT(mu), .min = 0, .max = INFINITY, .result = true,
     .arg = "COEFFICIENT",
     .against = RULES({.with = "frequency|rolling", .because = "each is a source of heat"}),
     .help = "coefficient of friction: the heat is mu times pressure times speed"},
    {.name = "frequency", .type = OPT_NUMBER, .unit = UNIT_HZ, AT(frequency), ABOVE_0, .arg = "F",
     .against = RULES({.with = "rolling", .because = "each is a source of heat"}),
     .help = "cycles per second: heat from the frames dissipation of rc-slip, summed over the cases"},
    {.name = "rolling", .type = OPT_NUMBER, .unit = UNIT_SPEED, AT(rolling), ABOVE_0, .arg = "V",
     .against = RULES({.with = "speed|moving",
                      .because = "the speed of rolling and the creepages of the stream give both motions"}),
     .help = "speed of rolling towards +x: heat from the frame dissipation of rc-slip --creep"},
    {.name = "speed", .type = OPT_NUMBERS, .unit = UNIT_SPEED, AT(speed), .min = -INFINITY,
     .max = INFINITY, .result = true, .arg = "VX[,VY]", .help = "sliding speed along x and y"},
    {.name = "conductivity", .type = OPT_TEXT, AT(conductivity), .result = true, .arg = "K1,K2",
     .one_of = RULES({.with = "conductivity", .remedy = "as in --conductivity 45W/mK,16W/mK"}),
     .help = "thermal conductivities of both bodies, as in 45W/mK,16W/mK"},
    {.name = "diffusivity", .type = OPT_NUMBERS, .unit = UNIT_DIFFUSIVITY, AT(diffusivity), ABOVE_0,
     .arg = "A1,A2",
     .one_of = RULES({.with = "diffusivity|heat-capacity"}),
     .help = "thermal diffusivities of both bodies, as in 12mm2/s,4mm2/s"},
    {.name = "heat-capacity", .type = OPT_NUMBERS, .unit = UNIT_HEAT, AT(capacity), ABOVE_0,
     .arg = "C1,C2", .help = "instead: heat capacities by volume, as in 3.7MJ/m3K,4MJ/m3K"},
    {.name = "moving", .type = OPT_TEXT, AT(moving), .result = true, .arg = "1|2|V1,V2",
     .help = "the body that moves past the contact (default 2), or both speeds along x, without --speed"},
    {.name = "bulk", .type = OPT_NUMBERS, .unit = UNIT_K, AT(bulk), .min = -INFINITY, .max = INFINITY,
     .result = true, .arg = "T1,T2",
     .help = "temperatures of both bodies far from the contact, as in 20degC,60degC (default 0,0)"},
    {.name = "time", .type = OPT_NUMBER, .unit = UNIT_S, AT(time), ABOVE_0, .arg = "TIME",
     .help = "time since heating began (default: steady state); needed where both axes repeat, or one of "
             "them and a body does not move along the other"},
    {.name = "time-steps", .type = OPT_COUNT, AT(time_steps), .min = 1, .max = 1000, .result = true,
     .arg = "N",
     .help = "steps of --time in which the shares of the bodies are found anew (default: as many as "
             "--tol needs)"},
    {.group = material_options},
    {.name = "partition", .type = OPT_TEXT, AT(partition), .list = partitions, .result = true,
     .arg = "matched|blok|charron|SHARE",
     .help = "heat of each body: equal temperatures at every node (default), or one number for all"},
    {.name = "depths", .type = OPT_NUMBERS, .unit = UNIT_M, AT(depths), .min = 0, .max = INFINITY,
     .result = true, .arg = "LIST", .help = "depths of the temperatures (default 0)"},
    {.name = "tol", .type = OPT_NUMBER, AT(tol), .min = 0, .max = 0.5, .above = true, .result = true,
     .arg = "ERROR",
     .help = "bound of the mismatch of the temperatures, and of the error of the time steps (default "
             "1e-3)"},
    {.name = "output", .type = OPT_WORDS, AT(output), .list = frames, .arg = "LIST",
     .help = "frames to write, of %s (default: all)"},
    {.name = "report", .type = OPT_REPORT, AT(report), .arg = "FILE",
     .help = "write one JSON object per case, or a row of FILE.tsv or .csv: temperatures, shares"},
    {.name = "dry-run", .type = OPT_FLAG, AT(dry_run), .text = true,
     .help = "print the expected memory and time, and stop"},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-heat",
    .summary = "Flash temperatures of a contact whose bodies slide",
    .operands = "[FILE...]",
    .examples = "  rc-solve --load 5N --radius 5mm --estar 114GPa --hardness 6GPa surface.rcg |\n"
                "      rc-heat --mu 0.3 --speed 1m/s --conductivity 45W/mK,45W/mK \\\n"
                "          --diffusivity 12mm2/s,12mm2/s --report heat.tsv -o hot.rcg\n"
                "  rc-solve --load 1N --radius 2mm --E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3 \\\n"
                "      -o contact.rcg surface.rcg\n"
                "  rc-slip --mu 0.6 --path '1N,0,0; 1N,0.4N,0; 1N,-0.4N,0; 1N,0.4N,0' \\\n"
                "      --output pressure,dissipation contact.rcg | rc-pick --case 3,4 |\n"
                "      rc-heat --frequency 50Hz --conductivity 45W/mK,45W/mK \\\n"
                "          --diffusivity 12mm2/s,12mm2/s --report fretting.tsv -o warm.rcg\n",
    .opts = opts,
    .figures = (const char *const[]){"heat", NULL},
    .shares = true,
    .fill = materials_fill,
    .of_materials = (const char *const[]){"conductivity", "diffusivity", NULL},
    .reads = READS_STREAM,
    .writes = WRITES_STREAM,
};

struct run {
    struct tool t;
    struct report report;
    struct rc_heat_problem problem;
    struct rc_grid *pressure, *contact; /* of the case beside its main frame; NULL: none */
    const char *channel;                /* of the main frame: pressure, dissipation or heat */
    double
        *touch;   /* 1 at the nodes in contact, in any case of a cycle; NULL: where heat is not 0 */
    double speed; /* m/s, of sliding                                                          */
    double creep[2], spin; /* of a contact that rolls: 1, rad/m; NAN: unknown */
};

/* ---- the command line ---- */

/* Two numbers, one for each body. */
static const double *
pair_of(struct tool *t, const char *name, const struct numbers *list)
{
    if (list->n != 2)
        tool_usage(t, "--%s: give two numbers, for body 1 and body 2", name);
    return list->v;
}

static void
read_motion(struct run *run)
{
    struct tool *t = &run->t;
    struct rc_heat_body *body = run->problem.body;
    const int one = strcmp(args.moving, "1") == 0 ? 0 : strcmp(args.moving, "2") == 0 ? 1 : -1;
    struct numbers v = args.speed;
    struct rc_err err;

    if (one < 0 && v.n > 0)
        tool_usage(t, "--moving %s has the speeds of both bodies: leave out --speed, or say 1 or 2",
                   args.moving);
    if (one < 0 && (unit_numbers(args.moving, UNIT_SPEED, &v, &err) != RC_OK || v.n != 2))
        tool_usage(t,
                   "--moving %s: it must be 1, 2 or the speeds of both bodies along x, as in "
                   "1m/s,0.8m/s",
                   args.moving);
    if (v.n > 2)
        tool_usage(t, "--speed: it must be one value (along x) or two (x and y)");
    for (size_t k = 0; k < v.n; k++)
        body[one < 0 ? k : (size_t)one].velocity[one < 0 ? 0 : k] = v.v[k];
    if (one < 0)
        free(v.v);
    run->speed =
        hypot(body[1].velocity[0] - body[0].velocity[0], body[1].velocity[1] - body[0].velocity[1]);
}

static void
read_source(struct run *run)
{
    struct tool *t = &run->t;
    const bool friction = tool_given(t, "mu"), cycles = tool_given(t, "frequency");
    const bool rolls = tool_given(t, "rolling");

    if (friction && run->speed * args.mu == 0 &&
        run->problem.body[0].bulk == run->problem.body[1].bulk)
        tool_usage(t,
                   "%s, so that friction makes no heat, and the bodies have the same bulk "
                   "temperature: give %s, or two temperatures with --bulk",
                   run->speed == 0 ? "the bodies do not slide" : "--mu is 0",
                   run->speed == 0 ? "a speed with --speed, as in --speed 1m/s"
                                   : "a coefficient above 0");
    if (friction && run->speed * args.mu == 0 && run->problem.partition != RC_HEAT_MATCHED)
        tool_usage(t,
                   "--partition %s shares the heat of friction, and there is none: leave it out, "
                   "for the heat between the bulk temperatures",
                   args.partition);
    run->channel = friction ? "pressure" : cycles || rolls ? "dissipation" : "heat";
}

static void
read_partition(struct run *run)
{
    struct rc_heat_problem *p = &run->problem;
    struct rc_err err;
    size_t k = 0;

    while (partitions[k] != NULL && strcmp(args.partition, partitions[k]) != 0)
        k++;
    p->partition = (enum rc_heat_partition)k;
    if (p->partition == RC_HEAT_SHARE &&
        (unit_number(args.partition, UNIT_NONE, &p->share, &err) != RC_OK ||
         !(p->share >= 0 && p->share <= 1)))
        tool_usage(&run->t,
                   "--partition %s: it must be matched, blok, charron, or the share of body 1 from "
                   "0 to 1",
                   args.partition);
    if (args.time_steps > 1 && !tool_given(&run->t, "time"))
        tool_usage(&run->t, "--time-steps needs --time");
    p->time_steps = args.time_steps;
}

static void
read_options(struct run *run)
{
    struct tool *t = &run->t;
    const bool capacity = tool_given(t, "heat-capacity");
    struct rc_heat_problem *p = &run->problem;
    const char *unit;
    double k[2];

    if (unit_conductivities(args.conductivity, k, &unit, &t->err) != RC_OK)
        tool_usage(t, "--conductivity %s: %s", args.conductivity, t->err.text);
    if (unit != NULL && strcmp(unit, "W/K") != 0)
        tool_usage(t, "--conductivity %s: it must be thermal, in W/mK", args.conductivity);
    for (int b = 0; b < 2; b++) {
        p->body[b].conductivity = k[b];
        p->body[b].diffusivity = capacity ? k[b] / pair_of(t, "heat-capacity", &args.capacity)[b]
                                          : pair_of(t, "diffusivity", &args.diffusivity)[b];
        if (args.bulk.n > 0)
            p->body[b].bulk = pair_of(t, "bulk", &args.bulk)[b];
    }
    p->time = args.time;
    p->tol = args.tol;
    p->threads = t->threads;
    p->ranks = ranks_of(t);
    read_motion(run);
    read_partition(run);
    read_source(run);
}

/* ---- a case ---- */

static bool
any_heat(const struct tool *t, const struct rc_grid *g)
{
    size_t k = 0;

    while (k < rc_grid_nodes(g) && g->v[k] == 0)
        k++;
    return ranks_most(t, k < rc_grid_nodes(g)) > 0;
}

/* Friction of bodies that attract each other is refused: the first node with a pressure below 0. */
static void
demand_positive(struct tool *t, const struct rc_grid *p)
{
    struct rc_err *err = &t->err;
    enum rc_status status = RC_OK;
    size_t first, rows;

    ranks_rows(t, rc_shape_of(p), &first, &rows);
    for (size_t k = 0; k < rc_grid_nodes(p) && status == RC_OK; k++)
        if (p->v[k] < 0)
            status = rc_err_set(err,
                                "pressure %g Pa at column %zu, row %zu: friction of bodies that "
                                "attract each other is not implemented: give the heat in a frame "
                                "heat",
                                p->v[k], k % p->nx, first + k / p->nx);
    if (ranks_agree(t, status, err) != RC_OK)
        tool_refuse(t, p, "%s", err->text);
}

static double
known(double v)
{
    return isnan(v) ? 0 : v;
}

/* The motion of both bodies past a contact that rolls towards +x, from the creepages of the case.
 * Without them it has not rolled yet. */
static void
find_rolling(struct run *run, const struct rc_grid *g)
{
    struct rc_heat_body *body = run->problem.body;
    double *creep = run->creep;

    creep[0] = creep[1] = run->spin = NAN;
    (void)rc_grid_number(g, "spin", &run->spin);
    if ((!rc_grid_number(g, "creep_x", &creep[0]) || !rc_grid_number(g, "creep_y", &creep[1])) &&
        any_heat(&run->t, g))
        tool_refuse(&run->t, g,
                    "it has no keys creep_x and creep_y: --rolling takes the output of "
                    "rc-slip --creep or --creep-force");
    body[0].velocity[0] = -args.rolling;
    body[1].velocity[0] = args.rolling * (known(creep[0]) - 1);
    body[1].velocity[1] = args.rolling * known(creep[1]);
    run->speed = args.rolling * hypot(known(creep[0]), known(creep[1]));
}

/* Checks the main frame. Its heat flux is the values times this factor: friction times speed,
 * frequency, or speed of rolling. */
static double
heat_factor(struct run *run, const struct rc_grid *g)
{
    const bool friction = tool_given(&run->t, "mu"), cycles = tool_given(&run->t, "frequency"),
               rolls = tool_given(&run->t, "rolling");
    const char *unit = friction ? "Pa" : cycles ? "J/m2" : rolls ? "J/m3" : "W/m2";
    const double factor = friction ? args.mu * run->speed
                          : cycles ? args.frequency
                          : rolls  ? args.rolling
                                   : 1;

    tool_demand_finite(&run->t, g, "recompute the map");
    if (rc_grid_get(g, "layers") != NULL)
        tool_refuse(
            &run->t, g,
            "its body 1 has layers, and rc-heat supports only bodies of one material: where "
            "the layers conduct as the substrate does, remove the key with rc-pick --set "
            "layers=");
    if (cycles && strcmp(g->unit, "J/m3") == 0)
        tool_refuse(&run->t, g,
                    "it is the energy per length rolled, in J/m3: give the speed of rolling "
                    "with --rolling instead of --frequency");
    if (rolls && strcmp(g->unit, "J/m2") == 0)
        tool_refuse(&run->t, g,
                    "it is the energy of a part of a cycle, in J/m2: give the cycles per "
                    "second with --frequency instead of --rolling");
    if (strcmp(g->unit, unit) != 0)
        tool_refuse(&run->t, g, "its unit is '%s': it must be %s", g->unit, unit);
    if (friction)
        tool_demand_full_sliding(
            &run->t, g,
            "take rc-slip --output pressure,dissipation, and --rolling for a contact "
            "that rolls or --frequency for a cycle instead of --mu");
    if (rolls)
        find_rolling(run, g);
    if (friction)
        demand_positive(&run->t, g);
    return factor;
}

/* Adds the nodes in contact of a case, and those that slipped in a cycle or left the contact in a step. */
static void
add_contact(struct run *run, const struct rc_grid *g)
{
    const struct rc_grid *p = tool_given(&run->t, "mu") ? g : run->pressure, *touch;
    const size_t n = rc_grid_nodes(g);

    if (p == NULL && run->contact == NULL)
        return;
    touch = contact_demand(&run->t, p, run->contact);
    tool_demand_grid_of(&run->t, touch, g);
    if (run->touch == NULL) {
        run->touch = tool_room(&run->t, n, sizeof *run->touch, "the contact");
        memset(run->touch, 0, n * sizeof *run->touch);
    }
    for (size_t k = 0; k < n; k++)
        if (rc_in_contact(touch->v[k]) ||
            (strcmp(run->channel, "dissipation") == 0 && g->v[k] != 0))
            run->touch[k] = 1;
}

/* The heat of the next case, or of all cases, which are one cycle. */
static struct rc_grid *
next_heat(struct run *run)
{
    struct tool_frame beside[] = {
        {CONTACT_CHANNEL, &run->contact}, {"pressure", &run->pressure}, {NULL, NULL}};
    struct rc_grid *g, *sum = NULL;

    if (tool_given(&run->t, "mu"))
        beside[1] = beside[2];
    while ((g = tool_channel_with(&run->t, run->channel, tool_take_frames, beside)) != NULL) {
        const double factor = heat_factor(run, g);
        if (sum != NULL)
            tool_demand_grid_of(&run->t, g, sum);
        add_contact(run, g);
        for (size_t k = 0; k < rc_grid_nodes(g); k++)
            g->v[k] = factor * g->v[k] + (sum != NULL ? sum->v[k] : 0);
        rc_grid_free(sum);
        tool_free_frames(beside);
        sum = g;
        if (!tool_given(&run->t, "frequency"))
            break;
    }
    return sum;
}

static void
write_frame(struct run *run, const struct rc_grid *like, struct rc_heat *h, size_t kind,
            double depth)
{
    const struct rc_heat_figures *f = rc_heat_result(h);
    static const char *const units[] = {"K", "K", "W/m2", "W/m2", "1"};
    const int body = (int)(kind % 2);
    const bool heat = kind >= 2;
    RC_OWN(rc_grid, g) = tool_frame_like(&run->t, like, NULL, frames[kind], units[kind]);

    tool_set_number(&run->t, g, "max_temperature", f->max_temperature);
    if (!heat)
        tool_set_number(&run->t, g, "depth", depth);
    tool_set(&run->t, g, "converged", f->converged ? "yes" : "no");
    tool_sign(&run->t, g);
    if (!heat)
        tool_must(&run->t, like, rc_heat_temperature(h, body, depth, g->v, &run->t.err));
    for (size_t k = 0; k < rc_grid_nodes(g) && heat; k++)
        g->v[k] = kind < 4             ? rc_heat_flux(h, body)[k]
                  : run->touch != NULL ? run->touch[k]
                                       : like->v[k] != 0;
    tool_write(&run->t, g);
}

static const char *
boundary(const struct run *run)
{
    return rc_boundary_word(run->problem.boundary);
}

/* The effects of this case: computed, or why not. */
static const struct effect_state *
effects(const struct run *run)
{
    static const char *const partition[] = {
        [RC_HEAT_MATCHED] = "on: equal temperatures at each node",
        [RC_HEAT_BLOK] = "on: one share, for equal largest temperatures",
        [RC_HEAT_CHARRON] = "on: one share, of bodies that do not move",
        [RC_HEAT_SHARE] = "left out: --partition gives the share"};
    static const char at_rest[] = "left out: the heat does not move over it";
    static struct effect_state list[7];
    const struct rc_heat_problem *p = &run->problem;
    const bool below = args.depths.n > 1 || args.depths.v[0] > 0;

    list[0] = (struct effect_state){"partition", partition[p->partition]};
    list[1] = (struct effect_state){"transient",
                                    p->time > 0 ? "on" : "left out: no --time, a steady state"};
    for (int b = 0; b < 2; b++)
        list[2 + b] = (struct effect_state){
            b == 0 ? "motion_1" : "motion_2",
            p->body[b].velocity[0] != 0 || p->body[b].velocity[1] != 0 ? "on" : at_rest};
    list[4] = (struct effect_state){
        "bulk", p->body[0].bulk != p->body[1].bulk ? "on" : "left out: equal bulk temperatures"};
    list[5] = (struct effect_state){"depths", below ? "on" : "left out: no --depths below 0"};
    return list;
}

static void
put_report(struct run *run, const struct rc_grid *g, const struct rc_heat_figures *f,
           double seconds)
{
    struct report *r = &run->report;

    report_begin(r);
    report_map(r, g, rc_grid_case(g));
    report_text(r, "boundary", boundary(run));
    report_count(r, "threads", run->t.threads, NULL);
    report_value(r, "speed", run->speed);
    report_table(r, rc_figures("heat"), f);
    if (rc_repeats(run->problem.boundary) == 1)
        report_number(r, "heat_power_per_metre",
                      f->heat_power /
                          (run->problem.boundary.x ? (double)g->nx * g->dx : (double)g->ny * g->dy),
                      "W/m");
    report_number(r, "tol", args.tol, NULL);
    report_effects(r, effects(run));
    report_seconds(r, (const struct report_phase[]){{NULL, 0}}, seconds);
    report_memory(r);
    report_ranks(r, &run->t);
    if (tool_given(&run->t, "rolling")) {
        report_value(r, "rolling_speed", args.rolling);
        report_value(r, "creep_x", run->creep[0]);
        report_value(r, "creep_y", run->creep[1]);
        report_value(r, "spin", run->spin);
    }
    report_finish_row(r);
}

enum {
    FEW = 10 /* nodes along the motion: with fewer the trailing edge is more than 3 % hotter */
};

/* True if rc-add made the height of the contact from two surfaces. */
static bool
adds_surfaces(const struct rc_grid *g)
{
    const char *history = rc_grid_get(g, "history");
    const char *step = history == NULL ? NULL : strstr(history, "rc-add ");
    const char *subtract = step == NULL ? NULL : strstr(step, "--subtract");

    return step != NULL && (subtract == NULL || subtract > step + strcspn(step, "|"));
}

static void
judge(struct run *run, const struct rc_grid *g, const struct rc_heat_figures *f)
{
    struct tool *t = &run->t;
    const double m = (double)f->hot_nodes;
    const char *where = tool_where(t, g);

    if (run->speed > 0 && strchr(args.moving, ',') == NULL && !tool_given(t, "rolling") &&
        adds_surfaces(g))
        tool_warn(t,
                  "%s: its height is the sum of two rough surfaces, whose spots last only for a "
                  "passage: with spots that stay on body %d the temperatures are too high",
                  where, *args.moving == '1' ? 2 : 1);
    if (f->hot_nodes < FEW && fmax(f->cell_peclet_1, f->cell_peclet_2) > 1)
        tool_warn(
            t,
            "%s: the hottest spot has %zu node%s along the motion, and the Peclet number of a cell "
            "is %.3g: its trailing edge is up to %.0f %% hotter than its last node: take a finer "
            "grid",
            where, f->hot_nodes, f->hot_nodes == 1 ? "" : "s",
            fmax(f->cell_peclet_1, f->cell_peclet_2), 100 * (sqrt(m / (m - 0.5)) - 1));
    if (f->max_temperature > 1000)
        tool_warn(t,
                  "%s: the largest temperature is %.4g K above the bulk of body 1: friction, "
                  "conductivity and hardness change far below it, and are constant here",
                  where, f->max_temperature);
    if (!f->converged && f->mismatch <= args.tol) {
        tool_warn(t,
                  "%s: the time steps have an error of %.2g %% of the largest rise, asked was %g "
                  "%%: the best "
                  "solution is written: accept it with a larger --tol",
                  where, 100 * f->time_error, 100 * args.tol);
        tool_fails_with(t, EXIT_SHORT);
    } else if (!f->converged) {
        tool_warn(t,
                  "%s: the temperatures of the bodies differ by %.2g %% of the largest rise, asked "
                  "was %g %%: the best solution is written",
                  where, 100 * f->mismatch, 100 * args.tol);
        tool_fails_with(t, EXIT_SHORT);
    }
}

/* The main figures, with --verbose. */
static void
tell(struct run *run, const struct rc_grid *g, const struct rc_heat_figures *f, double seconds)
{
    char place[64 + 2 * SHOWN_NUMBER] = "", share[64 + SHOWN_NUMBER] = "", x[SHOWN_NUMBER],
                        y[SHOWN_NUMBER];

    if (!isnan(f->max_x))
        snprintf(place, sizeof place, ", at x = %s, y = %s", shown_in_unit_to(x, f->max_x, "m"),
                 shown_in_unit_to(y, f->max_y, "m"));
    if (!isnan(f->share_1))
        snprintf(share, sizeof share, "; body 1 takes %s of the heat",
                 shown_percent(f->share_1, 3));
    tool_note(&run->t,
              "%s: hottest %.3g K above the bulk of body 1%s%s; %s to %.2g in %zu iterations, "
              "%.2g s",
              tool_where(&run->t, g), f->max_temperature, place, share,
              f->converged ? "converged" : "not converged", f->mismatch, f->iterations, seconds);
}

/* Warns of a profile on a free boundary. */
static void
check_profile(struct run *run, const struct rc_grid *g)
{
    const bool row = g->ny == 1;

    if ((g->nx > 1) != (g->ny > 1) && !rc_wraps(run->problem.boundary, row ? RC_Y : RC_X))
        tool_warn(&run->t,
                  "%s: this profile is heated as a strip %s wide: if it continues without end, "
                  "set its boundary with rc-pick --set boundary=periodic-%c",
                  tool_where(&run->t, g), shown_in_unit(row ? g->dy : g->dx, "m"), row ? 'y' : 'x');
}

static void
show_plan(struct run *run, const struct rc_grid *g)
{
    struct rc_expected expected;
    struct plan plan;
    size_t below = 0;

    for (size_t k = 0; k < args.depths.n && (args.output & 3) != 0; k++)
        below += args.depths.v[k] > 0;
    tool_must(&run->t, g,
              rc_heat_expect(rc_shape_of(g), &run->problem, below, &expected, &run->t.err));
    plan = plan_begin(&run->t, &run->report, g, rc_grid_case(g), boundary(run), "");
    plan_effects(&plan, effects(run));
    course_plan(&plan, g, expected, 1);
    free(run->touch);
    run->touch = NULL;
}

static void
do_case(struct run *run, struct rc_grid *g)
{
    const double began = tool_now();
    enum rc_status status;
    struct rc_heat *h;

    run->problem.boundary = map_boundary(g);
    check_profile(run, g);
    if (args.dry_run) {
        show_plan(run, g);
        return;
    }
    h = tool_made(&run->t, g,
                  rc_heat_new(rc_shape_of(g), &run->problem, g->v, run->touch, &run->t.err));
    while ((status = rc_heat_step(h, &run->t.err)) == RC_MORE)
        tool_progress(&run->t, NAN, "temperatures of %zu x %zu nodes", g->nx, g->ny);
    tool_progress_end(&run->t);
    if (status == RC_FAIL)
        tool_must(&run->t, g, status);
    tell(run, g, rc_heat_result(h), tool_now() - began);
    judge(run, g, rc_heat_result(h));
    for (size_t kind = 0; kind < 2; kind++)
        for (size_t k = 0; k < args.depths.n && args.output >> kind & 1; k++)
            write_frame(run, g, h, kind, args.depths.v[k]);
    for (size_t kind = 2; kind < 5; kind++)
        if (args.output >> kind & 1)
            write_frame(run, g, h, kind, 0);
    put_report(run, g, rc_heat_result(h), tool_now() - began);
    rc_heat_free(h);
    free(run->touch);
    run->touch = NULL;
}

/* ---- main ---- */

int
main(int argc, char **argv)
{
    static struct run run;
    static double surface[1];
    struct rc_grid *g;

    tool_start(&run.t, &info, argc, argv, &args);
    read_options(&run);
    if (args.depths.n == 0)
        args.depths = (struct numbers){.v = surface, .n = 1};
    report_open(&run.report, &run.t, args.report);
    while ((g = next_heat(&run)) != NULL) {
        do_case(&run, g);
        rc_grid_free(g);
    }
    report_close(&run.report);
    return tool_finish(&run.t);
}
