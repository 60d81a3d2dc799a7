/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The programs that rc-cost runs, their files, reports and messages. */
#include "cost.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- files ---- */

int
cost_file(struct tool *t)
{
    const char *folder = getenv("TMPDIR");
    char name[4096];
    int fd;

    snprintf(name, sizeof name, "%s/rc-cost-XXXXXX",
             folder == NULL || *folder == '\0' ? "/tmp" : folder);
    if ((fd = mkstemp(name)) < 0)
        tool_die(t, "a temporary file %s cannot be made: %s", name, strerror(errno));
    unlink(name);
    fcntl(fd, F_SETFD, FD_CLOEXEC);
    return fd;
}

FILE *
cost_file_read(struct tool *t, int file)
{
    int fd = fcntl(file, F_DUPFD_CLOEXEC, 0);
    FILE *stream;

    if (fd < 0 || lseek(fd, 0, SEEK_SET) < 0 || (stream = fdopen(fd, "rb")) == NULL)
        tool_die(t, "a temporary file cannot be read: %s", strerror(errno));
    return stream;
}

enum process_end
cost_process(struct cost_case *c, const char *const word[], int in, int out, double allowed,
             const char *doing, int *status)
{
    struct process p = {.in = in, .out = out, .allowed = allowed, .doing = doing};
    enum process_end end;

    free(c->said);
    if (out >= 0 && (ftruncate(out, 0) != 0 || lseek(out, 0, SEEK_SET) < 0) && errno != EINVAL)
        tool_die(c->tool, "a temporary file cannot be written: %s", strerror(errno));
    end = process_run(c->tool, word, &p);
    c->said = p.said;
    *status = p.status;
    return end;
}

/* ---- their reports and messages ---- */

const char *
cost_line(const char **at)
{
    const char *line = *at;

    while (line != NULL && *line != '{' && *line != '\0')
        line += strcspn(line, "\n") + (line[strcspn(line, "\n")] == '\n');
    if (line == NULL || *line == '\0')
        return NULL;
    *at = line + strcspn(line, "\n");
    return line;
}

const char *
cost_message(const char *said)
{
    static char text[256];
    const char *line = said == NULL ? "" : said, *next, *at;

    for (text[0] = '\0'; *line != '\0'; line = next) {
        size_t n = strcspn(line, "\n"), name = strcspn(line, " \n");

        next = line + n + (line[n] == '\n');
        if (strncmp(line, "rc-", 3) == 0 && line[name - 1] == ':' && line[name] == ' ')
            snprintf(text, sizeof text, "%.*s", (int)(n - name - 1), line + name + 1);
    }
    at = strstr(text, ", frame ");
    at = at == NULL ? NULL : strstr(at, "): ");
    return at == NULL ? text : at + 3;
}
