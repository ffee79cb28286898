/* SPDX-License-Identifier: BSD-3-Clause */
/* What belongs to a system may live longer than it: calls are refused, destroying is fine, and
 * nothing is lost or freed twice. */
#include "misuse/callback_world.h"
#include "support/counting.h"

static void leave_behind(world *w, se3d_particles **copy)
{
    world_open(w, SE3D_METHOD_VERLET);
    CHECK(!se3d_particles_clone(w->particles, copy));
    CHECK(!se3d_solver_run(w->solver, 0.01));
    CHECK(se3d_solver_count_event_records(w->solver) > 0);
    se3d_snapshot_destroy(w->snapshot);
    se3d_system_destroy(w->system);
    se3d_coordinates_destroy(w->coordinates);
}

static void a_solver_may_outlive_its_system(void)
{
    world w;
    se3d_particles *copy;
    se3d_solver_stats stats;
    se3d_event_record record;
    se3d_event event = {7, 7};
    const se3d_event_def def = se3d_event_def_default();
    const char *name = NULL;
    leave_behind(&w, &copy);
    CHECK(se3d_solver_run(w.solver, 1.0) == SE3D_ERR_STATE);
    CHECK(se3d_solver_step(w.solver, 1e-3) == SE3D_ERR_STATE);
    CHECK(!se3d_solver_get_stats(w.solver, &stats) && stats.steps > 0);
    CHECK(!se3d_solver_get_method(w.solver, &name) && strcmp(name, "verlet") == 0);
    CHECK(se3d_solver_count_event_records(w.solver) == 0);
    CHECK(se3d_solver_get_event_record(w.solver, 0, &record) == SE3D_ERR_STATE);
    CHECK(se3d_solver_clear_event_records(w.solver) == SE3D_ERR_STATE);
    CHECK(se3d_event_create(w.solver, &def, &event) == SE3D_ERR_STATE && event.index1 == 0);
    CHECK(se3d_event_destroy(w.solver, w.event) == SE3D_ERR_STATE);
    CHECK(se3d_event_get_name(w.solver, w.event, &name) == SE3D_ERR_STATE);
    se3d_solver_destroy(w.solver);
    se3d_particles_destroy(copy);
}

static void a_clone_of_particles_may_outlive_their_system(void)
{
    world w;
    se3d_particles *copy, *again = NULL;
    double r[9], force[3], torque[3], x;
    se3d_particles_energy energy;
    se3d_particles_tally tally;
    leave_behind(&w, &copy);
    CHECK(se3d_particles_count(copy) == 3);
    CHECK(!se3d_particles_get_all(copy, 3, r, NULL, NULL));
    CHECK_NEAR(r[0], 2.0, 0.01);
    CHECK(se3d_particles_hash(copy) != 0);
    CHECK(se3d_particles_count_contacts(copy) == 0);
    CHECK(se3d_particles_run(copy, 1.0) == SE3D_ERR_STATE);
    CHECK(se3d_particles_step(copy, 1) == SE3D_ERR_STATE);
    CHECK(se3d_particles_restore(copy, copy) == SE3D_ERR_STATE);
    CHECK(se3d_particles_clone(copy, &again) == SE3D_ERR_STATE && !again);
    CHECK(se3d_particles_get_energy(copy, &energy) == SE3D_ERR_STATE);
    CHECK(se3d_particles_get_tally(copy, 0, &tally) == SE3D_ERR_STATE);
    CHECK(se3d_particles_get_step(copy, &x) == SE3D_ERR_STATE);
    CHECK(se3d_particles_get_wrench(copy, w.ball, force, torque) == SE3D_ERR_STATE);
    CHECK(se3d_particles_set_step(copy, 1e-4) == SE3D_ERR_STATE);
    se3d_particles_destroy(copy);
    se3d_solver_destroy(w.solver);
}

/* Each call that reads or edits says STATE, as there is no system to tell why. */
static void no_call_reaches_a_system_that_is_gone(void)
{
    world w;
    se3d_particles *copy;
    uint32_t at = 7;
    size_t count = 7;
    double x[64] = {0.0}, *y = x + 32;
    se3d_average average;
    se3d_field_grid grid = se3d_field_grid_default();
    se3d_particles_contact contact;
    se3d_flow_def flow = se3d_flow_def_default();
    se3d_clump_def clump = se3d_clump_def_default();
    se3d_bond_def bond = se3d_bond_def_default();
    se3d_servo_def servo = se3d_servo_def_default();
    se3d_cell_def cell = se3d_cell_def_default();
    se3d_fill_def fill = se3d_fill_def_default();
    se3d_particles_source_def source = se3d_particles_source_def_default();
    se3d_particles_sink_def sink = se3d_particles_sink_def_default();
    leave_behind(&w, &copy);
    const se3d_status calls[] = {
        se3d_particles_get_average(copy, x, y, -1, &average),
        se3d_particles_get_fields(copy, &grid, 1, x),
        se3d_particles_get_contacts(copy, 1, &contact),
        se3d_particles_get_wall_map(copy, w.pad, 1, x, &count),
        se3d_particles_get_wall_corners(copy, w.pad, 1, x, &count),
        se3d_particles_add(copy, w.stuff, 1, x, y, NULL, NULL, NULL),
        se3d_particles_add_clump_template(copy, &clump, &at),
        se3d_particles_add_clumps(copy, 0, w.stuff, 1, x, NULL, NULL, NULL),
        se3d_particles_set_clumps(copy, 0, NULL, NULL, NULL, NULL),
        se3d_particles_bond(copy, &bond, 0, NULL, NULL, &at),
        se3d_particles_bond_near(copy, &bond, -1, -1, &count, &at),
        se3d_particles_bond_shape(copy, &bond, w.pad, -1, &count, &at),
        se3d_particles_add_cell_stage(copy, &cell, &at),
        se3d_particles_add_flow(copy, &flow, &at),
        se3d_particles_add_servo(copy, &servo, &at),
        se3d_particles_fill_lattice(copy, &fill, &count),
        se3d_particles_fill_random(copy, &fill),
        se3d_particles_add_source(copy, &source, &at),
        se3d_particles_remove_source(copy, 0),
        se3d_particles_add_sink(copy, &sink, &at),
        se3d_particles_remove_sink(copy, 0),
        se3d_particles_set_tags(copy, 0, NULL, 1),
        se3d_particles_set_fixed(copy, 0, NULL, 1),
        se3d_particles_remove(copy, 0, NULL),
        se3d_particles_set_all(copy, 0, NULL, NULL, NULL),
        se3d_solver_set_shown(w.solver, SE3D_SHOWN_ALL),
        se3d_solver_read(w.solver, x, sizeof x),
    };
    for (size_t k = 0; k < sizeof calls / sizeof *calls; ++k) {
        if (calls[k] != SE3D_ERR_STATE) {
            fprintf(stderr, "call %zu: %d\n", k, (int)calls[k]);
        }
        CHECK(calls[k] == SE3D_ERR_STATE);
    }
    CHECK(se3d_particles_count(copy) == 3);
    se3d_particles_destroy(copy);
    se3d_solver_destroy(w.solver);
}

static void coordinates_may_outlive_their_system(void)
{
    world w;
    se3d_coordinates *c;
    double q[64] = {0.0}, out[4096];
    size_t freedoms;
    world_open(&w, SE3D_METHOD_RK4);
    se3d_snapshot_destroy(w.snapshot);
    se3d_solver_destroy(w.solver);
    c = w.coordinates;
    CHECK(se3d_coordinates_count(c) > 0);
    se3d_system_destroy(w.system);
    const se3d_status calls[] = {
        se3d_coordinates_get_entry(c, 0, NULL, NULL, NULL, NULL, NULL),
        se3d_coordinates_get(c, q, NULL),
        se3d_coordinates_set(c, q, NULL),
        se3d_coordinates_move(c, q, q, out),
        se3d_coordinates_compute_accelerations(c, NULL, out),
        se3d_coordinates_compute_efforts(c, q, out),
        se3d_coordinates_compute_gravity(c, out),
        se3d_coordinates_compute_mass_matrix(c, out),
        se3d_coordinates_multiply_mass(c, q, out),
        se3d_coordinates_solve_mass(c, q, out),
        se3d_coordinates_compute_jacobian(c, (se3d_marker){0, 0}, out, NULL),
        se3d_coordinates_compute_transposed(c, (se3d_marker){0, 0}, q, out),
        se3d_coordinates_compute_momentum(c, q, NULL),
        se3d_coordinates_compute_loop_jacobian(c, out),
        se3d_coordinates_compute_null_space(c, out, &freedoms),
    };
    for (size_t k = 0; k < sizeof calls / sizeof *calls; ++k) {
        CHECK(calls[k] == SE3D_ERR_STATE);
    }
    se3d_coordinates_destroy(c);
}

static void nothing_is_lost_in_any_order(void)
{
    for (int order = 0; order < 6; ++order) {
        support_counting counting = {0};
        const se3d_allocator allocator = support_counting_allocator(&counting);
        se3d_system_def def = se3d_system_def_default();
        se3d_system *system = NULL;
        se3d_solver *solver[2] = {NULL, NULL};
        se3d_body body;
        se3d_body_def stuff = se3d_body_def_default();
        stuff.mass = stuff.inertia[0] = stuff.inertia[1] = stuff.inertia[2] = 1.0;
        def.allocator = &allocator;
        CHECK(!se3d_system_create(&def, &system) && !se3d_body_create(system, &stuff, &body));
        const se3d_solver_def settings = se3d_solver_def_default();
        for (int k = 0; k < 2; ++k) {
            CHECK(!se3d_solver_create(system, &settings, &solver[k]));
            CHECK(!se3d_solver_run(solver[k], 0.1 * (k + 1)));
        }
        static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                         {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
        for (int k = 0; k < 3; ++k) {
            const int which = orders[order][k];
            if (which == 2) {
                se3d_system_destroy(system);
            } else {
                se3d_solver_destroy(solver[which]);
            }
        }
        CHECK(counting.live == 0 && counting.bytes == 0 && counting.wrong == 0);
    }
}

int main(void)
{
    RUN(a_solver_may_outlive_its_system);
    RUN(a_clone_of_particles_may_outlive_their_system);
    RUN(no_call_reaches_a_system_that_is_gone);
    RUN(coordinates_may_outlive_their_system);
    RUN(nothing_is_lost_in_any_order);
    return check_finish();
}
