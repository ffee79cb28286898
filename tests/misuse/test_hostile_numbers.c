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

#define FILL_IN(type, name)                                                                        \
    static void set_##name(world *w, type *def);                                                   \
    static void fill_in_##name(world *w, void *storage)                                            \
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

FILL_IN(se3d_body_def, body)
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

FILL_IN(se3d_marker_def, marker)
{
    def->body = w->ball;
}
CREATE(se3d_marker_def, marker_create, se3d_marker)
static const field marker_fields[] = {NUMBERS(se3d_marker_def, position),
                                      NUMBERS(se3d_marker_def, orientation), FIELDS_END};

FILL_IN(se3d_state_def, state)
{
    (void)w;
    def->initial = 1.0;
}
CREATE(se3d_state_def, state_create, se3d_state)
static const field state_fields[] = {NUMBERS(se3d_state_def, initial),
                                     NUMBERS(se3d_state_def, size), FIELDS_END};

FILL_IN(se3d_wheel_def, wheel)
{
    def->body = w->ball;
    def->chassis = w->ground;
    def->radius = 0.3;
}
CREATE(se3d_wheel_def, wheel_create, se3d_wheel)
static const field wheel_fields[] = {
    NUMBERS(se3d_wheel_def, center),    NUMBERS(se3d_wheel_def, axis),
    NUMBERS(se3d_wheel_def, radius),    NUMBERS(se3d_wheel_def, steer_upper),
    NUMBERS(se3d_wheel_def, wheelbase), FIELDS_END};

FILL_IN(se3d_road_def, road)
{
    static const double heights[4] = {0.0, 0.1, 0.2, 0.1};
    def->body = w->ground;
    def->heights = heights;
    def->column_count = def->row_count = 2;
    def->spacing[0] = def->spacing[1] = 0.5;
}
CREATE(se3d_road_def, road_create, se3d_road)
static const field road_fields[] = {NUMBERS(se3d_road_def, point), NUMBERS(se3d_road_def, normal),
                                    NUMBERS(se3d_road_def, forward),
                                    NUMBERS(se3d_road_def, spacing), FIELDS_END};

#define PRIMITIVE(what, TYPE)                                                                      \
    FILL_IN(se3d_primitive_def, what)                                                              \
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

FILL_IN(se3d_coupler_def, coupler)
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

FILL_IN(se3d_driver_def, driver)
{
    def->joint = w->pin;
}
CREATE(se3d_driver_def, driver_create, se3d_constraint)
static const field driver_fields[] = {INTEGER(se3d_driver_def, coordinate),
                                      INTEGER(se3d_driver_def, is_rate),
                                      NUMBERS(se3d_driver_def, value), FIELDS_END};

FILL_IN(se3d_material_def, material)
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
                                        NUMBERS(se3d_material_def, damping_ratio),
                                        NUMBERS(se3d_material_def, tangential_ratio_hertz),
                                        NUMBERS(se3d_material_def, tangential_damping),
                                        NUMBERS(se3d_material_def, tangential_stiffness),
                                        NUMBERS(se3d_material_def, rolling_stiffness),
                                        NUMBERS(se3d_material_def, rolling_ratio),
                                        NUMBERS(se3d_material_def, rolling_damping),
                                        NUMBERS(se3d_material_def, damping_rate),
                                        FIELDS_END};

FILL_IN(se3d_material_pair_def, pair)
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
                                    NUMBERS(se3d_material_pair_def, damping_ratio),
                                    NUMBERS(se3d_material_pair_def, damping_rate),
                                    NUMBERS(se3d_material_pair_def, tangential_ratio),
                                    NUMBERS(se3d_material_pair_def, tangential_damping),
                                    NUMBERS(se3d_material_pair_def, tangential_stiffness),
                                    NUMBERS(se3d_material_pair_def, rolling_stiffness),
                                    NUMBERS(se3d_material_pair_def, rolling_ratio),
                                    NUMBERS(se3d_material_pair_def, rolling_damping),
                                    NUMBERS(se3d_material_pair_def, young),
                                    NUMBERS(se3d_material_pair_def, poisson),
                                    INTEGER(se3d_material_pair_def, law),
                                    FIELDS_END};

FILL_IN(se3d_contact_settings, settings)
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

FILL_IN(se3d_particles_def, particles)
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
static const field particles_fields[] = {INTEGER(se3d_particles_def, threads),
                                         INTEGER(se3d_particles_def, portable),
                                         INTEGER(se3d_particles_def, boundary),
                                         NUMBERS(se3d_particles_def, lower),
                                         NUMBERS(se3d_particles_def, upper),
                                         NUMBERS(se3d_particles_def, step),
                                         NUMBERS(se3d_particles_def, skin),
                                         INTEGER(se3d_particles_def, audit),
                                         FIELDS_END};

FILL_IN(se3d_fill_def, region)
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

FILL_IN(se3d_particles_source_def, source)
{
    fill_in_region(w, &w->fill);
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

FILL_IN(se3d_particles_sink_def, sink)
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

FILL_IN(se3d_flow_def, flow)
{
    (void)w;
    def->normal[2] = def->along[0] = 1.0;
    def->size[0] = def->size[1] = 1.0;
}
static se3d_status create_flow(world *w, const void *def)
{
    uint32_t flow;
    return se3d_particles_add_flow(w->set, def, &flow);
}
static const field flow_fields[] = {NUMBERS(se3d_flow_def, point),  NUMBERS(se3d_flow_def, normal),
                                    NUMBERS(se3d_flow_def, radius), NUMBERS(se3d_flow_def, size),
                                    NUMBERS(se3d_flow_def, along),  NUMBERS(se3d_flow_def, window),
                                    INTEGER(se3d_flow_def, tag),    FIELDS_END};

FILL_IN(se3d_servo_def, servo)
{
    se3d_shape_def plane = se3d_shape_def_default();
    plane.material = w->material;
    plane.normal[2] = 1.0;
    CHECK(!se3d_shape_create_plane(w->system, &plane, &def->shape));
    def->axis[2] = def->load = def->speed_max = 1.0;
}
static se3d_status create_servo(world *w, const void *def)
{
    return se3d_particles_add_servo(w->set, def, NULL);
}
static const field servo_fields[] = {NUMBERS(se3d_servo_def, axis),
                                     NUMBERS(se3d_servo_def, load),
                                     NUMBERS(se3d_servo_def, area),
                                     NUMBERS(se3d_servo_def, speed_max),
                                     NUMBERS(se3d_servo_def, gain),
                                     NUMBERS(se3d_servo_def, start),
                                     FIELDS_END};

FILL_IN(se3d_cell_def, cell)
{
    const double r[6] = {0.5, 0.5, 0.5, 0.69, 0.5, 0.5}, radius[2] = {0.1, 0.1};
    se3d_particles_def box = se3d_particles_def_default();
    for (int k = 0; k < 3; ++k) {
        box.boundary[k] = SE3D_DOMAIN_BOUNDARY_PERIODIC;
        box.upper[k] = 1.0;
        def->stress[k] = def->gain[k] = 1.0;
    }
    box.mask = 0;
    CHECK(!se3d_particles_create(w->system, &box, &w->set));
    CHECK(!se3d_particles_add(w->set, w->material, 2, r, radius, NULL, NULL, NULL));
    def->servo[1] = 1;
    def->shear_servo = 1;
    def->shear_stress = 1.0;
}
static se3d_status create_cell(world *w, const void *def)
{
    return se3d_particles_add_cell_stage(w->set, def, NULL);
}
static const field cell_fields[] = {NUMBERS(se3d_cell_def, start),
                                    NUMBERS(se3d_cell_def, rate),
                                    NUMBERS(se3d_cell_def, gain),
                                    NUMBERS(se3d_cell_def, shear_rate),
                                    INTEGER(se3d_cell_def, flow),
                                    INTEGER(se3d_cell_def, gradient),
                                    INTEGER(se3d_cell_def, servo),
                                    NUMBERS(se3d_cell_def, stress),
                                    NUMBERS(se3d_cell_def, rate_max),
                                    INTEGER(se3d_cell_def, volume),
                                    INTEGER(se3d_cell_def, shear_servo),
                                    NUMBERS(se3d_cell_def, shear_stress),
                                    NUMBERS(se3d_cell_def, shear_rate_max),
                                    NUMBERS(se3d_cell_def, shear_gain),
                                    FIELDS_END};

FILL_IN(se3d_bond_def, bond)
{
    const double r[6] = {0.5, 0.5, 0.5, 0.69, 0.5, 0.5}, radius[2] = {0.1, 0.1};
    CHECK(!se3d_particles_create(w->system, NULL, &w->set));
    CHECK(!se3d_particles_add(w->set, w->material, 2, r, radius, NULL, NULL, NULL));
    def->young = def->normal_stiffness = def->shear_stiffness = 1e5;
    def->springs[0] = def->springs[1] = def->springs[2] = def->springs[3] = 1e3;
    def->poisson = 0.2;
}
static se3d_status create_bond(world *w, const void *def)
{
    return se3d_particles_bond_near(w->set, def, -1, -1, NULL, NULL);
}
static const field bond_fields[] = {INTEGER(se3d_bond_def, law),
                                    NUMBERS(se3d_bond_def, radius),
                                    NUMBERS(se3d_bond_def, ratio),
                                    NUMBERS(se3d_bond_def, young),
                                    NUMBERS(se3d_bond_def, poisson),
                                    NUMBERS(se3d_bond_def, normal_stiffness),
                                    NUMBERS(se3d_bond_def, damping),
                                    NUMBERS(se3d_bond_def, shear_stiffness),
                                    NUMBERS(se3d_bond_def, gap),
                                    NUMBERS(se3d_bond_def, tensile_strength),
                                    INTEGER(se3d_bond_def, contact),
                                    NUMBERS(se3d_bond_def, springs),
                                    NUMBERS(se3d_bond_def, dampers),
                                    NUMBERS(se3d_bond_def, limits),
                                    NUMBERS(se3d_bond_def, shear_strength),
                                    FIELDS_END};

static se3d_status get_height(void *ctx, const se3d_system *system, double *value)
{
    double r[3];
    const se3d_status status = se3d_body_get_position(system, ((world *)ctx)->ball, r);
    *value = r[2];
    return status;
}

FILL_IN(se3d_event_def, event)
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

FILL_IN(se3d_function_def, function)
{
    (void)w;
    (void)def;
}
CREATE(se3d_function_def, function_create, se3d_function)
static const field function_fields[] = {NUMBERS(se3d_function_def, constant), FIELDS_END};

/* What the lists of the library and FORCE_LIST create. */
static site site_of(const world *w)
{
    return (site){w->ground, w->ball, w->pin, w->material};
}
#define LISTED(definition, function, handle)                                                       \
    static void fill_in_##definition(world *w, void *storage)                                      \
    {                                                                                              \
        const site at = site_of(w);                                                                \
        fill_##definition(&at, storage);                                                           \
    }                                                                                              \
    static se3d_status create_##definition(world *w, const void *def)                              \
    {                                                                                              \
        handle made;                                                                               \
        return se3d_##function(w->system, def, &made);                                             \
    }
#define JOINT_FUNCTIONS(type, flags)        LISTED(type, joint_create_##type, se3d_constraint)
#define FORCE_FUNCTIONS(name, def)          LISTED(name, force_create_##name, se3d_force)
#define VARIANT_FUNCTIONS(variant, name)    LISTED(variant, force_create_##name, se3d_force)
#define SHAPE_FUNCTIONS(KIND, name, traits) LISTED(name, shape_create_##name, se3d_shape)
#define SUBJECT(name, fields)               {#name, fields, fill_in_##name, create_##name, 0},
#define JOINT_SUBJECT(type, flags)          SUBJECT(type, joint_fields)
#define FORCE_SUBJECT(name, other)          SUBJECT(name, name##_fields)
#define SHAPE_SUBJECT(KIND, name, traits)   SUBJECT(name, shape_fields)
SE3DI_JOINT_LIST(JOINT_FUNCTIONS)
FORCE_LIST(FORCE_FUNCTIONS)
FORCE_VARIANT_LIST(VARIANT_FUNCTIONS)
SE3DI_SHAPE_LIST(SHAPE_FUNCTIONS)

static const subject subjects[] = {
    SE3DI_JOINT_LIST(JOINT_SUBJECT) FORCE_LIST(FORCE_SUBJECT) FORCE_VARIANT_LIST(FORCE_SUBJECT)
        SE3DI_SHAPE_LIST(SHAPE_SUBJECT){"body", body_fields, fill_in_body, create_body_create, 0},
    {"marker", marker_fields, fill_in_marker, create_marker_create, 0},
    {"state", state_fields, fill_in_state, create_state_create, 0},
    {"wheel", wheel_fields, fill_in_wheel, create_wheel_create, 0},
    {"road", road_fields, fill_in_road, create_road_create, 0},
    {"dp1", primitive_fields, fill_in_dp1, create_primitive_create, 0},
    {"dp2", primitive_fields, fill_in_dp2, create_primitive_create, 0},
    {"d", primitive_fields, fill_in_d, create_primitive_create, 0},
    {"cd", primitive_fields, fill_in_cd, create_primitive_create, 0},
    {"coupler", coupler_fields, fill_in_coupler, create_joint_create_coupler, 0},
    {"driver", driver_fields, fill_in_driver, create_driver_create, 0},
    {"material", material_fields, fill_in_material, create_material, 0},
    {"material pair", pair_fields, fill_in_pair, create_pair, 0},
    {"contact settings", settings_fields, fill_in_settings, create_settings, 0},
    {"particles", particles_fields, fill_in_particles, create_particles, 0},
    {"lattice", region_fields, fill_in_region, create_lattice, 1},
    {"random filling", region_fields, fill_in_region, create_random, 1},
    {"source", source_fields, fill_in_source, create_source, 1},
    {"sink", sink_fields, fill_in_sink, create_sink, 1},
    {"flow", flow_fields, fill_in_flow, create_flow, 1},
    {"servo", servo_fields, fill_in_servo, create_servo, 1},
    {"cell", cell_fields, fill_in_cell, create_cell, 0},
    {"bond", bond_fields, fill_in_bond, create_bond, 0},
    {"event", event_fields, fill_in_event, create_event, 0},
    {"function", function_fields, fill_in_function, create_function_create, 0},
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
