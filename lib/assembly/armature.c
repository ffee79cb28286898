/* SPDX-License-Identifier: BSD-3-Clause */
#include "assembly/armature.h"

#include "base/sort.h"
#include "math/vec3.h"

#include <string.h>

static int is_armature(const se3di_model *model, size_t force)
{
    return model->forces[force].type == SE3DI_FORCE_ARMATURE;
}

void se3di_armatures_count(se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    assembly->armature_count = 0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        assembly->armature_count += (uint32_t)is_armature(model, k);
    }
}

/* The free bodies of an element, the smaller first; 0: one of them is fixed. */
static int find_pair(const se3di_assembly *assembly, const se3di_force *force, int32_t pair[2])
{
    const int32_t i = assembly->free_index[force->body_i], j = assembly->free_index[force->body_j];
    pair[0] = i < j ? i : j;
    pair[1] = i < j ? j : i;
    return pair[0] >= 0;
}

/* The place of a pair in the list, -1: it is not there. */
static int32_t place_of(const se3di_assembly *assembly, const int32_t pair[2])
{
    for (uint32_t k = 0; k < assembly->armature_pair_count; ++k) {
        if (memcmp(assembly->armature_pair + 2 * (size_t)k, pair, 2 * sizeof *pair) == 0) {
            return (int32_t)k;
        }
    }
    return -1;
}

static void drop_repeated(se3di_assembly *assembly)
{
    int32_t *pairs = assembly->armature_pair;
    uint32_t kept = 0;
    se3di_sort_tuples(pairs, assembly->armature_pair_count, 2);
    for (uint32_t k = 0; k < assembly->armature_pair_count; ++k) {
        const int32_t *pair = pairs + 2 * (size_t)k;
        if (kept == 0 || memcmp(pair - 2, pair, 2 * sizeof *pair) != 0) {
            memmove(pairs + 2 * (size_t)kept, pair, 2 * sizeof *pair);
            ++kept;
        }
    }
    assembly->armature_pair_count = kept;
}

void se3di_armatures_list(se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    uint32_t count = 0;
    int32_t pair[2];
    assembly->armature_pair_count = 0;
    for (uint32_t k = 0; k < model->force_slots.count; ++k) {
        if (is_armature(model, k)) {
            assembly->armature[count++].force = k;
            if (find_pair(assembly, &model->forces[k], pair)) {
                memcpy(assembly->armature_pair + 2 * (size_t)assembly->armature_pair_count, pair,
                       sizeof pair);
                ++assembly->armature_pair_count;
            }
        }
    }
    drop_repeated(assembly);
    for (uint32_t k = 0; k < count; ++k) {
        se3di_armature_place *a = &assembly->armature[k];
        a->pair =
            find_pair(assembly, &model->forces[a->force], pair) ? place_of(assembly, pair) : -1;
    }
}

void se3di_armature_eval(const se3di_assembly *assembly, uint32_t index, se3di_armature *out)
{
    const se3di_model *model = assembly->model;
    const se3di_force *force = &model->forces[assembly->armature[index].force];
    const se3di_frame *i = &model->frames[force->body_i], *j = &model->frames[force->body_j];
    se3di_term term;
    se3di_measure_begin(model, force, &term);
    memset(out->g, 0, sizeof out->g);
    assembly->formulation->jacobian(&term, i, j, out->g[0], out->g[1]);
    out->gamma = assembly->formulation->gamma(&term, i, j);
    out->inertia = force->value[0];
    out->body[0] = assembly->free_index[force->body_i];
    out->body[1] = assembly->free_index[force->body_j];
}

/* block [n x n] += s x y^T */
static void add_outer(double *block, size_t n, double s, const double *x, const double *y)
{
    for (size_t r = 0; r < n; ++r) {
        for (size_t c = 0; c < n; ++c) {
            block[n * r + c] += s * x[r] * y[c];
        }
    }
}

void se3di_armatures_add_mass(se3di_assembly *assembly)
{
    const size_t n = (size_t)assembly->formulation->block;
    const size_t pairs = assembly->armature_pair_count;
    memset(assembly->H_pair, 0, pairs * n * n * sizeof *assembly->H_pair);
    for (uint32_t k = 0; k < assembly->armature_count && !assembly->levels; ++k) {
        const int32_t pair = assembly->armature[k].pair;
        se3di_armature a;
        se3di_armature_eval(assembly, k, &a);
        for (int b = 0; b < 2; ++b) {
            if (a.body[b] >= 0) {
                add_outer(assembly->H + (size_t)a.body[b] * n * n, n, a.inertia, a.g[b], a.g[b]);
            }
        }
        if (pair >= 0) {
            const int first = a.body[0] < a.body[1] ? 0 : 1;
            add_outer(assembly->H_pair + (size_t)pair * n * n, n, a.inertia, a.g[first],
                      a.g[1 - first]);
        }
    }
}

/* out += s g^T */
static void add_along(const se3di_assembly *assembly, const se3di_armature *a, double s,
                      double *out)
{
    const size_t n = (size_t)assembly->formulation->block;
    for (int b = 0; b < 2; ++b) {
        for (size_t k = 0; a->body[b] >= 0 && k < n; ++k) {
            out[n * (size_t)a->body[b] + k] += s * a->g[b][k];
        }
    }
}

void se3di_armatures_add_terms(const se3di_assembly *assembly, double *b)
{
    for (uint32_t k = 0; k < assembly->armature_count; ++k) {
        se3di_armature a;
        se3di_armature_eval(assembly, k, &a);
        add_along(assembly, &a, a.inertia * a.gamma, b);
    }
}

void se3di_armatures_subtract(const se3di_assembly *assembly, const double *x, double *out)
{
    const size_t n = (size_t)assembly->formulation->block;
    for (uint32_t k = 0; k < assembly->armature_count; ++k) {
        se3di_armature a;
        double sum = 0.0;
        se3di_armature_eval(assembly, k, &a);
        for (int b = 0; b < 2; ++b) {
            for (size_t c = 0; a.body[b] >= 0 && c < n; ++c) {
                sum += a.g[b][c] * x[n * (size_t)a.body[b] + c];
            }
        }
        add_along(assembly, &a, -a.inertia * sum, out);
    }
}

void se3di_armatures_add_coupled(const se3di_assembly *assembly, double s, const double *x,
                                 double *out)
{
    const size_t n = (size_t)assembly->formulation->block;
    for (uint32_t p = 0; p < assembly->armature_pair_count; ++p) {
        const double *H = assembly->H_pair + n * n * (size_t)p;
        const size_t i = n * (size_t)assembly->armature_pair[2 * (size_t)p];
        const size_t j = n * (size_t)assembly->armature_pair[2 * (size_t)p + 1];
        for (size_t r = 0; r < n; ++r) {
            for (size_t c = 0; c < n; ++c) {
                out[i + r] += s * H[n * r + c] * x[j + c];
                out[j + c] += s * H[n * r + c] * x[i + r];
            }
        }
    }
}

double se3di_armatures_energy(const se3di_model *model)
{
    double energy = 0.0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        if (is_armature(model, k)) {
            se3di_measure measure;
            se3di_measure_gradient(model, &model->forces[k], &measure);
            energy += 0.5 * model->forces[k].value[0] * measure.rate * measure.rate;
        }
    }
    return energy;
}

/* xddot = g . vdot + u . H u */
void se3di_armature_effect(const se3di_model *model, const se3di_force *force,
                           const double acceleration[12], se3di_effect *effect)
{
    const double a = force->value[0];
    se3di_measure m;
    double change = se3di_measure_curve(model, force);
    (void)se3di_measure_force(model, force, 1, &m);
    memset(effect, 0, sizeof *effect);
    effect->wants_derivative = 1;
    for (int k = 0; k < 12; ++k) {
        change += m.g[k] * acceleration[k];
    }
    for (int r = 0; r < 12; ++r) {
        double position = 0.0, velocity = 0.0; /* d xddot: its largest parts */
        for (int c = 0; c < 12; ++c) {
            position += acceleration[c] * m.H[12 * c + r];
            velocity += m.u[c] * (m.H[12 * c + r] + m.H[12 * r + c]);
        }
        effect->wrench[r] = -a * change * m.g[r];
        for (int c = 0; c < 12; ++c) {
            effect->K[12 * c + r] -= a * (m.g[c] * position + change * m.H[12 * c + r]);
            effect->D[12 * c + r] -= a * m.g[c] * velocity;
        }
    }
}
