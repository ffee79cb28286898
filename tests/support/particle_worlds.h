/* SPDX-License-Identifier: BSD-3-Clause */
/* Small worlds of particles that together have all that a set can hold: springs of pairs, walls and
 * meshes, rolling, cohesion, periods, sources, sinks, tags, walls that move and that give way, a
 * cell that strains, bonds that break, nothing until a source begins. */
#ifndef SE3D_TESTS_SUPPORT_PARTICLE_WORLDS_H
#define SE3D_TESTS_SUPPORT_PARTICLE_WORLDS_H

#include "check.h"
#include "se3d/se3d.h"

enum {
    PARTICLES_HEAP,
    PARTICLES_MESH,
    PARTICLES_PERIOD,
    PARTICLES_BODY,
    PARTICLES_TWO_SETS,
    PARTICLES_CLUMPS,
    PARTICLES_FUNNEL,
    PARTICLES_CELL,
    PARTICLES_BONDS,
    PARTICLES_LATE,
    PARTICLES_WORLDS
};

static const char *const particle_world_names[PARTICLES_WORLDS] = {
    "heap", "mesh", "period", "body", "two sets", "clumps", "funnel", "cell", "bonds", "late"};

static inline se3d_material particle_material(se3d_system *system, double rolling, double cohesion)
{
    se3d_material_def def = se3d_material_def_default();
    se3d_material material;
    def.density = 2500.0;
    def.stiffness = 2e4;
    def.young = 5e6;
    def.rolling_friction = rolling;
    def.torsional_friction = rolling;
    def.cohesion = cohesion;
    CHECK(!se3d_material_create(system, &def, &material));
    return material;
}

static inline void particle_plane(se3d_system *system, se3d_material material)
{
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape shape;
    def.material = material;
    def.name = "floor";
    CHECK(!se3d_shape_create_plane(system, &def, &shape));
}

/* A gutter along y. */
static inline void particle_mesh(se3d_system *system, se3d_material material)
{
    static const double vertices[] = {-0.2, -0.2, 0.1, -0.2, 0.2,  0.1, 0.0, -0.2, 0.0,
                                      0.0,  0.2,  0.0, 0.2,  -0.2, 0.1, 0.2, 0.2,  0.1};
    static const uint32_t triangles[] = {0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5};
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape shape;
    def.material = material;
    def.vertices = vertices;
    def.vertex_count = 6;
    def.triangles = triangles;
    def.triangle_count = 4;
    CHECK(!se3d_shape_create_mesh(system, &def, &shape));
}

/* Its mouth lets few through at a time, one after the other stays in it; the lower end is above a
 * plane. */
static inline void particle_funnel(se3d_system *system, se3d_material material)
{
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape shape;
    def.material = material;
    def.bottom_radius = 0.012;
    def.top_radius = 0.14;
    def.length = 0.13;
    def.position[2] = 0.11;
    CHECK(!se3d_shape_create_funnel(system, &def, &shape));
}

static inline se3d_particles *particle_set(se3d_system *system, int32_t threads, int kind)
{
    se3d_particles_def def = se3d_particles_def_default();
    se3d_particles *set = NULL;
    def.threads = threads;
    def.audit = kind == PARTICLES_HEAP || kind == PARTICLES_MESH || kind == PARTICLES_CLUMPS;
    for (int a = 0; a < 3 && kind == PARTICLES_PERIOD; ++a) {
        def.boundary[a] = a < 2 ? SE3D_DOMAIN_BOUNDARY_PERIODIC : SE3D_DOMAIN_BOUNDARY_OPEN;
        def.lower[a] = -0.1;
        def.upper[a] = a < 2 ? 0.1 : 2.0;
    }
    CHECK(!se3d_particles_create(system, &def, &set));
    return set;
}

static inline se3d_fill_def particle_fill(se3d_material material, double low, double high)
{
    se3d_fill_def fill = se3d_fill_def_default();
    fill.material = material;
    fill.lower[0] = fill.lower[1] = -0.08;
    fill.upper[0] = fill.upper[1] = 0.08;
    fill.lower[2] = low;
    fill.upper[2] = high;
    fill.radius_min = 0.008;
    fill.radius_max = 0.014;
    fill.jitter = 0.001;
    fill.velocity[0] = 0.3;
    fill.velocity[2] = -0.5;
    return fill;
}

static inline void particle_passage(se3d_particles *set, double height)
{
    se3d_flow_def def = se3d_flow_def_default();
    def.point[2] = height;
    def.normal[2] = 1.0;
    def.normal[0] = 0.3;
    def.window = 0.007;
    CHECK(!se3d_particles_add_flow(set, &def, NULL));
    def.radius = 0.05;
    def.tag = 0;
    CHECK(!se3d_particles_add_flow(set, &def, NULL));
}

static inline void particle_flow(se3d_particles *set, se3d_material material, double start)
{
    static const double radii[3] = {0.006, 0.009, 0.011};
    se3d_fill_def fill = particle_fill(material, 0.3, 0.36);
    se3d_particles_source_def source = se3d_particles_source_def_default();
    se3d_particles_sink_def sink = se3d_particles_sink_def_default();
    fill.radii = radii;
    fill.radius_count = 3;
    fill.tag = 7;
    fill.seed = 3;
    source.fill = &fill;
    source.rate = 2000.0;
    source.start = start;
    CHECK(!se3d_particles_add_source(set, &source, NULL));
    sink.normal[2] = 1.0;
    sink.point[2] = 0.01;
    CHECK(!se3d_particles_add_sink(set, &sink, NULL));
}

/* Lumps of three spheres that overlap, of several sizes, between the free spheres and from a
 * source; some leave. */
static inline void particle_clumps(se3d_particles *set, se3d_material material)
{
    static const double r[9] = {0.0, 0.0, 0.0, 0.009, 0.0, 0.0, 0.0, 0.007, 0.004},
                        radii[3] = {0.008, 0.006, 0.005};
    se3d_clump_def def = se3d_clump_def_default();
    se3d_fill_def fill = particle_fill(material, 0.12, 0.3);
    se3d_particles_source_def source = se3d_particles_source_def_default();
    se3d_particles_sink_def sink = se3d_particles_sink_def_default();
    uint32_t index;
    def.count = 3;
    def.r = r;
    def.radius = radii;
    CHECK(!se3d_particles_add_clump_template(set, &def, &index));
    fill.clump = index + 1;
    fill.radius_min = 0.012;
    fill.radius_max = 0.017;
    fill.count = 60;
    fill.tag = 4;
    CHECK(!se3d_particles_fill_random(set, &fill));
    fill.lower[2] = 0.32;
    fill.upper[2] = 0.4;
    fill.count = 0;
    fill.tag = 5;
    source.fill = &fill;
    source.rate = 500.0;
    CHECK(!se3d_particles_add_source(set, &source, NULL));
    sink.normal[0] = -1.0;
    sink.point[0] = 0.083;
    CHECK(!se3d_particles_add_sink(set, &sink, NULL));
}

/* Lumps that hold together and to the floor, until they hit it. */
static inline void particle_bonds(se3d_system *system, se3d_particles *set)
{
    se3d_bond_def def = se3d_bond_def_default();
    se3d_shape floor;
    size_t count = 0;
    def.young = 1e5;
    def.poisson = 0.2;
    def.gap = 0.012;
    def.damping = 0.05;
    def.tensile_strength = 300.0;
    def.shear_strength = 200.0;
    CHECK(!se3d_particles_bond_near(set, &def, 0, 0, &count, NULL) && count > 20);
    def.law = SE3D_BOND_LAW_PARALLEL;
    def.normal_stiffness = def.shear_stiffness = 1e7;
    def.gap = 0.01;
    def.contact = 1;
    CHECK(!se3d_shape_find(system, "floor", &floor));
    CHECK(!se3d_particles_bond_shape(set, &def, floor, -1, &count, NULL) && count > 0);
}

/* A lid that presses what is below. */
static inline void particle_lid(se3d_system *system, se3d_particles *set, se3d_material material)
{
    se3d_shape_def lid = se3d_shape_def_default();
    se3d_servo_def def = se3d_servo_def_default();
    lid.material = material;
    lid.normal[2] = -1.0;
    lid.position[2] = 0.125;
    CHECK(!se3d_shape_create_plane(system, &lid, &def.shape));
    def.axis[2] = -1.0;
    def.load = 5.0;
    def.speed_max = 0.5;
    CHECK(!se3d_particles_add_servo(set, &def, NULL));
}

static inline se3d_body particle_box(se3d_system *system, se3d_material material, double x)
{
    se3d_body_def body = se3d_body_def_default();
    se3d_shape_def shape = se3d_shape_def_default();
    se3d_shape made;
    body.mass = 0.5;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 1e-3;
    body.position[0] = x;
    body.position[2] = 0.16;
    CHECK(!se3d_body_create(system, &body, &shape.body));
    shape.material = material;
    shape.size[0] = shape.size[1] = shape.size[2] = 0.06;
    CHECK(!se3d_shape_create_box(system, &shape, &made));
    return shape.body;
}

/* A box that falls onto the particles, and a ram that moves as it is told. */
static inline void particle_bodies(se3d_system *system, se3d_material material)
{
    static const char *const variables[] = {"t"};
    se3d_joint_def joint = se3d_joint_def_default();
    se3d_function_def f = se3d_function_def_default();
    se3d_driver_def driver = se3d_driver_def_default();
    (void)particle_box(system, material, 0.0);
    joint.body_j = particle_box(system, material, -0.15);
    CHECK(!se3d_system_get_ground(system, &joint.body_i));
    joint.point_i[2] = 0.16;
    joint.point_i[0] = -0.15;
    joint.axis_i[0] = joint.axis_j[0] = 1.0;
    joint.axis_i[2] = joint.axis_j[2] = 0.0;
    CHECK(!se3d_joint_create_prismatic(system, &joint, &driver.joint));
    f.expression = "0.5*t";
    f.variables = variables;
    f.variable_count = 1;
    driver.coordinate = SE3D_JOINT_COORDINATE_DISPLACEMENT;
    CHECK(!se3d_function_create(system, &f, &driver.function));
    se3d_constraint made;
    CHECK(!se3d_driver_create(system, &driver, &made));
}

/* Spheres in a cell that is sheared and squeezed, and then keeps a pressure. */
static inline se3d_system *particle_cell(int32_t threads)
{
    se3d_system *system = NULL;
    se3d_particles *set = NULL;
    se3d_particles_def def = se3d_particles_def_default();
    se3d_cell_def stage = se3d_cell_def_default();
    CHECK(!se3d_system_create(NULL, &system));
    def.threads = threads;
    for (int a = 0; a < 3; ++a) {
        def.boundary[a] = SE3D_DOMAIN_BOUNDARY_PERIODIC;
        def.lower[a] = -0.1;
        def.upper[a] = 0.1;
        stage.rate[a] = -7.0;
    }
    CHECK(!se3d_particles_create(system, &def, &set));
    const se3d_fill_def fill = particle_fill(particle_material(system, 0.1, 0.0), -0.09, 0.09);
    CHECK(!se3d_particles_fill_lattice(set, &fill, NULL));
    stage.shear_rate = 20.0;
    CHECK(!se3d_particles_add_cell_stage(set, &stage, NULL));
    stage.start = 0.05;
    for (int a = 0; a < 3; ++a) {
        stage.rate[a] = 0.0;
        stage.servo[a] = a != 1;
        stage.stress[a] = 500.0;
        stage.rate_max[a] = 10.0;
    }
    CHECK(!se3d_particles_add_cell_stage(set, &stage, NULL));
    return system;
}

/* Gravity that may have no value as far as anybody knows: each step can be taken back. */
static inline void particle_tide(se3d_system *system)
{
    se3d_function_def f = se3d_function_def_default();
    se3d_function gravity[3] = {{0, 0}, {0, 0}, {0, 0}};
    f.expression = "-9.81*sqrt(1 - t)";
    CHECK(!se3d_function_create(system, &f, &gravity[2]));
    CHECK(!se3d_system_set_gravity_function(system, gravity));
}

/* What a kind has beside a bed of spheres. */
static inline void particle_more(se3d_system *system, se3d_particles *set, int kind,
                                 se3d_material stone, se3d_material floor)
{
    if (kind == PARTICLES_LATE) {
        particle_flow(set, stone, 0.03);
        particle_tide(system);
    }
    if (kind == PARTICLES_MESH) {
        particle_flow(set, stone, 0.0);
        particle_passage(set, 0.12);
    }
    if (kind == PARTICLES_CLUMPS) {
        particle_clumps(set, stone);
        particle_passage(set, 0.1);
    }
    if (kind == PARTICLES_HEAP) {
        particle_lid(system, set, floor);
    }
    if (kind == PARTICLES_BONDS) {
        particle_bonds(system, set);
    }
    if (kind == PARTICLES_BODY) {
        particle_bodies(system, floor);
    }
}

/* The same model each time, but for the threads. */
static inline se3d_system *particle_world(int kind, int32_t threads)
{
    se3d_system *system = NULL;
    se3d_contact_settings law = se3d_contact_settings_default();
    if (kind == PARTICLES_CELL) {
        return particle_cell(threads);
    }
    CHECK(!se3d_system_create(NULL, &system));
    law.law = kind == PARTICLES_HEAP ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE;
    CHECK(!se3d_system_set_contact(system, &law));
    const se3d_material floor = particle_material(system, 0.0, 0.0);
    const int rolls = kind == PARTICLES_HEAP || kind == PARTICLES_MESH || kind == PARTICLES_FUNNEL;
    const se3d_material stone =
        particle_material(system, rolls ? 0.1 : 0.0, kind == PARTICLES_PERIOD ? 1e3 : 0.0);
    if (kind == PARTICLES_FUNNEL) {
        particle_funnel(system, floor);
    }
    if (kind == PARTICLES_MESH) {
        particle_mesh(system, floor);
    } else {
        particle_plane(system, floor);
    }
    se3d_particles *set = particle_set(system, threads, kind);
    const double low = kind == PARTICLES_MESH ? 0.11 : kind == PARTICLES_FUNNEL ? 0.2 : 0.0;
    const double high = kind == PARTICLES_MESH ? 0.18 : kind == PARTICLES_FUNNEL ? 0.28 : 0.1;
    se3d_fill_def fill = particle_fill(stone, low, high);
    CHECK(kind == PARTICLES_LATE || !se3d_particles_fill_lattice(set, &fill, NULL));
    particle_more(system, set, kind, stone, floor);
    if (kind == PARTICLES_TWO_SETS) {
        set = particle_set(system, threads, kind);
        fill.material = floor;
        CHECK(!se3d_particles_fill_lattice(set, &fill, NULL));
    }
    return system;
}

#endif
