/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact between bodies: what is conserved, what is left alone, and that runs repeat themselves.
 */
#include "math/quaternion.h"
#include "support/counting.h"
#include "support/scene.h"

static scene begin_with(const se3d_allocator *allocator, double restitution, double stiffness)
{
    se3d_material_def stuff = scene_stuff(0.4, restitution, stiffness);
    stuff.rolling_friction = 0.01;
    return scene_begin_with(allocator, SE3D_CONTACT_LAW_HOOKE, &stuff);
}

static scene begin(const se3d_allocator *allocator, double restitution)
{
    return begin_with(allocator, restitution, 1e5);
}

static se3d_body box(scene *s, const double size[3], double mass, const double r[3],
                     const double p[4])
{
    se3d_body body = scene_box(s, size, mass, r, scene_zero);
    CHECK(se3d_body_set_orientation(s->system, body, p) == SE3D_OK);
    return body;
}

static const double cube[3] = {0.2, 0.3, 0.25};
static const double leaning[4] = {0.88, 0.3, 0.35, 0.1}; /* normalised by the body's creation */

static void normalised(const double p[4], double out[4])
{
    double n = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);
    for (int k = 0; k < 4; ++k) {
        out[k] = p[k] / n;
    }
}

/* Dropped on a corner it tumbles and comes to rest; what is lost is accounted for. */
static void energy_of_a_falling_box_is_accounted_for(void)
{
    for (int k = 0; k < 2; ++k) {
        scene w = begin(NULL, 0.4);
        const double r[3] = {0.0, 0.0, 0.4};
        double p[4], v[3];
        se3d_energy before, after;
        normalised(leaning, p);
        se3d_body body = box(&w, cube, 3.0, r, p);
        scene_floor(&w, 0.0);
        scene_solve(&w, SE3D_METHOD_DOP853, k ? SE3D_FORMULATION_RP : SE3D_FORMULATION_ROMEGA, 0.0,
                    1e-7);
        CHECK(se3d_system_get_energy(w.system, &before) == SE3D_OK);
        double lost = 0.0;
        for (int step = 1; step <= 15; ++step) {
            scene_run(&w, 0.1 * step);
            CHECK(se3d_system_get_energy(w.system, &after) == SE3D_OK);
            CHECK_NEAR(after.total + after.dissipated, before.total, 1e-4 * before.total);
            CHECK(after.dissipated > lost - 1e-5 * before.total);
            lost = after.dissipated;
        }
        CHECK(lost > 0.3 * before.total);
        CHECK(se3d_body_get_velocity(w.system, body, v) == SE3D_OK);
        CHECK(fabs(v[2]) < 0.05);
        scene_end(&w);
    }
}

/* Two boxes that meet in free space: momentum and angular momentum stay to rounding. */
static void momentum_of_colliding_boxes_is_kept(void)
{
    scene w = begin(NULL, 0.7);
    const double none[3] = {0.0, 0.0, 0.0}, a[3] = {0.0, 0.0, 0.0}, b[3] = {0.5, 0.05, 0.08};
    const double v[3] = {-1.5, 0.1, 0.0}, spin[3] = {1.0, -2.0, 0.5};
    const double straight[4] = {1.0, 0.0, 0.0, 0.0};
    double p[4], first[6] = {0.0}, now[6];
    normalised(leaning, p);
    CHECK(se3d_system_set_gravity(w.system, none) == SE3D_OK);
    se3d_body bodies[2] = {box(&w, cube, 3.0, a, straight), box(&w, cube, 1.0, b, p)};
    CHECK(se3d_body_set_velocity(w.system, bodies[1], v) == SE3D_OK);
    CHECK(se3d_body_set_angular_velocity(w.system, bodies[1], spin) == SE3D_OK);
    scene_solve(&w, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, 1e-9);
    for (int step = 0; step < 5; ++step) {
        scene_run(&w, 0.1 * step);
        memset(now, 0, sizeof now);
        for (int k = 0; k < 2; ++k) {
            const double mass = k ? 1.0 : 3.0;
            double r[3], u[3], omega[3], A[9];
            CHECK(se3d_body_get_position(w.system, bodies[k], r) == SE3D_OK);
            CHECK(se3d_body_get_velocity(w.system, bodies[k], u) == SE3D_OK);
            CHECK(se3d_body_get_angular_velocity(w.system, bodies[k], omega) == SE3D_OK);
            CHECK(se3d_body_get_orientation(w.system, bodies[k], p) == SE3D_OK);
            se3di_quat_to_matrix(p, A);
            double L[3];
            for (int c = 0; c < 3; ++c) {
                double s = cube[(c + 1) % 3], t = cube[(c + 2) % 3];
                L[c] = mass * (s * s + t * t) / 12.0 * omega[c];
            }
            for (int c = 0; c < 3; ++c) {
                int i = (c + 1) % 3, j = (c + 2) % 3;
                now[c] += mass * u[c];
                now[3 + c] += mass * (r[i] * u[j] - r[j] * u[i]) + A[3 * c] * L[0] +
                              A[3 * c + 1] * L[1] + A[3 * c + 2] * L[2];
            }
        }
        for (int c = 0; c < 6; ++c) {
            first[c] = step == 0 ? now[c] : first[c];
            CHECK_NEAR(now[c], first[c], 1e-9);
        }
    }
    double u[3];
    CHECK(se3d_body_get_velocity(w.system, bodies[0], u) == SE3D_OK);
    CHECK(u[0] < -0.1); /* they did meet */
    scene_end(&w);
}

/* A narrow block set on one edge rocks, and rests flat in the end. */
static void a_rocking_block_comes_to_rest(void)
{
    scene w = begin(NULL, 0.3);
    const double size[3] = {0.1, 0.2, 0.4};
    const double angle = 0.15;
    const double p[4] = {cos(0.5 * angle), 0.0, sin(0.5 * angle), 0.0};
    const double r[3] = {0.0, 0.0, 0.2 * cos(angle) + 0.05 * sin(angle) - 1e-5};
    double q[4], wrench[6];
    se3d_body body = box(&w, size, 2.0, r, p);
    scene_floor(&w, 0.0);
    scene_solve(&w, SE3D_METHOD_GENERALIZED_ALPHA, SE3D_FORMULATION_ROMEGA, 5e-4, 1e-6);
    scene_run(&w, 0.1);
    CHECK(se3d_body_get_angular_velocity(w.system, body, q) == SE3D_OK);
    CHECK(q[1] < -0.05); /* falling back */
    scene_run(&w, 4.0);
    CHECK(se3d_body_get_orientation(w.system, body, q) == SE3D_OK);
    CHECK_NEAR(q[2], 0.0, 1e-5); /* it stands strained */
    CHECK(se3d_body_get_contact_wrench(w.system, body, wrench, wrench + 3) == SE3D_OK);
    CHECK_NEAR(wrench[2], 2.0 * G, 1e-3);
    CHECK(se3d_system_count_contacts(w.system) == 4);
    scene_end(&w);
}

/* The same on its way to the other edge, over whose landing its corners share the load anew: place
 * and velocities of the body. */
static void rock(int32_t method, double tolerance, double at[6])
{
    scene w = begin(NULL, 0.5);
    const double size[3] = {0.1, 0.2, 0.4}, angle = 0.15;
    const double p[4] = {cos(0.5 * angle), 0.0, sin(0.5 * angle), 0.0};
    const double r[3] = {0.0, 0.0, 0.2 * cos(angle) + 0.05 * sin(angle) - 1e-5};
    double v[3], spin[3], x[3];
    se3d_body body = box(&w, size, 2.0, r, p);
    scene_floor(&w, 0.0);
    scene_solve(&w, method, SE3D_FORMULATION_ROMEGA, 0.0, tolerance);
    scene_run(&w, 0.2);
    CHECK(se3d_body_get_position(w.system, body, x) == SE3D_OK);
    CHECK(se3d_body_get_velocity(w.system, body, v) == SE3D_OK);
    CHECK(se3d_body_get_angular_velocity(w.system, body, spin) == SE3D_OK);
    const double all[6] = {x[0], x[1], x[2], v[0], v[2], spin[1]};
    memcpy(at, all, sizeof all);
    scene_end(&w);
}

static void implicit_methods_rock_a_block_as_exactly_as_was_asked_for(void)
{
    static const struct {
        int32_t method;
        double tolerance, place, speed;
    } cases[] = {
        {SE3D_METHOD_RADAU, 1e-7, 2e-8, 1e-5},
        {SE3D_METHOD_BDF, 1e-6, 1e-7, 1e-5},
        {SE3D_METHOD_BDF, 1e-7, 1e-8, 1e-6},
    };
    double truth[6], at[6];
    rock(SE3D_METHOD_DOP853, 1e-9, truth);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        rock(cases[k].method, cases[k].tolerance, at);
        for (int i = 0; i < 6; ++i) {
            CHECK_NEAR(at[i], truth[i], i < 3 ? cases[k].place : cases[k].speed);
        }
    }
}

/* A leg that slides in a guide, sprung against the airframe, with a ball for a foot. */
static se3d_body landing_gear(scene *w, se3d_body *frame)
{
    const double size[3] = {1.0, 1.0, 0.2}, r[3] = {0.0, 0.0, 1.3};
    const double straight[4] = {1.0, 0.0, 0.0, 0.0}, sink[3] = {0.0, 0.0, -1.5};
    se3d_body_def def = se3d_body_def_default();
    se3d_body leg;
    *frame = box(w, size, 100.0, r, straight);
    def.mass = 5.0;
    def.inertia[0] = def.inertia[1] = def.inertia[2] = 0.3;
    def.position[2] = 0.5;
    CHECK(se3d_body_create(w->system, &def, &leg) == SE3D_OK);
    CHECK(se3d_body_set_velocity(w->system, leg, sink) == SE3D_OK);
    CHECK(se3d_body_set_velocity(w->system, *frame, sink) == SE3D_OK);
    se3d_shape_def foot = se3d_shape_def_default();
    se3d_shape shape;
    foot.body = leg;
    foot.material = w->material;
    foot.radius = 0.15;
    foot.position[2] = -0.3;
    CHECK(se3d_shape_create_sphere(w->system, &foot, &shape) == SE3D_OK);
    se3d_joint_def guide = se3d_joint_def_default();
    se3d_constraint joint;
    guide.body_i = *frame;
    guide.body_j = leg;
    guide.axis_i[2] = guide.axis_j[2] = 1.0;
    guide.ref_i[0] = guide.ref_j[0] = 1.0;
    CHECK(se3d_joint_create_prismatic(w->system, &guide, &joint) == SE3D_OK);
    se3d_tsda_def spring = se3d_tsda_def_default();
    se3d_force force;
    spring.body_i = *frame;
    spring.body_j = leg;
    spring.k = 2e4;
    spring.c = 2e3;
    spring.l0 = 0.8;
    CHECK(se3d_force_create_tsda(w->system, &spring, &force) == SE3D_OK);
    return leg;
}

/* Lands, and in the end carries its weight; every implicit method, and both formulations, agree. */
static void a_landing_gear_carries_its_weight(void)
{
    static const int32_t methods[4] = {SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_HHT,
                                       SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_DOP853};
    double heights[4];
    for (int k = 0; k < 4; ++k) {
        scene w = begin_with(NULL, 0.5, 2e6);
        se3d_body frame;
        double r[3], force[3], torque[3];
        se3d_body leg = landing_gear(&w, &frame);
        scene_floor(&w, 0.0);
        int rp = k == 1 || k == 2;
        scene_solve(&w, methods[k], rp ? SE3D_FORMULATION_RP : SE3D_FORMULATION_ROMEGA,
                    k == 3 ? 0.0 : 5e-4, 1e-6);
        scene_run(&w, 0.3);
        CHECK(se3d_body_get_position(w.system, frame, r) == SE3D_OK);
        heights[k] = r[2];
        scene_run(&w, 3.0);
        CHECK(se3d_body_get_contact_wrench(w.system, leg, force, torque) == SE3D_OK);
        CHECK_NEAR(force[2], 105.0 * G, 1.0);
        CHECK(se3d_body_get_contact_wrench(w.system, frame, force, torque) == SE3D_OK);
        CHECK(!(fabs(force[2]) > 0.0)); /* its own leg does not touch it */
        scene_end(&w);
        CHECK_NEAR(heights[k], heights[0], 1e-4);
    }
}

/* Shapes of jointed bodies may overlap; the same bodies without the joint do not stay there. */
static void jointed_bodies_do_not_touch(void)
{
    for (int jointed = 0; jointed < 2; ++jointed) {
        scene w = begin(NULL, 0.5);
        const double none[3] = {0.0, 0.0, 0.0}, a[3] = {0.0, 0.0, 0.0}, b[3] = {0.19, 0.0, 0.0};
        const double straight[4] = {1.0, 0.0, 0.0, 0.0};
        double v[3];
        CHECK(se3d_system_set_gravity(w.system, none) == SE3D_OK);
        se3d_body one = box(&w, cube, 1.0, a, straight), two = box(&w, cube, 1.0, b, straight);
        se3d_joint_def def = se3d_joint_def_default();
        se3d_constraint joint;
        def.body_i = one;
        def.body_j = two;
        def.point_i[0] = 0.095;
        def.point_j[0] = -0.095;
        def.axis_i[2] = def.axis_j[2] = 1.0;
        def.ref_i[0] = def.ref_j[0] = 1.0;
        if (jointed) {
            CHECK(se3d_joint_create_revolute(w.system, &def, &joint) == SE3D_OK);
        }
        scene_solve(&w, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, 1e-6);
        scene_run(&w, 0.05);
        CHECK(se3d_body_get_velocity(w.system, two, v) == SE3D_OK);
        CHECK((v[0] > 0.1) == !jointed);
        scene_end(&w);
    }
}

/* A snapshot in the middle of a tumble and a clone go on with the same bits. */
static void runs_repeat_from_snapshots_and_clones(void)
{
    static const int32_t methods[2] = {SE3D_METHOD_DOP853, SE3D_METHOD_GENERALIZED_ALPHA};
    for (int k = 0; k < 2; ++k) {
        scene w = begin(NULL, 0.4);
        const double r[3] = {0.0, 0.0, 0.3};
        double p[4];
        normalised(leaning, p);
        box(&w, cube, 3.0, r, p);
        scene_floor(&w, 0.0);
        scene_solve(&w, methods[k], SE3D_FORMULATION_ROMEGA, k ? 5e-4 : 0.0, 1e-6);
        scene_run(&w, 0.4);
        CHECK(se3d_system_count_contacts(w.system) > 0);
        se3d_snapshot *snapshot = NULL;
        scene copy = {0};
        CHECK(se3d_snapshot_create(w.system, &snapshot) == SE3D_OK);
        CHECK(se3d_system_clone(w.system, &copy.system) == SE3D_OK);
        scene_solve(&copy, methods[k], SE3D_FORMULATION_ROMEGA, k ? 5e-4 : 0.0, 1e-6);
        scene_run(&w, 0.8);
        uint64_t hash = se3d_system_hash(w.system);
        CHECK(se3d_snapshot_restore(snapshot, w.system) == SE3D_OK);
        CHECK(se3d_system_hash(w.system) != hash);
        scene_run(&w, 0.8);
        CHECK(se3d_system_hash(w.system) == hash);
        scene_run(&copy, 0.8);
        CHECK(se3d_system_hash(copy.system) == hash);
        se3d_snapshot_destroy(snapshot);
        scene_end(&copy);
        scene_end(&w);
    }
}

/* At rest a step allocates nothing. */
static void steady_steps_allocate_nothing(void)
{
    support_counting counting = {0};
    const se3d_allocator allocator = support_counting_allocator(&counting);
    scene w = begin(&allocator, 0.4);
    const double r[3] = {0.0, 0.0, 0.125};
    const double straight[4] = {1.0, 0.0, 0.0, 0.0};
    box(&w, cube, 3.0, r, straight);
    scene_floor(&w, 0.0);
    scene_solve(&w, SE3D_METHOD_GENERALIZED_ALPHA, SE3D_FORMULATION_ROMEGA, 1e-3, 1e-6);
    scene_run(&w, 0.1);
    size_t before = counting.calls;
    scene_run(&w, 1.1);
    CHECK(counting.calls == before);
    scene_end(&w);
    CHECK(counting.live == 0);
}

/* Every allocation on the way to a tumble fails once: the failure is reported, or nothing. */
static void failed_allocations_are_reported(void)
{
    size_t k = 1;
    int reached = 1;
    for (; k < 300 && reached; ++k) {
        support_counting counting = {0};
        const se3d_allocator allocator = support_counting_allocator(&counting);
        scene w = begin(&allocator, 0.4);
        const double r[3] = {0.0, 0.0, 0.24};
        double p[4];
        normalised(leaning, p);
        box(&w, cube, 3.0, r, p);
        scene_floor(&w, 0.0);
        scene_solve(&w, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, 1e-4);
        counting.fail_at = counting.calls + k;
        se3d_status status = se3d_solver_run(w.solver, 0.3);
        reached = counting.failed > 0;
        CHECK(status == SE3D_ERR_NO_MEMORY || (status >= 0 && !reached));
        scene_end(&w);
        CHECK(counting.live == 0 && counting.wrong == 0);
    }
    CHECK(k > 10 && !reached);
}

/* If two shapes are far inside each other the run says which. */
static void too_large_overlaps_name_the_shapes(void)
{
    scene w = begin(NULL, 0.4);
    const double r[3] = {0.0, 0.0, 0.5}, fast[3] = {0.0, 0.0, -60.0};
    const double straight[4] = {1.0, 0.0, 0.0, 0.0};
    se3d_body body = box(&w, cube, 3.0, r, straight);
    CHECK(se3d_body_set_velocity(w.system, body, fast) == SE3D_OK);
    scene_floor(&w, 0.0);
    scene_solve(&w, SE3D_METHOD_GENERALIZED_ALPHA, SE3D_FORMULATION_ROMEGA, 1e-3, 1e-6);
    CHECK(se3d_solver_run(w.solver, 0.2) == SE3D_ERR_STEP_SIZE);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "floor");
    CHECK_CONTAINS(se3d_system_get_error(w.system), "overlap");
    scene_end(&w);
}

static se3d_status get_press(void *ctx, const se3d_system *system, double *value)
{
    double force[3], torque[3];
    const se3d_status status =
        se3d_body_get_contact_wrench(system, *(const se3d_body *)ctx, force, torque);
    *value = force[2];
    return status;
}

static se3d_status get_most(void *ctx, const se3d_system *system, double *value)
{
    (void)ctx;
    return se3d_system_get_contact_force_max(system, value);
}

/* Only the floor pushes the ball of 500 kg: m (a + g) is its force. */
static se3d_status get_push(void *ctx, const se3d_system *system, double *value)
{
    double a[3];
    const se3d_status status = se3d_body_get_acceleration(system, *(const se3d_body *)ctx, a);
    *value = 500.0 * (a[2] + G);
    return status;
}

static se3d_body ball_above_floor(scene *w)
{
    const double r[3] = {0.0, 0.0, 0.51}, v[3] = {0.0, 0.0, -1.0};
    scene_floor(w, 0.0);
    return scene_ball(w, 0.5, 500.0, r, v);
}

static void add_push_event(scene *w, se3d_event_value value, se3d_body *body)
{
    se3d_event_def def = se3d_event_def_default();
    se3d_event event;
    def.value = value;
    def.ctx = body;
    def.level = 2e4;
    CHECK(se3d_event_create(w->solver, &def, &event) == SE3D_OK);
}

/* The same three quantities; methods with dense output go back within their steps. */
static void forces_of_contacts_cross_levels(void)
{
    static const int32_t methods[] = {SE3D_METHOD_DOP853, SE3D_METHOD_RK4, SE3D_METHOD_RADAU,
                                      SE3D_METHOD_BDF, SE3D_METHOD_RATTLE};
    for (size_t k = 0; k < sizeof methods / sizeof methods[0]; ++k) {
        scene w = begin_with(NULL, 0.8, 1e6);
        se3d_body ball = ball_above_floor(&w);
        scene_solve(&w, methods[k], SE3D_FORMULATION_ROMEGA, 0.0, 1e-7);
        add_push_event(&w, get_press, &ball);
        add_push_event(&w, get_most, NULL);
        add_push_event(&w, get_push, &ball);
        CHECK(se3d_solver_run(w.solver, 0.15) >= 0);
        CHECK(se3d_solver_count_event_records(w.solver) == 6);
        for (size_t n = 0; n < 6 && n < se3d_solver_count_event_records(w.solver); ++n) {
            se3d_event_record record, last;
            CHECK(se3d_solver_get_event_record(w.solver, n, &record) == SE3D_OK);
            CHECK(se3d_solver_get_event_record(w.solver, n - n % 3, &last) == SE3D_OK);
            CHECK(record.direction == (n < 3 ? SE3D_EVENT_RISING : SE3D_EVENT_FALLING));
            CHECK_NEAR(record.time, last.time, 1e-12);
            CHECK_NEAR(record.value, 2e4, 1e-3);
        }
        scene_end(&w);
    }
}

int main(void)
{
    RUN(energy_of_a_falling_box_is_accounted_for);
    RUN(momentum_of_colliding_boxes_is_kept);
    RUN(a_rocking_block_comes_to_rest);
    RUN(implicit_methods_rock_a_block_as_exactly_as_was_asked_for);
    RUN(a_landing_gear_carries_its_weight);
    RUN(jointed_bodies_do_not_touch);
    RUN(runs_repeat_from_snapshots_and_clones);
    RUN(steady_steps_allocate_nothing);
    RUN(failed_allocations_are_reported);
    RUN(too_large_overlaps_name_the_shapes);
    RUN(forces_of_contacts_cross_levels);
    return check_finish();
}
