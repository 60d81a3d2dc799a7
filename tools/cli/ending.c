#include "ending.h"

#include <string.h>
#include <strings.h>
#include <sys/stat.h>

void
ending_demand_png(struct tool *t, const char *option, const char *name)
{
    size_t n = name == NULL ? 0 : strlen(name);
    struct stat st;

    if (name == NULL || (n >= 4 && strcasecmp(name + n - 4, ".png") == 0))
        return;
    if (strncmp(name, "/dev/", 5) == 0 || (stat(name, &st) == 0 && !S_ISREG(st.st_mode)))
        return;
    tool_die(t, EXIT_USAGE, "%s %s: a picture is a PNG: its name has to end in .png", option, name);
}
