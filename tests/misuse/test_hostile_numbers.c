/* SPDX-License-Identifier: BSD-3-Clause */
/* Every number of every definition, made hostile: it is refused with its name, its value and what
 * is allowed, and nothing has changed; or it is taken, and a short run gives finite numbers or says
 * why not. */
#include <float.h>
#include <limits.h>

#include "misuse/hostile_world.h"

static const double doubles[] = {
    (double)NAN, (double)INFINITY, -(double)INFINITY, -1.0, 0.0, 1e308, -1e308, 5e-324, 1e-30,
    1e30};
static const int32_t integers[] = {-1, 0, 1, 3, 1000000, INT32_MAX, INT32_MIN};
static const size_t sizes[] = {0, 1, 1000, SIZE_MAX / 2, SIZE_MAX};

#define DOUBLES  (sizeof doubles / sizeof doubles[0])
#define INTEGERS (sizeof integers / sizeof integers[0])
#define SIZES    (sizeof sizes / sizeof sizes[0])

static char where[200]; /* what is tried */

static void expect(int holds, const char *what, const char *message)
{
    CHECK(holds);
    if (!holds) {
        fprintf(stderr, "  %s: %s: %s\n", where, what, message ? message : "");
    }
}

/* ------------------------------------------------------------------ what is defined */

#define FILL(type, name)                                                                           \
    static void set_##name(world *w, type *def);                                                   \
    static void fill_##name(world *w, void *storage)                                               \
    {                                                                                              \
        type *def = storage;                                                                       \
        *def = type##_default();                                                                   \
        set_##name(w, def);                                                                        \
    }                                                                                              \
    static void set_##name(world *w, type *def)

#define CREATE(type, function, handle)                                                             \
    static se3d_status create_##function(world *w, const void *def)                                \
    {                                                                                              \
        handle made;                                                                               \
        return se3d_##function(w->system, def, &made);                                             \
    }

FILL(se3d_body_def, body)
{
    (void)w;
    def->mass = 1.0;
    def->inertia[0] = def->inertia[1] = def->inertia[2] = 0.1;
}
CREATE(se3d_body_def, body_create, se3d_body)
static const field body_fields[] = {
    NUMBERS(se3d_body_def, mass),     NUMBERS(se3d_body_def, inertia),
    NUMBERS(se3d_body_def, position), NUMBERS(se3d_body_def, orientation),
    NUMBERS(se3d_body_def, velocity), NUMBERS(se3d_body_def, angular_velocity),
    INTEGER(se3d_body_def, fixed),    FIELDS_END};

FILL(se3d_marker_def, marker)
{
    def->body = w->ball;
}
CREATE(se3d_marker_def, marker_create, se3d_marker)
static const field marker_fields[] = {NUMBERS(se3d_marker_def, position),
                                      NUMBERS(se3d_marker_def, orientation), FIELDS_END};

FILL(se3d_joint_def, joint)
{
    def->body_i = w->ground;
    def->body_j = w->ball;
    def->point_i[2] = 0.0999;
    def->pitch = 0.1;
    def->distance = 0.5;
}
static void fill_at_distance(world *w, void *storage)
{
    fill_joint(w, storage);
    ((se3d_joint_def *)storage)->point_i[0] = -0.5;
}
static void fill_cross(world *w, void *storage)
{
    se3d_joint_def *def = storage;
    fill_joint(w, storage);
    def->axis_j[0] = 1.0;
    def->axis_j[2] = 0.0;
}
static const field joint_fields[] = {
    NUMBERS(se3d_joint_def, point_i),  NUMBERS(se3d_joint_def, point_j),
    NUMBERS(se3d_joint_def, axis_i),   NUMBERS(se3d_joint_def, axis_j),
    NUMBERS(se3d_joint_def, ref_i),    NUMBERS(se3d_joint_def, ref_j),
    NUMBERS(se3d_joint_def, angle0),   NUMBERS(se3d_joint_def, pitch),
    NUMBERS(se3d_joint_def, distance), FIELDS_END};
CREATE(se3d_joint_def, joint_create_fixed, se3d_constraint)
CREATE(se3d_joint_def, joint_create_revolute, se3d_constraint)
CREATE(se3d_joint_def, joint_create_prismatic, se3d_constraint)
CREATE(se3d_joint_def, joint_create_cylindrical, se3d_constraint)
CREATE(se3d_joint_def, joint_create_spherical, se3d_constraint)
CREATE(se3d_joint_def, joint_create_universal, se3d_constraint)
CREATE(se3d_joint_def, joint_create_planar, se3d_constraint)
CREATE(se3d_joint_def, joint_create_screw, se3d_constraint)
CREATE(se3d_joint_def, joint_create_point_on_line, se3d_constraint)
CREATE(se3d_joint_def, joint_create_point_on_plane, se3d_constraint)
CREATE(se3d_joint_def, joint_create_distance, se3d_constraint)
CREATE(se3d_joint_def, joint_create_revolute_spherical, se3d_constraint)
CREATE(se3d_joint_def, joint_create_revolute_cylindrical, se3d_constraint)
CREATE(se3d_joint_def, joint_create_parallel, se3d_constraint)
CREATE(se3d_joint_def, joint_create_perpendicular, se3d_constraint)
CREATE(se3d_joint_def, joint_create_orientation, se3d_constraint)
CREATE(se3d_joint_def, joint_create_perpendicular1, se3d_constraint)
CREATE(se3d_joint_def, joint_create_perpendicular2, se3d_constraint)

#define PRIMITIVE(what, TYPE)                                                                      \
    FILL(se3d_primitive_def, what)                                                                 \
    {                                                                                              \
        def->type = SE3D_PRIMITIVE_##TYPE;                                                         \
        def->body_i = w->ground;                                                                   \
        def->body_j = w->ball;                                                                     \
        def->a_i[0] = def->a_j[1] = def->c[0] = 1.0;                                               \
        def->point_i[0] = SE3D_PRIMITIVE_##TYPE == SE3D_PRIMITIVE_D ? -0.5 : 0.0;                  \
        def->point_i[2] = SE3D_PRIMITIVE_##TYPE == SE3D_PRIMITIVE_D ? 0.0999 : 0.0;                \
        def->value = SE3D_PRIMITIVE_##TYPE == SE3D_PRIMITIVE_D ? 0.5 : 0.0;                        \
    }
PRIMITIVE(dp1, DP1)
PRIMITIVE(dp2, DP2)
PRIMITIVE(d, D)
PRIMITIVE(cd, CD)
CREATE(se3d_primitive_def, primitive_create, se3d_constraint)
static const field primitive_fields[] = {
    INTEGER(se3d_primitive_def, type),    NUMBERS(se3d_primitive_def, a_i),
    NUMBERS(se3d_primitive_def, a_j),     NUMBERS(se3d_primitive_def, point_i),
    NUMBERS(se3d_primitive_def, point_j), NUMBERS(se3d_primitive_def, c),
    NUMBERS(se3d_primitive_def, value),   FIELDS_END};

FILL(se3d_coupler_def, coupler)
{
    def->joint[0] = w->pin;
    def->joint[1] = w->slide;
    def->coordinate[1] = SE3D_JOINT_COORDINATE_DISPLACEMENT;
    def->ratio[0] = 1.0;
    def->ratio[1] = 2.0;
    def->count = 2;
}
CREATE(se3d_coupler_def, joint_create_coupler, se3d_constraint)
static const field coupler_fields[] = {
    {"coordinate", offsetof(se3d_coupler_def, coordinate), sizeof(int32_t), 2, 'i'},
    {"ratio", offsetof(se3d_coupler_def, ratio), sizeof(double), 2, 'd'},
    SIZE(se3d_coupler_def, count),
    NUMBERS(se3d_coupler_def, value),
    FIELDS_END};

FILL(se3d_driver_def, driver)
{
    def->joint = w->pin;
}
CREATE(se3d_driver_def, driver_create, se3d_constraint)
static const field driver_fields[] = {INTEGER(se3d_driver_def, coordinate),
                                      NUMBERS(se3d_driver_def, value), FIELDS_END};

FILL(se3d_tsda_def, tsda)
{
    def->body_i = w->ground;
    def->body_j = w->ball;
    def->point_i[2] = 1.0;
    def->k = 100.0;
    def->c = 1.0;
    def->l0 = 0.5;
}
CREATE(se3d_tsda_def, force_create_tsda, se3d_force)
static const field tsda_fields[] = {NUMBERS(se3d_tsda_def, point_i),
                                    NUMBERS(se3d_tsda_def, point_j),
                                    NUMBERS(se3d_tsda_def, k),
                                    NUMBERS(se3d_tsda_def, c),
                                    NUMBERS(se3d_tsda_def, l0),
                                    NUMBERS(se3d_tsda_def, preload),
                                    FIELDS_END};

FILL(se3d_rsda_def, rsda)
{
    def->joint = w->pin;
    def->k = 10.0;
    def->c = 0.1;
}
FILL(se3d_rsda_def, rsda_between)
{
    def->body_i = w->ground;
    def->body_j = w->ball;
    def->axis_i[2] = 1.0;
    def->k = 10.0;
}
CREATE(se3d_rsda_def, force_create_rsda, se3d_force)
static const field rsda_fields[] = {
    NUMBERS(se3d_rsda_def, k),       NUMBERS(se3d_rsda_def, c),      NUMBERS(se3d_rsda_def, theta0),
    NUMBERS(se3d_rsda_def, preload), NUMBERS(se3d_rsda_def, axis_i), NUMBERS(se3d_rsda_def, ref_i),
    NUMBERS(se3d_rsda_def, ref_j),   NUMBERS(se3d_rsda_def, angle0), FIELDS_END};

FILL(se3d_load_def, load)
{
    def->body = w->ball;
    def->value[0] = 1.0;
}
CREATE(se3d_load_def, force_create_load, se3d_force)
CREATE(se3d_load_def, force_create_torque, se3d_force)
static const field load_fields[] = {NUMBERS(se3d_load_def, point), NUMBERS(se3d_load_def, value),
                                    INTEGER(se3d_load_def, in_body_frame), FIELDS_END};

FILL(se3d_bushing_def, bushing)
{
    def->body_i = w->ground;
    def->body_j = w->ball;
    for (int k = 0; k < 6; ++k) {
        def->K[7 * k] = 100.0;
        def->C[7 * k] = 1.0;
    }
}
CREATE(se3d_bushing_def, force_create_bushing, se3d_force)
static const field bushing_fields[] = {NUMBERS(se3d_bushing_def, point_i),
                                       NUMBERS(se3d_bushing_def, point_j),
                                       NUMBERS(se3d_bushing_def, orientation_i),
                                       NUMBERS(se3d_bushing_def, orientation_j),
                                       NUMBERS(se3d_bushing_def, K),
                                       NUMBERS(se3d_bushing_def, C),
                                       FIELDS_END};

FILL(se3d_friction_def, friction)
{
    def->joint = w->pin;
    def->mu = 0.3;
    def->mu_static = 0.4;
    def->radius = 0.01;
    def->limit = 0.1;
}
CREATE(se3d_friction_def, force_create_friction, se3d_force)
static const field friction_fields[] = {INTEGER(se3d_friction_def, coordinate),
                                        NUMBERS(se3d_friction_def, mu),
                                        NUMBERS(se3d_friction_def, mu_static),
                                        NUMBERS(se3d_friction_def, radius),
                                        NUMBERS(se3d_friction_def, limit),
                                        NUMBERS(se3d_friction_def, viscous),
                                        NUMBERS(se3d_friction_def, presliding),
                                        NUMBERS(se3d_friction_def, length),
                                        NUMBERS(se3d_friction_def, width),
                                        NUMBERS(se3d_friction_def, thrust_radius),
                                        FIELDS_END};

FILL(se3d_stop_def, stop)
{
    def->joint = w->pin;
    def->upper = 1.0;
    def->k = 1000.0;
}
FILL(se3d_stop_def, stop_between)
{
    def->body_i = w->ground;
    def->body_j = w->ball;
    def->point_i[2] = 1.0;
    def->upper = 1.0;
    def->k = 1000.0;
}
CREATE(se3d_stop_def, force_create_stop, se3d_force)
static const field stop_fields[] = {
    INTEGER(se3d_stop_def, coordinate),  NUMBERS(se3d_stop_def, point_i),
    NUMBERS(se3d_stop_def, point_j),     NUMBERS(se3d_stop_def, lower),
    NUMBERS(se3d_stop_def, upper),       NUMBERS(se3d_stop_def, k),
    NUMBERS(se3d_stop_def, restitution), FIELDS_END};

FILL(se3d_effort_def, effort)
{
    def->joint = w->pin;
    def->value = 1.0;
}
CREATE(se3d_effort_def, force_create_effort, se3d_force)
static const field effort_fields[] = {INTEGER(se3d_effort_def, coordinate),
                                      NUMBERS(se3d_effort_def, value), FIELDS_END};

FILL(se3d_material_def, material)
{
    (void)w;
    def->density = 1000.0;
    def->stiffness = 1e5;
    def->young = 1e7;
}
/* A second ball of it, which touches the first. */
static se3d_status create_material(world *w, const void *def)
{
    se3d_shape_def shape = se3d_shape_def_default();
    se3d_shape made;
    const se3d_status status = se3d_material_create(w->system, def, &shape.material);
    shape.body = w->hinged;
    shape.position[0] = -1.0;
    shape.position[2] = -1.701;
    shape.radius = 0.1;
    return status < 0 ? status : se3d_shape_create_sphere(w->system, &shape, &made);
}
static const field material_fields[] = {NUMBERS(se3d_material_def, density),
                                        NUMBERS(se3d_material_def, friction),
                                        NUMBERS(se3d_material_def, restitution),
                                        NUMBERS(se3d_material_def, rolling_friction),
                                        NUMBERS(se3d_material_def, torsional_friction),
                                        NUMBERS(se3d_material_def, stiffness),
                                        NUMBERS(se3d_material_def, tangential_ratio),
                                        NUMBERS(se3d_material_def, young),
                                        NUMBERS(se3d_material_def, poisson),
                                        NUMBERS(se3d_material_def, cohesion),
                                        NUMBERS(se3d_material_def, adhesion),
                                        FIELDS_END};

FILL(se3d_material_pair_def, pair)
{
    (void)w;
    def->friction = 0.3;
}
static se3d_status create_pair(world *w, const void *def)
{
    return se3d_material_set_pair(w->system, w->material, w->material, def);
}
static const field pair_fields[] = {NUMBERS(se3d_material_pair_def, friction),
                                    NUMBERS(se3d_material_pair_def, restitution),
                                    NUMBERS(se3d_material_pair_def, rolling_friction),
                                    NUMBERS(se3d_material_pair_def, torsional_friction),
                                    NUMBERS(se3d_material_pair_def, stiffness),
                                    NUMBERS(se3d_material_pair_def, cohesion),
                                    NUMBERS(se3d_material_pair_def, adhesion),
                                    FIELDS_END};

FILL(se3d_contact_settings, settings)
{
    (void)w;
    (void)def;
}
static se3d_status create_settings(world *w, const void *def)
{
    return se3d_system_set_contact(w->system, def);
}
static const field settings_fields[] = {INTEGER(se3d_contact_settings, law),
                                        NUMBERS(se3d_contact_settings, step),
                                        NUMBERS(se3d_contact_settings, overlap_limit), FIELDS_END};

static const double corners[12] = {0, 0, 0, 0.1, 0, 0, 0, 0.1, 0, 0, 0, 0.1};
static const uint32_t faces[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

FILL(se3d_shape_def, shape)
{
    def->body = w->ball;
    def->material = w->material;
    def->position[2] = 0.05;
    def->size[0] = def->size[1] = def->size[2] = 0.1;
    def->radius = 0.05;
    def->length = 0.1;
    def->vertices = corners;
    def->triangles = faces;
    def->vertex_count = def->triangle_count = 4;
}
static const field shape_fields[] = {NUMBERS(se3d_shape_def, position),
                                     NUMBERS(se3d_shape_def, orientation),
                                     NUMBERS(se3d_shape_def, normal),
                                     NUMBERS(se3d_shape_def, size),
                                     NUMBERS(se3d_shape_def, radius),
                                     NUMBERS(se3d_shape_def, length),
                                     FIELDS_END};
CREATE(se3d_shape_def, shape_create_sphere, se3d_shape)
CREATE(se3d_shape_def, shape_create_box, se3d_shape)
CREATE(se3d_shape_def, shape_create_capsule, se3d_shape)
CREATE(se3d_shape_def, shape_create_cylinder, se3d_shape)
CREATE(se3d_shape_def, shape_create_plane, se3d_shape)
CREATE(se3d_shape_def, shape_create_hull, se3d_shape)
CREATE(se3d_shape_def, shape_create_mesh, se3d_shape)

FILL(se3d_particles_def, particles)
{
    (void)w;
    def->boundary[0] = SE3D_DOMAIN_BOUNDARY_OPEN;
    for (int k = 0; k < 3; ++k) {
        def->lower[k] = -5.0;
        def->upper[k] = 5.0;
    }
}
static se3d_status create_particles(world *w, const void *def)
{
    se3d_particles *set = NULL;
    const se3d_status status = se3d_particles_create(w->system, def, &set);
    w->set = set ? set : w->set;
    return status;
}
static const field particles_fields[] = {
    INTEGER(se3d_particles_def, threads),  INTEGER(se3d_particles_def, portable),
    INTEGER(se3d_particles_def, boundary), NUMBERS(se3d_particles_def, lower),
    NUMBERS(se3d_particles_def, upper),    NUMBERS(se3d_particles_def, step),
    NUMBERS(se3d_particles_def, skin),     FIELDS_END};

FILL(se3d_fill_def, region)
{
    def->material = w->material;
    def->count = 4;
    def->lower[0] = 4.0;
    def->lower[2] = 0.5;
    def->upper[0] = 5.0;
    def->upper[1] = 1.0;
    def->upper[2] = 1.5;
    def->radius_min = def->radius_max = 0.1;
}
static se3d_status create_lattice(world *w, const void *def)
{
    size_t added;
    return se3d_particles_fill_lattice(w->set, def, &added);
}
static se3d_status create_random(world *w, const void *def)
{
    return se3d_particles_fill_random(w->set, def);
}
static const field region_fields[] = {
    NUMBERS(se3d_fill_def, lower),      NUMBERS(se3d_fill_def, upper),
    NUMBERS(se3d_fill_def, radius_min), NUMBERS(se3d_fill_def, radius_max),
    NUMBERS(se3d_fill_def, spacing),    NUMBERS(se3d_fill_def, jitter),
    NUMBERS(se3d_fill_def, velocity),   INTEGER(se3d_fill_def, region),
    INTEGER(se3d_fill_def, axis),       FIELDS_END};

FILL(se3d_particles_source_def, source)
{
    fill_region(w, &w->fill);
    def->fill = &w->fill;
    def->rate = 10.0;
}
static se3d_status create_source(world *w, const void *def)
{
    uint32_t source;
    return se3d_particles_add_source(w->set, def, &source);
}
static const field source_fields[] = {
    NUMBERS(se3d_particles_source_def, rate),     NUMBERS(se3d_particles_source_def, start),
    NUMBERS(se3d_particles_source_def, stop),     NUMBERS(se3d_particles_source_def, every),
    INTEGER(se3d_particles_source_def, per_mass), FIELDS_END};

FILL(se3d_particles_sink_def, sink)
{
    (void)w;
    def->upper[0] = def->upper[1] = def->upper[2] = 1.0;
}
static se3d_status create_sink(world *w, const void *def)
{
    uint32_t sink;
    return se3d_particles_add_sink(w->set, def, &sink);
}
static const field sink_fields[] = {NUMBERS(se3d_particles_sink_def, lower),
                                    NUMBERS(se3d_particles_sink_def, upper),
                                    INTEGER(se3d_particles_sink_def, region),
                                    INTEGER(se3d_particles_sink_def, axis),
                                    NUMBERS(se3d_particles_sink_def, point),
                                    NUMBERS(se3d_particles_sink_def, normal),
                                    FIELDS_END};

static se3d_status get_height(void *ctx, const se3d_system *system, double *value)
{
    double r[3];
    const se3d_status status = se3d_body_get_position(system, ((world *)ctx)->ball, r);
    *value = r[2];
    return status;
}

FILL(se3d_event_def, event)
{
    def->value = get_height;
    def->ctx = w;
}
static se3d_status create_event(world *w, const void *def)
{
    se3d_event event;
    return se3d_event_create(w->solver, def, &event);
}
static const field event_fields[] = {
    NUMBERS(se3d_event_def, level),      INTEGER(se3d_event_def, direction),
    INTEGER(se3d_event_def, action),     INTEGER(se3d_event_def, motion_only),
    NUMBERS(se3d_event_def, hysteresis), FIELDS_END};

FILL(se3d_function_def, function)
{
    (void)w;
    (void)def;
}
CREATE(se3d_function_def, function_create, se3d_function)
static const field function_fields[] = {NUMBERS(se3d_function_def, constant), FIELDS_END};

#define JOINT(type)                                                                                \
    {                                                                                              \
#type, joint_fields, fill_joint, create_joint_create_##type, 0                             \
    }
#define JOINT_WITH(type, fill)                                                                     \
    {                                                                                              \
#type, joint_fields, fill, create_joint_create_##type, 0                                   \
    }
#define SHAPE(type)                                                                                \
    {                                                                                              \
#type, shape_fields, fill_shape, create_shape_create_##type, 0                             \
    }

static const subject subjects[] = {
    {"body", body_fields, fill_body, create_body_create, 0},
    {"marker", marker_fields, fill_marker, create_marker_create, 0},
    JOINT(fixed),
    JOINT(revolute),
    JOINT(prismatic),
    JOINT(cylindrical),
    JOINT(spherical),
    JOINT_WITH(universal, fill_cross),
    JOINT(planar),
    JOINT(screw),
    JOINT(point_on_line),
    JOINT(point_on_plane),
    JOINT_WITH(distance, fill_at_distance),
    JOINT_WITH(revolute_spherical, fill_at_distance),
    JOINT_WITH(revolute_cylindrical, fill_at_distance),
    JOINT(parallel),
    JOINT_WITH(perpendicular, fill_cross),
    JOINT(orientation),
    JOINT(perpendicular1),
    JOINT_WITH(perpendicular2, fill_cross),
    {"dp1", primitive_fields, fill_dp1, create_primitive_create, 0},
    {"dp2", primitive_fields, fill_dp2, create_primitive_create, 0},
    {"d", primitive_fields, fill_d, create_primitive_create, 0},
    {"cd", primitive_fields, fill_cd, create_primitive_create, 0},
    {"coupler", coupler_fields, fill_coupler, create_joint_create_coupler, 0},
    {"driver", driver_fields, fill_driver, create_driver_create, 0},
    {"tsda", tsda_fields, fill_tsda, create_force_create_tsda, 0},
    {"rsda", rsda_fields, fill_rsda, create_force_create_rsda, 0},
    {"rsda between bodies", rsda_fields, fill_rsda_between, create_force_create_rsda, 0},
    {"load", load_fields, fill_load, create_force_create_load, 0},
    {"torque", load_fields, fill_load, create_force_create_torque, 0},
    {"bushing", bushing_fields, fill_bushing, create_force_create_bushing, 0},
    {"friction", friction_fields, fill_friction, create_force_create_friction, 0},
    {"stop", stop_fields, fill_stop, create_force_create_stop, 0},
    {"effort", effort_fields, fill_effort, create_force_create_effort, 0},
    {"stop between points", stop_fields, fill_stop_between, create_force_create_stop, 0},
    {"material", material_fields, fill_material, create_material, 0},
    {"material pair", pair_fields, fill_pair, create_pair, 0},
    {"contact settings", settings_fields, fill_settings, create_settings, 0},
    SHAPE(sphere),
    SHAPE(box),
    SHAPE(capsule),
    SHAPE(cylinder),
    SHAPE(plane),
    SHAPE(hull),
    SHAPE(mesh),
    {"particles", particles_fields, fill_particles, create_particles, 0},
    {"lattice", region_fields, fill_region, create_lattice, 1},
    {"random filling", region_fields, fill_region, create_random, 1},
    {"source", source_fields, fill_source, create_source, 1},
    {"sink", sink_fields, fill_sink, create_sink, 1},
    {"event", event_fields, fill_event, create_event, 0},
    {"function", function_fields, fill_function, create_function_create, 0},
};
#define SUBJECTS (sizeof subjects / sizeof subjects[0])

/* ------------------------------------------------------------------ trying them */

/* A run after it: finite numbers, or a failure with a message. */
static void run_on(world *w)
{
    double r[3 * 16], p[4 * 16], v[3 * 16], omega[3 * 16];
    const size_t count = se3d_system_count_bodies(w->system);
    const se3d_status status = se3d_solver_run(w->solver, 1e-3);
    if (status < 0) {
        expect(se3d_system_get_error(w->system)[0] != '\0', "fails without a message", NULL);
    }
    CHECK(se3d_body_get_all(w->system, count, r, p, v, omega) == SE3D_OK);
    int finite = 1;
    for (size_t k = 0; k < 3 * count; ++k) {
        finite = finite && isfinite(r[k]) && isfinite(v[k]) && isfinite(omega[k]) && isfinite(p[k]);
    }
    expect(finite, "positions or velocities are not finite", se3d_system_get_error(w->system));
}

/* If a field limits another, as `lower` does `upper`, that one may be named. */
static int names_a_field(const subject *s, const char *message)
{
    int named = 0;
    for (const field *f = s->fields; f->name; ++f) {
        named = named || strstr(message, f->name);
    }
    return named;
}

static void check_refusal(const world *w, const subject *s, const char *value, uint64_t hash)
{
    const char *message = se3d_system_get_error(w->system);
    expect(names_a_field(s, message), "the field is not named", message);
    expect(strstr(message, value) || strstr(message, "principal"), /* those of a matrix */
           "the value is not shown", message);
    expect(strstr(message, "must") || strstr(message, "at most") || strstr(message, "needs"),
           "what is allowed is not said", message);
    expect(se3d_system_hash(w->system) == hash, "the system has changed", message);
}

/* Element `n` of a field, made hostile by value `k` of its kind. @return 0: there is none */
static int spoil(char *def, const field *f, size_t n, size_t k, char text[40])
{
    char *at = def + f->offset + n * f->size;
    if (f->kind == 'd' && k < DOUBLES) {
        memcpy(at, &doubles[k], sizeof doubles[k]);
        snprintf(text, 40, "%g", doubles[k]);
        return 1;
    }
    if (f->kind == 'i' && k < INTEGERS) {
        memcpy(at, &integers[k], sizeof integers[k]);
        snprintf(text, 40, "%d", (int)integers[k]);
        return 1;
    }
    if (f->kind == 'z' && k < SIZES) {
        memcpy(at, &sizes[k], sizeof sizes[k]);
        snprintf(text, 40, "%zu", sizes[k]);
        return 1;
    }
    return 0;
}

/* @return 0: there are no more values */
static int try_value(const subject *s, const field *f, size_t n, size_t k)
{
    world w;
    def_storage def;
    char text[40];
    memset(&def, 0, sizeof def);
    world_open(&w, s->with_particles);
    s->fill(&w, &def);
    const int there = spoil((char *)&def, f, n, k, text);
    if (there) {
        const uint64_t hash = se3d_system_hash(w.system);
        snprintf(where, sizeof where, "%s.%s[%zu] = %s", s->name, f->name, n, text);
        const se3d_status status = s->create(&w, &def);
        if (status < 0) {
            check_refusal(&w, s, text, hash);
        }
        run_on(&w);
    }
    world_close(&w);
    return there;
}

static void good_definitions_are_taken_and_run(void)
{
    for (size_t k = 0; k < SUBJECTS; ++k) {
        world w;
        def_storage def;
        memset(&def, 0, sizeof def);
        world_open(&w, subjects[k].with_particles);
        subjects[k].fill(&w, &def);
        snprintf(where, sizeof where, "%s", subjects[k].name);
        expect(subjects[k].create(&w, &def) >= 0, "refused", se3d_system_get_error(w.system));
        expect(se3d_solver_run(w.solver, 1e-3) >= 0, "fails", se3d_system_get_error(w.system));
        world_close(&w);
    }
}

static void hostile_numbers_are_refused_by_name_or_harmless(void)
{
    for (size_t k = 0; k < SUBJECTS; ++k) {
        for (const field *f = subjects[k].fields; f->name; ++f) {
            for (size_t n = 0; n < f->count; ++n) {
                for (size_t value = 0; try_value(&subjects[k], f, n, value); ++value) {
                }
            }
        }
    }
}

int main(void)
{
    RUN(good_definitions_are_taken_and_run);
    RUN(hostile_numbers_are_refused_by_name_or_harmless);
    return check_finish();
}
