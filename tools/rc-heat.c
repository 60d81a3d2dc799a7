/* Temperatures of a contact whose bodies slide: flash temperatures of both surfaces. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

static struct args {
    const char *conductivity, *moving, *partition, *report;
    struct numbers speed, diffusivity, capacity, bulk, depths;
    double mu, time, tol;
    size_t output;
} args = {.moving = "2", .partition = "matched", .mu = NAN, .tol = 1e-3, .output = 15};

static const char *
frame_word(size_t k)
{
    static const char *const words[] = {"temperature-1", "temperature-2", "heat-1", "heat-2", NULL};

    return words[k];
}

#define AT(field) .at = offsetof(struct args, field)
#define ABOVE_0 .min = 0, .max = INFINITY, .above = true, .result = true
/* clang-format off */
static const struct opt opts[] = {
    {.name = "mu", .type = OPT_NUMBER, AT(mu), ABOVE_0, .arg = "COEFFICIENT",
     .help = "coefficient of friction: the heat is mu times pressure times speed"},
    {.name = "speed", .type = OPT_NUMBERS, AT(speed), .min = -INFINITY, .max = INFINITY, .result = true,
     .arg = "VX[,VY]", .help = "sliding speed, m/s, along x and y"},
    {.name = "conductivity", .type = OPT_TEXT, AT(conductivity), .result = true, .arg = "K1,K2",
     .help = "thermal conductivities of both bodies, as in 45W/mK,16W/mK"},
    {.name = "diffusivity", .type = OPT_NUMBERS, AT(diffusivity), ABOVE_0, .arg = "A1,A2",
     .help = "thermal diffusivities of both bodies, m2/s, as in 1.2e-5,4e-6"},
    {.name = "heat-capacity", .type = OPT_NUMBERS, AT(capacity), ABOVE_0, .arg = "C1,C2",
     .help = "instead: heat capacities by volume, J/m3K, as in 3.7e6,4e6"},
    {.name = "moving", .type = OPT_CHOICE, AT(moving), .result = true, .arg = "1|2",
     .help = "the body whose material moves past the contact (default 2); the other carries the spots"},
    {.name = "bulk", .type = OPT_NUMBERS, AT(bulk), .min = -INFINITY, .max = INFINITY, .result = true,
     .arg = "T1,T2", .help = "temperatures of both bodies far from the contact, K or Celsius (default 0,0)"},
    {.name = "time", .type = OPT_NUMBER, .unit = UNIT_S, AT(time), ABOVE_0, .arg = "TIME",
     .help = "time since heating began (default: steady state); a periodic map needs it"},
    {.name = "partition", .type = OPT_CHOICE, AT(partition), .result = true, .arg = "matched|blok|charron",
     .help = "heat of each body: equal temperatures at every node (default), or one number for all"},
    {.name = "depths", .type = OPT_NUMBERS, .unit = UNIT_M, AT(depths), .min = 0, .max = INFINITY,
     .result = true, .arg = "LIST", .help = "depths of the temperatures (default 0)"},
    {.name = "tol", .type = OPT_NUMBER, AT(tol), .min = 0, .max = 0.5, .above = true, .result = true,
     .arg = "ERROR", .help = "bound of the mismatch of the temperatures (default 1e-3)"},
    {.name = "output", .type = OPT_WORDS, AT(output), .words = frame_word, .arg = "LIST",
     .help = "frames to write, of %s (default: all)"},
    {.name = "report", .type = OPT_REPORT, AT(report), .arg = "FILE",
     .help = "write one JSON object per case, or a row of FILE.tsv or .csv: temperatures, shares"},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-heat",
    .summary = "Flash temperatures of a contact whose bodies slide",
    .operands = "[FILE...]",
    .examples = "  rc-solve --load 5N --radius 5mm --estar 114GPa --hardness 6GPa surface.rcg |\n"
                "      rc-heat --mu 0.3 --speed 1 --conductivity 45W/mK,45W/mK \\\n"
                "          --diffusivity 1.2e-5,1.2e-5 --report heat.tsv -o hot.rcg\n",
    .opts = opts,
    .reads = READS_STREAM,
    .writes = WRITES_STREAM,
};

struct run {
    struct tool t;
    struct report report;
    struct rc_heat_problem problem;
    struct rc_grid *pressure, *contact; /* of the case beside its main frame; NULL: none */
    bool friction;                      /* heat from --mu and --speed                    */
    double speed;                       /* m/s                                           */
};

/* ---- the command line ---- */

/* Two numbers, one for each body. */
static const double *
pair_of(struct tool *t, const char *name, const struct numbers *list)
{
    if (list->n != 2)
        tool_die(t, EXIT_USAGE, "--%s: give two numbers, for body 1 and body 2", name);
    return list->v;
}

static void
read_speed(struct run *run)
{
    const struct numbers *v = &args.speed;
    struct rc_heat_body *moves = &run->problem.body[strcmp(args.moving, "1") == 0 ? 0 : 1];

    if (v->n == 0 || v->n > 2)
        tool_die(&run->t, EXIT_USAGE, "give the sliding speed in m/s with --speed VX or VX,VY");
    memcpy(moves->velocity, v->v, v->n * sizeof *v->v);
    run->speed = hypot(moves->velocity[0], moves->velocity[1]);
    run->friction = tool_given(&run->t, "mu");
    if (run->friction && run->speed == 0)
        tool_die(&run->t, EXIT_USAGE, "--speed is 0, so that friction makes no heat: give a speed");
}

static void
read_options(struct run *run)
{
    struct tool *t = &run->t;
    const bool capacity = tool_given(t, "heat-capacity");
    struct rc_heat_problem *p = &run->problem;
    const char *unit;
    double k[2];
    struct rc_err err;

    if (args.conductivity == NULL || capacity == tool_given(t, "diffusivity"))
        tool_die(t, EXIT_USAGE,
                 "give the materials with --conductivity and with one of --diffusivity and "
                 "--heat-capacity");
    if (unit_conductivities(args.conductivity, k, &unit, &err) != RC_OK)
        tool_die(t, EXIT_USAGE, "--conductivity %s: %s", args.conductivity, err.text);
    if (unit != NULL && strcmp(unit, "W/K") != 0)
        tool_die(t, EXIT_USAGE, "--conductivity %s: it must be thermal, in W/mK",
                 args.conductivity);
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
    p->partition = strcmp(args.partition, "blok") == 0      ? RC_HEAT_BLOK
                   : strcmp(args.partition, "charron") == 0 ? RC_HEAT_CHARRON
                                                            : RC_HEAT_MATCHED;
    read_speed(run);
}

/* ---- a case ---- */

/* Makes the heat flux of friction, or checks the given one. */
static void
find_heat(struct run *run, struct rc_grid *g)
{
    tool_demand_finite(&run->t, g, "recompute the map");
    if (rc_grid_get(g, "layers") != NULL)
        tool_die_at(
            &run->t, g, EXIT_IMPOSSIBLE,
            "its body 1 has layers, and rc-heat supports only bodies of one material: where "
            "the layers conduct as the substrate does, remove the key with rc-pick --set "
            "layers=");
    if (!run->friction && strcmp(g->unit, "W/m2") != 0)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "its unit is '%s': it must be W/m2", g->unit);
    for (size_t k = 0; k < rc_grid_nodes(g) && run->friction; k++) {
        if (g->v[k] < 0)
            tool_die_at(
                &run->t, g, EXIT_IMPOSSIBLE,
                "pressure %g Pa at column %zu, row %zu: friction of bodies that attract each "
                "other is not implemented: give the heat in a frame heat",
                g->v[k], k % g->nx, k / g->nx);
        g->v[k] *= args.mu * run->speed;
    }
}

static void
write_frame(struct run *run, const struct rc_grid *like, struct rc_heat *h, size_t kind,
            double depth)
{
    const struct rc_heat_figures *f = rc_heat_result(h);
    const int body = (int)(kind % 2);
    const bool heat = kind >= 2;
    struct rc_err err;
    struct rc_grid *g = rc_grid_like(like, frame_word(kind), heat ? "W/m2" : "K", &err);

    if (g == NULL || rc_grid_set_number(g, "max_temperature", f->max_temperature, &err) != RC_OK ||
        (!heat && rc_grid_set_number(g, "depth", depth, &err) != RC_OK) ||
        rc_grid_set(g, "converged", f->converged ? "yes" : "no", &err) != RC_OK ||
        rc_grid_history(g, tool_history(&run->t), &err) != RC_OK ||
        (!heat && rc_heat_temperature(h, body, depth, g->v, &err) != RC_OK))
        tool_die_at(&run->t, like, EXIT_IMPOSSIBLE, "%s", err.text);
    if (heat)
        memcpy(g->v, rc_heat_flux(h, body), rc_grid_nodes(g) * sizeof *g->v);
    tool_write(&run->t, g);
    rc_grid_free(g);
}

static void
put_report(struct run *run, const struct rc_grid *g, const struct rc_heat_figures *f,
           double seconds)
{
    struct report *r = &run->report;

    if (!report_wanted(r))
        return;
    report_begin(r);
    report_map(r, g, rc_grid_case(g));
    report_text(r, "boundary", run->problem.boundary == RC_PERIODIC ? "periodic" : "free");
    report_count(r, "threads", run->t.threads, NULL);
    report_table(r, rc_figures("heat"), f);
    report_number(r, "seconds", seconds, "s");
    report_memory(r);
    report_finish_row(r);
}

enum {
    FEW = 10 /* nodes along the motion: with fewer the trailing edge is more than 3 % hotter */
};

static void
judge(struct run *run, const struct rc_grid *g, const struct rc_heat_figures *f)
{
    struct tool *t = &run->t;
    const double m = (double)f->hot_nodes;
    char where[256];

    tool_where(t, g, where, sizeof where);
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
    if (!f->converged) {
        tool_warn(t,
                  "%s: the temperatures of the bodies differ by %.2g of the largest rise, asked "
                  "was %g: the best solution is written",
                  where, f->mismatch, args.tol);
        tool_fails_with(t, EXIT_SHORT);
    }
}

static void
do_case(struct run *run, struct rc_grid *g)
{
    const struct rc_grid *p = run->friction ? g : run->pressure;
    const struct rc_shape shape = rc_grid_shape(g);
    const double began = tool_now();
    double *contact = NULL;
    enum rc_status status;
    struct rc_heat *h;
    struct rc_err err;

    if (p != NULL || run->contact != NULL) {
        const struct rc_grid *touch = contact_demand(&run->t, p, run->contact);
        tool_demand_grid_of(&run->t, touch, g);
        contact = tool_room(&run->t, rc_grid_nodes(g), sizeof *contact, "the contact");
        memcpy(contact, touch->v, rc_grid_nodes(g) * sizeof *contact);
    }
    run->problem.boundary = map_boundary(g);
    find_heat(run, g);
    h = rc_heat_new(&shape, &run->problem, g->v, contact, &err);
    free(contact);
    if (h == NULL)
        tool_die_at(&run->t, g, EXIT_IMPOSSIBLE, "%s", err.text);
    while ((status = rc_heat_step(h, &err)) == RC_MORE)
        tool_progress(&run->t, NAN, "temperatures of %zu x %zu nodes", g->nx, g->ny);
    tool_progress_end(&run->t);
    tool_must(&run->t, g, status, &err);
    judge(run, g, rc_heat_result(h));
    for (size_t kind = 0; kind < 2; kind++)
        for (size_t k = 0; k < args.depths.n && args.output >> kind & 1; k++)
            write_frame(run, g, h, kind, args.depths.v[k]);
    for (size_t kind = 2; kind < 4; kind++)
        if (args.output >> kind & 1)
            write_frame(run, g, h, kind, 0);
    put_report(run, g, rc_heat_result(h), tool_now() - began);
    rc_heat_free(h);
}

/* ---- main ---- */

int
main(int argc, char **argv)
{
    static struct run run;
    struct tool_frame beside[] = {
        {"pressure", &run.pressure}, {CONTACT_CHANNEL, &run.contact}, {NULL, NULL}};
    static double surface[1];
    struct rc_grid *g;

    tool_start(&run.t, &info, argc, argv, &args);
    read_options(&run);
    if (args.depths.n == 0)
        args.depths = (struct numbers){.v = surface, .n = 1};
    report_open(&run.report, &run.t, args.report);
    while ((g = tool_channel_with(&run.t, run.friction ? "pressure" : "heat", tool_take_frames,
                                  run.friction ? beside + 1 : beside)) != NULL) {
        do_case(&run, g);
        rc_grid_free(g);
        rc_grid_free(run.pressure);
        rc_grid_free(run.contact);
        run.pressure = run.contact = NULL;
    }
    report_close(&run.report);
    return tool_finish(&run.t);
}
