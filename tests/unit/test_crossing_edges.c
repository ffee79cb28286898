/* SPDX-License-Identifier: BSD-3-Clause */
/* Edges of two meshes that pass over each other touch once, though both meshes
 * are searched for edges within the other: combs of roofs whose ridges cross. */
#include "check.h"
#include "contact/narrow/internal.h"
#include "contact/shape/mesh.h"

#define LENGTH 1.0
#define HEIGHT 0.5
#define PITCH  0.4
#define TEETH  3
#define PARTS  3

typedef struct comb {
    double vertices[3 * TEETH * 3 * (PARTS + 1)];
    uint32_t triangles[3 * TEETH * (6 * PARTS + 2)];
    size_t vertex_count, triangle_count;
} comb;

static void add_triangle(comb *c, size_t i, size_t j, size_t k)
{
    uint32_t *to = c->triangles + 3 * c->triangle_count++;
    to[0] = (uint32_t)i;
    to[1] = (uint32_t)j;
    to[2] = (uint32_t)k;
}

/* A prism of three sides along x in so many parts, its ridge up at z = 0, y = `across`. */
static void add_roof(comb *c, double across, size_t parts)
{
    const double section[3][2] = {{0.0, 0.0}, {-0.15, -HEIGHT}, {0.15, -HEIGHT}};
    const size_t first = c->vertex_count;
    for (size_t k = 0; k <= parts; ++k) {
        for (size_t n = 0; n < 3; ++n) {
            double *to = c->vertices + 3 * c->vertex_count++;
            to[0] = LENGTH * ((double)k / (double)parts - 0.47); /* no crossing at an end */
            to[1] = across + section[n][0];
            to[2] = section[n][1];
        }
    }
    for (size_t k = 0; k < parts; ++k) {
        for (size_t n = 0; n < 3; ++n) {
            const size_t a = first + 3 * k + n, b = first + 3 * k + (n + 1) % 3;
            add_triangle(c, a, a + 3, b);
            add_triangle(c, b, a + 3, b + 3);
        }
    }
    const size_t last = first + 3 * parts;
    add_triangle(c, first, first + 1, first + 2);
    add_triangle(c, last, last + 2, last + 1);
}

static void build(comb *c, se3di_shape *shape, int teeth, size_t parts)
{
    const se3d_allocator standard = se3di_alloc_default();
    *c = (comb){.vertex_count = 0};
    for (int k = 0; k < teeth; ++k) {
        add_roof(c, PITCH * (k - 0.5 * (teeth - 1)), parts);
    }
    *shape = (se3di_shape){.kind = SE3DI_SHAPE_MESH};
    CHECK(se3di_mesh_build(&standard, c->vertices, c->vertex_count, c->triangles, c->triangle_count,
                           shape) == SE3D_OK);
    shape->bound = se3di_shape_bound(shape);
    CHECK(shape->closed != 0);
}

/* Ridges along x below, ridges that point down above, turned by `angle` about z. */
static void cross(int teeth, size_t parts, double angle, double depth)
{
    const se3d_allocator standard = se3di_alloc_default();
    const double c = cos(angle), s = sin(angle);
    const se3di_shape_pose low = {.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
    const se3di_shape_pose high = {.x = {0.01, 0.02, -depth},
                                   .R = {c, s, 0.0, s, -c, 0.0, 0.0, 0.0, -1.0}};
    comb combs[2];
    se3di_shape shapes[2];
    se3di_manifold manifold = {0};
    build(&combs[0], &shapes[0], teeth, parts);
    build(&combs[1], &shapes[1], teeth, 1);
    const se3di_solid i = {&shapes[0], &low}, j = {&shapes[1], &high};
    se3di_narrow_surfaces(&i, &j, &manifold);
    CHECK_NEAR((double)manifold.count, (double)(teeth * teeth), 0.0);
    for (uint32_t k = 0; k < manifold.count; ++k) {
        const se3di_contact_point *p = &manifold.points[k];
        const double line = s * (p->point[0] - 0.01) - c * (p->point[1] - 0.02);
        CHECK_NEAR(p->overlap, depth, 1e-12);
        CHECK_NEAR(p->normal[2], 1.0, 1e-12);
        CHECK_NEAR(p->point[2], -0.5 * depth, 1e-12);
        /* on the ridge of i and on that of j, to the depth */
        CHECK_NEAR(remainder(p->point[1] - 0.5 * PITCH * (teeth - 1), PITCH), 0.0, depth);
        CHECK_NEAR(remainder(line - 0.5 * PITCH * (teeth - 1), PITCH), 0.0, depth);
    }
    se3di_shape_release(&standard, &shapes[0]);
    se3di_shape_release(&standard, &shapes[1]);
}

static void ridges_that_cross_touch_once(void)
{
    static const double angles[] = {0.5 * 3.14159265358979323846, 1.3, 1.1, 2.0};
    for (size_t k = 0; k < sizeof angles / sizeof *angles; ++k) {
        for (size_t parts = 1; parts <= PARTS; parts += 2) {
            cross(2, parts, angles[k], 1e-3);
            cross(2, parts, angles[k], 1e-6);
        }
    }
    cross(3, 1, 0.5 * 3.14159265358979323846, 1e-3);
    cross(3, 3, 1.5, 1e-3);
}

int main(void)
{
    RUN(ridges_that_cross_touch_once);
    return check_finish();
}
