/* SPDX-License-Identifier: BSD-3-Clause */
/* Callbacks are asked for the times of steps only, so that a pulse may lie between: `step`, where
 * steps are chosen the largest one, finds it in every method. */
#include "support/block_text.h"
#include "support/methods.h"
#include "support/text_model.h"

#define SHORT 1e-3 /* s */

/* 5 N s within 1 ms, after a rest. */
static se3d_status push(void *ctx, double t, const se3d_body_motion motion[2], double wrench[12],
                        double *K, double *D)
{
    const double s = (t - 0.1) / SHORT;
    (void)ctx;
    (void)motion;
    (void)K;
    (void)D;
    memset(wrench, 0, 12 * sizeof *wrench);
    wrench[6] = s > 0.0 && s < 1.0 ? 30.0 / SHORT * s * (1.0 - s) : 0.0;
    return SE3D_OK;
}

static text_model open_with_callback(int32_t method, int32_t formulation, double step)
{
    text_model m = text_model_open(BLOCK OUTPUT, method, formulation, step);
    se3d_force_callback_def def = se3d_force_callback_def_default();
    se3d_force force;
    CHECK(!se3d_system_get_ground(m.system, &def.body_i));
    CHECK(!se3d_body_find(m.system, "a", &def.body_j));
    def.callback = push;
    CHECK(!se3d_force_create_callback(m.system, &def, &force));
    return m;
}

/* A callback is asked for the times of the steps only: a largest step finds its pulse, where steps
 * are chosen, too. */
static void a_largest_step_finds_the_pulse_of_a_callback(void)
{
    for (int32_t run = 0; run < 2 * method_count(); ++run) {
        text_model m = open_with_callback(run / 2, run % 2, 0.2 * SHORT);
        CHECK(text_model_run(&m, 0.12));
        CHECK_NEAR(text_model_get(&m, 0, 0), 2.5, 0.11); /* five of the places of a parabola */
        text_model_close(&m);
    }
}

int main(void)
{
    RUN(a_largest_step_finds_the_pulse_of_a_callback);
    return check_finish();
}
