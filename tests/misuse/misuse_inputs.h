/* SPDX-License-Identifier: BSD-3-Clause */
/* Misuse of the setters of values. */
#ifndef SE3D_TESTS_MISUSE_INPUTS_H
#define SE3D_TESTS_MISUSE_INPUTS_H

#include "misuse/misuse_world.h"

#include <math.h>

typedef struct settable {
    se3d_force spring, load, bushing, stop, friction, effort, armature;
} settable;

static settable add_settable(arguments *a)
{
    settable made;
    se3d_body ground;
    CHECK(!se3d_system_get_ground(a->system, &ground));
    made.spring = a->use.force;
    se3d_load_def load = se3d_load_def_default();
    load.body = a->use.body;
    CHECK(!se3d_force_create_load(a->system, &load, &made.load));
    se3d_bushing_def bushing = se3d_bushing_def_default();
    bushing.body_i = ground;
    bushing.body_j = a->use.body;
    CHECK(!se3d_force_create_bushing(a->system, &bushing, &made.bushing));
    se3d_stop_def stop = se3d_stop_def_default();
    stop.joint = a->use.pin;
    stop.upper = 1.0;
    stop.k = 1.0;
    CHECK(!se3d_force_create_stop(a->system, &stop, &made.stop));
    se3d_friction_def friction = se3d_friction_def_default();
    friction.joint = a->use.pin;
    friction.mu = 0.1;
    CHECK(!se3d_force_create_friction(a->system, &friction, &made.friction));
    se3d_effort_def effort = se3d_effort_def_default();
    effort.joint = a->use.pin;
    CHECK(!se3d_force_create_effort(a->system, &effort, &made.effort));
    se3d_armature_def armature = se3d_armature_def_default();
    armature.joint = a->use.pin;
    CHECK(!se3d_force_create_armature(a->system, &armature, &made.armature));
    return made;
}

static void remove_settable(arguments *a, const settable *made)
{
    CHECK(!se3d_force_destroy(a->system, made->load));
    CHECK(!se3d_force_destroy(a->system, made->bushing));
    CHECK(!se3d_force_destroy(a->system, made->stop));
    CHECK(!se3d_force_destroy(a->system, made->friction));
    CHECK(!se3d_force_destroy(a->system, made->effort));
    CHECK(!se3d_force_destroy(a->system, made->armature));
}

#define INVALID(call) CHECK((call) == SE3D_ERR_INVALID_ARGUMENT)

/* The value of each parameter that is refused, and one that is taken. */
static void check_parameters(arguments *a, const settable *m)
{
    const double nan = (double)NAN, infinite = (double)INFINITY;
    const struct {
        se3d_force force;
        int32_t parameter;
        int32_t reserved;
        double bad, good;
    } rows[] = {{m->spring, SE3D_FORCE_PARAMETER_K, 0, nan, -2.0},
                {m->spring, SE3D_FORCE_PARAMETER_C, 0, infinite, 2.0},
                {m->spring, SE3D_FORCE_PARAMETER_REST, 0, -1.0, 0.5},
                {m->spring, SE3D_FORCE_PARAMETER_PRELOAD, 0, nan, 7.0},
                {m->stop, SE3D_FORCE_PARAMETER_K, 0, 0.0, 9.0},
                {m->stop, SE3D_FORCE_PARAMETER_LOWER, 0, 1.0, -infinite},
                {m->stop, SE3D_FORCE_PARAMETER_UPPER, 0, nan, 3.0},
                {m->stop, SE3D_FORCE_PARAMETER_RESTITUTION, 0, 1.5, 0.5},
                {m->stop, SE3D_FORCE_PARAMETER_IMPACT, 0, -1.0, 0.25},
                {m->friction, SE3D_FORCE_PARAMETER_MU, 0, -0.1, 0.3},
                {m->friction, SE3D_FORCE_PARAMETER_MU_STATIC, 0, 0.2, 0.4},
                {m->friction, SE3D_FORCE_PARAMETER_RADIUS, 0, nan, 0.01},
                {m->friction, SE3D_FORCE_PARAMETER_LIMIT, 0, -1.0, 0.0},
                {m->friction, SE3D_FORCE_PARAMETER_VISCOUS, 0, infinite, 0.5},
                {m->friction, SE3D_FORCE_PARAMETER_PRESLIDING, 0, -1e-9, 1e-6},
                {m->armature, SE3D_FORCE_PARAMETER_INERTIA, 0, -1.0, 0.5}};
    for (size_t k = 0; k < sizeof rows / sizeof rows[0]; ++k) {
        double before = 0.0, after = 1.0;
        CHECK(!se3d_force_get_parameter(a->system, rows[k].force, rows[k].parameter, &before));
        INVALID(se3d_force_set_parameter(a->system, rows[k].force, rows[k].parameter, rows[k].bad));
        CHECK(!se3d_force_get_parameter(a->system, rows[k].force, rows[k].parameter, &after));
        CHECK(memcmp(&before, &after, sizeof after) == 0);
        CHECK(!se3d_force_set_parameter(a->system, rows[k].force, rows[k].parameter, rows[k].good));
        CHECK(!se3d_force_get_parameter(a->system, rows[k].force, rows[k].parameter, &after));
        CHECK(memcmp(&rows[k].good, &after, sizeof after) == 0);
    }
    double mu_static = 0.0; /* the same again */
    CHECK(!se3d_force_set_parameter(a->system, m->friction, SE3D_FORCE_PARAMETER_MU_STATIC, 0.0));
    CHECK(!se3d_force_set_parameter(a->system, m->friction, SE3D_FORCE_PARAMETER_MU, 0.7));
    CHECK(!se3d_force_get_parameter(a->system, m->friction, SE3D_FORCE_PARAMETER_MU_STATIC,
                                    &mu_static));
    CHECK_NEAR(mu_static, 0.7, 0.0);
    INVALID(se3d_force_set_parameter(a->system, m->spring, SE3D_FORCE_PARAMETER_MU, 0.1));
    CHECK_CONTAINS(se3d_system_get_error(a->system), "a tsda element has no mu");
    INVALID(se3d_force_set_parameter(a->system, m->load, SE3D_FORCE_PARAMETER_K, 0.1));
    INVALID(se3d_force_set_parameter(a->system, m->spring, 14, 0.1));
    INVALID(se3d_force_set_parameter(a->system, m->spring, -1, 0.1));
    INVALID(se3d_force_get_parameter(a->system, m->spring, 14, &mu_static));
    INVALID(se3d_force_get_parameter(a->system, m->stop, SE3D_FORCE_PARAMETER_C, &mu_static));
    CHECK(se3d_force_set_parameter(NULL, m->spring, 0, 1.0) == SE3D_ERR_NULL);
    CHECK(se3d_force_get_parameter(NULL, m->spring, 0, &mu_static) == SE3D_ERR_NULL);
    CHECK(se3d_force_get_parameter(a->system, m->spring, 0, NULL) == SE3D_ERR_NULL);
}

static void check_values(arguments *a, const settable *m)
{
    const double nan[3] = {0.0, (double)NAN, 0.0}, good[3] = {1.0, 2.0, 3.0};
    double K[36] = {1.0}, C[36] = {0.0}, value[3];
    CHECK(!se3d_force_set_value(a->system, m->load, good));
    INVALID(se3d_force_set_value(a->system, m->load, nan));
    INVALID(se3d_force_set_value(a->system, m->spring, good));
    INVALID(se3d_force_get_value(a->system, m->spring, value));
    CHECK(!se3d_force_get_value(a->system, m->load, value));
    CHECK(memcmp(value, good, sizeof value) == 0);
    CHECK(se3d_force_set_value(NULL, m->load, good) == SE3D_ERR_NULL);
    CHECK(se3d_force_set_value(a->system, m->load, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_force_get_value(NULL, m->load, value) == SE3D_ERR_NULL);
    CHECK(se3d_force_get_value(a->system, m->load, NULL) == SE3D_ERR_NULL);
    CHECK(!se3d_force_set_bushing(a->system, m->bushing, K, C));
    INVALID(se3d_force_set_bushing(a->system, m->spring, K, C));
    INVALID(se3d_force_get_bushing(a->system, m->spring, K, C));
    K[1] = 1.0; /* not symmetric */
    INVALID(se3d_force_set_bushing(a->system, m->bushing, K, C));
    CHECK(!se3d_force_get_bushing(a->system, m->bushing, K, C));
    CHECK(fabs(K[1]) <= 0.0 && K[0] >= 1.0);
    CHECK(se3d_force_set_bushing(NULL, m->bushing, K, C) == SE3D_ERR_NULL);
    CHECK(se3d_force_set_bushing(a->system, m->bushing, NULL, C) == SE3D_ERR_NULL);
    CHECK(se3d_force_set_bushing(a->system, m->bushing, K, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_force_get_bushing(NULL, m->bushing, K, C) == SE3D_ERR_NULL);
    CHECK(se3d_force_get_bushing(a->system, m->bushing, NULL, C) == SE3D_ERR_NULL);
    CHECK(se3d_force_get_bushing(a->system, m->bushing, K, NULL) == SE3D_ERR_NULL);
}

static void check_efforts(arguments *a, const settable *m)
{
    const double nan = (double)NAN, two[2] = {1.0, 2.0}, bad = (double)INFINITY;
    double value = 0.0;
    size_t count = 7;
    CHECK(!se3d_effort_count(a->system, &count));
    CHECK(count == 1);
    CHECK(!se3d_effort_set(a->system, m->effort, 3.0));
    INVALID(se3d_effort_set(a->system, m->effort, nan));
    INVALID(se3d_effort_set(a->system, m->spring, 3.0));
    INVALID(se3d_effort_get(a->system, m->spring, &value));
    INVALID(se3d_effort_set_all(a->system, 2, two));
    INVALID(se3d_effort_set_all(a->system, 0, two));
    INVALID(se3d_effort_set_all(a->system, 1, &bad));
    CHECK(!se3d_effort_get(a->system, m->effort, &value));
    CHECK_NEAR(value, 3.0, 0.0);
    CHECK(!se3d_effort_set_all(a->system, 1, two));
    CHECK(!se3d_effort_get(a->system, m->effort, &value));
    CHECK_NEAR(value, 1.0, 0.0);
    CHECK(se3d_effort_set(NULL, m->effort, 1.0) == SE3D_ERR_NULL);
    CHECK(se3d_effort_get(NULL, m->effort, &value) == SE3D_ERR_NULL);
    CHECK(se3d_effort_get(a->system, m->effort, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_effort_set_all(NULL, 1, two) == SE3D_ERR_NULL);
    CHECK(se3d_effort_set_all(a->system, 1, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_effort_count(NULL, &count) == SE3D_ERR_NULL && count == 0);
    CHECK(se3d_effort_count(a->system, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_effort_set(a->system, (se3d_force){0, 0}, 1.0) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_effort_get(a->system, (se3d_force){0, 0}, &value) == SE3D_ERR_STALE_HANDLE);
}

static void check_tyre(arguments *a, const settable *m)
{
    double values[SE3D_TYRE_VALUES], k = 0.0;
    se3d_tyre_def def = se3d_tyre_def_default();
    se3d_force tyre;
    CHECK(!se3d_system_get_ground(a->system, &def.road));
    def.wheel = a->use.body;
    def.radius = def.k = def.mu = def.slip_stiffness = def.cornering_stiffness = 1.0;
    CHECK(!se3d_force_create_tyre(a->system, &def, &tyre));
    CHECK(!se3d_tyre_get_values(a->system, tyre, 0, SE3D_TYRE_VALUES, values));
    CHECK(!se3d_tyre_get_values(a->system, tyre, SE3D_TYRE_CONTACT_Z, 1, values));
    INVALID(se3d_tyre_get_values(a->system, tyre, SE3D_TYRE_TURN_SLIP, 2, values));
    INVALID(se3d_tyre_get_values(a->system, tyre, SE3D_TYRE_VALUES, 1, values));
    INVALID(se3d_tyre_get_values(a->system, tyre, 0, 0, values));
    INVALID(se3d_tyre_get_values(a->system, tyre, 1, SIZE_MAX, values));
    INVALID(se3d_tyre_get_values(a->system, m->spring, 0, 1, values));
    CHECK(se3d_tyre_get_values(NULL, tyre, 0, 1, values) == SE3D_ERR_NULL);
    CHECK(se3d_tyre_get_values(a->system, tyre, 0, 1, NULL) == SE3D_ERR_NULL);
    CHECK(!se3d_tyre_get_some(a->system, tyre, 1u << (SE3D_TYRE_VALUES - 1), values));
    INVALID(se3d_tyre_get_some(a->system, tyre, 0, values));
    INVALID(se3d_tyre_get_some(a->system, tyre, 1u << SE3D_TYRE_VALUES, values));
    INVALID(se3d_tyre_get_some(a->system, m->spring, 1, values));
    CHECK(se3d_tyre_get_some(NULL, tyre, 1, values) == SE3D_ERR_NULL);
    CHECK(se3d_tyre_get_some(a->system, tyre, 1, NULL) == SE3D_ERR_NULL);
    const se3d_force pair[2] = {tyre, m->spring};
    CHECK(!se3d_tyre_get_several(a->system, 1, pair, 1, values));
    CHECK(!se3d_tyre_get_several(a->system, 0, NULL, 1, NULL));
    INVALID(se3d_tyre_get_several(a->system, 1, pair, 0, values));
    INVALID(se3d_tyre_get_several(a->system, 1, pair, 1u << SE3D_TYRE_VALUES, values));
    INVALID(se3d_tyre_get_several(a->system, 2, pair, 1, values));
    CHECK(se3d_tyre_get_several(NULL, 1, pair, 1, values) == SE3D_ERR_NULL);
    CHECK(se3d_tyre_get_several(a->system, 1, NULL, 1, values) == SE3D_ERR_NULL);
    CHECK(se3d_tyre_get_several(a->system, 1, pair, 1, NULL) == SE3D_ERR_NULL);
    CHECK(!se3d_force_set_parameter(a->system, tyre, SE3D_FORCE_PARAMETER_K, 7.0));
    CHECK(!se3d_force_get_parameter(a->system, tyre, SE3D_FORCE_PARAMETER_K, &k));
    CHECK_NEAR(k, 7.0, 0.0);
    CHECK(!se3d_force_set_parameter(a->system, tyre, SE3D_FORCE_PARAMETER_MU, 0.5));
    INVALID(se3d_force_set_parameter(a->system, tyre, SE3D_FORCE_PARAMETER_MU, 0.0));
    INVALID(se3d_force_set_parameter(a->system, tyre, SE3D_FORCE_PARAMETER_K, 0.0));
    INVALID(se3d_force_set_parameter(a->system, tyre, SE3D_FORCE_PARAMETER_C, -1.0));
    INVALID(se3d_force_set_parameter(a->system, tyre, SE3D_FORCE_PARAMETER_REST, 1.0));
    CHECK(!se3d_force_destroy(a->system, tyre));
    size_t index = 7;
    double c[2] = {-1.0, -1.0};
    se3d_tyre_coefficients_init(NULL, 3);
    se3d_tyre_coefficients_init(c, 1);
    CHECK(c[0] >= 0.0 && c[1] < 0.0);
    CHECK(!se3d_tyre_coefficient_find("PDY1", &index) && index == SE3D_TYRE_PDY1);
    CHECK(se3d_tyre_coefficient_find("PDY", &index) == SE3D_ERR_INVALID_ARGUMENT && index == 0);
    CHECK(se3d_tyre_coefficient_find(NULL, &index) == SE3D_ERR_NULL);
    CHECK(se3d_tyre_coefficient_find("PDY1", NULL) == SE3D_ERR_NULL);
    def.law = SE3D_TYRE_MF61; /* without coefficients */
    INVALID(se3d_force_create_tyre(a->system, &def, &tyre));
    def.coefficient_count = 1;
    CHECK(se3d_force_create_tyre(a->system, &def, &tyre) == SE3D_ERR_NULL);
    def.coefficient_count = SE3D_TYRE_COEFFICIENTS + 1;
    INVALID(se3d_force_create_tyre(a->system, &def, &tyre));
    CHECK(se3d_tyre_get_values(a->system, tyre, 0, 1, values) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_tyre_get_some(a->system, tyre, 1, values) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_tyre_get_several(a->system, 1, pair, 1, values) == SE3D_ERR_STALE_HANDLE);
}

static void check_prescribed(arguments *a)
{
    se3d_function_def def = se3d_function_def_default();
    se3d_function constant;
    CHECK(!se3d_function_create(a->system, &def, &constant));
    CHECK(!se3d_function_set_constant(a->system, constant, 2.0));
    INVALID(se3d_function_set_constant(a->system, constant, (double)NAN));
    INVALID(se3d_function_set_constant(a->system, a->use.function, 2.0)); /* an expression */
    CHECK(se3d_function_set_constant(NULL, constant, 2.0) == SE3D_ERR_NULL);
    CHECK(!se3d_function_destroy(a->system, constant));
    CHECK(se3d_function_set_constant(a->system, constant, 2.0) == SE3D_ERR_STALE_HANDLE);
    CHECK(!se3d_constraint_set_value(a->system, a->use.driver, 0.0));
    CHECK(!se3d_constraint_set_value(a->system, a->use.primitive, 0.0));
    INVALID(se3d_constraint_set_value(a->system, a->use.pin, 0.0));
    INVALID(se3d_constraint_set_value(a->system, a->use.driver, (double)INFINITY));
    CHECK(se3d_constraint_set_value(NULL, a->use.driver, 0.0) == SE3D_ERR_NULL);
    CHECK(se3d_constraint_set_value(a->system, (se3d_constraint){0, 0}, 0.0) ==
          SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_system_touch(NULL) == SE3D_ERR_NULL);
    CHECK(!se3d_system_touch(a->system));
}

static se3d_status setters_reject_misuse(arguments *a)
{
    const settable made = add_settable(a);
    const se3d_force none = {0, 0};
    double K[36] = {0.0}, value[3] = {0.0};
    check_parameters(a, &made);
    check_values(a, &made);
    check_efforts(a, &made);
    check_prescribed(a);
    check_tyre(a, &made);
    CHECK(se3d_force_set_value(a->system, none, value) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_force_get_value(a->system, none, value) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_force_set_parameter(a->system, none, 0, 1.0) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_force_get_parameter(a->system, none, 0, value) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_force_set_bushing(a->system, none, K, K) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_force_get_bushing(a->system, none, K, K) == SE3D_ERR_STALE_HANDLE);
    remove_settable(a, &made);
    return SE3D_OK;
}

#endif
