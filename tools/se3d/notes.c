/* SPDX-License-Identifier: BSD-3-Clause */
/* Mechanisms that are locked, particles that an analysis leaves out. */
#include "notes.h"

#include <stdio.h>
#include <string.h>

enum { CONSTRAINTS_MAX = 100 }; /* beyond it a rank is not found in passing */

static void add(notes *n, const char *text)
{
    if (n->count < NOTES_MAX) {
        snprintf(n->text[n->count++], NOTE_SIZE, "%s", text);
    }
}

static int is_analysed(const se3d_run *run, const char *type)
{
    int found = 0;
    for (size_t k = 0; k < se3d_run_count_analyses(run); ++k) {
        se3d_run_analysis analysis;
        found = found || (!SE3D_FAILED(se3d_run_get_analysis(run, k, &analysis)) &&
                          strcmp(analysis.type, type) == 0);
    }
    return found;
}

static void note_particles(notes *n, const se3d_run *run)
{
    static const char *const types[] = {"equilibrium", "modes"};
    char text[NOTE_SIZE];
    for (size_t k = 0; k < sizeof types / sizeof *types && se3d_run_count_particles(run) > 0; ++k) {
        if (is_analysed(run, types[k])) {
            snprintf(text, sizeof text,
                     "%s: the particles and their forces on the bodies are left out; let dynamics "
                     "bring them to rest",
                     types[k]);
            add(n, text);
        }
    }
}

/* Dynamics that ends at rest, without particles beside the bodies. */
static int may_be_locked(const se3d_system *system, const se3d_run *run)
{
    se3d_energy energy = {0.0, 0.0, 0.0, 0.0};
    return se3d_system_count_constraints(system) <= CONSTRAINTS_MAX &&
           se3d_run_count_particles(run) == 0 && is_analysed(run, "dynamics") &&
           !SE3D_FAILED(se3d_system_get_energy(system, &energy)) && !(energy.kinetic > 1e-20);
}

/* There are bodies, and no force could move them. */
static int is_locked(se3d_system *system)
{
    se3d_check_summary summary = {.struct_size = sizeof summary};
    se3d_check *check = NULL;
    const int locked = !SE3D_FAILED(se3d_check_create(system, &check)) &&
                       !SE3D_FAILED(se3d_check_get_summary(check, &summary)) &&
                       summary.bodies > 0 && summary.freedoms == 0;
    se3d_check_destroy(check);
    return locked;
}

void notes_collect(notes *n, se3d_model *model, const se3d_run *run)
{
    se3d_system *system = se3d_model_get_system(model);
    n->count = 0;
    note_particles(n, run);
    if (may_be_locked(system, run) && is_locked(system)) {
        add(n, "nothing can move: the constraints leave no degree of freedom; `se3d check` says "
               "which of them duplicate others, and axes or dimensions may need more digits");
    }
}
