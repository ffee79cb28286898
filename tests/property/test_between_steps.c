/* SPDX-License-Identifier: BSD-3-Clause */
/* What is shown between two steps is one smooth motion through both of their ends: velocities are
 * the derivatives of the poses that are shown, what is dissipated that of the damper's power, and
 * nothing jumps where steps meet. */
#include "support/mechanisms.h"
#include "support/methods.h"

#define STEP  0.02
#define NEAR  1e-7 /* time between two states that are one but for what moves */
#define APART 1e-5 /* of the differences that are compared with velocities */

#define DAMPING 0.5
#define BODIES  2

typedef struct pose {
    double r[3], p[4], v[3], w[3]; /* w: body frame */
} pose;

typedef struct scene {
    pose body[BODIES];
    double lost; /* what the damper has taken up [J] */
} scene;

typedef struct result {
    double jump, off, lost; /* the largest: where steps meet, of velocities, of the power */
} result;

/* A body that tumbles and falls, and one that swings on a ball joint with a spring between them. */
static void build(world *w, se3d_body bodies[BODIES])
{
    const double ball[3] = {0.0, 0.0, 0.0}, axis[3] = {0.0, 0.0, 1.0};
    const double spin[3] = {1.0, 3.0, -2.0}, velocity[3] = {0.3, 1.0, -0.5};
    const double corner[2] = {0.0, 0.0};
    se3d_body_def def = se3d_body_def_default();
    se3d_tsda_def spring = se3d_tsda_def_default();
    se3d_force force;
    *w = world_create();
    bodies[0] = add_bar(w, "bar", corner, 0.2, 1.0, 1.5);
    add_joint(w, se3d_joint_create_spherical, "ball", w->ground, bodies[0], ball, axis);
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
}

static scene show(world *w, const se3d_body bodies[BODIES], double t)
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
    }
    MUST(w, se3d_system_get_energy(w->system, &energy));
    now.lost = energy.dissipated;
    return now;
}

/* The largest change of anything. */
static double gap(const scene *a, const scene *b)
{
    const double *x = a->body[0].r, *y = b->body[0].r;
    double most = 0.0;
    for (size_t k = 0; k < sizeof *a / sizeof *x; ++k) {
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

static result follow(int32_t method, int32_t formulation)
{
    world w;
    se3d_body bodies[BODIES];
    se3d_solver_def def = se3d_solver_def_default();
    result most = {0.0, 0.0, 0.0};
    build(&w, bodies);
    def.method = method;
    def.formulation = formulation;
    def.step = STEP;
    MUST(&w, se3d_solver_create(w.system, &def, &w.solver));
    show(&w, bodies, 0.0);
    for (int k = 0; k < 6; ++k) {
        for (double s = 0.17; s < 1.0; s += 0.24) {
            const double t = STEP * (k + s);
            const scene a = show(&w, bodies, t);
            const scene mid = show(&w, bodies, t + 0.5 * APART);
            const scene b = show(&w, bodies, t + APART);
            const double lost = (b.lost - a.lost) / APART;
            for (int j = 0; j < BODIES; ++j) {
                most.off = fmax(most.off, mismatch(&a.body[j], &mid.body[j], &b.body[j], APART));
            }
            most.lost = fmax(most.lost, fabs(lost - power_of(&mid, DAMPING)));
        }
        const scene before = show(&w, bodies, STEP * (k + 1) - NEAR);
        const scene at = show(&w, bodies, STEP * (k + 1));
        const scene after = show(&w, bodies, STEP * (k + 1) + NEAR);
        most.jump = fmax(most.jump, fmax(gap(&before, &at), gap(&at, &after)));
    }
    world_destroy(&w);
    return most;
}

static void motion_between_steps_is_smooth_and_one_with_its_velocities(void)
{
    for (int32_t method = 0; method < method_count(); ++method) {
        for (int32_t formulation = 0; formulation < 3; ++formulation) {
            const result most = follow(method, formulation);
            /* the powers of newmark's steps go along a straight line */
            const int is_straight =
                method == SE3D_METHOD_GENERALIZED_ALPHA || method == SE3D_METHOD_HHT;
            CHECK(most.jump < 2e-6);
            CHECK(most.off < 2e-6);
            CHECK(most.lost < (is_straight ? 1e-2 : 2e-5));
            if (check_failures) {
                fprintf(stderr, "%s, formulation %d: jumps %.2e, velocities %.2e, power %.2e\n",
                        se3d_method_get_name(method), (int)formulation, most.jump, most.off,
                        most.lost);
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
