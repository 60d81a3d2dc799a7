/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Workbooks made by this test: blocks of numbers in sheets are profiles and maps; formulas without a value
 * are refused. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/formats/made/made.h"

extern const struct rc_format rc_format_xlsx;

static const char workbook[] =
    "<workbook xmlns:r=\"http://r\"><sheets><sheet name=\"First\" sheetId=\"1\" r:id=\"rId7\"/>"
    "<sheet name=\"Map\" sheetId=\"2\" r:id=\"rId1\"/></sheets></workbook>";
static const char relations[] = "<Relationships><Relationship Id=\"rId7\" "
                                "Target=\"worksheets/a.xml\"/><Relationship Id=\"rId1\" "
                                "Target=\"/xl/worksheets/b.xml\"/></Relationships>";
static const char strings[] =
    "<sst><si><t>x</t></si><si><r><t>he</t></r><r><t>ight (nm)</t></r></si>"
    "<si><t>\xc2\xb5m</t></si></sst>";

/* A profile with titles, one of them with its unit in a separate row; a formula with a value. */
static const char profile_sheet[] =
    "<worksheet><sheetData>"
    "<row r=\"1\"><c r=\"B1\" t=\"s\"><v>0</v></c></row>"
    "<row r=\"2\"><c r=\"B2\" t=\"s\"><v>2</v></c><c r=\"C2\" t=\"s\"><v>1</v></c></row>"
    "<row r=\"3\"><c r=\"B3\"><v>0</v></c><c r=\"C3\"><v>10</v></c></row>"
    "<row r=\"4\"><c r=\"B4\"><v>1.5</v></c><c r=\"C4\"><f>A1*2</f><v>-2E1</v></c></row>"
    "<row r=\"5\"><c r=\"B5\"><v>3</v></c><c r=\"C5\" t=\"e\"><v>#N/A</v></c></row>"
    "<row r=\"6\"><c><v>7</v></c><c r=\"B6\"><v>4.5</v></c><c r=\"C6\"><v>40</v></c></row>"
    "</sheetData></worksheet>";
/* A matrix with an empty corner; the text beside it does not belong to it. */
static const char map_sheet[] =
    "<worksheet><sheetData>"
    "<row><c t=\"inlineStr\"><is><t>a map</t></is></c></row>"
    "<row r=\"3\"><c r=\"AA3\"><v>1</v></c><c><v>2</v></c><c><v>3</v></c><c><v>4</v></c></row>"
    "<row><c r=\"AA4\"><v>5</v></c><c><v>6</v></c><c><v>7</v></c><c><v>8</v></c></row>"
    "<row><c r=\"AA5\"><v>9</v></c><c><v>10</v></c><c><v>11</v></c><c r=\"AF5\" "
    "t=\"str\"><v>end</v>"
    "</c></row></sheetData></worksheet>";

static const char none[] = "<worksheet><sheetData/></worksheet>";

static struct bytes
book(const char *a, const char *b)
{
    const struct member members[] = {
        {"xl/workbook.xml", workbook, strlen(workbook)},
        {"xl/_rels/workbook.xml.rels", relations, strlen(relations)},
        {"xl/sharedStrings.xml", strings, strlen(strings)},
        {"xl/worksheets/a.xml", a, strlen(a)},
        {"xl/worksheets/b.xml", b, strlen(b)},
    };

    return archive(members, 5);
}

static void
blocks_are_read(void **state)
{
    static const double profile[] = {10e-9, -20e-9, NAN, 40e-9};
    static const double map[] = {1e-9, 2e-9, 3e-9, 4e-9,  5e-9,  6e-9,
                                 7e-9, 8e-9, 9e-9, 10e-9, 11e-9, NAN};
    struct rc_wish wish = {.dx = 2e-6, .dy = 3e-6, .z_unit = 1e-9};
    struct bytes b = book(profile_sheet, map_sheet);
    struct rc_file file = file_of(&b, "noname");
    struct rc_channel channel[4];
    struct rc_err err;
    struct rc_grid *g;

    (void)state;
    assert_ptr_equal(rc_format_find(&file, NULL), &rc_format_xlsx);
    assert_int_equal(list_maps(&rc_format_xlsx, &file, &rc_no_wish, channel, 4, NULL), 2);
    assert_string_equal(channel[0].name, "Map AA3:AD5"); /* the larger one */
    assert_string_equal(channel[1].name, "First B3:C6");
    g = read_well(&rc_format_xlsx, &b, 1);
    check_map(g, 4, 1, 1.5e-6, 1.5e-6, profile);
    assert_string_equal(rc_grid_get(g, "file.channel"), "First B3:C6");
    rc_grid_free(g);
    g = try_read(&rc_format_xlsx, &b, &wish, 0, &err);
    assert_non_null(g);
    check_map(g, 4, 3, 2e-6, 3e-6, map);
    rc_grid_free(g);
    refuse(&rc_format_xlsx, &b, "--dx LENGTH");
    assert_null(try_read(&rc_format_xlsx, &b, &wish, 2, &err));
    assert_non_null(strstr(err.text, "there is no channel 3: the file has 2"));
    drop(&b);
}

/* A profile of SurfTest: its positions have the unit of the cut-off, its heights that of the first roughness.
 * It has no titles, and shorter columns are beside it. */
static void
surftest(void **state)
{
    static const char certificate[] =
        "<worksheet><sheetData><row r=\"48\"><c r=\"D48\" t=\"str\"><v>Cut-Off</v></c>"
        "<c r=\"E48\" t=\"str\"><v>0.08mm</v></c></row></sheetData></worksheet>";
    static const char data[] =
        "<worksheet><sheetData>"
        "<row r=\"1\"><c r=\"A1\" t=\"str\"><v>Ra     0.018  \xc2\xb5m      </v></c>"
        "<c r=\"D1\"><v>99</v></c><c r=\"E1\"><v>0.0005</v></c><c r=\"F1\"><v>3</v></c></row>"
        "<row r=\"2\"><c r=\"D2\"><v>98</v></c><c r=\"E2\"><v>0.001</v></c><c "
        "r=\"F2\"><v>-1</v></c></row>"
        "<row r=\"3\"><c r=\"E3\"><v>0.0015</v></c><c r=\"F3\"><v>2</v></c></row>"
        "<row r=\"4\"><c r=\"E4\"><v>0.002</v></c><c r=\"F4\"><v>4</v></c></row>"
        "<row r=\"5\"><c r=\"E5\"><v>0.0025</v></c><c r=\"F5\"><v>5</v></c></row>"
        "</sheetData></worksheet>";
    static const double wanted[] = {3e-6, -1e-6, 2e-6, 4e-6, 5e-6};
    struct bytes b = book(certificate, data);
    struct rc_grid *g = read_well(&rc_format_xlsx, &b, 0);

    (void)state;
    assert_int_equal(g->nx, 5);
    assert_true(fabs(g->dx - 0.5e-6) <= rounding * 2.5e-6);
    for (size_t k = 0; k < 5; k++)
        assert_true(fabs(g->v[k] - wanted[k]) <= last_digit * fabs(wanted[k]));
    assert_string_equal(rc_grid_get(g, "file.channel"), "Map E1:F5");
    rc_grid_free(g);
    drop(&b);
}

/* Numbers above a map, in its columns but separated by an empty row or beside a text, do not belong to it. */
static void
numbers_above(void **state)
{
    static const char *const tops[] = {
        "<row r=\"1\"><c r=\"AA1\" t=\"str\"><v>Date</v></c><c r=\"AB1\"><v>43831</v></c></row>",
        "<row r=\"2\"><c r=\"AA2\" t=\"str\"><v>Date</v></c><c r=\"AB2\"><v>43831</v></c></row>",
    };
    struct rc_channel channel;

    (void)state;
    for (size_t k = 0; k < 2; k++) {
        char *sheet =
            with(map_sheet, "<row><c t=\"inlineStr\"><is><t>a map</t></is></c></row>", tops[k]);
        struct bytes b = book(none, sheet);
        struct rc_file file = file_of(&b, "a.xlsx");

        assert_int_equal(list_maps(&rc_format_xlsx, &file, &rc_no_wish, &channel, 1, NULL), 1);
        assert_string_equal(channel.name, "Map AA3:AD5");
        assert_int_equal(channel.ny, 3);
        drop(&b);
        free(sheet);
    }
}

static void
refusals(void **state)
{
    static const struct {
        const char *from, *to, *why;
    } cases[] = {
        {"<v>-2E1</v>", "", "a formula in sheet 'First', row 4, column 3, has no value"},
        {"<v>-2E1</v>", "<v></v>", "has no value"},
        {"<v>1.5</v>", "<v>wide</v>", "'wide' in sheet 'First', row 4, column 2, is not a number"},
        {"t=\"s\"><v>1</v>", "t=\"s\"><v>9</v>",
         "a cell refers to shared text 9, but there are only 3"},
        {"r=\"B3\"", "r=\"C3\"", "out of order"},
        {"r=\"B3\"", "r=\"XFE3\"", "'XFE3' is not a cell"},
        {"r=\"B3\"", "r=\"B0\"", "'B0' is not a cell"},
        {"<row r=\"1\"><c r=\"B1\" t", "<row r=\"0\"><c t", "has a cell in row 0"},
        {"<v>1.5</v>", "<v>1</v>", "the positions are not evenly spaced"},
        {"</worksheet>", "", "not well-formed"},
    };
    struct bytes b;

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char *sheet = with(profile_sheet, cases[k].from, cases[k].to);

        b = book(sheet, none);
        refuse(&rc_format_xlsx, &b, cases[k].why);
        drop(&b);
        free(sheet);
    }
    b = book(none, none);
    refuse(&rc_format_xlsx, &b, "has no column of numbers");
    drop(&b);
}

static void
cuts_and_changes(void **state)
{
    struct bytes b = book(profile_sheet, none);

    (void)state;
    refuse_cuts(&rc_format_xlsx, &b, b.n, 3);
    survive_changes(&rc_format_xlsx, &b, 2000);
    drop(&b);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_are_read),  cmocka_unit_test(surftest),
        cmocka_unit_test(numbers_above),    cmocka_unit_test(refusals),
        cmocka_unit_test(cuts_and_changes),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
