/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: rc-cost. A study varies options of a command, which is one program or several
 * in a pipe. A list has the values of one option, or the grids. A trial has one value of each list; the
 * reference has the tightest ones. A run is one program with its words and its input; trials share runs.
 * Nothing here knows what an option means: `--completions json` of the programs says which options they have
 * and what their figures are.
 */
#ifndef RC_COST_H
#define RC_COST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

enum {
    COST_WORDS = 128,    /* most words of a program */
    COST_PROGRAMS = 8,   /* most programs of a command */
    COST_LISTS = 6,      /* most lists */
    COST_VALUES = 64,    /* most values of a list */
    COST_TRIALS = 256,   /* most trials */
    COST_CHANNELS = 64,  /* most channels of the last program */
    COST_FIGURES = 160,  /* most figures of all programs */
    COST_ESTIMATES = 48, /* most estimates of all programs */
    COST_SHOWN = 4,      /* most figures in the table */
    COST_NAME = 64
};

/* ---- command.c: the command ---- */

struct cost_program {
    const char *name;
    char *json; /* its --completions json */
    const char *word[COST_WORDS];
    size_t words;
    bool reads; /* a stream, on standard input; else files, with - among its words */
    bool streams, reports, plans; /* it writes a stream, has --report and --dry-run */
};

struct cost_command {
    struct tool *tool;
    int nowhere; /* /dev/null */
    struct cost_program program[COST_PROGRAMS];
    size_t programs;
};

/* Takes the words after `--`, or a single one that is split as a shell would; ends the tool if they are not
 * a pipe of tools of this family whose results can be compared. */
void cost_command_read(struct cost_command *command, char **word, size_t words);
/* The object of an option in the program's list; NULL: it has none of this name or alias. */
const char *cost_option(const struct cost_program *program, const char *name);
/* The argument of the option in the words of the program, "" if it has none; NULL: they do not have it. */
const char *cost_option_given(const struct cost_program *program, const char *name);
/* Ends the tool if the option may not be varied. */
void cost_option_check(struct tool *tool, const char *option, const char *from);
/* Gives an option the value in place of the one that the words have; returns their new number. "no" takes
 * the option away, and "yes" is the option alone, if it takes no argument or can be without. The words
 * are copied into `text`, which must last as long as they. */
size_t cost_option_put(struct tool *tool, const struct cost_program *program, const char *word[],
                       size_t words, const char *name, const char *value, char text[320]);

/* ---- trials.c: lists and trials ---- */

struct cost_list {
    char name[COST_NAME], option[COST_NAME]; /* "2.tol", "tol" */
    size_t program;                          /* SIZE_MAX: each program with the option */
    bool grid;                               /* values are 8 for 1/8 of the nodes a side */
    const char *value[COST_VALUES];
    size_t n, given; /* values with the reference; of the command line */
    bool numbers;    /* each value is a plain number */
    double number[COST_VALUES];
    bool whole;             /* whole numbers */
    int tight;              /* -1: small numbers are accurate, 1: large ones; 0: not known yet */
    bool fixed;             /* --reference gave its value */
    size_t reference, last; /* of the values: the tightest one; the tightest one of the others */
    double least, most;     /* bounds of the option; NAN: none */
};

enum cost_state {
    COST_OPEN,
    COST_DONE,
    COST_LEFT_OUT, /* not started: `why` */
    COST_STOPPED,  /* started, no result: `why` */
};

struct cost_run {
    size_t level; /* 0: rc-pick; k: program k - 1 of the command */
    size_t from;  /* the run whose output it reads; SIZE_MAX: the input */
    const char **word;
    int output; /* -1: none, or released */
    enum cost_state state;
    bool converged, compared;
    char *report, why[256];
    size_t lines, runs, turn;
    double seconds, processor, memory, convolutions; /* NAN: unknown; s, s, B */
    double planned, mebibytes;
    double channel[COST_CHANNELS]; /* error of each channel; NAN: unknown */
};

struct cost_trial {
    size_t pick[COST_LISTS];
    size_t run[COST_PROGRAMS + 1],
        runs;    /* from the first program to the last; rc-pick is not one */
    size_t grid; /* the run of rc-pick; SIZE_MAX: the input */
    unsigned coarse;
    bool reference, converged, front, optimistic, unjudged;
    const char *name; /* NULL: that of its values */
    enum cost_state state;
    char why[256];
    double expected, seconds, processor, memory, convolutions; /* NAN: unknown */
    double estimate, error, bound;
    double figure[COST_FIGURES],
        judged[COST_ESTIMATES]; /* errors with sign; estimates; NAN: unknown */
};

struct cost_channel {
    char name[COST_NAME];
    bool passed; /* the input of the last program has it */
    bool whole;  /* whole numbers up to 10 */
    bool differs;
    double sum;
};

struct cost_figure { /* of the results, or an estimate */
    size_t program;
    char name[COST_NAME], of[COST_NAME], by[COST_NAME];
    /* "2.contact_area" where several programs report this figure, else its name; of the report, where the
     * last of them has the name without a number */
    char shown[COST_NAME + 8], column[COST_NAME + 8];
    char unit[16];
    bool differs;
};

/* What an error belongs to: channel k, or figure k. */
struct cost_object {
    bool frame, known;
    size_t k;
};

struct cost_case {
    struct tool *tool;
    struct cost_command command;
    struct cost_list list[COST_LISTS];
    size_t lists, points;        /* `points`: the list along whose values the picture draws lines */
    const struct rc_grid *first; /* the first map of the input, without values */
    struct rc_shape shape;
    double limit, budget, error; /* s, s, -; NAN: not given */
    double began,
        spent; /* s: when the trials began; the time of those that ran before the others */
    bool choosing, shown; /* a command is wanted; all trials are shown nevertheless */
    const char *of;       /* --of, or NULL */
    double around;        /* s of a process besides its work */
    int input, nowhere;
    size_t turn;
    bool usage; /* a program has refused its command line */
    struct cost_run *run;
    size_t runs, run_room;
    struct cost_trial *trial; /* the reference is trial[reference] */
    size_t trials, room, reference;
    size_t cases;
    struct cost_channel channel[COST_CHANNELS];
    size_t channels;
    struct cost_figure figure[COST_FIGURES], estimate[COST_ESTIMATES];
    size_t figures, estimates;
    struct cost_object ranked, judged; /* `judged`: what the estimate of the table belongs to */
    double reference_error;            /* of the ranked object */
    char *said;                        /* standard error of the last process */
};

/* Adds a list, "1e-2,1e-4" or with ';' between the values; `name`: "tol", "2.increments", "grid"; `from`: the
 * option of rc-cost, for messages. Ends the tool if a program or an option does not exist. */
void cost_list_add(struct cost_case *c, const char *from, const char *name, const char *values);
/* The list of --vary, "2.increments=4,8". */
void cost_list_vary(struct cost_case *c, const char *text);
/* Sets the reference of a list, "tol=1e-9". */
void cost_list_reference(struct cost_case *c, const char *text);
/* The value of the reference, once the direction is known. */
void cost_list_close(struct cost_case *c, struct cost_list *list);
/* Makes the tightest value of the command line the reference. */
void cost_list_shorten(struct cost_list *list);
/* The place of a value from the loosest, 0, to the tightest. */
size_t cost_list_rank(const struct cost_list *list, size_t value);
/* Makes all trials of the lists, without the reference. */
void cost_trials(struct cost_case *c);
/* The place of the trial of these values; SIZE_MAX: none, unless it `adds` one. */
size_t cost_trial_find(struct cost_case *c, const size_t pick[COST_LISTS], bool adds);
/* A trial on 1/coarse of the nodes a side. */
size_t cost_trial_add(struct cost_case *c, unsigned coarse);
/* "grid 1/2, tol 1e-4"; with `series` without the grid and the list of the points. */
const char *cost_name(const struct cost_case *c, const struct cost_trial *t, bool series,
                      char text[160]);
/* "1/8" for a grid, else the value. */
const char *cost_value(const struct cost_list *list, size_t value, char text[COST_NAME]);
/* The grid of the trial. */
struct rc_shape cost_shape(const struct cost_case *c, const struct cost_trial *t);

/* ---- files.c: programs, files, reports ---- */

/* An unnamed file, deleted when its last descriptor is closed. Ends the tool on failure. */
int cost_file(struct tool *tool);
/* Opens it for reading from the beginning; the caller closes it. */
FILE *cost_file_read(struct tool *tool, int file);
/* Runs a command. `in` and `out`: its standard input and output, which is emptied first (-1: the output is
 * captured). Its standard error is then in c->said, its exit status in *status. */
enum process_end cost_process(struct cost_case *c, const char *const word[], int in, int out,
                              double allowed, const char *doing, int *status);
/* The last message of a tool, without the tool's name and the place of the frame; "": none. Valid until the
 * next call. */
const char *cost_message(const char *said);
/* The next line of a report that is an object, and moves *at past it; NULL: none. */
const char *cost_line(const char **at);

/* ---- measure.c: runs and errors ---- */

/* A run that has ended: its output, `file`, is the input of this trial. */
size_t cost_input_add(struct cost_case *c, size_t trial, int file);
/* Finds or adds the runs of a trial, and its expected cost; leaves out a trial that is not possible. */
void cost_plan(struct cost_case *c, struct cost_trial *t);
/* Runs the programs of a trial that have not run, and compares the results with the reference, if it is
 * known. False when the tool was interrupted. */
bool cost_trial_run(struct cost_case *c, size_t trial, double allowed);
/* One more run of a program; the shortest time counts. */
void cost_run_again(struct cost_case *c, const struct cost_trial *t, size_t run, double allowed);
/* Sets time, memory and work of a trial from its runs. */
void cost_trial_sum(const struct cost_case *c, struct cost_trial *t);
/* Reads channels and figures of the reference, and compares the trials that have run before it. */
void cost_reference_read(struct cost_case *c);
/* Compares the results of a trial with the reference. */
void cost_compare(struct cost_case *c, struct cost_trial *t);
/* Relative error of a figure or a frame of the trial, with sign; NAN: unknown. */
double cost_error_of(const struct cost_case *c, const struct cost_trial *t,
                     struct cost_object object);
/* The largest estimate for the object; NAN: none. On a coarser grid only estimates of its error hold, but
 * with `any` the others count too. */
double cost_estimate_of(const struct cost_case *c, const struct cost_trial *t,
                        struct cost_object object, bool any);
struct cost_object cost_object_named(const struct cost_case *c, const char *name);
/* What an estimate belongs to: a frame, or a figure of its own program. */
struct cost_object cost_object_of(const struct cost_case *c, const struct cost_figure *estimate);
const char *cost_object_name(const struct cost_case *c, struct cost_object object);
/* The error of the reference: its estimate, or the last change along a list, whichever is larger. */
double cost_reference_error(const struct cost_case *c, struct cost_object object);
/* True if the estimate for an object is below 0.9 of its error, less the estimate of the reference or
 * its last change, whichever is smaller. */
bool cost_is_optimistic(const struct cost_case *c, const struct cost_trial *t,
                        struct cost_object object);
/* Chooses the ranked object, and sets error, estimate, bound and marks of all trials. */
void cost_judge(struct cost_case *c);

/* ---- schedule.c ---- */

/* True if a run of this number of repetitions and this time is repeated. Short runs are repeated in turns:
 * the shortest time is that of the work; the excess is due to other programs. */
bool cost_again(double runs, double seconds);
/* True if --error may choose it: by the triangle inequality its true error is at most `bound`. */
bool cost_is_near(const struct cost_case *c, const struct cost_trial *t);
/* Finds which end of each list is the tight one, by the work of the trials at both ends. */
void cost_find_directions(struct cost_case *c);
/* Runs the reference and its neighbours; ends the tool on failure. */
void cost_run_reference(struct cost_case *c);
/* Runs the trials that fit into the time limit, the fastest first; short ones several times. */
void cost_run_trials(struct cost_case *c);

/* ---- show.c, plot.c: results ---- */

/* Prints the command for a time or an accuracy; ends the tool when there is none. */
void cost_show_command(const struct cost_case *c, FILE *out);
void cost_show_table(const struct cost_case *c, FILE *out);
void cost_warn(const struct cost_case *c);
void cost_report(const struct cost_case *c, struct report *out);
/* A plot of error against time as a PNG, SVG or PDF (`ending`: "png", ...) in memory, which the caller
 * frees. */
unsigned char *cost_plot(const struct cost_case *c, const char *ending, size_t *bytes,
                         struct rc_err *err);
/* The same for any graph. */
struct graph;
unsigned char *cost_picture(struct tool *tool, const char *title, const struct graph *graph,
                            const char *ending, size_t *bytes, struct rc_err *err);

#endif
