/* SPDX-License-Identifier: BSD-3-Clause */
/* KKT systems in lanes: each lane has the bits of its state alone, on random mechanisms. */
#include "linsol/kkt_lanes.h"

#include <math.h>

#include "check.h"
#include "test_linsol.h"

enum { WIDEST = SE3DI_KKT_LANES_MAX };

static mechanism states[WIDEST]; /* too large for the stack */

/* The numbers of all lanes. */
typedef struct side_by_side {
    double body[MAX_BODIES * 64 * WIDEST], upper[MAX_COUPLINGS * 64 * WIDEST];
    double joint[MAX_ENTRIES * 64 * WIDEST];
    double b[MAX_BODIES * 8 * WIDEST], c[MAX_JOINTS * 64 * WIDEST];
    double x[MAX_BODIES * 8 * WIDEST], l[MAX_JOINTS * 64 * WIDEST];
} side_by_side;

static _Alignas(64) side_by_side all;

static void put(size_t count, size_t width, size_t lane, const double *from, double *to)
{
    for (size_t i = 0; i < count; ++i) {
        to[i * width + lane] = from[i];
    }
}

static size_t count_joint_values(const mechanism *s)
{
    size_t sum = 0;
    for (size_t j = 0; j < s->pattern.joint_count; ++j) {
        sum += (size_t)((s->begin[j + 1] - s->begin[j]) * s->rows[j] * s->pattern.body_size);
    }
    return sum;
}

static void put_all(size_t width)
{
    for (size_t lane = 0; lane < width; ++lane) {
        const mechanism *s = &states[lane];
        const size_t n = (size_t)s->pattern.body_size;
        put(s->unknowns * n, width, lane, s->body, all.body);
        put(s->pattern.coupling_count * n * n, width, lane, s->upper, all.upper);
        put(count_joint_values(s), width, lane, s->joint, all.joint);
        put(s->unknowns, width, lane, s->b, all.b);
        put(s->row_count, width, lane, s->c, all.c);
    }
}

static se3di_kkt *create(const se3di_kkt_settings *settings)
{
    se3di_kkt *kkt = NULL;
    CHECK(se3di_kkt_create(&memory, &states[0].pattern, SE3DI_KKT_STRUCTURED, NULL, &kkt) ==
          SE3D_OK);
    if (kkt && settings) {
        se3di_kkt_set_settings(kkt, settings);
    }
    return kkt;
}

/* Whether lane and state alone agree in all bits, and in their status. */
static void compare_lane(se3di_kkt *alone, size_t width, size_t lane, int with_c,
                         const se3di_kkt_lanes_info *info)
{
    mechanism *s = &states[lane];
    se3d_status status = se3di_kkt_factor(alone, &s->values, NULL);
    const int is_factored = status >= 0;
    if (is_factored) {
        status = se3di_kkt_solve(alone, &s->values, s->b, with_c ? s->c : NULL, s->x, s->l, NULL);
    }
    CHECK(info->status[lane] == status);
    for (size_t i = 0; is_factored && i < s->unknowns; ++i) {
        CHECK(memcmp(&s->x[i], &all.x[i * width + lane], sizeof(double)) == 0);
    }
    for (size_t i = 0; is_factored && i < s->row_count; ++i) {
        CHECK(memcmp(&s->l[i], &all.l[i * width + lane], sizeof(double)) == 0);
    }
}

/* @return lanes that were alone */
static int compare(size_t width, int with_c, const se3di_kkt_settings *settings)
{
    se3di_kkt *kkt = create(settings), *alone = create(settings);
    se3di_kkt_lanes *lanes = NULL;
    se3di_kkt_lanes_info info;
    const se3di_kkt_values values = {
        .body = all.body, .coupling_upper = all.upper, .joint = all.joint};
    int count = 0;
    put_all(width);
    CHECK(se3di_kkt_lanes_create(&memory, kkt, (int32_t)width, &lanes) == SE3D_OK);
    for (int again = 0; lanes && again < 2; ++again) {
        const size_t calls = memory_counter.calls;
        (void)se3di_kkt_lanes_solve(lanes, &values, all.b, with_c ? all.c : NULL, all.x, all.l,
                                    &info);
        CHECK(memory_counter.calls == calls);
        for (size_t lane = 0; lane < width; ++lane) {
            compare_lane(alone, width, lane, with_c, &info);
            count += again && info.is_alone[lane];
        }
    }
    se3di_kkt_lanes_destroy(lanes);
    se3di_kkt_destroy(alone);
    se3di_kkt_destroy(kkt);
    return count;
}

/* The widths of this processor. */
static size_t list_widths(size_t widths[3])
{
    size_t count = 0;
    for (size_t width = 1; width <= (size_t)se3di_kkt_lanes_widest(); width = width == 1 ? 4 : 8) {
        widths[count++] = width;
        if (width == 8) {
            break;
        }
    }
    return count;
}

/* What filters of explicit methods ask for. */
static se3di_kkt_settings filter(void)
{
    return (se3di_kkt_settings){
        .eps = 1e-9, .eps_min = 1e-9, .tolerance = 1e-13, .max_refinements = 10};
}

/* ---- together ---- */

static void trees_have_the_bits_of_each_state_alone(void)
{
    size_t widths[3];
    const size_t count = list_widths(widths);
    for (int32_t n = 1; n <= 7; ++n) {
        for (uint64_t seed = 1; seed <= 6; ++seed) {
            for (size_t lane = 0; lane < WIDEST; ++lane) {
                mechanism *s = &states[lane];
                start(s, 12, n, true, seed);
                add_tree(s, n < 6 ? 1 + (n - 1) / 2 : 0);
                s->seed += 97 * lane;
                fill(s);
            }
            for (size_t k = 0; k < count; ++k) {
                CHECK(compare(widths[k], seed % 2 == 0, NULL) < (int)widths[k]);
            }
        }
    }
}

static void mass_blocks_and_couplings_have_the_bits_of_each_state_alone(void)
{
    size_t widths[3];
    const size_t count = list_widths(widths);
    for (uint64_t seed = 1; seed <= 12; ++seed) {
        for (size_t lane = 0; lane < WIDEST; ++lane) {
            mechanism *s = &states[lane];
            start(s, 20, 6, true, seed);
            s->pattern.body_kind = SE3DI_KKT_BODY_MASS;
            add_tree(s, seed % 3 == 0 ? 5 : 0);
            if (seed % 2 == 0) {
                add_coupling(s, 1, 7);
                add_coupling(s, 0, 19);
            }
            s->seed += 97 * lane;
            fill(s);
        }
        for (size_t k = 0; k < count; ++k) {
            CHECK(compare(widths[k], 1, NULL) < (int)widths[k]);
        }
    }
}

/* A joint whose rows are far smaller than the others, or a body that turns far more easily. */
static void make_uneven(mechanism *s, uint64_t kind)
{
    for (size_t i = 0; kind == 2 && i < 12; ++i) {
        s->joint[i] *= 1e-5;
    }
    for (size_t i = 21; kind == 3 && i < 36; ++i) { /* J of diag(m, m, m, J) */
        s->body[i] *= 1e-3;
    }
}

/* Loops are regularised: solutions are refined. */
static void loops_have_the_bits_of_each_state_alone(void)
{
    size_t widths[3];
    const size_t count = list_widths(widths);
    const se3di_kkt_settings settings = filter();
    size_t number = 0, alone = 0;
    for (uint64_t seed = 1; seed <= 12; ++seed) {
        for (size_t lane = 0; lane < WIDEST; ++lane) {
            mechanism *s = &states[lane];
            start(s, 14, 6, true, seed);
            s->pattern.body_kind = seed % 2 ? SE3DI_KKT_BODY_MASS : SE3DI_KKT_BODY_FULL;
            add_tree(s, 2);
            add_joint(s, 2, 3, 11);
            add_joint(s, 9, 5, 9); /* two nodes */
            if (seed % 3 == 0) {
                add_coupling(s, 2, 8);
            }
            s->seed += 97 * lane;
            fill(s);
            make_uneven(s, seed % 4);
        }
        for (size_t k = 0; k < count; ++k) {
            number += widths[k];
            alone += (size_t)compare(widths[k], 1, &settings);
            CHECK(compare(widths[k], 1, NULL) == (int)widths[k]);
        }
    }
    CHECK(2 * alone < number);
}

/* ---- alone ---- */

static void lanes_that_need_more_are_solved_alone_and_leave_the_others(void)
{
    const size_t width = (size_t)se3di_kkt_lanes_widest();
    const se3di_kkt_settings settings = filter();
    for (int kind = 0; kind < 4; ++kind) {
        for (size_t lane = 0; lane < WIDEST; ++lane) {
            mechanism *s = &states[lane];
            start(s, 10, 6, true, 5);
            add_chain(s, 4);
            add_joint(s, 2, 2, 7);
            s->seed += 97 * lane;
            fill(s);
        }
        /* in lane 0 both rows of the last joint are the same, or numbers are bad */
        for (size_t r = 0; kind == 0 && r < 6; ++r) {
            double *last = states[0].joint + count_joint_values(&states[0]) - 24;
            last[6 + r] = last[r];
            last[18 + r] = last[12 + r];
        }
        mechanism *odd = &states[0];
        odd->body[14] = kind == 1 ? (double)NAN : kind == 2 ? -3.0 : odd->body[14];
        odd->b[3] = kind == 3 ? HUGE_VAL : odd->b[3];
        const int alone = compare(width, 1, &settings);
        CHECK(alone >= 1 && (width == 1 || alone < (int)width));
    }
}

/* A body without inertia, a joint without bodies, no joints at all. */
static void degenerate_systems_have_the_bits_of_each_state_alone(void)
{
    size_t widths[3];
    const size_t count = list_widths(widths);
    for (int kind = 0; kind < 3; ++kind) {
        for (size_t lane = 0; lane < WIDEST; ++lane) {
            mechanism *s = &states[lane];
            start(s, 3, 6, true, 3 + lane);
            if (kind < 2) {
                add_chain(s, 5);
            }
            fill(s);
            if (kind == 0) {
                memset(s->body, 0, 36 * sizeof *s->body);
            } else if (kind == 1) {
                add_joint(s, 5, -1, -1);
                s->row_count += 5;
            }
        }
        for (size_t k = 0; k < count; ++k) {
            CHECK(compare(widths[k], 1, NULL) == (kind < 2 ? (int)widths[k] : 0));
        }
    }
}

/* ---- misuse, memory ---- */

static void solvers_that_have_no_lanes_are_refused(void)
{
    const struct {
        int32_t n, width;
        bool symmetric;
        se3di_kkt_kind kind;
    } rows[] = {
        {8, 1, true, SE3DI_KKT_STRUCTURED},  {6, 1, false, SE3DI_KKT_STRUCTURED},
        {6, 1, true, SE3DI_KKT_DENSE},       {6, 2, true, SE3DI_KKT_STRUCTURED},
        {6, 0, true, SE3DI_KKT_STRUCTURED},  {6, -4, true, SE3DI_KKT_STRUCTURED},
        {6, 16, true, SE3DI_KKT_STRUCTURED},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        se3di_kkt *kkt = NULL;
        se3di_kkt_lanes *lanes = (se3di_kkt_lanes *)(void *)&all;
        start(&states[0], 2, rows[k].n, rows[k].symmetric, 1);
        add_chain(&states[0], 5);
        CHECK(se3di_kkt_create(&memory, &states[0].pattern, rows[k].kind, NULL, &kkt) == SE3D_OK);
        CHECK(se3di_kkt_lanes_create(&memory, kkt, rows[k].width, &lanes) ==
              SE3D_ERR_INVALID_ARGUMENT);
        CHECK(!lanes);
        se3di_kkt_destroy(kkt);
    }
    se3di_kkt_lanes_destroy(NULL);
}

static void a_failing_allocation_leaves_nothing_behind(void)
{
    start(&states[0], 6, 6, true, 2);
    add_chain(&states[0], 5);
    se3di_kkt *kkt = create(NULL);
    const long before = memory_counter.bytes;
    for (size_t at = 1; at <= 3; ++at) {
        se3di_kkt_lanes *lanes = NULL;
        memory_counter.calls = 0;
        memory_counter.fail_at = at;
        const se3d_status status = se3di_kkt_lanes_create(&memory, kkt, 1, &lanes);
        CHECK(status == (at < 3 ? SE3D_ERR_NO_MEMORY : SE3D_OK) && (status < 0) == !lanes);
        se3di_kkt_lanes_destroy(lanes);
        CHECK(memory_counter.bytes == before);
    }
    memory_counter.fail_at = SIZE_MAX;
    se3di_kkt_destroy(kkt);
}

int main(void)
{
    RUN(trees_have_the_bits_of_each_state_alone);
    RUN(mass_blocks_and_couplings_have_the_bits_of_each_state_alone);
    RUN(loops_have_the_bits_of_each_state_alone);
    RUN(lanes_that_need_more_are_solved_alone_and_leave_the_others);
    RUN(degenerate_systems_have_the_bits_of_each_state_alone);
    RUN(solvers_that_have_no_lanes_are_refused);
    RUN(a_failing_allocation_leaves_nothing_behind);
    CHECK(memory_counter.bytes == 0);
    return check_finish();
}
