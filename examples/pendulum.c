/* SPDX-License-Identifier: BSD-3-Clause */
/* The ME751 pendulum, a steel bar of 4 m on a revolute joint, in three analyses:
 *
 *     kinematics         theta = pi/4 cos 2t is prescribed: positions, velocities, accelerations
 *     inverse dynamics   the same motion: which torque does the driver need?
 *     dynamics           the driver is gone: the bar swings freely from rest at theta = pi/4
 *
 * theta is the angle from -z about +x; gravity is along -z. Returns not 0 if a number is off. */
#include "se3d/se3d.h"

#include <math.h>
#include <stdio.h>
#define PI 3.14159265358979323846

/* Every call returns a status; the system keeps a message that says what was wrong. */
#define TRY(call)                                                                                  \
    do {                                                                                           \
        if (SE3D_FAILED(call)) {                                                                   \
            fprintf(stderr, "%s: %s\n", #call, se3d_system_get_error(sys));                        \
            return 1;                                                                              \
        }                                                                                          \
    } while (0)

typedef struct pendulum {
    se3d_constraint pin, drive;
    int driven;
    double r[6], q[8], v[6], w[6]; /* the ground and the bar at t = 0 */
} pendulum;

static int build(se3d_system *sys, pendulum *p)
{
    const double L = 2.0, w = 0.05, m = 7800.0 * 2.0 * L * w * w, theta = PI / 4.0;
    const double at[3] = {0.0, 0.0, 0.0}, axis[3] = {1.0, 0.0, 0.0};
    se3d_body ground, bar;
    TRY(se3d_system_get_ground(sys, &ground));
    se3d_body_def body = se3d_body_def_default();
    body.name = "bar";
    body.mass = m;
    body.inertia[0] = m * (2.0 * w * w) / 12.0; /* body x is the long axis */
    body.inertia[1] = body.inertia[2] = m * (4.0 * L * L + w * w) / 12.0;
    body.position[1] = L * sin(theta);
    body.position[2] = -L * cos(theta);
    body.orientation[0] = body.orientation[2] = sqrt(0.5) * cos(theta / 2.0); /* scalar first */
    body.orientation[1] = body.orientation[3] = sqrt(0.5) * sin(theta / 2.0);
    TRY(se3d_body_create(sys, &body, &bar));
    se3d_joint_def joint = se3d_joint_def_default();
    joint.body_i = ground; /* the reference */
    joint.body_j = bar;    /* moves relative to it */
    joint.angle0 = theta;  /* the joint angle at this pose */
    TRY(se3d_joint_def_set_frame(sys, &joint, at, axis, NULL));
    TRY(se3d_joint_create_revolute(sys, &joint, &p->pin));
    se3d_driver_def driver = se3d_driver_def_default();
    driver.joint = p->pin;
    driver.coordinate = SE3D_JOINT_COORDINATE_ANGLE;
    TRY(se3d_function_create_expression(sys, "pi/4*cos(2*t)", &driver.function));
    TRY(se3d_driver_create(sys, &driver, &p->drive));
    TRY(se3d_body_get_all(sys, 2, p->r, p->q, p->v, p->w));
    return 0;
}

/* Run to 1 s; compare the end with {theta, Fy, Fz, torque}. */
static int report(se3d_system *sys, se3d_solver *solver, const pendulum *p, const double wanted[4])
{
    double x, xd, xdd, F[3], T[3], effort = 0.0;
    printf("   t [s]  theta [rad]  theta' [rad/s]  pin Fy [N]  pin Fz [N]  torque [N m]\n");
    for (int k = 0; k <= 4; ++k) {
        TRY(se3d_solver_run(solver, 0.25 * k));
        TRY(se3d_joint_get_coordinate(sys, p->pin, SE3D_JOINT_COORDINATE_ANGLE, &x, &xd, &xdd));
        TRY(se3d_constraint_get_reaction(sys, p->pin, F, T)); /* of the ground on the bar */
        if (p->driven) {
            TRY(se3d_driver_get_effort(sys, p->drive, &effort));
        }
        printf("%8.2f %12.6f %15.6f %11.3f %11.3f %13.6f\n", 0.25 * k, x, xd, F[1], F[2], effort);
    }
    const double end[4] = {x, F[1], F[2], effort}, tolerance = p->driven ? 1e-10 : 1e-8;
    for (int k = 0; k < 4; ++k) {
        if (!(fabs(end[k] - wanted[k]) <= tolerance * fmax(1.0, fabs(wanted[k])))) {
            printf("%.12g is wrong, expected %.12g\n", end[k], wanted[k]);
            return 1;
        }
    }
    return 0;
}

static int analyse(se3d_system *sys, const pendulum *p, int32_t analysis, const double wanted[4])
{
    const char *const name[] = {"assembly", "kinematics", "inverse dynamics", "dynamics"};
    se3d_solver *solver;
    se3d_solver_def def = se3d_solver_def_default();
    def.analysis = analysis;
    def.step = 0.01, def.tolerance = 1e-10; /* dynamics chooses shorter steps by itself */
    TRY(se3d_system_set_time(sys, 0.0));
    TRY(se3d_body_set_all(sys, 2, p->r, p->q, p->v, p->w));
    TRY(se3d_solver_create(sys, &def, &solver));
    printf("%s\n", name[analysis]);
    int failed = report(sys, solver, p, wanted);
    se3d_solver_destroy(solver); /* before its system */
    return failed;
}

int main(void)
{
    /* At t = 1 s: closed forms, and an integration in quadruple precision. */
    const double driven[4] = {-0.326840961127784, 295.328888630727, 1001.10938523126,
                              52.5581921051678};
    const double swing[4] = {-0.214742177777088, 185.495611303303, 1041.80464411362, 0.0};
    pendulum p = {.driven = 1};
    se3d_system *sys = NULL;
    TRY(se3d_system_create(NULL, &sys)); /* NULL: malloc, silent, gravity 9.81 along -z */
    int failed = build(sys, &p) || analyse(sys, &p, SE3D_ANALYSIS_KINEMATICS, driven) ||
                 analyse(sys, &p, SE3D_ANALYSIS_INVERSE_DYNAMICS, driven);
    if (!failed) {
        TRY(se3d_constraint_destroy(sys, p.drive)); /* between runs, anything may be edited */
        p.driven = 0;
        failed = analyse(sys, &p, SE3D_ANALYSIS_DYNAMICS, swing);
    }
    se3d_system_destroy(sys);
    return failed;
}
