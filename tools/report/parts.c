/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the page in their order: what they run and show, and which are wanted. */
#include <string.h>

#include "page.h"

struct page_args page_args = {.physics = PHYSICS_NONE,
                              .effects = SCENE_NOTHING,
                              .outliers = NAN,
                              .spikes = NAN,
                              .nu = NAN,
                              .passes = 1};

/* rc-scene compares with a uniform body 1. */
static bool
has_effects(const struct page *run)
{
    (void)run;
    return !isinf(page_args.physics.e1);
}

static bool
is_measured(const struct page *run)
{
    return !run->stream;
}

static bool
has_noise(const struct page *run)
{
    (void)run;
    return page_args.noise.n > 0;
}

bool
page_was_given(const struct page *run, const char *name, size_t n)
{
    for (size_t k = 0; k < run->givens; k++)
        if (strncmp(run->given[k], "--", 2) == 0 && strlen(run->given[k]) == n + 2 &&
            strncmp(run->given[k] + 2, name, n) == 0)
            return true;
    return false;
}

static bool
has_several_loads(const struct page *run)
{
    return run->loads > 1;
}

/* ---- the page: what its parts run and show ---- */

const struct page_part page_parts[] = {
    {.command = "rc-import ORIGINAL", .file = "measured.rcg", .wanted = is_measured},
    {.command = "rc-detrend PREPARED", .file = "surface.rcg"},
    {.show = page_show_verdict},
    {.heading = "The surface",
     .command = "rc-render --quiet --hillshade --width 800 surface.rcg",
     .file = "heights.png",
     .show = page_show_picture,
     .a = "Heights; the section Origin says how they were prepared"},
    {.command = "rc-info --areal --psd surface.rcg",
     .file = "parameters.txt",
     .show = page_show_lines,
     .b = "psd"},
    {.heading = "Heights and wavelengths",
     .command = "rc-render --quiet --material-ratio --width 800 surface.rcg",
     .file = "ratio.png",
     .show = page_show_picture,
     .a = "Material ratio: the share of the surface at or above each height"},
    {.command = "rc-info --json --psd surface.rcg", .file = "spectrum.json"},
    {.command =
         "rc-render --quiet --curve psd.q:psd.c --log xy --subtitle= --width 800 spectrum.json",
     .file = "spectrum.png",
     .show = page_show_picture,
     .a = "Power spectrum, the mean over all directions"},
    {.file = "parameters.txt", .show = page_show_lines, .a = "psd", .b = "keys"},
    {.heading = "Profiles along x",
     .command = "rc-info --profile rows surface.rcg",
     .file = "profiles.txt",
     .show = page_show_lines,
     .a = "profile",
     .b = "keys"},
    {.heading = "Under load", .show = page_show_bodies},
    {.command = "rc-solve CONTACT --output OUTPUT --report loads.tsv surface.rcg",
     .file = "contact.rcg"},
    {.command = "rc-pick --case LAST contact.rcg", .file = "last.rcg"},
    {.command = "rc-render --quiet --width 800 last.rcg",
     .file = "pressure.png",
     .show = page_show_picture,
     .a = "Contact pressure under the last load"},
    {.command = "rc-info --patches last.rcg",
     .file = "contact.txt",
     .show = page_show_lines,
     .b = "keys"},
    {.command = "rc-render --quiet --curve mean_pressure:contact_fraction --log xy --y-unit % "
                "--subtitle= --width 800 loads.tsv",
     .file = "curve.png",
     .show = page_show_picture,
     .a = "Real contact area, as a share of the map, against the mean pressure",
     .wanted = has_several_loads},
    {.command = "rc-stress NU --section y=0 --depths auto --components mises "
                "last.rcg",
     .file = "section.rcg"},
    {.command = "rc-render --quiet --log --width 800 section.rcg",
     .file = "section.png",
     .show = page_show_picture,
     .a = "Mises stress below the middle of the map, under the last load"},
    {.command =
         "rc-stress NU --depths auto --components mises --report stress.json last.rcg -o /dev/null",
     .file = "stress.json"},
    {.heading = "Travel",
     .needs = "travel",
     .command =
         "rc-solve BARE @yield @travel @passes --output pressure --report travel.tsv surface.rcg",
     .file = "travel.rcg"},
    {.needs = "travel",
     .file = "travel.tsv",
     .show = page_show_table,
     .a =
         " position pass height max_pressure contact_fraction strain_gain plastic_depth converged ",
     .says = "After the last pass the body has shaken down.",
     .denies =
         "After the last pass the body has not shaken down: it yields further in more passes.",
     .figure = "shakedown"},
    {.needs = "travel",
     .command =
         "rc-render --quiet --curve position:max_pressure --subtitle= --width 800 travel.tsv",
     .file = "travel.png",
     .show = page_show_picture,
     .a = "Largest pressure at each position"},
    {.heading = "Creep",
     .needs = "relaxation time",
     .command =
         "rc-solve SOFT @relaxation --time TIMES --output pressure --report creep.tsv surface.rcg",
     .file = "creep.rcg"},
    {.needs = "relaxation time",
     .file = "creep.tsv",
     .show = page_show_table,
     .a = " time contact_fraction max_pressure indentation mean_gap pressure_error_estimate "
          "converged ",
     .says = "By creep the share of the map in contact becomes %s in the given time.",
     .figure = "contact_fraction"},
    {.needs = "relaxation time",
     .command = "rc-render --quiet --curve time:contact_fraction --log x --y-unit % --subtitle= "
                "--width 800 creep.tsv",
     .file = "creep.png",
     .show = page_show_picture,
     .a = "Real contact area, as a share of the map, against time"},
    {.heading = "Friction",
     .needs = "mu tangential",
     .command =
         "rc-slip @mu @tangential COUPLING --output pressure,state --report slip.tsv last.rcg",
     .file = "slip.rcg"},
    {.needs = "mu tangential",
     .file = "slip.tsv",
     .show = page_show_figures,
     .a = "tangential_x limit displacement_x stick_fraction largest_slip_total "
          "tangential_stiffness "
          "dissipated_energy "
          "traction_error_estimate converged",
     .says = "The tangential force leaves a share of %s of the contact sticking.",
     .figure = "stick_fraction"},
    {.needs = "mu tangential",
     .command = "rc-render --quiet --channel state --width 800 slip.rcg",
     .file = "slip.png",
     .show = page_show_picture,
     .a = "Where the contact sticks, and where it slips"},
    {.heading = "Rolling",
     .needs = "mu creep",
     .command = "rc-slip @mu @creep --steady --output pressure,state --report rolling.tsv last.rcg",
     .file = "rolling.rcg"},
    {.needs = "mu creep",
     .file = "rolling.tsv",
     .show = page_show_figures,
     .a = "creep_x creep_y spin tangential_x tangential_y moment limit stick_fraction power "
          "traction_error_estimate discretization_error_estimate converged",
     .says = "Rolling with these creepages leaves a share of %s of the contact sticking.",
     .figure = "stick_fraction"},
    {.needs = "mu creep",
     .command = "rc-render --quiet --channel state --width 800 rolling.rcg",
     .file = "rolling.png",
     .show = page_show_picture,
     .a = "Where the contact sticks, and where it slips, in steady rolling towards the right"},
    {.heading = "Wear",
     .needs = "coefficient distance",
     .command = "rc-wear @coefficient @distance --report wear.tsv --steps steps.tsv last.rcg",
     .file = "wear.rcg"},
    {.needs = "coefficient distance",
     .file = "wear.tsv",
     .show = page_show_figures,
     .a = "distance wear_volume wear_volume_1 wear_volume_2 max_wear_depth mean_wear_depth "
          "contact_fraction "
          "max_pressure approach wear_error_estimate pressure_error_estimate "
          "max_pressure_error_estimate converged",
     .says = "At the end of the sliding distance the largest worn depth is %s.",
     .figure = "max_wear_depth",
     .wide = "max_pressure_error_estimate",
     .covers =
         "it covers each node that may have the largest pressure, also one that has just come "
         "into contact at an edge that the grid does not resolve, and may be far above the "
         "error"},
    {.needs = "coefficient distance",
     .command = "rc-render --quiet --curve distance:max_pressure --log xy --subtitle= --width 800 "
                "steps.tsv",
     .file = "wear.png",
     .show = page_show_picture,
     .a = "Largest pressure against the sliding distance"},
    {.heading = "Heat",
     .needs = "mu speed conductivity diffusivity",
     .command =
         "rc-heat @mu @speed @conductivity @diffusivity @moving @time --report heat.tsv last.rcg",
     .file = "heat.rcg"},
    {.needs = "mu speed conductivity diffusivity",
     .file = "heat.tsv",
     .show = page_show_figures,
     .a = "speed heat_power share_1 max_temperature max_x max_y mean_temperature "
          "temperature_error_estimate "
          "steady_time converged",
     .says = "Friction heats the contact by up to %s.",
     .figure = "max_temperature"},
    {.needs = "mu speed conductivity diffusivity",
     .command = "rc-render --quiet --channel temperature-1 --width 800 heat.rcg",
     .file = "heat.png",
     .show = page_show_picture,
     .a = "Temperature of the surface of body 1, above that of the bodies"},
    {.heading = "Leak",
     .needs = "pressure-drop",
     .command = "rc-leak FLUID --report leak.tsv last.rcg",
     .file = "leak.rcg"},
    {.needs = "pressure-drop",
     .file = "leak.tsv",
     .show = page_show_figures,
     .a = "percolates flow_rate flow_conductance flow_factor mean_gap critical_gap critical_x "
          "critical_y "
          "throat_nodes discretization_error_estimate",
     .says = "A fluid gets through the gap.",
     .denies = "No fluid gets through the gap.",
     .figure = "percolates"},
    {.needs = "pressure-drop",
     .command = "rc-render --quiet --channel channel --width 800 leak.rcg",
     .file = "leak.png",
     .show = page_show_picture,
     .a = "Where the fluid flows, and where it stands"},
    {.heading = "Fatigue",
     .needs = "bending-limit torsion-limit",
     .command = "rc-fatigue NU @bending-limit @torsion-limit --pass x --depths auto --report "
                "fatigue.tsv last.rcg",
     .file = "fatigue.rcg"},
    {.needs = "bending-limit torsion-limit",
     .file = "fatigue.tsv",
     .show = page_show_figures,
     .a = "safety crossland crossland_depth dangvan dangvan_depth amplitude amplitude_depth "
          "sampling_error_estimate converged",
     .says = "As if this surface passed along x over a smooth body 1, the safety factor against "
             "fatigue is %s; a rough body 1, over which a smooth body passes, needs "
             "'rc-solve --travel'.",
     .figure = "safety"},
    {.heading = "Shakedown",
     .needs = "yield",
     .command = "rc-fatigue NU --criteria shakedown @yield --pass x --depths auto --report "
                "shakedown.tsv last.rcg",
     .file = "shakedown.rcg"},
    {.needs = "yield",
     .file = "shakedown.tsv",
     .show = page_show_figures,
     .a = "shakedown shakedown_x shakedown_y shakedown_depth shakedown_error_estimate",
     .says = "As if this surface passed along x over a smooth body 1, the index of elastic "
             "shakedown is %s; above 1 the body yields again at each pass.",
     .figure = "shakedown"},
    {.heading = "Effects",
     .command = "rc-scene SCENE --report effects.tsv surface.rcg",
     .file = "effects.txt",
     .show = page_show_effects,
     .wanted = has_effects,
     .may_fail = true},
    {.heading = "Accuracy",
     .file = "loads.tsv",
     .show = page_show_table,
     .a = " mean_pressure load contact_fraction max_pressure converged pressure_error_estimate "
          "edge_load_fraction nodes_per_patch "},
    {.command =
         "rc-cost --quiet --noise NOISE --resolution --report bars.tsv -o bars.txt surface.rcg "
         "-- rc-solve CONTACT",
     .file = "bars.tsv",
     .show = page_show_bars,
     .wanted = has_noise,
     .may_fail = true},
    {.show = page_show_messages},
    {.heading = "Limits", .show = page_show_limits},
    {.heading = "Origin", .file = "parameters.txt", .show = page_show_lines, .a = "keys"},
    {.heading = "Commands", .show = page_show_commands},
};
const size_t page_part_count = sizeof page_parts / sizeof *page_parts;

bool
page_is_wanted(const struct page *run, const struct page_part *part)
{
    if (part->wanted != NULL && !part->wanted(run))
        return false;
    for (const char *at = part->needs; at != NULL && *at != '\0'; at += strspn(at, " ")) {
        const size_t n = strcspn(at, " ");

        if (!page_was_given(run, at, n))
            return false;
        at += n;
    }
    return true;
}

/* True if the page has a section of an effect that reads the gap and the heights of the contact. */
bool
page_has_readers(const struct page *run)
{
    for (size_t k = 0; k < page_part_count; k++)
        if (page_parts[k].needs != NULL && page_parts[k].command != NULL &&
            page_is_wanted(run, &page_parts[k]) &&
            strstr(page_parts[k].command, "last.rcg") != NULL)
            return true;
    return false;
}
