/* SPDX-License-Identifier: BSD-3-Clause */
/* Print the hashes of the states to which models come, with the library as it is installed or as
 * one source (AMALGAMATED). */
#ifdef AMALGAMATED
#include "se3d-io.h"
#else
#include <se3d/io.h>
#endif
#include <stdio.h>

int main(int count, char **paths)
{
    for (int k = 1; k < count; ++k) {
        se3d_model *model = NULL;
        se3d_model_error error;
        se3d_solver *solver = NULL;
        se3d_solver_def how = se3d_solver_def_default();
        if (se3d_model_read_file(paths[k], NULL, &model, &error) < 0 ||
            se3d_model_get_solver(model, 0, &how) < 0 ||
            se3d_solver_create(se3d_model_get_system(model), &how, &solver) < 0 ||
            se3d_solver_run(solver, 0.1) < 0) {
            fprintf(stderr, "%s: failed\n", paths[k]);
            return 1;
        }
        printf("%016llx\n", (unsigned long long)se3d_system_hash(se3d_model_get_system(model)));
        se3d_solver_destroy(solver);
        se3d_model_destroy(model);
    }
    return 0;
}
