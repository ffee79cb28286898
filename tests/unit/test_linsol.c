/* SPDX-License-Identifier: BSD-3-Clause */
/* The KKT solver on random mechanisms: structured = dense, redundancy, failures, allocation. */
#include <stdlib.h>

#include "check.h"
#include "linsol/kkt.h"
#include "test_linsol.h"

static mechanism m, other; /* too large for the stack */

static double distance(const double *a, const double *b, size_t count)
{
    double top = 0.0;
    for (size_t i = 0; i < count; ++i) {
        double d = fabs(a[i] - b[i]);
        top = d > top || !(d >= 0.0) ? d : top;
        if (!(d >= 0.0)) {
            return HUGE_VAL;
        }
    }
    return top;
}

typedef struct outcome {
    se3d_status factor, solve;
    se3di_kkt_factor_info factor_info;
    se3di_kkt_solve_info info;
    double error_x, error_l;
} outcome;

static se3di_kkt *create(mechanism *s, se3di_kkt_kind kind)
{
    se3di_kkt *kkt = NULL;
    CHECK(se3di_kkt_create(&memory, &s->pattern, kind, NULL, &kkt) == SE3D_OK);
    return kkt;
}

static outcome solve_with(mechanism *s, se3di_kkt_kind kind, const se3di_kkt_settings *settings)
{
    outcome out = {.factor = SE3D_ERR_STATE, .solve = SE3D_ERR_STATE};
    se3di_kkt *kkt = create(s, kind);
    if (!kkt) {
        return out;
    }
    if (settings) {
        se3di_kkt_set_settings(kkt, settings);
    }
    out.factor = se3di_kkt_factor(kkt, &s->values, &out.factor_info);
    out.solve = se3di_kkt_solve(kkt, &s->values, s->b, s->c, s->x, s->l, &out.info);
    out.error_x = distance(s->x, s->exact_x, s->unknowns);
    out.error_l = distance(s->l, s->exact_l, s->row_count);
    se3di_kkt_destroy(kkt);
    return out;
}

static const se3di_kkt_level levels[] = {SE3DI_KKT_LEVEL_PORTABLE, SE3DI_KKT_LEVEL_AVX2,
                                         SE3DI_KKT_LEVEL_AVX512};

/* Both kinds and all levels find the known solution. */
static void check_all_kinds(mechanism *s, double tolerance)
{
    bool is_tree =
        s->pattern.joint_count <= s->pattern.body_count; /* one factorisation is enough */
    outcome dense = solve_with(s, SE3DI_KKT_DENSE, NULL);
    CHECK(dense.factor == SE3D_OK && dense.solve == SE3D_OK);
    CHECK_NEAR(dense.error_x, 0.0, tolerance);
    CHECK_NEAR(dense.error_l, 0.0, tolerance);
    for (size_t k = 0; k < 3; ++k) {
        s->pattern.level = levels[k];
        outcome out = solve_with(s, SE3DI_KKT_STRUCTURED, NULL);
        CHECK(out.factor == SE3D_OK && out.solve == SE3D_OK);
        CHECK(out.factor_info.dependent_rows == 0 && out.factor_info.negative_pivots == 0);
        CHECK(!is_tree || out.factor_info.factorisations == 1);
        CHECK_NEAR(out.error_x, 0.0, tolerance);
        CHECK_NEAR(out.error_l, 0.0, tolerance);
    }
}

static void structured_and_dense_find_the_solution_of_trees(void)
{
    const size_t sizes[] = {1, 2, 7, 50};
    for (size_t k = 0; k < 4; ++k) {
        for (uint64_t seed = 1; seed <= 4; ++seed) {
            for (int32_t n = 3; n <= 6; n += 3) {
                start(&m, sizes[k], n, true, seed);
                add_tree(&m, n == 3 ? 2 : (seed == 1 ? 5 : 0));
                fill(&m);
                check_all_kinds(&m, 1e-11);
            }
        }
    }
}

static void structured_and_dense_find_the_solution_of_unsymmetric_trees(void)
{
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        start(&m, 3 * (size_t)seed, seed % 2 == 0 ? 6 : 8, false, seed);
        add_tree(&m, 0);
        add_coupling(&m, 0, 2);
        add_coupling(&m, 1, 2);
        fill(&m);
        check_all_kinds(&m, 1e-10);
    }
}

static void euler_parameter_blocks_are_solved(void)
{
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        start(&m, 5 * (size_t)seed, 8, true, seed);
        add_tree(&m, 3);
        add_coupling(&m, 0, 1);
        add_coupling(&m, 1, 4);
        fill(&m);
        check_all_kinds(&m, 1e-11);
    }
}

static void euler_parameter_blocks_at_the_identity_are_solved(void)
{
    start(&m, 1, 8, true, 3);
    add_joint(&m, 3, 0, -1);
    fill(&m);
    memset(m.body, 0, sizeof m.body);
    for (size_t r = 0; r < 3; ++r) {
        m.body[9 * r] = 2.0;
        m.body[9 * (r + 4)] = 0.3; /* 4 G^T J G at p = (1, 0, 0, 0) */
    }
    m.body[3 * 8 + 7] = m.body[7 * 8 + 3] = 1.0;
    memset(m.b, 0, sizeof m.b);
    memset(m.c, 0, sizeof m.c);
    multiply(&m, m.exact_x, m.exact_l, m.b, m.c);
    check_all_kinds(&m, 1e-12);
}

static void mass_blocks_give_what_full_blocks_give(void)
{
    start(&m, 20, 6, true, 5);
    m.pattern.body_kind = SE3DI_KKT_BODY_MASS;
    add_chain(&m, 5);
    fill(&m);
    check_all_kinds(&m, 1e-11);
}

static void mass_blocks_with_couplings_and_loops_are_solved(void)
{
    start(&m, 12, 6, true, 6);
    m.pattern.body_kind = SE3DI_KKT_BODY_MASS;
    add_tree(&m, 3);
    add_coupling(&m, 0, 1);
    add_coupling(&m, 4, 9);
    fill(&m);
    for (size_t i = 0; i < sizeof m.upper / sizeof *m.upper; ++i) {
        m.upper[i] *= 0.2; /* H stays positive definite */
    }
    memset(m.b, 0, sizeof m.b);
    memset(m.c, 0, sizeof m.c);
    multiply(&m, m.exact_x, m.exact_l, m.b, m.c);
    check_all_kinds(&m, 1e-11);
}

static void unsymmetric_blocks_are_pivoted(void)
{
    start(&m, 5, 6, false, 2);
    add_tree(&m, 3);
    fill(&m);
    for (size_t i = 0; i < 5; ++i) { /* rows 0 and 1 swapped, the first pivot zero */
        double *H = m.body + 36 * i;
        for (size_t c = 0; c < 6; ++c) {
            double t = H[c];
            H[c] = H[6 + c];
            H[6 + c] = t;
        }
        H[0] = 0.0;
    }
    memset(m.b, 0, sizeof m.b);
    memset(m.c, 0, sizeof m.c);
    multiply(&m, m.exact_x, m.exact_l, m.b, m.c);
    check_all_kinds(&m, 1e-10);
}

static void couplings_and_loops_and_big_joints_are_solved(void)
{
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        start(&m, 12, 6, true, seed);
        add_tree(&m, 3);
        add_joint(&m, 2, 3, 9); /* closes a loop */
        add_joint(&m, 1, 1, 11);
        add_joint(&m, 1, 0, 5);
        for (int32_t i = 0; i < 8; ++i) { /* a coupler of 10 rows on 8 bodies */
            m.body_of[m.begin[m.pattern.joint_count] + i] = i;
        }
        m.rows[m.pattern.joint_count] = 10;
        m.begin[m.pattern.joint_count + 1] = m.begin[m.pattern.joint_count] + 8;
        ++m.pattern.joint_count;
        add_joint(&m, 3, -1, -1); /* both ends on the ground: ignored */
        add_coupling(&m, 0, 11);
        add_coupling(&m, 2, 7);
        fill(&m);
        check_all_kinds(&m, 1e-10);
    }
}

/* A hub with many loops through it, on the ground or floating. */
static void a_hub_with_many_loops_is_solved(void)
{
    for (int32_t grounded = 0; grounded < 2; ++grounded) {
        start(&m, 41, 6, true, 7);
        for (int32_t k = 0; k < 20; ++k) {
            add_joint(&m, 5, 0, 1 + 2 * k);
            add_joint(&m, 3, 1 + 2 * k, 2 + 2 * k);
            add_joint(&m, 3, 0, 2 + 2 * k);
        }
        if (grounded) {
            add_joint(&m, 4, 0, -1);
        }
        fill(&m);
        check_all_kinds(&m, 1e-10);
    }
}

static void empty_systems_are_fine(void)
{
    for (int kind = 0; kind < 2; ++kind) {
        start(&m, 0, 6, true, 1);
        outcome out = solve_with(&m, (se3di_kkt_kind)kind, NULL);
        CHECK(out.factor == SE3D_OK && out.solve == SE3D_OK);
        start(&m, 0, 6, true, 1);
        add_joint(&m, 5, -1, -1);
        m.row_count = 5;
        m.c[2] = 1.0;
        m.l[2] = 9.0;
        out = solve_with(&m, (se3di_kkt_kind)kind, NULL);
        CHECK(out.factor == SE3D_OK && out.solve == SE3D_OK);
        CHECK_NEAR(m.l[2], 0.0, 0.0);
        start(&m, 3, 6, true, 1); /* no joints */
        fill(&m);
        out = solve_with(&m, (se3di_kkt_kind)kind, NULL);
        CHECK(out.factor == SE3D_OK && out.solve == SE3D_OK);
        CHECK_NEAR(out.error_x, 0.0, 1e-13);
    }
}

/* ---- redundancy ---- */

/* Repeat the last joint with its rows mixed by `factor`; exact_l is the least-norm solution. */
static void make_redundant(mechanism *s, double factor)
{
    size_t last = s->pattern.joint_count - 1;
    size_t rows = (size_t)s->rows[last], n = (size_t)s->pattern.body_size;
    size_t count = (size_t)(s->begin[last + 1] - s->begin[last]);
    add_joint(s, (int32_t)rows, s->body_of[s->begin[last]],
              count > 1 ? s->body_of[s->begin[last] + 1] : -1);
    size_t at = 0;
    for (size_t j = 0; j < last; ++j) {
        at += (size_t)(s->begin[j + 1] - s->begin[j]) * (size_t)s->rows[j] * n;
    }
    for (size_t i = 0; i < count * rows * n; ++i) {
        s->joint[at + count * rows * n + i] = factor * s->joint[at + i];
        s->joint_b[at + count * rows * n + i] = factor * s->joint_b[at + i];
    }
    /* l1 + f l2 = g with least |l|: l1 = g / (1 + f^2), l2 = f l1 */
    size_t row = s->row_count - rows;
    for (size_t r = 0; r < rows; ++r) {
        s->exact_l[row + r] /= 1.0 + factor * factor;
        s->exact_l[row + rows + r] = factor * s->exact_l[row + r];
        s->c[row + rows + r] = factor * s->c[row + r];
    }
    s->row_count += rows;
}

static void redundant_rows_leave_x_exact_and_l_of_least_norm(void)
{
    const double factors[] = {1.0, -0.3, 7.0};
    for (uint64_t seed = 1; seed <= 12; ++seed) {
        for (int kind = 0; kind < 2; ++kind) {
            start(&m, 1 + 2 * (size_t)seed, seed % 4 == 0 ? 8 : 6, seed % 3 != 0, seed);
            add_tree(&m, seed % 4 == 0 ? 3 : 5);
            fill(&m);
            make_redundant(&m, factors[seed % 3]);
            outcome out = solve_with(&m, (se3di_kkt_kind)kind, NULL);
            CHECK(out.factor == SE3D_INFO_REDUNDANT && out.solve == SE3D_INFO_REDUNDANT);
            CHECK(out.factor_info.dependent_rows == (seed % 4 == 0 ? 3 : 5));
            CHECK(out.info.projected && !out.info.inconsistent);
            CHECK(out.info.refinements <= 5);
            CHECK_NEAR(out.error_x, 0.0, 1e-12);
            CHECK_NEAR(out.error_l, 0.0, 1e-11);
        }
    }
}

static void exact_least_norm_agrees_with_the_refined_one(void)
{
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        start(&m, 9, seed % 2 == 0 ? 8 : 6, seed % 3 != 0, seed);
        add_tree(&m, 3);
        fill(&m);
        make_redundant(&m, 0.5);
        int32_t rank = 0;
        se3di_kkt *kkt = create(&m, SE3DI_KKT_STRUCTURED);
        CHECK(se3di_kkt_min_norm(kkt, &m.values, m.b, m.exact_x, 1e-10, m.l, &rank) == SE3D_OK);
        se3di_kkt_destroy(kkt);
        CHECK(rank == 27);
        CHECK_NEAR(distance(m.l, m.exact_l, m.row_count), 0.0, 1e-12);
    }
}

static void redundancy_inside_a_tree_is_found_late(void)
{
    start(&m, 6, 6, true, 9);
    add_tree(&m, 5);
    fill(&m);
    make_redundant(&m, 1.0);
    se3di_kkt_settings settings;
    se3di_kkt *kkt = create(&m, SE3DI_KKT_STRUCTURED);
    settings = se3di_kkt_get_settings(kkt);
    se3di_kkt_destroy(kkt);
    settings.regularise = SE3DI_KKT_REGULARISE_LATE;
    outcome out = solve_with(&m, SE3DI_KKT_STRUCTURED, &settings);
    CHECK(out.factor_info.factorisations == 2);
    CHECK(out.factor_info.dependent_rows == 5);
    CHECK_NEAR(out.error_x, 0.0, 1e-12);
    CHECK_NEAR(out.error_l, 0.0, 1e-11);
    settings.regularise = SE3DI_KKT_REGULARISE_FIRST;
    out = solve_with(&m, SE3DI_KKT_STRUCTURED, &settings);
    CHECK(out.factor_info.factorisations == 1);
    CHECK_NEAR(out.error_x, 0.0, 1e-12);
}

static void contradicting_rows_are_told(void)
{
    for (int kind = 0; kind < 2; ++kind) {
        start(&m, 5, 6, true, 4);
        add_tree(&m, 5);
        fill(&m);
        make_redundant(&m, 1.0);
        m.c[m.row_count - 1] += 1e-3;
        outcome out = solve_with(&m, (se3di_kkt_kind)kind, NULL);
        CHECK(out.solve == SE3D_INFO_REDUNDANT);
        CHECK(out.info.inconsistent);
        CHECK(out.info.residual_c > 1e-5);
        CHECK(out.error_x < 0.1); /* least squares: off by the size of the contradiction */
        CHECK_NEAR(out.error_l, 0.0, 0.1);
    }
}

/* The last two joints nearly the same: every entry of the copy off by up to 1e-5. */
static void make_nearly_redundant(uint64_t seed)
{
    start(&m, 6, 6, true, seed);
    add_tree(&m, 2);
    fill(&m);
    make_redundant(&m, 1.0);
    size_t last = 0, j = m.pattern.joint_count - 1;
    for (size_t k = 0; k <= j; ++k) {
        last += (size_t)((m.begin[k + 1] - m.begin[k]) * m.rows[k] * 6);
    }
    for (size_t i = last - 12; i < last; ++i) {
        m.joint[i] += 1e-5 * uniform(&m);
    }
    memset(m.b, 0, sizeof m.b);
    memset(m.c, 0, sizeof m.c);
    multiply(&m, m.exact_x, m.exact_l, m.b, m.c);
}

static void nearly_dependent_rows_are_solved_as_regular(void)
{
    for (uint64_t seed = 1; seed <= 8; ++seed) {
        for (int kind = 0; kind < 2; ++kind) {
            make_nearly_redundant(seed);
            outcome out = solve_with(&m, (se3di_kkt_kind)kind, NULL);
            CHECK(out.factor >= 0 && out.solve == SE3D_OK);
            CHECK(kind == 1 || out.factor_info.near_dependent == 2);
            CHECK_NEAR(out.error_x, 0.0, 1e-8);
            CHECK(out.info.residual_b < 1e-14 && out.info.residual_c < 1e-14);
            for (size_t i = 0; i < m.row_count; ++i) { /* x of size 1e5, l of size 1e10 */
                m.c[i] += uniform(&m);
            }
            out = solve_with(&m, (se3di_kkt_kind)kind, NULL);
            CHECK(out.solve == SE3D_OK);
            CHECK(out.info.residual_b < 1e-14 && out.info.residual_c < 1e-10);
        }
    }
}

/* ---- failures, memory, repetition ---- */

static void bad_values_are_refused(void)
{
    for (int kind = 0; kind < 2; ++kind) {
        start(&m, 4, 6, true, 1);
        add_tree(&m, 5);
        fill(&m);
        m.body[36 + 24] = (double)NAN;
        outcome out = solve_with(&m, (se3di_kkt_kind)kind, NULL);
        CHECK(out.factor == SE3D_ERR_NOT_FINITE);
        start(&m, 4, 6, true, 1);
        add_tree(&m, 5);
        fill(&m);
        m.joint[7] = HUGE_VAL;
        out = solve_with(&m, (se3di_kkt_kind)kind, NULL);
        CHECK(out.factor == SE3D_ERR_NOT_FINITE);
    }
    start(&m, 2, 6, true, 1);
    add_tree(&m, 5);
    fill(&m);
    memset(m.body, 0, sizeof m.body);
    outcome out = solve_with(&m, SE3DI_KKT_STRUCTURED, NULL);
    CHECK(out.factor == SE3D_ERR_SINGULAR);
}

static void bad_patterns_are_refused(void)
{
    se3di_kkt *kkt = NULL;
    start(&m, 2, 9, true, 1);
    CHECK(se3di_kkt_create(&memory, &m.pattern, SE3DI_KKT_STRUCTURED, NULL, &kkt) ==
          SE3D_ERR_INVALID_ARGUMENT);
    start(&m, 2, 6, true, 1);
    add_joint(&m, 5, 0, 2);
    CHECK(se3di_kkt_create(&memory, &m.pattern, SE3DI_KKT_STRUCTURED, NULL, &kkt) ==
          SE3D_ERR_INVALID_ARGUMENT);
    start(&m, 2, 6, true, 1);
    add_joint(&m, 5, 1, 1);
    CHECK(se3di_kkt_create(&memory, &m.pattern, SE3DI_KKT_STRUCTURED, NULL, &kkt) ==
          SE3D_ERR_INVALID_ARGUMENT);
    start(&m, 2, 6, true, 1);
    add_joint(&m, 65, 0, 1);
    CHECK(se3di_kkt_create(&memory, &m.pattern, SE3DI_KKT_STRUCTURED, NULL, &kkt) ==
          SE3D_ERR_INVALID_ARGUMENT);
    start(&m, 2, 6, true, 1);
    add_coupling(&m, 1, 0);
    CHECK(se3di_kkt_create(&memory, &m.pattern, SE3DI_KKT_STRUCTURED, NULL, &kkt) ==
          SE3D_ERR_INVALID_ARGUMENT);
    CHECK(kkt == NULL);
    CHECK(memory_counter.bytes == 0);
}

static void a_failing_allocation_leaves_nothing_behind(void)
{
    for (int kind = 0; kind < 2; ++kind) {
        start(&m, 6, 6, kind == 0, 2);
        add_tree(&m, 5);
        add_joint(&m, 2, 1, 4);
        fill(&m);
        se3d_status status = SE3D_ERR_NO_MEMORY;
        size_t at = 1;
        for (; status < 0 && at < 10000; ++at) {
            se3di_kkt *kkt = NULL;
            memory_counter.calls = 0;
            memory_counter.fail_at = SIZE_MAX;
            se3di_shelf *shelf = se3di_shelf_create(&memory);
            memory_counter.fail_at = at + 1;
            status = se3di_kkt_create(&memory, &m.pattern, (se3di_kkt_kind)kind, shelf, &kkt);
            CHECK(status == SE3D_OK || (status == SE3D_ERR_NO_MEMORY && !kkt));
            se3di_kkt_destroy(kkt);
            se3di_shelf_drop(shelf);
            CHECK(memory_counter.bytes == 0);
        }
        memory_counter.fail_at = SIZE_MAX;
        CHECK(status == SE3D_OK && at > 20);
    }
}

static void factor_and_solve_allocate_nothing_and_repeat_bit_for_bit(void)
{
    for (int kind = 0; kind < 2; ++kind) {
        start(&m, 20, 6, true, 2);
        add_tree(&m, 5);
        fill(&m);
        make_redundant(&m, 1.0);
        se3di_kkt *kkt = create(&m, (se3di_kkt_kind)kind);
        size_t calls = memory_counter.calls;
        for (int step = 0; step < 3; ++step) {
            CHECK(se3di_kkt_factor(kkt, &m.values, NULL) == SE3D_INFO_REDUNDANT);
            CHECK(se3di_kkt_solve(kkt, &m.values, m.b, m.c, m.x, m.l, NULL) == SE3D_INFO_REDUNDANT);
            if (step == 0) {
                memcpy(other.x, m.x, sizeof m.x);
                memcpy(other.l, m.l, sizeof m.l);
            }
            CHECK(memcmp(other.x, m.x, sizeof m.x) == 0);
            CHECK(memcmp(other.l, m.l, sizeof m.l) == 0);
        }
        CHECK(memory_counter.calls == calls);
        se3di_kkt_destroy(kkt);
    }
}

static void several_right_sides_use_one_factorisation(void)
{
    start(&m, 20, 6, true, 2);
    add_tree(&m, 5);
    fill(&m);
    se3di_kkt *kkt = create(&m, SE3DI_KKT_STRUCTURED);
    CHECK(se3di_kkt_factor(kkt, &m.values, NULL) == SE3D_OK);
    for (int side = 0; side < 3; ++side) {
        memset(m.b, 0, sizeof m.b);
        memset(m.c, 0, sizeof m.c);
        fill_right_side(&m);
        CHECK(se3di_kkt_solve(kkt, &m.values, m.b, m.c, m.x, m.l, NULL) == SE3D_OK);
        CHECK_NEAR(distance(m.x, m.exact_x, m.unknowns), 0.0, 1e-11);
        CHECK_NEAR(distance(m.l, m.exact_l, m.row_count), 0.0, 1e-11);
    }
    se3di_kkt_destroy(kkt);
}

/* The body blocks and weights of the first factorisation serve the second, of other joint blocks.
 */
static void held_body_blocks_serve_other_joint_blocks(void)
{
    for (int mass = 0; mass < 2; ++mass) {
        for (int chain = 0; chain < 2; ++chain) {
            start(&m, 12, 6, true, 17);
            m.pattern.body_kind = mass ? SE3DI_KKT_BODY_MASS : SE3DI_KKT_BODY_FULL;
            if (chain) {
                add_chain(&m, 5);
            } else {
                add_tree(&m, 3);
            }
            fill(&m);
            se3di_kkt *kkt = create(&m, SE3DI_KKT_STRUCTURED);
            CHECK(kkt != NULL);
            se3di_kkt_hold(kkt, true);
            CHECK(se3di_kkt_factor(kkt, &m.values, NULL) == SE3D_OK);
            fill_joints(&m); /* counts the rows once more */
            m.row_count /= 2;
            memset(m.b, 0, sizeof m.b);
            memset(m.c, 0, sizeof m.c);
            multiply(&m, m.exact_x, m.exact_l, m.b, m.c);
            CHECK(se3di_kkt_factor(kkt, &m.values, NULL) == SE3D_OK);
            CHECK(se3di_kkt_solve(kkt, &m.values, m.b, m.c, m.x, m.l, NULL) == SE3D_OK);
            CHECK_NEAR(distance(m.x, m.exact_x, m.unknowns), 0.0, 1e-12);
            CHECK_NEAR(distance(m.l, m.exact_l, m.row_count), 0.0, 1e-11);
            m.body[0] += 1.0; /* not read: a body goes before its joints */
            CHECK(se3di_kkt_factor(kkt, &m.values, NULL) == SE3D_OK);
            m.body[0] -= 1.0;
            CHECK(se3di_kkt_solve(kkt, &m.values, m.b, m.c, m.x, m.l, NULL) == SE3D_OK);
            CHECK(!mass || !chain || distance(m.x, m.exact_x, m.unknowns) < 1e-12);
            se3di_kkt_hold(kkt, false);
            m.body[0] += 1.0; /* from now on it is */
            CHECK(se3di_kkt_factor(kkt, &m.values, NULL) == SE3D_OK);
            CHECK(se3di_kkt_solve(kkt, &m.values, m.b, m.c, m.x, m.l, NULL) == SE3D_OK);
            CHECK(distance(m.x, m.exact_x, m.unknowns) > 1e-6);
            se3di_kkt_destroy(kkt);
        }
    }
}

static void an_expected_right_side_is_solved_as_any_other(void)
{
    for (int kind = 0; kind < 4; ++kind) { /* chain, tree with redundant rows, r-p, unsymmetric */
        start(&m, 9, kind == 2 ? 8 : 6, kind != 3, 23);
        if (kind == 0) {
            add_chain(&m, 5);
        } else {
            add_tree(&m, 3);
        }
        fill(&m);
        if (kind == 1) {
            make_redundant(&m, 0.5);
        }
        static double other_b[MAX_BODIES * 8], x[MAX_BODIES * 8], l[MAX_JOINTS * 64];
        memcpy(other_b, m.b, sizeof other_b);
        se3di_kkt *kkt = create(&m, SE3DI_KKT_STRUCTURED);
        CHECK(kkt != NULL);
        se3di_kkt_expect(kkt, m.b, m.c);
        CHECK(se3di_kkt_factor(kkt, &m.values, NULL) >= 0);
        CHECK(se3di_kkt_solve(kkt, &m.values, m.b, m.c, m.x, m.l, NULL) >= 0);
        CHECK(distance(m.x, m.exact_x, m.unknowns) < 1e-11);
        m.b[0] += 1.0; /* the second solution is of what is in b now */
        CHECK(se3di_kkt_solve(kkt, &m.values, m.b, m.c, x, l, NULL) >= 0);
        CHECK(distance(x, m.exact_x, m.unknowns) > 1e-3);
        se3di_kkt_expect(kkt, m.b, m.c); /* but another one comes */
        CHECK(se3di_kkt_factor(kkt, &m.values, NULL) >= 0);
        CHECK(se3di_kkt_solve(kkt, &m.values, other_b, m.c, x, l, NULL) >= 0);
        CHECK(distance(x, m.exact_x, m.unknowns) < 1e-11);
        se3di_kkt_destroy(kkt);
    }
}

/* Known redundancy needs no look at the residual; one row more does. */
static void known_redundancy_is_solved_to_the_tolerance_without_a_check(void)
{
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        start(&m, 1 + 2 * (size_t)seed, 6, true, seed);
        add_tree(&m, 5);
        fill(&m);
        make_redundant(&m, 0.5);
        se3di_kkt_settings settings = {.eps = 1e-10,
                                       .eps_min = 1e-10,
                                       .tolerance = 1e-6,
                                       .max_refinements = 2,
                                       .any_multipliers = true,
                                       .redundant_rows = 5};
        outcome once = solve_with(&m, SE3DI_KKT_STRUCTURED, &settings);
        CHECK(once.solve == SE3D_OK && !once.info.checked && !once.info.projected);
        CHECK(once.info.refinements == 0 && once.error_x < 1e-6);
        settings.tolerance = 1e-12;
        outcome twice = solve_with(&m, SE3DI_KKT_STRUCTURED, &settings);
        CHECK(twice.info.refinements > 0 && !twice.info.checked && twice.error_x < 1e-12);
        CHECK(twice.error_x < once.error_x);
        settings.redundant_rows = 4;
        outcome checked = solve_with(&m, SE3DI_KKT_STRUCTURED, &settings);
        CHECK(checked.info.checked && checked.error_x < 1e-12);
    }
}

/* c = 0, and C x cancels: the rest of it must be small beside its terms, not beside itself. */
static void motions_that_obey_the_constraints_are_exact(void)
{
    static double force[MAX_BODIES * 8], rate[MAX_JOINTS * 64];
    static const double zero[MAX_JOINTS * 64];
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        start(&m, 1, 6, true, seed);
        m.pattern.level = levels[seed % 3];
        add_joint(&m, 2, 0, -1);
        add_joint(&m, 2, -1, 0);
        fill(&m);
        se3di_kkt_settings settings = {.eps = 1e-8,
                                       .eps_min = 1e-8,
                                       .tolerance = 3e-15,
                                       .max_refinements = 10,
                                       .always_check = true};
        se3di_kkt *kkt = create(&m, SE3DI_KKT_STRUCTURED);
        se3di_kkt_solve_info info;
        se3di_kkt_set_settings(kkt, &settings);
        CHECK(se3di_kkt_factor(kkt, &m.values, NULL) == SE3D_OK);
        CHECK(se3di_kkt_solve(kkt, &m.values, m.b, NULL, m.x, m.l, &info) == SE3D_OK);
        CHECK(info.checked && info.residual_c < 1e-14);
        memset(rate, 0, sizeof rate);
        multiply(&m, m.x, m.l, force, rate);
        CHECK(distance(rate, zero, m.row_count) < 1e-13);
        se3di_kkt_destroy(kkt);
    }
}

/* Two rows at the angle s of each other; the second also asks for a little across the first. */
static double solve_with_rows_at(double s)
{
    start(&m, 1, 6, true, 1);
    add_joint(&m, 1, 0, -1);
    add_joint(&m, 1, 0, -1);
    for (int k = 0; k < 6; ++k) {
        m.body[7 * k] = 1.0;
    }
    m.unknowns = 6;
    m.row_count = 2;
    m.joint[0] = 1.0;
    m.joint[6] = cos(s);
    m.joint[7] = sin(s);
    m.c[0] = 1.0;
    m.c[1] = cos(s) + 0.01 * sin(s);
    se3di_kkt_settings settings = {.eps = 1e-9,
                                   .eps_min = 1e-9,
                                   .tolerance = 1e-15,
                                   .max_refinements = 10,
                                   .regularise = SE3DI_KKT_REGULARISE_FIRST,
                                   .any_multipliers = true};
    const outcome out = solve_with(&m, SE3DI_KKT_STRUCTURED, &settings);
    CHECK(out.factor >= 0 && out.solve >= 0);
    return 100.0 * m.x[1]; /* 1 without a filter */
}

static void a_filtered_solution_does_not_jump(void)
{
    double last = solve_with_rows_at(1e-7), least = last;
    for (int k = 1; k <= 6000; ++k) {
        const double now = solve_with_rows_at(1e-7 * pow(10.0, 1e-3 * k));
        CHECK_NEAR(now, last, 5e-3);
        least = fmin(least, now);
        last = now;
    }
    CHECK(least < 1e-3);
    CHECK_NEAR(last, 1.0, 1e-10);
}

static void cost_of_a_chain_is_proportional_to_its_length(void)
{
    double cost[2];
    for (size_t k = 0; k < 2; ++k) {
        start(&m, k == 0 ? 25 : 50, 6, true, 1);
        add_chain(&m, 5);
        se3di_kkt *kkt = create(&m, SE3DI_KKT_STRUCTURED);
        cost[k] = se3di_kkt_get_cost(kkt);
        se3di_kkt_destroy(kkt);
    }
    CHECK(cost[1] < 2.1 * cost[0]);
}

int main(void)
{
    RUN(structured_and_dense_find_the_solution_of_trees);
    RUN(structured_and_dense_find_the_solution_of_unsymmetric_trees);
    RUN(euler_parameter_blocks_are_solved);
    RUN(euler_parameter_blocks_at_the_identity_are_solved);
    RUN(mass_blocks_give_what_full_blocks_give);
    RUN(mass_blocks_with_couplings_and_loops_are_solved);
    RUN(unsymmetric_blocks_are_pivoted);
    RUN(couplings_and_loops_and_big_joints_are_solved);
    RUN(a_hub_with_many_loops_is_solved);
    RUN(empty_systems_are_fine);
    RUN(redundant_rows_leave_x_exact_and_l_of_least_norm);
    RUN(exact_least_norm_agrees_with_the_refined_one);
    RUN(redundancy_inside_a_tree_is_found_late);
    RUN(contradicting_rows_are_told);
    RUN(nearly_dependent_rows_are_solved_as_regular);
    RUN(motions_that_obey_the_constraints_are_exact);
    RUN(a_filtered_solution_does_not_jump);
    RUN(bad_values_are_refused);
    RUN(bad_patterns_are_refused);
    RUN(a_failing_allocation_leaves_nothing_behind);
    RUN(factor_and_solve_allocate_nothing_and_repeat_bit_for_bit);
    RUN(several_right_sides_use_one_factorisation);
    RUN(held_body_blocks_serve_other_joint_blocks);
    RUN(an_expected_right_side_is_solved_as_any_other);
    RUN(known_redundancy_is_solved_to_the_tolerance_without_a_check);
    RUN(cost_of_a_chain_is_proportional_to_its_length);
    CHECK(memory_counter.bytes == 0);
    return check_finish();
}
