/* SPDX-License-Identifier: BSD-3-Clause */
/* What acts for a short time only, after a long rest in which steps grow, is not stepped over, in
 * any method. */
#include "support/block_text.h"
#include "support/methods.h"
#include "support/text_model.h"

/* 5 N s in a tenth of a second, and in a hundredth. */
static const char *const pushes[] = {
    BLOCK "forces: [{type: force, body: a, value: [\"if(abs(t - 4) < 0.05, 100*cos(10*pi*(t - "
          "4))^2, 0)\", 0, 0]}]\n" OUTPUT,
    BLOCK "forces: [{type: force, body: a, value: [\"if(abs(t - 4) < 0.005, 1000*cos(100*pi*(t - "
          "4))^2, 0)\", 0, 0]}]\n" OUTPUT,
};

/* Every method in one formulation at least: the even ones in one, the odd ones in the other. */
static int is_wanted(int32_t run)
{
    return check_is_long() || run % 2 == run / 2 % 2;
}

static void a_push_of_a_moment_is_not_stepped_over(void)
{
    for (size_t k = 0; k < sizeof pushes / sizeof *pushes; ++k) {
        for (int32_t run = 0; run < 2 * method_count(); ++run) {
            if (!is_wanted(run)) {
                continue;
            }
            const int is_equal = run / 2 == SE3D_METHOD_RATTLE || run / 2 == SE3D_METHOD_VERLET;
            text_model m = text_model_open(pushes[k], run / 2, run % 2, k && is_equal ? 1e-4 : 0.0);
            CHECK(text_model_run(&m, 6.0));
            CHECK_NEAR(text_model_get(&m, 0, 0), 2.5, 1e-3);
            CHECK_NEAR(text_model_get(&m, 1, 0), 5.0, 2e-3);
            text_model_close(&m);
        }
    }
}

/* A pendulum hangs from a cart that is driven forth and back within a tenth of a second: it swings
 * with what short steps say. */
static void a_driver_that_moves_for_a_moment_is_not_stepped_over(void)
{
    static const char text[] =
        "se3d: 1\nbodies:\n  - {name: cart, mass: 1, inertia: [1, 1, 1]}\n"
        "  - {name: a, mass: 1, inertia: [0.01, 0.01, 0.01], position: [0, 0, -0.5]}\n"
        "joints:\n"
        "  - {name: s, type: prismatic, body_i: ground, body_j: cart, at: [0, 0, 0], axis: [1, 0, "
        "0]}\n"
        "  - {name: pin, type: revolute, body_i: cart, body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}\n"
        "drivers: [{joint: s, value: \"if(abs(t - 4) < 0.05, 0.1*cos(10*pi*(t - 4))^4, "
        "0)\"}]\n" OUTPUT;
    text_model m = text_model_open(text, SE3D_METHOD_DOP853, -1, 1e-3);
    CHECK(text_model_run(&m, 4.7));
    const double v = text_model_get(&m, 0, 0);
    CHECK(fabs(v) > 0.03);
    text_model_close(&m);
    for (int32_t run = 0; run < 2 * method_count(); ++run) {
        const int is_verlet = run / 2 == SE3D_METHOD_VERLET; /* steps as rattle does: 6 s */
        if (!is_wanted(run) || (is_verlet && !check_is_long())) {
            continue;
        }
        m = text_model_open(text, run / 2, run % 2, 0.0);
        CHECK(text_model_run(&m, 4.7));
        /* steps of convex are equal: of 1 ms, and their error is not estimated */
        CHECK_NEAR(text_model_get(&m, 0, 0), v,
                   (run / 2 == SE3D_METHOD_CONVEX ? 5e-3 : 2e-3) * fabs(v));
        text_model_close(&m);
    }
}

int main(void)
{
    RUN(a_push_of_a_moment_is_not_stepped_over);
    RUN(a_driver_that_moves_for_a_moment_is_not_stepped_over);
    return check_finish();
}
