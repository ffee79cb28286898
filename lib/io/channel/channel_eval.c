/* SPDX-License-Identifier: BSD-3-Clause */
/* The numbers of channels at the present state. */
#include <math.h>
#include <string.h>

#include "io/base/rotation.h"
#include "io/channel/channel.h"
#include "io/channel/channel_flow.h"
#include "io/channel/relative.h"
#include "io/channel/sample.h"
#include "math/vec3.h"

enum { TYRES_AT_ONCE = 4 };

/* Of a marker, in its own frame. */
static se3d_status eval_turning(const se3di_channel *c, const se3d_system *system, double value[4])
{
    double p[4];
    double q[4];
    double w[3];
    double ground[3];
    double A[9];
    se3d_body body;
    se3d_status status = se3d_marker_get_body(system, c->marker, &body);
    status = status < 0 ? status : se3d_body_get_orientation(system, body, p);
    status = status < 0 ? status : se3d_marker_get_orientation(system, c->marker, q);
    if (status >= 0) {
        status = c->quantity == SE3DI_MARKER_ANGULAR_VELOCITY
                     ? se3d_body_get_angular_velocity(system, body, w)
                     : se3d_body_get_angular_acceleration(system, body, w);
    }
    if (status < 0) {
        return status;
    }
    se3di_rotation_to_matrix(p, A);
    se3di_mul(A, w, ground);
    se3di_rotation_apply_inverse(q, ground, value);
    return SE3D_OK;
}

static se3d_status eval_body(const se3di_channel *c, const se3d_system *system, double value[4])
{
    double torque[3];
    switch (c->quantity) {
    case SE3DI_BODY_POSITION:
        return se3d_body_get_position(system, c->body, value);
    case SE3DI_BODY_ORIENTATION:
        return se3d_body_get_orientation(system, c->body, value);
    case SE3DI_BODY_VELOCITY:
        return se3d_body_get_velocity(system, c->body, value);
    case SE3DI_BODY_ANGULAR_VELOCITY:
        return se3d_body_get_angular_velocity(system, c->body, value);
    case SE3DI_BODY_ACCELERATION:
        return se3d_body_get_acceleration(system, c->body, value);
    case SE3DI_BODY_ANGULAR_ACCELERATION:
        return se3d_body_get_angular_acceleration(system, c->body, value);
    case SE3DI_BODY_CONTACT_FORCE:
        return se3d_body_get_contact_wrench(system, c->body, value, torque);
    case SE3DI_MARKER_POSITION:
        return se3d_marker_get_position(system, c->marker, value);
    case SE3DI_MARKER_VELOCITY:
        return se3d_marker_get_velocity(system, c->marker, value);
    case SE3DI_MARKER_ORIENTATION:
        return se3d_marker_get_orientation(system, c->marker, value);
    case SE3DI_MARKER_ANGULAR_VELOCITY:
    case SE3DI_MARKER_ANGULAR_ACCELERATION:
        return eval_turning(c, system, value);
    default:
        return se3d_marker_get_acceleration(system, c->marker, value);
    }
}

/* What an element does to its body j at its point there; the system knows it at the centre of
 * mass. */
static se3d_status ask_wrench(const se3di_channel *c, const se3d_system *system, double numbers[6])
{
    double w[6];
    double r[3];
    double at[3];
    se3d_status status = se3d_force_get_wrench(system, c->force, 1, w);
    if (status >= 0) {
        status = se3d_body_get_position(system, c->body, r);
    }
    if (status >= 0) {
        status = se3d_body_get_point(system, c->body, c->point, at);
    }
    if (status < 0) {
        return status;
    }
    const double s[3] = {at[0] - r[0], at[1] - r[1], at[2] - r[2]};
    for (size_t k = 0; k < 3; ++k) {
        const size_t i = (k + 1) % 3;
        const size_t j = (k + 2) % 3;
        numbers[k] = w[k];
        numbers[3 + k] = w[3 + k] - (s[i] * w[j] - s[j] * w[i]);
    }
    return SE3D_OK;
}

static se3d_status ask_broken(const se3di_channel *c, const se3d_system *system, double *number)
{
    int32_t broken = 0;
    const se3d_status status = se3d_joint_get_broken(system, c->constraint, &broken);
    *number = broken;
    return status;
}

static se3d_status ask_element(se3di_question question, const se3di_channel *c,
                               const se3d_system *system, double numbers[SE3DI_ANSWER_NUMBERS])
{
    switch (question) {
    case SE3DI_ASK_REACTION:
        return se3d_constraint_get_reaction(system, c->constraint, numbers, numbers + 3);
    case SE3DI_ASK_JOINT_ANGLE:
        return se3d_joint_get_coordinate(system, c->constraint, SE3D_JOINT_COORDINATE_ANGLE,
                                         numbers, numbers + 1, NULL);
    case SE3DI_ASK_JOINT_DISPLACEMENT:
        return se3d_joint_get_coordinate(system, c->constraint, SE3D_JOINT_COORDINATE_DISPLACEMENT,
                                         numbers, numbers + 1, NULL);
    case SE3DI_ASK_JOINT_BROKEN:
        return ask_broken(c, system, numbers);
    case SE3DI_ASK_DRIVER_VALUE:
        return se3d_driver_get_value(system, c->constraint, numbers);
    case SE3DI_ASK_DRIVER_EFFORT:
        return se3d_driver_get_effort(system, c->constraint, numbers);
    case SE3DI_ASK_ARMATURE_MOTION:
        return se3d_force_get_state(system, c->force, numbers, numbers + 1, NULL);
    case SE3DI_ASK_WRENCH:
        return ask_wrench(c, system, numbers);
    case SE3DI_ASK_STATE_VALUE:
        return se3d_state_get_value(system, c->state, SE3D_STATE_OUTPUT, numbers);
    case SE3DI_ASK_STATE_ITSELF:
        return se3d_state_get_value(system, c->state, SE3D_STATE_VALUE, numbers);
    case SE3DI_ASK_STATE_INPUT:
        return se3d_state_get_value(system, c->state, SE3D_STATE_INPUT, numbers);
    case SE3DI_ASK_STATE_RATE:
        return se3d_state_get_rate(system, c->state, numbers);
    case SE3DI_ASK_WHEEL_POSE:
        return se3d_wheel_get_measures(system, c->wheel, SE3D_WHEEL_CAMBER,
                                       SE3D_WHEEL_CASTER - SE3D_WHEEL_CAMBER, numbers);
    case SE3DI_ASK_WHEEL_AXIS:
        return se3d_wheel_get_measures(system, c->wheel, SE3D_WHEEL_CASTER,
                                       SE3D_WHEEL_CAMBER_GRADIENT - SE3D_WHEEL_CASTER, numbers);
    case SE3DI_ASK_WHEEL_RIDE:
        return se3d_wheel_get_measures(system, c->wheel, SE3D_WHEEL_CAMBER_GRADIENT,
                                       SE3D_WHEEL_WHEEL_LOAD - SE3D_WHEEL_CAMBER_GRADIENT, numbers);
    case SE3DI_ASK_WHEEL_LOAD:
        return se3d_wheel_get_measures(system, c->wheel, SE3D_WHEEL_WHEEL_LOAD,
                                       SE3D_WHEEL_MEASURES - SE3D_WHEEL_WHEEL_LOAD, numbers);
    case SE3DI_ASK_TYRE_PLACE:
        return se3d_tyre_get_values(system, c->force, SE3D_TYRE_INCLINATION,
                                    SE3D_TYRE_VALUES - SE3D_TYRE_INCLINATION, numbers);
    default:
        return se3d_force_get_state(system, c->force, numbers, numbers + 1, numbers + 2);
    }
}

static se3d_status ask_energy(const se3d_system *system, double numbers[4])
{
    se3d_energy energy = {0.0, 0.0, 0.0, 0.0};
    const se3d_status status = se3d_system_get_energy(system, &energy);
    numbers[0] = energy.kinetic;
    numbers[1] = energy.potential;
    numbers[2] = energy.total;
    numbers[3] = energy.dissipated;
    return status;
}

static se3d_status answer(se3di_question question, const se3di_channel *c, se3di_sample *sample,
                          double room[SE3DI_ANSWER_NUMBERS], const double **numbers);

/* Actuators, drivers, and what is left over of the energies. */
static se3d_status ask_work(const se3di_channel *c, se3di_sample *sample, double numbers[3])
{
    double room[SE3DI_ANSWER_NUMBERS];
    const double *energy;
    se3d_work work = {0.0, 0.0, 0.0};
    se3d_status status = se3d_system_get_work(sample->system, &work);
    if (status >= 0) {
        status = answer(SE3DI_ASK_ENERGY, c, sample, room, &energy);
    }
    if (status >= 0) {
        numbers[0] = work.actuators;
        numbers[1] = work.drivers;
        numbers[2] = energy[0] + energy[1] + work.dissipated - work.actuators - work.drivers;
    }
    return status;
}

static se3d_status ask_particles(const se3di_channel *c, double numbers[6])
{
    se3d_particles_stats stats = {.steps = 0};
    se3d_particles_energy energy = {0.0, 0.0, 0.0};
    se3d_status status = se3d_particles_get_stats(c->particles, &stats);
    if (status >= 0) {
        status = se3d_particles_get_energy(c->particles, &energy);
    }
    numbers[0] = (double)se3d_particles_count(c->particles);
    numbers[1] = (double)stats.lost;
    numbers[2] = (double)stats.left;
    numbers[3] = energy.translation + energy.rotation + energy.potential;
    numbers[4] = energy.translation + energy.rotation;
    numbers[5] = energy.rotation;
    return status;
}

static se3d_status ask_contact_count(const se3di_channel *c, const se3d_system *system,
                                     double *count)
{
    se3d_particles_stats stats = {.steps = 0};
    const se3d_status status =
        c->particles ? se3d_particles_get_stats(c->particles, &stats) : SE3D_OK;
    *count = (double)(se3d_system_count_contacts(system) + stats.contacts);
    return status;
}

static double norm(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* The largest force of bodies, whose contacts are known. */
static se3d_status find_body_max(se3di_sample *sample, double *largest)
{
    const size_t count = se3d_system_count_contacts(sample->system);
    se3d_contact *list = se3di_iopool_array(&sample->listing, count + 1, sizeof *list);
    if (!list) {
        return SE3D_ERR_NO_MEMORY;
    }
    const se3d_status status = se3d_system_get_contacts(sample->system, count, list);
    for (size_t k = 0; k < count && status >= 0; ++k) {
        *largest = fmax(*largest, norm(list[k].force));
    }
    return status;
}

/* The list of the contacts of particles serves files that show it, too. */
static se3d_status ask_force_max(const se3di_channel *c, se3di_sample *sample, double *largest)
{
    se3di_particle_contacts contacts = {NULL, 0};
    if (!c->particles || sample->state == 0) {
        return se3d_system_get_contact_force_max(sample->system, largest);
    }
    se3d_status status = se3di_sample_list_contacts(sample, c->particles, &contacts);
    for (size_t k = 0; k < contacts.count; ++k) {
        *largest = fmax(*largest, norm(contacts.list[k].force));
    }
    return status < 0 ? status : find_body_max(sample, largest);
}

static se3d_status ask_solver(const se3d_solver_stats *stats, double numbers[2])
{
    numbers[0] = stats ? (double)stats->steps : 0.0;
    numbers[1] = stats ? (double)stats->iterations : 0.0;
    return SE3D_OK;
}

static se3d_status ask(se3di_question question, const se3di_channel *c, se3di_sample *sample,
                       double numbers[SE3DI_ANSWER_NUMBERS])
{
    const se3d_system *system = sample->system;
    switch (question) {
    case SE3DI_ASK_ENERGY:
        return ask_energy(system, numbers);
    case SE3DI_ASK_WORK:
        return ask_work(c, sample, numbers);
    case SE3DI_ASK_VIOLATION:
        return se3d_system_get_violation(system, numbers);
    case SE3DI_ASK_CONTACTS_COUNT:
        return ask_contact_count(c, system, numbers);
    case SE3DI_ASK_CONTACTS_FORCE_MAX:
        return ask_force_max(c, sample, numbers);
    case SE3DI_ASK_PARTICLES:
        return ask_particles(c, numbers);
    case SE3DI_ASK_TALLY:
        return se3di_tagged_ask_tally(c, numbers);
    case SE3DI_ASK_SOURCES:
        return se3di_tagged_ask_sources(c, numbers);
    case SE3DI_ASK_SINK:
        return se3di_tagged_ask_sink(c, numbers);
    case SE3DI_ASK_AVERAGE:
        return se3di_tagged_ask_average(c, numbers);
    case SE3DI_ASK_PASSED:
        return se3di_tagged_ask_passed(c, numbers);
    case SE3DI_ASK_DISSIPATION:
        return se3di_tagged_ask_dissipation(c, numbers);
    case SE3DI_ASK_SERVO:
        return se3di_tagged_ask_servo(c, numbers);
    case SE3DI_ASK_CELL:
        return se3di_tagged_ask_cell(c, numbers);
    case SE3DI_ASK_BONDS:
        return se3di_tagged_ask_bonds(c, numbers);
    case SE3DI_ASK_SOLVER:
        return ask_solver(sample->stats, numbers);
    default:
        return ask_element(question, c, system, numbers);
    }
}

/* By which answers to a question are kept: 0 if there is one only. */
static size_t element_of(se3di_question question, const se3di_channel *c)
{
    switch (question) {
    case SE3DI_ASK_WRENCH:
    case SE3DI_ASK_FORCE:
    case SE3DI_ASK_ARMATURE_MOTION:
    case SE3DI_ASK_TYRE_PLACE:
        return c->force.index1;
    case SE3DI_ASK_STATE_VALUE:
    case SE3DI_ASK_STATE_ITSELF:
    case SE3DI_ASK_STATE_INPUT:
    case SE3DI_ASK_STATE_RATE:
        return c->state.index1;
    case SE3DI_ASK_WHEEL_POSE:
    case SE3DI_ASK_WHEEL_AXIS:
    case SE3DI_ASK_WHEEL_RIDE:
    case SE3DI_ASK_WHEEL_LOAD:
        return c->wheel.index1;
    case SE3DI_ASK_REACTION:
    case SE3DI_ASK_JOINT_ANGLE:
    case SE3DI_ASK_JOINT_DISPLACEMENT:
    case SE3DI_ASK_DRIVER_VALUE:
    case SE3DI_ASK_DRIVER_EFFORT:
        return c->constraint.index1;
    default: /* of sets, sinks and regions */
        return c->tagged ? c->index : 0;
    }
}

/* Up to four tyres from this one on in the list that were last asked about as it was, in the same
 * state and for the same numbers, and will be so again. @return how many */
static size_t list_tyres(se3di_sample *sample, se3d_force tyre, se3di_answer *kept,
                         se3d_force tyres[TYRES_AT_ONCE], se3di_answer *answers[TYRES_AT_ONCE])
{
    size_t count = 1, at = 0;
    tyres[0] = tyre;
    answers[0] = kept;
    if (!kept->is_listed && sample->tyre_count < SE3DI_SAMPLE_TYRES) {
        kept->is_listed = 1;
        sample->tyres[sample->tyre_count++] = tyre;
    }
    while (at < sample->tyre_count && sample->tyres[at].index1 != tyre.index1) {
        ++at;
    }
    for (++at; kept->state != 0 && at < sample->tyre_count && count < TYRES_AT_ONCE; ++at) {
        se3di_answer *other = se3di_sample_find(sample, SE3DI_ASK_TYRE, sample->tyres[at].index1);
        if (!other || other->state != kept->state || other->which != kept->which) {
            break;
        }
        tyres[count] = sample->tyres[at];
        answers[count++] = other;
    }
    return count;
}

/* Of tyres the forces, moments and slips that some channel has asked for until now. */
static se3d_status ask_tyres(se3di_sample *sample, se3d_force tyre, se3di_answer *kept)
{
    double values[TYRES_AT_ONCE][SE3D_TYRE_VALUES];
    se3d_force tyres[TYRES_AT_ONCE];
    se3di_answer *answers[TYRES_AT_ONCE];
    const size_t count = list_tyres(sample, tyre, kept, tyres, answers);
    const se3d_status status =
        se3d_tyre_get_several(sample->system, count, tyres, kept->which, values[0]);
    if (status < 0 && count > 1) { /* of one that is not asked about yet, perhaps */
        kept->state = 0;
        return ask_tyres(sample, tyre, kept);
    }
    for (size_t k = 0; k < count; ++k) {
        answers[k]->state = status < 0 ? 0 : sample->state;
        if (status >= 0) {
            memcpy(answers[k]->numbers, values[k], sizeof values[k]);
        }
    }
    return status;
}

static se3d_status answer_tyre(const se3di_channel *c, size_t first, se3di_sample *sample,
                               double room[SE3DI_ANSWER_NUMBERS], const double **numbers)
{
    const uint32_t own = UINT32_C(1) << first;
    *numbers = room;
    if (sample->state == 0) {
        return se3d_tyre_get_some(sample->system, c->force, own, room);
    }
    se3di_answer *kept = se3di_sample_find(sample, SE3DI_ASK_TYRE, c->force.index1);
    if (!kept) {
        return SE3D_ERR_NO_MEMORY;
    }
    *numbers = kept->numbers;
    if (kept->state == sample->state && (kept->which & own)) {
        return SE3D_OK;
    }
    kept->which |= own;
    return ask_tyres(sample, c->force, kept);
}

/* As `ask`, once in a state; failures are not kept. *numbers: where they are, in `room` if nothing
 * is kept. */
static se3d_status answer(se3di_question question, const se3di_channel *c, se3di_sample *sample,
                          double room[SE3DI_ANSWER_NUMBERS], const double **numbers)
{
    *numbers = room;
    if (sample->state == 0) {
        memset(room, 0, SE3DI_ANSWER_NUMBERS * sizeof *room);
        return ask(question, c, sample, room);
    }
    se3di_answer *kept = se3di_sample_find(sample, question, element_of(question, c));
    if (!kept) {
        return SE3D_ERR_NO_MEMORY;
    }
    *numbers = kept->numbers;
    if (kept->state != sample->state) {
        memset(kept->numbers, 0, sizeof kept->numbers);
        const se3d_status status = ask(question, c, sample, kept->numbers);
        if (status < 0) {
            return status;
        }
        kept->state = sample->state;
    }
    return SE3D_OK;
}

static se3d_status eval_quantity(const se3di_channel *channel, se3di_sample *sample,
                                 double value[4])
{
    double room[SE3DI_ANSWER_NUMBERS];
    const double *numbers;
    size_t first = 0;
    const se3di_question question = se3di_channel_get_question(channel, &first);
    for (size_t k = 0; k < 4; ++k) {
        value[k] = 0.0;
    }
    if (channel->reference.given) {
        return se3di_relative_eval(channel, sample->system, value);
    }
    if (question == SE3DI_ASK_ITSELF) {
        return eval_body(channel, sample->system, value);
    }
    const se3d_status status = question == SE3DI_ASK_TYRE
                                   ? answer_tyre(channel, first, sample, room, &numbers)
                                   : answer(question, channel, sample, room, &numbers);
    const size_t width = status < 0 ? 0 : se3di_channel_get_width(channel);
    for (size_t k = 0; k < width; ++k) {
        value[k] = numbers[first + k];
    }
    return status;
}

static se3d_status eval_combination(const se3di_combination *c, se3di_sample *sample,
                                    double value[4])
{
    double x[SE3D_EXPRESSION_VARIABLE_MAX] = {0.0};
    memset(value, 0, 4 * sizeof *value);
    se3d_status status = se3d_system_get_time(sample->system, x);
    for (size_t k = 0; k < c->count && status >= 0; ++k) {
        double numbers[4];
        status = eval_quantity(&c->parts[k], sample, numbers);
        x[k + 1] = numbers[c->components[k]];
    }
    if (status < 0) {
        return status;
    }
    value[0] = x[1];
    return c->expression ? se3d_expression_eval(c->expression, x, value) : SE3D_OK;
}

se3d_status se3di_channel_eval(const se3di_channel *channel, se3di_sample *sample, double value[4])
{
    return channel->combination ? eval_combination(channel->combination, sample, value)
                                : eval_quantity(channel, sample, value);
}
