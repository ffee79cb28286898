/* SPDX-License-Identifier: BSD-3-Clause */
/* Scenes with contact that have closed forms: a row of balls. */
#include "check.h"
#include "se3d/se3d.h"

/* Three equal balls with gaps, the first at 1 m/s: each blow passes on (1 + e)/2 of the speed. */
static void a_row_of_balls_passes_the_blow_on(void)
{
    const double e = 0.9, none[3] = {0.0, 0.0, 0.0};
    const double expected[3] = {0.5 * (1 - e), 0.25 * (1 - e * e), 0.25 * (1 + e) * (1 + e)};
    se3d_system *system = NULL;
    se3d_material material;
    se3d_body balls[3];
    se3d_solver *solver = NULL;
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    CHECK(se3d_system_set_gravity(system, none) == SE3D_OK);
    se3d_material_def stuff = se3d_material_def_default();
    stuff.density = 1000.0;
    stuff.restitution = e;
    stuff.stiffness = 1e5;
    CHECK(se3d_material_create(system, &stuff, &material) == SE3D_OK);
    for (int k = 0; k < 3; ++k) {
        se3d_body_def def = se3d_body_def_default();
        se3d_shape_def shape = se3d_shape_def_default();
        se3d_shape made;
        def.mass = 0.5;
        def.inertia[0] = def.inertia[1] = def.inertia[2] = 0.4 * 0.5 * 0.0025;
        def.position[0] = 0.11 * k;
        def.velocity[0] = k == 0 ? 1.0 : 0.0;
        CHECK(se3d_body_create(system, &def, &balls[k]) == SE3D_OK);
        shape.body = balls[k];
        shape.material = material;
        shape.radius = 0.05;
        CHECK(se3d_shape_create_sphere(system, &shape, &made) == SE3D_OK);
    }
    se3d_solver_def def = se3d_solver_def_default();
    def.method = SE3D_METHOD_DOP853;
    CHECK(se3d_solver_create(system, &def, &solver) == SE3D_OK);
    CHECK(se3d_solver_run(solver, 0.1) >= 0);
    for (int k = 0; k < 3; ++k) {
        double v[3] = {0.0};
        CHECK(se3d_body_get_velocity(system, balls[k], v) == SE3D_OK);
        CHECK_NEAR(v[0], expected[k], 1e-3);
    }
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
}

int main(void)
{
    RUN(a_row_of_balls_passes_the_blow_on);
    return check_finish();
}
