/* SPDX-License-Identifier: BSD-3-Clause */
/* Definitions of force elements and their members, for the misuse table. */
#ifndef SE3D_TESTS_MISUSE_FORCES_H
#define SE3D_TESTS_MISUSE_FORCES_H

#include "misuse/misuse_fields.h"

static void define_tsda(arguments *a)
{
    se3d_tsda_def def = se3d_tsda_def_default();
    def.body_i = ground_of(a);
    def.body_j = a->use.body;
    def.point_j[0] = 1.0;
    STORE(def);
}
static const field tsda_fields[] = {
    MEMBER('N', se3d_tsda_def, name, 1),    MEMBER('b', se3d_tsda_def, body_i, 1),
    MEMBER('b', se3d_tsda_def, body_j, 1),  MEMBER('n', se3d_tsda_def, point_i, 3),
    MEMBER('n', se3d_tsda_def, point_j, 3), MEMBER('n', se3d_tsda_def, k, 1),
    MEMBER('n', se3d_tsda_def, c, 1),       MEMBER('n', se3d_tsda_def, l0, 1),
    MEMBER('f', se3d_tsda_def, h, 1),       END};

static void define_rsda(arguments *a)
{
    se3d_rsda_def def = se3d_rsda_def_default();
    def.joint = a->use.pin;
    STORE(def);
}
static const field rsda_fields[] = {MEMBER('N', se3d_rsda_def, name, 1),
                                    MEMBER('c', se3d_rsda_def, joint, 1),
                                    MEMBER('n', se3d_rsda_def, k, 1),
                                    MEMBER('n', se3d_rsda_def, c, 1),
                                    MEMBER('n', se3d_rsda_def, theta0, 1),
                                    MEMBER('f', se3d_rsda_def, h, 1),
                                    END};

static void define_load(arguments *a)
{
    se3d_load_def def = se3d_load_def_default();
    def.body = a->use.body;
    STORE(def);
}
static const field load_fields[] = {
    MEMBER('N', se3d_load_def, name, 1),     MEMBER('b', se3d_load_def, body, 1),
    MEMBER('n', se3d_load_def, point, 3),    MEMBER('n', se3d_load_def, value, 3),
    MEMBER('f', se3d_load_def, function, 3), END};
static const field torque_fields[] = {
    MEMBER('N', se3d_load_def, name, 1), MEMBER('b', se3d_load_def, body, 1),
    MEMBER('n', se3d_load_def, value, 3), MEMBER('f', se3d_load_def, function, 3), END};

static void define_bushing(arguments *a)
{
    se3d_bushing_def def = se3d_bushing_def_default();
    def.body_i = ground_of(a);
    def.body_j = a->use.body;
    STORE(def);
}
static const field bushing_fields[] = {MEMBER('N', se3d_bushing_def, name, 1),
                                       MEMBER('b', se3d_bushing_def, body_i, 1),
                                       MEMBER('b', se3d_bushing_def, body_j, 1),
                                       MEMBER('n', se3d_bushing_def, point_i, 3),
                                       MEMBER('n', se3d_bushing_def, point_j, 3),
                                       MEMBER('n', se3d_bushing_def, orientation_i, 4),
                                       MEMBER('n', se3d_bushing_def, orientation_j, 4),
                                       MEMBER('n', se3d_bushing_def, K, 36),
                                       MEMBER('n', se3d_bushing_def, C, 36),
                                       END};

static void define_friction(arguments *a)
{
    se3d_friction_def def = se3d_friction_def_default();
    def.joint = a->use.pin;
    def.mu = 0.1;
    def.radius = 0.01;
    STORE(def);
}
static const field friction_fields[] = {MEMBER('N', se3d_friction_def, name, 1),
                                        MEMBER('c', se3d_friction_def, joint, 1),
                                        MEMBER('n', se3d_friction_def, mu, 1),
                                        MEMBER('n', se3d_friction_def, mu_static, 1),
                                        MEMBER('n', se3d_friction_def, radius, 1),
                                        MEMBER('n', se3d_friction_def, limit, 1),
                                        MEMBER('n', se3d_friction_def, viscous, 1),
                                        MEMBER('n', se3d_friction_def, presliding, 1),
                                        MEMBER('n', se3d_friction_def, length, 1),
                                        MEMBER('n', se3d_friction_def, width, 1),
                                        MEMBER('n', se3d_friction_def, thrust_radius, 1),
                                        END};

/* Infinite bounds are allowed (none), a joint that is null too. */
static void define_stop(arguments *a)
{
    se3d_stop_def def = se3d_stop_def_default();
    def.body_i = ground_of(a);
    def.body_j = a->use.body;
    def.point_j[0] = 1.0;
    def.upper = 2.0;
    def.k = 1e5;
    STORE(def);
}
static const field stop_fields[] = {
    MEMBER('N', se3d_stop_def, name, 1),        MEMBER('b', se3d_stop_def, body_i, 1),
    MEMBER('b', se3d_stop_def, body_j, 1),      MEMBER('n', se3d_stop_def, point_i, 3),
    MEMBER('n', se3d_stop_def, point_j, 3),     MEMBER('n', se3d_stop_def, k, 1),
    MEMBER('n', se3d_stop_def, restitution, 1), END};

static void define_effort(arguments *a)
{
    se3d_effort_def def = se3d_effort_def_default();
    def.joint = a->use.pin;
    STORE(def);
}

static const field effort_fields[] = {MEMBER('N', se3d_effort_def, name, 1),
                                      MEMBER('c', se3d_effort_def, joint, 1),
                                      MEMBER('n', se3d_effort_def, value, 1), END};

static se3d_status no_force(void *ctx, double t, const se3d_body_motion motion[2],
                            double wrench[12], double *K, double *D)
{
    (void)ctx, (void)t, (void)motion, (void)K, (void)D;
    memset(wrench, 0, 12 * sizeof *wrench);
    return SE3D_OK;
}
static void define_callback(arguments *a)
{
    se3d_force_callback_def def = se3d_force_callback_def_default();
    def.body_i = ground_of(a);
    def.body_j = a->use.body;
    def.callback = no_force;
    STORE(def);
}
static const field callback_fields[] = {MEMBER('N', se3d_force_callback_def, name, 1),
                                        MEMBER('b', se3d_force_callback_def, body_i, 1),
                                        MEMBER('b', se3d_force_callback_def, body_j, 1), END};

#endif
