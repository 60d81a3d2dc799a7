/*
 * What every rc-* tool shares: options, streams in and out, messages, signals, exit.
 * A main reads: start, read, do, write, finish; only *do* differs.
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
 * Whatever goes wrong on the way is said by tool_die, which does not return.
 */
#ifndef RC_TOOL_H
#define RC_TOOL_H

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "formats/rcg/rcg.h"
#include "libcontact/grid.h"
#include "tools/text/text.h"

enum {
    EXIT_IMPOSSIBLE = 1, /* bad data, I/O, impossible request             */
    EXIT_USAGE = 2,      /* the command line is wrong                     */
    EXIT_SHORT = 3,      /* stopped short of the asked accuracy           */
};

/* ---- options: a const table, one row each ---- */

enum opt_type {
    OPT_FLAG,    /* bool                                                                    */
    OPT_NUMBER,  /* double; NAN before means "not given"                                    */
    OPT_COUNT,   /* size_t                                                                  */
    OPT_TEXT,    /* const char *                                                            */
    OPT_REPORT,  /* const char *: a file for report_open, or - for standard output, where then only
                    the report is written                                                   */
    OPT_CHOICE,  /* const char *, one of the words that .words gives, or else of those in
                    .arg, which are separated by '|'                                        */
    OPT_WORDS,   /* size_t: bit k is set when the list holds word k of .words               */
    OPT_NUMBERS, /* struct numbers; none (n = 0) for .word, if there is one                 */
    OPT_STEP,    /* appended to a struct steps: options whose order on the line matters; with
                    .arg it takes a whole number or, with a unit or .real, a number, or one of the
                    words that '|' separates in it, whose place is the value                       */
    OPT_TEXTS,   /* appended too, in the same order; the argument stays a text              */
};

struct opt {
    const char *name;  /* without the two hyphens                                           */
    const char *alias; /* another name of it, or NULL                                       */
    enum opt_type type;
    enum unit unit;
    size_t at;       /* offsetof the value in the tool's args                              */
    double min, max; /* bounds of each number, kept when min < max                         */
    bool above;      /* min itself is out of bounds                                        */
    bool real;       /* OPT_STEP without a unit: not whole numbers only                  */
    bool result;     /* changes what is computed: goes into history                        */
    bool text;       /* given, the tool writes text, whatever it writes otherwise          */
    bool optional;   /* the argument may be left out: of OPT_NUMBER for the default, of
                        OPT_CHOICE for the value ""                                    */
    const char *(*words)(size_t k); /* word k; NULL past the last: see words.h; of OPT_TEXT those
                                       that a shell offers, any other may be given      */
    const char *word;               /* instead of OPT_NUMBERS; of OPT_NUMBER: for INFINITY  */
    bool whole;       /* OPT_NUMBERS: whole numbers, whose commas are no decimal marks */
    bool per_metre;   /* OPT_NUMBERS of forces that may be in N/m             */
    const char *arg;  /* how help names the argument: "FORCE"; NULL: takes none             */
    const char *help; /* one line; %s in it stands for the words                            */
    const void *of;   /* what else the tool keeps of it                                     */
    /* A row without a name: the rows of this table, whose .at are relative to that of the row. */
    const struct opt *group;
};

enum {
    TOOL_OPTIONS = 64, /* rows that a tool may have of its own */
    TOOL_STEPS = 64    /* options whose order matters, on one line */
};

struct steps {
    struct step {
        const struct opt *opt;
        double value;
        const char *text; /* of OPT_TEXTS; goes into history as it is when it is asked for */
    } step[TOOL_STEPS];
    size_t n;
};

/* ---- what a tool is ---- */

enum tool_reads {
    READS_NOTHING,
    READS_STREAM, /* RCG1 on standard input or in the files named                          */
    READS_FILES,  /* files of its own choosing: operands are left in tool.operand          */
};

enum tool_writes {
    WRITES_STREAM, /* RCG1; never to a terminal                                            */
    WRITES_BYTES,  /* tool.out, binary; never to a terminal                                */
    WRITES_TEXT,   /* tool.out                                                             */
};

struct tool;

struct tool_info {
    const char *name;
    const char *summary;    /* "contact of a height map with an elastic half-space"          */
    const char *operands;   /* "[FILE...]", as help shows them                               */
    const char *examples;   /* whole lines for the end of --help                             */
    const struct opt *opts; /* ended by a row without a name and group                     */
    enum tool_reads reads;
    enum tool_writes writes;
    /* NULL, or gives advice on an input that is no grid stream and begins with `head`; where it
     * gives NULL, the advice is that of every tool. */
    const char *(*foreign)(const char *head);
    /* NULL, or called between the options and the output: may change tool->writes. */
    void (*settle)(struct tool *tool);
    /* NULL, or what the tool does to a frame that tool_channel passes on. */
    void (*passing)(struct tool *tool, struct rc_grid *grid);
    bool shares; /* under mpirun its processes share the maps */
};

struct tool {
    const struct tool_info *info;
    void *args;
    /* the options of every tool */
    size_t threads;     /* at least 1                                                          */
    size_t memory;      /* bytes; 0: no limit                                                  */
    size_t beside;      /* bytes of code and stacks, which the allocator does not count */
    size_t budget;      /* bytes that the allocator may give                                      */
    const char *bound;  /* what bounds it, as in "--memory allows"                          */
    const char *remedy; /* for the message when memory is short; NULL: a smaller map        */
    double budget_at;   /* s: when the machine was last asked                               */
    size_t beside_memory; /* bytes: the most of tool_memory_beside                       */
    const char *vickers;  /* a hardness that was given so, as it was written; or NULL    */
    bool quiet, verbose;
    const char *progress;    /* NULL: where a person watches; "", line, json: always            */
    bool debug;              /* verbose too, and tells of memory */
    enum tool_writes writes; /* info->writes, or text where an option asks for it          */
    const char *out_name;    /* NULL: standard output                                         */
    struct ranks *ranks;     /* the processes that share the maps; NULL: alone. See ranks.h    */
    const struct rc_share *in_share, *out_share; /* then: this one's part in the files          */
    /* streams */
    char **operand;
    size_t operands, next_operand;
    const char *source; /* name of what is being read, for messages                        */
    FILE *in, *out;
    struct rc_reader *reader;
    struct rc_writer *writer;
    bool missing, infinite;  /* NaN, infinity came in or is made on purpose: it may go out */
    size_t last_case, frame; /* frame: place in the current source, from 1                 */
    struct rc_grid *ahead;   /* the next frame, its values not yet read; NULL: nobody looked */
    struct {                 /* the case that tool_channel is in; number 0: none yet       */
        size_t number, found;
        const char *source; /* where it began                                             */
        char names[512];    /* its channels, for the message that one is missing          */
    } current;
    struct { /* of the case that results_demand_none is in; number 0: none yet        */
        size_t number;
        bool height;
        char names[256]; /* channels of its results                                       */
    } results;
    bool report_alone;    /* standard output is for --report, and there is no other output */
    bool stream_expected; /* by whoever reads standard output, as far as the command line says */
    bool type_given, began, ended, warned_short; /* began, ended: the stream written    */
    bool progress_shown; /* a line stands on the terminal                                  */
    double progress_at;  /* s: when it was written                                         */
    enum rc_type type;
    struct opt opt[TOOL_OPTIONS]; /* the tool's own, groups written out                     */
    size_t opts;
    bool given[TOOL_OPTIONS];       /* by row of opt                                              */
    const char *list[TOOL_OPTIONS]; /* OPT_NUMBERS as it stands on the line, for a warning  */
    int exit_status;
};

/* Reads the command line into args (a struct that the table's offsets point into, holding the
 * defaults), answers --help and --version, opens the output. Does not return when any of that
 * fails. */
void tool_start(struct tool *tool, const struct tool_info *info, int argc, char **argv, void *args);
/* Whether an option of the tool's own table was given. */
bool tool_given(const struct tool *tool, const char *name);
/* This tool's line in a stream's history: name, version, the options that change the result, in SI.
 * Valid until the next call. */
const char *tool_history(struct tool *tool);
/* The same options as separate words, for another command; at most `most`. Valid until the next call. */
size_t tool_result_words(struct tool *tool, const char *word[], size_t most);

/* The next frame of all inputs, cases numbered on; NULL at their end. The caller frees it. */
struct rc_grid *tool_read(struct tool *tool);
/* The next frame of this channel, one in each case; the case's other frames are written as they are, but
 * for what info->passing does, (`pass`) or dropped. A case that has none of it, or several, ends the tool;
 * with `pass` so does one that holds results beside a height, see results.h. NULL at the end. */
struct rc_grid *tool_channel(struct tool *tool, const char *channel, bool pass);
/* The frame of this channel in the next case. Of its other frames, wherever they stand in the case, `take`
 * keeps some and returns true; the others are left out. `kept` is the frame of the channel, NULL as long as
 * it has not come. The head of the frame after the case is read too, but not its values. */
typedef bool tool_take(void *ctx, struct tool *tool, const struct rc_grid *kept, struct rc_grid *g);
struct rc_grid *tool_channel_with(struct tool *tool, const char *channel, tool_take *take,
                                  void *ctx);
/* The same, and beside it the frame of one other channel, which lies on its grid; *other is NULL where
 * there is none. */
struct rc_grid *tool_channel_beside(struct tool *tool, const char *channel, const char *beside,
                                    struct rc_grid **other);
/* For `take`: the frame as *kept; ends the tool where the case has two of them. */
void tool_keep_frame(struct tool *tool, struct rc_grid *g, struct rc_grid **kept);
/* Ends the tool where a frame has not the grid of another. */
void tool_demand_grid_of(struct tool *tool, const struct rc_grid *g, const struct rc_grid *of);
/* Ends the tool where dx and dy of a frame are no lengths (key `dunit`); tool_channel and those with it
 * do so for what they give. */
void tool_demand_lengths(struct tool *tool, const struct rc_grid *grid);
/* First of the rows of a map that this process holds: 0 when it holds all. */
size_t tool_first_row(const struct tool *tool, const struct rc_grid *grid);
/* Writes a frame, in --type when that was given; not when only the report goes to standard
 * output. */
void tool_write(struct tool *tool, struct rc_grid *grid);
/* Ends the stream, closes, puts the file in place; the exit status of main. */
int tool_finish(struct tool *tool);
/* Exit with status at the end, unless something worse comes. */
void tool_fails_with(struct tool *tool, int status);

/* Prints "rc-solve: message" on standard error, writes RCGFAIL into a stream that has begun and
 * into a pipe that waits for one, and removes half-written files. */
_Noreturn void tool_die(struct tool *tool, int status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* The same, naming source, case and channel of the frame that is to blame. */
_Noreturn void tool_die_at(struct tool *tool, const struct rc_grid *grid, int status,
                           const char *format, ...) __attribute__((format(printf, 4, 5)));
/* Says what could not be done and goes on, to the next file: with --quiet too; exit status 1 at the end. */
void tool_fail(struct tool *tool, const char *format, ...) __attribute__((format(printf, 2, 3)));
void tool_warn(struct tool *tool, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Only with --verbose. */
void tool_note(struct tool *tool, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* One line that replaces the last one, at most ten times a second, only where it is wanted; `done`: the share of the
 * case that is done, NAN: unknown. Ended by tool_progress_end. */
void tool_progress(struct tool *tool, double done, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void tool_progress_end(struct tool *tool);

/* Ctrl-C and SIGTERM remove what is half-written and end the tool; after this call the first one only
 * sets what tool_interrupted gives (the signal's number), and tool_finish ends by it. Processes that
 * share maps ask together. */
void tool_catch_signals(void);
/* The first one ends the tool again, one that has come already at once, until that is called once more: for
 * long work before there is anything to write. Not where processes share maps. */
void tool_release_signals(void);
int tool_interrupted(void);
/* The same of this process alone, where the handler sets it. */
const volatile sig_atomic_t *tool_signal(void);

/* "bench.x3p, case 2, frame 1 (height)": where a frame stands, for messages. */
const char *tool_where(const struct tool *tool, const struct rc_grid *grid, char *text,
                       size_t size);

/* Ends the tool when a value is NaN or infinite, with their count and the first one's place;
 * `remedy` says what to do about them. */
void tool_demand_finite(struct tool *tool, const struct rc_grid *grid, const char *remedy);
/* Ends the tool when the file that an option names (NULL: none) cannot be written: said before the
 * work, not after it. */
void tool_demand_writable(struct tool *tool, const char *option, const char *name);
/* The budget of the allocator: what --memory allows, or what the machine has, if that is less. */
void tool_budget(struct tool *tool);
/* Where the budget refused memory, makes the message "out of memory ..." say how much is needed, what
 * bounds it and what to do; g: NULL, or the map. */
void tool_add_refusal(const struct tool *tool, const struct rc_grid *g, char *text, size_t size);
/* Whether so many bytes more are within the budget; RC_FAIL when they are not, and *err says what needs
 * them (shape NULL: the work), what bounds them, and tool->remedy. */
enum rc_status tool_ask_memory(const struct tool *tool, const struct rc_shape *shape, size_t bytes,
                               struct rc_err *err);
/* Before long work that will allocate so many bytes: ends the tool when they exceed the budget. */
void tool_demand_memory(struct tool *tool, const struct rc_grid *grid, size_t bytes);
/* A tool->remedy: the first engine that is not slow and whose `bytes` fit; NULL: there is none. Valid until
 * the next call. */
const char *tool_leaner_engine(const struct tool *tool, bool periodic,
                               size_t (*bytes)(const void *ctx, const char *engine),
                               const void *ctx);
/* Bytes that may still be allocated. */
size_t tool_memory_left(const struct tool *tool);
/* What the tool will hold once it has allocated `bytes` more, with its code. */
size_t tool_memory_with(size_t bytes);
/* The most that was allocated so far, with the code. */
size_t tool_counted_memory(struct tool *tool);

/* Seconds on a clock that only goes forwards. */
double tool_now(void);
/* A process that this one started, and that has ended, held at most so many bytes of its own. */
void tool_memory_beside(struct tool *tool, size_t bytes);
/* Bytes that this process has held at most so far. */
size_t tool_peak_memory(void);

#endif
