/* SPDX-License-Identifier: BSD-3-Clause */
/* The narrow phase against brute force: the least of h_i(n) + h_j(-n) over all directions is the
 * overlap of two convex shapes, or minus their distance. */
#include "check.h"
#include "contact/narrow/internal.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "support/poses.h"

#define SOLIDS 7

static const double tetra[12] = {0.5, 0.1, -0.3, -0.4, 0.5, -0.2, -0.3, -0.5, -0.3, 0.05, 0.1, 0.6};
static const uint32_t tetra_faces[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};

static se3di_shape shape_of(int kind)
{
    se3di_shape s = {.kind = kind, .radius = 0.35, .half_length = 0.5, .half = {0.3, 0.5, 0.4}};
    s.radius = kind == SE3DI_SHAPE_CYLINDER ? 0.4 : s.radius;
    if (kind == SE3DI_SHAPE_HULL) {
        s.vertices = (double *)(uintptr_t)tetra;
        s.triangles = (uint32_t *)(uintptr_t)tetra_faces;
        s.vertex_count = s.triangle_count = 4;
    }
    s.bound = se3di_shape_bound(&s);
    return s;
}

static const int kinds[SOLIDS] = {SE3DI_SHAPE_SPHERE,   SE3DI_SHAPE_BOX,  SE3DI_SHAPE_CAPSULE,
                                  SE3DI_SHAPE_CYLINDER, SE3DI_SHAPE_HULL, SE3DI_SHAPE_ELLIPSOID,
                                  SE3DI_SHAPE_PLANE};

static void random_pose(uint64_t *seed, double spread, se3di_shape_pose *pose)
{
    poses_turn(seed, pose);
    for (int k = 0; k < 3; ++k) {
        pose->x[k] = spread * check_random(seed);
    }
}

static double reach(const se3di_solid *s, const double n[3])
{
    double p[3];
    se3di_core_support(s, n, p);
    return se3di_dot(p, n) + se3di_core_radius(s->shape);
}

static double gap_along(const se3di_solid *i, const se3di_solid *j, const double n[3])
{
    double back[3];
    se3di_scale(-1.0, n, back);
    if (j->shape->kind == SE3DI_SHAPE_PLANE) {
        double up[3] = {j->at->R[2], j->at->R[5], j->at->R[8]};
        double down[3];
        se3di_scale(-1.0, up, down);
        return reach(i, down) + se3di_dot(j->at->x, up);
    }
    return reach(i, n) + reach(j, back);
}

/* Sampled over the sphere, then refined around the best samples. */
static double brute_force(const se3di_solid *i, const se3di_solid *j)
{
    enum { SAMPLES = 1500, STARTS = 8 };
    double best[STARTS], at[STARTS][3];
    for (int k = 0; k < STARTS; ++k) {
        best[k] = HUGE_VAL;
    }
    for (int k = 0; k < SAMPLES; ++k) {
        double z = 1.0 - (2.0 * k + 1.0) / SAMPLES;
        double turn = 2.399963229728653 * k;
        double rho = sqrt(1.0 - z * z);
        double n[3] = {rho * cos(turn), rho * sin(turn), z};
        double depth = gap_along(i, j, n);
        int worst = 0;
        for (int s = 1; s < STARTS; ++s) {
            worst = best[s] > best[worst] ? s : worst;
        }
        if (depth < best[worst]) {
            best[worst] = depth;
            se3di_copy(n, at[worst]);
        }
    }
    double least = HUGE_VAL;
    for (int s = 0; s < STARTS; ++s) {
        uint64_t seed = 77;
        for (double step = 0.1; step > 1e-9; step *= 0.8) {
            for (int k = 0; k < 12; ++k) {
                double n[3];
                for (int c = 0; c < 3; ++c) {
                    n[c] = at[s][c] + step * check_random(&seed);
                }
                se3di_scale(1.0 / se3di_norm(n), n, n);
                double depth = gap_along(i, j, n);
                if (depth < best[s]) {
                    best[s] = depth;
                    se3di_copy(n, at[s]);
                }
            }
        }
        least = fmin(least, best[s]);
    }
    return least;
}

static double deepest(const se3di_manifold *m)
{
    double most = 0.0;
    for (uint32_t k = 0; k < m->count; ++k) {
        most = fmax(most, m->points[k].overlap);
    }
    return most;
}

static int is_good(const se3di_manifold *m)
{
    int good = m->count <= SE3DI_MANIFOLD_POINTS;
    for (uint32_t k = 0; good && k < m->count; ++k) {
        const se3di_contact_point *p = &m->points[k];
        good = se3di_is_finite(p->point, 3) && se3di_is_finite(p->normal, 3) &&
               isfinite(p->overlap) && p->overlap > 0.0 &&
               fabs(se3di_norm(p->normal) - 1.0) < 1e-12 &&
               fabs(se3di_norm(p->bend_i.u) - 1.0) < 1e-9 && p->bend_i.r[0] >= 0.0 &&
               p->bend_i.r[1] >= 0.0 && p->bend_j.r[0] >= 0.0 && p->bend_j.r[1] >= 0.0;
        for (uint32_t other = 0; other < k; ++other) {
            good = good && m->points[other].feature != p->feature;
        }
    }
    return good;
}

/* Points on the core of one, and of the other, are not farther from the point than the overlap. */
static int is_inside(const se3di_solid *s, const se3di_contact_point *p, double slack)
{
    double d[3], local[3], at[3], n[3], distance;
    se3di_sub(p->point, s->at->x, d);
    se3di_mul_transposed(s->at->R, d, local);
    se3di_shape_nearest(s->shape, local, at, n, &distance);
    return distance <= slack;
}

static void overlaps_equal_brute_force_for_all_pairs(void)
{
    uint64_t seed = 4711;
    for (int a = 0; a < SOLIDS - 1; ++a) {
        for (int b = a; b < SOLIDS; ++b) {
            se3di_shape one = shape_of(kinds[a]), two = shape_of(kinds[b]);
            int touching = 0;
            for (int trial = 0; trial < 25; ++trial) {
                se3di_shape_pose at_one, at_two;
                se3di_manifold m, swapped;
                random_pose(&seed, 0.2, &at_one);
                random_pose(&seed, 0.75, &at_two);
                se3di_solid i = {&one, &at_one}, j = {&two, &at_two};
                double depth = brute_force(&i, &j);
                se3di_narrow_find(&one, &at_one, &two, &at_two, &m);
                CHECK(is_good(&m));
                se3di_narrow_find(&two, &at_two, &one, &at_one, &swapped);
                CHECK(is_good(&swapped));
                CHECK((m.count > 0) == (depth > 0.0) || fabs(depth) < 1e-6);
                CHECK((swapped.count > 0) == (m.count > 0));
                touching += m.count > 0;
                if (m.count == 0 || swapped.count == 0) {
                    continue;
                }
                CHECK(deepest(&m) > 0.5 * depth - 1e-6 && deepest(&m) < depth / 0.85 + 1e-6);
                CHECK_NEAR(deepest(&swapped), deepest(&m), 0.12 * depth + 1e-9);
                for (uint32_t k = 0; k < m.count; ++k) {
                    CHECK(is_inside(&i, &m.points[k], 1.5 * m.points[k].overlap));
                    CHECK(is_inside(&j, &m.points[k], 1.5 * m.points[k].overlap));
                }
            }
            CHECK(touching > 3 && touching < 26);
        }
    }
}

static void distances_of_cores_are_exact(void)
{
    uint64_t seed = 99;
    for (int trial = 0; trial < 400; ++trial) {
        se3di_shape one = shape_of(kinds[1 + trial % 4]), two = shape_of(kinds[1 + trial / 4 % 4]);
        se3di_shape_pose at_one, at_two;
        double n[3], on_i[3], on_j[3], d[3];
        random_pose(&seed, 0.2, &at_one);
        random_pose(&seed, 0.9, &at_two);
        se3di_solid i = {&one, &at_one}, j = {&two, &at_two};
        double radii = se3di_core_radius(&one) + se3di_core_radius(&two);
        double overlap = se3di_convex_distance(&i, &j, HUGE_VAL, n, on_i, on_j);
        double sampled = brute_force(&i, &j); /* from above: its search may end on a ridge */
        CHECK(overlap + radii <= sampled + 1e-9 && overlap + radii > sampled - 5e-3);
        CHECK_NEAR(se3di_norm(n), 1.0, 1e-12);
        CHECK_NEAR(gap_along(&i, &j, n) - radii, overlap, 1e-7); /* attained along n */
        se3di_sub(on_i, on_j, d);
        se3di_add_scaled(-overlap, n, d);
        CHECK_NEAR(se3di_norm(d), 0.0, 1e-6); /* by the points */
    }
}

/* Two points at one place would be as stiff and damp as one twice that, by rounding. */
static void check_single(const se3di_manifold *m)
{
    for (uint32_t a = 0; a < m->count; ++a) {
        for (uint32_t b = 0; b < a; ++b) {
            double d[3], turn[3];
            se3di_sub(m->points[a].point, m->points[b].point, d);
            se3di_sub(m->points[a].normal, m->points[b].normal, turn);
            const double deeper = fabs(m->points[a].overlap - m->points[b].overlap);
            CHECK(se3di_norm(d) > 1e-12 || se3di_norm(turn) > 1e-9 || deeper > 1e-3);
        }
    }
}

/* Boxes, cylinders and hulls exactly on each other: shared axes, shared planes, shared centres. */
static void degenerate_poses_give_finite_contacts(void)
{
    static const double turns[4][4] = {
        {1.0, 0.0, 0.0, 0.0}, {1.0, 1.0, 0.0, 0.0}, {0.0, 0.0, 1.0, 0.0}, {1.0, 0.0, 0.0, 1.0}};
    int found = 0;
    for (int a = 0; a < SOLIDS; ++a) {
        for (int b = 0; b < SOLIDS; ++b) {
            for (int place = 0; place < 27 * 4; ++place) {
                se3di_shape one = shape_of(kinds[a]), two = shape_of(kinds[b]);
                se3di_shape_pose at_one = {.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
                se3di_shape_pose at_two = at_one;
                double p[4];
                se3di_manifold m;
                se3di_quat_normalize(turns[place / 27], p);
                se3di_quat_to_matrix(p, at_two.R);
                for (int c = 0, k = place % 27; c < 3; ++c, k /= 3) {
                    at_two.x[c] = 0.4 * (k % 3 - 1);
                }
                se3di_narrow_find(&one, &at_one, &two, &at_two, &m);
                CHECK(is_good(&m));
                check_single(&m);
                found += m.count > 0;
            }
        }
    }
    CHECK(found > 1000);
}

/* Along a path of small moves the greatest overlap never jumps. */
static void overlaps_are_continuous(void)
{
    uint64_t seed = 5;
    for (int a = 0; a < SOLIDS - 1; ++a) {
        for (int b = a; b < SOLIDS; ++b) {
            se3di_shape one = shape_of(kinds[a]), two = shape_of(kinds[b]);
            se3di_shape_pose at_one, at_two;
            double last = -1.0, way[3];
            random_pose(&seed, 0.0, &at_one);
            random_pose(&seed, 0.7, &at_two);
            for (int c = 0; c < 3; ++c) {
                way[c] = -2.0 * at_two.x[c];
            }
            for (int k = 0; k < 4000; ++k) {
                se3di_manifold m;
                se3di_add_scaled(1.0 / 4000.0, way, at_two.x);
                se3di_narrow_find(&one, &at_one, &two, &at_two, &m);
                double now = deepest(&m);
                double step = se3di_norm(way) / 4000.0;
                /* while shallow; where another face becomes the nearest the normal changes */
                if (last >= 0.0 && fmin(last, now) < 0.02) {
                    CHECK(fabs(now - last) <= 1.2 * step + 0.1 * fmin(last, now));
                }
                last = now;
            }
        }
    }
}

static void boxes_on_each_other_touch_at_four_corners(void)
{
    se3di_shape box = shape_of(SE3DI_SHAPE_BOX);
    se3di_shape_pose at = {.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
    se3di_shape_pose above = at;
    se3di_manifold m, moved;
    above.x[2] = 0.8 - 1e-3;
    se3di_narrow_find(&box, &at, &box, &above, &m);
    CHECK(m.count == 4);
    for (uint32_t k = 0; k < m.count; ++k) {
        CHECK_NEAR(m.points[k].overlap, 1e-3, 1e-15);
        CHECK_NEAR(m.points[k].normal[2], 1.0, 1e-15);
        CHECK_NEAR(fabs(m.points[k].point[0]), 0.3, 1e-12);
    }
    above.x[0] = 1e-8; /* features stay when the upper one creeps */
    above.x[1] = -1e-8;
    se3di_narrow_find(&box, &at, &box, &above, &moved);
    CHECK(moved.count == 4);
    for (uint32_t k = 0; k < 4; ++k) {
        CHECK(moved.points[k].feature == m.points[k].feature);
    }
}

/* A box that begins to touch, flat on another or on a plane that leans: by rounding some of its
 * corners are in it and others are not. All or none count. */
static void what_begins_to_touch_flat_has_all_corners(void)
{
    se3di_shape box = shape_of(SE3DI_SHAPE_BOX), plane = shape_of(SE3DI_SHAPE_PLANE);
    int found = 0;
    for (int k = 0; k < 400; ++k) {
        const double angle = 0.01 * k, p[4] = {cos(angle), 0.0, sin(angle), 0.0};
        se3di_shape_pose one = {.x = {0.3 * k, 0.1, 0.1 * k}}, two = one;
        se3di_manifold m;
        double up[3];
        se3di_quat_to_matrix(p, one.R);
        memcpy(two.R, one.R, sizeof two.R);
        for (int c = 0; c < 3; ++c) {
            up[c] = one.R[3 * c + 2];
            one.x[c] += k % 2 ? box.half[2] * up[c] : 0.0;
        }
        two.x[0] += 2.0 * box.half[2] * up[0];
        two.x[1] += 2.0 * box.half[2] * up[1];
        two.x[2] += 2.0 * box.half[2] * up[2];
        if (k % 2) { /* the plane through the lower face of the upper one */
            se3di_narrow_find(&plane, &one, &box, &two, &m);
        } else {
            se3di_narrow_find(&box, &one, &box, &two, &m);
        }
        CHECK(m.count == 0 || m.count == 4);
        found += m.count == 4;
    }
    CHECK(found > 20 && found < 380);
}

static void cylinders_stand_on_four_and_lie_on_two_points(void)
{
    se3di_shape cylinder = shape_of(SE3DI_SHAPE_CYLINDER);
    se3di_shape plane = shape_of(SE3DI_SHAPE_PLANE);
    se3di_shape_pose ground = {.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
    se3di_shape_pose at = ground;
    se3di_manifold m;
    at.x[2] = 0.5 - 1e-3;
    se3di_narrow_find(&plane, &ground, &cylinder, &at, &m);
    CHECK(m.count == 4);
    CHECK_NEAR(m.points[0].normal[2], 1.0, 1e-15);
    const double lying[9] = {0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0};
    memcpy(at.R, lying, sizeof lying);
    at.x[2] = 0.4 - 1e-3;
    se3di_narrow_find(&plane, &ground, &cylinder, &at, &m);
    CHECK(m.count == 2);
    CHECK_NEAR(m.points[0].overlap, 1e-3, 1e-12);
    CHECK_NEAR(m.points[0].point[0] + m.points[1].point[0], 0.0, 1e-12);
}

/* Of two that are pushed out of each other until they overlap by little. */
static void points_are_at_different_places(void)
{
    uint64_t seed = 77;
    const int count = poses_count(60);
    for (int a = 0; a < SOLIDS - 1; ++a) {
        for (int b = a; b < SOLIDS; ++b) {
            const se3di_shape one = shape_of(kinds[a]), two = shape_of(kinds[b]);
            for (int trial = 0; trial < count; ++trial) {
                se3di_shape_pose at_one, at_two;
                se3di_manifold m;
                random_pose(&seed, 0.2, &at_one);
                random_pose(&seed, 0.75, &at_two);
                for (int step = 0; step < 3; ++step) {
                    se3di_narrow_find(&one, &at_one, &two, &at_two, &m);
                    check_single(&m);
                    if (m.count > 0) {
                        const double by = m.points[0].overlap - 0.01 * one.bound;
                        se3di_add_scaled(by, m.points[0].normal, at_two.x);
                    }
                }
            }
        }
    }
}

/* Above an edge of a box, from the one face that ends there to the other. `lean`: by how little the
 * two are not parallel. */
static void lie_on_edge(int kind, double turn, double lean, int first)
{
    se3di_shape box = shape_of(SE3DI_SHAPE_BOX), round = shape_of(kind);
    const se3di_shape_pose at = {.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
    const double n[3] = {sin(turn), 0.0, cos(turn)}, deep = 1e-3;
    const double q[4] = {sqrt(0.5), sqrt(0.5), lean, -lean};
    double unit[4];
    se3di_shape_pose of = {.x = {box.half[0], 0.1, box.half[2]}};
    se3di_manifold m;
    se3di_quat_normalize(q, unit);
    se3di_quat_to_matrix(unit, of.R);
    se3di_add_scaled(round.radius - deep, n, of.x);
    if (first) {
        se3di_narrow_find(&round, &of, &box, &at, &m);
    } else {
        se3di_narrow_find(&box, &at, &round, &of, &m);
    }
    CHECK(m.count == 2);
    for (uint32_t k = 0; k < m.count; ++k) {
        const se3di_contact_point *p = &m.points[k];
        const double side = first ? -1.0 : 1.0;
        CHECK_NEAR(p->overlap, deep, 1e-9 + 2.0 * fabs(lean));
        CHECK_NEAR(side * se3di_dot(p->normal, n), 1.0, 1e-9);
        CHECK_NEAR(p->point[0] + 0.5 * deep * n[0], box.half[0], 1e-5);
        CHECK_NEAR(p->point[2] + 0.5 * deep * n[2], box.half[2], 1e-5);
    }
    CHECK_NEAR(fabs(m.points[0].point[1] - m.points[1].point[1]), 0.9, 1e-4); /* in common */
}

static void a_round_side_on_an_edge_touches_at_both_ends(void)
{
    static const double leans[] = {0.0, 1e-15, -1e-12, 1e-9, -1e-6};
    for (int k = 1; k < 18; ++k) {
        const double turn = 0.087 * k;
        for (size_t l = 0; l < sizeof leans / sizeof *leans; ++l) {
            for (int first = 0; first < 2; ++first) {
                lie_on_edge(SE3DI_SHAPE_CYLINDER, turn, leans[l], first);
                lie_on_edge(SE3DI_SHAPE_CAPSULE, turn, leans[l], first);
            }
        }
    }
}

int main(void)
{
    RUN(overlaps_equal_brute_force_for_all_pairs);
    RUN(distances_of_cores_are_exact);
    RUN(degenerate_poses_give_finite_contacts);
    RUN(points_are_at_different_places);
    RUN(overlaps_are_continuous);
    RUN(boxes_on_each_other_touch_at_four_corners);
    RUN(what_begins_to_touch_flat_has_all_corners);
    RUN(cylinders_stand_on_four_and_lie_on_two_points);
    RUN(a_round_side_on_an_edge_touches_at_both_ends);
    return check_finish();
}
