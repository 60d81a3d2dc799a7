/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options with the data of the effects, of rc-scene and rc-report. */
#include <stddef.h>

#include "scene.h"

static const char *const moving_words[] = {"1", "2", NULL};

#define AT(field) .at = offsetof(struct scene_args, field)
#define ABOVE_0 .min = 0, .max = INFINITY, .above = true, .result = true
/* clang-format off */
const struct opt scene_options[] = {
    {.name = "thickness", .type = OPT_NUMBER, .unit = UNIT_M, AT(thickness), ABOVE_0, .arg = "LENGTH",
     .help = "thin body: thickness of body 1 on a rigid base"},
    {.name = "yield", .type = OPT_TEXT, AT(yield), .result = true, .arg = "Y",
     .help = "yield in the volume: yield stress of body 1"},
    {.name = "adhesion", .type = OPT_TEXT, AT(adhesion), .result = true, .arg = "WORK[,LAW[,RANGE]]",
     .help = "adhesion: work, law and range of the attraction, as for rc-solve"},
    {.name = "mu", .type = OPT_NUMBER, AT(mu), ABOVE_0, .arg = "COEFFICIENT",
     .help = "coefficient of friction: partial slip, dissimilar bodies, heat"},
    {.name = "tangential", .type = OPT_NUMBER, .unit = UNIT_N, AT(tangential), ABOVE_0, .arg = "FORCE",
     .help = "partial slip: the tangential force"},
    {.name = "speed", .type = OPT_NUMBER, .unit = UNIT_SPEED, AT(speed), ABOVE_0, .arg = "V",
     .help = "sliding speed along x, or with --creep the speed of rolling: heat, sliding on rubber"},
    {.name = "creep", .type = OPT_TEXT, AT(creep), .result = true, .arg = "XI[,ETA[,SPIN]]",
     .help = "rolling: creepages along x and y, and spin, as for rc-slip"},
    {.name = "time", .type = OPT_NUMBER, .unit = UNIT_S, AT(time), ABOVE_0, .arg = "TIME",
     .help = "time since the load acts and heat flows: relaxation, heat"},
    {.name = "conductivity", .type = OPT_TEXT, AT(conductivity), .result = true, .arg = "K1,K2",
     .help = "heat: thermal conductivities of both bodies, as in 45W/mK,16W/mK"},
    {.name = "diffusivity", .type = OPT_NUMBERS, .unit = UNIT_DIFFUSIVITY, AT(diffusivity), ABOVE_0,
     .arg = "A1,A2", .help = "heat: thermal diffusivities of both bodies"},
    {.name = "moving", .type = OPT_CHOICE, AT(moving), .list = moving_words, .result = true, .arg = "1|2",
     .against = RULES({.with = "creep", .because = "both bodies move past a contact that rolls"}),
     .help = "heat: the body that moves past the contact (default 2)"},
    {.name = "coefficient", .type = OPT_TEXT, AT(coefficient), .result = true, .arg = "K1[,K2]",
     .help = "wear: coefficients of body 1 and body 2, in mm3/Nm, m2/N or 1/GPa"},
    {.name = "distance", .type = OPT_NUMBER, .unit = UNIT_M, AT(distance), ABOVE_0, .arg = "LENGTH",
     .help = "wear: the sliding distance"},
    {.name = "bending-limit", .type = OPT_NUMBER, .unit = UNIT_PA, AT(bending), ABOVE_0, .arg = "F",
     .help = "fatigue: endurance limit of body 1 in fully reversed bending"},
    {.name = "torsion-limit", .type = OPT_NUMBER, .unit = UNIT_PA, AT(torsion), ABOVE_0, .arg = "T",
     .help = "fatigue: the same in torsion"},
    {.name = "pressure-drop", .type = OPT_NUMBER, .unit = UNIT_PA, AT(drop), ABOVE_0, .arg = "DP",
     .help = "leak: of a fluid in the gap, from the left edge of the map to the right one"},
    {.name = "viscosity", .type = OPT_NUMBER, .unit = UNIT_PAS, AT(viscosity), ABOVE_0, .arg = "ETA",
     .needs = RULES({.with = "radius|pressure-drop"}, {.with = "speed|pressure-drop"}),
     .help = "leak, and a warning of a film that carries load: viscosity of the fluid"},
    {.name = "pressure-viscosity", .type = OPT_NUMBER, .unit = UNIT_PER_PA, AT(piezo), ABOVE_0,
      .arg = "ALPHA",
     .needs = RULES({.with = "viscosity"}),
     .help = "the same: its pressure coefficient, in 1/GPa or 1/Pa (default: the bodies are soft)"},
    {.name = "expansion", .type = OPT_NUMBER, AT(expansion), ABOVE_0, .arg = "A",
     .needs = RULES({.with = "mu"}, {.with = "speed"}, {.with = "conductivity"}),
     .help = "warn of thermal expansion: its coefficient, 1/K, for body 1"},
    {.name = NULL},
};
/* clang-format on */
