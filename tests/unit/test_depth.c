/* SPDX-License-Identifier: BSD-3-Clause */
/* Overlap and normal of two convex shapes against support/separation.h: both right to 1e-9 for
 * every pair, and every point of contact within both.
 *
 * From any pose where two overlap by d along n, the pose that is moved by d - w along n overlaps by
 * w along n and by more in all other directions: the ball about the origin in the difference of the
 * two has moved to where it touches first. So no pose is ambiguous, and any depth is had. */
#include "contact/narrow/internal.h"
#include "contact/shape/hull.h"
#include "support/poses.h"
#include "support/separation.h"
#include "support/surfaces.h"

#define SAME  1e-9
#define BULGE 6e-5 /* of the radius of a rim: what its four points may be less deep than it */
#define CLEAR 1e-8
#define KINDS 5

static const int kinds[KINDS] = {SE3DI_SHAPE_BOX, SE3DI_SHAPE_HULL, SE3DI_SHAPE_CYLINDER,
                                 SE3DI_SHAPE_CAPSULE, SE3DI_SHAPE_SPHERE};
static const char *const names[KINDS] = {"box", "hull", "cylinder", "capsule", "sphere"};

static const se3di_contact_point *deepest(const se3di_manifold *m)
{
    const se3di_contact_point *best = &m->points[0];
    for (uint32_t k = 1; k < m->count; ++k) {
        best = m->points[k].overlap > best->overlap ? &m->points[k] : best;
    }
    return best;
}

typedef struct accuracy {
    int counted, wrong, outside, less, phantom;
    int kinds[3][3]; /* by what touches of i and of j */
    double depth, normal, beyond;
} accuracy;

/* What of a shape is farthest along n: 0 a corner or a point of a rim, 1 an edge or a side, 2 a
 * face or a cap. */
static int feature_of(const poly *p, const double n[3])
{
    int count = 0;
    double at[3];
    if (p->is_cylinder) {
        const double along = fabs(se3di_dot(n, p->z));
        return along > 1.0 - 1e-12 ? 2 : along < SAME;
    }
    const double most = poly_reach(p, n, at);
    for (int k = 0; k < p->points; ++k) {
        count += se3di_dot(p->point[k], n) > most - SAME;
    }
    return count > 2 ? 2 : count - 1;
}

/* How far a place is outside a shape. */
static double outside(const se3di_shape *s, const se3di_shape_pose *at, const double x[3])
{
    double d[3], local[3], point[3], normal[3], distance;
    se3di_sub(x, at->x, d);
    se3di_mul_transposed(at->R, d, local);
    se3di_shape_nearest(s, local, point, normal, &distance);
    return distance;
}

/* Each point is the middle of a line along the normal that is as long as its overlap, in both. */
static double beyond_of(const se3di_shape *i, const se3di_shape_pose *at, const se3di_shape *j,
                        const se3di_shape_pose *of, const se3di_manifold *m)
{
    double most = 0.0;
    for (uint32_t k = 0; k < m->count; ++k) {
        const se3di_contact_point *p = &m->points[k];
        for (int end = -1; end <= 1; end += 2) {
            double x[3];
            const double share = end < 0 ? 1.0 - p->share : p->share;
            se3di_copy(p->point, x);
            se3di_add_scaled(end * share * p->overlap, p->normal, x);
            most = fmax(most, end > 0 ? outside(i, at, x) : outside(j, of, x));
        }
    }
    return most;
}

static void show(const se3di_shape *i, const se3di_shape *j, double wanted, const double n[3],
                 const se3di_contact_point *p)
{
    if (poses_are_many()) {
        printf("kinds %d %d: overlap %.15g, not %.15g; normal %.12g %.12g %.12g, not %.12g %.12g "
               "%.12g\n",
               i->kind, j->kind, p ? p->overlap : 0.0, wanted, p ? p->normal[0] : 0.0,
               p ? p->normal[1] : 0.0, p ? p->normal[2] : 0.0, n[0], n[1], n[2]);
    }
}

/* An axis of the one, of a round one that of its side, is nearly parallel to the other's side. */
static int is_along(const se3di_solid *one, const se3di_solid *two)
{
    double u[3], w[3], across[3];
    int along = 0;
    const int is_round = se3di_shape_class_of(one->shape)->lines == SE3DI_AXES_Z;
    se3di_solid_axis(two, 2, w);
    for (int axis = is_round ? 2 : 0; axis < 3; ++axis) {
        se3di_solid_axis(one, axis, u);
        se3di_cross(u, w, across);
        along |= se3di_norm(across) < 1e-2;
    }
    return along && (is_round || one->shape->kind == SE3DI_SHAPE_BOX) &&
           se3di_shape_class_of(two->shape)->lines == SE3DI_AXES_Z;
}

/* Two round sides that are nearly parallel, or one and an edge of a box: their points have normals
 * of their own, which lean from that of the least translation by what the two do, and are as deep
 * as the two. */
static int are_along(const se3di_shape *i, const se3di_shape_pose *at, const se3di_shape *j,
                     const se3di_shape_pose *of)
{
    const se3di_solid one = {i, at}, two = {j, of};
    return is_along(&one, &two) || is_along(&two, &one);
}

static double rim_of(const se3di_shape *shape)
{
    return se3di_shape_is(shape, SE3DI_SHAPE_HAS_RIMS) ? shape->radius : 0.0;
}

/* `convex`: j, or the convex solid whose surface it is. Along any direction the overlap bounds the
 * least one: one that is less than that found here is
 * right if it is that along its own normal. Normals may differ where these are equal to rounding.
 */
static void compare(const se3di_shape *i, const se3di_shape_pose *at, const se3di_shape *j,
                    const se3di_shape_pose *of, const se3di_shape *convex, double wanted,
                    const double n[3], accuracy *a)
{
    static poly one, two;
    se3di_manifold m;
    double turn[3] = {1.0, 0.0, 0.0}, back[3], v[3], off = 1.0, along = HUGE_VAL;
    se3di_narrow_find(i, at, j, of, &m);
    const se3di_contact_point *p = m.count > 0 ? deepest(&m) : NULL;
    poly_of(i, at, &one);
    poly_of(convex, of, &two);
    se3di_scale(-1.0, n, back);
    ++a->kinds[feature_of(&one, n)][feature_of(&two, back)];
    if (p) {
        along = overlap_along(&one, &two, p->normal, v) + one.radius + two.radius;
        se3di_sub(p->normal, n, turn);
        off = fabs(p->overlap - wanted);
    }
    const double same_depth = SAME + BULGE * (rim_of(i) + rim_of(j));
    const double beyond = j->kind == SE3DI_SHAPE_MESH ? 0.0 : beyond_of(i, at, j, of, &m);
    const double lean = se3di_norm(turn);
    const int less = p && along < wanted - 1e-12 && fabs(p->overlap - along) < same_depth;
    const int along_sides = are_along(i, at, j, of);
    const double most = 2e-5 + (along_sides ? 0.3 : 1e-2) * wanted;
    const int same = off < same_depth && (lean < (along_sides ? 0.05 : SAME) ||
                                          (lean < 10.0 * SAME && along < wanted + 1e-14));
    ++a->counted;
    a->less += less;
    a->wrong += !same && !less;
    a->outside += !(beyond < most);
    a->depth = less ? a->depth : fmax(a->depth, off);
    a->normal = less || along_sides ? a->normal : fmax(a->normal, lean);
    a->beyond = fmax(a->beyond, beyond);
    if ((!same && !less) || !(beyond < most)) {
        show(i, j, wanted, n, p);
    }
}

/* Moved on along the normal, until they are apart. */
static void part(const se3di_shape *i, se3di_shape_pose *at, const se3di_shape *j,
                 const se3di_shape_pose *of, double wanted, const double n[3], accuracy *a)
{
    se3di_manifold m;
    se3di_add_scaled(-(wanted + CLEAR), n, at->x);
    se3di_narrow_find(i, at, j, of, &m);
    a->phantom += m.count > 0;
}

/* Of a random pose, or one with axes nearly parallel, on the way to the other. */
static void random_pair(se3di_shape_pose *at, se3di_shape_pose *of, uint64_t *seed)
{
    poses_turn(seed, of);
    poses_turn(seed, at);
    if (check_random(seed) > 0.4) {
        poses_lean(seed, of, at);
    }
    for (int c = 0; c < 3; ++c) {
        at->x[c] = 0.3 * check_random(seed);
    }
}

static void report(const char *one, const char *two, const accuracy *a)
{
    if (poses_are_many()) {
        printf("%s, %s: %d counted, %d wrong, depth %.2g, normal %.2g, outside %d, %.2g, less %d, "
               "phantom %d\n",
               one, two, a->counted, a->wrong, a->depth, a->normal, a->outside, a->beyond, a->less,
               a->phantom);
        printf("    corner, edge, face of the one on those of the other:");
        for (int k = 0; k < 9; ++k) {
            printf("%s %d", k % 3 == 0 ? ";" : "", a->kinds[k / 3][k % 3]);
        }
        printf("\n");
    }
}

/* Every way in which two polyhedra touch in a single point was had often. */
static void check_kinds(int one, int two, const accuracy *a)
{
    const int are_flat = one < 2 && two < 2; /* boxes and hulls */
    CHECK(!are_flat || 20 * a->kinds[0][2] > a->counted);
    CHECK(!are_flat || 20 * a->kinds[2][0] > a->counted);
    CHECK(!are_flat || 20 * a->kinds[1][1] > a->counted);
}

static void check_pair(int one, int two, int poses)
{
    uint64_t seed = 5 + 100 * (uint64_t)one + (uint64_t)two;
    accuracy a = {.counted = 0};
    for (int k = 0; k < poses; ++k) {
        poses_solid i, j;
        poses_random_solid(kinds[one], &seed, &i);
        poses_random_solid(kinds[two], &seed, &j);
        se3di_shape_pose at, of;
        double n[3];
        random_pair(&at, &of, &seed);
        const double size = fmin(poses_size(&i.shape), poses_size(&j.shape));
        double wanted = size * (k % 4 == 3 ? 0.5 : 0.02) * (1.001 + check_random(&seed));
        const double radius = se3di_core_radius(&i.shape) + se3di_core_radius(&j.shape);
        wanted += k % 8 == 7 && radius < size ? radius : 0.0;
        const double least = separation_of(&i.shape, &at, &j.shape, &of, n);
        if (!(least > radius ? least > wanted : least > -HUGE_VAL && wanted < radius)) {
            continue;
        }
        se3di_add_scaled(wanted - least, n, at.x);
        compare(&i.shape, &at, &j.shape, &of, &j.shape, wanted, n, &a);
        part(&i.shape, &at, &j.shape, &of, wanted, n, &a);
    }
    report(names[one], names[two], &a);
    CHECK(a.counted > poses / 8);
    CHECK(a.wrong == 0);
    CHECK(a.phantom == 0);
    CHECK(a.outside == 0);
    CHECK(a.less * 200 < a.counted);
    check_kinds(one, two, &a);
}

/* A convex mesh is what it encloses. */
static void check_block(int kind, int poses)
{
    static surface s;
    uint64_t seed = 70 + (uint64_t)kind;
    accuracy a = {.counted = 0};
    surface_make(SURFACE_BLOCK, &s);
    const se3di_shape block = {
        .kind = SE3DI_SHAPE_BOX, .half = {0.5, 0.5, 0.5}, .bound = s.shape.bound};
    for (int k = 0; k < poses; ++k) {
        poses_solid i;
        se3di_shape_pose at, of;
        double n[3];
        poses_random_solid(kinds[kind], &seed, &i);
        random_pair(&at, &of, &seed);
        const double radius = se3di_core_radius(&i.shape);
        const double wanted = 0.1 * poses_size(&i.shape) * (1.001 + check_random(&seed));
        const double least = separation_of(&i.shape, &at, &block, &of, n);
        if (least > (least > radius ? wanted : -HUGE_VAL)) {
            se3di_add_scaled(wanted - least, n, at.x);
            compare(&i.shape, &at, &s.shape, &of, &block, wanted, n, &a);
            part(&i.shape, &at, &s.shape, &of, wanted, n, &a);
        }
    }
    report(names[kind], s.name, &a);
    surface_release(&s);
    CHECK(a.counted > poses / 8);
    CHECK(a.wrong == 0);
    CHECK(a.phantom == 0);
}

static void convex_meshes_are_as_deep_as_what_they_enclose(void)
{
    for (int kind = 0; kind < KINDS; ++kind) {
        check_block(kind, poses_count(400));
    }
}

static void overlaps_and_normals_are_those_of_the_least_translation(void)
{
    for (int one = 0; one < KINDS; ++one) {
        for (int two = 0; two < KINDS; ++two) {
            check_pair(one, two, poses_count(one == 2 && two == 2 ? 60 : 400));
        }
    }
}

/* The convex solid below a surface that bulges upwards. */
static void solid_below(const surface *s, se3di_shape *hull)
{
    static double points[3 * (SURFACE_GRID * SURFACE_GRID + 4)];
    const se3d_allocator allocator = se3di_alloc_default();
    memcpy(points, s->points, 3 * s->point_count * sizeof(double));
    for (size_t k = 0; k < 4; ++k) {
        double *x = points + 3 * (s->point_count + k);
        x[0] = k & 1 ? 1.0 : -1.0;
        x[1] = k & 2 ? 1.0 : -1.0;
        x[2] = -4.0;
    }
    memset(hull, 0, sizeof *hull);
    hull->kind = SE3DI_SHAPE_HULL;
    CHECK(!se3di_hull_build(&allocator, points, s->point_count + 4, hull));
    hull->bound = se3di_shape_bound(hull);
}

/* Meshes that bulge are the convex solids below them. */
static void check_surface(int kind, int which, int poses, int parallel)
{
    static surface s;
    const se3d_allocator allocator = se3di_alloc_default();
    uint64_t seed = 40 + (uint64_t)kind;
    accuracy a = {.counted = 0};
    se3di_shape below;
    surface_make(which, &s);
    solid_below(&s, &below);
    for (int k = 0; k < poses; ++k) {
        poses_solid solid;
        se3di_shape_pose at, of;
        double n[3], local[3], up[3];
        poses_random_solid(kinds[kind], &seed, &solid);
        random_pair(&at, &of, &seed);
        if (parallel) {
            poses_turn_slightly(&seed, &of, -9.5, -6.0, &at);
        }
        for (int c = 0; c < 2; ++c) {
            local[c] = 0.5 * check_random(&seed);
        }
        local[2] = surface_height(which, local[0], local[1]) + 0.1 * check_random(&seed);
        poly_place(&of, local, at.x);
        const double size = poses_size(&solid.shape);
        const double wanted = size * (k % 4 == 3 ? 0.2 : 0.02) * (1.001 + check_random(&seed));
        const double least = separation_of(&solid.shape, &at, &below, &of, n);
        const double radius = se3di_core_radius(&solid.shape);
        for (int c = 0; c < 3; ++c) {
            up[c] = of.R[3 * c + 2];
        }
        if (!(least > radius ? least > wanted : least > -HUGE_VAL && wanted < radius) ||
            !(se3di_dot(n, up) < 0.0)) {
            continue;
        }
        se3di_add_scaled(wanted - least, n, at.x);
        poses_inner(&solid.shape, &at, local);
        if (outside(&below, &of, local) < 0.0) {
            continue; /* the surface is seen from below */
        }
        compare(&solid.shape, &at, &s.shape, &of, &below, wanted, n, &a);
        part(&solid.shape, &at, &s.shape, &of, wanted, n, &a);
    }
    report(names[kind], s.name, &a);
    CHECK(a.counted > poses / 8);
    CHECK(a.wrong == 0);
    CHECK(a.phantom == 0);
    se3di_shape_release(&allocator, &below);
    surface_release(&s);
}

static void meshes_that_bulge_are_as_deep_as_what_is_below_them(void)
{
    for (int kind = 0; kind < KINDS; ++kind) {
        check_surface(kind, SURFACE_ROOF, poses_count(400), 0);
        check_surface(kind, SURFACE_DOME, poses_count(400) / 20, 0);
    }
}

/* Beneath an edge of the dome that it leaves last, overlapping only triangles about it. */
static void sharp_hulls_are_as_deep_as_what_is_below_the_dome(void)
{
    check_surface(1, SURFACE_DOME, poses_count(600), 0);
}

/* Edges at an angle of 1e-8 have a product, and the nearest face of the polytope is a sliver. A way
 * off a corner of the ridge that leads into its other half by 5e-7 rad is not a way off it. */
static void solids_nearly_parallel_to_a_ridge_are_as_deep_as_others(void)
{
    check_surface(0, SURFACE_ROOF, poses_count(1500), 1);
    check_surface(2, SURFACE_ROOF, poses_count(1500), 1);
}

/* Rounding stops the polytope at a sliver, 2.6 cm too deep: the search goes on with other faces. */
static void a_cylinder_along_a_block_is_not_held_by_a_sliver(void)
{
    static surface s;
    const double wanted = 0.019049523563811881;
    se3di_shape drum = {.kind = SE3DI_SHAPE_CYLINDER,
                        .radius = 0.11149345128748681,
                        .half_length = 0.14365728673125425};
    const se3di_shape_pose at = {
        .x = {-0.58962651285940793, 0.13276203820508622, 0.10464354792061796},
        .R = {0.99841508289598024, -0.051161347270346449, 0.023448641566112732,
              -0.049445874127400043, -0.99641301945169459, -0.068674596460075107,
              0.026878016623075523, 0.06740631433819734, -0.99736350495180526}};
    const se3di_shape_pose of = {
        .R = {0.023448641566330031, 0.9984150828959325, -0.05116134727117827, -0.068674596461114068,
              -0.049445874128187545, -0.9964130194515739, -0.99736350495172865,
              0.026878016623399725, 0.067406314339202161}};
    se3di_manifold m;
    surface_make(SURFACE_BLOCK, &s);
    drum.bound = se3di_shape_bound(&drum);
    se3di_narrow_find(&drum, &at, &s.shape, &of, &m);
    CHECK(m.count > 0 && fabs(deepest(&m)->overlap - wanted) < SAME);
    surface_release(&s);
}

/* It overlaps one triangle, with no corner of its own and no edge, and leaves last over an edge
 * that is two triangles away, 4.4 mm deeper. */
static void a_sliver_below_a_dome_leaves_over_an_edge_that_it_does_not_overlap(void)
{
    static surface s;
    static const double corners[12] = {
        -0.026664984413101587, 0.051007433825427148, -0.24328423767435844,  -0.077000714791830016,
        -0.084360202084774252, 0.22238310688036375,  0.18147538948843667,   -0.058146661363484085,
        -0.16181980343054592,  -0.04176530245663377, 0.0086114322855532915, -0.24633615801318576};
    const double wanted = 0.0177999649729829;
    const se3d_allocator allocator = se3di_alloc_default();
    const se3di_shape_pose at = {
        .x = {0.19129464393561502, 0.44506416007592614, -0.19873342664312296},
        .R = {0.18580458381941489, 0.97678454280636962, -0.10662370077166515, -0.93566906708767938,
              0.14275688231049344, -0.32271329295252132, -0.30000008921159665, 0.15972610772049595,
              0.94047196501835972}};
    const se3di_shape_pose of = {.R = {0.26189707252486361, 0.3346854366287364, 0.90520471823314008,
                                       -0.024415773945427294, 0.93994036960378058,
                                       -0.34046434699062744, -0.96478691605221945,
                                       0.06706534200122008, 0.25433923511072221}};
    se3di_shape sliver = {.kind = SE3DI_SHAPE_HULL};
    se3di_manifold m;
    surface_make(SURFACE_DOME, &s);
    CHECK(!se3di_hull_build(&allocator, corners, 4, &sliver));
    sliver.bound = se3di_shape_bound(&sliver);
    se3di_narrow_find(&sliver, &at, &s.shape, &of, &m);
    CHECK(m.count > 0 && fabs(deepest(&m)->overlap - wanted) < SAME);
    se3di_shape_release(&allocator, &sliver);
    surface_release(&s);
}

/* Side by side or across each other, with their middles or their ends: what the formula says is the
 * least of all directions, and most need no other way. */
static void logs_are_as_deep_as_all_directions_say(void)
{
    const int poses = poses_count(2000);
    uint64_t seed = 12;
    int known = 0, wrong = 0, counted = 0;
    for (int k = 0; k < poses; ++k) {
        se3di_shape log[2];
        se3di_shape_pose at, of;
        double n[3], wanted[3], a[3], b[3], axis[3], side[3], turn[3];
        for (int c = 0; c < 2; ++c) {
            log[c] = (se3di_shape){.kind = SE3DI_SHAPE_CYLINDER,
                                   .radius = poses_between(&seed, 0.05, 0.2),
                                   .half_length = poses_between(&seed, 0.1, 1.0)};
            log[c].bound = se3di_shape_bound(&log[c]);
        }
        poses_turn(&seed, &of);
        if (k % 2 == 0) {
            poses_turn(&seed, &at);
        } else {
            poses_turn_slightly(&seed, &of, -12.0, -1.0, &at);
        }
        const se3di_solid i = {&log[0], &at}, j = {&log[1], &of};
        se3di_solid_axis(&i, 2, axis);
        se3di_perpendicular(axis, side);
        const double deep = log[0].radius * pow(10.0, poses_between(&seed, -6.0, -0.3));
        se3di_scale(log[0].radius + log[1].radius - deep, side, at.x);
        se3di_add_scaled(log[0].half_length * check_random(&seed), axis, at.x);
        const double least = separation_of(&log[0], &at, &log[1], &of, wanted);
        const double overlap = se3di_cylinders_overlap(&i, &j, n, a, b);
        counted += least > 0.0;
        if (overlap > 0.0) {
            ++known;
            se3di_sub(n, wanted, turn);
            wrong += !(fabs(overlap - least) < 1e-12 && se3di_norm(turn) < 1e-6);
        }
    }
    if (poses_are_many()) {
        printf("%d logs overlap, %d are known, %d wrong\n", counted, known, wrong);
    }
    CHECK(counted > poses / 4 && 5 * known > 2 * counted);
    CHECK(wrong == 0);
}

/* A cap pushed onto a solid, by little and by more than either is thick: what is said to be the
 * least of all directions is, and most of what lies on a cap is known so. */
static void what_lies_on_a_cap_is_as_deep_as_all_directions_say(void)
{
    static const int others[] = {SE3DI_SHAPE_HULL, SE3DI_SHAPE_CYLINDER};
    const int poses = poses_count(2000);
    uint64_t seed = 15;
    int known[2] = {0, 0}, counted = 0, wrong = 0;
    for (int k = 0; k < poses; ++k) {
        poses_solid one, two;
        se3di_shape_pose at, of;
        double wanted[3], n[3], a[3], b[3], turn[3];
        poses_random_solid(SE3DI_SHAPE_CYLINDER, &seed, &one);
        poses_random_solid(others[k % 2], &seed, &two);
        poses_turn(&seed, &at);
        if (k % 4 < 2) {
            poses_turn(&seed, &of);
        } else {
            poses_turn_slightly(&seed, &at, -6.0, -1.0, &of);
        }
        const se3di_solid i = {&one.shape, &at}, j = {&two.shape, &of};
        double axis[3], side[3], back[3], q[3];
        se3di_solid_axis(&i, 2, axis);
        se3di_perpendicular(axis, side);
        se3di_scale(-1.0, axis, back);
        se3di_core_support(&j, back, q);
        const double deep = one.shape.half_length * pow(10.0, poses_between(&seed, -6.0, 0.5));
        se3di_add_scaled(one.shape.half_length - deep - se3di_dot(q, axis), axis, of.x);
        se3di_add_scaled(one.shape.radius * check_random(&seed), side, of.x);
        const double least = separation_of(&one.shape, &at, &two.shape, &of, wanted);
        const double overlap = se3di_caps_overlap(&i, &j, n, a, b);
        counted += least > 0.0;
        if (overlap > 0.0) {
            ++known[k % 2];
            se3di_sub(n, wanted, turn);
            wrong += !(fabs(overlap - least) < 1e-12 && se3di_norm(turn) < 1e-6);
        }
    }
    if (poses_are_many()) {
        printf("%d overlap, %d hulls and %d cylinders are known on a cap, %d wrong\n", counted,
               known[0], known[1], wrong);
    }
    CHECK(counted > poses / 4 && 8 * known[0] > counted && 8 * known[1] > counted);
    CHECK(wrong == 0);
}

int main(void)
{
    RUN(convex_meshes_are_as_deep_as_what_they_enclose);
    RUN(overlaps_and_normals_are_those_of_the_least_translation);
    RUN(meshes_that_bulge_are_as_deep_as_what_is_below_them);
    RUN(sharp_hulls_are_as_deep_as_what_is_below_the_dome);
    RUN(solids_nearly_parallel_to_a_ridge_are_as_deep_as_others);
    RUN(a_cylinder_along_a_block_is_not_held_by_a_sliver);
    RUN(logs_are_as_deep_as_all_directions_say);
    RUN(what_lies_on_a_cap_is_as_deep_as_all_directions_say);
    RUN(a_sliver_below_a_dome_leaves_over_an_edge_that_it_does_not_overlap);
    return check_finish();
}
