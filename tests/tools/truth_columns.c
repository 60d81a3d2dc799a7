/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A table of numbers in columns gives the SI values of its text, whatever its separators, names and
 * units; other tables are refused with the line. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "formats/core/core.h"
#include "tools/text/text.h"

enum {
    TIME,
    STORAGE,
    LOSS,
    STRAIN,
    TAN,
    KINDS
};
static const struct wanted_column wanted[KINDS] = {
    [TIME] = {"time t", UNIT_S, .infinite = true},
    [STORAGE] = {"storage storagemodulus e' e(t)", UNIT_PA, .needs_unit = true},
    [LOSS] = {"loss lossmodulus e''", UNIT_PA, .optional = true},
    [STRAIN] = {"strain", UNIT_NONE, .optional = true},
    [TAN] = {"tandelta tan(delta) tan\316\264", UNIT_NONE, .optional = true, .spare = 1U << LOSS},
};

static enum rc_status
read_text(const char *text, size_t n, bool headed, struct columns *c, struct rc_err *err)
{
    char name[] = "/tmp/columns-XXXXXX";
    const int file = mkstemp(name);
    enum rc_status status;

    assert_true(file >= 0);
    assert_int_equal(write(file, text, n), (ssize_t)n);
    close(file);
    status = columns_read(c, name, wanted, KINDS, headed, err);
    unlink(name);
    return status;
}

/* All give 2 rows: 1 ms and 2 ms, storage 3 MPa and 4.5 MPa, loss 0.5 MPa and 0 or no loss. */
static void
same(void **state)
{
    static const char *const good[] = {
        "1ms 3MPa 0.5MPa\n2ms 4.5MPa 0\n",
        "time storage loss\n1ms 3MPa 0.5MPa\n2ms 4.5MPa 0\n",
        "time/ms storage/MPa loss/MPa\n1 3 0.5\n2 4.5 0\n",
        "time/ms\tstorage/MPa\tloss/MPa\n1\t3\t0.5\n2\t\t4.5\t0\n",
        "time/ms,storage/MPa,loss/MPa\n1,3,0.5\n2,4.5,0\n",
        "time/ms,storage/MPa,loss/MPa,\r\n1,3,0.5,\r\n2,4.5,0,\r\n\r\n",
        "time/ms;storage/MPa;loss/MPa\n1;3;0,5\n2,0;4,5;0\n",
        "time/ms;storage/MPa;loss/MPa\n1;3;0.5\n2.0;4.5;0\n",
        "time/s\tstorage [N/mm\302\262]\tloss/MPa\n0,001\t3,0\t0,5\n0,002\t4,5\t0\n",
        "Time (ms);Storage modulus (MPa);Loss Modulus [MPa]\n1;3;0,5\n2,0;4,5;0\n",
        "Time (ms) Storage modulus (MPa) Loss_Modulus [MPa]\n1 3 0.5\n2 4.5 0\n",
        "time / ms storage / MPa loss / MPa\n1 3 0.5\n2 4.5 0\n",
        "\"t\",\"E'\",\"E''\"\n\"ms\",\"MPa\",\"MPa\"\n\"1\",\"3\",\"0.5\"\n2,4.5,0\n",
        "t,E',E''\n[ms],[MPa],[N/mm2]\n1,3,0.5\n2,4.5,0\n",
        "loss/kPa storage/GPa t/us\n500 3e-3 1000\n0 4.5e-3 2000\n",
        "t/us storage/MPa loss/MPa\n1ms 3000kPa .5\n 2000 4500kPa 0 # a comment\n",
        "# time/ms storage/MPa loss/MPa\n1 3 0.5\n2 4.5 0\n",
        "# measured on a Monday\n\n# time storage loss\n# ms MPa MPa\n1 3 0.5\n2 4.5 0\n",
        "# time and storage\ntime/ms storage/MPa loss/MPa\n#1 2 3\n1 3 0.5\n2 4.5 0\n# time loss\n",
        "# time storage\ntime/ms storage/MPa loss/MPa\n1 3 0.5\n2 4.5 0",
        "\xef\xbb\xbftime/ms storage/MPa loss/MPa\n1 3 0.5\n2 4.5 0\n",
        "time,storage,loss,tan delta\nms,MPa,MPa,-\n1,3,0.5,0.2\n2,4.5,0,undefined\n",
        "time storage tan delta loss\nms MPa 1 MPa\n1 3 0.5 0.5\n2 4.5 - 0\n",
        "t/ms E(t)/MPa tan(delta) loss/(N/mm2)\n1 3 0.5 0.5\n2 4.5 0 0\n",
        "t/ms storage/MPa\n1 3\n2 4.5\n",
        "strain/% t/ms storage/MPa\n100 1 3\n200 2 4.5\n",
        /* a name and its symbol; Latin-1; a letter of another alphabet */
        "t (ms);Storage modulus E' (N/mm\302\262);Loss modulus E'' (N/mm\302\262);tan \316\264\n"
        "1;3;0.5;x\n2;4.5;0;x\n",
        "time t/ms storage modulus e' / MPa loss modulus e''/MPa\n1 3 0.5\n2 4.5 0\n",
        "t/ms\tstorage/(N/mm\262)\tloss/(N/mm\262)\n1\t3\t0.5\n2\t4.5\t0\n",
        /* a decimal comma between tabs: of six digits, and by another number of the file */
        "t/us\tstorage/MPa\tloss/MPa\n1000,000000\t3,000\t0,500\n2000,000000\t4,500\t0\n",
        "t/ms\tstorage/MPa\tloss/MPa\n1,000\t3,000\t0,5\n2,000\t4,500\t0\n",
        "t/ms\tstorage/MPa\n1,000\t3,000\n2,000\t4,5\n",
        /* a unit may be blank, in any column and of any separator */
        "time,storage,loss,strain\nms,MPa,MPa,\n1,3,0.5,1\n2,4.5,0,2\n",
        "strain;time;storage;loss\n;ms;MPa;MPa\n1;1;3;0,5\n2;2;4,5;0\n",
        "time\tstrain\tstorage\nms\t\tMPa\n1\t1\t3\n2\t2\t4.5\n",
        "strain\ttime\tstorage\n\tms\tMPa\n1\t1\t3\n2\t2\t4.5\n",
        "time\tstorage\tstrain\nms\tMPa\t\n1\t3\t1\n2\t4.5\t2\n",
        "# time,storage,strain\n# ms,MPa,\n1,3,1\n2,4.5,2\n",
        /* separators between quotes: decimal commas, and blanks of names */
        "time/ms,storage/MPa,loss/MPa\n\"1\",\"3,0\",\"0,5\"\n\"2\", \"4,5\" ,\"0\"\n",
        "\"t/ms\",\"storage/MPa\",\"loss/"
        "MPa\"\n\"1,000\",\"3,000\",\"0,5\"\n\"2,000\",\"4,500\",0\n",
        "\"Time\" \"Storage modulus\"\n\"ms\" \"MPa\"\n\"1\" 3\n2 \"4.5\"\n",
    };
    (void)state;

    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        struct columns c;
        struct rc_err err = {""};

        if (read_text(good[k], strlen(good[k]), false, &c, &err) != RC_OK)
            fail_msg("%s%s", good[k], err.text);
        assert_int_equal(c.n, 2);
        if (c.v[TIME][0] != 1e-3 || c.v[TIME][1] != 2e-3 || c.v[STORAGE][0] != 3e6 ||
            c.v[STORAGE][1] != 4.5e6 ||
            (c.v[LOSS] != NULL && (c.v[LOSS][0] != 0.5e6 || c.v[LOSS][1] != 0)) ||
            (c.v[STRAIN] != NULL && (c.v[STRAIN][0] != 1 || c.v[STRAIN][1] != 2)))
            fail_msg("%s: %g %g, %g %g", good[k], c.v[TIME][0], c.v[TIME][1], c.v[STORAGE][0],
                     c.v[STORAGE][1]);
        assert_true((c.v[LOSS] != NULL) == (strstr(good[k], "0.5") || strstr(good[k], "0,5") ||
                                            strstr(good[k], " .5") || strstr(good[k], "500 3e-3")));
        assert_null(c.v[TAN]); /* beside the loss */
        columns_free(&c);
    }
}

static void
refused(void **state)
{
    static const struct {
        const char *text, *why;
    } bad[] = {
        {"", "no row of numbers"},
        {"# nothing\n\n", "no row of numbers"},
        {"time/s storage/MPa\n", "no row of numbers"},
        {"time/s storage/MPa\n\n1 2 3\n", "line 3: it has 3 values, and the table 2 columns"},
        {"time/s storage/MPa\n1 2\n3\n", "line 3: it has 1 value, and the table 2 columns"},
        {"time,storage\ns,MPa\n1,,2\n", "line 3: it has 3 values"},
        {"time,storage,loss\ns,MPa,MPa\n1,,2\n", "line 3: storage: '' is not a number"},
        {"1s 2MPa\n1s\n", "line 2: it has 1 value"},
        {"1s\n", "line 1: it must hold time, storage[, loss][, strain], and has 1 value"},
        {"1 2 3 4 5\n", "line 1: it must hold"},
        {"1 2 3 4 5 6 7 8 9 10 11 12 13\n", "line 1: it has more than 12 columns"},
        {"time stroage\n1 2\n",
         "line 1: there is no column 'stroage': the columns are time, storage, "
         "loss, strain, tandelta: did you mean storage?"},
        {"time storage temperature\n1 2 3\n",
         "there is no column 'temperature': the columns are time, storage, loss, strain, tandelta: "
         "remove it from the table"},
        {"time storage t\n1 2 3\n", "line 1: there are two columns time"},
        {"time loss\n1 2\n", "line 1: there is no column storage: a table must hold"},
        {"time/m storage/MPa\n1 2\n", "line 1: time: unknown unit 'm'"},
        {"time/s storage/MPq\n1 2\n", "line 1: storage: unknown unit 'MPq'"},
        {"time storage\ns MPq\n1 2\n", "line 2: storage: unknown unit 'MPq'"},
        {"time storage loss\ns MPa\n1 2 3\n",
         "line 2: it has 2 units, and the table 3 columns: write - for no unit"},
        {"time;storage;loss\ns;MPa\n1;2;3\n", "line 2: it has 2 units, and the table 3 columns"},
        {"time;storage\ns;MPa;MPa\n1;2;3\n", "line 2: it has 3 units, and the table 2 columns"},
        {"time;storage\ns;\n1;2\n", "line 3: storage: give its unit"},
        {"time/s,storage/MPa\n\"1,234\",2\n",
         "line 2: time: '1,234': is its comma the decimal mark"},
        {"time/s,storage/MPa\n# \"0,5\"\n1,\"1,234\"\n", "line 3: storage: '1,234': is its comma"},
        {"time/s,storage/MPa\n1,\"1,5\n", "line 2: it has 3 values"},
        {"time/s,storage/MPa\n\"\",\"1,5\"\n", "line 2: time: '' is not a number"},
        {"time/s storage/MPa\ns MPa\n1 2\n", "line 2: time: 's' is not a number"},
        {"# time/s storage/MPq\n1 2\n", "line 1: storage: unknown unit 'MPq'"},
        {"time/s strain/Pa storage/Pa\n1 2 3\n", "line 1: strain: "},
        {"time/s storage\n1 2\n",
         "line 2: storage: give its unit, in the heading as in storage/kPa"},
        {"time/s storage/MPa\n1 2\nnan 3\n", "line 3: time: 'nan' is not a number"},
        {"time/s storage/MPa\n1 2\n2 inf\n", "line 3: storage: 'inf' is not a number"},
        {"time/s storage/MPa\n1 2\n2 1e400\n", "line 3: storage: "},
        {"time/s storage/MPa\n1 2\n2 0x10\n", "line 3: storage: "},
        {"time/s storage/MPa\n1 2\n2 x\n", "line 3: storage: 'x' is not a number"},
        {"time/s storage/MPa\n1 2\n2 3s\n", "line 3: storage: unknown unit 's'"},
        {"time/s\tstorage/MPa\n1,234\t2\n", "line 2: time: '1,234': is its comma the decimal mark"},
        {"time/s\tstorage/MPa\n1\t-12,345,678\n", "line 2: storage: '-12,345,678': is its comma"},
        /* no other number shows that the comma is decimal: a point, a comment, a cell of another separator */
        {"time/s\tstorage/MPa\n0.5\t1,234\n", "line 2: storage: '1,234': is its comma"},
        {"time/s\tstorage/MPa\n1\t1,234 # 0,5\t0,5\n", "line 2: storage: '1,234': is its comma"},
        {"# 0,5\ntime/s\tstorage/MPa\n1\t1,234\n", "line 3: storage: '1,234': is its comma"},
        {"time/s\tstorage/MPa\n0,5\t1,234,567\n", "line 2: storage: '1,234,567': is its comma"},
        {"time/s storage/MPa\n1 2m\262\n", "line 2: storage: unknown unit 'm2'"},
        {"time/s zeit\344/MPa\n1 2\n", "line 1: there is no column 'zeit\303\244'"},
        {"time/s "
         "storage/(\344\344\344\344\344\344\344\344\344\344\344\344\344\344\344\344\344\344\344"
         "\344\344\344\344\344\344)\n1 2\n",
         "\303\244\303\244...' is too long"},
        {"time/s;storage/MPa\n1.000,5;2\n", "line 2: time: "},
        {"time/s;storage/MPa\n1,000,5;2\n", "line 2: time: "},
        {"time/s storage/MPa\n1,5 2,5\n", "line 2: "},
    };
    struct columns c;
    struct rc_err err = {""};
    (void)state;

    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        if (read_text(bad[k].text, strlen(bad[k].text), false, &c, &err) == RC_OK)
            fail_msg("%s: not refused", bad[k].text);
        assert_true(rc_utf8_valid(err.text));
        if (strstr(err.text, bad[k].why) == NULL)
            fail_msg("%s: '%s' instead of '%s'", bad[k].text, err.text, bad[k].why);
        columns_free(&c);
    }
    assert_int_equal(read_text("time\0storage\n1 2\n", 17, false, &c, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "binary"));
    columns_free(&c);
    assert_int_equal(read_text("1s 2MPa\n", 8, true, &c, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "line 1: it must be a heading"));
    columns_free(&c);
    assert_int_equal(columns_read(&c, "/", wanted, KINDS, false, &err), RC_FAIL);
    columns_free(&c);
    assert_int_equal(columns_read(&c, "/none.tsv", wanted, KINDS, false, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "No such file"));
    columns_free(&c);
}

/* A spare column is read if the other one is absent. */
static void
spare(void **state)
{
    const char *text = "t/s storage/MPa tan \316\264\n1 2 0.25\n";
    struct columns c;
    struct rc_err err = {""};
    (void)state;

    assert_int_equal(read_text(text, strlen(text), true, &c, &err), RC_OK);
    assert_true(c.v[LOSS] == NULL && c.v[TAN] != NULL && c.v[TAN][0] == 0.25);
    columns_free(&c);
    text = "t/s storage/MPa tandelta/MPa\n1 2 0.25\n";
    assert_int_equal(read_text(text, strlen(text), true, &c, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "tandelta: "));
    columns_free(&c);
}

static void
infinite(void **state)
{
    struct columns c;
    struct rc_err err = {""};
    (void)state;

    assert_int_equal(read_text("t storage\nInf 1MPa\n", 19, true, &c, &err), RC_OK);
    assert_true(isinf(c.v[TIME][0]) && c.v[STORAGE][0] == 1e6 && c.line[0] == 2);
    columns_free(&c);
}

static void
files(void **state)
{
    static const char *const file[] = {"table",      "a.tsv",  "1.5.csv",
                                       "/dev/fd/63", "./1GPa", "20C.txt"};
    static const char *const number[] = {"1GPa", "1.5GPa,2GPa", "1.GPa", ".5", "-1", "1e9"};
    (void)state;

    for (size_t k = 0; k < sizeof file / sizeof *file; k++)
        assert_true(columns_file(file[k]));
    for (size_t k = 0; k < sizeof number / sizeof *number; k++)
        assert_false(columns_file(number[k]));
}

int
main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(same), cmocka_unit_test(refused),
                                       cmocka_unit_test(infinite), cmocka_unit_test(spare),
                                       cmocka_unit_test(files)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
