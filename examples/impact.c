/* SPDX-License-Identifier: BSD-3-Clause */
/* A bar on a pin swings against a wall: an event finds every impact, its callback turns the motion
 * round. Behind an impact at rate w the bar rises to 1 - cos(theta) = e^2 (1 - cos(theta before)).
 */
#include <se3d/se3d.h>

#include <math.h>
#include <stdio.h>

#define RESTITUTION 0.8
#define START       1.0 /* rad from the wall, which is at the lowest position */

typedef struct bar {
    se3d_body body;
    se3d_constraint pin;
    double worst, expected; /* cosines */
} bar;

static se3d_status get_angle(void *ctx, const se3d_system *system, double *value)
{
    return se3d_joint_get_coordinate(system, ((bar *)ctx)->pin, SE3D_JOINT_COORDINATE_ANGLE, value,
                                     NULL, NULL);
}

static se3d_status get_rate(void *ctx, const se3d_system *system, double *value)
{
    return se3d_joint_get_coordinate(system, ((bar *)ctx)->pin, SE3D_JOINT_COORDINATE_ANGLE, NULL,
                                     value, NULL);
}

/* All velocities are proportional to the rate of the pin. */
static se3d_status hit_wall(void *ctx, se3d_system *system, const se3d_event_record *event)
{
    bar *b = ctx;
    double v[3], w[3];
    printf("%-10.6f wall\n", event->time);
    se3d_status status = se3d_body_get_velocity(system, b->body, v);
    if (!SE3D_FAILED(status)) {
        status = se3d_body_get_angular_velocity(system, b->body, w);
    }
    for (int k = 0; k < 3; ++k) {
        v[k] *= -RESTITUTION;
        w[k] *= -RESTITUTION;
    }
    if (!SE3D_FAILED(status)) {
        status = se3d_body_set_velocity(system, b->body, v);
    }
    return SE3D_FAILED(status) ? status : se3d_body_set_angular_velocity(system, b->body, w);
}

static se3d_status reach_top(void *ctx, se3d_system *system, const se3d_event_record *event)
{
    bar *b = ctx;
    double angle;
    const se3d_status status = get_angle(b, system, &angle);
    b->expected = 1.0 - RESTITUTION * RESTITUTION * (1.0 - b->expected);
    b->worst = fmax(b->worst, fabs(cos(angle) - b->expected));
    printf("%-10.6f top at %.9f rad, expected %.9f\n", event->time, angle, acos(b->expected));
    return status;
}

static se3d_status build(se3d_system *system, bar *b)
{
    se3d_body_def body = se3d_body_def_default();
    se3d_joint_def pin = se3d_joint_def_default();
    body.mass = 2.0;
    body.inertia[0] = body.inertia[1] = 2.0 / 3.0; /* 2 m long, along its z */
    body.inertia[2] = 1e-3;
    body.orientation[0] = cos(0.5 * START);
    body.orientation[1] = sin(0.5 * START);
    body.position[1] = sin(START);
    body.position[2] = -cos(START);
    se3d_status status = se3d_body_create(system, &body, &b->body);
    if (SE3D_FAILED(status)) {
        return status;
    }
    (void)se3d_system_get_ground(system, &pin.body_i);
    pin.body_j = b->body;
    pin.point_j[2] = 1.0;
    pin.axis_i[0] = pin.axis_j[0] = pin.ref_i[1] = pin.ref_j[1] = 1.0;
    pin.axis_i[2] = pin.axis_j[2] = 0.0;
    return se3d_joint_create_revolute(system, &pin, &b->pin);
}

static se3d_status watch(se3d_solver *solver, bar *b)
{
    se3d_event_def def = se3d_event_def_default();
    se3d_event event;
    def.ctx = def.callback_ctx = b;
    def.direction = SE3D_EVENT_FALLING;
    def.motion_only = 1;
    def.name = "wall";
    def.value = get_angle;
    def.callback = hit_wall;
    const se3d_status status = se3d_event_create(solver, &def, &event);
    def.name = "top";
    def.value = get_rate;
    def.callback = reach_top;
    return SE3D_FAILED(status) ? status : se3d_event_create(solver, &def, &event);
}

int main(void)
{
    se3d_system *system = NULL;
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    bar b = {.expected = cos(START)};
    def.tolerance = 1e-10;
    int ok = !SE3D_FAILED(se3d_system_create(NULL, &system)) && !SE3D_FAILED(build(system, &b)) &&
             !SE3D_FAILED(se3d_solver_create(system, &def, &solver)) &&
             !SE3D_FAILED(watch(solver, &b)) && !SE3D_FAILED(se3d_solver_run(solver, 10.0));
    ok = ok && se3d_solver_count_event_records(solver) >= 10 && b.worst < 1e-8;
    if (!ok) {
        fprintf(stderr, "failed: %s\n", system ? se3d_system_get_error(system) : "no memory");
    }
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
    return ok ? 0 : 1;
}
