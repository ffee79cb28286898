/* SPDX-License-Identifier: BSD-3-Clause */
#include "assembly/tangent.h"

#include "assembly/armature.h"
#include "assembly/convex.h"
#include "assembly/fused.h"
#include "assembly/left_out.h"
#include "assembly/loads.h"
#include "assembly/user.h"
#include "base/sort.h"
#include "force/measure.h"
#include "force/signal.h"
#include "force/tyre.h"
#include "math/inertia.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "model/state.h"
#include "primitive/user.h"

#include <stdlib.h>
#include <string.h>

#define COUPLED_BODIES 64

/* Couplings: every pair of free bodies that a force element or a term of a constraint joins; the
 * curvature of CD does not couple its bodies. */

static void note_pair(se3di_tangent *tangent, uint32_t dense_a, uint32_t dense_b, size_t *count)
{
    int32_t a = tangent->assembly->free_index[dense_a];
    int32_t b = tangent->assembly->free_index[dense_b];
    if (a < 0 || b < 0 || a == b) {
        return;
    }
    if (tangent->coupling) {
        tangent->coupling[2 * *count] = a < b ? a : b;
        tangent->coupling[2 * *count + 1] = a < b ? b : a;
    }
    ++*count;
}

/* How many free bodies have shapes; it stops if there are too many. */
static size_t count_bodies_with_shapes(const se3di_tangent *tangent)
{
    const se3di_model *model = tangent->assembly->model;
    size_t count = 0;
    for (size_t body = 0; body < model->body_slots.count && count <= COUPLED_BODIES; ++body) {
        int found = 0;
        for (size_t k = 0; k < model->shape_slots.count && !found; ++k) {
            found = model->shapes[k].body == body && model->shapes[k].material >= 0;
        }
        count += (size_t)(found && tangent->assembly->free_index[body] >= 0);
    }
    return count;
}

/* Free bodies that may touch. Beyond so many the coupling is left out of the Newton matrix, which
 * then converges more slowly: it would not be sparse. */
static void list_contacts(se3di_tangent *tangent, size_t *count)
{
    const se3di_model *model = tangent->assembly->model;
    uint32_t shapes = (uint32_t)model->shape_slots.count;
    if (count_bodies_with_shapes(tangent) > COUPLED_BODIES) {
        return;
    }
    for (uint32_t b = 1; b < shapes; ++b) {
        uint32_t noted = SE3DI_NO_INDEX; /* a body: its shapes often follow one another */
        for (uint32_t a = 0; a < b; ++a) {
            if (model->shapes[a].body != noted && se3di_shapes_may_touch(model, a, b)) {
                noted = model->shapes[a].body;
                note_pair(tangent, noted, model->shapes[b].body, count);
            }
        }
    }
}

/* Bodies of a force element with those that its functions depend on. */
static void note_signals(se3di_tangent *tangent, const se3di_force *force, size_t *count)
{
    const se3di_model *model = tangent->assembly->model;
    for (int c = 0; c < 3; ++c) {
        const se3di_function *function =
            force->function[c] >= 0 ? &model->functions[force->function[c]] : NULL;
        const uint32_t leaves = function ? se3di_law_count_leaves(model, function) : 0;
        for (uint32_t s = 0; s < leaves; ++s) {
            uint32_t bodies[2];
            se3di_signal_bodies(model, se3di_law_get_leaf(model, function, s), bodies);
            for (size_t k = 0; k < 4; ++k) {
                note_pair(tangent, k < 2 ? force->body_i : force->body_j, bodies[k % 2], count);
            }
        }
    }
}

/* The bodies of a tyre with the state of its slip that lags. */
static void note_lag(se3di_tangent *tangent, const se3di_force *state, size_t *count)
{
    if (state->tyre_index >= 0) {
        const se3di_force *tyre = &tangent->assembly->model->forces[state->tyre_index];
        note_pair(tangent, tyre->body_i, state->body_j, count);
        note_pair(tangent, tyre->body_j, state->body_j, count);
    }
}

/* Count the pairs, and write them if there is room. */
static size_t list_pairs(se3di_tangent *tangent)
{
    const se3di_model *model = tangent->assembly->model;
    size_t count = 0;
    list_contacts(tangent, &count);
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        note_pair(tangent, model->forces[k].body_i, model->forces[k].body_j, &count);
        note_signals(tangent, &model->forces[k], &count);
        note_lag(tangent, &model->forces[k], &count);
    }
    for (size_t k = 0; k < model->term_count; ++k) {
        if (model->terms[k].type != SE3DI_PRIMITIVE_CD) {
            note_pair(tangent, model->terms[k].body_i, model->terms[k].body_j, &count);
        }
    }
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        const se3di_constraint *constraint = &model->constraints[k];
        for (uint32_t b = 1; se3di_is_user(constraint) && b < constraint->body_count; ++b) {
            for (uint32_t a = 0; a < b; ++a) {
                note_pair(tangent, constraint->bodies[a], constraint->bodies[b], &count);
            }
        }
    }
    return count;
}

static int compare_pairs(const void *a, const void *b)
{
    const int32_t *x = a;
    const int32_t *y = b;
    int first = (x[0] > y[0]) - (x[0] < y[0]);
    return first ? first : (x[1] > y[1]) - (x[1] < y[1]);
}

static size_t remove_duplicates(int32_t *pairs, size_t count)
{
    size_t kept = 0;
    se3di_sort_tuples(pairs, count, 2);
    for (size_t k = 0; k < count; ++k) {
        if (kept == 0 || compare_pairs(pairs + 2 * k, pairs + 2 * (kept - 1)) != 0) {
            memmove(pairs + 2 * kept, pairs + 2 * k, 2 * sizeof *pairs);
            ++kept;
        }
    }
    return kept;
}

#define TANGENT_ARRAYS 9
#define BODY_ARRAYS    3 /* the first, of bodies; the others of couplings */

static void list_arrays(se3di_tangent *t, double **list[TANGENT_ARRAYS],
                        size_t count[TANGENT_ARRAYS])
{
    size_t block = (size_t)t->assembly->formulation->block;
    double **arrays[TANGENT_ARRAYS] = {&t->M,       &t->K,       &t->D,
                                       &t->K_upper, &t->K_lower, &t->D_upper,
                                       &t->D_lower, &t->M_upper, &t->M_lower};
    for (int k = 0; k < TANGENT_ARRAYS; ++k) {
        list[k] = arrays[k];
        count[k] = (k < BODY_ARRAYS ? t->assembly->body_count : t->coupling_count) * block * block;
        count[k] = k < 7 || t->assembly->armature_count > 0 ? count[k] : 0;
    }
}

/* The coupling of two free bodies, -1: there is none. */
static int32_t find_pair(const se3di_tangent *tangent, int32_t a, int32_t b)
{
    const int32_t pair[2] = {a < b ? a : b, a < b ? b : a};
    const int32_t *found =
        bsearch(pair, tangent->coupling, tangent->coupling_count, sizeof pair, compare_pairs);
    return found ? (int32_t)((found - tangent->coupling) / 2) : -1;
}

static void find_joint_pairs(se3di_tangent *tangent)
{
    const se3di_assembly *assembly = tangent->assembly;
    for (uint32_t k = 0; k < assembly->constraint_count; ++k) {
        const int32_t *body = assembly->joint_body + assembly->joint_begin[k];
        const int is_pair = assembly->joint_begin[k + 1] - assembly->joint_begin[k] == 2;
        tangent->joint_pair[k] =
            assembly->is_fused[k] && is_pair ? find_pair(tangent, body[0], body[1]) : -1;
    }
}

static se3d_status allocate(se3di_tangent *tangent)
{
    const se3d_allocator *allocator = &tangent->assembly->model->allocator;
    double **arrays[TANGENT_ARRAYS];
    size_t counts[TANGENT_ARRAYS];
    tangent->coupling_capacity = list_pairs(tangent);
    tangent->coupling =
        se3di_alloc(allocator, 2 * tangent->coupling_capacity, sizeof *tangent->coupling);
    tangent->joint_pair =
        se3di_alloc(allocator, tangent->assembly->constraint_count, sizeof *tangent->joint_pair);
    tangent->is_filled = se3di_alloc(allocator, tangent->coupling_capacity, 1);
    if (!tangent->coupling || !tangent->joint_pair || !tangent->is_filled) {
        return SE3D_ERR_NO_MEMORY;
    }
    (void)list_pairs(tangent);
    tangent->coupling_count = remove_duplicates(tangent->coupling, tangent->coupling_capacity);
    find_joint_pairs(tangent);
    list_arrays(tangent, arrays, counts);
    for (int k = 0; k < TANGENT_ARRAYS; ++k) {
        *arrays[k] = se3di_alloc(allocator, counts[k], sizeof(double));
        if (!*arrays[k]) {
            return SE3D_ERR_NO_MEMORY;
        }
    }
    memset(tangent->is_filled, 1, tangent->coupling_capacity); /* with whatever was there */
    return SE3D_OK;
}

se3d_status se3di_tangent_init(se3di_tangent *tangent, const se3di_assembly *assembly)
{
    *tangent = (se3di_tangent){.assembly = assembly};
    se3d_status status = allocate(tangent);
    if (status < 0) {
        se3di_tangent_destroy(tangent);
    }
    return status;
}

void se3di_tangent_destroy(se3di_tangent *tangent)
{
    if (!tangent->assembly) {
        return;
    }
    const se3d_allocator *allocator = &tangent->assembly->model->allocator;
    double **arrays[TANGENT_ARRAYS];
    size_t counts[TANGENT_ARRAYS];
    list_arrays(tangent, arrays, counts);
    for (int k = 0; k < TANGENT_ARRAYS; ++k) {
        se3di_free(allocator, *arrays[k], counts[k], sizeof(double));
    }
    se3di_free(allocator, tangent->coupling, 2 * tangent->coupling_capacity,
               sizeof *tangent->coupling);
    se3di_free(allocator, tangent->joint_pair, tangent->assembly->constraint_count,
               sizeof *tangent->joint_pair);
    se3di_free(allocator, tangent->is_filled, tangent->coupling_capacity, 1);
    memset(tangent, 0, sizeof *tangent);
}

/* The block of (row body, column body) of K (which = 0) or D; NULL: a body is fixed. */
static double *find_block(const se3di_tangent *tangent, int which, int32_t row, int32_t column)
{
    size_t n = (size_t)tangent->assembly->formulation->block;
    if (row < 0 || column < 0) {
        return NULL;
    }
    if (row == column) {
        return (which ? tangent->D : tangent->K) + (size_t)row * n * n;
    }
    const int32_t pair = find_pair(tangent, row, column);
    if (pair < 0) { /* CD, or a contact of one of very many bodies */
        return NULL;
    }
    double *upper = which ? tangent->D_upper : tangent->K_upper;
    double *lower = which ? tangent->D_lower : tangent->K_lower;
    tangent->is_filled[pair] = 1;
    return (row < column ? upper : lower) + (size_t)pair * n * n;
}

/* M of the couplings of armatures, beside its blocks of bodies; `n` of the block. */
static void add_armature_mass(se3di_tangent *tangent, const se3di_armature *a, size_t n)
{
    const int32_t pair =
        a->body[0] >= 0 && a->body[1] >= 0 ? find_pair(tangent, a->body[0], a->body[1]) : -1;
    for (size_t e = 0; e < n * n; ++e) {
        const size_t r = e / n, c = e % n;
        for (int b = 0; b < 2; ++b) {
            if (a->body[b] >= 0) {
                tangent->M[(size_t)a->body[b] * n * n + e] += a->inertia * a->g[b][r] * a->g[b][c];
            }
        }
        if (pair >= 0) {
            const int first = a->body[0] < a->body[1] ? 0 : 1;
            const double *g = a->g[first], *other = a->g[1 - first];
            tangent->is_filled[pair] = 1;
            tangent->M_upper[(size_t)pair * n * n + e] += a->inertia * g[r] * other[c];
            tangent->M_lower[(size_t)pair * n * n + e] += a->inertia * other[r] * g[c];
        }
    }
}

/* block += s (6 x 6 of a 12 x 12) */
static void add_six(double *block, double s, const double *from)
{
    for (int r = 0; r < 6; ++r) {
        for (int c = 0; c < 6; ++c) {
            block[6 * r + c] += s * from[12 * r + c];
        }
    }
}

/* rows of torques turned to r-p by 2 G^T: out[7 x 6] */
static void turn_rows(const se3di_frame *frame, const double *from, double out[42])
{
    double G[12];
    se3di_g_matrix(frame->p, G);
    for (int c = 0; c < 6; ++c) {
        for (int r = 0; r < 3; ++r) {
            out[6 * r + c] = from[12 * r + c];
        }
        for (int r = 0; r < 4; ++r) {
            out[6 * (3 + r) + c] = 2.0 * (G[r] * from[12 * 3 + c] + G[4 + r] * from[12 * 4 + c] +
                                          G[8 + r] * from[12 * 5 + c]);
        }
    }
}

/* block[7 x 7 of 8 x 8] += s rows * diag(I, X), X 3 x 4; `translations`: the identity part too */
static void add_turned(double *block, double s, const double rows[42], const double X[12],
                       int translations)
{
    for (int r = 0; r < 7; ++r) {
        for (int c = 0; c < 3 && translations; ++c) {
            block[8 * r + c] += s * rows[6 * r + c];
        }
        for (int c = 0; c < 4; ++c) {
            block[8 * r + 3 + c] += s * (rows[6 * r + 3] * X[c] + rows[6 * r + 4] * X[4 + c] +
                                         rows[6 * r + 5] * X[8 + c]);
        }
    }
}

static void scaled_g(const double p[4], double s, double X[12])
{
    se3di_g_matrix(p, X);
    for (int k = 0; k < 12; ++k) {
        X[k] *= s;
    }
}

/* Minus the derivative of one body's wrench to another's coordinates. In r-p dtheta = 2 G dp and
 * dw = 2 G dpdot - 2 G(pdot) dp. */
static void add_force_block(se3di_tangent *tangent, uint32_t row, uint32_t column, const double *K,
                            const double *D)
{
    const se3di_assembly *assembly = tangent->assembly;
    const se3di_frame *frames = assembly->model->frames;
    int32_t r = assembly->free_index[row];
    int32_t c = assembly->free_index[column];
    double *block_K = find_block(tangent, 0, r, c);
    double *block_D = find_block(tangent, 1, r, c);
    if (!block_K) {
        return;
    }
    if (assembly->formulation->block == 6) {
        add_six(block_K, -1.0, K);
        add_six(block_D, -1.0, D);
        return;
    }
    double rows[42], X[12], Xdot[12];
    scaled_g(frames[column].p, 2.0, X);
    scaled_g(frames[column].pdot, -2.0, Xdot);
    turn_rows(&frames[row], K, rows);
    add_turned(block_K, -1.0, rows, X, 1);
    turn_rows(&frames[row], D, rows);
    add_turned(block_K, -1.0, rows, Xdot, 0);
    add_turned(block_D, -1.0, rows, X, 1);
}

/* block[4 x 4 at (3, 3) of 8 x 8] += s N(y), where G(p)^T y = N(y) p */
static void add_turned_torque(double *block, double s, const double y[3])
{
    const double N[16] = {0.0,  -y[0], -y[1], -y[2], y[0], 0.0,  y[2],  -y[1],
                          y[1], -y[2], 0.0,   y[0],  y[2], y[1], -y[0], 0.0};
    for (int k = 0; k < 16; ++k) {
        block[8 * (3 + k / 4) + 3 + k % 4] += s * N[k];
    }
}

/* What acts on two bodies: its wrench [12] and derivatives. */
static void add_load(se3di_tangent *tangent, const uint32_t bodies[2], const double *wrench,
                     const double *K, const double *D)
{
    const se3di_assembly *assembly = tangent->assembly;
    double convex[144];
    if (tangent->is_convex) {
        const int is_free[2] = {assembly->free_index[bodies[0]] >= 0,
                                assembly->free_index[bodies[1]] >= 0};
        se3di_convex_load(is_free, K, convex);
        K = convex;
    }
    for (int row = 0; row < 2; ++row) {
        int32_t free = assembly->free_index[bodies[row]];
        for (int column = 0; column < 2; ++column) {
            size_t offset = (size_t)(72 * row + 6 * column);
            add_force_block(tangent, bodies[row], bodies[column], K + offset, D + offset);
        }
        double *block = find_block(tangent, 0, free, free);
        if (block && assembly->formulation->block == 8) {
            add_turned_torque(block, -2.0, wrench + 6 * row + 3);
        }
    }
}

/* What one function of the element depends on elsewhere. */
static se3d_status add_signals(se3di_tangent *tangent, const se3di_force *force, int c, double t)
{
    const se3di_model *model = tangent->assembly->model;
    const se3di_function *function = &model->functions[force->function[c]];
    const uint32_t rows[2] = {force->body_i, force->body_j};
    const uint32_t leaves = se3di_law_count_leaves(model, function);
    for (uint32_t s = 0; s < leaves; ++s) {
        double K[288], D[288];
        uint32_t columns[2];
        SE3DI_TRY(se3di_signal_tangent(model, force, c, s, t, columns, K, D));
        for (size_t k = 0; k < 4; ++k) {
            add_force_block(tangent, rows[k / 2], columns[k % 2], K + 72 * k, D + 72 * k);
        }
    }
    return SE3D_OK;
}

/* A force that is out of balance by `excess` turns with its line, too: K -= n H for the rest. */
static void leave_excess(const se3di_model *model, const se3di_force *force, double excess,
                         se3di_effect *effect)
{
    se3di_measure measure;
    if (excess != 0.0 && se3di_measure_force(model, force, 1, &measure)) {
        for (int k = 0; k < 144; ++k) {
            effect->K[k] += excess * measure.H[k];
        }
    }
}

/* The rate of a slip that lags: its derivatives, and what the wrench of the tyre has of it. */
static se3d_status add_lag(se3di_tangent *tangent, const se3di_force *state, double t)
{
    const se3di_model *model = tangent->assembly->model;
    const se3di_force *tyre = &model->forces[state->tyre_index];
    const uint32_t bodies[2] = {tyre->body_i, tyre->body_j}, carrier = state->body_j;
    const double zero[72] = {0.0};
    double own[72] = {SE3DI_CARRIER_MASS};
    se3di_tyre_lag lag = {.wants_derivative = 1};
    SE3DI_TRY(se3di_tyre_lag_eval(model, tyre, t, state->coordinate, &lag));
    own[0] *= lag.own;
    add_force_block(tangent, carrier, carrier, zero, own);
    for (int b = 0; b < 2; ++b) {
        double K[72] = {0.0}, D[72] = {0.0}, gain[72] = {0.0};
        for (int c = 0; c < 6; ++c) {
            K[c] = SE3DI_CARRIER_MASS * lag.K[6 * b + c];
            D[c] = SE3DI_CARRIER_MASS * lag.D[6 * b + c];
            gain[12 * c] = lag.gain[6 * b + c];
        }
        add_force_block(tangent, carrier, bodies[b], K, D);
        add_force_block(tangent, bodies[b], carrier, zero, gain);
    }
    return SE3D_OK;
}

static se3d_status add_force(se3di_tangent *tangent, size_t k, double t)
{
    const se3di_model *model = tangent->assembly->model;
    const se3di_force *force = &model->forces[k];
    const uint32_t bodies[2] = {force->body_i, force->body_j};
    se3di_effect effect;
    effect.wants_derivative = 1;
    SE3DI_TRY(se3di_force_eval(model, force, t, &effect));
    leave_excess(model, force, tangent->excess ? tangent->excess[k] : 0.0, &effect);
    add_load(tangent, bodies, effect.wrench, effect.K, effect.D);
    if (force->tyre_index >= 0 && !tangent->is_convex) {
        SE3DI_TRY(add_lag(tangent, force, t));
    }
    for (int c = 0; c < 3 && !tangent->is_convex; ++c) {
        if (force->function[c] >= 0) {
            SE3DI_TRY(add_signals(tangent, force, c, t));
        }
    }
    return SE3D_OK;
}

static se3d_status add_forces(se3di_tangent *tangent, double t, se3di_error *error)
{
    const se3di_model *model = tangent->assembly->model;
    for (uint32_t k = 0; k < model->force_slots.count; ++k) {
        const se3d_status status = add_force(tangent, k, t);
        if (status < 0) {
            return se3di_force_fail(model, k, status, t, error);
        }
    }
    return SE3D_OK;
}

/* M, and what accelerations and velocities make of the rates of coordinates. */
static void add_armatures(se3di_tangent *tangent, const double *vdot)
{
    const se3di_assembly *assembly = tangent->assembly;
    const se3di_model *model = assembly->model;
    const size_t n = (size_t)assembly->formulation->block;
    for (uint32_t k = 0; k < assembly->armature_count; ++k) {
        const se3di_force *force = &model->forces[assembly->armature[k].force];
        const uint32_t bodies[2] = {force->body_i, force->body_j};
        double acceleration[12] = {0.0};
        se3di_armature a;
        se3di_effect effect;
        se3di_armature_eval(assembly, k, &a);
        add_armature_mass(tangent, &a, n);
        for (int b = 0; b < 2; ++b) {
            if (a.body[b] >= 0) {
                assembly->formulation->get_acceleration(
                    &model->frames[bodies[b]], vdot + n * (size_t)a.body[b], acceleration + 6 * b);
            }
        }
        se3di_armature_effect(model, force, acceleration, &effect);
        if (!tangent->is_convex) {
            add_load(tangent, bodies, effect.wrench, effect.K, effect.D);
        }
    }
}

static se3d_status add_contact(void *ctx, const se3di_encounter *encounter)
{
    double wrench[12], K[144], D[144];
    se3di_encounter_wrench(encounter, wrench);
    se3di_encounter_derivative(encounter, K, D);
    add_load(ctx, encounter->body, wrench, K, D);
    return SE3D_OK;
}

static void add_quadrant(double *block, int32_t block_size, const double *H, int32_t size, int row,
                         int column)
{
    if (!block) {
        return;
    }
    for (int r = 0; r < size; ++r) {
        for (int c = 0; c < size; ++c) {
            block[block_size * r + c] += H[2 * size * (size * row + r) + size * column + c];
        }
    }
}

static void add_row_curvature(se3di_tangent *tangent, const se3di_row *row, double lambda)
{
    const se3di_assembly *assembly = tangent->assembly;
    const se3di_model *model = assembly->model;
    const se3di_formulation *formulation = assembly->formulation;
    for (uint32_t e = 0; e < row->term_count; ++e) {
        const se3di_term *term = &model->terms[row->term_begin + e];
        const uint32_t bodies[2] = {term->body_i, term->body_j};
        double H[196] = {0.0};
        formulation->curvature(term, &model->frames[bodies[0]], &model->frames[bodies[1]],
                               lambda * term->coefficient, H);
        for (int q = 0; q < 4; ++q) {
            double *block = find_block(tangent, 0, assembly->free_index[bodies[q / 2]],
                                       assembly->free_index[bodies[q % 2]]);
            add_quadrant(block, formulation->block, H, formulation->size, q / 2, q % 2);
        }
    }
}

static void add_fused_curvature(se3di_tangent *tangent, uint32_t joint, const double *lambda)
{
    const se3di_assembly *assembly = tangent->assembly;
    const se3di_model *model = assembly->model;
    const se3di_term *term = model->terms + model->constraints[joint].term_begin;
    const int32_t i = assembly->free_index[term->body_i];
    const int32_t j = assembly->free_index[term->body_j];
    se3di_fused_blocks blocks = {.ii = find_block(tangent, 0, i, i),
                                 .jj = find_block(tangent, 0, j, j)};
    if (tangent->joint_pair[joint] >= 0) {
        tangent->is_filled[tangent->joint_pair[joint]] = 1;
        double *upper = tangent->K_upper + 36 * (size_t)tangent->joint_pair[joint];
        double *lower = tangent->K_lower + 36 * (size_t)tangent->joint_pair[joint];
        blocks.ij = i < j ? upper : lower;
        blocks.ji = i < j ? lower : upper;
    }
    se3di_fused_add_curvature(assembly, joint, lambda, &blocks);
}

static void add_curvature(se3di_tangent *tangent, const double *lambda)
{
    const se3di_assembly *assembly = tangent->assembly;
    const se3di_model *model = assembly->model;
    for (uint32_t k = 0; k < assembly->constraint_count; ++k) {
        const se3di_constraint *constraint = &model->constraints[k];
        if (assembly->is_fused[k]) {
            add_fused_curvature(tangent, k, lambda + constraint->row_begin);
            continue;
        }
        for (uint32_t r = constraint->row_begin; r < constraint->row_begin + constraint->row_count;
             ++r) {
            add_row_curvature(tangent, &model->rows[r], lambda[r]);
        }
    }
}

/* d(Phi_q qdot)/dq = qdot^T d(Phi_q^T)/dq, the curvature for a unit multiplier. */
static void add_term_gradient(const se3di_assembly *assembly, const se3di_term *term, double c,
                              double *row_i, double *row_j)
{
    const se3di_frame *frames[2] = {&assembly->model->frames[term->body_i],
                                    &assembly->model->frames[term->body_j]};
    double *rows[2] = {row_i, row_j};
    double H[196] = {0.0};
    assembly->formulation->curvature(term, frames[0], frames[1], c * term->coefficient, H);
    for (int q = 0; q < 4; ++q) {
        double velocity[6];
        se3di_copy(frames[q / 2]->v, velocity);
        se3di_copy(frames[q / 2]->w, velocity + 3);
        for (int k = 0; k < 6 && rows[q % 2]; ++k) {
            for (int r = 0; r < 6; ++r) {
                rows[q % 2][k] += velocity[r] * H[12 * (6 * (q / 2) + r) + 6 * (q % 2) + k];
            }
        }
    }
}

void se3di_assembly_add_rate_gradient(const se3di_assembly *assembly, double c, double *rows)
{
    const se3di_model *model = assembly->model;
    for (uint32_t joint = 0; joint < assembly->constraint_count; ++joint) {
        const se3di_constraint *constraint = &model->constraints[joint];
        const size_t *offset = assembly->block_offset + assembly->joint_begin[joint];
        if (assembly->is_fused[joint]) {
            se3di_fused_add_rate_gradient(assembly, joint, c, rows);
            continue;
        }
        for (uint32_t r = 0; r < constraint->row_count; ++r) {
            const se3di_row *row = &model->rows[constraint->row_begin + r];
            for (uint32_t e = row->term_begin; e < row->term_begin + row->term_count; ++e) {
                const se3di_term_place *place = &assembly->places[e];
                double *row_i = place->slot_i < 0 ? NULL : rows + offset[place->slot_i] + 6 * r;
                double *row_j = place->slot_j < 0 ? NULL : rows + offset[place->slot_j] + 6 * r;
                add_term_gradient(assembly, &model->terms[e], c, row_i, row_j);
            }
        }
    }
    se3di_left_out_clear_blocks(assembly, rows);
}

/* K += the curvature of one user constraint: minus the derivative of its wrenches -Phi_q^T lambda.
 */
static se3d_status add_user_curvature(se3di_tangent *tangent, const se3di_constraint *constraint,
                                      double t, const double *lambda)
{
    enum { NUMBERS = 6 * SE3DI_NODE_BODIES_MAX };
    const double zero[72] = {0.0};
    double H[NUMBERS * NUMBERS], g[NUMBERS], K[72];
    const uint32_t *bodies = constraint->bodies + constraint->user_first;
    uint32_t count = se3di_user_body_count(constraint);
    SE3DI_TRY(se3di_user_curvature(tangent->assembly->model, constraint, t,
                                   lambda + constraint->row_begin, H, g));
    for (uint32_t row = 0; row < count; ++row) {
        for (uint32_t column = 0; column < count; ++column) {
            for (size_t k = 0; k < 36; ++k) { /* rows of twelve, as those of force elements */
                K[12 * (k / 6) + k % 6] = -H[6 * count * (6 * row + k / 6) + 6 * column + k % 6];
            }
            add_force_block(tangent, bodies[row], bodies[column], K, zero);
        }
        int32_t free = tangent->assembly->free_index[bodies[row]];
        double *block = find_block(tangent, 0, free, free);
        if (block && tangent->assembly->formulation->block == 8) {
            add_turned_torque(block, 2.0, g + 6 * row + 3);
        }
    }
    return SE3D_OK;
}

static se3d_status add_user_curvatures(se3di_tangent *tangent, double t, const double *lambda,
                                       se3di_error *error)
{
    se3di_model *model = tangent->assembly->model;
    for (uint32_t k = 0; k < model->constraint_slots.count; ++k) {
        const se3di_constraint *constraint = &model->constraints[k];
        if (se3di_is_user(constraint) && !se3di_is_broken(constraint, model->rows)) {
            const se3d_status status = add_user_curvature(tangent, constraint, t, lambda);
            if (status < 0) {
                model->user_failure =
                    (se3di_user_failure){.time = t, .status = (int32_t)status, .constraint = k};
                return se3di_user_report(model, error);
            }
        }
    }
    return SE3D_OK;
}

/* r-omega: w x J w  ->  tilde(w) J - tilde(J w) */
static void add_gyroscopic(const se3di_body *body, const se3di_frame *frame, double *D)
{
    double J[9], momentum[3], W[9], L[9], WJ[9];
    se3di_inertia_matrix(body->J, J);
    se3di_mul(J, frame->w, momentum);
    se3di_tilde(frame->w, W);
    se3di_tilde(momentum, L);
    se3di_mat_mul(W, J, WJ);
    for (int k = 0; k < 9; ++k) {
        D[6 * (3 + k / 3) + 3 + k % 3] += WJ[k] - L[k];
    }
}

/* block[4 x 4] += s G(a)^T J G(b) */
static void add_gjg(double *block, double s, const double a[4], const double J[9],
                    const double b[4])
{
    double G_a[12], G_b[12], JG[12];
    se3di_g_matrix(a, G_a);
    se3di_g_matrix(b, G_b);
    for (int k = 0; k < 12; ++k) {
        int r = k / 4;
        int c = k % 4;
        JG[k] = J[3 * r] * G_b[c] + J[3 * r + 1] * G_b[4 + c] + J[3 * r + 2] * G_b[8 + c];
    }
    for (int r = 0; r < 4; ++r) {
        for (int c = 0; c < 4; ++c) {
            block[8 * (3 + r) + 3 + c] +=
                s * (G_a[r] * JG[c] + G_a[4 + r] * JG[4 + c] + G_a[8 + r] * JG[8 + c]);
        }
    }
}

/* r-p: 4 G^T J G pddot + 8 Gdot^T J G pdot + p lambda_p, with G(a) b = -G(b) a */
static void add_rp_terms(const se3di_body *body, const se3di_frame *frame, const double *vdot,
                         double *K, double *D)
{
    double J[9], turn[3], y[3];
    se3di_inertia_matrix(body->J, J);
    se3di_g_mul(frame->p, vdot + 3, turn);
    se3di_mul(J, turn, y);
    add_turned_torque(K, 4.0, y);
    add_gjg(K, -4.0, frame->p, J, vdot + 3);
    add_gjg(K, -8.0, frame->pdot, J, frame->pdot);
    se3di_g_mul(frame->p, frame->pdot, turn);
    se3di_mul(J, turn, y);
    add_turned_torque(D, 8.0, y);
    add_gjg(D, 8.0, frame->pdot, J, frame->p);
    for (int r = 0; r < 4; ++r) {
        K[9 * (3 + r)] += vdot[7];
    }
}

/* All blocks of bodies, and those of couplings that are filled. */
static void clear(se3di_tangent *tangent)
{
    const size_t n = (size_t)tangent->assembly->formulation->block, size = n * n * sizeof(double);
    double **arrays[TANGENT_ARRAYS];
    size_t counts[TANGENT_ARRAYS];
    list_arrays(tangent, arrays, counts);
    for (int k = 0; k < TANGENT_ARRAYS; ++k) {
        if (k < BODY_ARRAYS) {
            memset(*arrays[k], 0, counts[k] * sizeof(double));
            continue;
        }
        for (size_t c = 0; c < tangent->coupling_count && counts[k] > 0; ++c) {
            if (tangent->is_filled[c]) {
                memset(*arrays[k] + c * n * n, 0, size);
            }
        }
    }
    memset(tangent->is_filled, 0, tangent->coupling_capacity);
}

se3d_status se3di_tangent_eval(se3di_tangent *tangent, double t, const double *vdot,
                               const double *lambda, se3di_error *error)
{
    const se3di_assembly *assembly = tangent->assembly;
    const se3di_model *model = assembly->model;
    size_t n = (size_t)assembly->formulation->block;
    clear(tangent);
    for (size_t k = 0; k < assembly->body_count; ++k) {
        const se3di_body *body = &model->bodies[assembly->free_body[k]];
        const se3di_frame *frame = &model->frames[assembly->free_body[k]];
        assembly->formulation->mass(body, frame, tangent->M + k * n * n);
        if (n == 6) {
            add_gyroscopic(body, frame, tangent->D + k * n * n);
        } else {
            add_rp_terms(body, frame, vdot + n * k, tangent->K + k * n * n, tangent->D + k * n * n);
        }
    }
    add_armatures(tangent, vdot);
    add_curvature(tangent, lambda);
    SE3DI_TRY(add_user_curvatures(tangent, t, lambda, error));
    if (tangent->is_convex) {
        se3di_convex_blocks(tangent);
    }
    SE3DI_TRY(add_forces(tangent, t, error));
    return se3di_contacts_visit(model, t, add_contact, tangent);
}

static void add_block(const double *block, size_t n, double s, const double *x, double *out)
{
    for (size_t r = 0; r < n; ++r) {
        double sum = 0.0;
        for (size_t c = 0; c < n; ++c) {
            sum += block[r * n + c] * x[c];
        }
        out[r] += s * sum;
    }
}

/* out += s (blocks) x */
static void add_blocks(const se3di_tangent *tangent, const double *const blocks[3], double s,
                       const double *x, double *out)
{
    size_t n = (size_t)tangent->assembly->formulation->block;
    for (size_t k = 0; k < tangent->assembly->body_count; ++k) {
        add_block(blocks[0] + k * n * n, n, s, x + k * n, out + k * n);
    }
    for (size_t k = 0; k < tangent->coupling_count; ++k) {
        size_t i = (size_t)tangent->coupling[2 * k];
        size_t j = (size_t)tangent->coupling[2 * k + 1];
        if (!tangent->is_filled[k]) {
            continue;
        }
        add_block(blocks[1] + k * n * n, n, s, x + j * n, out + i * n);
        add_block(blocks[2] + k * n * n, n, s, x + i * n, out + j * n);
    }
}

void se3di_tangent_add_stiffness(const se3di_tangent *tangent, double s, const double *x,
                                 double *out)
{
    const double *const blocks[3] = {tangent->K, tangent->K_upper, tangent->K_lower};
    add_blocks(tangent, blocks, s, x, out);
}

void se3di_tangent_add_damping(const se3di_tangent *tangent, double s, const double *x, double *out)
{
    const double *const blocks[3] = {tangent->D, tangent->D_upper, tangent->D_lower};
    add_blocks(tangent, blocks, s, x, out);
}
