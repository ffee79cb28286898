/* SPDX-License-Identifier: BSD-3-Clause */
/* Joint coordinates by the public functions, on random trees and loops of all joint types: the mass
 * matrix and the bias are projections of the bodies' own, Jacobians and their rates are differences
 * of order two, efforts undo accelerations, and what a call leaves behind is nothing. */
#include "support/counting.h"
#include "support/tree_world.h"

#include "nonlinear/equations.h"
#include "se3d/coordinates.h"

enum { MECHANISMS = 40, SIZE = 7 * TREE_BODIES_MAX };

typedef struct setting {
    tree_world world;
    se3d_system *system;
    se3d_coordinates *c;
    size_t n, positions;
    double q[SIZE], qdot[SIZE];
    se3d_marker marker;
} setting;

/* A marker on the last body, and coordinates at random. */
static void begin(setting *s, uint64_t seed, int loops)
{
    se3d_marker_def def = se3d_marker_def_default();
    double dq[SIZE];
    tree_world_init(&s->world, seed, 1 + (int)(seed % TREE_BODIES_MAX), loops);
    s->system = s->world.system;
    def.body = s->world.bodies[s->world.count - 1];
    tree_vector(&s->world, def.position, 3, 1.0);
    CHECK(!se3d_marker_create(s->system, &def, &s->marker));
    CHECK(!se3d_coordinates_create(s->system, &s->c));
    s->n = se3d_coordinates_count(s->c);
    s->positions = se3d_coordinates_count_positions(s->c);
    CHECK(s->n <= s->positions && s->positions <= SIZE);
    CHECK(!se3d_coordinates_get(s->c, s->q, NULL));
    tree_vector(&s->world, dq, (int)s->n, 2.0);
    tree_vector(&s->world, s->qdot, (int)s->n, 1.0);
    CHECK(!se3d_coordinates_move(s->c, s->q, dq, s->q));
    CHECK(!se3d_coordinates_set(s->c, s->q, s->qdot));
}

static void end(setting *s)
{
    se3d_coordinates_destroy(s->c);
    tree_world_destroy(&s->world);
}

static double difference(const double *a, const double *b, size_t count)
{
    double most = 0.0;
    for (size_t k = 0; k < count; ++k) {
        most = fmax(most, fabs(a[k] - b[k]));
    }
    return most;
}

static double dot(const double *a, const double *b, size_t count)
{
    double sum = 0.0;
    for (size_t k = 0; k < count; ++k) {
        sum += a[k] * b[k];
    }
    return sum;
}

/* Velocities of all bodies that one of the coordinates gives: columns of their Jacobian. */
static void body_velocities(const setting *s, double (*v)[6])
{
    for (int k = 0; k < s->world.count; ++k) {
        CHECK(!se3d_body_get_velocity(s->system, s->world.bodies[k], v[k]));
        CHECK(!se3d_body_get_angular_velocity(s->system, s->world.bodies[k], v[k] + 3));
    }
}

/* m v or J w of a body, in the same frames. */
static void momentum_of(const setting *s, int body, const double v[6], double p[6])
{
    double mass, J[6];
    CHECK(!se3d_body_get_mass(s->system, s->world.bodies[body], &mass, J));
    const double *w = v + 3;
    se3di_scale(mass, v, p);
    p[3] = J[0] * w[0] + J[3] * w[1] + J[5] * w[2];
    p[4] = J[3] * w[0] + J[1] * w[1] + J[4] * w[2];
    p[5] = J[5] * w[0] + J[4] * w[1] + J[2] * w[2];
}

static void the_mass_matrix_is_the_projection_of_the_masses(void)
{
    static double M[SIZE * SIZE];
    static double column[SIZE][TREE_BODIES_MAX + 1][6];
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        setting s;
        double unit[SIZE] = {0.0}, x[SIZE], out[SIZE], back[SIZE];
        begin(&s, seed, 0);
        for (size_t k = 0; k < s.n; ++k) {
            unit[k] = 1.0;
            CHECK(!se3d_coordinates_set(s.c, NULL, unit));
            body_velocities(&s, column[k]);
            unit[k] = 0.0;
        }
        CHECK(!se3d_coordinates_compute_mass_matrix(s.c, M));
        for (size_t a = 0; a < s.n; ++a) {
            for (size_t b = 0; b < s.n; ++b) {
                double sum = 0.0, p[6];
                for (int k = 1; k < s.world.count; ++k) {
                    momentum_of(&s, k, column[b][k], p);
                    sum += dot(column[a][k], p, 6);
                }
                CHECK_NEAR(M[a * s.n + b], sum, 1e-9 * (1.0 + fabs(sum)));
            }
        }
        tree_vector(&s.world, x, (int)s.n, 1.0);
        CHECK(!se3d_coordinates_multiply_mass(s.c, x, out));
        for (size_t a = 0; a < s.n; ++a) {
            CHECK_NEAR(out[a], dot(M + a * s.n, x, s.n), 1e-9 * (1.0 + fabs(out[a])));
        }
        CHECK(!se3d_coordinates_solve_mass(s.c, out, back));
        CHECK_NEAR(difference(back, x, s.n), 0.0, 1e-8);
        end(&s);
    }
}

static void efforts_and_accelerations_undo_each_other(void)
{
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        setting s;
        double effort[SIZE], qddot[SIZE], back[SIZE], bias[SIZE], x[SIZE];
        begin(&s, seed, 0);
        tree_vector(&s.world, effort, (int)s.n, 10.0);
        CHECK(!se3d_coordinates_compute_accelerations(s.c, effort, qddot));
        CHECK(!se3d_coordinates_compute_efforts(s.c, qddot, back));
        CHECK_NEAR(difference(effort, back, s.n), 0.0, 1e-9 * (1.0 + fabs(back[0])));
        CHECK(!se3d_coordinates_compute_efforts(s.c, NULL, bias));
        CHECK(!se3d_coordinates_multiply_mass(s.c, qddot, x));
        for (size_t k = 0; k < s.n; ++k) {
            CHECK_NEAR(x[k] + bias[k], effort[k], 1e-8);
        }
        end(&s);
    }
}

/* A column of marker motion by differences of two positions or of two Jacobians. */
static void jacobians_are_differences_of_order_two(void)
{
    static double J[6 * SIZE], high[6 * SIZE], low[6 * SIZE], rate[6 * SIZE];
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        setting s;
        double errors[2][2] = {{0.0, 0.0}, {0.0, 0.0}}, scale = 1.0;
        begin(&s, seed, 0);
        CHECK(!se3d_coordinates_compute_jacobian(s.c, s.marker, J, rate));
        for (int level = 0; level < 2; ++level) {
            const double h = level ? 5e-4 : 1e-3;
            double dq[SIZE], q[SIZE], r[2][3], motion[6];
            for (int side = 0; side < 2; ++side) {
                for (size_t k = 0; k < s.n; ++k) {
                    dq[k] = (side ? h : -h) * s.qdot[k];
                }
                CHECK(!se3d_coordinates_move(s.c, s.q, dq, q));
                CHECK(!se3d_coordinates_set(s.c, q, NULL));
                CHECK(!se3d_marker_get_position(s.system, s.marker, r[side]));
                CHECK(!se3d_coordinates_compute_jacobian(s.c, s.marker, side ? high : low, NULL));
            }
            for (int k = 0; k < 3; ++k) {
                motion[k] = dot(J + (size_t)(3 + k) * s.n, s.qdot, s.n);
                errors[0][level] =
                    fmax(errors[0][level], fabs(motion[k] - (r[1][k] - r[0][k]) / (2.0 * h)));
            }
            for (size_t k = 0; k < 6 * s.n; ++k) {
                const double slope = (high[k] - low[k]) / (2.0 * h);
                errors[1][level] = fmax(errors[1][level], fabs(rate[k] - slope));
                scale = fmax(scale, fabs(rate[k]));
            }
        }
        for (int k = 0; k < 2; ++k) {
            CHECK(errors[k][0] < 1e-3 * scale * scale * scale);
            CHECK(errors[k][0] < 1e-8 ||
                  (errors[k][0] / errors[k][1] > 3.6 && errors[k][0] / errors[k][1] < 4.4));
        }
        end(&s);
    }
}

static void jacobians_give_the_motion_and_the_work_of_markers(void)
{
    static double J[6 * SIZE];
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        setting s;
        double v[3], wrench[6], effort[SIZE];
        begin(&s, seed, 0);
        CHECK(!se3d_coordinates_compute_jacobian(s.c, s.marker, J, NULL));
        CHECK(!se3d_marker_get_velocity(s.system, s.marker, v));
        for (int k = 0; k < 3; ++k) {
            CHECK_NEAR(dot(J + (size_t)(3 + k) * s.n, s.qdot, s.n), v[k], 1e-11);
        }
        tree_vector(&s.world, wrench, 6, 1.0);
        CHECK(!se3d_coordinates_compute_transposed(s.c, s.marker, wrench, effort));
        for (size_t a = 0; a < s.n; ++a) {
            double sum = 0.0;
            for (size_t k = 0; k < 6; ++k) {
                sum += J[k * s.n + a] * wrench[k];
            }
            CHECK_NEAR(effort[a], sum, 1e-11);
        }
        end(&s);
    }
}

static void momentum_is_its_matrix_times_the_velocities(void)
{
    static double H[6 * SIZE];
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        setting s;
        double momentum[6];
        begin(&s, seed, 0);
        CHECK(!se3d_coordinates_compute_momentum(s.c, momentum, H));
        for (size_t k = 0; k < 6; ++k) {
            CHECK_NEAR(dot(H + k * s.n, s.qdot, s.n), momentum[k],
                       1e-10 * (1.0 + fabs(momentum[k])));
        }
        end(&s);
    }
}

/* Without springs: what holds the weights at rest is the bias. */
static void gravity_is_the_bias_at_rest(void)
{
    setting s;
    double zero[SIZE] = {0.0}, bias[SIZE], weights[SIZE];
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        begin(&s, seed, 0);
        CHECK(!se3d_coordinates_set(s.c, NULL, zero));
        CHECK(!se3d_coordinates_compute_gravity(s.c, weights));
        if (s.system->model.force_slots.count == 0) {
            CHECK(!se3d_coordinates_compute_efforts(s.c, NULL, bias));
            CHECK_NEAR(difference(bias, weights, s.n), 0.0, 1e-10);
        }
        const double none[3] = {0.0, 0.0, 0.0};
        CHECK(!se3d_system_set_gravity(s.system, none));
        CHECK(!se3d_coordinates_compute_gravity(s.c, bias));
        CHECK(difference(bias, zero, s.n) == 0.0);
        end(&s);
    }
}

/* G N^T = 0, and accelerations of the loops stay in what the rows leave. */
static void the_null_space_is_what_loops_leave(void)
{
    static double G[6 * SIZE * SIZE], N[SIZE * SIZE];
    int tried = 0;
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        setting s;
        size_t freedoms;
        begin(&s, seed, 1 + (int)(seed % 3));
        const size_t rows = se3d_coordinates_count_loop_rows(s.c);
        CHECK(!se3d_coordinates_compute_loop_jacobian(s.c, G));
        CHECK(!se3d_coordinates_compute_null_space(s.c, N, &freedoms));
        CHECK(freedoms + rows >= s.n);
        for (size_t f = 0; f < freedoms; ++f) {
            CHECK_NEAR(dot(N + f * s.n, N + f * s.n, s.n), 1.0, 1e-10);
            for (size_t r = 0; r < rows; ++r) {
                CHECK_NEAR(dot(G + r * s.n, N + f * s.n, s.n), 0.0, 1e-9);
            }
        }
        tried += rows > 0 && freedoms < s.n;
        end(&s);
    }
    CHECK(tried > MECHANISMS / 4);
}

/* The acceleration of the marker by coordinates, J qddot + rate qdot, is that of the KKT system. */
static void accelerations_of_closed_loops_are_those_of_the_bodies(void)
{
    static double J[6 * SIZE], rate[6 * SIZE];
    int tried = 0;
    for (uint64_t seed = 0; seed < 2 * MECHANISMS; ++seed) {
        setting s;
        se3di_equations e;
        double qddot[SIZE], a[3];
        begin(&s, seed, 1 + (int)(seed % 2));
        CHECK(!se3di_equations_init(&e, &s.system->model, &se3di_formulation_romega, 1, NULL));
        if (se3di_acceleration_solve(&e, 0.0) == SE3D_OK && !e.redundant) {
            CHECK(!se3d_coordinates_compute_accelerations(s.c, NULL, qddot));
            CHECK(!se3d_coordinates_compute_jacobian(s.c, s.marker, J, rate));
            CHECK(!se3d_marker_get_acceleration(s.system, s.marker, a));
            for (size_t k = 0; k < 3; ++k) {
                const double *row = J + (3 + k) * s.n, *change = rate + (3 + k) * s.n;
                CHECK_NEAR(dot(row, qddot, s.n) + dot(change, s.qdot, s.n), a[k],
                           1e-9 * (1.0 + fabs(a[k])));
            }
            tried += se3d_coordinates_count_loop_rows(s.c) > 0;
        }
        se3di_equations_destroy(&e);
        end(&s);
    }
    CHECK(tried > MECHANISMS / 2);
}

/* Each revolute and each ball of a world once more, where it is. @return how many */
static int double_joints(se3d_system *system)
{
    const se3di_model *model = &system->model;
    const size_t count = model->constraint_slots.count;
    int added = 0;
    for (size_t k = 0; k < count; ++k) {
        const se3di_constraint *c = &model->constraints[k];
        const int turns = strcmp(c->type, "revolute") == 0;
        se3d_joint_def def = se3d_joint_def_default();
        se3d_constraint joint;
        if (!turns && strcmp(c->type, "spherical") != 0) {
            continue;
        }
        CHECK(!se3d_system_get_body(system, c->bodies[0], &def.body_i));
        CHECK(!se3d_system_get_body(system, c->bodies[1], &def.body_j));
        se3di_copy(c->frames.point_i, def.point_i);
        se3di_copy(c->frames.point_j, def.point_j);
        se3di_copy(c->frames.axis_i, def.axis_i);
        se3di_copy(c->frames.axis_j, def.axis_j);
        CHECK(!(turns ? se3d_joint_create_revolute : se3d_joint_create_spherical)(system, &def,
                                                                                  &joint));
        ++added;
    }
    return added;
}

/* What is left of its rows on the tree is rounding, and no equation. */
static void a_joint_that_is_there_twice_changes_nothing(void)
{
    static double N[SIZE * SIZE];
    int tried = 0;
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        setting s;
        double once[SIZE], twice[SIZE], scale = 1.0;
        size_t freedoms;
        begin(&s, seed, 0);
        CHECK(!se3d_coordinates_compute_accelerations(s.c, NULL, once));
        tried += double_joints(s.system) > 0;
        se3d_coordinates_destroy(s.c);
        CHECK(!se3d_coordinates_create(s.system, &s.c));
        CHECK(se3d_coordinates_count(s.c) == s.n);
        CHECK(!se3d_coordinates_compute_null_space(s.c, N, &freedoms));
        CHECK(freedoms == s.n);
        CHECK(se3d_coordinates_compute_accelerations(s.c, NULL, twice) >= 0);
        for (size_t k = 0; k < s.n; ++k) {
            scale = fmax(scale, fabs(once[k]));
        }
        CHECK_NEAR(difference(once, twice, s.n), 0.0, 1e-9 * scale);
        end(&s);
    }
    CHECK(tried > MECHANISMS / 2);
}

/* A quaternion that overflows, and velocities of bodies that do. */
static void what_cannot_be_set_leaves_the_state_alone(void)
{
    int lengths = 0, rates = 0;
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        setting s;
        double q[SIZE], qdot[SIZE];
        begin(&s, seed, 0);
        const uint64_t before = se3d_system_hash(s.system);
        for (size_t k = 0; k < s.positions; ++k) {
            q[k] = 1e200;
        }
        for (size_t k = 0; k < s.n; ++k) {
            qdot[k] = 1.7e308;
        }
        const se3d_status length = se3d_coordinates_set(s.c, q, NULL);
        const uint64_t after = se3d_system_hash(s.system);
        const se3d_status rate = se3d_coordinates_set(s.c, NULL, qdot);
        CHECK(length == SE3D_OK || (length == SE3D_ERR_INVALID_ARGUMENT && after == before));
        CHECK(rate == SE3D_OK || rate == SE3D_ERR_NOT_FINITE);
        CHECK(rate == SE3D_OK || se3d_system_hash(s.system) == after);
        for (int k = 0; k < s.world.count; ++k) {
            double p[4], v[6];
            CHECK(!se3d_body_get_orientation(s.system, s.world.bodies[k], p));
            CHECK_NEAR(dot(p, p, 4), 1.0, 1e-9);
            CHECK(!se3d_body_get_velocity(s.system, s.world.bodies[k], v));
            CHECK(isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]));
        }
        lengths += length < 0;
        rates += rate < 0;
        end(&s);
    }
    CHECK(lengths > 0 && rates > 0);
}

/* Bodies that are off their joints by a setter are not moved onto the tree by new velocities. */
static void velocities_alone_move_no_body(void)
{
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        setting s;
        double q[SIZE], qdot[SIZE], r[3], p[4], r_after[3], p_after[4];
        begin(&s, seed, 0);
        const se3d_body body = s.world.bodies[s.world.count - 1];
        CHECK(!se3d_body_get_position(s.system, body, r));
        CHECK(!se3d_body_get_orientation(s.system, body, p));
        r[0] += 0.01;
        CHECK(!se3d_body_set_position(s.system, body, r));
        CHECK(!se3d_coordinates_get(s.c, q, qdot));
        for (size_t k = 0; k < s.n; ++k) {
            qdot[k] = 0.1 * (double)(k + 1);
        }
        CHECK(!se3d_coordinates_set(s.c, NULL, qdot));
        CHECK(!se3d_body_get_position(s.system, body, r_after));
        CHECK(!se3d_body_get_orientation(s.system, body, p_after));
        CHECK(memcmp(r, r_after, sizeof r) == 0 && memcmp(p, p_after, sizeof p) == 0);
        end(&s);
    }
}

static void every_velocity_has_its_joint_and_body(void)
{
    for (uint64_t seed = 0; seed < MECHANISMS; ++seed) {
        setting s;
        begin(&s, seed, 0);
        for (size_t k = 0; k < s.n; ++k) {
            se3d_constraint joint;
            se3d_body body, parent;
            size_t component, position;
            CHECK(
                !se3d_coordinates_get_entry(s.c, k, &joint, &body, &parent, &component, &position));
            CHECK(component <= k && position < s.positions && body.index1 != parent.index1);
            CHECK(joint.index1 > 0 || component < 6);
        }
        end(&s);
    }
}

/* Setters of masses hold from the next call on, and no call changes the state. */
static void calls_see_setters_and_leave_the_state_alone(void)
{
    setting s;
    uint64_t before, after;
    static double M[SIZE * SIZE], twice[SIZE * SIZE], J[6 * SIZE];
    double x[SIZE], momentum[6];
    size_t freedoms;
    begin(&s, 7, 1);
    before = se3d_system_hash(s.system);
    CHECK(!se3d_coordinates_compute_accelerations(s.c, NULL, x));
    CHECK(!se3d_coordinates_compute_efforts(s.c, NULL, x));
    CHECK(!se3d_coordinates_compute_gravity(s.c, x));
    CHECK(!se3d_coordinates_compute_mass_matrix(s.c, M));
    CHECK(!se3d_coordinates_compute_jacobian(s.c, s.marker, J, J));
    CHECK(!se3d_coordinates_compute_momentum(s.c, momentum, NULL));
    CHECK(!se3d_coordinates_compute_null_space(s.c, twice, &freedoms));
    after = se3d_system_hash(s.system);
    CHECK(before == after);
    for (int k = 1; k < s.world.count; ++k) {
        double mass, inertia[6];
        CHECK(!se3d_body_get_mass(s.system, s.world.bodies[k], &mass, inertia));
        for (int i = 0; i < 6; ++i) {
            inertia[i] *= 2.0;
        }
        CHECK(!se3d_body_set_mass(s.system, s.world.bodies[k], 2.0 * mass, inertia));
    }
    CHECK(!se3d_coordinates_compute_mass_matrix(s.c, twice));
    for (size_t k = 0; k < s.n * s.n; ++k) {
        CHECK_NEAR(twice[k], 2.0 * M[k], 1e-9 * (1.0 + fabs(M[k])));
    }
    end(&s);
}

/* What others move is read again, to the bit as by coordinates that have seen nothing. */
static void calls_see_what_others_have_moved(void)
{
    setting s;
    se3d_coordinates *other, *fresh;
    double x[SIZE], y[SIZE], before[SIZE];
    begin(&s, 5, 0);
    CHECK(!se3d_coordinates_create(s.system, &other));
    CHECK(!se3d_coordinates_compute_accelerations(s.c, NULL, before));
    for (int way = 0; way < 2; ++way) {
        for (size_t k = 0; k < s.n; ++k) {
            s.qdot[k] += 0.5;
        }
        if (way == 0) {
            CHECK(!se3d_coordinates_set(other, NULL, s.qdot));
        } else {
            const double v[3] = {0.3, -0.2, 0.1};
            CHECK(!se3d_body_set_angular_velocity(s.system, s.world.bodies[s.world.count - 1], v));
        }
        CHECK(!se3d_coordinates_create(s.system, &fresh));
        CHECK(!se3d_coordinates_compute_accelerations(s.c, NULL, x));
        CHECK(!se3d_coordinates_compute_accelerations(fresh, NULL, y));
        CHECK(difference(x, y, s.n) == 0.0);
        CHECK(difference(x, before, s.n) > 1e-6);
        memcpy(before, x, sizeof before);
        se3d_coordinates_destroy(fresh);
    }
    se3d_coordinates_destroy(other);
    end(&s);
}

static void what_is_made_once_allocates_no_more_and_is_given_back(void)
{
    support_counting counting = {0};
    const se3d_allocator allocator = support_counting_allocator(&counting);
    se3d_system_def def = se3d_system_def_default();
    se3d_system *system = NULL;
    se3d_coordinates *c = NULL;
    se3d_body body;
    se3d_body_def ball = se3d_body_def_default();
    double x[6], q[7];
    ball.mass = ball.inertia[0] = ball.inertia[1] = ball.inertia[2] = 1.0;
    def.allocator = &allocator;
    CHECK(!se3d_system_create(&def, &system) && !se3d_body_create(system, &ball, &body));
    CHECK(!se3d_coordinates_create(system, &c));
    const size_t calls = counting.calls;
    CHECK(!se3d_coordinates_get(c, q, x) && !se3d_coordinates_set(c, q, x));
    CHECK(!se3d_coordinates_compute_accelerations(c, NULL, x));
    CHECK_NEAR(x[2], -9.81, 1e-12);
    CHECK(!se3d_coordinates_compute_efforts(c, NULL, x));
    CHECK_NEAR(x[2], 9.81, 1e-12);
    CHECK(counting.calls == calls);
    se3d_system_destroy(system);
    size_t freedoms = 7;
    CHECK(se3d_coordinates_get(c, q, x) == SE3D_ERR_STATE);
    CHECK(se3d_coordinates_compute_null_space(c, x, &freedoms) == SE3D_ERR_STATE && freedoms == 0);
    CHECK(se3d_coordinates_count_loop_rows(c) == 0);
    se3d_coordinates_destroy(c);
    CHECK(counting.live == 0 && counting.bytes == 0 && counting.wrong == 0);
}

int main(void)
{
    RUN(the_mass_matrix_is_the_projection_of_the_masses);
    RUN(efforts_and_accelerations_undo_each_other);
    RUN(jacobians_are_differences_of_order_two);
    RUN(jacobians_give_the_motion_and_the_work_of_markers);
    RUN(momentum_is_its_matrix_times_the_velocities);
    RUN(gravity_is_the_bias_at_rest);
    RUN(the_null_space_is_what_loops_leave);
    RUN(accelerations_of_closed_loops_are_those_of_the_bodies);
    RUN(a_joint_that_is_there_twice_changes_nothing);
    RUN(what_cannot_be_set_leaves_the_state_alone);
    RUN(velocities_alone_move_no_body);
    RUN(every_velocity_has_its_joint_and_body);
    RUN(calls_see_setters_and_leave_the_state_alone);
    RUN(calls_see_what_others_have_moved);
    RUN(what_is_made_once_allocates_no_more_and_is_given_back);
    return check_finish();
}
