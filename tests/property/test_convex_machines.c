/* SPDX-License-Identifier: BSD-3-Clause */
/* Machines by `convex` at steps of milliseconds: stops of any stiffness that bounce and hold, the
 * account of energy with stops and drivers; machines side by side. */
#include "support/text_model.h"

#include <stdio.h>

#define STEP 1e-3

/* `before`, the stiffness and restitution of a stop, `after`. */
static text_model open_text(const char *before, double k, double e, const char *after)
{
    char text[2048];
    (void)snprintf(text, sizeof text, "%s, k: %.17g, restitution: %g%s", before, k, e, after);
    return text_model_open(text, SE3D_METHOD_CONVEX, SE3D_FORMULATION_AUTO, STEP);
}

static const double stiffness[] = {1e4, 1e6, 1e9};

/* 2 kg fall by 1 m along a rail, 4.43 m/s, and come to rest m g / k beyond. */
static void what_falls_onto_a_stop_bounces_and_comes_to_rest(void)
{
    static const char *const before_stop =
        "se3d: 1\nbodies: [{name: b, mass: 2, inertia: [1, 1, 1], position: [0, 0, 1]}]\n"
        "joints: [{name: s, type: prismatic, body_i: ground, body_j: b, at: [0, 0, 1], axis: [0, "
        "0, 1]}]\n"
        "forces: [{name: f, type: stop, joint: s, lower: -1";
    static const char *const after_stop =
        "}]\nanalysis: {type: dynamics, duration: 4}\n"
        "output: [{file: r.csv, channels: [s.displacement, s.rate, energy.balance, f.force, "
        "s.force, b.acceleration]}]\n";
    for (size_t k = 0; k < 3; ++k) {
        text_model m = open_text(before_stop, stiffness[k], 0.5, after_stop);
        double before = 0.0, after = 0.0, worst = 0.0;
        for (int step = 1; step <= 4000; ++step) {
            CHECK(text_model_run(&m, STEP * step));
            const double v = text_model_get(&m, 1, 0);
            before = fmin(before, v);
            after = fmax(after, v);
            worst = fmax(worst, fabs(text_model_get(&m, 2, 0) - 2.0 * 9.81));
            if (k > 0) {
                CHECK(text_model_get(&m, 0, 0) > -1.0 - 1e-4);
            }
        }
        CHECK_NEAR(-before / sqrt(2.0 * 9.81), 1.0, 0.01);
        CHECK_NEAR(after / -before, k > 0 ? 0.5 : 0.4734, k > 0 ? 0.005 : 2e-3); /* as dop853 */
        CHECK_NEAR((-1.0 - text_model_get(&m, 0, 0)) * stiffness[k] / (2.0 * 9.81), 1.0, 1e-6);
        CHECK_NEAR(fabs(text_model_get(&m, 3, 0)) / (2.0 * 9.81), 1.0, 1e-6);
        CHECK_NEAR(text_model_get(&m, 5, 2), 0.0, 1e-5);
        CHECK(worst < 1e-3);
        text_model_close(&m);
    }
}

/* 2 kg that meet a stop at 4.43 m/s: the speed at which they leave it. */
static double leave_stop(int32_t method, double k, double e)
{
    char text[1024];
    double after = 0.0;
    (void)snprintf(text, sizeof text,
                   "se3d: 1\nbodies: [{name: b, mass: 2, inertia: [1, 1, 1], velocity: [0, 0, "
                   "-4.43], position: [0, 0, 5e-4]}]\n"
                   "joints: [{name: s, type: prismatic, body_i: ground, body_j: b, at: [0, 0, "
                   "5e-4], axis: [0, 0, 1]}]\n"
                   "forces: [{name: f, type: stop, joint: s, lower: -5e-4, k: %g, restitution: "
                   "%g}]\nanalysis: {type: dynamics, duration: 0.1%s}\n"
                   "output: [{file: r.csv, channels: [s.rate]}]\n",
                   k, e, method == SE3D_METHOD_CONVEX ? "" : ", tolerance: 1.0e-9");
    text_model m = text_model_open(text, method, SE3D_FORMULATION_AUTO,
                                   method == SE3D_METHOD_CONVEX ? STEP : 0.0);
    for (int step = 1; step <= 100; ++step) {
        CHECK(text_model_run(&m, STEP * step));
        after = fmax(after, text_model_get(&m, 0, 0));
    }
    text_model_close(&m);
    return after;
}

/* In 12 to 44 steps: what a stop gives back, of all it takes, is that of the law. */
static void what_soft_stops_give_back_is_that_of_the_law(void)
{
    static const double given[] = {0.02, 0.05, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0};
    static const double soft[] = {1e4, 4e4, 1.3e5};
    for (size_t k = 0; k < 24; ++k) {
        const double stiff = soft[k / 8], e = given[k % 8];
        const double law = leave_stop(SE3D_METHOD_DOP853, stiff, e);
        CHECK_NEAR(leave_stop(SE3D_METHOD_CONVEX, stiff, e), law, (e < 0.05 ? 0.02 : 0.01) * law);
    }
}

/* A door that a spring of 3 N m shuts onto its stop: 3 N m there, too. */
static void an_angle_stays_within_its_range(void)
{
    static const char *const before_stop =
        "se3d: 1\ngravity: [0, 0, 0]\n"
        "bodies: [{name: d, mass: 5, inertia: [0.2, 0.2, 0.4], position: [0.4, 0, 0]}]\n"
        "joints: [{name: h, type: revolute, body_i: ground, body_j: d, at: [0, 0, 0], axis: [0, 0, "
        "1]}]\n"
        "forces: [{name: f, type: stop, joint: h, upper: 0.7";
    static const char *const after_stop =
        "}, {name: s, type: effort, joint: h, value: 3}]\n"
        "analysis: {type: dynamics, duration: 8}\n"
        "output: [{file: r.csv, channels: [h.angle, h.rate, energy.balance, f.force]}]\n";
    for (size_t k = 0; k < 3; ++k) {
        text_model m = open_text(before_stop, stiffness[k], 0.4, after_stop);
        double before = 0.0, after = 0.0, worst = 0.0;
        for (int step = 1; step <= 8000; ++step) {
            CHECK(text_model_run(&m, STEP * step));
            before = fmax(before, text_model_get(&m, 1, 0));
            after = fmin(after, text_model_get(&m, 1, 0));
            worst = fmax(worst, fabs(text_model_get(&m, 2, 0)));
        }
        const double speed = sqrt(2.0 * 3.0 * 0.7 / (0.4 + 5.0 * 0.16));
        CHECK_NEAR(before / speed, 1.0, 0.01);
        CHECK_NEAR(-after / before, 0.4, 0.02);
        CHECK_NEAR((text_model_get(&m, 0, 0) - 0.7) * stiffness[k] / 3.0, 1.0, 1e-5);
        CHECK_NEAR(fabs(text_model_get(&m, 3, 0)) / 3.0, 1.0, 1e-5);
        CHECK(worst < 1e-3);
        text_model_close(&m);
    }
}

/* A weight of little inertia on an arm of 1 m, which is what the stop feels, falls from level to
 * hanging; one that gives all back neither gains nor loses height. */
static void what_swings_onto_a_stop_is_as_heavy_as_its_arm_makes_it(void)
{
    static const char *const before_stop =
        "se3d: 1\nbodies: [{name: b, mass: 2, inertia: [8e-5, 8e-5, 8e-5], position: [1, 0, 0]}]\n"
        "joints: [{name: s, type: revolute, body_i: ground, body_j: b, at: [0, 0, 0], axis: [0, 1, "
        "0]}]\nforces: [{name: f, type: stop, joint: s, upper: pi/2";
    static const char *const after_stop =
        "}]\nanalysis: {type: dynamics, duration: 30}\n"
        "output: [{file: r.csv, channels: [s.rate, energy.total]}]\n";
    static const double restitution[] = {1.0, 0.9, 0.5};
    const double speed = sqrt(2.0 * 9.81);
    for (size_t k = 0; k < 6; ++k) {
        const double e = restitution[k / 2];
        text_model m = open_text(before_stop, k % 2 ? 1e3 : 1e7, e, after_stop);
        double after = 0.0, most = 0.0;
        for (int step = 1; step <= 30000; ++step) {
            CHECK(text_model_run(&m, STEP * step));
            after = fmin(after, text_model_get(&m, 0, 0));
            most = fmax(most, text_model_get(&m, 1, 0));
        }
        CHECK_NEAR(-after / speed, e, k % 2 ? 0.02 : 0.002);
        CHECK(most < (k % 2 ? 1.0 : 0.001)); /* of 19.6 J */
        CHECK(fabs(text_model_get(&m, 0, 0)) < 1.01 * speed * pow(e, 10.0));
        text_model_close(&m);
    }
}

/* What is driven over its stop feels the law, and what nothing can move has no part in energy. */
static void what_is_driven_over_its_stop_feels_the_law(void)
{
    static const char *const before_stop =
        "se3d: 1\ngravity: [0, 0, 0]\n"
        "bodies: [{name: b, mass: 1, inertia: [1, 1, 1]}, {name: wall, fixed: true, position: [0, "
        "0, 2]}]\n"
        "joints: [{name: s, type: prismatic, body_i: ground, body_j: b, at: [0, 0, 0], axis: [1, "
        "0, 0]}]\ndrivers: [{name: d, joint: s, value: t}]\n"
        "forces: [{name: w, type: stop, body_i: ground, body_j: wall, upper: 1, k: 1e5}, {name: f, "
        "type: stop, joint: s, upper: 0.1";
    static const char *const after_stop =
        "}]\nanalysis: {type: dynamics, duration: 0.3}\n"
        "output: [{file: r.csv, channels: [d.effort, energy.balance, energy.dissipated]}]\n";
    text_model m = open_text(before_stop, 1e5, 1.0, after_stop);
    double most = 0.0, open = 0.0;
    for (int step = 1; step <= 150; ++step) {
        CHECK(text_model_run(&m, STEP * step));
        most = fmax(most, fabs(text_model_get(&m, 0, 0)));
        open = fmax(open, fabs(text_model_get(&m, 1, 0) - 5e4 - 0.5));
    }
    CHECK_NEAR(most / (1e5 * 0.05), 1.0, 0.03);
    CHECK(open < 10.0); /* of 125 J */
    CHECK(fabs(text_model_get(&m, 2, 0)) < 10.0);
    text_model_close(&m);
}

/* A string to the ground, and one from ball to ball, without any joint. */
static void what_hangs_on_strings_pulls_them_tight(void)
{
    static const char *const before_stop =
        "se3d: 1\nbodies: [{name: a, mass: 1, inertia: [0.01, 0.01, 0.01], position: [0, 0, "
        "-0.2]}, {name: b, mass: 2, inertia: [0.01, 0.01, 0.01], position: [0, 0, -0.4]}]\n"
        "forces: [{name: f, type: stop, body_i: ground, body_j: a, upper: 0.5";
    static const char *const after_stop =
        "}, {name: g, type: stop, body_i: a, body_j: b, upper: 0.3, k: 1e6, "
        "restitution: 0.1}]\n"
        "analysis: {type: dynamics, duration: 3}\n"
        "output: [{file: r.csv, channels: [a.position, b.position, energy.balance, "
        "b.acceleration, a.acceleration]}]\n";
    for (size_t k = 0; k < 3; ++k) {
        text_model m = open_text(before_stop, stiffness[k], 0.1, after_stop);
        CHECK(text_model_run(&m, 3.0));
        const double low = -text_model_get(&m, 0, 2), lower = -text_model_get(&m, 1, 2);
        CHECK_NEAR((low - 0.5) * stiffness[k] / (3.0 * 9.81), 1.0, 1e-5);
        CHECK_NEAR((lower - low - 0.3) * 1e6 / (2.0 * 9.81), 1.0, 1e-5);
        CHECK_NEAR(text_model_get(&m, 3, 2), 0.0, 1e-4);
        CHECK_NEAR(text_model_get(&m, 4, 2), 0.0, 1e-4);
        text_model_close(&m);
    }
}

/* A figure of four parts whose joints have ranges falls down: what hits one part drives others
 * onto their stops. No energy comes from them. */
static const char figure[] =
    "se3d: 1\nmaterials: [{name: m, density: 1000, stiffness: 1.0e+6, restitution: 0.2}]\n"
    "contact: {}\n"
    "bodies: [{name: ground, shapes: [{type: plane, material: m}]},\n"
    "  {name: a, position: [0, 0, 1.2], angular_velocity: [0.4, 0.9, 0], shapes: [{type: capsule, "
    "radius: 0.1, length: 0.3, material: m}]},\n"
    "  {name: b, position: [0, 0, 0.75], shapes: [{type: capsule, radius: 0.07, length: 0.3, "
    "material: m}]},\n"
    "  {name: c, position: [0, 0, 0.35], shapes: [{type: capsule, radius: 0.05, length: 0.3, "
    "material: m}]},\n"
    "  {name: d, position: [0, 0, 1.55], shapes: [{type: sphere, radius: 0.09, material: m}]}]\n"
    "joints: [{name: hip, type: revolute, body_i: a, body_j: b, at: [0, 0, 0.95], axis: [0, 1, "
    "0]},\n"
    "  {name: knee, type: revolute, body_i: b, body_j: c, at: [0, 0, 0.55], axis: [0, 1, 0]},\n"
    "  {name: neck, type: revolute, body_i: a, body_j: d, at: [0, 0, 1.45], axis: [1, 0, 0]}]\n"
    "forces: [{name: hs, type: stop, joint: hip, lower: -0.9, upper: 0.2, k: 1.0e+5, restitution: "
    "0.1},\n"
    "  {name: ks, type: stop, joint: knee, lower: -0.02, upper: 1.9, k: 1.0e+5, restitution: "
    "0.1},\n"
    "  {name: ns, type: stop, joint: neck, lower: -0.4, upper: 0.4, k: 1.0e+5, restitution: 0.1}]\n"
    "analysis: {type: dynamics, duration: 2}\n"
    "output: [{file: r.csv, channels: [energy.total, hip.angle, knee.angle, neck.angle, "
    "contacts.count, energy.balance]}]\n";

/* A cloth that is drawn from under a box faster and faster, beside a wheel that starts: what their
 * own inertia takes of the drivers is counted, too, though half of it acts across the constraints
 * at the ends of steps. */
static void what_drivers_speed_up_by_themselves_is_counted(void)
{
    static const char *const text =
        "se3d: 1\nmaterials: [{name: m, density: 1000, stiffness: 1.0e+6, friction: 0.3}]\n"
        "contact: {}\ngravity: [0, 0, -9.81]\n"
        "bodies: [{name: c, mass: 2, inertia: [0.1, 0.1, 0.1], shapes: [{type: box, size: [2, 1, "
        "0.02], material: m}]}, {name: b, position: [0, 0, 0.06], shapes: [{type: box, size: [0.1, "
        "0.1, 0.1], material: m}]}, {name: w, mass: 1, inertia: [0.2, 0.2, 0.2], position: [0, 3, "
        "0]}]\n"
        "joints: [{name: p, type: prismatic, body_i: ground, body_j: c, at: [0, 0, 0], axis: [1, "
        "0, 0]}, {name: r, type: revolute, body_i: ground, body_j: w, at: [0, 3, 0], axis: [0, 0, "
        "1]}]\ndrivers: [{joint: p, value: \"5*t^2\"}, {joint: r, value: \"10*(t - 0.1*(1 - "
        "exp(-t/0.1)))\"}]\nanalysis: {type: dynamics, duration: 0.4}\n"
        "output: [{file: r.csv, channels: [energy.balance]}]\n";
    text_model m = text_model_open(text, SE3D_METHOD_CONVEX, -1, STEP);
    const double first = text_model_get(&m, 0, 0);
    for (int k = 1; k <= 40 && text_model_run(&m, 0.01 * k); ++k) {
        CHECK_NEAR(text_model_get(&m, 0, 0), first, 0.05); /* of 19 J in the end */
    }
    text_model_close(&m);
}

static void a_figure_falls_down_within_the_ranges_of_its_joints(void)
{
    static const double range[3][2] = {{-0.9, 0.2}, {-0.02, 1.9}, {-0.4, 0.4}};
    text_model m = text_model_open(figure, SE3D_METHOD_CONVEX, SE3D_FORMULATION_AUTO, STEP);
    double beyond = 0.0, most = 0.0, last;
    CHECK(text_model_run(&m, STEP));
    last = text_model_get(&m, 0, 0);
    const double first = last;
    for (int step = 2; step <= 2500; ++step) {
        CHECK(text_model_run(&m, STEP * step));
        const double energy = text_model_get(&m, 0, 0);
        most = fmax(most, energy - last);
        last = energy;
        for (size_t k = 0; k < 3; ++k) {
            const double angle = text_model_get(&m, 1 + k, 0);
            beyond = fmax(beyond, fmax(range[k][0] - angle, angle - range[k][1]));
        }
    }
    CHECK(beyond < 0.02);
    CHECK(most < 1e-4 * first);
    CHECK(last < 0.3 * first);
    CHECK(text_model_get(&m, 4, 0) >= 2.0);
    text_model_close(&m);
}

/* A disc on a shaft beside its middle lifts a slide that a spring presses on it. What the shaft is
 * driven with beside a contact is counted by the impulses of the step: the account of energy that
 * is open after a turn is as open after eight. */
static void what_a_cam_is_driven_with_is_counted(void)
{
    static const char *const cam =
        "se3d: 1\nmaterials: [{name: s, density: 2000, stiffness: 1.0e+6, restitution: 0.1, "
        "friction: 0.2}]\ncontact: {}\n"
        "bodies: [{name: disc, position: [0.02, 0, 0], shapes: [{type: cylinder, radius: 0.06, "
        "length: 0.03, orientation: {axis: [1, 0, 0], angle: 90*deg}, material: s}]},\n"
        "  {name: slide, position: [0, 0, 0.1101], shapes: [{type: box, size: [0.08, 0.04, 0.1], "
        "material: s}]}]\n"
        "joints: [{name: j, type: revolute, body_i: ground, body_j: disc, at: [0, 0, 0], axis: "
        "[0, 1, 0]},\n"
        "  {name: k, type: prismatic, body_i: ground, body_j: slide, at: [0, 0, 0.1], axis: [0, 0, "
        "1]}]\n"
        "drivers: [{name: m, joint: j, value: 2*pi*t}]\n"
        "forces: [{name: f, type: tsda, body_i: ground, body_j: slide, point_i: [0, 0, 0.4], "
        "point_j: [0, 0, 0], k: 300, l0: 0.4}]\n"
        "analysis: {type: dynamics, duration: 9}\n"
        "output: [{file: r.csv, channels: [energy.balance, work.drivers]}]\n";
    text_model m = text_model_open(cam, SE3D_METHOD_CONVEX, SE3D_FORMULATION_AUTO, STEP);
    CHECK(text_model_run(&m, 1.0));
    const double once = text_model_get(&m, 0, 0), work = text_model_get(&m, 1, 0);
    CHECK(text_model_run(&m, 8.0));
    CHECK(work > 1.0);
    CHECK_NEAR(text_model_get(&m, 1, 0) / work, 8.0, 1.0);
    CHECK_NEAR(text_model_get(&m, 0, 0), once, 1e-4);
    text_model_close(&m);
}

/* Legs of two parts with a range, which fall over: `count` from number `first` on; and a ball on
 * the plane, so that steps are those in which something touches from the beginning. */
static text_model open_legs(int first, int count)
{
    char text[8192];
    int n = snprintf(text, sizeof text,
                     "se3d: 1\nmaterials: [{name: m, density: 1000, stiffness: 1.0e+6, friction: "
                     "0.5, restitution: 0.1}]\ncontact: {}\nbodies:\n"
                     "  - {name: ground, shapes: [{type: plane, material: m}]}\n"
                     "  - {name: ball, position: [-5, 0, 0.0999], shapes: [{type: sphere, "
                     "radius: 0.1, material: m}]}\n");
    for (int pass = 0; pass < 3; ++pass) {
        n += snprintf(text + n, sizeof text - (size_t)n, "%s",
                      pass == 0   ? ""
                      : pass == 1 ? "joints:\n"
                                  : "forces:\n");
        for (int k = first; k < first + count; ++k) {
            const double x = 2.0 * k, z = 0.5 + 0.05 * k;
            char *end = text + n;
            const size_t room = sizeof text - (size_t)n;
            n += pass == 0
                     ? snprintf(end, room,
                                "  - {name: u%d, position: [%g, 0, %g], angular_velocity: [0, %g, "
                                "0], shapes: [{type: capsule, radius: 0.05, length: 0.3, material: "
                                "m}]}\n  - {name: l%d, position: [%g, 0, %g], shapes: [{type: "
                                "capsule, radius: 0.04, length: 0.3, material: m}]}\n",
                                k, x, z + 0.4, 1.0 + 0.3 * k, k, x, z)
                 : pass == 1
                     ? snprintf(end, room,
                                "  - {name: j%d, type: revolute, body_i: u%d, body_j: l%d, at: "
                                "[%g, 0, %g], axis: [0, 1, 0]}\n",
                                k, k, k, x, z + 0.2)
                     : snprintf(end, room,
                                "  - {name: s%d, type: stop, joint: j%d, lower: -0.1, upper: 1.2, "
                                "k: 1.0e+5, restitution: 0.1}\n",
                                k, k);
        }
    }
    n += snprintf(text + n, sizeof text - (size_t)n,
                  "analysis: {type: dynamics, duration: 2}\noutput: [{file: r.csv, channels: [");
    for (int k = first; k < first + count; ++k) {
        n += snprintf(text + n, sizeof text - (size_t)n, "%su%d.position, l%d.position",
                      k > first ? ", " : "", k, k);
    }
    (void)snprintf(text + n, sizeof text - (size_t)n, "]}]\n");
    return text_model_open(text, SE3D_METHOD_CONVEX, SE3D_FORMULATION_AUTO, STEP);
}

/* Each machine is a problem of its own: together they take the iterations that they take one by
 * one, and move as they do alone. */
static void machines_that_do_not_touch_are_solved_apart(void)
{
    enum { LEGS = 3 };
    double alone[LEGS][2][3];
    uint64_t iterations = 0;
    se3d_solver_stats stats;
    for (int k = 0; k < LEGS; ++k) {
        text_model m = open_legs(k, 1);
        CHECK(text_model_run(&m, 0.6));
        for (size_t part = 0; part < 6; ++part) {
            alone[k][part / 3][part % 3] = text_model_get(&m, part / 3, part % 3);
        }
        CHECK(!se3d_solver_get_stats(m.solver, &stats));
        iterations += stats.iterations;
        text_model_close(&m);
    }
    text_model m = open_legs(0, LEGS);
    CHECK(text_model_run(&m, 0.6));
    for (size_t k = 0; k < LEGS; ++k) {
        for (size_t part = 0; part < 6; ++part) {
            const double together = text_model_get(&m, 2 * k + part / 3, part % 3);
            CHECK_NEAR(together, alone[k][part / 3][part % 3], 1e-9);
        }
        CHECK(alone[k][1][2] < 0.2); /* it has hit the plane */
    }
    CHECK(!se3d_solver_get_stats(m.solver, &stats));
    CHECK_NEAR((double)stats.iterations / (double)iterations, 1.0, 0.02); /* the ball's are few */
    text_model_close(&m);
}

/* A double pendulum with friction and a stop, a weight on a spring, a top that flies; a ball that
 * lies somewhere else. */
static text_model open_flight(int with_ball)
{
    char text[4096];
    (void)snprintf(
        text, sizeof text,
        "se3d: 1\nmaterials: [{name: m, density: 1000, stiffness: 1.0e+6, friction: 0.5}]\n"
        "contact: {}\nbodies:\n"
        "  - {name: ground, shapes: [{type: plane, material: m}]}\n"
        "  - {name: a, position: [0.5, 0, 2], mass: 1, inertia: [0.01, 0.02, 0.03]}\n"
        "  - {name: b, position: [1.5, 0, 2], mass: 1, inertia: [0.01, 0.02, 0.03]}\n"
        "  - {name: s, position: [3, 0, 2], mass: 2, inertia: [0.1, 0.2, 0.3]}\n"
        "  - {name: f, position: [5, 0, 9], mass: 2, inertia: [0.1, 0.2, 0.3], angular_velocity: "
        "[3, 8, 2]}\n%s"
        "joints:\n"
        "  - {name: p, type: revolute, body_i: ground, body_j: a, at: [0, 0, 2], axis: [0, 1, 0]}\n"
        "  - {name: q, type: revolute, body_i: a, body_j: b, at: [1, 0, 2], axis: [0, 1, 0]}\n"
        "forces:\n"
        "  - {name: k, type: tsda, body_i: ground, body_j: s, at: [3, 0, 3], at_2: [3, 0, 2], k: "
        "100, c: 0.1, l0: 0.7}\n"
        "  - {name: r, type: friction, joint: p, mu: 0.1, radius: 0.05}\n"
        "  - {name: t, type: stop, joint: q, lower: -2, upper: 2, k: 1.0e+4, restitution: 0.5}\n"
        "analysis: {type: dynamics, duration: 2}\noutput: [{file: r.csv, channels: [a.position, "
        "b.position, s.position, f.position, f.orientation, s.acceleration, k.force]}]\n",
        with_ball ? "  - {name: c, position: [-5, 0, 0.0999], shapes: [{type: sphere, radius: 0.1, "
                    "material: m}]}\n"
                  : "");
    return text_model_open(text, SE3D_METHOD_CONVEX, SE3D_FORMULATION_AUTO, STEP);
}

/* To the bit, whatever touches elsewhere. */
static void what_nothing_touches_moves_as_it_does_alone(void)
{
    static const size_t counts[] = {3, 3, 3, 3, 4};
    text_model alone = open_flight(0), together = open_flight(1);
    for (int step = 1; step <= 1000; ++step) {
        CHECK(text_model_run(&alone, STEP * step));
        CHECK(text_model_run(&together, STEP * step));
        for (size_t k = 0; k < sizeof counts / sizeof *counts; ++k) {
            for (size_t part = 0; part < counts[k]; ++part) {
                const double is = text_model_get(&together, k, part);
                CHECK(is == text_model_get(&alone, k, part)); /* NOLINT */
            }
        }
    }
    text_model_close(&alone);
    text_model_close(&together);
}

/* Forces of contacts press on the bodies that touch. */
static void what_touches_pushes_no_other_body(void)
{
    text_model m = open_flight(1);
    for (int step = 1; step <= 100; ++step) {
        CHECK(text_model_run(&m, STEP * step));
        CHECK_NEAR(text_model_get(&m, 5, 2), -9.81 + 0.5 * text_model_get(&m, 6, 0), 1e-9);
    }
    text_model_close(&m);
}

/* A ball on a rail is driven at 0.1 m/s against a wall, and another one before it, or is too heavy
 * to be stopped by that. Forces are those of the overlaps. */
static void what_is_driven_against_what_cannot_give_way_feels_the_law(void)
{
    static const char *const movers[2] = {"mass: 0.5, inertia: [1e-3, 1e-3, 1e-3]",
                                          "mass: 1.0e+7, inertia: [1e5, 1e5, 1e5], "
                                          "velocity: [0.1, 0, 0]"};
    static const char *const rails[2] = {
        "joints: [{name: s, type: prismatic, body_i: ground, body_j: a, at: [0, 0, 0], axis: [1, "
        "0, 0]}]\ndrivers: [{name: d, joint: s, value: 0.1*t}]\n",
        ""};
    for (int k = 0; k < 3; ++k) {
        const int jams = k > 0, is_free = k > 1;
        char text[2048];
        (void)snprintf(
            text, sizeof text,
            "se3d: 1\ngravity: [0, 0, 0]\nmaterials: [{name: m, density: 1000, stiffness: 1.0e+6, "
            "friction: 0.3, restitution: 0.3}]\ncontact: {}\nbodies:\n"
            "  - {name: wall, fixed: true, position: [%g, 0, 0], shapes: [{type: box, size: [0.1, "
            "0.2, 0.2], material: m}]}\n"
            "  - {name: a, %s, shapes: [{type: sphere, radius: 0.05, material: m}]}\n%s%s"
            "analysis: {type: dynamics, duration: 0.2}\n"
            "output: [{file: r.csv, channels: [a.position, a.contact_force, energy.balance]}]\n",
            jams ? 0.201 : 0.101, movers[is_free],
            jams ? "  - {name: b, position: [0.1005, 0, 0], shapes: [{type: sphere, radius: 0.05, "
                   "material: m}]}\n"
                 : "",
            rails[is_free]);
        text_model m = text_model_open(text, SE3D_METHOD_CONVEX, SE3D_FORMULATION_AUTO, STEP);
        for (int step = 1; step <= 80; ++step) {
            CHECK(text_model_run(&m, STEP * step));
            const double depth = text_model_get(&m, 0, 0) - 1e-3;
            const double force = -text_model_get(&m, 1, 0), springs = jams ? 2.0 : 1.0;
            if (depth > 1e-3) {
                CHECK_NEAR(force, 1e6 * depth / springs, 120.0); /* of up to 7000, with dampers */
            } else {
                CHECK(force >= 0.0 && force < 1200.0);
            }
        }
        text_model_close(&m);
    }
}

/* A ball that adheres is driven against a plane: it is pulled as by its law, also slowly. */
static void what_is_driven_against_what_it_adheres_to_is_pulled(void)
{
    static const double speeds[] = {0.5, 0.1, 0.02};
    for (size_t k = 0; k < sizeof speeds / sizeof *speeds; ++k) {
        char text[1024];
        (void)snprintf(
            text, sizeof text,
            "se3d: 1\nmaterials: [{name: m, density: 1000, stiffness: 1.0e+6, restitution: 0.9, "
            "friction: 0.3, adhesion: 20}]\ncontact: {}\nbodies:\n"
            "  - {name: ground, shapes: [{type: plane, material: m}]}\n"
            "  - {name: b, mass: 2, inertia: [0.02, 0.02, 0.02], position: [0, 0, 0.1005], "
            "velocity: [0, 0, -%g], shapes: [{type: sphere, radius: 0.1, material: m}]}\n"
            "joints: [{name: j, type: prismatic, body_i: ground, body_j: b, at: [0, 0, 0], axis: "
            "[0, 0, 1]}]\ndrivers: [{name: d, joint: j, value: -%g*t}]\n"
            "analysis: {type: dynamics, duration: 1}\noutput: [{file: r.csv, channels: "
            "[d.effort]}]\n",
            speeds[k], speeds[k]);
        text_model m = text_model_open(text, SE3D_METHOD_CONVEX, SE3D_FORMULATION_AUTO, STEP);
        text_model by_law = text_model_open(text, SE3D_METHOD_DOP853, SE3D_FORMULATION_AUTO, STEP);
        const double t = k == 0 ? 0.01 : 0.002 / speeds[k];
        CHECK(text_model_run(&m, t) && text_model_run(&by_law, t));
        const double effort = text_model_get(&by_law, 0, 0);
        CHECK(fabs(effort) > 1000.0);
        CHECK_NEAR(text_model_get(&m, 0, 0) / effort, 1.0, 0.01);
        text_model_close(&m);
        text_model_close(&by_law);
    }
}

/* A ball that lies at a wall is squeezed by what is driven at it: the springs of both contacts
 * carry it, no impacts between the two, and no damper that is to bring things to rest. */
static void what_is_squeezed_is_held_by_springs(void)
{
    static const double masses[] = {0.5, 2.0, 5.0}, speeds[] = {0.02, 0.1};
    for (int k = 0; k < 6; ++k) {
        char text[1536];
        (void)snprintf(
            text, sizeof text,
            "se3d: 1\ngravity: [0, 0, 0]\nmaterials: [{name: m, density: 1000, stiffness: 1.0e+6, "
            "restitution: 0.5, friction: 0.6}]\ncontact: {}\nbodies:\n"
            "  - {name: wall, fixed: true, position: [-0.1, 0, 0], shapes: [{type: box, size: "
            "[0.1, "
            "0.3, 0.3], material: m}]}\n"
            "  - {name: o, mass: %g, inertia: [0.0002, 0.0002, 0.0002], shapes: [{type: sphere, "
            "radius: 0.05, material: m}]}\n"
            "  - {name: f, mass: 1, inertia: [0.01, 0.01, 0.01], position: [0.1002, 0, 0], "
            "velocity: [-%g, 0, 0], shapes: [{type: box, size: [0.1, 0.3, 0.3], material: m}]}\n"
            "joints: [{name: j, type: prismatic, body_i: ground, body_j: f, at: [0, 0, 0], axis: "
            "[1, 0, 0]}]\ndrivers: [{name: d, joint: j, value: -%g*t}]\n"
            "analysis: {type: dynamics, duration: 1}\noutput: [{file: r.csv, channels: "
            "[d.effort]}]\n",
            masses[k / 2], speeds[k % 2], speeds[k % 2]);
        text_model m = text_model_open(text, SE3D_METHOD_CONVEX, SE3D_FORMULATION_AUTO, STEP);
        text_model by_law = text_model_open(text, SE3D_METHOD_DOP853, SE3D_FORMULATION_AUTO, STEP);
        const double t = 0.0015 / speeds[k % 2];
        CHECK(text_model_run(&m, t) && text_model_run(&by_law, t));
        CHECK_NEAR(text_model_get(&m, 0, 0) / text_model_get(&by_law, 0, 0), 1.0, 0.03);
        text_model_close(&m);
        text_model_close(&by_law);
    }
}

/* An arm with friction in its joints turns on a box that lies: what is set between two steps, with
 * the value that it had, changes nothing. */
static void what_is_set_between_steps_leaves_the_rest_as_it_is(void)
{
    static const char *const text =
        "se3d: 1\nmaterials: [{name: m, density: 1000, stiffness: 1.0e+5, restitution: 0.3, "
        "friction: 0.8}]\ncontact: {}\nbodies:\n"
        "  - {name: ground, shapes: [{type: plane, position: [0, 0, -1], material: m}]}\n"
        "  - {name: base, mass: 8, inertia: [0.2, 0.2, 0.2], position: [0, 0, -0.9], shapes: "
        "[{type: box, size: [0.8, 0.8, 0.2], material: m}]}\n"
        "  - {name: col, mass: 1, inertia: [0.01, 0.01, 0.01], position: [0, 0, -0.6], "
        "angular_velocity: [0, 0, 8]}\n"
        "  - {name: arm, mass: 1, inertia: [0.002, 0.02, 0.02], position: [0.3, 0, -0.5], "
        "velocity: [0, 2.4, 0], angular_velocity: [0, 0, 8]}\n"
        "  - {name: pend, mass: 0.5, inertia: [0.001, 0.002, 0.001], position: [0.6, 0, -0.6], "
        "velocity: [0, 4.8, 0], angular_velocity: [0, 0, 8]}\n"
        "joints:\n"
        "  - {name: j1, type: revolute, body_i: base, body_j: col, at: [0, 0, -0.7], axis: [0, 0, "
        "1]}\n"
        "  - {name: j2, type: revolute, body_i: col, body_j: arm, at: [0, 0, -0.5], axis: [0, 1, "
        "0]}\n"
        "  - {name: j3, type: revolute, body_i: arm, body_j: pend, at: [0.6, 0, -0.5], axis: [1, "
        "0, 0]}\n"
        "forces:\n"
        "  - {name: f2, type: friction, joint: j2, mu: 0.2, radius: 0.05, length: 0.1}\n"
        "  - {name: f3, type: friction, joint: j3, mu: 0.2, radius: 0.05, length: 0.1}\n"
        "  - {name: s2, type: rsda, joint: j2, k: 40, c: 0.2}\n"
        "  - {name: e, type: effort, joint: j1, value: 0}\n"
        "analysis: {type: dynamics, duration: 1}\n"
        "output: [{file: r.csv, channels: [pend.position, energy.balance]}]\n";
    text_model m[2];
    se3d_force effort;
    for (int k = 0; k < 2; ++k) {
        m[k] = text_model_open(text, SE3D_METHOD_CONVEX, SE3D_FORMULATION_AUTO, STEP);
    }
    CHECK(!se3d_force_find(m[1].system, "e", &effort));
    for (int step = 1; step <= 500; ++step) {
        CHECK(text_model_run(&m[0], STEP * step) && text_model_run(&m[1], STEP * step));
        CHECK(!se3d_effort_set(m[1].system, effort, 0.0));
    }
    for (size_t c = 0; c < 3; ++c) {
        CHECK_NEAR(text_model_get(&m[1], 0, c), text_model_get(&m[0], 0, c), 1e-9);
    }
    CHECK_NEAR(text_model_get(&m[1], 1, 0), text_model_get(&m[0], 1, 0), 1e-6);
    text_model_close(&m[0]);
    text_model_close(&m[1]);
}

int main(void)
{
    RUN(what_is_driven_against_what_it_adheres_to_is_pulled);
    RUN(what_is_squeezed_is_held_by_springs);
    RUN(what_is_set_between_steps_leaves_the_rest_as_it_is);
    RUN(what_falls_onto_a_stop_bounces_and_comes_to_rest);
    RUN(what_soft_stops_give_back_is_that_of_the_law);
    RUN(an_angle_stays_within_its_range);
    RUN(what_swings_onto_a_stop_is_as_heavy_as_its_arm_makes_it);
    RUN(what_is_driven_over_its_stop_feels_the_law);
    RUN(what_is_driven_against_what_cannot_give_way_feels_the_law);
    RUN(what_hangs_on_strings_pulls_them_tight);
    RUN(what_a_cam_is_driven_with_is_counted);
    RUN(what_drivers_speed_up_by_themselves_is_counted);
    RUN(a_figure_falls_down_within_the_ranges_of_its_joints);
    RUN(machines_that_do_not_touch_are_solved_apart);
    RUN(what_nothing_touches_moves_as_it_does_alone);
    RUN(what_touches_pushes_no_other_body);
    return check_finish();
}
