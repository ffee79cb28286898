/* SPDX-License-Identifier: BSD-3-Clause */
/* Reports on constraints: counts, ranks, names, contradictions; multipliers of least norm. */
#include "support/mechanisms.h"

#include "base/alloc.h"
#include "linsol/rank.h"

static se3d_check_summary summary;

/* The report of a system; the summary is a global. */
static se3d_check *check_world(const world *w, se3d_status expected)
{
    se3d_check *check = NULL;
    se3d_status status = se3d_check_create(w->system, &check);
    MUST(w, status);
    CHECK(status == expected);
    summary.struct_size = sizeof summary;
    MUST(w, se3d_check_get_summary(check, &summary));
    CHECK(summary.equations - summary.rank == summary.redundant);
    CHECK(6 * summary.bodies - summary.rank == summary.freedoms);
    CHECK(6 * (int64_t)summary.bodies - (int64_t)summary.equations == summary.gruebler);
    return check;
}

static int has_message(const se3d_check *check, const char *text)
{
    for (size_t k = 0; k < se3d_check_count_messages(check); ++k) {
        const char *message = NULL;
        if (se3d_check_get_message(check, k, &message) == SE3D_OK && strcmp(message, text) == 0) {
            return 1;
        }
    }
    return 0;
}

/* The first message with `part` in it, or "". */
static const char *find_message(const se3d_check *check, const char *part)
{
    for (size_t k = 0; k < se3d_check_count_messages(check); ++k) {
        const char *message = NULL;
        if (se3d_check_get_message(check, k, &message) == SE3D_OK && strstr(message, part)) {
            return message;
        }
    }
    return "";
}

static void an_empty_system_has_nothing_to_report(void)
{
    world w = world_create();
    se3d_check *check = check_world(&w, SE3D_OK);
    CHECK(summary.bodies == 0 && summary.equations == 0 && summary.rank == 0);
    CHECK(se3d_check_count_messages(check) == 0);
    se3d_check_destroy(check);
    world_destroy(&w);
}

static void a_pendulum_has_one_freedom_and_no_redundancy(void)
{
    const double from[2] = {0.0, 0.0};
    world w = world_create();
    se3d_body bar = add_bar(&w, "bar", from, 0.3, 1.0, 1.0);
    add_pin(&w, "pin", w.ground, bar, 0.0, 0.0);
    se3d_check *check = check_world(&w, SE3D_OK);
    CHECK(summary.bodies == 1 && summary.equations == 5 && summary.rank == 5);
    CHECK(summary.freedoms == 1 && summary.inconsistent == 0);
    CHECK(has_message(check, "1 degree of freedom: bar can move"));
    CHECK(se3d_check_count_messages(check) == 1);
    se3d_check_destroy(check);
    world_destroy(&w);
}

/* A second pin on the same axis: three equations of the loop repeat the first pin's one by one. */
static void a_second_hinge_of_a_door_is_named_row_by_row(void)
{
    const double from[2] = {0.0, 0.0};
    const double up[3] = {0.0, 0.0, 1.0};
    const double z[3] = {0.0, 0.0, 1.0};
    world w = world_create();
    se3d_body door = add_bar(&w, "door", from, 0.0, 1.0, 1.0);
    add_pin(&w, "low", w.ground, door, 0.0, 0.0);
    add_joint(&w, se3d_joint_create_revolute, "high", w.ground, door, up, z);
    se3d_check *check = check_world(&w, SE3D_INFO_REDUNDANT);
    CHECK(summary.equations == 10 && summary.rank == 5 && summary.redundant == 5);
    CHECK(summary.freedoms == 1 && summary.gruebler == -4 && summary.inconsistent == 0);
    CHECK(has_message(check, "high.cd_z duplicates low.cd_z"));
    CHECK(has_message(check, "high.dp1_a duplicates low.dp1_a"));
    CHECK(has_message(check, "high.dp1_b duplicates low.dp1_b"));
    CHECK_CONTAINS(find_message(check, "high.cd_x"), "duplicates low.cd_x, low.dp1_");
    CHECK_CONTAINS(find_message(check, "high.cd_y"), "duplicates low.cd_y, low.dp1_");
    se3d_check_destroy(check);
    world_destroy(&w);
}

static void windows_have_three_redundant_equations_each(void)
{
    for (int n = 1; n <= 2; ++n) {
        world w = create_windows(n, se3d_joint_create_revolute);
        se3d_check *check = check_world(&w, SE3D_INFO_REDUNDANT);
        CHECK(summary.bodies == (size_t)(2 * n + 1));
        CHECK(summary.equations == (size_t)(15 * n + 5));
        CHECK(summary.redundant == (size_t)(3 * n) && summary.freedoms == 1);
        CHECK(summary.inconsistent == 0);
        CHECK_CONTAINS(find_message(check, "C0.dp1_a"), "C0.dp1_a duplicates O0.dp1_");
        CHECK_CONTAINS(find_message(check, "C0.cd_z"), "C0.cd_z duplicates O0.cd_z");
        CHECK_CONTAINS(find_message(check, "C0.cd_z"), "O1.cd_z");
        CHECK_CONTAINS(find_message(check, "C0.cd_z"), "B0.cd_z");
        se3d_check_destroy(check);
        world_destroy(&w);
    }
}

/* Flat, the four-bar can move in two ways at first order. */
static void a_singular_position_has_one_freedom_more(void)
{
    const double O[2] = {0.0, 0.0}, A[2] = {1.0, 0.0}, Q[2] = {1.0, 0.0};
    world w = world_create();
    se3d_body left = add_bar(&w, "left", O, 0.0, 1.0, 1.0);
    se3d_body beam = add_bar(&w, "beam", A, 0.0, 1.0, 1.0);
    se3d_body right = add_bar(&w, "right", Q, 0.0, 1.0, 1.0);
    add_pin(&w, "O", w.ground, left, 0.0, 0.0);
    add_pin(&w, "A", left, beam, 1.0, 0.0);
    add_pin(&w, "B", beam, right, 2.0, 0.0);
    add_pin(&w, "Q", w.ground, right, 1.0, 0.0);
    se3d_check_destroy(check_world(&w, SE3D_INFO_REDUNDANT));
    CHECK(summary.redundant == 4 && summary.freedoms == 2);
    world_destroy(&w);
}

static void many_windows_are_reported_like_one(void)
{
    world w = create_windows(64, se3d_joint_create_revolute);
    se3d_check *check = check_world(&w, SE3D_INFO_REDUNDANT);
    CHECK(summary.redundant == 192 && summary.freedoms == 1);
    CHECK_CONTAINS(find_message(check, "C63.dp1_a"), "duplicates O63.dp1_");
    se3d_check_destroy(check);
    world_destroy(&w);
}

/* A tree has full rank whatever its size, and costs no dense analysis. */
static void a_long_chain_is_taken_off_link_by_link(void)
{
    world w = world_create();
    se3d_body before = w.ground;
    for (int k = 0; k < 800; ++k) {
        const double from[2] = {k, 0.0};
        se3d_body link = add_bar(&w, NULL, from, 0.0, 1.0, 1.0);
        add_pin(&w, NULL, before, link, k, 0.0);
        before = link;
    }
    se3d_check *check = check_world(&w, SE3D_OK);
    CHECK(summary.rank == 4000 && summary.freedoms == 800);
    CHECK(se3d_check_count_messages(check) == 0);
    se3d_check_destroy(check);
    world_destroy(&w);
}

static void bodies_that_nothing_holds_are_named(void)
{
    const double from[2] = {0.0, 0.0}, next[2] = {1.0, 0.0}, far[2] = {5.0, 5.0};
    world w = world_create();
    se3d_body a = add_bar(&w, "a", from, 0.0, 1.0, 1.0);
    se3d_body b = add_bar(&w, "b", next, 0.0, 1.0, 1.0);
    add_bar(&w, "alone", far, 0.0, 1.0, 1.0);
    add_pin(&w, "pin", a, b, 1.0, 0.0);
    se3d_check *check = check_world(&w, SE3D_OK);
    CHECK(summary.freedoms == 13);
    CHECK_CONTAINS(find_message(check, "nothing holds a, b:"), "no constraint leads to a fixed");
    CHECK_CONTAINS(find_message(check, "nothing holds alone:"), "no constraint leads to a fixed");
    CHECK(has_message(check, "7 degrees of freedom: a, b can move"));
    se3d_check_destroy(check);
    world_destroy(&w);
}

static se3d_constraint add_distance(world *w, const char *name, se3d_body j, double distance)
{
    se3d_constraint joint;
    se3d_joint_def def = se3d_joint_def_default();
    def.name = name;
    def.body_i = w->ground;
    def.body_j = j;
    def.distance = distance;
    MUST(w, se3d_joint_create_distance(w->system, &def, &joint));
    return joint;
}

static void two_lengths_of_one_link_contradict_each_other(void)
{
    const double from[2] = {0.0, 0.0};
    world w = world_create();
    se3d_body bar = add_bar(&w, "bar", from, 0.0, 2.0, 1.0);
    double before[3], after[3];
    add_distance(&w, "rod", bar, 1.0);
    add_distance(&w, "other", bar, 1.5);
    MUST(&w, se3d_body_get_position(w.system, bar, before));
    se3d_check *check = check_world(&w, SE3D_INFO_REDUNDANT);
    MUST(&w, se3d_body_get_position(w.system, bar, after));
    CHECK(memcmp(before, after, sizeof before) == 0);
    CHECK(summary.rank == 1 && summary.inconsistent == 1);
    CHECK_CONTAINS(find_message(check, "contradicts"), "other.d contradicts rod.d");
    se3d_check_destroy(check);
    world_destroy(&w);
}

static void two_drivers_at_different_speeds_contradict_each_other(void)
{
    const double from[2] = {0.0, 0.0};
    for (int same = 0; same < 2; ++same) {
        world w = world_create();
        se3d_body bar = add_bar(&w, "bar", from, 0.0, 2.0, 1.0);
        se3d_constraint pin = add_pin(&w, "pin", w.ground, bar, 0.0, 0.0);
        add_driver(&w, "motor", pin, SE3D_JOINT_COORDINATE_ANGLE, "2*t");
        add_driver(&w, "second", pin, SE3D_JOINT_COORDINATE_ANGLE, same ? "t+t" : "3*t");
        se3d_check *check = check_world(&w, SE3D_INFO_REDUNDANT);
        CHECK(summary.rank == 6 && summary.freedoms == 0);
        CHECK(summary.inconsistent == (same ? 0 : 1));
        const char *text = find_message(check, "second.");
        CHECK_CONTAINS(text, same ? "duplicates motor." : "contradicts motor.");
        CHECK_CONTAINS(text, same ? "" : "in its rate: it is off by 1 rad/s");
        se3d_check_destroy(check);
        world_destroy(&w);
    }
}

/* Poses off by 1e-3 hide the redundancy unless they are assembled for the analysis. */
static void rough_poses_are_assembled_for_the_report(void)
{
    world w = create_windows(1, se3d_joint_create_revolute);
    se3d_body post;
    double r[3];
    MUST(&w, se3d_body_find(w.system, "post1", &post));
    MUST(&w, se3d_body_get_position(w.system, post, r));
    r[0] += 1e-3;
    r[2] += 1e-3;
    MUST(&w, se3d_body_set_position(w.system, post, r));
    uint64_t hash = se3d_system_hash(w.system);
    se3d_check *check = check_world(&w, SE3D_INFO_REDUNDANT);
    CHECK(se3d_system_hash(w.system) == hash);
    CHECK(summary.redundant == 3 && summary.inconsistent == 0);
    CHECK_CONTAINS(find_message(check, "the given poses do not fit"), "open by");
    se3d_check_destroy(check);
    world_destroy(&w);
}

static void links_that_do_not_reach_are_reported_with_their_gap(void)
{
    const double O[2] = {0.0, 0.0}, A[2] = {1.0, 0.0}, Q[2] = {4.0, 0.0};
    const double front[3] = {-0.5, 0.0, 0.0}, back[3] = {0.5, 0.0, 0.0};
    world w = world_create();
    se3d_body crank = add_bar(&w, "crank", O, 0.2, 1.0, 1.0);
    se3d_body coupler = add_bar(&w, "coupler", A, 0.1, 1.0, 1.0);
    se3d_body rocker = add_bar(&w, "rocker", Q, 2.8, 1.0, 1.0);
    add_pin(&w, "O", w.ground, crank, 0.0, 0.0);
    add_local(&w, se3d_joint_create_revolute, "A", crank, back, coupler, front);
    add_local(&w, se3d_joint_create_revolute, "B", coupler, back, rocker, back);
    add_pin(&w, "Q", w.ground, rocker, 4.0, 0.0);
    se3d_check *check = check_world(&w, SE3D_INFO_REDUNDANT);
    CHECK(summary.inconsistent >= 1);
    const char *text = find_message(check, "cannot be met");
    const char *gap = strstr(text, "open by ");
    CHECK_NEAR(gap ? strtod(gap + 8, NULL) : 0.0, 1.0, 1e-4);
    se3d_check_destroy(check);
    world_destroy(&w);
}

static void misuse_of_reports_is_refused(void)
{
    world w = create_windows(1, se3d_joint_create_revolute);
    se3d_check *check = (se3d_check *)&w;
    const char *text = "x";
    CHECK(se3d_check_create(NULL, &check) == SE3D_ERR_NULL);
    CHECK(check == NULL);
    CHECK(se3d_check_create(w.system, NULL) == SE3D_ERR_NULL);
    check = check_world(&w, SE3D_INFO_REDUNDANT);
    summary.struct_size = 0;
    CHECK(se3d_check_get_summary(check, &summary) == SE3D_ERR_INVALID_ARGUMENT);
    summary.struct_size = sizeof summary + 4096;
    CHECK(se3d_check_get_summary(check, &summary) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_check_get_summary(NULL, &summary) == SE3D_ERR_NULL);
    CHECK(se3d_check_get_summary(check, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_check_get_message(check, 1000, &text) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(text == NULL);
    CHECK(se3d_check_get_message(NULL, 0, &text) == SE3D_ERR_NULL);
    CHECK(se3d_check_get_message(check, 0, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_check_count_messages(NULL) == 0);
    se3d_check_destroy(NULL);
    se3d_check_destroy(check);
    world_destroy(&w);
}

/* ---- multipliers ---- */

#define ROWS    128
#define COLUMNS 128

typedef struct multipliers {
    double C[ROWS * COLUMNS];
    double lambda[ROWS];
    size_t rows, columns;
} multipliers;

static size_t index_of(const world *w, se3d_body body)
{
    size_t k = 0;
    se3d_body other;
    while (se3d_system_get_body(w->system, k, &other) == SE3D_OK &&
           memcmp(&other, &body, sizeof body) != 0) {
        ++k;
    }
    return k;
}

static void add_block(const world *w, multipliers *m, se3d_constraint c, size_t slot, size_t count)
{
    se3d_body body;
    int32_t fixed;
    double phi_r[24], phi_pi[24];
    MUST(w, se3d_constraint_get_body(w->system, c, slot, &body));
    MUST(w, se3d_body_get_fixed(w->system, body, &fixed));
    MUST(w,
         se3d_constraint_eval_jacobian(w->system, c, SE3D_FORMULATION_ROMEGA, slot, phi_r, phi_pi));
    for (size_t e = 0; e < 3 * count && !fixed; ++e) {
        double *row = m->C + (m->rows + e / 3) * m->columns + 6 * index_of(w, body);
        row[e % 3] = phi_r[e];
        row[e % 3 + 3] = phi_pi[e];
    }
}

static multipliers *read_multipliers(const world *w)
{
    static multipliers m;
    memset(&m, 0, sizeof m);
    m.columns = 6 * se3d_system_count_bodies(w->system);
    for (size_t k = 0; k < se3d_system_count_constraints(w->system); ++k) {
        se3d_constraint c;
        size_t equations, bodies;
        MUST(w, se3d_system_get_constraint(w->system, k, &c));
        MUST(w, se3d_constraint_count_equations(w->system, c, &equations));
        MUST(w, se3d_constraint_count_bodies(w->system, c, &bodies));
        for (size_t slot = 0; slot < bodies; ++slot) {
            add_block(w, &m, c, slot, equations);
        }
        MUST(w, se3d_constraint_get_multipliers(w->system, c, m.lambda + m.rows));
        m.rows += equations;
    }
    CHECK(m.rows <= ROWS && m.columns <= COLUMNS);
    return &m;
}

/* The largest part of the multipliers in a direction that moves no body, relative to them. */
static double null_part(const multipliers *m, int32_t redundant)
{
    se3d_allocator allocator = se3di_alloc_default();
    se3di_rank rank;
    double worst = 0.0;
    double top = 0.0;
    CHECK(se3di_rank_analyse(&allocator, (int32_t)m->rows, (int32_t)m->columns, m->C, 1e-8,
                             &rank) == SE3D_INFO_REDUNDANT);
    CHECK(rank.redundant_count == redundant);
    for (size_t k = 0; k < m->rows; ++k) {
        top = fmax(top, fabs(m->lambda[k]));
    }
    for (int32_t k = 0; k < rank.redundant_count; ++k) {
        double sum = m->lambda[rank.redundant[k]];
        double norm = 1.0;
        for (int32_t e = rank.combination_begin[k]; e < rank.combination_begin[k + 1]; ++e) {
            sum -= rank.combination[e] * m->lambda[rank.combination_row[e]];
            norm += rank.combination[e] * rank.combination[e];
        }
        worst = fmax(worst, fabs(sum) / sqrt(norm));
    }
    se3di_rank_destroy(&allocator, &rank);
    return worst / top;
}

/* A load out of the plane, so that the redundant directions are loaded. */
static void multipliers_are_of_least_norm_in_both_formulations(void)
{
    const double gravity[3] = {0.3, -9.81, 2.0};
    for (int n = 1; n <= 2; ++n) {
        double first[ROWS];
        for (int f = 0; f < 2; ++f) {
            world w = create_windows(n, se3d_joint_create_revolute);
            MUST(&w, se3d_system_set_gravity(w.system, gravity));
            use_solver(&w, SE3D_ANALYSIS_DYNAMICS, (se3d_formulation)f);
            CHECK(se3d_solver_run(w.solver, 0.0) == SE3D_INFO_REDUNDANT);
            multipliers *m = read_multipliers(&w);
            CHECK(null_part(m, 3 * n) < 1e-12);
            for (size_t k = 0; k < m->rows && f == 1; ++k) {
                CHECK_NEAR(m->lambda[k], first[k], 1e-10 * 20.0);
            }
            memcpy(first, m->lambda, sizeof first);
            CHECK(se3d_solver_run(w.solver, 0.05) == SE3D_INFO_REDUNDANT);
            CHECK(null_part(read_multipliers(&w), 3 * n) < 1e-10);
            world_destroy(&w);
        }
    }
}

int main(void)
{
    RUN(an_empty_system_has_nothing_to_report);
    RUN(a_pendulum_has_one_freedom_and_no_redundancy);
    RUN(a_second_hinge_of_a_door_is_named_row_by_row);
    RUN(windows_have_three_redundant_equations_each);
    RUN(a_singular_position_has_one_freedom_more);
    RUN(many_windows_are_reported_like_one);
    RUN(a_long_chain_is_taken_off_link_by_link);
    RUN(bodies_that_nothing_holds_are_named);
    RUN(two_lengths_of_one_link_contradict_each_other);
    RUN(two_drivers_at_different_speeds_contradict_each_other);
    RUN(rough_poses_are_assembled_for_the_report);
    RUN(links_that_do_not_reach_are_reported_with_their_gap);
    RUN(misuse_of_reports_is_refused);
    RUN(multipliers_are_of_least_norm_in_both_formulations);
    return check_finish();
}
