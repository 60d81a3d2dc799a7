/* Options that define the contact, for all tools that solve it. */
#include "solve.h"

#include <math.h>

#define AT(field) .at = offsetof(struct solve_args, field)

/* clang-format off */
const struct opt solve_contact_options[] = {
    {.group = physics_options, AT(physics)},
    {.title = "yield"},
    {.name = "yield", .type = OPT_TEXT, AT(yield), .result = true, .arg = "Y[,HM]|FILE",
     .help = "yield stress of body 1 (in its volume), and its increase per plastic strain, HM"},
    {.title = "adhesion"},
    {.name = "adhesion", .type = OPT_TEXT, AT(adhesion), .result = true, .arg = "WORK[,LAW[,RANGE]]",
     .help = "the bodies attract each other: 50mJ/m2, 50mJ/m2,exponential,2nm; a list is a path"},
    {.title = "load and bodies"},
    {.name = "history", .type = OPT_FLAG, AT(physics.history), .result = true,
     .help = "apply the loads in sequence, keeping plastic shape; 0 separates the bodies"},
    {.name = "tilt", .type = OPT_CHOICE, AT(tilt), .result = true,
     .list = (const char *const[]){"fixed", "free", NULL},
     .help = "free: the counter body tilts until the moment is zero (default fixed)"},
    {.name = "at", .type = OPT_NUMBERS, .unit = UNIT_M, AT(at), .min = -INFINITY, .max = INFINITY,
     .result = true, .arg = "X,Y",
     .help = "point where the load acts, with --tilt free (default: the middle)"},
    {.name = NULL},
};
/* clang-format on */
