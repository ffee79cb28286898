/* SPDX-License-Identifier: BSD-3-Clause */
#include "print_rows.h"
#include "outcome.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "io/base/file.h"

const char *print_rows_find(const options *o, const se3d_model *model)
{
    const int is_any = strcmp(o->print, "-") == 0;
    for (size_t k = 0; k < se3d_model_count_outputs(model); ++k) {
        se3d_model_output output;
        se3d_model_get_output(model, k, &output);
        if (is_any ? output.channel_count > 0 && !se3di_file_is_hdf5(output.file)
                   : strcmp(output.file, o->print) == 0) {
            return output.file;
        }
    }
    complain("se3d run: --print %s: the model's `output` has no %s\n", o->print,
             is_any ? "CSV file of channels" : "such file");
    return NULL;
}

int print_rows(const char *folder, const char *file)
{
    char path[4096], block[4096];
    FILE *from = se3di_file_join(folder, file, path, sizeof path) ? se3di_file_open(path) : NULL;
    if (!from) {
        complain("se3d run: --print %s: %s\n", file, se3di_file_get_text(errno));
        return EXIT_FAILED;
    }
    size_t used = fread(block, 1, sizeof block, from);
    while (used > 0 && fwrite(block, 1, used, stdout) == used) {
        used = fread(block, 1, sizeof block, from);
    }
    fclose(from);
    return EXIT_DONE;
}
