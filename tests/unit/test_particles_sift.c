/* SPDX-License-Identifier: BSD-3-Clause */
/* Spheres and triangles, many at a time: nothing that touches is sifted out, what is found is what
 * one at a time gives, to the bit, at every level of instructions, and little else is left. */
#include "check.h"
#include "contact/shape/mesh.h"
#include "math/vec3.h"
#include "particles/sift.h"
#include "particles/wall.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static se3d_allocator standard;

enum { CORNERS = 24, TRIANGLES = 24 };

/* From 0 to 1. */
static double part(uint64_t *seed)
{
    return 0.5 + 0.5 * check_random(seed);
}

/* Random triangles, of which some are slender and some needles. */
static int build(uint64_t *seed, double slender, se3di_shape *shape)
{
    double vertices[3 * CORNERS];
    uint32_t triangles[3 * TRIANGLES];
    for (int k = 0; k < CORNERS; ++k) {
        for (int a = 0; a < 3; ++a) {
            vertices[3 * k + a] = check_random(seed);
        }
        if (k % 3 == 2) { /* near to the line through the two before it */
            const double *a = vertices + 3 * (k - 2), *b = a + 3;
            const double t = part(seed);
            for (int n = 0; n < 3; ++n) {
                vertices[3 * k + n] = a[n] + t * (b[n] - a[n]) + slender * vertices[3 * k + n];
            }
        }
    }
    for (uint32_t k = 0; k < TRIANGLES; ++k) {
        const uint32_t first = k < CORNERS / 3 ? 3 * k : (uint32_t)(part(seed) * CORNERS);
        for (uint32_t n = 0; n < 3; ++n) {
            triangles[3 * k + n] = (first + n * (1 + k % 5)) % CORNERS;
        }
        if (k < CORNERS / 3) {
            triangles[3 * k + 1] = first + 1;
            triangles[3 * k + 2] = first + 2;
        }
    }
    return se3di_mesh_build(&standard, vertices, CORNERS, triangles, TRIANGLES, shape) == SE3D_OK;
}

static void turn_at_random(uint64_t *seed, se3di_wall *wall)
{
    double axis[3] = {check_random(seed), check_random(seed), 1.5};
    const double angle = 3.0 * check_random(seed), c = cos(angle), s = sin(angle);
    se3di_scale(1.0 / se3di_norm(axis), axis, axis);
    for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3, d = (a + 2) % 3;
        wall->pose.x[a] = check_random(seed);
        wall->pose.R[4 * a] = c + (1.0 - c) * axis[a] * axis[a];
        wall->pose.R[3 * a + b] = (1.0 - c) * axis[a] * axis[b] - s * axis[d];
        wall->pose.R[3 * b + a] = (1.0 - c) * axis[a] * axis[b] + s * axis[d];
    }
}

/* A sphere that touches a triangle on its face, a side or a corner, or just not. */
static void place(uint64_t *seed, const se3di_wall *wall, size_t k, se3di_sift *pairs)
{
    const se3di_shape *shape = &wall->shape;
    const uint32_t triangle = (uint32_t)(part(seed) * (double)shape->triangle_count);
    double w[3] = {part(seed), part(seed), part(seed)}, local[3], x[3];
    w[0] *= (double)(k % 3 > 0);
    w[1] *= (double)(k % 7 > 0);
    const double sum = w[0] + w[1] + w[2];
    const double radius = 0.02 + 0.3 * part(seed);
    for (int a = 0; a < 3; ++a) {
        local[a] = 1.1 * radius * check_random(seed);
        for (int n = 0; n < 3; ++n) {
            const size_t corner = shape->triangles[3 * triangle + (uint32_t)n];
            local[a] += w[n] / sum * shape->vertices[3 * corner + (size_t)a];
        }
    }
    se3di_mul(wall->pose.R, local, x);
    pairs->radius[k] = radius;
    pairs->triangle[k] = k % 2 ? triangle : (uint32_t)(part(seed) * (double)shape->triangle_count);
    for (int a = 0; a < 3; ++a) {
        pairs->x[a][k] = x[a] + wall->pose.x[a];
    }
}

static int bit(const uint8_t *of, size_t k)
{
    return of[k / 8] >> (k % 8) & 1;
}

typedef struct tally {
    size_t touching, left, inside;
} tally;

/* Whether the pairs are as one at a time gives them. */
static int is_right(const se3di_wall *wall, const se3di_sift *pairs, size_t count, tally *sum)
{
    for (size_t k = 0; k < count; ++k) {
        const double x[3] = {pairs->x[0][k], pairs->x[1][k], pairs->x[2][k]};
        double local[3], normal[3];
        se3di_touch touch;
        se3di_wall_local(wall, x, local);
        const size_t touches = se3di_mesh_contacts_among(&wall->shape, &pairs->triangle[k], 1,
                                                         local, pairs->radius[k], 1, &touch);
        const int left = bit(pairs->left, k), inside = bit(pairs->inside, k);
        sum->touching += touches;
        sum->left += (size_t)left;
        sum->inside += (size_t)inside;
        if ((touches && !left) || (inside && !(touches && left))) {
            return 0;
        }
        const double found[4] = {pairs->distance[k], pairs->local[0][k], pairs->local[1][k],
                                 pairs->local[2][k]};
        const double ground[3] = {pairs->normal[0][k], pairs->normal[1][k], pairs->normal[2][k]};
        if (inside) {
            se3di_mul(wall->pose.R, touch.normal, normal);
            if (memcmp(&found[0], &touch.distance, sizeof(double)) != 0 ||
                memcmp(&found[1], touch.normal, sizeof touch.normal) != 0 ||
                memcmp(ground, normal, sizeof normal) != 0) {
                return 0;
            }
        }
    }
    return 1;
}

static void nothing_that_touches_is_sifted_out(void)
{
    const se3di_kernels *levels[4] = {se3di_particle_kernels_portable(),
                                      se3di_particle_kernels_fma(), se3di_particle_kernels_avx2(),
                                      se3di_particle_kernels_avx512()};
    static const double slender[4] = {1.0, 1e-3, 1e-7, 1e-12};
    static se3di_sift asked, first, here;
    uint64_t seed;
    for (int level = 0; level < 4; ++level) {
        tally sum = {0, 0, 0};
        seed = 5;
        for (int trial = 0; levels[level] && trial < 60; ++trial) {
            se3di_wall wall;
            memset(&wall, 0, sizeof wall);
            CHECK(build(&seed, slender[trial % 4], &wall.shape));
            turn_at_random(&seed, &wall);
            const size_t count = trial % 9 ? SE3DI_SIFT_SIZE : 21;
            memset(&asked, 0, sizeof asked);
            for (size_t k = 0; k < count; ++k) {
                place(&seed, &wall, k, &asked);
            }
            first = here = asked;
            levels[0]->sift(&wall, count, &first);
            levels[level]->sift(&wall, count, &here);
            CHECK(is_right(&wall, &here, count, &sum));
            CHECK(memcmp(here.left, first.left, (count + 7) / 8) == 0);
            CHECK(memcmp(here.inside, first.inside, (count + 7) / 8) == 0);
            se3di_shape_release(&standard, &wall.shape);
        }
        if (levels[level]) {
            CHECK(sum.inside > 500 && sum.touching > 2 * sum.inside);
            CHECK(sum.left < sum.touching + sum.touching / 4);
        }
    }
}

int main(void)
{
    standard = se3di_alloc_default();
    RUN(nothing_that_touches_is_sifted_out);
    return check_finish();
}
