/* Contact of a height map with an elastic half-space. */
#include <math.h>
#include <string.h>

#include "tools/cli/cli.h"
#include "tools/solve/solve.h"

static struct solve_args args = {
    .physics = PHYSICS_NONE,
    .kernel = "auto",
    .method = "auto",
    .along = "x",
    .track = "fresh",
    .counter_travel = 1,
    .passes = 1,
    .shift = 1,
    .drive.interval = 60,
    .output = 1 << SOLVE_PRESSURE | 1 << SOLVE_GAP | 1 << SOLVE_DISPLACEMENT | 1 << SOLVE_HEIGHT,
};

#define AT(field) .at = offsetof(struct solve_args, field)
/* clang-format off */
static const struct opt opts[] = {
    {.title = "load and bodies"},
    {.group = solve_contact_options},
    {.title = "yield"},
    {.name = "increments", .type = OPT_TEXT, AT(increments), .result = true, .arg = "N[,half]|auto",
     .help = "increments of each load with --yield, or steps from time to time (default auto: to an error of "
             "1 %)"},
    {.name = "slabs", .type = OPT_TEXT, AT(slabs), .result = true, .arg = "N|LIST|auto",
     .help = "layers that may yield: number or thicknesses, from the surface down (default auto)"},
    {.title = "time"},
    {.name = "relaxation", .type = OPT_TEXT, AT(relaxation), .result = true,
     .arg = "EINF,E1:TAU1,...|FILE",
     .help = "body 1 is viscoelastic: relaxed modulus and terms of E(t), or a file (instead of --E1)"},
    {.name = "shift", .type = OPT_NUMBER, AT(shift), .min = 0, .max = INFINITY, .above = true,
     .result = true, .arg = "FACTOR",
     .help = "multiply all times of --relaxation, as the shift factor of a temperature (default 1)"},
    {.name = "time", .type = OPT_NUMBERS, .unit = UNIT_S, AT(time), .min = 0, .max = INFINITY,
     .result = true, .arg = "LIST",
     .help = "with --relaxation, times of the loads or of the results of one load, each a case"},
    {.title = "sliding"},
    {.name = "speed", .type = OPT_NUMBERS, .unit = UNIT_SPEED, AT(speed), .min = -INFINITY,
     .max = INFINITY, .result = true, .arg = "LIST",
     .help = "with --relaxation, body 2 slides steadily over body 1: m/s along +x, each a case"},
    {.name = "along", .type = OPT_CHOICE, AT(along), .result = true, .arg = "x|y",
     .help = "direction in which it slides (default x)"},
    {.name = "track", .type = OPT_CHOICE, AT(track), .result = true, .arg = "fresh|repeated",
     .help = "whether it meets its own grooves again after a period (default fresh)"},
    {.title = "adhesion"},
    {.name = "pull-off", .type = OPT_FLAG, AT(pull_off), .result = true,
     .help = "after the last state separate the bodies, and find the pull-off load"},
    {.title = "travel"},
    {.name = "travel", .type = OPT_NUMBERS, .unit = UNIT_M, AT(travel), .min = -INFINITY,
     .max = INFINITY, .result = true, .arg = "LIST",
     .help = "the contact travels over the map: x of its middle, from that of the map, each a case"},
    {.name = "counter", .type = OPT_TEXT, AT(counter), .result = true, .arg = "FILE",
     .help = "heights of body 2, which travels (or a ball: --radius); mirrored as by rc-add"},
    {.name = "counter-travel", .type = OPT_NUMBER, AT(counter_travel), .min = -INFINITY,
     .max = INFINITY, .result = true, .arg = "RATIO",
     .help = "travel of its heights over that of the contact: 1 (default) slides, 0 rolls"},
    {.name = "window", .type = OPT_TEXT, AT(window), .result = true, .arg = "WxH",
     .help = "with --travel, solve so many nodes around the contact (default: the whole map)"},
    {.name = "passes", .type = OPT_COUNT, AT(passes), .min = 1, .max = 1e6, .result = true,
     .arg = "N",
     .help = "with --travel and --yield, go through the positions N times (default 1)"},
    {.title = "accuracy"},
    {.name = "kernel", .alias = "engine", .type = OPT_CHOICE, AT(kernel),
     .words = words_engine_or_auto, .help = "engine that sums displacements (default auto)"},
    {.name = "method", .type = OPT_CHOICE, AT(method), .words = words_method_or_auto,
     .help = "iteration of the contact (default auto)"},
    {.name = "tol", .type = OPT_NUMBER, AT(tol), .min = 0, .max = 1, .above = true,
     .result = true, .arg = "ERROR",
     .help = "relative L1 error of the pressure (default N^(-3/4), N nodes, at most 1e-3)"},
    {.title = "output"},
    {.name = "output", .type = OPT_WORDS, AT(output),
     .list = solve_frames, .arg = "LIST",
     .help = "frames to write, of %s (default: pressure, gap, displacement, height; with --yield residual, "
             "with --adhesion contact too)"},
    {.name = "stiffness", .type = OPT_FLAG, AT(stiffness),
     .help = "compute d load / d approach (default: with a list)"},
    {.name = "conductivity", .type = OPT_TEXT, AT(conductivity), .arg = "K1,K2",
     .help = "compute the conductance from the conductivities of both bodies: 45W/mK,16W/mK, 58MS/m,7MS/m"},
    {.title = "accuracy"},
    {.name = "discretization", .type = OPT_FLAG, AT(discretization),
     .help = "estimate the discretization error, from a second solution on a coarser grid"},
    {.title = "output"},
    {.group = drive_options, AT(drive)},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-solve",
    .summary = "Contact of a height map with an elastic half-space: pressure, gap, displacement",
    .operands = "[FILE...]",
    .examples = "  rc-synth sphere --nx 128 --dx 5um --radius 7.5mm |\n"
                "      rc-solve --load 240N --estar 114GPa --report hertz.json | rc-info\n",
    .opts = opts,
    .reads = READS_STREAM,
    .writes = WRITES_STREAM,
    .shares = true,
};

/* ---- the command line ---- */

static void
read_conductivity(struct run *run)
{
    if (args.conductivity == NULL)
        return;
    if (unit_conductivities(args.conductivity, run->k, &run->conductance_unit, &run->d.t.err) !=
        RC_OK)
        tool_usage(&run->d.t, "--conductivity %s: %s", args.conductivity, run->d.t.err.text);
    run->conductance = args.physics.pair.one.layers == 0;
    if (!run->conductance)
        tool_warn(&run->d.t, "--conductivity does not work with --layer, because the analogy of "
                             "conductance and stiffness fails: the conductance is left out");
}

/* Checks the options of a counter body that is free to tilt. */
static void
check_tilt(struct run *run)
{
    const struct physics *a = &args.physics;

    run->tilt = args.tilt != NULL && strcmp(args.tilt, "free") == 0;
    if (args.at.n > 0 && !run->tilt)
        tool_usage(&run->d.t, "--at has no effect without --tilt free");
    if (args.at.n > 0 && args.at.n != 2)
        tool_usage(&run->d.t, "--at: it must be X,Y, from the middle of the map, as in 0.1mm,0");
    if (run->tilt && a->periodic)
        tool_usage(&run->d.t,
                   "--tilt free does not work on a periodic surface, because it has no centre of "
                   "tilt: leave out --periodic");
    if (run->tilt && tool_given(&run->d.t, "history"))
        tool_usage(&run->d.t, "--tilt free does not work with --history yet");
}

static void
check_arguments(struct run *run)
{
    /* each load starts from the last one */
    args.physics.history |= args.yield != NULL || args.adhesion != NULL;
    args.physics.adhesion = args.adhesion != NULL;
    args.physics.travels = args.travel.n > 0;
    relax_read(run, &args);
    physics_check(&run->d.t, &args.physics);
    run->args = &args;
    run->steps = physics_steps(&args.physics);
    run->stiffness = args.stiffness || (run->steps->n > 1 && args.adhesion == NULL);
    read_conductivity(run);
    check_tilt(run);
    yield_read(run);
    adhesion_read(run);
    travel_read(run);
    relax_check(run);
    slide_check(run);
    if (run->yielding.wanted && !tool_given(&run->d.t, "output"))
        args.output |= 1 << SOLVE_RESIDUAL;
    if (run->adhering.wanted && (args.output & (1 << SOLVE_PRESSURE | 1 << SOLVE_GAP)))
        args.output |= 1 << SOLVE_CONTACT; /* the pressure does not determine the contact */
}

/* ---- main ---- */

int
main(int argc, char **argv)
{
    /* Values of lists are points; with another tolerance the iteration continues. */
    static const char *const changeable[] = {"tol",   "load",   "mean-pressure", "approach", "time",
                                             "speed", "travel", "passes",        "pull-off", NULL};
    static const char *const reads[] = {HEIGHT_ERROR, NULL};
    static struct run run = {.d = {.args = &args.drive,
                                   .output = &args.output,
                                   .list = solve_frames,
                                   .reads = reads,
                                   .changeable = changeable}};
    const struct tool_frame beside[] = {
        {"hardness", &run.hardness}, {"counter", &run.travelling.counter}, {NULL, NULL}};

    tool_start(&run.d.t, &info, argc, argv, &args);
    check_arguments(&run);
    run.d.beside = beside;
    if ((args.physics.history && !run.adhering.wanted) ||
        run.relaxing.wanted) { /* the errors of earlier points stay */
        run.d.changeable = changeable + 1;
        run.d.bound = run.yielding.wanted ? NULL : "tol";
    }
    drive_open(&run.d, NULL);
    while (tool_interrupted() == 0 &&
           (run.g = tool_channel_beside(&run.d.t, "height", "hardness", &run.hardness)) != NULL) {
        solve_case(&run);
        rc_grid_free(run.g);
        rc_grid_free(run.hardness);
    }
    return drive_close(&run.d);
}
