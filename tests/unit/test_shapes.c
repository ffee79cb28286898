/* SPDX-License-Identifier: BSD-3-Clause */
/* Shapes: nearest points against a search of the surface at random poses, hulls and meshes against
 * the boxes that they are. */
#include "check.h"
#include "se3d/se3d.h"

#define PI 3.1415926535897932384626433832795

static uint64_t seed = 12345;

static double uniform(double low, double high)
{
    uint64_t z = (seed += UINT64_C(0x9E3779B97F4A7C15));
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return low + (high - low) * ((double)((z ^ (z >> 31)) >> 11) * 0x1p-53);
}

static void random_orientation(double p[4])
{
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) {
        p[k] = uniform(-1.0, 1.0);
        sum += p[k] * p[k];
    }
    for (int k = 0; k < 4; ++k) {
        p[k] /= sqrt(sum);
    }
}

static void rotate(const double p[4], const double s[3], double out[3])
{
    double t[3] = {2.0 * (p[2] * s[2] - p[3] * s[1]), 2.0 * (p[3] * s[0] - p[1] * s[2]),
                   2.0 * (p[1] * s[1] - p[2] * s[0])};
    out[0] = s[0] + p[0] * t[0] + p[2] * t[2] - p[3] * t[1];
    out[1] = s[1] + p[0] * t[1] + p[3] * t[0] - p[1] * t[2];
    out[2] = s[2] + p[0] * t[2] + p[1] * t[1] - p[2] * t[0];
}

/* Half sizes 0.3, 0.2, 0.4; radius 0.25; length 0.6. */
static const double half[3] = {0.3, 0.2, 0.4};
#define RADIUS 0.25
#define LENGTH 0.6

enum { SPHERE, BOX, CAPSULE, CYLINDER, PLANE, HULL, MESH, KINDS };

static const double box_corners[24] = {-0.3, -0.2, -0.4, 0.3,  -0.2, -0.4, -0.3, 0.2,
                                       -0.4, 0.3,  0.2,  -0.4, -0.3, -0.2, 0.4,  0.3,
                                       -0.2, 0.4,  -0.3, 0.2,  0.4,  0.3,  0.2,  0.4};
static const uint32_t box_faces[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                       2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

/* A point of the surface from two numbers in [0, 1] and a part; the plane: near the origin. */
static void surface(int kind, double u, double v, int part, double out[3])
{
    double angle = 2.0 * PI * u;
    double up = 2.0 * v - 1.0;
    double ring = sqrt(fmax(0.0, 1.0 - up * up));
    double ball[3] = {RADIUS * ring * cos(angle), RADIUS * ring * sin(angle), RADIUS * up};
    int axis = part % 3;
    memcpy(out, ball, sizeof ball);
    if (kind == CAPSULE) {
        out[2] = part % 3 == 0 ? LENGTH * (v - 0.5) : ball[2] + (up > 0.0 ? 0.5 : -0.5) * LENGTH;
        out[0] = part % 3 == 0 ? RADIUS * cos(angle) : ball[0];
        out[1] = part % 3 == 0 ? RADIUS * sin(angle) : ball[1];
    } else if (kind == CYLINDER) {
        double r = part % 3 == 0 ? RADIUS : RADIUS * v;
        out[0] = r * cos(angle);
        out[1] = r * sin(angle);
        out[2] = part % 3 == 0 ? LENGTH * (v - 0.5) : (part % 3 == 1 ? 0.5 : -0.5) * LENGTH;
    } else if (kind == PLANE) {
        out[0] = 8.0 * (u - 0.5);
        out[1] = 8.0 * (v - 0.5);
        out[2] = 0.0;
    } else if (kind != SPHERE) {
        out[axis] = part < 3 ? half[axis] : -half[axis];
        out[(axis + 1) % 3] = (2.0 * u - 1.0) * half[(axis + 1) % 3];
        out[(axis + 2) % 3] = up * half[(axis + 2) % 3];
    }
}

/* How far inside: positive inside. */
static double depth(int kind, const double x[3])
{
    double rho = hypot(x[0], x[1]);
    double beyond = fmax(0.0, fabs(x[2]) - 0.5 * LENGTH);
    switch (kind) {
    case SPHERE:
        return RADIUS - hypot(rho, x[2]);
    case CAPSULE:
        return RADIUS - hypot(rho, beyond);
    case CYLINDER:
        return fmin(RADIUS - rho, 0.5 * LENGTH - fabs(x[2]));
    case PLANE:
        return -x[2];
    default:
        return fmin(half[0] - fabs(x[0]), fmin(half[1] - fabs(x[1]), half[2] - fabs(x[2])));
    }
}

typedef struct world {
    se3d_system *system;
    double r[3], p[4]; /* of the body */
    double s[3], q[4]; /* of the shape on it */
    se3d_shape shape;
} world;

static void world_init(world *w, int kind)
{
    se3d_status (*const create[KINDS])(se3d_system *, const se3d_shape_def *, se3d_shape *) = {
        se3d_shape_create_sphere,   se3d_shape_create_box,   se3d_shape_create_capsule,
        se3d_shape_create_cylinder, se3d_shape_create_plane, se3d_shape_create_hull,
        se3d_shape_create_mesh};
    se3d_body_def body = se3d_body_def_default();
    se3d_shape_def def = se3d_shape_def_default();
    CHECK(se3d_system_create(NULL, &w->system) == SE3D_OK);
    random_orientation(w->p);
    random_orientation(w->q);
    for (int a = 0; a < 3; ++a) {
        w->r[a] = body.position[a] = uniform(-2.0, 2.0);
        w->s[a] = def.position[a] = uniform(-0.5, 0.5);
        def.size[a] = 2.0 * half[a];
        body.inertia[a] = 1.0;
    }
    body.mass = 1.0;
    memcpy(body.orientation, w->p, sizeof w->p);
    memcpy(def.orientation, w->q, sizeof w->q);
    CHECK(se3d_body_create(w->system, &body, &def.body) == SE3D_OK);
    def.radius = RADIUS;
    def.length = LENGTH;
    def.vertices = box_corners;
    def.vertex_count = 8;
    def.triangles = box_faces;
    def.triangle_count = 12;
    CHECK(create[kind](w->system, &def, &w->shape) == SE3D_OK);
}

static void to_ground(const world *w, const double local[3], double out[3])
{
    double on_body[3], turned[3];
    rotate(w->q, local, on_body);
    for (int a = 0; a < 3; ++a) {
        on_body[a] += w->s[a];
    }
    rotate(w->p, on_body, turned);
    for (int a = 0; a < 3; ++a) {
        out[a] = turned[a] + w->r[a];
    }
}

static double least_sampled(const world *w, int kind, const double x[3])
{
    double least = HUGE_VAL;
    const int n = 60;
    for (int part = 0; part < 6; ++part) {
        for (int k = 0; k < n * n; ++k) {
            double local[3], at[3];
            surface(kind, (double)(k % n) / (n - 1), (double)(k / n) / (n - 1), part, local);
            to_ground(w, local, at);
            least = fmin(least, hypot(hypot(at[0] - x[0], at[1] - x[1]), at[2] - x[2]));
        }
    }
    return least;
}

static void nearest_points_are_where_a_search_finds_them(void)
{
    for (int kind = 0; kind < KINDS; ++kind) {
        int inside = 0;
        for (int pose = 0; pose < 3; ++pose) {
            world w;
            world_init(&w, kind);
            for (int k = 0; k < 30; ++k) {
                double local[3], x[3], point[3], normal[3], distance;
                for (int a = 0; a < 3; ++a) {
                    local[a] = uniform(-0.55, 0.55);
                }
                to_ground(&w, local, x);
                CHECK(se3d_shape_get_nearest(w.system, w.shape, x, point, normal, &distance) ==
                      SE3D_OK);
                double deep = depth(kind, local);
                inside += deep > 0.0;
                CHECK(kind == MESH ? distance >= 0.0 : (distance < 0.0) == (deep > 0.0));
                if (deep > 0.0) {
                    CHECK_NEAR(fabs(distance), deep, 1e-12);
                }
                double sampled = least_sampled(&w, kind, x);
                CHECK(fabs(distance) < sampled + 1e-12);
                CHECK(fabs(distance) > sampled - 0.02 - (kind == PLANE ? 0.1 : 0.0));
                double length = 0.0;
                for (int a = 0; a < 3; ++a) {
                    CHECK_NEAR(point[a] + distance * normal[a], x[a], 1e-12);
                    length += normal[a] * normal[a];
                }
                CHECK_NEAR(length, 1.0, 1e-12);
                /* the point is on the surface: its own distance is nothing */
                double again[3], other[3], none;
                CHECK(se3d_shape_get_nearest(w.system, w.shape, point, again, other, &none) ==
                      SE3D_OK);
                CHECK(fabs(none) < 1e-12);
            }
            se3d_system_destroy(w.system);
        }
        CHECK(inside > 0);
    }
}

/* If the normal has no direction of its own, it is one of the surface's. */
static void centres_and_surface_points_have_normals(void)
{
    for (int kind = 0; kind < KINDS; ++kind) {
        world w;
        world_init(&w, kind);
        const double local[2][3] = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.3}};
        for (int k = 0; k < 2; ++k) {
            double x[3], point[3], normal[3], distance;
            to_ground(&w, local[k], x);
            CHECK(se3d_shape_get_nearest(w.system, w.shape, x, point, normal, &distance) ==
                  SE3D_OK);
            CHECK_NEAR(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2], 1.0,
                       1e-12);
            for (int a = 0; a < 3; ++a) {
                CHECK_NEAR(point[a] + distance * normal[a], x[a], 1e-12);
            }
        }
        se3d_system_destroy(w.system);
    }
}

/* Two hundred points on a sphere: the hull lies between the sphere and one a little smaller; the
 * points inside are not corners. */
static void hull_of_a_cloud_holds_it(void)
{
    double points[3 * 260];
    for (int k = 0; k < 260; ++k) {
        double p[4];
        random_orientation(p);
        const double out[3] = {k < 200 ? 1.0 : 0.5, 0.0, 0.0};
        rotate(p, out, points + 3 * k);
    }
    se3d_system *system;
    se3d_shape shape;
    se3d_shape_def def = se3d_shape_def_default();
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    def.vertices = points;
    def.vertex_count = 260;
    CHECK(se3d_shape_create_hull(system, &def, &shape) == SE3D_OK);
    for (int k = 0; k < 260; ++k) {
        double point[3], normal[3], distance;
        CHECK(se3d_shape_get_nearest(system, shape, points + 3 * k, point, normal, &distance) ==
              SE3D_OK);
        CHECK(k < 200 ? fabs(distance) < 1e-12 : distance < -0.2 && distance > -0.5);
    }
    se3d_system_destroy(system);
}

static void flat_hulls_and_meshes_without_area_are_refused(void)
{
    const double flat[15] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0,  1.0,
                             0.0, 1.0, 1.0, 0.0, 0.3, 0.4, 1e-12};
    const uint32_t thin[3] = {0, 1, 1};
    se3d_system *system;
    se3d_shape shape;
    se3d_shape_def def = se3d_shape_def_default();
    CHECK(se3d_system_create(NULL, &system) == SE3D_OK);
    def.vertices = flat;
    def.vertex_count = 5;
    CHECK(se3d_shape_create_hull(system, &def, &shape) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(system), "plane");
    def.triangles = thin;
    def.triangle_count = 1;
    CHECK(se3d_shape_create_mesh(system, &def, &shape) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(system), "area");
    se3d_system_destroy(system);
}

/* The shape is not made, whatever it is, and the message has `text`. */
static void refused(se3d_system *system, const se3d_shape_def *def,
                    se3d_status (*create)(se3d_system *, const se3d_shape_def *, se3d_shape *),
                    const char *text)
{
    se3d_shape shape = {7, 7};
    CHECK(create(system, def, &shape) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(shape.index1 == 0 && shape.generation == 0);
    CHECK_CONTAINS(se3d_system_get_error(system), text);
}

static void hulls_and_meshes_have_bounds(void)
{
    enum { TOO_MANY = 10001 };
    static double points[3 * TOO_MANY];
    const uint32_t beyond[6] = {0, 1, 2, 0, 2, 3};
    se3d_system *system;
    se3d_shape shape;
    se3d_shape_def def = se3d_shape_def_default();
    CHECK(!se3d_system_create(NULL, &system));
    for (int k = 0; k < 3 * TOO_MANY; ++k) {
        points[k] = uniform(-1.0, 1.0);
    }
    def.vertices = points;
    def.vertex_count = TOO_MANY;
    refused(system, &def, se3d_shape_create_hull, "vertex_count = 10001 of a hull");
    def.vertex_count = 3;
    def.triangle_count = 2;
    CHECK(se3d_shape_create_mesh(system, &def, &shape) == SE3D_ERR_NULL);
    def.triangles = beyond;
    refused(system, &def, se3d_shape_create_mesh, "triangles[5] = 3, must be less than");
    def.triangle_count = 0;
    refused(system, &def, se3d_shape_create_mesh, "triangle_count = 0, must be");
    def.triangle_count = UINT32_MAX;
    refused(system, &def, se3d_shape_create_mesh, "triangle_count = 4294967295, must be");
    def.triangle_count = 1;
    CHECK(!se3d_shape_create_mesh(system, &def, &shape));
    se3d_system_destroy(system);
}

static void heightfields_have_bounds(void)
{
    double heights[6] = {0.0, 0.1, 0.2, 0.1, 0.0, 0.3};
    se3d_system *system;
    se3d_shape shape;
    const struct grid {
        size_t columns, rows;
        double spacing[2];
        const char *text;
    } grids[] = {
        {1, 3, {0.1, 0.1}, "column_count = 1, must be from 2"},
        {2, 1, {0.1, 0.1}, "row_count = 1, must be from 2"},
        {UINT32_MAX, 2, {0.1, 0.1}, "column_count = 4294967295, must be from 2"},
        {2, UINT32_MAX, {0.1, 0.1}, "row_count = 4294967295, must be from 2"},
        {9000, 9000, {0.1, 0.1}, "row_count * column_count = 9000 * 9000, must be at most"},
        {2, 3, {NAN, 0.1}, "spacing[0] = nan m, must be finite"},
        {2, 3, {0.1, HUGE_VAL}, "spacing[1] = inf m, must be finite"},
        {2, 3, {0.1, 1e-10}, "spacing[1] = 1e-10 m, must be finite and at least 1e-09"},
    };
    se3d_shape_def def = se3d_shape_def_default();
    CHECK(!se3d_system_create(NULL, &system));
    for (size_t k = 0; k < sizeof grids / sizeof *grids; ++k) {
        se3d_shape_def bad = def;
        bad.heights = heights;
        bad.column_count = grids[k].columns;
        bad.row_count = grids[k].rows;
        memcpy(bad.spacing, grids[k].spacing, sizeof bad.spacing);
        refused(system, &bad, se3d_shape_create_heightfield, grids[k].text);
    }
    def.column_count = 2;
    def.row_count = 3;
    def.spacing[0] = def.spacing[1] = 0.1;
    CHECK(se3d_shape_create_heightfield(system, &def, &shape) == SE3D_ERR_NULL);
    def.heights = heights;
    heights[5] = -HUGE_VAL;
    refused(system, &def, se3d_shape_create_heightfield, "heights[5] = -inf m, must be finite");
    heights[5] = 0.3;
    CHECK(!se3d_shape_create_heightfield(system, &def, &shape));
    se3d_system_destroy(system);
}

/* Radii so small that no triangle has an area. */
static void funnels_without_area_are_refused(void)
{
    se3d_system *system;
    se3d_shape_def def = se3d_shape_def_default();
    CHECK(!se3d_system_create(NULL, &system));
    def.bottom_radius = 1e-200;
    def.length = 1e-200;
    refused(system, &def, se3d_shape_create_funnel, "none of the funnel's triangles has an area");
    se3d_system_destroy(system);
}

int main(void)
{
    RUN(nearest_points_are_where_a_search_finds_them);
    RUN(centres_and_surface_points_have_normals);
    RUN(hull_of_a_cloud_holds_it);
    RUN(flat_hulls_and_meshes_without_area_are_refused);
    RUN(hulls_and_meshes_have_bounds);
    RUN(heightfields_have_bounds);
    RUN(funnels_without_area_are_refused);
    return check_finish();
}
