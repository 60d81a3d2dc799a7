/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: the page of rc-report. A table (parts.c) has a row for each part: the command
 * of another tool, the file that it writes into a temporary folder, and the function that shows this file.
 */
#ifndef RC_TOOL_PAGE_H
#define RC_TOOL_PAGE_H

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "tools/problem/problem.h"
#include "tools/scene/scene.h"

enum {
    PAGE_WORDS = 512, /* more than a command has words or a table columns */
    PAGE_CELL = 128   /* a name, a number or a unit */
};

/* What the command line gives; NAN or NULL: not given. */
extern struct page_args {
    struct physics physics;
    struct scene_args effects;
    double outliers, spikes, nu;
    struct numbers noise;
    bool mirror;
    const char *title, *relaxation, *travel;
    size_t passes;
} page_args;

struct page {
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
    const char *contact[PAGE_WORDS]; /* options of rc-solve */
    size_t contacts;
    const char
        *scene[PAGE_WORDS]; /* options of rc-scene: the last load, the bodies, data of effects */
    size_t scenes;
    const char *given[PAGE_WORDS]; /* all options that change results */
    size_t givens;
    char times[4 * RC_NUMBER_SIZE]; /* of a creep curve */
    char stress[8192];              /* the report of the stresses below all of the map */
    double yield;                   /* the yield stress of body 1; NAN: unknown */
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

extern char page_folder[];
/* Makes the folder. It is removed when the tool ends, also by a signal. */
void page_make_folder(struct tool *t);
void page_remove_folder(void);
/* Opens a file of the folder, or ends the tool. */
FILE *page_open(struct page *run, const char *name);

/* ---- the parts ---- */

/* A command gets "-o FILE" at its end. The words in capitals stand for others, see commands.c. */
struct page_part {
    const char *heading, *command, *file;
    void (*show)(struct page *run, FILE *in, const char *a, const char *b);
    const char *a, *b;
    bool (*wanted)(const struct page *run); /* NULL: always */
    bool may_fail;                          /* its file is then empty */
    /* of an effect: options that must be given; an empty file of its section shows nothing */
    const char *needs;
    /* a sentence of the first paragraph about a figure of the file; `denies`: if it is false */
    const char *says, *denies, *figure;
    /* an estimated error of the file that may be far above the error, and what it covers */
    const char *wide, *covers;
};
extern const struct page_part page_parts[];
extern const size_t page_part_count;
/* True if the options ask for the part. */
bool page_is_wanted(const struct page *run, const struct page_part *part);
/* True if the page has a section of an effect that reads the gap and the heights of the contact. */
bool page_has_readers(const struct page *run);
/* True if the option with this name of n characters was given. */
bool page_was_given(const struct page *run, const char *name, size_t n);

/* ---- commands ---- */

/* True for the options of the load. */
bool page_is_load(const char *word);
/* Runs the command of a part. False: it failed, which it may. */
bool page_run_part(struct page *run, const struct page_part *part);
/* Makes an empty file in the folder, which shows nothing. */
void page_leave_empty(struct page *run, const char *name);

/* ---- HTML ---- */

/* Writes text of files and users: no character of it acts as markup, and none is a control character. */
void page_text(FILE *out, const char *text);
/* Writes a number with its unit. */
void page_value(FILE *out, const char *text, const char *unit);
/* Ends the first cell of a line of a table, and returns the next one. */
char *page_end_cell(char *cell);
/* Finds the cell of a column in the last row of a table, and its unit. */
bool page_last_cell(struct page *run, const char *file, const char *column, char text[PAGE_CELL],
                    char unit[PAGE_CELL]);
/* Finds the cell of a column in the first row whose cells have these texts: pairs of a column and a text, the
 * last one of NULL. */
bool page_cell(struct page *run, const char *file, const char *column, const char *const where[][2],
               char text[PAGE_CELL]);
/* page_last_cell as a number; NAN: none. */
double page_last_number(struct page *run, const char *file, const char *column);
/* Writes it with its unit. */
void page_last(struct page *run, const char *file, const char *column);

/* Functions of parts: each writes what the file `in` of the part holds; `a` and `b` are those of its row. */
typedef void page_show(struct page *run, FILE *in, const char *a, const char *b);
page_show page_show_picture, page_show_lines, page_show_figures, page_show_table, page_show_bars,
    page_show_bodies, page_show_verdict, page_show_limits, page_show_messages, page_show_commands,
    page_show_effects;

#endif
