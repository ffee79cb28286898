/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: constraints whose equations a callback computes. */
#include "joint/draft.h"
#include "system/coordinate.h"
#include "system/system_internal.h"

#include <stdio.h>

void se3d_user_constraint_def_init(se3d_user_constraint_def *def, size_t size)
{
    se3d_user_constraint_def full = {.struct_size = size, .body_count = 1, .equation_count = 1};
    se3di_def_init(def, size, &full, sizeof full);
}

static se3d_status check_counts(se3d_system *system, const se3d_user_constraint_def *def)
{
    if (def->body_count < 1 || def->body_count > SE3D_USER_BODIES_MAX) {
        return SE3DI_FAIL_OF(system, "body_count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be 1 to %d", (int)def->body_count, SE3D_USER_BODIES_MAX);
    }
    if (def->equation_count < 1 || def->equation_count > SE3D_USER_EQUATIONS_MAX) {
        return SE3DI_FAIL_OF(system, "equation_count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be 1 to %d", (int)def->equation_count,
                             SE3D_USER_EQUATIONS_MAX);
    }
    return se3di_check_pointer(system, "callback", (const void *)(uintptr_t)def->callback);
}

/* The bodies of the callback, all different. */
static se3d_status find_bodies(se3d_system *system, const se3d_user_constraint_def *def,
                               uint32_t bodies[SE3D_USER_BODIES_MAX])
{
    for (int32_t k = 0; k < def->body_count; ++k) {
        char what[24];
        snprintf(what, sizeof what, "bodies[%d]", (int)k);
        SE3DI_TRY(se3di_find_body(system, what, def->bodies[k], &bodies[k]));
        for (int32_t other = 0; other < k; ++other) {
            if (bodies[other] == bodies[k]) {
                return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT,
                                     " is bodies[%d] again, the bodies must be different",
                                     (int)other);
            }
        }
    }
    if (def->body_count == 1 && bodies[0] == 0) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "bodies[0] is the ground, a constraint of one body needs a body");
    }
    return SE3D_OK;
}

se3d_status se3d_user_constraint_create(se3d_system *system, const se3d_user_constraint_def *user,
                                        se3d_constraint *constraint)
{
    SE3DI_CREATE(system, constraint);
    se3d_user_constraint_def def = se3d_user_constraint_def_default();
    uint32_t bodies[SE3D_USER_BODIES_MAX] = {0};
    se3di_draft draft;
    SE3DI_TRY(se3di_check_def(system, "def", user, &def, sizeof def));
    SE3DI_TRY(
        se3di_check_new_name(system, &system->model.constraint_slots, 0, "constraint", def.name));
    SE3DI_TRY(check_counts(system, &def));
    SE3DI_TRY(find_bodies(system, &def, bodies));
    se3di_user_draft(&def, bodies, &draft);
    return se3di_constraint_add(system, &draft, constraint);
}
