/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/radau_lines.h"

#include "force/measure.h"
#include "math/inertia.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define STAGES SE3DI_RADAU_STAGES
#define STIFF  10.0 /* (frequency times step)^2, or decay times step, from which a force is so */

typedef struct line {
    double g[12];          /* at the second stage */
    double slope[2];       /* of n there; both 0: not stiff */
    double n[STAGES];      /* n^ */
    double excess[STAGES]; /* n - n^ */
} line;

#define LINE (sizeof(line) / sizeof(double))
_Static_assert(sizeof(line) == 20 * sizeof(double), "it is an array of double in the work");

/* Behind the lines: the excess of each. */
size_t se3di_radau_lines_count(const se3di_model *model)
{
    return (LINE + 1) * model->force_slots.count;
}

static line *line_of(const se3di_radau *m, size_t k)
{
    return (line *)(void *)m->lines + k;
}

static double *excess_of(const se3di_radau *m)
{
    return m->lines + LINE * m->assembly->model->force_slots.count;
}

static int is_stiff(const line *l)
{
    return l->slope[0] != 0.0 || l->slope[1] != 0.0;
}

static double dot(const double *a, const double *b, size_t count)
{
    double sum = 0.0;
    for (size_t k = 0; k < count; ++k) {
        sum += a[k] * b[k];
    }
    return sum;
}

/* n and g of an element at the state of the model; 0: it acts along no line. */
static int measure(const se3di_model *model, const se3di_force *force, double t, se3di_effect *at,
                   se3di_measure *measure, double *n, se3d_status *status)
{
    const int is_scalar = (se3di_force_class_of(force)->traits & SE3DI_FORCE_IS_SCALAR) != 0;
    if (!is_scalar || !se3di_measure_force(model, force, 0, measure)) {
        return 0;
    }
    at->wants_derivative = 0;
    *status = se3di_force_eval(model, force, t, at);
    const double square = dot(measure->g, measure->g, 12);
    *n = square > 0.0 ? -dot(at->wrench, measure->g, 12) / square : 0.0;
    return *status >= 0 && square > 0.0;
}

/* g M^-1 g^T of the free bodies. */
static double inverse_mass(const se3di_model *model, const se3di_force *force, const double g[12])
{
    const uint32_t bodies[2] = {force->body_i, force->body_j};
    double sum = 0.0;
    for (int k = 0; k < 2; ++k) {
        const se3di_body *body = &model->bodies[bodies[k]];
        const double *part = g + 6 * k;
        double J[9], turn[3];
        if (!body->fixed) {
            se3di_inertia_matrix(body->J, J);
            se3di_solve3(J, part + 3, turn);
            sum += se3di_dot(part, part) / body->mass + se3di_dot(part + 3, turn);
        }
    }
    return sum;
}

static se3d_status begin_lines(se3di_radau *m, int is_start, double t)
{
    const se3di_model *model = m->assembly->model;
    const double c = se3di_radau_gamma * m->h;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        line *l = line_of(m, k);
        se3di_effect at;
        se3di_measure x;
        se3d_status status = SE3D_OK;
        double n = 0.0;
        const int is_line = measure(model, force, t, &at, &x, &n, &status);
        SE3DI_TRY(status);
        if (is_start) {
            l->n[0] = l->n[1] = l->n[2] = n;
            continue;
        }
        memset(l->slope, 0, sizeof l->slope);
        if (is_line &&
            c * (c * at.slope[0] + at.slope[1]) * inverse_mass(model, force, x.g) > STIFF) {
            memcpy(l->g, x.g, sizeof l->g);
            memcpy(l->slope, at.slope, sizeof l->slope);
            m->has_lines = 1;
        }
    }
    return SE3D_OK;
}

se3d_status se3di_radau_lines_begin(se3di_radau *m)
{
    se3di_assembly *assembly = m->assembly;
    m->has_lines = 0;
    if (assembly->model->force_slots.count == 0) {
        return SE3D_OK;
    }
    se3di_state_set(assembly, m->Y + m->count);
    SE3DI_TRY(begin_lines(m, 0, m->t + se3di_radau_c[1] * m->h));
    if (!m->has_lines) {
        return SE3D_OK;
    }
    se3di_state_set(assembly, m->y0);
    SE3DI_TRY(begin_lines(m, 1, m->t));
    memset(excess_of(m), 0, assembly->model->force_slots.count * sizeof(double));
    return SE3D_OK;
}

se3d_status se3di_radau_lines_apply(se3di_radau *m, int stage, double t, double *b)
{
    const se3di_model *model = m->assembly->model;
    for (size_t k = 0; m->has_lines && k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        const uint32_t bodies[2] = {force->body_i, force->body_j};
        line *l = line_of(m, k);
        se3di_effect at;
        se3di_measure x;
        se3d_status status = SE3D_OK;
        double n = 0.0;
        if (!is_stiff(l) || !measure(model, force, t, &at, &x, &n, &status)) {
            SE3DI_TRY(status);
            continue;
        }
        l->excess[stage] = n - l->n[stage];
        for (size_t e = 0; e < 12; ++e) {
            const int32_t body = m->assembly->free_index[bodies[e / 6]];
            if (body >= 0) {
                b[6 * (size_t)body + e % 6] += l->excess[stage] * (x.g[e] - l->g[e]);
            }
        }
        if (stage == 1) {
            excess_of(m)[k] = l->excess[1];
        }
    }
    return SE3D_OK;
}

const double *se3di_radau_lines_excess(const se3di_radau *m)
{
    return m->has_lines ? excess_of(m) : NULL;
}

/* g . x of the bodies of the element. */
static double along(const se3di_radau *m, const se3di_force *force, const double g[12],
                    const double *x)
{
    const int32_t i = m->assembly->free_index[force->body_i];
    const int32_t j = m->assembly->free_index[force->body_j];
    return (i < 0 ? 0.0 : dot(g, x + 6 * (size_t)i, 6)) +
           (j < 0 ? 0.0 : dot(g + 6, x + 6 * (size_t)j, 6));
}

void se3di_radau_lines_correct(se3di_radau *m, double W[STAGES][STAGES])
{
    const se3di_model *model = m->assembly->model;
    const size_t n = m->assembly->unknown_count;
    const double c = se3di_radau_gamma * m->h;
    for (size_t k = 0; m->has_lines && k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        line *l = line_of(m, k);
        double impulse[STAGES], change[STAGES];
        for (size_t i = 0; i < STAGES && is_stiff(l); ++i) {
            impulse[i] = c * (l->slope[0] * along(m, force, l->g, m->uq + i * n) +
                              l->slope[1] * along(m, force, l->g, m->u + i * n)) +
                         m->h * dot(W[i], l->excess, STAGES);
        }
        if (is_stiff(l)) {
            se3di_radau_untransform(impulse, m->h, change);
            for (size_t i = 0; i < STAGES; ++i) {
                l->n[i] += change[i];
            }
        }
    }
}
