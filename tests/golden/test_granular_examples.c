/* SPDX-License-Identifier: BSD-3-Clause */
/* The granular examples do what their heads say: what leaves the hopper is counted and nothing is
 * lost beside it; the drum's motor carries the slope; the bucket's pin carries what it has dug;
 * the oedometer's plate holds its load. */
#include "check.h"
#include "se3d/io.h"
#include "se3d/se3d.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST 2000

typedef struct world {
    se3d_model *model;
    se3d_system *system;
    se3d_particles *particles;
    se3d_solver *solver;
    double r[3 * MOST], radius[MOST];
    size_t count;
} world;

static void open_world(world *w, const char *name)
{
    const char *root = getenv("SE3D_SOURCE_DIR");
    char path[900];
    se3d_model_error error;
    se3d_solver_def def = se3d_solver_def_default();
    snprintf(path, sizeof path, "%.500s/examples/models/%s.yaml", root ? root : ".", name);
    CHECK(!se3d_model_read_file(path, NULL, &w->model, &error));
    w->system = se3d_model_get_system(w->model);
    CHECK(!se3d_particles_find(w->system, "particles", &w->particles));
    CHECK(!se3d_model_get_solver(w->model, 0, &def));
    CHECK(!se3d_solver_create(w->system, &def, &w->solver));
}

static void close_world(world *w)
{
    se3d_solver_destroy(w->solver);
    se3d_model_destroy(w->model);
}

static void go(world *w, double t)
{
    se3d_status status = se3d_solver_run(w->solver, t);
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(w->system));
    }
    CHECK(status >= 0);
    w->count = se3d_particles_count(w->particles);
    CHECK(w->count <= MOST);
    CHECK(!se3d_particles_get_all(w->particles, w->count, w->r, NULL, NULL));
    CHECK(!se3d_particles_get_radii(w->particles, w->count, w->radius));
}

static double mass_of(const world *w, size_t k)
{
    return 2500.0 * 4.0 / 3.0 * 3.14159265358979323846 * pow(w->radius[k], 3.0);
}

/* Mass above z = `height`, and its centre. */
static double mass_above(const world *w, double height, double centre[3])
{
    double mass = 0.0;
    memset(centre, 0, 3 * sizeof *centre);
    for (size_t k = 0; k < w->count; ++k) {
        if (w->r[3 * k + 2] > height) {
            mass += mass_of(w, k);
            for (size_t a = 0; a < 3; ++a) {
                centre[a] += mass_of(w, k) * w->r[3 * k + a];
            }
        }
    }
    for (size_t a = 0; a < 3; ++a) {
        centre[a] /= mass;
    }
    return mass;
}

static world w; /* large */

static void hopper_discharges_through_its_gate_and_loses_nothing(void)
{
    double centre[3], before, middle, after;
    se3d_particles_stats stats;
    open_world(&w, "hopper");
    size_t all = se3d_particles_count(w.particles);
    go(&w, 0.19);
    CHECK(w.count == all);
    before = mass_above(&w, -0.01, centre);
    CHECK(centre[2] > 0.01 && centre[2] < 0.05);
    go(&w, 0.3);
    middle = mass_above(&w, -0.01, centre);
    go(&w, 0.4);
    after = mass_above(&w, -0.01, centre);
    CHECK(middle < 0.97 * before);
    CHECK(middle - after > 0.1 * before);
    go(&w, 0.5);
    CHECK(!se3d_particles_get_stats(w.particles, &stats));
    CHECK(stats.lost > 50 && w.count + stats.lost == all);
    close_world(&w);
}

static void motor_of_the_drum_carries_the_slope(void)
{
    double moment = 0.0, effort = 0.0, lean = 0.0, now, centre[3];
    se3d_constraint motor;
    int samples = 0;
    open_world(&w, "rotating_drum");
    CHECK(!se3d_constraint_find(w.system, "motor", &motor));
    for (double t = 0.5; t < 1.0; t += 0.005, ++samples) {
        go(&w, t);
        CHECK(!se3d_driver_get_effort(w.system, motor, &now));
        double mass = mass_above(&w, -1.0, centre);
        moment += 9.81 * mass * centre[0];
        effort += now;
        lean += atan2(fabs(centre[0]), -centre[2]);
    }
    moment /= samples;
    effort /= samples;
    lean *= 180.0 / 3.14159265358979323846 / samples;
    CHECK(fabs(moment) > 0.005);
    CHECK_NEAR(effort, -moment, 0.1 * fabs(moment)); /* steady but for avalanches */
    CHECK(lean > 15.0 && lean < 45.0);
    close_world(&w);
}

static void pin_carries_the_bucket_and_what_it_has_dug(void)
{
    double force[3], torque[3], centre[3], lift = 0.0;
    const int samples = 20; /* beads still jump about */
    se3d_constraint pin;
    open_world(&w, "bucket");
    CHECK(!se3d_constraint_find(w.system, "pin", &pin));
    double load = 0.0;
    for (int k = 0; k < samples; ++k) {
        go(&w, 1.3 + 0.005 * (k + 1));
        CHECK(!se3d_constraint_get_reaction(w.system, pin, force, torque));
        lift += force[2] / samples;
        load += mass_above(&w, 0.15, centre) / samples;
    }
    CHECK(load > 0.02);
    CHECK_NEAR(lift, 9.81 * (1.0 + load), 0.05 * 9.81 * load);
    close_world(&w);
}

/* A servo wall: it comes down at each step of its load, less for each newton the more the beads are
 * pressed. */
static void plate_of_the_oedometer_holds_its_load(void)
{
    static const double times[3] = {0.24, 0.3, 0.36}, loads[3] = {20.0, 50.0, 100.0};
    double z[3];
    open_world(&w, "oedometer");
    for (int k = 0; k < 3; ++k) {
        se3d_servo_state plate;
        go(&w, times[k]);
        CHECK(!se3d_particles_get_servo(w.particles, 0, &plate));
        CHECK_NEAR(plate.wanted, loads[k], 1e-3 * loads[k]);
        CHECK_NEAR(plate.force / loads[k], 1.0, 0.01);
        z[k] = -plate.position;
    }
    CHECK(z[0] > z[1] && z[1] > z[2]);
    CHECK((z[0] - z[1]) / 30.0 > (z[1] - z[2]) / 50.0);
    close_world(&w);
}

/* The lid has its load, and what the beads hold the upper half back with is what they are held
 * with in shear boxes: about as much as the lid presses with. */
static void shear_box_presses_and_is_held_back(void)
{
    static const double times[3] = {0.32, 0.38, 0.42};
    se3d_servo_state lid;
    se3d_body upper;
    double force[3], torque[3], sunk = 0.0, lid_load = 0.0, held = 0.0;
    se3d_solver_def def = se3d_solver_def_default();
    open_world(&w, "shear_box");
    se3d_solver_destroy(w.solver);
    def.method = SE3D_METHOD_VERLET;
    def.step = 2e-5; /* the automatic one takes three times as long */
    CHECK(!se3d_solver_create(w.system, &def, &w.solver));
    CHECK(!se3d_body_find(w.system, "upper", &upper));
    for (int k = 0; k < 3; ++k) {
        go(&w, times[k]);
        CHECK(!se3d_particles_get_servo(w.particles, 0, &lid));
        CHECK(!se3d_body_get_contact_wrench(w.system, upper, force, torque));
        CHECK_NEAR(lid.wanted, 5000.0 * 0.06 * 0.06, 1e-9);
        CHECK_NEAR(lid.force, lid.wanted, 0.15 * lid.wanted);
        sunk = k == 0 ? lid.position : sunk;
        lid_load = lid.force;
        held = -force[0];
    }
    CHECK(held > 0.7 * lid_load && held < 1.6 * lid_load);
    CHECK(sunk > 0.03 && lid.position < sunk); /* it was lifted */
    close_world(&w);
}

int main(void)
{
    RUN(hopper_discharges_through_its_gate_and_loses_nothing);
    RUN(motor_of_the_drum_carries_the_slope);
    RUN(plate_of_the_oedometer_holds_its_load);
    RUN(shear_box_presses_and_is_held_back);
    if (check_is_long()) {
        RUN(pin_carries_the_bucket_and_what_it_has_dug);
    }
    return check_finish();
}
