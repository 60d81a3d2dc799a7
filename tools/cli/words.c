/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "words.h"

#include <stdio.h>
#include <string.h>

const char *
words_engine(size_t k)
{
    const struct rc_engine_info *info = rc_engine_info(k);

    return info == NULL ? NULL : info->name;
}

const char *
words_engine_or_auto(size_t k)
{
    return k == 0 ? "auto" : words_engine(k - 1);
}

const char *
words_method(size_t k)
{
    const struct rc_method_info *info = rc_method_info(k);

    return info == NULL ? NULL : info->name;
}

const char *
words_method_or_auto(size_t k)
{
    return k == 0 ? "auto" : words_method(k - 1);
}

const char *
words_component(size_t k)
{
    return k < RC_STRESSES ? rc_component_names[k] : NULL;
}

const char *
words_stress_engine_or_auto(size_t k)
{
    const struct rc_engine_info *info;

    if (k == 0)
        return "auto";
    for (size_t e = 0; (info = rc_engine_info(e)) != NULL; e++)
        if (!info->precise && --k == 0)
            return info->name;
    return NULL;
}

const char *
words_periodic_engines(char *list, size_t size)
{
    const struct rc_engine_info *info;
    size_t n = 0;

    list[0] = '\0';
    for (size_t e = 0; (info = rc_engine_info(e)) != NULL && n < size; e++)
        if (info->periodic && !info->precise)
            n += (size_t)snprintf(list + n, size - n, "%s%s", n == 0 ? "" : " ", info->name);
    return list;
}

size_t
words_engine_place(const char *name)
{
    const char *word;
    size_t k = 0;

    while ((word = words_engine(k)) != NULL && strcmp(word, name) != 0)
        k++;
    return k;
}

const struct rc_engine_info *
words_engine_named(const char *name)
{
    return rc_engine_info(words_engine_place(name));
}
