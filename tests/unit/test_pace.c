/* SPDX-License-Identifier: BSD-3-Clause */
/* How far a step may go before bodies that do not touch meet. */
#include "contact/bodies/pace.h"
#include "support/scene.h"
#include "system/system_internal.h"

/* With a ball of the radius 0.1 above the ground and its speed upwards. */
static double pace_of(double gap, double speed, double h)
{
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.3, 0.5, 1e6);
    const double r[3] = {0.0, 0.0, 0.1 + gap}, v[3] = {0.0, 0.0, speed};
    (void)scene_floor(&s, 0.0);
    (void)scene_ball(&s, 0.1, 1.0, r, v);
    const double step = se3di_contacts_pace(&s.system->model, SE3DI_PACE_ADAPTIVE, h);
    scene_end(&s);
    return step;
}

/* It may fall at once, from rest too. */
static void what_may_fall_onto_a_floor_within_a_step_shortens_it(void)
{
    for (int k = 0; k < 4; ++k) {
        const double gap = 0.01 * (k + 1), h = 0.1;
        const double fall = gap / sqrt(2.0 * G * gap); /* with the speed that it has then */
        CHECK_NEAR(pace_of(gap, 0.0, h), fall, 0.1 * fall);
        CHECK_NEAR(pace_of(gap, -1.0, h), gap / (1.0 + sqrt(2.0 * G * gap)), 0.1 * fall);
    }
    CHECK_NEAR(pace_of(0.2, 0.0, 0.1), 0.1, 0.0);
    CHECK_NEAR(pace_of(0.2, -1.0, 0.1), 0.1, 0.0);
}

int main(void)
{
    RUN(what_may_fall_onto_a_floor_within_a_step_shortens_it);
    return check_finish();
}
