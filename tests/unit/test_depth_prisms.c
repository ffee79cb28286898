/* SPDX-License-Identifier: BSD-3-Clause */
/* Overlap of prisms side by side against support/separation.h: stones of an arch, bricks, wedges.
 * Their edges are parallel, exactly or but for little, their ends often flush, and where they rest
 * on each other they overlap by little: much of their difference lies in planes and along lines
 * that are the same but for rounding. */
#include "contact/narrow/internal.h"
#include "contact/shape/hull.h"
#include "support/poses.h"
#include "support/separation.h"

#define SAME  5e-8 /* what overlaps less may not be known to */
#define BULGE 6e-5 /* of the radius of a rim: what its points may be less deep than it */
#define SIDES 4

/* A polygon of 3 to SIDES corners on an ellipse, between two ends. */
static void random_prism(uint64_t *seed, double half_length, poses_solid *s)
{
    const se3d_allocator allocator = se3di_alloc_default();
    const int sides = 3 + (int)poses_between(seed, 0.0, SIDES - 2.001);
    const double wide = poses_between(seed, 0.04, 0.25), high = poses_between(seed, 0.04, 0.25);
    double points[3 * 2 * SIDES];
    se3di_shape hull = {.kind = SE3DI_SHAPE_HULL};
    memset(s, 0, sizeof *s);
    s->shape.kind = SE3DI_SHAPE_HULL;
    do {
        const double first = poses_between(seed, 0.0, 6.28);
        for (int k = 0; k < sides; ++k) {
            const double angle = first + 6.28 / sides * (k + 0.3 * check_random(seed));
            for (int end = 0; end < 2; ++end) {
                double *x = points + 3 * (2 * k + end);
                x[0] = wide * cos(angle);
                x[1] = high * sin(angle);
                x[2] = end ? half_length : -half_length;
            }
        }
    } while (se3di_hull_build(&allocator, points, 2 * (size_t)sides, &hull) < 0);
    poses_take_hull(s, &hull);
    poses_link(s);
    s->shape.bound = se3di_shape_bound(&s->shape);
}

/* Turned about the axis of the other, and by `lean` about the others. */
static void turn_beside(uint64_t *seed, const se3di_shape_pose *as, double lean,
                        se3di_shape_pose *pose)
{
    const double angle = 3.1 * check_random(seed);
    const double q[4] = {cos(angle), lean * check_random(seed), lean * check_random(seed),
                         sin(angle)};
    double unit[4], turn[9];
    memset(pose, 0, sizeof *pose);
    se3di_quat_normalize(q, unit);
    se3di_quat_to_matrix(unit, turn);
    se3di_mat_mul(as->R, turn, pose->R);
}

static double deepest(const se3di_manifold *m)
{
    double most = 0.0;
    for (uint32_t k = 0; k < m->count; ++k) {
        most = fmax(most, m->points[k].overlap);
    }
    return most;
}

typedef struct tally {
    int counted, wrong;
} tally;

/* Side by side, moved until they overlap by what is wanted, see test_depth.c. */
static void try_pair(uint64_t *seed, int k, const se3di_shape *i, const se3di_shape *j, int flush,
                     tally *all)
{
    se3di_shape_pose at, of;
    se3di_manifold m;
    double n[3], along[3] = {0.0, 0.0, 0.0};
    const double lean = k % 2 == 0 ? 0.0 : pow(10.0, poses_between(seed, -15.0, -3.0));
    const int is_round = se3di_shape_is(i, SE3DI_SHAPE_HAS_RIMS);
    const double same = SAME + (is_round ? BULGE * i->radius : 0.0);
    poses_turn(seed, &of);
    turn_beside(seed, &of, lean, &at);
    for (int c = 0; c < 2; ++c) {
        along[c] = 0.1 * check_random(seed);
    }
    along[2] = flush ? 0.0 : 0.05 * check_random(seed);
    se3di_mul(of.R, along, at.x);
    const double least = separation_of(i, &at, j, &of, n);
    const double wanted = 0.03 * pow(10.0, poses_between(seed, -7.0, 0.0));
    if (!(least > wanted)) {
        return;
    }
    se3di_add_scaled(wanted - least, n, at.x);
    se3di_narrow_find(i, &at, j, &of, &m);
    const double found = deepest(&m);
    ++all->counted;
    if (!(fabs(found - wanted) < same)) {
        ++all->wrong;
        if (poses_are_many()) {
            printf("%d: overlap %.12g, not %.12g, lean %.3g, %u points\n", k, found, wanted, lean,
                   m.count);
        }
    }
}

static void check_tally(const char *what, int poses, const tally *all)
{
    if (poses_are_many()) {
        printf("%d %s, %d wrong\n", all->counted, what, all->wrong);
    }
    CHECK(2 * all->counted > poses);
    CHECK(all->wrong == 0);
}

static void prisms_side_by_side_are_as_deep_as_the_least_translation(void)
{
    const int poses = poses_count(4000);
    uint64_t seed = 21;
    tally all = {0, 0};
    for (int k = 0; k < poses; ++k) {
        poses_solid i, j;
        const int flush = k % 3 == 0;
        const double half = poses_between(&seed, 0.04, 0.25);
        random_prism(&seed, half, &i);
        random_prism(&seed, flush ? half : poses_between(&seed, 0.04, 0.25), &j);
        try_pair(&seed, k, &i.shape, &j.shape, flush, &all);
    }
    check_tally("prisms", poses, &all);
}

/* Within its length, or beyond its ends. */
static void a_log_along_a_block_is_as_deep_as_the_least_translation(void)
{
    const int poses = poses_count(4000);
    uint64_t seed = 22;
    tally all = {0, 0};
    for (int k = 0; k < poses; ++k) {
        poses_solid i, j;
        poses_random_solid(SE3DI_SHAPE_CYLINDER, &seed, &i);
        poses_random_solid(SE3DI_SHAPE_BOX, &seed, &j);
        try_pair(&seed, k, &i.shape, &j.shape, k % 3 == 0, &all);
    }
    check_tally("logs along blocks", poses, &all);
}

int main(void)
{
    RUN(prisms_side_by_side_are_as_deep_as_the_least_translation);
    RUN(a_log_along_a_block_is_as_deep_as_the_least_translation);
    return check_finish();
}
