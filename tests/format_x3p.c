/* X3P files are read by their own rules, and whatever is wrong with one is refused by name. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <zip.h>

#include "formats/format.h"
#include "formats/md5.h"
#include "formats/utf8.h"

extern const struct rc_format rc_format_x3p;

static const struct rc_wish no_wish = {.dx = NAN, .dy = NAN, .z_unit = NAN};

/* ---- archives in memory ---- */

struct member {
    const char *name;
    const void *bytes;
    size_t n;
};

static struct rc_file
archive(const struct member *member, size_t members)
{
    zip_source_t *source = zip_source_buffer_create(NULL, 0, 0, NULL);
    zip_t *zip = zip_open_from_source(source, ZIP_TRUNCATE, NULL);
    struct rc_file file = {.name = "made.x3p"};
    unsigned char *data;
    zip_stat_t st;

    assert_non_null(zip);
    zip_source_keep(source);
    for (size_t k = 0; k < members; k++) {
        zip_source_t *from = zip_source_buffer(zip, member[k].bytes, member[k].n, 0);
        assert_true(zip_file_add(zip, member[k].name, from, ZIP_FL_ENC_UTF_8) >= 0);
    }
    assert_int_equal(zip_close(zip), 0);
    assert_int_equal(zip_source_stat(source, &st), 0);
    file.size = (size_t)st.size;
    data = malloc(file.size);
    assert_int_equal(zip_source_open(source), 0);
    assert_int_equal(zip_source_read(source, data, file.size), (zip_int64_t)file.size);
    zip_source_close(source);
    zip_source_free(source);
    file.data = data;
    return file;
}

static void
drop(struct rc_file *file)
{
    free((void *)(uintptr_t)file->data);
}

/* ---- what goes into them ---- */

static const char binary_link[] = "<DataLink><PointDataLink>bindata/data.bin</PointDataLink>"
                                  "@MORE@</DataLink>";

static const char main_xml[] =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\">\n"
    "<Record1><Revision>ISO5436 - 2000</Revision><FeatureType>SUR</FeatureType><Axes>\n"
    "<CX><AxisType>I</AxisType><DataType>D</DataType><Increment>1.1e-6</Increment>"
    "<Offset>0</Offset></CX>\n"
    "<CY><AxisType>I</AxisType><DataType>D</DataType><Increment>1.29e-6</Increment>"
    "<Offset>0</Offset></CY>\n"
    "<CZ><AxisType>A</AxisType><DataType>@TYPE@</DataType>"
    "<Increment>0.25</Increment><Offset>-2</Offset></CZ>\n"
    "</Axes></Record1>\n"
    "<Record2><Date>2024-02-29</Date><Creator>A. \xc3\x85ngstr\xc3\xb6m</Creator><Instrument>"
    "<Manufacturer>M</Manufacturer><Model>\xc2\xb5X</Model><Serial>7</Serial>"
    "</Instrument><ProbingSystem><Type>NonContacting</Type><Identification>20x</Identification>"
    "</ProbingSystem><Comment>a &lt;b&gt; &#x3bc;</Comment></Record2>\n"
    "<Record3><MatrixDimension><SizeX>3</SizeX><SizeY>2</SizeY><SizeZ>1</SizeZ>"
    "</MatrixDimension>\n@DATA@</Record3>\n"
    "<Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4>\n"
    "</p:ISO5436_2>\n";

/* text with the first `from` replaced by `to`; the caller frees it. */
static char *
with(const char *text, const char *from, const char *to)
{
    const char *at = strstr(text, from);
    size_t size = strlen(text) + strlen(to) + 1, head;
    char *made = malloc(size);

    if (at == NULL)
        fail_msg("'%s' is not in the text", from);
    head = (size_t)(at - text);
    memcpy(made, text, head);
    snprintf(made + head, size - head, "%s%s", to, at + strlen(from));
    return made;
}

/* The same in place of a text that was made before. */
static void
alter(char **text, const char *from, const char *to)
{
    char *made = with(*text, from, to);

    free(*text);
    *text = made;
}

static void
sum_of(const void *bytes, size_t n, char sum[RC_MD5_TEXT])
{
    struct rc_md5 md5;

    rc_md5_start(&md5);
    rc_md5_add(&md5, bytes, n);
    rc_md5_end(&md5, sum);
}

/* An archive of main.xml with its checksum, and data.bin when there are bytes. */
static struct rc_file
pack(const char *xml, const void *bytes, size_t n)
{
    char line[64], sum[RC_MD5_TEXT];
    struct member member[3] = {
        {"main.xml", xml, strlen(xml)}, {"md5checksum.hex", line, 0}, {"bindata/data.bin", bytes, n}};

    sum_of(xml, strlen(xml), sum);
    snprintf(line, sizeof line, "%s *main.xml\n", sum);
    member[1].n = strlen(line);
    return archive(member, bytes == NULL ? 2 : 3);
}

static char *
binary_xml(const char *type, const char *more)
{
    char *xml = with(main_xml, "@DATA@", binary_link);

    alter(&xml, "@TYPE@", type);
    alter(&xml, "@MORE@", more);
    return xml;
}

static const double plain[6] = {1, 2, 3, 4, 5, 6};

static struct rc_file
plain_file(void)
{
    char *xml = binary_xml("D", "");
    struct rc_file file = pack(xml, plain, sizeof plain);

    free(xml);
    return file;
}

static struct rc_grid *
read_with(const struct rc_file *file, const struct rc_wish *wish, struct rc_notes *notes,
          struct rc_err *err)
{
    *notes = (struct rc_notes){0};
    err->text[0] = '\0';
    return rc_format_x3p.read(file, wish, 0, notes, err);
}

static struct rc_grid *
read_well(const struct rc_file *file, struct rc_notes *notes)
{
    struct rc_err err;
    struct rc_grid *g = read_with(file, &no_wish, notes, &err);

    if (g == NULL)
        fail_msg("refused: %s", err.text);
    return g;
}

static void
refuse(const struct rc_file *file, const char *why)
{
    struct rc_notes notes;
    struct rc_err err;
    struct rc_grid *g = read_with(file, &no_wish, &notes, &err);

    if (g != NULL)
        fail_msg("read, and should be refused for: %s", why);
    if (strstr(err.text, why) == NULL)
        fail_msg("refused for '%s', not for '%s'", err.text, why);
}

static void
refuse_xml(const char *xml, const char *why)
{
    struct rc_file file = pack(xml, plain, sizeof plain);

    refuse(&file, why);
    drop(&file);
}

static bool
noted(const struct rc_notes *notes, const char *words)
{
    for (size_t k = 0; k < notes->n; k++)
        if (strstr(notes->text[k], words) != NULL)
            return true;
    return false;
}

/* ---- what is read ---- */

/* Six numbers in each type, as bytes spelt out and as text: with increment 1/4 and offset -2 every
 * height is exact. */
static const struct {
    const char *type;
    unsigned char bytes[48];
    size_t n;
    const char *list;
    double height[6];
} types[] = {
    {"I",
     {0x00, 0x80, 0xff, 0x7f, 0xff, 0xff, 0x00, 0x00, 0x01, 0x00, 0x2c, 0x01},
     12,
     "<Datum>-32768</Datum><Datum>32767</Datum><Datum>-1</Datum><Datum>0</Datum><Datum>1</Datum>"
     "<Datum>300</Datum>",
     {-8194, 8189.75, -2.25, -2, -1.75, 73}},
    {"L",
     {0x00, 0x00, 0x00, 0x80, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff, 0xff,
      0x00, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x70, 0x11, 0x01, 0x00},
     24,
     "<Datum>-2147483648</Datum><Datum>2147483647</Datum><Datum>-1</Datum><Datum>0</Datum>"
     "<Datum>1</Datum><Datum>70000</Datum>",
     {-536870914.0, 536870909.75, -2.25, -2, -1.75, 17498}},
    {"F", /* 1, -1, 0.5, NaN, 0, 6 */
     {0x00, 0x00, 0x80, 0x3f, 0x00, 0x00, 0x80, 0xbf, 0x00, 0x00, 0x00, 0x3f,
      0x00, 0x00, 0xc0, 0x7f, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xc0, 0x40},
     24,
     "<Datum>1</Datum><Datum>-1.0</Datum><Datum>5e-1</Datum><Datum/><Datum>0</Datum>"
     "<Datum> 6 </Datum>",
     {-1.75, -2.25, -1.875, NAN, -2, -0.5}},
    {"D",
     {0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xf0, 0x3f, 0x00, 0x00, 0x00, 0x00,
      0x00, 0x00, 0xf0, 0xbf, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xe0, 0x3f,
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xf8, 0x7f, 0x00, 0x00, 0x00, 0x00,
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x18, 0x40},
     48,
     "<Datum>1.0E+0000</Datum><Datum>-1</Datum><Datum>.5</Datum><Datum></Datum>"
     "<Datum>0</Datum><Datum>6</Datum>",
     {-1.75, -2.25, -1.875, NAN, -2, -0.5}},
};

static void
check_heights(const struct rc_grid *g, const double *height)
{
    assert_int_equal(g->nx, 3);
    assert_int_equal(g->ny, 2);
    assert_true(g->dx == 1.1e-6 && g->dy == 1.29e-6);
    assert_string_equal(g->channel, "height");
    assert_string_equal(g->unit, "m");
    for (size_t k = 0; k < 6; k++)
        if (isnan(height[k]) ? !isnan(g->v[k]) : g->v[k] != height[k])
            fail_msg("height %zu is %.17g, not %.17g", k, g->v[k], height[k]);
}

static void
all_types_as_bytes_and_as_text(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof types / sizeof *types; k++) {
        char *binary = binary_xml(types[k].type, ""), *list = with(main_xml, "@TYPE@", types[k].type);
        char data[600];
        struct rc_file file = pack(binary, types[k].bytes, types[k].n);
        struct rc_notes notes;
        struct rc_grid *g = read_well(&file, &notes);

        assert_int_equal(notes.n, 0);
        check_heights(g, types[k].height);
        rc_grid_free(g);
        drop(&file);
        snprintf(data, sizeof data, "<DataList>%s</DataList>", types[k].list);
        alter(&list, "@DATA@", data);
        file = pack(list, NULL, 0);
        g = read_well(&file, &notes);
        assert_int_equal(notes.n, 0);
        check_heights(g, types[k].height);
        rc_grid_free(g);
        drop(&file);
        free(binary);
        free(list);
    }
}

static void
increment_and_offset_default(void **state)
{
    static const char *const absent[] = {"", "<Increment/><Offset/>",
                                         "<Increment> </Increment><Offset></Offset>"};

    (void)state;
    for (size_t k = 0; k < sizeof absent / sizeof *absent; k++) {
        char *xml = binary_xml("D", "");
        struct rc_notes notes;
        struct rc_file file;
        struct rc_grid *g;

        alter(&xml, "<Increment>0.25</Increment><Offset>-2</Offset>", absent[k]);
        file = pack(xml, plain, sizeof plain);
        g = read_well(&file, &notes);
        check_heights(g, plain);
        rc_grid_free(g);
        drop(&file);
        free(xml);
    }
}

/* Points 1 and 5 are missing: bits 1 and 5 of the first byte, counted from the lowest, are 0. */
static const unsigned char mask[1] = {0x1d};
static const double masked[6] = {-1.75, NAN, -1.25, -1, -0.75, NAN};

static struct rc_file
masked_file(const char *more, const void *bits, size_t n)
{
    char *xml = binary_xml("D", more);
    struct member member[] = {{"main.xml", xml, strlen(xml)},
                              {"bindata/data.bin", plain, sizeof plain},
                              {"bindata/valid.bin", bits, n}};
    struct rc_file file = archive(member, 3);

    free(xml);
    return file;
}

static void
valid_points(void **state)
{
    static const char link[] = "<ValidPointsLink>bindata/valid.bin</ValidPointsLink>";
    static const unsigned char long_mask[9] = {0x1d};
    char more[200], sum[RC_MD5_TEXT];
    struct rc_notes notes;
    struct rc_file file;
    struct rc_grid *g;

    (void)state;
    for (size_t n = 1; n <= 8; n += 7) {
        file = masked_file(link, n == 1 ? mask : long_mask, n);
        g = read_well(&file, &notes);
        check_heights(g, masked);
        rc_grid_free(g);
        drop(&file);
    }
    file = masked_file(link, long_mask, 9);
    refuse(&file, "promises 1 bytes of valid points, the file has 9");
    drop(&file);
    file = masked_file(link, "", 0);
    refuse(&file, "promises 1 bytes of valid points, the file has 0");
    drop(&file);
    sum_of(mask, 1, sum);
    snprintf(more, sizeof more, "%s<MD5ChecksumValidPoints>%s</MD5ChecksumValidPoints>", link, sum);
    file = masked_file(more, mask, 1);
    rc_grid_free(read_well(&file, &notes));
    drop(&file);
    file = masked_file(more, long_mask + 1, 1);
    refuse(&file, sum);
    drop(&file);
}

static void
checksums(void **state)
{
    /* MD5 of the 48 bytes of 1.0 to 6.0, by md5sum(1) */
    static const char good[] = "<MD5ChecksumPointData>@SUM@</MD5ChecksumPointData>";
    char sum[RC_MD5_TEXT], *more, *xml;
    struct rc_notes notes;
    struct rc_file file;
    struct rc_grid *g;

    (void)state;
    sum_of(plain, sizeof plain, sum);
    assert_string_equal(sum, "50da13748603a71b2a148ab7b8ee9dc2");
    for (char *s = sum; *s != '\0'; s++)
        if (*s >= 'a')
            *s = (char)(*s - 'a' + 'A');
    more = with(good, "@SUM@", sum);
    xml = binary_xml("D", more);
    file = pack(xml, plain, sizeof plain);
    g = read_well(&file, &notes);
    assert_int_equal(notes.n, 0);
    rc_grid_free(g);
    drop(&file);
    alter(&xml, sum, "00112233445566778899aabbccddeeff");
    refuse_xml(xml, "main.xml says 00112233445566778899aabbccddeeff");
    alter(&xml, "00112233445566778899aabbccddeeff", "not available");
    file = pack(xml, plain, sizeof plain);
    g = read_well(&file, &notes);
    assert_true(noted(&notes, "'not available' is no MD5 sum"));
    rc_grid_free(g);
    drop(&file);
    free(more);
    free(xml);
}

static void
checksum_of_main_is_only_noted(void **state)
{
    char *xml = binary_xml("D", "");
    static const struct {
        const char *file, *note;
    } cases[] = {
        {"00112233445566778899aabbccddeeff *main.xml\n", "says 00112233445566778899aabbccddeeff"},
        {"what?\n", "holds no MD5 sum"},
        {"", "holds no MD5 sum"},
        {NULL, "has no md5checksum.hex"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct member member[] = {
            {"main.xml", xml, strlen(xml)},
            {"bindata/data.bin", plain, sizeof plain},
            {"md5checksum.hex", cases[k].file, cases[k].file == NULL ? 0 : strlen(cases[k].file)}};
        struct rc_file file = archive(member, cases[k].file == NULL ? 2 : 3);
        struct rc_notes notes;
        struct rc_grid *g = read_well(&file, &notes);

        assert_int_equal(notes.n, 1);
        assert_true(noted(&notes, cases[k].note));
        rc_grid_free(g);
        drop(&file);
    }
    free(xml);
}

static void
members_under_one_folder(void **state)
{
    char *xml = binary_xml("D", "");
    struct member member[] = {{"__MACOSX/main.xml", "junk", 4},
                              {"some folder/main.xml", xml, strlen(xml)},
                              {"some folder/bindata/data.bin", plain, sizeof plain}};
    struct rc_notes notes;
    struct rc_file file;

    (void)state;
    file = archive(member, 3);
    assert_ptr_equal(rc_format_find(&file, NULL), &rc_format_x3p);
    rc_grid_free(read_well(&file, &notes));
    drop(&file);
    alter(&xml, "bindata/data.bin", "./bindata\\data.bin");
    member[1] = (struct member){"some folder/main.xml", xml, strlen(xml)};
    file = archive(member, 3);
    rc_grid_free(read_well(&file, &notes));
    drop(&file);
    file = archive(member, 1);
    refuse(&file, "it holds no main.xml");
    drop(&file);
    free(xml);
}

static void
words_become_keys(void **state)
{
    struct rc_file file = plain_file();
    struct rc_notes notes;
    struct rc_grid *g = read_well(&file, &notes);
    char *xml, comment[5000];

    (void)state;
    assert_string_equal(rc_grid_get(g, "file.creator"), "A. \xc3\x85ngstr\xc3\xb6m");
    assert_string_equal(rc_grid_get(g, "file.date"), "2024-02-29");
    assert_string_equal(rc_grid_get(g, "file.manufacturer"), "M");
    assert_string_equal(rc_grid_get(g, "file.model"), "\xc2\xb5X");
    assert_string_equal(rc_grid_get(g, "file.serial"), "7");
    assert_string_equal(rc_grid_get(g, "file.probe-type"), "NonContacting");
    assert_string_equal(rc_grid_get(g, "file.probe"), "20x");
    assert_string_equal(rc_grid_get(g, "file.comment"), "a <b> \xce\xbc");
    assert_null(rc_grid_get(g, "file.calibrated"));
    rc_grid_free(g);
    drop(&file);
    /* another encoding, control characters, and more than a header should carry */
    xml = binary_xml("D", "");
    alter(&xml, "UTF-8", "ISO-8859-1");
    alter(&xml, "A. \xc3\x85ngstr\xc3\xb6m", "\xc5ngstr\xf6m");
    memset(comment, '\xb5', sizeof comment - 1);
    comment[sizeof comment - 1] = '\0';
    comment[0] = 'a';
    comment[1] = '\n';
    alter(&xml, "a &lt;b&gt; &#x3bc;", comment);
    file = pack(xml, plain, sizeof plain);
    g = read_well(&file, &notes);
    assert_string_equal(rc_grid_get(g, "file.creator"), "\xc3\x85ngstr\xc3\xb6m");
    assert_memory_equal(rc_grid_get(g, "file.comment"), "a \xc2\xb5", 4);
    assert_true(strlen(rc_grid_get(g, "file.comment")) < 4096);
    assert_true(rc_utf8_valid(rc_grid_get(g, "file.comment")));
    rc_grid_free(g);
    drop(&file);
    free(xml);
}

static void
profiles(void **state)
{
    char *xml = binary_xml("D", "");
    struct rc_notes notes;
    struct rc_file file;
    struct rc_grid *g;

    (void)state;
    alter(&xml, "SUR", "PRF");
    refuse_xml(xml, "SizeY must be 1");
    alter(&xml, "<SizeX>3", "<SizeX>6");
    alter(&xml, "<SizeY>2", "<SizeY>1");
    alter(&xml, "<Increment>1.29e-6</Increment>", "");
    file = pack(xml, plain, sizeof plain);
    g = read_well(&file, &notes);
    assert_int_equal(g->nx, 6);
    assert_int_equal(g->ny, 1);
    assert_true(g->dx == 1.1e-6 && g->dy == 1.1e-6);
    rc_grid_free(g);
    drop(&file);
    free(xml);
}

static void
rotation_is_noted(void **state)
{
    static const char *const matrices[] = {
        "</CZ><Rotation><r11>1.0</r11><r12>0</r12><r22>1</r22></Rotation>",
        "</CZ><Rotation><r11>-1</r11><r22>-1</r22><r33>1</r33></Rotation>"};

    (void)state;
    for (size_t k = 0; k < 2; k++) {
        char *xml = binary_xml("D", "");
        struct rc_notes notes;
        struct rc_file file;

        alter(&xml, "</CZ>", matrices[k]);
        file = pack(xml, plain, sizeof plain);
        rc_grid_free(read_well(&file, &notes));
        assert_int_equal(noted(&notes, "rotation matrix"), k);
        drop(&file);
        free(xml);
    }
}

static void
wishes_win(void **state)
{
    struct rc_wish wish = {.dx = 2e-6, .dy = NAN, .z_unit = NAN};
    char *xml = binary_xml("D", "");
    struct rc_file file = pack(xml, plain, sizeof plain);
    struct rc_notes notes;
    struct rc_err err;
    struct rc_grid *g = read_with(&file, &wish, &notes, &err);

    (void)state;
    assert_non_null(g);
    assert_true(g->dx == 2e-6 && g->dy == 2e-6);
    assert_true(noted(&notes, "in x is 2e-06 m as given; the file says 1.1e-06 m"));
    rc_grid_free(g);
    wish = (struct rc_wish){.dx = NAN, .dy = 3e-6, .z_unit = 1e-6};
    g = read_with(&file, &wish, &notes, &err);
    assert_non_null(g);
    assert_true(g->dx == 1.1e-6 && g->dy == 3e-6);
    assert_true(fabs(g->v[5] - -0.5e-6) < 1e-21);
    assert_int_equal(notes.n, 2);
    rc_grid_free(g);
    drop(&file);
    alter(&xml, "<Increment>1.1e-6</Increment>", "");
    file = pack(xml, plain, sizeof plain);
    refuse(&file, "the spacing in x: --dx LENGTH says it");
    wish = (struct rc_wish){.dx = 2e-6, .dy = 1.29e-6, .z_unit = NAN};
    g = read_with(&file, &wish, &notes, &err);
    assert_non_null(g);
    assert_int_equal(notes.n, 0);
    rc_grid_free(g);
    drop(&file);
    free(xml);
}

/* ---- what is refused ---- */

static void
wrong_headers(void **state)
{
    static const struct {
        const char *from, *to, *why;
    } wrong[] = {
        {"SUR", "PCL", "cloud of points"},
        {"SUR", "", "FeatureType is ''"},
        {"<CX><AxisType>I", "<CX><AxisType>A", "axis CX is of type 'A'"},
        {"<CY><AxisType>I", "<CY><AxisType>A", "axis CY is of type 'A'"},
        {"1.1e-6", "0", "spacing in x is 0 m in the file"},
        {"1.1e-6", "-1e-6", "spacing in x is -1e-06 m"},
        {"1.1e-6", "NaN", "'NaN' in main.xml: it must be finite"},
        {"1.1e-6", "inf", "'inf' in main.xml: it must be finite"},
        {"1.1e-6", "1e999", "'1e999' in main.xml: it must be finite"},
        {"1.1e-6", "1,1e-6", "'1,1e-6' in main.xml: that is no number"},
        {"1.29e-6", "0.0", "spacing in y is 0 m"},
        {"1.29e-6", "", "--dy LENGTH"},
        {"0.25", "0", "increment of CZ is 0"},
        {"0.25", "nan", "must be finite"},
        {"-2<", "1e400<", "must be finite"},
        {"0.25", "1e308", "column 1, row 0 (from 0) is infinite"},
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
        {"</p:ISO5436_2>", "", "no whole XML"},
        {"<Record2>", "<Record2>&bomb;", "no whole XML"},
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
    struct rc_file file = archive(&sheet, 1);

    (void)state;
    assert_ptr_equal(rc_format_find(&file, NULL), &rc_format_x3p);
    refuse(&file, "no X3P: it holds no main.xml (the first of its 1 members is "
                  "'[Content_Types].xml')");
    drop(&file);
    file = archive(&page, 1);
    refuse(&file, "the root of its main.xml is 'html'");
    drop(&file);
    file = archive(&empty, 1);
    refuse(&file, "main.xml is no");
    drop(&file);
}

/* A billion laughs by way of parameter entities and of general ones. */
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
    struct rc_file file = archive(member, 2);

    (void)state;
    assert_true(file.size < n / 500);
    refuse(&file, "promises 48 bytes of heights, the file has 67108864");
    drop(&file);
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
    PACKED_SIZE = 20, /* places in a directory entry of a ZIP archive */
    SIZE = 24
};

static void
lying_sizes(void **state)
{
    char *xml = binary_xml("D", "");
    struct rc_file file = plain_file();

    (void)state;
    patch(&file, "bindata/data.bin", SIZE, 0xfffffff0U);
    refuse(&file, "cannot hold");
    patch(&file, "bindata/data.bin", SIZE, 96);
    refuse(&file, "promises 48 bytes of heights, the file has 96");
    patch(&file, "bindata/data.bin", SIZE, 48);
    patch(&file, "bindata/data.bin", PACKED_SIZE, 0x7ffffff0U);
    refuse(&file, "promises 2147483632 packed bytes");
    drop(&file);
    /* the header believes the lie: six more heights than there are */
    alter(&xml, "<SizeX>3", "<SizeX>6");
    file = pack(xml, plain, sizeof plain);
    patch(&file, "bindata/data.bin", SIZE, 96);
    refuse(&file, "bindata/data.bin");
    drop(&file);
    /* and fewer than there are */
    alter(&xml, "<SizeX>6", "<SizeX>2");
    file = pack(xml, plain, sizeof plain);
    patch(&file, "bindata/data.bin", SIZE, 32);
    refuse(&file, "bindata/data.bin");
    drop(&file);
    free(xml);
}

/* Every way to use the file, in a block of memory of exactly its size: it is refused with a reason
 * or read as what it was, and nothing beside the block is touched. Whether it was read. */
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
    rc_format_x3p.list(&file, &no_wish, &channel, 1, &err);
    g = read_with(&file, &no_wish, &notes, &err);
    read = g != NULL;
    if (!read && err.text[0] == '\0')
        fail_msg("refused without a reason");
    for (size_t k = 0; read && k < 6; k++)
        assert_true(g->nx == 3 && g->ny == 2 && g->v[k] == 0.25 * plain[k] - 2);
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
    drop(&file);
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
    drop(&file);
}

/* Damage that has its checksums put right: the archive is whole, what it says is not. */
static void
every_byte_of_the_header_damaged(void **state)
{
    static const char bytes[] = "\n<>&;/\"\x80 0";
    char *xml = binary_xml("D", "");
    size_t n = strlen(xml);

    (void)state;
    for (size_t k = 0; k < n; k++) {
        char good = xml[k];
        for (size_t b = 0; b < sizeof bytes - 1; b++) {
            struct rc_file file;
            struct rc_notes notes;
            struct rc_err err;
            xml[k] = bytes[b];
            file = pack(xml, plain, sizeof plain);
            rc_grid_free(read_with(&file, &no_wish, &notes, &err));
            drop(&file);
        }
        xml[k] = good;
    }
    free(xml);
}

static void
list_tells_size_and_spacing(void **state)
{
    struct rc_file file = plain_file();
    struct rc_channel channel;
    struct rc_err err;

    (void)state;
    assert_int_equal(rc_format_x3p.list(&file, &no_wish, &channel, 1, &err), 1);
    assert_int_equal(channel.nx, 3);
    assert_int_equal(channel.ny, 2);
    assert_true(channel.dx == 1.1e-6 && channel.dy == 1.29e-6);
    assert_string_equal(channel.unit, "m");
    drop(&file);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_types_as_bytes_and_as_text),
        cmocka_unit_test(increment_and_offset_default),
        cmocka_unit_test(valid_points),
        cmocka_unit_test(checksums),
        cmocka_unit_test(checksum_of_main_is_only_noted),
        cmocka_unit_test(members_under_one_folder),
        cmocka_unit_test(words_become_keys),
        cmocka_unit_test(profiles),
        cmocka_unit_test(rotation_is_noted),
        cmocka_unit_test(wishes_win),
        cmocka_unit_test(wrong_headers),
        cmocka_unit_test(wrong_lists),
        cmocka_unit_test(other_archives),
        cmocka_unit_test(entity_bomb),
        cmocka_unit_test(zip_bombs),
        cmocka_unit_test(lying_sizes),
        cmocka_unit_test(every_truncation),
        cmocka_unit_test(every_byte_damaged),
        cmocka_unit_test(every_byte_of_the_header_damaged),
        cmocka_unit_test(list_tells_size_and_spacing),
    };

    /* numbers in files have a point whatever the user's locale has */
    if (setlocale(LC_ALL, "de_DE.UTF-8") == NULL)
        printf("no locale with a decimal comma here: only the point is tried\n");
    return cmocka_run_group_tests(tests, NULL, NULL);
}
