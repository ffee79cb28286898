/* SPDX-License-Identifier: BSD-3-Clause */
/* What is shown between two steps is one smooth motion through both of their ends: velocities are
 * the derivatives of the poses that are shown and accelerations those of velocities, what is
 * dissipated that of the power of damper and friction, and nothing jumps where steps meet. */
#include <stddef.h>

#include "support/mechanisms.h"
#include "support/methods.h"

#define STEP  0.02
#define NEAR  1e-7 /* time between two states that are one but for what moves */
#define APART 1e-5 /* of the differences that are compared with velocities */

#define DAMPING 0.5
#define RUBBING 0.3 /* N m */
#define BODIES  2

typedef struct pose {
    double r[3], p[4], v[3], w[3]; /* w: body frame */
} pose;

typedef struct scene {
    pose body[BODIES];
    double lost;            /* what damper and friction have taken up [J] */
    double a[BODIES][2][3]; /* accelerations, angular ones in the body frame */
    double reaction[3];     /* of the joint [N] */
} scene;

typedef struct result {
    /* the largest: where steps meet, of velocities, of accelerations, of the power, of the
     * reaction where steps meet */
    double jump, off, bent, lost, kick;
} result;

/* A body that tumbles and falls, and one that swings on a ball joint, or on a pin with friction,
 * with a spring between them. */
static se3d_constraint build(world *w, int rubs, se3d_body bodies[BODIES])
{
    const double ball[3] = {0.0, 0.0, 0.0}, axis[3] = {0.0, 0.0, 1.0};
    const double spin[3] = {1.0, 3.0, -2.0}, velocity[3] = {0.3, 1.0, -0.5};
    const double corner[2] = {0.0, 0.0};
    se3d_body_def def = se3d_body_def_default();
    se3d_tsda_def spring = se3d_tsda_def_default();
    se3d_force force;
    *w = world_create();
    bodies[0] = add_bar(w, "bar", corner, 0.2, 1.0, 1.5);
    const se3d_constraint joint =
        add_joint(w, rubs ? se3d_joint_create_revolute : se3d_joint_create_spherical, "pin",
                  w->ground, bodies[0], ball, axis);
    if (rubs) {
        se3d_friction_def friction = se3d_friction_def_default();
        friction.joint = joint;
        friction.coordinate = SE3D_JOINT_COORDINATE_ANGLE;
        friction.limit = RUBBING;
        MUST(w, se3d_force_create_friction(w->system, &friction, &force));
    }
    def.name = "tumbler";
    def.mass = 2.0;
    def.inertia[0] = 0.2;
    def.inertia[1] = 0.3;
    def.inertia[2] = 0.45;
    def.position[0] = 2.0;
    def.position[1] = 1.0;
    MUST(w, se3d_body_create(w->system, &def, &bodies[1]));
    MUST(w, se3d_body_set_angular_velocity(w->system, bodies[1], spin));
    MUST(w, se3d_body_set_velocity(w->system, bodies[1], velocity));
    spring.body_i = bodies[0];
    spring.body_j = bodies[1];
    spring.point_i[0] = 0.5;
    spring.point_j[1] = 0.1;
    spring.k = 20.0;
    spring.c = DAMPING;
    spring.l0 = 1.0;
    MUST(w, se3d_force_create_tsda(w->system, &spring, &force));
    return joint;
}

static scene show(world *w, const se3d_body bodies[BODIES], se3d_constraint joint, double t)
{
    scene now;
    se3d_energy energy;
    MUST(w, se3d_solver_run(w->solver, t));
    for (int k = 0; k < BODIES; ++k) {
        pose *x = &now.body[k];
        MUST(w, se3d_body_get_position(w->system, bodies[k], x->r));
        MUST(w, se3d_body_get_orientation(w->system, bodies[k], x->p));
        MUST(w, se3d_body_get_velocity(w->system, bodies[k], x->v));
        MUST(w, se3d_body_get_angular_velocity(w->system, bodies[k], x->w));
        MUST(w, se3d_body_get_acceleration(w->system, bodies[k], now.a[k][0]));
        MUST(w, se3d_body_get_angular_acceleration(w->system, bodies[k], now.a[k][1]));
    }
    MUST(w, se3d_constraint_get_reaction(w->system, joint, now.reaction, NULL));
    MUST(w, se3d_system_get_energy(w->system, &energy));
    now.lost = energy.dissipated;
    return now;
}

/* The largest change of anything but accelerations. */
static double gap(const scene *a, const scene *b)
{
    const double *x = a->body[0].r, *y = b->body[0].r;
    double most = 0.0;
    for (size_t k = 0; k < offsetof(scene, a) / sizeof *x; ++k) {
        most = fmax(most, fabs(x[k] - y[k]));
    }
    return most;
}

/* How far velocities are from the differences of poses over `time`, in m/s and rad/s: the turn is
 * 2 conj(p_a) p_b of the body frame. */
static double mismatch(const pose *a, const pose *mid, const pose *b, double time)
{
    double most = 0.0;
    const double *p = a->p, *q = b->p;
    const double turn[3] = {
        2.0 * (p[0] * q[1] - p[1] * q[0] - p[2] * q[3] + p[3] * q[2]) / time,
        2.0 * (p[0] * q[2] + p[1] * q[3] - p[2] * q[0] - p[3] * q[1]) / time,
        2.0 * (p[0] * q[3] - p[1] * q[2] + p[2] * q[1] - p[3] * q[0]) / time,
    };
    for (int k = 0; k < 3; ++k) {
        most = fmax(most, fabs((b->r[k] - a->r[k]) / time - mid->v[k]));
        most = fmax(most, fabs(turn[k] - mid->w[k]));
    }
    return most;
}

/* How far accelerations are from the differences of velocities over `time`. */
static double bend(const scene *a, const scene *mid, const scene *b, double time)
{
    double most = 0.0;
    for (int j = 0; j < BODIES; ++j) {
        for (int k = 0; k < 3; ++k) {
            const double v = (b->body[j].v[k] - a->body[j].v[k]) / time;
            const double w = (b->body[j].w[k] - a->body[j].w[k]) / time;
            most = fmax(most, fmax(fabs(v - mid->a[j][0][k]), fabs(w - mid->a[j][1][k])));
        }
    }
    return most;
}

/* The power of the damper: c times the square of the rate of its length. */
static double power_of(const scene *x, double damping)
{
    double d[3], rate[3], length = 0.0, product = 0.0;
    const double points[BODIES][3] = {{0.5, 0.0, 0.0}, {0.0, 0.1, 0.0}};
    for (int b = 0; b < BODIES; ++b) {
        const pose *at = &x->body[b];
        const double sign = b == 0 ? -1.0 : 1.0, *p = at->p, *s = points[b], *w = at->w;
        const double turn[3] = {w[1] * s[2] - w[2] * s[1], w[2] * s[0] - w[0] * s[2],
                                w[0] * s[1] - w[1] * s[0]};
        for (int k = 0; k < 3; ++k) {
            const int m = (k + 1) % 3, n = (k + 2) % 3;
            const double row[3] = {1.0 - 2.0 * (p[m + 1] * p[m + 1] + p[n + 1] * p[n + 1]),
                                   2.0 * (p[k + 1] * p[m + 1] - p[0] * p[n + 1]),
                                   2.0 * (p[k + 1] * p[n + 1] + p[0] * p[m + 1])};
            const double place = row[0] * s[k] + row[1] * s[m] + row[2] * s[n];
            const double speed = row[0] * turn[k] + row[1] * turn[m] + row[2] * turn[n];
            d[k] = (b == 0 ? 0.0 : d[k]) + sign * (at->r[k] + place);
            rate[k] = (b == 0 ? 0.0 : rate[k]) + sign * (at->v[k] + speed);
        }
    }
    for (int k = 0; k < 3; ++k) {
        length += d[k] * d[k];
        product += d[k] * rate[k];
    }
    return damping * product * product / length;
}

static result follow(int32_t method, int32_t formulation, int rubs)
{
    world w;
    se3d_body bodies[BODIES];
    se3d_solver_def def = se3d_solver_def_default();
    result most = {0.0, 0.0, 0.0, 0.0, 0.0};
    const se3d_constraint joint = build(&w, rubs, bodies);
    def.method = method;
    def.formulation = formulation;
    def.step = STEP;
    MUST(&w, se3d_solver_create(w.system, &def, &w.solver));
    show(&w, bodies, joint, 0.0);
    for (int k = 0; k < 6; ++k) {
        for (double s = 0.17; s < 1.0; s += 0.24) {
            const double t = STEP * (k + s);
            const scene a = show(&w, bodies, joint, t);
            const scene mid = show(&w, bodies, joint, t + 0.5 * APART);
            const scene b = show(&w, bodies, joint, t + APART);
            const double lost = (b.lost - a.lost) / APART;
            for (int j = 0; j < BODIES; ++j) {
                most.off = fmax(most.off, mismatch(&a.body[j], &mid.body[j], &b.body[j], APART));
            }
            const double rubbed = rubs ? RUBBING * fabs(mid.body[0].w[2]) : 0.0;
            most.lost = fmax(most.lost, fabs(lost - power_of(&mid, DAMPING) - rubbed));
            most.bent = fmax(most.bent, bend(&a, &mid, &b, APART));
        }
        const scene before = show(&w, bodies, joint, STEP * (k + 1) - NEAR);
        const scene at = show(&w, bodies, joint, STEP * (k + 1));
        const scene after = show(&w, bodies, joint, STEP * (k + 1) + NEAR);
        most.jump = fmax(most.jump, fmax(gap(&before, &at), gap(&at, &after)));
        for (int j = 0; j < 3; ++j) {
            most.kick = fmax(most.kick, fabs(before.reaction[j] - at.reaction[j]));
            most.kick = fmax(most.kick, fabs(after.reaction[j] - at.reaction[j]));
        }
    }
    world_destroy(&w);
    return most;
}

static void motion_between_steps_is_smooth_and_one_with_its_velocities(void)
{
    for (int32_t method = 0; method < method_count(); ++method) {
        for (int k = 0; k < 6; ++k) {
            const int32_t formulation = k % 3;
            const int rubs = k / 3;
            /* accelerations and powers of newmark's steps go along straight lines */
            const int is_straight =
                method == SE3D_METHOD_GENERALIZED_ALPHA || method == SE3D_METHOD_HHT;
            const result most = follow(method, formulation, rubs);
            CHECK(most.jump < 2e-6);
            CHECK(most.off < 2e-6);
            CHECK(most.bent < (is_straight ? 0.25 : 1e-4));
            CHECK(most.kick < 1e-3);
            CHECK(most.lost < (is_straight ? 1e-2 : 2e-5));
            if (check_failures) {
                fprintf(stderr,
                        "%s, formulation %d, %s: jumps %.2e, velocities %.2e, accelerations %.2e, "
                        "power %.2e, reactions %.2e\n",
                        se3d_method_get_name(method), (int)formulation, rubs ? "pin" : "ball",
                        most.jump, most.off, most.bent, most.lost, most.kick);
                return;
            }
        }
    }
}

int main(void)
{
    RUN(motion_between_steps_is_smooth_and_one_with_its_velocities);
    return check_finish();
}
