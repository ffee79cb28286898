/* SPDX-License-Identifier: BSD-3-Clause */
/* Two jaws on prismatic joints squeeze a box and lift it off the floor by friction, by method
 * convex at steps of milliseconds: it goes as the palm does, or stays if the force is too small. */
#include "support/text_model.h"

#include <math.h>

#define UNTIL  3.0
#define HEIGHT 0.04 /* of the box at the start, less what it sinks */
#define WEIGHT (9.81 * 0.32)
#define MU     0.8

static const char text[] =
    "se3d: 1\n"
    "parameters: {squeeze: 20}\n"
    "materials:\n"
    "  - {name: rubber, density: 1000, friction: 0.8, restitution: 0.1, stiffness: 1e6}\n"
    "contact: {law: hooke}\n"
    "bodies:\n"
    "  - {name: ground, shapes: [{type: plane, material: rubber, normal: [0, 0, 1]}]}\n"
    "  - {name: palm, mass: 2, inertia: [0.02, 0.02, 0.02], position: [0, 0, 0.3]}\n"
    "  - {name: left, mass: 0.3, inertia: [0.001, 0.001, 0.001], position: [-0.09, 0, 0.06],\n"
    "     shapes: [{type: box, size: [0.02, 0.06, 0.1], material: rubber}]}\n"
    "  - {name: right, mass: 0.3, inertia: [0.001, 0.001, 0.001], position: [0.09, 0, 0.06],\n"
    "     shapes: [{type: box, size: [0.02, 0.06, 0.1], material: rubber}]}\n"
    "  - {name: part, position: [0, 0, 0.04],\n"
    "     shapes: [{type: box, size: [0.08, 0.05, 0.08], material: rubber}]}\n"
    "joints:\n"
    "  - {name: lift, type: prismatic, body_i: ground, body_j: palm, at: [0, 0, 0.3],\n"
    "     axis: [0, 0, 1]}\n"
    "  - {name: jaw_l, type: prismatic, body_i: palm, body_j: left, at: [-0.09, 0, 0.06],\n"
    "     axis: [1, 0, 0]}\n"
    "  - {name: jaw_r, type: prismatic, body_i: palm, body_j: right, at: [0.09, 0, 0.06],\n"
    "     axis: [-1, 0, 0]}\n"
    "drivers:\n"
    "  - {joint: lift, coordinate: displacement,\n"
    "     value: \"0.1*max(0, t - 0.5)^2/(1 + max(0, t - 0.5))\"}\n"
    "forces:\n"
    "  - {name: squeeze_l, type: effort, joint: jaw_l, value: \"squeeze - 20*qdot\"}\n"
    "  - {name: squeeze_r, type: effort, joint: jaw_r, value: \"squeeze - 20*qdot\"}\n"
    "analysis: {type: dynamics, duration: 3}\n"
    "output:\n"
    "  - {file: g.csv, every: 0.25, channels: [part.position, part.velocity, contacts.count]}\n";

/* The same with another force. */
static void squeeze_with(double force, char *out, size_t size)
{
    const char *at = strstr(text, "20}");
    snprintf(out, size, "%.*s%g%s", (int)(at - text), text, force, at + 2);
}

static void a_box_is_lifted_as_the_palm_is(void)
{
    static const double steps[3] = {1e-3, 2e-3, 5e-3};
    for (int k = 0; k < 3; ++k) {
        text_model m = text_model_open(text, SE3D_METHOD_CONVEX, -1, steps[k]);
        text_model_run(&m, UNTIL);
        const double s = UNTIL - 0.5, lift = 0.1 * s * s / (1.0 + s);
        const double speed = 0.1 * s * (2.0 + s) / ((1.0 + s) * (1.0 + s));
        const double rise = 0.2 / ((1.0 + s) * (1.0 + s) * (1.0 + s)); /* m/s^2 */
        CHECK_NEAR(text_model_get(&m, 0, 2), HEIGHT + lift, 4e-3 * steps[k]);
        CHECK_NEAR(text_model_get(&m, 1, 2), speed, rise * steps[k]);
        CHECK(fabs(text_model_get(&m, 0, 0)) < 1e-9 && fabs(text_model_get(&m, 0, 1)) < 1e-9);
        CHECK_NEAR(text_model_get(&m, 2, 0), 8.0, 0.0);
        text_model_close(&m);
    }
}

/* Friction on both sides carries its weight and 0.2 m/s^2 at the start, or does not. */
static void friction_decides_whether_it_holds(void)
{
    for (int holds = 0; holds < 2; ++holds) {
        char model[sizeof text + 32];
        squeeze_with((holds ? 1.1 : 0.9) * WEIGHT * (1.0 + 0.2 / 9.81) / (2.0 * MU), model,
                     sizeof model);
        text_model m = text_model_open(model, SE3D_METHOD_CONVEX, -1, 1e-3);
        text_model_run(&m, UNTIL);
        const double z = text_model_get(&m, 0, 2);
        CHECK(holds ? z > 0.21 : fabs(z - HEIGHT) < 1e-5);
        text_model_close(&m);
    }
}

int main(void)
{
    RUN(a_box_is_lifted_as_the_palm_is);
    RUN(friction_decides_whether_it_holds);
    return check_finish();
}
