/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles: every bad argument is refused with a message, and every failing allocation leaves
 * things as they were. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/counting.h"

#include <stdlib.h>

typedef struct bed {
    support_counting counting;
    se3d_allocator allocator;
    se3d_system *system;
    se3d_particles *particles;
    se3d_material material;
    se3d_shape wall;
} bed;

static se3d_material_def stuff(void)
{
    se3d_material_def def = se3d_material_def_default();
    def.density = 2500.0;
    def.stiffness = 2.5e4;
    def.young = 1e8;
    def.rolling_friction = 0.05;
    return def;
}

static void bed_init(bed *b)
{
    *b = (bed){.wall = {0, 0}};
    b->allocator = support_counting_allocator(&b->counting);
    se3d_system_def def = se3d_system_def_default();
    def.allocator = &b->allocator;
    CHECK(se3d_system_create(&def, &b->system) == SE3D_OK);
    CHECK(se3d_particles_create(b->system, NULL, &b->particles) == SE3D_OK);
    se3d_material_def material = stuff();
    CHECK(se3d_material_create(b->system, &material, &b->material) == SE3D_OK);
    se3d_shape_def wall = se3d_shape_def_default();
    wall.material = b->material;
    CHECK(se3d_shape_create_plane(b->system, &wall, &b->wall) == SE3D_OK);
}

static void bed_destroy(bed *b)
{
    se3d_particles_destroy(b->particles);
    se3d_system_destroy(b->system);
    CHECK(b->counting.live == 0 && b->counting.bytes == 0 && b->counting.wrong == 0);
}

static se3d_fill_def fill_of(const bed *b)
{
    se3d_fill_def def = se3d_fill_def_default();
    def.material = b->material;
    def.upper[0] = def.upper[1] = def.upper[2] = 0.05;
    def.radius_min = def.radius_max = 0.005;
    def.spacing = 0.00999; /* they touch */
    def.count = 40;
    return def;
}

static void refused(const bed *b, se3d_status actual, se3d_status expected, const char *part)
{
    CHECK(actual == expected);
    CHECK_CONTAINS(se3d_system_get_error(b->system), part);
}

static void bad_materials_are_refused(void)
{
    static const size_t fields[11] = {offsetof(se3d_material_def, density),
                                      offsetof(se3d_material_def, friction),
                                      offsetof(se3d_material_def, restitution),
                                      offsetof(se3d_material_def, rolling_friction),
                                      offsetof(se3d_material_def, torsional_friction),
                                      offsetof(se3d_material_def, stiffness),
                                      offsetof(se3d_material_def, tangential_ratio),
                                      offsetof(se3d_material_def, young),
                                      offsetof(se3d_material_def, poisson),
                                      offsetof(se3d_material_def, cohesion),
                                      offsetof(se3d_material_def, adhesion)};
    bed b;
    bed_init(&b);
    for (int k = 0; k < 33; ++k) {
        se3d_material_def def = stuff();
        se3d_material material = {1, 1};
        double bad = k % 3 == 0 ? -1.0 : k % 3 == 1 ? strtod("nan", NULL) : HUGE_VAL;
        memcpy((char *)&def + fields[k / 3], &bad, sizeof bad);
        refused(&b, se3d_material_create(b.system, &def, &material), SE3D_ERR_INVALID_ARGUMENT,
                "must be finite");
        CHECK(material.index1 == 0 && material.generation == 0);
    }
    se3d_material_def def = stuff();
    se3d_material material;
    def.restitution = 0.0;
    refused(&b, se3d_material_create(b.system, &def, &material), SE3D_ERR_INVALID_ARGUMENT,
            "restitution = 0");
    def.struct_size = 0;
    refused(&b, se3d_material_create(b.system, &def, &material), SE3D_ERR_INVALID_ARGUMENT,
            "struct_size");
    refused(&b, se3d_material_create(b.system, NULL, &material), SE3D_ERR_NULL, "NULL");
    CHECK(se3d_material_create(NULL, &def, &material) == SE3D_ERR_NULL);
    bed_destroy(&b);
}

static void bad_sets_are_refused(void)
{
    bed b;
    bed_init(&b);
    for (int k = 0; k < 8; ++k) {
        se3d_particles_def def = se3d_particles_def_default();
        se3d_particles *out = b.particles;
        def.threads = k == 0 ? 1 << 20 : def.threads;
        def.threads = k == 1 ? 0 : def.threads;
        def.step = k == 2 ? -1.0 : def.step;
        def.skin = k == 3 ? 0.0 : def.skin;
        def.skin = k == 4 ? strtod("nan", NULL) : def.skin;
        def.boundary[1] = k == 5 ? 3 : def.boundary[1];
        def.boundary[2] = k == 6 ? SE3D_DOMAIN_BOUNDARY_SINK : def.boundary[2]; /* lower = upper */
        def.struct_size = k == 7 ? 4096 : def.struct_size;
        refused(&b, se3d_particles_create(b.system, &def, &out), SE3D_ERR_INVALID_ARGUMENT, "must");
        CHECK(out == NULL);
    }
    CHECK(se3d_particles_create(NULL, NULL, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_create(b.system, NULL, NULL) == SE3D_ERR_NULL);
    bed_destroy(&b);
}

/* A period in which a particle would meet a neighbour twice is found when the particle comes. */
static void too_short_a_period_is_found_at_once(void)
{
    bed b;
    bed_init(&b);
    se3d_particles *set;
    se3d_particles_def def = se3d_particles_def_default();
    def.boundary[1] = SE3D_DOMAIN_BOUNDARY_PERIODIC;
    def.upper[1] = 0.39;
    CHECK(se3d_particles_create(b.system, &def, &set) == SE3D_OK);
    const double r[3] = {0.0, 0.2, 1.0}, radius = 0.1, fits = 0.096;
    se3d_fill_def fill = se3d_fill_def_default();
    se3d_particles_source_def source = se3d_particles_source_def_default();
    fill.material = b.material;
    fill.radius_min = 0.01;
    fill.radius_max = 0.1;
    fill.count = 1;
    fill.upper[0] = fill.upper[1] = fill.upper[2] = 0.39;
    source.fill = &fill;
    source.rate = 1.0;
    const char *text = "periodic along y and only 0.39 m long";
    refused(&b, se3d_particles_add(set, b.material, 1, r, &radius, NULL, NULL, NULL),
            SE3D_ERR_INVALID_ARGUMENT, text);
    refused(&b, se3d_particles_fill_lattice(set, &fill, NULL), SE3D_ERR_INVALID_ARGUMENT, text);
    refused(&b, se3d_particles_fill_random(set, &fill), SE3D_ERR_INVALID_ARGUMENT, text);
    refused(&b, se3d_particles_add_source(set, &source, NULL), SE3D_ERR_INVALID_ARGUMENT, text);
    CHECK(se3d_particles_count(set) == 0);
    CHECK(se3d_particles_add(set, b.material, 1, r, &fits, NULL, NULL, NULL) == SE3D_OK);
    CHECK(se3d_particles_step(set, 10) == SE3D_OK); /* with a thinner skin */
    se3d_particles_destroy(set);
    bed_destroy(&b);
}

static void stale_and_foreign_handles_are_detected(void)
{
    bed a, b;
    bed_init(&a);
    bed_init(&b);
    const double r[3] = {0.0, 0.0, 1.0}, radius = 0.1;
    double force[3], torque[3];
    refused(&a, se3d_particles_add(a.particles, b.material, 1, r, &radius, NULL, NULL, NULL),
            SE3D_ERR_STALE_HANDLE, "material");
    refused(&a, se3d_shape_destroy(a.system, b.wall), SE3D_ERR_STALE_HANDLE, "shape");
    CHECK(se3d_shape_get_wrench(a.system, b.wall, force, torque) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_shape_destroy(a.system, a.wall) == SE3D_OK);
    CHECK(se3d_shape_get_wrench(a.system, a.wall, force, torque) == SE3D_ERR_STALE_HANDLE);
    se3d_shape_def wall = se3d_shape_def_default();
    wall.material = b.material;
    refused(&a, se3d_shape_create_plane(a.system, &wall, &a.wall), SE3D_ERR_STALE_HANDLE,
            "material");
    wall.material = a.material;
    wall.normal[2] = strtod("nan", NULL);
    refused(&a, se3d_shape_create_plane(a.system, &wall, &a.wall), SE3D_ERR_INVALID_ARGUMENT,
            "normal");
    refused(&a, se3d_shape_create_box(a.system, &wall, &a.wall), SE3D_ERR_INVALID_ARGUMENT, "size");
    se3d_material_pair_def pair = se3d_material_pair_def_default();
    refused(&a, se3d_material_set_pair(a.system, a.material, b.material, &pair),
            SE3D_ERR_STALE_HANDLE, "material b");
    pair.restitution = 2.0;
    refused(&a, se3d_material_set_pair(a.system, a.material, a.material, &pair),
            SE3D_ERR_INVALID_ARGUMENT, "restitution = 2");
    refused(&a, se3d_particles_restore(a.particles, b.particles), SE3D_ERR_STATE, "another system");
    bed_destroy(&a);
    bed_destroy(&b);
}

static void bad_arrays_are_refused_and_change_nothing(void)
{
    bed b;
    bed_init(&b);
    double r[6] = {0.0, 0.0, 1.0, 0.0, 0.0, 2.0}, radius[2] = {0.1, 0.0}, out[6];
    refused(&b, se3d_particles_add(b.particles, b.material, 2, r, radius, NULL, NULL, NULL),
            SE3D_ERR_INVALID_ARGUMENT, "radius[1] = 0");
    radius[1] = 0.1;
    r[4] = strtod("nan", NULL);
    refused(&b, se3d_particles_add(b.particles, b.material, 2, r, radius, NULL, NULL, NULL),
            SE3D_ERR_INVALID_ARGUMENT, "r[4]");
    refused(&b, se3d_particles_add(b.particles, b.material, 2, NULL, radius, NULL, NULL, NULL),
            SE3D_ERR_NULL, "r is NULL");
    CHECK(se3d_particles_count(b.particles) == 0);
    r[4] = 0.0;
    CHECK(se3d_particles_add(b.particles, b.material, 2, r, radius, NULL, NULL, NULL) == SE3D_OK);
    uint64_t hash = se3d_particles_hash(b.particles);
    r[5] = HUGE_VAL;
    refused(&b, se3d_particles_set_all(b.particles, 2, r, NULL, NULL), SE3D_ERR_INVALID_ARGUMENT,
            "r[5]");
    refused(&b, se3d_particles_set_all(b.particles, 1, r, NULL, NULL), SE3D_ERR_INVALID_ARGUMENT,
            "count = 1");
    CHECK(se3d_particles_hash(b.particles) == hash);
    CHECK(se3d_particles_get_all(b.particles, 3, out, NULL, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_forces(b.particles, 0, out, out) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_particles_get_radii(b.particles, 2, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_ids(NULL, 0, NULL) == SE3D_ERR_NULL);
    refused(&b, se3d_particles_run(b.particles, -1.0), SE3D_ERR_INVALID_ARGUMENT, "not before");
    refused(&b, se3d_particles_set_step(b.particles, -1.0), SE3D_ERR_INVALID_ARGUMENT, "step");
    bed_destroy(&b);
}

static void null_is_always_answered(void)
{
    se3d_particles_stats stats;
    se3d_particles_energy energy;
    double number;
    CHECK(se3d_particles_step(NULL, 1) == SE3D_ERR_NULL);
    CHECK(se3d_particles_run(NULL, 1.0) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_stats(NULL, &stats) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_energy(NULL, &energy) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_step(NULL, &number) == SE3D_ERR_NULL);
    CHECK(se3d_particles_get_time(NULL, &number) == SE3D_ERR_NULL);
    CHECK(se3d_particles_clone(NULL, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_remove(NULL, 0, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_fill_lattice(NULL, NULL, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_fill_random(NULL, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_particles_count(NULL) == 0 && se3d_particles_hash(NULL) == 0);
    CHECK(se3d_particles_count_contacts(NULL) == 0);
    se3d_particles_destroy(NULL);
}

/* Operations on a bed of 40 that touch. */
static se3d_status do_add(bed *b)
{
    se3d_fill_def fill = fill_of(b);
    fill.lower[2] = 1.0;
    fill.upper[2] = 1.05;
    return se3d_particles_fill_lattice(b->particles, &fill, NULL);
}

static se3d_status do_pack(bed *b)
{
    se3d_fill_def fill = fill_of(b);
    fill.lower[2] = 1.0;
    fill.upper[2] = 1.2;
    return se3d_particles_fill_random(b->particles, &fill);
}

static se3d_status do_remove(bed *b)
{
    const uint32_t ids[2] = {3, 17};
    return se3d_particles_remove(b->particles, 2, ids);
}

static se3d_status do_material(bed *b)
{
    se3d_material_def def = stuff();
    se3d_material material;
    return se3d_material_create(b->system, &def, &material);
}

static se3d_status do_wall(bed *b)
{
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape wall;
    def.material = b->material;
    def.position[2] = -0.1;
    return se3d_shape_create_plane(b->system, &def, &wall);
}

static se3d_status do_mesh(bed *b)
{
    static const double points[12] = {0.0, 0.0, -0.1, 0.1, 0.0, -0.1,
                                      0.0, 0.1, -0.1, 0.1, 0.1, 0.0};
    static const uint32_t faces[6] = {0, 1, 2, 1, 3, 2};
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape shape, hull;
    def.material = b->material;
    def.vertices = points;
    def.vertex_count = 4;
    def.triangles = faces;
    def.triangle_count = 2;
    def.name = "ramp";
    se3d_status status = se3d_shape_create_mesh(b->system, &def, &shape);
    if (status == SE3D_OK) {
        def.name = NULL;
        def.material = (se3d_material){0, 0};
        status = se3d_shape_create_hull(b->system, &def, &hull);
        if (status < 0) {
            CHECK(se3d_shape_destroy(b->system, shape) == SE3D_OK);
        }
    }
    return status;
}

/* A step after a mesh has come under the particles. */
static se3d_status do_step_on_a_mesh(bed *b)
{
    se3d_shape shape;
    if (se3d_shape_find(b->system, "ramp", &shape) != SE3D_OK) {
        se3d_status status = do_mesh(b);
        if (status < 0) {
            return status;
        }
    }
    return se3d_particles_step(b->particles, 5);
}

static se3d_status do_clone_system(bed *b)
{
    se3d_system *copy = NULL;
    se3d_status status = do_mesh(b);
    if (status == SE3D_OK) {
        status = se3d_system_clone(b->system, &copy);
        se3d_shape shape;
        CHECK(se3d_shape_find(b->system, "ramp", &shape) == SE3D_OK);
        if (status < 0) {
            CHECK(se3d_shape_destroy(b->system, shape) == SE3D_OK);
        }
        se3d_system_destroy(copy);
    }
    return status;
}

static se3d_status do_clone(bed *b)
{
    se3d_particles *copy;
    se3d_status status = se3d_particles_clone(b->particles, &copy);
    CHECK((status == SE3D_OK) == (copy != NULL));
    se3d_particles_destroy(copy);
    return status;
}

static se3d_status do_step(bed *b)
{
    return se3d_particles_step(b->particles, 200);
}

static se3d_status do_first_step(bed *b)
{
    return se3d_particles_step(b->particles, 1);
}

static void sweep(se3d_status (*operation)(bed *), int steps_before, int changes_on_failure)
{
    int failed = 1;
    for (size_t at = 1; failed && at < 200; ++at) {
        bed b;
        bed_init(&b);
        se3d_fill_def fill = fill_of(&b);
        CHECK(se3d_particles_fill_lattice(b.particles, &fill, NULL) == SE3D_OK);
        CHECK(se3d_particles_step(b.particles, (size_t)steps_before) == SE3D_OK);
        uint64_t hash = se3d_particles_hash(b.particles);
        size_t count = se3d_particles_count(b.particles);
        b.counting.fail_at = b.counting.calls + at;
        se3d_status status = operation(&b);
        failed = b.counting.failed > 0;
        CHECK(status == (failed ? SE3D_ERR_NO_MEMORY : SE3D_OK));
        if (failed && !changes_on_failure) {
            CHECK(se3d_particles_hash(b.particles) == hash);
            CHECK(se3d_particles_count(b.particles) == count);
        }
        b.counting.fail_at = 0;
        CHECK(!failed || operation(&b) == SE3D_OK); /* the second attempt */
        CHECK(se3d_particles_step(b.particles, 3) == SE3D_OK);
        bed_destroy(&b);
    }
    CHECK(!failed);
}

static void every_failing_allocation_is_survived(void)
{
    sweep(do_add, 50, 0);
    sweep(do_pack, 50, 0);
    sweep(do_remove, 50, 0);
    sweep(do_material, 50, 0);
    sweep(do_wall, 50, 0);
    sweep(do_mesh, 50, 0);
    sweep(do_step_on_a_mesh, 50, 1);
    sweep(do_clone_system, 0, 0);
    sweep(do_clone, 50, 0);
    sweep(do_first_step, 0, 0);
    sweep(do_step, 0, 1);
    sweep(do_step, 50, 1);
}

static void settled_steps_allocate_nothing(void)
{
    bed b;
    bed_init(&b);
    se3d_fill_def fill = fill_of(&b);
    CHECK(se3d_particles_fill_lattice(b.particles, &fill, NULL) == SE3D_OK);
    CHECK(se3d_particles_run(b.particles, 1.0) == SE3D_OK);
    size_t calls = b.counting.calls;
    CHECK(se3d_particles_step(b.particles, 1000) == SE3D_OK);
    CHECK(b.counting.calls == calls);
    bed_destroy(&b);
}

int main(void)
{
    RUN(bad_materials_are_refused);
    RUN(bad_sets_are_refused);
    RUN(too_short_a_period_is_found_at_once);
    RUN(stale_and_foreign_handles_are_detected);
    RUN(bad_arrays_are_refused_and_change_nothing);
    RUN(null_is_always_answered);
    RUN(every_failing_allocation_is_survived);
    RUN(settled_steps_allocate_nothing);
    return check_finish();
}
