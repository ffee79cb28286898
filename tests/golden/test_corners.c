/* SPDX-License-Identifier: BSD-3-Clause */
/* Corners of cars by hardpoints, examples/fsae/corner.yaml, against the geometry of rigid links: a
 * ball joint turns about the axis of its arm, the others lie where three spheres meet, the rocker
 * turns until the pushrod has its length. docs/theory/wheel.md */
#include <stdint.h>
#include <stdlib.h>

#include "check.h"
#include "se3d/study.h"

enum {
    HUB,
    UPPER,
    LOWER,
    UPPER_FRONT,
    UPPER_REAR,
    LOWER_FRONT,
    LOWER_REAR,
    LINK_INNER,
    LINK_OUTER,
    PUSH_OUTER,
    PUSH_INNER,
    ROCKER,
    DAMPER_OUTER,
    DAMPER_INNER,
    POINTS
};

#define RADIAN 0.017453292519943295
#define LIFT   28.0
#define SPREAD 12.0 /* of the hardpoints, mm to both sides */

/* Hardpoints [mm] of the left front wheel, camber and toe [deg]. */
typedef struct corner {
    double of[POINTS][3];
    double camber, toe;
} corner;

static const char *const names[POINTS] = {
    "hub",         "upper_ball", "lower_ball",   "upper_front", "upper_rear",
    "lower_front", "lower_rear", "link_inner",   "link_outer",  "push_outer",
    "push_inner",  "rocker",     "damper_outer", "damper_inner"};
static const corner example = {{{0, 600, 228},
                                {-8, 552, 320},
                                {4, 572, 130},
                                {130, 282, 277},
                                {-130, 282, 291},
                                {140, 195, 118},
                                {-150, 195, 124},
                                {68, 213, 152.6},
                                {68, 586, 170},
                                {4, 540, 146},
                                {0, 312, 402},
                                {0, 258, 372},
                                {0, 262, 446},
                                {0, 56, 452}},
                               -1.2,
                               0.0};
/* A published one, of a car with its pushrods on the upper arms: those are the example's here. */
static const corner published = {{{0, 612.5, 235},
                                  {-39.2, 527.786, 350},
                                  {-10.601, 563.477, 148.512},
                                  {98.347, 273.206, 303.434},
                                  {-143.236, 273.327, 309.89},
                                  {148.576, 262.926, 126.153},
                                  {-107.79, 263.181, 150.828},
                                  {-60, 266.31, 119.872},
                                  {-60, 553.4, 118.54},
                                  {-10.601, 531.477, 164.512},
                                  {-10.601, 312, 402},
                                  {-10.601, 258, 372},
                                  {-10.601, 262, 446},
                                  {-10.601, 56, 452}},
                                 0.0,
                                 0.0};

/* ---- geometry --------------------------------------------------------------------------------*/

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; ++k) {
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    }
}

static void subtract(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; ++k) {
        out[k] = a[k] - b[k];
    }
}

static double distance(const double a[3], const double b[3])
{
    double d[3];
    subtract(a, b, d);
    return sqrt(dot(d, d));
}

/* e: the first along b - a, the second in the plane of c, the third normal to it. */
static void erect(const double a[3], const double b[3], const double c[3], double e[3][3])
{
    const double length = distance(a, b);
    double side[3];
    subtract(b, a, e[0]);
    subtract(c, a, side);
    for (int k = 0; k < 3; ++k) {
        e[0][k] /= length;
    }
    const double along = dot(e[0], side);
    for (int k = 0; k < 3; ++k) {
        side[k] -= along * e[0][k];
    }
    const double height = sqrt(dot(side, side));
    for (int k = 0; k < 3; ++k) {
        e[1][k] = side[k] / height;
    }
    cross(e[0], e[1], e[2]);
}

/* The place that has these distances from three centres, on the same side of them as `given`. */
static void meet(const double *const centers[3], const double r[3], double side, double out[3])
{
    double e[3][3], to[3];
    erect(centers[0], centers[1], centers[2], e);
    subtract(centers[2], centers[0], to);
    const double d = distance(centers[0], centers[1]), i = dot(e[0], to), j = dot(e[1], to);
    const double x = (r[0] * r[0] - r[1] * r[1] + d * d) / (2.0 * d);
    const double y = (r[0] * r[0] - r[2] * r[2] + i * i + j * j) / (2.0 * j) - i * x / j;
    const double z = copysign(sqrt(r[0] * r[0] - x * x - y * y), side);
    for (int k = 0; k < 3; ++k) {
        out[k] = centers[0][k] + x * e[0][k] + y * e[1][k] + z * e[2][k];
    }
}

/* The same for three points of the corner and one that keeps its distances from them. */
static void follow(const corner *c, const int from[3], int what, double at[POINTS][3])
{
    double e[3][3], to[3], r[3];
    const double *centers[3];
    for (int k = 0; k < 3; ++k) {
        centers[k] = at[from[k]];
        r[k] = distance(c->of[what], c->of[from[k]]);
    }
    erect(c->of[from[0]], c->of[from[1]], c->of[from[2]], e);
    subtract(c->of[what], c->of[from[0]], to);
    meet(centers, r, dot(e[2], to), at[what]);
}

/* A point turned about an axis through another. */
static void turn(const double p[3], const double through[3], const double axis[3], double angle,
                 double out[3])
{
    double v[3], x[3];
    const double length = sqrt(dot(axis, axis));
    subtract(p, through, v);
    cross(axis, v, x);
    const double along = dot(axis, v) * (1.0 - cos(angle)) / (length * length);
    for (int k = 0; k < 3; ++k) {
        out[k] = through[k] + v[k] * cos(angle) + x[k] * sin(angle) / length + axis[k] * along;
    }
}

/* All points with the lower arm at an angle; the height of the hub. */
static double place(const corner *c, double angle, double at[POINTS][3])
{
    static const int upper[3] = {UPPER_FRONT, UPPER_REAR, LOWER};
    static const int link[3] = {LINK_INNER, LOWER, UPPER}, hub[3] = {LOWER, UPPER, LINK_OUTER};
    double axis[3];
    memcpy(at, c->of, sizeof c->of);
    subtract(c->of[LOWER_REAR], c->of[LOWER_FRONT], axis);
    turn(c->of[LOWER], c->of[LOWER_FRONT], axis, angle, at[LOWER]);
    turn(c->of[PUSH_OUTER], c->of[LOWER_FRONT], axis, angle, at[PUSH_OUTER]);
    follow(c, upper, UPPER, at);
    follow(c, link, LINK_OUTER, at);
    follow(c, hub, HUB, at);
    return at[HUB][2];
}

/* How much too long the pushrod is with the rocker at an angle. */
static double turn_rocker(const corner *c, double angle, double at[POINTS][3])
{
    const double x[3] = {1.0, 0.0, 0.0};
    turn(c->of[PUSH_INNER], c->of[ROCKER], x, angle, at[PUSH_INNER]);
    turn(c->of[DAMPER_OUTER], c->of[ROCKER], x, angle, at[DAMPER_OUTER]);
    return distance(at[PUSH_INNER], at[PUSH_OUTER]) -
           distance(c->of[PUSH_INNER], c->of[PUSH_OUTER]);
}

/* Camber, toe, place of the hub, length of the spring; radians and metres. */
static void solve(const corner *c, double lift, double wanted[6])
{
    double at[POINTS][3], angle = 0.0, rocker = 0.0;
    for (int k = 0; k < 30; ++k) { /* secants of 1e-5 rad: linear, by 1e-4 or less a time */
        const double slope = (place(c, angle + 1e-5, at) - place(c, angle - 1e-5, at)) / 2e-5;
        angle -= (place(c, angle, at) - c->of[HUB][2] - lift) / slope;
    }
    (void)place(c, angle, at);
    for (int k = 0; k < 30; ++k) {
        const double slope =
            (turn_rocker(c, rocker + 1e-5, at) - turn_rocker(c, rocker - 1e-5, at)) / 2e-5;
        rocker -= turn_rocker(c, rocker, at) / slope;
    }
    (void)turn_rocker(c, rocker, at);
    const double camber = c->camber * RADIAN, toe = c->toe * RADIAN;
    const double axis[3] = {sin(toe) * cos(camber), cos(toe) * cos(camber), -sin(camber)};
    double before[3][3], now[3][3], spin[3] = {0.0, 0.0, 0.0};
    erect(c->of[LOWER], c->of[UPPER], c->of[LINK_OUTER], before);
    erect(at[LOWER], at[UPPER], at[LINK_OUTER], now);
    for (int k = 0; k < 3; ++k) {
        for (int i = 0; i < 3; ++i) {
            spin[i] += dot(before[k], axis) * now[k][i];
        }
        wanted[2 + k] = 1e-3 * at[HUB][k];
    }
    wanted[0] = -asin(spin[2]);
    wanted[1] = atan2(spin[0], spin[1]);
    wanted[5] = 1e-3 * distance(at[DAMPER_OUTER], at[DAMPER_INNER]);
}

/* ---- the model -------------------------------------------------------------------------------*/

static void write_model(const corner *c, char *text, size_t size)
{
    const char *source = getenv("SE3D_SOURCE_DIR");
    size_t used = (size_t)snprintf(
        text, size,
        "se3d: 1\nunits: {length: mm, force: N, mass: kg, time: s, angle: deg}\n"
        "parameters: {lift: %g}\ninclude:\n- file: %s/examples/fsae/corner.yaml\n  parameters:\n"
        "    camber: %.17g\n    toe: %.17g\n",
        LIFT, source ? source : ".", c->camber, c->toe);
    for (int k = 0; k < POINTS; ++k) {
        used += (size_t)snprintf(text + used, size - used, "    %s: '[%.17g, %.17g, %.17g]'\n",
                                 names[k], c->of[k][0], c->of[k][1], c->of[k][2]);
    }
    used += (size_t)snprintf(
        text + used, size - used,
        "bodies:\n- {name: chassis, mass: 1, inertia: [1, 1, 1], fixed: true}\n"
        "- {name: rack, mass: 1, inertia: [1, 1, 1], fixed: true}\n"
        "constraints: [{name: road, type: cd, body_i: ground, body_j: upright, c: [0, 0, 1], "
        "at_2: [%.17g, %.17g, %.17g], value: %.17g + lift*sin(180 deg/s*t)}]\n"
        "drivers: [{name: brake, joint: bearing, value: 0}]\n"
        "analysis: {type: kinematics, duration: 1.5, step: 0.05}\n"
        "study:\n  sensitivities: [lift]\n  measures:\n",
        c->of[HUB][0], c->of[HUB][1], c->of[HUB][2], c->of[HUB][2]);
    static const char *const channels[] = {"hub.camber",         "hub.toe",
                                           "upright.position.x", "upright.position.y",
                                           "upright.position.z", "spring.length"};
    for (int k = 0; k < 12; ++k) {
        used += (size_t)snprintf(text + used, size - used, "    m%d: {at: %s, time: %s}\n", k,
                                 channels[k % 6], k < 6 ? "0.5" : "1.5");
    }
}

static void check_corner(const corner *c)
{
    char text[4000];
    double measures[12], wanted[12];
    se3d_model *model = NULL;
    se3d_study *study = NULL;
    se3d_model_error error = {.message = ""};
    write_model(c, text, sizeof text);
    CHECK(se3d_model_read_text(text, strlen(text), "a.yaml", NULL, &model, &error) == SE3D_OK);
    CHECK(model && se3d_study_create(model, &study, &error) == SE3D_OK);
    CHECK(study && se3d_study_eval_nominal(study, measures, &error) == SE3D_OK);
    if (error.message[0]) {
        fprintf(stderr, "%s\n", error.message);
    }
    solve(c, LIFT, wanted);
    solve(c, -LIFT, wanted + 6);
    for (int k = 0; k < 12 && study; ++k) {
        CHECK_NEAR(measures[k], wanted[k], 1e-13); /* rad, m */
    }
    se3d_study_destroy(study);
    se3d_model_destroy(model);
}

static void the_example_and_a_published_corner_move_as_rigid_links_do(void)
{
    check_corner(&example);
    check_corner(&published);
}

static void corners_with_other_hardpoints_do_so(void)
{
    uint64_t seed = 7;
    for (int sample = 0; sample < 6; ++sample) {
        corner c = example;
        for (int k = 0; k < 3 * POINTS; ++k) {
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            const double share = 2.0 * (double)(seed >> 11) / 9007199254740992.0 - 1.0;
            c.of[k / 3][k % 3] += SPREAD * share;
            c.camber = k == 1 ? share : c.camber;
            c.toe = k == 2 ? share : c.toe;
        }
        check_corner(&c);
    }
}

int main(void)
{
    RUN(the_example_and_a_published_corner_move_as_rigid_links_do);
    RUN(corners_with_other_hardpoints_do_so);
    return check_finish();
}
