/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/state.h"

#include "assembly/energy.h"
#include "assembly/loads.h"
#include "assembly/user.h"
#include "contact/bodies/body_contacts.h"
#include "force/driver_rate.h"
#include "force/friction.h"
#include "force/measure.h"
#include "math/larger.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "model/state.h"
#include "nonlinear/against.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

/* A wider filter is asked for where the noise of accelerations near singular positions matters:
 * that of rows on the tree is larger, all of the violation being in few of them. */
#define ROWS_EPS 1.5e-10

/* Of the speed at which other points move: what is slower is measured by that. */
#define LEAST_PART 1e-4

#define UNIT 1e-9 /* that the square of Euler parameters may be off 1 */

size_t se3di_state_count(const se3di_assembly *assembly)
{
    return SE3DI_STATE_SIZE * (size_t)assembly->body_count + SE3DI_STATE_WORK;
}

void se3di_state_pack(const se3di_frame *frame, double *y)
{
    memcpy(y, frame->r, 3 * sizeof *y);
    memcpy(y + 3, frame->p, 4 * sizeof *y);
    memcpy(y + 7, frame->v, 3 * sizeof *y);
    memcpy(y + 10, frame->w, 3 * sizeof *y);
}

void se3di_state_get(const se3di_assembly *assembly, double *y)
{
    for (uint32_t k = 0; k < assembly->body_count; ++k, y += SE3DI_STATE_SIZE) {
        se3di_state_pack(&assembly->model->frames[assembly->free_body[k]], y);
    }
    memcpy(y, assembly->model->work, SE3DI_STATE_WORK * sizeof *y);
}

void se3di_state_set(se3di_assembly *assembly, const double *y)
{
    for (uint32_t k = 0; k < assembly->body_count; ++k, y += SE3DI_STATE_SIZE) {
        se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        memcpy(frame->r, y, 3 * sizeof *y);
        se3di_quat_normalize(y + 3, frame->p);
        memcpy(frame->v, y + 7, 3 * sizeof *y);
        memcpy(frame->w, y + 10, 3 * sizeof *y);
        se3di_frame_update(frame);
    }
}

void se3di_state_set_rates(se3di_assembly *assembly, const double *derivative)
{
    for (uint32_t k = 0; k < assembly->body_count; ++k, derivative += SE3DI_STATE_SIZE) {
        memcpy(assembly->model->acceleration + 6 * (size_t)assembly->free_body[k], derivative + 7,
               6 * sizeof *derivative);
    }
}

static int has_power(const se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    return model->force_slots.count > model->state_count || model->shape_slots.count > 1 ||
           assembly->timed_count > 0 || assembly->user_count > 0 ||
           se3di_model_gravity_varies(model);
}

se3d_status se3di_state_powers(se3di_assembly *assembly, double t, const double *l, double power[3])
{
    se3di_model *model = assembly->model;
    memset(power, 0, SE3DI_STATE_WORK * sizeof *power);
    if (!has_power(assembly)) {
        return SE3D_OK;
    }
    if (l && assembly->row_count > 0 && l != model->lambda) {
        memcpy(model->lambda, l, assembly->row_count * sizeof *l);
    }
    return se3di_loads_power(model, t, power);
}

se3d_status se3di_state_complete_powers(se3di_assembly *assembly, double t, const double *l,
                                        double power[3])
{
    se3di_model *model = assembly->model;
    if (l && assembly->row_count > 0 && l != model->lambda) {
        memcpy(model->lambda, l, assembly->row_count * sizeof *l);
    }
    static const double none[2] = {0.0, 0.0};
    const int may_touch = model->shape_slots.count > 1;
    power[2] = 0.0;
    return l || may_touch ? se3di_loads_complete_power(
                                model, t, may_touch ? assembly->contact_power : none, power)
                          : SE3D_OK;
}

/* All of a derivative but the powers. @return where these begin */
static double *put_rates(const se3di_assembly *assembly, const double *qddot, double *derivative)
{
    const se3di_model *model = assembly->model;
    size_t block = (size_t)assembly->formulation->block;
    double *out = derivative;
    for (uint32_t k = 0; k < assembly->body_count; ++k, out += SE3DI_STATE_SIZE) {
        const se3di_frame *frame = &model->frames[assembly->free_body[k]];
        memcpy(out, frame->v, 3 * sizeof *out);
        memcpy(out + 3, frame->pdot, 4 * sizeof *out);
        assembly->formulation->get_acceleration(frame, qddot + k * block, out + 7);
    }
    return out;
}

se3d_status se3di_state_derivative(se3di_assembly *assembly, double t, const double *qddot,
                                   const double *l, double *derivative)
{
    return se3di_state_powers(assembly, t, l, put_rates(assembly, qddot, derivative));
}

se3d_status se3di_state_derivative_of(se3di_equations *equations, double t, double *derivative)
{
    se3di_assembly *assembly = &equations->assembly;
    double *power = put_rates(assembly, equations->x, derivative);
    if (!has_power(assembly) || se3di_forces_have_memory(assembly->model)) {
        return se3di_state_powers(assembly, t, equations->l, power);
    }
    memcpy(power, assembly->power, sizeof assembly->power);
    return se3di_state_complete_powers(assembly, t, equations->l, power);
}

se3di_kkt_settings se3di_state_begin(se3di_equations *equations, double eps, double accuracy)
{
    se3di_kkt_settings before = se3di_kkt_get_settings(equations->kkt);
    se3di_kkt_settings settings = before;
    settings.eps = settings.eps_min = eps;
    settings.tolerance = fmax(settings.tolerance, accuracy);
    settings.always_check = false;
    settings.any_multipliers = !has_power(&equations->assembly);
    se3di_kkt_set_settings(equations->kkt, &settings);
    equations->takes_rows = equations->has_loops && !(eps > ROWS_EPS);
    const se3di_model *model = equations->assembly.model;
    const int needs_bodies =
        !equations->is_open_tree || model->left_out_count > model->broken_count;
    if (equations->assembly.formulation->block == 6 && needs_bodies) {
        se3di_assembly_eval_mass(&equations->assembly);
    }
    return before;
}

void se3di_state_begin_step(se3di_equations *equations, double redundant, int wide)
{
    se3di_kkt_settings settings = se3di_kkt_get_settings(equations->kkt);
    settings.redundant_rows = (int32_t)redundant;
    settings.wide = wide;
    se3di_kkt_set_settings(equations->kkt, &settings);
    if (equations->takes_rows) {
        se3di_tree_loops_filter(&equations->loops, &settings);
    }
    se3di_kkt_hold(equations->kkt, se3di_assembly_is_plain(&equations->assembly));
}

se3di_kkt_settings se3di_state_regularise(const se3di_assembly *assembly, se3di_kkt *kkt,
                                          double eps)
{
    const se3di_kkt_settings before = se3di_kkt_get_settings(kkt);
    se3di_kkt_settings settings = before;
    settings.eps = settings.eps_min = eps;
    settings.tolerance = 1e-8;
    settings.max_refinements = 1;
    settings.any_multipliers = !has_power(assembly);
    settings.iterated = true;
    se3di_kkt_set_settings(kkt, &settings);
    return before;
}

void se3di_state_end(se3di_equations *equations, const se3di_kkt_settings *settings)
{
    se3di_kkt_hold(equations->kkt, false);
    se3di_kkt_set_settings(equations->kkt, settings);
}

/* The solver keeps blocks that do not change. */
static void eval_mass(se3di_assembly *assembly)
{
    if (!se3di_assembly_is_plain(assembly)) {
        se3di_assembly_eval_mass(assembly);
    }
}

static se3d_status factor(se3di_equations *equations, double t)
{
    eval_mass(&equations->assembly);
    return se3di_equations_factor_values(equations, t, 0);
}

se3d_status se3di_state_evaluate(se3di_equations *equations, double t)
{
    SE3DI_TRY(se3di_assembly_eval_functions(&equations->assembly, t, equations->error));
    eval_mass(&equations->assembly);
    ++equations->counters.evaluations;
    SE3DI_TRY(se3di_equations_accelerate(equations, t, 0));
    return se3di_friction_system_finish(equations, t);
}

/* c = -Phi; returns the largest relative violation. */
static double eval_gap(se3di_equations *equations, double length)
{
    const se3di_assembly *assembly = &equations->assembly;
    double worst = 0.0;
    se3di_assembly_eval_phi(assembly, equations->c);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        double gap = fabs(equations->c[k]) / se3di_row_get_scale(assembly->model, k, length);
        worst = se3di_larger(worst, gap);
        equations->c[k] = -equations->c[k];
    }
    return worst;
}

static double rate_of(const se3di_state_scale *scale)
{
    return fmax(scale->speed / scale->length, scale->spin);
}

/* c = nu - Phi_q qdot; returns its largest part relative to the scales. */
static double eval_rate_gap(se3di_equations *equations, const se3di_state_scale *scale)
{
    const se3di_assembly *assembly = &equations->assembly;
    double rate = rate_of(scale);
    double worst = 0.0;
    se3di_assembly_get_velocity(assembly, equations->x);
    se3di_assembly_mul(assembly, equations->x, equations->c);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        equations->c[k] = assembly->f[3 * k + 1] - equations->c[k];
        double gap =
            fabs(equations->c[k]) / (rate * se3di_row_get_scale(assembly->model, k, scale->length));
        worst = se3di_larger(worst, gap);
    }
    return worst;
}

static void move(se3di_equations *equations)
{
    se3di_assembly *assembly = &equations->assembly;
    size_t block = (size_t)assembly->formulation->block;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        assembly->formulation->move(frame, equations->x + k * block);
        se3di_quat_normalize(frame->p, frame->p);
        se3di_frame_update(frame);
    }
}

static double largest_shift(const se3di_equations *equations, double length)
{
    const se3di_assembly *assembly = &equations->assembly;
    size_t block = (size_t)assembly->formulation->block;
    double largest = 0.0;
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        double size = fabs(equations->x[k]) / (k % block < 3 ? length : 1.0);
        largest = k % block == 7 || size <= largest ? largest : size;
    }
    return largest;
}

/* *is_factored: the Jacobian of the present positions is factored; and is it in the end. */
static se3d_status project_positions(se3di_equations *equations, double t,
                                     const se3di_state_scale *scale, double accuracy,
                                     int *is_factored)
{
    se3di_assembly *assembly = &equations->assembly;
    double moved = 0.0;
    double gap = eval_gap(equations, scale->length);
    for (int k = 0; k < 6 && gap > accuracy; ++k) {
        double before = gap;
        if (!*is_factored) {
            se3di_assembly_eval_jacobian(assembly);
            SE3DI_TRY(factor(equations, t));
            *is_factored = 1;
        }
        memset(equations->b, 0, assembly->unknown_count * sizeof *equations->b);
        SE3DI_TRY(se3di_equations_solve(equations));
        moved = se3di_larger(moved, largest_shift(equations, scale->length));
        if (!(moved < 0.5)) {
            return se3di_error_set(equations->error, SE3D_ERR_NO_CONVERGENCE,
                                   "t = %g s: the step leaves the constraints, it is too large", t);
        }
        move(equations);
        gap = eval_gap(equations, scale->length);
        *is_factored = gap < 1e-2 * before; /* else with a new Jacobian */
        if (!(gap < before)) {
            break;
        }
    }
    if (gap > fmax(1e-8, accuracy)) {
        return se3di_error_set(equations->error, SE3D_ERR_NO_CONVERGENCE,
                               "t = %g s: the positions did not converge: the constraints are off "
                               "by %.3g; the step is too large or the mechanism is locked",
                               t, gap);
    }
    return SE3D_OK;
}

se3d_status se3di_state_project_positions(se3di_equations *equations, double t,
                                          const se3di_state_scale *scale, double accuracy)
{
    int is_factored = 0;
    return project_positions(equations, t, scale, accuracy, &is_factored);
}

int se3di_state_has_rates(const se3di_equations *equations)
{
    return equations->assembly.user_count > 0 &&
           se3di_find_driver_rate(equations->assembly.model) != SE3DI_NO_INDEX;
}

se3d_status se3di_state_check_rates(se3di_equations *equations, double t,
                                    const se3di_state_scale *scale)
{
    if (!se3di_state_has_rates(equations)) {
        return SE3D_OK;
    }
    se3di_assembly_eval_jacobian(&equations->assembly);
    const double gap = eval_rate_gap(equations, scale);
    return se3di_against_check_rates(equations, t, gap, rate_of(scale), scale->length);
}

se3d_status se3di_state_project(se3di_equations *equations, double t,
                                const se3di_state_scale *scale, double accuracy, int is_factored)
{
    se3di_assembly *assembly = &equations->assembly;
    if (assembly->row_count == 0) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_assembly_eval_functions(assembly, t, equations->error));
    SE3DI_TRY(project_positions(equations, t, scale, accuracy, &is_factored));
    se3di_assembly_eval_jacobian(assembly);
    for (int k = 0; k < 3 && eval_rate_gap(equations, scale) > accuracy; ++k) {
        if (!is_factored) {
            SE3DI_TRY(factor(equations, t));
            is_factored = 1;
        }
        memset(equations->b, 0, assembly->unknown_count * sizeof *equations->b);
        SE3DI_TRY(se3di_equations_solve(equations));
        se3di_assembly_get_velocity(assembly, equations->b);
        for (uint32_t c = 0; c < assembly->unknown_count; ++c) {
            equations->b[c] += equations->x[c];
        }
        se3di_assembly_set_velocity(assembly, equations->b);
        if (se3di_state_has_rates(equations)) {
            se3di_assembly_eval_jacobian(assembly); /* rows of such drivers depend on velocities */
            is_factored = 0;
        }
    }
    return se3di_state_check_rates(equations, t, scale);
}

se3d_status se3di_state_measure_gap(se3di_equations *equations, double t,
                                    const se3di_state_scale *scale, double *gap)
{
    se3di_assembly *assembly = &equations->assembly;
    *gap = 0.0;
    if (assembly->row_count == 0) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_assembly_eval_functions(assembly, t, equations->error));
    const double positions = eval_gap(equations, scale->length);
    se3di_assembly_eval_jacobian(assembly);
    const double rates = eval_rate_gap(equations, scale);
    *gap = se3di_larger(rates, positions);
    return SE3D_OK;
}

void se3di_state_split_force(const se3di_assembly *assembly, const se3di_frame *frame,
                             const double *generalised, double force[3], double torque[3])
{
    se3di_copy(generalised, force);
    if (assembly->formulation->block == 6) {
        se3di_copy(generalised + 3, torque);
        return;
    }
    se3di_g_mul(frame->p, generalised + 3, torque); /* 2 G^T n is the force of a torque n */
    se3di_scale(0.5, torque, torque);
}

double se3di_state_part(const se3di_assembly *assembly, size_t k, const se3di_state_scale *scale,
                        const double change[6])
{
    const uint32_t body = assembly->free_body[k];
    if (assembly->model->bodies[body].state != 0) {
        return fabs(change[0]) / se3di_state_size(assembly->model, body);
    }
    return se3di_norm(change) / scale->speed + se3di_norm(change + 3) / scale->spin;
}

int se3di_state_is_carrier(const se3di_assembly *assembly, size_t k)
{
    return assembly->model->bodies[assembly->free_body[k]].state != 0;
}

double se3di_state_limit_turn(const se3di_model *model, double growth, double h)
{
    for (size_t k = 0; k < model->angle_count; ++k) {
        const se3di_term *term = &model->angles[k].term;
        double rate =
            se3di_norm(model->frames[term->body_i].w) + se3di_norm(model->frames[term->body_j].w);
        const double pace = rate + sqrt(rate * rate + 4.0 * growth);
        const double least = pace > 0.0 ? 2.0 * SE3DI_STATE_TURN / pace : h;
        h = h > least ? least : h;
    }
    return h;
}

/* The square of how far a point of a body is from its origin, if it is the larger one. */
static double farther(double square, uint32_t body, const double point[3])
{
    return body > 0 ? se3di_raised(square, se3di_dot(point, point)) : square;
}

/* Between points that belong to one body. */
double se3di_state_length(const se3di_model *model)
{
    double square = 0.0;
    for (size_t k = 0; k < model->term_count; ++k) {
        const se3di_term *term = &model->terms[k];
        square = farther(square, term->body_i, term->s_i);
        square = farther(square, term->body_j, term->s_j);
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        square = farther(square, force->body_i, force->s_i);
        square = farther(square, force->body_j, force->s_j);
    }
    double length = sqrt(square);
    for (size_t k = 0; k < model->body_slots.count && length == 0.0; ++k) {
        length = model->bodies[k].state == 0 ? se3di_norm(model->frames[k].r) : 0.0;
    }
    return length > 1e-9 ? length : 1.0;
}

/* Kinetic energy, what the acceleration makes of it on the way `length` and a turn of 1 rad, and a
 * little of what the applied forces could. */
static double body_energy(const se3di_assembly *assembly, uint32_t body, const double *derivative,
                          double length)
{
    const se3di_body *b = &assembly->model->bodies[body];
    const se3di_frame *frame = &assembly->model->frames[body];
    const double *wrench = assembly->wrench + 6 * (size_t)body;
    double J = se3di_raised(se3di_raised(b->J[0], b->J[1]), b->J[2]);
    double v2 = se3di_dot(frame->v, frame->v) + se3di_norm(derivative + 7) * length;
    double w2 = se3di_dot(frame->w, frame->w) + se3di_norm(derivative + 10);
    double applied = se3di_norm(wrench) * length + se3di_norm(wrench + 3);
    return 0.5 * (b->mass * v2 + J * w2) + 1e-3 * applied;
}

/* Squares of the rates that rolling would make of one another: a touch turns what came without spin
 * by about its speed over its size, and to an error estimate without a measure for spin that would
 * be a singularity. */
static void grow_by_shapes(const se3di_model *model, double *v, double *w)
{
    for (size_t k = 0; k < model->shape_slots.count; ++k) {
        const se3di_shape *shape = &model->shapes[k];
        const se3di_frame *frame = &model->frames[shape->body];
        const double size = shape->bound + se3di_norm(shape->x);
        if (shape->material >= 0 && size > 0.0 && size < HUGE_VAL) {
            *v = fmax(*v, se3di_dot(frame->w, frame->w) * size * size);
            *w = fmax(*w, se3di_dot(frame->v, frame->v) / (size * size));
        }
    }
}

/* If friction holds a mechanism at rest nothing moves but rounding: the scale is of what its
 * forces would move of the whole mass. */
static void grow_by_holds(const se3di_model *model, double *a, double *wdot)
{
    double mass = 0.0, J = 0.0;
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        const se3di_body *body = &model->bodies[k];
        const int moves = !body->fixed && body->state == 0;
        mass += !moves ? 0.0 : body->mass;
        J += !moves ? 0.0 : fmax(body->J[0], fmax(body->J[1], body->J[2]));
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        if (force->type == SE3DI_FORCE_FRICTION && se3di_friction_sticks(force)) {
            const double n = se3di_friction_get(model, force);
            se3di_measure measure;
            (void)se3di_measure_force(model, force, 0, &measure);
            *a = fmax(*a, n * n * se3di_dot(measure.g + 6, measure.g + 6) / (mass * mass));
            *wdot = fmax(*wdot, n * n * se3di_dot(measure.g + 9, measure.g + 9) / (J * J));
        }
    }
}

void se3di_state_scale_grow(const se3di_assembly *assembly, const double *derivative,
                            se3di_state_scale *scale)
{
    double a = 0.0, wdot = 0.0, v = 1e-12, w = 1e-12, energy = 1e-24;
    grow_by_shapes(assembly->model, &v, &w);
    if (se3di_forces_have_memory(assembly->model)) {
        grow_by_holds(assembly->model, &a, &wdot);
    }
    for (uint32_t k = 0; k < assembly->body_count; ++k, derivative += SE3DI_STATE_SIZE) {
        const se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        if (assembly->model->bodies[assembly->free_body[k]].state != 0) {
            continue;
        }
        v = se3di_raised(v, se3di_dot(frame->v, frame->v));
        w = se3di_raised(w, se3di_dot(frame->w, frame->w));
        a = se3di_raised(a, se3di_dot(derivative + 7, derivative + 7));
        wdot = se3di_raised(wdot, se3di_dot(derivative + 10, derivative + 10));
        energy += body_energy(assembly, assembly->free_body[k], derivative, scale->length);
    }
    const double squares[4] = {v, w, a, wdot};
    se3di_state_scale_take(squares, scale);
    scale->energy = fmax(0.95 * scale->energy, energy);
}

void se3di_state_scale_take(const double squares[4], se3di_state_scale *scale)
{
    double v = fmax(sqrt(squares[0]), sqrt(sqrt(squares[2]) * scale->length));
    double w = fmax(sqrt(squares[1]), sqrt(sqrt(squares[3])));
    /* centres of mass that stay where they are, or bodies that do not turn: their rounding is
     * measured by what moves */
    v = fmax(v, LEAST_PART * w * scale->length);
    w = fmax(w, LEAST_PART * v / scale->length);
    scale->speed = fmax(0.95 * scale->speed, v);
    scale->spin = fmax(0.95 * scale->spin, w);
}

/* Sums that overflow, and Euler parameters that vanish. */
static int is_finite(const se3di_frame *frame)
{
    const double *p = frame->p;
    const double square = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3];
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) {
        sum += 0.0 * (frame->r[k] + frame->v[k] + frame->w[k]);
    }
    return sum == 0.0 && fabs(square - 1.0) <= UNIT;
}

se3d_status se3di_state_check(const se3di_equations *equations, double t)
{
    const se3di_assembly *assembly = &equations->assembly;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const uint32_t body = assembly->free_body[k];
        if (!is_finite(&assembly->model->frames[body])) {
            const char *name = assembly->model->bodies[body].name;
            return se3di_error_set(equations->error, SE3D_ERR_NOT_FINITE,
                                   "t = %g s: the state of body %.80s is not finite", t,
                                   name ? name : "without a name");
        }
    }
    return SE3D_OK;
}

se3d_status se3di_state_prepare(se3di_equations *equations, double t)
{
    se3di_model *model = equations->assembly.model;
    SE3DI_TRY(se3di_user_report(model, equations->error));
    SE3DI_TRY(se3di_state_check(equations, t));
    return se3di_loads_prepare(model, t, equations->error);
}

/* Of what was integrated beside the frames. */
static void take_works(se3di_model *model, const double *work, double t)
{
    model->time = t;
    memcpy(model->work, work, sizeof model->work);
    model->work_valid = 1;
}

void se3di_state_conclude_step(se3di_equations *equations, const double *work, const double *power,
                               double t)
{
    se3di_model *model = equations->assembly.model;
    take_works(model, work, t);
    model->settled = SE3DI_SETTLED;
    if (power) {
        memcpy(model->power, power, sizeof model->power);
    }
}

se3d_status se3di_state_conclude(se3di_equations *equations, const double *work, double t)
{
    se3di_model *model = equations->assembly.model;
    take_works(model, work, t);
    model->settled = SE3DI_SETTLED;
    SE3DI_TRY(se3di_state_check(equations, t));
    return se3di_loads_power(model, t, model->power);
}

void se3di_state_take_motion(se3di_model *model, const double *work, double t)
{
    take_works(model, work, t);
    model->settled = SE3DI_SETTLED | SE3DI_LACKING;
}

se3d_status se3di_state_conclude_motion(se3di_equations *equations, const double *work, double t)
{
    se3di_state_take_motion(equations->assembly.model, work, t);
    return se3di_state_check(equations, t);
}

double se3di_state_rough(const se3di_model *model, int shows_motion, double tolerance)
{
    const int can = shows_motion && model->contacts.pair_count == 0 && !model->sets &&
                    !se3di_forces_have_memory(model);
    return can ? SE3DI_STATE_ROUGH * tolerance : 0.0;
}

se3d_status se3di_state_publish(se3di_equations *equations, const se3di_shown *shown)
{
    const double *work = shown->y + SE3DI_STATE_SIZE * (size_t)equations->assembly.body_count;
    se3di_state_set(&equations->assembly, shown->y);
    if (shown->project) {
        SE3DI_TRY(
            se3di_state_project(equations, shown->t, shown->scale, fmax(1e-15, shown->rough), 0));
    }
    if (shown->rough > 0.0) {
        se3di_angles_accept(equations->assembly.model);
        return se3di_state_conclude_motion(equations, work, shown->t);
    }
    SE3DI_TRY(se3di_acceleration_solve(equations, shown->t));
    se3di_contacts_renew_forces(equations->assembly.model);
    se3di_angles_accept(equations->assembly.model);
    return se3di_state_conclude(equations, work, shown->t);
}
