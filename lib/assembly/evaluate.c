/* SPDX-License-Identifier: BSD-3-Clause */
/* Evaluation of the equations at the state of the model. */
#include "assembly/assembly.h"

#include "assembly/armature.h"
#include "assembly/fused.h"
#include "assembly/left_out.h"
#include "assembly/loads.h"
#include "assembly/user.h"
#include "math/vec3.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

#define DISTANCE_MIN 1e-12 /* squared, of the square of the bodies' size */

/* A body's radius of gyration, or the distance of a point on it. */
static double reach(const se3di_body *body, const double s[3])
{
    const double gyration =
        body->mass > 0.0 ? (body->J[0] + body->J[1] + body->J[2]) / body->mass : 0.0;
    return fmax(sqrt(fmax(gyration, 0.0)), se3di_norm(s));
}

/* A distance of zero has no direction, and no motion goes on through it. */
static int is_lost_distance(const se3di_model *model, const se3di_row *row, double square)
{
    if (square > 1e-9 || row->term_count != 1 ||
        model->terms[row->term_begin].type != SE3DI_PRIMITIVE_D) {
        return 0;
    }
    const se3di_term *term = &model->terms[row->term_begin];
    const double size = fmax(reach(&model->bodies[term->body_i], term->s_i),
                             reach(&model->bodies[term->body_j], term->s_j));
    return square <= DISTANCE_MIN * size * size;
}

static se3d_status report_distance(const se3di_model *model, uint32_t row, double t, double square,
                                   se3di_error *error)
{
    char name[128];
    se3di_row_name(model, row, name, sizeof name);
    return se3di_error_set(
        error, SE3D_ERR_INCONSISTENT,
        "t = %g s: the square of the distance that %s prescribes is %.3g m^2, must "
        "be > 0: a distance of zero has no direction (a spherical joint holds "
        "points together)",
        t, name, square);
}

se3d_status se3di_assembly_eval_functions(se3di_assembly *assembly, double t, se3di_error *error)
{
    const se3di_model *model = assembly->model;
    assembly->time = t;
    SE3DI_TRY(se3di_user_report(assembly->model, error));
    for (uint32_t timed = 0; timed < assembly->timed_count; ++timed) {
        uint32_t k = assembly->timed_rows[timed];
        const se3di_row *row = &model->rows[k];
        double *jet = assembly->f + 3 * (size_t)k;
        se3d_status status = se3di_function_eval(&model->functions[row->function], &t, jet, NULL);
        if (status < 0) {
            char name[128];
            se3di_row_name(model, k, name, sizeof name);
            return se3di_error_set(error, status,
                                   "t = %g s: the function of %s is f = %g, f' = %g, f'' = %g, "
                                   "must be finite",
                                   t, name, jet[0], jet[1], jet[2]);
        }
        if (is_lost_distance(model, row, jet[0])) {
            return report_distance(model, k, t, jet[0], error);
        }
    }
    return SE3D_OK;
}

void se3di_assembly_eval_phi(const se3di_assembly *assembly, double *phi)
{
    const se3di_model *model = assembly->model;
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        const se3di_row *row = &model->rows[k];
        phi[k] = se3di_row_violation(model, row, assembly->f[3 * k]);
    }
    se3di_user_eval_phi(assembly, phi);
    se3di_left_out_clear_values(assembly, phi);
}

/* Add `size` numbers of a term's block to a row of the joint's blocks. */
static void add_block(double *block, const double *phi, double coefficient, int32_t size)
{
    for (int32_t k = 0; k < size; ++k) {
        block[k] += coefficient * phi[k];
    }
}

static void eval_joint_jacobian(se3di_assembly *assembly, uint32_t joint)
{
    const se3di_model *model = assembly->model;
    const se3di_formulation *formulation = assembly->formulation;
    const se3di_constraint *constraint = &model->constraints[joint];
    const size_t *offset = assembly->block_offset + assembly->joint_begin[joint];
    size_t block = (size_t)formulation->block;
    for (uint32_t r = 0; r < constraint->row_count; ++r) {
        const se3di_row *row = &model->rows[constraint->row_begin + r];
        for (uint32_t k = 0; k < row->term_count; ++k) {
            uint32_t index = row->term_begin + k;
            const se3di_term *term = &model->terms[index];
            const se3di_term_place *place = &assembly->places[index];
            double phi_i[SE3DI_BLOCK_MAX];
            double phi_j[SE3DI_BLOCK_MAX];
            formulation->jacobian(term, &model->frames[term->body_i], &model->frames[term->body_j],
                                  phi_i, phi_j);
            if (place->slot_i >= 0) {
                add_block(assembly->C + offset[place->slot_i] + r * block, phi_i, term->coefficient,
                          formulation->size);
            }
            if (place->slot_j >= 0) {
                add_block(assembly->C + offset[place->slot_j] + r * block, phi_j, term->coefficient,
                          formulation->size);
            }
        }
    }
}

/* Blocks of one joint, term by term. */
static void eval_joint(se3di_assembly *assembly, uint32_t joint)
{
    size_t begin = assembly->block_offset[assembly->joint_begin[joint]];
    size_t count = (size_t)(assembly->joint_begin[joint + 1] - assembly->joint_begin[joint]) *
                   (size_t)(assembly->joint_rows[joint] * assembly->formulation->block);
    if (count > 0) {
        memset(assembly->C + begin, 0, count * sizeof *assembly->C);
    }
    eval_joint_jacobian(assembly, joint);
}

void se3di_assembly_eval_jacobian(se3di_assembly *assembly)
{
    for (uint32_t k = 0; k < assembly->constraint_count; ++k) {
        if (assembly->is_fused[k]) {
            se3di_fused_eval(assembly, k, NULL);
        } else {
            eval_joint(assembly, k);
        }
    }
    se3di_user_eval_jacobian(assembly);
    se3di_left_out_clear_blocks(assembly, assembly->C);
}

static double eval_row_gamma(const se3di_assembly *assembly, uint32_t k)
{
    const se3di_model *model = assembly->model;
    const se3di_row *row = &model->rows[k];
    double gamma = assembly->f[3 * (size_t)k + 2];
    for (uint32_t t = 0; t < row->term_count; ++t) {
        const se3di_term *term = &model->terms[row->term_begin + t];
        gamma +=
            term->coefficient * assembly->formulation->gamma(term, &model->frames[term->body_i],
                                                             &model->frames[term->body_j]);
    }
    return gamma;
}

void se3di_assembly_eval_gamma(const se3di_assembly *assembly, double *gamma)
{
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        gamma[k] = eval_row_gamma(assembly, k);
    }
    se3di_user_eval_gamma(assembly, gamma);
    se3di_left_out_clear_values(assembly, gamma);
}

static void eval_rows_of(se3di_assembly *assembly, uint32_t joint, double *gamma)
{
    const se3di_constraint *constraint = &assembly->model->constraints[joint];
    if (assembly->is_fused[joint]) {
        se3di_fused_eval(assembly, joint, gamma + constraint->row_begin);
        return;
    }
    eval_joint(assembly, joint);
    for (uint32_t r = 0; r < constraint->row_count; ++r) {
        gamma[constraint->row_begin + r] = eval_row_gamma(assembly, constraint->row_begin + r);
    }
}

/* What is the same for all: user constraints, rows that are left out. */
static void finish_rows(se3di_assembly *assembly, double *gamma)
{
    se3di_user_eval_jacobian(assembly);
    se3di_user_eval_gamma(assembly, gamma);
    se3di_left_out_clear_blocks(assembly, assembly->C);
    se3di_left_out_clear_values(assembly, gamma);
}

void se3di_assembly_eval_rows(se3di_assembly *assembly, double *gamma)
{
    for (uint32_t k = 0; k < assembly->constraint_count; ++k) {
        eval_rows_of(assembly, k, gamma);
    }
    finish_rows(assembly, gamma);
}

void se3di_assembly_eval_some_rows(se3di_assembly *assembly, const uint32_t *constraints,
                                   uint32_t count, double *gamma)
{
    for (uint32_t k = 0; k < count; ++k) {
        eval_rows_of(assembly, constraints[k], gamma);
    }
    finish_rows(assembly, gamma);
}

void se3di_assembly_eval_mass(se3di_assembly *assembly)
{
    size_t block = (size_t)assembly->formulation->block;
    const double J = assembly->like_inertia;
    const se3di_body alike = {.mass = assembly->like_mass, .J = {J, J, J, 0.0, 0.0, 0.0}};
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        uint32_t body = assembly->free_body[k];
        const se3di_body *weight = assembly->levels ? &alike : &assembly->model->bodies[body];
        assembly->formulation->mass(weight, &assembly->model->frames[body],
                                    assembly->H + k * block * block);
    }
    if (assembly->armature_count > 0) {
        se3di_armatures_add_mass(assembly);
    }
}

void se3di_assembly_follow_mass(se3di_assembly *assembly)
{
    if (assembly->armature_count > 0) {
        se3di_assembly_eval_mass(assembly);
    }
}

/* Independent of the poses, so that a run goes on with the same bits wherever it stands. */
void se3di_assembly_level(se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    double length = 0.0;
    double sum = 0.0;
    for (uint32_t k = 0; k < model->term_count; ++k) {
        const se3di_term *term = &model->terms[k];
        if (assembly->places[k].slot_i >= 0) {
            length = fmax(length, se3di_norm(term->s_i));
        }
        if (assembly->places[k].slot_j >= 0) {
            length = fmax(length, se3di_norm(term->s_j));
        }
    }
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        sum += model->bodies[assembly->free_body[k]].mass;
    }
    length = length > 0.0 ? length : 1.0;
    assembly->like_mass = assembly->body_count > 0 ? sum / assembly->body_count : 1.0;
    assembly->like_inertia = assembly->like_mass * length * length;
    assembly->levels = 1;
}

/* Into assembly->wrench. */
static se3d_status sum_elements(se3di_assembly *assembly, double t, se3di_force_sums *sums,
                                se3di_error *error)
{
    const se3di_model *model = assembly->model;
    sums->wrench = assembly->wrench;
    const se3d_status status = se3di_forces_sum(model, t, sums);
    if (status < 0) {
        return se3di_force_fail(model, sums->failed, status, t, error);
    }
    memcpy(assembly->power, sums->power, sizeof assembly->power);
    return SE3D_OK;
}

se3d_status se3di_assembly_eval_elements(se3di_assembly *assembly, double t, se3di_error *error)
{
    se3di_force_sums sums = {.along = NULL};
    return sum_elements(assembly, t, &sums, error);
}

se3d_status se3di_assembly_sum_loads(se3di_assembly *assembly, double t, se3di_force_sums *sums,
                                     se3di_error *error)
{
    SE3DI_TRY(sum_elements(assembly, t, sums, error));
    se3di_contacts_add_wrenches(assembly->model, t, assembly->wrench, assembly->contact_power);
    for (size_t k = 0; assembly->push && k < 6 * (size_t)assembly->dense_count; ++k) {
        assembly->wrench[k] += assembly->push[k];
    }
    return SE3D_OK;
}

se3d_status se3di_assembly_eval_wrenches(se3di_assembly *assembly, double t, se3di_error *error)
{
    se3di_force_sums sums = {.along = NULL};
    return se3di_assembly_sum_loads(assembly, t, &sums, error);
}

se3d_status se3di_assembly_eval_forces(se3di_assembly *assembly, double t, double *b,
                                       se3di_error *error)
{
    const se3di_model *model = assembly->model;
    SE3DI_TRY(se3di_assembly_eval_wrenches(assembly, t, error));
    int32_t block = assembly->formulation->block;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        uint32_t body = assembly->free_body[k];
        const double *wrench = assembly->wrench + 6 * body;
        assembly->formulation->velocity_terms(&model->bodies[body], &model->frames[body],
                                              b + k * (uint32_t)block);
        assembly->formulation->add_wrench(&model->frames[body], wrench, wrench + 3,
                                          b + k * (uint32_t)block);
    }
    se3di_armatures_add_terms(assembly, b);
    return SE3D_OK;
}

void se3di_assembly_mul_mass(const se3di_assembly *assembly, const double *x, double *out)
{
    size_t n = (size_t)assembly->formulation->block;
    for (size_t k = 0; k < assembly->body_count; ++k) {
        const double *H = assembly->H + k * n * n;
        for (size_t r = 0; r < n; ++r) {
            double sum = 0.0;
            for (size_t c = 0; c < n; ++c) {
                sum += H[n * r + c] * x[k * n + c];
            }
            out[k * n + r] = sum;
        }
    }
    se3di_armatures_add_coupled(assembly, 1.0, x, out);
}

/* out [n] -= B x, B an n x n block of one body. */
static void subtract_block(const double *B, size_t n, const double *x, double *out)
{
    for (size_t r = 0; r < n; ++r) {
        for (size_t c = 0; c < n; ++c) {
            out[r] -= B[n * r + c] * x[c];
        }
    }
}

void se3di_assembly_subtract_mass(const se3di_assembly *assembly, const double *x, double *out)
{
    const size_t n = (size_t)assembly->formulation->block;
    for (size_t k = 0; k < assembly->body_count; ++k) {
        subtract_block(assembly->H + k * n * n, n, x + k * n, out + k * n);
    }
    se3di_armatures_add_coupled(assembly, -1.0, x, out);
}

void se3di_assembly_subtract_inertia(const se3di_assembly *assembly, const double *x, double *out)
{
    const size_t n = (size_t)assembly->formulation->block;
    double M[SE3DI_BLOCK_MAX * SE3DI_BLOCK_MAX];
    for (size_t k = 0; k < assembly->body_count; ++k) {
        const uint32_t body = assembly->free_body[k];
        assembly->formulation->mass(&assembly->model->bodies[body], &assembly->model->frames[body],
                                    M);
        subtract_block(M, n, x + k * n, out + k * n);
    }
    se3di_armatures_subtract(assembly, x, out);
}

void se3di_assembly_mul(const se3di_assembly *assembly, const double *x, double *out)
{
    size_t n = (size_t)assembly->formulation->block;
    memset(out, 0, assembly->row_count * sizeof *out);
    for (uint32_t joint = 0; joint < assembly->constraint_count; ++joint) {
        double *rows = out + assembly->model->constraints[joint].row_begin;
        for (int32_t k = assembly->joint_begin[joint]; k < assembly->joint_begin[joint + 1]; ++k) {
            const double *block = assembly->C + assembly->block_offset[k];
            const double *part = x + (size_t)assembly->joint_body[k] * n;
            for (int32_t r = 0; r < assembly->joint_rows[joint]; ++r, block += n) {
                for (size_t c = 0; c < n; ++c) {
                    rows[r] += block[c] * part[c];
                }
            }
        }
    }
}

void se3di_assembly_add_transposed(const se3di_assembly *assembly, double scale, const double *l,
                                   double *out)
{
    size_t n = (size_t)assembly->formulation->block;
    for (uint32_t joint = 0; joint < assembly->constraint_count; ++joint) {
        const double *rows = l + assembly->model->constraints[joint].row_begin;
        for (int32_t k = assembly->joint_begin[joint]; k < assembly->joint_begin[joint + 1]; ++k) {
            const double *block = assembly->C + assembly->block_offset[k];
            double *part = out + (size_t)assembly->joint_body[k] * n;
            for (int32_t r = 0; r < assembly->joint_rows[joint]; ++r, block += n) {
                for (size_t c = 0; c < n; ++c) {
                    part[c] += scale * rows[r] * block[c];
                }
            }
        }
    }
}

void se3di_assembly_get_velocity(const se3di_assembly *assembly, double *qdot)
{
    size_t block = (size_t)assembly->formulation->block;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        qdot[k * block + block - 1] = 0.0;
        assembly->formulation->get_velocity(&assembly->model->frames[assembly->free_body[k]],
                                            qdot + k * block);
    }
}

void se3di_assembly_set_velocity(se3di_assembly *assembly, const double *qdot)
{
    size_t block = (size_t)assembly->formulation->block;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        assembly->formulation->set_velocity(&assembly->model->frames[assembly->free_body[k]],
                                            qdot + k * block);
    }
}

void se3di_assembly_get_acceleration(const se3di_assembly *assembly, double *qddot)
{
    size_t block = (size_t)assembly->formulation->block;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        uint32_t body = assembly->free_body[k];
        qddot[k * block + block - 1] = 0.0;
        assembly->formulation->set_acceleration(&assembly->model->frames[body],
                                                assembly->model->acceleration + 6 * body,
                                                qddot + k * block);
    }
}

void se3di_assembly_set_acceleration(se3di_assembly *assembly, const double *qddot)
{
    size_t block = (size_t)assembly->formulation->block;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        uint32_t body = assembly->free_body[k];
        assembly->formulation->get_acceleration(&assembly->model->frames[body], qddot + k * block,
                                                assembly->model->acceleration + 6 * body);
    }
}
