#include "info.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    PATH_SIZE = 4096
};

struct info_file {
    struct tool *tool;
    const char *option, *name;
    FILE *file;
    struct rc_writer *writer;
};

/* Where it is under construction: a tool that ends on the way has to find it. */
static char half_written[PATH_SIZE];

static void
remove_half_written(void)
{
    if (half_written[0] != '\0')
        unlink(half_written);
}

static _Noreturn void
failed(struct info_file *f)
{
    tool_die(f->tool, EXIT_IMPOSSIBLE, "%s %s: %s", f->option, f->name, strerror(errno));
}

/* A device or a FIFO is written directly; so that of the file itself, or of one beside it. */
static FILE *
open_file(struct info_file *f)
{
    struct stat st;
    mode_t mask = umask(0);
    int fd;

    umask(mask);
    if (stat(f->name, &st) == 0 && !S_ISREG(st.st_mode))
        return fopen(f->name, "wb");
    if (strlen(f->name) >= PATH_SIZE - 8) {
        errno = ENAMETOOLONG;
        return NULL;
    }
    snprintf(half_written, sizeof half_written, "%s.XXXXXX", f->name);
    if ((fd = mkstemp(half_written)) < 0) {
        half_written[0] = '\0';
        return NULL;
    }
    atexit(remove_half_written);
    return fchmod(fd, 0666 & ~mask) == 0 ? fdopen(fd, "wb") : NULL;
}

struct info_file *
info_file_new(struct tool *t, const char *option, const char *name)
{
    struct info_file *f = calloc(1, sizeof *f);
    struct rc_err err;

    if (f == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "out of memory");
    *f = (struct info_file){.tool = t, .option = option, .name = name};
    if (strcmp(name, "-") == 0)
        tool_die(t, EXIT_USAGE, "%s -: standard output is for the figures: name a file", option);
    tool_demand_writable(t, option, name);
    if ((f->file = open_file(f)) == NULL)
        failed(f);
    if ((f->writer = rc_writer_new(f->file, &err)) == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "%s", err.text);
    return f;
}

void
info_file_put(struct info_file *f, const struct rc_grid *g)
{
    struct rc_err err;

    if (rc_writer_put(f->writer, g, &err) != RC_OK)
        tool_die_at(f->tool, g, EXIT_IMPOSSIBLE, "%s %s: %s", f->option, f->name, err.text);
}

void
info_file_end(struct info_file *f)
{
    struct rc_err err;

    if (rc_writer_end(f->writer, &err) != RC_OK)
        tool_die(f->tool, EXIT_IMPOSSIBLE, "%s %s: %s", f->option, f->name, err.text);
    rc_writer_free(f->writer);
    if (fclose(f->file) != 0)
        failed(f);
    if (half_written[0] != '\0' && rename(half_written, f->name) != 0)
        failed(f);
    half_written[0] = '\0';
    free(f);
}
