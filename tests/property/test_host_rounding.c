/* SPDX-License-Identifier: BSD-3-Clause */
/* What is asked of a system between runs is computed as always, also where the host rounds another
 * way and flushes small numbers to zero; its setting stays. */
#include <fenv.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "check.h"
#include "se3d/se3d.h"

typedef struct asked {
    se3d_system *system, *hanging;
    se3d_body ground, body;
    se3d_marker marker;
    se3d_shape shape;
    se3d_force force;
    se3d_modes *modes;
    se3d_particles *particles;
} asked;

enum { NUMBERS = 16 };

static const double place[3] = {0.3, -0.7, 0.9};

typedef struct question {
    const char *name;
    se3d_status (*ask)(const asked *a, double out[NUMBERS]);
} question;

#define ASK(name, ...)                                                                             \
    static se3d_status do_##name(const asked *a, double out[NUMBERS])                              \
    {                                                                                              \
        return se3d_##name(__VA_ARGS__);                                                           \
    }
ASK(body_get_point, a->system, a->body, place, out)
ASK(marker_get_position, a->system, a->marker, out)
ASK(marker_get_velocity, a->system, a->marker, out)
ASK(marker_get_acceleration, a->system, a->marker, out)
ASK(marker_get_orientation, a->system, a->marker, out)
ASK(shape_get_nearest, a->system, a->shape, place, out, out + 3, out + 6)
ASK(force_get_wrench, a->system, a->force, 1, out)
ASK(modes_get_eigenvalue, a->modes, 0, (se3d_eigenvalue *)out)
ASK(modes_get_shape, a->modes, 0, 0, out, out + 6)
ASK(particles_get_energy, a->particles, (se3d_particles_energy *)out)
ASK(particles_get_wrench, a->particles, a->body, out, out + 3)
ASK(particles_get_step, a->particles, out)

#define ROW(name)                                                                                  \
    {                                                                                              \
#name, do_##name                                                                           \
    }
static const question questions[] = {
    ROW(body_get_point),          ROW(marker_get_position),    ROW(marker_get_velocity),
    ROW(marker_get_acceleration), ROW(marker_get_orientation), ROW(shape_get_nearest),
    ROW(force_get_wrench),        ROW(modes_get_eigenvalue),   ROW(modes_get_shape),
    ROW(particles_get_energy),    ROW(particles_get_wrench),   ROW(particles_get_step)};

static void add_body(asked *a)
{
    se3d_body_def body = se3d_body_def_default();
    se3d_marker_def marker = se3d_marker_def_default();
    se3d_tsda_def spring = se3d_tsda_def_default();
    const double axis[3] = {0.6, 0.0, 0.8}, p[4] = {0.36, 0.48, 0.48, 0.64};
    body.mass = 1.3;
    memcpy(body.orientation, p, sizeof p);
    for (int k = 0; k < 3; ++k) {
        body.inertia[k] = 0.1 + 0.01 * k;
        body.angular_velocity[k] = 0.1 * (k + 1);
        body.velocity[k] = 0.7 / (k + 1);
        marker.position[k] = place[2 - k];
        spring.point_j[k] = 0.1 * place[k];
    }
    CHECK(!se3d_body_create(a->system, &body, &a->body));
    marker.body = spring.body_j = a->body;
    memcpy(marker.orientation, p, sizeof p);
    CHECK(!se3d_marker_create(a->system, &marker, &a->marker));
    spring.body_i = a->ground;
    memcpy(spring.point_i, axis, sizeof axis);
    spring.k = 11.0;
    spring.c = 0.3;
    CHECK(!se3d_force_create_tsda(a->system, &spring, &a->force));
}

static void add_shape(asked *a)
{
    se3d_material_def stuff = se3d_material_def_default();
    se3d_shape_def shape = se3d_shape_def_default();
    const double r[3] = {3.0, 0.1, 0.2}, v[3] = {0.1, 0.2, 0.3}, radius = 0.07;
    stuff.density = 1100.0;
    stuff.stiffness = 1e4;
    CHECK(!se3d_material_create(a->system, &stuff, &shape.material));
    shape.body = a->body;
    shape.radius = 0.123;
    shape.position[1] = 0.3;
    CHECK(!se3d_shape_create_sphere(a->system, &shape, &a->shape));
    CHECK(!se3d_particles_create(a->system, NULL, &a->particles));
    CHECK(!se3d_particles_add(a->particles, shape.material, 1, r, &radius, v, v, NULL));
}

/* Of a pendulum that hangs. */
static void open_modes(asked *a)
{
    se3d_body_def body = se3d_body_def_default();
    se3d_joint_def joint = se3d_joint_def_default();
    se3d_constraint pin;
    const double g[3] = {0.0, 0.0, -9.81};
    CHECK(!se3d_system_create(NULL, &a->hanging));
    CHECK(!se3d_system_set_gravity(a->hanging, g));
    CHECK(!se3d_system_get_ground(a->hanging, &joint.body_i));
    body.mass = 1.3;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 0.3;
    joint.point_i[2] = 0.7;
    joint.point_j[2] = 0.7;
    joint.axis_i[1] = joint.axis_j[1] = 1.0;
    joint.axis_i[2] = joint.axis_j[2] = 0.0;
    CHECK(!se3d_body_create(a->hanging, &body, &joint.body_j));
    CHECK(!se3d_joint_create_revolute(a->hanging, &joint, &pin));
    CHECK(!se3d_modes_create(a->hanging, NULL, &a->modes));
}

/* After a step, so that nothing is a whole number. */
static void open_asked(asked *a)
{
    se3d_solver *solver = NULL;
    se3d_solver_def how = se3d_solver_def_default();
    memset(a, 0, sizeof *a);
    CHECK(!se3d_system_create(NULL, &a->system));
    CHECK(!se3d_system_get_ground(a->system, &a->ground));
    add_body(a);
    open_modes(a);
    add_shape(a);
    how.method = SE3D_METHOD_VERLET;
    CHECK(!SE3D_FAILED(se3d_solver_create(a->system, &how, &solver)));
    CHECK(!SE3D_FAILED(se3d_solver_run(solver, 0.0123)));
    se3d_solver_destroy(solver);
}

static void close_asked(asked *a)
{
    se3d_modes_destroy(a->modes);
    se3d_system_destroy(a->hanging);
    se3d_system_destroy(a->system);
}

static void set_small_to_zero(int on)
{
#if defined(__SSE2__)
    const unsigned int flags = 0x8040u;
    _mm_setcsr(on ? _mm_getcsr() | flags : _mm_getcsr() & ~flags);
#else
    (void)on;
#endif
}

static void answers_do_not_depend_on_the_rounding_of_the_host(void)
{
#if defined(FE_UPWARD) && defined(FE_DOWNWARD) && defined(FE_TOWARDZERO)
    static const int modes[] = {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
    asked a;
    open_asked(&a);
    for (size_t k = 0; k < sizeof questions / sizeof *questions; ++k) {
        double expected[NUMBERS] = {0.0};
        CHECK(questions[k].ask(&a, expected) == SE3D_OK);
        for (size_t m = 0; m < sizeof modes / sizeof *modes; ++m) {
            double found[NUMBERS] = {0.0};
            CHECK(fesetround(modes[m]) == 0);
            set_small_to_zero(1);
            const se3d_status status = questions[k].ask(&a, found);
            const int stays = fegetround() == modes[m];
            set_small_to_zero(0);
            fesetround(FE_TONEAREST);
            if (status != SE3D_OK || !stays || memcmp(found, expected, sizeof found) != 0) {
                fprintf(stderr, "%s in mode %zu\n", questions[k].name, m);
                CHECK(0);
            }
        }
    }
    close_asked(&a);
#endif
}

int main(void)
{
    RUN(answers_do_not_depend_on_the_rounding_of_the_host);
    return check_finish();
}
