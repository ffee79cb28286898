/* SPDX-License-Identifier: BSD-3-Clause */
/* Run a model file in one call: `run_model [MODEL [FOLDER]]`. The results are in the folder. */
#include <se3d/io.h>

#include <stdio.h>

int main(int count, char **words)
{
    const char *model = count > 1 ? words[1] : "examples/models/pendulum.yaml";
    const char *folder = count > 2 ? words[2] : "results/run_model";
    se3d_model_error error;
    if (SE3D_FAILED(se3d_model_run_file(model, folder, &error))) {
        fprintf(stderr, "%s\n", error.message);
        return 1;
    }
    printf("results of %s are in %s\n", model, folder);
    return 0;
}
