/*
 * Names, units and kinds of the parameters: in the order of the standard, for text, JSON and tables.
 */
#include "info.h"

#define AREAL(name) #name, offsetof(struct rc_areal, name)
#define FEATURE(name) #name, offsetof(struct rc_features, name)
#define LINE(name) #name, offsetof(struct rc_profile, name)

const struct info_parameter info_areal[] = {
    {AREAL(sq), "Sq", "Rq", INFO_LENGTH},
    {AREAL(sa), "Sa", "Ra", INFO_LENGTH},
    {AREAL(ssk), "Ssk", "Rsk", INFO_NUMBER},
    {AREAL(sku), "Sku", "Rku", INFO_NUMBER},
    {AREAL(sp), "Sp", "Rpt", INFO_LENGTH},
    {AREAL(sv), "Sv", "Rvt", INFO_LENGTH},
    {AREAL(sz), "Sz", "Rt", INFO_LENGTH},
    {AREAL(sdq), "Sdq", "Rdq", INFO_NUMBER},
    {AREAL(sdr), "Sdr", "Rdr", INFO_FRACTION},
    {AREAL(sal), "Sal", "Ral", INFO_LENGTH},
    {AREAL(str), "Str", NULL, INFO_NUMBER},
    {AREAL(std), "Std", NULL, INFO_ANGLE},
    {AREAL(sk), "Sk", "Rk", INFO_LENGTH},
    {AREAL(spk), "Spk", "Rpk", INFO_LENGTH},
    {AREAL(svk), "Svk", "Rvk", INFO_LENGTH},
    {AREAL(smr1), "Smr1", "Rmrk1", INFO_FRACTION},
    {AREAL(smr2), "Smr2", "Rmrk2", INFO_FRACTION},
    {AREAL(vmp), "Vmp", "Rvmp", INFO_LENGTH},
    {AREAL(vmc), "Vmc", "Rvmc", INFO_LENGTH},
    {AREAL(vvc), "Vvc", "Rvvc", INFO_LENGTH},
    {AREAL(vvv), "Vvv", "Rvvv", INFO_LENGTH},
    {AREAL(sxp), "Sxp", "Rdc", INFO_LENGTH},
    {AREAL(rms_curvature), "RMS curvature", "RMS curvature", INFO_CURVATURE},
    {.key = NULL}};

const struct info_parameter info_features[] = {{FEATURE(spd), "Spd", NULL, INFO_DENSITY},
                                               {FEATURE(svd), "Svd", NULL, INFO_DENSITY},
                                               {FEATURE(spc), "Spc", NULL, INFO_CURVATURE},
                                               {FEATURE(s5p), "S5p", NULL, INFO_LENGTH},
                                               {FEATURE(s5v), "S5v", NULL, INFO_LENGTH},
                                               {FEATURE(s10z), "S10z", NULL, INFO_LENGTH},
                                               {FEATURE(sha), "Sha", NULL, INFO_AREA},
                                               {FEATURE(sda), "Sda", NULL, INFO_AREA},
                                               {.key = NULL}};

const struct info_parameter info_line[] = {
    {LINE(ra), NULL, "Ra", INFO_LENGTH},   {LINE(rq), NULL, "Rq", INFO_LENGTH},
    {LINE(rsk), NULL, "Rsk", INFO_NUMBER}, {LINE(rku), NULL, "Rku", INFO_NUMBER},
    {LINE(rp), NULL, "Rp", INFO_LENGTH},   {LINE(rv), NULL, "Rv", INFO_LENGTH},
    {LINE(rz), NULL, "Rz", INFO_LENGTH},   {LINE(rpt), NULL, "Rpt", INFO_LENGTH},
    {LINE(rvt), NULL, "Rvt", INFO_LENGTH}, {LINE(rt), NULL, "Rt", INFO_LENGTH},
    {LINE(rsm), NULL, "Rsm", INFO_LENGTH}, {LINE(rc), NULL, "Rc", INFO_LENGTH},
    {LINE(rdq), NULL, "Rdq", INFO_NUMBER}, {.key = NULL}};

double
info_value(const void *figures, const struct info_parameter *p)
{
    return *(const double *)(const void *)((const char *)figures + p->at);
}

const char *
info_unit(enum info_kind kind)
{
    static const char *const unit[] = {
        [INFO_LENGTH] = "m",      [INFO_NUMBER] = NULL,    [INFO_FRACTION] = NULL,
        [INFO_ANGLE] = "deg",     [INFO_DENSITY] = "1/m2", [INFO_AREA] = "m2",
        [INFO_CURVATURE] = "1/m",
    };

    return unit[kind];
}

const char *
info_shown(char text[SHOWN_NUMBER], double value, enum info_kind kind)
{
    switch (kind) {
    case INFO_LENGTH:
        return shown_in_unit(text, value, "m");
    case INFO_AREA:
        return shown_area(text, value);
    case INFO_FRACTION:
        snprintf(text, SHOWN_NUMBER, "%.6g %%", 100 * value);
        return text;
    case INFO_ANGLE:
        snprintf(text, SHOWN_NUMBER, "%.6g deg", value);
        return text;
    case INFO_DENSITY:
        snprintf(text, SHOWN_NUMBER, "%.6g 1/mm2", 1e-6 * value);
        return text;
    case INFO_CURVATURE:
        snprintf(text, SHOWN_NUMBER, "%.6g 1/mm", 1e-3 * value);
        return text;
    case INFO_NUMBER:
        break;
    }
    snprintf(text, SHOWN_NUMBER, "%.6g", value);
    return text;
}
