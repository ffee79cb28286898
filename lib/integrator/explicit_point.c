/* SPDX-License-Identifier: BSD-3-Clause */
/* The state of an explicit method in a step: its vectors, derivatives, scales of errors. */
#include "integrator/explicit_point.h"
#include "integrator/explicit_step.h"

#include "contact/bodies/body_contacts.h"
#include "integrator/motion.h"
#include "math/larger.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define BALANCE     8e-15 /* rounding of accelerations, relative to those of forces that balance */
#define ROUNDING    2e-15 /* of a velocity of one kind, relative to those of the other */
#define GAUSS_PART  0.3   /* of the tolerance, instead of SE3DI_EXPLICIT_PART, where all is plain */
#define WORK_WEIGHT 0.1   /* of the error of works: it disturbs nothing but the audit of energy */
#define WIDE        1e-8  /* regularisation of short steps */
#define BROAD       3e-9  /* of rk45, at this tolerance and above; below, it falls with the root */
#define BROAD_FROM  3e-7

#define VECTORS (3 + SE3DI_EXPLICIT_FORMS)

/* As motion->count has it. */
size_t se3di_explicit_history_count(const se3di_assembly *assembly)
{
    const int has_tree = assembly->tree_count > 0 &&
                         assembly->model->left_out_count == assembly->model->broken_count;
    const size_t count =
        has_tree ? assembly->tree_count + SE3DI_STATE_WORK : se3di_state_count(assembly);
    return SE3DI_EXPLICIT_PAST + VECTORS * count;
}

/* Work: that of the method, the state of a stage, what the force elements remember, and two changes
 * of the state as the bodies see them. */
size_t se3di_explicit_work_count(const se3di_assembly *assembly)
{
    const size_t memories = SE3DI_FORCE_STATES * assembly->model->force_slots.count;
    return (SE3DI_EXPLICIT_ROWS + 5) * se3di_state_count(assembly) + memories;
}

/* Local errors add up; what the user asks for is about the error of a run of some ten motions. Not
 * below what rounding allows. On open trees with nothing but plain forces the estimates of long
 * steps, which are of low orders, are far above the error: at 0.1 by three orders of magnitude;
 * those of gauss are at every tolerance. */
static double inner_tolerance(const se3di_integration *integration, int is_plain)
{
    const double tolerance = integration->settings.tolerance;
    const int is_gauss = integration->method->tag == SE3D_METHOD_GAUSS;
    const int is_loose = is_plain && tolerance > SE3DI_EXPLICIT_LOOSE;
    const double more = is_loose ? sqrt(tolerance / SE3DI_EXPLICIT_LOOSE) : 1.0;
    const double part = is_plain && is_gauss ? GAUSS_PART : SE3DI_EXPLICIT_PART;
    return fmax(part * more * tolerance, SE3DI_EXPLICIT_LEAST);
}

static int find_plain(const se3di_integration *integration, const se3di_motion *motion)
{
    const uint64_t tag = integration->method->tag;
    return (tag == SE3D_METHOD_GAUSS || tag == SE3D_METHOD_DOP853) &&
           motion->are_all_plain(integration->equations);
}

double se3di_gauss_get_reach(const se3di_integration *integration, const se3di_model *model)
{
    const se3di_equations *equations = integration->equations;
    const int is_built = equations && equations->assembly.model == model;
    const int is_plain = is_built && se3di_motion_find(equations)->are_all_plain(equations);
    return is_plain ? SE3DI_EXPLICIT_LEAST / GAUSS_PART : SE3DI_EXPLICIT_REACH;
}

/* See se3di_state_begin. The tightest tolerances need accelerations with less noise near singular
 * positions; elsewhere a wider filter costs steps and accuracy. The short steps of rk4 end within
 * a narrow one by the hundred, those of rk45 at loose tolerances often enough, and what they err by
 * there adds up in the velocity. */
static double regularisation(const se3di_integrator *method, int is_controlled, double tolerance)
{
    if (is_controlled && method->tag == SE3D_METHOD_RK4) {
        return WIDE;
    }
    const double eps = fmin(1e-9, fmax(1e-10, 1e-10 * (1e-11 / tolerance)));
    const int is_broad = is_controlled && method->tag == SE3D_METHOD_RK45;
    return is_broad ? fmax(eps, BROAD * sqrt(fmin(1.0, tolerance / BROAD_FROM))) : eps;
}

/* The violation of constraints that does not matter: near a singular position velocities magnify it
 * by the inverse of the distance, accelerations by its cube. */
static double projection_accuracy(double tolerance)
{
    return fmin(1e-13, fmax(1e-15, 1e-6 * tolerance));
}

se3di_explicit_past *se3di_explicit_past_of(const se3di_model *model)
{
    return (se3di_explicit_past *)(void *)model->history;
}

se3di_explicit se3di_explicit_point(const se3di_integration *integration)
{
    se3di_assembly *assembly = &integration->equations->assembly;
    const se3di_motion *motion = se3di_motion_find(integration->equations);
    const size_t count = motion->count(integration->equations);
    const size_t memories = SE3DI_FORCE_STATES * assembly->model->force_slots.count;
    const int is_plain = find_plain(integration, motion);
    double *history = assembly->model->history;
    double *memory = integration->work + (SE3DI_EXPLICIT_ROWS + 3) * count;
    const se3di_sums *avx2 = se3di_sums_avx2();
    return (se3di_explicit){
        .sums = avx2 ? avx2 : se3di_sums_portable(),
        .methods = integration->method->explicit_class,
        .tableau = integration->method->tableau,
        .motion = motion,
        .equations = integration->equations,
        .assembly = assembly,
        .count = count,
        .past = se3di_explicit_past_of(assembly->model),
        .y1 = history + SE3DI_EXPLICIT_PAST,
        .f1 = history + SE3DI_EXPLICIT_PAST + count,
        .y0 = history + SE3DI_EXPLICIT_PAST + 2 * count,
        .forms = history + SE3DI_EXPLICIT_PAST + 3 * count,
        .K = integration->work,
        .y = integration->work + SE3DI_EXPLICIT_ROWS * count,
        .sum = integration->work + (SE3DI_EXPLICIT_ROWS + 1) * count,
        .sum3 = integration->work + (SE3DI_EXPLICIT_ROWS + 2) * count,
        .memory = memory,
        .bodies = {memory + memories, memory + memories + se3di_state_count(assembly)},
        .is_plain = is_plain,
        .tolerance = inner_tolerance(integration, is_plain),
    };
}

se3di_explicit se3di_explicit_begin(se3di_integration *integration, int is_controlled)
{
    se3di_explicit m = se3di_explicit_point(integration);
    const double asked = integration->settings.tolerance;
    m.step.integration = integration;
    se3di_contacts_begin(m.assembly->model, 0.0, 1.0, 0);
    const double solved =
        fmin(m.tolerance, fmax(SE3DI_EXPLICIT_PART * asked, SE3DI_EXPLICIT_LEAST));
    const double eps = regularisation(integration->method, is_controlled, solved);
    m.kkt = se3di_state_begin(m.equations, eps, fmin(1e-6, 1e-3 * solved));
    m.is_bare = is_controlled && m.methods->is_bare && m.methods->is_bare(&m);
    return m;
}

const double *se3di_explicit_get_rates(const se3di_explicit *m)
{
    return m->motion->get_rates(m->equations, m->f1, m->bodies[0]);
}

/* Squares of the accelerations that a force and a torque (their squares) on a body would make. */
static void grow_sums(const se3di_body *body, double force, double torque, double sums[2])
{
    const double J = se3di_raised(se3di_raised(body->J[0], body->J[1]), body->J[2]);
    if (!body->fixed && body->state == 0) {
        sums[0] = se3di_raised(sums[0], force / (body->mass * body->mass));
        sums[1] = se3di_raised(sums[1], torque / (J * J));
    }
}

/* A contact's force is its stiffness times a difference of positions. */
static void grow_by_contact(const se3di_model *model, const se3di_body_contact *contact,
                            double sums[2])
{
    const uint32_t shapes[2] = {contact->shape_i, contact->shape_j};
    const double stiffness = se3di_contact_stiffness(model, contact);
    for (int k = 0; k < 2; ++k) {
        const uint32_t body = model->shapes[shapes[k]].body;
        double arm[3];
        se3di_sub(contact->point, model->frames[body].r, arm);
        const double size = se3di_dot(arm, arm);
        const double force =
            2.0 * stiffness * stiffness * (se3di_dot(contact->point, contact->point) + size);
        grow_sums(&model->bodies[body], force, force * size, sums);
    }
}

/* What is at rest as its forces balance is moved by the rounding of their sums: the accelerations
 * that these are parts of. */
static void grow_balance(se3di_explicit *m)
{
    const se3di_model *model = m->assembly->model;
    const double length = m->past->scale.length;
    double sums[2] = {se3di_dot(model->gravity, model->gravity), 0.0};
    for (size_t k = 0; k < m->assembly->body_count; ++k) {
        const size_t body = m->assembly->free_body[k];
        const double *wrench = m->assembly->wrench + 6 * body;
        const double force = se3di_dot(wrench, wrench);
        grow_sums(&model->bodies[body], force,
                  se3di_dot(wrench + 3, wrench + 3) + force * length * length, sums);
    }
    for (size_t k = 0; k < model->contacts.count; ++k) {
        grow_by_contact(model, &model->contacts.list[k], sums);
    }
    for (int c = 0; c < 2; ++c) {
        m->past->balance[c] = fmax(0.95 * m->past->balance[c], sqrt(sums[c]));
    }
}

const double *se3di_explicit_grow_scale(se3di_explicit *m)
{
    se3di_state_scale *scale = &m->past->scale;
    const double *rates = se3di_explicit_get_rates(m);
    se3di_state_scale_grow(m->assembly, rates, scale);
    scale->energy = fmax(scale->energy, m->past->energy_least);
    grow_balance(m);
    return rates;
}

void se3di_explicit_grow_bare_scale(se3di_explicit *m)
{
    const double *g = m->assembly->model->gravity;
    se3di_state_scale_take(m->squares, &m->past->scale);
    m->past->balance[0] = fmax(0.95 * m->past->balance[0], sqrt(se3di_dot(g, g)));
    m->past->balance[1] *= 0.95;
}

void se3di_explicit_combine(const se3di_explicit *m, const double *rows, const double *base,
                            double h, const double *coefficients, int limit, double *out)
{
    const double *stage[SE3DI_EXPLICIT_ROWS];
    double factor[SE3DI_EXPLICIT_ROWS];
    int used = 0;
    for (int k = 0; k < limit; ++k) {
        if (coefficients[k] != 0.0) {
            stage[used] = rows + (size_t)k * m->count;
            factor[used++] = h * coefficients[k];
        }
    }
    m->sums->combine(m->count, used, stage, factor, base, out);
}

se3d_status se3di_explicit_differentiate(se3di_explicit *m, double t, double *derivative)
{
    return m->motion->evaluate(m->equations, t, derivative);
}

se3d_status se3di_explicit_evaluate(se3di_explicit *m, double t, const double *y,
                                    double *derivative)
{
    return m->motion->evaluate_at(m->equations, t, y, derivative);
}

se3di_state_scale se3di_explicit_measure_by(const se3di_explicit *m)
{
    const double part = BALANCE / m->tolerance * m->h;
    se3di_state_scale scale = m->past->scale;
    scale.speed = se3di_raised(scale.speed, part * m->past->balance[0]);
    scale.spin = se3di_raised(scale.spin, part * m->past->balance[1]);
    return scale;
}

/* The same, and neither of the velocities below what rounding makes of the other. */
se3di_state_scale se3di_explicit_measure_both_by(const se3di_explicit *m)
{
    const se3di_state_scale own = se3di_explicit_measure_by(m);
    const double least = ROUNDING / m->tolerance;
    se3di_state_scale scale = own;
    scale.speed = se3di_raised(own.speed, least * own.spin * own.length);
    scale.spin = se3di_raised(own.spin, least * own.speed / own.length);
    return scale;
}

static double size_of(const se3di_state_scale *scale, const double parts[4],
                      const double work[SE3DI_STATE_WORK])
{
    const double r = sqrt(parts[0]) / scale->length + 2.0 * sqrt(parts[1]);
    const double v = sqrt(parts[2]) / scale->speed + sqrt(parts[3]) / scale->spin;
    const double e = se3di_norm(work) / scale->energy;
    return r + v + WORK_WEIGHT * e;
}

/* Body by body. */
static double size_on_bodies(const se3di_explicit *m, const double *error)
{
    double most[4] = {0.0, 0.0, 0.0, 0.0}, z = 0.0;
    const double *end = m->motion->spread(m->equations, error, m->bodies[0]);
    for (size_t k = 0; k < m->assembly->body_count; ++k, end += SE3DI_STATE_SIZE) {
        const double *e = end;
        if (se3di_state_is_carrier(m->assembly, k)) {
            const double part = se3di_state_part(m->assembly, k, &m->past->scale, e + 7);
            z = se3di_larger(z, part);
            continue;
        }
        double turn = e[3] * e[3] + e[4] * e[4] + e[5] * e[5] + e[6] * e[6];
        double parts[4] = {se3di_dot(e, e), turn, se3di_dot(e + 7, e + 7),
                           se3di_dot(e + 10, e + 10)};
        for (int c = 0; c < 4; ++c) {
            most[c] = se3di_larger(most[c], parts[c]);
        }
    }
    const se3di_state_scale scale = se3di_explicit_measure_both_by(m);
    return size_of(&scale, most, end) + z;
}

void se3di_explicit_sizes(const se3di_explicit *m, const double *const error[2], double size[2])
{
    double parts[2][4], states[2];
    const size_t work = m->count - SE3DI_STATE_WORK;
    if (m->motion->measure) {
        const se3di_state_scale scale = se3di_explicit_measure_both_by(m);
        m->motion->measure(m->equations, error, m->bodies[0], parts, states);
        for (int k = 0; k < 2; ++k) {
            size[k] = size_of(&scale, parts[k], error[k] + work) + states[k];
        }
        return;
    }
    for (int k = 0; k < 2; ++k) {
        size[k] = size_on_bodies(m, error[k]);
    }
}

double se3di_explicit_size(const se3di_explicit *m, const double *error)
{
    const double *const both[2] = {error, error};
    double sizes[2];
    if (!m->motion->measure) {
        return size_on_bodies(m, error);
    }
    se3di_explicit_sizes(m, both, sizes);
    return sizes[0];
}

double se3di_explicit_measure(const se3di_explicit *m, const double *error)
{
    return se3di_explicit_size(m, error) / m->tolerance;
}

double *se3di_explicit_end(const se3di_explicit *m)
{
    return m->K + (size_t)m->methods->get_end(m) * m->count;
}

se3d_status se3di_explicit_project(se3di_explicit *m, double t, int is_factored)
{
    return m->motion->project(m->equations, t, &m->past->scale, projection_accuracy(m->tolerance),
                              is_factored);
}

int se3di_explicit_is_too_large(const se3di_explicit *m, double error)
{
    return !(error <= 1.0) && isfinite(m->tolerance);
}
