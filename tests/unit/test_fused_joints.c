/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints evaluated in one pass give the same Jacobian and gamma as term by term. */
#include "assembly/assembly.h"
#include "check.h"
#include "system/system_internal.h"

static void build(se3d_system *system)
{
    uint64_t seed = 77;
    se3d_body bodies[3];
    se3d_constraint joint;
    const double axis[3] = {0.3, -0.5, 0.8};
    CHECK(se3d_system_get_ground(system, &bodies[0]) == SE3D_OK);
    for (int k = 1; k < 3; ++k) {
        se3d_body_def def = se3d_body_def_default();
        double w[3], v[3], p[4], size = 0.0;
        for (int c = 0; c < 4; ++c) {
            p[c] = check_random(&seed);
            size += p[c] * p[c];
        }
        for (int c = 0; c < 4; ++c) {
            def.orientation[c] = p[c] / sqrt(size);
        }
        for (int c = 0; c < 3; ++c) {
            w[c] = 3.0 * check_random(&seed);
            v[c] = check_random(&seed);
            def.position[c] = check_random(&seed);
            def.inertia[c] = 1.0 + 0.2 * c;
        }
        def.mass = 1.0;
        CHECK(se3d_body_create(system, &def, &bodies[k]) == SE3D_OK);
        CHECK(se3d_body_set_velocity(system, bodies[k], v) == SE3D_OK);
        CHECK(se3d_body_set_angular_velocity(system, bodies[k], w) == SE3D_OK);
    }
    for (int k = 0; k < 4; ++k) { /* revolute and spherical, with the ground and between bodies */
        const double at[3] = {0.1 * k, 0.4, -0.2};
        se3d_joint_def def = se3d_joint_def_default();
        def.body_i = bodies[k % 2];
        def.body_j = bodies[k % 2 + 1];
        CHECK(se3d_joint_def_set_frame(system, &def, at, axis, NULL) == SE3D_OK);
        CHECK((k < 2 ? se3d_joint_create_revolute(system, &def, &joint)
                     : se3d_joint_create_spherical(system, &def, &joint)) == SE3D_OK);
    }
}

static void compare(const se3di_formulation *formulation)
{
    se3d_system *system = NULL;
    se3di_assembly assembly;
    double together[16], apart[16], C[200];
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    build(system);
    CHECK(se3di_assembly_init(&assembly, &system->model, formulation, 1, &system->error) ==
          SE3D_OK);
    CHECK(assembly.row_count == 16 && assembly.joint_value_count <= 200);
    se3di_assembly_eval_rows(&assembly, together);
    memcpy(C, assembly.C, assembly.joint_value_count * sizeof *C);
    for (int k = 0; k < 4; ++k) {
        CHECK(assembly.is_fused[k] == 1);
        assembly.is_fused[k] = 0;
    }
    se3di_assembly_eval_jacobian(&assembly);
    se3di_assembly_eval_gamma(&assembly, apart);
    for (int k = 0; k < 16; ++k) {
        CHECK_NEAR(together[k], apart[k], 1e-13);
    }
    for (size_t k = 0; k < assembly.joint_value_count; ++k) {
        CHECK_NEAR(C[k], assembly.C[k], 1e-14);
    }
    se3di_assembly_destroy(&assembly);
    se3d_system_destroy(system);
}

static void one_pass_equals_term_by_term(void)
{
    compare(&se3di_formulation_romega);
    compare(&se3di_formulation_rp_tangent);
}

/* The rows that r-p leaves on the tangent are those of r-omega, by other formulas. */
static void tangent_of_r_p_has_the_equations_of_r_omega(void)
{
    se3d_system *system = NULL;
    se3di_assembly romega, tangent;
    double gamma[16], gamma_p[16];
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    build(system);
    CHECK(se3di_assembly_init(&romega, &system->model, &se3di_formulation_romega, 1,
                              &system->error) == SE3D_OK);
    CHECK(se3di_assembly_init(&tangent, &system->model, &se3di_formulation_rp_tangent, 1,
                              &system->error) == SE3D_OK);
    se3di_assembly_eval_rows(&romega, gamma);
    se3di_assembly_eval_rows(&tangent, gamma_p);
    for (int k = 0; k < 16; ++k) {
        CHECK_NEAR(gamma[k], gamma_p[k], 1e-13);
    }
    for (size_t k = 0; k < romega.joint_value_count; ++k) {
        CHECK_NEAR(romega.C[k], tangent.C[k], 1e-14);
    }
    double b[12], b_p[12];
    CHECK(se3di_assembly_eval_forces(&romega, 0.0, b, &system->error) == SE3D_OK);
    CHECK(se3di_assembly_eval_forces(&tangent, 0.0, b_p, &system->error) == SE3D_OK);
    for (int k = 0; k < 12; ++k) {
        CHECK_NEAR(b[k], b_p[k], 1e-13);
    }
    se3di_assembly_destroy(&romega);
    se3di_assembly_destroy(&tangent);
    se3d_system_destroy(system);
}

int main(void)
{
    RUN(one_pass_equals_term_by_term);
    RUN(tangent_of_r_p_has_the_equations_of_r_omega);
    return check_finish();
}
