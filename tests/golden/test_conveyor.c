/* SPDX-License-Identifier: BSD-3-Clause */
/* Surfaces that move on their bodies: a box on a belt slides and then goes with it, a box on a
 * turntable stays on its circle, a ball on one rolls in circles of its own; the work of the drive.
 */
#include "se3d/io.h"
#include "support/scene.h"

typedef struct way {
    int32_t method;
    double step, tolerance;
} way;

static const way ways[] = {{SE3D_METHOD_CONVEX, 1e-3, 0.0},
                           {SE3D_METHOD_VERLET, 0.0, 0.0},
                           {SE3D_METHOD_GENERALIZED_ALPHA, 1e-3, 0.0},
                           {SE3D_METHOD_RADAU, 0.0, 1e-7},
                           {SE3D_METHOD_BDF, 0.0, 1e-7},
                           {SE3D_METHOD_DOP853, 0.0, 1e-7}};
#define WAYS (sizeof ways / sizeof *ways)

static const double no_motion[3] = {0.0, 0.0, 0.0};

static void solve(scene *s, const way *w)
{
    scene_solve(s, w->method, SE3D_FORMULATION_ROMEGA, w->step, w->tolerance);
}

static se3d_shape belt(scene *s, const double velocity[3], const double spin[3])
{
    se3d_shape_def def = scene_shape(s, scene_ground(s));
    se3d_shape shape;
    memcpy(def.surface_velocity, velocity, sizeof def.surface_velocity);
    memcpy(def.surface_spin, spin, sizeof def.surface_spin);
    CHECK(se3d_shape_create_plane(s->system, &def, &shape) == SE3D_OK);
    return shape;
}

static void a_box_slides_on_a_belt_and_then_goes_with_it(void)
{
    const double mu = 0.4, u = 1.2, m = 2.0, size[3] = {0.3, 0.3, 0.06}, sink = m * G / 4e5;
    const double t1 = u / (mu * G), motion[3] = {0.0, u, 0.0}, back[3] = {0.0, -u, 0.0};
    for (size_t k = 0; k < WAYS; ++k) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, mu, 0.2, 1e5);
        const double at[3] = {0.0, 0.0, 0.03 - sink};
        double x[3], v[3];
        se3d_work work;
        se3d_shape shape = belt(&s, motion, no_motion);
        se3d_body box = scene_box(&s, size, m, at, scene_zero);
        solve(&s, &ways[k]);
        CHECK(scene_run(&s, 0.5 * t1)); /* half of the slide */
        CHECK(se3d_body_get_velocity(s.system, box, v) == SE3D_OK);
        CHECK_NEAR(v[1], 0.5 * u, 5e-3 * u);
        CHECK(scene_run(&s, 1.5 * t1));
        CHECK(se3d_body_get_position(s.system, box, x) == SE3D_OK);
        CHECK(se3d_body_get_velocity(s.system, box, v) == SE3D_OK);
        CHECK(se3d_system_get_work(s.system, &work) == SE3D_OK);
        CHECK_NEAR(v[1], u, 5e-3 * u);
        CHECK_NEAR(x[1], u * t1, 5e-3 * u * t1); /* u t1 / 2 while it slides, u t1 / 2 after */
        CHECK_NEAR(work.actuators, m * u * u, 0.01 * m * u * u);
        CHECK_NEAR(work.dissipated, 0.5 * m * u * u, 0.01 * m * u * u);
        /* the belt runs back: the box is brought to rest in t1, with the work against it */
        CHECK(se3d_shape_set_surface_motion(s.system, shape, back, no_motion) == SE3D_OK);
        CHECK(scene_run(&s, 2.5 * t1));
        CHECK(se3d_body_get_velocity(s.system, box, v) == SE3D_OK);
        CHECK_NEAR(v[1], 0.0, 0.01 * u);
        CHECK(se3d_system_get_work(s.system, &work) == SE3D_OK);
        CHECK_NEAR(work.actuators, 2.0 * m * u * u, 0.02 * m * u * u);
        scene_end(&s);
    }
}

/* With the centripetal force of friction, below its cap. */
static void a_box_on_a_turntable_stays_on_its_circle(void)
{
    const double w = 2.0, R = 0.5, size[3] = {0.1, 0.1, 0.02}, spin[3] = {0.0, 0.0, w};
    for (size_t k = 0; k < WAYS; ++k) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.6, 0.2, 1e5);
        const double at[3] = {R, 0.0, 0.01 - G / 4e5}, v0[3] = {0.0, w * R, 0.0}, t = 1.0;
        double x[3], turn[3];
        (void)belt(&s, no_motion, spin);
        se3d_body box = scene_box(&s, size, 1.0, at, v0);
        CHECK(se3d_body_set_angular_velocity(s.system, box, spin) == SE3D_OK);
        solve(&s, &ways[k]);
        CHECK(scene_run(&s, t));
        CHECK(se3d_body_get_position(s.system, box, x) == SE3D_OK);
        CHECK(se3d_body_get_angular_velocity(s.system, box, turn) == SE3D_OK);
        CHECK_NEAR(x[0], R * cos(w * t), 2e-3 * R);
        CHECK_NEAR(x[1], R * sin(w * t), 2e-3 * R);
        CHECK_NEAR(turn[2], w, 2e-3 * w);
        scene_end(&s);
    }
}

/* A ball that rolls on a turntable: dv/dt = 2/7 w z x v, a circle of radius 7 v / (2 w). */
static void a_ball_on_a_turntable_rolls_in_circles(void)
{
    const double w = 3.0, r = 0.05, v = 0.3, spin[3] = {0.0, 0.0, w}, rate = 2.0 / 7.0 * w;
    for (size_t k = 0; k < WAYS; k += 3) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 1.0, 0.2, 1e5);
        const double at[3] = {0.2, 0.0, r - G / 1e5}, v0[3] = {0.0, v, 0.0}, t = 1.5;
        /* v + turn x (-r z) = w z x at = (0, w at, 0) */
        const double turn[3] = {(w * at[0] - v) / at[2], 0.0, 0.0};
        double x[3];
        (void)belt(&s, no_motion, spin);
        se3d_body ball = scene_ball(&s, r, 1.0, at, v0);
        CHECK(se3d_body_set_angular_velocity(s.system, ball, turn) == SE3D_OK);
        solve(&s, &ways[k]);
        CHECK(scene_run(&s, t));
        CHECK(se3d_body_get_position(s.system, ball, x) == SE3D_OK);
        CHECK_NEAR(x[0], at[0] - v / rate * (1.0 - cos(rate * t)), 3e-3);
        CHECK_NEAR(x[1], v / rate * sin(rate * t), 3e-3);
        scene_end(&s);
    }
}

/* A box on two rollers that turn against each other: its points of contact stay, what the rollers
 * have there turns on. Without friction it lies as on rollers at rest. */
static void a_box_lies_on_rollers_that_turn(void)
{
    static const double steps[] = {1e-3, 4e-3}, rates[] = {0.0, 5.0, 50.0};
    static const double size[3] = {0.2, 0.2, 0.2};
    for (size_t k = 0; k < sizeof steps / sizeof *steps; ++k) {
        double z[3][3], v[3];
        for (size_t r = 0; r < 3; ++r) {
            scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.0, 0.1, 1e6);
            const double at[3] = {0.0, 0.0, 0.1};
            se3d_work work;
            for (int side = -1; side <= 1; side += 2) {
                se3d_shape_def def = scene_shape(&s, scene_ground(&s));
                se3d_shape roller;
                def.radius = 0.05;
                def.length = 0.4;
                def.position[0] = 0.06 * side;
                def.position[2] = -0.05;
                def.orientation[0] = sqrt(0.5); /* its axis is y */
                def.orientation[1] = -sqrt(0.5);
                def.surface_spin[1] = -side * rates[r];
                CHECK(se3d_shape_create_cylinder(s.system, &def, &roller) == SE3D_OK);
            }
            se3d_body box = scene_box(&s, size, 3.2, at, scene_zero);
            scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, steps[k], 0.0);
            CHECK(scene_run(&s, 0.5));
            CHECK(se3d_body_get_position(s.system, box, z[r]) == SE3D_OK);
            CHECK(se3d_body_get_velocity(s.system, box, v) == SE3D_OK);
            CHECK(se3d_system_get_work(s.system, &work) == SE3D_OK);
            CHECK_NEAR(z[r][2], z[0][2], 1e-9);
            CHECK(fabs(v[2]) < 1e-6);
            CHECK(work.dissipated > 0.0 && fabs(work.actuators) < 1e-9);
            scene_end(&s);
        }
    }
}

/* Once round, by steps of 1 to 4 ms of convex: it is as fast as at the start and where it was, and
 * nothing is dissipated, as the drive gives and takes the same. The spring that sticks lets it lag.
 */
static void a_ball_on_a_turntable_comes_back(void)
{
    const double w = 7.0, r = 0.05, v = 0.6, spin[3] = {0.0, 0.0, w}, stiffness = 1e6;
    for (int k = 0; k < 3; ++k) {
        const double h = 1e-3 * (1 << k), mass = 0.5;
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 1.0, 0.2, stiffness);
        const double at[3] = {0.3, 0.0, r - mass * G / stiffness}, v0[3] = {0.0, v, 0.0};
        const double turn[3] = {(w * at[0] - v) / at[2], 0.0, 0.0};
        double x[3], u[3];
        se3d_energy energy;
        (void)belt(&s, no_motion, spin);
        se3d_body ball = scene_ball(&s, r, mass, at, v0);
        CHECK(se3d_body_set_angular_velocity(s.system, ball, turn) == SE3D_OK);
        scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, h, 0.0);
        CHECK(scene_run(&s, PI));
        CHECK(se3d_body_get_position(s.system, ball, x) == SE3D_OK);
        CHECK(se3d_body_get_velocity(s.system, ball, u) == SE3D_OK);
        CHECK(se3d_system_get_energy(s.system, &energy) == SE3D_OK);
        CHECK_NEAR(hypot(u[0], u[1]), v, 1e-4);
        CHECK_NEAR(x[0], at[0], 12.0 * h * h * at[0]);
        CHECK_NEAR(x[1], 0.0, 5e-4);
        CHECK_NEAR(energy.dissipated, 0.0, 12.0 * h * h * energy.kinetic);
        scene_end(&s);
    }
}

/* At a place that the surface turns about, without a velocity: there a body stays, and turns, also
 * with long steps, over each of which the surface goes on in arcs. */
static void a_box_stays_where_a_surface_that_moves_and_turns_is_at_rest(void)
{
    const double size[3] = {0.1, 0.1, 0.1}, motion[3] = {0.5, 0.0, 0.0}, spin[3] = {0.0, 0.0, 1.0};
    for (size_t k = 0; k < WAYS; k += 2) {
        const double at[3] = {0.0, 0.5, 0.05 - 0.5 * G / 4e4}, t = 1.0;
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.8, 0.2, 1e4);
        double x[3];
        (void)belt(&s, motion, spin);
        se3d_body box = scene_box(&s, size, 0.5, at, scene_zero);
        CHECK(se3d_body_set_angular_velocity(s.system, box, spin) == SE3D_OK);
        scene_solve(&s, ways[k].method, SE3D_FORMULATION_ROMEGA, 0.01, 0.0);
        CHECK(scene_run(&s, t));
        CHECK(se3d_body_get_position(s.system, box, x) == SE3D_OK);
        CHECK_NEAR(x[0], at[0], 1e-5);
        CHECK_NEAR(x[1], at[1], 1e-5);
        scene_end(&s);
    }
}

/* A model file says the same; snapshots go on with the same bits. */
static void a_belt_of_a_file_goes_on_from_a_snapshot(void)
{
    static const char text[] =
        "se3d: 1\n"
        "materials: [{name: rubber, density: 1000, friction: 0.5, restitution: 0.2, "
        "stiffness: 1e5}]\n"
        "contact: {law: hooke}\n"
        "bodies:\n"
        "  - name: ground\n"
        "    shapes: [{type: plane, name: belt, material: rubber, surface_velocity: [1, 0, 0],\n"
        "              surface_spin: [0, 0, 0.5]}]\n"
        "  - name: box\n"
        "    position: [0, 0, 0.049]\n"
        "    shapes: [{type: box, size: [0.1, 0.1, 0.1], material: rubber}]\n";
    static const int32_t methods[2] = {SE3D_METHOD_CONVEX, SE3D_METHOD_RADAU};
    for (int k = 0; k < 2; ++k) {
        se3d_model *model = NULL;
        se3d_model_error error = {0};
        se3d_snapshot *snapshot = NULL;
        se3d_solver *solver = NULL;
        se3d_shape shape;
        double velocity[3], spin[3];
        uint64_t hash[2];
        CHECK(se3d_model_read_text(text, strlen(text), "m", NULL, &model, &error) == SE3D_OK);
        se3d_system *system = se3d_model_get_system(model);
        CHECK(se3d_shape_find(system, "belt", &shape) == SE3D_OK);
        CHECK(se3d_shape_get_surface_motion(system, shape, velocity, spin) == SE3D_OK);
        CHECK_NEAR(velocity[0], 1.0, 0.0);
        CHECK_NEAR(spin[2], 0.5, 0.0);
        se3d_solver_def def = se3d_solver_def_default();
        def.method = methods[k];
        def.step = k ? 0.0 : 1e-3;
        CHECK(se3d_solver_create(system, &def, &solver) == SE3D_OK);
        CHECK(se3d_solver_run(solver, 0.1) == SE3D_OK);
        CHECK(se3d_snapshot_create(system, &snapshot) == SE3D_OK);
        for (int again = 0; again < 2; ++again) {
            CHECK(se3d_solver_run(solver, 0.2) == SE3D_OK);
            hash[again] = se3d_system_hash(system);
            CHECK(se3d_snapshot_restore(snapshot, system) == SE3D_OK);
        }
        CHECK(hash[0] == hash[1]);
        se3d_snapshot_destroy(snapshot);
        se3d_solver_destroy(solver);
        se3d_model_destroy(model);
    }
}

/* Particles touch walls: a ball that a belt accelerates rolls off with 2/7 of its speed; when the
 * belt stands still again, it is brought to 2/7 of what it would lack. */
static void a_belt_carries_particles(void)
{
    const double u = 0.7, r = 0.01, motion[3] = {u, 0.0, 0.0};
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.5, 1e4);
    se3d_shape shape = belt(&s, motion, no_motion);
    se3d_particles_def def = se3d_particles_def_default();
    se3d_particles *set = NULL;
    const double at[3] = {0.0, 0.0, r};
    double v[3];
    CHECK(se3d_particles_create(s.system, &def, &set) == SE3D_OK);
    CHECK(se3d_particles_add(set, s.material, 1, at, &r, NULL, NULL, NULL) == SE3D_OK);
    scene_solve(&s, SE3D_METHOD_VERLET, SE3D_FORMULATION_ROMEGA, 0.0, 0.0);
    CHECK(scene_run(&s, 0.2));
    CHECK(se3d_particles_get_all(set, 1, NULL, v, NULL) == SE3D_OK);
    CHECK_NEAR(v[0], 2.0 / 7.0 * u, 2e-3 * u);
    CHECK(se3d_shape_set_surface_motion(s.system, shape, no_motion, no_motion) == SE3D_OK);
    CHECK(scene_run(&s, 0.4));
    CHECK(se3d_particles_get_all(set, 1, NULL, v, NULL) == SE3D_OK);
    CHECK_NEAR(v[0], 0.0, 2e-3 * u);
    scene_end(&s);
}

/* A ball that comes straight to a plane, at a place beside the origin of that. */
typedef struct impact {
    double normal[3];          /* unit */
    double motion[3], spin[3]; /* of the surface */
    double friction;
} impact;

static se3d_shape plane_of(scene *s, const impact *i)
{
    se3d_shape_def def = scene_shape(s, scene_ground(s));
    se3d_shape shape;
    const double *n = i->normal, h = sqrt(0.5 * (1.0 + n[2]));
    const double p[4] = {h, -0.5 * n[1] / h, 0.5 * n[0] / h, 0.0}; /* z to the normal */
    memcpy(def.orientation, p, sizeof p);
    memcpy(def.surface_velocity, i->motion, sizeof def.surface_velocity);
    memcpy(def.surface_spin, i->spin, sizeof def.surface_spin);
    CHECK(se3d_shape_create_plane(s->system, &def, &shape) == SE3D_OK);
    return shape;
}

/* The velocity after it, of a particle or of a body with a sphere. */
static void rebound(const impact *i, int is_particle, double v[3])
{
    const double r = 0.01, mass = 4.0 / 3.0 * PI * r * r * r * 1000.0, *n = i->normal;
    const double aside[3] = {0.3 * n[2], 0.4, -0.3 * n[0]}; /* n has no y */
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, i->friction, 0.5, 1e4);
    se3d_body ball = {0, 0};
    se3d_particles *set = NULL;
    double at[3], v0[3];
    for (int k = 0; k < 3; ++k) {
        at[k] = aside[k] + 1.1 * r * n[k];
        v0[k] = -n[k];
    }
    CHECK(se3d_system_set_gravity(s.system, scene_zero) == SE3D_OK);
    (void)plane_of(&s, i);
    if (is_particle) {
        const se3d_particles_def def = se3d_particles_def_default();
        CHECK(se3d_particles_create(s.system, &def, &set) == SE3D_OK);
        CHECK(se3d_particles_add(set, s.material, 1, at, &r, v0, NULL, NULL) == SE3D_OK);
    } else {
        ball = scene_ball(&s, r, mass, at, v0);
    }
    scene_solve(&s, SE3D_METHOD_VERLET, SE3D_FORMULATION_ROMEGA, 1e-5, 0.0);
    CHECK(scene_run(&s, 0.01));
    CHECK((is_particle ? se3d_particles_get_all(set, 1, NULL, v, NULL)
                       : se3d_body_get_velocity(s.system, ball, v)) == SE3D_OK);
    scene_end(&s);
}

/* The end of a belt, a slope of one, and a roller. What the surface has along the normal is not
 * felt: without friction it is as at rest, restitution 0.5. */
static void particles_and_bodies_feel_of_a_surface_what_is_tangential(void)
{
    static const impact impacts[] = {
        {{-1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.5},
        {{-1.0, 0.0, 0.0}, {-0.9, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.5},
        {{-0.6, 0.0, 0.8}, {1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.0},
        {{-0.6, 0.0, 0.8}, {1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.4},
        {{0.6, 0.0, 0.8}, {0.5, -0.2, 0.3}, {3.0, 1.0, -2.0}, 0.4},
    };
    for (size_t k = 0; k < sizeof impacts / sizeof *impacts; ++k) {
        const double *n = impacts[k].normal;
        double v[2][3];
        rebound(&impacts[k], 0, v[0]);
        rebound(&impacts[k], 1, v[1]);
        CHECK_NEAR(v[1][0] * n[0] + v[1][2] * n[2], 0.5, 2e-3);
        for (int a = 0; a < 3; ++a) {
            CHECK_NEAR(v[1][a], v[0][a], 3e-3);
        }
    }
}

/* A ball that stands where a turntable turns is turned by torsional friction alone, with a constant
 * moment, up to the table's rate: half of the work of the drive is lost. */
static void a_turntable_gives_work_by_torsional_friction(void)
{
    const double w = 4.0, r = 0.05, m = 1.0, spin[3] = {0.0, 0.0, w}, stiffness = 1e5;
    for (size_t k = 1; k < WAYS; ++k) { /* convex has no such friction */
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.2, stiffness);
        const double at[3] = {0.0, 0.0, r - m * G / (2.0 * stiffness)}, J = 0.4 * m * r * r;
        double turn[3];
        se3d_work work;
        se3d_material_def stuff = scene_stuff(0.5, 0.2, stiffness);
        stuff.torsional_friction = 0.1;
        CHECK(se3d_material_set(s.system, s.material, &stuff) == SE3D_OK);
        (void)belt(&s, no_motion, spin);
        se3d_body ball = scene_ball(&s, r, m, at, scene_zero);
        solve(&s, &ways[k]);
        CHECK(scene_run(&s, 1.0));
        CHECK(se3d_body_get_angular_velocity(s.system, ball, turn) == SE3D_OK);
        CHECK(se3d_system_get_work(s.system, &work) == SE3D_OK);
        CHECK_NEAR(turn[2], w, 5e-3 * w);
        CHECK_NEAR(work.actuators, J * w * w, 0.02 * J * w * w);
        CHECK_NEAR(work.dissipated, 0.5 * J * w * w, 0.02 * J * w * w);
        scene_end(&s);
    }
}

int main(void)
{
    RUN(a_belt_carries_particles);
    RUN(particles_and_bodies_feel_of_a_surface_what_is_tangential);
    RUN(a_box_slides_on_a_belt_and_then_goes_with_it);
    RUN(a_box_on_a_turntable_stays_on_its_circle);
    RUN(a_ball_on_a_turntable_rolls_in_circles);
    RUN(a_ball_on_a_turntable_comes_back);
    RUN(a_box_lies_on_rollers_that_turn);
    RUN(a_box_stays_where_a_surface_that_moves_and_turns_is_at_rest);
    RUN(a_turntable_gives_work_by_torsional_friction);
    RUN(a_belt_of_a_file_goes_on_from_a_snapshot);
    return check_finish();
}
