/* SPDX-License-Identifier: BSD-3-Clause */
/* 1024 controllers at once: an arm on a motor is brought from 1 rad to 0 by a torque
 * u = gravity's moment - kp q - kd qdot that is set every millisecond, each arm with other gains.
 * Motions are compared with those of a torque without steps, and the best gains are looked for. */
#include <se3d/se3d.h>

#include <math.h>
#include <stdio.h>

#define TRY(call, why)                                                                             \
    do {                                                                                           \
        if (SE3D_FAILED(call)) {                                                                   \
            fprintf(stderr, "%s: %s\n", #call, why);                                               \
            return 1;                                                                              \
        }                                                                                          \
    } while (0)

enum { SIDE = 32, ARMS = SIDE * SIDE, STEPS = 1000 };

static const double m = 2.0, s = 0.5, h = 1e-3, g = 9.81;

/* A bar of 1 m about the y axis, q = 0: upright. */
static int build(se3d_system *system)
{
    se3d_constraint motor;
    se3d_joint_def joint = se3d_joint_def_default();
    se3d_body_def bar = se3d_body_def_default();
    bar.mass = m;
    bar.inertia[0] = bar.inertia[1] = m / 12.0;
    bar.inertia[2] = 1e-3;
    bar.position[2] = s;
    TRY(se3d_body_create(system, &bar, &joint.body_j), se3d_system_get_error(system));
    TRY(se3d_system_get_ground(system, &joint.body_i), "ground");
    joint.point_j[2] = -s;
    joint.axis_i[1] = joint.axis_j[1] = 1.0;
    joint.axis_i[2] = joint.axis_j[2] = 0.0;
    TRY(se3d_joint_create_revolute(system, &joint, &motor), se3d_system_get_error(system));
    return 0;
}

static double kp(int arm)
{
    return 20.0 + 4.0 * (arm % SIDE);
}

static double kd(int arm)
{
    return 4.0 + 0.5 * (double)(arm / SIDE);
}

/* q at time t of I q'' = -kp q - kd q', q(0) = 1, q'(0) = 0 */
static double exact(int arm, double t)
{
    const double I = m / 12.0 + m * s * s, b = kd(arm) / (2.0 * I);
    const double square = kp(arm) / I - b * b, w = sqrt(fabs(square));
    const double c = square > 0.0 ? cos(w * t) : cosh(w * t);
    const double part = square > 0.0 ? sin(w * t) / w : sinh(w * t) / w;
    return exp(-b * t) * (c + b * part);
}

/* Sums of |q| over time: what is left of the error. */
static int run(se3d_batch *batch, double *q, double *area)
{
    static double qdot[ARMS], effort[ARMS];
    for (int arm = 0; arm < ARMS; ++arm) {
        q[arm] = 1.0;
        area[arm] = 0.0;
    }
    TRY(se3d_batch_set_state(batch, 0, ARMS, q, qdot), se3d_batch_get_error(batch));
    for (int k = 0; k < STEPS; ++k) {
        TRY(se3d_batch_get_state(batch, 0, ARMS, q, qdot), "state");
        for (int arm = 0; arm < ARMS; ++arm) {
            effort[arm] = -m * g * s * sin(q[arm]) - kp(arm) * q[arm] - kd(arm) * qdot[arm];
            area[arm] += h * fabs(q[arm]);
        }
        TRY(se3d_batch_set_efforts(batch, 0, ARMS, effort), se3d_batch_get_error(batch));
        TRY(se3d_batch_step(batch, SE3D_METHOD_RK4, h, 1), se3d_batch_get_error(batch));
    }
    TRY(se3d_batch_get_state(batch, 0, ARMS, q, NULL), "state");
    return 0;
}

int main(void)
{
    static double q[ARMS], area[ARMS];
    se3d_system *system = NULL;
    se3d_batch *batch = NULL;
    double worst = 0.0;
    int best = 0;
    TRY(se3d_system_create(NULL, &system), "system");
    if (build(system)) {
        return 1;
    }
    TRY(se3d_batch_create(system, ARMS, 1, &batch), se3d_system_get_error(system));
    se3d_system_destroy(system);
    if (run(batch, q, area)) {
        return 1;
    }
    for (int arm = 0; arm < ARMS; ++arm) {
        worst = fmax(worst, fabs(q[arm] - exact(arm, h * STEPS)));
        best = area[arm] < area[best] ? arm : best;
    }
    printf("%d arms, %zu of them at once, %d steps\n", ARMS, se3d_batch_count_lanes(batch), STEPS);
    printf("largest difference to a torque without steps %.2e rad\n", worst);
    printf("least area under |q|: %.4f rad s with kp = %g N m/rad, kd = %g N m s/rad\n", area[best],
           kp(best), kd(best));
    se3d_batch_destroy(batch);
    return worst < 5e-3 && area[best] < area[0] ? 0 : 1;
}
