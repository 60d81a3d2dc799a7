/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Materials by name: --body1 steel sets the options of body 1 that the line leaves out.
 */
#ifndef RC_MATERIALS_H
#define RC_MATERIALS_H

#include "tools/cli/cli.h"

enum material_property {
    MATERIAL_E,
    MATERIAL_NU,
    MATERIAL_HARDNESS,
    MATERIAL_YIELD,
    MATERIAL_CONDUCTIVITY,
    MATERIAL_DIFFUSIVITY,
    MATERIAL_PROPERTIES
};

/* Values as on a command line, with their units; NULL: unknown, and then without a source. */
struct material {
    const char *names; /* separated by '|' */
    struct material_value {
        const char *value, *source;
    } of[MATERIAL_PROPERTIES];
};
extern const struct material material_table[]; /* ends with a row without names */

/* --body1, --body2 and --materials, or without --body2; the values are those of one command line. */
extern const struct opt material_options[], material_options_of_one[];

/* For tool_info.fill: sets those options of tool_info.of_materials that the line does not give. */
void materials_fill(struct tool *tool);
/* A property of the material of body 1, as on a command line, after materials_fill; NULL: it has none. */
const char *materials_value(struct tool *tool, enum material_property property);
/* After materials_fill: which body has no value for this option, as in "the table has no hardness of steel, body 1";
 * "" if none lacks it. */
const char *materials_lack(const char *option);

#endif
