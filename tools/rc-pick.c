/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rc-pick: selects frames of a stream, cuts and resamples their maps, and changes their headers. */

#include <math.h>
#include <string.h>

#include "formats/core/core.h"
#include "tools/pick/pick.h"

static struct args {
    struct wanted wanted;
    struct steps steps;
    char *made[TOOL_STEPS]; /* the texts of --set, kept until the end */
} args;

#define STEP(word, argument, what)                                                                 \
    {                                                                                              \
        .name = word, .type = OPT_TEXTS, .at = offsetof(struct args, steps), .result = true,       \
        .arg = argument, .help = what                                                              \
    }

/* clang-format off */
static const struct opt opts[] = {
    WANTED_OPTIONS(struct args, wanted, true),
    STEP("crop", "X,Y,W,H", "cut out a part: nodes, or lengths with their unit"),
    STEP("resample", "DX[,DY]|NXxNY", "to other spacings, or numbers of nodes"),
    STEP("mirror", "x|y", "left to right, or top to bottom"),
    STEP("rotate", "90|180|270", "counterclockwise"),
    STEP("extrude", "N", "a row becomes a map of N equal rows, which repeats along y (a column: along x)"),
    {.name = "set", .type = OPT_TEXTS, .at = offsetof(struct args, steps), .result = true,
     .arg = "KEY=VALUE",
     .help = "set a key of every frame, KEY= removes it; may be repeated"},
    {.name = NULL},
};
/* clang-format on */

static void settle(struct tool *t);

static const struct tool_info info = {
    .name = "rc-pick",
    .summary = "Choose frames of a grid stream, cut, resample and turn them, set their keys",
    .operands = "[FILE...]",
    .examples = "  rc-pick --channel height result.rcg -o surface.rcg\n"
                "  rc-pick --crop 10um,0,20um,20um --resample 1um surface.rcg | rc-info\n"
                "  rc-pick --channel pressure --set load= result.rcg | rc-info\n",
    .opts = opts,
    .reads = READS_STREAM,
    .mends = true,
    .writes = WRITES_STREAM,
    .settle = settle,
};

/* ---- --set KEY=VALUE ---- */

/* Header lines that --set refuses: they describe the grid or order the stream. */
static const struct {
    const char *key, *why;
} kept[] = {
    {"nx", "it counts the values of a row"},
    {"ny", "it counts the rows"},
    {"type", "--type says how values are written"},
    {"crc32", "it is computed from the written bytes"},
    {"case", "frames of a case belong together, and keep its number"},
    {"history", "it records the steps, including this one"},
};

static bool
is_spacing(const char *key)
{
    return strcmp(key, "dx") == 0 || strcmp(key, "dy") == 0;
}

static bool
is_field(const char *key)
{
    return is_spacing(key) || strcmp(key, "channel") == 0 || strcmp(key, "unit") == 0;
}

/* Splits the text of the step into key and value, which stay valid; lengths become SI, as in the history. */
static void
settle_set(struct tool *t, struct step *step)
{
    size_t n = strcspn(step->text, "="), size = strlen(step->text) + RC_NUMBER_SIZE;
    const char *value = step->text + n + (step->text[n] == '=');
    char *text = args.made[step - args.steps.step] = tool_room(t, size, 1, "a text");

    snprintf(text, size, "%.*s", (int)n, step->text);
    if (step->text[n] == '\0' || !rc_key_valid(text))
        tool_usage(
            t,
            "--set %s: KEY=VALUE is expected, with a key of lower-case letters, digits, points, "
            "underscores and hyphens",
            step->text);
    for (size_t k = 0; k < sizeof kept / sizeof *kept; k++)
        if (strcmp(kept[k].key, text) == 0)
            tool_usage(t, "--set %s: %s cannot be set: %s", step->text, text, kept[k].why);
    if (*value == '\0' && is_field(text))
        tool_usage(t, "--set %s: every frame has a %s: give it a value", step->text, text);
    if (*value != '\0' && rc_key_check(text, value, &t->err) != RC_OK)
        tool_usage(t, "--set %s", t->err.text);
    if (!rc_utf8_valid(value))
        tool_usage(t, "--set %s...: the value is not UTF-8", text);
    if (is_spacing(text)) {
        if (unit_number(value, UNIT_M, &step->value, &t->err) != RC_OK)
            tool_usage(t, "--set %s: %s", step->text, t->err.text);
        if (!(step->value > 0))
            tool_usage(t, "--set %s: it must be above 0", step->text);
        text[n] = '=';
        rc_number_text(text + n + 1, step->value);
    } else {
        memcpy(text + n, step->text + n, strlen(step->text + n) + 1);
    }
    step->text = text;
}

/* True if the steps change a height to another surface. */
static bool
changes_heights(void)
{
    for (size_t k = 0; k < args.steps.n; k++)
        if (strncmp(args.steps.step[k].text, "dx=", 3) == 0 ||
            strncmp(args.steps.step[k].text, "dy=", 3) == 0 ||
            strncmp(args.steps.step[k].text, "unit=", 5) == 0)
            return true;
    return false;
}

static void
set(struct tool *t, struct rc_grid *g, const struct step *step)
{
    const char *value = strchr(step->text, '=') + 1;
    RC_OWNED char *key = tool_copy(t, step->text);

    key[value - step->text - 1] = '\0';
    if (strcmp(key, "dx") == 0)
        g->dx = step->value;
    else if (strcmp(key, "dy") == 0)
        g->dy = step->value;
    else if (strcmp(key, "channel") == 0)
        tool_must(t, g, rc_text_set(&g->channel, value, &t->err));
    else if (strcmp(key, "unit") == 0)
        tool_must(t, g, rc_text_set(&g->unit, value, &t->err));
    else
        tool_set(t, g, key, *value == '\0' ? NULL : value);
}

/* ---- the command line ---- */

static void
settle(struct tool *t)
{
    wanted_check(&args.wanted, t);
    if (args.steps.n == 0 && args.wanted.channel == NULL && args.wanted.depth.n == 0 &&
        args.wanted.number.n == 0)
        tool_usage(
            t, "nothing to do: give --channel, --depth or --case, or --set KEY=VALUE, or --crop, "
               "--resample, --mirror, --rotate or --extrude");
    for (size_t k = 0; k < args.steps.n; k++)
        if (pick_geometry(&args.steps.step[k]))
            pick_geometry_settle(t, &args.steps.step[k]);
        else
            settle_set(t, &args.steps.step[k]);
}

/* ---- frame by frame ---- */

/* Ends the tool when two frames of a case would get the same channel. */
static void
demand_one_channel(struct tool *t, const struct rc_grid *g)
{
    static char first[256];
    static size_t number; /* number of the current case; 0: none yet */

    if (rc_grid_case(g) != number) {
        number = rc_grid_case(g);
        snprintf(first, sizeof first, "%s", g->channel);
    } else if (strncmp(first, g->channel, sizeof first - 1) != 0) {
        tool_refuse(
            t, g,
            "--set channel=... would give %s and %s of one case the same name: choose one by "
            "--channel",
            first, g->channel);
    }
}

static void
change(struct tool *t, struct rc_grid *g, struct part *part)
{
    bool renamed = false;

    for (size_t k = 0; k < args.steps.n; k++)
        renamed = renamed || strncmp(args.steps.step[k].text, "channel=", 8) == 0;
    if (renamed)
        demand_one_channel(t, g);
    if (changes_heights())
        results_demand_none(t, g);
    /* because the number of depths may be smaller now */
    if (args.wanted.channel != NULL || args.wanted.depth.n > 0)
        tool_set(t, g, "frames", NULL);
    for (size_t k = 0; k < args.steps.n; k++)
        if (pick_geometry(&args.steps.step[k]))
            pick_geometry_do(t, g, &args.steps.step[k], part);
        else
            set(t, g, &args.steps.step[k]);
    if (rc_keys_check(g, &t->err) != RC_OK)
        tool_refuse(t, g, "%s: correct it with --set", t->err.text);
    tool_sign(t, g);
}

/* True if only rows are needed: frames that wait for a decision about depths need their values. */
static bool
works_by_rows(void)
{
    bool does = args.wanted.depth.n == 0;

    for (size_t k = 0; k < args.steps.n; k++)
        does = does && pick_by_rows(&args.steps.step[k]);
    return does;
}

/* Writes a part of the map that was read last. */
static void
write_part(struct tool *t, struct rc_grid *g, size_t nx, const struct part *part)
{
    const size_t together = tool_rows_together(nx);
    RC_OWNED double *v = tool_room(t, together * nx, sizeof *v, "some rows of a map");

    tool_skip_rows(t, part->top);
    tool_write_head(t, g);
    for (size_t n, left = g->ny; left > 0; left -= n) {
        n = left < together ? left : together;
        tool_read_rows(t, n, v);
        tool_must(t, g,
                  rc_crop(&(struct rc_shape){nx, n, g->dx, g->dy}, v, part->left, 0,
                          &(struct rc_shape){g->nx, n, g->dx, g->dy}, v, &t->err));
        tool_write_rows(t, g, n, v);
    }
}

int
main(int argc, char **argv)
{
    struct rc_grid *g;
    struct tool t;

    tool_start(&t, &info, argc, argv, &args);
    if (works_by_rows())
        tool_by_rows(&t);
    while ((g = wanted_read(&args.wanted, &t)) != NULL) {
        const size_t nx = g->nx;
        struct part part = {0, 0};
        change(&t, g, &part);
        if (tool_has_values(g))
            tool_write(&t, g);
        else
            write_part(&t, g, nx, &part);
        rc_grid_free(g);
    }
    return tool_finish(&t);
}
