/* SPDX-License-Identifier: BSD-3-Clause */
/* Every joint: the number and rank of its equations, the freedoms it leaves (infinitesimal and
 * finite), its coordinates along them. */
#include "property/test_joint_world.h"

#define PI 3.1415926535897932384626433832795

/* Phi_q [rows * 12] in r-omega, body i then body j: d/dr, d/dtheta. */
static void jacobian(const world *w, se3d_constraint joint, double *J)
{
    size_t rows;
    CHECK(se3d_constraint_count_equations(w->system, joint, &rows) == SE3D_OK);
    for (size_t slot = 0; slot < 2; ++slot) {
        double phi_r[8 * 3], phi_pi[8 * 3];
        CHECK(se3d_constraint_eval_jacobian(w->system, joint, SE3D_FORMULATION_ROMEGA, slot, phi_r,
                                            phi_pi) == SE3D_OK);
        for (size_t r = 0; r < rows; ++r) {
            memcpy(J + 12 * r + 6 * slot, phi_r + 3 * r, 3 * sizeof *J);
            memcpy(J + 12 * r + 6 * slot + 3, phi_pi + 3 * r, 3 * sizeof *J);
        }
    }
}

/* Phi_q times a ground-frame twist of the body in `slot`, largest entry. */
static double violation_rate(const world *w, const double *J, int rows, int slot, se3d_body body,
                             const double twist[6])
{
    double local[3], worst = 0.0;
    se3di_mul_transposed(world_frame(w, body)->A, twist + 3, local);
    for (int r = 0; r < rows; ++r) {
        const double *row = J + 12 * r + 6 * slot;
        worst = fmax(worst, fabs(se3di_dot(row, twist) + se3di_dot(row + 3, local)));
    }
    return worst;
}

static double violation(const world *w, se3d_constraint joint)
{
    double phi[8], worst = 0.0;
    size_t rows;
    CHECK(se3d_constraint_count_equations(w->system, joint, &rows) == SE3D_OK);
    CHECK(se3d_constraint_eval(w->system, joint, SE3D_FORMULATION_ROMEGA, phi, NULL, NULL) ==
          SE3D_OK);
    for (size_t r = 0; r < rows; ++r) {
        worst = fmax(worst, fabs(phi[r]));
    }
    return worst;
}

static void check_equations(const world *w, const joint_case *c, se3d_constraint joint)
{
    const char *text, *name = c->row_names;
    size_t rows;
    CHECK(se3d_constraint_get_type(w->system, joint, &text) == SE3D_OK);
    CHECK(strcmp(text, c->name) == 0);
    CHECK(se3d_constraint_count_equations(w->system, joint, &rows) == SE3D_OK);
    CHECK((int)rows == c->rows);
    for (size_t r = 0; r < rows; ++r) {
        CHECK(se3d_constraint_get_equation_name(w->system, joint, r, &text) == SE3D_OK);
        size_t length = strcspn(name, " ");
        CHECK(strlen(text) == length && strncmp(text, name, length) == 0);
        name += length + (name[length] == ' ');
    }
    CHECK(*name == '\0');
}

static void check_freedoms(const world *w, const joint_case *c, se3d_constraint joint,
                           se3d_body body_i, se3d_body body_j)
{
    double J[8 * 12], twists[6 * 6];
    int count = 0;
    jacobian(w, joint, J);
    for (; count < 6 && c->freedoms[count].kind; ++count) {
        double axis[3], point[3];
        freedom_geometry(w, c, &c->freedoms[count], joint, axis, point);
        freedom_twist(w, &c->freedoms[count], axis, point, body_j, twists + 6 * count);
        CHECK_NEAR(violation_rate(w, J, c->rows, 1, body_j, twists + 6 * count), 0.0, 1e-13);
    }
    CHECK(c->rows + count == 6);
    CHECK(matrix_rank(twists, count, 6, 1e-6) == count);
    /* a motion of both bodies as one */
    double point[3] = {0.3, -0.2, 0.7}, axis[3] = {0.6, 0.0, 0.8}, twist_i[6], twist_j[6];
    const freedom turn = {'s', 0, 0};
    freedom_twist(w, &turn, axis, point, body_i, twist_i);
    freedom_twist(w, &turn, axis, point, body_j, twist_j);
    for (int r = 0; r < c->rows; ++r) {
        double local_i[3], local_j[3];
        const double *row = J + 12 * r;
        se3di_mul_transposed(world_frame(w, body_i)->A, twist_i + 3, local_i);
        se3di_mul_transposed(world_frame(w, body_j)->A, twist_j + 3, local_j);
        CHECK_NEAR(se3di_dot(row, twist_i) + se3di_dot(row + 3, local_i) +
                       se3di_dot(row + 6, twist_j) + se3di_dot(row + 9, local_j),
                   0.0, 1e-13);
    }
    double J_j[8 * 6];
    for (int r = 0; r < c->rows; ++r) {
        memcpy(J_j + 6 * r, J + 12 * r + 6, 6 * sizeof *J_j);
    }
    CHECK(matrix_rank(J_j, c->rows, 6, 1e-6) == c->rows);
}

/* Expected coordinates after the finite motions; which joints have which. */
static void check_coordinates(const world *w, const joint_case *c, se3d_constraint joint,
                              double angle, double displacement)
{
    double value;
    se3d_status status = se3d_joint_get_coordinate(w->system, joint, SE3D_JOINT_COORDINATE_ANGLE,
                                                   &value, NULL, NULL);
    CHECK(status == (c->angle ? SE3D_OK : SE3D_ERR_INVALID_ARGUMENT));
    CHECK_NEAR(value, c->angle ? angle : 0.0, 2e-13);
    status = se3d_joint_get_coordinate(w->system, joint, SE3D_JOINT_COORDINATE_DISPLACEMENT, &value,
                                       NULL, NULL);
    CHECK(status == (c->displacement ? SE3D_OK : SE3D_ERR_INVALID_ARGUMENT));
    CHECK_NEAR(value, c->displacement ? displacement : 0.0, 2e-13);
}

static double displacement_of(const world *w, const joint_case *c, se3d_constraint joint)
{
    double value = 0.0;
    if (c->displacement) {
        CHECK(se3d_joint_get_coordinate(w->system, joint, SE3D_JOINT_COORDINATE_DISPLACEMENT,
                                        &value, NULL, NULL) == SE3D_OK);
    }
    return value;
}

/* Go along every freedom by a finite amount; the equations stay met and the coordinates count. */
static void check_finite_motion(world *w, const joint_case *c, se3d_constraint joint,
                                se3d_body body_j)
{
    double angle = 0.4, displacement = displacement_of(w, c, joint);
    CHECK_NEAR(violation(w, joint), 0.0, 2e-14);
    check_coordinates(w, c, joint, angle, displacement);
    for (int k = 0; k < 6 && c->freedoms[k].kind; ++k) {
        const freedom *f = &c->freedoms[k];
        double axis[3], point[3], amount = 1.0 + 0.9 * check_random(&w->seed);
        double slide = f->kind == 't'   ? amount
                       : f->kind == 's' ? amount * WORLD_PITCH / (2 * PI)
                                        : 0;
        double turn = f->kind == 't' ? 0.0 : amount;
        freedom_geometry(w, c, f, joint, axis, point);
        world_move(w, body_j, axis, point, turn, slide);
        CHECK_NEAR(violation(w, joint), 0.0, 1e-13);
        angle += turn;
        displacement += slide;
    }
    check_coordinates(w, c, joint, angle, displacement);
}

/* Leave the manifold by each motion that is not a freedom: some equation must notice. */
static void every_other_motion_is_blocked(void)
{
    for (size_t k = 0; k < JOINT_CASES; ++k) {
        const joint_case *c = &joint_cases[k];
        world w;
        world_init(&w, 900 + k);
        se3d_joint_def def;
        se3d_constraint joint;
        world_joint_def(&w, c, w.body[0], w.body[1], &def);
        CHECK(c->create(w.system, &def, &joint) == SE3D_OK);
        double J[8 * 12];
        jacobian(&w, joint, J);
        double point[3] = {0.1, 0.2, 0.3}, axis[3], twist[6];
        const freedom screw = {'s', 0, 0};
        world_random_unit(&w, axis, 3);
        freedom_twist(&w, &screw, axis, point, w.body[1], twist); /* a general motion */
        CHECK(violation_rate(&w, J, c->rows, 1, w.body[1], twist) > 1e-3);
        world_destroy(&w);
    }
}

static void every_joint_leaves_its_freedoms_and_no_others(void)
{
    for (size_t k = 0; k < JOINT_CASES; ++k) {
        for (uint64_t trial = 0; trial < 8; ++trial) {
            const joint_case *c = &joint_cases[k];
            world w;
            world_init(&w, 1000 * (k + 1) + trial);
            /* body i, body j or neither is the ground */
            se3d_body body_i = trial == 1 ? w.ground : w.body[0];
            se3d_body body_j = trial == 2 ? w.ground : w.body[1];
            se3d_joint_def def;
            se3d_constraint joint;
            world_joint_def(&w, c, body_i, body_j, &def);
            CHECK(c->create(w.system, &def, &joint) == SE3D_OK);
            check_equations(&w, c, joint);
            check_freedoms(&w, c, joint, body_i, body_j);
            if (trial != 2) {
                check_finite_motion(&w, c, joint, body_j);
                check_freedoms(&w, c, joint, body_i, body_j);
            }
            world_destroy(&w);
        }
    }
}

/* Joints of constant distance keep the one they are given. */
static void distances_are_the_given_ones(void)
{
    const joint_create creators[2] = {se3d_joint_create_distance,
                                      se3d_joint_create_revolute_spherical};
    for (int k = 0; k < 2; ++k) {
        world w;
        world_init(&w, 77);
        se3d_joint_def def = se3d_joint_def_default();
        se3d_constraint joint;
        double zero[3] = {0.0, 0.0, 0.0}, r[3] = {3.0, 4.0, 0.0}, phi[2];
        def.body_i = w.ground;
        def.body_j = w.body[0];
        def.distance = 4.0;
        CHECK(se3d_body_set_position(w.system, w.body[0], r) == SE3D_OK);
        CHECK(creators[k](w.system, &def, &joint) == SE3D_OK);
        CHECK(se3d_constraint_eval(w.system, joint, SE3D_FORMULATION_RP, phi, NULL, NULL) ==
              SE3D_OK);
        CHECK_NEAR(phi[0], 25.0 - 16.0, 1e-14);
        def.distance = 0.0;
        CHECK(creators[k](w.system, &def, &joint) == SE3D_OK);
        CHECK(se3d_constraint_eval(w.system, joint, SE3D_FORMULATION_RP, phi, NULL, NULL) ==
              SE3D_OK);
        CHECK_NEAR(phi[0], 0.0, 1e-14);
        CHECK(se3d_body_set_position(w.system, w.body[0], zero) == SE3D_OK);
        CHECK(creators[k](w.system, &def, &joint) == SE3D_ERR_INVALID_ARGUMENT);
        CHECK_CONTAINS(se3d_system_get_error(w.system), "coincide");
        world_destroy(&w);
    }
}

int main(void)
{
    RUN(every_joint_leaves_its_freedoms_and_no_others);
    RUN(every_other_motion_is_blocked);
    RUN(distances_are_the_given_ones);
    return check_finish();
}
