/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The commands of the parts: their words, their messages and how they are shown. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "page.h"

bool
page_is_load(const char *word)
{
    return strcmp(word, "--load") == 0 || strcmp(word, "--mean-pressure") == 0 ||
           strcmp(word, "--approach") == 0;
}

struct command {
    const char *word[PAGE_WORDS + 1];
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
add_preparation(const struct page *run, struct command *c)
{
    if (!run->stream)
        add(c, "--poly", "2");
    if (*run->spikes != '\0')
        add(c, "--spikes", run->spikes);
    if (*run->outliers != '\0')
        add(c, "--outliers", run->outliers);
    add(c, "--fill", NULL);
    if (page_args.mirror && rc_repeats(page_args.physics.boundary) == 1)
        add(c, "--mirror", page_args.physics.boundary.x ? "x" : "y");
    else if (page_args.mirror)
        add(c, "--mirror", NULL);
    add(c, run->stream ? run->path : "measured.rcg", NULL);
}

/* Adds an option with its values, if it was given. */
static void
add_given(const struct page *run, struct command *c, const char *name)
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
add_last_contact(const struct page *run, struct command *c, bool soft)
{
    bool in = true;

    for (size_t k = 0; k < run->contacts; k++) {
        const char *word = run->contact[k];

        if (strncmp(word, "--", 2) == 0)
            in = strcmp(word, "--hardness") != 0 && !(soft && strcmp(word, "--E1") == 0);
        if (in)
            add(c, k > 0 && page_is_load(run->contact[k - 1]) ? run->load : word, NULL);
    }
}

/* Adds a word of a command. @NAME is this option, if it was given. ORIGINAL, PREPARED and the like are
 * replaced by files and options. */
static void
expand(const struct page *run, struct command *c, const char *word)
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
        add(c, page_has_readers(run) ? "pressure,gap,height" : "pressure", NULL);
    else if (strcmp(word, "COUPLING") == 0 && !isfinite(page_args.physics.hardness))
        return; /* rc-slip solves further loads of elastic bodies only */
    else if (strcmp(word, "COUPLING") == 0)
        add(c, "--coupling", "none");
    else if (strcmp(word, "FLUID") == 0 && !page_was_given(run, "viscosity", strlen("viscosity")))
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
write_command(const struct page *run, const struct command *c)
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

/* Messages about options, "rc-solve: --hardness 129HV is ...", are said once: each command repeats them. The
 * others remain. */
static void
leave_repeated(struct page *run, char *said)
{
    char *to = said, *line = said, *next;

    if (fflush(run->said.file) != 0)
        tool_die(&run->t, "out of memory");
    for (; *line != '\0'; line = next) {
        const char *option = strstr(line, ": --");
        RC_OWNED char *text = NULL;
        size_t n = strcspn(line, "\n");

        n += line[n] == '\n';
        next = line + n;
        if (option != NULL && option == line + strcspn(line, ":") && option < next) {
            if ((text = strndup(option, (size_t)(next - option))) == NULL)
                tool_die(&run->t, "out of memory");
            if (run->said.text != NULL && strstr(run->said.text, text) != NULL)
                continue;
        }
        memmove(to, line, n);
        to += n;
    }
    *to = '\0';
}

/* Repeats the messages of a command, and ends as it did if it failed. */
static void
take_messages(struct page *run, const char *name, enum process_end end, struct process *p,
              bool may_fail)
{
    struct tool *t = &run->t;

    if (end == PROCESS_INTERRUPTED)
        page_remove_folder(); /* the signal ends this tool, which then does nothing else */
    if (end == PROCESS_INTERRUPTED || end == PROCESS_DIED)
        tool_die(t, "%s was ended by a signal", name);
    if (p->said != NULL && end != PROCESS_FAILED)
        leave_repeated(run, p->said);
    if (p->said != NULL && (end == PROCESS_FAILED || !t->quiet))
        fputs(p->said, stderr);
    if (end == PROCESS_FAILED && !may_fail) {
        if (strcmp(name, "rc-import") == 0)
            fputs("rc-report: if this file needs options of rc-import, write its grid stream to a "
                  "file, "
                  "and make the page of that\n",
                  stderr);
        whole_files_remove();
        exit(p->status == EXIT_USAGE ? EXIT_USAGE : EXIT_IMPOSSIBLE);
    }
    if (p->said != NULL)
        fputs(p->said, run->said.file);
    if (p->status == EXIT_SHORT)
        tool_fails_with(t, EXIT_SHORT);
    free(p->said);
}

void
page_leave_empty(struct page *run, const char *name)
{
    char path[WHOLE_PATH];
    FILE *empty;

    snprintf(path, sizeof path, "%s/%s", page_folder, name);
    empty = fopen(path, "wb");
    if (empty == NULL || fclose(empty) != 0)
        tool_die(&run->t, "%s: %s", path, strerror(errno));
}

/* Runs the command of a part. False: it failed, which it may. */
bool
page_run_part(struct page *run, const struct page_part *part)
{
    struct process p = {
        .in = run->nothing, .out = run->nothing, .folder = page_folder, .allowed = INFINITY};
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
        page_leave_empty(run, part->file);
    free(words);
    return end != PROCESS_FAILED;
}
