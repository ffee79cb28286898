/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/fmi/states.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/channel/channel.h"
#include "io/channel/event.h"
#include "io/channel/output.h"

enum { NAME_SIZE = 400 };

typedef struct lister {
    se3d_model *model;
    se3di_fmi_variables *v;
    se3d_coordinates *coordinates;
    double length, rate; /* sizes of the model: m, 1/s */
    char *problem;
    size_t problem_size;
} lister;

/* ---- what cannot be exchanged -----------------------------------------------------------------*/

static void give_reason(se3di_fmi_variables *v, const char *name, const char *why)
{
    snprintf(v->reason, sizeof v->reason, "%.100s%s", name, why);
}

/* Sums over the steps of a solver of the model's own. */
static bool is_summed(const se3di_channel *channel)
{
    size_t first = 0;
    const se3di_question question = se3di_channel_get_question(channel, &first);
    return question == SE3DI_ASK_WORK || question == SE3DI_ASK_SOLVER ||
           channel->quantity == SE3DI_ENERGY_DISSIPATED;
}

static bool has_sum(const se3di_channel *channel)
{
    const se3di_combination *made = channel->combination;
    bool found = !made && is_summed(channel);
    for (size_t k = 0; made && k < made->count; ++k) {
        found = found || is_summed(&made->parts[k]);
    }
    return found;
}

static bool check_outputs(const se3d_model *model, se3di_fmi_variables *v)
{
    for (size_t k = 0; k < model->output_count; ++k) {
        for (size_t i = 0; i < model->outputs[k].count; ++i) {
            const se3di_channel *channel = &model->outputs[k].channels[i];
            if (has_sum(channel)) {
                give_reason(v, channel->name,
                            " is summed up over the steps of the model's own solver: choose other "
                            "channels in `output`");
                return false;
            }
        }
    }
    return true;
}

static bool check_elements(const se3d_model *model, se3di_fmi_variables *v)
{
    for (size_t k = 0; k < model->element_count; ++k) {
        const se3di_element_entry *e = &model->elements[k];
        const char *type = "";
        if (e->kind == SE3DI_ELEMENT_FORCE) {
            se3d_force_get_type(model->system, e->force, &type);
        }
        if (strcmp(type, "friction") == 0) {
            give_reason(v, e->name, " sticks and slips, which states do not tell");
        } else if (e->break_channel) {
            give_reason(v, e->name, " may break, which changes the number of states");
        } else if (e->kind == SE3DI_ELEMENT_DRIVER && e->rate.index1 && (e->settable & 1U)) {
            give_reason(v, e->name,
                        " has a rate that can be set, whose integral the states do not have");
        }
        if (v->reason[0]) {
            return false;
        }
    }
    return true;
}

static bool check_model(const se3d_model *model, se3di_fmi_variables *v)
{
    for (size_t k = 0; k < model->shape_count; ++k) {
        if (model->shapes[k].made.index1) {
            give_reason(v, "", "bodies touch, and what they touched with is not in the states");
            return false;
        }
    }
    return check_elements(model, v) && check_outputs(model, v);
}

/* ---- states -----------------------------------------------------------------------------------*/

static se3d_status add(lister *l, se3di_fmi_role role, const char *name,
                       const se3di_fmi_variable *like)
{
    se3di_fmi_variable made = *like;
    made.name = name;
    made.role = role;
    return se3di_fmi_variables_add(l->v, &made, l->problem, l->problem_size);
}

/* What the numbers of a joint are called, in the order of its coordinates; 'a' begins an angle, 'l'
 * a length, 'q' a unit quaternion. */
typedef struct naming {
    const char *type;
    const char *positions[7];
    const char *velocities[6];
    const char *kinds; /* of the positions */
    const char *rates; /* of the velocities */
} naming;

static const naming namings[] = {
    {"revolute", {"angle"}, {"rate"}, "a", "a"},
    {"screw", {"angle"}, {"rate"}, "a", "a"},
    {"prismatic", {"displacement"}, {"rate"}, "l", "l"},
    {"cylindrical", {"angle", "displacement"}, {"angle_rate", "displacement_rate"}, "al", "al"},
    {"universal", {"angle_i", "angle_j"}, {"rate_i", "rate_j"}, "aa", "aa"},
    {"planar", {"x", "y", "angle"}, {"x_rate", "y_rate", "angle_rate"}, "lla", "lla"},
    {"spherical",
     {"e0", "e1", "e2", "e3"},
     {"angular_velocity.x", "angular_velocity.y", "angular_velocity.z"},
     "qqqq",
     "aaa"},
    {"",
     {"position.x", "position.y", "position.z", "e0", "e1", "e2", "e3"},
     {"velocity.x", "velocity.y", "velocity.z", "angular_velocity.x", "angular_velocity.y",
      "angular_velocity.z"},
     "lllqqqq",
     "lllaaa"}};

typedef struct entry {
    const naming *how;
    const char *name; /* of the joint, or of the body if it is free */
    size_t component; /* of the joint's velocities */
    size_t position;  /* the joint's first */
} entry;

static se3d_status get_entry(const lister *l, size_t index, entry *e)
{
    const se3d_system *system = l->model->system;
    se3d_constraint joint;
    se3d_body body;
    const char *type = "";
    se3d_status status = se3d_coordinates_get_entry(l->coordinates, index, &joint, &body, NULL,
                                                    &e->component, &e->position);
    if (status >= 0 && joint.index1) {
        status = se3d_constraint_get_type(system, joint, &type);
        status = status < 0 ? status : se3d_constraint_get_name(system, joint, &e->name);
    } else if (status >= 0) {
        status = se3d_body_get_name(system, body, &e->name);
    }
    e->how = NULL;
    for (size_t k = 0; k < sizeof namings / sizeof *namings && !e->how; ++k) {
        e->how = strcmp(namings[k].type, type) == 0 ? &namings[k] : NULL;
    }
    return status < 0 || e->how ? status : SE3D_ERR_UNSUPPORTED;
}

/* Joints without a name get a number. */
static void format_name(char *text, const char *name, size_t number, const char *what)
{
    if (name[0]) {
        snprintf(text, NAME_SIZE, "state.%.200s.%s", name, what);
    } else {
        snprintf(text, NAME_SIZE, "state.%zu.%s", number, what);
    }
}

/* A position (of_rate 0), its derivative or velocity (1), or the derivative of that (2). */
static se3di_fmi_variable describe(const lister *l, char kind, int of_rate, size_t place)
{
    const int8_t time = (int8_t)-of_rate;
    double size = kind == 'l' ? l->length : 1.0;
    for (int k = 0; k < of_rate; ++k) {
        size *= l->rate;
    }
    return (se3di_fmi_variable){.nominal = size,
                                .element = place,
                                .dimension = kind == 'l'   ? (se3di_dimension){1, 0, time, 0}
                                             : kind == 'a' ? (se3di_dimension){0, 0, time, 1}
                                                           : (se3di_dimension){0, 0, time, 0},
                                .has_unit = kind != 'q' || of_rate > 0};
}

/* The name of a derivative of the state `name`. */
static void format_derivative(char *text, const char *name)
{
    snprintf(text, NAME_SIZE, "der(%.380s)", name);
}

static se3d_status add_position(lister *l, const entry *e, size_t velocity, size_t k, bool rates)
{
    char name[NAME_SIZE];
    char derivative[NAME_SIZE];
    const char kind = e->how->kinds[k];
    se3di_fmi_variable v = describe(l, kind, rates, e->position + k);
    format_name(name, e->name, velocity, e->how->positions[k]);
    format_derivative(derivative, name);
    v.component = rates && kind != 'q' ? l->v->positions + velocity + k + 1 : 0;
    return add(l, rates ? SE3DI_FMI_DERIVATIVE : SE3DI_FMI_STATE, rates ? derivative : name, &v);
}

static se3d_status add_positions(lister *l, bool rates)
{
    entry e;
    se3d_status status = SE3D_OK;
    for (size_t k = 0; k < l->v->velocities && status >= 0; ++k) {
        status = get_entry(l, k, &e);
        if (status < 0 || e.component > 0) {
            continue;
        }
        for (size_t i = 0; e.how->kinds[i] && status >= 0; ++i) {
            status = add_position(l, &e, k, i, rates);
        }
    }
    return status;
}

static se3d_status add_velocities(lister *l, bool rates)
{
    char name[NAME_SIZE];
    char derivative[NAME_SIZE];
    entry e;
    se3d_status status = SE3D_OK;
    for (size_t k = 0; k < l->v->velocities && status >= 0; ++k) {
        status = get_entry(l, k, &e);
        if (status < 0) {
            break;
        }
        const se3di_fmi_variable v =
            describe(l, e.how->rates[e.component], rates ? 2 : 1, l->v->positions + k);
        format_name(name, e.name, k - e.component, e.how->velocities[e.component]);
        format_derivative(derivative, name);
        status =
            add(l, rates ? SE3DI_FMI_DERIVATIVE : SE3DI_FMI_STATE, rates ? derivative : name, &v);
    }
    return status;
}

static se3d_status add_user_states(lister *l, bool rates)
{
    char name[NAME_SIZE];
    char derivative[NAME_SIZE];
    const se3d_system *system = l->model->system;
    const size_t first = l->v->positions + l->v->velocities;
    se3d_status status = SE3D_OK;
    for (size_t k = 0; k < se3d_system_count_states(system) && status >= 0; ++k) {
        se3d_state state;
        const char *own = "";
        double value = 0.0;
        status = se3d_system_get_state(system, k, &state);
        se3d_state_get_name(system, state, &own);
        se3d_state_get_value(system, state, SE3D_STATE_VALUE, &value);
        const se3di_fmi_variable v = {.nominal = fmax(fabs(value), 1.0), .element = first + k};
        format_name(name, own, first + k, "z");
        format_derivative(derivative, name);
        status = status < 0 ? status
                            : add(l, rates ? SE3DI_FMI_DERIVATIVE : SE3DI_FMI_STATE,
                                  rates ? derivative : name, &v);
    }
    return status;
}

/* ---- indicators -------------------------------------------------------------------------------*/

/* The ends of a stop, which may be infinite. @return false: the element is no stop */
static bool get_ends(const se3d_model *model, const se3di_element_entry *e, double ends[2])
{
    const char *type = "";
    const bool is_stop = e->kind == SE3DI_ELEMENT_FORCE &&
                         se3d_force_get_type(model->system, e->force, &type) >= 0 &&
                         strcmp(type, "stop") == 0;
    return is_stop &&
           se3d_force_get_parameter(model->system, e->force, SE3D_FORCE_PARAMETER_LOWER,
                                    &ends[0]) >= 0 &&
           se3d_force_get_parameter(model->system, e->force, SE3D_FORCE_PARAMETER_UPPER,
                                    &ends[1]) >= 0;
}

bool se3di_fmi_find_stop(const se3d_model *model, size_t k, se3d_force *stop)
{
    for (size_t n = 0; n < model->element_count; ++n) {
        double ends[2];
        if (get_ends(model, &model->elements[n], ends) && k-- == 0) {
            *stop = model->elements[n].force;
            return true;
        }
    }
    return false;
}

static se3d_status add_indicators(lister *l)
{
    static const char *const sides[] = {"lower", "upper"};
    const se3d_model *model = l->model;
    const se3di_fmi_variable plain = {.nominal = 1.0};
    char name[NAME_SIZE];
    se3d_status status = SE3D_OK;
    for (size_t k = 0; k < model->event_count && status >= 0; ++k) {
        snprintf(name, sizeof name, "indicator.%zu.%.300s", k + 1, model->events[k].name);
        status = add(l, SE3DI_FMI_INDICATOR, name, &plain);
    }
    for (size_t k = 0; k < model->element_count && status >= 0; ++k) {
        double ends[2] = {0.0, 0.0};
        const bool is_stop = get_ends(model, &model->elements[k], ends);
        l->v->stops += is_stop;
        for (size_t i = 0; is_stop && i < 2 && status >= 0; ++i) {
            snprintf(name, sizeof name, "indicator.%.300s.%s", model->elements[k].name, sides[i]);
            status = isfinite(ends[i]) ? add(l, SE3DI_FMI_INDICATOR, name, &plain) : SE3D_OK;
        }
    }
    return status;
}

se3d_status se3di_fmi_eval_indicator(const se3d_model *model, size_t k, se3di_sample *sample,
                                     double *value)
{
    if (k < model->event_count) {
        const se3di_event_entry *event = &model->events[k];
        double numbers[4];
        const se3d_status status = se3di_channel_eval(&event->source.channel, sample, numbers);
        *value = numbers[event->source.component] - event->level;
        return status;
    }
    k -= model->event_count;
    for (size_t n = 0; n < model->element_count; ++n) {
        double ends[2] = {0.0, 0.0};
        const bool is_stop = get_ends(model, &model->elements[n], ends);
        for (size_t i = 0; is_stop && i < 2; ++i) {
            if (isfinite(ends[i]) && k-- == 0) {
                double x = 0.0;
                const se3d_status status =
                    se3d_force_get_state(model->system, model->elements[n].force, &x, NULL, NULL);
                *value = i == 0 ? x - ends[0] : ends[1] - x;
                return status;
            }
        }
    }
    return SE3D_ERR_INVALID_ARGUMENT;
}

/* ---- the whole --------------------------------------------------------------------------------*/

static se3d_status add_all(lister *l)
{
    se3di_fmi_variables *v = l->v;
    v->state = v->count;
    for (int rates = 0; rates < 2; ++rates) {
        se3d_status status = add_positions(l, rates);
        status = status < 0 ? status : add_velocities(l, rates);
        status = status < 0 ? status : add_user_states(l, rates);
        if (status < 0) {
            return status;
        }
        v->states = rates ? v->states : v->count - v->state;
    }
    v->indicator = v->count;
    const se3d_status status = add_indicators(l);
    v->indicators = v->count - v->indicator;
    return status;
}

static bool has_constraints(const lister *l)
{
    bool found = se3d_coordinates_count_loop_rows(l->coordinates) > 0;
    for (size_t k = 0; k < l->model->element_count; ++k) {
        const se3di_element_kind kind = l->model->elements[k].kind;
        found = found || kind == SE3DI_ELEMENT_DRIVER || kind == SE3DI_ELEMENT_CONSTRAINT;
    }
    return found;
}

static void measure(lister *l)
{
    const se3di_channel position = {.quantity = SE3DI_BODY_POSITION};
    const se3di_channel turning = {.quantity = SE3DI_BODY_ANGULAR_VELOCITY};
    l->length = se3di_channel_get_scale(&position, l->model->system);
    l->rate = se3di_channel_get_scale(&turning, l->model->system);
}

static se3d_status list_states(se3d_model *model, se3di_fmi_variables *variables, char *problem,
                               size_t problem_size)
{
    lister l = {.model = model, .v = variables, .problem = problem, .problem_size = problem_size};
    if (!check_model(model, variables)) {
        return SE3D_OK;
    }
    se3d_status status = se3d_coordinates_create(model->system, &l.coordinates);
    if (status < 0) {
        give_reason(variables, "", se3d_system_get_error(model->system));
        return status == SE3D_ERR_NO_MEMORY ? status : SE3D_OK;
    }
    measure(&l);
    variables->positions = se3d_coordinates_count_positions(l.coordinates);
    variables->velocities = se3d_coordinates_count(l.coordinates);
    variables->projects = has_constraints(&l);
    status = add_all(&l);
    if (status >= 0 && variables->states == 0) {
        give_reason(variables, "", "nothing moves");
    }
    se3d_coordinates_destroy(l.coordinates);
    return status;
}

static se3d_status refuse(const se3d_model *model, char *problem, size_t size, const char *what)
{
    snprintf(problem, size, "%.200s%s", model->file, what);
    return SE3D_ERR_UNSUPPORTED;
}

se3d_status se3di_fmi_variables_create(se3d_model *model, se3di_fmi_variables *variables,
                                       char *problem, size_t problem_size)
{
    size_t index = 0;
    memset(variables, 0, sizeof *variables);
    se3di_iopool_init(&variables->pool, &model->pool.allocator);
    if (!se3di_fmi_find_analysis(model, &index)) {
        return refuse(model, problem, problem_size,
                      ": the model has no analysis in which time passes; a unit needs dynamics, "
                      "kinematics or inverse_dynamics");
    }
    if (model->guest_count > 0) {
        return refuse(model, problem, problem_size,
                      ": the model has `fmus`, units do not hold others");
    }
    if (model->particles) {
        return refuse(model, problem, problem_size,
                      ": the model has particles, which a unit cannot have");
    }
    const se3d_status status = se3di_fmi_variables_list(model, variables, problem, problem_size);
    return status < 0 ? status : list_states(model, variables, problem, problem_size);
}
