/* SPDX-License-Identifier: BSD-3-Clause */
/* Good definitions of joints, force elements and shapes, and their members. One place for the tests
 * of misuse, hostile numbers, calls from callbacks and failed allocations: they take joints and
 * shapes from the lists of the library, force elements from FORCE_LIST. */
#ifndef SE3D_TESTS_MISUSE_ELEMENT_DEFS_H
#define SE3D_TESTS_MISUSE_ELEMENT_DEFS_H

#include <stddef.h>
#include <string.h>

#include "joint/joint.h"
#include "model/shape.h"
#include "se3d/se3d.h"

/* What elements are attached to: `body` is at the origin, or a little above it. */
typedef struct site {
    se3d_body ground, body;
    se3d_constraint pin; /* a revolute */
    se3d_material material;
} site;

/* Kinds: d double, u double that may be infinite or that not every type uses, i int32_t, z size_t,
 * b body, c constraint, f function or null, N name. */
typedef struct field {
    const char *name; /* NULL: the end */
    size_t offset, size, count;
    char kind;
} field;

#define FIELD(type, member, kind, unit)                                                            \
    {                                                                                              \
#member, offsetof(type, member), sizeof(unit), sizeof(((type *)0)->member) / sizeof(unit), \
            kind                                                                                   \
    }
#define NUMBERS(type, member)  FIELD(type, member, 'd', double)
#define LOOSE(type, member)    FIELD(type, member, 'u', double)
#define INTEGER(type, member)  FIELD(type, member, 'i', int32_t)
#define SIZE(type, member)     FIELD(type, member, 'z', size_t)
#define BODY(type, member)     FIELD(type, member, 'b', se3d_body)
#define JOINT(type, member)    FIELD(type, member, 'c', se3d_constraint)
#define FUNCTION(type, member) FIELD(type, member, 'f', se3d_function)
#define NAME(type)             FIELD(type, name, 'N', const char *)
/* The table <name>_fields; not every test needs all. */
#define FIELDS(name) __attribute__((unused)) static const field name##_fields[]
#define FIELDS_END                                                                                 \
    {                                                                                              \
        NULL, 0, 0, 0, 0                                                                           \
    }

/* FILL(type, name) { ... }: the function fill_<name>, which sets what the defaults lack. */
#define FILL(type, name)                                                                           \
    static void set_##name(const site *at, type *def);                                             \
    static inline void fill_##name(const site *at, void *storage)                                  \
    {                                                                                              \
        type def = type##_default();                                                               \
        set_##name(at, &def);                                                                      \
        memcpy(storage, &def, sizeof def);                                                         \
    }                                                                                              \
    static void set_##name(const site *at, type *def)

/* ------------------------------------------------------------------ force elements */

/* X(name, def): se3d_force_create_<name>, which takes the definition se3d_<def>_def. */
#define FORCE_LIST(X)                                                                              \
    X(tsda, tsda)                                                                                  \
    X(rsda, rsda)                                                                                  \
    X(load, load)                                                                                  \
    X(torque, load)                                                                                \
    X(bushing, bushing)                                                                            \
    X(friction, friction)                                                                          \
    X(stop, stop)                                                                                  \
    X(effort, effort)                                                                              \
    X(armature, armature)                                                                          \
    X(tyre, tyre)                                                                                  \
    X(callback, force_callback)

/* X(variant, name): other definitions of the same elements. */
#define FORCE_VARIANT_LIST(X)                                                                      \
    X(rsda_between, rsda)                                                                          \
    X(stop_between, stop)                                                                          \
    X(tyre_fiala, tyre)                                                                            \
    X(tyre_magic, tyre)                                                                            \
    X(tyre_lagging, tyre)

FILL(se3d_tsda_def, tsda)
{
    def->body_i = at->ground;
    def->body_j = at->body;
    def->point_i[2] = 1.0;
    def->k = 100.0;
    def->c = 1.0;
    def->l0 = 0.5;
}
FIELDS(tsda) = {NAME(se3d_tsda_def),
                BODY(se3d_tsda_def, body_i),
                BODY(se3d_tsda_def, body_j),
                NUMBERS(se3d_tsda_def, point_i),
                NUMBERS(se3d_tsda_def, point_j),
                NUMBERS(se3d_tsda_def, k),
                NUMBERS(se3d_tsda_def, c),
                NUMBERS(se3d_tsda_def, l0),
                NUMBERS(se3d_tsda_def, preload),
                FUNCTION(se3d_tsda_def, h),
                FUNCTION(se3d_tsda_def, spring),
                FUNCTION(se3d_tsda_def, damper),
                FIELDS_END};

FILL(se3d_rsda_def, rsda)
{
    def->joint = at->pin;
    def->k = 10.0;
    def->c = 0.1;
}
FIELDS(rsda) = {NAME(se3d_rsda_def),
                JOINT(se3d_rsda_def, joint),
                NUMBERS(se3d_rsda_def, k),
                NUMBERS(se3d_rsda_def, c),
                NUMBERS(se3d_rsda_def, theta0),
                NUMBERS(se3d_rsda_def, preload),
                FUNCTION(se3d_rsda_def, h),
                FUNCTION(se3d_rsda_def, spring),
                FUNCTION(se3d_rsda_def, damper),
                FIELDS_END};

FILL(se3d_rsda_def, rsda_between)
{
    def->body_i = at->ground;
    def->body_j = at->body;
    def->axis_i[2] = 1.0;
    def->k = 10.0;
}
FIELDS(rsda_between) = {BODY(se3d_rsda_def, body_i),    BODY(se3d_rsda_def, body_j),
                        NUMBERS(se3d_rsda_def, axis_i), NUMBERS(se3d_rsda_def, ref_i),
                        NUMBERS(se3d_rsda_def, ref_j),  NUMBERS(se3d_rsda_def, angle0),
                        NUMBERS(se3d_rsda_def, theta0), FIELDS_END};

FILL(se3d_load_def, load)
{
    def->body = at->body;
    def->value[0] = 1.0;
}
FIELDS(load) = {NAME(se3d_load_def),
                BODY(se3d_load_def, body),
                NUMBERS(se3d_load_def, point),
                NUMBERS(se3d_load_def, value),
                INTEGER(se3d_load_def, in_body_frame),
                FUNCTION(se3d_load_def, function),
                FIELDS_END};
#define fill_torque   fill_load
#define torque_fields load_fields

FILL(se3d_bushing_def, bushing)
{
    def->body_i = at->ground;
    def->body_j = at->body;
    for (int k = 0; k < 6; ++k) {
        def->K[7 * k] = 100.0;
        def->C[7 * k] = 1.0;
    }
}
FIELDS(bushing) = {NAME(se3d_bushing_def),
                   BODY(se3d_bushing_def, body_i),
                   BODY(se3d_bushing_def, body_j),
                   NUMBERS(se3d_bushing_def, point_i),
                   NUMBERS(se3d_bushing_def, point_j),
                   NUMBERS(se3d_bushing_def, orientation_i),
                   NUMBERS(se3d_bushing_def, orientation_j),
                   NUMBERS(se3d_bushing_def, K),
                   NUMBERS(se3d_bushing_def, C),
                   FIELDS_END};

FILL(se3d_friction_def, friction)
{
    def->joint = at->pin;
    def->mu = 0.3;
    def->mu_static = 0.4;
    def->radius = 0.01;
    def->limit = 0.1;
}
FIELDS(friction) = {NAME(se3d_friction_def),
                    JOINT(se3d_friction_def, joint),
                    INTEGER(se3d_friction_def, coordinate),
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
    def->joint = at->pin;
    def->upper = 1.0;
    def->k = 1000.0;
}
FIELDS(stop) = {NAME(se3d_stop_def),
                JOINT(se3d_stop_def, joint),
                INTEGER(se3d_stop_def, coordinate),
                LOOSE(se3d_stop_def, lower),
                LOOSE(se3d_stop_def, upper),
                NUMBERS(se3d_stop_def, k),
                NUMBERS(se3d_stop_def, restitution),
                FIELDS_END};

FILL(se3d_stop_def, stop_between)
{
    def->body_i = at->ground;
    def->body_j = at->body;
    def->point_i[2] = 1.0;
    def->upper = 1.0;
    def->k = 1000.0;
}
FIELDS(stop_between) = {BODY(se3d_stop_def, body_i), BODY(se3d_stop_def, body_j),
                        NUMBERS(se3d_stop_def, point_i), NUMBERS(se3d_stop_def, point_j),
                        FIELDS_END};

FILL(se3d_effort_def, effort)
{
    def->joint = at->pin;
    def->value = 1.0;
}
FIELDS(effort) = {NAME(se3d_effort_def),
                  JOINT(se3d_effort_def, joint),
                  INTEGER(se3d_effort_def, coordinate),
                  NUMBERS(se3d_effort_def, value),
                  FUNCTION(se3d_effort_def, function),
                  FIELDS_END};

FILL(se3d_armature_def, armature)
{
    def->joint = at->pin;
    def->inertia = 0.5;
}
FIELDS(armature) = {NAME(se3d_armature_def), JOINT(se3d_armature_def, joint),
                    INTEGER(se3d_armature_def, coordinate), NUMBERS(se3d_armature_def, inertia),
                    FIELDS_END};

FILL(se3d_tyre_def, tyre)
{
    def->road = at->ground;
    def->wheel = at->body;
    def->point[2] = -0.2;
    def->radius = 0.3;
    def->k = 1000.0;
    def->c = 10.0;
    def->mu = 0.8;
    def->slip_stiffness = 500.0;
    def->cornering_stiffness = 400.0;
    def->patch_length = 0.1;
    def->rolling_resistance = 0.01;
}
FIELDS(tyre) = {NAME(se3d_tyre_def),
                BODY(se3d_tyre_def, road),
                BODY(se3d_tyre_def, wheel),
                NUMBERS(se3d_tyre_def, point),
                NUMBERS(se3d_tyre_def, normal),
                NUMBERS(se3d_tyre_def, center),
                NUMBERS(se3d_tyre_def, axis),
                INTEGER(se3d_tyre_def, side),
                NUMBERS(se3d_tyre_def, radius),
                NUMBERS(se3d_tyre_def, k),
                NUMBERS(se3d_tyre_def, c),
                NUMBERS(se3d_tyre_def, mu),
                NUMBERS(se3d_tyre_def, mu_min),
                NUMBERS(se3d_tyre_def, slip_stiffness),
                NUMBERS(se3d_tyre_def, cornering_stiffness),
                NUMBERS(se3d_tyre_def, patch_length),
                NUMBERS(se3d_tyre_def, rolling_resistance),
                NUMBERS(se3d_tyre_def, rolling_radius),
                NUMBERS(se3d_tyre_def, low_speed),
                FIELDS_END};

FILL(se3d_tyre_def, tyre_fiala)
{
    set_tyre(at, def);
    def->law = SE3D_TYRE_FIALA;
    def->mu_min = 0.6;
}
FIELDS(tyre_fiala) = {NUMBERS(se3d_tyre_def, mu), NUMBERS(se3d_tyre_def, mu_min), FIELDS_END};

FILL(se3d_tyre_def, tyre_magic)
{
    static const struct {
        int32_t at, reserved;
        double value;
    } given[] = {
        {SE3D_TYRE_FNOMIN, 0, 100.0}, {SE3D_TYRE_PCX1, 0, 1.6},  {SE3D_TYRE_PDX1, 0, 1.1},
        {SE3D_TYRE_PKX1, 0, 20.0},    {SE3D_TYRE_PCY1, 0, 1.3},  {SE3D_TYRE_PDY1, 0, 1.0},
        {SE3D_TYRE_PKY1, 0, -15.0},   {SE3D_TYRE_PKY2, 0, 2.0},  {SE3D_TYRE_PHYP1, 0, 1.0},
        {SE3D_TYRE_PHYP2, 0, 0.15},   {SE3D_TYRE_QCRP1, 0, 0.2}, {SE3D_TYRE_QDRP1, 0, 1.0}};
    static double c[SE3D_TYRE_COEFFICIENTS];
    se3d_tyre_coefficients_init(c, SE3D_TYRE_COEFFICIENTS);
    for (size_t k = 0; k < sizeof given / sizeof *given; ++k) {
        c[given[k].at] = given[k].value;
    }
    set_tyre(at, def);
    def->law = SE3D_TYRE_MF61;
    def->has_turn_slip = 1;
    def->coefficients = c;
    def->coefficient_count = SE3D_TYRE_COEFFICIENTS;
}
FIELDS(tyre_magic) = {INTEGER(se3d_tyre_def, law),           SIZE(se3d_tyre_def, coefficient_count),
                      INTEGER(se3d_tyre_def, measured_side), NUMBERS(se3d_tyre_def, mu),
                      INTEGER(se3d_tyre_def, has_turn_slip), FIELDS_END};

FILL(se3d_tyre_def, tyre_lagging)
{
    set_tyre(at, def);
    def->relaxation_x = 0.2;
    def->relaxation_y = 0.4;
}
FIELDS(tyre_lagging) = {INTEGER(se3d_tyre_def, is_transient), NUMBERS(se3d_tyre_def, relaxation_x),
                        NUMBERS(se3d_tyre_def, relaxation_y), FIELDS_END};

static inline se3d_status no_force(void *ctx, double t, const se3d_body_motion motion[2],
                                   double wrench[12], double *K, double *D)
{
    (void)ctx, (void)t, (void)motion, (void)K, (void)D;
    memset(wrench, 0, 12 * sizeof *wrench);
    return SE3D_OK;
}
FILL(se3d_force_callback_def, callback)
{
    def->body_i = at->ground;
    def->body_j = at->body;
    def->callback = no_force;
}
FIELDS(callback) = {NAME(se3d_force_callback_def), BODY(se3d_force_callback_def, body_i),
                    BODY(se3d_force_callback_def, body_j), FIELDS_END};

/* ------------------------------------------------------------------ joints */

static inline int is_one_of(const char *name, const char *const *names)
{
    while (*names && strcmp(*names, name) != 0) {
        ++names;
    }
    return *names != NULL;
}

/* A joint between the ground and the body; most types take parallel axes and points that meet. */
static inline void fill_joint(const site *at, const char *type, void *storage)
{
    static const char *const crossed[] = {"universal", "perpendicular", "perpendicular2", NULL};
    static const char *const apart[] = {"distance", "revolute_spherical", "revolute_cylindrical",
                                        NULL};
    se3d_joint_def def = se3d_joint_def_default();
    def.body_i = at->ground;
    def.body_j = at->body;
    def.point_i[0] = is_one_of(type, apart) ? -0.5 : 0.0;
    def.point_i[2] = 0.0999;
    def.pitch = 0.1;
    def.distance = 0.5;
    def.axis_j[0] = is_one_of(type, crossed) ? 1.0 : 0.0;
    def.axis_j[2] = 1.0 - def.axis_j[0];
    memcpy(storage, &def, sizeof def);
}
#define JOINT_FILL(type, flags)                                                                    \
    static inline void fill_##type(const site *at, void *storage)                                  \
    {                                                                                              \
        fill_joint(at, #type, storage);                                                            \
    }
SE3DI_JOINT_LIST(JOINT_FILL)
#undef JOINT_FILL
FIELDS(joint) = {NAME(se3d_joint_def),
                 BODY(se3d_joint_def, body_i),
                 BODY(se3d_joint_def, body_j),
                 NUMBERS(se3d_joint_def, point_i),
                 NUMBERS(se3d_joint_def, point_j),
                 NUMBERS(se3d_joint_def, axis_i),
                 NUMBERS(se3d_joint_def, axis_j),
                 NUMBERS(se3d_joint_def, ref_i),
                 NUMBERS(se3d_joint_def, ref_j),
                 NUMBERS(se3d_joint_def, angle0),
                 LOOSE(se3d_joint_def, pitch),
                 LOOSE(se3d_joint_def, distance),
                 FIELDS_END};

/* ------------------------------------------------------------------ shapes */

FILL(se3d_shape_def, shape)
{
    static const double corners[12] = {0, 0, 0, 0.1, 0, 0, 0, 0.1, 0, 0, 0, 0.1};
    static const uint32_t faces[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    def->body = at->body;
    def->material = at->material;
    def->position[2] = 0.05;
    def->size[0] = def->size[1] = def->size[2] = 0.1;
    def->radius = 0.05;
    def->length = 0.1;
    def->bottom_radius = 0.05;
    def->top_radius = 0.03;
    def->vertices = corners;
    def->triangles = faces;
    def->vertex_count = def->triangle_count = 4;
    def->heights = corners;
    def->row_count = 3;
    def->column_count = 4;
    def->spacing[0] = def->spacing[1] = 0.1;
    def->semi_axes[0] = def->semi_axes[1] = def->semi_axes[2] = 0.1;
}
FIELDS(shape) = {NUMBERS(se3d_shape_def, position),
                 NUMBERS(se3d_shape_def, orientation),
                 NUMBERS(se3d_shape_def, normal),
                 NUMBERS(se3d_shape_def, size),
                 NUMBERS(se3d_shape_def, radius),
                 NUMBERS(se3d_shape_def, length),
                 NUMBERS(se3d_shape_def, spacing),
                 NUMBERS(se3d_shape_def, bottom_radius),
                 NUMBERS(se3d_shape_def, top_radius),
                 NUMBERS(se3d_shape_def, surface_velocity),
                 NUMBERS(se3d_shape_def, surface_spin),
                 NUMBERS(se3d_shape_def, semi_axes),
                 FIELDS_END};

#define SHAPE_FILL(KIND, name, traits)                                                             \
    static inline void fill_##name(const site *at, void *storage)                                  \
    {                                                                                              \
        fill_shape(at, storage);                                                                   \
    }
SE3DI_SHAPE_LIST(SHAPE_FILL)
#undef SHAPE_FILL

#endif
