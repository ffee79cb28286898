/* SPDX-License-Identifier: BSD-3-Clause */
/* Cohesion and adhesion by `convex`, beside closed forms (docs/theory/contact-laws.md) and dop853.
 */
#include "support/text_model.h"

#include <stdio.h>
#include <string.h>

#define STEP 1e-3
#define G    9.81
#define PI   3.1415926535897932

/* A ball of 0.1 m on a block whose top is at 0.1 m, or below it. */
static text_model open_ball(const char *material, const char *law, const char *ball,
                            const char *gravity, int32_t method)
{
    char text[1024];
    (void)snprintf(
        text, sizeof text,
        "se3d: 1\ngravity: %s\nmaterials: [{name: m, density: 1000, friction: 0.5, restitution: "
        "0.5, %s}]\ncontact: {law: %s}\nbodies: [{name: block, fixed: true, shapes: [{type: box, "
        "size: [2, 2, 0.2], material: m}]}, {name: a, %s, shapes: [{type: sphere, radius: 0.1, "
        "material: m}]}]\nanalysis: {type: dynamics, duration: 2}\n"
        "output: [{file: r.csv, channels: [a.position, a.velocity, energy.balance, "
        "contacts.count, energy.dissipated]}]\n",
        gravity, material, law, ball);
    return text_model_open(text, method, SE3D_FORMULATION_AUTO,
                           method == SE3D_METHOD_CONVEX ? STEP : 0.0);
}

/* Up to the pull-off force 3/2 pi adhesion R* it hangs, its spring at E - 2 sqrt(Fc E) = -m g. */
static void a_ball_hangs_up_to_the_pull_off_force(void)
{
    const double weight = 1000.0 * 4.0 / 3.0 * PI * 1e-3 * G, k = 1e6;
    const double adhesion[] = {1.05 * weight / (0.15 * PI), 0.95 * weight / (0.15 * PI)};
    for (int e = 0; e < 2; ++e) {
        char material[128];
        (void)snprintf(material, sizeof material, "stiffness: %.17g, adhesion: %.17g", k,
                       adhesion[e]);
        text_model m = open_ball(material, "hooke", "position: [0, 0, 0.1999]", "[0, 0, -9.81]",
                                 SE3D_METHOD_CONVEX);
        const double pull = 1.5 * PI * adhesion[e] * 0.1;
        CHECK(text_model_run(&m, 0.5)); /* it lies, as deep as adhesion and weight draw it */
        const double root = sqrt(pull) + sqrt(pull + weight);
        CHECK_NEAR((0.2 - text_model_get(&m, 0, 2)) * k / (root * root), 1.0, 1e-6);
        const double up[3] = {0.0, 0.0, G};
        CHECK(!se3d_system_set_gravity(m.system, up));
        const double first = text_model_get(&m, 2, 0);
        CHECK(text_model_run(&m, 1.0));
        if (e == 0) {
            const double held = sqrt(pull) + sqrt(pull - weight);
            CHECK_NEAR((0.2 - text_model_get(&m, 0, 2)) * k / (held * held), 1.0, 1e-6);
            CHECK_NEAR(text_model_get(&m, 3, 0), 1.0, 0.0);
        } else {
            CHECK(text_model_get(&m, 0, 2) > 0.5);
            CHECK_NEAR(text_model_get(&m, 3, 0), 0.0, 0.0);
        }
        CHECK_NEAR(text_model_get(&m, 2, 0), first, 1e-9);
        text_model_close(&m);
    }
}

/* Slow ones stick, fast ones leave with what the way out of the well has left, as by dop853. */
static void what_hits_sticks_or_leaves_as_its_law_says(void)
{
    static const char *const stuff[][2] = {
        {"stiffness: 1.0e+6, adhesion: 100", "hooke"},
        {"young: 1.0e+8, poisson: 0.3, adhesion: 100", "hertz_mindlin"},
        {"stiffness: 1.0e+6, cohesion: 3.0e+5", "hooke"},
        {"stiffness: 2.0e+4, adhesion: 100", "hooke"}};
    static const double speeds[] = {0.02, 0.1, 0.2, 0.6, 2.0};
    int stuck = 0;
    for (size_t k = 0; k < 19; ++k) { /* not the soft one at 2 m/s, which would be too deep */
        char ball[96];
        double seen[2][2];
        (void)snprintf(ball, sizeof ball, "position: [0, 0, 0.2003], velocity: [0, 0, -%g]",
                       speeds[k % 5]);
        for (int e = 0; e < 2; ++e) {
            text_model m = open_ball(stuff[k / 5][0], stuff[k / 5][1], ball, "[0, 0, 0]",
                                     e ? SE3D_METHOD_DOP853 : SE3D_METHOD_CONVEX);
            const double first = text_model_get(&m, 2, 0);
            CHECK(text_model_run(&m, 0.2));
            seen[e][0] = text_model_get(&m, 1, 2);
            seen[e][1] = text_model_get(&m, 4, 0);
            CHECK_NEAR(text_model_get(&m, 2, 0), first, 1e-8);
            text_model_close(&m);
        }
        stuck += fabs(seen[1][0]) < 1e-3;
        CHECK_NEAR(seen[0][0], seen[1][0], 0.002 + 0.005 * speeds[k % 5]);
        CHECK_NEAR(seen[0][1] / seen[1][1], 1.0, 0.01);
    }
    CHECK(stuck > 5 && stuck < 15);
}

/* Friction is capped by what presses, which attraction makes more: a ball on a wall stays. */
static void what_adheres_sticks_sideways(void)
{
    text_model m = open_ball("stiffness: 1.0e+6, adhesion: 400, rolling_friction: 0.9", "hooke",
                             "position: [0, 0, 0.1998]", "[9.81, 0, 0]", SE3D_METHOD_CONVEX);
    CHECK(text_model_run(&m, 0.5));
    const double held = text_model_get(&m, 0, 0);
    CHECK_NEAR(held, 0.0, 1e-3);
    CHECK(text_model_run(&m, 2.0));
    CHECK_NEAR(text_model_get(&m, 0, 0), held, 1e-9);
    text_model_close(&m);
}

/* Boxes that fall on each other and adhere: energy falls, what is dissipated grows. */
static void a_heap_that_adheres_gives_no_energy(void)
{
    char text[4096];
    int used = snprintf(text, sizeof text,
                        "se3d: 1\nmaterials: [{name: m, density: 1000, friction: 0.5, restitution: "
                        "0.2, adhesion: 20, stiffness: 1.0e+6}]\ncontact: {}\nbodies:\n  - {name: "
                        "ground, shapes: [{type: plane, material: m}]}\n");
    for (int k = 0; k < 12; ++k) {
        used += snprintf(text + used, sizeof text - (size_t)used,
                         "  - {name: b%d, position: [%g, %g, %g], angular_velocity: [%d, 1, 0], "
                         "shapes: [{type: box, size: [0.2, 0.16, 0.12], material: m}]}\n",
                         k, 0.21 * (k % 2) + 0.006 * k, 0.18 * (k / 2 % 2) - 0.004 * k,
                         0.2 + 0.25 * (k / 4), k % 3);
    }
    (void)snprintf(text + used, sizeof text - (size_t)used,
                   "analysis: {type: dynamics, duration: 2}\n"
                   "output: [{file: r.csv, channels: [energy.total, energy.dissipated, "
                   "energy.balance, energy.kinetic]}]\n");
    text_model m = text_model_open(text, SE3D_METHOD_AUTO, SE3D_FORMULATION_AUTO, 0.0);
    double total = text_model_get(&m, 0, 0), lost = text_model_get(&m, 1, 0);
    const double first = text_model_get(&m, 2, 0);
    const char *method = "";
    for (int step = 1; step <= 200; ++step) {
        CHECK(text_model_run(&m, 0.01 * step));
        CHECK(text_model_get(&m, 0, 0) < total + 1e-5);
        CHECK(text_model_get(&m, 1, 0) > lost - 1e-5);
        total = text_model_get(&m, 0, 0);
        lost = text_model_get(&m, 1, 0);
    }
    CHECK_NEAR(text_model_get(&m, 2, 0), first, 1e-6);
    CHECK(text_model_get(&m, 3, 0) < 0.1);
    CHECK(!se3d_solver_get_method(m.solver, &method) && strcmp(method, "convex") == 0);
    text_model_close(&m);
}

int main(void)
{
    RUN(a_ball_hangs_up_to_the_pull_off_force);
    RUN(what_hits_sticks_or_leaves_as_its_law_says);
    RUN(what_adheres_sticks_sideways);
    RUN(a_heap_that_adheres_gives_no_energy);
    return check_finish();
}
