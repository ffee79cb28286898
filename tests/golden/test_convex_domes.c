/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies that slide over round ones by `convex` at 1 ms: the normal turns as they go, by more in a
 * step than what they press is deep, and yet they press as the law says until they leave. */
#include "support/text_model.h"

#include <string.h>

#define G 9.81

#define DOME(friction, dome, body, start)                                                          \
    "se3d: 1\nmaterials: [{name: m, density: 1000, friction: " friction ", restitution: 0.5, "     \
    "stiffness: 1.0e+7}]\ncontact: {}\nbodies: [{name: ground, shapes: [{" dome ", material: m}]}" \
    ", {name: a, " start ", shapes: [{" body ", material: m}]}]\n"                                 \
    "analysis: {type: dynamics, duration: 1}\n"                                                    \
    "output: [{file: r.csv, channels: [a.contact_force, a.position]}]\n"

#define BALL "type: sphere, radius: 1"

static double size_of(const text_model *m, size_t channel)
{
    double sum = 0.0;
    for (size_t k = 0; k < 3; ++k) {
        const double x = text_model_get(m, channel, k);
        sum += x * x;
    }
    return sqrt(sum);
}

/* A ball of 4.19 kg without friction from 5 degrees beside the top leaves where cos is 2/3 of that
 * there, at 0.9 s; before it presses by m g (3 cos - 2 cos 5 deg). */
static void a_ball_presses_on_a_dome_until_it_leaves(void)
{
    static const char *const text = DOME("0", BALL, "type: sphere, radius: 0.1",
                                         "position: [1.1*sin(5*deg), 0, 1.1*cos(5*deg)]");
    text_model m = text_model_open(text, SE3D_METHOD_CONVEX, SE3D_FORMULATION_AUTO, 1e-3);
    const double weight = 4000.0 / 3.0 * 3.14159265358979 * 1e-3 * G, first = cos(5.0 / 57.29578);
    int rests = 0;
    for (int k = 1; k <= 1100 && text_model_run(&m, 1e-3 * k); ++k) {
        const double height = text_model_get(&m, 1, 2) / size_of(&m, 1), force = size_of(&m, 0);
        if (k > 20 && height > 0.68) {
            CHECK_NEAR(force, weight * (3.0 * height - 2.0 * first), 0.03 * weight);
        }
        if (height < 0.64) {
            CHECK(force == 0.0);
            ++rests;
        }
    }
    CHECK(rests > 20);
    text_model_close(&m);
}

/* Friction, edges that slide, other domes: as by dop853. */
static void what_slides_over_a_dome_presses_as_by_dop853(void)
{
    static const char *const texts[] = {
        DOME("0.2", BALL, "type: sphere, radius: 0.1",
             "position: [0, 0, 1.1], velocity: [2, 0, 0]"),
        DOME("0.2", BALL, "type: box, size: [0.3, 0.2, 0.2]",
             "position: [0, 0, 1.1], velocity: [1.2, 0.2, 0]"),
        DOME("0.1", "type: ellipsoid, semi_axes: [1.5, 1, 0.7]", "type: sphere, radius: 0.1",
             "position: [0, 0, 0.8], velocity: [1, 1, 0]"),
        DOME("0.05",
             "type: cylinder, radius: 1, length: 3, orientation: {axis: [1, 0, 0], "
             "angle: pi/2}",
             "type: sphere, radius: 0.1", "position: [0, 0, 1.1], velocity: [0, 1.5, 0]")};
    for (size_t k = 0; k < sizeof texts / sizeof *texts; ++k) {
        text_model m = text_model_open(texts[k], SE3D_METHOD_CONVEX, SE3D_FORMULATION_AUTO, 1e-3);
        text_model other =
            text_model_open(texts[k], SE3D_METHOD_DOP853, SE3D_FORMULATION_AUTO, 0.0);
        double off = 0.0, force = 0.0;
        for (int step = 1; step <= 200; ++step) {
            CHECK(text_model_run(&m, 1e-3 * step) && text_model_run(&other, 1e-3 * step));
            if (step > 40) {
                off += fabs(size_of(&m, 0) - size_of(&other, 0));
                force += size_of(&other, 0);
            }
        }
        CHECK(force > 0.0 && off < 0.03 * force);
        text_model_close(&m);
        text_model_close(&other);
    }
}

int main(void)
{
    RUN(a_ball_presses_on_a_dome_until_it_leaves);
    RUN(what_slides_over_a_dome_presses_as_by_dop853);
    return check_finish();
}
