/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of text that instruments export. */
#include "made.h"

#include <stdio.h>

/* Number k of the map in this format, or the word for a missing point. */
static void
add_word(struct bytes *m, size_t k, const char *form, const char *missing)
{
    char text[32];

    snprintf(text, sizeof text, form, value_of(k, true));
    add_text(m, k == MISSING_AT ? missing : text);
}

/* 0: with commas, in English; 1: with semicolons and decimal commas, in German, with a break in the header
 * and the micro sign of Latin-1; 2: in Japanese, Shift-JIS; 3: in Chinese, GBK; 4: in Korean,
 * CP949 */
void
make_keyence(struct bytes *m, int variant)
{
    static const char *const heads[] = {
        "\"Measured date\",\"2025-12-10 12:00:00\"\r\n\"Model\",\"VK-X3000 Series\"\r\n"
        "\"Data type\",\"ImageDataCsv\"\r\n\"File version\",\"1000\"\r\n"
        "\"Objective Lens Power\",\"50\"\r\n\"XY Calibration\",\"1100.000\",\"nm\"\r\n"
        "\"Output image data\",\"Height\"\r\n\"Horizontal\",\"3\"\r\n\"Vertical\",\"2\"\r\n"
        "\"Minimum value\",\"-60\"\r\n\"Maximum value\",\"40\"\r\n\"Unit\",\"nm\"\r\n"
        "\"Reference data name\",\"\"\r\n\r\n\"Height\"\r\n",
        "\"Modell\";\"VK-X1000 Series\"\n\"Data "
        "type\n\";\"ImageDataCsv\"\n\"XY-Justierung\";\"1,1\";\"\xb5m\"\n"
        "\"Bilddatenausg.\";\"H\xf6he\"\n\"Horizont.\";\"3\"\n\"Vertikal\";\"2\"\n\"Einheit\";"
        "\"nm\"\n\n"
        "\"H\xf6he\"\n",
        "\"\x8b@\x8e\xed\",\"VK-X1000 Series\"\r\n\"\x83t\x83@\x83"
        "C\x83\x8b\",\"ImageDataCsv\"\r\n"
        "\"XY\",\"1.1\",\"\x83\xcam\"\r\n\"\x89\xa1\",\"3\"\r\n\"\x8f"
        "c\",\"2\"\r\n\"\x92P\x88\xca\",\"\x83\xcam\"\r\n"
        "\r\n\"\x8d\x82\x82\xb3\"\r\n",
        "\"\xce\xc4\xbc\xfe\",\"ImageDataCsv\"\r\n\"XY\",\"1.1\",\"\xa6\xccm\"\r\n\"\xcb\xae\","
        "\"3\"\r\n"
        "\"\xb4\xb9\",\"2\"\r\n\"\xb5\xa5\",\"\xa6\xccm\"\r\n\r\n\"\xb8\xdf\"\r\n",
        "\"\xb1\xe2\xc1\xbe\",\"ImageDataCsv\"\r\n\"XY\",\"1.1\",\"\xa5\xecm\"\r\n"
        "\"\xb0\xa1\xb7\xce\",\"3\"\r\n\"\xbc\xbc\xb7\xce\",\"2\"\r\n"
        "\"\xb4\xdc\xc0\xa7\",\"\xa7\xad\"\r\n\r\n\"\xb3\xf4\xc0\xcc\"\r\n",
    };

    add_text(m, heads[variant]);
    for (size_t k = 0; k < NX * NY; k++) {
        add_text(m, "\"");
        add_word(m, k, variant == 1 ? "%.0f,0" : variant == 0 ? "%.1f" : "%.3f", "");
        add_text(m, (k + 1) % NX != 0 ? variant == 1 ? "\";" : "\","
                    : variant == 1    ? "\"\n"
                                      : "\"\r\n");
    }
}

/* 0: in units of a wavelength, 1: in nanometres, 2: points in nanometres, 3: points in nanometres from the
 * upper right downwards, although the header says wavelengths */
void
make_wykotext(struct bytes *m, int variant)
{
    char place[64];

    add_text(m, variant % 3 == 0 ? "Wyko ASCII Data File Format 0\t0\t1\r\n"
                                 : "Wyko ASCII Data File Format 0\t1\t1\r\n");
    add_text(
        m, "X Size\t3\r\nY Size\t2\r\nBlock Name\tType\tLength\tValue\r\nWavelength\t7\t4\t640\r\n"
           "Aspect\t7\t4\t1.1727272727272728\r\nTitle\t5\t20\ta title\r\nNote\t5\t60\t\r\n"
           "Pixel_size\t7\t4\t0.0011\r\nMult\t6\t2\t8\r\nRAW_DATA\t3\t24\t\r\n");
    for (size_t n = 0; n < NX; n++) /* a column a line, the lowest first */
        for (size_t k = NY; k-- > 0;) {
            size_t i = variant == 3 ? NX - 1 - n : n, j = variant == 3 ? NY - 1 - k : k;

            if (variant >= 2) {
                snprintf(place, sizeof place, "%.6f\t%.6f\t", 0.0011 * (double)i,
                         0.00129 * (double)(NY - 1 - j));
                add_text(m, place);
            }
            add_word(m, j * NX + i, "%.2f", "Bad");
            add_text(m, k > 0 && variant < 2 ? "\t" : "\r\n");
        }
}

/* 0: XYZ in micrometres, without one point; 1 to 3: ASCII with phase resolution 0 to 2 */
void
make_zygo(struct bytes *m, int variant)
{
    char text[80];

    add_text(m, variant == 0 ? "Zygo XYZ Data File - Format 1\n"
                             : "Zygo ASCII Data File - Format 2\n");
    add_text(
        m,
        "1 8 3 5 \"Wed May 06 14:03:59 2015\"\n0 0 3 2 1 255\n10 20 3 2\n\"a "
        "comment\"\n\"\"\n\"\"\n"
        "0 0.5 6.25e-007 0 2 0 1.1e-006 1430913839\n640 480 1 2 0 0 \"5X\"\n0 1 0 0 0 0 0 0 0 0\n");
    snprintf(text, sizeof text, "%d 1 20 2 0 0 0 0 0\n0 \"\"\n1 0\n",
             variant == 0 ? 1 : variant - 1);
    add_text(m, text);
    if (variant > 0)
        add_text(m, "\"zoom\"\n#\n1 2 3\n4 5 6\n");
    add_text(m, "#\n");
    for (size_t k = NX * NY; variant == 0 && k-- > 0;) /* in any order */
        if (k != MISSING_AT) {
            snprintf(text, sizeof text, "%d %d %g\n", (int)(10 + k % NX), (int)(20 + k / NX),
                     value_of(k, true) * 1e-3);
            add_text(m, text);
        }
    for (size_t k = 0; variant > 0 && k < NX * NY; k++) {
        add_word(m, k, "%.0f", "2147483640");
        add_text(m, k == 3 ? "\n" : " ");
    }
    add_text(m, variant == 0 ? "\n12 20 No Data\n12 20 0.03\n#\n" : "\n#\n");
}
