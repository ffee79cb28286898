/* SPDX-License-Identifier: BSD-3-Clause */
/* Channels: names to quantities, columns and numbers. */
#include "io/channel/channel.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/channel/relative.h"
#include "io/document/document.h"
#include "io/document/guess.h"
#include "io/document/keys.h"
#include "io/model/model.h"
#include "io/model/tagged.h"

typedef struct quantity_name {
    const char *name;
    se3di_quantity quantity;
} quantity_name;

static const quantity_name body_names[] = {
    {"position", SE3DI_BODY_POSITION},
    {"orientation", SE3DI_BODY_ORIENTATION},
    {"velocity", SE3DI_BODY_VELOCITY},
    {"angular_velocity", SE3DI_BODY_ANGULAR_VELOCITY},
    {"acceleration", SE3DI_BODY_ACCELERATION},
    {"angular_acceleration", SE3DI_BODY_ANGULAR_ACCELERATION},
    {"contact_force", SE3DI_BODY_CONTACT_FORCE},
    {NULL, SE3DI_STEPS}};
static const quantity_name marker_names[] = {{"position", SE3DI_MARKER_POSITION},
                                             {"velocity", SE3DI_MARKER_VELOCITY},
                                             {"acceleration", SE3DI_MARKER_ACCELERATION},
                                             {NULL, SE3DI_STEPS}};
/* What one may ask for besides. */
static const quantity_name marker_asked_names[] = {
    {"orientation", SE3DI_MARKER_ORIENTATION},
    {"angular_velocity", SE3DI_MARKER_ANGULAR_VELOCITY},
    {"angular_acceleration", SE3DI_MARKER_ANGULAR_ACCELERATION},
    {NULL, SE3DI_STEPS}};
static const quantity_name reaction_names[] = {
    {"force", SE3DI_REACTION_FORCE}, {"torque", SE3DI_REACTION_TORQUE}, {NULL, SE3DI_STEPS}};
static const quantity_name driver_names[] = {
    {"value", SE3DI_DRIVER_VALUE}, {"effort", SE3DI_DRIVER_EFFORT}, {NULL, SE3DI_STEPS}};
static const quantity_name tsda_names[] = {{"length", SE3DI_FORCE_COORDINATE},
                                           {"rate", SE3DI_FORCE_RATE},
                                           {"force", SE3DI_FORCE_VALUE},
                                           {NULL, SE3DI_STEPS}};
static const quantity_name rsda_names[] = {{"angle", SE3DI_FORCE_COORDINATE},
                                           {"rate", SE3DI_FORCE_RATE},
                                           {"torque", SE3DI_FORCE_VALUE},
                                           {NULL, SE3DI_STEPS}};
static const quantity_name range_names[] = {{"coordinate", SE3DI_FORCE_COORDINATE},
                                            {"rate", SE3DI_FORCE_RATE},
                                            {"force", SE3DI_FORCE_VALUE},
                                            {NULL, SE3DI_STEPS}};
static const quantity_name effort_names[] = {{"coordinate", SE3DI_FORCE_COORDINATE},
                                             {"rate", SE3DI_FORCE_RATE},
                                             {"effort", SE3DI_FORCE_VALUE},
                                             {NULL, SE3DI_STEPS}};
static const quantity_name armature_names[] = {{"coordinate", SE3DI_ARMATURE_COORDINATE},
                                               {"rate", SE3DI_ARMATURE_RATE},
                                               {"effort", SE3DI_ARMATURE_EFFORT},
                                               {NULL, SE3DI_STEPS}};
static const quantity_name wrench_names[] = {
    {"force", SE3DI_WRENCH_FORCE}, {"torque", SE3DI_WRENCH_TORQUE}, {NULL, SE3DI_STEPS}};
static const quantity_name tyre_names[] = {{"fx", SE3DI_TYRE_FX},
                                           {"fy", SE3DI_TYRE_FY},
                                           {"fz", SE3DI_TYRE_FZ},
                                           {"mx", SE3DI_TYRE_MX},
                                           {"my", SE3DI_TYRE_MY},
                                           {"mz", SE3DI_TYRE_MZ},
                                           {"slip_ratio", SE3DI_TYRE_SLIP_RATIO},
                                           {"slip_angle", SE3DI_TYRE_SLIP_ANGLE},
                                           {"inclination", SE3DI_TYRE_INCLINATION},
                                           {"deflection", SE3DI_TYRE_DEFLECTION},
                                           {"loaded_radius", SE3DI_TYRE_LOADED_RADIUS},
                                           {"rolling_radius", SE3DI_TYRE_ROLLING_RADIUS},
                                           {"speed", SE3DI_TYRE_SPEED},
                                           {"contact", SE3DI_TYRE_CONTACT},
                                           {"lagged_ratio", SE3DI_TYRE_LAGGED_RATIO},
                                           {"lagged_angle", SE3DI_TYRE_LAGGED_ANGLE},
                                           {"turn_slip", SE3DI_TYRE_TURN_SLIP},
                                           {NULL, SE3DI_STEPS}};
static const quantity_name wheel_names[] = {
    {"camber", SE3DI_WHEEL_CAMBER},
    {"inclination", SE3DI_WHEEL_INCLINATION},
    {"steer", SE3DI_WHEEL_STEER},
    {"toe", SE3DI_WHEEL_TOE},
    {"travel", SE3DI_WHEEL_TRAVEL},
    {"wheelbase_change", SE3DI_WHEELBASE_CHANGE},
    {"track_change", SE3DI_WHEEL_TRACK_CHANGE},
    {"ackermann_error", SE3DI_WHEEL_ACKERMANN_ERROR},
    {"contact", SE3DI_WHEEL_CONTACT},
    {"caster", SE3DI_WHEEL_CASTER},
    {"kingpin_inclination", SE3DI_WHEEL_KINGPIN_INCLINATION},
    {"scrub_radius", SE3DI_WHEEL_SCRUB_RADIUS},
    {"mechanical_trail", SE3DI_WHEEL_MECHANICAL_TRAIL},
    {"camber_gradient", SE3DI_WHEEL_CAMBER_GRADIENT},
    {"toe_gradient", SE3DI_WHEEL_TOE_GRADIENT},
    {"track_gradient", SE3DI_WHEEL_TRACK_GRADIENT},
    {"wheelbase_gradient", SE3DI_WHEELBASE_GRADIENT},
    {"front_swing_arm", SE3DI_WHEEL_FRONT_SWING_ARM},
    {"front_center_height", SE3DI_WHEEL_FRONT_CENTER_HEIGHT},
    {"side_swing_arm", SE3DI_WHEEL_SIDE_SWING_ARM},
    {"side_center_height", SE3DI_WHEEL_SIDE_CENTER_HEIGHT},
    {"roll_center_height", SE3DI_WHEEL_ROLL_CENTER_HEIGHT},
    {"anti_dive", SE3DI_WHEEL_ANTI_DIVE},
    {"anti_lift", SE3DI_WHEEL_ANTI_LIFT},
    {"anti_squat", SE3DI_WHEEL_ANTI_SQUAT},
    {"motion_ratio", SE3DI_WHEEL_MOTION_RATIO},
    {"wheel_load", SE3DI_WHEEL_LOAD},
    {"wheel_rate", SE3DI_WHEEL_RATE},
    {"roll_rate", SE3DI_WHEEL_ROLL_RATE},
    {NULL, SE3DI_STEPS}};
static const quantity_name state_names[] = {
    {"value", SE3DI_STATE_VALUE}, {"state", SE3DI_STATE_ITSELF}, {NULL, SE3DI_STEPS}};
static const quantity_name input_names[] = {{"input", SE3DI_STATE_INPUT}, {NULL, SE3DI_STEPS}};
static const quantity_name rate_names[] = {{"rate", SE3DI_STATE_RATE}, {NULL, SE3DI_STEPS}};
static const struct {
    const char *type;
    const quantity_name *names;
} force_names[] = {{"tsda", tsda_names},        {"rsda", rsda_names},     {"friction", range_names},
                   {"stop", range_names},       {"effort", effort_names}, {"bushing", wrench_names},
                   {"force", wrench_names},     {"torque", wrench_names}, {"tyre", tyre_names},
                   {"armature", armature_names}};
static const quantity_name system_names[] = {
    {"energy.kinetic", SE3DI_ENERGY_KINETIC},
    {"energy.potential", SE3DI_ENERGY_POTENTIAL},
    {"energy.total", SE3DI_ENERGY_TOTAL},
    {"energy.dissipated", SE3DI_ENERGY_DISSIPATED},
    {"energy.balance", SE3DI_ENERGY_BALANCE},
    {"work.actuators", SE3DI_WORK_ACTUATORS},
    {"work.drivers", SE3DI_WORK_DRIVERS},
    {"violation.position", SE3DI_VIOLATION_POSITION},
    {"violation.velocity", SE3DI_VIOLATION_VELOCITY},
    {"violation.acceleration", SE3DI_VIOLATION_ACCELERATION},
    {"steps", SE3DI_STEPS},
    {"iterations", SE3DI_ITERATIONS},
    {NULL, SE3DI_STEPS}};

static const quantity_name contact_names[] = {{"contacts.count", SE3DI_CONTACTS_COUNT},
                                              {"contacts.force_max", SE3DI_CONTACTS_FORCE_MAX},
                                              {NULL, SE3DI_STEPS}};
static const quantity_name particle_names[] = {{"particles.count", SE3DI_PARTICLES_COUNT},
                                               {"particles.lost", SE3DI_PARTICLES_LOST},
                                               {"particles.energy", SE3DI_PARTICLES_ENERGY},
                                               {"particles.kinetic", SE3DI_PARTICLES_KINETIC},
                                               {"particles.rotation", SE3DI_PARTICLES_ROTATION},
                                               {"particles.left", SE3DI_PARTICLES_LEFT},
                                               {NULL, SE3DI_STEPS}};

static const quantity_name cell_names[] = {{"cell.length", SE3DI_CELL_LENGTH},
                                           {"cell.offset", SE3DI_CELL_OFFSET},
                                           {"cell.strain", SE3DI_CELL_STRAIN},
                                           {"cell.shear_strain", SE3DI_CELL_SHEAR_STRAIN},
                                           {"cell.rate", SE3DI_CELL_RATE},
                                           {"cell.shear_rate", SE3DI_CELL_SHEAR_RATE},
                                           {"cell.stress", SE3DI_CELL_STRESS},
                                           {"cell.shear", SE3DI_CELL_SHEAR},
                                           {"cell.volume", SE3DI_CELL_VOLUME},
                                           {"cell.solid_fraction", SE3DI_CELL_SOLID_FRACTION},
                                           {"cell.kinetic", SE3DI_CELL_KINETIC},
                                           {"cell.work", SE3DI_CELL_WORK},
                                           {NULL, SE3DI_STEPS}};

static const quantity_name audit_names[] = {
    {"dissipation.normal", SE3DI_DISSIPATION_NORMAL},
    {"dissipation.tangential", SE3DI_DISSIPATION_TANGENTIAL},
    {"dissipation.rolling", SE3DI_DISSIPATION_ROLLING},
    {"dissipation.torsion", SE3DI_DISSIPATION_TORSION},
    {"dissipation.bonds", SE3DI_DISSIPATION_BONDS},
    {"dissipation.total", SE3DI_DISSIPATION_TOTAL},
    {"dissipation.elastic", SE3DI_DISSIPATION_ELASTIC},
    {"dissipation.wall_work", SE3DI_DISSIPATION_WALL_WORK},
    {NULL, SE3DI_STEPS}};

static const quantity_name set_names[] = {{"count", SE3DI_SET_COUNT},
                                          {"lost", SE3DI_SET_LOST},
                                          {"left", SE3DI_SET_LEFT},
                                          {"mass", SE3DI_SET_MASS},
                                          {"energy", SE3DI_SET_ENERGY},
                                          {"kinetic", SE3DI_SET_KINETIC},
                                          {"rotation", SE3DI_SET_ROTATION},
                                          {"inserted", SE3DI_SET_INSERTED},
                                          {"deferred", SE3DI_SET_DEFERRED},
                                          {"waiting", SE3DI_SET_WAITING},
                                          {NULL, SE3DI_STEPS}};
static const quantity_name sink_names[] = {{"count", SE3DI_SINK_COUNT}, {NULL, SE3DI_STEPS}};

static const quantity_name region_names[] = {{"count", SE3DI_REGION_COUNT},
                                             {"mass", SE3DI_REGION_MASS},
                                             {"solid_fraction", SE3DI_REGION_SOLID_FRACTION},
                                             {"coordination", SE3DI_REGION_COORDINATION},
                                             {"temperature", SE3DI_REGION_TEMPERATURE},
                                             {"velocity", SE3DI_REGION_VELOCITY},
                                             {"mass_flux", SE3DI_REGION_MASS_FLUX},
                                             {"stress", SE3DI_REGION_STRESS},
                                             {"shear", SE3DI_REGION_SHEAR},
                                             {NULL, SE3DI_STEPS}};

static const quantity_name bond_names[] = {{"count", SE3DI_BOND_COUNT},
                                           {"broken", SE3DI_BOND_BROKEN},
                                           {"torn", SE3DI_BOND_TORN},
                                           {"sheared", SE3DI_BOND_SHEARED},
                                           {"lost", SE3DI_BOND_LOST},
                                           {"energy", SE3DI_BOND_ENERGY},
                                           {"dissipated", SE3DI_BOND_DISSIPATED},
                                           {"released", SE3DI_BOND_RELEASED},
                                           {"tension", SE3DI_BOND_TENSION},
                                           {"shear", SE3DI_BOND_SHEAR},
                                           {NULL, SE3DI_STEPS}};

static const quantity_name flow_names[] = {{"count", SE3DI_FLOW_COUNT},
                                           {"forward", SE3DI_FLOW_FORWARD},
                                           {"backward", SE3DI_FLOW_BACKWARD},
                                           {"mass", SE3DI_FLOW_MASS},
                                           {"momentum", SE3DI_FLOW_MOMENTUM},
                                           {"count_rate", SE3DI_FLOW_COUNT_RATE},
                                           {"mass_rate", SE3DI_FLOW_MASS_RATE},
                                           {"momentum_rate", SE3DI_FLOW_MOMENTUM_RATE},
                                           {NULL, SE3DI_STEPS}};

static const quantity_name servo_names[] = {
    {"position", SE3DI_SERVO_POSITION}, {"speed", SE3DI_SERVO_SPEED}, {"force", SE3DI_SERVO_FORCE},
    {"wanted", SE3DI_SERVO_WANTED},     {"work", SE3DI_SERVO_WORK},   {NULL, SE3DI_STEPS}};

enum { QUANTITIES_MAX = 32 };

/* What one thing offers: at most QUANTITIES_MAX names. */
typedef struct offer {
    quantity_name list[QUANTITIES_MAX];
    size_t count;
} offer;

static void offer_names(offer *o, const quantity_name *names)
{
    for (; names->name && o->count < QUANTITIES_MAX; ++names) {
        o->list[o->count++] = *names;
    }
}

static void offer_one(offer *o, const char *name, se3di_quantity quantity)
{
    const quantity_name names[] = {{name, quantity}, {NULL, SE3DI_STEPS}};
    offer_names(o, names);
}

/* Coordinates of a joint; `rate` is that of the angle if it has both. */
static void offer_coordinates(offer *o, const se3d_system *system, se3d_constraint joint)
{
    const bool angle = se3di_joint_has(system, joint, SE3D_JOINT_COORDINATE_ANGLE);
    const bool displacement = se3di_joint_has(system, joint, SE3D_JOINT_COORDINATE_DISPLACEMENT);
    if (angle) {
        offer_one(o, "angle", SE3DI_JOINT_ANGLE);
    }
    if (displacement) {
        offer_one(o, "displacement", SE3DI_JOINT_DISPLACEMENT);
    }
    if (angle || displacement) {
        offer_one(o, "rate", angle ? SE3DI_JOINT_ANGLE_RATE : SE3DI_JOINT_DISPLACEMENT_RATE);
    }
    if (angle && displacement) {
        offer_one(o, "displacement_rate", SE3DI_JOINT_DISPLACEMENT_RATE);
    }
}

static void offer_element(offer *o, const se3d_model *model, const se3di_element_entry *entry)
{
    const se3di_node *type = se3di_node_get(entry->node, "type");
    const char *text = type ? type->text : "";
    size_t equations = 0;
    o->count = 0;
    switch (entry->kind) {
    case SE3DI_ELEMENT_JOINT:
        offer_names(o, reaction_names);
        if (se3di_keys_contain(" gear rack_pinion coupler ", text)) {
            offer_names(o, driver_names);
        } else {
            offer_coordinates(o, model->system, entry->constraint);
        }
        if (entry->break_channel) {
            offer_one(o, "broken", SE3DI_JOINT_BROKEN);
        }
        break;
    case SE3DI_ELEMENT_CONSTRAINT:
        offer_names(o, reaction_names);
        if (!SE3D_FAILED(
                se3d_constraint_count_equations(model->system, entry->constraint, &equations)) &&
            equations == 1) {
            offer_names(o, driver_names);
        }
        break;
    case SE3DI_ELEMENT_WHEEL:
        offer_names(o, wheel_names);
        break;
    case SE3DI_ELEMENT_DRIVER:
        offer_names(o, driver_names);
        break;
    case SE3DI_ELEMENT_STATE:
        offer_names(o, state_names);
        if (se3di_node_get(entry->node, "input")) {
            offer_names(o, input_names);
        }
        if (se3di_keys_contain(" ode integrator lag ", text)) {
            offer_names(o, rate_names);
        }
        break;
    case SE3DI_ELEMENT_FORCE:
    default:
        for (size_t k = 0; k < sizeof force_names / sizeof *force_names; ++k) {
            if (strcmp(text, force_names[k].type) == 0) {
                offer_names(o, force_names[k].names);
            }
        }
        break;
    }
}

static bool pick(const offer *o, const char *name, se3di_quantity *quantity)
{
    for (size_t k = 0; k < o->count; ++k) {
        if (strcmp(o->list[k].name, name) == 0) {
            *quantity = o->list[k].quantity;
            return true;
        }
    }
    return false;
}

static void append(char *text, size_t size, const char *before, const char *word)
{
    const size_t used = strlen(text);
    snprintf(text + used, size - used, "%s%s", before, word);
}

/* "`bar` has no channel `x`, allowed are: a, b". */
static void explain(const offer *o, const char *owner, const char *name, char *problem, size_t size)
{
    se3di_guess guess = se3di_guess_begin(name);
    for (size_t k = 0; k < o->count; ++k) {
        se3di_guess_offer(&guess, o->list[k].name);
    }
    const char *meant = se3di_guess_get(&guess);
    if (*name) {
        snprintf(problem, size, "`%.60s` has no channel `%.60s`, ", owner, name);
    } else {
        snprintf(problem, size, "`%.60s` is not a channel, ", owner);
    }
    if (meant) {
        append(problem, size, "did you mean `", meant);
        append(problem, size, "`?", "");
        return;
    }
    append(problem, size, o->count > 0 ? "it has: " : "it has none", "");
    for (size_t k = 0; k < o->count; ++k) {
        append(problem, size, k > 0 ? ", " : "", o->list[k].name);
    }
}

static void explain_unknown(const se3d_model *model, const char *name, char *problem, size_t size)
{
    se3di_guess guess = se3di_guess_begin(name);
    for (size_t k = 0; k < model->body_count; ++k) {
        se3di_guess_offer(&guess, model->bodies[k].name);
    }
    for (size_t k = 0; k < model->element_count; ++k) {
        se3di_guess_offer(&guess, model->elements[k].name);
    }
    for (const quantity_name *q = system_names; q->name; ++q) {
        se3di_guess_offer(&guess, q->name);
    }
    const char *meant = se3di_guess_get(&guess);
    snprintf(problem, size, "`%.60s` is unknown%s%s%s", name,
             meant ? ", did you mean `"
                   : ", must be a body, joint, driver, constraint, force, state or wheel, or "
                     "one of "
                     "energy, work, "
                     "violation, steps, iterations",
             meant ? meant : "", meant ? "`?" : "");
}

/* Of bodies, and of particles if there are any. */
static bool find_contacts(const se3d_model *model, const char *name, se3di_channel *channel)
{
    for (const quantity_name *q = contact_names; q->name; ++q) {
        if (strcmp(q->name, name) == 0) {
            channel->quantity = q->quantity;
            channel->particles = model->particles ? model->particles->set : NULL;
            return true;
        }
    }
    return false;
}

static bool find_particles(const se3d_model *model, const char *name, se3di_channel *channel)
{
    for (const quantity_name *q = particle_names; model->particles && q->name; ++q) {
        if (strcmp(q->name, name) == 0) {
            channel->quantity = q->quantity;
            channel->particles = model->particles->set;
            return true;
        }
    }
    return false;
}

/* Those of a model that has a `cell`, or an audit of its particles. */
static bool find_among(const quantity_name *q, const se3d_model *model, const char *name,
                       se3di_channel *channel)
{
    for (; q->name; ++q) {
        if (strcmp(q->name, name) == 0) {
            channel->quantity = q->quantity;
            channel->particles = model->particles->set;
            return true;
        }
    }
    return false;
}

static bool find_cell(const se3d_model *model, const char *name, se3di_channel *channel)
{
    return model->particles &&
           ((model->particles->cell && find_among(cell_names, model, name, channel)) ||
            (model->particles->audit && find_among(audit_names, model, name, channel)));
}

static bool find_system(const char *name, se3di_channel *channel)
{
    for (const quantity_name *q = system_names; q->name; ++q) {
        if (strcmp(q->name, name) == 0) {
            channel->quantity = q->quantity;
            return true;
        }
    }
    return false;
}

/* A work, in a model whose analyses (kinematics) do not all compute works. */
static bool is_left_out(const se3d_model *model, se3di_quantity quantity)
{
    const bool work = quantity == SE3DI_ENERGY_DISSIPATED || quantity == SE3DI_ENERGY_BALANCE ||
                      quantity == SE3DI_WORK_ACTUATORS || quantity == SE3DI_WORK_DRIVERS;
    for (size_t k = 0; k < model->analysis_count && work; ++k) {
        if (model->analyses[k].solver.analysis == SE3D_ANALYSIS_KINEMATICS) {
            return true;
        }
    }
    return false;
}

/* A name of the form energy.x or violation.x that find_system did not know. */
static bool explain_system(const char *head, const char *name, char *problem, size_t size)
{
    offer o = {.count = 0};
    if (strcmp(head, "contacts") == 0 || strcmp(head, "particles") == 0) {
        snprintf(problem, size,
                 "`%.60s.%.60s` is unknown, there are contacts.count, contacts.force_max and, with "
                 "`particles`, particles.count, particles.lost, particles.left, particles.energy, "
                 "particles.kinetic, particles.rotation",
                 head, name);
        return true;
    }
    if (strcmp(head, "cell") == 0) {
        snprintf(problem, size,
                 "`%.60s.%.60s` is unknown, there are, with `cell`, cell.length, cell.strain, "
                 "cell.rate, cell.stress, cell.shear, cell.shear_strain, cell.shear_rate, "
                 "cell.offset, cell.volume, cell.solid_fraction, cell.kinetic, cell.work",
                 head, name);
        return true;
    }
    if (strcmp(head, "dissipation") == 0) {
        snprintf(problem, size,
                 "`%.60s.%.60s` is unknown, there are, with `contact: {audit: true}`, "
                 "dissipation.normal, .tangential, .rolling, .torsion, .bonds, .total, .elastic, "
                 ".wall_work",
                 head, name);
        return true;
    }
    if (strcmp(head, "energy") != 0 && strcmp(head, "violation") != 0 &&
        strcmp(head, "work") != 0) {
        return false;
    }
    for (const quantity_name *q = system_names; q->name; ++q) {
        if (strncmp(q->name, head, strlen(head)) == 0) {
            offer_one(&o, q->name + strlen(head) + 1, q->quantity);
        }
    }
    explain(&o, head, name, problem, size);
    return true;
}

static bool find_marker(const se3d_model *model, const se3di_body_entry *body, char *tail,
                        se3di_channel *channel, char *problem, size_t size)
{
    char *dot = strchr(tail, '.');
    offer o = {.count = 0};
    size_t index = 0;
    *dot = '\0';
    if (!se3di_ionames_find(&body->markers, tail, &index)) {
        snprintf(problem, size, "`%.60s` has no marker named `%.60s`", body->name, tail);
        return false;
    }
    offer_names(&o, marker_names);
    offer_names(&o, marker_asked_names);
    channel->marker = model->markers[index].marker;
    if (!pick(&o, dot + 1, &channel->quantity)) {
        explain(&o, tail, dot + 1, problem, size);
        return false;
    }
    return true;
}

/* A set of particles, a sink, a region, a flow, a servo wall, bonds: returns whether one has that
 * name. */
static bool find_flow(const se3d_model *model, const char *head, se3di_channel *channel, offer *o)
{
    static const quantity_name *const names[] = {
        [SE3DI_TAGGED_SET] = set_names,       [SE3DI_TAGGED_SINK] = sink_names,
        [SE3DI_TAGGED_REGION] = region_names, [SE3DI_TAGGED_FLOW] = flow_names,
        [SE3DI_TAGGED_SERVO] = servo_names,   [SE3DI_TAGGED_BOND] = bond_names};
    for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
        const size_t index = se3di_tagged_find(model->particles, (se3di_tagged_kind)k, head);
        if (index != SIZE_MAX) {
            channel->tagged = model->particles;
            channel->particles = model->particles->set;
            channel->index = (uint32_t)index;
            offer_names(o, names[k]);
            return true;
        }
    }
    return false;
}

/* What a coordinate of the element is. */
static se3di_motion motion_of(const se3di_element_entry *entry)
{
    const se3di_node *type = se3di_node_get(entry->node, "type");
    const char *text = type ? type->text : "";
    if (entry->kind == SE3DI_ELEMENT_CONSTRAINT) {
        return strcmp(text, "d") == 0 || strcmp(text, "cd") == 0 ? SE3DI_TRANSLATION
                                                                 : SE3DI_MOTION_UNKNOWN;
    }
    if (entry->kind == SE3DI_ELEMENT_JOINT) {
        return SE3DI_MOTION_UNKNOWN;
    }
    if (strcmp(text, "tsda") == 0 || strcmp(text, "rsda") == 0) {
        return text[0] == 't' ? SE3DI_TRANSLATION : SE3DI_ROTATION;
    }
    return entry->coordinate == SE3D_JOINT_COORDINATE_ANGLE ? SE3DI_ROTATION : SE3DI_TRANSLATION;
}

static void set_element(se3di_channel *channel, const se3di_element_entry *entry)
{
    channel->constraint = entry->constraint;
    channel->force = entry->force;
    channel->wheel = entry->wheel;
    channel->state = entry->states ? entry->states[0] : (se3d_state){0, 0};
    channel->body = entry->body;
    channel->motion = motion_of(entry);
    memcpy(channel->point, entry->point, sizeof channel->point);
}

static bool find_element(const se3d_model *model, const char *head, const char *tail,
                         se3di_channel *channel, offer *offered)
{
    size_t index = 0;
    if (!se3di_ionames_find(&model->element_names, head, &index)) {
        return false;
    }
    const se3di_element_entry *entry = &model->elements[index];
    offer_element(offered, model, entry);
    set_element(channel, entry);
    return pick(offered, tail, &channel->quantity);
}

static bool find_absolute(const se3d_model *model, const char *name, se3di_channel *channel,
                          char *problem, size_t problem_size)
{
    char head[320];
    offer o = {.count = 0};
    size_t index = 0;
    memset(channel, 0, sizeof *channel);
    channel->name = name;
    if (find_system(name, channel)) {
        if (is_left_out(model, channel->quantity)) {
            snprintf(problem, problem_size,
                     "`%.60s` is not computed by kinematics, use inverse_dynamics", name);
            return false;
        }
        return true;
    }
    if (find_contacts(model, name, channel) || find_particles(model, name, channel) ||
        find_cell(model, name, channel)) {
        return true;
    }
    snprintf(head, sizeof head, "%s", name);
    char *tail = head + strcspn(head, ".");
    if (*tail) {
        *tail++ = '\0';
    }
    if (find_element(model, head, tail, channel, &o)) {
        return true;
    }
    if (find_flow(model, head, channel, &o)) {
        if (!pick(&o, tail, &channel->quantity)) {
            explain(&o, head, tail, problem, problem_size);
            return false;
        }
        return true;
    }
    if (se3di_ionames_find(&model->body_names, head, &index)) {
        const se3di_body_entry *body = &model->bodies[index];
        channel->body = body->body;
        if (strchr(tail, '.')) {
            return find_marker(model, body, tail, channel, problem, problem_size);
        }
        offer_names(&o, body_names);
        if (pick(&o, tail, &channel->quantity)) {
            return true;
        }
    } else if (!se3di_ionames_find(&model->element_names, head, NULL)) {
        if (!explain_system(head, tail, problem, problem_size)) {
            explain_unknown(model, *tail ? head : name, problem, problem_size);
        }
        return false;
    }
    explain(&o, head, tail, problem, problem_size);
    return false;
}

/* "wheel.position@chassis" */
static bool find_relative(const se3d_model *model, const char *name, const char *at,
                          se3di_channel *channel, char *problem, size_t problem_size)
{
    char base[320];
    snprintf(base, sizeof base, "%.*s", (int)(at - name), name);
    if (!find_absolute(model, base, channel, problem, problem_size)) {
        return false;
    }
    channel->name = name;
    if (!se3di_channel_can_be_relative(channel)) {
        snprintf(problem, problem_size,
                 "`%.100s` cannot be relative (@): positions, orientations, velocities and "
                 "accelerations of bodies and markers can",
                 base);
        return false;
    }
    return se3di_reference_find(model, at + 1, &channel->reference, problem, problem_size);
}

bool se3di_channel_find(const se3d_model *model, const char *name, se3di_channel *channel,
                        char *problem, size_t problem_size)
{
    const char *at = strrchr(name, '@');
    return find_absolute(model, name, channel, problem, problem_size) ||
           (at && find_relative(model, name, at, channel, problem, problem_size));
}

/* The length of `name` without a component at its end, 0 if there is none. */
static size_t find_component(const char *name)
{
    static const char *const components[] = {"x", "y", "z", "e0", "e1", "e2", "e3"};
    const char *dot = strrchr(name, '.');
    for (size_t k = 0; dot && k < sizeof components / sizeof *components; ++k) {
        if (strcmp(dot + 1, components[k]) == 0) {
            return (size_t)(dot - name);
        }
    }
    return 0;
}

bool se3di_channel_find_number(se3d_model *model, const char *name, se3di_channel *channel,
                               size_t *component, char *problem, size_t problem_size)
{
    const size_t length = find_component(name);
    const char *whole = length > 0 ? se3di_iopool_copy(&model->pool, name, length) : name;
    char column[400];
    *component = 0;
    if (!whole) {
        snprintf(problem, problem_size, "out of memory");
        return false;
    }
    if (!se3di_channel_find(model, whole, channel, problem, problem_size)) {
        return false;
    }
    const size_t width = se3di_channel_get_width(channel);
    for (size_t k = 0; k < width; ++k) {
        se3di_channel_format_column(channel, k, column, sizeof column);
        if (strcmp(column, name) == 0) {
            *component = k;
            return true;
        }
    }
    if (width == 1) {
        snprintf(problem, problem_size, "`%.200s` has no components", whole);
    } else {
        se3di_channel_format_column(channel, width - 1, column, sizeof column);
        snprintf(problem, problem_size,
                 "`%.200s` is not a single number, name a component such as `%.200s`", name,
                 column);
    }
    return false;
}

/* A growing list of channels with names made up of two or three parts. */
typedef struct channel_list {
    se3d_model *model;
    size_t most; /* elements of a kind */
    se3di_channel *list;
    size_t count;
    size_t capacity;
    bool failed;
} channel_list;

static void list_one(channel_list *c, se3di_channel channel, const char *const parts[3])
{
    char name[320];
    snprintf(name, sizeof name, "%s%s%s%s%s", parts[0], parts[1] ? "." : "",
             parts[1] ? parts[1] : "", parts[2] ? "." : "", parts[2] ? parts[2] : "");
    channel.name = se3di_iopool_copy(&c->model->pool, name, strlen(name));
    se3di_channel *grown =
        se3di_iopool_grow(&c->model->pool, c->list, c->count, &c->capacity, sizeof *grown);
    if (!channel.name || !grown) {
        c->failed = true;
        return;
    }
    c->list = grown;
    c->list[c->count++] = channel;
}

static bool has_contacts(const se3d_model *model)
{
    return se3di_node_get(model->root, "contact") || model->particles;
}

static void list_bodies(channel_list *c)
{
    const se3d_model *model = c->model;
    for (size_t k = 1; k < model->body_count && k <= c->most && !c->failed; ++k) {
        for (const quantity_name *q = body_names; q->name && !c->failed; ++q) {
            if (q->quantity == SE3DI_BODY_CONTACT_FORCE && !has_contacts(model)) {
                continue;
            }
            const char *const parts[3] = {model->bodies[k].name, q->name, NULL};
            const se3di_channel channel = {.quantity = q->quantity, .body = model->bodies[k].body};
            list_one(c, channel, parts);
        }
    }
    for (size_t k = 0; k < model->marker_count && !c->failed; ++k) {
        const se3di_marker_entry *marker = &model->markers[k];
        if (marker->body == 0 || marker->body > c->most) {
            continue;
        }
        for (const quantity_name *q = marker_names; q->name && !c->failed; ++q) {
            const char *const parts[3] = {model->bodies[marker->body].name, marker->name, q->name};
            const se3di_channel channel = {.quantity = q->quantity, .marker = marker->marker};
            list_one(c, channel, parts);
        }
    }
}

static void list_elements(channel_list *c)
{
    const se3d_model *model = c->model;
    size_t listed[SE3DI_ELEMENT_KINDS] = {0};
    for (size_t k = 0; k < model->element_count && !c->failed; ++k) {
        const se3di_element_entry *entry = &model->elements[k];
        offer o;
        if (++listed[entry->kind] > c->most) {
            continue;
        }
        offer_element(&o, model, entry);
        for (size_t i = 0; i < o.count && !c->failed; ++i) {
            const char *const parts[3] = {entry->name, o.list[i].name, NULL};
            se3di_channel channel = {.quantity = o.list[i].quantity};
            set_element(&channel, entry);
            list_one(c, channel, parts);
        }
    }
}

se3di_channel *se3di_channel_list_all(se3d_model *model, size_t most, size_t *count)
{
    channel_list c = {.model = model, .most = most};
    list_bodies(&c);
    list_elements(&c);
    for (const quantity_name *q = system_names; q->name && !c.failed; ++q) {
        if (is_left_out(model, q->quantity)) {
            continue;
        }
        const char *const parts[3] = {q->name, NULL, NULL};
        const se3di_channel channel = {.quantity = q->quantity};
        list_one(&c, channel, parts);
    }
    for (const quantity_name *q = contact_names; has_contacts(model) && q->name && !c.failed; ++q) {
        const char *const parts[3] = {q->name, NULL, NULL};
        const se3di_channel channel = {
            .quantity = q->quantity, .particles = model->particles ? model->particles->set : NULL};
        list_one(&c, channel, parts);
    }
    for (const quantity_name *q = particle_names; model->particles && q->name && !c.failed; ++q) {
        const char *const parts[3] = {q->name, NULL, NULL};
        const se3di_channel channel = {.quantity = q->quantity, .particles = model->particles->set};
        list_one(&c, channel, parts);
    }
    *count = c.failed ? 0 : c.count;
    return c.failed ? NULL : c.list;
}

void se3di_channel_format_column(const se3di_channel *channel, size_t k, char *text, size_t size)
{
    static const char *const xyz[] = {".x", ".y", ".z"};
    static const char *const euler[] = {".e0", ".e1", ".e2", ".e3"};
    const size_t width = se3di_channel_get_width(channel);
    snprintf(text, size, "%s%s", channel->name, width == 4 ? euler[k] : width == 3 ? xyz[k] : "");
}
