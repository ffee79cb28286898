/* SPDX-License-Identifier: BSD-3-Clause */
/* Channels relative to a body or marker: against differences of what they are the rates of, and
 * against the absolute ones where the reference rests. */
#include <math.h>

#include "check.h"
#include "support/read_text.h"
#include "support/text_model.h"

/* Two bars that tumble: a skew hinge on the ground, a ball between them. */
#define BARS                                                                                       \
    "se3d: 1\nbodies:\n"                                                                           \
    "  - {name: carrier, mass: 2, inertia: [.02, .05, .04, .003, 0, .001], position: [.5, 0, "     \
    "0],\n"                                                                                        \
    "     orientation: {axis: [1, 2, 3], angle: 0.7}, markers: [{name: plate, position: [.1, .2, " \
    "-.3],\n     orientation: {axis: [0, 1, 1], angle: 1.1}}]}\n"                                  \
    "  - {name: hub, mass: 1, inertia: [.01, .02, .025], position: [1.4, .2, 0],\n"                \
    "     angular_velocity: [3, -2, 5], markers: [{name: tip, position: [.3, -.1, .2],\n"          \
    "     orientation: {axis: [1, 0, 1], angle: 0.4}}]}\n"                                         \
    "joints:\n  - {name: pin, type: revolute, body_i: ground, body_j: carrier, at: [0, 0, 0],\n"   \
    "     axis: [1, 1, 1]}\n"                                                                      \
    "  - {name: ball, type: spherical, body_i: carrier, body_j: hub, at: [1, 0, 0]}\n"             \
    "analysis: {type: dynamics, method: dop853, tolerance: 1e-12, duration: 1}\n"

static void get(const text_model *m, size_t k, double value[4])
{
    size_t width = 0;
    CHECK(!se3d_model_get_channel_value(m->model, 0, k, NULL, value, &width));
}

enum { POSITION, VELOCITY, ACCELERATION, ORIENTATION, TURNING, TURNING_RATE, CHANNELS };

/* The angular velocity that two Euler parameters far apart by `time` show, in their common frame:
 * 2 dp/dt p*. */
static void turning_between(const double a[4], const double p[4], const double b[4], double time,
                            double w[3])
{
    double sign = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] < 0.0 ? -1.0 : 1.0;
    double d[4];
    for (int k = 0; k < 4; ++k) {
        d[k] = 2.0 * (sign * b[k] - a[k]) / time;
    }
    sign = a[0] * p[0] + a[1] * p[1] + a[2] * p[2] + a[3] * p[3] < 0.0 ? -1.0 : 1.0;
    w[0] = sign * (-d[0] * p[1] + d[1] * p[0] - d[2] * p[3] + d[3] * p[2]);
    w[1] = sign * (-d[0] * p[2] + d[2] * p[0] - d[3] * p[1] + d[1] * p[3]);
    w[2] = sign * (-d[0] * p[3] + d[3] * p[0] - d[1] * p[2] + d[2] * p[1]);
}

static void rates_are_those_of_what_changes(void)
{
    static const char *const pairs[][2] = {
        {"hub", "carrier"},           {"hub.tip", "carrier"},       {"hub", "carrier.plate"},
        {"hub.tip", "carrier.plate"}, {"carrier.plate", "hub.tip"}, {"ground", "hub.tip"},
        {"hub.tip", "ground"}};
    const double h = 1e-4;
    for (size_t n = 0; n < sizeof pairs / sizeof *pairs; ++n) {
        char text[2000];
        double at[3][CHANNELS][4];
        double w[3];
        const char *of = pairs[n][0], *in = pairs[n][1];
        snprintf(text, sizeof text,
                 BARS "output:\n  - {file: r.csv, channels: [%s.position@%s, %s.velocity@%s, "
                      "%s.acceleration@%s,\n     %s.orientation@%s, %s.angular_velocity@%s, "
                      "%s.angular_acceleration@%s]}\n",
                 of, in, of, in, of, in, of, in, of, in, of, in);
        text_model m = text_model_open(text, -1, -1, 0.0);
        for (int k = 0; k < 3; ++k) {
            text_model_run(&m, 0.4 + h * (k - 1));
            for (size_t c = 0; c < CHANNELS; ++c) {
                get(&m, c, at[k][c]);
            }
        }
        for (int i = 0; i < 3; ++i) {
            CHECK_NEAR(at[1][VELOCITY][i], (at[2][POSITION][i] - at[0][POSITION][i]) / (2.0 * h),
                       1e-5);
            CHECK_NEAR(at[1][ACCELERATION][i],
                       (at[2][VELOCITY][i] - at[0][VELOCITY][i]) / (2.0 * h), 1e-4);
            CHECK_NEAR(at[1][TURNING_RATE][i], (at[2][TURNING][i] - at[0][TURNING][i]) / (2.0 * h),
                       1e-4);
        }
        turning_between(at[0][ORIENTATION], at[1][ORIENTATION], at[2][ORIENTATION], 2.0 * h, w);
        for (int i = 0; i < 3; ++i) {
            CHECK_NEAR(at[1][TURNING][i], w[i], 1e-5);
        }
        text_model_close(&m);
    }
}

static void the_ground_is_a_reference_like_others(void)
{
    text_model m = text_model_open(
        BARS "output:\n  - {file: r.csv, channels: [hub.position, hub.position@ground, "
             "hub.tip.velocity,\n     hub.tip.velocity@ground, hub.acceleration, "
             "hub.acceleration@ground,\n     hub.tip.position@hub, hub.tip.velocity@hub, "
             "hub.tip.acceleration@hub, hub.tip.orientation@hub,\n     "
             "hub.tip.angular_velocity@hub.tip, hub.tip.orientation, hub.tip.angular_velocity,\n"
             "     hub.angular_velocity, hub.tip.position@hub.y, {far: "
             "\"hypot(hub.tip.position@carrier.plate.x, 0*t)\"},\n     "
             "hub.tip.position@carrier.plate]}\n",
        -1, -1, 0.0);
    double a[4], b[4], p[4], w[4];
    text_model_run(&m, 0.3);
    for (size_t k = 0; k < 6; k += 2) {
        get(&m, k, a);
        get(&m, k + 1, b);
        for (int i = 0; i < 3; ++i) {
            CHECK_NEAR(a[i], b[i], 1e-12);
        }
    }
    const double tip[3] = {0.3, -0.1, 0.2};
    get(&m, 6, a);
    for (int i = 0; i < 3; ++i) {
        CHECK_NEAR(a[i], tip[i], 1e-13);
        CHECK_NEAR(text_model_get(&m, 7, (size_t)i), 0.0, 1e-12);
        CHECK_NEAR(text_model_get(&m, 8, (size_t)i), 0.0, 1e-10);
        CHECK_NEAR(text_model_get(&m, 10, (size_t)i), 0.0, 1e-12);
    }
    get(&m, 9, p);
    CHECK_NEAR(p[0], cos(0.2), 1e-13);
    CHECK_NEAR(p[1], sin(0.2) / sqrt(2.0), 1e-13);
    /* the same vector in the marker's and in the body's frame */
    get(&m, 12, a);
    get(&m, 13, w);
    CHECK_NEAR(a[0] * a[0] + a[1] * a[1] + a[2] * a[2], w[0] * w[0] + w[1] * w[1] + w[2] * w[2],
               1e-11);
    const double along = (a[0] + a[2]) / sqrt(2.0), same = (w[0] + w[2]) / sqrt(2.0);
    CHECK_NEAR(along, same, 1e-12); /* along the axis by which it is turned */
    CHECK_NEAR(text_model_get(&m, 14, 0), -0.1, 1e-13);
    CHECK_NEAR(text_model_get(&m, 15, 0), fabs(text_model_get(&m, 16, 0)), 1e-13);
    text_model_close(&m);
}

static void what_cannot_be_relative_is_refused(void)
{
    static const struct {
        const char *channel;
        const char *part;
    } table[] = {
        {"pin.angle@hub", "`pin.angle` cannot be relative (@)"},
        {"energy.total@hub", "`energy.total` cannot be relative (@)"},
        {"hub.position@rim", "`rim` behind @ is unknown, must be a body or body.marker"},
        {"hub.position@carrier.top", "`carrier` has no marker named `top`"},
        {"hub.position@", "behind @ is unknown"},
        {"hub.speed@carrier", "`hub` has no channel `speed`"},
        {"hub.position@carrier@ground", "`hub` has no channel `position@carrier`"},
    };
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        char text[2000];
        se3d_model *model = NULL;
        se3d_model_error error = {0};
        snprintf(text, sizeof text, BARS "output:\n  - {file: r.csv, channels: [\"%s\"]}\n",
                 table[k].channel);
        CHECK(se3d_model_read_text(text, strlen(text), "m.yaml", NULL, &model, &error) ==
              SE3D_ERR_MODEL);
        CHECK_CONTAINS(error.message, table[k].part);
    }
    se3d_model *model = NULL;
    se3d_model_error error = {0};
    const char law[] = BARS "forces:\n  - {type: effort, joint: pin, coordinate: angle, value: "
                            "\"0.1*hub.position@carrier.x\"}\n";
    CHECK(se3d_model_read_text(law, strlen(law), "m.yaml", NULL, &model, &error) == SE3D_ERR_MODEL);
    CHECK_CONTAINS(error.message, "is relative to a frame that moves");
}

int main(void)
{
    RUN(rates_are_those_of_what_changes);
    RUN(the_ground_is_a_reference_like_others);
    RUN(what_cannot_be_relative_is_refused);
    return check_finish();
}
