/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Friction in a contact found by rc-solve: stick, slip and dissipated energy. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tools/materials/materials.h"
#include "tools/slip/slip.h"

static struct slip_args args = {
    .mu = NAN,
    .tau_max = NAN,
    .nu = NAN,
    .e1 = NAN,
    .nu1 = NAN,
    .e2 = NAN,
    .nu2 = NAN,
    .tol = NAN,
    .repeats = BOUNDARY_NONE,
    .coupling = "full",
    .output = (1u << SLIP_STATE) - 1,
    .drive.interval = 60,
};

#define AT(field) .at = offsetof(struct slip_args, field)
#define ABOVE_0 .min = 0, .max = INFINITY, .above = true
/* clang-format off */
static const struct opt opts[] = {
    {.name = "mu", .type = OPT_NUMBER, AT(mu), ABOVE_0, .result = true, .arg = "COEFFICIENT",
     .one_of = RULES({.with = "mu", .remedy = "as in --mu 0.3"}),
     .help = "coefficient of friction, static and kinetic"},
    {.name = "tau-max", .type = OPT_NUMBER, .unit = UNIT_PA, AT(tau_max), ABOVE_0, .result = true,
     .arg = "STRESS", .help = "upper bound of the traction (Tresca)"},
    {.name = "tangential", .type = OPT_NUMBERS, .unit = UNIT_N, AT(tangential), .min = -INFINITY,
     .max = INFINITY, .result = true, .arg = "FX[,FY]",
     .one_of = RULES({.with = "tangential|displacement|path|history|creep|creep-force",
                      .remedy = "which move the bodies"}),
     .help = "force of body 2 on body 1 along the surface, under the load of the stream"},
    {.name = "displacement", .type = OPT_NUMBERS, .unit = UNIT_M, AT(displacement),
     .min = -INFINITY, .max = INFINITY, .result = true, .arg = "DX[,DY]",
     .help = "instead of the force: displacement of body 2 over body 1"},
    {.name = "path", .type = OPT_TEXT, AT(path), .result = true, .arg = "P,FX,FY;...",
     .help = "loads and forces, each a case, starting separated: '240N,0,0; 240N,40N,0'"},
    {.name = "history", .type = OPT_TEXT, AT(history), .result = true, .arg = "FILE",
     .help = "the same path from a file with lines of load, force along x, force along y"},
    {.name = "creep", .type = OPT_TEXT, AT(creep), .result = true, .arg = "XI[,ETA[,SPIN]]",
     .help = "rolling towards +x: motion of body 2 over body 1 per length (above 0 it pulls body 1 along +x; "
             "railway textbooks have the opposite sign), as 1e-3 or 0.1%; spin in rad/m; "
             "with --steady each also as a:b:n or a:b:log:n, each value a case"},
    {.name = "creep-force", .type = OPT_NUMBERS, .unit = UNIT_N, AT(creep_force), .min = -INFINITY,
     .max = INFINITY, .result = true, .arg = "FX[,FY]",
     .help = "rolling under this force of body 2 on body 1: finds the creepages"},
    {.name = "steady", .type = OPT_FLAG, AT(steady), .result = true,
     .needs = RULES({.with = "creep|creep-force"}),
     .help = "steady rolling: tractions do not change while the contact rolls"},
    {.name = "increments", .type = OPT_TEXT, AT(increments), .result = true, .arg = "N|auto",
     .against = RULES({.with = "creep|creep-force", .because = "each case of rolling is one increment"}),
     .help = "increments between corners of a path (default auto: an error of about 1 %)"},
    {.name = "coupling", .type = OPT_CHOICE, AT(coupling), .result = true,
     .list = (const char *const[]){"full", "goodman", "none", NULL},
     .against = RULES({.with = "creep|creep-force", .word = "full",
                       .because = "rolling neglects the effect of tractions on the pressure",
                       .remedy = "take --coupling goodman, or none"}),
     .help = "how pressure and tractions of dissimilar bodies influence each other (default full)"},
    {.name = "nu", .type = OPT_NUMBER, AT(nu), .min = -1, .max = 0.5, .above = true,
     .result = true, .arg = "RATIO",
     .against = RULES({.with = "E1|nu1|E2|nu2", .because = "it is Poisson's ratio of both bodies"}),
     .help = "Poisson's ratio of both bodies, if the stream has only E*"},
    {.name = "E1", .type = OPT_NUMBER, .unit = UNIT_PA, AT(e1), ABOVE_0, .result = true,
     .arg = "MODULUS",
     .needs = RULES({.with = "nu1"}, {.with = "E2", .because = "the constants of both bodies are needed"}),
     .help = "or both bodies: Young's modulus of body 1"},
    {.name = "nu1", .type = OPT_NUMBER, AT(nu1), .min = -1, .max = 0.5, .above = true,
     .result = true, .arg = "RATIO",
     .needs = RULES({.with = "E1"}),
     .help = "Poisson's ratio of body 1"},
    {.name = "E2", .type = OPT_NUMBER, .unit = UNIT_PA, AT(e2), ABOVE_0, .result = true,
     .word = "rigid", .arg = "MODULUS",
     .needs = RULES({.with = "E1"}, {.with = "nu2", .word = "MODULUS"}),
     .help = "Young's modulus of body 2, or rigid"},
    {.name = "nu2", .type = OPT_NUMBER, AT(nu2), .min = -1, .max = 0.5, .above = true,
     .result = true, .arg = "RATIO",
     .needs = RULES({.with = "E2"}),
     .against = RULES({.with = "E2 rigid", .because = "a rigid body does not deform",
                       .remedy = "leave out --nu2"}),
     .help = "Poisson's ratio of body 2"},
    {.group = material_options},
    OPT_PERIODIC(offsetof(struct slip_args, repeats),
                 "the map repeats without end, along both axes or the given one (default: the "
                 "stream's boundary, else free)"),
    {.name = "tol", .type = OPT_NUMBER, AT(tol), .min = 0, .max = 1, .above = true,
     .result = true, .arg = "ERROR",
     .help = "relative L1 error of the tractions (default 1e-4 of the iteration, 0.1 in all)"},
    {.name = "output", .type = OPT_WORDS, AT(output), .list = slip_frames, .arg = "LIST",
     .help = "frames to write, of %s (default: the first five)"},
    {.group = drive_options, AT(drive)},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-slip",
    .summary = "Friction in a contact: tractions, stick and slip",
    .operands = "[FILE...]",
    .examples = "  rc-solve --load 1N --radius 2mm --E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3 \\\n"
                "      -o contact.rcg surface.rcg\n"
                "  rc-slip --mu 0.3 --tangential 0.15N --report slip.json -o slip.rcg contact.rcg\n"
                "  rc-slip --mu 0.3 --path '1N,0,0; 1N,0.2N,0; 1N,-0.2N,0; 1N,0.2N,0' \\\n"
                "      --report loop.tsv -o loop.rcg contact.rcg\n",
    .opts = opts,
    .figures = (const char *const[]){"friction", "rolling", NULL},
    .shares = true,
    .fill = materials_fill,
    .of_materials = (const char *const[]){"E1", "nu1", "E2", "nu2", NULL},
    .reads = READS_STREAM,
    .writes = WRITES_STREAM,
};

/* ---- the command line ---- */

static void
check_arguments(struct slip_run *run)
{
    const struct slip_motion *const *motion = slip_motions;
    run->args = &args;
    run->coupling = strcmp(args.coupling, "full") == 0      ? RC_COUPLING_FULL
                    : strcmp(args.coupling, "goodman") == 0 ? RC_COUPLING_GOODMAN
                                                            : RC_COUPLING_NONE;
    while (!(*motion)->ask(&args))
        motion++;
    run->motion = *motion;
    run->motion->read(run, &args);
}

/* ---- main ---- */

int
main(int argc, char **argv)
{
    static const char *const reads[] = {"boundary", "datum", "estar",    "e1", "nu",
                                        "e2",       "nu2",   "window_x", NULL};
    static struct slip_run run = {
        .d = {.args = &args.drive, .output = &args.output, .list = slip_frames, .reads = reads}};
    struct tool_frame beside[] = {
        {"gap", &run.gap}, {"height", &run.height}, {CONTACT_CHANNEL, &run.contact}, {NULL, NULL}};

    tool_start(&run.d.t, &info, argc, argv, &args);
    check_arguments(&run);
    run.d.beside = beside;
    drive_open(&run.d, NULL);
    while (tool_interrupted() == 0 &&
           (run.p = tool_channel_with(&run.d.t, "pressure", tool_take_frames, beside)) != NULL) {
        slip_case(&run);
        rc_grid_free(run.p);
        run.p = NULL;
        tool_free_frames(beside);
    }
    free(run.given);
    if (run.motion->close != NULL)
        run.motion->close();
    return drive_close(&run.d);
}
