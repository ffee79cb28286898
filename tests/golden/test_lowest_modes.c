/* SPDX-License-Identifier: BSD-3-Clause */
/* The lowest modes of large models against those of the dense solver: chains, free bodies, many
 * modes of one frequency, unstable ones, loops with redundant rows; and what is no case for it. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/counting.h"

#include <stdbool.h>

enum { BODIES = 64, LOWEST = 5 };

typedef struct world {
    se3d_system *system;
    se3d_body body[BODIES];
} world;

static world begin_with(const se3d_allocator *allocator)
{
    const double none[3] = {0.0, 0.0, 0.0};
    world w = {.system = NULL};
    se3d_system_def system = se3d_system_def_default();
    system.allocator = allocator;
    CHECK(se3d_system_create(&system, &w.system) == SE3D_OK);
    CHECK(se3d_system_set_gravity(w.system, none) == SE3D_OK);
    for (int k = 0; k < BODIES; ++k) {
        se3d_body_def def = se3d_body_def_default();
        def.mass = 1.0 + 0.01 * k;
        def.inertia[0] = 0.02;
        def.inertia[1] = def.inertia[2] = 0.1;
        def.position[0] = k + 0.5;
        CHECK(se3d_body_create(w.system, &def, &w.body[k]) == SE3D_OK);
    }
    return w;
}

static world begin(void)
{
    return begin_with(NULL);
}

static se3d_body ground_of(const world *w)
{
    se3d_body ground;
    CHECK(se3d_system_get_ground(w->system, &ground) == SE3D_OK);
    return ground;
}

static se3d_body before(const world *w, int k)
{
    return k > 0 ? w->body[k - 1] : ground_of(w);
}

/* A hinge at a place of the ground; bodies are in their first poses. */
static se3d_constraint add_hinge(world *w, se3d_body body_i, int k, const double at[3],
                                 const double axis[3])
{
    se3d_joint_def def = se3d_joint_def_default();
    se3d_constraint joint;
    double r_i[3], r_j[3];
    def.body_i = body_i;
    def.body_j = w->body[k];
    CHECK(se3d_body_get_position(w->system, def.body_i, r_i) == SE3D_OK);
    CHECK(se3d_body_get_position(w->system, def.body_j, r_j) == SE3D_OK);
    for (int c = 0; c < 3; ++c) {
        def.point_i[c] = at[c] - r_i[c];
        def.point_j[c] = at[c] - r_j[c];
        def.axis_i[c] = def.axis_j[c] = axis[c];
    }
    CHECK(se3d_joint_create_revolute(w->system, &def, &joint) == SE3D_OK);
    return joint;
}

/* A hinge between each body and the one before, its axis a little different each time. */
static void add_hinges(world *w, double tilt)
{
    for (int k = 0; k < BODIES; ++k) {
        const double at[3] = {k, 0.0, 0.0}, axis[3] = {0.0, k % 2 ? tilt : 0.0, 1.0};
        add_hinge(w, before(w, k), k, at, axis);
    }
}

/* Springs from the ground to each body, at rest, above and beside it. */
static void add_springs(world *w, double k0, double c)
{
    for (int k = 0; k < 2 * BODIES; ++k) {
        se3d_tsda_def def = se3d_tsda_def_default();
        se3d_force spring;
        def.body_i = ground_of(w);
        def.body_j = w->body[k / 2];
        def.point_i[0] = k / 2 + 0.5;
        def.point_i[1 + k % 2] = 1.0;
        def.k = k0 + k;
        def.c = c;
        def.l0 = 1.0;
        CHECK(se3d_force_create_tsda(w->system, &def, &spring) == SE3D_OK);
    }
}

static se3d_modes *linearise(se3d_system *system, size_t lowest)
{
    se3d_modes_def def = se3d_modes_def_default();
    se3d_modes *modes = NULL;
    def.lowest = lowest;
    const se3d_status status = se3d_modes_create(system, &def, &modes);
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(system));
    }
    CHECK(status == SE3D_OK);
    return modes;
}

/* Eigenvalues to 1e-9, shapes of what has a frequency of its own to `shape` (0: not compared). */
static void compare(world *w, double shape)
{
    se3d_modes *all = linearise(w->system, 0), *few = linearise(w->system, LOWEST);
    CHECK(se3d_modes_count(few) == LOWEST);
    CHECK(se3d_modes_count_freedoms(few) == se3d_modes_count_freedoms(all));
    for (size_t k = 0; k < LOWEST; ++k) {
        se3d_eigenvalue a, b;
        CHECK(se3d_modes_get_eigenvalue(all, k, &a) == SE3D_OK);
        CHECK(se3d_modes_get_eigenvalue(few, k, &b) == SE3D_OK);
        const double size = a.frequency > 0.0 ? 6.3 * a.frequency : 1.0;
        CHECK_NEAR(b.real, a.real, 1e-9 * size);
        CHECK_NEAR(b.imaginary, a.imaginary, 1e-9 * size);
        for (size_t body = 0; body <= BODIES && shape > 0.0; ++body) {
            double x[6], y[6];
            CHECK(se3d_modes_get_shape(all, k, body, x, NULL) == SE3D_OK);
            CHECK(se3d_modes_get_shape(few, k, body, y, NULL) == SE3D_OK);
            for (int c = 0; c < 6; ++c) {
                CHECK_NEAR(y[c], x[c], shape);
            }
        }
    }
    se3d_modes_destroy(all);
    se3d_modes_destroy(few);
    se3d_system_destroy(w->system);
}

static void chains_have_the_modes_of_the_dense_solver(void)
{
    world w = begin();
    add_hinges(&w, 0.3);
    add_springs(&w, 100.0, 0.0);
    compare(&w, 1e-9);
}

/* Joints of every third body are doubled: rows that depend on others, and loops. */
static void add_doubled_hinges(world *w)
{
    add_hinges(w, 0.0);
    for (int k = 0; k < BODIES; k += 3) {
        const double at[3] = {k, 0.0, 0.0}, axis[3] = {0.0, 0.0, 1.0};
        add_hinge(w, before(w, k), k, at, axis);
    }
}

static void redundant_rows_change_nothing(void)
{
    world w = begin();
    add_doubled_hinges(&w);
    add_springs(&w, 100.0, 0.0);
    compare(&w, 1e-9);
}

/* Nothing holds the bodies: as many zeros as one asks for. */
static void free_bodies_do_not_vibrate(void)
{
    world w = begin();
    compare(&w, 0.0);
}

/* Bodies that stand on hinges fall, each by itself, with the same rate two by two. */
static void unstable_modes_are_found_by_their_size(void)
{
    const double down[3] = {0.0, 0.0, -9.81};
    world w = begin();
    CHECK(se3d_system_set_gravity(w.system, down) == SE3D_OK);
    for (int k = 0; k < BODIES; ++k) {
        const double length = 0.5 + 0.01 * (k / 4), axis[3] = {0.0, 1.0, 0.0};
        const double at[3] = {k + 0.5, 0.0, k % 2 ? length : -length};
        add_hinge(&w, ground_of(&w), k, at, axis);
    }
    compare(&w, 0.0);
}

/* Damping is a case for the dense solver. */
static void damped_modes_are_those_of_the_dense_solver(void)
{
    world w = begin();
    add_hinges(&w, 0.3);
    add_springs(&w, 100.0, 0.5);
    compare(&w, 1e-12);
}

/* Springs and dampers from each body to the next but one. */
static void dampers_between_bodies_are_seen(void)
{
    world w = begin();
    add_hinges(&w, 0.3);
    add_springs(&w, 100.0, 0.0);
    for (int k = 0; k + 2 < BODIES; ++k) {
        se3d_tsda_def def = se3d_tsda_def_default();
        se3d_force damper;
        def.body_i = w.body[k];
        def.body_j = w.body[k + 2];
        def.point_j[1] = 0.5;
        def.k = 30.0;
        def.c = k == BODIES / 2 ? 2.0 : 0.0;
        def.l0 = 2.0;
        CHECK(se3d_force_create_tsda(w.system, &def, &damper) == SE3D_OK);
    }
    compare(&w, 1e-9);
}

/* A body that turns about its axis wobbles, by gyroscopic terms. */
static void a_body_that_turns_is_no_case_for_it(void)
{
    const double rate[3] = {3.0, 0.0, 0.0};
    world w = begin();
    CHECK(se3d_body_set_angular_velocity(w.system, w.body[7], rate) == SE3D_OK);
    compare(&w, 0.0);
}

/* Rotors on the hinges tie the masses of bodies together. */
static void rotors_have_the_modes_of_the_dense_solver(void)
{
    world w = begin();
    for (int k = 0; k < BODIES; ++k) {
        const double at[3] = {k, 0.0, 0.0}, axis[3] = {0.0, k % 2 ? 0.3 : 0.0, 1.0};
        se3d_armature_def def = se3d_armature_def_default();
        se3d_force rotor;
        def.joint = add_hinge(&w, before(&w, k), k, at, axis);
        def.inertia = 0.05 + 0.01 * k;
        CHECK(se3d_force_create_armature(w.system, &def, &rotor) == SE3D_OK);
    }
    add_springs(&w, 100.0, 0.0);
    compare(&w, 1e-9);
}

/* Loads that turn with their bodies make the stiffness unsymmetric: small ones do next to nothing,
 * large ones do. */
static void loads_that_follow_their_bodies_are_seen(void)
{
    static const double loads[] = {1e-3, 20.0};
    for (size_t row = 0; row < sizeof loads / sizeof *loads; ++row) {
        world w = begin();
        add_hinges(&w, 0.3);
        add_springs(&w, 100.0, 0.0);
        se3d_load_def def = se3d_load_def_default();
        se3d_force load;
        def.body = w.body[BODIES - 1];
        def.in_body_frame = 1;
        def.value[1] = loads[row];
        CHECK(se3d_force_create_load(w.system, &def, &load) == SE3D_OK);
        compare(&w, 0.0);
    }
}

/* The count is of the lowest, and there are no matrices. */
static void what_is_not_asked_for_is_not_there(void)
{
    world w = begin();
    size_t rows = 1, columns = 1;
    se3d_modes_def def = se3d_modes_def_default();
    const se3d_modes_input input = {.body = w.body[0], .direction = {1.0, 0.0, 0.0}};
    add_hinges(&w, 0.3);
    add_springs(&w, 100.0, 0.0);
    se3d_modes *modes = linearise(w.system, LOWEST);
    for (int32_t k = SE3D_MODES_A; k <= SE3D_MODES_BASIS; ++k) {
        CHECK(se3d_modes_get_matrix(modes, k, &rows, &columns, NULL, 0) == SE3D_OK);
        CHECK(rows == 0 && columns == 0);
    }
    se3d_modes_destroy(modes);
    modes = linearise(w.system, 1000);
    CHECK(se3d_modes_count(modes) == BODIES);
    se3d_modes_destroy(modes);
    def.inputs = &input;
    def.input_count = 1;
    def.lowest = 1;
    CHECK(se3d_modes_create(w.system, &def, &modes) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "lowest");
    se3d_system_destroy(w.system);
}

/* Each failed allocation is reported, and not mended by the dense solver, and gives back what there
 * was. */
static void failed_allocations_leave_nothing(void)
{
    support_counting counting = {.fail_at = 0};
    const se3d_allocator allocator = support_counting_allocator(&counting);
    world w = begin_with(&allocator);
    se3d_modes_def def = se3d_modes_def_default();
    se3d_modes *modes = NULL;
    se3d_status status = SE3D_ERR_NO_MEMORY;
    def.lowest = LOWEST;
    add_doubled_hinges(&w);
    add_springs(&w, 100.0, 0.0);
    modes = linearise(w.system, LOWEST);
    se3d_modes_destroy(modes);
    const size_t live = counting.live;
    size_t k = 1;
    for (bool is_over = false; !is_over && k < 2000; ++k) {
        counting.calls = counting.failed = 0;
        counting.fail_at = k;
        status = se3d_modes_create(w.system, &def, &modes);
        is_over = counting.failed == 0;
        CHECK(is_over ? status == SE3D_OK : status == SE3D_ERR_NO_MEMORY && !modes);
        se3d_modes_destroy(modes);
        CHECK(counting.live == live);
    }
    CHECK(status == SE3D_OK && k > 50);
    se3d_system_destroy(w.system);
    CHECK(counting.live == 0 && counting.bytes == 0 && counting.wrong == 0);
}

int main(void)
{
    RUN(chains_have_the_modes_of_the_dense_solver);
    RUN(redundant_rows_change_nothing);
    RUN(free_bodies_do_not_vibrate);
    RUN(unstable_modes_are_found_by_their_size);
    RUN(damped_modes_are_those_of_the_dense_solver);
    RUN(dampers_between_bodies_are_seen);
    RUN(a_body_that_turns_is_no_case_for_it);
    RUN(rotors_have_the_modes_of_the_dense_solver);
    RUN(loads_that_follow_their_bodies_are_seen);
    RUN(what_is_not_asked_for_is_not_there);
    RUN(failed_allocations_leave_nothing);
    return check_finish();
}
