/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A tool for the model of relaxing.c: its options and its maker; tools/model does everything else. */
#include <math.h>

#include "relaxing.h"
#include "tools/model/model.h"

static struct args {
    double estar, compliance, tau, tol;
    struct numbers load, time;
    size_t output;
    bool periodic;
    struct drive_args drive;
} args = {.tol = 1e-2, .output = 3, .drive.interval = 60};

static const char *const frames[] = {"pressure", "settlement", "height", NULL};

#define AT(field) .at = offsetof(struct args, field)
#define ABOVE_0 .min = 0, .max = INFINITY, .above = true, .result = true
/* clang-format off */
static const struct opt opts[] = {
    {.name = "estar", .type = OPT_NUMBER, .unit = UNIT_PA, AT(estar), ABOVE_0, .arg = "MODULUS",
     .help = "composite modulus"},
    {.name = "compliance", .type = OPT_NUMBER, AT(compliance), ABOVE_0, .arg = "M/PA",
     .help = "final settlement over pressure"},
    {.name = "tau", .type = OPT_NUMBER, .unit = UNIT_S, AT(tau), ABOVE_0, .arg = "TIME",
     .help = "time constant"},
    {.name = "tol", .type = OPT_NUMBER, AT(tol), ABOVE_0, .arg = "ERROR", .help = "error of a step"},
    {.name = "load", .type = OPT_NUMBERS, .unit = UNIT_N, AT(load), ABOVE_0, .arg = "LIST",
     .help = "normal force"},
    {.name = "time", .type = OPT_NUMBERS, .unit = UNIT_S, AT(time), ABOVE_0, .arg = "LIST",
     .help = "time"},
    {.name = "periodic", .type = OPT_FLAG, AT(periodic), .result = true, .help = "the map repeats"},
    {.name = "output", .type = OPT_WORDS, AT(output), .list = frames, .arg = "LIST",
     .help = "frames to write, of %s"},
    {.group = drive_options, AT(drive)},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-toy",
    .summary = "Contact on a bed of springs that relaxes",
    .operands = "[FILE...]",
    .opts = opts,
    .reads = READS_STREAM,
    .writes = WRITES_STREAM,
};

int
main(int argc, char **argv)
{
    static struct drive d = {.args = &args.drive, .output = &args.output, .list = frames};
    static const struct drive_axis axes[] = {
        {RC_LOAD, &args.load}, {RC_TIME, &args.time}, {0, NULL}};
    struct drive_advice advice[] = {{"edge_load_fraction", "take a larger map"}, {NULL, NULL}};
    struct rc_grid *g;
    struct rc_err err;

    tool_start(&d.t, &info, argc, argv, &args);
    if (args.periodic)
        advice[0].advice = NULL;
    d.advice = advice;
    drive_open(&d, axes);
    while ((g = drive_next(&d)) != NULL) {
        const struct rc_shape shape = rc_grid_shape(g);
        const struct rc_problem problem = {.pair.estar = args.estar,
                                           .boundary = args.periodic ? RC_PERIODIC : RC_FREE,
                                           .tol = args.tol / 1000,
                                           .threads = d.t.threads,
                                           .hurry = tool_signal()};
        const struct toy_relaxing law = {args.compliance, args.tau, args.tol};
        drive_case(
            &d, g,
            toy_relaxing_new(rc_elastic_new(&shape, g->v, &problem, NULL, &err), g->v, &law, &err),
            &err);
        rc_grid_free(g);
    }
    return drive_close(&d);
}
