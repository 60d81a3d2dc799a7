/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Included before each test that clang-tidy checks: cmocka's assertions do not return when they fail, but
 * their declarations lack this property. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

_Noreturn void _fail(const char *file, int line);
#include <cmocka.h>

#undef assert_true
#define assert_true(holds) ((holds) ? (void)0 : _fail(__FILE__, __LINE__))
#undef assert_non_null
#define assert_non_null(at) assert_true((at) != NULL)
