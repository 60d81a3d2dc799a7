/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every defect of an X3P file is refused with a message that names it. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/formats/made/made.h"

static void
wrong_headers(void **state)
{
    static const struct {
        const char *from, *to, *why;
    } wrong[] = {
        {"SUR", "PCL", "cloud of points"},
        {"SUR", "", "FeatureType is ''"},
        {"<CX><AxisType>I", "<CX><AxisType>X", "axis CX is of type 'X'"},
        {"<CX><AxisType>I", "<CX><AxisType>A", "promises 96 bytes of heights, the file has 48"},
        {"<CY><AxisType>I", "<CY><AxisType>A", "promises 96 bytes of heights, the file has 48"},
        {"1.1e-6", "0", "spacing in x is 0 m in the file"},
        {"1.1e-6", "-1e-6", "spacing in x is -1e-06 m"},
        {"1.1e-6", "NaN", "'NaN' in main.xml: it must be finite"},
        {"1.1e-6", "inf", "'inf' in main.xml: it must be finite"},
        {"1.1e-6", "1e999", "'1e999' in main.xml: it must be finite"},
        {"1.1e-6", "1,1e-6", "'1,1e-6' in main.xml: that is not a number"},
        {"1.29e-6", "0.0", "spacing in y is 0 m"},
        {"1.29e-6", "", "--dy LENGTH"},
        {"0.25", "0", "increment of CZ is 0"},
        {"0.25", "nan", "must be finite"},
        {"-2<", "1e400<", "must be finite"},
        {"<SizeX>3", "<SizeX>0", "0 x 2 points is empty"},
        {"<SizeX>3", "<SizeX>-3", "must be a whole number"},
        {"<SizeX>3", "<SizeX>3.0", "must be a whole number"},
        {"<SizeX>3", "<SizeX>4", "promises 64 bytes of heights, the file has 48"},
        {"<SizeX>3", "<SizeX>2", "promises 32 bytes of heights, the file has 48"},
        {"<SizeX>3", "<SizeX>99999999999999", "promises 1599999999999984 bytes"},
        {"<SizeX>3</SizeX><SizeY>2", "<SizeX>99999999999999</SizeX><SizeY>99999999999999",
         "more than this machine can address"},
        {"<SizeX>3</SizeX>", "", "gives no SizeX"},
        {"<SizeX>3</SizeX>", "<SizeX>3</SizeX><SizeX>4</SizeX>", "SizeX twice"},
        {"<SizeZ>1", "<SizeZ>2", "SizeZ is 2"},
        {">D</DataType><Increment>0.25", ">X</DataType><Increment>0.25", "DataType of CZ is 'X'"},
        {"bindata/data.bin", "bindata/other.bin", "no member 'bindata/other.bin'"},
        {"bindata/data.bin", "", "main.xml lists 0"},
        {"</p:ISO5436_2>", "", "not well-formed XML"},
        {"<Record2>", "<Record2>&bomb;", "not well-formed XML"},
        {"?>\n", "?>\n<!DOCTYPE a [<!ENTITY b \"x\">]>\n", "document type declaration"},
        {"?>\n", "?>\n<!DOCTYPE a SYSTEM \"file:///etc/passwd\">\n", "document type declaration"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char *xml = binary_xml("D", "");
        alter(&xml, wrong[k].from, wrong[k].to);
        refuse_xml(xml, wrong[k].why);
        free(xml);
    }
}

static void
wrong_lists(void **state)
{
    static const struct {
        const char *list, *why;
    } wrong[] = {
        {"<Datum>1</Datum>", "main.xml lists 1"},
        {"<Datum>1</Datum><Datum/><Datum/><Datum/><Datum/><Datum/><Datum/>", "main.xml lists 7"},
        {"<Datum>1;2;3</Datum>", "Datum 1 is '1;2;3': lists with coordinates"},
        {"<Datum/><Datum>one</Datum>", "Datum 2 is 'one'"},
        {"<Datum>1,5</Datum>", "Datum 1 is '1,5'"},
        {"<Datum>inf</Datum><Datum/><Datum/><Datum/><Datum/><Datum/>", "is infinite"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char *xml = with(main_xml, "@TYPE@", "D"), data[300];
        snprintf(data, sizeof data, "<DataList>%s</DataList>", wrong[k].list);
        alter(&xml, "@DATA@", data);
        refuse_xml(xml, wrong[k].why);
        free(xml);
    }
}

static void
other_archives(void **state)
{
    struct member sheet = {"[Content_Types].xml", "<Types/>", 8};
    struct member page = {"main.xml", "<html><body/></html>", 20};
    struct member empty = {"main.xml", "", 0};
    struct rc_file file = archive_file(&sheet, 1);

    (void)state;
    assert_ptr_equal(rc_format_find(&file, NULL), &rc_format_x3p);
    refuse_file(&file, "no X3P: it has no main.xml (the first of its 1 members is "
                       "'[Content_Types].xml')");
    drop_file(&file);
    file = archive_file(&page, 1);
    refuse_file(&file, "the root of its main.xml is 'html'");
    drop_file(&file);
    file = archive_file(&empty, 1);
    refuse_file(&file, "main.xml is no");
    drop_file(&file);
}

/* Nested entities that expand without limit (billion laughs), as parameter entities and as general ones. */
static void
entity_bomb(void **state)
{
    static const char laughs[] =
        "<?xml version=\"1.0\"?>\n<!DOCTYPE ISO5436_2 [\n<!ENTITY a \"lollollollol\">\n"
        "<!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;\">\n"
        "<!ENTITY c \"&b;&b;&b;&b;&b;&b;&b;&b;&b;&b;\">\n"
        "<!ENTITY d \"&c;&c;&c;&c;&c;&c;&c;&c;&c;&c;\">\n"
        "<!ENTITY e \"&d;&d;&d;&d;&d;&d;&d;&d;&d;&d;\">\n"
        "<!ENTITY f \"&e;&e;&e;&e;&e;&e;&e;&e;&e;&e;\">\n"
        "<!ENTITY g \"&f;&f;&f;&f;&f;&f;&f;&f;&f;&f;\">\n]>\n"
        "<ISO5436_2><Record1>&g;&g;&g;&g;</Record1></ISO5436_2>";

    (void)state;
    refuse_xml(laughs, "document type declaration");
}

static void
zip_bombs(void **state)
{
    size_t n = (size_t)64 << 20;
    unsigned char *zeros = calloc(n, 1);
    char *xml = binary_xml("D", "");
    struct member member[] = {{"main.xml", xml, strlen(xml)}, {"bindata/data.bin", zeros, n}};
    struct rc_file file = archive_file(member, 2);

    (void)state;
    assert_true(file.size < n / 500);
    refuse_file(&file, "promises 48 bytes of heights, the file has 67108864");
    drop_file(&file);
    free(zeros);
    free(xml);
}

/* Sets the little-endian word at `offset` in the directory entry of a member. */
static void
patch(struct rc_file *file, const char *name, size_t offset, uint32_t word)
{
    unsigned char *data = (unsigned char *)(uintptr_t)file->data;
    size_t n = strlen(name);

    for (size_t k = 0; k + 46 + n <= file->size; k++)
        if (memcmp(data + k, "PK\1\2", 4) == 0 && memcmp(data + k + 46, name, n) == 0)
            for (size_t b = 0; b < 4; b++)
                data[k + offset + b] = (unsigned char)(word >> 8 * b);
}

enum {
    PACKED_SIZE = 20, /* offsets in a directory entry of a ZIP archive */
    SIZE = 24
};

static void
lying_sizes(void **state)
{
    char *xml = binary_xml("D", "");
    struct rc_file file = plain_file();

    (void)state;
    patch(&file, "bindata/data.bin", SIZE, 0xfffffff0U);
    refuse_file(&file, "cannot hold");
    patch(&file, "bindata/data.bin", SIZE, 96);
    refuse_file(&file, "promises 48 bytes of heights, the file has 96");
    patch(&file, "bindata/data.bin", SIZE, 48);
    patch(&file, "bindata/data.bin", PACKED_SIZE, 0x7ffffff0U);
    refuse_file(&file, "promises 2147483632 packed bytes");
    drop_file(&file);
    /* the header agrees with the false size: six more heights than the file holds */
    alter(&xml, "<SizeX>3", "<SizeX>6");
    file = pack(xml, plain_bytes, sizeof plain_bytes);
    patch(&file, "bindata/data.bin", SIZE, 96);
    refuse_file(&file, "bindata/data.bin");
    drop_file(&file);
    /* and fewer than the file holds */
    alter(&xml, "<SizeX>6", "<SizeX>2");
    file = pack(xml, plain_bytes, sizeof plain_bytes);
    patch(&file, "bindata/data.bin", SIZE, 32);
    refuse_file(&file, "bindata/data.bin");
    drop_file(&file);
    free(xml);
}

/* Reads the file in every way, in a block of memory of exactly its size. It is refused with a reason or gives
 * the original map, and no byte outside the block is accessed. Returns true if it was read. */
static bool
survives(const unsigned char *data, size_t n)
{
    unsigned char *copy = malloc(n == 0 ? 1 : n);
    struct rc_file file = {.name = "cut.x3p", .data = copy, .size = n};
    struct rc_channel channel;
    struct rc_notes notes;
    struct rc_err err;
    struct rc_grid *g;
    bool read;

    memcpy(copy, data, n);
    rc_format_find(&file, &err);
    list_maps(&rc_format_x3p, &file, &rc_no_wish, &channel, 1, &err);
    g = read_with(&file, &rc_no_wish, &notes, &err);
    read = g != NULL;
    if (!read && err.text[0] == '\0')
        fail_msg("refused without a reason");
    for (size_t k = 0; read && k < 6; k++)
        assert_true(g->nx == 3 && g->ny == 2 && g->v[k] == 0.25 * plain_heights[k] - 2);
    rc_grid_free(g);
    free(copy);
    return read;
}

static void
every_truncation(void **state)
{
    struct rc_file file = plain_file();

    (void)state;
    assert_true(survives(file.data, file.size));
    for (size_t n = 0; n < file.size; n++)
        if (survives(file.data, n))
            fail_msg("the first %zu of %zu bytes are read as a map", n, file.size);
    drop_file(&file);
}

static void
every_byte_damaged(void **state)
{
    struct rc_file file = plain_file();
    unsigned char *data = (unsigned char *)(uintptr_t)file.data;

    (void)state;
    for (size_t k = 0; k < file.size; k++) {
        unsigned char good = data[k];
        for (size_t way = 0; way < 3; way++) {
            data[k] = (unsigned char)(way == 0 ? 0 : way == 1 ? 0xff : good ^ 1);
            survives(data, file.size);
        }
        data[k] = good;
    }
    drop_file(&file);
}

/* Damage with matching checksums: the archive is valid, its content is not. */
static void
every_byte_of_the_header_damaged(void **state)
{
    static const char bytes[] = "\n<>&;/\"\x80 0";
    char *xml = binary_xml("D", "");
    size_t n = strlen(xml), refused = 0;

    (void)state;
    for (size_t k = 0; k < n; k++) {
        char good = xml[k];
        for (size_t b = 0; b < sizeof bytes - 1; b++) {
            struct rc_file file;
            struct rc_notes notes;
            struct rc_err err;
            struct rc_grid *g;

            xml[k] = bytes[b];
            file = pack(xml, plain_bytes, sizeof plain_bytes);
            g = read_with(&file, &rc_no_wish, &notes, &err);
            if (g != NULL)
                check_sound("a damaged header", g, file.size);
            else if (err.text[0] == '\0')
                fail_msg("refused without a reason");
            refused += g == NULL;
            rc_grid_free(g);
            drop_file(&file);
        }
        xml[k] = good;
    }
    assert_true(refused > n); /* most of its bytes have a meaning */
    free(xml);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_locale_has_a_comma), /* and the others run under it */
        cmocka_unit_test(wrong_headers),
        cmocka_unit_test(wrong_lists),
        cmocka_unit_test(other_archives),
        cmocka_unit_test(entity_bomb),
        cmocka_unit_test(zip_bombs),
        cmocka_unit_test(lying_sizes),
        cmocka_unit_test(every_truncation),
        cmocka_unit_test(every_byte_damaged),
        cmocka_unit_test(every_byte_of_the_header_damaged),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
