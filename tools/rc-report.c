/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A page about a measured surface: the other tools do the steps, and this one puts their pictures, tables and
 * texts together. */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "formats/core/core.h"
#include "tools/materials/materials.h"
#include "tools/problem/problem.h"
#include "tools/scene/scene.h"

static struct args {
    struct physics physics;
    struct scene_args effects;
    double outliers, spikes, nu;
    struct numbers noise;
    bool mirror;
    const char *title, *relaxation, *travel;
    size_t passes;
} args = {.physics = PHYSICS_NONE,
          .effects = SCENE_NOTHING,
          .outliers = NAN,
          .spikes = NAN,
          .nu = NAN,
          .passes = 1};

#define AT(field) .at = offsetof(struct args, field)
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

enum {
    WORDS = 512, /* more than a command has words or a table columns */
    CELL = 128   /* a name, a number or a unit */
};

struct run {
    struct tool t;
    const char *file, *name; /* as it was given; without its folders */
    char *path;              /* its full name                        */
    bool stream;             /* it is a grid stream                  */
    bool assumed;            /* the bodies are the default ones      */
    size_t loads;
    char load[RC_NUMBER_SIZE + 4]; /* the last one */
    char noise[2 * RC_NUMBER_SIZE];
    char last[RC_NUMBER_SIZE], outliers[RC_NUMBER_SIZE], spikes[RC_NUMBER_SIZE], nu[RC_NUMBER_SIZE],
        memory[RC_NUMBER_SIZE];
    const char *contact[WORDS]; /* options of rc-solve */
    size_t contacts;
    const char *scene[WORDS]; /* options of rc-scene: the last load, the bodies, data of effects */
    size_t scenes;
    const char *given[WORDS]; /* all options that change results */
    size_t givens;
    char times[4 * RC_NUMBER_SIZE]; /* of a creep curve */
    char stress[8192];              /* the report of the stresses below all of the map */
    double yield;                   /* the given yield stress; NAN: none */
    const char *shown;              /* the file of the part that is written */
    struct text {
        char *text;
        size_t size;
        FILE *file;         /* writes it */
    } commands, said, page; /* what was run; the messages */
    int nothing;            /* /dev/null */
    /* files that options name: the commands run in another folder, but are shown with the names as given */
    struct named {
        const char *given;
        char *path;
    } named[2];
};

/* ---- the temporary folder ---- */

static char folder[WHOLE_PATH - 256];

/* Also at the end of a tool that fails. */
static void
remove_folder(void)
{
    DIR *dir = opendir(folder);
    const struct dirent *entry;

    while (dir != NULL && (entry = readdir(dir)) != NULL)
        unlinkat(dirfd(dir), entry->d_name, 0);
    if (dir != NULL)
        closedir(dir);
    rmdir(folder);
}

/* A process of its own waits for the end of this one, which nothing else may notice (kill -9), and then
 * removes the folder. The other tools end with this one, so that no file is added later. */
static void
guard_folder(struct tool *t)
{
    enum {
        FILES = 1024,
        TRIES = 40
    };
    static const struct timespec pause = {.tv_nsec = 50000000};
    int end[2];
    char nothing;

    if (pipe(end) != 0)
        tool_die(t, "no pipe can be made: %s", strerror(errno));
    (void)fcntl(end[1], F_SETFD, FD_CLOEXEC);
    if (fork() != 0) { /* without this process only kill -9 leaves the folder */
        (void)close(end[0]);
        return;
    }
    (void)setsid(); /* a signal to all processes of a terminal does not end it */
    signal(SIGTERM, SIG_IGN);
    for (int fd = 0; fd < FILES; fd++)
        if (fd != end[0])
            (void)close(fd);
    while (read(end[0], &nothing, 1) < 0 && errno == EINTR)
        continue;
    for (int k = 0; k < TRIES && access(folder, F_OK) == 0; k++) {
        remove_folder();
        (void)nanosleep(&pause, NULL);
    }
    _exit(0);
}

static void
make_folder(struct tool *t)
{
    const char *place = getenv("TMPDIR");

    snprintf(folder, sizeof folder, "%s/rc-report-XXXXXX",
             place == NULL || *place == '\0' ? "/tmp" : place);
    if (mkdtemp(folder) == NULL)
        tool_die(t, "a temporary folder %s cannot be made: %s", folder, strerror(errno));
    atexit(remove_folder);
    guard_folder(t);
}

static FILE *
open_part(struct run *run, const char *name)
{
    char path[WHOLE_PATH];
    FILE *in;

    snprintf(path, sizeof path, "%s/%s", folder, name);
    if ((in = fopen(path, "rb")) == NULL)
        tool_die(&run->t, "%s: %s", path, strerror(errno));
    return in;
}

/* ---- HTML ---- */

/* Writes text of files and users: no character of it acts as markup, and none is a control character. */
static void
put_text(FILE *out, const char *text)
{
    bool utf8 = rc_utf8_valid(text);

    for (size_t size; *text != '\0'; text += size) {
        size = rc_control_size(text);
        if (*text != '\n' && (size > 0 || (!utf8 && (unsigned char)*text >= 0x80)))
            putc('?', out);
        else if (strchr("&<>\"'", *text) != NULL)
            fprintf(out, "&#%d;", *text);
        else
            putc(*text, out);
        size = size == 0 ? 1 : size;
    }
}

static void
show_picture(struct run *run, FILE *in, const char *caption, const char *unused)
{
    FILE *out = run->page.file;
    unsigned char bytes[3];
    char four[5];
    const int first = getc(in);

    (void)unused;
    if (first == EOF) /* of an effect that was not computed */
        return;
    (void)ungetc(first, in);
    fprintf(out, "<figure><img alt=\"%s\" src=\"data:image/png;base64,", caption);
    for (size_t n; (n = fread(bytes, 1, sizeof bytes, in)) > 0;)
        fputs(rc_base64(four, bytes, n), out);
    fprintf(out, "\"/><figcaption>%s</figcaption></figure>\n", caption);
}

static bool
begins(const char *line, const char *word)
{
    return word != NULL && strncmp(line, "  ", 2) == 0 &&
           strncmp(line + 2, word, strlen(word)) == 0;
}

/* Shows some lines of a text of rc-info. The first is the line with this first word (NULL: the second line),
 * the last is the one before the line with the other word. */
static void
show_lines(struct run *run, FILE *in, const char *from, const char *to)
{
    RC_OWNED char *line = NULL;
    size_t room = 0;
    bool shown = false;

    fputs("<pre>", run->page.file);
    for (size_t k = 0; getline(&line, &room, in) > 0; k++) {
        shown = (shown || (from == NULL ? k == 1 : begins(line, from))) && !begins(line, to);
        if (shown)
            put_text(run->page.file, line);
    }
    fputs("</pre>\n", run->page.file);
}

/* ---- tables of reports ---- */

/* A value of a report with its unit, in four digits; what is no number, as it is. A length below 1 fm is only
 * rounding. */
static void
put_value(FILE *out, const char *text, const char *unit)
{
    char *end;
    const double value = strtod(text, &end);
    const double whole = value == 0 || strcmp(unit, "m") != 0 || fabs(value) >= 1e-15 ? value : 0;

    if (strcmp(text, "NaN") == 0 || *text == '\0')
        putc('-', out);
    else if (strcmp(text, "true") == 0 || strcmp(text, "false") == 0)
        fputs(*text == 't' ? "yes" : "no", out);
    else if (end == text || *end != '\0')
        put_text(out, text);
    else if (strcmp(unit, "m2") == 0)
        fputs(shown_area(value), out);
    else
        fprintf(out, "%s%s", shown_number(whole, 4, unit), unit);
}

/* A cell of a line, which the next one follows: ends it and returns the rest. */
static char *
end_cell(char *cell)
{
    char *rest = cell + strcspn(cell, "\t\n");

    if (*rest != '\0')
        *rest++ = '\0';
    return rest;
}

/* Writes the cell of a column in the last row of a report to `text`, and its unit to `unit`. False: the
 * report is empty or has no such column. */
static bool
last_cell(struct run *run, const char *file, const char *column, char text[CELL], char unit[CELL])
{
    FILE *in = open_part(run, file);
    RC_OWNED char *line = NULL;
    size_t room = 0, at = SIZE_MAX;
    const size_t name = strlen(column);

    *text = '\0';
    for (size_t row = 0; getline(&line, &room, in) > 0; row++) {
        char *cell = line, *rest;

        for (size_t k = 0; *cell != '\0'; k++, cell = rest) {
            rest = end_cell(cell);
            if (row == 0 && strncmp(cell, column, name) == 0 &&
                (cell[name] == '/' || cell[name] == '\0')) {
                at = k;
                snprintf(unit, CELL, "%s", cell[name] == '/' ? cell + name + 1 : "");
            }
            if (row > 0 && k == at)
                snprintf(text, CELL, "%s", cell);
        }
    }
    fclose(in);
    return at != SIZE_MAX && *text != '\0';
}

static double
last_number(struct run *run, const char *file, const char *column)
{
    char text[CELL], unit[CELL];

    return last_cell(run, file, column, text, unit) ? strtod(text, NULL) : NAN;
}

static void
put_last(struct run *run, const char *file, const char *column)
{
    char text[CELL], unit[CELL];

    if (last_cell(run, file, column, text, unit))
        put_value(run->page.file, text, unit);
    else
        fputs("unknown", run->page.file);
}

static void
put_title(FILE *out, const char *column)
{
    const struct rc_figure *f = report_figure(column);

    if (f != NULL && f->title != NULL)
        put_text(out, f->title);
    else
        for (const char *c = column; *c != '\0'; c++)
            putc(*c == '_' ? ' ' : *c, out);
}

/* Shows these figures of the last row of a report, one below the other. */
static void
show_figures(struct run *run, FILE *in, const char *columns, const char *unused)
{
    FILE *out = run->page.file;
    char word[CELL], text[CELL], unit[CELL];

    (void)unused;
    if (getc(in) == EOF) {
        fputs("<p>This was not computed: see the messages under Accuracy.</p>\n", out);
        return;
    }
    fputs("<table>\n", out);
    for (const char *at = columns; *at != '\0'; at += strspn(at, " ")) {
        const size_t n = strcspn(at, " ");

        snprintf(word, sizeof word, "%.*s", (int)n, at);
        at += n;
        if (!last_cell(run, run->shown, word, text, unit) || strcmp(text, "NaN") == 0)
            continue;
        fputs("<tr><th>", out);
        put_title(out, word);
        fputs("</th><td>", out);
        put_value(out, text, unit);
        fputs("</td></tr>\n", out);
    }
    fputs("</table>\n", out);
}

/* Shows these columns of a report, if its last row has a value. */
static void
show_table(struct run *run, FILE *in, const char *columns, const char *unused)
{
    FILE *out = run->page.file;
    char unit[WORDS][CELL], text[CELL], other[CELL];
    bool wanted[WORDS] = {false};
    char *line = NULL, *rest;
    size_t room = 0;

    (void)unused;
    fputs("<table>\n", out);
    for (size_t row = 0; getline(&line, &room, in) > 0; row++) {
        char *cell = line;

        fputs("<tr>", out);
        for (size_t k = 0; k < WORDS && *cell != '\0'; k++, cell = rest) {
            rest = end_cell(cell);
            if (row == 0) {
                const size_t n = strcspn(cell, "/");
                char name[CELL];

                snprintf(name, sizeof name, " %.*s ", (int)n, cell);
                snprintf(unit[k], CELL, "%s", cell[n] == '/' ? cell + n + 1 : "");
                cell[n] = '\0';
                wanted[k] = strstr(columns, name) != NULL &&
                            last_cell(run, run->shown, cell, text, other) &&
                            strcmp(text, "NaN") != 0;
            }
            if (!wanted[k])
                continue;
            fputs(row == 0 ? "<th>" : "<td>", out);
            if (row > 0)
                put_value(out, cell, unit[k]);
            else
                put_title(out, cell);
            fputs(row == 0 ? "</th>" : "</td>", out);
        }
        fputs("</tr>\n", out);
    }
    fputs("</table>\n", out);
    free(line);
}

/* Shows the figures of the last case that have a bar, or a note why they have none. */
static void
show_bars(struct run *run, FILE *in, const char *a, const char *b)
{
    enum {
        WHAT,
        CASE,
        NAME,
        UNIT,
        VALUE,
        SHARE,
        DOMINANT,
        WHY,
        CELLS
    };
    static const char *const names[CELLS] = {"what",  "case",         "name",     "unit",
                                             "value", "bar_relative", "dominant", "why"};
    FILE *out = run->page.file;
    char *line = NULL;
    size_t room = 0, at[CELLS] = {0};

    (void)a, (void)b;
    fprintf(out,
            "<p>Noise of %s in the heights, and the grid, change the figures of the last load. In "
            "90 %% of "
            "the cases the value of the true surface is within this bar:</p>\n<table>\n"
            "<tr><th>figure</th><th>value</th><th>bar</th><th>mostly by</th><th></th></tr>\n",
            shown_in_unit(args.noise.v[0], "m"));
    for (size_t row = 0; getline(&line, &room, in) > 0; row++) {
        char *cell[WORDS] = {NULL}, *rest = line;
        const char *own[CELLS];

        for (size_t k = 0; k < WORDS && *rest != '\0'; k++) {
            cell[k] = rest;
            rest += strcspn(rest, "\t\n");
            if (*rest != '\0')
                *rest++ = '\0';
            for (size_t i = 0; row == 0 && i < CELLS; i++)
                at[i] = strcmp(cell[k], names[i]) == 0 ? k : at[i];
        }
        for (size_t i = 0; i < CELLS; i++)
            own[i] = cell[at[i]] == NULL || strcmp(cell[at[i]], "NaN") == 0 ? "" : cell[at[i]];
        if (row == 0 || strcmp(own[WHAT], "figure") != 0 || strcmp(own[CASE], run->last) != 0 ||
            strcmp(own[SHARE], "0") == 0 || (*own[SHARE] == '\0' && *own[WHY] == '\0'))
            continue;
        for (char *c = cell[at[NAME]]; (c = strchr(c, '_')) != NULL;)
            *c = ' ';
        fputs("<tr><td>", out);
        put_text(out, own[NAME]);
        fprintf(out, "</td><td>%.4g ", strtod(own[VALUE], NULL));
        put_text(out, own[UNIT]);
        if (*own[SHARE] == '\0')
            fputs("</td><td>-</td><td>", out);
        else
            fprintf(out, "</td><td>%.2g %%</td><td>", 100 * strtod(own[SHARE], NULL));
        put_text(out, own[DOMINANT]);
        fputs("</td><td>", out);
        put_text(out, own[WHY]);
        fputs("</td></tr>\n", out);
    }
    fputs("</table>\n", out);
    free(line);
}

static void
show_bodies(struct run *run, FILE *in, const char *a, const char *b)
{
    const struct physics *p = &args.physics;
    FILE *out = run->page.file;

    (void)in, (void)a, (void)b;
    fprintf(out, "<p>The surface is pressed against a flat body. E* is %s",
            shown_in_unit(p->surface_estar, "Pa"));
    if (p->pair.one.layers > 0)
        fprintf(out, " at the surface of %zu layer%s", p->pair.one.layers,
                p->pair.one.layers == 1 ? "" : "s");
    if (!isnan(p->radius))
        fprintf(out, ", a sphere of radius %s is added", shown_in_unit(p->radius, "m"));
    if (!isnan(p->cylinder))
        fprintf(out, ", a cylinder of radius %s is added", shown_in_unit(p->cylinder, "m"));
    if (isfinite(p->hardness))
        fprintf(out, ", the hardness is %s", shown_in_unit(p->hardness, "Pa"));
    else
        fputs(", the bodies are elastic", out);
    fprintf(out, ", and the map %s.%s</p>\n",
            rc_repeats(p->boundary) == 2 ? "repeats without end"
            : p->boundary.x              ? "repeats along x"
            : p->boundary.y              ? "repeats along y"
                                         : "ends at its edges",
            run->assumed ? " No elasticity was given: these are values of steel on steel." : "");
}

/* The first paragraph of a contact in words: area, pressure, what yields, the error. */
static void
put_contact(struct run *run)
{
    static const char loads[] = "loads.tsv";
    const struct physics *p = &args.physics;
    FILE *out = run->page.file;
    const double bound = last_number(run, loads, "plastic_area"),
                 area = last_number(run, loads, "contact_area");
    const double stress = json_real(json_member(run->stress, "largest.mises.value")),
                 depth = json_real(json_member(run->stress, "largest.mises.depth"));
    const double fraction = last_number(run, loads, "contact_fraction");

    fputs("Under a load of ", out);
    put_last(run, loads, "load");
    fputs(", a mean pressure of ", out);
    put_last(run, loads, "mean_pressure");
    fprintf(out, ", the bodies touch on %.3g %% of the map, ", 100 * fraction);
    put_last(run, loads, "contact_area");
    fputs(". The largest pressure is ", out);
    put_last(run, loads, "max_pressure");
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
            100 * last_number(run, loads, "pressure_error_estimate"));
    if (!isnan(last_number(run, loads, "contact_area_error_estimate")))
        fprintf(out, ", that of the area %.2g %%",
                100 * last_number(run, loads, "contact_area_error_estimate"));
    fputs(".\n", out);
}

static bool has_readers(const struct run *run);

/* True if any row of a table has this text in a column. */
static bool
has_cell(struct run *run, const char *file, const char *column, const char *text)
{
    FILE *in = open_part(run, file);
    RC_OWNED char *line = NULL;
    size_t room = 0, at = SIZE_MAX;
    bool found = false;

    for (size_t row = 0; !found && getline(&line, &room, in) > 0; row++) {
        char *cell = line, *rest;

        for (size_t k = 0; *cell != '\0'; k++, cell = rest) {
            rest = end_cell(cell);
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
put_limits(struct run *run, const char *inaccurate)
{
    static const char loads[] = "loads.tsv";
    const double nodes = last_number(run, loads, "contact_nodes"),
                 patch = last_number(run, loads, "nodes_per_patch"),
                 edge = last_number(run, loads, "edge_load_fraction"),
                 slope = last_number(run, loads, "rms_slope");
    char text[CELL], unit[CELL];
    const struct {
        bool holds;
        const char *format;
        double value;
    } limit[] = {
        {last_cell(run, loads, "converged", text, unit) && strcmp(text, "false") == 0,
         "the solver stopped before its tolerance", 0},
        {nodes < 100, "only %.0f nodes touch, so that the grid decides", nodes},
        {nodes >= 100 && patch < 4, "a contact patch has only %.2g nodes, so that the grid decides",
         patch},
        {rc_repeats(args.physics.boundary) == 0 && edge > 0.01,
         "the edge of the map carries %.2g %% of the load, so that a larger map has another result",
         100 * edge},
        {slope > 0.3,
         "the RMS slope where the bodies touch is %.2g, beyond the theory of small slopes", slope},
        {last_number(run, loads, "max_pressure") > args.physics.surface_estar / 10,
         "the largest pressure is beyond a tenth of E*, where strains are not small", 0},
        {args.relaxation != NULL && has_readers(run),
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
        fputs(args.noise.n > 0
                  ? "The checks of the grid, the edges and the slopes found nothing that limits "
                    "these figures; the bars under Accuracy are those of the measurement"
                  : "The checks of the grid, the edges and the slopes found nothing that limits "
                    "these figures; --noise adds bars for the measurement",
              out);
    fputs(".\n", out);
}

static void show_verdict(struct run *run, FILE *in, const char *a, const char *b);

/* The limits of all tools, as README has them. */
static void
show_limits(struct run *run, FILE *in, const char *a, const char *b)
{
    (void)in, (void)a, (void)b;
    fputs("<ul>\n"
          "<li>Bodies are half-spaces with small slopes and small strains: thin bodies do not "
          "bend, and bodies "
          "have no side edges.</li>\n"
          "<li>No fluid film carries load. Temperatures do not change the contact, and metals do "
          "not creep. "
          "Wear depends on the sliding distance alone.</li>\n"
          "<li>You choose the filters, the form and the threshold of spikes. A scan too coarse for "
          "its contact "
          "gets a warning; nothing is corrected behind your back.</li>\n</ul>\n",
          run->page.file);
}

static void
show_messages(struct run *run, FILE *in, const char *a, const char *b)
{
    FILE *out = run->page.file;

    (void)in, (void)a, (void)b;
    if (run->said.size == 0) {
        fputs("<p>The tools gave no warnings.</p>\n", out);
        return;
    }
    fputs("<p>Warnings of the tools:</p>\n<pre>", out);
    put_text(out, run->said.text);
    fputs("</pre>\n", out);
}

static void
show_commands(struct run *run, FILE *in, const char *a, const char *b)
{
    FILE *out = run->page.file;

    (void)in, (void)a, (void)b;
    fprintf(out,
            "<p>These commands of libcontact %s make the files of this page again.</p>\n"
            "<pre id=\"commands\">",
            rc_version());
    put_text(out, run->commands.text);
    fputs("</pre>\n", out);
}

/* Writes a command of another tool, with its files as they were given. */
static void
put_command(const struct run *run, const char *line)
{
    FILE *out = run->page.file;

    for (size_t k = 0; k < sizeof run->named / sizeof *run->named; k++) {
        const char *path = run->named[k].path, *at = path == NULL ? NULL : strstr(line, path);
        if (at == NULL)
            continue;
        RC_OWNED char *before = strndup(line, (size_t)(at - line));
        put_text(out, before == NULL ? "" : before);
        put_text(out, run->named[k].given);
        line = at + strlen(path);
    }
    put_text(out, line);
}

/* Shows the verdicts of rc-scene: the lines of effects, indented by two blanks, with their commands, indented
 * further, and what is missing. Expected times depend on the machine and are left out. */
static void
show_effects(struct run *run, FILE *in, const char *a, const char *b)
{
    enum {
        TITLE = 33 /* the verdict begins here */
    };
    FILE *out = run->page.file;
    RC_OWNED char *line = NULL;
    RC_OWNED char *missing = NULL;
    size_t room = 0, lines = 0;
    char *end;

    (void)a, (void)b;
    fprintf(out, "<p>By how much each effect would change the elastic contact under %s.</p>\n",
            run->loads > 1 ? "the last load" : "this load");
    fputs("<table id=\"effects\">\n", out);
    for (ssize_t n; (n = getline(&line, &room, in)) > 0; lines++) {
        line[n - 1] = '\0';
        if ((end = strstr(line, "   (about ")) != NULL)
            *end = '\0';
        if (strncmp(line, "  data missing: ", 16) == 0) {
            missing = strdup(line + 16);
        } else if (strncmp(line, "      ", 6) == 0) {
            fputs("<tr><td></td><td><pre>", out);
            put_command(run, line + 6);
            fputs("</pre></td></tr>\n", out);
        } else if (lines > 0 && n > TITLE) {
            line[TITLE - 1] = '\0';
            for (char *c = line + TITLE - 2; c > line && *c == ' '; c--)
                *c = '\0';
            fputs("<tr><th>", out);
            put_text(out, line + 2);
            fputs("</th><td>", out);
            put_text(out, line + TITLE);
            fputs("</td></tr>\n", out);
        }
    }
    fputs("</table>\n", out);
    if (lines == 0)
        fputs("<p>rc-scene has no verdicts on this contact: see its message.</p>\n", out);
    if (missing != NULL) {
        fputs("<p>Data are missing for: ", out);
        put_text(out, missing);
        fputs(".</p>\n", out);
    }
}

/* rc-scene compares with a uniform body 1. */
static bool
has_effects(const struct run *run)
{
    (void)run;
    return !isinf(args.physics.e1);
}

static bool
is_measured(const struct run *run)
{
    return !run->stream;
}

static bool
has_noise(const struct run *run)
{
    (void)run;
    return args.noise.n > 0;
}

static bool
was_given(const struct run *run, const char *name, size_t n)
{
    for (size_t k = 0; k < run->givens; k++)
        if (strncmp(run->given[k], "--", 2) == 0 && strlen(run->given[k]) == n + 2 &&
            strncmp(run->given[k] + 2, name, n) == 0)
            return true;
    return false;
}

static bool
has_several_loads(const struct run *run)
{
    return run->loads > 1;
}

/* ---- the page: what its parts run and show ---- */

/* A command gets "-o FILE" at its end. The words in capitals stand for others, see `expand`. */
static const struct part {
    const char *heading, *command, *file;
    void (*show)(struct run *run, FILE *in, const char *a, const char *b);
    const char *a, *b;
    bool (*wanted)(const struct run *run); /* NULL: always */
    bool may_fail;                         /* its file is then empty */
    /* of an effect: options that must be given; an empty file of its section shows nothing */
    const char *needs;
    /* a sentence of the first paragraph about a figure of the file; `denies`: if it is false */
    const char *says, *denies, *figure;
} parts[] = {
    {.command = "rc-import ORIGINAL", .file = "measured.rcg", .wanted = is_measured},
    {.command = "rc-detrend PREPARED", .file = "surface.rcg"},
    {.show = show_verdict},
    {.heading = "The surface",
     .command = "rc-render --quiet --hillshade --width 800 surface.rcg",
     .file = "heights.png",
     .show = show_picture,
     .a = "Heights; the section Origin says how they were prepared"},
    {.command = "rc-info --areal --psd surface.rcg",
     .file = "parameters.txt",
     .show = show_lines,
     .b = "psd"},
    {.heading = "Heights and wavelengths",
     .command = "rc-render --quiet --material-ratio --width 800 surface.rcg",
     .file = "ratio.png",
     .show = show_picture,
     .a = "Material ratio: the share of the surface at or above each height"},
    {.command = "rc-info --json --psd surface.rcg", .file = "spectrum.json"},
    {.command =
         "rc-render --quiet --curve psd.q:psd.c --log xy --subtitle= --width 800 spectrum.json",
     .file = "spectrum.png",
     .show = show_picture,
     .a = "Power spectrum, the mean over all directions"},
    {.file = "parameters.txt", .show = show_lines, .a = "psd", .b = "keys"},
    {.heading = "Profiles along x",
     .command = "rc-info --profile rows surface.rcg",
     .file = "profiles.txt",
     .show = show_lines,
     .a = "profile",
     .b = "keys"},
    {.heading = "Under load", .show = show_bodies},
    {.command = "rc-solve CONTACT --output OUTPUT --report loads.tsv surface.rcg",
     .file = "contact.rcg"},
    {.command = "rc-pick --case LAST contact.rcg", .file = "last.rcg"},
    {.command = "rc-render --quiet --width 800 last.rcg",
     .file = "pressure.png",
     .show = show_picture,
     .a = "Contact pressure under the last load"},
    {.command = "rc-info --patches last.rcg",
     .file = "contact.txt",
     .show = show_lines,
     .b = "keys"},
    {.command = "rc-render --quiet --curve mean_pressure:contact_fraction --log xy --y-unit % "
                "--subtitle= --width 800 loads.tsv",
     .file = "curve.png",
     .show = show_picture,
     .a = "Real contact area, as a share of the map, against the mean pressure",
     .wanted = has_several_loads},
    {.command = "rc-stress NU --section y=0 --depths auto --components mises "
                "last.rcg",
     .file = "section.rcg"},
    {.command = "rc-render --quiet --log --width 800 section.rcg",
     .file = "section.png",
     .show = show_picture,
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
     .show = show_table,
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
     .show = show_picture,
     .a = "Largest pressure at each position"},
    {.heading = "Creep",
     .needs = "relaxation time",
     .command =
         "rc-solve SOFT @relaxation --time TIMES --output pressure --report creep.tsv surface.rcg",
     .file = "creep.rcg"},
    {.needs = "relaxation time",
     .file = "creep.tsv",
     .show = show_table,
     .a = " time contact_fraction max_pressure indentation mean_gap pressure_error_estimate "
          "converged ",
     .says = "By creep the share of the map in contact becomes %s in the given time.",
     .figure = "contact_fraction"},
    {.needs = "relaxation time",
     .command = "rc-render --quiet --curve time:contact_fraction --log x --y-unit % --subtitle= "
                "--width 800 creep.tsv",
     .file = "creep.png",
     .show = show_picture,
     .a = "Real contact area, as a share of the map, against time"},
    {.heading = "Friction",
     .needs = "mu tangential",
     .command =
         "rc-slip @mu @tangential COUPLING --output pressure,state --report slip.tsv last.rcg",
     .file = "slip.rcg"},
    {.needs = "mu tangential",
     .file = "slip.tsv",
     .show = show_figures,
     .a = "tangential_x limit displacement_x stick_fraction largest_slip tangential_stiffness "
          "dissipated_energy "
          "traction_error_estimate converged",
     .says = "The tangential force leaves a share of %s of the contact sticking.",
     .figure = "stick_fraction"},
    {.needs = "mu tangential",
     .command = "rc-render --quiet --channel state --width 800 slip.rcg",
     .file = "slip.png",
     .show = show_picture,
     .a = "Where the contact sticks, and where it slips"},
    {.heading = "Wear",
     .needs = "coefficient distance",
     .command = "rc-wear @coefficient @distance --report wear.tsv --steps steps.tsv last.rcg",
     .file = "wear.rcg"},
    {.needs = "coefficient distance",
     .file = "wear.tsv",
     .show = show_figures,
     .a = "distance wear_volume wear_volume_1 wear_volume_2 max_wear_depth mean_wear_depth "
          "contact_fraction "
          "max_pressure approach wear_error_estimate converged",
     .says = "At the end of the sliding distance the largest worn depth is %s.",
     .figure = "max_wear_depth"},
    {.needs = "coefficient distance",
     .command = "rc-render --quiet --curve distance:max_pressure --log xy --subtitle= --width 800 "
                "steps.tsv",
     .file = "wear.png",
     .show = show_picture,
     .a = "Largest pressure against the sliding distance"},
    {.heading = "Heat",
     .needs = "mu speed conductivity diffusivity",
     .command =
         "rc-heat @mu @speed @conductivity @diffusivity @moving @time --report heat.tsv last.rcg",
     .file = "heat.rcg"},
    {.needs = "mu speed conductivity diffusivity",
     .file = "heat.tsv",
     .show = show_figures,
     .a = "speed heat_power share_1 max_temperature max_x max_y mean_temperature "
          "temperature_error_estimate "
          "steady_time converged",
     .says = "Friction heats the contact by up to %s.",
     .figure = "max_temperature"},
    {.needs = "mu speed conductivity diffusivity",
     .command = "rc-render --quiet --channel temperature-1 --width 800 heat.rcg",
     .file = "heat.png",
     .show = show_picture,
     .a = "Temperature of the surface of body 1, above that of the bodies"},
    {.heading = "Leak",
     .needs = "pressure-drop",
     .command = "rc-leak FLUID --report leak.tsv last.rcg",
     .file = "leak.rcg"},
    {.needs = "pressure-drop",
     .file = "leak.tsv",
     .show = show_figures,
     .a = "percolates flow_rate flow_conductance flow_factor mean_gap critical_gap critical_x "
          "critical_y "
          "throat_nodes discretization_error_estimate",
     .says = "A fluid gets through the gap.",
     .denies = "No fluid gets through the gap.",
     .figure = "percolates"},
    {.needs = "pressure-drop",
     .command = "rc-render --quiet --channel channel --width 800 leak.rcg",
     .file = "leak.png",
     .show = show_picture,
     .a = "Where the fluid flows, and where it stands"},
    {.heading = "Fatigue",
     .needs = "bending-limit torsion-limit",
     .command = "rc-fatigue NU @bending-limit @torsion-limit --pass x --depths auto --report "
                "fatigue.tsv last.rcg",
     .file = "fatigue.rcg"},
    {.needs = "bending-limit torsion-limit",
     .file = "fatigue.tsv",
     .show = show_figures,
     .a = "safety crossland crossland_depth dangvan dangvan_depth amplitude amplitude_depth "
          "sampling_error_estimate converged",
     .says = "When the contact passes along x, the safety factor against fatigue is %s.",
     .figure = "safety"},
    {.heading = "Shakedown",
     .needs = "yield",
     .command = "rc-fatigue NU --criteria shakedown @yield --pass x --depths auto --report "
                "shakedown.tsv last.rcg",
     .file = "shakedown.rcg"},
    {.needs = "yield",
     .file = "shakedown.tsv",
     .show = show_figures,
     .a = "shakedown shakedown_x shakedown_y shakedown_depth shakedown_error_estimate",
     .says = "The index of elastic shakedown is %s; above 1 the body yields again at each pass.",
     .figure = "shakedown"},
    {.heading = "Effects",
     .command = "rc-scene SCENE surface.rcg",
     .file = "effects.txt",
     .show = show_effects,
     .wanted = has_effects,
     .may_fail = true},
    {.heading = "Accuracy",
     .file = "loads.tsv",
     .show = show_table,
     .a = " mean_pressure load contact_fraction max_pressure converged pressure_error_estimate "
          "edge_load_fraction nodes_per_patch "},
    {.command =
         "rc-cost --quiet --noise NOISE --resolution --report bars.tsv -o bars.txt surface.rcg "
         "-- rc-solve CONTACT",
     .file = "bars.tsv",
     .show = show_bars,
     .wanted = has_noise},
    {.show = show_messages},
    {.heading = "Limits", .show = show_limits},
    {.heading = "Origin", .file = "parameters.txt", .show = show_lines, .a = "keys"},
    {.heading = "Commands", .show = show_commands},
};

static bool
is_wanted(const struct run *run, const struct part *part)
{
    if (part->wanted != NULL && !part->wanted(run))
        return false;
    for (const char *at = part->needs; at != NULL && *at != '\0'; at += strspn(at, " ")) {
        const size_t n = strcspn(at, " ");

        if (!was_given(run, at, n))
            return false;
        at += n;
    }
    return true;
}

/* True if the page has a section of an effect that reads the gap and the heights of the contact. */
static bool
has_readers(const struct run *run)
{
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++)
        if (parts[k].needs != NULL && parts[k].command != NULL && is_wanted(run, &parts[k]) &&
            strstr(parts[k].command, "last.rcg") != NULL)
            return true;
    return false;
}

/* The sections of effects with a row that is not converged, as "Travel, Wear". */
static const char *
name_inaccurate(struct run *run, char text[CELL])
{
    const char *heading = "";
    size_t n = 0;

    text[0] = '\0';
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        const struct part *part = &parts[k];

        if (part->heading != NULL)
            heading = part->heading;
        if (part->needs != NULL && part->command == NULL && is_wanted(run, part) &&
            has_cell(run, part->file, "converged", "false") && n < CELL)
            n += (size_t)snprintf(text + n, CELL - n, "%s%s", n > 0 ? ", " : "", heading);
    }
    return text;
}

static void
show_verdict(struct run *run, FILE *in, const char *a, const char *b)
{
    FILE *out = run->page.file;
    char text[CELL], unit[CELL], inaccurate[CELL];

    (void)in, (void)a, (void)b;
    fputs("<p id=\"verdict\">", out);
    put_contact(run);
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        const char *says = parts[k].says, *at;

        if (says == NULL || !is_wanted(run, &parts[k]) ||
            !last_cell(run, parts[k].file, parts[k].figure, text, unit) || strcmp(text, "NaN") == 0)
            continue;
        if (strcmp(text, "false") == 0 || strcmp(text, "no") == 0)
            says = parts[k].denies != NULL ? parts[k].denies : says;
        at = strstr(says, "%s");
        fprintf(out, "%.*s", at == NULL ? (int)strlen(says) : (int)(at - says), says);
        if (at != NULL)
            put_value(out, text, unit);
        fprintf(out, "%s\n", at == NULL ? "" : at + 2);
    }
    put_limits(run, name_inaccurate(run, inaccurate));
    fputs("</p>\n", out);
}

/* ---- commands ---- */

static bool
is_load(const char *word)
{
    return strcmp(word, "--load") == 0 || strcmp(word, "--mean-pressure") == 0 ||
           strcmp(word, "--approach") == 0;
}

struct command {
    const char *word[WORDS + 1];
    size_t n;
};

static void
add(struct command *c, const char *option, const char *value)
{
    c->word[c->n++] = option;
    if (value != NULL)
        c->word[c->n++] = value;
}

static void
add_preparation(const struct run *run, struct command *c)
{
    if (!run->stream)
        add(c, "--poly", "2");
    if (*run->spikes != '\0')
        add(c, "--spikes", run->spikes);
    if (*run->outliers != '\0')
        add(c, "--outliers", run->outliers);
    add(c, "--fill", NULL);
    if (args.mirror && rc_repeats(args.physics.boundary) == 1)
        add(c, "--mirror", args.physics.boundary.x ? "x" : "y");
    else if (args.mirror)
        add(c, "--mirror", NULL);
    add(c, run->stream ? run->path : "measured.rcg", NULL);
}

/* Adds an option with its values, if it was given. */
static void
add_given(const struct run *run, struct command *c, const char *name)
{
    for (size_t k = 0; k < run->givens; k++)
        if (strncmp(run->given[k], "--", 2) == 0 && strcmp(run->given[k] + 2, name) == 0) {
            add(c, run->given[k++], NULL);
            while (k < run->givens && strncmp(run->given[k], "--", 2) != 0)
                add(c, run->given[k++], NULL);
            return;
        }
}

/* Adds the contact under the last load without a hardness, `soft`: and without the modulus of body 1. */
static void
add_last_contact(const struct run *run, struct command *c, bool soft)
{
    bool in = true;

    for (size_t k = 0; k < run->contacts; k++) {
        const char *word = run->contact[k];

        if (strncmp(word, "--", 2) == 0)
            in = strcmp(word, "--hardness") != 0 && !(soft && strcmp(word, "--E1") == 0);
        if (in)
            add(c, k > 0 && is_load(run->contact[k - 1]) ? run->load : word, NULL);
    }
}

/* Adds a word of a command. @NAME is this option, if it was given. ORIGINAL, PREPARED and the like are
 * replaced by files and options. */
static void
expand(const struct run *run, struct command *c, const char *word)
{
    if (strcmp(word, "ORIGINAL") == 0)
        add(c, run->path, NULL);
    else if (strcmp(word, "PREPARED") == 0)
        add_preparation(run, c);
    else if (strcmp(word, "LAST") == 0)
        add(c, run->last, NULL);
    else if (strcmp(word, "NOISE") == 0)
        add(c, run->noise, NULL);
    else if (strcmp(word, "OUTPUT") == 0)
        add(c, has_readers(run) ? "pressure,gap,height" : "pressure", NULL);
    else if (strcmp(word, "COUPLING") == 0 && !isfinite(args.physics.hardness))
        return; /* rc-slip solves further loads of elastic bodies only */
    else if (strcmp(word, "COUPLING") == 0)
        add(c, "--coupling", "none");
    else if (strcmp(word, "FLUID") == 0 && !was_given(run, "viscosity", strlen("viscosity")))
        return; /* the flow rate depends on both */
    else if (strcmp(word, "FLUID") == 0) {
        add_given(run, c, "pressure-drop");
        add_given(run, c, "viscosity");
    } else if (strcmp(word, "TIMES") == 0)
        add(c, run->times, NULL);
    else if (strcmp(word, "BARE") == 0 || strcmp(word, "SOFT") == 0)
        add_last_contact(run, c, *word == 'S');
    else if (*word == '@')
        add_given(run, c, word + 1);
    else if (strcmp(word, "CONTACT") == 0)
        for (size_t k = 0; k < run->contacts; k++)
            add(c, run->contact[k], NULL);
    else if (strcmp(word, "SCENE") == 0)
        for (size_t k = 0; k < run->scenes; k++)
            add(c, run->scene[k], NULL);
    else if (strcmp(word, "NU") != 0)
        add(c, word, NULL);
    else if (*run->nu != '\0')
        add(c, "--nu", run->nu);
}

/* Writes the command for a shell, with the file as it was given. */
static void
write_command(const struct run *run, const struct command *c)
{
    FILE *out = run->commands.file;

    for (size_t k = 0; k < c->n; k++) {
        const char *word = c->word[k] == run->path ? run->file : c->word[k];

        for (size_t i = 0; i < sizeof run->named / sizeof *run->named; i++)
            if (word == run->named[i].path)
                word = run->named[i].given;
        if (k > 0)
            putc(' ', out);
        if (word == run->file && *word == '-')
            fputs("./", out);
        shown_shell_word(out, word);
    }
    putc('\n', out);
}

/* Repeats the messages of a command, and ends as it did if it failed. */
static void
take_messages(struct run *run, const char *name, enum process_end end, struct process *p,
              bool may_fail)
{
    struct tool *t = &run->t;

    if (end == PROCESS_INTERRUPTED)
        remove_folder(); /* the signal ends this tool, which then does nothing else */
    if (end == PROCESS_INTERRUPTED || end == PROCESS_DIED)
        tool_die(t, "%s was ended by a signal", name);
    if (p->said != NULL && (end == PROCESS_FAILED || !t->quiet))
        fputs(p->said, stderr);
    if (end == PROCESS_FAILED && !may_fail) {
        if (strcmp(name, "rc-import") == 0)
            fprintf(stderr,
                    "%s: if this file needs options of rc-import, write its grid stream to a "
                    "file, and make the page of that\n",
                    info.name);
        whole_files_remove();
        exit(p->status == EXIT_USAGE ? EXIT_USAGE : EXIT_IMPOSSIBLE);
    }
    if (p->said != NULL)
        fputs(p->said, run->said.file);
    if (p->status == EXIT_SHORT)
        tool_fails_with(t, EXIT_SHORT);
    free(p->said);
}

static void
leave_empty(struct run *run, const char *name)
{
    char path[WHOLE_PATH];
    FILE *empty;

    snprintf(path, sizeof path, "%s/%s", folder, name);
    empty = fopen(path, "wb");
    if (empty == NULL || fclose(empty) != 0)
        tool_die(&run->t, "%s: %s", path, strerror(errno));
}

/* Runs the command of a part. False: it failed, which it may. */
static bool
run_part(struct run *run, const struct part *part)
{
    struct process p = {
        .in = run->nothing, .out = run->nothing, .folder = folder, .allowed = INFINITY};
    struct command c = {.n = 0};
    char *words = strdup(part->command), *rest = words;
    enum process_end end;

    if (words == NULL)
        tool_die(&run->t, "out of memory");
    for (const char *word; (word = strtok_r(rest, " ", &rest)) != NULL;)
        expand(run, &c, word);
    if (strstr(part->command, " -o ") == NULL)
        add(&c, "-o", part->file);
    write_command(run, &c);
    if (*run->memory != '\0') { /* behind the name of the tool: a command may follow its options */
        memmove(c.word + 3, c.word + 1, (c.n - 1) * sizeof *c.word);
        c.word[1] = "--memory";
        c.word[2] = run->memory;
        c.n += 2;
    }
    p.doing = c.word[0];
    end = process_run(&run->t, c.word, &p);
    take_messages(run, c.word[0], end, &p, part->may_fail || part->needs != NULL);
    if (end == PROCESS_FAILED)
        leave_empty(run, part->file);
    free(words);
    return end != PROCESS_FAILED;
}

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
find_file(struct run *run, const char *option, const char *word)
{
    const size_t k = strcmp(option, "--relaxation") == 0 ? 0 : 1;

    if (k == 1 && strcmp(option, "--materials") != 0)
        return word;
    free(run->named[k].path);
    run->named[k] = (struct named){word, realpath(word, NULL)};
    return run->named[k].path == NULL ? word : run->named[k].path;
}

/* Gives rc-solve the options of the contact, and rc-scene those with the last load and the data of
 * effects. */
static void
divide_words(struct run *run)
{
    const char *all[WORDS / 2];
    const struct numbers *steps = physics_steps(&args.physics);
    const size_t n = tool_result_words(&run->t, all, WORDS / 2);
    bool of_scene = false, of_load = false, of_page = false, softens = false, modulus = false;

    snprintf(run->load, sizeof run->load, "%s%s", rc_number(steps->v[steps->n - 1]),
             steps->per_metre ? "N/m" : "");
    for (size_t k = 0; k < run->contacts; k++)
        run->scene[run->scenes++] = run->contact[k];
    for (size_t k = 0; k < n; k++) {
        const bool name = strncmp(all[k], "--", 2) == 0, value = of_load && !name;
        if (name) {
            of_page = strcmp(all[k], "--travel") == 0 || strcmp(all[k], "--passes") == 0;
            softens = strcmp(all[k], "--relaxation") == 0;
            modulus = args.relaxation != NULL && strcmp(all[k], "--E1") == 0;
            of_scene = of_page || softens || is_option(scene_options, all[k]);
            of_load = is_load(all[k]);
        }
        if (k > 0 && !name)
            all[k] = find_file(run, all[k - 1], all[k]);
        run->given[run->givens++] = all[k];
        if (!of_scene)
            run->contact[run->contacts++] = all[k];
        if (!of_page && !modulus)
            run->scene[run->scenes++] = value ? run->load : all[k];
    }
}

/* The data of the sections: the modulus of a viscoelastic body 1 at once, times, the yield stress. */
static void
check_effects(struct run *run)
{
    struct tool *t = &run->t;
    const double time = args.effects.time;
    struct numbers yield;

    run->yield = NAN;
    if (args.effects.yield != NULL &&
        unit_numbers(args.effects.yield, UNIT_PA, &yield, NULL) == RC_OK) {
        run->yield = yield.v[0];
        free(yield.v);
    }
    if (args.relaxation != NULL) {
        struct relaxation_law law;
        char modulus[RC_NUMBER_SIZE];

        if (relaxation_law_read(&law, args.relaxation, NULL, &t->err) != RC_OK)
            tool_usage(t, "--relaxation %s: %s", args.relaxation, t->err.text);
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
check_contact(struct run *run)
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
    if (args.mirror && args.physics.repeats.periodic == NULL) {
        args.physics.repeats.periodic = "";
        run->contact[run->contacts++] = "--periodic";
    }
    check_effects(run);
    t->quiet = true; /* rc-solve gives these warnings */
    physics_check(t, &args.physics);
    t->quiet = quiet;
    run->loads = physics_steps(&args.physics)->n;
    divide_words(run);
    rc_number_text(run->last, (double)run->loads);
    if (!tool_given(t, "nu1") && args.physics.layer.n == 0) /* layers have their own */
        rc_number_text(run->nu, isnan(args.nu) ? 0.28 : args.nu);
}

static void
check_file(struct run *run)
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
check_arguments(struct run *run)
{
    check_file(run);
    check_contact(run);
    if (!isnan(args.outliers))
        rc_number_text(run->outliers, args.outliers);
    if (!isnan(args.spikes))
        rc_number_text(run->spikes, args.spikes);
    if (args.noise.n > 2)
        tool_usage(&run->t, "--noise takes a standard deviation and a length, not %zu numbers",
                   args.noise.n);
    for (size_t k = 0; k < args.noise.n; k++)
        snprintf(run->noise + strlen(run->noise), RC_NUMBER_SIZE, "%s%s", k > 0 ? "," : "",
                 rc_number(args.noise.v[k]));
    if (run->t.memory > 0)
        rc_number_text(run->memory, (double)run->t.memory);
    setenv("RC_THREADS", rc_number((double)run->t.threads), 1);
}

/* ---- the run ---- */

static void
demand_one_map(struct run *run)
{
    FILE *in = open_part(run, "surface.rcg");
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
read_text(struct run *run, const char *name, char *text, size_t size)
{
    FILE *in = open_part(run, name);

    text[fread(text, 1, size - 1, in)] = '\0';
    fclose(in);
}

static void
run_parts(struct run *run)
{
    bool fails = false; /* a command of this section */

    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        const struct part *part = &parts[k];

        if (part->heading != NULL)
            fails = false;
        if (!is_wanted(run, part))
            continue;
        if (fails)
            leave_empty(run, part->file);
        else if (part->command != NULL)
            fails = !run_part(run, part);
        if (part->command != NULL && strcmp(part->file, "surface.rcg") == 0)
            demand_one_map(run);
    }
    read_text(run, "stress.json", run->stress, sizeof run->stress);
}

static void
write_page(struct run *run)
{
    const char *title = args.title == NULL ? run->name : args.title;
    FILE *out = run->page.file, *in;

    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
          "<meta http-equiv=\"Content-Security-Policy\" "
          "content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'\"/>\n<title>",
          out);
    put_text(out, title);
    fputs("</title>\n<style>body{font:16px/1.5 sans-serif;max-width:52em;margin:2em auto;padding:0 "
          "1em;"
          "color:#222}img{max-width:100%}figure{margin:1em 0}figcaption{color:#595959}"
          "pre{background:#f4f4f4;padding:.8em;white-space:pre-wrap;overflow-wrap:anywhere}"
          "table{font-size:85%}td,th{padding:.2em .6em;text-align:right}"
          "#effects td,#effects th{text-align:left;vertical-align:top}#effects pre{margin:0}"
          "</style>\n</head>\n<body>\n<h1>",
          out);
    put_text(out, title);
    fputs("</h1>\n", out);
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        const struct part *part = &parts[k];

        if (!is_wanted(run, part))
            continue;
        if (part->heading != NULL)
            fprintf(out, "<h2>%s</h2>\n", part->heading);
        if (part->show == NULL)
            continue;
        run->shown = part->file;
        in = part->file == NULL ? NULL : open_part(run, part->file);
        part->show(run, in, part->a, part->b);
        if (in != NULL)
            fclose(in);
    }
    fputs("</body>\n</html>\n", out);
}

static void
open_text(struct run *run, struct text *text)
{
    if ((text->file = open_memstream(&text->text, &text->size)) == NULL)
        tool_die(&run->t, "out of memory");
}

static void
close_text(struct run *run, struct text *text)
{
    if (ferror(text->file) || fclose(text->file) != 0)
        tool_die(&run->t, "out of memory");
}

int
main(int argc, char **argv)
{
    static struct run run;
    struct tool *t = &run.t;

    tool_start(t, &info, argc, argv, &args);
    check_arguments(&run);
    if ((run.nothing = open("/dev/null", O_RDWR | O_CLOEXEC)) < 0)
        tool_die(t, "/dev/null: %s", strerror(errno));
    open_text(&run, &run.commands);
    open_text(&run, &run.said);
    open_text(&run, &run.page);
    make_folder(t);
    tool_catch_signals();
    run_parts(&run);
    close_text(&run, &run.commands);
    close_text(&run, &run.said);
    write_page(&run);
    close_text(&run, &run.page);
    remove_folder(); /* before the reader of a pipe can end this tool */
    fwrite(run.page.text, 1, run.page.size, t->output.file);
    free(run.commands.text);
    free(run.said.text);
    free(run.page.text);
    free(run.path);
    for (size_t k = 0; k < sizeof run.named / sizeof *run.named; k++)
        free(run.named[k].path);
    return tool_finish(t);
}
