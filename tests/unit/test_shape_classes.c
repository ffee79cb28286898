/* SPDX-License-Identifier: BSD-3-Clause */
/* What holds for every kind of shape of SE3DI_SHAPE_LIST: its functions agree with each other. */
#include "check.h"
#include "contact/narrow/internal.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "support/poses.h"

static const double corners[24] = {-0.3, -0.2, -0.4, 0.3,  -0.2, -0.4, -0.3, 0.2,
                                   -0.4, 0.3,  0.2,  -0.4, -0.3, -0.2, 0.4,  0.3,
                                   -0.2, 0.4,  -0.3, 0.2,  0.4,  0.3,  0.2,  0.4};
static const uint32_t faces[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                   2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

/* All that any kind needs. */
static se3d_shape_def full_definition(void)
{
    se3d_shape_def def = se3d_shape_def_default();
    def.radius = 0.25;
    def.length = 0.6;
    def.bottom_radius = 0.2;
    def.top_radius = 0.35;
    def.size[0] = 0.6;
    def.size[1] = 0.4;
    def.size[2] = 0.8;
    def.semi_axes[0] = 0.3;
    def.semi_axes[1] = 0.2;
    def.semi_axes[2] = 0.4;
    def.vertices = corners;
    def.vertex_count = 8;
    def.triangles = faces;
    def.triangle_count = 12;
    def.heights = corners;
    def.row_count = 4;
    def.column_count = 6;
    def.spacing[0] = def.spacing[1] = 0.2;
    return def;
}

static se3d_status define(int kind, const se3d_shape_def *def, se3di_shape *shape,
                          se3di_error *error)
{
    const se3d_allocator allocator = se3di_alloc_default();
    memset(shape, 0, sizeof *shape);
    memset(error, 0, sizeof *error);
    shape->kind = kind;
    return se3di_shape_define(def, &allocator, shape, error);
}

static void release(se3di_shape *shape)
{
    const se3d_allocator allocator = se3di_alloc_default();
    se3di_shape_release(&allocator, shape);
}

/* One of each kind, for all tests. */
static se3di_shape shapes[SE3DI_SHAPE_COUNT];

static void make_all(void)
{
    const se3d_shape_def def = full_definition();
    se3di_error error;
    for (int kind = 0; kind < SE3DI_SHAPE_COUNT; ++kind) {
        CHECK(define(kind, &def, &shapes[kind], &error) == SE3D_OK);
    }
}

static int is_solid(const se3di_shape *s)
{
    return !se3di_shape_is(s, SE3DI_SHAPE_IS_SURFACE | SE3DI_SHAPE_IS_HALF_SPACE);
}

static void random_unit(uint64_t *seed, double d[3])
{
    do {
        for (int c = 0; c < 3; ++c) {
            d[c] = check_random(seed);
        }
    } while (!(se3di_norm(d) > 0.1));
    se3di_scale(1.0 / se3di_norm(d), d, d);
}

static double distance_of(const se3di_shape *s, const double local[3])
{
    double point[3], normal[3], distance;
    se3di_shape_nearest(s, local, point, normal, &distance);
    return distance;
}

/* With its frame that of the ground. */
static se3di_shape_pose upright(void)
{
    const se3di_shape_pose pose = {.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
    return pose;
}

static void every_kind_has_the_name_and_the_number_of_the_list(void)
{
    static const char *const names[] = {
#define NAME(KIND, name, traits) [SE3D_SHAPE_##KIND] = #name,
        SE3DI_SHAPE_LIST(NAME)
#undef NAME
    };
    for (int kind = 0; kind < SE3DI_SHAPE_COUNT; ++kind) {
        const se3di_shape shape = {.kind = kind};
        CHECK(strcmp(se3di_shape_class_of(&shape)->name, names[kind]) == 0);
    }
}

static void bad_lengths_are_refused_by_their_names(void)
{
    const double bad[4] = {-1.0, (double)NAN, HUGE_VAL, 0.0};
    for (int kind = 0; kind < SE3DI_SHAPE_COUNT; ++kind) {
        se3di_shape shape = {.kind = kind};
        const se3di_dimension *list = se3di_shape_class_of(&shape)->dimensions;
        for (const se3di_dimension *d = list; d && d->name; ++d) {
            for (uint32_t k = 0; k < 4 * d->count; ++k) {
                se3d_shape_def def = full_definition();
                se3di_error error;
                const double value = bad[k % 4];
                const int good = d->may_be_zero && k % 4 == 3;
                memcpy((char *)&def + d->from + k / 4 * sizeof value, &value, sizeof value);
                CHECK((define(kind, &def, &shape, &error) == SE3D_OK) == good);
                CHECK(strcmp(error.field, good ? "" : d->name) == 0);
                if (good) {
                    release(&shape);
                }
            }
        }
    }
}

static void points_farthest_along_a_direction_are_on_the_surface(void)
{
    uint64_t seed = 17;
    for (int trial = 0; trial < 2000; ++trial) {
        const se3di_shape_pose pose = upright();
        const se3di_shape s = shapes[trial % SE3DI_SHAPE_COUNT];
        double d[3], x[3], far[3], point[3], normal[3], distance;
        const se3di_solid solid = {&s, &pose};
        random_unit(&seed, d);
        random_unit(&seed, x);
        se3di_core_support(&solid, d, far);
        se3di_add_scaled(se3di_core_radius(&s), d, far);
        if (is_solid(&s)) {
            CHECK(fabs(distance_of(&s, far)) < 1e-14);
            CHECK(se3di_norm(far) <= s.bound + 1e-15);
            se3di_shape_nearest(&s, x, point, normal, &distance);
            CHECK(se3di_dot(point, d) <= se3di_dot(far, d) + 1e-14);
        }
    }
}

static void faces_and_corners_are_on_the_surface(void)
{
    uint64_t seed = 18;
    for (int trial = 0; trial < 2000; ++trial) {
        const se3di_shape_pose pose = upright();
        const se3di_shape s = shapes[trial % SE3DI_SHAPE_COUNT];
        se3di_face face;
        double d[3], x[3], far[3], most = -HUGE_VAL;
        const se3di_solid solid = {&s, &pose};
        random_unit(&seed, d);
        if (is_solid(&s)) {
            se3di_face_find(&solid, d, &face);
            for (int k = 0; k < face.count; ++k) {
                CHECK(fabs(distance_of(&s, face.corner[k]) + se3di_core_radius(&s)) < 1e-14);
            }
            CHECK(face.count > 0 && fabs(se3di_norm(face.normal) - 1.0) < 1e-14);
        }
        const se3di_shape_class *kind = se3di_shape_class_of(&s);
        for (uint32_t k = 0; kind->corner && kind->corner(&s, k, x); ++k) {
            CHECK(fabs(distance_of(&s, x)) < 1e-14);
            most = fmax(most, se3di_dot(x, d));
        }
        se3di_core_support(&solid, d, far);
        CHECK(!kind->corner || fabs(most - se3di_dot(far, d)) < 1e-15);
    }
}

/* How far the normal turns from `local` to a place beside it, less what the bend says. */
static double turn_error(const se3di_shape *s, const double local[3], const double way[3],
                         double radius)
{
    const double step = 1e-6;
    double point[3], n[3], m[3], beside[3], distance;
    se3di_shape_nearest(s, local, point, n, &distance);
    se3di_copy(local, beside);
    se3di_add_scaled(step, way, beside);
    se3di_shape_nearest(s, beside, point, m, &distance);
    se3di_sub(m, n, m);
    se3di_scale(1.0 / step, m, m);
    se3di_add_scaled(-1.0 / (radius + distance), way, m);
    return se3di_norm(m);
}

static void normals_turn_as_surfaces_bend(void)
{
    uint64_t seed = 19;
    int bent = 0;
    for (int trial = 0; trial < 4800; ++trial) {
        const se3di_shape s = shapes[trial % SE3DI_SHAPE_COUNT];
        double local[3], point[3], n[3], u[3], w[3], r[2] = {HUGE_VAL, HUGE_VAL}, distance;
        const se3di_shape_class *kind = se3di_shape_class_of(&s);
        random_unit(&seed, local);
        se3di_shape_nearest(&s, local, point, n, &distance);
        if (kind->bend) {
            if (!kind->bend(&s, local, u, r)) {
                se3di_perpendicular(n, u);
            }
            se3di_cross(n, u, w);
            CHECK(fabs(se3di_dot(u, n)) < 1e-12);
            CHECK(turn_error(&s, local, u, r[0]) < 1e-4);
            CHECK(turn_error(&s, local, w, r[1]) < 1e-4);
            ++bent;
        }
    }
    CHECK(bent >= 2000);
}

static double deepest(const se3di_manifold *m)
{
    double most = 0.0;
    for (uint32_t k = 0; k < m->count; ++k) {
        most = fmax(most, m->points[k].overlap);
    }
    return most;
}

/* Turned, near the origin. */
static void place(uint64_t *seed, se3di_shape_pose *pose)
{
    poses_turn(seed, pose);
    for (int c = 0; c < 3; ++c) {
        pose->x[c] = 0.4 * check_random(seed);
    }
}

static void pairs_are_the_same_from_both_sides(void)
{
    uint64_t seed = 20;
    int touching = 0;
    for (int trial = 0; trial < 20 * SE3DI_SHAPE_COUNT * SE3DI_SHAPE_COUNT; ++trial) {
        const se3di_shape i = shapes[trial % SE3DI_SHAPE_COUNT];
        const se3di_shape j = shapes[trial / SE3DI_SHAPE_COUNT % SE3DI_SHAPE_COUNT];
        se3di_shape_pose at, of;
        se3di_manifold one, two;
        double n[3], m[3];
        place(&seed, &at);
        place(&seed, &of);
        se3di_narrow_find(&i, &at, &j, &of, &one);
        se3di_narrow_find(&j, &of, &i, &at, &two);
        const double gap = se3di_narrow_gap(&i, &at, &j, &of, n);
        const int known = se3di_narrow_is_known(&i, &j);
        CHECK(!known || fabs(gap - se3di_narrow_gap(&j, &of, &i, &at, m)) < 1e-12);
        CHECK(known == se3di_narrow_is_known(&j, &i));
        CHECK(known || one.count == 0);
        CHECK(one.count == 0 || !(gap > 1e-12));
        CHECK(fabs(deepest(&one) - deepest(&two)) < 1e-9);
        touching += one.count > 0;
    }
    CHECK(touching > 300);
}

/* What serves kinds that have nothing of their own. */
static void general_answer_on_planes_is_as_deep_as_the_special_ones(void)
{
    uint64_t seed = 21;
    for (int trial = 0; trial < 2000; ++trial) {
        const se3di_shape s = shapes[trial % SE3DI_SHAPE_COUNT];
        const se3di_shape plane = shapes[SE3DI_SHAPE_PLANE];
        se3di_shape_pose at, of;
        se3di_manifold own, general;
        place(&seed, &at);
        place(&seed, &of);
        general.count = 0;
        if (is_solid(&s)) {
            const se3di_solid solid = {&s, &at}, floor = {&plane, &of};
            se3di_narrow_find(&s, &at, &plane, &of, &own);
            se3di_plane_convex(&solid, &floor, &general);
            CHECK((own.count > 0) == (general.count > 0));
            CHECK(fabs(deepest(&own) - deepest(&general)) < 1e-7); /* rims lean when upright */
        }
    }
}

int main(void)
{
    make_all();
    RUN(every_kind_has_the_name_and_the_number_of_the_list);
    RUN(bad_lengths_are_refused_by_their_names);
    RUN(points_farthest_along_a_direction_are_on_the_surface);
    RUN(faces_and_corners_are_on_the_surface);
    RUN(normals_turn_as_surfaces_bend);
    RUN(pairs_are_the_same_from_both_sides);
    RUN(general_answer_on_planes_is_as_deep_as_the_special_ones);
    for (int kind = 0; kind < SE3DI_SHAPE_COUNT; ++kind) {
        release(&shapes[kind]);
    }
    return check_finish();
}
