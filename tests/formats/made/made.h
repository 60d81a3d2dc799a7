/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Files made in memory for the tests of formats, byte by byte without the project's writers, and the checks
 * that every reader must pass. This folder is built once as the library `made`.
 */
#ifndef MADE_H
#define MADE_H

#include <hdf5.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "formats/core/core.h"
#include "formats/export.h"
#include "formats/format.h"
#include "tests/exact.h"
#include "tests/formats/made/open.h"

/* ---- bytes.c: a growing array of bytes ---- */

struct bytes {
    unsigned char *data;
    size_t n;
    bool big;    /* most significant byte first */
    size_t room; /* allocated bytes: the address sanitizer forbids access after byte n + 1 */
};

void add(struct bytes *b, const void *from, size_t n);
void add_text(struct bytes *b, const char *s);
void add_zeros(struct bytes *b, size_t n);
void add_number(struct bytes *b, uint64_t value, size_t n);
void add_f64(struct bytes *b, double value);
void add_f32(struct bytes *b, double value);
/* Writes the number in this type and the byte order of b, at the end or over existing bytes. */
void add_raw(struct bytes *b, enum rc_raw raw, double value);
void set_raw(struct bytes *b, size_t at, enum rc_raw raw, double value);
void set_text(struct bytes *b, size_t at, const char *s);
/* Writes the length of the bytes after `at` there, as a number of four bytes. */
void close_object(struct bytes *b, size_t at);
void drop(struct bytes *b);
struct rc_file file_of(const struct bytes *b, const char *name);

/*
 * The numbers of the maps in made_files, but -20 and -60 if the type has a sign. 50 is missing if the format
 * can mark missing points:
 *
 *     10 20 30
 *     40 50 60
 */
enum {
    NX = 3,
    NY = 2,
    MISSING_AT = 4
};
double value_of(size_t k, bool has_sign);

enum order {
    ROWS = 0,
    COLUMNS = 1,
    BOTTOM = 2,
    RIGHT = 4
};
/* The six numbers; `missing` replaces the missing one (pass 50 for none). */
void add_map(struct bytes *b, enum rc_raw raw, int order, double missing, size_t padding);

/* ---- files.c: a file of every flat format and variant ---- */

enum {
    NO_SPACING = 1, /* the file lacks the spacing: the options give 1.1e-6 and 1.29e-6 */
    NO_UNIT = 2,    /* the file lacks the unit: the options give nanometres */
    HAS_MISSING = 4,
    PLAIN = 8,   /* the type has no sign */
    SQUARE = 16, /* dy = dx = 1.1e-6     */
    IS_TEXT = 32 /* without its last bytes it may still be valid */
};

typedef void made_maker(struct bytes *b, int variant);

/* Heights are number * scale + zero metres. */
struct made_file {
    const char *title, *format, *name;
    made_maker *make;
    int variant, flags;
    double scale, zero;
};
extern const struct made_file made_files[];
extern const size_t made_files_n;

/* The options for such a file. */
struct rc_wish wish_for(int flags);

/* profilers.c */
made_maker make_sdf_text, make_sdf_binary, make_sur, make_opd, make_metropro, make_al3d, make_plu;
/* probes.c */
made_maker make_nanoscope, make_nid, make_gwy, make_gsf, make_ibw, make_mi, make_wsxm, make_sxm,
    make_mdt, make_createc, make_iso28600;
/* others.c */
made_maker make_bcr, make_frt, make_tmd, make_grd, make_esri, make_npy, make_opdx, make_vk4,
    make_vk6, make_xyz, make_stl;

/* arrays.c */
made_maker make_mat, make_nrrd;
/* These functions add to a MAT file: the header, which sets the byte order of m; a variable with class and
 * flags of the format. Others add a variable of one number, and a text. The last one puts a compressed
 * variable in place of the bytes from `at` on. */
void mat_header(struct bytes *m, bool big);
void mat_array(struct bytes *m, const char *name, unsigned flags, size_t rows, size_t columns,
               unsigned type, const void *numbers, size_t n);
void mat_number(struct bytes *m, const char *name, double value);
void mat_text(struct bytes *m, const char *name, const char *text);
void mat_pack(struct bytes *m, size_t at);

/* ole.c */
made_maker make_mnt;
/* A compound file with this stream. */
void ole_file(struct bytes *b, const char *name, const struct bytes *stream);

/* texts.c */
made_maker make_keyence, make_wykotext, make_zygo;

/* ---- checks.c: checks of every reader ---- */

/* Relative tolerances for numbers from files. */
static const double last_digit = 4e-16;    /* one or two roundings of a double */
static const double float_rounding = 6e-8; /* one rounding to a float: 2^-24 */

/* True if a message gives the expected reason. With addresses of 32 bits a false size may be refused earlier,
 * because it exceeds the address space. */
bool gives_reason(const char *text, const char *why);
/* Checks that spacings are positive and finite, that no value is infinite, and that a file of this size may
 * have so many values. */
void check_sound(const char *what, const struct rc_grid *g, size_t file_size);
/* Fails the test unless the map has this size, these spacings and values, and is a height in
 * metres. */
void check_map(const struct rc_grid *g, size_t nx, size_t ny, double dx, double dy,
               const double *v);

struct rc_grid *try_read(const struct rc_format *format, const struct bytes *b,
                         const struct rc_wish *wish, size_t index, struct rc_err *err);
struct rc_grid *read_well(const struct rc_format *format, const struct bytes *b, size_t index);
void refuse(const struct rc_format *format, const struct bytes *b, const char *why);
/* A file that is cut anywhere is refused with a reason, except for cuts in the bytes after its data. */
void refuse_cuts(const struct rc_format *format, const struct bytes *b, size_t least, size_t step);
/* Bytes are changed at random: each file is refused with a reason or gives a valid map. RC_FUZZ in the
 * environment multiplies the number of files; RC_FUZZ_BYPASS reads without the sandbox, so that the
 * sanitizers see the reader. */
void survive_changes(const struct rc_format *format, const struct bytes *b, size_t times);

/* ---- zip.c ---- */

struct member {
    const char *name;
    const void *bytes;
    size_t n;
};
struct bytes archive(const struct member *member, size_t members);
/* text with the first `from` replaced by `to`; the caller frees it. */
char *with(const char *text, const char *from, const char *to);
/* The same; frees the previous text at this pointer. */
void alter(char **text, const char *from, const char *to);

/* ---- x3p.c ---- */

extern const struct rc_format rc_format_x3p;

/* Templates of main.xml with @TYPE@ and @DATA@, and of its data, with @MORE@. */
extern const char main_xml[], binary_link[];
extern const double plain_heights[6];
/* The same in the order of a file, the lowest byte first on every machine. */
extern const unsigned char plain_bytes[48];

struct rc_file archive_file(const struct member *member, size_t members);
void drop_file(struct rc_file *file);
/* An archive of main.xml with its checksum, and data.bin when there are bytes. */
struct rc_file pack(const char *xml, const void *bytes, size_t n);
struct rc_file pack_doubles(const char *xml, const double *v, size_t n);
char *binary_xml(const char *type, const char *more);
struct rc_file plain_file(void);

struct rc_grid *read_with(const struct rc_file *file, const struct rc_wish *wish,
                          struct rc_notes *notes, struct rc_err *err);
struct rc_grid *read_file(const struct rc_file *file, struct rc_notes *notes);
void refuse_file(const struct rc_file *file, const char *why);
void refuse_xml(const char *xml, const char *why);
bool noted(const struct rc_notes *notes, const char *words);

/* ---- tiff.c ---- */

struct tag {
    uint16_t tag, type; /* 2 text, 3 u16, 4 u32, 7 bytes, 8 i16, 12 f64 */
    uint32_t count;
    const char *text; /* text of types 2 and 7 */
    double number;    /* number of the others */
};
extern const int raw_counts[6];

struct tag text_tag(unsigned tag, const char *text);
struct tag number_tag(unsigned tag, unsigned type, double number);
void tiff_start(struct bytes *b, bool big);
/* One directory with its data before it; returns its offset. The list ends with tag 0. */
size_t tiff_directory(struct bytes *b, const struct tag *tag);
/* A page of nx x ny pixels in one strip, with further tags, which must be above 339. `last` is the offset of
 * the word that points to this page. Returns the offset of the word for the next page. */
size_t tiff_page(struct bytes *b, size_t last, size_t nx, size_t ny, unsigned bits,
                 unsigned samples, const char *description, const void *pixels, size_t n,
                 const struct tag *more);
/* A page with pixels compressed by zlib. */
size_t tiff_packed_page(struct bytes *b, size_t last, size_t nx, size_t ny, unsigned bits,
                        unsigned samples, const char *description, const void *pixels, size_t n,
                        const struct tag *more);
void pixels_i32(struct bytes *b, const int *v, size_t n);

/* ---- hdf.c ---- */

extern const double hdf_counts[6];

hid_t hdf_start(void);
struct bytes hdf_end(hid_t file);
void hdf_number(hid_t set, const char *name, double value);
void hdf_text(hid_t set, const char *name, const char *text, bool variable);
/* A dataset of the six counts; with `chunk` compressed in chunks. */
hid_t hdf_set(hid_t in, const char *name, hid_t type, int rank, const hsize_t *size,
              const hsize_t *chunk);
struct bytes hdf_plain(void);

/* ---- export.c: frames to be written, and files of them ---- */

struct written {
    char *bytes;
    size_t n;
};
extern const struct rc_export_wish plain_export;

/* Heights of about 3.3 um, a fraction of them missing. */
struct rc_grid *random_grid(size_t nx, size_t ny, double missing);
struct rc_export_wish typed(enum rc_raw raw);
struct written export(const char *name, struct rc_grid *const *frame, size_t frames,
                      const struct rc_export_wish *wish);
void refuse_export(const char *name, struct rc_grid *const *frame, size_t frames,
                   const struct rc_export_wish *wish, const char *why);

/* ---- locale.c: a locale with a decimal comma ---- */

/* Makes the locale with localedef(1), so that none needs to be installed, and sets it for numbers. False if
 * the system has no localedef. */
bool set_comma_locale(void);
/* The first test that runs under this locale. */
void the_locale_has_a_comma(void **state);

#endif
