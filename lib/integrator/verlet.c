/* SPDX-License-Identifier: BSD-3-Clause */
/* verlet: explicit, order 2, for contact and particles. Bodies move by the step of rattle with the
 * forces at predicted velocities (lie_verlet.h): positions and velocities meet their constraints at
 * every step. Particles move by velocity Verlet in the same loop: their contact forces are
 * evaluated once, with all positions at t_1 and all velocities in the middle of the step, and act
 * on the bodies with the same weights h/2 as on the particles, so that the momentum of all is kept.
 *
 * Between two steps of one run the half kicks of the particles are one pass.
 * docs/theory/verlet.md */
#include "contact/bodies/pace.h"
#include "expression/expression.h"
#include "integrator/kink_step.h"
#include "integrator/lie_verlet.h"
#include "math/steps.h"
#include "particles/sets.h"

#include <math.h>

static size_t work_count(const se3di_assembly *assembly)
{
    return se3di_lie_verlet_work_count(assembly) + 6 * (size_t)assembly->dense_count;
}

typedef struct verlet {
    se3di_lie_verlet bodies;
    se3di_model *model;
    se3di_error *error;
    double *push; /* of the particles on the bodies [dense bodies * 6] */
    double h;     /* of the last step, whose second half kick of the particles is `open` */
    int32_t open;
    int32_t moved; /* the particles were, in the step under way */
    int32_t keeps; /* they come back if it fails */
    int32_t reserved;
} verlet;

/* The user's own functions, and friction that jams, may fail with the particles moved: then these
 * are kept before each step. That costs as much as half a step of theirs, so it is not done for
 * what hardly ever fails. */
static int has_callbacks(const se3di_model *model)
{
    int has = model->contact.callback != NULL;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        has = has || model->forces[k].callback;
    }
    for (size_t k = 0; k < model->function_slots.count; ++k) {
        const se3d_expression *expression = model->functions[k].expression;
        has = has || model->functions[k].callback ||
              (expression && !se3di_expression_is_total(expression));
    }
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        has = has || model->constraints[k].callback;
    }
    return has;
}

static verlet begin(se3di_integration *integration)
{
    se3di_assembly *assembly = &integration->equations->assembly;
    verlet m = {.bodies = se3di_lie_verlet_begin(integration, 1),
                .model = assembly->model,
                .error = integration->equations->error,
                .push = integration->work + se3di_lie_verlet_work_count(assembly)};
    if (m.model->sets) {
        se3di_sets_push(m.model, m.push);
        assembly->push = m.push;
        m.keeps = has_callbacks(m.model) || m.bodies.friction.count > 0;
    }
    return m;
}

/* The particles have their velocities at the model's time. */
static void close_kick(verlet *m)
{
    if (m->open) {
        se3di_sets_kick(m->model, m->h);
        m->open = 0;
    }
}

/* The work of the particles on the bodies, beside that of the step in the audit. Their impulses at
 * the ends of a step are symmetric about the velocities there: the trapezoidal rule is exact. */
static void account(const verlet *m)
{
    double power = se3di_sets_power(m->model, m->push);
    m->model->work[1] += 0.5 * m->h * power; /* the other half: with the next step, from `power` */
    m->model->power[1] += power;
}

/* The first half of the step of the bodies, and what the particles have to know and to keep before
 * they move. */
static se3d_status begin_step(verlet *m)
{
    SE3DI_TRY(se3di_sets_aim(m->model, m->bodies.h, m->error));
    SE3DI_TRY(se3di_lie_verlet_drift(&m->bodies));
    SE3DI_TRY(se3di_contacts_reserve(m->model, m->bodies.t1, m->error)); /* no lack of it later */
    return m->keeps ? se3di_sets_keep(m->model, m->error) : SE3D_OK;
}

/* The particles to t1, and what they do to the bodies there; *contact as se3di_sets_forces has it.
 */
static se3d_status move_particles(verlet *m, double t1, se3d_status *contact)
{
    se3di_sets_move(m->model, m->open ? 2 : 1, m->bodies.h);
    m->moved = 1;
    const se3d_status status = se3di_sets_forces(m->model, t1, m->bodies.h, m->error, contact);
    se3di_sets_push(m->model, m->push);
    return status;
}

/* The second half of the step of the bodies. As the particles have moved already, nobody is asked
 * meanwhile whether the run is to end. */
static se3d_status finish_bodies(verlet *m)
{
    se3di_guard *const guard = m->bodies.equations->guard;
    if (guard) {
        ++guard->muted;
    }
    se3d_status status = se3di_lie_verlet_kick(&m->bodies);
    status = status < 0 ? status : se3di_lie_verlet_finish(&m->bodies);
    if (guard) {
        --guard->muted;
    }
    return status;
}

/* One step to t1 that leaves the last half kick of the particles open. Processes that share them
 * ask each other before these move, and before some of them come back. */
static se3d_status advance(verlet *m, double t1)
{
    se3di_lie_verlet *bodies = &m->bodies;
    bodies->h = t1 - m->model->time;
    if (!m->model->sets) {
        return se3di_lie_verlet_follow(bodies, bodies->h, t1);
    }
    bodies->t1 = t1;
    m->moved = 0;
    se3d_status contact = SE3D_OK;
    se3d_status status = se3di_equations_keep(bodies->equations);
    status = status < 0 ? status : begin_step(m);
    status = se3di_sets_settle(m->model, status, m->error);
    status = status < 0 ? status : move_particles(m, t1, &contact);
    status = status < 0 ? status : finish_bodies(m);
    status = m->keeps ? se3di_sets_settle(m->model, status, m->error) : status;
    const int comes_back = status < 0 && m->moved && m->keeps;
    if (m->moved && !comes_back) { /* else the kick before stays as it was */
        m->open = 1;
        m->h = bodies->h;
    }
    if (comes_back) {
        se3di_sets_come_back(m->model);
    }
    if (status < 0) {
        se3di_equations_come_back(bodies->equations);
        return status;
    }
    account(m);
    ++bodies->equations->counters.steps;
    return contact; /* the step is complete, and the last one */
}

static se3d_status finish(verlet *m, se3d_status status)
{
    status = se3di_sets_settle(m->model, status, m->error);
    close_kick(m);
    m->bodies.assembly->push = NULL;
    se3di_sets_end(m->model);
    return status;
}

/* Steps of `most`, equal ones if it was asked for, or shorter if bodies touch. */
static se3d_status run_steps(se3di_integration *integration, double t_end, double most, int asked)
{
    verlet m = begin(integration);
    se3d_status status = SE3D_OK;
    while (m.model->time < t_end && status >= 0 && status != SE3D_INFO_EVENT) {
        most = asked || m.model->sets ? most : integration->settings.step_most;
        double rest = t_end - m.model->time;
        double h = rest / se3di_steps_count(rest, most, t_end);
        status = se3di_equations_try_step(integration->equations, m.model->time);
        if (status >= 0 && asked) {
            status = se3di_contacts_check_step(m.model, SE3DI_PACE_EXPLICIT, h, m.error);
        } else if (status >= 0) {
            h = se3di_equal_steps_next(integration, most, t_end);
        }
        double t1 = rest > (1.0 + 1e-9) * h ? m.model->time + h : t_end;
        h = se3di_kink_step(integration, m.model->time, h, fmin(2.0 * h, rest), &t1);
        if (integration->at_kink) {
            break;
        }
        if (m.open && fabs(h - m.h) > 1e-9 * h) {
            close_kick(&m);
        }
        status = status < 0 ? status : se3di_watch_begin(integration->equations);
        status = status < 0 ? status : advance(&m, t1);
        if (status >= 0) {
            se3di_equal_steps_watch(integration, m.bodies.h);
        }
        status = status < 0 ? status : se3di_watch_end(integration->equations);
    }
    return finish(&m, status);
}

/* Accelerations and multipliers with the forces of the particles. */
static se3d_status accelerate(se3di_integration *integration)
{
    se3di_equations *equations = integration->equations;
    se3di_model *model = equations->assembly.model;
    SE3DI_TRY(se3di_sets_begin(model, 0.0, equations->error)); /* any step */
    (void)begin(integration);
    se3d_status status = se3di_acceleration_solve(equations, model->time);
    status = se3di_sets_settle(model, status, equations->error);
    equations->assembly.push = NULL;
    se3di_sets_end(model);
    return status;
}

static se3d_status start(se3di_integration *integration, double h)
{
    SE3DI_TRY(se3di_lie_verlet_start(integration, h));
    return integration->equations->assembly.model->sets ? accelerate(integration) : SE3D_OK;
}

static se3d_status step(se3di_integration *integration, double h)
{
    se3di_model *model = integration->equations->assembly.model;
    SE3DI_TRY(se3di_sets_begin(model, h, integration->equations->error));
    return run_steps(integration, model->time + h, h, 1);
}

static se3d_status run(se3di_integration *integration, double t_end)
{
    se3di_model *model = integration->equations->assembly.model;
    const double given = se3di_equal_steps_given(integration, model);
    double h = integration->settings.step > 0.0 ? given : integration->settings.step_most;
    h = given > 0.0 ? fmin(h, given) : h;
    double count = se3di_steps_count(t_end - model->time, h, t_end);
    if (count > SE3DI_STEPS_MOST) {
        return se3di_error_set(integration->equations->error, SE3D_ERR_STEP_COUNT,
                               "a step of %g s needs %g steps from t = %g s to %g s, must be at "
                               "most %g; try softer or heavier materials, or another step",
                               h, count, model->time, t_end, SE3DI_STEPS_MOST);
    }
    SE3DI_TRY(
        se3di_sets_begin(model, (t_end - model->time) / count, integration->equations->error));
    int asked = integration->settings.step > 0.0 || model->contact.step > 0.0;
    return run_steps(integration, t_end, h, asked);
}

const se3di_integrator se3di_integrator_verlet = {
    .name = "verlet",
    .tag = SE3D_METHOD_VERLET,
    .history_count = se3di_lie_verlet_history_count,
    .work_count = work_count,
    .start = start,
    .renew = se3di_lie_verlet_renew,
    .accelerate = accelerate,
    .step = step,
    .run = run,
    .chooses_step = 1,
    .get_reach = se3di_equal_steps_reach,
    .orders = 1u << 2,
    .weighs_bodies = 1,
    .moves_first = 1,
    .takes_particles = 1,
};
