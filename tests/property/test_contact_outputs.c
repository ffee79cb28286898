/* SPDX-License-Identifier: BSD-3-Clause */
/* The contact forces that are shown are those of the state that is shown: with the weight they make
 * the acceleration, at whatever times the steps of the method end. */
#include "support/methods.h"
#include "support/text_model.h"

/* A ball comes down aslant, slips and rolls up; a lighter one drops onto it from aside. */
static const char balls[] =
    "se3d: 1\nmaterials: [{name: m, density: 1000, friction: 0.4, restitution: 0.5, stiffness: "
    "2.0e+5}]\ncontact: {law: hooke}\n"
    "bodies:\n  - {name: ground, shapes: [{type: plane, material: m}]}\n"
    "  - {name: a, mass: 2, inertia: [0.02, 0.02, 0.02], position: [0, 0, 0.12], velocity: [1.5, "
    "0, -0.5], shapes: [{type: sphere, radius: 0.1, material: m}]}\n"
    "  - {name: b, mass: 0.5, inertia: [0.002, 0.002, 0.002], position: [0.3, 0.02, 0.3], shapes: "
    "[{type: sphere, radius: 0.08, material: m}]}\n"
    "analysis: {type: dynamics, duration: 0.4}\n"
    "output: [{file: r.csv, channels: [a.acceleration, a.contact_force, b.acceleration, "
    "b.contact_force]}]\n";

static double find_gap(const text_model *m, size_t body, double mass)
{
    double gap = 0.0;
    for (size_t c = 0; c < 3; ++c) {
        const double weight = c == 2 ? 9.81 * mass : 0.0;
        gap = fmax(gap, fabs(mass * text_model_get(m, 2 * body, c) + weight -
                             text_model_get(m, 2 * body + 1, c)));
    }
    return gap;
}

static void contact_forces_are_those_of_the_state_that_is_shown(void)
{
    for (int32_t method = 0; method < method_count(); ++method) {
        for (int32_t formulation = 0; formulation < 2; ++formulation) {
            text_model m = text_model_open(balls, method, formulation, 0.0);
            double worst = 0.0, largest = 0.0;
            for (int k = 1; k <= 57 && text_model_run(&m, 0.007 * k); ++k) {
                worst = fmax(worst, fmax(find_gap(&m, 0, 2.0), find_gap(&m, 1, 0.5)));
                largest = fmax(largest, text_model_get(&m, 1, 2));
            }
            /* impacts of one step lie between the outputs: of convex these show the weight */
            CHECK(largest > (method == SE3D_METHOD_CONVEX ? 19.0 : 50.0));
            CHECK(worst < 1e-7 * largest);
            if (!(worst < 1e-7 * largest)) {
                fprintf(stderr, "%s %d: off by %.2e of %.3g N\n", se3d_method_get_name(method),
                        (int)formulation, worst, largest);
            }
            text_model_close(&m);
        }
    }
}

int main(void)
{
    RUN(contact_forces_are_those_of_the_state_that_is_shown);
    return check_finish();
}
