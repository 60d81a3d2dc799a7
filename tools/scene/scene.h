/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: rc-scene. For each effect of the library a row names the command that
 * computes it.
 */
#ifndef RC_TOOL_SCENE_H
#define RC_TOOL_SCENE_H

#include <math.h>
#include <stdio.h>

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

enum {
    SCENE_WHY = 320, /* of a message of a tool */
    SCENE_WORDS = 96,
    SCENE_PROGRAMS = 3
};

/* Data of the effects, as given; NAN or NULL: not given. */
struct scene_args {
    const char *yield, *adhesion, *conductivity, *coefficient, *moving, *creep;
    struct numbers diffusivity;
    double mu, tangential, speed, time, distance, thickness, bending, torsion, drop, viscosity,
        piezo, expansion, noise;
};
#define SCENE_NOTHING                                                                              \
    {                                                                                              \
        .mu = NAN, .tangential = NAN, .speed = NAN, .time = NAN, .distance = NAN, .thickness = NAN \
    }
extern const struct opt scene_options[];

/* Warns of effects that no tool computes, where a published number says that they may matter: a film of a
 * fluid, thermal expansion, noise of the scan. `conductivity`: of body 1; `within`: the bound. */
struct scene_notes {
    const struct rc_contact *contact;
    const struct rc_pair *pair;
    double estar, radius, conductivity, within;
    double entrains; /* m/s: mean speed of both surfaces past the contact */
    double slides;   /* m/s: of one surface over the other                 */
};
void scene_notes(struct tool *tool, const struct rc_grid *g, const struct scene_args *args,
                 const struct scene_notes *about);

/* The programs of a pipe that computes an effect, each with its words. */
struct scene_command {
    size_t programs;
    const char *word[SCENE_PROGRAMS][SCENE_WORDS]; /* the last one is NULL */
    char text[SCENE_PROGRAMS][SCENE_WORDS][96];    /* of words that are made here */
};
/* 210GPa for 2.1e11 Pa, if this is exactly the same number; else its digits. */
const char *scene_number_in_unit(double value, enum unit unit, char text[64]);
/* The value of an option as it was typed, or as its table has it; else as scene_number_in_unit. */
const char *scene_value(struct tool *tool, const char *name, char pretty[64]);
/* Makes the command. `effect`: its name, or "leak in time" of a contact that has relaxed. `load`: the option
 * of the load and its value for this case; `body`: body 1 as a layer; `with`: names of options of effects
 * that are accepted before. False: no program computes this effect. */
bool scene_command(struct tool *tool, const char *effect, const char *const load[2],
                   const char *body, const char *with, struct scene_command *command);
/* Puts rc-pick before a command of one program, which then reads the map on nx by ny nodes. */
void scene_refine(struct scene_command *command, size_t nx, size_t ny);
/* Prints the command as a shell reads it, with the file as its input, and as its output one with the name of
 * the effect. */
void scene_show(const struct scene_command *command, const char *effect, const char *file,
                FILE *out);

/* The figures that a command reports, for the comparison with the elastic contact; NAN: none. */
struct scene_found {
    double figure[RC_SCENE_FIGURES], error[RC_SCENE_FIGURES]; /* error: relative, as it is told */
    double seconds, convolutions;
    bool converged;
};
/* Why the command of an effect decides nothing; NULL: it does. */
const char *scene_not_computed(struct tool *tool, const char *effect);
/* A nameless file that is deleted when it is closed. */
int scene_file(struct tool *tool);
/* Runs the programs: the first one reads `in`, a second one `contact`, the elastic contact, and a third one
 * the output of the second. With `plan` the last of the first two only forecasts its work. False when one of
 * them fails, with *why if it refuses the contact. */
bool scene_run(struct tool *tool, const struct scene_command *command, const char *effect, int in,
               int contact, bool plan, struct scene_found *found, char why[SCENE_WHY]);

#endif
