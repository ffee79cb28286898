/* SPDX-License-Identifier: BSD-3-Clause */
/* What two shapes are to each other does not depend on which is the first, on where both are, or on
 * the unit of length: overlaps and normals of random pairs are the same. */
#include "contact/narrow/internal.h"
#include "support/poses.h"

#define SAME 1e-9 /* of the size */

enum { SOLIDS = 6 };
static const int kinds[SOLIDS] = {SE3DI_SHAPE_BOX,     SE3DI_SHAPE_HULL,   SE3DI_SHAPE_CYLINDER,
                                  SE3DI_SHAPE_CAPSULE, SE3DI_SHAPE_SPHERE, SE3DI_SHAPE_ELLIPSOID};
static const char *const names[SOLIDS] = {"box",     "hull",   "cylinder",
                                          "capsule", "sphere", "ellipsoid"};

typedef struct pair {
    poses_solid i, j;
    se3di_shape_pose at, of;
} pair;

static void link_hull(poses_solid *s)
{
    if (s->shape.kind == SE3DI_SHAPE_HULL) {
        poses_link(s);
        se3di_hull_set_planes(&s->shape);
    }
}

/* `far`: the most that the origins are apart along each axis. */
static void random_pair(int one, int two, double far, uint64_t *seed, pair *p)
{
    poses_random_solid(kinds[one], seed, &p->i);
    poses_random_solid(kinds[two], seed, &p->j);
    poses_turn(seed, &p->of);
    poses_turn(seed, &p->at);
    if (check_random(seed) > 0.4) {
        poses_lean(seed, &p->of, &p->at);
    }
    for (int c = 0; c < 3; ++c) {
        p->at.x[c] = far * check_random(seed);
    }
}

static void scale_solid(poses_solid *s, double unit)
{
    s->shape.radius *= unit;
    s->shape.half_length *= unit;
    for (int c = 0; c < 3; ++c) {
        s->shape.half[c] *= unit;
    }
    for (int k = 0; k < 3 * POSES_CORNERS; ++k) {
        s->vertices[k] *= unit;
    }
    link_hull(s);
    s->shape.bound = se3di_shape_bound(&s->shape);
}

/* Longer by `unit`; and turned and moved together if there is a motion. */
static pair change(const pair *from, double unit, const se3di_shape_pose *motion)
{
    pair p = *from;
    scale_solid(&p.i, unit);
    scale_solid(&p.j, unit);
    for (int k = 0; k < 2; ++k) {
        se3di_shape_pose *at = k ? &p.of : &p.at;
        double x[3], R[9];
        se3di_scale(unit, at->x, at->x);
        if (motion) {
            se3di_mul(motion->R, at->x, x);
            se3di_add(x, motion->x, at->x);
            se3di_mat_mul(motion->R, at->R, R);
            memcpy(at->R, R, sizeof R);
        }
    }
    return p;
}

/* The deepest overlap; 0: none. */
static double deepest(const pair *p, int is_swapped, double n[3])
{
    se3di_manifold m;
    double most = 0.0;
    if (is_swapped) {
        se3di_narrow_find(&p->j.shape, &p->of, &p->i.shape, &p->at, &m);
    } else {
        se3di_narrow_find(&p->i.shape, &p->at, &p->j.shape, &p->of, &m);
    }
    memset(n, 0, 3 * sizeof *n);
    for (uint32_t k = 0; k < m.count; ++k) {
        if (m.points[k].overlap > most) {
            most = m.points[k].overlap;
            se3di_scale(is_swapped ? -1.0 : 1.0, m.points[k].normal, n);
        }
    }
    return most;
}

typedef struct tally {
    int touching, depth, normal;
    double most;
} tally;

/* Directions may differ where two are equally deep: a few. */
static void compare(double wanted, const double n[3], double found, const double m[3], double size,
                    tally *t)
{
    double turn[3];
    se3di_sub(n, m, turn);
    t->most = fmax(t->most, fabs(found - wanted) / size);
    t->depth += fabs(found - wanted) > SAME * size;
    t->normal += se3di_norm(turn) > 100.0 * SAME && wanted > 1e-6 * size;
}

static void check_pair(int one, int two, double far, int poses)
{
    static const double units[3] = {1e-3, 1.0, 1e3};
    uint64_t seed = 900 + 10 * (uint64_t)one + (uint64_t)two;
    tally t = {.touching = 0};
    for (int k = 0; k < poses; ++k) {
        pair p;
        double n[3], m[3], back[3];
        se3di_shape_pose motion;
        random_pair(one, two, far, &seed, &p);
        link_hull(&p.i);
        link_hull(&p.j);
        const double size = poses_size(&p.i.shape);
        const double wanted = deepest(&p, 0, n);
        t.touching += wanted > 0.0;
        compare(wanted, n, deepest(&p, 1, m), m, size, &t);
        poses_turn(&seed, &motion);
        for (int c = 0; c < 3; ++c) {
            motion.x[c] = 2.0 * check_random(&seed);
        }
        for (int u = 0; u < 3; ++u) {
            pair q = change(&p, units[u], u == 1 ? &motion : NULL);
            link_hull(&q.i);
            link_hull(&q.j);
            const double found = deepest(&q, 0, m) / units[u];
            se3di_mul_transposed(motion.R, m, back);
            compare(wanted, n, found, u == 1 ? back : m, size, &t);
        }
    }
    if (poses_are_many()) {
        printf("%s, %s: %d touching, %d other depths, up to %.2g, %d other normals\n", names[one],
               names[two], t.touching, t.depth, t.most, t.normal);
    }
    CHECK(t.touching > poses / 8);
    CHECK(t.depth == 0);
    CHECK(100 * t.normal <= poses);
}

static void overlaps_do_not_depend_on_frame_order_or_unit(void)
{
    for (int one = 0; one < SOLIDS; ++one) {
        for (int two = 0; two < SOLIDS; ++two) {
            check_pair(one, two, 0.3, poses_count(200));
        }
    }
}

/* Far in each other they have many directions that are nearly the least. */
static void deep_overlaps_do_not_depend_on_frame_order_or_unit(void)
{
    for (int one = 0; one < SOLIDS; ++one) {
        for (int two = 0; two < SOLIDS; ++two) {
            const int is_two_rims = kinds[one] == SE3DI_SHAPE_CYLINDER && one == two;
            check_pair(one, two, 0.1, poses_count(is_two_rims ? 100 : 1000));
        }
    }
}

int main(void)
{
    RUN(overlaps_do_not_depend_on_frame_order_or_unit);
    RUN(deep_overlaps_do_not_depend_on_frame_order_or_unit);
    return check_finish();
}
