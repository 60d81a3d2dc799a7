#include "words.h"

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

const struct rc_engine_info *
words_engine_named(const char *name)
{
    const struct rc_engine_info *info;

    for (size_t k = 0; (info = rc_engine_info(k)) != NULL; k++)
        if (strcmp(info->name, name) == 0)
            return info;
    return NULL;
}

const struct rc_method_info *
words_method_named(const char *name)
{
    const struct rc_method_info *info;

    for (size_t k = 0; (info = rc_method_info(k)) != NULL; k++)
        if (strcmp(info->name, name) == 0)
            return info;
    return NULL;
}
