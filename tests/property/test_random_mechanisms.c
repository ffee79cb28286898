/* SPDX-License-Identifier: BSD-3-Clause */
/* Random mechanisms: trees and loops of all joint types between bodies at random poses, with random
 * frames, springs, dampers and velocities. r-p and r-omega, dop853 and radau give one motion, the
 * audit of energy closes, and if nothing holds them momentum is kept; methods with fixed steps
 * come near. With arguments FIRST COUNT: more of them. */
#include <stdlib.h>

#include "check.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "se3d/se3d.h"

enum { BODIES_MAX = 6, SPRINGS = 3 };
#define DURATION 0.4 /* s, so short that chaos does not magnify what differs */

typedef struct mechanism {
    se3d_system *system;
    se3d_body ground, bodies[BODIES_MAX];
    double r[BODIES_MAX][3], p[BODIES_MAX][4];
    int count, free; /* bodies, freedoms at least */
    int afloat;      /* nothing holds it, and there is no gravity */
    uint64_t seed;
} mechanism;

typedef se3d_status (*joint_create)(se3d_system *, const se3d_joint_def *, se3d_constraint *);

/* Which axes a joint has, and how many freedoms it takes away. */
static const struct kind {
    joint_create create;
    int taken;
    int square, apart; /* axes at right angles; points apart */
} kinds[] = {
    {se3d_joint_create_revolute, 5, 0, 0},       {se3d_joint_create_spherical, 3, 0, 0},
    {se3d_joint_create_prismatic, 5, 0, 0},      {se3d_joint_create_cylindrical, 4, 0, 0},
    {se3d_joint_create_universal, 4, 1, 0},      {se3d_joint_create_planar, 3, 0, 0},
    {se3d_joint_create_screw, 5, 0, 0},          {se3d_joint_create_point_on_line, 2, 0, 0},
    {se3d_joint_create_point_on_plane, 1, 0, 0}, {se3d_joint_create_distance, 1, 0, 1},
    {se3d_joint_create_parallel, 2, 0, 0},       {se3d_joint_create_perpendicular, 1, 1, 0},
    {se3d_joint_create_orientation, 3, 0, 0},    {se3d_joint_create_fixed, 6, 0, 0},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

static double uniform(mechanism *m, double low, double high)
{
    return low + 0.5 * (high - low) * (1.0 + check_random(&m->seed));
}

static int below(mechanism *m, int count)
{
    int k = (int)uniform(m, 0.0, count);
    return k < count ? k : count - 1;
}

static void random_vector(mechanism *m, double *v, int count, double scale)
{
    for (int k = 0; k < count; ++k) {
        v[k] = uniform(m, -scale, scale);
    }
}

static void random_unit(mechanism *m, double *v, int count)
{
    double square = 0.0;
    while (square < 0.1) {
        random_vector(m, v, count, 1.0);
        square = 0.0;
        for (int k = 0; k < count; ++k) {
            square += v[k] * v[k];
        }
    }
    for (int k = 0; k < count; ++k) {
        v[k] /= sqrt(square);
    }
}

static void add_body(mechanism *m)
{
    const int k = m->count++;
    se3d_body_def def = se3d_body_def_default();
    double a = uniform(m, 0.1, 1.0), b = uniform(m, 0.1, 1.0), c = uniform(m, 0.1, 1.0);
    random_vector(m, m->r[k], 3, 2.0);
    random_unit(m, m->p[k], 4);
    def.mass = uniform(m, 0.5, 5.0);
    def.inertia[0] = b + c;
    def.inertia[1] = a + c;
    def.inertia[2] = a + b;
    memcpy(def.position, m->r[k], sizeof def.position);
    memcpy(def.orientation, m->p[k], sizeof def.orientation);
    random_vector(m, def.velocity, 3, 1.0);
    random_vector(m, def.angular_velocity, 3, 2.0);
    CHECK(!se3d_body_create(m->system, &def, &m->bodies[k]));
}

/* Index -1: the ground. */
static se3d_body body_of(const mechanism *m, int k)
{
    return k < 0 ? m->ground : m->bodies[k];
}

/* A point and a direction of the ground in the frame of a body. */
static void to_body(const mechanism *m, int k, const double point[3], const double axis[3],
                    double local_point[3], double local_axis[3])
{
    double A[9], d[3];
    if (k < 0) {
        memcpy(local_point, point, 3 * sizeof *point);
        memcpy(local_axis, axis, 3 * sizeof *axis);
        return;
    }
    se3di_quat_to_matrix(m->p[k], A);
    for (int c = 0; c < 3; ++c) {
        d[c] = point[c] - m->r[k][c];
    }
    for (int c = 0; c < 3; ++c) {
        local_point[c] = A[c] * d[0] + A[3 + c] * d[1] + A[6 + c] * d[2];
        local_axis[c] = A[c] * axis[0] + A[3 + c] * axis[1] + A[6 + c] * axis[2];
    }
}

static void add_joint(mechanism *m, int i, int j, const struct kind *kind)
{
    double at[3], at_j[3], axis[3], other[3], unused[3];
    se3d_constraint joint;
    se3d_joint_def def = se3d_joint_def_default();
    random_vector(m, at, 3, 2.0);
    random_unit(m, axis, 3);
    random_unit(m, other, 3);
    memcpy(at_j, at, sizeof at);
    memcpy(unused, axis, sizeof axis);
    if (kind->square) {
        double along = se3di_dot(axis, other);
        for (int c = 0; c < 3; ++c) {
            unused[c] = other[c] - along * axis[c];
        }
    }
    if (kind->apart) {
        def.distance = uniform(m, 0.5, 2.0);
        for (int c = 0; c < 3; ++c) {
            at_j[c] += def.distance * other[c];
        }
    }
    def.pitch = uniform(m, 0.05, 0.5);
    def.body_i = body_of(m, i);
    def.body_j = body_of(m, j);
    to_body(m, i, at, axis, def.point_i, def.axis_i);
    to_body(m, j, at_j, unused, def.point_j, def.axis_j);
    CHECK(!kind->create(m->system, &def, &joint));
    m->free -= kind->taken;
}

static void add_spring(mechanism *m, int i, int j)
{
    se3d_tsda_def def = se3d_tsda_def_default();
    se3d_force force;
    def.body_i = body_of(m, i);
    def.body_j = body_of(m, j);
    random_vector(m, def.point_i, 3, 1.0);
    random_vector(m, def.point_j, 3, 1.0);
    def.k = uniform(m, 0.0, 50.0);
    def.c = uniform(m, 0.0, 3.0);
    def.l0 = uniform(m, 0.0, 2.0);
    def.preload = uniform(m, -3.0, 3.0);
    CHECK(!se3d_force_create_tsda(m->system, &def, &force));
}

/* A tree of the first bodies, each on an earlier one, and joints that close loops as long as two
 * freedoms are left. */
static void build(mechanism *m, uint64_t seed)
{
    *m = (mechanism){.seed = seed * 2654435761u + 99991u};
    check_random(&m->seed);
    double gravity[3];
    const int count = 1 + below(m, BODIES_MAX);
    CHECK(!se3d_system_create(NULL, &m->system));
    CHECK(!se3d_system_get_ground(m->system, &m->ground));
    m->afloat = count > 1 && below(m, 3) == 0;
    random_vector(m, gravity, 3, m->afloat ? 0.0 : 10.0);
    CHECK(!se3d_system_set_gravity(m->system, gravity));
    for (int k = 0; k < count; ++k) {
        add_body(m);
        m->free += 6;
        if (k > 0 || !m->afloat) {
            add_joint(m, m->afloat ? below(m, k) : below(m, k + 1) - 1, k, &kinds[below(m, KINDS)]);
        }
    }
    for (int tries = below(m, 4); tries > 0; --tries) {
        const int i = below(m, count), j = m->afloat ? below(m, count) : below(m, count + 1) - 1;
        const struct kind *kind = &kinds[below(m, KINDS)];
        if (i != j && m->free - kind->taken >= (m->afloat ? 8 : 2)) {
            add_joint(m, j, i, kind);
        }
    }
    for (int k = below(m, SPRINGS + 1); k > 0; --k) {
        const int i = below(m, count), j = m->afloat ? below(m, count) : below(m, count + 1) - 1;
        if (i != j) {
            add_spring(m, j, i);
        }
    }
}

/* Energy by the audit, and momentum about the origin [6]. */
static double measure(const mechanism *m, double momentum[6], double *size)
{
    se3d_energy energy;
    se3d_work work;
    CHECK(!se3d_system_get_energy(m->system, &energy));
    CHECK(!se3d_system_get_work(m->system, &work));
    memset(momentum, 0, 6 * sizeof *momentum);
    for (int k = 0; k < m->count; ++k) {
        double r[3], v[3], w[3], p[4], A[9], L[3], cross[3], mass, J[6];
        CHECK(!se3d_body_get_position(m->system, m->bodies[k], r));
        CHECK(!se3d_body_get_velocity(m->system, m->bodies[k], v));
        CHECK(!se3d_body_get_orientation(m->system, m->bodies[k], p));
        CHECK(!se3d_body_get_angular_velocity(m->system, m->bodies[k], w));
        CHECK(!se3d_body_get_mass(m->system, m->bodies[k], &mass, J));
        se3di_quat_to_matrix(p, A);
        se3di_cross(r, v, cross);
        for (int c = 0; c < 3; ++c) {
            L[c] = J[c] * w[c];
        }
        for (int c = 0; c < 3; ++c) {
            momentum[c] += mass * v[c];
            momentum[3 + c] +=
                mass * cross[c] + A[3 * c] * L[0] + A[3 * c + 1] * L[1] + A[3 * c + 2] * L[2];
        }
    }
    *size = fabs(energy.kinetic) + fabs(energy.potential) + fabs(work.dissipated) + 1.0;
    return energy.kinetic + energy.potential + work.dissipated - work.actuators - work.drivers;
}

typedef struct outcome {
    se3d_status status;
    double r[BODIES_MAX][3], v[BODIES_MAX][3]; /* at the end */
    double balance, drift;                     /* what energy and momentum miss, relative */
} outcome;

static outcome run(uint64_t seed, int32_t formulation, int32_t method, double tolerance,
                   double step)
{
    mechanism m;
    outcome out = {.status = SE3D_OK};
    se3d_solver *solver = NULL;
    se3d_solver_def def = se3d_solver_def_default();
    double first[6], last[6], size, most;
    build(&m, seed);
    def.formulation = formulation;
    def.method = method;
    def.tolerance = tolerance;
    def.step = step;
    CHECK(!se3d_solver_create(m.system, &def, &solver));
    out.status = se3d_solver_run(solver, 0.0);
    const double begin = measure(&m, first, &size);
    for (int k = 1; k <= 4 && out.status >= 0; ++k) {
        out.status = se3d_solver_run(solver, DURATION * k / 4);
    }
    out.balance = fabs(measure(&m, last, &most) - begin) / fmax(size, most);
    for (int c = 0; c < 6 && m.afloat; ++c) {
        out.drift = fmax(out.drift, fabs(last[c] - first[c]) / fmax(size, most));
    }
    for (int k = 0; k < m.count; ++k) {
        CHECK(!se3d_body_get_position(m.system, m.bodies[k], out.r[k]));
        CHECK(!se3d_body_get_velocity(m.system, m.bodies[k], out.v[k]));
    }
    se3d_solver_destroy(solver);
    se3d_system_destroy(m.system);
    return out;
}

/* The largest gap of positions [m] and of velocities [m/s]. */
static double gap(const outcome *a, const outcome *b)
{
    double off = 0.0;
    for (int k = 0; k < BODIES_MAX; ++k) {
        for (int c = 0; c < 3; ++c) {
            off = fmax(off, fabs(a->r[k][c] - b->r[k][c]));
            off = fmax(off, 0.1 * fabs(a->v[k][c] - b->v[k][c]));
        }
    }
    return off;
}

static void expect(uint64_t seed, const char *what, double value, double bound)
{
    if (!(value <= bound)) {
        printf("mechanism %llu: %s %.3g, at most %.3g\n", (unsigned long long)seed, what, value,
               bound);
    }
    CHECK(value <= bound);
}

static const struct fixed {
    const char *name;
    int32_t method;
    double step, bound;
} fixed_steps[] = {{"generalized_alpha", SE3D_METHOD_GENERALIZED_ALPHA, 5e-4, 2e-3},
                   {"hht", SE3D_METHOD_HHT, 5e-4, 2e-2},
                   {"bdf", SE3D_METHOD_BDF, 0.0, 1e-3},
                   {"rattle", SE3D_METHOD_RATTLE, 5e-4, 2e-3},
                   {"verlet", SE3D_METHOD_VERLET, 5e-4, 2e-3}};

/* To a loose tolerance in r-omega, and to a tight one in joint coordinates. */
static void try_gauss(uint64_t seed, const outcome *exact)
{
    const outcome loose = run(seed, SE3D_FORMULATION_ROMEGA, SE3D_METHOD_GAUSS, 1e-5, 0.0);
    const outcome tight = run(seed, SE3D_FORMULATION_JOINT, SE3D_METHOD_GAUSS, 1e-9, 0.0);
    CHECK(loose.status >= 0 && tight.status >= 0);
    expect(seed, "gauss against dop853", gap(exact, &loose), 1e-4);
    expect(seed, "gauss in joint coordinates", gap(exact, &tight), 1e-7);
    expect(seed, "energy with gauss", tight.balance, 1e-8);
    expect(seed, "momentum with gauss", tight.drift, 1e-8);
}

/* Returns 1 if the mechanism moves: one that locks at once is of no use here. */
static int try_mechanism(uint64_t seed)
{
    const outcome a = run(seed, SE3D_FORMULATION_ROMEGA, SE3D_METHOD_DOP853, 1e-10, 0.0);
    const outcome b = run(seed, SE3D_FORMULATION_RP, SE3D_METHOD_DOP853, 1e-10, 0.0);
    if (a.status < 0 || b.status < 0) {
        printf("mechanism %llu: %d %d\n", (unsigned long long)seed, (int)a.status, (int)b.status);
        CHECK((a.status < 0) == (b.status < 0));
        return 0;
    }
    const outcome j = run(seed, SE3D_FORMULATION_JOINT, SE3D_METHOD_DOP853, 1e-10, 0.0);
    CHECK(j.status >= 0);
    expect(seed, "joint coordinates against r-omega", gap(&a, &j), 1e-7);
    expect(seed, "energy in joint coordinates", j.balance, 1e-8);
    expect(seed, "momentum in joint coordinates", j.drift, 1e-9);
    try_gauss(seed, &a);
    const outcome c = run(seed, SE3D_FORMULATION_ROMEGA, SE3D_METHOD_RADAU, 1e-9, 0.0);
    const outcome d = run(seed, SE3D_FORMULATION_RP, SE3D_METHOD_RADAU, 1e-9, 0.0);
    CHECK(c.status >= 0 && d.status >= 0);
    expect(seed, "r-p against r-omega", gap(&a, &b), 1e-7);
    expect(seed, "radau against dop853", gap(&a, &c), 1e-6);
    expect(seed, "radau in r-p against dop853", gap(&a, &d), 1e-6);
    expect(seed, "energy", fmax(a.balance, b.balance), 1e-8);
    expect(seed, "energy with radau", fmax(c.balance, d.balance), 1e-6);
    expect(seed, "momentum", fmax(a.drift, b.drift), 1e-9);
    expect(seed, "momentum with radau", fmax(c.drift, d.drift), 1e-7);
    for (size_t k = 0; k < sizeof fixed_steps / sizeof *fixed_steps; ++k) {
        const struct fixed *way = &fixed_steps[k];
        const int32_t formulation = k % 2 ? SE3D_FORMULATION_RP : SE3D_FORMULATION_ROMEGA;
        const outcome e = run(seed, formulation, way->method, 1e-6, way->step);
        expect(seed, way->name, e.status < 0 ? HUGE_VAL : gap(&a, &e), way->bound);
    }
    return 1;
}

static uint64_t seed_first = 1, seed_count = 60;

static void random_mechanisms_move_alike_in_every_way(void)
{
    uint64_t moved = 0;
    for (uint64_t k = 0; k < seed_count; ++k) {
        moved += (uint64_t)try_mechanism(seed_first + k);
    }
    CHECK(4 * moved >= 3 * seed_count);
}

int main(int argc, char **argv)
{
    if (argc == 3) {
        seed_first = strtoull(argv[1], NULL, 10);
        seed_count = strtoull(argv[2], NULL, 10);
    }
    RUN(random_mechanisms_move_alike_in_every_way);
    return check_finish();
}
