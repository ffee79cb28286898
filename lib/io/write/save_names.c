/* SPDX-License-Identifier: BSD-3-Clause */
/* Names of elements in a model file, and what entries say by them: bodies, coordinates, functions
 * and the channels that these depend on. */
#include <stdio.h>
#include <string.h>

#include "base/shortest.h"
#include "io/model/model.h"
#include "io/write/save.h"

static bool fail(se3di_save *s, se3d_status status)
{
    s->status = status;
    return false;
}

/* Names without a name: the first one that is free. */
static const char *make_name(se3di_save *s, const se3di_ionames *taken, const char *what)
{
    char made[48];
    size_t k = 1;
    do {
        snprintf(made, sizeof made, "%s%zu", what, k++);
    } while (se3di_ionames_find(taken, made, NULL));
    return se3di_iopool_copy(&s->pool, made, strlen(made));
}

/* What a name in a file may be: as the reader says. */
static bool is_good(const char *name)
{
    const size_t length = strlen(name);
    return length > 0 && length <= 100 && name[0] != ' ' && name[length - 1] != ' ' &&
           !name[strcspn(name, ".,;\"'`[]{}")];
}

/* Names that elements of one kind have; the others get one. */
typedef struct namer {
    se3di_save *s;
    se3di_ionames *taken;
    const char *what;
    se3di_save_names *out;
} namer;

static bool give_name(const namer *n, uint32_t index1, const char *own, size_t number)
{
    se3di_save_names *out = n->out;
    if (index1 >= out->count) {
        const uint32_t count = 2 * index1 + 16;
        const char **grown = se3di_iopool_array(&n->s->pool, count, sizeof *grown);
        if (!grown) {
            return fail(n->s, SE3D_ERR_NO_MEMORY);
        }
        if (out->count > 0) {
            memcpy(grown, out->names, out->count * sizeof *grown);
        }
        out->names = grown;
        out->count = count;
    }
    if (own[0] && (!is_good(own) || se3di_ionames_find(n->taken, own, NULL))) {
        snprintf(n->s->problem, sizeof n->s->problem,
                 is_good(own) ? "%.100s is the name of two elements, a file needs different ones"
                              : "the name %.100s is not allowed in a file",
                 own);
        return fail(n->s, SE3D_ERR_UNSUPPORTED);
    }
    const char *name = own[0] ? own : make_name(n->s, n->taken, n->what);
    if (!name || !se3di_ionames_add(n->taken, &n->s->pool, name, number)) {
        return fail(n->s, SE3D_ERR_NO_MEMORY);
    }
    out->names[index1] = name;
    return true;
}

static bool name_bodies(se3di_save *s)
{
    se3di_ionames taken = {.capacity = 0};
    const namer n = {s, &taken, "body", &s->bodies};
    for (int unnamed = 0; unnamed < 2; ++unnamed) {
        for (size_t k = 0; k < se3d_system_count_bodies(s->system); ++k) {
            se3d_body body;
            const char *own = "";
            (void)se3d_system_get_body(s->system, k, &body);
            (void)se3d_body_get_name(s->system, body, &own);
            if ((own[0] == '\0') == (unnamed == 1) && !give_name(&n, body.index1, own, k)) {
                return false;
            }
        }
    }
    return true;
}

/* What a driver, joint, primitive without a name is called. */
static const char *kind_of(const char *type)
{
    return strcmp(type, "driver") == 0 ? "driver"
           : strcmp(type, "d") == 0 || strcmp(type, "cd") == 0 || strncmp(type, "dp", 2) == 0 ||
                   strncmp(type, "perpendicular", 13) == 0 || strcmp(type, "user") == 0
               ? "constraint"
               : "joint";
}

static bool name_constraints(se3di_save *s, se3di_ionames *taken, bool unnamed)
{
    for (size_t k = 0; k < se3d_system_count_constraints(s->system); ++k) {
        se3d_constraint constraint;
        const char *own = "", *type = "";
        (void)se3d_system_get_constraint(s->system, k, &constraint);
        (void)se3d_constraint_get_name(s->system, constraint, &own);
        (void)se3d_constraint_get_type(s->system, constraint, &type);
        const namer n = {s, taken, kind_of(type), &s->constraints};
        if ((own[0] == '\0') == unnamed && !give_name(&n, constraint.index1, own, k)) {
            return false;
        }
    }
    return true;
}

static bool name_forces(se3di_save *s, se3di_ionames *taken, bool unnamed)
{
    const namer n = {s, taken, "force", &s->forces};
    const namer of_states = {s, taken, "state", &s->forces};
    const namer of_roads = {s, taken, "road", &s->roads};
    const namer of_wheels = {s, taken, "wheel", &s->wheels};
    const char *own = "";
    for (size_t k = 0; k < se3d_system_count_forces(s->system); ++k) {
        se3d_force force;
        (void)se3d_system_get_force(s->system, k, &force);
        (void)se3d_force_get_name(s->system, force, &own);
        if ((own[0] == '\0') == unnamed && !give_name(&n, force.index1, own, k)) {
            return false;
        }
    }
    for (size_t k = 0; k < se3d_system_count_states(s->system); ++k) {
        se3d_state state;
        se3d_state_def def = se3d_state_def_default();
        (void)se3d_system_get_state(s->system, k, &state);
        if (se3d_state_get_def(s->system, state, &def) < 0) {
            continue; /* the slip of a tyre */
        }
        (void)se3d_state_get_name(s->system, state, &own);
        if ((own[0] == '\0') == unnamed && !give_name(&of_states, state.index1, own, k)) {
            return false;
        }
    }
    for (size_t k = 0; k < se3d_system_count_roads(s->system); ++k) {
        se3d_road road;
        (void)se3d_system_get_road(s->system, k, &road);
        (void)se3d_road_get_name(s->system, road, &own);
        if ((own[0] == '\0') == unnamed && !give_name(&of_roads, road.index1, own, k)) {
            return false;
        }
    }
    for (size_t k = 0; k < se3d_system_count_wheels(s->system); ++k) {
        se3d_wheel wheel;
        (void)se3d_system_get_wheel(s->system, k, &wheel);
        (void)se3d_wheel_get_name(s->system, wheel, &own);
        if ((own[0] == '\0') == unnamed && !give_name(&of_wheels, wheel.index1, own, k)) {
            return false;
        }
    }
    return true;
}

static bool name_materials(se3di_save *s)
{
    se3di_ionames taken = {.capacity = 0};
    const namer n = {s, &taken, "material", &s->materials};
    for (int unnamed = 0; unnamed < 2; ++unnamed) {
        for (size_t k = 0; k < se3d_system_count_materials(s->system); ++k) {
            se3d_material material;
            const char *own = "";
            (void)se3d_system_get_material(s->system, k, &material);
            (void)se3d_material_get_name(s->system, material, &own);
            if ((own[0] == '\0') == (unnamed == 1) && !give_name(&n, material.index1, own, k)) {
                return false;
            }
        }
    }
    return true;
}

bool se3di_save_name_all(se3di_save *s)
{
    se3di_ionames taken = {.capacity = 0};
    return name_bodies(s) && name_constraints(s, &taken, false) && name_forces(s, &taken, false) &&
           name_constraints(s, &taken, true) && name_forces(s, &taken, true) && name_materials(s);
}

/* ---- what entries refer to ------------------------------------------------------------------*/

static const char *find(se3di_save *s, const se3di_save_names *names, uint32_t index1)
{
    const char *name = index1 < names->count ? names->names[index1] : NULL;
    if (!name) {
        se3di_save_refuse(s, "it depends on an element that is not in the file");
    }
    return name ? name : "";
}

void se3di_save_body(se3di_save *s, const char *key, se3d_body body)
{
    se3di_save_text(s, key, find(s, &s->bodies, body.index1));
}

void se3di_save_constraint(se3di_save *s, const char *key, se3d_constraint constraint)
{
    se3di_save_text(s, key, find(s, &s->constraints, constraint.index1));
}

void se3di_save_coordinate(se3di_save *s, se3d_constraint joint, int32_t coordinate)
{
    se3di_save_constraint(s, "joint", joint);
    if (se3di_joint_has(s->system, joint, SE3D_JOINT_COORDINATE_ANGLE) &&
        se3di_joint_has(s->system, joint, SE3D_JOINT_COORDINATE_DISPLACEMENT)) {
        se3di_save_word(s, "coordinate",
                        coordinate == SE3D_JOINT_COORDINATE_ANGLE ? "angle" : "displacement");
    }
}

/* ---- channels -------------------------------------------------------------------------------*/

static const char *join(se3di_save *s, const char *name, const char *what, const char *part)
{
    char text[300];
    if (!name) {
        return NULL; /* no memory */
    }
    snprintf(text, sizeof text, "%.120s.%.120s%s%s", name, what, part[0] ? "." : "", part);
    return se3di_iopool_copy(&s->pool, text, strlen(text));
}

/* As it stands in an expression: names that have other characters than those of names of
 * expressions stand in quotes. */
static const char *quote_channel(se3di_save *s, const char *channel)
{
    static const char simple[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789.";
    char text[310];
    if (!channel ||
        (strspn(channel, simple) == strlen(channel) && !(channel[0] >= '0' && channel[0] <= '9'))) {
        return channel;
    }
    snprintf(text, sizeof text, "'%s'", channel);
    return se3di_iopool_copy(&s->pool, text, strlen(text));
}

static const char *joint_channel(se3di_save *s, const se3d_signal *signal)
{
    const char *name = find(s, &s->constraints, signal->joint.index1);
    const bool angle = signal->component == SE3D_JOINT_COORDINATE_ANGLE;
    if (signal->kind == SE3D_SIGNAL_JOINT_COORDINATE) {
        return join(s, name, angle ? "angle" : "displacement", "");
    }
    const bool both = se3di_joint_has(s->system, signal->joint, SE3D_JOINT_COORDINATE_ANGLE);
    return join(s, name, !angle && both ? "displacement_rate" : "rate", "");
}

static const char *force_channel(se3di_save *s, const se3d_signal *signal)
{
    const char *name = find(s, &s->forces, signal->force.index1);
    const char *type = "";
    (void)se3d_force_get_type(s->system, signal->force, &type);
    if (signal->kind == SE3D_SIGNAL_FORCE_RATE) {
        return join(s, name, "rate", "");
    }
    return join(s, name,
                strcmp(type, "tsda") == 0   ? "length"
                : strcmp(type, "rsda") == 0 ? "angle"
                                            : "coordinate",
                "");
}

/* A marker of the body at the point; null: there is none. */
static se3d_marker find_marker(const se3di_save *s, const se3d_signal *signal)
{
    for (size_t k = 0; k < se3d_system_count_markers(s->system); ++k) {
        se3d_marker marker;
        se3d_marker_def def = se3d_marker_def_default();
        (void)se3d_system_get_marker(s->system, k, &marker);
        (void)se3d_marker_get_def(s->system, marker, &def);
        if (def.body.index1 == signal->body.index1 && def.name &&
            memcmp(def.position, signal->point, sizeof def.position) == 0) {
            return marker;
        }
    }
    return (se3d_marker){0, 0};
}

static const char *body_channel(se3di_save *s, const se3d_signal *signal)
{
    static const char *const axes[] = {"x", "y", "z"};
    static const char *const parameters[] = {"e0", "e1", "e2", "e3"};
    const char *name = find(s, &s->bodies, signal->body.index1);
    const size_t k = (size_t)signal->component;
    if (signal->kind == SE3D_SIGNAL_ORIENTATION) {
        return join(s, name, "orientation", parameters[k]);
    }
    if (signal->kind == SE3D_SIGNAL_ANGULAR_VELOCITY) {
        return join(s, name, "angular_velocity", axes[k]);
    }
    const char *what = signal->kind == SE3D_SIGNAL_POINT_POSITION ? "position" : "velocity";
    if (se3di_save_is_zero(signal->point, 3)) {
        return join(s, name, what, axes[k]);
    }
    const se3d_marker marker = find_marker(s, signal);
    const char *own = "";
    if (SE3D_FAILED(se3d_marker_get_name(s->system, marker, &own))) {
        se3di_save_refuse(s, "it depends on a point of body %.100s where no marker is", name);
        return name;
    }
    return join(s, join(s, name, own, ""), what, axes[k]);
}

const char *se3di_save_channel(se3di_save *s, const se3d_signal *signal)
{
    switch (signal->kind) {
    case SE3D_SIGNAL_JOINT_COORDINATE:
    case SE3D_SIGNAL_JOINT_RATE:
        return joint_channel(s, signal);
    case SE3D_SIGNAL_FORCE_COORDINATE:
    case SE3D_SIGNAL_FORCE_RATE:
        return force_channel(s, signal);
    case SE3D_SIGNAL_STATE: {
        static const char *const parts[] = {[SE3D_STATE_VALUE] = "state",
                                            [SE3D_STATE_OUTPUT] = "value",
                                            [SE3D_STATE_INPUT] = "input"};
        return join(s, find(s, &s->forces, signal->state.index1), parts[signal->component], "");
    }
    default:
        return body_channel(s, signal);
    }
}

/* ---- functions ------------------------------------------------------------------------------*/

static void put_number(se3di_save *s, double value)
{
    char text[SE3DI_SHORTEST_SIZE];
    (void)se3di_shortest_format(value, text);
    se3di_save_put(s, text);
}

static void put_table(se3di_save *s, const se3d_function_def *def)
{
    static const char *const kinds[] = {[SE3D_TABLE_CUBIC] = "spline",
                                        [SE3D_TABLE_LINEAR] = "linear",
                                        [SE3D_TABLE_AKIMA] = "akima"};
    se3di_save_put(s, "{");
    se3di_save_put(s, kinds[def->table_kind]);
    se3di_save_put(s, ": [");
    for (size_t k = 0; k < def->table_count; ++k) {
        if (k > 0) {
            se3di_save_put(s, s->out.column > 90 ? ",\n" : ", ");
            se3di_save_put(s, s->out.column == 0 ? s->indent : "");
        }
        se3di_save_put(s, "[");
        put_number(s, def->table_x[k]);
        se3di_save_put(s, ", ");
        put_number(s, def->table_y[k]);
        se3di_save_put(s, "]");
    }
    se3di_save_put(s, def->table_periodic ? "], periodic: true}" : "]}");
}

/* The names of its variables: `own`, then channels. */
static bool list_variables(se3di_save *s, se3d_function function, const se3d_function_def *def,
                           const char *const *own, const char **names)
{
    static const char *const time_only[] = {"t", NULL};
    size_t count = 0;
    for (own = own ? own : time_only; own[count]; ++count) {
        if (count < SE3D_FUNCTION_VARIABLES_MAX) {
            names[count] = own[count];
        }
    }
    if (count + def->signal_count != def->variable_count) {
        se3di_save_refuse(s, "a function has %zu variables, a file gives it %zu",
                          def->variable_count, count + def->signal_count);
        return false;
    }
    for (size_t k = 0; k < def->signal_count; ++k) {
        se3d_signal signal;
        (void)se3d_function_get_signal(s->system, function, k, &signal);
        names[count + k] = quote_channel(s, se3di_save_channel(s, &signal));
        s->status = names[count + k] ? s->status : SE3D_ERR_NO_MEMORY;
    }
    return s->problem[0] == '\0' && s->status >= 0;
}

static void put_expression(se3di_save *s, se3d_function function, const se3d_function_def *def,
                           const char *const *own)
{
    const char *names[SE3D_FUNCTION_VARIABLES_MAX] = {NULL};
    size_t length = 0;
    if (!list_variables(s, function, def, own, names)) {
        return;
    }
    char *text = NULL;
    se3d_status status = se3d_expression_write(def->compiled, names, NULL, 0, &length);
    if (status >= 0) {
        text = se3di_iopool_alloc(&s->pool, length + 1);
        status = text ? se3d_expression_write(def->compiled, names, text, length + 1, &length)
                      : SE3D_ERR_NO_MEMORY;
    }
    if (status < 0) {
        s->status = status;
    } else if (length > SE3D_EXPRESSION_TEXT_MAX) {
        se3di_save_refuse(s, "an expression would have %zu characters, at most %d are allowed",
                          length, SE3D_EXPRESSION_TEXT_MAX);
    } else {
        se3di_save_put_text(s, text);
    }
}

void se3di_save_put_function(se3di_save *s, se3d_function function, double value,
                             const char *const *own)
{
    se3d_function_def def = se3d_function_def_default();
    if (function.index1 == 0) {
        put_number(s, value);
        return;
    }
    (void)se3d_function_get_def(s->system, function, &def);
    if (def.callback) {
        se3di_save_refuse(s, "its function is a callback");
    } else if (def.compiled) {
        put_expression(s, function, &def, own);
    } else if (def.table_x) {
        put_table(s, &def);
    } else {
        put_number(s, def.constant);
    }
}

void se3di_save_function(se3di_save *s, const char *key, se3d_function function,
                         const char *const *own)
{
    if (function.index1 != 0) {
        se3di_save_word(s, key, "");
        se3di_save_put_function(s, function, 0.0, own);
    }
}
