/* SPDX-License-Identifier: BSD-3-Clause */
/* Semicircular arches of stones without mortar, by default. Below a thickness of 10.75 % of the
 * radius none stands under its own weight, however rough (Milankovitch 1907; Alexakis and Makris,
 * "Limit equilibrium analysis and the minimum thickness of circular masonry arches", 2013): it
 * falls by hinges, where stones turn about their edges, which are parallel but for rounding. Stones
 * that are somewhat soft want a little more. */
#include "support/scene.h"

#define STONES 31  /* not even */
#define HALF   0.1 /* of the depth */
#define RHO    2000.0

/* A stone about its centre of mass, x outward, and how far that is from the middle of the arch. */
static double cut_stone(int stones, double thickness, double corners[24], double *mass, double J[3])
{
    const double pi = 3.14159265358979324, inner = 1.0 - 0.5 * thickness;
    const double x[4] = {inner, inner + thickness, inner + thickness, inner};
    const double side[4] = {-1.0, -1.0, 1.0, 1.0}, half = 0.5 * pi / stones;
    double p[4][2], area = 0.0, center = 0.0, xx = 0.0, zz = 0.0;
    for (int k = 0; k < 4; ++k) {
        p[k][0] = x[k] * cos(half);
        p[k][1] = x[k] * side[k] * sin(half);
    }
    for (int k = 0; k < 4; ++k) { /* of a polygon */
        const double *a = p[k], *b = p[(k + 1) % 4], twice = a[0] * b[1] - b[0] * a[1];
        area += 0.5 * twice;
        center += twice * (a[0] + b[0]) / 6.0;
        xx += twice * (a[0] * a[0] + a[0] * b[0] + b[0] * b[0]) / 12.0;
        zz += twice * (a[1] * a[1] + a[1] * b[1] + b[1] * b[1]) / 12.0;
    }
    center /= area;
    xx -= area * center * center;
    *mass = RHO * 2.0 * HALF * area;
    const double yy = *mass * HALF * HALF / 3.0;
    J[0] = yy + RHO * 2.0 * HALF * zz;
    J[1] = RHO * 2.0 * HALF * (xx + zz);
    J[2] = yy + RHO * 2.0 * HALF * xx;
    for (int k = 0; k < 8; ++k) {
        corners[3 * k] = p[k % 4][0] - center;
        corners[3 * k + 1] = k < 4 ? -HALF : HALF;
        corners[3 * k + 2] = p[k % 4][1];
    }
    return center;
}

/* How high the keystone is after 3 s. */
static double keep_arch(int stones, double thickness)
{
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.8, 0.1, 1e7);
    const double y[3] = {0.0, 1.0, 0.0};
    double corners[24], J[3], mass, z[3];
    const double away = cut_stone(stones, thickness, corners, &mass, J);
    se3d_body keystone = scene_ground(&s);
    (void)scene_floor(&s, 0.0);
    for (int k = 0; k < stones; ++k) {
        const double angle = 3.14159265358979324 * (k + 0.5) / stones;
        const double r[3] = {away * cos(angle), 0.0, away * sin(angle)};
        const se3d_body stone = scene_body(&s, mass, J, r, scene_zero);
        se3d_shape_def def = scene_shape(&s, stone);
        se3d_shape shape;
        scene_turn(&s, stone, y, -angle);
        def.vertices = corners;
        def.vertex_count = 8;
        CHECK(se3d_shape_create_hull(s.system, &def, &shape) == SE3D_OK);
        keystone = k == stones / 2 ? stone : keystone;
    }
    scene_solve(&s, SE3D_METHOD_AUTO, SE3D_FORMULATION_AUTO, 0.0, 0.0);
    CHECK(scene_run(&s, 3.0));
    CHECK(!se3d_body_get_position(s.system, keystone, z));
    scene_end(&s);
    return z[2];
}

static void arches_stand_from_the_thickness_of_milankovitch_on(void)
{
    CHECK(keep_arch(STONES, 0.10) < 0.2);
    CHECK(keep_arch(STONES, 0.105) < 0.2);
    CHECK_NEAR(keep_arch(STONES, 0.12), 1.0, 2e-3);
    CHECK_NEAR(keep_arch(STONES, 0.16), 1.0, 1e-3);
}

/* As stones lie on the ground in the end: flat. */
static void thin_arches_fall_to_the_end(void)
{
    CHECK_NEAR(keep_arch(9, 0.05), 0.025, 2e-3);
    CHECK_NEAR(keep_arch(11, 0.062), 0.031, 2e-3);
    CHECK_NEAR(keep_arch(11, 0.08), 0.04, 2e-3);
    CHECK_NEAR(keep_arch(13, 0.04), 0.02, 2e-3);
}

int main(void)
{
    RUN(thin_arches_fall_to_the_end);
    RUN(arches_stand_from_the_thickness_of_milankovitch_on);
    return check_finish();
}
