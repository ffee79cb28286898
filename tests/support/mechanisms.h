/* SPDX-License-Identifier: BSD-3-Clause */
/* Planar mechanisms out of bars and plain 3-D joints, for tests of several kinds. Bars lie in the
 * x-y plane, their long axis is body x, the joints turn about z; gravity is -y. */
#ifndef SE3D_TESTS_MECHANISMS_H
#define SE3D_TESTS_MECHANISMS_H

#include "support/world.h"

#define PI 3.14159265358979323846

typedef struct world {
    se3d_system *system;
    se3d_body ground;
    se3d_solver *solver;
} world;

#define MUST(w, call) world_must((w)->system, (call), #call)

static inline world world_create(void)
{
    world w = {NULL, {0, 0}, NULL};
    se3d_system_def def = se3d_system_def_default();
    const double gravity[3] = {0.0, -9.81, 0.0};
    memcpy(def.gravity, gravity, sizeof gravity);
    MUST(&w, se3d_system_create(&def, &w.system));
    MUST(&w, se3d_system_get_ground(w.system, &w.ground));
    return w;
}

static inline void world_destroy(world *w)
{
    se3d_solver_destroy(w->solver);
    se3d_system_destroy(w->system);
    w->solver = NULL;
    w->system = NULL;
}

/* A bar from (x, y) of `length` at `angle`; its centre of mass in the middle. */
static inline se3d_body add_bar(world *w, const char *name, const double from[2], double angle,
                                double length, double mass)
{
    se3d_body body;
    se3d_body_def def = se3d_body_def_default();
    def.name = name;
    def.mass = mass;
    def.inertia[0] = mass * length * length / 200.0;
    def.inertia[1] = def.inertia[2] = mass * length * length / 12.0;
    def.position[0] = from[0] + 0.5 * length * cos(angle);
    def.position[1] = from[1] + 0.5 * length * sin(angle);
    def.orientation[0] = cos(0.5 * angle);
    def.orientation[3] = sin(0.5 * angle);
    MUST(w, se3d_body_create(w->system, &def, &body));
    return body;
}

/* A joint at (x, y, 0) with the axis given. */
static inline se3d_constraint add_joint(world *w, joint_create create, const char *name,
                                        se3d_body i, se3d_body j, const double at[3],
                                        const double axis[3])
{
    return world_join(w->system, create, name, i, j, at, axis);
}

static inline se3d_constraint add_pin(world *w, const char *name, se3d_body i, se3d_body j,
                                      double x, double y)
{
    const double at[3] = {x, y, 0.0};
    const double axis[3] = {0.0, 0.0, 1.0};
    return add_joint(w, se3d_joint_create_revolute, name, i, j, at, axis);
}

/* A revolute between points (x along the bar) of two bars, whatever their poses. */
static inline se3d_constraint add_local(world *w, joint_create create, const char *name,
                                        se3d_body i, const double point_i[3], se3d_body j,
                                        const double point_j[3])
{
    se3d_constraint joint;
    se3d_joint_def def = se3d_joint_def_default();
    def.name = name;
    def.body_i = i;
    def.body_j = j;
    memcpy(def.point_i, point_i, sizeof def.point_i);
    memcpy(def.point_j, point_j, sizeof def.point_j);
    MUST(w, create(w->system, &def, &joint));
    return joint;
}

static inline se3d_constraint add_driver(world *w, const char *name, se3d_constraint joint,
                                         se3d_joint_coordinate coordinate, const char *text)
{
    se3d_constraint driver;
    se3d_driver_def def = se3d_driver_def_default();
    def.name = name;
    def.joint = joint;
    def.coordinate = (int32_t)coordinate;
    MUST(w, se3d_function_create_expression(w->system, text, &def.function));
    MUST(w, se3d_driver_create(w->system, &def, &driver));
    return driver;
}

static inline void use_solver(world *w, se3d_analysis analysis, se3d_formulation formulation)
{
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver_destroy(w->solver);
    def.analysis = (int32_t)analysis;
    def.formulation = (int32_t)formulation;
    MUST(w, se3d_solver_create(w->system, &def, &w->solver));
}

/* IFToMM A02: `windows` four-bars in a row, all bars 1 m and 1 kg; joints O<k>, and B<k> (where a
 * horizontal bar begins), C<k> (where it ends). The couplers start at +1 m/s in x. */
static inline world create_windows(int windows, joint_create create)
{
    world w = world_create();
    const double axis[3] = {0.0, 0.0, 1.0};
    se3d_body post[65];
    for (int k = 0; k <= windows; ++k) {
        char name[16];
        const double from[2] = {k, 0.0};
        const double spin[3] = {0.0, 0.0, -1.0};
        const double velocity[3] = {0.5, 0.0, 0.0};
        snprintf(name, sizeof name, "post%d", k);
        post[k] = add_bar(&w, name, from, 0.5 * PI, 1.0, 1.0);
        MUST(&w, se3d_body_set_velocity(w.system, post[k], velocity));
        MUST(&w, se3d_body_set_angular_velocity(w.system, post[k], spin));
        snprintf(name, sizeof name, "O%d", k);
        const double at[3] = {k, 0.0, 0.0};
        add_joint(&w, create, name, w.ground, post[k], at, axis);
    }
    for (int k = 0; k < windows; ++k) {
        char name[16];
        const double from[2] = {k, 1.0};
        const double velocity[3] = {1.0, 0.0, 0.0};
        snprintf(name, sizeof name, "beam%d", k);
        se3d_body beam = add_bar(&w, name, from, 0.0, 1.0, 1.0);
        MUST(&w, se3d_body_set_velocity(w.system, beam, velocity));
        const double begin[3] = {k, 1.0, 0.0};
        const double end[3] = {k + 1, 1.0, 0.0};
        snprintf(name, sizeof name, "B%d", k);
        add_joint(&w, create, name, post[k], beam, begin, axis);
        snprintf(name, sizeof name, "C%d", k);
        add_joint(&w, create, name, beam, post[k + 1], end, axis);
    }
    return w;
}

#endif
