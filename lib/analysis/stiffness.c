/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/stiffness.h"

#include "force/force.h"
#include "math/inertia.h"
#include "math/vec3.h"
#include "nonlinear/equations.h"

#include <math.h>
#include <string.h>

#define STIFF_RATIO                                                                                \
    2e4 /* of the rates: bodies that are held by joints decay more slowly than free ones */

#define HELD_RATIO  1e3 /* the same, of the rate of bodies that are held */
#define HELD_SOLVES 12  /* towards that rate, from below */
#define GOLDEN      0.6180339887498949

#define STEP_ANGLE 0.1 /* of the fastest oscillation in an explicit step [rad] */

/* The derivatives of an elastic element. @return false: it is none, or the analysis itself will say
 * why it cannot be evaluated. */
static int eval_elastic(const se3di_model *model, const se3di_force *force, se3di_effect *effect)
{
    effect->wants_derivative = 1;
    return (se3di_force_class_of(force)->traits & SE3DI_FORCE_IS_ELASTIC) &&
           se3di_force_eval(model, force, model->time, effect) >= 0;
}

/* Column c of J^-1 A_rr, A 6 x 6 of 12 x 12. */
static void solve_turning(const double J[9], const double *A, int c, double column[3])
{
    const double turning[3] = {A[12 * 3 + 3 + c], A[12 * 4 + 3 + c], A[12 * 5 + 3 + c]};
    se3di_solve3(J, turning, column);
}

/* tr(M^-1 D) of one body of an element, D 6 x 6 of 12 x 12 (minus the derivative of its wrench). */
static double body_rate(const se3di_body *body, const double *D)
{
    double J[9], column[3], rate = 0.0;
    if (body->fixed) {
        return 0.0;
    }
    se3di_inertia_matrix(body->J, J);
    for (int c = 0; c < 3; ++c) {
        solve_turning(J, D, c, column);
        rate -= D[13 * c] / body->mass + column[c];
    }
    return rate;
}

/* tr(M^-1 D) and tr(M^-1 K) of an element, 0 if it is none that is elastic. */
static void measure_element(const se3di_model *model, const se3di_force *force, double *rate,
                            double *square)
{
    const se3di_body *i = &model->bodies[force->body_i], *j = &model->bodies[force->body_j];
    se3di_effect effect;
    *rate = *square = 0.0;
    if (eval_elastic(model, force, &effect)) {
        *rate = body_rate(i, effect.D) + body_rate(j, effect.D + 6 * 13);
        *square = body_rate(i, effect.K) + body_rate(j, effect.K + 6 * 13);
    }
}

/* The largest over springs, dampers and bushings of tr(M^-1 D) or of sqrt tr(M^-1 K). */
static void measure(const se3di_model *model, double *decay, double *oscillation)
{
    *decay = *oscillation = 0.0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        double rate, square;
        measure_element(model, &model->forces[k], &rate, &square);
        *decay = rate > *decay ? rate : *decay; /* not if it is NaN */
        *oscillation = square > *oscillation * *oscillation ? sqrt(square) : *oscillation;
    }
}

double se3di_stiffness_vibration(const se3di_model *model, const se3di_force **force)
{
    double fastest = 0.0;
    *force = NULL;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        double rate, square;
        measure_element(model, &model->forces[k], &rate, &square);
        if (model->forces[k].type != SE3DI_FORCE_TYRE && square > fastest * fastest &&
            rate * rate < square) {
            fastest = sqrt(square);
            *force = &model->forces[k];
        }
    }
    return fastest;
}

double se3di_stiffness_step(const se3di_model *model)
{
    double decay, oscillation;
    measure(model, &decay, &oscillation);
    const double rate = decay + oscillation;
    return rate > 0.0 ? STEP_ANGLE / rate : HUGE_VAL; /* a host may trap divisions by 0 */
}

/* |A_tt| / m + |J^-1 A_rr| of one body of an element, A 6 x 6 of 12 x 12: unlike the trace it does
 * not vanish where what pulls along and what pushes across are alike. */
static double body_norm(const se3di_body *body, const double *A)
{
    double J[9], column[3], along = 0.0, about = 0.0;
    if (body->fixed) {
        return 0.0;
    }
    se3di_inertia_matrix(body->J, J);
    for (int c = 0; c < 3; ++c) {
        const double moving[3] = {A[c], A[12 + c], A[24 + c]};
        solve_turning(J, A, c, column);
        along += se3di_dot(moving, moving);
        about += se3di_dot(column, column);
    }
    return sqrt(along) / body->mass + sqrt(about);
}

double se3di_stiffness_angle(const se3di_model *model, double h)
{
    double angle = 0.0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        const se3di_body *i = &model->bodies[force->body_i], *j = &model->bodies[force->body_j];
        se3di_effect effect;
        if (!eval_elastic(model, force, &effect)) {
            continue;
        }
        const double decay = body_norm(i, effect.D) + body_norm(j, effect.D + 6 * 13);
        const double square = body_norm(i, effect.K) + body_norm(j, effect.K + 6 * 13);
        angle = fmax(angle, h * decay + h * sqrt(square));
    }
    return angle;
}

double se3di_stiffness_spin(const se3di_model *model)
{
    double spin = 0.0;
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        spin = fmax(spin, se3di_norm(model->frames[k].w));
    }
    return spin;
}

double se3di_stiffness_motion(const se3di_model *model)
{
    const double pendulum = sqrt(se3di_norm(model->gravity) / se3di_model_get_size(model));
    return fmax(fmax(se3di_stiffness_spin(model), pendulum), 1.0);
}

/* out -= D v of the six numbers of a body at `rows` by those of a body at `columns`. */
static void subtract_block(const se3di_assembly *assembly, const uint32_t body[2], const double *D,
                           const double *v, double *out)
{
    const int32_t row = assembly->free_index[body[0]], column = assembly->free_index[body[1]];
    for (int r = 0; row >= 0 && column >= 0 && r < 6; ++r) {
        for (int c = 0; c < 6; ++c) {
            out[6 * row + r] -= D[12 * r + c] * v[6 * column + c];
        }
    }
}

/* out = -(d wrench / d velocity) v of all elements that are elastic. */
static void resist(const se3di_assembly *assembly, const double *v, double *out)
{
    const se3di_model *model = assembly->model;
    memset(out, 0, assembly->unknown_count * sizeof *out);
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        se3di_effect effect;
        if (!eval_elastic(model, force, &effect)) {
            continue;
        }
        for (int b = 0; b < 4; ++b) {
            const int row = b / 2, column = b % 2;
            const uint32_t body[2] = {row ? force->body_j : force->body_i,
                                      column ? force->body_j : force->body_i};
            subtract_block(assembly, body, effect.D + 6 * (12 * row + column), v, out);
        }
    }
}

static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0.0;
    for (size_t k = 0; k < n; ++k) {
        sum += a[k] * b[k];
    }
    return sum;
}

/* The fastest decay that the constraints allow, by power iteration, until it is `enough`: its
 * Rayleigh quotients grow towards the largest. */
static se3d_status find_held_rate(se3di_equations *equations, double enough, double *rate)
{
    const se3di_assembly *assembly = &equations->assembly;
    const size_t n = assembly->unknown_count;
    double *v = equations->x, *b = equations->b;
    SE3DI_TRY(se3di_equations_factor(equations));
    memset(equations->c, 0, assembly->row_count * sizeof *equations->c);
    for (size_t k = 0; k < n; ++k) {
        const double turns =
            GOLDEN * (double)k; /* no two bodies are alike, however many there are */
        b[k] = 1.0 + turns - floor(turns);
    }
    for (int k = 0; k < HELD_SOLVES && !(*rate > enough); ++k) {
        SE3DI_TRY(se3di_equations_solve(equations));
        se3di_assembly_mul_mass(assembly, v, b);
        const double square = dot(v, b, n);
        if (!(square > 0.0 && isfinite(square))) {
            break;
        }
        for (size_t i = 0; i < n; ++i) {
            v[i] /= sqrt(square);
        }
        resist(assembly, v, b);
        *rate = dot(v, b, n);
    }
    return SE3D_OK;
}

se3d_status se3di_stiffness_is_stiff(se3di_model *model, se3di_error *error, int *is_stiff)
{
    double decay, oscillation, held = 0.0;
    measure(model, &decay, &oscillation);
    const double motion = se3di_stiffness_motion(model);
    *is_stiff = decay > STIFF_RATIO * motion;
    if (!*is_stiff || model->constraint_slots.count == 0) {
        return SE3D_OK;
    }
    se3di_equations equations;
    se3di_error own = {0}; /* what cannot be solved is for the analysis itself to say */
    SE3DI_TRY(se3di_equations_init(&equations, model, &se3di_formulation_romega, 0, error));
    equations.error = &own;
    const se3d_status status = find_held_rate(&equations, HELD_RATIO * motion, &held);
    se3di_equations_destroy(&equations);
    *is_stiff = status < 0 || held > HELD_RATIO * motion;
    return status == SE3D_ERR_NO_MEMORY ? status : SE3D_OK;
}
