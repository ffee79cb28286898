/* SPDX-License-Identifier: BSD-3-Clause */
/* Every model of examples/models, one after the other. */
#ifndef SE3D_TESTS_SUPPORT_EXAMPLES_H
#define SE3D_TESTS_SUPPORT_EXAMPLES_H

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "se3d/io.h"

/* Whether analysis `index` moves what no two methods move alike for long: particles that roll over
 * each other, and heaps of bodies, which are there for the method convex; others follow each of
 * their contacts through its oscillation, for minutes. Nor hundreds of swings, which are there for
 * gauss, and at whose samples no energy has been exchanged. */
static inline int support_is_chaotic_example(const se3d_model *model, size_t index)
{
    se3d_solver_def def = se3d_solver_def_default();
    CHECK(!se3d_model_get_solver(model, index, &def));
    return se3d_system_count_particles(se3d_model_get_system(model)) > 0 ||
           def.method == SE3D_METHOD_CONVEX || def.method == SE3D_METHOD_GAUSS;
}

/* The sum of what `visit` returns for each. Define _POSIX_C_SOURCE before the first include. */
static inline int support_visit_examples(int (*visit)(const char *path, const char *name))
{
    const char *root = getenv("SE3D_SOURCE_DIR");
    char folder[600], path[900];
    int sum = 0;
    snprintf(folder, sizeof folder, "%.500s/examples/models", root ? root : ".");
    DIR *directory = opendir(folder);
    CHECK(directory != NULL);
    for (struct dirent *entry; directory && (entry = readdir(directory));) {
        size_t length = strlen(entry->d_name);
        if (length > 5 && strcmp(entry->d_name + length - 5, ".yaml") == 0) {
            snprintf(path, sizeof path, "%s/%.255s", folder, entry->d_name);
            sum += visit(path, entry->d_name);
        }
    }
    if (directory) {
        closedir(directory);
    }
    return sum;
}

#endif
