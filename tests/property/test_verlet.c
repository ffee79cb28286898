/* SPDX-License-Identifier: BSD-3-Clause */
/* verlet: bodies and particles in one loop. Momentum is kept to rounding, what the particles press
 * is what the joints carry, constraints hold, and a snapshot continues with the same bits. */
#include "check.h"
#include "se3d/se3d.h"

#include <math.h>
#include <string.h>

typedef struct world {
    se3d_system *system;
    se3d_particles *particles;
    se3d_material material;
    se3d_body body;
    se3d_solver *solver;
} world;

static void open_world(world *w, const double gravity[3])
{
    se3d_system_def def = se3d_system_def_default();
    memcpy(def.gravity, gravity, sizeof def.gravity);
    *w = (world){0};
    CHECK(se3d_system_create(&def, &w->system) == SE3D_OK);
    se3d_particles_def set = se3d_particles_def_default();
    set.name = "sand";
    CHECK(se3d_particles_create(w->system, &set, &w->particles) == SE3D_OK);
    se3d_material_def stuff = se3d_material_def_default();
    stuff.density = 2500.0;
    stuff.stiffness = 1e4;
    CHECK(se3d_material_create(w->system, &stuff, &w->material) == SE3D_OK);
}

static void close_world(world *w)
{
    se3d_solver_destroy(w->solver);
    se3d_system_destroy(w->system); /* and its particles */
}

static void add_body(world *w, double mass, const double r[3], const double size[3])
{
    se3d_body_def def = se3d_body_def_default();
    def.mass = mass;
    memcpy(def.position, r, sizeof def.position);
    for (int k = 0; k < 3; ++k) {
        double a = size[(k + 1) % 3], b = size[(k + 2) % 3];
        def.inertia[k] = mass * (a * a + b * b) / 12.0;
    }
    CHECK(se3d_body_create(w->system, &def, &w->body) == SE3D_OK);
}

static void add_box(world *w, se3d_body body, const double at[3], const double size[3])
{
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape shape;
    def.body = body;
    def.material = w->material;
    memcpy(def.position, at, sizeof def.position);
    memcpy(def.size, size, sizeof def.size);
    CHECK(se3d_shape_create_box(w->system, &def, &shape) == SE3D_OK);
}

static void add_floor(world *w, double z)
{
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape shape;
    def.material = w->material;
    def.position[2] = z;
    CHECK(se3d_shape_create_plane(w->system, &def, &shape) == SE3D_OK);
}

static void fill(world *w, const double lower[3], const double upper[3], const double v[3])
{
    se3d_fill_def def = se3d_fill_def_default();
    def.material = w->material;
    memcpy(def.lower, lower, sizeof def.lower);
    memcpy(def.upper, upper, sizeof def.upper);
    def.radius_min = 0.008;
    def.radius_max = 0.012;
    def.jitter = 0.001;
    def.seed = 3;
    memcpy(def.velocity, v, sizeof def.velocity);
    CHECK(se3d_particles_fill_lattice(w->particles, &def, NULL) == SE3D_OK);
}

static void solve(world *w, int32_t formulation)
{
    se3d_solver_def def = se3d_solver_def_default();
    def.formulation = formulation;
    CHECK(se3d_solver_create(w->system, &def, &w->solver) == SE3D_OK);
}

static void go(world *w, double t)
{
    se3d_status status = se3d_solver_run(w->solver, t);
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(w->system));
    }
    CHECK(status >= 0);
}

/* Momentum and angular momentum about the origin, and the largest part of either. */
static void add_momentum(const double r[3], const double p[3], const double spin[3], double sum[6],
                         double *size)
{
    double l[3] = {r[1] * p[2] - r[2] * p[1] + spin[0], r[2] * p[0] - r[0] * p[2] + spin[1],
                   r[0] * p[1] - r[1] * p[0] + spin[2]};
    for (int k = 0; k < 3; ++k) {
        sum[k] += p[k];
        sum[3 + k] += l[k];
        *size = fmax(*size, fmax(fabs(p[k]), fabs(l[k])));
    }
}

static void measure_momentum(const world *w, double sum[6], double *size)
{
    double r[3], v[3], L[3], spin[3], mass, J[6], rate[3];
    static double x[3000], xdot[3000], turn[3000], radius[1000];
    memset(sum, 0, 6 * sizeof *sum);
    *size = 0.0;
    CHECK(!se3d_body_get_position(w->system, w->body, r));
    CHECK(!se3d_body_get_velocity(w->system, w->body, v));
    CHECK(!se3d_body_get_angular_velocity(w->system, w->body, rate));
    CHECK(!se3d_body_get_mass(w->system, w->body, &mass, J));
    for (int k = 0; k < 3; ++k) {
        L[k] = J[k] * rate[k];
        v[k] *= mass;
    }
    CHECK(!se3d_body_get_point(w->system, w->body, L, spin));
    for (int k = 0; k < 3; ++k) {
        spin[k] -= r[k];
    }
    add_momentum(r, v, spin, sum, size);
    size_t n = se3d_particles_count(w->particles);
    CHECK(n <= 1000);
    CHECK(!se3d_particles_get_all(w->particles, n, x, xdot, turn));
    CHECK(!se3d_particles_get_radii(w->particles, n, radius));
    for (size_t i = 0; i < n; ++i) {
        double m = 2500.0 * 4.0 / 3.0 * 3.14159265358979323846 * pow(radius[i], 3.0);
        for (int k = 0; k < 3; ++k) {
            v[k] = m * xdot[3 * i + (size_t)k];
            spin[k] = 0.4 * m * radius[i] * radius[i] * turn[3 * i + (size_t)k];
        }
        add_momentum(x + 3 * i, v, spin, sum, size);
    }
}

static double energy_kinetic(const world *w)
{
    se3d_energy energy = {0};
    CHECK(!se3d_system_get_energy(w->system, &energy));
    return energy.kinetic;
}

/* Energy of the bodies, less what drivers and particles did on them. */
static double balance(const world *w)
{
    se3d_energy energy = {0};
    se3d_work work = {0};
    CHECK(!se3d_system_get_energy(w->system, &energy));
    CHECK(!se3d_system_get_work(w->system, &work));
    return energy.kinetic + energy.potential + work.dissipated - work.actuators - work.drivers;
}

/* A long free box is hit by a cloud off its centre: it tumbles. */
static void momentum_of_bodies_and_particles_is_kept_to_rounding(void)
{
    const double none[3] = {0.0, 0.0, 0.0};
    const double size[3] = {0.3, 0.1, 0.04};
    for (int32_t formulation = 0; formulation < 2; ++formulation) {
        world w;
        double before[6], after[6], scale, w1[3];
        open_world(&w, none);
        add_body(&w, 0.5, none, size);
        add_box(&w, w.body, none, size);
        fill(&w, (double[3]){0.02, -0.08, 0.05}, (double[3]){0.2, 0.05, 0.12},
             (double[3]){0.1, 0.2, -1.5});
        CHECK(se3d_particles_count(w.particles) > 40);
        measure_momentum(&w, before, &scale);
        solve(&w, formulation);
        go(&w, 0.2);
        double size_now;
        measure_momentum(&w, after, &size_now);
        for (int k = 0; k < 6; ++k) {
            CHECK_NEAR(after[k], before[k], 1e-12 * scale);
        }
        CHECK(!se3d_body_get_angular_velocity(w.system, w.body, w1));
        CHECK(fabs(w1[1]) > 1.0); /* much has happened */
        CHECK(energy_kinetic(&w) > 0.05);
        CHECK_NEAR(balance(&w), 0.0, 1e-4 * energy_kinetic(&w));
        close_world(&w);
    }
}

/* A tray of 5 walls hangs by a revolute joint far above, damped: at rest the pin carries tray and
 * particles. */
static void a_joint_carries_the_particles_in_its_tray(void)
{
    const double g[3] = {0.0, 0.0, -9.81};
    world w;
    open_world(&w, g);
    add_body(&w, 2.0, (double[3]){0.0, 0.0, 0.0}, (double[3]){0.2, 0.1, 0.02});
    se3d_joint_def pin = se3d_joint_def_default();
    se3d_constraint joint;
    CHECK(!se3d_system_get_ground(w.system, &pin.body_i));
    pin.body_j = w.body;
    CHECK(!se3d_joint_def_set_frame(w.system, &pin, (double[3]){0.0, 0.0, 0.5},
                                    (double[3]){0.0, 1.0, 0.0}, NULL));
    CHECK(!se3d_joint_create_revolute(w.system, &pin, &joint));
    se3d_rsda_def damper = se3d_rsda_def_default();
    se3d_force force;
    damper.joint = joint;
    damper.c = 2.0;
    CHECK(!se3d_force_create_rsda(w.system, &damper, &force));
    add_box(&w, w.body, (double[3]){0.0, 0.0, 0.0}, (double[3]){0.2, 0.1, 0.02});
    for (int side = -1; side < 2; side += 2) {
        add_box(&w, w.body, (double[3]){0.105 * side, 0.0, 0.05}, (double[3]){0.01, 0.1, 0.1});
        add_box(&w, w.body, (double[3]){0.0, 0.055 * side, 0.05}, (double[3]){0.2, 0.01, 0.1});
    }
    fill(&w, (double[3]){-0.09, -0.045, 0.012}, (double[3]){0.09, 0.045, 0.09},
         (double[3]){0.0, 0.0, 0.0});
    solve(&w, SE3D_FORMULATION_ROMEGA);
    go(&w, 1.5);
    double mass = 2.0, radius[200], reaction[3], torque[3], violation[3];
    size_t n = se3d_particles_count(w.particles);
    CHECK(n > 10 && n < 200);
    CHECK(!se3d_particles_get_radii(w.particles, n, radius));
    for (size_t k = 0; k < n; ++k) {
        mass += 2500.0 * 4.0 / 3.0 * 3.14159265358979323846 * pow(radius[k], 3.0);
    }
    CHECK(!se3d_constraint_get_reaction(w.system, joint, reaction, torque));
    CHECK_NEAR(reaction[2], 9.81 * mass, 0.01 * 9.81 * mass);
    CHECK(fabs(reaction[1]) < 0.01 * 9.81 * mass);
    CHECK(!se3d_system_get_violation(w.system, violation));
    CHECK(violation[0] < 1e-12 && violation[1] < 1e-10);
    CHECK_NEAR(balance(&w), 0.0, 1e-4 * 9.81 * mass * 0.1); /* of the tray alone, at z = 0 */
    close_world(&w);
}

/* A driven blade pushes particles on a floor. */
static void open_blade(world *w)
{
    open_world(w, (double[3]){0.0, 0.0, -9.81});
    add_floor(w, 0.0);
    add_body(w, 1.0, (double[3]){-0.1, 0.0, 0.05}, (double[3]){0.02, 0.2, 0.1});
    se3d_joint_def slide = se3d_joint_def_default();
    se3d_constraint joint, driver;
    CHECK(!se3d_system_get_ground(w->system, &slide.body_i));
    slide.body_j = w->body;
    CHECK(!se3d_joint_def_set_frame(w->system, &slide, (double[3]){-0.1, 0.0, 0.05},
                                    (double[3]){1.0, 0.0, 0.0}, NULL));
    CHECK(!se3d_joint_create_prismatic(w->system, &slide, &joint));
    se3d_driver_def drive = se3d_driver_def_default();
    drive.joint = joint;
    drive.coordinate = SE3D_JOINT_COORDINATE_DISPLACEMENT;
    CHECK(!se3d_function_create_expression(w->system, "0.1*t", &drive.function));
    CHECK(!se3d_driver_create(w->system, &drive, &driver));
    add_box(w, w->body, (double[3]){0.0, 0.0, 0.0}, (double[3]){0.02, 0.2, 0.1});
    fill(w, (double[3]){-0.08, -0.08, 0.0}, (double[3]){0.08, 0.08, 0.05},
         (double[3]){0.0, 0.0, 0.0});
    solve(w, SE3D_FORMULATION_ROMEGA);
}

static void a_snapshot_and_a_clone_continue_with_the_same_bits(void)
{
    world w;
    open_blade(&w);
    go(&w, 0.05);
    se3d_snapshot *snapshot;
    se3d_system *clone;
    se3d_solver *solver;
    se3d_particles *copy;
    se3d_solver_def def = se3d_solver_def_default();
    uint64_t middle = se3d_system_hash(w.system);
    CHECK(!se3d_snapshot_create(w.system, &snapshot));
    CHECK(!se3d_system_clone(w.system, &clone));
    CHECK(se3d_system_hash(clone) == middle);
    go(&w, 0.1);
    uint64_t end = se3d_system_hash(w.system);
    uint64_t particles = se3d_particles_hash(w.particles);
    CHECK(end != middle);
    CHECK(!se3d_snapshot_restore(snapshot, w.system));
    CHECK(se3d_system_hash(w.system) == middle);
    go(&w, 0.1);
    CHECK(se3d_system_hash(w.system) == end && se3d_particles_hash(w.particles) == particles);
    CHECK(!se3d_solver_create(clone, &def, &solver));
    CHECK(se3d_solver_run(solver, 0.1) >= 0);
    CHECK(se3d_system_hash(clone) == end);
    CHECK(se3d_system_count_particles(clone) == 1);
    CHECK(!se3d_particles_find(clone, "sand", &copy) && copy != w.particles);
    CHECK(se3d_particles_hash(copy) == particles);
    se3d_solver_destroy(solver);
    se3d_system_destroy(clone);
    se3d_snapshot_destroy(snapshot);
    close_world(&w);
}

static void auto_is_verlet_where_there_are_particles(void)
{
    world w;
    const char *name = "";
    double t, r[3], time;
    open_blade(&w);
    go(&w, 0.01);
    CHECK(!se3d_solver_get_method(w.solver, &name) && strcmp(name, "verlet") == 0);
    CHECK(!se3d_system_get_time(w.system, &t) && !se3d_particles_get_time(w.particles, &time));
    CHECK(t == 0.01 && time == 0.01);
    CHECK(!se3d_body_get_position(w.system, w.body, r));
    CHECK_NEAR(r[0], -0.1 + 0.1 * 0.01, 1e-14);
    close_world(&w);
}

static void too_large_an_overlap_is_named_and_leaves_one_time_for_all(void)
{
    world w;
    double t = -1.0, time = -2.0;
    const double x[3] = {0.0, 0.0, 0.2}, v[3] = {0.0, 0.0, -80.0}, radius = 0.01;
    open_world(&w, (double[3]){0.0, 0.0, 0.0});
    add_floor(&w, 0.0);
    add_body(&w, 1.0, (double[3]){1.0, 0.0, 0.0}, (double[3]){0.1, 0.1, 0.1});
    CHECK(!se3d_particles_add(w.particles, w.material, 1, x, &radius, v, NULL, NULL));
    solve(&w, SE3D_FORMULATION_ROMEGA);
    CHECK(se3d_solver_run(w.solver, 0.1) == SE3D_ERR_STEP_SIZE);
    CHECK_CONTAINS(se3d_system_get_error(w.system),
                   "particle 0 of sand and the shape without a name overlap by");
    CHECK(!se3d_system_get_time(w.system, &t) && !se3d_particles_get_time(w.particles, &time));
    CHECK(t == time && t > 0.0023 && t < 0.0026);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "at time 0.00");
    close_world(&w);
}

int main(void)
{
    RUN(momentum_of_bodies_and_particles_is_kept_to_rounding);
    RUN(a_joint_carries_the_particles_in_its_tray);
    RUN(a_snapshot_and_a_clone_continue_with_the_same_bits);
    RUN(auto_is_verlet_where_there_are_particles);
    RUN(too_large_an_overlap_is_named_and_leaves_one_time_for_all);
    return check_finish();
}
