/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "siblings.h"

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    PATH_SIZE = 512,
    LINE_SIZE = 64
};

/* The first line of /proc/PROCESS/FILE; false if it cannot be read. */
static bool
line_of(const char *root, const char *process, const char *file, char line[LINE_SIZE])
{
    char path[PATH_SIZE];
    FILE *in;
    bool good;

    snprintf(path, sizeof path, "%s/proc/%s/%s", root, process, file);
    if ((in = fopen(path, "r")) == NULL)
        return false;
    good = fgets(line, LINE_SIZE, in) != NULL;
    fclose(in);
    return good;
}

static bool
is_of_user(const char *root, const char *process, uid_t user)
{
    char path[PATH_SIZE];
    struct stat st;

    snprintf(path, sizeof path, "%s/proc/%s", root, process);
    return stat(path, &st) == 0 && st.st_uid == user;
}

struct siblings
machine_siblings(const char *root)
{
    struct siblings s = {1, 0};
    char path[PATH_SIZE], own[LINE_SIZE], name[LINE_SIZE], self[32];
    const double page = (double)sysconf(_SC_PAGESIZE);
    unsigned long pages;
    struct dirent *entry;
    DIR *all;

    snprintf(path, sizeof path, "%s/proc", root);
    snprintf(self, sizeof self, "%ld", (long)getpid());
    if (!line_of(root, "self", "comm", own) || (all = opendir(path)) == NULL)
        return s;
    while ((entry = readdir(all)) != NULL) {
        const char *process = entry->d_name;

        if (process[strspn(process, "0123456789")] != '\0' || strlen(process) > 20 ||
            strcmp(process, self) == 0 || !line_of(root, process, "comm", name) ||
            strcmp(name, own) != 0 || !is_of_user(root, process, getuid()))
            continue;
        s.n++;
        if (line_of(root, process, "statm", name) && sscanf(name, "%*s %lu", &pages) == 1)
            s.bytes += page * (double)pages;
    }
    closedir(all);
    return s;
}
