/* SPDX-License-Identifier: BSD-3-Clause */
/* Conjugate gradients on 6 x 6 blocks: against the matrix itself, for random graphs, chains, pieces
 * of larger lists, and stiff couplings. */
#include "linsol/block_cg_core.h"

#include "check.h"

#include <math.h>
#include <string.h>

#define MOST  40
#define PAIRS 400

static uint64_t seed = 1;
static se3d_allocator allocator;

typedef struct problem {
    int32_t pairs[2 * PAIRS];
    double diagonal[36 * MOST], coupling[36 * PAIRS];
    double x[6 * MOST], b[6 * MOST], found[6 * MOST], back[6 * MOST];
    se3di_block_matrix A;
} problem;

/* An element that couples two bodies: k (J_i x_i + J_j x_j)^2 of three rows. */
static void couple(problem *p, size_t i, size_t j, double stiffness)
{
    double J[2][18];
    const size_t at = p->A.pair_count++, body[2] = {i, j};
    for (int side = 0; side < 2; ++side) {
        for (int k = 0; k < 18; ++k) {
            J[side][k] = check_random(&seed);
        }
    }
    p->pairs[2 * at] = (int32_t)i;
    p->pairs[2 * at + 1] = (int32_t)j;
    for (size_t r = 0; r < 6; ++r) {
        for (size_t c = 0; c < 6; ++c) {
            for (size_t e = 0; e < 3; ++e) {
                p->coupling[36 * at + 6 * r + c] += stiffness * J[0][6 * e + r] * J[1][6 * e + c];
                for (size_t side = 0; side < 2; ++side) {
                    p->diagonal[36 * body[side] + 6 * r + c] +=
                        stiffness * J[side][6 * e + r] * J[side][6 * e + c];
                }
            }
        }
    }
}

/* Unit masses; each pair with the given probability, those of a chain always. */
static void build(problem *p, size_t count, double density, double stiffness)
{
    memset(p, 0, sizeof *p);
    p->A = (se3di_block_matrix){
        .count = count, .pairs = p->pairs, .diagonal = p->diagonal, .coupling = p->coupling};
    for (size_t k = 0; k < 6 * count; ++k) {
        p->diagonal[36 * (k / 6) + 7 * (k % 6)] = 1.0;
        p->x[k] = check_random(&seed);
    }
    for (size_t i = 0; i < count; ++i) {
        for (size_t j = i + 1; j < count && p->A.pair_count < PAIRS; ++j) {
            if (j == i + 1 || fabs(check_random(&seed)) < density) {
                couple(p, i, j, stiffness);
            }
        }
    }
    se3di_block_cg_add_product(&p->A, p->x, p->b);
}

/* The largest error relative to the solution, after a solution to `share`. */
static double solve(se3di_block_cg *cg, problem *p, double share, int *iterations)
{
    double worst = 0.0;
    CHECK(se3di_block_cg_reserve(cg, &allocator, p->A.count, p->A.pair_count) == SE3D_OK);
    se3di_block_cg_factor(cg, &p->A);
    *iterations = se3di_block_cg_solve(cg, &p->A, p->b, share, 500, p->found);
    for (size_t k = 0; k < 6 * p->A.count; ++k) {
        worst = fmax(worst, fabs(p->found[k] - p->x[k]));
    }
    return worst;
}

static void random_graphs_are_solved(void)
{
    static problem p;
    se3di_block_cg cg = {0};
    for (int k = 0; k < 24; ++k) {
        int iterations;
        build(&p, 1 + (size_t)(k % 8) * 5, 0.1 * (k / 8), k % 2 ? 1e4 : 1.0);
        CHECK_NEAR(solve(&cg, &p, 1e-14, &iterations), 0.0, k % 2 ? 1e-7 : 1e-11);
    }
    se3di_block_cg_destroy(&cg, &allocator);
}

/* Elimination along it fills nothing in: the preconditioner is the matrix. */
static void a_chain_is_solved_at_once(void)
{
    static problem p;
    se3di_block_cg cg = {0};
    int iterations;
    build(&p, MOST, 0.0, 100.0);
    CHECK(solve(&cg, &p, 1e-9, &iterations) < 1e-9);
    CHECK(iterations == 1);
    se3di_block_cg_destroy(&cg, &allocator);
}

/* D is that of the matrix before one more element, the couplings are those of now. */
static void a_kept_preconditioner_solves_what_has_changed(void)
{
    static problem p;
    se3di_block_cg cg = {0};
    int iterations;
    build(&p, MOST, 0.2, 10.0);
    (void)solve(&cg, &p, 1e-12, &iterations);
    const size_t pairs = p.A.pair_count;
    for (size_t k = 0; k < pairs; k += 5) {
        static problem more;
        memset(&more, 0, sizeof more);
        couple(&more, 0, 1, 3.0);
        for (size_t e = 0; e < 36; ++e) {
            p.coupling[36 * k + e] += more.coupling[e];
            p.diagonal[36 * (size_t)p.pairs[2 * k] + e] += more.diagonal[e];
            p.diagonal[36 * (size_t)p.pairs[2 * k + 1] + e] += more.diagonal[36 + e];
        }
    }
    memset(p.b, 0, sizeof p.b);
    se3di_block_cg_add_product(&p.A, p.x, p.b);
    se3di_block_cg_renew(&cg, &p.A);
    const int kept = se3di_block_cg_solve(&cg, &p.A, p.b, 1e-13, 500, p.found);
    CHECK(kept < 500);
    for (size_t k = 0; k < 6 * MOST; ++k) {
        CHECK_NEAR(p.found[k], p.x[k], 1e-10);
    }
    se3di_block_cg_destroy(&cg, &allocator);
}

/* The couplings of an island in the list of all. */
static void blocks_may_be_part_of_more(void)
{
    static problem p;
    se3di_block_cg cg = {0};
    double whole[6 * 10];
    int iterations, again;
    build(&p, 10, 0.5, 3.0);
    (void)solve(&cg, &p, 1e-12, &iterations);
    memcpy(whole, p.found, sizeof whole);
    for (size_t k = 0; k < 2 * p.A.pair_count; ++k) {
        p.pairs[k] += 17;
    }
    p.A.first = 17;
    (void)solve(&cg, &p, 1e-12, &again);
    CHECK(again == iterations && memcmp(whole, p.found, sizeof whole) == 0);
    se3di_block_cg_destroy(&cg, &allocator);
}

/* However early it ends, what it has found leads downhill. */
static void every_beginning_leads_downhill(void)
{
    static problem p;
    se3di_block_cg cg = {0};
    build(&p, MOST, 0.2, 1e3);
    CHECK(se3di_block_cg_reserve(&cg, &allocator, MOST, PAIRS) == SE3D_OK);
    se3di_block_cg_factor(&cg, &p.A);
    for (int most = 1; most < 40; most += 3) {
        double down = 0.0;
        CHECK(se3di_block_cg_solve(&cg, &p.A, p.b, 0.0, most, p.found) == most);
        for (size_t k = 0; k < 6 * MOST; ++k) {
            down += p.b[k] * p.found[k];
        }
        CHECK(down > 0.0);
    }
    memset(p.b, 0, sizeof p.b);
    CHECK(se3di_block_cg_solve(&cg, &p.A, p.b, 1e-3, 100, p.found) == 0);
    CHECK(fabs(p.found[0]) <= 0.0 && fabs(p.found[6 * MOST - 1]) <= 0.0);
    se3di_block_cg_destroy(&cg, &allocator);
}

static void all_levels_give_the_same_bits(void)
{
    static problem p;
    static double first[6 * MOST];
    se3di_block_cg cg = {0};
    const se3di_block_cg_core *levels[2] = {se3di_block_cg_core_portable(),
                                            se3di_block_cg_core_avx2()};
    build(&p, MOST, 0.2, 1e3);
    CHECK(se3di_block_cg_reserve(&cg, &allocator, MOST, PAIRS) == SE3D_OK);
    for (int k = 0; k < 2 && levels[k]; ++k) {
        cg.core = levels[k];
        se3di_block_cg_factor(&cg, &p.A);
        CHECK(se3di_block_cg_solve(&cg, &p.A, p.b, 1e-12, 500, p.found) > 3);
        if (k == 0) {
            memcpy(first, p.found, sizeof first);
        }
        CHECK(memcmp(first, p.found, sizeof first) == 0);
    }
    se3di_block_cg_destroy(&cg, &allocator);
}

int main(void)
{
    allocator = se3di_alloc_default();
    RUN(random_graphs_are_solved);
    RUN(a_chain_is_solved_at_once);
    RUN(a_kept_preconditioner_solves_what_has_changed);
    RUN(blocks_may_be_part_of_more);
    RUN(every_beginning_leads_downhill);
    RUN(all_levels_give_the_same_bits);
    return check_finish();
}
