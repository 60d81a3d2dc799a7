/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "info.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct info_file {
    struct tool *tool;
    const char *option, *name;
    FILE *file;
    struct whole_file whole;
    struct rc_writer *writer;
};

static _Noreturn void
failed(struct info_file *f)
{
    tool_die(f->tool, "%s %s: %s", f->option, f->name, strerror(errno));
}

struct info_file *
info_file_new(struct tool *t, const char *option, const char *name)
{
    struct info_file *f = tool_room(t, 1, sizeof *f, "a file");

    *f = (struct info_file){.tool = t, .option = option, .name = name};
    if (strcmp(name, "-") == 0)
        tool_usage(t, "%s -: standard output is for the figures: name a file", option);
    tool_demand_writable(t, option, name);
    if ((f->file = whole_file_open(&f->whole, name)) == NULL)
        failed(f);
    f->writer = tool_made(t, NULL, rc_writer_new(f->file, &t->err));
    return f;
}

void
info_file_put(struct info_file *f, const struct rc_grid *g)
{
    for (size_t k = 0; k < g->nx * g->ny; k++)
        if (!isfinite(g->v[k]))
            tool_refuse(f->tool, g,
                        "%s: the powers are too large for a number: are the units of heights and "
                        "spacings right?",
                        f->option);
    if (rc_writer_put(f->writer, g, &f->tool->err) != RC_OK)
        tool_refuse(f->tool, g, "%s %s: %s", f->option, f->name, f->tool->err.text);
}

void
info_file_end(struct info_file *f)
{
    if (rc_writer_end(f->writer, &f->tool->err) != RC_OK)
        tool_die(f->tool, "%s %s: %s", f->option, f->name, f->tool->err.text);
    rc_writer_free(f->writer);
    if (!whole_file_put(&f->whole, f->file))
        failed(f);
    free(f);
}
