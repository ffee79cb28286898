/* SPDX-License-Identifier: BSD-3-Clause */
/* Scenes with contact that have closed forms: a row of balls. */
#include "support/scene.h"

/* Three equal balls with gaps, the first at 1 m/s: each blow passes on (1 + e)/2 of the speed. */
static void a_row_of_balls_passes_the_blow_on(void)
{
    const double e = 0.9;
    const double expected[3] = {0.5 * (1 - e), 0.25 * (1 - e * e), 0.25 * (1 + e) * (1 + e)};
    scene s = scene_begin(SE3D_LAW_HOOKE, 0.5, e, 1e5);
    se3d_body balls[3];
    CHECK(se3d_system_set_gravity(s.system, scene_zero) == SE3D_OK);
    for (int k = 0; k < 3; ++k) {
        const double r[3] = {0.11 * k, 0.0, 0.0}, v[3] = {k == 0 ? 1.0 : 0.0, 0.0, 0.0};
        balls[k] = scene_ball(&s, 0.05, 0.5, r, v);
    }
    scene_solve(&s, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, 0.0);
    scene_run(&s, 0.1);
    for (int k = 0; k < 3; ++k) {
        double v[3] = {0.0};
        CHECK(se3d_body_get_velocity(s.system, balls[k], v) == SE3D_OK);
        CHECK_NEAR(v[0], expected[k], 1e-3);
    }
    scene_end(&s);
}

int main(void)
{
    RUN(a_row_of_balls_passes_the_blow_on);
    return check_finish();
}
