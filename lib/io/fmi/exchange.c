/* SPDX-License-Identifier: BSD-3-Clause */
/* Model exchange. A trial state begins from the last completed step, which has what stops and turns
 * of angles remember; time, coordinates and inputs are set, and the solver makes it consistent, as
 * at the beginning of a run. So derivatives are a function of time, states and inputs, whatever
 * was asked before.
 *
 * Constraints that the joint coordinates leave are met by what is shown, not by the states x of
 * the caller: x' = f(P(x)), in which P moves onto the constraints. What errors of the caller do
 * across them has no effect of first order, and is taken away in an event once it is more than
 * DRIFT_MAX. */
#include "io/fmi/exchange.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/channel/event.h"
#include "io/fmi/states.h"

#define DRIFT_MAX 1e-4 /* of what is nominal */

enum { IN_EVENT = 1U << SE3DI_FMI_EVENT, IN_TIME = 1U << SE3DI_FMI_CONTINUOUS };

bool se3di_fmi_exchange_create(se3di_fmi_unit *u)
{
    const se3di_fmi_variables *v = &u->variables;
    if (v->states == 0) {
        return se3di_fmi_fail(u, "the unit is for co-simulation only: %s", v->reason);
    }
    se3di_fmi_exchange *e = se3di_iopool_alloc(&u->pool, sizeof *e);
    double *numbers =
        se3di_iopool_array(&u->pool, 4 * v->states + v->indicators + v->stops, sizeof *numbers);
    if (!e || !numbers) {
        return se3di_fmi_fail(u, "out of memory");
    }
    memset(e, 0, sizeof *e);
    e->x = numbers;
    e->dx = e->x + v->states;
    e->shown = e->dx + v->states;
    e->given = e->shown + v->states;
    e->signs = e->given + v->states;
    u->exchange = e;
    return true;
}

void se3di_fmi_exchange_drop(se3di_fmi_unit *u)
{
    if (u->exchange) {
        se3d_coordinates_destroy(u->exchange->coordinates);
        se3d_snapshot_destroy(u->exchange->base);
        u->exchange->coordinates = NULL;
        u->exchange->base = NULL;
    }
}

/* ---- the system and the states ----------------------------------------------------------------*/

/* Read what the system is at into `out`, or, if that is NULL, set it to `in`. */
static se3d_status pass_states(const se3di_fmi_unit *u, double *out, const double *in)
{
    se3d_system *system = u->model->system;
    se3d_coordinates *coordinates = u->exchange->coordinates;
    const size_t positions = u->variables.positions;
    const size_t first = positions + u->variables.velocities;
    se3d_status status = out ? se3d_coordinates_get(coordinates, out, out + positions)
                             : se3d_coordinates_set(coordinates, in, in + positions);
    for (size_t k = first; k < u->variables.states && status >= 0; ++k) {
        se3d_state state;
        status = se3d_system_get_state(system, k - first, &state);
        if (status >= 0) {
            status = out ? se3d_state_get_value(system, state, SE3D_STATE_VALUE, &out[k])
                         : se3d_state_set_value(system, state, in[k]);
        }
    }
    return status;
}

/* p' = p (0, w) / 2, w in the frame that p turns. */
static void turn(const double p[4], const double w[3], double rate[4])
{
    rate[0] = -0.5 * (p[1] * w[0] + p[2] * w[1] + p[3] * w[2]);
    rate[1] = 0.5 * (p[0] * w[0] + p[2] * w[2] - p[3] * w[1]);
    rate[2] = 0.5 * (p[0] * w[1] + p[3] * w[0] - p[1] * w[2]);
    rate[3] = 0.5 * (p[0] * w[2] + p[1] * w[1] - p[2] * w[0]);
}

/* Quaternions are those positions whose derivative is no velocity. */
static se3d_status differentiate_positions(se3di_fmi_unit *u)
{
    const se3di_fmi_variables *v = &u->variables;
    const double *velocities = u->exchange->shown + v->positions;
    const size_t derivative = v->state + v->states;
    for (size_t k = 0; k < v->velocities; ++k) {
        size_t component = 0;
        size_t at = 0;
        se3d_constraint joint;
        const se3d_status status = se3d_coordinates_get_entry(u->exchange->coordinates, k, &joint,
                                                              NULL, NULL, &component, &at);
        if (status < 0) {
            return status;
        }
        const size_t quaternion = joint.index1 ? at : at + 3;
        const size_t first = joint.index1 ? 0 : 3; /* velocity of the turning */
        if (component == 0 && joint.index1 == 0) {
            memcpy(u->exchange->dx + at, velocities + k, 3 * sizeof *velocities);
        }
        if (component == first && v->list[derivative + quaternion].component == 0) {
            turn(u->exchange->shown + quaternion, velocities + k, u->exchange->dx + quaternion);
        } else if (joint.index1 && v->list[derivative + at].component > 0) {
            u->exchange->dx[at + component] = velocities[k];
        }
    }
    return SE3D_OK;
}

static se3d_status differentiate(se3di_fmi_unit *u)
{
    se3d_system *system = u->model->system;
    const se3di_fmi_variables *v = &u->variables;
    double *dx = u->exchange->dx;
    const size_t first = v->positions + v->velocities;
    se3d_status status = pass_states(u, u->exchange->shown, NULL);
    status = status < 0 ? status : differentiate_positions(u);
    status = status < 0 ? status
                        : se3d_coordinates_compute_accelerations(u->exchange->coordinates, NULL,
                                                                 dx + v->positions);
    for (size_t k = first; k < v->states && status >= 0; ++k) {
        se3d_state state;
        status = se3d_system_get_state(system, k - first, &state);
        status = status < 0 ? status : se3d_state_get_rate(system, state, &dx[k]);
    }
    return status;
}

/* ---- stops ----
 * The speed with which an impact began is a state that jumps: it is that of the event in which the
 * stop was reached, or of the last step before. */

static double *impacts_of(const se3di_fmi_unit *u)
{
    return u->exchange->signs + u->variables.indicators;
}

static se3d_status write_impacts(const se3di_fmi_unit *u)
{
    se3d_status status = SE3D_OK;
    se3d_force stop;
    for (size_t k = 0; status >= 0 && se3di_fmi_find_stop(u->model, k, &stop); ++k) {
        status = se3d_force_set_parameter(u->model->system, stop, SE3D_FORCE_PARAMETER_IMPACT,
                                          impacts_of(u)[k]);
    }
    return status;
}

/* As the system has them; `begins`: those that have begun since the last event do so now. */
static se3d_status read_impacts(se3di_fmi_unit *u, bool begins)
{
    const se3d_system *system = u->model->system;
    se3d_status status = SE3D_OK;
    se3d_force stop;
    for (size_t k = 0; status >= 0 && se3di_fmi_find_stop(u->model, k, &stop); ++k) {
        double *impact = &impacts_of(u)[k];
        double ends[2] = {0.0, 0.0};
        double x = 0.0;
        double rate = 0.0;
        status = se3d_force_get_parameter(system, stop, SE3D_FORCE_PARAMETER_IMPACT, impact);
        se3d_force_get_parameter(system, stop, SE3D_FORCE_PARAMETER_LOWER, &ends[0]);
        se3d_force_get_parameter(system, stop, SE3D_FORCE_PARAMETER_UPPER, &ends[1]);
        status = status < 0 ? status : se3d_force_get_state(system, stop, &x, &rate, NULL);
        const bool is_outward = (x <= ends[0] && rate < 0.0) || (x >= ends[1] && rate > 0.0);
        *impact = begins && is_outward ? fabs(rate) : *impact;
    }
    return status;
}

static se3d_status keep(se3di_fmi_unit *u)
{
    se3d_snapshot *base = NULL;
    const se3d_status status = se3d_snapshot_create(u->model->system, &base);
    if (status >= 0) {
        se3d_snapshot_destroy(u->exchange->base);
        u->exchange->base = base;
    }
    return status;
}

static se3d_status begin(se3di_fmi_unit *u)
{
    se3di_fmi_exchange *e = u->exchange;
    se3d_status status = SE3D_OK;
    if (!e->coordinates) {
        status = se3d_coordinates_create(u->model->system, &e->coordinates);
    }
    status = status < 0 ? status : keep(u);
    status = status < 0 ? status : read_impacts(u, false);
    status = status < 0 ? status : differentiate(u);
    memcpy(e->x, e->shown, u->variables.states * sizeof *e->x);
    e->is_stale = false;
    e->is_drifted = false;
    return status;
}

/* 1, -1. A value that comes to zero has come to the other side, once (0.5, -0.5): a caller may find
 * the zero itself. At the beginning it is on none (0). */
static double sign_of(double value, double before)
{
    const double reached = fabs(before) < 1.0 ? before : -0.5 * before;
    return value > 0.0 ? 1.0 : value < 0.0 ? -1.0 : reached;
}

static bool get_indicators(se3di_fmi_unit *u, double *values)
{
    for (size_t k = 0; k < u->variables.indicators; ++k) {
        const se3d_status status = se3di_fmi_eval_indicator(u->model, k, &u->sample, &values[k]);
        if (status < 0) {
            return se3di_fmi_fail_system(u, u->variables.list[u->variables.indicator + k].name,
                                         status);
        }
    }
    return true;
}

bool se3di_fmi_exchange_begin(se3di_fmi_unit *u)
{
    const se3d_status status = begin(u);
    if (status < 0) {
        u->mode = SE3DI_FMI_FAILED;
        return se3di_fmi_fail_system(u, "the states at the beginning", status);
    }
    if (!get_indicators(u, u->exchange->signs)) {
        return false;
    }
    for (size_t k = 0; k < u->variables.indicators; ++k) {
        u->exchange->signs[k] = sign_of(u->exchange->signs[k], 0.0);
    }
    u->exchange->is_stale = true; /* the bits of a trial state, as they will be asked for again */
    return se3di_fmi_exchange_update(u);
}

static se3d_status apply_inputs(const se3di_fmi_unit *u)
{
    se3d_status status = SE3D_OK;
    for (size_t k = 0; k < u->variables.count && status >= 0; ++k) {
        if (u->given[k] && u->variables.list[k].role == SE3DI_FMI_INPUT) {
            status = se3di_fmi_apply_input(u->model, &u->variables.list[k], u->values[k]);
        }
    }
    return status;
}

static se3d_status try_state(se3di_fmi_unit *u)
{
    se3d_system *system = u->model->system;
    se3d_status status = se3d_snapshot_restore(u->exchange->base, system);
    status = status < 0 ? status : apply_inputs(u);
    status = status < 0 ? status : se3d_system_set_time(system, u->time);
    status = status < 0 ? status : pass_states(u, NULL, u->exchange->x);
    status = status < 0 ? status : write_impacts(u);
    status = status < 0 ? status : se3d_solver_set_shown(u->solver, SE3D_SHOWN_ALL);
    status = status < 0 ? status : se3d_solver_run(u->solver, u->time);
    return status < 0 ? status : differentiate(u);
}

bool se3di_fmi_exchange_update(se3di_fmi_unit *u)
{
    se3di_fmi_exchange *e = u->exchange;
    char what[100];
    if (!e->is_stale) {
        return true;
    }
    u->is_quiet = true;
    const se3d_status status = try_state(u);
    u->is_quiet = false;
    se3d_solver_get_stats(u->solver, &u->stats);
    se3di_sample_renew(&u->sample, &u->stats);
    if (status < 0) {
        u->is_discarded = status != SE3D_ERR_NO_MEMORY;
        snprintf(what, sizeof what, "no derivatives at t = %.9g s", u->time);
        return se3di_fmi_fail_system(u, what, status);
    }
    e->is_stale = false;
    return true;
}

bool se3di_fmi_exchange_get(se3di_fmi_unit *u, const se3di_fmi_variable *v, size_t reference,
                            double *value)
{
    if (v->role == SE3DI_FMI_INDICATOR) {
        const size_t k = reference - u->variables.indicator;
        const se3d_status status = se3di_fmi_eval_indicator(u->model, k, &u->sample, value);
        return status >= 0 || se3di_fmi_fail_system(u, v->name, status);
    }
    *value = (v->role == SE3DI_FMI_STATE ? u->exchange->x : u->exchange->dx)[v->element];
    return true;
}

void se3di_fmi_exchange_put(se3di_fmi_unit *u, const double *x)
{
    se3di_fmi_exchange *e = u->exchange;
    e->is_stale = e->is_stale || memcmp(e->x, x, u->variables.states * sizeof *x) != 0;
    memcpy(e->x, x, u->variables.states * sizeof *x);
}

bool se3di_fmi_exchange_resume(se3di_fmi_unit *u, se3d_snapshot *base, const double *numbers)
{
    se3di_fmi_exchange *e = u->exchange;
    se3d_status status = SE3D_OK;
    se3d_snapshot_destroy(e->base);
    e->base = base;
    if (!e->coordinates) {
        status = se3d_coordinates_create(u->model->system, &e->coordinates);
    }
    memcpy(e->x, numbers, u->variables.states * sizeof *numbers);
    memcpy(e->signs, numbers + u->variables.states,
           (u->variables.indicators + u->variables.stops) * sizeof *numbers);
    e->is_stale = true;
    e->is_drifted = false;
    return status >= 0 || se3di_fmi_fail_system(u, "the state cannot be put back", status);
}

size_t se3di_fmi_exchange_count(const se3di_fmi_unit *u)
{
    return u->variables.states + u->variables.indicators + u->variables.stops;
}

/* ---- calls ------------------------------------------------------------------------------------*/

static bool is_in(se3di_fmi_unit *u, unsigned modes, const char *call)
{
    u->is_discarded = false;
    return u->exchange ? se3di_fmi_is_in(u, modes, call)
                       : se3di_fmi_fail(u, "%s is for model exchange", call);
}

static bool has_count(se3di_fmi_unit *u, const void *values, size_t count, size_t right,
                      const char *what)
{
    return count == right && (values || count == 0)
               ? true
               : se3di_fmi_fail(u, "there is room for %zu %s, there are %zu", values ? count : 0,
                                what, right);
}

bool se3di_fmi_unit_discards(const se3di_fmi_unit *unit)
{
    return unit->is_discarded;
}

size_t se3di_fmi_unit_count_states(const se3di_fmi_unit *unit)
{
    return unit->variables.states;
}

size_t se3di_fmi_unit_count_indicators(const se3di_fmi_unit *unit)
{
    return unit->variables.indicators;
}

bool se3di_fmi_unit_set_time(se3di_fmi_unit *unit, double time)
{
    if (!is_in(unit, IN_EVENT | IN_TIME, "setting the time")) {
        return false;
    }
    if (!isfinite(time)) {
        return se3di_fmi_fail(unit, "the time is %g s, must be finite", time);
    }
    unit->exchange->is_stale = unit->exchange->is_stale || fabs(time - unit->time) > 0.0;
    unit->time = time;
    return true;
}

bool se3di_fmi_unit_set_states(se3di_fmi_unit *unit, const double *x, size_t count)
{
    const size_t states = unit->variables.states;
    if (!is_in(unit, IN_EVENT | IN_TIME, "setting states") ||
        !has_count(unit, x, count, states, "states")) {
        return false;
    }
    for (size_t k = 0; k < count; ++k) {
        if (!isfinite(x[k])) {
            return se3di_fmi_fail(unit, "%s is set to %g, must be finite",
                                  unit->variables.list[unit->variables.state + k].name, x[k]);
        }
    }
    se3di_fmi_exchange_put(unit, x);
    return true;
}

enum { READS = 1U << SE3DI_FMI_INITIALIZING | IN_EVENT | IN_TIME };

static bool can_read(se3di_fmi_unit *u, const void *values, size_t count, const char *what)
{
    return is_in(u, READS, "getting states, derivatives or indicators") &&
           has_count(u, values, count,
                     what[0] == 'i' ? u->variables.indicators : u->variables.states, what) &&
           se3di_fmi_refresh(u);
}

bool se3di_fmi_unit_get_states(se3di_fmi_unit *unit, double *x, size_t count)
{
    const bool begins = unit->mode == SE3DI_FMI_INITIALIZING;
    if (!is_in(unit, READS, "getting states") ||
        !has_count(unit, x, count, unit->variables.states, "states") ||
        (begins && !se3di_fmi_refresh(unit))) {
        return false;
    }
    memcpy(x, unit->exchange->x, count * sizeof *x);
    return true;
}

bool se3di_fmi_unit_get_nominals(se3di_fmi_unit *unit, double *x, size_t count)
{
    if (!is_in(unit, READS, "getting nominal values") ||
        !has_count(unit, x, count, unit->variables.states, "states")) {
        return false;
    }
    for (size_t k = 0; k < count; ++k) {
        x[k] = unit->variables.list[unit->variables.state + k].nominal;
    }
    return true;
}

bool se3di_fmi_unit_get_derivatives(se3di_fmi_unit *unit, double *dx, size_t count)
{
    if (!can_read(unit, dx, count, "states")) {
        return false;
    }
    memcpy(dx, unit->exchange->dx, count * sizeof *dx);
    return true;
}

bool se3di_fmi_unit_get_indicators(se3di_fmi_unit *unit, double *values, size_t count)
{
    return can_read(unit, values, count, "indicators") && get_indicators(unit, values);
}

bool se3di_fmi_unit_complete_step(se3di_fmi_unit *unit, bool *event)
{
    se3di_fmi_exchange *e = unit->exchange;
    if (!is_in(unit, IN_TIME, "completing a step") || !se3di_fmi_exchange_update(unit)) {
        return false;
    }
    se3d_status status = keep(unit);
    status = status < 0 ? status : read_impacts(unit, false);
    e->is_drifted = false;
    for (size_t k = 0; k < unit->variables.states; ++k) {
        const double size = unit->variables.list[unit->variables.state + k].nominal;
        e->is_drifted = e->is_drifted || fabs(e->x[k] - e->shown[k]) > DRIFT_MAX * size;
    }
    *event = e->is_drifted;
    return status >= 0 || se3di_fmi_fail_system(unit, "the step", status);
}

bool se3di_fmi_unit_enter_event(se3di_fmi_unit *unit)
{
    if (!is_in(unit, IN_TIME | IN_EVENT, "entering an event")) {
        return false;
    }
    unit->mode = SE3DI_FMI_EVENT;
    return true;
}

/* Whether event k of the model has happened, from the sign before. */
static bool has_happened(const se3di_fmi_unit *u, size_t k, double sign)
{
    const int32_t direction = u->model->events[k].direction;
    const double before = u->exchange->signs[k];
    return sign * before < 0.0 && (direction == SE3D_EVENT_ANY || direction * sign > 0.0);
}

/* Whether something changed its sign, and what of it the model wants to know. */
static bool see_events(se3di_fmi_unit *u, const double *values, bool *ends)
{
    bool found = false;
    char text[200];
    for (size_t k = 0; k < u->variables.indicators; ++k) {
        const double sign = sign_of(values[k], u->exchange->signs[k]);
        found = found || sign * u->exchange->signs[k] < 0.0;
        if (k < u->model->event_count && has_happened(u, k, sign)) {
            *ends = *ends || u->model->events[k].action == SE3D_EVENT_STOP;
            snprintf(text, sizeof text, "t = %.9g s: event %.100s", u->time,
                     u->model->events[k].name);
            if (u->tell) {
                u->tell(u->ctx, SE3D_LOG_INFO, text);
            }
        }
        u->exchange->signs[k] = sign;
    }
    return found;
}

/* At the state as it is: what happens, and where the next trial states begin from. */
static se3d_status take_event(se3di_fmi_unit *u, const double *values, bool *ends, bool *moved)
{
    se3di_fmi_exchange *e = u->exchange;
    const bool found = see_events(u, values, ends);
    se3d_status status = keep(u);
    status = status < 0 ? status : read_impacts(u, found);
    if (e->is_drifted) {
        memcpy(e->x, e->shown, u->variables.states * sizeof *e->x);
        *moved = true;
    }
    e->is_stale = e->is_stale || found || e->is_drifted;
    e->is_drifted = false;
    return status;
}

bool se3di_fmi_unit_update_event(se3di_fmi_unit *unit, bool *ends, bool *moved)
{
    *ends = false;
    *moved = false;
    if (!is_in(unit, IN_EVENT, "an event") || !se3di_fmi_exchange_update(unit)) {
        return false;
    }
    se3di_iopool pool;
    se3di_iopool_init(&pool, NULL);
    double *values = se3di_iopool_array(&pool, unit->variables.indicators + 1, sizeof *values);
    bool good = values ? get_indicators(unit, values) : se3di_fmi_fail(unit, "out of memory");
    if (good) {
        const se3d_status status = take_event(unit, values, ends, moved);
        good = status >= 0 || se3di_fmi_fail_system(unit, "the event", status);
    }
    se3di_iopool_destroy(&pool);
    return good && se3di_fmi_exchange_update(unit);
}

bool se3di_fmi_unit_enter_continuous(se3di_fmi_unit *unit)
{
    if (!is_in(unit, IN_EVENT, "leaving an event")) {
        return false;
    }
    unit->mode = SE3DI_FMI_CONTINUOUS;
    return true;
}
