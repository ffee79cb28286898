/* SPDX-License-Identifier: BSD-3-Clause */
/* Assembly: from rough poses to consistent positions, velocities and accelerations; what cannot be
 * met is named with its gap. */
#include "support/mechanisms.h"

#define LOOPS 5

/* Five loops of four links, 20 bodies: each loop stands on the ground and on the last link of the
 * loop before it. */
static world create_loops(void)
{
    world w = world_create();
    static const double corner[5][2] = {{0.0, 0.0}, {0.2, 1.0}, {1.0, 1.6}, {1.9, 1.0}, {2.0, 0.0}};
    se3d_body base = w.ground;
    for (int loop = 0; loop < LOOPS; ++loop) {
        se3d_body before = base;
        double x0 = 2.0 * loop;
        for (int k = 0; k < 4; ++k) {
            char name[16];
            const double from[2] = {x0 + corner[k][0], corner[k][1]};
            double dx = corner[k + 1][0] - corner[k][0];
            double dy = corner[k + 1][1] - corner[k][1];
            snprintf(name, sizeof name, "link%d%d", loop, k);
            se3d_body link = add_bar(&w, name, from, atan2(dy, dx), hypot(dx, dy), 1.0 + k);
            snprintf(name, sizeof name, "pin%d%d", loop, k);
            add_pin(&w, name, before, link, from[0], from[1]);
            before = link;
        }
        char name[16];
        snprintf(name, sizeof name, "foot%d", loop);
        add_pin(&w, name, w.ground, before, x0 + 2.0, 0.0);
        base = before;
    }
    return w;
}

/* Move every body that is not held by up to `amount` m and rad, each its own way. */
static void scatter(const world *w, double amount)
{
    uint64_t seed = 20240817;
    for (size_t k = 1; k < se3d_system_count_bodies(w->system); ++k) {
        se3d_body body;
        int32_t held;
        double r[3], p[4], length = 0.0;
        MUST(w, se3d_system_get_body(w->system, k, &body));
        MUST(w, se3d_body_get_held(w->system, body, &held));
        MUST(w, se3d_body_get_position(w->system, body, r));
        MUST(w, se3d_body_get_orientation(w->system, body, p));
        for (int c = 0; c < 3; ++c) {
            r[c] += amount * check_random(&seed);
        }
        for (int c = 0; c < 4; ++c) {
            p[c] += 0.5 * amount * check_random(&seed);
            length += p[c] * p[c];
        }
        for (int c = 0; c < 4; ++c) {
            p[c] /= sqrt(length);
        }
        if (!held) {
            MUST(w, se3d_body_set_position(w->system, body, r));
            MUST(w, se3d_body_set_orientation(w->system, body, p));
        }
    }
}

static uint64_t count_iterations(const world *w)
{
    se3d_solver_stats stats = {0};
    MUST(w, se3d_solver_get_stats(w->solver, &stats));
    return stats.iterations;
}

static void twenty_scattered_bodies_assemble_in_a_handful_of_steps(void)
{
    for (int f = 0; f < 2; ++f) {
        world w = create_loops();
        double violation[3];
        CHECK(se3d_system_count_bodies(w.system) == 21);
        scatter(&w, 0.1);
        MUST(&w, se3d_system_get_violation(w.system, violation));
        CHECK(violation[0] > 0.1);
        use_solver(&w, SE3D_ANALYSIS_ASSEMBLY, (se3d_formulation)f);
        CHECK(se3d_solver_run(w.solver, 0.0) == SE3D_INFO_REDUNDANT);
        CHECK(count_iterations(&w) <= 8);
        MUST(&w, se3d_system_get_violation(w.system, violation));
        CHECK_NEAR(violation[0], 0.0, 1e-12);
        CHECK_NEAR(violation[1], 0.0, 1e-12);
        CHECK_NEAR(violation[2], 0.0, 1e-9);
        world_destroy(&w);
    }
}

static void poses_that_fit_stay_where_they_are(void)
{
    world w = create_loops();
    se3d_body link;
    double before[3], after[3];
    MUST(&w, se3d_body_find(w.system, "link32", &link));
    MUST(&w, se3d_body_get_position(w.system, link, before));
    use_solver(&w, SE3D_ANALYSIS_ASSEMBLY, SE3D_FORMULATION_ROMEGA);
    MUST(&w, se3d_solver_run(w.solver, 0.0));
    MUST(&w, se3d_body_get_position(w.system, link, after));
    for (int c = 0; c < 3; ++c) {
        CHECK_NEAR(after[c], before[c], 1e-14);
    }
    world_destroy(&w);
}

/* The crank's pose and speed are given: the others follow. */
static void held_bodies_keep_their_pose_and_velocity(void)
{
    for (int f = 0; f < 2; ++f) {
        world w = create_windows(1, se3d_joint_create_revolute);
        se3d_body crank, beam, other;
        const double zero[3] = {0.0, 0.0, 0.0};
        const double spin[3] = {0.0, 0.0, -3.0};
        const double velocity[3] = {1.5, 0.0, 0.0};
        double r[3], v[3], omega[3], violation[3];
        int32_t held = -1;
        MUST(&w, se3d_body_find(w.system, "post0", &crank));
        MUST(&w, se3d_body_find(w.system, "post1", &other));
        MUST(&w, se3d_body_find(w.system, "beam0", &beam));
        MUST(&w, se3d_body_get_held(w.system, crank, &held));
        CHECK(held == 0);
        MUST(&w, se3d_body_set_held(w.system, crank, 7));
        MUST(&w, se3d_body_get_held(w.system, crank, &held));
        CHECK(held == 1);
        scatter(&w, 0.1);
        MUST(&w, se3d_body_set_velocity(w.system, crank, velocity));
        MUST(&w, se3d_body_set_angular_velocity(w.system, crank, spin));
        MUST(&w, se3d_body_set_velocity(w.system, beam, zero));
        MUST(&w, se3d_body_set_velocity(w.system, other, zero));
        MUST(&w, se3d_body_set_angular_velocity(w.system, other, zero));
        use_solver(&w, SE3D_ANALYSIS_ASSEMBLY, (se3d_formulation)f);
        MUST(&w, se3d_solver_run(w.solver, 0.0));
        MUST(&w, se3d_body_get_position(w.system, crank, r));
        CHECK(r[0] == 0.5 * cos(0.5 * PI) && r[1] == 0.5 && r[2] == 0.0);
        MUST(&w, se3d_body_get_angular_velocity(w.system, crank, omega));
        CHECK_NEAR(omega[2], -3.0, 1e-14);
        MUST(&w, se3d_body_get_velocity(w.system, crank, v));
        CHECK_NEAR(v[0], 1.5, 1e-14);
        MUST(&w, se3d_body_get_velocity(w.system, beam, v)); /* the parallelogram's */
        CHECK_NEAR(v[0], 3.0, 1e-12);
        CHECK_NEAR(v[1], 0.0, 1e-12);
        MUST(&w, se3d_body_get_angular_velocity(w.system, other, omega));
        CHECK_NEAR(omega[2], -3.0, 1e-12);
        MUST(&w, se3d_body_get_position(w.system, beam, r));
        CHECK_NEAR(r[0], 0.5, 1e-12);
        CHECK_NEAR(r[1], 1.0, 1e-12);
        MUST(&w, se3d_system_get_violation(w.system, violation));
        CHECK_NEAR(violation[0] + violation[1], 0.0, 1e-12);
        CHECK_NEAR(violation[2], 0.0, 1e-9);
        world_destroy(&w);
    }
}

static void two_held_bodies_that_do_not_fit_are_not_moved(void)
{
    world w = create_windows(1, se3d_joint_create_revolute);
    se3d_body body;
    const double r[3] = {0.7, 1.0, 0.0};
    double after[3];
    MUST(&w, se3d_body_find(w.system, "post0", &body));
    MUST(&w, se3d_body_set_held(w.system, body, 1));
    MUST(&w, se3d_body_find(w.system, "beam0", &body));
    MUST(&w, se3d_body_set_held(w.system, body, 1));
    MUST(&w, se3d_body_set_position(w.system, body, r));
    use_solver(&w, SE3D_ANALYSIS_ASSEMBLY, SE3D_FORMULATION_ROMEGA);
    CHECK(se3d_solver_run(w.solver, 0.0) == SE3D_ERR_INCONSISTENT);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "B0 0.2 m");
    MUST(&w, se3d_body_get_position(w.system, body, after));
    CHECK(memcmp(r, after, sizeof r) == 0);
    world_destroy(&w);
}

/* A four-bar with `length` of the coupler; ground 4 m, crank and rocker 1 m. */
static world create_short(double length)
{
    world w = world_create();
    const double O[2] = {0.0, 0.0}, A[2] = {0.9, 0.4}, Q[2] = {4.0, 0.0};
    const double ground_end[3] = {4.0, 0.0, 0.0};
    const double end[3] = {0.5, 0.0, 0.0}, begin[3] = {-0.5, 0.0, 0.0};
    const double front[3] = {-0.5 * length, 0.0, 0.0}, back[3] = {0.5 * length, 0.0, 0.0};
    se3d_body crank = add_bar(&w, "crank", O, 0.5, 1.0, 1.0);
    se3d_body coupler = add_bar(&w, "coupler", A, 0.1, length, 1.0);
    se3d_body rocker = add_bar(&w, "rocker", Q, 2.6, 1.0, 1.0);
    add_pin(&w, "O", w.ground, crank, 0.0, 0.0);
    add_local(&w, se3d_joint_create_revolute, "A", crank, end, coupler, front);
    add_local(&w, se3d_joint_create_revolute, "B", coupler, back, rocker, end);
    add_local(&w, se3d_joint_create_revolute, "Q", w.ground, ground_end, rocker, begin);
    return w;
}

static void a_bar_that_is_too_short_is_told_with_the_gap(void)
{
    for (int f = 0; f < 2; ++f) {
        world w = create_short(1.5);
        se3d_body crank;
        double before[3], after[3];
        MUST(&w, se3d_body_find(w.system, "crank", &crank));
        MUST(&w, se3d_body_get_position(w.system, crank, before));
        use_solver(&w, SE3D_ANALYSIS_ASSEMBLY, (se3d_formulation)f);
        CHECK(se3d_solver_run(w.solver, 0.0) == SE3D_ERR_INCONSISTENT);
        const char *text = se3d_system_get_error(w.system);
        const char *gap = strstr(text, "open by ");
        CHECK_CONTAINS(text, "cannot be met");
        CHECK_CONTAINS(text, "A 0.12");
        CHECK_CONTAINS(text, "B 0.12");
        CHECK_NEAR(gap ? strtod(gap + 8, NULL) : 0.0, 0.5, 1e-4);
        MUST(&w, se3d_body_get_position(w.system, crank, after)); /* as before */
        CHECK(memcmp(before, after, sizeof before) == 0);
        world_destroy(&w);
    }
}

/* The same guess with a coupler that reaches is no error. */
static void a_bar_that_is_long_enough_assembles_from_the_same_guess(void)
{
    for (int f = 0; f < 2; ++f) {
        world w = create_short(2.5);
        double violation[3];
        use_solver(&w, SE3D_ANALYSIS_ASSEMBLY, (se3d_formulation)f);
        CHECK(se3d_solver_run(w.solver, 0.0) == SE3D_INFO_REDUNDANT);
        MUST(&w, se3d_system_get_violation(w.system, violation));
        CHECK_NEAR(violation[0], 0.0, 1e-12);
        world_destroy(&w);
    }
}

/* Hinges off by more than the digits of data are a contradiction, not a poor guess. */
static void a_small_contradiction_is_not_taken_for_a_poor_guess(void)
{
    const double from[2] = {0.0, 0.0};
    const double up[3] = {0.0, 0.0, 1.0}, high[3] = {-0.5, 0.0, 1.0002};
    world w = world_create();
    se3d_body door = add_bar(&w, "door", from, 0.0, 1.0, 1.0);
    add_pin(&w, "low", w.ground, door, 0.0, 0.0);
    add_local(&w, se3d_joint_create_revolute, "high", w.ground, up, door, high);
    use_solver(&w, SE3D_ANALYSIS_ASSEMBLY, SE3D_FORMULATION_ROMEGA);
    CHECK(se3d_solver_run(w.solver, 0.0) == SE3D_ERR_INCONSISTENT);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "open by 0.0002 m");
    world_destroy(&w);
}

/* A slider driven beyond the reach of its rod. */
static void a_driver_that_locks_is_named_with_its_time(void)
{
    for (int f = 0; f < 2; ++f) {
        world w = world_create();
        const double O[2] = {0.0, 0.0}, C[2] = {0.6, 0.0};
        const double x[3] = {1.0, 0.0, 0.0}, at[3] = {0.0, 0.0, 0.0};
        se3d_body crank = add_bar(&w, "crank", O, 0.5 * PI, 0.2, 1.0);
        const double top[2] = {0.0, 0.2};
        se3d_body rod = add_bar(&w, "rod", top, -asin(0.4), 0.5, 2.0);
        se3d_body slider = add_bar(&w, "slider", C, 0.0, 0.2, 3.0);
        double reach = 0.5 * cos(asin(0.4));
        const double r[3] = {reach, 0.0, 0.0};
        MUST(&w, se3d_body_set_position(w.system, slider, r));
        add_pin(&w, "O", w.ground, crank, 0.0, 0.0);
        add_pin(&w, "A", crank, rod, 0.0, 0.2);
        add_pin(&w, "C", rod, slider, reach, 0.0);
        se3d_constraint guide =
            add_joint(&w, se3d_joint_create_prismatic, "guide", w.ground, slider, at, x);
        double s, rate, acceleration;
        MUST(&w, se3d_joint_get_coordinate(w.system, guide, SE3D_JOINT_COORDINATE_DISPLACEMENT, &s,
                                           &rate, &acceleration));
        char text[64];
        snprintf(text, sizeof text, "%.17g + 0.5*t", s);
        add_driver(&w, "push", guide, SE3D_JOINT_COORDINATE_DISPLACEMENT, text);
        use_solver(&w, SE3D_ANALYSIS_KINEMATICS, (se3d_formulation)f);
        double lock = (0.7 - reach) / 0.5; /* stretched: 0.483 s */
        CHECK(se3d_solver_run(w.solver, 0.98 * lock) == SE3D_INFO_REDUNDANT);
        se3d_status status = se3d_solver_run(w.solver, 1.2 * lock);
        CHECK(status == SE3D_ERR_INCONSISTENT || status == SE3D_ERR_NO_CONVERGENCE);
        CHECK_CONTAINS(se3d_system_get_error(w.system), "t = 0.4");
        CHECK_CONTAINS(se3d_system_get_error(w.system), "push");
        double now;
        MUST(&w, se3d_system_get_time(w.system, &now));
        CHECK(now >= 0.98 * lock && now <= lock);
        world_destroy(&w);
    }
}

static void misuse_of_holding_is_refused(void)
{
    world w = create_windows(1, se3d_joint_create_revolute);
    const se3d_body nobody = {0, 0};
    int32_t held = 5;
    CHECK(se3d_body_set_held(NULL, w.ground, 1) == SE3D_ERR_NULL);
    CHECK(se3d_body_set_held(w.system, nobody, 1) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_body_get_held(NULL, w.ground, &held) == SE3D_ERR_NULL);
    CHECK(se3d_body_get_held(w.system, w.ground, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_body_get_held(w.system, nobody, &held) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_body_set_held(w.system, w.ground, 1) == SE3D_OK);
    world_destroy(&w);
}

int main(void)
{
    RUN(twenty_scattered_bodies_assemble_in_a_handful_of_steps);
    RUN(poses_that_fit_stay_where_they_are);
    RUN(held_bodies_keep_their_pose_and_velocity);
    RUN(two_held_bodies_that_do_not_fit_are_not_moved);
    RUN(a_bar_that_is_too_short_is_told_with_the_gap);
    RUN(a_bar_that_is_long_enough_assembles_from_the_same_guess);
    RUN(a_small_contradiction_is_not_taken_for_a_poor_guess);
    RUN(a_driver_that_locks_is_named_with_its_time);
    RUN(misuse_of_holding_is_refused);
    return check_finish();
}
