/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * All rc-* tools share this header: options, input and output streams, messages, signals, exit. Every main
 * does: start, read, *work*, write, finish; only the work differs.
 *
 *     struct args args = {.tol = NAN};
 *     struct tool t;
 *     tool_start(&t, &info, argc, argv, &args);
 *     while ((g = tool_read(&t)) != NULL) {
 *         ...
 *         tool_write(&t, g);
 *         rc_grid_free(g);
 *     }
 *     return tool_finish(&t);
 *
 * Errors end in tool_die, which prints the message and does not return.
 */
#ifndef RC_TOOL_H
#define RC_TOOL_H

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "formats/rcg/rcg.h"
#include "libcontact/grid.h"
#include "libcontact/owned.h"
#include "tools/text/text.h"

enum {
    EXIT_IMPOSSIBLE = 1, /* bad data, I/O, impossible request             */
    EXIT_USAGE = 2,      /* the command line is wrong                     */
    EXIT_SHORT = 3,      /* stopped short of the requested accuracy       */
};

/* ---- options: a const table, one row each ---- */

enum opt_type {
    OPT_FLAG,   /* bool */
    OPT_NUMBER, /* double; NAN before means "not given" */
    OPT_COUNT,  /* size_t */
    OPT_TEXT,   /* const char * */
    OPT_REPORT, /* const char *: a file for report_open, or - for standard output, which then holds
                   only the report */
    OPT_CHOICE, /* const char *, one of the words from .words, or else of those in .arg, separated by
                   '|' */
    OPT_WORDS,  /* size_t: bit k is set if the list contains word k of .words */
    OPT_NUMBERS, /* struct numbers; n = 0 for .word, if the option has such a word */
    /* Appended to a struct steps: options whose order on the line matters. With .arg it takes a whole number
     * or, with a unit or .real, a number. If '|' separates words in .arg it takes one; the value is its
     * index, or -1 if it is optional and omitted. */
    OPT_STEP,
    OPT_TEXTS, /* appended too, in the same order; the argument is kept as text */
};

/* A rule about an option and others, as in {.with = "tilt free", .because = "..."}. It is a clause of
 * one sentence: "--at has no effect without --tilt free, because ...: REMEDY". */
struct opt_rule {
    /* Names of options, each with a word after a blank or without, separated by '|'. LIST as the word of
     * OPT_NUMBERS means several values, and the .arg of an OPT_NUMBER a number instead of .word. */
    const char *with;
    const char *word;    /* only with this word of the option, or one of "x|y"; NULL: always */
    const char *because; /* NULL: the reason is obvious */
    const char *remedy;  /* NULL: obvious, or to leave out one of both */
};
#define RULES(...)                                                                                 \
    (const struct opt_rule[])                                                                      \
    {                                                                                              \
        __VA_ARGS__,                                                                               \
        {                                                                                          \
            .with = NULL                                                                           \
        }                                                                                          \
    }

struct opt {
    const char *name;  /* without the two hyphens                                           */
    const char *alias; /* another name of it, or NULL                                       */
    enum opt_type type;
    enum unit unit;
    size_t at;       /* offsetof the value in the tool's args                              */
    void *base;      /* or in this object; NULL: in the args                               */
    double min, max; /* bounds of each number, checked if min < max                        */
    bool above;      /* min itself is out of bounds                                        */
    bool real;       /* OPT_STEP without a unit: not only whole numbers                    */
    bool result;     /* changes the result: goes into the history and the marks of a checkpoint */
    bool points;     /* its values are points of a history, which have marks of their own  */
    bool text;       /* with this option the tool writes text                              */
    bool optional;   /* the argument may be omitted: OPT_NUMBER then keeps the default,
                        OPT_CHOICE gets "" */
    const char *(*words)(size_t k); /* word k; NULL past the last: see words.h; for OPT_TEXT they
                                       are completions, and other texts are allowed */
    const char *const *list;        /* the same words as a list, which ends with NULL */
    const char *word; /* a word in place of OPT_NUMBERS; for OPT_NUMBER it means INFINITY */
    bool whole;       /* a list of whole numbers, whose commas cannot be decimal marks    */
    bool per_metre;   /* OPT_NUMBERS of forces that may be in N/m             */
    const char *arg;  /* the name of the argument in --help: "FORCE"; NULL: no argument */
    const char *help; /* one line; %s is replaced by the words                */
    const void *of;   /* further data of the tool */
    /* Rules, each a RULES(...): the tool refuses a command line that breaks one, and --help, completions and
     * programs know them. */
    const struct opt_rule *needs;   /* without one of these options this one has no effect */
    const struct opt_rule *against; /* it does not work with any of these                  */
    /* The tool needs exactly one of these, also without the option. */
    const struct opt_rule *one_of;
    /* A row without a name: the rows of this table, whose .at are relative to that of the row, if they have
     * no .base. It may have rules for all of them. */
    const struct opt *group;
    /* A row with a group, or a row of its own: the heading of these rows, or of the following ones, in
     * --help. Rows with the same heading stand together there. Headings of groups count only if the
     * table of the tool has one too. In struct tool every row has its heading. */
    const char *title;
};

enum {
    TOOL_OPTIONS = 64, /* most rows of a tool */
    TOOL_STEPS = 64,   /* most options whose order matters on one line */
    WARNING_KINDS = 24,
    WARNING_TEXT = 160
};

struct steps {
    struct step {
        const struct opt *opt;
        double value;
        const char *text;  /* argument of OPT_TEXTS; the history gets its present text */
        const char *typed; /* this argument on the command line */
    } step[TOOL_STEPS];
    size_t n;
};

/* ---- the declaration of a tool ---- */

enum tool_reads {
    READS_NOTHING,
    READS_STREAM, /* RCG1 on standard input or in the named files */
    READS_FILES,  /* other files: operands are left in tool.operand */
};

enum tool_writes {
    WRITES_STREAM, /* RCG1; never to a terminal                                            */
    WRITES_BYTES,  /* tool.output.file, binary; never to a terminal                        */
    WRITES_TEXT,   /* tool.output.file                                                     */
};

struct tool;

/* Words after --help beside the headings of a tool. */
struct help_topic {
    /* separated by blanks, the name of the page contact-WORD(7) first; NULL: the end */
    const char *words;
    const char *options; /* their names, separated by blanks */
};

struct tool_info {
    const char *name;
    const char *summary;    /* "contact of a height map with an elastic half-space"          */
    const char *operands;   /* "[FILE...]", as shown in --help                               */
    const char *examples;   /* whole lines for the end of --help                             */
    const struct opt *opts; /* ended by a row without a name, group and title              */
    enum tool_reads reads;
    enum tool_writes writes;
    /* NULL, or returns advice for an input that is not a grid stream and begins with `head`. If it returns
     * NULL, the common advice is printed. */
    const char *(*foreign)(const char *head);
    /* NULL, or called when the options have been read and before their rules are checked: may set those that
     * the line does not give. materials_fill sets these, up to NULL. */
    void (*fill)(struct tool *tool);
    const char *const *of_materials;
    /* NULL, or called between reading the options and opening the output: may change tool->writes. */
    void (*settle)(struct tool *tool);
    /* NULL, or changes a frame that tool_channel passes on. */
    void (*passing)(struct tool *tool, struct rc_grid *grid);
    /* Names of the library's tables of figures in its reports, up to NULL, and a table of its own
     * figures; NULL: none. */
    const char *const *figures;
    const struct rc_figure *own;
    bool mends;        /* takes keys with values that they cannot have, to correct them */
    bool shares;       /* true: under mpirun its processes share the maps; else they are refused */
    const char *alone; /* advice in this refusal; NULL: none */
    /* NULL, or topics up to one without words */
    const struct help_topic *topics;
};

struct tool {
    const struct tool_info *info;
    void *args;
    /* the options of every tool */
    size_t threads; /* at least 1 */
    bool part;      /* threads are a part of the cores, because other processes of this tool run */
    size_t memory;  /* bytes; 0: no limit */
    bool quiet, verbose;
    bool debug;              /* verbose too, and prints the memory */
    const char *progress;    /* NULL: where a person watches; "", line, json: always            */
    const char *out_name;    /* NULL: standard output                                         */
    const char *materials;   /* what --body1 and --body2 set, for the report; or NULL         */
    const char *vickers;     /* a Vickers number of the line, as it was written; or NULL      */
    enum tool_writes writes; /* info->writes, or text if an option selects it                 */
    char **operand;
    size_t operands;
    struct {
        struct opt row[TOOL_OPTIONS]; /* the tool's own rows, with groups expanded           */
        size_t n;
        bool given[TOOL_OPTIONS];       /* one entry for each row                            */
        const char *text[TOOL_OPTIONS]; /* the value as typed, or of a material; NULL: none  */
    } option;
    struct {               /* memory                                                           */
        size_t beside;     /* bytes of code and stacks, which the allocator does not count */
        size_t budget;     /* bytes that may be allocated                                  */
        const char *bound; /* what limits it, as in "--memory allows"                      */
        char part[96];     /* the same, if processes share the machine                     */
        double at;         /* s: the time when the memory of the machine was last read     */
        size_t children;   /* bytes: the largest of tool_memory_beside, with this process  */
        size_t counted;    /* the same, as counted                                         */
    } room;
    const char *remedy;  /* advice in the message when memory is short; NULL: a smaller map */
    struct ranks *ranks; /* the processes that share the maps (ranks.h); NULL: a single one */
    /* streams */
    struct {
        const char *source;     /* name of the current input, for messages    */
        size_t frame;           /* number in the current source, from 1       */
        bool missing, infinite; /* the input has NaN or infinity, or the tool makes it on purpose:
                                   the output may have it */
        FILE *file;
        struct rc_reader *reader;
        const struct rc_share *share; /* with several processes: this process's part of the file */
        size_t next, last_case;       /* next: operand                                         */
        struct rc_grid *ahead; /* the next frame without its values; NULL: not read yet        */
        bool warned_short;
        bool by_rows;      /* tool_by_rows                                                 */
        enum rc_type type; /* of the last frame                                            */
        size_t row, read;  /* values of its row; values read by rows so far                */
        size_t infinite_count, infinite_first; /* infinite ones among these; first: which node */
    } input;
    struct {
        FILE *file;
        struct rc_writer *writer;
        const struct rc_share *share;
        enum rc_type type;
        bool type_given, began, ended; /* began, ended: state of the stream */
        bool expected; /* a stream is expected on standard output, according to the command line */
        bool report_alone; /* standard output holds only the report                       */
        size_t left, missing, infinite; /* values of the frame that is written by rows: those to
                                           come, and those so far that are not finite */
    } output;
    struct { /* the current case of tool_channel; number 0: none yet                */
        size_t number, found;
        const char *source; /* where it began                                             */
        char names[512];    /* its channels, for the message about a missing one          */
    } current;
    struct { /* the current case of results_demand_none; number 0: none yet               */
        size_t number;
        bool height;
        char names[256]; /* channels of its results                                       */
    } results;
    struct {
        bool shown; /* a line of progress is on the terminal  */
        double at;  /* s: the time when it was written        */
    } line;
    struct { /* warnings of the same kind about several inputs */
        struct repeat {
            const char *format;        /* of the warning                                       */
            char text[WARNING_TEXT];   /* without the name of the input; "": the format is enough */
            char first[WARNING_TEXT];  /* the first one, for the last message                  */
            const char *source, *last; /* the first input, and the last one with it            */
            size_t others;             /* inputs besides the first                             */
        } kind[WARNING_KINDS];
        size_t n;
    } repeats;
    struct { /* warnings of the first case, see tool_warn_first */
        const char *what[WARNING_KINDS];
        size_t others[WARNING_KINDS], n;
    } firsts;
    int exit_status;
    struct rc_err err; /* of the call that tool_must or tool_made checks */
};

/* Reads the command line into args (the struct of the table's offsets, which holds the defaults), handles
 * --help and --version, and opens the output. Does not return on failure. */
void tool_start(struct tool *tool, const struct tool_info *info, int argc, char **argv, void *args);
/* Where the value of an option of the tool is. */
static inline void *
tool_value(const struct tool *tool, const struct opt *o)
{
    return (char *)(o->base != NULL ? o->base : tool->args) + o->at;
}
/* True if an option of the tool's own table was given. */
bool tool_given(const struct tool *tool, const char *name);
/* Sets an option of the tool as if the line had it. */
void tool_set_option(struct tool *tool, const char *name, const char *text);
/* This tool's line for the history of a stream: name, version, the options that change the result, in SI.
 * Valid until the next call. */
const char *tool_history(struct tool *tool);
/* The value of the option of row k as in that line, "yes" for a flag; "" if it was not given or does
 * not change the result. Valid until the next call. */
const char *tool_result_value(struct tool *tool, size_t k);
/* The same options as separate words for another command; at most `most` words. Valid until the next call. */
size_t tool_result_words(struct tool *tool, const char *word[], size_t most);

/* The next frame of all inputs, with continued case numbers; NULL at the end. The caller frees it. */
struct rc_grid *tool_read(struct tool *tool);
/* Before the first frame is read: from now on the values of frames are not in memory (tool_has_values), and
 * tool_write copies those of the last frame that was read. Not for processes that share maps. */
void tool_by_rows(struct tool *tool);
static inline bool
tool_has_values(const struct rc_grid *g)
{
    return g->elsewhere < g->ny;
}
/* Reads the values of the last frame that was read, all of them, to the memory of the frame; if it has them,
 * nothing. */
void tool_load(struct tool *tool, struct rc_grid *grid);
/* Reads its next n rows to v; the rows that are left are read, and checked, before the next frame. */
void tool_read_rows(struct tool *tool, size_t n, double *v);
void tool_skip_rows(struct tool *tool, size_t n);
/* The next row is the first one of the frame again; the input must be a file (tool_reads_file). */
void tool_read_again(struct tool *tool);
bool tool_reads_file(const struct tool *tool);
size_t tool_rows_left(const struct tool *tool);
/* tool_write in parts: the header of a frame, then its rows in any number of pieces. */
void tool_write_head(struct tool *tool, struct rc_grid *grid);
void tool_write_rows(struct tool *tool, const struct rc_grid *grid, size_t n, const double *v);
/* Rows of nx nodes that are read or written together. */
size_t tool_rows_together(size_t nx);
/* The next frame of this channel, one in each case. With `pass` the other frames of the case are written,
 * changed only by info->passing; otherwise they are dropped. A case with no such frame, or with several, ends
 * the tool. With `pass`, a case with both heights and results ends the tool too, see results.h. Returns NULL
 * at the end. */
struct rc_grid *tool_channel(struct tool *tool, const char *channel, bool pass);
/* The frame of this channel in the next case. `take` is called for the other frames, before and after it; it
 * keeps a frame and returns true, other frames are dropped. `kept` is the frame of the channel, NULL before
 * it was read. The header of the frame after the case is read too, but not its values. */
typedef bool tool_take(void *ctx, struct tool *tool, const struct rc_grid *kept, struct rc_grid *g);
struct rc_grid *tool_channel_with(struct tool *tool, const char *channel, tool_take *take,
                                  void *ctx);
/* A `take` that keeps the frames of a list; ctx: the list, which ends with a row without a channel. */
struct tool_frame {
    const char *channel;
    struct rc_grid **frame; /* where the frame is kept; NULL before */
};
bool tool_take_frames(void *ctx, struct tool *tool, const struct rc_grid *kept, struct rc_grid *g);
/* Frees the kept frames. */
void tool_free_frames(const struct tool_frame *list);
/* Refuses frames of friction in the case of g, by which some nodes stick. `instead` says what to give. */
void tool_demand_full_sliding(struct tool *t, const struct rc_grid *g, const char *instead);
/* The same with the frame of one other channel on its grid; *other is NULL if there is none. */
struct rc_grid *tool_channel_beside(struct tool *tool, const char *channel, const char *beside,
                                    struct rc_grid **other);
/* The first frame of the file (- is standard input) that --OPTION names, or the first one with this channel.
 * Ends the tool if there is none. The caller frees the frame. */
struct rc_grid *tool_frame_of_file(struct tool *tool, const char *option, const char *name,
                                   const char *channel);
/* For `take`: stores the frame in *kept; ends the tool if the case has two of them. */
void tool_keep_frame(struct tool *tool, struct rc_grid *g, struct rc_grid **kept);
/* Ends the tool if two frames have different grids. */
void tool_demand_grid_of(struct tool *tool, const struct rc_grid *g, const struct rc_grid *of);
/* Ends the tool if dx and dy of a frame are not lengths (key `dunit`). tool_channel and the similar functions
 * check this for the frames that they return. */
void tool_demand_lengths(struct tool *tool, const struct rc_grid *grid);
/* The first row of a map on this process: 0 for a single process. */
size_t tool_first_row(const struct tool *tool, const struct rc_grid *grid);
/* Writes a frame, in the type of --type if given; does nothing if standard output holds only the report. */
void tool_write(struct tool *tool, struct rc_grid *grid);
/* Ends the stream, closes the file and gives it its final name; returns the exit status of main. */
int tool_finish(struct tool *tool);
/* Sets the exit status at the end, unless a higher one follows. */
void tool_fails_with(struct tool *tool, int status);

/* Prints "rc-solve: message" on standard error, and removes half-written files. It writes RCGFAIL into a
 * stream that has begun and into a pipe that waits for one. With a faulty frame the message names its source,
 * case and channel. */
_Noreturn void tool_die_at(struct tool *tool, const struct rc_grid *grid, int status,
                           const char *format, ...) __attribute__((format(printf, 4, 5)));
/* The same for impossible requests, for the command line, and for a faulty frame. */
#define tool_die(tool, ...) tool_die_at(tool, NULL, EXIT_IMPOSSIBLE, __VA_ARGS__)
#define tool_usage(tool, ...) tool_die_at(tool, NULL, EXIT_USAGE, __VA_ARGS__)
#define tool_refuse(tool, grid, ...) tool_die_at(tool, grid, EXIT_IMPOSSIBLE, __VA_ARGS__)
/* Ends the tool with the message of a failure, tool->err, at a frame or, with NULL, without a place. */
void tool_must(struct tool *tool, const struct rc_grid *grid, enum rc_status status);
/* Returns what a maker returned; ends the tool with tool->err if that is NULL. */
void *tool_made(struct tool *tool, const struct rc_grid *grid, void *made)
    __attribute__((returns_nonnull));
/* A frame with the keys of another one, and its shape if `shape` is NULL. */
struct rc_grid *tool_frame_like(struct tool *tool, const struct rc_grid *like,
                                const struct rc_shape *shape, const char *channel, const char *unit)
    __attribute__((returns_nonnull));
/* True if the key has this value. */
bool map_says(const struct rc_grid *g, const char *key, const char *value);
/* These set a key of a frame. NULL, or a number that is not finite, removes it. */
void tool_set(struct tool *tool, struct rc_grid *grid, const char *name, const char *value);
void tool_set_number(struct tool *tool, struct rc_grid *grid, const char *name, double value);
/* An estimated error, rounded up to three digits. */
void tool_set_error(struct tool *tool, struct rc_grid *grid, const char *name, double value);
void tool_set_numbers(struct tool *tool, struct rc_grid *grid, const char *name, const double *v,
                      size_t n);
/* True if the last step of this tool in the history of a frame has this text, as in "--tilt free". */
bool tool_history_has(const struct rc_grid *grid, const char *name, const char *text);
/* Adds this command to the history of a frame. */
void tool_sign(struct tool *tool, struct rc_grid *grid);
/* An array of n elements of this size, all 0, which the caller frees. Ends the tool when memory is short,
 * with the message "out of memory for WHAT". */
void *tool_room(struct tool *tool, size_t n, size_t size, const char *what)
    __attribute__((returns_nonnull));
/* Returns the array `v` of n elements with room for one more. It is the same, or a larger one in its
 * place. */
void *tool_grown(struct tool *tool, void *v, size_t n, size_t *room, size_t size, const char *what)
    __attribute__((returns_nonnull));
char *tool_copy(struct tool *tool, const char *text) __attribute__((returns_nonnull));
/* Prints what could not be done, also with --quiet, and continues with the next file; exit status 1 at the
 * end. */
void tool_fail(struct tool *tool, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* A warning of the same kind about another input is only counted; tool_finish prints the counts.
 * --verbose prints each. */
void tool_warn(struct tool *tool, const char *format, ...) __attribute__((format(printf, 2, 3)));
void tool_count_warnings(struct tool *tool);
/* A warning of a case. Of further cases with the same `what` only the number is printed, at the end:
 * "2 other cases too: WHAT". --verbose prints each. */
void tool_warn_first(struct tool *tool, const char *what, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Prints a note, only with --verbose. */
void tool_note(struct tool *tool, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* A result in one line, for a person: at a terminal, or with --verbose. */
void tool_tell(struct tool *tool, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Prints a line that replaces the last one, at most ten times a second, if progress is shown. `done`: the
 * finished fraction of the case, NAN: unknown. tool_progress_end ends it. */
void tool_progress(struct tool *tool, double done, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void tool_progress_end(struct tool *tool);

/* By default Ctrl-C and SIGTERM remove incomplete files and end the tool. After this call the first signal
 * only sets the result of tool_interrupted (the number of the signal), and tool_finish ends the tool by it.
 * Processes that share maps call tool_interrupted together. */
void tool_catch_signals(void);
/* The first signal ends the tool again, at once if it has already arrived, until tool_catch_signals is called
 * again. Call it before long work, when there is no result yet. Must not be used for processes that share
 * maps. */
void tool_release_signals(void);
int tool_interrupted(void);
/* The same for this process only, at the address that the handler sets. */
const volatile sig_atomic_t *tool_signal(void);

/* The shape of a grid, for an argument; it lives until the end of the block. */
#define rc_shape_of(grid) ((struct rc_shape[]){rc_grid_shape(grid)})
/* "bench.x3p, case 2, frame 1 (height)": the place of a frame, for messages, until the end of the block. */
enum {
    WHERE = 256
};
#define tool_where(tool, grid) tool_where_to(tool, grid, (char[WHERE]){""})
const char *tool_where_to(const struct tool *tool, const struct rc_grid *grid, char text[WHERE]);

/* Ends the tool if a value is NaN or infinite, with their number and the place of the first one; `remedy` is
 * the advice. */
void tool_demand_finite(struct tool *tool, const struct rc_grid *grid, const char *remedy);
/* The same of `count` such values that the caller has found, the first one in node `first`. */
void tool_demand_none(struct tool *tool, const struct rc_grid *grid, size_t count, size_t first,
                      const char *remedy);
/* Ends the tool if a height is infinite; NaN is a point without a measurement. By rows: of the rows read so
 * far. */
void tool_demand_measured(struct tool *tool, const struct rc_grid *grid);
/* Warns of an RMS slope of heights that is implausible, because a unit may be wrong; `remedy` is the advice.
 * True: it has. */
bool tool_judge_slope(struct tool *tool, const char *where, double slope, const char *remedy);
/* Ends the tool before the work if the file of an option (NULL: none) cannot be written. */
void tool_demand_writable(struct tool *tool, const char *option, const char *name);
/* Sets the budget of the allocator: the limit of --memory, or the memory of the machine if it is less. */
void tool_budget(struct tool *tool);
/* If the budget refused memory, extends the message "out of memory ..." by the bytes needed, the limit and
 * the advice; g: NULL, or the map. */
void tool_add_refusal(const struct tool *tool, const struct rc_grid *g, char *text, size_t size);
/* Checks that the budget allows this number of further bytes. Otherwise RC_FAIL, and *err names the purpose
 * (shape NULL: the work), the limit, and tool->remedy. */
enum rc_status tool_ask_memory(const struct tool *tool, const struct rc_shape *shape, size_t bytes,
                               struct rc_err *err);
/* Before long work that will allocate this number of bytes: ends the tool if they exceed the budget. */
void tool_demand_memory(struct tool *tool, const struct rc_grid *grid, size_t bytes);
/* A value for tool->remedy: the first engine that is not slow and whose `bytes` fit; NULL: there is none.
 * Valid until the next call. */
const char *tool_leaner_engine(const struct tool *tool, bool periodic,
                               size_t (*bytes)(const void *ctx, const char *engine),
                               const void *ctx);
/* Bytes that may still be allocated. */
size_t tool_memory_left(const struct tool *tool);
/* The memory of the tool after allocating `bytes` more, with its code. */
size_t tool_memory_with(size_t bytes);
/* The peak of allocated memory so far, with the code; with that of the largest process beside it. */
size_t tool_own_memory(struct tool *tool);
size_t tool_counted_memory(struct tool *tool);

/* Seconds of a monotonic clock. */
double tool_now(void);
/* Processor seconds of all threads of this process so far; other processes do not add to them. */
double tool_worked(void);
/* Reports the peak, in bytes, of a process that this one started and that has ended: the kernel's, and the
 * counted one (0: counted here). */
void tool_memory_beside(struct tool *tool, size_t bytes, size_t counted);

#endif
