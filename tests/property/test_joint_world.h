/* SPDX-License-Identifier: BSD-3-Clause */
/* What the tests of joints share: a system of moving bodies at random states, every joint between
 * two of them at a pose that meets it, and the freedoms that it must leave. */
#ifndef SE3D_TESTS_JOINT_WORLD_H
#define SE3D_TESTS_JOINT_WORLD_H

#include "check.h"

#include "math/quaternion.h"
#include "math/vec3.h"
#include "primitive/turn_counter.h"
#include "system/system_internal.h"

#define WORLD_BODIES 4

typedef struct world {
    se3d_system *system;
    se3d_body ground;
    se3d_body body[WORLD_BODIES];
    uint64_t seed;
} world;

static inline void world_random(world *w, double *values, int count, double scale)
{
    for (int k = 0; k < count; ++k) {
        values[k] = scale * check_random(&w->seed);
    }
}

static inline void world_random_unit(world *w, double *values, int count)
{
    double square = 0.0;
    while (square < 0.1) {
        world_random(w, values, count, 1.0);
        square = 0.0;
        for (int k = 0; k < count; ++k) {
            square += values[k] * values[k];
        }
    }
    for (int k = 0; k < count; ++k) {
        values[k] /= sqrt(square);
    }
}

static inline void world_init(world *w, uint64_t seed)
{
    *w = (world){.seed = seed};
    CHECK(se3d_system_create(NULL, &w->system) == SE3D_OK);
    CHECK(se3d_system_get_ground(w->system, &w->ground) == SE3D_OK);
    for (int k = 0; k < WORLD_BODIES; ++k) {
        se3d_body_def def = se3d_body_def_default();
        def.mass = 1.0 + k;
        def.inertia[0] = 0.3;
        def.inertia[1] = 0.4;
        def.inertia[2] = 0.5;
        world_random(w, def.position, 3, 2.0);
        world_random_unit(w, def.orientation, 4);
        world_random(w, def.velocity, 3, 1.0);
        world_random(w, def.angular_velocity, 3, 1.0);
        CHECK(se3d_body_create(w->system, &def, &w->body[k]) == SE3D_OK);
    }
}

static inline void world_destroy(world *w)
{
    se3d_system_destroy(w->system);
}

static inline uint32_t world_index(const world *w, se3d_body body)
{
    return se3di_slots_find(&w->system->model.body_slots, body.index1, body.generation);
}

static inline const se3di_frame *world_frame(const world *w, se3d_body body)
{
    return &w->system->model.frames[world_index(w, body)];
}

typedef se3d_status (*joint_create)(se3d_system *, const se3d_joint_def *, se3d_constraint *);

/* The motions that a joint leaves to body j, in an order in which a finite one does not spoil the
 * later ones. */
typedef struct freedom {
    char kind;  /* r: turn about a line, t: slide, s: screw about axis_i; 0: end of the list */
    char axis;  /* a: axis_i, b: axis_j, r: ref_i, t: third_i, x y z: ground axes */
    char point; /* r: the line goes through P_i (i) or P_j (j) */
} freedom;

typedef struct joint_case {
    const char *name;
    joint_create create;
    int rows;
    int angle, displacement; /* has the coordinate */
    int square;              /* axis_j is perpendicular to axis_i */
    char place; /* P_j: i at P_i, a slid along axis_i, b along axis_j, c the same beside P_i, p in
                   the plane perpendicular to axis_i, f anywhere */
    const char *row_names;
    freedom freedoms[6];
} joint_case;

#define WORLD_PITCH 0.37

static const joint_case joint_cases[] = {
    {"fixed", se3d_joint_create_fixed, 6, 0, 0, 0, 'i', "cd_x cd_y cd_z dp1_a dp1_b dp1_c", {{0}}},
    {"revolute",
     se3d_joint_create_revolute,
     5,
     1,
     0,
     0,
     'i',
     "cd_x cd_y cd_z dp1_a dp1_b",
     {{'r', 'a', 'i'}}},
    {"prismatic",
     se3d_joint_create_prismatic,
     5,
     0,
     1,
     0,
     'a',
     "dp1_a dp1_b dp2_a dp2_b dp1_c",
     {{'t', 'a', 0}}},
    {"cylindrical",
     se3d_joint_create_cylindrical,
     4,
     1,
     1,
     0,
     'a',
     "dp1_a dp1_b dp2_a dp2_b",
     {{'t', 'a', 0}, {'r', 'a', 'i'}}},
    {"spherical",
     se3d_joint_create_spherical,
     3,
     0,
     0,
     0,
     'i',
     "cd_x cd_y cd_z",
     {{'r', 'x', 'i'}, {'r', 'y', 'i'}, {'r', 'z', 'i'}}},
    {"universal",
     se3d_joint_create_universal,
     4,
     0,
     0,
     1,
     'i',
     "cd_x cd_y cd_z dp1",
     {{'r', 'b', 'i'}, {'r', 'a', 'i'}}},
    {"planar",
     se3d_joint_create_planar,
     3,
     1,
     0,
     0,
     'p',
     "dp1_a dp1_b dp2",
     {{'r', 'a', 'j'}, {'t', 'r', 0}, {'t', 't', 0}}},
    {"screw",
     se3d_joint_create_screw,
     5,
     1,
     1,
     0,
     'a',
     "dp1_a dp1_b dp2_a dp2_b screw",
     {{'s', 'a', 'i'}}},
    {"point_on_line",
     se3d_joint_create_point_on_line,
     2,
     0,
     1,
     0,
     'a',
     "dp2_a dp2_b",
     {{'r', 'x', 'j'}, {'r', 'y', 'j'}, {'r', 'z', 'j'}, {'t', 'a', 0}}},
    {"point_on_plane",
     se3d_joint_create_point_on_plane,
     1,
     0,
     0,
     0,
     'p',
     "dp2",
     {{'r', 'x', 'j'}, {'r', 'y', 'j'}, {'r', 'z', 'j'}, {'t', 'r', 0}, {'t', 't', 0}}},
    {"distance",
     se3d_joint_create_distance,
     1,
     0,
     0,
     0,
     'f',
     "d",
     {{'r', 'x', 'j'}, {'r', 'y', 'j'}, {'r', 'z', 'j'}, {'r', 'a', 'i'}, {'r', 'r', 'i'}}},
    {"revolute_spherical",
     se3d_joint_create_revolute_spherical,
     2,
     0,
     0,
     0,
     'p',
     "d dp2",
     {{'r', 'x', 'j'}, {'r', 'y', 'j'}, {'r', 'z', 'j'}, {'r', 'a', 'i'}}},
    {"revolute_cylindrical",
     se3d_joint_create_revolute_cylindrical,
     3,
     0,
     0,
     1,
     'c',
     "dp1 dp2 triple",
     {{'r', 'b', 'j'}, {'t', 'b', 0}, {'r', 'a', 'i'}}},
    {"parallel",
     se3d_joint_create_parallel,
     2,
     1,
     0,
     0,
     'f',
     "dp1_a dp1_b",
     {{'r', 'a', 'j'}, {'t', 'x', 0}, {'t', 'y', 0}, {'t', 'z', 0}}},
    {"perpendicular",
     se3d_joint_create_perpendicular,
     1,
     0,
     0,
     1,
     'f',
     "dp1",
     {{'r', 'b', 'j'}, {'r', 'a', 'j'}, {'t', 'x', 0}, {'t', 'y', 0}, {'t', 'z', 0}}},
    {"orientation",
     se3d_joint_create_orientation,
     3,
     0,
     0,
     0,
     'f',
     "dp1_a dp1_b dp1_c",
     {{'t', 'x', 0}, {'t', 'y', 0}, {'t', 'z', 0}}},
    {"perpendicular1",
     se3d_joint_create_perpendicular1,
     2,
     1,
     0,
     0,
     'f',
     "dp1_a dp1_b",
     {{'r', 'a', 'j'}, {'t', 'x', 0}, {'t', 'y', 0}, {'t', 'z', 0}}},
    {"perpendicular2",
     se3d_joint_create_perpendicular2,
     2,
     0,
     1,
     0,
     'a',
     "dp2_a dp2_b",
     {{'r', 'x', 'j'}, {'r', 'y', 'j'}, {'r', 'z', 'j'}, {'t', 'a', 0}}},
};
#define JOINT_CASES (sizeof joint_cases / sizeof *joint_cases)

/* A def at the present (random) poses that meets the joint, with angle0 = 0.4. */
static inline void world_joint_def(world *w, const joint_case *c, se3d_body body_i,
                                   se3d_body body_j, se3d_joint_def *def)
{
    double at[3], axis[3], other[3], ref[3];
    *def = se3d_joint_def_default();
    def->name = c->name;
    def->body_i = body_i;
    def->body_j = body_j;
    def->pitch = WORLD_PITCH;
    def->angle0 = 0.4;
    world_random(w, at, 3, 1.0);
    world_random_unit(w, axis, 3);
    world_random_unit(w, ref, 3);
    CHECK(se3d_joint_def_set_frame(w->system, def, at, axis, ref) == SE3D_OK);
    const se3di_frame *j = world_frame(w, body_j);
    double third[3], direction[3];
    se3di_cross(axis, ref, third); /* perpendicular to the axis */
    se3di_scale(1.0 / se3di_norm(third), third, third);
    se3di_cross(axis, third, other);
    if (c->square) {
        se3di_mul_transposed(j->A, third, def->axis_j);
    }
    double u[3], shift[3] = {0.0, 0.0, 0.0};
    world_random_unit(w, u, 3);
    if (c->place == 'a' || c->place == 'f') {
        se3di_add_scaled(0.3 + u[0], axis, shift);
    }
    if (c->place == 'c') { /* def.distance away along the common normal */
        se3di_add_scaled(-0.7, other, shift);
        def->distance = 0.7;
    }
    if (c->place == 'b' || c->place == 'c') {
        se3di_add_scaled(0.3 + u[0], third, shift);
    }
    if (c->place == 'p' || c->place == 'f') {
        se3di_add_scaled(u[1], third, shift);
        se3di_add_scaled(u[2], other, shift);
    }
    se3di_mul_transposed(j->A, shift, direction);
    se3di_add(def->point_j, direction, def->point_j);
}

/* The line or direction of a freedom in the ground frame at the present poses. */
static inline void freedom_geometry(const world *w, const joint_case *c, const freedom *f,
                                    se3d_constraint joint, double axis[3], double point[3])
{
    (void)c;
    const se3di_model *m = &w->system->model;
    uint32_t index = se3di_slots_find(&m->constraint_slots, joint.index1, joint.generation);
    const se3di_constraint *constraint = &m->constraints[index];
    const se3di_joint_frames *s = &constraint->frames;
    const se3di_frame *i = &m->frames[constraint->bodies[0]];
    const se3di_frame *j = &m->frames[constraint->bodies[1]];
    axis[0] = f->axis == 'x';
    axis[1] = f->axis == 'y';
    axis[2] = f->axis == 'z';
    if (f->axis == 'a') {
        se3di_mul(i->A, s->axis_i, axis);
    } else if (f->axis == 'b') {
        se3di_mul(j->A, s->axis_j, axis);
    } else if (f->axis == 'r') {
        se3di_mul(i->A, s->ref_i, axis);
    } else if (f->axis == 't') {
        se3di_mul(i->A, s->third_i, axis);
    }
    const se3di_frame *at = f->point == 'j' ? j : i;
    se3di_mul(at->A, f->point == 'j' ? s->point_j : s->point_i, point);
    se3di_add(point, at->r, point);
}

/* Velocity of the centre of mass of `body` and angular velocity, ground frame, of a unit motion. */
static inline void freedom_twist(const world *w, const freedom *f, const double axis[3],
                                 const double point[3], se3d_body body, double twist[6])
{
    double arm[3];
    memset(twist, 0, 6 * sizeof *twist);
    if (f->kind != 't') {
        se3di_sub(world_frame(w, body)->r, point, arm);
        se3di_cross(axis, arm, twist);
        se3di_copy(axis, twist + 3);
    }
    double slide = f->kind == 't'   ? 1.0
                   : f->kind == 's' ? WORLD_PITCH / (2.0 * 3.14159265358979324)
                                    : 0.0;
    se3di_add_scaled(slide, axis, twist);
}

/* Move a body by a finite turn about the line (point, axis) and then a slide along it. */
static inline void world_move(world *w, se3d_body body, const double axis[3], const double point[3],
                              double turn, double slide)
{
    double q[4], A[9], arm[3], r[3], p[4];
    const se3di_frame *frame = world_frame(w, body);
    se3di_quat_from_axis_angle(axis, turn, q);
    se3di_quat_to_matrix(q, A);
    se3di_sub(frame->r, point, arm);
    se3di_mul(A, arm, r);
    se3di_add(r, point, r);
    se3di_add_scaled(slide, axis, r);
    se3di_quat_mul(q, frame->p, p);
    se3di_quat_normalize(p, p);
    CHECK(se3d_body_set_position(w->system, body, r) == SE3D_OK);
    CHECK(se3d_body_set_orientation(w->system, body, p) == SE3D_OK);
    se3di_angles_accept(&w->system->model);
}

/* Rank of a row-major matrix by Gauss elimination with full pivoting; destroys it. */
static inline int matrix_rank(double *a, int rows, int columns, double tolerance)
{
    int rank = 0;
    for (; rank < rows && rank < columns; ++rank) {
        int row = rank, column = rank;
        for (int r = rank; r < rows; ++r) {
            for (int c = rank; c < columns; ++c) {
                if (fabs(a[r * columns + c]) > fabs(a[row * columns + column])) {
                    row = r;
                    column = c;
                }
            }
        }
        double pivot = a[row * columns + column];
        if (fabs(pivot) < tolerance) {
            break;
        }
        for (int c = 0; c < columns; ++c) {
            double t = a[row * columns + c];
            a[row * columns + c] = a[rank * columns + c];
            a[rank * columns + c] = t;
        }
        for (int r = 0; r < rows; ++r) {
            double t = a[r * columns + column];
            a[r * columns + column] = a[r * columns + rank];
            a[r * columns + rank] = t;
        }
        for (int r = rank + 1; r < rows; ++r) {
            double factor = a[r * columns + rank] / pivot;
            for (int c = rank; c < columns; ++c) {
                a[r * columns + c] -= factor * a[rank * columns + c];
            }
        }
    }
    return rank;
}

#endif
