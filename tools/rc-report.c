/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A page about a measured surface: the other tools do the steps, and this one puts their pictures, tables and
 * texts together. */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "formats/core/core.h"
#include "tools/materials/materials.h"
#include "tools/report/page.h"

#define AT(field) .at = offsetof(struct page_args, field)
/* clang-format off */
static const struct opt opts[] = {
    {.name = "spikes", .type = OPT_NUMBER, AT(spikes), .min = 0, .max = INFINITY, .above = true,
     .against = RULES({.with = "outliers", .because = "both remove single points"}), .arg = "T",
     .help = "drop spikes of 1 to 9 points that stand out by T deviations; grooves stay, see rc-detrend"},
    {.name = "outliers", .type = OPT_NUMBER, AT(outliers), .min = 0, .max = INFINITY, .above = true,
     .arg = "T", .help = "drop points that differ by T deviations from the median of their neighbours"},
    {.name = "mirror", .type = OPT_FLAG, AT(mirror),
     .help = "add the mirror images about two edges, and solve the contact as periodic; with "
             "--periodic=x or y those along this axis"},
    {.group = physics_options, AT(physics)},
    {.group = material_options},
    {.name = "nu", .type = OPT_NUMBER, AT(nu), .min = -1, .max = 0.5, .above = true, .arg = "RATIO",
     .against = RULES({.with = "nu1", .because = "--nu1 is the ratio for the stresses too",
                       .remedy = "leave out --nu"}),
     .help = "Poisson's ratio for the stresses (default: --nu1, else 0.28)"},
    {.name = "noise", .type = OPT_NUMBERS, .unit = UNIT_M, AT(noise), .min = 0, .max = INFINITY,
     .above = true, .arg = "SIGMA[,LENGTH]",
     .help = "noise of the measurement: the figures of the contact get bars, as by rc-cost"},
    {.title = "data of the effects"},
    {.group = scene_options, AT(effects)},
    {.name = "relaxation", .type = OPT_TEXT, AT(relaxation), .result = true, .arg = "EINF,E1:TAU1,...|FILE",
     .against = RULES({.with = "E1 MODULUS", .because = "the moduli of body 1 are those of --relaxation"},
                      {.with = "estar", .because = "body 1 needs its Poisson's ratio"}),
     .help = "creep: the relaxation modulus of body 1, instead of --E1; with --time"},
    {.name = "travel", .type = OPT_TEXT, AT(travel), .result = true, .arg = "LIST",
     .needs = RULES({.with = "radius|cylinder", .because = "nothing travels"}),
     .help = "travel: positions of the contact along x, from the middle of the map"},
    {.name = "passes", .type = OPT_COUNT, AT(passes), .min = 1, .max = 1e6, .result = true, .arg = "N",
     .needs = RULES({.with = "travel"}, {.with = "yield",
       .because = "an elastic body does not change from pass to pass"}),
     .help = "travel: go through the positions N times, with --yield in the volume"},
    {.title = "output"},
    {.name = "title", .type = OPT_TEXT, AT(title), .arg = "TEXT",
     .help = "title of the page (default: the name of the file)"},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-report",
    .summary = "One page about a measured surface: maps, parameters, contact and stresses",
    .operands = "FILE",
    .examples =
        "  rc-report -o page.html surface.x3p\n"
        "  rc-report --spikes 5 --load 1N:20N:log:5 --estar 3GPa -o page.html surface.x3p\n",
    .opts = opts,
    .fill = materials_fill,
    .of_materials = (const char *const[]){"E1", "nu1", "E2", "nu2", NULL},
    .reads = READS_FILES,
    .writes = WRITES_BYTES,
};

/* ---- the command line ---- */

/* Gives an option that the command line does not have. */
static void
assume(struct tool *t, const char *name, const char *text)
{
    for (size_t k = 0; k < t->option.n; k++) {
        const struct opt *o = &t->option.row[k];
        void *at = (char *)t->args + o->at;

        if (strcmp(o->name, name) != 0)
            continue;
        t->option.given[k] = true;
        if (o->type == OPT_NUMBERS)
            (void)unit_numbers(text, o->unit, at, NULL);
        else
            (void)unit_number(text, o->unit, at, NULL);
    }
}

/* True for an option of this table; its word may end in "=VALUE". */
static bool
is_option(const struct opt *row, const char *word)
{
    for (; row->name != NULL; row++)
        if (strncmp(word, "--", 2) == 0 && strlen(row->name) == strcspn(word + 2, "=") &&
            strncmp(word + 2, row->name, strlen(row->name)) == 0)
            return true;
    return false;
}

/* The path of a file that an option names, or its word. */
static const char *
find_file(struct page *run, const char *option, const char *word)
{
    const size_t k = strcmp(option, "--relaxation") == 0 ? 0 : 1;

    if (k == 1 && strcmp(option, "--materials") != 0)
        return word;
    free(run->named[k].path);
    run->named[k] = (struct named){word, realpath(word, NULL)};
    return run->named[k].path == NULL ? word : run->named[k].path;
}

/* A value as it was typed, or as the table of materials has it; `si` if it was neither. */
static const char *
as_typed(const struct tool *t, const char *option, const char *si)
{
    for (size_t k = 0; k < t->option.n; k++) {
        const struct opt *o = &t->option.row[k];

        if (o->name != NULL && (o->type == OPT_NUMBER || o->type == OPT_NUMBERS) &&
            strcmp(o->name, option + 2) == 0 && t->option.text[k] != NULL)
            return t->option.text[k];
    }
    return si;
}

/* Gives rc-solve the options of the contact, and rc-scene those with the last load and the data of
 * effects. */
static void
divide_words(struct page *run)
{
    const char *all[PAGE_WORDS / 2];
    const struct numbers *steps = physics_steps(&page_args.physics);
    const size_t n = tool_result_words(&run->t, all, PAGE_WORDS / 2);
    bool of_scene = false, of_load = false, of_page = false, softens = false, modulus = false;

    snprintf(run->load, sizeof run->load, "%s%s", rc_number(steps->v[steps->n - 1]),
             steps->per_metre ? "N/m" : "");
    for (size_t k = 0; k < run->contacts; k++)
        run->scene[run->scenes++] = run->contact[k];
    for (size_t k = 0; k < n; k++) {
        const bool name = strncmp(all[k], "--", 2) == 0, value = of_load && !name;
        const char *typed = name || k == 0 ? all[k] : as_typed(&run->t, all[k - 1], all[k]);
        if (name) {
            of_page = strcmp(all[k], "--travel") == 0 || strcmp(all[k], "--passes") == 0;
            softens = strcmp(all[k], "--relaxation") == 0;
            modulus = page_args.relaxation != NULL && strcmp(all[k], "--E1") == 0;
            of_scene = of_page || softens || is_option(scene_options, all[k]);
            of_load = page_is_load(all[k]);
        }
        if (typed == all[k] && k > 0 && !name)
            typed = find_file(run, all[k - 1], all[k]);
        run->given[run->givens++] = typed;
        if (!of_scene)
            run->contact[run->contacts++] = typed;
        if (!of_page && !modulus)
            run->scene[run->scenes++] = value ? run->load : typed;
    }
}

/* The data of the sections: the modulus of a viscoelastic body 1 at once, times, the yield stress. */
static void
check_effects(struct page *run)
{
    struct tool *t = &run->t;
    const double time = page_args.effects.time;
    const char *given = page_args.effects.yield != NULL ? page_args.effects.yield
                                                        : materials_value(t, MATERIAL_YIELD);
    struct numbers yield;

    if (tool_given(t, "speed") && tool_given(t, "creep"))
        tool_usage(t, "--speed with --creep is the speed of rolling, and the section about heat is "
                      "that of sliding: leave out one of them, or see rc-scene and rc-heat "
                      "--rolling");
    run->yield = NAN;
    if (given != NULL && unit_numbers(given, UNIT_PA, &yield, NULL) == RC_OK) {
        run->yield = yield.v[0];
        free(yield.v);
    }
    if (page_args.relaxation != NULL) {
        struct relaxation_law law;
        char modulus[RC_NUMBER_SIZE];

        if (relaxation_law_read(&law, page_args.relaxation, NULL, &t->err) != RC_OK)
            tool_usage(t, "--relaxation %s: %s", page_args.relaxation, t->err.text);
        rc_number_text(modulus, 1 / law.material->instant); /* a compliance */
        rc_relaxation_free(law.material);
        assume(t, "E1", modulus);
        if (!isnan(time)) {
            char first[RC_NUMBER_SIZE];

            rc_number_text(first, time / 1000);
            snprintf(run->times, sizeof run->times, "%s:%s:log:7", first, rc_number(time));
        }
    }
}

static void
check_contact(struct page *run)
{
    struct tool *t = &run->t;
    bool quiet = t->quiet;

    if (!tool_given(t, "load") && !tool_given(t, "mean-pressure") && !tool_given(t, "approach"))
        assume(t, "mean-pressure", "2MPa:64MPa:log:6");
    if (!tool_given(t, "estar") && !tool_given(t, "E1") && !tool_given(t, "nu1") &&
        !tool_given(t, "E2") && !tool_given(t, "nu2")) {
        run->assumed = true;
        assume(t, "estar", "114GPa");
        tool_warn(t, "no elasticity was given, so the bodies are steel on steel: E* is 114 GPa%s",
                  tool_given(t, "hardness") ? "" : ", and the hardness is 6 GPa");
        if (!tool_given(t, "hardness"))
            assume(t, "hardness", "6GPa");
    }
    if (page_args.mirror && page_args.physics.repeats.periodic == NULL) {
        page_args.physics.repeats.periodic = "";
        run->contact[run->contacts++] = "--periodic";
    }
    check_effects(run);
    t->quiet = true; /* rc-solve gives these warnings */
    physics_check(t, &page_args.physics);
    t->quiet = quiet;
    run->loads = physics_steps(&page_args.physics)->n;
    divide_words(run);
    rc_number_text(run->last, (double)run->loads);
    if (!tool_given(t, "nu1") && page_args.physics.layer.n == 0) /* layers have their own */
        rc_number_text(run->nu, isnan(page_args.nu) ? 0.28 : page_args.nu);
}

static void
check_file(struct page *run)
{
    struct tool *t = &run->t;
    char head[4] = "";
    FILE *in;

    if (t->operands != 1)
        tool_usage(t, "%zu files were given: give one, as in rc-report -o page.html FILE",
                   t->operands);
    run->file = t->operand[0];
    if (strcmp(run->file, "-") == 0)
        tool_usage(t,
                   "-: the page names its file: write standard input to a file and give its name");
    if ((run->path = realpath(run->file, NULL)) == NULL || (in = fopen(run->path, "rb")) == NULL)
        tool_die(t, "%s: %s", run->file, strerror(errno));
    run->stream = fread(head, 1, 4, in) == 4 && memcmp(head, "RCG1", 4) == 0;
    fclose(in);
    run->name = strrchr(run->file, '/') == NULL ? run->file : strrchr(run->file, '/') + 1;
}

static void
check_arguments(struct page *run)
{
    check_file(run);
    check_contact(run);
    if (!isnan(page_args.outliers))
        rc_number_text(run->outliers, page_args.outliers);
    if (!isnan(page_args.spikes))
        rc_number_text(run->spikes, page_args.spikes);
    if (page_args.noise.n > 2)
        tool_usage(&run->t, "--noise takes a standard deviation and a length, not %zu numbers",
                   page_args.noise.n);
    for (size_t k = 0; k < page_args.noise.n; k++)
        snprintf(run->noise + strlen(run->noise), RC_NUMBER_SIZE, "%s%s", k > 0 ? "," : "",
                 rc_number(page_args.noise.v[k]));
    if (run->t.memory > 0)
        rc_number_text(run->memory, (double)run->t.memory);
    setenv("RC_THREADS", rc_number((double)run->t.threads), 1);
}

/* ---- the run ---- */

static void
demand_one_map(struct page *run)
{
    FILE *in = page_open(run, "surface.rcg");
    struct rc_err err;
    struct rc_reader *reader = rc_reader_new(in, 0, 0, &err);
    struct rc_grid *g;
    size_t maps = 0;

    for (; reader != NULL && rc_reader_next(reader, &g, &err) == RC_MORE; maps++)
        rc_grid_free(g);
    if (maps != 1)
        tool_die(&run->t,
                 "%s: it holds %zu maps, and a page is about one: choose one with rc-import and "
                 "rc-pick, "
                 "and give the new file",
                 run->file, maps);
    rc_reader_free(reader);
    fclose(in);
}

/* Reads the start of a file of the folder. */
static void
read_text(struct page *run, const char *name, char *text, size_t size)
{
    FILE *in = page_open(run, name);

    text[fread(text, 1, size - 1, in)] = '\0';
    fclose(in);
}

static void
run_parts(struct page *run)
{
    bool fails = false; /* a command of this section */

    for (size_t k = 0; k < page_part_count; k++) {
        const struct page_part *part = &page_parts[k];

        if (part->heading != NULL)
            fails = false;
        if (!page_is_wanted(run, part))
            continue;
        if (fails)
            page_leave_empty(run, part->file);
        else if (part->command != NULL)
            fails = !page_run_part(run, part);
        if (part->command != NULL && strcmp(part->file, "surface.rcg") == 0)
            demand_one_map(run);
    }
    read_text(run, "stress.json", run->stress, sizeof run->stress);
}

static void
write_page(struct page *run)
{
    const char *title = page_args.title == NULL ? run->name : page_args.title;
    FILE *out = run->page.file, *in;

    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
          "<meta http-equiv=\"Content-Security-Policy\" "
          "content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'\"/>\n<title>",
          out);
    page_text(out, title);
    fputs("</title>\n<style>body{font:16px/1.5 sans-serif;max-width:52em;margin:2em auto;padding:0 "
          "1em;"
          "color:#222}img{max-width:100%}figure{margin:1em 0}figcaption{color:#595959}"
          "pre{background:#f4f4f4;padding:.8em;white-space:pre-wrap;overflow-wrap:anywhere}"
          "table{font-size:85%}td,th{padding:.2em .6em;text-align:right}"
          "#effects td,#effects th{text-align:left;vertical-align:top}#effects pre{margin:0}"
          "</style>\n</head>\n<body>\n<h1>",
          out);
    page_text(out, title);
    fputs("</h1>\n", out);
    for (size_t k = 0; k < page_part_count; k++) {
        const struct page_part *part = &page_parts[k];

        if (!page_is_wanted(run, part))
            continue;
        if (part->heading != NULL)
            fprintf(out, "<h2>%s</h2>\n", part->heading);
        if (part->show == NULL)
            continue;
        run->shown = part->file;
        in = part->file == NULL ? NULL : page_open(run, part->file);
        part->show(run, in, part->a, part->b);
        if (in != NULL)
            fclose(in);
    }
    fputs("</body>\n</html>\n", out);
}

static void
open_text(struct page *run, struct text *text)
{
    if ((text->file = open_memstream(&text->text, &text->size)) == NULL)
        tool_die(&run->t, "out of memory");
}

static void
close_text(struct page *run, struct text *text)
{
    if (ferror(text->file) || fclose(text->file) != 0)
        tool_die(&run->t, "out of memory");
}

int
main(int argc, char **argv)
{
    static struct page run;
    struct tool *t = &run.t;

    tool_start(t, &info, argc, argv, &page_args);
    check_arguments(&run);
    if ((run.nothing = open("/dev/null", O_RDWR | O_CLOEXEC)) < 0)
        tool_die(t, "/dev/null: %s", strerror(errno));
    open_text(&run, &run.commands);
    open_text(&run, &run.said);
    open_text(&run, &run.page);
    page_make_folder(t);
    tool_catch_signals();
    run_parts(&run);
    close_text(&run, &run.commands);
    close_text(&run, &run.said);
    write_page(&run);
    close_text(&run, &run.page);
    page_remove_folder(); /* before the reader of a pipe can end this tool */
    fwrite(run.page.text, 1, run.page.size, t->output.file);
    free(run.commands.text);
    free(run.said.text);
    free(run.page.text);
    free(run.path);
    for (size_t k = 0; k < sizeof run.named / sizeof *run.named; k++)
        free(run.named[k].path);
    return tool_finish(t);
}
