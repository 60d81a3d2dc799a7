/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The loops of simd_body.h for two, four and eight doubles in a register.
 */
#include "simd.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#endif

#define WIDTH 2
#define NAME(x) narrow_##x
#define TARGET
#include "simd_body.h"
#undef WIDTH
#undef NAME
#undef TARGET

#if defined(__x86_64__) && defined(__GNUC__)
#define WIDTH 4
#define NAME(x) avx2_##x
#define TARGET __attribute__((target("avx2,fma")))
#include "simd_body.h"
#undef WIDTH
#undef NAME
#undef TARGET

#define WIDTH 8
#define NAME(x) avx512_##x
#define TARGET __attribute__((target("avx2,fma,avx512f,avx512dq,avx512vl")))
#include "simd_body.h"
#undef WIDTH
#undef NAME
#undef TARGET
#endif

const struct rc_simd *
rc_simd(void)
{
#if defined(__x86_64__) && defined(__GNUC__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
        return &avx512_simd;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        return &avx2_simd;
#endif
    return &narrow_simd;
}
