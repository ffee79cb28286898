/* SPDX-License-Identifier: BSD-3-Clause */
#include "se3d/io.h"

se3d_status se3d_model_run_file(const char *path, const char *directory, se3d_model_error *error)
{
    se3d_model *model = NULL;
    se3d_run *run = NULL;
    se3d_status status = se3d_model_read_file(path, NULL, &model, error);
    if (status >= 0) {
        se3d_run_options options = se3d_run_options_default();
        options.directory = directory;
        status = se3d_model_run(model, &options, &run, error);
    }
    se3d_run_destroy(run);
    se3d_model_destroy(model);
    return status;
}
