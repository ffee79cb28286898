/* SPDX-License-Identifier: BSD-3-Clause */
/* What rests on a heavy body in motion is solved by convex as exactly as on one at rest. */
#include "support/text_model.h"

#include <stdio.h>

/* Three boxes of 10 g on a cart of 10 t that slides on ice, in 2 s: how far the highest has gone
 * aside and how fast it does. */
static void ride(double speed, double *aside, double *rate)
{
    char text[2000], loads[1000];
    int length = 0;
    for (int k = 0; k < 3; ++k) {
        length += snprintf(loads + length, sizeof loads - (size_t)length,
                           ", {name: b%d, mass: 0.01, inertia: [1.6e-5, 1.6e-5, 1.6e-5], position: "
                           "[0.3, 0.2, %g], velocity: [%g, 0, 0], shapes: [{type: box, size: [0.1, "
                           "0.1, 0.1], material: steel}]}",
                           k, 0.25 + 0.1 * k, speed);
    }
    (void)snprintf(
        text, sizeof text,
        "se3d: 1\nmaterials: [{name: ice, density: 1000, friction: 0, stiffness: 1.0e+8, "
        "restitution: 0.1}, {name: steel, density: 1000, friction: 0.5, stiffness: "
        "1.0e+6, restitution: 0.1}]\ncontact: {pairs: [{material_1: ice, material_2: "
        "steel, friction: 0}]}\nbodies: [{name: ground, shapes: [{type: plane, material: "
        "ice}]}, {name: cart, mass: 10000, inertia: [100, 100, 100], position: [0, 0, "
        "0.1], velocity: [%g, 0, 0], shapes: [{type: box, size: [2, 2, 0.2], material: "
        "steel}]}%s]\nanalysis: {type: dynamics, duration: 2}\n"
        "output: [{file: r.csv, channels: [b2.position, b2.velocity]}]\n",
        speed, loads);
    text_model m = text_model_open(text, SE3D_METHOD_CONVEX, SE3D_FORMULATION_AUTO, 1e-3);
    CHECK(text_model_run(&m, 2.0));
    *aside = fabs(text_model_get(&m, 0, 1) - 0.2);
    *rate = fabs(text_model_get(&m, 1, 1));
    text_model_close(&m);
}

static void loads_of_a_fast_body_stay_where_they_are(void)
{
    static const double speeds[3] = {0.0, 3.0, 30.0};
    for (int k = 0; k < 3; ++k) {
        double aside, rate;
        ride(speeds[k], &aside, &rate);
        CHECK(aside < 1e-7);
        CHECK(rate < 1e-6);
    }
}

int main(void)
{
    RUN(loads_of_a_fast_body_stay_where_they_are);
    return check_finish();
}
