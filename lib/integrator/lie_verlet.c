/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/lie_verlet.h"

#include "assembly/energy.h"
#include "assembly/loads.h"
#include "contact/bodies/body_contacts.h"
#include "contact/bodies/met.h"
#include "integrator/state.h"
#include "math/elementary.h"
#include "math/inertia.h"
#include "math/larger.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "model/state.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

#define POSITION_ITERATIONS 60
#define TURN_MAX            3.0   /* rad, of a body in a step */
#define GAP_ROUNDING        1e-12 /* relative violation of a position equation */
#define GAP_CLOSED          1e-6  /* the largest that may be closed at the end of a step */
#define PART_LEAST          1e-8  /* of a step */
#define TURN_MOST           0.2   /* of velocities, that a step may change at once */
#define REST                1e-5  /* of the size or of a radian, in a step: hardly anything moves */
#define PARTS_TRIED         200   /* of one step; more changes are passed over in what is left */

size_t se3di_lie_verlet_history_count(const se3di_assembly *assembly)
{
    return SE3DI_EQUAL_HEADER + se3di_lie_friction_history_count(assembly->model);
}

size_t se3di_lie_verlet_work_count(const se3di_assembly *assembly)
{
    return 6 * (size_t)assembly->dense_count + 2 * (size_t)assembly->row_count +
           12 * (size_t)assembly->body_count + assembly->unknown_count +
           se3di_lie_friction_work_count(assembly->model);
}

se3d_status se3di_lie_verlet_start(se3di_integration *integration, double h)
{
    (void)h;
    se3di_model *model = integration->equations->assembly.model;
    memset(model->history, 0, SE3DI_EQUAL_HEADER * sizeof *model->history);
    se3di_lie_friction_start(model, model->history + SE3DI_EQUAL_HEADER);
    return SE3D_OK;
}

se3d_status se3di_lie_verlet_renew(se3di_integration *integration)
{
    se3di_model *model = integration->equations->assembly.model;
    se3di_lie_friction_start(model, model->history + SE3DI_EQUAL_HEADER);
    return SE3D_OK;
}

se3di_lie_verlet se3di_lie_verlet_begin(se3di_integration *integration, int force_iterations)
{
    se3di_assembly *assembly = &integration->equations->assembly;
    se3di_lie_verlet m = {.integration = integration,
                          .equations = integration->equations,
                          .assembly = assembly,
                          .force_iterations = force_iterations,
                          .wrench = integration->work};
    m.lambda = m.wrench + 6 * (size_t)assembly->dense_count;
    m.best = m.lambda + assembly->row_count;
    m.half = m.best + assembly->row_count;
    m.begin = m.half + 6 * (size_t)assembly->body_count;
    m.last = m.begin + 6 * (size_t)assembly->body_count;
    m.friction = se3di_lie_friction_begin(m.equations, m.last + assembly->unknown_count,
                                          assembly->model->history + SE3DI_EQUAL_HEADER);
    return m;
}

/* The transpose of the inverse derivative of exp at the turn x (length y^(1/2) < 2 pi):
 *
 *     m + s/2 x x m + c x x (x x m),   c(y) = (1 - z cot z)/y,  z = y^(1/2)/2
 *
 * Its c and dc/dy; by series if the difference cancels. */
static void turn_coefficients(double y, double *c, double *c_y)
{
    if (y < 0.06) {
        *c = 1.0 / 12 +
             y * (1.0 / 720 + y * (1.0 / 30240 + y * (1.0 / 1209600 + y * (1.0 / 47900160))));
        *c_y = 1.0 / 720 + y * (1.0 / 15120 + y * (1.0 / 403200 + y * (1.0 / 11975040)));
        return;
    }
    const double z = 0.5 * sqrt(y), cot = 1.0 / se3di_tan(z);
    *c = (1.0 - z * cot) / y;
    *c_y = (0.125 * (1.0 + cot * cot - cot / z) - *c) / y;
}

/* The momentum at the start (s = 1) or end (s = -1) of a turn x in which it is m in the mean. */
static void trivialised_momentum(const double m[3], const double x[3], double s, double out[3])
{
    double gyro[3], twice[3], c, c_y;
    turn_coefficients(se3di_dot(x, x), &c, &c_y);
    se3di_cross(x, m, gyro);
    se3di_cross(x, gyro, twice);
    for (int k = 0; k < 3; ++k) {
        out[k] = m[k] + 0.5 * s * gyro[k] + c * twice[k];
    }
}

/* d momentum(J x, x, 1) / d x */
static void momentum_derivative(const double J[9], const double m[3], const double x[3],
                                double D[9])
{
    double c, c_y, gyro[3], twice[3];
    const double y = se3di_dot(x, x), along = se3di_dot(x, m);
    const double X[9] = {0, -x[2], x[1], x[2], 0, -x[0], -x[1], x[0], 0};
    const double P[9] = {0, -m[2], m[1], m[2], 0, -m[0], -m[1], m[0], 0};
    double Jx[3];
    turn_coefficients(y, &c, &c_y);
    se3di_cross(x, m, gyro);
    se3di_cross(x, gyro, twice);
    se3di_mul(J, x, Jx); /* J is symmetric */
    for (int r = 0; r < 3; ++r) {
        for (int k = 0; k < 3; ++k) {
            double XJ = X[3 * r] * J[k] + X[3 * r + 1] * J[3 + k] + X[3 * r + 2] * J[6 + k];
            double XXJ = x[r] * Jx[k] - y * J[3 * r + k];
            D[3 * r + k] = J[3 * r + k] + 0.5 * (XJ - P[3 * r + k]) +
                           c * (XXJ + (r == k ? along : 0.0) + x[r] * m[k] - 2.0 * m[r] * x[k]) +
                           2.0 * c_y * twice[r] * x[k];
        }
    }
}

/* The turn x = h xi of a momentum h L at its start, and the mean momentum m = J x, by Newton. */
static se3d_status solve_turn(const double J[9], const double momentum[3], double x[3], double m[3])
{
    double before = HUGE_VAL;
    se3di_solve3(J, momentum, x);
    for (int iteration = 0; iteration < 50; ++iteration) {
        double f[3], D[9], dx[3];
        se3di_mul(J, x, m);
        if (!(se3di_dot(x, x) < TURN_MAX * TURN_MAX)) {
            return SE3D_ERR_NO_CONVERGENCE;
        }
        trivialised_momentum(m, x, 1.0, f);
        se3di_sub(momentum, f, f);
        momentum_derivative(J, m, x, D);
        se3di_solve3(D, f, dx);
        se3di_add(x, dx, x);
        double size = se3di_norm(dx), scale = se3di_norm(x);
        if (!isfinite(size)) {
            return SE3D_ERR_NOT_FINITE;
        }
        if (size <= 1e-15 * scale || (size <= 1e-12 * scale && size >= 0.5 * before)) {
            se3di_mul(J, x, m);
            return SE3D_OK;
        }
        before = size;
    }
    return SE3D_ERR_NO_CONVERGENCE;
}

/* The middle of the step of a free body, with the velocity that its frame has and the turn of the
 * step: its velocities, and what is kept for the end. */
static void set_half(se3di_lie_verlet *m, uint32_t free_body, const double turn[3],
                     const double mean[3])
{
    double *half = m->half + 6 * (size_t)free_body;
    se3di_frame *frame = &m->assembly->model->frames[m->assembly->free_body[free_body]];
    se3di_copy(frame->v, half);
    trivialised_momentum(mean, turn, -1.0, half + 3);
    se3di_scale(1.0 / m->h, half + 3, half + 3);
    se3di_scale(1.0 / m->h, turn, frame->w);
    se3di_frame_update(frame);
}

static se3d_status report_turn(const se3di_lie_verlet *m, uint32_t body, se3d_status status)
{
    const char *name = m->assembly->model->bodies[body].name;
    const double rate = se3di_norm(m->equations->saved[body].w);
    return se3di_error_set(m->equations->error, status,
                           "t = %g s: body %s turns too far in a step of %g s at %.3g rad/s; try a "
                           "step of at most %.3g s",
                           m->t1, name ? name : "without a name", m->h, rate,
                           fmin(1.0 / rate, 0.5 * fabs(m->h)));
}

/* q_1, v_h and L_1 without its last half kick, for the multipliers `lambda`; the frames hold q_0
 * before (equations->saved), q_1 and the velocities in the middle of the step after. */
static se3d_status drift(se3di_lie_verlet *m)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    const se3di_model *model = assembly->model;
    size_t block = (size_t)assembly->formulation->block;
    double h = m->h;
    memset(equations->b, 0, assembly->unknown_count * sizeof *equations->b);
    se3di_assembly_add_transposed(assembly, 1.0, m->lambda, equations->b);
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        uint32_t body = assembly->free_body[k];
        const se3di_frame *from = &equations->saved[body];
        se3di_frame *frame = &model->frames[body];
        double force[3], torque[3], momentum[3], J[9], turn[3], mean[3];
        se3di_state_split_force(assembly, from, equations->b + k * block, force, torque);
        se3di_inertia_matrix(model->bodies[body].J, J);
        se3di_mul(J, from->w, momentum);
        for (int c = 0; c < 3; ++c) {
            const double *applied = m->wrench + 6 * (size_t)body;
            frame->v[c] = from->v[c] + 0.5 * h * (applied[c] - force[c]) / model->bodies[body].mass;
            momentum[c] = h * (momentum[c] + 0.5 * h * (applied[3 + c] - torque[c]));
            frame->r[c] = from->r[c] + h * frame->v[c];
        }
        se3d_status status = solve_turn(J, momentum, turn, mean);
        if (status < 0) {
            return report_turn(m, body, status);
        }
        se3di_quat_rotate(from->p, turn, frame->p);
        se3di_quat_normalize(frame->p, frame->p);
        set_half(m, k, turn, mean);
    }
    return SE3D_OK;
}

/* The largest relative violation of the positions; `c` is what the multipliers have to change. */
static double eval_gap(se3di_lie_verlet *m)
{
    se3di_equations *equations = m->equations;
    const se3di_assembly *assembly = m->assembly;
    double worst = 0.0;
    se3di_assembly_eval_phi(assembly, equations->c);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        double gap = fabs(equations->c[k]) / se3di_row_get_scale(assembly->model, k, m->size);
        worst = se3di_larger(worst, gap);
        equations->c[k] *= 2.0 / (m->h * m->h);
    }
    return worst;
}

/* Near a singular position the constraint forces of q_0 have no leverage on some constraints at
 * q_1, or the opposite one if the step goes through it: what gap they leave there is closed
 * along the constraint forces of q_1, and the velocities follow the displacements. */
static se3d_status close_gap(se3di_lie_verlet *m)
{
    const se3di_model *model = m->assembly->model;
    const se3di_state_scale scale = {.length = m->size};
    SE3DI_TRY(drift(m));
    SE3DI_TRY(se3di_state_project_positions(m->equations, m->t1, &scale, GAP_ROUNDING));
    for (uint32_t k = 0; k < m->assembly->body_count; ++k) {
        uint32_t body = m->assembly->free_body[k];
        const se3di_frame *from = &m->equations->saved[body];
        se3di_frame *frame = &model->frames[body];
        double turn[3], J[9], mean[3];
        for (int c = 0; c < 3; ++c) {
            frame->v[c] = (frame->r[c] - from->r[c]) / m->h;
        }
        se3di_quat_log(from->p, frame->p, turn);
        se3di_inertia_matrix(model->bodies[body].J, J);
        se3di_mul(J, turn, mean);
        set_half(m, k, turn, mean);
    }
    return SE3D_OK;
}

/* lambda_0 with Phi(q_1) = 0: Newton with the matrix of q_0. */
static se3d_status solve_positions(se3di_lie_verlet *m)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    double before = HUGE_VAL;
    for (int iteration = 0; iteration < POSITION_ITERATIONS; ++iteration) {
        SE3DI_TRY(se3di_equations_ask(equations));
        SE3DI_TRY(drift(m));
        double gap = eval_gap(m);
        if (gap <= 1e-15 || (gap <= GAP_ROUNDING && gap >= 0.5 * before)) {
            return SE3D_OK;
        }
        if (!(gap < before)) {
            break;
        }
        before = gap;
        memset(equations->b, 0, assembly->unknown_count * sizeof *equations->b);
        SE3DI_TRY(se3di_equations_solve(equations));
        ++equations->counters.iterations;
        memcpy(m->best, m->lambda, assembly->row_count * sizeof *m->best);
        for (uint32_t k = 0; k < assembly->row_count; ++k) {
            m->lambda[k] -= equations->l[k];
        }
    }
    if (!(before <= GAP_CLOSED)) {
        return se3di_error_set(equations->error, SE3D_ERR_NO_CONVERGENCE,
                               "t = %g s: the positions did not converge in a step of %g s; try a "
                               "smaller step",
                               m->t1, m->h);
    }
    memcpy(m->lambda, m->best, assembly->row_count * sizeof *m->best);
    m->is_singular = 1;
    return close_gap(m);
}

/* The last half kick with the applied wrench of the present velocities. */
static void kick(se3di_lie_verlet *m)
{
    se3di_assembly *assembly = m->assembly;
    const se3di_model *model = assembly->model;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        uint32_t body = assembly->free_body[k];
        se3di_frame *frame = &model->frames[body];
        const double *half = m->half + 6 * (size_t)k;
        const double *applied = assembly->wrench + 6 * (size_t)body;
        double momentum[3], J[9];
        for (int c = 0; c < 3; ++c) {
            frame->v[c] = half[c] + 0.5 * m->h * applied[c] / model->bodies[body].mass;
            momentum[c] = half[3 + c] + 0.5 * m->h * applied[3 + c];
        }
        se3di_inertia_matrix(model->bodies[body].J, J);
        se3di_solve3(J, momentum, frame->w);
        se3di_quat_rate(frame->p, frame->w, frame->pdot);
    }
}

/* min |qdot - kicked|_M with Phi_q qdot = nu. */
static se3d_status project_velocities(se3di_lie_verlet *m)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    se3di_assembly_get_velocity(assembly, equations->x);
    se3di_assembly_mul_mass(assembly, equations->x, equations->b);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        equations->c[k] = assembly->f[3 * (size_t)k + 1];
    }
    SE3DI_TRY(se3di_equations_solve(equations));
    se3di_assembly_set_velocity(assembly, equations->x);
    return SE3D_OK;
}

/* How much an iteration has changed states, relative to their sizes. */
static double largest_state_change(const se3di_lie_verlet *m)
{
    const se3di_assembly *assembly = m->assembly;
    const size_t block = (size_t)assembly->formulation->block;
    double change = 0.0;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const uint32_t body = assembly->free_body[k];
        if (se3di_state_is_carrier(assembly, k)) {
            const double difference = m->equations->x[k * block] - m->last[k * block];
            change =
                se3di_larger(change, fabs(difference) / se3di_state_size(assembly->model, body));
        }
    }
    return change;
}

/* v_1 and w_1; iterated if forces depend on them. */
static se3d_status solve_velocities(se3di_lie_verlet *m)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    size_t unknowns = assembly->unknown_count;
    const size_t block = (size_t)assembly->formulation->block;
    for (int iteration = 0; iteration < m->force_iterations; ++iteration) {
        SE3DI_TRY(se3di_equations_ask(equations));
        SE3DI_TRY(se3di_assembly_eval_forces(assembly, m->t1, equations->b, equations->error));
        se3di_assembly_get_velocity(assembly, m->last);
        kick(m);
        SE3DI_TRY(project_velocities(m));
        if (m->friction.count > 0) {
            se3di_lie_friction_solve_velocities(&m->friction, m->h);
            se3di_lie_friction_add_wrenches(&m->friction);
            kick(m);
            SE3DI_TRY(project_velocities(m));
        }
        double change = 0.0, size = 0.0;
        const double state = largest_state_change(m);
        for (size_t k = 0; k < unknowns; ++k) {
            if (se3di_state_is_carrier(assembly, k / block)) {
                continue;
            }
            change = se3di_larger(change, fabs(equations->x[k] - m->last[k]));
            size = fmax(size, fabs(equations->x[k]));
        }
        if (!se3di_loads_are_stiff(assembly->model) || (change <= 1e-13 * size && state <= 1e-13)) {
            break;
        }
    }
    return SE3D_OK;
}

se3d_status se3di_lie_verlet_drift(se3di_lie_verlet *m)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    const se3di_model *model = assembly->model;
    SE3DI_TRY(se3di_met_reserve(m->assembly->model));
    se3di_contacts_begin(m->assembly->model, fmax(m->h, 0.0), 0.5, 1);
    se3di_equations_save(equations);
    if (assembly->row_count > 0) {
        memcpy(m->lambda, model->lambda, assembly->row_count * sizeof *m->lambda);
    }
    m->size = se3di_model_get_size(model);
    se3di_lie_friction_take(&m->friction);
    SE3DI_TRY(se3di_assembly_eval_forces(assembly, model->time, equations->b, equations->error));
    se3di_lie_friction_add_wrenches(&m->friction);
    memcpy(m->wrench, assembly->wrench, 6 * (size_t)assembly->dense_count * sizeof *m->wrench);
    const se3di_kkt_settings before =
        se3di_state_regularise(assembly, equations->kkt, SE3DI_STATE_REGULARISATION);
    se3d_status status = se3di_equations_factor(equations);
    status = status < 0 ? status : se3di_assembly_eval_functions(assembly, m->t1, equations->error);
    status = status < 0 ? status : solve_positions(m);
    se3di_kkt_set_settings(equations->kkt, &before);
    return status;
}

/* From the velocities in the middle of the step to those that they lead to at its end. */
static void predict_velocities(se3di_lie_verlet *m)
{
    for (uint32_t k = 0; k < m->assembly->body_count; ++k) {
        uint32_t body = m->assembly->free_body[k];
        const se3di_frame *from = &m->equations->saved[body];
        se3di_frame *frame = &m->assembly->model->frames[body];
        for (int c = 0; c < 3; ++c) {
            frame->v[c] = 2.0 * frame->v[c] - from->v[c];
            frame->w[c] = 2.0 * frame->w[c] - from->w[c];
        }
        se3di_quat_rate(frame->p, frame->w, frame->pdot);
    }
}

static se3d_status solve_accelerations(se3di_lie_verlet *m)
{
    se3di_equations *equations = m->equations;
    SE3DI_TRY(se3di_assembly_eval_forces(m->assembly, m->t1, equations->b, equations->error));
    se3di_assembly_eval_gamma(m->assembly, equations->c);
    ++equations->counters.evaluations;
    return se3di_lie_friction_solve_accelerations(&m->friction);
}

se3d_status se3di_lie_verlet_kick(se3di_lie_verlet *m)
{
    predict_velocities(m);
    se3di_contacts_look(m->assembly->model);
    SE3DI_TRY(se3di_equations_factor(m->equations));
    SE3DI_TRY(se3di_lie_friction_prepare(&m->friction));
    for (int iteration = 0; iteration < m->force_iterations + 1; ++iteration) {
        SE3DI_TRY(solve_velocities(m));
        SE3DI_TRY(solve_accelerations(m));
        if (se3di_lie_friction_change(&m->friction) <= 1e-12) {
            break;
        }
    }
    return SE3D_OK;
}

se3d_status se3di_lie_verlet_finish(se3di_lie_verlet *m)
{
    se3di_model *model = m->assembly->model;
    SE3DI_TRY(se3di_state_prepare(m->equations, m->t1));
    se3di_lie_friction_accept(&m->friction);
    model->time = m->t1;
    se3di_angles_accept(model);
    se3di_loads_accept(model);
    return se3di_work_accept(model, m->h);
}

/* What the velocities of the frames miss of v_0 + s a_0, over the largest ones, of rotation
 * (`is_spin`) or of translation. */
static double measure_turn(const se3di_lie_verlet *m, double s, int is_spin)
{
    const se3di_assembly *assembly = m->assembly;
    const double length = is_spin ? 1.0 : m->size;
    double worst = 0.0, most = REST * length / fabs(m->h);
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const uint32_t body = assembly->free_body[k];
        const se3di_frame *from = &m->equations->saved[body];
        const se3di_frame *frame = &assembly->model->frames[body];
        const double *before = is_spin ? from->w : from->v, *v = is_spin ? frame->w : frame->v;
        const double *a = m->begin + 6 * (size_t)k + 3 * (size_t)is_spin;
        double missed[3];
        if (se3di_state_is_carrier(assembly, k)) {
            continue;
        }
        for (int c = 0; c < 3; ++c) {
            missed[c] = v[c] - before[c] - s * a[c];
        }
        worst = se3di_larger(worst, se3di_norm(missed));
        most = fmax(most, fmax(se3di_norm(before), se3di_norm(v)));
    }
    return worst / most;
}

/* A step that closes a gap at a singular position may have left the branch of the motion there:
 * velocities then change at once. */
static se3d_status check_branch(const se3di_lie_verlet *m, double s)
{
    if (!m->is_singular ||
        (measure_turn(m, s, 0) <= TURN_MOST && measure_turn(m, s, 1) <= TURN_MOST)) {
        return SE3D_OK;
    }
    return se3di_error_set(m->equations->error, SE3D_ERR_NO_CONVERGENCE,
                           "t = %g s: a step of %g s leaves the motion: velocities change at once "
                           "at a singular position; try another step",
                           m->t1, m->h);
}

se3d_status se3di_lie_verlet_advance(se3di_lie_verlet *m)
{
    const se3di_assembly *assembly = m->assembly;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const double *a = assembly->model->acceleration + 6 * (size_t)assembly->free_body[k];
        memcpy(m->begin + 6 * (size_t)k, a, 6 * sizeof *a);
    }
    SE3DI_TRY(se3di_lie_verlet_drift(m));
    SE3DI_TRY(check_branch(m, 0.5 * m->h));
    SE3DI_TRY(se3di_lie_verlet_kick(m));
    SE3DI_TRY(check_branch(m, m->h));
    return se3di_lie_verlet_finish(m);
}

/* The place in a step at which accelerations jump, by halves. Next to a singular position they
 * change fast as well, but there shorter parts only come closer to it. */
typedef struct search {
    double whole, least; /* the step, and the shortest part [s] */
    double longest;      /* part that is tried next; the whole step: nothing is searched for */
    double rate;         /* of what the first part with the jump has missed */
    int32_t doubts;      /* the step may be smooth and only fast: its first half tells */
    int32_t tried, gives_up;
} search;

/* After a part of h that has missed so much; without a search `most` is allowed.
 * @return whether it is to be made again */
static int refuse(search *s, double h, double missed, double most)
{
    const int searches = s->longest < s->whole, doubts = s->doubts;
    const double first = s->rate * s->whole;
    s->doubts = 0;
    if (doubts && missed > 0.1 * first &&
        missed < 0.4 * first) { /* a quarter: it is watched elsewhere */
        s->gives_up = 1;
        s->longest = s->whole;
        return 1;
    }
    if (missed > (searches ? 1.0 : most) && h > s->least && !s->gives_up) {
        s->doubts = s->tried == 1 && most > 1.0;
        s->rate = searches ? s->rate : missed / h;
        s->longest = 0.5 * h;
        return 1;
    }
    const int passed = missed > 0.3 * s->rate * h || !(s->longest > s->least);
    s->longest = passed || !searches ? s->whole : 0.5 * s->longest; /* it is in the other half */
    return 0;
}

se3d_status se3di_lie_verlet_follow(se3di_lie_verlet *m, double h, double t1)
{
    const se3di_model *model = m->assembly->model;
    search s = {.whole = h, .least = PART_LEAST * h, .longest = h};
    m->h = h;
    m->t1 = t1;
    for (;;) {
        SE3DI_TRY(se3di_equations_keep(m->equations));
        m->is_singular = 0;
        const se3d_status status = se3di_lie_verlet_advance(m);
        s.gives_up |= ++s.tried >= PARTS_TRIED;
        if (status == SE3D_ERR_NO_CONVERGENCE && s.longest < s.whole) {
            se3di_equations_come_back(m->equations); /* though a longer one did */
            s.gives_up = 1;
            s.longest = s.whole;
        } else if (status < 0) {
            se3di_equations_come_back(m->equations);
            return status;
        } else {
            double most;
            const double missed = se3di_equal_steps_review(m->integration, m->h, &most);
            if (!m->is_singular && refuse(&s, m->h, missed, most)) {
                se3di_equations_come_back(m->equations);
            } else {
                ++m->equations->counters.steps;
            }
        }
        if (!(model->time < t1)) {
            return SE3D_OK;
        }
        m->t1 = t1 - model->time > (1.0 + 1e-9) * s.longest ? model->time + s.longest : t1;
        m->h = m->t1 - model->time;
    }
}
