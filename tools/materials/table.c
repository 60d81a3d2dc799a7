/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Published values at room temperature; rc-solve(1) has the sources in full. A value without a source is left
 * out. */
#include "materials.h"

static const char kaye[] = "Kaye and Laby 1995", incropera[] = "Incropera 2007",
                  matweb[] = "MatWeb", coors[] = "CoorsTek AD-995", hopcroft[] = "Hopcroft 2010",
                  klein[] = "Klein 1993", johnston[] = "Johnston 2014",
                  incompressible[] = "incompressible", nothing[] = "by definition";

#define ELASTIC(e, nu, source) [MATERIAL_E] = {e, source}, [MATERIAL_NU] = {nu, source}
#define HARD(value, source) [MATERIAL_HARDNESS] = {value, source}
#define YIELDS(value, source) [MATERIAL_YIELD] = {value, source}
#define THERMAL(k, a, source)                                                                      \
    [MATERIAL_CONDUCTIVITY] = {k, source}, [MATERIAL_DIFFUSIVITY] = {a, source}

/* clang-format off */
const struct material material_table[] = {
    {"rigid", {[MATERIAL_E] = {"rigid", nothing}}},
    {"steel|mild-steel", {ELASTIC("211.9GPa", "0.291", kaye), THERMAL("60.5W/mK", "17.7mm2/s", incropera)}},
    {"100Cr6|52100|AISI-52100", {ELASTIC("210GPa", "0.3", matweb), HARD("848HV", matweb),
                                 THERMAL("46.6W/mK", "12.6mm2/s", matweb)}},
    {"tool-steel", {ELASTIC("211.6GPa", "0.287", kaye)}},
    {"stainless-steel|AISI-304|304", {ELASTIC("193GPa", "0.29", matweb), HARD("129HV", matweb),
                                      YIELDS("215MPa", matweb), THERMAL("14.9W/mK", "3.95mm2/s", incropera)}},
    {"iron", {ELASTIC("211.4GPa", "0.293", kaye), THERMAL("80.2W/mK", "23.1mm2/s", incropera)}},
    {"cast-iron", {ELASTIC("152.3GPa", "0.27", kaye)}},
    {"aluminium", {ELASTIC("70.3GPa", "0.345", kaye), THERMAL("237W/mK", "97.1mm2/s", incropera)}},
    {"6061-T6|aluminium-6061", {ELASTIC("68.9GPa", "0.33", matweb), HARD("107HV", matweb),
                                YIELDS("276MPa", matweb), THERMAL("167W/mK", "69mm2/s", matweb)}},
    {"7075-T6|aluminium-7075", {ELASTIC("71.7GPa", "0.33", matweb), HARD("175HV", matweb),
                                YIELDS("503MPa", matweb), THERMAL("130W/mK", "48.2mm2/s", matweb)}},
    {"copper", {ELASTIC("129.8GPa", "0.343", kaye), THERMAL("401W/mK", "117mm2/s", incropera)}},
    {"brass", {ELASTIC("100.6GPa", "0.35", kaye), THERMAL("110W/mK", "33.9mm2/s", incropera)}},
    {"gold", {ELASTIC("78GPa", "0.44", kaye), THERMAL("317W/mK", "127mm2/s", incropera)}},
    {"silver", {ELASTIC("82.7GPa", "0.367", kaye), THERMAL("429W/mK", "174mm2/s", incropera)}},
    {"platinum", {ELASTIC("168GPa", "0.377", kaye), THERMAL("71.6W/mK", "25.1mm2/s", incropera)}},
    {"tin", {ELASTIC("49.9GPa", "0.357", kaye), THERMAL("66.6W/mK", "40.1mm2/s", incropera)}},
    {"lead", {ELASTIC("16.1GPa", "0.44", kaye), THERMAL("35.3W/mK", "24.1mm2/s", incropera)}},
    {"zinc", {ELASTIC("108.4GPa", "0.249", kaye), THERMAL("116W/mK", "41.8mm2/s", incropera)}},
    {"nickel", {ELASTIC("199.5GPa", "0.312", kaye), THERMAL("90.7W/mK", "23mm2/s", incropera)}},
    {"chromium", {ELASTIC("279.1GPa", "0.21", kaye), THERMAL("93.7W/mK", "29.1mm2/s", incropera)}},
    {"molybdenum", {ELASTIC("324.8GPa", "0.293", kaye), THERMAL("138W/mK", "53.7mm2/s", incropera)}},
    {"tungsten", {ELASTIC("411GPa", "0.28", kaye), THERMAL("174W/mK", "68.3mm2/s", incropera)}},
    {"titanium", {ELASTIC("120.2GPa", "0.361", kaye), THERMAL("21.9W/mK", "9.32mm2/s", incropera)}},
    {"Ti-6Al-4V|Ti6Al4V", {ELASTIC("113.8GPa", "0.342", matweb), HARD("349HV", matweb),
                           YIELDS("880MPa", matweb), THERMAL("6.7W/mK", "2.87mm2/s", matweb)}},
    {"tungsten-carbide", {ELASTIC("534.4GPa", "0.22", kaye)}},
    {"alumina|Al2O3", {ELASTIC("370GPa", "0.22", coors), HARD("14.1GPa", coors),
                       THERMAL("36W/mK", "11.9mm2/s", incropera)}},
    {"silicon|Si", {ELASTIC("130GPa", "0.28", hopcroft), THERMAL("148W/mK", "89.2mm2/s", incropera)}},
    {"diamond", {ELASTIC("1143GPa", "0.069", klein), [MATERIAL_CONDUCTIVITY] = {"2300W/mK", incropera}}},
    {"glass|crown-glass", {ELASTIC("71.3GPa", "0.22", kaye), THERMAL("1.4W/mK", "0.747mm2/s", incropera)}},
    {"fused-silica|quartz-glass", {ELASTIC("73.1GPa", "0.17", kaye),
                                   THERMAL("1.38W/mK", "0.834mm2/s", incropera)}},
    {"PDMS|Sylgard-184", {[MATERIAL_E] = {"1.32MPa", johnston}, [MATERIAL_NU] = {"0.5", incompressible}}},
    {.names = NULL},
};
/* clang-format on */
