/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/models.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

static const double X[3] = {1.0, 0.0, 0.0};
static const double Y[3] = {0.0, 1.0, 0.0};

static void *take(size_t count, size_t size)
{
    void *memory = calloc(count > 0 ? count : 1, size);
    if (!memory) {
        fprintf(stderr, "no memory for a test\n");
        exit(1);
    }
    return memory;
}

static void cross(const double a[3], const double b[3], double c[3])
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

/* v turned by Euler parameters p: v + 2 e x (e x v + e0 v). */
static void turn(const double p[4], const double v[3], double out[3])
{
    double first[3], second[3];
    cross(p + 1, v, first);
    for (int k = 0; k < 3; ++k) {
        first[k] += p[0] * v[k];
    }
    cross(p + 1, first, second);
    for (int k = 0; k < 3; ++k) {
        out[k] = v[k] + 2.0 * second[k];
    }
}

static void product(const double a[4], const double b[4], double out[4])
{
    double c[4] = {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
                   a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
                   a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
                   a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
    memcpy(out, c, sizeof c);
}

static void reserve(support_plan *plan, int bodies, int joints)
{
    *plan = (support_plan){.gravity = {0.0, 0.0, -9.81}};
    plan->bodies = take((size_t)bodies, sizeof *plan->bodies);
    plan->joints = take((size_t)joints, sizeof *plan->joints);
}

/* A square bar from `a` to `b`: its body x axis points from a to b. */
static int add_bar(support_plan *plan, const double a[3], const double b[3], double mass)
{
    support_body *body = &plan->bodies[plan->body_count];
    double d[3], length = 0.0, width = 0.05;
    for (int k = 0; k < 3; ++k) {
        d[k] = b[k] - a[k];
        body->position[k] = 0.5 * (a[k] + b[k]);
        length += d[k] * d[k];
    }
    length = sqrt(length);
    body->mass = mass;
    body->inertia[0] = mass * width * width / 6.0;
    body->inertia[1] = mass * (length * length + width * width) / 12.0;
    body->inertia[2] = body->inertia[1];
    /* The turn from x to d: p = (1 + x.d, x cross d), normalised. */
    double p[4] = {1.0 + d[0] / length, 0.0, -d[2] / length, d[1] / length};
    double size = sqrt(p[0] * p[0] + p[2] * p[2] + p[3] * p[3]);
    for (int k = 0; k < 4; ++k) {
        body->orientation[k] = p[k] / size;
    }
    return plan->body_count++;
}

static support_joint *add_joint(support_plan *plan, support_joint_create create, int i, int j,
                                const double at[3], const double axis[3])
{
    support_joint *joint = &plan->joints[plan->joint_count++];
    *joint = (support_joint){.create = create, .i = i, .j = j};
    memcpy(joint->at, at, sizeof joint->at);
    memcpy(joint->axis, axis, sizeof joint->axis);
    return joint;
}

/* `count` bars of 0.5 m in the y-z plane, each turned against the one before. */
static void plan_chain(support_plan *plan, int count, support_joint_create create)
{
    double a[3] = {0.0, 0.0, 0.0};
    reserve(plan, count, count);
    for (int k = 0; k < count; ++k) {
        double angle = 0.3 + 0.25 * (k % 5);
        double b[3] = {a[0] + (create == se3d_joint_create_spherical ? 0.1 * (k % 3) : 0.0),
                       a[1] + 0.5 * cos(angle), a[2] - 0.5 * sin(angle)};
        int body = add_bar(plan, a, b, 1.0 + 0.1 * (k % 4));
        add_joint(plan, create, body - 1, body, a, X);
        memcpy(a, b, sizeof a);
    }
}

/* The free pendulum of ME751, from pi/4: a bar of 4 m. */
static void plan_pendulum(support_plan *plan, const char *drive)
{
    const double O[3] = {0.0, 0.0, 0.0};
    const double tip[3] = {0.0, 4.0 * sin(PI / 4), -4.0 * cos(PI / 4)};
    reserve(plan, 1, 1);
    add_bar(plan, O, tip, 78.0);
    add_joint(plan, se3d_joint_create_revolute, -1, 0, O, X)->drive = drive;
}

/* The double pendulum of ME751: bars of 4 m and 2 m, the first level, the second hanging. */
static void plan_double_pendulum(support_plan *plan, const char *drive)
{
    const double O[3] = {0.0, 0.0, 0.0}, elbow[3] = {0.0, 4.0, 0.0}, tip[3] = {0.0, 4.0, -2.0};
    reserve(plan, 2, 2);
    add_bar(plan, O, elbow, 78.0);
    add_bar(plan, elbow, tip, 39.0);
    add_joint(plan, se3d_joint_create_revolute, -1, 0, O, X)->drive = drive;
    add_joint(plan, se3d_joint_create_revolute, 0, 1, elbow, X);
}

/* A heavy symmetric top, 0.5 m above its ball joint, leaning by 0.4 rad, spinning at 20 rad/s. */
static void plan_heavy_top(support_plan *plan)
{
    const double O[3] = {0.0, 0.0, 0.0}, Z[3] = {0.0, 0.0, 1.0};
    reserve(plan, 1, 1);
    support_body *top = plan->bodies;
    plan->body_count = 1;
    const double lean[4] = {cos(0.2), sin(0.2), 0.0, 0.0};
    const double centre[3] = {0.0, 0.0, 0.5}, w[3] = {0.0, 0.8, 20.0};
    double w_ground[3];
    *top = (support_body){.mass = 5.0, .inertia = {0.08, 0.08, 0.05}};
    memcpy(top->orientation, lean, sizeof lean);
    memcpy(top->angular_velocity, w, sizeof w);
    turn(lean, centre, top->position);
    turn(lean, w, w_ground);
    cross(w_ground, top->position, top->velocity);
    add_joint(plan, se3d_joint_create_spherical, -1, 0, O, Z);
}

/* `count` four-bars with revolutes in a row along y, each 1 - 2 - 2 - 2.2 m about x; every crank
 * is at its own angle. Three equations of each are redundant. */
static void plan_four_bar(support_plan *plan, int count, const char *drive)
{
    const double crank = 1.0, coupler = 2.0, rocker = 2.0, base = 2.2;
    reserve(plan, 3 * count, 4 * count);
    for (int k = 0; k < count; ++k) {
        double y = 5.0 * k, angle = 1.1 + 0.01 * (k % 7);
        const double O[3] = {0.0, y, 0.0}, Q[3] = {0.0, y + base, 0.0};
        const double A[3] = {0.0, y + crank * cos(angle), crank * sin(angle)};
        double dy = Q[1] - A[1], dz = Q[2] - A[2], d = sqrt(dy * dy + dz * dz);
        double along = (d * d + coupler * coupler - rocker * rocker) / (2.0 * d);
        double across = sqrt(coupler * coupler - along * along);
        const double B[3] = {0.0, A[1] + (along * dy - across * dz) / d,
                             A[2] + (along * dz + across * dy) / d};
        int first = add_bar(plan, O, A, 3.0);
        add_bar(plan, A, B, 6.0);
        add_bar(plan, Q, B, 7.0);
        add_joint(plan, se3d_joint_create_revolute, -1, first, O, X)->drive = drive;
        add_joint(plan, se3d_joint_create_revolute, first, first + 1, A, X);
        add_joint(plan, se3d_joint_create_revolute, -1, first + 2, Q, X);
        add_joint(plan, se3d_joint_create_revolute, first + 1, first + 2, B, X);
    }
}

/* A spatial slider-crank without redundant equations: revolute, ball, cross, slide along y. */
static void plan_slider_crank(support_plan *plan, const char *drive)
{
    const double O[3] = {0.0, 0.0, 0.0}, angle = 0.7, offset = 0.1;
    const double A[3] = {0.0, 0.4 * cos(angle), 0.4 * sin(angle)};
    const double B[3] = {
        offset, A[1] + sqrt(1.2 * 1.2 - offset * offset - (A[2] - 0.05) * (A[2] - 0.05)), 0.05};
    const double end[3] = {B[0], B[1] + 0.2, B[2]};
    reserve(plan, 3, 4);
    add_bar(plan, O, A, 2.0);
    add_bar(plan, A, B, 3.0);
    add_bar(plan, B, end, 4.0);
    add_joint(plan, se3d_joint_create_revolute, -1, 0, O, X)->drive = drive;
    add_joint(plan, se3d_joint_create_spherical, 0, 1, A, X);
    /* One axis of the cross is perpendicular to the rod and fixed in it, the other is fixed in the
     * slider, perpendicular to both. */
    support_joint *cardan = add_joint(plan, se3d_joint_create_universal, 1, 2, B, X);
    const double rod[3] = {B[0] - A[0], B[1] - A[1], B[2] - A[2]};
    const double square[3] = {0.0, -rod[2], rod[1]};
    const double x_like[3] = {rod[1] * square[2] - rod[2] * square[1],
                              rod[2] * square[0] - rod[0] * square[2],
                              rod[0] * square[1] - rod[1] * square[0]};
    memcpy(cardan->axis, x_like, sizeof x_like);
    memcpy(cardan->axis_j, square, sizeof square);
    add_joint(plan, se3d_joint_create_prismatic, -1, 2, B, Y);
}

void support_plan_make(support_plan *plan, const char *name, int count)
{
    /* Drives start with the plan's pose and at rest where the models do. */
    if (strcmp(name, "pendulum") == 0) {
        plan_pendulum(plan, NULL);
    } else if (strcmp(name, "driven_pendulum") == 0) {
        plan_pendulum(plan, "0.8*sin(2*t)+0.1*t");
    } else if (strcmp(name, "double_pendulum") == 0) {
        plan_double_pendulum(plan, NULL);
    } else if (strcmp(name, "driven_double_pendulum") == 0) {
        plan_double_pendulum(plan, "0.6*sin(3*t)");
    } else if (strcmp(name, "heavy_top") == 0) {
        plan_heavy_top(plan);
    } else if (strcmp(name, "four_bar") == 0) {
        plan_four_bar(plan, count, NULL);
    } else if (strcmp(name, "driven_four_bar") == 0) {
        plan_four_bar(plan, count, "1.5*t+0.2*sin(3*t)");
    } else if (strcmp(name, "slider_crank") == 0) {
        plan_slider_crank(plan, NULL);
    } else if (strcmp(name, "driven_slider_crank") == 0) {
        plan_slider_crank(plan, "3*t+0.4*sin(2*t)");
    } else if (strcmp(name, "chain_revolute") == 0) {
        plan_chain(plan, count, se3d_joint_create_revolute);
    } else if (strcmp(name, "chain_ball") == 0) {
        plan_chain(plan, count, se3d_joint_create_spherical);
    } else {
        fprintf(stderr, "no mechanism is named %s\n", name);
        exit(1);
    }
}

void support_plan_destroy(support_plan *plan)
{
    free(plan->bodies);
    free(plan->joints);
    *plan = (support_plan){0};
}

static void turn_in_place(const double p[4], double v[3])
{
    double out[3];
    turn(p, v, out);
    memcpy(v, out, sizeof out);
}

void support_plan_transform(support_plan *plan, const double p[4], const double shift[3])
{
    turn_in_place(p, plan->gravity);
    for (int k = 0; k < plan->body_count; ++k) {
        support_body *body = &plan->bodies[k];
        turn_in_place(p, body->position);
        turn_in_place(p, body->velocity);
        product(p, body->orientation, body->orientation);
        for (int c = 0; c < 3; ++c) {
            body->position[c] += shift[c];
        }
    }
    for (int k = 0; k < plan->joint_count; ++k) {
        support_joint *joint = &plan->joints[k];
        turn_in_place(p, joint->at);
        turn_in_place(p, joint->axis);
        turn_in_place(p, joint->axis_j);
        for (int c = 0; c < 3; ++c) {
            joint->at[c] += shift[c];
        }
    }
}

static se3d_status create_body(support_model *model, const support_body *body, int index)
{
    se3d_body_def def = se3d_body_def_default();
    def.mass = body->mass;
    memcpy(def.inertia, body->inertia, sizeof def.inertia);
    memcpy(def.position, body->position, sizeof def.position);
    memcpy(def.orientation, body->orientation, sizeof def.orientation);
    memcpy(def.velocity, body->velocity, sizeof def.velocity);
    memcpy(def.angular_velocity, body->angular_velocity, sizeof def.angular_velocity);
    return se3d_body_create(model->system, &def, &model->bodies[index]);
}

/* The direction `axis_j` (ground frame) in the frame of body j. */
static void set_axis_j(const support_plan *plan, const support_joint *joint, se3d_joint_def *def)
{
    const double *p = plan->bodies[joint->j].orientation;
    const double back[4] = {p[0], -p[1], -p[2], -p[3]};
    turn(back, joint->axis_j, def->axis_j);
}

static se3d_status create_joint(support_model *model, const support_plan *plan, int index)
{
    const support_joint *joint = &plan->joints[index];
    se3d_joint_def def = se3d_joint_def_default();
    def.body_i = joint->i < 0 ? model->ground : model->bodies[joint->i];
    def.body_j = joint->j < 0 ? model->ground : model->bodies[joint->j];
    se3d_status status =
        se3d_joint_def_set_frame(model->system, &def, joint->at, joint->axis, NULL);
    if (status < 0) {
        return status;
    }
    if (joint->axis_j[0] != 0.0 || joint->axis_j[1] != 0.0 || joint->axis_j[2] != 0.0) {
        set_axis_j(plan, joint, &def);
        memset(def.ref_i, 0, sizeof def.ref_i);
        memset(def.ref_j, 0, sizeof def.ref_j);
    }
    return joint->create(model->system, &def, &model->joints[index]);
}

static se3d_status create_driver(support_model *model, const support_plan *plan, int index)
{
    se3d_driver_def def = se3d_driver_def_default();
    if (!plan->joints[index].drive) {
        return SE3D_OK;
    }
    def.joint = model->joints[index];
    def.coordinate = SE3D_JOINT_COORDINATE_ANGLE;
    se3d_status status =
        se3d_function_create_expression(model->system, plan->joints[index].drive, &def.function);
    return status < 0 ? status : se3d_driver_create(model->system, &def, &model->drivers[index]);
}

static se3d_status build(support_model *model, const support_plan *plan,
                         const se3d_allocator *allocator, int reversed)
{
    se3d_system_def def = se3d_system_def_default();
    def.allocator = allocator;
    memcpy(def.gravity, plan->gravity, sizeof def.gravity);
    se3d_status status = se3d_system_create(&def, &model->system);
    if (status >= 0) {
        status = se3d_system_get_ground(model->system, &model->ground);
    }
    for (int k = 0; k < plan->body_count && status >= 0; ++k) {
        int index = reversed ? plan->body_count - 1 - k : k;
        status = create_body(model, &plan->bodies[index], index);
    }
    for (int k = 0; k < plan->joint_count && status >= 0; ++k) {
        status = create_joint(model, plan, reversed ? plan->joint_count - 1 - k : k);
    }
    for (int k = 0; k < plan->joint_count && status >= 0; ++k) {
        status = create_driver(model, plan, k);
    }
    return status;
}

se3d_status support_model_create(support_model *model, const support_plan *plan,
                                 const se3d_allocator *allocator, int reversed)
{
    *model = (support_model){.body_count = plan->body_count, .joint_count = plan->joint_count};
    model->bodies = take((size_t)plan->body_count, sizeof *model->bodies);
    model->joints = take((size_t)plan->joint_count, sizeof *model->joints);
    model->drivers = take((size_t)plan->joint_count, sizeof *model->drivers);
    se3d_status status = build(model, plan, allocator, reversed);
    if (status < 0) {
        support_model_destroy(model);
    }
    return status;
}

void support_model_destroy(support_model *model)
{
    se3d_system_destroy(model->system);
    free(model->bodies);
    free(model->joints);
    free(model->drivers);
    *model = (support_model){0};
}

void support_model_make(support_model *model, const char *name, int count)
{
    support_plan plan;
    support_plan_make(&plan, name, count);
    se3d_status status = support_model_create(model, &plan, NULL, 0);
    support_plan_destroy(&plan);
    if (status < 0) {
        fprintf(stderr, "%s: %s\n", name, se3d_status_get_text(status));
        exit(1);
    }
}
