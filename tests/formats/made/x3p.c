/* SPDX-License-Identifier: GPL-3.0-or-later */
/* X3P files made in memory, whose parts a test can replace. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/containers/containers.h"
#include "made.h"

struct rc_file
archive_file(const struct member *member, size_t members)
{
    struct bytes b = archive(member, members);

    return file_of(&b, "made.x3p");
}

void
drop_file(struct rc_file *file)
{
    free((void *)(uintptr_t)file->data);
}

const char binary_link[] = "<DataLink><PointDataLink>bindata/data.bin</PointDataLink>"
                           "@MORE@</DataLink>";

const char main_xml[] =
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

struct rc_file
pack(const char *xml, const void *bytes, size_t n)
{
    char line[64], md5[RC_MD5_TEXT];
    struct member member[3] = {{"main.xml", xml, strlen(xml)},
                               {"md5checksum.hex", line, 0},
                               {"bindata/data.bin", bytes, n}};

    rc_md5_of(xml, strlen(xml), md5);
    snprintf(line, sizeof line, "%s *main.xml\n", md5);
    member[1].n = strlen(line);
    return archive_file(member, bytes == NULL ? 2 : 3);
}

char *
binary_xml(const char *type, const char *more)
{
    char *xml = with(main_xml, "@DATA@", binary_link);

    alter(&xml, "@TYPE@", type);
    alter(&xml, "@MORE@", more);
    return xml;
}

const double plain_heights[6] = {1, 2, 3, 4, 5, 6};
const unsigned char plain_bytes[48] = {0, 0, 0, 0, 0, 0, 0xf0, 0x3f, 0, 0, 0, 0, 0, 0, 0x00, 0x40,
                                       0, 0, 0, 0, 0, 0, 0x08, 0x40, 0, 0, 0, 0, 0, 0, 0x10, 0x40,
                                       0, 0, 0, 0, 0, 0, 0x14, 0x40, 0, 0, 0, 0, 0, 0, 0x18, 0x40};

struct rc_file
pack_doubles(const char *xml, const double *v, size_t n)
{
    struct bytes b = {0};
    struct rc_file file;

    for (size_t k = 0; k < n; k++)
        add_f64(&b, v[k]);
    file = pack(xml, b.data, b.n);
    drop(&b);
    return file;
}

struct rc_file
plain_file(void)
{
    char *xml = binary_xml("D", "");
    struct rc_file file = pack(xml, plain_bytes, sizeof plain_bytes);

    free(xml);
    return file;
}

struct rc_grid *
read_with(const struct rc_file *file, const struct rc_wish *wish, struct rc_notes *notes,
          struct rc_err *err)
{
    *notes = (struct rc_notes){0};
    err->text[0] = '\0';
    return read_map(&rc_format_x3p, file, wish, 0, notes, err);
}

struct rc_grid *
read_file(const struct rc_file *file, struct rc_notes *notes)
{
    struct rc_err err;
    struct rc_grid *g = read_with(file, &rc_no_wish, notes, &err);

    if (g == NULL)
        fail_msg("refused: %s", err.text);
    return g;
}

void
refuse_file(const struct rc_file *file, const char *why)
{
    struct rc_notes notes;
    struct rc_err err;
    struct rc_grid *g = read_with(file, &rc_no_wish, &notes, &err);

    if (g != NULL)
        fail_msg("read, and should be refused for: %s", why);
    if (!gives_reason(err.text, why))
        fail_msg("refused for '%s', not for '%s'", err.text, why);
}

void
refuse_xml(const char *xml, const char *why)
{
    struct rc_file file = pack(xml, plain_bytes, sizeof plain_bytes);

    refuse_file(&file, why);
    drop_file(&file);
}

bool
noted(const struct rc_notes *notes, const char *words)
{
    for (size_t k = 0; k < notes->n; k++)
        if (strstr(notes->text[k], words) != NULL)
            return true;
    return false;
}
