/* SPDX-License-Identifier: BSD-3-Clause */
/* Freedoms that joints leave, found joint by joint: against the equations themselves, known numbers
 * of freedoms, and the pivots of the KKT solver. */
#include "check.h"

#include "linsol/eigen.h"
#include "linsol/kkt.h"
#include "linsol/null_space.h"

#include <stdlib.h>

#define BODIES 6
#define JOINTS 8
#define N      (6 * BODIES)
#define ROWS   64

static void *plain_alloc(void *ctx, size_t size)
{
    size_t *left = ctx; /* allocations before one fails */
    if (left && (*left)-- == 0) {
        *left = 0;
        return NULL;
    }
    return malloc(size);
}

static void *plain_realloc(void *ctx, void *memory, size_t old_size, size_t new_size)
{
    (void)ctx;
    (void)old_size;
    return realloc(memory, new_size);
}

static void plain_free(void *ctx, void *memory, size_t size)
{
    (void)ctx;
    (void)size;
    free(memory);
}

static const se3d_allocator heap = {plain_alloc, plain_realloc, plain_free, NULL};

static uint64_t seed;

static double next(void)
{
    seed ^= seed << 13;
    seed ^= seed >> 7;
    seed ^= seed << 17;
    return (double)(seed >> 11) * 0x1p-52 - 1.0;
}

/* Joints of random rows between random bodies: joint k joins body k and an earlier one or the
 * ground, the last ones close loops. */
typedef struct mechanism {
    int32_t rows[JOINTS], begin[JOINTS + 1], body[2 * JOINTS];
    size_t offset[2 * JOINTS];
    double C[ROWS * 12];
    se3di_null_space_pattern pattern;
    int32_t row_count;
} mechanism;

static void build(mechanism *m, int32_t rows)
{
    size_t values = 0;
    *m = (mechanism){0};
    for (int32_t k = 0; k < JOINTS; ++k) {
        const int32_t j = k < BODIES ? k : (k + 3) % BODIES;
        const int32_t i = k < BODIES ? k - 1 - (k > 2) : k % 3;
        int32_t count = m->begin[k];
        m->rows[k] = rows;
        m->row_count += rows;
        for (int end = 0; end < 2; ++end) {
            const int32_t body = end ? j : i;
            if (body >= 0 && !(end && i == j)) {
                m->body[count] = body;
                m->offset[count++] = values;
                for (int32_t e = 0; e < 6 * rows; ++e) {
                    m->C[values++] = next();
                }
            }
        }
        m->begin[k + 1] = count;
    }
    m->pattern = (se3di_null_space_pattern){BODIES, JOINTS, m->rows, m->begin, m->body, m->offset};
}

/* One row of a joint is a combination of its others. */
static void make_redundant(mechanism *m, int32_t joint)
{
    for (int32_t e = m->begin[joint]; e < m->begin[joint + 1]; ++e) {
        double *block = m->C + m->offset[e];
        for (int c = 0; c < 6; ++c) {
            block[c] = 2.0 * block[6 + c] - 0.5 * block[12 + c];
        }
    }
}

static double worst_violation(const mechanism *m, const double *Z, int32_t freedoms)
{
    double worst = 0.0;
    for (int32_t z = 0; z < freedoms; ++z) {
        for (int32_t k = 0; k < JOINTS; ++k) {
            for (int32_t r = 0; r < m->rows[k]; ++r) {
                double sum = 0.0;
                for (int32_t e = m->begin[k]; e < m->begin[k + 1]; ++e) {
                    for (int c = 0; c < 6; ++c) {
                        sum += m->C[m->offset[e] + (size_t)(6 * r + c)] *
                               Z[N * z + 6 * m->body[e] + c];
                    }
                }
                worst = fmax(worst, fabs(sum));
            }
        }
    }
    return worst;
}

static double *find(const mechanism *m, int32_t *freedoms, int32_t *dependent)
{
    double *Z = NULL;
    CHECK(se3di_null_space_find(&heap, &m->pattern, m->C, 1e-9, &Z, freedoms, dependent, NULL) ==
          SE3D_OK);
    return Z;
}

static void what_is_left_meets_every_row(void)
{
    mechanism m;
    for (uint64_t start = 1; start < 200; ++start) {
        seed = start * 2654435761u;
        int32_t freedoms, dependent;
        const int32_t rows = 1 + (int32_t)(start % 5);
        build(&m, rows);
        double *Z = find(&m, &freedoms, &dependent);
        /* five rows hold bodies 0 to 4 twice over, but body 5 by one joint only */
        const int32_t expected = rows == 5 ? 1 : N - m.row_count;
        CHECK(freedoms == expected);
        CHECK(dependent == m.row_count - (N - expected));
        CHECK(freedoms == 0 || worst_violation(&m, Z, freedoms) < 1e-9);
        if (freedoms > 0) {
            CHECK(se3di_null_space_orthonormalise(&heap, freedoms, N, Z) == SE3D_OK);
            CHECK(worst_violation(&m, Z, freedoms) < 1e-9);
        }
        for (int32_t a = 0; a < freedoms; ++a) {
            for (int32_t b = 0; b <= a; ++b) {
                double dot = 0.0;
                for (int32_t c = 0; c < N; ++c) {
                    dot += Z[N * a + c] * Z[N * b + c];
                }
                CHECK_NEAR(dot, a == b ? 1.0 : 0.0, 1e-13);
            }
        }
        free(Z);
    }
}

static void redundant_rows_are_counted_and_take_no_freedom(void)
{
    mechanism m;
    for (uint64_t start = 1; start < 100; ++start) {
        seed = start * 2654435761u;
        int32_t freedoms, dependent;
        build(&m, 3);
        make_redundant(&m, 2);
        make_redundant(&m, 7);
        double *Z = find(&m, &freedoms, &dependent);
        CHECK(dependent == 2);
        CHECK(freedoms == N - m.row_count + 2);
        CHECK(worst_violation(&m, Z, freedoms) < 1e-9);
        free(Z);
    }
}

static void without_joints_every_body_is_free(void)
{
    mechanism m = {.row_count = 0};
    int32_t freedoms, dependent;
    m.pattern = (se3di_null_space_pattern){BODIES, 0, m.rows, m.begin, m.body, m.offset};
    double *Z = find(&m, &freedoms, &dependent);
    CHECK(freedoms == N && dependent == 0);
    for (int32_t k = 0; k < N * N; ++k) {
        CHECK_NEAR(Z[k], k / N == k % N ? 1.0 : 0.0, 0.0);
    }
    free(Z);
}

static void what_is_not_finite_is_refused(void)
{
    mechanism m;
    seed = 3;
    for (int k = 0; k < 2; ++k) {
        double *Z = NULL;
        int32_t freedoms, dependent;
        build(&m, 3);
        m.C[25] = k ? (double)NAN : HUGE_VAL;
        CHECK(se3di_null_space_find(&heap, &m.pattern, m.C, 1e-9, &Z, &freedoms, &dependent,
                                    NULL) == SE3D_ERR_NOT_FINITE);
        CHECK(Z == NULL);
    }
}

static void running_out_of_memory_holds_nothing(void)
{
    mechanism m;
    seed = 3;
    build(&m, 3);
    for (size_t allowed = 0;; ++allowed) {
        size_t left = allowed;
        const se3d_allocator short_heap = {plain_alloc, plain_realloc, plain_free, &left};
        double *Z = NULL;
        int32_t freedoms, dependent;
        se3d_status status = se3di_null_space_find(&short_heap, &m.pattern, m.C, 1e-9, &Z,
                                                   &freedoms, &dependent, NULL);
        if (status == SE3D_OK) {
            CHECK(allowed > 5);
            free(Z);
            return;
        }
        CHECK(status == SE3D_ERR_NO_MEMORY && Z == NULL);
        CHECK(allowed < 1000);
    }
}

/* Negative eigenvalues of Z H Z^T, H of blocks on the diagonal. */
static int32_t count_negative(const double *H, const double *Z, int32_t freedoms)
{
    double *R = calloc((size_t)(freedoms * freedoms), sizeof *R);
    double w[N];
    int32_t count = 0;
    for (int32_t a = 0; a < freedoms; ++a) {
        for (int32_t b = 0; b < freedoms; ++b) {
            for (int32_t k = 0; k < N * 6; ++k) {
                const int32_t row = k / 6;
                R[freedoms * a + b] += Z[N * a + row] * H[k] * Z[N * b + row / 6 * 6 + k % 6];
            }
        }
    }
    CHECK(se3di_symmetric_eigen(&heap, freedoms, R, w) == SE3D_OK);
    for (int32_t k = 0; k < freedoms; ++k) {
        count += w[k] < 0.0;
    }
    free(R);
    return count;
}

/* Sylvester: the pivots of [H C^T; C 0] tell the signs of H on the null space of C. */
static void kkt_pivots_count_freedoms_of_negative_curvature(void)
{
    mechanism m;
    int32_t seen = 0;
    for (uint64_t start = 1; start < 200; ++start) {
        seed = start * 2654435761u;
        double H[N * 6];
        int32_t freedoms, dependent;
        const double shift = start % 2 ? 0.0 : 1.2;
        se3di_kkt *kkt = NULL;
        se3di_kkt_factor_info info;
        build(&m, 1 + (int32_t)(start % 3));
        for (int32_t k = 0; k < N * 6; ++k) {
            const int32_t r = k / 6 % 6, c = k % 6;
            H[k] = next() + (r == c ? shift : 0.0);
            if (c < r) {
                H[k] = H[k / 36 * 36 + 6 * c + r];
            }
        }
        const se3di_kkt_pattern pattern = {.body_count = BODIES,
                                           .joint_count = JOINTS,
                                           .joint_rows = m.rows,
                                           .joint_begin = m.begin,
                                           .joint_body = m.body,
                                           .body_size = 6,
                                           .symmetric = true};
        CHECK(se3di_kkt_create(&heap, &pattern, SE3DI_KKT_STRUCTURED, NULL, &kkt) == SE3D_OK);
        const se3di_kkt_values values = {.body = H, .joint = m.C};
        CHECK(se3di_kkt_factor(kkt, &values, &info) >= 0);
        double *Z = find(&m, &freedoms, &dependent);
        const int32_t expected = count_negative(H, Z, freedoms);
        CHECK(info.negative_freedoms == expected);
        seen += info.negative_freedoms != info.negative_pivots;
        free(Z);
        se3di_kkt_destroy(kkt);
    }
    CHECK(seen > 20); /* pivots of bodies alone would not have told */
}

int main(void)
{
    RUN(what_is_left_meets_every_row);
    RUN(redundant_rows_are_counted_and_take_no_freedom);
    RUN(without_joints_every_body_is_free);
    RUN(what_is_not_finite_is_refused);
    RUN(running_out_of_memory_holds_nothing);
    RUN(kkt_pivots_count_freedoms_of_negative_curvature);
    return check_finish();
}
