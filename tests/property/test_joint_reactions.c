/* SPDX-License-Identifier: BSD-3-Clause */
/* Reactions: balance between the bodies, no work on the freedoms of ideal joints, signs and points
 * against closed forms, frames of markers. The multipliers are set here, not solved for. */
#include "property/test_joint_world.h"

#define PI 3.1415926535897932384626433832795

static const se3di_constraint *data_of(const world *w, se3d_constraint c)
{
    const se3di_model *m = &w->system->model;
    return &m->constraints[se3di_slots_find(&m->constraint_slots, c.index1, c.generation)];
}

static void set_multipliers(world *w, se3d_constraint c, const double *lambda)
{
    const se3di_constraint *data = data_of(w, c);
    for (uint32_t k = 0; k < data->row_count; ++k) {
        w->system->model.lambda[data->row_begin + k] = lambda[k];
    }
}

static void joint_point(const world *w, se3d_constraint c, double point[3])
{
    const se3di_constraint *data = data_of(w, c);
    const se3di_frame *j = &w->system->model.frames[data->bodies[1]];
    se3di_mul(j->A, data->frames.point_j, point);
    se3di_add(point, j->r, point);
}

static void check_vector(const double actual[3], const double expected[3], double tolerance)
{
    for (int k = 0; k < 3; ++k) {
        CHECK_NEAR(actual[k], expected[k], tolerance);
    }
}

/* Force and torque about one point on both bodies cancel; the public wrench at the joint point is
 * the reaction. */
static void check_balance(const world *w, se3d_constraint joint)
{
    const se3d_marker ground_frame = {0, 0};
    const double anywhere[3] = {0.7, -0.4, 1.1};
    double on_i[6], on_j[6], force[3], torque[3], point[3];
    CHECK(se3d_constraint_get_reaction_at(w->system, joint, 0, anywhere, ground_frame, on_i) ==
          SE3D_OK);
    CHECK(se3d_constraint_get_reaction_at(w->system, joint, 1, anywhere, ground_frame, on_j) ==
          SE3D_OK);
    double size = 0.0;
    for (int k = 0; k < 6; ++k) {
        CHECK_NEAR(on_i[k] + on_j[k], 0.0, 1e-13);
        size = fmax(size, fabs(on_j[k]));
    }
    CHECK(size > 1e-3);
    joint_point(w, joint, point);
    CHECK(se3d_constraint_get_reaction_at(w->system, joint, 1, point, ground_frame, on_j) ==
          SE3D_OK);
    CHECK(se3d_constraint_get_reaction(w->system, joint, force, torque) == SE3D_OK);
    check_vector(force, on_j, 1e-14);
    check_vector(torque, on_j + 3, 1e-14);
}

static void reactions_balance_and_do_no_work_on_the_freedoms(void)
{
    for (size_t k = 0; k < JOINT_CASES; ++k) {
        for (uint64_t trial = 0; trial < 5; ++trial) {
            const joint_case *c = &joint_cases[k];
            world w;
            world_init(&w, 40 * (k + 1) + trial);
            se3d_joint_def def;
            se3d_constraint joint;
            double lambda[8], got[8], force[3], torque[3], point[3];
            world_joint_def(&w, c, trial == 1 ? w.ground : w.body[0], w.body[1], &def);
            CHECK(c->create(w.system, &def, &joint) == SE3D_OK);
            world_random(&w, lambda, 8, 10.0);
            set_multipliers(&w, joint, lambda);
            CHECK(se3d_constraint_get_multipliers(w.system, joint, got) == SE3D_OK);
            CHECK(memcmp(got, lambda, (size_t)c->rows * sizeof *got) == 0);
            check_balance(&w, joint);
            CHECK(se3d_constraint_get_reaction(w.system, joint, force, torque) == SE3D_OK);
            joint_point(&w, joint, point);
            for (int f = 0; f < 6 && c->freedoms[f].kind; ++f) {
                double axis[3], line[3], twist[6], arm[3], velocity[3];
                freedom_geometry(&w, c, &c->freedoms[f], joint, axis, line);
                freedom_twist(&w, &c->freedoms[f], axis, line, w.body[1], twist);
                se3di_sub(point, world_frame(&w, w.body[1])->r, arm);
                se3di_cross(twist + 3, arm, velocity);
                se3di_add(velocity, twist, velocity);
                CHECK_NEAR(se3di_dot(force, velocity) + se3di_dot(torque, twist + 3), 0.0, 1e-12);
            }
            world_destroy(&w);
        }
    }
}

/* cd rows carry -lambda as the force, dp1 rows -lambda (a_j x a_i) as the torque on body j. */
static void reaction_of_a_revolute_has_its_closed_form(void)
{
    world w;
    world_init(&w, 5);
    const double at[3] = {0.3, -0.5, 0.2}, axis[3] = {0.0, 0.6, 0.8}, ref[3] = {1.0, 0.0, 0.0};
    const double third[3] = {0.0, 0.8, -0.6}, lambda[5] = {1.0, -2.0, 3.0, 5.0, -7.0};
    double expected[3], force[3], torque[3];
    se3d_joint_def def = se3d_joint_def_default();
    se3d_constraint joint;
    def.body_i = w.body[0];
    def.body_j = w.body[1];
    CHECK(se3d_joint_def_set_frame(w.system, &def, at, axis, ref) == SE3D_OK);
    CHECK(se3d_joint_create_revolute(w.system, &def, &joint) == SE3D_OK);
    set_multipliers(&w, joint, lambda);
    CHECK(se3d_constraint_get_reaction(w.system, joint, force, torque) == SE3D_OK);
    const double minus[3] = {-1.0, 2.0, -3.0};
    check_vector(force, minus, 1e-15);
    /* dp1_a: axis x ref = third; dp1_b: axis x third = -ref */
    se3di_scale(-lambda[3], third, expected);
    se3di_add_scaled(lambda[4], ref, expected);
    check_vector(torque, expected, 1e-14);
    world_destroy(&w);
}

static void markers_turn_the_components_of_reactions(void)
{
    world w;
    world_init(&w, 8);
    se3d_joint_def def;
    se3d_constraint joint;
    se3d_marker_def marker_def = se3d_marker_def_default();
    se3d_marker marker;
    const se3d_marker ground_frame = {0, 0};
    const double point[3] = {1.0, 2.0, 3.0};
    double lambda[8], in_ground[6], in_marker[6], A[9], turned[3], expected[3];
    world_joint_def(&w, &joint_cases[0], w.body[0], w.body[1], &def);
    CHECK(se3d_joint_create_fixed(w.system, &def, &joint) == SE3D_OK);
    world_random(&w, lambda, 8, 1.0);
    set_multipliers(&w, joint, lambda);
    marker_def.body = w.body[2];
    world_random_unit(&w, marker_def.orientation, 4);
    CHECK(se3d_marker_create(w.system, &marker_def, &marker) == SE3D_OK);
    CHECK(se3d_constraint_get_reaction_at(w.system, joint, 0, point, ground_frame, in_ground) ==
          SE3D_OK);
    CHECK(se3d_constraint_get_reaction_at(w.system, joint, 0, point, marker, in_marker) == SE3D_OK);
    se3di_quat_to_matrix(marker_def.orientation, A);
    for (int half = 0; half < 2; ++half) {
        se3di_mul(A, in_marker + 3 * half, turned);
        se3di_mul(world_frame(&w, w.body[2])->A, turned, expected);
        check_vector(in_ground + 3 * half, expected, 1e-14);
    }
    world_destroy(&w);
}

/* The driven pendulum of the ME751 notes at t = 0: M qddot + Phi_q^T lambda = Q, six equations. */
static void driven_pendulum_has_the_published_torque(void)
{
    se3d_system *system;
    se3d_body ground, bar;
    se3d_constraint pin, driver;
    const double L = 2.0, m = 78.0, theta = PI / 4,
                 qddot[6] = {0,  -4.442882938158367, -4.442882938158366, 0, 0,
                             -PI}; /* wdot: body z is along x */
    const double J[3] = {0.0325, 104.01625, 104.01625}, zero[3] = {0, 0, 0}, x[3] = {1, 0, 0};
    const double A[9] = {0, 0, 1, sin(theta), cos(theta), 0, -cos(theta), sin(theta), 0};
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    CHECK(se3d_system_get_ground(system, &ground) == SE3D_OK);
    se3d_body_def body = se3d_body_def_default();
    body.mass = m;
    memcpy(body.inertia, J, sizeof J);
    body.position[1] = L * sin(theta);
    body.position[2] = -L * cos(theta);
    se3di_quat_from_matrix(A, body.orientation);
    CHECK(se3d_body_create(system, &body, &bar) == SE3D_OK);
    se3d_joint_def def = se3d_joint_def_default();
    def.body_i = ground;
    def.body_j = bar;
    def.angle0 = theta;
    CHECK(se3d_joint_def_set_frame(system, &def, zero, x, NULL) == SE3D_OK);
    CHECK(se3d_joint_create_revolute(system, &def, &pin) == SE3D_OK);
    se3d_driver_def drive = se3d_driver_def_default();
    drive.joint = pin;
    CHECK(se3d_function_create_expression(system, "pi/4*cos(2*t)", &drive.function) == SE3D_OK);
    CHECK(se3d_driver_create(system, &drive, &driver) == SE3D_OK);

    double phi[6], gamma[6], phi_r[18], phi_pi[18], a[6 * 7];
    se3d_constraint_eval(system, pin, SE3D_FORMULATION_ROMEGA, phi, NULL, gamma);
    se3d_constraint_eval(system, driver, SE3D_FORMULATION_ROMEGA, phi + 5, NULL, gamma + 5);
    se3d_constraint_eval_jacobian(system, pin, SE3D_FORMULATION_ROMEGA, 1, phi_r, phi_pi);
    se3d_constraint_eval_jacobian(system, driver, SE3D_FORMULATION_ROMEGA, 1, phi_r + 15,
                                  phi_pi + 15);
    for (int r = 0; r < 6; ++r) {
        CHECK_NEAR(phi[r], 0.0, 1e-15);
        CHECK_NEAR(se3di_dot(phi_r + 3 * r, qddot) + se3di_dot(phi_pi + 3 * r, qddot + 3), gamma[r],
                   1e-13);
        for (int k = 0; k < 3; ++k) {
            a[7 * k + r] = phi_r[3 * r + k];
            a[7 * (3 + k) + r] = phi_pi[3 * r + k];
        }
    }
    for (int k = 0; k < 3; ++k) {
        a[7 * k + 6] = m * ((k == 2 ? -9.81 : 0.0) - qddot[k]);
        a[7 * (3 + k) + 6] = -J[k] * qddot[3 + k];
    }
    for (int p = 0; p < 6; ++p) { /* Gauss-Jordan with row pivoting */
        int best = p;
        for (int r = p; r < 6; ++r) {
            best = fabs(a[7 * r + p]) > fabs(a[7 * best + p]) ? r : best;
        }
        for (int k = 0; k < 7; ++k) {
            double t = a[7 * p + k];
            a[7 * p + k] = a[7 * best + k];
            a[7 * best + k] = t;
        }
        for (int r = 0; r < 6; ++r) {
            double factor = r == p ? 0.0 : a[7 * r + p] / a[7 * p + p];
            for (int k = 0; k < 7; ++k) {
                a[7 * r + k] -= factor * a[7 * p + k];
            }
        }
    }
    for (int r = 0; r < 6; ++r) {
        system->model.lambda[r] = a[7 * r + 6] / a[7 * r + r];
    }
    double effort, force[3], torque[3];
    const double pivot[3] = {0.0, -346.54486917635262, 418.6351308236475};
    CHECK(se3d_driver_get_effort(system, driver, &effort) == SE3D_OK);
    CHECK_NEAR(effort, -224.82566111733013, 1e-10);
    CHECK(se3d_constraint_get_reaction(system, pin, force, torque) == SE3D_OK);
    check_vector(force, pivot, 1e-10);
    check_vector(torque, zero, 1e-10);
    const double drive_torque[3] = {-224.82566111733013, 0.0, 0.0};
    CHECK(se3d_constraint_get_reaction(system, driver, force, torque) == SE3D_OK);
    check_vector(force, zero, 1e-12);
    check_vector(torque, drive_torque, 1e-10);
    se3d_system_destroy(system);
}

/* Gears: body j of each joint gets its torque; the grounds of both joints the rest. */
static void reactions_of_a_gear_balance_over_all_its_bodies(void)
{
    world w;
    world_init(&w, 21);
    const double at[2][3] = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, z[3] = {0.0, 0.0, 1.0};
    const double lambda = 4.0;
    se3d_constraint pins[2], gear;
    for (int k = 0; k < 2; ++k) {
        se3d_joint_def def = se3d_joint_def_default();
        def.body_i = w.ground;
        def.body_j = w.body[k];
        CHECK(se3d_joint_def_set_frame(w.system, &def, at[k], z, NULL) == SE3D_OK);
        CHECK(se3d_joint_create_revolute(w.system, &def, &pins[k]) == SE3D_OK);
    }
    CHECK(se3d_joint_create_gear(w.system, "gear", pins[0], pins[1], 2.5, &gear) == SE3D_OK);
    set_multipliers(&w, gear, &lambda);
    const se3d_body bodies[3] = {w.ground, w.body[0], w.body[1]};
    const double torques[3] = {14.0, -10.0, -4.0};
    size_t count;
    CHECK(se3d_constraint_count_bodies(w.system, gear, &count) == SE3D_OK);
    CHECK(count == 3);
    for (size_t slot = 0; slot < 3; ++slot) {
        const se3d_marker ground_frame = {0, 0};
        se3d_body body;
        double wrench[6];
        CHECK(se3d_constraint_get_body(w.system, gear, slot, &body) == SE3D_OK);
        CHECK(memcmp(&body, &bodies[slot], sizeof body) == 0);
        CHECK(se3d_constraint_get_reaction_at(w.system, gear, slot, at[1], ground_frame, wrench) ==
              SE3D_OK);
        CHECK_NEAR(wrench[5], torques[slot], 1e-13);
        CHECK_NEAR(se3di_norm(wrench), 0.0, 1e-13);
    }
    world_destroy(&w);
}

int main(void)
{
    RUN(reactions_balance_and_do_no_work_on_the_freedoms);
    RUN(reaction_of_a_revolute_has_its_closed_form);
    RUN(markers_turn_the_components_of_reactions);
    RUN(driven_pendulum_has_the_published_torque);
    RUN(reactions_of_a_gear_balance_over_all_its_bodies);
    return check_finish();
}
