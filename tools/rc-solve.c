/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact of a height map with an elastic half-space. */
#include "tools/solve/solve.h"

/* Effects without a heading of their own, and other names of headings. */
static const struct help_topic topics[] = {
    {"conductance conductivity resistance", "stiffness conductivity"},
    {"hardness plasticity", "hardness history output"},
    {"layers coating layered", "layer E1 nu1"},
    {"mpi", ""},
    {"relaxation creep viscoelasticity viscoelastic rubber",
     "relaxation shift temperature time increments"},
    {"theory", ""},
    {"tilt", "tilt at"},
    {0},
};

static struct tool_info info = {
    .name = "rc-solve",
    .summary = "Contact of a height map with an elastic half-space: pressure, gap, displacement",
    .operands = "[FILE...]",
    .examples = "  rc-synth sphere --nx 128 --dx 5um --radius 7.5mm |\n"
                "      rc-solve --load 240N --estar 114GPa --report hertz.json | rc-info\n",
    .topics = topics,
    .figures = (const char *const[]){"contact", "elastic", "yield", "adhesion", "travel", "sliding",
                                     "viscoelastic", NULL},
    .own = solve_figures,
    .fill = materials_fill,
    .of_materials = (const char *const[]){"E1", "nu1", "E2", "nu2", NULL},
    .reads = READS_STREAM,
    .writes = WRITES_STREAM,
    .shares = true,
};

/* The next heights, with the maps that effects read beside them. */
static struct rc_grid *
next_case(struct run *run, struct tool_frame *beside)
{
    struct rc_grid *g = tool_interrupted() != 0
                            ? NULL
                            : tool_channel_with(&run->d.t, "height", tool_take_frames, beside);

    for (const struct tool_frame *f = beside; g != NULL && f->channel != NULL; f++)
        if (*f->frame != NULL)
            tool_demand_grid_of(&run->d.t, *f->frame, g);
    return g;
}

/* Whether a run with another tolerance continues from a checkpoint. */
static void
decide_on_tol(struct run *run)
{
    static const char *const changeable[] = {"tol", NULL};
    enum solve_tol is = run->physics->history ? TOL_MAY_RISE : TOL_FREE;

    SOLVE_EACH (run, e, tol)
        is = e->tol;
    if (is == TOL_FREE)
        run->d.changeable = changeable;
    if (is == TOL_MAY_RISE)
        run->d.bound = changeable[0];
}

int
main(int argc, char **argv)
{
    static const char *const reads[] = {HEIGHT_ERROR, NULL};
    static struct run run = {.d = {.args = &solve_args.drive,
                                   .output = &solve_args.output,
                                   .list = solve_frames,
                                   .reads = reads}};
    struct tool_frame maps[SOLVE_EFFECTS + 1] = {{0}}, beside[SOLVE_EFFECTS + 1] = {{0}};
    size_t n = 0, m = 0;

    info.opts = solve_options();
    tool_start(&run.d.t, &info, argc, argv, &solve_args);
    solve_read(&run);
    for (size_t k = 0; solve_effects[k] != NULL; k++) {
        if (solve_effects[k]->map.channel != NULL)
            maps[n++] = solve_effects[k]->map;
        if (solve_effects[k]->beside)
            beside[m++] = solve_effects[k]->map;
    }
    run.d.beside = maps;
    decide_on_tol(&run);
    drive_open(&run.d, NULL);
    while ((run.g = next_case(&run, beside)) != NULL) {
        solve_case(&run);
        rc_grid_free(run.g);
        tool_free_frames(beside);
    }
    return drive_close(&run.d);
}
