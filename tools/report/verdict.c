/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The first paragraph: the contact and the effects in words, and what limits the trust in them. */
#include <stdlib.h>
#include <string.h>

#include "page.h"

/* The first paragraph of a contact in words: area, pressure, what yields, the error. */
static void
put_contact(struct page *run)
{
    static const char loads[] = "loads.tsv";
    const struct physics *p = &page_args.physics;
    FILE *out = run->page.file;
    const double bound = page_last_number(run, loads, "plastic_area"),
                 area = page_last_number(run, loads, "contact_area");
    const double stress = json_real(json_member(run->stress, "largest.mises.value")),
                 depth = json_real(json_member(run->stress, "largest.mises.depth"));
    const double fraction = page_last_number(run, loads, "contact_fraction");

    fputs("Under a load of ", out);
    page_last(run, loads, "load");
    fputs(", a mean pressure of ", out);
    page_last(run, loads, "mean_pressure");
    fprintf(out, ", the bodies touch on %.3g %% of the map, ", 100 * fraction);
    page_last(run, loads, "contact_area");
    fputs(". The largest pressure is ", out);
    page_last(run, loads, "max_pressure");
    if (isfinite(p->hardness) && bound > 0)
        fprintf(out, ": the hardness, at which %.3g %% of the contact yields. ",
                100 * bound / area);
    else if (isfinite(p->hardness))
        fputs(", below the hardness: nothing yields at the surface. ", out);
    else
        fputs("; the bodies are elastic, and no hardness limits it. ", out);
    if (!isnan(stress)) {
        fprintf(out, "Below it the largest Mises stress is %sPa", shown_number(stress, 4, "Pa"));
        if (depth > 0)
            fprintf(out, ", %sm deep", shown_number(depth, 3, "m"));
        if (!(run->yield > 0))
            fputs(": a material with a lower yield stress yields there. ", out);
        else
            fprintf(out, ", %s the yield stress of %s: %s. ",
                    stress > run->yield ? "above" : "below", shown_in_unit(run->yield, "Pa"),
                    stress > run->yield ? "the volume yields, which these figures do not include"
                                        : "the volume stays elastic");
    }
    fprintf(out, "The estimated error of the pressure is %.2g %%",
            100 * page_last_number(run, loads, "pressure_error_estimate"));
    if (!isnan(page_last_number(run, loads, "contact_area_error_estimate")))
        fprintf(out, ", that of the area %.2g %%",
                100 * page_last_number(run, loads, "contact_area_error_estimate"));
    fputs(".\n", out);
}

/* True if any row of a table has this text in a column. */
static bool
has_cell(struct page *run, const char *file, const char *column, const char *text)
{
    FILE *in = page_open(run, file);
    RC_OWNED char *line = NULL;
    size_t room = 0, at = SIZE_MAX;
    bool found = false;

    for (size_t row = 0; !found && getline(&line, &room, in) > 0; row++) {
        char *cell = line, *rest;

        for (size_t k = 0; *cell != '\0'; k++, cell = rest) {
            rest = page_end_cell(cell);
            if (row == 0 && strcmp(cell, column) == 0)
                at = k;
            found = found || (row > 0 && k == at && strcmp(cell, text) == 0);
        }
    }
    fclose(in);
    return found;
}

/* What limits the trust in the contact, each in some words; `inaccurate`: sections of effects. */
static void
put_limits(struct page *run, const char *inaccurate)
{
    static const char loads[] = "loads.tsv";
    const double nodes = page_last_number(run, loads, "contact_nodes"),
                 patch = page_last_number(run, loads, "nodes_per_patch"),
                 edge = page_last_number(run, loads, "edge_load_fraction"),
                 slope = page_last_number(run, loads, "rms_slope");
    char text[PAGE_CELL], unit[PAGE_CELL];
    const struct {
        bool holds;
        const char *format;
        double value;
    } limit[] = {
        {page_last_cell(run, loads, "converged", text, unit) && strcmp(text, "false") == 0,
         "the solver stopped before its tolerance", 0},
        {nodes < 100, "only %.0f nodes touch, so that the grid decides", nodes},
        {nodes >= 100 && patch < 4, "a contact patch has only %.2g nodes, so that the grid decides",
         patch},
        {rc_repeats(page_args.physics.boundary) == 0 && edge > 0.01,
         "the edge of the map carries %.2g %% of the load, so that a larger map has another result",
         100 * edge},
        {slope > 0.3,
         "the RMS slope where the bodies touch is %.2g, beyond the theory of small slopes", slope},
        {page_last_number(run, loads, "max_pressure") > page_args.physics.surface_estar / 10,
         "the largest pressure is beyond a tenth of E*, where strains are not small", 0},
        {page_args.relaxation != NULL && page_has_readers(run),
         "the sections of other effects are those of the contact before creep", 0},
        {run->assumed, "no elasticity was given, so that the values are those of steel on steel",
         0},
    };
    FILE *out = run->page.file;
    size_t n = 0;

    if (*inaccurate != '\0') {
        fprintf(out,
                "What limits the trust in these figures: the requested accuracy was not reached "
                "under %s",
                inaccurate);
        n++;
    }
    for (size_t k = 0; k < sizeof limit / sizeof *limit; k++)
        if (limit[k].holds) {
            fputs(n++ == 0 ? "What limits the trust in these figures: " : "; ", out);
            fprintf(out, limit[k].format, limit[k].value);
        }
    if (n == 0)
        fputs(page_args.noise.n > 0
                  ? "The checks of the grid, the edges and the slopes found nothing that limits "
                    "these figures; the bars under Accuracy are those of the measurement"
                  : "The checks of the grid, the edges and the slopes found nothing that limits "
                    "these figures; --noise adds bars for the measurement",
              out);
    fputs(".\n", out);
}

/* The sections of effects with a row that is not converged, as "Travel, Wear". */
static const char *
name_inaccurate(struct page *run, char text[PAGE_CELL])
{
    const char *heading = "";
    size_t n = 0;

    text[0] = '\0';
    for (size_t k = 0; k < page_part_count; k++) {
        const struct page_part *part = &page_parts[k];

        if (part->heading != NULL)
            heading = part->heading;
        if (part->needs != NULL && part->command == NULL && page_is_wanted(run, part) &&
            has_cell(run, part->file, "converged", "false") && n < PAGE_CELL)
            n += (size_t)snprintf(text + n, PAGE_CELL - n, "%s%s", n > 0 ? ", " : "", heading);
    }
    return text;
}

void
page_show_verdict(struct page *run, FILE *in, const char *a, const char *b)
{
    FILE *out = run->page.file;
    char text[PAGE_CELL], unit[PAGE_CELL], inaccurate[PAGE_CELL];

    (void)in, (void)a, (void)b;
    fputs("<p id=\"verdict\">", out);
    put_contact(run);
    for (size_t k = 0; k < page_part_count; k++) {
        const char *says = page_parts[k].says, *at;

        if (says == NULL || !page_is_wanted(run, &page_parts[k]) ||
            !page_last_cell(run, page_parts[k].file, page_parts[k].figure, text, unit) ||
            strcmp(text, "NaN") == 0)
            continue;
        if (strcmp(text, "false") == 0 || strcmp(text, "no") == 0)
            says = page_parts[k].denies != NULL ? page_parts[k].denies : says;
        at = strstr(says, "%s");
        fprintf(out, "%.*s", at == NULL ? (int)strlen(says) : (int)(at - says), says);
        if (at != NULL)
            page_value(out, text, unit);
        fprintf(out, "%s\n", at == NULL ? "" : at + 2);
    }
    put_limits(run, name_inaccurate(run, inaccurate));
    fputs("</p>\n", out);
}
