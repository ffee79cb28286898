/* SPDX-License-Identifier: BSD-3-Clause */
/* Ellipsoids: the nearest place against places that are known, curvature against differences, and
 * what touches them: both places are the nearest ones of each other along the normal, which tells
 * an error of the normal to first order, and no other direction has a lesser overlap. */
#include "contact/narrow/internal.h"
#include "support/poses.h"

#define EXACT 1e-10 /* of the size */

static se3di_shape ellipsoid(double a, double b, double c)
{
    const se3d_allocator allocator = se3di_alloc_default();
    se3d_shape_def def = se3d_shape_def_default();
    se3di_shape s = {.kind = SE3DI_SHAPE_ELLIPSOID};
    se3di_error error = {0};
    def.semi_axes[0] = a;
    def.semi_axes[1] = b;
    def.semi_axes[2] = c;
    CHECK(se3di_shape_define(&def, &allocator, &s, &error) == SE3D_OK);
    return s;
}

static void unit_vector(uint64_t *seed, double n[3])
{
    do {
        for (int c = 0; c < 3; ++c) {
            n[c] = check_random(seed);
        }
    } while (!(se3di_norm(n) > 0.1));
    se3di_scale(1.0 / se3di_norm(n), n, n);
}

static double apart(const double a[3], const double b[3])
{
    double d[3];
    se3di_sub(a, b, d);
    return se3di_norm(d);
}

/* From a place of the surface along its normal: outward any way, inward up to the least radius of
 * curvature, short^2 / long. */
static void nearest_places_are_those_that_the_normal_leads_back_to(void)
{
    static const double axes[][3] = {{1.0, 1.0, 1.0}, {2.0, 1.0, 0.5}, {0.5, 2.0, 1.0},
                                     {1.0, 1.0, 0.2}, {0.2, 1.0, 0.2}, {1.0, 1e-3, 0.3},
                                     {1e-3, 1.0, 1.0}};
    uint64_t seed = 5;
    for (size_t k = 0; k < sizeof axes / sizeof *axes; ++k) {
        const se3di_shape s = ellipsoid(axes[k][0], axes[k][1], axes[k][2]);
        const se3di_shape_class *kind = se3di_shape_class_of(&s);
        const double most = s.bound, least = kind->size(&s);
        for (int c = 0; c < 3000; ++c) {
            const int is_far = c % 3 == 0;
            double n[3], x[3], y[3], point[3], normal[3], distance;
            unit_vector(&seed, n);
            if (c % 5 == 0) {
                n[c % 3] = 0.0; /* on a plane of symmetry */
                se3di_scale(1.0 / se3di_norm(n), n, n);
            }
            const double d = is_far ? poses_between(&seed, 0.0, 10.0 * most)
                                    : poses_between(&seed, -0.99, 1.0) * least * least / most;
            kind->support(&s, n, x);
            se3di_copy(x, y);
            se3di_add_scaled(d, n, y);
            kind->nearest(&s, y, point, normal, &distance);
            const double slack = 1e-14 * (most + fabs(d));
            CHECK(fabs(distance - d) < slack);
            if (is_far) {
                CHECK(apart(point, x) < 1e3 * slack);
            }
            CHECK(fabs(se3di_norm(normal) - 1.0) < 1e-15);
        }
    }
}

/* In the middle, and on the flat part between the two sides, one of these is taken. */
static void from_within_the_shorter_side_is_nearest(void)
{
    const se3di_shape s = ellipsoid(1.0, 0.3, 2.0);
    const double inner[3][3] = {{0.0, 0.0, 0.0}, {0.2, 0.0, 0.5}, {-0.1, 0.0, 1.0}};
    for (int k = 0; k < 3; ++k) {
        double point[3], normal[3], distance, best = HUGE_VAL;
        uint64_t seed = 9;
        se3di_shape_nearest(&s, inner[k], point, normal, &distance);
        for (int c = 0; c < 200000; ++c) {
            double n[3], x[3];
            unit_vector(&seed, n);
            se3di_shape_class_of(&s)->support(&s, n, x);
            best = fmin(best, apart(x, inner[k]));
        }
        CHECK(-distance <= best + 1e-15 && -distance > best - 5e-3);
        CHECK(fabs(apart(point, inner[k]) + distance) < 1e-15);
        CHECK(point[1] > 0.0);
    }
}

/* dx = r0 (u.dn) u + r1 (v.dn) v: the place moves on by the radii as the normal turns. */
static void radii_of_curvature_are_those_of_differences(void)
{
    uint64_t seed = 3;
    for (int k = 0; k < 300; ++k) {
        const int is_round = k % 10 == 0;
        const double a = poses_between(&seed, 0.1, 1.0);
        const se3di_shape s = ellipsoid(a, is_round ? a : poses_between(&seed, 0.1, 1.0),
                                        is_round ? a : poses_between(&seed, 0.1, 1.0));
        const se3di_shape_class *kind = se3di_shape_class_of(&s);
        double n[3], x[3], u[2][3], r[2];
        unit_vector(&seed, n);
        kind->support(&s, n, x);
        CHECK(kind->bend(&s, x, u[0], r) == 1);
        CHECK(r[0] > 0.999999 * r[1] && r[1] > 0.0 && fabs(se3di_dot(u[0], n)) < 1e-12);
        se3di_cross(n, u[0], u[1]);
        for (int c = 0; c < 2; ++c) {
            double ends[2][3], way[3];
            for (int e = 0; e < 2; ++e) {
                double turned[3];
                se3di_copy(n, turned);
                se3di_add_scaled(e ? 1e-4 : -1e-4, u[c], turned);
                kind->support(&s, turned, ends[e]);
            }
            se3di_sub(ends[1], ends[0], way);
            se3di_add_scaled(-2e-4 * r[c], u[c], way);
            CHECK(se3di_norm(way) < 2e-4 * 1e-5 * r[0]);
        }
    }
}

static double overlap_along(const se3di_solid *i, const se3di_solid *j, const double n[3])
{
    double back[3], a[3], b[3], d[3];
    se3di_scale(-1.0, n, back);
    se3di_core_support(i, n, a);
    se3di_core_support(j, back, b);
    se3di_sub(a, b, d);
    return se3di_dot(d, n) + se3di_core_radius(i->shape) + se3di_core_radius(j->shape);
}

/* Whether a place is on the surface of a solid that looks along `out` there: the nearest one to a
 * place beyond. */
static double off_surface(const se3di_solid *solid, const double x[3], const double out[3])
{
    double beyond[3], d[3], local[3], at[3], point[3], normal[3], distance;
    se3di_copy(x, beyond);
    se3di_add_scaled(solid->shape->bound, out, beyond);
    se3di_sub(beyond, solid->at->x, d);
    se3di_mul_transposed(solid->at->R, d, local);
    se3di_shape_nearest(solid->shape, local, at, normal, &distance);
    se3di_solid_to_ground(solid, at, point);
    return apart(point, x);
}

static void check_touch(const se3di_solid *i, const se3di_solid *j, const se3di_contact_point *p,
                        uint64_t *seed)
{
    const double size = i->shape->bound + j->shape->bound;
    double on_i[3], on_j[3], back[3];
    se3di_scale(-1.0, p->normal, back);
    se3di_copy(p->point, on_i);
    se3di_copy(p->point, on_j);
    se3di_add_scaled(p->share * p->overlap, p->normal, on_i);
    se3di_add_scaled((p->share - 1.0) * p->overlap, p->normal, on_j);
    CHECK(off_surface(i, on_i, p->normal) < EXACT * size);
    CHECK(off_surface(j, on_j, back) < EXACT * size);
    CHECK(fabs(overlap_along(i, j, p->normal) - p->overlap) < 1e-14 * size);
    for (int k = 0; k < 400; ++k) {
        double n[3];
        unit_vector(seed, n);
        se3di_scale(k % 2 ? 1.0 : pow(10.0, -k / 80), n, n);
        se3di_add_scaled(k % 2 ? 0.0 : 1.0, p->normal, n);
        se3di_scale(1.0 / se3di_norm(n), n, n);
        CHECK(overlap_along(i, j, n) > p->overlap - 1e-14 * size);
    }
}

/* Shallow and deep, of all that is convex; `far`: up to a hundred times as long as thick. */
static void touch_all(double far)
{
    static const int kinds[] = {SE3DI_SHAPE_ELLIPSOID, SE3DI_SHAPE_BOX,      SE3DI_SHAPE_HULL,
                                SE3DI_SHAPE_CAPSULE,   SE3DI_SHAPE_CYLINDER, SE3DI_SHAPE_SPHERE};
    uint64_t seed = 70;
    for (int k = 0; k < 6; ++k) {
        int found = 0;
        for (int pose = 0; pose < poses_count(150); ++pose) {
            poses_solid other;
            se3di_shape_pose at, of;
            se3di_manifold m;
            const se3di_shape s =
                ellipsoid(poses_between(&seed, 0.1, 0.3), poses_between(&seed, 0.1, 0.3),
                          poses_between(&seed, 0.1, 0.3) / far);
            poses_random_solid(kinds[k], &seed, &other);
            poses_turn(&seed, &at);
            poses_turn(&seed, &of);
            for (int c = 0; c < 3; ++c) {
                of.x[c] = 0.35 * check_random(&seed);
            }
            const se3di_solid i = {&s, &at}, j = {&other.shape, &of};
            se3di_narrow_find(&s, &at, &other.shape, &of, &m);
            if (kinds[k] == SE3DI_SHAPE_HULL && m.count > 0) {
                double inner[3], d[3], local[3], point[3], normal[3], distance;
                poses_inner(&other.shape, &of, inner); /* nearest() of a hull is not as exact */
                se3di_sub(inner, at.x, d);
                se3di_mul_transposed(at.R, d, local);
                se3di_shape_nearest(&s, local, point, normal, &distance);
                m.count = distance > 0.0 ? m.count : 0;
            }
            CHECK(m.count <= 1);
            if (m.count == 1) {
                check_touch(&i, &j, &m.points[0], &seed);
                ++found;
            }
        }
        CHECK(found > poses_count(150) / 10);
    }
}

static void what_is_convex_touches_in_the_point_of_the_least_overlap(void)
{
    touch_all(1.0);
    touch_all(100.0);
}

/* How far two are apart, to the same accuracy: along the normal. */
static void gaps_are_exact(void)
{
    uint64_t seed = 12;
    for (int k = 0; k < 500; ++k) {
        se3di_shape_pose at, of;
        double n[3], back[3];
        const se3di_shape s = ellipsoid(0.1, 0.2, 0.05), t = ellipsoid(0.2, 0.02, 0.1);
        poses_turn(&seed, &at);
        poses_turn(&seed, &of);
        unit_vector(&seed, n);
        se3di_scale(poses_between(&seed, 0.41, 2.0), n, of.x);
        const se3di_solid i = {&s, &at}, j = {&t, &of};
        const double gap = se3di_narrow_gap(&s, &at, &t, &of, n);
        double a[3], b[3], d[3];
        se3di_scale(-1.0, n, back);
        se3di_core_support(&i, n, a);
        se3di_core_support(&j, back, b);
        se3di_sub(b, a, d);
        se3di_add_scaled(-gap, n, d);
        CHECK(se3di_norm(d) < EXACT);
    }
}

/* All three axes alike: the contacts of a sphere, on all there is. */
static void a_ball_is_a_sphere(void)
{
    static const double corners[12] = {-2.0, -2.0, 0.0, 2.0,  -2.0, 0.1,
                                       2.0,  2.0,  0.3, -2.0, 2.0,  -0.2};
    static const uint32_t triangles[6] = {0, 1, 2, 0, 2, 3};
    const se3d_allocator allocator = se3di_alloc_default();
    se3d_shape_def def = se3d_shape_def_default();
    se3di_error error = {0};
    uint64_t seed = 31;
    se3di_shape shapes[4] = {{.kind = SE3DI_SHAPE_PLANE},
                             {.kind = SE3DI_SHAPE_BOX},
                             {.kind = SE3DI_SHAPE_CAPSULE},
                             {.kind = SE3DI_SHAPE_MESH}};
    def.size[0] = def.size[1] = def.size[2] = 1.0;
    def.radius = 0.4;
    def.length = 0.8;
    def.vertices = corners;
    def.vertex_count = 4;
    def.triangles = triangles;
    def.triangle_count = 2;
    for (int k = 0; k < 4; ++k) {
        int found = 0;
        CHECK(se3di_shape_define(&def, &allocator, &shapes[k], &error) == SE3D_OK);
        for (int pose = 0; pose < 300; ++pose) {
            const se3di_shape ball = ellipsoid(0.2, 0.2, 0.2);
            const se3di_shape sphere = {.kind = SE3DI_SHAPE_SPHERE, .radius = 0.2, .bound = 0.2};
            se3di_shape_pose at, of;
            se3di_manifold m, wanted;
            poses_turn(&seed, &at);
            poses_turn(&seed, &of);
            for (int c = 0; c < 3; ++c) {
                at.x[c] = check_random(&seed);
            }
            se3di_narrow_find(&ball, &at, &shapes[k], &of, &m);
            se3di_narrow_find(&sphere, &at, &shapes[k], &of, &wanted);
            if (wanted.count > 0 && wanted.points[0].overlap > 0.15) {
                continue; /* not the deep ones: a sphere's centre takes sides of its own */
            }
            CHECK(m.count == wanted.count);
            found += (int)m.count;
            for (uint32_t c = 0; c < m.count && m.count == wanted.count; ++c) {
                CHECK(fabs(m.points[c].overlap - wanted.points[c].overlap) < 1e-12);
                CHECK(apart(m.points[c].normal, wanted.points[c].normal) < 1e-9);
            }
        }
        CHECK(found > 20);
        se3di_shape_release(&allocator, &shapes[k]);
    }
}

static void lengths_that_are_not_positive_are_refused(void)
{
    const se3d_allocator allocator = se3di_alloc_default();
    for (int k = 0; k < 3; ++k) {
        se3d_shape_def def = se3d_shape_def_default();
        se3di_shape s = {.kind = SE3DI_SHAPE_ELLIPSOID};
        se3di_error error = {0};
        def.semi_axes[0] = def.semi_axes[1] = def.semi_axes[2] = 1.0;
        def.semi_axes[k] = k == 2 ? -1.0 : 0.0;
        CHECK(se3di_shape_define(&def, &allocator, &s, &error) == SE3D_ERR_INVALID_ARGUMENT);
    }
}

int main(void)
{
    RUN(nearest_places_are_those_that_the_normal_leads_back_to);
    RUN(from_within_the_shorter_side_is_nearest);
    RUN(radii_of_curvature_are_those_of_differences);
    RUN(what_is_convex_touches_in_the_point_of_the_least_overlap);
    RUN(gaps_are_exact);
    RUN(a_ball_is_a_sphere);
    RUN(lengths_that_are_not_positive_are_refused);
    return check_finish();
}
