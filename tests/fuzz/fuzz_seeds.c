/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the files that the tests make by hand into folders FOLDER/FORMAT/, as seeds. */
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "tests/formats/made/made.h"

int
main(int argc, char **argv)
{
    char path[4096];

    if (argc != 2)
        return 2;
    for (size_t k = 0; k < made_files_n; k++) {
        struct bytes m = {0};
        FILE *f;

        snprintf(path, sizeof path, "%s/%s", argv[1], made_files[k].format);
        mkdir(path, 0777);
        snprintf(path, sizeof path, "%s/%s/made-%zu-%s", argv[1], made_files[k].format, k,
                 made_files[k].name);
        made_files[k].make(&m, made_files[k].variant);
        if ((f = fopen(path, "wb")) == NULL || fwrite(m.data, 1, m.n, f) != m.n || fclose(f) != 0) {
            perror(path);
            return 1;
        }
        drop(&m);
    }
    return 0;
}
