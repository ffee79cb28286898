/* SPDX-License-Identifier: BSD-3-Clause */
/* Few fast particles among slow ones, and walls that move: what touches is always among what is
 * evaluated, and the fast ones do not make lists for the slow ones. */
#include "check.h"
#include "contact/shape/mesh.h"
#include "particles/wall.h"
#include "se3d/se3d.h"
#include "support/bed.h"
#include "system/particles.h"

#include <math.h>
#include <stdlib.h>

#define WIDTH 0.12

static const double none[3] = {0.0, 0.0, 0.0};

static void open_cloud(bed *b, size_t count, double spacing)
{
    se3d_material_def material = se3d_material_def_default();
    material.density = 2500.0;
    material.stiffness = 2.5e4;
    se3d_particles_def def = se3d_particles_def_default();
    def.step = 1e-5;
    bed_open(b, SE3D_CONTACT_LAW_HOOKE, none, &def, &material);
    se3d_fill_def fill = se3d_fill_def_default();
    fill.material = b->material;
    fill.radius_min = 0.003;
    fill.radius_max = 0.005;
    fill.upper[0] = fill.upper[1] = fill.upper[2] = WIDTH;
    fill.seed = 3;
    fill.count = count;
    if (spacing > 0.0) {
        fill.radius_min = fill.radius_max;
        fill.spacing = spacing;
        CHECK(se3d_particles_fill_lattice(b->particles, &fill, NULL) == SE3D_OK);
    } else {
        CHECK(se3d_particles_fill_random(b->particles, &fill) == SE3D_OK);
    }
}

/* Speeds over four decades, up to 2 m/s. */
static void throw_about(const bed *b, size_t count)
{
    double *v = calloc(3 * count, sizeof *v);
    uint64_t seed = 11;
    for (size_t k = 0; v && k < 3 * count; ++k) {
        v[k] = 2.0 * pow(10.0, (double)(k / 3 % 5) - 4.0) * check_random(&seed);
    }
    CHECK(v && se3d_particles_set_all(b->particles, count, NULL, v, NULL) == SE3D_OK);
    free(v);
}

static se3d_body add_plate(const bed *b, double z, int mesh)
{
    static const double vertices[12] = {0.0,   0.0,   0.0, WIDTH, 0.0,   0.0,
                                        WIDTH, WIDTH, 0.0, 0.0,   WIDTH, 0.0};
    static const uint32_t triangles[6] = {0, 1, 2, 0, 2, 3};
    se3d_body_def def = se3d_body_def_default();
    se3d_body plate;
    def.mass = def.inertia[0] = def.inertia[1] = def.inertia[2] = 1.0;
    def.position[2] = z;
    CHECK(se3d_body_create(b->system, &def, &plate) == SE3D_OK);
    se3d_shape_def wall = se3d_shape_def_default();
    se3d_shape shape;
    wall.body = plate;
    wall.material = b->material;
    wall.normal[2] = 1.0;
    wall.vertices = vertices;
    wall.vertex_count = 4;
    wall.triangles = triangles;
    wall.triangle_count = 2;
    CHECK((mesh ? se3d_shape_create_mesh : se3d_shape_create_plane)(b->system, &wall, &shape) ==
          SE3D_OK);
    return plate;
}

static size_t count_pairs(const se3di_particles *set)
{
    size_t count = 0;
    for (size_t i = 0; i < set->count; ++i) {
        const se3di_particle *a = &set->particles[i];
        for (size_t j = i + 1; j < set->count; ++j) {
            const se3di_particle *b = &set->particles[j];
            const double d[3] = {a->x[0] - b->x[0], a->x[1] - b->x[1], a->x[2] - b->x[2]};
            const double reach = a->radius + b->radius;
            count += d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach * reach;
        }
    }
    return count;
}

/* Particles on planes, and places where they touch meshes. */
static size_t count_wall_contacts(const se3di_particles *set)
{
    size_t count = 0;
    for (size_t w = 0; w < set->wall_count; ++w) {
        const se3di_wall *wall = &set->walls[w];
        for (size_t k = 0; k < set->count; ++k) {
            const se3di_particle *g = &set->particles[k];
            if (wall->shape.kind == SE3DI_SHAPE_MESH) {
                se3di_touch touch[SE3DI_PARTICLE_FACES];
                double local[3];
                se3di_wall_local(wall, g->x, local);
                count += se3di_mesh_contacts(&wall->shape, local, g->radius, SE3DI_PARTICLE_FACES,
                                             touch);
            } else {
                count += se3di_wall_distance(wall, g->x) < g->radius;
            }
        }
    }
    return count;
}

static void what_touches_is_evaluated_when_few_are_fast(void)
{
    bed b;
    open_cloud(&b, 300, 0.0);
    throw_about(&b, 300);
    const se3d_body floor = add_plate(&b, -0.01, 0), lid = add_plate(&b, WIDTH + 0.01, 1);
    size_t touched = 0, on_walls = 0;
    for (int k = 0; k < 3000; ++k) {
        const double t = 1e-5 * k, shift = 0.012 * sin(60.0 * t);
        const double low[3] = {0.0, 0.0, -0.01 + shift}, high[3] = {0.0, 0.0, WIDTH + 0.01 - shift};
        const double p[4] = {cos(2.0 * t), sin(2.0 * t), 0.0, 0.0};
        CHECK(se3d_body_set_position(b.system, floor, low) == SE3D_OK);
        CHECK(se3d_body_set_position(b.system, lid, high) == SE3D_OK);
        CHECK(se3d_body_set_orientation(b.system, lid, p) == SE3D_OK);
        CHECK(se3d_particles_step(b.particles, 1) == SE3D_OK);
        const se3di_particles *set = &b.particles->set;
        const size_t walls = count_wall_contacts(set);
        const size_t expected = count_pairs(set) + walls;
        touched += expected;
        on_walls += walls;
        if (set->touching != expected) {
            CHECK(set->touching == expected);
            break;
        }
    }
    CHECK(touched > 1000 && on_walls > 300);
    bed_close(&b);
}

/* A plane that comes closer by less than the thousandth of a radius in all. */
static void a_slow_plane_leaves_lists_as_they_are(void)
{
    bed b;
    open_cloud(&b, 100, 0.0);
    const se3d_body floor = add_plate(&b, -0.01, 0);
    const se3di_particles *set = &b.particles->set;
    uint64_t last = 0;
    int made = 0;
    for (int k = 0; k < 200; ++k) {
        const double low[3] = {0.0, 0.0, -0.01 + 1e-8 * k};
        CHECK(se3d_body_set_position(b.system, floor, low) == SE3D_OK);
        CHECK(se3d_particles_step(b.particles, 1) == SE3D_OK);
        made += set->steps_near != last;
        last = set->steps_near;
    }
    CHECK(made < 20);
    bed_close(&b);
}

/* One particle flies past a lattice at rest, whose gaps are a fifth of the skin. */
static void one_fast_particle_leaves_the_blocks_of_others_alone(void)
{
    bed b;
    open_cloud(&b, 0, 0.0102);
    const double r[3] = {-0.05, 0.0, 0.0}, v[3] = {0.0, 0.0, 3.0};
    bed_add(&b, r, 0.005, v, none);
    CHECK(se3d_particles_step(b.particles, 200) == SE3D_OK);
    const se3di_particles *set = &b.particles->set;
    CHECK(set->count > 1000 && set->block_count == 0);
    CHECK(set->list_count > 2 * set->count); /* they are in each other's lists */
    bed_close(&b);
}

int main(void)
{
    RUN(a_slow_plane_leaves_lists_as_they_are);
    RUN(what_touches_is_evaluated_when_few_are_fast);
    RUN(one_fast_particle_leaves_the_blocks_of_others_alone);
    return check_finish();
}
