/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of rc-solve: those of every contact, and those of its effects. */
#include "solve.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#ifndef RC_EFFECTS_LIST
#define RC_EFFECTS_LIST "tools/solve/effects.list"
#endif
#define EFFECT(name) extern const struct effect solve_effect_##name;
#include RC_EFFECTS_LIST
#undef EFFECT
#define EFFECT(name) &solve_effect_##name,
const struct effect *const solve_effects[] = {
#include RC_EFFECTS_LIST
    NULL};
#undef EFFECT

struct solve_args solve_args = {
    .physics = PHYSICS_NONE,
    .kernel = "auto",
    .method = "auto",
    .drive.interval = 60,
    .output = 1 << SOLVE_PRESSURE | 1 << SOLVE_GAP | 1 << SOLVE_DISPLACEMENT | 1 << SOLVE_HEIGHT,
};

const char *solve_frames[SOLVE_FRAMES + 1] = {
    [SOLVE_CONTACT] = CONTACT_CHANNEL,
    [SOLVE_PRESSURE] = "pressure",
    [SOLVE_GAP] = "gap",
    [SOLVE_DISPLACEMENT] = "displacement",
    [SOLVE_HEIGHT] = "height",
    [SOLVE_PLASTIC] = "plastic",
};

#define AT(field) .base = &solve_args.field
/* clang-format off */
const struct opt solve_increments[] = {
    {.name = "increments", .type = OPT_TEXT, AT(increments), .result = true, .arg = "N[,half]|auto",
     .needs = RULES({.with = "yield|time"}),
     .help = "increments of each load with --yield, or steps from time to time (default auto: to an error of "
             "1 %)"},
    {.name = NULL},
};
static const struct opt of_solver[] = {
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
    {.group = drive_options, AT(drive)},
    {.name = NULL},
};
/* clang-format on */

const struct opt *
solve_options(void)
{
    static struct opt opts[SOLVE_EFFECTS + 4];
    size_t frames = SOLVE_PLASTIC + 1, n = 0;

    opts[n++] = (struct opt){.group = physics_options, AT(physics), .title = "load and bodies"};
    opts[n++] = (struct opt){.group = material_options, .title = "load and bodies"};
    for (size_t k = 0; solve_effects[k] != NULL; k++) {
        const char *const *frame = solve_effects[k]->frames;
        assert(k < SOLVE_EFFECTS);
        if (solve_effects[k]->options != NULL)
            opts[n++] =
                (struct opt){.group = solve_effects[k]->options, .title = solve_effects[k]->title};
        for (; frame != NULL && *frame != NULL; frame++) {
            assert(frames < SOLVE_FRAMES);
            solve_frames[frames++] = *frame;
        }
    }
    opts[n++] = (struct opt){.group = of_solver, .title = "accuracy"};
    return opts;
}

/* ---- reading ---- */

const struct effect *
solve_first(const struct run *run, size_t at, size_t size)
{
    for (const struct effect *const *e = run->active; *e != NULL; e++)
        for (size_t k = 0; k < size; k++)
            if (((const char *)*e)[at + k] != 0)
                return *e;
    return NULL;
}

static size_t
frame_of(const char *word)
{
    size_t k = 0;

    while (solve_frames[k] != NULL && strcmp(solve_frames[k], word) != 0)
        k++;
    return k;
}

void
solve_add_frame(const char *word)
{
    solve_args.output |= (size_t)1 << frame_of(word);
}

/* Refuses frames of an effect that is not active. */
static void
refuse_frames(struct run *run, const struct effect *e)
{
    for (const char *const *f = e->frames; f != NULL && *f != NULL; f++)
        if (solve_wanted(run->args, frame_of(*f)))
            tool_usage(&run->d.t, "--output %s %s", *f, e->frames_alone);
}

void
solve_read(struct run *run)
{
    size_t n = 0;

    run->args = &solve_args;
    run->physics = &solve_args.physics;
    for (size_t k = 0; solve_effects[k] != NULL; k++) {
        const struct effect *e = solve_effects[k];
        if (e->ask != NULL && !e->ask(run))
            continue;
        run->active[n++] = e;
        run->physics->history = run->physics->history || e->sequence;
    }
    physics_check(&run->d.t, run->physics);
    run->steps = physics_steps(run->physics);
    for (size_t k = 0, at = 0; solve_effects[k] != NULL; k++)
        if (run->active[at] == solve_effects[k])
            at++;
        else
            refuse_frames(run, solve_effects[k]);
    SOLVE_EACH (run, e, read)
        e->read(run);
    SOLVE_EACH (run, e, warn)
        e->warn(run);
}
