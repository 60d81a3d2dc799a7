/*
 * Small files of every flat format, byte by byte as its specification has them and not by a writer
 * of ours: 3 columns, 2 rows, and every variant that the readers know.
 */
#include "made.h"

const struct made_file made_files[] = {
    {"SDF text", "sdf", "a.sdf", make_sdf_text, 0, HAS_MISSING | IS_TEXT, 1e-9, 0},
    {"SDF text, BCR", "sdf", "a.sdf", make_sdf_text, 1, HAS_MISSING | IS_TEXT, 1e-9, 0},
    {"SDF u8", "sdf", "a.sdf", make_sdf_binary, 0, PLAIN, 1e-9, 0},
    {"SDF u16", "sdf", "a.sdf", make_sdf_binary, 1, PLAIN, 1e-9, 0},
    {"SDF u32", "sdf", "a.sdf", make_sdf_binary, 2, PLAIN, 1e-9, 0},
    {"SDF f32", "sdf", "a.sdf", make_sdf_binary, 3, HAS_MISSING, 1e-9, 0},
    {"SDF i8", "sdf", "a.sdf", make_sdf_binary, 4, HAS_MISSING, 1e-9, 0},
    {"SDF i16", "sdf", "a.sdf", make_sdf_binary, 5, HAS_MISSING, 1e-9, 0},
    {"SDF i32", "sdf", "a.sdf", make_sdf_binary, 6, HAS_MISSING, 1e-9, 0},
    {"SDF f64", "sdf", "a.sdf", make_sdf_binary, 7, HAS_MISSING, 1e-9, 0},
    {"SUR 16 bits", "sur", "a.sur", make_sur, 0, HAS_MISSING, 0.25e-9, 100e-9},
    {"SUR 32 bits", "sur", "a.sur", make_sur, 1, HAS_MISSING, 0.25e-9, 100e-9},
    {"SUR compressed", "sur", "a.sur", make_sur, 2, HAS_MISSING, 0.25e-9, 100e-9},
    {"SUR without missing points", "sur", "a.sur", make_sur, 3, 0, 0.25e-9, 100e-9},
    {"OPD floats", "opd", "a.opd", make_opd, 0, HAS_MISSING, 80e-9, 0},
    {"OPD 16 bits", "opd", "a.opd", make_opd, 1, HAS_MISSING, 80e-9, 0},
    {"OPD Raw", "opd", "a.opd", make_opd, 2, HAS_MISSING, 80e-9, 0},
    {"MetroPro 0", "metropro", "a.dat", make_metropro, 0, HAS_MISSING | SQUARE, 6.25e-7 / 4096, 0},
    {"MetroPro 1", "metropro", "a.dat", make_metropro, 1, HAS_MISSING | SQUARE, 6.25e-7 / 32768, 0},
    {"MetroPro 2", "metropro", "a.dat", make_metropro, 2, HAS_MISSING | SQUARE, 6.25e-7 / 131072,
     0},
    {"AL3D padded", "al3d", "a.al3d", make_al3d, 0, HAS_MISSING, 1, 0},
    {"PLU", "plu", "a.plu", make_plu, 0, HAS_MISSING, 1e-6, 0},
    {"NanoScope 16 bits", "nanoscope", "a.001", make_nanoscope, 0, 0, 12.5e-12, 0},
    {"NanoScope 32 bits, mV", "nanoscope", "a.spm", make_nanoscope, 1, 0, 12.5e-12, 0},
    {"NanoScope in nm", "nanoscope", "a.spm", make_nanoscope, 2, SQUARE, 0.01e-9, 0},
    {"NID 16 bits", "nid", "a.nid", make_nid, 0, 0, 1e-12, 0},
    {"NID 32 bits", "nid", "a.nid", make_nid, 1, 0, 1e-12, 0},
    {"NID unsigned", "nid", "a.nid", make_nid, 2, PLAIN, 1e-12, -32.768e-9},
    {"NID Motorola", "nid", "a.nid", make_nid, 3, 0, 1e-12, 0},
    {"GWY", "gwy", "a.gwy", make_gwy, 0, HAS_MISSING, 1e-9, 0},
    {"GSF, 4 NUL", "gsf", "a.gsf", make_gsf, 0, HAS_MISSING, 1e-9, 0},
    {"GSF, 3 NUL", "gsf", "a.gsf", make_gsf, 1, HAS_MISSING, 1e-9, 0},
    {"GSF, 2 NUL", "gsf", "a.gsf", make_gsf, 2, HAS_MISSING, 1e-9, 0},
    {"GSF, 1 NUL", "gsf", "a.gsf", make_gsf, 3, HAS_MISSING, 1e-9, 0},
    {"IBW f32", "ibw", "a.ibw", make_ibw, 0, HAS_MISSING, 1e-9, 0},
    {"IBW f64 of Macintosh", "ibw", "a.ibw", make_ibw, 1, HAS_MISSING, 1e-9, 0},
    {"IBW i16, labels", "ibw", "a.ibw", make_ibw, 2, 0, 1e-9, 0},
    {"MI 16 bits", "mi", "a.mi", make_mi, 0, 0, 1e-12, 0},
    {"MI 32 bits", "mi", "a.mi", make_mi, 1, 0, 1e-12 / 65536, 0},
    {"WSxM short", "wsxm", "a.top", make_wsxm, 0, 0, 0.1e-9, 0},
    {"WSxM float", "wsxm", "a.stp", make_wsxm, 1, 0, 0.1e-9, 0},
    {"WSxM double", "wsxm", "a.stp", make_wsxm, 2, 0, 0.1e-9, 0},
    {"BCR", "bcr", "a.bcr", make_bcr, 0, HAS_MISSING, 0.25e-9, 0},
    {"BCR of Macintosh", "bcr", "a.bcr", make_bcr, 1, HAS_MISSING, 0.25e-9, 0},
    {"BCRF", "bcr", "a.bcrf", make_bcr, 2, HAS_MISSING, 1e-6, 0},
    {"BCRF, wide", "bcr", "a.bcrf", make_bcr, 3, HAS_MISSING, 1e-6, 0},
    {"FRT 1.00", "frt", "a.frt", make_frt, 0, HAS_MISSING | PLAIN, 1e-9, 0},
    {"FRT 1.01", "frt", "a.frt", make_frt, 1, HAS_MISSING, 1e-9, 0},
    {"TrueMap", "tmd", "a.tmd", make_tmd, 0, HAS_MISSING, 1e-6, 0},
    {"GelSight", "tmd", "a.tmd", make_tmd, 1, HAS_MISSING, 1e-3, 0},
    {"Surfer text", "grd", "a.grd", make_grd, 0, HAS_MISSING | NO_SPACING | NO_UNIT | IS_TEXT, 1e-9,
     0},
    {"Surfer 6", "grd", "a.grd", make_grd, 1, HAS_MISSING | NO_SPACING | NO_UNIT, 1e-9, 0},
    {"Surfer 7", "grd", "a.grd", make_grd, 2, HAS_MISSING | NO_SPACING | NO_UNIT, 1e-9, 0},
    {"ESRI", "esri", "a.asc", make_esri, 0, HAS_MISSING | NO_SPACING | NO_UNIT | IS_TEXT, 1e-9, 0},
    {"ESRI, DX DY", "esri", "a.asc", make_esri, 1, HAS_MISSING | NO_SPACING | NO_UNIT | IS_TEXT,
     1e-9, 0},
    {"SXM, up", "sxm", "a.sxm", make_sxm, 0, HAS_MISSING, 1e-9, 0},
    {"SXM, down, the way back", "sxm", "a.sxm", make_sxm, 1, HAS_MISSING, 1e-9, 0},
    {"Keyence", "keyence", "a.csv", make_keyence, 0, HAS_MISSING | SQUARE | IS_TEXT, 1e-9, 0},
    {"Keyence, German", "keyence", "a.csv", make_keyence, 1, HAS_MISSING | SQUARE | IS_TEXT, 1e-9,
     0},
    {"Keyence, Shift-JIS", "keyence", "a.csv", make_keyence, 2, HAS_MISSING | SQUARE | IS_TEXT,
     1e-6, 0},
    {"Keyence, GBK", "keyence", "a.csv", make_keyence, 3, HAS_MISSING | SQUARE | IS_TEXT, 1e-6, 0},
    {"Wyko text", "wykotext", "a.asc", make_wykotext, 0, HAS_MISSING | IS_TEXT, 80e-9, 0},
    {"Wyko text, nm", "wykotext", "a.asc", make_wykotext, 1, HAS_MISSING | IS_TEXT, 1e-9, 0},
    {"Zygo XYZ", "zygo", "a.xyz", make_zygo, 0, HAS_MISSING | SQUARE, 1e-9, 0},
    {"Zygo ASCII 0", "zygo", "a.asc", make_zygo, 1, HAS_MISSING | SQUARE, 6.25e-7 / 4096, 0},
    {"Zygo ASCII 1", "zygo", "a.asc", make_zygo, 2, HAS_MISSING | SQUARE, 6.25e-7 / 32768, 0},
    {"Zygo ASCII 2", "zygo", "a.asc", make_zygo, 3, HAS_MISSING | SQUARE, 6.25e-7 / 131072, 0},
    {"NPY <f8", "npy", "a.npy", make_npy, 0, HAS_MISSING | NO_SPACING | NO_UNIT, 1e-9, 0},
    {"NPY <f4", "npy", "a.npy", make_npy, 1, HAS_MISSING | NO_SPACING | NO_UNIT, 1e-9, 0},
    {"NPY |i1", "npy", "a.npy", make_npy, 2, NO_SPACING | NO_UNIT, 1e-9, 0},
    {"NPY >i2", "npy", "a.npy", make_npy, 3, NO_SPACING | NO_UNIT, 1e-9, 0},
    {"NPY <i4", "npy", "a.npy", make_npy, 4, NO_SPACING | NO_UNIT, 1e-9, 0},
    {"NPY <i8", "npy", "a.npy", make_npy, 5, NO_SPACING | NO_UNIT, 1e-9, 0},
    {"NPY |u1", "npy", "a.npy", make_npy, 6, NO_SPACING | NO_UNIT | PLAIN, 1e-9, 0},
    {"NPY <u2", "npy", "a.npy", make_npy, 7, NO_SPACING | NO_UNIT | PLAIN, 1e-9, 0},
    {"NPY >u4", "npy", "a.npy", make_npy, 8, NO_SPACING | NO_UNIT | PLAIN, 1e-9, 0},
    {"NPY <u8", "npy", "a.npy", make_npy, 9, NO_SPACING | NO_UNIT | PLAIN, 1e-9, 0},
    {"NPY >f8 of Fortran", "npy", "a.npy", make_npy, 10, HAS_MISSING | NO_SPACING | NO_UNIT, 1e-9,
     0},
    {"NPY version 2", "npy", "a.npy", make_npy, 11, HAS_MISSING | NO_SPACING | NO_UNIT, 1e-9, 0},
    {"OPDx map", "opdx", "a.opdx", make_opdx, 0, HAS_MISSING, 0.25e-9, 0},
    {"OPDx map, no name", "opdx", "a.opdx", make_opdx, 1, HAS_MISSING, 0.25e-9, 0},
    {"VK4", "vk", "a.vk4", make_vk4, 0, PLAIN, 100e-12, 0},
    {"VK3, 16 bits", "vk", "a.vk3", make_vk4, 1, PLAIN, 100e-12, 0},
    {"VK4, 8 bits", "vk", "a.vk4", make_vk4, 2, PLAIN, 100e-12, 0},
    {"VK6", "vk", "a.vk6", make_vk6, 0, PLAIN, 100e-12, 0},
    {"VK7", "vk", "a.vk7", make_vk6, 1, PLAIN, 100e-12, 0},
    {"XYZ", "xyz", "a.xyz", make_xyz, 0, HAS_MISSING | NO_SPACING | NO_UNIT | IS_TEXT, 1e-9, 0},
    {"XYZ, commas, a hole", "xyz", "a.txt", make_xyz, 1,
     HAS_MISSING | NO_SPACING | NO_UNIT | IS_TEXT, 1e-9, 0},
    {"XYZ, backwards", "xyz", "a.txt", make_xyz, 2, HAS_MISSING | NO_SPACING | NO_UNIT | IS_TEXT,
     1e-9, 0},
};

const size_t made_files_n = sizeof made_files / sizeof *made_files;

struct rc_wish
wish_for(int flags)
{
    struct rc_wish wish = rc_no_wish;

    if ((flags & NO_SPACING) != 0) {
        wish.dx = 1.1e-6;
        wish.dy = 1.29e-6;
    }
    if ((flags & NO_UNIT) != 0)
        wish.z_unit = 1e-9;
    return wish;
}
