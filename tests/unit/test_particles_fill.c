/* SPDX-License-Identifier: BSD-3-Clause */
/* Regions filled with particles: no part of one is outside, and radii come as often as asked for.
 */
#include "check.h"
#include "se3d/se3d.h"
#include "support/bed.h"

#include <math.h>

#define MOST 5000

typedef struct filled {
    bed bed;
    se3d_fill_def fill;
    double r[3 * MOST], radius[MOST];
    size_t count;
} filled;

static void open_bed(filled *b)
{
    const double down[3] = {0.0, 0.0, -9.81};
    se3d_material_def stuff = se3d_material_def_default();
    stuff.density = 2500.0;
    stuff.stiffness = 1e4;
    bed_open(&b->bed, SE3D_CONTACT_LAW_HOOKE, down, NULL, &stuff);
    b->fill = se3d_fill_def_default();
    b->fill.material = b->bed.material;
    b->fill.seed = 5;
}

static void read_bed(filled *b)
{
    b->count = se3d_particles_count(b->bed.particles);
    CHECK(b->count <= MOST);
    CHECK(se3d_particles_get_all(b->bed.particles, b->count, b->r, NULL, NULL) == SE3D_OK);
    CHECK(se3d_particles_get_radii(b->bed.particles, b->count, b->radius) == SE3D_OK);
}

/* The largest distance of any point of a particle from the axis (or the centre: axis -1). */
static double reach(const filled *b, const double centre[3], int axis)
{
    double most = 0.0;
    for (size_t k = 0; k < b->count; ++k) {
        double square = 0.0;
        for (int a = 0; a < 3; ++a) {
            double d = b->r[3 * k + (size_t)a] - centre[a];
            square += a == axis ? 0.0 : d * d;
        }
        most = fmax(most, sqrt(square) + b->radius[k]);
    }
    return most;
}

static filled b; /* large */

static void regions_hold_every_part_of_their_particles(void)
{
    const double centre[3] = {1.0, 2.0, 3.0};
    for (int packing = 0; packing < 2; ++packing) {
        for (int32_t axis = -1; axis < 3; ++axis) {
            open_bed(&b);
            for (int a = 0; a < 3; ++a) {
                double half = a == axis ? 0.1 : 0.2;
                b.fill.lower[a] = centre[a] - half;
                b.fill.upper[a] = centre[a] + half;
            }
            b.fill.region = axis < 0 ? SE3D_FILL_REGION_SPHERE : SE3D_FILL_REGION_CYLINDER;
            b.fill.axis = axis < 0 ? 0 : axis;
            b.fill.radius_min = 0.008;
            b.fill.radius_max = 0.012;
            b.fill.jitter = packing ? 0.0 : 0.001;
            b.fill.count = packing ? 700 : 0;
            size_t added = 700;
            CHECK((packing
                       ? se3d_particles_fill_random(b.bed.particles, &b.fill)
                       : se3d_particles_fill_lattice(b.bed.particles, &b.fill, &added)) == SE3D_OK);
            read_bed(&b);
            CHECK(b.count == added);
            CHECK(b.count > 500); /* the volume is used: boxes hold 5832 or 2592 on the lattice */
            double most = reach(&b, centre, axis);
            CHECK(most <= 0.2 * (1.0 + 1e-12) && most > 0.19);
            bed_close(&b.bed);
        }
    }
}

static void radii_of_a_table_come_as_often_as_asked_for(void)
{
    const double radii[4] = {0.004, 0.006, 0.009, 0.02}, weights[4] = {1.0, 2.0, 1.0, 0.0};
    open_bed(&b);
    for (int a = 0; a < 3; ++a) {
        b.fill.upper[a] = 0.32;
    }
    b.fill.radii = radii;
    b.fill.weights = weights;
    b.fill.radius_count = 4;
    CHECK(se3d_particles_fill_lattice(b.bed.particles, &b.fill, NULL) == SE3D_OK);
    read_bed(&b);
    size_t seen[4] = {0, 0, 0, 0};
    for (size_t k = 0; k < b.count; ++k) {
        for (int i = 0; i < 4; ++i) {
            seen[i] += b.radius[k] == radii[i];
        }
    }
    double n = (double)b.count, deviation = sqrt(n * 0.25 * 0.75);
    CHECK(seen[0] + seen[1] + seen[2] == b.count && seen[3] == 0);
    CHECK_NEAR((double)seen[0], 0.25 * n, 4.0 * deviation);
    CHECK_NEAR((double)seen[1], 0.5 * n, 4.0 * deviation);
    b.fill.weights = NULL;
    b.fill.radius_count = 2;
    b.fill.lower[0] = 1.0;
    b.fill.upper[0] = 1.32;
    size_t added = 0;
    b.fill.count = 1000;
    CHECK(se3d_particles_fill_lattice(b.bed.particles, &b.fill, &added) == SE3D_OK &&
          added == 1000);
    bed_close(&b.bed);
}

static void tables_and_regions_are_checked(void)
{
    const double radii[2] = {0.01, -0.01}, weights[2] = {0.0, 0.0};
    open_bed(&b);
    for (int a = 0; a < 3; ++a) {
        b.fill.upper[a] = 0.1;
    }
    b.fill.radius_count = 2;
    CHECK(se3d_particles_fill_lattice(b.bed.particles, &b.fill, NULL) == SE3D_ERR_NULL);
    b.fill.radii = radii;
    CHECK(se3d_particles_fill_lattice(b.bed.particles, &b.fill, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(b.bed.system), "radii = -0.01");
    b.fill.radius_count = 1;
    b.fill.weights = weights;
    CHECK(se3d_particles_fill_lattice(b.bed.particles, &b.fill, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(b.bed.system), "weights");
    b.fill.weights = NULL;
    b.fill.region = 3;
    CHECK(se3d_particles_fill_random(b.bed.particles, &b.fill) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(b.bed.system), "region = 3");
    b.fill.region = SE3D_FILL_REGION_CYLINDER;
    b.fill.axis = -1;
    CHECK(se3d_particles_fill_random(b.bed.particles, &b.fill) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(b.bed.system), "axis = -1");
    CHECK(se3d_particles_count(b.bed.particles) == 0);
    bed_close(&b.bed);
}

/* Most of its points are outside the cylinder, so that few particles may take for ever to place. */
static void a_lattice_that_takes_for_ever_to_look_at_is_refused(void)
{
    open_bed(&b);
    b.fill.region = SE3D_FILL_REGION_CYLINDER;
    b.fill.axis = 1;
    b.fill.count = 3;
    b.fill.radius_min = b.fill.radius_max = 0.01;
    b.fill.upper[0] = b.fill.upper[2] = 1.0;
    b.fill.upper[1] = 1e21;
    CHECK(se3d_particles_fill_lattice(b.bed.particles, &b.fill, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(b.bed.system),
                   "points of the lattice from lower to upper");
    CHECK(se3d_particles_count(b.bed.particles) == 0);
    b.fill.region = SE3D_FILL_REGION_BOX;
    CHECK(se3d_particles_fill_lattice(b.bed.particles, &b.fill, NULL) == SE3D_OK);
    CHECK(se3d_particles_count(b.bed.particles) == 3);
    bed_close(&b.bed);
}

/* Two regions that meet across the border of a periodic domain share their room. */
static void places_across_a_periodic_border_are_taken_once(void)
{
    static double x[3 * 200], v[3 * 200], w[3 * 200];
    se3d_particles_def def = se3d_particles_def_default();
    se3d_particles *set = NULL;
    open_bed(&b);
    def.boundary[0] = SE3D_DOMAIN_BOUNDARY_PERIODIC;
    def.upper[0] = def.upper[1] = def.upper[2] = 1.0;
    CHECK(se3d_particles_create(b.bed.system, &def, &set) == SE3D_OK);
    b.fill.radius_min = b.fill.radius_max = 0.03;
    b.fill.upper[1] = b.fill.upper[2] = 0.4;
    b.fill.count = 40;
    for (int k = 0; k < 3; ++k) {
        b.fill.lower[0] = k == 0 ? 0.9 : k == 1 ? -0.05 : -0.3;
        b.fill.upper[0] = k == 0 ? 1.05 : k == 1 ? 0.1 : 1.2; /* the last is longer than a period */
        b.fill.seed = (uint64_t)k;
        const se3d_status status = se3d_particles_fill_random(set, &b.fill);
        CHECK(status == SE3D_OK || status == SE3D_ERR_NO_CONVERGENCE);
    }
    const size_t count = se3d_particles_count(set);
    CHECK(count >= 80 && count <= 200);
    CHECK(se3d_particles_get_all(set, count, x, v, w) == SE3D_OK);
    for (size_t i = 0; i < count; ++i) {
        for (size_t j = 0; j < i; ++j) {
            double square = 0.0;
            for (size_t a = 0; a < 3; ++a) {
                const double d = x[3 * i + a] - x[3 * j + a];
                square += a == 0 ? (d - nearbyint(d)) * (d - nearbyint(d)) : d * d;
            }
            CHECK(square > 0.06 * 0.06 * (1.0 - 1e-12));
        }
    }
    se3d_particles_destroy(set);
    bed_close(&b.bed);
}

/* A count that cannot be meant is told at once. */
static void a_lattice_of_too_many_particles_is_refused(void)
{
    open_bed(&b);
    b.fill.radius_min = b.fill.radius_max = 0.03;
    b.fill.upper[0] = b.fill.upper[1] = b.fill.upper[2] = 1e5;
    b.fill.count = (size_t)1e15;
    CHECK(se3d_particles_fill_lattice(b.bed.particles, &b.fill, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_count(b.bed.particles) == 0);
    bed_close(&b.bed);
}

/* A region of less than the spacing, but of more than a particle, holds a layer in its middle. */
static void narrow_regions_hold_one_layer(void)
{
    static const double widths[3] = {0.02, 0.0211, 0.022};
    for (int k = 0; k < 3; ++k) {
        size_t added = 0;
        open_bed(&b);
        b.fill.radius_min = b.fill.radius_max = 0.01;
        b.fill.jitter = 0.02 < widths[k] ? 5e-4 : 0.0;
        b.fill.lower[1] = 0.3;
        b.fill.upper[0] = b.fill.upper[2] = 0.1;
        b.fill.upper[1] = 0.3 + widths[k];
        CHECK(!se3d_particles_fill_lattice(b.bed.particles, &b.fill, &added) && added == 16);
        read_bed(&b);
        for (size_t n = 0; n < b.count; ++n) {
            const double y = b.r[3 * n + 1];
            CHECK(y > 0.31 - 1e-9 && y < 0.3 + widths[k] - 0.01 + 1e-9);
        }
        bed_close(&b.bed);
    }
}

/* A box, cylinder or sphere as large as a particle holds it, whatever its borders round to. */
static void a_region_of_one_diameter_holds_one(void)
{
    static const double lowers[4] = {0.1, 0.7, -12.3, 1000.1};
    for (int k = 0; k < 4 * 3 * 2; ++k) {
        const double lower = lowers[k % 4];
        size_t added = 1;
        open_bed(&b);
        b.fill.radius_min = b.fill.radius_max = 0.1;
        b.fill.region = k / 4 % 3;
        b.fill.count = 1;
        for (int a = 0; a < 3; ++a) {
            b.fill.lower[a] = lower;
            b.fill.upper[a] = lower + 0.2;
        }
        b.fill.upper[2] = k == 0 ? 0.3 : b.fill.upper[2]; /* .3 - .1 < .2 */
        CHECK((k / 12 ? se3d_particles_fill_random(b.bed.particles, &b.fill)
                      : se3d_particles_fill_lattice(b.bed.particles, &b.fill, &added)) == SE3D_OK);
        read_bed(&b);
        CHECK(added == 1 && b.count == 1);
        CHECK_NEAR(b.r[2], lower + 0.1, 1e-9);
        b.fill.upper[1] -= 1e-6;
        CHECK(se3d_particles_fill_random(b.bed.particles, &b.fill) == SE3D_ERR_INVALID_ARGUMENT);
        bed_close(&b.bed);
    }
}

static void check_plane(double y)
{
    read_bed(&b);
    for (size_t n = 0; n < b.count; ++n) {
        CHECK(!(fabs(b.r[3 * n + 1] - y) > 0.0));
    }
}

/* A region without width along an axis holds centres in a plane, where disks of all sizes stay. */
static void flat_regions_hold_models_in_2d(void)
{
    static const double y = 0.3, at[3] = {0.0, 0.0, 0.0}, far[3] = {0.22, 0.0, 0.0};
    static const double up[3] = {0.0, 0.0, 1.0}, right[3] = {1.0, 0.0, 0.0},
                        left[3] = {-1.0, 0.0, 0.0};
    for (int packing = 0; packing < 2; ++packing) {
        size_t added = 0;
        open_bed(&b);
        (void)bed_add_plane(&b.bed, at, up);
        (void)bed_add_plane(&b.bed, at, right);
        (void)bed_add_plane(&b.bed, far, left);
        b.fill.radius_min = 0.005;
        b.fill.radius_max = 0.01;
        b.fill.jitter = 5e-4;
        b.fill.lower[1] = b.fill.upper[1] = y;
        b.fill.upper[0] = b.fill.upper[2] = 0.22;
        b.fill.count = packing ? 60 : 0;
        CHECK((packing ? se3d_particles_fill_random(b.bed.particles, &b.fill)
                       : se3d_particles_fill_lattice(b.bed.particles, &b.fill, &added)) == SE3D_OK);
        CHECK(se3d_particles_count(b.bed.particles) == (packing ? 60 : 100));
        check_plane(y);
        se3d_particles_source_def source = se3d_particles_source_def_default();
        se3d_fill_def above = b.fill;
        source.fill = &above;
        above.lower[2] = 0.24;
        above.upper[2] = 0.3;
        source.rate = 200.0;
        CHECK(se3d_particles_add_source(b.bed.particles, &source, NULL) == SE3D_OK);
        CHECK(se3d_particles_run(b.bed.particles, 0.2) == SE3D_OK);
        CHECK(se3d_particles_count(b.bed.particles) > (packing ? 90U : 130U));
        check_plane(y);
        b.fill.count = 1;
        b.fill.upper[1] = y + 1e-3;
        CHECK(se3d_particles_fill_random(b.bed.particles, &b.fill) == SE3D_ERR_INVALID_ARGUMENT);
        b.fill.upper[1] = y;
        b.fill.region = SE3D_FILL_REGION_CYLINDER;
        CHECK(se3d_particles_fill_random(b.bed.particles, &b.fill) == SE3D_ERR_INVALID_ARGUMENT);
        CHECK_CONTAINS(se3d_system_get_error(b.bed.system), "upper");
        b.fill.axis = 1;
        b.fill.lower[2] = 0.5;
        b.fill.upper[2] = 0.72;
        CHECK(se3d_particles_fill_random(b.bed.particles, &b.fill) == SE3D_OK);
        bed_close(&b.bed);
    }
}

int main(void)
{
    RUN(flat_regions_hold_models_in_2d);
    RUN(places_across_a_periodic_border_are_taken_once);
    RUN(a_region_of_one_diameter_holds_one);
    RUN(a_lattice_of_too_many_particles_is_refused);
    RUN(regions_hold_every_part_of_their_particles);
    RUN(radii_of_a_table_come_as_often_as_asked_for);
    RUN(tables_and_regions_are_checked);
    RUN(narrow_regions_hold_one_layer);
    RUN(a_lattice_that_takes_for_ever_to_look_at_is_refused);
    return check_finish();
}
