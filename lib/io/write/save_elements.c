/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints, couplers, primitives, drivers, states, force elements and wheels as a model file. A joint
 * is said by its frames on both bodies, so that it does not depend on their poses. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/document/keys.h"
#include "io/read/forces_tyre.h"
#include "io/write/save.h"

/* ---- constraints ----------------------------------------------------------------------------*/

static const char coupled[] = " coupler gear rack_pinion ";
static const char primitives[] = " dp1 dp2 d cd ";
static const char points_only[] = " spherical distance ";

static void save_pair(se3di_save *s, se3d_constraint joint, const char *type)
{
    se3d_joint_def def = se3d_joint_def_default();
    (void)se3d_joint_get_def(s->system, joint, &def);
    se3di_save_text(s, "name", s->constraints.names[joint.index1]);
    se3di_save_text(s, "type", type);
    se3di_save_body(s, "body_i", def.body_i);
    se3di_save_body(s, "body_j", def.body_j);
    se3di_save_vector(s, "point_i", def.point_i, 3);
    se3di_save_vector(s, "point_j", def.point_j, 3);
    if (!se3di_keys_contain(points_only, type)) {
        se3di_save_vector(s, "axis_i", def.axis_i, 3);
        se3di_save_vector(s, "axis_j", def.axis_j, 3);
        se3di_save_vector(s, "ref_i", def.ref_i, 3);
        se3di_save_vector(s, "ref_j", def.ref_j, 3);
        se3di_save_number_but(s, "angle0", def.angle0, 0.0);
    }
    se3di_save_number_but(s, "pitch", def.pitch, 0.0);
    if (se3di_keys_contain(" distance revolute_spherical revolute_cylindrical ", type)) {
        se3di_save_number(s, "distance", def.distance);
    }
    if (def.break_force > 0.0 || def.break_moment > 0.0) {
        se3di_save_word(s, "break", "{");
        s->is_first = true;
        se3di_save_number_but(s, "force", def.break_force, 0.0);
        se3di_save_number_but(s, "moment", def.break_moment, 0.0);
        se3di_save_put(s, "}");
    }
}

static void save_coupler(se3di_save *s, se3d_constraint joint)
{
    se3d_coupler_def def = se3d_coupler_def_default();
    (void)se3d_coupler_get_def(s->system, joint, &def);
    se3di_save_text(s, "name", s->constraints.names[joint.index1]);
    se3di_save_text(s, "type", "coupler");
    se3di_save_word(s, "terms", "[");
    for (size_t k = 0; k < def.count; ++k) {
        se3di_save_put(s, k > 0 ? ", {" : "{");
        s->is_first = true;
        se3di_save_coordinate(s, def.joint[k], def.coordinate[k]);
        se3di_save_number_but(s, "ratio", def.ratio[k], 1.0);
        se3di_save_put(s, "}");
    }
    se3di_save_put(s, "]");
    if (def.function.index1 != 0) {
        se3di_save_function(s, "value", def.function, NULL);
    } else {
        se3di_save_number_but(s, "value", def.value, 0.0);
    }
}

static void save_primitive(se3di_save *s, se3d_constraint primitive, const char *type)
{
    se3d_primitive_def def = se3d_primitive_def_default();
    (void)se3d_primitive_get_def(s->system, primitive, &def);
    se3di_save_text(s, "name", s->constraints.names[primitive.index1]);
    se3di_save_text(s, "type", type);
    se3di_save_body(s, "body_i", def.body_i);
    se3di_save_body(s, "body_j", def.body_j);
    se3di_save_vector_but_zero(s, "a_i", def.a_i, 3);
    se3di_save_vector_but_zero(s, "a_j", def.a_j, 3);
    if (def.type != SE3D_PRIMITIVE_DP1) {
        se3di_save_vector(s, "point_i", def.point_i, 3);
        se3di_save_vector(s, "point_j", def.point_j, 3);
    }
    se3di_save_vector_but_zero(s, "c", def.c, 3);
    se3di_save_word(s, "value", "");
    se3di_save_put_function(s, def.function, def.value, NULL);
}

/* A rate that is integrated from another time than 0 begins there only if it is a number. */
static void save_rate(se3di_save *s, const se3d_driver_def *driver, se3d_function_def *def)
{
    double start = def->start;
    if (def->start_time != 0.0) {
        if (def->compiled || def->callback || def->table_x) {
            se3di_save_refuse(s,
                              "the rate of driver %.100s is integrated from t = %g s, a file "
                              "begins at 0",
                              driver->name ? driver->name : "", def->start_time);
        }
        start -= def->constant * def->start_time;
    }
    se3di_save_word(s, "rate", "");
    se3di_save_put_function(s, driver->function, 0.0, NULL);
    se3di_save_number(s, "start", start);
}

static void save_driver(se3di_save *s, se3d_constraint driver)
{
    se3d_driver_def def = se3d_driver_def_default();
    se3d_function_def function = se3d_function_def_default();
    (void)se3d_driver_get_def(s->system, driver, &def);
    se3di_save_text(s, "name", s->constraints.names[driver.index1]);
    se3di_save_coordinate(s, def.joint, def.coordinate);
    if (def.function.index1 != 0) {
        (void)se3d_function_get_def(s->system, def.function, &function);
    }
    if (function.integrate) {
        save_rate(s, &def, &function);
        return;
    }
    se3di_save_word(s, def.is_rate ? "rate" : "value", "");
    se3di_save_put_function(s, def.function, def.value, NULL);
}

/* The lists of a file in their order, with the constraints that each of them has. */
typedef enum list { PAIRS, COUPLINGS, PRIMITIVES, DRIVERS, LISTS } list;

static list list_of(const char *type)
{
    if (se3di_keys_contain(coupled, type)) {
        return COUPLINGS;
    }
    if (strcmp(type, "driver") == 0) {
        return DRIVERS;
    }
    return se3di_keys_contain(primitives, type) || strncmp(type, "perpendicular", 13) == 0 ||
                   strcmp(type, "user") == 0
               ? strcmp(type, "perpendicular") == 0 ? PAIRS : PRIMITIVES
               : PAIRS;
}

static void save_constraint(se3di_save *s, se3d_constraint constraint, const char *type)
{
    if (strcmp(type, "user") == 0) {
        se3di_save_refuse(s, "constraint %.100s is a callback, which a file cannot hold",
                          s->constraints.names[constraint.index1]);
    } else if (strcmp(type, "driver") == 0) {
        save_driver(s, constraint);
    } else if (se3di_keys_contain(coupled, type)) {
        save_coupler(s, constraint);
    } else if (se3di_keys_contain(primitives, type)) {
        save_primitive(s, constraint, type);
    } else {
        save_pair(s, constraint, type);
    }
}

void se3di_save_name_problem(se3di_save *s, const char *what, const char *name)
{
    char text[sizeof s->problem];
    if (s->status >= 0 && s->problem[0] && !strstr(s->problem, name)) {
        snprintf(text, sizeof text, "%s %.100s: %.380s", what, name, s->problem);
        memcpy(s->problem, text, sizeof text);
    }
}

void se3di_save_constraints(se3di_save *s)
{
    static const char *const titles[LISTS] = {"joints", "joints", "constraints", "drivers"};
    for (int at = PAIRS; at < LISTS; ++at) {
        if (at != COUPLINGS || s->section) {
            se3di_save_begin_section(s, titles[at]);
        }
        s->indent = "     ";
        for (size_t k = 0; k < se3d_system_count_constraints(s->system); ++k) {
            se3d_constraint constraint;
            const char *type = "";
            (void)se3d_system_get_constraint(s->system, k, &constraint);
            (void)se3d_constraint_get_type(s->system, constraint, &type);
            if (list_of(type) != (list)at) {
                continue;
            }
            const char *name = s->constraints.names[constraint.index1];
            const se3di_save_entry entry = se3di_save_open(s);
            save_constraint(s, constraint, type);
            se3di_save_name_problem(s, type, name);
            if (!se3di_save_close(s, &entry)) {
                s->constraints.names[constraint.index1] = NULL;
            }
        }
    }
}

/* ---- force elements -------------------------------------------------------------------------*/

static void save_laws(se3di_save *s, se3d_function h, se3d_function spring, se3d_function damper,
                      const char *const *variables)
{
    static const char *const elastic[] = {"x", NULL};
    static const char *const viscous[] = {"v", NULL};
    se3di_save_function(s, "spring", spring, elastic);
    se3di_save_function(s, "damper", damper, viscous);
    se3di_save_function(s, "h", h, variables);
}

static void save_tsda(se3di_save *s, se3d_force force)
{
    static const char *const variables[] = {"t", "l", "ldot", NULL};
    se3d_tsda_def def = se3d_tsda_def_default();
    (void)se3d_force_get_tsda(s->system, force, &def);
    se3di_save_body(s, "body_i", def.body_i);
    se3di_save_body(s, "body_j", def.body_j);
    se3di_save_vector(s, "point_i", def.point_i, 3);
    se3di_save_vector(s, "point_j", def.point_j, 3);
    se3di_save_number_but(s, "k", def.k, 0.0);
    se3di_save_number_but(s, "c", def.c, 0.0);
    se3di_save_number_but(s, "l0", def.l0, 0.0);
    se3di_save_number_but(s, "preload", def.preload, 0.0);
    save_laws(s, def.h, def.spring, def.damper, variables);
}

static void save_rsda(se3di_save *s, se3d_force force)
{
    static const char *const variables[] = {"t", "theta", "thetadot", NULL};
    se3d_rsda_def def = se3d_rsda_def_default();
    (void)se3d_force_get_rsda(s->system, force, &def);
    if (def.joint.index1 != 0) {
        se3di_save_constraint(s, "joint", def.joint);
    } else {
        se3di_save_body(s, "body_i", def.body_i);
        se3di_save_body(s, "body_j", def.body_j);
        se3di_save_vector(s, "axis_i", def.axis_i, 3);
        se3di_save_vector(s, "ref_i", def.ref_i, 3);
        se3di_save_vector(s, "ref_j", def.ref_j, 3);
        se3di_save_number_but(s, "angle0", def.angle0, 0.0);
    }
    se3di_save_number_but(s, "k", def.k, 0.0);
    se3di_save_number_but(s, "c", def.c, 0.0);
    se3di_save_number_but(s, "theta0", def.theta0, 0.0);
    se3di_save_number_but(s, "preload", def.preload, 0.0);
    save_laws(s, def.h, def.spring, def.damper, variables);
}

static void save_matrix(se3di_save *s, const char *key, const double K[36])
{
    double diagonal[6];
    double rest[36];
    memcpy(rest, K, sizeof rest);
    for (int k = 0; k < 6; ++k) {
        diagonal[k] = K[7 * k];
        rest[7 * k] = 0.0;
    }
    if (se3di_save_is_zero(K, 36)) {
        return;
    }
    if (se3di_save_is_zero(rest, 36)) {
        se3di_save_vector(s, key, diagonal, 6);
        return;
    }
    se3di_save_word(s, key, "[");
    for (int k = 0; k < 6; ++k) {
        s->is_first = true; /* rows have no keys */
        se3di_save_put(s, k > 0 ? ",\n" : "\n");
        se3di_save_put(s, s->indent);
        se3di_save_put_row(s, K + 6 * k, 6);
    }
    s->is_first = false;
    se3di_save_put(s, "]");
}

static void save_bushing(se3di_save *s, se3d_force force)
{
    se3d_bushing_def def = se3d_bushing_def_default();
    (void)se3d_force_get_bushing_def(s->system, force, &def);
    se3di_save_body(s, "body_i", def.body_i);
    se3di_save_body(s, "body_j", def.body_j);
    se3di_save_vector(s, "point_i", def.point_i, 3);
    se3di_save_vector(s, "point_j", def.point_j, 3);
    se3di_save_orientation(s, "orientation_i", def.orientation_i);
    se3di_save_orientation(s, "orientation_j", def.orientation_j);
    save_matrix(s, "K", def.K);
    save_matrix(s, "C", def.C);
}

static void save_friction(se3di_save *s, se3d_force force)
{
    se3d_friction_def def = se3d_friction_def_default();
    (void)se3d_force_get_friction(s->system, force, &def);
    se3di_save_coordinate(s, def.joint, def.coordinate);
    se3di_save_number_but(s, "mu", def.mu, 0.0);
    se3di_save_number_but(s, "mu_static", def.mu_static, def.mu);
    se3di_save_number_but(s, "radius", def.radius, 0.0);
    se3di_save_number_but(s, "limit", def.limit, 0.0);
    se3di_save_number_but(s, "viscous", def.viscous, 0.0);
    se3di_save_number_but(s, "presliding", def.presliding, 1e-9);
    se3di_save_number_but(s, "length", def.length, 0.0);
    se3di_save_number_but(s, "width", def.width, 0.0);
    se3di_save_number_but(s, "thrust_radius", def.thrust_radius, 0.0);
}

static void save_stop(se3di_save *s, se3d_force force)
{
    se3d_stop_def def = se3d_stop_def_default();
    (void)se3d_force_get_stop(s->system, force, &def);
    if (def.joint.index1 != 0) {
        se3di_save_coordinate(s, def.joint, def.coordinate);
    } else {
        se3di_save_body(s, "body_i", def.body_i);
        se3di_save_body(s, "body_j", def.body_j);
        se3di_save_vector(s, "point_i", def.point_i, 3);
        se3di_save_vector(s, "point_j", def.point_j, 3);
    }
    if (isfinite(def.lower)) {
        se3di_save_number(s, "lower", def.lower);
    }
    if (isfinite(def.upper)) {
        se3di_save_number(s, "upper", def.upper);
    }
    se3di_save_number(s, "k", def.k);
    se3di_save_number_but(s, "restitution", def.restitution, 1.0);
}

static void save_effort(se3di_save *s, se3d_force force)
{
    static const char *const variables[] = {"t", "q", "qdot", NULL};
    se3d_effort_def def = se3d_effort_def_default();
    (void)se3d_force_get_effort(s->system, force, &def);
    se3di_save_coordinate(s, def.joint, def.coordinate);
    se3di_save_word(s, "value", "");
    se3di_save_put_function(s, def.function, def.value, variables);
}

static void save_armature(se3di_save *s, se3d_force force)
{
    se3d_armature_def def = se3d_armature_def_default();
    (void)se3d_force_get_armature(s->system, force, &def);
    se3di_save_coordinate(s, def.joint, def.coordinate);
    se3di_save_number(s, "inertia", def.inertia);
}

static void save_load(se3di_save *s, se3d_force force, const char *type)
{
    se3d_load_def def = se3d_load_def_default();
    (void)se3d_force_get_load(s->system, force, &def);
    se3di_save_body(s, "body", def.body);
    if (strcmp(type, "force") == 0) {
        se3di_save_vector_but_zero(s, "point", def.point, 3);
    }
    if (def.in_body_frame) {
        se3di_save_word(s, "frame", "body");
    }
    se3di_save_word(s, "value", "[");
    for (int k = 0; k < 3; ++k) {
        se3di_save_put(s, k > 0 ? ", " : "");
        se3di_save_put_function(s, def.function[k], def.value[k], NULL);
    }
    se3di_save_put(s, "]");
}

/* The file of coefficients that the entry of a model names. */
static void save_coefficients(se3di_save *s, se3d_force force)
{
    const se3di_node *file = NULL;
    const se3di_component *part = NULL;
    for (size_t k = 0; s->model && k < s->model->element_count; ++k) {
        const se3di_element_entry *entry = &s->model->elements[k];
        if (entry->kind == SE3DI_ELEMENT_FORCE && entry->force.index1 == force.index1) {
            file = se3di_node_get(entry->node, "file");
            part = entry->part;
        }
    }
    if (!file) {
        se3di_save_refuse(s, "the coefficients of tyre %.100s are in no file",
                          s->forces.names[force.index1]);
        return;
    }
    se3di_save_text(s, "file", se3di_save_get_file(s, part, file->text));
}

/* The plane that a tyre rolls on, or its road. */
static void save_surface(se3di_save *s, const se3d_tyre_def *def)
{
    if (def->surface.index1 == 0) {
        se3di_save_body(s, "road", def->road);
        se3di_save_vector(s, "road_point", def->point, 3);
        se3di_save_vector(s, "normal", def->normal, 3);
        return;
    }
    const char *name = s->roads.names[def->surface.index1];
    if (!name) {
        se3di_save_refuse(s, "its road is not in the file");
        return;
    }
    se3di_save_text(s, "road", name);
    se3di_save_number_but(s, "envelope", def->envelope_length, 0.0);
    se3di_save_number_but(s, "envelope_width", def->envelope_width, 0.0);
}

static void save_tyre(se3di_save *s, se3d_force force)
{
    se3d_tyre_def def = se3d_tyre_def_default();
    (void)se3d_force_get_tyre(s->system, force, &def);
    se3di_save_body(s, "body", def.wheel);
    se3di_save_vector_but_zero(s, "point", def.center, 3);
    se3di_save_word(s, "frame", "body");
    se3di_save_vector(s, "axis", def.axis, 3);
    if (def.side != SE3D_TYRE_LEFT) {
        se3di_save_word(s, "side", se3di_tyre_sides[def.side]);
    }
    save_surface(s, &def);
    se3di_save_word(s, "model", se3di_tyre_laws[def.law]);
    se3di_save_number(s, "radius", def.radius);
    se3di_save_number(s, "k", def.k);
    se3di_save_number_but(s, "c", def.c, 0.0);
    se3di_save_number(s, "mu", def.mu);
    if (def.coefficients) {
        save_coefficients(s, force);
    } else {
        se3di_save_number_but(s, "mu_min", def.mu_min, 0.0);
        se3di_save_number(s, "slip_stiffness", def.slip_stiffness);
        se3di_save_number(s, "cornering_stiffness", def.cornering_stiffness);
        se3di_save_number_but(s, "patch_length", def.patch_length, 0.0);
        se3di_save_number_but(s, "rolling_resistance", def.rolling_resistance, 0.0);
    }
    se3di_save_number_but(s, "rolling_radius", def.rolling_radius, 0.0);
    se3di_save_number(s, "low_speed", def.low_speed);
    se3di_save_word(s, "transient", def.is_transient ? "true" : "false");
    if (def.coefficients) {
        se3di_save_word(s, "turn_slip", def.has_turn_slip ? "true" : "false");
    }
    se3di_save_number_but(s, "relaxation_x", def.relaxation_x, 0.0);
    se3di_save_number_but(s, "relaxation_y", def.relaxation_y, 0.0);
}

static void save_force(se3di_save *s, se3d_force force, const char *type)
{
    static const struct {
        const char *type;
        void (*save)(se3di_save *s, se3d_force force);
    } kinds[] = {{"tsda", save_tsda},         {"rsda", save_rsda}, {"bushing", save_bushing},
                 {"friction", save_friction}, {"stop", save_stop}, {"effort", save_effort},
                 {"armature", save_armature}, {"tyre", save_tyre}};
    const char *name = s->forces.names[force.index1];
    se3di_save_text(s, "name", name);
    se3di_save_text(s, "type", type);
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
        if (strcmp(kinds[k].type, type) == 0) {
            kinds[k].save(s, force);
            return;
        }
    }
    if (strcmp(type, "callback") == 0) {
        se3di_save_refuse(s, "force %.100s is a callback, which a file cannot hold", name);
    } else {
        save_load(s, force, type);
    }
}

void se3di_save_forces(se3di_save *s)
{
    se3di_save_begin_section(s, "forces");
    for (size_t k = 0; k < se3d_system_count_forces(s->system); ++k) {
        se3d_force force;
        const char *type = "";
        (void)se3d_system_get_force(s->system, k, &force);
        (void)se3d_force_get_type(s->system, force, &type);
        const se3di_save_entry entry = se3di_save_open(s);
        save_force(s, force, type);
        se3di_save_name_problem(s, type, s->forces.names[force.index1]);
        if (!se3di_save_close(s, &entry)) {
            s->forces.names[force.index1] = NULL;
        }
    }
}

/* ---- states ---------------------------------------------------------------------------------*/

void se3di_save_states(se3di_save *s)
{
    se3di_save_begin_section(s, "states");
    for (size_t k = 0; k < se3d_system_count_states(s->system); ++k) {
        se3d_state state;
        se3d_state_def def = se3d_state_def_default();
        const double size = def.size;
        (void)se3d_system_get_state(s->system, k, &state);
        if (se3d_state_get_def(s->system, state, &def) < 0) {
            continue; /* the slip of a tyre */
        }
        const se3di_save_entry entry = se3di_save_open(s);
        se3di_save_text(s, "name", s->forces.names[state.index1]);
        se3di_save_text(s, "type", "ode");
        se3di_save_word(s, "rate", "");
        se3di_save_put_function(s, def.rate, 0.0, NULL);
        se3di_save_function(s, "output", def.output, NULL);
        se3di_save_function(s, "input", def.input, NULL);
        se3di_save_number_but(s, "initial", def.initial, 0.0);
        se3di_save_number_but(s, "size", def.size, size);
        se3di_save_name_problem(s, "state", s->forces.names[state.index1]);
        if (!se3di_save_close(s, &entry)) {
            s->forces.names[state.index1] = NULL;
        }
    }
}

/* ---- wheels ---------------------------------------------------------------------------------*/

static void save_wheel(se3di_save *s, se3d_wheel wheel, size_t number)
{
    se3d_wheel_def def = se3d_wheel_def_default();
    (void)se3d_wheel_get_def(s->system, wheel, &def);
    se3di_save_text(s, "name", s->wheels.names[wheel.index1]);
    se3di_save_body(s, "body", def.body);
    se3di_save_body(s, "chassis", def.chassis);
    se3di_save_vector(s, "point", def.center, 3);
    se3di_save_word(s, "frame", "body");
    se3di_save_vector(s, "axis", def.axis, 3);
    se3di_save_vector(s, "forward", def.forward, 3);
    se3di_save_vector(s, "up", def.up, 3);
    se3di_save_number(s, "radius", def.radius);
    se3di_save_number_but(s, "width", def.width, 0.0);
    if (memcmp(def.steer_lower, def.steer_upper, sizeof def.steer_lower) != 0) {
        se3di_save_vector(s, "lower", def.steer_lower, 3);
        se3di_save_vector(s, "upper", def.steer_upper, 3);
    }
    if (def.travel.index1 != 0) {
        se3di_save_constraint(s, "travel", def.travel);
    }
    if (def.steering.index1 != 0) {
        se3di_save_constraint(s, "steering", def.steering);
    }
    if (def.spring.index1 != 0) {
        se3di_save_text(s, "spring", s->forces.names[def.spring.index1]);
    }
    for (size_t k = 0; k < number && def.opposite.index1 != 0; ++k) {
        se3d_wheel before;
        (void)se3d_system_get_wheel(s->system, k, &before);
        if (before.index1 == def.opposite.index1) {
            se3di_save_text(s, "opposite", s->wheels.names[before.index1]);
        }
    }
    se3di_save_number_but(s, "wheelbase", def.wheelbase, 0.0);
    se3di_save_number_but(s, "cg_height", def.cg_height, 0.0);
    se3di_save_number_but(s, "brake_share", def.brake_share, 0.0);
    se3di_save_number_but(s, "drive_share", def.drive_share, 0.0);
}

void se3di_save_wheels(se3di_save *s)
{
    se3di_save_begin_section(s, "wheels");
    for (size_t k = 0; k < se3d_system_count_wheels(s->system); ++k) {
        se3d_wheel wheel;
        (void)se3d_system_get_wheel(s->system, k, &wheel);
        const se3di_save_entry entry = se3di_save_open(s);
        save_wheel(s, wheel, k);
        se3di_save_name_problem(s, "wheel", s->wheels.names[wheel.index1]);
        if (!se3di_save_close(s, &entry)) {
            s->wheels.names[wheel.index1] = NULL;
        }
    }
}
